//! The motion of a rock through an impact on a plane, from first contact or from any state within
//! it.
//!
//! The normal motion is a closed form for any initial state: the remaining time of the impact, the
//! largest penetration and the exit speed are known before the tangential motion is integrated.

use super::{ImpactStart, Plane, Rebound, SMOOTH};
use crate::math;
use crate::rock::Vec3;
use crate::solver::contact_frame::{ContactFrame, Local};
use crate::solver::impact::ImpactEffort;
use crate::solver::impact::normal_motion::Exit;
use crate::solver::loss::Loss;

/// Penetration of a rock into a plane, and the stretches of the springs of its contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InitialDeformation {
    /// Penetration (m).
    pub(crate) depth_m: f64,
    /// Stretch of the shear spring (m) and of the rolling spring (rad).
    pub(crate) shear_m: Vec3,
    pub(crate) roll_rad: Vec3,
}

impl InitialDeformation {
    /// At first contact.
    pub(crate) const NONE: Self = Self {
        depth_m: 0.0,
        shear_m: Vec3::new(0.0, 0.0, 0.0),
        roll_rad: Vec3::new(0.0, 0.0, 0.0),
    };
}

/// The normal motion until the penetration is zero again, or for a part of that time, in units of a
/// speed and of `1/ω`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NormalPassage {
    frame: ContactFrame,
    omega: f64,
    /// The unit of speed (m/s).
    speed: f64,
    /// Gravity; the last component is against the normal.
    gravity: Local,
    /// Penetration and speed into the plane.
    depth: f64,
    inwards: f64,
    /// Force and its rate.
    begin: [f64; 2],
    exit: Exit,
    /// Penetration at the end.
    end_depth: f64,
    deepest: f64,
}

impl NormalPassage {
    /// Duration (s).
    pub(crate) fn time_s(&self) -> f64 {
        (self.exit.lift_off + self.exit.clearing) / self.omega
    }

    /// Whether the penetration is zero at its end.
    pub(crate) fn leaves(&self) -> bool {
        self.end_depth == 0.0
    }

    /// Upper bound of the penetration (m).
    pub(crate) fn deepest_m(&self) -> f64 {
        self.deepest * self.speed / self.omega
    }

    /// Normal impulse over the mass (m/s).
    pub(crate) fn blow_m_s(&self) -> f64 {
        (self.inwards + self.exit.speed + self.gravity[2].max(0.0) * self.exit.lift_off)
            * self.speed
    }
}

impl Plane {
    /// The normal motion of a rock with velocity `v` (m/s) in the plane with unit normal `n` and
    /// the penetration `depth_m`; `None` if gravity keeps it, or nothing pushes it any more.
    pub(crate) fn passage(&self, n: &Vec3, v: &Vec3, depth_m: f64) -> Option<NormalPassage> {
        let frame = ContactFrame::of(n);
        let inwards_m_s = -n.dot(v);
        let is_touch = depth_m == 0.0;
        let speed =
            if is_touch { inwards_m_s } else { math::hypot(inwards_m_s, self.omega * depth_m) };
        let (over, over_force) = (1.0 / speed, 1.0 / (self.omega * speed));
        // gravity in units of acceleration ω times the speed
        let [gx, gy, gn] = frame.local(&self.body.gravity).map(|g| g * over_force);
        let (gamma, oscillator) = (-gn, &self.oscillator);
        let (depth, inwards) =
            if is_touch { (0.0, 1.0) } else { (depth_m * self.omega * over, inwards_m_s * over) };
        let (begin, exit, deepest) = if is_touch {
            (oscillator.onset(gamma), oscillator.exit(gamma)?, oscillator.deepest(gamma))
        } else {
            let begin = oscillator.force_at((depth, inwards), gamma);
            // about the equilibrium with gravity the amplitude of the oscillation does not grow
            let deepest = gamma + math::hypot(depth - gamma, inwards);
            (begin, oscillator.exit_from(begin, gamma)?, deepest)
        };
        let gravity = [gx, gy, gamma];
        Some(NormalPassage {
            frame,
            omega: self.omega,
            speed,
            gravity,
            depth,
            inwards,
            begin,
            exit,
            end_depth: 0.0,
            deepest,
        })
    }

