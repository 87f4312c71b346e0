//! Schemes `adaptive` and `reference` for blocks: a diagonally implicit tableau with error control.

use super::super::{BlockContactState, BlockState, BlockStepOutcome, TURN_LIMIT};
use super::impact_energy::gained_j;
use super::onset::Onsets;
use super::stage::{StageBase, StageState};
use super::{BlockHistory, BlockRates, Springs};
use crate::body::Block;
use crate::contact::history::transport;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::plane_ahead::longest_step;
use crate::solver::step_control::{
    Control, ONSET, PLACE_ROUNDING, RESOLVED, ROUNDING, StepError, TrialStep, TryOutcome,
    find_accepted_step,
};

/// Energy that a step may gain by its error and that is then removed from the motion (–, relative
/// to the energy of the speed error that the tolerance allows).
const CORRECTABLE: f64 = 1e-2;

/// A trial step of a block among any features.
struct BlockTrial<'a, 'w> {
    world: &'a ContactEnvironment<'w>,
    control: Control,
    contact_state: &'a mut BlockContactState,
    block: &'a Block,
    start: &'a BlockState,
    h: f64,
    limit: f64,
    omega: f64,
    /// Local error allowed (m/s).
    allowed: f64,
    onsets: Onsets,
    /// Whether the impulses of a stage did not converge.
    unsettled: bool,
    /// Energy gained by the error of the step (J), ≥ 0.
    spurious_j: f64,
    end: Option<StageState>,
}

/// Outcome of the stages of a trial step.
enum StagesOutcome {
    /// End of the step, and its error relative to the allowed one.
    Whole(StageState, f64),
    /// An impact begins at this share of the step (–).
    Cut(f64),
}

impl TrialStep for BlockTrial<'_, '_> {
    fn h(&mut self) -> &mut f64 {
        &mut self.h
    }

    fn limit(&mut self) -> f64 {
        self.limit
    }

    fn try_step(&mut self, dt: f64) -> TryOutcome {
        let springs = &mut self.contact_state.springs;
        springs.histories.truncate(springs.known);
        springs.suspends_new = !self.onsets.acts_at_once;
        let tried = self.attempt(dt);
        self.contact_state.springs.suspends_new = false;
        let (end, error) = match tried {
            None => return TryOutcome::NotConverged,
            Some(StagesOutcome::Cut(share)) => {
                return TryOutcome::Cut(self.onsets.cut(share, dt * self.omega));
            }
            Some(StagesOutcome::Whole(end, error)) => (end, error),
        };
        let error = self.onsets.bounded(error, dt * self.omega);
        self.spurious_j = if error <= 1.0 { self.spurious_j(&end, dt) } else { 0.0 };
        // a contact that begins with a penetration, as one feature replaces another, is not avoided
        // by a shorter step
        let is_correctable =
            dt * self.omega <= RESOLVED || self.spurious_j <= self.correctable_j(&end);
        self.end = Some(end);
        if is_correctable { TryOutcome::Error(error) } else { TryOutcome::EnergyGain }
    }
}

impl BlockTrial<'_, '_> {
    /// The stages of one step.
    fn attempt(&mut self, dt: f64) -> Option<StagesOutcome> {
        let tableau = self.control.tableau;
        let way_s = tableau.diagonal * dt;
        // slip-dependent friction is evaluated at the middle of the step
        self.contact_state.springs.ahead_m = 0.5 * dt * self.contact_state.springs.slip_m_s;
        let mut end = None;
        self.unsettled = false;
        for i in 1..tableau.stages {
            let base = self.contact_state.base(self.start, tableau, (i, dt));
            let stage = StageBase { start: self.start, base, times_s: (way_s, way_s) };
            let shear = |BlockContactState { springs, .. }: &BlockContactState, k: usize| {
                let from = (springs.histories[k].shear, &springs.rates[..]);
                tableau.base((i, dt), from, |rate| rate.shear[k])
            };
            let ends = self.contact_state.stage(self.world, self.block, &stage, shear)?;
            self.unsettled |= self.contact_state.unsettled;
            let onset_s = self.onsets.first(
                &self.contact_state.springs,
                (self.block, &ends.state, way_s),
                tableau.node(i) * dt,
            );
            if let Some(onset_s) = onset_s {
                return Some(StagesOutcome::Cut(onset_s / dt));
            }
            self.contact_state.store_rates(self.world, (self.block, &stage), (i, &ends));
            end = Some(ends);
        }
        end.map(|end| StagesOutcome::Whole(end, self.error(dt)))
    }

