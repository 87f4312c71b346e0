//! Fitting a few named ground values to measured ends, and saying how well they do on ends that were kept apart.
//!
//! Measured rocks are dealt alternately into two halves. A grid over the ranges that the scene names, refined twice
//! round its best place, finds the values whose distribution of runouts lies nearest that of one half (Kolmogorov and
//! Smirnov's distance, then the area between the two); the other half judges them.
//! Both ways round are done and printed. All trials draw the same chance, so two of them differ by their values alone.

use crate::chance::Distribution;
use crate::ensemble::Ensemble;
use crate::error::{Error, Flaw, Result};
use crate::hazard::{Agreement, Row, Way};
use crate::plan::Plan;
use crate::scene::{CalibrateTable, GroundTable, Scene, VaryKey, VaryTable};
use crate::terrain::Terrain;
use crate::trajectory::{Scratch, fall};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Values tried of each quantity in the first grid, and in each refinement: of one or two quantities, and of three.
const GRID: [[usize; 3]; 2] = [[6, 5, 5], [5, 4, 4]];
/// Most quantities that are fitted at a time: more than a hundred measured ends can tell apart.
const MOST: usize = 3;

/// One trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The values, in the order of the scene's list.
    pub values: Vec<f64>,
    /// Against the half that was fitted.
    pub fitted: Agreement,
    /// Against the half that was kept apart.
    pub kept_apart: Agreement,
    /// Against all measured ends.
    pub all: Agreement,
}

/// What a calibration found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// What was varied: `ground.key`.
    pub names: Vec<String>,
    /// Releases of each trial.
    pub releases: usize,
    /// Number of trials of each search.
    pub trials: usize,
    /// With the values that would stand there without calibration.
    pub before: Trial,
    /// Fitted to the first half (rows 1, 3, 5, … of the file).
    pub first: Trial,
    /// Fitted to the second half.
    pub second: Trial,
}

/// Computed ways with their release numbers.
type Ends = Vec<(usize, Way)>;

/// The search over one half after the other.
struct Search<'a> {
    scene: Scene,
    table: &'a CalibrateTable,
    measured: Vec<Way>,
    ensemble: &'a Ensemble,
    terrain: Option<Terrain>,
    /// Ends of the values tried so far: both halves begin with the same grid.
    known: Vec<(Vec<f64>, Ends)>,
}

/// Calibrates a scene; `tried` hears of every trial.
///
/// # Errors
/// A scene without `[calibrate]` or with nothing to vary; measured ends or releases that cannot be used.
pub fn calibrate(
    scene: &Scene,
    ensemble: &Ensemble,
    releases: usize,
    tried: &mut dyn FnMut(usize, &Trial),
) -> Result<Calibration> {
    let table = scene.calibrate.as_ref().filter(|table| (1..=MOST).contains(&table.vary.len()));
    let Some(table) = table else {
        let remedy = format!("write deposits and one to {MOST} entries of vary");
        return Err(Error::input(&scene.file, "[calibrate]", "found nothing to fit", remedy));
    };
    let measured = Way::read(&table.deposits)?;
    let (terrain, _) = scene.read_terrain()?;
    let mut search = Search {
        scene: bare(scene, releases),
        table,
        measured,
        ensemble,
        terrain: Some(terrain),
        known: Vec::new(),
    };
    let before: Vec<f64> = table.vary.iter().map(|vary| vary.before).collect();
    let before = search.trial(&before, 0)?;
    let (first, trials) = search.best(0, tried)?;
    let (second, _) = search.best(1, tried)?;
    let name = |vary: &VaryTable| format!("{}.{}", vary.ground, vary.key.name());
    Ok(Calibration {
        names: table.vary.iter().map(name).collect(),
        releases,
        trials,
        before,
        first,
        second,
    })
}

/// The scene without anything that a trial has no use for.
fn bare(scene: &Scene, releases: usize) -> Scene {
    let mut bare = scene.clone();
    bare.release.count = releases;
    (bare.record.paths, bare.record.impacts) = (Some(0), Some(false));
    (bare.lines, bare.maps) = (Vec::new(), None);
    bare
}

