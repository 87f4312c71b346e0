//! A step of one contact on one plane, in the contact's own frame.
//!
//! While only one face touches, geometry is a plane and the normal a constant: the stages of `stage.rs` are the same sums
//! over fourteen numbers, and there is nothing to iterate. Where each stage ends it is asked whether that face is still
//! alone; if the features around the rock certify it (`contact::near`), not even that. Most impacts are of this kind.

use super::adaptive::{
    Advance, Control, Halt, Outcome, PLACE_ROUNDING, RESOLVED, ROUNDING, Stuck, TRAVEL, Trial,
    settle,
};
use super::grip::{Grip, Loss, World};
use super::law::{Body, normal_force};
use super::slide::{Along, Frame, Local, Pair, cut, cut_moment};
use super::tableau::STAGES;
use crate::contact::FeatureKind;
use crate::contact::near::Near;
use crate::ground::Law;
use crate::rock::Vec3;

/// Numbers that change along a step, and where each kind begins.
const SIZE: usize = 14;
/// Way of the centre since the step's start (m).
const WAY: usize = 0;
/// Velocity (m/s).
const SPEED: usize = 3;
/// Spin (rad/s).
const SPIN: usize = 6;
/// Stretch of the shear spring (m).
const SHEAR: usize = 9;
/// Stretch of the rolling spring (rad).
const ROLL: usize = 11;

type State = [f64; SIZE];

#[inline]
fn two(x: &State, at: usize) -> Along {
    [x[at], x[at + 1]]
}

#[inline]
fn three(x: &State, at: usize) -> Local {
    [x[at], x[at + 1], x[at + 2]]
}

