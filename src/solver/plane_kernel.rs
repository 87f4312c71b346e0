//! A step of one contact on one plane, in the contact's own frame.
//!
//! While only one face touches, geometry is a plane and the normal a constant: the stages of `stage.rs` are the same sums
//! over fourteen numbers, and there is nothing to iterate. Where each stage ends it is asked whether that face is still
//! alone; if the features around the rock certify it (`contact::near`), not even that. Most impacts are of this kind.

mod state;
mod trial;

use super::contact_state::{ContactEnvironment, ContactState, Loss, longest_step};
use super::friction_rolling::{Frame, Local, Mode, cut, cut_moment};
use super::law::Body;
use super::step_control::{Advance, Control, StepError, StepFailure, TRAVEL};
use super::tableau::STAGES;
use crate::contact::FeatureKind;
use crate::ground::Law;
use crate::rock::Vec3;
use state::{
    PlaneForces, ROLL, SHEAR, SIZE, SPEED, SPIN, State, WAY, accelerations, slip, square, stored_j,
    three, two,
};
use trial::Try;

/// State and rates of a rock on one plane.
#[derive(Debug)]
pub struct PlaneKernel {
    /// Whether they are those of the rock in hand.
    on: bool,
    frame: Frame,
    state: State,
    rates: [State; STAGES],
    /// Power that goes into friction, damping and rolling at each stage (W).
    losses: [Local; STAGES],
}

impl Default for PlaneKernel {
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
fn is_on_face(world: &ContactEnvironment, rock: &ContactState) -> bool {
    let [history] = &rock.histories[..] else { return false };
    if history.feature.kind != FeatureKind::Face {
        return false;
    }
    let face = world.terrain.face(history.feature.id);
    // Deep inside, or with a memory from elsewhere, the side it is on must be looked up.
    history.n.dot(&(rock.c - face.a)) > 0.5 * world.body.radius
        && (history.n == face.n || history.n == -face.n)
}

impl ContactState {
    /// One accepted step on a plane, or all of an impact; `None` if the rock does not stay on one.
    pub(crate) fn step_on_plane(
        &mut self,
        world: &ContactEnvironment,
        control: &Control,
        (h, h_max): (&mut f64, f64),
        done: &mut Advance,
    ) -> Option<Result<(), StepError>> {
        if !is_on_face(world, self) {
            return None;
        }
        self.see_ahead(world, h.min(h_max));
        let history = self.histories[0];
        let law = world.law(history.triangle);
        let c_n = if history.captured { law.c_n_captured } else { law.c_n };
        let penetration = self.sunk(world);
        if !self.plane_kernel.on {
            self.enter_plane(law, &world.body, (penetration, c_n));
        }
        let gravity = self.plane_kernel.frame.local(&world.body.gravity);
        let mut trial = Try {
            h,
            limit: self.longest_step(world, TRAVEL),
            room_s: longest_step(&world.body, self.v.norm(), TRAVEL * world.body.radius),
            control,
            world,
            law,
            c_n,
            gravity,
            penetration,
            energy: self.motion_j(&world.body) + self.stored,
            energy_at_end: 0.0,
            room2: self.near.room_m(&self.c).max(0.0).powi(2),
            near: &self.near,
            start: self.c,
            face: history.feature.id,
            plane_kernel: &mut self.plane_kernel,
            mode: Mode::default(),
            end: [0.0; SIZE],
            press: PlaneForces::default(),
            stored: 0.0,
            solved: 0,
        };
        let halt = trial.run((h_max, world.terrain.is_tree(history.triangle)), done);
        let (press, stored) = (trial.press, trial.stored);
        self.sweeps += trial.solved;
        match halt {
            Some(StepFailure::Unsettled) if done.steps == 0 => {
                return Some(Err(StepError::Unsettled));
            }
            Some(StepFailure::Elsewhere) if done.steps == 0 => return None,
            // What stopped it after its first step is met again, or got round, from where it is now.
            _ => {}
        }
        done.loss = done.loss.on(world, history.triangle);
        self.take_plane(law, press, stored);
        Some(Ok(()))
    }

    /// Sees to it that the features where a step of `dt` goes are known, and a little beyond.
    fn see_ahead(&mut self, world: &ContactEnvironment, dt: f64) {
        let way = (self.v * dt).cap_magnitude(TRAVEL * world.body.radius);
        if !(self.near.covers(&self.c) && self.near.covers(&(self.c + way))) {
            let ahead = self.v.cap_magnitude(AHEAD * world.body.radius);
            self.collect(world, &(self.c + ahead));
        }
    }

    /// Penetration into the plane of the one contact (m).
    fn sunk(&self, world: &ContactEnvironment) -> f64 {
        let history = &self.histories[0];
        let corner = world.terrain.face(history.feature.id).a;
        world.body.radius - history.n.dot(&(self.c - corner))
    }

