//! A step of a block never gains energy.

use super::rolling::RollingImpulse;
use super::solve::{BlockContact, Mass, rolling_limit};
use super::{BlockContactState, BlockState, TOUCH};
use crate::body::Block;
use crate::flight::top::momentum_of;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::{Loss, share_of};

/// Normals that differ by less are one (–).
const SAME_NORMAL: f64 = 1e-9;

/// Share of a motion that is rounding of its energy (–).
const NOTHING_LEFT: f64 = 1e-7;

/// Along what contacts act on a block. One without friction acts along its normal alone: with one such normal the momentum across it and the
/// angular momentum about it are not theirs to change, with two the momentum square to both. Friction acts along everything.
///
/// The angular momentum `L = n·ℓ` about one normal leaves the block a spin `n L/(n·I n)` at least, the one of least energy. The rest
/// of its turning is what a contact can change, and holds an energy of its own, ≥ 0: what is square to `n` in `ℓ` itself does not, unless `n` is a
/// principal axis, and a box that slid on its corner had less than none to pay for the error of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactDirections {
    /// Directions square to each other, and how many.
    normals: [Vec3; 3],
    count: usize,
    /// Whether something rubs or resists rolling.
    all_directions: bool,
}

/// The part of a motion along which contacts act, and what it changes in the energy of motion: scaled by `1 + δ` it adds
/// `slope δ + curvature δ²/2`. Both are twice its own energy, but for the weight that slowing it takes away.
#[derive(Debug, Clone, Copy)]
pub(super) struct MotionComponent {
    v: Vec3,
    momentum: Vec3,
    /// Both in J.
    slope_j: f64,
    curvature_j: f64,
}

impl ContactDirections {
    /// Along everything.
    pub(super) const ALL: Self =
        Self { normals: [Vec3::new(0.0, 0.0, 0.0); 3], count: 0, all_directions: true };

    /// Takes in a contact with this normal; whether it `rubs`.
    pub(super) fn add(&mut self, n: &Vec3, rubs: bool) {
        self.all_directions |= rubs;
        let known = &self.normals[..self.count];
        let new = known.iter().fold(*n, |rest, one| rest - one * one.dot(&rest));
        if self.count < self.normals.len() && new.norm_squared() > SAME_NORMAL * SAME_NORMAL {
            self.normals[self.count] = new.normalize();
            self.count += 1;
        }
    }

    /// What impulses of contacts act along in the rigid limit.
    pub(super) fn of_impulses(contacts: &[BlockContact], rolling: &RollingImpulse) -> Self {
        let mut all = Self { all_directions: rolling.is_on(), ..Self::default() };
        for contact in contacts.iter().filter(|contact| contact.pushes()) {
            all.add(&contact.n, contact.has_friction());
        }
        all
    }

    /// What of the velocity and the angular momentum of a block they act along.
    fn project(
        &self,
        block: &Block,
        BlockState { pose, v, momentum }: &BlockState,
    ) -> (Vec3, Vec3) {
        if self.all_directions {
            return (*v, *momentum);
        }
        let known = &self.normals[..self.count];
        let turns = match known {
            [] => Vec3::zeros(),
            [n] => {
                let about = momentum_of(block.inertia_kg_m2, &pose.attitude, n);
                momentum - about * (n.dot(momentum) / n.dot(&about))
            }
            _ => *momentum,
        };
        (known.iter().map(|n| n * n.dot(v)).sum(), turns)
    }
}

impl MotionComponent {
    /// Energy in it (J).
    pub(super) fn energy_j(&self) -> f64 {
        0.5 * self.slope_j
    }

    /// The most that can be taken from it (J): where it climbs, weight slows it besides, and it is worth more than it holds; it is stopped
    /// all the same, and not turned back.
    pub(super) fn available_j(&self) -> f64 {
        let slope_j = self.slope_j.max(0.0);
        if slope_j >= self.curvature_j {
            return slope_j - 0.5 * self.curvature_j.max(0.0);
        }
        slope_j * slope_j / (2.0 * self.curvature_j)
    }

