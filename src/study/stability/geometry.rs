//! Meshes that are awkward: edges, corners, walls, slivers, seams, far away.

use super::bounds::{DIGITS, rests_within, strikes_within};
use super::{Notes, SchemeSetting, sprung};
use crate::math;
use crate::rock::{Rock, Vec3};
use crate::simulation::{Stop, Trajectory};
use crate::study::bench::{GRAVITY_M_S2, ROCK, SETUP, Setup, terrain};
use crate::terrain::stl::Facet;
use crate::terrain::{Terrain, make};

fn square(corner: Vec3, a: Vec3, b: Vec3) -> Vec<Facet> {
    vec![[corner, corner + a, corner + a + b], [corner, corner + a + b, corner + b]]
}

/// A rock that falls 0.5 m and drifts, from above the origin, followed for 1.5 s.
fn dropped() -> Setup {
    Setup {
        centre_m: Vec3::new(0.1, 0.2, 1.0),
        velocity_m_s: Vec3::new(0.5, 0.2, 0.0),
        longest_s: 1.5,
        ..SETUP
    }
}

/// Dropped exactly onto an edge and onto a corner: it goes down a flank, and no energy comes from nowhere.
pub(super) fn edge_and_corner(way: &SchemeSetting, notes: &mut Notes) {
    let above = Setup { centre_m: Vec3::new(0.0, 0.0, 1.0), longest_s: 0.6, ..SETUP };
    let watched = Setup { path_step_s: Some(2e-4), ..above };
    let deep = strikes_within(way, &above, (2.0 * GRAVITY_M_S2 * 0.5).sqrt());
    let roof = terrain(make::ridge(4.0, 1.0));
    let edge = deepest_m(&notes.follow(way, "edge", &watched, &roof), &roof);
    notes.hold(way, "edge", "deeper than the edge allows (m)", edge, deep);
    // level: on the seam of two triangles, and on a corner where six meet
    let planes = [false, true].map(|has_corner| terrain(level(has_corner)));
    for (setting, plane) in ["seam of a plane", "corner in a plane"].into_iter().zip(&planes) {
        let end = notes.follow(way, setting, &above, plane).end;
        let sideways = math::hypot(end.position_m.x, end.position_m.y)
            + math::hypot(end.velocity_m_s.x, end.velocity_m_s.y);
        notes.hold(way, setting, "sideways (m, m/s)", sideways, DIGITS);
    }
    let tip = terrain(make::tetrahedron(6.0));
    let corner = deepest_m(&notes.follow(way, "corner", &watched, &tip), &tip);
    notes.hold(way, "corner", "deeper than the corner allows (m)", corner, deep);
}

/// How deep the origin has been in a rock on its kept path (m).
fn deepest_m(journey: &Trajectory, on: &Terrain) -> f64 {
    let nearest = journey.path.iter().map(|point| (point.motion.position_m + on.origin_m).norm());
    journey.rock.radius_m - nearest.fold(f64::INFINITY, f64::min)
}

/// A level square, split along the diagonal through the origin, or four of them about it.
fn level(has_corner: bool) -> Vec<Facet> {
    let (x, y) = (Vec3::x() * 4.0, Vec3::y() * 4.0);
    if !has_corner {
        return square(-(x + y) * 0.5, x, y);
    }
    let squares = [-(x + y), -x, -y, Vec3::zeros()].map(|corner| square(corner, x, y));
    squares.concat()
}

