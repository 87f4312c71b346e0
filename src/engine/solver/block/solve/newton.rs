//! Impulses of compliant contacts, in the six unknowns of the body.
//!
//! The impulse `P(u)` of a contact is a closed form of the velocity `u` of its point, so the
//! unknown is the single motion with `M (V − V_free) = Σ Tᵀ P(T V)`: six equations, however many
//! contacts a face has. The equations are piecewise smooth, as contacts open, stick or slip, and
//! are solved by Newton's method. If it does not converge, contacts are swept instead; so is a
//! dashpot that alone would keep the block outside, which has no closed form.
//!
//! Hard contacts are swept. If that does not converge – more contacts than a rigid body can
//! distinguish, or rolling friction that holds a block sliding on several corners – they are solved
//! with a compliance of a millionth of the body's own.

use super::super::rolling::RollingImpulse;
use super::{BlockContact, Mass, SpringCompliance};
use crate::contact::block::MAX_BLOCK_CONTACTS;
use crate::rock::Vec3;
use arrayvec::ArrayVec;
use nalgebra::{Matrix3, Matrix6, Vector6};

/// Newton steps before contacts are swept instead.
const NEWTON_STEPS: u32 = 30;
/// Halvings of a step that does not reduce the residual.
const HALVINGS: u32 = 4;
/// Change of the motion, relative to the largest impulse over the mass, below which it has
/// converged (–).
const MOTION_SETTLED: f64 = 1e-12;

/// Compliance of hard contacts and of their rolling friction, relative to the mean of the body's
/// own (–).
const REGULARIZATION: f64 = 1e-6;

/// The impulse of a contact whose point moves by `u` (m/s), and its derivative (kg).
type ImpulseAndSlope = (Vec3, Matrix3<f64>);

impl BlockContact {
    /// A hard contact with a small compliance.
    fn softened(&self) -> Self {
        let compliance = [REGULARIZATION * self.delassus.trace() / 3.0; 2];
        Self { springs: Some(SpringCompliance { compliance, surface_m_s: f64::INFINITY }), ..*self }
    }

    /// Its impulse at a velocity of its point, and the derivative; `None` where only sweeps can
    /// find it.
    fn impulse_at(&self, u: &Vec3) -> Option<ImpulseAndSlope> {
        let springs = self.springs()?;
        let [along, across] = springs.compliance.map(|c| 1.0 / c);
        let off = self.goal - u;
        let up = self.n.dot(&off);
        if up <= 0.0 {
            return Some((Vec3::zeros(), Matrix3::zeros()));
        }
        if self.n.dot(u) > springs.surface_m_s {
            return None;
        }
        let (normal, normal_impulse) = (self.n * self.n.transpose(), up * along);
        let held = (off - self.n * up) * across;
        let (cap, size) = (self.friction * normal_impulse, held.norm());
        let plane = Matrix3::identity() - normal;
        if size <= cap {
            return Some((self.n * normal_impulse + held, normal * -along - plane * across));
        }
        let direction = held / size;
        let turns = (plane - direction * direction.transpose()) * (-across * cap / size);
        let grows = (direction * self.n.transpose()) * (-along * self.friction);
        Some((self.n * normal_impulse + direction * cap, normal * -along + turns + grows))
    }
}

/// The equations of a body in contact.
struct BodyEquations<'c> {
    mass: &'c Mass,
    inertia: Matrix3<f64>,
    contacts: &'c mut [BlockContact],
    rolling: &'c mut RollingImpulse,
    free: (Vec3, Vec3),
}

