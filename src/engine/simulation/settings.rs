//! What all rocks of a scene have in common.

use super::{Effort, Stop};
use crate::flight::FlightEnd;
use crate::ground::{Capture, Law};
use crate::plan::{Plan, Recorders, RestRule};
use crate::solver::Settings;
use crate::solver::body::Body;
use crate::solver::environment::ContactEnvironment;
use crate::terrain::Terrain;

/// What all rocks of a scene have in common.
/// Borrowed from the plan and never changed while rocks fall, so all threads share one.
#[derive(Debug, Clone, Copy)]
pub struct RunSettings<'a> {
    /// The meshes.
    pub terrain: &'a Terrain,
    /// Gravity (m/s²).
    pub gravity_m_s2: f64,
    /// The step.
    pub step: &'a Settings,
    /// When a rock is at rest.
    /// See [`RestRule`].
    pub rest: RestRule,
    /// Simulated time after which a rock is out of time (s).
    pub longest_s: f64,
    /// Evaluation lines and map cells.
    pub recorders: Recorders<'a>,
    /// Seed of the rocks' random streams.
    pub seed: u64,
}

impl<'a> RunSettings<'a> {
    /// What the rocks of a plan have in common.
    pub fn of(plan: &'a Plan) -> Self {
        Self {
            terrain: &plan.terrain,
            gravity_m_s2: plan.gravity_m_s2,
            step: &plan.step,
            rest: plan.rest,
            longest_s: plan.longest_s,
            recorders: plan.recorders(),
            seed: plan.seed,
        }
    }

    /// What the laws of grounds and rocks need to know of the run.
    ///
    /// The scene's own capture speed, or what it is made of where the scene names none: tolerance
    /// and gravity.
    pub(super) fn capture(&self, block_radius_m: Option<f64>) -> Capture {
        Capture {
            own_m_s: self.step.capture_speed_m_s,
            tolerance_m_s: self.step.speed_error_m_s(self.gravity_m_s2, block_radius_m),
            gravity_m_s2: self.gravity_m_s2,
        }
    }

    /// What a rock meets, with these laws of the grounds.
    pub(super) fn contact_environment<'w>(
        &self,
        body: Body,
        laws: &'w [Law],
    ) -> ContactEnvironment<'w>
    where
        'a: 'w,
    {
        ContactEnvironment { terrain: self.terrain, body, laws }
    }

    /// Whether a rock has had all the work it may have: a budget of work, not of time, so that it is stopped on every machine.
    pub(super) fn over_budget(&self, effort: &Effort) -> Option<Stop> {
        (effort.work() > self.step.scheme.most_work()).then_some(Stop::OverBudget)
    }

    /// How long a flight lasts (s) that ends so and began at `now_s`, and whether the rock, after this `effort`, stops there.
    ///
    /// Flights count too: between two plates a rock may fly without end and without getting on in time.
    pub(super) fn end_of_flight(
        &self,
        end: &FlightEnd,
        now_s: f64,
        effort: &Effort,
    ) -> (f64, Option<Stop>) {
        let left = self.longest_s - now_s;
        let (dt, stop) = match *end {
            FlightEnd::Touch(t) => (t, None),
            FlightEnd::Leaves(t) => (t, Some(Stop::LeftTerrain)),
            FlightEnd::Flies => (left, Some(Stop::TimeUp)),
        };
        // a touch at the very end of the time comes too late
        (dt, stop.or_else(|| self.end_of_step(now_s, dt, effort)))
    }

    /// Whether a rock, after this `effort`, is out of time `dt` (s) after `now_s`, or over its budget. Out of time: it has taken all that was
    /// left, or the clock says so by rounding. A step of no time at all has no solution where the rock both slides and rolls.
    pub(super) fn end_of_step(&self, now_s: f64, dt: f64, effort: &Effort) -> Option<Stop> {
        let is_over = dt >= self.longest_s - now_s || now_s + dt >= self.longest_s;
        is_over.then_some(Stop::TimeUp).or_else(|| self.over_budget(effort))
    }
}
