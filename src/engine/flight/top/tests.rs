#![allow(
    clippy::excessive_precision,
    reason = "digits as they were computed, one more than f64 has"
)]

use super::*;

/// Leine's box 3 x 2 x 1 m of 1 kg.
const BOX: [f64; 3] = [5.0 / 12.0, 10.0 / 12.0, 13.0 / 12.0];

fn top(inertia: [f64; 3], spin: Vec3) -> Top {
    let start = turn(&Unit::new_normalize(Vec3::new(1.0, 2.0, -0.5)), 0.7);
    let own = Vec3::new(inertia[0] * spin.x, inertia[1] * spin.y, inertia[2] * spin.z);
    Top::new(inertia, start, start * own)
}

/// Spin in the body's frame after `t` (s).
fn own_spin(top: &Top, t: f64) -> Vec3 {
    let attitude = top.attitude(t);
    attitude.inverse_transform_vector(&top.spin(&attitude))
}

/// The two starts of Leine's box against 40 digits: near the middle axis (the flip of Dzhanibekov)
/// and away from it.
#[test]
fn spin_after_twenty_seconds_has_its_digits() {
    let cases = [
        (
            Vec3::new(1e-3, 10.0, 1e-3),
            Vec3::new(0.001_479_651_326_964_0, -9.999_999_920_708_796_4, 0.001_327_559_948_278_5),
            Vec3::new(-3.039_631_708_321_663_7, 9.363_805_499_743_183_9, 2.433_653_142_256_918_2),
        ),
        (
            Vec3::new(3.0, -4.0, 5.0),
            Vec3::new(-2.527_626_400_022_449, -4.413_782_169_811_518_1, 4.829_722_029_619_438_8),
            Vec3::new(4.445_791_008_590_356_6, -1.283_195_130_880_797_1, 5.648_068_520_098_937_6),
        ),
    ];
    for (start, at_5, at_20) in cases {
        // turned, the start would be rounded, and a flip's time with it
        let own = Vec3::from(BOX).component_mul(&start);
        let top = Top::new(BOX, Rotation3::identity(), own);
        let off = [(own_spin(&top, 5.0) - at_5).norm(), (own_spin(&top, 20.0) - at_20).norm()];
        assert!(off[0] < 1e-11 && off[1] < 1e-11, "{off:?}");
    }
}

/// The classical Runge–Kutta method on attitude and constant momentum: another way to the same
/// rotation.
fn integrated(top: &Top, t: f64, steps: u32) -> Matrix3<f64> {
    let rate = |r: &Matrix3<f64>| {
        let w = top.spin(&Rotation3::from_matrix_unchecked(*r));
        w.cross_matrix() * r
    };
    let h = t / f64::from(steps);
    let mut r = *top.start.matrix();
    for _ in 0..steps {
        let k1 = rate(&r);
        let k2 = rate(&(r + k1 * (0.5 * h)));
        let k3 = rate(&(r + k2 * (0.5 * h)));
        let k4 = rate(&(r + k3 * h));
        r += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
    }
    r
}

/// Boxes, nearly symmetric and symmetric bodies, balls, with spins near every axis, on both sides
/// of the separatrix and on it.
#[test]
fn attitude_follows_the_equation_of_motion() {
    let scan = [0.83, 1.37, 1.71];
    for inertia in [BOX, scan, [1.0, 1.0 + 1e-6, 1.6], [1.0, 1.0, 1.6], [1.6, 1.0, 1.0], [0.4; 3]] {
        for spin in [
            Vec3::new(3.0, -4.0, 5.0),
            Vec3::new(9.0, 1.0, -0.3),
            Vec3::new(0.01, 8.0, 0.02),
            Vec3::new(-0.2, 0.1, -7.0),
            Vec3::new(0.0, 0.0, 6.0),
            Vec3::new(-5.0, 0.0, 0.0),
            Vec3::new(0.0, 6.0, 0.0),
            Vec3::new(-9e-16, -6.0, 2e-16),
            Vec3::new(3e-13, 6.0, 1e-12),
            Vec3::new(2e-8, 6.0, -1e-9),
        ] {
            let top = top(inertia, spin);
            let found = top.attitude(2.0);
            let off = (found.matrix() - integrated(&top, 2.0, 20_000)).norm();
            assert!(off < 2e-11, "{inertia:?} {spin:?}: {off:e}");
        }
    }
}

/// Momentum, energy and the length of the axes are conserved to rounding; at time 0 the body is
/// where it was.
#[test]
fn what_is_conserved_stays() {
    for spin in [Vec3::new(1e-3, 10.0, 1e-3), Vec3::new(3.0, -4.0, 5.0)] {
        let top = top(BOX, spin);
        assert!((top.attitude(0.0).matrix() - top.start.matrix()).norm() < 3e-15);
        let energy = top.energy_j();
        for k in 1..200 {
            let attitude = top.attitude(0.1 * f64::from(k));
            let spin = top.spin(&attitude);
            let square = attitude.matrix().transpose() * attitude.matrix();
            assert!((square - Matrix3::identity()).norm() < 4e-15);
            assert!((0.5 * spin.dot(&top.momentum) / energy - 1.0).abs() < 1e-14);
        }
    }
}