    /// The first part of a passage, for a `share` of the time until lift-off.
    pub(crate) fn part(&self, passage: &NormalPassage, share: f64) -> NormalPassage {
        let lift_off = share * passage.exit.lift_off;
        let (end_depth, inwards) =
            self.oscillator.state_at((passage.begin, passage.gravity[2]), lift_off);
        NormalPassage {
            exit: Exit { lift_off, clearing: 0.0, speed: -inwards },
            end_depth,
            ..*passage
        }
    }

    /// Integrates the tangential motion of a rock with velocity `v` (m/s) and spin `w` (rad/s) on
    /// its `passage`.
    ///
    /// Losses are those of the kinetic and potential energy: energy that springs return is
    /// subtracted, as it was counted among them when it was stored.
    pub(crate) fn pass(
        &self,
        passage: &NormalPassage,
        (v, w): (&Vec3, &Vec3),
        pressed: &InitialDeformation,
    ) -> Rebound {
        let NormalPassage {
            frame,
            speed,
            gravity: [gx, gy, gamma],
            depth,
            inwards,
            exit,
            end_depth,
            ..
        } = *passage;
        let (over, radius) = (1.0 / speed, self.body.radius);
        let (stretch, turn) = (self.omega * over, self.omega * over * radius);
        let (shear, roll) = (frame.along(&pressed.shear_m), frame.local(&pressed.roll_rad));
        let start = ImpactStart {
            v: frame.along(v).map(|v| v * over),
            w: frame.local(w).map(|w| w * (over * radius)),
            shear: self.shear.stretched(shear.map(|x| x * stretch)),
            roll: self.rolling.stretched(roll.map(|x| x * turn)),
            gravity: [gx, gy],
            gamma,
            begin: passage.begin,
            leaves: passage.leaves(),
            // at the largest penetration a rock without velocity has the speed that its springs
            // will give it
            allowed: SMOOTH * self.tolerance * v.norm().max(speed) * over,
        };
        let mut effort = ImpactEffort::default();
        let along = self.tangential_motion(&start, &exit, &mut effort);
        let unit_j = self.body.mass * speed * speed;
        // normal energy: dashpot, and weight over the exit
        let held = 0.5 * (depth * depth - end_depth * end_depth);
        let motion = 0.5 * (inwards * inwards - exit.speed * exit.speed);
        let damped = motion + held - gamma * (depth - end_depth);
        // in units of the penetration by weight alone
        debug_assert!(
            damped >= -1e-9 * (1.0 + gamma * gamma),
            "a spring that gives energy: {passage:?}"
        );
        let damped = damped.max(0.0);
        let [held_shear, held_roll] = self.given_back((&start.shear, &start.roll), &along);
        let [friction, shear, rolling] = along.lost;
        let lost = [friction, damped - held + shear - held_shear, rolling - held_roll];
        let has_sliders = self.shear.is_on() || self.rolling.is_on();
        let (scale, spin) = (speed / self.omega, speed / radius);
        let [x, y] = along.way.map(|x| x * scale);
        let after = InitialDeformation {
            depth_m: end_depth * scale,
            shear_m: frame.out_along(self.shear.stretch(along.shear).map(|x| x / stretch)),
            roll_rad: frame.out_local(self.rolling.stretch(along.roll).map(|x| x / turn)),
        };
        Rebound {
            time_s: passage.time_s(),
            shift_m: frame.out_local([x, y, (depth - end_depth) * scale]),
            velocity_m_s: frame.out_local([along.v[0], along.v[1], exit.speed].map(|v| v * speed)),
            spin_rad_s: if has_sliders { frame.out_local(along.w.map(|w| w * spin)) } else { *w },
            loss: Loss::on_slope(lost.map(|lost| lost * unit_j)),
            pressed: (!start.leaves).then_some(after),
            effort,
        }
    }
}
