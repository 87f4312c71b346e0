//! Schemes `adaptive` and `reference`: a diagonally implicit tableau with error control.
//!
//! ```text
//! stage i:   x_i = x + h Σ_{j<i} a_ij f_j + h γ f(x_i),      f_i = f(x_i)
//! error:     h |Σ_i (b_i − b̂_i) f_i|,  in m/s: max(|Δv|, R |Δω|, ω |Δc|, ω |Δξ|)  over the tolerance
//! next step: h · clamp(0.9 err^(−1/(p̂+1)), 0.2, 4)
//! ```
//!
//! Displacements and stretches are multiplied by `ω = √(p_N/m)`: in these units one tolerance in
//! m/s bounds motion and springs alike, and the cost of an impact does not depend on `p_N`. A step
//! is also rejected when a
//! stage has no solution, when it would jump over a feature, and when energy rises.

mod onset;
mod controller;

use super::Settings;
use super::body::Body;
use super::contact_state::{ContactEnvironment, ContactState, Onset};
use super::law::StageContact;
use super::loss::Loss;
use super::stage::StageMotion;
use super::tableau::Tableau;
use crate::contact::history::transport;
use crate::ground::Law;
pub(crate) use controller::{StepFailure, TrialStep, TryOutcome, find_accepted_step};
pub(crate) use onset::{FirstOnset, MOST_CUTS, ONSET_ACCURACY_RAD, OnsetSearch};

/// First step of a contact, in radians of its oscillation (–): an unresolved impact would create
/// energy.
///
/// Schemes of second order and more make energy out of an impact that they do not resolve, up to
/// four times the speed at `ω h` of 1e4.
pub(crate) const ONSET: f64 = 0.3;
/// Longest travel in one step where more than one plane is near (–, relative to R). On one plane no
/// feature can be missed, and the error alone limits the step.
pub(crate) const TRAVEL: f64 = 0.15;
/// A step this short, in radians of the stiffest contact, resolves everything: its energy gain is
/// rounding (–).
pub(crate) const RESOLVED: f64 = 1e-3;
/// Relative gain of energy in one step that is rounding (–).
pub const ROUNDING: f64 = 1e-10;
/// Rounding of positions, relative to the radius (–).
pub(crate) const PLACE_ROUNDING: f64 = 1e-11;

/// Why a step cannot be completed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum StepError {
    /// No step, however short, converges.
    #[error("the contact step would not settle, however short")]
    NotConverged,
    /// The rock is so deep in the mesh that its contact springs mean nothing any more.
    #[error("the rock sank in by half its radius: its contact springs are too soft for its speed")]
    SankIn,
    /// Position, velocity or spin are no longer numbers.
    #[error("the motion is no longer finite")]
    NotFinite,
}

/// Result of one advance.
#[derive(Debug, Clone, Copy, Default)]
pub struct Advance {
    /// Length of the step (s).
    pub dt: f64,
    /// Energy lost by each kind of contact work (J).
    pub loss: Loss,
    /// Steps taken: one, or those of a whole impact.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Whether the contact states did not converge (`dda`).
    pub unsettled: bool,
}

/// Settings of the step control.
#[derive(Debug, Clone, Copy)]
pub struct Control {
    /// The tableau.
    pub tableau: &'static Tableau,
    /// Local error allowed in sustained contact (m/s) …
    pub tolerance: f64,
    /// … and in an impact (–, relative to its speed).
    pub impact: f64,
    /// Whether impacts have kernels of their own: whole impacts on one plane, explicit stages for
    /// blocks.
    pub impact_kernels: bool,
}

/// Local error allowed in an impact (–, relative to its speed): per 1 m/s of the tolerance of
/// sustained contact, and at most.
///
/// 4e-3 times the tolerance, 2e-4 at most: at the default of 0.05 m/s that is 2e-4, and restitution
/// is right to about as much.
pub const IMPACT: (f64, f64) = (4e-3, 2e-4);
/// Coarsest tolerance that has an effect (m/s). Beyond it impacts, which carry most of the error,
/// are resolved as if it were this.
pub const COARSEST_M_S: f64 = IMPACT.1 / IMPACT.0;
/// Local error allowed in an impact by the scheme `reference` (–, relative to its speed).
pub const IMPACT_OF_REFERENCE: f64 = 1e-10;
/// Upper bound of the local error allowed in sustained contact (–, relative to √(g R), the speed of
/// a rock that tips over an edge).
const SUSTAINED_TOLERANCE: f64 = 0.02;

