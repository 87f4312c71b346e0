//! Rocks that got into each other or into the mesh are moved out, without adding velocity.
//!
//! Velocity-level steps keep gaps only to the error of the step; left alone, overlaps grow. Moving
//! rocks apart changes places only, but lifts some of them: that height is work, and someone must
//! pay for it, or a heap warms up by itself.

use super::RigidIsland;
use super::contacts::{ImpactScene, StepBody};
use crate::contact::TOUCH;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::rock::Vec3;
use crate::solver::loss::Given;
use crate::solver::rigid::way_out;

/// Overlap of two rocks that is left alone: what their weight presses springs in, within bounds (–, relative to the smaller
/// radius).
const SLACK: (f64, f64) = (1e-8, 1e-5);
/// Layers of rocks that press there (–).
const LAYERS: f64 = 4.0;
/// Sweeps over what overlaps, at most.
const SWEEPS: u32 = 30;
/// From the second sweep on rocks are moved so much farther than until they no longer overlap, and by so much of what is left
/// alone besides (–): in a heap each is pushed back by the next (successive over-relaxation, Young 1954), and what was moved
/// to the brim would be moved again. Two rocks alone have parted in the first sweep.
const BEYOND: (f64, f64) = (0.8, 0.3);
/// Way of a rock up to which it gets into none but the pairs that were near at first (–, relative to its radius). Where one is
/// moved farther, twice as much is looked at.
const ROOM: f64 = 0.005;
/// Way of a rock for which the touches with the mesh that are known are taken for planes (–, relative to its radius). Over an
/// edge that is off by half the square of it.
const FLAT: f64 = 3e-4;

/// Two rocks that may get into each other while rocks are moved.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearPair {
    ends: [usize; 2],
    /// Distance of the centres that is left alone (m).
    allowed_m: f64,
}

impl PairHistory {
    /// Distance of two centres that is left alone (m): what weight would press in anyway is left, as without it contacts of a
    /// heap would open and close from step to step.
    fn allowed_m(&self, balls: [&StepBody; 2]) -> f64 {
        let weight = |ball: &StepBody| ball.body.mass * ball.body.gravity.norm();
        let radius = balls[0].body.radius.min(balls[1].body.radius);
        let pressed = self.law.static_penetration_m(LAYERS * (weight(balls[0]) + weight(balls[1])));
        let slack = pressed.clamp(SLACK.0 * radius, SLACK.1 * radius);
        balls[0].body.radius + balls[1].body.radius - slack
    }
}

impl RigidIsland {
    /// Moves apart what overlaps, each by its share of the mass; the height that a rock gains is paid by its motion.
    ///
    /// Gauss–Seidel over pairs and mesh, to and fro between them until nothing moves: each rock out
    /// of one neighbour may be in another. What has not been moved since it was seen is passed over: it is where it was.
    pub(super) fn part(&mut self, scene: &mut ImpactScene) {
        self.places.clear();
        self.places.extend(self.balls.iter().map(|ball| ball.c));
        let mut room = ROOM;
        self.find_near(scene.pair_histories, room);
        for sweep in 1..=SWEEPS {
            let mut moved = self.part_pairs(sweep);
            let mut far = false;
            for k in 0..self.balls.len() {
                if self.balls[k].is_stirred(sweep) {
                    moved |= self.push_out(scene, k, sweep);
                    let ball = &self.balls[k];
                    let way2 = (ball.c - self.places[k]).norm_squared();
                    far |= way2 > (room * ball.body.radius).powi(2);
                }
            }
            if !moved {
                break;
            }
            if far {
                room = 2.0 * self.farthest();
                self.find_near(scene.pair_histories, room);
            }
        }
        self.pay_for_height();
    }

    /// Farthest way of a rock so far, over its radius (–).
    fn farthest(&self) -> f64 {
        let ways = self.balls.iter().zip(&self.places);
        ways.map(|(ball, from)| (ball.c - from).norm() / ball.body.radius).fold(0.0, f64::max)
    }

    /// Lists the pairs that overlap or may do so before a rock has gone farther than `room` times its radius.
    fn find_near(&mut self, pair_histories: &[PairHistory], room: f64) {
        self.near.clear();
        for pair_history in pair_histories {
            let ends = [pair_history.a as usize, pair_history.b as usize];
            let [a, b] = ends.map(|k| &self.balls[k]);
            let apart = self.places[ends[0]] - self.places[ends[1]];
            let reach = (a.body.radius + b.body.radius) * (1.0 + room);
            if apart.norm_squared() <= reach * reach {
                self.near.push(NearPair { ends, allowed_m: pair_history.allowed_m([a, b]) });
            }
        }
    }

    /// Moves the rocks of every pair apart that overlaps; whether there was one.
    fn part_pairs(&mut self, sweep: u32) -> bool {
        let mut moved = false;
        let beyond = if sweep > 1 { BEYOND } else { (0.0, 0.0) };
        for &NearPair { ends, allowed_m: allowed } in &self.near {
            let Ok([a, b]) = self.balls.get_disjoint_mut(ends) else { continue };
            if !(a.is_stirred(sweep) || b.is_stirred(sweep))
                || (a.c - b.c).norm_squared() >= allowed * allowed
            {
                continue;
            }
            let (n, distance) = normal_and_distance(&a.c, &b.c);
            // each moves by its share of 1/m: the centre of mass of the two stays
            let slack = a.body.radius + b.body.radius - allowed;
            let missing = (allowed - distance) * (1.0 + beyond.0) + slack * beyond.1;
            let way = n * (missing / (a.inv.0 + b.inv.0));
            a.c += way * a.inv.0;
            b.c -= way * b.inv.0;
            (a.shifted, b.shifted) = (sweep, sweep);
            moved = true;
        }
        moved
    }

