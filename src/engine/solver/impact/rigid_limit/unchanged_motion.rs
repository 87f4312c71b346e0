//! Detection of a jammed rock: its motion no longer changes.

use crate::solver::body::{STILL, Twist};

/// Since when the motions have not changed.
///
/// A rock wedged between two contacts keeps its velocity, near 0, while springs and friction
/// balance each other: no step would end that.
pub(super) struct UnchangedMotion<const B: usize> {
    since: f64,
    motions: [Twist; B],
}

impl<const B: usize> UnchangedMotion<B> {
    /// No motion recorded yet.
    pub(super) const NONE: Self = Self { since: 0.0, motions: [STILL; B] };

    /// For how long velocities and spins have been the same, to `allowed`.
    pub(super) fn unchanged_for(&mut self, motions: &[Twist; B], time: f64, allowed: f64) -> f64 {
        let change2 = |((v, w), (was_v, was_w)): (&Twist, &Twist)| {
            (v - was_v).norm_squared().max((w - was_w).norm_squared())
        };
        let change2 = motions.iter().zip(&self.motions).map(change2).fold(0.0, f64::max);
        if change2 > allowed * allowed {
            (self.since, self.motions) = (time, *motions);
        }
        time - self.since
    }
}
