//! Rolling friction of blocks: a moment of up to ρ N R against the spin, R of the sphere of equal
//! volume, in every scheme.

use super::cases::balls;
use super::springs::{SCHEMES, every_scheme, on_springs};
use super::*;
use crate::solver::Scheme;

/// Stiffness of the springs (N/m).
const P_N: f64 = 1e9;

/// The same run on a ground with this rolling friction, in a scheme.
fn with_rolling(case: BlockRun, scheme: Scheme, rolling_friction: f64) -> BlockRun {
    let case = on_ground(case, rolling_friction);
    if scheme.has_springs() { on_springs(case, scheme, P_N) } else { case }
}

fn on_ground(mut case: BlockRun, rolling_friction: f64) -> BlockRun {
    case.ground.rolling_friction = rolling_friction;
    case.law = law_of(&case.ground, &case.block, case.law.capture_m_s);
    case
}

/// Two balls of 0.3 m, 0.8 m apart, of 1000 kg, with I/(m r²) = 7/15 about their axis.
fn capsule() -> Block {
    let (r, mass) = (0.3, 1000.0);
    let own = 7.0 / 15.0 * mass * r * r;
    let ends = vec![Vec3::y() * 0.4, Vec3::y() * -0.4];
    balls(ends, r, (mass, [2.0 * own, own, 2.0 * own]))
}

fn ball(r: f64) -> Block {
    let mass = 2700.0 * 4.0 / 3.0 * std::f64::consts::PI * r * r * r;
    balls(vec![Vec3::zeros()], r, (mass, [0.4 * mass * r * r; 3]))
}

/// How near a scheme comes to a closed form (–).
fn tolerance(scheme: Scheme) -> f64 {
    if scheme.has_springs() { 2e-3 } else { 1e-6 }
}

/// A capsule rolls across 20°: a = g (sin 20° − ρ R/r cos 20°)/(1 + 7/15), and rolling friction
/// takes ρ R N for every radian.
#[test]
fn a_capsule_is_held_back_by_rolling_friction() {
    let (angle, rho, r) = (20_f64.to_radians(), 0.1, 0.3);
    for scheme in every_scheme() {
        let lever_m = rho * capsule().radius_m;
        let case = BlockRun::new(slope(angle, 100.0), capsule(), (1.0, 0.0));
        let mut case = with_rolling(case, scheme, rho);
        let (along, up) = axes(angle);
        let mut state = case.start(tilted(angle), still(up * r - along * 40.0));
        let start = state.pose.centre;
        case.follow(&mut state, 2.0, |_, _| ());
        let a = G * (sin(angle) - lever_m / r * cos(angle)) / (1.0 + 7.0 / 15.0);
        let (way, speed) = ((state.pose.centre - start).dot(&along), state.v.dot(&along));
        let taken_j = lever_m * 1000.0 * G * cos(angle) * way / r;
        let off = [speed / (2.0 * a), way / (2.0 * a), case.lost.rolling / taken_j];
        println!("{scheme:?} {off:?}");
        assert!((off[0] - 1.0).abs() < tolerance(scheme), "{scheme:?} {off:?}");
        assert!((off[1] - 1.0).abs() < tolerance(scheme), "{scheme:?} {off:?}");
        assert!((off[2] - 1.0).abs() < 1e-3_f64.max(tolerance(scheme)), "{scheme:?} {off:?}");
    }
}

