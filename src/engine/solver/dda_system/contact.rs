//! One contact inside a fixed step: its submatrices, and the judgement of its state.

use super::slider::{Change, DdaSlider, along};
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, SAME_GRIP, carry};
use crate::contact::submatrix::{
    Mat6, Vec6, displacement, friction_load, gap, moment_load, normal_load, normal_row,
    normal_stiffness, rolling_stiffness, shear_load, shear_stiffness, slip, touching_point,
};
use crate::contact::{ContactPoint, Feature};
use crate::ground::{FixedStepNormal, FrictionLimits, Law};
use crate::rock::Vec3;
use crate::solver::loss::Loss;

/// What is the same for all contacts of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepConstants {
    /// Length (s).
    pub dt: f64,
    /// Displacement and rotation without contacts.
    pub free: Vec6,
    /// Radius of the sphere (m).
    pub radius: f64,
    /// Way of the touched point per newton along the surface (m/N) and turn of the sphere per newton metre.
    pub compliance: (f64, f64),
    /// Whether shear springs keep their stretch; if not, friction is that of the last step's end, as printed.
    pub shear_memory: bool,
}

/// What of a contact the matrix is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ContactMatrixTerms {
    v: Vec3,
    p1: Vec3,
    normal: f64,
    shear: f64,
    roll: f64,
}

impl ContactMatrixTerms {
    /// No contact.
    pub(crate) const NONE: Self = Self {
        v: Vec3::new(0.0, 0.0, 0.0),
        p1: Vec3::new(0.0, 0.0, 0.0),
        normal: 0.0,
        shear: 0.0,
        roll: 0.0,
    };

    /// Its stiffness.
    pub(crate) fn stiffness(&self) -> Mat6 {
        let row = normal_row(&self.v);
        normal_stiffness(self.normal, &row)
            + shear_stiffness(self.shear, &displacement(&self.p1), &row)
            + rolling_stiffness(self.roll)
    }
}

/// One contact of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DdaContact {
    /// Its memory.
    pub history: usize,
    /// Where on the mesh.
    pub feature: Feature,
    /// Triangle whose ground answers.
    pub triangle: u32,
    /// `V`, from the centre to the touched point.
    v: Vec3,
    /// `P1` from the centre (m).
    p1: Vec3,
    radius: f64,
    /// `λ` at the step's start (m).
    gap: f64,
    element: FixedStepNormal,
    limits: FrictionLimits,
    /// Normal force at the end of the last step (N).
    push_before: f64,
    /// Normal force (N).
    pub normal_force: f64,
    /// Not open.
    pub presses: bool,
    pub shear: DdaSlider,
    pub roll: DdaSlider,
    shear_memory: bool,
}

impl DdaContact {
    /// No contact.
    pub(crate) const NONE: Self = Self {
        history: 0,
        feature: Feature::NONE,
        triangle: 0,
        v: Vec3::new(0.0, 0.0, 0.0),
        p1: Vec3::new(0.0, 0.0, 0.0),
        radius: 0.0,
        gap: 0.0,
        element: FixedStepNormal::NONE,
        limits: FrictionLimits::NONE,
        push_before: 0.0,
        normal_force: 0.0,
        presses: false,
        shear: DdaSlider::NONE,
        roll: DdaSlider::NONE,
        shear_memory: true,
    };

