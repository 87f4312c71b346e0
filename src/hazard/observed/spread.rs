//! Where ends lie and how they spread, measured beside computed.

use super::{ObservedPath, Weighted, mean_direction, runouts};
use crate::hazard::proportion::{NORMAL_95, student_95};
use crate::math;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Ends of one set of rocks along and across a direction.
#[derive(Debug)]
pub struct EndSpread {
    mean_m: [f64; 2],
    sd_m: [f64; 2],
}

impl EndSpread {
    /// Mean distance from release to end.
    pub const MEAN: &str = "mean runout (m)";
    /// Distance between the middles of measured and computed ends.
    pub const OFFSET: &str = "offset of the centroid (m)";
    /// How much of the computed lies farther than all that was measured.
    pub const BEYOND: &str = "share past the farthest measured (–)";
    /// Standard deviations along and across the mean direction of the measured ends.
    pub const DEVIATIONS: [&str; 2] =
        ["standard deviation along (m)", "standard deviation across (m)"];

    /// Figures of measured and computed ways: what, of the measured, of the computed.
    pub fn figures(
        measured: &[ObservedPath],
        computed: &[Weighted],
    ) -> Vec<(&'static str, f64, f64)> {
        let along = mean_direction(measured);
        let measured: Vec<Weighted> = measured.iter().map(|way| (*way, 1.0)).collect();
        let [one, two] = [&measured, computed].map(|ways| Self::of(ways, along));
        let [near, far] = [&measured, computed].map(runouts);
        let total =
            |runouts: &[(f64, f64)]| runouts.iter().fold(0.0, |sum, (_, weight)| sum + weight);
        let mean = |runouts: &[(f64, f64)]| {
            runouts.iter().map(|(runout, weight)| runout * weight).sum::<f64>() / total(runouts)
        };
        let offset_m = math::hypot(two.mean_m[0] - one.mean_m[0], two.mean_m[1] - one.mean_m[1]);
        let farthest_m = near.last().map_or(f64::NAN, |(runout, _)| *runout);
        let beyond = &far[far.partition_point(|(runout, _)| *runout <= farthest_m)..];
        vec![
            (Self::MEAN, mean(&near), mean(&far)),
            (Self::OFFSET, 0.0, offset_m),
            (Self::DEVIATIONS[0], one.sd_m[0], two.sd_m[0]),
            (Self::DEVIATIONS[1], one.sd_m[1], two.sd_m[1]),
            (Self::BEYOND, 0.0, total(beyond) / total(&far)),
        ]
    }

    /// 95 % interval of a figure of measured ends that are worth so many independent ones, where it is a standard deviation (m): its ends, none
    /// where there are too few to say. None of other figures.
    pub fn deviation_95(
        what: &str,
        measured: &[ObservedPath],
        worth: f64,
    ) -> Option<[Option<f64>; 2]> {
        let axis = Self::DEVIATIONS.iter().position(|name| *name == what)?;
        let along = mean_direction(measured);
        let values: Vec<f64> = measured.iter().map(|way| turned(way, along)[axis]).collect();
        Some(deviation_95(&values, worth).map_or([None; 2], |ends| ends.map(Some)))
    }

    /// From the middle of measured ends to that of computed ones, on the map (m).
    pub fn offset_m(measured: &[ObservedPath], computed: &[Weighted]) -> [f64; 2] {
        let measured: Vec<Weighted> = measured.iter().map(|way| (*way, 1.0)).collect();
        let [one, two] = [&measured, computed].map(|ways| Self::of(ways, [1.0, 0.0]).mean_m);
        [two[0] - one[0], two[1] - one[1]]
    }

    /// Where weighted ends lie along and across a direction.
    pub(super) fn of(ways: &[Weighted], along: [f64; 2]) -> Self {
        let is_there = |(at, weight): &([f64; 2], f64)| {
            *weight > 0.0 && at.iter().all(|along| along.is_finite())
        };
        let turned = ways.iter().map(|(way, weight)| (turned(way, along), *weight));
        let all: Vec<([f64; 2], f64)> = turned.filter(is_there).collect();
        let sum = |of: &dyn Fn(&[f64; 2]) -> f64| -> f64 {
            all.iter().map(|(at, weight)| weight * of(at)).sum()
        };
        let whole = sum(&|_| 1.0);
        let mean_m = [0, 1].map(|axis| sum(&|at| at[axis]) / whole);
        // of n ends that weigh alike the variance of the sample, over n − 1
        let free = whole * (1.0 - 1.0 / all.len() as f64);
        let sd_m = [0, 1].map(|axis| (sum(&|at| (at[axis] - mean_m[axis]).powi(2)) / free).sqrt());
        Self { mean_m, sd_m }
    }

