//! Blocks at their ends: flat, slender, small and large beside the triangles, fast, elastic, rough.

use super::bounds::DIGITS;
use super::impacts::floor;
use super::{Notes, SchemeSetting, sprung};
use crate::ground::Ground;
use crate::math;
use crate::rock::Vec3;
use crate::simulation::{Stop, Trajectory};
use crate::solver::CORNER_WAY;
use crate::study::bench::{
    BlockForm, GRAVITY_M_S2, GROUND, MadeBlock, SETUP, Setup, terrain, with_springs,
};
use crate::study::cases::meshes::{bumpy, fold};
use crate::terrain::Terrain;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};

/// Radius of the balls over the shortest side (–).
const BALL: f64 = 0.05;

/// A box with these sides (m), turned by no simple angle, its ball around it `gap_m` above z = 0.
fn boxed(sides_m: [f64; 3], gap_m: f64) -> Setup {
    let form = BlockForm::Box(sides_m);
    let shortest = sides_m.into_iter().fold(f64::INFINITY, f64::min);
    let attitude = math::turn(&Vec3::x_axis(), 0.7) * math::turn(&Vec3::y_axis(), 0.4);
    let half = Vec3::from(sides_m).norm() / 2.0;
    Setup {
        rock: form.rock(),
        block: Some(MadeBlock { form, ball_m: BALL * shortest, attitude }),
        centre_m: Vec3::new(0.03, 0.02, half + gap_m),
        ..SETUP
    }
}

/// Springs are so stiff that the fastest impact of a case presses them in by about this share of the balls' radius (–) …
const PRESSED: f64 = 0.03;
/// … and a fixed step is so much of their `1/√(p_N/m)` (rad), of which there are about so many.
const PHASE: f64 = 0.3;
const STEPS: f64 = 4000.0;
/// Points of a path, at most: three to an impact, or as many as there are of these.
const POINTS: f64 = 2e5;

/// A case in which nothing strikes faster than `speed_m_s`, as a scheme can follow it: the rigid limit has no springs.
fn followed(way: &SchemeSetting, setup: &Setup, speed_m_s: f64) -> (SchemeSetting, Setup) {
    let ball_m = setup.block.map_or(setup.rock.radius_m, |block| block.ball_m);
    let omega = speed_m_s / (PRESSED * ball_m);
    let normal_stiffness_n_m = setup.rock.mass_kg() * omega * omega;
    // an impact must not fall between the points of a path, where one is asked for
    let path_step_s = setup.path_step_s.map(|_| (1.0 / omega).max(setup.longest_s / POINTS));
    let ground = with_springs(setup.ground, normal_stiffness_n_m);
    let stiff = Setup { ground, path_step_s, ..*setup };
    if !way.scheme.has_fixed_step() {
        return (*way, stiff);
    }
    let fineness = way.fineness.min(PHASE / omega);
    // the first touch comes when the centre is at the ground at the latest
    let before_s = (setup.centre_m.z / -setup.velocity_m_s.z).max(0.0);
    let longest_s = setup.longest_s.min(before_s + STEPS * fineness);
    (SchemeSetting { fineness, ..*way }, Setup { longest_s, ..stiff })
}

/// How deep under z = 0 the lowest of its balls was on a kept path (m); no number without a block.
fn sunk_m(setup: &Setup, journey: &Trajectory, on: &Terrain) -> f64 {
    let Some(made) = setup.block else { return f64::NAN };
    let block = made.drawn(&setup.rock).block;
    let depths = journey.path.iter().map(|point| {
        let [w, x, y, z] = point.attitude.unwrap_or([f64::NAN; 4]);
        let turn = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
        let down = turn.inverse() * -Vec3::z();
        block.support_m(&down) - (point.motion.position_m.z + on.origin_m.z)
    });
    depths.fold(f64::NEG_INFINITY, f64::max)
}

/// How deep a ball may be (m) where nothing strikes faster than `speed_m_s`.
///
/// A corner presses its spring in by no more than `v/ω` and twice the weight: less than the block's mass moves with it. A fixed
/// step sees it `PHASE` of `v/ω` too late. The rigid limit brings corners to the surface in the middle of a step, from which
/// they go on for half of that.
fn may_sink_m(way: &SchemeSetting, setup: &Setup, speed_m_s: f64) -> f64 {
    if !sprung(way) {
        return 0.5 * CORNER_WAY * setup.block.map_or(f64::NAN, |block| block.ball_m);
    }
    let late = if way.scheme.has_fixed_step() { PHASE } else { 0.0 };
    (1.0 + late) * speed_m_s / setup.omega() + 2.0 * setup.pressed_m(0.0)
}

