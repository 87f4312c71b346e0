//! Impacts of several bodies that touch each other and the mesh: springs in series, with all
//! contacts coupled.
//!
//! The wave through a column, a row or a cradle of rocks takes the time of their springs. In the
//! limit of stiff springs it takes no time, but its course is the same. It is integrated in its own
//! time with the same rates as the impact of one rock on several contacts. Impulses act on both
//! bodies of a contact at one point, so momentum and angular momentum are conserved to rounding.

use super::contacts::{AfterImpact, ImpactContacts, REST};
use super::{
    ContactEnds, FrozenBody, FrozenContact, ImpactOutcome, ImpactRun, LONGEST_STEP, MOST_STEPS,
};
use crate::rock::Vec3;
use crate::solver::body::{STILL, Twist};
use crate::solver::loss::Loss;
use std::f64::consts::PI;

/// Most bodies and contacts of one impact.
pub(crate) const BODIES: usize = 16;
pub(crate) const CONTACTS: usize = 48;
/// Half periods of the heaviest body on the softest contact for which there must be steps. A stiff
/// spring, or a light stone between heavy ones, oscillates thousands of times meanwhile, and an
/// impact that is not integrated to its end would stop bodies that still move.
const HALF_PERIODS: f64 = 4.0;
/// Sweeps over the contacts in which captured contacts are brought to rest, at most.
const ROUNDS: usize = 1000;

/// Largest ratio of masses times ratio of stiffnesses (–) up to which an impact of several bodies
/// is integrated, if no contact has more than this damping ratio (–).
pub(crate) fn largest_followed_ratio(damping_ratio: f64) -> f64 {
    lowest_followed_frequency(LONGEST_STEP / (2.0 * damping_ratio).max(1.0)).powi(-2)
}

/// Lowest frequency that the number of steps covers (rad of the stiffest contact), with steps of at
/// most `longest`.
fn lowest_followed_frequency(longest: f64) -> f64 {
    HALF_PERIODS * PI / (longest * f64::from(MOST_STEPS))
}

/// Motions after a frozen impact of several bodies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrozenCollision {
    /// Velocity (m/s) and spin (rad/s) of every body.
    pub(crate) motions: [Twist; BODIES],
    /// Energy lost (J) by contact and kind, each ≥ 0: together exactly the energy before less that
    /// after.
    pub(crate) loss: [Loss; CONTACTS],
    /// Fastest approach at each contact (m/s), 0 where it was not closed.
    pub(crate) fastest_m_s: [f64; CONTACTS],
}

impl FrozenCollision {
    /// Bodies at rest, and contacts without loss.
    pub(crate) const STILL: Self = Self {
        motions: [STILL; BODIES],
        loss: [Loss::on_slope([0.0; 3]); CONTACTS],
        fastest_m_s: [0.0; CONTACTS],
    };
}

/// Integrates the impact of up to [`BODIES`] bodies with up to [`CONTACTS`] contacts at once, each
/// of them at penetration zero or at its gap. `None` if no contact closes, if there are too many of
/// them, or if their frequencies differ too much to be integrated to the end. `tolerance` is
/// relative to the largest relative velocity at a contact (–).
///
/// A contact that is closed more slowly than its capture speed does not rebound, whatever it
/// returned in between.
pub(crate) fn frozen_collision(
    bodies: &[FrozenBody],
    contacts: &[FrozenContact],
    tolerance: f64,
) -> Option<FrozenCollision> {
    let case = (bodies, contacts);
    match (bodies.len(), contacts.len()) {
        (..=3, ..=6) => follow_bodies::<3, 6, 63, 24, 18>(case, tolerance),
        (..=8, ..=20) => follow_bodies::<8, 20, 192, 80, 60>(case, tolerance),
        (..=BODIES, ..=CONTACTS) => {
            follow_bodies::<BODIES, CONTACTS, 432, 192, 144>(case, tolerance)
        }
        _ => None,
    }
}

fn follow_bodies<const B: usize, const K: usize, const N: usize, const Q: usize, const P: usize>(
    (bodies, contacts): (&[FrozenBody], &[FrozenContact]),
    tolerance: f64,
) -> Option<FrozenCollision> {
    let speed = fastest_m_s(bodies, contacts)?;
    let mut run = ImpactRun::<B, K, N, Q, P>::new((bodies, contacts), speed, tolerance);
    if run.flow.contacts.lowest_frequency() < lowest_followed_frequency(run.flow.longest) {
        return None;
    }
    let start = run.motions();
    let unit_j = run.flow.contacts.mass_kg * speed * speed;
    run.flow.contacts.capture(contacts, speed);
    let settled = run.follow(tolerance);
    let negligible = run.flow.negligible();
    let contacts = &run.flow.contacts;
    let is_over = |k: usize| {
        run.flow.is_apart(k, &run.y)
            || (settled == ImpactOutcome::Free && run.flow.approaches_again(k, &run.y))
    };
    let meets: [bool; K] = std::array::from_fn(|k| k < contacts.list().len() && !is_over(k));
    let AfterImpact { motions: together, plastic } =
        contacts.project_velocities((run.motions(), meets), negligible);
    let (motions, lost) = contacts.balanced((&start, &together), plastic.iter().sum());
    let loss_j = run.loss_j(lost.max(0.0) * unit_j, plastic);
    let mut end = FrozenCollision::STILL;
    for (k, body) in bodies.iter().enumerate() {
        end.motions[k] = body.out_of_units(motions[k], speed);
    }
    end.loss[..K].copy_from_slice(&loss_j);
    for (m_s, fastest) in end.fastest_m_s.iter_mut().zip(run.flow.contacts.fastest) {
        *m_s = fastest * speed;
    }
    Some(end)
}

