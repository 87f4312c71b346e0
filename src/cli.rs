//! The command line: arguments, messages and the exit status. Nothing else prints.
#![allow(
    rustdoc::invalid_html_tags,
    reason = "the command's help is printed as it stands: <scene name>"
)]

mod calibrate;
mod compare;
mod init;
mod mesh;
mod signals;
mod study;
mod study_files;
mod terminal;
mod words;

use crate::error::{Error, Result};
use crate::hazard::barrier_warnings;
use crate::output::{self, Mode, Results};
use crate::plan::Plan;
use crate::report::{
    self,
    format::{counted, significant},
};
use crate::run::{RunEnd, RunOptions, Selection, read_measured, run_observed};
use crate::scene::Scene;
use crate::study::target_precision::TargetPrecision;
use crate::study::verify::Verification;
use clap::{Args, Parser, Subcommand};
use indicatif::ProgressBar;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;
use terminal::{bar, complain, in_words, say};

/// Exit status when a check failed.
const CHECK_FAILED: u8 = 1;
/// Exit status when the user's input is wrong.
const WRONG_INPUT: u8 = 2;
/// Exit status after Ctrl-C, as shells report it: 128 plus the number of the signal. SIGTERM and SIGHUP end the same way.
const INTERRUPTED: u8 = 130;

