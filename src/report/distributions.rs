//! Small histograms of speed, energies, bounce height and impacts.

use super::axis::Axis;
use super::by_frequency;
use super::canvas::{Canvas, Label, NORMAL, Pen, SMALL, bold_width, fitted, paint, text_width};
use super::colour::{GREY, INK};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::histogram::EqualBins;
use super::model::{Estimate, Is, Quantile, Report, ReportQuantity};
use super::panel::{FOOT_PX, Panel};
use super::runout;
use super::svg::path::PaperFrame;

/// What is shown, left to right, top to bottom.
const SHOWN: [ReportQuantity; 6] = [
    ReportQuantity::Speed,
    ReportQuantity::Height,
    ReportQuantity::Translational,
    ReportQuantity::Rotational,
    ReportQuantity::Total,
    ReportQuantity::Impacts,
];
/// Energies within so small a factor of each other have a linear axis (–).
const NARROW: f64 = 3.0;
const COLUMNS: usize = 2;
const PLOT_PX: f64 = 112.0;
const HEAD_PX: f64 = 38.0;
const ROW_PX: f64 = HEAD_PX + PLOT_PX + FOOT_PX + 4.0;
/// What of the axis of reach angles is still seen as a bar (degrees).
const LEAST_DEG: f64 = 0.5;
/// Between two numbers of a head.
const GAP: &str = " · ";
/// Room left of a frame that a head's second line may take, where the labels of its axis stand below (px).
const HEAD_BESIDE_PX: f64 = 40.0;
/// Pens of the marked percentiles, most common first.
const MARKED: [(f64, Pen); 3] = [
    (0.50, Pen::full(INK, 1.3)),
    (0.95, Pen::full(INK, 1.3).dashed()),
    (0.99, Pen::full(INK, 1.3).dotted()),
];

/// Draws one panel a quantity.
pub(super) fn draw(report: &Report) -> Drawing {
    let words = report.words();
    let rows = SHOWN.len().div_ceil(COLUMNS);
    let height = rows as f64 * ROW_PX;
    let panel = |(i, quantity): (usize, &ReportQuantity)| {
        let column = WIDTH_PX / COLUMNS as f64;
        let (left, top) = ((i % COLUMNS) as f64 * column, (i / COLUMNS) as f64 * ROW_PX);
        let frame = PaperFrame {
            left: left + 52.0,
            right: left + column - 14.0,
            top: top + HEAD_PX,
            bottom: top + HEAD_PX + PLOT_PX,
        };
        DistributionPanel::of(report, *quantity, frame)
    };
    let panels: Vec<DistributionPanel<'_>> = SHOWN.iter().enumerate().map(panel).collect();
    let svg = paint("distributions", (WIDTH_PX, height), words.distributions_title, |canvas| {
        for panel in &panels {
            panel.draw(canvas, 24.0);
        }
    });
    let note = report.is_weighted.then_some(by_frequency::CURVES);
    let is_beyond = panels.iter().any(|panel| panel.bins.beyond > 0);
    let beyond = if is_beyond { words.drawn().beyond } else { "" };
    // where rocks are too few for any percentile there is no line
    let is_marked = |q: &Quantile| q.at.value.is_finite();
    let marked = SHOWN.iter().filter_map(|one| report.quantiles.get(one)).flatten().any(is_marked);
    let lines = if marked { words.drawn().quantile_lines } else { "" };
    let caption = format!("{}{lines}{beyond}", words.distributions_caption);
    Drawing { svg, caption: by_frequency::noted(caption, note, words) }
}

/// The values of one quantity, ready to be drawn.
pub(super) struct DistributionPanel<'a> {
    report: &'a Report,
    quantity: ReportQuantity,
    bins: EqualBins,
    /// Where it is drawn; may be widened before.
    pub(super) panel: Panel,
    /// Largest value and the size of the shown unit (both SI).
    largest: f64,
    unit_size: f64,
}

impl<'a> DistributionPanel<'a> {
    pub(super) fn of(report: &'a Report, quantity: ReportQuantity, frame: PaperFrame) -> Self {
        let si = report.weighed(|fall| quantity.of(fall));
        let finite = si.iter().map(|(v, _)| *v).filter(|v| v.is_finite());
        let largest = finite.reduce(f64::max).unwrap_or(0.0);
        let (unit, unit_size) = quantity.unit(largest);
        let values: Vec<(f64, f64)> =
            si.iter().map(|(v, weight)| (v / unit_size, *weight)).collect();
        let bins = match quantity {
            // where all is much alike a logarithmic axis would be far wider than the values
            _ if quantity.is_energy() && !is_narrow(&values) => EqualBins::of_ratios(&values),
            _ if quantity.is_energy() => EqualBins::of(&values),
            ReportQuantity::Impacts => EqualBins::clipped(&values).whole(&values),
            // its axis shows what is observed elsewhere besides
            ReportQuantity::ReachAngle => EqualBins::clipped(&values).seen(&values, LEAST_DEG),
            _ => EqualBins::clipped(&values),
        };
        let words = report.words();
        let y = Axis::from_zero([1.02 * bins.tallest()], words.releases_percent);
        let panel = Panel::new(frame, bins.axis(&titled(quantity.name(words), unit)), y);
        Self { report, quantity, bins, panel, largest, unit_size }
    }

