//! Time within a step of an impact at which a contact begins, ends, or replaces another.

use super::changes::{ContactChange, ContactChanges};
use super::flow::SphereFlow;
use crate::contact::TOUCH;
use crate::rock::Vec3;
use crate::solver::impact::dormand_prince::NODES;
use crate::solver::law::ZERO;

/// Penetration at which a contact has begun, and at which it has ended (–, relative to R).
const BEGUN: f64 = 0.5 * TOUCH;
const ENDED: f64 = -2.0 * TOUCH;
/// Accuracy of these penetrations (–, relative to R).
const ACCURACY: f64 = 0.4 * TOUCH;
/// Margin beyond the radius within which contacts that begin or end are searched for (–, relative
/// to R).
const SEARCH_MARGIN: f64 = 0.05;
/// Iterations for it, at most.
const ROOT_STEPS: u32 = 40;
/// Accuracy of the time at which a contact replaces another (–, relative to the share of the step
/// before it).
const EXCHANGE_ACCURACY: f64 = 0.01;

impl<const C: usize> SphereFlow<'_, '_, C> {
    /// Share of the step at which the first contact begins or ends (–), on the `path` of centre and
    /// velocity over the step's share; `None` if none does. `dt` is the step's length (s).
    pub(super) fn change_share(
        &mut self,
        dt: f64,
        path: impl Fn(f64) -> (Vec3, Vec3),
    ) -> Option<f64> {
        let ContactChanges { onset, end, .. } = self.changes;
        let onset = onset.and_then(|seen| self.share_of((ContactChange::Onset, seen), dt, &path));
        let end = end.and_then(|seen| self.share_of((ContactChange::End, seen), dt, &path));
        [onset, end].into_iter().flatten().reduce(f64::min)
    }

    /// The same for one change, first seen at stage `seen`.
    ///
    /// Newton's method along the path, bracketed by the last position before the change and the
    /// first one behind it.
    fn share_of(
        &mut self,
        (change, seen): (ContactChange, usize),
        dt: f64,
        path: &impl Fn(f64) -> (Vec3, Vec3),
    ) -> Option<f64> {
        let exact = ACCURACY * self.radius_m();
        let is_beyond = |place: Option<(f64, Vec3)>| place.is_none_or(|(beyond, _)| beyond > 0.0);
        let mut look = |at: f64| {
            let (c, v) = path(at);
            (self.beyond_m(change, &c), v)
        };
        // stages are not on the path: the change may be a little later than at their nodes, or not
        // occur at all
        let places = [NODES[seen], 1.0].into_iter();
        let (mut high, mut seen) =
            places.map(|at| (at, look(at))).find(|(_, (place, _))| is_beyond(*place))?;
        let (mut low, mut at) = (0.0, high);
        for _ in 0..ROOT_STEPS {
            let (place, v) = seen;
            if is_beyond(place) {
                high = at;
            } else {
                low = at;
            }
            let next = match place {
                Some((beyond, _)) if beyond.abs() <= exact => return Some(at),
                Some((beyond, n)) => at - beyond / (change.sign() * -n.dot(&v) * dt),
                None => f64::NAN,
            };
            at = if next > low && next < high { next } else { 0.5 * (low + high) };
            seen = look(at);
        }
        Some(high)
    }

    /// Distance of a rock at `c` beyond a change (m, negative before it), and the normal of its
    /// contact; `None` if there is no such contact: it has then ended, or not yet begun.
    fn beyond_m(&mut self, change: ContactChange, c: &Vec3) -> Option<(f64, Vec3)> {
        let radius = self.radius_m();
        self.look_within(c, radius * (1.0 + SEARCH_MARGIN));
        let mut first = self.changes.first(change, &self.state.touches);
        if first.is_none() && change == ContactChange::End {
            // Of two sheets on top of each other the farther one may represent both where it is in
            // reach, so the contact of the step's start is searched for by itself. Otherwise its
            // end was located at the start of the step, again and again.
            self.look(c);
            first = self.changes.first(change, &self.state.touches);
        }
        let beyond = |(distance, n)| match change {
            ContactChange::Onset => (radius - distance - BEGUN * radius, n),
            ContactChange::End => (ENDED * radius - (radius - distance), n),
        };
        match (first, change) {
            (None, ContactChange::Onset) => Some((-SEARCH_MARGIN * radius, ZERO)),
            (first, _) => first.map(beyond),
        }
    }

    /// Share of the step just beyond which contacts have replaced others (–), on the `path` of the
    /// centre.
    pub(super) fn exchange_share(&mut self, path: impl Fn(f64) -> Vec3) -> Option<f64> {
        let (mut low, mut high) = (0.0, NODES[self.changes.exchange?]);
        while high - low > EXCHANGE_ACCURACY * high {
            let at = 0.5 * (low + high);
            self.look(&path(at));
            let exchanged = self.changes.are_exchanged(&self.state.touches);
            (low, high) = if exchanged { (low, at) } else { (at, high) };
        }
        Some(high)
    }
}