/// Rockfall hazard on triangle meshes, with the numerical error beside every number.
#[derive(Debug, Parser)]
#[command(name = "rockfall", version, about, arg_required_else_help = true)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write a commented first scene for a terrain: release line along its steepest cliffs, grounds to be filled in
    Init(init::InitArgs),
    /// Check and plan a scene, run all releases in parallel, write results and report
    Run(RunArgs),
    /// Read a scene and its meshes, print mesh health and the plan, without running
    Plan {
        /// Scene file (TOML)
        scene: PathBuf,
    },
    /// Join the results of all shards of a run: the same bytes as one undivided run
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
    /// Redraw figures and page from the results in a folder, without running
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
    /// List the catalogue of grounds for `like = "NAME"`, with their sources
    Grounds,
    /// Fit the ground values named under [calibrate] to measured ends, scored on ends held out
    Calibrate(calibrate::CalibrateArgs),
    /// Study the numerics: error against run time, stability
    #[command(subcommand)]
    Study(study::StudyCommand),
    /// Check, convert and make meshes
    #[command(subcommand)]
    Mesh(mesh::MeshCommand),
    /// Print the completion script of a shell
    Completions {
        /// Which shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of the program or of a command (roff): `rockfall man run | man -l -`
    Man(init::ManArgs),
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
    /// One release alone (numbers begin at 0), with its full path; its results go to a folder of their own inside that of the scene
    #[arg(long, value_name = "I", conflicts_with = "resume")]
    only: Option<usize>,
    /// The K-th of N parts of the releases, K from 1 to N; `rockfall merge` puts them together
    #[arg(long, value_name = "K/N", value_parser = words::shard, conflicts_with = "only")]
    shard: Option<Selection>,
    /// Go on with more releases until a 95 % interval is narrower, as in "runout.p95 < 1.0 m"
    #[arg(long, value_name = "PRECISION", conflicts_with_all = ["only", "shard"])]
    until: Option<TargetPrecision>,
    /// Go on with an interrupted run in the same folder
    #[arg(long, conflicts_with = "overwrite")]
    resume: bool,
    /// Replace the results in the folder
    #[arg(long)]
    overwrite: bool,
    /// Run without asking even where more than 2 GB of memory or 10 GB of disk are expected
    #[arg(long, short)]
    yes: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Reads the command line, does what it asks and answers with the exit status.
pub fn main() -> ExitCode {
    signals::outlive_file_limits();
    let done = match CommandLine::parse().command {
        Command::Init(args) => init::init(&args),
        Command::Run(args) => run(&args),
        Command::Plan { scene } => plan(&scene),
        Command::Merge { shards, out, overwrite } => merge(&shards, &out, overwrite),
        Command::Draw { dir } => report::draw_again(&dir).map(|()| say(report_in(&dir))),
        Command::Compare(args) => compare::compare(&args),
        Command::Verify { out } => verify(&out),
        Command::Grounds => Ok(say(crate::scene::catalogue())),
        Command::Calibrate(args) => calibrate::calibrate(&args),
        Command::Study(command) => study::study(&command),
        Command::Mesh(command) => mesh::mesh(command),
        Command::Completions { shell } => Ok(init::completions(shell)),
        Command::Man(args) => init::man(&args),
    };
    done.unwrap_or_else(|error| {
        complain(format_args!("error: {error}"));
        ExitCode::from(WRONG_INPUT)
    })
}

fn plan(scene: &Path) -> Result<ExitCode> {
    let scene = Scene::read(scene)?;
    let plan = Plan::of_scene(&scene)?;
    read_measured(&plan)?;
    let health = plan.mesh_health.as_ref().map(ToString::to_string).unwrap_or_default();
    Ok(say(format!("{health}\n{plan}")))
}

fn verify(out: &Path) -> Result<ExitCode> {
    output::check_writable(out)?;
    let verification = Verification::run()?;
    verification.write(out)?;
    say(format!("{}\ntable and figures in {}", verification.table(), out.display()));
    Ok(if verification.holds() { ExitCode::SUCCESS } else { ExitCode::from(CHECK_FAILED) })
}

fn merge(shards: &[PathBuf], out: &Path, overwrite: bool) -> Result<ExitCode> {
    let mode = if overwrite { Mode::Overwrite } else { Mode::Merge };
    output::merge(shards, out, mode)
        .and_then(|results| report::draw_merged(&results, shards))
        .map_err(|error| error.on_full_disk("make room and merge again with --overwrite"))?;
    Ok(say(format!("results in {}\n{}", out.display(), report_in(out))))
}

/// Where the page of a folder of results is, a last line.
fn report_in(dir: &Path) -> String {
    format!("report: {}", dir.join("report.html").display())
}

fn run(args: &RunArgs) -> Result<ExitCode> {
    let scene = args.scene()?;
    let options = args.options();
    options.check_folder(&scene)?;
    let plan = Plan::of_scene(&scene)?;
    if !args.yes {
        plan.cost(options.selection.range(plan.count).len()).check()?;
    }
    if !args.quiet {
        say(&plan);
    }
    let bar = args.progress(options.selection.range(plan.count).len());
    let ended = run_observed(
        &plan,
        &options,
        |flag| signals::stop_at(&flag),
        |done, asked| {
            bar.set_length(asked as u64);
            bar.set_position(done as u64);
        },
    )
    .map_err(|error| error.on_full_disk("make room and go on with --resume"))?;
    match ended {
        RunEnd::Interrupted { done, of } => {
            bar.abandon();
            Ok(args.interrupted(done, of))
        }
        RunEnd::Complete(results) => {
            bar.finish();
            if !args.quiet {
                let at_holes = report::LeftAtHoles::of(&results)?;
                let mut warnings = barrier_warnings(&results.summary.barriers);
                warnings.extend(report::untouched_trees(&results));
                warnings.extend(report::untouched_ground(&results));
                warnings.extend(report::fast_rocks(&results.hazard));
                let warnings = warnings.iter().map(|warning| format!("warning: {warning}"));
                let said = report::headline(&results.hazard, at_holes.as_ref())
                    .into_iter()
                    .chain(warnings);
                say(format!("\n{}\n", said.collect::<Vec<_>>().join("\n")));
                say(last_words(&results));
            }
            Ok(ExitCode::SUCCESS)
        }
    }
}

/// The last lines of a run: the answer at each line and barrier, what it took, and where the report is.
fn last_words(results: &Results) -> String {
    let mut said = report::answers(results);
    let (releases, took) = (results.hazard.rocks(), results.summary.run);
    let time = in_words(Duration::from_secs_f64(took.seconds.max(0.0)));
    let rate = significant(took.releases_per_second, 3);
    said.push(format!(
        "{releases} {} in {time} ({rate} a second)",
        counted(releases, "release", "releases")
    ));
    said.push(format!("results in {}", results.dir.display()));
    said.push(report_in(&results.dir));
    said.join("\n")
}

impl RunArgs {
    /// The scene with what the command line changes.
    fn scene(&self) -> Result<Scene> {
        let mut scene = Scene::read(&self.scene)?;
        scene.release.count = self.releases.unwrap_or(scene.release.count);
        scene.seed = self.seed.unwrap_or(scene.seed);
        self.selection().check(scene.release.count)?;
        self.check_together(&scene)?;
        Ok(scene)
    }

    /// What is asked of rocks that fall together.
    fn check_together(&self, scene: &Scene) -> Result<()> {
        let remedy = match self.selection() {
            _ if !scene.release.together => return Ok(()),
            _ if self.until.is_some() => "--until: the rocks of this scene touch each other and fall together; write another [release] count".to_owned(),
            Selection::Shard { number, of } => format!(
                "--shard {number}/{of}: the rocks of this scene touch each other and fall together; leave it out"
            ),
            _ => return Ok(()),
        };
        Err(Error::Request(remedy))
    }

    fn selection(&self) -> Selection {
        self.only.map(Selection::Only).or(self.shard).unwrap_or(Selection::All)
    }

    fn options(&self) -> RunOptions {
        let name = self.scene.file_stem().unwrap_or_default();
        let existing = match (self.resume, self.overwrite) {
            (true, _) => Mode::Resume,
            (_, true) => Mode::Overwrite,
            _ => Mode::Fresh,
        };
        let results = Path::new("reports").join(name);
        // A part of the releases has a folder of its own: it is not the scene's result.
        let usual = match self.selection() {
            Selection::All => results,
            Selection::Only(only) => results.join(format!("only_{only}")),
            Selection::Shard { number, of } => results.join(format!("shard_{number}_of_{of}")),
        };
        RunOptions {
            out: self.out.clone().unwrap_or(usual),
            existing,
            selection: self.selection(),
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
        // a world is written as a whole: where nothing is, there is nothing to go on with
        let is_begun = done > 0;
        let given = std::env::args_os().skip(1).filter(|word| !is_begun || word != "--overwrite");
        let mut words: Vec<String> =
            given.map(|word| words::quoted(&word.to_string_lossy())).collect();
        if is_begun && !self.resume {
            words.push("--resume".to_owned());
        }
        let how = if is_begun { "go on" } else { "start again" };
        complain(format_args!("interrupted: {done} of {asked} releases are written"));
        complain(format_args!("{how} with: rockfall {}", words.join(" ")));
        ExitCode::from(INTERRUPTED)
    }
}
