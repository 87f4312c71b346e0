//! Impacts of a block in a scheme with springs: noted down as they begin and end, and on rough ground turned against the facets
//! that it meets, as spheres are (`simulation::rock_in_contact`).

use super::super::impacts::MeshEnergy;
use super::super::rock_in_contact::IMPACT_TIMES;
use super::{Roll, turned};
use crate::rock::Vec3;
use crate::solver::block::BlockHistory;
use crate::solver::impact_point::ImpactPoint;
use crate::solver::law::capture_m_s;
use crate::solver::loss::Loss;
use crate::solver::roughness::SurfaceApproach;
use crate::solver::scar::GroundBlow;
use nalgebra::Rotation3;
use std::f64::consts::PI;

impl Roll<'_> {
    /// Begins an episode of contact; what its springs hold (J).
    pub(super) fn begin_contact(&mut self) -> Loss {
        if self.has_springs() {
            let on = (self.block, &self.moving);
            self.footing.begin_springs(&self.world, self.settings.step, on);
        }
        self.held()
    }

    /// What springs hold (J).
    pub(super) fn held(&mut self) -> Loss {
        if self.has_springs() {
            self.footing.springs_j(&self.world, (self.block, &self.moving))
        } else {
            self.footing.clamp.stored(&self.world)
        }
    }

    /// Ends an episode of contact.
    pub(super) fn end_contact(&mut self) {
        if self.has_springs() {
            self.recorder.end_all_impacts();
            self.rotate_back();
        }
    }

    /// Notes down the impacts that have begun, and turns the block against the facet of the fastest.
    pub(super) fn begin_impacts(&mut self) {
        self.footing.meet_next_facet(&self.world, (self.block, &self.moving));
        let springs = &self.footing.springs;
        let new = springs.histories.iter().filter(|history| !history.announced);
        let fastest = new.max_by(|one, other| one.approach_m_s.total_cmp(&other.approach_m_s));
        let Some(fastest) = fastest.copied() else { return };
        self.footing.damp_together(&self.world, (self.block, &self.moving));
        let facet = self.next_facet(fastest.triangle, &fastest.n, &fastest.point);
        let until_s = self.recorder.now.time_s + IMPACT_TIMES * PI / self.footing.springs.slowest();
        let held_j = self.held_j();
        // whether a block rebounds is judged by its approach to the facet
        let capture_m_s = self.world.law(fastest.triangle).capture_m_s;
        let to_facet_m_s = facet.map(|(_, speed)| speed).filter(|speed| *speed >= capture_m_s);
        let mut blows = std::mem::take(&mut self.footing.blows);
        blows.clear();
        let begin = self.footing.springs.histories.iter().filter(|history| !history.announced);
        for one in begin.filter(|history| to_facet_m_s.is_some() || !history.captured) {
            blows.push(self.blow_on((one.triangle, one.n), one.approach_m_s));
        }
        let histories = &self.footing.springs.histories;
        let mut begun = std::mem::take(&mut self.footing.begun);
        begun.clear();
        begun.extend((0..histories.len()).filter(|k| !histories[*k].announced));
        for k in &begun {
            self.begin_impact(*k, to_facet_m_s, (until_s, &held_j));
        }
        if to_facet_m_s.is_some() || !fastest.captured {
            let facet = facet.map(|(turn, _)| (turn, &fastest));
            self.dig_and_break(&blows, (&begun, facet), until_s);
        }
        (self.footing.blows, self.footing.begun) = (blows, begun);
        // what is captured is turned too: the facet takes what it takes
        if let Some((turn, _)) = facet {
            self.footing.rotate_onto_facet(self.block, &mut self.moving, (turn, until_s));
        }
    }

    /// The facet that the block meets which strikes a surface with normal `n` at `point`, and its approach to it (m/s), if it
    /// meets a new one. One that it is turned against belongs to the place before: it is turned back first.
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

    /// The block as it meets a surface with normal `n` at `point`.
    fn meeting(&self, triangle: u32, n: &Vec3, point: &Vec3) -> SurfaceApproach {
        let c = self.moving.pose.centre;
        SurfaceApproach { n: *n, triangle, c, v: self.moving.at(self.block, &(point - c)) }
    }

    /// Gives the contacts that have begun the dashpots of the speed that soil has left them, and of the facet that the fastest of them meets.
    fn strike_anew(&mut self, begun: &[usize], facet: Option<(Rotation3<f64>, &BlockHistory)>) {
        let to_facet_m_s = facet
            .map(|(turn, one)| self.meeting(one.triangle, &one.n, &one.point).approach_m_s(&turn));
        for k in begun {
            let one = self.footing.springs.histories[*k];
            let own_m_s = -one.n.dot(&self.meeting(one.triangle, &one.n, &one.point).v);
            let approach_m_s = to_facet_m_s.map_or(own_m_s, |facet| facet.max(own_m_s));
            if !one.captured && approach_m_s >= capture_m_s(&one.law) {
                self.footing.strike_anew(*k, (self.block, &self.moving), approach_m_s);
            }
        }
    }

    /// What impacts that rebound do to the grounds and to stems; those of contacts that have begun, and the facet that the fastest of them meets.
    fn dig_and_break(
        &mut self,
        blows: &[GroundBlow],
        (begun, facet): (&[usize], Option<(Rotation3<f64>, &BlockHistory)>),
        until_s: f64,
    ) {
        self.dig(blows);
        // where nothing has changed a contact keeps what it began with
        if facet.is_some() || self.scars.are_any() {
            self.strike_anew(begun, facet);
        }
        if self.break_stems() {
            self.footing.springs.refresh();
        }
        self.footing.springs.until_s = until_s;
    }

    /// Notes down that contact `k` has begun, if it has not been; on rough ground all rebound with the fastest.
    fn begin_impact(
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

    /// Ends the impacts that are over, and turns the block back from a facet that is behind it.
    pub(super) fn leave_impacts(&mut self) {
        if !self.has_springs() {
            return;
        }
        let springs = &self.footing.springs;
        let lasts = |number| springs.histories.iter().any(|history| history.impact == number);
        if self.recorder.end_impacts(lasts) {
            let held_j = self.held_j();
            self.recorder.book_impacts(&held_j);
        }
        let now_s = self.recorder.now.time_s;
        if self.footing.facets.is_tilt_over(self.footing.springs.is_free(), now_s) {
            self.rotate_back();
        }
        self.footing.springs.capture(now_s);
    }

    /// What springs hold.
    fn held_j(&self) -> MeshEnergy {
        let (springs, terrain) = (&self.footing.springs, self.world.terrain);
        let trees_j = springs.held_on_j(|triangle| terrain.is_tree(triangle));
        MeshEnergy { slope_j: springs.held_j() - trees_j, trees_j }
    }

    /// Turns the block back, if it is turned.
    fn rotate_back(&mut self) {
        if self.footing.rotate_back(self.block, &mut self.moving) {
            // a rebound into the mean surface is the next impact
            self.recorder.impacts.forget_last();
            self.recorder.now.velocity_m_s = self.moving.v;
            self.recorder.now.spin_rad_s = self.moving.spin(self.block);
            self.recorder.turned = Some(turned(self.block, &self.moving));
        }
    }
}
