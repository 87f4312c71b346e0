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
use crate::solver::island::BodySnapshot;

/// All that later windows depend on.
pub(super) struct Snapshot {
    bodies: Vec<Option<Kept>>,
    pair_histories: Vec<PairHistory>,
    now_s: f64,
}

/// One rock of it.
pub(super) struct Kept {
    memory: BodySnapshot,
    mark: RecorderMark,
    state: BodyState,
    lands: Option<(f64, Option<Stop>)>,
    calm: RestCriterion,
    h: f64,
    pressed_m_s: f64,
    is_unloaded: bool,
    began_j: (f64, f64),
}

impl WorldBody<'_> {
    /// What the rock is now, as far as later windows depend on it.
    pub(super) fn keep(&self) -> Kept {
        Kept {
            memory: self.member.snapshot(),
            mark: self.recorder.mark(),
            state: self.state.clone(),
            lands: self.lands.clone(),
            calm: self.calm,
            h: self.h,
            pressed_m_s: self.pressed_m_s,
            is_unloaded: self.is_unloaded,
            began_j: self.began_j,
        }
    }

    /// To the bit what it was; only its effort and what is foreseen of it stay.
    pub(super) fn go_back(&mut self, kept: &Kept) {
        self.member.restore(&kept.memory);
        self.recorder.go_back(&kept.mark);
        self.state.clone_from(&kept.state);
        self.lands.clone_from(&kept.lands);
        (self.calm, self.h, self.began_j) = (kept.calm, kept.h, kept.began_j);
        (self.pressed_m_s, self.is_unloaded) = (kept.pressed_m_s, kept.is_unloaded);
    }

    /// When this is gone through again, it is known how far the rock was deviated.
    ///
    /// Twice the change that was seen: each return at least doubles the bound, so few returns
    /// suffice.
    pub(super) fn foresee(&mut self) {
        self.foreseen_m_s = self.foreseen_m_s.max(2.0 * self.off.1);
    }
}

impl BodyWorld<'_> {
    /// Keeps the present.
    pub(super) fn snapshot(&self) -> Snapshot {
        // What is gone does not come back.
        let kept =
            |body: &WorldBody| (!matches!(body.state, BodyState::Gone(_))).then(|| body.keep());
        Snapshot {
            bodies: self.bodies.iter().map(|body| body.as_deref().and_then(kept)).collect(),
            pair_histories: self.pair_histories.clone(),
            now_s: self.now_s,
        }
    }

    /// Goes back to a moment that was kept.
    ///
    /// Rocks that had left before then stay gone: nothing of theirs was kept.
    pub(super) fn go_back(&mut self, snapshot: &Snapshot) {
        for (body, kept) in self.bodies.iter_mut().zip(&snapshot.bodies) {
            if let (Some(body), Some(kept)) = (body, kept) {
                body.go_back(kept);
            }
        }
        self.pair_histories.clone_from(&snapshot.pair_histories);
        self.now_s = snapshot.now_s;
    }
}
