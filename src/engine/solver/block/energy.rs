//! Energy correction: a step of a block never gains energy.

use super::rolling::RollingImpulse;
use super::solve::{BlockContact, Mass, rolling_limit};
use super::{BlockContactState, BlockState, TOUCH};
use crate::body::Block;
use crate::flight::top::momentum_of;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::{Loss, scale_factor};

/// Normals that differ by less count as equal (–).
const SAME_NORMAL: f64 = 1e-9;

/// Share of a motion below which its energy is rounding (–).
const NOTHING_LEFT: f64 = 1e-7;

/// The part of the motion of a block that its contacts can change. A contact without friction acts
/// along its normal only. With one such normal it changes neither the momentum across the normal
/// nor the angular momentum about it; with two normals it does not change the momentum
/// perpendicular to both. Contacts with friction can change the whole motion.
///
/// The angular momentum `L = n·ℓ` about a single normal leaves the block at least the spin
/// `n L/(n·I n)`, the one of least energy. A contact can change the rest of the rotation, whose
/// energy is ≥ 0. The component of `ℓ` perpendicular to `n` has no such energy unless `n` is a
/// principal axis: with it a box that slid on its corner had a negative energy to correct the error
/// of a step with.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactDirections {
    /// Orthonormal directions, and how many.
    normals: [Vec3; 3],
    count: usize,
    /// Whether a contact has friction or rolling friction: then all of the motion can change.
    all_directions: bool,
}

/// The part of a motion that contacts can change, and how the kinetic energy depends on it: scaling
/// the part by `1 + δ` adds `slope δ + curvature δ²/2`. Slope and curvature are both twice the
/// energy of the part, except that the slope is less by the work of the weight that slowing takes
/// away.
#[derive(Debug, Clone, Copy)]
pub(super) struct MotionComponent {
    v: Vec3,
    momentum: Vec3,
    /// Both in J.
    slope_j: f64,
    curvature_j: f64,
}

impl ContactDirections {
    /// All of the motion.
    pub(super) const ALL: Self =
        Self { normals: [Vec3::new(0.0, 0.0, 0.0); 3], count: 0, all_directions: true };

    /// Adds a contact with this normal; `has_friction` if it has friction.
    pub(super) fn add(&mut self, n: &Vec3, has_friction: bool) {
        self.all_directions |= has_friction;
        let known = &self.normals[..self.count];
        let new = known.iter().fold(*n, |rest, one| rest - one * one.dot(&rest));
        if self.count < self.normals.len() && new.norm_squared() > SAME_NORMAL * SAME_NORMAL {
            self.normals[self.count] = new.normalize();
            self.count += 1;
        }
    }

    /// The directions in which the impulses of these contacts act in the rigid limit.
    pub(super) fn of_impulses(contacts: &[BlockContact], rolling: &RollingImpulse) -> Self {
        let mut all = Self { all_directions: rolling.is_on(), ..Self::default() };
        for contact in contacts.iter().filter(|contact| contact.pushes()) {
            all.add(&contact.n, contact.has_friction());
        }
        all
    }

    /// The velocity and the angular momentum of a block that these contacts can change.
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
    /// Its kinetic energy (J).
    pub(super) fn energy_j(&self) -> f64 {
        0.5 * self.slope_j
    }

    /// Largest energy that can be removed from it (J). Where it climbs, weight slows it too, and
    /// more can be removed than its kinetic energy. It is stopped at most, never reversed.
    pub(super) fn available_j(&self) -> f64 {
        let slope_j = self.slope_j.max(0.0);
        if slope_j >= self.curvature_j {
            return slope_j - 0.5 * self.curvature_j.max(0.0);
        }
        slope_j * slope_j / (2.0 * self.curvature_j)
    }

    /// The scaling `δ` (–) that removes `taken_j` (J), or the largest removal if there is less.
    fn scale_for(&self, taken_j: f64) -> f64 {
        let root = (self.slope_j.powi(2) - 2.0 * taken_j * self.curvature_j).max(0.0).sqrt();
        let sum = self.slope_j + root;
        let share = if sum > 0.0 { (-2.0 * taken_j / sum).max(-1.0) } else { 0.0 };
        // a remainder of rounding size would creep
        if share < NOTHING_LEFT - 1.0 { -1.0 } else { share }
    }
}

impl BlockState {
    /// The part of its motion that contacts can change.
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

    /// Removes energy (J) from a part of the motion; a negative amount adds energy.
    pub(super) fn take_energy_from(&mut self, part: &MotionComponent, taken_j: f64) {
        let share = part.scale_for(taken_j);
        self.v += part.v * share;
        self.momentum += part.momentum * share;
    }

