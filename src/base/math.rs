//! Exponentials, logarithms, angles: the same bits on every machine.
//!
//! Those of `std` come from the system's C library, whose variants for processors with and without fused
//! multiplication round differently; rocks of one study computed on unlike machines would then not be the same rocks.
//! All that reaches a result or a figure is taken from here. Clippy refuses the methods of `f64` (`clippy.toml`).

pub mod elliptic;

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

pub use libm::{
    acos, acosh, asin, atan, atan2, atanh, cbrt, cos, erfc, exp, hypot, log as ln, log2, log10,
    pow, sin, tan,
};

/// Sine and cosine of an angle (rad).
pub fn sin_cos(angle_rad: f64) -> (f64, f64) {
    libm::sincos(angle_rad)
}

/// The turn by an angle (rad) about an axis, right-handed (Rodrigues' formula).
pub fn turn(axis: &Unit<Vector3<f64>>, angle_rad: f64) -> Rotation3<f64> {
    let (sin, cos) = sin_cos(angle_rad);
    let along = axis.as_ref() * axis.transpose();
    let turned = along + (Matrix3::identity() - along) * cos + axis.cross_matrix() * sin;
    Rotation3::from_matrix_unchecked(turned)
}

/// One step of length `h` by the classical explicit Runge–Kutta method of order four (Kutta 1901), from the rates at a state: for references
/// that must know nothing of the schemes that are compared with them.
pub fn runge_kutta_4<const N: usize>(
    state: &[f64; N],
    h: f64,
    rate: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let after = |k: &[f64; N], h: f64| std::array::from_fn(|i| state[i] + h * k[i]);
    let k1 = rate(state);
    let k2 = rate(&after(&k1, 0.5 * h));
    let k3 = rate(&after(&k2, 0.5 * h));
    let k4 = rate(&after(&k3, h));
    std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// Halvings in search of a crossing: to rounding.
const HALVINGS: u32 = 50;

/// Where between 0 and 1 the cubic with a value and a slope at both ends (Hermite's) crosses zero, downwards or upwards, by bisection.
/// The values are of either side; of several crossings it finds one.
pub fn hermite_crossing([x0, d0]: [f64; 2], [x1, d1]: [f64; 2], down: bool) -> f64 {
    let (b, a) = (3.0 * (x1 - x0) - 2.0 * d0 - d1, d0 + d1 - 2.0 * (x1 - x0));
    let is_before = |t: f64| {
        let x = x0 + t * (d0 + t * (b + t * a));
        if down { x >= 0.0 } else { x <= 0.0 }
    };
    let [lo, hi] = bisected([0.0, 1.0], HALVINGS, is_before);
    0.5 * (lo + hi)
}

/// An interval, halved so many times, from the last place before something to the first behind it.
pub fn bisected(
    [mut lo, mut hi]: [f64; 2],
    halvings: u32,
    mut is_before: impl FnMut(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (lo + hi);
        *(if is_before(middle) { &mut lo } else { &mut hi }) = middle;
    }
    [lo, hi]
}

/// The nearest number with so many significant digits.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{:.*e}", digits.max(1) - 1, value).parse().unwrap_or(value)
}

/// A number of two significant digits that is no smaller, at most a tenth larger, for advice like "write 130 or more"; `value` positive.
pub fn rounded_up(value: f64) -> f64 {
    let unit = 10.0f64.powi(log10(value).floor() as i32 - 1);
    let up = rounded((value / unit).ceil() * unit, 2);
    // a logarithm or product that rounding has put just below
    if up >= value { up } else { rounded(up + unit, 2) }
}

#[cfg(test)]
mod tests {
    use super::*;
    type Vec3 = Vector3<f64>;

    #[test]
    fn sine_and_cosine_at_once_are_those_one_by_one() {
        for k in 0..20_000 {
            let x = exp(1e-3 * f64::from(k) - 12.0);
            assert_eq!(sin_cos(x), (sin(x), cos(x)));
            assert_eq!(sin_cos(-x), (sin(-x), cos(-x)));
        }
    }

    #[test]
    fn numbers_rounded_up_are_no_smaller() {
        let pairs = [(123.4, "130"), (120.0, "120"), (0.0991, "0.1"), (9.95, "10"), (1.0, "1")];
        for (value, said) in pairs {
            assert_eq!(rounded_up(value).to_string(), said);
        }
        for k in 1..5000 {
            let value = exp(0.01 * f64::from(k) - 20.0);
            let up = rounded_up(value);
            assert!(up >= value && up <= 1.1001 * value, "{value} {up}");
        }
    }

    /// A swing over half its period, in steps and in half as long ones: the error falls by 2⁴.
    #[test]
    fn explicit_steps_are_of_order_four() {
        let off = |steps: u32| {
            let h = std::f64::consts::PI / f64::from(steps);
            let swing = |y: &[f64; 2]| [y[1], -y[0]];
            let end = (0..steps).fold([1.0, 0.0], |y, _| runge_kutta_4(&y, h, swing));
            hypot(end[0] + 1.0, end[1])
        };
        assert!((log2(off(50) / off(100)) - 4.0).abs() < 0.05, "{} {}", off(50), off(100));
    }

    /// A quarter turn about z takes x to y; lengths stay.
    #[test]
    fn a_turn_is_right_handed_and_keeps_lengths() {
        let quarter = turn(&Vec3::z_axis(), 0.5 * std::f64::consts::PI);
        assert!((quarter * Vec3::x() - Vec3::y()).norm() < 1e-15);
        let axis = Unit::new_normalize(Vec3::new(1.0, -2.0, 0.5));
        let v = Vec3::new(0.3, 0.4, -7.0);
        let turned = turn(&axis, 1.234) * v;
        assert!((turned.norm() - v.norm()).abs() < 4e-15 * v.norm());
        assert!((turned.dot(&axis) - v.dot(&axis)).abs() < 1e-14);
        assert!((turned - Rotation3::from_axis_angle(&axis, 1.234) * v).norm() < 1e-14);
    }

    /// Bits that must never change: a published run can be repeated only as long as they do not.
    #[test]
    fn bits_are_those_of_every_machine() {
        let x = 0.737_372_1;
        let found =
            [sin(x), cos(x), tan(x), atan2(x, 0.4), exp(-x), ln(x), pow(x, 0.3), hypot(x, 3.0)];
        let bits = found.map(f64::to_bits);
        assert_eq!(bits, BITS, "{bits:?}");
    }

    const BITS: [u64; 8] = [
        4_604_231_164_604_569_244,
        4_604_842_690_419_111_072,
        4_606_356_298_226_681_008,
        4_607_514_581_934_838_694,
        4_602_289_156_421_002_099,
        13_822_531_970_792_100_887,
        4_606_395_673_111_392_447,
        4_614_138_883_235_811_309,
    ];
}
