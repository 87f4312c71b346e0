//! Where sweeps creep, the stirred part of the island is solved at once.
//!
//! A light rock under a heavy one, a high pile: each sweep hands on a small share of what must be carried. The modes that
//! the sweeps have found make the step a linear system, that of [`jump`]; the rigid limit is a spring so stiff that what
//! it gives way is lost beside the tolerance. The sweeps judge the result.

use super::Pile;
use super::ball::{Ball, Foot, Knot};
use crate::contact::pair::Tie;
use crate::coupled::bridge::{Bridge, Motion};
use crate::coupled::jump::jump;
use crate::coupled::member::Seat;
use crate::ground::Law;
use crate::rock::Vec3;
use crate::step::law::{Spot, within};

/// Impulse by speed of a spring that stands for a rigid contact, over the largest mass (–).
const HOLD: f64 = 1e7;
/// A jump of more rocks than this costs more than the sweeps that it may save.
const MOST_ROCKS: usize = 64;

impl Pile {
    /// Solves the rocks that were stirred since `times`, and their neighbours, at once; whether that was possible.
    pub(super) fn jump(&mut self, (members, ties): (&mut [Seat], &[Tie]), times: &[u32]) -> bool {
        let takes_part = self.stirred_since(times);
        if takes_part.iter().filter(|part| **part).count() > MOST_ROCKS {
            return false;
        }
        let heaviest = self.balls.iter().map(|ball| ball.body.mass).fold(0.0, f64::max);
        let stiffness = HOLD * heaviest;
        self.hand_over(members, stiffness);
        let bridge = |knot: &Knot| knot.bridge(&ties[knot.tie], stiffness);
        let bridges: Vec<Bridge> = self.knots.iter().map(bridge).collect();
        let Some(motions) = jump(members, &bridges, &takes_part, 1.0) else { return false };
        self.act_on(&motions, stiffness);
        self.drive();
        true
    }

    /// Rocks that were set in another motion, and what touches them.
    fn stirred_since(&self, times: &[u32]) -> Vec<bool> {
        let core: Vec<bool> =
            self.balls.iter().zip(times).map(|(ball, times)| ball.times != *times).collect();
        let mut grown = core.clone();
        for [a, b] in self.knots.iter().filter(|knot| knot.push > 0.0).map(|knot| knot.ends) {
            grown[a] |= core[b];
            grown[b] |= core[a];
        }
        grown
    }

    /// Motions and contacts with the mesh as the linear system wants them: a stage of length one, impulses for forces.
    fn hand_over(&self, members: &mut [Seat], stiffness: f64) {
        for (member, ball) in members.iter_mut().zip(&self.balls) {
            let member = &mut **member;
            member.free = (ball.before.0 + self.gain(ball), ball.before.1);
            member.now = (ball.v, ball.w);
            member.grip.spot_count = 0;
        }
        for foot in &self.feet {
            let member = &mut *members[foot.ball];
            let grip = &mut member.grip;
            if grip.spot_count < grip.spots.len() {
                grip.spots[grip.spot_count] = foot.spot(member.body.radius, stiffness);
                grip.spot_count += 1;
            }
        }
    }

    /// Sets every impulse of rocks that jumped to what the stiff springs give at their new motions.
    fn act_on(&mut self, motions: &[Option<Motion>], stiffness: f64) {
        for (ball, motion) in self.balls.iter_mut().zip(motions) {
            if let Some((v, w)) = motion {
                (ball.v, ball.w) = (*v, *w);
            }
        }
        for foot in self.feet.iter_mut().filter(|foot| motions[foot.ball].is_some()) {
            foot.give_way(&self.balls[foot.ball], stiffness);
        }
        for knot in &mut self.knots {
            if knot.ends.iter().any(|&k| motions[k].is_some()) {
                let [a, b] = knot.ends.map(|k| &self.balls[k]);
                knot.push = (stiffness * (knot.target - knot.speed(a, b))).max(0.0);
                knot.drag = within(knot.slip(a, b) * stiffness, knot.friction * knot.push);
            }
        }
    }

    /// Motions from weight and all impulses together.
    fn drive(&mut self) {
        for k in 0..self.balls.len() {
            let gain = self.gain(&self.balls[k]);
            let ball = &mut self.balls[k];
            (ball.v, ball.w) = (ball.before.0 + gain, ball.before.1);
            ball.times += 1;
        }
        self.start_warm();
    }

    /// What weight adds to the velocity in the step in hand.
    fn gain(&self, ball: &Ball) -> Vec3 {
        ball.body.gravity * self.dt
    }
}

/// A law whose springs give this impulse by speed, with the friction of another.
fn law(stiffness: f64, (friction, rolling_m): (f64, f64), radius: f64) -> Law {
    let k_r = if rolling_m > 0.0 { stiffness * radius * radius } else { 0.0 };
    Law { p_n: stiffness, p_s: stiffness, k_r, friction, rolling_m, ..Law::NONE }
}

impl Foot {
    fn spot(&self, radius: f64, stiffness: f64) -> Spot {
        Spot {
            feature: self.feature,
            triangle: self.triangle,
            law: law(stiffness, self.caps, radius),
            n: self.n,
            pen: self.target,
            push: self.push,
            drag: -self.drag,
            moment: -self.turn,
            ..Spot::NONE
        }
    }

    fn give_way(&mut self, ball: &Ball, stiffness: f64) {
        self.push = (stiffness * (self.target - self.n.dot(&ball.v))).max(0.0);
        let slip = ball.body.slip(&self.n, &ball.v, &ball.w);
        let wound = ball.w * (stiffness * ball.body.radius.powi(2));
        self.drag = -within(slip * stiffness, self.caps.0 * self.push);
        self.turn = -within(wound, self.caps.1 * self.push);
    }
}

impl Knot {
    fn bridge(&self, tie: &Tie, stiffness: f64) -> Bridge {
        Bridge {
            tie: self.tie,
            ends: self.ends,
            law: law(stiffness, (self.friction, 0.0), 1.0),
            c_n: 0.0,
            captured: tie.captured,
            bond: None,
            n: self.n,
            pen: self.target,
            shear: Vec3::zeros(),
            levers: self.levers,
            push: self.push,
            drag: self.drag,
            inv_m: self.inv.0,
            inv_t: self.inv.1,
        }
    }
}
