//! One rock of a world: flying, touching, resting, and what is noted down of it.
//!
//! A rock of a world has two clocks: its recorder stands at `now`, the last instant that was written down, and its
//! solver state at the end of the last step. In flight only the recorder counts, because the parabola gives every
//! later instant in closed form; at a touch the state takes over from it (`land`, `begin`).

use super::{BodyState, WorldBody};
use crate::flight::{FlightEnd, Parabola, time_of_impact_past};
use crate::release::Release;
use crate::rock::{Motion, Vec3};
use crate::simulation::impacts::MeshEnergy;
use crate::simulation::rest::RestCriterion;
use crate::simulation::rock_in_contact::RockInContact;
use crate::simulation::settings::RunSettings;
use crate::simulation::{PathState, Stop, Trajectory};
use crate::solver::island::{BlowInStep, MeshImpact};
use crate::solver::loss::{EnergyGiven, Loss};
use crate::solver::step_control::ONSET;

impl<'a> WorldBody<'a> {
    /// The parabola of its centre from the recorded instant on: `c + v t − g t²/2 z`, the spin constant.
    pub(super) fn flight(&self, settings: &RunSettings) -> Parabola {
        Parabola::of(&self.recorder.now, settings.gravity_m_s2, self.member.body.radius)
    }

    /// Centre at a time not before its own (m).
    pub(super) fn position_at(&self, settings: &RunSettings, time_s: f64) -> Vec3 {
        // a rock in contact is moved by the steps of its island only
        if self.member.flying && time_s > self.recorder.now.time_s {
            self.flight(settings).centre(time_s - self.recorder.now.time_s)
        } else {
            self.recorder.now.position_m
        }
    }

    /// Velocity at a time not before its own (m/s).
    pub(super) fn velocity_at(&self, settings: &RunSettings, time_s: f64) -> Vec3 {
        // `c + v t − g t²/2 z` differentiated
        if self.member.flying && time_s > self.recorder.now.time_s {
            self.flight(settings).velocity(time_s - self.recorder.now.time_s)
        } else {
            self.recorder.now.velocity_m_s
        }
    }

    /// Begins to watch how far its velocity changes; returns what was watched before.
    /// The reference is the velocity along the parabola at `now_s`.
    pub(super) fn watch_from(&mut self, settings: &RunSettings, now_s: f64) -> (Vec3, f64) {
        let velocity = self.velocity_at(settings, now_s);
        std::mem::replace(&mut self.off, (velocity, 0.0))
    }

    /// Goes on with what was watched before.
    pub(super) fn watch_on(&mut self, (velocity, off): (Vec3, f64)) {
        // triangle inequality: what it may be off the older reference is at most the sum of both distances
        let since = (self.off.0 - velocity).norm() + self.off.1;
        self.off = (velocity, off.max(since));
    }

    /// Brings a rock that slept to the present; one that flies without knowing where looks ahead.
    pub(super) fn wake(&mut self, settings: &RunSettings, now_s: f64) {
        if self.state == BodyState::Asleep {
            self.state = BodyState::Moving;
            self.recorder.stay(now_s);
        }
        if self.member.flying && self.lands.is_none() {
            self.find_contact_points_ahead(settings);
        }
    }

    /// Finds the end of the flight that begins now.
    /// Kept until it comes: windows only compare times with it.
    pub(super) fn find_contact_points_ahead(&mut self, settings: &RunSettings) {
        let now_s = self.recorder.now.time_s;
        let left = settings.longest_s - now_s;
        let flight = self.flight(settings);
        let effort = &mut self.recorder.effort;
        // one search along the whole parabola up to the time limit, O(log n) in the triangles near its path
        effort.leaps += 1;
        self.lands = Some(
            match time_of_impact_past(
                settings.terrain,
                &flight,
                left,
                &self.member.state.near.gone,
                &mut effort.triangles,
            ) {
                FlightEnd::Touch(t) => (now_s + t, None),
                FlightEnd::Leaves(t) => (now_s + t, Some(Stop::LeftTerrain)),
                FlightEnd::Flies => (f64::INFINITY, None),
            },
        );
        self.spend(settings);
    }

