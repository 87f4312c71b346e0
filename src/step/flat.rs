//! A step of one contact on one plane, in the contact's own frame.
//!
//! While only one face touches, geometry is a plane and the normal a constant: the stages of `stage.rs` are the same sums
//! over fourteen numbers, and there is nothing to iterate. Where each stage ends it is asked whether that face is still
//! alone; if the features around the rock certify it (`contact::near`), not even that. Most impacts are of this kind.

mod state;
mod trial;

use super::adaptive::{Advance, Control, Halt, Stuck, TRAVEL};
use super::grip::{Grip, Loss, World, longest_step};
use super::law::Body;
use super::slide::{Frame, Local, Mode, cut, cut_moment};
use super::tableau::STAGES;
use crate::contact::FeatureKind;
use crate::ground::Law;
use crate::rock::Vec3;
use state::{
    Press, ROLL, SHEAR, SIZE, SPEED, SPIN, State, WAY, accelerations, slip, square, stored_j,
    three, two,
};
use trial::Try;

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
/// Features are collected so far ahead of the rock (–, relative to R): half of how far they are known.
const AHEAD: f64 = 0.17;

/// Whether the rock's one contact is the face that its one memory belongs to.
fn is_on_face(world: &World, grip: &Grip) -> bool {
    let [hold] = &grip.holds[..] else { return false };
    if hold.feature.kind != FeatureKind::Face {
        return false;
    }
    let face = &world.terrain.features.faces[hold.feature.id as usize];
    // Deep inside, or with a memory from elsewhere, the side it is on must be looked up.
    hold.n.dot(&(grip.c - face.a)) > 0.5 * world.body.radius
        && (hold.n == face.n || hold.n == -face.n)
}

impl Grip {
    /// One accepted step on a plane, or all of an impact; `None` if the rock does not stay on one.
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
        self.see_ahead(world, h.min(h_max));
        let hold = self.holds[0];
        let law = world.law(hold.triangle);
        let c_n = if hold.captured { law.c_n_captured } else { law.c_n };
        let pen = self.sunk(world);
        if !self.flat.on {
            self.enter_plane(law, &world.body, (pen, c_n));
        }
        let gravity = self.flat.frame.local(&world.body.gravity);
        let mut trial = Try {
            h,
            limit: self.longest_step(world, TRAVEL),
            room_s: longest_step(&world.body, self.v.norm(), TRAVEL * world.body.radius),
            control,
            world,
            law,
            c_n,
            gravity,
            pen,
            energy: self.motion_j(&world.body) + self.stored,
            energy_at_end: 0.0,
            room2: self.near.room_m(&self.c).max(0.0).powi(2),
            near: &self.near,
            start: self.c,
            face: hold.feature.id,
            flat: &mut self.flat,
            mode: Mode::default(),
            end: [0.0; SIZE],
            press: Press::default(),
            stored: 0.0,
            solved: 0,
        };
        let halt = trial.run((h_max, world.terrain.is_tree(hold.triangle)), done);
        let (press, stored) = (trial.press, trial.stored);
        self.sweeps += trial.solved;
        match halt {
            Some(Halt::Unsettled) if done.steps == 0 => return Some(Err(Stuck::Unsettled)),
            Some(Halt::Elsewhere) if done.steps == 0 => return None,
            // What stopped it after its first step is met again, or got round, from where it is now.
            _ => {}
        }
        done.loss = done.loss.on(world, hold.triangle);
        self.take_plane(law, press, stored);
        Some(Ok(()))
    }

    /// Sees to it that the features where a step of `dt` goes are known, and a little beyond.
    fn see_ahead(&mut self, world: &World, dt: f64) {
        let way = (self.v * dt).cap_magnitude(TRAVEL * world.body.radius);
        if !(self.near.covers(&self.c) && self.near.covers(&(self.c + way))) {
            let ahead = self.v.cap_magnitude(AHEAD * world.body.radius);
            self.collect(world, &(self.c + ahead));
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

    /// Takes over where the steps have ended: motion and memory.
    fn take_plane(&mut self, law: &Law, press: Press, stored: f64) {
        let Flat { state, frame, on, .. } = &mut self.flat;
        self.c += frame.out_local(three(state, WAY));
        self.v = frame.out_local(three(state, SPEED));
        self.w = frame.out_local(three(state, SPIN));
        self.stored = stored;
        let hold = &mut self.holds[0];
        hold.shear = frame.out_along(two(state, SHEAR));
        hold.roll = frame.out_local(three(state, ROLL));
        hold.push = press.push;
        hold.slides = square(press.drag) >= (law.friction * press.push * (1.0 - 1e-9)).powi(2);
        hold.closed = press.closed;
        state[WAY..SPEED].fill(0.0);
        if !press.closed {
            *on = false;
            self.holds.clear();
            self.fresh = false;
        }
    }

    /// Hands state and rates back to the frame of the terrain.
    pub(crate) fn leave_plane(&mut self, world: &World) {
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
        let loss = Loss { friction, damping, rolling, trees: 0.0 };
        rate.loss = loss.on(world, self.holds[0].triangle);
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
}
