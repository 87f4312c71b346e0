//! A contact with the mesh among others of a stage: its Gauss–Seidel update, its forces at a given
//! motion, and its linearisation for Newton steps.
//!
//! ```text
//! normal:  F = a − b s,  s = n·v                                  (open contacts are left out)
//! shear:   q = q0 + J (u − u0) + μ e (F − F0)                     sticking: J = κ 1;  sliding: J = κ cap/|trial| (1 − e eᵀ)
//! rolling: M = M0 + J_r (ω − ω0) + μ_r e_r (F − F0)
//! on the rock:  Σ (n F − q),  Σ (R n × q − M),                    u = T x with T = [1 − n nᵀ, R n×]
//! ```
//!
//! Used for a rock alone ([`multi_contact`](super::multi_contact)) and for the rocks of an island.

use super::body::{Body, Twist};
use super::law::StageContact;
use crate::contact::submatrix::Mat6;
use crate::ground::NormalLine;
use nalgebra::Matrix3;

/// Forces on a rock over a stage, linear in velocity and spin: load minus stiffness times both.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearForces {
    /// Decrease of force (first row) and moment with velocity (first column) and spin (N s/m; N s;
    /// N m s).
    pub(super) stiffness: [[Matrix3<f64>; 2]; 2],
    /// Force and moment at zero velocity and spin (N, N m).
    pub(super) load: Twist,
}

impl StageContact {
    /// Normal force linearised in its present mode.
    pub(crate) fn line(&self, body: &Body, h: f64) -> NormalLine {
        self.normal.line((self.penetration, self.normal_force), body.mass, h)
    }

    /// One Gauss–Seidel update: solves the contact for fixed forces of all others. `now` is the
    /// motion under all forces. Returns the square of the largest change of a force (N²), the
    /// rolling moment taken over the radius.
    pub(super) fn relax(&mut self, body: &Body, now: &mut Twist, h: f64) -> f64 {
        let before = (self.normal_force, self.shear_force, self.rolling_moment);
        let (dv, dw) = self.effect(body, h);
        // the motion without this contact's own forces
        let (vf, wf) = (now.0 - dv, now.1 - dw);
        self.solve(body, &vf, &wf, h);
        let (dv, dw) = self.effect(body, h);
        *now = (vf + dv, wf + dw);
        (self.normal_force - before.0)
            .powi(2)
            .max((self.shear_force - before.1).norm_squared())
            .max((self.rolling_moment - before.2).norm_squared() / body.radius.powi(2))
    }

    /// Sets the forces to those of the law at a motion plus a change of it. The change stands apart
    /// because it is known beyond the rounding of the motion.
    ///
    /// After a Newton step the linear system may have left a friction cone or let a spring pull;
    /// the law does not.
    pub(super) fn set_forces_at(&mut self, body: &Body, [(v, w), (dv, dw)]: [&Twist; 2], h: f64) {
        let NormalLine { a, b } = self.line(body, h);
        self.normal_force = (a - b * self.n.dot(v) - b * self.n.dot(dv)).max(0.0);
        let (trial_force, trial_moment) = self.trial_forces(body, v, w, h);
        let trial_force =
            trial_force + body.slip(&self.n, dv, dw) * self.law.shear.stage_stiffness(h);
        let trial_moment = trial_moment + dw * self.law.rolling.stage_stiffness(h);
        self.shear_force = self.law.shear.capped(trial_force, self.normal_force);
        self.rolling_moment = self.law.rolling.capped(trial_moment, self.normal_force);
    }

    /// Forces linearised around a motion in the present modes.
    pub(super) fn linearised(&self, body: &Body, motion: &Twist, h: f64) -> LinearForces {
        self.linearised_at(body, motion, h).0
    }

