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
//! Geometry is that of the middle of the step: second order where nothing switches, first order
//! over lift-off and sliding into rolling. What is lost against springs: the time of an impact, and
//! the penetration at rest, `m g/p_N`.

mod plane_step;

use super::body::Body;
use super::contact_state::{ContactEnvironment, ContactState};
use super::friction_rolling::{Answers, ContactFrame, Pair, SlipState};
use super::impact::{FrozenContact, throw};
use super::law::capture_m_s;
use super::loss::Loss;
use super::roughness;
use super::step_control::{Advance, StepError, TRAVEL};
use crate::contact::TOUCH;
use crate::contact::history::ContactHistory;
use crate::contact::{ContactPoint, ContactPoints, MOST};
use crate::ground::Law;
use crate::rock::Vec3;

/// Touches no further away than this still hold the rock (–, relative to R).
pub(crate) const HELD: f64 = 1e-4;
/// Local error of an impact followed in its own time (–, relative to its speed).
pub(crate) const IMPACT: f64 = 2e-5;
/// Share of the slowest approach to a facet from which on a turned rock comes to it (–): turning rounds the approach, and once
/// the facet is struck there is none.
const ONTO_FACET: f64 = 0.5;
/// Sweeps over the contacts, at most.
pub(super) const SWEEPS: u32 = 100;
/// Change of an impulse, relative to the largest, below which the sweeps have settled (–).
pub(super) const SETTLED: f64 = 1e-12;

/// One contact and its impulses.
#[derive(Debug, Clone, Copy)]
struct ImpulsiveContact<'w> {
    n: Vec3,
    law: &'w Law,
    triangle: u32,
    /// Normal speed wanted after the impulse (m/s).
    target: f64,
    /// Normal impulse (N s), ≥ 0.
    normal_force: f64,
    /// Impulse along the surface (N s).
    shear_force: Vec3,
    /// Rolling impulse (N m s).
    turn: Vec3,
    /// Which of the two are at their caps, as far as is known.
    mode: SlipState,
}

impl ImpulsiveContact<'_> {
    const NONE: Self = Self {
        n: Vec3::new(0.0, 0.0, 0.0),
        law: &Law::NONE,
        triangle: 0,
        target: 0.0,
        normal_force: 0.0,
        shear_force: Vec3::new(0.0, 0.0, 0.0),
        turn: Vec3::new(0.0, 0.0, 0.0),
        mode: SlipState::Stick,
    };

    /// Impulses for velocity `v` and spin `w` without this contact's own.
    /// `J = max(0, m (target − n·v))`: exact for one contact; for several the sweeps repeat it.
    fn solve(&mut self, body: &Body, v: &Vec3, w: &Vec3) {
        let m = body.mass;
        self.normal_force = (m * (self.target - self.n.dot(v))).max(0.0);
        if self.normal_force <= 0.0 {
            (self.shear_force, self.turn) = (Vec3::zeros(), Vec3::zeros());
            return;
        }
        let caps = self.law.limits().caps(self.normal_force);
        let frame = ContactFrame::of(&self.n);
        (self.shear_force, self.turn) = rub(body, &frame, caps, (v, w), &mut self.mode);
    }

    /// Change of velocity and spin.
    /// `Δv = (J n + j)/m`, `Δω = (M − R n × j)/I`: here `j` and `M` act on the rock.
    fn effect(&self, body: &Body) -> (Vec3, Vec3) {
        let dv = (self.n * self.normal_force + self.shear_force) / body.mass;
        let dw = (self.turn - self.n.cross(&self.shear_force) * body.radius) / body.inertia;
        (dv, dw)
    }

    /// Energy that the impulses take (J), at mean velocity `v` and spin `w`.
    ///
    /// An impulse works with the mean of the velocities before and after: `J·(v₀ + v₁)/2` is the
    /// change of kinetic energy exactly.
    fn loss(&self, body: &Body, v: &Vec3, w: &Vec3) -> Loss {
        let friction = -self.shear_force.dot(&body.slip(&self.n, v, w));
        Loss {
            friction,
            damping: -self.normal_force * self.n.dot(v),
            rolling: -self.turn.dot(w),
            trees: 0.0,
        }
    }
}

/// Impulses along the surface with the frame `frame` (N s) and of rolling (N m s) on a rock with velocity `v` and spin `w`
/// without them; `caps` are the largest of both. The mode found before is tried first.
///
/// The stick solution: `2/7 m` is the contact point's mass along the surface, `I ω` stops all
/// rotation; `Pair` couples both and cuts them.
pub(crate) fn rub(
    body: &Body,
    frame: &ContactFrame,
    caps: (f64, f64),
    (v, w): (&Vec3, &Vec3),
    mode: &mut SlipState,
) -> (Vec3, Vec3) {
    let pair = Pair {
        answers: &Answers::rigid(body.radius),
        a: frame.along(&(body.slip(&frame.n, v, w) * (body.mass_along()))),
        d: frame.local(&(w * body.inertia)),
        caps,
    };
    let (shear_force, turn) = pair.solve(mode);
    (-frame.out_along(shear_force), -frame.out_local(turn))
}

