//! A step of one contact on one plane, in the contact's own frame.
//!
//! While only one face touches, the geometry is a plane and the normal constant: the stages of
//! `stage.rs` become the same sums over fourteen numbers, without iteration over the geometry.
//! After each stage it is checked that the face is still
//! the only one touched; if the features around the rock certify that (`Neighbours::plane`), no
//! check is needed. Most
//! impacts are of this kind.
//!
//! The steps agree with those of `stage.rs` to rounding, at a lower cost.
//!
//! Frame: two tangents `s`, `t` and the normal `n` (from the mesh to the centre), fixed as long as
//! the face is. State: displacement of the centre since the last contact search (3), velocity (3),
//! spin (3), shear
//! stretch (2), rolling stretch (3).

mod trial;

use super::body::Body;
use super::contact_frame::{ContactFrame, square};
use super::contact_state::{ContactEnvironment, ContactState};
use super::friction_rolling::SlipState;
use super::loss::Loss;
use super::plane_ahead::longest_step;
use super::plane_state::{PlaneForces, PlaneState, SIZE, SPEED, WAY, into_plane, out_of_plane};
use super::step_control::{Advance, Control, StepError, StepFailure, TRAVEL};
use crate::contact::FeatureKind;
use crate::ground::{Law, NormalElement};
use crate::rock::Vec3;
use trial::PlaneTrial;

/// Whether the only contact of the rock is with the face of its only history.
pub(super) fn is_on_face(world: &ContactEnvironment, rock: &ContactState) -> bool {
    let [history] = &rock.histories[..] else { return false };
    if history.feature.kind != FeatureKind::Face {
        return false;
    }
    let face = world.terrain.face(history.feature.id);
    // more than half a radius off the plane, and with the normal of the face, the side of the rock
    // is unambiguous
    history.n.dot(&(rock.c - face.a)) > 0.5 * world.body.radius
        && (history.n == face.n || history.n == -face.n)
}

impl ContactState {
    /// Accepted steps on a plane, all of an impact; `None` if the rock does not stay on one.
    ///
    /// `h` is the step to try and becomes the next one; `h_max` (s) is the longest. An impact on a
    /// plane is stepped to its end in one call: contact search, change of frame and copies of
    /// histories are needed once.
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
        // the features ahead must be known before the face can be certified as the only one touched
        let history = self.histories[0];
        let (proposed_s, usual_m) = (h.min(h_max), TRAVEL * world.body.radius);
        let limit = self.longest_on_plane_s(world, history.feature.id, (proposed_s, usual_m));
        self.collect_along(world, &(self.v * proposed_s).cap_magnitude(usual_m));
        let usual_s = longest_step(&world.body, self.v.norm(), usual_m);
        let law = &world.springs_of(&history);
        let normal = law.normal(history.captured);
        // from the position, not from the sum of displacements: over many steps that would drift
        // off the plane
        let penetration = self.plane_penetration_m(world);
        // state and rates stay in the plane's frame from step to step; they are transformed only at
        // the first and the last one
        if !self.plane.on {
            self.enter_plane(law, &world.body, (penetration, &normal));
        }
        let gravity = self.plane.frame.local(&world.body.gravity);
        let mut trial = PlaneTrial {
            h,
            limit,
            usual_s,
            room_s: usual_s,
            control,
            world,
            law,
            normal,
            gravity,
            penetration,
            energy: self.motion_j(&world.body) + self.stored,
            energy_at_end: 0.0,
            known_way2: self.near.margin_left_m(&self.c).max(0.0).powi(2),
            near: &self.near,
            start: self.c,
            face: history.feature.id,
            plane: &mut self.plane,
            mode: SlipState::default(),
            end: [0.0; SIZE],
            forces: PlaneForces::default(),
            stored: 0.0,
            solved: 0,
        };
        // as many steps as the certificate covers
        let failure = trial.take_steps((h_max, world.terrain.is_tree(history.triangle)), done);
        let (forces, stored) = (trial.forces, trial.stored);
        self.sweeps += trial.solved;
        match failure {
            // a failure of the first step is returned; after it, the accepted steps count and the
            // next call handles the failure
            Some(StepFailure::NotConverged) if done.steps == 0 => {
                return Some(Err(StepError::NotConverged));
            }
            Some(StepFailure::OutOfDomain) if done.steps == 0 => return None,
            // the cause of a later failure is met again, or avoided, from the new position
            _ => {}
        }
        done.loss = done.loss.on(world, history.triangle);
        self.accept_plane_steps(law, forces, stored);
        Some(Ok(()))
    }

    /// Penetration into the plane of the one contact (m).
    /// `R − n·(c − a)`, positive when pressed in.
    pub(super) fn plane_penetration_m(&self, world: &ContactEnvironment) -> f64 {
        let history = &self.histories[0];
        let corner = world.terrain.face(history.feature.id).a;
        world.body.radius - history.n.dot(&(self.c - corner))
    }

    /// Transforms state and rates into the plane's frame.
    ///
    /// Rates of the last step that still hold are transformed too, so that the first stage need not
    /// be computed anew.
    fn enter_plane(
        &mut self,
        law: &Law,
        body: &Body,
        (penetration, normal): (f64, &NormalElement),
    ) {
        let (history, plane) = (&self.histories[0], &mut self.plane);
        plane.on = true;
        plane.frame = ContactFrame::of(&history.n);
        let (motion, springs) =
            ([&Vec3::zeros(), &self.v, &self.w], [&history.shear, &history.roll]);
        plane.state = into_plane(&plane.frame, motion, springs);
        if self.fresh {
            let rate = &self.rates[0];
            let (motion, springs) = ([&rate.c, &rate.v, &rate.w], [&rate.shear[0], &rate.roll[0]]);
            plane.rates[0] = into_plane(&plane.frame, motion, springs);
            let loss = &rate.loss;
            plane.losses[0] = if loss.trees == 0.0 {
                [loss.friction, loss.damping, loss.rolling]
            } else {
                [loss.trees, 0.0, 0.0]
            };
        } else {
            self.stored = plane.rates_now(law, body, (penetration, normal));
            self.fresh = true;
        }
    }

    /// Accepts the end of the steps: motion and contact history.
    fn accept_plane_steps(&mut self, law: &Law, forces: PlaneForces, stored: f64) {
        let PlaneState { state, frame, on, .. } = &mut self.plane;
        let history = &mut self.histories[0];
        let displacement;
        [displacement, self.v, self.w, history.shear, history.roll] = out_of_plane(frame, state);
        self.c += displacement;
        self.stored = stored;
        // forces at the end, as the initial guess of the next step
        history.normal_force = forces.normal_force;
        history.slides = law.shear.slides2(square(forces.shear_force), forces.normal_force);
        history.closed = forces.closed;
        state[WAY..SPEED].fill(0.0);
        // the rock has lifted off: the episode may be over, and no history is left
        if !forces.closed {
            *on = false;
            self.histories.clear();
            self.fresh = false;
        }
    }

    /// Transforms state and rates back to the frame of the terrain. The general stage continues
    /// from the same rates: the change of kernel costs no extra stage.
    pub(crate) fn leave_plane(&mut self, world: &ContactEnvironment) {
        let plane = &mut self.plane;
        if !std::mem::take(&mut plane.on) {
            return;
        }
        let rate = &mut self.rates[0];
        [rate.c, rate.v, rate.w, rate.shear[0], rate.roll[0]] =
            out_of_plane(&plane.frame, &plane.rates[0]);
        rate.loss = Loss::on_slope(plane.losses[0]).on(world, self.histories[0].triangle);
    }
}