    /// The contact of a touch and its memory (number `k`), in the state in which it was left or will likely be.
    pub(crate) fn new(
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
            v,
            p1,
            radius: step.radius,
            gap: gap(&v, &p1, &(v * touch.distance_m)),
            element: law.normal_over_step(history.captured, step.dt),
            limits: law.limits(),
            push_before: history.normal_force,
            shear: DdaSlider::new(&law.shear, step.dt, step.compliance.0),
            roll: DdaSlider {
                stretch: history.roll,
                ..DdaSlider::new(&law.rolling, step.dt, step.compliance.1)
            },
            shear_memory: step.shear_memory,
            ..Self::NONE
        };
        if step.shear_memory {
            contact.shear.stretch = carry(history.shear, &history.n, &touch.normal);
        } else {
            contact.shear.damper = 0.0;
        }
        contact.presses = history.closed || contact.depth(&step.free) > 0.0;
        contact.expect(&step.free, history);
        contact
    }

    /// Begins with the sliders' state that the free motion and the last normal force suggest.
    fn expect(&mut self, free: &Vec6, history: &ContactHistory) {
        if history.normal_force <= 0.0 {
            return;
        }
        let (way, turn) = self.ways(free);
        let cap = self.limits.caps(history.normal_force).0;
        if self.shear_memory {
            self.shear.judge(&way, &Vec3::zeros(), cap);
        } else if history.slides {
            (self.shear.slides, self.shear.friction) = (true, along(&way) * cap);
        }
        if self.limits.has_rolling() {
            self.roll.judge(&turn, &Vec3::zeros(), self.limits.caps(history.normal_force).1);
        }
    }

    /// Penetration after the displacement `d` (m), negative when apart.
    pub(crate) fn depth(&self, d: &Vec6) -> f64 {
        normal_row(&self.v).dot(d) - self.gap
    }

    /// Whether a touch after `d` is where this contact has got to: no deeper in a surface no steeper.
    pub(crate) fn leads_to(&self, touch: &ContactPoint, d: &Vec6) -> bool {
        let deeper = self.radius - touch.distance_m - self.depth(d);
        -self.v.dot(&touch.normal) > SAME_GRIP && deeper <= TOUCH * self.radius
    }

    /// Slip of the touched point, Eq. (16), and rotation.
    fn ways(&self, d: &Vec6) -> (Vec3, Vec3) {
        (slip(&self.v, &(displacement(&self.p1) * d)), d.fixed_rows::<3>(3).into())
    }

    /// Penetration at the start (m), 0 when apart.
    fn inside(&self) -> f64 {
        (-self.gap).max(0.0)
    }

    /// Normal force after `d` (N): spring and dashpot, the dashpot working from the touch on.
    ///
    /// Counted from the touch the force grows steadily from nothing as the rock gets in, so every set of contacts has
    /// one state that fits; a dashpot that worked on the way there would leave none.
    fn normal_force(&self, d: &Vec6) -> f64 {
        self.element.force(self.depth(d), self.inside())
    }

    /// Its springs and dashpots in force.
    pub(crate) fn shape(&self) -> ContactMatrixTerms {
        let of = |slider: &DdaSlider, acts: bool| {
            if acts && !slider.slides { slider.spring + slider.damper } else { 0.0 }
        };
        ContactMatrixTerms {
            v: self.v,
            p1: self.p1,
            normal: if self.presses { self.element.stiffness() } else { 0.0 },
            shear: of(&self.shear, self.presses),
            roll: of(&self.roll, self.presses && self.limits.has_rolling()),
        }
    }

    /// Adds its loads to `F`.
    pub(crate) fn add_load(&self, f: &mut Vec6) {
        if !self.presses {
            return;
        }
        let t = displacement(&self.p1);
        let stiff = self.element.load_stiffness(self.gap);
        *f += normal_load(stiff, self.gap, &normal_row(&self.v));
        *f += if self.shear.slides {
            friction_load(&t, &self.shear.friction)
        } else {
            shear_load(self.shear.spring, &t, &self.shear.stretch)
        };
        if self.limits.has_rolling() {
            *f -= moment_load(&self.roll.force(&Vec3::zeros()));
        }
    }

    /// Opens or closes as the normal force after the displacement `d` asks; whether that changed anything.
    pub(crate) fn open_or_close(&mut self, d: &Vec6) -> bool {
        self.normal_force = self.normal_force(d).max(0.0);
        std::mem::replace(&mut self.presses, self.normal_force > 0.0) != self.presses
    }

    /// Compares its state with the displacement `d` that came out, and changes it where they do not agree.
    pub(crate) fn judge(&mut self, d: &Vec6) -> Change {
        let (shear_force, rolling_moment) = self.forces(d);
        let mut change = if self.open_or_close(d) { Change::Mode } else { Change::None };
        if self.presses {
            let (way, turn) = self.ways(d);
            let cap = self.limits.caps(self.normal_force).0;
            change = change.max(if self.shear_memory {
                self.shear.judge(&way, &shear_force, cap)
            } else {
                let before = self.limits.caps(self.push_before).0;
                self.shear.judge_as_printed(&way, cap, before)
            });
            if self.limits.has_rolling() {
                change = change.max(self.roll.judge(
                    &turn,
                    &rolling_moment,
                    self.limits.caps(self.normal_force).1,
                ));
            }
        }
        change
    }

    /// Ends the search for its state: closed and sticking for this step if it begins inside, else without friction.
    pub(crate) fn stick(&mut self) {
        let apart = self.begins_apart();
        self.presses |= !apart;
        self.shear.slides = apart || !self.limits.has_friction();
        self.roll.slides = apart;
        (self.shear.friction, self.roll.friction) = (Vec3::zeros(), Vec3::zeros());
    }

    fn begins_apart(&self) -> bool {
        self.gap > TOUCH * self.radius
    }

    /// After [`Self::stick`]: opens or closes if it begins apart; whether that changed anything.
    pub(crate) fn open_or_close_apart(&mut self, d: &Vec6) -> bool {
        if self.begins_apart() {
            return self.open_or_close(d);
        }
        self.normal_force = self.normal_force(d).max(0.0);
        false
    }

    /// Shear force and rolling moment after `d`.
    fn forces(&self, d: &Vec6) -> (Vec3, Vec3) {
        let (way, turn) = self.ways(d);
        if !self.presses {
            (Vec3::zeros(), Vec3::zeros())
        } else if self.limits.has_rolling() {
            (self.shear.force(&way), self.roll.force(&turn))
        } else {
            (self.shear.force(&way), Vec3::zeros())
        }
    }

    /// Energy that its dashpots and sliders take over `d` (J).
    pub(crate) fn loss(&self, d: &Vec6) -> Loss {
        let (shear_force, rolling_moment) = self.forces(d);
        let (way, turn) = self.ways(d);
        let damping = self.element.loss_j(self.presses, self.depth(d), self.inside());
        let mut loss = Loss { damping, ..Loss::default() };
        if self.shear_memory {
            let (friction, damping) = self.shear.loss(&way, &shear_force);
            loss.friction = friction;
            loss.damping += damping;
        } else if self.shear.slides {
            loss.friction = shear_force.dot(&way);
        }
        if self.limits.has_rolling() {
            let (slider, dashpot) = self.roll.loss(&turn, &rolling_moment);
            loss.rolling = slider + dashpot;
        }
        loss
    }

    /// Writes what it remembers of the step into its memory.
    pub(crate) fn remember(&self, d: &Vec6, history: &mut ContactHistory) {
        let (shear_force, rolling_moment) = self.forces(d);
        (history.feature, history.triangle, history.n) = (self.feature, self.triangle, -self.v);
        if self.shear_memory {
            history.shear = self.shear.end(&shear_force);
        }
        if self.limits.has_rolling() {
            history.roll = self.roll.end(&rolling_moment);
        }
        history.normal_force = self.normal_force;
        history.slides = self.presses && self.shear.slides;
        history.closed = self.presses || self.depth(d) > 0.0;
    }
}
