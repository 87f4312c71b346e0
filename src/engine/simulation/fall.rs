//! A sphere on its way: what it meets, what it is, what is noted down of it.

use super::driver::{Falling, follow};
use super::form::{Form, RockInstant};
use super::recorder::{Keep, Recorder};
use super::rock_in_contact::RockInContact;
use super::settings::RunSettings;
use super::{Stop, Trajectory};
use crate::contact::TOUCH;
use crate::flight::{Parabola, time_of_impact_past};
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

/// One sphere.
/// Everything that a journey needs and nothing that outlives it.
pub(super) struct Fall<'a> {
    pub(super) settings: &'a RunSettings<'a>,
    pub(super) body: Body,
    /// Those in force: soil and the speed of impacts change them on the way.
    pub(super) laws: &'a mut [Law],
    pub(super) soil: Soil<'a>,
    pub(super) state: &'a mut ContactState,
    pub(super) recorder: Recorder<'a>,
}

/// Follows one sphere from its release to its stop; `laws` are those of the grounds for it.
pub(super) fn follow_sphere(
    settings: &RunSettings,
    release: &Release,
    keep: Keep,
    (laws, random): (&mut [Law], RandomStream),
    (state, scars, slip): (&mut ContactState, &mut Scars, &mut Slip),
) -> Trajectory {
    state.near.forget();
    (state.near.tested, state.sweeps) = (0, 0);
    state.stem_load.reset(settings.terrain, &random, &mut state.near.gone);
    state.facets = RoughFacets::of(random, laws);
    slip.begin(&release.grounds);
    let form = Form { rock: release.rock, block: None };
    let kept = (keep, settings.recorders);
    let mut fall = Fall {
        settings,
        body: Body::new(&release.rock, settings.gravity_m_s2),
        laws,
        soil: Soil::new(scars, slip),
        state,
        recorder: Recorder::new(settings.terrain, form, (release.motion, None), kept),
    };
    let pressed = fall.is_pressed();
    let stop = follow(&mut fall, pressed);
    fall.end(release, stop)
}

impl<'a> Fall<'a> {
    /// Whether the rock is in contact with something it is pressed into.
    fn is_pressed(&mut self) -> bool {
        self.look();
        self.state.touches.iter().any(|touch| touch.distance_m < self.body.radius)
    }

    /// Begins contact anew where it is.
    fn look(&mut self) {
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.recorder.now;
        let world = self.settings.around(self.body, self.laws);
        let together = if self.is_rigid() { STRUCK_TOGETHER } else { TOUCH };
        self.state.begin_within(&world, (c, v, w), together);
    }

    /// The journey, complete.
    fn end(mut self, release: &Release, stop: Stop) -> Trajectory {
        self.recorder.effort.sweeps += self.state.sweeps;
        self.recorder.effort.triangles += self.state.near.tested;
        let weight_n = self.body.mass * self.settings.gravity_m_s2;
        let energies = (weight_n, release.motion.kinetic_j(&release.rock));
        self.recorder.into_trajectory(release, stop, energies)
    }

    /// Whether contacts have no springs: those of the rigid limit hold nothing, whatever the depth that rounding leaves.
    pub(super) fn is_rigid(&self) -> bool {
        !self.settings.step.scheme.has_springs()
    }

    /// The rock and its notes.
    pub(super) fn in_contact(&mut self) -> RockInContact<'_, 'a> {
        let has_springs = !self.is_rigid();
        let Self { settings, body, laws, state, recorder, .. } = self;
        RockInContact { world: settings.around(*body, laws), state, recorder, has_springs }
    }
}

