//! Both errors of a scene's statistics over run time.

use super::scene::{Of, SceneStudy, StudyQuantity, StudyStatistic};
use super::scene_page::written_unit;
use crate::hazard::Quantity;
use crate::report::axis::Axis;
use crate::report::canvas::{Canvas, Label, NORMAL, Pen, SMALL, paint, text_width};
use crate::report::colour::{BLUE, GREEN, GREY, INK, VERMILLION};
use crate::report::figure::WIDTH_PX;
use crate::report::format;
use crate::report::panel::{FOOT_PX, Panel, align};
use crate::report::svg::path::PaperFrame;
use crate::report::words::{Words, fill};
use std::fmt::Display;

const PLOT_PX: f64 = 150.0;
const TOP_PX: f64 = 44.0;
const GAP_PX: f64 = 30.0;
/// The smallest error over the largest that still has a place on an axis: one that is 0 by chance has none (–).
const SMALLEST: f64 = 1e-6;
/// The percentile that the figure shows (per cent).
const SHOWN: u8 = 95;

/// Draws one panel a quantity.
pub(super) fn draw(study: &SceneStudy) -> String {
    let shown: Vec<&StudyStatistic> =
        study.statistics.iter().filter(|statistic| is_shown(study, statistic)).collect();
    let times = shown.iter().flat_map(|statistic| points(study, statistic)).map(|point| point.0);
    let (fast, slow) = times.fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
    let mut panels: Vec<Panel> = (0..shown.len())
        .map(|row| panel(study, shown[row], row, (fast, slow), row + 1 == shown.len()))
        .collect();
    if let [a, b, c] = &mut panels[..] {
        align([a, b, c]);
    }
    let bottom = panels.last().map_or(TOP_PX, |panel| panel.frame.bottom);
    let words = Words::of(study.language);
    paint("error", (WIDTH_PX, bottom + FOOT_PX), words.error_study, |canvas| {
        key(canvas, panels.first(), !study.meshes.is_empty(), words);
        for (panel, statistic) in panels.iter().zip(&shown) {
            panel.grid(canvas);
            draw_statistic(canvas, panel, study, statistic);
            if let Some(why) = no_sampling(study, statistic, words) {
                let corner =
                    (panel.frame.right - text_width(&why, SMALL) - 4.0, panel.frame.top + 8.0);
                canvas.text(&Label::new(why, corner).coloured(BLUE));
            }
        }
        let (last, rest) = match panels.split_last() {
            Some((last, rest)) => (Some(last), rest),
            None => (None, &[][..]),
        };
        for panel in rest {
            panel.axes_above_another(canvas);
        }
        if let Some(last) = last {
            last.axes(canvas);
        }
    })
}

/// The whole journeys' quantities: those at lines are in the tables.
fn is_shown(study: &SceneStudy, statistic: &StudyStatistic) -> bool {
    let is_whole = matches!(study.subjects[statistic.subject].of, Of::Rock(_));
    is_whole && statistic.percent == SHOWN
}

/// Its name in the language of the figure.
fn name(subject: &StudyQuantity, words: &Words) -> String {
    let said = match subject.of {
        Of::Rock(Quantity::Runout) => words.runout,
        Of::Rock(Quantity::MaxTotal) => words.total,
        Of::Rock(Quantity::MaxHeight) => words.bounce_height,
        _ => return subject.name.clone(),
    };
    let mut letters = said.chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    if words.code == "de" { said.to_owned() } else { first.chain(letters).collect() }
}

