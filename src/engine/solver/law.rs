//! The contact law acting on a sphere: normal force, shear force and rolling moment of a contact
//! for a given motion, and at the end of an implicit stage.
//!
//! Forces of springs, dashpots and sliders come from [`Law`]; here they act on mass, lever and
//! spin. A stage of length `h` from `(v*, w*)` is one SDDA solve; eliminated contact by contact it
//! needs no matrix.

use super::body::Body;
use super::contact_frame::ContactFrame;
use super::friction_rolling::{Compliance, FrictionRolling, SlipState};
use crate::contact::Feature;
use crate::contact::history::ContactHistory;
pub(crate) use crate::ground::clamp_norm;
use crate::ground::{Law, NormalElement, SliderForce};
use crate::rock::Vec3;

/// One contact inside a stage: its state at the stage's base and the forces that are sought.
#[derive(Debug, Clone, Copy)]
pub struct StageContact {
    /// Place of its history.
    pub history: usize,
    /// Mesh feature.
    pub feature: Feature,
    /// Triangle whose ground sets the law.
    pub triangle: u32,
    /// Its law.
    pub law: Law,
    /// Normal spring and dashpot in force, those of capture if it is captured.
    pub(crate) normal: NormalElement,
    /// Unit normal from the mesh to the centre.
    pub n: Vec3,
    /// Penetration at the stage's base, along `n` (m).
    pub penetration: f64,
    /// Stretch of the shear spring at the base, tangent to the surface (m).
    pub shear: Vec3,
    /// Stretch of the rolling spring at the base (rad).
    pub roll: Vec3,
    /// Normal force (N), ≥ 0.
    pub normal_force: f64,
    /// Shear force `q`; the rock feels `−q` at the contact point (N).
    pub shear_force: Vec3,
    /// Rolling moment `M`; the rock feels `−M` (N m).
    pub rolling_moment: Vec3,
    /// Which of the two are at their caps, as far as is known: an initial guess for the next
    /// solution.
    pub(crate) mode: SlipState,
}

pub(crate) const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// Forces of a contact at a given motion, and the rates of its springs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactForces {
    /// Slip of the contact point (m/s).
    pub(crate) slip: Vec3,
    /// Normal force (N), ≥ 0, and its value without that bound.
    pub(crate) normal: [f64; 2],
    /// Shear force; the rock feels its opposite at the contact point (N).
    pub(crate) shear: SliderForce,
    /// Rolling moment; the rock feels its opposite (N m).
    pub(crate) rolling: SliderForce,
}

/// Normal, penetration and spring stretches of a contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactDeformation {
    /// Unit normal from the mesh to the centre.
    pub(crate) n: Vec3,
    /// Penetration (m).
    pub(crate) penetration: f64,
    /// Stretch of the shear spring (m) …
    pub(crate) shear: Vec3,
    /// … and of the rolling spring (rad).
    pub(crate) roll: Vec3,
}

impl ContactForces {
    /// Forces with a given normal element, all else by `law`, at velocity `v` and spin `w`.
    #[inline]
    pub(crate) fn of(
        body: &Body,
        law: &Law,
        normal: &NormalElement,
        at: &ContactDeformation,
        (v, w): (&Vec3, &Vec3),
    ) -> Self {
        let unbounded = normal.bilateral_force(at.penetration, at.n.dot(v));
        let normal_force = unbounded.max(0.0);
        let slip = body.slip(&at.n, v, w);
        let shear = law.shear.at_rate(at.shear, slip, law.shear.cap(normal_force));
        let rolling = if law.rolling.is_damped() {
            law.rolling.at_rate(at.roll, *w, law.rolling.cap(normal_force))
        } else {
            SliderForce::default()
        };
        Self { slip, normal: [normal_force, unbounded], shear, rolling }
    }
}

impl StageContact {
    /// No contact.
    pub const NONE: Self = Self {
        history: 0,
        feature: Feature::NONE,
        triangle: 0,
        law: Law::NONE,
        normal: NormalElement::NONE,
        n: ZERO,
        penetration: 0.0,
        shear: ZERO,
        roll: ZERO,
        normal_force: 0.0,
        shear_force: ZERO,
        rolling_moment: ZERO,
        mode: SlipState::Stick,
    };

