//! A rock in contact with the mesh, alone or among others. Its impacts are recorded as they begin
//! and end; on rough ground it is rotated relative to the facets that it meets.
//!
//! An impact here is a contact that begins with an approach above the capture speed. Only these
//! rebound, are counted and get a row.

use super::impacts::MeshEnergy;
use super::recorder::Recorder;
use crate::contact::ContactPoint;
use crate::contact::history::ContactHistory;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::impact_point::{Blow, ImpactPoint};
use crate::solver::loss::Loss;
use crate::solver::roughness::SurfaceApproach;
use nalgebra::Rotation3;
use std::f64::consts::PI;

/// An impact is over after this many contact times (–), whether the rock has separated or not.
///
/// Without gravity a contact lasts `π/ω` at most. Gravity prolongs it, but threefold only where the
/// rock is about to stay.
pub(super) const IMPACT_TIMES: f64 = 3.0;

/// A rock in contact and its recorder.
pub(super) struct RockInContact<'r, 'a> {
    pub(super) world: ContactEnvironment<'r>,
    pub(super) state: &'r mut ContactState,
    pub(super) recorder: &'r mut Recorder<'a>,
    /// Whether contacts have springs, so that impacts take time.
    pub(super) has_springs: bool,
}

impl RockInContact<'_, '_> {
    /// Records impacts that have just begun, and rotates the rock relative to the facet of the
    /// fastest.
    ///
    /// Why the fastest: all contacts that begin at one instant see the same facet of rough ground.
    /// Soil and dashpots are those of every ground that is hit. Speeds are those before the impact.
    pub(super) fn begin_impacts(&mut self) {
        let Some(fastest) = self.fastest_new_contact() else { return };
        let facet = self.next_facet(&fastest);
        // whether a rock rebounds depends on its approach speed towards the facet
        let to_facet_m_s = facet.map_or(0.0, |(_, approach_m_s)| approach_m_s);
        if to_facet_m_s >= self.world.law(fastest.triangle).capture_m_s {
            self.state.rebound(&self.world, to_facet_m_s);
        }
        // elastic energy of contacts recorded earlier: it must not be charged to the new impact
        let held_j = self.spring_energy_j(|history| history.announced);
        let until_s = self.recorder.now.time_s + self.longest_impact_s();
        self.state.blows.clear();
        self.record_new_contacts((&fastest, to_facet_m_s), (until_s, &held_j));
        // The rock is rotated instead of the mesh, so that contact detection stays as it is. A
        // captured rock is rotated too: the facet takes its share of the energy.
        if let Some((turn, _)) = facet {
            self.state.rotate_onto_facet(&self.world, turn, until_s);
            self.recorder.now.turn(&turn.inverse());
        }
    }

    /// The facet that the rock meets in this impact, and the approach speed towards it (m/s), if
    /// this is a new facet. A facet relative to which the rock is rotated belongs to the place
    /// before: that rotation is undone first.
    fn next_facet(&mut self, blow: &Blow) -> Option<(Rotation3<f64>, f64)> {
        let Blow { n, triangle, .. } = *blow;
        let at = |state: &ContactState| SurfaceApproach { n, triangle, c: state.c, v: state.v };
        if !self.state.facets.meets_new_facet(&self.world, &at(self.state)) {
            return None;
        }
        self.leave_facet();
        let at = at(self.state);
        let turn = self.state.facets.draw_facet(&self.world, &at)?;
        Some((turn, at.approach_m_s(&turn)))
    }

    /// The fastest of the contacts that have begun and are not recorded yet.
    fn fastest_new_contact(&self) -> Option<Blow> {
        let both = self.state.histories.iter().chain(self.state.upcoming_impacts.iter());
        let begun = both.filter(|history| !history.announced).map(|history| Blow {
            approach_m_s: -history.n.dot(&self.recorder.now.velocity_m_s),
            n: history.n,
            triangle: history.triangle,
        });
        begun.reduce(|a, b| if b.approach_m_s > a.approach_m_s { b } else { a })
    }

    /// Records the contacts that have begun and the impacts of those that rebound; the approach
    /// speed of the `fastest` is that towards the facet. A captured contact, or one that is too
    /// slow, is recorded but is no impact.
    fn record_new_contacts(
        &mut self,
        (fastest, to_facet_m_s): (&Blow, f64),
        (until_s, held_j): (f64, &MeshEnergy),
    ) {
        let Self { world, state, recorder, .. } = self;
        let ContactState { c, histories, upcoming_impacts, blows, .. } = &mut **state;
        // in the rigid limit contacts of an impact that is still to be solved have a list of their
        // own
        for history in histories.iter_mut().chain(upcoming_impacts.iter_mut()) {
            if std::mem::replace(&mut history.announced, true) || history.captured {
                continue;
            }
            let own_m_s = -history.n.dot(&recorder.now.velocity_m_s);
            // the facet counts only for the contact for which it was drawn
            let is_fastest = history.n == fastest.n;
            let approach_m_s = if is_fastest { own_m_s.max(to_facet_m_s) } else { own_m_s };
            let (n, triangle) = (history.n, history.triangle);
            // none is left out: the capacity is the largest number of contacts of a rock
            blows.try_push(Blow { approach_m_s, n, triangle }).ok();
            // below the capture speed it is no impact
            history.impact = if approach_m_s < world.law(history.triangle).capture_m_s {
                0
            } else {
                let place = (history.feature, history.triangle);
                let struck =
                    ImpactPoint::by_ball((c, world.body.radius), &history.n, place, approach_m_s);
                recorder.begin_impact(&struck, until_s, held_j)
            };
        }
    }

