//! A long step of a rock that slides or rolls on one plane.
//!
//! With one normal, the impulses of the limit of stiff springs depend on the step length only where
//! friction changes its direction, slipping ends, or the rock comes to rest. So a step is taken as
//! a whole and in two halves. Where both agree, the step may be as long as the plane is clear; the
//! result is that of the halves.

use super::contact::{GroundContact, sustained_m_s};
use super::sustained::push_out;
use super::{HELD, update_histories};
use crate::contact::ContactPoint;
use crate::rock::Vec3;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::friction_rolling::SlipState;
use crate::solver::loss::Loss;
use crate::solver::plane_ahead::PlaneStep;
use crate::solver::step_control::Advance;

/// Longest step on a plane over the longest elsewhere (–).
const LONGEST_FACTOR: f64 = 10.0;
/// A longer step is tried only if it exceeds the usual one by this factor (–) …
const WORTH: f64 = 2.0;
/// … and the travel is at least this (–, relative to R): a slow rock must be checked for rest after
/// every step.
const LEAST_TRAVEL: f64 = 0.05;
/// Growth of the next step, after one that was accepted and after one that was not tried (–).
const GROWTH: (f64, f64) = (2.0, 1.5);
/// Difference allowed between a step as a whole and in halves, of velocities and of positions (–,
/// relative to the change by gravity in the longest usual step): a small part of the error of such
/// a step; first for smooth steps, then where friction turns or slipping or rolling ends.
const ERROR: (f64, f64) = (0.02, 0.001);

/// Motion on the plane at a time, and the energy taken since the step's start.
#[derive(Debug, Clone, Copy)]
struct Slide {
    c: Vec3,
    v: Vec3,
    w: Vec3,
    /// Height over the plane less the radius (m).
    gap: f64,
    loss: Loss,
    /// Mode of friction and rolling friction.
    mode: SlipState,
}

/// The only plane that holds the rock.
struct PlaneContact<'a, 'w> {
    world: &'a ContactEnvironment<'w>,
    touch: ContactPoint,
}

impl PlaneContact<'_, '_> {
    /// The motion after `dt` (s), with the mean velocity during the step; `None` without a normal
    /// impulse.
    fn after(&self, from: &Slide, dt: f64) -> Option<Slide> {
        let Self { world, touch } = self;
        let (body, n) = (&world.body, touch.normal);
        let mut contact = GroundContact::new(0, touch, world.law(touch.triangle));
        contact.target_m_s = sustained_m_s(from.gap, n.dot(&from.v), dt);
        let free = from.v + body.gravity * dt;
        contact.solve_for(body, &free, &from.w);
        if contact.normal_impulse <= 0.0 {
            return None;
        }
        let (dv, dw) = contact.velocity_change(body);
        let (v, w) = (free + dv, from.w + dw);
        let mean = (0.5 * (from.v + v), 0.5 * (from.w + w));
        let mut loss = from.loss;
        loss.add(&contact.loss(body, &mean), 1.0);
        let gap = from.gap + n.dot(&mean.0) * dt;
        Some(Slide { c: from.c + mean.0 * dt, v, w, gap, loss, mode: contact.mode })
    }

    /// The motion in two halves, if it agrees with the whole step within a part of the error of
    /// steps of `usual` (s). Else the time at which slipping or rolling ends within the step (s),
    /// if it does.
    fn in_halves(&self, from: &Slide, dt: f64, usual: f64) -> Result<Slide, Option<f64>> {
        let whole = self.after(from, dt).ok_or(None)?;
        let half = self.after(from, 0.5 * dt).ok_or(None)?;
        let end = self.after(&half, 0.5 * dt).ok_or(None)?;
        let body = &self.world.body;
        let is_smooth = half.has_mode_of(&whole) && half.has_mode_of(&end);
        let error = if is_smooth { ERROR.0 } else { ERROR.1 };
        let allowed = error * body.gravity.norm() * usual;
        let error_rate2 = (whole.v - end.v)
            .norm_squared()
            .max((whole.w - end.w).norm_squared() * body.radius * body.radius)
            .max((whole.c - end.c).norm_squared() / (usual * usual));
        if error_rate2 <= allowed * allowed {
            return Ok(end);
        }
        Err(self
            .halves_to_mode_change(from, &half)
            .map(|halves| 0.5 * dt * halves)
            .filter(|_| !is_smooth))
    }

