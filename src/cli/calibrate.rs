//! `rockfall calibrate`.

use super::{at_least_1, say};
use crate::wiring;
use clap::Args;
use rockfall::error::Result;
use rockfall::scene::Scene;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    /// Scene file (TOML) with a table [calibrate]
    scene: PathBuf,
    /// Folder for calibration.csv and calibration.json [default: reports/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Releases of each trial
    #[arg(long, value_name = "N", value_parser = at_least_1, default_value = "400")]
    releases: usize,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = at_least_1)]
    threads: Option<usize>,
}

/// Calibrates and says what was found.
pub(super) fn calibrate(args: &CalibrateArgs) -> Result<ExitCode> {
    let scene = Scene::read(&args.scene)?;
    let name = args.scene.file_stem().unwrap_or_default();
    let out = args.out.clone().unwrap_or_else(|| Path::new("reports").join(name));
    wiring::calibrate(&scene, (args.releases, args.threads), &out).map(say)
}
