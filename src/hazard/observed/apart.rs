//! How far the ends of two sets of rocks lie apart in plan view.

use super::{ObservedPath, Weighted};
use crate::math;

/// Measured ends in groups beside the computed ends of each group, as their energy distance needs them (Székely and Rizzo 2013):
/// `2 E|X − Y| − E|X − X'| − E|Y − Y'|` with computed ends X, measured ends Y and copies of both, every end seen
/// from its own release (m). It is 0 where the two are distributed alike, and above it where they are not, be it in runout, in how it
/// spreads, or to the side; it has no scale or weight to choose. Groups count by their measured ends.
#[derive(Debug, Clone, PartialEq)]
pub struct EndDistances {
    /// Mean distance of each measured end from the computed ends of its group (m).
    to_computed_m: Vec<f64>,
    /// Mean distance of two computed ends of each group (m).
    within_m: Vec<f64>,
    /// Of each group the computed ends beside it.
    pulls: Vec<Vec<EndPull>>,
}

/// What one computed end does to the distance of its group.
#[derive(Debug, Clone, PartialEq)]
struct EndPull {
    /// Which of the computed ends it is.
    at: usize,
    /// What it weighs (–).
    weight: f64,
    /// By how much the distance grows with its share of all, to first order (m): twice its mean distance from the measured ends of its group
    /// less that from the computed ones.
    pull_m: f64,
}

impl EndDistances {
    /// Of groups of rows of the measured ends; `computed` has the ends that stand beside the rows of a group.
    pub fn of(
        measured: &[ObservedPath],
        groups: &[Vec<usize>],
        computed: impl Fn(&[usize]) -> Vec<Weighted>,
    ) -> Self {
        let mut to_computed_m = vec![f64::NAN; measured.len()];
        let (mut within_m, mut pulls) = (Vec::new(), Vec::new());
        for rows in groups {
            let all = computed(rows).into_iter().enumerate();
            let is_beside = |(_, (way, weight)): &(usize, Weighted)| {
                *weight > 0.0 && way.runout_m().is_finite()
            };
            let (places, beside): (Vec<usize>, Vec<Weighted>) = all.filter(is_beside).unzip();
            for &row in rows {
                to_computed_m[row] = mean_distance_m(&measured[row], &beside);
            }
            let ends: Vec<Weighted> = rows.iter().map(|&row| (measured[row], 1.0)).collect();
            let whole: f64 = beside.iter().map(|(_, weight)| weight).sum();
            let mut within = 0.0;
            let pull = |(at, (way, weight)): (usize, &Weighted)| {
                let from_computed_m = mean_distance_m(way, &beside);
                within += weight * from_computed_m;
                let pull_m = 2.0 * (mean_distance_m(way, &ends) - from_computed_m);
                EndPull { at, weight: *weight, pull_m }
            };
            pulls.push(places.into_iter().zip(&beside).map(pull).collect());
            within_m.push(within / whole);
        }
        Self { to_computed_m, within_m, pulls }
    }

    /// The same where each computed end stands there so many times, to first order in how their distribution changes: all pairs of
    /// ends would have to be gone through for every one of many drawings, and change less.
    #[must_use]
    pub fn again(&self, times: &[usize]) -> Self {
        let moved_m = |ends: &Vec<EndPull>| {
            let mean_m = |times: &dyn Fn(&EndPull) -> f64| {
                let weights = ends.iter().map(|end| end.weight * times(end));
                let sum_m: f64 = weights.clone().zip(ends).map(|(w, end)| w * end.pull_m).sum();
                sum_m / weights.sum::<f64>()
            };
            mean_m(&|end| times[end.at] as f64) - mean_m(&|_| 1.0)
        };
        let within_m = self.within_m.iter().zip(&self.pulls);
        let within_m = within_m.map(|(within_m, ends)| within_m - moved_m(ends)).collect();
        Self { to_computed_m: self.to_computed_m.clone(), within_m, pulls: Vec::new() }
    }

