//! Impact of a block in the limit of stiff springs.
//!
//! In that limit the block does not move during the impact: normals, levers and the inertia tensor
//! are constant, weight has no effect, and the contact law becomes an equation in the impact's own
//! time `1/ω`,
//!
//! ```text
//! x_k' = −n_k·u_k,   u_k = v + ω × a_k,   m v' = Σ (F_k n_k − q_k),   ℓ' = Σ a_k × (F_k n_k − q_k)
//! ```
//!
//! with the forces of spring, dashpot and slider that all schemes have. The outcome depends on
//! ratios of stiffness only, not on their size. Where friction and lever couple normal and
//! tangential impulse, this differs from Newton's restitution of each contact: a corner that sticks
//! rebounds as its spring does, several corners share the impact by their compliance, and nothing
//! can gain energy.
//!
//! A contact that opens and closes again begins anew, at its new approach speed: the step is cut
//! there, because its dashpot acts at once.

mod open_contacts;
mod standstill;

use super::super::energy::ContactDirections;
use super::{BlockContactState, BlockState, RollingSpring, SpringContact};
use crate::body::Block;
use crate::contact::MAX_CONTACTS;
use crate::contact::block::{BlockContactPoint, MAX_BLOCK_CONTACTS};
use crate::rock::Vec3;
use crate::solver::block::solve::Mass;
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::{FIRST, LONGEST_RAD, SHORTEST_RAD, control_error};
use crate::solver::impact::dormand_prince::{
    Attempt, Flow, Rates, Stages, add_sums, put_vec3, vec3_at,
};
use crate::solver::impact::{LOCAL_ERROR, NEGLIGIBLE};
use crate::solver::law::capture_m_s;
use crate::solver::loss::{Loss, scale_to_total};
use standstill::Standstill;

/// Offsets of the state: velocity, angular momentum, stretch of the rolling spring; penetration and
/// stretch of each contact follow.
const V: usize = 0;
const MOMENTUM: usize = 3;
const ROLLING: usize = 6;
const CONTACTS: usize = 9;
/// State variables of each contact.
const PER_CONTACT: usize = 4;
/// Quadratures: losses by friction, damping, rolling friction and to trees.
const SUMS: usize = 4;
/// Steps, and radians of the stiffest contact, after which an impact is ended: corners that rattle
/// in a notch have no other end.
const MOST_STEPS: u32 = 5_000;
const MOST_RAD: f64 = 300.0;
/// Tolerance of an impact (–, relative to the fastest of its contact points): the default of
/// `adaptive`.
const BLOW_TOLERANCE: f64 = 2e-4;

/// The block, and contacts of frozen geometry.
struct FrozenFlow<'a, 'w> {
    world: &'a ContactEnvironment<'w>,
    block: &'a Block,
    mass: Mass,
    /// Contact points, and their contacts in the same order; an open contact is suspended.
    touches: &'a [BlockContactPoint],
    contacts: Vec<SpringContact>,
    rolling: RollingSpring,
    /// Stiffest contact (rad/s), and local error allowed (m/s).
    omega: f64,
    allowed: f64,
    /// Energy of the contacts at the start (J).
    held_j: f64,
    /// Whether the impact has ended with contacts that jam each other.
    is_clamped: bool,
}

impl BlockContactState {
    /// The impact of the touching contacts in the limit of stiff springs; `None` if there is no
    /// such limit or the impact does not end by itself: the motion is not changed then.
    pub(in super::super) fn blow(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
    ) -> Option<Loss> {
        self.select_for_blow(world, block);
        let touches = std::mem::take(&mut self.selected);
        let outcome = self.outcome(world, (block, state), &touches);
        self.selected = touches;
        let (next, taken) = outcome?;
        *state = next;
        Some(taken)
    }

