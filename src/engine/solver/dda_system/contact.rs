//! One contact inside a fixed step, of a sphere with the mesh or of two spheres: its submatrices, and the judgement of its state.

use super::StepConstants;
use super::slider::{Change, DdaSlider, unit_or_zero};
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, SAME_GRIP, carry};
use crate::contact::submatrix::{
    Mat3x6, Mat6, Vec6, displacement, friction_load, gap, moment_load, normal_load, normal_row,
    normal_stiffness, rolling_stiffness, shear_load, shear_stiffness, slip, touching_point,
};
use crate::contact::{ContactPoint, Feature};
use crate::ground::{FixedStepNormal, FrictionLimits, Law};
use crate::rock::Vec3;
use crate::solver::loss::Loss;

/// What of a contact with the mesh the matrix is made of.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct ContactMatrixTerms {
    v: Vec3,
    p1: Vec3,
    normal: f64,
    shear: f64,
    roll: f64,
}

impl ContactMatrixTerms {
    /// Its stiffness, Eqs. (10) and (13).
    pub(super) fn stiffness(&self) -> Mat6 {
        let row = normal_row(&self.v);
        normal_stiffness(self.normal, &row)
            + shear_stiffness(self.shear, &displacement(&self.p1), &row)
            + rolling_stiffness(self.roll)
    }
}

/// What a contact sees of the displacements of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RelativeDisplacement {
    /// Penetration at the end (m), negative when apart.
    pub(crate) depth: f64,
    /// Slip of the touched point (m), Eq. (16), of the first sphere relative to the second.
    pub(super) slip: Vec3,
    /// Rotation.
    turn: Vec3,
}

/// One contact of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct DdaContact {
    /// Its memory.
    pub(crate) history: usize,
    /// Where on the mesh.
    pub(crate) feature: Feature,
    /// Triangle whose ground answers.
    pub(crate) triangle: u32,
    /// Radius, the smaller one of two (m).
    pub(crate) radius: f64,
    /// `V`, from the centre to the touched point or the other centre, frozen at the step's start.
    pub(super) v: Vec3,
    /// `P1` from the centre (m), Eq. (5), and the same of the second sphere.
    pub(super) points: [Vec3; 2],
    /// `λ` at the step's start (m), Eq. (7).
    pub(super) gap: f64,
    /// Whether it pulls as well as it pushes, and never slides.
    pub(super) bonded: bool,
    pub(super) normal: FixedStepNormal,
    pub(super) limits: FrictionLimits,
    pub(super) shear: DdaSlider,
    pub(super) roll: DdaSlider,
    /// Whether the shear spring remembers; without, as printed.
    pub(super) shear_memory: bool,
    /// Normal force at the end of the last step (N): the printed scheme caps friction by it.
    pub(super) last_normal_force: f64,
    /// Normal force of the last judgement (N), positive when pressing.
    pub(super) normal_force: f64,
    /// Not open.
    pub(super) closed: bool,
}

impl DdaContact {
    /// The elements of a law over the step; a unit of shear force takes `compliance` (m/N) off the way.
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

