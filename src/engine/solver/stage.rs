//! One implicit stage: the contact law solved with the geometry at the stage's end.
//!
//! The unknowns of a stage are velocity and spin at its end: with `h γ = hh`, `M (v − v_free)/hh`
//! equals the sum of the contact forces, which depend on `v` and `ω` through penetration, slip and
//! rolling. The solve is exact for given normals; an outer fixed-point iteration moves the normals
//! to the end position of the rock.
use super::contact_state::{ContactEnvironment, ContactState, StateRates};
use super::law::{ContactDeformation, ContactForces, StageContact};
use super::loss::Loss;
use super::multi_contact;
use super::tableau::Tableau;
use crate::contact::TOUCH;
use crate::contact::history::transport;
use crate::ground::NormalElement;
use crate::rock::Vec3;

/// Most passes of the fixed-point iteration between geometry and forces.
pub(crate) const PASSES: u32 = 10;
/// Change of the centre, relative to the radius, at which it has converged (–).
pub(crate) const SHIFT_CONVERGED: f64 = 1e-9;

impl StageContact {
    /// Power that goes into the contact (W) at velocity `v` and spin `w`, what its springs store
    /// included.
    pub(super) fn loss(
        &self,
        world: &ContactEnvironment,
        v: &Vec3,
        w: &Vec3,
        shear_rate: &Vec3,
    ) -> Loss {
        let slip = world.body.slip(&self.n, v, w);
        let others = [-self.normal_force * self.n.dot(v), self.rolling_moment.dot(w)];
        Loss::of_slip((&self.shear_force, &slip, shear_rate), others).on(world, self.triangle)
    }

    /// Sets the forces to those of the present state, for the explicit first stage; returns the
    /// rates of shear and rolling springs.
    pub(super) fn set_forces_now(
        &mut self,
        world: &ContactEnvironment,
        v: &Vec3,
        w: &Vec3,
    ) -> (Vec3, Vec3) {
        let at = ContactDeformation {
            n: self.n,
            penetration: self.penetration,
            shear: self.shear,
            roll: self.roll,
        };
        let law = &self.law;
        let action = ContactForces::of(&world.body, law, &self.normal, &at, (v, w));
        self.normal_force = action.normal[0];
        (self.shear_force, self.rolling_moment) = (action.shear.force, action.rolling.force);
        (action.shear.stretch_rate, action.rolling.stretch_rate)
    }
}

/// Position, velocity and spin at the base or at the end of a stage.
#[derive(Debug, Clone, Copy)]
pub struct StageMotion {
    /// Centre (m).
    pub c: Vec3,
    /// Velocity (m/s).
    pub v: Vec3,
    /// Spin (rad/s).
    pub w: Vec3,
}

impl ContactState {
    /// The base of implicit stage `i`: the state plus the explicit part of the earlier stages.
    pub(crate) fn base(&self, tableau: &Tableau, i: usize, h: f64) -> StageMotion {
        let base = |x, part: fn(&StateRates) -> Vec3| tableau.base((i, h), (x, &self.rates), part);
        StageMotion {
            c: base(self.c, |rate| rate.c),
            v: base(self.v, |rate| rate.v),
            w: base(self.w, |rate| rate.w),
        }
    }

    /// Solves implicit stage `i` of a step of length `h` and stores its rates; `None` if it does
    /// not converge.
    pub fn stage(
        &mut self,
        world: &ContactEnvironment,
        tableau: &Tableau,
        i: usize,
        h: f64,
    ) -> Option<StageMotion> {
        let base = self.base(tableau, i, h);
        let hh = tableau.diagonal * h;
        // free motion: weight acts, contacts do not
        let (vf, wf) = (base.v + world.body.gravity * hh, base.w);
        // extrapolated with velocity and acceleration of the stage before
        let before = &self.rates[i - 1];
        let mut guess = base.c + (before.c + before.v * hh) * hh;
        // contact points moved along their planes may have left their faces: the search at the end
        // must confirm them
        let mut is_current =
            !(self.near.covers(&guess) && self.touches.update_on_planes(world.terrain, &guess));
        if is_current {
            self.find_contact_points_ahead(world, &guess);
        }
        for _ in 0..PASSES {
            self.place_contacts(world, tableau, (i, h), (&base, &guess));
            let contacts = &mut self.contacts[..self.contact_count];
            let (v, w) =
                multi_contact::solve(&world.body, contacts, (vf, wf), hh, &mut self.sweeps)?;
            let c = base.c + v * hh;
            self.find_contact_points_ahead(world, &c);
            let moved = (c - guess).norm_squared();
            let agrees = is_current && moved <= (SHIFT_CONVERGED * world.body.radius).powi(2);
            if agrees || self.stays_on_faces() {
                let end = StageMotion { c, v, w };
                self.store(world, &base, &end, (i, hh));
                return Some(end);
            }
            (guess, is_current) = (c, true);
        }
        None
    }

