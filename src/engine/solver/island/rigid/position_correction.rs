//! Position correction: rocks that overlap each other or the mesh are moved apart, without a change of velocity.
//!
//! Velocity-level steps keep gaps only to the error of the step, and overlaps would grow. The correction changes positions
//! only, but lifts some rocks: their potential energy is taken from dissipation and motion, or a heap would gain energy.

use super::RigidIsland;
use super::contacts::{ImpactScene, StepBody};
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::contact::{TOUCH, penetration_correction};
use crate::rock::Vec3;
use crate::solver::loss::EnergyGiven;

/// Overlap of two rocks that is not corrected: the static penetration of their springs, within bounds (–, relative to the
/// smaller radius).
const SLACK: (f64, f64) = (1e-8, 1e-5);
/// Layers of rocks whose weight counts there (–).
const LAYERS: f64 = 4.0;
/// Sweeps over what overlaps, at most.
const SWEEPS: u32 = 30;
/// Over-relaxation from the second sweep on, relative to the overlap, and relative to the overlap that is not corrected (–):
/// in a heap each rock is pushed back by the next (successive over-relaxation, Young 1954), and one moved just to the limit
/// would be moved again. Two rocks alone are separated by the first sweep.
const BEYOND: (f64, f64) = (0.8, 0.3);
/// Displacement of a rock up to which it can only overlap the rocks that were near at first (–, relative to its radius).
/// Where one is moved farther, the pairs within twice that distance are searched again.
const ROOM: f64 = 0.005;
/// Displacement of a rock for which the known contact points with the mesh are taken as planes (–, relative to its radius).
/// Over an edge the error is half its square.
const FLAT: f64 = 3e-4;

/// Two rocks that may overlap during the correction.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearPair {
    ends: [usize; 2],
    /// Distance of the centres below which they are moved apart (m).
    allowed_m: f64,
}

impl PairHistory {
    /// Distance of two centres below which they are moved apart (m). The static penetration is left, as without it the
    /// contacts of a heap would open and close from step to step.
    fn allowed_m(&self, balls: [&StepBody; 2]) -> f64 {
        let weight = |ball: &StepBody| ball.body.mass * ball.body.gravity.norm();
        let radius = balls[0].body.radius.min(balls[1].body.radius);
        let pressed = self.law.static_penetration_m(LAYERS * (weight(balls[0]) + weight(balls[1])));
        let slack = pressed.clamp(SLACK.0 * radius, SLACK.1 * radius);
        balls[0].body.radius + balls[1].body.radius - slack
    }
}

impl RigidIsland {
    /// Separates overlapping rocks in proportion to their inverse masses; books the potential energy that this adds.
    ///
    /// Gauss–Seidel over pairs and mesh until nothing moves, as a rock moved out of one neighbour may overlap another.
    /// Pairs of which no rock has moved since the last sweep are skipped.
    pub(super) fn correct_positions(&mut self, scene: &mut ImpactScene) {
        self.places.clear();
        self.places.extend(self.balls.iter().map(|ball| ball.c));
        let mut room = ROOM;
        self.find_near(scene.pair_histories, room);
        for sweep in 1..=SWEEPS {
            let mut moved = self.separate_pairs(sweep);
            let mut far = false;
            for k in 0..self.balls.len() {
                if self.balls[k].was_moved(sweep) {
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

    /// Largest displacement of a rock so far, relative to its radius (–).
    fn farthest(&self) -> f64 {
        let ways = self.balls.iter().zip(&self.places);
        ways.map(|(ball, from)| (ball.c - from).norm() / ball.body.radius).fold(0.0, f64::max)
    }

    /// Lists the pairs that overlap or may overlap before a rock has moved farther than `room` times its radius.
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

    /// Separates every pair that overlaps; whether there was one.
    fn separate_pairs(&mut self, sweep: u32) -> bool {
        let mut moved = false;
        let beyond = if sweep > 1 { BEYOND } else { (0.0, 0.0) };
        for &NearPair { ends, allowed_m: allowed } in &self.near {
            let Ok([a, b]) = self.balls.get_disjoint_mut(ends) else { continue };
            if !(a.was_moved(sweep) || b.was_moved(sweep))
                || (a.c - b.c).norm_squared() >= allowed * allowed
            {
                continue;
            }
            let (n, distance) = normal_and_distance(&a.c, &b.c);
            // each moves in proportion to 1/m: the centre of mass of the two stays
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

    /// Moves a rock out of the mesh; whether it overlapped it.
    fn push_out(&mut self, scene: &mut ImpactScene, k: usize, sweep: u32) -> bool {
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let off = state.contact_points_ahead_near(&world, &ball.c, FLAT * world.body.radius);
        if state.touches.is_empty() {
            return false;
        }
        let out = penetration_correction(&state.touches, world.body.radius, &off);
        ball.c += out;
        if out != Vec3::zeros() {
            ball.shifted = sweep;
        }
        out.norm_squared() > (TOUCH * world.body.radius).powi(2)
    }

    /// Balances the potential energy that rocks gain: first from the dissipation of normal impulses in this step, as a rock
    /// that sinks in by the error of a step has lost that energy there; the rest from the kinetic energy.
    /// (Taken from kinetic energy alone, corrections of 1e-5 R would stop a heap that begins to slide.)
    fn pay_for_height(&mut self) {
        // summed over all rocks: the descent of one balances the ascent of another
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
            // a net descent is dissipated
            return self.share_out(|given, lifted_j| {
                let lost_j = -net_j * (-lifted_j).max(0.0) / sunk_j.max(f64::MIN_POSITIVE);
                (given.lost, given.passed_on) = (given.lost + lost_j, given.passed_on - lost_j);
            });
        }
        let covered_j = net_j.min(self.taken_j.max(0.0));
        let paid_j = self.give_back(covered_j) + self.pay_together(net_j - covered_j);
        let unpaid_j = net_j - paid_j;
        if unpaid_j > 0.0 {
            // no energy left to take: it stays as an error of the step
            self.share_out(|given, lifted_j| {
                given.passed_on += unpaid_j * lifted_j.max(0.0) / risen_j;
            });
        }
    }

    /// Books something for every rock by the potential energy that it has gained (J).
    fn share_out(&mut self, mut book: impl FnMut(&mut EnergyGiven, f64)) {
        for ((ball, from), given) in self.balls.iter().zip(&self.places).zip(&mut self.given) {
            book(given, ball.lifted_j(from));
        }
    }

    /// Takes energy (J) back from what is booked as dissipated in this step, from every rock in proportion; how much there was.
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

    /// Takes energy (J) from the motion of all rocks that were pushed or moved; how much they had.
    /// In proportion to their kinetic energies, so that directions and ratios of speeds stay.
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
    fn was_moved(&self, sweep: u32) -> bool {
        self.shifted + 1 >= sweep
    }

    /// Energy in motion (J).
    fn motion_j(&self) -> f64 {
        self.body.motion_j((&self.v, &self.w))
    }

    /// Potential energy gained from a position (J).
    fn lifted_j(&self, from: &Vec3) -> f64 {
        self.body.lifted_j(&(self.c - from))
    }
}
