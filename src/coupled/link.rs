//! The contact of two rocks inside a fixed step: the paper's submatrices for two spheres, and the judgement of its state.
//!
//! With `V` from the first sphere to the second, `s = 1` for the first and `−1` for the second, the relative
//! displacement is `Σ s_k T_k D_k`, and every submatrix of the sphere–edge contact becomes four:
//! `K_kl += s_k s_l (p_N V_Nᵀ V_N + p_s T_kᵀ Q T_l)`, `F_k += s_k (p_N λ V_Nᵀ − p_s T_kᵀ ξ)`.

use crate::contact::hold::carry;
use crate::contact::pair::{Bond, Tie, between};
use crate::contact::submatrix::{
    Mat3x6, Mat6, Vec6, displacement, force_at, friction_cap, normal_row, slip, touching_point,
};
use crate::rock::Vec3;
use crate::step::dda::slider::{Change, Slider};
use crate::step::law::Body;

/// One contact of two rocks in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    pub(super) tie: usize,
    pub(super) ends: [usize; 2],
    v: Vec3,
    t: [Mat3x6; 2],
    /// `λ` at the step's start (m).
    gap: f64,
    p_n: f64,
    damper: f64,
    tan_phi: f64,
    bond: Option<Bond>,
    captured: bool,
    push: f64,
    pub(super) presses: bool,
    shear: Slider,
    memory: bool,
    push_before: f64,
}

const SIGN: [f64; 2] = [1.0, -1.0];

impl Link {
    /// The link over tie `k` if the rocks are nearer than `slack` (m).
    pub(super) fn over(
        (k, tie): (usize, &Tie),
        bodies: [&Body; 2],
        at: [&Vec3; 2],
        slack: f64,
        (dt, memory): (f64, bool),
    ) -> Option<Self> {
        let (n, distance) = between(at[0], at[1]);
        let reach = tie.bond.map_or(bodies[0].radius + bodies[1].radius, |bond| bond.length_m);
        if distance > reach + slack && tie.bond.is_none() {
            return None;
        }
        let v = -n;
        let points = [touching_point(&v, bodies[0].radius), touching_point(&-v, bodies[1].radius)];
        let law = &tie.law;
        let damped = law.c_s > 0.0;
        let c_n = if tie.captured && damped { law.c_n_captured } else { law.c_n };
        let compliance = |body: &Body| {
            0.5 * dt * dt * (1.0 / body.mass + body.radius * body.radius / body.inertia)
        };
        // A new tie knows no normal yet, and from the opposite of `n` there is no shortest turn.
        let from = if tie.is_held() { &tie.n } else { &n };
        let shear = Slider {
            stretch: if memory { carry(tie.shear, from, &n) } else { Vec3::zeros() },
            spring: law.p_s,
            damper: if memory { law.c_s / dt } else { 0.0 },
            compliance: bodies.iter().map(|body| compliance(body)).sum(),
            ..Slider::NONE
        };
        Some(Self {
            tie: k,
            ends: [tie.a as usize, tie.b as usize],
            v,
            t: points.map(|point| displacement(&point)),
            gap: distance - reach,
            p_n: law.p_n,
            damper: c_n / dt,
            tan_phi: law.friction,
            bond: tie.bond,
            captured: tie.captured,
            push: tie.push,
            presses: tie.is_held(),
            shear,
            memory,
            push_before: tie.push,
        })
    }

    /// Penetration after the displacements `d` (m).
    pub(super) fn depth(&self, d: [&Vec6; 2]) -> f64 {
        normal_row(&self.v).dot(&(d[0] - d[1])) - self.gap
    }

    fn way(&self, d: [&Vec6; 2]) -> Vec3 {
        slip(&self.v, &(self.t[0] * d[0] - self.t[1] * d[1]))
    }

    fn inside(&self) -> f64 {
        if self.bond.is_some() { -self.gap } else { (-self.gap).max(0.0) }
    }