fn panel(
    study: &SceneStudy,
    statistic: &StudyStatistic,
    row: usize,
    (fast, slow): (f64, f64),
    is_last: bool,
) -> Panel {
    let errors: Vec<f64> = points(study, statistic).into_iter().map(|point| point.1).collect();
    let (least, most) = reach(&errors);
    let subject = &study.subjects[statistic.subject];
    let words = Words::of(study.language);
    let (name, (unit, _)) = (name(subject, words), unit_of(study, statistic));
    let found: [(&str, &dyn Display); 3] =
        [("percent", &SHOWN), ("quantity", &name), ("unit", &unit)];
    let title = fill(words.error_axis, &found);
    let y = Axis::log(least, most, title);
    let top = TOP_PX + row as f64 * (PLOT_PX + GAP_PX);
    let title = if is_last { words.error_time } else { "" };
    let frame = PaperFrame { left: 0.0, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
    let mut panel = Panel::new(frame, Axis::log(fast, slow, title), y);
    panel.frame.left = panel.room_left();
    panel
}

/// The least and the largest error that an axis holds.
fn reach(errors: &[f64]) -> (f64, f64) {
    let above_0 = errors.iter().copied().filter(|error| *error > 0.0);
    let least = above_0.fold(f64::INFINITY, f64::min);
    let most = errors.iter().copied().fold(least, f64::max);
    (least.max(SMALLEST * most), most)
}

/// The unit of the errors of a statistic, and its size.
fn unit_of(study: &SceneStudy, statistic: &StudyStatistic) -> (&'static str, f64) {
    written_unit(study.subjects[statistic.subject].unit, statistic.own.value)
}

/// Everything that must find room: run time (s) and error.
fn points(study: &SceneStudy, statistic: &StudyStatistic) -> Vec<(f64, f64)> {
    let both = steps(study, statistic).into_iter().chain(meshes(study, statistic));
    let ends = both.flat_map(|(t, error, most)| [(t, error), (t, most)]);
    sampling(study, statistic).into_iter().chain(ends).collect()
}

/// Sampling error of the first so many releases over the time they take.
fn sampling(study: &SceneStudy, statistic: &StudyStatistic) -> Vec<(f64, f64)> {
    let each_s = study.rungs[study.own].seconds / study.releases as f64;
    let (_, size) = unit_of(study, statistic);
    statistic.sampling.iter().map(|&(n, error)| (each_s * n as f64, error / size)).collect()
}

/// Why there is no error of sampling; none where there is one.
fn no_sampling(study: &SceneStudy, statistic: &StudyStatistic, words: &Words) -> Option<String> {
    if statistic.sampling_error().is_some() {
        return None;
    }
    let why = if statistic.is_only_bound(study.releases) {
        let (n, of) = (format::decimal(statistic.open as f64, 0), study.releases);
        let of = format::decimal(of as f64, 0);
        fill(words.open().no_sampling, &[("n", &n), ("of", &of)])
    } else {
        words.no_interval.to_owned()
    };
    Some(why)
}

/// Error of the steps and what it is at most, over the time of all releases under each setting.
fn steps(study: &SceneStudy, statistic: &StudyStatistic) -> Vec<(f64, f64, f64)> {
    let (_, size) = unit_of(study, statistic);
    let one = |rung: &super::scene::Rung| {
        let error = statistic.step_error(rung.relative, rung.step.scheme);
        (rung.seconds, error.value.abs() / size, error.at_most() / size)
    };
    study.rungs.iter().map(one).collect()
}

/// The same of the meshes.
fn meshes(study: &SceneStudy, statistic: &StudyStatistic) -> Vec<(f64, f64, f64)> {
    let (_, size) = unit_of(study, statistic);
    let one = |mesh: &super::scene::MeshRung| {
        let error = statistic.mesh_error_of(mesh);
        (mesh.rung.seconds, error.value.abs() / size, error.at_most() / size)
    };
    study.meshes.iter().map(one).collect()
}

fn draw_statistic(
    canvas: &Canvas<'_>,
    panel: &Panel,
    study: &SceneStudy,
    statistic: &StudyStatistic,
) {
    let has_place = |error: f64| error >= panel.y.low * (1.0 - 1e-9);
    let inside = |error: f64| error.max(panel.y.low);
    let sampled: Vec<_> =
        sampling(study, statistic).into_iter().filter(|(_, error)| has_place(*error)).collect();
    panel.line(canvas, &sampled, Pen::full(BLUE, 1.4));
    for &(t, error) in &sampled {
        canvas.mark(0, panel.at(t, error), 2.4, BLUE);
    }
    let steps = steps(study, statistic);
    let meshes = meshes(study, statistic);
    for (shape, (bars, ink)) in [(&steps, VERMILLION), (&meshes, GREEN)].into_iter().enumerate() {
        // what has no place on the axis has no mark: its bar comes up from the frame
        for middle in bars.split(|(_, error, _)| !has_place(*error)) {
            let middle: Vec<(f64, f64)> = middle.iter().map(|&(t, error, _)| (t, error)).collect();
            panel.line(canvas, &middle, Pen::full(ink, 1.4));
        }
        for &(t, error, most) in bars.iter().filter(|bar| has_place(bar.2)) {
            let (spot, end) = (panel.at(t, inside(error)), panel.at(t, inside(most)));
            canvas.line(&[spot, end], Pen::full(ink, 0.8));
            canvas.line(&[(end.0 - 3.0, end.1), (end.0 + 3.0, end.1)], Pen::full(ink, 0.8));
            if has_place(error) {
                canvas.mark(1 + shape, spot, 2.4, ink);
            }
        }
    }
    let (own_steps, own_mesh) = (steps.get(study.own), meshes.last());
    let own = own_mesh.into_iter().chain(own_steps).map(|&(t, error, _)| (t, error));
    let own = sampled.last().copied().into_iter().chain(own);
    for (t, error) in own.filter(|(_, error)| has_place(*error)) {
        let (x, y) = panel.at(t, error);
        let ring = PaperFrame { left: x - 5.0, right: x + 5.0, top: y - 5.0, bottom: y + 5.0 };
        canvas.outline(&ring, Pen::full(INK, 1.0));
    }
}

fn key(canvas: &Canvas<'_>, first: Option<&Panel>, with_meshes: bool, words: &Words) {
    let Some(panel) = first else { return };
    let mut x = panel.frame.left;
    let title = fill(words.error_head, &[("percent", &SHOWN)]);
    canvas.text(&Label::new(title, (x, 12.0)).sized(NORMAL).bold());
    let own = words.error_own;
    let own_x = panel.frame.right - text_width(own, SMALL);
    let ring = PaperFrame { left: own_x - 15.0, right: own_x - 5.0, top: 7.0, bottom: 17.0 };
    canvas.outline(&ring, Pen::full(INK, 1.0));
    canvas.text(&Label::new(own, (own_x, 12.0)).coloured(GREY));
    for (shape, (ink, said, is_there)) in [
        (BLUE, words.error_sampling, true),
        (VERMILLION, words.error_steps, true),
        (GREEN, words.error_mesh, with_meshes),
    ]
    .into_iter()
    .enumerate()
    {
        if is_there {
            canvas.line(&[(x, 30.0), (x + 18.0, 30.0)], Pen::full(ink, 1.4));
            canvas.mark(shape, (x + 9.0, 30.0), 2.4, ink);
            canvas.text(&Label::new(said, (x + 23.0, 30.0)));
            x += 23.0 + text_width(said, SMALL) + 16.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::reach;

    /// A small error stands where it was measured, and not at the end of an axis that is too short for it; only one of next to 0 has no place.
    #[test]
    fn an_axis_reaches_down_to_the_smallest_error() {
        assert_eq!(reach(&[2.0, 4e-6, 0.0, 0.5]), (4e-6, 2.0));
        assert_eq!(reach(&[2.0, 1e-30]), (2e-6, 2.0));
    }
}
