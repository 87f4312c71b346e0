//! The search: grids that narrow to what the measured ends leave open, even points where there are many values.
//!
//! A grid that ends on a spacing wider than that tells the grid's interval and not that of the ends. So the ends are drawn
//! again after every grid, and the next one spans the values that fit them best, until it has several steps there. Of the values tried
//! the best are then followed again, see [`super::finalists`].

use super::computed::Computed;
use super::site::CalibrationSite;
use super::{CalibrationStage, CalibrationTrial, Ends};
use crate::ensemble::Ensemble;
use crate::error::{Error, Result};
use crate::hazard::Agreement;
use crate::math;
use crate::scene::{Scene, VaryTable};
use std::cmp::Ordering;

/// Values tried of each quantity in the first grid, and in each refinement: of one, two and three quantities.
const GRID: [[usize; 2]; 3] = [[6, 9], [6, 5], [5, 4]];
/// Most quantities that a grid can be afforded for.
const MOST_IN_A_GRID: usize = GRID.len();
/// Grids of a search: at least, and at most.
const GRIDS: [usize; 2] = [3, 7];
/// Steps of the last grid in the interval of a value. The step adds to the variance what a rounding does, a twelfth of its
/// square: with four of them to an interval of four standard deviations 4 % of the deviation.
const STEPS_INSIDE: f64 = 4.0;
/// A step that is fine enough, whatever the ends say: share of the range (–).
const FINEST: f64 = 0.002;
/// How often the ends are drawn again to place the next grid: its ends need no more than that.
const REDRAWS: usize = 50;
/// What of those lies outside the next grid on either side (–).
const TAIL: f64 = 0.025;
/// Of more quantities: even points in each stage, and the share of the range that they lie in.
const POINTS: [(usize, f64); 3] = [(200, 1.0), (80, 0.35), (80, 0.12)];
/// Bases of the even points (Halton's sequence).
const BASES: [usize; 6] = [2, 3, 5, 7, 11, 13];

/// Trials of one search for so many values, at least; none for no value.
pub(super) fn trials(values: usize) -> usize {
    if values == 0 {
        return 0;
    }
    if values > MOST_IN_A_GRID {
        return POINTS.iter().map(|(points, _)| points).sum();
    }
    (0..GRIDS[0]).map(|stage| steps(values, stage).pow(values as u32)).sum()
}

/// Values of each quantity in a grid of so many quantities.
fn steps(values: usize, stage: usize) -> usize {
    GRID[values - 1][stage.min(1)]
}

/// Ends that were computed, site by site.
struct KnownTrial {
    values: Vec<f64>,
    stage: CalibrationStage,
    computed: Vec<Computed>,
}

/// What a search has found, and from how many trials and finalists.
pub(super) struct FoundFit {
    pub(super) trial: CalibrationTrial,
    pub(super) trials: usize,
    pub(super) finalists: usize,
    /// Of it and those of the search that open rocks leave unclear, the one that may lie nearest.
    pub(super) unclear: Option<CalibrationTrial>,
}

/// The search over one set of ends after the other.
pub(super) struct ParameterSearch<'a> {
    pub(super) sites: Vec<CalibrationSite>,
    pub(super) vary: &'a [VaryTable],
    ensemble: &'a Ensemble,
    releases: usize,
    /// What was computed so far: all searches begin with the same points.
    known: Vec<KnownTrial>,
    /// Where the trials of the search that runs, or ran last, stand there. Those of others were placed by ends that it may not know.
    own: Vec<usize>,
    /// Step of the last grid, value by value.
    pub(super) step: Vec<f64>,
}

impl<'a> ParameterSearch<'a> {
    pub(super) fn new(
        scenes: &[Scene],
        vary: &'a [VaryTable],
        ensemble: &'a Ensemble,
        (releases, parts): (usize, usize),
    ) -> Result<Self> {
        let score = scenes.first().and_then(|scene| scene.calibrate.as_ref()?.score);
        let asked = (releases, parts);
        let sites = scenes.iter();
        let sites = sites.map(|scene| CalibrationSite::of(scene, asked, score.unwrap_or_default()));
        Ok(Self {
            sites: sites.collect::<Result<_>>()?,
            vary,
            ensemble,
            releases,
            known: Vec::new(),
            own: Vec::new(),
            step: Vec::new(),
        })
    }

