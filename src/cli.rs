//! The command line: what is asked, what is said, and the exit status. Only this file prints.

mod compare;
mod signals;
mod study;
mod words;

use crate::run::{self, Ended, Part, RunOptions};
use clap::{Args, Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use rockfall::error::{Error, Result};
use rockfall::output::Mode;
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::study::target_precision::TargetPrecision;
use rockfall::study::verify::Verification;
use rockfall::terrain::weld::Up;
use std::fmt::Display;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit status when a check failed.
const CHECK_FAILED: u8 = 1;
/// Exit status when the user's input is wrong.
const WRONG_INPUT: u8 = 2;
/// Exit status after Ctrl-C, as shells have it: 128 and the number of the signal. SIGTERM and SIGHUP end the same way.
const INTERRUPTED: u8 = 130;

/// Rockfall hazard on triangle meshes, with the numerical error beside every number.
#[derive(Debug, Parser)]
#[command(name = "rockfall", version, about, arg_required_else_help = true)]
struct Asked {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Check and plan a scene, run all releases in parallel, write results and report
    Run(RunArgs),
    /// Read a scene and its meshes, print mesh health and the plan; run nothing
    Plan {
        /// Scene file (TOML)
        scene: PathBuf,
    },
    /// Put the results of all shards of a run together: the same bytes as the run at once
    Merge {
        /// Folders of the shards, in any order
        #[arg(required = true, value_name = "DIR")]
        shards: Vec<PathBuf>,
        /// Folder for the results
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Replace the results in the folder
        #[arg(long)]
        overwrite: bool,
    },
    /// Draw figures and page again from the results in a folder; run no rock
    Draw {
        /// Folder with the results of a run
        dir: PathBuf,
    },
    /// Compare two finished runs: differences with intervals, on the same rocks where both have one seed
    Compare(compare::CompareArgs),
    /// Run the exact cases and the method paper's examples; write table and figures
    Verify {
        /// Folder for table and figures
        #[arg(long, value_name = "DIR", default_value = "reports/verification")]
        out: PathBuf,
    },
    /// List the grounds that `like` knows, with their sources
    Grounds,
    /// Fit the ground values named under [calibrate] to measured ends: on half of them, scored on the other half
    Calibrate(CalibrateArgs),
    /// Study the numerics: error against run time, stability
    #[command(subcommand)]
    Study(study::StudyCommand),
    /// Check, convert and make meshes
    #[command(subcommand)]
    Mesh(MeshCommand),
}

#[derive(Debug, Subcommand)]
enum MeshCommand {
    /// Print the health of STL files as they will be welded
    Check {
        /// STL files
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Which axis of the files points up, as `up` in the scene: with y, (x, y, z) becomes (x, -z, y)
        #[arg(long, value_name = "z|y", value_parser = words::up, default_value = "z")]
        up: Up,
    },
    /// Turn a GeoTIFF or an ESRI ASCII grid into STL; subtract the map origin and print it
    FromGrid {
        /// Elevation model (.tif, .asc)
        grid: PathBuf,
        /// STL file to write
        out: PathBuf,
    },
    /// Turn a list of trees into stems that stand on a slope
    Stems {
        /// List (CSV) with the columns `x, y, dbh_m, height_m`, or GeoJSON or Shapefile points with `dbh_m` and `height_m`
        list: PathBuf,
        /// The slope's STL file
        terrain: PathBuf,
        /// STL file to write, in the coordinates of the slope's file
        out: PathBuf,
        /// Map position of the slope file's (0, 0, 0), as `origin_m` in the scene: then the list is in map coordinates
        #[arg(
            long,
            value_name = "X,Y,Z",
            value_delimiter = ',',
            num_args = 1,
            allow_negative_numbers = true
        )]
        origin_m: Option<Vec<f64>>,
    },
    /// Write one of the made slopes and shapes
    Make {
        /// Which one
        kind: String,
        /// STL file to write
        out: PathBuf,
    },
}

