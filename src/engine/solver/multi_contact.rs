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
//! ```
//!
//! Cost: a sweep is linear in the contacts, a jump one LU of 6×6 whatever their number.

use super::body::Body;
use super::law::StageContact;
use crate::ground::NormalLine;
use crate::rock::Vec3;
use nalgebra::{Matrix3, SMatrix, SVector};

/// Sweeps between two jumps.
const SWEEPS: u32 = 4;
/// Jumps after which a stage is given up; the step is then halved.
const JUMPS: u32 = 12;
/// Change of a force, relative to the largest, below which the sweeps have settled (–).
const SETTLED: f64 = 1e-9;

type Matrix6 = SMatrix<f64, 6, 6>;
type Vector6 = SVector<f64, 6>;

/// Solves all contacts of one stage from `free`, velocity and spin without contact forces (gravity included).
///
/// Returns velocity and spin at the stage's end, or `None` if the sweeps do not settle; `sweeps` counts.
pub(super) fn solve(
    body: &Body,
    contacts: &mut [StageContact],
    free: (Vec3, Vec3),
    h: f64,
    sweeps: &mut u64,
) -> Option<(Vec3, Vec3)> {
    match contacts {
        [] => Some(free),
        [contact] => {
            *sweeps += 1;
            contact.solve(body, &free.0, &free.1, h);
            let (dv, dw) = contact.effect(body, h);
            Some((free.0 + dv, free.1 + dw))
        }
        several => sweep_and_jump(body, several, free, h, sweeps),
    }
}

/// Nonlinear Gauss–Seidel first, because it finds the modes; Newton in these modes, because it
/// finds the forces.
fn sweep_and_jump(
    body: &Body,
    contacts: &mut [StageContact],
    free: (Vec3, Vec3),
    h: f64,
    sweeps: &mut u64,
) -> Option<(Vec3, Vec3)> {
    for contact in contacts.iter_mut() {
        // Without a guess for friction a guess for the push alone would only mislead.
        (contact.normal_force, contact.shear_force, contact.rolling_moment) =
            (0.0, Vec3::zeros(), Vec3::zeros());
    }
    let mut now = free;
    for _ in 0..JUMPS {
        let mut calm = 0;
        for _ in 0..SWEEPS {
            *sweeps += 1;
            if sweep(body, contacts, (&mut now, &mut calm), h) {
                return Some(now);
            }
        }
        // a singular system is no harm: the sweeps simply go on
        if let Some(jumped) = jump(body, contacts, free, &now, h) {
            act_on(body, contacts, &jumped, h);
            now = driven(body, contacts, free, h);
        }
    }
    None
}

