//! Barriers judged on the rocks that arrive: what they stop, what passes, what a design by the scene's rule asks for.
//!
//! A barrier does not change a rock's way in the computation. A rock that the first barrier on its way stops counts as
//! not arriving at those behind it: with several in line, each sees what the ones before have let through.

mod weighted;

use super::arrival::{Arrival, sample};
use super::design::{Design, Rule};
use super::lines::{CrossingRow, by_rock};
use super::open::OpenRocks;
use super::proportion::Proportion;
use super::rate::share_if_any;
use super::totals::Largest;
use super::{Statistic, statistic};
use crate::frequency::Weights;
use serde::{Deserialize, Serialize};
use std::iter;
use weighted::{arriving, stopped_at};

/// A barrier on one of the evaluation lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Barrier {
    /// Its name, and that of its line in `crossings.csv`.
    pub name: String,
    /// Height above the ground (m), positive.
    pub height_m: f64,
    /// Largest total energy that it can stop (J), positive.
    pub capacity_j: f64,
    /// How a design is derived; none leaves it out.
    pub design: Option<Rule>,
    /// Where else it might stand.
    #[serde(default)]
    pub elsewhere: Vec<Elsewhere>,
}

/// Another place for a barrier, beside its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Elsewhere {
    /// Distance from its own place (m), positive on the left of its line.
    pub offset_m: f64,
    /// Name of the evaluation line there.
    pub line: String,
}

/// What a barrier does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BarrierSummary {
    /// The barrier.
    #[serde(flatten)]
    pub barrier: Barrier,
    /// Rocks whose way crosses its line, stopped before or not.
    pub crossing: usize,
    /// Rocks that arrive, those stopped before left out, as a share of all releases.
    pub arriving: Proportion,
    /// Rocks that may still arrive, with any energy: what is missing in energies and heights. None of none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub may_still_come: Option<Proportion>,
    /// Rocks stopped, as a share of those that arrive.
    pub stopped: Proportion,
    /// Rocks that reach above its upper edge, those of unknown height among them.
    pub over: usize,
    /// Rocks that cross it where there is no ground below, so that their height is not known: they count as passing over it.
    #[serde(default, skip_serializing_if = "super::is_0")]
    pub height_unknown: usize,
    /// Rocks below its edge with more energy than it can stop.
    pub through: usize,
    /// Total energy of the rocks that arrive (J).
    pub energy_j: Statistic,
    /// Height of the highest point of the rocks that arrive (m).
    pub top_m: Statistic,
    /// What the rule asks for, from the rocks that arrive; none without a rule, and with too few rocks.
    pub design_values: Option<Design>,
    /// Rocks missing for a design value; 0 with one, and without a rule.
    #[serde(default)]
    pub design_lacks: usize,
    /// At its own place first, then elsewhere.
    pub by_place: Vec<AtPlace>,
}

/// What a barrier of the same capacity would do at a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AtPlace {
    /// Distance from its own place (m), positive on the left of its line.
    pub offset_m: f64,
    /// Rocks that arrive there, as a share of all releases.
    pub arriving: Proportion,
    /// Height (m) and share of the arriving rocks that would be stopped.
    pub by_height: Vec<(f64, Proportion)>,
    /// What the rule asks for there; none with too few rocks.
    pub design_values: Option<Design>,
}

/// Heights of the sensitivity over the barrier's own (–).
const HEIGHTS: [f64; 7] = [0.5, 0.75, 0.9, 1.0, 1.1, 1.25, 1.5];
/// Which of them is its own.
const OWN_HEIGHT: usize = 3;

impl AtPlace {
    /// Share of the arriving rocks that a barrier of its own height stops.
    pub fn at_own_height(&self) -> Option<&Proportion> {
        self.by_height.get(OWN_HEIGHT).map(|(_, share)| share)
    }
}

/// Rocks that arrive at each place of a barrier, its own first.
pub type Arrivals = Vec<Vec<Arrival>>;

