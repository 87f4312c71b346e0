//! Explicit integration of an impact of a block.
//!
//! As for spheres (`solver::explicit_impact`): a rebound lasts about `π/ω`, and in units of `1/ω`
//! nothing is stiff. An explicit pair of order five needs a handful of steps, whereas each implicit
//! stage would iterate over geometry and contacts. The error is controlled relative to the speed of
//! the impact. A step is cut where friction changes between slipping and sticking, where a contact
//! opens, and where a further one begins.
//!
//! Impacts with more contacts than there is room for, and those that last too long or are too slow
//! to rebound, are integrated by the implicit stages.

mod flow;

use super::super::{BlockContactState, BlockState, BlockStepOutcome, TOUCH, orthonormal};
use super::impact_energy::gained_j;
use crate::body::Block;
use crate::contact::block::{BlockContactPoint, BlockContactPoints};
use crate::contact::pair::IMPACT_DURATION_RAD;
use crate::ground::Law;
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::{FIRST, LONGEST_RAD, SHORTEST_RAD, control_error};
use crate::solver::impact::LOCAL_ERROR;
use crate::solver::impact::dormand_prince::{Attempt, Flow, Stages};
use crate::solver::loss::Loss;
use crate::solver::step_control::{Control, StepError};
use flow::{BlockFlow, ErrorScale, LOSSES};

/// A block flies clear of an open contact for this multiple of the time that its speed needs (–).
const RELEASE_MARGIN: f64 = 1.2;
/// Penetration that is rounding of positions (–, relative to the radius of the sphere of equal
/// volume).
pub(super) const ROUNDING_OF_PLACE: f64 = 1e-11;
/// Trial steps cut where a contact begins, at most; after them it presses from where it is found.
const MOST_ONSET_CUTS: u32 = 6;
/// Room for contacts: of the usual case, and the most that are integrated here.
const FEW_CONTACTS: usize = 2;
const MOST_CONTACTS: usize = 6;

/// Bounds of a step, and its error scale.
#[derive(Debug, Clone, Copy)]
struct ImpactBounds {
    scale: ErrorScale,
    /// Longest step that cannot miss a feature (s), and longest step requested (s).
    limit: f64,
    h_max: f64,
}

/// An accepted step.
struct ExplicitStep {
    end: BlockState,
    dt: f64,
    /// Loss of the step, with the energy that springs store counted in.
    loss: Loss,
}

impl BlockContactState {
    /// Whether the present contacts are those of an impact whose energy is accounted for: it is
    /// integrated explicitly, or has too many contacts for that.
    pub(super) fn is_accounted(&self, world: &ContactEnvironment, control: &Control) -> bool {
        let springs = &self.springs;
        let least_m_s = world.least_impact_m_s();
        control.impact_kernels
            // rolling friction of blocks is in the implicit stages alone
            && world.laws.iter().all(|law| !law.rolling.is_on())
            && springs.histories.iter().any(|one| {
                one.closed
                    && !one.captured
                    && one.age_rad < IMPACT_DURATION_RAD
                    && one.approach_m_s > least_m_s
            })
            // a shear spring without a dashpot has a stretch, not a rate, of its own
            && springs.histories.iter().all(|one| !one.law.shear.is_on() || one.law.shear.is_damped())
    }

    /// Whether there is room to integrate the present contacts explicitly.
    pub(super) fn has_room(&self) -> bool {
        self.springs.histories.len() <= MOST_CONTACTS
    }

