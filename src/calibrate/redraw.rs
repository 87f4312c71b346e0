//! Measured ends and computed rocks drawn again, and the intervals that figures of them have.
//!
//! Both are samples. A value fitted to a thousand ends by a hundred rocks is known no better than a hundred rocks tell.

use super::Ends;
use super::computed::{Computed, times_again};
use super::site::CalibrationSite;
use crate::hazard::student_95;
use crate::math;
use crate::random::RandomStream;

/// How often ends and rocks are drawn again for an interval.
pub(super) const REDRAWS: usize = 200;

/// One drawing for a scene.
pub(super) struct Again {
    /// Rows of measured ends.
    pub(super) rows: Vec<usize>,
    /// How often each release stands there.
    pub(super) times: Vec<usize>,
}

impl Again {
    /// A drawing of some of the measured ends of a scene and of the rocks of trials like this one.
    pub(super) fn of(
        site: &CalibrationSite,
        (ends, computed): (Ends, &Computed),
        random: &mut RandomStream,
    ) -> Self {
        let rows = site.redraw(ends, random);
        Self { rows, times: times_again(computed.releases, random) }
    }
}

/// The tail on either side that makes a 95 % interval of figures of so many independent ends when they are drawn again (–).
///
/// Ends drawn again vary less than ends do, by the part `(n − 1)/n` of the variance, and how much those vary is itself known the worse the fewer there are:
/// `Φ(−t √(n/(n − 1)))` with Student's t of `n − 1` degrees of freedom makes good for both (Hesterberg 2015, The American
/// Statistician 69, 371, section 5.3). Many ends have a fortieth.
pub(super) fn tail_of(ends: f64) -> f64 {
    let n = ends.max(2.0);
    let far = student_95(n - 1.0) * (n / (n - 1.0)).sqrt();
    0.5 * math::erfc(far / std::f64::consts::SQRT_2)
}

/// The interval that leaves out a tail of the numbers on either side.
pub(super) fn middle(mut numbers: Vec<f64>, tail: f64) -> [f64; 2] {
    numbers.sort_by(f64::total_cmp);
    let at = |p: f64| {
        let rank = (p * (numbers.len() as f64 - 1.0)).round() as usize;
        numbers.get(rank).copied().unwrap_or(f64::NAN)
    };
    [at(tail), at(1.0 - tail)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, one_of, stream, unit};

    /// Means of ten ends of a known law, drawn again as the measured ones are: the truth lies in the interval in 92 of 100 samples, by a fortieth on
    /// either side in 89; of fourteen, what Tschamut's are worth, in 94 and 91.
    #[test]
    fn the_mean_of_few_ends_lies_in_its_interval() {
        const SAMPLES: usize = 4000;
        for (n, least) in [(10_usize, 0.91), (14, 0.925)] {
            let holds = |sample: &usize| {
                let mut random = stream(n as u64, Purpose::Redraw, *sample);
                // the sum of twelve even numbers is normal enough (–)
                let mut end = || (0..12).map(|_| unit(&mut random) - 0.5).sum::<f64>();
                let ends: Vec<f64> = (0..n).map(|_| end()).collect();
                let mut again = || -> f64 {
                    let one = |_| ends[one_of(&mut random, n)];
                    (0..n).map(one).sum::<f64>() / n as f64
                };
                let means = (0..REDRAWS).map(|_| again()).collect();
                let [low, high] = middle(means, tail_of(n as f64));
                low <= 0.0 && 0.0 <= high
            };
            let share = (0..SAMPLES).filter(holds).count() as f64 / SAMPLES as f64;
            assert!((least..=0.96).contains(&share), "{n}: {share}");
        }
        assert!((tail_of(1e9) - 0.025).abs() < 1e-6 && tail_of(2.0) < 1e-9);
    }

    /// Of five and of ten ends: Student's t of four and of nine degrees of freedom, 2.7764 and 2.2622, stretched by `√(n/(n − 1))` to 3.1042 and 2.3845, and
    /// what a normal variable exceeds by chance there, from tables. A thousandth of t, by which its series is off for three degrees of freedom, is a hundredth of that.
    #[test]
    fn the_tail_of_few_ends_is_that_of_student() {
        for (ends, exact) in [(5.0, 9.541e-4), (10.0, 8.5506e-3)] {
            let tail = tail_of(ends);
            assert!((tail / exact - 1.0).abs() < 1e-2, "{ends}: {tail} for {exact}");
        }
    }
}
