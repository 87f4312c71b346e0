//! State of a rock on one plane: fourteen numbers that change during a step, and the contact
//! forces.

use super::body::Body;
use super::contact_frame::{Along, ContactFrame, Local, dot, square};
use super::friction_rolling::capped;
use super::tableau::STAGES;
use crate::ground::{Law, NormalElement};
use crate::rock::Vec3;

/// Size of the state; the offset of each quantity follows.
pub(super) const SIZE: usize = 14;
/// Displacement of the centre since the step's start (m).
pub(super) const WAY: usize = 0;
/// Velocity (m/s).
pub(super) const SPEED: usize = 3;
/// Spin (rad/s).
pub(super) const SPIN: usize = 6;
/// Stretch of the shear spring (m).
pub(super) const SHEAR: usize = 9;
/// Stretch of the rolling spring (rad).
pub(super) const ROLL: usize = 11;

pub(super) type State = [f64; SIZE];

#[inline]
pub(super) fn along_at(x: &State, at: usize) -> Along {
    [x[at], x[at + 1]]
}

#[inline]
pub(super) fn local_at(x: &State, at: usize) -> Local {
    [x[at], x[at + 1], x[at + 2]]
}

/// A state of displacement, velocity, spin and the stretches of shear and rolling springs, or of
/// their rates.
#[inline]
pub(super) fn state_of(
    [displacement, speed, spin]: [Local; 3],
    shear: Along,
    roll: Local,
) -> State {
    let mut state = [0.0; SIZE];
    state[WAY..SPEED].copy_from_slice(&displacement);
    state[SPEED..SPIN].copy_from_slice(&speed);
    state[SPIN..SHEAR].copy_from_slice(&spin);
    state[SHEAR..ROLL].copy_from_slice(&shear);
    state[ROLL..].copy_from_slice(&roll);
    state
}

/// A state from vectors in the frame of the terrain.
pub(super) fn into_plane(
    frame: &ContactFrame,
    motion: [&Vec3; 3],
    [shear, roll]: [&Vec3; 2],
) -> State {
    state_of(motion.map(|x| frame.local(x)), frame.along(shear), frame.local(roll))
}

/// Displacement, velocity, spin, shear and rolling as vectors in the frame of the terrain.
pub(super) fn out_of_plane(frame: &ContactFrame, x: &State) -> [Vec3; 5] {
    let [way, speed, spin, roll] =
        [WAY, SPEED, SPIN, ROLL].map(|at| frame.out_local(local_at(x, at)));
    [way, speed, spin, frame.out_along(along_at(x, SHEAR)), roll]
}

/// Contact forces at a stage's end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlaneForces {
    pub(super) normal_force: f64,
    pub(super) shear_force: Along,
    pub(super) rolling_moment: Local,
    /// Whether the contact is closed.
    pub(super) closed: bool,
}

/// Velocity of the contact point along the plane (m/s).
#[inline]
pub(super) fn slip(body: &Body, speed: Local, spin: Local) -> Along {
    [speed[0] - body.radius * spin[1], speed[1] + body.radius * spin[0]]
}

/// Energy in the springs (J).
#[inline]
pub(super) fn stored_j(law: &Law, penetration: f64, at: &State) -> f64 {
    let (shear2, roll2) = (square(along_at(at, SHEAR)), square(local_at(at, ROLL)));
    law.stored_j(penetration, shear2, roll2)
}

impl PlaneForces {
    /// Accelerations by them (m/s², rad/s²).
    #[inline]
    pub(super) fn accelerations(&self, body: &Body) -> (Local, Local) {
        let Self { normal_force, shear_force, rolling_moment, .. } = *self;
        let (over_m, over_i, r) = (1.0 / body.mass, 1.0 / body.inertia, body.radius);
        let turns = [
            -r * shear_force[1] - rolling_moment[0],
            r * shear_force[0] - rolling_moment[1],
            -rolling_moment[2],
        ];
        (
            [-shear_force[0] * over_m, -shear_force[1] * over_m, normal_force * over_m],
            turns.map(|x| x * over_i),
        )
    }