    /// Takes it out of the world when it has had all the work it may have: others may have less to do.
    pub(super) fn spend(&mut self, settings: &RunSettings) {
        if let Some(stop) = settings.over_budget(&self.recorder.effort) {
            self.lands = None;
            self.leave(stop);
        }
    }

    /// Goes along the parabola; nothing for a rock in contact.
    pub(super) fn fly_to(&mut self, settings: &RunSettings, time_s: f64) {
        if matches!(self.state, BodyState::Gone(_)) || !self.member.flying {
            return;
        }
        let dt = time_s - self.recorder.now.time_s;
        // rocks of one island meet at common times: those already there have nothing to record
        if dt > 0.0 {
            let flight = self.flight(settings);
            self.recorder.fly(&flight, None, dt);
            // the event's own time, not the sum of durations: rounding must not separate rocks that meet
            self.recorder.now.time_s = time_s;
        }
        let now = self.recorder.now;
        let state = &mut self.member.state;
        (state.c, state.v, state.w) = (now.position_m, now.velocity_m_s, now.spin_rad_s);
    }

    /// Begins an episode of contact.
    pub(super) fn begin(&mut self, settings: &RunSettings) {
        if self.member.flying {
            self.member.flying = false;
            self.lands = None;
            self.calm = RestCriterion::from(self.recorder.now.position_m);
            self.member.state.histories.clear();
            self.member.state.stored = 0.0;
            // energy at the start of the episode, against which its largest rise is measured at the end
            self.began_j = (self.total_j(settings), self.given_j());
        }
    }

    /// What others and the contacts with them have had so far (J).
    ///
    /// `others_j` is lost in contacts with them, `passed_on_j` is theirs now: together what this
    /// rock no longer has.
    fn given_j(&self) -> f64 {
        self.recorder.ledger.others_j + self.recorder.ledger.passed_on_j
    }

    /// Touches the mesh.
    /// Contact begins with springs at rest, unless the rock is pressed in already.
    pub(super) fn land(&mut self, settings: &RunSettings) {
        self.begin(settings);
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.recorder.now;
        let (world, state) = self.member.with_environment(settings.terrain);
        // looks for the contacts of this place; what was remembered of the episode before is gone
        state.begin(&world, c, v, w);
        // A rock that is pressed in from the start has the energy of its springs, too.
        if settings.step.scheme.has_springs() {
            let held = state.stored_j(&world);
            self.recorder.hold(&Loss::default(), &held);
            self.began_j.0 += held.sum();
        }
        // an impact must be resolved from its start; what is too slow to rebound, the error control alone finds out
        if state.histories.iter().any(|history| !history.captured) {
            self.h = self.h.min(ONSET / self.member.omega(settings.terrain));
        }
        self.in_contact(settings).announce();
    }

    /// Mechanical energy (J): `m v²/2 + I ω²/2 + m g z`. Springs are not in it; [`Self::end_episode`] adds what they
    /// hold.
    pub(super) fn total_j(&self, settings: &RunSettings) -> f64 {
        let now = &self.recorder.now;
        let body = &self.member.body;
        body.motion_j((&now.velocity_m_s, &now.spin_rad_s))
            + body.mass * settings.gravity_m_s2 * now.position_m.z
    }

    /// Notes one step of its island.
    pub(super) fn step(
        &mut self,
        settings: &RunSettings,
        time_s: f64,
        (mut loss, given): (Loss, EnergyGiven),
        slides: bool,
    ) {
        if matches!(self.state, BodyState::Gone(_)) {
            return;
        }
        let was_flying = self.lands.is_some();
        let mut rock = self.in_contact(settings);
        rock.announce();
        // what others give it comes from where they are: it meets no facet meanwhile
        if given != EnergyGiven::default() {
            rock.leave_facet();
        }
        // stems that the step has overloaded take their share of the energy now
        rock.state.load_stems(&rock.world, true, &mut loss);
        let to = self.motion_at(time_s);
        // A rock may be hit and let go within one step: then it flies another way.
        // neither the mesh nor another rock took or gave anything in this step
        let is_untouched = given == EnergyGiven::default() && loss == Loss::default();
        if was_flying && self.member.flying && is_untouched {
            self.recorder.step_as(to, PathState::Flight, true);
            return;
        }
        self.touch(settings, to, (loss, given), (slides, was_flying));
        if self.member.flying {
            self.find_contact_points_ahead(settings);
        }
    }

