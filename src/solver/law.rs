//! The contact law inside one implicit stage: normal force, shear force and rolling moment of every contact.
//!
//! Normal: spring and dashpot in parallel, no tension, set-valued at first touch. Shear and rolling: a slider in
//! series with spring and dashpot. A stage of length `h` from `(v*, w*)` is one SDDA solve; eliminated contact by
//! contact it needs no matrix. This is the only place where stiffness and damping enter the `adaptive` and
//! `reference` schemes.

use super::body::Body;
use super::friction_rolling::{Answers, ContactFrame, Pair, SlipState};
use crate::contact::Feature;
use crate::contact::history::ContactHistory;
use crate::ground::Law;
use crate::rock::Vec3;

/// One contact inside a stage: its state at the stage's base and the forces that are sought.
#[derive(Debug, Clone, Copy)]
pub struct StageContact {
    /// Which memory it belongs to.
    pub history: usize,
    /// Where on the mesh.
    pub feature: Feature,
    /// Triangle whose ground answers.
    pub triangle: u32,
    /// Its law.
    pub law: Law,
    /// Normal damping in force (N s/m): the captured value in a captured contact.
    pub c_n: f64,
    /// Whether it touches a tree.
    pub is_tree: bool,
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
    /// Which of the two are at their caps, as far as is known.
    pub(crate) mode: SlipState,
}

impl Law {
    /// Energy in springs (J) at a penetration (m) and the squares of their stretches (m², rad²):
    /// `(p_N pen² + p_s ξ² + k_r θ²)/2`.
    #[inline]
    pub(crate) fn stored_j(&self, penetration: f64, shear2: f64, roll2: f64) -> f64 {
        0.5 * (self.p_n * penetration * penetration + self.p_s * shear2 + self.k_r * roll2)
    }

    /// What a slip speed adds to a sticking shear force over a stage of length `h` (N s/m): `p_s h + c_s`.
    #[inline]
    pub(crate) fn shear_over(&self, h: f64) -> f64 {
        self.p_s * h + self.c_s
    }

    /// What a spin adds to a sticking rolling moment over a stage of length `h` (N m s): `k_r h + c_r`.
    #[inline]
    pub(crate) fn rolling_over(&self, h: f64) -> f64 {
        self.k_r * h + self.c_r
    }

    /// Stretch of the shear spring after a stage of length `h` from `shear` under `force`: `ξ' = (h q + c_s ξ*)/(h p_s + c_s)`.
    #[inline]
    pub(crate) fn shear_after(&self, force: &Vec3, shear: &Vec3, h: f64) -> Vec3 {
        (force * h + shear * self.c_s) / self.shear_over(h)
    }
}

/// No impact is slower than this (m/s), whatever capture speed is asked for: a blow takes no time, and rounding would
/// strike them without end.
const LEAST_M_S: f64 = 1e-6;

pub(crate) const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// Shortens `x` to at most `cap`.
#[inline]
pub(crate) fn within(x: Vec3, cap: f64) -> Vec3 {
    let size2 = x.norm_squared();
    if size2 > cap * cap { x * (cap / size2.sqrt()) } else { x }
}

/// What a contact does at a given motion, and how its springs go on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Action {
    /// Slip of the contact point (m/s).
    pub(crate) slip: Vec3,
    /// Normal force (N), ≥ 0, and what it would be if it could pull.
    pub(crate) normal: [f64; 2],
    /// Shear force; the rock feels its opposite at the contact point (N).
    pub(crate) shear_force: Vec3,
    /// Rolling moment; the rock feels its opposite (N m).
    pub(crate) rolling_moment: Vec3,
    /// Rates of the stretches of shear (m/s) and rolling springs (rad/s).
    pub(crate) rates: [Vec3; 2],
    /// Squares of the shear force and of the rolling moment that there would be without a cap (N², N² m²).
    pub(crate) asked2: [f64; 2],
}

/// Where a contact is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactPlace {
    /// Unit normal from the mesh to the centre.
    pub(crate) n: Vec3,
    /// Penetration (m).
    pub(crate) penetration: f64,
    /// Stretch of the shear spring (m) …
    pub(crate) shear: Vec3,
    /// … and of the rolling spring (rad).
    pub(crate) roll: Vec3,
}

impl Action {
    /// In a contact of stiffness `p_n` (N/m) and damping `c_n` (N s/m), all else by `law`, at velocity `v` and spin `w`.
    #[inline]
    pub(crate) fn of(
        body: &Body,
        law: &Law,
        (p_n, c_n): (f64, f64),
        at: &ContactPlace,
        (v, w): (&Vec3, &Vec3),
    ) -> Self {
        let pulls = p_n * at.penetration - c_n * at.n.dot(v);
        let normal_force = pulls.max(0.0);
        let slip = body.slip(&at.n, v, w);
        let held = at.shear * law.p_s;
        let asked = held + slip * law.c_s;
        let shear_force = within(asked, law.friction * normal_force);
        let shear_rate = if law.c_s > 0.0 { (shear_force - held) / law.c_s } else { ZERO };
        let (mut rolling_moment, mut roll_rate, mut asked_moment2) = (ZERO, ZERO, 0.0);
        if law.c_r > 0.0 {
            let wound = at.roll * law.k_r;
            let asked = wound + w * law.c_r;
            rolling_moment = within(asked, law.rolling_m * normal_force);
            roll_rate = (rolling_moment - wound) / law.c_r;
            asked_moment2 = asked.norm_squared();
        }
        Self {
            slip,
            normal: [normal_force, pulls],
            shear_force,
            rolling_moment,
            rates: [shear_rate, roll_rate],
            asked2: [asked.norm_squared(), asked_moment2],
        }
    }

