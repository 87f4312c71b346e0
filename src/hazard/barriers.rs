//! Barriers judged on the rocks that arrive: what they stop, what passes, what a design by the scene's rule asks for.
//!
//! A barrier does not change a rock's way in the computation. A rock that the first barrier on its way stops counts as
//! not arriving at those behind it: with several in line, each sees what the ones before have let through.

use super::lines::CrossingRow;
use super::proportion::Proportion;
use super::sample::Sample;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A barrier on one of the evaluation lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Barrier {
    /// Its name, and that of its line in `crossings.csv`.
    pub name: String,
    /// Height above the ground (m), positive.
    pub height_m: f64,
    /// Energy that it takes (J), positive.
    pub capacity_j: f64,
    /// How a design is derived; none leaves it out.
    pub design: Option<Rule>,
}

/// A design rule: a percentile and factors, each by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rule {
    /// Percentile of energy and height over the rocks that arrive (per cent), above 0 and below 100.
    pub percentile: f64,
    /// Factors on the speed (–); they enter the energy squared.
    #[serde(default)]
    pub speed_factors: BTreeMap<String, f64>,
    /// Factors on the mass (–).
    #[serde(default)]
    pub mass_factors: BTreeMap<String, f64>,
    /// Factors on the height (–).
    #[serde(default)]
    pub height_factors: BTreeMap<String, f64>,
    /// Free height to be kept above the design height (m).
    pub free_height_m: f64,
}

/// What a rule asks of a barrier at its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// The percentile of total energy (J).
    pub energy_percentile_j: f64,
    /// With all factors (J).
    pub energy_j: f64,
    /// The percentile of the height of the rock's highest point (m).
    pub height_percentile_m: f64,
    /// With all factors and the free height (m).
    pub height_m: f64,
}

/// What a barrier does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BarrierSummary {
    /// The barrier.
    #[serde(flatten)]
    pub barrier: Barrier,
    /// Rocks that arrive, those stopped before left out, as a share of all releases.
    pub arriving: Proportion,
    /// Rocks stopped, as a share of those that arrive.
    pub stopped: Proportion,
    /// Rocks that reach above its upper edge.
    pub over: usize,
    /// Rocks below its edge with more energy than it takes.
    pub through: usize,
    /// What the rule asks for, from the rocks that arrive; none without rule or rocks.
    pub design_values: Option<Design>,
    /// Height (m) and share of the arriving rocks that would be stopped (–) at equal capacity.
    pub by_height: Vec<(f64, f64)>,
}

/// Heights of the sensitivity over the barrier's own (–).
const HEIGHTS: [f64; 7] = [0.5, 0.75, 0.9, 1.0, 1.1, 1.25, 1.5];

#[derive(Debug, Default)]
struct Arrivals {
    /// Height of the highest point (m) and total energy (J).
    rocks: Vec<(f64, f64)>,
}

/// Judges all barriers; `rows` are first crossings, release by release.
///
/// # Errors
/// Passes on what reading a row says.
pub fn judge<E>(
    barriers: &[Barrier],
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
    releases: usize,
) -> Result<Vec<BarrierSummary>, E> {
    let mut arrivals: Vec<Arrivals> = barriers.iter().map(|_| Arrivals::default()).collect();
    let mut rock: Vec<(f64, usize, CrossingRow)> = Vec::new();
    for row in rows {
        let row = row?;
        if rock.first().is_some_and(|(_, _, first)| first.index != row.index) {
            send(barriers, &mut rock, &mut arrivals);
        }
        if let Some(which) = barriers.iter().position(|barrier| barrier.name == row.line) {
            rock.push((row.time_s, which, row));
        }
    }
    send(barriers, &mut rock, &mut arrivals);
    let summary = |(barrier, arrivals): (&Barrier, Arrivals)| arrivals.summary(barrier, releases);
    Ok(barriers.iter().zip(arrivals).map(summary).collect())
}

/// Sends one rock through the barriers on its way until one stops it.
fn send(
    barriers: &[Barrier],
    rock: &mut Vec<(f64, usize, CrossingRow)>,
    arrivals: &mut [Arrivals],
) {
    rock.sort_by(|one, other| one.0.total_cmp(&other.0));
    for (_, which, row) in rock.iter() {
        // where there is no ground below, nothing says how high it is: it is let through
        let top_m =
            if row.height_m.is_nan() { f64::INFINITY } else { row.height_m + 2.0 * row.radius_m };
        let total_j = row.total_j();
        arrivals[*which].rocks.push((top_m, total_j));
        if stops(&barriers[*which], top_m, total_j) {
            break;
        }
    }
    rock.clear();
}

