//! Values of grounds and shapes fitted to measured ends: a search over values, scored on ends that it has not seen, and how far the ends
//! tell the values at all.
//!
//! The ends are cut into parts, throws of one block together. The values are fitted to all but one part and scored on
//! that, for each part in turn, and at last fitted to all. What the parts held out say is what the fit is worth
//! elsewhere. Of every fit the best trials are followed again with other rocks, which select among them, and the selected one with
//! others still, which say how good it is: no score profits from the luck of its rocks. Measured ends and computed rocks
//! are then drawn again many times: the values that fit these best spread as far as both leave them open.

mod beside;
mod computed;
mod finalists;
mod fitted;
mod open;
mod own;
mod parts;
mod redraw;
mod search;
mod site;
mod told;
mod worth;

pub use finalists::CalibrationStage;
pub use fitted::fitted_scene;
pub(crate) use own::{OwnPlaces, ThrownFrom, place_of};
pub use told::Told;
pub use worth::SiteMeasure;

use crate::ensemble::Ensemble;
use crate::error::{Error, Flaw, Result};
use crate::frequency::Frequency;
use crate::hazard::Agreement;
use crate::math;
use crate::random::Distribution;
use crate::release::check_shapes;
use crate::scene::{CalibrateTable, GroundTable, Scene, VaryKey, VaryTable};
use search::{FoundFit, ParameterSearch};
use serde::{Deserialize, Serialize};
use site::CalibrationSite;
use std::fmt;

/// Most quantities that are fitted at a time.
const MOST: usize = 6;

/// One trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CalibrationTrial {
    /// The values, in the order of the scene's list.
    pub values: Vec<f64>,
    /// What it is for.
    #[serde(default)]
    pub stage: CalibrationStage,
    /// Its releases, of each scene; 0 where it is not recorded, and was that of all trials.
    #[serde(default)]
    pub releases: usize,
    /// Against the ends that were fitted.
    pub fitted: Agreement,
    /// Against the ends that were kept apart; all of them where none were.
    pub kept_apart: Agreement,
    /// Against all measured ends.
    pub all: Agreement,
}

/// Some of the measured ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// All but those of one part.
    Without(usize),
    /// Those of one part.
    Only(usize),
    /// All of them.
    All,
}

/// What a calibration found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// What was varied: `ground.key`.
    pub names: Vec<String>,
    /// Releases of each trial of a search, of each scene.
    pub releases: usize,
    /// Number of trials of the fit to all ends; fits to parts of them take about as many.
    pub trials: usize,
    /// How many of these other rocks have selected from; 0 in a record of a search whose best trial was taken.
    #[serde(default)]
    pub finalists: usize,
    /// With the values that would stand there without calibration.
    pub before: CalibrationTrial,
    /// Fitted to all but one part of the ends and scored on that, part by part; none where none was held out.
    pub held_out: Vec<CalibrationTrial>,
    /// Whether throws of one block were held out together.
    #[serde(default)]
    pub by_block: bool,
    /// Fitted to all ends.
    pub whole: CalibrationTrial,
    /// How far the ends tell each value.
    pub told: Vec<Told>,
    /// Measured and computed ends of the fit to all, scene by scene.
    pub measures: Vec<SiteMeasure>,
    /// Shapes of the rocks, as the plans say them; empty for spheres alone.
    #[serde(default)]
    pub shapes: Vec<String>,
    /// What is to be said of measured ends beside the terrain, scene by scene, of values at the end of their range, and of ends that no value tried
    /// explains.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// Measured ends, and how many independent ones they are worth: throws of one block are alike.
    pub ends: (usize, f64),
}

/// What a calibration takes, at least, for a bar of progress: in trials of the search.
pub fn planned(scene: &Scene) -> usize {
    let Some(table) = &scene.calibrate else { return 0 };
    let trials = search::trials(table.vary.len());
    (table.parts() + 1) * (trials + finalists::effort(trials))
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
    tried: &mut dyn FnMut(Ends, &CalibrationTrial),
) -> Result<Calibration> {
    let (vary, parts) = vary_of(scenes)?;
    let mut search = ParameterSearch::new(scenes, vary, ensemble, (releases, parts.max(1)))?;
    let before: Vec<f64> = vary.iter().map(|vary| vary.before).collect();
    // by the rocks that assess the fits, so that the difference is that of the values
    let before = search.trial(&before, (Ends::All, CalibrationStage::Assessment))?;
    // first, so that the interval is that of the grids of this fit
    let FoundFit { trial: whole, trials, finalists, unclear } = search.best(Ends::All, tried)?;
    let (told, measures, ends) = search.worth(&whole.values, scenes[0].seed)?;
    search.refuse_unclear(&whole, unclear.as_ref(), ends.1)?;
    let mut held_out = Vec::new();
    for part in 0..parts {
        held_out.push(search.best(Ends::Without(part), tried)?.trial);
    }
    let mut found = Calibration {
        names: vary.iter().map(VaryTable::name).collect(),
        releases,
        trials,
        finalists,
        before,
        held_out,
        by_block: search.sites.iter().any(CalibrationSite::knows_blocks),
        whole,
        told,
        measures,
        shapes: search.shapes(),
        warnings: search
            .sites
            .iter()
            .filter_map(CalibrationSite::beside)
            .map(str::to_owned)
            .collect(),
        ends,
    };
    found.warnings.extend(open::warning(&found.whole.all));
    found.warnings.extend(found.doubts(vary, unclear.as_ref()));
    Ok(found)
}