impl<'a> Falling<'a> for Fall<'a> {
    type Stepping = Stepper;

    fn settings(&self) -> &'a RunSettings<'a> {
        self.settings
    }

    fn recorder(&mut self) -> &mut Recorder<'a> {
        &mut self.recorder
    }

    fn ball(&self) -> (Vec3, f64) {
        (self.state.c, self.body.radius)
    }

    fn total_j(&self) -> f64 {
        self.state.motion_j(&self.body) - self.body.mass * self.body.gravity.dot(&self.state.c)
    }

    /// Cost: one search through the index, however long the flight.
    fn fly(&mut self) -> Option<Stop> {
        let now = self.recorder.now;
        let flight = Parabola::of(&now, self.settings.gravity_m_s2, self.body.radius);
        let left = self.settings.longest_s - now.time_s;
        let begun = self.state.stopwatches.now();
        // stems that this rock has broken are no longer in its way
        let end = time_of_impact_past(
            self.settings.terrain,
            &flight,
            left,
            &self.state.near.gone,
            &mut self.recorder.effort.triangles,
        );
        // a flight counts as one leap, however long
        self.recorder.effort.leaps += 1;
        let (dt, stop) = self.settings.end_of_flight(&end, now.time_s, &self.recorder.effort);
        self.state.stopwatches.stop(TimedPiece::Leap, begun);
        let begun = self.state.stopwatches.now();
        self.recorder.fly(&flight, None, dt);
        let kept = self.soil.fly(&self.body, &self.recorder.now.velocity_m_s, dt);
        self.recorder.slow_in_flight(kept);
        self.state.stopwatches.stop(TimedPiece::NotesInFlight, begun);
        stop
    }

    fn begin(&mut self) -> (Stepper, Loss) {
        self.look();
        self.in_contact().announce();
        // soil takes speed out of the blow before any spring answers
        let kept = self.answer_blows();
        self.recorder.now.velocity_m_s *= kept;
        let world = self.settings.around(self.body, self.laws);
        let held = if self.is_rigid() { Loss::default() } else { self.state.stored_j(&world) };
        (Stepper::new(self.settings.step, &world, self.state), held)
    }

    /// What a sphere strikes its step says.
    fn meet(&mut self) -> bool {
        false
    }

    fn longest_s(&mut self) -> f64 {
        self.before_step()
    }

    fn step(&mut self, stepper: &mut Stepper, most_s: f64) -> Result<(Advance, bool), StepError> {
        let before = self.state.c;
        let world = self.settings.around(self.body, self.laws);
        let mut done = solver::advance(stepper, &world, self.state, most_s)?;
        self.in_contact().announce();
        self.soil_after_step(&before, done.dt);
        self.answer_blows();
        let world = self.settings.around(self.body, self.laws);
        // a stem has given way: stiffness and contacts changed, so the stepper forgets its factors and its step
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

    fn note(&mut self, to: RockInstant, slides: bool) -> bool {
        let begun = self.state.stopwatches.now();
        self.recorder.step(to, slides);
        self.in_contact().end_impacts();
        self.state.stopwatches.stop(TimedPiece::NotesInContact, begun);
        self.state.is_free()
    }

    /// Only a fixed step leaves some in those of a free rock.
    fn stored(&mut self) -> Loss {
        let left = self.state.is_free() && !self.settings.step.scheme.has_fixed_step();
        if left || self.is_rigid() {
            return Loss::default();
        }
        self.state.springs_j(&self.settings.around(self.body, self.laws))
    }

    fn leave(&mut self) {
        self.recorder.end_all_impacts();
        self.in_contact().leave_facet();
    }
}

/// What a sphere does to soil.
/// All of it is changed between steps, so a step itself sees constant laws.
pub(super) struct Soil<'a> {
    pub(super) scars: &'a mut Scars,
    pub(super) slip: &'a mut Slip,
    /// Where it slips fastest since the step in hand began.
    pub(super) slips: Option<Slips>,
    /// How long the step before was (s), 0 after a flight.
    pub(super) last_step_s: f64,
}

/// A contact that slips.
///
/// Speed of the contact point along the surface, normal of the contact, and the ground on which it
/// slips.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slips {
    pub(super) speed_m_s: f64,
    pub(super) n: Vec3,
    pub(super) ground: u16,
}

impl<'a> Soil<'a> {
    /// Of a rock that has not moved yet.
    pub(super) fn new(scars: &'a mut Scars, slip: &'a mut Slip) -> Self {
        Self { scars, slip, slips: None, last_step_s: 0.0 }
    }

    /// Flies for so long (s) and ends at a velocity; what the rock keeps of that (–).
    pub(super) fn fly(&mut self, body: &Body, v: &Vec3, flight_s: f64) -> f64 {
        self.slip.decay(flight_s);
        self.last_step_s = 0.0;
        self.scars.fly(body, v, flight_s)
    }
}
