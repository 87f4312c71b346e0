//! One rock of a world: flight, contact, rest, and its record.
//!
//! A rock of a world has two clocks. Its recorder is at `now`, the last recorded instant; the state
//! of the solver is at the end of the last step. In flight only the recorder counts, because the
//! parabola gives every later instant in closed form. When a contact begins, the solver state is
//! set from it (`land`, `begin_contact`).

use super::{BodyState, WorldBody};
use crate::flight::{FlightEnd, Parabola, time_of_impact_without};
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
    /// Parabola of its centre from the recorded instant on: `c + v t − g t²/2 z`, with constant
    /// spin.
    pub(super) fn flight(&self, settings: &RunSettings) -> Parabola {
        Parabola::of(&self.recorder.now, settings.gravity_m_s2, self.member.body.radius)
    }

    /// Centre at a time not before the recorded instant (m).
    pub(super) fn position_at(&self, settings: &RunSettings, time_s: f64) -> Vec3 {
        // only the steps of its island move a rock in contact
        if self.member.flying && time_s > self.recorder.now.time_s {
            self.flight(settings).centre(time_s - self.recorder.now.time_s)
        } else {
            self.recorder.now.position_m
        }
    }

    /// Velocity at a time not before the recorded instant (m/s).
    pub(super) fn velocity_at(&self, settings: &RunSettings, time_s: f64) -> Vec3 {
        // `c + v t − g t²/2 z` differentiated
        if self.member.flying && time_s > self.recorder.now.time_s {
            self.flight(settings).velocity(time_s - self.recorder.now.time_s)
        } else {
            self.recorder.now.velocity_m_s
        }
    }

    /// Starts to track the deviation of its velocity, from the velocity on the parabola at `now_s`;
    /// returns what was tracked before.
    pub(super) fn start_deviation(&mut self, settings: &RunSettings, now_s: f64) -> (Vec3, f64) {
        let velocity = self.velocity_at(settings, now_s);
        std::mem::replace(&mut self.deviation, (velocity, 0.0))
    }

    /// Resumes the deviation that was tracked before.
    pub(super) fn resume_deviation(&mut self, (reference, largest): (Vec3, f64)) {
        // triangle inequality: the deviation from the older reference is at most the sum of both
        // distances
        let since = (self.deviation.0 - reference).norm() + self.deviation.1;
        self.deviation = (reference, largest.max(since));
    }

    /// Wakes a sleeping rock and brings its record to `now_s`; finds the end of its flight if that
    /// is not known.
    pub(super) fn wake(&mut self, settings: &RunSettings, now_s: f64) {
        if self.state == BodyState::Asleep {
            self.state = BodyState::Moving;
            self.recorder.record_rest_until(now_s);
        }
        if self.member.flying && self.flight_end.is_none() {
            self.find_flight_end(settings);
        }
    }

    /// Finds the end of the flight that begins now. The result is stored until the flight ends:
    /// windows only compare times with it.
    pub(super) fn find_flight_end(&mut self, settings: &RunSettings) {
        let now_s = self.recorder.now.time_s;
        let time_left_s = settings.longest_s - now_s;
        let flight = self.flight(settings);
        let effort = &mut self.recorder.effort;
        // one search along the whole parabola up to the time limit, O(log n) in the triangles near
        // its path
        effort.leaps += 1;
        let gone = &self.member.state.near.broken_stems;
        let terrain = settings.terrain;
        let end =
            time_of_impact_without(terrain, &flight, time_left_s, gone, &mut effort.triangles);
        self.flight_end = Some(match end {
            FlightEnd::Touch(t) => (now_s + t, None),
            FlightEnd::Leaves(t) => (now_s + t, Some(Stop::LeftTerrain)),
            FlightEnd::Flies => (f64::INFINITY, None),
        });
        self.check_budget(settings);
    }

    /// Whether its flight lasts beyond `end_s` (s).
    pub(super) fn flies_beyond(&self, end_s: f64) -> bool {
        self.member.flying && self.flight_end.as_ref().is_some_and(|(time_s, _)| *time_s > end_s)
    }

    /// Removes it from the world when its budget of work is used up: other rocks may need less.
    pub(super) fn check_budget(&mut self, settings: &RunSettings) {
        if let Some(stop) = settings.over_budget(&self.recorder.effort) {
            self.flight_end = None;
            self.remove(stop);
        }
    }

    /// Moves a rock along its parabola; does nothing for a rock in contact.
    pub(super) fn fly_to(&mut self, settings: &RunSettings, time_s: f64) {
        if matches!(self.state, BodyState::Removed(_)) || !self.member.flying {
            return;
        }
        let dt = time_s - self.recorder.now.time_s;
        // rocks of one island have events at common times: those already there have nothing to
        // record
        if dt > 0.0 {
            let flight = self.flight(settings);
            self.recorder.record_flight(&flight, None, dt);
            // the time of the event, not the sum of durations: rounding must not separate rocks
            // that meet
            self.recorder.now.time_s = time_s;
        }
        let now = self.recorder.now;
        let state = &mut self.member.state;
        (state.c, state.v, state.w) = (now.position_m, now.velocity_m_s, now.spin_rad_s);
    }

    /// Begins a contact episode.
    pub(super) fn begin_contact(&mut self, settings: &RunSettings) {
        if self.member.flying {
            self.member.flying = false;
            self.flight_end = None;
            self.rest_criterion = RestCriterion::new(self.recorder.now.position_m);
            self.member.state.histories.clear();
            self.member.state.stored = 0.0;
            // energy at the start of the episode, from which its largest rise is measured at the
            // end
            self.episode_start_j = (self.mechanical_energy_j(settings), self.given_j());
        }
    }

    /// Energy given to other rocks and lost in contacts with them so far (J).
    ///
    /// `others_j` is lost in those contacts, `passed_on_j` belongs to other rocks now: together
    /// what this rock no longer has.
    fn given_j(&self) -> f64 {
        self.recorder.ledger.others_j + self.recorder.ledger.passed_on_j
    }

    /// Begins contact with the mesh; its springs are relaxed, unless the rock penetrates already.
    pub(super) fn land(&mut self, settings: &RunSettings) {
        self.begin_contact(settings);
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.recorder.now;
        let (world, state) = self.member.with_environment(settings.terrain);
        // detects the contacts at this position; histories of the episode before are gone
        state.begin(&world, c, v, w);
        // A rock that penetrates from the start has the energy of its springs, too.
        if settings.step.scheme.has_springs() {
            let held = state.stored_j(&world);
            self.recorder.book_spring_energy(&Loss::default(), &held);
            self.episode_start_j.0 += held.sum();
        }
        // an impact is resolved from its start; contacts too slow to rebound are left to error
        // control
        if state.histories.iter().any(|history| !history.captured) {
            self.next_step_s = self.next_step_s.min(ONSET / self.member.omega(settings.terrain));
        }
        self.in_contact(settings).begin_impacts();
    }

    /// Mechanical energy (J): `m v²/2 + I ω²/2 + m g z`, without elastic energy, which
    /// [`Self::end_episode`] adds.
    pub(super) fn mechanical_energy_j(&self, settings: &RunSettings) -> f64 {
        let now = &self.recorder.now;
        let body = &self.member.body;
        body.motion_j((&now.velocity_m_s, &now.spin_rad_s))
            + body.mass * settings.gravity_m_s2 * now.position_m.z
    }

    /// Records one step of its island.
    pub(super) fn record_step(
        &mut self,
        settings: &RunSettings,
        time_s: f64,
        (mut loss, given): (Loss, EnergyGiven),
        slides: bool,
    ) {
        if matches!(self.state, BodyState::Removed(_)) {
            return;
        }
        let was_flying = self.flight_end.is_some();
        // a bond would pull at the rotation of a facet
        let leaves_facet = self.is_bonded && given != EnergyGiven::default();
        let mut rock = self.in_contact(settings);
        rock.begin_impacts();
        if leaves_facet {
            rock.leave_facet();
        }
        // stems that the step has overloaded take their part of the energy now
        rock.state.load_stems(&rock.world, true, &mut loss);
        let to = self.motion_at(time_s);
        // a rock may be hit and released within one step: then it flies on another path
        let is_untouched = given == EnergyGiven::default() && loss == Loss::default();
        if was_flying && self.member.flying && is_untouched {
            self.recorder.record_step_as(to, PathState::Flight, true);
            return;
        }
        self.record_contact_step(settings, to, (loss, given), (slides, was_flying));
        if self.member.flying {
            self.find_flight_end(settings);
        }
    }

    /// Records one step of its island in the rigid limit, in which flying rocks may also touch and
    /// fly on within a step.
    ///
    /// Unlike with springs no contact history shows an impact: each was recorded by `record_blow`
    /// before.
    pub(super) fn record_rigid_step(
        &mut self,
        settings: &RunSettings,
        time_s: f64,
        (mut loss, given): (Loss, EnergyGiven),
        slides: bool,
    ) {
        if matches!(self.state, BodyState::Removed(_)) {
            return;
        }
        let rock = self.in_contact(settings);
        rock.state.load_stems(&rock.world, false, &mut loss);
        let to = self.motion_at(time_s);
        // its impacts are listed with the impacts of the step
        self.member.state.histories.iter_mut().for_each(|history| history.announced = true);
        if self.member.flew && self.member.flying && !self.member.was_touched {
            self.recorder.record_step_as(to, PathState::Flight, true);
            return;
        }
        let flew = self.member.flew;
        self.record_contact_step(settings, to, (loss, given), (slides, flew));
        self.recorder.book_impacts(&MeshEnergy::default());
        if self.member.flying {
            self.flight_end = None;
        }
    }

    /// Records one impulsive impact of the step that ends at `time_s` (s), with its contacts with
    /// the mesh: up to the first impact with the rock's state before, sliding or not, and between
    /// impacts in flight. What the impacts took is known at the end of the step only.
    pub(super) fn record_blow(
        &mut self,
        settings: &RunSettings,
        (blow, hits): (&BlowInStep, &[MeshImpact]),
        (time_s, slides): (f64, bool),
    ) {
        if matches!(self.state, BodyState::Removed(_)) {
            return;
        }
        let flies = self.member.flew || self.step_start.is_some();
        let now_s = self.recorder.now.time_s;
        self.step_start = self.step_start.or(Some((now_s, self.mechanical_energy_j(settings))));
        // rounding may have put the time before the start of the step
        let time_of = |motion: Motion| (time_s + motion.time_s).max(now_s);
        let [before, after] = blow.motions.map(|at| Motion { time_s: time_of(at), ..at });
        let state = if flies { PathState::Flight } else { PathState::in_contact(slides) };
        self.recorder.record_step_as(before, state, flies || self.member.state.is_free());
        for hit in hits {
            self.recorder.begin_impact(&hit.struck, before.time_s, &MeshEnergy::default());
        }
        self.recorder.record_velocity_jump(after);
        let _ = self.recorder.end_impacts(|_| false);
    }

    /// Tracks the deviation of its velocity from the reference: a rock that is hit and hit back has
    /// deviated all the same.
    pub(super) fn update_deviation(&mut self) {
        self.deviation.1 = self.deviation.1.max((self.member.state.v - self.deviation.0).norm());
    }

    /// State of the solver at `time_s` (s); also tracks the deviation.
    fn motion_at(&mut self, time_s: f64) -> Motion {
        self.update_deviation();
        let state = &self.member.state;
        Motion { time_s, position_m: state.c, velocity_m_s: state.v, spin_rad_s: state.w }
    }

    /// Records one step with contact.
    fn record_contact_step(
        &mut self,
        settings: &RunSettings,
        to: Motion,
        (loss, given): (Loss, EnergyGiven),
        (slides, was_flying): (bool, bool),
    ) {
        let from = self.recorder.now;
        let began = self.step_start.take();
        let (began_s, before_j) =
            began.unwrap_or_else(|| (from.time_s, self.mechanical_energy_j(settings)));
        let dt = to.time_s - began_s;
        // one slipping contact, with mesh or rock, makes the step "sliding"
        let slides = slides || self.member.state.histories.iter().any(|history| history.slides);
        // held by other rocks alone
        let is_off_ground = self.member.state.is_free();
        self.recorder.record_step_as(to, PathState::in_contact(slides), is_off_ground);
        self.recorder.book_losses(&loss);
        self.book_given(&given);
        // energy balance of the step: what motion, friction, dashpots and other rocks do not
        // account for is numerical error
        let change = self.mechanical_energy_j(settings) - before_j + loss.sum() + given.sum();
        self.recorder.ledger.remainder_j -= change;
        self.in_contact(settings).end_impacts();
        self.update_deviation();
        // hit during flight: a new contact episode begins with the energy before the step
        if was_flying {
            self.flight_end = None;
            self.rest_criterion = RestCriterion::new(self.recorder.now.position_m);
            self.episode_start_j = (before_j, self.given_j() - given.sum());
        }
        if self.member.flying {
            self.end_episode(settings);
        }
        self.rest_criterion.add_step(dt, [&from, &to], self.member.body.radius, &settings.rest);
    }

    /// Books the energy transferred to other rocks and lost in contacts with them (J).
    pub(super) fn book_given(&mut self, given: &EnergyGiven) {
        self.recorder.ledger.others_j += given.lost;
        self.recorder.ledger.passed_on_j += given.passed_on;
    }

    /// Ends a contact episode: its elastic energy, its impacts, and its rise of energy.
    pub(super) fn end_episode(&mut self, settings: &RunSettings) {
        let given_j = self.given_j() - self.episode_start_j.1;
        let (world, state) = self.member.with_environment(settings.terrain);
        // The rigid limit has no springs, whatever penetration rounding leaves.
        let is_rigid = !settings.step.scheme.has_springs();
        let stored = if is_rigid { Loss::default() } else { state.springs_j(&world) };
        self.recorder.book_spring_energy(&stored, &Loss::default());
        self.recorder.end_all_impacts();
        self.in_contact(settings).leave_facet();
        let rise_j =
            self.mechanical_energy_j(settings) - self.episode_start_j.0 + given_j + stored.sum();
        // without numerical error it is 0 or less: contacts only dissipate
        self.recorder.ledger.rise_j = self.recorder.ledger.rise_j.max(rise_j);
    }

    /// Prepares a step in contact, stems and facets as for a rock alone; returns the longest step
    /// (s).
    pub(super) fn before_step(&mut self, settings: &RunSettings) -> f64 {
        if self.member.flying {
            return f64::INFINITY;
        }
        self.in_contact(settings).before_step()
    }

    /// The rock in contact and its recorder.
    pub(super) fn in_contact<'r>(
        &'r mut self,
        settings: &RunSettings<'r>,
    ) -> RockInContact<'r, 'a> {
        let (world, state) = self.member.with_environment(settings.terrain);
        let has_springs = settings.step.scheme.has_springs();
        RockInContact { world, state, recorder: &mut self.recorder, has_springs }
    }

    /// Removes it from the world; a rock already removed keeps its reason. From then on it is in no
    /// island, and other rocks pass through where it was.
    pub(super) fn remove(&mut self, stop: Stop) {
        if self.state == BodyState::Moving {
            self.state = BodyState::Removed(stop);
        }
    }

    /// The complete trajectory.
    pub(super) fn end(
        mut self,
        settings: &RunSettings,
        index: usize,
        release: &Release,
        now_s: f64,
    ) -> Trajectory {
        // a rock that still moves when the world ends has reached the time limit
        let stop = match &self.state {
            BodyState::Moving => Stop::TimeUp,
            BodyState::Asleep => Stop::AtRest,
            BodyState::Removed(stop) => stop.clone(),
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
