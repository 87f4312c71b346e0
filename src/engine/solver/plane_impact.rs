//! The rest of an impact on one plane, solved as a whole.
//!
//! On a plane the normal motion of an impact has a closed form, and slip and spin follow under its
//! known force (`impact::plane`): no contact search, no stages. It requires a certificate that
//! nothing but this plane is touched on the way: the path is enclosed in a rectangle along and into
//! the plane, widened by its possible curvature, and tested against all features around. That
//! nearly always holds from the first touch on; an impact that began at a fold or an edge is taken
//! over where it has left it.

use super::contact_state::{ContactEnvironment, ContactState};
use super::impact::{InitialDeformation, NormalPassage, Plane, Rebound};
use super::law::{ContactDeformation, ContactForces};
use super::plane_kernel::is_on_face;
use super::step_control::Advance;
use crate::contact::TOUCH;
use crate::contact::history::ContactHistory;
use crate::contact::neighbours::PressedPath;
use crate::rock::Vec3;

/// Assumed upper bound of the share of slip that an impact stops, before that is known (–): one
/// without loss reverses it.
const SLIP_STOPPED: f64 = 0.5;

/// Shortest part of an impact that is solved as a whole (rad of the contact).
const LEAST_RAD: f64 = 0.5;

impl ContactState {
    /// Solves the rest of an impact on one plane, if nothing else can be touched as far as the rock
    /// gets and the rock comes out within `h_max` (s). Where something else is touched later, only
    /// the first half or quarter of it, and so on. `tolerance` as in [`Self::step_impact`].
    ///
    /// Returns false and changes nothing where that is impossible: then the impact is resolved step
    /// by step.
    pub(crate) fn finish_plane_impact(
        &mut self,
        world: &ContactEnvironment,
        tolerance: f64,
        h_max: f64,
        done: &mut Advance,
    ) -> bool {
        let Some((history, pressed)) = self.pressed_in_plane(world) else { return false };
        let plane = Plane::new(&world.body, &world.springs_of(&history), tolerance);
        let Some(whole) = plane.passage(&history.n, &self.v, pressed.depth_m) else { return false };
        let least_s = LEAST_RAD / world.springs_of(&history).omega_rad_s();
        let (mut passage, mut share) = (whole, 1.0);
        loop {
            if passage.time_s() <= h_max
                && let Some(rebound) =
                    self.passage_on_plane(world, (&plane, &passage), (&history, &pressed))
            {
                self.accept_rebound(world, &rebound, done);
                return true;
            }
            share *= 0.5;
            passage = plane.part(&whole, share);
            if passage.time_s() < least_s {
                return false;
            }
        }
    }

    /// The only contact of a rock that rebounds from a face, and its penetration; `None` if there
    /// is another, or none. An impact on a stem that may break is stepped, so that it can break at
    /// its time.
    ///
    /// The penetration follows from the position: contact points may have been found elsewhere.
    fn pressed_in_plane(
        &self,
        world: &ContactEnvironment,
    ) -> Option<(ContactHistory, InitialDeformation)> {
        if !is_on_face(world, self) || self.may_yield {
            return None;
        }
        let (history, depth_m) = (self.histories[0], self.plane_penetration_m(world));
        let is_penetrating = depth_m > 2.0 * TOUCH * world.body.radius;
        match (history.closed, is_penetrating) {
            _ if history.captured => None,
            // just begun: the closed form starts at penetration 0
            (false, false) => Some((history, InitialDeformation::NONE)),
            (true, true) if history.announced => {
                let pressed =
                    InitialDeformation { depth_m, shear_m: history.shear, roll_rad: history.roll };
                Some((history, pressed))
            }
            _ => None,
        }
    }

    /// Motion after a `passage` on which the rock touches nothing but the plane, if that holds.
    fn passage_on_plane(
        &mut self,
        world: &ContactEnvironment,
        (plane, passage): (&Plane, &NormalPassage),
        (history, pressed): (&ContactHistory, &InitialDeformation),
    ) -> Option<Rebound> {
        let (n, face) = (&history.n, history.feature.id);
        // the path is enclosed between the deepest position and the surface, from which the rock
        // has come
        let surface = self.c + n * pressed.depth_m;
        let encloses = |shift: &Vec3, change_m_s: f64| {
            let (time_s, deepest_m) = (passage.time_s(), passage.deepest_m());
            PressedPath::of(n, surface, (shift, change_m_s), time_s, deepest_m)
        };
        let slip_m_s = world.body.slip(n, &self.v, &self.w).norm();
        let friction_m_s = world.springs_of(history).limits().caps(passage.blow_m_s()).0;
        // springs at rest change the velocity in one direction; stretched ones may reverse it, up
        // to the limit of friction
        let is_whole = pressed.depth_m == 0.0 && passage.leaves();
        let most_m_s = friction_m_s + world.body.gravity.norm() * passage.time_s();
        let likely_m_s =
            if is_whole { friction_m_s.min(SLIP_STOPPED * slip_m_s) } else { most_m_s };
        let straight = encloses(&(self.v * passage.time_s()), likely_m_s);
        if straight.reach_m + pressed.depth_m > self.near.margin_left_m(&self.c) {
            let c = self.c;
            self.collect(world, &c);
        }
        if !self.is_alone_on(face, &straight) {
            return None;
        }
        let rebound = plane.pass(passage, (&self.v, &self.w), pressed);
        let along_m_s = PressedPath::tangent(n, &(rebound.velocity_m_s - self.v)).norm();
        let change_m_s = if is_whole { along_m_s } else { most_m_s };
        self.is_alone_on(face, &encloses(&rebound.shift_m, change_m_s)).then_some(rebound)
    }

    /// Whether nothing but the plane of `face` is touched on a `path`, within the known features.
    fn is_alone_on(&self, face: u32, path: &PressedPath) -> bool {
        let beyond = (path.start - self.c).norm();
        path.reach_m + beyond <= self.near.margin_left_m(&self.c)
            && self.near.meets_only_plane(face, path)
    }

    /// Accepts the end of a passage.
    fn accept_rebound(
        &mut self,
        world: &ContactEnvironment,
        rebound: &Rebound,
        done: &mut Advance,
    ) {
        self.c += rebound.shift_m;
        (self.v, self.w) = (rebound.velocity_m_s, rebound.spin_rad_s);
        self.fresh = false;
        done.dt += rebound.time_s;
        done.steps += u64::from(rebound.effort.steps);
        done.rejected += u64::from(rebound.effort.rejected);
        let triangle = self.histories[0].triangle;
        done.loss.add(&rebound.loss.on(world, triangle), 1.0);
        let Some(pressed) = &rebound.pressed else {
            self.histories.clear();
            self.balance(world);
            self.impact.forget();
            return;
        };
        let law = world.springs_of(&self.histories[0]);
        self.impact.elapse(law.omega_rad_s() * rebound.time_s);
        if self.impact.left_rad <= 0.0 {
            self.balance(world);
        }
        let history = &mut self.histories[0];
        let at = ContactDeformation {
            n: history.n,
            penetration: pressed.depth_m,
            shear: pressed.shear_m,
            roll: pressed.roll_rad,
        };
        let action =
            ContactForces::of(&world.body, &law, &law.normal(false), &at, (&self.v, &self.w));
        (history.shear, history.roll) = (at.shear, at.roll);
        history.normal_force = action.normal[0];
        history.slides = law.shear.slides2(action.shear.trial_force2, action.normal[0]);
        history.closed = true;
    }
}
