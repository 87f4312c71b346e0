//! Settings that all rocks of a run share.

use super::{Effort, Stop};
use crate::flight::FlightEnd;
use crate::ground::{Capture, Law};
use crate::plan::{Plan, Recorders, RestRule};
use crate::solver::Settings;
use crate::solver::body::Body;
use crate::solver::environment::ContactEnvironment;
use crate::terrain::Terrain;

/// Settings that all rocks of a run share. Borrowed from the plan and never changed during the run,
/// so all threads share one.
#[derive(Debug, Clone, Copy)]
pub struct RunSettings<'a> {
    /// The meshes.
    pub terrain: &'a Terrain,
    /// Gravity (m/s²).
    pub gravity_m_s2: f64,
    /// Scheme and parameters of the time step.
    pub step: &'a Settings,
    /// Criterion of rest, see [`RestRule`].
    pub rest: RestRule,
    /// Simulated time at which a rock is stopped (s).
    pub longest_s: f64,
    /// Evaluation lines and map cells.
    pub recorders: Recorders<'a>,
    /// Seed of the rocks' random streams.
    pub seed: u64,
}

impl<'a> RunSettings<'a> {
    /// Settings of the rocks of a plan.
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

    /// Parameters of the capture speed for the laws of grounds and rocks.
    ///
    /// The capture speed of the scene, or, where the scene names none, what it is derived from:
    /// tolerance and gravity.
    pub(super) fn capture(&self, block_radius_m: Option<f64>) -> Capture {
        Capture {
            own_m_s: self.step.capture_speed_m_s,
            tolerance_m_s: self.step.speed_error_m_s(self.gravity_m_s2, block_radius_m),
            gravity_m_s2: self.gravity_m_s2,
        }
    }

    /// Terrain, body and laws of the grounds, as the contact solver needs them.
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

    /// Whether a rock has used up its budget. The budget counts work, not computing time, so that a
    /// rock is stopped at the same point on every machine.
    pub(super) fn over_budget(&self, effort: &Effort) -> Option<Stop> {
        (effort.work() > self.step.scheme.most_work()).then_some(Stop::OverBudget)
    }

    /// Duration (s) of a flight that began at `now_s` and ends with `end`, and why the rock stops
    /// there after this `effort`, if it does.
    ///
    /// Flights count against the budget too: between two plates a rock may fly for ever without
    /// advancing in time.
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
        // a contact exactly at the time limit comes too late
        (dt, stop.or_else(|| self.end_of_step(now_s, dt, effort)))
    }

    /// Whether a rock, after this `effort`, has reached the time limit or its budget `dt` (s) after
    /// `now_s`. The time limit is reached if the step took all the time left, or if the clock says
    /// so by rounding: a step of zero length has no solution where a rock both slides and rolls.
    pub(super) fn end_of_step(&self, now_s: f64, dt: f64, effort: &Effort) -> Option<Stop> {
        let is_over = dt >= self.longest_s - now_s || now_s + dt >= self.longest_s;
        is_over.then_some(Stop::TimeUp).or_else(|| self.over_budget(effort))
    }
}