    /// The values that bring the computed ends nearest the measured ones.
    pub(super) fn best(
        &mut self,
        ends: Ends,
        tried: &mut dyn FnMut(Ends, &CalibrationTrial),
    ) -> Result<FoundFit> {
        let trials = self.search(ends, tried)?;
        let (trial, finalists) = self.select(&trials, ends, tried)?;
        let count = trials.len();
        Ok(FoundFit { unclear: unclear(trials, &trial), trial, trials: count, finalists })
    }

    /// All trials of the search.
    fn search(
        &mut self,
        ends: Ends,
        tried: &mut dyn FnMut(Ends, &CalibrationTrial),
    ) -> Result<Vec<CalibrationTrial>> {
        let mut ranges: Vec<[f64; 2]> = self.vary.iter().map(|vary| [vary.from, vary.to]).collect();
        let (mut trials, mut stage) = (Vec::new(), 0);
        self.own.clear();
        loop {
            let of_stage = (ends, CalibrationStage::Search);
            let points = points(&ranges, stage);
            trials.extend(self.try_all(&points, of_stage, tried)?);
            for values in &points {
                let place = self.place(values, CalibrationStage::Search)?;
                self.own.push(place);
            }
            self.step = step(&ranges, stage);
            let best = trials.iter().min_by(|one, other| nearer(one, other));
            let best =
                best.filter(|best| best.fitted.computed > 0).ok_or_else(|| self.nothing())?;
            stage += 1;
            match self.next(&ranges, &best.values, (stage, ends)) {
                Some(next) => ranges = next,
                None => return Ok(trials),
            }
        }
    }

    /// Tries values one after the other.
    pub(super) fn try_all(
        &mut self,
        points: &[Vec<f64>],
        (ends, stage): (Ends, CalibrationStage),
        tried: &mut dyn FnMut(Ends, &CalibrationTrial),
    ) -> Result<Vec<CalibrationTrial>> {
        let one = |values: &Vec<f64>| {
            let trial = self.trial(values, (ends, stage))?;
            tried(ends, &trial);
            Ok(trial)
        };
        points.iter().map(one).collect()
    }

    /// The ranges of the next stage; none after the last one.
    fn next(
        &self,
        ranges: &[[f64; 2]],
        best: &[f64],
        (stage, ends): (usize, Ends),
    ) -> Option<Vec<[f64; 2]>> {
        if ranges.len() > MOST_IN_A_GRID {
            let (_, share) = POINTS.get(stage)?;
            return Some(around(best, *share, self.vary));
        }
        if stage == 1 {
            return Some(widened(best.iter().map(|best| [*best; 2]), &self.step, self.vary));
        }
        let open = self.left_open(ends, REDRAWS, TAIL).ranges;
        let mut axes = ranges.iter().zip(&open).zip(&self.step).zip(self.vary);
        let is_resolved = axes.all(|(((range, open), step), vary)| {
            let is_inside = range[0] <= open[0] && open[1] <= range[1];
            let is_fine = STEPS_INSIDE * step <= open[1] - open[0];
            is_inside && (is_fine || *step <= FINEST * (vary.to - vary.from))
        });
        let is_last = stage >= GRIDS[1] || (stage >= GRIDS[0] && is_resolved);
        (!is_last).then(|| widened(open.into_iter(), &self.step, self.vary))
    }

    /// Shapes of the rocks of all scenes, each once.
    pub(super) fn shapes(&self) -> Vec<String> {
        let mut shapes = Vec::new();
        for shape in self.sites.iter().flat_map(CalibrationSite::shapes) {
            if !shapes.contains(shape) {
                shapes.push(shape.clone());
            }
        }
        shapes
    }

