//! The simulation of one sphere: its state, its environment and its record.

use super::driver::{RockSimulation, run_to_stop};
use super::recorder::{RecordOptions, Recorder};
use super::rock_geometry::{RockGeometry, RockInstant};
use super::rock_in_contact::RockInContact;
use super::settings::RunSettings;
use super::{Stop, Trajectory};
use crate::contact::TOUCH;
use crate::flight::{Parabola, time_of_impact_without};
use crate::ground::Law;
use crate::random::RandomStream;
use crate::release::Release;
use crate::rock::{Motion, Vec3};
use crate::solver::body::Body;
use crate::solver::contact_state::ContactState;
use crate::solver::loss::Loss;
use crate::solver::rigid::STRUCK_TOGETHER;
use crate::solver::roughness::RoughFacets;
use crate::solver::scar::Scars;
use crate::solver::slip::Slip;
use crate::solver::step_control::{Advance, StepError};
use crate::solver::{self, Stepper};
use crate::stopwatch::TimedPiece;

/// One sphere during its simulation. Everything that a trajectory needs and nothing that outlives
/// it.
pub(super) struct SphereSimulation<'a> {
    pub(super) settings: &'a RunSettings<'a>,
    pub(super) body: Body,
    /// Laws in force: soil and impact speed change them during the simulation.
    pub(super) laws: &'a mut [Law],
    pub(super) soil: Soil<'a>,
    pub(super) state: &'a mut ContactState,
    pub(super) recorder: Recorder<'a>,
}

/// Simulates one sphere from its release to its stop; `laws` are the laws of the grounds for it.
pub(super) fn run_sphere(
    settings: &RunSettings,
    release: &Release,
    options: RecordOptions,
    (laws, random): (&mut [Law], RandomStream),
    (state, scars, slip): (&mut ContactState, &mut Scars, &mut Slip),
) -> Trajectory {
    state.near.forget();
    (state.near.tested, state.sweeps) = (0, 0);
    state.stem_load.reset(settings.terrain, &random, &mut state.near.broken_stems);
    state.facets = RoughFacets::of(random, laws);
    slip.begin(&release.grounds);
    let geometry = RockGeometry { rock: release.rock, block: None };
    let records = (options, settings.recorders);
    let mut rock = SphereSimulation {
        settings,
        body: Body::new(&release.rock, settings.gravity_m_s2),
        laws,
        soil: Soil::new(scars, slip),
        state,
        recorder: Recorder::new(settings.terrain, geometry, (release.motion, None), records),
    };
    let penetrates = rock.is_penetrating();
    let stop = run_to_stop(&mut rock, penetrates);
    rock.end(release, stop)
}

impl<'a> SphereSimulation<'a> {
    /// Whether the rock penetrates the mesh.
    fn is_penetrating(&mut self) -> bool {
        self.find_contacts();
        self.state.touches.iter().any(|touch| touch.distance_m < self.body.radius)
    }

    /// Detects the contacts at the present position; all histories start anew.
    fn find_contacts(&mut self) {
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.recorder.now;
        let world = self.settings.contact_environment(self.body, self.laws);
        let search_distance = if self.is_rigid() { STRUCK_TOGETHER } else { TOUCH };
        self.state.begin_within(&world, (c, v, w), search_distance);
    }

    /// The complete trajectory.
    fn end(mut self, release: &Release, stop: Stop) -> Trajectory {
        self.recorder.effort.sweeps += self.state.sweeps;
        self.recorder.effort.triangles += self.state.near.tested;
        let weight_n = self.body.mass * self.settings.gravity_m_s2;
        let energies = (weight_n, release.motion.kinetic_j(&release.rock));
        self.recorder.into_trajectory(release, stop, energies)
    }

    /// Whether contacts have no springs. Contacts of the rigid limit hold no energy, whatever
    /// penetration rounding leaves.
    pub(super) fn is_rigid(&self) -> bool {
        !self.settings.step.scheme.has_springs()
    }

    /// The rock in contact and its recorder.
    pub(super) fn in_contact(&mut self) -> RockInContact<'_, 'a> {
        let has_springs = !self.is_rigid();
        let Self { settings, body, laws, state, recorder, .. } = self;
        RockInContact {
            world: settings.contact_environment(*body, laws),
            state,
            recorder,
            has_springs,
        }
    }
}

