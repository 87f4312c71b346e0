//! The test block of Chant Sura, EOTA221 of 780 kg, beside what was measured and what RAMMS computes: single impacts
//! on a meadow, and the way it rolls down a ramp of 40°.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test prints its table")]

use crate::common;

use common::{GROUND, terrain};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};
use rockfall::body::{Block, Shape, ShapeKind, Solid, eota};
use rockfall::ground::{Ground, Scar, SlipFriction};
use rockfall::plan::{Recorders, RestRule};
use rockfall::random::{Purpose, stream, unit};
use rockfall::release::{DrawnShape, Release};
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{
    PathPoint, PathState, RecordOptions, RunSettings, Scratch, Trajectory, simulate_block,
};
use rockfall::solver::Scheme;
use rockfall::study::bench::settings;
use rockfall::terrain::Terrain;

const G: f64 = 9.81;
/// Slope of the ramp of Leine et al. (2021), and near that of Chant Sura (rad).
const SLOPE: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// 780 kg in 0.93 x 0.93 x 0.47 m: 17/24 of the box (Lu et al. 2019).
const MASS_KG: f64 = 780.0;
const SIDES_M: [f64; 3] = [0.93, 0.93, 0.47];

/// What Lu et al. (2019) use for this meadow: friction "hard", no restitution, the site's mean strength and drag.
const MEADOW: Ground = Ground {
    friction_angle_rad: 0.502_843_210_927_860_8, // atan 0.55
    slip_friction: Some(SlipFriction { most: 2.0, kappa_per_m: 3.0, beta_per_s: 185.0 }),
    scar: Some(Scar { strength_kn_m2: 15e3, drag: 2.5, soil_density_kg_m3: 1700.0 }),
    restitution: Some(0.0),
    ..GROUND
};

/// The six published impacts of Caviezel et al. (2019, tables 1 and 2): translational energy before and after (J).
const IMPACTS_J: [[f64; 2]; 6] = [
    [244_600.0, 53_800.0],
    [109_300.0, 120_800.0],
    [176_000.0, 97_200.0],
    [323_400.0, 135_100.0],
    [192_200.0, 95_300.0],
    [188_200.0, 89_300.0],
];
/// Speed of the centre normal to the ground over speed (–): of the four impacts of this block in Lu et al. (2019), whose normal
/// speeds follow from their Eq. 11 and the depths that it gives, 0.45 to 0.75.
const NORMAL_SHARE: f64 = 0.6;
/// R ω over speed of the same four impacts (–), 0.51 to 0.71.
const ROLLING: f64 = 0.63;

fn ramp(half_m: f64) -> Terrain {
    let along = Vec3::new(SLOPE.cos(), 0.0, -SLOPE.sin());
    let at = |x: f64, y: f64| along * (half_m * x) + Vec3::y() * (half_m * y);
    let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    terrain(vec![[a, b, c], [a, c, d]])
}

/// The block, rounded at a tenth of its radius, with release `index`'s turn.
fn drawn(index: usize) -> (Rock, DrawnShape) {
    let surface = eota(SIDES_M);
    let solid = Solid::of(&surface);
    let rock = Rock { radius_m: solid.equal_radius(), density_kg_m3: MASS_KG / solid.volume };
    let shape = Shape::of(&solid, &surface.points, 0.1).unwrap();
    let block = Block::new(&shape, &rock);
    let mut random = stream(5, Purpose::Shape, index);
    // four normal numbers are a direction in four dimensions: a uniform turn
    let pair = |a: f64, b: f64| {
        let size = (-2.0 * (1.0 - a).ln()).sqrt();
        [size * (std::f64::consts::TAU * b).cos(), size * (std::f64::consts::TAU * b).sin()]
    };
    let [a, b, c, d] = [0; 4].map(|_| unit(&mut random));
    let ([w, x], [y, z]) = (pair(a, b), pair(c, d));
    let attitude: Rotation3<f64> =
        UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).to_rotation_matrix();
    (rock, DrawnShape { kind: ShapeKind::Eota221, sides: [1.0, 0.5], block, attitude })
}

/// Follows the block from a gap above the ramp's place `along_m`.
fn follow(
    (on, ground): (&Terrain, Ground),
    index: usize,
    (along_m, gap_m): (f64, f64),
    [velocity_m_s, spin_rad_s]: [Vec3; 2],
    (longest_s, path_step_s): (f64, f64),
    scratch: &mut Scratch,
) -> Trajectory {
    let (rock, drawn) = drawn(index);
    let (along, up) =
        (Vec3::new(SLOPE.cos(), 0.0, -SLOPE.sin()), Vec3::new(SLOPE.sin(), 0.0, SLOPE.cos()));
    let position_m = along * along_m + up * (drawn.block.bound_m + gap_m) - on.origin_m;
    let motion = Motion { time_s: 0.0, position_m, velocity_m_s, spin_rad_s };
    let release = Release { rock, motion, grounds: vec![ground] };
    let step = settings(Scheme::Rigid, 0.01, None);
    let course = RunSettings {
        terrain: on,
        gravity_m_s2: G,
        step: &step,
        rest: RestRule { speed_m_s: 0.02, time_s: 0.3 },
        longest_s,
        recorders: Recorders::default(),
        seed: 1,
    };
    let keep = RecordOptions { path_step_s: Some(path_step_s), impacts: false };
    let random = stream(5, Purpose::Impacts, index);
    simulate_block(&course, (&release, &drawn), keep, random, scratch)
}

