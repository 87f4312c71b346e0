//! The page of a scene's errors: sentences, tables, CSV.

use super::bootstrap::Interval;
use super::scene::{Rung, SceneStudy, StudyStatistic};
use crate::math;
use crate::report::format::{self, significant};
use crate::report::model::energy_unit;
use crate::solver::{CORNER_WAY, Settings};
use std::fmt::Write as _;

/// A statistic and the total error wanted of it (same unit).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Which of [`SceneStudy::statistics`].
    pub statistic: usize,
    /// The wanted error.
    pub error: f64,
}

/// Why a percentile of the tables is not to all digits that of the sentences above them.
const RANKED: &str = "\nA percentile in the tables is the value of one rock, the smallest that so many of them do not exceed; in the sentences \
    above, as in reports, it lies between two neighbouring rocks.\n";

/// Said where neither steps nor mesh have the largest error.
const SAMPLING: &str = "Sampling dominates";

/// Narrower an interval is not asked to become: an error so far below its interval is not worth a hundred times the releases (–).
const MOST_NARROWED: f64 = 10.0;

/// Writes the page.
pub(super) fn page(study: &SceneStudy, wish: Option<Wish>) -> String {
    let mut page = format!("# Error against run time: {}\n\n", study.title);
    let _ = writeln!(
        page,
        "{} {} under each of {} settings, {} {}. Paths of rocks are chaotic: the same release ends metres apart under any two \
         settings, so single paths do not converge, but their statistics do. **Sampling error**: half the 95 % interval of the percentile \
         (order statistics, whatever the distribution). **Error of the steps**: how far a straight line through the percentiles of all settings, over the \
         error that each step should have and with the same releases, stands at the scene's own setting from where it goes when the steps are refined; \
         its interval from drawing the rocks again 400 times, and from what the finest settings alone say where the line misses by more than chance. A single percentile of the table lies off that line by what chaos does to the few rocks beside it.\n",
        format::decimal(study.releases as f64, 0),
        format::counted(study.releases, "release", "releases"),
        study.rungs.len(),
        study.threads,
        format::counted(study.threads, "thread", "threads")
    );
    if let Some(effective) = study.effective_releases {
        let _ = writeln!(
            page,
            "Every rock counts for its part of the frequency of its source, and all are as precise as {} of equal weight. \
             Percentiles hold for the sources as they are. Rocks are drawn again class by class of size and source, and the interval of \
             a percentile is Woodruff's.\n",
            format::decimal(effective, 0)
        );
    }
    sentences(&mut page, study, wish);
    page += "\n![Error over run time](error.svg)\n\n";
    settings_table(&mut page, study);
    page += RANKED;
    statistics_table(&mut page, study);
    mesh_table(&mut page, study);
    page
}

fn sentences(page: &mut String, study: &SceneStudy, wish: Option<Wish>) {
    for (number, statistic) in study.statistics.iter().enumerate() {
        let wished = wish.filter(|wish| wish.statistic == number).map(|wish| wish.error);
        if statistic.percent == 95 || wished.is_some() {
            let _ = writeln!(page, "- {}", sentence(study, statistic, wished));
        }
    }
}

/// What dominates, and the cheapest way to a wanted error (half the present one where none is given).
pub fn sentence(study: &SceneStudy, statistic: &StudyStatistic, wanted: Option<f64>) -> String {
    let subject = &study.subjects[statistic.subject];
    let name = &subject.name;
    let (unit, size) = written_unit(subject.unit, statistic.own.value);
    let small = |value: f64| few_digits(value / size, 2);
    let value = few_digits(statistic.own.value / size, 3);
    // as in reports: what nothing bounds from above is no number
    if statistic.own.upper_95.is_none() && statistic.own.lacks(study.releases).is_some() {
        return format!("**P{} {name}**: {}", statistic.percent, lacking(study, statistic));
    }
    let head = format!("**P{} {name} {value} {unit}**", statistic.percent);
    let (Some(sampling), Some(total)) = (statistic.sampling_error(), statistic.total_error())
    else {
        return format!("{head}: {}", without_errors(study, statistic));
    };
    let steps = statistic.ladder.own_error;
    let mesh = statistic.meshes.as_ref().map_or_else(String::new, |meshes| {
        format!(", error of the mesh {}", with_ends(&meshes.own_error, (unit, size)))
    });
    let errors = format!(
        "sampling error ±{} {unit}, error of the steps {}{mesh}, total {} {unit}",
        small(sampling),
        with_ends(&steps, (unit, size)),
        small(total)
    );
    if total <= 0.0 {
        return format!("{head}: {errors}. All rocks that decide are alike under every setting.");
    }
    let mesh_error = statistic.meshes.as_ref().map(|meshes| &meshes.own_error);
    let dominates = dominant(sampling, &steps, mesh_error);
    let wanted = wanted.unwrap_or(0.5 * total);
    let offer = offered(study, statistic, (sampling, wanted), &small(wanted));
    format!("{head}: {errors}. {dominates}; {offer}.")
}