/// Between upright walls that press it from both sides by `s`: friction `2 μ p_N s` holds it, or it slides with
/// `g − 2 μ p_N s/m`. Springs only: for the rigid limit it must not be thrown out.
pub(super) fn parallel_walls(way: &SchemeSetting, notes: &mut Notes) {
    for (setting, s) in [("slides", 1e-5), ("stays", 2e-5)] {
        let half = SETUP.rock.radius_m - s;
        let wall = |x: f64| square(Vec3::new(x, -5.0, -5.0), Vec3::y() * 10.0, Vec3::z() * 10.0);
        let walls = terrain([wall(-half), wall(half)].concat());
        let setup = Setup { longest_s: 0.3, ..SETUP };
        let end = notes.follow(way, setting, &setup, &walls).end;
        if !sprung(way) {
            notes.hold(way, setting, "thrown sideways (m)", end.position_m.x.abs(), 2.0 * s);
            continue;
        }
        let mu = math::tan(SETUP.ground.friction_angle_rad);
        let held = 2.0 * mu * SETUP.ground.normal_stiffness_n_m * s / SETUP.rock.mass_kg();
        let way_m = 0.5 * (GRAVITY_M_S2 - held).max(0.0) * setup.longest_s.powi(2);
        // friction takes up to a millisecond to build up: until then it falls freely
        let bound = GRAVITY_M_S2 * 1e-3 * setup.longest_s;
        notes.hold(
            way,
            setting,
            "fall off the expected one (m)",
            (-end.position_m.z - way_m).abs(),
            bound,
        );
    }
}

/// At rest on the two borders of a groove narrower than itself: `sin a` = half width/R.
pub(super) fn narrow_groove(way: &SchemeSetting, notes: &mut Notes) {
    let half = 0.3;
    let plate =
        |x: f64, out: f64| square(Vec3::new(x, -5.0, 0.0), Vec3::x() * out, Vec3::y() * 10.0);
    let rails = terrain([plate(-half, -5.0), plate(half, 5.0)].concat());
    let height = (0.25f64 - half * half).sqrt();
    let setup = Setup { centre_m: Vec3::new(0.0, 0.1, height), ..SETUP };
    let end = notes.follow(way, "", &setup, &rails).end;
    // both springs of both contacts share the load: p_N along the normal, p_s = p_N/4 across
    let (cos2, sin2) = (height * height / 0.25, half * half / 0.25);
    let sinks = if sprung(way) { setup.pressed_m(0.0) / (2.0 * (cos2 + 0.25 * sin2)) } else { 0.0 };
    // the borders turn about it as it sinks: the square of that is left out
    let bound = 2.0 * sinks * sinks / height + DIGITS;
    notes.hold(
        way,
        "",
        "height off √(R² − b²) less what the springs give (m)",
        (end.position_m.z - height + sinks).abs(),
        bound,
    );
}

/// Triangles without area, slivers, doubles: the same journey as without them.
pub(super) fn degenerate(way: &SchemeSetting, notes: &mut Notes) {
    let clean = make::jittered_plane(10.0, 6, 0.0);
    let mut dirty = clean.clone();
    let [a, b, c] = clean[20];
    dirty.extend([[a, a, b], [a, a + (b - a) * 0.5, b], [a, b, c], [c, b, a]]);
    dirty.push([a, b, a + (b - a) * 0.5 + (c - a) * 1e-9]);
    let [clean, dirty] = [clean, dirty].map(terrain);
    let first = notes.follow(way, "clean", &dropped(), &clean).end;
    let second = notes.follow(way, "with slivers and doubles", &dropped(), &dirty).end;
    let off = (first.position_m - second.position_m).norm();
    notes.hold(way, "", "end moved (m)", off, DIGITS);
}

/// All triangles the other way round: the same bits.
pub(super) fn flipped(way: &SchemeSetting, notes: &mut Notes) {
    let facets = make::natural_slope(30, 40).facets;
    let setup = Setup { centre_m: Vec3::new(150.0, 150.0, 130.0), longest_s: 8.0, ..SETUP };
    let inside_out = facets.iter().map(|&[a, b, c]| [c, b, a]).collect();
    let first = notes.follow(way, "as it is", &setup, &terrain(facets)).end;
    let second = notes.follow(way, "inside out", &setup, &terrain(inside_out)).end;
    let off = (first.position_m - second.position_m).norm();
    // the same surface in another order of corners: rounding of places, which each of four impacts makes ten times as large
    let rounded = f64::EPSILON * setup.centre_m.norm();
    notes.hold(way, "", "end moved (m)", off, 1e4 * rounded);
}

