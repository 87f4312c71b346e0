//! One rock, one plane: stiffness, size, speed, restitution, friction to their ends.

use super::{Notes, SchemeSetting, sprung};
use crate::ground::{Ground, damping_ratio, normal_impact};
use crate::math;
use crate::rock::{Rock, Vec3};
use crate::simulation::Trajectory;
use crate::study::bench::{GRAVITY_M_S2, GROUND, ROCK, SETUP, Setup, terrain, with_springs};
use crate::terrain::Terrain;
use crate::terrain::make;

/// Contact oscillation per step (rad) below which a fixed step resolves an impact.
const RESOLVED: f64 = 0.1;

/// A level square of two triangles.
pub(super) fn floor() -> Terrain {
    terrain(make::jittered_plane(50.0, 1, 0.0))
}

/// A rock that touches the floor of [`floor`] and moves with `v`.
fn touching(v: Vec3) -> Setup {
    Setup { centre_m: Vec3::new(0.3, 0.2, SETUP.rock.radius_m), velocity_m_s: v, ..SETUP }
}

/// Stiffness × radius × speed: the rebound is that of the closed form with gravity, or none where the rock is captured.
pub(super) fn impact(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    for stiffness in [1e3, 1e6, 1e9, 1e12, 1e14] {
        for radius in [1e-3, 0.1, 10.0] {
            for speed in [0.01, 1.0, 100.0] {
                one_impact(way, notes, &floor, [stiffness, radius, speed]);
            }
        }
    }
}

fn one_impact(
    way: &SchemeSetting,
    notes: &mut Notes,
    floor: &Terrain,
    [stiffness, radius, speed]: [f64; 3],
) {
    let rock = Rock { radius_m: radius, ..ROCK };
    let ground = with_springs(GROUND, stiffness);
    let (mass, omega) = (rock.mass_kg(), (stiffness / rock.mass_kg()).sqrt());
    let depth = 0.5f64.sqrt() * speed / omega + mass * GRAVITY_M_S2 / stiffness;
    // the plan refuses springs that soft, and the rigid limit has none
    let is_meant =
        if sprung(way) { depth <= 0.1 * radius } else { (stiffness / 1e9 - 1.0).abs() < 1e-12 };
    if !is_meant {
        return;
    }
    // long enough for a rebound, too short to come down again
    let lasts = if sprung(way) { 4.0 / omega } else { 0.01 * speed / GRAVITY_M_S2 };
    let setup = Setup {
        rock,
        ground,
        centre_m: Vec3::new(0.3, 0.2, radius),
        velocity_m_s: Vec3::new(0.0, 0.0, -speed),
        longest_s: lasts,
        path_step_s: Some(lasts / 200.0),
        ..SETUP
    };
    let setting = format!("{stiffness:.0e} N/m, R {radius} m, {speed} m/s");
    let journey = notes.follow(way, &setting, &setup, floor);
    if sprung(way) {
        let points = journey.path.iter().map(|point| point.motion.position_m.z);
        let lowest = points.fold(f64::INFINITY, f64::min) + floor.origin_m.z;
        let law = "depth (m) within twice √e v/ω + m g/p_N";
        notes.hold(way, &setting, law, radius - lowest, 2.0 * depth + 1e-9 * radius);
    }
    let rebound = rebound_m_s(&journey, &setup) / speed;
    let phase = way.fineness * omega;
    if way.scheme.has_fixed_step() && phase > RESOLVED {
        notes.hold(way, &setting, "rebound over speed, at most 1", rebound, 1.0);
        return;
    }
    let exact = normal_impact(speed, omega, damping_ratio(0.5), GRAVITY_M_S2).rebound_m_s;
    let (law, off, allowed) = match exact {
        None if !sprung(way) => ("captured: no rebound", rebound, 0.0),
        Some(_) if !sprung(way) && speed < 0.02 => ("captured: no rebound", rebound, 0.0),
        Some(_) if !sprung(way) => ("rebound over speed is e", (rebound - 0.5).abs(), 1e-9),
        // captured: the springs may still swing it
        None => ("captured: no more than the rebound of e", rebound, 0.5),
        Some(_) if speed <= way_capture(way) => {
            ("captured: no more than the rebound of e", rebound, 0.5)
        }
        Some(out) => {
            let relative = way.fineness / speed;
            let fine = way.scheme.of([phase, 2.0 * relative, 100.0 * relative, 0.0]);
            let off = (rebound - out / speed).abs();
            ("rebound over speed is that of the closed form", off, fine + 1e-3)
        }
    };
    notes.hold(way, &setting, law, off, allowed);
}

