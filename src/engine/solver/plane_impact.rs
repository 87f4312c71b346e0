//! What is left of an impact on one plane, at once.
//!
//! On a plane the normal motion of an impact is a closed form, and slip and spin follow under its
//! known force (`impact::plane`): no contact search, no stages. What it needs is the certificate
//! that nothing but this plane is touched on the way: the way is enclosed in a rectangle along and
//! into the plane, widened by what it may bulge, and all features collected around are held against
//! it. That is nearly always so from the touch on; an impact that began at a fold or an edge is
//! taken up where it has left it.

use super::contact_state::{ContactEnvironment, ContactState};
use super::impact::{ContactDeformation, NormalPassage, Plane, Rebound};
use super::law::{Action, ContactPlace};
use super::plane_kernel::is_on_face;
use super::step_control::Advance;
use crate::contact::TOUCH;
use crate::contact::history::ContactHistory;
use crate::contact::neighbours::PressedPath;
use crate::rock::Vec3;

/// Share of its slip that an impact is taken to stop, at most, before that is known (–): one that loses nothing turns it round.
const STOPS: f64 = 0.5;

/// Least part of an impact that is worth following by itself (rad of the contact).
const LEAST_RAD: f64 = 0.5;

impl ContactState {
    /// What is left of an impact on one plane, if it is one: nothing else can be touched as far as the rock gets, and the rock comes
    /// out again within `h_max` (s). Where something else is touched later, the part before: a half, or a quarter, of the time.
    /// `tolerance` as in [`Self::step_impact`].
    ///
    /// Returns false and changes nothing where it is none: then the impact is followed step by
    /// step.
    pub(crate) fn bounce(
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
                    self.pass_alone(world, (&plane, &passage), (&history, &pressed))
            {
                self.accept_bounce(world, &rebound, done);
                return true;
            }
            share *= 0.5;
            passage = plane.part(&whole, share);
            if passage.time_s() < least_s {
                return false;
            }
        }
    }

    /// The one contact of a rock that rebounds from a face, and how far it is in; `None` if there is another, or none. A stem that may
    /// break is stepped, so that it can break on time.
    ///
    /// Where it is tells how far it is in: touches may have been looked for elsewhere.
    fn pressed_in_plane(
        &self,
        world: &ContactEnvironment,
    ) -> Option<(ContactHistory, ContactDeformation)> {
        if !is_on_face(world, self) || self.may_yield {
            return None;
        }
        let (history, depth_m) = (self.histories[0], self.sunk(world));
        let is_sunk = depth_m > 2.0 * TOUCH * world.body.radius;
        match (history.closed, is_sunk) {
            _ if history.captured => None,
            // it has just begun: the closed form is that from penetration 0
            (false, false) => Some((history, ContactDeformation::NONE)),
            (true, true) if history.announced => {
                let pressed =
                    ContactDeformation { depth_m, shear_m: history.shear, roll_rad: history.roll };
                Some((history, pressed))
            }
            _ => None,
        }
    }

    /// Where and how the rock is after a `passage` on which it touches nothing but the plane, if that is so.
    fn pass_alone(
        &mut self,
        world: &ContactEnvironment,
        (plane, passage): (&Plane, &NormalPassage),
        (history, pressed): (&ContactHistory, &ContactDeformation),
    ) -> Option<Rebound> {
        let (n, face) = (&history.n, history.feature.id);
        // the way is enclosed between the deepest place and the surface, from which the rock has come
        let surface = self.c + n * pressed.depth_m;
        let encloses = |shift: &Vec3, change_m_s: f64| {
            let (time_s, deepest_m) = (passage.time_s(), passage.deepest_m());
            PressedPath::of(n, surface, (shift, change_m_s), time_s, deepest_m)
        };
        let slip_m_s = world.body.slip(n, &self.v, &self.w).norm();
        let rubbed_m_s = world.springs_of(history).limits().caps(passage.blow_m_s()).0;
        // springs at rest change the velocity one way; stretched ones may turn it round, by all that friction bears
        let is_whole = pressed.depth_m == 0.0 && passage.leaves();
        let most_m_s = rubbed_m_s + world.body.gravity.norm() * passage.time_s();
        let likely_m_s = if is_whole { rubbed_m_s.min(STOPS * slip_m_s) } else { most_m_s };
        let straight = encloses(&(self.v * passage.time_s()), likely_m_s);
        if straight.way_m + pressed.depth_m > self.near.room_m(&self.c) {
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

    /// Whether nothing but the plane of `face` is touched on a `path`, as far as features are known.
    fn is_alone_on(&self, face: u32, path: &PressedPath) -> bool {
        let beyond = (path.start - self.c).norm();
        path.way_m + beyond <= self.near.room_m(&self.c) && self.near.is_plane_on(face, path)
    }

    /// Takes over the end of a passage.
    fn accept_bounce(&mut self, world: &ContactEnvironment, rebound: &Rebound, done: &mut Advance) {
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
        self.impact.pass(law.omega_rad_s() * rebound.time_s);
        if self.impact.left <= 0.0 {
            self.balance(world);
        }
        let history = &mut self.histories[0];
        let at = ContactPlace {
            n: history.n,
            penetration: pressed.depth_m,
            shear: pressed.shear_m,
            roll: pressed.roll_rad,
        };
        let action = Action::of(&world.body, &law, &law.normal(false), &at, (&self.v, &self.w));
        (history.shear, history.roll) = (at.shear, at.roll);
        history.normal_force = action.normal[0];
        history.slides = law.shear.slides2(action.shear.asked2, action.normal[0]);
        history.closed = true;
    }
}
