//! Rates of a rock and of the springs of its contacts, at any position.
//!
//! ```text
//! c' = v,   v' = g + Σ (F n − q)/m,   ω' = Σ (R n × q − M)/I
//! ξ' and θ' of each contact from its sliders (`law::ContactForces`)
//! F ≥ 0 by spring and dashpot,   |q| ≤ μ F,   |M| ≤ μ_r R F
//! ```
//!
//! Contacts are detected at every stage. Springs belong to histories, each tangent to the normal of
//! its history: they are rotated to the present normal before they are evaluated, and their rates
//! are rotated back.

use super::changes::ContactChanges;
use crate::contact::TOUCH;
use crate::contact::history::transport;
use crate::contact::{ContactPoint, Feature};
use crate::ground::NormalElement;
use crate::rock::Vec3;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::impact::dormand_prince::{Flow, NODES, Rates, put_vec3, vec3_at};
use crate::solver::law::{ContactDeformation, ContactForces};
use crate::solver::loss::Loss;
use crate::solver::stage::StageMotion;
use arrayvec::ArrayVec;

/// Offsets of the state: displacement of the centre, velocity, spin; the springs follow.
pub(super) const DISPLACEMENT: usize = 0;
pub(super) const V: usize = 3;
const W: usize = 6;
/// The stage at a step's end.
const LAST: usize = NODES.len() - 1;
/// Offset of the springs: shear of all `C` contacts, then rolling of all, three variables each.
const SPRINGS: usize = 9;
/// Quadratures: losses by friction, damping, rolling and to trees. The energy that the normal
/// spring of each contact stores follows.
pub(super) const LOSSES: usize = 4;

/// A contact at the state evaluated last.
#[derive(Debug, Clone, Copy)]
pub(super) struct PressedContact {
    /// Index of its history.
    pub(super) place: usize,
    pub(super) touch: ContactPoint,
    pub(super) at: ContactDeformation,
    /// Normal spring and dashpot in force.
    pub(super) normal: NormalElement,
    /// Normal force (N), and whether friction is at its cap.
    pub(super) normal_force: f64,
    pub(super) slides: bool,
}

/// Energy of a normal spring.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct HeldEnergy {
    /// By its compression (J).
    pub(in crate::solver) stored_j: f64,
    /// Whether it is returned to the motion; not if the bodies separate faster than spring and
    /// dashpot can follow.
    pub(in crate::solver) gives_back: bool,
}

impl HeldEnergy {
    pub(in crate::solver) const NONE: Self = Self { stored_j: 0.0, gives_back: true };

    /// Of a normal element with this penetration (m) and force (N); the mass is that of the rock
    /// (kg).
    pub(in crate::solver) fn of(
        normal: &NormalElement,
        (depth_m, force_n): (f64, f64),
        mass_kg: f64,
    ) -> Self {
        let gives_back = force_n > 0.0 || !normal.is_damped(mass_kg);
        Self { stored_j: normal.stored_j(depth_m), gives_back }
    }

    /// Energy stored by the spring up to the step's `end` (J); the quadrature over the step gives
    /// `summed_j`.
    ///
    /// It is known from the two ends if the spring pushes at both, whatever happened in between:
    /// the energy is a continuous function of position. A spring released by its dashpot has not
    /// returned its energy; then the quadratures are used, which cancel against those of the
    /// dashpot. They are not used where contacts hand `over` their energies to each other: these
    /// jump, and only their sum, each energy by its compression, is continuous.
    pub(in crate::solver) fn stored_until(
        &self,
        end: &Self,
        over: impl FnOnce() -> bool,
        summed_j: f64,
    ) -> f64 {
        let is_known = (self.gives_back && end.gives_back) || over();
        if is_known { end.stored_j - self.stored_j } else { summed_j }
    }
}