#[derive(Debug, Args)]
struct CalibrateArgs {
    /// Scene files (TOML) with a table [calibrate]; several are fitted together, the first says what is varied
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Folder for trials, result and fitted scenes [default: reports/<first scene's name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Releases of each trial
    #[arg(long, value_name = "N", value_parser = words::of_a_trial, default_value = "400")]
    releases: usize,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = words::at_least_1)]
    threads: Option<usize>,
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a word of the command line")]
struct RunArgs {
    /// Scene file (TOML)
    scene: PathBuf,
    /// Folder for the results [default: reports/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of releases, instead of the scene's
    #[arg(long, value_name = "N", value_parser = words::at_least_1)]
    releases: Option<usize>,
    /// Seed, instead of the scene's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = words::threads)]
    threads: Option<usize>,
    /// One release alone, with its full path recorded
    #[arg(long, value_name = "I", conflicts_with = "resume")]
    only: Option<usize>,
    /// The K-th of N parts of the releases, K from 1 to N; `rockfall merge` puts them together
    #[arg(long, value_name = "K/N", value_parser = words::shard, conflicts_with = "only")]
    shard: Option<Part>,
    /// Go on with more releases until a 95 % interval is narrower, as in "runout.p95 < 1.0 m"
    #[arg(long, value_name = "AIM", conflicts_with_all = ["only", "shard"])]
    until: Option<TargetPrecision>,
    /// Go on with an interrupted run in the same folder
    #[arg(long, conflicts_with = "overwrite")]
    resume: bool,
    /// Replace the results in the folder
    #[arg(long)]
    overwrite: bool,
    /// Run also what takes more memory or disk than the plan allows
    #[arg(long, short)]
    yes: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Reads the command line, does what it asks and answers with the exit status.
pub(crate) fn main() -> ExitCode {
    signals::outlive_file_limits();
    let done = match Asked::parse().command {
        Command::Run(args) => run(&args),
        Command::Plan { scene } => plan(&scene),
        Command::Merge { shards, out, overwrite } => merge(&shards, &out, overwrite),
        Command::Draw { dir } => run::draw(&dir).map(|()| ExitCode::SUCCESS),
        Command::Compare(args) => compare::compare(&args),
        Command::Verify { out } => verify(&out),
        Command::Grounds => Ok(say(rockfall::scene::catalogue())),
        Command::Calibrate(args) => calibrate(&args),
        Command::Study(command) => study::study(&command),
        Command::Mesh(MeshCommand::Check { files, up }) => run::check_meshes(&files, up).map(say),
        Command::Mesh(MeshCommand::FromGrid { grid, out }) => {
            run::mesh_from_grid(&grid, &out).map(say)
        }
        Command::Mesh(MeshCommand::Stems { list, terrain, out, origin_m }) => {
            run::mesh_of_stems((&list, &terrain), &out, origin_m.as_deref()).map(say)
        }
        Command::Mesh(MeshCommand::Make { kind, out }) => run::make_mesh(&kind, &out).map(say),
    };
    done.unwrap_or_else(|error| {
        complain(format_args!("error: {error}"));
        ExitCode::from(WRONG_INPUT)
    })
}

fn calibrate(args: &CalibrateArgs) -> Result<ExitCode> {
    let scenes = args.scenes.iter().map(|scene| Scene::read(scene));
    let scenes = scenes.collect::<Result<Vec<_>>>()?;
    let name = args.scenes[0].file_stem().unwrap_or_default();
    let out = args.out.clone().unwrap_or_else(|| Path::new("reports").join(name));
    let bar = bar(rockfall::calibrate::planned(&scenes[0]), "trials");
    let said = run::calibrate(&scenes, (args.releases, args.threads), &out, || bar.inc(1))?;
    bar.finish_and_clear();
    Ok(say(said))
}

fn plan(scene: &Path) -> Result<ExitCode> {
    let scene = Scene::read(scene)?;
    let (terrain, health) = scene.read_terrain()?;
    let plan = Plan::compile(&scene, terrain)?;
    run::read_measured(&plan)?;
    Ok(say(format!("{health}\n{plan}")))
}

fn verify(out: &Path) -> Result<ExitCode> {
    let verification = Verification::run()?;
    verification.write(out)?;
    say(format!("{}\ntable and figures in {}", verification.table(), out.display()));
    Ok(if verification.holds() { ExitCode::SUCCESS } else { ExitCode::from(CHECK_FAILED) })
}

fn merge(shards: &[PathBuf], out: &Path, overwrite: bool) -> Result<ExitCode> {
    let mode = if overwrite { Mode::Overwrite } else { Mode::Merge };
    run::merge(shards, out, mode)?;
    Ok(say(format!("results in {}", out.display())))
}

fn run(args: &RunArgs) -> Result<ExitCode> {
    let scene = args.scene()?;
    let (terrain, health) = scene.read_terrain()?;
    let mut plan = Plan::compile(&scene, terrain)?;
    let options = args.options();
    if !args.yes {
        plan.cost(options.part.range(plan.count).len()).check()?;
    }
    if !args.quiet {
        say(&plan);
    }
    let bar = args.progress(options.part.range(plan.count).len());
    let ended = run::run(
        &mut plan,
        &health,
        &options,
        |flag| signals::stop_at(&flag),
        |done, asked| {
            bar.set_length(asked as u64);
            bar.set_position(done as u64);
        },
    )?;
    match ended {
        Ended::Interrupted(done, asked) => {
            bar.abandon();
            Ok(args.interrupted(done, asked))
        }
        Ended::Complete(headline) => {
            bar.finish();
            if !args.quiet {
                say(format!("\n{}\n", headline.join("\n")));
                say(format!("{} releases, results in {}", plan.count, options.out.display()));
            }
            Ok(ExitCode::SUCCESS)
        }
    }
}

impl RunArgs {
    /// The scene with what the command line changes.
    fn scene(&self) -> Result<Scene> {
        let mut scene = Scene::read(&self.scene)?;
        scene.release.count = self.releases.unwrap_or(scene.release.count);
        scene.seed = self.seed.unwrap_or(scene.seed);
        self.check_part(&scene)?;
        Ok(scene)
    }