    /// What is wrong where no trial has an end to compare.
    pub(super) fn nothing(&self) -> Error {
        let mut all = self.known.iter().flat_map(|known| self.sites.iter().zip(&known.computed));
        let short = all.find_map(|(site, computed)| {
            site.least_runout_m().filter(|_| !computed.stayed.is_empty()).map(|m| (site, m))
        });
        if let Some((site, least_m)) = short {
            let found = format!("found {least_m}, and in no trial a rock that runs so far");
            let remedy = "write a smaller number, or a wider range (from, to) in vary";
            return Error::input(site.file(), "[calibrate] least_runout_m", found, remedy);
        }
        let remedy = "release rocks that do not fail";
        Error::input(self.sites[0].file(), "[calibrate]", "found no computed end", remedy)
    }

    /// Compares all releases with these values with the measured ends.
    pub(super) fn trial(
        &mut self,
        values: &[f64],
        (ends, stage): (Ends, CalibrationStage),
    ) -> Result<CalibrationTrial> {
        let place = self.place(values, stage)?;
        let computed = self.computed(place);
        let compare = |of: Ends| {
            let sites = self.sites.iter().zip(computed);
            Agreement::joined(
                &sites.map(|(site, computed)| site.compare(computed, of)).collect::<Vec<_>>(),
            )
        };
        let apart = if let Ends::Without(part) = ends { Ends::Only(part) } else { Ends::All };
        let found = |of: Ends| compare(of).ok_or_else(|| self.nothing());
        Ok(CalibrationTrial {
            values: values.to_vec(),
            stage,
            releases: stage.releases(self.releases),
            fitted: found(ends)?,
            kept_apart: found(apart)?,
            all: found(Ends::All)?,
        })
    }

    /// Where the ends computed with these values for a stage stand; they are computed if they are not known.
    pub(super) fn place(&mut self, values: &[f64], stage: CalibrationStage) -> Result<usize> {
        let is_same = |known: &KnownTrial| known.stage == stage && known.values == values;
        if let Some(place) = self.known.iter().position(is_same) {
            return Ok(place);
        }
        let mut computed = Vec::new();
        for site in &mut self.sites {
            computed.push(site.compute((self.vary, values), stage, self.ensemble)?);
        }
        self.known.push(KnownTrial { values: values.to_vec(), stage, computed });
        Ok(self.known.len() - 1)
    }

    /// The ends that stand at a place, site by site.
    pub(super) fn computed(&self, place: usize) -> &[Computed] {
        &self.known[place].computed
    }

    /// Values of the search that runs, or ran last, with the ends that were computed with them.
    pub(super) fn searched(&self) -> impl Iterator<Item = (&[f64], &[Computed])> {
        let searched = self.own.iter().map(|&place| &self.known[place]);
        searched.map(|known| (&known.values[..], &known.computed[..]))
    }
}

/// Whose fitted ends lie nearer, those of one trial (less) or of another: by their energy distance where a fit is scored by it, else by their
/// runouts; by the most that these can be, however open rocks would have ended.
pub(super) fn nearer(one: &CalibrationTrial, other: &CalibrationTrial) -> Ordering {
    let (one, other) = (&one.fitted, &other.fitted);
    // 0 where it is not known, on both sides
    let [one_m, other_m] = [one, other].map(|of| of.ends_at_most_m().unwrap_or(0.0));
    let [one_ks, other_ks] = [one, other].map(Agreement::ks_at_most);
    let by_runout = || one_ks.total_cmp(&other_ks).then(one.area_m.total_cmp(&other.area_m));
    one_m.total_cmp(&other_m).then_with(by_runout)
}

/// Of trials that open rocks leave unclear the one whose runouts may lie nearest; none where they leave none so.
fn unclear(
    searched: Vec<CalibrationTrial>,
    selected: &CalibrationTrial,
) -> Option<CalibrationTrial> {
    let all = searched.into_iter().chain([selected.clone()]);
    let unclear = all.filter(|trial| trial.fitted.ks_most.is_some());
    unclear.min_by(|one, other| one.fitted.ks.total_cmp(&other.fitted.ks))
}

/// All combinations of `steps` even values of each range, ends included.
fn grid(ranges: &[[f64; 2]], steps: usize) -> Vec<Vec<f64>> {
    ranges.iter().fold(vec![Vec::new()], |points, [from, to]| {
        let value = |k: usize| from + (to - from) * k as f64 / (steps - 1) as f64;
        let longer = |point: &Vec<f64>, k: usize| [&point[..], &[value(k)]].concat();
        points.iter().flat_map(|point| (0..steps).map(move |k| longer(point, k))).collect()
    })
}