    /// Local error of the step over the allowed one (–): lengths times the largest contact
    /// frequency, rotations times the largest radius.
    fn error(&self, dt: f64) -> f64 {
        let tableau = self.control.tableau;
        let rates = &self.contact_state.springs.rates;
        let off = |part: fn(&BlockRates) -> Vec3| tableau.embedded_difference(rates, part);
        let (omega, reach) = (self.omega, self.block.bound_m);
        let spin = self.start.mass(self.block).inverse * off(|rate| rate.momentum);
        let histories = 0..self.contact_state.springs.histories.len();
        let stretch =
            histories.map(|k| tableau.embedded_difference(rates, |rate| rate.shear[k]).norm());
        let worst = [
            off(|rate| rate.centre).norm() * omega,
            off(|rate| rate.turned).norm() * reach * omega,
            off(|rate| rate.v).norm(),
            spin.norm() * reach,
            off(|rate| rate.rolled).norm() * reach * omega,
            stretch.fold(0.0, f64::max) * omega,
        ];
        dt * worst.into_iter().fold(0.0, f64::max) / self.allowed
    }

    /// Growth of kinetic, potential and spring energy together over the step (J); 0 if that is
    /// rounding.
    fn spurious_j(&self, end: &StageState, dt: f64) -> f64 {
        let (block, body) = (self.block, &self.world.body);
        let stored_j = self.contact_state.springs.stored_j;
        let before = self.start.motion_j(block) + stored_j;
        let contacts = self.contact_state.springs.contacts.iter();
        let force = block.mass_kg * body.gravity.norm()
            + contacts.map(|contact| contact.normal_force).sum::<f64>();
        let unknown = ROUNDING * before + PLACE_ROUNDING * block.radius_m * force;
        let pressed = self
            .contact_state
            .stored_at_end_j((block, &end.state), self.control.tableau.diagonal * dt);
        let spurious_j = gained_j(self.world, block, (self.start, &end.state)) + pressed - stored_j;
        if spurious_j > unknown { spurious_j } else { 0.0 }
    }

    /// Energy (J) that can be removed from the motion while changing it by no more than a small
    /// part of the tolerance: `m |v| δv`. A block that tips over a corner loses nothing, so each
    /// step gains or loses a little; rejecting every gain would make rounding limit the steps. It
    /// is 0 during an impact and where one begins: a step that gains energy there is too long.
    fn correctable_j(&self, end: &StageState) -> f64 {
        let springs = &self.contact_state.springs;
        let begins = springs.histories[springs.known..].iter().any(|one| !one.captured);
        if begins || springs.impact_m_s > 0.0 {
            return 0.0;
        }
        let mass_kg = self.block.mass_kg;
        let part = end.state.motion_component(self.block, &springs.acting_along());
        let speed_m_s = (2.0 * part.energy_j() / mass_kg).sqrt();
        CORRECTABLE * self.allowed * mass_kg * speed_m_s
    }
}

impl Springs {
    /// Factor by which a stage of length `way_s` (s) reduces the fastest contact motion (–).
    fn left_by_stage(&self, way_s: f64) -> f64 {
        let left = |one: &BlockHistory| one.law.stage_amplification(one.captured, way_s);
        self.histories.iter().map(left).fold(1.0, f64::min)
    }

