//! Newton steps for sustained contact: where sweeps converge slowly, the rocks that still change are solved at once.
//!
//! With a light rock under a heavy one, or in a high pile, each sweep passes on a small share of the load. With the
//! contact modes that the sweeps have found the step is a linear system, that of [`solve_linearised`]. A rigid contact
//! stands there as a spring so stiff that its compliance is far below the tolerance. The sweeps check the result.
//!
//! In terms of a stage: `h = 1`, `p_N = 1e7 m_max` per unit of speed, and the target speed in place of penetration.
//! A contact then gives way by `J/p_N`, 1e-7 of the speed that the impulse gives the heaviest rock.

use super::RigidIsland;
use super::contacts::{BallContact, StepBody};
use crate::contact::pair::{PairHistory, PairImpact};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::{Body, Twist};
use crate::solver::island::body::BodySlot;
use crate::solver::island::newton_step::solve_linearised;
use crate::solver::island::pair_contact::PairContact;
use crate::solver::law::StageContact;
use crate::solver::rigid::GroundContact;

/// Stiffness (impulse over speed) of the spring that stands for a rigid contact, over the largest mass (–).
const HOLD_BY_SPEED: f64 = 1e7;
/// For more rocks than this a Newton step costs more than the sweeps that it may save.
const MOST_ROCKS: usize = 64;

impl RigidIsland {
    /// Solves the rocks whose motion has changed since `versions`, and their neighbours, at once; whether that was
    /// possible.
    ///
    /// Cost: one factorisation over these rocks. Modes (closed, sliding) are those of the last sweep; if they were
    /// wrong, the sweeps that follow show it, and `converge` undoes the step.
    pub(super) fn newton_step(
        &mut self,
        (members, pair_histories): (&mut [BodySlot], &[PairHistory]),
        versions: &[u32],
    ) -> bool {
        let takes_part = self.changed_since(versions);
        if takes_part.iter().filter(|part| **part).count() > MOST_ROCKS {
            return false;
        }
        // one stiffness for all contacts: mass ratios are in the matrix, and the compliance of a contact
        // is small against the heaviest rock
        let heaviest = self.balls.iter().map(|ball| ball.body.mass).fold(0.0, f64::max);
        let stiffness = HOLD_BY_SPEED * heaviest;
        self.set_up_newton(members, stiffness);
        let pair = |ball_contact: &BallContact| {
            let ends = ball_contact.ends.map(|k| &self.balls[k].body);
            ball_contact.as_pair_contact(
                &pair_histories[ball_contact.pair_history],
                ends,
                stiffness,
            )
        };
        let pairs: Vec<PairContact> = self.ball_contacts.iter().map(pair).collect();
        let now: Vec<Twist> = self.balls.iter().map(|ball| (ball.v, ball.w)).collect();
        let solved = solve_linearised((&*members, &now), &pairs, &takes_part, 1.0);
        let Some(motions) = solved else { return false };
        self.apply_newton_solution(&motions, stiffness);
        self.resum_impulses();
        true
    }

    /// Rocks whose motion has changed, and those that touch them.
    ///
    /// `versions` are those of a sweep ago: rocks that have changed since have not converged. Neighbours take part,
    /// because their contacts must be free to change too.
    fn changed_since(&self, versions: &[u32]) -> Vec<bool> {
        let core: Vec<bool> = self
            .balls
            .iter()
            .zip(versions)
            .map(|(ball, versions)| ball.version != *versions)
            .collect();
        let mut grown = core.clone();
        for [a, b] in self
            .ball_contacts
            .iter()
            .filter(|ball_contact| ball_contact.normal_impulse > 0.0)
            .map(|ball_contact| ball_contact.ends)
        {
            grown[a] |= core[b];
            grown[b] |= core[a];
        }
        grown
    }

    /// Writes free motions and contacts with the mesh as a stage of length one, with impulses for forces.
    fn set_up_newton(&self, members: &mut [BodySlot], stiffness: f64) {
        for (member, ball) in members.iter_mut().zip(&self.balls) {
            let member = &mut **member;
            // free motion of the step: velocity at its start plus weight, without impulses
            member.free = (ball.before.0 + self.gain(ball), ball.before.1);
            member.state.contact_count = 0;
        }
        for ground_contact in &self.ground_contacts {
            let member = &mut *members[ground_contact.rock];
            let state = &mut member.state;
            // no more contacts than a rock can keep: the sweeps solve those left out
            if state.contact_count < state.contacts.len() {
                state.contacts[state.contact_count] =
                    ground_contact.as_stage_contact(member.body.radius, stiffness);
                state.contact_count += 1;
            }
        }
    }