/// The contacts of one impact or step.
/// On the stack, as many as a rock keeps.
struct Blows<'w> {
    list: [ImpulsiveContact<'w>; MOST],
    len: usize,
}

impl<'w> Blows<'w> {
    /// One blow for each touch of the last look, with the target that `target` names for it.
    fn of(
        world: &'w ContactEnvironment,
        state: &ContactState,
        target: impl Fn(&ImpulsiveContact, f64) -> f64,
    ) -> Self {
        let mut blows = Self { list: [ImpulsiveContact::NONE; MOST], len: state.touches.len() };
        for (blow, touch) in blows.list.iter_mut().zip(state.touches.iter()) {
            (blow.n, blow.triangle, blow.law) =
                (touch.normal, touch.triangle, world.law(touch.triangle));
            blow.target = target(blow, touch.distance_m);
        }
        blows
    }

    /// Sweeps until the impulses settle; returns velocity and spin after them.
    /// Projected Gauss–Seidel; for one contact the first pass is exact.
    fn solve(&mut self, body: &Body, v: Vec3, w: Vec3, sweeps: &mut u64) -> (Vec3, Vec3) {
        let (mut v, mut w) = (v, w);
        for _ in 0..SWEEPS {
            *sweeps += 1;
            let (mut change, mut scale) = (0.0f64, f64::MIN_POSITIVE);
            for blow in &mut self.list[..self.len] {
                let (dv, dw) = blow.effect(body);
                let (vf, wf, before) = (v - dv, w - dw, (blow.normal_force, blow.shear_force));
                blow.solve(body, &vf, &wf);
                let (dv, dw) = blow.effect(body);
                (v, w) = (vf + dv, wf + dw);
                change = change
                    .max((blow.normal_force - before.0).abs())
                    .max((blow.shear_force - before.1).norm());
                scale = scale.max(blow.normal_force);
            }
            if self.len <= 1 || change <= SETTLED * scale {
                break;
            }
        }
        (v, w)
    }

    /// Takes over velocity and spin after the impulses and books their losses.
    fn apply(
        &self,
        world: &ContactEnvironment,
        state: &mut ContactState,
        (v, w): (Vec3, Vec3),
        loss: &mut Loss,
    ) {
        let (mean_v, mean_w) = (0.5 * (state.v + v), 0.5 * (state.w + w));
        for blow in &self.list[..self.len] {
            loss.add(&blow.loss(&world.body, &mean_v, &mean_w).on(world, blow.triangle), 1.0);
        }
        (state.v, state.w) = (v, w);
    }
}

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
        state.look(world, &c, world.body.radius * (1.0 + TOUCH));
        if state.is_struck {
            impact(world, state, &mut done);
        } else {
            // Strikes anew within an episode: the driver hears of it before it happens, as it does of the first.
            strike(world, state);
            done.steps = 0;
        }
        state.is_struck = !state.is_struck;
    } else {
        state.is_struck = false;
        let speed = state.v.norm().max(f64::MIN_POSITIVE);
        let usual = longest.min(TRAVEL * world.body.radius / speed);
        if !state.slide_on_plane(world, (usual, longest), h_max, &mut done) {
            step(world, state, usual.min(h_max), &mut done);
        }
    }
    let finite = state.c.iter().chain(state.v.iter()).chain(state.w.iter()).all(|x| x.is_finite());
    if finite { Ok(done) } else { Err(StepError::NotFinite) }
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

