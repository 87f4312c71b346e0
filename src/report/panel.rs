//! A framed plot: axes with ticks outside, lines, bands and bars, all cut at the frame.

use super::axis::{Axis, Tick};
use super::canvas::{Canvas, Label, NORMAL, Pen, SMALL, text_width};
use super::colour::{INK, PALE};
use super::format;
use super::svg::path::{PaperFrame, Spot, clipped, thinned};
use super::words::{Words, fill};
use plotters::style::RGBColor;

/// Length of a tick (px).
const TICK_PX: f64 = 4.0;
/// Gap between a tick and its label (px).
const GAP_PX: f64 = 3.0;
/// Room of an axis title with its gap (px).
const TITLE_PX: f64 = NORMAL + 8.0;
/// Most turns until a frame and the room of its labels agree.
const LABEL_TURNS: usize = 5;
/// From so many marks on, marks shrink to dots.
pub(super) const MANY: usize = 400;
/// How far a drawn line may lie from the true one (px): below what a printer shows.
pub(super) const TOLERANCE_PX: f64 = 0.15;
const FRAME_PEN: Pen = Pen::full(INK, 0.8);
const GRID_PEN: Pen = Pen::full(PALE, 0.6);

/// Room below a frame for ticks, labels and title (px).
pub const FOOT_PX: f64 = TICK_PX + GAP_PX + SMALL + TITLE_PX;

/// A frame with two axes.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Where it stands on the paper.
    pub frame: PaperFrame,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// Least room for the tick labels left of the frame (px): what panels on top of each other share.
    labels_px: f64,
}

/// Gives panels on top of each other one left edge and their y titles one line.
pub fn align<const N: usize>(panels: [&mut Panel; N]) {
    let widest = panels.iter().map(|panel| panel.labels_px()).fold(0.0, f64::max);
    for panel in panels {
        panel.labels_px = widest;
        panel.frame.left = panel.room_left();
    }
}

/// A panel whose labels have the room that they need; `of` makes it with so much on its left (px).
///
/// The ticks need room, and what room is left may decide the ticks: a few turns agree.
pub fn with_room(of: impl Fn(f64) -> Panel) -> Panel {
    let mut panel = of(0.0);
    for _ in 0..LABEL_TURNS {
        let room = panel.room_left();
        if room <= panel.frame.left {
            break;
        }
        panel = of(room);
    }
    panel
}

impl Panel {
    /// A panel by itself.
    pub fn new(frame: PaperFrame, x: Axis, y: Axis) -> Self {
        Self { frame, x, y, labels_px: 0.0 }
    }

    /// Where a pair of values stands on the paper; not finite where a value is not.
    pub fn at(&self, x: f64, y: f64) -> Spot {
        (
            self.frame.left + self.x.share(x) * self.frame.width(),
            self.frame.bottom - self.y.share(y) * self.frame.height(),
        )
    }

    /// Labelled ticks of the y axis that fit the height.
    fn y_ticks(&self) -> Vec<Tick> {
        self.y.ticks((self.frame.height() / 27.0).clamp(3.0, 10.0) as usize)
    }

    /// Labelled ticks of the x axis that fit the width without touching.
    fn x_ticks(&self) -> Vec<Tick> {
        let fits = |ticks: &[Tick]| {
            let widest = widest_label(ticks);
            let labelled = ticks.iter().filter(|t| !t.label.is_empty()).count();
            labelled as f64 * (widest + 16.0) <= self.frame.width() + widest
        };
        let counts = (1..=10).rev().map(|count| self.x.ticks(count));
        counts.into_iter().find(|ticks| fits(ticks)).unwrap_or_else(|| self.x.ticks(1))
    }

    fn labels_px(&self) -> f64 {
        widest_label(&self.y_ticks()).max(self.labels_px)
    }

    /// Room that ticks, labels and title of the y axis need left of the frame (px).
    pub fn room_left(&self) -> f64 {
        self.labels_px() + TICK_PX + GAP_PX + TITLE_PX + 2.0
    }

    /// Light lines across at the ticks, to be drawn before the data.
    pub fn grid(&self, canvas: &Canvas<'_>) {
        for tick in self.y_ticks().iter().filter(|t| !t.label.is_empty()) {
            let y = self.at(self.x.low, tick.value).1;
            canvas.line(&[(self.frame.left, y), (self.frame.right, y)], GRID_PEN);
        }
    }

    /// Light lines upwards at the ticks, to be drawn before the data.
    pub fn grid_upright(&self, canvas: &Canvas<'_>) {
        for tick in self.x_ticks() {
            self.upright(canvas, tick.value, GRID_PEN);
        }
    }

    /// Frame and both axes, to be drawn after the data.
    pub fn axes(&self, canvas: &Canvas<'_>) {
        self.x_axis(canvas);
        self.y_axis(canvas);
    }

    /// Frame and y axis; ticks of the x axis without labels, which the panel below carries.
    pub fn axes_above_another(&self, canvas: &Canvas<'_>) {
        for tick in self.x_ticks() {
            let x = self.at(tick.value, self.y.low).0;
            canvas.line(&[(x, self.frame.bottom), (x, self.frame.bottom + TICK_PX)], FRAME_PEN);
        }
        self.y_axis(canvas);
    }