/// What is varied, which every scene must have beside measured ends, and the parts that are held out in turn.
fn vary_of(scenes: &[Scene]) -> Result<(&[VaryTable], usize)> {
    let wrong = |scene: &Scene, found: &str, remedy: String| {
        Err(Error::input(&scene.file, "[calibrate]", found, remedy))
    };
    let Some(first) = scenes.first() else {
        return Err(Error::Request("calibrate: found no scene; write one or more".to_owned()));
    };
    let vary = first.calibrate.as_ref().map_or(&[][..], |table| &table.vary);
    if !(1..=MOST).contains(&vary.len()) {
        let remedy = format!("write deposits and one to {MOST} entries of vary");
        let found = if vary.is_empty() { "nothing".to_owned() } else { vary.len().to_string() };
        return wrong(first, &format!("found {found} to fit"), remedy);
    }
    for scene in scenes {
        if scene.calibrate.is_none() {
            return wrong(scene, "found nothing", "write deposits = \"ends.csv\"".to_owned());
        }
        let mut grounds = vary.iter().filter_map(|vary| vary.ground.as_ref());
        if let Some(lacks) = grounds.find(|name| !scene.grounds.contains_key(*name)) {
            let remedy = format!("write [grounds.{lacks}]: the scene before varies it");
            return wrong(scene, "found another set of grounds", remedy);
        }
        refuse_weights(scene, scene.sources().as_ref())?;
        let refused = |vary: &VaryTable| {
            let found = format!("found that {} is to be varied", vary.name());
            scene.refuses_to_vary(vary).map(|remedy| (found, remedy))
        };
        if let Some((found, remedy)) = vary.iter().find_map(refused) {
            return wrong(scene, &found, remedy);
        }
    }
    scenes.iter().try_for_each(|scene| refuse_too_round(scene, vary, first))?;
    Ok((vary, first.calibrate.as_ref().map_or(0, CalibrateTable::parts)))
}

/// Refuses corners that a trial would make too round for a shape, by the key that says so.
fn refuse_too_round(scene: &Scene, vary: &[VaryTable], first: &Scene) -> Result<()> {
    check_shapes(scene)?;
    for (index, vary) in vary.iter().enumerate().filter(|(_, v)| v.key == VaryKey::CornerRadius) {
        for (key, value) in [("before", vary.before), ("to", vary.to)] {
            let mut tried = scene.clone();
            put_all(&mut tried, std::slice::from_ref(vary), &[value])?;
            if check_shapes(&tried).is_err() {
                let place = format!("[calibrate] vary #{} {key}", index + 1);
                let found = format!(
                    "found {value}, a corner_radius too round for a shape of {}",
                    scene.file.display()
                );
                let remedy = "write a smaller number, or a less slender shape";
                return Err(Error::input(&first.file, place, found, remedy));
            }
        }
    }
    Ok(())
}

/// Refuses sources whose rocks do not all stand for the same number of events.
///
/// A fit draws the measured ends again and keeps the computed ones. Where few of these carry most of the weight, they move the score
/// by more than the measured ends do, and the interval of a fitted value would not hold what it says. Weighing all alike would fit
/// the rare large rocks, computed as often as small ones, to ends of rocks as they come.
fn refuse_weights(scene: &Scene, sources: Option<&Frequency>) -> Result<()> {
    let weighs = |frequency: &Frequency| -> bool {
        // one rock of each: numbers of releases that strata do not divide are no weights
        !frequency.weights(frequency.strata().len()).are_equal()
    };
    if !sources.is_some_and(weighs) {
        return Ok(());
    }
    let found = "found rocks that stand for unlike numbers of events a year: a fit weighs every rock the same";
    let remedy = "write a scene of the rocks that were measured, without [frequency] and frequency_per_year: their sizes in \
                  [rocks], their places in [release]; the fitted grounds then serve this scene too";
    Err(Error::input(&scene.file, "[frequency]", found, remedy))
}

