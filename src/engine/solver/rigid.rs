//! Scheme `rigid`: the limit of stiff springs. Impacts are instantaneous, sustained contact is
//! stepped at velocity level.
//!
//! Friction and rolling friction are impulses bounded by the normal impulse; several contacts are
//! solved by sweeps (projected Gauss–Seidel, after Moreau). The energy that an impulse takes
//! follows from the mean velocity during it, so the energy balance closes to rounding, apart from
//! the correction of penetrations.
//!
//! ```text
//! impact:     all touches of the instant at once, in the limit p_N → ∞ (`impact::throw`)
//! sustained:  v₁ = v₀ + g Δt + Σ (J n + j)/m,    n·v₁ ≥ −max(0, gap/Δt, n·v₀)
//!             J ≥ 0,  |j| ≤ μ J,  |M| ≤ μ_r R J
//!             c₁ = c₀ + Δt (v₀ + v₁)/2
//! ```
//!
//! A surface that the rock approaches exerts no force before it is reached: the step ends there. An
//! impact follows, or, where the approach is too slow to rebound, impulses that hold the rock from
//! there on.
//!
//! Geometry is that of the middle of the step: second order where nothing switches, first order
//! over lift-off and at the transition from sliding to rolling. Compared with springs the duration
//! of an impact is neglected, and the penetration at rest, `m g/p_N`.

mod contact;
mod plane_step;
mod sustained;

use super::contact_state::{ContactEnvironment, ContactState};
use super::impact::{FrozenContact, frozen_impact};
use super::law::capture_m_s;
use super::roughness;
use super::step_control::{Advance, StepError, TRAVEL};
use crate::contact::TOUCH;
use crate::contact::history::ContactHistory;
use crate::contact::{ContactPoint, MAX_CONTACTS};
use crate::rock::Vec3;
use arrayvec::ArrayVec;
pub(super) use contact::{GroundContact, converge, sustained_m_s};

/// Contact points no further away than this still hold the rock (–, relative to R).
pub(crate) const HELD: f64 = 1e-4;
/// Surfaces reached within this distance of each other are struck together (–, relative to R):
/// steps end at about this distance from a surface, and of two walls that a rock rolls between
/// neither is first.
pub(crate) const STRUCK_TOGETHER: f64 = 1e-6;
/// Local error of an impact resolved on its own time scale (–, relative to its speed).
pub(crate) const IMPACT: f64 = 2e-5;
/// A slower approach is neglected (–, relative to `√(g R)`): the rest of it that a step leaves
/// takes energy by friction only at the level of rounding of the ground.
const APPROACHING: f64 = 3e-3;
/// Share of the slowest approach to a facet from which on a rotated rock approaches it (–): the
/// rotation rounds the approach, and after the impact on the facet there is none.
const FACET_SHARE: f64 = 0.5;

/// One impact or one step of at most `h_max` (s), which on one plane may be longer than `longest` (s).
///
/// # Errors
/// [`StepError`] if motion is no longer finite.
/// First impacts of zero duration, where contacts approach fast; else a step of sustained contact.
pub fn advance(
    world: &ContactEnvironment,
    state: &mut ContactState,
    longest: f64,
    h_max: f64,
) -> Result<Advance, StepError> {
    let mut done = Advance { steps: 1, ..Advance::default() };
    let c = state.c;
    state.upcoming_impacts.clear();
    state.update_contact_points_ahead(world, &c);
    if has_impact(world, state) {
        // only contacts closed at this instant take part in the impact
        let mut touches = state.touches.clone();
        touches.retain_impacting(world.body.radius, &state.v, STRUCK_TOGETHER);
        if state.impact_announced {
            impact(world, state, &touches, &mut done);
        } else {
            // a further impact within an episode: the driver is told before it happens, as for the
            // first
            announce_impact(world, state, &touches);
            done.steps = 0;
        }
        state.impact_announced = !state.impact_announced;
    } else {
        state.impact_announced = false;
        sustained::capture(world, state, &mut done);
        let speed = state.v.norm().max(f64::MIN_POSITIVE);
        let usual = longest.min(TRAVEL * world.body.radius / speed);
        if !state.slide_on_plane(world, (usual, longest), h_max, &mut done) {
            sustained::step(world, state, usual.min(h_max), &mut done);
        }
    }
    if state.is_finite() { Ok(done) } else { Err(StepError::NotFinite) }
}

