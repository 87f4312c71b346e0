//! What shows only after long, or among many.

use super::bounds::DIGITS;
use super::{Notes, SchemeSetting, sprung};
use crate::ground::Ground;
use crate::math;
use crate::random::{Purpose, stream, unit};
use crate::rock::{Rock, Vec3};
use crate::simulation::{Scratch, Stop, Trajectory};
use crate::study::bench::{GROUND, ROCK, SETUP, Setup, settings, terrain};
use crate::terrain::make;
use std::f64::consts::PI;

/// On a slope that friction and rolling friction hold: no creep, and as good as no cost. A top spinning on the spot slows
/// down and stays where it is.
pub(super) fn rest(way: &SchemeSetting, notes: &mut Notes) {
    let angle = 20f64.to_radians();
    let slope = terrain(make::jittered_plane(10.0, 6, angle));
    let ground = Ground { rolling_friction: 0.5, ..GROUND };
    let pressed = if sprung(way) { SETUP.pressed_m(angle) } else { 0.0 };
    let height = SETUP.rock.radius_m - pressed;
    // a fixed step cannot leap over rest: 10 s of it are a million steps
    let longest_s = if way.scheme.has_fixed_step() { 10.0 } else { 3600.0 };
    let setup = Setup {
        ground,
        centre_m: Vec3::new(0.0, height * math::sin(angle), height * math::cos(angle)),
        longest_s,
        ..SETUP
    };
    let end = notes.follow(way, "on a slope of 20°", &setup, &slope).end;
    let along = SETUP.rock.mass_kg() * SETUP.gravity_m_s2 * math::sin(angle);
    // the shear spring and, by the lever R, the rolling spring 0.1 p_s R²
    let wound = 11.0 * along / GROUND.shear_stiffness_n_m;
    notes.hold(
        way,
        "on a slope of 20°",
        "moved (m), at most what the springs wind up",
        (end.position_m - setup.centre_m).norm(),
        if sprung(way) { 1.1 * wound } else { DIGITS },
    );
    // places are rounded, and over a fixed step that is a speed
    let placed = 2.0 * f64::EPSILON * SETUP.rock.radius_m / way.fineness;
    let still = if way.scheme.has_fixed_step() { placed } else { DIGITS };
    notes.hold(way, "on a slope of 20°", "speed at the end (m/s)", end.velocity_m_s.norm(), still);
    top(way, notes, ground);
}

/// A top on the spot, pressed in by its weight.
fn top(way: &SchemeSetting, notes: &mut Notes, ground: Ground) {
    let level = terrain(make::jittered_plane(10.0, 6, 0.0));
    let pressed = if sprung(way) { SETUP.pressed_m(0.0) } else { 0.0 };
    let top = Setup {
        ground,
        centre_m: Vec3::new(0.1, 0.2, SETUP.rock.radius_m - pressed),
        spin_rad_s: Vec3::new(0.0, 0.0, 20.0),
        longest_s: 4.0,
        ..SETUP
    };
    let end = notes.follow(way, "spinning on the spot", &top, &level).end;
    notes.hold(
        way,
        "spinning on the spot",
        "spin left after 4 s (rad/s)",
        end.spin_rad_s.norm(),
        20.0 * DIGITS,
    );
    notes.hold(
        way,
        "spinning on the spot",
        "moved sideways (m)",
        math::hypot(end.position_m.x - 0.1, end.position_m.y - 0.2),
        DIGITS,
    );
}

/// Rocks of all sizes down a rough slope of 10 000 triangles: none fails, none is lost, no energy rises, and the ledger
/// accounts for all of it.
pub(super) fn random_releases(way: &SchemeSetting, notes: &mut Notes) {
    let slope = terrain(make::natural_slope(61, 82).facets);
    let rocks = if way.scheme.has_fixed_step() { 2 } else { 100 };
    let step = settings(way.scheme, way.fineness, None);
    let (mut lost, mut rise, mut remainder, mut bound) = (0u32, 0.0f64, 0.0f64, 0.0f64);
    let mut scratch = Scratch::default();
    for index in 0..rocks {
        let mut random = stream(11, Purpose::Place, index);
        let mut between = |low: f64, high: f64| low + (high - low) * unit(&mut random);
        let (x, y) = (between(60.0, 240.0), between(20.0, 60.0));
        let rock = Rock { radius_m: between(0.15, 1.0), ..ROCK };
        let ground = Ground { rolling_friction: 0.5, restitution: Some(0.4), ..GROUND };
        let ground_m =
            slope.ground_below(x - slope.origin_m.x, y - slope.origin_m.y).unwrap_or(0.0)
                + slope.origin_m.z;
        let setup = Setup {
            rock,
            ground,
            centre_m: Vec3::new(x, y, ground_m + 3.0 * rock.radius_m + 1.0),
            velocity_m_s: Vec3::new(between(-0.5, 0.5), between(0.0, 1.0), 0.0),
            longest_s: 120.0,
            rest_time_s: 0.3,
            ..SETUP
        };
        let journey = setup.follow(&slope, &step, &mut scratch);
        lost += u32::from(matches!(journey.stop, Stop::Failed(_) | Stop::TimeUp));
        rise = rise.max(journey.ledger.rise_j / journey.released_j);
        remainder = remainder.max(journey.energy_balance_error());
        bound = bound.max(unaccounted(way, &setup, &journey));
    }
    let setting = format!("{rocks} rocks");
    notes.hold(way, &setting, "failed or out of time", f64::from(lost), 0.0);
    notes.hold(way, &setting, "energy rise over energy released", rise, DIGITS);
    notes.hold(way, &setting, "energy not accounted for, over energy released", remainder, bound);
}

/// What the ledger of a journey may leave unaccounted for, over the energy released (–).
///
/// The fixed step damps `exp(−π ω Δt/4)` of the speed of an impact, and all impacts together have no more than was released.
/// Implicit steps err by their tolerance of the speed, for which that of all the energy stands. The rigid limit solves each of
/// its steps of contact to as many digits.
fn unaccounted(way: &SchemeSetting, setup: &Setup, journey: &Trajectory) -> f64 {
    let damped = 1.0 - math::exp(-0.5 * PI * setup.omega() * way.fineness);
    let speed = (2.0 * journey.released_j / setup.rock.mass_kg()).sqrt();
    let by_tolerance = 2.0 * way.fineness / speed;
    let steps = setup.longest_s / way.fineness;
    way.scheme.of([damped, by_tolerance, by_tolerance, DIGITS * steps])
}