    /// Notes one step of its island in the rigid limit: rocks that fly touch and fly on within a step, too.
    ///
    /// Unlike with springs there is no memory that tells of an impact: `pass` was told of each
    /// before.
    pub(super) fn stride(
        &mut self,
        settings: &RunSettings,
        time_s: f64,
        (mut loss, given): (Loss, EnergyGiven),
        slides: bool,
    ) {
        if matches!(self.state, BodyState::Gone(_)) {
            return;
        }
        let rock = self.in_contact(settings);
        rock.state.load_stems(&rock.world, false, &mut loss);
        let to = self.motion_at(time_s);
        // its impacts are listed with its blows
        self.member.state.histories.iter_mut().for_each(|history| history.announced = true);
        if self.member.flew && self.member.flying && !self.member.was_touched {
            self.recorder.step_as(to, PathState::Flight, true);
            return;
        }
        let flew = self.member.flew;
        self.touch(settings, to, (loss, given), (slides, flew));
        self.recorder.book_impacts(&MeshEnergy::default());
        if self.member.flying {
            self.lands = None;
        }
    }

    /// Goes through a blow, and the impacts on the mesh that are its own, in the step that ends at `time_s` (s): up to it as the rock went,
    /// sliding or not, and between blows in flight. What the impacts took is known at the end of the step.
    pub(super) fn pass(
        &mut self,
        settings: &RunSettings,
        (blow, hits): (&BlowInStep, &[MeshImpact]),
        (time_s, slides): (f64, bool),
    ) {
        if matches!(self.state, BodyState::Gone(_)) {
            return;
        }
        let flies = self.member.flew || self.step_began.is_some();
        let now_s = self.recorder.now.time_s;
        self.step_began = self.step_began.or(Some((now_s, self.total_j(settings))));
        // a time that rounding has put before the step began
        let fell_s = |motion: Motion| (time_s + motion.time_s).max(now_s);
        let [before, after] = blow.motions.map(|at| Motion { time_s: fell_s(at), ..at });
        let state = if flies { PathState::Flight } else { PathState::in_contact(slides) };
        self.recorder.step_as(before, state, flies || self.member.state.is_free());
        for hit in hits {
            self.recorder.begin_impact(&hit.struck, before.time_s, &MeshEnergy::default());
        }
        self.recorder.go_on_with(after);
        let _ = self.recorder.end_impacts(|_| false);
    }

    /// Watches how far its velocity has changed since the reference: a rock that is hit and hit back has deviated all the same.
    pub(super) fn watch(&mut self) {
        self.off.1 = self.off.1.max((self.member.state.v - self.off.0).norm());
    }

    /// What the solver has made of it (the largest change of its velocity is kept).
    fn motion_at(&mut self, time_s: f64) -> Motion {
        self.watch();
        let state = &self.member.state;
        Motion { time_s, position_m: state.c, velocity_m_s: state.v, spin_rad_s: state.w }
    }

