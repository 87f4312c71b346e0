//! Shear and rolling of one contact under a known force: slider in series with (spring ∥ dashpot),
//! explicitly.
//!
//! In units of mass, radius, approach speed and `1/ω`. With `s = k ξ/c`, the velocity at which the
//! dashpot has the force of the spring, the law of an element reads `p = proj_{cap}(u + s)`,
//! `s' = (k/c)(p − s)`, force `c p`: the slider slips by `u + s − p`, the dashpot moves by `p − s`.
//!
//! `s` is used instead of `ξ` because it is a velocity: slip and spring add up before the
//! projection. Losses: the slider takes `c p (u + s − p)`, the dashpot `c (p − s)²`; the rest goes
//! into the spring.

use super::dormand_prince::{Rates, slips};
use super::integrate::ForcedFlow;
use crate::ground::Law;
use crate::solver::body::Body;

/// A slider in series with spring and dashpot.
#[derive(Debug, Clone, Copy)]
pub(super) struct SliderElement {
    /// Damping `c` (–); 0 = left out.
    pub(super) damping: f64,
    /// `k/c` (–).
    pub(super) rate: f64,
    /// The slider's limit over the normal force, and over `c` (–).
    pub(super) cap: f64,
}

/// Without a dashpot the element has no such form and is left out.
impl SliderElement {
    /// None.
    pub(super) const NONE: Self = Self { damping: 0.0, rate: 0.0, cap: 0.0 };

    fn new([stiffness, damping, limit]: [f64; 3]) -> Self {
        if damping > 0.0 && limit > 0.0 {
            Self { damping, rate: stiffness / damping, cap: limit / damping }
        } else {
            Self::NONE
        }
    }

    /// The shear element of a contact of a normal stiffness (N/m).
    pub(super) fn shear(body: &Body, law: &Law, stiffness: f64) -> Self {
        let momentum = (stiffness * body.mass).sqrt();
        Self::new(law.shear.in_units([stiffness, momentum, 1.0]))
    }

    /// Its rolling element; with the spin times the radius for a speed.
    pub(super) fn rolling(body: &Body, law: &Law, stiffness: f64) -> Self {
        let momentum = (stiffness * body.mass).sqrt();
        let r2 = body.radius * body.radius;
        Self::new(law.rolling.in_units([r2 * stiffness, r2 * momentum, body.radius]))
    }

    pub(super) fn is_on(&self) -> bool {
        self.damping > 0.0
    }

    /// The stretch `ξ` of a spring as a velocity, `s = k ξ/c`.
    pub(super) fn stretched<const N: usize>(&self, stretch: [f64; N]) -> [f64; N] {
        stretch.map(|x| x * self.rate)
    }

    /// The stretch of a spring from `s`.
    pub(super) fn stretch<const N: usize>(&self, s: [f64; N]) -> [f64; N] {
        if self.is_on() { s.map(|s| s / self.rate) } else { [0.0; N] }
    }

    /// Energy `k ξ²/2` of a spring from `s`.
    pub(super) fn stored(&self, s: &[f64]) -> f64 {
        let square: f64 = s.iter().map(|s| s * s).sum();
        if square > 0.0 { 0.5 * self.damping * square / self.rate } else { 0.0 }
    }

    /// Projection of a trial value under the force `f`: the factor of `p = trial × share`, the
    /// excess over the cap, and the cap.
    #[inline]
    pub(super) fn share(&self, trial2: f64, f: f64) -> (f64, f64, f64) {
        let cap = self.cap * f;
        let (share, by) = Self::scale(slips([trial2, cap]), [trial2, cap]);
        (share, by, cap)
    }

    /// Projection of a trial value for an element that slips under a cap, or sticks: the factor of
    /// `p = trial × share`, and the excess.
    #[inline]
    fn scale(slips: bool, [trial2, cap]: [f64; 2]) -> (f64, f64) {
        if !slips {
            return (1.0, 0.0);
        }
        let trial = trial2.sqrt().max(f64::MIN_POSITIVE);
        (cap / trial, trial - cap)
    }
}

/// Shear alone: slip and spring.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShearFlow {
    pub(super) element: SliderElement,
    /// Mass over that of the contact point along the surface, `1 + m R²/I` (–).
    pub(super) lightness: f64,
    /// Gravity along the surface.
    pub(super) gravity: [f64; 2],
}

/// State: slip, spring `s`; quadratures: loss by slip, slip.
impl ForcedFlow<4, 3, 1> for ShearFlow {
    #[inline]
    fn trial_values(&self, f: f64, y: &[f64; 4]) -> [[f64; 2]; 1] {
        let trial = [y[0] + y[2], y[1] + y[3]];
        [[trial[0] * trial[0] + trial[1] * trial[1], self.element.cap * f]]
    }

    #[inline]
    fn rates(&self, f: f64, y: &[f64; 4], [slips]: &[bool; 1], to: &mut Rates<4, 3, 1>) {
        let SliderElement { damping, rate, .. } = self.element;
        let switching = self.trial_values(f, y);
        let (share, by) = SliderElement::scale(*slips, switching[0]);
        let p = [y[0] + y[2], y[1] + y[3]].map(|x| x * share);
        // an impulse c p changes the slip by (1 + m R²/I) = 7/2 of it for a sphere: velocity and
        // spin both give way
        let normal_force = self.lightness * damping;
        let g = self.gravity;
        *to = Rates {
            y: [
                g[0] - normal_force * p[0],
                g[1] - normal_force * p[1],
                rate * (p[0] - y[2]),
                rate * (p[1] - y[3]),
            ],
            q: [damping * switching[0][1] * by, y[0], y[1]],
            switching,
        };
    }

