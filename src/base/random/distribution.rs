//! Numbers that may be drawn.

use super::normal::Truncated;
use super::written::{Lognormal, NormalTable};
use super::{RandomStream, unit};
use crate::count::number_of;
use crate::error::Flaw;
use crate::math;

/// Largest number that a scene may hold, in whatever unit: what is computed from greater ones may overflow, and nothing on
/// a slope comes near it.
pub const LARGEST: f64 = 1e18;
/// Smallest size of a number that is not 0: a smaller one has no decimal power that it could be divided by.
pub const LEAST: f64 = 1e-100;

/// A number, or how it is distributed; valid by construction. In the unit of the key it stands for.
///
/// Written as `0.4`, `{ uniform = [0.2, 0.6] }`, `{ normal = { mean, sd, min, max } }`,
/// `{ lognormal = { median, sigma, min, max } }`, `{ triangular = [0.2, 0.4, 0.9] }` or
/// `{ values = [...], weights = [...] }`; `min`, `max` and `weights` may be left out.
/// Drawn by the inverse of the cumulative distribution: a bound truncates it exactly, without rejection.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    shape: DistributionFamily,
}

#[derive(Debug, Clone, PartialEq)]
enum DistributionFamily {
    Fixed(f64),
    Uniform {
        low: f64,
        high: f64,
    },
    Normal(Truncated),
    /// The logarithm is normal; the bounds are those of the value itself.
    Lognormal {
        log: Truncated,
        low: f64,
        high: f64,
    },
    Triangular {
        low: f64,
        mode: f64,
        high: f64,
    },
    /// Values of positive weight, each with the sum of the weights up to and including its own.
    Values(Vec<(f64, f64)>),
}

impl Distribution {
    /// Always this number.
    ///
    /// # Errors
    /// NaN and infinity are refused.
    pub fn fixed(value: f64) -> Result<Self, Flaw> {
        finite(&[value])?;
        Ok(Self { shape: DistributionFamily::Fixed(value) })
    }

    /// The number, if it is not drawn at all.
    pub fn as_fixed(&self) -> Option<f64> {
        if let DistributionFamily::Fixed(value) = self.shape { Some(value) } else { None }
    }

