//! A sphere on soil: how impacts and slip change the laws of the grounds, and how soil slows the
//! rock.
//!
//! Laws and speed change between steps only, so all schemes are treated alike.
//!
//! Two laws, each on grounds that ask for it: the scar of Lu et al. (2019), `solver::scar`, and
//! friction that grows with slip of Leine et al. (2014), `solver::slip`. A third law, restitution
//! that falls with impact speed, belongs to the ground itself (`Law::set_impact_speed`).

use super::sphere::{SlippingContact, SphereSimulation};
use crate::contact::MAX_CONTACTS;
use crate::contact::history::ContactHistory;
use crate::rock::Vec3;
use crate::solver::impact_point::Blow;
use crate::solver::scar::GroundBlow;
use arrayvec::ArrayVec;

/// Approximate growth of `κ s` within one step (–): friction changes between steps only. It is
/// evaluated at the middle of the step, so that the remaining error is of second order in it.
const GROWTH_OF_STEP: f64 = 0.02;

impl SphereSimulation<'_> {
    /// Applies the impacts of the last step to soil and dashpots: the rock enters the soil that it
    /// hit, and the contacts, or in the rigid limit the grounds, get the damping of their impact
    /// speed. Returns the fraction of the speed that the rock keeps (–).
    ///
    /// Order: soil slows the rock first; the dashpots are those of the remaining speed. The
    /// fraction is a factor on the velocity: the direction stays, and the spin is unchanged because
    /// drag acts at the centre.
    pub(super) fn apply_blows(&mut self) -> f64 {
        if self.state.blows.is_empty() {
            return 1.0;
        }
        let speed_factor = if self.soil.scars.are_any() { self.enter_soil() } else { 1.0 };
        self.slow(speed_factor);
        let world = self.settings.contact_environment(self.body, self.laws);
        for blow in &self.state.blows {
            // a contact that persists beside it keeps its own damping
            let ratio = world.law(blow.triangle).ratio_at(speed_factor * blow.approach_m_s);
            let is_struck = |history: &&mut ContactHistory| {
                (history.triangle, history.n) == (blow.triangle, blow.n)
            };
            if let Some((ratio, history)) =
                ratio.zip(self.state.histories.iter_mut().find(is_struck))
            {
                history.damping_ratio = ratio;
            }
        }
        let ground_and_speed =
            |blow: &Blow| (world.ground_of(blow.triangle), speed_factor * blow.approach_m_s);
        let mut struck: ArrayVec<(u16, f64), MAX_CONTACTS> =
            self.state.blows.iter().map(ground_and_speed).collect();
        self.state.blows.clear();
        // the fastest on each ground comes last
        struck.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (ground, approach_m_s) in struck {
            self.laws[usize::from(ground)].set_impact_speed(approach_m_s);
        }
        speed_factor
    }

    /// Fraction of its speed that the rock keeps as it enters the soil that it hits (–).
    fn enter_soil(&mut self) -> f64 {
        let world = self.settings.contact_environment(self.body, self.laws);
        let (state, scars) = (&self.state, &mut *self.soil.scars);
        let holding = state.histories.iter().chain(state.upcoming_impacts.iter());
        let in_soil = scars.is_in_soil(&world, holding.map(|history| history.triangle));
        let blow = |&Blow { approach_m_s, n: normal, triangle }: &Blow| {
            let ground = world.ground_of(triangle);
            GroundBlow { ground, normal, approach_m_s, of_point_m_s: approach_m_s }
        };
        let struck: ArrayVec<GroundBlow, MAX_CONTACTS> = state.blows.iter().map(blow).collect();
        scars.enter(&self.body, &struck, (state.v.norm(), in_soil))
    }

    /// Prepares a step: applies impacts, updates the friction that grows with slip, and returns the
    /// longest step (s). That is the least of what stems, scars and growing friction allow.
    pub(super) fn before_step(&mut self) -> f64 {
        let longest_s = self.in_contact().before_step();
        self.apply_blows();
        self.state.plane.ploughs = self.soil.scars.are_any();
        let speed_factor = self.soil.scars.plough_ahead();
        self.slow(speed_factor);
        let mut longest_s = longest_s.min(self.soil.scars.longest_s(self.state.v.norm()));
        if self.soil.slip.has_growing_friction() {
            self.soil.fastest_slip = self.find_fastest_slip();
            let speed_m_s = self.soil.fastest_slip.map_or(0.0, |slip| slip.speed_m_s);
            // d(κ s)/dt = κ |slip|: a step of GROWTH/per_s lets κ s grow by that much
            let per_s = self.soil.slip.fastest_per_m() * speed_m_s;
            longest_s = longest_s.min(GROWTH_OF_STEP / per_s);
            // friction of the middle of the step
            self.update_friction(0.5 * speed_m_s * longest_s.min(self.soil.last_step_s));
        }
        longest_s
    }

    /// After a step of `dt` (s) that began with the centre at `before`: drag of ploughing, slip,
    /// and the speed that leaving a scar takes.
    ///
    /// Distances are those of the step just taken: for ploughing that of the centre, for friction
    /// the slip of the contact point (mean of both ends).
    pub(super) fn soil_after_step(&mut self, before: &Vec3, dt: f64) {
        self.soil.last_step_s = dt;
        if self.soil.scars.are_any() {
            let world = self.settings.contact_environment(self.body, self.laws);
            let contacts = self.state.histories.iter().map(|history| (history.triangle, history.n));
            let floor = self.soil.scars.floor(&world, contacts);
            let path_length_m = (self.state.c - before).norm();
            let velocity_if_free = self.state.is_free().then_some(self.state.v);
            let speed_factor =
                self.soil.scars.plough(&self.body, (path_length_m, floor), velocity_if_free);
            self.slow(speed_factor);
        }
        if let Some(SlippingContact { speed_m_s, n, ground }) = self.soil.fastest_slip.take() {
            let after_m_s = self.body.slip(&n, &self.state.v, &self.state.w).norm();
            self.soil.slip.grow(0.5 * (speed_m_s + after_m_s) * dt, Some(ground));
        }
    }

    /// Multiplies the velocity by `speed_factor`. The energy `ΔE = m v² (1 − speed_factor²)/2` goes
    /// to the soil.
    fn slow(&mut self, speed_factor: f64) {
        if speed_factor >= 1.0 {
            return;
        }
        let v = self.recorder.slow_in_soil(&self.state.v, speed_factor);
        let world = self.settings.contact_environment(self.body, self.laws);
        self.state.redirect(&world, v, self.state.w);
    }

    /// Sets the friction of the grounds to that of the slip distance so far plus `ahead_m` (m).
    ///
    /// The stepper is told only where the value changes in some bit: a redirect discards what it
    /// knows of the last step.
    fn update_friction(&mut self, ahead_m: f64) {
        let mut changes = false;
        for (ground, law) in self.laws.iter_mut().enumerate() {
            let friction = self.soil.slip.friction(ground as u16, law, ahead_m);
            changes |= law.set_friction(friction);
        }
        if changes {
            let (v, w) = (self.state.v, self.state.w);
            let world = self.settings.contact_environment(self.body, self.laws);
            self.state.redirect(&world, v, w);
        }
    }

    /// The contact with the largest slip speed of those that hold the rock.
    fn find_fastest_slip(&self) -> Option<SlippingContact> {
        let world = self.settings.contact_environment(self.body, self.laws);
        let slip_of = |history: &ContactHistory| {
            let speed_m_s = self.body.slip(&history.n, &self.state.v, &self.state.w).norm();
            SlippingContact { speed_m_s, n: history.n, ground: world.ground_of(history.triangle) }
        };
        let fastest = |a: SlippingContact, b: SlippingContact| {
            if b.speed_m_s > a.speed_m_s { b } else { a }
        };
        self.state.histories.iter().map(slip_of).reduce(fastest)
    }
}
