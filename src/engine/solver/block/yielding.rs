//! A blow on something that gives way, in the limit of stiff springs, of a contact with a lever.
//!
//! While the contact point comes nearer, the normal impulse grows; the impulse along the surface follows it by Coulomb's law from
//! one share of it to the next (Routh 1905; Stronge 2000, ch. 4): against the slip at the rim of the cone, or, where the slip has
//! ended, what keeps it so if the cone allows. What an impulse `P` has taken is exact at any time, whatever its way:
//! `W = −(u₀·P + P·G P/2)` with `u₀` the velocity of the contact point before and `G = T M⁻¹ Tᵀ`.

use super::solve::BlockContact;
use crate::math;
use crate::rock::Vec3;
use crate::solver::law::within;
use crate::solver::yielding::BISECTIONS;

/// Shares of the normal impulse that would stop the contact point without friction, for one of which a step goes (–).
const PUSH_STEP: f64 = 2e-3;
/// Steps at most: friction may make the stop as much dearer.
const STEPS: u32 = 20_000;
/// Passes over the two directions along the surface (–).
const PASSES: u32 = 40;

impl BlockContact {
    /// What an impulse has taken (J) of a body whose contact point moved by `u` (m/s).
    fn taken_j(&self, u: &Vec3, impulse: &Vec3) -> f64 {
        -(u.dot(impulse) + 0.5 * impulse.dot(&(self.delassus * impulse)))
    }

    /// Impulse along the surface over the normal one (–), at a velocity `u` of the contact point, for a step of `push` (N s); and
    /// whether the point slips on throughout.
    fn friction_ratio(&self, u: &Vec3, push: f64) -> (Vec3, bool) {
        let along = |x: Vec3| x - self.n * self.n.dot(&x);
        let slip = along(*u);
        let against = |x: &Vec3| -x.try_normalize(0.0).unwrap_or_default() * self.friction;
        let slides = against(&slip);
        let after = slip + along(self.delassus * (self.n + slides)) * push;
        if slip.dot(&after) > 0.0 {
            return (slides, true);
        }
        // the slip ends: what ends it and keeps it so, by a few passes over the two directions along the surface
        let rate = 1.0 / (self.delassus.trace() - self.n.dot(&(self.delassus * self.n)));
        let mut stick = Vec3::zeros();
        for _ in 0..PASSES {
            let next = stick - along(slip / push + self.delassus * (self.n + stick)) * rate;
            stick = within(next, self.friction);
        }
        (stick, false)
    }

    /// Impulse after another step of `push` (N s) along the normal: while the point slips, with the direction of the slip in the
    /// middle of the step.
    fn advance_impulse(&self, u: &Vec3, impulse: &Vec3, push: f64) -> Vec3 {
        let (mut ratio, slips) = self.friction_ratio(&(u + self.delassus * impulse), push);
        if slips {
            let half = impulse + (self.n + ratio) * (0.5 * push);
            (ratio, _) = self.friction_ratio(&(u + self.delassus * half), 0.5 * push);
        }
        impulse + (self.n + ratio) * push
    }

    /// Impulse (N s) with which a body goes on whose contact point strikes, with the velocity `u` (m/s), something that gives way
    /// once it has taken `limit_j`, friction included. `None` if that stands until the point comes to rest along the normal.
    pub(super) fn yielding(&self, u: &Vec3, limit_j: f64) -> Option<Vec3> {
        let push = -self.n.dot(u) / self.n.dot(&(self.delassus * self.n)) * PUSH_STEP;
        let mut impulse = Vec3::zeros();
        for _ in 0..STEPS {
            if self.n.dot(&(u + self.delassus * impulse)) >= 0.0 {
                return None;
            }
            let next = self.advance_impulse(u, &impulse, push);
            if self.taken_j(u, &next) >= limit_j {
                let after = |share: f64| impulse + (next - impulse) * share;
                let stands = |share: f64| self.taken_j(u, &after(share)) < limit_j;
                let [_, yields] = math::bisected([0.0, 1.0], BISECTIONS, stands);
                return Some(after(yields));
            }
            impulse = next;
        }
        None
    }
}