/// One pass over the contacts; whether all agree. `calm` counts those that were asked since anything they answer to has
/// changed.
///
/// Counts across sweeps: as soon as each contact has been asked once with nothing changed since,
/// all agree.
fn sweep(
    body: &Body,
    contacts: &mut [StageContact],
    ((v, w), calm): (&mut (Vec3, Vec3), &mut usize),
    h: f64,
) -> bool {
    // changes are measured by the largest force, and by a thousandth of the weight where there is
    // hardly any
    let least = 1e-3 * body.mass * body.gravity.norm();
    let scale = contacts.iter().map(|contact| contact.normal_force).fold(least, f64::max);
    let count = contacts.len();
    for contact in contacts.iter_mut() {
        let before = (contact.normal_force, contact.shear_force, contact.rolling_moment);
        let (dv, dw) = contact.effect(body, h);
        // without this contact's own forces: what the others do to the rock
        let (vf, wf) = (*v - dv, *w - dw);
        contact.solve(body, &vf, &wf, h);
        let (dv, dw) = contact.effect(body, h);
        (*v, *w) = (vf + dv, wf + dw);
        let change2 = (contact.normal_force - before.0)
            .powi(2)
            .max((contact.shear_force - before.1).norm_squared())
            .max((contact.rolling_moment - before.2).norm_squared() / body.radius.powi(2));
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

/// Free motion and all contact forces together.
fn driven(
    body: &Body,
    contacts: &[StageContact],
    (mut v, mut w): (Vec3, Vec3),
    h: f64,
) -> (Vec3, Vec3) {
    for contact in contacts {
        let (dv, dw) = contact.effect(body, h);
        v += dv;
        w += dw;
    }
    (v, w)
}

/// Sets every force to what its law gives at velocity and spin `at`.
///
/// After a jump: the linear system may have left a cone or let a spring pull; the law itself may
/// not.
fn act_on(body: &Body, contacts: &mut [StageContact], (v, w): &(Vec3, Vec3), h: f64) {
    for contact in contacts {
        let normal = contact.line(body, h);
        contact.normal_force = normal.at(contact.n.dot(v));
        let law = &contact.law;
        let (stick, wound) = contact.trials(body, v, w, h);
        contact.shear_force = law.shear.capped(stick, contact.normal_force);
        contact.rolling_moment = law.rolling.capped(wound, contact.normal_force);
    }
}

impl StageContact {
    /// Its normal force as a line, in the mode that it is in.
    pub(crate) fn line(&self, body: &Body, h: f64) -> NormalLine {
        self.normal.line((self.penetration, self.normal_force), body.mass, h)
    }
}

/// Velocity and spin that solve the stage linearised in its present modes.
/// Friction grows with the normal force, which makes the matrix unsymmetric: LU, not Cholesky.
fn jump(
    body: &Body,
    contacts: &[StageContact],
    free: (Vec3, Vec3),
    now: &(Vec3, Vec3),
    h: f64,
) -> Option<(Vec3, Vec3)> {
    let mut k = Matrix6::zeros();
    let mut f = Vector6::zeros();
    for axis in 0..3 {
        (k[(axis, axis)], k[(axis + 3, axis + 3)]) = (body.mass / h, body.inertia / h);
        (f[axis], f[axis + 3]) = (free.0[axis] * body.mass / h, free.1[axis] * body.inertia / h);
    }
    // open contacts have neither stiffness nor load
    for contact in contacts.iter().filter(|contact| contact.normal_force > 0.0) {
        add(&mut k, &mut f, body, contact, (now, h));
    }
    let x = k.lu().solve(&f)?;
    let found = (x.fixed_rows::<3>(0).into(), x.fixed_rows::<3>(3).into());
    x.iter().all(|x| x.is_finite()).then_some(found)
}

/// Adds one contact's forces, linear around `now`, to the system.
fn add(
    k: &mut Matrix6,
    f: &mut Vector6,
    body: &Body,
    contact: &StageContact,
    ((v, w), h): (&(Vec3, Vec3), f64),
) {
    let normal = contact.line(body, h);
    let (law, n, r) = (&contact.law, contact.n, body.radius);
    // Slip u = T x with T = [Q, R n×]; shear acts back through the same T.
    // S = [Q, R n×], the slip of the contact point from velocity and spin
    let q = Matrix3::identity() - n * n.transpose();
    let spin = n.cross_matrix() * r;
    let (stick, wound) = contact.trials(body, v, w, h);
    let normal_force = normal.at(n.dot(v));
    // The sweeps know the mode. What the law gives at `now` does not: a newton of another contact that has changed
    // since moves a stiff spring far beyond its cap.
    let shear = law.shear.left(h, (&contact.shear_force, contact.normal_force));
    let roll = law.rolling.left(h, (&contact.rolling_moment, contact.normal_force));
    let (shear, roll) = (shear.at(stick, normal_force), roll.at(wound, normal_force));
    let slip = body.slip(&n, v, w);
    // q ≈ q0 + J (u − u0) − e μ b (s − s0), and the same for the moment.
    let drag0 = shear.force - shear.jacobian * slip + shear.along * (normal.b * n.dot(v));
    let moment0 = roll.force - roll.jacobian * w + roll.along * (normal.b * n.dot(v));
    let (jq, js) = (q * shear.jacobian * q, shear.jacobian * spin);
    let coupling = shear.along * n.transpose() * normal.b;
    let (vv, vw) = (n * n.transpose() * normal.b + jq - coupling, q * js);
    let wv =
        spin.transpose() * (shear.jacobian * q - coupling) - roll.along * n.transpose() * normal.b;
    let ww = spin.transpose() * js + roll.jacobian;
    for (row, column, block) in [(0, 0, vv), (0, 3, vw), (3, 0, wv), (3, 3, ww)] {
        let mut place = k.fixed_view_mut::<3, 3>(row, column);
        place += block;
    }
    let mut force = f.fixed_rows_mut::<3>(0);
    force += n * normal.a - drag0;
    let mut torque = f.fixed_rows_mut::<3>(3);
    torque -= spin.transpose() * drag0 + moment0;
}
