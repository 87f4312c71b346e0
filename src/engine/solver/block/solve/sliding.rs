//! What a contact answers in the frame of its normal.

use crate::rock::Vec3;
use crate::solver::contact_frame::ContactFrame;
use nalgebra::{Matrix2, Matrix3, Vector2};

/// What a contact that slides is solved with: a matrix (1/kg) in the frame of the normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlidingAnswer {
    /// Directions along the surface.
    pub(super) first: Vec3,
    pub(super) second: Vec3,
    /// Along the normal for a push along it, and along the surface for the same; the same along the normal for a drag.
    pub(super) own: f64,
    pub(super) lift: Vector2<f64>,
    /// Along the surface for a drag.
    pub(super) across: Matrix2<f64>,
}

impl SlidingAnswer {
    pub(super) fn of(n: &Vec3, whole: &Matrix3<f64>) -> Self {
        let frame = ContactFrame::of(n);
        let (first, second) = (frame.out_along([1.0, 0.0]), frame.out_along([0.0, 1.0]));
        let flat = |x: &Vec3| Vector2::new(first.dot(x), second.dot(x));
        let to_n = whole * n;
        let across = Matrix2::from_columns(&[flat(&(whole * first)), flat(&(whole * second))]);
        Self { first, second, own: n.dot(&to_n), lift: flat(&to_n), across }
    }

    pub(super) fn flat(&self, x: &Vec3) -> Vector2<f64> {
        Vector2::new(self.first.dot(x), self.second.dot(x))
    }
}
