//! Sheets that lie on each other, as tiles and buildings from several files do: no corners in common, borders on the others' faces.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;
use crate::patch::{kept, pressed};
use common::*;
use rockfall::contact::neighbours::Neighbours;
use rockfall::ground::Ground;
use rockfall::rock::{Rock, Vec3};
use rockfall::solver::Scheme;
use rockfall::terrain::Terrain;
use rockfall::terrain::stl::{Facet, write_binary};

/// Two tiles, welded as in a scene without a tolerance of its own.
fn welded(tiles: [Vec<Facet>; 2]) -> Terrain {
    terrain_of_files(tiles.into(), None)
}

/// A sheet from x = `from` to 10 m and 20 m wide, of so many squares each way.
fn sheet(from: f64, squares: u32, z: impl Fn(f64, f64) -> f64) -> Vec<Facet> {
    let at = |i: u32, j: u32| {
        let along = |k: u32| f64::from(k) / f64::from(squares);
        let (x, y) = (from + (10.0 - from) * along(i), 20.0 * along(j) - 10.0);
        Vec3::new(x, y, z(x, y))
    };
    let squares = (0..squares).flat_map(|i| (0..squares).map(move |j| (i, j)));
    let halves = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    squares.flat_map(halves).collect()
}

/// A tile of level ground, and one on it that begins in the middle of its faces and rises by an angle.
fn rising(angle: f64) -> Terrain {
    welded([sheet(-10.0, 3, |_, _| 0.0), sheet(0.0, 7, |x, _| angle * x)])
}

/// e = 1 without friction.
fn elastic(radius: f64) -> Case {
    let ground = Ground {
        normal_stiffness_n_m: 1e9 * radius,
        shear_stiffness_n_m: 0.25e9 * radius,
        friction_angle_rad: 0.0,
        restitution: Some(1.0),
        ..GROUND
    };
    let rock = Rock { radius_m: radius, ..ROCK };
    Case { ground, rock, tolerance_m_s: 0.05, step_s: 0.01, capture_speed_m_s: Some(0.0), ..CASE }
}

/// Two tiles of one slope in the 32 bits of an STL file: they lie within some 1e-9 m of each other. A rock lets go of both in a
/// few steps, wherever it lands. Of these landings one took all of the five million steps that a rock has.
#[test]
fn a_rock_lets_go_of_two_sheets_that_lie_on_each_other() {
    let slope = |x: f64, y: f64| 0.01 * x + 0.013 * y;
    let single = |facets: Vec<Facet>| -> Vec<Facet> {
        let rounded = |corner: Vec3| corner.map(|x| f64::from(x as f32));
        facets.into_iter().map(|facet| facet.map(rounded)).collect()
    };
    let terrain = welded([single(sheet(-10.0, 3, slope)), single(sheet(0.0, 7, slope))]);
    for radius in [0.05, 0.5] {
        for k in 0..40 {
            let random = &mut common::zoo::dice(6, k);
            let y = common::zoo::between(random, -5.0, 5.0);
            let near = if k % 2 == 0 { 0.01 } else { 1.0 };
            let x = radius * near * common::zoo::between(random, -0.3, 0.3);
            let v = [1.0, common::zoo::between(random, -2.0, 2.0), -10.0];
            let run = elastic(radius).run(&terrain, [[x, y, 1.2 * radius + 0.2], v, [0.0; 3]], 0.2);
            assert!(run.effort.steps < 100, "R {radius} {k}: {:?}", run.effort);
        }
    }
}

/// Where a sheet begins on the faces of another and parts from it bluntly, a ball rolls from both to one without a jump of what
/// its springs hold. Half of it was gone where the foot came to the border.
#[test]
fn a_border_on_the_faces_of_another_sheet_makes_no_jump() {
    let (radius, depth, ways) = (0.5, 0.02, 2000);
    let mut near = Neighbours::default();
    for angle in [1e-5, 1e-3, 0.02, 0.1, 0.3] {
        let terrain = rising(angle);
        for y in [-4.3, -0.8, 0.2, 2.9] {
            let at = |k: u32| 0.5 * radius * (2.0 * f64::from(k) / f64::from(ways) - 1.0);
            let mut energy = |k: u32| {
                let (x, z) = (at(k), radius - depth + angle * at(k).max(0.0));
                let centre = Vec3::new(x, y + 0.3 * x, z) - terrain.origin_m;
                pressed(&terrain, &mut near, &centre, radius).0
            };
            let energies: Vec<f64> = (0..=ways).map(&mut energy).collect();
            let largest = energies.iter().copied().fold(0.0, f64::max);
            let jump = energies.windows(2).map(|two| (two[1] - two[0]).abs()).fold(0.0, f64::max);
            // a way of 0.25 mm on a spring pressed in by 20 mm, at a slope of up to 0.3
            assert!(jump < 0.01 * largest, "{angle} {y}: {}", jump / largest);
        }
    }
}

/// e = 1 without friction where a tile begins on the faces of another: energy is kept. Up to 0.7 of it came or went.
#[test]
fn elastic_impacts_where_one_sheet_begins_on_another_keep_their_energy() {
    let schemes = [(Scheme::Reference, 1e-8), (Scheme::Adaptive, 0.05), (Scheme::Rigid, 0.05)];
    for angle in [1e-5, 1e-3, 0.02, 0.1] {
        let terrain = rising(angle);
        for (scheme, tolerance_m_s) in schemes {
            for k in 0..24 {
                let random = &mut common::zoo::dice(7, k);
                let x = common::zoo::between(random, -0.02, 0.02);
                let v = [common::zoo::between(random, -3.0, 3.0), 0.3, -5.0];
                let case = Case { scheme, tolerance_m_s, ..elastic(0.5) };
                let z = 1.01 * 0.5 + angle * x.abs();
                let off = (kept(&terrain, &case, [[x, 0.7, z], v]) - 1.0).abs();
                assert!(off < 1e-9, "{scheme:?} {angle} {k}: {off:e}");
            }
        }
    }
}

