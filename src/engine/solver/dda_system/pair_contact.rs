//! The contact of two rocks in a fixed step: the paper's submatrices for two spheres.
//!
//! With `V` from the first sphere to the second, `s = 1` for the first and `−1` for the second, the relative
//! displacement is `Σ s_k T_k D_k`, and every submatrix of the sphere–edge contact becomes four:
//! `K_kl += s_k s_l (p_N V_Nᵀ V_N + p_s T_kᵀ Q T_l)`, `F_k += s_k (p_N λ V_Nᵀ − p_s T_kᵀ ξ)`.
//!
//! `λ = |c_b − c_a| − R_a − R_b` (m, negative when pressed in), a bond's rest length in place of
//! the radii. Dashpots act on the mean velocity of the step, `c/Δt` beside the spring, as in `dda`.

use super::StepConstants;
use super::contact::{DdaContact, RelativeDisplacement};
use crate::contact::history::transport;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::contact::submatrix::{
    Mat6, Vec6, displacement, force_at, normal_row, normal_stiffness, touching_point,
};
use crate::rock::Vec3;

/// Gap (–, relative to the smaller radius) up to which two rocks are in potential contact: they may
/// close it within the step.
const REACH: f64 = 0.1;

/// Sign `s` of the first and of the second sphere: their forces are opposite.
const SIGN: [f64; 2] = [1.0, -1.0];

/// One contact of two rocks in a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DdaPairContact {
    /// The rocks.
    pub(crate) ends: [usize; 2],
    /// Springs and state, as of a contact with the mesh.
    pub(crate) contact: DdaContact,
}

impl DdaPairContact {
    /// The contact of pair `k` whose rocks are `at` (m), if they are bonded, or closed, or may close within the step.
    pub(crate) fn of_pair(
        (k, pair_history): (usize, &PairHistory),
        steps: [&StepConstants; 2],
        at: [&Vec3; 2],
    ) -> Option<Self> {
        let (n, distance) = normal_and_distance(at[0], at[1]);
        let radii = steps.map(|step| step.radius);
        let radius = radii[0].min(radii[1]);
        let bonded = pair_history.bond.is_some();
        let reach = pair_history.bond.map_or(radii[0] + radii[1], |bond| bond.length_m);
        if distance > reach + REACH * radius && !bonded {
            return None;
        }
        let v = -n;
        let compliance = (steps[0].compliance.0 + steps[1].compliance.0, 0.0);
        let contact = DdaContact {
            history: k,
            radius,
            v,
            points: [touching_point(&v, radii[0]), touching_point(&n, radii[1])],
            gap: distance - reach,
            bonded,
            ..DdaContact::new(steps[0], &pair_history.law, pair_history.captured, compliance)
        };
        let ends = [pair_history.a as usize, pair_history.b as usize];
        let mut pair = Self { ends, contact };
        let free = pair.relative_displacement(steps.map(|step| &step.free));
        // a new pair has no normal yet, and from the opposite of `n` there is no shortest rotation
        let from = if pair_history.is_held() { &pair_history.n } else { &n };
        let left = (pair_history.normal_force, transport(pair_history.shear, from, &n));
        pair.contact.begin((pair_history.is_held(), pair_history.slides), left, &free);
        Some(pair)
    }

    /// Relative displacement of its ends.
    pub(crate) fn relative_displacement(&self, d: [&Vec6; 2]) -> RelativeDisplacement {
        let [a, b] = [0, 1].map(|k| displacement(&self.contact.points[k]) * d[k]);
        self.contact.relative_to(&(d[0] - d[1]), &(a - b))
    }

    /// Block `K_kl`.
    pub(crate) fn stiffness(&self, k: usize, l: usize) -> Mat6 {
        let row = normal_row(&self.contact.v);
        let [normal, shear] = self.contact.stiffnesses();
        let [t_k, t_l] = [k, l].map(|end| displacement(&self.contact.points[end]));
        // T_kᵀ Q T_l, as Vᵀ T = V_N
        let across = (t_k.transpose() * t_l - row * row.transpose()) * shear;
        (normal_stiffness(normal, &row) + across) * (SIGN[k] * SIGN[l])
    }

    /// Load `F_k − Σ_l K_kl D₀_l`, from the relative free displacement.
    ///
    /// The effect of the free motion on the springs depends on that difference alone: rocks that
    /// move together lose no digits.
    pub(crate) fn load(&self, k: usize, free: &RelativeDisplacement) -> Vec6 {
        let contact = &self.contact;
        if !contact.closed {
            return Vec6::zeros();
        }
        let [normal, shear] = contact.stiffnesses();
        let t = displacement(&contact.points[k]);
        let pushed = normal_row(&contact.v) * (normal * (free.depth + contact.gap));
        let held = contact.shear_load(&t) - force_at(&t, &(free.slip * shear));
        (contact.normal_load() - pushed + held) * SIGN[k]
    }

    /// Work of each end on the contact over its displacement (J), which goes to the other rock and
    /// the springs.
    ///
    /// `−F_k · D_k` with the force at the step's end: the paper's springs act with it over the whole
    /// step.
    pub(crate) fn given_j(&self, d: [&Vec6; 2]) -> [f64; 2] {
        let (contact, relative) = (&self.contact, self.relative_displacement(d));
        if !contact.closed {
            return [0.0; 2];
        }
        let push = normal_row(&contact.v) * contact.pull_or_push(relative.depth);
        let drag = contact.forces(&relative).0;
        let act = |k: usize| push + force_at(&displacement(&contact.points[k]), &drag);
        [0, 1].map(|k| (act(k) * SIGN[k]).dot(d[k]))
    }

    /// The part of it that the contact itself takes (J): that of dashpots and slider, and the
    /// increase of its springs. The rest is lost by the step.
    pub(crate) fn taken_j(&self, d: [&Vec6; 2]) -> f64 {
        let relative = self.relative_displacement(d);
        self.contact.loss(&relative).sum() + self.contact.stored_more_j(&relative)
    }

    /// Writes the step's end into its history; whether a bond broke.
    pub(crate) fn write_history(&self, d: [&Vec6; 2], pair_history: &mut PairHistory) -> bool {
        let (contact, relative) = (&self.contact, self.relative_displacement(d));
        let (closed, slides, stretch) = contact.end_state(&relative);
        pair_history.n = -contact.v;
        (pair_history.closed, pair_history.slides) = (closed, slides);
        pair_history.shear = if closed { stretch } else { Vec3::zeros() };
        pair_history.normal_force = contact.normal_force;
        pair_history.shear_force = contact.forces(&relative).0;
        let breaks = pair_history.overload() > 0.0;
        if breaks {
            pair_history.break_bond();
        }
        breaks
    }
}