/// Largest relative velocity of the two ends of a contact (m/s); `None` if no contact closes.
fn fastest_m_s(bodies: &[FrozenBody], contacts: &[FrozenContact]) -> Option<f64> {
    let velocity = |k: usize| bodies[k].motion.0;
    let apart = contacts.iter().map(|FrozenContact { normal, ends, .. }| {
        let v = velocity(ends.first) - ends.second.map_or_else(Vec3::zeros, velocity);
        (v.norm(), normal.dot(&v) < 0.0)
    });
    let (fastest, closes) = apart
        .fold((0.0f64, false), |(most, any), (speed, closes)| (most.max(speed), any || closes));
    closes.then_some(fastest)
}

impl<const B: usize, const K: usize> ImpactContacts<B, K> {
    /// Removes the rebound of captured contacts and every remaining approach speed: the closest
    /// motions in which no contact closes and the held ones do not separate either. Closest in the
    /// norm of the kinetic energy, which is the choice of least loss.
    ///
    /// Projected Gauss–Seidel over the normal impulses of the contacts in `meets`.
    fn project_velocities(
        &self,
        (mut motions, meets): ([Twist; B], [bool; K]),
        negligible: f64,
    ) -> AfterImpact<B, K> {
        let separation = |motions: &[Twist; B], k: usize| self.separation(k, |k| motions[k].0);
        let held: [bool; K] = std::array::from_fn(|k| {
            meets[k] && self.is_held(k, separation(&motions, k), negligible)
        });
        let speeds: [f64; K] = std::array::from_fn(|k| {
            let speed = if meets[k] { separation(&motions, k) } else { 0.0 };
            if speed < 0.0 || held[k] { speed } else { 0.0 }
        });
        let before = self.energies(&motions);
        self.sweep(&mut motions, (meets, held));
        let mut plastic = [0.0; K];
        Self::share_plastic(before - self.energies(&motions), speeds, &mut plastic);
        AfterImpact { motions, plastic }
    }

    /// Normal impulses until no contact closes and the held ones do not separate either.
    fn sweep(&self, motions: &mut [Twist; B], (meets, held): ([bool; K], [bool; K])) {
        let mut impulses = [0.0; K];
        for _ in 0..ROUNDS {
            let mut worst = 0.0f64;
            for (k, contact) in self.list().iter().enumerate().filter(|(k, _)| meets[*k]) {
                let ContactEnds { first, second, .. } = contact.ends;
                let lightness = |end: usize| self.bodies[end].lightness;
                let (one, other) = (lightness(first), second.map_or(0.0, lightness));
                let wanted = impulses[k] - self.separation(k, |k| motions[k].0) / (one + other);
                let next = if held[k] { wanted } else { wanted.max(0.0) };
                let change = next - impulses[k];
                impulses[k] = next;
                motions[first].0 += contact.n * (change * one);
                if let Some(second) = second {
                    motions[second].0 -= contact.n * (change * other);
                }
                worst = worst.max((change * (one + other)).abs());
            }
            if worst <= REST {
                break;
            }
        }
    }

    fn energies(&self, motions: &[Twist; B]) -> f64 {
        motions.iter().enumerate().map(|(k, motion)| self.energy(k, *motion)).sum()
    }

    /// Motions after the impact with no more energy than before, with exactly as much if no contact
    /// dissipates, and the loss. All impulses are scaled by one factor, so that momentum is
    /// conserved.
    ///
    /// `E(s) = E₀ + s a + s² b` of the motions `x₀ + s (x₁ − x₀)`.
    fn balanced(
        &self,
        (before, after): (&[Twist; B], &[Twist; B]),
        plastic: f64,
    ) -> ([Twist; B], f64) {
        let change: [Twist; B] =
            std::array::from_fn(|k| (after[k].0 - before[k].0, after[k].1 - before[k].1));
        let (was, is, b) = (self.energies(before), self.energies(after), self.energies(&change));
        let is_exact = self.is_conservative() && plastic <= REST;
        if !(is_exact || is > was) || b <= 0.0 {
            return (*after, was - is);
        }
        let s = (b - (is - was)) / b;
        let motions: [Twist; B] =
            std::array::from_fn(|k| (before[k].0 + change[k].0 * s, before[k].1 + change[k].1 * s));
        (motions, was - self.energies(&motions))
    }
}
