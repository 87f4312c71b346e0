//! The contacts of a frozen impact, in units of mass, radius, speed and the stiffest contact's
//! `1/ω`.
//!
//! In these units a contact's stiffness is `p_N |a|²/p_N,max`, its dashpot `c_N |a|/√(p_N,max m)`,
//! spin is `R ω/|v|`.

use super::{ContactEnds, FrozenBody, FrozenContact};
use crate::ground::restitution;
use crate::rock::Vec3;
use crate::solver::body::{Body, Twist};
use crate::solver::impact::normal_motion::UNDAMPED;
use crate::solver::impact::sliders::SliderElement;
use crate::solver::law::capture_m_s;

/// A normal velocity up to this is zero, in impact speeds (–).
pub(super) const REST: f64 = 1e-9;
/// A captured contact may rebound by its own spring at this multiple of its restitution (–).
const ALLOWANCE: f64 = 1.05;

/// A contact of a frozen impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImpactContact {
    pub(super) n: Vec3,
    pub(super) ends: ContactEnds,
    pub(super) stiffness: f64,
    /// Normal damping when alone.
    pub(super) damping: f64,
    pub(super) shear: SliderElement,
    pub(super) rolling: SliderElement,
    /// Gap at the start.
    pub(super) gap: f64,
    captured: bool,
    /// Approach speed below which it does not rebound, whether it is captured or not.
    capture_speed: f64,
    /// Its restitution when alone (–).
    restitution: f64,
}

/// A body of a frozen impact, in units of the mass `m₀`.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImpactBody {
    /// `m₀/m` (–).
    pub(super) lightness: f64,
    /// `m₀ R²/I` (–).
    pub(super) turns: f64,
}

/// Up to `K` contacts of `B` bodies.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImpactContacts<const B: usize, const K: usize> {
    list: [ImpactContact; K],
    len: usize,
    pub(super) bodies: [ImpactBody; B],
    /// Unit of mass `m₀` (kg): the least effective mass of a contact.
    pub(super) mass_kg: f64,
    /// Frequency of the softest contact, in units of the stiffest's: `√(k_min/k_max)`, at most 1.
    pub(super) softest: f64,
    /// Fastest approach at each contact so far.
    pub(super) fastest: [f64; K],
}

/// Time in a step at which a contact opens or closes.
#[derive(Debug, Clone, Copy)]
pub(super) enum SwitchTime {
    /// At its start: the set of closed contacts has been changed, and the step must be tried anew.
    Now,
    /// At this share of it.
    At(f64),
}

/// Motion after the impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct AfterImpact<const B: usize, const K: usize> {
    /// Velocity, and spin times radius, of every body.
    pub(super) motions: [Twist; B],
    /// Energy absorbed at the end by contacts without rebound.
    pub(super) plastic: [f64; K],
}

impl<const B: usize, const K: usize> ImpactContacts<B, K> {
    pub(super) fn new(bodies: &[FrozenBody], struck: &[FrozenContact], speed: f64) -> Self {
        let normal = |struck: &FrozenContact| struck.law.normal(struck.captured);
        let stiffness =
            |struck: &FrozenContact| normal(struck).stiffness_n_m(struck.stiffness_scale);
        let moved = |struck: &FrozenContact| struck.ends.effective_mass_kg(bodies);
        let stiffest = struck.iter().map(stiffness).fold(0.0, f64::max);
        let mass_kg = struck.iter().map(moved).fold(f64::INFINITY, f64::min);
        let momentum = (stiffest * mass_kg).sqrt();
        let way_m = speed * (mass_kg / stiffest).sqrt();
        let contact = |struck: &FrozenContact| {
            let law = struck.law;
            let damping = normal(struck).damping_over(struck.stiffness_scale, momentum);
            let unit = Body { mass: mass_kg, ..bodies[struck.ends.first].body };
            // rocks among themselves have no rolling friction
            let rolls = struck.ends.second.is_none();
            let rolling = SliderElement::rolling(&unit, law, stiffest);
            ImpactContact {
                n: struck.normal,
                ends: struck.ends,
                stiffness: stiffness(struck) / stiffest,
                damping: if damping > UNDAMPED { damping } else { 0.0 },
                shear: SliderElement::shear(&unit, law, stiffest),
                rolling: if rolls { rolling } else { SliderElement::NONE },
                gap: if struck.gap_m > 0.0 { struck.gap_m / way_m } else { 0.0 },
                captured: struck.captured,
                capture_speed: 0.0,
                restitution: restitution(normal(struck).damping_ratio(moved(struck))),
            }
        };
        let slowness = |struck: &FrozenContact| stiffness(struck) * (mass_kg / moved(struck));
        let softest = struck.iter().map(slowness).fold(f64::INFINITY, f64::min) / stiffest;
        let body = |FrozenBody { body, .. }: &FrozenBody| ImpactBody {
            lightness: mass_kg / body.mass,
            turns: mass_kg * body.radius * body.radius / body.inertia,
        };
        Self {
            list: std::array::from_fn(|k| contact(struck.get(k).unwrap_or(&struck[0]))),
            len: struck.len(),
            bodies: std::array::from_fn(|k| body(bodies.get(k).unwrap_or(&bodies[0]))),
            mass_kg,
            softest: softest.sqrt(),
            fastest: [0.0; K],
        }
    }

