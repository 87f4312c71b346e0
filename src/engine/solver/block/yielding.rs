//! Impact of a contact with a lever on a stem that breaks, in the limit of stiff springs.
//!
//! While the contact point approaches, the normal impulse grows. The tangential impulse follows
//! from Coulomb's law in small increments of the normal impulse (Routh 1905; Stronge 2000, ch. 4):
//! against the slip on the friction cone or, once the slip has ended, the impulse that keeps the
//! point from slipping if the cone allows it. The energy that an impulse `P` dissipates is exact at
//! any time, whatever its path: `W = −(u₀·P + P·G P/2)` with `u₀` the velocity of the contact point
//! before and `G = T M⁻¹ Tᵀ`.

use super::solve::BlockContact;
use crate::math;
use crate::rock::Vec3;
use crate::solver::law::clamp_norm;
use crate::solver::yielding::BISECTIONS;

/// Increment of the normal impulse, relative to the one that would stop the contact point without
/// friction (–).
const PUSH_STEP: f64 = 2e-3;
/// Increments at most: with friction stopping may take correspondingly more.
const STEPS: u32 = 20_000;
/// Iterations over the two tangential directions (–).
const PASSES: u32 = 40;

impl BlockContact {
    /// Energy (J) that an impulse takes from a body whose contact point moved at `u` (m/s).
    fn dissipated_j(&self, u: &Vec3, impulse: &Vec3) -> f64 {
        -(u.dot(impulse) + 0.5 * impulse.dot(&(self.delassus * impulse)))
    }

    /// Tangential over normal impulse (–), at a velocity `u` of the contact point, for an increment
    /// `increment` (N s) of the normal impulse; and whether the point slips throughout.
    fn friction_ratio(&self, u: &Vec3, increment: f64) -> (Vec3, bool) {
        let along = |x: Vec3| x - self.n * self.n.dot(&x);
        let slip = along(*u);
        let against = |x: &Vec3| -x.try_normalize(0.0).unwrap_or_default() * self.friction;
        let slides = against(&slip);
        let after = slip + along(self.delassus * (self.n + slides)) * increment;
        if slip.dot(&after) > 0.0 {
            return (slides, true);
        }
        // the slip ends: the ratio that ends it and prevents further slip, by a few iterations over
        // the two tangential directions
        let rate = 1.0 / (self.delassus.trace() - self.n.dot(&(self.delassus * self.n)));
        let mut stick = Vec3::zeros();
        for _ in 0..PASSES {
            let next = stick - along(slip / increment + self.delassus * (self.n + stick)) * rate;
            stick = clamp_norm(next, self.friction);
        }
        (stick, false)
    }

    /// Impulse after another increment `increment` (N s) of the normal impulse. While the point
    /// slips, the direction of slip at the middle of the increment is used.
    fn advance_impulse(&self, u: &Vec3, impulse: &Vec3, increment: f64) -> Vec3 {
        let (mut ratio, slips) = self.friction_ratio(&(u + self.delassus * impulse), increment);
        if slips {
            let half = impulse + (self.n + ratio) * (0.5 * increment);
            (ratio, _) = self.friction_ratio(&(u + self.delassus * half), 0.5 * increment);
        }
        impulse + (self.n + ratio) * increment
    }

    /// Impulse (N s) on a body whose contact point strikes, at the velocity `u` (m/s), something
    /// that breaks once it has absorbed `limit_j`, friction included. `None` if it does not break
    /// before the point comes to rest along the normal.
    pub(super) fn yielding(&self, u: &Vec3, limit_j: f64) -> Option<Vec3> {
        let increment = -self.n.dot(u) / self.n.dot(&(self.delassus * self.n)) * PUSH_STEP;
        let mut impulse = Vec3::zeros();
        for _ in 0..STEPS {
            if self.n.dot(&(u + self.delassus * impulse)) >= 0.0 {
                return None;
            }
            let next = self.advance_impulse(u, &impulse, increment);
            if self.dissipated_j(u, &next) >= limit_j {
                let after = |share: f64| impulse + (next - impulse) * share;
                let stands = |share: f64| self.dissipated_j(u, &after(share)) < limit_j;
                let [_, yields] = math::bisected([0.0, 1.0], BISECTIONS, stands);
                return Some(after(yields));
            }
            impulse = next;
        }
        None
    }
}
