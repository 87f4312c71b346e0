//! A snapshot of a world, to restore: a rock that deviated further than its island allowed for may
//! have hit a rock of another island, which took no account of it.
//!
//! Only what later windows depend on is stored: motions, contact histories, random streams, and the
//! lengths of the recorders' lists. Geometry and scratch space are computed again. Cost: O(n) in
//! the rocks that are left.

use super::bodies::BodyWorld;
use super::{BodyState, Stop, WorldBody};
use crate::contact::pair::PairHistory;
use crate::simulation::recorder::RecorderMark;
use crate::simulation::rest::RestCriterion;
use crate::solver::island::MotionSnapshot;

/// All that later windows depend on.
pub(super) struct Snapshot {
    bodies: Vec<Option<BodySnapshot>>,
    pair_histories: Vec<PairHistory>,
    now_s: f64,
}

/// Snapshot of one rock.
pub(super) struct BodySnapshot {
    memory: MotionSnapshot,
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
    /// State of the rock, as far as later windows depend on it.
    pub(super) fn snapshot(&self) -> BodySnapshot {
        BodySnapshot {
            memory: self.member.snapshot(),
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

    /// Restores the state to the bit; effort and predicted velocity change are not restored.
    pub(super) fn restore(&mut self, saved: &BodySnapshot) {
        self.member.restore(&saved.memory);
        self.recorder.restore(&saved.mark);
        self.state.clone_from(&saved.state);
        self.flight_end.clone_from(&saved.flight_end);
        (self.rest_criterion, self.next_step_s, self.episode_start_j) =
            (saved.rest_criterion, saved.next_step_s, saved.episode_start_j);
        (self.spring_dv_m_s, self.is_unloaded) = (saved.spring_dv_m_s, saved.is_unloaded);
    }

    /// Raises the predicted velocity change to the deviation that was found, for the repeated
    /// computation.
    ///
    /// Twice the change that occurred: each return at least doubles the bound, so few returns
    /// suffice.
    pub(super) fn raise_predicted_dv(&mut self) {
        self.predicted_dv_m_s = self.predicted_dv_m_s.max(2.0 * self.deviation.1);
    }
}

impl BodyWorld<'_> {
    /// Takes a snapshot of the present.
    pub(super) fn snapshot(&self) -> Snapshot {
        // removed rocks do not come back
        let saved = |body: &WorldBody| {
            (!matches!(body.state, BodyState::Removed(_))).then(|| body.snapshot())
        };
        Snapshot {
            bodies: self.bodies.iter().map(|body| body.as_deref().and_then(saved)).collect(),
            pair_histories: self.pair_histories.clone(),
            now_s: self.now_s,
        }
    }

    /// Restores a snapshot.
    ///
    /// Rocks removed before it was taken stay removed: it holds nothing of them.
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
