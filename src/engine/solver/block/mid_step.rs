//! What comes to a block within a step: how long that may be, and what its contacts ask for.

use super::{BlockContactState, BlockState, DETECTION_REACH, TOUCH};
use crate::body::Block;
use crate::contact::block::BlockTouch;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::law::capture_m_s;

/// Looks into the middle of a step that an impact cuts, at most.
const MOST_DETECTIONS: u32 = 4;
/// A step is cut again where the impact comes sooner by more than this (–).
const SOONER: f64 = 1e-3;
/// No step is cut shorter (s).
const SHORTEST_S: f64 = 1e-9;

/// How a contact in the middle of a step came there.
pub(super) struct MidStepContact {
    /// Velocity of the point of the block at the start of the step, and what turning has added (m/s).
    start_velocity: Vec3,
    velocity_change: Vec3,
    /// Gap at the start, and the least it can have been (m).
    gap_m: f64,
    least_gap_m: f64,
}

impl MidStepContact {
    /// The contact `touch` of a block in the middle of a step of `dt`.
    pub(super) fn of(
        block: &Block,
        [start, middle]: [&BlockState; 2],
        touch: &BlockTouch,
        dt: f64,
    ) -> Self {
        let n = &touch.normal;
        let core = middle.pose.attitude.inverse_transform_vector(&(touch.lever + n * block.ball_m));
        let start_velocity =
            start.velocity_at(block, &(start.pose.attitude * core - n * block.ball_m));
        let velocity_change = middle.velocity_at(block, &touch.lever) - start_velocity;
        let gap_m = touch.gap_m - 0.5 * dt * n.dot(&(start_velocity + velocity_change * 0.5));
        // a pair of edges moves on along both, and so is no point of the block: the slower of the two speeds cannot make a gap of one that was pressed in
        let slower = n.dot(&start_velocity).max(n.dot(&(start_velocity + velocity_change)));
        let least_gap_m = touch.gap_m - 0.5 * dt * slower;
        Self { start_velocity, velocity_change, gap_m, least_gap_m }
    }

    /// Whether it comes to the block as an impact: it did not touch, and closes faster than its ground captures.
    pub(super) fn strikes(
        &self,
        world: &ContactEnvironment,
        block: &Block,
        touch: &BlockTouch,
    ) -> bool {
        let speed = -touch.normal.dot(&self.start_velocity);
        self.least_gap_m > TOUCH * block.radius_m && speed >= capture_m_s(world.law(touch.triangle))
    }

    /// The velocity that the contact point seeks in the middle of a step: along the normal what ends the step at the surface, along the surface
    /// what ends it where it began, as far as turning has moved it.
    ///
    /// At the surface a step ends that began with the gap `g` and the speed `b` and ends with `−2g/Δt − b`. A contact that comes down on it would be
    /// thrown back so: it ends no faster than what was pressed in is let out, with `out_m_s` (m/s) from `deep_m` (m) on.
    pub(super) fn goal(&self, touch: &BlockTouch, dt: f64, (deep_m, out_m_s): (f64, f64)) -> Vec3 {
        let n = &touch.normal;
        let up = n.dot(&self.velocity_change);
        let most_m_s = out_m_s * (-self.gap_m / deep_m).clamp(0.0, 1.0);
        let out = (-2.0 * self.gap_m / dt - n.dot(&self.start_velocity)).min(most_m_s);
        n * (out - up) - (self.velocity_change - n * up)
    }
}

impl BlockContactState {
    /// Drifts from the start to the middle of a step of at most `dt` and looks for contacts there; how long the step is (s).
    ///
    /// What closes faster than its ground captures is an impact, and comes at the end of the step. Where cells are smaller than a step
    /// only the look in the middle finds it.
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

    /// Cuts a step of `dt` (s) where an impact comes, as it looks `elapsed` (s) from its start.
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
