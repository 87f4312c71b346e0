//! The curve of energy exceedance λ(E ≥ e), and the energy of a return period on it.

use super::super::classes::{RATIO, lower_end_of};
use super::rate::{Running, Sums};
use crate::frequency::Weights;
use serde::{Deserialize, Serialize};

/// A point of the curve: at the lower end of a class of energy that a rock fell in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ExceedancePoint {
    /// Energy (J).
    pub energy_j: f64,
    /// Passages a year with at least that much (1/year).
    pub per_year: f64,
    /// Lower end of the 95 % interval (1/year).
    pub low_95: f64,
    /// Upper end of the 95 % interval (1/year).
    pub high_95: f64,
    /// Change with the exponents (1/year).
    pub by_exponent: f64,
}

/// The energy that is passed once in so many years.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ReturnEnergy {
    /// Return period (years).
    pub years: f64,
    /// Energy (J) with λ(E ≥ e) = 1/T; none where rocks come more seldom.
    pub energy_j: Option<f64>,
    /// Lower end of the 95 % interval (J); 0: they may come more seldom.
    pub low_95: f64,
    /// Upper end of the 95 % interval (J); none where too few rocks bound it.
    pub high_95: Option<f64>,
    /// Change with the logarithm of all rates (J).
    pub by_log_rate: Option<f64>,
    /// Change with the exponents (J).
    pub by_exponent: Option<f64>,
}

/// The curve of rocks given by class, stratum and sums, by **falling** class; its points fall in energy too.
pub(super) fn curve(
    entries: impl Iterator<Item = (u16, u16, Sums)>,
    running: &mut Running<'_>,
) -> Vec<ExceedancePoint> {
    let mut points: Vec<ExceedancePoint> = Vec::new();
    let mut open = None;
    for (class, stratum, sums) in entries {
        if open.is_some_and(|before| before != class) {
            points.extend(open.map(|before| point(before, running)));
        }
        running.add(stratum, &sums);
        open = Some(class);
    }
    points.extend(open.map(|before| point(before, running)));
    points
}

fn point(class: u16, running: &Running<'_>) -> ExceedancePoint {
    let [per_year, low_95, high_95] = running.estimate();
    let by_exponent = running.by_exponent();
    ExceedancePoint { energy_j: lower_end_of(class), per_year, low_95, high_95, by_exponent }
}

/// Step by which rate and exponent are moved to see how an energy follows (–).
const STEP: f64 = 1e-3;

/// The energy of a return period on a curve of falling points.
///
/// λ is taken as even in the logarithm of the energy inside a class, so that the energy is known to far better than the
/// class is wide. The interval is that of the rate, read along the other axis: an energy belongs to it if 1/T lies in
/// the interval of its λ.
pub(super) fn return_energy(
    points: &[ExceedancePoint],
    weights: &Weights,
    years: f64,
    has_exponent: bool,
) -> ReturnEnergy {
    let nothing_seen = Running::new(weights, 1.0).estimate()[2];
    let at = |of: &dyn Fn(&ExceedancePoint) -> f64, start| reached(points, of, start, 1.0 / years);
    let energy_j = at(&|p| p.per_year, 0.0).filter(|energy| *energy > 0.0);
    let slope = |moved: &dyn Fn(&ExceedancePoint, f64) -> f64| {
        let end = |step: f64| at(&|p| moved(p, step), 0.0);
        Some((end(STEP)? - end(-STEP)?) / (2.0 * STEP))
    };
    ReturnEnergy {
        years,
        energy_j,
        low_95: at(&|p| p.low_95, 0.0).unwrap_or(0.0),
        high_95: at(&|p| p.high_95, nothing_seen),
        by_log_rate: energy_j.and_then(|_| slope(&|p, step| p.per_year * (1.0 + step))),
        by_exponent: energy_j
            .filter(|_| has_exponent)
            .and_then(|_| slope(&|p, step| p.per_year + step * p.by_exponent)),
    }
}

/// The largest energy (J) whose λ reaches `wanted` (1/year); 0 if none does, none if λ is that large even above all
/// points, where it is `start`.
fn reached(
    points: &[ExceedancePoint],
    of: impl Fn(&ExceedancePoint) -> f64,
    start: f64,
    wanted: f64,
) -> Option<f64> {
    let mut above = start;
    if above >= wanted {
        return None;
    }
    for point in points {
        let here = of(point);
        if here >= wanted {
            let share = (here - wanted) / (here - above);
            return Some(point.energy_j * libm::pow(RATIO, share));
        }
        above = here;
    }
    Some(0.0)
}
