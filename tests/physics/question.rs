//! The question: releases drawn from a scene, and the plan made of it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use rockfall::error::{Error, Result};
use rockfall::plan::{Part, Plan};
use rockfall::release::{Release, Releases};
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::solver::Scheme;
use rockfall::terrain::Terrain;
use rockfall::terrain::make::jittered_plane;
use std::path::Path;

/// A scene on a plane of 40 m; `release` completes its last table, `solver` follows.
fn scene(release: &str, solver: &str) -> Scene {
    let text = format!(
        r#"
        title = "Question"
        seed = 2017
        terrain = [{{ mesh = "plane.stl", ground = "rock" }}]
        [grounds.rock]
        normal_stiffness_n_m = 1e9
        shear_stiffness_n_m = 0.25e9
        friction_angle_deg = {{ uniform = [25.0, 35.0] }}
        restitution = 0.4
        [rocks]
        density_kg_m3 = 2700.0
        radius_m = {{ uniform = [0.2, 0.6] }}
        [release]
        count = 1000
        velocity_m_s = [0.0, 0.0, {{ uniform = [-1.0, 0.0] }}]
        spin_rad_s = [0.0, 0.0, 0.0]
        {release}
        {solver}
        "#
    );
    Scene::parse(&text, Path::new("question.toml")).unwrap()
}

fn plane(angle_deg: f64) -> Terrain {
    common::terrain(jittered_plane(20.0, 8, f64::to_radians(angle_deg)))
}

const L_SHAPE: &str =
    "height_m = 0.5\npolygon_m = [[0, 0], [8, 0], [8, 4], [4, 4], [4, 8], [0, 8]]";

fn drawn(scene: &Scene, terrain: &Terrain, count: usize) -> Vec<Release> {
    let releases = Releases::compile(scene, terrain).unwrap();
    (0..count).map(|i| releases.release(terrain, i).unwrap()).collect()
}

/// Pearson's χ² of counts that should all be equal.
fn chi_square(counts: &[f64]) -> f64 {
    let expected = counts.iter().sum::<f64>() / counts.len() as f64;
    counts.iter().map(|count| (count - expected).powi(2) / expected).sum()
}

/// χ² of k cells has mean k − 1 and standard deviation sqrt(2 (k − 1)); five of them above the mean leave
/// about 1 chance in 10⁴ for an even spread, and a corner drawn twice as often would give thousands.
fn assert_even(counts: &[f64]) {
    let freedom = counts.len() as f64 - 1.0;
    let found = chi_square(counts);
    assert!(found < freedom + 5.0 * (2.0 * freedom).sqrt(), "χ² = {found} over {counts:?}");
}

#[test]
fn releases_are_uniform_over_a_polygon() {
    let terrain = plane(0.0);
    let mut counts = [0.0; 64];
    for release in drawn(&scene(L_SHAPE, ""), &terrain, 9600) {
        let at = release.motion.position_m + terrain.origin_m;
        counts[(at.y as usize) * 8 + at.x as usize] += 1.0;
    }
    let is_inside = |cell: &usize| cell % 8 < 4 || cell / 8 < 4;
    let inside: Vec<f64> = (0..64).filter(is_inside).map(|cell| counts[cell]).collect();
    assert_eq!(inside.len(), 48);
    assert!((inside.iter().sum::<f64>() - 9600.0).abs() < 0.5, "every release lies inside");
    assert_even(&inside);
}

/// Pieces of 3 m and 5 m: evenly along the length, not piece by piece.
#[test]
fn releases_are_uniform_along_a_line() {
    let terrain = plane(0.0);
    let asked = scene("height_m = 0.5\nline_m = [[0, 0], [3, 0], [3, 5]]", "");
    let mut counts = [0.0; 16];
    for release in drawn(&asked, &terrain, 3200) {
        let at = release.motion.position_m + terrain.origin_m;
        assert!(at.y.abs() < 1e-12 || (at.x - 3.0).abs() < 1e-12, "{at} is off the line");
        counts[(2.0 * (at.x + at.y)) as usize] += 1.0;
    }
    assert_even(&counts);
}

