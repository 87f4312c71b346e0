//! The contact law inside one implicit stage: normal force, shear force and rolling moment of every contact.
//!
//! Normal: spring and dashpot in parallel, no tension, set-valued at first touch. Shear and rolling: a slider in
//! series with spring and dashpot. A stage of length `h` from `(v*, w*)` is one SDDA solve; eliminated contact by
//! contact it needs no matrix. This is the only place where stiffness and damping enter the `adaptive` and
//! `reference` schemes.

use super::joint;
use crate::contact::Feature;
use crate::ground::Law;
use crate::rock::{Rock, Vec3};

/// What of a rock the mechanics needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia (kg m²).
    pub inertia: f64,
    /// Radius (m).
    pub radius: f64,
    /// Gravity vector (m/s²).
    pub gravity: Vec3,
}

impl Body {
    /// The body of a rock under gravity `g_m_s2` along −z.
    pub fn new(rock: &Rock, g_m_s2: f64) -> Self {
        let gravity = Vec3::new(0.0, 0.0, -g_m_s2);
        Self { mass: rock.mass_kg(), inertia: rock.inertia_kg_m2(), radius: rock.radius_m, gravity }
    }

    /// Velocity of the contact point along the surface with normal `n` (m/s): `Q (v + w × (−R n))`.
    #[inline]
    pub fn slip(&self, n: &Vec3, v: &Vec3, w: &Vec3) -> Vec3 {
        v - n * n.dot(v) + n.cross(w) * self.radius
    }
}

/// One contact inside a stage: its state at the stage's base and the forces that are sought.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// Which memory it belongs to.
    pub hold: usize,
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
    pub pen: f64,
    /// Stretch of the shear spring at the base, tangent to the surface (m).
    pub shear: Vec3,
    /// Stretch of the rolling spring at the base (rad).
    pub roll: Vec3,
    /// Normal force (N), ≥ 0.
    pub push: f64,
    /// Shear force `q`; the rock feels `−q` at the contact point (N).
    pub drag: Vec3,
    /// Rolling moment `M`; the rock feels `−M` (N m).
    pub moment: Vec3,
}

const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// Shortens `x` to at most `cap`.
#[inline]
pub(crate) fn within(x: Vec3, cap: f64) -> Vec3 {
    let size2 = x.norm_squared();
    if size2 > cap * cap { x * (cap / size2.sqrt()) } else { x }
}

impl Spot {
    /// No contact.
    pub const NONE: Self = Self {
        hold: 0,
        feature: Feature::NONE,
        triangle: 0,
        law: Law::NONE,
        c_n: 0.0,
        is_tree: false,
        n: ZERO,
        pen: 0.0,
        shear: ZERO,
        roll: ZERO,
        push: 0.0,
        drag: ZERO,
        moment: ZERO,
    };

    /// Forces for a base `(v, w)` without this contact's own effect, over a stage of length `h`.
    #[inline]
    pub(crate) fn solve(&mut self, body: &Body, v: &Vec3, w: &Vec3, h: f64) {
        self.push = self.normal_force(body, v, h);
        if self.push <= 0.0 {
            (self.drag, self.moment) = (Vec3::zeros(), Vec3::zeros());
        } else if self.law.rolling_m > 0.0 {
            self.shear_and_roll(body, v, w, h);
        } else {
            let law = &self.law;
            let kap = law.p_s * h + law.c_s;
            let trial = self.shear * law.p_s + body.slip(&self.n, v, w) * kap;
            let free = trial / (1.0 + 3.5 * h * kap / body.mass);
            self.drag = within(free, law.friction * self.push);
        }
    }

    /// `F = p_N pen + c_N pen'` at the stage's end, no tension, set-valued where the rock just does not get in.
    #[inline]
    fn normal_force(&self, body: &Body, v: &Vec3, h: f64) -> f64 {
        normal_force((self.law.p_n, self.c_n), self.pen, self.n.dot(v), body.mass, h)
    }

    /// Shear force and rolling moment together.
    ///
    /// Each is the shortening to its cap of `q̂ = (a − C n × M)/(1+B)`, `M̂ = (d + E R n × q)/(1+E)`. Both, one or none
    /// of them may be at its cap: three of the four cases are solved in closed form.
    fn shear_and_roll(&mut self, body: &Body, v: &Vec3, w: &Vec3, h: f64) {
        let (law, n) = (&self.law, self.n);
        let kap = law.p_s * h + law.c_s;
        let kar = law.k_r * h + law.c_r;
        let pair = Pair {
            n,
            a: self.shear * law.p_s + body.slip(&n, v, w) * kap,
            d: self.roll * law.k_r + w * kar,
            b1: 1.0 + 3.5 * kap * h / body.mass,
            c: kap * h * body.radius / body.inertia,
            e1: 1.0 + kar * h / body.inertia,
            er: kar * h / body.inertia * body.radius,
            caps: (law.friction * self.push, law.rolling_m * self.push),
        };
        (self.drag, self.moment) = pair.solve();
    }