impl Search<'_> {
    /// The values that bring the computed runouts nearest the measured ones of one half.
    fn best(
        &mut self,
        half: usize,
        tried: &mut dyn FnMut(usize, &Trial),
    ) -> Result<(Trial, usize)> {
        let mut ranges: Vec<[f64; 2]> =
            self.table.vary.iter().map(|vary| [vary.from, vary.to]).collect();
        let mut best: Option<Trial> = None;
        let mut count = 0;
        for steps in GRID[usize::from(ranges.len() > 2)] {
            for values in grid(&ranges, steps) {
                let trial = self.trial(&values, half)?;
                tried(half, &trial);
                count += 1;
                if best.as_ref().is_none_or(|best| is_nearer(&trial.fitted, &best.fitted)) {
                    best = Some(trial);
                }
            }
            if let Some(best) = &best {
                ranges = nearer(&ranges, &best.values, steps, &self.table.vary);
            }
        }
        best.map(|best| (best, count)).ok_or_else(|| self.nothing())
    }

    fn nothing(&self) -> Error {
        let remedy = "release rocks that do not fail";
        Error::input(&self.scene.file, "[calibrate]", "found no computed end", remedy)
    }

    /// Compares all releases with these values with the measured ends.
    fn trial(&mut self, values: &[f64], half: usize) -> Result<Trial> {
        let known = self.known.iter().position(|(known, _)| known == values);
        let place = known.unwrap_or(self.known.len());
        if known.is_none() {
            let ends = self.ends(values)?;
            self.known.push((values.to_vec(), ends));
        }
        let computed = &self.known[place].1;
        let compare = |of: Option<usize>| self.compare(computed, of).ok_or_else(|| self.nothing());
        Ok(Trial {
            values: values.to_vec(),
            fitted: compare(Some(half))?,
            kept_apart: compare(Some(1 - half))?,
            all: compare(None)?,
        })
    }

    /// Computes all releases with these values.
    fn ends(&mut self, values: &[f64]) -> Result<Ends> {
        let mut entries: Vec<(&VaryTable, &f64)> = self.table.vary.iter().zip(values).collect();
        // a spread lies above the value that another entry may set
        entries.sort_by_key(|(vary, _)| vary.key == VaryKey::RollingFrictionSpread);
        for (vary, value) in entries {
            if let Some(ground) = self.scene.grounds.get_mut(&vary.ground) {
                put(ground, vary.key, *value)?;
            }
        }
        let terrain = match self.terrain.take() {
            Some(terrain) => terrain,
            None => self.scene.read_terrain()?.0,
        };
        let plan = Plan::compile(&self.scene, terrain)?;
        let origin_m = plan.terrain.origin_m;
        let mut computed: Ends = Vec::new();
        let one = |index: usize, scratch: &mut Scratch| fall(&plan, index, None, scratch);
        for falls in self.ensemble.in_chunks(0..plan.count, Scratch::default, one) {
            let ways = falls?
                .iter()
                .filter_map(|fall| Some((fall.index, Way::of(&Row::of(fall, origin_m))?)))
                .collect::<Vec<_>>();
            computed.extend(ways);
        }
        self.terrain = Some(plan.terrain);
        Ok(computed)
    }

    /// Compares one half, or all. Where every measured rock has its release point, a half is computed from its own.
    fn compare(&self, computed: &[(usize, Way)], half: Option<usize>) -> Option<Agreement> {
        let rows = self.measured.len();
        let points = self.scene.release.points_m.as_ref().map_or(0, Vec::len);
        let wanted = |row: usize| half.is_none_or(|half| row % 2 == half);
        let measured: Vec<Way> =
            (0..rows).filter(|row| wanted(*row)).map(|row| self.measured[row]).collect();
        let computed: Vec<Way> = computed
            .iter()
            .filter(|(index, _)| points != rows || wanted(index % rows))
            .map(|(_, way)| *way)
            .collect();
        Agreement::of(&measured, &computed)
    }
}

