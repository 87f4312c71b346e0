//! The 6×6 submatrices of one contact between a sphere and a fixed mesh, equation by equation.
//!
//! Wang, Jiao, Huang, Zheng, Zhao: *Model of Sphere-to-Edge Contact for Spherical Discontinuous
//! Deformation Analysis*, Int. J. Geomech. 17(12), 2017. Unknown is the displacement of one step,
//! `D = (d, r)`: three displacements of the centre (m) and three rotations about it (rad), Eq. (1).
//! What is called `K` goes into the matrix of Eq. (4), what is called `F` to its right-hand side.
//! Points are counted from the sphere's centre `C`: a step needs only differences, and map
//! coordinates would cost digits.
//!
//! `V` is the unit vector from the centre to the touched point; a
//! [`ContactPoint`](super::ContactPoint) carries its opposite. Three equations are corrected, each
//! where it stands: Eqs. (14), (16), (18).

use crate::rock::Vec3;
use nalgebra::{SMatrix, SVector};

/// Displacements and rotations of one sphere, or the forces and moments that belong to them.
pub type Vec6 = SVector<f64, 6>;
/// A diagonal block of the stiffness matrix.
pub type Mat6 = SMatrix<f64, 6, 6>;
/// From the motion of the sphere to that of one of its points.
pub type Mat3x6 = SMatrix<f64, 3, 6>;

/// Displacement matrix `T` of Eq. (3) for the point `p` of the sphere (m, from its centre): `u = T
/// D = d + r × p`.
#[inline]
pub fn displacement(p: &Vec3) -> Mat3x6 {
    #[rustfmt::skip]
    let t = Mat3x6::new(
        1.0, 0.0, 0.0,  0.0,  p.z, -p.y,
        0.0, 1.0, 0.0, -p.z,  0.0,  p.x,
        0.0, 0.0, 1.0,  p.y, -p.x,  0.0,
    );
    t
}

/// Point `P1` of the sphere that will touch, Eq. (5): `R V` (m, from the centre).
#[inline]
pub fn touching_point(v: &Vec3, radius_m: f64) -> Vec3 {
    v * radius_m
}

/// `λ` of Eq. (7): distance from `P1` to the touched point `P2` along `V` (m), negative when
/// pressed in.
#[inline]
pub fn gap(v: &Vec3, p1: &Vec3, p2: &Vec3) -> f64 {
    v.dot(&(p2 - p1))
}

/// `V_N = (V, 0)` of Eq. (9). It equals `Vᵀ T` because the lever of `P1` is parallel to `V`: a
/// normal force turns nothing.
#[inline]
pub fn normal_row(v: &Vec3) -> Vec6 {
    Vec6::new(v.x, v.y, v.z, 0.0, 0.0, 0.0)
}

/// Normal spring of a stiffness (N/m), Eq. (10): `p_N V_Nᵀ V_N → K`.
#[inline]
pub fn normal_stiffness(stiffness_n_m: f64, row: &Vec6) -> Mat6 {
    (row * stiffness_n_m) * row.transpose()
}

/// Normal spring pressed in or apart by `gap_m` at the step's start, Eq. (11): `p_N λ V_Nᵀ → F`.
#[inline]
pub fn normal_load(stiffness_n_m: f64, gap_m: f64, row: &Vec6) -> Vec6 {
    row * (stiffness_n_m * gap_m)
}

/// Shear spring of a stiffness (N/m), Eq. (13): `p_s (Tᵀ T − V_Nᵀ V_N) → K`.
#[inline]
pub fn shear_stiffness(stiffness_n_m: f64, t: &Mat3x6, row: &Vec6) -> Mat6 {
    (t.transpose() * t - row * row.transpose()) * stiffness_n_m
}

/// Shear spring stretched by `stretch` (m, tangent to the surface) at the step's start, in place of
/// Eq. (14): `−p_s Tᵀ ξ → F`.
///
/// As printed, `p_s Tᵀ (P2 − P1) − p_s λ V_Nᵀ` is identically zero: `P1` is placed anew on the
/// normal at every step, so `P2 − P1 = λ V`. The stretch has to be carried from step to step.
#[inline]
pub fn shear_load(stiffness_n_m: f64, t: &Mat3x6, stretch: &Vec3) -> Vec6 {
    force_at(t, &(stretch * -stiffness_n_m))
}