    /// Breaks the stems that the current impact overloads, and meets the next facet when it is due.
    /// Returns the longest step (s) within which no stem is loaded beyond its strength.
    ///
    /// With springs a stem yields in the course of steps, so the step is limited; in the rigid
    /// limit it yields at once.
    pub(super) fn before_step(&mut self) -> f64 {
        let longest_s = if self.has_springs {
            self.state.longest_before_yield_s(&self.world)
        } else {
            self.break_stems();
            f64::INFINITY
        };
        if self.state.facets.are_rough() {
            self.meet_next_facet();
        }
        longest_s
    }

    fn break_stems(&mut self) {
        let Self { world, state, recorder, .. } = self;
        let world = &*world;
        let note = |state: &ContactState, touch: &ContactPoint, (loss, is_new): (&Loss, bool)| {
            let approach_m_s = -touch.normal.dot(&state.v);
            if is_new && approach_m_s >= world.law(touch.triangle).capture_m_s {
                let place = (touch.feature, touch.triangle);
                let at = (&state.c, world.body.radius);
                let struck = ImpactPoint::by_ball(at, &touch.normal, place, approach_m_s);
                let now_s = recorder.now.time_s;
                recorder.begin_impact(&struck, now_s, &MeshEnergy::default());
            }
            recorder.book_losses(loss);
        };
        state.break_stems(world, note);
        // the energy that the stems took is booked: the step begins with what is left
        (recorder.now.velocity_m_s, recorder.now.spin_rad_s) = (state.v, state.w);
    }

    /// A rock that slides or rolls on rough ground meets the next facet when it has left the last
    /// behind.
    ///
    /// Roughness is a property of the distance covered, not of the number of contact events: see
    /// `solver::roughness`.
    fn meet_next_facet(&mut self) {
        if self.state.facets.is_tilted() {
            return;
        }
        let is_persistent = |history: &&mut ContactHistory| history.closed && history.announced;
        let pressed = self.state.histories.iter_mut().filter(is_persistent);
        let Some(history) =
            // the contact with the largest normal force feels the facet
            pressed.max_by(|a, b| a.normal_force.total_cmp(&b.normal_force))
        else {
            return;
        };
        let at = SurfaceApproach {
            n: history.n,
            triangle: history.triangle,
            c: self.state.c,
            v: self.state.v,
        };
        if self.state.facets.meets_new_facet(&self.world, &at) {
            history.announced = false;
            self.begin_impacts();
            // its impact is recorded herewith
            self.state.impact_announced |= self.state.facets.is_tilted();
        }
    }

    /// Longest duration of an impact (s): `3 π/ω` of the softest contact; in the rigid limit 0.
    fn longest_impact_s(&self) -> f64 {
        if !self.has_springs {
            return 0.0;
        }
        let omegas =
            self.state.histories.iter().map(|history| self.world.springs_of(history).omega_rad_s());
        let slowest = omegas.fold(f64::INFINITY, f64::min);
        IMPACT_TIMES * PI / slowest
    }

    /// Ends the impacts whose contact has opened or whose longest duration is over, and undoes the
    /// rotation of a facet that the rock has left behind.
    pub(super) fn end_impacts(&mut self) {
        // an impact of the rigid limit is recorded first and solved in the next step
        if !self.has_springs && self.state.impact_announced {
            return;
        }
        // the rigid limit has no history of a contact that has closed and opened within a step
        let (histories, has_springs) = (&self.state.histories, self.has_springs);
        let lasts =
            |number| !has_springs || histories.iter().any(|history| history.impact == number);
        if self.recorder.end_impacts(lasts) {
            let held_j = self.spring_energy_j(|_| true);
            self.recorder.book_impacts(&held_j);
        }
        if self.state.facets.is_tilt_over(self.state.is_free(), self.recorder.now.time_s) {
            self.leave_facet();
        }
    }

    /// Elastic energy of the contacts selected by `counts` (J).
    fn spring_energy_j(&mut self, counts: impl Fn(&ContactHistory) -> bool) -> MeshEnergy {
        if !self.has_springs {
            return MeshEnergy::default();
        }
        let Self { world, state, .. } = self;
        let is_tree = |history: &ContactHistory| world.terrain.is_tree(history.triangle);
        let trees_j = state.held_j(world, |history| counts(history) && is_tree(history));
        MeshEnergy { slope_j: state.held_j(world, counts) - trees_j, trees_j }
    }

    /// Undoes the rotation of a facet, if there is one.
    pub(super) fn leave_facet(&mut self) {
        if let Some(turn) = self.state.rotate_back(&self.world) {
            // a contact with the mean surface after the rebound is the next impact
            self.recorder.impacts.forget_ended();
            // rotated, not copied from the state: a step that is not recorded yet has changed its
            // speed
            self.recorder.now.turn(&turn);
        }
    }
}