/// From a cube to a sheet and to a needle: none sinks in, all come to rest as flat as they are.
pub(super) fn flat(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let slender = [[1.0, 1.0, 0.1], [1.0, 1.0, 0.01], [1.0, 0.1, 0.1], [1.0, 0.01, 0.01], [1.0; 3]];
    for sides_m in slender {
        // forty thousand steps thrown away
        let is_needle = sides_m[1] < 0.05;
        if is_needle && way.scheme.of([false, false, true, false]) {
            continue;
        }
        let shortest = sides_m.into_iter().fold(f64::INFINITY, f64::min);
        let setup = Setup {
            velocity_m_s: Vec3::new(1.0, 0.5, -2.0),
            spin_rad_s: Vec3::new(3.0, -2.0, 1.0),
            longest_s: 30.0,
            rest_time_s: 0.3,
            path_step_s: Some(0.01),
            ..boxed(sides_m, 0.2)
        };
        let setting = format!("{sides_m:?} m");
        let fastest = 8.0;
        let (way, setup) = &followed(way, &setup, fastest);
        let journey = notes.follow(way, &setting, setup, &floor);
        let (sunk, deep) = (sunk_m(setup, &journey, &floor), may_sink_m(way, setup, fastest));
        notes.hold(way, &setting, "sinks in (m)", sunk, deep);
        // a fixed step cannot leap over rest
        if way.scheme.has_fixed_step() {
            continue;
        }
        let stirs = f64::from(u8::from(journey.stop != Stop::AtRest));
        notes.hold(way, &setting, "does not come to rest (0 = no)", stirs, 0.0);
        let lies = (journey.end.position_m.z - 0.5 * shortest).abs();
        // all of the weight on one of its corners
        let pressed = if sprung(way) { setup.pressed_m(0.0) } else { deep };
        notes.hold(
            way,
            &setting,
            "height of the centre at rest off that of a face (m)",
            lies,
            pressed,
        );
    }
}

/// A block of a tenth of a millimetre on triangles of 10 km, and one of 10 m on triangles of a decimetre: sizes over sides
/// of triangles are 1 : 1e8 and 100 : 1; with springs 10 : 1, in `reference` none so large.
pub(super) fn sizes(way: &SchemeSetting, notes: &mut Notes) {
    let wide = terrain(crate::terrain::make::jittered_plane(1e4, 1, 0.0));
    // with springs hundreds of contacts would press at once for a thousand steps, with the finest dozens too many
    let coarse = Some((30, 1.0, 1e-2));
    let rough = way.scheme.of([coarse, coarse, None, Some((300, 0.1, 1e-3))]);
    let rough = rough.map(|(cells, cell_m, noise_m)| {
        (terrain(bumpy(cells, cell_m, noise_m)), format!("10 m on {cell_m} m"))
    });
    let large = rough.iter().map(|(on, setting)| (10.0, on, setting.as_str()));
    let small = [(1e-4, &wide, "0.1 mm on 10 km"), (0.1, &wide, "0.1 m on 10 km")];
    for (size_m, on, setting) in small.into_iter().chain(large) {
        let speed = (GRAVITY_M_S2 * size_m).sqrt();
        let setup = Setup {
            velocity_m_s: Vec3::new(0.2 * speed, 0.0, -speed),
            spin_rad_s: Vec3::new(0.3, -1.0, 0.2) * (speed / size_m),
            longest_s: 3.0 * size_m / speed,
            path_step_s: Some(0.02 * size_m / speed),
            ..boxed([size_m, 0.8 * size_m, 0.5 * size_m], 0.1 * size_m)
        };
        let fastest = 3.0 * speed;
        let (way, setup) = &followed(way, &setup, fastest);
        let journey = notes.follow(way, setting, setup, on);
        let (sunk, deep) = (sunk_m(setup, &journey, on), may_sink_m(way, setup, fastest));
        notes.hold(way, setting, "sinks in (m)", sunk, deep);
        let struck = f64::from(u8::from(journey.impact_count == 0));
        notes.hold(way, setting, "strikes nothing (0 = no)", struck, 0.0);
    }
}

