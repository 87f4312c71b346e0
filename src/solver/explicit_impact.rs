//! An impact among any features, followed in its own time.
//!
//! While a contact rebounds it lasts about `π/ω`, `ω = √(p_N/m)`: in units of `1/ω` nothing is stiff, and an explicit pair of
//! order five is the cheapest way to follow it (Dormand and Prince 1980). The error is controlled relative to the speed of the
//! impact, so that restitution is as right for a pebble as for a block. Geometry is that of every stage; force is continuous
//! wherever patches meet (`contact::patch`), and where a further contact begins the step is cut by its error.

use super::contact_state::{ContactEnvironment, ContactState, Loss, Rate, TOUCH, longest_step};
use super::stage::End;
use super::step_control::{Advance, StepError, TRAVEL};
use crate::contact::history::{HISTORIES, carry};
use crate::math;
use crate::rock::Vec3;

/// Stages of the pair; the last is the first of the next step.
const STAGES: usize = 7;

/// Coefficients of the stages; the last row are the weights of fifth order.
const A: [[f64; 6]; STAGES] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Weights of fifth order minus those of fourth.
const ERROR: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// First step of an impact (rad of its oscillation).
const FIRST: f64 = 0.3;
/// Longest step (rad): where friction begins to slip or to hold within a longer one, its error estimate may not see it.
const LONGEST: f64 = 0.4;
/// Local error allowed where patches meet and part, relative to that on a plane (–): the estimate sees too little of a kink.
const KINKED: f64 = 0.1;
/// Largest error of energy that is balanced (–, relative to motion).
const BALANCED: f64 = 0.1;
/// Shortest step (rad): a contact that begins within a step is met this exactly.
const SHORTEST: f64 = 1e-9;
/// Safety factor of the step controller (–).
const SAFETY: f64 = 0.9;
/// Most that a step shrinks or grows at once (–).
const RATIO: (f64, f64) = (0.2, 4.0);

/// An impact is over after so long (rad), or goes on as lasting contact.
const LASTS: f64 = 20.0;

/// What an impact needs besides the rock's state.
#[derive(Debug)]
pub(crate) struct ExplicitImpact {
    rates: [Rate; STAGES],
    /// Whether the first rate belongs to the present state.
    fresh: bool,
    /// The step to try next (s), if there is one.
    h: f64,
    /// Fastest approach of the contacts (m/s).
    speed_m_s: f64,
    /// How much longer it is followed in its own time (rad).
    left: f64,
    /// Power that goes into the normal springs at each stage (W) …
    stores: [Loss; STAGES],
    /// … and the energy in them at the present state (J), if all of them push.
    stored: Option<Loss>,
    /// Energy that the steps have gained (J).
    gained: f64,
}

impl Default for ExplicitImpact {
    fn default() -> Self {
        Self {
            rates: [Rate::NONE; STAGES],
            fresh: false,
            h: 0.0,
            speed_m_s: 0.0,
            left: 0.0,
            stores: [Loss::default(); STAGES],
            stored: None,
            gained: 0.0,
        }
    }
}

impl ExplicitImpact {
    /// Forgets the impact before.
    pub(crate) fn forget(&mut self) {
        (self.fresh, self.speed_m_s, self.left) = (false, 0.0, 0.0);
    }

    /// The rock has been given another velocity.
    pub(crate) fn restart(&mut self) {
        self.fresh = false;
    }

    /// A contact begins at `speed_m_s` that may rebound; `slowest` is the speed from which on it is followed here.
    pub(crate) fn meet(&mut self, speed_m_s: f64, slowest: f64) {
        if speed_m_s <= slowest {
            return;
        }
        if self.left <= 0.0 {
            (self.fresh, self.h, self.gained) = (false, 0.0, 0.0);
        }
        (self.speed_m_s, self.left) = (self.speed_m_s.max(speed_m_s), LASTS);
    }
}

/// What the contacts of one stage do to the rock.
#[derive(Default)]
struct Motions {
    v: Vec3,
    w: Vec3,
    loss: Loss,
    stores: Loss,
}

impl ContactState {
    /// Whether an impact is going on.
    pub(crate) fn is_rebounding(&self) -> bool {
        self.impact.left > 0.0 && self.histories.iter().any(|history| !history.captured)
    }

