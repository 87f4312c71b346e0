//! One moment of a world, kept to go back to: a rock that was thrown further than its island allowed for may have run
//! into another island that knew nothing of it.

use super::crowd::Crowd;
use super::{Rover, State, Stop};
use crate::contact::pair::Tie;
use crate::coupled::Memory;
use crate::trajectory::calm::Calm;
use crate::trajectory::journey::Mark;

/// All that later windows depend on.
pub(super) struct Moment {
    rovers: Vec<Option<Kept>>,
    ties: Vec<Tie>,
    now_s: f64,
}

/// One rock of it.
pub(super) struct Kept {
    memory: Memory,
    mark: Mark,
    state: State,
    lands: Option<(f64, Option<Stop>)>,
    calm: Calm,
    h: f64,
    pressed_m_s: f64,
    began_j: (f64, f64),
}

impl Rover<'_> {
    pub(super) fn keep(&self) -> Kept {
        Kept {
            memory: self.member.memory(),
            mark: self.journey.mark(),
            state: self.state.clone(),
            lands: self.lands.clone(),
            calm: self.calm,
            h: self.h,
            pressed_m_s: self.pressed_m_s,
            began_j: self.began_j,
        }
    }

    pub(super) fn go_back(&mut self, kept: &Kept) {
        self.member.recall(&kept.memory);
        self.journey.go_back(&kept.mark);
        self.state.clone_from(&kept.state);
        self.lands.clone_from(&kept.lands);
        (self.calm, self.h, self.began_j) = (kept.calm, kept.h, kept.began_j);
        self.pressed_m_s = kept.pressed_m_s;
    }

    /// When this is gone through again, it is known how far the rock was thrown.
    pub(super) fn foresee(&mut self) {
        self.foreseen_m_s = self.foreseen_m_s.max(2.0 * self.off.1);
    }
}

impl Crowd<'_> {
    /// Keeps the present.
    pub(super) fn moment(&self) -> Moment {
        // What is gone does not come back.
        let kept = |rover: &Rover| (!matches!(rover.state, State::Gone(_))).then(|| rover.keep());
        Moment {
            rovers: self.rovers.iter().map(|rover| rover.as_deref().and_then(kept)).collect(),
            ties: self.ties.clone(),
            now_s: self.now_s,
        }
    }

    /// Goes back to a moment that was kept.
    pub(super) fn go_back(&mut self, moment: &Moment) {
        for (rover, kept) in self.rovers.iter_mut().zip(&moment.rovers) {
            if let (Some(rover), Some(kept)) = (rover, kept) {
                rover.go_back(kept);
            }
        }
        self.ties.clone_from(&moment.ties);
        self.now_s = moment.now_s;
    }
}
