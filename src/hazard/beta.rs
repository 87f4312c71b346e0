//! The beta distribution: its distribution function and its quantiles, of which exact intervals of shares are made.

use crate::math;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Least part of a continued fraction that is taken into account (–).
const NEGLIGIBLE: f64 = 1e-15;
/// Most terms of it: of parameters of a thousand million some ten thousand are needed.
const MOST_TERMS: u32 = 100_000;
/// Steps in which a quantile is found, at most: those of Halley's method treble the digits, halvings give one bit each.
const MOST_STEPS: u32 = 100;
/// Where steps end: the next would be the cube of this (–, of the quantile).
const CONVERGED: f64 = 1e-9;

/// Logarithm of the density of beta(a, b) times `x (1 − x)`: `a ln x + b ln(1 − x) − ln B(a, b)`.
struct Beta {
    a: f64,
    b: f64,
    ln_whole: f64,
}

impl Beta {
    fn new(a: f64, b: f64) -> Self {
        let ln_gamma = libm::lgamma;
        Self { a, b, ln_whole: ln_gamma(a) + ln_gamma(b) - ln_gamma(a + b) }
    }

    fn front(&self, x: f64) -> f64 {
        math::exp(self.a * math::ln(x) + self.b * libm::log1p(-x) - self.ln_whole)
    }

    /// `I_x(a, b)`, the chance of a value below `x`, 0 < x < 1; `front` is that of `x`.
    fn below(&self, x: f64, front: f64) -> f64 {
        let Self { a, b, .. } = *self;
        if x < (a + 1.0) / (a + b + 2.0) {
            front * fraction(x, [a, b]) / a
        } else {
            1.0 - front * fraction(1.0 - x, [b, a]) / b
        }
    }
}

/// The continued fraction of the incomplete beta function (Olver et al. 2010, NIST Handbook, 8.17.22), from its front by the
/// method of Lentz as Thompson and Barnett (1986) have it.
fn fraction(x: f64, [a, b]: [f64; 2]) -> f64 {
    let kept = |value: f64| if value.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { value };
    let mut d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
    let (mut c, mut whole) = (1.0, d);
    for term in 1..MOST_TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for coefficient in [even, odd] {
            d = 1.0 / kept(1.0 + coefficient * d);
            c = kept(1.0 + coefficient / c);
            factor = c * d;
            whole *= factor;
        }
        if (factor - 1.0).abs() < NEGLIGIBLE {
            break;
        }
    }
    whole
}

/// The value below which beta(a, b) lies with probability `p`: 0 of none to the left (a = 0), 1 of none to the right (b = 0).
///
/// By Halley's method on `I_x(a, b) = p`, inside a bracket that every step narrows.
pub(super) fn quantile(p: f64, [a, b]: [f64; 2]) -> f64 {
    if a <= 0.0 || b <= 0.0 {
        return if a <= 0.0 { 0.0 } else { 1.0 };
    }
    let beta = Beta::new(a, b);
    let (mut low, mut high) = (0.0, 1.0);
    let mut x = start(p, &beta);
    for _ in 0..MOST_STEPS {
        let front = beta.front(x);
        let off = beta.below(x, front) - p;
        if off < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = off * x * (1.0 - x) / front;
        let bend = newton * ((a - 1.0) / x - (b - 1.0) / (1.0 - x));
        let next = x - newton / (1.0 - 0.5 * bend.clamp(-1.0, 1.0));
        let is_inside = low < next && next < high;
        let next = if is_inside { next } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        x = next;
        if step <= CONVERGED * x.min(1.0 - x) {
            break;
        }
    }
    x
}

/// The value below which a standard normal variable lies with the chance that beta(a, b) is below `x`, to 1e-6 where that is not rarer than 1e-6.
pub(super) fn normal_score(x: f64, [a, b]: [f64; 2]) -> f64 {
    let beta = Beta::new(a, b);
    let chance = beta.below(x, beta.front(x)).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON);
    let z = normal(chance);
    // one step of Newton's
    let off = 0.5 * math::erfc(-z * FRAC_1_SQRT_2) - chance;
    z - off * TAU.sqrt() * math::exp(0.5 * z * z)
}

