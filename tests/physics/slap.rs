//! A block that lies, tips over its lower edge and slaps down on its next face: what strikes has company that has lasted for long.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::{G, GROUND, terrain};
use nalgebra::Rotation3;
use rockfall::body::{Block, Shape, ShapeKind, Solid, box_surface};
use rockfall::ground::Ground;
use rockfall::plan::{Recorders, RestRule};
use rockfall::random::{Purpose, stream};
use rockfall::release::{DrawnShape, Release};
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{RecordOptions, RunSettings, Scratch, simulate_block};
use rockfall::solver::Scheme;
use rockfall::study::bench::settings;

/// A slope on which a box twice as high as wide just tips over (rad).
const ANGLE: f64 = 0.48;
/// Sides of the box (m): along the slope, across it, and out of it.
const SIDES_M: [f64; 3] = [0.8, 0.8, 1.6];

/// Velocity along and out of the slope (m/s), and spin about the edge (rad/s), before and after the slap.
fn slap(scheme: Scheme, e: f64, friction_angle_rad: f64) -> [[f64; 3]; 2] {
    let (along, up) =
        (Vec3::new(ANGLE.cos(), 0.0, -ANGLE.sin()), Vec3::new(ANGLE.sin(), 0.0, ANGLE.cos()));
    let [a, b, c, d] = [[-9.0, -9.0], [90.0, -9.0], [90.0, 9.0], [-9.0, 9.0]]
        .map(|[x, y]| along * x + Vec3::y() * y);
    let plane = terrain(vec![[a, b, c], [a, c, d]]);
    let solid = Solid::of(&box_surface(SIDES_M));
    let rock = Rock { radius_m: solid.equal_radius(), density_kg_m3: 2700.0 };
    let corners = box_surface(SIDES_M).points;
    let block = Block::new(&Shape::of(&solid, &corners, 0.03).unwrap(), &rock);
    let position_m = up * (block.bound_m + 1e-3) - plane.origin_m;
    let still = Vec3::zeros();
    let motion = Motion { time_s: 0.0, position_m, velocity_m_s: still, spin_rad_s: still };
    let ground = Ground { restitution: Some(e), friction_angle_rad, ..GROUND };
    let release = Release { rock, motion, grounds: vec![ground] };
    let attitude = Rotation3::from_axis_angle(&Vec3::y_axis(), ANGLE);
    let drawn = DrawnShape { kind: ShapeKind::Box, sides: [1.0; 2], block, attitude };
    let step = settings(scheme, 0.01, Some(0.0));
    let course = RunSettings {
        terrain: &plane,
        gravity_m_s2: G,
        step: &step,
        rest: RestRule { speed_m_s: 0.0, time_s: 9.0 },
        longest_s: 6.0,
        recorders: Recorders::default(),
        seed: 1,
    };
    let keep = RecordOptions { path_step_s: Some(1e-3), impacts: false };
    let random = stream(1, Purpose::Impacts, 0);
    let fall = simulate_block(&course, (&release, &drawn), keep, random, &mut Scratch::default());
    let motion = fall.path.iter().map(|point| {
        let (v, w) = (point.motion.velocity_m_s, point.motion.spin_rad_s);
        [v.dot(&along), v.dot(&up), w.y]
    });
    let motion: Vec<[f64; 3]> = motion.collect();
    let slap = (1..motion.len()).find(|k| motion[k - 1][2] > 2.0 && motion[*k][2] < 1.0).unwrap();
    [motion[slap - 2], motion[slap + 1]]
}

/// The edge about which it tips has lasted since it lay flat. Dashpots of that time, and of corners that come down one by one in the looks of a step,
/// made the schemes with springs throw it back with 0.7 of the speed of their limit, and rub it less.
#[test]
fn a_block_that_slaps_down_is_thrown_alike_by_every_scheme() {
    for (e, friction) in [(0.0, 0.75), (0.15, 0.75), (0.3, 0.75), (0.3, 0.9)] {
        let by = |scheme| slap(scheme, e, f64::atan(friction));
        let [before, limit] = by(Scheme::Rigid);
        let size = before[1].abs();
        assert!(size > 1.0, "{before:?}");
        for scheme in [Scheme::Adaptive, Scheme::Reference] {
            let [comes, thrown] = by(scheme);
            for k in 0..3 {
                assert!((comes[k] - before[k]).abs() < 0.02 * size, "{k}: {comes:?} {before:?}");
                assert!((thrown[k] - limit[k]).abs() < 0.02 * size, "{k}: {thrown:?} {limit:?}");
            }
        }
    }
}
