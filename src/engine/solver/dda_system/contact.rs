//! A contact in a fixed step, of a sphere with the mesh or of two spheres: its submatrices, and the
//! update of its state.

use super::StepConstants;
use super::slider::{Change, DdaSlider, unit_or_zero};
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, SAME_CONTACT_COSINE, transport};
use crate::contact::submatrix::{
    Mat3x6, Mat6, Vec6, displacement, friction_load, gap, moment_load, normal_load, normal_row,
    normal_stiffness, rolling_stiffness, shear_load, shear_stiffness, slip, touching_point,
};
use crate::contact::{ContactPoint, Feature};
use crate::ground::{FixedStepNormal, FrictionLimits, Law};
use crate::rock::Vec3;
use crate::solver::loss::Loss;

/// Terms of a contact with the mesh that determine its stiffness matrix.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct ContactMatrixTerms {
    v: Vec3,
    p1: Vec3,
    normal: f64,
    shear: f64,
    roll: f64,
}

impl ContactMatrixTerms {
    /// Stiffness matrix, Eqs. (10) and (13).
    pub(super) fn stiffness(&self) -> Mat6 {
        let row = normal_row(&self.v);
        normal_stiffness(self.normal, &row)
            + shear_stiffness(self.shear, &displacement(&self.p1), &row)
            + rolling_stiffness(self.roll)
    }
}

/// Relative displacement at a contact over a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RelativeDisplacement {
    /// Penetration at the end (m), negative when open.
    pub(crate) depth: f64,
    /// Slip of the contact point (m), Eq. (16), of the first sphere relative to the second.
    pub(super) slip: Vec3,
    /// Rotation.
    turn: Vec3,
}

/// One contact of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct DdaContact {
    /// Place of its history.
    pub(crate) history: usize,
    /// Mesh feature.
    pub(crate) feature: Feature,
    /// Triangle whose ground sets the law.
    pub(crate) triangle: u32,
    /// Radius, the smaller one of two (m).
    pub(crate) radius: f64,
    /// `V`, from the centre to the contact point or the other centre, of the step's start.
    pub(super) v: Vec3,
    /// `P1` from the centre (m), Eq. (5), and the same of the second sphere.
    pub(super) points: [Vec3; 2],
    /// `λ` at the step's start (m), Eq. (7).
    pub(super) gap: f64,
    /// Whether it is bonded: it also pulls, and never slides.
    pub(super) bonded: bool,
    pub(super) normal: FixedStepNormal,
    pub(super) limits: FrictionLimits,
    pub(super) shear: DdaSlider,
    pub(super) roll: DdaSlider,
    /// Whether the shear spring keeps its stretch; if not, as printed in the paper.
    pub(super) shear_memory: bool,
    /// Normal force at the end of the last step (N): the printed scheme takes the cap of friction
    /// from it.
    pub(super) last_normal_force: f64,
    /// Normal force of the last state update (N), positive in compression.
    pub(super) normal_force: f64,
    /// Whether it is closed.
    pub(super) closed: bool,
}

impl DdaContact {
    /// A contact with the elements of a law over the step; `compliance` is displacement per unit of
    /// shear force (m/N) and rotation per unit of moment.
    pub(super) fn new(
        step: &StepConstants,
        law: &Law,
        captured: bool,
        (shear, turn): (f64, f64),
    ) -> Self {
        Self {
            normal: law.normal_over_step(captured, step.dt),
            limits: law.limits(),
            shear: DdaSlider::new(&law.shear, step.dt, shear),
            roll: DdaSlider::new(&law.rolling, step.dt, turn),
            shear_memory: step.shear_memory,
            ..Self::default()
        }
    }

    /// The contact of a contact point and its history (number `k`).
    pub(super) fn with_mesh(
        step: &StepConstants,
        law: &Law,
        touch: &ContactPoint,
        (k, history): (usize, &ContactHistory),
    ) -> Self {
        let v = -touch.normal;
        let p1 = touching_point(&v, step.radius);
        let mut contact = Self {
            history: k,
            feature: touch.feature,
            triangle: touch.triangle,
            radius: step.radius,
            v,
            points: [p1, Vec3::zeros()],
            gap: gap(&v, &p1, &(v * touch.distance_m)),
            ..Self::new(step, law, history.captured, step.compliance)
        };
        contact.roll.stretch = history.roll;
        let stretch = transport(history.shear, &history.n, &touch.normal);
        let free = contact.relative_displacement(&step.free);
        let left = (history.normal_force, stretch);
        contact.begin((history.closed, history.slides), left, &free);
        contact
    }