impl<'a> RockSimulation<'a> for SphereSimulation<'a> {
    type StepperState = Stepper;

    fn settings(&self) -> &'a RunSettings<'a> {
        self.settings
    }

    fn recorder(&mut self) -> &mut Recorder<'a> {
        &mut self.recorder
    }

    fn bounding_sphere(&self) -> (Vec3, f64) {
        (self.state.c, self.body.radius)
    }

    fn mechanical_energy_j(&self) -> f64 {
        self.state.motion_j(&self.body) - self.body.mass * self.body.gravity.dot(&self.state.c)
    }

    /// Cost: one search through the index, however long the flight.
    fn fly(&mut self) -> Option<Stop> {
        let now = self.recorder.now;
        let flight = Parabola::of(&now, self.settings.gravity_m_s2, self.body.radius);
        let time_left_s = self.settings.longest_s - now.time_s;
        let started = self.state.stopwatches.now();
        // stems that this rock has broken are no obstacles any more
        let end = time_of_impact_without(
            self.settings.terrain,
            &flight,
            time_left_s,
            &self.state.near.broken_stems,
            &mut self.recorder.effort.triangles,
        );
        // a flight counts as one, however long
        self.recorder.effort.leaps += 1;
        let (dt, stop) = self.settings.end_of_flight(&end, now.time_s, &self.recorder.effort);
        self.state.stopwatches.stop(TimedPiece::Leap, started);
        let started = self.state.stopwatches.now();
        self.recorder.record_flight(&flight, None, dt);
        let speed_factor = self.soil.fly(&self.body, &self.recorder.now.velocity_m_s, dt);
        self.recorder.slow_in_soil_after_flight(speed_factor);
        self.state.stopwatches.stop(TimedPiece::NotesInFlight, started);
        stop
    }

    fn begin_contact(&mut self) -> (Stepper, Loss) {
        self.find_contacts();
        self.in_contact().begin_impacts();
        // soil slows the rock down before any spring acts
        let speed_factor = self.apply_blows();
        self.recorder.now.velocity_m_s *= speed_factor;
        let world = self.settings.contact_environment(self.body, self.laws);
        let spring_energy =
            if self.is_rigid() { Loss::default() } else { self.state.stored_j(&world) };
        (Stepper::new(self.settings.step, &world, self.state), spring_energy)
    }

    /// Nothing to do: the step of a sphere finds its impacts.
    fn resolve_impacts(&mut self) -> bool {
        false
    }

    fn prepare_step(&mut self) -> f64 {
        self.before_step()
    }

    fn step(
        &mut self,
        stepper: &mut Stepper,
        longest_s: f64,
    ) -> Result<(Advance, bool), StepError> {
        let before = self.state.c;
        let world = self.settings.contact_environment(self.body, self.laws);
        let mut done = solver::advance(stepper, &world, self.state, longest_s)?;
        self.in_contact().begin_impacts();
        self.soil_after_step(&before, done.dt);
        self.apply_blows();
        let world = self.settings.contact_environment(self.body, self.laws);
        // a stem has yielded: stiffness and contacts have changed, so the stepper discards its
        // factorisation and its step size
        if self.state.load_stems(&world, !self.is_rigid(), &mut done.loss) {
            *stepper = Stepper::new(self.settings.step, &world, self.state);
        }
        // one slipping contact makes the whole step "sliding" on the path
        Ok((done, self.state.histories.iter().any(|history| history.slides)))
    }

    fn instant(&self, time_s: f64) -> RockInstant {
        let ContactState { c: position_m, v: velocity_m_s, w: spin_rad_s, .. } = *self.state;
        Motion { time_s, position_m, velocity_m_s, spin_rad_s }.into()
    }

    fn record_step(&mut self, to: RockInstant, slides: bool) -> bool {
        let started = self.state.stopwatches.now();
        self.recorder.record_step(to, slides);
        self.in_contact().end_impacts();
        self.state.stopwatches.stop(TimedPiece::NotesInContact, started);
        self.state.is_free()
    }

    /// Only a fixed step leaves elastic energy in the springs of a free rock.
    fn spring_energy(&mut self) -> Loss {
        let is_relaxed = self.state.is_free() && !self.settings.step.scheme.has_fixed_step();
        if is_relaxed || self.is_rigid() {
            return Loss::default();
        }
        self.state.springs_j(&self.settings.contact_environment(self.body, self.laws))
    }

    fn end_contact(&mut self) {
        self.recorder.end_all_impacts();
        self.in_contact().leave_facet();
    }
}

/// Interaction of a sphere with soil. It changes between steps only, so the laws are constant
/// within a step.
pub(super) struct Soil<'a> {
    pub(super) scars: &'a mut Scars,
    pub(super) slip: &'a mut Slip,
    /// The contact that slips fastest, at the start of the current step.
    pub(super) fastest_slip: Option<SlippingContact>,
    /// Length of the step before (s), 0 after a flight.
    pub(super) last_step_s: f64,
}

/// A contact that slips: slip speed along the surface (m/s), contact normal, and number of the
/// ground on which it slips.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlippingContact {
    pub(super) speed_m_s: f64,
    pub(super) n: Vec3,
    pub(super) ground: u16,
}

impl<'a> Soil<'a> {
    /// For a rock that has not moved yet.
    pub(super) fn new(scars: &'a mut Scars, slip: &'a mut Slip) -> Self {
        Self { scars, slip, fastest_slip: None, last_step_s: 0.0 }
    }

    /// Records a flight of `flight_s` (s) that ends with velocity `v`. Returns the fraction of the
    /// speed that the rock keeps (–).
    pub(super) fn fly(&mut self, body: &Body, v: &Vec3, flight_s: f64) -> f64 {
        self.slip.decay(flight_s);
        self.last_step_s = 0.0;
        self.scars.fly(body, v, flight_s)
    }
}