    /// The motion after the impact on these contact points, and its loss.
    fn outcome(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
        touches: &[BlockContactPoint],
    ) -> Option<(BlockState, Loss)> {
        let mass = state.mass(block);
        let mut contacts = std::mem::take(&mut self.springs.contacts);
        contacts.clear();
        for (k, touch) in touches.iter().enumerate() {
            let ground = world.ground_of(touch.triangle);
            let friction = self.slip.friction(ground, world.law(touch.triangle), 0.0);
            let approach_m_s = state.approach_m_s(block, touch);
            let law = Self::law_of_touch(world, &mass, touch, (approach_m_s, touches.iter()));
            let mut contact = SpringContact::just_touching((k, touch), &law, friction);
            contact.captured = approach_m_s < capture_m_s(&law);
            // a contact that neither closes nor opens lasts, whatever rounding says
            contact.is_suspended = approach_m_s < -capture_m_s(&law);
            self.clamp.load(&mut contact, touch);
            contacts.push(contact);
        }
        let omega = contacts.iter().map(|contact| contact.law.omega_rad_s()).fold(0.0, f64::max);
        let fastest = touches.iter().map(|touch| state.velocity_at(block, &touch.lever).norm());
        let pressed = contacts
            .iter()
            .map(|one| omega * (one.penetration.powi(2) + one.shear.norm_squared()).sqrt());
        let allowed = LOCAL_ERROR * BLOW_TOLERANCE * fastest.chain(pressed).fold(0.0, f64::max);
        let mut rolling = RollingSpring::default();
        rolling.adopt_element(&contacts);
        rolling.stretch = self.clamp.rolled;
        let held_j = self.clamp.held_j;
        let mut flow = FrozenFlow {
            world,
            block,
            mass,
            touches,
            contacts,
            rolling,
            omega,
            allowed,
            held_j,
            is_clamped: false,
        };
        // the state lives on the stack, and its loops have constant lengths
        let end = match touches.len() {
            1 => flow.follow::<{ CONTACTS + PER_CONTACT }, 2>(state),
            2 => flow.follow::<{ CONTACTS + 2 * PER_CONTACT }, 4>(state),
            3..=4 => flow.follow::<{ CONTACTS + 4 * PER_CONTACT }, 8>(state),
            5..=MAX_CONTACTS => flow.follow::<{ CONTACTS + PER_CONTACT * MAX_CONTACTS }, { 2 * MAX_CONTACTS }>(state),
            _ => flow
                .follow::<{ CONTACTS + PER_CONTACT * MAX_BLOCK_CONTACTS }, { 2 * MAX_BLOCK_CONTACTS }>(state),
        };
        if end.is_some() {
            self.clamp.open();
        }
        if flow.is_clamped {
            self.clamp.close(&flow.contacts, touches);
            self.clamp.rolled = flow.rolling.stretch;
        }
        self.springs.contacts = flow.contacts;
        end
    }
}

