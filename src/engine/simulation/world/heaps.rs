//! Heaps in the rigid limit: what `adaptive` leaves out where many rocks lie on each other.
//!
//! In a heap each small blow runs through all that touch, and the step of all is as short as the springs of one ask for, while the heap as
//! a whole hardly moves. So an island in which many rocks hold each other goes through its windows as with `rigid`, the limit of the
//! same law, until it is small again, or a rock of it is struck hard: what a boulder throws up that falls on a heap hangs on how its blow runs
//! through all of it, and in large islands of the rigid limit it is followed through the nearest of them alone. Between two windows its springs
//! are unloaded into motion (`solver::island::unload`), or begin anew at rest. Errors are those of `rigid` at such speeds: the time
//! of an impact, the depth `m g/p_N` that weight presses in, and the spread of small blows.

use super::bodies::BodyWorld;
use super::window::IslandWindow;
use super::{PairMaterial, WorldBody};
use crate::contact::pair::{PairHistory, between, held_groups};
use crate::rock::Motion;
use crate::simulation::settings::RunSettings;
use crate::solver::island::unload_pair;
use crate::solver::loss::EnergyGiven;
use crate::solver::{MOST_WITH_SPRINGS, Settings};

/// The step of heaps where they go on in the rigid limit: not where bonds are to break, as those have springs.
pub(super) fn step_in_heaps(step: &Settings, answer: &PairMaterial) -> Option<Settings> {
    (step.rigid_heaps && !answer.strength.is_some()).then(|| step.in_rigid_limit())
}

impl<'a> BodyWorld<'a> {
    /// How an island of these rocks is stepped; ends of pairs count places in `ids`.
    ///
    /// A heap stays one as long as its island is as large and most of its rocks are of it: in the rigid limit blows take no time, and those
    /// that bounce do not touch.
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

    /// Whether two rocks come so fast at each other that one is struck hard: large islands of the rigid limit follow that through the nearest alone.
    fn is_struck_hard(&self, ends: [u32; 2]) -> bool {
        let [a, b] = ends.map(|k| self.body(k));
        let [at, other] = [a, b].map(|body| body.position_at(self.settings, self.now_s));
        let [v, w] = [a, b].map(|body| body.velocity_at(self.settings, self.now_s));
        let (n, _) = between(&at, &other);
        let approach_m_s = -n.dot(&(v - w));
        [a, b].iter().any(|body| body.member.body.is_struck_hard(approach_m_s))
    }
}

/// How many rocks of an island of `count` hold each other, directly or through others, at most.
fn largest_touching(count: usize, pairs: &[PairHistory]) -> usize {
    held_groups(count, pairs).sizes().into_iter().max().unwrap_or(0)
}

impl IslandWindow<'_> {
    /// Sees to it that contacts have springs as far as the island's scheme has.
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

    /// What springs hold goes into motion.
    fn unload(&mut self) {
        let Self { settings, bodies, pair_histories, .. } = self;
        let on_mesh = |body: &&mut Box<WorldBody>| !body.is_unloaded && !body.member.flying;
        for body in bodies.iter_mut().filter(on_mesh) {
            body.unload(settings);
        }
        for pair in pair_histories.iter_mut().filter(|pair| pair.is_held()) {
            let ends = [pair.a as usize, pair.b as usize];
            let Ok([a, b]) = bodies.get_disjoint_mut(ends) else { continue };
            // a pair that is held has been in one island
            if !a.is_unloaded {
                let given = unload_pair(pair, [&mut a.member, &mut b.member]);
                a.go_on_unloaded(&given[0]);
                b.go_on_unloaded(&given[1]);
            }
        }
    }

    /// Springs begin at rest: contacts of the rigid limit know the forces of their last step.
    fn load(&mut self) {
        for body in self.bodies.iter_mut().filter(|body| body.is_unloaded) {
            body.member.forget_springs();
        }
        // others in the island may have springs already
        let of_heap = |pair: &&mut PairHistory| self.bodies[pair.a as usize].is_unloaded;
        self.pair_histories.iter_mut().filter(of_heap).for_each(PairHistory::forget_springs);
    }
}

impl WorldBody<'_> {
    /// Unloads its contacts with the mesh.
    fn unload(&mut self, settings: &RunSettings) {
        self.in_contact(settings).leave_facet();
        let loss = self.member.unload(settings.terrain);
        self.recorder.pay(&loss);
        self.go_on_unloaded(&EnergyGiven::default());
        self.recorder.end_all_impacts();
    }

    /// Goes on with the motion that springs have given it.
    fn go_on_unloaded(&mut self, given: &EnergyGiven) {
        self.give(given);
        let (velocity_m_s, spin_rad_s) = (self.member.state.v, self.member.state.w);
        self.recorder.go_on_with(Motion { velocity_m_s, spin_rad_s, ..self.recorder.now });
        self.watch();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::Law;

    /// Chains count as one, whatever their order; pairs that are only near do not.
    #[test]
    fn rocks_that_hold_each_other_are_counted() {
        let pair = |a, b, closed| PairHistory { closed, ..PairHistory::new(a, b, Law::NONE) };
        let pairs = [pair(0, 1, true), pair(1, 4, true), pair(2, 3, true), pair(3, 4, false)];
        assert_eq!(largest_touching(6, &pairs), 3);
        assert_eq!(largest_touching(6, &[]), 1);
    }
}
