//! Exact volume, centre and inertia of a closed triangle surface.

use crate::math;
use crate::rock::Vec3;
use nalgebra::{Matrix3, Rotation3};
use std::f64::consts::PI;

/// A closed surface of triangles, their corners counter-clockwise as seen from outside.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Points (m).
    pub points: Vec<Vec3>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
}

/// A homogeneous solid of density 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Volume.
    pub volume: f64,
    /// Centre of mass.
    pub centre: Vec3,
    /// Principal moments of inertia about the centre, for unit density.
    pub moments: [f64; 3],
    /// From the principal frame to the surface's, right-handed.
    pub axes: Rotation3<f64>,
}

impl Solid {
    /// Integrates over signed tetrahedra from a point of the surface (Mirtich 1996): `V = Σ
    /// a·(b×c)/6`, centre `Σ v (a+b+c)/4 / V`, second moments `Σ v/20 (aaᵀ + bbᵀ + ccᵀ + ssᵀ)`, `s
    /// = a+b+c`. Negative if the triangles are inside out.
    pub fn of(surface: &Surface) -> Self {
        // near the body, not near the origin of a map: products of large coordinates would lose the
        // digits
        let origin = surface.points.first().copied().unwrap_or_default();
        let corners = |t: &[u32; 3]| t.map(|k| surface.points[k as usize] - origin);
        let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Matrix3::zeros());
        for [a, b, c] in surface.triangles.iter().map(corners) {
            let (v, s) = (a.dot(&b.cross(&c)) / 6.0, a + b + c);
            volume += v;
            first += s * (0.25 * v);
            let square = a * a.transpose() + b * b.transpose() + c * c.transpose();
            second += (square + s * s.transpose()) * (0.05 * v);
        }
        let centre = first / volume;
        let about_centre = second - centre * centre.transpose() * volume;
        Self::with_moments(volume, origin + centre, about_centre)
    }

    /// Of a solid ellipsoid with these half-axes about the origin.
    pub fn ellipsoid(half: [f64; 3]) -> Self {
        let volume = 4.0 / 3.0 * PI * half[0] * half[1] * half[2];
        let second = Matrix3::from_diagonal(&Vec3::from(half.map(|h| 0.2 * volume * h * h)));
        Self::with_moments(volume, Vec3::zeros(), second)
    }

    /// Radius of the sphere of equal volume.
    pub fn equal_radius(&self) -> f64 {
        math::cbrt(0.75 * self.volume / PI)
    }

    /// `I = tr(C) 1 − C`, diagonal in the frame of the eigenvectors of `C`.
    fn with_moments(volume: f64, centre: Vec3, second: Matrix3<f64>) -> Self {
        let (values, axes) = principal(second);
        let trace: f64 = values.iter().sum();
        Self { volume, centre, moments: values.map(|value| trace - value), axes }
    }
}

/// Rotations until the off-diagonal entries are rounding.
const MAX_ROTATIONS: usize = 60;
/// Rounding of the off-diagonal entries (–): it must not rotate the axes of equal moments.
const OFF_DIAGONAL: f64 = 1e-14;

/// Eigenvalues of a symmetric matrix and a right-handed frame of eigenvectors, by Jacobi rotations.
/// A diagonal matrix keeps its axes, and so does a body its corners.
fn principal(mut a: Matrix3<f64>) -> ([f64; 3], Rotation3<f64>) {
    let mut axes = Matrix3::identity();
    let scale = a.norm();
    for sweep in 0..MAX_ROTATIONS {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][sweep % 3];
        let off = a[(p, q)];
        if off.abs() <= OFF_DIAGONAL * scale {
            continue;
        }
        let theta = 0.5 * (a[(q, q)] - a[(p, p)]) / off;
        let t = 1.0_f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
        let c = 1.0 / (t * t + 1.0).sqrt();
        let mut turn = Matrix3::identity();
        (turn[(p, p)], turn[(q, q)], turn[(p, q)], turn[(q, p)]) = (c, c, t * c, -t * c);
        a = turn.transpose() * a * turn;
        axes *= turn;
    }
    ([a[(0, 0)], a[(1, 1)], a[(2, 2)]], Rotation3::from_matrix_unchecked(axes))
}