    /// Turns state and rates into the plane's frame.
    fn enter_plane(&mut self, law: &Law, body: &Body, (penetration, c_n): (f64, f64)) {
        let (history, plane_kernel) = (&self.histories[0], &mut self.plane_kernel);
        plane_kernel.on = true;
        plane_kernel.frame = Frame::of(&history.n);
        let put =
            |to: &mut State, (c, v, w): (&Vec3, &Vec3, &Vec3), (shear, roll): (&Vec3, &Vec3)| {
                to[WAY..SPEED].copy_from_slice(&plane_kernel.frame.local(c));
                to[SPEED..SPIN].copy_from_slice(&plane_kernel.frame.local(v));
                to[SPIN..SHEAR].copy_from_slice(&plane_kernel.frame.local(w));
                to[SHEAR..ROLL].copy_from_slice(&plane_kernel.frame.along(shear));
                to[ROLL..].copy_from_slice(&plane_kernel.frame.local(roll));
            };
        put(
            &mut plane_kernel.state,
            (&Vec3::zeros(), &self.v, &self.w),
            (&history.shear, &history.roll),
        );
        if self.fresh {
            let rate = &self.rates[0];
            let springs = (&rate.shear[0], &rate.roll[0]);
            put(&mut plane_kernel.rates[0], (&rate.c, &rate.v, &rate.w), springs);
            let loss = &rate.loss;
            plane_kernel.losses[0] = if loss.trees == 0.0 {
                [loss.friction, loss.damping, loss.rolling]
            } else {
                [loss.trees, 0.0, 0.0]
            };
        } else {
            self.stored = plane_kernel.begin(law, body, (penetration, c_n));
            self.fresh = true;
        }
    }

    /// Takes over where the steps have ended: motion and memory.
    fn take_plane(&mut self, law: &Law, press: PlaneForces, stored: f64) {
        let PlaneKernel { state, frame, on, .. } = &mut self.plane_kernel;
        self.c += frame.out_local(three(state, WAY));
        self.v = frame.out_local(three(state, SPEED));
        self.w = frame.out_local(three(state, SPIN));
        self.stored = stored;
        let history = &mut self.histories[0];
        history.shear = frame.out_along(two(state, SHEAR));
        history.roll = frame.out_local(three(state, ROLL));
        history.normal_force = press.normal_force;
        history.slides =
            square(press.shear_force) >= (law.friction * press.normal_force * (1.0 - 1e-9)).powi(2);
        history.closed = press.closed;
        state[WAY..SPEED].fill(0.0);
        if !press.closed {
            *on = false;
            self.histories.clear();
            self.fresh = false;
        }
    }

    /// Hands state and rates back to the frame of the terrain.
    pub(crate) fn leave_plane(&mut self, world: &ContactEnvironment) {
        let plane_kernel = &mut self.plane_kernel;
        if !std::mem::take(&mut plane_kernel.on) {
            return;
        }
        let (rate, from) = (&mut self.rates[0], &plane_kernel.rates[0]);
        rate.c = plane_kernel.frame.out_local(three(from, WAY));
        rate.v = plane_kernel.frame.out_local(three(from, SPEED));
        rate.w = plane_kernel.frame.out_local(three(from, SPIN));
        rate.shear[0] = plane_kernel.frame.out_along(two(from, SHEAR));
        rate.roll[0] = plane_kernel.frame.out_local(three(from, ROLL));
        let [friction, damping, rolling] = plane_kernel.losses[0];
        let loss = Loss { friction, damping, rolling, trees: 0.0 };
        rate.loss = loss.on(world, self.histories[0].triangle);
    }
}

impl PlaneKernel {
    /// Forgets whose state it holds (before the next contact).
    pub(crate) fn forget(&mut self) {
        self.on = false;
    }

    /// Rates at the present state, for the explicit first stage; returns the energy in the springs (J).
    fn begin(&mut self, law: &Law, body: &Body, (penetration, c_n): (f64, f64)) -> f64 {
        let (penetration, s) = (penetration.max(0.0), &self.state);
        let (speed, spin) = (three(s, SPEED), three(s, SPIN));
        let slip = slip(body, speed, spin);
        let normal_force = (law.p_n * penetration - c_n * speed[2]).max(0.0);
        let held = two(s, SHEAR).map(|x| x * law.p_s);
        let shear_force =
            cut([0, 1].map(|k| held[k] + slip[k] * law.c_s), law.friction * normal_force);
        let wound = three(s, ROLL).map(|x| x * law.k_r);
        let rolling_moment = cut_moment(
            [0, 1, 2].map(|k| wound[k] + spin[k] * law.c_r),
            law.rolling_m * normal_force,
        );
        let over = |damping: f64| if damping > 0.0 { 1.0 / damping } else { 0.0 };
        let (over_s, over_r) = (over(law.c_s), over(law.c_r));
        let gravity = self.frame.local(&body.gravity);
        let (dv, dw) = accelerations(body, normal_force, shear_force, rolling_moment);
        let rate = &mut self.rates[0];
        for k in 0..3 {
            rate[WAY + k] = speed[k];
            rate[SPEED + k] = gravity[k] + dv[k];
            rate[SPIN + k] = dw[k];
            rate[ROLL + k] = (rolling_moment[k] - wound[k]) * over_r;
        }
        for k in 0..2 {
            rate[SHEAR + k] = (shear_force[k] - held[k]) * over_s;
        }
        let press = PlaneForces { normal_force, shear_force, rolling_moment, closed: true };
        self.losses[0] = press.losses(slip, (speed[2], spin), two(&self.rates[0], SHEAR));
        stored_j(law, penetration, &self.state)
    }
}