    /// The part of the releases that is asked for must be there.
    fn check_part(&self, scene: &Scene) -> Result<()> {
        let count = scene.release.count;
        let refuse = |why: String| Err(Error::Request(why));
        match self.part() {
            Part::Only(only) if only >= count => refuse(format!(
                "--only {only}: found {count} releases; write a number from 0 to {}",
                count - 1
            )),
            Part::Shard { number, of } if of > count => refuse(format!(
                "--shard {number}/{of}: found {count} releases; write at most as many parts"
            )),
            _ if self.until.is_some() && scene.release.together => refuse(
                "--until: the rocks of this scene touch each other and fall together; write another [release] count"
                    .to_owned(),
            ),
            Part::Shard { number, of } if scene.release.together => refuse(format!(
                "--shard {number}/{of}: the rocks of this scene touch each other and fall together; leave it out"
            )),
            _ => Ok(()),
        }
    }

    fn part(&self) -> Part {
        self.only.map(Part::Only).or(self.shard).unwrap_or(Part::All)
    }

    fn options(&self) -> RunOptions {
        let name = self.scene.file_stem().unwrap_or_default();
        let mode = match (self.resume, self.overwrite) {
            (true, _) => Mode::Resume,
            (_, true) => Mode::Overwrite,
            _ => Mode::Fresh,
        };
        let results = Path::new("reports").join(name);
        // A part of the releases has a folder of its own: it is not the scene's result.
        let usual = match self.part() {
            Part::All => results,
            Part::Only(only) => results.join(format!("only_{only}")),
            Part::Shard { number, of } => results.join(format!("shard_{number}_of_{of}")),
        };
        RunOptions {
            out: self.out.clone().unwrap_or(usual),
            mode,
            part: self.part(),
            threads: self.threads,
            until: self.until,
        }
    }

    /// Rate and remaining time on a terminal, nothing when piped.
    fn progress(&self, asked: usize) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        bar(asked, "rocks")
    }

    /// Says how to go on.
    fn interrupted(&self, done: usize, asked: usize) -> ExitCode {
        let given = std::env::args_os().skip(1).filter(|word| word != "--overwrite");
        let mut words: Vec<String> =
            given.map(|word| words::quoted(&word.to_string_lossy())).collect();
        if !self.resume {
            words.push("--resume".to_owned());
        }
        complain(format_args!("interrupted: {done} of {asked} releases are written"));
        complain(format_args!("go on with: rockfall {}", words.join(" ")));
        ExitCode::from(INTERRUPTED)
    }
}

/// A bar over so many things.
fn bar(asked: usize, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(asked as u64);
    let looks = format!("{{bar:40}} {{pos}}/{{len}} {what}, {{per_sec}}, {{eta}} left");
    match ProgressStyle::with_template(&looks) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Says what is wrong; where even that cannot be written (a full disk, nobody there) the status must do.
fn complain(text: impl Display) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints; a reader that has gone away (`rockfall plan … | head`) is no error.
fn say(text: impl Display) -> ExitCode {
    let text = text.to_string();
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{}", text.trim_end()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(format_args!("error: cannot print: {error}"));
            ExitCode::from(WRONG_INPUT)
        }
        _ => ExitCode::SUCCESS,
    }
}
