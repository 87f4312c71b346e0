//! Impacts of a block in a scheme with springs: recorded as they begin and end. On rough ground the
//! block is rotated relative to the facet that it meets, as spheres are
//! (`simulation::rock_in_contact`).

use super::super::impacts::MeshEnergy;
use super::super::rock_in_contact::IMPACT_TIMES;
use super::{BlockSimulation, rotation};
use crate::rock::Vec3;
use crate::solver::block::BlockHistory;
use crate::solver::impact_point::ImpactPoint;
use crate::solver::law::capture_m_s;
use crate::solver::roughness::SurfaceApproach;
use crate::solver::scar::GroundBlow;
use nalgebra::Rotation3;
use std::f64::consts::PI;

impl BlockSimulation<'_> {
    /// Ends a contact episode.
    pub(super) fn end_springs(&mut self) {
        if self.has_springs() {
            self.recorder.end_all_impacts();
            self.rotate_back();
        }
    }

    /// Records the impacts that have begun, and rotates the block relative to the facet of the
    /// fastest.
    pub(super) fn begin_impacts(&mut self) {
        self.footing.meet_next_facet(&self.world, (self.block, &self.moving));
        let springs = &self.footing.springs;
        let new = springs.histories.iter().filter(|history| !history.announced);
        let fastest = new.max_by(|a, b| a.approach_m_s.total_cmp(&b.approach_m_s));
        let Some(fastest) = fastest.copied() else { return };
        self.footing.damp_together(&self.world, (self.block, &self.moving));
        let facet = self.next_facet(fastest.triangle, &fastest.n, &fastest.point);
        let until_s = self.recorder.now.time_s + IMPACT_TIMES * PI / self.footing.springs.slowest();
        let held_j = self.spring_energy_j();
        // whether a block rebounds depends on its approach speed towards the facet
        let capture_m_s = self.world.law(fastest.triangle).capture_m_s;
        let to_facet_m_s = facet.map(|(_, speed)| speed).filter(|speed| *speed >= capture_m_s);
        let mut blows = std::mem::take(&mut self.footing.blows);
        blows.clear();
        let begin = self.footing.springs.histories.iter().filter(|history| !history.announced);
        for history in begin.filter(|history| to_facet_m_s.is_some() || !history.captured) {
            blows.push(self.ground_blow((history.triangle, history.n), history.approach_m_s));
        }
        let histories = &self.footing.springs.histories;
        let mut begun = std::mem::take(&mut self.footing.begun);
        begun.clear();
        begun.extend((0..histories.len()).filter(|k| !histories[*k].announced));
        for k in &begun {
            self.record_impact(*k, to_facet_m_s, (until_s, &held_j));
        }
        if to_facet_m_s.is_some() || !fastest.captured {
            let facet = facet.map(|(turn, _)| (turn, &fastest));
            self.apply_to_soil_and_stems(&blows, (&begun, facet), until_s);
        }
        (self.footing.blows, self.footing.begun) = (blows, begun);
        // a captured block is rotated too: the facet takes its share of the energy
        if let Some((turn, _)) = facet {
            self.footing.rotate_onto_facet(self.block, &mut self.moving, (turn, until_s));
        }
    }

    /// The facet that the block meets where it hits a surface with normal `n` at `point`, and the
    /// approach speed towards it (m/s), if this is a new facet. A facet relative to which the block
    /// is rotated belongs to the place before: that rotation is undone first.
    fn next_facet(
        &mut self,
        triangle: u32,
        n: &Vec3,
        point: &Vec3,
    ) -> Option<(Rotation3<f64>, f64)> {
        if !self.footing.facets.meets_new_facet(&self.world, &self.meeting(triangle, n, point)) {
            return None;
        }
        self.rotate_back();
        let at = self.meeting(triangle, n, point);
        let turn = self.footing.facets.draw_facet(&self.world, &at)?;
        Some((turn, at.approach_m_s(&turn)))
    }

    /// State of the block at a contact with normal `n` at `point`.
    fn meeting(&self, triangle: u32, n: &Vec3, point: &Vec3) -> SurfaceApproach {
        let c = self.moving.pose.centre;
        SurfaceApproach { n: *n, triangle, c, v: self.moving.velocity_at(self.block, &(point - c)) }
    }

    /// Recomputes the dashpots of the contacts that have begun, from the speed that soil has left
    /// them and from the facet that the fastest of them meets.
    fn reset_dashpots(&mut self, begun: &[usize], facet: Option<(Rotation3<f64>, &BlockHistory)>) {
        let to_facet_m_s = facet.map(|(turn, history)| {
            self.meeting(history.triangle, &history.n, &history.point).approach_m_s(&turn)
        });
        for k in begun {
            let history = self.footing.springs.histories[*k];
            let own_m_s =
                -history.n.dot(&self.meeting(history.triangle, &history.n, &history.point).v);
            let approach_m_s = to_facet_m_s.map_or(own_m_s, |facet| facet.max(own_m_s));
            if !history.captured && approach_m_s >= capture_m_s(&history.law) {
                self.footing.strike_anew(*k, (self.block, &self.moving), approach_m_s);
            }
        }
    }

    /// Effects of rebounding impacts on soil and stems; `begun` are the contacts that have begun,
    /// `facet` the facet that the fastest of them meets.
    fn apply_to_soil_and_stems(
        &mut self,
        blows: &[GroundBlow],
        (begun, facet): (&[usize], Option<(Rotation3<f64>, &BlockHistory)>),
        until_s: f64,
    ) {
        self.enter_soil(blows);
        // if nothing has changed, a contact keeps its initial damping
        if facet.is_some() || self.scars.are_any() {
            self.reset_dashpots(begun, facet);
        }
        if self.break_stems() {
            self.footing.springs.invalidate_rates();
        }
        self.footing.springs.until_s = until_s;
    }

    /// Records the beginning of contact `k`, if it has not been recorded yet. On rough ground all
    /// contacts rebound with the fastest.
    fn record_impact(
        &mut self,
        k: usize,
        to_facet_m_s: Option<f64>,
        (until_s, held_j): (f64, &MeshEnergy),
    ) {
        let mut history = self.footing.springs.histories[k];
        if std::mem::replace(&mut history.announced, true) {
            return;
        }
        if let Some(speed) = to_facet_m_s {
            history.rebound(speed);
        }
        if !history.captured {
            let struck = ImpactPoint {
                point_m: history.point,
                normal: history.n,
                feature: history.feature.kind,
                triangle: history.triangle,
                approach_m_s: history.approach_m_s.max(0.0),
            };
            history.impact = self.recorder.begin_impact(&struck, until_s, held_j);
        }
        self.footing.springs.histories[k] = history;
    }

    /// Ends the impacts that are over, and undoes the rotation of a facet that the block has left
    /// behind.
    pub(super) fn end_impacts(&mut self) {
        if !self.has_springs() {
            return;
        }
        let springs = &self.footing.springs;
        let lasts = |number| springs.histories.iter().any(|history| history.impact == number);
        if self.recorder.end_impacts(lasts) {
            let held_j = self.spring_energy_j();
            self.recorder.book_impacts(&held_j);
        }
        let now_s = self.recorder.now.time_s;
        if self.footing.facets.is_tilt_over(self.footing.springs.is_free(), now_s) {
            self.rotate_back();
        }
        self.footing.springs.capture(now_s);
    }

    /// Elastic energy of the contacts.
    fn spring_energy_j(&self) -> MeshEnergy {
        let (springs, terrain) = (&self.footing.springs, self.world.terrain);
        let trees_j = springs.held_on_j(|triangle| terrain.is_tree(triangle));
        MeshEnergy { slope_j: springs.held_j() - trees_j, trees_j }
    }

    /// Undoes the rotation of a facet, if there is one.
    fn rotate_back(&mut self) {
        if self.footing.rotate_back(self.block, &mut self.moving) {
            // a contact with the mean surface after the rebound is the next impact
            self.recorder.impacts.forget_ended();
            self.recorder.now.velocity_m_s = self.moving.v;
            self.recorder.now.spin_rad_s = self.moving.spin(self.block);
            self.recorder.rotation = Some(rotation(self.block, &self.moving));
        }
    }
}