impl Control {
    /// The control of a rock in `world`.
    pub fn new(tableau: &'static Tableau, settings: &Settings, world: &ContactEnvironment) -> Self {
        let usual = (IMPACT.0 * settings.tolerance_m_s).min(IMPACT.1);
        let impact = settings.scheme.of([usual, usual, IMPACT_OF_REFERENCE, usual]);
        Self {
            tableau,
            tolerance: sustained_tolerance_m_s(settings, &world.body),
            impact,
            impact_kernels: settings.impact_kernels,
        }
    }
}

/// Local error allowed in the forces of contacts that wedge a rock between faces (–, relative to
/// its weight).
const WEDGED: f64 = 3e-3;
/// Faces wedge a rock where the cosine between their normals is below this (–).
const WEDGING_COSINE: f64 = 0.97;

/// Local error allowed to a rock in sustained contact (m/s): the smaller one of the tolerance of
/// the run and a share of `√(g R)`.
pub(crate) fn sustained_tolerance_m_s(settings: &Settings, body: &Body) -> f64 {
    let own = body.fall_speed_m_s();
    let relative = if own > 0.0 { SUSTAINED_TOLERANCE * own } else { f64::INFINITY };
    settings.tolerance_m_s.min(relative)
}

/// First step after a touch (s).
pub fn first_step(world: &ContactEnvironment, state: &ContactState) -> f64 {
    ONSET / stiffest(world, state)
}

/// Largest `√(p_N/m)` among the contacts (rad/s).
fn stiffest(world: &ContactEnvironment, state: &ContactState) -> f64 {
    let omega = state.stiffest_rad_s(world);
    if omega > 0.0 { omega } else { world.laws.iter().map(Law::omega_rad_s).fold(0.0, f64::max) }
}

/// One accepted step of at most `h_max` (s), or all steps of an impact on one plane. `h` (s) is the
/// step to try; on return it is the step to try next.
///
/// # Errors
/// [`StepError`] if the step had to become too short to matter, or the motion is no longer finite.
pub fn advance(
    world: &ContactEnvironment,
    control: &Control,
    state: &mut ContactState,
    h: &mut f64,
    h_max: f64,
) -> Result<Advance, StepError> {
    let done = step(world, control, state, (h, h_max))?;
    // a maximum of errors ignores NaN
    if state.is_finite() { Ok(done) } else { Err(StepError::NotFinite) }
}

/// The step itself, or all steps of an impact on one plane.
fn step(
    world: &ContactEnvironment,
    control: &Control,
    state: &mut ContactState,
    (h, h_max): (&mut f64, f64),
) -> Result<Advance, StepError> {
    let mut done = Advance::default();
    // An impact is short and not stiff on its own time scale: explicit stages, over the whole
    // impact on one plane, step by step elsewhere.
    if state.is_rebounding() {
        state.leave_plane(world);
        if control.impact_kernels
            && state.finish_plane_impact(world, control.impact, h_max, &mut done)
        {
            return Ok(done);
        }
        let omega = stiffest(world, state);
        return state.step_impact(world, (omega, control.impact), h_max, &mut done).map(|()| done);
    }
    // sustained contact on one plane: its kernel, else the stages among any features
    if let Some(settled) = state.step_on_plane(world, control, (&mut *h, h_max), &mut done) {
        return settled.map(|()| done);
    }
    state.leave_plane(world);
    // First same as last: the rates at a step's end are those of the next step's first stage,
    // unless something has changed them
    if !state.fresh {
        state.rates_now(world);
    }
    let limit = state.longest_step(world, TRAVEL);
    let (omega, histories_at_start) = (stiffest(world, state), state.histories.len());
    let (end, onsets) = (None, OnsetSearch::NEW);
    let mut trial =
        RockTrial { world, control, state, h, limit, omega, histories_at_start, end, onsets };
    done.dt = find_accepted_step(&mut trial, control, (h_max, omega), &mut done.rejected)?;
    done.steps = 1;
    if let Some(end) = trial.end {
        accept(world, control.tableau, state, (&end, done.dt), &mut done.loss);
        // deferred contacts act from now on
        state.fresh &= !std::mem::take(&mut state.onset).is_reached;
    }
    Ok(done)
}