impl FrozenFlow<'_, '_> {
    /// Integrates the impact of a block from this motion.
    fn follow<const N: usize, const P: usize>(
        &mut self,
        state: &BlockState,
    ) -> Option<(BlockState, Loss)> {
        let (mut y, mut sums) = ([0.0; N], [0.0; SUMS]);
        put_vec3(&mut y, V, &state.v);
        put_vec3(&mut y, MOMENTUM, &state.momentum);
        put_vec3(&mut y, ROLLING, &self.rolling.stretch);
        for (k, contact) in self.contacts.iter().enumerate() {
            y[CONTACTS + PER_CONTACT * k] = contact.penetration;
            put_vec3(&mut y, CONTACTS + PER_CONTACT * k + 1, &contact.shear);
        }
        let mut still = Standstill::of(state);
        let mut stages = Stages::<N, SUMS, P>::NONE;
        let (mut h, mut elapsed_rad) = (FIRST / self.omega, 0.0);
        self.rates(0, &y, stages.first());
        for _ in 0..MOST_STEPS {
            let dt = h.min(LONGEST_RAD / self.omega);
            let is_short = dt * self.omega < SHORTEST_RAD;
            let felt = (!is_short).then_some(self.allowed);
            let tried = match stages.step(self, &y, dt, felt) {
                Attempt::Whole(tried) => tried,
                Attempt::Cut(share) => {
                    h = dt * share;
                    continue;
                }
            };
            let (accepted, next_h) = control_error((dt, h), (tried.error2, true), is_short).ok()?;
            h = next_h;
            if !accepted {
                continue;
            }
            if let Some(share) = self.recontact_share(&y, &tried.y).filter(|_| !is_short) {
                h = dt * share;
                continue;
            }
            y = tried.y;
            add_sums(&mut sums, &tried.q);
            elapsed_rad += dt * self.omega;
            stages.reuse_last();
            let mut begins = self.update_open(&mut y);
            // the forces are those of the step's end
            if !begins && self.is_free() {
                let Some(wait_s) = self.next_touch(&y) else {
                    return Some(self.end(&y, state, &sums));
                };
                self.drift(&mut y, wait_s);
                (begins, elapsed_rad) = (true, elapsed_rad + wait_s * self.omega);
            }
            if self.stays_clamped(&y, elapsed_rad, &mut still) {
                self.is_clamped = true;
                return Some(self.end(&y, state, &sums));
            }
            if elapsed_rad > MOST_RAD {
                return None;
            }
            if begins {
                h = FIRST / self.omega;
                self.rates(0, &y, stages.first());
            }
        }
        None
    }

    /// The velocity of a contact point at a state.
    fn point_m_s<const N: usize>(&self, k: usize, y: &[f64; N]) -> Vec3 {
        let w = self.mass.inverse * vec3_at(y, MOMENTUM);
        Mass::velocity_at(&self.contacts[k].lever, (&vec3_at(y, V), &w))
    }

    /// Penetration to which the onset of a contact that closes again is resolved (m).
    fn onset_m(&self) -> f64 {
        self.allowed / self.omega
    }

    /// Whether no contact pushes at the state evaluated last.
    fn is_free(&self) -> bool {
        self.contacts.iter().all(|contact| contact.is_suspended || contact.normal_force <= 0.0)
    }

    /// Time (s) until a free block touches again, if it does.
    fn next_touch<const N: usize>(&self, y: &[f64; N]) -> Option<f64> {
        let waits = (0..self.contacts.len()).filter_map(|k| {
            let closing_m_s = -self.contacts[k].n.dot(&self.point_m_s(k, y));
            let gap_m = -y[CONTACTS + PER_CONTACT * k];
            (closing_m_s > NEGLIGIBLE * self.allowed).then(|| (gap_m / closing_m_s).max(0.0))
        });
        waits.reduce(f64::min)
    }

    /// Moves a free block for `wait_s` (s); contacts that touch then begin anew.
    fn drift<const N: usize>(&mut self, y: &mut [f64; N], wait_s: f64) {
        for k in 0..self.contacts.len() {
            let up_m_s = self.contacts[k].n.dot(&self.point_m_s(k, y));
            let x = &mut y[CONTACTS + PER_CONTACT * k];
            *x -= up_m_s * wait_s;
            let touches = *x > -0.5 * self.onset_m() && up_m_s < 0.0;
            self.contacts[k].is_suspended = true;
            if touches {
                self.recontact(k, y);
            }
        }
    }