    /// Notes one step with contact.
    fn touch(
        &mut self,
        settings: &RunSettings,
        to: Motion,
        (loss, given): (Loss, EnergyGiven),
        (slides, was_flying): (bool, bool),
    ) {
        let from = self.recorder.now;
        let began = self.step_began.take();
        let (began_s, before_j) = began.unwrap_or_else(|| (from.time_s, self.total_j(settings)));
        let dt = to.time_s - began_s;
        // one slipping contact, with mesh or rock, makes the step "sliding"
        let slides = slides || self.member.state.histories.iter().any(|history| history.slides);
        // others alone hold it
        let is_off_ground = self.member.state.is_free();
        self.recorder.step_as(to, PathState::in_contact(slides), is_off_ground);
        self.recorder.pay(&loss);
        self.give(&given);
        // energy balance of the step: what motion, friction, dashpots and other rocks do not account for is numerical
        let change = self.total_j(settings) - before_j + loss.sum() + given.sum();
        self.recorder.ledger.remainder_j -= change;
        self.in_contact(settings).end_impacts();
        self.watch();
        // hit out of flight: a new episode of contact begins with the energy before the step
        if was_flying {
            self.lands = None;
            self.calm = RestCriterion::from(self.recorder.now.position_m);
            self.began_j = (before_j, self.given_j() - given.sum());
        }
        if self.member.flying {
            self.end_episode(settings);
        }
        self.calm.note(dt, [&from, &to], self.member.body.radius, &settings.rest);
    }

    /// Writes down what other rocks, and contacts with them, have got (J).
    pub(super) fn give(&mut self, given: &EnergyGiven) {
        self.recorder.ledger.others_j += given.lost;
        self.recorder.ledger.passed_on_j += given.passed_on;
    }

    /// Largest rise of energy over the contact episode that ends now.
    pub(super) fn end_episode(&mut self, settings: &RunSettings) {
        let given_j = self.given_j() - self.began_j.1;
        let (world, state) = self.member.with_environment(settings.terrain);
        // The rigid limit has no springs, whatever the depth that rounding leaves.
        let is_rigid = !settings.step.scheme.has_springs();
        let stored = if is_rigid { Loss::default() } else { state.springs_j(&world) };
        self.recorder.hold(&stored, &Loss::default());
        self.recorder.end_all_impacts();
        self.in_contact(settings).leave_facet();
        let rise_j = self.total_j(settings) - self.began_j.0 + given_j + stored.sum();
        // without numerical error it is 0 or less: contacts only take energy
        self.recorder.ledger.rise_j = self.recorder.ledger.rise_j.max(rise_j);
    }

    /// Makes ready for a step in contact; returns the longest that it may be (s).
    /// Stems and facets, as for a rock alone.
    pub(super) fn before_step(&mut self, settings: &RunSettings) -> f64 {
        if self.member.flying {
            return f64::INFINITY;
        }
        self.in_contact(settings).before_step()
    }

    /// The rock in contact and its notes.
    pub(super) fn in_contact<'r>(
        &'r mut self,
        settings: &RunSettings<'r>,
    ) -> RockInContact<'r, 'a> {
        let (world, state) = self.member.with_environment(settings.terrain);
        let has_springs = settings.step.scheme.has_springs();
        RockInContact { world, state, recorder: &mut self.recorder, has_springs }
    }

    /// Takes it out of the world; one that has already stopped keeps its reason.
    /// From then on it is in no island, and others pass where it was.
    pub(super) fn leave(&mut self, stop: Stop) {
        if self.state == BodyState::Moving {
            self.state = BodyState::Gone(stop);
        }
    }

    /// The journey, complete.
    pub(super) fn end(
        mut self,
        settings: &RunSettings,
        index: usize,
        release: &Release,
        now_s: f64,
    ) -> Trajectory {
        // what still moves when the world ends has run out of time
        let stop = match &self.state {
            BodyState::Moving => Stop::TimeUp,
            BodyState::Asleep => Stop::AtRest,
            BodyState::Gone(stop) => stop.clone(),
        };
        if stop == Stop::TimeUp {
            self.fly_to(settings, now_s);
        }
        if !self.member.flying {
            self.end_episode(settings);
        }
        self.recorder.effort.triangles += self.member.state.near.tested;
        let weight_n = self.member.body.mass * settings.gravity_m_s2;
        let energies = (weight_n, release.motion.kinetic_j(&release.rock));
        Trajectory { index, ..self.recorder.into_trajectory(release, stop, energies) }
    }
}
