//! Where the commands meet the floors that compute: running releases, drawing results, meshes.

pub(crate) mod compare;
mod infos;
pub(crate) mod study;
mod year;

use infos::{barriers, line_infos, map_frame, site};
use rockfall::calibrate::{self, Ends, Trial};
use rockfall::ensemble::Ensemble;
use rockfall::error::{Error, Result};
use rockfall::file;
use rockfall::hazard::{Hazard, Way};
use rockfall::output::{self, Identity, Mode, Output, RunInfo};
use rockfall::plan::Plan;
use rockfall::report;
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::simulation::{self, Scratch};
use rockfall::study::aim::Aim;
use rockfall::terrain::formats;
use rockfall::terrain::health::Health;
use rockfall::terrain::read::Source;
use rockfall::terrain::stl::write_binary;
use rockfall::terrain::weld::Up;
use rockfall::terrain::{Sheet, Terrain, make};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// How a run is asked for.
#[derive(Debug)]
pub(crate) struct Order {
    /// Folder for the results.
    pub(crate) out: PathBuf,
    /// What to do with results that it holds already.
    pub(crate) mode: Mode,
    /// What part of the releases.
    pub(crate) part: Part,
    /// Worker threads; `None` = all cores.
    pub(crate) threads: Option<usize>,
    /// Go on with more releases until this is reached.
    pub(crate) until: Option<Aim>,
}

/// What part of the releases a run computes.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Part {
    /// All of them.
    All,
    /// This one alone, with its full path.
    Only(usize),
    /// The `number`-th of `of` nearly equal parts, both from 1.
    Shard {
        /// Which part.
        number: usize,
        /// Of how many.
        of: usize,
    },
}

impl Part {
    /// Its release numbers of `count`.
    pub(crate) fn range(self, count: usize) -> Range<usize> {
        // In 128 bits the product of two counts cannot overflow.
        let cut = |number: usize, of: usize| (count as u128 * number as u128 / of as u128) as usize;
        match self {
            Self::All => 0..count,
            Self::Only(index) => index..index + 1,
            Self::Shard { number, of } => cut(number - 1, of)..cut(number, of),
        }
    }
}

/// How a run ended.
pub(crate) enum Ended {
    /// All releases are written, the report is drawn: its headline, line by line.
    Complete(Vec<String>),
    /// Stopped after so many releases of so many; the rest can be resumed.
    Interrupted(usize, usize),
}

/// Computes and writes chunk by chunk, then summary, figures and page.
///
/// `begin` gets the flag that stops after the chunk in hand; `progress` the number of releases on the disk and of those
/// asked for, which an aim may raise.
pub(crate) fn run(
    plan: &mut Plan,
    health: &Health,
    order: &Order,
    begin: impl FnOnce(Arc<AtomicBool>) -> Result<()>,
    progress: impl Fn(usize, usize),
) -> Result<Ended> {
    year::allows(plan, order.until.is_some())?;
    let ensemble = Ensemble::new(order.threads)?;
    begin(ensemble.stop_flag())?;
    let mut mode = order.mode;
    if order.until.is_some() && mode == Mode::Resume {
        mode = Mode::Extend;
        plan.count = plan.count.max(output::releases_in(&order.out)?.unwrap_or(0));
    }
    loop {
        let info = run_info(plan, health, order, &ensemble)?;
        let output = Output::create(info, &order.out, mode)?;
        let asked = order.part.range(plan.count);
        let output = compute(plan, &ensemble, output, order, |done| progress(done, asked.len()))?;
        let done = output.remaining().start - asked.start;
        if done < asked.len() {
            return Ok(Ended::Interrupted(done, asked.len()));
        }
        // Only the last round is finished: until then the folder keeps what the next one goes on from.
        if let Some(releases) = more(order.until.as_ref(), output.hazard(), plan.count)? {
            plan.count = releases;
            mode = Mode::Extend;
            continue;
        }
        let results = output.finish()?;
        output::write_drawings(&order.out, plan)?;
        report::draw_run(&results, &plan.terrain)?;
        return Ok(Ended::Complete(report::headline(&results.hazard)));
    }
}

