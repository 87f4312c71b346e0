//! Rates of a block and of the springs of its contacts, wherever it is and however it is turned.
//!
//! ```text
//! c' = v,   θ' = ω − θ×ω/2 + …,   v' = g + Σ (F n − q)/m,   ℓ' = Σ a × (F n − q)
//! ξ' of each contact from its slider,   F ≥ 0 by spring and dashpot,   |q| ≤ μ F
//! ```
//!
//! `θ` is the rotation vector since the step's start, so levers and normals are those of every stage. Which contacts press is settled at the
//! step's start: one that comes up on the way presses nothing until the step has been cut where it begins, so that within a step the
//! right side has no jump and the pair's own estimate of the error holds.

use super::super::{SpringContact, rotation_by, rotation_vector_rate};
use crate::body::Block;
use crate::contact::Feature;
use crate::contact::block::Pose;
use crate::contact::history::carry;
use crate::rock::Vec3;
use crate::solver::block::{BlockContactState, BlockState, TOUCH};
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::HeldEnergy;
use crate::solver::impact::dormand_prince::{Flow, NODES, Rates, put_vec3, vec3_at};
use crate::solver::loss::Loss;
use nalgebra::Matrix3;

/// Where the way of the centre begins among the numbers that change; rotation vector, velocity, momentum and the springs follow.
const WAY: usize = 0;
const TURNED: usize = 3;
const V: usize = 6;
const MOMENTUM: usize = 9;
const SPRINGS: usize = 12;
/// What is summed up: losses by friction, damping and to trees. What the normal spring of each contact takes up follows.
pub(super) const LOSSES: usize = 3;
/// A contact that seems to have begun so near to the step's start has not come up by the way: it popped up, and presses at once (–).
const APPEARED: f64 = 0.02;

/// What errors are measured by.
#[derive(Debug, Clone, Copy)]
pub(super) struct ErrorScale {
    /// Stiffest contact (rad/s).
    pub(super) omega: f64,
    /// Local error allowed (m/s).
    pub(super) allowed: f64,
    /// Penetration (m) up to which a contact that comes up need not be met more exactly.
    pub(super) onset_m: f64,
}

/// A block with up to `C` contacts that press; a contact keeps the place of its memory.
pub(super) struct BlockFlow<'a, 'w, const C: usize> {
    world: &'a ContactEnvironment<'w>,
    pub(super) footing: &'a mut BlockContactState,
    block: &'a Block,
    start: &'a BlockState,
    /// Inverse inertia at the step's start (1/(kg m²)).
    inverse: Matrix3<f64>,
    scale: ErrorScale,
    /// Memories at the step's start; before the first look, any number.
    known: usize,
    /// Pairs of features that touch at the step's start, as many as there are places for.
    first: [(u16, Feature); C],
    /// Length of the try (s), and whether what comes up in it presses at once.
    dt: f64,
    admits_new: bool,
    /// Where in the try a further contact begins (–), if one does.
    pub(super) onset: Option<f64>,
    /// Whether there were more contacts than places.
    pub(super) exceeds_room: bool,
    /// What the normal spring of each contact held at the step's start, and whether it has a dashpot.
    held_at_start: [HeldEnergy; C],
    damped: [bool; C],
    /// Stiffness of each contact at the step's start relative to that of a single point (–).
    gain2_at_start: [f64; C],
    /// Whether the try has met the same pairs of features throughout.
    pub(super) is_smooth: bool,
    /// The block at the state last asked for.
    pub(super) state: BlockState,
}

