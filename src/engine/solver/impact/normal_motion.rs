//! The normal motion of one impact on a plane, with gravity, in closed form.
//!
//! In units of the approach speed `v_n` and of `1/ω` the penetration obeys `x'' = γ − 2ζ x' − x`,
//! `x(0) = 0`, `x'(0) = 1`, with `γ = g_n/(ω v_n)`. With the impulse response `S` of the free
//! oscillator, `S(0) = 0`, `S'(0) = 1`,
//!
//! - `x = S + γ (1 − S' − 2ζ S)` and `x' = S' + γ S`;
//! - the force over `m ω v_n` is `f = x + 2ζ x' = S + 2ζ S' + γ (1 − S')`, and
//!   `f'' = γ − f − 2ζ f'`;
//! - it ends where `f` first falls to zero. There `x'' = γ`, so `x' = f' − 2ζ γ` and `x = −2ζ x'`.
//!
//! Without gravity that is at `t_c`, where `f' = −e`; gravity moves it by about `γ (1 + e)/e`. From
//! there a Taylor series, whose terms follow from the equation itself, gives it to rounding without
//! further sines (numerics 2.1, 2.2).
//!
//! Scales: `m` the mass, `p_N` and `c_N` the contact's, `ω = √(p_N/m)`, `ζ = c_N/(2 √(p_N m))`. An
//! impact on any plane is then described by two numbers, `ζ` and `γ`; `γ` is small for a fast
//! impact and grows as the rock slows down, until gravity keeps it in contact.

use crate::ground::restitution;
use crate::math;
use std::f64::consts::TAU;

/// Terms of the Taylor series about the end of contact.
const TERMS: usize = 14;
/// Radius around the end of contact within which they give full precision (–, in units of its
/// shortest time).
const SERIES_RADIUS: f64 = 0.3;
/// Convergence limit of a time (1/ω).
const ROOT_ACCURACY: f64 = 1e-13;
/// Newton steps at most, with bisection where a step would leave its bracket.
const NEWTON: u32 = 80;
/// Damping below this is zero (–): the residue of a search for that of `e = 1`.
pub(super) const UNDAMPED: f64 = 1e-12;
/// Damping this close to critical is critical (–).
const CRITICAL: f64 = 1e-9;

/// One spring and dashpot without tension.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalMotion {
    /// Damping ratio `ζ` (–).
    pub(super) zeta: f64,
    /// Restitution without gravity (–).
    ///
    /// `e(ζ) = exp(−2ζ acos ζ/√(1−ζ²))`, for a contact that ends where the force is 0 and nothing
    /// pulls.
    restitution: f64,
    /// Duration of contact without gravity (1/ω).
    pub(super) duration: f64,
}

/// How an impact leaves the plane, in units of `v_n` and `1/ω`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exit {
    /// Time at which the force falls to zero.
    pub(super) lift_off: f64,
    /// Time of free motion from there until the penetration is zero.
    pub(super) clearing: f64,
    /// Speed away from the plane where the penetration is zero again.
    pub(super) speed: f64,
}

impl NormalMotion {
    pub(super) fn new(zeta: f64) -> Self {
        let zeta = if zeta > UNDAMPED { zeta } else { 0.0 };
        // contact ends where S + 2ζ S' = 0, that is S'/S + ζ = ζ − 1/(2ζ)
        Self { zeta, restitution: restitution(zeta), duration: time_at(zeta, zeta - 0.5 / zeta) }
    }

    /// Force and its rate at first contact: `f(0) = 2ζ`, because the dashpot acts at once, and
    /// `f'(0) = 1 − 2ζ (2ζ − γ)`.
    #[inline]
    pub(super) fn onset(&self, gamma: f64) -> [f64; 2] {
        let zeta = self.zeta;
        [2.0 * zeta, 1.0 - 2.0 * zeta * (2.0 * zeta - gamma)]
    }

    /// Force and its rate at the penetration `x` and the speed `inwards` into the plane.
    #[inline]
    pub(super) fn force_at(&self, (x, inwards): (f64, f64), gamma: f64) -> [f64; 2] {
        let damping = 2.0 * self.zeta;
        [x + damping * inwards, inwards + damping * (gamma - damping * inwards - x)]
    }

    /// Penetration and speed into the plane after a time `t` from a start with this force and rate,
    /// and gravity.
    pub(super) fn state_at(&self, from: ([f64; 2], f64), t: f64) -> (f64, f64) {
        let damping = 2.0 * self.zeta;
        let [force, rate] = self.force(from, t);
        let inwards = rate - damping * (from.1 - force);
        (force - damping * inwards, inwards)
    }

