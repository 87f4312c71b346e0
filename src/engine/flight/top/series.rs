//! The torque-free rotation over a short time as a power series: a tenth of the cost of the
//! elliptic functions.
//!
//! In the body's frame `ℓ' = ℓ × I⁻¹ℓ`, and the quaternion from the start's frame obeys `q' = q ∘
//! I⁻¹ℓ/2`. The right-hand sides contain only products, so the terms follow from the previous ones
//! (Cauchy product). With `Ω = L/I_min` the terms are no larger than `L Ω^k` and `Ω^k` (by
//! induction), so the series is truncated where `(Ω t)^k` is below rounding: the truncation error
//! is known beforehand, for every body.

use super::is_asymmetric;
use crate::rock::Vec3;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};

/// Most terms.
const MAX_TERMS: usize = 18;
/// Largest time, as `Ω t` (rad): up to it 16 terms are exact to rounding.
const MAX_PHASE_RAD: f64 = 0.1;
/// A term no larger than this is below rounding (–).
const SMALLEST_TERM: f64 = 1e-17;

/// `Ω`: a bound on the spin of a body with this angular momentum (rad/s).
fn fastest_spin(inertia: [f64; 3], momentum: &Vec3) -> f64 {
    momentum.norm() / inertia.into_iter().fold(f64::INFINITY, f64::min)
}

/// A torque-free rotation around one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RotationSeries {
    start: Rotation3<f64>,
    /// Duration for which the series is valid (s).
    pub(crate) valid_s: f64,
    /// Terms of the quaternion from the start's frame, scalar first (1/s^k).
    terms: [[f64; 4]; MAX_TERMS],
    count: usize,
}

impl RotationSeries {
    /// The series of a body with three unequal moments (kg m²) at this attitude, with this angular
    /// momentum in the world (kg m²/s), for up to `asked_s` (s) or as long as the series is valid.
    /// `None` if the closed form is cheap: two or three equal moments, or no spin.
    pub(crate) fn of(
        inertia: [f64; 3],
        start: Rotation3<f64>,
        momentum: &Vec3,
        asked_s: f64,
    ) -> Option<Self> {
        if !is_asymmetric(inertia) {
            return None;
        }
        let fastest = fastest_spin(inertia, momentum);
        let valid_s = asked_s.min(MAX_PHASE_RAD / fastest);
        // without spin the time would be infinite
        if !(valid_s > 0.0 && fastest > 0.0 && valid_s.is_finite()) {
            return None;
        }
        let mut series = Self { start, valid_s, terms: [[0.0; 4]; MAX_TERMS], count: 1 };
        series.compute_terms(inertia, &start.inverse_transform_vector(momentum), fastest * valid_s);
        Some(series)
    }

    /// The series of a rotation for all of `t` (s); `None` also if it is not valid for so long.
    pub(crate) fn covering(
        inertia: [f64; 3],
        start: Rotation3<f64>,
        momentum: &Vec3,
        t: f64,
    ) -> Option<Self> {
        let reaches = t <= MAX_PHASE_RAD / fastest_spin(inertia, momentum);
        reaches.then(|| Self::of(inertia, start, momentum, t)).flatten()
    }

    /// Computes the terms for an angular momentum in the body's frame and times up to `phase` over
    /// `Ω`.
    fn compute_terms(&mut self, inertia: [f64; 3], own: &Vec3, phase: f64) {
        let mut momenta = [[0.0; 3]; MAX_TERMS];
        let mut spins = [[0.0; 3]; MAX_TERMS];
        momenta[0] = [own.x, own.y, own.z];
        let rate = |momentum: [f64; 3]| {
            [momentum[0] / inertia[0], momentum[1] / inertia[1], momentum[2] / inertia[2]]
        };
        spins[0] = rate(momenta[0]);
        // ℓ × I⁻¹ℓ along each axis: the product of the other two components times the difference of
        // the inverse moments
        let inverse_difference =
            |i: usize, j: usize| (inertia[i] - inertia[j]) / (inertia[i] * inertia[j]);
        let inverse_differences =
            [inverse_difference(1, 2), inverse_difference(2, 0), inverse_difference(0, 1)];
        self.terms[0] = [1.0, 0.0, 0.0, 0.0];
        let mut size = phase;
        while size > SMALLEST_TERM && self.count < MAX_TERMS {
            let k = self.count - 1;
            let (mut products, mut quaternion) = ([0.0; 3], [0.0; 4]);
            for j in 0..=k {
                let ([x, y, z], [x1, y1, z1]) = (momenta[j], momenta[k - j]);
                products[0] += y * z1;
                products[1] += z * x1;
                products[2] += x * y1;
                let [a, b, c] = spins[k - j];
                let [s, i, j, k] = self.terms[j];
                quaternion[0] -= i * a + j * b + k * c;
                quaternion[1] += s * a + j * c - k * b;
                quaternion[2] += s * b + k * a - i * c;
                quaternion[3] += s * c + i * b - j * a;
            }
            let share = 1.0 / self.count as f64;
            momenta[self.count] =
                std::array::from_fn(|i| products[i] * inverse_differences[i] * share);
            spins[self.count] = rate(momenta[self.count]);
            self.terms[self.count] = quaternion.map(|x| x * (0.5 * share));
            self.count += 1;
            size *= phase;
        }
    }

    /// The rotation from body to world `t` (s) after the start, within the valid duration.
    #[inline]
    pub(crate) fn attitude(&self, t: f64) -> Rotation3<f64> {
        let mut sum = [0.0; 4];
        for term in self.terms[..self.count].iter().rev() {
            for (sum, term) in sum.iter_mut().zip(term) {
                *sum = *sum * t + term;
            }
        }
        let [s, i, j, k] = sum;
        let quaternion = UnitQuaternion::new_normalize(Quaternion::new(s, i, j, k));
        self.start * quaternion.to_rotation_matrix()
    }
}
