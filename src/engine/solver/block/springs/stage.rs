//! One implicit stage of a block on springs.
//!
//! Forces are those at the stage's end. The solve is exact for given normals and levers, and the
//! loop around it moves the block to the end of the stage. Each pass starts from the penetration
//! found there, moved back by the motion of the pass before. Once the passes agree the end is
//! exact, however the block turns.

use super::super::{BlockContactState, BlockState, ROUNDING_OF_SPEED, TOUCH, orthonormal};
use super::rotation_vector::{rotation_by, rotation_vector_rate};
use super::{BlockRates, SpringContact};
use crate::body::Block;
use crate::contact::block::{BlockContactPoint, Pose};
use crate::contact::history::transport;
use crate::ground::{Law, SliderForce};
use crate::rock::Vec3;
use crate::solver::block::rolling::RollingImpulse;
use crate::solver::block::solve::{BlockContact, Mass, SWEEPS, first_guess, solve, solve_springs};
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::stage::{PASSES, SHIFT_CONVERGED};
use crate::solver::tableau::Tableau;

/// Up to this number of contacts, sweeps are tried first (–).
const FEW: usize = 2;
/// Sweeps of that first try: where friction outweighs the lever, sweeps hardly converge.
const FIRST_SWEEPS: u32 = 8;

/// A block within a step.
#[derive(Debug, Clone)]
pub(super) struct StageState {
    /// Pose and motion.
    pub(super) state: BlockState,
    /// Rotation vector from the step's start (rad).
    pub(super) turned: Vec3,
    /// Stretch of the rolling spring at the base of the stage (rad).
    pub(super) rolled: Vec3,
}

/// Base of a stage.
pub(super) struct StageBase<'m> {
    /// At the step's start.
    pub(super) start: &'m BlockState,
    /// The state plus the explicit part of the stages before.
    pub(super) base: StageState,
    /// Times for which impulses act and for which the block moves (s).
    pub(super) times_s: (f64, f64),
}

impl StageBase<'_> {
    /// The block after moving with this velocity and momentum, its rotation evaluated at `guess`.
    fn advanced(&self, block: &Block, v: Vec3, momentum: Vec3, guess: &StageState) -> StageState {
        let w = guess.state.mass(block).inverse * momentum;
        let b = self.times_s.1;
        let turned = self.base.turned + rotation_vector_rate(&guess.turned, &w) * b;
        let pose = Pose {
            centre: self.base.state.pose.centre + v * b,
            attitude: orthonormal(&(rotation_by(&turned) * self.start.pose.attitude)),
        };
        StageState { state: BlockState { pose, v, momentum }, turned, rolled: self.base.rolled }
    }
}

impl SpringContact {
    /// The contact of history `history` at penetration zero, with a coefficient of friction (–).
    pub(super) fn just_touching(
        (history, touch): (usize, &BlockContactPoint),
        law: &Law,
        friction: f64,
    ) -> Self {
        let mut law = law.of_patch(touch.gain2, 1.0);
        law.set_friction(friction);
        Self {
            history,
            law,
            captured: false,
            is_suspended: false,
            triangle: touch.triangle,
            n: touch.normal,
            lever: touch.lever,
            offset_m: 0.0,
            penetration: 0.0,
            shear: Vec3::zeros(),
            normal_force: 0.0,
            shear_force: Vec3::zeros(),
        }
    }
}

impl BlockContactState {
    /// The base of implicit stage `i` of a step of length `h` (s) from `start`.
    pub(super) fn base(
        &self,
        start: &BlockState,
        tableau: &Tableau,
        (i, h): (usize, f64),
    ) -> StageState {
        let base =
            |x, part: fn(&BlockRates) -> Vec3| tableau.base((i, h), (x, &self.springs.rates), part);
        let BlockState { pose: Pose { centre, attitude }, v, momentum } = *start;
        let pose = Pose { centre: base(centre, |rate| rate.centre), attitude };
        StageState {
            state: BlockState {
                pose,
                v: base(v, |rate| rate.v),
                momentum: base(momentum, |rate| rate.momentum),
            },
            turned: base(Vec3::zeros(), |rate| rate.turned),
            rolled: base(self.springs.rolling.stretch, |rate| rate.rolled),
        }
    }