#[inline]
fn dot<const N: usize>(x: [f64; N], y: [f64; N]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

#[inline]
fn square<const N: usize>(x: [f64; N]) -> f64 {
    dot(x, x)
}

/// State and rates of a rock on one plane.
#[derive(Debug)]
pub struct Flat {
    /// Whether they are those of the rock in hand.
    on: bool,
    frame: Frame,
    state: State,
    rates: [State; STAGES],
    /// Power that goes into friction, damping and rolling at each stage (W).
    losses: [Local; STAGES],
}

impl Default for Flat {
    fn default() -> Self {
        Self {
            on: false,
            frame: Frame::of(&Vec3::z()),
            state: [0.0; SIZE],
            rates: [[0.0; SIZE]; STAGES],
            losses: [[0.0; 3]; STAGES],
        }
    }
}

/// What presses on the rock at a stage's end.
#[derive(Debug, Clone, Copy, Default)]
struct Press {
    push: f64,
    drag: Along,
    moment: Local,
    /// Whether it still holds the rock.
    closed: bool,
}

/// A step being tried.
struct Try<'a, 'w> {
    control: &'a Control,
    world: &'a World<'w>,
    law: &'a Law,
    flat: &'a mut Flat,
    /// Normal damping in force (N s/m).
    c_n: f64,
    gravity: Local,
    /// Penetration at the step's start (m).
    pen: f64,
    /// Energy at the step's start, motion and springs (J).
    energy: f64,
    near: &'a Near,
    /// Centre at the step's start (m).
    start: Vec3,
    face: u32,
    end: State,
    press: Press,
    stored: f64,
    solved: u64,
}

/// Whether the rock's one contact is the face that its one memory belongs to.
fn is_on_face(world: &World, grip: &Grip) -> bool {
    let [hold] = &grip.holds[..] else { return false };
    if hold.feature.kind != FeatureKind::Face || !grip.near.covers(&grip.c) {
        return false;
    }
    let face = &world.terrain.features.faces[hold.feature.id as usize];
    // Deep inside, or with a memory from elsewhere, the side it is on must be looked up.
    hold.n.dot(&(grip.c - face.a)) > 0.5 * world.body.radius
        && (hold.n == face.n || hold.n == -face.n)
}

impl Grip {
    /// One accepted step on a plane; `None` if the rock does not stay on one.
    pub(crate) fn step_on_plane(
        &mut self,
        world: &World,
        control: &Control,
        (h, h_max): (&mut f64, f64),
        done: &mut Advance,
    ) -> Option<Result<(), Stuck>> {
        if !is_on_face(world, self) {
            return None;
        }
        let hold = self.holds[0];
        let law = world.law(hold.triangle);
        let c_n = if hold.captured { law.c_n_captured } else { law.c_n };
        let pen = self.sunk(world);
        if !self.flat.on {
            self.enter_plane(law, &world.body, (pen, c_n));
        }
        let limit = self.longest_step(world, TRAVEL);
        let mut trial = Try {
            control,
            world,
            law,
            c_n,
            gravity: self.flat.frame.local(&world.body.gravity),
            pen,
            energy: self.motion_j(&world.body) + self.stored,
            near: &self.near,
            start: self.c,
            face: hold.feature.id,
            flat: &mut self.flat,
            end: [0.0; SIZE],
            press: Press::default(),
            stored: 0.0,
            solved: 0,
        };
        let settled = settle(&mut trial, control, (h, h_max, limit), &mut done.rejected);
        let (end, press, stored) = (trial.end, trial.press, trial.stored);
        self.sweeps += trial.solved;
        match settled {
            Ok(dt) => {
                done.dt = dt;
                done.loss = self.flat.lost(control, dt).on(world, hold.triangle);
                self.take_plane(law, control, (end, press, stored));
                Some(Ok(()))
            }
            Err(Halt::Unsettled) => Some(Err(Stuck::Unsettled)),
            Err(Halt::Elsewhere) => None,
        }
    }

    /// Penetration into the plane of the one contact (m).
    fn sunk(&self, world: &World) -> f64 {
        let hold = &self.holds[0];
        let corner = &world.terrain.features.faces[hold.feature.id as usize].a;
        world.body.radius - hold.n.dot(&(self.c - corner))
    }

    /// Turns state and rates into the plane's frame.
    fn enter_plane(&mut self, law: &Law, body: &Body, (pen, c_n): (f64, f64)) {
        let (hold, flat) = (&self.holds[0], &mut self.flat);
        flat.on = true;
        flat.frame = Frame::of(&hold.n);
        let put =
            |to: &mut State, (c, v, w): (&Vec3, &Vec3, &Vec3), (shear, roll): (&Vec3, &Vec3)| {
                to[WAY..SPEED].copy_from_slice(&flat.frame.local(c));
                to[SPEED..SPIN].copy_from_slice(&flat.frame.local(v));
                to[SPIN..SHEAR].copy_from_slice(&flat.frame.local(w));
                to[SHEAR..ROLL].copy_from_slice(&flat.frame.along(shear));
                to[ROLL..].copy_from_slice(&flat.frame.local(roll));
            };
        put(&mut flat.state, (&Vec3::zeros(), &self.v, &self.w), (&hold.shear, &hold.roll));
        if self.fresh {
            let rate = &self.rates[0];
            let springs = (&rate.shear[0], &rate.roll[0]);
            put(&mut flat.rates[0], (&rate.c, &rate.v, &rate.w), springs);
            let loss = &rate.loss;
            flat.losses[0] = if loss.trees == 0.0 {
                [loss.friction, loss.damping, loss.rolling]
            } else {
                [loss.trees, 0.0, 0.0]
            };
        } else {
            self.stored = flat.begin(law, body, (pen, c_n));
            self.fresh = true;
        }
    }

    /// Takes over the step's end: motion, memory, rates.
    fn take_plane(
        &mut self,
        law: &Law,
        control: &Control,
        (end, press, stored): (State, Press, f64),
    ) {
        let flat = &mut self.flat;
        let last = control.tableau.stages - 1;
        (flat.rates[0], flat.losses[0]) = (flat.rates[last], flat.losses[last]);
        self.c += flat.frame.out_local(three(&end, WAY));
        self.v = flat.frame.out_local(three(&end, SPEED));
        self.w = flat.frame.out_local(three(&end, SPIN));
        self.stored = stored;
        let hold = &mut self.holds[0];
        hold.shear = flat.frame.out_along(two(&end, SHEAR));
        hold.roll = flat.frame.out_local(three(&end, ROLL));
        hold.push = press.push;
        hold.slides = square(press.drag) >= (law.friction * press.push * (1.0 - 1e-9)).powi(2);
        flat.state = end;
        flat.state[WAY..SPEED].fill(0.0);
        hold.closed = press.closed;
        if !press.closed {
            flat.on = false;
            self.holds.clear();
            self.fresh = false;
        }
    }

    /// Hands state and rates back to the frame of the terrain.
    pub(crate) fn leave_plane(&mut self) {
        let flat = &mut self.flat;
        if !std::mem::take(&mut flat.on) {
            return;
        }
        let (rate, from) = (&mut self.rates[0], &flat.rates[0]);
        rate.c = flat.frame.out_local(three(from, WAY));
        rate.v = flat.frame.out_local(three(from, SPEED));
        rate.w = flat.frame.out_local(three(from, SPIN));
        rate.shear[0] = flat.frame.out_along(two(from, SHEAR));
        rate.roll[0] = flat.frame.out_local(three(from, ROLL));
        let [friction, damping, rolling] = flat.losses[0];
        rate.loss = Loss { friction, damping, rolling, trees: 0.0 };
    }
}

impl Flat {
    /// Forgets whose state it holds (before the next contact).
    pub(crate) fn forget(&mut self) {
        self.on = false;
    }

    /// Rates at the present state, for the explicit first stage; returns the energy in the springs (J).
    fn begin(&mut self, law: &Law, body: &Body, (pen, c_n): (f64, f64)) -> f64 {
        let (pen, s) = (pen.max(0.0), &self.state);
        let (speed, spin) = (three(s, SPEED), three(s, SPIN));
        let slip = slip(body, speed, spin);
        let push = (law.p_n * pen - c_n * speed[2]).max(0.0);
        let held = two(s, SHEAR).map(|x| x * law.p_s);
        let drag = cut([0, 1].map(|k| held[k] + slip[k] * law.c_s), law.friction * push);
        let wound = three(s, ROLL).map(|x| x * law.k_r);
        let moment =
            cut_moment([0, 1, 2].map(|k| wound[k] + spin[k] * law.c_r), law.rolling_m * push);
        let over = |damping: f64| if damping > 0.0 { 1.0 / damping } else { 0.0 };
        let (over_s, over_r) = (over(law.c_s), over(law.c_r));
        let gravity = self.frame.local(&body.gravity);
        let (dv, dw) = accelerations(body, push, drag, moment);
        let rate = &mut self.rates[0];
        for k in 0..3 {
            rate[WAY + k] = speed[k];
            rate[SPEED + k] = gravity[k] + dv[k];
            rate[SPIN + k] = dw[k];
            rate[ROLL + k] = (moment[k] - wound[k]) * over_r;
        }
        for k in 0..2 {
            rate[SHEAR + k] = (drag[k] - held[k]) * over_s;
        }
        let press = Press { push, drag, moment, closed: true };
        self.losses[0] = press.losses(slip, (speed[2], spin), two(&self.rates[0], SHEAR));
        stored_j(law, pen, &self.state)
    }

    /// What went into friction, damping and rolling over an accepted step (J).
    fn lost(&self, control: &Control, dt: f64) -> Loss {
        let mut sum = [0.0; 3];
        for (k, loss) in self.losses[..control.tableau.stages].iter().enumerate() {
            let weight = dt * control.tableau.weight(k);
            for (sum, loss) in sum.iter_mut().zip(loss) {
                *sum += weight * loss;
            }
        }
        let [friction, damping, rolling] = sum;
        Loss { friction, damping, rolling, trees: 0.0 }
    }
}

/// Velocity of the contact point along the plane (m/s).
#[inline]
fn slip(body: &Body, speed: Local, spin: Local) -> Along {
    [speed[0] - body.radius * spin[1], speed[1] + body.radius * spin[0]]
}

/// What contact forces do to velocity and spin (m/s², rad/s²).
#[inline]
fn accelerations(body: &Body, push: f64, drag: Along, moment: Local) -> (Local, Local) {
    let (over_m, over_i) = (1.0 / body.mass, 1.0 / body.inertia);
    let r = body.radius;
    let turns = [-r * drag[1] - moment[0], r * drag[0] - moment[1], -moment[2]];
    ([-drag[0] * over_m, -drag[1] * over_m, push * over_m], turns.map(|x| x * over_i))
}

/// Energy in the springs (J).
#[inline]
fn stored_j(law: &Law, pen: f64, at: &State) -> f64 {
    let (shear2, roll2) = (square(two(at, SHEAR)), square(three(at, ROLL)));
    0.5 * (law.p_n * pen * pen + law.p_s * shear2 + law.k_r * roll2)
}

impl Press {
    /// Power that goes into friction, damping and rolling (W): what the springs store is counted in.
    #[inline]
    fn losses(&self, slip: Along, (rise, spin): (f64, Local), shear_rate: Along) -> Local {
        let held = dot(self.drag, shear_rate);
        [dot(self.drag, slip) - held, held - self.push * rise, dot(self.moment, spin)]
    }
}

impl Try<'_, '_> {
    /// Solves implicit stage `i` of a step of length `dt`.
    #[inline]
    fn stage(&mut self, i: usize, dt: f64) {
        let (body, law, tableau) = (&self.world.body, self.law, self.control.tableau);
        let hh = tableau.diagonal * dt;
        let mut base = self.flat.state;
        for (rate, a) in self.flat.rates.iter().zip(tableau.a[i]) {
            for (base, rate) in base.iter_mut().zip(rate) {
                *base += rate * (dt * a);
            }
        }
        let spin = three(&base, SPIN);
        let speed = [0, 1, 2].map(|k| base[SPEED + k] + self.gravity[k] * hh);
        let pen = self.pen - base[WAY + 2];
        let push = normal_force((law.p_n, self.c_n), pen, speed[2], body.mass, hh);
        let (mut drag, mut moment) = ([0.0; 2], [0.0; 3]);
        if push > 0.0 {
            let (kap, kar) = (law.p_s * hh + law.c_s, law.k_r * hh + law.c_r);
            let slip = slip(body, speed, spin);
            let a = [0, 1].map(|k| base[SHEAR + k] * law.p_s + slip[k] * kap);
            let d = [0, 1, 2].map(|k| base[ROLL + k] * law.k_r + spin[k] * kar);
            (drag, moment) = Pair::of(body, law, (hh, push), (a, d)).solve();
        }
        let (dv, dw) = accelerations(body, push, drag, moment);
        let (rate, end) = (&mut self.flat.rates[i], &mut self.end);
        for k in 0..3 {
            let v = speed[k] + dv[k] * hh;
            rate[WAY + k] = v;
            rate[SPEED + k] = self.gravity[k] + dv[k];
            rate[SPIN + k] = dw[k];
        }
        let over_s = 1.0 / (hh * law.p_s + law.c_s);
        for k in 0..2 {
            rate[SHEAR + k] = (drag[k] - law.p_s * base[SHEAR + k]) * over_s;
        }
        let winding = hh * law.k_r + law.c_r;
        let over_r = if winding > 0.0 { 1.0 / winding } else { 0.0 };
        for k in 0..3 {
            rate[ROLL + k] = (moment[k] - law.k_r * base[ROLL + k]) * over_r;
        }
        for k in 0..SIZE {
            end[k] = base[k] + rate[k] * hh;
        }
        let press = Press { push, drag, moment, closed: true };
        let (speed, spin) = (three(end, SPEED), three(end, SPIN));
        let shear_rate = two(rate, SHEAR);
        self.flat.losses[i] = press.losses(slip(body, speed, spin), (speed[2], spin), shear_rate);
        self.press = press;
        self.solved += 1;
    }

    /// Whether the stage ended on the plane, or above it, and touches nothing else.
    #[inline]
    fn is_alone(&self) -> bool {
        let centre = self.start + self.flat.frame.out_local(three(&self.end, WAY));
        self.near.covers(&centre)
            && (self.near.plane() == Some(self.face) || {
                let reach = self.world.body.radius;
                self.near.is_alone(self.world.terrain, self.face, (&centre, reach))
            })
    }

    /// Local error relative to the tolerance.
    #[inline]
    fn error(&self, dt: f64) -> f64 {
        let tableau = self.control.tableau;
        let mut off = [0.0; SIZE];
        for (rate, weight) in self.flat.rates[..tableau.stages].iter().zip(tableau.error) {
            for (off, rate) in off.iter_mut().zip(rate) {
                *off += rate * weight;
            }
        }
        let omega2 = self.law.omega * self.law.omega;
        let worst2 = (square(three(&off, WAY)).max(square(two(&off, SHEAR))) * omega2)
            .max(square(three(&off, SPEED)))
            .max(square(three(&off, SPIN)) * self.world.body.radius.powi(2));
        dt * worst2.sqrt() / self.control.tolerance
    }

    /// Whether motion, height and springs together hold more at the end than at the start.
    fn gains(&self) -> bool {
        let (body, end) = (&self.world.body, &self.end);
        let (speed2, spin2) = (square(three(end, SPEED)), square(three(end, SPIN)));
        let motion = 0.5 * (body.mass * speed2 + body.inertia * spin2);
        let lifted = -body.mass * dot(self.gravity, three(end, WAY));
        let force = body.mass * body.gravity.norm() + self.press.push;
        let unknown = ROUNDING * self.energy + PLACE_ROUNDING * body.radius * force;
        motion + lifted + self.stored > self.energy + unknown
    }
}

impl Trial for Try<'_, '_> {
    fn omega(&self) -> f64 {
        self.law.omega
    }

    fn try_step(&mut self, dt: f64) -> Outcome {
        for i in 1..self.control.tableau.stages {
            self.stage(i, dt);
            if !self.is_alone() {
                return Outcome::Elsewhere;
            }
        }
        let error = self.error(dt);
        if error > 1.0 || error.is_nan() {
            return Outcome::Error(error);
        }
        let pen = (self.pen - self.end[WAY + 2]).max(0.0);
        self.press.closed = self.press.push > 0.0 || pen > 0.0;
        self.stored = if self.press.closed { stored_j(self.law, pen, &self.end) } else { 0.0 };
        if dt * self.law.omega > RESOLVED && self.gains() {
            return Outcome::Gains;
        }
        Outcome::Error(error)
    }
}