    /// Draws it with its head so far above the frame (px).
    pub(super) fn draw(&self, canvas: &Canvas<'_>, head_px: f64) {
        let said = self.report.words();
        let total = self.report.released();
        self.panel.grid(canvas);
        self.bins.bars(canvas, &self.panel);
        let mut words = self.percentiles(canvas);
        if total > 0 {
            // the angle of a rock that would have gone on is an upper bound; below that of one at rest it decides nothing
            let mut ended = self.report.releases.iter().filter(|release| !runout::is_open(release));
            let is_bound = self.quantity == ReportQuantity::ReachAngle
                && !ended.any(|release| self.quantity.of(release) >= self.largest);
            let sign = format::sign(if is_bound { Is::AtMost } else { Is::Value });
            let most = format::alone(self.largest / self.unit_size);
            words.push(format!("{} {sign}{most}", said.max));
        }
        self.panel.axes(canvas);
        if self.bins.beyond > 0 {
            words.push(format!("+{} →", format::decimal(self.bins.beyond as f64, 0)));
        }
        let above = PaperFrame { top: self.panel.frame.top - head_px, ..self.panel.frame };
        head(canvas, &above, self.quantity.name(said), &words);
        if self.bins.is_empty() {
            let why = match self.largest {
                _ if total == 0 => said.no_release,
                // a logarithmic axis has no place for 0
                largest if largest == 0.0 && self.quantity.is_energy() => said.none_above_zero,
                _ => said.no_finite,
            };
            self.panel.nothing(canvas, why);
        }
    }

    /// Draws the percentile lines and returns their values in words.
    fn percentiles(&self, canvas: &Canvas<'_>) -> Vec<String> {
        let known = self.report.quantiles.get(&self.quantity).map_or(&[][..], Vec::as_slice);
        let mut words = Vec::new();
        for (probability, pen) in MARKED {
            let found = known.iter().find(|q| (q.probability - probability).abs() < 1e-9);
            let Some(quantile) = found.filter(|q| q.at.value.is_finite()) else { continue };
            let Estimate { value, low, high, .. } = quantile.at.over(self.unit_size);
            self.panel.upright(canvas, value, pen);
            let [value, ..] = format::with_interval([value, low, high]);
            let sign = format::sign(quantile.at.is);
            words.push(format!("P{:.0} {sign}{value}", 100.0 * probability));
        }
        words
    }
}

/// Name left and numbers right, in two lines where they do not fit in one.
fn head(canvas: &Canvas<'_>, frame: &PaperFrame, name: &str, words: &[String]) {
    let y = frame.top;
    let room = frame.width() - bold_width(name, NORMAL) - 8.0;
    let fits = text_width(&words.join(GAP), SMALL) < room;
    canvas.text(&Label::new(name, (frame.left, y)).bold().sized(NORMAL));
    let y = if fits { y } else { y + 15.0 };
    let words = last_of(words, frame.width() + HEAD_BESIDE_PX);
    canvas.text(&Label::new(words, (frame.right, y)).right().coloured(GREY));
}

/// As many of the last words as have room: tables hold all percentiles, the maximum is read here.
fn last_of(words: &[String], width_px: f64) -> String {
    let from = |k: usize| words[k..].join(GAP);
    let fits = |said: &String| text_width(said, SMALL) <= width_px;
    let whole = (0..words.len()).map(from).find(fits);
    whole.unwrap_or_else(|| fitted(words.last().map_or("", String::as_str), SMALL, width_px))
}

/// Whether all values above 0 are within a small factor of each other.
fn is_narrow(values: &[(f64, f64)]) -> bool {
    let positive = || values.iter().map(|(v, _)| *v).filter(|v| v.is_finite() && *v > 0.0);
    let ends = positive().reduce(f64::min).zip(positive().reduce(f64::max));
    ends.is_some_and(|(low, high)| high < NARROW * low)
}

/// Name with its unit.
fn titled(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maximum_is_never_cut_off() {
        let words = ["P50 667 000", "P95 2 850 000", "P99 3 190 000", "max 3 506 000"];
        let words = words.map(str::to_owned);
        assert_eq!(last_of(&words, 600.0), words.join(GAP));
        let said = last_of(&words, 300.0);
        assert!(said.ends_with("P99 3 190 000 · max 3 506 000") && !said.contains('…'), "{said}");
        assert_eq!(last_of(&words, 100.0), words[3]);
        assert_eq!(last_of(&[], 100.0), "");
    }
}