    /// The `δ` (–) with which it has lost so much (J), or the most if it has less.
    fn scale_for(&self, taken_j: f64) -> f64 {
        let root = (self.slope_j.powi(2) - 2.0 * taken_j * self.curvature_j).max(0.0).sqrt();
        let sum = self.slope_j + root;
        let share = if sum > 0.0 { (-2.0 * taken_j / sum).max(-1.0) } else { 0.0 };
        // rounding of what is left would creep
        if share < NOTHING_LEFT - 1.0 { -1.0 } else { share }
    }
}

impl BlockState {
    /// The part of its motion along which contacts act.
    pub(super) fn motion_component(
        &self,
        block: &Block,
        along: &ContactDirections,
    ) -> MotionComponent {
        let (v, momentum) = along.project(block, self);
        let w = self.mass(block).inverse * momentum;
        let twice_j = block.mass_kg * v.norm_squared() + momentum.dot(&w);
        MotionComponent { v, momentum, slope_j: twice_j, curvature_j: twice_j }
    }

    /// Takes energy (J) from a part of its motion; gives it where it is negative.
    pub(super) fn take_energy_from(&mut self, part: &MotionComponent, taken_j: f64) {
        let share = part.scale_for(taken_j);
        self.v += part.v * share;
        self.momentum += part.momentum * share;
    }

    /// Takes energy (J) from the motion along which contacts act, and from all of it what that has not.
    pub(super) fn take_energy(&mut self, block: &Block, along: &ContactDirections, taken_j: f64) {
        let part = self.motion_component(block, along);
        self.take_energy_from(&part, taken_j);
        let rest_j = taken_j - part.available_j();
        if rest_j > 0.0 && !along.all_directions {
            let all = self.motion_component(block, &ContactDirections::ALL);
            self.take_energy_from(&all, rest_j);
        }
    }

    /// Slows all of the motion of a block that has more energy than it had, with what its weight gave on the way behind it, and than its weight
    /// gives it on the way to come (J), which is slowed too. What has none to climb with stands still, and does not creep.
    fn scale_to_energy(&mut self, block: &Block, [had_j, comes_j]: [f64; 2]) {
        let motion_j = self.motion_j(block);
        if motion_j > had_j + comes_j && motion_j > 0.0 {
            // motion k² = had + comes k
            let root = (comes_j * comes_j + 4.0 * motion_j * had_j.max(0.0)).sqrt();
            let kept = ((comes_j + root) / (2.0 * motion_j)).clamp(0.0, 1.0);
            self.v *= kept;
            self.momentum *= kept;
        }
    }

    /// Holds a block to the energy that it had when it moved `free`, before contacts acted `along` these directions, its weight counted in
    /// as the change of velocity that it makes: contacts only take energy. Moving out of what it was pressed into is paid by its motion, and what none of
    /// them acts along stays as it is.
    ///
    /// Where the motion along them has not so much, a share of what contacts have done is taken back. With a share `s` of their impulse `P` and their
    /// impulse of turning `T` the energy of motion, less what the weight gives on the way, grows by
    ///
    /// ```text
    /// s (P·(v − W/2) + T·ω) + s²/2 (P·P/m + T·I⁻¹T)
    /// ```
    ///
    /// with `v` and `ω` of the free motion, the way being that of the mean velocity and `W = g Δt` counted in `v`. It is 0 for `s = 0`.
    ///
    /// Contacts that act along everything are held by the energies themselves: at rest, where all of the motion goes, nothing may be left of it.
    pub(super) fn limit_energy_gain(
        &mut self,
        block: &Block,
        (free, weight): (&Self, &Vec3),
        along: &ContactDirections,
    ) {
        let mass = self.mass(block);
        if along.all_directions {
            let before = free.v - weight;
            let turning_j = 0.5 * free.momentum.dot(&(mass.inverse * free.momentum));
            let had_j = turning_j + 0.5 * block.mass_kg * before.dot(&(before + weight));
            self.scale_to_energy(block, [had_j, 0.5 * block.mass_kg * weight.dot(&self.v)]);
            return;
        }
        let (dv, turned) = (self.v - free.v, self.momentum - free.momentum);
        let dw = mass.inverse * turned;
        let linear_j = block.mass_kg * dv.dot(&(free.v - weight * 0.5)) + free.momentum.dot(&dw);
        let quadratic_j = block.mass_kg * dv.norm_squared() + turned.dot(&dw);
        let gain_j = linear_j + 0.5 * quadratic_j;
        // rounding, which nothing along the contacts may be there to pay for
        if gain_j <= f64::EPSILON * self.motion_j(block) {
            return;
        }
        let mut part = self.motion_component(block, along);
        // what is slowed gets less from its weight on the way to come
        part.slope_j -= 0.5 * block.mass_kg * weight.dot(&part.v);
        if gain_j <= part.available_j() {
            self.take_energy_from(&part, gain_j);
            return;
        }
        let share = (-2.0 * linear_j / quadratic_j).clamp(0.0, 1.0);
        self.v = free.v + dv * share;
        self.momentum = free.momentum + turned * share;
    }
}