    /// Number of halves of the step after which slipping or rolling ends, extrapolated from the
    /// first half.
    fn halves_to_mode_change(&self, from: &Slide, half: &Slide) -> Option<f64> {
        let (body, n) = (&self.world.body, &self.touch.normal);
        let slip = |slide: &Slide| body.slip(n, &slide.v, &slide.w).norm();
        let [before, after] = match half.mode {
            SlipState::Slide | SlipState::Both(_) => [from, half].map(slip),
            SlipState::Roll(_) => [from, half].map(|slide| slide.w.norm()),
            SlipState::Stick => return None,
        };
        (after < before).then(|| before / (before - after))
    }
}

impl Slide {
    /// Whether both are in the same mode of slipping and rolling.
    fn has_mode_of(&self, other: &Self) -> bool {
        std::mem::discriminant(&self.mode) == std::mem::discriminant(&other.mode)
    }
}

impl ContactState {
    /// A step on the plane that holds the rock, at most `h_max` (s) long; returns whether one
    /// longer than the usual step elsewhere, `usual` (s), was taken.
    pub(super) fn slide_on_plane(
        &mut self,
        world: &ContactEnvironment,
        (usual, longest): (f64, f64),
        h_max: f64,
        done: &mut Advance,
    ) -> bool {
        let (speed, body) = (self.v.norm(), &world.body);
        let least = WORTH * usual;
        let proposed = self.plane.proposed_s.min(LONGEST_FACTOR * longest).min(h_max);
        if proposed < least || speed * proposed < LEAST_TRAVEL * body.radius {
            self.plane.proposed_s *= GROWTH.1;
            return false;
        }
        let Some(contact) = self.plane_contact(world) else { return false };
        let face = contact.touch.feature.id;
        let clear = self.longest_on_plane_s(world, face, (proposed, usual * speed));
        let from = Slide {
            c: self.c,
            v: self.v,
            w: self.w,
            gap: contact.touch.distance_m - body.radius,
            loss: Loss::default(),
            mode: SlipState::default(),
        };
        let step = PlaneStep { face, n: contact.touch.normal, start: self.c };
        let (tried, mut is_cut) = (proposed.min(clear), false);
        let mut dt = tried;
        while dt >= least || is_cut {
            self.sweeps += 3;
            match contact.in_halves(&from, dt, usual) {
                Ok(end) => {
                    let moved = (&(end.c - from.c), &(end.v - from.v));
                    if step.touches_plane_only((world, &self.near), moved, dt) {
                        self.slide_to(world, (&end, contact.touch.triangle), dt, done);
                        self.plane.proposed_s = if is_cut { tried } else { GROWTH.0 * dt };
                        return true;
                    }
                    is_cut = false;
                    dt *= 0.5;
                }
                // at this time the mode changes
                Err(Some(ends)) if ends < dt && !is_cut => (dt, is_cut) = (ends, true),
                Err(_) => (dt, is_cut) = (0.5 * dt, false),
            }
            done.rejected += 1;
        }
        self.plane.proposed_s = usual;
        false
    }

    /// Accepts a step of `dt` (s) on the plane of a triangle.
    fn slide_to(
        &mut self,
        world: &ContactEnvironment,
        (end, triangle): (&Slide, u32),
        dt: f64,
        done: &mut Advance,
    ) {
        (self.c, self.v, self.w) = (end.c, end.v, end.w);
        done.loss.add(&end.loss.on(world, triangle), 1.0);
        done.dt = dt;
        push_out(world, self);
        update_histories(world, self, true);
    }

    /// The only plane of the ground that holds the rock, by the last contact search.
    fn plane_contact<'a, 'w>(
        &self,
        world: &'a ContactEnvironment<'w>,
    ) -> Option<PlaneContact<'a, 'w>> {
        let reach = world.body.radius * (1.0 + HELD);
        let mut held = self.touches.iter().filter(|touch| touch.distance_m <= reach);
        let touch = *held.next()?;
        let is_plane =
            held.next().is_none() && touch.is_on_plane() && !world.terrain.is_tree(touch.triangle);
        is_plane.then_some(PlaneContact { world, touch })
    }
}