/// Notes the contacts of the last look that are about to be struck.
fn strike(world: &ContactEnvironment, state: &mut ContactState) {
    let touches = state.touches;
    let mut taken = 0;
    for touch in touches.iter() {
        let captured = !is_fast(world, touch, &state.v);
        let history = state.histories.find(touch, &touches, taken, || captured);
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
    touches: &ContactPoints,
    v: &Vec3,
) -> [FrozenContact<'w>; MOST] {
    let mut struck = [FrozenContact::none(); MOST];
    for (struck, touch) in struck.iter_mut().zip(touches.iter()) {
        *struck = FrozenContact {
            normal: touch.normal,
            law: world.law(touch.triangle),
            stiffness_scale: touch.gain2,
            captured: !is_fast(world, touch, v),
        };
    }
    struck
}

/// The impact: the limit of stiff springs of the same law, with the geometry of the instant ([`super::impact`]).
fn impact(world: &ContactEnvironment, state: &mut ContactState, done: &mut Advance) {
    let (v, w, touches) = (state.v, state.w, state.touches);
    let struck = frozen(world, &touches, &v);
    let thrown = throw(&world.body, &struck[..touches.len()], (&v, &w), IMPACT);
    (state.v, state.w) = (thrown.velocity_m_s, thrown.spin_rad_s);
    for (loss, touch) in thrown.loss.iter().zip(touches.iter()) {
        done.loss.add(&loss.on(world, touch.triangle), 1.0);
    }
    done.steps = u64::from(thrown.effort.steps).max(1);
    done.rejected = u64::from(thrown.effort.rejected);
    remember(world, state, |_| true);
}

/// One step of sustained contact.
///
/// A step may slide over an edge: half of the turn of the normal lies before its middle and half
/// after it.
fn step(world: &ContactEnvironment, state: &mut ContactState, longest: f64, done: &mut Advance) {
    let body = &world.body;
    let r = body.radius;
    let (c, v, w) = (state.c, state.v, state.w);
    let dt = closing(world, state, longest);
    // contacts are those of the middle of the step, looked for there
    let middle = c + v * (0.5 * dt);
    state.look_ahead(world, &middle);
    let mut blows = Blows::of(world, state, |blow, distance| {
        let gap = distance - r - blow.n.dot(&(middle - c));
        // A push never works on the rock: over an edge, half of the turn is before the middle and half after it.
        -(gap / dt).max(blow.n.dot(&v)).max(0.0)
    });
    let after = blows.solve(body, v + body.gravity * dt, w, &mut state.sweeps);
    blows.apply(world, state, after, &mut done.loss);
    // mean of both velocities: the parabola under weight alone is exact
    state.c = c + (v + state.v) * (0.5 * dt);
    done.dt = dt;
    // without any impulse the rock is free, and the next leap takes over
    let pushed = blows.list[..blows.len].iter().any(|blow| blow.normal_force > 0.0);
    push_out(world, state);
    remember(world, state, |_| pushed);
}

/// Cuts a step where a gap to a touch of the last look closes faster than the capture speed: the impact comes at the end
/// of the step.
fn closing(world: &ContactEnvironment, state: &ContactState, dt: f64) -> f64 {
    let r = world.body.radius;
    state.touches.iter().filter(|touch| is_fast(world, touch, &state.v)).fold(dt, |dt, touch| {
        let gap = touch.distance_m - r;
        if gap > TOUCH * r { dt.min(gap / -touch.normal.dot(&state.v)) } else { dt }
    })
}

/// Moves a rock that got into the mesh out along the normals; the height it gains is paid by its motion.
///
/// The depth is the error of the step. Lifting the rock out for nothing would create energy at
/// every step of a slide over rough ground.
fn push_out(world: &ContactEnvironment, state: &mut ContactState) {
    let (r, before) = (world.body.radius, state.c);
    for _ in 0..4 {
        let c = state.c;
        state.look_ahead_again(world, &c);
        // each normal adds what the ones before it have not moved out already
        let out = state.touches.iter().fold(Vec3::zeros(), |sum, touch| {
            let missing = r - touch.distance_m - sum.dot(&touch.normal);
            sum + touch.normal * missing.max(0.0)
        });
        if out.norm() <= TOUCH * r {
            break;
        }
        state.c += out;
    }
    let lifted = -world.body.mass * world.body.gravity.dot(&(state.c - before));
    let motion = state.motion_j(&world.body);
    if lifted > 0.0 && motion > 0.0 {
        let kept = ((motion - lifted) / motion).max(0.0).sqrt();
        state.v *= kept;
        state.w *= kept;
    }
}

/// Keeps a memory for every touch that still holds the rock, so that impacts are counted and rest is seen.
pub(crate) fn remember(
    world: &ContactEnvironment,
    state: &mut ContactState,
    holds: impl Fn(&Vec3) -> bool,
) {
    let (c, v) = (state.c, state.v);
    state.look_ahead_again(world, &c);
    let mut touches = state.touches;
    touches.keep_nearer(world.body.radius * (1.0 + HELD));
    for history in state.histories.iter_mut() {
        history.closed = false;
    }
    let mut taken = 0;
    for touch in touches.iter() {
        let k = state.histories.find(touch, &touches, taken, || true);
        taken |= 1 << k;
        let history = &mut state.histories[k];
        (history.feature, history.triangle, history.n) =
            (touch.feature, touch.triangle, touch.normal);
        // A touch that separates faster than the capture speed lets go.
        history.closed = holds(&v) && touch.normal.dot(&v) < capture_m_s(world.law(touch.triangle));
        history.slides = world.body.slip(&history.n, &v, &state.w).norm() > 1e-6 * (1.0 + v.norm());
    }
    state.histories.retain(|history| history.closed);
}