    #[inline]
    pub(super) fn list(&self) -> &[ImpactContact] {
        &self.list[..self.len]
    }

    /// Frequency of the heaviest body on the softest contact: that of a boulder on a stone is far
    /// below the stone's.
    pub(super) fn lowest_frequency(&self) -> f64 {
        self.softest * self.bodies.iter().fold(1.0, |least, one| one.lightness.min(least)).sqrt()
    }

    /// Energy of motion of a body.
    /// `(v² m/m₀ + (Rω)²/(m₀ R²/I))/2`, the unit of energy being `m₀ |v|²`.
    pub(super) fn energy(&self, body: usize, (v, w): Twist) -> f64 {
        let ImpactBody { lightness, turns } = self.bodies[body];
        0.5 * (v.norm_squared() / lightness + w.norm_squared() / turns)
    }

    /// Normal velocity at which the two ends of contact `k` separate; of displacements, their
    /// separation.
    #[inline]
    pub(super) fn separation(&self, k: usize, v: impl Fn(usize) -> Vec3) -> f64 {
        let ContactEnds { first, second, .. } = self.list[k].ends;
        let apart = if B > 1
            && let Some(second) = second
        {
            v(first) - v(second)
        } else {
            v(first)
        };
        self.list[k].n.dot(&apart)
    }

    /// Whether a captured contact has not been opened by others: its separation speed at the end is
    /// that of its own spring.
    pub(super) fn is_held(&self, k: usize, separation: f64, negligible: f64) -> bool {
        let own = ALLOWANCE * self.list[k].restitution * self.fastest[k] + negligible;
        let captured = self.list[k].captured || self.fastest[k] < self.list[k].capture_speed;
        captured && separation <= own
    }

    /// From now on contacts that are closed more slowly than their capture speed do not rebound;
    /// `speed` (m/s) is the unit.
    pub(super) fn capture(&mut self, struck: &[FrozenContact], speed: f64) {
        for (contact, struck) in self.list.iter_mut().zip(struck) {
            contact.capture_speed = capture_m_s(struck.law) / speed;
        }
    }

    /// Whether no contact dissipates energy. Then the limit is exactly elastic, and so must be the
    /// result.
    pub(super) fn is_conservative(&self) -> bool {
        self.list().iter().all(|contact| {
            contact.damping == 0.0 && !contact.shear.is_on() && !contact.rolling.is_on()
        })
    }

    /// Distributes energy that was absorbed at the end over the contacts that stopped something, by
    /// their normal velocities.
    pub(super) fn share_plastic(taken: f64, stopped: [f64; K], plastic: &mut [f64; K]) {
        // squares of velocities: the energies that they stood for
        let sum: f64 = stopped.iter().map(|speed| speed * speed).sum();
        for (plastic, stopped) in plastic.iter_mut().zip(stopped) {
            let own = stopped * stopped;
            *plastic += if sum > 0.0 { taken.max(0.0) * own / sum } else { 0.0 };
        }
    }
}

impl<const K: usize> ImpactContacts<1, K> {
    /// Removes from the motion the rebound of captured contacts by their own springs and every
    /// remaining approach speed, and limits the energy to that before: exactly the same if no
    /// contact dissipates.
    ///
    /// Captured contacts have a spring too and would make the rock rebound by their own
    /// restitution. That part is removed, but not what other contacts have thrown at the rock.
    pub(super) fn finish(
        &self,
        before: Twist,
        (mut v, mut w): Twist,
        negligible: f64,
    ) -> AfterImpact<1, K> {
        let mut plastic = [0.0; K];
        // each pass may press the rock against a contact that it had left: at most one more pass
        // for each contact
        for _ in 0..=self.len {
            let up = |k: usize| self.list[k].n.dot(&v);
            let held: [bool; K] =
                std::array::from_fn(|k| k < self.len && self.is_held(k, up(k), negligible));
            let next = self.nearest_allowed(&v, held);
            if next == v {
                break;
            }
            let stops = |k: usize| k < self.len && (up(k) < 0.0 || held[k]);
            let stopped = std::array::from_fn(|k| if stops(k) { up(k) } else { 0.0 });
            let taken = 0.5 * (v.norm_squared() - next.norm_squared());
            Self::share_plastic(taken, stopped, &mut plastic);
            v = next;
        }
        let (was, is) = (self.energy(0, before), self.energy(0, (v, w)));
        if self.is_conservative() && plastic.iter().all(|taken| *taken <= negligible * negligible) {
            // Only rounding can have changed the spin.
            w = before.1;
            v *= before.0.norm() / v.norm();
        } else if is > was {
            let slower = (was / is).sqrt();
            (v, w) = (v * slower, w * slower);
        }
        AfterImpact { motions: [(v, w)], plastic }
    }

    /// Closest velocity to `v` that closes no contact and neither closes nor opens the `held` ones.
    /// In three dimensions it is `v` itself, lies in one contact's plane, along the line of two, or
    /// is zero: each is tried.
    ///
    /// A projection on a convex cone; in the sense of energy the closest is the one that loses
    /// least.
    fn nearest_allowed(&self, v: &Vec3, held: [bool; K]) -> Vec3 {
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
}