/// Judges all barriers; `rows` are first crossings, release by release, and every rock weighs what it stands for;
/// `open` may still come.
///
/// # Errors
/// Passes on what reading a row says.
pub fn judge<E>(
    barriers: &[Barrier],
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
    (weights, open): (&Weights, &OpenRocks),
) -> Result<Vec<BarrierSummary>, E> {
    let (arrivals, crossing) = follow(barriers, rows)?;
    let all = barriers.iter().zip(&arrivals).zip(crossing).enumerate();
    let said = |(which, ((barrier, places), n)): (usize, ((&Barrier, &Arrivals), usize))| {
        let lines = iter::once(&barrier.name).chain(barrier.elsewhere.iter().map(|at| &at.line));
        let open: Vec<Vec<usize>> =
            lines.map(|line| open.free_at(line, Some(which)).collect()).collect();
        summary(barrier, (places, &open), (n, weights))
    };
    Ok(all.map(said).collect())
}

/// Says of a crossing which barrier stops the rock there, by its number.
pub fn stopping(barriers: &[Barrier]) -> impl Fn(&CrossingRow) -> Option<usize> {
    |row| {
        let which = barriers.iter().position(|barrier| barrier.name == row.line)?;
        let (height_m, capacity_j) = (barriers[which].height_m, barriers[which].capacity_j);
        Arrival::of(row).is_stopped(height_m, capacity_j).then_some(which)
    }
}

/// The rocks that arrive at each barrier, at its own place and elsewhere.
///
/// # Errors
/// Passes on what reading a row says.
pub fn arrivals<E>(
    barriers: &[Barrier],
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
) -> Result<Vec<Arrivals>, E> {
    Ok(follow(barriers, rows)?.0)
}

fn follow<E>(
    barriers: &[Barrier],
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
) -> Result<(Vec<Arrivals>, Vec<usize>), E> {
    let places = |barrier: &Barrier| vec![Vec::new(); 1 + barrier.elsewhere.len()];
    let mut arrivals: Vec<Arrivals> = barriers.iter().map(places).collect();
    let mut crossing = vec![0; barriers.len()];
    // without barriers no row has anything to say
    if !barriers.is_empty() {
        by_rock(rows, |rock| send(barriers, rock, (&mut arrivals, &mut crossing)))?;
    }
    Ok((arrivals, crossing))
}

/// Sends one rock through the barriers on its way until one stops it; and again for every other place of one of them.
fn send(
    barriers: &[Barrier],
    rock: &mut [CrossingRow],
    (arrivals, crossing): (&mut [Arrivals], &mut [usize]),
) {
    rock.sort_by(|one, other| one.time_s.total_cmp(&other.time_s));
    let way = |moved: Option<(usize, &str)>| -> Vec<(usize, Arrival)> {
        let line = |which: usize| match moved {
            Some((other, line)) if other == which => line,
            _ => barriers[which].name.as_str(),
        };
        let barrier_at =
            |row: &CrossingRow| (0..barriers.len()).find(|&which| line(which) == row.line);
        rock.iter().filter_map(|row| Some((barrier_at(row)?, Arrival::of(row)))).collect()
    };
    let own = way(None);
    for (which, _) in &own {
        crossing[*which] += 1;
    }
    for (which, arrival) in until_stopped(barriers, &own) {
        arrivals[*which][0].push(*arrival);
    }
    for (which, barrier) in barriers.iter().enumerate() {
        for (place, elsewhere) in barrier.elsewhere.iter().enumerate() {
            let way = way(Some((which, &elsewhere.line)));
            let arrived = until_stopped(barriers, &way).iter().find(|(met, _)| *met == which);
            arrivals[which][1 + place].extend(arrived.map(|(_, arrival)| *arrival));
        }
    }
}

/// The part of a way up to the barrier that stops the rock.
fn until_stopped<'a>(barriers: &[Barrier], way: &'a [(usize, Arrival)]) -> &'a [(usize, Arrival)] {
    let end = way.iter().position(|(which, arrival)| {
        let barrier = &barriers[*which];
        arrival.is_stopped(barrier.height_m, barrier.capacity_j)
    });
    &way[..end.map_or(way.len(), |last| last + 1)]
}

