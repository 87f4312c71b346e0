//! Elliptic functions and integrals, with the complementary parameter `1 − m` given where `m` near 1 would lose it.

use super::{atan2, sin_cos};

/// Terms of the arithmetic-geometric mean kept at most: it converges quadratically.
const MEANS: usize = 16;
/// Spread of two means below which the next is exact to rounding (–): it is the square.
const MEANS_AGREE: f64 = 1e-8;
/// Relative spread of arguments below which Carlson's series is exact to rounding (–): its first term left out is of order eight.
const SPREAD: f64 = 1e-2;
/// Excess over 1 below which the series of `R_C(1, 1 + e)` is exact to rounding (–): the second step of `R_J` has come to it.
const NEAR_ONE: f64 = 1.0 / 64.0;

/// Carlson's `R_F(x, y, z) = ½ ∫₀^∞ dt/√((t+x)(t+y)(t+z))` by duplication (Carlson 1995); arguments ≥ 0, at most one 0.
pub fn rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < SPREAD {
            let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0
                - 3.0 * e2 * e3 / 44.0
                - 5.0 * e2 * e2 * e2 / 208.0
                + 3.0 * e3 * e3 / 104.0
                + e2 * e2 * e3 / 16.0;
            return series / mean.sqrt();
        }
        let (sx, sy, sz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = sx * sy + sy * sz + sz * sx;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
}

/// Carlson's `R_C(x, y) = R_F(x, y, y)`; `x ≥ 0`, `y > 0`.
pub fn rc(x: f64, y: f64) -> f64 {
    rf(x, y, y)
}

/// `R_C(1, 1 + e)`, `e > −1`: near 1 its power series, `Σ (−e)^k/(2k + 1)`.
fn rc_near_one(e: f64) -> f64 {
    if e.abs() > NEAR_ONE {
        return rc(1.0, 1.0 + e);
    }
    (0..=8_u32).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 1) - e * sum)
}

/// Carlson's `R_J(x, y, z, p) = 3/2 ∫₀^∞ dt/((t+p)√((t+x)(t+y)(t+z)))`; arguments ≥ 0, at most one of the first three 0,
/// `p > 0`.
pub fn rj(mut x: f64, mut y: f64, mut z: f64, mut p: f64) -> f64 {
    let (mut sum, mut share) = (0.0, 1.0);
    let mut apart = (p - x) * (p - y) * (p - z);
    loop {
        let mean = (x + y + z + 2.0 * p) / 5.0;
        let [dx, dy, dz, dp] = [x, y, z, p].map(|a| 1.0 - a / mean);
        if [dx, dy, dz, dp].iter().fold(0.0, |most: f64, d| most.max(d.abs())) < SPREAD {
            return 6.0 * sum + share * rj_series([dx, dy, dz, dp]) / (mean * mean.sqrt());
        }
        let (sx, sy, sz, sp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = sx * sy + sy * sz + sz * sx;
        let d = (sp + sx) * (sp + sy) * (sp + sz);
        sum += share / d * rc_near_one(apart / (d * d));
        share *= 0.25;
        apart /= 64.0;
        [x, y, z, p] = [x, y, z, p].map(|a| 0.25 * (a + lambda));
    }
}

/// The series of `R_J` times `mean^{3/2}` in what its arguments are less than their mean, relative to it (Carlson 1995).
fn rj_series([dx, dy, dz, dp]: [f64; 4]) -> f64 {
    let (ea, eb, ec) = (dx * (dy + dz) + dy * dz, dx * dy * dz, dp * dp);
    let e2 = ea - 3.0 * ec;
    let e3 = eb + 2.0 * dp * (ea - ec);
    let e4 = dp * (2.0 * eb + dp * ea);
    let e5 = eb * ec;
    let sixth = -e2 * e2 * e2 / 16.0 + 3.0 * e3 * e3 / 40.0 + 3.0 * e2 * e4 / 20.0;
    let seventh = 45.0 * e2 * e2 * e3 / 272.0 - 9.0 * (e3 * e4 + e2 * e5) / 68.0;
    1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
        + 3.0 * e5 / 26.0
        + (sixth + seventh)
}

/// Jacobi's sn and cn of `u`, within a quarter period on either side of 0, both to rounding of their own size however near `m` is to 1.
///
/// Gauss' descending transformation in `cs = cn/sn` (Bulirsch 1965): sums of positive terms only, so nothing cancels. As the cosine of an
/// amplitude near π/2, cn would have no digits left where the body turns about its middle axis.
fn sn_cn(u: f64, mc: f64) -> (f64, f64) {
    let mut means = [(1.0, 1.0); MEANS];
    let ((mut a, mut b), mut count) = ((1.0_f64, mc.sqrt()), 0);
    while count < MEANS {
        means[count] = (a, b);
        count += 1;
        let agree = (a - b).abs() <= MEANS_AGREE * a;
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        if agree {
            break;
        }
    }
    let (sin, cos) = sin_cos(a * u);
    if sin == 0.0 {
        return (0.0, 1.0);
    }
    let (mut ratio, mut dn) = (cos / sin, 1.0);
    let mut cs = a * ratio;
    for (mean, root) in means[..count].iter().rev() {
        let square = ratio * cs;
        cs *= dn;
        dn = (root + square) / (mean + square);
        ratio = cs / mean;
    }
    let sn = sin.signum() / super::hypot(1.0, cs);
    (sn, cs * sn)
}

/// Jacobi's functions of a time: whole half turns of the amplitude, and sine and cosine of what is left of it (−π/2..π/2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobi {
    /// Half turns (–).
    pub halves: f64,
    /// Sine of the rest (–): `sn` but for the sign of odd half turns.
    pub sn: f64,
    /// Cosine of the rest (–), `cn` but for the same sign.
    pub cn: f64,
}