    /// Removes energy (J) from the part of the motion that contacts can change, and from the whole
    /// motion what this part does not have.
    pub(super) fn take_energy(&mut self, block: &Block, along: &ContactDirections, taken_j: f64) {
        let part = self.motion_component(block, along);
        self.take_energy_from(&part, taken_j);
        let rest_j = taken_j - part.available_j();
        if rest_j > 0.0 && !along.all_directions {
            let all = self.motion_component(block, &ContactDirections::ALL);
            self.take_energy_from(&all, rest_j);
        }
    }

    /// Scales the whole motion down if its kinetic energy exceeds `had_j` plus `remaining_work_j`
    /// (J). `had_j` is the energy that the block had, with the work of its weight so far;
    /// `remaining_work_j` is the work of its weight over the rest of the step, which scales with
    /// the motion. A block without energy to climb with stops and does not creep.
    fn scale_to_energy(&mut self, block: &Block, [had_j, remaining_work_j]: [f64; 2]) {
        let motion_j = self.motion_j(block);
        if motion_j > had_j + remaining_work_j && motion_j > 0.0 {
            // motion k² = had + remaining work · k
            let root =
                (remaining_work_j * remaining_work_j + 4.0 * motion_j * had_j.max(0.0)).sqrt();
            let kept = ((remaining_work_j + root) / (2.0 * motion_j)).clamp(0.0, 1.0);
            self.v *= kept;
            self.momentum *= kept;
        }
    }

    /// Limits the energy of a block to the one that it had in the motion `free`, before contacts
    /// acted `along` these directions. The work of its weight is counted in; `weight` is the
    /// velocity change by it. Contacts only remove energy. The recovery of penetration is paid for
    /// by the motion that contacts can change; the rest of the motion stays as it is.
    ///
    /// If that part of the motion has too little energy, a share of the contact impulses is taken
    /// back. With a share `s` of their impulse `P` and of their angular impulse `T`, the kinetic
    /// energy, less the work of the weight, grows by
    ///
    /// ```text
    /// s (P·(v − W/2) + T·ω) + s²/2 (P·P/m + T·I⁻¹T)
    /// ```
    ///
    /// with `v` and `ω` of the free motion. The displacement is that of the mean velocity, and
    /// `W = g Δt` is contained in `v`. The growth is 0 for `s = 0`.
    ///
    /// Contacts that can change the whole motion are limited by comparing the energies directly: at
    /// rest, where the whole motion stops, nothing of it may remain.
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
        // rounding; the contact directions may hold no energy to correct it with
        if gain_j <= f64::EPSILON * self.motion_j(block) {
            return;
        }
        let mut part = self.motion_component(block, along);
        // a slowed motion gains less work from the weight over the rest of the step
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

/// The energy bound does not shorten a step below this (s).
const SHORTEST_S: f64 = 1e-6;

impl BlockState {
    /// Longest step (s) in which half of the climb of the block is covered by its kinetic energy
    /// (J). If a contact lifts a block that hardly moves, a longer step would raise it without
    /// energy. A climb within the touching tolerance is ignored, so that a block that rests on
    /// rounding errors takes steps of normal length.
    pub(super) fn climb_limit_s(&self, block: &Block, gravity: &Vec3, motion_j: f64) -> f64 {
        // m g v: power of the climb
        let power_w = -block.mass_kg * gravity.dot(&self.v);
        if power_w <= 0.0 {
            return f64::INFINITY;
        }
        let nothing_s = TOUCH * block.radius_m * block.mass_kg * gravity.norm() / power_w;
        (2.0 * motion_j / power_w).max(nothing_s).max(SHORTEST_S)
    }
}

impl BlockContactState {
    /// Energy that friction, restitution and rolling friction of each contact dissipate, each at
    /// least 0, together `lost_j`. Impulses work with the mean of the motions before and after.
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
            let (normal_impulse, up) = (contact.n.dot(&contact.impulse), contact.n.dot(&mean));
            let friction_impulse = contact.impulse - contact.n * normal_impulse;
            let borne = contact.rolling_limit() / limit.max(f64::MIN_POSITIVE);
            let rolling = -self.rolling.impulse.dot(&spin) * borne;
            let taken = [-friction_impulse.dot(&mean), -normal_impulse * up, rolling];
            (taken.map(|joule| joule.max(0.0)), contact.triangle)
        };
        let sum: f64 = self.contacts.iter().flat_map(|contact| part(contact).0).sum();
        let share = scale_factor(lost_j.max(0.0), sum).unwrap_or(0.0);
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

    /// The energy that can be removed from a part of a motion is the energy that stopping it
    /// removes, or less where the block falls and would gain more from its weight. It is never an
    /// amount that only a reversal would remove.
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
