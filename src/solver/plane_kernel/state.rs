//! A rock on one plane: the fourteen numbers that change along a step, and what presses on it.

use crate::ground::Law;
use crate::solver::friction_rolling::{Along, Local};
use crate::solver::law::Body;

/// Numbers that change along a step, and where each kind begins.
pub(super) const SIZE: usize = 14;
/// Way of the centre since the step's start (m).
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
pub(super) fn two(x: &State, at: usize) -> Along {
    [x[at], x[at + 1]]
}

#[inline]
pub(super) fn three(x: &State, at: usize) -> Local {
    [x[at], x[at + 1], x[at + 2]]
}

#[inline]
pub(super) fn dot<const N: usize>(x: [f64; N], y: [f64; N]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

#[inline]
pub(super) fn square<const N: usize>(x: [f64; N]) -> f64 {
    dot(x, x)
}
/// What presses on the rock at a stage's end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlaneForces {
    pub(super) normal_force: f64,
    pub(super) shear_force: Along,
    pub(super) rolling_moment: Local,
    /// Whether it still holds the rock.
    pub(super) closed: bool,
}
/// Velocity of the contact point along the plane (m/s).
#[inline]
pub(super) fn slip(body: &Body, speed: Local, spin: Local) -> Along {
    [speed[0] - body.radius * spin[1], speed[1] + body.radius * spin[0]]
}

/// What contact forces do to velocity and spin (m/s², rad/s²).
#[inline]
pub(super) fn accelerations(
    body: &Body,
    normal_force: f64,
    shear_force: Along,
    rolling_moment: Local,
) -> (Local, Local) {
    let (over_m, over_i) = (1.0 / body.mass, 1.0 / body.inertia);
    let r = body.radius;
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

/// Energy in the springs (J).
#[inline]
pub(super) fn stored_j(law: &Law, penetration: f64, at: &State) -> f64 {
    let (shear2, roll2) = (square(two(at, SHEAR)), square(three(at, ROLL)));
    law.stored_j(penetration, shear2, roll2)
}

impl PlaneForces {
    /// Power that goes into friction, damping and rolling (W): what the springs store is counted in.
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
