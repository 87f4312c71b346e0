//! Figures of a comparison: all differences at a glance, and distributions on top of each other.

use super::Comparison;
use super::populations::{ComparedQuantity, Population};
use super::table::{ComparedStatistic, Group, signed_percent};
use crate::hazard::{Quantity, Sample, Values};
use crate::report::axis::Axis;
use crate::report::canvas::{Canvas, Label, NORMAL, Pen, SMALL, fitted_among, paint, text_width};
use crate::report::colour::{BLUE, GREY, INK, PALE, VERMILLION};
use crate::report::figure::{Drawing, Heading, WIDTH_PX};
use crate::report::format;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::svg::path::PaperFrame;
use crate::report::words::{Words, fill};
use plotters::style::RGBColor;

const A_PEN: Pen = Pen::full(BLUE, 1.6);
const B_PEN: Pen = Pen::full(VERMILLION, 1.6).dashed();
const ROW_PX: f64 = 21.0;
const CURVE_PX: f64 = 165.0;
const CHANGES: &str = "What changes from A to B";
const CHANGES_CAPTION: &str = "Change of each statistic over its value in A, with its 95 % interval; a vermillion diamond where the \
    interval leaves out zero. One in twenty intervals misses by chance.";
const BEHIND_CAPTION: &str = "A name in quotation marks alone stands for the rocks that the barriers of each run have let through to that place: at a barrier those that arrive at it. Those that pass it are a share of all releases.";
/// Said where the first figure has fewer rows than there are first statistics.
const SAME_CAPTION: &str =
    "Statistics that are the same in both runs, and whose interval is 0, are left out.";
const CURVES_CAPTION: &str = "Share of the rocks that exceed a value: A full, B dashed ({a} and {b} rocks). Axes end where one in \
    two hundred exceeds in both.";
/// The same where rocks weigh what they stand for.
const WEIGHTED_CAPTION: &str = "Share of the rocks by frequency that exceed a value: A full, B dashed ({a} and {b} rocks computed). Axes \
    end where one in two hundred exceeds in both.";
const BEYOND_CAPTION: &str =
    "An arrow stands where a row goes on beyond the frame, with the change where that lies beyond.";
const HEAD_PX: f64 = 30.0;
/// Room for the key above the panels (px).
const KEY_PX: f64 = 20.0;
/// Changes beyond this never widen the axis, and no axis is narrower than that (–).
const MOST_CHANGE: f64 = 2.0;
const LEAST_CHANGE: f64 = 0.05;
/// The axis shows so many times the change of the median row (–).
const OVER_MEDIAN: f64 = 4.0;
/// Share of the rocks that an axis of values leaves out at its upper end (–).
const BEYOND: f64 = 0.005;

/// All figures with their captions.
pub(super) fn all(comparison: &Comparison) -> Vec<(Heading, Drawing)> {
    let words = comparison.words;
    let heading = |file: String, title: String| Heading { file, title };
    let mut drawn = vec![(
        heading("differences.svg".to_owned(), words.say(CHANGES)),
        changes(&comparison.groups, words),
    )];
    for (number, pair) in comparison.populations.iter().enumerate() {
        let curves = curves_of(pair);
        if curves.iter().any(|(_, values)| values.iter().any(|one| !one.is_empty())) {
            let (file, title) =
                (format!("exceedance_{}.svg", number + 1), words.say(&pair[0].name));
            drawn.push((
                heading(file, title),
                exceedance(&format!("compare-{number}"), pair, &curves, words),
            ));
        }
    }
    drawn
}

/// A row of the first figure: its place, which may be nowhere, and its statistic; change and its interval over the value of A.
type ChangeRow = ([String; 2], [f64; 3]);

/// The rows of the first figure.
fn rows(groups: &[Group], words: &Words) -> Vec<ChangeRow> {
    let relative = |group: &Group, row: &ComparedStatistic| -> Option<ChangeRow> {
        let (low, high) = row.difference.interval?;
        let a = row.difference.a;
        let named = match group.name.as_str() {
            "All releases" => [String::new(), row.name_in(words)],
            group => {
                let group = words.say(group);
                [place_of(&group).to_owned(), words.colon().to_owned() + &row.name_in(words)]
            }
        };
        let change = [row.difference.value, low, high].map(|x| x / a.abs());
        (a.abs() > 0.0).then(|| (named, possible(change, a)))
    };
    let rows = groups.iter().flat_map(|group| group.rows.iter().map(move |row| (group, row)));
    let first = rows.filter(|(_, row)| row.is_headline && !row.difference.is_none());
    first.filter_map(|(group, row)| relative(group, row)).collect()
}

