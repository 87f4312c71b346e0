//! Contacts that begin, end or replace others within a step of an impact.
//!
//! Where a contact begins or ends the force jumps: its own dashpot acts at once, and the dashpots
//! of the other contacts are shared with it. No pair of any order can locate that. So the contacts
//! of a step are those of its start: a contact that begins is suspended, one that ends is still
//! counted, and the step ends where the first change happens on its dense output. Where a contact
//! replaces another, from a face over an edge to the next face, the force is continuous and only
//! its rate jumps: the new contact acts at once, and a step whose error is then too large is tried
//! anew up to there.

use crate::contact::{ContactPoint, ContactPoints, Feature, MAX_CONTACTS};
use crate::rock::Vec3;
use arrayvec::ArrayVec;

/// The contacts of a step's start, and the first stages that see other contacts.
#[derive(Debug, Clone)]
pub(super) struct ContactChanges {
    at_start: ArrayVec<(Feature, Vec3), MAX_CONTACTS>,
    /// Whether each of them is a single point.
    are_single: bool,
    /// Normals of those that the current stage no longer touches.
    ended: ArrayVec<Vec3, MAX_CONTACTS>,
    /// First stage at which a suspended contact would press, at which a contact has ended, and at
    /// which one has replaced another.
    pub(super) onset: Option<usize>,
    pub(super) end: Option<usize>,
    pub(super) exchange: Option<usize>,
    /// Whether the step ends just past a known exchange.
    pub(super) ends_past_exchange: bool,
}

/// Kind of change that is located.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ContactChange {
    Onset,
    End,
}

/// Contact points compared with those of the step's start.
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
    /// No changes, and no contacts.
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

    /// Begins another trial step.
    pub(super) fn begin_try(&mut self) {
        (self.onset, self.end, self.exchange) = (None, None, None);
    }

    /// Whether a stage has seen a change.
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

    /// Number of the contact points that existed at the step's start.
    fn count_persisting(&self, touches: &ContactPoints) -> usize {
        touches.iter().filter(|touch| self.has(touch.feature)).count()
    }

    /// Compares the contact points with those of the step's start.
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

    /// Whether contacts have replaced others, or a patch has replaced single points.
    pub(super) fn are_exchanged(&self, touches: &ContactPoints) -> bool {
        self.compared(touches) == TouchComparison::Others
    }

    /// Restricts the contact points of stage `node` to those of the step's start, for a rock of
    /// `radius` (m); those at the ends, node 0, are kept.
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
                let has_ended =
                    |one: &&(Feature, Vec3)| touches.iter().all(|at| at.feature != one.0);
                self.ended.extend(self.at_start.iter().filter(has_ended).map(|one| one.1));
            }
            TouchComparison::More => {
                let mut waits = touches.iter().filter(|touch| !self.has(touch.feature));
                let presses = waits.any(|touch| touch.distance_m < radius);
                self.onset = self.onset.or(presses.then_some(node));
                touches.retain(|touch| self.has(touch.feature));
            }
        }
    }

    /// The contact that begins first, or ends first: its distance (m) and its normal.
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
    /// Sign of the penetration rate at the change.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Onset => 1.0,
            Self::End => -1.0,
        }
    }
}