    /// Power that goes into friction, dashpots and springs, and rolling (W), in this order.
    #[inline]
    pub(crate) fn powers(&self, approach: f64, w: &Vec3) -> [f64; 3] {
        let slipping = self.shear_force.dot(&(self.slip - self.rates[0]));
        let damping = self.shear_force.dot(&self.rates[0]) + self.normal[0] * approach;
        [slipping, damping, self.rolling_moment.dot(w)]
    }
}

impl StageContact {
    /// No contact.
    pub const NONE: Self = Self {
        history: 0,
        feature: Feature::NONE,
        triangle: 0,
        law: Law::NONE,
        c_n: 0.0,
        is_tree: false,
        n: ZERO,
        penetration: 0.0,
        shear: ZERO,
        roll: ZERO,
        normal_force: 0.0,
        shear_force: ZERO,
        rolling_moment: ZERO,
        mode: SlipState::Stick,
    };

    /// Forces for a base `(v, w)` without this contact's own effect, over a stage of length `h`.
    #[inline]
    pub(crate) fn solve(&mut self, body: &Body, v: &Vec3, w: &Vec3, h: f64) {
        self.normal_force = self.normal_force(body, v, h);
        if self.normal_force <= 0.0 {
            (self.shear_force, self.rolling_moment) = (Vec3::zeros(), Vec3::zeros());
            return;
        }
        let law = &self.law;
        let frame = ContactFrame::of(&self.n);
        let answers = Answers::of(body, law, h);
        let slip = body.slip(&self.n, v, w);
        let pair = Pair {
            answers: &answers,
            a: frame.along(&(self.shear * law.p_s + slip * answers.kap)),
            d: frame.local(&(self.roll * law.k_r + w * answers.kar)),
            caps: (law.friction * self.normal_force, law.rolling_m * self.normal_force),
        };
        let (shear_force, rolling_moment) = pair.solve(&mut self.mode);
        (self.shear_force, self.rolling_moment) =
            (frame.out_along(shear_force), frame.out_local(rolling_moment));
    }

    /// `F = p_N pen + c_N pen'` at the stage's end, no tension, set-valued where the rock just does not get in.
    #[inline]
    fn normal_force(&self, body: &Body, v: &Vec3, h: f64) -> f64 {
        normal_force((self.law.p_n, self.c_n), self.penetration, self.n.dot(v), body.mass, h)
    }

    /// What shear and rolling springs would hold at velocity `v` and spin `w` if they did not slide.
    pub(crate) fn trials(&self, body: &Body, v: &Vec3, w: &Vec3, h: f64) -> (Vec3, Vec3) {
        let law = &self.law;
        let stick = self.shear * law.p_s + body.slip(&self.n, v, w) * law.shear_over(h);
        (stick, self.roll * law.k_r + w * (law.rolling_over(h)))
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
    pub fn pen_at(&self, v: &Vec3, h: f64) -> f64 {
        self.penetration - h * self.n.dot(v)
    }

    /// Whether it still holds the rock at the stage's end.
    #[inline]
    pub fn is_closed(&self, v: &Vec3, h: f64) -> bool {
        self.normal_force > 0.0 || self.pen_at(v, h) > 0.0
    }

    /// Writes the contact into its memory, with its stretches and whether it still holds the rock.
    pub(crate) fn remember(
        &self,
        (shear, roll): (Vec3, Vec3),
        closed: bool,
        history: &mut ContactHistory,
    ) {
        (history.feature, history.triangle, history.n) = (self.feature, self.triangle, self.n);
        (history.shear, history.roll, history.normal_force) = (shear, roll, self.normal_force);
        history.slides =
            self.shear_force.norm() >= self.law.friction * self.normal_force * (1.0 - 1e-9);
        history.closed = closed;
    }

    /// Stretches at the stage's end: `ξ' = (h q + c_s ξ*)/(h p_s + c_s)`, and the same for rolling.
    #[inline]
    pub fn stretches(&self, h: f64) -> (Vec3, Vec3) {
        let law = &self.law;
        let shear = law.shear_after(&self.shear_force, &self.shear, h);
        let hr = h * law.k_r + law.c_r;
        let roll = if hr > 0.0 {
            (self.rolling_moment * h + self.roll * law.c_r) / hr
        } else {
            Vec3::zeros()
        };
        (shear, roll)
    }
}

/// `F = p_N pen + c_N pen'` at the end of a stage of length `h`, no tension, set-valued where the bodies just do not get
/// in; `vn` is their normal speed apart without this force, `m` the mass that it moves.
#[inline]
pub(crate) fn normal_force(
    (p_n, c_n): (f64, f64),
    penetration: f64,
    vn: f64,
    m: f64,
    h: f64,
) -> f64 {
    let reached = penetration - h * vn;
    let force = (p_n * reached - c_n * vn) / (1.0 + (p_n * h + c_n) * h / m);
    if force <= 0.0 {
        0.0
    } else if reached - h * h * force / m < 0.0 {
        // The dashpot alone would keep the rock out: the force that holds it exactly at the surface.
        (reached * m / (h * h)).max(0.0)
    } else {
        force
    }
}

/// Speed of approach up to which a contact does not rebound (m/s).
pub(crate) fn capture_m_s(law: &Law) -> f64 {
    law.capture_m_s.max(LEAST_M_S)
}
