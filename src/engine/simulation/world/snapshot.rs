//! A snapshot of a world, kept to go back to: a rock that was deviated further than its island allowed for may have run
//! into another island that knew nothing of it.
//!
//! Only what later windows depend on is kept: motions, memories of contacts, random streams, and
//! how long the recorders' lists were. Geometry and scratch space are found again. Cost: O(n) in the rocks that are left.

use super::bodies::BodyWorld;
use super::{BodyState, Stop, WorldBody};
use crate::contact::pair::PairHistory;
use crate::simulation::recorder::RecorderMark;
use crate::simulation::rest::RestCriterion;
use crate::solver::island::Memory;

/// All that later windows depend on.
pub(super) struct Snapshot {
    bodies: Vec<Option<BodySnapshot>>,
    pair_histories: Vec<PairHistory>,
    now_s: f64,
}

/// One rock of it.
pub(super) struct BodySnapshot {
    memory: Memory,
    mark: RecorderMark,
    state: BodyState,
    flight_end: Option<(f64, Option<Stop>)>,
    rest_criterion: RestCriterion,
    next_step_s: f64,
    spring_dv_m_s: f64,
    is_unloaded: bool,
    episode_start_j: (f64, f64),
}

impl WorldBody<'_> {
    /// What the rock is now, as far as later windows depend on it.
    pub(super) fn snapshot(&self) -> BodySnapshot {
        BodySnapshot {
            memory: self.member.memory(),
            mark: self.recorder.mark(),
            state: self.state.clone(),
            flight_end: self.flight_end.clone(),
            rest_criterion: self.rest_criterion,
            next_step_s: self.next_step_s,
            spring_dv_m_s: self.spring_dv_m_s,
            is_unloaded: self.is_unloaded,
            episode_start_j: self.episode_start_j,
        }
    }

    /// To the bit what it was; only its effort and what is foreseen of it stay.
    pub(super) fn restore(&mut self, saved: &BodySnapshot) {
        self.member.recall(&saved.memory);
        self.recorder.restore(&saved.mark);
        self.state.clone_from(&saved.state);
        self.flight_end.clone_from(&saved.flight_end);
        (self.rest_criterion, self.next_step_s, self.episode_start_j) =
            (saved.rest_criterion, saved.next_step_s, saved.episode_start_j);
        (self.spring_dv_m_s, self.is_unloaded) = (saved.spring_dv_m_s, saved.is_unloaded);
    }

    /// When this is gone through again, it is known how far the rock was deviated.
    ///
    /// Twice the change that was seen: each return at least doubles the bound, so few returns
    /// suffice.
    pub(super) fn raise_predicted_dv(&mut self) {
        self.predicted_dv_m_s = self.predicted_dv_m_s.max(2.0 * self.deviation.1);
    }
}

impl BodyWorld<'_> {
    /// Keeps the present.
    pub(super) fn snapshot(&self) -> Snapshot {
        // What is gone does not come back.
        let saved = |body: &WorldBody| {
            (!matches!(body.state, BodyState::Removed(_))).then(|| body.snapshot())
        };
        Snapshot {
            bodies: self.bodies.iter().map(|body| body.as_deref().and_then(saved)).collect(),
            pair_histories: self.pair_histories.clone(),
            now_s: self.now_s,
        }
    }

    /// Goes back to a moment that was kept.
    ///
    /// Rocks that had left before then stay gone: nothing of theirs was kept.
    pub(super) fn restore(&mut self, snapshot: &Snapshot) {
        for (body, saved) in self.bodies.iter_mut().zip(&snapshot.bodies) {
            if let (Some(body), Some(saved)) = (body, saved) {
                body.restore(saved);
            }
        }
        self.pair_histories.clone_from(&snapshot.pair_histories);
        self.now_s = snapshot.now_s;
    }
}
