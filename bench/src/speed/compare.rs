//! The same releases under every scheme: what the statistics differ by.

use super::slope::Slope;
use rockfall::hazard::Sample;
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;
use rockfall::study::bootstrap::{Interval, Paired};

/// Draws of the intervals start here.
const SEED: u64 = 11;

/// One statistic under one scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// What it is, with its unit.
    pub name: &'static str,
    /// The scheme.
    pub scheme: Scheme,
    /// Of how many rocks.
    pub rocks: usize,
    /// The value, with the interval that this number of rocks gives.
    pub value: Interval,
    /// Value minus that of the first scheme, of the releases that both have; none for the first itself.
    pub difference: Option<Interval>,
}

/// Compares the journeys of each scheme with those of the first, as far as both have the same releases.
pub fn compare(slope: &Slope, journeys: &[(Scheme, Vec<Trajectory>)]) -> Vec<Compared> {
    // The slope falls along y: how far down a rock came is what a study asks for.
    let down = |one: &Trajectory| one.end.position_m.y + slope.terrain.origin_m.y;
    let speed = |one: &Trajectory| one.extremes.speed_m_s;
    let runout = Trajectory::runout_m;
    [
        percentiles("P50 of the runout (m)", journeys, runout, 0.5),
        percentiles("P95 of the runout (m)", journeys, runout, 0.95),
        percentiles("P50 of the way down the slope (m)", journeys, down, 0.5),
        means("mean of the largest speed (m/s)", journeys, speed),
    ]
    .concat()
}

/// A percentile under every scheme.
fn percentiles(
    name: &'static str,
    journeys: &[(Scheme, Vec<Trajectory>)],
    of: impl Fn(&Trajectory) -> f64,
    p: f64,
) -> Vec<Compared> {
    let first: Vec<f64> = journeys[0].1.iter().map(&of).collect();
    let one = |(number, (scheme, all)): (usize, &(Scheme, Vec<Trajectory>))| {
        let values: Vec<f64> = all.iter().map(&of).collect();
        let value = percentile(&values, p)?;
        let both = first.len().min(values.len());
        let pair = [first[..both].to_vec(), values[..both].to_vec()];
        let difference = (number > 0).then(|| Paired::new(&pair).shift(p, 1, SEED));
        Some(Compared { name, scheme: *scheme, rocks: values.len(), value, difference })
    };
    journeys.iter().enumerate().filter_map(one).collect()
}

/// A mean under every scheme.
fn means(
    name: &'static str,
    journeys: &[(Scheme, Vec<Trajectory>)],
    of: impl Fn(&Trajectory) -> f64,
) -> Vec<Compared> {
    let one = |(number, (scheme, all)): (usize, &(Scheme, Vec<Trajectory>))| {
        let gaps = all.iter().zip(&journeys[0].1).map(|(one, first)| of(one) - of(first));
        let difference = if number > 0 { mean(gaps) } else { None };
        let value = mean(all.iter().map(&of))?;
        Some(Compared { name, scheme: *scheme, rocks: all.len(), value, difference })
    };
    journeys.iter().enumerate().filter_map(one).collect()
}

fn percentile(values: &[f64], p: f64) -> Option<Interval> {
    let found = Sample::of(values.iter().copied()).percentile(p)?;
    let (low, high) = (found.low_95.unwrap_or(f64::NAN), found.high_95.unwrap_or(f64::NAN));
    Some(Interval { value: found.value, low, high })
}

fn mean(values: impl Iterator<Item = f64>) -> Option<Interval> {
    let found = Sample::of(values).mean()?;
    let (low, high) = (found.low_95.unwrap_or(f64::NAN), found.high_95.unwrap_or(f64::NAN));
    Some(Interval { value: found.value, low, high })
}