impl Arrival {
    pub(super) fn of(row: &CrossingRow) -> Self {
        // where there is no ground below, nothing says how high it is: it is let through
        let top_m = if row.height_m.is_nan() { f64::INFINITY } else { row.highest_m() };
        let total_j = row.total_j();
        Self { release: row.index, top_m, total_j, speed_m_s: row.speed_m_s }
    }

    /// Whether a barrier of this height (m) and capacity (J) stops it.
    pub fn is_stopped(&self, height_m: f64, capacity_j: f64) -> bool {
        self.top_m <= height_m && self.total_j <= capacity_j
    }
}

fn summary(
    barrier: &Barrier,
    (places, open): (&Arrivals, &[Vec<usize>]),
    (crossing, weights): (usize, &Weights),
) -> BarrierSummary {
    let rocks = &places[0];
    let stopped = stopped_at(barrier, (rocks, weights), barrier.height_m);
    let over = rocks.iter().filter(|rock| rock.top_m > barrier.height_m).count();
    let statistic = |of: fn(&Arrival) -> f64| {
        let mut largest = None;
        for rock in rocks {
            Largest::update(&mut largest, rock.release, of(rock));
        }
        statistic(&sample(rocks, weights, of), largest)
    };
    let offsets = iter::once(0.0).chain(barrier.elsewhere.iter().map(|place| place.offset_m));
    let at_place = |((offset_m, rocks), open): ((f64, &Vec<Arrival>), &Vec<usize>)| AtPlace {
        offset_m,
        arriving: arriving((rocks, open), weights),
        by_height: HEIGHTS
            .map(|share| share * barrier.height_m)
            .map(|height_m| (height_m, stopped_at(barrier, (rocks, weights), height_m)))
            .into(),
        design_values: barrier.design.as_ref().and_then(|rule| rule.design(rocks, weights).ok()),
    };
    let asked = barrier.design.as_ref().map(|rule| rule.design(rocks, weights));
    BarrierSummary {
        barrier: barrier.clone(),
        crossing,
        arriving: arriving((rocks, &open[0]), weights),
        may_still_come: share_if_any(weights, open[0].iter().copied()),
        stopped,
        over,
        height_unknown: rocks.iter().filter(|rock| rock.top_m.is_infinite()).count(),
        through: rocks.len() - stopped.count - over,
        energy_j: statistic(|rock| rock.total_j),
        top_m: statistic(|rock| rock.top_m),
        design_lacks: asked.as_ref().and_then(|asked| asked.as_ref().err().copied()).unwrap_or(0),
        design_values: asked.and_then(Result::ok),
        by_place: offsets.zip(places).zip(open).map(at_place).collect(),
    }
}

