//! Impacts as they begin and end, and what contacts take of a rock's energy.

use super::Recorder;
use crate::rock::Vec3;
use crate::simulation::Ledger;
use crate::simulation::impacts::{MeshEnergy, PatchOwner};
use crate::solver::impact_point::ImpactPoint;
use crate::solver::loss::Loss;

impl Recorder<'_> {
    /// Begins an impact on a triangle's patch at the present motion, to end at `until_s` (s) at the latest; `held_j` is what
    /// the springs of other contacts hold. Returns its number.
    pub(in crate::simulation) fn begin_impact(
        &mut self,
        struck: &ImpactPoint,
        until_s: f64,
        held_j: &MeshEnergy,
    ) -> u32 {
        let times_s = (self.now.time_s, until_s);
        // springs of contacts that are still pressed hold energy that is booked as lost until they
        // give it back: not this impact's
        let lost_j = (self.lost_to_each_j().less(held_j), self.ledger.soil_j);
        let speed_m_s = self.now.velocity_m_s.norm();
        let sheet = self.terrain.sheet_of[struck.triangle as usize];
        let is_tree = self.terrain.sheets[usize::from(sheet)].is_tree;
        let stem = self.terrain.stems.as_ref().and_then(|stems| stems.of_triangle(struck.triangle));
        let on = (struck, PatchOwner { sheet, is_tree, stem });
        let (number, is_new) = self.impacts.begin(on, times_s, speed_m_s, lost_j);
        self.tree_impact_count += u32::from(is_new && is_tree);
        number
    }

    /// Ends the impacts whose time is over or whose patch no longer `holds` the rock; whether those were the last, to be booked.
    #[must_use]
    pub(in crate::simulation) fn end_impacts(&mut self, holds: impl Fn(u32) -> bool) -> bool {
        if !self.impacts.is_any() {
            return false;
        }
        self.impacts.end(self.now.time_s, self.now.velocity_m_s.norm(), holds);
        !self.impacts.is_any()
    }

    /// Books what the impacts took that have ended; `held_j` as above.
    pub(in crate::simulation) fn book_impacts(&mut self, held_j: &MeshEnergy) {
        self.impacts.book((self.lost_to_each_j().less(held_j), self.ledger.soil_j));
    }

    /// Ends all impacts where no spring holds anything.
    pub(in crate::simulation) fn end_all_impacts(&mut self) {
        if self.end_impacts(|_| false) {
            self.book_impacts(&MeshEnergy::default());
        }
    }

    /// What of this velocity (m/s) is left to the rock that keeps a share of it (–); soil has the energy of the rest.
    pub(in crate::simulation) fn slowed_in_soil(&mut self, v: &Vec3, kept: f64) -> Vec3 {
        self.ledger.soil_j +=
            0.5 * self.form.rock.mass_kg() * v.norm_squared() * (1.0 - kept * kept);
        v * kept
    }

    /// The same of its velocity at the end of a flight.
    pub(in crate::simulation) fn slow_in_flight(&mut self, kept: f64) {
        let v = self.now.velocity_m_s;
        self.now.velocity_m_s = self.slowed_in_soil(&v, kept);
    }

    /// Writes losses into the ledger, what springs take up counted in.
    pub(in crate::simulation) fn pay(&mut self, loss: &Loss) {
        self.ledger.friction_j += loss.friction;
        self.ledger.damping_j += loss.damping;
        self.ledger.rolling_j += loss.rolling;
        self.ledger.trees_j += loss.trees;
    }

    /// Takes what springs hold at the end of an episode out of the losses, and what they `brought` along from before back in.
    pub(in crate::simulation) fn hold(&mut self, stored: &Loss, brought: &Loss) {
        let mut back = *brought;
        back.add(stored, -1.0);
        self.pay(&back);
        self.ledger.springs_j -= back.sum();
    }

    /// Writes down what springs between the rock and others hold at the end (J): booked as lost to others, and not lost.
    pub(in crate::simulation) fn hold_for_others(&mut self, held_j: f64) {
        self.ledger.others_j -= held_j;
        self.ledger.springs_j += held_j;
    }

    /// Ends an episode in which motion and weight have gained `rise_j` (J), with [`Self::hold`]. What springs hold is not lost, and no gain is
    /// due to what they have brought: what rises beyond that is an error of the numerics.
    pub(in crate::simulation) fn end_episode(
        &mut self,
        rise_j: f64,
        stored: &Loss,
        brought: &Loss,
    ) {
        self.hold(stored, brought);
        self.ledger.rise_j = self.ledger.rise_j.max(rise_j + stored.sum() - brought.sum());
    }

    /// All losses so far (J).
    /// Including what other rocks got or took.
    pub(in crate::simulation) fn lost_j(&self) -> f64 {
        let Ledger { friction_j, damping_j, rolling_j, trees_j, soil_j, others_j, .. } =
            self.ledger;
        friction_j + damping_j + rolling_j + trees_j + soil_j + others_j + self.ledger.passed_on_j
    }

    /// Those in contacts with the mesh, those with trees apart.
    fn lost_to_each_j(&self) -> MeshEnergy {
        let ledger = &self.ledger;
        MeshEnergy {
            slope_j: ledger.friction_j + ledger.damping_j + ledger.rolling_j + ledger.soil_j,
            trees_j: ledger.trees_j,
        }
    }
}
