//! An island of the rigid limit through one window: steps from its start to its end, without
//! events.
//!
//! No events are searched: the rigid step itself finds the impacts of its rocks, in the order of
//! their times.

use super::{IslandWindow, WorldBody};

impl IslandWindow<'_> {
    /// Whether the island is stepped as a whole in the rigid limit; a rock alone flies and steps as
    /// with springs.
    pub(in crate::simulation::world) fn is_rigid_heap(&self) -> bool {
        !self.settings.step.scheme.has_springs() && self.bodies.len() > 1
    }

    /// Advances all of the island to the end of the window. Flying rocks take part in the steps:
    /// that costs next to nothing, while stopping at each of their contacts would cost all others a
    /// step.
    pub(in crate::simulation::world) fn run_rigid(&mut self) {
        let (settings, now_s) = (self.settings, self.now_s);
        for body in &mut self.bodies {
            body.wake(settings, now_s);
            body.fly_to(settings, now_s);
        }
        let mut island = self.lend_to_solver();
        while self.now_s < self.end_s {
            let longest_s = self.end_s - self.now_s;
            let spent = (island.sweeps, island.newton_steps);
            let Some(done) = self.advance(&mut island, longest_s) else { break };
            // a step of the full length ends exactly at the window's end
            self.now_s = if done.dt >= longest_s { self.end_s } else { self.now_s + done.dt };
            self.record_step(&mut island, &done, (spent, WorldBody::record_rigid_step));
        }
        self.take_back_from_solver(island);
        self.remove_departed();
        self.put_to_sleep();
    }

    /// Removes the rocks whose flight has left the terrain.
    fn remove_departed(&mut self) {
        for body in self.bodies.iter_mut().filter(|body| body.member.flying) {
            let now_s = self.now_s;
            if let Some((_, Some(stop))) = body
                .flight_end
                .take_if(|flight_end| flight_end.0 <= now_s && flight_end.1.is_some())
            {
                body.remove(stop);
            }
        }
    }
}
