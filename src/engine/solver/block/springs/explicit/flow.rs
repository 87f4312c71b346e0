//! Rates of a block and of the springs of its contacts, at any pose.
//!
//! ```text
//! c' = v,   θ' = ω − θ×ω/2 + …,   v' = g + Σ (F n − q)/m,   ℓ' = Σ a × (F n − q)
//! ξ' of each contact from its slider,   F ≥ 0 by spring and dashpot,   |q| ≤ μ F
//! ```
//!
//! `θ` is the rotation vector since the step's start, so levers and normals are those of every
//! stage. The set of pressing contacts is fixed at the step's start. A contact that begins within
//! the step exerts no force until the step has been cut where it begins. So the right side has no
//! jump within a step, and the error estimate of the pair holds.

use super::super::SpringContact;
use super::super::rotation_vector::{rotation_by, rotation_vector_rate};
use crate::body::Block;
use crate::contact::Feature;
use crate::contact::block::Pose;
use crate::contact::history::transport;
use crate::rock::Vec3;
use crate::solver::block::{BlockContactState, BlockState, TOUCH};
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::HeldEnergy;
use crate::solver::impact::dormand_prince::{Flow, NODES, Rates, put_vec3, vec3_at};
use crate::solver::loss::Loss;
use nalgebra::Matrix3;

/// Offsets of the state: displacement of the centre, rotation vector, velocity, momentum; the shear
/// springs follow.
const DISPLACEMENT: usize = 0;
const ROTATION: usize = 3;
const V: usize = 6;
const MOMENTUM: usize = 9;
const SPRINGS: usize = 12;
/// Quadratures: losses by friction, damping and to trees. The energy that the normal spring of each
/// contact stores follows.
pub(super) const LOSSES: usize = 3;
/// A contact that seems to have begun within this share of the step from its start has not closed
/// by the motion: it appeared, and presses at once (–).
const APPEARED: f64 = 0.02;

/// Scale of the errors.
#[derive(Debug, Clone, Copy)]
pub(super) struct ErrorScale {
    /// Stiffest contact (rad/s).
    pub(super) omega: f64,
    /// Local error allowed (m/s).
    pub(super) allowed: f64,
    /// Penetration (m) to which the onset of a contact is resolved.
    pub(super) onset_m: f64,
}

/// A block with up to `C` pressing contacts; a contact has the index of its history.
pub(super) struct BlockFlow<'a, 'w, const C: usize> {
    world: &'a ContactEnvironment<'w>,
    pub(super) contact_state: &'a mut BlockContactState,
    block: &'a Block,
    start: &'a BlockState,
    /// Inverse inertia at the step's start (1/(kg m²)).
    inverse: Matrix3<f64>,
    scale: ErrorScale,
    /// Number of histories at the step's start; before the first detection, any number.
    known: usize,
    /// Pairs of features in contact at the step's start, as far as there is room.
    first: [(u16, Feature); C],
    /// Length of the trial step (s), and whether contacts that begin in it press at once.
    dt: f64,
    admits_new: bool,
    /// Share of the trial step at which a further contact begins (–), if one does.
    pub(super) onset: Option<f64>,
    /// Whether there were more contacts than room.
    pub(super) exceeds_room: bool,
    /// Energy of the normal spring of each contact at the step's start, and whether it has a
    /// dashpot.
    held_at_start: [HeldEnergy; C],
    damped: [bool; C],
    /// Stiffness of each contact at the step's start relative to that of a single point (–).
    gain2_at_start: [f64; C],
    /// Whether the trial step has met the same pairs of features throughout.
    pub(super) is_smooth: bool,
    /// The block at the state evaluated last.
    pub(super) state: BlockState,
}

impl<'a, 'w, const C: usize> BlockFlow<'a, 'w, C> {
    pub(super) fn new(
        world: &'a ContactEnvironment<'w>,
        contact_state: &'a mut BlockContactState,
        (block, start): (&'a Block, &'a BlockState),
        scale: ErrorScale,
    ) -> Self {
        // contacts at the start without a history begin there
        contact_state.springs.known = contact_state.springs.histories.len();
        Self {
            world,
            contact_state,
            block,
            start,
            inverse: start.mass(block).inverse,
            scale,
            known: usize::MAX,
            first: [(0, Feature::NONE); C],
            dt: 0.0,
            admits_new: false,
            onset: None,
            exceeds_room: false,
            held_at_start: [HeldEnergy::NONE; C],
            damped: [false; C],
            gain2_at_start: [1.0; C],
            is_smooth: true,
            state: start.clone(),
        }
    }

    /// The present state. Displacement and rotation vector count from the step's start: map
    /// coordinates would cost digits.
    pub(super) fn initial_state<const N: usize>(&self) -> [f64; N] {
        let mut y = [0.0; N];
        put_vec3(&mut y, V, &self.start.v);
        put_vec3(&mut y, MOMENTUM, &self.start.momentum);
        for (k, history) in self.contact_state.springs.histories.iter().enumerate().take(C) {
            put_vec3(&mut y, SPRINGS + 3 * k, &history.shear);
        }
        y
    }