/// A rock with up to `C` contacts; a contact has the index of its history.
pub(super) struct SphereFlow<'a, 'w, const C: usize> {
    world: &'a ContactEnvironment<'w>,
    pub(super) state: &'a mut ContactState,
    /// Stiffest contact (rad/s) and local error allowed (m/s).
    scale: (f64, f64),
    /// Whether there were more contacts than room.
    pub(super) exceeds_room: bool,
    /// Whether the current trial step has met one face only: no patches, and no contact that begins
    /// or ends.
    pub(super) is_smooth: bool,
    /// Contacts that begin, end or replace others within the step.
    pub(super) changes: ContactChanges,
    /// The single face met at the step's start; [`Feature::NONE`] if it was anything else.
    face: Option<Feature>,
    /// The normal spring of each contact at the step's start, and which of them have a dashpot.
    held_at_start: [HeldEnergy; C],
    damped: u32,
    /// Contacts at the state evaluated last.
    pressed: ArrayVec<PressedContact, C>,
}

impl PressedContact {
    /// Energy of its normal spring; the mass is that of the rock (kg).
    fn held(&self, mass: f64) -> HeldEnergy {
        HeldEnergy::of(&self.normal, (self.at.penetration, self.normal_force), mass)
    }
}

impl<'a, 'w, const C: usize> SphereFlow<'a, 'w, C> {
    pub(super) fn new(
        world: &'a ContactEnvironment<'w>,
        state: &'a mut ContactState,
        scale: (f64, f64),
    ) -> Self {
        Self {
            world,
            state,
            scale,
            exceeds_room: false,
            is_smooth: true,
            changes: ContactChanges::NONE,
            face: None,
            held_at_start: [HeldEnergy::NONE; C],
            damped: 0,
            pressed: ArrayVec::new(),
        }
    }

    /// Whether a state of `N` variables includes rolling springs. Scenes without rolling friction
    /// have none.
    const fn rolls<const N: usize>() -> bool {
        N > SPRINGS + 3 * C
    }

    /// The present state.
    ///
    /// Displacement 0: positions count from the start of the step, as map coordinates would cost
    /// digits.
    pub(super) fn initial_state<const N: usize>(&self) -> [f64; N] {
        let mut y = [0.0; N];
        put_vec3(&mut y, V, &self.state.v);
        put_vec3(&mut y, W, &self.state.w);
        for (k, history) in self.state.histories.iter().enumerate().take(C) {
            put_vec3(&mut y, SPRINGS + 3 * k, &history.shear);
            if Self::rolls::<N>() {
                put_vec3(&mut y, SPRINGS + 3 * (C + k), &history.roll);
            }
        }
        y
    }

    /// Begins another trial step from the same state.
    pub(super) fn begin_try(&mut self) {
        self.is_smooth = true;
        self.changes.begin_try();
    }

    /// Detects the contact points at `c`.
    pub(super) fn look(&mut self, c: &Vec3) {
        self.look_within(c, self.radius_m() * (1.0 + TOUCH));
    }

    /// The same, nearer than `reach` (m).
    pub(super) fn look_within(&mut self, c: &Vec3, reach: f64) {
        self.state.find_contact_points(self.world, c, reach);
    }

    /// Radius of the rock (m).
    pub(super) fn radius_m(&self) -> f64 {
        self.world.body.radius
    }

    /// Contacts at the state evaluated last.
    pub(super) fn pressed(&self) -> &[PressedContact] {
        &self.pressed
    }

    /// Records the contacts of the step's start, the state evaluated last, and the energies of
    /// their normal springs.
    ///
    /// They are those of its rates. Contact points may have been detected elsewhere since, at the
    /// end of a possible flight; a contact of that position would end at the start of the step,
    /// again and again.
    pub(super) fn record_start(&mut self) {
        self.changes.begin(self.pressed.iter().map(|contact| &contact.touch));
        for contact in &self.pressed {
            self.held_at_start[contact.place] = contact.held(self.world.body.mass);
        }
    }