/// How many rocks a percentile needs before it is told at all, and before it has an interval.
fn lacking(study: &SceneStudy, statistic: &StudyStatistic) -> String {
    let more = statistic.own.lacks(study.releases).unwrap_or(1);
    let needed = statistic.own.needs_for_interval(f64::from(statistic.percent) / 100.0);
    format!(
        "too few rocks, {more} more {} needed; {needed} in all for an interval.",
        format::counted(more, "is", "are")
    )
}

/// Why a statistic has no errors.
fn without_errors(study: &SceneStudy, statistic: &StudyStatistic) -> String {
    if statistic.is_only_bound(study.releases) {
        // up to as many as lie beyond the percentile leave it an end, if there are releases enough
        let beyond = 1.0 - f64::from(statistic.percent) / 100.0;
        let closes = (statistic.open as f64) < beyond * study.releases as f64;
        let remedy = if closes {
            "so that its interval has no end with so few releases; ask for more, give"
        } else {
            "and no number of releases makes it narrower; give"
        };
        return format!(
            "only a bound. {} of {} {} left the terrain, ran out of time or failed, {remedy} terrain that reaches farther, or a longer [solver] longest_s.",
            statistic.open,
            study.releases,
            format::counted(study.releases, "rock", "rocks")
        );
    }
    let needed = statistic.own.needs_for_interval(f64::from(statistic.percent) / 100.0);
    format!("too few rocks for an interval; {needed} or more are needed.")
}

/// The cheapest way to a wanted error, `said` as written, or what would bring it there.
fn offered(
    study: &SceneStudy,
    statistic: &StudyStatistic,
    (sampling, wanted): (f64, f64),
    said: &str,
) -> String {
    let unit = written_unit(study.subjects[statistic.subject].unit, statistic.own.value).0;
    let Some(offer) = study.cheapest(statistic, wanted) else {
        let finest = study.finest_steps(statistic);
        let mesh_error = statistic.meshes.as_ref().map(|meshes| &meshes.own_error);
        let remedy = remedy((sampling, wanted), &finest, mesh_error, study.releases);
        return format!("no setting tried brings it to {said} {unit}: {remedy}");
    };
    format!(
        "cheapest for a total of {said} {unit}: {} with {} releases, about {} s",
        setting(&study.rungs[offer.rung].step),
        format::decimal(offer.releases as f64, 0),
        significant(offer.seconds, 2)
    )
}

/// Which of the three errors is the largest, and whether it is there at all.
fn dominant(sampling: f64, steps: &Interval, mesh: Option<&Interval>) -> String {
    let of_mesh = mesh.map(|error| ("the mesh", error));
    let others = std::iter::once(("the steps", steps)).chain(of_mesh);
    let size = |error: &Interval| error.value.abs();
    let largest = others.reduce(|one, next| if size(next.1) > size(one.1) { next } else { one });
    match largest.filter(|(_, error)| size(error) > sampling) {
        None => SAMPLING.to_owned(),
        Some((what, error)) if error.is_certain() => format!("The error of {what} dominates"),
        Some((what, _)) => {
            format!("The error of {what} may dominate, more releases would tell it from 0")
        }
    }
}

