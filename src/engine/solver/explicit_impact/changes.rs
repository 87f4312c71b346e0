//! What comes and what goes within a step of an impact.
//!
//! Where a contact begins or ends the force jumps: its own dashpot acts from one instant to the next, and the others' dashpots share with
//! it. No pair of any order sees where that is. So the contacts of a step are those of its start: one that begins waits, one that ends is
//! still counted, and the step ends where that happens first, found on its own path. Where a contact takes the place of another, from
//! a face over an edge to the next, forces go on and only their rates jump: it acts at once, and a step whose error is too large for
//! that is tried anew up to there.

use crate::contact::{ContactPoint, ContactPoints, Feature, MOST};
use crate::rock::Vec3;
use arrayvec::ArrayVec;

/// The contacts of a step's start, and the first stages that see others.
#[derive(Debug, Clone)]
pub(super) struct ContactChanges {
    at_start: ArrayVec<(Feature, Vec3), MOST>,
    /// Whether each of them is a single point.
    are_single: bool,
    /// Normals of those that the current stage does not touch any more.
    ended: ArrayVec<Vec3, MOST>,
    /// First stage at which a contact that waits would press, at which one has ended, at which one has taken the place of another.
    pub(super) onset: Option<usize>,
    pub(super) end: Option<usize>,
    pub(super) exchange: Option<usize>,
    /// Whether the step ends just past an exchange that is known.
    pub(super) ends_past_exchange: bool,
}

/// Which change is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ContactChange {
    Onset,
    End,
}

/// Touches beside those of the step's start.
#[derive(Debug, Clone, Copy, PartialEq)]
enum TouchComparison {
    Same,
    /// All of them, and more.
    More,
    /// Some of them, and no other.
    Fewer,
    /// Anything else.
    Others,
}

impl ContactChanges {
    /// None, and no contacts.
    pub(super) const NONE: Self = Self {
        at_start: ArrayVec::new_const(),
        are_single: true,
        ended: ArrayVec::new_const(),
        onset: None,
        end: None,
        exchange: None,
        ends_past_exchange: false,
    };

    /// The contacts of the step's start.
    pub(super) fn begin<'a>(&mut self, touches: impl Iterator<Item = &'a ContactPoint>) {
        self.at_start.clear();
        self.are_single = true;
        for touch in touches {
            self.at_start.push((touch.feature, touch.normal));
            self.are_single &= touch.is_single();
        }
    }

    /// Begins another try.
    pub(super) fn begin_try(&mut self) {
        (self.onset, self.end, self.exchange) = (None, None, None);
    }

    /// Whether a stage has seen any.
    pub(super) fn are_any(&self) -> bool {
        self.onset.or(self.end).or(self.exchange).is_some()
    }

    /// Normals of the contacts that have ended since the step's start.
    pub(super) fn ended(&self) -> &[Vec3] {
        &self.ended
    }

    fn has(&self, feature: Feature) -> bool {
        self.at_start.iter().any(|at_start| at_start.0 == feature)
    }

    /// How many of the touches were there at the step's start.
    fn count_persisting(&self, touches: &ContactPoints) -> usize {
        touches.iter().filter(|touch| self.has(touch.feature)).count()
    }

    /// What the touches are to those of the step's start.
    fn compared(&self, touches: &ContactPoints) -> TouchComparison {
        let persisting = self.count_persisting(touches);
        let are_single = touches.iter().all(ContactPoint::is_single);
        match (persisting == self.at_start.len(), persisting == touches.len()) {
            (true, true) if are_single == self.are_single => TouchComparison::Same,
            (true, false) if are_single && self.are_single => TouchComparison::More,
            (false, true) if are_single && self.are_single => TouchComparison::Fewer,
            _ => TouchComparison::Others,
        }
    }

    /// Whether contacts have taken the place of others, or a patch that of single points.
    pub(super) fn are_exchanged(&self, touches: &ContactPoints) -> bool {
        self.compared(touches) == TouchComparison::Others
    }

    /// Makes the touches of stage `node` those of the step's start, for a rock of `radius` (m); those of the ends, 0, are what they are.
    pub(super) fn keep_start_contacts(
        &mut self,
        node: usize,
        touches: &mut ContactPoints,
        radius: f64,
    ) {
        self.ended.clear();
        if node == 0 {
            return;
        }
        match self.compared(touches) {
            TouchComparison::Same => {}
            TouchComparison::Others => self.exchange = self.exchange.or(Some(node)),
            TouchComparison::Fewer => {
                self.end = self.end.or(Some(node));
                let is_gone = |one: &&(Feature, Vec3)| touches.iter().all(|at| at.feature != one.0);
                self.ended.extend(self.at_start.iter().filter(is_gone).map(|one| one.1));
            }
            TouchComparison::More => {
                let mut waits = touches.iter().filter(|touch| !self.has(touch.feature));
                let presses = waits.any(|touch| touch.distance_m < radius);
                self.onset = self.onset.or(presses.then_some(node));
                touches.retain(|touch| self.has(touch.feature));
            }
        }
    }

    /// The contact that comes first, or goes first, by its distance (m) and its normal.
    pub(super) fn first(
        &self,
        change: ContactChange,
        touches: &ContactPoints,
    ) -> Option<(f64, Vec3)> {
        let places = touches.iter().map(|touch| (touch.distance_m, touch.normal, touch.feature));
        let first = match change {
            ContactChange::Onset => {
                places.filter(|touch| !self.has(touch.2)).min_by(|a, b| a.0.total_cmp(&b.0))
            }
            ContactChange::End if self.count_persisting(touches) < self.at_start.len() => None,
            ContactChange::End => {
                places.filter(|touch| self.has(touch.2)).max_by(|a, b| a.0.total_cmp(&b.0))
            }
        };
        first.map(|(distance, normal, _)| (distance, normal))
    }
}

impl ContactChange {
    /// Whether penetration grows towards it.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Onset => 1.0,
            Self::End => -1.0,
        }
    }
}
