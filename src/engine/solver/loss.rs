//! Energy ledger of contacts.

use super::environment::ContactEnvironment;
use crate::rock::Vec3;

/// Power that goes into contacts (W) by kind, or energy (J) once summed over time. What springs
/// store is included; it is zero once the contact is over.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Loss {
    /// Sliding friction on the slope.
    pub friction: f64,
    /// Normal and shear dashpots on the slope.
    pub damping: f64,
    /// Rolling friction on the slope.
    pub rolling: f64,
    /// Everything in contacts with trees.
    pub trees: f64,
}

impl Loss {
    /// Of the slope, by friction, damping and rolling.
    pub(crate) const fn on_slope([friction, damping, rolling]: [f64; 3]) -> Self {
        Self { friction, damping, rolling, trees: 0.0 }
    }

    /// Power that goes into a contact on the slope, from its slip (m/s), shear force (N) and
    /// stretch rate (m/s), and from the power (W) of its normal element and of rolling. Friction
    /// takes the part of the slip that does not stretch the spring; the other part goes into spring
    /// and dashpot.
    #[inline]
    pub(super) fn of_slip(
        (shear_force, slip, stretch_rate): (&Vec3, &Vec3, &Vec3),
        [normal_w, rolling]: [f64; 2],
    ) -> Self {
        let friction = shear_force.dot(&(slip - stretch_rate));
        Self::on_slope([friction, shear_force.dot(stretch_rate) + normal_w, rolling])
    }

    /// Of the slope, from parts by friction, damping and rolling of which only the sum is exact.
    /// Where one part is negative, as friction that follows a spin which rolling friction slows, it
    /// is set to zero and the others are scaled to the same sum.
    pub(crate) fn redistributed([friction, damping, rolling]: [f64; 3]) -> Self {
        let parts = [friction, damping, rolling];
        let (sum, mut taken) = (friction + damping + rolling, parts.map(|part| part.max(0.0)));
        if sum < 0.0 || parts.iter().all(|part| *part >= 0.0) {
            return Self::on_slope(parts);
        }
        scale_to_total(sum, &mut taken);
        Self::on_slope(taken)
    }

    /// The four parts: friction, damping, rolling, trees.
    pub(crate) fn parts(&self) -> [f64; 4] {
        [self.friction, self.damping, self.rolling, self.trees]
    }

    /// Adds `other` times `factor`.
    #[inline]
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.friction += factor * other.friction;
        self.damping += factor * other.damping;
        self.rolling += factor * other.rolling;
        self.trees += factor * other.trees;
    }

    /// The same, counted as trees where the triangle belongs to one.
    #[must_use]
    #[inline]
    pub fn on(self, world: &ContactEnvironment, triangle: u32) -> Self {
        if world.terrain.is_tree(triangle) {
            Self { trees: self.sum(), ..Self::default() }
        } else {
            self
        }
    }

    /// All of it.
    pub fn sum(&self) -> f64 {
        self.friction + self.damping + self.rolling + self.trees
    }
}

/// Scales parts to a known total. The total is exact, from energies; the parts are sums over steps
/// and give only the shares.
pub(super) fn scale_to_total(lost: f64, parts: &mut [f64]) {
    match scale_factor(lost, parts.iter().sum()) {
        Some(share) => parts.iter_mut().for_each(|part| *part *= share),
        None => parts[1] = lost,
    }
}

/// Factor that scales parts with this sum to the total `lost`; `None` where the sum is zero or too
/// small for the division.
pub(super) fn scale_factor(lost: f64, sum: f64) -> Option<f64> {
    let share = lost / sum;
    (sum > 0.0 && share.is_finite()).then_some(share)
}

/// Energy that a rock gives to its contacts with other rocks (J), or power (W).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyGiven {
    /// Half of what those contacts dissipate and store.
    pub lost: f64,
    /// Passed on to the other rocks, negative if received.
    pub passed_on: f64,
}

impl EnergyGiven {
    /// For both ends of a contact, from the work that each does on it.
    ///
    /// `lost` is half of the sum for each; the rest is equal and opposite, so that `passed_on` adds
    /// up to 0 over a world.
    pub(super) fn of_ends([a, b]: [f64; 2]) -> [Self; 2] {
        let lost = 0.5 * (a + b);
        [Self { lost, passed_on: a - lost }, Self { lost, passed_on: b - lost }]
    }

    /// Adds `other` times `factor`.
    pub(super) fn add(&mut self, other: &Self, factor: f64) {
        self.lost += factor * other.lost;
        self.passed_on += factor * other.passed_on;
    }

    /// All of it.
    pub fn sum(&self) -> f64 {
        self.lost + self.passed_on
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where friction follows a spin that rolling friction slows, the mean motion of a step makes
    /// its part slightly negative: no part of the ledger may be below 0.
    #[test]
    fn parts_of_a_loss_take_and_give_nothing_back() {
        let loss = Loss::redistributed([-0.2, 0.5, 1.0]);
        assert!(loss.friction == 0.0 && (loss.sum() - 1.3).abs() < 1e-15, "{loss:?}");
        assert!((loss.rolling / loss.damping - 2.0).abs() < 1e-15, "{loss:?}");
        assert_eq!(Loss::redistributed([0.1, 0.2, 0.3]), Loss::on_slope([0.1, 0.2, 0.3]));
        // a gain of energy stays visible
        assert_eq!(Loss::redistributed([-0.2, 0.1, 0.0]), Loss::on_slope([-0.2, 0.1, 0.0]));
    }

    #[test]
    fn what_is_lost_is_a_number_however_little_was_summed() {
        for summed in [[0.0; 4], [1e-320, 0.0, 3e-322, 0.0], [5e-324; 4]] {
            for lost in [0.0, 1e-9, 1e3, 1e9] {
                let mut parts = summed;
                scale_to_total(lost, &mut parts);
                let sum: f64 = parts.iter().sum();
                assert!((sum - lost).abs() <= 1e-12 * lost + 1e-300, "{summed:?}: {parts:?}");
            }
        }
    }
}