/// A trial step of a rock among any features.
struct RockTrial<'a, 'w> {
    world: &'a ContactEnvironment<'w>,
    control: &'a Control,
    state: &'a mut ContactState,
    h: &'a mut f64,
    limit: f64,
    omega: f64,
    /// Number of contact histories at the step's start.
    histories_at_start: usize,
    end: Option<StageMotion>,
    onsets: OnsetSearch,
}

impl TrialStep for RockTrial<'_, '_> {
    fn h(&mut self) -> &mut f64 {
        self.h
    }

    fn limit(&mut self) -> f64 {
        self.limit
    }

    fn try_step(&mut self, dt: f64) -> TryOutcome {
        // histories that a rejected try has added are discarded
        self.state.histories.truncate(self.histories_at_start);
        self.state.onset =
            Onset { deferred: self.onsets.defers(dt * self.omega), is_reached: false };
        let Some((end, error)) = attempt(self.world, self.control, self.state, dt, self.omega)
        else {
            return TryOutcome::NotConverged;
        };
        self.end = Some(end);
        let hh = self.control.tableau.diagonal * dt;
        if let Some(share) = self.until_impact(&end, (dt, hh)) {
            return TryOutcome::Cut(share);
        }
        // the energy of a contact that has just begun is below the step's error
        if error <= 1.0
            && !self.state.onset.is_reached
            && dt * self.omega > RESOLVED
            && gains_energy(self.world, self.state, &end, hh)
        {
            return TryOutcome::EnergyGain;
        }
        TryOutcome::Error(error)
    }
}

/// Whether kinetic energy, height and springs together have more energy at the step's end than at
/// its start.
///
/// `m v²/2 + I ω²/2 − m g·Δc + springs`, end against start; dashpots and friction
/// only dissipate.
fn gains_energy(
    world: &ContactEnvironment,
    state: &ContactState,
    end: &StageMotion,
    hh: f64,
) -> bool {
    let body = &world.body;
    let [before, after] = energies_j(body, state, (end, hh));
    // Positions are rounded to about 1e-13 of a slope's size: this times the forces is the
    // uncertainty of the work.
    let contacts = state.stage_contacts().iter();
    let force = body.mass * body.gravity.norm() + contacts.map(|one| one.normal_force).sum::<f64>();
    let rounding_j = ROUNDING * before + PLACE_ROUNDING * body.radius * force;
    after > before + rounding_j
}

/// Kinetic energy, height over the step's start and springs of a rock (J), at the start of a step
/// and at its end.
pub(crate) fn energies_j(
    body: &Body,
    state: &ContactState,
    (end, hh): (&StageMotion, f64),
) -> [f64; 2] {
    let motion = body.motion_j((&end.v, &end.w));
    // height relative to the start of the step: absolute heights would cost digits
    let lifted = body.lifted_j(&(end.c - state.c));
    [state.motion_j(body) + state.stored, motion + lifted + springs_at_end_j(state, end, hh)]
}

/// Energy in the springs of the contacts that are closed at the end of the step (J):
/// `Σ (p_N pen² + p_s ξ² + k_r θ²)/2`.
fn springs_at_end_j(state: &ContactState, end: &StageMotion, hh: f64) -> f64 {
    let closed = state.stage_contacts().iter().filter(|contact| contact.is_closed(&end.v, hh));
    let stored = closed.map(|contact| {
        let (penetration, law) = (contact.penetration_at(&end.v, hh).max(0.0), &contact.law);
        let (shear, roll) = contact.stretches(hh);
        law.stored_j(penetration, shear.norm_squared(), roll.norm_squared())
    });
    stored.sum()
}

