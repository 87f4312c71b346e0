//! Studies: from the command line to the study floor and to files.

use rockfall::ensemble::Ensemble;
use rockfall::error::{Error, Result};
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::solver::Scheme;
use rockfall::study::aim::Aim;
use rockfall::study::scene::{Of, PERCENTS, QUANTITIES, SceneStudy};
use rockfall::study::speed::{self, Order, WRITTEN};
use rockfall::study::stability::{self, Map, Outcome};
use rockfall::study::{self, Wish, conserve, exact, exact_values, order, scene};
use std::cell::Cell;
use std::path::{Path, PathBuf};

/// How a study of a scene is asked for.
#[derive(Debug)]
pub(crate) struct SceneOrder {
    /// The scene file.
    pub(crate) scene: PathBuf,
    /// Folder for page, table and figure.
    pub(crate) out: PathBuf,
    /// Releases under each setting, instead of the scene's.
    pub(crate) releases: Option<usize>,
    /// Worker threads; `None` = all cores.
    pub(crate) threads: Option<usize>,
    /// Whether to try coarser meshes too.
    pub(crate) meshes: bool,
    /// What the cheapest setting shall reach.
    pub(crate) within: Option<Aim>,
}

/// Studies the exact cases and says where the result is.
pub(crate) fn exact_cases(out: &Path, done: impl Fn(&str)) -> Result<String> {
    let values = exact_values::values();
    let ladders = order::study();
    let studies = exact::study(done);
    study::write_exact(&studies, &ladders, &values, out)?;
    Ok(format!("{}page, tables and figures in {}", exact_values::table(&values), out.display()))
}

/// Runs the stiff and extreme cases; says how many bounds are kept, and whether all are.
pub(crate) fn stability(out: &Path, done: impl Fn(&str)) -> Result<(String, bool)> {
    let outcomes = stability::study(&done);
    let maps = Map::all();
    done("map of stiffness against step");
    study::write_stability(&outcomes, &maps, out)?;
    let mut words: Vec<String> = outcomes
        .iter()
        .filter(|outcome| !outcome.holds())
        .map(|Outcome { case, setting, scheme, law, found, bound }| {
            format!(
                "outside its bound: {case}, {setting}, {}: {law}: {found:.2e} > {bound:.2e}",
                scheme.name()
            )
        })
        .collect();
    let all_hold = words.is_empty();
    words.push(format!(
        "{} of {} bounds kept; page, table and map in {}",
        outcomes.len() - words.len(),
        outcomes.len(),
        out.display()
    ));
    Ok((words.join("\n"), all_hold))
}

/// Follows worlds of more and more spheres, those of `settle` to the end of their story; says what was found, and whether
/// all of it is as it should be.
pub(crate) fn scaling(
    (out, (longest_s, settle)): (&Path, (f64, &[usize])),
    schemes: &[(Scheme, &[usize])],
    done: impl Fn(String) + Send + Sync,
) -> Result<(String, bool)> {
    // One thread: processor time is that of the thread.
    let worlds = Ensemble::new(Some(1))?.install(|| {
        let before = study::resident_now();
        let mut all: Vec<(usize, Scheme)> = schemes
            .iter()
            .flat_map(|(scheme, list)| list.iter().map(|&spheres| (spheres, *scheme)))
            .collect();
        // Small worlds first: what a large one has given back to the process would hide their memory.
        all.sort_by_key(|(spheres, _)| *spheres);
        let settled_s = study::Phase::Settling.times_s().1;
        let follow = |(spheres, scheme): (usize, Scheme)| {
            let settles = scheme != Scheme::Dda && settle.contains(&spheres);
            let until_s = if settles { longest_s.max(settled_s) } else { longest_s };
            let world = study::world(scheme, spheres, (until_s, before));
            done(format!(
                "{}, {spheres} spheres: {:.2} s of processor time for {until_s} s",
                scheme.name(),
                world.processor_s
            ));
            world
        };
        all.into_iter().map(follow).collect::<Vec<_>>()
    });
    study::write_scaling(&worlds, out)?;
    let found = study::findings(&worlds);
    let mut words: Vec<String> = found
        .iter()
        .map(|(words, holds)| format!("{}{words}", if *holds { "" } else { "outside its bound: " }))
        .collect();
    words.push(format!("page, table and figure in {}", out.display()));
    Ok((words.join("\n"), found.iter().all(|(_, holds)| *holds)))
}