    /// How the rock leaves; `None` if gravity keeps it.
    pub(super) fn exit(&self, gamma: f64) -> Option<Exit> {
        let lift_off = self
            .lift_nearby(gamma)
            .or_else(|| self.lift_anywhere((self.onset(gamma), gamma), self.duration))?;
        let exit = self.exit_at(lift_off, gamma)?;
        // Without damping nothing is lost, and no rounding may say otherwise.
        Some(if self.zeta == 0.0 { Exit { speed: 1.0, ..exit } } else { exit })
    }

    /// How a rock leaves from the force and rate `begin`; `None` if gravity keeps it, or nothing
    /// pushes it.
    pub(super) fn exit_from(&self, begin: [f64; 2], gamma: f64) -> Option<Exit> {
        let [force, rate] = begin;
        if force <= 0.0 {
            return None;
        }
        // u = f − γ is a free oscillation: it is 0 where S'/S + ζ = −u'/u − ζ
        let guess = time_at(self.zeta, -rate / (force - gamma) - self.zeta);
        let from = (begin, gamma);
        let near = self.lift_near((guess, self.force(from, guess)), gamma);
        let falls = near.filter(|(lift_off, rate)| *lift_off > 0.0 && *rate < 0.0);
        self.exit_at(falls.or_else(|| self.lift_anywhere(from, guess))?, gamma)
    }

    /// How the rock leaves if it lifts off at that time, with that rate of the force.
    fn exit_at(&self, (lift_off, rate): (f64, f64), gamma: f64) -> Option<Exit> {
        // where f = 0: x' = f' − 2ζγ, so the rock rises at −x', still pressed in by x = −2ζ x'
        let up = 2.0 * self.zeta * gamma - rate;
        let x = 2.0 * self.zeta * up;
        // out of the slab against gravity: up² − 2γ x must be positive, or it falls back
        let left = up * up - 2.0 * gamma * x;
        if up <= 0.0 || left <= 0.0 {
            return None;
        }
        let speed = left.sqrt();
        // x = up·t − γ t²/2 for the time of free motion, without cancellation
        Some(Exit { lift_off, clearing: 2.0 * x / (up + speed), speed })
    }

    /// Time of lift-off and the force's rate there, if it is close to the one without gravity.
    #[inline]
    fn lift_nearby(&self, gamma: f64) -> Option<(f64, f64)> {
        let (zeta, e) = (self.zeta, self.restitution);
        let late = gamma * (1.0 + e) / e;
        // too far for the series: gravity moves the end of contact by a considerable part of its
        // time
        if late.abs() * (2.0 * zeta).max(1.0) > 0.5 * SERIES_RADIUS {
            return None;
        }
        // at t_c the free oscillation has S + 2ζS' = 0 and S' = −e, so there f = γ (1 + e) and f' =
        // −e
        self.lift_near((self.duration, [gamma * (1.0 + e), -e]), gamma)
    }

    /// The same near a time at which force and rate are known.
    #[inline]
    fn lift_near(&self, (at, [force, rate]): (f64, [f64; 2]), gamma: f64) -> Option<(f64, f64)> {
        let zeta = self.zeta;
        let series = Series::<TERMS>::new([force, rate], zeta, gamma);
        let (mut t, mut change) = (-force / rate, f64::INFINITY);
        for _ in 0..8 {
            let [force, rate] = series.value_and_rate(t);
            change = force / rate;
            t -= change;
            if change.abs() <= 1e-14 {
                break;
            }
        }
        // Newton's method does not converge where the force falls to zero much later, or never
        if change.is_nan() || change.abs() > ROOT_ACCURACY {
            return None;
        }
        let is_near = t.abs() * (2.0 * zeta).max(1.0) <= SERIES_RADIUS;
        is_near.then(|| (at + t, series.value_and_rate(t)[1]))
    }

    /// The same without a guess nearby: between the start and the first minimum of the force.
    /// `from` is force and rate at the start, and gravity.
    fn lift_anywhere(&self, from: ([f64; 2], f64), guess: f64) -> Option<(f64, f64)> {
        // the force rises, falls and has its first minimum; if it is below 0 there, it has crossed
        // 0 just once before
        let mut hi = self.first_minimum(from);
        if hi.is_none() && from.1 < 0.0 {
            // Nothing holds the rock: the force becomes negative in the end.
            hi = (0..60).map(|k| 2f64.powi(k)).find(|t| self.force(from, *t)[0] <= 0.0);
        }
        let (mut lo, mut hi) = (0.0, hi.filter(|t| self.force(from, *t)[0] <= 0.0)?);
        let mut t = if guess > 0.0 && guess < hi { guess } else { 0.5 * hi };
        for _ in 0..NEWTON {
            let [force, rate] = self.force(from, t);
            if force > 0.0 {
                lo = t;
            } else {
                hi = t;
            }
            let next = t - force / rate;
            let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
            let change = (next - t).abs();
            t = next;
            if change <= 1e-15 * hi {
                break;
            }
        }
        Some((t, self.force(from, t)[1]))
    }

