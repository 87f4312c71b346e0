//! What one trial computes on a scene, and the same with its rocks drawn again, as measured ends are.

use crate::hazard::{EndDistances, ObservedPath};
use crate::random::{RandomStream, one_of};

/// Computed ways with their release numbers.
pub(super) type ObservedWays = Vec<(usize, ObservedPath)>;

/// What one trial computed on a scene.
pub(super) struct Computed {
    /// Ways that are compared.
    pub(super) ways: ObservedWays,
    /// Release numbers of the rocks that are not compared, as their runout is less than any that was measured can be.
    pub(super) stayed: Vec<usize>,
    /// Its releases, and how many classes they take in turn: places of release that measured ends have too, or strata of size and source.
    pub(super) releases: (usize, usize),
    /// How far the ends lie from the measured ones, for each way in which open rocks may have ended; only where a fit is scored by it.
    pub(super) apart: Vec<EndDistances>,
}

impl Computed {
    /// The same where each release stands there so many times.
    pub(super) fn again(&self, times: &[usize]) -> Self {
        let each = self.ways.iter().map(|(index, _)| times[*index]);
        let ways = self.ways.iter().zip(each.clone());
        let each: Vec<usize> = each.collect();
        Self {
            ways: ways.flat_map(|(way, times)| std::iter::repeat_n(*way, times)).collect(),
            stayed: Vec::new(),
            releases: self.releases,
            apart: self.apart.iter().map(|apart| apart.again(&each)).collect(),
        }
    }
}

/// How often each of so many releases, which take so many classes in turn, stands among rocks that are drawn again: one less than it has from
/// each class, which so spread by what rocks of their number do (Rao and Wu 1988, Journal of the American Statistical Association 83, 231). The
/// only one of a class stays.
///
/// A release has the same rock in every trial of a stage, whatever the values: drawn once for all trials, it keeps what they have in common.
pub(super) fn times_again(
    (releases, classes): (usize, usize),
    random: &mut RandomStream,
) -> Vec<usize> {
    let mut times = vec![0; releases];
    for class in 0..classes.min(releases) {
        let of_class = (releases - class).div_ceil(classes);
        for _ in 0..(of_class - 1).max(1) {
            times[class + one_of(random, of_class) * classes] += 1;
        }
    }
    times
}

/// So many of some rows, of which there must be one, drawn with replacement.
pub(super) fn drawn_from(rows: &[usize], count: usize, random: &mut RandomStream) -> Vec<usize> {
    (0..count).map(|_| rows[one_of(random, rows.len())]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, stream};

    /// Ten releases that take three classes in turn: four, three and three rocks, of which three, two and two are drawn; of means of a class the
    /// variance is that of its rocks over their number, `Σ (x − x̄)² / (n (n − 1))`: of 0, 1, 2 and 3 it is 5/12.
    #[test]
    fn rocks_are_drawn_again_class_by_class() {
        const SAMPLES: usize = 20_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for sample in 0..SAMPLES {
            let times = times_again((10, 3), &mut stream(1, Purpose::Redraw, sample));
            let of_class = |class: usize| times.iter().skip(class).step_by(3);
            assert_eq!([0, 1, 2].map(|class| of_class(class).sum::<usize>()), [3, 2, 2]);
            let mean =
                of_class(0).enumerate().map(|(x, times)| x * times).sum::<usize>() as f64 / 3.0;
            sum += mean;
            squares += mean * mean;
        }
        let mean = sum / SAMPLES as f64;
        let variance = squares / SAMPLES as f64 - mean * mean;
        // five standard errors of a variance of so many samples, √(2/n)
        assert!((mean - 1.5).abs() < 0.025 && (12.0 / 5.0 * variance - 1.0).abs() < 0.05);
        assert_eq!(times_again((2, 5), &mut stream(1, Purpose::Redraw, 0)), [1, 1]);
    }
}