/// What to do where no setting tried reaches a wanted error: more releases as long as chance hides what steps and mesh do (the
/// sampling error and the intervals of both fall with the root of their number), else finer steps or a finer mesh.
fn remedy(
    (sampling, wanted): (f64, f64),
    steps: &Interval,
    mesh: Option<&Interval>,
    releases: usize,
) -> String {
    let size = |error: &Interval| error.value.abs();
    let mesh_is_known = mesh.is_none_or(Interval::is_certain);
    let of_mesh = mesh.filter(|error| mesh_is_known && size(error) >= wanted).map(|_| "the mesh");
    let steps_are_it = steps.is_certain() && (mesh_is_known || size(steps) >= wanted);
    let finer = of_mesh.or(steps_are_it.then_some("the steps"));
    let larger = mesh.filter(|error| size(error) > size(steps));
    let more = (sampling / wanted).max(told_apart(larger.unwrap_or(steps)));
    let needed = math::rounded(releases as f64 * more * more, 2);
    let first = format!("about {} releases are needed first", format::decimal(needed, 0));
    let suspected = larger.map_or("the steps", |_| "the mesh");
    // a smooth surface leaves less than what is told
    let leaves_less = of_mesh.is_some() && mesh.is_some_and(|error| error.at_least() < wanted);
    let may_do = leaves_less && more <= 1.0;
    match finer {
        None => format!("{first}, to show whether {suspected} must be finer"),
        Some(what) if more > 1.0 && dominant(sampling, steps, mesh) == SAMPLING => {
            format!("{first}, then {what} must be finer")
        }
        Some(what) if may_do => format!("{what} may have to be finer"),
        Some(what) => format!("{what} must be finer"),
    }
}

/// By how much the interval of an error must become narrower to leave out 0, at most to 1/[`MOST_NARROWED`] (–).
fn told_apart(error: &Interval) -> f64 {
    let Interval { value, low, high } = *error;
    let towards_0 = if value > 0.0 { value - low } else { high - value };
    (towards_0 / value.abs().max(f64::MIN_POSITIVE)).clamp(1.0, MOST_NARROWED)
}

/// The unit that a value is written in, and its size: an energy of many digits tells none of the last.
pub(super) fn written_unit(unit: &'static str, value: f64) -> (&'static str, f64) {
    if unit == "J" { energy_unit(value) } else { (unit, 1.0) }
}

/// A number of so many digits, the whole ones too.
fn few_digits(value: f64, digits: usize) -> String {
    significant(math::rounded(value, digits), digits)
}

/// An error with its interval.
fn with_ends(error: &Interval, (unit, size): (&str, f64)) -> String {
    let small = |value: f64| few_digits(value / size, 2);
    let certainty = if error.is_certain() { "" } else { ", not distinguishable from 0" };
    let Interval { value, low, high } = error;
    if [value, low, high].iter().all(|end| **end == 0.0) {
        return format!("0 {unit}");
    }
    format!("{} {unit} ({} to {}{certainty})", small(*value), small(*low), small(*high))
}

/// A setting in words.
pub fn setting(step: &Settings) -> String {
    let own = if step.scheme.controls_error() {
        format!("tolerance {} m/s", step.tolerance_m_s)
    } else {
        format!("step {} s", step.step_s)
    };
    if (step.corner_way - CORNER_WAY).abs() < 1e-12 {
        return own;
    }
    format!("{own}, corner way {}", significant(step.corner_way, 3))
}

fn settings_table(page: &mut String, study: &SceneStudy) {
    *page += "| setting | run time (s) | contact steps per rock | passes per rock | failed | largest rise of energy (J) | unsettled steps |\n|---|---|---|---|---|---|---|\n";
    for (number, Rung { step, seconds, effort, failed, rise_j, .. }) in
        study.rungs.iter().enumerate()
    {
        let each = |count: u64| significant(count as f64 / study.releases as f64, 4);
        let own = if number == study.own { " (the scene's own)" } else { "" };
        let _ = writeln!(
            page,
            "| {}{own} | {} | {} | {} | {failed} | {rise_j:.1e} | {} |",
            setting(step),
            significant(*seconds, 3),
            each(effort.steps),
            each(effort.sweeps),
            effort.unsettled
        );
    }
    *page += "\n";
}

fn statistics_table(page: &mut String, study: &SceneStudy) {
    *page += "| statistic |";
    for rung in &study.rungs {
        let _ = write!(page, " {} |", setting(&rung.step));
    }
    let _ = writeln!(page, " limit |\n|---|{}---|", "---|".repeat(study.rungs.len()));
    for statistic in &study.statistics {
        let subject = &study.subjects[statistic.subject];
        let (unit, size) = written_unit(subject.unit, statistic.own.value);
        let told = |value: f64| significant(value / size, 5);
        let _ = write!(page, "| P{} {} ({unit}) |", statistic.percent, subject.name);
        for value in &statistic.ladder.values {
            let _ = write!(page, " {} |", told(*value));
        }
        let Interval { value, low, high } = statistic.ladder.limit;
        let _ = writeln!(page, " {} ({} to {}) |", told(value), told(low), told(high));
    }
}