    /// Energy stored by the normal springs since the step's start (J), at its end, the state
    /// evaluated last. A contact that was absorbed by a patch stores nothing by itself, and where
    /// patches meet or separate they hand over their energies.
    pub(super) fn normal_energy_stored<const Q: usize>(&self, sums: &[f64; Q]) -> Loss {
        let jumps = self.changes.exchange.is_some();
        let mut taken = Loss::default();
        for (place, history) in self.state.histories.iter().enumerate().take(C) {
            let end = self.pressed().iter().find(|contact| contact.place == place);
            let is_absorbed =
                || self.state.near.patch_holding(self.world.terrain, history.feature).is_some();
            let ended = end.map_or_else(
                || HeldEnergy {
                    stored_j: 0.0,
                    gives_back: self.damped & (1 << place) == 0 || is_absorbed(),
                },
                |contact| contact.held(self.world.body.mass),
            );
            let damping =
                self.held_at_start[place].stored_until(&ended, || jumps, sums[LOSSES + place]);
            let triangle = end.map_or(history.triangle, |contact| contact.touch.triangle);
            taken.add(&Loss { damping, ..Loss::default() }.on(self.world, triangle), 1.0);
        }
        taken
    }

    /// Whether the contacts at the state evaluated last are those of the histories, with the same
    /// normals.
    pub(super) fn has_unchanged_normals(&self) -> bool {
        let histories = &self.state.histories;
        self.pressed.len() == histories.len()
            && self.pressed().iter().all(|contact| {
                let history = &histories[contact.place];
                (history.feature, history.n) == (contact.touch.feature, contact.at.n)
            })
    }

    /// Stores the contacts at the state evaluated last in their histories. The last stage of the
    /// pair is at the step's end, so that state is the end.
    pub(super) fn remember(&mut self) {
        let histories = &mut self.state.histories;
        histories.iter_mut().for_each(|history| history.closed = false);
        for contact in &self.pressed {
            let PressedContact { place, touch, at, normal_force, slides, .. } = *contact;
            let history = &mut histories[place];
            (history.feature, history.triangle) = (touch.feature, touch.triangle);
            (history.n, history.shear, history.roll) = (at.n, at.shear, at.roll);
            (history.normal_force, history.slides) = (normal_force, slides);
            history.closed = normal_force > 0.0 || at.penetration > 0.0;
        }
    }

    /// Position, velocity and spin of the rock.
    pub(super) fn end<const N: usize>(&self, y: &[f64; N]) -> StageMotion {
        StageMotion {
            c: self.state.c + vec3_at(y, DISPLACEMENT),
            v: vec3_at(y, V),
            w: vec3_at(y, W),
        }
    }
}