/// Says of each barrier that rocks cross where there is no ground below it how many they are.
pub fn barrier_warnings(barriers: &[BarrierSummary]) -> Vec<String> {
    let are_any = |one: &&BarrierSummary| one.height_unknown > 0;
    let said = |one: &BarrierSummary| {
        format!(
            "barrier “{}”: {} of {} arriving rocks cross it where the terrain has a hole: their height is not known, and they count as passing over it; fill the hole",
            one.barrier.name, one.height_unknown, one.arriving.count
        )
    };
    barriers.iter().filter(are_any).map(said).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hazard::lines::tests::row;
    use std::collections::BTreeMap;
    use std::convert::Infallible;

    fn barrier(name: &str, height_m: f64, capacity_j: f64) -> Barrier {
        Barrier { name: name.to_owned(), height_m, capacity_j, design: None, elsewhere: vec![] }
    }

    /// Over a hole nobody knows how high a rock is: it is let through, and a warning says so.
    #[test]
    fn rocks_of_unknown_height_are_named() {
        let net = [barrier("net", 3.0, 100.0)];
        let rows = [row(0, "net", 1.0, 0.5, 50.0), row(1, "net", 1.0, f64::NAN, 50.0)];
        let rows = rows.into_iter().map(Ok::<_, Infallible>);
        let found = judge(&net, rows, (&Weights::equal(2), &OpenRocks::default())).unwrap();
        let at = &found[0];
        assert_eq!([at.arriving.count, at.stopped.count, at.over, at.height_unknown], [2, 1, 1, 1]);
        let said = barrier_warnings(&found);
        assert!(said.len() == 1 && said[0].contains("“net”: 1 of 2"), "{said:?}");
    }

    /// By hand: rock 0 is stopped by the upper net and never seen below; rock 1 flies over the upper one and is stopped
    /// below; rock 2 breaks through both; rock 3 meets the lower one only.
    #[test]
    fn what_the_first_stops_does_not_arrive_at_the_second() {
        let mut upper = barrier("upper", 3.0, 100.0);
        let speed_factors = [("a".to_owned(), 1.02), ("b".to_owned(), 1.1)].into();
        let (mass_factors, height_factors) = ([("c".to_owned(), 1.02)].into(), BTreeMap::new());
        upper.design = Some(Rule {
            standard: None,
            percentile: 30.0,
            speed_factors,
            mass_factors,
            height_factors,
            free_height_m: 0.5,
            free_distance_m: None,
            block: None,
            capacity_factor: None,
        });
        upper.elsewhere = vec![Elsewhere { offset_m: -5.0, line: "upper -5 m".to_owned() }];
        let barriers = [upper, barrier("lower", 2.0, 200.0)];
        let rows = [
            row(0, "lower", 2.0, 0.0, 10.0),
            row(0, "upper", 1.0, 2.0, 100.0),
            row(1, "upper", 1.0, 2.5, 50.0),
            row(1, "lower", 2.0, 0.5, 60.0),
            row(2, "upper", 1.0, 0.0, 500.0),
            row(2, "lower", 2.0, 0.0, 400.0),
            row(3, "lower", 2.0, 0.0, 200.0),
            row(3, "upper -5 m", 1.5, 1.5, 90.0),
            row(4, "lower", 1.0, 0.5, 50.0),
            row(4, "upper -5 m", 1.5, 0.0, 10.0),
        ];
        let rows = rows.into_iter().map(Ok::<_, Infallible>);
        let found = judge(&barriers, rows, (&Weights::equal(8), &OpenRocks::default())).unwrap();
        let counts = |k: usize| {
            let at: &BarrierSummary = &found[k];
            [at.arriving.count, at.stopped.count, at.over, at.through]
        };
        assert_eq!(counts(0), [3, 1, 1, 1]);
        assert_eq!(counts(1), [4, 3, 0, 1]);
        assert_eq!(found[0].arriving.of, 8);
        // rock 0 crosses the lower line too, but the upper net has it
        assert_eq!((found[0].crossing, found[1].crossing), (3, 5));
        let largest = found[1].energy_j.max.unwrap();
        assert_eq!((found[1].energy_j.rocks, largest.release), (4, 2));
        // five metres on, rock 3 meets the upper net; rock 4 would too, but the lower one has stopped it before
        let places: Vec<[usize; 2]> = found[0]
            .by_place
            .iter()
            .map(|at| [at.arriving.count, at.by_height[3].1.count])
            .collect();
        assert_eq!(places, [[3, 1], [1, 1]]);
        // lower by half: 1.5 m stop none of the tops of 3, 3.5 and 1 m but the last, which has too much energy
        assert_eq!(found[0].by_place[0].by_height[0].1.count, 0);
        let design = found[0].design_values.as_ref().unwrap();
        // P30 of 50, 100 and 500 J and of tops at 1, 3 and 3.5 m
        assert!((design.energy_j - 80.0 * (1.02_f64 * 1.1).powi(2) * 1.02).abs() < 1e-9);
        assert!((design.height_m - 2.7).abs() < 1e-12);
    }
}
