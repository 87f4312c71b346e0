//! Where sweeps creep, the stirred part of the island is solved at once.
//!
//! A light rock under a heavy one, a high pile: each sweep hands on a small share of what must be carried. The modes that
//! the sweeps have found make the step a linear system, that of [`jump`]; the rigid limit is a spring so stiff that what
//! it gives way is lost beside the tolerance. The sweeps judge the result.
//!
//! In the language of stages: `h = 1`, `p_N = 1e7 m_max` per unit of speed, penetration in place of
//! the speed wanted. A contact then gives way by `J/p_N`, 1e-7 of the speed that the impulse gives
//! the heaviest rock.

use super::RigidIsland;
use super::contacts::{BallContact, StepBody};
use crate::contact::pair::{PairHistory, PairImpact};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::{Body, Twist};
use crate::solver::island::body::BodySlot;
use crate::solver::island::newton_step::jump;
use crate::solver::island::pair_contact::PairContact;
use crate::solver::law::StageContact;
use crate::solver::rigid::GroundContact;

/// Impulse by speed of a spring that stands for a rigid contact, over the largest mass (–).
const HOLD_BY_SPEED: f64 = 1e7;
/// A jump of more rocks than this costs more than the sweeps that it may save.
const MOST_ROCKS: usize = 64;

impl RigidIsland {
    /// Solves the rocks that were stirred since `times`, and their neighbours, at once; whether that was possible.
    ///
    /// Cost: one factorisation over the stirred rocks, in place of the sweeps that creep. Modes
    /// (closed, sliding) are those of the last sweep; if they were wrong, the sweeps after it find
    /// out, and `settle` takes the jump back.
    pub(super) fn jump(
        &mut self,
        (members, pair_histories): (&mut [BodySlot], &[PairHistory]),
        times: &[u32],
    ) -> bool {
        let takes_part = self.stirred_since(times);
        if takes_part.iter().filter(|part| **part).count() > MOST_ROCKS {
            return false;
        }
        // one stiffness for all contacts: ratios of masses are in the matrix, and a contact's give
        // is small against the heaviest rock
        let heaviest = self.balls.iter().map(|ball| ball.body.mass).fold(0.0, f64::max);
        let stiffness = HOLD_BY_SPEED * heaviest;
        self.hand_over(members, stiffness);
        let pair = |ball_contact: &BallContact| {
            let ends = ball_contact.ends.map(|k| &self.balls[k].body);
            ball_contact.bridge(&pair_histories[ball_contact.pair_history], ends, stiffness)
        };
        let pairs: Vec<PairContact> = self.ball_contacts.iter().map(pair).collect();
        let now: Vec<Twist> = self.balls.iter().map(|ball| (ball.v, ball.w)).collect();
        let jumped = jump((&*members, &now), &pairs, &takes_part, 1.0);
        let Some(motions) = jumped else { return false };
        self.act_on(&motions, stiffness);
        self.drive();
        true
    }

    /// Rocks that were set in another motion, and what touches them.
    ///
    /// `times` are the counts of a sweep ago: who changed since is still creeping. Neighbours take
    /// part, because their contacts must give way too.
    fn stirred_since(&self, times: &[u32]) -> Vec<bool> {
        let core: Vec<bool> =
            self.balls.iter().zip(times).map(|(ball, times)| ball.times != *times).collect();
        let mut grown = core.clone();
        for [a, b] in self
            .ball_contacts
            .iter()
            .filter(|ball_contact| ball_contact.normal_force > 0.0)
            .map(|ball_contact| ball_contact.ends)
        {
            grown[a] |= core[b];
            grown[b] |= core[a];
        }
        grown
    }

    /// Free motions and contacts with the mesh as the linear system wants them: a stage of length one, impulses for forces.
    fn hand_over(&self, members: &mut [BodySlot], stiffness: f64) {
        for (member, ball) in members.iter_mut().zip(&self.balls) {
            let member = &mut **member;
            // free motion of the step: velocity at its start plus weight, without impulses
            member.free = (ball.before.0 + self.gain(ball), ball.before.1);
            member.state.contact_count = 0;
        }
        for ground_contact in &self.ground_contacts {
            let member = &mut *members[ground_contact.rock];
            let state = &mut member.state;
            // no more contacts than a rock keeps: what is left out is left to the sweeps
            if state.contact_count < state.contacts.len() {
                state.contacts[state.contact_count] =
                    ground_contact.spot(member.body.radius, stiffness);
                state.contact_count += 1;
            }
        }
    }

    /// Sets every impulse of rocks that jumped to what the stiff springs give at their new motions.
    fn act_on(&mut self, motions: &[Option<Twist>], stiffness: f64) {
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
            ground_contact.give_way(&self.balls[ground_contact.rock], stiffness);
        }
        for ball_contact in &mut self.ball_contacts {
            if ball_contact.ends.iter().any(|&k| motions[k].is_some()) {
                let [a, b] = ball_contact.ends.map(|k| &self.balls[k]);
                ball_contact.normal_force =
                    (stiffness * (ball_contact.target - ball_contact.speed(a, b))).max(0.0);
                ball_contact.shear_force = ball_contact
                    .limits
                    .shear(ball_contact.slip(a, b) * stiffness, ball_contact.normal_force);
            }
        }
    }

    /// Motions from weight and all impulses together.
    ///
    /// Adds all impulses anew instead of changes to changes: rounding of many sweeps does not pile
    /// up.
    fn drive(&mut self) {
        for k in 0..self.balls.len() {
            let gain = self.gain(&self.balls[k]);
            let ball = &mut self.balls[k];
            (ball.v, ball.w) = (ball.before.0 + gain, ball.before.1);
            ball.times += 1;
        }
        self.start_warm();
    }

    /// What weight adds to the velocity in the current step.
    /// `g Δt` (m/s).
    fn gain(&self, ball: &StepBody) -> Vec3 {
        ball.body.gravity * self.dt
    }
}

impl GroundContact {
    /// The contact with the mesh as the linear system knows contacts; signs turn, as there forces
    /// act against slip.
    fn spot(&self, radius: f64, stiffness: f64) -> StageContact {
        let law = Law::penalty(stiffness, self.limits, radius);
        StageContact {
            feature: self.feature,
            triangle: self.triangle,
            normal: law.normal(false),
            law,
            n: *self.n(),
            penetration: self.target,
            normal_force: self.normal_force,
            shear_force: -self.shear_force,
            rolling_moment: -self.turn,
            ..StageContact::NONE
        }
    }

    /// Impulses of the stiff springs at the rock's new motion, cut to the cones.
    fn give_way(&mut self, ball: &StepBody, stiffness: f64) {
        self.normal_force = (stiffness * (self.target - self.n().dot(&ball.v))).max(0.0);
        let slip = ball.body.slip(self.n(), &ball.v, &ball.w);
        let wound = ball.w * (stiffness * ball.body.radius.powi(2));
        self.shear_force = -self.limits.shear(slip * stiffness, self.normal_force);
        self.turn = -self.limits.rolling(wound, self.normal_force);
    }
}

impl BallContact {
    /// The same for two rocks.
    fn bridge(
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
            waits: false,
            bond: None,
            n: self.n,
            penetration: self.target,
            shear: Vec3::zeros(),
            levers: self.levers,
            normal_force: self.normal_force,
            shear_force: self.shear_force,
            inertia: bodies.map(|body| (body.mass, body.inertia)),
            inv_m: self.inv.0,
            inv_t: self.inv.1,
        }
    }
}