/// Computes and writes what remains, until it is done or stopped.
fn compute(
    plan: &Plan,
    ensemble: &Ensemble,
    mut output: Output,
    order: &Order,
    progress: impl Fn(usize),
) -> Result<Output> {
    let asked = order.part.range(plan.count);
    let paths = matches!(order.part, Part::Only(_)).then(|| asked.clone());
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
        beside(chunks, |falls| {
            output.write(&falls?)?;
            progress(output.remaining().start - asked.start);
            Ok(())
        })?;
    }
    output.keep()?;
    Ok(output)
}

/// Takes the chunks in order, each while the next one is being computed: the workers need not wait for the disk.
fn beside<T: Send>(
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

/// How many releases the aim still asks for; none when it is reached.
///
/// # Errors
/// If it is out of reach: the rounds before stay, and can be finished without the aim.
fn more(until: Option<&Aim>, hazard: &Hazard, done: usize) -> Result<Option<usize>> {
    let Some(aim) = until else { return Ok(None) };
    if let Some(why) = aim.refusal(hazard) {
        return Err(Error::Request(format!("{why}; finish these with --releases {done} --resume")));
    }
    let values = hazard.values(aim.quantity);
    let needed = aim.needs(values, done);
    if needed > MOST_RELEASES as f64 {
        return Err(Error::Request(format!(
            "--until \"{aim}\": {done} releases are written, and about {needed:.0e} would be needed; write a wider interval, or finish these with --releases {done} --resume"
        )));
    }
    Ok(aim.next(values, done).map(|next| next.min(MOST_RELEASES)))
}

/// An aim that needs more releases than this is given up: their values take a gigabyte.
const MOST_RELEASES: usize = 10_000_000;

fn run_info(plan: &Plan, health: &Health, order: &Order, ensemble: &Ensemble) -> Result<RunInfo> {
    let asked = order.part.range(plan.count);
    let mut mesh_health = serde_json::to_value(health)
        .map_err(|error| Error::Request(format!("the mesh health cannot be written: {error}")))?;
    mesh_health["table"] = health.to_string().lines().collect();
    Ok(RunInfo {
        title: plan.title.clone(),
        identity: Identity {
            scene_hash: plan.scene_hash.clone(),
            version: plan.version.to_owned(),
            seed: plan.seed,
            first_release: asked.start,
            releases: asked.len(),
            of_releases: plan.count,
        },
        origin_m: plan.terrain.origin_m,
        site: site(plan),
        ground_of_sheet: plan
            .terrain
            .sheets
            .iter()
            .map(|sheet| plan.ground_names[usize::from(sheet.ground)].clone())
            .collect(),
        lines: line_infos(plan),
        maps: map_frame(plan),
        barriers: barriers(plan),
        asked: year::asked(plan),
        observed: read_measured(plan)?,
        keeps_paths: matches!(order.part, Part::Only(_)) || plan.paths.is_kept(),
        keeps_impacts: plan.impacts.is_kept(),
        has_blocks: plan.has_blocks(),
        is_shard: matches!(order.part, Part::Shard { .. }),
        threads: ensemble.threads(),
        plan: plan.lines(),
        inputs: plan.inputs.clone(),
        title_block: plan.title_block.clone(),
        sources: plan.sources.clone(),
        warnings: plan.warnings.clone(),
        mesh_health,
    })
}

/// The measured ends that a plan compares with; none if it names none.
pub(crate) fn read_measured(plan: &Plan) -> Result<Vec<Way>> {
    plan.deposits.as_deref().map_or(Ok(Vec::new()), Way::read)
}

/// Calibrates scenes together, writes all trials and the fitted scenes into `out` and says what was found.
pub(crate) fn calibrate(
    scenes: &[Scene],
    (releases, threads): (usize, Option<usize>),
    out: &Path,
    progress: impl Fn(),
) -> Result<String> {
    let ensemble = Ensemble::new(threads)?;
    let mut trials: Vec<(Ends, Trial)> = Vec::new();
    let found = calibrate::calibrate(scenes, &ensemble, releases, &mut |ends, trial| {
        trials.push((ends, trial.clone()));
        progress();
    })?;
    let vary = scenes[0].calibrate.as_ref().map_or(&[][..], |table| &table.vary);
    let mut fitted = Vec::new();
    for scene in scenes {
        let name = scene.file.file_stem().unwrap_or_default().to_string_lossy();
        fitted.push((format!("{name}_fitted.toml"), calibrate::fitted_scene(scene, vary, &found)?));
    }
    output::write_calibration(out, &found, (&trials, &fitted))?;
    let out = out.display();
    Ok(format!("{found}all trials in {out}/calibration.csv, fitted scenes beside it"))
}

/// Puts the shards of a run together, and draws the report.
pub(crate) fn merge(shards: &[PathBuf], out: &Path, mode: Mode) -> Result<()> {
    let results = output::merge(shards, out, mode)?;
    report::draw_merged(&results, &shards[0])
}

/// Draws figures and page again from the results in `dir`.
pub(crate) fn draw(dir: &Path) -> Result<()> {
    report::draw_again(dir)
}

/// Health of mesh files as they will be welded, in words.
pub(crate) fn check_meshes(files: &[PathBuf], up: Up) -> Result<String> {
    let source = |path: &PathBuf| Source { up, ..slope_source(path) };
    let sources: Vec<Source> = files.iter().map(source).collect();
    let (_, health) = Terrain::read(&sources, Vec3::zeros(), None)?;
    Ok(health.to_string())
}

/// Turns a GeoTIFF or an ESRI ASCII grid into an STL file; says what was subtracted.
pub(crate) fn mesh_from_grid(grid: &Path, out: &Path) -> Result<String> {
    file::keep_inputs(out, &[grid])?;
    let read = formats::read_grid(grid)?;
    read.check_slope(grid)?;
    let grid = read;
    let origin_m = grid.map_origin_m();
    let facets = grid.facets(origin_m);
    write_binary(out, &facets)?;
    Ok(format!(
        "{} triangles written to {}\norigin_m = [{:?}, {:?}, {:?}]  # write this into the scene",
        facets.len(),
        out.display(),
        origin_m.x,
        origin_m.y,
        origin_m.z
    ))
}

/// Turns a list of trees into stems on a slope.
pub(crate) fn mesh_of_stems(
    (list, slope): (&Path, &Path),
    out: &Path,
    origin_m: Option<&[f64]>,
) -> Result<String> {
    file::keep_inputs(out, &[list, slope])?;
    let map_origin_m = match origin_m {
        None => Vec3::zeros(),
        Some(&[x, y, z]) if [x, y, z].iter().all(|m| m.is_finite()) => Vec3::new(x, y, z),
        Some(_) => {
            let wrong = "--origin-m: write three finite numbers, as in 2600000,1200000,0";
            return Err(Error::Request(wrong.to_owned()));
        }
    };
    let trees = make::read_list(list)?;
    let (terrain, _) = Terrain::read(&[slope_source(slope)], map_origin_m, None)?;
    let mut facets = make::plant(list, &trees, &terrain)?;
    for corner in facets.iter_mut().flatten() {
        *corner -= map_origin_m;
    }
    write_binary(out, &facets)?;
    Ok(format!("{} stems, {} triangles written to {}", trees.len(), facets.len(), out.display()))
}

/// A mesh file as it stands.
fn slope_source(path: &Path) -> Source {
    Source::stl(Sheet { path: path.to_owned(), ground: 0, is_tree: false })
}

/// Writes one of the made slopes and shapes.
pub(crate) fn make_mesh(kind: &str, out: &Path) -> Result<String> {
    let shipped = make::shipped();
    let name = |file: &'static str| file.trim_end_matches(".stl");
    let Some((_, facets)) = shipped.iter().find(|(file, _)| name(file) == kind) else {
        let known: Vec<&str> = shipped.iter().map(|(file, _)| name(file)).collect();
        let known = known.join(", ");
        return Err(Error::Request(format!("mesh make: found {kind}; write one of {known}")));
    };
    write_binary(out, facets)?;
    Ok(format!("{} triangles written to {}", facets.len(), out.display()))
}
