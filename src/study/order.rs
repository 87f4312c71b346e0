//! Order of convergence at fixed steps: a sphere that tips over an edge without slip, its normal turning all the time.
//!
//! Error control hides the order of a scheme: it takes small steps where the motion bends and few elsewhere, and stops
//! refining where nothing is left to resolve. Here every scheme takes the same number of equal steps over the same smooth
//! motion, from well above the contact oscillation to well below it.

use super::bench::{Setup, settings};
use super::cases::{Case, rolling_off_an_edge};
use crate::ground::{Capture, Damping, Law};
use crate::math;
use crate::report::axis::Axis;
use crate::report::canvas::{Label, NORMAL, Pen, SMALL, paint};
use crate::report::figure::WIDTH_PX;
use crate::report::format;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::svg::path::PaperFrame;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::step_control::Control;
use crate::solver::{Scheme, Stepper, advance};
use std::fmt::Write as _;

/// Numbers of steps.
const STEPS: [u32; 7] = [30, 60, 120, 240, 480, 960, 1920];
/// Time of the motion (s): the rock still rolls, it slips and lifts off later.
pub(super) const LASTS_S: f64 = 0.6;
/// Errors below this are the digits of the exact solution (m).
const DIGITS_M: f64 = 1e-11;
/// Numbers of steps, the finest before rounding, over which the order is taken.
const FINEST: usize = 3;

/// One scheme at every number of `STEPS`.
#[derive(Debug, Clone)]
pub struct OrderLadder {
    /// The scheme.
    pub scheme: Scheme,
    /// Order in theory.
    pub theory: f64,
    /// Number of steps and distance of the centre from the exact place (m).
    pub errors: Vec<(u32, f64)>,
}

/// Runs every scheme at every number of steps.
pub fn study() -> Vec<OrderLadder> {
    Scheme::ALL.map(ladder).into()
}

fn ladder(scheme: Scheme) -> OrderLadder {
    let (case, exact) = rolling_off_an_edge(scheme.has_springs(), LASTS_S);
    let setup = (case.setup)(scheme.has_springs());
    let error = |steps: u32| (steps, (end(scheme, &case, &setup, steps) - exact).norm());
    OrderLadder { scheme, theory: scheme.order(), errors: STEPS.map(error).into() }
}

/// Where the rock is after [`LASTS_S`] in so many equal steps; NaN where a step fails.
fn end(scheme: Scheme, case: &Case, setup: &Setup, steps: u32) -> Vec3 {
    let terrain = case.terrain();
    let capture =
        Capture { own_m_s: Some(0.0), tolerance_m_s: 0.0, gravity_m_s2: setup.gravity_m_s2 };
    let laws =
        [Law::new(&setup.ground, &Damping::of(setup.ground.restitution), &setup.rock, &capture)];
    let body = Body::new(&setup.rock, setup.gravity_m_s2);
    let world = ContactEnvironment { terrain: &terrain, body, laws: &laws };
    let mut grip = ContactState::default();
    grip.begin(&world, setup.centre_m - terrain.origin_m, setup.velocity_m_s, setup.spin_rad_s);
    let dt = LASTS_S / f64::from(steps);
    let mut stepper = stepper(scheme, &world, &mut grip, dt);
    let mut left = LASTS_S;
    while left > 1e-9 * dt {
        match advance(&mut stepper, &world, &mut grip, left.min(dt)) {
            Ok(done) => left -= done.dt,
            Err(_) => return Vec3::repeat(f64::NAN),
        }
    }
    grip.c + terrain.origin_m
}

/// Equal steps: the tableaux with an error control that allows everything.
fn stepper(
    scheme: Scheme,
    world: &ContactEnvironment,
    grip: &mut ContactState,
    dt: f64,
) -> Stepper {
    let Some(tableau) = scheme.tableau() else {
        return Stepper::new(&settings(scheme, dt, None), world, grip);
    };
    Stepper::Controlled(
        Control { tableau, tolerance: f64::INFINITY, impact: f64::INFINITY, impact_kernels: false },
        dt,
    )
}

impl OrderLadder {
    /// Order of convergence: the slope of log error over log steps, least squares over the finest steps, as far as errors
    /// still fall and have digits.
    pub fn order(&self) -> f64 {
        let mut last = f64::INFINITY;
        let falling = self.errors.iter().take_while(|&&(_, error)| {
            let falls = error > DIGITS_M && error < last;
            last = error;
            falls
        });
        let logs: Vec<(f64, f64)> =
            falling.map(|&(steps, error)| (math::ln(f64::from(steps)), math::ln(error))).collect();
        let logs = &logs[logs.len().saturating_sub(FINEST)..];
        let n = logs.len() as f64;
        let (x, y) = logs.iter().fold((0.0, 0.0), |(x, y), log| (x + log.0 / n, y + log.1 / n));
        let (xx, xy) = logs.iter().fold((0.0, 0.0), |(xx, xy), log| {
            (xx + (log.0 - x).powi(2), xy + (log.0 - x) * (log.1 - y))
        });
        -xy / xx
    }
}