/// What coarser meshes make of the same releases.
fn mesh_table(page: &mut String, study: &SceneStudy) {
    if study.meshes.is_empty() {
        *page += if study.with_meshes {
            "\nError of the mesh: not known, the slope has too few triangles to be made coarser.\n"
        } else {
            "\nError of the mesh: not asked for (`--meshes`).\n"
        };
        return;
    }
    *page += "\n## Error of the mesh\n\nThe same releases under the scene's own setting on coarser meshes: vertices of the slope are thinned out, the rest stay where they are \
        (trees stay as they are). The error of the scene's own mesh is what a straight line in the length of the edges, through the two finest meshes, leaves at length 0, as on a surface that is rough at \
        all lengths. On one that is smooth between its vertices it goes with the square of the length, and is a third of that: the interval, from drawing the rocks again, holds both. What the surface \
        does below the scene's own triangles no computation knows, so it is a guide, not a bound.\n\n| statistic |";
    for mesh in &study.meshes {
        let own = if mesh.times > 1.0 { "" } else { ", own" };
        let triangles = format::decimal(mesh.triangles as f64, 0);
        let _ = write!(page, " {} m, {triangles} triangles{own} |", significant(mesh.edge_m, 2));
    }
    let columns = "---|".repeat(study.meshes.len());
    let _ = writeln!(page, " error of the own mesh |\n|---|{columns}---|");
    for statistic in &study.statistics {
        let subject = &study.subjects[statistic.subject];
        let (unit, size) = written_unit(subject.unit, statistic.own.value);
        let Some(meshes) = &statistic.meshes else { continue };
        let _ = write!(page, "| P{} {} ({unit}) |", statistic.percent, subject.name);
        for value in &meshes.values {
            let _ = write!(page, " {} |", significant(*value / size, 5));
        }
        let _ = writeln!(page, " {} |", with_ends(&meshes.own_error, (unit, size)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What cannot be told from 0 is not said to dominate.
    #[test]
    fn only_what_is_there_dominates() {
        let error = |value: f64, low: f64, high: f64| Interval { value, low, high };
        let certain = error(0.018, 0.0005, 0.045);
        let said = |sampling: f64, steps: Interval, mesh: Option<Interval>| {
            dominant(sampling, &steps, mesh.as_ref())
        };
        assert_eq!(said(0.0094, certain, None), "The error of the steps dominates");
        assert_eq!(said(0.02, certain, None), "Sampling dominates");
        let open = error(0.006, -1e-5, 0.011);
        let may = "The error of the steps may dominate, more releases would tell it from 0";
        assert_eq!(said(0.0045, open, None), may);
        assert_eq!(said(0.0045, open, Some(certain)), "The error of the mesh dominates");
    }

    /// Chance is asked away before a mesh or steps are blamed: a finer mesh is asked for only where its error is told from 0 and is
    /// alone too large. Half the sampling error takes four times the releases.
    #[test]
    fn more_releases_come_before_a_finer_mesh() {
        let error = |value: f64, low: f64, high: f64| Interval { value, low, high };
        let none = error(0.001, -0.01, 0.01);
        let said = |sampling: f64, mesh: Interval| remedy((sampling, 1.0), &none, Some(&mesh), 300);
        let first = said(2.0, error(1.2, -0.1, 2.0));
        let whether = "releases are needed first, to show whether the mesh must be finer";
        assert_eq!(first, format!("about 1\u{2009}200 {whether}"));
        assert_eq!(said(0.5, error(1.2, 1.1, 1.5)), "the mesh must be finer");
        // a smooth surface may leave little enough
        assert_eq!(said(0.5, error(1.2, 0.8, 1.5)), "the mesh may have to be finer");
        let both = said(1.5, error(1.2, 0.8, 1.5));
        assert!(both.ends_with("releases are needed first, then the mesh must be finer"), "{both}");
        // sampling is small enough, but the mesh's interval has to become half as wide
        let told = said(0.5, error(1.0, -1.0, 2.0));
        assert!(told.starts_with("about 1") && told.contains("whether the mesh"), "{told}");
    }
}