    /// One accepted step of an impact, of at most `h_max` (s), in contacts of at most `omega` (rad/s); `tolerance` is the local
    /// error allowed relative to the speed of the impact.
    ///
    /// # Errors
    /// [`StepError`] if the motion is no longer finite.
    pub(crate) fn step_impact(
        &mut self,
        world: &ContactEnvironment,
        (omega, tolerance): (f64, f64),
        h_max: f64,
        done: &mut Advance,
    ) -> Result<(), StepError> {
        if !self.impact.fresh {
            let now = End { c: self.c, v: self.v, w: self.w };
            self.rate_at(world, &now, 0, 0.0);
            self.impact.stored = self.pressed_springs_j(world);
            self.impact.fresh = true;
        }
        if self.impact.h == 0.0 {
            self.impact.h = FIRST / omega;
        }
        let c = self.c;
        self.know(world, &c);
        let way = TRAVEL * world.body.radius;
        let limit = longest_step(&world.body, self.v.norm(), way).min(LONGEST / omega);
        let known = self.histories.len();
        loop {
            self.histories.truncate(known);
            let wished = self.impact.h.min(limit);
            let dt = wished.min(h_max);
            let (end, error) = self.try_impact(world, omega, dt);
            let error = error / (KINKED * tolerance * self.impact.speed_m_s);
            if error <= 1.0 || dt * omega < SHORTEST {
                if !error.is_finite() {
                    return Err(StepError::NotFinite);
                }
                let least = if dt < wished { wished } else { 0.0 };
                self.impact.h = (dt * growth(error)).max(least);
                self.impact.left -= omega * dt;
                self.accept_impact(world, &end, dt, done);
                return Ok(());
            }
            done.rejected += 1;
            self.impact.h = dt * growth(error);
        }
    }

    fn try_impact(&mut self, world: &ContactEnvironment, omega: f64, dt: f64) -> (End, f64) {
        let mut at = End { c: self.c, v: self.v, w: self.w };
        for i in 1..STAGES {
            at = self.explicit_base(i, dt);
            self.rate_at(world, &at, i, dt);
        }
        let (mut off, mut stretch2) = ([Vec3::zeros(); 3], 0.0f64);
        for (rate, weight) in self.impact.rates.iter().zip(ERROR) {
            off[0] += rate.c * weight;
            off[1] += rate.v * weight;
            off[2] += rate.w * weight;
        }
        // A spring that nothing presses on any more holds nothing: how it relaxes does not matter.
        for contact in
            self.contacts[..self.contact_count].iter().filter(|contact| contact.normal_force > 0.0)
        {
            let (k, stages) = (contact.history, self.impact.rates.iter().zip(ERROR));
            let drift = stages.fold(Vec3::zeros(), |sum, (rate, by)| sum + rate.shear[k] * by);
            stretch2 = stretch2.max(drift.norm_squared());
        }
        let worst2 = (off[0].norm_squared().max(stretch2) * omega * omega)
            .max(off[1].norm_squared())
            .max(off[2].norm_squared() * world.body.radius.powi(2));
        (at, dt * worst2.sqrt())
    }

    fn explicit_base(&self, i: usize, dt: f64) -> End {
        let mut at = End { c: self.c, v: self.v, w: self.w };
        for (rate, a) in self.impact.rates.iter().zip(A[i]) {
            at.c += rate.c * (dt * a);
            at.v += rate.v * (dt * a);
            at.w += rate.w * (dt * a);
        }
        at
    }

    /// Rates of stage `i` at a state, with the springs as they are there.
    fn rate_at(&mut self, world: &ContactEnvironment, at: &End, i: usize, dt: f64) {
        let body = &world.body;
        self.look(world, &at.c, body.radius * (1.0 + TOUCH));
        let mut total = Motions { v: body.gravity, ..Motions::default() };
        self.impact.rates[i].clear(HISTORIES.min(self.histories.len() + self.touches.len()));
        let mut taken = 0;
        self.contact_count = self.touches.len();
        for k in 0..self.touches.len() {
            let before = self.histories.len();
            let history = self.history_of(world, k, taken, &at.v);
            taken |= 1 << history;
            if history >= before {
                for rate in &mut self.impact.rates {
                    (rate.shear[history], rate.roll[history]) = (Vec3::zeros(), Vec3::zeros());
                }
            }
            let (mut shear, mut roll) =
                (self.histories[history].shear, self.histories[history].roll);
            for (rate, a) in self.impact.rates[..i].iter().zip(A[i]) {
                shear += rate.shear[history] * (dt * a);
                roll += rate.roll[history] * (dt * a);
            }
            let mut contact = self.contact_of(world, k, history);
            let back = self.histories[history].n;
            (contact.shear, contact.roll) = (carry(shear, &back, &contact.n), roll);
            contact.penetration = (body.radius - self.touches[k].distance_m).max(0.0);
            let (shear_rate, roll_rate) = contact.act_now(world, &at.v, &at.w);
            total.v += (contact.n * contact.normal_force - contact.shear_force) / body.mass;
            total.w += (contact.n.cross(&contact.shear_force) * body.radius
                - contact.rolling_moment)
                / body.inertia;
            let rate = &mut self.impact.rates[i];
            (rate.shear[history], rate.roll[history]) =
                (carry(shear_rate, &contact.n, &back), roll_rate);
            total.loss.add(&contact.loss(world, &at.v, &at.w, &shear_rate), 1.0);
            let stores = -contact.law.p_n * contact.penetration * contact.n.dot(&at.v);
            total.stores.add(&normal_spring(stores).on(world, contact.triangle), 1.0);
            self.contacts[k] = contact;
        }
        let rate = &mut self.impact.rates[i];
        (rate.c, rate.v, rate.w, rate.loss) = (at.v, total.v, total.w, total.loss);
        self.impact.stores[i] = total.stores;
    }

