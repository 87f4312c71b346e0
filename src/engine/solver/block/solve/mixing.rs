//! Sweeps that learn from those before them (Anderson 1965; Walker and Ni 2011).
//!
//! A sweep turns impulses `x` into `g(x)`; they have settled where `f = g − x` is 0. Sweeps alone come nearer by the same factor each
//! time, which is near 1 where a face presses on all its corners or friction outweighs the lever. From the last few differences of `f` the
//! combination is taken that would have left least of it, and the next sweep begins with the same combination of `g`. As
//! long as every contact keeps sticking or sliding, few unknowns of the body are left, and few sweeps. What a sweep makes of an impulse
//! is not changed, nor when it has settled. The second half of
//! the sweeps goes on alone, as those that change between two laws without end would otherwise never come nearer.

use super::super::rolling::RollingImpulse;
use super::{BlockContact, Mass};
use crate::rock::Vec3;

/// Differences kept (–): a face that slides has three motions to settle, and rounding.
const DEPTH: usize = 4;
/// Sweeps that go before: most settle at once.
pub(super) const PLAIN_SWEEPS: u32 = 2;
/// A difference that adds less than this to those before it tells nothing new (–, relative to its size).
const LINEARLY_DEPENDENT: f64 = 1e-7;
/// What is left may grow this much (–) before the differences are forgotten: contacts have changed from sticking to sliding …
const RESTART_GROWTH: f64 = 2.0;
/// Impulses that are larger than the largest of the sweeps that went before by more than this (–) are no combination of such: where a
/// contact that would pull is left out, those beside it grow from sweep to sweep, and velocities would lose their digits …
const MOST_IMPULSE_GROWTH: f64 = 100.0;
/// … and so often before sweeps go on alone.
const MOST_RESTARTS: u32 = 6;

/// The impulses of all contacts, and last that of rolling friction over the reach of the contacts (N s).
type ContactImpulses<const M: usize> = [Vec3; M];

/// What the last sweeps have done with up to `M` impulses.
#[derive(Debug)]
pub(super) struct AndersonMixing<const M: usize> {
    /// How many impulses there are: contacts and rolling friction.
    count: usize,
    /// Distance of the farthest contact from the centre of mass (m).
    reach_m: f64,
    restarts: u32,
    /// Size of the largest impulse of the sweeps that went before (N s).
    reference_size: Option<f64>,
    /// Impulses with which the sweep began.
    start: ContactImpulses<M>,
    /// What the sweep before changed, where it ended, and the size of what it changed squared.
    last: Option<(ContactImpulses<M>, ContactImpulses<M>, f64)>,
    /// Differences of what sweeps changed, made square to each other, with the differences of their ends that belong to them.
    basis: [(ContactImpulses<M>, ContactImpulses<M>); DEPTH],
    /// How many of them, and where the next goes.
    len: usize,
}

fn dot<const M: usize>(one: &ContactImpulses<M>, other: &ContactImpulses<M>, count: usize) -> f64 {
    one[..count].iter().zip(&other[..count]).map(|(a, b)| a.dot(b)).sum()
}

/// Size of the largest of them.
fn largest<const M: usize>(all: &ContactImpulses<M>, count: usize) -> f64 {
    all[..count].iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt()
}

/// `to − from`.
fn difference<const M: usize>(
    to: &ContactImpulses<M>,
    from: &ContactImpulses<M>,
    count: usize,
) -> ContactImpulses<M> {
    let mut off = [Vec3::zeros(); M];
    for k in 0..count {
        off[k] = to[k] - from[k];
    }
    off
}

/// Takes a share of the one from the other.
fn subtract<const M: usize>(
    from: &mut ContactImpulses<M>,
    one: &ContactImpulses<M>,
    share: f64,
    count: usize,
) {
    for k in 0..count {
        from[k] -= one[k] * share;
    }
}

impl<const M: usize> AndersonMixing<M> {
    const NONE: ContactImpulses<M> = [Vec3::new(0.0, 0.0, 0.0); M];

    /// Of so many impulses, of contacts that reach so far from the centre of mass (m).
    pub(super) fn of(count: usize, reach_m: f64) -> Self {
        let basis = [(Self::NONE, Self::NONE); DEPTH];
        Self {
            count,
            reach_m,
            restarts: 0,
            reference_size: None,
            start: Self::NONE,
            last: None,
            basis,
            len: 0,
        }
    }

