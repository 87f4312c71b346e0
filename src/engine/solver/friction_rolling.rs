//! Shear force and rolling moment of one contact, solved in the contact's own frame.
//!
//! Both are springs with dashpots in series with sliders. They are coupled: shear turns the rock,
//! the moment changes the slip. Of the four cases (stick or slip, each) two have closed forms and
//! two a scalar equation solved by Newton's method.
//!
//! `B = 7/2 κ h/m`, `C = κ h R/I`, `E = κ_r h/I`, with `κ = p_s h + c_s` and `κ_r = k_r h + c_r` of
//! a stage of length `h`.

use super::body::Body;
use super::contact_frame::{Along, Local, square};
use crate::ground::{Law, STICK_THRESHOLD};
use crate::rock::Rock;

/// Coefficients of a contact over a stage of given length: the same for all stages of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compliance {
    /// Shear force per slip speed (N s/m) and moment per spin (N m s) while they stick.
    pub(crate) kappa: f64,
    pub(crate) kappa_r: f64,
    /// `1/(1 + B)`.
    shear_factor: f64,
    /// `C`.
    c: f64,
    /// `1/(1 + E)`.
    rolling_factor: f64,
    /// `E R`.
    e_r: f64,
    /// `1/(1 − C E R/((1 + B)(1 + E)))`.
    coupling_factor: f64,
}

impl Compliance {
    #[inline]
    pub(crate) fn of(body: &Body, law: &Law, h: f64) -> Self {
        let (kappa, kappa_r) = (law.shear.stage_stiffness(h), law.rolling.stage_stiffness(h));
        let (turn_q, turn_m) = (kappa * h / body.inertia, kappa_r * h / body.inertia);
        Self::new(
            (kappa, kappa_r),
            Rock::SLIP_LIGHTNESS * kappa * h / body.mass,
            turn_m,
            (turn_q, body.radius),
        )
    }

    /// The limit of stiff springs, for impulses: `q̂ = 2/7 m slip − 5/7 n × M/R` and `M̂ = I w + R n × q` for a solid sphere.
    #[inline]
    pub(crate) fn rigid(radius: f64) -> Self {
        let (c, e_r) = (1.0 / Rock::ROLLING_INERTIA / radius, radius);
        Self {
            kappa: 0.0,
            kappa_r: 0.0,
            shear_factor: 1.0,
            c,
            rolling_factor: 1.0,
            e_r,
            coupling_factor: Rock::SLIP_LIGHTNESS,
        }
    }

    #[inline]
    fn new((kappa, kappa_r): (f64, f64), b: f64, e: f64, (turn_q, r): (f64, f64)) -> Self {
        let (shear_factor, rolling_factor, c, e_r) =
            (1.0 / (1.0 + b), 1.0 / (1.0 + e), turn_q * r, e * r);
        let coupling_factor = 1.0 / (1.0 - c * e_r * shear_factor * rolling_factor);
        Self { kappa, kappa_r, shear_factor, c, rolling_factor, e_r, coupling_factor }
    }
}

/// The coupled shear force `q` and rolling moment `M` of one contact over one stage: each is the
/// projection onto its cap of `q̂ = (a − C n × M)/(1 + B)` and `M̂ = (d + E R n × q)/(1 + E)`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrictionRolling<'a> {
    pub(crate) compliance: &'a Compliance,
    /// Trial shear force without the effect of `q` and `M` (N).
    pub(crate) a: Along,
    /// Trial rolling moment without their effect (N m).
    pub(crate) d: Local,
    /// Largest shear force (N) and rolling moment (N m).
    pub(crate) caps: (f64, f64),
}

/// Most Newton steps for a ratio.
const RATIO_STEPS: u32 = 30;
/// Relative change of a ratio after which the next Newton step would be rounding (–): sweeps over
/// several contacts converge only when each of them reproduces its forces.
const RATIO_CONVERGED: f64 = 1e-7;

/// `n × x` of a vector along the surface.
#[inline]
fn cross_n(x: Along) -> Along {
    [-x[1], x[0]]
}

