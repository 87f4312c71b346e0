//! Several contacts of one rock at once: sweeps, helped along by Newton jumps in the six unknowns.
//!
//! Sweeping contact by contact settles slowly where two stiff contacts nearly oppose or nearly repeat each other.
//! With the modes (open, closed, sticking, sliding) that the sweeps have found, the stage is one linear system for
//! velocity and spin, the paper's 6×6 system of Eq. (4) for one rock; solving it jumps to where the sweeps were
//! heading. The sweeps alone decide whether the result holds.
//!
//! ```text
//! sweep:  contact by contact, forces of the others held: closed form of `StageContact::solve`
//! jump:   (M/h + Σ N b Nᵀ + Σ Sᵀ J S …) x = M x_free/h + Σ N a − Σ Sᵀ q0      x = (v, ω), six unknowns
//! again:  (      the same matrix      ) δ = M (x_free − x)/h + Σ N F(x) − Σ Sᵀ q(x)
//! ```
//!
//! A velocity is rounded, and times a large stiffness that is a force: at 1e14 N/m a jump leaves forces that are known to
//! 1e-7 of their size and better, and sweeps that creep never settle. Jumps after the first therefore ask for the change `δ` of the
//! motion, from which forces follow beyond the rounding of the motion itself.
//!
//! Cost: a sweep is linear in the contacts, a jump one LU of 6×6 whatever their number.

use super::body::{Body, STILL, Twist};
use super::law::StageContact;
use super::linear_forces::{LinearForces, motion_under};
use crate::contact::submatrix::{Mat6, Vec6};
use crate::rock::Vec3;

/// Sweeps between two jumps.
const SWEEPS: u32 = 4;
/// Jumps after which a stage is given up; the step is then halved.
const JUMPS: u32 = 12;
/// Change of a force, relative to the largest, below which the sweeps have settled (–).
const SETTLED: f64 = 1e-9;

/// Solves all contacts of one stage from `free`, velocity and spin without contact forces (gravity included).
///
/// Returns velocity and spin at the stage's end, or `None` if the sweeps do not settle; `sweeps` counts.
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
        several => sweep_and_jump(body, several, free, h, sweeps),
    }
}

/// Nonlinear Gauss–Seidel first, because it finds the modes; Newton in these modes, because it finds the forces.
fn sweep_and_jump(
    body: &Body,
    contacts: &mut [StageContact],
    free: Twist,
    h: f64,
    sweeps: &mut u64,
) -> Option<Twist> {
    for contact in contacts.iter_mut() {
        // Without a guess for friction a guess for the push alone would only mislead.
        (contact.normal_force, contact.shear_force, contact.rolling_moment) =
            (0.0, Vec3::zeros(), Vec3::zeros());
    }
    let mut now = free;
    for round in 0..JUMPS {
        let mut calm = 0;
        for _ in 0..SWEEPS {
            *sweeps += 1;
            if sweep(body, contacts, (&mut now, &mut calm), h) {
                return Some(now);
            }
        }
        // a singular system is no harm: the sweeps simply go on
        let jumped = if round == 0 {
            let motion = solved(body, contacts, (&free, h), |one| one.linearised(body, &now, h));
            motion.map(|motion| (motion, STILL))
        } else {
            let missing = (free.0 - now.0, free.1 - now.1);
            let change = |one: &StageContact| one.linearised_in_changes(body, &now, h);
            solved(body, contacts, (&missing, h), change).map(|change| (now, change))
        };
        if let Some((motion, change)) = jumped {
            for contact in contacts.iter_mut() {
                contact.set_forces_at(body, [&motion, &change], h);
            }
            now = motion_under(body, contacts, free, h);
        }
    }
    None
}

/// One pass over the contacts; whether all agree. `calm` counts, across sweeps, those that were asked since anything they answer to has
/// changed: as soon as that is each of them, all agree.
fn sweep(
    body: &Body,
    contacts: &mut [StageContact],
    (now, calm): (&mut Twist, &mut usize),
    h: f64,
) -> bool {
    // changes are measured by the largest force, and by a thousandth of the weight where there is
    // hardly any
    let least = 1e-3 * body.mass * body.gravity.norm();
    let scale = contacts.iter().map(|contact| contact.normal_force).fold(least, f64::max);
    let count = contacts.len();
    for contact in contacts.iter_mut() {
        let change2 = contact.relax(body, now, h);
        *calm = if change2 <= (SETTLED * scale.max(contact.normal_force)).powi(2) {
            *calm + 1
        } else {
            1
        };
        if *calm >= count {
            return true;
        }
    }
    false
}

/// What solves the linear system of inertia, which would move by `free` without contacts, and of their linear `forces`.
/// Friction grows with the normal force, which makes the matrix unsymmetric: LU, not Cholesky.
fn solved(
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