impl BodyEquations<'_> {
    /// Residual at a motion, and its derivative; the impulses go into the contacts.
    fn residual_at(&mut self, (v, w): (&Vec3, &Vec3)) -> Option<(Vector6<f64>, Matrix6<f64>)> {
        let (dv, dw) = (v - self.free.0, w - self.free.1);
        let (mut linear, mut angular) = (dv * self.mass.mass, self.inertia * dw);
        let mut slope = Matrix6::zeros();
        slope.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(self.mass.mass);
        slope.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.inertia);
        // capacity of rolling friction, and its derivative with respect to the motion
        let (mut limit, mut limit_slope) = (0.0, [Vec3::zeros(); 2]);
        for contact in self.contacts.iter_mut() {
            let (impulse, rate) = contact.impulse_at(&Mass::velocity_at(&contact.lever, (v, w)))?;
            contact.impulse = impulse;
            linear -= impulse;
            angular -= contact.lever.cross(&impulse);
            // Tᵀ P' T with T = [1, −[a]×]
            let arm = contact.lever.cross_matrix();
            let (right, both) = (rate * arm, arm * rate);
            let mut block = slope.fixed_view_mut::<3, 3>(0, 0);
            block -= rate;
            let mut block = slope.fixed_view_mut::<3, 3>(0, 3);
            block += right;
            let mut block = slope.fixed_view_mut::<3, 3>(3, 0);
            block -= both;
            let mut block = slope.fixed_view_mut::<3, 3>(3, 3);
            block += arm * right;
            if contact.has_rolling() {
                limit += contact.rolling_limit();
                let normal_slope = rate.tr_mul(&contact.n) * contact.rolling_limit_of(1.0);
                limit_slope[0] += normal_slope;
                limit_slope[1] -= arm.tr_mul(&normal_slope);
            }
        }
        if let Some((taken, rate, direction)) = self.rolling.impulse_at(w, limit) {
            angular += taken;
            let mut block = slope.fixed_view_mut::<3, 3>(3, 0);
            block += direction * limit_slope[0].transpose();
            let mut block = slope.fixed_view_mut::<3, 3>(3, 3);
            block += rate + direction * limit_slope[1].transpose();
        }
        Some((Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z), slope))
    }

    /// Size of a residual, as a velocity (m/s).
    fn residual_m_s(&self, residual: &Vector6<f64>, reach: f64) -> f64 {
        let linear: Vec3 = residual.fixed_rows::<3>(0).into();
        let angular: Vec3 = residual.fixed_rows::<3>(3).into();
        linear.norm() / self.mass.mass + (self.mass.inverse * angular).norm() * reach
    }
}

/// Solves for the impulses of compliant contacts, from the motion without impulses and a first
/// guess; returns whether it has converged.
pub(in super::super) fn solve_springs(
    mass: &Mass,
    (contacts, rolling): (&mut [BlockContact], &mut RollingImpulse),
    (free, guess): ((Vec3, Vec3), (Vec3, Vec3)),
    rounding_m_s: f64,
) -> bool {
    let reach = contacts.iter().map(|contact| contact.lever.norm()).fold(0.0, f64::max);
    let Some(inertia) = mass.inverse.try_inverse() else { return false };
    let mut equations = BodyEquations { mass, inertia, contacts, rolling, free };
    let (mut v, mut w) = guess;
    let Some((mut residual, mut slope)) = equations.residual_at((&v, &w)) else { return false };
    let mut size = equations.residual_m_s(&residual, reach);
    for _ in 0..NEWTON_STEPS {
        let Some(step) = slope.lu().solve(&-residual) else { return false };
        let (dv, dw): (Vec3, Vec3) =
            (step.fixed_rows::<3>(0).into(), step.fixed_rows::<3>(3).into());
        let mut share = 1.0;
        for halving in 0..=HALVINGS {
            let Some(next) = equations.residual_at((&(v + dv * share), &(w + dw * share))) else {
                return false;
            };
            let next_size = equations.residual_m_s(&next.0, reach);
            if next_size < size || halving == HALVINGS {
                (residual, slope, size) = (next.0, next.1, next_size);
                break;
            }
            share *= 0.5;
        }
        (v, w) = (v + dv * share, w + dw * share);
        let moved = (dv.norm() + dw.norm() * reach) * share;
        let scale =
            equations.contacts.iter().map(|contact| contact.impulse.norm()).fold(0.0, f64::max);
        if moved <= (MOTION_SETTLED * scale / mass.mass).max(rounding_m_s) {
            return true;
        }
    }
    false
}

/// The same for hard contacts and their rolling friction, from their present motion and impulses;
/// nothing is changed if it does not converge.
pub(super) fn solve_hard(
    mass: &Mass,
    (contacts, rolling): (&mut [BlockContact], &mut RollingImpulse),
    (v, w): (&Vec3, &Vec3),
    rounding_m_s: f64,
) -> bool {
    if contacts.iter().any(|contact| contact.springs.is_some() || contact.is_clamped) {
        return false;
    }
    let mut free = (*v, w - mass.inverse * rolling.impulse);
    for contact in contacts.iter() {
        let (dv, dw) = mass.velocity_change(contact, &contact.impulse);
        free = (free.0 - dv, free.1 - dw);
    }
    let mut soft: ArrayVec<BlockContact, MAX_BLOCK_CONTACTS> =
        contacts.iter().map(BlockContact::softened).collect();
    let mut held = rolling.with_compliance(REGULARIZATION * mass.inverse.trace() / 3.0);
    if !solve_springs(mass, (&mut soft, &mut held), (free, (*v, *w)), rounding_m_s) {
        return false;
    }
    rolling.impulse = held.impulse;
    for (contact, solved) in contacts.iter_mut().zip(&soft) {
        contact.impulse = solved.impulse;
    }
    true
}
