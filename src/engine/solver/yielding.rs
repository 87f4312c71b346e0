//! An impact on a stem that breaks, in the limit of stiff springs: the law of one contact at a
//! fixed place, integrated on the time scale of the impact until the stem has taken its limit of
//! energy.
//!
//! In the limit of stiff springs nothing moves during the impact: normal and position are fixed and
//! the law of one contact is the whole model, with three springs and six velocities. Energy that
//! has left the rock's motion is in the stem, whether in springs or in friction.

use super::body::Body;
use super::law::{ContactDeformation, ContactForces};
use crate::ground::Law;
use crate::math;
use crate::rock::Vec3;

/// Step (rad of the contact's oscillation).
/// 5e-3 rad with a midpoint rule: an error of some 1e-5 of the speed, over at most 4000 steps.
pub(super) const STEP: f64 = 5e-3;
/// Longest impact (rad). By then the rock has separated, or moves out so heavily damped that no
/// more energy is taken.
pub(super) const MAX_CONTACT_RAD: f64 = 20.0;
/// Bisections of the step in which the stem breaks: to the last digit.
pub(super) const BISECTIONS: u32 = 60;

/// A rock pressed into one contact.
#[derive(Clone, Copy)]
struct PressedRock {
    at: ContactDeformation,
    v: Vec3,
    w: Vec3,
}

impl PressedRock {
    /// State after `h` (s), by the midpoint rule: `x + h f(x + h f(x)/2)`.
    fn after(&self, body: &Body, law: &Law, h: f64) -> Self {
        let middle = self.stepped(body, law, self, 0.5 * h);
        self.stepped(body, law, &middle, h)
    }

    /// State after `h` (s) at the rates of `there`.
    fn stepped(&self, body: &Body, law: &Law, there: &Self, h: f64) -> Self {
        let n = &there.at.n;
        let forces =
            ContactForces::of(body, law, &law.normal(false), &there.at, (&there.v, &there.w));
        let turning = n.cross(&forces.shear.force) * body.radius - forces.rolling.force;
        Self {
            at: ContactDeformation {
                n: *n,
                penetration: self.at.penetration - n.dot(&there.v) * h,
                shear: self.at.shear + forces.shear.stretch_rate * h,
                roll: self.at.roll + forces.rolling.stretch_rate * h,
            },
            v: self.v + (n * forces.normal[0] - forces.shear.force) * (h / body.mass),
            w: self.w + turning * (h / body.inertia),
        }
    }

    /// Whether it still approaches or is pushed out.
    fn presses(&self, law: &Law) -> bool {
        let separation_m_s = self.at.n.dot(&self.v);
        let force = law.normal(false).bilateral_force(self.at.penetration, separation_m_s);
        separation_m_s < 0.0 || force > 0.0
    }

    fn motion_j(&self, body: &Body) -> f64 {
        body.motion_j((&self.v, &self.w))
    }
}

/// Velocity and spin after an impact on a stem with normal `n` that breaks once it has taken
/// `limit_j`, springs and friction included. `None` if it withstands until the rock has separated:
/// friction goes on taking energy while the spring pushes out.
pub(crate) fn yielding_impact(
    body: &Body,
    (law, n): (&Law, &Vec3),
    (v, w): (&Vec3, &Vec3),
    limit_j: f64,
) -> Option<(Vec3, Vec3)> {
    let at =
        ContactDeformation { n: *n, penetration: 0.0, shear: Vec3::zeros(), roll: Vec3::zeros() };
    let mut rock = PressedRock { at, v: *v, w: *w };
    let left_j = rock.motion_j(body) - limit_j;
    let step = STEP / law.omega_rad_s();
    let mut elapsed_rad = 0.0;
    while rock.presses(law) && elapsed_rad < MAX_CONTACT_RAD {
        let next = rock.after(body, law, step);
        if next.motion_j(body) <= left_j {
            // bisection is safe where the energy taken is not monotone: the interval always ends
            // with the first crossing that the step saw
            let withstands = |time: f64| rock.after(body, law, time).motion_j(body) > left_j;
            let [_, breaks_s] = math::bisected([0.0, step], BISECTIONS, withstands);
            let end = rock.after(body, law, breaks_s);
            return Some((end.v, end.w));
        }
        (rock, elapsed_rad) = (next, elapsed_rad + STEP);
    }
    None
}
