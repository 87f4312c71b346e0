//! Scheme `rigid`: the limit of stiff springs. Impacts take no time, sustained contact is stepped in velocities.
//!
//! Friction and rolling friction are impulses bounded by the normal impulse; several contacts are swept
//! (projected Gauss–Seidel, after Moreau). What each impulse takes is booked by the mean velocity it acts on, so
//! the energy balance closes to rounding but for the push-out of penetrations.
//!
//! ```text
//! impact:     all touches of the instant at once, in the limit p_N → ∞ (`impact::throw`)
//! sustained:  v₁ = v₀ + g Δt + Σ (J n + j)/m,    n·v₁ ≥ −max(0, gap/Δt, n·v₀)
//!             J ≥ 0,  |j| ≤ μ J,  |M| ≤ μ_r R J
//!             c₁ = c₀ + Δt (v₀ + v₁)/2
//! ```
//!
//! What the rock comes to bears nothing before it is met: the step ends there, and an impact follows, or, slower than a blow rebounds, the impulses
//! that hold it from there on.
//! Geometry is that of the middle of the step: second order where nothing switches, first order
//! over lift-off and sliding into rolling. What is lost against springs: the time of an impact, and
//! the penetration at rest, `m g/p_N`.

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
use crate::contact::{ContactPoint, MOST};
use crate::rock::Vec3;
use arrayvec::ArrayVec;
pub(super) use contact::{GroundContact, settle, sustained_m_s};
pub(super) use sustained::way_out;

/// Touches no further away than this still hold the rock (–, relative to R).
pub(crate) const HELD: f64 = 1e-4;
/// What a rock comes to within this when it strikes something else it strikes with it (–, relative to R): steps end so far from what they
/// come to, and of two walls that a rock rolls between neither is first.
pub(crate) const STRUCK_TOGETHER: f64 = 1e-6;
/// Local error of an impact followed in its own time (–, relative to its speed).
pub(crate) const IMPACT: f64 = 2e-5;
/// An approach slower than this is none (–, relative to `√(g R)`): what a step leaves of it rubs off no more than rounding of the ground.
const COMING: f64 = 3e-3;
/// Share of the slowest approach to a facet from which on a turned rock comes to it (–): turning rounds the approach, and once
/// the facet is struck there is none.
const ONTO_FACET: f64 = 0.5;

/// One impact or one step of at most `h_max` (s), which on one plane may be longer than `longest` (s).
///
/// # Errors
/// [`StepError`] if motion is no longer finite.
/// Order: first what comes in fast, as an impact of no duration; else a step of sustained contact.
pub fn advance(
    world: &ContactEnvironment,
    state: &mut ContactState,
    longest: f64,
    h_max: f64,
) -> Result<Advance, StepError> {
    let mut done = Advance { steps: 1, ..Advance::default() };
    let c = state.c;
    state.struck.clear();
    state.look_ahead_again(world, &c);
    if hits(world, state) {
        // only what touches at this instant takes part in the impact
        let mut touches = state.touches.clone();
        touches.keep_struck(world.body.radius, &state.v, STRUCK_TOGETHER);
        if state.is_struck {
            impact(world, state, &touches, &mut done);
        } else {
            // Strikes anew within an episode: the driver hears of it before it happens, as it does of the first.
            strike(world, state, &touches);
            done.steps = 0;
        }
        state.is_struck = !state.is_struck;
    } else {
        state.is_struck = false;
        sustained::meet(world, state, &mut done);
        let speed = state.v.norm().max(f64::MIN_POSITIVE);
        let usual = longest.min(TRAVEL * world.body.radius / speed);
        if !state.slide_on_plane(world, (usual, longest), h_max, &mut done) {
            sustained::step(world, state, usual.min(h_max), &mut done);
        }
    }
    if state.is_finite() { Ok(done) } else { Err(StepError::NotFinite) }
}

/// Whether a touch of the last look comes in faster than the capture speed, or as fast as to a facet that is met.
fn hits(world: &ContactEnvironment, state: &ContactState) -> bool {
    let reach = world.body.radius * (1.0 + TOUCH);
    let meets = state.facets.is_any_met();
    let comes = |touch: &ContactPoint| {
        let approach = -touch.normal.dot(&state.v);
        is_fast(world, touch, &state.v)
            || meets && approach >= ONTO_FACET * roughness::least_m_s(world)
    };
    state.touches.iter().any(|touch| touch.distance_m < reach && comes(touch))
}

/// Whether a rock with velocity `v` hits a touch too fast to be captured.
pub(super) fn is_fast(world: &ContactEnvironment, touch: &ContactPoint, v: &Vec3) -> bool {
    -touch.normal.dot(v) >= capture_m_s(world.law(touch.triangle))
}

/// Whether a rock with velocity `v` comes to a touch so fast that it matters when it meets it: a step that began before would hold it on both
/// sides of a fold at once, and rub.
fn is_coming(world: &ContactEnvironment, touch: &ContactPoint, v: &Vec3) -> bool {
    -touch.normal.dot(v) >= COMING * world.body.fall_speed_m_s()
}

/// Notes the contacts that are about to be struck.
fn strike(world: &ContactEnvironment, state: &mut ContactState, touches: &[ContactPoint]) {
    let mut taken = 0;
    for touch in touches {
        let captured = !is_fast(world, touch, &state.v);
        let history = state.histories.find(touch, touches, taken, || captured);
        taken |= 1 << history;
        let history = &mut state.histories[history];
        history.announced = true;
        if !captured {
            let struck = ContactHistory { announced: false, captured, ..*history };
            state.struck.push(struck);
        }
    }
}

/// The touches of a rock with velocity `v` as contacts of one impact: those too slow to rebound take part and give nothing back.
pub(super) fn frozen<'w>(
    world: &'w ContactEnvironment,
    touches: &[ContactPoint],
    v: &Vec3,
) -> ArrayVec<FrozenContact<'w>, MOST> {
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
    remember(world, state, true);
}

/// Keeps a memory for every touch that still `holds` the rock, so that impacts are counted and rest is seen.
pub(crate) fn remember(world: &ContactEnvironment, state: &mut ContactState, holds: bool) {
    let (c, v) = (state.c, state.v);
    state.look_ahead_again(world, &c);
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
        // A touch that separates faster than the capture speed lets go.
        history.closed = holds && touch.normal.dot(&v) < capture_m_s(world.law(touch.triangle));
        history.slides = world.body.slip(&history.n, &v, &state.w).norm() > 1e-6 * (1.0 + v.norm());
    }
    state.histories.retain(|history| history.closed);
}