    /// The contacts of the first detection are those that press.
    pub(super) fn fix_contacts(&mut self) {
        self.known = self.contact_state.springs.histories.len();
        self.contact_state.springs.known = self.known;
        self.contact_state.springs.keep_offsets();
        for (first, touch) in self.first.iter_mut().zip(&self.contact_state.touches.found) {
            *first = (touch.part, touch.feature);
        }
        let contacts =
            self.contact_state.springs.contacts.iter().zip(&self.contact_state.touches.found);
        for (contact, touch) in contacts.filter(|(contact, _)| contact.history < C) {
            self.held_at_start[contact.history] = self.held(contact);
            self.gain2_at_start[contact.history] = touch.gain2;
        }
    }

    /// Begins another trial step, of length `dt` (s), from the same state; with `admits_new`
    /// contacts that begin in it press at once.
    pub(super) fn begin_try(&mut self, dt: f64, admits_new: bool) {
        self.contact_state.springs.histories.truncate(self.known);
        (self.dt, self.admits_new, self.onset, self.is_smooth) = (dt, admits_new, None, true);
    }

    /// Energy of the normal spring of a contact.
    fn held(&self, contact: &SpringContact) -> HeldEnergy {
        let normal = contact.law.normal(contact.captured);
        let pressed = (contact.penetration.max(0.0), contact.normal_force);
        HeldEnergy::of(&normal, pressed, self.block.mass_kg)
    }

    /// Loss of the step from its quadratures, at its end, the state evaluated last. At a part of
    /// the block that presses with a patch, contacts that merge into the patch hand over their
    /// energy, and take it back where it splits.
    pub(super) fn loss<const Q: usize>(&self, sums: &[f64; Q]) -> Loss {
        let mut taken = Loss { friction: sums[0], damping: sums[1], trees: sums[2], rolling: 0.0 };
        let springs = &self.contact_state.springs;
        for (place, history) in springs.histories.iter().enumerate().take(C) {
            let end = springs.contacts.iter().find(|contact| contact.history == place);
            let released = HeldEnergy { stored_j: 0.0, gives_back: !self.damped[place] };
            let ended = end.map_or(released, |contact| self.held(contact));
            let over = || self.has_patch(history.pair().0);
            let damping =
                self.held_at_start[place].stored_until(&ended, over, sums[LOSSES + place]);
            let triangle = end.map_or(history.triangle, |contact| contact.triangle);
            taken.add(&Loss { damping, ..Loss::default() }.on(self.world, triangle), 1.0);
        }
        taken
    }

    /// Whether a part of the block presses with a patch of several points at an end of the step.
    fn has_patch(&self, part: u16) -> bool {
        let several = |gain2: f64| (gain2 - 1.0).abs() > 0.0;
        let mut held_at_start =
            self.contact_state.springs.histories.iter().zip(self.gain2_at_start);
        let mut ends = self.contact_state.touches.found.iter();
        held_at_start.any(|(history, gain2)| history.pair().0 == part && several(gain2))
            || ends.any(|touch| touch.part == part && several(touch.gain2))
    }

    /// The block at a state, and its rotation vector since the step's start (rad).
    fn at<const N: usize>(&self, y: &[f64; N]) -> (BlockState, Vec3) {
        let turned = vec3_at(y, ROTATION);
        let pose = Pose {
            centre: self.start.pose.centre + vec3_at(y, DISPLACEMENT),
            attitude: rotation_by(&turned) * self.start.pose.attitude,
        };
        (BlockState { pose, v: vec3_at(y, V), momentum: vec3_at(y, MOMENTUM) }, turned)
    }

    /// Records where a contact begins that has closed by stage `node`, with a normal velocity
    /// `up_m_s` (m/s).
    fn record_onset(&mut self, node: usize, penetration_m: f64, up_m_s: f64) {
        if penetration_m <= self.scale.onset_m {
            return;
        }
        let reached = NODES[node];
        // half of the tolerance after its onset, so that the next step begins with it
        let since_s = (penetration_m - 0.5 * self.scale.onset_m) / -up_m_s;
        let share = reached - since_s / self.dt;
        let closes = up_m_s < 0.0 && share > APPEARED;
        let share = if closes { share.min(reached) } else { 0.0 };
        self.onset = Some(self.onset.map_or(share, |before: f64| before.min(share)));
    }

