//! Captured contacts that rebound after all, because a blow is transmitted through them.
//!
//! Rocks that lie on each other and on the ground have come there slowly: their contacts are
//! captured, and damped so that nothing flutters. A blow through these contacts is no slow
//! approach. They become part of it as soon as it presses them together faster than the capture
//! speed, as do those that were slightly open when it came. Without that a blow on a heap, a row or
//! a cradle of rocks lost most of its energy, with restitution 1 too, or none, by a rounding of the
//! gaps.

use super::assembly::Island;
use super::body::IslandBody;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::terrain::Terrain;

impl Island<'_> {
    /// Lets captured contacts rebound that are pressed together too fast for capture: those of two
    /// rocks, and those with the mesh of rocks that touch others. Whether there were any.
    pub(super) fn release_struck(&mut self) -> bool {
        let Self { terrain, members, pair_histories, .. } = self;
        let mut any_released = false;
        let mut touches_others = vec![false; members.len()];
        for pair_history in pair_histories.iter_mut().filter(|pair| PairHistory::is_held(pair)) {
            let ends = [pair_history.a, pair_history.b].map(|k| k as usize);
            let [a, b] = ends.map(|k| &members[k].state);
            let (n, _) = normal_and_distance(&a.c, &b.c);
            any_released |= pair_history.release_if_struck(-n.dot(&(a.v - b.v)));
            for k in ends {
                touches_others[k] = true;
            }
        }
        for (member, _) in members.iter_mut().zip(touches_others).filter(|(_, touches)| *touches) {
            any_released |= member.release_ground(terrain);
        }
        any_released
    }
}

impl IslandBody {
    /// The same for its contacts with the mesh.
    fn release_ground(&mut self, terrain: &Terrain) -> bool {
        let (world, state) = self.with_environment(terrain);
        let mut any_released = false;
        for history in state.histories.iter_mut().filter(|one| one.captured && one.closed) {
            let approach_m_s = -history.n.dot(&state.v);
            let law = world.springs_of(history);
            if law.is_struck_through(history.normal_force, approach_m_s) {
                history.captured = false;
                state.impact.add_contact(approach_m_s, world.least_impact_m_s());
                any_released = true;
            }
        }
        any_released
    }
}