    /// Ticks, labels and title below the frame.
    pub fn x_axis(&self, canvas: &Canvas<'_>) {
        let bottom = self.frame.bottom;
        for tick in self.x_ticks() {
            let x = self.at(tick.value, self.y.low).0;
            let length = if tick.label.is_empty() { 0.6 * TICK_PX } else { TICK_PX };
            canvas.line(&[(x, bottom), (x, bottom + length)], FRAME_PEN);
            // seven digits at the end of an axis stay on the paper
            let half = 0.5 * text_width(&tick.label, SMALL) + 1.0;
            let x = x.min(canvas.size_px().0 - half).max(half);
            let at = (x, bottom + TICK_PX + GAP_PX);
            write_if_any(canvas, &Label::new(tick.label, at).below().centred());
        }
        // the title of a slender frame stays on the paper too
        let half = 0.5 * text_width(&self.x.title, NORMAL) + 1.0;
        let middle = 0.5 * (self.frame.left + self.frame.right);
        let middle = middle.min(canvas.size_px().0 - half).max(half);
        let below = bottom + TICK_PX + GAP_PX + SMALL + 5.0;
        let title = Label::new(self.x.title.clone(), (middle, below)).below().centred();
        write_if_any(canvas, &title.sized(NORMAL));
    }

    fn y_axis(&self, canvas: &Canvas<'_>) {
        let left = self.frame.left;
        for tick in self.y_ticks() {
            let y = self.at(self.x.low, tick.value).1;
            let length = if tick.label.is_empty() { 0.6 * TICK_PX } else { TICK_PX };
            canvas.line(&[(left - length, y), (left, y)], FRAME_PEN);
            let at = (left - TICK_PX - GAP_PX, y);
            write_if_any(canvas, &Label::new(tick.label, at).right());
        }
        let middle = 0.5 * (self.frame.top + self.frame.bottom);
        let beside = left - self.labels_px() - TICK_PX - GAP_PX - 7.0;
        let title = Label::new(self.y.title.clone(), (beside, middle)).above().centred().upwards();
        write_if_any(canvas, &title.sized(NORMAL));
        canvas.outline(&self.frame, FRAME_PEN);
    }

    /// A line through values, thinned and cut at the frame.
    pub fn line(&self, canvas: &Canvas<'_>, values: &[(f64, f64)], pen: Pen) {
        for part in self.on_paper(values) {
            canvas.line(&part, pen);
        }
    }

    /// The parts of a line inside the frame, on paper and thinned.
    pub fn on_paper(&self, values: &[(f64, f64)]) -> Vec<Vec<Spot>> {
        let spots: Vec<Spot> = values.iter().map(|&(x, y)| self.at(x, y)).collect();
        clipped(&spots, &self.frame).iter().map(|part| thinned(part, TOLERANCE_PX)).collect()
    }

    /// The area between two curves over the same `x`: `(x, low, high)`. A bound that is missing or outside ends at the frame.
    pub fn band(
        &self,
        canvas: &Canvas<'_>,
        band: &[(f64, f64, f64)],
        fill: RGBColor,
        opacity: f64,
    ) {
        let edge = |x: f64, y: f64, else_y: f64| {
            let (x, y) = self.at(x, y);
            // 0 on a logarithmic axis lies infinitely far below: the edge of the frame, not a missing bound
            let y = if y.is_nan() { else_y } else { y };
            let PaperFrame { left, top, right, bottom } = self.frame;
            (x.clamp(left, right), y.clamp(top, bottom))
        };
        let inside = band.iter().filter(|(x, ..)| (self.x.low..=self.x.high).contains(x));
        let lower = inside.clone().map(|&(x, low, _)| edge(x, low, self.frame.bottom));
        let upper = inside.clone().rev().map(|&(x, _, high)| edge(x, high, self.frame.top));
        canvas.polygon(&lower.chain(upper).collect::<Vec<_>>(), fill, opacity);
    }

    /// A bar from the lower end of the y axis up to `y`, between two values of `x`.
    pub fn bar(&self, canvas: &Canvas<'_>, (from, to): (f64, f64), y: f64, fill: RGBColor) {
        let (from, to) = (from.max(self.x.low), to.min(self.x.high));
        let height = self.y.share(y).clamp(0.0, 1.0) * self.frame.height();
        if to <= from || height <= 0.0 || height.is_nan() {
            return;
        }
        let (left, right) = (self.at(from, self.y.low).0, self.at(to, self.y.low).0);
        // a hair of paper between bars
        let gap = if right - left > 3.0 { 0.4 } else { 0.0 };
        let bar = PaperFrame {
            left: left + gap,
            right: right - gap,
            top: self.frame.bottom - height,
            bottom: self.frame.bottom,
        };
        canvas.fill(&bar, fill, 1.0);
    }

    /// A line across the whole height at `x`, if that is on the axis.
    pub fn upright(&self, canvas: &Canvas<'_>, x: f64, pen: Pen) {
        if (self.x.low..=self.x.high).contains(&x) {
            let x = self.at(x, self.y.low).0;
            canvas.line(&[(x, self.frame.bottom), (x, self.frame.top)], pen);
        }
    }

    /// Grey words in the middle of a frame that has nothing to show.
    pub fn nothing(&self, canvas: &Canvas<'_>, why: &str) {
        let PaperFrame { left, top, right, bottom } = self.frame;
        let middle = (0.5 * (left + right), 0.5 * (top + bottom));
        canvas.text(&Label::new(why, middle).centred().coloured(super::colour::GREY));
    }

    /// How many rocks have less energy than the axis shows.
    pub(super) fn weaker(&self, canvas: &Canvas<'_>, words: &Words, count: usize) {
        if count > 0 {
            let said = fill(words.drawn().weaker, &[("n", &format::decimal(count as f64, 0))]);
            let at = (self.frame.left + 4.0, self.frame.top + 10.0);
            canvas.text_on_rim(&Label::new(said, at).coloured(super::colour::GREY));
        }
    }
}

fn write_if_any(canvas: &Canvas<'_>, label: &Label) {
    if !label.is_empty() {
        canvas.text(label);
    }
}

fn widest_label(ticks: &[Tick]) -> f64 {
    ticks.iter().map(|t| text_width(&t.label, SMALL)).fold(0.0, f64::max)
}
