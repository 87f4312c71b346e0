//! A whole impact on one plane at once.
//!
//! On a plane the normal motion of an impact is a closed form, and slip and spin follow under its
//! known force (`impact::plane`): no contact search, no stages. What it needs is the certificate
//! that nothing but this plane is touched on the way: the way is enclosed in a rectangle along and
//! into the plane, widened by what it may bulge, and all features collected around are held against
//! it.

use super::contact_state::{ContactEnvironment, ContactState};
use super::impact::{Followed, Plane};
use super::step_control::Advance;
use crate::contact::TOUCH;
use crate::contact::neighbours::PressedPath;
use crate::contact::{ContactPoint, FeatureKind};
use crate::ground::NormalElement;

impl ContactState {
    /// All of an impact on one plane, if it is one: nothing else can be touched as far as the rock gets, springs are
    /// unstretched, and the rock comes out again within `h_max` (s). `tolerance` as in [`Self::step_impact`].
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
        // one contact that has just begun, on the inside of a face; a stem that may break is
        // stepped, so that it can break on time
        let [history] = &self.histories[..] else { return false };
        let (face, is_face) = (history.feature.id, history.feature.kind == FeatureKind::Face);
        let begins = !history.closed && is_face;
        if !begins
            || !NormalElement::has_closed_form()
            || self.may_yield
            || self.touches.iter().any(|touch| is_sunk(world, touch))
        {
            return false;
        }
        let (n, triangle) = (history.n, history.triangle);
        let plane = Plane::new(&world.body, world.law(triangle), tolerance);
        let Followed::Left(rebound) = plane.follow(&n, &self.v, &self.w) else { return false };
        let change = rebound.velocity_m_s - self.v;
        let moved = (&rebound.shift_m, &change);
        let passage = PressedPath::of(&n, self.c, moved, rebound.time_s, rebound.deepest_m);
        // features are collected as far as the rock gets, or the certificate is worth nothing
        let is_known = passage.way_m <= self.near.room_m(&self.c);
        if rebound.time_s > h_max || !is_known || !self.near.is_plane_on(face, &passage) {
            return false;
        }
        self.c += rebound.shift_m;
        (self.v, self.w) = (rebound.velocity_m_s, rebound.spin_rad_s);
        self.histories.clear();
        self.fresh = false;
        self.impact.forget();
        done.dt = rebound.time_s;
        done.steps = u64::from(rebound.effort.steps);
        done.rejected = u64::from(rebound.effort.rejected);
        done.loss = rebound.loss.on(world, triangle);
        true
    }
}

/// Whether a touch is pressed in by more than rounding.
/// The closed form begins at penetration 0; from deeper in it would not be the same impact.
fn is_sunk(world: &ContactEnvironment, touch: &ContactPoint) -> bool {
    world.body.radius - touch.distance_m > 2.0 * TOUCH * world.body.radius
}
