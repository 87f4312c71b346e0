//! One contact inside a fixed step: its springs, dashpots and sliders, and the judgement of their states.

use crate::contact::hold::{Hold, carry};
use crate::contact::submatrix::{
    Mat6, Vec6, displacement, friction_cap, friction_load, gap, moment_load, normal_load,
    normal_row, normal_stiffness, rolling_stiffness, shear_load, shear_stiffness, slip,
    touching_point,
};
use crate::contact::{Feature, Touch};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::step::grip::Loss;

/// Change of a friction force, relative to its cap, below which it has settled (–).
const SETTLED: f64 = 1e-6;

/// What a judgement changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Change {
    /// Nothing.
    None,
    /// A friction force: the right-hand side.
    Load,
    /// Open, sliding or sticking: the matrix.
    Mode,
}

/// What is the same for all contacts of a step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Length (s).
    pub dt: f64,
    /// Displacement and rotation without contacts.
    pub free: Vec6,
    /// Radius of the sphere (m).
    pub radius: f64,
    /// Whether shear springs keep their stretch; if not, friction is that of the last step's end, as printed.
    pub shear_memory: bool,
}

/// A spring beside a dashpot, in series with a slider: shear (m, N) or rolling (rad, N m).
#[derive(Debug, Clone, Copy)]
struct Slider {
    /// Stretch at the step's start.
    stretch: Vec3,
    /// Stiffness.
    spring: f64,
    /// Damping over the step's length.
    damper: f64,
    slides: bool,
    /// Force while it slides.
    friction: Vec3,
}

impl Slider {
    const NONE: Self = Self {
        stretch: Vec3::new(0.0, 0.0, 0.0),
        spring: 0.0,
        damper: 0.0,
        slides: false,
        friction: Vec3::new(0.0, 0.0, 0.0),
    };

    /// Force after `way`, should it stick.
    fn sticking(&self, way: &Vec3) -> Vec3 {
        self.stretch * self.spring + way * (self.spring + self.damper)
    }

    fn force(&self, way: &Vec3) -> Vec3 {
        if self.slides { self.friction } else { self.sticking(way) }
    }

    /// Stretch that belongs to a force at the step's end.
    fn end(&self, force: &Vec3) -> Vec3 {
        (force + self.stretch * self.damper) / (self.spring + self.damper)
    }

    /// Slides where the force to stick passes the cap, in that force's direction.
    fn judge(&mut self, way: &Vec3, cap: f64) -> Change {
        let needed = self.sticking(way);
        let size = needed.norm();
        // At the cap itself rounding must not turn it to and fro.
        let slides = size > if self.slides { cap * (1.0 - SETTLED) } else { cap } || cap <= 0.0;
        let friction = if slides && size > 0.0 { needed * (cap / size) } else { Vec3::zeros() };
        let change = if slides != self.slides {
            Change::Mode
        } else if slides && (friction - self.friction).norm() > SETTLED * cap {
            Change::Load
        } else {
            return Change::None;
        };
        (self.slides, self.friction) = (slides, friction);
        change
    }

    /// The same as printed: friction is `before`, that of the last step's end, and acts against the displacement of the
    /// step until that turns round.
    fn judge_as_printed(&mut self, way: &Vec3, cap: f64, before: f64) -> Change {
        if !self.slides && self.sticking(way).norm() > cap {
            (self.slides, self.friction) = (true, along(way) * before);
            Change::Mode
        } else if self.slides && way.dot(&self.friction) < 0.0 {
            (self.slides, self.friction) = (false, Vec3::zeros());
            Change::Mode
        } else {
            Change::None
        }
    }

    /// Energy that slider and dashpot take over `way` at `force`.
    fn loss(&self, way: &Vec3, force: &Vec3) -> (f64, f64) {
        let stretched = self.end(force) - self.stretch;
        (force.dot(&(way - stretched)), self.damper * stretched.norm_squared())
    }
}

/// The direction of `x`; nothing for nothing.
fn along(x: &Vec3) -> Vec3 {
    x.try_normalize(0.0).unwrap_or_default()
}

