//! Newton steps for a whole island: the stage linearised in the contact modes that the sweeps have found.
//!
//! The paper's global system of 6×6 blocks, Eq. (4), with the change of friction with the normal force, which makes it
//! unsymmetric.
//!
//! Gauss–Seidel sweeps over the contacts find quickly which contacts press, stick or slip, but
//! converge slowly in heaps: a load travels one contact a sweep. With these modes fixed the stage
//! is smooth, and one linear solve over all rocks that take part replaces many sweeps. The sweeps
//! then check the modes again.
//! ```text
//! normal:  F = a − b s,  s = n·(v_1 − v_2)              (open contacts are left out)
//! shear:   q = q0 + J (u − u0) + μ e (F − F0)           sticking: J = κ 1;  sliding: J = κ cap/|trial| (1 − e eᵀ)
//! rows:    N = ± (n, 0),   S = (± Q, lever n×)          of one end, so s = Σ N x and u = Σ S x
//! ```

use super::body::BodySlot;
use super::pair_contact::PairContact;
use crate::contact::submatrix::{Mat3x6, Mat6, Vec6};
use crate::ground::{LinearFriction, NormalLine};
use crate::rock::Vec3;
use crate::solver::block_factor::{BlockFactor, BlockSystem, LowerBlock};
use crate::solver::body::{STILL, Twist};
use crate::solver::linear_forces::LinearForces;
use nalgebra::{DMatrix, DVector, Matrix3};

/// Most rocks for which a dense matrix with column pivoting is as cheap.
const DENSE: usize = 8;

/// A contact linearised around the present motion.
struct LinearContact {
    /// Normal force (N) as a linear function of the normal speed.
    normal: NormalLine,
    /// Shear force (N) linearised in slip (m/s) and normal force.
    shear: LinearFriction,
    /// Slip and normal speed there, by the ends that are unknowns.
    slip: Vec3,
    speed: f64,
    /// Unit normal, from the second body (or the mesh) to the first.
    n: Vec3,
    /// Its ends that are unknowns: place, sign of the first or second body, lever.
    ends: [Option<(usize, f64, f64)>; 2],
}

/// Six rows for each body of the island.
struct NewtonSystem {
    /// `K_kk`: inertia over `h`, and the contacts of rock `k` with mesh and others (kg/s, kg m²/s).
    diagonal: Vec<Mat6>,
    /// Blocks that couple two rocks: the one below the diagonal, and the one opposite.
    off_diagonal: Vec<(LowerBlock, Mat6)>,
    /// Right side: impulse rates of free motion and of the constant parts of contacts (N, N m), six a rock.
    load: Vec<f64>,
}

/// Motions that solve the stage of length `h`, linearised around the present ones, for the rocks that take part.
///
/// `takes_part` makes the solve local: rocks that have converged keep their motion and enter as moving supports.
pub(super) fn solve_linearised(
    (members, motions): (&[BodySlot], &[Twist]),
    pairs: &[PairContact],
    takes_part: &[bool],
    h: f64,
) -> Option<Vec<Option<Twist>>> {
    let mut rocks = 0;
    let place: Vec<Option<usize>> = takes_part
        .iter()
        .map(|&part| {
            rocks += usize::from(part);
            part.then(|| rocks - 1)
        })
        .collect();
    // rows are numbered over the rocks that take part; others enter through the load
    let (diagonal, load) = (vec![Mat6::zeros(); rocks], vec![0.0; 6 * rocks]);
    let mut system = NewtonSystem { diagonal, off_diagonal: Vec::with_capacity(pairs.len()), load };
    for ((member, motion), place) in members.iter().zip(motions).zip(&place) {
        let Some(k) = *place else { continue };
        let own = &mut (&mut system.diagonal[k], &mut system.load[6 * k..6 * k + 6]);
        LinearForces::of_inertia(&member.body, &member.free, h).add_to(own.0, own.1);
        for contact in member.contacts().iter().filter(|contact| contact.normal_force > 0.0) {
            // the mesh is an end that does not move: only `K_kk` changes
            contact.linearised(&member.body, motion, h).add_to(own.0, own.1);
        }
    }
    for pair in pairs.iter().filter(|pair| pair.normal_force > 0.0 || pair.bond.is_some()) {
        if pair.ends.iter().any(|&end| place[end].is_some()) {
            system.add(&LinearContact::of_pair(pair, motions, &place, h));
        }
    }
    let solved = system.solve()?;
    Some(place.iter().map(|place| place.map(|k| solved[k])).collect())
}