    fn normal_force(&self, d: [&Vec6; 2]) -> f64 {
        let depth = self.depth(d);
        self.p_n * depth + self.damper * (depth - self.inside())
    }

    /// Block `K_kl`.
    pub(super) fn stiffness(&self, k: usize, l: usize) -> Mat6 {
        if !self.presses {
            return Mat6::zeros();
        }
        let row = normal_row(&self.v);
        let normal = (row * (self.p_n + self.damper)) * row.transpose();
        let shear = if self.shear.slides { 0.0 } else { self.shear.spring + self.shear.damper };
        // T_kᵀ Q T_l, as Vᵀ T = V_N
        let across = (self.t[k].transpose() * self.t[l] - row * row.transpose()) * shear;
        (normal + across) * (SIGN[k] * SIGN[l])
    }

    /// Load `F_k`.
    pub(super) fn load(&self, k: usize) -> Vec6 {
        if !self.presses {
            return Vec6::zeros();
        }
        // What the dashpot has done before the touch is not its work.
        let constant = self.p_n * self.gap + self.damper * (self.gap + self.inside());
        let drag = if self.shear.slides {
            self.shear.friction
        } else {
            self.shear.stretch * self.shear.spring
        };
        (normal_row(&self.v) * constant - force_at(&self.t[k], &drag)) * SIGN[k]
    }

    /// Opens or closes; whether that changed anything.
    pub(super) fn open_or_close(&mut self, d: [&Vec6; 2]) -> bool {
        self.push = self.normal_force(d);
        if self.bond.is_some() {
            return false;
        }
        self.push = self.push.max(0.0);
        std::mem::replace(&mut self.presses, self.push > 0.0) != self.presses
    }

    /// Compares its state with the displacements that came out.
    pub(super) fn judge(&mut self, d: [&Vec6; 2]) -> Change {
        let drag = self.drag(d);
        let mut change = if self.open_or_close(d) { Change::Mode } else { Change::None };
        if self.presses && self.bond.is_none() {
            let (way, cap) = (self.way(d), friction_cap(self.push, self.tan_phi));
            change = change.max(if self.memory {
                self.shear.judge(&way, &drag, cap)
            } else {
                let before = friction_cap(self.push_before, self.tan_phi);
                self.shear.judge_as_printed(&way, cap, before)
            });
        }
        change
    }

    pub(super) fn stick(&mut self) {
        self.shear.slides = self.tan_phi <= 0.0 && self.bond.is_none();
    }

    fn drag(&self, d: [&Vec6; 2]) -> Vec3 {
        if self.presses { self.shear.force(&self.way(d)) } else { Vec3::zeros() }
    }

    /// Work on end `k` over its displacement (J): what the other rock and the springs give it.
    pub(super) fn work(&self, k: usize, d: [&Vec6; 2]) -> f64 {
        if !self.presses {
            return 0.0;
        }
        let push = normal_row(&self.v) * -self.normal_force(d);
        ((push - force_at(&self.t[k], &self.drag(d))) * SIGN[k]).dot(d[k])
    }

    /// Writes what it remembers of the step; whether a bond broke.
    pub(super) fn remember(&self, d: [&Vec6; 2], tie: &mut Tie) -> bool {
        let drag = self.drag(d);
        tie.n = -self.v;
        tie.shear = if self.memory && self.presses { self.shear.end(&drag) } else { Vec3::zeros() };
        (tie.push, tie.drag, tie.captured) = (self.push, drag, self.captured);
        tie.slides = self.presses && self.shear.slides;
        tie.closed = self.presses || self.depth(d) > 0.0;
        let overload = |bond: &Bond| bond.overload(self.push, drag.norm(), self.tan_phi);
        let breaks = self.bond.as_ref().is_some_and(|bond| overload(bond) > 0.0);
        if breaks {
            super::accept::break_bond(tie);
        }
        breaks
    }
}
