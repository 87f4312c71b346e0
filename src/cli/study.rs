//! `rockfall study`.

use super::words::at_least_1;
use super::{CHECK_FAILED, say};
use crate::wiring::study::{self as wiring, SceneOrder};
use clap::{Args, Subcommand};
use rockfall::error::Result;
use rockfall::solver::Scheme;
use rockfall::study::aim::Aim;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Subcommand)]
pub(super) enum StudyCommand {
    /// Error against run time: of a scene's own statistics, or of the exact cases when no scene is given
    Error(ErrorArgs),
    /// Stiff and extreme cases with every scheme, or conservation over all releases of a scene; exit status 1 if one is
    /// outside its bound
    Stability(StabilityArgs),
    /// Cost of more and more rocks that share one world; exit status 1 if it is not near-linear or a rock is lost
    Scaling(ScalingArgs),
    /// Rocks per second of every scheme on a made slope, where the time goes, what each part of a scene costs
    Speed(SpeedArgs),
}

#[derive(Debug, Args)]
pub(super) struct StabilityArgs {
    /// Scene file (TOML)
    scene: Option<PathBuf>,
    /// Folder for page, table and map [default: reports/stability, with a scene reports/stability/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of releases, instead of the scene's
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    releases: Option<usize>,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    threads: Option<usize>,
}

#[derive(Debug, Args)]
pub(super) struct SpeedArgs {
    /// Folder for page, tables and figure
    #[arg(long, value_name = "DIR", default_value = "reports/speed")]
    out: PathBuf,
    /// Rocks of the fast schemes; `reference` follows a tenth of them, `dda` one of 200
    #[arg(long, value_name = "N", value_parser = at_least_1, default_value = "400")]
    releases: usize,
    /// Sizes of the slope, about
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = at_least_1, default_values_t = [10_000, 100_000, 1_000_000])]
    triangles: Vec<usize>,
}

#[derive(Debug, Args)]
pub(super) struct ErrorArgs {
    /// Scene file (TOML)
    scene: Option<PathBuf>,
    /// Folder for page, table and figures [default: reports/error, with a scene reports/error/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of releases under each setting, instead of the scene's
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    releases: Option<usize>,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = at_least_1, requires = "scene")]
    threads: Option<usize>,
    /// Also run on the slope's mesh with edges 2 and 4 times as long, to see the error of the mesh
    #[arg(long, requires = "scene")]
    meshes: bool,
    /// Also find the cheapest setting for this 95 % interval of both errors together, as in "runout.p95 < 1.0 m"
    #[arg(long, value_name = "AIM", requires = "scene")]
    within: Option<Aim>,
}

#[derive(Debug, Args)]
pub(super) struct ScalingArgs {
    /// Folder for page, table and figure
    #[arg(long, value_name = "DIR", default_value = "reports/scaling")]
    out: PathBuf,
    /// Numbers of spheres with scheme adaptive
    #[arg(long, value_name = "N,N", value_delimiter = ',', value_parser = at_least_1, default_value = "48,500,2000,5000,20000")]
    spheres: Vec<usize>,
    /// Numbers of spheres with scheme dda
    #[arg(long, value_name = "N,N", value_delimiter = ',', value_parser = at_least_1, default_value = "48,500,2000")]
    dda: Vec<usize>,
    /// Numbers of spheres with scheme rigid
    #[arg(long, value_name = "N,N", value_delimiter = ',', value_parser = at_least_1, default_value = "48,500,2000,5000,20000")]
    rigid: Vec<usize>,
    /// Time to follow each world (s): falling ends at 0.25 s, impacts at 0.6 s
    #[arg(long, value_name = "S", value_parser = positive, default_value = "0.6")]
    seconds: f64,
    /// Numbers of spheres that are followed to 1.8 s with adaptive and rigid, when the heaps settle
    #[arg(long, value_name = "N,N", value_delimiter = ',', value_parser = at_least_1, default_value = "48,500,2000")]
    settle: Vec<usize>,
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(number) if (0.0..1e6).contains(&number) && number > 0.0 => Ok(number),
        _ => Err("write a time in seconds above 0, as in 0.5".to_owned()),
    }
}

/// Does what a study asks.
pub(super) fn study(command: &StudyCommand) -> Result<ExitCode> {
    match command {
        StudyCommand::Error(args) => error(args),
        StudyCommand::Stability(args) => stability(args),
        StudyCommand::Scaling(args) => scaling(args),
        StudyCommand::Speed(args) => {
            let say_done = |piece: String| {
                say(piece);
            };
            wiring::speed((args.releases, &args.triangles), &args.out, say_done).map(say)
        }
    }
}

fn scaling(args: &ScalingArgs) -> Result<ExitCode> {
    let say_done = |line: String| {
        say(line);
    };
    let worlds = [
        (Scheme::Adaptive, &args.spheres[..]),
        (Scheme::Dda, &args.dda[..]),
        (Scheme::Rigid, &args.rigid[..]),
    ];
    let times = (args.seconds, &args.settle[..]);
    let (words, all_hold) = wiring::scaling((&args.out, times), &worlds, say_done)?;
    say(words);
    Ok(if all_hold { ExitCode::SUCCESS } else { ExitCode::from(CHECK_FAILED) })
}

fn stability(args: &StabilityArgs) -> Result<ExitCode> {
    let usual = PathBuf::from("reports/stability");
    let say_done = |done: &str| {
        say(format!("{done} done"));
    };
    let (words, all_hold) = match &args.scene {
        None => wiring::stability(args.out.as_ref().unwrap_or(&usual), say_done)?,
        Some(scene) => {
            let name = scene.file_stem().unwrap_or_default();
            let out = args.out.clone().unwrap_or_else(|| usual.join(name));
            wiring::conservation(scene, &out, (args.releases, args.threads), say_done)?
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
        return wiring::exact_cases(&out, say_done).map(say);
    };
    let name = scene.file_stem().unwrap_or_default();
    let order = SceneOrder {
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
    wiring::scene_errors(&order, say_done).map(say)
}