    /// What shear and rolling springs would hold at velocity `v` and spin `w` if they did not slide.
    pub(crate) fn trials(&self, body: &Body, v: &Vec3, w: &Vec3, h: f64) -> (Vec3, Vec3) {
        let law = &self.law;
        let stick = self.shear * law.p_s + body.slip(&self.n, v, w) * (law.p_s * h + law.c_s);
        (stick, self.roll * law.k_r + w * (law.k_r * h + law.c_r))
    }

    /// Change of velocity and spin by this contact's forces over `h`.
    #[inline]
    pub(crate) fn effect(&self, body: &Body, h: f64) -> (Vec3, Vec3) {
        let dv = (self.n * self.push - self.drag) * (h / body.mass);
        let dw = (self.n.cross(&self.drag) * body.radius - self.moment) * (h / body.inertia);
        (dv, dw)
    }

    /// Penetration at the stage's end (m), where the velocity is `v`.
    #[inline]
    pub fn pen_at(&self, v: &Vec3, h: f64) -> f64 {
        self.pen - h * self.n.dot(v)
    }

    /// Whether it still holds the rock at the stage's end.
    #[inline]
    pub fn is_closed(&self, v: &Vec3, h: f64) -> bool {
        self.push > 0.0 || self.pen_at(v, h) > 0.0
    }

    /// Stretches at the stage's end: `ξ' = (h q + c_s ξ*)/(h p_s + c_s)`, and the same for rolling.
    #[inline]
    pub fn stretches(&self, h: f64) -> (Vec3, Vec3) {
        let law = &self.law;
        let shear = (self.drag * h + self.shear * law.c_s) / (h * law.p_s + law.c_s);
        let hr = h * law.k_r + law.c_r;
        let roll =
            if hr > 0.0 { (self.moment * h + self.roll * law.c_r) / hr } else { Vec3::zeros() };
        (shear, roll)
    }
}

