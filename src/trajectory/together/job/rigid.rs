//! An island of the rigid limit through one window: steps from its start to its end, whatever happens on the way.

use super::{Job, Rover};
use crate::step::Scheme;

impl Job<'_> {
    /// Whether the island is stepped as a whole in the rigid limit; a rock alone leaps and steps as it always does.
    pub(in crate::trajectory::together) fn is_rigid_heap(&self) -> bool {
        self.course.step.scheme == Scheme::Rigid && self.rovers.len() > 1
    }

    /// Takes all of the island to the end of the window. Rocks that fly are taken along: a step costs them next to
    /// nothing, and to stop for each of their touches would cost all others a step.
    pub(in crate::trajectory::together) fn run_rigid(&mut self) {
        let (course, now_s) = (self.course, self.now_s);
        for rover in &mut self.rovers {
            rover.wake(course, now_s);
            rover.fly_to(course, now_s);
        }
        let mut cluster = self.cluster();
        while self.now_s < self.end_s {
            let room = self.end_s - self.now_s;
            let spent = (cluster.sweeps, cluster.jumps);
            let done = match cluster.advance_rigid(course.step.step_s, room) {
                Ok(done) => done,
                Err(stuck) => {
                    self.fail(stuck);
                    break;
                }
            };
            self.now_s = if done.dt >= room { self.end_s } else { self.now_s + done.dt };
            self.note(&mut cluster, &done, (spent, Rover::stride));
        }
        self.dissolve(cluster);
        self.let_go();
        self.fall_asleep();
    }

    /// Lets go of the rocks whose flight has left the terrain.
    fn let_go(&mut self) {
        for rover in self.rovers.iter_mut().filter(|rover| rover.member.flying) {
            let now_s = self.now_s;
            if let Some((_, Some(stop))) =
                rover.lands.take_if(|lands| lands.0 <= now_s && lands.1.is_some())
            {
                rover.leave(stop);
            }
        }
    }
}
