//! One rock, one plane: stiffness, size, speed, restitution, friction to their ends.

use super::bounds::{
    DIGITS, SpringImpact, captured_restitution, plane_error, rests_within, strikes_within,
};
use super::{Notes, SchemeSetting, sprung};
use crate::ground::{Ground, damping_ratio};
use crate::math;
use crate::rock::{Rock, Vec3};
use crate::simulation::Trajectory;
use crate::solver::dda::{TRAVEL, own_restitution};
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
    let steps = if way.scheme.has_fixed_step() { 2.0 * way.fineness } else { 0.0 };
    let setup = Setup {
        rock,
        ground,
        centre_m: Vec3::new(0.3, 0.2, radius),
        velocity_m_s: Vec3::new(0.0, 0.0, -speed),
        longest_s: lasts + steps,
        path_step_s: Some(lasts / 200.0),
        ..SETUP
    };
    let setting = format!("{stiffness:.0e} N/m, R {radius} m, {speed} m/s");
    let journey = notes.follow(way, &setting, &setup, floor);
    if sprung(way) {
        let law = "depth (m) within twice √e v/ω + m g/p_N, or a step's v Δt/4";
        let deepest = radius - lowest_m(&journey, floor);
        // a step that turns the rock round is drawn as a parabola
        let drawn = if way.scheme.has_fixed_step() { 0.25 * speed * way.fineness } else { 0.0 };
        notes.hold(way, &setting, law, deepest, 2.0 * depth + drawn + DIGITS * radius);
    }
    let rebound = rebound_m_s(&journey, &setup) / speed;
    hold_rebound(way, notes, &setting, (&setup, rebound));
}

/// Holds the rebound over the speed of an impact on the floor.
fn hold_rebound(
    way: &SchemeSetting,
    notes: &mut Notes,
    setting: &str,
    (setup, rebound): (&Setup, f64),
) {
    let speed = -setup.velocity_m_s.z;
    let blow = SpringImpact::of(setup, speed, 0.5);
    let phase = way.fineness * blow.omega;
    let is_captured = speed <= way_capture(way) || blow.never_leaves();
    if way.scheme.has_fixed_step() {
        let blow = if is_captured { blow.captured() } else { blow };
        // nor does it go further in a step than it looks ahead
        let looks_m = TRAVEL * setup.rock.radius_m;
        let (left, _) = blow.stepped(way.fineness, looks_m, setup.longest_s);
        let law = "rebound over speed is what the steps leave";
        // places are rounded: over a step that is a speed
        let placed = 4.0 * f64::EPSILON * setup.rock.radius_m / (speed * way.fineness);
        notes.hold(way, setting, law, (rebound - left / speed).abs(), placed + 10.0 * DIGITS);
        if phase > RESOLVED {
            return;
        }
    }
    let exact = blow.closed_form() / speed;
    let swings = "captured: no more than its dashpot gives back";
    let (law, off, allowed) = match (sprung(way), is_captured) {
        (false, true) => ("captured: no rebound", rebound, 0.0),
        (false, false) => ("rebound over speed is e", (rebound - 0.5).abs(), DIGITS),
        // slower than its tolerance: that it takes for nothing
        (true, true) if way.scheme.controls_error() && speed < way.fineness => {
            ("captured: no more than the rebound of e", rebound, 0.5)
        }
        (true, true) => (swings, rebound, captured_restitution() + plane_error(way, blow.omega)),
        (true, false) => {
            let law = "rebound over speed is that of the closed form";
            (law, (rebound - exact).abs(), plane_error(way, blow.omega))
        }
    };
    notes.hold(way, setting, law, off, allowed);
}

/// Lowest height of the centre on a kept path (m).
fn lowest_m(journey: &Trajectory, on: &Terrain) -> f64 {
    let heights = journey.path.iter().map(|point| point.motion.position_m.z + on.origin_m.z);
    heights.fold(f64::INFINITY, f64::min)
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

/// Impacts this slow are captured (m/s): by default, or as a case asks.
const SLOW_M_S: f64 = 0.02;

/// The speed (m/s) up to which numerics may capture an impact.
fn way_capture(way: &SchemeSetting) -> f64 {
    way.scheme.of([SLOW_M_S, way.fineness, SLOW_M_S, SLOW_M_S])
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
        let depth = SETUP.rock.radius_m - lowest_m(&journey, &floor);
        // it falls another 0.1 m first
        let bound = strikes_within(way, &setup, math::hypot(v.z, (0.2 * GRAVITY_M_S2).sqrt()));
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
        // thrown up or down at 1 m/s it is at rest again after less than that
        notes.hold(way, setting, "rests within 2 m g/p_N (m)", depth, rests_within(way, &setup));
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
    notes.hold(way, "", "end is the mirror image (m)", off, DIGITS);
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
    // its dashpot is over-damped: the weight never lets it leave
    notes.hold(way, "e = 0", "height of the rebound (m)", highest, DIGITS);
    let setup = Setup { ground: with(1.0), longest_s: 9.5, ..drop };
    let journey = notes.follow_captured(way, "e = 1", &setup, &floor, Some(0.02));
    let kept = (journey.end.velocity_m_s.z.powi(2) / (2.0 * GRAVITY_M_S2)
        + journey.end.position_m.z
        - 0.5)
        .max(0.0);
    let law = "change of height over ten bounces from 1 m (m)";
    // what the fixed step leaves of each bounce without its weight, which in an impact is g/(ω v) of the spring's force
    let bound = if way.scheme.has_fixed_step() {
        let left = own_restitution(way.fineness * setup.omega());
        let struck = f64::from(journey.impact_count);
        1.05 * (1.0 - math::pow(left, 2.0 * struck))
    } else {
        10.0 * DIGITS
    };
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
        rest_time_s: 0.05,
        ..SETUP
    };
    let journey = notes.follow_captured(way, "", &setup, &floor, Some(SLOW_M_S));
    let time = journey.end.time_s - setup.rest_time_s;
    let expected = bounces_s(way, &setup, 0.9);
    // the rule of rest compares halves of its time; implicit steps take the last swings, which fade by `ζ ω`, for some of one,
    // and the rigid limit may be a step late at either end
    let swing = 1.0 / (damping_ratio(0.9) * setup.omega());
    let late = 0.5 * setup.rest_time_s + 2.0 * swing;
    let bound = way.scheme.of([1.0 / setup.omega(), late, late, 2.0 * way.fineness]);
    notes.hold(way, "", "time to rest off that of its bounces (s)", (time - expected).abs(), bound);
}

/// How long a drop from 1 m bounces until it is captured (s).
fn bounces_s(way: &SchemeSetting, setup: &Setup, e: f64) -> f64 {
    let mut speed = (2.0 * GRAVITY_M_S2).sqrt();
    let mut time = speed / GRAVITY_M_S2;
    while speed > SLOW_M_S {
        let blow = SpringImpact::of(setup, speed, e);
        let (left, contact_s) = match (sprung(way), way.scheme.has_fixed_step()) {
            (false, _) => (e * speed, 0.0),
            (true, true) => blow.stepped(way.fineness, f64::INFINITY, 4.0 / blow.omega),
            (true, false) => (blow.closed_form(), blow.lasts_s()),
        };
        speed = left;
        time += contact_s + 2.0 * speed / GRAVITY_M_S2;
    }
    time
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
    notes.hold(way, "89°", "slip (m/s) after 2 s", slip.abs(), 5.0 * DIGITS);
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
    let bound = plane_error(way, setup.omega()) * 4.0;
    notes.hold(way, "", "leaves with e v (m/s)", off, bound);
}