/// Shortens a vector to at most `cap`.
#[inline]
pub(crate) fn capped<const N: usize>(x: [f64; N], cap: f64) -> [f64; N] {
    let size2 = square(x);
    if size2 > cap * cap { x.map(|x| x * (cap / size2.sqrt())) } else { x }
}

/// Newton step for the logarithm of a ratio (–), at most a factor of 2.5, from a value and the
/// wanted one, both squared. `grows/by` is the derivative of the value's logarithm with respect to
/// that of the ratio. In logarithms a power law converges at once.
#[inline]
fn log_newton_step((value2, wanted2): (f64, f64), (grows, by): (f64, f64)) -> f64 {
    ((wanted2 - value2) * by / ((wanted2 + value2) * grows).max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0)
}

/// Ratio over a cap that may be zero.
#[inline]
fn over_cap(ratio: f64, cap: f64) -> f64 {
    ratio / cap.max(f64::MIN_POSITIVE)
}

/// Which of shear force and rolling moment are at their caps.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) enum SlipState {
    /// Neither.
    #[default]
    Stick,
    /// The moment, with the `μ` of [`FrictionRolling::rolling_alone`] by its cap.
    Roll(f64),
    /// The shear force.
    Slide,
    /// Both, with the `κ` of [`FrictionRolling::both_slip`] by the moment's cap.
    Both(f64),
}

