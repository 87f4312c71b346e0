//! The curve of energy exceedance λ(E ≥ e), and the energy of a return period on it.

use super::super::classes::{RATIO, class_of, lower_end_of};
use super::super::rate::{Limits, Running, Sums};
use crate::frequency::Weights;
use crate::math;
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
    /// Change with the logarithm of all rates (J), over 15 % of them either way.
    pub by_log_rate: Option<f64>,
    /// Change with the exponents (J), over 0.05 either way.
    pub by_exponent: Option<f64>,
}

/// What λ(E ≥ e) can reach, class by class of energy.
pub(super) struct Ceilings {
    limits: Vec<Limits>,
    /// Upper end of λ where no rock was seen (1/year); it never rises with the class.
    unseen: Vec<f64>,
}

/// Energy beyond which nothing is told apart (J): a hillside that falls off a mountain.
const MOST_J: f64 = 1e15;

impl Ceilings {
    /// Of strata that can have so much energy each (J).
    pub(super) fn of(weights: &Weights, most_j: &[f64]) -> Self {
        Self::beside(&Running::new(weights), (weights, most_j))
    }

    /// The same, where `nothing` has happened but may.
    pub(super) fn beside(nothing: &Running<'_>, (weights, most_j): (&Weights, &[f64])) -> Self {
        let above = |class: u16| Limits::above(weights, most_j, lower_end_of(class));
        let limits: Vec<Limits> = (0..=class_of(MOST_J)).map(above).collect();
        let unseen = limits.iter().map(|limits| nothing.estimate(limits)[2]).collect();
        Self { limits, unseen }
    }

    fn at(&self, class: u16) -> &Limits {
        &self.limits[usize::from(class).min(self.limits.len() - 1)]
    }

    /// The largest energy (J) at which λ may still reach `wanted` (1/year): above all that was seen as far as rocks can have
    /// it, below by the upper ends of the points. 0 where λ does not reach it at any; none where nothing bounds it.
    fn highest(&self, points: &[ExceedancePoint], wanted: f64) -> Option<f64> {
        let seen = points.first().map_or(0, |point| class_of(point.energy_j * RATIO.sqrt()));
        let free = self.unseen.partition_point(|high| *high >= wanted);
        if free > usize::from(seen) + 1 {
            // the last class in which rocks can be heavy enough: its upper end bounds them
            return (free < self.unseen.len()).then(|| lower_end_of(free as u16));
        }
        Some(reached(points, |point| point.high_95, wanted).unwrap_or(0.0))
    }
}

/// The curve of rocks given by class, stratum and sums, by **falling** class; its points fall in energy too.
pub(super) fn curve(
    entries: impl Iterator<Item = (u16, u16, Sums)>,
    running: &mut Running<'_>,
    ceilings: &Ceilings,
) -> Vec<ExceedancePoint> {
    let mut points: Vec<ExceedancePoint> = Vec::new();
    let mut open = None;
    for (class, stratum, sums) in entries {
        if open.is_some_and(|before| before != class) {
            points.extend(open.map(|before| point(before, running, ceilings)));
        }
        running.add(stratum, &sums);
        open = Some(class);
    }
    points.extend(open.map(|before| point(before, running, ceilings)));
    // what has the larger energy has the smaller too: λ at a lower energy is no less, and so are both ends
    let mut ends = (0.0f64, 0.0f64);
    for point in &mut points {
        ends = (ends.0.max(point.low_95), ends.1.max(point.high_95));
        (point.low_95, point.high_95) = ends;
    }
    points
}

fn point(class: u16, running: &Running<'_>, ceilings: &Ceilings) -> ExceedancePoint {
    let [per_year, low_95, high_95] = running.estimate(ceilings.at(class));
    let by_exponent = running.by_exponent();
    ExceedancePoint { energy_j: lower_end_of(class), per_year, low_95, high_95, by_exponent }
}

/// How far the logarithm of the rates is moved either way to see how an energy follows (–): over several classes of energy and the rocks in
/// them, as inside one class the curve knows no slope of its own.
const RATE_STEP: f64 = 0.15;
/// The same of the exponents (–): it moves rates by about as much.
const EXPONENT_STEP: f64 = 0.05;

/// The energy of a return period on a curve of falling points.
///
/// λ is taken as even in the logarithm of the energy inside a class, so that the energy is known to far better than the
/// class is wide. The interval is that of the rate, read along the other axis: an energy belongs to it if 1/T lies in
/// the interval of its λ.
pub(super) fn return_energy(
    points: &[ExceedancePoint],
    ceilings: &Ceilings,
    years: f64,
    has_exponent: bool,
) -> ReturnEnergy {
    let at = |of: &dyn Fn(&ExceedancePoint) -> f64| reached(points, of, 1.0 / years);
    let energy_j = at(&|p| p.per_year);
    let slope = |moved: &dyn Fn(&ExceedancePoint, f64) -> f64, step: f64| {
        let [less, more] = [-step, step].map(|step| at(&|p| moved(p, step)));
        // where rarer rocks have no such energy, the other side tells
        Some((more? - less.or(energy_j)?) / if less.is_some() { 2.0 * step } else { step })
    };
    ReturnEnergy {
        years,
        energy_j,
        low_95: at(&|p| p.low_95).unwrap_or(0.0),
        high_95: ceilings.highest(points, 1.0 / years),
        by_log_rate: energy_j
            .and_then(|_| slope(&|p, step| p.per_year * math::exp(step), RATE_STEP)),
        by_exponent: energy_j
            .filter(|_| has_exponent)
            .and_then(|_| slope(&|p, step| p.per_year + step * p.by_exponent, EXPONENT_STEP)),
    }
}

/// The largest energy (J) whose λ reaches `wanted` (1/year); none if none does.
fn reached(
    points: &[ExceedancePoint],
    of: impl Fn(&ExceedancePoint) -> f64,
    wanted: f64,
) -> Option<f64> {
    let mut above = 0.0;
    for point in points {
        let here = of(point);
        if here >= wanted {
            let share = ((here - wanted) / (here - above)).clamp(0.0, 1.0);
            return Some(point.energy_j * math::pow(RATIO, share));
        }
        above = here;
    }
    None
}