    /// A sweep begins with these impulses.
    #[inline]
    pub(super) fn begin(&mut self, contacts: &[BlockContact], rolling: &RollingImpulse) {
        self.start = self.collect_impulses(contacts, rolling);
        self.reference_size.get_or_insert(largest(&self.start, self.count));
    }

    fn collect_impulses(
        &self,
        contacts: &[BlockContact],
        rolling: &RollingImpulse,
    ) -> ContactImpulses<M> {
        let mut all = Self::NONE;
        for (one, contact) in all.iter_mut().zip(contacts) {
            *one = contact.impulse;
        }
        all[contacts.len()] = rolling.impulse / self.reach_m;
        all
    }

    /// After a sweep that has not settled: contacts and rolling friction take the impulses that the next begins with; the change of
    /// velocity and spin.
    pub(super) fn mix(
        &mut self,
        mass: &Mass,
        (contacts, rolling): (&mut [BlockContact], &mut RollingImpulse),
    ) -> (Vec3, Vec3) {
        let mut change = (Vec3::zeros(), Vec3::zeros());
        if self.restarts >= MOST_RESTARTS {
            return change;
        }
        let Some(next) = self.next(self.collect_impulses(contacts, rolling)) else { return change };
        if rolling.is_on() {
            let next = next[contacts.len()] * self.reach_m;
            change.1 += mass.inverse * (next - rolling.impulse);
            rolling.impulse = next;
        }
        for (contact, next) in contacts.iter_mut().zip(&next) {
            // none pulls
            if contact.n.dot(next) < 0.0 {
                continue;
            }
            let (dv, dw) = mass.velocity_change(contact, &(next - contact.impulse));
            change = (change.0 + dv, change.1 + dw);
            contact.impulse = *next;
        }
        change
    }

    /// The impulses with which the next sweep begins; `None` = those with which this one ended.
    fn next(&mut self, end: ContactImpulses<M>) -> Option<ContactImpulses<M>> {
        let count = self.count;
        let left = difference(&end, &self.start, count);
        let size2 = dot(&left, &left, count);
        let (last_left, last_ended, last_size2) = self.last.replace((left, end, size2))?;
        if size2 > RESTART_GROWTH * RESTART_GROWTH * last_size2 {
            return self.restart();
        }
        self.add_difference(
            difference(&left, &last_left, count),
            difference(&end, &last_ended, count),
        );
        let (mut rest, mut next) = (left, end);
        for (residual, end) in &self.basis[..self.len] {
            let share = dot(residual, &rest, count);
            subtract(&mut rest, residual, share, count);
            subtract(&mut next, end, share, count);
        }
        // not than those of this sweep: a hundred times, again and again, is without bound
        if self.reference_size.is_none_or(|reference_size| {
            largest(&next, count) > MOST_IMPULSE_GROWTH * reference_size
        }) {
            return self.restart();
        }
        Some(next)
    }

    /// Forgets the differences: the next sweep begins with what this one ended with.
    fn restart(&mut self) -> Option<ContactImpulses<M>> {
        (self.len, self.restarts) = (0, self.restarts + 1);
        None
    }

    /// Learns a difference of what sweeps changed, and of where they ended.
    fn add_difference(&mut self, mut residual: ContactImpulses<M>, mut end: ContactImpulses<M>) {
        let count = self.count;
        if self.len == DEPTH {
            // the oldest belongs to other directions of friction; those after it are square to it, so what is lost is its part alone
            self.basis.rotate_left(1);
            self.len -= 1;
        }
        let whole = dot(&residual, &residual, count).sqrt();
        for (basis, known_end) in &self.basis[..self.len] {
            let share = dot(basis, &residual, count);
            subtract(&mut residual, basis, share, count);
            subtract(&mut end, known_end, share, count);
        }
        let size = dot(&residual, &residual, count).sqrt();
        if size > LINEARLY_DEPENDENT * whole && size > 0.0 {
            for k in 0..count {
                residual[k] /= size;
                end[k] /= size;
            }
            self.basis[self.len] = (residual, end);
            self.len += 1;
        }
    }
}