    /// Power that goes into friction, damping and rolling (W), what the springs store included.
    #[inline]
    pub(super) fn losses(
        &self,
        slip: Along,
        (rise, spin): (f64, Local),
        shear_rate: Along,
    ) -> Local {
        let held = dot(self.shear_force, shear_rate);
        [
            dot(self.shear_force, slip) - held,
            held - self.normal_force * rise,
            dot(self.rolling_moment, spin),
        ]
    }
}

/// Travel on one plane that is checked first (–, relative to R).
pub(super) const FIRST_REACH: f64 = 0.6;

/// State and rates of a rock on one plane.
#[derive(Debug)]
pub struct PlaneState {
    /// Whether they belong to the current rock.
    pub(super) on: bool,
    pub(super) frame: ContactFrame,
    pub(super) state: State,
    pub(super) rates: [State; STAGES],
    /// Power that goes into friction, damping and rolling at each stage (W).
    pub(super) losses: [Local; STAGES],
    /// `rigid`: the step to try next (s).
    pub(super) proposed_s: f64,
    /// Travel to check next (–, relative to R), and the position where the last one short enough
    /// was not clear (m).
    pub(super) reach: f64,
    pub(super) blocked_at: Vec3,
    /// Whether soil slows the rock between steps: then steps stay short.
    pub(crate) ploughs: bool,
}

impl Default for PlaneState {
    fn default() -> Self {
        Self {
            on: false,
            frame: ContactFrame::of(&Vec3::z()),
            state: [0.0; SIZE],
            rates: [[0.0; SIZE]; STAGES],
            losses: [[0.0; 3]; STAGES],
            proposed_s: f64::INFINITY,
            reach: FIRST_REACH,
            blocked_at: Vec3::repeat(f64::INFINITY),
            ploughs: false,
        }
    }
}

impl PlaneState {
    /// Invalidates the state (before the next contact).
    pub(crate) fn forget(&mut self) {
        (self.on, self.proposed_s) = (false, f64::INFINITY);
        (self.reach, self.blocked_at) = (FIRST_REACH, Vec3::repeat(f64::INFINITY));
    }

    /// Rates at the present state, for the explicit first stage; returns the energy in the springs (J).
    pub(super) fn rates_now(
        &mut self,
        law: &Law,
        body: &Body,
        (penetration, normal): (f64, &NormalElement),
    ) -> f64 {
        let (penetration, s) = (penetration.max(0.0), &self.state);
        let (speed, spin) = (local_at(s, SPEED), local_at(s, SPIN));
        let slip = slip(body, speed, spin);
        let normal_force = normal.force(penetration, speed[2]);
        let held = along_at(s, SHEAR).map(|x| law.shear.spring_force(x));
        let trial = [0, 1].map(|k| held[k] + law.shear.dashpot_force(slip[k]));
        let shear_force = capped(trial, law.shear.cap(normal_force));
        let roll_held = local_at(s, ROLL).map(|x| law.rolling.spring_force(x));
        let trial = [0, 1, 2].map(|k| roll_held[k] + law.rolling.dashpot_force(spin[k]));
        let rolling_moment = capped(trial, law.rolling.cap(normal_force));
        let (over_s, over_r) = (law.shear.mobility(), law.rolling.mobility());
        let gravity = self.frame.local(&body.gravity);
        let forces = PlaneForces { normal_force, shear_force, rolling_moment, closed: true };
        let (dv, dw) = forces.accelerations(body);
        let dv = [0, 1, 2].map(|k| gravity[k] + dv[k]);
        let shear_rate = [0, 1].map(|k| (shear_force[k] - held[k]) * over_s);
        let roll_rate = [0, 1, 2].map(|k| (rolling_moment[k] - roll_held[k]) * over_r);
        self.rates[0] = state_of([speed, dv, dw], shear_rate, roll_rate);
        self.losses[0] = forces.losses(slip, (speed[2], spin), shear_rate);
        stored_j(law, penetration, &self.state)
    }
}