/// What ends a name in each language, as [`Words::quoted`] writes it.
const CLOSING: [char; 3] = ['”', '“', '»'];

/// The place that a heading names, without what follows on it; a name may hold commas.
fn place_of(heading: &str) -> &str {
    let behind = heading.rfind(CLOSING).unwrap_or_default();
    let end = heading[behind..].find(',').map_or(heading.len(), |at| behind + at);
    &heading[..end]
}

/// The mark that a place ends with, and the space before it.
fn closing_of(place: &str) -> &str {
    let name = place.strip_suffix(CLOSING).unwrap_or(place).trim_end_matches('\u{a0}');
    &place[name.len()..]
}

/// Says of a row whose change lies beyond the frame how large it is, at the edge where it goes on.
fn change_beyond(
    canvas: &Canvas<'_>,
    frame: &PaperFrame,
    (change, y): (f64, f64),
    colour: RGBColor,
) {
    let text = signed_percent(change, 0);
    let label = if change > 0.0 {
        Label::new(text, (frame.right - 10.0, y)).right()
    } else {
        Label::new(text, (frame.left + 10.0, y))
    };
    canvas.text(&label.coloured(colour));
}

/// A change and its interval as far as they can be: what is positive in both runs falls by no more than all of it, whatever the
/// approximation of the interval says.
fn possible([change, low, high]: [f64; 3], a: f64) -> [f64; 3] {
    let least = if a > 0.0 && change >= -1.0 { -1.0 } else { f64::NEG_INFINITY };
    [change, low.max(least), high]
}

