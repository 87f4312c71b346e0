//! The contacts of a frozen impact, in units of mass, radius, speed and the stiffest contact's `1/ω`.

use super::Struck;
use crate::contact::MOST;
use crate::ground::restitution;
use crate::rock::Vec3;
use crate::step::impact::normal::NONE;
use crate::step::impact::rub::Element;
use crate::step::law::Body;

/// Sweeps of projections at the end, at most.
const SWEEPS: u32 = 5000;
/// What a captured contact throws back by its own spring may be so much more than its restitution says (–).
const ALLOWANCE: f64 = 1.05;

/// One of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    pub(super) n: Vec3,
    pub(super) stiffness: f64,
    /// Normal damping when alone.
    pub(super) damping: f64,
    pub(super) shear: Element,
    pub(super) rolling: Element,
    captured: bool,
    /// Its restitution when alone (–).
    kept: f64,
}

/// All of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contacts {
    list: [Contact; MOST],
    len: usize,
    /// Frequency of the softest.
    pub(super) softest: f64,
    /// `m R²/I` (–).
    pub(super) turns: f64,
    /// Fastest approach to each so far.
    pub(super) fastest: [f64; MOST],
}

/// Where in a step a contact opens or closes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Place {
    /// At its start: the contacts that are pressed have been changed, the step must be tried anew.
    Now,
    /// At this share of it.
    At(f64),
}

/// Motion after the impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ended {
    pub(super) v: Vec3,
    pub(super) w: Vec3,
    /// What contacts without rebound have taken at last.
    pub(super) plastic: [f64; MOST],
}

impl Contacts {
    pub(super) fn new(body: &Body, struck: &[Struck]) -> Self {
        let stiffness = |struck: &Struck| struck.law.p_n * struck.stiffness_scale;
        let stiffest = struck.iter().map(stiffness).fold(0.0, f64::max);
        let momentum = (stiffest * body.mass).sqrt();
        let contact = |struck: &Struck| {
            let law = struck.law;
            let c_n = if struck.captured { law.c_n_captured } else { law.c_n };
            let damping = c_n * struck.stiffness_scale.sqrt() / momentum;
            Contact {
                n: struck.normal,
                stiffness: stiffness(struck) / stiffest,
                damping: if damping > NONE { damping } else { 0.0 },
                shear: Element::shear(body, law, stiffest),
                rolling: Element::rolling(body, law, stiffest),
                captured: struck.captured,
                kept: restitution(0.5 * c_n / (law.p_n * body.mass).sqrt()),
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
    pub(super) fn list(&self) -> &[Contact] {
        &self.list[..self.len]
    }

    /// Energy of motion.
    pub(super) fn energy(&self, (v, w): (Vec3, Vec3)) -> f64 {
        0.5 * (v.norm_squared() + w.norm_squared() / self.turns)
    }

    /// Whether nothing in them takes energy.
    fn conserve(&self) -> bool {
        self.list().iter().all(|contact| {
            contact.damping == 0.0 && !contact.shear.is_on() && !contact.rolling.is_on()
        })
    }

    /// Takes out of the motion what captured contacts gave back of themselves and every approach that is left, and sees to it
    /// that the energy is not more than it was: exactly the same where nothing in the contacts takes any.
    pub(super) fn come_to_an_end(
        &self,
        before: (Vec3, Vec3),
        (mut v, mut w): (Vec3, Vec3),
        nothing: f64,
    ) -> Ended {
        let mut plastic = [0.0; MOST];
        for _ in 0..SWEEPS {
            let mut largest = 0.0f64;
            for (k, contact) in self.list().iter().enumerate() {
                let up = contact.n.dot(&v);
                let own = ALLOWANCE * contact.kept * self.fastest[k] + nothing;
                if up < 0.0 || (contact.captured && up <= own) {
                    plastic[k] += 0.5 * up * up;
                    v -= contact.n * up;
                    largest = largest.max(up.abs());
                }
            }
            if largest <= 1e-10 {
                break;
            }
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
        Ended { v, w, plastic }
    }
}
