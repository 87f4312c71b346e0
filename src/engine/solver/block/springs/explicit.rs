//! An impact of a block, followed in its own time.
//!
//! As for spheres (`solver::explicit_impact`): while a contact rebounds it lasts about `π/ω`, and in units of `1/ω` nothing is stiff, so
//! that an explicit pair of order five follows it in a handful of steps, where each implicit stage would cost passes over geometry and
//! contacts. The error is controlled relative to the speed of the impact; a step is cut where friction begins to slip or to stick, where a
//! contact lets go, and where a further one begins.
//!
//! Impacts with more contacts than there is room for, and those that last too long or come too slowly to rebound, go by the implicit
//! stages.

mod flow;

use super::super::{BlockContactState, BlockState, BlockStepOutcome, TOUCH, orthonormal};
use super::impact_energy::gained_j;
use crate::body::Block;
use crate::contact::block::{BlockTouch, BlockTouches};
use crate::contact::pair::LASTS_RAD;
use crate::ground::Law;
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::{FIRST, LONGEST_RAD, SHORTEST_RAD, control_error};
use crate::solver::impact::LOCAL;
use crate::solver::impact::dormand_prince::{Attempt, Flow, Stages};
use crate::solver::loss::Loss;
use crate::solver::step_control::{Control, StepError};
use flow::{BlockFlow, ErrorScale, LOSSES};

/// A contact that lets go is left behind in this times the time that its speed takes (–).
const RELEASE_MARGIN: f64 = 1.2;
/// Penetration that is rounding of places (–, relative to the radius of the sphere of equal volume).
pub(super) const ROUNDING_OF_PLACE: f64 = 1e-11;
/// Tries that are cut where a contact begins, at most; after them it presses from where it is found.
const ONSETS: u32 = 6;
/// Contacts with room of their own: the usual case, and the most that are followed here.
const FEW_PRESS: usize = 2;
const MOST_PRESS: usize = 6;

/// How far a step may go, and how exactly.
#[derive(Debug, Clone, Copy)]
struct ImpactBounds {
    scale: ErrorScale,
    /// Longest step that cannot jump over a feature (s), and longest step asked for (s).
    limit: f64,
    h_max: f64,
}

/// An accepted step.
struct ExplicitStep {
    end: BlockState,
    dt: f64,
    /// What it took, what springs store counted in.
    loss: Loss,
}

impl BlockContactState {
    /// Whether the present contacts are those of an impact whose energy is kept account of: it is followed in its own time, or has too many
    /// contacts for that.
    pub(super) fn is_accounted(&self, world: &ContactEnvironment, control: &Control) -> bool {
        let springs = &self.springs;
        let least_m_s = world.least_impact_m_s();
        control.impact_kernels
            // rolling friction of blocks is in the implicit stages alone
            && world.laws.iter().all(|law| !law.rolling.is_on())
            && springs.histories.iter().any(|one| {
                one.closed
                    && !one.captured
                    && one.age_rad < LASTS_RAD
                    && one.approach_m_s > least_m_s
            })
            // a shear spring without a dashpot has a stretch, not a rate, of its own
            && springs.histories.iter().all(|one| !one.law.shear.is_on() || one.law.shear.is_damped())
    }

    /// Whether there is room to follow the present contacts in their own time.
    pub(super) fn has_room(&self) -> bool {
        self.springs.histories.len() <= MOST_PRESS
    }

    /// One accepted step of an impact of at most `most_s`, and the tries thrown away; `None` if there is no room for its contacts.
    ///
    /// # Errors
    /// [`StepError`] if the motion is no longer finite, or a spring is pressed in too far.
    pub(super) fn explicit_step(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        (control, most_s, limit): (&Control, f64, f64),
    ) -> Result<Option<(BlockStepOutcome, u64)>, StepError> {
        let omega = self.springs.stiffest(world);
        let allowed = LOCAL * control.impact * self.springs.impact_m_s;
        let onset_m = (allowed / omega).max(ROUNDING_OF_PLACE * block.radius_m);
        let scale = ErrorScale { omega, allowed, onset_m };
        let bounds = ImpactBounds { scale, limit: limit.min(LONGEST_RAD / omega), h_max: most_s };
        if self.springs.is_new() {
            self.springs.h = FIRST / omega;
        }
        let start = state.clone();
        let mut rejected = 0;
        let mut step = None;
        if self.springs.histories.len() <= FEW_PRESS {
            step = self.try_steps::<FEW_PRESS, { 12 + 3 * FEW_PRESS }, { LOSSES + FEW_PRESS }, { 2 * FEW_PRESS }>(
                world,
                (block, &start),
                &bounds,
                &mut rejected,
            )?;
        }
        if step.is_none() {
            step = self.try_steps::<MOST_PRESS, { 12 + 3 * MOST_PRESS }, { LOSSES + MOST_PRESS }, { 2 * MOST_PRESS }>(
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
        // what springs store is counted among the losses until they give it back
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

    /// Tries steps with room for `C` contacts until one is accurate; `None` if there are more of them.
    ///
    /// A try that is cut at a kink or where a contact begins is shorter, not wrong.
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
                flow.footing.springs.histories.truncate(flow.footing.springs.known);
                return Ok(None);
            }
            *rejected += 1;
            if let Some(share) = flow.onset {
                onsets += 1;
                admits_new = share <= 0.0 || onsets >= ONSETS;
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
                let loss = flow.taken(&tried.q);
                let mut end = flow.state;
                self.springs.h = h;
                end.pose.attitude = orthonormal(&end.pose.attitude);
                return Ok(Some(ExplicitStep { end, dt, loss }));
            }
        }
    }

    /// Whether the contacts found at the step's end are those that a look would find now, as the pairs that press have changed.
    fn touches_unchanged(&self, block: &Block) -> bool {
        let BlockTouches { found, held, .. } = &self.touches;
        let holds = |touch: &BlockTouch| held.contains(&(touch.part, touch.feature));
        found.iter().all(|touch| block.core.is_corner(touch.part) || holds(touch))
    }

    /// Flies out of contacts that push no more, if that takes no longer than `longest_s` and nothing else is in the way there; how long it
    /// took (s). What still hangs on the contacts has no force, so that the motion is that of a free body.
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
            // weight takes less than half of the speed by then
            let own_s = RELEASE_MARGIN * (clear_m - touch.gap_m).max(0.0) / up_m_s;
            let leaves = contact.normal_force <= 0.0
                && up_m_s > 0.0
                && contact.law.lets_go(up_m_s, 2.0 * weight, own_s);
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
    /// Where it opens and where it slips, for an explicit pair: what is asked of its normal element, squared, and what that would pull with, and
    /// the same of shear. Both in units of acceleration for a mass (kg), so that times a step they are speeds.
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
    /// Whether the impact that goes on has just begun.
    fn is_new(&self) -> bool {
        let mut impacts = self.histories.iter().filter(|one| one.closed && !one.captured);
        impacts.all(|one| one.age_rad <= 0.0)
    }

    /// The contacts have gone on for `dt` (s).
    pub(super) fn advance_ages(&mut self, dt: f64) {
        for history in &mut self.histories {
            history.age_rad += dt * Law::omega_rad_s(&history.law);
        }
    }
}
