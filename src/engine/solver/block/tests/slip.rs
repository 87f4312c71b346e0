//! Friction that grows with slip.

use super::springs::{every_scheme, on_springs, with_long_steps};
use super::*;
use crate::ground::SlipFriction;

/// Leine's square block on 45°, with μ = 0.2 + (2/π) 1.1 atan(0.7 s), slides on its face with the
/// speed that the closed integral of friction leaves it, 3.49176205 m/s where μ = 1 after
/// 3.12813509 m; there it tips over its lower edge.
#[test]
fn friction_that_grows_with_slip_tips_a_block() {
    let angle = 45_f64.to_radians();
    let kappa = 0.7;
    let soil = SlipFriction { most: 1.3, kappa_per_m: kappa, beta_per_s: 20.0 };
    // v²/2 = g (s sin − cos ∫ μ ds)
    let exact = |s: f64| {
        let grown = s * atan(kappa * s) - (1.0 + (kappa * s).powi(2)).ln() / (2.0 * kappa);
        let friction = 0.2 * s + 1.1 / std::f64::consts::FRAC_PI_2 * grown;
        (2.0 * G * (s * sin(angle) - cos(angle) * friction)).sqrt()
    };
    assert!((soil.at(0.2, 3.128_135_09) - 1.0).abs() < 1e-9);
    assert!((exact(3.128_135_09) - 3.491_762_05).abs() < 1e-8);
    let (along, up) = axes(angle);
    for scheme in every_scheme() {
        let body = block(&box_surface([1.0; 3]), 0.02);
        let mut case = BlockRun::new(slope(angle, 100.0), body, (0.2, 0.0));
        if scheme.has_springs() {
            case = with_long_steps(on_springs(case, scheme, 1e9));
        }
        case.ground.slip_friction = Some(soil);
        let mut state = case.start(tilted(angle), still(up * 0.5));
        let (block, start) = (case.block.clone(), state.pose.centre);
        let (mut worst, mut tipped) = (0.0f64, 0.0f64);
        case.follow(&mut state, 2.4, |_, state| {
            let way = (state.pose.centre - start).dot(&along);
            let spin = state.spin(&block).norm();
            // with its edges rounded it tips a little earlier
            if (1.0..2.7).contains(&way) {
                worst = worst.max((state.v.dot(&along) / exact(way) - 1.0).abs()).max(spin);
            }
            tipped = tipped.max(spin);
        });
        let most = if scheme.has_springs() { 1e-3 } else { 1e-4 };
        println!("{scheme:?} {worst:e} {tipped}");
        assert!(worst > 0.0 && worst < most, "{scheme:?} {worst:e}");
        assert!(tipped > 0.3, "{scheme:?}: it does not tip: {tipped}");
    }
}

/// What a block has slipped is forgotten in flight as e^(−βt), exactly.
#[test]
fn slip_is_forgotten_in_flight() {
    let soil = SlipFriction { most: 1.3, kappa_per_m: 0.7, beta_per_s: 20.0 };
    let (left, half) = (soil.left_m(2.0, 0.1), soil.left_m(2.0, 0.05));
    assert!((left - 2.0 * (-2.0_f64).exp()).abs() < 1e-15);
    assert!((soil.left_m(half, 0.05) - left).abs() < 1e-15);
    assert!((soil.at(0.2, 0.0) - 0.2).abs() < 1e-15 && soil.at(0.2, 1e18) <= 1.3);
}
