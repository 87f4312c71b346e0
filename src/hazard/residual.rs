//! What arrives at the evaluation lines, without barriers and with them: the risk that remains.

use super::barriers::{Barrier, stopping};
use super::lines::{CrossingRow, LineInfo, LineQuantity, by_rock};
use super::open::OpenRocks;
use super::proportion::Proportion;
use super::rate::share_up_to;
use super::sample::Sample;
use super::totals::Largest;
use super::{Statistic, statistic};
use crate::frequency::Weights;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Rocks that pass an evaluation line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Passing {
    /// Their share of all releases.
    pub reach: Proportion,
    /// Total energy at the first crossing (J).
    pub energy_j: Statistic,
    /// Vertical height of the lowest point at the first crossing (m).
    pub height_m: Statistic,
}

/// An evaluation line without and with the barriers that rocks meet before it.
///
/// A rock that a barrier lets through keeps its energy: what a torn net takes from it is not counted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// Name of the line.
    pub line: String,
    /// Barriers that at least one rock meets on its way to the line, in the order of the scene.
    pub behind: Vec<String>,
    /// As if there were no barrier.
    pub without: Passing,
    /// Without the rocks that a barrier stops before the line.
    pub with: Passing,
}

/// Which rows of one rock no barrier has stopped it before, in the order of the rows given. A line that is drawn on a barrier lies
/// behind it.
pub fn unstopped(barriers: &[Barrier], rock: &[CrossingRow]) -> Vec<bool> {
    let stopped_by = stopping(barriers);
    let stops = rock.iter().filter(|row| stopped_by(row).is_some());
    let stop_s = stops.map(|row| row.time_s).fold(f64::INFINITY, f64::min);
    let passes = |row: &CrossingRow| {
        let is_barrier = barriers.iter().any(|barrier| barrier.name == row.line);
        if is_barrier { row.time_s <= stop_s } else { !row.is_behind(stop_s) }
    };
    rock.iter().map(passes).collect()
}

/// Rocks that pass one line, 24 bytes each.
#[derive(Default)]
struct LinePassages {
    behind: BTreeSet<usize>,
    releases: Vec<u32>,
    energies_j: Vec<f64>,
    heights_m: Vec<f64>,
    /// Whether no barrier stops the rock before.
    passes: Vec<bool>,
}

/// Every line of the scene that is no barrier's, without and with barriers; `rows` are first crossings, release by
/// release, each rock with what it stands for; `open` may still come. Empty where no barrier stands.
///
/// # Errors
/// Passes on what reading a row says.
pub fn residual<E>(
    barriers: &[Barrier],
    lines: &[LineInfo],
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
    (weights, open): (&Weights, &OpenRocks),
) -> Result<Vec<Residual>, E> {
    let is_plain = |line: &&LineInfo| {
        !line.of_barrier && barriers.iter().all(|barrier| barrier.name != line.name)
    };
    let lines: Vec<&LineInfo> = lines.iter().filter(is_plain).collect();
    if barriers.is_empty() || lines.is_empty() {
        return Ok(Vec::new());
    }
    let mut seen: Vec<LinePassages> = lines.iter().map(|_| LinePassages::default()).collect();
    by_rock(rows, |rock| take(barriers, &lines, rock, &mut seen))?;
    let said = |(line, seen): (&&LineInfo, LinePassages)| Residual {
        line: line.name.clone(),
        behind: seen.behind.iter().map(|&which| barriers[which].name.clone()).collect(),
        without: seen.passing(|_| true, (weights, open.at(&line.name))),
        with: seen.passing(|at| seen.passes[at], (weights, open.behind_barriers(&line.name))),
    };
    Ok(lines.iter().zip(seen).map(said).collect())
}

fn take(
    barriers: &[Barrier],
    lines: &[&LineInfo],
    rock: &[CrossingRow],
    seen: &mut [LinePassages],
) {
    let passes = unstopped(barriers, rock);
    for (row, passes) in rock.iter().zip(passes) {
        let Some(at) = lines.iter().position(|line| line.name == row.line) else { continue };
        let before = rock.iter().filter(|other| row.is_behind(other.time_s));
        let met = before.filter_map(|other| barriers.iter().position(|b| b.name == other.line));
        let seen = &mut seen[at];
        seen.behind.extend(met);
        seen.releases.push(row.index as u32);
        seen.energies_j.push(LineQuantity::Total.of(row));
        seen.heights_m.push(LineQuantity::Height.of(row));
        seen.passes.push(passes);
    }
}