/// One contact of a step.
#[derive(Debug, Clone, Copy)]
pub struct Joint {
    /// Its memory.
    pub hold: usize,
    /// Where on the mesh.
    pub feature: Feature,
    /// Triangle whose ground answers.
    pub triangle: u32,
    /// `V`, from the centre to the touched point.
    v: Vec3,
    /// `P1` from the centre (m).
    p1: Vec3,
    /// `λ` at the step's start (m).
    gap: f64,
    p_n: f64,
    /// Normal damping over the step's length (N/m).
    damper: f64,
    tan_phi: f64,
    rolling_m: f64,
    /// Normal force at the end of the last step (N).
    push_before: f64,
    /// Normal force (N).
    push: f64,
    /// Not open.
    presses: bool,
    shear: Slider,
    roll: Slider,
    shear_memory: bool,
    /// Whether the last judgement changed its mode.
    contested: bool,
}

impl Joint {
    /// No contact.
    pub const NONE: Self = Self {
        hold: 0,
        feature: Feature::NONE,
        triangle: 0,
        v: Vec3::new(0.0, 0.0, 0.0),
        p1: Vec3::new(0.0, 0.0, 0.0),
        gap: 0.0,
        p_n: 0.0,
        damper: 0.0,
        tan_phi: 0.0,
        rolling_m: 0.0,
        push_before: 0.0,
        push: 0.0,
        presses: false,
        shear: Slider::NONE,
        roll: Slider::NONE,
        shear_memory: true,
        contested: false,
    };

    /// The contact of a touch and its memory (number `k`), in the state in which it was left or will likely be.
    pub fn new(step: &Step, law: &Law, touch: &Touch, (k, hold): (usize, &Hold)) -> Self {
        let v = -touch.normal;
        let p1 = touching_point(&v, step.radius);
        let has_dashpots = law.c_s > 0.0;
        let c_n = if hold.captured && has_dashpots { law.c_n_captured } else { law.c_n };
        let mut joint = Self {
            hold: k,
            feature: touch.feature,
            triangle: touch.triangle,
            v,
            p1,
            gap: gap(&v, &p1, &(v * touch.distance_m)),
            p_n: law.p_n,
            damper: c_n / step.dt,
            tan_phi: law.friction,
            rolling_m: law.rolling_m,
            push_before: hold.push,
            shear: Slider { spring: law.p_s, ..Slider::NONE },
            roll: Slider {
                stretch: hold.roll,
                spring: law.k_r,
                damper: law.c_r / step.dt,
                ..Slider::NONE
            },
            shear_memory: step.shear_memory,
            ..Self::NONE
        };
        if step.shear_memory {
            joint.shear.stretch = carry(hold.shear, &hold.n, &touch.normal);
            joint.shear.damper = law.c_s / step.dt;
        }
        joint.presses = hold.closed || joint.depth(&step.free) > 0.0;
        joint.expect(&step.free, hold);
        joint
    }

    /// Begins with the sliders' state that the free motion and the last normal force suggest.
    fn expect(&mut self, free: &Vec6, hold: &Hold) {
        if hold.push <= 0.0 {
            return;
        }
        let (way, turn) = self.ways(free);
        let cap = friction_cap(hold.push, self.tan_phi);
        if self.shear_memory {
            self.shear.judge(&way, cap);
        } else if hold.slides {
            (self.shear.slides, self.shear.friction) = (true, along(&way) * cap);
        }
        if self.rolling_m > 0.0 {
            self.roll.judge(&turn, self.rolling_m * hold.push);
        }
    }

    /// Penetration after the displacement `d` (m), negative when apart.
    pub fn depth(&self, d: &Vec6) -> f64 {
        normal_row(&self.v).dot(d) - self.gap
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
        let depth = self.depth(d);
        self.p_n * depth + self.damper * (depth - self.inside())
    }

    /// Adds its springs and dashpots to `K`.
    pub fn add_stiffness(&self, k: &mut Mat6) {
        if !self.presses {
            return;
        }
        let row = normal_row(&self.v);
        *k += normal_stiffness(self.p_n + self.damper, &row);
        if !self.shear.slides {
            let stiff = self.shear.spring + self.shear.damper;
            *k += shear_stiffness(stiff, &displacement(&self.p1), &row);
        }
        if self.rolling_m > 0.0 && !self.roll.slides {
            *k += rolling_stiffness(self.roll.spring + self.roll.damper);
        }
    }