/// Runs so many releases of a scene on so many threads; says which bounds are kept, and whether all are.
pub(crate) fn conservation(
    scene: &Path,
    out: &Path,
    (releases, threads): (Option<usize>, Option<usize>),
    done: impl Fn(&str),
) -> Result<(String, bool)> {
    let mut asked = Scene::read(scene)?;
    asked.release.count = releases.unwrap_or(asked.release.count);
    let (terrain, _) = asked.read_terrain()?;
    let plan = Plan::compile(&asked, terrain)?;
    if plan.rock_against_rock.is_kept() {
        return Err(Error::Request(format!(
            "{}: [release] together = true: conservation is studied rock by rock; leave together out",
            scene.display()
        )));
    }
    let count = plan.count;
    let ensemble = Ensemble::new(threads)?;
    let tenths = Cell::new(0);
    let found = conserve::study(plan, &ensemble, |rocks| {
        if 10 * rocks / count > tenths.replace(10 * rocks / count) {
            done(&format!("{rocks} of {count} releases"));
        }
    })?;
    study::write_conservation(&found, out)?;
    let line = |bound: &conserve::Bound| {
        let kept = if bound.holds() { "kept" } else { "NOT KEPT" };
        format!("{kept}: {}: {:.1e} (bound {:.1e})", bound.law, bound.found, bound.bound)
    };
    let mut words: Vec<String> = found.bounds().iter().map(line).collect();
    words.push(format!("page and table in {}", out.display()));
    Ok((words.join("\n"), found.holds()))
}

/// Measures speed and says where the result is.
pub(crate) fn speed(
    (rocks, triangles): (usize, &[usize]),
    out: &Path,
    done: impl FnMut(String),
) -> Result<String> {
    let program = std::env::current_exe().map_err(|why| {
        Error::Request(format!("the program does not find itself to measure its memory: {why}"))
    })?;
    // run where its source code lies, it can name the commit
    let package = std::fs::read_to_string("Cargo.toml").unwrap_or_default();
    let source = package.contains("name = \"rockfall\"").then(|| PathBuf::from("."));
    let order = Order { rocks, triangles: triangles.to_vec(), written: WRITTEN, program, source };
    let found = speed::study(&order, &out.join("work"), done)?;
    study::write_speed(&found, out)?;
    Ok(format!("page, tables and figure in {}", out.display()))
}

/// Studies a scene and says what was found in a few sentences.
pub(crate) fn scene_errors(order: &SceneOrder, done: impl Fn(String)) -> Result<String> {
    let mut asked = Scene::read(&order.scene)?;
    asked.release.count = order.releases.unwrap_or(asked.release.count);
    let (terrain, _) = asked.read_terrain()?;
    let plan = Plan::compile(&asked, terrain)?;
    if let Some(aim) = &order.within {
        among_studied(aim)?;
    }
    let ensemble = Ensemble::new(order.threads)?;
    let found = scene::study(plan, &ensemble, order.meshes, |rung, times| {
        let each = 1e3 * rung.seconds / asked.release.count as f64;
        let setting = study::setting(&rung.step);
        let mesh =
            if times > 1.0 { format!(", edges {times} times as long") } else { String::new() };
        done(format!("{setting}{mesh}: {:.1} s, {each:.2} ms a rock", rung.seconds));
    })?;
    let wish = order.within.as_ref().and_then(|aim| wish(aim, &found));
    study::write_scene(&found, wish, &order.out)?;
    let mut words: Vec<String> = found
        .statistics
        .iter()
        .enumerate()
        .filter_map(|(number, statistic)| {
            let wished = wish.filter(|wish| wish.statistic == number).map(|wish| wish.error);
            let is_shown = statistic.percent == 95 || wished.is_some();
            is_shown.then(|| study::sentence(&found, statistic, wished).replace("**", ""))
        })
        .collect();
    words.push(format!("page, table and figure in {}", order.out.display()));
    Ok(words.join("\n"))
}

/// The error that an interval allows is half its width.
fn wish(aim: &Aim, found: &SceneStudy) -> Option<Wish> {
    let is_it = |statistic: &scene::Statistic| {
        let subject = &found.subjects[statistic.subject];
        subject.of == Of::Rock(aim.quantity) && statistic.percent == aim.percent
    };
    let statistic = found.statistics.iter().position(is_it)?;
    Some(Wish { statistic, error: 0.5 * aim.width })
}

fn among_studied(aim: &Aim) -> Result<()> {
    let is_studied = QUANTITIES.iter().any(|(quantity, ..)| *quantity == aim.quantity)
        && PERCENTS.contains(&aim.percent);
    if is_studied {
        return Ok(());
    }
    let names = QUANTITIES.map(|(_, name, _)| name).join(", ");
    let percents = PERCENTS.map(|percent| format!("p{percent}")).join(", ");
    Err(Error::Request(format!(
        "--within: found \"{aim}\"; a study looks at {percents} of {names}: write one of these"
    )))
}