/// Where to begin: a normal value through Wilson and Hilferty's cubes (Abramowitz and Stegun 1964, 26.5.22); for a parameter
/// below 1 by the tail on that side alone.
fn start(p: f64, &Beta { a, b, ln_whole }: &Beta) -> f64 {
    let inside = |x: f64| x.clamp(1e-300, 1.0 - f64::EPSILON);
    if a < 1.0 || b < 1.0 {
        let tail = |share: f64, a: f64| math::exp((math::ln(share * a) + ln_whole) / a);
        let left = tail(p, a);
        return inside(if left < a / (a + b) { left } else { 1.0 - tail(1.0 - p, b) });
    }
    let z = -normal(p);
    let (u, v) = (1.0 / (2.0 * a - 1.0), 1.0 / (2.0 * b - 1.0));
    let (third, h) = ((z * z - 3.0) / 6.0, 2.0 / (u + v));
    let root = z * (third + h).max(0.0).sqrt() / h;
    let w = root - (v - u) * (third + 5.0 / 6.0 - 2.0 / (3.0 * h));
    inside(a / (a + b * math::exp(2.0 * w)))
}

/// Quantile of the standard normal distribution, to 5e-4 (Abramowitz and Stegun 1964, 26.2.23).
fn normal(p: f64) -> f64 {
    let tail = p.min(1.0 - p);
    let t = (-2.0 * math::ln(tail)).sqrt();
    let over = (0.010_328 * t + 0.802_853) * t + 2.515_517;
    let under = ((0.001_308 * t + 0.189_269) * t + 1.432_788) * t + 1.0;
    let far = t - over / under;
    if p < 0.5 { -far } else { far }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed forms: `1 − (1 − p)^(1/b)` of beta(1, b) and `p^(1/a)` of beta(a, 1); by arbitrary precision those of 3 and of 81 successes among
    /// 1000 and 263, and of a parameter below one.
    #[test]
    fn quantiles_are_those_of_closed_forms_and_of_many_digits() {
        let near = |found: f64, exact: f64| {
            assert!((found / exact - 1.0).abs() < 1e-9, "{found} for {exact}");
        };
        for n in [1.0, 2.0, 30.0, 1e3, 1e5] {
            for p in [0.025, 0.05, 0.975] {
                near(quantile(p, [1.0, n]), -(((-p).ln_1p() / n).exp_m1()));
                near(quantile(p, [n, 1.0]), (p.ln() / n).exp());
            }
        }
        near(quantile(0.025, [3.0, 998.0]), 6.190_999_316_494_7e-4);
        near(quantile(0.975, [4.0, 997.0]), 8.742_023_238_477_7e-3);
        near(quantile(0.025, [81.0, 183.0]), 0.252_736_745_585);
        near(quantile(0.025, [0.3, 50.0]), 6.416_173_074_8e-8);
        assert!(quantile(0.025, [0.0, 4.0]) <= 0.0 && quantile(0.975, [4.0, 0.0]) >= 1.0);
    }

    /// The `i`-th of `n` values lies below the share of which beta has 2.5, 50 and 97.5 % with −1.96, 0 and 1.96.
    #[test]
    fn a_normal_score_is_that_of_the_chance() {
        for [a, b] in [[1.0, 72.0], [3.0, 998.0], [0.7, 0.8], [5e5, 2e4]] {
            for (p, z) in [(0.025, -1.959_963_985), (0.5, 0.0), (0.975, 1.959_963_985)] {
                let found = normal_score(quantile(p, [a, b]), [a, b]);
                assert!((found - z).abs() < 1e-5, "{p} of beta({a}, {b}): {found}");
            }
        }
    }

    /// The chance of a value below the quantile is what was asked, over eight decades of both parameters.
    #[test]
    fn a_quantile_has_its_chance_below_it() {
        for step in 0..400 {
            let power = |k: i32| 10_f64.powf(-1.0 + 0.4 * f64::from(k));
            let (a, b) = (power(step % 20), power(step / 20));
            let beta = Beta::new(a, b);
            for p in [0.025, 0.5, 0.975] {
                let x = quantile(p, [a, b]);
                // nearer to 1 than numbers are told apart
                let is_told = x < 1.0 - 1e-12 && x > 0.0;
                let off = if is_told { beta.below(x, beta.front(x)) - p } else { 0.0 };
                assert!(off.abs() < 1e-6, "{p} of beta({a}, {b}): {x} is off by {off}");
            }
        }
    }
}
