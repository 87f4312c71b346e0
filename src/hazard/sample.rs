//! All values of one quantity, sorted, and what they say.

use super::proportion::student_95;
use super::quantile::{Open, Percentile, worth};
use super::strata::Strata;
use crate::frequency::Weights;
use crate::math;
use serde::{Deserialize, Serialize};

/// Values of one quantity in ascending order; what is not a finite number is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    sorted: Vec<f64>,
    /// What each of them weighs; none where all weigh the same.
    weights: Option<Vec<f64>>,
    /// The strata of weighted values, where they are known.
    strata: Option<Strata>,
    /// The same with censored values (bounds only) at the far end of their possible range; none when no value is censored.
    far: Option<(Box<Sample>, Open)>,
    /// What the mean of such values can never lie below, where that is known.
    floor: Option<f64>,
}

/// A mean with its 95 % interval, see [`Sample::mean`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Mean {
    /// Mean.
    pub value: f64,
    /// Lower end of the interval; none for a single value, or where all are equal.
    pub low_95: Option<f64>,
    /// Upper end of the interval; none for a single value, or where all are equal.
    pub high_95: Option<f64>,
    /// Whether some values are only bounds (censored): then the mean is one too, and its interval is open on that side.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub censored: bool,
}

/// A share of rocks that exceeds a value, the value, and where it lies with 95 % confidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exceedance {
    /// Share of the rocks above the value (–), between 0 and 1.
    pub share: f64,
    /// The value exceeded by that share.
    pub value: f64,
    /// Lower end of the interval of the value; none when there are too few rocks.
    pub low_95: Option<f64>,
    /// Upper end of the interval of the value; none when there are too few rocks.
    pub high_95: Option<f64>,
    /// Whether rocks seen only in part decide the value more than chance in the sample does: there the curve ends.
    pub censored: bool,
}

/// How many values fall between neighbouring edges.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Ascending edges, one more than counts; round numbers.
    pub edges: Vec<f64>,
    /// Values from one edge up to below the next.
    pub counts: Vec<usize>,
}

/// Fewest and most bars of a histogram: enough to show a second peak, few enough to be read.
const BARS: (f64, f64) = (5.0, 60.0);