    /// Springs over their rate, so that an error of `s` counts as the stretch it stands for.
    #[inline]
    fn size2(&self, off: &[f64; 4]) -> f64 {
        let over = 1.0 / self.element.rate;
        let slip2 = off[0] * off[0] + off[1] * off[1];
        slip2 + (off[2] * off[2] + off[3] * off[3]) * (over * over)
    }
}

/// Shear alone along one line, without gravity.
#[derive(Debug, Clone, Copy)]
pub(super) struct LineShearFlow {
    pub(super) element: SliderElement,
    /// Mass over that of the contact point along the surface, `1 + m R²/I` (–).
    pub(super) lightness: f64,
}

/// State: slip, spring `s`; quadratures: loss by slip, slip.
impl ForcedFlow<2, 2, 1> for LineShearFlow {
    #[inline]
    fn trial_values(&self, f: f64, y: &[f64; 2]) -> [[f64; 2]; 1] {
        let trial = y[0] + y[1];
        [[trial * trial, self.element.cap * f]]
    }

    #[inline]
    fn rates(&self, f: f64, y: &[f64; 2], [slips]: &[bool; 1], to: &mut Rates<2, 2, 1>) {
        let SliderElement { damping, rate, .. } = self.element;
        let switching = self.trial_values(f, y);
        let (share, by) = SliderElement::scale(*slips, switching[0]);
        let p = (y[0] + y[1]) * share;
        *to = Rates {
            y: [-self.lightness * damping * p, rate * (p - y[1])],
            q: [damping * switching[0][1] * by, y[0]],
            switching,
        };
    }

    /// As for two directions.
    #[inline]
    fn size2(&self, off: &[f64; 2]) -> f64 {
        let stretch = off[1] / self.element.rate;
        off[0] * off[0] + stretch * stretch
    }
}

/// Shear and rolling.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShearRollingFlow {
    pub(super) shear: SliderElement,
    pub(super) rolling: SliderElement,
    /// `m R²/I` (–).
    pub(super) turns: f64,
    /// Gravity along the surface.
    pub(super) gravity: [f64; 2],
}

impl ShearRollingFlow {
    /// `u = (v_s − R ω_t, v_t + R ω_s)`, with `y[2..5] = R ω`.
    #[inline]
    fn slip(y: &[f64; 10]) -> [f64; 2] {
        [y[0] - y[3], y[1] + y[2]]
    }

    /// Trial value of the shear element.
    #[inline]
    fn slip_trial(y: &[f64; 10]) -> [f64; 2] {
        let slip = Self::slip(y);
        [slip[0] + y[5], slip[1] + y[6]]
    }

    /// Trial value of the rolling element, which acts on the whole spin, including that about the
    /// normal.
    #[inline]
    fn spin_trial(y: &[f64; 10]) -> [f64; 3] {
        [y[2] + y[7], y[3] + y[8], y[4] + y[9]]
    }
}

/// State: velocity, spin, springs; quadratures: loss by slip, displacement, work of rolling and of
/// shear.
impl ForcedFlow<10, 5, 2> for ShearRollingFlow {
    #[inline]
    fn trial_values(&self, f: f64, y: &[f64; 10]) -> [[f64; 2]; 2] {
        let (trial, spring_spin) = (Self::slip_trial(y), Self::spin_trial(y));
        [
            [trial[0] * trial[0] + trial[1] * trial[1], self.shear.cap * f],
            [
                spring_spin[0] * spring_spin[0]
                    + spring_spin[1] * spring_spin[1]
                    + spring_spin[2] * spring_spin[2],
                self.rolling.cap * f,
            ],
        ]
    }

    #[expect(clippy::inline_always, reason = "as in all of its steps")]
    #[inline(always)]
    fn rates(
        &self,
        f: f64,
        y: &[f64; 10],
        [slips, turns_over]: &[bool; 2],
        to: &mut Rates<10, 5, 2>,
    ) {
        let (shear, rolling) = (self.shear, self.rolling);
        let slip = Self::slip(y);
        let switching = self.trial_values(f, y);
        let (share, by) = SliderElement::scale(*slips, switching[0]);
        let p = Self::slip_trial(y).map(|x| x * share);
        let (share, _) = SliderElement::scale(*turns_over, switching[1]);
        let m = Self::spin_trial(y).map(|x| x * share);
        let (c, turn, g) = (shear.damping, self.turns * shear.damping, self.gravity);
        let stop = self.turns * rolling.damping;
        *to = Rates {
            y: [
                g[0] - c * p[0],
                g[1] - c * p[1],
                -turn * p[1] - stop * m[0],
                turn * p[0] - stop * m[1],
                -stop * m[2],
                shear.rate * (p[0] - y[5]),
                shear.rate * (p[1] - y[6]),
                rolling.rate * (m[0] - y[7]),
                rolling.rate * (m[1] - y[8]),
                rolling.rate * (m[2] - y[9]),
            ],
            q: [
                c * switching[0][1] * by,
                y[0],
                y[1],
                rolling.damping * (m[0] * y[2] + m[1] * y[3] + m[2] * y[4]),
                c * (p[0] * slip[0] + p[1] * slip[1]),
            ],
            switching,
        };
    }

    #[inline]
    fn size2(&self, off: &[f64; 10]) -> f64 {
        let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        let over = |element: &SliderElement| {
            if element.is_on() { 1.0 / (element.rate * element.rate) } else { 0.0 }
        };
        square(&off[..5])
            + square(&off[5..7]) * over(&self.shear)
            + square(&off[7..]) * over(&self.rolling)
    }
}
