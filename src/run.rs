//! A run: the releases of a plan, computed chunk by chunk, written durably, summed up and drawn.

mod floors;
mod infos;
mod options;
mod year;

pub use options::{RunOptions, Selection};

use crate::ensemble::Ensemble;
use crate::error::{Error, Result};
use crate::hazard::{Hazard, ObservedPath, effective};
use crate::output::{self, Mode, Output, Results, RunInfo};
use crate::plan::Plan;
use crate::report;
use crate::simulation::{self, Scratch};
use crate::study::target_precision::TargetPrecision;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// How a run ended.
#[derive(Debug)]
pub enum RunEnd {
    /// All releases asked for are written, and the report is drawn.
    Complete(Box<Results>),
    /// Stopped between two chunks; [`Mode::Resume`] goes on from there.
    Interrupted {
        /// Releases written.
        done: usize,
        /// Releases asked for.
        of: usize,
    },
}

/// Computes the releases of a plan, writes results and report into a folder, and returns the results.
///
/// Every chunk (about two seconds of work) is on the disk before the next begins: an interrupted run goes on with
/// [`Mode::Resume`], and ends with the same bytes as an undisturbed one.
///
/// # Errors
/// A folder that holds results which [`RunOptions::existing`] does not allow to touch, a disk that is full, a measured
/// file that cannot be read, a target precision out of reach.
///
/// # Examples
/// ```
/// use rockfall::{Mode, Plan, Quantity, RunOptions, Scene};
/// # fn main() -> rockfall::Result<()> {
/// # let folder = std::env::temp_dir().join(format!("rockfall_doc_{}", std::process::id()));
/// let mut scene = Scene::read("examples/quick.toml".as_ref())?;
/// scene.release.count = 40;
/// let plan = Plan::of_scene(&scene)?;
/// let options = RunOptions { existing: Mode::Overwrite, ..RunOptions::into_folder(&folder) };
/// let results = rockfall::run(&plan, &options)?;
/// assert_eq!(results.hazard.rocks(), 40);
/// assert!(results.statistic(Quantity::Runout).percentiles["p50"].value > 0.0);
/// # std::fs::remove_dir_all(&folder).ok();
/// # Ok(())
/// # }
/// ```
pub fn run(plan: &Plan, options: &RunOptions) -> Result<Results> {
    match run_observed(plan, options, |_| Ok(()), |_, _| ())? {
        RunEnd::Complete(results) => Ok(*results),
        RunEnd::Interrupted { done, of } => Err(Error::Request(format!(
            "{}: interrupted, {done} of {of} releases are written; go on with Mode::Resume",
            options.out.display()
        ))),
    }
}

/// The same for a program that may be interrupted and shows how far it is.
///
/// `begin` gets the flag that stops the run after the current chunk; `progress` the number of releases on the disk and
/// of those asked for, which a target precision may raise.
///
/// # Errors
/// As [`run`], and what `begin` answers.
pub fn run_observed(
    plan: &Plan,
    options: &RunOptions,
    begin: impl FnOnce(Arc<AtomicBool>) -> Result<()>,
    progress: impl Fn(usize, usize),
) -> Result<RunEnd> {
    options.selection.check(plan.count)?;
    let ensemble = Ensemble::new(options.threads)?;
    begin(ensemble.stop_flag())?;
    let (mut mode, mut releases) = (options.existing, plan.count);
    if options.until.is_some() && mode == Mode::Resume {
        mode = Mode::Extend;
        releases = releases.max(output::releases_in(&options.out)?.unwrap_or(0));
    }
    loop {
        let round = Round { plan, options, releases, ensemble: &ensemble };
        let output = Output::create(round.info()?, &options.out, mode)?;
        let asked = options.selection.range(releases);
        let output = round.compute(output, |done| progress(done, asked.len()))?;
        let done = output.remaining().start - asked.start;
        if done < asked.len() {
            return Ok(RunEnd::Interrupted { done, of: asked.len() });
        }
        // Only the last round is finished: until then the folder keeps what the next one goes on from.
        if let Some(more) = more(options.until.as_ref(), output.hazard(), releases)? {
            releases = more;
            mode = Mode::Extend;
            continue;
        }
        let results = output.finish()?;
        output::write_drawings(&options.out, plan)?;
        report::draw_run(&results, &plan.terrain, |index| plan.releases.shape(index))?;
        return Ok(RunEnd::Complete(Box::new(results)));
    }
}

/// The measured ends that a plan compares with; none if it names none.
///
/// # Errors
/// A file that cannot be read or understood.
pub fn read_measured(plan: &Plan) -> Result<Vec<ObservedPath>> {
    plan.measured.as_ref().map_or(Ok(Vec::new()), ObservedPath::read)
}

/// Independent ends that the measured ones are worth; none where none are measured.
fn measured_worth(plan: &Plan, measured: &[ObservedPath]) -> Result<Option<f64>> {
    let Some(ends) = &plan.measured else { return Ok(None) };
    let runouts: Vec<f64> = measured.iter().map(ObservedPath::runout_m).collect();
    Ok(Some(effective(&runouts, &ObservedPath::read_blocks(&ends.file)?)))
}