    /// Standard deviation across the direction (m).
    pub(super) fn across_m(&self) -> f64 {
        self.sd_m[1]
    }
}

/// A way along and across a direction (m).
fn turned(way: &ObservedPath, [x, y]: [f64; 2]) -> [f64; 2] {
    let [dx, dy] = way.vector_m();
    [x * dx + y * dy, x * dy - y * dx]
}

/// 95 % interval of the standard deviation of values that are worth so many independent ones; none of fewer than five.
///
/// On the scale of the logarithm of the variance, with the kurtosis about a trimmed mean (Bonett 2006, Computational Statistics & Data Analysis
/// 50, 775–782). Values drawn again do not do: of few, they hardly ever spread as widely as what they stand for.
fn deviation_95(values: &[f64], worth: f64) -> Option<[f64; 2]> {
    if values.len() < 5 || worth < 5.0 {
        return None;
    }
    let n = values.len() as f64;
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let trimmed = (0.5 * n / (n - 4.0).sqrt()) as usize;
    // of five values all but the middle one are trimmed
    let kept = &sorted[trimmed..values.len() - trimmed];
    let [middle, mean] = [kept, values].map(|x| x.iter().sum::<f64>() / x.len() as f64);
    let squares = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    let fourths = values.iter().map(|x| (x - middle).powi(4)).sum::<f64>();
    // values that are all alike have no kurtosis, and no spread either
    let kurtosis = if squares > 0.0 { n * fourths / (squares * squares) } else { 0.0 };
    let small = worth / (worth - NORMAL_95);
    let of_kurtosis = (kurtosis - (worth - 3.0) / worth).max(0.0) / (worth - 1.0);
    let far = 0.5 * NORMAL_95 * small * of_kurtosis.sqrt();
    let middle = (small * squares / (n - 1.0)).sqrt();
    Some([middle * math::exp(-far), middle * math::exp(far)])
}

/// Share of computed runouts below a measured one (–), those equal to it by half; none of none.
pub fn rank(measured: &ObservedPath, computed: &[ObservedPath]) -> Option<f64> {
    let own_m = measured.runout_m();
    let below = |way: &ObservedPath| match way.runout_m().total_cmp(&own_m) {
        Ordering::Less => 1.0,
        Ordering::Equal => 0.5,
        Ordering::Greater => 0.0,
    };
    let sum: f64 = computed.iter().map(below).sum();
    (!computed.is_empty()).then(|| sum / computed.len() as f64)
}

/// 95 % interval of the mean of values that are worth so many independent ones, Student's; none of fewer than two.
pub fn mean_95(values: &[f64], worth: f64) -> Option<[f64; 2]> {
    let n = values.len() as f64;
    if n < 2.0 || worth < 2.0 {
        return None;
    }
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let half = student_95(worth - 1.0) * (squares / (n - 1.0) / worth).sqrt();
    Some([mean - half, mean + half])
}