impl LinePassages {
    /// Statistics of some of them, by their place in the lists.
    fn passing(
        &self,
        is_one: impl Fn(usize) -> bool,
        (weights, open): (&Weights, impl Iterator<Item = usize> + Clone),
    ) -> Passing {
        let release = |at: usize| self.releases[at] as usize;
        let some = || (0..self.releases.len()).filter(|at| is_one(*at));
        let of = |values: &[f64]| {
            let mut largest = None;
            for at in some() {
                Largest::update(&mut largest, release(at), values[at]);
            }
            let each = some().map(|at| (values[at], release(at)));
            statistic(&Sample::of_releases(each, weights), largest)
        };
        Passing {
            reach: share_up_to(weights, some().map(release).collect::<Vec<_>>().into_iter(), open),
            energy_j: of(&self.energies_j),
            height_m: of(&self.heights_m),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hazard::lines::tests::row;
    use std::convert::Infallible;

    /// It holds 100 J.
    fn net() -> Barrier {
        let (name, elsewhere) = ("net".to_owned(), Vec::new());
        Barrier { name, height_m: 3.0, capacity_j: 100.0, design: None, elsewhere }
    }

    /// A road drawn on a net is crossed a rounding before or after it: what the net stops is not on the road, either way.
    #[test]
    fn a_line_on_a_barrier_lies_behind_it() {
        let net = net();
        for rounding_s in [-2e-15, 0.0, 2e-15] {
            let rock = [row(0, "road", 2.0 + rounding_s, 0.1, 50.0), row(0, "net", 2.0, 0.1, 50.0)];
            assert_eq!(unstopped(std::slice::from_ref(&net), &rock), [false, true]);
        }
        let rock = [row(0, "road", 1.999, 0.1, 50.0), row(0, "net", 2.0, 0.1, 50.0)];
        assert_eq!(unstopped(&[net], &rock), [true, true]);
    }

    /// By hand: the net holds 100 J. Rock 0 passes the path above the net and is stopped by it, rock 1 breaks through,
    /// rock 2 meets the road first and the net behind it, rock 3 never meets the net.
    #[test]
    fn what_a_net_stops_does_not_arrive_behind_it() {
        let net = net();
        let line = |name: &str| LineInfo {
            name: name.to_owned(),
            length_m: 1.0,
            corners_m: vec![],
            of_barrier: false,
            floor: None,
        };
        let rows = [
            row(0, "path", 1.0, 0.1, 40.0),
            row(0, "road", 3.0, 0.1, 60.0),
            row(0, "net", 2.0, 0.1, 50.0),
            row(1, "road", 3.0, 0.1, 400.0),
            row(1, "net", 2.0, 0.1, 500.0),
            row(2, "road", 1.0, 0.1, 30.0),
            row(2, "net", 2.0, 0.1, 20.0),
            row(3, "road", 1.0, 0.1, 10.0),
        ];
        let lines = [line("path"), line("road"), line("net")];
        let rows = rows.into_iter().map(Ok::<_, Infallible>);
        let found =
            residual(&[net], &lines, rows, (&Weights::equal(8), &OpenRocks::default())).unwrap();
        assert_eq!(found.len(), 2, "a barrier's own line is none of them");
        let counts = |at: &Residual| (at.without.reach.count, at.with.reach.count);
        assert_eq!((counts(&found[0]), counts(&found[1])), ((1, 1), (4, 3)));
        assert_eq!(found[0].behind, Vec::<String>::new());
        assert_eq!(found[1].behind, ["net"]);
        assert_eq!(found[1].with.reach.of, 8);
        let most = |of: &Statistic| of.max.unwrap().value;
        assert!((most(&found[1].with.energy_j) - 400.0).abs() < 1e-12);
        assert_eq!(found[1].without.energy_j.rocks, 4);
    }
}
