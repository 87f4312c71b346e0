//! A sliding contact: its matrix in the frame of its normal, and its impulse on the surface of
//! Coulomb's cone.

use super::BlockContact;
use crate::rock::Vec3;
use crate::solver::contact_frame::ContactFrame;
use crate::solver::law::clamp_norm;
use nalgebra::{Matrix2, Matrix3, Vector2};

/// Newton steps for the direction of friction, at most, and the largest turn of a step (rad).
const ANGLE_STEPS: u32 = 20;
const WIDEST_TURN: f64 = 0.8;
/// A turn (rad) up to this is the last: its square is below rounding.
const LAST_TURN: f64 = 1e-8;
/// Iterations for the impulse of one sliding contact, at most.
const PASSES: u32 = 100;
/// Relative change of the impulse below which they have converged (–).
const CONVERGED: f64 = 1e-13;

/// The matrix (1/kg) of a sliding contact in the frame of its normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlidingMatrix {
    /// Tangents.
    pub(super) first: Vec3,
    pub(super) second: Vec3,
    /// Normal response to a normal impulse, and tangential response to a normal impulse; by
    /// symmetry also the normal response to a tangential one.
    pub(super) nn: f64,
    pub(super) tn: Vector2<f64>,
    /// Tangential response to a tangential impulse.
    pub(super) tt: Matrix2<f64>,
}

impl SlidingMatrix {
    pub(super) fn of(n: &Vec3, whole: &Matrix3<f64>) -> Self {
        let frame = ContactFrame::of(n);
        let (first, second) = (frame.out_along([1.0, 0.0]), frame.out_along([0.0, 1.0]));
        let tangential = |x: &Vec3| Vector2::new(first.dot(x), second.dot(x));
        let to_n = whole * n;
        let tt =
            Matrix2::from_columns(&[tangential(&(whole * first)), tangential(&(whole * second))]);
        Self { first, second, nn: n.dot(&to_n), tn: tangential(&to_n), tt }
    }

    pub(super) fn tangential(&self, x: &Vec3) -> Vector2<f64> {
        Vector2::new(self.first.dot(x), self.second.dot(x))
    }
}

impl BlockContact {
    /// The impulse on the surface of Coulomb's cone, `p (n + μ d)`, with the unit tangent `d`
    /// against the slip that it leaves: one equation for the angle of `d`, solved by Newton's
    /// method from a first guess. `None` if it does not converge to a slip that friction opposes.
    pub(super) fn sliding_impulse(
        &self,
        (up, slip): (f64, Vector2<f64>),
        mut d: Vector2<f64>,
        matrix: &SlidingMatrix,
    ) -> Option<Vec3> {
        let friction = self.friction;
        for _ in 0..ANGLE_STEPS {
            let perpendicular = Vector2::new(-d.y, d.x);
            let own = matrix.nn + friction * matrix.tn.dot(&d);
            let normal_impulse = -up / own;
            let answer = matrix.tn + matrix.tt * d * friction;
            let left = slip + answer * normal_impulse;
            let push_turns = -normal_impulse * friction * matrix.tn.dot(&perpendicular) / own;
            let turns = perpendicular.dot(
                &(answer * push_turns + matrix.tt * perpendicular * (friction * normal_impulse)),
            ) - d.dot(&left);
            let turn = -perpendicular.dot(&left) / turns;
            if own <= 0.0 || !turn.is_finite() {
                return None;
            }
            d = (d + perpendicular * turn.clamp(-WIDEST_TURN, WIDEST_TURN)).normalize();
            // Newton's method squares the remaining turn
            if turn.abs() <= LAST_TURN {
                let normal_impulse = -up / (matrix.nn + friction * matrix.tn.dot(&d));
                let opposes = d.dot(&left) <= 0.0 && normal_impulse > 0.0;
                let tangent = matrix.first * d.x + matrix.second * d.y;
                return opposes.then(|| (self.n + tangent * friction) * normal_impulse);
            }
        }
        None
    }

    /// The same by fixed-point iteration over friction and normal impulse, which is slow. It also
    /// serves where no rigid solution exists (Painlevé): then the last iterate is taken, which
    /// obeys the cone and pushes.
    pub(super) fn sliding_impulse_by_iteration(
        &self,
        u: &Vec3,
        (mut friction_impulse, whole): (Vec3, &Matrix3<f64>),
    ) -> Vec3 {
        let n = &self.n;
        let along = |x: &Vec3| x - n * n.dot(x);
        let to_n = whole * n;
        let (own, rate) = (n.dot(&to_n), 1.0 / (whole.trace() - n.dot(&to_n)));
        let mut normal_impulse = 0.0;
        for _ in 0..PASSES {
            let asked = -(n.dot(u) + to_n.dot(&friction_impulse)) / own;
            normal_impulse = asked.max(0.0);
            let slip = along(&(u + whole * friction_impulse + to_n * normal_impulse));
            let next = clamp_norm(friction_impulse - slip * rate, self.friction * normal_impulse);
            let change = (next - friction_impulse).norm();
            friction_impulse = next;
            if change <= CONVERGED * normal_impulse {
                break;
            }
        }
        n * normal_impulse + friction_impulse
    }
}