/// A body set up to rotate about its middle axis does so, whatever the rounding of its spin, until
/// that has grown e^λt-fold.
#[test]
fn spin_about_the_middle_axis_with_rounding_stays_steady() {
    for seed in 0..200_u32 {
        let off = |k: f64| 1e-15 * crate::math::sin(k * f64::from(seed * seed) + k);
        let spin = Vec3::new(off(1.3), 0.258, off(2.1));
        let top = top(BOX, spin);
        for t in [0.01, 0.15, 1.0, 5.0, 40.0] {
            // λ = 0.48 Ω: at 40 s rounding of 4e-15 of the spin is 6e-13
            let steady = turn(&Unit::new_normalize(top.momentum), 0.258 * t) * top.start;
            let off = (top.attitude(t).matrix() - steady.matrix()).norm();
            assert!(off < 2e-11, "{seed} {t}: {off:e}");
        }
    }
}

/// A wheel in free spin for a minute: its axis stays, however many turns.
#[test]
fn a_wheel_keeps_its_axis() {
    let top = top([1.0, 1.0, 1.6], Vec3::new(0.0, 0.0, 30.0));
    let axis = top.start * Vec3::z();
    for k in 1..=60 {
        assert!((top.attitude(f64::from(k)) * Vec3::z() - axis).norm() < 1e-12);
    }
}

/// The series of a short rotation, as long as it is valid, about every axis: it agrees with fine
/// steps of Runge and Kutta to rounding, and with the closed form to the rounding of that form.
#[test]
fn a_short_turn_is_the_closed_form() {
    let mut worst = [0.0f64; 2];
    for spin in [[3.0, -4.0, 5.0], [1e-3, 10.0, 1e-3], [0.2, 0.1, -9.0], [7.0, 1e-9, 1e-3]] {
        for inertia in [BOX, [1.0, 40.0, 40.5]] {
            let top = top(inertia, Vec3::from(spin));
            let series = top.series_at(top.start, 1e9).unwrap();
            for share in [1e-6, 0.1, 0.5, 1.0] {
                let t = share * series.valid_s;
                let found = series.attitude(t);
                worst[0] = worst[0].max((found.matrix() - integrated(&top, t, 128)).norm());
                worst[1] = worst[1].max((found.matrix() - top.by_closed_form(t).matrix()).norm());
            }
            assert!(series.valid_s > 0.1 * 0.99 / (41.0 * Vec3::from(spin).norm()));
        }
    }
    println!("{worst:?}");
    // rounding of 128 steps
    assert!(worst[0] < 3e-14 && worst[1] < 1e-12, "{worst:?}");
    // closed forms without elliptic functions are cheap enough
    assert!(top([1.0, 1.0, 2.0], Vec3::x()).series_at(Rotation3::identity(), 1.0).is_none());
    assert!(top(BOX, Vec3::zeros()).series_at(Rotation3::identity(), 1.0).is_none());
}

/// The motion of no point of a body exceeds the bounds, and about a principal axis the bound on the
/// acceleration is attained.
#[test]
fn bends_bound_the_ways_of_all_points() {
    let starts = [Vec3::new(3.0, -4.0, 5.0), Vec3::new(0.1, 6.0, 0.1), Vec3::new(0.0, 0.0, 5.0)];
    for (start, inertia) in starts.into_iter().flat_map(|s| [(s, BOX), (s, [1.0, 3.0, 3.5])]) {
        let top = top(inertia, start);
        let (mut most, h) = ([0.0_f64; 2], 1e-3);
        for k in 0..400 {
            let attitude =
                |steps: f64| top.attitude(0.01 * f64::from(k) + steps * h).matrix() * 1.0;
            // central differences of the rotation: their norms are the largest of any point over
            // its length
            let second = attitude(1.0) - attitude(0.0) * 2.0 + attitude(-1.0);
            let third = (attitude(0.5) - attitude(-0.5)) * 3.0 - (attitude(1.5) - attitude(-1.5));
            for (most, difference) in most.iter_mut().zip([second / (h * h), third / (h * h * h)]) {
                *most = most.max(difference.svd(false, false).singular_values.max());
            }
        }
        let bounds = top.point_bounds();
        let shares = [most[0] / bounds.acceleration, most[1] / bounds.jerk];
        let is_steady = start.x.abs() < f64::EPSILON;
        assert!(shares.iter().all(|share| *share <= 1.0 + 1e-5), "{shares:?}");
        let least = if is_steady { [0.999; 2] } else { [0.3, 0.05] };
        assert!(shares[0] > least[0] && shares[1] > least[1], "{shares:?}");
    }
}

/// The angular acceleration is the rate of the spin.
#[test]
fn spin_changes_by_the_angular_acceleration() {
    for (start, t) in [(Vec3::new(3.0, -4.0, 5.0), 0.7), (Vec3::new(1e-3, 10.0, 1e-3), 2.1)] {
        let (top, h) = (top(BOX, start), 1e-4);
        let spin = |t: f64| top.spin(&top.attitude(t));
        let rate = (spin(t + h) - spin(t - h)) / (2.0 * h);
        let found = top.angular_acceleration_rad_s2(&top.attitude(t));
        assert!((found - rate).norm() < 1e-6 * (1.0 + rate.norm()), "{found} {rate}");
    }
}
