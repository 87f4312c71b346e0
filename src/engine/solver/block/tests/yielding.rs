//! Impacts on something that breaks.

use super::*;
use proptest::prelude::*;

fn vector(size: f64) -> impl Strategy<Value = Vec3> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(move |x: [f64; 3]| Vec3::from(x) * size)
}

/// A box of 2 m × 1 m × 0.6 m that is not turned.
fn mass() -> (Block, Mass) {
    let block = block(&box_surface([2.0, 1.0, 0.6]), 0.05);
    let still = Motion {
        time_s: 0.0,
        position_m: Vec3::zeros(),
        velocity_m_s: Vec3::zeros(),
        spin_rad_s: Vec3::zeros(),
    };
    let state = BlockState::new(&block, (still.position_m, Rotation3::identity()), &still);
    let mass = state.mass(&block);
    (block, mass)
}

/// Struck straight through its centre of mass and without friction a block goes on with
/// `√(v² − 2E/m)`, and stops where the stem can take all of its motion.
#[test]
fn a_central_blow_takes_its_limit_off_the_speed() {
    let (block, mass) = mass();
    let contact = BlockContact::new(&mass, (Vec3::x(), -Vec3::x()), (0.0, 0), Vec3::zeros());
    let (u, m) = (Vec3::new(-10.0, 3.0, 0.0), block.mass_kg);
    for share in [1e-6, 0.1, 0.5, 0.9, 0.999] {
        let limit_j = share * 0.5 * m * 100.0;
        let impulse = contact.yielding(&u, limit_j).unwrap();
        let speed_left = 10.0 * f64::sqrt(1.0 - share);
        assert!(
            (impulse / m - Vec3::x() * (10.0 - speed_left)).norm() < 1e-9,
            "{share}: {impulse:?}"
        );
    }
    assert!(contact.yielding(&u, 1.001 * 0.5 * m * 100.0).is_none());
}

proptest! {
    /// Wherever it is struck: the broken stem has absorbed its limit to rounding, the impulse
    /// pushes and never pulls, and obeys Coulomb's cone.
    #[test]
    fn a_blow_takes_its_limit_within_the_cone(
        lever in vector(1.0),
        n in vector(1.0),
        u in vector(20.0),
        friction in 0.0..1.5f64,
        share in 0.01..1.2f64,
    ) {
        prop_assume!(n.norm() > 0.1);
        let (_, mass) = mass();
        let n = n.normalize();
        prop_assume!(n.dot(&u) < -0.1);
        let contact = BlockContact::new(&mass, (n, lever), (friction, 0), Vec3::zeros());
        // the energy that an impact without friction absorbs until the point stops along the normal
        let available_j: f64 = 0.5 * n.dot(&u).powi(2) / n.dot(&(contact.delassus * n));
        let Some(impulse) = contact.yielding(&u, share * available_j) else {
            prop_assert!(friction > 0.0 || share >= 1.0);
            return Ok(());
        };
        let taken_j: f64 = -(u.dot(&impulse) + 0.5 * impulse.dot(&(contact.delassus * impulse)));
        prop_assert!((taken_j / (share * available_j) - 1.0).abs() < 1e-9, "{}", taken_j);
        let push = n.dot(&impulse);
        prop_assert!(push > 0.0 && (impulse - n * push).norm() <= friction * push * (1.0 + 1e-9));
    }

    /// With enough friction a contact point that slips at first stops slipping, and stays so.
    #[test]
    fn enough_friction_ends_the_slip(lever in vector(0.3), selected in -1.0..1.0f64) {
        let (_, mass) = mass();
        let lever = lever - Vec3::x();
        let contact = BlockContact::new(&mass, (Vec3::x(), lever), (5.0, 0), Vec3::zeros());
        let u = Vec3::new(-10.0, selected, 0.5);
        let available_j = 50.0 / contact.delassus.m11;
        let Some(impulse) = contact.yielding(&u, 0.7 * available_j) else { return Ok(()) };
        let after = u + contact.delassus * impulse;
        prop_assert!(after.x < 0.0 && after.yz().norm() < 0.02, "{after:?}");
    }
}
