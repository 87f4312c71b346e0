//! A rock in contact with the mesh, alone or among others: its impacts are noted down as they begin and end, and on rough
//! ground it is turned against the facets that it meets.
//!
//! An impact here is a contact that begins with an approach above the capture speed: only those
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

/// An impact is over after so many contact times (–), whether the rock has left or not.
///
/// Without weight a contact lasts `π/ω` at most; weight prolongs it, but threefold only where the
/// rock is about to stay.
pub(super) const IMPACT_TIMES: f64 = 3.0;

/// A rock in contact and its notes.
pub(super) struct RockInContact<'r, 'a> {
    pub(super) world: ContactEnvironment<'r>,
    pub(super) state: &'r mut ContactState,
    pub(super) recorder: &'r mut Recorder<'a>,
    /// Whether contacts have springs, and impacts take time.
    pub(super) has_springs: bool,
}

impl RockInContact<'_, '_> {
    /// Notes down impacts that have just begun, and turns the rock against the facet of the fastest.
    ///
    /// Why the fastest: all contacts that begin at one instant see the same facet of rough ground. Soil and dashpots are those of
    /// every ground that is struck. Speeds are those before the blow.
    pub(super) fn announce(&mut self) {
        let Some(fastest) = self.fastest_unannounced() else { return };
        let facet = self.next_facet(&fastest);
        // whether a rock rebounds is judged by its approach to the facet
        let to_facet_m_s = facet.map_or(0.0, |(_, approach_m_s)| approach_m_s);
        if to_facet_m_s >= self.world.law(fastest.triangle).capture_m_s {
            self.state.rebound(&self.world, to_facet_m_s);
        }
        // what contacts that were announced earlier hold in their springs: the new impact must not
        // be charged with it
        let held_j = self.held_j(|history| history.announced);
        let until_s = self.recorder.now.time_s + self.impact_time();
        self.state.blows.clear();
        self.announce_all((&fastest, to_facet_m_s), (until_s, &held_j));
        // The rock is turned instead of the mesh: contact itself stays as it is. What is captured is turned too: the facet
        // takes what it takes.
        if let Some((turn, _)) = facet {
            self.state.rotate_onto_facet(&self.world, turn, until_s);
            self.recorder.now.turn(&turn.inverse());
        }
    }

    /// The facet that a rock meets which strikes the surface so, and its approach to it (m/s), if it meets a new one.
    /// One that it is turned against belongs to the place before: it is turned back first.
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

    /// The fastest of the contacts that have begun.
    fn fastest_unannounced(&self) -> Option<Blow> {
        let both = self.state.histories.iter().chain(self.state.upcoming_impacts.iter());
        let begun = both.filter(|history| !history.announced).map(|history| Blow {
            approach_m_s: -history.n.dot(&self.recorder.now.velocity_m_s),
            n: history.n,
            triangle: history.triangle,
        });
        begun.reduce(|one, other| if other.approach_m_s > one.approach_m_s { other } else { one })
    }

    /// Notes down the contacts that have begun, the `fastest` by its approach to the facet, and the blows of those that rebound.
    /// One that was captured, or is too slow, is announced but is no impact.
    fn announce_all(
        &mut self,
        (fastest, to_facet_m_s): (&Blow, f64),
        (until_s, held_j): (f64, &MeshEnergy),
    ) {
        let Self { world, state, recorder, .. } = self;
        let ContactState { c, histories, upcoming_impacts, blows, .. } = &mut **state;
        // in the rigid limit what is about to be struck stands in a list of its own
        for history in histories.iter_mut().chain(upcoming_impacts.iter_mut()) {
            if std::mem::replace(&mut history.announced, true) || history.captured {
                continue;
            }
            let own_m_s = -history.n.dot(&recorder.now.velocity_m_s);
            // the facet counts for the contact that it was drawn for
            let is_fastest = history.n == fastest.n;
            let approach_m_s = if is_fastest { own_m_s.max(to_facet_m_s) } else { own_m_s };
            let (n, triangle) = (history.n, history.triangle);
            // none is left out: as many contacts as a rock has at once
            blows.try_push(Blow { approach_m_s, n, triangle }).ok();
            // what comes too slowly is no impact
            history.impact = if approach_m_s < world.law(history.triangle).capture_m_s {
                0
            } else {
                let of = (history.feature, history.triangle);
                let struck =
                    ImpactPoint::by_ball((c, world.body.radius), &history.n, of, approach_m_s);
                recorder.begin_impact(&struck, until_s, held_j)
            };
        }
    }

