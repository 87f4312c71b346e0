//! The curve of energy exceedance λ(E ≥ e), and the energy of a return period on it.

use super::super::classes::{RATIO, class_of, lower_end_of};
use super::super::rate::{Limits, Running, Sums, reaches};
use super::energies::EnergyClass;
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

/// How often more may come than any rock had: the upper end of λ between the energy before, or the largest seen, and this one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UnseenPoint {
    /// Energy (J) up to which it holds.
    pub energy_j: f64,
    /// Upper end of the 95 % interval (1/year).
    pub high_95: f64,
}

/// The energy that is passed once in so many years.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ReturnEnergy {
    /// Return period (years).
    pub years: f64,
    /// Energy (J) with λ(E ≥ e) = 1/T; none where rocks come more seldom.
    pub energy_j: Option<f64>,
    /// Width of the class of energies that it is read from over its lower end (–); none where it is the energy of a rock. The interval
    /// holds the classes of its ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class_width: Option<f64>,
    /// Lower end of the 95 % interval (J); 0: they may come more seldom.
    pub low_95: f64,
    /// Upper end of the 95 % interval (J); none where too few rocks bound it.
    pub high_95: Option<f64>,
    /// Change with the logarithm of all rates (J), over 15 % of them either way.
    pub by_log_rate: Option<f64>,
    /// Change with the exponents (J), over 0.05 either way.
    pub by_exponent: Option<f64>,
}

/// A place where the curve steps: a class of energy, whose rocks lie anywhere in it, or the energy of a rock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// With the least energy.
    pub(super) point: ExceedancePoint,
    /// The class of that energy.
    pub(super) class: u16,
    /// Largest over least energy (–): 1 of a rock.
    width: f64,
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

    /// Upper ends above the largest energy seen, by rising energy up to the largest that sizes and terrain allow.
    pub(super) fn unseen_above(&self, seen: &[Step]) -> Vec<UnseenPoint> {
        let from = seen.first().map_or(0, |step| usize::from(step.class) + 1);
        let possible = self.unseen.partition_point(|high| *high > 0.0);
        let above = self.unseen.get(from..possible).unwrap_or_default();
        let mut class = from;
        let of_run = |equal: &[f64]| {
            class += equal.len();
            UnseenPoint { energy_j: lower_end_of(class as u16), high_95: equal[0] }
        };
        above.chunk_by(|one, next| one.total_cmp(next).is_eq()).map(of_run).collect()
    }

    /// The largest energy (J) at which λ may still reach `wanted` (1/year): above all that was seen as far as rocks can have
    /// it, below by the upper ends of the steps. 0 where λ does not reach it at any; none where nothing bounds it.
    fn highest(&self, steps: &[Step], wanted: f64) -> Option<f64> {
        let seen = steps.first().map_or(0, |step| step.class);
        let free = self.unseen.partition_point(|high| *high >= wanted);
        if free > usize::from(seen) + 1 {
            // the last class in which rocks can be heavy enough: its upper end bounds them
            return (free < self.unseen.len()).then(|| lower_end_of(free as u16));
        }
        let found = reached(steps, |point| point.high_95, wanted);
        Some(found.map_or(0.0, |(step, _)| step.point.energy_j * step.width))
    }
}

/// The curve of rocks given by class, stratum and sums, by **falling** class; its steps fall in energy too. From the largest energy
/// on down it also steps where rocks may still come with no more: its upper end rises there.
pub(super) fn curve(
    entries: impl Iterator<Item = (u16, u16, Sums)>,
    running: &mut Running<'_>,
    ceilings: &Ceilings,
) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut open = None;
    let of_class = |class, running: &Running<'_>| {
        let energy_j = lower_end_of(class);
        Step { point: point(energy_j, class, (running, ceilings)), class, width: RATIO }
    };
    let down_to = |below: u16, before: u16, running: &Running<'_>| -> Vec<Step> {
        let between = running.open_classes(below + 1..before);
        std::iter::once(before).chain(between).map(|class| of_class(class, running)).collect()
    };
    for (class, stratum, sums) in entries {
        if let Some(before) = open.filter(|before| *before != class) {
            steps.extend(down_to(class, before, running));
        }
        running.add(stratum, &sums);
        open = Some(class);
    }
    steps.extend(open.into_iter().flat_map(|before| down_to(0, before, running)));
    never_rising(&mut steps);
    steps
}

/// The same curve, finer in the classes that decide an energy of a return period (years); `rocks` by **falling** energy.
pub(super) fn resolved(
    (smooth, rocks): (&[Step], &[EnergyClass]),
    running: &mut Running<'_>,
    ceilings: &Ceilings,
    years: &[f64],
) -> Vec<Step> {
    let wanted = years.iter().map(|years| 1.0 / years);
    let of: [fn(&ExceedancePoint) -> f64; 3] = [|p| p.per_year, |p| p.low_95, |p| p.high_95];
    let deciding =
        |wanted: f64| of.map(|of| reached(smooth, of, wanted).map(|(step, _)| step.class));
    let deciding: Vec<u16> = wanted.flat_map(deciding).flatten().collect();
    running.clear();
    let mut steps = Vec::new();
    let mut left = rocks;
    for step in smooth {
        let class = step.class;
        let (inside, lower) = left.split_at(left.partition_point(|rocks| rocks.class >= class));
        left = lower;
        // what lies across the lower end of a class is met in the one below
        let is_deciding = deciding.iter().any(|at| *at == class || *at == class + 1);
        if is_deciding && running.open_classes(class..class + 1).next().is_some() {
            // what may still come lies anywhere in its class, the rocks seen below it
            let point = point(step.point.energy_j, class, (running, ceilings));
            steps.push(Step { point, ..*step });
        }
        for equal in inside.chunk_by(|one, next| one.lower_j.total_cmp(&next.lower_j).is_eq()) {
            for rocks in equal {
                running.add(rocks.stratum, &Sums::many(rocks.rocks));
            }
            if is_deciding {
                let EnergyClass { lower_j, upper_j, .. } = equal[0];
                let width =
                    if upper_j > lower_j && lower_j > 0.0 { upper_j / lower_j } else { 1.0 };
                steps.push(Step {
                    point: point(lower_j, class, (running, ceilings)),
                    class,
                    width,
                });
            }
        }
        if !is_deciding {
            steps.push(*step);
        }
    }
    never_rising(&mut steps);
    steps
}