    /// Energy distance of some measured ends, which may stand there several times, from the computed ones (m); not a number where
    /// nothing was computed beside one of them.
    pub fn energy_m(
        &self,
        measured: &[ObservedPath],
        groups: &[Vec<usize>],
        wanted: &[usize],
    ) -> f64 {
        let of_group = |(rows, within_m): (&Vec<usize>, &f64)| {
            let own: Vec<usize> = wanted.iter().copied().filter(|row| rows.contains(row)).collect();
            if own.is_empty() {
                return 0.0;
            }
            let ends: Vec<Weighted> = own.iter().map(|&row| (measured[row], 1.0)).collect();
            let count = own.len() as f64;
            let across_m = own.iter().map(|&row| self.to_computed_m[row]).sum::<f64>() / count;
            let among_m =
                ends.iter().map(|(end, _)| mean_distance_m(end, &ends)).sum::<f64>() / count;
            count * (2.0 * across_m - within_m - among_m)
        };
        let each = groups.iter().zip(&self.within_m).map(of_group);
        each.sum::<f64>() / wanted.len() as f64
    }
}

/// Mean distance of an end from others (m), each seen from its own release.
fn mean_distance_m(one: &ObservedPath, others: &[Weighted]) -> f64 {
    let [x, y] = one.vector_m();
    let (mut sum_m, mut whole) = (0.0, 0.0);
    for (other, weight) in others {
        let [other_x, other_y] = other.vector_m();
        sum_m += weight * math::hypot(x - other_x, y - other_y);
        whole += weight;
    }
    sum_m / whole
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(x: f64, y: f64) -> ObservedPath {
        ObservedPath { start_m: [7.0, 3.0], end_m: [7.0 + x, 3.0 + y], open: None }
    }

    /// By hand: ends at 0 and 2 m beside computed ones 3 m to the side. Across: (3 + √13)/2; among each: 1.
    #[test]
    fn the_energy_distance_is_that_found_by_hand() {
        let measured = [way(0.0, 0.0), way(2.0, 0.0)];
        let computed = [(way(0.0, 3.0), 1.0), (way(2.0, 3.0), 1.0)];
        let groups = [vec![0, 1]];
        let apart = EndDistances::of(&measured, &groups, |_| computed.to_vec());
        let found = apart.energy_m(&measured, &groups, &[0, 1]);
        assert!((found - (3.0 + 13.0_f64.sqrt() - 2.0)).abs() < 1e-14);
        // the same ends, and one that weighs nothing
        let same: Vec<Weighted> =
            vec![(measured[0], 2.0), (measured[1], 2.0), (way(9.0, 9.0), 0.0)];
        let apart = EndDistances::of(&measured, &groups, |_| same.clone());
        assert!(apart.energy_m(&measured, &groups, &[0, 1]).abs() < 1e-14);
        // an end that was drawn twice instead of the other: 2 · 1 − 1 − 0
        assert!((apart.energy_m(&measured, &groups, &[1, 1]) - 1.0).abs() < 1e-14);
    }

    /// By hand: ends at 0 and 2 m, computed at 1 and 4 m; drawn again, only that at 4 m. Pulls: 2 (1 − 1.5) = −1 and 2 (3 − 1.5) = 3 m, so the distance grows
    /// by 3 − 1 = 2 m, from 2 · 2 − 1.5 − 1 = 1.5 to 3.5 m. Each as often as before leaves it.
    #[test]
    fn computed_ends_drawn_again_move_the_distance_by_their_pulls() {
        let measured = [way(0.0, 0.0), way(2.0, 0.0)];
        let computed = [(way(9.0, 0.0), 0.0), (way(1.0, 0.0), 1.0), (way(4.0, 0.0), 1.0)];
        let groups = [vec![0, 1]];
        let apart = EndDistances::of(&measured, &groups, |_| computed.to_vec());
        for (times, wanted) in [([1, 0, 1], 3.5), ([0, 2, 2], 1.5)] {
            let found = apart.again(&times).energy_m(&measured, &groups, &[0, 1]);
            assert!((found - wanted).abs() < 1e-14, "{found}");
        }
    }

    /// Two blocks that end 10 m apart, computed the other way round: over all ends alike, block by block not at all.
    #[test]
    fn blocks_that_change_places_are_seen() {
        let measured = [way(0.0, 0.0), way(10.0, 0.0)];
        let beside = |rows: &[usize]| -> Vec<Weighted> {
            rows.iter().map(|&row| (measured[1 - row], 1.0)).collect()
        };
        for (groups, wanted) in [(vec![vec![0, 1]], 0.0), (vec![vec![0], vec![1]], 20.0)] {
            let apart = EndDistances::of(&measured, &groups, beside);
            let found = apart.energy_m(&measured, &groups, &[0, 1]);
            assert!((found - wanted).abs() < 1e-14, "{found}");
        }
    }
}
