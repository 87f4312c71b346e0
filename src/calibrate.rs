//! Ground values fitted to measured ends: a search over values, scored on ends that it has not seen, and how far the ends
//! tell the values at all.
//!
//! The ends are cut in two halves, row by row. The values are fitted to one half and scored on the other, then the other
//! way round, and at last fitted to all. What the held-out halves say is what the fit is worth elsewhere. The measured
//! ends are then drawn again many times: the values that fit these best spread as far as the ends leave them open.

mod fitted;
mod search;
mod worth;

pub use fitted::fitted_scene;
pub use worth::{Measure, Told};

use crate::ensemble::Ensemble;
use crate::error::{Error, Flaw, Result};
use crate::hazard::Agreement;
use crate::random::Distribution;
use crate::scene::{GroundTable, Scene, VaryKey, VaryTable};
use search::Search;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Most quantities that are fitted at a time.
const MOST: usize = 6;

/// One trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The values, in the order of the scene's list.
    pub values: Vec<f64>,
    /// Against the ends that were fitted.
    pub fitted: Agreement,
    /// Against the ends that were kept apart; all of them where none were.
    pub kept_apart: Agreement,
    /// Against all measured ends.
    pub all: Agreement,
}

/// Measured ends that are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Rows 1, 3, 5, … (0) or 2, 4, 6, … (1) of each file.
    Half(usize),
    /// All rows.
    All,
}

/// What a calibration found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// What was varied: `ground.key`.
    pub names: Vec<String>,
    /// Releases of each trial and scene.
    pub releases: usize,
    /// Number of trials of each search.
    pub trials: usize,
    /// With the values that would stand there without calibration.
    pub before: Trial,
    /// Fitted to the first half (rows 1, 3, 5, … of the file).
    pub first: Trial,
    /// Fitted to the second half.
    pub second: Trial,
    /// Fitted to all ends.
    #[serde(default)]
    pub whole: Option<Trial>,
    /// How far the ends tell each value.
    #[serde(default)]
    pub told: Vec<Told>,
    /// Measured and computed ends of the fit to all, scene by scene.
    #[serde(default)]
    pub measures: Vec<Measure>,
    /// Measured ends, and how many independent ones they are worth: throws of one block are alike.
    #[serde(default)]
    pub ends: (usize, f64),
}

/// Number of trials of a calibration, for a bar of progress.
pub fn planned(scene: &Scene) -> usize {
    let values = scene.calibrate.as_ref().map_or(0, |table| table.vary.len());
    3 * search::trials(values)
}

/// Calibrates scenes together; the first says what is varied. `tried` hears of every trial.
///
/// # Errors
/// A scene without `[calibrate]` or with nothing to vary, or without the grounds that are; measured ends or releases that
/// cannot be used.
pub fn calibrate(
    scenes: &[Scene],
    ensemble: &Ensemble,
    releases: usize,
    tried: &mut dyn FnMut(Ends, &Trial),
) -> Result<Calibration> {
    let vary = vary_of(scenes)?;
    let mut search = Search::new(scenes, vary, ensemble, releases)?;
    let before: Vec<f64> = vary.iter().map(|vary| vary.before).collect();
    let before = search.trial(&before, Ends::Half(0))?;
    let (first, trials) = search.best(Ends::Half(0), tried)?;
    let (second, _) = search.best(Ends::Half(1), tried)?;
    let (whole, _) = search.best(Ends::All, tried)?;
    let name = |vary: &VaryTable| format!("{}.{}", vary.ground, vary.key.name());
    let (told, measures, ends) = search.worth(&whole.values, scenes[0].seed)?;
    Ok(Calibration {
        names: vary.iter().map(name).collect(),
        releases,
        trials,
        before,
        first,
        second,
        whole: Some(whole),
        told,
        measures,
        ends,
    })
}

/// What is varied; every scene must have it, and measured ends.
fn vary_of(scenes: &[Scene]) -> Result<&[VaryTable]> {
    let wrong = |scene: &Scene, found: &str, remedy: String| {
        Err(Error::input(&scene.file, "[calibrate]", found, remedy))
    };
    let Some(first) = scenes.first() else {
        return Err(Error::Request("calibrate: found no scene; write one or more".to_owned()));
    };
    let vary = first.calibrate.as_ref().map_or(&[][..], |table| &table.vary);
    if !(1..=MOST).contains(&vary.len()) {
        let remedy = format!("write deposits and one to {MOST} entries of vary");
        return wrong(first, "found nothing to fit, or too much", remedy);
    }
    for scene in scenes {
        if scene.calibrate.is_none() {
            return wrong(scene, "found nothing", "write deposits = \"ends.csv\"".to_owned());
        }
        if let Some(lacks) = vary.iter().find(|vary| !scene.grounds.contains_key(&vary.ground)) {
            let remedy = format!("write [grounds.{}]: the scene before varies it", lacks.ground);
            return wrong(scene, "found another set of grounds", remedy);
        }
    }
    Ok(vary)
}

/// Puts values into the grounds of a scene.
fn put_all(scene: &mut Scene, vary: &[VaryTable], values: &[f64]) -> Result<()> {
    let mut entries: Vec<(&VaryTable, &f64)> = vary.iter().zip(values).collect();
    // a spread lies above the value that another entry may set
    entries.sort_by_key(|(vary, _)| vary.key == VaryKey::RollingFrictionSpread);
    for (vary, value) in entries {
        if let Some(ground) = scene.grounds.get_mut(&vary.ground) {
            put(ground, vary.key, *value)?;
        }
    }
    Ok(())
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

impl fmt::Display for Calibration {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(to, "{} trials of {} releases for each half", self.trials, self.releases)?;
        let whose = [
            ("before", &self.before),
            ("fit on 1st half", &self.first),
            ("fit on 2nd half", &self.second),
        ];
        let whole = self.whole.as_ref().map(|whole| ("fit on all", whole));
        for (who, trial) in whose.into_iter().chain(whole) {
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
        let (ends, effective) = self.ends;
        writeln!(to, "{ends} measured ends, worth {effective:.0} independent ones")?;
        self.told.iter().try_for_each(|told| writeln!(to, "{told}"))?;
        self.measures.iter().try_for_each(|measure| writeln!(to, "{measure}"))
    }
}
