//! One moment of a world, kept to go back to: a rock that was thrown further than its island allowed for may have run
//! into another island that knew nothing of it.

use super::crowd::Crowd;
use super::{Rover, State, Stop};
use crate::contact::pair::Tie;
use crate::coupled::Memory;
use crate::trajectory::journey::Journey;
use std::collections::BTreeMap;

/// All that later windows depend on.
pub(super) struct Moment<'a> {
    rovers: Vec<Option<Kept<'a>>>,
    ties: BTreeMap<(u32, u32), Tie>,
    now_s: f64,
}

/// One rock of it.
struct Kept<'a> {
    memory: Memory,
    journey: Journey<'a>,
    state: State,
    lands: Option<(f64, Option<Stop>)>,
    quiet_s: f64,
    h: f64,
    began_j: (f64, f64),
}

impl<'a> Rover<'a> {
    fn keep(&self) -> Kept<'a> {
        Kept {
            memory: self.member.memory(),
            journey: self.journey.clone(),
            state: self.state.clone(),
            lands: self.lands.clone(),
            quiet_s: self.quiet_s,
            h: self.h,
            began_j: self.began_j,
        }
    }

    fn go_back(&mut self, kept: &Kept<'a>) {
        self.member.recall(&kept.memory);
        let effort = self.journey.effort;
        self.journey = kept.journey.clone();
        // What was tried in vain was work all the same.
        self.journey.effort = effort;
        self.state.clone_from(&kept.state);
        self.lands.clone_from(&kept.lands);
        (self.quiet_s, self.h, self.began_j) = (kept.quiet_s, kept.h, kept.began_j);
    }
}

impl<'a> Crowd<'a> {
    /// Keeps the present.
    pub(super) fn moment(&self) -> Moment<'a> {
        // What is gone does not come back.
        let kept =
            |rover: &Rover<'a>| (!matches!(rover.state, State::Gone(_))).then(|| rover.keep());
        Moment {
            rovers: self.rovers.iter().map(|rover| rover.as_deref().and_then(kept)).collect(),
            ties: self.ties.clone(),
            now_s: self.now_s,
        }
    }

    /// Goes back to a moment that was kept.
    pub(super) fn go_back(&mut self, moment: &Moment<'a>) {
        for (rover, kept) in self.rovers.iter_mut().zip(&moment.rovers) {
            if let (Some(rover), Some(kept)) = (rover, kept) {
                rover.go_back(kept);
            }
        }
        self.ties = moment.ties.clone();
        self.now_s = moment.now_s;
    }
}