    /// One accepted step of an impact of at most `most_s`, and the number of rejected trial steps;
    /// `None` if there is no room for its contacts.
    ///
    /// # Errors
    /// [`StepError`] if the motion is no longer finite, or a penetration is too large.
    pub(super) fn explicit_step(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        (control, most_s, limit): (&Control, f64, f64),
    ) -> Result<Option<(BlockStepOutcome, u64)>, StepError> {
        let omega = self.springs.stiffest(world);
        let allowed = LOCAL_ERROR * control.impact * self.springs.impact_m_s;
        let onset_m = (allowed / omega).max(ROUNDING_OF_PLACE * block.radius_m);
        let scale = ErrorScale { omega, allowed, onset_m };
        let bounds = ImpactBounds { scale, limit: limit.min(LONGEST_RAD / omega), h_max: most_s };
        if self.springs.is_new() {
            self.springs.h = FIRST / omega;
        }
        let start = state.clone();
        let mut rejected = 0;
        let mut step = None;
        if self.springs.histories.len() <= FEW_CONTACTS {
            step = self.try_steps::<FEW_CONTACTS, { 12 + 3 * FEW_CONTACTS }, { LOSSES + FEW_CONTACTS }, { 2 * FEW_CONTACTS }>(
                world,
                (block, &start),
                &bounds,
                &mut rejected,
            )?;
        }
        if step.is_none() {
            step = self.try_steps::<MOST_CONTACTS, { 12 + 3 * MOST_CONTACTS }, { LOSSES + MOST_CONTACTS }, { 2 * MOST_CONTACTS }>(
                world,
                (block, &start),
                &bounds,
                &mut rejected,
            )?;
        }
        let Some(step) = step else { return Ok(None) };
        *state = step.end;
        self.store_contacts((block, state), 0.0);
        self.springs.advance_ages(step.dt);
        let held_j = self.springs.stored_j;
        self.springs.stored_j = self.springs.stored_by_contacts(world).sum();
        self.springs.invalidate_rates();
        self.springs.touches_are_current = self.touches_unchanged(block);
        // the energy that springs store is counted as lost until they return it
        let gained_j = gained_j(world, block, (&start, state)) + step.loss.sum();
        self.springs.account((gained_j, step.loss.sum()), held_j);
        let mut done =
            BlockStepOutcome { dt: step.dt, loss: step.loss, ..BlockStepOutcome::default() };
        done.slides = self.springs.histories.iter().any(|history| history.slides);
        let left_s = most_s - step.dt;
        done.dt += self.fly_clear(world, (block, state), left_s.min(limit));
        done.is_free = self.springs.is_free();
        if done.is_free {
            done.loss.damping += self.balance(block, state);
        }
        self.check_depth(block)?;
        Ok(Some((done, rejected)))
    }

    /// Tries steps with room for `C` contacts until one is accurate; `None` if there are more
    /// contacts.
    ///
    /// A trial step that is cut where a slider switches or a contact begins is shorter, not
    /// rejected for its error.
    fn try_steps<const C: usize, const N: usize, const Q: usize, const P: usize>(
        &mut self,
        world: &ContactEnvironment,
        on: (&Block, &BlockState),
        bounds: &ImpactBounds,
        rejected: &mut u64,
    ) -> Result<Option<ExplicitStep>, StepError> {
        let ImpactBounds { scale, limit, h_max } = *bounds;
        let mut h = self.springs.h;
        let mut flow = BlockFlow::<C>::new(world, self, on, scale);
        let y = flow.initial_state::<N>();
        let mut stages = Stages::<N, Q, P>::NONE;
        flow.rates(0, &y, stages.first());
        flow.fix_contacts();
        let (mut onsets, mut admits_new) = (0, false);
        loop {
            let wished = h.min(limit);
            let dt = wished.min(h_max);
            let is_short = dt * scale.omega < SHORTEST_RAD;
            flow.begin_try(dt, admits_new || is_short);
            let felt = (!is_short).then_some(scale.allowed);
            let attempt = stages.step(&mut flow, &y, dt, felt);
            if flow.exceeds_room {
                flow.contact_state.springs.histories.truncate(flow.contact_state.springs.known);
                return Ok(None);
            }
            *rejected += 1;
            if let Some(share) = flow.onset {
                onsets += 1;
                admits_new = share <= 0.0 || onsets >= MOST_ONSET_CUTS;
                h = if share > 0.0 { dt * share } else { dt };
                continue;
            }
            let tried = match attempt {
                Attempt::Whole(tried) => tried,
                Attempt::Cut(share) => {
                    h = dt * share;
                    continue;
                }
            };
            let (accepted, next_h) =
                control_error((dt, wished), (tried.error2, flow.is_smooth), is_short)?;
            h = next_h;
            if accepted {
                *rejected -= 1;
                let loss = flow.loss(&tried.q);
                let mut end = flow.state;
                self.springs.h = h;
                end.pose.attitude = orthonormal(&end.pose.attitude);
                return Ok(Some(ExplicitStep { end, dt, loss }));
            }
        }
    }

