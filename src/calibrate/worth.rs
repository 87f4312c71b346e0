//! What a fit is worth: how far the measured ends tell the values, and how far computed ends lie from them.

use super::computed::{Computed, drawn_from, times_again};
use super::redraw::{Again, REDRAWS, middle, tail_of};
use super::search::ParameterSearch;
use super::site::CalibrationSite;
use super::told::Told;
use super::{CalibrationStage, Ends};
use crate::error::Result;
use crate::hazard::{EndSpread, Sample, ks_limit, runouts};
use crate::math;
use crate::random::{Purpose, stream};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How far the ranks of measured ends are from even ones.
const UNEVEN: &str = "largest distance of these ranks from even ones (–)";

/// Where the measured ends lie among the computed ones.
const RANK: &str = "mean rank among computed ends of the same place (–)";

/// Most blocks that are told one by one.
const MOST_BLOCKS: usize = 12;

/// One figure of the measured ends of a scene beside the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SiteMeasure {
    /// The scene.
    pub scene: String,
    /// What, with its unit.
    pub what: String,
    /// Of the measured ends.
    pub measured: f64,
    /// Of the computed ends; of rocks that had not ended as they were last seen.
    pub computed: f64,
    /// 95 % interval of computed less measured, from measured ends and computed rocks drawn again, of measured standard deviations from their
    /// kurtosis: lower end.
    /// None of what cannot be below 0: its words say what chance alone comes to; none of too few ends.
    pub low_95: Option<f64>,
    /// Its upper end.
    pub high_95: Option<f64>,
    /// Whether rocks that had not ended make the computed figure, and its difference from the measured one, the least that they can be: then the interval has no upper
    /// end. What they make neither least nor most has no interval.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub censored: bool,
}

impl SiteMeasure {
    fn of(
        (scene, what): (String, String),
        [measured, computed]: [f64; 2],
        [low_95, high_95]: [Option<f64>; 2],
    ) -> Self {
        Self { scene, what, measured, computed, low_95, high_95, censored: false }
    }

    /// The same where rocks had not ended: of the difference a lower bound is known or nothing. A rank is of measured ends, among computed ones.
    fn left_open(self, is_least: bool) -> Self {
        Self {
            low_95: self.low_95.filter(|_| is_least),
            high_95: None,
            censored: is_least && self.what != RANK,
            ..self
        }
    }
}

/// Values, figures, and the number of ends with what they are worth.
type Worth = (Vec<Told>, Vec<SiteMeasure>, (usize, f64));

impl ParameterSearch<'_> {
    /// What the fit with these values is worth.
    pub(super) fn worth(&mut self, values: &[f64], seed: u64) -> Result<Worth> {
        // the rocks that assess: those that selected are lucky ones
        let place = self.place(values, CalibrationStage::Assessment)?;
        let (mut ends, mut worth) = (0, 0.0);
        for site in &self.sites {
            ends += site.measured().len();
            worth += site.effective();
        }
        Ok((self.told(values), self.measures(place, seed), (ends, worth)))
    }

    fn measures(&self, place: usize, seed: u64) -> Vec<SiteMeasure> {
        let of_site = |(site, computed): (&CalibrationSite, &Computed)| {
            let of_all = site.measures_of_all(computed, seed);
            of_all.into_iter().chain(site.measures_of_blocks(computed, seed)).collect::<Vec<_>>()
        };
        self.sites.iter().zip(self.computed(place)).flat_map(of_site).collect()
    }
}

/// Rows of measured ends beside what was computed, both drawn again.
type DrawnEnds = (Vec<usize>, Computed);