    /// Sets the initial state: as it was left, open or closed and sliding or not, with its normal
    /// force (N) and stretch (m), or as these and the free motion suggest.
    pub(super) fn begin(
        &mut self,
        (closed, slides): (bool, bool),
        (push, stretch): (f64, Vec3),
        free: &RelativeDisplacement,
    ) {
        self.last_normal_force = push;
        if self.shear_memory {
            self.shear.stretch = stretch;
        } else {
            self.shear.damper = 0.0;
        }
        self.closed = closed || free.depth > 0.0;
        if push <= 0.0 || self.bonded {
            return;
        }
        let (cap, roll_cap) = self.limits.caps(push);
        if self.shear_memory {
            self.shear.update_state(&free.slip, &Vec3::zeros(), cap);
        } else if slides {
            (self.shear.slides, self.shear.friction) = (true, unit_or_zero(&free.slip) * cap);
        }
        if self.limits.has_rolling() {
            self.roll.update_state(&free.turn, &Vec3::zeros(), roll_cap);
        }
    }

    /// Relative displacement for the displacement `d` of its sphere.
    pub(crate) fn relative_displacement(&self, d: &Vec6) -> RelativeDisplacement {
        self.relative_to(d, &(displacement(&self.points[0]) * d))
    }

    /// Relative displacement for `d` of a sphere and `u` of its contact point, both relative to the
    /// other sphere's if there is one.
    pub(super) fn relative_to(&self, d: &Vec6, u: &Vec3) -> RelativeDisplacement {
        let turn = d.fixed_rows::<3>(3).into();
        RelativeDisplacement { depth: self.depth(d), slip: slip(&self.v, u), turn }
    }

    fn depth(&self, d: &Vec6) -> f64 {
        normal_row(&self.v).dot(d) - self.gap
    }

    /// Whether a contact point after `d` is where this contact has moved to: no deeper, on a
    /// surface that continues it.
    pub(crate) fn moves_to(&self, touch: &ContactPoint, d: &Vec6) -> bool {
        let deeper = self.radius - touch.distance_m - self.depth(d);
        -self.v.dot(&touch.normal) > SAME_CONTACT_COSINE && deeper <= TOUCH * self.radius
    }

    /// Penetration at the start (m), 0 when open: the dashpot begins at the contact.
    fn start_penetration(&self) -> f64 {
        if self.bonded { -self.gap } else { (-self.gap).max(0.0) }
    }

    /// Normal force at a depth (N), of spring and dashpot; negative only in a bond.
    ///
    /// The dashpot acts from the contact on. Then the force grows continuously from zero with the
    /// penetration, and every set of contacts has one consistent state; with a dashpot that acts on
    /// the approach there might be none.
    pub(super) fn pull_or_push(&self, depth: f64) -> f64 {
        self.normal.force(depth, self.start_penetration())
    }

    /// Shear force (N) and rolling moment (N m), against slip and turn.
    pub(super) fn forces(&self, relative: &RelativeDisplacement) -> (Vec3, Vec3) {
        if !self.closed {
            return (Vec3::zeros(), Vec3::zeros());
        }
        let has_rolling = self.limits.has_rolling();
        let moment = if has_rolling { self.roll.force(&relative.turn) } else { Vec3::zeros() };
        (self.shear.force(&relative.slip), moment)
    }

    /// Its springs and dashpots in force.
    pub(super) fn terms(&self) -> ContactMatrixTerms {
        let [normal, shear] = self.stiffnesses();
        let roll = self.roll.stiffness(self.closed && self.limits.has_rolling());
        ContactMatrixTerms { v: self.v, p1: self.points[0], normal, shear, roll }
    }

    /// Stiffness in force along `V` and along the surface (N/m).
    pub(super) fn stiffnesses(&self) -> [f64; 2] {
        let normal = if self.closed { self.normal.stiffness() } else { 0.0 };
        [normal, self.shear.stiffness(self.closed)]
    }

    /// Load of the normal element, Eq. (11).
    pub(super) fn normal_load(&self) -> Vec6 {
        let stiff = self.normal.load_stiffness(self.bonded || self.gap < 0.0);
        normal_load(stiff, self.gap, &normal_row(&self.v))
    }

    /// Load of the shear element, Eq. (14), or of friction, Eqs. (17) and (18).
    pub(super) fn shear_load(&self, t: &Mat3x6) -> Vec6 {
        if self.shear.slides {
            friction_load(t, &self.shear.friction)
        } else {
            shear_load(self.shear.spring, t, &self.shear.stretch)
        }
    }

    /// Adds the loads of a contact with the mesh to `F`.
    pub(super) fn add_load(&self, f: &mut Vec6) {
        if !self.closed {
            return;
        }
        *f += self.normal_load();
        *f += self.shear_load(&displacement(&self.points[0]));
        if self.limits.has_rolling() {
            *f -= moment_load(&self.roll.force(&Vec3::zeros()));
        }
    }

