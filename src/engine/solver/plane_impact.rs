//! What is left of an impact on one plane, at once.
//!
//! On a plane the normal motion of an impact is a closed form, and slip and spin follow under its
//! known force (`impact::plane`): no contact search, no stages. What it needs is the certificate
//! that nothing but this plane is touched on the way: the way is enclosed in a rectangle along and
//! into the plane, widened by what it may bulge, and all features collected around are held against
//! it. That is nearly always so from the touch on; an impact that began at a fold or an edge is
//! taken up where it has left it.

use super::contact_state::{ContactEnvironment, ContactState};
use super::impact::{NormalPassage, Plane, PressedIn, Rebound};
use super::law::{Action, ContactPlace};
use super::step_control::Advance;
use crate::contact::TOUCH;
use crate::contact::history::ContactHistory;
use crate::contact::neighbours::PressedPath;
use crate::contact::{ContactPoint, FeatureKind};
use crate::ground::NormalElement;
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
        let plane = Plane::new(&world.body, world.law(history.triangle), tolerance);
        let Some(whole) = plane.passage(&history.n, &self.v, pressed.depth_m) else { return false };
        let least_s = LEAST_RAD / world.law(history.triangle).omega_rad_s();
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

    /// The one contact of a rock that rebounds from the inside of a face, and how far it is in; `None` if there is another, or none. A
    /// stem that may break is stepped, so that it can break on time.
    fn pressed_in_plane(&self, world: &ContactEnvironment) -> Option<(ContactHistory, PressedIn)> {
        let [history] = &self.histories[..] else { return None };
        let is_face = history.feature.kind == FeatureKind::Face;
        if !is_face || history.captured || !NormalElement::has_closed_form() || self.may_yield {
            return None;
        }
        if !history.closed {
            // it has just begun: the closed form is that from penetration 0
            let is_sunk = self.touches.iter().any(|touch| sunk_m(world, touch) > 0.0);
            return (!is_sunk).then_some((*history, PressedIn::NOT));
        }
        let [touch] = &self.touches[..] else { return None };
        let is_same = touch.is_on_plane() && touch.feature == history.feature;
        let depth_m = world.body.radius - touch.distance_m;
        (is_same && sunk_m(world, touch) > 0.0 && history.announced).then_some((
            *history,
            PressedIn { depth_m, shear_m: history.shear, roll_rad: history.roll },
        ))
    }

    /// Where and how the rock is after a `passage` on which it touches nothing but the plane, if that is so.
    fn pass_alone(
        &mut self,
        world: &ContactEnvironment,
        (plane, passage): (&Plane, &NormalPassage),
        (history, pressed): (&ContactHistory, &PressedIn),
    ) -> Option<Rebound> {
        let n = &history.n;
        // the way is enclosed between the deepest place and the surface, from which the rock has come
        let surface = self.c + n * pressed.depth_m;
        let encloses = |shift: &Vec3, change: &Vec3| {
            PressedPath::of(n, surface, (shift, change), passage.time_s(), passage.deepest_m())
        };
        let slip = world.body.slip(n, &self.v, &self.w);
        let rubbed = world.law(history.triangle).limits().caps(passage.blow_m_s()).0;
        let change = slip.cap_magnitude(rubbed.min(STOPS * slip.norm()));
        let straight = encloses(&(self.v * passage.time_s()), &change);
        if straight.way_m + pressed.depth_m > self.near.room_m(&self.c) {
            let c = self.c;
            self.collect(world, &c);
        }
        if !self.is_alone_on(history.feature.id, &straight) {
            return None;
        }
        let rebound = plane.pass(passage, (&self.v, &self.w), pressed);
        let taken = encloses(&rebound.shift_m, &(rebound.velocity_m_s - self.v));
        self.is_alone_on(history.feature.id, &taken).then_some(rebound)
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
        let law = world.law(triangle);
        self.impact.pass(law.omega_rad_s() * rebound.time_s);
        let history = &mut self.histories[0];
        let at = ContactPlace {
            n: history.n,
            penetration: pressed.depth_m,
            shear: pressed.shear_m,
            roll: pressed.roll_rad,
        };
        let action = Action::of(&world.body, law, &law.normal(false), &at, (&self.v, &self.w));
        (history.shear, history.roll) = (at.shear, at.roll);
        history.normal_force = action.normal[0];
        history.slides = law.shear.slides2(action.asked2[0], action.normal[0]);
        history.closed = true;
        let c = self.c;
        self.look(world, &c, world.body.radius * (1.0 + TOUCH));
    }
}

/// How far a touch is pressed in (m), by more than rounding.
fn sunk_m(world: &ContactEnvironment, touch: &ContactPoint) -> f64 {
    (world.body.radius - touch.distance_m - 2.0 * TOUCH * world.body.radius).max(0.0)
}