/// The first point from which the block flies for a tenth of a second after it has touched.
fn lift_off(path: &[PathPoint]) -> Option<&PathPoint> {
    let touched = path.iter().position(|point| point.state != PathState::Flight)?;
    let after = &path[touched..];
    let flies = |from: usize| {
        let begun = after[from].motion.time_s;
        let soon = after[from..].iter().take_while(|p| p.motion.time_s < begun + 0.1);
        after[from].state == PathState::Flight && soon.clone().all(|p| p.state == PathState::Flight)
    };
    (0..after.len()).find(|from| flies(*from)).map(|from| &after[from])
}

fn quantile(sorted: &[f64], p: f64) -> f64 {
    sorted[(p * (sorted.len() - 1) as f64).round() as usize]
}

/// Medians over 200 attitudes of translational energy after over before on this soil, impact by impact.
fn medians(mesh: &Terrain, soil: Scar, scratch: &mut Scratch) -> Vec<f64> {
    let (along, up) =
        (Vec3::new(SLOPE.cos(), 0.0, -SLOPE.sin()), Vec3::new(SLOPE.sin(), 0.0, SLOPE.cos()));
    let ground = Ground { scar: Some(soil), ..MEADOW };
    let mut one = |[before_j, after_j]: [f64; 2]| {
        let speed = (2.0 * before_j / MASS_KG).sqrt();
        let velocity = along * (speed * (1.0 - NORMAL_SHARE * NORMAL_SHARE).sqrt())
            - up * (speed * NORMAL_SHARE);
        let mut ratios = Vec::new();
        for index in 0..200 {
            // forwards: about the horizontal across the slope
            let spin = Vec3::y() * (ROLLING * speed / drawn(index).0.radius_m);
            let start = [velocity, spin];
            let fall = follow((mesh, ground), index, (0.0, 0.0), start, (1.5, 0.005), scratch);
            let off = lift_off(&fall.path);
            ratios.extend(off.map(|p| p.motion.velocity_m_s.norm_squared() / (speed * speed)));
        }
        ratios.sort_by(f64::total_cmp);
        let [low, middle, high] = [0.05, 0.5, 0.95].map(|p| quantile(&ratios, p));
        println!(
            "{speed:.1} m/s: measured {:.2}, computed {middle:.2} (90 % of attitudes {low:.2} to {high:.2}, {} lift off)",
            after_j / before_j,
            ratios.len()
        );
        middle
    };
    IMPACTS_J.into_iter().map(&mut one).collect()
}

/// One strength and drag for all six, within the ranges of single impacts in Lu et al. (2019): the medians lie within 0.21 to
/// 0.55, as five of the six published ratios do, for at least five of the six speeds. The sixth gained energy (1.11).
#[test]
fn impacts_on_the_meadow_take_what_was_measured() {
    let (mesh, mut scratch) = (ramp(60.0), Scratch::default());
    let mut best = 0;
    for (strength_kn_m2, drag) in [(15e3, 2.5), (25e3, 2.5), (15e3, 1.5), (25e3, 1.5)] {
        let soil = Scar { strength_kn_m2, drag, soil_density_kg_m3: 1700.0 };
        let medians = medians(&mesh, soil, &mut scratch);
        let within = medians.iter().filter(|ratio| (0.21..=0.55).contains(*ratio)).count();
        println!("{strength_kn_m2} kN/m², drag {drag}: {within} of 6");
        best = best.max(within);
    }
    assert!(best >= 5, "{best} of 6");
}

/// Down a ramp of 40°, from random attitudes: it rolls with R ω/v of 0.6 to 0.8, as RAMMS has it (0.69). Soil and length of its
/// ramp are not printed, so the other figures stand beside it only.
#[test]
fn the_wheel_rolls_down_the_ramp_as_published() {
    let (mesh, mut scratch) = (ramp(120.0), Scratch::default());
    let mut sums = [[0.0f64; 2]; 4];
    let (mut points, radius_m) = (0.0, drawn(0).0.radius_m);
    for index in 0..150 {
        let still = [Vec3::zeros(); 2];
        let fall = follow((&mesh, MEADOW), index, (-110.0, 0.5), still, (60.0, 0.05), &mut scratch);
        for point in &fall.path {
            let (v, w) = (point.motion.velocity_m_s.norm(), point.motion.spin_rad_s.norm());
            let values = [
                v,
                w / std::f64::consts::TAU,
                point.clearance_m.max(0.0),
                0.5e-3 * MASS_KG * v * v,
            ];
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum = [sum[0] + value, sum[1] + value * value];
            }
            points += 1.0;
        }
    }
    let mean_sd = sums.map(|[one, two]| {
        let mean = one / points;
        (mean, (two / points - mean * mean).sqrt())
    });
    let rolling = radius_m * std::f64::consts::TAU * mean_sd[1].0 / mean_sd[0].0;
    println!(
        "speed (m/s), spin (rev/s), height (m), energy (kJ): {mean_sd:.2?}; R ω/v {rolling:.3}"
    );
    assert!((0.6..=0.8).contains(&rolling), "{rolling}");
}