/// Rock i is a function of scene, seed and i: alone, backwards, in a larger run.
#[test]
fn a_release_depends_on_no_other() {
    let terrain = plane(0.0);
    let few = scene(L_SHAPE, "");
    let all = drawn(&few, &terrain, 50);
    let mut many = few.clone();
    many.release.count = 1_000_000;
    let releases = Releases::compile(&many, &terrain).unwrap();
    for i in (0..50).rev() {
        assert_eq!(releases.release(&terrain, i).unwrap(), all[i]);
    }
    assert!(all.windows(2).all(|pair| pair[0].motion.position_m != pair[1].motion.position_m));
    let mut other_seed = few.clone();
    other_seed.seed += 1;
    assert!(drawn(&other_seed, &terrain, 1)[0] != all[0]);
}

/// Size, place, start and grounds have streams of their own: fixing one leaves the others alone.
#[test]
fn fixing_the_radius_leaves_the_other_draws_alone() {
    let terrain = plane(0.0);
    let drawn_radius = scene(L_SHAPE, "");
    let mut fixed_radius = drawn_radius.clone();
    fixed_radius.rocks.radius_m = Some(rockfall::random::Distribution::fixed(0.3).unwrap());
    let (some, others) = (drawn(&drawn_radius, &terrain, 20), drawn(&fixed_radius, &terrain, 20));
    for (one, other) in some.iter().zip(&others) {
        assert_eq!(one.motion.position_m.xy(), other.motion.position_m.xy());
        assert_eq!(one.motion.velocity_m_s, other.motion.velocity_m_s);
        assert_eq!(one.grounds, other.grounds);
        assert!(one.rock != other.rock);
    }
}

/// `height_m` is the vertical gap between the lowest point of the rock and the ground below.
#[test]
fn the_gap_is_measured_below_the_lowest_point() {
    let terrain = plane(20.0);
    for Release { rock, motion, .. } in drawn(&scene(L_SHAPE, ""), &terrain, 100) {
        let at = motion.position_m;
        let ground = terrain.ground_below(at.x, at.y).unwrap();
        // heights of some metres: rounding of a few 1e-15
        assert!((at.z - rock.radius_m - ground - 0.5).abs() < 1e-13);
    }
}

/// Points are taken in turn, in map coordinates whatever the meshes' origin.
#[test]
fn points_are_cycled_through() {
    let terrain = plane(0.0);
    let asked = scene("points_m = [[1, 2, 3], [4, 5, 6], [7, 8, 9]]", "");
    let corners = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0), Vec3::new(7.0, 8.0, 9.0)];
    for (i, release) in drawn(&asked, &terrain, 7).iter().enumerate() {
        assert!((release.motion.position_m + terrain.origin_m - corners[i % 3]).norm() < 1e-12);
    }
}

fn message<T: std::fmt::Debug>(result: Result<T>) -> String {
    let error = result.unwrap_err();
    assert!(matches!(error, Error::Input { .. }), "{error}");
    error.to_string()
}

#[test]
fn places_off_the_terrain_are_refused_with_their_coordinates() {
    let terrain = plane(0.0);
    let corner = scene("height_m = 0.5\npolygon_m = [[0, 0], [90, 0], [0, 9]]", "");
    let said = message(Releases::compile(&corner, &terrain));
    assert!(said.contains("[release] polygon_m, entry 2: found no terrain at (90, 0)"), "{said}");
    assert!(said.contains("-20..20 east"), "{said}");
}

/// A rock must start clear of every triangle: below the surface, sunk in from above, or beside a slope
/// whose vertical gap is larger than the distance.
#[test]
fn a_rock_inside_the_ground_is_refused_with_index_and_coordinates() {
    let at = |z: &str| scene(&format!("points_m = [[1, 2, 9], [1, 2, {z}]]"), "");
    let level = plane(0.0);
    let refused = |asked: &Scene, terrain: &Terrain| {
        message(Releases::compile(asked, terrain).and_then(|places| places.release(terrain, 1)))
    };
    let said = refused(&at("0.1"), &level);
    assert!(said.contains("release 1 at (1, 2, 0.1): found it"), "{said}");
    let said = refused(&at("-0.1"), &level);
    assert!(said.contains("under the terrain"), "{said}");
}

/// On 60° the distance to the ground is half the vertical one: a gap below R would put the rock into it, so it is
/// lifted until it just touches, its centre R above the plane along the normal, 2 R above it along the vertical.
#[test]
fn a_rock_over_steep_ground_is_lifted_until_it_touches() {
    let (steep, asked) = (plane(60.0), scene("height_m = 0.1\npoints_m = [[0, 0]]", ""));
    let release = Releases::compile(&asked, &steep).unwrap().release(&steep, 0).unwrap();
    let centre = release.motion.position_m;
    let ground = steep.ground_below(centre.x, centre.y).unwrap();
    assert!((centre.z - ground - 2.0 * release.rock.radius_m).abs() < 1e-12);
}