    /// The motion at a state, and the loss: together exactly the energy at the start.
    fn end<const N: usize>(
        &self,
        y: &[f64; N],
        start: &BlockState,
        sums: &[f64; SUMS],
    ) -> (BlockState, Loss) {
        let mut end =
            BlockState { v: vec3_at(y, V), momentum: vec3_at(y, MOMENTUM), ..start.clone() };
        let before_j = start.motion_j(self.block) + self.held_j;
        let holds_j = if self.is_clamped { self.clamped_j() } else { 0.0 };
        // the integration error
        let along = ContactDirections::default().and_springs(&self.contacts);
        if self.held_j > 0.0 || self.is_clamped {
            let gained_j = end.motion_j(self.block) + holds_j - before_j;
            end.take_energy(self.block, &along, gained_j.max(0.0));
        } else {
            end.limit_energy_gain(self.block, (start, &Vec3::zeros()), &along);
        }
        let mut taken = sums.map(|sum| sum.max(0.0));
        scale_to_total((before_j - end.motion_j(self.block) - holds_j).max(0.0), &mut taken);
        let [friction, damping, rolling, trees] = taken;
        let mut loss = Loss { friction, damping, rolling, trees };
        let stored_j = holds_j - self.held_j;
        // an episode of contact subtracts from the losses what springs hold at its end
        loss.damping += stored_j;
        (end, loss)
    }
}

impl<const N: usize, const P: usize> Flow<N, SUMS, P> for FrozenFlow<'_, '_> {
    fn rates(&mut self, _node: usize, y: &[f64; N], to: &mut Rates<N, SUMS, P>) {
        *to = Rates::NONE;
        let v = vec3_at(y, V);
        let w = self.mass.inverse * vec3_at(y, MOMENTUM);
        let (mut force_sum, mut torque, mut loss) = (Vec3::zeros(), Vec3::zeros(), Loss::default());
        for (k, contact) in self.contacts.iter_mut().enumerate() {
            let (at, u) = (CONTACTS + PER_CONTACT * k, Mass::velocity_at(&contact.lever, (&v, &w)));
            to.y[at] = -contact.n.dot(&u);
            (contact.penetration, contact.shear) = (y[at], vec3_at(y, at + 1));
            if contact.is_suspended {
                (contact.normal_force, contact.shear_force) = (0.0, Vec3::zeros());
                continue;
            }
            let (pulls, shear) = contact.update_forces(&u);
            let force = contact.n * contact.normal_force - contact.shear_force;
            force_sum += force;
            torque += contact.lever.cross(&force);
            put_vec3(&mut to.y, at + 1, &shear.stretch_rate);
            loss.add(&contact.power(self.world, &u, &shear.stretch_rate), 1.0);
            let switching = contact.switching((pulls, shear.trial_force2), self.mass.mass);
            to.switching[2 * k..2 * k + 2].copy_from_slice(&switching);
        }
        if self.rolling.is_on() {
            self.rolling.stretch = vec3_at(y, ROLLING);
            let rolling = self.rolling.update_moment(&self.contacts, &w);
            torque -= rolling.force;
            put_vec3(&mut to.y, ROLLING, &rolling.stretch_rate);
            loss.add(&self.rolling.power(self.world, &self.contacts, &w), 1.0);
        }
        to.q = [loss.friction, loss.damping, loss.rolling, loss.trees];
        put_vec3(&mut to.y, V, &(force_sum / self.mass.mass));
        put_vec3(&mut to.y, MOMENTUM, &torque);
    }

    /// Displacements and stretches times `ω`, spin and rotations times the largest radius, all in
    /// m/s.
    fn size2(&self, off: &[f64; N]) -> f64 {
        let (reach2, omega2) = (self.block.bound_m.powi(2), self.omega * self.omega);
        let pressed = self.contacts.iter().enumerate().filter(|(_, one)| one.normal_force > 0.0);
        let ways2 = pressed.map(|(k, _)| {
            let at = CONTACTS + PER_CONTACT * k;
            (off[at] * off[at]).max(vec3_at(off, at + 1).norm_squared())
        });
        let worst2 = (ways2.fold(0.0, f64::max) * omega2)
            .max(vec3_at(off, V).norm_squared())
            .max((self.mass.inverse * vec3_at(off, MOMENTUM)).norm_squared() * reach2)
            .max(vec3_at(off, ROLLING).norm_squared() * reach2 * omega2);
        worst2 / (self.allowed * self.allowed)
    }
}