fn stops(barrier: &Barrier, top_m: f64, total_j: f64) -> bool {
    top_m <= barrier.height_m && total_j <= barrier.capacity_j
}

impl Arrivals {
    fn summary(&self, barrier: &Barrier, releases: usize) -> BarrierSummary {
        let count = |of: &dyn Fn(f64, f64) -> bool| {
            self.rocks.iter().filter(|(top_m, total_j)| of(*top_m, *total_j)).count()
        };
        let n = self.rocks.len();
        let stopped = count(&|top_m, total_j| stops(barrier, top_m, total_j));
        let over = count(&|top_m, _| top_m > barrier.height_m);
        let share = |height_m: f64| {
            let other = Barrier { height_m, ..barrier.clone() };
            count(&|top_m, total_j| stops(&other, top_m, total_j)) as f64 / n.max(1) as f64
        };
        BarrierSummary {
            barrier: barrier.clone(),
            arriving: Proportion::new(n, releases),
            stopped: Proportion::new(stopped, n),
            over,
            through: n - stopped - over,
            design_values: barrier.design.as_ref().and_then(|rule| self.design(rule)),
            by_height: HEIGHTS.map(|h| h * barrier.height_m).map(|h| (h, share(h))).into(),
        }
    }

    fn design(&self, rule: &Rule) -> Option<Design> {
        let p = rule.percentile / 100.0;
        let value = |of: fn(&(f64, f64)) -> f64| {
            Some(Sample::of(self.rocks.iter().map(of)).percentile(p)?.value)
        };
        let product = |factors: &BTreeMap<String, f64>| factors.values().product::<f64>();
        let (energy, height) = (value(|rock| rock.1)?, value(|rock| rock.0)?);
        let speed = product(&rule.speed_factors);
        Some(Design {
            energy_percentile_j: energy,
            energy_j: energy * speed * speed * product(&rule.mass_factors),
            height_percentile_m: height,
            height_m: height * product(&rule.height_factors) + rule.free_height_m,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn barrier(name: &str, height_m: f64, capacity_j: f64) -> Barrier {
        Barrier { name: name.to_owned(), height_m, capacity_j, design: None }
    }

    fn row(index: usize, line: &str, time_s: f64, height_m: f64, joule: f64) -> CrossingRow {
        CrossingRow {
            index,
            line: line.to_owned(),
            time_s,
            along_m: 0.0,
            height_m,
            speed_m_s: 1.0,
            translational_j: joule,
            rotational_j: 0.0,
            height_normal_m: height_m,
            descent_deg: 0.0,
            mass_kg: 1.0,
            radius_m: 0.5,
            times: 1,
            position_m: [0.0; 3],
        }
    }

    /// By hand: rock 0 is stopped by the upper net and never seen below; rock 1 flies over the upper one and is stopped
    /// below; rock 2 breaks through both; rock 3 meets the lower one only.
    #[test]
    fn what_the_first_stops_does_not_arrive_at_the_second() {
        let mut upper = barrier("upper", 3.0, 100.0);
        let speed_factors = [("a".to_owned(), 1.02), ("b".to_owned(), 1.1)].into();
        let (mass_factors, height_factors) = ([("c".to_owned(), 1.02)].into(), BTreeMap::new());
        upper.design = Some(Rule {
            percentile: 50.0,
            speed_factors,
            mass_factors,
            height_factors,
            free_height_m: 0.5,
        });
        let barriers = [upper, barrier("lower", 2.0, 200.0)];
        let rows = [
            row(0, "lower", 2.0, 0.0, 10.0),
            row(0, "upper", 1.0, 2.0, 100.0),
            row(1, "upper", 1.0, 2.5, 50.0),
            row(1, "lower", 2.0, 0.5, 60.0),
            row(2, "upper", 1.0, 0.0, 500.0),
            row(2, "lower", 2.0, 0.0, 400.0),
            row(3, "lower", 2.0, 0.0, 200.0),
        ];
        let found = judge(&barriers, rows.into_iter().map(Ok::<_, Infallible>), 8).unwrap();
        let counts = |k: usize| {
            let at: &BarrierSummary = &found[k];
            [at.arriving.count, at.stopped.count, at.over, at.through]
        };
        assert_eq!(counts(0), [3, 1, 1, 1]);
        assert_eq!(counts(1), [3, 2, 0, 1]);
        assert_eq!(found[0].arriving.of, 8);
        let design = found[0].design_values.as_ref().unwrap();
        assert!((design.energy_j - 100.0 * (1.02_f64 * 1.1).powi(2) * 1.02).abs() < 1e-9);
        assert!((design.height_m - 3.5).abs() < 1e-12);
    }
}