/// Whether the distributions of one comparison lie nearer than those of another.
fn is_nearer(one: &Agreement, other: &Agreement) -> bool {
    one.ks.total_cmp(&other.ks).then(one.area_m.total_cmp(&other.area_m)).is_lt()
}

fn put(ground: &mut GroundTable, key: VaryKey, value: f64) -> Result<()> {
    let refuse = |flaw: Flaw| Error::Request(flaw.to_string());
    let fixed = Distribution::fixed(value).map_err(refuse)?;
    match key {
        VaryKey::FrictionAngleDeg => ground.friction_angle_deg = fixed,
        VaryKey::Restitution => ground.restitution = Some(fixed),
        VaryKey::RollingFriction => ground.rolling_friction = Some(fixed),
        VaryKey::RollingFrictionSpread if value > 0.0 => {
            let low = ground.rolling_friction.as_ref().map_or(0.0, |rolling| rolling.support().0);
            let above = Distribution::triangular([low, low, low + value]).map_err(refuse)?;
            ground.rolling_friction = Some(above);
        }
        VaryKey::RollingFrictionSpread => {}
        VaryKey::RoughnessDeg => ground.roughness_deg = Some(fixed),
    }
    Ok(())
}

/// All combinations of `steps` even values of each range, ends included.
fn grid(ranges: &[[f64; 2]], steps: usize) -> Vec<Vec<f64>> {
    ranges.iter().fold(vec![Vec::new()], |points, [from, to]| {
        let value = |k: usize| from + (to - from) * k as f64 / (steps - 1) as f64;
        let longer = |point: &Vec<f64>, k: usize| [&point[..], &[value(k)]].concat();
        points.iter().flat_map(|point| (0..steps).map(move |k| longer(point, k))).collect()
    })
}

/// Ranges of one step of the grid to both sides of the best values, inside what the scene allows.
fn nearer(ranges: &[[f64; 2]], best: &[f64], steps: usize, allowed: &[VaryTable]) -> Vec<[f64; 2]> {
    let range = |((range, best), allowed): ((&[f64; 2], &f64), &VaryTable)| {
        let step = (range[1] - range[0]) / (steps - 1) as f64;
        [(best - step).max(allowed.from), (best + step).min(allowed.to)]
    };
    ranges.iter().zip(best).zip(allowed).map(range).collect()
}

impl fmt::Display for Calibration {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(to, "{} trials of {} releases for each half", self.trials, self.releases)?;
        let whose = [
            ("before", &self.before),
            ("fit on 1st half", &self.first),
            ("fit on 2nd half", &self.second),
        ];
        for (who, trial) in whose {
            let values = self.names.iter().zip(&trial.values);
            let values: Vec<String> =
                values.map(|(name, value)| format!("{name} = {value:.4}")).collect();
            writeln!(to, "{who:<16} {}", values.join(", "))?;
            for (what, of) in [
                ("fitted half", &trial.fitted),
                ("held-out half", &trial.kept_apart),
                ("all", &trial.all),
            ] {
                writeln!(
                    to,
                    "  {what:<14} runout {:.1} m (measured {:.1}), KS {:.3} (limit {:.3}), area {:.1} m, side {:.1} m (measured {:.1})",
                    of.computed_mean_m,
                    of.measured_mean_m,
                    of.ks,
                    of.ks_limit,
                    of.area_m,
                    of.computed_side_m,
                    of.measured_side_m
                )?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_holds_all_corners_and_shrinks_inside_its_limits() {
        let points = grid(&[[0.0, 1.0], [10.0, 20.0]], 3);
        assert_eq!(points.len(), 9);
        assert_eq!(points[0], [0.0, 10.0]);
        assert_eq!(points[8], [1.0, 20.0]);
        let vary = |from: f64, to: f64| VaryTable {
            ground: String::new(),
            key: VaryKey::Restitution,
            from,
            to,
            before: from,
        };
        let allowed = [vary(0.0, 1.0), vary(10.0, 20.0)];
        let next = nearer(&[[0.0, 1.0], [10.0, 20.0]], &[0.0, 15.0], 3, &allowed);
        assert_eq!(next, [[0.0, 0.5], [10.0, 20.0]]);
    }
}
