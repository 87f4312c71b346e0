//! A triangle seen from the centre of a rock: what tells, without roots, which of its parts the rock can come to.

use super::faces::Face;
use crate::rock::Vec3;

/// Where a centre stands to the sides of a triangle. Side `k` runs from corner `k` to the next.
#[derive(Debug)]
pub struct Seen<'a> {
    face: &'a Face,
    /// From the first corner to the centre (m).
    to: Vec3,
    /// Of the centre over the plane (m).
    height: f64,
    /// Squares of the sides' lengths (m²).
    length2: [f64; 3],
    /// How far the foot is beyond each side, times its length (m²).
    beyond: [f64; 3],
}

/// Squares computed here are right to this (–, relative).
const SQUARE_ROUNDING: f64 = 1e-9;

impl<'a> Seen<'a> {
    /// `None` if the foot of a centre at `height` is more than `beside` (both m) beyond a side.
    #[inline]
    pub fn of(face: &'a Face, to: Vec3, (height, beside): (f64, f64)) -> Option<Self> {
        let most2 = beside * beside * (1.0 + SQUARE_ROUNDING);
        let is_out = |beyond: f64, length2: f64| beyond > 0.0 && beyond * beyond > most2 * length2;
        // (side × n) · to, with one cross product for the two sides at the first corner
        let across = face.n.cross(&to);
        let (first, length2) = (face.e1.dot(&across), face.e1.norm_squared());
        if is_out(first, length2) {
            return None;
        }
        let (third, third_length2) = (-face.e2.dot(&across), face.e2.norm_squared());
        if is_out(third, third_length2) {
            return None;
        }
        let side = face.e2 - face.e1;
        let (second, second_length2) =
            (side.dot(&face.n.cross(&(to - face.e1))), side.norm_squared());
        if is_out(second, second_length2) {
            return None;
        }
        let (length2, beyond) = ([length2, second_length2, third_length2], [first, second, third]);
        Some(Self { face, to, height, length2, beyond })
    }

    /// Whether the foot is nowhere more than `near` (m) beyond a side.
    #[inline]
    pub fn is_within(&self, near: f64) -> bool {
        let near2 = near * near * (1.0 + SQUARE_ROUNDING);
        (0..3).all(|k| self.beyond[k] <= 0.0 || self.beyond[k].powi(2) <= near2 * self.length2[k])
    }

    /// How far along side `k` the foot is, times its length (m²).
    #[inline]
    fn along(&self, k: usize) -> f64 {
        let (e1, e2, to) = (&self.face.e1, &self.face.e2, &self.to);
        match k {
            0 => e1.dot(to),
            1 => (e2 - e1).dot(&(to - e1)),
            _ => self.length2[2] - e2.dot(to),
        }
    }

    /// Whether the centre, moved by up to `near`, can be abreast of side `k`, outside of the triangle and no further than
    /// `reach` (m) from it.
    #[inline]
    pub fn may_meet_edge(&self, k: usize, (near, reach): (f64, f64)) -> bool {
        let (beyond, length2) = (self.beyond[k], self.length2[k]);
        let past = {
            let along = self.along(k);
            -along.min(length2 - along)
        };
        let near2 = near * near * length2 * (1.0 + SQUARE_ROUNDING);
        let far2 = (reach * reach * (1.0 + SQUARE_ROUNDING) - self.height * self.height) * length2;
        (beyond >= 0.0 || beyond * beyond <= near2)
            && beyond * beyond <= far2 * (1.0 + SQUARE_ROUNDING)
            && (past <= 0.0 || past * past <= near2)
    }

    /// Whether the centre, moved by up to `near`, can be abreast of side `k`, inside of the triangle and no further than
    /// `reach` (m) from it.
    #[inline]
    pub fn may_press_edge(&self, k: usize, (near, reach): (f64, f64)) -> bool {
        let (beyond, length2) = (self.beyond[k], self.length2[k]);
        let near2 = near * near * length2 * (1.0 + SQUARE_ROUNDING);
        let far2 = (reach * reach * (1.0 + SQUARE_ROUNDING) - self.height * self.height) * length2;
        (beyond <= 0.0 || beyond * beyond <= near2)
            && beyond * beyond <= far2 * (1.0 + SQUARE_ROUNDING)
    }

    /// Whether the centre, moved by up to `near`, can be behind both sides at corner `k` and no further than `reach` (m)
    /// from the corner along either.
    #[inline]
    pub fn may_meet_corner(&self, k: usize, (near, reach): (f64, f64)) -> bool {
        let before = (k + 2) % 3;
        let sides = [(k, self.along(k)), (before, self.length2[before] - self.along(before))];
        sides.into_iter().all(|(side, ahead)| {
            let most = if ahead > 0.0 { near } else { reach };
            ahead * ahead <= most * most * self.length2[side] * (1.0 + SQUARE_ROUNDING)
        })
    }
}