/// Independent values that values in groups are worth: `n / (1 + (m̄ − 1) ρ)` with the intraclass correlation ρ of a
/// one-way analysis of variance (Donner and Koval 1980) and the mean size m̄ of a group. All of them without groups.
pub fn effective(values: &[f64], groups: &[String]) -> f64 {
    let n = values.len() as f64;
    let mut sets: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for (value, group) in values.iter().zip(groups) {
        sets.entry(group).or_default().push(*value);
    }
    let k = sets.len() as f64;
    if groups.len() != values.len() || k < 2.0 || k >= n {
        return n;
    }
    let mean = |set: &[f64]| set.iter().sum::<f64>() / set.len() as f64;
    let whole = mean(values);
    let among =
        sets.values().map(|set| set.len() as f64 * (mean(set) - whole).powi(2)).sum::<f64>();
    let within = |set: &Vec<f64>| set.iter().map(|value| (value - mean(set)).powi(2)).sum::<f64>();
    let (among, within) = (among / (k - 1.0), sets.values().map(within).sum::<f64>() / (n - k));
    let squares = sets.values().map(|set| (set.len() as f64).powi(2)).sum::<f64>();
    let typical = (n - squares / n) / (k - 1.0);
    let alike = ((among - within) / (among + (typical - 1.0) * within)).clamp(0.0, 1.0);
    // no value is worth less than its group
    (n / (1.0 + (n / k - 1.0) * alike)).max(k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, stream, unit};

    fn groups(sizes: &[usize]) -> Vec<String> {
        let each = sizes.iter().enumerate();
        each.flat_map(|(group, size)| vec![group.to_string(); *size]).collect()
    }

    /// Of 25 independent values with standard deviation 5 the mean is known to 2.064 (Student, 24 degrees of freedom) times 1; of 100 that
    /// are worth 25 to the same.
    #[test]
    fn a_mean_is_known_as_well_as_independent_values_tell() {
        let half = |n: usize| {
            let values: Vec<f64> = (0..n).map(|k| if k % 2 == 0 { 95.0 } else { 105.0 }).collect();
            let [low, high] = mean_95(&values, 25.0).unwrap();
            0.5 * (high - low) * ((n - 1) as f64 / n as f64).sqrt()
        };
        assert!((half(100) - 2.0639).abs() < 1e-3 && (half(26) - 2.0639).abs() < 1e-3);
        assert!(mean_95(&[1.0], 1.0).is_none());
    }

    /// Groups whose values are all alike are worth one each; groups that spread like the whole are worth all.
    #[test]
    fn groups_are_worth_what_they_differ_within() {
        let alike = [1.0, 1.0, 1.0, 5.0, 5.0, 5.0, 9.0, 9.0];
        assert!((effective(&alike, &groups(&[3, 3, 2])) - 3.0).abs() < 1e-12);
        let mixed = [1.0, 5.0, 9.0, 1.0, 5.0, 9.0, 1.0, 9.0];
        assert!((effective(&mixed, &groups(&[3, 3, 2])) - 8.0).abs() < 1e-12);
        assert!((effective(&mixed, &[]) - 8.0).abs() < 1e-12);
    }

    /// Normal numbers have their standard deviation in the interval of ten, of fourteen and of eighty in 95 % of all samples, numbers
    /// that are as askew as waiting times in 88 %; of ten drawn again they have it in 80 % and 63 %. Groups of three that are all alike are
    /// worth one each.
    #[test]
    fn the_standard_deviation_of_few_ends_lies_in_its_interval() {
        const SAMPLES: usize = 4000;
        let share = |n: usize, alike: usize, of: &dyn Fn(f64) -> f64, sd: f64| {
            let holds = |sample: &usize| {
                let mut random = stream(n as u64, Purpose::Redraw, *sample);
                let mut one = || of((0..12).map(|_| unit(&mut random) - 0.5).sum());
                let values: Vec<f64> = (0..n).flat_map(|_| vec![one(); alike]).collect();
                let [low, high] = deviation_95(&values, n as f64).unwrap();
                low <= sd && sd <= high
            };
            (0..SAMPLES).filter(holds).count() as f64 / SAMPLES as f64
        };
        for n in [10, 14, 80] {
            let normal = share(n, 1, &|x| x, 1.0);
            assert!((0.935..=0.975).contains(&normal), "{n}: {normal}");
            // the spread of a square plus a part of the number itself: skewness 1.8
            let askew = share(n, 1, &|x| x + 0.5 * x * x, 1.5f64.sqrt());
            assert!((0.87..=0.975).contains(&askew), "{n}: {askew}");
        }
        let groups = share(14, 3, &|x| x, 1.0);
        assert!((0.92..=0.975).contains(&groups), "{groups}");
        assert_eq!(deviation_95(&[1.0, 2.0, 3.0, 4.0], 4.0), None);
        assert_eq!(deviation_95(&[2.0; 6], 6.0), Some([0.0; 2]));
    }

    /// By hand: ends at 10 and 20 m north, computed 3 m further east and 4 m further north, one of them beyond.
    #[test]
    fn figures_are_those_found_by_hand() {
        let way = |x: f64, y: f64| ObservedPath {
            start_m: [1.0, 1.0],
            end_m: [1.0 + x, 1.0 + y],
            open: None,
        };
        let figures = EndSpread::figures(
            &[way(0.0, 10.0), way(0.0, 20.0)],
            &[(way(3.0, 14.0), 1.0), (way(3.0, 24.0), 1.0)],
        );
        let value = |what: &str| figures.iter().find(|f| f.0.starts_with(what)).unwrap();
        assert!((value("offset").2 - 5.0).abs() < 1e-12);
        assert!((value("standard deviation along").1 - 50.0_f64.sqrt()).abs() < 1e-12);
        assert!(value("standard deviation across").2.abs() < 1e-12);
        assert!((value("share past").2 - 0.5).abs() < 1e-12);
        let computed = [way(0.0, 5.0), way(0.0, 10.0), way(0.0, 15.0), way(0.0, 30.0)];
        assert_eq!(rank(&way(0.0, 10.0), &computed), Some(0.375));
        assert_eq!(rank(&way(0.0, 10.0), &[]), None);
    }
}
