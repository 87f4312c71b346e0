//! What a fit is worth: how far the measured ends tell the values, and how far computed ends lie from them.

use super::search::ParameterSearch;
use super::site::{CalibrationSite, Computed};
use crate::error::Result;
use crate::hazard::EndSpread;
use crate::random::{Purpose, stream, unit};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How often the measured ends are drawn again.
const REDRAWS: usize = 200;
/// Share of a value's range above which its interval tells nothing (–).
const UNTOLD: f64 = 0.6;

/// Most blocks that are told one by one.
const MOST_BLOCKS: usize = 12;

/// How far the measured ends tell one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// `ground.key`.
    pub name: String,
    /// The value that fits all ends best.
    pub value: f64,
    /// Lower end of the 95 % interval: of the values tried, those that fit ends drawn again best.
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
    /// 95 % interval of computed less measured, from measured ends drawn again: lower end.
    pub low_95: f64,
    /// Its upper end.
    pub high_95: f64,
}

/// Values, figures, and the number of ends with what they are worth.
type Worth = (Vec<Told>, Vec<SiteMeasure>, (usize, f64));

impl ParameterSearch<'_> {
    /// What the fit with these values is worth.
    pub(super) fn worth(&mut self, values: &[f64], seed: u64) -> Result<Worth> {
        let place = self.place(values)?;
        let (mut ends, mut worth) = (0, 0.0);
        for site in &self.sites {
            ends += site.measured().len();
            worth += site.effective();
        }
        Ok((self.told(values, seed), self.measures(place, seed), (ends, worth)))
    }

    /// The values that fit best when the measured ends are drawn again.
    fn told(&self, values: &[f64], seed: u64) -> Vec<Told> {
        let best = |redraw: usize| {
            let mut random = stream(seed, Purpose::Redraw, redraw);
            let drawn: Vec<Vec<usize>> =
                self.sites.iter().map(|site| site.redraw(&mut random)).collect();
            let distance = |computed: &[Computed]| -> f64 {
                let each = self.sites.iter().zip(&drawn).zip(computed);
                each.map(|((site, rows), computed)| site.distance(computed, rows)).sum()
            };
            let distances: Vec<f64> =
                self.known.iter().map(|(_, computed)| distance(computed)).collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
            // values that make no difference fit equally well, all of them
            let ties =
                self.known.iter().zip(distances).filter(move |(_, distance)| *distance <= least);
            ties.map(|((values, _), _)| values.clone()).collect::<Vec<_>>()
        };
        let best: Vec<Vec<Vec<f64>>> = (0..REDRAWS).map(best).collect();
        let ends = |at: usize| {
            let extremes = |ties: &Vec<Vec<f64>>| {
                let values = || ties.iter().map(|values| values[at]);
                [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
            };
            best.iter().flat_map(extremes).collect()
        };
        let one = |(at, vary): (usize, &crate::scene::VaryTable)| {
            let [low_95, high_95] = middle_95(ends(at));
            let is_told = high_95 - low_95 < UNTOLD * (vary.to - vary.from);
            Told { name: vary.name(), value: values[at], low_95, high_95, is_told }
        };
        self.vary.iter().enumerate().map(one).collect()
    }

    fn measures(&self, place: usize, seed: u64) -> Vec<SiteMeasure> {
        let sites = self.sites.iter().zip(&self.known[place].1);
        let of_site = |(site, computed): (&CalibrationSite, &Computed)| {
            let all: Vec<usize> = (0..site.measured().len()).collect();
            let found = site.figures(computed, &all);
            let again: Vec<_> = (0..REDRAWS)
                .map(|redraw| {
                    let mut random = stream(seed, Purpose::Redraw, redraw);
                    site.figures(computed, &site.redraw(&mut random))
                })
                .collect();
            let one = |(at, (what, measured, computed)): (usize, (&'static str, f64, f64))| {
                let differences = again.iter().map(|figures| figures[at].2 - figures[at].1);
                let [low_95, high_95] = middle_95(differences.collect());
                let (scene, what) = (site.title(), what.to_owned());
                SiteMeasure { scene, what, measured, computed, low_95, high_95 }
            };
            let of_all = found.into_iter().enumerate().map(one);
            of_all.chain(site.measures_of_blocks(computed, seed)).collect::<Vec<_>>()
        };
        sites.flat_map(of_site).collect()
    }
}

impl CalibrationSite {
    /// Figures of some measured ends and of what was computed beside them: what, measured, computed.
    fn figures(&self, computed: &Computed, rows: &[usize]) -> Vec<(&'static str, f64, f64)> {
        let mut figures = EndSpread::figures(&self.ends(rows), &self.weighted(computed, rows));
        if let Some([mean, off]) = self.ranks(computed, rows) {
            figures.push(("mean rank among computed ends of the same place (–)", mean, 0.5));
            figures.push(("largest distance of these ranks from even ones (–)", off, 0.0));
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
        let measure = |what: String, of: &dyn Fn(&[[f64; 2]]) -> [f64; 2]| {
            let off =
                again.iter().map(|means| of(means)).map(|[measured, computed]| computed - measured);
            let ([low_95, high_95], [measured, computed]) = (middle_95(off.collect()), of(&found));
            SiteMeasure { scene: self.title(), what, measured, computed, low_95, high_95 }
        };
        let first = blocks[0].0;
        let own = blocks.iter().enumerate().map(|(at, (name, _))| {
            measure(format!("mean runout of block {name} (m)"), &|means| means[at])
        });
        let apart = blocks.iter().enumerate().skip(1).map(|(at, (name, _))| {
            let what = format!("mean runout of block {name} less that of block {first} (m)");
            measure(what, &|means| [0, 1].map(|side| means[at][side] - means[0][side]))
        });
        own.chain(apart).collect()
    }
}

/// The interval that leaves a fortieth of the numbers on either side.
fn middle_95(mut numbers: Vec<f64>) -> [f64; 2] {
    numbers.sort_by(f64::total_cmp);
    let at = |p: f64| {
        let rank = (p * (numbers.len() as f64 - 1.0)).round() as usize;
        numbers.get(rank).copied().unwrap_or(f64::NAN)
    };
    [at(0.025), at(0.975)]
}

impl fmt::Display for Told {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, low_95, high_95, is_told } = self;
        write!(to, "{name} = {value:.4} (95 %: {low_95:.4} to {high_95:.4})")?;
        if *is_told {
            return Ok(());
        }
        write!(to, "; warning: the measured ends hardly tell it, other values fit as well")
    }
}

impl fmt::Display for SiteMeasure {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, what, measured, computed, low_95, high_95 } = self;
        write!(
            to,
            "{scene}: {what} measured {measured:.2}, computed {computed:.2} (difference, 95 %: {low_95:.2} to {high_95:.2})"
        )
    }
}