/// Points of a stage within ranges of values.
fn points(ranges: &[[f64; 2]], stage: usize) -> Vec<Vec<f64>> {
    let values = ranges.len();
    if values > MOST_IN_A_GRID {
        return even(ranges, POINTS[stage].0);
    }
    grid(ranges, steps(values, stage))
}

/// Step of the points of a stage, value by value; of even points that of as many on a grid.
fn step(ranges: &[[f64; 2]], stage: usize) -> Vec<f64> {
    let values = ranges.len();
    let gaps = if values > MOST_IN_A_GRID {
        math::pow(POINTS[stage].0 as f64, 1.0 / values as f64) - 1.0
    } else {
        steps(values, stage) as f64 - 1.0
    };
    ranges.iter().map(|[from, to]| (to - from) / gaps).collect()
}

/// Ranges with a step to both sides, inside what the scene allows.
fn widened(
    ranges: impl Iterator<Item = [f64; 2]>,
    steps: &[f64],
    allowed: &[VaryTable],
) -> Vec<[f64; 2]> {
    let range = |(([low, high], step), allowed): (([f64; 2], &f64), &VaryTable)| {
        [(low - step).max(allowed.from), (high + step).min(allowed.to)]
    };
    ranges.zip(steps).zip(allowed).map(range).collect()
}

/// Points spread evenly over the ranges (Halton 1960): any number of them, in any number of dimensions up to six.
fn even(ranges: &[[f64; 2]], count: usize) -> Vec<Vec<f64>> {
    let share = |number: usize, base: usize| {
        let (mut rest, mut step, mut sum) = (number, 1.0, 0.0);
        while rest > 0 {
            step /= base as f64;
            sum += step * (rest % base) as f64;
            rest /= base;
        }
        sum
    };
    let point = |number: usize| {
        let axes = ranges.iter().zip(BASES);
        axes.map(|([from, to], base)| from + (to - from) * share(number, base)).collect()
    };
    (1..=count).map(point).collect()
}

/// Ranges of a share of what is allowed around the best values.
fn around(best: &[f64], share: f64, allowed: &[VaryTable]) -> Vec<[f64; 2]> {
    let range = |(best, allowed): (&f64, &VaryTable)| {
        let half = 0.5 * share * (allowed.to - allowed.from);
        [(best - half).max(allowed.from), (best + half).min(allowed.to)]
    };
    best.iter().zip(allowed).map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::VaryKey;

    #[test]
    fn a_grid_holds_all_corners_and_shrinks_inside_its_limits() {
        let points = grid(&[[0.0, 1.0], [10.0, 20.0]], 3);
        assert_eq!(points.len(), 9);
        assert_eq!(points[0], [0.0, 10.0]);
        assert_eq!(points[8], [1.0, 20.0]);
        let vary = |from: f64, to: f64| VaryTable {
            ground: None,
            key: VaryKey::Restitution,
            from,
            to,
            before: from,
        };
        let allowed = [vary(0.0, 1.0), vary(10.0, 20.0)];
        let best = [[0.0; 2], [15.0; 2]].into_iter();
        let next = widened(best, &[0.5, 5.0], &allowed);
        assert_eq!(next, [[0.0, 0.5], [10.0, 20.0]]);
    }

    /// Every eighth of the range of each of six values holds its share of the points.
    #[test]
    fn even_points_are_even_in_every_value() {
        let points = even(&[[0.0, 1.0]; 6], 200);
        for axis in 0..6 {
            for eighth in 0..8 {
                let inside = |point: &&Vec<f64>| (8.0 * point[axis]) as usize == eighth;
                let count = points.iter().filter(inside).count();
                assert!((20..=30).contains(&count), "axis {axis}, eighth {eighth}: {count}");
            }
        }
        assert_eq!(trials(3), 125 + 64 + 64);
        assert_eq!(trials(0), 0);
    }
}