/// Speed of an upward motion at the level of the touch, by energy; 0 where it does not get there (m/s).
pub(super) fn rebound_m_s(journey: &Trajectory, setup: &Setup) -> f64 {
    let end = &journey.end;
    let rise = end.position_m.z - setup.rock.radius_m;
    let square = end.velocity_m_s.z.powi(2) + 2.0 * setup.gravity_m_s2 * rise;
    if end.velocity_m_s.z.is_nan() {
        return f64::NAN;
    }
    if end.velocity_m_s.z > 0.0 { square.max(0.0).sqrt() } else { 0.0 }
}

/// The speed (m/s) up to which numerics may capture an impact.
fn way_capture(way: &SchemeSetting) -> f64 {
    way.scheme.of([0.02, way.fineness, 0.02, 0.02])
}

/// 100 m/s onto a single layer of triangles, upright and at 0.1°: on its side it stays.
pub(super) fn thin_sheet(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    for (setting, v) in [
        ("upright", Vec3::new(0.0, 0.0, -100.0)),
        ("at 45°", Vec3::new(70.0, 0.0, -70.0)),
        ("grazing at 0.1°", Vec3::new(100.0, 0.0, -0.175)),
    ] {
        let setup = Setup {
            centre_m: Vec3::new(-20.0, 0.2, 0.6),
            velocity_m_s: v,
            longest_s: 0.3,
            path_step_s: Some(1e-3),
            ..SETUP
        };
        let journey = notes.follow(way, setting, &setup, &floor);
        let lowest = journey
            .path
            .iter()
            .map(|point| point.motion.position_m.z)
            .fold(f64::INFINITY, f64::min);
        let depth = SETUP.rock.radius_m - (lowest + floor.origin_m.z);
        // it falls another 0.1 m first
        let bound = math::hypot(v.z, (0.2 * GRAVITY_M_S2).sqrt()) / 841.0 + 3e-5;
        notes.hold(way, setting, "depth (m) within v_n/ω + 2 m g/p_N", depth, bound);
    }
}

/// Starts with a gap of nothing: inwards, outwards, along, at rest, and 1e-17 m too deep.
pub(super) fn zero_gap(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    for (setting, v, gap) in [
        ("inwards", Vec3::new(0.0, 0.0, -1.0), 0.0),
        ("outwards", Vec3::new(0.0, 0.0, 1.0), 0.0),
        ("along", Vec3::new(3.0, 0.0, 0.0), 0.0),
        ("at rest", Vec3::zeros(), 0.0),
        ("inside by 1e-17 m", Vec3::zeros(), -1e-17),
        ("inside by 1e-12 m", Vec3::new(0.0, 0.0, -1e-9), -1e-12),
    ] {
        let mut setup = Setup { longest_s: 0.5, ..touching(v) };
        setup.centre_m.z += gap;
        let journey = notes.follow(way, setting, &setup, &floor);
        let depth = SETUP.rock.radius_m - journey.end.position_m.z;
        notes.hold(
            way,
            setting,
            "depth (m) within v_n/ω + 2 m g/p_N",
            depth,
            v.z.abs() / 841.0 + 3e-5,
        );
    }
}

/// From behind a sheet, thrown up against it without gravity: the mirror image of the throw from the front, bit for bit.
pub(super) fn from_behind(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let front = Setup {
        centre_m: Vec3::new(0.3, 0.2, 1.0),
        velocity_m_s: Vec3::new(1.0, 0.0, -5.0),
        gravity_m_s2: 0.0,
        longest_s: 0.5,
        ..SETUP
    };
    let mut back = front;
    (back.centre_m.z, back.velocity_m_s.z) = (-front.centre_m.z, -front.velocity_m_s.z);
    let above = notes.follow(way, "front", &front, &floor).end;
    let below = notes.follow(way, "back", &back, &floor).end;
    let off = (above.position_m.z + below.position_m.z).abs()
        + (above.position_m.x - below.position_m.x).abs();
    notes.hold(way, "", "end is the mirror image (m)", off, 1e-12);
}