impl Sample {
    /// Sorts the finite ones of the values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        Self { sorted, weights: None, strata: None, far: None, floor: None }
    }

    /// Sorts values, each with what it weighs (0 or more).
    pub fn weighted(values: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let finite = values.into_iter().filter(|(value, _)| value.is_finite());
        Self::sorted(finite.map(|(value, weighs)| (value, weighs, 0)).collect(), None)
    }

    /// Sorts values of releases, each with what its release stands for. The interval of the mean is that of stratified sampling.
    pub fn of_releases(values: impl IntoIterator<Item = (f64, usize)>, weights: &Weights) -> Self {
        let finite = values.into_iter().filter(|(value, _)| value.is_finite());
        Self::sorted(
            finite.map(|(value, release)| of_release(value, release, weights)).collect(),
            Some(weights),
        )
    }

    /// Sorts values with their weights and strata; an open end of where a rock may lie is one of them.
    fn sorted(mut rows: Vec<SampleRow>, weights: Option<&Weights>) -> Self {
        #[expect(clippy::float_cmp, reason = "equal weights are the same number")]
        let are_equal = rows.windows(2).all(|pair| pair[0].1 == pair[1].1);
        if are_equal {
            let mut sorted: Vec<f64> = rows.into_iter().map(|(value, ..)| value).collect();
            sorted.sort_unstable_by(f64::total_cmp);
            return Self { sorted, weights: None, strata: None, far: None, floor: None };
        }
        rows.sort_by(|one, other| {
            let by = [one.0.total_cmp(&other.0), one.1.total_cmp(&other.1)];
            by[0].then(by[1]).then(one.2.cmp(&other.2))
        });
        let strata = weights.map(|weights| Strata {
            of: rows.iter().map(|(.., stratum)| *stratum).collect(),
            rocks: Strata::rocks_of(weights),
        });
        let (sorted, weights) = rows.into_iter().map(|(value, weighs, _)| (value, weighs)).unzip();
        Self { sorted, weights: Some(weights), strata, far: None, floor: None }
    }

    /// Sorts values, each with what it weighs, of which some are only bounds (true): the rock was seen in part. The truth
    /// lies on the `open` side; of a bound that is no number nothing is known, and it counts only there.
    pub fn censored(values: impl IntoIterator<Item = (f64, f64, bool)>, open: Open) -> Self {
        let rows = values.into_iter().map(|(value, weighs, is)| ((value, weighs, 0), is));
        Self::bounded(rows, open, None)
    }

    /// The same of releases, each with what it stands for, as [`Self::of_releases`].
    pub fn censored_of_releases(
        values: impl IntoIterator<Item = (f64, usize, bool)>,
        weights: &Weights,
        open: Open,
    ) -> Self {
        let rows = values
            .into_iter()
            .map(|(value, release, is)| (of_release(value, release, weights), is));
        Self::bounded(rows, open, Some(weights))
    }

    fn bounded(
        rows: impl Iterator<Item = (SampleRow, bool)>,
        open: Open,
        weights: Option<&Weights>,
    ) -> Self {
        let seen: Vec<(SampleRow, bool)> =
            rows.filter(|((value, ..), is_bound)| *is_bound || value.is_finite()).collect();
        let far_end = match open {
            Open::Above => f64::INFINITY,
            Open::Below => f64::NEG_INFINITY,
        };
        let far = seen.iter().any(|(_, is_bound)| *is_bound).then(|| {
            let moved = |&((value, weighs, stratum), is_bound): &(SampleRow, bool)| {
                (if is_bound { far_end } else { value }, weighs, stratum)
            };
            (Box::new(Self::sorted(seen.iter().map(moved).collect(), weights)), open)
        });
        let finite = seen.into_iter().map(|(row, _)| row).filter(|(value, ..)| value.is_finite());
        Self { far, ..Self::sorted(finite.collect(), weights) }
    }

    /// The same, of values whose mean can never lie below `floor`; without it 0 is taken where no value is below 0.
    #[must_use]
    pub fn not_below(self, floor: f64) -> Self {
        Self { floor: Some(floor), ..self }
    }

    /// What their mean can never lie below: 0 where no value is below that.
    fn floor(&self) -> Option<f64> {
        let is_positive = self.sorted.first().is_some_and(|least| *least >= 0.0);
        if is_positive { Some(0.0) } else { self.floor }
    }

    /// How many of the values are only bounds.
    pub fn bounds(&self) -> usize {
        let of =
            |(far, _): &(Box<Self>, Open)| far.sorted.iter().filter(|v| !v.is_finite()).count();
        self.far.as_ref().map_or(0, of)
    }

    /// So many values of equal weight would say as much (–): `(Σ w)² / Σ w²`.
    pub fn effective_rocks(&self) -> f64 {
        self.weights.as_ref().map_or(self.sorted.len() as f64, |weights| worth(weights))
    }

    /// The largest value, and whether it is only a bound; none of nothing. Where the truth lies above bounds, any of them may be the
    /// largest; where it lies below, one that is not the largest decides nothing.
    pub fn largest(&self) -> Option<(f64, bool)> {
        let most = *self.sorted.last()?;
        let far = self.far.as_ref().and_then(|(far, _)| far.sorted.last());
        Some((most, far.is_some_and(|far| far.total_cmp(&most).is_ne())))
    }

    /// The values in ascending order.
    pub fn values(&self) -> &[f64] {
        &self.sorted
    }

    /// Mean with its interval; none of nothing. The ends are the outer ones of Student's interval and of Hall's (1992), which knows that values
    /// are skewed: few rocks of a long tail tell that the mean lies far above rather than below.
    ///
    /// Where the lower end would be below what is possible, 0 where no value is below it or the floor `f` of the [values](Self::not_below), it is
    /// `f + (mean − f) · exp(−half/(mean − f))`, normal for the logarithm of how far the mean lies above.
    /// Summed in ascending order, so the same values give the same bits however they arrived. Weighted values: ratio of
    /// sums, with the variance `Σ w² (x − mean)² / (Σ w)²` of its linearisation (delta method), of releases stratum by stratum.
    pub fn mean(&self) -> Option<Mean> {
        let spread = match &self.weights {
            None => Spread::of(&self.sorted),
            Some(weights) => {
                let values = (&self.sorted[..], &weights[..]);
                Spread::weighted(values, self.strata.as_ref(), self.effective_rocks())
            }
        };
        let (value, below, above) = (spread.mean, spread.below(), spread.above());
        let low = self.floor().map_or(value - below, |floor| low_above(floor, value, below));
        // equal values say nothing of how far another may lie: none of ten seen to jump is no height of exactly zero
        let differ = self.sorted.first() < self.sorted.last();
        let ends = |end: f64| differ.then_some(end);
        let open = self.far.as_ref().map(|(_, open)| *open);
        let mean = Mean {
            value,
            low_95: ends(low).filter(|_| open != Some(Open::Below)),
            high_95: ends(value + above).filter(|_| open != Some(Open::Above)),
            censored: open.is_some(),
        };
        (!self.sorted.is_empty()).then_some(mean)
    }

    /// Percentile `p` (0 < p < 1) with its interval; none of nothing.
    pub fn percentile(&self, p: f64) -> Option<Percentile> {
        let seen = self.seen(p)?;
        let Some((far, open)) = &self.far else { return Some(seen) };
        Some(seen.between(&far.seen(p)?, *open))
    }

    /// Percentile `p` with each value that is only a bound at the far end of where it may lie, which is infinite; none where no value is one.
    pub fn far_percentile(&self, p: f64) -> Option<Percentile> {
        self.far.as_ref()?.0.seen(p)
    }

    /// The same, each value taken as it is.
    fn seen(&self, p: f64) -> Option<Percentile> {
        match &self.weights {
            None => Percentile::of(&self.sorted, p),
            Some(weights) => Percentile::weighted((&self.sorted, weights), p),
        }
    }

    /// The curve of exceedance, from the share 0.995 down to `1/n`.
    ///
    /// Each point is a percentile with its order-statistic interval, so the curve passes exactly through the
    /// percentiles of the tables. The band is pointwise: each point keeps 95 % by itself, not all at once.
    pub fn exceedance(&self) -> Vec<Exceedance> {
        let point = |share: f64| {
            let Percentile { value, low_95, high_95, .. } = self.percentile(1.0 - share)?;
            let censored = self.is_decided_by_bounds(1.0 - share);
            Some(Exceedance { share, value, low_95, high_95, censored })
        };
        shares(self.sorted.len()).into_iter().filter_map(point).collect()
    }

    /// Whether the far end of percentile `p` lies outside the interval that chance alone gives.
    fn is_decided_by_bounds(&self, p: f64) -> bool {
        let Some((far, open)) = &self.far else { return false };
        let (Some(seen), Some(far)) = (self.seen(p), far.seen(p)) else { return false };
        match open {
            // where too few say how far chance reaches, whatever lies beyond the value itself may have decided it
            Open::Above => far.value > seen.high_95.unwrap_or(seen.value),
            Open::Below => far.value < seen.low_95.unwrap_or(seen.value),
        }
    }

    /// A histogram with bars of a round width near that of Freedman and Diaconis (1981), `2 IQR / ∛n`;
    /// none of nothing.
    pub fn histogram(&self) -> Option<Histogram> {
        let (&least, &most) = (self.sorted.first()?, self.sorted.last()?);
        let width = self.bar_width(least, most);
        let first = (least / width).floor();
        let bars = (most / width).floor() - first + 1.0;
        let edges: Vec<f64> = (0..=bars as usize).map(|bar| (first + bar as f64) * width).collect();
        // Cut at the inner edges as they are: rounding of the outer ones can lose no value.
        let below = |edge: &f64| self.sorted.partition_point(|value| value < edge);
        let inner = edges[1..edges.len() - 1].iter().map(below);
        let cuts: Vec<usize> = [0].into_iter().chain(inner).chain([self.sorted.len()]).collect();
        let counts = cuts.windows(2).map(|pair| pair[1] - pair[0]).collect();
        Some(Histogram { edges, counts })
    }

    /// A round bar width, positive.
    fn bar_width(&self, least: f64, most: f64) -> f64 {
        let range = most - least;
        let quarter = |p| self.percentile(p).map_or(0.0, |quarter| quarter.value);
        let wanted = 2.0 * (quarter(0.75) - quarter(0.25)) / math::cbrt(self.sorted.len() as f64);
        let width = wanted.clamp(range / BARS.1, range / BARS.0);
        // All values equal: one bar, wide enough to be told from its neighbours in f64.
        if width > 0.0 { round_up(width) } else { round_up(least.abs().max(1.0) * 1e-3) }
    }
}