    /// Removes the energy gained by the error of an accepted step (J) from the motion with which
    /// the next one begins; returns the part that has gone into contacts (J): what the motion has
    /// not `gained` by the step's error is in springs that began with a penetration.
    fn correct_energy(
        &mut self,
        (block, state): (&Block, &mut BlockState),
        (spurious_j, gained_j): (f64, f64),
    ) -> f64 {
        if spurious_j > 0.0 {
            state.take_energy(block, &self.acting_along(), spurious_j);
        }
        let first = &mut self.rates[0];
        (first.centre, first.turned) = (state.v, state.spin(block));
        self.has_current_rates = true;
        (spurious_j - gained_j.max(0.0)).max(0.0)
    }
}

impl BlockContactState {
    /// First step after a touch (s).
    pub(super) fn first_step_s(&self, world: &ContactEnvironment) -> f64 {
        ONSET / self.springs.stiffest(world)
    }

    /// Energy in the springs at the end of a stage of length `way_s` (J).
    fn stored_at_end_j(&self, (block, end): (&Block, &BlockState), way_s: f64) -> f64 {
        let stored = self.springs.contacts.iter().map(|contact| {
            let pen = contact.penetration_after(&end.velocity_at(block, &contact.lever), way_s);
            contact.stored_j(pen, &contact.stretch(way_s))
        });
        stored.sum::<f64>() + self.springs.rolling.stored_after_j(way_s)
    }

    /// Longest step (s) in which no point of the block travels further than `corner_way` times the
    /// balls' radius, and the block turns no further than a step may.
    pub(super) fn travel_limit_s(
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
        corner_way: f64,
    ) -> f64 {
        let spin = state.spin(block).norm();
        let fastest = state.v.norm() + spin * block.bound_m;
        let turn_s = TURN_LIMIT * corner_way / spin.max(f64::MIN_POSITIVE);
        turn_s.min(longest_step(&world.body, fastest, corner_way * block.ball_m))
    }

    /// One accepted step of at most `most_s`.
    ///
    /// # Errors
    /// [`StepError`] if the step had to become too short to matter, or a penetration is too large.
    pub(super) fn controlled_step(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        (control, most_s, limit): (Control, f64, f64),
    ) -> Result<(BlockStepOutcome, u64), StepError> {
        self.springs.update_impact_speed();
        let is_accounted = self.is_accounted(world, &control);
        if is_accounted && self.has_room() {
            let step = self.explicit_step(world, (block, state), (&control, most_s, limit))?;
            if let Some(step) = step {
                return Ok(step);
            }
        }
        let beyond_j = if is_accounted { 0.0 } else { self.balance(block, state) };
        if !self.springs.has_current_rates {
            self.rates_now(world, (block, state));
        }
        let springs = &mut self.springs;
        springs.update_impact_speed();
        let allowed = if springs.impact_m_s > 0.0 {
            control.impact * springs.impact_m_s
        } else {
            control.tolerance
        };
        self.springs.known = self.springs.histories.len();
        let omega = self.springs.stiffest(world);
        let (h, start) = (self.springs.h, state.clone());
        let mut rejected = 0;
        let contact_state = &mut *self;
        let mut trial = BlockTrial {
            world,
            control,
            contact_state,
            block,
            start: &start,
            h,
            limit,
            omega,
            allowed,
            onsets: Onsets::new(&control, (omega, block.radius_m)),
            unsettled: false,
            spurious_j: 0.0,
            end: None,
        };
        let dt = find_accepted_step(&mut trial, &control, (most_s, omega), &mut rejected)?;
        let (next_h, unsettled, spurious_j) = (trial.h, trial.unsettled, trial.spurious_j);
        let end = trial.end.ok_or(StepError::NotConverged)?;
        self.springs.h = next_h;
        *state = end.state;
        self.springs.advance_ages(dt);
        let step = (block, &start, &mut *state);
        let mut done = self.book(world, step, (&control, dt), (spurious_j, is_accounted));
        done.loss.damping += beyond_j;
        done.unsettled = unsettled;
        self.restart_at_onset(world);
        self.check_depth(block)?;
        Ok((done, rejected))
    }

