//! The contact of two rocks inside a fixed step: the paper's submatrices for two spheres, and the judgement of its state.
//!
//! With `V` from the first sphere to the second, `s = 1` for the first and `−1` for the second, the relative
//! displacement is `Σ s_k T_k D_k`, and every submatrix of the sphere–edge contact becomes four:
//! `K_kl += s_k s_l (p_N V_Nᵀ V_N + p_s T_kᵀ Q T_l)`, `F_k += s_k (p_N λ V_Nᵀ − p_s T_kᵀ ξ)`.
//!
//! `λ = |c_b − c_a| − R_a − R_b` (m, negative when pressed in), a bond's rest length in place of
//! the radii. Dashpots act on the mean velocity of the step, `c/Δt` beside the spring, as in `dda`.

use crate::contact::history::carry;
use crate::contact::pair::{Bond, PairHistory, between};
use crate::contact::submatrix::{
    Mat3x6, Mat6, Vec6, displacement, force_at, normal_row, slip, touching_point,
};
use crate::ground::{FixedStepNormal, FrictionLimits};
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::dda_system::slider::{Change, DdaSlider};

/// One contact of two rocks in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct DdaPairContact {
    pub(super) pair_history: usize,
    pub(super) ends: [usize; 2],
    /// Unit vector from the first centre to the second, frozen at the step's start.
    v: Vec3,
    /// `T` of Eq. (3) for the contact point of each sphere.
    t: [Mat3x6; 2],
    /// `λ` at the step's start (m).
    gap: f64,
    element: FixedStepNormal,
    limits: FrictionLimits,
    bond: Option<Bond>,
    captured: bool,
    /// Force of the last judgement (N), positive when pressing.
    normal_force: f64,
    pub(super) presses: bool,
    shear: DdaSlider,
    /// Whether the shear spring remembers; without, as printed.
    memory: bool,
    /// Normal force at the end of the last step (N): the printed scheme caps friction by it.
    push_before: f64,
}

/// `s` of the first and of the second sphere: what pushes one pushes the other back.
const SIGN: [f64; 2] = [1.0, -1.0];

impl DdaPairContact {
    /// The contact of pair `k` if the rocks are nearer than `slack` (m).
    ///
    /// `memory` is off in the printed scheme: no stretch is carried, no dashpot acts along the
    /// surface.
    pub(super) fn over(
        (k, pair_history): (usize, &PairHistory),
        bodies: [&Body; 2],
        at: [&Vec3; 2],
        slack: f64,
        (dt, memory): (f64, bool),
    ) -> Option<Self> {
        let (n, distance) = between(at[0], at[1]);
        let reach =
            pair_history.bond.map_or(bodies[0].radius + bodies[1].radius, |bond| bond.length_m);
        if distance > reach + slack && pair_history.bond.is_none() {
            return None;
        }
        let v = -n;
        let points = [touching_point(&v, bodies[0].radius), touching_point(&-v, bodies[1].radius)];
        let law = &pair_history.law;
        let compliance = |body: &Body| {
            0.5 * dt * dt * (1.0 / body.mass + body.radius * body.radius / body.inertia)
        };
        // A new pair knows no normal yet, and from the opposite of `n` there is no shortest turn.
        let from = if pair_history.is_held() { &pair_history.n } else { &n };
        let compliance = bodies.iter().map(|body| compliance(body)).sum();
        let mut shear = DdaSlider::new(&law.shear, dt, compliance);
        if memory {
            shear.stretch = carry(pair_history.shear, from, &n);
        } else {
            shear.damper = 0.0;
        }
        Some(Self {
            pair_history: k,
            ends: [pair_history.a as usize, pair_history.b as usize],
            v,
            t: points.map(|point| displacement(&point)),
            gap: distance - reach,
            element: law.normal_over_step(pair_history.captured, dt),
            limits: law.limits(),
            bond: pair_history.bond,
            captured: pair_history.captured,
            normal_force: pair_history.normal_force,
            presses: pair_history.is_held(),
            shear,
            memory,
            push_before: pair_history.normal_force,
        })
    }

    /// Penetration after the displacements `d` (m).
    pub(super) fn depth(&self, d: [&Vec6; 2]) -> f64 {
        normal_row(&self.v).dot(&(d[0] - d[1])) - self.gap
    }

