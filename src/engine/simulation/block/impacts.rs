//! Impacts of a block in a scheme with springs: noted down as they begin and end, and on rough ground turned against the facets
//! that it meets, as spheres are (`simulation::rock_in_contact`).

use super::super::impacts::MeshEnergy;
use super::super::rock_in_contact::IMPACT_TIMES;
use super::{Roll, turned};
use crate::rock::Vec3;
use crate::solver::loss::Loss;
use crate::solver::roughness::Meeting;
use crate::solver::scar::GroundBlow;
use crate::solver::struck::Struck;
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
            self.turn_back();
        }
    }

    /// Notes down the impacts that have begun, and turns the block against the facet of the fastest.
    pub(super) fn begin_impacts(&mut self) {
        self.footing.meet_next_facet(&self.world, (self.block, &self.moving));
        let springs = &self.footing.springs;
        let new = springs.histories.iter().filter(|history| !history.announced);
        let fastest = new.max_by(|one, other| one.approach_m_s.total_cmp(&other.approach_m_s));
        let Some(fastest) = fastest.copied() else { return };
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
        for k in 0..self.footing.springs.histories.len() {
            self.begin_impact(k, to_facet_m_s, (until_s, &held_j));
        }
        if to_facet_m_s.is_some() || !fastest.captured {
            self.dig_and_break(&blows, until_s);
        }
        self.footing.blows = blows;
        // what is captured is turned too: the facet takes what it takes
        if let Some((turn, _)) = facet {
            self.footing.turn_against(self.block, &mut self.moving, (turn, until_s));
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
        let at = |roll: &Self| {
            let c = roll.moving.pose.centre;
            Meeting { n: *n, triangle, c, v: roll.moving.at(roll.block, &(point - c)) }
        };
        if !self.footing.facets.meet_next(&self.world, &at(self)) {
            return None;
        }
        self.turn_back();
        let at = at(self);
        let turn = self.footing.facets.struck(&self.world, &at)?;
        Some((turn, at.approach_m_s(&turn)))
    }

    /// What impacts that rebound do to the grounds and to stems.
    fn dig_and_break(&mut self, blows: &[GroundBlow], until_s: f64) {
        self.dig(blows);
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
            let struck = Struck {
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
        if self.footing.facets.is_met(self.footing.springs.is_free(), now_s) {
            self.turn_back();
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
    fn turn_back(&mut self) {
        if self.footing.turn_back(self.block, &mut self.moving) {
            // a rebound into the mean surface is the next impact
            self.recorder.impacts.forget_last();
            self.recorder.now.velocity_m_s = self.moving.v;
            self.recorder.now.spin_rad_s = self.moving.spin(self.block);
            self.recorder.turned = Some(turned(self.block, &self.moving));
        }
    }
}
