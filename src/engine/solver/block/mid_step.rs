//! Contacts that close within a step: the length of the step, and the target velocities of the
//! contacts at its midpoint.

use super::{BlockContactState, BlockState, DETECTION_REACH, TOUCH};
use crate::body::Block;
use crate::contact::block::BlockContactPoint;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::law::capture_m_s;

/// Contact detections at the midpoint of a step that an impact shortens, at most.
const MOST_DETECTIONS: u32 = 4;
/// A step is shortened again if the impact comes sooner by more than this share of it (–).
const SOONER: f64 = 1e-3;
/// No step is shortened further than to this (s).
const SHORTEST_S: f64 = 1e-9;

/// A contact at the midpoint of a step, with its motion since the start of the step.
pub(super) struct MidStepContact {
    /// Velocity of the body point at the start of the step, and its change by rotation (m/s).
    start_velocity: Vec3,
    velocity_change: Vec3,
    /// Gap at the start, and a lower bound of it (m).
    gap_m: f64,
    least_gap_m: f64,
}

impl MidStepContact {
    /// The contact `touch` of a block at the midpoint of a step of `dt`.
    pub(super) fn of(
        block: &Block,
        [start, middle]: [&BlockState; 2],
        touch: &BlockContactPoint,
        dt: f64,
    ) -> Self {
        let n = &touch.normal;
        let core = middle.pose.attitude.inverse_transform_vector(&(touch.lever + n * block.ball_m));
        let start_velocity =
            start.velocity_at(block, &(start.pose.attitude * core - n * block.ball_m));
        let velocity_change = middle.velocity_at(block, &touch.lever) - start_velocity;
        let gap_m = touch.gap_m - 0.5 * dt * n.dot(&(start_velocity + velocity_change * 0.5));
        // The contact point of two edges moves along both and is no fixed point of the block: of
        // the two velocities the one that separates faster is taken, so that a contact that was
        // pressed in is not taken for a gap.
        let slower = n.dot(&start_velocity).max(n.dot(&(start_velocity + velocity_change)));
        let least_gap_m = touch.gap_m - 0.5 * dt * slower;
        Self { start_velocity, velocity_change, gap_m, least_gap_m }
    }

    /// Whether the contact closes as an impact: it did not touch at the start, and it closes faster
    /// than its ground captures.
    pub(super) fn strikes(
        &self,
        world: &ContactEnvironment,
        block: &Block,
        touch: &BlockContactPoint,
    ) -> bool {
        let speed = -touch.normal.dot(&self.start_velocity);
        self.least_gap_m > TOUCH * block.radius_m && speed >= capture_m_s(world.law(touch.triangle))
    }

    /// Target velocity of the contact point at the midpoint of a step. Its normal part ends the
    /// step at the surface; its tangential part ends the step where the point began, as far as
    /// rotation has moved it.
    ///
    /// A step that begins with the gap `g` and the normal velocity `b` ends at the surface if it
    /// ends with `−2g/Δt − b`. A contact that closes would rebound at that speed. So the normal
    /// target is limited to the recovery speed of penetration, which reaches `out_m_s` (m/s) from a
    /// depth of `deep_m` (m) on.
    pub(super) fn goal(
        &self,
        touch: &BlockContactPoint,
        dt: f64,
        (deep_m, out_m_s): (f64, f64),
    ) -> Vec3 {
        let n = &touch.normal;
        let up = n.dot(&self.velocity_change);
        let most_m_s = out_m_s * (-self.gap_m / deep_m).clamp(0.0, 1.0);
        let out = (-2.0 * self.gap_m / dt - n.dot(&self.start_velocity)).min(most_m_s);
        n * (out - up) - (self.velocity_change - n * up)
    }
}

impl BlockContactState {
    /// Drifts from the start to the midpoint of a step of at most `dt` and detects the contacts
    /// there; returns the length of the step (s).
    ///
    /// A contact that closes faster than its ground captures is an impact and is put at the end of
    /// the step. Where the cells of the mesh are smaller than the travel of a step, only the
    /// detection at the midpoint finds it.
    pub(super) fn drift_to_middle(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        (start, state): (&BlockState, &mut BlockState),
        mut dt: f64,
    ) -> f64 {
        dt = self.time_to_impact(world, block, [start, start], (0.0, dt));
        for detection in 1..=MOST_DETECTIONS {
            *state = start.clone();
            state.drift(block, 0.5 * dt);
            self.detect(world, block, &state.pose, DETECTION_REACH * block.ball_m);
            let sooner = self.time_to_impact(world, block, [start, state], (0.5 * dt, dt));
            if detection == MOST_DETECTIONS || sooner >= dt * (1.0 - SOONER) {
                break;
            }
            dt = sooner;
        }
        dt
    }

    /// Shortens a step of `dt` (s) to the first impact; `now` is the state `elapsed` (s) after its
    /// start.
    fn time_to_impact(
        &self,
        world: &ContactEnvironment,
        block: &Block,
        [start, now]: [&BlockState; 2],
        (elapsed, dt): (f64, f64),
    ) -> f64 {
        self.touches.found.iter().fold(dt, |dt, touch| {
            let speed = now.approach_m_s(block, touch);
            let strikes = speed > 0.0
                && MidStepContact::of(block, [start, now], touch, 2.0 * elapsed)
                    .strikes(world, block, touch);
            if strikes { dt.min((elapsed + touch.gap_m / speed).max(SHORTEST_S)) } else { dt }
        })
    }
}