    /// Solves the forces for a base `(v, w)` without this contact's own effect, over a stage of
    /// length `h`.
    #[inline]
    pub(crate) fn solve(&mut self, body: &Body, v: &Vec3, w: &Vec3, h: f64) {
        self.normal_force = self.normal.stage_force(self.penetration, self.n.dot(v), body.mass, h);
        if self.normal_force <= 0.0 {
            (self.shear_force, self.rolling_moment) = (Vec3::zeros(), Vec3::zeros());
            return;
        }
        let law = &self.law;
        let frame = ContactFrame::of(&self.n);
        let compliance = Compliance::of(body, law, h);
        let slip = body.slip(&self.n, v, w);
        let pair = FrictionRolling {
            compliance: &compliance,
            a: frame.along(&(law.shear.spring_force(self.shear) + slip * compliance.kappa)),
            d: frame.local(&(law.rolling.spring_force(self.roll) + w * compliance.kappa_r)),
            caps: law.limits().caps(self.normal_force),
        };
        let (shear_force, rolling_moment) = pair.solve(&mut self.mode);
        (self.shear_force, self.rolling_moment) =
            (frame.out_along(shear_force), frame.out_local(rolling_moment));
    }

    /// Trial shear force and rolling moment at velocity `v` and spin `w`: those without sliding.
    pub(crate) fn trial_forces(&self, body: &Body, v: &Vec3, w: &Vec3, h: f64) -> (Vec3, Vec3) {
        let law = &self.law;
        let trial_force = law.shear.spring_force(self.shear)
            + body.slip(&self.n, v, w) * law.shear.stage_stiffness(h);
        (trial_force, law.rolling.spring_force(self.roll) + w * law.rolling.stage_stiffness(h))
    }

    /// Change of velocity and spin by this contact's forces over `h`.
    #[inline]
    pub(crate) fn effect(&self, body: &Body, h: f64) -> (Vec3, Vec3) {
        let dv = (self.n * self.normal_force - self.shear_force) * (h / body.mass);
        let dw = (self.n.cross(&self.shear_force) * body.radius - self.rolling_moment)
            * (h / body.inertia);
        (dv, dw)
    }

    /// Penetration at the stage's end (m), where the velocity is `v`.
    #[inline]
    pub fn penetration_at(&self, v: &Vec3, h: f64) -> f64 {
        self.penetration - h * self.n.dot(v)
    }

    /// Whether it is closed at the stage's end.
    #[inline]
    pub fn is_closed(&self, v: &Vec3, h: f64) -> bool {
        self.normal_force > 0.0 || self.penetration_at(v, h) > 0.0
    }

    /// Writes the contact into its history, with its stretches and whether it is closed.
    pub(crate) fn write_history(
        &self,
        (shear, roll): (Vec3, Vec3),
        closed: bool,
        history: &mut ContactHistory,
    ) {
        (history.feature, history.triangle, history.n) = (self.feature, self.triangle, self.n);
        (history.shear, history.roll, history.normal_force) = (shear, roll, self.normal_force);
        history.slides = self.law.shear.slides(self.shear_force.norm(), self.normal_force);
        history.closed = closed;
    }

    /// Stretches at the stage's end: `ξ' = (h q + c_s ξ*)/(h p_s + c_s)`, and the same for rolling.
    #[inline]
    pub fn stretches(&self, h: f64) -> (Vec3, Vec3) {
        let law = &self.law;
        let shear = law.shear.stretch_after(&self.shear_force, &self.shear, h);
        let roll = if law.rolling.stage_stiffness(h) > 0.0 {
            law.rolling.stretch_after(&self.rolling_moment, &self.roll, h)
        } else {
            Vec3::zeros()
        };
        (shear, roll)
    }
}

/// Approach speed below which an impact does not rebound in the rigid limit (m/s).
pub(crate) fn capture_m_s(law: &Law) -> f64 {
    law.rigid_capture_m_s()
}