    /// Solves a stage; `None` if geometry and forces do not converge. `shear_of` gives the stretch
    /// of a history at the base.
    pub(super) fn stage(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        stage: &StageBase,
        shear_of: impl Fn(&Self, usize) -> Vec3,
    ) -> Option<StageState> {
        let (act_s, _) = stage.times_s;
        let free_v = stage.base.state.v + world.body.gravity * act_s;
        let mut guess = stage.advanced(block, free_v, stage.base.state.momentum, &stage.base);
        let ahead_m = Self::ahead_m(world, (block, stage.start), stage.times_s.1);
        for _ in 0..PASSES {
            self.detect_all(world, (block, &guess.state.pose), ahead_m);
            self.update_histories(world, (block, &guess.state));
            self.place_contacts(
                world,
                (block, stage.start, &guess.state),
                stage.times_s.1,
                &shear_of,
            );
            let (v, momentum) = self.solve_contacts(block, stage, &guess.state, free_v);
            let end = stage.advanced(block, v, momentum, &guess);
            let moved = (end.state.pose.centre - guess.state.pose.centre).norm()
                + (end.turned - guess.turned).norm() * block.bound_m;
            guess = end;
            if moved <= SHIFT_CONVERGED * block.radius_m {
                return Some(guess);
            }
        }
        None
    }

    /// Penetration (m) at which the spring of a contact begins to act. It is 0, except where a
    /// contact of an edge or a face of the block begins in this step, or moves to another feature,
    /// with a larger penetration at the step's start than its spring had. The penetration that a
    /// feature finds when it takes over a contact stores nothing, so that no change of features can
    /// gain energy. The patches of a corner's ball take over from each other without a jump, as
    /// they have the same springs (`springs_parted_from`).
    fn offset_m(
        &self,
        (start, guess): (&BlockState, &BlockState),
        touch: &BlockContactPoint,
        (block, history): (&Block, usize),
    ) -> f64 {
        let recorded = &self.springs.histories[history];
        if block.core.is_corner(touch.part) {
            return 0.0;
        }
        if history < self.springs.known && recorded.is_of(touch) {
            return recorded.offset_m;
        }
        let own = guess.pose.attitude.inverse_transform_vector(&touch.lever);
        let way = guess.pose.centre + touch.lever - start.pose.point(&own);
        let began_m = touch.normal.dot(&way) - touch.gap_m;
        (began_m - recorded.pressed_m).max(0.0)
    }

    /// Creates the contacts of the last detection, at `guess`, based at the stage's base.
    pub(super) fn place_contacts(
        &mut self,
        world: &ContactEnvironment,
        (block, start, guess): (&Block, &BlockState, &BlockState),
        way_s: f64,
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) {
        let mut contacts = std::mem::take(&mut self.springs.contacts);
        contacts.clear();
        for (k, touch) in self.touches.found.iter().enumerate() {
            let Some(history) = self.history_of_touch[k] else { continue };
            let recorded = &self.springs.histories[history];
            let ground = world.ground_of(touch.triangle);
            let friction = self.slip.friction(ground, &recorded.law, self.springs.ahead_m);
            let offset_m = self.offset_m((start, guess), touch, (block, history));
            contacts.push(SpringContact {
                offset_m,
                captured: recorded.captured,
                is_suspended: self.springs.suspends_new
                    && history >= self.springs.known
                    && !recorded.captured
                    && recorded.approach_m_s > 0.0,
                penetration: way_s * touch.normal.dot(&guess.velocity_at(block, &touch.lever))
                    - touch.gap_m
                    - offset_m,
                shear: transport(shear_of(self, history), &recorded.n, &touch.normal),
                ..SpringContact::just_touching((history, touch), &recorded.law, friction)
            });
        }
        self.springs.rolling.adopt_element(&contacts);
        self.springs.contacts = contacts;
    }

    /// Unknowns of a stage: its contacts, and their rolling friction.
    fn unknowns(&mut self) -> (&mut [BlockContact], &mut RollingImpulse) {
        (&mut self.contacts, &mut self.rolling)
    }