/// Puts values into the grounds and shapes of a scene.
fn put_all(scene: &mut Scene, vary: &[VaryTable], values: &[f64]) -> Result<()> {
    let mut entries: Vec<(&VaryTable, &f64)> = vary.iter().zip(values).collect();
    // a spread lies above the value that another entry may set
    entries.sort_by_key(|(vary, _)| vary.key == VaryKey::RollingFrictionSpread);
    for (vary, value) in entries {
        let Some(name) = &vary.ground else {
            // spheres among the shapes have no corners
            let corners =
                scene.rocks.shapes.iter_mut().filter_map(|one| one.corner_radius.as_mut());
            corners.for_each(|radius| *radius = *value);
            continue;
        };
        if let Some(ground) = scene.grounds.get_mut(name) {
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
        VaryKey::RollingFrictionSpread => {
            let low = ground.rolling_friction.as_ref().map_or(0.0, |rolling| rolling.support().0);
            // a triangle of no width is no distribution
            let above = if value > 0.0 {
                Distribution::triangular([low, low, low + value])
            } else {
                Distribution::fixed(low)
            };
            ground.rolling_friction = Some(above.map_err(refuse)?);
        }
        _ => {
            if key == VaryKey::TangentialRatio {
                ground.shear_stiffness_n_m = None;
            }
            // a scene without the soil was refused, and shapes are no ground
            if let Some(drawn) = ground.drawn(key) {
                *drawn = Some(fixed);
            } else if let Some(number) = ground.of_soil(key) {
                *number = value;
            }
        }
    }
    Ok(())
}

impl fmt::Display for Calibration {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(to, "{} trials of {} releases for the fit on all", self.trials, self.releases)?;
        if self.finalists > 0 {
            let (finalists, more) = (self.finalists, self.whole.releases);
            writeln!(
                to,
                "the best {finalists} again with {more} other releases, which select one; its scores are those of {more} others still"
            )?;
        }
        self.shapes.iter().try_for_each(|shape| writeln!(to, "shape: {shape}"))?;
        self.warnings.iter().try_for_each(|warning| writeln!(to, "warning: {warning}"))?;
        self.write_trial(to, "before", &self.before)?;
        for (part, trial) in self.held_out.iter().enumerate() {
            let who = format!("fit without part {} of {}", part + 1, self.held_out.len());
            self.write_trial(to, &who, trial)?;
        }
        self.write_trial(to, "fit on all", &self.whole)?;
        let (ends, effective) = self.ends;
        let limit = self.independent_ks_limit(&self.whole.all);
        writeln!(
            to,
            "{ends} measured ends, worth {effective:.0} independent ones, to which the limits belong: {limit:.2} on all ends; fitted to the same ends, their KS is no test"
        )?;
        self.told.iter().try_for_each(|told| writeln!(to, "{told}"))?;
        self.measures.iter().try_for_each(|measure| writeln!(to, "{measure}"))
    }
}

impl Calibration {
    /// The 5 % limit of the KS distance (–) between some of the measured ends and what was computed, for as many ends as those are
    /// worth: throws of one block are alike. Parts are worth their share of all.
    pub fn independent_ks_limit(&self, of: &Agreement) -> f64 {
        let (ends, worth) = self.ends;
        of.ks_limit_worth(worth * of.measured as f64 / ends.max(1) as f64)
    }

    fn write_trial(
        &self,
        to: &mut fmt::Formatter<'_>,
        who: &str,
        trial: &CalibrationTrial,
    ) -> fmt::Result {
        let values = self.names.iter().zip(&trial.values);
        let values: Vec<String> =
            values.map(|(name, value)| format!("{name} = {}", math::rounded(*value, 4))).collect();
        writeln!(to, "{who:<16} {}", values.join(", "))?;
        let parts = [("fitted ends", &trial.fitted), ("held-out ends", &trial.kept_apart)];
        // before, and fitted on all, there is nothing apart
        let parts = parts.into_iter().filter(|_| trial.fitted.measured < trial.all.measured);
        parts.chain([("all ends", &trial.all)]).try_for_each(|(what, of)| {
            let least = if of.open() > 0 { ">= " } else { "" };
            if of.computed == 0 {
                return writeln!(to, "  {what:<14} no computed end, {} not compared", of.stayed);
            }
            writeln!(
                to,
                "  {what:<14} runout {least}{:.1} m (measured {:.1}), KS {:.3}{} (limit {:.3}), area {least}{:.1} m, side {:.1} m (measured {:.1}){}{}",
                of.computed_mean_m,
                of.measured_mean_m,
                of.ks,
                of.ks_most.map_or_else(String::new, |most| format!(" to {most:.3}")),
                self.independent_ks_limit(of),
                of.area_m,
                of.computed_side_m,
                of.measured_side_m,
                energy_distance(of),
                counts(of),
            )
        })
    }
}

/// The energy distance of a trial, as it is said; nothing where a fit is not scored by it.
fn energy_distance(of: &Agreement) -> String {
    let most = of.ends_most_m.map_or_else(String::new, |most_m| format!(" to {most_m:.2}"));
    of.ends_m.map_or_else(String::new, |ends_m| format!(", energy distance {ends_m:.2}{most} m"))
}

/// Computed rocks of a trial that are not compared, or that had not ended, as they are said.
fn counts(of: &Agreement) -> String {
    let said = |count: usize, what: &str| {
        if count > 0 { format!(", {count} {what}") } else { String::new() }
    };
    said(of.stayed, "not compared") + &said(of.open(), "had not ended")
}