    /// Time of the first minimum of the force, if it has one: `f' = a S' − β S`, `a` its rate and
    /// `β = f − γ` at the start.
    fn first_minimum(&self, ([force, a], gamma): ([f64; 2], f64)) -> Option<f64> {
        let (zeta, beta) = (self.zeta, force - gamma);
        if 1.0 - zeta * zeta > CRITICAL {
            let wd = (1.0 - zeta * zeta).sqrt();
            // a S' − β S = 0 for a damped oscillation: a sine of known phase, at the first time
            // when it rises through 0
            let phase = math::atan2((a * zeta + beta) / wd, a);
            return Some((-0.25 * TAU - phase).rem_euclid(TAU) / wd);
        }
        // Overdamped, it has at most one extremum: a minimum if it began to fall.
        let y = beta / a + zeta;
        (a < 0.0 && y * y > zeta * zeta - 1.0 && y > 0.0).then(|| time_at(zeta, y))
    }

    /// Force and its rate at any time: `f − γ = β (S' + 2ζ S) + a S`, written so that a large `γ`
    /// costs no digits of a small time.
    fn force(&self, ([force, a], gamma): ([f64; 2], f64), t: f64) -> [f64; 2] {
        let (damping, [s, ds]) = (2.0 * self.zeta, impulse_response(self.zeta, t));
        let oscillator = force * (ds + damping * s) + (a - damping * gamma) * s;
        [oscillator + gamma * (1.0 - ds), a * ds - (force - gamma) * s]
    }

    /// Largest penetration of an impact that leaves: where `S' = −γ S`.
    pub(super) fn deepest(&self, gamma: f64) -> f64 {
        let zeta = self.zeta;
        // x' = S' + γ S = 0 at the deepest point
        let t = time_at(zeta, zeta - gamma);
        gamma + math::exp(-zeta * t) * (1.0 - 2.0 * zeta * gamma + gamma * gamma).max(0.0).sqrt()
    }
}

/// The first time at which `S'/S + ζ` is `y`.
fn time_at(zeta: f64, y: f64) -> f64 {
    let off = 1.0 - zeta * zeta;
    if off.abs() <= CRITICAL {
        return 1.0 / y;
    }
    let wd = off.abs().sqrt();
    // S'/S + ζ = w_d cot(w_d t), and its hyperbolic and critical forms
    if off > 0.0 { math::atan2(wd, y) / wd } else { math::atanh(wd / y) / wd }
}

/// `S` and `S'`.
fn impulse_response(zeta: f64, t: f64) -> [f64; 2] {
    let off = 1.0 - zeta * zeta;
    let wd = off.abs().sqrt();
    let (s, c) = if off.abs() <= CRITICAL {
        (t, 1.0)
    } else if off > 0.0 {
        let (s, c) = math::sin_cos(wd * t);
        (s / wd, c)
    } else {
        // Together with the decay, so that neither overflows.
        let (slow, fast) = (math::exp((wd - zeta) * t), math::exp((-wd - zeta) * t));
        let (s, c) = (0.5 * (slow - fast) / wd, 0.5 * (slow + fast));
        return [s, c - zeta * s];
    };
    let fade = math::exp(-zeta * t);
    [fade * s, fade * (c - zeta * s)]
}

/// The force's Taylor series about some time, of `N` terms.
///
/// `f'' = γ − f − 2ζ f'` gives each coefficient from the two before it:
/// `(k+1)(k+2) a_(k+2) = −a_k − 2ζ (k+1) a_(k+1)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Series<const N: usize>([f64; N]);

/// `1/((k + 1)(k + 2))`.
const RECIPROCALS: [f64; 24] = {
    let mut over = [0.0; 24];
    let mut k = 0;
    while k < 24 {
        over[k] = 1.0 / ((k + 1) * (k + 2)) as f64;
        k += 1;
    }
    over
};

impl<const N: usize> Series<N> {
    #[inline]
    pub(super) fn new([force, rate]: [f64; 2], zeta: f64, gamma: f64) -> Self {
        let mut a = [0.0; N];
        (a[0], a[1]) = (force, rate);
        // The equation is that of `f − γ`, which has no constant term.
        let mut below = force - gamma;
        for k in 0..N - 2 {
            a[k + 2] = -(below + 2.0 * zeta * (k + 1) as f64 * a[k + 1]) * RECIPROCALS[k];
            below = a[k + 1];
        }
        Self(a)
    }

    /// Its value `t` later.
    /// Horner's rule.
    #[inline]
    pub(super) fn at(&self, t: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, a| sum * t + a)
    }

    /// Its value and its rate `t` later.
    #[inline]
    pub(super) fn value_and_rate(&self, t: f64) -> [f64; 2] {
        let (mut value, mut rate) = (0.0, 0.0);
        for a in self.0.iter().rev() {
            rate = rate * t + value;
            value = value * t + a;
        }
        [value, rate]
    }
}
