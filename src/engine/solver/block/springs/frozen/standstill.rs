//! Impacts that end with contacts that jam each other.

use super::{CONTACTS, FrozenFlow, MOMENTUM, PER_CONTACT, V};
use crate::rock::Vec3;
use crate::solver::block::BlockState;
use crate::solver::impact::dormand_prince::vec3_at;

/// A block is clamped if its motion has changed by at most `UNCHANGED` allowed errors (–) for
/// `STILL_RAD` radians of the stiffest contact, and a contact presses with more than
/// `CLAMPED_ERRORS` of them (–).
const UNCHANGED: f64 = 3.0;
const STILL_RAD: f64 = 12.0;
const CLAMPED_ERRORS: f64 = 100.0;

/// Since when the motion of a block in an impact has not changed.
pub(super) struct Standstill {
    since_rad: f64,
    v: Vec3,
    momentum: Vec3,
}

impl Standstill {
    pub(super) fn of(state: &BlockState) -> Self {
        Self { since_rad: 0.0, v: state.v, momentum: state.momentum }
    }

    /// For how long (rad) velocity and angular momentum have been the same, where `is_other` tells
    /// whether a change counts.
    pub(super) fn unchanged_rad(
        &mut self,
        (v, momentum): (Vec3, Vec3),
        age_rad: f64,
        is_other: impl Fn(&Vec3, &Vec3) -> bool,
    ) -> f64 {
        if is_other(&(v - self.v), &(momentum - self.momentum)) {
            *self = Self { since_rad: age_rad, v, momentum };
        }
        age_rad - self.since_rad
    }
}

impl FrozenFlow<'_, '_> {
    /// Whether pressing contacts jam each other: the motion has not changed for some periods,
    /// although they would otherwise push the block away.
    pub(super) fn stays_clamped<const N: usize>(
        &mut self,
        y: &[f64; N],
        elapsed_rad: f64,
        still: &mut Standstill,
    ) -> bool {
        let (inverse, reach_m) = (self.mass.inverse, self.block.bound_m);
        let nothing = UNCHANGED * self.allowed;
        let is_other =
            |dv: &Vec3, dl: &Vec3| dv.norm() > nothing || (inverse * dl).norm() * reach_m > nothing;
        let stays =
            still.unchanged_rad((vec3_at(y, V), vec3_at(y, MOMENTUM)), elapsed_rad, is_other);
        if stays < STILL_RAD {
            return false;
        }
        for (k, contact) in self.contacts.iter_mut().enumerate() {
            let at = CONTACTS + PER_CONTACT * k;
            (contact.penetration, contact.shear) = (y[at], vec3_at(y, at + 1));
        }
        let pressed = self.contacts.iter().filter(|one| !one.is_suspended && one.penetration > 0.0);
        let deepest = pressed.map(|one| one.penetration).fold(0.0, f64::max);
        deepest * self.omega > CLAMPED_ERRORS * self.allowed
    }

    /// Energy in the pressing contacts (J).
    pub(super) fn clamped_j(&self) -> f64 {
        let pressed = self.contacts.iter().filter(|one| one.normal_force > 0.0);
        pressed.map(|one| one.stored_j(one.penetration, &one.shear)).sum()
    }
}
