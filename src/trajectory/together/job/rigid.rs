//! An island of the rigid limit through one window: steps from its start to its end, whatever happens on the way.

use super::{Job, Rovers};
use crate::coupled::{Cluster, Done};
use crate::step::Scheme;

impl<'a> Job<'a> {
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
            self.note_rigid(&mut cluster, &done, spent);
        }
        self.dissolve(cluster);
        self.let_go();
        self.fall_asleep();
    }

    /// Writes one step into the journeys.
    fn note_rigid(&mut self, cluster: &mut Cluster<'a>, done: &Done, spent: (u64, u64)) {
        let (sweeps, jumps) = (cluster.sweeps - spent.0, cluster.jumps - spent.1);
        let rocks = self.rovers.len() as u64;
        self.census.add(&super::Census {
            steps: 1,
            rock_steps: rocks,
            sweeps,
            jumps,
            unsettled: u64::from(done.unsettled),
            largest: rocks,
            ..super::Census::default()
        });
        let slides = sliding(&self.rovers, cluster);
        let mut hits = done.hits.iter().peekable();
        for (k, rover) in self.rovers.iter_mut().enumerate() {
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
            while let Some(hit) = hits.next_if(|hit| hit.rock == k) {
                rover.hit(hit, self.now_s);
            }
            let effort = &mut rover.journey.effort;
            effort.steps += 1;
            effort.sweeps += sweeps + jumps;
            effort.unsettled += u64::from(done.unsettled);
            rover.stride(self.course, self.now_s, (done.losses[k], done.given_j[k]), slides[k]);
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
        }
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

/// Which rocks slide over another.
fn sliding(rovers: &Rovers, cluster: &Cluster) -> Vec<bool> {
    let mut slides = vec![false; rovers.len()];
    for tie in cluster.ties.iter().filter(|tie| tie.closed && tie.slides) {
        (slides[tie.a as usize], slides[tie.b as usize]) = (true, true);
    }
    slides
}
