//! What a fit is worth: how far the measured ends tell the values, and how far computed ends lie from them.

use super::search::ParameterSearch;
use super::site::{CalibrationSite, Computed};
use super::{CalibrationStage, Ends};
use crate::error::Result;
use crate::hazard::{EndSpread, KOLMOGOROV_95, student_95};
use crate::math;
use crate::random::{Purpose, stream, unit};
use crate::scene::VaryTable;
use serde::{Deserialize, Serialize};
use std::fmt;

/// How often the measured ends are drawn again.
const REDRAWS: usize = 200;
/// Share of a value's range above which its interval tells nothing (–).
const UNTOLD: f64 = 0.6;

/// How far the ranks of measured ends are from even ones.
const UNEVEN: &str = "largest distance of these ranks from even ones (–)";

/// Most blocks that are told one by one.
const MOST_BLOCKS: usize = 12;

/// How far the measured ends tell one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// `ground.key`.
    pub name: String,
    /// The value that fits all ends best.
    pub value: f64,
    /// Lower end of the 95 % interval: where the values lie that fit ends drawn again best.
    pub low_95: f64,
    /// Its upper end.
    pub high_95: f64,
    /// Whether the interval leaves out a good part of the range.
    pub is_told: bool,
}

/// One figure of the measured ends of a scene beside the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SiteMeasure {
    /// The scene.
    pub scene: String,
    /// What, with its unit.
    pub what: String,
    /// Of the measured ends.
    pub measured: f64,
    /// Of the computed ends.
    pub computed: f64,
    /// 95 % interval of computed less measured, from measured ends drawn again, of standard deviations from their kurtosis: lower end.
    /// None of what cannot be below 0: its words say what chance alone comes to; none of too few ends.
    pub low_95: Option<f64>,
    /// Its upper end.
    pub high_95: Option<f64>,
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

    /// How far the measured ends tell each value. A value tried stands for half a step to either side.
    ///
    /// The intervals are of the trials of all searches, whose rocks are others than those that selected: a selected value outside widens its own.
    fn told(&self, values: &[f64]) -> Vec<Told> {
        let ends: f64 = self.sites.iter().map(CalibrationSite::effective).sum();
        let open = self.left_open(Ends::All, REDRAWS, tail_of(ends));
        let one = |(at, vary): (usize, &VaryTable)| {
            let half = 0.5 * self.step[at];
            let low_95 = (open[at][0].min(values[at]) - half).max(vary.from);
            let high_95 = (open[at][1].max(values[at]) + half).min(vary.to);
            let is_told = high_95 - low_95 < UNTOLD * (vary.to - vary.from);
            Told { name: vary.name(), value: values[at], low_95, high_95, is_told }
        };
        self.vary.iter().enumerate().map(one).collect()
    }

    /// Where the values lie that fit best, of those tried, when the measured ends are drawn again, but for a tail on either side.
    pub(super) fn left_open(&self, ends: Ends, redraws: usize, tail: f64) -> Vec<[f64; 2]> {
        let seed = self.sites[0].seed();
        let best = |redraw: usize| {
            let mut random = stream(seed, Purpose::Redraw, redraw);
            let drawn: Vec<Vec<usize>> =
                self.sites.iter().map(|site| site.redraw(ends, &mut random)).collect();
            let distance = |computed: &[Computed]| -> f64 {
                let each = self.sites.iter().zip(&drawn).zip(computed);
                each.map(|((site, rows), computed)| site.distance(computed, rows)).sum()
            };
            let distances: Vec<f64> =
                self.searched().map(|(_, computed)| distance(computed)).collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
            // values that make no difference fit equally well, all of them
            let ties =
                self.searched().zip(distances).filter(move |(_, distance)| *distance <= least);
            ties.map(|((values, _), _)| values.to_vec()).collect::<Vec<_>>()
        };
        let best: Vec<Vec<Vec<f64>>> = (0..redraws).map(best).collect();
        let extremes = |at: usize| {
            let of = move |ties: &Vec<Vec<f64>>| {
                let values = || ties.iter().map(|values| values[at]);
                [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
            };
            best.iter().flat_map(of).collect()
        };
        (0..self.vary.len()).map(|at| middle(extremes(at), tail)).collect()
    }

    fn measures(&self, place: usize, seed: u64) -> Vec<SiteMeasure> {
        let sites = self.sites.iter().zip(self.computed(place));
        let of_site = |(site, computed): (&CalibrationSite, &Computed)| {
            let all: Vec<usize> = (0..site.measured().len()).collect();
            let found = site.figures(computed, &all);
            let drawn =
                |redraw: usize| site.redraw(Ends::All, &mut stream(seed, Purpose::Redraw, redraw));
            let drawn: Vec<Vec<usize>> = (0..REDRAWS).map(drawn).collect();
            let again: Vec<_> = drawn.iter().map(|rows| site.figures(computed, rows)).collect();
            let one = |(at, (what, measured, own)): (usize, (&'static str, f64, f64))| {
                let scene = site.title();
                if let Some(most) = site.by_chance(what, computed, &drawn) {
                    let what = what.replace(" (", &format!(", by chance up to {most:.2} ("));
                    let (low_95, high_95) = (None, None);
                    return SiteMeasure { scene, what, measured, computed: own, low_95, high_95 };
                }
                let worth = site.effective();
                let deviation = EndSpread::deviation_95(what, site.measured(), worth);
                let drawn = || {
                    let off = again.iter().map(|figures| figures[at].2 - figures[at].1);
                    middle(off.collect(), tail_of(worth)).map(Some)
                };
                let less = |measured: f64| own - measured;
                let [low_95, high_95] =
                    deviation.map_or_else(drawn, |[low, high]| [high.map(less), low.map(less)]);
                let what = what.to_owned();
                SiteMeasure { scene, what, measured, computed: own, low_95, high_95 }
            };
            let of_all = found.into_iter().enumerate().map(one);
            of_all.chain(site.measures_of_blocks(computed, seed)).collect::<Vec<_>>()
        };
        sites.flat_map(of_site).collect()
    }
}

impl CalibrationSite {
    /// What a figure that cannot be below 0 comes to by chance, in 95 % of all samples of ends that are alike; none of other
    /// figures. `drawn` are rows of measured ends drawn again.
    fn by_chance(&self, what: &str, computed: &Computed, drawn: &[Vec<usize>]) -> Option<f64> {
        let n = self.effective();
        match what {
            EndSpread::OFFSET => {
                let off = |rows: &[usize]| {
                    EndSpread::offset_m(&self.ends(rows), &self.weighted(computed, rows))
                };
                let all: Vec<usize> = (0..self.measured().len()).collect();
                let own = off(&all);
                let moved = |[x, y]: [f64; 2]| math::hypot(x - own[0], y - own[1]);
                let mut by: Vec<f64> = drawn.iter().map(|rows| moved(off(rows))).collect();
                by.sort_by(f64::total_cmp);
                by.get((0.95 * by.len() as f64) as usize).copied()
            }
            // all n measured ends lie below a quantile q of the computed ones with probability qⁿ
            EndSpread::BEYOND => Some(1.0 - math::pow(0.05, 1.0 / n)),
            UNEVEN => Some((KOLMOGOROV_95 / n.sqrt()).min(1.0)),
            _ => None,
        }
    }

    /// Figures of some measured ends and of what was computed beside them: what, measured, computed.
    fn figures(&self, computed: &Computed, rows: &[usize]) -> Vec<(&'static str, f64, f64)> {
        let mut figures = EndSpread::figures(&self.ends(rows), &self.weighted(computed, rows));
        if let Some([mean, off]) = self.ranks(computed, rows) {
            figures.push(("mean rank among computed ends of the same place (–)", mean, 0.5));
            figures.push((UNEVEN, off, 0.0));
        }
        figures
    }

    /// Mean runout of each block, and by how much it differs from that of the first; ends are drawn again within each
    /// block, where they are independent.
    fn measures_of_blocks(&self, computed: &Computed, seed: u64) -> Vec<SiteMeasure> {
        let blocks = self.rows_of_blocks();
        let is_thrown_again = blocks.iter().all(|(_, rows)| rows.len() > 1);
        if !(2..=MOST_BLOCKS).contains(&blocks.len()) || !is_thrown_again {
            return Vec::new();
        }
        let mean = |rows: &[usize]| {
            let figures = EndSpread::figures(&self.ends(rows), &self.weighted(computed, rows));
            // the first of them is the mean runout
            figures.first().map_or([f64::NAN; 2], |(_, measured, computed)| [*measured, *computed])
        };
        let found: Vec<[f64; 2]> = blocks.iter().map(|(_, rows)| mean(rows)).collect();
        let again: Vec<Vec<[f64; 2]>> = (0..REDRAWS)
            .map(|redraw| {
                let mut random = stream(seed, Purpose::Redraw, redraw);
                let mut drawn = |rows: &[usize]| -> Vec<usize> {
                    let one = |random: &mut _| rows[(unit(random) * rows.len() as f64) as usize];
                    rows.iter().map(|_| one(&mut random)).collect()
                };
                blocks.iter().map(|(_, rows)| mean(&drawn(rows))).collect()
            })
            .collect();
        let fewest = |rows: &[usize]| -> f64 {
            rows.iter().map(|at| blocks[*at].1.len()).min().unwrap_or_default() as f64
        };
        let measure = |what: String, rows: &[usize], of: &dyn Fn(&[[f64; 2]]) -> [f64; 2]| {
            let off =
                again.iter().map(|means| of(means)).map(|[measured, computed]| computed - measured);
            let [low_95, high_95] = middle(off.collect(), tail_of(fewest(rows))).map(Some);
            let [measured, computed] = of(&found);
            SiteMeasure { scene: self.title(), what, measured, computed, low_95, high_95 }
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

/// The tail on either side that makes a 95 % interval of figures of so many independent ends when they are drawn again (–).
///
/// Ends drawn again vary less than ends do, by the part `(n − 1)/n` of the variance, and how much those vary is itself known the worse the fewer there are:
/// `Φ(−t √(n/(n − 1)))` with Student's t of `n − 1` degrees of freedom makes good for both (Hesterberg 2015, The American
/// Statistician 69, 371, section 5.3). Many ends have a fortieth.
fn tail_of(ends: f64) -> f64 {
    let n = ends.max(2.0);
    let far = student_95(n - 1.0) * (n / (n - 1.0)).sqrt();
    0.5 * math::erfc(far / std::f64::consts::SQRT_2)
}

/// The interval that leaves out a tail of the numbers on either side.
fn middle(mut numbers: Vec<f64>, tail: f64) -> [f64; 2] {
    numbers.sort_by(f64::total_cmp);
    let at = |p: f64| {
        let rank = (p * (numbers.len() as f64 - 1.0)).round() as usize;
        numbers.get(rank).copied().unwrap_or(f64::NAN)
    };
    [at(tail), at(1.0 - tail)]
}

impl fmt::Display for Told {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, low_95, high_95, is_told } = self;
        let [value, low_95, high_95] = [value, low_95, high_95].map(|&v| math::rounded(v, 4));
        write!(to, "{name} = {value} (95 %: {low_95} to {high_95})")?;
        if *is_told {
            return Ok(());
        }
        write!(to, "; warning: the measured ends hardly tell it, other values fit as well")
    }
}

impl fmt::Display for SiteMeasure {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, what, measured, computed, low_95, high_95 } = self;
        let [measured, computed] = [measured, computed].map(|value| plain(*value));
        write!(to, "{scene}: {what} measured {measured}, computed {computed}")?;
        if let (Some(low), Some(high)) = (low_95, high_95) {
            write!(to, " (difference, 95 %: {} to {})", plain(*low), plain(*high))?;
        }
        Ok(())
    }
}