impl<'a, 'w, const C: usize> BlockFlow<'a, 'w, C> {
    pub(super) fn new(
        world: &'a ContactEnvironment<'w>,
        footing: &'a mut BlockContactState,
        (block, start): (&'a Block, &'a BlockState),
        scale: ErrorScale,
    ) -> Self {
        // what touches at the start and is not yet known begins there
        footing.springs.known = footing.springs.histories.len();
        Self {
            world,
            footing,
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

    /// The present state. Way and rotation vector count from the step's start: map coordinates would cost digits.
    pub(super) fn initial_state<const N: usize>(&self) -> [f64; N] {
        let mut y = [0.0; N];
        put_vec3(&mut y, V, &self.start.v);
        put_vec3(&mut y, MOMENTUM, &self.start.momentum);
        for (k, history) in self.footing.springs.histories.iter().enumerate().take(C) {
            put_vec3(&mut y, SPRINGS + 3 * k, &history.shear);
        }
        y
    }

    /// The contacts of the first look are those that press.
    pub(super) fn fix_contacts(&mut self) {
        self.known = self.footing.springs.histories.len();
        self.footing.springs.known = self.known;
        self.footing.springs.keep_offsets();
        for (first, touch) in self.first.iter_mut().zip(&self.footing.touches.found) {
            *first = (touch.part, touch.feature);
        }
        let contacts = self.footing.springs.contacts.iter().zip(&self.footing.touches.found);
        for (contact, touch) in contacts.filter(|(contact, _)| contact.history < C) {
            self.held_at_start[contact.history] = self.held(contact);
            self.gain2_at_start[contact.history] = touch.gain2;
        }
    }

    /// Begins another try, of length `dt` (s), from the same state; what comes up in it presses at once if it `admits_new`.
    pub(super) fn begin_try(&mut self, dt: f64, admits_new: bool) {
        self.footing.springs.histories.truncate(self.known);
        (self.dt, self.admits_new, self.onset, self.is_smooth) = (dt, admits_new, None, true);
    }

    /// What the normal spring of a contact holds.
    fn held(&self, contact: &SpringContact) -> HeldEnergy {
        let normal = contact.law.normal(contact.captured);
        let pressed = (contact.penetration.max(0.0), contact.normal_force);
        HeldEnergy::of(&normal, pressed, self.block.mass_kg)
    }

    /// What the step has taken, from its sums, at its end, the state last asked for. At a part of the block that presses with a patch contacts that
    /// come into it hand over what they hold, and take it with them where it parts.
    pub(super) fn taken<const Q: usize>(&self, sums: &[f64; Q]) -> Loss {
        let mut taken = Loss { friction: sums[0], damping: sums[1], trees: sums[2], rolling: 0.0 };
        let springs = &self.footing.springs;
        for (place, history) in springs.histories.iter().enumerate().take(C) {
            let end = springs.contacts.iter().find(|contact| contact.history == place);
            let gone = HeldEnergy { stored_j: 0.0, gives_back: !self.damped[place] };
            let ended = end.map_or(gone, |contact| self.held(contact));
            let over = || self.has_patch(history.pair().0);
            let damping = self.held_at_start[place].taken_until(&ended, over, sums[LOSSES + place]);
            let triangle = end.map_or(history.triangle, |contact| contact.triangle);
            taken.add(&Loss { damping, ..Loss::default() }.on(self.world, triangle), 1.0);
        }
        taken
    }

    /// Whether a part of the block presses with a patch of several points at an end of the step.
    fn has_patch(&self, part: u16) -> bool {
        let several = |gain2: f64| (gain2 - 1.0).abs() > 0.0;
        let mut held_at_start = self.footing.springs.histories.iter().zip(self.gain2_at_start);
        let mut ends = self.footing.touches.found.iter();
        held_at_start.any(|(history, gain2)| history.pair().0 == part && several(gain2))
            || ends.any(|touch| touch.part == part && several(touch.gain2))
    }

    /// The block at a state, and its rotation vector since the step's start (rad).
    fn at<const N: usize>(&self, y: &[f64; N]) -> (BlockState, Vec3) {
        let turned = vec3_at(y, TURNED);
        let pose = Pose {
            centre: self.start.pose.centre + vec3_at(y, WAY),
            attitude: rotation_by(&turned) * self.start.pose.attitude,
        };
        (BlockState { pose, v: vec3_at(y, V), momentum: vec3_at(y, MOMENTUM) }, turned)
    }

    /// Notes down where a contact begins that has come up by stage `node`, moving apart with `up_m_s` (m/s).
    fn note_onset(&mut self, node: usize, penetration_m: f64, up_m_s: f64) {
        if penetration_m <= self.scale.onset_m {
            return;
        }
        let reached = NODES[node];
        // half of what is allowed behind its beginning, so that the next step begins with it
        let since_s = (penetration_m - 0.5 * self.scale.onset_m) / -up_m_s;
        let share = reached - since_s / self.dt;
        let comes = up_m_s < 0.0 && share > APPEARED;
        let share = if comes { share.min(reached) } else { 0.0 };
        self.onset = Some(self.onset.map_or(share, |before: f64| before.min(share)));
    }

    /// Looks for the contacts of the block at a state.
    fn detect_at<const N: usize>(&mut self, state: &BlockState, y: &[f64; N]) {
        let (world, block) = (self.world, self.block);
        // where the step begins is where the one before has looked last
        let sees = std::mem::take(&mut self.footing.springs.touches_are_current)
            && self.known == usize::MAX;
        if !sees {
            self.footing.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
        }
        self.footing.update_histories(world, (block, state));
        self.footing.place_contacts(world, (block, self.start, state), 0.0, &|_, k| {
            if k < C { vec3_at(y, SPRINGS + 3 * k) } else { Vec3::zeros() }
        });
        let found = &self.footing.touches.found;
        let pairs = found.iter().map(|touch| (touch.part, touch.feature));
        self.is_smooth &=
            found.len() <= C && pairs.eq(self.first[..found.len().min(C)].iter().copied());
    }

    /// Force of a contact whose point moves by `u` (m/s); its spring, its losses and its kinks go into `rates`.
    fn contact_force<const N: usize, const Q: usize, const P: usize>(
        &mut self,
        contact: &mut SpringContact,
        u: &Vec3,
        rates: &mut Rates<N, Q, P>,
    ) -> Vec3 {
        let (pulls, shear) = contact.update_forces(u);
        let place = contact.history;
        let history = &self.footing.springs.histories[place];
        let rate = carry(shear.stretch_rate, &contact.n, &history.n);
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
        let switching = contact.switching((pulls, shear.asked2), self.block.mass_kg);
        rates.switching[2 * place..2 * place + 2].copy_from_slice(&switching);
        contact.n * contact.normal_force - contact.shear_force
    }
}

impl<const C: usize, const N: usize, const Q: usize, const P: usize> Flow<N, Q, P>
    for BlockFlow<'_, '_, C>
{
    /// Writes the rates at `y`, a state of stage `node`, over `rates`; contacts are those of `y` then.
    fn rates(&mut self, node: usize, y: &[f64; N], rates: &mut Rates<N, Q, P>) {
        *rates = Rates::NONE;
        // the try is cut where a contact begins: what comes later is thrown away
        if self.onset.is_some() {
            return;
        }
        let (state, turned) = self.at(y);
        self.detect_at(&state, y);
        let spin = state.spin(self.block);
        let mut contacts = std::mem::take(&mut self.footing.springs.contacts);
        let (mut dv, mut torque) = (self.world.body.gravity, Vec3::zeros());
        for contact in &mut contacts {
            let u = state.v + spin.cross(&contact.lever);
            let place = contact.history;
            if place >= self.known && !self.admits_new {
                self.note_onset(node, contact.penetration, contact.n.dot(&u));
            } else if place < C {
                let force = self.contact_force(contact, &u, rates);
                dv += force / self.block.mass_kg;
                torque += contact.lever.cross(&force);
            } else {
                self.exceeds_room = true;
            }
        }
        self.footing.springs.contacts = contacts;
        put_vec3(&mut rates.y, WAY, &state.v);
        put_vec3(&mut rates.y, TURNED, &rotation_vector_rate(&turned, &spin));
        put_vec3(&mut rates.y, V, &dv);
        put_vec3(&mut rates.y, MOMENTUM, &torque);
        self.state = state;
    }

    /// Ways, turns and stretches times `ω`, spin times the largest radius, all in m/s. A spring that nothing presses on any more holds
    /// nothing: how it relaxes does not matter.
    #[inline]
    fn size2(&self, off: &[f64; N]) -> f64 {
        let ErrorScale { omega, allowed, .. } = self.scale;
        let reach2 = self.block.bound_m.powi(2);
        let pressed = self.footing.springs.contacts.iter();
        let pressed = pressed.filter(|one| one.normal_force > 0.0 && one.history < C);
        let ways2 = pressed
            .map(|contact| vec3_at(off, SPRINGS + 3 * contact.history).norm_squared())
            .fold(vec3_at(off, WAY).norm_squared(), f64::max)
            .max(vec3_at(off, TURNED).norm_squared() * reach2);
        let worst2 = (ways2 * omega * omega)
            .max(vec3_at(off, V).norm_squared())
            .max((self.inverse * vec3_at(off, MOMENTUM)).norm_squared() * reach2);
        worst2 / (allowed * allowed)
    }
}
