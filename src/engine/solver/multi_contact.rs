//! Several contacts of one rock at once: Gauss–Seidel sweeps, accelerated by Newton steps in the
//! six unknowns.
//!
//! Sweeps converge slowly where two stiff contacts nearly oppose or nearly repeat each other. With
//! the modes (open, closed, sticking, sliding) found by the sweeps, the stage is one linear system
//! for velocity and spin, the paper's 6×6 system of Eq. (4) for one rock; its solution is the limit
//! of the sweeps in these modes. The sweeps alone decide whether the result is accepted.
//!
//! ```text
//! sweep:  contact by contact, forces of the others held: closed form of `StageContact::solve`
//! jump:   (M/h + Σ N b Nᵀ + Σ Sᵀ J S …) x = M x_free/h + Σ N a − Σ Sᵀ q0      x = (v, ω), six unknowns
//! again:  (      the same matrix      ) δ = M (x_free − x)/h + Σ N F(x) − Σ Sᵀ q(x)
//! ```
//!
//! The rounding of a velocity times a large stiffness is an error of force: at 1e14 N/m a Newton
//! step leaves forces with relative errors up to 1e-7, and slow sweeps never converge. Newton steps
//! after the first therefore solve for the change `δ` of the motion, from which forces follow
//! beyond the rounding of the motion itself.
//!
//! Cost: a sweep is linear in the contacts, a Newton step one LU of 6×6 whatever their number.

use super::body::{Body, STILL, Twist};
use super::law::StageContact;
use super::linear_forces::{LinearForces, motion_under};
use crate::contact::submatrix::{Mat6, Vec6};
use crate::rock::Vec3;

/// Sweeps between two Newton steps.
const SWEEPS: u32 = 4;
/// Rounds of sweeps after which a stage is given up; the step is then shortened.
const ROUNDS: u32 = 12;
/// Change of a force, relative to the largest, at which the sweeps have converged (–).
const FORCES_CONVERGED: f64 = 1e-9;

/// Solves all contacts of one stage from `free`, velocity and spin without contact forces (gravity included).
///
/// Returns velocity and spin at the stage's end, or `None` without convergence; `sweeps` is a
/// counter.
pub(super) fn solve(
    body: &Body,
    contacts: &mut [StageContact],
    free: Twist,
    h: f64,
    sweeps: &mut u64,
) -> Option<Twist> {
    match contacts {
        [] => Some(free),
        [contact] => {
            *sweeps += 1;
            contact.solve(body, &free.0, &free.1, h);
            Some(motion_under(body, contacts, free, h))
        }
        several => sweeps_and_newton_steps(body, several, free, h, sweeps),
    }
}

/// Nonlinear Gauss–Seidel finds the modes, Newton's method the forces in these modes.
fn sweeps_and_newton_steps(
    body: &Body,
    contacts: &mut [StageContact],
    free: Twist,
    h: f64,
    sweeps: &mut u64,
) -> Option<Twist> {
    for contact in contacts.iter_mut() {
        // a guess for the normal force without one for friction would mislead
        (contact.normal_force, contact.shear_force, contact.rolling_moment) =
            (0.0, Vec3::zeros(), Vec3::zeros());
    }
    let mut now = free;
    for round in 0..ROUNDS {
        let mut converged_count = 0;
        for _ in 0..SWEEPS {
            *sweeps += 1;
            if sweep(body, contacts, (&mut now, &mut converged_count), h) {
                return Some(now);
            }
        }
        // after a singular system the sweeps go on
        let solution = if round == 0 {
            let motion =
                solve_linear(body, contacts, (&free, h), |one| one.linearised(body, &now, h));
            motion.map(|motion| (motion, STILL))
        } else {
            let free_change = (free.0 - now.0, free.1 - now.1);
            let change = |one: &StageContact| one.linearised_in_changes(body, &now, h);
            solve_linear(body, contacts, (&free_change, h), change).map(|change| (now, change))
        };
        if let Some((motion, change)) = solution {
            for contact in contacts.iter_mut() {
                contact.set_forces_at(body, [&motion, &change], h);
            }
            now = motion_under(body, contacts, free, h);
        }
    }
    None
}

/// One sweep; whether all contacts have converged. `converged_count` counts, across sweeps, the contacts
/// solved since the last change that matters: as soon as that is all of them, they agree.
fn sweep(
    body: &Body,
    contacts: &mut [StageContact],
    (now, converged_count): (&mut Twist, &mut usize),
    h: f64,
) -> bool {
    // changes are relative to the largest force, or to a thousandth of the weight where forces are
    // small
    let least = 1e-3 * body.mass * body.gravity.norm();
    let scale = contacts.iter().map(|contact| contact.normal_force).fold(least, f64::max);
    let count = contacts.len();
    for contact in contacts.iter_mut() {
        let change2 = contact.relax(body, now, h);
        *converged_count =
            if change2 <= (FORCES_CONVERGED * scale.max(contact.normal_force)).powi(2) {
                *converged_count + 1
            } else {
                1
            };
        if *converged_count >= count {
            return true;
        }
    }
    false
}

/// Solves the linear system of inertia, with `free` as the motion without contacts, and of the
/// linearised `forces`. Friction grows with the normal force, which makes the matrix unsymmetric:
/// LU, not Cholesky.
fn solve_linear(
    body: &Body,
    contacts: &[StageContact],
    (free, h): (&Twist, f64),
    forces: impl Fn(&StageContact) -> LinearForces,
) -> Option<Twist> {
    let (mut k, mut f) = (Mat6::zeros(), Vec6::zeros());
    LinearForces::of_inertia(body, free, h).add_to(&mut k, f.as_mut_slice());
    // open contacts have neither stiffness nor load
    for contact in contacts.iter().filter(|contact| contact.normal_force > 0.0) {
        forces(contact).add_to(&mut k, f.as_mut_slice());
    }
    let x = k.lu().solve(&f)?;
    let found = (x.fixed_rows::<3>(0).into(), x.fixed_rows::<3>(3).into());
    x.iter().all(|x| x.is_finite()).then_some(found)
}
