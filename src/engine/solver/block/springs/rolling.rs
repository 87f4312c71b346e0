//! The rolling spring of a block: one for all contacts, because they rotate one body.
//!
//! Spring and dashpot are those of the first ground with rolling friction that the block has met in
//! an episode of contact; the slider's capacity is the sum over the contacts.

use super::SpringContact;
use crate::ground::{FrictionElement, SliderForce};
use crate::rock::Vec3;
use crate::solver::block::rolling::RollingImpulse;
use crate::solver::block::solve::first_guess;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;

/// The rolling spring of a block, and its moment.
#[derive(Debug, Default)]
pub(super) struct RollingSpring {
    /// Spring and dashpot; none until a ground with rolling friction is met.
    element: Option<FrictionElement>,
    /// Its stretch at the step's start, and at the base of the current stage (rad).
    pub(super) stretch: Vec3,
    base: Vec3,
    /// Its moment against the spin of the block (N m).
    moment: Vec3,
    /// Impulse on the block of the last solve (N m s): the next initial guess.
    impulse: Vec3,
}

impl RollingSpring {
    /// Adopts the element of the first of these contacts that has one.
    pub(super) fn adopt_element(&mut self, contacts: &[SpringContact]) {
        if self.element.is_none() {
            let elements = contacts.iter().map(|contact| contact.law.rolling);
            self.element = elements.into_iter().find(FrictionElement::is_on);
        }
    }

    /// Whether there is rolling friction.
    pub(super) fn is_on(&self) -> bool {
        self.element.is_some()
    }

    /// Its impulse over a stage in which it acts for `a` and the block turns for `b` (s), from a
    /// stretch at its base (rad).
    pub(super) fn stage_compliance(&mut self, base: &Vec3, times_s: (f64, f64)) -> RollingImpulse {
        self.base = *base;
        match &self.element {
            Some(element) => {
                RollingImpulse::of_stage(element, base, times_s).with_guess(self.impulse)
            }
            None => RollingImpulse::NONE,
        }
    }

    /// Sets the moment from an impulse that has acted for `a` (s).
    pub(super) fn set_moment(&mut self, rolling: &RollingImpulse, a: f64) {
        self.moment = rolling.impulse / -a;
        self.impulse = first_guess(rolling.impulse);
    }

    /// Sets the moment at the spin `w` (rad/s), for the present normal forces of its contacts.
    pub(super) fn update_moment(&mut self, contacts: &[SpringContact], w: &Vec3) -> SliderForce {
        self.base = self.stretch;
        let Some(element) = &self.element else { return SliderForce::default() };
        let pressed = element.at_rate(self.stretch, *w, limit_n_m(contacts));
        self.moment = pressed.force;
        pressed
    }

    /// Mean rate of the stretch (rad/s) over a stage in which the block has turned for `b` (s).
    pub(super) fn rate_over(&self, b: f64) -> Vec3 {
        (self.stretch_after(b) - self.base) / b
    }

    /// Stretch after the block has turned for `b` (s) (rad).
    fn stretch_after(&self, b: f64) -> Vec3 {
        let after = |element: &FrictionElement| element.stretch_after(&self.moment, &self.base, b);
        self.element.as_ref().map_or_else(Vec3::zeros, after)
    }

    /// Sets the stretch to that of the end of a stage.
    pub(super) fn keep(&mut self, b: f64) {
        self.stretch = self.stretch_after(b);
    }

    /// Energy in it at the step's start (J).
    pub(super) fn stored_j(&self) -> f64 {
        self.energy_at(&self.stretch)
    }

    /// Energy in it at the end of a stage (J).
    pub(super) fn stored_after_j(&self, b: f64) -> f64 {
        self.energy_at(&self.stretch_after(b))
    }

    fn energy_at(&self, stretch: &Vec3) -> f64 {
        self.element
            .as_ref()
            .map_or(0.0, |element| 0.5 * element.spring_force(*stretch).dot(stretch))
    }

    /// Power into it (W) at a spin (rad/s), stored power included, distributed over its contacts.
    pub(super) fn power(
        &self,
        world: &ContactEnvironment,
        contacts: &[SpringContact],
        w: &Vec3,
    ) -> Loss {
        self.borne_by(world, contacts, self.moment.dot(w))
    }

    /// Energy (J) that slider and dashpot dissipate where the block turns with `w` (rad/s) for `b`
    /// (s), distributed over its contacts. The spring stores its moment at the end times its change
    /// of stretch.
    pub(super) fn dissipated(
        &self,
        world: &ContactEnvironment,
        contacts: &[SpringContact],
        (w, b): (&Vec3, f64),
    ) -> Loss {
        let end = self.stretch_after(b);
        let sprung = |element: &FrictionElement| element.spring_force(end).dot(&(end - self.base));
        let sprung_j = self.element.as_ref().map_or(0.0, sprung);
        self.borne_by(world, contacts, self.moment.dot(w) * b - sprung_j)
    }

    /// An amount (W or J), distributed over its contacts by their capacities.
    fn borne_by(
        &self,
        world: &ContactEnvironment,
        contacts: &[SpringContact],
        amount: f64,
    ) -> Loss {
        let (mut loss, all_n_m) = (Loss::default(), limit_n_m(contacts));
        if self.element.is_none() || all_n_m <= 0.0 {
            return loss;
        }
        let rolling = amount / all_n_m;
        for contact in contacts {
            let own = Loss { rolling, ..Loss::default() }.on(world, contact.triangle);
            loss.add(&own, contact.law.rolling.cap(contact.normal_force));
        }
        loss
    }
}

/// Largest moment of the contacts together (N m).
fn limit_n_m(contacts: &[SpringContact]) -> f64 {
    contacts.iter().map(|contact| contact.law.rolling.cap(contact.normal_force)).sum()
}