impl CalibrationSite {
    /// Figures of all measured ends.
    fn measures_of_all(&self, computed: &Computed, seed: u64) -> Vec<SiteMeasure> {
        let all: Vec<usize> = (0..self.measured().len()).collect();
        let drawn: Vec<DrawnEnds> = (0..REDRAWS).map(|k| self.again(computed, (seed, k))).collect();
        let again: Vec<_> =
            drawn.iter().map(|(rows, computed)| self.figures(computed, rows)).collect();
        let (worth, rocks) = (self.effective(), computed.releases.0 as f64);
        let is_open = self.has_open(computed, &all);
        let one = |(at, (what, measured, own)): (usize, (&'static str, f64, f64))| {
            let scene = self.title();
            if let Some(most) = self.by_chance(what, computed, &drawn) {
                let what = what.replace(" (", &format!(", by chance up to {most:.2} ("));
                return SiteMeasure::of((scene, what), [measured, own], [None; 2]);
            }
            let of = |tail: f64, figure: &dyn Fn(&(&'static str, f64, f64)) -> f64| {
                middle(again.iter().map(|figures| figure(&figures[at])).collect(), tail)
            };
            let off = || of(tail_of(worth.min(rocks)), &|(_, measured, own)| own - measured);
            let deviation = EndSpread::deviation_95(what, self.measured(), worth);
            let [low_95, high_95] = deviation.map_or_else(
                || off().map(Some),
                |ends| less_95((own, of(tail_of(rocks), &|(_, _, own)| *own)), (measured, ends)),
            );
            SiteMeasure::of((scene, what.to_owned()), [measured, own], [low_95, high_95])
        };
        let left_open = |(at, figure): (usize, (&'static str, f64, f64))| {
            // what rises with every runout
            let is_least = [EndSpread::MEAN, EndSpread::BEYOND, RANK].contains(&figure.0);
            let measure = one((at, figure));
            if is_open { measure.left_open(is_least) } else { measure }
        };
        self.figures(computed, &all).into_iter().enumerate().map(left_open).collect()
    }

    /// Measured ends and computed rocks drawn again.
    fn again(&self, computed: &Computed, (seed, redraw): (u64, usize)) -> DrawnEnds {
        let mut random = stream(seed, Purpose::Redraw, redraw);
        let again = Again::of(self, (Ends::All, computed), &mut random);
        (again.rows, computed.again(&again.times))
    }

    /// What a figure that cannot be below 0 comes to by chance, in 95 % of all samples of ends that are alike; none of other
    /// figures. `drawn` are measured and computed ends drawn again.
    fn by_chance(&self, what: &str, computed: &Computed, drawn: &[DrawnEnds]) -> Option<f64> {
        let n = self.effective();
        let all = || (0..self.measured().len()).collect::<Vec<_>>();
        match what {
            EndSpread::OFFSET => {
                let off = |rows: &[usize], computed: &Computed| {
                    EndSpread::offset_m(&self.ends(rows), &self.weighted(computed, rows))
                };
                let own = off(&all(), computed);
                let moved = |[x, y]: [f64; 2]| math::hypot(x - own[0], y - own[1]);
                let mut by: Vec<f64> =
                    drawn.iter().map(|(rows, computed)| moved(off(rows, computed))).collect();
                by.sort_by(f64::total_cmp);
                by.get((0.95 * by.len() as f64) as usize).copied()
            }
            EndSpread::BEYOND => Some(beyond_95(n, self.rocks_beside(computed, &all()))),
            UNEVEN => Some(ks_limit(n, self.rocks_beside(computed, &all())).min(1.0)),
            _ => None,
        }
    }

    /// Whether some of the computed rocks beside some measured ends had not ended.
    fn has_open(&self, computed: &Computed, rows: &[usize]) -> bool {
        let beside = self.weighted(computed, rows);
        beside.iter().any(|(way, weight)| *weight > 0.0 && way.open.is_some())
    }

    /// Computed ends of equal weight that those beside some measured ends are worth (Kish 1965).
    fn rocks_beside(&self, computed: &Computed, rows: &[usize]) -> f64 {
        Sample::weighted(runouts(&self.weighted(computed, rows))).effective_rocks()
    }

    /// Figures of some measured ends and of what was computed beside them: what, measured, computed.
    fn figures(&self, computed: &Computed, rows: &[usize]) -> Vec<(&'static str, f64, f64)> {
        let mut figures = EndSpread::figures(&self.ends(rows), &self.weighted(computed, rows));
        if let Some([mean, off]) = self.ranks(computed, rows) {
            figures.push((RANK, mean, 0.5));
            figures.push((UNEVEN, off, 0.0));
        }
        figures
    }

    /// Mean runout of each block, and by how much it differs from that of the first; ends are drawn again within each
    /// block, where they are independent, and computed rocks with them.
    fn measures_of_blocks(&self, computed: &Computed, seed: u64) -> Vec<SiteMeasure> {
        let blocks = self.rows_of_blocks();
        let is_thrown_again = blocks.iter().all(|(_, rows)| rows.len() > 1);
        if !(2..=MOST_BLOCKS).contains(&blocks.len()) || !is_thrown_again {
            return Vec::new();
        }
        let mean = |computed: &Computed, rows: &[usize]| {
            let figures = EndSpread::figures(&self.ends(rows), &self.weighted(computed, rows));
            // the first of them is the mean runout
            figures.first().map_or([f64::NAN; 2], |(_, measured, computed)| [*measured, *computed])
        };
        let found: Vec<[f64; 2]> = blocks.iter().map(|(_, rows)| mean(computed, rows)).collect();
        let again: Vec<Vec<[f64; 2]>> = (0..REDRAWS)
            .map(|redraw| {
                let mut random = stream(seed, Purpose::Redraw, redraw);
                let rows = blocks.iter().map(|(_, rows)| drawn_from(rows, rows.len(), &mut random));
                let rows: Vec<Vec<usize>> = rows.collect();
                let computed = computed.again(&times_again(computed.releases, &mut random));
                rows.iter().map(|rows| mean(&computed, rows)).collect()
            })
            .collect();
        let fewest = |rows: &[usize]| -> f64 {
            rows.iter().map(|at| blocks[*at].1.len()).min().unwrap_or_default() as f64
        };
        let measure = |what: String, rows: &[usize], of: &dyn Fn(&[[f64; 2]]) -> [f64; 2]| {
            let off =
                again.iter().map(|means| of(means)).map(|[measured, computed]| computed - measured);
            let [low_95, high_95] = middle(off.collect(), tail_of(fewest(rows))).map(Some);
            let measure = SiteMeasure::of((self.title(), what), of(&found), [low_95, high_95]);
            let is_open = rows.iter().any(|at| self.has_open(computed, &blocks[*at].1));
            // a difference of two blocks is open on both sides
            if is_open { measure.left_open(rows.len() == 1) } else { measure }
        };
        let first = blocks[0].0;
        let own = blocks.iter().enumerate().map(|(at, (name, _))| {
            measure(format!("mean runout of block {name} (m)"), &[at], &|means| means[at])
        });
        let apart = blocks.iter().enumerate().skip(1).map(|(at, (name, _))| {
            let what = format!("mean runout of block {name} less that of block {first} (m)");
            measure(what, &[0, at], &|means| [0, 1].map(|side| means[at][side] - means[0][side]))
        });
        own.chain(apart).collect()
    }
}

/// 95 % interval of a computed figure less a measured one, each of which has its own: the distances to their ends add up in squares (Zou and
/// Donner 2008, Statistics in Medicine 27, 1693). None where the measured one has none.
fn less_95(
    (computed, [lower, upper]): (f64, [f64; 2]),
    (measured, [low, high]): (f64, [Option<f64>; 2]),
) -> [Option<f64>; 2] {
    let off = computed - measured;
    [
        high.map(|high| off - math::hypot(computed - lower, high - measured)),
        low.map(|low| off + math::hypot(upper - computed, measured - low)),
    ]
}

/// The share of so many computed ends that lie beyond all of so many measured ones which is exceeded in less than 5 % of all samples that are alike (–):
/// the farthest `k` of both are computed ones with probability `Π (m − i)/(n + m − i)`, `i < k`.
fn beyond_95(measured: f64, computed: f64) -> f64 {
    let (mut chance, mut count) = (1.0, 0.0);
    while count < computed {
        chance *= (computed - count) / (measured + computed - count);
        if chance < 0.05 {
            break;
        }
        count += 1.0;
    }
    count / computed.max(1.0)
}

impl fmt::Display for SiteMeasure {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, what, measured, computed, low_95, high_95, censored } = self;
        let [measured, computed] = [measured, computed].map(|value| plain(*value));
        let least = if *censored { ">= " } else { "" };
        write!(to, "{scene}: {what} measured {measured}, computed {least}{computed}")?;
        match (low_95, high_95) {
            (Some(low), Some(high)) => {
                write!(to, " (difference, 95 %: {} to {})", plain(*low), plain(*high))
            }
            (Some(low), None) => write!(to, " (difference, 95 %: {} or more)", plain(*low)),
            _ => Ok(()),
        }
    }
}

/// A number with two decimals, with a true minus, without a sign before nothing.
fn plain(value: f64) -> String {
    let said = format!("{value:.2}");
    if said == "-0.00" { "0.00".to_owned() } else { said.replace('-', "\u{2212}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As in all other texts.
    #[test]
    fn a_negative_number_has_a_true_minus() {
        assert_eq!([-0.45, 0.45, -0.001].map(plain), ["−0.45", "0.45", "0.00"]);
    }

    /// By hand: 5 (4 to 8) less 3 (2.25 to 7) is 2, from √(1² + 4²) below to √(3² + 0.75²) above.
    #[test]
    fn a_difference_has_the_errors_of_both() {
        let [low, high] =
            less_95((5.0, [4.0, 8.0]), (3.0, [Some(2.25), Some(7.0)])).map(Option::unwrap);
        assert!((low - (2.0 - 17.0_f64.sqrt())).abs() < 1e-12);
        assert!((high - (2.0 + 9.5625_f64.sqrt())).abs() < 1e-12);
        assert_eq!(less_95((5.0, [4.0, 8.0]), (3.0, [None, None])), [None, None]);
    }

    /// Of two measured and three computed ends the farthest is a computed one with 3/5, the two farthest are with 3/5 · 2/4 = 0.3, all three with
    /// 0.3 · 1/3 = 0.1: more than 5 %. Of three measured ones these are 1/2, 1/5 and 1/20, of four 3/7, 1/7 and 1/35. Beside very many computed ends it is the share
    /// `1 − q` with `qⁿ = 0.05`.
    #[test]
    fn the_share_beyond_all_measured_ends_is_that_of_chance() {
        for (n, wanted) in [(2.0, 1.0), (4.0, 2.0 / 3.0)] {
            assert!((beyond_95(n, 3.0) - wanted).abs() < 1e-12, "{n}");
        }
        let many = beyond_95(24.0, 1e6);
        assert!((many - (1.0 - 0.05_f64.powf(1.0 / 24.0))).abs() < 1e-5, "{many}");
    }
}
