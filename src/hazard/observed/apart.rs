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
}

impl EndDistances {
    /// Of groups of rows of the measured ends; `computed` has the ends that stand beside the rows of a group.
    pub fn of(
        measured: &[ObservedPath],
        groups: &[Vec<usize>],
        computed: impl Fn(&[usize]) -> Vec<Weighted>,
    ) -> Self {
        let mut to_computed_m = vec![f64::NAN; measured.len()];
        let mut within_m = Vec::new();
        for rows in groups {
            let mut beside = computed(rows);
            beside.retain(|(way, weight)| *weight > 0.0 && way.runout_m().is_finite());
            for &row in rows {
                to_computed_m[row] = mean_distance_m(&measured[row], &beside);
            }
            let whole: f64 = beside.iter().map(|(_, weight)| weight).sum();
            let each = beside.iter().map(|(way, weight)| weight * mean_distance_m(way, &beside));
            within_m.push(each.sum::<f64>() / whole);
        }
        Self { to_computed_m, within_m }
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
        ObservedPath { start_m: [7.0, 3.0], end_m: [7.0 + x, 3.0 + y] }
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