    /// The same in terms of changes of the motion: the load is then the force at the motion itself.
    pub(super) fn linearised_in_changes(
        &self,
        body: &Body,
        motion: &Twist,
        h: f64,
    ) -> LinearForces {
        let (forces, at_motion) = self.linearised_at(body, motion, h);
        LinearForces { load: at_motion, ..forces }
    }

    /// Forces linearised around the motion `(v, w)`, and force and moment there.
    fn linearised_at(&self, body: &Body, (v, w): &Twist, h: f64) -> (LinearForces, Twist) {
        let normal = self.line(body, h);
        let (law, n, r) = (&self.law, self.n, body.radius);
        // slip u = T x with T = [Q, R n×]; shear acts back through the same T
        let q = Matrix3::identity() - n * n.transpose();
        let spin = n.cross_matrix() * r;
        let (trial_force, trial_moment) = self.trial_forces(body, v, w, h);
        let normal_force = normal.at(n.dot(v));
        // The modes are those of the sweeps and not those of the law at `(v, w)`: a change of a
        // newton in another contact since then moves a stiff spring far beyond its cap.
        let shear = law.shear.stage_slider(h, (&self.shear_force, self.normal_force));
        let roll = law.rolling.stage_slider(h, (&self.rolling_moment, self.normal_force));
        let (shear, roll) =
            (shear.at(trial_force, normal_force), roll.at(trial_moment, normal_force));
        let slip = body.slip(&n, v, w);
        // q ≈ q0 + J (u − u0) − e μ b (s − s0), and the same for the moment.
        let drag0 = shear.force - shear.jacobian * slip + shear.along * (normal.b * n.dot(v));
        let moment0 = roll.force - roll.jacobian * w + roll.along * (normal.b * n.dot(v));
        let (jq, js) = (q * shear.jacobian * q, shear.jacobian * spin);
        let coupling = shear.along * n.transpose() * normal.b;
        let (vv, vw) = (n * n.transpose() * normal.b + jq - coupling, q * js);
        let wv = spin.transpose() * (shear.jacobian * q - coupling)
            - roll.along * n.transpose() * normal.b;
        let ww = spin.transpose() * js + roll.jacobian;
        // the same expressions as in `set_forces_at`
        let push = n * (normal.a - normal.b * n.dot(v));
        let at_motion = (push - shear.force, -(spin.transpose() * shear.force + roll.force));
        let load = (n * normal.a - drag0, -(spin.transpose() * drag0 + moment0));
        (LinearForces { stiffness: [[vv, vw], [wv, ww]], load }, at_motion)
    }
}

/// Motion under inertia, weight and all contact forces of a rock.
pub(super) fn motion_under(body: &Body, contacts: &[StageContact], free: Twist, h: f64) -> Twist {
    contacts.iter().fold(free, |(v, w), contact| {
        let (dv, dw) = contact.effect(body, h);
        (v + dv, w + dw)
    })
}

impl LinearForces {
    /// The terms of inertia: without contacts the solution is the free motion.
    pub(super) fn of_inertia(body: &Body, free: &Twist, h: f64) -> Self {
        let [m, i] = [body.mass / h, body.inertia / h];
        let diagonal = |inertia: f64| Matrix3::identity() * inertia;
        Self {
            stiffness: [[diagonal(m), Matrix3::zeros()], [Matrix3::zeros(), diagonal(i)]],
            // with the same numbers as the diagonal: a free motion comes out without rounding
            load: (free.0 * m, free.1 * i),
        }
    }

    /// Adds it to the 6×6 block of its rock and to its six loads.
    pub(super) fn add_to(&self, k: &mut Mat6, load: &mut [f64]) {
        for (i, blocks) in self.stiffness.iter().enumerate() {
            for (j, block) in blocks.iter().enumerate() {
                let mut place = k.fixed_view_mut::<3, 3>(3 * i, 3 * j);
                place += block;
            }
        }
        for axis in 0..3 {
            load[axis] += self.load.0[axis];
            load[3 + axis] += self.load.1[axis];
        }
    }
}
