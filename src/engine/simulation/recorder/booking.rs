//! Begin and end of impacts, and the energy that contacts take from a rock.

use super::Recorder;
use crate::rock::Vec3;
use crate::simulation::Ledger;
use crate::simulation::impacts::{MeshEnergy, PatchOwner};
use crate::solver::impact_point::ImpactPoint;
use crate::solver::loss::Loss;

impl Recorder<'_> {
    /// Begins an impact on the patch of a triangle with the present motion, to end at
    /// `latest_end_s` (s) at the latest; `held_j` is the elastic energy of other contacts. Returns
    /// its number.
    pub(in crate::simulation) fn begin_impact(
        &mut self,
        struck: &ImpactPoint,
        latest_end_s: f64,
        held_j: &MeshEnergy,
    ) -> u32 {
        let times_s = (self.now.time_s, latest_end_s);
        // energy in springs of contacts that are still compressed is booked as lost until they
        // return it: it does not belong to this impact
        let lost_j = (self.lost_to_mesh_j().minus(held_j), self.ledger.soil_j);
        let speed_m_s = self.now.velocity_m_s.norm();
        let sheet = self.terrain.sheet_of[struck.triangle as usize];
        let is_tree = self.terrain.sheets[usize::from(sheet)].is_tree;
        let stem = self.terrain.stems.as_ref().and_then(|stems| stems.of_triangle(struck.triangle));
        let on = (struck, PatchOwner { sheet, is_tree, stem });
        let (number, is_new) = self.impacts.begin(on, times_s, speed_m_s, lost_j);
        self.tree_impact_count += u32::from(is_new && is_tree);
        number
    }

    /// Ends the impacts whose time is over or whose patch no longer `holds` the rock. Returns
    /// whether those were the last, so that their energy is to be booked.
    #[must_use]
    pub(in crate::simulation) fn end_impacts(&mut self, holds: impl Fn(u32) -> bool) -> bool {
        if !self.impacts.is_any_active() {
            return false;
        }
        self.impacts.end(self.now.time_s, self.now.velocity_m_s.norm(), holds);
        !self.impacts.is_any_active()
    }

    /// Books the energy of the impacts that have ended; `held_j` as above.
    pub(in crate::simulation) fn book_impacts(&mut self, held_j: &MeshEnergy) {
        self.impacts.book((self.lost_to_mesh_j().minus(held_j), self.ledger.soil_j));
    }

    /// Ends and books all impacts, where no spring holds energy.
    pub(in crate::simulation) fn end_all_impacts(&mut self) {
        if self.end_impacts(|_| false) {
            self.book_impacts(&MeshEnergy::default());
        }
    }

    /// Velocity (m/s) left to a rock of velocity `v` that keeps a fraction `speed_factor` of its
    /// speed (–); books the energy of the rest to soil.
    pub(in crate::simulation) fn slow_in_soil(&mut self, v: &Vec3, speed_factor: f64) -> Vec3 {
        self.ledger.soil_j += 0.5
            * self.geometry.rock.mass_kg()
            * v.norm_squared()
            * (1.0 - speed_factor * speed_factor);
        v * speed_factor
    }

    /// The same for its velocity at the end of a flight.
    pub(in crate::simulation) fn slow_in_soil_after_flight(&mut self, speed_factor: f64) {
        let v = self.now.velocity_m_s;
        self.now.velocity_m_s = self.slow_in_soil(&v, speed_factor);
    }

    /// Books losses in the energy balance, the energy that springs take up included.
    pub(in crate::simulation) fn book_losses(&mut self, loss: &Loss) {
        self.ledger.friction_j += loss.friction;
        self.ledger.damping_j += loss.damping;
        self.ledger.rolling_j += loss.rolling;
        self.ledger.trees_j += loss.trees;
    }

    /// Takes the elastic energy at the end of an episode, `stored`, out of the losses, and puts the
    /// energy that was `brought` into the episode back in.
    pub(in crate::simulation) fn book_spring_energy(&mut self, stored: &Loss, brought: &Loss) {
        let mut returned = *brought;
        returned.add(stored, -1.0);
        self.book_losses(&returned);
        self.ledger.springs_j -= returned.sum();
    }

    /// Books the elastic energy of contacts with other rocks at the end (J): it was booked as lost
    /// to others, but is not lost.
    pub(in crate::simulation) fn book_pair_spring_energy(&mut self, held_j: f64) {
        self.ledger.others_j -= held_j;
        self.ledger.springs_j += held_j;
    }

    /// Ends an episode in which kinetic and potential energy have grown by `rise_j` (J), with
    /// [`Self::book_spring_energy`]. Energy in springs is not lost, and energy `brought` in springs
    /// may be gained; a rise beyond that is numerical error.
    pub(in crate::simulation) fn end_episode(
        &mut self,
        rise_j: f64,
        stored: &Loss,
        brought: &Loss,
    ) {
        self.book_spring_energy(stored, brought);
        self.ledger.rise_j = self.ledger.rise_j.max(rise_j + stored.sum() - brought.sum());
    }

    /// All losses so far (J), including the energy that other rocks got or took.
    pub(in crate::simulation) fn lost_j(&self) -> f64 {
        let Ledger { friction_j, damping_j, rolling_j, trees_j, soil_j, others_j, .. } =
            self.ledger;
        friction_j + damping_j + rolling_j + trees_j + soil_j + others_j + self.ledger.passed_on_j
    }

    /// Losses in contacts with the mesh, those with trees apart.
    fn lost_to_mesh_j(&self) -> MeshEnergy {
        let ledger = &self.ledger;
        MeshEnergy {
            slope_j: ledger.friction_j + ledger.damping_j + ledger.rolling_j + ledger.soil_j,
            trees_j: ledger.trees_j,
        }
    }
}