impl FrictionRolling<'_> {
    /// Force and moment. `mode` is an initial guess for the case and is set to the one found. The
    /// solution is unique, so any case that agrees with both laws is the solution.
    #[inline]
    pub(crate) fn solve(&self, mode: &mut SlipState) -> (Along, Local) {
        let cap_m = self.caps.1;
        let found = match *mode {
            SlipState::Stick => None,
            SlipState::Roll(by_cap) => self.try_rolling(Some(by_cap * cap_m)),
            SlipState::Slide => self.try_sliding(),
            SlipState::Both(by_cap) => self.try_both(Some(by_cap * cap_m)),
        };
        let (found, q, rolling_moment) = found.unwrap_or_else(|| self.solve_without_guess());
        *mode = found;
        (q, rolling_moment)
    }

    fn solve_without_guess(&self) -> (SlipState, Along, Local) {
        let (cap_q, cap_m) = self.caps;
        let (q, rolling_moment) = self.both_stick();
        let m_fits = square(rolling_moment) <= cap_m * cap_m;
        if m_fits && square(q) <= cap_q * cap_q {
            return (SlipState::Stick, q, rolling_moment);
        }
        let one = if m_fits { None } else { self.try_rolling(None) };
        one.or_else(|| self.try_sliding()).unwrap_or_else(|| {
            let (ratio, q, rolling_moment) = self.both_slip(None);
            (SlipState::Both(over_cap(ratio, cap_m)), q, rolling_moment)
        })
    }

    /// The moment at its cap, if shear then sticks and the moment slips.
    #[inline]
    fn try_rolling(&self, ratio: Option<f64>) -> Option<(SlipState, Along, Local)> {
        let (ratio, share, rolling_moment) = self.rolling_alone(ratio);
        let q = self.shear_at(rolling_moment);
        let rolls = share * STICK_THRESHOLD <= self.compliance.rolling_factor;
        let mode = SlipState::Roll(over_cap(ratio, self.caps.1));
        (rolls && square(q) <= self.caps.0 * self.caps.0).then_some((mode, q, rolling_moment))
    }

    /// Shear at its cap, if the moment then sticks and shear slips.
    #[inline]
    fn try_sliding(&self) -> Option<(SlipState, Along, Local)> {
        let (cap_q, cap_m) = self.caps;
        let q = self.sliding_alone();
        let rolling_moment = self.moment_at(q);
        let slides = square(self.shear_at(rolling_moment)) >= (STICK_THRESHOLD * cap_q).powi(2);
        (slides && square(rolling_moment) <= cap_m * cap_m).then_some((
            SlipState::Slide,
            q,
            rolling_moment,
        ))
    }

    /// Both at their caps, if neither sticks.
    #[inline]
    fn try_both(&self, ratio: Option<f64>) -> Option<(SlipState, Along, Local)> {
        let (cap_q, cap_m) = self.caps;
        let (ratio, q, rolling_moment) = self.both_slip(ratio);
        let slips = square(self.shear_at(rolling_moment)) >= cap_q * cap_q
            && ratio <= self.compliance.c * self.compliance.rolling_factor;
        slips.then_some((SlipState::Both(over_cap(ratio, cap_m)), q, rolling_moment))
    }

    /// `q̂` for a moment.
    #[inline]
    fn shear_at(&self, rolling_moment: Local) -> Along {
        let y = cross_n([rolling_moment[0], rolling_moment[1]]);
        [0, 1].map(|k| (self.a[k] - y[k] * self.compliance.c) * self.compliance.shear_factor)
    }

    /// `M̂` for a shear force.
    #[inline]
    fn moment_at(&self, q: Along) -> Local {
        self.moment_with(q, self.compliance.rolling_factor)
    }

    /// Neither at its cap: with `y = n × M`, `(1+B) q + C y = a` and `E R q + (1+E) y = n × d`.
    #[inline]
    fn both_stick(&self) -> (Along, Local) {
        let &Compliance { shear_factor, c, rolling_factor, e_r, coupling_factor, .. } =
            self.compliance;
        let nd = cross_n([self.d[0], self.d[1]]);
        let q = [0, 1]
            .map(|k| (self.a[k] - nd[k] * (c * rolling_factor)) * (shear_factor * coupling_factor));
        let y = [0, 1].map(|k| {
            (nd[k] - self.a[k] * (e_r * shear_factor)) * (rolling_factor * coupling_factor)
        });
        (q, [y[1], -y[0], self.d[2] * rolling_factor])
    }

    /// The moment at its cap while shear sticks: `M_t = μ G_t`, `M_n = λ G_n` with
    /// `λ = μ/(1 + μs)`. `|M|²` grows with `μ`, and Newton's method finds the `μ` of the cap.
    /// Returns `μ`, `λ` and the moment.
    #[inline]
    fn rolling_alone(&self, guess: Option<f64>) -> (f64, f64, Local) {
        let y = cross_n(self.a);
        let g =
            [0, 1].map(|k| self.d[k] + y[k] * (self.compliance.e_r * self.compliance.shear_factor));
        let (t2, n2, cap) = (square(g), self.d[2] * self.d[2], self.caps.1);
        let s = self.compliance.e_r * self.compliance.c * self.compliance.shear_factor;
        let guess = guess.filter(|guess| *guess > 0.0);
        let mut ratio = guess.unwrap_or_else(|| cap / (t2 + n2).sqrt().max(f64::MIN_POSITIVE));
        let mut room = 1.0 / (1.0 + ratio * s);
        for _ in 0..RATIO_STEPS {
            let spun2 = n2 * room * room;
            let size2 = t2 + spun2;
            let grows = (t2 + spun2 * room, size2);
            let share = log_newton_step((ratio * ratio * size2, cap * cap), grows);
            let change = ratio * (share + 0.5 * share * share);
            ratio += change;
            if share.abs() <= RATIO_CONVERGED {
                // so small a step is exact on the tangent
                room -= room * room * s * change;
                break;
            }
            room = 1.0 / (1.0 + ratio * s);
        }
        let spun = ratio * room;
        (ratio, spun, [g[0] * ratio, g[1] * ratio, self.d[2] * spun])
    }

    /// Shear at its cap while rolling sticks: `q ∥ a − C/(1+E) n × d`.
    #[inline]
    fn sliding_alone(&self) -> Along {
        let y = cross_n([self.d[0], self.d[1]]);
        let along =
            [0, 1].map(|k| self.a[k] - y[k] * (self.compliance.c * self.compliance.rolling_factor));
        let size = square(along).sqrt();
        if size > 0.0 { along.map(|x| x * (self.caps.0 / size)) } else { along }
    }

    /// Both at their caps: only directions are unknown. With `M = κ/C (d + E R n × q)` the part of
    /// `M` that is parallel to `n × q` does not turn `q`: `q ∥ a − κ n × d`, and
    /// `κ |n × d − E R q, d_n|` is `C` times the moment's cap. It grows with `κ`, which Newton's
    /// method finds. Returns `κ`, force and moment.
    fn both_slip(&self, guess: Option<f64>) -> (f64, Along, Local) {
        let (cap_q, cap_m) = self.caps;
        let nd = cross_n([self.d[0], self.d[1]]);
        let lever = self.compliance.e_r * cap_q;
        let (nd2, wanted) = (square(nd), self.compliance.c * cap_m);
        let most2 = nd2 + lever * lever + self.d[2] * self.d[2];
        let guess = guess.filter(|guess| *guess > 0.0);
        let mut ratio = guess.unwrap_or_else(|| wanted / most2.sqrt().max(f64::MIN_POSITIVE));
        let mut e = [0.0; 2];
        for _ in 0..RATIO_STEPS {
            let p = [0, 1].map(|k| self.a[k] - nd[k] * ratio);
            let over = 1.0 / square(p).sqrt().max(f64::MIN_POSITIVE);
            e = p.map(|x| x * over);
            let c = nd[0] * e[0] + nd[1] * e[1];
            let size2 = most2 - 2.0 * lever * c;
            let grows = (size2 + ratio * lever * (nd2 - c * c) * over, size2);
            let share = log_newton_step((ratio * ratio * size2, wanted * wanted), grows);
            let change = ratio * (share + 0.5 * share * share);
            ratio += change;
            if share.abs() <= RATIO_CONVERGED {
                // so small a step is exact on the tangent
                e = [0, 1].map(|k| e[k] - (nd[k] - e[k] * c) * (over * change));
                break;
            }
        }
        let q = e.map(|x| x * cap_q);
        (ratio, q, self.moment_with(q, ratio / self.compliance.c))
    }

    /// `M̂` for a shear force with the factor `share` in place of `1/(1 + E)`.
    #[inline]
    fn moment_with(&self, q: Along, share: f64) -> Local {
        let y = cross_n(q);
        let along = [0, 1].map(|k| (self.d[k] + y[k] * self.compliance.e_r) * share);
        [along[0], along[1], self.d[2] * share]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whichever case is tried first, the result is the fixed point of both projections, to
        /// 1e-11 of the caps.
        #[test]
        fn shear_and_rolling_solve_their_equations(
            a in prop::array::uniform2(-1.0f64..1.0), d in prop::array::uniform3(-1.0f64..1.0),
            caps in prop::array::uniform2(0.01f64..2.0), spins in prop::bool::ANY,
            b in 0.001f64..100.0, e in 0.001f64..100.0, r in 0.01f64..10.0, hint in 0.0f64..100.0,
        ) {
            // C E R = 5/7 B E, as a solid sphere has it
            let c = b / Rock::ROLLING_INERTIA / r;
            let d = [d[0] * r, d[1] * r, if spins { d[2] * r } else { 0.0 }];
            let compliance = Compliance::new((b, e), b, e, (c / r, r));
            let pair = FrictionRolling { compliance: &compliance, a, d, caps: (caps[0], caps[1] * r) };
            for mode in [SlipState::Stick, SlipState::Roll(hint), SlipState::Slide, SlipState::Both(hint)] {
                let (q, rolling_moment) = pair.solve(&mut { mode });
                let at_m = capped(pair.shear_at(rolling_moment), pair.caps.0);
                let at_q = capped(pair.moment_at(q), pair.caps.1);
                let off_q = square([q[0] - at_m[0], q[1] - at_m[1]]).sqrt();
                let off_m = square([0, 1, 2].map(|k| rolling_moment[k] - at_q[k])).sqrt();
                prop_assert!(off_q <= 1e-11 * pair.caps.0 && off_m <= 1e-11 * pair.caps.1, "{mode:?} {off_q} {off_m}");
                let (size_q, size_m) = (square(q).sqrt(), square(rolling_moment).sqrt());
                prop_assert!(size_q <= pair.caps.0 * (1.0 + 1e-12) && size_m <= pair.caps.1 * (1.0 + 1e-12));
            }
        }
    }
}
