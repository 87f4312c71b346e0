//! The contacts of a frozen impact, in units of mass, radius, speed and the stiffest contact's `1/ω`.
//!
//! In these units a contact's stiffness is `p_N |a|²/p_N,max`, its dashpot `c_N |a|/√(p_N,max m)`,
//! spin is `R ω/|v|`.

use super::FrozenContact;
use crate::contact::MOST;
use crate::ground::restitution;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::impact::normal_motion::NONE;
use crate::solver::impact::sliders::SliderElement;

/// A speed along a normal that is none, in impact speeds (–).
const REST: f64 = 1e-9;
/// What a captured contact throws back by its own spring may be so much more than its restitution says (–).
const ALLOWANCE: f64 = 1.05;

/// One of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImpactContact {
    pub(super) n: Vec3,
    pub(super) stiffness: f64,
    /// Normal damping when alone.
    pub(super) damping: f64,
    pub(super) shear: SliderElement,
    pub(super) rolling: SliderElement,
    captured: bool,
    /// Its restitution when alone (–).
    kept: f64,
}

/// All of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contacts {
    list: [ImpactContact; MOST],
    len: usize,
    /// Frequency of the softest.
    /// In units of the stiffest's: `√(k_min/k_max)`, at most 1.
    pub(super) softest: f64,
    /// `m R²/I` (–).
    pub(super) turns: f64,
    /// Fastest approach to each so far.
    pub(super) fastest: [f64; MOST],
}

/// Where in a step a contact opens or closes.
#[derive(Debug, Clone, Copy)]
pub(super) enum SwitchTime {
    /// At its start: the contacts that are pressed have been changed, the step must be tried anew.
    Now,
    /// At this share of it.
    At(f64),
}

/// Motion after the impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct AfterImpact {
    pub(super) v: Vec3,
    pub(super) w: Vec3,
    /// What contacts without rebound have taken at last.
    pub(super) plastic: [f64; MOST],
}

impl Contacts {
    pub(super) fn new(body: &Body, struck: &[FrozenContact]) -> Self {
        let normal = |struck: &FrozenContact| struck.law.normal(struck.captured);
        let stiffness =
            |struck: &FrozenContact| normal(struck).stiffness_n_m(struck.stiffness_scale);
        let stiffest = struck.iter().map(stiffness).fold(0.0, f64::max);
        let momentum = (stiffest * body.mass).sqrt();
        let contact = |struck: &FrozenContact| {
            let law = struck.law;
            let damping = normal(struck).damping_over(struck.stiffness_scale, momentum);
            ImpactContact {
                n: struck.normal,
                stiffness: stiffness(struck) / stiffest,
                damping: if damping > NONE { damping } else { 0.0 },
                shear: SliderElement::shear(body, law, stiffest),
                rolling: SliderElement::rolling(body, law, stiffest),
                captured: struck.captured,
                kept: restitution(normal(struck).damping_ratio(body.mass)),
            }
        };
        let softest = struck.iter().map(stiffness).fold(f64::INFINITY, f64::min) / stiffest;
        Self {
            list: std::array::from_fn(|k| contact(struck.get(k).unwrap_or(&struck[0]))),
            len: struck.len(),
            softest: softest.sqrt(),
            turns: body.mass * body.radius * body.radius / body.inertia,
            fastest: [0.0; MOST],
        }
    }

    #[inline]
    pub(super) fn list(&self) -> &[ImpactContact] {
        &self.list[..self.len]
    }

    /// Energy of motion.
    /// `(v² + (Rω)²/(m R²/I))/2`, the unit of energy being `m |v|²`.
    pub(super) fn energy(&self, (v, w): (Vec3, Vec3)) -> f64 {
        0.5 * (v.norm_squared() + w.norm_squared() / self.turns)
    }