/// The table.
pub(super) fn table(ladders: &[OrderLadder]) -> String {
    let mut text = String::from(
        "## Order of convergence at fixed steps\n\nA sphere tips over an edge without slip for 0.6 s in equal steps, the normal turning all the time: distance of the \
         centre from the exact place (m). `adaptive` and `reference` with their error control switched off. The order is the slope of log error over log \
         steps over the three finest numbers of steps before rounding (some 1e-10 m). At 30 steps one step is 17 radians of the contact oscillation: so stiff, the \
         fourth-order tableau has its stage order of two, and reaches four where steps resolve the oscillation (one radian at 480).\n\n| steps |",
    );
    for ladder in ladders {
        let _ = write!(text, " {} |", ladder.scheme.name());
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(ladders.len()));
    for (row, steps) in STEPS.iter().enumerate() {
        let _ = write!(text, "| {steps} |");
        for ladder in ladders {
            let _ = write!(text, " {:.1e} |", ladder.errors[row].1);
        }
        text += "\n";
    }
    text += "| **order (theory)** |";
    for ladder in ladders {
        let _ = write!(text, " {:.2} ({}) |", ladder.order(), format::plain(ladder.theory));
    }
    text + "\n\n![Order of convergence](figures/order.svg)\n\n"
}

/// All errors as CSV.
pub(super) fn csv(ladders: &[OrderLadder]) -> String {
    let mut text = String::from("scheme,steps,error_m\n");
    for ladder in ladders {
        for (steps, error) in &ladder.errors {
            let _ = writeln!(text, "{},{steps},{error:.3e}", ladder.scheme.name());
        }
    }
    text
}

const PLOT_PX: f64 = 250.0;
const TOP_PX: f64 = 26.0;
/// Room right of the frame for the names of the curves (px).
const KEY_PX: f64 = 190.0;

/// Draws error over number of steps.
pub(super) fn draw(ladders: &[OrderLadder]) -> String {
    let finite = || ladders.iter().flat_map(|ladder| &ladder.errors).filter(|point| point.1 > 0.0);
    let (least, most) =
        finite().fold((1.0f64, 0.0f64), |(a, b), point| (a.min(point.1), b.max(point.1)));
    let frame =
        PaperFrame { left: 0.0, top: TOP_PX, right: WIDTH_PX - KEY_PX, bottom: TOP_PX + PLOT_PX };
    let (first, last) = (f64::from(STEPS[0]), f64::from(STEPS[STEPS.len() - 1]));
    let x = Axis::log(first, last, "Equal steps over 0.6 s");
    let mut panel = Panel::new(frame, x, Axis::log(least, most, "Error of the place (m)"));
    panel.frame.left = panel.room_left();
    let title = "A sphere tips over an edge without slip: order at fixed steps";
    paint("order", (WIDTH_PX, panel.frame.bottom + FOOT_PX), title, |canvas| {
        canvas.text(&Label::new(title, (panel.frame.left, 12.0)).sized(NORMAL).bold());
        panel.grid(canvas);
        panel.grid_upright(canvas);
        let (left, mut y) = (panel.frame.right + 14.0, panel.frame.top + 8.0);
        for ladder in ladders {
            let ink = super::exact_figure::colour(ladder.scheme);
            let points = ladder.errors.iter().filter(|point| point.1 > 0.0);
            let points: Vec<(f64, f64)> = points.map(|&(n, error)| (f64::from(n), error)).collect();
            panel.line(canvas, &points, Pen::full(ink, 1.4));
            for &(x, y) in &points {
                canvas.mark(super::exact_figure::shape(ladder.scheme), panel.at(x, y), 2.6, ink);
            }
            canvas.line(&[(left, y), (left + 18.0, y)], Pen::full(ink, 1.4));
            canvas.mark(super::exact_figure::shape(ladder.scheme), (left + 9.0, y), 2.6, ink);
            canvas.text(&Label::new(ladder.scheme.name(), (left + 24.0, y)).bold());
            let words = format!(
                "order {} (theory {})",
                format::decimal(ladder.order(), 2),
                format::plain(ladder.theory)
            );
            canvas.text(&Label::new(words, (left + 24.0, y + SMALL + 3.0)));
            y += 2.0 * SMALL + 16.0;
        }
        panel.axes(canvas);
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of slope −p in the logarithms has order p, whatever lies below the digits.
    #[test]
    fn the_order_is_the_slope() {
        for order in [1.0, 2.0, 4.0] {
            let error = |n: u32| (n, 1e5 * f64::from(n).powf(-order));
            let mut errors: Vec<_> = STEPS.map(error).into();
            errors.push((4000, 1e-12));
            let ladder = OrderLadder { scheme: Scheme::default(), theory: order, errors };
            assert!((ladder.order() - order).abs() < 1e-9);
        }
    }
}