impl<const C: usize, const N: usize, const Q: usize, const P: usize> Flow<N, Q, P>
    for SphereFlow<'_, '_, C>
{
    /// Writes the rates at `y` into `rates`, at stage `node` of a step, 0 at its ends; its contacts
    /// are then those of the rock's state.
    fn rates(&mut self, node: usize, y: &[f64; N], rates: &mut Rates<N, Q, P>) {
        *rates = Rates::NONE;
        let (c, v, w) = (self.state.c + vec3_at(y, DISPLACEMENT), vec3_at(y, V), vec3_at(y, W));
        self.look(&c);
        let Self { world, state, damped, changes, .. } = self;
        let body = &world.body;
        let (by_mass, by_inertia) = (1.0 / body.mass, 1.0 / body.inertia);
        changes.keep_start_contacts(node, &mut state.touches, body.radius);
        let (mut dv, mut dw, mut taken) = (body.gravity, Vec3::zeros(), 0);
        // patches and edges have switching points that the error estimate hardly sees: a step that
        // meets any is held to a tighter tolerance
        let face = match &state.touches[..] {
            [touch] if touch.is_on_plane() => touch.feature,
            _ => Feature::NONE,
        };
        let first = *self.face.get_or_insert(face);
        let is_end = node == LAST && changes.ends_past_exchange;
        let is_plain = face == first && face != Feature::NONE && !changes.are_any();
        self.is_smooth &= is_end || is_plain;
        self.pressed.clear();
        for k in 0..state.touches.len() {
            let touch = state.touches[k];
            // by feature; a contact without a history takes over that of a similar one, or begins
            // one
            let known = state.histories.iter().position(|history| history.feature == touch.feature);
            let place = known.unwrap_or_else(|| state.history_of(world, k, taken, &v));
            taken |= 1 << place;
            // more contacts than room: this result is discarded, but indices must stay in bounds
            if place >= C {
                self.exceeds_room = true;
                continue;
            }
            let (n, history) = (touch.normal, &state.histories[place]);
            let mut own = None;
            let law = world.law_touched(history, touch.triangle, &mut own);
            // a patch of stiffness |a|² has its dashpot times |a|; parallel patches share theirs
            let share = world.dashpot_share_beside(&state.touches, k, changes.ended());
            let normal = law.normal(history.captured).of_patch(touch.gain2, share);
            let at = ContactDeformation {
                n,
                penetration: (body.radius - touch.distance_m).max(0.0),
                shear: transport(vec3_at(y, SPRINGS + 3 * place), &history.n, &n),
                roll: if Self::rolls::<N>() {
                    vec3_at(y, SPRINGS + 3 * (C + place))
                } else {
                    Vec3::zeros()
                },
            };
            let action = ContactForces::of(body, law, &normal, &at, (&v, &w));
            let ContactForces { normal: [normal_force, pulls], shear, rolling, slip } = action;
            dv += (n * normal_force - shear.force) * by_mass;
            dw += (n.cross(&shear.force) * body.radius - rolling.force) * by_inertia;
            put_vec3(
                &mut rates.y,
                SPRINGS + 3 * place,
                &transport(shear.stretch_rate, &n, &history.n),
            );
            if Self::rolls::<N>() {
                put_vec3(&mut rates.y, SPRINGS + 3 * (C + place), &rolling.stretch_rate);
            }
            let apart = n.dot(&v);
            let others = [normal.dissipating_w(at.penetration, apart), rolling.force.dot(&w)];
            let power = Loss::of_slip((&shear.force, &slip, &shear.stretch_rate), others);
            rates.q[LOSSES + place] = normal.storing_w(at.penetration, -apart);
            *damped |= u32::from(normal.is_damped(body.mass)) << place;
            let power = power.on(world, touch.triangle).parts();
            for (sum, power) in rates.q.iter_mut().zip(power) {
                *sum += power;
            }
            let (cap, most) = law.limits().caps(normal_force);
            // In units of acceleration, so that times a step they are speeds.
            let turn = body.radius * by_inertia;
            rates.switching[3 * place] =
                [(normal_force * by_mass).powi(2), (-pulls).max(0.0) * by_mass];
            rates.switching[3 * place + 1] =
                [shear.trial_force2 * by_mass * by_mass, cap * by_mass];
            rates.switching[3 * place + 2] = [rolling.trial_force2 * turn * turn, most * turn];
            let slides = law.shear.slides2(shear.trial_force2, normal_force);
            let pressed = PressedContact { place, touch, at, normal, normal_force, slides };
            self.pressed.push(pressed);
        }
        put_vec3(&mut rates.y, DISPLACEMENT, &v);
        put_vec3(&mut rates.y, V, &dv);
        put_vec3(&mut rates.y, W, &dw);
    }

    /// Norm of an error: displacement and shear stretches times `ω`, spin times `R`, all in m/s.
    /// The spring of an unloaded contact stores nothing: how it relaxes does not matter.
    #[inline]
    fn size2(&self, off: &[f64; N]) -> f64 {
        let (omega, allowed) = self.scale;
        let pressed = self.pressed().iter().filter(|contact| contact.normal_force > 0.0);
        let stretch2 = pressed
            .map(|contact| vec3_at(off, SPRINGS + 3 * contact.place).norm_squared())
            .fold(vec3_at(off, DISPLACEMENT).norm_squared(), f64::max);
        let worst2 = (stretch2 * omega * omega)
            .max(vec3_at(off, V).norm_squared())
            .max(vec3_at(off, W).norm_squared() * self.world.body.radius.powi(2));
        worst2 / (allowed * allowed)
    }
}