    /// Whether the last search found the very faces that the forces were computed with. A plane is
    /// the same everywhere, so the forces are exact wherever the rock was when they were computed.
    #[inline]
    fn stays_on_faces(&self) -> bool {
        let contacts = self.stage_contacts();
        contacts.len() == self.touches.len()
            && contacts.iter().zip(self.touches.iter()).all(|(contact, touch)| {
                touch.is_on_plane() && touch.feature == contact.feature && touch.normal == contact.n
            })
    }

    /// Makes the contact points found last into contacts of the stage.
    pub(crate) fn place_contacts(
        &mut self,
        world: &ContactEnvironment,
        tableau: &Tableau,
        (i, h): (usize, f64),
        (base, at): (&StageMotion, &Vec3),
    ) {
        self.contact_count = self.touches.len();
        // each history belongs to at most one contact; bits mark those in use
        let mut taken = 0;
        for k in 0..self.contact_count {
            let history = self.history_of(world, k, taken, &base.v);
            taken |= 1 << history;
            let (contact_history, rates) = (&self.histories[history], &self.rates);
            let shear =
                tableau.base((i, h), (contact_history.shear, rates), |rate| rate.shear[history]);
            let roll =
                tableau.base((i, h), (contact_history.roll, rates), |rate| rate.roll[history]);
            let mut contact = self.contact_of(world, k, history, (shear, roll));
            contact.penetration =
                world.body.radius - self.touches[k].distance_m - contact.n.dot(&(base.c - at));
            if self.onset.deferred && contact_history.onset_m_s > 0.0 {
                contact.normal = NormalElement::NONE;
            }
            self.contacts[k] = contact;
        }
    }

    /// The contact at point `k` with the given spring stretches in the frame of its history, and no
    /// penetration yet.
    fn contact_of(
        &self,
        world: &ContactEnvironment,
        k: usize,
        history: usize,
        (shear, roll): (Vec3, Vec3),
    ) -> StageContact {
        let (touch, contact_history) = (&self.touches[k], &self.histories[history]);
        let law = world.law_of(contact_history, &self.touches, k);
        StageContact {
            history,
            feature: touch.feature,
            triangle: touch.triangle,
            normal: law.normal(contact_history.captured),
            n: touch.normal,
            penetration: 0.0,
            // turned with the normal, keeping its length
            shear: transport(shear, &contact_history.n, &touch.normal),
            roll,
            normal_force: contact_history.normal_force,
            shear_force: Vec3::zeros(),
            rolling_moment: Vec3::zeros(),
            // an initial guess only: the solver finds the mode itself
            mode: self.contacts[k].mode,
            law,
        }
    }

    /// Stores the rates of stage `i`.
    pub(crate) fn store(
        &mut self,
        world: &ContactEnvironment,
        base: &StageMotion,
        end: &StageMotion,
        (i, hh): (usize, f64),
    ) {
        let rate = &mut self.rates[i];
        // slopes of the stage, from base to end
        (rate.c, rate.v, rate.w) = (end.v, (end.v - base.v) / hh, (end.w - base.w) / hh);
        rate.loss = Loss::default();
        rate.clear(self.histories.len());
        for contact in &self.contacts[..self.contact_count] {
            let (shear, roll) = contact.stretches(hh);
            let (shear_rate, roll_rate) =
                ((shear - contact.shear) / hh, (roll - contact.roll) / hh);
            rate.shear[contact.history] =
                transport(shear_rate, &contact.n, &self.histories[contact.history].n);
            rate.roll[contact.history] = roll_rate;
            rate.loss.add(&contact.loss(world, &end.v, &end.w, &shear_rate), 1.0);
            self.onset.is_reached |= self.onset.deferred
                && self.histories[contact.history].onset_m_s > 0.0
                && contact.penetration_at(&end.v, hh) > 0.0;
        }
    }

    /// Rates at the present state, for the explicit first stage.
    pub fn rates_now(&mut self, world: &ContactEnvironment) {
        let (c, v, w) = (self.c, self.v, self.w);
        let body = &world.body;
        self.find_contact_points(world, &c, body.radius * (1.0 + TOUCH));
        // weight, then contact by contact
        self.rates[0] = StateRates { c: v, v: body.gravity, ..StateRates::NONE };
        let mut taken = 0;
        for k in 0..self.touches.len() {
            let history = self.history_of(world, k, taken, &v);
            taken |= 1 << history;
            let contact_history = &self.histories[history];
            let mut contact =
                self.contact_of(world, k, history, (contact_history.shear, contact_history.roll));
            contact.penetration = (body.radius - self.touches[k].distance_m).max(0.0);
            let (shear_rate, roll_rate) = contact.set_forces_now(world, &v, &w);
            let back = self.histories[history].n;
            let rate = &mut self.rates[0];
            // Newton–Euler equations of a sphere: shear acts at the contact point, R below the
            // centre
            rate.v += (contact.n * contact.normal_force - contact.shear_force) / body.mass;
            rate.w += (contact.n.cross(&contact.shear_force) * body.radius
                - contact.rolling_moment)
                / body.inertia;
            rate.shear[history] = transport(shear_rate, &contact.n, &back);
            rate.roll[history] = roll_rate;
            rate.loss.add(&contact.loss(world, &v, &w, &shear_rate), 1.0);
        }
        self.stored = self.springs_j(world).sum();
        self.fresh = true;
    }
}
