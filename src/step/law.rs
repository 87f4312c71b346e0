//! The contact law inside one implicit stage: normal force, shear force and rolling moment of every contact.
//!
//! Normal: spring and dashpot in parallel, no tension, set-valued at first touch. Shear and rolling: a slider in
//! series with spring and dashpot. A stage of length `h` from `(v*, w*)` is one SDDA solve; eliminated contact by
//! contact it needs no matrix. This is the only place where stiffness and damping enter the `adaptive` and
//! `reference` schemes.

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
pub(super) fn within(x: Vec3, cap: f64) -> Vec3 {
    let size2 = x.norm_squared();
    if size2 > cap * cap { x * (cap / size2.sqrt()) } else { x }
}

impl Spot {
    /// No contact.
    pub const NONE: Self = Self {
        hold: 0,
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
    fn solve(&mut self, body: &Body, v: &Vec3, w: &Vec3, h: f64) {
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
        let (p_n, vn, m) = (self.law.p_n, self.n.dot(v), body.mass);
        let reached = self.pen - h * vn;
        let force = (p_n * reached - self.c_n * vn) / (1.0 + (p_n * h + self.c_n) * h / m);
        if force <= 0.0 {
            0.0
        } else if reached - h * h * force / m < 0.0 {
            // The dashpot alone would keep the rock out: the force that holds it exactly at the surface.
            (reached * m / (h * h)).max(0.0)
        } else {
            force
        }
    }

    /// Shear force and rolling moment together: both stick in closed form, else alternating projections.
    ///
    /// With `y = n × M` the tangential parts obey `(1+B) q + C y = A`, `E R q + (1+E) y = n × D`.
    fn shear_and_roll(&mut self, body: &Body, v: &Vec3, w: &Vec3, h: f64) {
        let (law, n, r) = (&self.law, self.n, body.radius);
        let kap = law.p_s * h + law.c_s;
        let kar = law.k_r * h + law.c_r;
        let a = self.shear * law.p_s + body.slip(&n, v, w) * kap;
        let d = self.roll * law.k_r + w * kar;
        let b = 3.5 * kap * h / body.mass;
        let c = kap * h * r / body.inertia;
        let e = kar * h / body.inertia;
        let (cap_q, cap_m) = (law.friction * self.push, law.rolling_m * self.push);
        let nd = n.cross(&d);
        let det = (1.0 + b) * (1.0 + e) - c * e * r;
        let mut q = (a * (1.0 + e) - nd * c) / det;
        let y = (nd * (1.0 + b) - a * (e * r)) / det;
        let mut moment = n * (n.dot(&d) / (1.0 + e)) - n.cross(&y);
        let sticks = q.norm_squared() <= cap_q * cap_q && moment.norm_squared() <= cap_m * cap_m;
        if !sticks {
            for _ in 0..ALTERNATIONS {
                moment = within((d + n.cross(&q) * (e * r)) / (1.0 + e), cap_m);
                let next = within((a - n.cross(&moment) * c) / (1.0 + b), cap_q);
                let change = (next - q).norm_squared();
                q = next;
                if change <= (SETTLED * cap_q).powi(2) {
                    break;
                }
            }
            moment = within((d + n.cross(&q) * (e * r)) / (1.0 + e), cap_m);
        }
        (self.drag, self.moment) = (q, moment);
    }

    /// Change of velocity and spin by this contact's forces over `h`.
    #[inline]
    fn effect(&self, body: &Body, h: f64) -> (Vec3, Vec3) {
        let dv = (self.n * self.push - self.drag) * (h / body.mass);
        let dw = (self.n.cross(&self.drag) * body.radius - self.moment) * (h / body.inertia);
        (dv, dw)
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

/// Most alternations of shear and rolling in one contact.
const ALTERNATIONS: u32 = 60;
/// Change of a force, relative to its scale, below which it has settled (–).
const SETTLED: f64 = 1e-10;
/// Most Gauss–Seidel sweeps over the contacts of one rock; a stage that needs more is rejected.
const SWEEPS: u32 = 60;

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
    let (mut v, mut w) = (v, w);
    for spot in spots.iter() {
        let (dv, dw) = spot.effect(body, h);
        v += dv;
        w += dw;
    }
    for _ in 0..SWEEPS {
        *sweeps += 1;
        let (mut change, mut scale) = (0.0f64, 1e-3 * body.mass * body.gravity.norm());
        for spot in spots.iter_mut() {
            let before = (spot.push, spot.drag, spot.moment);
            let (dv, dw) = spot.effect(body, h);
            let (vf, wf) = (v - dv, w - dw);
            spot.solve(body, &vf, &wf, h);
            let (dv, dw) = spot.effect(body, h);
            (v, w) = (vf + dv, wf + dw);
            change = change
                .max((spot.push - before.0).abs())
                .max((spot.drag - before.1).norm())
                .max((spot.moment - before.2).norm() / body.radius);
            scale = scale.max(spot.push);
        }
        if change <= SETTLED * scale {
            return Some((v, w));
        }
    }
    None
}
