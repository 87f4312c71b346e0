//! More exact cases with every scheme that has springs: numbers of `docs/exact_blocks.md`.

use super::springs::{SCHEMES, every_scheme, on_springs, with_long_steps};
use super::*;

/// Forces along the normal of the upper and the lower corners of a cube that lies on a slope (N),
/// of its springs.
fn pairs_n(case: &BlockRun, state: &BlockState, angle: f64) -> [f64; 2] {
    let (along, up) = axes(angle);
    let mut pairs = [0.0; 2];
    for corner in &case.block.core.corners {
        let arm = state.pose.attitude * corner;
        let pressed = case.block.ball_m - (state.pose.centre + arm).dot(&up);
        pairs[usize::from(arm.dot(&along) > 0.0)] +=
            case.ground.normal_stiffness_n_m * pressed.max(0.0);
    }
    pairs
}

/// S7: a cube at rest on 20° presses with (cos 20° ± sin 20°)/2 of its weight on its lower and
/// upper corners; their balls, set inside, make the difference a little larger: 0.6408563821 and
/// 0.2988362387 where it is sharp.
#[test]
fn a_cube_at_rest_presses_as_statics_says() {
    let angle = 20_f64.to_radians();
    let (ball, up) = (0.001, axes(angle).1);
    let shares = |arm: f64| [-1.0, 1.0].map(|s| 0.5 * (cos(angle) + s * sin(angle) * 0.5 / arm));
    let sharp = shares(0.5);
    assert!(
        (sharp[1] - 0.640_856_382_1).abs() < 1e-10 && (sharp[0] - 0.298_836_238_7).abs() < 1e-10
    );
    let made =
        || BlockRun::new(slope(angle, 10.0), block(&box_surface([1.0; 3]), ball), (1.0, 0.4));
    for scheme in SCHEMES {
        let mut case = with_long_steps(on_springs(made(), scheme, 1e9));
        let mut state = case.start(tilted(angle), still(up * 0.5));
        case.follow(&mut state, 1.0, |_, _| ());
        let weight = case.block.mass_kg * G;
        for (found, known) in pairs_n(&case, &state, angle).into_iter().zip(shares(0.5 - ball)) {
            assert!((found / weight - known).abs() < 1e-4, "{scheme:?} {} {known}", found / weight);
        }
    }
    // the rigid limit: impulses of one step
    let case = made();
    let (own, laws) = (case.block.clone(), [case.law]);
    let world =
        ContactEnvironment { terrain: &case.terrain, body: Body::of_block(&own, G), laws: &laws };
    let mut contact_state = BlockContactState::default();
    let mut state = case.start(tilted(angle), still(up * 0.5));
    for _ in 0..20 {
        contact_state.step(&world, &own, &mut state, (1e-3, CORNER_WAY));
    }
    let mut pairs = [0.0; 2];
    for contact in &contact_state.contacts {
        let lower = contact.lever.dot(&axes(angle).0) > 0.0;
        pairs[usize::from(lower)] += contact.n.dot(&contact.impulse) / (1e-3 * own.mass_kg * G);
    }
    for (found, known) in pairs.into_iter().zip(shares(0.5 - ball)) {
        assert!((found - known).abs() < 1e-6, "{found} {known}");
    }
}

/// S8 and S9: on 50° a cube tips about its lower edge if friction exceeds the slenderness of its
/// base, with the closed form's angular acceleration, and slides on its face if not; on 40° it does
/// neither with friction enough.
#[test]
fn a_cube_slides_or_tips_as_friction_says() {
    let ball = 0.01;
    for (degrees, friction) in [(50_f64, 0.9), (50.0, 1.3), (40.0, 1.3)] {
        let angle = degrees.to_radians();
        let arm = 0.5 - ball;
        let turns = G * (0.5 * sin(angle) - arm * cos(angle)) / (1.0 / 6.0 + 0.25 + arm * arm);
        let tips = friction > arm / 0.5 && turns > 0.0;
        let slides = G * (sin(angle) - friction * cos(angle));
        for scheme in every_scheme() {
            let body = block(&box_surface([1.0; 3]), ball);
            let mut case = BlockRun::new(slope(angle, 100.0), body, (friction, 0.0));
            if scheme.has_springs() {
                case = with_long_steps(on_springs(case, scheme, 1e12));
            }
            let own = case.block.clone();
            let mut state = case.start(tilted(angle), still(axes(angle).1 * 0.5));
            // springs settle first
            case.follow(&mut state, 0.01, |_, _| ());
            let (w, v) = (state.spin(&own).y, state.v.dot(&axes(angle).0));
            case.follow(&mut state, 0.02, |_, _| ());
            let turned = (state.spin(&own).y - w) / 0.02;
            let slid = (state.v.dot(&axes(angle).0) - v) / 0.02;
            let known =
                [if tips { turns } else { 0.0 }, if tips { turns * 0.5 } else { slides.max(0.0) }];
            let setting = format!("{scheme:?} {degrees}° {friction}: {turned} {slid}, {known:?}");
            assert!((turned - known[0]).abs() < 5e-3, "{setting}");
            assert!((slid - known[1]).abs() < 5e-3, "{setting}");
        }
    }
}