/// A rock slides over level ground that is there twice in as many steps as over one sheet, about, and without a kick. It took a step
/// for every 0.3 rad of its spring: hundreds of times as many.
#[test]
fn ground_that_is_there_twice_is_slid_over_like_one_sheet() {
    let once = terrain(sheet(-10.0, 3, |_, _| 0.0));
    let twice = welded([sheet(-10.0, 3, |_, _| 0.0), sheet(-10.0, 7, |_, _| 0.0)]);
    for radius in [0.05, 0.2] {
        let case = Case { capture_speed_m_s: None, ..elastic(radius) };
        let start = [[-3.0, 1.234, radius], [5.0, 0.4, 0.0], [0.0; 3]];
        let [one, two] = [&once, &twice].map(|terrain| case.run(terrain, start, 1.2));
        println!("{} {} steps", one.effort.steps, two.effort.steps);
        assert!(two.effort.steps < 5 * one.effort.steps, "{:?} {:?}", one.effort, two.effort);
        assert!((two.end.velocity_m_s - Vec3::new(5.0, 0.4, 0.0)).norm() < 1e-6);
    }
}

/// Level ground of squares of `cell_m`, with one diagonal or the other; `tilt` about y.
fn level(cell_m: f64, other: bool, tilt: f64) -> Vec<Facet> {
    let at = |i: i32, j: i32| {
        let x = cell_m * f64::from(i);
        Vec3::new(x, cell_m * f64::from(j), tilt * x)
    };
    let halves = |i: i32, j: i32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if other { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
    };
    (-20..20).flat_map(|i| (-20..20).flat_map(move |j| halves(i, j))).collect()
}

/// The same corners twice, with other diagonals: a rock rolls over them with the bytes of one sheet. Seams pushed it with some cm/s, and
/// `reference` took up to 100 000 steps a second.
#[test]
fn the_same_corners_with_other_diagonals_are_one_sheet() {
    for cell_m in [0.1, 0.4] {
        let sheets = || [level(cell_m, false, 0.0), level(cell_m, true, 0.0)];
        let once = welded([level(cell_m, false, 0.0), Vec::new()]);
        let twice = [welded(sheets()), terrain(sheets().concat())];
        for scheme in [Scheme::Adaptive, Scheme::Reference, Scheme::Rigid] {
            let tolerance_m_s = if scheme == Scheme::Reference { 1e-8 } else { 0.05 };
            let case = Case { scheme, tolerance_m_s, capture_speed_m_s: None, ..elastic(0.5) };
            let start =
                [[-5.0 * cell_m, 0.3 * cell_m, 0.5], [5.0 * cell_m, 0.4 * cell_m, 0.0], [0.0; 3]];
            let one = case.run(&once, start, 1.0);
            for twice in &twice {
                let two = case.run(twice, start, 1.0);
                assert_eq!(
                    (&two.end, two.effort.steps),
                    (&one.end, one.effort.steps),
                    "{scheme:?}"
                );
            }
        }
    }
}

/// Boxes that land on one of two level sheets, nearer to each other than their corners are round, lie on the upper one and gain nothing. Of two sheets
/// that touch a corner at one point only one had a spring: boxes sank to the lower one with `rigid`, and what the upper one pushed
/// when it came in as a whole threw them up with springs, with up to 175 times their energy.
#[test]
fn blocks_lie_on_the_upper_of_two_sheets() {
    let dir = tempfile::tempdir().unwrap();
    let file = |name: &str, z: f64| {
        write_binary(&dir.path().join(name), &sheet(-10.0, 1, |_, _| z)).unwrap();
    };
    file("lower.stl", 0.0);
    for (scheme, rolling) in
        [("adaptive", 0.0), ("adaptive", 0.3), ("reference", 0.0), ("rigid", 0.0), ("rigid", 0.3)]
    {
        for over_m in [0.001, 0.005, 0.05] {
            file("upper.stl", over_m);
            let text = format!(
                "title = \"t\"\nseed = 1\n[[terrain]]\nmesh = \"lower.stl\"\nground = \"g\"\n[[terrain]]\nmesh = \"upper.stl\"\n\
                 ground = \"g\"\n[grounds.g]\nnormal_stiffness_n_m = 2e9\nshear_stiffness_n_m = 5e8\nfriction_angle_deg = 30.0\n\
                 restitution = 0.0\nrolling_friction = {rolling}\n[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.3\n\
                 [[rocks.shapes]]\nkind = \"box\"\ncorner_radius = 0.2\naxes = [1.5, 1.0, 0.8]\n[release]\ncount = 8\n\
                 height_m = 0.5\nvelocity_m_s = [0.0, 0.0, -3.0]\nspin_rad_s = [1.0, 0.0, 0.0]\npoints_m = [[0.0, 0.0]]\n\
                 [solver]\nscheme = \"{scheme}\"\nlongest_s = 6.0\n"
            );
            let plan = plan_in(dir.path(), &text);
            for fall in falls(&plan) {
                let index = fall.index;
                let height_m = fall.end.position_m.z + plan.terrain.origin_m.z - over_m;
                // half of the smallest side is 0.182 m
                assert!(height_m > 0.1815, "{scheme} {rolling} {over_m} {index}: {height_m}");
                let gained = -fall.ledger.remainder_j / fall.released_j;
                assert!(gained < 1e-3, "{scheme} {rolling} {over_m} {index}: {gained}");
            }
        }
    }
}