/// No rebound with e = 0; with e = 1 the height is kept over ten bounces, as far as the numerics keep it.
pub(super) fn restitution(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let with = |e: f64| Ground { restitution: Some(e), friction_angle_rad: 0.0, ..GROUND };
    let drop = Setup { centre_m: Vec3::new(0.3, 0.2, 1.5), ..SETUP };
    let setup = Setup { ground: with(0.0), longest_s: 2.0, path_step_s: Some(0.01), ..drop };
    let journey = notes.follow(way, "e = 0", &setup, &floor);
    let later = journey.path.iter().filter(|point| point.motion.time_s > 0.5);
    let highest =
        later.map(|point| point.motion.position_m.z + floor.origin_m.z - 0.5).fold(0.0, f64::max);
    notes.hold(way, "e = 0", "height of the rebound (m), e < 0.01", highest, 1e-4);
    let setup = Setup { ground: with(1.0), longest_s: 9.5, ..drop };
    let journey = notes.follow_captured(way, "e = 1", &setup, &floor, Some(0.02));
    let kept = (journey.end.velocity_m_s.z.powi(2) / (2.0 * GRAVITY_M_S2)
        + journey.end.position_m.z
        - 0.5)
        .max(0.0);
    let law = "change of height over ten bounces from 1 m (m)";
    // the fixed step keeps exp(−π ω Δt/4) of the speed in each of ten bounces: 0.0066 of it, twice that of the height
    let bound = way.scheme.of([0.15, 10.0 * 4.0 * way.fineness / 4.4, 1e-3, 1e-3]);
    notes.hold(way, "e = 1", law, (kept - 1.0).abs(), bound);
}

/// e = 0.9 down to rest: finitely many impacts, the time `t_f (1 + e)/(1 − e)`.
pub(super) fn bounce_to_rest(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let ground = Ground { restitution: Some(0.9), ..GROUND };
    let setup = Setup {
        ground,
        centre_m: Vec3::new(0.3, 0.2, 1.5),
        longest_s: 60.0,
        rest_time_s: 0.3,
        ..SETUP
    };
    let journey = notes.follow_captured(way, "", &setup, &floor, Some(0.02));
    let falls = (2.0 / GRAVITY_M_S2).sqrt();
    let (e, time) = (0.9, journey.end.time_s - setup.rest_time_s);
    let off = (time / (falls * (1.0 + e) / (1.0 - e)) - 1.0).abs();
    // the time to rest is 1/(1 − e) times the error of e: a hundredth of e is a tenth of it
    // adaptive: a dozen steps of each impact, twice the local error over the first speed of 4.4 m/s
    let bound = way.scheme.of([0.06, 10.0 * 2.0 * way.fineness / 4.4, 0.02, 0.02]);
    notes.hold(way, "", "time to rest, relative to t_f (1 + e)/(1 − e)", off, bound);
}

/// Without friction the spin keeps every bit; with 89° nothing slips: the touched point ends at rest.
pub(super) fn friction(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let with = |degrees: f64| Ground { friction_angle_rad: degrees.to_radians(), ..GROUND };
    let spin = Vec3::new(3.0, -20.0, 4.0);
    let thrown = Setup { spin_rad_s: spin, ..touching(Vec3::new(5.0, 1.0, -5.0)) };
    let end = notes.follow(way, "0", &Setup { ground: with(0.0), ..thrown }, &floor).end;
    notes.hold(way, "0", "change of spin (rad/s)", (end.spin_rad_s - spin).norm(), 0.0);
    let rolled = Setup { ground: with(89.0), longest_s: 2.0, ..touching(Vec3::new(5.0, 0.0, 0.0)) };
    let end = notes.follow(way, "89°", &rolled, &floor).end;
    let slip = end.velocity_m_s.x - 0.5 * end.spin_rad_s.y;
    notes.hold(way, "89°", "slip (m/s) after 2 s", slip.abs(), 1e-6);
}

/// Without gravity a rock flies straight, strikes once and never comes back.
pub(super) fn no_gravity(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let setup = Setup {
        gravity_m_s2: 0.0,
        centre_m: Vec3::new(0.0, 0.0, 2.5),
        velocity_m_s: Vec3::new(0.0, 0.0, -4.0),
        longest_s: 1.0,
        ..SETUP
    };
    let journey = notes.follow(way, "", &setup, &floor);
    let off = (journey.end.velocity_m_s.z - 2.0).abs();
    // the errors of a dozen steps add up to about twice the local error of 0.05 m/s
    let bound = if sprung(way) { 0.1 } else { 1e-12 };
    notes.hold(way, "", "leaves with e v (m/s)", off, bound);
}
