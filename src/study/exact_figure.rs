//! Work and precision: error over run time, one panel a case, one curve a scheme.

use super::exact::{CaseStudy, Curve};
use crate::report::axis::Axis;
use crate::report::canvas::{Canvas, Label, NORMAL, Pen, SMALL, paint, text_width};
use crate::report::colour::{BLUE, GREEN, GREY, ORANGE, VERMILLION};
use crate::report::figure::WIDTH_PX;
use crate::report::format;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::svg::path::PaperFrame;
use crate::solver::Scheme;
use plotters::style::RGBColor;

const PLOT_PX: f64 = 250.0;
const TOP_PX: f64 = 26.0;
/// Room right of the frame for the names of the curves (px).
const KEY_PX: f64 = 190.0;
/// Errors below this are drawn here: rounding has no place on a logarithmic axis.
const FLOOR: f64 = 1e-12;

/// The colour of a scheme in every figure of the studies.
pub fn colour(scheme: Scheme) -> RGBColor {
    scheme.of([VERMILLION, BLUE, GREEN, ORANGE])
}

/// The form of a scheme's marks.
pub fn shape(scheme: Scheme) -> usize {
    scheme.of([1, 0, 2, 3])
}

/// Draws one case.
pub(super) fn draw(study: &CaseStudy) -> String {
    let points = || study.curves.iter().flat_map(|curve| &curve.points);
    let finite = || points().filter(|point| point.error.is_finite());
    let least = finite().map(|point| shown(point.error)).fold(1.0, f64::min);
    let most = finite().map(|point| shown(point.error)).fold(least, f64::max);
    let (fast, slow) = points().fold((f64::INFINITY, 0.0_f64), |(low, high), point| {
        (low.min(point.seconds), high.max(point.seconds))
    });
    let frame =
        PaperFrame { left: 0.0, top: TOP_PX, right: WIDTH_PX - KEY_PX, bottom: TOP_PX + PLOT_PX };
    let x = Axis::log(fast, slow, "Run time (s)");
    let mut panel = Panel::new(frame, x, Axis::log(least, most, "Error of the result (–)"));
    panel.frame.left = panel.room_left();
    paint(study.case.name, (WIDTH_PX, panel.frame.bottom + FOOT_PX), study.case.title, |canvas| {
        canvas.text(&Label::new(study.case.title, (panel.frame.left, 12.0)).sized(NORMAL).bold());
        panel.grid(canvas);
        panel.grid_upright(canvas);
        for curve in &study.curves {
            draw_curve(canvas, &panel, curve);
        }
        panel.axes(canvas);
        key(canvas, &panel, study);
    })
}

fn shown(error: f64) -> f64 {
    error.max(FLOOR)
}

fn draw_curve(canvas: &Canvas<'_>, panel: &Panel, curve: &Curve) {
    let ink = colour(curve.rungs.scheme);
    let finite = curve.points.iter().filter(|point| point.error.is_finite());
    let values: Vec<(f64, f64)> = finite.map(|p| (p.seconds, shown(p.error))).collect();
    panel.line(canvas, &values, Pen::full(ink, 1.4));
    for &(x, y) in &values {
        canvas.mark(shape(curve.rungs.scheme), panel.at(x, y), 2.6, ink);
    }
}

/// Names of the schemes with their measured and theoretical orders.
fn key(canvas: &Canvas<'_>, panel: &Panel, study: &CaseStudy) {
    let left = panel.frame.right + 14.0;
    let mut y = panel.frame.top + 8.0;
    for curve in &study.curves {
        let scheme = curve.rungs.scheme;
        let middle = y;
        canvas.line(&[(left, middle), (left + 18.0, middle)], Pen::full(colour(scheme), 1.4));
        canvas.mark(shape(scheme), (left + 9.0, middle), 2.6, colour(scheme));
        canvas.text(&Label::new(scheme.name(), (left + 24.0, y)).bold());
        canvas.text(
            &Label::new(order_in_words(curve), (left + 24.0, y + SMALL + 3.0)).coloured(GREY),
        );
        y += 2.0 * SMALL + 16.0;
    }
    for line in savings_in_words(study) {
        debug_assert!(text_width(&line, SMALL) < KEY_PX);
        canvas.text(&Label::new(line, (left, y)).coloured(GREY));
        y += SMALL + 4.0;
    }
}

/// Measured order beside the theoretical one.
pub(super) fn order_in_words(curve: &Curve) -> String {
    let theory = format::plain(curve.rungs.order);
    match curve.order() {
        Some(order) => format!("order {} (theory {theory})", format::decimal(order, 1)),
        None if curve.is_exact() => "exact to rounding".to_owned(),
        None if curve.ends_at_rounding() => format!("at rounding (theory {theory})"),
        None => format!("no order to see (theory {theory})"),
    }
}

fn savings_in_words(study: &CaseStudy) -> Vec<String> {
    let savings = study.savings();
    let Some(last) = savings.last() else { return Vec::new() };
    let times = format::significant(last.time, 2);
    vec![
        "adaptive against dda,".to_owned(),
        format!("error {}:", format::significant(last.error, 1)),
        format!("{times} times faster"),
    ]
}
