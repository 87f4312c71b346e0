//! Groups of rocks in contact fall asleep together, and leave the terrain together.

use super::super::{BodyState, WorldBody};
use super::IslandWindow;
use crate::contact::pair::held_groups;
use crate::flight::{FlightEnd, Parabola, time_of_impact_without};
use crate::rock::Vec3;
use crate::simulation::Stop;

impl IslandWindow<'_> {
    /// The groups of rocks in contact with each other, by their indices in the island.
    fn groups_in_contact(&self) -> Vec<Vec<u32>> {
        held_groups(self.bodies.len(), &self.pair_histories).lists()
    }

    /// Puts to sleep the groups in which all rocks have been quiet for long enough.
    pub(super) fn put_to_sleep(&mut self) {
        let is_quiet = |body: &WorldBody| {
            body.state == BodyState::Moving
                && !body.member.flying
                && body.rest_criterion.is_at_rest()
        };
        if !self.bodies.iter().any(|body| is_quiet(body)) {
            return;
        }
        // a group falls asleep as a whole or not at all: one that still moves would pull on the
        // others
        for list in self.groups_in_contact() {
            if list.iter().all(|k| is_quiet(&self.bodies[*k as usize])) {
                for k in list {
                    self.bodies[k as usize].state = BodyState::Asleep;
                }
            }
        }
    }

    /// Removes bonded rocks that have passed the border of the terrain. A rock alone is removed
    /// where its last flight passes the last ground, but bonded rocks do not fly.
    pub(super) fn remove_past_border(&mut self) {
        if self.pair_histories.iter().all(|pair_history| pair_history.bond.is_none()) {
            return;
        }
        for list in self.groups_in_contact() {
            if list.len() > 1 && self.is_past_border(&list) {
                for k in list {
                    self.bodies[k as usize].remove(Stop::LeftTerrain);
                }
            }
        }
    }

    /// Whether a group has no ground below, and its bounding sphere, which flies as its centre of
    /// mass does, never touches the mesh again.
    fn is_past_border(&self, list: &[u32]) -> bool {
        let terrain = self.settings.terrain;
        let rocks = || list.iter().map(|k| &*self.bodies[*k as usize]);
        let is_off = |rock: &WorldBody| {
            let at = rock.member.state.c;
            rock.state == BodyState::Moving
                && rock.member.state.is_free()
                && terrain.ground_below(at.x, at.y).is_none()
        };
        if !rocks().all(is_off) {
            return false;
        }
        let mean = |of: fn(&WorldBody) -> Vec3| {
            let mass = |rock: &WorldBody| rock.member.body.mass;
            rocks().map(|rock| of(rock) * mass(rock)).sum::<Vec3>() / rocks().map(mass).sum::<f64>()
        };
        let start = mean(|rock| rock.member.state.c);
        let farthest =
            |rock: &WorldBody| (rock.member.state.c - start).norm() + rock.member.body.radius;
        let ball = Parabola {
            start,
            velocity: mean(|rock| rock.member.state.v),
            gravity: self.settings.gravity_m_s2,
            radius: rocks().map(farthest).fold(0.0, f64::max),
        };
        let flight = time_of_impact_without(terrain, &ball, f64::INFINITY, &[], &mut 0);
        matches!(flight, FlightEnd::Leaves(_))
    }
}
