//! An island of the rigid limit through one window: steps from its start to its end, whatever happens on the way.
//!
//! No events are looked for: the rigid step finds the impacts of its rocks by itself, in the order
//! of their times.

use super::{IslandWindow, WorldBody};

impl IslandWindow<'_> {
    /// Whether the island is stepped as a whole in the rigid limit; a rock alone leaps and steps as it always does.
    pub(in crate::simulation::world) fn is_rigid_heap(&self) -> bool {
        !self.settings.step.scheme.has_springs() && self.bodies.len() > 1
    }

    /// Takes all of the island to the end of the window. Rocks that fly are taken along: a step costs them next to
    /// nothing, and to stop for each of their touches would cost all others a step.
    pub(in crate::simulation::world) fn run_rigid(&mut self) {
        let (settings, now_s) = (self.settings, self.now_s);
        for body in &mut self.bodies {
            body.wake(settings, now_s);
            body.fly_to(settings, now_s);
        }
        let mut island = self.cluster();
        while self.now_s < self.end_s {
            let room = self.end_s - self.now_s;
            let spent = (island.sweeps, island.newton_steps);
            let Some(done) = self.advance(&mut island, room) else { break };
            // a step that takes all the room ends exactly at the window's end
            self.now_s = if done.dt >= room { self.end_s } else { self.now_s + done.dt };
            self.note(&mut island, &done, (spent, WorldBody::stride));
        }
        self.dissolve(island);
        self.let_go();
        self.fall_asleep();
    }

    /// Lets go of the rocks whose flight has left the terrain.
    fn let_go(&mut self) {
        for body in self.bodies.iter_mut().filter(|body| body.member.flying) {
            let now_s = self.now_s;
            if let Some((_, Some(stop))) =
                body.lands.take_if(|lands| lands.0 <= now_s && lands.1.is_some())
            {
                body.leave(stop);
            }
        }
    }
}