    /// Adds its loads to `F`.
    pub fn add_load(&self, f: &mut Vec6) {
        if !self.presses {
            return;
        }
        let t = displacement(&self.p1);
        let stiff = if self.gap < 0.0 { self.p_n } else { self.p_n + self.damper };
        *f += normal_load(stiff, self.gap, &normal_row(&self.v));
        *f += if self.shear.slides {
            friction_load(&t, &self.shear.friction)
        } else {
            shear_load(self.shear.spring, &t, &self.shear.stretch)
        };
        if self.rolling_m > 0.0 {
            *f -= moment_load(&self.roll.force(&Vec3::zeros()));
        }
    }

    /// Compares its state with the displacement `d` that came out, and changes it where they do not agree.
    pub fn judge(&mut self, d: &Vec6) -> Change {
        self.push = self.normal_force(d).max(0.0);
        let presses = self.push > 0.0;
        let mut change = if presses == self.presses { Change::None } else { Change::Mode };
        self.presses = presses;
        if presses {
            let (way, turn) = self.ways(d);
            let cap = friction_cap(self.push, self.tan_phi);
            change = change.max(if self.shear_memory {
                self.shear.judge(&way, cap)
            } else {
                let before = friction_cap(self.push_before, self.tan_phi);
                self.shear.judge_as_printed(&way, cap, before)
            });
            if self.rolling_m > 0.0 {
                change = change.max(self.roll.judge(&turn, self.rolling_m * self.push));
            }
        }
        self.contested = change == Change::Mode;
        change
    }

    /// Takes the safe side of a quarrel: closed, sticking. Neither adds energy.
    pub fn give_in(&mut self) {
        if self.contested {
            self.presses = true;
            (self.shear.slides, self.roll.slides) = (false, false);
        }
    }

    /// Takes `d` as it is, settled or not.
    pub fn accept(&mut self, d: &Vec6) {
        self.push = if self.presses { self.normal_force(d).max(0.0) } else { 0.0 };
    }

    /// Shear force and rolling moment after `d`.
    fn forces(&self, d: &Vec6) -> (Vec3, Vec3) {
        let (way, turn) = self.ways(d);
        if !self.presses {
            (Vec3::zeros(), Vec3::zeros())
        } else if self.rolling_m > 0.0 {
            (self.shear.force(&way), self.roll.force(&turn))
        } else {
            (self.shear.force(&way), Vec3::zeros())
        }
    }

    /// Energy that its dashpots and sliders take over `d` (J).
    pub fn loss(&self, d: &Vec6) -> Loss {
        let (drag, moment) = self.forces(d);
        let (way, turn) = self.ways(d);
        let pressed = if self.presses { self.depth(d) - self.inside() } else { 0.0 };
        let mut loss = Loss { damping: self.damper * pressed * pressed, ..Loss::default() };
        if self.shear_memory {
            let (friction, damping) = self.shear.loss(&way, &drag);
            loss.friction = friction;
            loss.damping += damping;
        } else if self.shear.slides {
            loss.friction = drag.dot(&way);
        }
        if self.rolling_m > 0.0 {
            let (slider, dashpot) = self.roll.loss(&turn, &moment);
            loss.rolling = slider + dashpot;
        }
        loss
    }

    /// Writes what it remembers of the step into its memory.
    pub fn remember(&self, d: &Vec6, hold: &mut Hold) {
        let (drag, moment) = self.forces(d);
        (hold.feature, hold.triangle, hold.n) = (self.feature, self.triangle, -self.v);
        if self.shear_memory {
            hold.shear = self.shear.end(&drag);
        }
        if self.rolling_m > 0.0 {
            hold.roll = self.roll.end(&moment);
        }
        hold.push = self.push;
        hold.slides = self.presses && self.shear.slides;
        hold.closed = self.presses || self.depth(d) > 0.0;
    }
}