/// An elliptic modulus with its quarter period.
#[derive(Debug, Clone, Copy)]
pub struct Elliptic {
    mc: f64,
    /// `K(m)`.
    quarter: f64,
}

impl Elliptic {
    /// Of complementary parameter `mc = 1 − m`, `0 < mc ≤ 1`.
    pub fn of_complement(mc: f64) -> Self {
        Self { mc, quarter: rf(0.0, mc, 1.0) }
    }

    /// The functions of `u`.
    pub fn functions(&self, u: f64) -> Jacobi {
        let halves = (0.5 * u / self.quarter).round();
        let rest = u - 2.0 * halves * self.quarter;
        let (sn, cn) = sn_cn(rest, self.mc);
        Jacobi { halves, sn, cn }
    }

    /// `dn` where the sine and cosine of the amplitude are these.
    pub fn dn(&self, sn: f64, cn: f64) -> f64 {
        (cn * cn + self.mc * sn * sn).sqrt()
    }

    /// `F(φ, m)` for sine and cosine of an angle φ.
    pub fn first_kind(&self, (sin, cos): (f64, f64)) -> f64 {
        let (halves, sin, cos) = reduced(sin, cos);
        let delta = cos * cos + self.mc * sin * sin;
        2.0 * halves * self.quarter + sin * rf(cos * cos, delta, 1.0)
    }

    /// The integral of the third kind of characteristic `n ≤ 0`.
    pub fn third_kind(self, n: f64) -> ThirdKind {
        let mut third = ThirdKind { of: self, n, quarter: 0.0 };
        third.quarter = third.of_rest(1.0, 0.0);
        third
    }
}

/// `Π(n; φ, m) = ∫₀^φ dθ/((1 − n sin²θ)√(1 − m sin²θ))` for one `n ≤ 0`, with its value at a quarter period: a body that spins asks
/// for it at every moment.
#[derive(Debug, Clone, Copy)]
pub struct ThirdKind {
    of: Elliptic,
    n: f64,
    quarter: f64,
}

impl ThirdKind {
    /// Up to the amplitude of some functions.
    pub fn at(&self, functions: &Jacobi) -> f64 {
        2.0 * functions.halves * self.quarter + self.of_rest(functions.sn, functions.cn)
    }

    fn of_rest(&self, s: f64, c: f64) -> f64 {
        let (c2, s2) = (c * c, s * s);
        let delta = c2 + self.of.mc * s2;
        s * rf(c2, delta, 1.0) + self.n / 3.0 * s * s2 * rj(c2, delta, 1.0, 1.0 - self.n * s2)
    }
}