    /// Energy in the normal springs of the last stage (J), if all of them push.
    fn pressed_springs_j(&self, world: &ContactEnvironment) -> Option<Loss> {
        let contacts = &self.contacts[..self.contact_count];
        if contacts.is_empty() || contacts.iter().any(|contact| contact.normal_force <= 0.0) {
            return None;
        }
        let mut stored = Loss::default();
        for contact in contacts {
            let joule = 0.5 * contact.law.p_n * contact.penetration * contact.penetration;
            stored.add(&normal_spring(joule).on(world, contact.triangle), 1.0);
        }
        Some(stored)
    }

    /// Takes over the step's end: motion, memories, losses. The last stage was there.
    fn accept_impact(
        &mut self,
        world: &ContactEnvironment,
        end: &End,
        dt: f64,
        done: &mut Advance,
    ) {
        let body = &world.body;
        let before = self.motion_j(body);
        let mut loss = Loss::default();
        for (rate, weight) in self.impact.rates.iter().zip(A[STAGES - 1]) {
            loss.add(&rate.loss, dt * weight);
        }
        // Where springs push from the step's start to its end, what they store is known exactly.
        let stored = self.pressed_springs_j(world);
        if let (Some(before), Some(after)) = (self.impact.stored, stored) {
            for (stores, weight) in self.impact.stores.iter().zip(A[STAGES - 1]) {
                loss.add(stores, -dt * weight);
            }
            loss.add(&after, 1.0);
            loss.add(&before, -1.0);
        }
        self.impact.stored = stored;
        let lifted = -body.mass * body.gravity.dot(&(end.c - self.c));
        (self.c, self.v, self.w) = (end.c, end.v, end.w);
        self.remember_contacts();
        // what the springs store is counted among the losses until they give it back
        self.impact.gained += self.motion_j(body) + lifted + loss.sum() - before;
        self.keep_closed(world);
        self.fresh = false;
        if self.is_free() || self.impact.left <= 0.0 {
            self.balance(world);
        }
        done.loss.add(&loss, 1.0);
        done.dt += dt;
        done.steps += 1;
    }

    /// Gives motion back what the steps of the impact have lost by themselves, or takes what they have gained: what is left of
    /// the energy is what came in less what the contacts took.
    fn balance(&mut self, world: &ContactEnvironment) {
        let (gained, motion) = (self.impact.gained, self.motion_j(&world.body));
        if gained.abs() < BALANCED * motion {
            let kept = (1.0 - gained / motion).sqrt();
            self.v *= kept;
            self.w *= kept;
        }
        (self.impact.gained, self.impact.left) = (0.0, 0.0);
    }

    /// Writes the last stage's contacts into their memories.
    fn remember_contacts(&mut self) {
        for history in self.histories.iter_mut() {
            history.closed = false;
        }
        for contact in &self.contacts[..self.contact_count] {
            let history = &mut self.histories[contact.history];
            let last = &mut self.impact.rates[STAGES - 1];
            last.shear[contact.history] =
                carry(last.shear[contact.history], &history.n, &contact.n);
            contact.remember(
                (contact.shear, contact.roll),
                contact.normal_force > 0.0 || contact.penetration > 0.0,
                history,
            );
        }
    }

    /// Forgets contacts that have opened and makes the last rate the first of the next step.
    fn keep_closed(&mut self, world: &ContactEnvironment) {
        let merged = self.merge_lost(world);
        let (first, last) = self.impact.rates.split_at_mut(STAGES - 1);
        let (next, last) = (&mut first[0], &last[0]);
        self.impact.stores[0] = self.impact.stores[STAGES - 1];
        (next.c, next.v, next.w, next.loss) = (last.c, last.v, last.w, last.loss);
        let mut kept = 0;
        for k in 0..self.histories.len() {
            if self.histories[k].closed {
                (next.shear[kept], next.roll[kept]) = (last.shear[k], last.roll[k]);
                kept += 1;
            }
        }
        self.histories.retain(|history| history.closed);
        self.impact.fresh = !merged;
    }
}

/// Energy or power of a normal spring, as it is booked.
fn normal_spring(damping: f64) -> Loss {
    Loss { damping, ..Loss::default() }
}

fn growth(error: f64) -> f64 {
    if error.is_finite() {
        (SAFETY * math::pow(error, -0.2)).clamp(RATIO.0, RATIO.1)
    } else {
        RATIO.0
    }
}