/// A rock that rests exactly on the ground is clear of it.
#[test]
fn a_rock_that_touches_may_start() {
    let resting = scene("height_m = 0.0\npoints_m = [[1, 2]]", "");
    assert_eq!(drawn(&resting, &plane(0.0), 20).len(), 20);
}

fn plan(release: &str, solver: &str) -> Plan {
    Plan::compile(&scene(release, solver), plane(30.0)).unwrap()
}

/// Numerics may have defaults, and every one of them is printed.
#[test]
fn defaults_are_filled_in_and_listed() {
    let lean = plan(L_SHAPE, "");
    assert_eq!(lean.step.scheme, Scheme::Adaptive);
    let listing = lean.to_string();
    for line in [
        "scheme             adaptive, local error 0.05 m/s",
        "capture speed      0.0439 m/s on rock",
        "stop rule          at rest after 0.3 s below 0.02 m/s in contact; time up after 120 s",
        "trees              left out: the scene has none",
        "flight             leapt over: nothing but gravity acts",
        "rolling friction   left out: no ground has any",
        "roughness          left out: no ground has any",
        "rock against rock  left out: releases are independent",
        "coupled solve      left out: one rock has 6 unknowns",
        "paths              kept for 500 of 1000 releases, every 0.05 s",
        "impacts            left out: not asked for",
        "releases           1000 over an area of 48.0 m², seed 2017",
    ] {
        assert!(listing.contains(line), "no line\n{line}\nin\n{listing}");
    }
    assert!(lean.warnings.is_empty(), "{:?}", lean.warnings);
}

/// Everything this version can keep is kept, and nothing but what is kept changes.
#[test]
fn keeping_everything_leaves_the_question_as_it_is() {
    let lean = plan(L_SHAPE, "[record]\npaths = 0");
    assert!(!lean.paths.is_kept() && !lean.rolling.is_kept());
    let first = lean.release(0).unwrap();
    let full = lean.keep_everything();
    assert!(full.rolling.is_kept() && full.roughness.is_kept());
    assert!(full.trees.is_kept() && full.impacts.is_kept());
    assert!(matches!(full.paths, Part::Kept(paths) if paths.first == full.count));
    assert_eq!(full.release(0).unwrap(), first);
}

/// `dda` without a restitution dissipates by itself; the plan says how much, for small and large rocks.
#[test]
fn the_schemes_own_dissipation_is_printed() {
    let mut asked = scene(L_SHAPE, "[solver]\nscheme = \"dda\"\nstep_s = 1e-4");
    asked.grounds.get_mut("rock").unwrap().restitution = None;
    let plan = Plan::compile(&asked, plane(30.0)).unwrap();
    let [small, _, large] = plan.own_dissipation[0].phases;
    // R = 0.2 m weighs 90.5 kg: ω Δt = sqrt(1e9/90.5) 1e-4; mass grows with R³
    assert!((small.1 - 0.332_454).abs() < 1e-5, "{small:?}");
    assert!((small.1 / large.1 - 27_f64.sqrt()).abs() < 1e-12);
    let listing = plan.to_string();
    assert!(listing.contains("restitution in force"), "{listing}");
    assert!(plan.warnings.iter().any(|warning| warning.contains("omega * step_s = 0.332")));
}

/// Springs too soft to carry a rock are refused with a value that would do; soft ones are warned of.
#[test]
fn soft_springs_are_refused_or_warned_of() {
    let with = |stiffness: f64| {
        let mut asked = scene(L_SHAPE, "");
        let ground = asked.grounds.get_mut("rock").unwrap();
        ground.normal_stiffness_n_m = rockfall::random::Distribution::fixed(stiffness).unwrap();
        Plan::compile(&asked, plane(30.0))
    };
    // R = 0.6 m: 2443 kg; m g/(0.01 R) = 4.0e6 N/m
    let said = message(with(3.9e6));
    assert!(said.contains("[grounds.rock] normal_stiffness_n_m: found 3.9e6"), "{said}");
    // e m v²/(0.1 R)², v² = 2 g (20.6 m) + 1: 1.1e8 N/m
    let sinks = |stiffness| {
        with(stiffness).unwrap().fast_warnings.iter().any(|w| w.text.contains("sink in"))
    };
    assert!(sinks(1e8) && !sinks(1.2e8));
}
