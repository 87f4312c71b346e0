//! Anderson acceleration of the sweeps (Anderson 1965; Walker and Ni 2011).
//!
//! A sweep maps impulses `x` to `g(x)`; they have converged where `f = g − x` is 0. Plain sweeps
//! reduce the error by a constant factor, which is near 1 where a face presses on all its corners
//! or friction outweighs the lever. The next sweep starts from the combination of the last `g`
//! whose combination of `f` is least. While every contact keeps sticking or sliding, the body has
//! few unknowns, so that a few sweeps suffice. The map of a sweep and the test of convergence are
//! unchanged. The second half of the sweeps runs without acceleration: sweeps that alternate
//! between two contact states would otherwise never converge.

use super::super::rolling::RollingImpulse;
use super::{BlockContact, Mass};
use crate::rock::Vec3;

/// Differences kept (–): a sliding face has three motions to converge, and rounding.
const DEPTH: usize = 4;
/// Plain sweeps before the first mixing: most solves converge in them.
pub(super) const PLAIN_SWEEPS: u32 = 2;
/// A difference is linearly dependent on those before it if less than this remains of it (–,
/// relative to its size).
const LINEARLY_DEPENDENT: f64 = 1e-7;
/// The residual may grow by this factor (–) before the differences are discarded: contacts have
/// changed between sticking and sliding.
const RESTART_GROWTH: f64 = 2.0;
/// A mixed impulse may exceed the largest impulse of the plain sweeps by this factor (–). If a
/// contact that would pull is left out of the mixing, those beside it grow from sweep to sweep, and
/// velocities would lose their digits.
const MOST_IMPULSE_GROWTH: f64 = 100.0;
/// Restarts after which sweeps go on without mixing.
const MOST_RESTARTS: u32 = 6;

/// The impulses of all contacts and, last, the angular impulse of rolling friction over the reach
/// of the contacts (N s).
type ContactImpulses<const M: usize> = [Vec3; M];

/// History of the last sweeps for up to `M` impulses.
#[derive(Debug)]
pub(super) struct AndersonMixing<const M: usize> {
    /// Number of impulses: contacts and rolling friction.
    count: usize,
    /// Distance of the farthest contact from the centre of mass (m).
    reach_m: f64,
    restarts: u32,
    /// Size of the largest impulse of the plain sweeps (N s).
    reference_size: Option<f64>,
    /// Impulses at the start of the sweep.
    start: ContactImpulses<M>,
    /// The last sweep: its residual, its end, and the squared size of its residual.
    last: Option<(ContactImpulses<M>, ContactImpulses<M>, f64)>,
    /// Orthonormalised differences of residuals, with the corresponding differences of the ends.
    basis: [(ContactImpulses<M>, ContactImpulses<M>); DEPTH],
    /// Number of differences, and place of the next.
    len: usize,
}

fn dot<const M: usize>(one: &ContactImpulses<M>, other: &ContactImpulses<M>, count: usize) -> f64 {
    one[..count].iter().zip(&other[..count]).map(|(a, b)| a.dot(b)).sum()
}

/// Size of the largest impulse.
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

/// Subtracts a multiple of one from the other.
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

    /// For `count` impulses, of contacts that reach so far from the centre of mass (m).
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

    /// Records the impulses at the start of a sweep.
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

    /// After a sweep that has not converged: sets the impulses with which the next one starts;
    /// returns the change of velocity and spin.
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
            // no contact may pull
            if contact.n.dot(next) < 0.0 {
                continue;
            }
            let (dv, dw) = mass.velocity_change(contact, &(next - contact.impulse));
            change = (change.0 + dv, change.1 + dw);
            contact.impulse = *next;
        }
        change
    }

    /// The impulses with which the next sweep starts; `None` for those with which this one ended.
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
        // compared with the plain sweeps, not with this sweep: a factor of a hundred, again and
        // again, is no bound
        if self.reference_size.is_none_or(|reference_size| {
            largest(&next, count) > MOST_IMPULSE_GROWTH * reference_size
        }) {
            return self.restart();
        }
        Some(next)
    }

    /// Discards the differences: the next sweep starts with the end of this one.
    fn restart(&mut self) -> Option<ContactImpulses<M>> {
        (self.len, self.restarts) = (0, self.restarts + 1);
        None
    }

    /// Adds a difference of residuals, and the corresponding difference of ends.
    fn add_difference(&mut self, mut residual: ContactImpulses<M>, mut end: ContactImpulses<M>) {
        let count = self.count;
        if self.len == DEPTH {
            // the oldest belongs to other friction directions; the later ones are orthogonal to it,
            // so that only its part is lost
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