/// `F = p_N pen + c_N pen'` at the end of a stage of length `h`, no tension, set-valued where the bodies just do not get
/// in; `vn` is their normal speed apart without this force, `m` the mass that it moves.
#[inline]
pub(crate) fn normal_force((p_n, c_n): (f64, f64), pen: f64, vn: f64, m: f64, h: f64) -> f64 {
    let reached = pen - h * vn;
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

/// The coupled shear force and rolling moment of one contact.
struct Pair {
    n: Vec3,
    a: Vec3,
    d: Vec3,
    /// 1 + B.
    b1: f64,
    c: f64,
    /// 1 + E.
    e1: f64,
    /// E R.
    er: f64,
    /// Largest shear force (N) and rolling moment (N m).
    caps: (f64, f64),
}

impl Pair {
    #[inline]
    fn solve(&self) -> (Vec3, Vec3) {
        let (cap_q, cap_m) = self.caps;
        let (q, moment) = self.both_stick();
        let (q_fits, m_fits) =
            (q.norm_squared() <= cap_q * cap_q, moment.norm_squared() <= cap_m * cap_m);
        if q_fits && m_fits {
            return (q, moment);
        }
        if !m_fits {
            let moment = self.rolling_alone();
            let q = self.shear_at(&moment);
            if q.norm_squared() <= cap_q * cap_q {
                return (q, moment);
            }
        }
        let q = self.sliding_alone();
        let moment = self.moment_at(&q);
        if moment.norm_squared() <= cap_m * cap_m {
            return (q, moment);
        }
        self.both_slip(q)
    }

    /// `q̂` for a moment.
    #[inline]
    fn shear_at(&self, moment: &Vec3) -> Vec3 {
        (self.a - self.n.cross(moment) * self.c) / self.b1
    }

    /// `M̂` for a shear force.
    #[inline]
    fn moment_at(&self, q: &Vec3) -> Vec3 {
        (self.d + self.n.cross(q) * self.er) / self.e1
    }

    /// Neither at its cap: with `y = n × M`, `(1+B) q + C y = a` and `E R q + (1+E) y = n × d`.
    #[inline]
    fn both_stick(&self) -> (Vec3, Vec3) {
        let nd = self.n.cross(&self.d);
        let det = self.b1 * self.e1 - self.c * self.er;
        let q = (self.a * self.e1 - nd * self.c) / det;
        let y = (nd * self.b1 - self.a * self.er) / det;
        (q, self.n * (self.n.dot(&self.d) / self.e1) - self.n.cross(&y))
    }

    /// The moment at its cap while shear sticks: `M ∥ G + s M_t`, a scalar equation for their ratio.
    #[inline]
    fn rolling_alone(&self) -> Vec3 {
        let g = self.d + self.n.cross(&self.a) * (self.er / self.b1);
        let g_n = self.n * self.n.dot(&g);
        let g_t = g - g_n;
        let (t2, n2, cap2) = (g_t.norm_squared(), g_n.norm_squared(), self.caps.1 * self.caps.1);
        let s = self.er * self.c / self.b1;
        // M_t = λ G_t/(1 − λs), M_n = λ G_n; |M| grows with λ. Newton on λ − cap/|G/(1 − λs)| from the far side.
        let mut ratio = 0.0;
        for _ in 0..RATIO_STEPS {
            let room = 1.0 / (1.0 - ratio * s);
            let size2 = t2 * room * room + n2;
            let miss = ratio - (cap2 / size2).sqrt();
            let slope = 1.0 + (cap2 / size2).sqrt() * t2 * room * room * room * s / size2;
            let change = miss / slope;
            ratio -= change;
            if change.abs() <= SETTLED * ratio {
                break;
            }
        }
        g_t * (ratio / (1.0 - ratio * s)) + g_n * ratio
    }

    /// Shear at its cap while rolling sticks: `q ∥ H`.
    #[inline]
    fn sliding_alone(&self) -> Vec3 {
        let along = self.a - self.n.cross(&self.d) * (self.c / self.e1);
        along * (self.caps.0 / along.norm().max(f64::MIN_POSITIVE))
    }

    /// Both at their caps: only directions are sought; alternating them settles in a few passes.
    fn both_slip(&self, mut q: Vec3) -> (Vec3, Vec3) {
        let (cap_q, cap_m) = self.caps;
        for _ in 0..ALTERNATIONS {
            let next = within(self.shear_at(&within(self.moment_at(&q), cap_m)), cap_q);
            let change = (next - q).norm_squared();
            q = next;
            if change <= (SETTLED * cap_q).powi(2) {
                break;
            }
        }
        (q, within(self.moment_at(&q), cap_m))
    }
}

/// Newton steps for the ratio of a rolling moment at its cap.
const RATIO_STEPS: u32 = 30;
/// Most alternations of shear and rolling in one contact.
const ALTERNATIONS: u32 = 60;
/// Change of a force, relative to its scale, below which it has settled (–).
const SETTLED: f64 = 1e-10;

/// Solves all contacts of one stage from `(v, w)`, velocity and spin without contact forces (gravity included).
///
/// Returns velocity and spin at the stage's end, or `None` if the sweeps do not settle; `sweeps` counts.
pub fn solve(
    body: &Body,
    spots: &mut [Spot],
    v: Vec3,
    w: Vec3,
    h: f64,
    sweeps: &mut u64,
) -> Option<(Vec3, Vec3)> {
    if let [spot] = spots {
        *sweeps += 1;
        spot.solve(body, &v, &w, h);
        let (dv, dw) = spot.effect(body, h);
        return Some((v + dv, w + dw));
    }
    joint::solve(body, spots, (v, w), h, sweeps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0f64..1.0).prop_map(Vec3::from)
    }

    proptest! {
        /// Whatever case the closed forms choose, the result is the fixed point of both shortenings; 1e-8 of the caps
        /// is what the alternation of two slipping directions leaves.
        #[test]
        fn shear_and_rolling_solve_their_equations(
            a in vector(), d in vector(), caps in prop::array::uniform2(0.01f64..2.0),
            b in 0.001f64..100.0, e in 0.001f64..100.0, r in 0.01f64..10.0,
        ) {
            let n = Vec3::new(0.6, 0.0, 0.8);
            let a = a - n * n.dot(&a);
            // C E R = 5/7 B E, as a solid sphere has it
            let c = 5.0 / 7.0 * b / r;
            let pair = Pair { n, a, d: d * r, b1: 1.0 + b, c, e1: 1.0 + e, er: e * r, caps: (caps[0], caps[1] * r) };
            let (q, moment) = pair.solve();
            let off_q = (q - within(pair.shear_at(&moment), pair.caps.0)).norm();
            let off_m = (moment - within(pair.moment_at(&q), pair.caps.1)).norm();
            prop_assert!(off_q <= 1e-8 * pair.caps.0 && off_m <= 1e-8 * pair.caps.1, "{off_q} {off_m}");
            prop_assert!(q.norm() <= pair.caps.0 * (1.0 + 1e-12) && moment.norm() <= pair.caps.1 * (1.0 + 1e-12));
        }
    }
}