    /// Books the losses of an accepted step from `start`; the motion pays for the energy gained by
    /// its error (J). The energy of an impact is accounted for until it is over.
    fn book(
        &mut self,
        world: &ContactEnvironment,
        (block, start, state): (&Block, &BlockState, &mut BlockState),
        (control, dt): (&Control, f64),
        (spurious_j, is_accounted): (f64, bool),
    ) -> BlockStepOutcome {
        let held_j = self.springs.stored_j;
        let mut done = self.accept(world, (block, state), (control, dt));
        let own_j = gained_j(world, block, (start, state)) + done.loss.sum();
        done.loss.damping += self.springs.correct_energy((block, state), (spurious_j, own_j));
        if is_accounted {
            let own_j = gained_j(world, block, (start, state)) + done.loss.sum();
            self.springs.account((own_j, done.loss.sum()), held_j);
            if done.is_free {
                done.loss.damping += self.balance(block, state);
            }
        }
        done
    }

    /// Accepts the end of the step: histories and losses.
    fn accept(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
        (control, dt): (&Control, f64),
    ) -> BlockStepOutcome {
        let tableau = control.tableau;
        let way_s = tableau.diagonal * dt;
        let mut done = BlockStepOutcome { dt, ..BlockStepOutcome::default() };
        let left = self.springs.left_by_stage(way_s);
        for (k, rate) in self.springs.rates[..tableau.stages].iter().enumerate() {
            done.loss.add(&rate.loss, dt * tableau.damped_work_weight(k, left));
        }
        done.loss.add(&self.elastic_uptake(world, (block, state), way_s), 1.0);
        self.springs.stored_j = self.stored_at_end_j((block, state), way_s);
        self.springs.rates.swap(0, tableau.stages - 1);
        self.store_contacts((block, state), way_s);
        self.springs.invalidate_touches();
        done.slides = self.springs.histories.iter().any(|history| history.slides);
        done.is_free = self.springs.is_free();
        done
    }

    /// Stores the contacts of the step's end in their histories, and drops the histories that no
    /// longer press.
    pub(super) fn store_contacts(&mut self, (block, state): (&Block, &BlockState), way_s: f64) {
        let springs = &mut self.springs;
        for history in &mut springs.histories {
            history.closed = false;
        }
        for (contact, k) in springs.contacts.iter().zip(0..) {
            let history = &mut springs.histories[contact.history];
            let rate = &mut springs.rates[0].shear[contact.history];
            *rate = transport(*rate, &history.n, &contact.n);
            if let Some(touch) = self.touches.found.get(k) {
                history.follow(touch, &state.pose.centre);
            }
            if contact.is_suspended {
                history.age_rad = 0.0;
            }
            history.shear = contact.stretch(way_s);
            history.normal_force = contact.normal_force;
            history.slides =
                contact.law.shear.slides(contact.shear_force.norm(), contact.normal_force);
            let u = state.velocity_at(block, &contact.lever);
            (history.offset_m, history.pressed_m) =
                (contact.offset_m, contact.penetration_after(&u, way_s).max(0.0));
            history.normal_j = contact.normal_j(history.pressed_m);
            history.closed = contact.normal_force > 0.0 || history.pressed_m > 0.0;
        }
        springs.rolling.keep(way_s);
        let mut kept = 0;
        for k in 0..springs.histories.len() {
            if springs.histories[k].closed {
                springs.histories.swap(kept, k);
                springs.rates[0].shear.swap(kept, k);
                kept += 1;
            }
        }
        springs.histories.truncate(kept);
        self.touches.active.clear();
        self.touches.active.extend(springs.histories.iter().map(BlockHistory::pair));
    }
}