/// One go at so many releases; a target precision may ask for another with more.
struct Round<'a> {
    plan: &'a Plan,
    options: &'a RunOptions,
    releases: usize,
    ensemble: &'a Ensemble,
}

impl Round<'_> {
    /// Computes and writes what remains, until it is done or stopped.
    fn compute(&self, mut output: Output, progress: impl Fn(usize)) -> Result<Output> {
        let Self { plan, ensemble, .. } = *self;
        let asked = self.options.selection.range(self.releases);
        let paths = matches!(self.options.selection, Selection::Only(_)).then(|| asked.clone());
        if plan.rock_against_rock.is_kept() {
            let stop = ensemble.stop_flag();
            let falls = ensemble
                .install(|| simulation::simulate_releases_together(plan, paths.as_ref(), &stop))?;
            // One world is one piece: stopped before its end, it leaves nothing to write.
            let remaining = output.remaining();
            let wanted = falls.into_iter().flatten().filter(|fall| remaining.contains(&fall.index));
            output.write(&wanted.collect::<Vec<_>>())?;
        } else {
            let fall = |index: usize, scratch: &mut Scratch| {
                simulation::simulate_release(plan, index, paths.as_ref(), scratch)
            };
            let chunks = ensemble.in_chunks(output.remaining(), Scratch::default, fall);
            take_beside(chunks, |falls| {
                output.write(&falls?)?;
                progress(output.remaining().start - asked.start);
                Ok(())
            })?;
        }
        output.keep()?;
        Ok(output)
    }

    /// What the results need to know.
    fn info(&self) -> Result<RunInfo> {
        let Self { plan, options, releases, ensemble } = *self;
        let ground_of =
            |sheet: &crate::terrain::Sheet| plan.ground_names[usize::from(sheet.ground)].clone();
        let observed = read_measured(plan)?;
        Ok(RunInfo {
            title: plan.title.clone(),
            identity: options.identity((plan.scene_hash.clone(), plan.seed), releases),
            origin_m: plan.terrain.origin_m,
            site: infos::site(plan),
            ground_of_sheet: plan.terrain.sheets.iter().map(ground_of).collect(),
            lines: infos::line_infos(plan),
            maps: infos::map_frame(plan),
            profile_step_m: plan.recorders().profile_step_m.unwrap_or_default(),
            barriers: infos::barriers(plan),
            asked: year::asked(plan),
            observed_worth: measured_worth(plan, &observed)?,
            observed,
            observed_least_runout_m: plan.measured.as_ref().and_then(|ends| ends.least_runout_m),
            keeps_paths: matches!(options.selection, Selection::Only(_)) || plan.paths.is_kept(),
            keeps_impacts: plan.impacts.is_kept(),
            has_blocks: plan.releases.has_blocks(),
            has_scars: plan.releases.has_scars(),
            is_shard: matches!(options.selection, Selection::Shard { .. }),
            threads: ensemble.threads(),
            plan: plan.entries_for(releases),
            inputs: plan.inputs.clone(),
            title_block: plan.title_block.clone(),
            language: plan.language,
            sources: plan.sources.clone(),
            warnings: plan.warnings_for(releases),
            mesh_health: infos::mesh_health(plan)?,
        })
    }
}

/// Takes the chunks in order, each while the next one is being computed: the workers need not wait for the disk.
fn take_beside<T: Send>(
    chunks: impl Iterator<Item = T> + Send,
    mut take: impl FnMut(T) -> Result<()>,
) -> Result<()> {
    std::thread::scope(|scope| {
        // handed over one by one: at most two chunks are in memory
        let (hand, taken) = std::sync::mpsc::sync_channel(0);
        scope.spawn(move || {
            // whoever takes no more has met an error, which it tells itself
            for chunk in chunks {
                if hand.send(chunk).is_err() {
                    break;
                }
            }
        });
        taken.into_iter().try_for_each(&mut take)
    })
}

/// A target precision that needs more releases than this is given up: their values take a gigabyte.
const MOST_RELEASES: usize = 10_000_000;

/// How many releases the target precision still asks for; none when it is reached.
///
/// # Errors
/// If it is out of reach: the rounds before stay, and can be finished without it.
fn more(until: Option<&TargetPrecision>, hazard: &Hazard, done: usize) -> Result<Option<usize>> {
    let Some(target) = until else { return Ok(None) };
    if let Some(why) = target.refusal(hazard) {
        return Err(Error::Request(format!("{why}; finish these with --releases {done} --resume")));
    }
    let sample = hazard.sample(target.quantity);
    let needed = target.needs(&sample, done);
    let next = target.next(&sample, done);
    if needed > MOST_RELEASES as f64 || (next.is_some() && done >= MOST_RELEASES) {
        return Err(Error::Request(format!(
            "--until \"{target}\": {done} releases are written, and about {needed:.0e} would be needed; write a wider interval, or finish these with --releases {done} --resume"
        )));
    }
    Ok(next.map(|next| next.min(MOST_RELEASES)))
}