    /// Whether nothing in them takes energy.
    /// Then the limit is exactly elastic, and so must be the result.
    fn conserve(&self) -> bool {
        self.list().iter().all(|contact| {
            contact.damping == 0.0 && !contact.shear.is_on() && !contact.rolling.is_on()
        })
    }

    /// Takes out of the motion what captured contacts gave back of themselves and every approach that is left, and sees to it
    /// that the energy is not more than it was: exactly the same where nothing in the contacts takes any.
    ///
    /// Captured contacts have a spring too, and would throw the rock back by their own restitution;
    /// that much is taken from them, not what other contacts threw at the rock.
    pub(super) fn come_to_an_end(
        &self,
        before: (Vec3, Vec3),
        (mut v, mut w): (Vec3, Vec3),
        nothing: f64,
    ) -> AfterImpact {
        let mut plastic = [0.0; MOST];
        // each round may press the rock against a contact it had left: at most one more for each
        // contact
        for _ in 0..=self.len {
            let own = |k: usize| ALLOWANCE * self.list[k].kept * self.fastest[k] + nothing;
            let stays = |k: usize| self.list[k].captured && self.list[k].n.dot(&v) <= own(k);
            let held: [bool; MOST] = std::array::from_fn(|k| k < self.len && stays(k));
            let next = self.nearest_allowed(&v, held);
            if next == v {
                break;
            }
            self.share_plastic(
                &v,
                0.5 * (v.norm_squared() - next.norm_squared()),
                held,
                &mut plastic,
            );
            v = next;
        }
        let (was, is) = (self.energy(before), self.energy((v, w)));
        if self.conserve() && plastic.iter().all(|taken| *taken <= nothing * nothing) {
            // Only rounding can have turned the spin.
            w = before.1;
            v *= before.0.norm() / v.norm();
        } else if is > was {
            let slower = (was / is).sqrt();
            (v, w) = (v * slower, w * slower);
        }
        AfterImpact { v, w, plastic }
    }

    /// Closest velocity to `v` that comes nearer to no contact and neither nears nor leaves those that are `held`. In three
    /// dimensions it is `v` itself, lies in one contact's plane, along the line of two, or is zero: each is tried.
    ///
    /// A projection on a convex cone; in the sense of energy the closest is the one that loses
    /// least.
    fn nearest_allowed(&self, v: &Vec3, held: [bool; MOST]) -> Vec3 {
        let is_allowed = |x: &Vec3| {
            self.list().iter().zip(held).all(|(contact, held)| {
                let up = contact.n.dot(x);
                up >= -REST && (!held || up <= REST)
            })
        };
        if is_allowed(v) {
            return *v;
        }
        // Projections go through the origin: the longest is the nearest.
        let mut best = Vec3::zeros();
        let mut offer = |x: Vec3| {
            if x.norm_squared() > best.norm_squared() && is_allowed(&x) {
                best = x;
            }
        };
        for (k, one) in self.list().iter().enumerate() {
            offer(v - one.n * one.n.dot(v));
            for other in &self.list()[k + 1..] {
                if let Some(line) = one.n.cross(&other.n).try_normalize(REST) {
                    offer(line * line.dot(v));
                }
            }
        }
        best
    }

    /// Books energy that ended in the contacts to those that stopped `v`, by the speeds they stopped.
    fn share_plastic(&self, v: &Vec3, taken: f64, held: [bool; MOST], plastic: &mut [f64; MOST]) {
        // square of the speed along each normal that had to go: the energy it stood for
        let stopped: [f64; MOST] = std::array::from_fn(|k| {
            let up = if k < self.len { self.list[k].n.dot(v) } else { 0.0 };
            if up < 0.0 || held[k] { up * up } else { 0.0 }
        });
        let sum: f64 = stopped.iter().sum();
        for (plastic, stopped) in plastic.iter_mut().zip(stopped) {
            *plastic += if sum > 0.0 { taken.max(0.0) * stopped / sum } else { 0.0 };
        }
    }
}
