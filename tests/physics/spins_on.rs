//! A rock that stays on its place and spins does not rest.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::{CASE, Case, ROCK, terrain};

use rockfall::rock::Vec3;
use rockfall::simulation::Stop;

/// A sphere stands on a level plane and spins about the vertical at 1 m/s on its rim. The point of contact does not slip, and without rolling
/// friction nothing slows the spin: it goes on for as long as it is followed, however still its centre is. Without spin it rests.
#[test]
fn a_rock_that_spins_on_the_spot_does_not_rest() {
    let p = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let level = terrain(vec![
        [p(-9.0, -9.0), p(9.0, -9.0), p(9.0, 9.0)],
        [p(-9.0, -9.0), p(9.0, 9.0), p(-9.0, 9.0)],
    ]);
    let case = Case { rest_time_s: 0.2, ..CASE };
    let r = ROCK.radius_m;
    let fall =
        |spin_rad_s: f64| case.run(&level, [[0.3, 0.2, r], [0.0; 3], [0.0, 0.0, spin_rad_s]], 2.0);
    let spinning = fall(1.0 / r);
    assert_eq!(spinning.stop, Stop::TimeUp);
    assert!((spinning.end.spin_rad_s.z * r - 1.0).abs() < 1e-6, "{:?}", spinning.end);
    assert_eq!(fall(0.0).stop, Stop::AtRest);
}
