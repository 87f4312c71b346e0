//! Heaps in the rigid limit: what `adaptive` leaves out where many rocks lie on each other.
//!
//! In a heap each small impact propagates through all rocks in contact. The step of all is as short
//! as the springs of one require, while the heap as a whole hardly moves. Therefore an island in
//! which many rocks are in contact is advanced as with `rigid`, the limit of the same law, until it
//! is small again, or a rock of it is hit hard. Hard impacts keep their springs: what a boulder
//! that falls on a heap throws up depends on how its impact propagates through the whole heap, and
//! large islands of the rigid limit follow an impact through the nearest rocks only. Between two
//! windows the springs are unloaded into motion (`solver::island::unload`), or start again relaxed.
//! The errors are those of `rigid` at such speeds: the time of an impact, the depth `m g/p_N` of
//! static penetration, and the propagation of small impacts.

use super::bodies::BodyWorld;
use super::window::IslandWindow;
use super::{PairMaterial, WorldBody};
use crate::contact::pair::{PairHistory, held_groups, normal_and_distance};
use crate::rock::Motion;
use crate::simulation::settings::RunSettings;
use crate::solver::island::unload_pair;
use crate::solver::loss::EnergyGiven;
use crate::solver::{MOST_WITH_SPRINGS, Settings};

/// Settings of the step of heaps where they are computed in the rigid limit; none where bonds may
/// break, since bonds have springs.
pub(super) fn step_in_heaps(step: &Settings, material: &PairMaterial) -> Option<Settings> {
    (step.rigid_heaps && !material.strength.is_some()).then(|| step.in_rigid_limit())
}

impl<'a> BodyWorld<'a> {
    /// Settings with which an island of these rocks is stepped; the ends of pairs are indices into
    /// `ids`.
    ///
    /// A heap remains one as long as its island is as large and most of its rocks were part of it:
    /// in the rigid limit impacts take no time, and rocks that bounce do not touch.
    pub(super) fn settings_of(&self, ids: &[u32], pairs: &[PairHistory]) -> &'a RunSettings<'a> {
        let Some(heaps) = self.heaps.filter(|_| ids.len() > MOST_WITH_SPRINGS) else {
            return self.settings;
        };
        let unloaded = ids.iter().filter(|&&k| self.body(k).is_unloaded).count();
        let is_heap =
            2 * unloaded > ids.len() || largest_touching(ids.len(), pairs) > MOST_WITH_SPRINGS;
        let is_struck_hard =
            |pair: &PairHistory| self.is_struck_hard([pair.a, pair.b].map(|k| ids[k as usize]));
        if is_heap && !pairs.iter().any(is_struck_hard) { heaps } else { self.settings }
    }

    /// Whether two rocks approach each other so fast that one is hit hard: large islands of the
    /// rigid limit follow such an impact through the nearest rocks only.
    fn is_struck_hard(&self, ends: [u32; 2]) -> bool {
        let [a, b] = ends.map(|k| self.body(k));
        let [at, other] = [a, b].map(|body| body.position_at(self.settings, self.now_s));
        let [v, w] = [a, b].map(|body| body.velocity_at(self.settings, self.now_s));
        let (n, _) = normal_and_distance(&at, &other);
        let approach_m_s = -n.dot(&(v - w));
        [a, b].iter().any(|body| body.member.body.is_struck_hard(approach_m_s))
    }
}

/// Size of the largest group of rocks in contact, directly or through others, in an island of
/// `count`.
fn largest_touching(count: usize, pairs: &[PairHistory]) -> usize {
    held_groups(count, pairs).sizes().into_iter().max().unwrap_or(0)
}

impl IslandWindow<'_> {
    /// Makes the contacts have springs if and only if the island's scheme has.
    pub(super) fn load_or_unload(&mut self) {
        let unloaded = !self.settings.step.scheme.has_springs();
        if self.bodies.iter().all(|body| body.is_unloaded == unloaded) {
            return;
        }
        if unloaded {
            self.unload();
        } else {
            self.load();
        }
        self.bodies.iter_mut().for_each(|body| body.is_unloaded = unloaded);
    }

    /// Releases the elastic energy into motion.
    fn unload(&mut self) {
        let Self { settings, bodies, pair_histories, .. } = self;
        let on_mesh = |body: &&mut Box<WorldBody>| !body.is_unloaded && !body.member.flying;
        for body in bodies.iter_mut().filter(on_mesh) {
            body.unload(settings);
        }
        for pair in pair_histories.iter_mut().filter(|pair| pair.is_held()) {
            let ends = [pair.a as usize, pair.b as usize];
            let Ok([a, b]) = bodies.get_disjoint_mut(ends) else { continue };
            // the rocks of a held pair were in one island
            if !a.is_unloaded {
                let given = unload_pair(pair, [&mut a.member, &mut b.member]);
                a.continue_unloaded(&given[0]);
                b.continue_unloaded(&given[1]);
            }
        }
    }

    /// Resets springs to relaxed: contacts of the rigid limit store the forces of their last step.
    fn load(&mut self) {
        for body in self.bodies.iter_mut().filter(|body| body.is_unloaded) {
            body.member.reset_springs();
        }
        // other rocks in the island may have springs already
        let of_heap = |pair: &&mut PairHistory| self.bodies[pair.a as usize].is_unloaded;
        self.pair_histories.iter_mut().filter(of_heap).for_each(PairHistory::reset_springs);
    }
}

impl WorldBody<'_> {
    /// Unloads its contacts with the mesh.
    fn unload(&mut self, settings: &RunSettings) {
        self.in_contact(settings).leave_facet();
        let loss = self.member.unload(settings.terrain);
        self.recorder.book_losses(&loss);
        self.continue_unloaded(&EnergyGiven::default());
        self.recorder.end_all_impacts();
    }

    /// Continues with the motion after unloading.
    fn continue_unloaded(&mut self, given: &EnergyGiven) {
        self.book_given(given);
        let (velocity_m_s, spin_rad_s) = (self.member.state.v, self.member.state.w);
        self.recorder.record_velocity_jump(Motion {
            velocity_m_s,
            spin_rad_s,
            ..self.recorder.now
        });
        self.update_deviation();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::Law;

    /// A chain counts as one group, whatever its order; pairs that are only near do not count.
    #[test]
    fn rocks_that_hold_each_other_are_counted() {
        let pair = |a, b, closed| PairHistory { closed, ..PairHistory::new(a, b, Law::NONE) };
        let pairs = [pair(0, 1, true), pair(1, 4, true), pair(2, 3, true), pair(3, 4, false)];
        assert_eq!(largest_touching(6, &pairs), 3);
        assert_eq!(largest_touching(6, &[]), 1);
    }
}