    /// Moves a rock out of the mesh; whether it was in it.
    fn push_out(&mut self, scene: &mut ImpactScene, k: usize, sweep: u32) -> bool {
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let off = state.look_ahead_near(&world, &ball.c, FLAT * world.body.radius);
        if state.touches.is_empty() {
            return false;
        }
        let out = way_out(&state.touches, world.body.radius, &off);
        ball.c += out;
        if out != Vec3::zeros() {
            ball.shifted = sweep;
        }
        out.norm_squared() > (TOUCH * world.body.radius).powi(2)
    }

    /// Pays for the height that rocks gain, first with what normal impulses took of them in this step: what sinks in by the
    /// error of a step loses its energy there, and has it back when it is lifted out. The rest is paid by motion.
    /// (Paid by motion alone, the lifting of 1e-5 R would stop a heap that begins to slide.)
    fn pay_for_height(&mut self) {
        // heights of all rocks together: what one rock sinks pays for what another rises
        let (mut net_j, mut risen_j, mut sunk_j) = (0.0, 0.0, 0.0);
        for (k, (ball, from)) in self.balls.iter_mut().zip(&self.places).enumerate() {
            ball.moved = ball.c != *from;
            let lifted_j = ball.lifted_j(from);
            self.given[k].passed_on -= lifted_j;
            net_j += lifted_j;
            risen_j += lifted_j.max(0.0);
            sunk_j -= lifted_j.min(0.0);
        }
        if net_j <= 0.0 {
            // what has sunk more than others rose is lost
            return self.share_out(|given, lifted_j| {
                let lost_j = -net_j * (-lifted_j).max(0.0) / sunk_j.max(f64::MIN_POSITIVE);
                (given.lost, given.passed_on) = (given.lost + lost_j, given.passed_on - lost_j);
            });
        }
        let covered_j = net_j.min(self.taken_j.max(0.0));
        let paid_j = self.give_back(covered_j) + self.pay_together(net_j - covered_j);
        let unpaid_j = net_j - paid_j;
        if unpaid_j > 0.0 {
            // nobody has it: the error of the step has made it
            self.share_out(|given, lifted_j| {
                given.passed_on += unpaid_j * lifted_j.max(0.0) / risen_j;
            });
        }
    }

    /// Goes through what rocks gave, with the energy that the height of each has gained (J).
    fn share_out(&mut self, mut book: impl FnMut(&mut Given, f64)) {
        for ((ball, from), given) in self.balls.iter().zip(&self.places).zip(&mut self.given) {
            book(given, ball.lifted_j(from));
        }
    }

    /// Takes back energy (J) from what is booked as lost in this step, from every rock its share; how much there was.
    fn give_back(&mut self, wanted_j: f64) -> f64 {
        let booked = self.losses.iter().zip(&self.given);
        let booked_j: f64 =
            booked.map(|(loss, given)| loss.damping.max(0.0) + given.lost.max(0.0)).sum();
        if wanted_j <= 0.0 || booked_j <= 0.0 {
            return 0.0;
        }
        let share = (wanted_j / booked_j).min(1.0);
        for (loss, given) in self.losses.iter_mut().zip(&mut self.given) {
            let back = [loss.damping, given.lost].map(|own_j| share * own_j.max(0.0));
            loss.damping -= back[0];
            given.lost -= back[1];
            given.passed_on += back[0] + back[1];
        }
        share * booked_j
    }

    /// Takes energy (J) out of the motion of all rocks that are pushed, each its share; how much they had.
    /// In proportion to what each has, so that directions and ratios of speeds stay.
    fn pay_together(&mut self, owed_j: f64) -> f64 {
        let takes_part = |ball: &StepBody| ball.pushed || ball.moved;
        let motion_j: f64 =
            self.balls.iter().filter(|ball| takes_part(ball)).map(StepBody::motion_j).sum();
        if owed_j <= 0.0 || motion_j <= 0.0 {
            return 0.0;
        }
        let share = (owed_j / motion_j).min(1.0);
        for (ball, given) in self.balls.iter_mut().zip(&mut self.given) {
            if takes_part(ball) {
                let own_j = share * ball.motion_j();
                ball.body.slow_down((&mut ball.v, &mut ball.w), own_j);
                given.passed_on += own_j;
            }
        }
        share * motion_j
    }
}

impl StepBody {
    /// Whether it was moved in this sweep or in the one before.
    #[inline]
    fn is_stirred(&self, sweep: u32) -> bool {
        self.shifted + 1 >= sweep
    }

    /// Energy in motion (J).
    fn motion_j(&self) -> f64 {
        self.body.motion_j((&self.v, &self.w))
    }

    /// Energy that its height has gained from a place (J).
    fn lifted_j(&self, from: &Vec3) -> f64 {
        self.body.lifted_j(&(self.c - from))
    }
}