/// e = 1 without friction keeps all energy, from a level to a narrow valley, of every shape. Left out with `reference`, whose errors go up as
/// well as down: 8e-9 of the energy up in these two seconds, where all else
/// keeps [`DIGITS`].
pub(super) fn elastic(way: &SchemeSetting, notes: &mut Notes) {
    if way.scheme.of([false, false, true, false]) {
        return;
    }
    let ground = Ground { friction_angle_rad: 0.0, restitution: Some(1.0), ..GROUND };
    let grounds = [
        ("level", floor()),
        ("valley 0.2 rad", terrain(fold(0.2, 20.0))),
        ("valley 2 rad", terrain(fold(2.0, 20.0))),
        ("uneven", terrain(bumpy(40, 0.5, 0.05))),
    ];
    for sides_m in [[1.0; 3], [1.0, 0.8, 0.1], [1.0, 0.1, 0.1]] {
        for (name, on) in &grounds {
            let setup = Setup {
                ground,
                velocity_m_s: Vec3::new(0.4, 0.2, -3.0),
                spin_rad_s: Vec3::new(1.0, -2.0, 0.5),
                longest_s: 2.0,
                ..boxed(sides_m, 1.5)
            };
            let setting = format!("{sides_m:?} m, {name}");
            let (way, setup) = &followed(way, &setup, 8.0);
            let journey = notes.follow_captured(way, &setting, setup, on, Some(0.0));
            // the fixed step damps: a fifth of the speed at `PHASE`; it is held to gain nothing
            if way.scheme.has_fixed_step() {
                continue;
            }
            let ledger = &journey.ledger;
            let spent = ledger.friction_j + ledger.damping_j + ledger.remainder_j.abs();
            let scale = journey.extremes.total_j;
            let law = "energy lost or gained where nothing takes any, over all";
            // an impact that takes nothing is given the energy that it had
            notes.hold(way, &setting, law, spent / scale, DIGITS);
        }
    }
}

/// 100 m/s onto a single layer of triangles, a plate edge on and spinning fast: on its side it stays.
pub(super) fn fast(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    for (setting, v, spin) in [
        ("upright", Vec3::new(0.0, 0.0, -100.0), Vec3::zeros()),
        ("grazing at 0.1°", Vec3::new(100.0, 0.0, -0.175), Vec3::zeros()),
        ("spinning at 1000 rad/s", Vec3::new(10.0, 0.0, -10.0), Vec3::new(900.0, 300.0, -300.0)),
    ] {
        for e in [0.0, 1.0] {
            let setup = Setup {
                ground: Ground { restitution: Some(e), ..GROUND },
                velocity_m_s: v,
                spin_rad_s: spin,
                longest_s: 0.2,
                path_step_s: Some(1e-3),
                ..boxed([1.0, 1.0, 0.05], 0.05)
            };
            let setup = Setup { centre_m: setup.centre_m - Vec3::x() * 20.0, ..setup };
            let setting = format!("{setting}, e {e}");
            // the speeds of corners
            let fastest = v.norm() + 0.7 * spin.norm();
            let (way, setup) = &followed(way, &setup, fastest);
            let journey = notes.follow(way, &setting, setup, &floor);
            let (sunk, deep) = (sunk_m(setup, &journey, &floor), may_sink_m(way, setup, fastest));
            notes.hold(way, &setting, "sinks in (m)", sunk, deep);
        }
    }
}

/// Friction from 0 to 89° and restitution from 0 to 1 under a tilted plate that skids: nothing gains or sinks in, whatever the pair, also
/// where rigid slip has no solution (Painlevé).
pub(super) fn friction(way: &SchemeSetting, notes: &mut Notes) {
    let (floor, sides_m) = (floor(), [1.0, 0.5, 0.1]);
    for friction in [0.0, 30.0, 60.0, 89.0f64] {
        for e in [0.0, 0.5, 1.0] {
            for lean in [0.3, 1.0, 1.5] {
                let flat = boxed(sides_m, 0.0);
                let attitude: Rotation3<f64> = math::turn(&Vec3::y_axis(), lean);
                let block = flat.block.map(|block| MadeBlock { attitude, ..block });
                let setup = Setup {
                    block,
                    ground: Ground {
                        friction_angle_rad: friction.to_radians(),
                        restitution: Some(e),
                        ..GROUND
                    },
                    velocity_m_s: Vec3::new(8.0, 0.0, -1.0),
                    longest_s: 1.0,
                    path_step_s: Some(0.01),
                    ..flat
                };
                let fastest = 8.0;
                let (way, setup) = &followed(way, &setup, fastest);
                let setting = format!("friction {friction}°, e {e}, leaning {lean} rad");
                let journey = notes.follow(way, &setting, setup, &floor);
                let deep = may_sink_m(way, setup, fastest);
                notes.hold(way, &setting, "sinks in (m)", sunk_m(setup, &journey, &floor), deep);
            }
        }
    }
}
