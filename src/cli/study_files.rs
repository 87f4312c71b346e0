//! Studies: from the command line to the study floor and to files.

use crate::ensemble::Ensemble;
use crate::error::{Error, Result};
use crate::output;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::study::scene::{Of, PERCENTS, QUANTITIES, SceneStudy};
use crate::study::stability::{self, CaseOutcome, Map};
use crate::study::target_precision::TargetPrecision;
use crate::study::{self, Wish, conserve, exact, exact_values, order, scene};
use std::cell::Cell;
use std::path::{Path, PathBuf};

/// How a study of a scene is asked for.
#[derive(Debug)]
pub(crate) struct StudyOptions {
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
    /// The precision that the cheapest setting must reach.
    pub(crate) within: Option<TargetPrecision>,
}

/// Studies the exact cases and says where the result is.
pub(crate) fn exact_cases(out: &Path, done: impl Fn(&str)) -> Result<String> {
    output::check_writable(out)?;
    let values = exact_values::values();
    let ladders = order::study();
    let studies = exact::study(done);
    study::write_exact(&studies, &ladders, &values, out)?;
    Ok(format!("{}page, tables and figures in {}", exact_values::table(&values), out.display()))
}

/// Runs the stiff and extreme cases; says how many bounds are kept, and whether all are.
pub(crate) fn stability(out: &Path, done: impl Fn(&str) + Sync) -> Result<(String, bool)> {
    output::check_writable(out)?;
    let outcomes = stability::study(&done);
    let maps = Map::all();
    done("map of stiffness against step");
    study::write_stability(&outcomes, &maps, out)?;
    let mut words: Vec<String> = outcomes
        .iter()
        .filter(|outcome| !outcome.holds())
        .map(|CaseOutcome { case, setting, scheme, law, found, bound }| {
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

/// Runs so many releases of a scene on so many threads; says which bounds are kept, and whether all are.
pub(crate) fn conservation(
    scene: &Path,
    out: &Path,
    (releases, threads): (Option<usize>, Option<usize>),
    done: impl Fn(&str),
) -> Result<(String, bool)> {
    output::check_writable(out)?;
    let mut asked = Scene::read(scene)?;
    asked.refuse_world("`study stability`")?;
    asked.release.count = releases.unwrap_or(asked.release.count);
    let (terrain, _) = asked.read_terrain()?;
    let plan = Plan::compile(&asked, terrain)?;
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

/// Studies a scene and says what was found in a few sentences.
pub(crate) fn scene_errors(options: &StudyOptions, done: impl Fn(String)) -> Result<String> {
    output::check_writable(&options.out)?;
    let mut asked = Scene::read(&options.scene)?;
    asked.refuse_world("`study error`")?;
    asked.release.count = options.releases.unwrap_or(asked.release.count);
    let (terrain, _) = asked.read_terrain()?;
    let plan = Plan::compile(&asked, terrain)?;
    if let Some(target) = &options.within {
        among_studied(target)?;
    }
    let ensemble = Ensemble::new(options.threads)?;
    let found = scene::study(plan, &ensemble, options.meshes, |rung, times| {
        let each = 1e3 * rung.seconds / asked.release.count as f64;
        let setting = study::setting(&rung.step);
        let mesh =
            if times > 1.0 { format!(", edges {times} times as long") } else { String::new() };
        done(format!("{setting}{mesh}: {:.1} s, {each:.2} ms a rock", rung.seconds));
    })?;
    let wish = options.within.as_ref().and_then(|target| wish(target, &found));
    study::write_scene(&found, wish, &options.out)?;
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
    words.push(format!("page, table and figure in {}", options.out.display()));
    Ok(words.join("\n"))
}

/// The error that an interval allows is half its width.
fn wish(target: &TargetPrecision, found: &SceneStudy) -> Option<Wish> {
    let is_it = |statistic: &scene::StudyStatistic| {
        let subject = &found.subjects[statistic.subject];
        subject.of == Of::Rock(target.quantity) && statistic.percent == target.percent
    };
    let statistic = found.statistics.iter().position(is_it)?;
    Some(Wish { statistic, error: 0.5 * target.width })
}

fn among_studied(target: &TargetPrecision) -> Result<()> {
    let is_studied = QUANTITIES.iter().any(|(quantity, ..)| *quantity == target.quantity)
        && PERCENTS.contains(&target.percent);
    if is_studied {
        return Ok(());
    }
    let names = QUANTITIES.map(|(_, name, _)| name).join(", ");
    let percents = PERCENTS.map(|percent| format!("p{percent}")).join(", ");
    Err(Error::Request(format!(
        "--within: found \"{target}\"; a study looks at {percents} of {names}: write one of these"
    )))
}