    /// Detects the contacts of the block at a state.
    fn detect_at<const N: usize>(&mut self, state: &BlockState, y: &[f64; N]) {
        let (world, block) = (self.world, self.block);
        // a step begins where the step before has detected contacts last
        let sees = std::mem::take(&mut self.contact_state.springs.touches_are_current)
            && self.known == usize::MAX;
        if !sees {
            self.contact_state.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
        }
        self.contact_state.update_histories(world, (block, state));
        self.contact_state.place_contacts(world, (block, self.start, state), 0.0, &|_, k| {
            if k < C { vec3_at(y, SPRINGS + 3 * k) } else { Vec3::zeros() }
        });
        let found = &self.contact_state.touches.found;
        let pairs = found.iter().map(|touch| (touch.part, touch.feature));
        self.is_smooth &=
            found.len() <= C && pairs.eq(self.first[..found.len().min(C)].iter().copied());
    }

    /// Force of a contact whose point moves at `u` (m/s); the rate of its spring, its losses and
    /// its switching functions go into `rates`.
    fn contact_force<const N: usize, const Q: usize, const P: usize>(
        &mut self,
        contact: &mut SpringContact,
        u: &Vec3,
        rates: &mut Rates<N, Q, P>,
    ) -> Vec3 {
        let (pulls, shear) = contact.update_forces(u);
        let place = contact.history;
        let history = &self.contact_state.springs.histories[place];
        let rate = transport(shear.stretch_rate, &contact.n, &history.n);
        put_vec3(&mut rates.y, SPRINGS + 3 * place, &rate);
        let (normal, up) = (contact.law.normal(contact.captured), contact.n.dot(u));
        let penetration = contact.penetration.max(0.0);
        let dissipates = normal.dissipating_w(penetration, up);
        let power = contact.shear_power(u, &shear.stretch_rate, dissipates);
        let power = power.on(self.world, contact.triangle);
        for (sum, power) in rates.q.iter_mut().zip([power.friction, power.damping, power.trees]) {
            *sum += power;
        }
        rates.q[LOSSES + place] = normal.storing_w(penetration, -up);
        self.damped[place] = normal.is_damped(self.block.mass_kg);
        let switching = contact.switching((pulls, shear.trial_force2), self.block.mass_kg);
        rates.switching[2 * place..2 * place + 2].copy_from_slice(&switching);
        contact.n * contact.normal_force - contact.shear_force
    }
}

impl<const C: usize, const N: usize, const Q: usize, const P: usize> Flow<N, Q, P>
    for BlockFlow<'_, '_, C>
{
    /// Writes the rates at `y`, a state of stage `node`, into `rates`; the contacts are then those
    /// of `y`.
    fn rates(&mut self, node: usize, y: &[f64; N], rates: &mut Rates<N, Q, P>) {
        *rates = Rates::NONE;
        // the trial step is cut where a contact begins: later stages are discarded
        if self.onset.is_some() {
            return;
        }
        let (state, turned) = self.at(y);
        self.detect_at(&state, y);
        let spin = state.spin(self.block);
        let mut contacts = std::mem::take(&mut self.contact_state.springs.contacts);
        let (mut dv, mut torque) = (self.world.body.gravity, Vec3::zeros());
        for contact in &mut contacts {
            let u = state.v + spin.cross(&contact.lever);
            let place = contact.history;
            if place >= self.known && !self.admits_new {
                self.record_onset(node, contact.penetration, contact.n.dot(&u));
            } else if place < C {
                let force = self.contact_force(contact, &u, rates);
                dv += force / self.block.mass_kg;
                torque += contact.lever.cross(&force);
            } else {
                self.exceeds_room = true;
            }
        }
        self.contact_state.springs.contacts = contacts;
        put_vec3(&mut rates.y, DISPLACEMENT, &state.v);
        put_vec3(&mut rates.y, ROTATION, &rotation_vector_rate(&turned, &spin));
        put_vec3(&mut rates.y, V, &dv);
        put_vec3(&mut rates.y, MOMENTUM, &torque);
        self.state = state;
    }

    /// Displacements, rotations and stretches times `ω`, spin times the largest radius, all in m/s.
    /// The spring of an unloaded contact stores nothing: how it relaxes does not matter.
    #[inline]
    fn size2(&self, off: &[f64; N]) -> f64 {
        let ErrorScale { omega, allowed, .. } = self.scale;
        let reach2 = self.block.bound_m.powi(2);
        let pressed = self.contact_state.springs.contacts.iter();
        let pressed = pressed.filter(|one| one.normal_force > 0.0 && one.history < C);
        let ways2 = pressed
            .map(|contact| vec3_at(off, SPRINGS + 3 * contact.history).norm_squared())
            .fold(vec3_at(off, DISPLACEMENT).norm_squared(), f64::max)
            .max(vec3_at(off, ROTATION).norm_squared() * reach2);
        let worst2 = (ways2 * omega * omega)
            .max(vec3_at(off, V).norm_squared())
            .max((self.inverse * vec3_at(off, MOMENTUM)).norm_squared() * reach2);
        worst2 / (allowed * allowed)
    }
}