    /// Breaks the stems that cannot take the current blow, and meets the next facet if it is time for it; returns the longest
    /// step (s) in which no stem takes more than it can.
    ///
    /// With springs a stem gives way in the course of steps, so the step is limited; in the rigid
    /// limit it gives way at once.
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
                let of = (touch.feature, touch.triangle);
                let at = (&state.c, world.body.radius);
                let struck = ImpactPoint::by_ball(at, &touch.normal, of, approach_m_s);
                let now_s = recorder.now.time_s;
                recorder.begin_impact(&struck, now_s, &MeshEnergy::default());
            }
            recorder.pay(loss);
        };
        state.break_stems(world, note);
        // what the stems took is booked: the step begins with what they left
        (recorder.now.velocity_m_s, recorder.now.spin_rad_s) = (state.v, state.w);
    }

    /// A rock that slides or rolls on rough ground meets the next facet once the last is behind it.
    ///
    /// Roughness is a property of the way covered, not of the number of contact events: see
    /// `solver::roughness`.
    fn meet_next_facet(&mut self) {
        if self.state.facets.is_tilted() {
            return;
        }
        let rests = |history: &&mut ContactHistory| history.closed && history.announced;
        let pressed = self.state.histories.iter_mut().filter(rests);
        let Some(history) =
            // the contact that carries the most load feels the facet
            pressed.max_by(|one, other| one.normal_force.total_cmp(&other.normal_force))
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
            self.announce();
            // its blow is announced herewith
            self.state.impact_announced |= self.state.facets.is_tilted();
        }
    }

    /// The longest an impact is taken to last (s): in the rigid limit no time at all.
    /// `3 π/ω` of the softest contact.
    fn impact_time(&self) -> f64 {
        if !self.has_springs {
            return 0.0;
        }
        let omegas =
            self.state.histories.iter().map(|history| self.world.springs_of(history).omega_rad_s());
        let slowest = omegas.fold(f64::INFINITY, f64::min);
        IMPACT_TIMES * PI / slowest
    }

    /// Ends the impacts whose patch has let go or whose time is up, and turns the rock back from a facet that is behind it.
    pub(super) fn end_impacts(&mut self) {
        // a blow of the rigid limit is announced first and falls with the next step
        if !self.has_springs && self.state.impact_announced {
            return;
        }
        // the rigid limit keeps no memory of what has hit and left again within a step
        let (histories, has_springs) = (&self.state.histories, self.has_springs);
        let lasts = |number| !has_springs || histories.iter().any(|one| one.impact == number);
        if self.recorder.end_impacts(lasts) {
            let held_j = self.held_j(|_| true);
            self.recorder.book_impacts(&held_j);
        }
        if self.state.facets.is_tilt_over(self.state.is_free(), self.recorder.now.time_s) {
            self.leave_facet();
        }
    }

    /// Energy in the springs of the contacts that `count` (J).
    fn held_j(&mut self, count: impl Fn(&ContactHistory) -> bool) -> MeshEnergy {
        if !self.has_springs {
            return MeshEnergy::default();
        }
        let Self { world, state, .. } = self;
        let is_tree = |history: &ContactHistory| world.terrain.is_tree(history.triangle);
        let trees_j = state.held_j(world, |history| count(history) && is_tree(history));
        MeshEnergy { slope_j: state.held_j(world, count) - trees_j, trees_j }
    }

    /// Turns the rock back, if it is turned.
    pub(super) fn leave_facet(&mut self) {
        if let Some(turn) = self.state.rotate_back(&self.world) {
            // a rebound into the mean surface is the next impact
            self.recorder.impacts.forget_last();
            // turned, not taken from the state: a step that is not noted yet has changed its speed
            self.recorder.now.turn(&turn);
        }
    }
}
