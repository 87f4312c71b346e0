//! A hexagonal prism that rolls down with plastic impacts of its edges.

use super::*;

/// Spin of a hexagonal prism of side 1 m that rolls down, as `made` for a scheme: before its last
/// edge impact, its minimum after it, and the spin before an impact in its limit cycle.
pub(super) fn rolling_prism(
    degrees: f64,
    made: impl Fn(BlockRun) -> BlockRun,
) -> ((f64, f64), f64) {
    let angle = degrees.to_radians();
    let mut case = made(prism_run(angle));
    let mut state = prism_start(&case, angle);
    // an edge impact takes a third of the spin, and the climb over the edge some more
    let (mut edge_impact, mut fastest, mut slowest, mut fell) =
        ((0.0, 0.0), 0.0, f64::INFINITY, None);
    let own = case.block.clone();
    case.follow(&mut state, 12.0, |now, state| {
        let spin = state.spin(&own).y;
        match fell {
            None if spin < 0.9 * fastest => fell = Some(now),
            None => fastest = spin.max(fastest),
            Some(_) if spin > 1.5 * slowest => {
                edge_impact = (fastest, slowest);
                (fastest, slowest, fell) = (spin, f64::INFINITY, None);
            }
            // the effect of the springs on the spin during the impact itself is soon over
            Some(begun) => slowest = if now > begun + 0.05 { spin.min(slowest) } else { slowest },
        }
    });
    (edge_impact, prism_cycle(angle).0)
}

/// Radius of its balls (m).
const PRISM_BALL_M: f64 = 0.01;

fn prism_run(angle: f64) -> BlockRun {
    let body = block(&prism_on_its_side(6), PRISM_BALL_M);
    BlockRun::new(slope(angle, 200.0), body, (1.0, 0.0))
}

/// It turns about its rear edge with 1.7 rad/s.
fn prism_start(case: &BlockRun, angle: f64) -> BlockState {
    let (along, up) = axes(angle);
    let (height, spin) = (0.75_f64.sqrt(), Vec3::y() * 1.7);
    let arm = up * height - along * 0.5;
    case.start(tilted(angle), [up * (height + 1e-7) - along * 100.0, spin.cross(&arm), spin])
}

/// Spin before an edge impact in its limit cycle (rad/s), and the share that the impact leaves (–):
/// edges a little inside, and arcs between them.
fn prism_cycle(angle: f64) -> (f64, f64) {
    // half a face, height, the share that an impact keeps, and the rotation between impacts
    let s = 0.5 - PRISM_BALL_M * crate::math::tan(std::f64::consts::FRAC_PI_6);
    let (h2, inertia) = (0.75, 5.0 / 12.0);
    let eta = (inertia + h2 - s * s) / (inertia + h2 + s * s);
    let way = 2.0 * s + PRISM_BALL_M * std::f64::consts::FRAC_PI_3;
    let square = 2.0 * G * way * sin(angle) / ((inertia + h2 + s * s) * (1.0 - eta * eta));
    (square.sqrt(), eta)
}

/// An impact on plastic ground throws the prism up by so little that it is back after this time
/// (s).
const SETTLED_S: f64 = 0.05;

/// A hexagonal prism of side 1 m rolls down with plastic edge impacts: its spin converges to the
/// one at which an impact takes what a sixth of a turn gives.
#[test]
fn a_hexagonal_prism_rolls_into_its_limit_cycle() {
    for (degrees, before, after) in
        [(10_f64, 2.033_972_418_3, 1.316_099_800_1), (15.0, 2.483_179_187_8, 1.606_763_003_9)]
    {
        let angle = degrees.to_radians();
        let mut case = prism_run(angle);
        let mut state = prism_start(&case, angle);
        // the last edge impact: the spin before it, and the spin left once the weight has brought
        // the prism to rest on its front edge, about which it rotates without loss
        let (mut edge_impact, mut known, mut fell) = ((0.0, 0.0), 1.7, (0.0, 0.0));
        let own = case.block.clone();
        let s = 0.5 - PRISM_BALL_M * crate::math::tan(std::f64::consts::FRAC_PI_6);
        let about_edge = 5.0 / 12.0 + 0.75 + s * s;
        case.follow(&mut state, 12.0, |t, state| {
            let (spin, z) = (state.spin(&own).y, state.pose.centre.z);
            if spin < 0.9 * known && t > fell.0 + SETTLED_S {
                (edge_impact.0, fell) = (known, (t, z));
            }
            if t < fell.0 + SETTLED_S {
                let motion = state.motion_j(&own) / own.mass_kg + G * (z - fell.1);
                edge_impact.1 = (2.0 * motion / about_edge).sqrt();
            }
            known = spin;
        });
        let (cycle, eta) = prism_cycle(angle);
        assert!((edge_impact.0 / cycle - 1.0).abs() < 5e-4, "{degrees}: {edge_impact:?} {cycle}");
        assert!(
            (edge_impact.1 / edge_impact.0 / eta - 1.0).abs() < 5e-4,
            "{degrees}: {edge_impact:?} {eta}"
        );
        // and near the sharp prism's digits
        assert!(
            (edge_impact.0 / before - 1.0).abs() < 0.015,
            "{degrees}: {edge_impact:?} {before}"
        );
        assert!((edge_impact.1 / after - 1.0).abs() < 0.03, "{degrees}: {edge_impact:?} {after}");
    }
}
