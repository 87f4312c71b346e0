//! A contact that slides: what it answers in the frame of its normal, and its impulse on the rim of Coulomb's cone.

use super::BlockContact;
use crate::rock::Vec3;
use crate::solver::contact_frame::ContactFrame;
use crate::solver::law::within;
use nalgebra::{Matrix2, Matrix3, Vector2};

/// Turns of the direction of friction, at most, and the widest of them (rad).
const ANGLE_STEPS: u32 = 20;
const WIDEST_TURN: f64 = 0.8;
/// A turn (rad) no wider than this is the last: its square is below rounding.
const LAST_TURN: f64 = 1e-8;
/// Passes over the impulse of one contact that slides, at most.
const PASSES: u32 = 100;
/// Change of it below which they have settled (–).
const CONVERGED: f64 = 1e-13;

/// What a contact that slides is solved with: a matrix (1/kg) in the frame of the normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlidingMatrix {
    /// Directions along the surface.
    pub(super) first: Vec3,
    pub(super) second: Vec3,
    /// Along the normal for a push along it, and along the surface for the same; the same along the normal for a drag.
    pub(super) nn: f64,
    pub(super) tn: Vector2<f64>,
    /// Along the surface for a drag.
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
    /// The impulse on the rim of Coulomb's cone, `p (n + μ d)` with a direction `d` along the surface against the slip that it leaves: one
    /// equation for the angle of `d`, by Newton's method from a first guess. `None` where it does not settle on a slip that friction
    /// opposes.
    pub(super) fn sliding_impulse(
        &self,
        (up, slip): (f64, Vector2<f64>),
        mut d: Vector2<f64>,
        matrix: &SlidingMatrix,
    ) -> Option<Vec3> {
        let friction = self.friction;
        for _ in 0..ANGLE_STEPS {
            let selected = Vector2::new(-d.y, d.x);
            let own = matrix.nn + friction * matrix.tn.dot(&d);
            let push = -up / own;
            let answer = matrix.tn + matrix.tt * d * friction;
            let left = slip + answer * push;
            let push_turns = -push * friction * matrix.tn.dot(&selected) / own;
            let turns = selected
                .dot(&(answer * push_turns + matrix.tt * selected * (friction * push)))
                - d.dot(&left);
            let turn = -selected.dot(&left) / turns;
            if own <= 0.0 || !turn.is_finite() {
                return None;
            }
            d = (d + selected * turn.clamp(-WIDEST_TURN, WIDEST_TURN)).normalize();
            // Newton's method squares what is left to turn
            if turn.abs() <= LAST_TURN {
                let push = -up / (matrix.nn + friction * matrix.tn.dot(&d));
                let opposes = d.dot(&left) <= 0.0 && push > 0.0;
                let drag = matrix.first * d.x + matrix.second * d.y;
                return opposes.then(|| (self.n + drag * friction) * push);
            }
        }
        None
    }

    /// The same by passes over drag and push, slowly. Also where no rigid solution exists (Painlevé): then the last pass, which obeys the
    /// cone and pushes.
    pub(super) fn sliding_impulse_by_iteration(
        &self,
        u: &Vec3,
        (mut drag, whole): (Vec3, &Matrix3<f64>),
    ) -> Vec3 {
        let n = &self.n;
        let along = |x: &Vec3| x - n * n.dot(x);
        let to_n = whole * n;
        let (own, rate) = (n.dot(&to_n), 1.0 / (whole.trace() - n.dot(&to_n)));
        let mut push = 0.0;
        for _ in 0..PASSES {
            let asked = -(n.dot(u) + to_n.dot(&drag)) / own;
            push = asked.max(0.0);
            let slip = along(&(u + whole * drag + to_n * push));
            let next = within(drag - slip * rate, self.friction * push);
            let change = (next - drag).norm();
            drag = next;
            if change <= CONVERGED * push {
                break;
            }
        }
        n * push + drag
    }
}
