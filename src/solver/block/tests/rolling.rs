//! Rolling friction of blocks, in the rigid limit: a torque of up to ρ N R against the turning, R of the sphere of equal volume.

use super::cases::balls;
use super::*;

/// The same run on a ground with this rolling friction.
fn with_rolling(mut case: BlockRun, rolling_friction: f64) -> BlockRun {
    case.ground.rolling_friction = rolling_friction;
    let rock = Rock { radius_m: case.block.radius_m, density_kg_m3: 2700.0 };
    let own_m_s = Some(case.law.capture_m_s);
    let capture = Capture { own_m_s, tolerance_m_s: 0.0, gravity_m_s2: G };
    case.law = Law::new(&case.ground, &Damping::of(case.ground.restitution), &rock, &capture);
    case
}

/// A capsule of two balls of radius r rolls across 20°: a = g (sin 20° − ρ R/r cos 20°)/(1 + 7/15), and rolling friction takes ρ R N for
/// every radian.
#[test]
fn a_capsule_is_held_back_by_rolling_friction() {
    let (angle, rho) = (20_f64.to_radians(), 0.1);
    let (r, half, mass) = (0.3, 0.4, 1000.0);
    let own = 7.0 / 15.0 * mass * r * r;
    let body =
        balls(vec![Vec3::y() * half, Vec3::y() * -half], r, (mass, [2.0 * own, own, 2.0 * own]));
    let torque_m = rho * body.radius_m;
    let mut case = with_rolling(BlockRun::new(slope(angle, 100.0), body, (1.0, 0.0)), rho);
    let (along, up) = axes(angle);
    let mut moving = case.start(tilted(angle), still(up * r - along * 40.0));
    let start = moving.pose.centre;
    case.follow(&mut moving, 4.0, |_, _| ());
    let a = G * (sin(angle) - torque_m / r * cos(angle)) / (1.0 + 7.0 / 15.0);
    let way = (moving.pose.centre - start).dot(&along);
    assert!((moving.v.dot(&along) / (4.0 * a) - 1.0).abs() < 1e-6, "{}", moving.v.dot(&along));
    assert!((way / (8.0 * a) - 1.0).abs() < 1e-6, "{way}");
    let taken_j = torque_m * mass * G * cos(angle) * way / r;
    assert!((case.lost.rolling / taken_j - 1.0).abs() < 1e-3, "{} {taken_j}", case.lost.rolling);
}

/// A ball stays on 10° where rolling friction bears tan 10°, and rolls where it bears less.
#[test]
fn a_ball_rests_below_the_slope_that_rolling_friction_holds() {
    let (angle, r, mass) = (10_f64.to_radians(), 0.5, 1400.0);
    let body = || balls(vec![Vec3::zeros()], r, (mass, [0.4 * mass * r * r; 3]));
    let held = angle.tan() * r / body().radius_m;
    for (share, stays) in [(1.05, true), (0.95, false)] {
        let case = BlockRun::new(slope(angle, 100.0), body(), (1.0, 0.0));
        let mut case = with_rolling(case, share * held);
        let (_, up) = axes(angle);
        let mut moving = case.start(tilted(angle), still(up * r));
        case.follow(&mut moving, 4.0, |_, _| ());
        assert_eq!(moving.v.norm() < 1e-6, stays, "{share}: {:e} m/s", moving.v.norm());
    }
}

/// A tumbling slab with rolling friction: no impact and no step gains energy, and rolling friction takes some of it.
#[test]
fn a_tumbling_slab_gains_nothing_by_rolling_friction() {
    let angle = 30_f64.to_radians();
    let body = block(&box_surface([0.5, 0.4, 0.25]), 0.05);
    let mut case = with_rolling(BlockRun::new(slope(angle, 200.0), body, (0.8, 0.3)), 0.2);
    let (along, up) = axes(angle);
    let start = [up - along * 150.0, along * 5.0, Vec3::new(1.0, 9.0, -2.0)];
    let mut moving = case.start(turn(&Vec3::x_axis(), 0.4), start);
    let (own, mass) = (case.block.clone(), case.block.mass_kg);
    let mut before_j = f64::INFINITY;
    case.follow(&mut moving, 6.0, |_, moving| {
        let total_j = moving.motion_j(&own) + mass * G * moving.pose.centre.z;
        assert!(total_j <= before_j + 1e-9 * moving.motion_j(&own), "{total_j} {before_j}");
        before_j = total_j;
    });
    assert!(case.lost.rolling > 0.0 && case.impacts > 5, "{:?} {}", case.lost, case.impacts);
}