/// Largest change that the axis shows (–): some times the median row, so that a few that change by far do not squeeze the others.
fn reach_of(rows: &[ChangeRow]) -> f64 {
    let most = |values: &[f64; 3]| {
        values.iter().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let mut all: Vec<f64> = rows.iter().map(|(_, values)| most(values)).collect();
    all.sort_by(f64::total_cmp);
    let largest = all.last().copied().unwrap_or_default();
    let median = all.get(all.len() / 2).copied().unwrap_or_default();
    largest.min(OVER_MEDIAN * median).clamp(LEAST_CHANGE, MOST_CHANGE)
}

/// An arrow at the edge of the frame where a row goes on beyond it.
fn goes_on(canvas: &Canvas<'_>, panel: &Panel, (values, y): (&[f64; 3], f64), colour: RGBColor) {
    let frame = &panel.frame;
    let ends = [(panel.x.low, frame.left, 1.0), (panel.x.high, frame.right, -1.0)];
    for (limit, edge, inwards) in ends {
        if values.iter().any(|x| -inwards * (100.0 * x - limit) > 0.0) {
            let back = edge + 6.0 * inwards;
            canvas.polygon(&[(edge, y), (back, y - 4.0), (back, y + 4.0)], colour, 1.0);
        }
    }
}

/// The names of the rows: places are cut so that they are told apart and leave room for statistics and changes.
fn fitted_names(rows: &[ChangeRow]) -> Vec<String> {
    let places = || rows.iter().map(|([place, _], _)| place.as_str());
    let name = |([place, statistic], _): &ChangeRow| {
        let closing = closing_of(place);
        let room = 0.55 * WIDTH_PX - text_width(statistic, SMALL) - text_width(closing, SMALL);
        let cut = fitted_among(place, places(), (SMALL, room));
        let closing = if cut.ends_with('…') { closing } else { "" };
        cut + closing + statistic
    };
    rows.iter().map(name).collect()
}

fn changes(groups: &[Group], words: &Words) -> Drawing {
    let rows = rows(groups, words);
    let names = fitted_names(&rows);
    let widest = names.iter().map(|name| text_width(name, SMALL)).fold(0.0, f64::max);
    let left = widest + 16.0;
    let bottom = 8.0 + ROW_PX * rows.len().max(2) as f64;
    let frame = PaperFrame { left, top: 8.0, right: WIDTH_PX - 14.0, bottom };
    let reach = reach_of(&rows);
    let x = Axis::linear(-105.0 * reach, 105.0 * reach, words.say("Change from A to B (% of A)"));
    let panel = Panel::new(frame, x, Axis::linear(0.0, 1.0, ""));
    let svg = paint("compare", (WIDTH_PX, bottom + FOOT_PX), &words.say(CHANGES), |canvas| {
        panel.grid_upright(canvas);
        panel.upright(canvas, 0.0, Pen::full(GREY, 1.2));
        for (k, ((_, values), name)) in rows.iter().zip(&names).enumerate() {
            let y = frame.top + ROW_PX * (k as f64 + 0.5);
            canvas.line(&[(frame.left, y), (frame.right, y)], Pen::full(PALE, 0.5).dotted());
            let edge = 1.05 * reach;
            let [at, low, high] = values.map(|x| panel.at(100.0 * x.clamp(-edge, edge), 0.0).0);
            let is_clear = values[1] > 0.0 || values[2] < 0.0;
            let colour = if is_clear { VERMILLION } else { INK };
            if values[0].abs() <= edge {
                canvas.line(&[(low, y), (high, y)], Pen::full(colour, 1.6));
                // told apart without colour: a diamond where the interval leaves out zero
                canvas.mark(if is_clear { 2 } else { 0 }, (at, y), 3.0, colour);
            } else {
                change_beyond(canvas, &frame, (values[0], y), colour);
            }
            goes_on(canvas, &panel, (values, y), colour);
            canvas.text(&Label::new(name.clone(), (frame.left - 8.0, y)).right());
        }
        canvas.outline(&frame, Pen::full(INK, 0.8));
        panel.x_axis(canvas);
        if rows.is_empty() {
            panel.nothing(canvas, &words.say("nothing to compare"));
        }
    });
    let beyond = rows.iter().flat_map(|(_, values)| values).any(|x| x.abs() > 1.05 * reach);
    let mut caption = words.say(CHANGES_CAPTION);
    if groups.iter().any(|group| group.name.starts_with('“')) {
        caption = format!("{caption} {}", words.say(BEHIND_CAPTION));
    }
    if groups
        .iter()
        .flat_map(|group| &group.rows)
        .any(|row| row.is_headline && row.difference.is_none())
    {
        caption = format!("{caption} {}", words.say(SAME_CAPTION));
    }
    if beyond {
        caption = format!("{caption} {}", words.say(BEYOND_CAPTION));
    }
    Drawing { svg, caption }
}

/// The quantities of a population that are drawn, with the values of both runs.
fn curves_of([a, b]: &[Population; 2]) -> Vec<(ComparedQuantity, [&Values; 2])> {
    let shown = |measure: ComparedQuantity| {
        !measure.is_count() && measure != ComparedQuantity::Whole(Quantity::ReachAngle)
    };
    let pairs = a.values.iter().zip(&b.values).filter(|((measure, _), _)| shown(*measure));
    pairs.map(|((measure, one), (_, other))| (*measure, [one, other])).collect()
}

fn exceedance(
    name: &str,
    pair: &[Population; 2],
    curves: &[(ComparedQuantity, [&Values; 2])],
    words: &Words,
) -> Drawing {
    let half = 0.5 * WIDTH_PX;
    let band = HEAD_PX + CURVE_PX + FOOT_PX;
    let height = KEY_PX + band * curves.len().div_ceil(2) as f64;
    let title = &words.say(&pair[0].name);
    let svg = paint(name, (WIDTH_PX, height), title, |canvas| {
        key(canvas);
        for (k, (measure, values)) in curves.iter().enumerate() {
            let top = KEY_PX + band * (k / 2) as f64 + HEAD_PX;
            let left = half * (k % 2) as f64;
            let frame = PaperFrame { left, top, right: left + half - 14.0, bottom: top + CURVE_PX };
            let (_, _, size) = measure.words();
            let samples = [0, 1].map(|k| pair[k].sample(values[k], size));
            one_panel(canvas, frame, (*measure, samples), words);
        }
    });
    let count =
        |k: usize| format::decimal(pair[k].values.first().map_or(0, |(_, v)| v.len()) as f64, 0);
    let weighted = pair.iter().any(|of| of.among.standing.is_some());
    let caption = if weighted { WEIGHTED_CAPTION } else { CURVES_CAPTION };
    let caption = fill(&words.say(caption), &[("a", &count(0)), ("b", &count(1))]);
    Drawing { svg, caption }
}

fn key(canvas: &Canvas<'_>) {
    let mut x = 60.0;
    for (name, pen) in [("A", A_PEN), ("B", B_PEN)] {
        canvas.line(&[(x, 11.0), (x + 26.0, 11.0)], pen);
        canvas.text(&Label::new(name, (x + 32.0, 11.0)).bold());
        x += 70.0;
    }
}

fn one_panel(
    canvas: &Canvas<'_>,
    frame: PaperFrame,
    (measure, samples): (ComparedQuantity, [Sample; 2]),
    words: &Words,
) {
    let (name, unit, _) = measure.words();
    let name = words.say(name);
    let far = samples.iter().filter_map(|sample| Some(sample.percentile(1.0 - BEYOND)?.value));
    let x = Axis::from_zero(far, format!("{name} ({unit})"));
    let rocks = samples.iter().map(|sample| sample.values().len()).max().unwrap_or(0);
    let mut panel = Panel::new(
        frame,
        x,
        Axis::log(1.0 / rocks.clamp(10, 200) as f64, 1.0, words.say("Share exceeding")),
    );
    panel.frame.left += panel.room_left();
    let at = (panel.frame.left, panel.frame.top - 9.0);
    canvas.text(&Label::new(name, at).bold().sized(NORMAL));
    panel.grid(canvas);
    for (sample, pen) in samples.iter().zip([A_PEN, B_PEN]) {
        let curve: Vec<(f64, f64)> =
            sample.exceedance().iter().map(|point| (point.value, point.share)).collect();
        panel.line(canvas, &curve, pen);
    }
    panel.axes(canvas);
    if rocks == 0 {
        panel.nothing(canvas, &words.say("no rock"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing that is positive falls by more than all of it: an interval was drawn to −124 %.
    #[test]
    fn nothing_falls_by_more_than_all_of_it() {
        let bits = |row: [f64; 3]| row.map(f64::to_bits);
        let shown = |row: [f64; 3], of: f64| bits(possible(row, of));
        assert_eq!(shown([-1.0, -1.24, -0.76], 3.0), bits([-1.0, -1.0, -0.76]));
        assert_eq!(shown([-0.2, -0.3, -0.1], 3.0), bits([-0.2, -0.3, -0.1]));
        // below zero there is no such end
        assert_eq!(shown([-1.0, -1.24, -0.76], -3.0), bits([-1.0, -1.24, -0.76]));
    }

    /// A long name ran out of the figure at its left, where it begins; cut at its end it would lose its statistic.
    #[test]
    fn long_names_keep_their_beginning_and_their_statistic() {
        let place =
            "line “un très long nom pour voir comment la figure le dessine à côté des barres";
        let row =
            |end: &str, what: &str| ([format!("{place} {end}”"), format!(": {what}")], [0.0; 3]);
        let rows =
            [row("nord", "P95 of energy"), row("sud", "P95 of energy"), row("sud", "Passages")];
        let names = fitted_names(&rows);
        for (name, end) in
            names.iter().zip(["nord”: P95 of energy", "sud”: P95 of energy", "sud”: Passages"])
        {
            assert!(text_width(name, SMALL) <= 0.55 * WIDTH_PX, "{name}");
            assert!(name.starts_with("line “un très") && name.ends_with(end), "{name}");
        }
    }

    /// A comma in a name is no end of it, and what is cut keeps its quotation mark.
    #[test]
    fn a_name_with_a_comma_is_whole_and_a_cut_one_is_closed() {
        let heading = "Object “School, parish of Oberrüti”, barriers left aside";
        assert_eq!(place_of(heading), "Object “School, parish of Oberrüti”");
        assert_eq!(place_of("Objekt „Schule, Turm“, ohne"), "Objekt „Schule, Turm“");
        assert_eq!(place_of("All releases"), "All releases");
        assert_eq!(closing_of("Objet «\u{a0}École\u{a0}»"), "\u{a0}»");
        let place = format!("Object “{}”", "a very long name of a school ".repeat(4));
        let names = fitted_names(&[([place, ": Hit it".to_owned()], [0.0; 3])]);
        assert!(names[0].ends_with("…”: Hit it"), "{names:?}");
        assert!(text_width(&names[0], SMALL) <= 0.55 * WIDTH_PX);
    }

    /// One row of 200 % leaves the others legible.
    #[test]
    fn a_row_that_changes_by_far_does_not_squeeze_the_others() {
        let row = |x: f64| ([String::new(), String::new()], [x, 0.9 * x, 1.1 * x]);
        let rows = [0.05, 0.05, 0.05, 2.0].map(row);
        assert!((reach_of(&rows) - OVER_MEDIAN * 1.1 * 0.05).abs() < 1e-12);
        assert!((reach_of(&[]) - LEAST_CHANGE).abs() < 1e-12);
        assert!((reach_of(&[row(0.2)]) - 1.1 * 0.2).abs() < 1e-12);
    }
}