    /// Sets the normal force at a depth; whether it is closed there. A contact without bond is open
    /// where it would pull.
    fn update_normal_force(&mut self, depth: f64) -> bool {
        let force = self.pull_or_push(depth);
        self.normal_force = if self.bonded { force } else { force.max(0.0) };
        self.bonded || force > 0.0
    }

    /// Opens or closes by the sign of the normal force; whether the state changed.
    fn open_or_close(&mut self, depth: f64) -> bool {
        let closed = self.update_normal_force(depth);
        std::mem::replace(&mut self.closed, closed) != closed
    }

    /// Updates its state by the displacements found, where both disagree; the change. Forces are
    /// those of the present solution, before it opens or closes.
    pub(crate) fn update_state(&mut self, relative: &RelativeDisplacement) -> Change {
        let (shear_force, moment) = self.forces(relative);
        let change = if self.open_or_close(relative.depth) { Change::Mode } else { Change::None };
        if !self.closed || self.bonded {
            return change;
        }
        let (cap, roll_cap) = self.limits.caps(self.normal_force);
        let change = change.max(if self.shear_memory {
            self.shear.update_state(&relative.slip, &shear_force, cap)
        } else {
            self.shear.update_state_as_printed(
                &relative.slip,
                cap,
                self.limits.caps(self.last_normal_force).0,
            )
        });
        if !self.limits.has_rolling() {
            return change;
        }
        change.max(self.roll.update_state(&relative.turn, &moment, roll_cap))
    }

    /// Fixes its state for the fallback solution: closed and sticking for this step if it begins
    /// inside, else frictionless.
    pub(crate) fn stick(&mut self) {
        let apart = self.begins_apart();
        self.closed |= !apart;
        self.shear.slides = apart || !self.limits.has_friction() && !self.bonded;
        self.roll.slides = apart;
        (self.shear.friction, self.roll.friction) = (Vec3::zeros(), Vec3::zeros());
    }

    /// Whether it begins apart; a bond never does.
    fn begins_apart(&self) -> bool {
        self.gap > TOUCH * self.radius && !self.bonded
    }

    /// After [`Self::stick`]: opens or closes if it begins apart; whether the state changed.
    pub(crate) fn open_or_close_apart(&mut self, relative: &RelativeDisplacement) -> bool {
        if self.begins_apart() {
            return self.open_or_close(relative.depth);
        }
        self.update_normal_force(relative.depth);
        false
    }

    /// Energy that its dashpots and sliders take (J).
    pub(crate) fn loss(&self, relative: &RelativeDisplacement) -> Loss {
        let (shear_force, moment) = self.forces(relative);
        let damping = self.normal.loss_j(self.closed, relative.depth, self.start_penetration());
        let mut loss = Loss { damping, ..Loss::default() };
        if self.shear_memory {
            let (friction, damping) = self.shear.loss(&relative.slip, &shear_force);
            loss.friction = friction;
            loss.damping += damping;
        } else if self.shear.slides {
            loss.friction = shear_force.dot(&relative.slip);
        }
        if self.limits.has_rolling() {
            let (slider, dashpot) = self.roll.loss(&relative.turn, &moment);
            loss.rolling = slider + dashpot;
        }
        loss
    }

    /// Increase of the energy of its springs over the step (J). A shear spring that opens loses its
    /// energy in its own dashpot, and counts as if it still held it.
    pub(super) fn stored_more_j(&self, relative: &RelativeDisplacement) -> f64 {
        let depth = if self.bonded { relative.depth } else { relative.depth.max(0.0) };
        let sheared = if self.shear_memory {
            self.shear.stored_more_j(&self.forces(relative).0)
        } else {
            0.0
        };
        self.normal.stored_more_j(depth, self.start_penetration()) + sheared
    }

    /// State at the step's end: whether it is closed, whether it slides, and the stretch of its
    /// shear spring (m).
    pub(super) fn end_state(&self, relative: &RelativeDisplacement) -> (bool, bool, Vec3) {
        let stretch = if self.shear_memory {
            self.shear.stretch_after(&self.forces(relative).0)
        } else {
            Vec3::zeros()
        };
        (self.closed || relative.depth > 0.0, self.closed && self.shear.slides, stretch)
    }

    /// Writes the step's end into its history.
    pub(crate) fn write_history(
        &self,
        relative: &RelativeDisplacement,
        history: &mut ContactHistory,
    ) {
        (history.feature, history.triangle, history.n) = (self.feature, self.triangle, -self.v);
        (history.closed, history.slides, history.shear) = self.end_state(relative);
        history.normal_force = self.normal_force;
        if self.limits.has_rolling() {
            history.roll = self.roll.stretch_after(&self.forces(relative).1);
        }
    }
}