/// Half turns, sine and cosine of the rest (cosine ≥ 0).
fn reduced(sin: f64, cos: f64) -> (f64, f64, f64) {
    if cos >= 0.0 {
        return (0.0, sin, cos);
    }
    (if atan2(sin, cos) > 0.0 { 1.0 } else { -1.0 }, -sin, -cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Carlson's own test values (1995, tables), and `K(1/2) = Γ(1/4)²/(4√π)`.
    #[test]
    fn integrals_have_their_published_values() {
        let close = |found: f64, known: f64| {
            assert!((found / known - 1.0).abs() < 4e-15, "{found} {known}");
        };
        close(rf(1.0, 2.0, 0.0), 1.311_028_777_146_059_9);
        close(rf(2.0, 3.0, 4.0), 0.584_082_841_677_151_7);
        close(rc(0.0, 0.25), std::f64::consts::PI);
        close(rj(0.0, 1.0, 2.0, 3.0), 0.776_886_237_785_823_3);
        close(rj(2.0, 3.0, 4.0, 5.0), 0.142_975_796_671_567_5);
        close(Elliptic::of_complement(0.5).quarter, 1.854_074_677_301_371_9);
    }

    /// Against forty digits (by another program), for arguments near and far from each other.
    #[test]
    fn integrals_are_exact_near_and_far() {
        let close = |found: f64, known: f64| {
            assert!((found / known - 1.0).abs() < 2e-15, "{found} {known}");
        };
        close(rf(0.0, 1.0e-12, 1.0), 15.201_804_919_087_715);
        close(rf(0.2, 0.21, 1.0), 1.603_664_912_819_762_6);
        close(rf(0.98, 0.99, 1.0), 1.005_048_070_136_720_6);
        close(rf(1.0e-08, 1.0, 100_000_000.0), 0.001_059_653_476_208_732_6);
        close(rj(2.0, 3.0, 4.0, 5.0), 0.142_975_796_671_567_54);
        close(rj(0.0, 1.0, 2.0, 3.0), 0.776_886_237_785_823_3);
        close(rj(0.0, 1.0e-12, 1.0, 1.5), 28.662_770_335_450_446);
        close(rj(0.001, 0.25, 1.0, 40.0), 0.140_557_608_694_15);
        close(rj(0.9, 0.95, 1.0, 1.0001), 1.047_657_767_135_609);
        close(rj(1.0, 1.0, 1.0, 10_000.0), 0.000_295_346_912_073_860_76);
        close(rj(0.3, 0.6, 1.0, 0.01), 12.223_788_467_629_74);
        close(rj(0.5, 2.0, 1_000_000.0, 1.0), 0.001_441_796_056_904_534_2);
    }

    /// The functions invert the integral of the first kind, from m = 0 to the separatrix, wherever they are told from rest.
    #[test]
    fn the_functions_invert_the_integral() {
        for mc in [1.0, 0.9, 0.5, 0.03, 1e-4, 7.5e-9, 1e-16, 1e-30, 1e-200, f64::MIN_POSITIVE] {
            let of = Elliptic::of_complement(mc);
            for k in -40..=40 {
                let u = 0.0491 * f64::from(k) * of.quarter;
                let Jacobi { halves, sn, cn } = of.functions(u);
                let back = 2.0 * halves * of.quarter + of.first_kind((sn, cn));
                let allowed = 2e-15 * (1.0 + u.abs());
                assert!((back - u).abs() < allowed, "{mc} {u} {back}");
                assert!((sn * sn + cn * cn - 1.0).abs() < 1e-15 && cn >= 0.0);
            }
        }
    }

    /// Against forty digits (by another program).
    #[test]
    fn the_functions_have_their_digits() {
        let known = [
            (0.9, 1.3, 0.956_253_289_327_763_9, 0.292_539_991_539_331_25),
            (0.03, -0.7, -0.605_568_052_707_390_9, 0.795_793_524_439_712_1),
            (0.0001, 5.2, 0.999_961_554_448_118_2, 0.008_768_672_972_752_212),
            (1.0e-07, 3.0, 0.995_054_777_823_116_6, 0.099_327_685_623_838_31),
            (1.0, 0.25, 0.247_403_959_254_522_94, 0.968_912_421_710_644_7),
        ];
        for (mc, u, sn, cn) in known {
            let found = sn_cn(u, mc);
            let off = (found.0 - sn).abs().max((found.1 - cn).abs());
            assert!(off < 2e-15, "{mc} {u}: {off}");
        }
    }

    /// At the separatrix they are hyperbolic: cn = 1/cosh u far from the quarter period, √(1−m) sinh(K−u) near it.
    #[test]
    fn at_the_separatrix_the_functions_are_hyperbolic() {
        for mc in [1e-24_f64, 1e-30, 1e-60, 1e-200] {
            let of = Elliptic::of_complement(mc);
            for u in [0.5_f64, 2.0, 7.0, 11.0] {
                let cosh = 0.5 * (crate::math::exp(u) + crate::math::exp(-u));
                assert!((of.functions(u).cn * cosh - 1.0).abs() < 1e-13, "{mc} {u}");
                let sinh = 0.5 * (crate::math::exp(u) - crate::math::exp(-u));
                let late = of.functions(of.quarter - u).cn / (mc.sqrt() * sinh);
                // the time itself is known to its rounding
                assert!((late - 1.0).abs() < 1e-15 * of.quarter / u.min(1.0) + 1e-13);
            }
        }
    }
}