    /// Whether a detection now would find the contacts of the step's end, although the pressing
    /// pairs may have changed.
    fn touches_unchanged(&self, block: &Block) -> bool {
        let BlockContactPoints { found, active: held, .. } = &self.touches;
        let holds = |touch: &BlockContactPoint| held.contains(&(touch.part, touch.feature));
        found.iter().all(|touch| block.core.is_corner(touch.part) || holds(touch))
    }

    /// Flies clear of open contacts if that takes at most `longest_s` and no other contact is met;
    /// returns the flight time (s). The remaining contacts exert no force, so that the motion is
    /// free.
    fn fly_clear(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        longest_s: f64,
    ) -> f64 {
        let (gravity, clear_m) = (world.body.gravity, 2.0 * TOUCH * block.radius_m);
        let mut out_s: f64 = 0.0;
        for (contact, touch) in self.springs.contacts.iter().zip(&self.touches.found) {
            let up_m_s = contact.n.dot(&state.velocity_at(block, &contact.lever));
            let weight = contact.n.dot(&gravity).min(0.0);
            // weight reduces the speed by less than half in this time
            let own_s = RELEASE_MARGIN * (clear_m - touch.gap_m).max(0.0) / up_m_s;
            let leaves = contact.normal_force <= 0.0
                && up_m_s > 0.0
                && contact.law.stays_open(up_m_s, 2.0 * weight, own_s);
            if !leaves {
                return 0.0;
            }
            out_s = out_s.max(own_s);
        }
        if out_s <= 0.0 || out_s > longest_s {
            return 0.0;
        }
        let mut out = state.clone();
        out.drift(block, out_s);
        out.pose.centre += gravity * (0.5 * out_s * out_s);
        out.v += gravity * out_s;
        self.detect_all(world, (block, &out.pose), TOUCH * block.radius_m);
        if !self.touches.found.is_empty() {
            self.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
            return 0.0;
        }
        *state = out;
        self.springs.histories.clear();
        out_s
    }
}

impl super::SpringContact {
    /// Switching functions of the explicit pair, for the opening of the contact and for slip: the
    /// squared trial value and the cap of the normal element, whose "cap" is the tension that it
    /// would exert, and those of shear. Both are accelerations of a mass (kg), so that times a step
    /// they are velocities.
    pub(super) fn switching(&self, (pulls, asked2): (f64, f64), mass_kg: f64) -> [[f64; 2]; 2] {
        let (by_mass, pushes) = (1.0 / mass_kg, self.normal_force);
        let cap = self.law.shear.cap(pushes);
        [
            [(pushes * by_mass).powi(2), (-pulls).max(0.0) * by_mass],
            [asked2 * by_mass * by_mass, cap * by_mass],
        ]
    }
}

impl super::Springs {
    /// Whether the current impact has just begun.
    fn is_new(&self) -> bool {
        let mut impacts = self.histories.iter().filter(|one| one.closed && !one.captured);
        impacts.all(|one| one.age_rad <= 0.0)
    }

    /// Advances the ages of the contacts by `dt` (s).
    pub(super) fn advance_ages(&mut self, dt: f64) {
        for history in &mut self.histories {
            history.age_rad += dt * Law::omega_rad_s(&history.law);
        }
    }
}