    /// The family it is drawn from, in one word.
    pub fn family(&self) -> &'static str {
        match self.shape {
            DistributionFamily::Fixed(_) => "fixed",
            DistributionFamily::Uniform { .. } => "uniform",
            DistributionFamily::Normal(_) => "normal",
            DistributionFamily::Lognormal { .. } => "lognormal",
            DistributionFamily::Triangular { .. } => "triangular",
            DistributionFamily::Values(_) => "listed values",
        }
    }

    /// Smallest and largest value it can take; infinite for a normal or lognormal without that bound.
    pub fn support(&self) -> (f64, f64) {
        match &self.shape {
            DistributionFamily::Fixed(value) => (*value, *value),
            DistributionFamily::Uniform { low, high }
            | DistributionFamily::Triangular { low, high, .. }
            | DistributionFamily::Lognormal { low, high, .. } => (*low, *high),
            DistributionFamily::Normal(normal) => (normal.low, normal.high),
            DistributionFamily::Values(values) => values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (v, _)| (a.min(*v), b.max(*v))),
        }
    }

    /// Smallest, median and largest value for estimates; where the support has no end,
    /// the value that one draw in a thousand passes.
    pub fn reckoned(&self) -> [f64; 3] {
        let (low, high) = self.support();
        let low = if low.is_finite() { low } else { self.quantile(0.001) };
        let high = if high.is_finite() { high } else { self.quantile(0.999) };
        [low, self.quantile(0.5), high]
    }

    /// The value below which the share `p` (–, in the open interval 0..1) of all draws lies.
    pub fn quantile(&self, p: f64) -> f64 {
        match &self.shape {
            DistributionFamily::Fixed(value) => *value,
            DistributionFamily::Uniform { low, high } => low * (1.0 - p) + high * p,
            DistributionFamily::Normal(normal) => normal.quantile(p),
            DistributionFamily::Lognormal { log, low, high } => {
                math::exp(log.quantile(p)).clamp(*low, *high)
            }
            DistributionFamily::Triangular { low, mode, high } => {
                triangular([*low, *mode, *high], p)
            }
            DistributionFamily::Values(values) => {
                let target = p * values[values.len() - 1].1;
                let index = values.partition_point(|(_, sum)| *sum <= target);
                values[index.min(values.len() - 1)].0
            }
        }
    }

    /// Draws one value; takes one word of the stream, even for a number that is not drawn.
    pub fn draw(&self, random: &mut RandomStream) -> f64 {
        self.quantile(unit(random))
    }

    /// Even between two numbers.
    ///
    /// # Errors
    /// Numbers that are not finite or not rising.
    pub fn uniform([low, high]: [f64; 2]) -> Result<Self, Flaw> {
        finite(&[low, high])?;
        if low >= high {
            return Err(Flaw::new(
                format!("found uniform = [{low}, {high}]"),
                "write the smaller bound first, or the number alone",
            ));
        }
        Ok(Self { shape: DistributionFamily::Uniform { low, high } })
    }

    pub(super) fn normal(as_written: &NormalTable) -> Result<Self, Flaw> {
        let NormalTable { mean, sd, min, max } = *as_written;
        finite(&[mean])?;
        positive("sd", sd)?;
        Ok(Self {
            shape: DistributionFamily::Normal(Truncated::new([mean, sd], bounds(min, max)?)?),
        })
    }

    pub(super) fn lognormal(as_written: &Lognormal) -> Result<Self, Flaw> {
        let Lognormal { median, sigma, min, max } = *as_written;
        positive("median", median)?;
        positive("sigma", sigma)?;
        if let Some(min) = min.filter(|min| *min < 0.0) {
            return Err(Flaw::new(
                format!("found min = {min} in a lognormal distribution"),
                "write a min of 0 or more: its values are never negative",
            ));
        }
        let [low, high] = bounds(min, max)?;
        // the distribution never reaches 0, and a rock of radius 0 is none
        let low = low.max(f64::MIN_POSITIVE);
        let log = Truncated::new([math::ln(median), sigma], [low, high].map(math::ln))?;
        Ok(Self { shape: DistributionFamily::Lognormal { log, low, high } })
    }

    /// Rising to the most frequent of three values and falling from there.
    ///
    /// # Errors
    /// Numbers that are not finite or not in order.
    pub fn triangular([low, mode, high]: [f64; 3]) -> Result<Self, Flaw> {
        finite(&[low, mode, high])?;
        if !(low <= mode && mode <= high && low < high) {
            return Err(Flaw::new(
                format!("found triangular = [{low}, {mode}, {high}]"),
                "write smallest, most frequent and largest value in this order",
            ));
        }
        Ok(Self { shape: DistributionFamily::Triangular { low, mode, high } })
    }

    /// One of the values, each as often as any other.
    ///
    /// # Errors
    /// No value, or one that is not finite.
    pub fn listed(values: Vec<f64>) -> Result<Self, Flaw> {
        Self::values(values, None)
    }

    /// One of the values, as often as the weights say; all alike without weights.
    ///
    /// # Errors
    /// No values, other numbers of values and weights, numbers that are not finite, weights below 0 or all 0.
    pub fn values(values: Vec<f64>, weights: Option<Vec<f64>>) -> Result<Self, Flaw> {
        let weights = weights.unwrap_or_else(|| vec![1.0; values.len()]);
        finite(&values)?;
        finite(&weights)?;
        if values.is_empty() || values.len() != weights.len() {
            let of = |count: usize, what| number_of(count as u64, what);
            return Err(Flaw::new(
                format!("found {} and {}", of(values.len(), "value"), of(weights.len(), "weight")),
                "write at least one value, and one weight for each",
            ));
        }
        let total: f64 = weights.iter().sum();
        if weights.iter().any(|&weight| weight < 0.0) || !(total > 0.0 && total.is_finite()) {
            return Err(Flaw::new(
                format!("found weights = {weights:?}"),
                "write weights of 0 or more, at least one above 0",
            ));
        }
        let mut sum = 0.0;
        let weighted = values.into_iter().zip(weights).filter(|(_, weight)| *weight > 0.0);
        let mut weighted: Vec<(f64, f64)> = weighted.collect();
        // rising, so that a quantile is one; stable, so that the same list gives the same draws
        weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let summed = weighted.into_iter().map(|(value, weight)| {
            sum += weight;
            (value, sum)
        });
        Ok(Self { shape: DistributionFamily::Values(summed.collect()) })
    }
}

/// Quantile of the triangular distribution.
fn triangular([low, mode, high]: [f64; 3], p: f64) -> f64 {
    let span = high - low;
    if p * span < mode - low {
        low + (p * span * (mode - low)).sqrt()
    } else {
        high - ((1.0 - p) * span * (high - mode)).sqrt()
    }
}

fn finite(numbers: &[f64]) -> Result<(), Flaw> {
    let Some(number) = numbers.iter().find(|number| !(-LARGEST..=LARGEST).contains(*number)) else {
        return Ok(());
    };
    let remedy = if number.is_finite() {
        format!("write a number of at most {LARGEST:e}")
    } else {
        "write a finite number".to_owned()
    };
    Err(Flaw::new(format!("found {number:?}"), remedy))
}

fn positive(key: &str, value: f64) -> Result<(), Flaw> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Flaw::new(format!("found {key} = {value}"), format!("write {key} above 0")))
}

/// Truncation bounds, infinite where none is written.
fn bounds(min: Option<f64>, max: Option<f64>) -> Result<[f64; 2], Flaw> {
    let (low, high) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
    if low < high {
        return Ok([low, high]);
    }
    Err(Flaw::new(
        format!("found min = {low} and max = {high}"),
        "write a min below the max, or the number alone",
    ))
}

#[cfg(test)]
mod tests;