    /// Takes over the motions of a Newton step, and sets every impulse of these rocks by its stiff spring.
    fn apply_newton_solution(&mut self, motions: &[Option<Twist>], stiffness: f64) {
        for (ball, motion) in self.balls.iter_mut().zip(motions) {
            if let Some((v, w)) = motion {
                (ball.v, ball.w) = (*v, *w);
            }
        }
        for ground_contact in self
            .ground_contacts
            .iter_mut()
            .filter(|ground_contact| motions[ground_contact.rock].is_some())
        {
            ground_contact.set_from_compliance(&self.balls[ground_contact.rock], stiffness);
        }
        for ball_contact in &mut self.ball_contacts {
            if ball_contact.ends.iter().any(|&k| motions[k].is_some()) {
                let [a, b] = ball_contact.ends.map(|k| &self.balls[k]);
                ball_contact.normal_impulse =
                    (stiffness * (ball_contact.target_m_s - ball_contact.speed(a, b))).max(0.0);
                ball_contact.shear_impulse = ball_contact
                    .limits
                    .shear(ball_contact.slip(a, b) * stiffness, ball_contact.normal_impulse);
            }
        }
    }

    /// Sets the motions to those that weight and all impulses give together.
    ///
    /// Summing anew keeps the rounding of many small changes from adding up.
    fn resum_impulses(&mut self) {
        for k in 0..self.balls.len() {
            let gain = self.gain(&self.balls[k]);
            let ball = &mut self.balls[k];
            (ball.v, ball.w) = (ball.before.0 + gain, ball.before.1);
            ball.version += 1;
        }
        self.warm_start();
    }

    /// What weight adds to the velocity in the current step.
    /// `g Δt` (m/s).
    fn gain(&self, ball: &StepBody) -> Vec3 {
        ball.body.gravity * self.dt
    }
}

impl GroundContact {
    /// The contact with the mesh as a contact of a stage; signs turn, as there shear forces act against slip.
    fn as_stage_contact(&self, radius: f64, stiffness: f64) -> StageContact {
        let law = Law::penalty(stiffness, self.limits, radius);
        StageContact {
            feature: self.feature,
            triangle: self.triangle,
            normal: law.normal(false),
            law,
            n: *self.n(),
            penetration: self.target_m_s,
            normal_force: self.normal_impulse,
            shear_force: -self.shear_impulse,
            rolling_moment: -self.rolling_impulse,
            ..StageContact::NONE
        }
    }

    /// Impulses of the stiff springs at the rock's new motion, projected onto the cones.
    fn set_from_compliance(&mut self, ball: &StepBody, stiffness: f64) {
        self.normal_impulse = (stiffness * (self.target_m_s - self.n().dot(&ball.v))).max(0.0);
        let slip = ball.body.slip(self.n(), &ball.v, &ball.w);
        let wound = ball.w * (stiffness * ball.body.radius.powi(2));
        self.shear_impulse = -self.limits.shear(slip * stiffness, self.normal_impulse);
        self.rolling_impulse = -self.limits.rolling(wound, self.normal_impulse);
    }
}

impl BallContact {
    /// The same for two rocks.
    fn as_pair_contact(
        &self,
        pair_history: &PairHistory,
        bodies: [&Body; 2],
        stiffness: f64,
    ) -> PairContact {
        let law = Law::penalty(stiffness, self.limits, 1.0);
        PairContact {
            pair_history: self.pair_history,
            ends: self.ends,
            normal: law.normal(false),
            law,
            captured: pair_history.captured,
            impact: PairImpact::default(),
            deferred: false,
            bond: None,
            n: self.n,
            penetration: self.target_m_s,
            shear: Vec3::zeros(),
            levers: self.levers,
            normal_force: self.normal_impulse,
            shear_force: self.shear_impulse,
            inertia: bodies.map(|body| (body.mass, body.inertia)),
            inv_m: self.inv.0,
            inv_t: self.inv.1,
        }
    }
}