/// A value, what it weighs, and its stratum.
type SampleRow = (f64, f64, u16);

/// A value of a release, what it stands for, and its stratum.
fn of_release(value: f64, release: usize, weights: &Weights) -> SampleRow {
    (value, weights.of_release(release), weights.stratum_of(release) as u16)
}

/// A mean, how well it is known, and how skewed that is.
struct Spread {
    mean: f64,
    /// Standard error.
    error: f64,
    /// Skewness of the mean (–): of equal weights that of the values over `√n`.
    skewness: f64,
    /// Half width of Student's interval, in standard errors (–).
    student: f64,
}

/// Lower end of the interval of a mean that reaches so far below it, where nothing below the floor is possible. Rounding may put the mean itself there.
fn low_above(floor: f64, mean: f64, below: f64) -> f64 {
    let over = mean - floor;
    if below <= over {
        mean - below
    } else if over > 0.0 {
        floor + over * math::exp(-below / over)
    } else {
        mean
    }
}

/// A skewness of the mean below this is none (–).
const SYMMETRIC: f64 = 1e-6;

impl Spread {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let [squares, cubes] =
            [2, 3].map(|power| values.iter().map(|one| (one - mean).powi(power)).sum::<f64>());
        let error = (squares / (n - 1.0) / n).sqrt();
        Self { mean, error, skewness: skewness(squares, cubes), student: student_95(n - 1.0) }
    }

    /// The same of values with weights, worth so many of equal weight; of releases stratum by stratum.
    fn weighted((values, weights): (&[f64], &[f64]), strata: Option<&Strata>, worth: f64) -> Self {
        let pairs = || values.iter().zip(weights);
        let all: f64 = weights.iter().sum();
        let mean = pairs().map(|(x, w)| w * x).sum::<f64>() / all;
        let pulls = || pairs().map(|(x, w)| w * (x - mean));
        let [squares, cubes, freedom] = match strata {
            None => {
                let [squares, cubes] = [2, 3].map(|power| pulls().map(|z| z.powi(power)).sum());
                [squares, cubes, f64::INFINITY]
            }
            Some(strata) => strata.moments(pulls()),
        };
        // of a few heavy rocks the variance itself is known badly, whatever stratum they are of
        let student = student_95(freedom.min(worth - 1.0));
        let error = squares.sqrt() / all;
        Self { mean, error, skewness: skewness(squares, cubes), student }
    }

    /// How far the interval reaches below the mean.
    fn below(&self) -> f64 {
        self.error * self.student.max(self.hall(self.student))
    }

    /// How far it reaches above.
    fn above(&self) -> f64 {
        self.error * self.student.max(-self.hall(-self.student))
    }

    /// Where the studentised mean is as far out as `t` of one that is not skewed (–): the inverse of Hall's cubic
    /// `T + a T²/3 + a² T³/27 + a/6` with the skewness `a` of the mean.
    fn hall(&self, t: f64) -> f64 {
        let a = self.skewness;
        if a.abs() < SYMMETRIC { t } else { 3.0 / a * (math::cbrt(1.0 + a * (t - a / 6.0)) - 1.0) }
    }
}

/// Skewness of a sum from the sums of the squares and cubes of its parts (–); 0 where nothing varies.
fn skewness(squares: f64, cubes: f64) -> f64 {
    if squares > 0.0 { cubes / (squares * squares.sqrt()) } else { 0.0 }
}

/// The next of 1, 2, 5 times a power of ten.
fn round_up(width: f64) -> f64 {
    let power = math::pow(10_f64, math::log10(width).floor());
    [1.0, 2.0, 5.0]
        .map(|step| step * power)
        .into_iter()
        .find(|&step| step >= width)
        .unwrap_or(10.0 * power)
}

/// Shares at which a curve of `n` rocks is drawn: every half per cent, then ten a decade down to `1/n`.
fn shares(n: usize) -> Vec<f64> {
    let body = (1..200).rev().map(|step| f64::from(step) / 200.0);
    let tail = (24..).map(|tenth| math::pow(10_f64, -f64::from(tenth) / 10.0));
    body.chain(tail.take_while(|share| share * n as f64 >= 1.0)).collect()
}