    /// The contact of a touch and its memory (number `k`).
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
        let stretch = carry(history.shear, &history.n, &touch.normal);
        let free = contact.relative_displacement(&step.free);
        let left = (history.normal_force, stretch);
        contact.begin((history.closed, history.slides), left, &free);
        contact
    }

    /// Begins in the state in which it was left, open or closed and sliding or not, with its normal force (N) and stretch (m), or in
    /// that which these and the free motion suggest.
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

    /// What it sees of the displacement `d` of its sphere.
    pub(crate) fn relative_displacement(&self, d: &Vec6) -> RelativeDisplacement {
        self.relative_to(d, &(displacement(&self.points[0]) * d))
    }

    /// What it sees of the displacements `d` of a sphere and `u` of the touched point, or of those relative to the other sphere's.
    pub(super) fn relative_to(&self, d: &Vec6, u: &Vec3) -> RelativeDisplacement {
        let turn = d.fixed_rows::<3>(3).into();
        RelativeDisplacement { depth: self.depth(d), slip: slip(&self.v, u), turn }
    }

    fn depth(&self, d: &Vec6) -> f64 {
        normal_row(&self.v).dot(d) - self.gap
    }

    /// Whether a touch after `d` is where this contact has got to: no deeper in a surface no steeper.
    pub(crate) fn moves_to(&self, touch: &ContactPoint, d: &Vec6) -> bool {
        let deeper = self.radius - touch.distance_m - self.depth(d);
        -self.v.dot(&touch.normal) > SAME_GRIP && deeper <= TOUCH * self.radius
    }

    /// Penetration at the start (m), 0 when apart: the dashpot begins at the touch.
    fn inside(&self) -> f64 {
        if self.bonded { -self.gap } else { (-self.gap).max(0.0) }
    }

    /// Normal force at a depth (N): spring and dashpot, the dashpot working from the touch on; negative only in a bond.
    ///
    /// Counted from the touch the force grows steadily from nothing as the rock gets in, so every set of contacts has
    /// one state that fits; a dashpot that worked on the way there would leave none.
    pub(super) fn pull_or_push(&self, depth: f64) -> f64 {
        self.normal.force(depth, self.inside())
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

    /// Takes the normal force at a depth; whether it presses there. A contact without bond is open where it would pull.
    fn press(&mut self, depth: f64) -> bool {
        let force = self.pull_or_push(depth);
        self.normal_force = if self.bonded { force } else { force.max(0.0) };
        self.bonded || force > 0.0
    }

    /// Opens or closes as the normal force asks; whether that changed anything.
    fn open_or_close(&mut self, depth: f64) -> bool {
        let closed = self.press(depth);
        std::mem::replace(&mut self.closed, closed) != closed
    }

    /// Compares its state with the displacements that came out, and changes it where they do not agree.
    /// Forces are those of the solution in hand, before it opens or closes.
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

    /// Ends the search for its state: closed and sticking for this step if it begins inside, else without friction.
    pub(crate) fn stick(&mut self) {
        let apart = self.begins_apart();
        self.closed |= !apart;
        self.shear.slides = apart || !self.limits.has_friction() && !self.bonded;
        self.roll.slides = apart;
        (self.shear.friction, self.roll.friction) = (Vec3::zeros(), Vec3::zeros());
    }

    /// A bond is there at any distance.
    fn begins_apart(&self) -> bool {
        self.gap > TOUCH * self.radius && !self.bonded
    }

    /// After [`Self::stick`]: opens or closes if it begins apart; whether that changed anything.
    pub(crate) fn open_or_close_apart(&mut self, relative: &RelativeDisplacement) -> bool {
        if self.begins_apart() {
            return self.open_or_close(relative.depth);
        }
        self.press(relative.depth);
        false
    }

    /// Energy that its dashpots and sliders take (J).
    pub(crate) fn loss(&self, relative: &RelativeDisplacement) -> Loss {
        let (shear_force, moment) = self.forces(relative);
        let damping = self.normal.loss_j(self.closed, relative.depth, self.inside());
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

    /// How much more its springs hold at the step's end than at its start (J); a shear spring that is let go runs out against its own dashpot, and
    /// counts as if it still held.
    pub(super) fn stored_more_j(&self, relative: &RelativeDisplacement) -> f64 {
        let depth = if self.bonded { relative.depth } else { relative.depth.max(0.0) };
        let sheared = if self.shear_memory {
            self.shear.stored_more_j(&self.forces(relative).0)
        } else {
            0.0
        };
        self.normal.stored_more_j(depth, self.inside()) + sheared
    }

    /// Whether it was closed at the step's end, whether it slid, and the stretch that its shear spring has left (m).
    pub(super) fn end_state(&self, relative: &RelativeDisplacement) -> (bool, bool, Vec3) {
        let stretch = if self.shear_memory {
            self.shear.stretch_after(&self.forces(relative).0)
        } else {
            Vec3::zeros()
        };
        (self.closed || relative.depth > 0.0, self.closed && self.shear.slides, stretch)
    }

    /// Writes what it remembers of the step into its memory.
    pub(crate) fn remember(&self, relative: &RelativeDisplacement, history: &mut ContactHistory) {
        (history.feature, history.triangle, history.n) = (self.feature, self.triangle, -self.v);
        (history.closed, history.slides, history.shear) = self.end_state(relative);
        history.normal_force = self.normal_force;
        if self.limits.has_rolling() {
            history.roll = self.roll.stretch_after(&self.forces(relative).1);
        }
    }
}
