//! `rockfall calibrate`.

use super::terminal::{bar, say};
use super::words::{of_a_trial, threads};
use crate::calibrate::{self, CalibrationTrial, Ends};
use crate::ensemble::Ensemble;
use crate::error::{Error, Result};
use crate::file::{self, write_atomic};
use crate::output;
use crate::scene::Scene;
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    /// Scene files (TOML) with a table [calibrate]; several are fitted together, the first says what is varied
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Folder for trials, result and fitted scenes [default: reports/<first scene's name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Releases of each trial of the search; its best are followed again with four times as many
    #[arg(long, value_name = "N", value_parser = of_a_trial, default_value = "400")]
    releases: usize,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
}

/// Fits the ground values that the scenes name to their measured ends.
pub(super) fn calibrate(args: &CalibrateArgs) -> Result<ExitCode> {
    let scenes = args.scenes.iter().map(|scene| Scene::read(scene));
    let scenes = scenes.collect::<Result<Vec<_>>>()?;
    let name = args.scenes[0].file_stem().unwrap_or_default();
    let out = args.out.clone().unwrap_or_else(|| Path::new("reports").join(name));
    let bar = bar(crate::calibrate::planned(&scenes[0]), "trials");
    let said = fit(&scenes, (args.releases, args.threads), &out, |trials| {
        // a search goes on until its steps are finer than what the ends leave open
        let beyond = (bar.position() + trials).saturating_sub(bar.length().unwrap_or_default());
        bar.inc_length(beyond);
        bar.inc(trials);
    })?;
    bar.finish_and_clear();
    Ok(say(said))
}

/// Calibrates scenes together, writes all trials and the fitted scenes into `out` and says what was found. `progress` hears how many trials of the
/// search each one was worth.
fn fit(
    scenes: &[Scene],
    (releases, threads): (usize, Option<usize>),
    out: &Path,
    progress: impl Fn(u64),
) -> Result<String> {
    output::check_writable(out)?;
    let ensemble = Ensemble::new(threads)?;
    let mut trials: Vec<(Ends, CalibrationTrial)> = Vec::new();
    let found = calibrate::calibrate(scenes, &ensemble, releases, &mut |ends, trial| {
        trials.push((ends, trial.clone()));
        progress((trial.releases / releases) as u64);
    })?;
    let vary = scenes[0].calibrate.as_ref().map_or(&[][..], |table| &table.vary);
    // before the scenes are read again: hours of trials must not hang on a file that has been moved meanwhile
    output::write_calibration(out, &found, &trials)?;
    let mut kept = String::new();
    for scene in scenes {
        let name = scene.file.file_stem().unwrap_or_default().to_string_lossy();
        let text = calibrate::fitted_scene(scene, vary, &found)?;
        let fitted = out.join(format!("{name}_fitted.toml"));
        kept.extend(keep_earlier(&fitted, text.as_bytes())?);
        write_atomic(&fitted, text.as_bytes())?;
    }
    let out = out.display();
    Ok(format!("{found}all trials in {out}/calibration.csv, fitted scenes beside it{kept}"))
}

/// Puts an earlier fitted scene with another text aside, under a name that is free: somebody may have worked on it. What is said of it;
/// nothing where nothing would be lost.
///
/// # Errors
/// A file that cannot be read or renamed.
fn keep_earlier(fitted: &Path, text: &[u8]) -> Result<Option<String>> {
    if !fitted.is_file() || file::read(fitted, file::LONGEST_TEXT)? == text {
        return Ok(None);
    }
    let ending = |number: usize| match number {
        1 => "previous.toml".to_owned(),
        number => format!("previous_{number}.toml"),
    };
    let mut names = (1..).map(|number| fitted.with_extension(ending(number)));
    let Some(aside) = names.find(|name| fs::symlink_metadata(name).is_err()) else {
        return Ok(None);
    };
    fs::rename(fitted, &aside).map_err(Error::file("rename", fitted))?;
    Ok(Some(format!("\nthe earlier fitted scene, which differs, is kept as {}", aside.display())))
}