/// One try of a step: its end and its error relative to the tolerance; `None` if a stage does not
/// converge.
fn attempt(
    world: &ContactEnvironment,
    control: &Control,
    state: &mut ContactState,
    dt: f64,
    omega: f64,
) -> Option<(StageMotion, f64)> {
    let tableau = control.tableau;
    let mut end = None;
    for i in 1..tableau.stages {
        end = Some(state.stage(world, tableau, i, dt)?);
    }
    let error_rate2 = error_rate2(tableau, state, &world.body, (omega, control.tolerance));
    end.map(|end| (end, dt * error_rate2.sqrt() / control.tolerance))
}

/// Squared local error of a rock over the step length (m²/s⁴), of which `allowed_m_s` is allowed.
/// Displacements and stretches are multiplied by the frequency of the stiffest contact (rad/s),
/// spin by the radius.
///
/// On one plane a contact forgets an error, because the weight determines its force. Between
/// wedging faces, as in a gully, friction across the direction of motion holds one face against the
/// other with any force within both cones, and keeps an error as long as both contacts stay closed.
/// Rolling friction depends on these forces; there displacements get a larger weight, so that they
/// are as exact as the forces must be.
pub(crate) fn error_rate2(
    tableau: &Tableau,
    state: &ContactState,
    body: &Body,
    (omega, allowed_m_s): (f64, f64),
) -> f64 {
    let rates = &state.rates;
    let displacement_rate2 = (0..state.histories.len())
        .map(|k| tableau.embedded_difference(rates, |rate| rate.shear[k]).norm_squared())
        .fold(tableau.embedded_difference(rates, |rate| rate.c).norm_squared(), f64::max);
    let (mut factor_rad_s, weight) = (omega, body.gravity.norm());
    if weight > 0.0 && rolls_wedged(state.stage_contacts()) {
        factor_rad_s *= (allowed_m_s * omega / (WEDGED * weight)).max(1.0);
    }
    (displacement_rate2 * factor_rad_s * factor_rad_s)
        .max(tableau.embedded_difference(rates, |rate| rate.v).norm_squared())
        .max(tableau.embedded_difference(rates, |rate| rate.w).norm_squared() * body.radius.powi(2))
}

/// Whether a rock with rolling friction is wedged between faces.
fn rolls_wedged(contacts: &[StageContact]) -> bool {
    contacts.iter().any(|one| one.law.rolling.is_on())
        && contacts
            .iter()
            .enumerate()
            .any(|(k, one)| contacts[..k].iter().any(|other| one.n.dot(&other.n) < WEDGING_COSINE))
}

/// Accepts the step: motion, contact histories, losses. A step changes the state only here; a
/// rejected try changes nothing but scratch space.
pub(crate) fn accept(
    world: &ContactEnvironment,
    tableau: &Tableau,
    state: &mut ContactState,
    (end, dt): (&StageMotion, f64),
    loss: &mut Loss,
) {
    for k in 0..tableau.stages {
        loss.add(&state.rates[k].loss, dt * tableau.work_weight(k));
    }
    let last = tableau.stages - 1;
    let hh = tableau.diagonal * dt;
    state.stored = springs_at_end_j(state, end, hh);
    let (first, later) = state.rates.split_at_mut(last);
    // the last stage's rates are the first ones of the next step; shear rates are turned with their
    // normals
    let next = &mut first[0];
    next.copy_from(&later[0], state.histories.len());
    for history in state.histories.iter_mut() {
        history.closed = false;
    }
    for contact in &state.contacts[..state.contact_count] {
        let history = &mut state.histories[contact.history];
        next.shear[contact.history] =
            transport(next.shear[contact.history], &history.n, &contact.n);
        contact.write_history(contact.stretches(hh), contact.is_closed(&end.v, hh), history);
    }
    state.fresh = !state.merge_lost(world);
    let next = &mut state.rates[0];
    let mut kept = 0;
    for k in 0..state.histories.len() {
        if state.histories[k].closed {
            (next.shear[kept], next.roll[kept]) = (next.shear[k], next.roll[k]);
            kept += 1;
        }
    }
    state.histories.retain(|history| history.closed);
    state.accept_new_contacts(world);
    (state.c, state.v, state.w) = (end.c, end.v, end.w);
    state.update_springs_of_grounds(world);
}