/// What has the larger energy has the smaller too: λ at a lower energy is no less, and so are both ends.
fn never_rising(steps: &mut [Step]) {
    let mut ends = (0.0f64, 0.0f64);
    for Step { point, .. } in steps {
        ends = (ends.0.max(point.low_95), ends.1.max(point.high_95));
        (point.low_95, point.high_95) = ends;
    }
}

fn point(
    energy_j: f64,
    class: u16,
    (running, ceilings): (&Running<'_>, &Ceilings),
) -> ExceedancePoint {
    let [per_year, low_95, high_95] = running.estimate(ceilings.at(class));
    let by_exponent = running.by_exponent();
    ExceedancePoint { energy_j, per_year, low_95, high_95, by_exponent }
}

/// How far the logarithm of the rates is moved either way to see how an energy follows (–): over several classes of energy and the rocks in
/// them, as inside one class the curve knows no slope of its own.
const RATE_STEP: f64 = 0.15;
/// The same of the exponents (–): it moves rates by about as much.
const EXPONENT_STEP: f64 = 0.05;

/// The energy of a return period on a curve of falling steps; `smooth` is the same by classes alone, from which its slopes are taken.
///
/// It is that of the rock with which λ reaches 1/T. Where a class decides and rocks in it are not told apart, λ is taken as even in the
/// logarithm of the energy inside it, and the interval reaches to its far ends. The interval is that of the rate, read along the other axis:
/// an energy belongs to it if 1/T lies in the interval of its λ.
pub(super) fn return_energy(
    (steps, smooth): (&[Step], &[Step]),
    ceilings: &Ceilings,
    years: f64,
    has_exponent: bool,
) -> ReturnEnergy {
    let found = |steps, of: &dyn Fn(&ExceedancePoint) -> f64| reached(steps, of, 1.0 / years);
    let inside = |(step, share): (Step, f64)| step.point.energy_j * math::pow(step.width, share);
    let reached = found(steps, &|p| p.per_year);
    let energy_j = reached.map(inside);
    let width = reached.map(|(step, _)| step.width - 1.0);
    let at = |of: &dyn Fn(&ExceedancePoint) -> f64| found(smooth, of).map(inside);
    let slope = |moved: &dyn Fn(&ExceedancePoint, f64) -> f64, step: f64| {
        let [less, more] = [-step, step].map(|step| at(&|p| moved(p, step)));
        // where rarer rocks have no such energy, the other side tells: rates that fall, exponents that rise
        let sides = [less, more].into_iter().flatten().count();
        let here = || at(&|p| p.per_year).filter(|_| sides > 0);
        Some((more.or_else(here)? - less.or_else(here)?) / (sides as f64 * step))
    };
    ReturnEnergy {
        years,
        energy_j,
        class_width: width.filter(|width| *width > 0.0),
        low_95: found(steps, &|p| p.low_95).map_or(0.0, |(step, _)| step.point.energy_j),
        high_95: ceilings.highest(steps, 1.0 / years),
        by_log_rate: energy_j
            .and_then(|_| slope(&|p, step| p.per_year * math::exp(step), RATE_STEP)),
        by_exponent: energy_j
            .filter(|_| has_exponent)
            .and_then(|_| slope(&|p, step| p.per_year + step * p.by_exponent, EXPONENT_STEP)),
    }
}

/// The first step, of the largest energy, whose λ reaches `wanted` (1/year), and at which share of its width it does; none if none does.
fn reached(
    steps: &[Step],
    of: impl Fn(&ExceedancePoint) -> f64,
    wanted: f64,
) -> Option<(Step, f64)> {
    let mut above = 0.0;
    for step in steps {
        let here = of(&step.point);
        if reaches(here, wanted) {
            return Some((*step, ((here - wanted) / (here - above)).clamp(0.0, 1.0)));
        }
        above = here;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the exponents rise, rare large rocks get rarer, and none has the energy of the return period any more: the other side tells the slope.
    /// By hand: λ reaches 1 a year at the lower end of its class, with 1.05 for it at half of the last class, `100 √RATIO`.
    #[test]
    fn an_energy_that_rising_exponents_leave_without_rocks_has_a_slope() {
        let step = |energy_j, per_year, by_exponent| {
            let point =
                ExceedancePoint { energy_j, per_year, low_95: 0.0, high_95: 2.0, by_exponent };
            Step { point, class: class_of(energy_j), width: RATIO }
        };
        let steps = [step(200.0, 0.95, 0.0), step(100.0, 1.0, -1.0)];
        let ceilings = Ceilings { limits: Vec::new(), unseen: Vec::new() };
        let found = return_energy((&steps, &steps), &ceilings, 1.0, true);
        assert!((found.energy_j.unwrap() - 100.0).abs() < 1e-9);
        let slope = -100.0 * (RATIO.sqrt() - 1.0) / EXPONENT_STEP;
        assert!((found.by_exponent.unwrap() / slope - 1.0).abs() < 1e-9, "{found:?}");
    }
}