    /// Velocity and momentum at the stage's end for the present contacts, with the attitude of
    /// `guess`.
    pub(super) fn solve_contacts(
        &mut self,
        block: &Block,
        stage: &StageBase,
        guess: &BlockState,
        free_v: Vec3,
    ) -> (Vec3, Vec3) {
        let (mass, act_s) = (guess.mass(block), stage.times_s.0);
        let mut pushed = BlockState { v: free_v, ..stage.base.state.clone() };
        self.contacts.clear();
        let pressing = |contact: &&SpringContact| !contact.is_suspended;
        for contact in self.springs.contacts.iter().filter(pressing) {
            let mut soft = contact.stage_compliance(&mass, stage.times_s);
            soft.impulse = self.springs.histories[contact.history].impulse;
            self.contacts.push(soft);
        }
        let began = self.springs.rolling.stage_compliance(&stage.base.rolled, stage.times_s);
        self.rolling = began;
        pushed.apply_impulses(&self.contacts, &began, block.mass_kg);
        let rounding_m_s = ROUNDING_OF_SPEED * (free_v.norm() + guess.v.norm());
        let free = (free_v, mass.inverse * stage.base.state.momentum);
        let from = (pushed.v, mass.inverse * pushed.momentum);
        // sweeps are faster for one or two contacts, if they converge
        let (quick, mut sweeps) = ((rounding_m_s, FIRST_SWEEPS), 0);
        self.unsettled = false;
        let settled =
            self.contacts.len() <= FEW && solve(&mass, self.unknowns(), from, quick, &mut sweeps);
        sweeps += u64::from(!settled);
        if !settled && !solve_springs(&mass, self.unknowns(), (free, from), rounding_m_s) {
            self.rolling = began;
            let known = self.springs.contacts.iter().filter(pressing);
            for (contact, own) in self.contacts.iter_mut().zip(known) {
                contact.impulse = self.springs.histories[own.history].impulse;
            }
            self.unsettled =
                !solve(&mass, self.unknowns(), from, (rounding_m_s, SWEEPS), &mut sweeps);
        }
        self.sweeps += sweeps;
        self.springs.rolling.set_moment(&self.rolling, act_s);
        let known = self.springs.contacts.iter_mut().filter(|contact| !contact.is_suspended);
        for (contact, solved) in known.zip(&self.contacts) {
            contact.set_forces(&solved.impulse, act_s);
            self.springs.histories[contact.history].impulse = first_guess(solved.impulse);
        }
        let mut end = BlockState { v: free_v, ..stage.base.state.clone() };
        end.apply_impulses(&self.contacts, &self.rolling, block.mass_kg);
        (end.v, end.momentum)
    }

    /// Stores the rates of stage `i`, which ends at `end`.
    pub(super) fn store_rates(
        &mut self,
        world: &ContactEnvironment,
        (block, stage): (&Block, &StageBase),
        (i, end): (usize, &StageState),
    ) {
        let (base, way_s) = (&stage.base, stage.times_s.1);
        let springs = &mut self.springs;
        let rate = &mut springs.rates[i];
        rate.centre = end.state.v;
        rate.v = (end.state.v - base.state.v) / way_s;
        rate.momentum = (end.state.momentum - base.state.momentum) / way_s;
        rate.turned = (end.turned - base.turned) / way_s;
        rate.loss = Loss::default();
        rate.shear.fill(Vec3::zeros());
        for contact in &springs.contacts {
            let shear_rate = (contact.stretch(way_s) - contact.shear) / way_s;
            let back = &springs.histories[contact.history].n;
            rate.shear[contact.history] = transport(shear_rate, &contact.n, back);
            let u = end.state.velocity_at(block, &contact.lever);
            rate.loss.add(&contact.power_of_stage(world, (block, &u), &shear_rate), 1.0);
        }
        rate.rolled = springs.rolling.rate_over(way_s);
        let spin = end.state.spin(block);
        rate.loss.add(&springs.rolling.power(world, &springs.contacts, &spin), 1.0);
    }

    /// Rates at the present state, for the explicit first stage.
    pub(super) fn rates_now(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) {
        self.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
        // contacts here without a history begin here
        self.springs.known = self.springs.histories.len();
        self.update_histories(world, (block, state));
        self.place_contacts(world, (block, state, state), 0.0, &|contact_state, k| {
            contact_state.springs.histories[k].shear
        });
        let springs = &mut self.springs;
        springs.keep_offsets();
        let mut rate = std::mem::take(&mut springs.rates[0]);
        rate.shear.fill(Vec3::zeros());
        (rate.centre, rate.v, rate.loss) = (state.v, world.body.gravity, Loss::default());
        (rate.turned, rate.momentum) = (state.spin(block), Vec3::zeros());
        for contact in &mut springs.contacts {
            let (n, u) = (contact.n, Mass::velocity_at(&contact.lever, (&state.v, &rate.turned)));
            let SliderForce { stretch_rate, .. } = contact.update_forces(&u).1;
            let force = n * contact.normal_force - contact.shear_force;
            rate.v += force / block.mass_kg;
            rate.momentum += contact.lever.cross(&force);
            let back = &springs.histories[contact.history].n;
            rate.shear[contact.history] = transport(stretch_rate, &n, back);
            rate.loss.add(&contact.power_of_stage(world, (block, &u), &stretch_rate), 1.0);
        }
        let rolling = springs.rolling.update_moment(&springs.contacts, &rate.turned);
        rate.momentum -= rolling.force;
        rate.rolled = rolling.stretch_rate;
        rate.loss.add(&springs.rolling.power(world, &springs.contacts, &rate.turned), 1.0);
        springs.rates[0] = rate;
        springs.has_current_rates = true;
    }
}