/// Whether a contact point found last approaches faster than the capture speed, or as fast as a
/// facet requires.
fn has_impact(world: &ContactEnvironment, state: &ContactState) -> bool {
    let reach = world.body.radius * (1.0 + TOUCH);
    let is_tilted = state.facets.is_tilted();
    let approaches = |touch: &ContactPoint| {
        let approach = -touch.normal.dot(&state.v);
        is_fast(world, touch, &state.v)
            || is_tilted && approach >= FACET_SHARE * roughness::least_m_s(world)
    };
    state.touches.iter().any(|touch| touch.distance_m < reach && approaches(touch))
}

/// Whether a rock with velocity `v` approaches a contact point too fast to be captured.
pub(super) fn is_fast(world: &ContactEnvironment, touch: &ContactPoint, v: &Vec3) -> bool {
    -touch.normal.dot(v) >= capture_m_s(world.law(touch.triangle))
}

/// Whether a rock with velocity `v` approaches a contact point so fast that the time of contact
/// matters: a step that began before would hold the rock on both sides of a fold at once, with
/// friction.
fn is_approaching(world: &ContactEnvironment, touch: &ContactPoint, v: &Vec3) -> bool {
    -touch.normal.dot(v) >= APPROACHING * world.body.fall_speed_m_s()
}

/// Announces the contacts of the next impact.
fn announce_impact(world: &ContactEnvironment, state: &mut ContactState, touches: &[ContactPoint]) {
    let mut taken = 0;
    for touch in touches {
        let captured = !is_fast(world, touch, &state.v);
        let history = state.histories.find(touch, touches, taken, || captured);
        taken |= 1 << history;
        let history = &mut state.histories[history];
        history.announced = true;
        if !captured {
            let struck = ContactHistory { announced: false, captured, ..*history };
            state.upcoming_impacts.push(struck);
        }
    }
}

/// Contact points of a rock with velocity `v` as contacts of one impact: those too slow to rebound
/// take part without restitution.
pub(super) fn frozen<'w>(
    world: &'w ContactEnvironment,
    touches: &[ContactPoint],
    v: &Vec3,
) -> ArrayVec<FrozenContact<'w>, MAX_CONTACTS> {
    let contact = |touch: &ContactPoint| FrozenContact {
        normal: touch.normal,
        law: world.law(touch.triangle),
        stiffness_scale: touch.gain2,
        captured: !is_fast(world, touch, v),
        ..FrozenContact::none()
    };
    touches.iter().map(contact).collect()
}

/// The impact: the limit of stiff springs of the same law, with the geometry of the instant ([`super::impact`]).
fn impact(
    world: &ContactEnvironment,
    state: &mut ContactState,
    touches: &[ContactPoint],
    done: &mut Advance,
) {
    let (v, w) = (state.v, state.w);
    let thrown = frozen_impact(&world.body, &frozen(world, touches, &v), (&v, &w), IMPACT);
    (state.v, state.w) = (thrown.velocity_m_s, thrown.spin_rad_s);
    for (loss, touch) in thrown.loss.iter().zip(touches) {
        state.stem_load.book((world, touch.triangle), loss, &mut done.loss);
    }
    done.steps = u64::from(thrown.effort.steps).max(1);
    done.rejected = u64::from(thrown.effort.rejected);
    update_histories(world, state, true);
}

/// Updates the history of every contact point that still `holds` the rock, so that impacts are
/// counted and rest is detected.
pub(crate) fn update_histories(world: &ContactEnvironment, state: &mut ContactState, holds: bool) {
    let (c, v) = (state.c, state.v);
    state.update_contact_points_ahead(world, &c);
    let touches = state.touches.nearer(world.body.radius * (1.0 + HELD));
    for history in state.histories.iter_mut() {
        history.closed = false;
    }
    let mut taken = 0;
    for touch in touches.iter() {
        let k = state.histories.find(touch, &touches, taken, || true);
        taken |= 1 << k;
        let history = &mut state.histories[k];
        (history.feature, history.n) = (touch.feature, touch.normal);
        (history.triangle, history.springs_of) = (touch.triangle, touch.triangle);
        // a contact that separates faster than the capture speed is open
        history.closed = holds && touch.normal.dot(&v) < capture_m_s(world.law(touch.triangle));
        history.slides = world.body.slip(&history.n, &v, &state.w).norm() > 1e-6 * (1.0 + v.norm());
    }
    state.histories.retain(|history| history.closed);
}