/// On a level a capsule that rolls at 2 m/s stops after v² (1 + 7/15) r/(2 ρ R g), and stays where
/// it is.
#[test]
fn a_capsule_stops_where_rolling_friction_has_its_energy() {
    let (rho, r, v) = (0.15, 0.3, 2.0);
    for scheme in every_scheme() {
        let case = BlockRun::new(slope(0.0, 100.0), capsule(), (1.0, 0.0));
        let mut case = with_rolling(case, scheme, rho);
        let start = [Vec3::z() * r, Vec3::x() * v, Vec3::y() * (v / r)];
        let mut state = case.start(Rotation3::identity(), start);
        let own = case.block.clone();
        let a = G * rho * own.radius_m / r / (1.0 + 7.0 / 15.0);
        let mut available_j = f64::INFINITY;
        case.follow(&mut state, 1.2 * v / a, |_, state| {
            let motion_j = state.motion_j(&own);
            // what springs hold comes back as motion
            assert!(motion_j <= available_j + 1.0, "{scheme:?} {motion_j} {available_j}");
            available_j = available_j.min(motion_j);
        });
        let way = state.pose.centre.x / (v * v / (2.0 * a));
        println!("{scheme:?} {way} {:e} m/s, {:?}", state.v.norm(), case.lost);
        // steps end where they do, not where the capsule stops
        assert!((way - 1.0).abs() < 1e-4, "{scheme:?} {way}");
        assert!(state.v.norm() < 1e-4 && state.spin(&own).norm() < 1e-4, "{scheme:?}");
        let had_j = 0.5 * 1000.0 * v * v * (1.0 + 7.0 / 15.0);
        assert!((case.lost.rolling / had_j - 1.0).abs() < 5e-3, "{scheme:?} {:?}", case.lost);
    }
}

/// A ball stays on 10° if the capacity of rolling friction is tan 10°, and rolls if it is less.
#[test]
fn a_ball_rests_below_the_slope_that_rolling_friction_holds() {
    let (angle, r) = (10_f64.to_radians(), 0.5);
    let held = angle.tan();
    for scheme in every_scheme() {
        for (part, stays) in [(1.05, true), (0.95, false)] {
            let case = BlockRun::new(slope(angle, 100.0), ball(r), (1.0, 0.0));
            let mut case = with_rolling(case, scheme, part * held);
            let (along, up) = axes(angle);
            let mut state = case.start(tilted(angle), still(up * r));
            case.follow(&mut state, 2.0, |_, _| ());
            let speed = state.v.dot(&along);
            let rolls = 5.0 / 7.0 * G * sin(angle) * 0.05 * 2.0;
            println!("{scheme:?} {part} {speed:e} m/s of {rolls}");
            let known = if stays { 0.0 } else { rolls };
            // the spring must be stretched before it reaches its capacity
            let share = if scheme.has_springs() { 0.05 } else { 1e-3 };
            assert!((speed - known).abs() < share * rolls, "{scheme:?} {part}: {speed} {known}");
        }
    }
}

/// One ball at the centre with rolling friction bounces and rolls on as the sphere of the same
/// scheme does.
#[test]
fn one_ball_with_rolling_friction_is_a_sphere() {
    let (angle, r) = (20_f64.to_radians(), 0.5);
    let (along, up) = axes(angle);
    let start = [up * r * (1.0 - 1e-12), along * 2.0 - up * 0.5, Vec3::new(0.5, 1.0, 2.0)];
    for scheme in SCHEMES {
        let case = BlockRun::new(slope(angle, 50.0), ball(r), (0.6, 0.0));
        let mut case = with_rolling(case, scheme, 0.2);
        let mut state = case.start(tilted(angle), start);
        case.follow(&mut state, 0.5, |_, _| ());
        let laws = [case.law];
        let own = Body::of_block(&case.block, G);
        let own = Body { radius: r, inertia: 0.4 * own.mass * r * r, ..own };
        let world = ContactEnvironment { terrain: &case.terrain, body: own, laws: &laws };
        let mut sphere = crate::solver::contact_state::ContactState::default();
        sphere.begin(&world, start[0] - case.terrain.origin_m, start[1], start[2]);
        let settings = case.springs.unwrap();
        let mut stepper = crate::solver::Stepper::new(&settings, &world, &mut sphere);
        let mut gone = 0.0;
        while gone < 0.5 {
            gone +=
                crate::solver::advance(&mut stepper, &world, &mut sphere, 0.5 - gone).unwrap().dt;
            assert!(!sphere.is_free(), "{scheme:?} {gone}");
        }
        let off = (state.v - sphere.v).norm() / sphere.v.norm();
        let turned = (state.spin(&case.block) - sphere.w).norm() / sphere.w.norm();
        println!("{scheme:?} {gone} {off:e} {turned:e} {} {}", state.v, sphere.v);
        assert!(off.max(turned) < 2e-3, "{scheme:?} {off:e} {turned:e}");
    }
}