/// No step ends sooner for want of energy (s).
const SHORTEST_S: f64 = 1e-6;

impl BlockState {
    /// How long a step may be (s) in which the block climbs half of its way on the energy that it has (J): where a contact lets out a block
    /// that hardly moves, a longer one would lift it for nothing. What it climbs within a gap that is none is nothing: a block that rests
    /// on rounding takes steps as long as any other.
    pub(super) fn climb_limit_s(&self, block: &Block, gravity: &Vec3, motion_j: f64) -> f64 {
        // m g v: what the climb takes in a second
        let power_w = -block.mass_kg * gravity.dot(&self.v);
        if power_w <= 0.0 {
            return f64::INFINITY;
        }
        let nothing_s = TOUCH * block.radius_m * block.mass_kg * gravity.norm() / power_w;
        (2.0 * motion_j / power_w).max(nothing_s).max(SHORTEST_S)
    }
}

impl BlockContactState {
    /// What friction, restitution and rolling friction of each contact took, together `lost_j`, each at least 0: impulses work with the
    /// mean of the motion before and after.
    pub(super) fn loss_of_impulses(
        &self,
        world: &ContactEnvironment,
        motion: [(&Vec3, &Vec3); 2],
        lost_j: f64,
    ) -> Loss {
        let limit = rolling_limit(&self.contacts);
        let part = |contact: &BlockContact| {
            let [before, after] = motion.map(|motion| Mass::velocity_at(&contact.lever, motion));
            let (mean, spin) = ((before + after) * 0.5, (motion[0].1 + motion[1].1) * 0.5);
            let (push, up) = (contact.n.dot(&contact.impulse), contact.n.dot(&mean));
            let drag = contact.impulse - contact.n * push;
            let borne = contact.rolling_limit() / limit.max(f64::MIN_POSITIVE);
            let rolling = -self.rolling.impulse.dot(&spin) * borne;
            let taken = [-drag.dot(&mean), -push * up, rolling];
            (taken.map(|joule| joule.max(0.0)), contact.triangle)
        };
        let sum: f64 = self.contacts.iter().flat_map(|contact| part(contact).0).sum();
        let share = share_of(lost_j.max(0.0), sum).unwrap_or(0.0);
        let mut loss = Loss::default();
        for (taken, triangle) in self.contacts.iter().map(part) {
            loss.add(&Loss::on_slope(taken).on(world, triangle), share);
        }
        loss
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What can be taken from a part of a motion is just what stopping takes, or less where it falls and would get more from its weight: never what only
    /// turning it back would.
    #[test]
    fn a_part_of_motion_gives_what_it_is_said_to_have() {
        for slope_j in [-1.0, 0.0, 0.4, 1.0, 1.7, 3.0] {
            let part = MotionComponent {
                v: Vec3::x(),
                momentum: Vec3::zeros(),
                slope_j,
                curvature_j: 1.0,
            };
            let available_j = part.available_j();
            let change_j = |share: f64| slope_j * share + 0.5 * share * share;
            assert!(
                (change_j(part.scale_for(available_j)) + available_j).abs() < 1e-6,
                "{slope_j}: {available_j}"
            );
            let least_j = (0..=100).map(|k| change_j(-0.01 * f64::from(k))).fold(0.0, f64::min);
            assert!((available_j + least_j).abs() < 1e-4, "{slope_j}: {available_j} {least_j}");
        }
    }
}