/// Two sheets that run through each other at 10°: a rock rolls into the wedge between them and stays above both.
pub(super) fn conflicting_sheets(way: &SchemeSetting, notes: &mut Notes) {
    let tilt = 10f64.to_radians();
    let both = [make::jittered_plane(8.0, 3, 0.0), make::jittered_plane(8.0, 3, tilt)].concat();
    let setup = Setup {
        centre_m: Vec3::new(0.1, 3.0, 0.52),
        velocity_m_s: Vec3::new(0.0, -4.0, 0.0),
        longest_s: 3.0,
        ..SETUP
    };
    let end = notes.follow(way, "", &setup, &terrain(both)).end.position_m;
    let over_tilted = end.z * math::cos(tilt) + end.y * math::sin(tilt);
    notes.hold(
        way,
        "",
        "depth in one of the sheets (m)",
        0.5 - end.z.min(over_tilted),
        rests_within(way, &setup),
    );
}

/// A thousand kilometres away: the same journey, as far as coordinates there have digits.
pub(super) fn offset(way: &SchemeSetting, notes: &mut Notes) {
    let here = make::jittered_plane(10.0, 6, 0.2);
    let far = Vec3::new(1e6, -1e6, 1e3);
    let there = here.iter().map(|facet| facet.map(|corner| corner + far)).collect();
    let setup = dropped();
    let moved = Setup { centre_m: setup.centre_m + far, ..setup };
    let first = notes.follow(way, "here", &setup, &terrain(here)).end.position_m;
    let second = notes.follow(way, "there", &moved, &terrain(there)).end.position_m;
    // corners and places are rounded there; a few impacts multiply that
    let bound = 4.0 * f64::EPSILON * far.norm();
    notes.hold(way, "", "end moved (m)", (second - far - first).norm(), bound);
}

/// A boulder of 10 m on triangles of 0.1 m.
pub(super) fn small_triangles(way: &SchemeSetting, notes: &mut Notes) {
    let ground = terrain(make::jittered_plane(12.0, 200, 0.0));
    let rock = Rock { radius_m: 10.0, ..ROCK };
    let mut setup = Setup { rock, centre_m: Vec3::new(0.1, 0.2, 10.5), longest_s: 0.5, ..SETUP };
    setup.ground.normal_stiffness_n_m = 1e11;
    setup.ground.shear_stiffness_n_m = 0.25e11;
    let end = notes.follow(way, "", &setup, &ground).end;
    notes.hold(
        way,
        "",
        "sideways (m)",
        math::hypot(end.position_m.x - 0.1, end.position_m.y - 0.2),
        DIGITS,
    );
}

/// A single triangle: hit and left behind, or missed.
pub(super) fn one_triangle(way: &SchemeSetting, notes: &mut Notes) {
    let facet = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let lone = terrain(vec![facet]);
    let setup = Setup {
        centre_m: Vec3::new(0.0, 0.0, 1.5),
        velocity_m_s: Vec3::new(3.0, 0.0, 0.0),
        longest_s: 20.0,
        ..SETUP
    };
    for (setting, x) in [("hit", -1.5), ("missed", 1.6)] {
        let setup = Setup { centre_m: Vec3::new(x, 0.0, 1.0), ..setup };
        let stop = notes.follow(way, setting, &setup, &lone).stop;
        notes.hold(
            way,
            setting,
            "leaves the terrain (0 = yes)",
            f64::from(u8::from(stop != Stop::LeftTerrain)),
            0.0,
        );
    }
    let on_it = Setup { centre_m: Vec3::new(0.0, 0.0, 0.6), velocity_m_s: Vec3::zeros(), ..setup };
    let end = notes.follow(way, "dropped on it", &on_it, &lone).end;
    let deep = setup.rock.radius_m - end.position_m.z;
    notes.hold(way, "dropped on it", "rests within 2 m g/p_N (m)", deep, rests_within(way, &setup));
}