impl LinearContact {
    /// The contact of two rocks, or their bond. A bond pulls as well as pushes and has no friction cap.
    fn of_pair(pair: &PairContact, motions: &[Twist], place: &[Option<usize>], h: f64) -> Self {
        let ends = pair.ends.map(|k| &motions[k]);
        let (law, speed, trial) = (&pair.law, pair.speed(ends), pair.trial(ends, h));
        let (normal, slider) = if pair.bond.is_some() {
            (pair.normal.bond(pair.penetration, h), law.shear.bonded_slider(h))
        } else {
            (pair.line(h), law.shear.stage_slider(h, (&pair.shear_force, pair.normal_force)))
        };
        // only ends that are unknowns enter here: the others are in the constants
        let sought = [0, 1].map(|k| if place[pair.ends[k]].is_some() { ends[k] } else { &STILL });
        let own = pair.speed(sought);
        Self {
            // an end that does not take part has a fixed motion: its share of the normal speed
            // belongs to the constant
            normal: NormalLine { a: normal.a - normal.b * (speed - own), ..normal },
            shear: slider.at(trial, normal.at(speed)),
            slip: pair.slip(sought),
            speed: own,
            n: pair.n,
            ends: [0, 1].map(|k| {
                place[pair.ends[k]].map(|at| (at, if k == 0 { 1.0 } else { -1.0 }, pair.levers[k]))
            }),
        }
    }
}

impl NewtonSystem {
    /// `K_kl += N_kᵀ b N_l + S_kᵀ (J S_l − e μ b N_l)`, with the rows `N` of the normal speed and `S` of the slip.
    fn add(&mut self, contact: &LinearContact) {
        let LinearContact { normal, shear, n, .. } = contact;
        let constant =
            shear.force - shear.jacobian * contact.slip + shear.along * (normal.b * contact.speed);
        let rows = contact.ends.map(|end| end.map(|(k, sign, lever)| (k, rows(n, sign, lever))));
        let block = |(n_k, s_k): &(Vec6, Mat3x6), (n_l, s_l): &(Vec6, Mat3x6)| {
            let shear_force = shear.jacobian * s_l - (shear.along * normal.b) * n_l.transpose();
            (n_k * normal.b) * n_l.transpose() + s_k.transpose() * shear_force
        };
        for (k, one) in rows.iter().flatten() {
            self.diagonal[*k] += block(one, one);
            let load = one.0 * normal.a - one.1.transpose() * constant;
            for row in 0..6 {
                self.load[6 * k + row] += load[row];
            }
        }
        if let [Some((k, one)), Some((l, two))] = &rows {
            // K_kl ≠ K_lkᵀ: friction depends on the normal force, and that on both ends
            let (below, above) = (block(one, two), block(two, one));
            self.off_diagonal.push(if k > l {
                ((*k, *l, below), above)
            } else {
                ((*l, *k, above), below)
            });
        }
    }

    /// The motions, or `None` if the matrix is singular. Few rocks: dense LU with pivots, O(n³);
    /// more: block factors in an order of least fill.
    fn solve(mut self) -> Option<Vec<Twist>> {
        self.off_diagonal.sort_by_key(|((row, column, _), _)| (*column, *row));
        let x =
            if self.diagonal.len() <= DENSE { self.solve_dense()? } else { self.solve_sparse()? };
        let at = |k: usize| Vec3::new(x[k], x[k + 1], x[k + 2]);
        let finite = x.iter().all(|x| x.is_finite());
        finite.then(|| (0..x.len() / 6).map(|k| (at(6 * k), at(6 * k + 3))).collect())
    }

    /// One dense matrix of 6 rows a rock.
    fn solve_dense(self) -> Option<Vec<f64>> {
        let size = self.load.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut add = |row: usize, column: usize, block: &Mat6| {
            let mut home = matrix.fixed_view_mut::<6, 6>(6 * row, 6 * column);
            home += block;
        };
        self.diagonal.iter().enumerate().for_each(|(k, block)| add(k, k, block));
        for ((row, column, below), above) in &self.off_diagonal {
            add(*row, *column, below);
            add(*column, *row, above);
        }
        let mut load = DVector::from_vec(self.load);
        matrix.lu().solve_mut(&mut load).then(|| load.data.into())
    }

    /// Sparse factorisation with blocks only where rocks touch.
    fn solve_sparse(self) -> Option<Vec<f64>> {
        let (below, above): (Vec<LowerBlock>, Vec<Mat6>) = self.off_diagonal.into_iter().unzip();
        let blocks = BlockSystem { diagonal: &self.diagonal, below: &below, above: Some(&above) };
        let mut load = self.load;
        BlockFactor::default().solve(blocks, &mut load).map(|()| load)
    }
}

/// Rows of normal speed and slip of one end.
///
/// The lever is `R` for both ends with the same sign: spins of two rocks rolling on each other add
/// up in the slip.
fn rows(n: &Vec3, sign: f64, lever: f64) -> (Vec6, Mat3x6) {
    let across = (Matrix3::identity() - n * n.transpose()) * sign;
    let mut slip = Mat3x6::zeros();
    slip.fixed_view_mut::<3, 3>(0, 0).copy_from(&across);
    slip.fixed_view_mut::<3, 3>(0, 3).copy_from(&(n.cross_matrix() * lever));
    (Vec6::new(n.x * sign, n.y * sign, n.z * sign, 0.0, 0.0, 0.0), slip)
}