/// A number with two decimals, without a sign before nothing.
fn plain(value: f64) -> String {
    let said = format!("{value:.2}");
    if said == "-0.00" { "0.00".to_owned() } else { said }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of ten ends of a known law, drawn again as the measured ones are: the truth lies in the interval in 92 of 100 samples, by a fortieth on
    /// either side in 89; of fourteen, what Tschamut's are worth, in 94 and 91.
    #[test]
    fn the_mean_of_few_ends_lies_in_its_interval() {
        const SAMPLES: usize = 4000;
        for (n, least) in [(10_usize, 0.91), (14, 0.925)] {
            let holds = |sample: &usize| {
                let mut random = stream(n as u64, Purpose::Redraw, *sample);
                // the sum of twelve even numbers is normal enough (–)
                let mut end = || (0..12).map(|_| unit(&mut random) - 0.5).sum::<f64>();
                let ends: Vec<f64> = (0..n).map(|_| end()).collect();
                let mut again = || -> f64 {
                    let one = |_| ends[(unit(&mut random) * n as f64) as usize];
                    (0..n).map(one).sum::<f64>() / n as f64
                };
                let means = (0..REDRAWS).map(|_| again()).collect();
                let [low, high] = middle(means, tail_of(n as f64));
                low <= 0.0 && 0.0 <= high
            };
            let share = (0..SAMPLES).filter(holds).count() as f64 / SAMPLES as f64;
            assert!((least..=0.96).contains(&share), "{n}: {share}");
        }
        assert!((tail_of(1e9) - 0.025).abs() < 1e-6 && tail_of(2.0) < 1e-9);
    }

    /// Of five and of ten ends: Student's t of four and of nine degrees of freedom, 2.7764 and 2.2622, stretched by `√(n/(n − 1))` to 3.1042 and 2.3845, and
    /// what a normal variable exceeds by chance there, from tables. A thousandth of t, by which its series is off for three degrees of freedom, is a hundredth of that.
    #[test]
    fn the_tail_of_few_ends_is_that_of_student() {
        for (ends, exact) in [(5.0, 9.541e-4), (10.0, 8.5506e-3)] {
            let tail = tail_of(ends);
            assert!((tail / exact - 1.0).abs() < 1e-2, "{ends}: {tail} for {exact}");
        }
    }
}