/// Part along the surface of the displacement `u` of `P1` (m), Eq. (16): `u − V (V·u)`.
///
/// The text calls it the projection on the edge; it is that on the plane normal to `V`.
#[inline]
pub fn slip(v: &Vec3, u: &Vec3) -> Vec3 {
    u - v * v.dot(u)
}

/// Friction on the sphere (N), Eqs. (17), (18): `−f Tᵀ (l m n)ᵀ → F`, `friction` being `f` times
/// the direction in which the sphere slides.
///
/// The sign is right only with the direction of the sphere's own slip. Eq. (15) calls `f` `f_s`: it
/// is `N tan φ`, and the paper takes `N = p_N d_p` of the last step's end.
#[inline]
pub fn friction_load(t: &Mat3x6, friction: &Vec3) -> Vec6 {
    force_at(t, &-friction)
}

/// A force (N) at a point: `Tᵀ f`, the force and its moment about the centre.
#[inline]
pub fn force_at(t: &Mat3x6, force: &Vec3) -> Vec6 {
    t.tr_mul(force)
}

/// Spring against rotation (N m/rad) about any axis through the centre: on the rotations' diagonal
/// `→ K`. Not in the paper: rolling friction.
#[inline]
pub fn rolling_stiffness(stiffness_n_m_rad: f64) -> Mat6 {
    let [x, y, z] = [stiffness_n_m_rad; 3];
    Mat6::from_diagonal(&Vec6::new(0.0, 0.0, 0.0, x, y, z))
}

/// A moment (N m) about the centre `→ F`.
#[inline]
pub fn moment_load(moment_n_m: &Vec3) -> Vec6 {
    Vec6::new(0.0, 0.0, 0.0, moment_n_m.x, moment_n_m.y, moment_n_m.z)
}