    /// Slip of the first sphere's contact point relative to the second's over the step (m), Eq.
    /// (16).
    fn way(&self, d: [&Vec6; 2]) -> Vec3 {
        slip(&self.v, &(self.t[0] * d[0] - self.t[1] * d[1]))
    }

    /// Penetration at the step's start (m), 0 for a contact that closes within the step: its dashpot
    /// begins at the touch.
    fn inside(&self) -> f64 {
        if self.bond.is_some() { -self.gap } else { (-self.gap).max(0.0) }
    }

    /// `p_N pen + c_N/Δt (pen − pen₀)` (N); negative only in a bond.
    fn normal_force(&self, d: [&Vec6; 2]) -> f64 {
        self.element.force(self.depth(d), self.inside())
    }

    /// Block `K_kl`.
    pub(super) fn stiffness(&self, k: usize, l: usize) -> Mat6 {
        if !self.presses {
            return Mat6::zeros();
        }
        let row = normal_row(&self.v);
        let normal = (row * self.element.stiffness()) * row.transpose();
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
        let constant = self.element.constant(self.gap, self.inside());
        let shear_force = if self.shear.slides {
            self.shear.friction
        } else {
            self.shear.stretch * self.shear.spring
        };
        (normal_row(&self.v) * constant - force_at(&self.t[k], &shear_force)) * SIGN[k]
    }

    /// Opens or closes; whether that changed anything.
    /// A contact without bond is open where its force would pull.
    pub(super) fn open_or_close(&mut self, d: [&Vec6; 2]) -> bool {
        self.normal_force = self.normal_force(d);
        if self.bond.is_some() {
            return false;
        }
        self.normal_force = self.normal_force.max(0.0);
        std::mem::replace(&mut self.presses, self.normal_force > 0.0) != self.presses
    }

    /// Compares its state with the displacements that came out.
    /// Shear is judged before the normal state changes: its force belongs to the solution in hand.
    pub(super) fn judge(&mut self, d: [&Vec6; 2]) -> Change {
        let shear_force = self.drag(d);
        let mut change = if self.open_or_close(d) { Change::Mode } else { Change::None };
        if self.presses && self.bond.is_none() {
            let (way, cap) = (self.way(d), self.limits.caps(self.normal_force).0);
            change = change.max(if self.memory {
                self.shear.judge(&way, &shear_force, cap)
            } else {
                let before = self.limits.caps(self.push_before).0;
                self.shear.judge_as_printed(&way, cap, before)
            });
        }
        change
    }

    /// Fixes its sliders for a step whose states could not be found: friction holds, or there is
    /// none.
    pub(super) fn stick(&mut self) {
        self.shear.slides = !self.limits.has_friction() && self.bond.is_none();
    }

    /// Shear force on the first sphere (N), against its slip.
    fn drag(&self, d: [&Vec6; 2]) -> Vec3 {
        if self.presses { self.shear.force(&self.way(d)) } else { Vec3::zeros() }
    }

    /// Work on end `k` over its displacement (J): what the other rock and the springs give it.
    ///
    /// `F_k · D_k` with the force at the step's end: the paper's springs act with it over the whole
    /// step.
    pub(super) fn work(&self, k: usize, d: [&Vec6; 2]) -> f64 {
        if !self.presses {
            return 0.0;
        }
        let normal_force = normal_row(&self.v) * -self.normal_force(d);
        ((normal_force - force_at(&self.t[k], &self.drag(d))) * SIGN[k]).dot(d[k])
    }

    /// Writes what it remembers of the step; whether a bond broke.
    pub(super) fn remember(&self, d: [&Vec6; 2], pair_history: &mut PairHistory) -> bool {
        let shear_force = self.drag(d);
        pair_history.n = -self.v;
        pair_history.shear =
            if self.memory && self.presses { self.shear.end(&shear_force) } else { Vec3::zeros() };
        (pair_history.normal_force, pair_history.shear_force, pair_history.captured) =
            (self.normal_force, shear_force, self.captured);
        pair_history.slides = self.presses && self.shear.slides;
        pair_history.closed = self.presses || self.depth(d) > 0.0;
        let law = &pair_history.law;
        let overload = |bond: &Bond| bond.overload(law, self.normal_force, shear_force.norm());
        let breaks = self.bond.as_ref().is_some_and(|bond| overload(bond) > 0.0);
        if breaks {
            pair_history.break_bond();
        }
        breaks
    }
}
