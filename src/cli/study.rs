//! `rockfall study`.

use super::CHECK_FAILED;
use super::study_files::{self as files, StudyOptions};
use super::terminal::say;
use super::words::at_least_1;
use crate::error::Result;
use crate::study::target_precision::TargetPrecision;
use clap::{Args, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Subcommand)]
pub(super) enum StudyCommand {
    /// Error against run time: of a scene's own statistics, or of the exact cases when no scene is given
    Error(ErrorArgs),
    /// Stiff and extreme cases with every scheme, or conservation over all releases of a scene; exit status 1 if one is
    /// outside its bound
    Stability(StabilityArgs),
}

#[derive(Debug, Args)]
pub(super) struct StabilityArgs {
    /// Scene file (TOML)
    scene: Option<PathBuf>,
    /// Folder for page, table and map [default: reports/stability, with a scene reports/stability/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of releases of SCENE, instead of its own
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    releases: Option<usize>,
    /// Worker threads for SCENE [default: all cores]
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    threads: Option<usize>,
}

#[derive(Debug, Args)]
pub(super) struct ErrorArgs {
    /// Scene file (TOML)
    scene: Option<PathBuf>,
    /// Folder for page, table and figures [default: reports/error, with a scene reports/error/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of releases of SCENE under each setting, instead of its own
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    releases: Option<usize>,
    /// Worker threads for SCENE [default: all cores]
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    threads: Option<usize>,
    /// Also run SCENE on its slope's mesh with edges 2 and 4 times as long, to see the error of the mesh
    #[arg(long, requires = "scene")]
    meshes: bool,
    /// Also find the cheapest setting of SCENE for this 95 % interval of both errors together, as in "runout.p95 < 1.0 m"
    #[arg(long, value_name = "PRECISION", requires = "scene")]
    within: Option<TargetPrecision>,
}

/// Does what a study asks.
pub(super) fn study(command: &StudyCommand) -> Result<ExitCode> {
    match command {
        StudyCommand::Error(args) => error(args),
        StudyCommand::Stability(args) => stability(args),
    }
}

fn stability(args: &StabilityArgs) -> Result<ExitCode> {
    let usual = PathBuf::from("reports/stability");
    let say_done = |done: &str| {
        say(format!("{done} done"));
    };
    let (words, all_hold) = match &args.scene {
        None => files::stability(args.out.as_ref().unwrap_or(&usual), say_done)?,
        Some(scene) => {
            let name = scene.file_stem().unwrap_or_default();
            let out = args.out.clone().unwrap_or_else(|| usual.join(name));
            files::conservation(scene, &out, (args.releases, args.threads), say_done)?
        }
    };
    say(words);
    Ok(if all_hold { ExitCode::SUCCESS } else { ExitCode::from(CHECK_FAILED) })
}

fn error(args: &ErrorArgs) -> Result<ExitCode> {
    let usual = PathBuf::from("reports/error");
    let Some(scene) = &args.scene else {
        let out = args.out.clone().unwrap_or(usual);
        let say_done = |case: &str| {
            say(format!("{case} done"));
        };
        return files::exact_cases(&out, say_done).map(say);
    };
    let name = scene.file_stem().unwrap_or_default();
    let options = StudyOptions {
        scene: scene.clone(),
        out: args.out.clone().unwrap_or_else(|| usual.join(name)),
        releases: args.releases,
        threads: args.threads,
        meshes: args.meshes,
        within: args.within,
    };
    let say_done = |line: String| {
        say(line);
    };
    files::scene_errors(&options, say_done).map(say)
}