/// Inertia in a step of `dt` (s) with constant acceleration: `2 M/dt² → K`, `M = (m, I)`.
#[inline]
pub fn inertia(mass_kg: f64, inertia_kg_m2: f64, dt: f64) -> Mat6 {
    let (m, i) = (2.0 * mass_kg / (dt * dt), 2.0 * inertia_kg_m2 / (dt * dt));
    Mat6::from_diagonal(&Vec6::new(m, m, m, i, i, i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RADIUS: f64 = 0.5;
    const P: f64 = 3.0e3;

    fn unit() -> impl Strategy<Value = Vec3> {
        (-1.0..1.0f64, 0.0..std::f64::consts::TAU).prop_map(|(z, turn)| {
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * turn.cos(), r * turn.sin(), z)
        })
    }

    fn motion() -> impl Strategy<Value = Vec6> {
        proptest::array::uniform6(-1.0..1.0f64).prop_map(Vec6::from)
    }

    /// `d² = |P2 − (P1 + T D)|²`, Eq. (6), and its projection on `V`, Eq. (7).
    fn distances(v: &Vec3, lambda: f64, d: &Vec6) -> (f64, f64) {
        let p1 = touching_point(v, RADIUS);
        let p2 = v * (RADIUS + lambda);
        let off = p2 - (p1 + displacement(&p1) * d);
        (off.norm_squared(), v.dot(&off))
    }

    /// Normal energy, Eq. (8).
    fn normal_energy(v: &Vec3, lambda: f64, d: &Vec6) -> f64 {
        0.5 * P * distances(v, lambda, d).1.powi(2)
    }

    /// Shear energy, Eq. (12), with a stretch carried into the step.
    fn shear_energy(v: &Vec3, xi: &Vec3, d: &Vec6) -> f64 {
        let t = displacement(&touching_point(v, RADIUS));
        0.5 * P * (xi + slip(v, &(t * d))).norm_squared()
    }

    /// Negative gradient of an energy at `D = 0`: exact by central differences, as the energies are
    /// quadratic.
    fn pull(energy: impl Fn(&Vec6) -> f64) -> Vec6 {
        Vec6::from_fn(|k, _| {
            let d = Vec6::from_fn(|j, _| f64::from(j == k));
            0.5 * (energy(&-d) - energy(&d))
        })
    }

    /// Hessian of a quadratic energy, exact by differences.
    fn hessian(energy: impl Fn(&Vec6) -> f64) -> Mat6 {
        let e = |k: usize| Vec6::from_fn(|j, _| f64::from(j == k));
        Mat6::from_fn(|i, j| {
            energy(&(e(i) + e(j))) - energy(&e(i)) - energy(&e(j)) + energy(&Vec6::zeros())
        })
    }

    /// Differences of numbers of size `P`: a few dozen roundings.
    const ROUNDING: f64 = 1e-13 * P;

    proptest! {
        /// `u = d + r × p`: Eq. (3) is the small rotation of a rigid body.
        #[test]
        fn points_move_like_a_rigid_body(p in unit(), d in motion()) {
            let (shift, turn): (Vec3, Vec3) = (d.fixed_rows::<3>(0).into(), d.fixed_rows::<3>(3).into());
            prop_assert!((displacement(&p) * d - (shift + turn.cross(&p))).norm() < 1e-15 * 8.0);
        }

        /// A normal force has no lever: `Vᵀ T = V_N` but for one rounding of the lever's two
        /// products.
        #[test]
        fn a_normal_force_turns_nothing(v in unit()) {
            let t = displacement(&touching_point(&v, RADIUS));
            let lever = force_at(&t, &v) - normal_row(&v);
            prop_assert!(lever.norm() < 1e-16);
        }

        /// Eq. (10) is the Hessian of Eq. (8), Eq. (11) its negative gradient.
        #[test]
        fn normal_submatrices_are_derivatives_of_their_energy(v in unit(), lambda in -0.1..0.1f64) {
            let row = normal_row(&v);
            let energy = |d: &Vec6| normal_energy(&v, lambda, d);
            prop_assert!((normal_stiffness(P, &row) - hessian(energy)).norm() < 10.0 * ROUNDING);
            prop_assert!((normal_load(P, lambda, &row) - pull(energy)).norm() < 10.0 * ROUNDING);
        }

        /// Eq. (13) is the Hessian of Eq. (12), the corrected Eq. (14) its negative gradient.
        #[test]
        fn shear_submatrices_are_derivatives_of_their_energy(v in unit(), raw in unit()) {
            let (t, xi) = (displacement(&touching_point(&v, RADIUS)), slip(&v, &raw));
            let energy = |d: &Vec6| shear_energy(&v, &xi, d);
            let k = shear_stiffness(P, &t, &normal_row(&v));
            prop_assert!((k - hessian(energy)).norm() < 10.0 * ROUNDING);
            prop_assert!((shear_load(P, &t, &xi) - pull(energy)).norm() < 10.0 * ROUNDING);
        }

        /// `d_s² = d² − d_N²`: the energy of Eq. (12) without a carried stretch.
        #[test]
        fn shear_distance_is_what_the_normal_leaves(v in unit(), lambda in -0.1..0.1f64, d in motion()) {
            let (d2, d_n) = distances(&v, lambda, &d);
            let shear = shear_energy(&v, &Vec3::zeros(), &d) / (0.5 * P);
            prop_assert!((shear - (d2 - d_n * d_n)).abs() < 1e-14 * (1.0 + d2));
        }

        /// Symmetric and positive semidefinite: springs resist. Two directions of slip and no more
        /// for shear, one for the normal: rank 2 and 1.
        #[test]
        fn stiffness_is_symmetric_and_never_negative(v in unit()) {
            let row = normal_row(&v);
            let t = displacement(&touching_point(&v, RADIUS));
            for (k, rank) in [(normal_stiffness(P, &row), 1), (shear_stiffness(P, &t, &row), 2)] {
                prop_assert!((k - k.transpose()).norm() < ROUNDING);
                let values = k.symmetric_eigenvalues();
                prop_assert!(values.min() > -10.0 * ROUNDING);
                prop_assert_eq!(values.iter().filter(|x| **x > 1e-6 * P).count(), rank);
            }
        }

        /// Eq. (14) as printed is nothing, whatever the contact: there is no shear memory in it.
        #[test]
        fn the_printed_shear_load_vanishes(v in unit(), lambda in -0.1..0.1f64) {
            let p1 = touching_point(&v, RADIUS);
            let p2 = v * (RADIUS + lambda);
            let t = displacement(&p1);
            let printed = force_at(&t, &(p2 - p1)) * P - normal_load(P, gap(&v, &p1, &p2), &normal_row(&v));
            prop_assert!(printed.norm() < 1e-15 * P);
        }

        /// Friction along the sphere's own slip takes energy: `F · D = −f |slip|`.
        #[test]
        fn friction_opposes_the_slip_of_the_sphere(v in unit(), d in motion()) {
            let t = displacement(&touching_point(&v, RADIUS));
            let slipped = slip(&v, &(t * d));
            let force = 0.5 * P;
            let work = friction_load(&t, &(slipped.normalize() * force)).dot(&d);
            prop_assert!((work + force * slipped.norm()).abs() < 1e-14 * P);
        }
    }
}