/// A tumbling slab with rolling friction: no impact and no step gains energy, and rolling friction
/// takes some of it.
#[test]
fn a_tumbling_slab_gains_nothing_by_rolling_friction() {
    let angle = 30_f64.to_radians();
    for scheme in every_scheme() {
        let body = block(&box_surface([0.5, 0.4, 0.25]), 0.05);
        let case = BlockRun::new(slope(angle, 200.0), body, (0.8, 0.3));
        let mut case = with_rolling(case, scheme, 0.2);
        let (along, up) = axes(angle);
        let start = [up - along * 150.0, along * 5.0, Vec3::new(1.0, 9.0, -2.0)];
        let mut state = case.start(turn(&Vec3::x_axis(), 0.4), start);
        let (own, mass) = (case.block.clone(), case.block.mass_kg);
        let total_j = |state: &BlockState| state.motion_j(&own) + mass * G * state.pose.centre.z;
        let mut before_j = f64::INFINITY;
        // springs give back what they have stored; the rigid limit has none
        let given_j = if scheme.has_springs() { f64::INFINITY } else { 0.0 };
        let longest_s = if scheme.has_fixed_step() { 1.0 } else { 3.0 };
        let begun_j = total_j(&state);
        case.follow(&mut state, longest_s, |_, state| {
            let now_j = total_j(state);
            assert!(now_j <= before_j + given_j + 1e-9 * begun_j.abs(), "{scheme:?} {now_j}");
            before_j = now_j;
        });
        let balance = (begun_j - total_j(&state) - case.lost.sum()) / case.lost.sum();
        println!("{scheme:?} {:?}, {balance:e} left", case.lost);
        assert!(case.lost.rolling > 0.0 && total_j(&state) < begun_j, "{scheme:?}");
    }
}

/// The angular impulse is at its limit against the trial value of spin and spring, or leaves no
/// spin.
#[test]
fn turning_acts_against_the_spin() {
    let inverse = Matrix3::from_diagonal(&Vec3::new(1.0, 0.4, 0.25));
    let mass = Mass { mass: 10.0, inverse };
    let law = |rho: f64| {
        let case = BlockRun::new(slope(0.0, 1.0), ball(0.5), (1.0, 0.0));
        on_ground(case, rho).law
    };
    let w = Vec3::new(3.0, -2.0, 5.0);
    for (rho, stops) in [(0.02, false), (0.2, false), (40.0, true)] {
        let mut contact =
            BlockContact::new(&mass, (Vec3::z(), -Vec3::z()), (1.0, 0), Vec3::zeros())
                .rolling(law(rho).limits());
        contact.impulse = Vec3::z() * 4.0;
        let (mut rolling, capacity) = (rigid_rolling(&[contact]), contact.rolling_limit());
        let after = w + rolling.update(&mass.inverse, &w, capacity);
        let again = rolling.update(&mass.inverse, &after, capacity);
        assert!(again.norm() < 1e-12, "{rho}: {again}");
        if stops {
            assert!(after.norm() < 1e-12, "{after}");
        } else {
            let (size, limit) = (rolling.impulse.norm(), rho * 0.5 * 4.0);
            assert!((size / limit - 1.0).abs() < 1e-12, "{rho}: {size} {limit}");
            let along = -rolling.impulse.dot(&after) / (size * after.norm());
            assert!((along - 1.0).abs() < 1e-12, "{rho}: {along}");
        }
    }
}
