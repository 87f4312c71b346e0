//! Table, page and figure of the cost against the number of rocks in one world.

use super::scaling::{World, exponent};
use crate::report::axis::Axis;
use crate::report::colour::{BLUE, GREEN, GREY, INK, ORANGE};
use crate::report::figure::WIDTH_PX;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::paper::{Label, NORMAL, Paper, Pen, paint};
use crate::report::svg::path::Frame;
use crate::step::Scheme;
use plotters::style::RGBColor;
use std::fmt::Write as _;

/// Other programs' cost of the same worlds: spheres, LIGGGHTS at 0.05 ms, Rapier at 5 ms (processor seconds by
/// simulated second), as measured before on a like machine.
pub(super) const OTHERS: [(usize, f64, f64); 3] =
    [(48, 0.14, 0.016), (500, 0.76, 0.23), (5000, 7.7, 7.8)];

/// Largest exponent of processor time, and of memory, that counts as near-linear (–): a logarithm of the
/// number and larger caches' misses.
pub(super) const NEAR_LINEAR: f64 = 1.2;

const SCHEMES: [Scheme; 3] = [Scheme::Adaptive, Scheme::Dda, Scheme::Rigid];

/// Worlds of `rigid` from which on growth is fitted: fewer spheres hardly lie on each other.
const RIGID_FROM: usize = 500;
/// Share of steps of `rigid` that may stop before every impulse has settled (–): friction may go round in circles. They
/// are counted.
const RIGID_UNSETTLED: f64 = 1e-4;

fn of(worlds: &[World], scheme: Scheme) -> impl Iterator<Item = &World> {
    worlds.iter().filter(move |world| world.scheme == scheme)
}

/// Time of one step of all rocks (s).
fn step_s(world: &World) -> f64 {
    world.rock_step_s() * world.spheres as f64
}

/// Every law that a world must keep, and whether it does.
pub fn findings(worlds: &[World]) -> Vec<(String, bool)> {
    let mut found = Vec::new();
    for scheme in SCHEMES {
        let (name, from) = match scheme {
            Scheme::Rigid => (format!("rigid, from {RIGID_FROM} spheres"), RIGID_FROM),
            _ => (scheme.name().to_owned(), 0),
        };
        let fit = |value: fn(&World) -> Option<f64>| {
            let large = of(worlds, scheme).filter(|world| world.spheres >= from);
            let points = large.filter_map(|w| Some((w.spheres as f64, value(w)?)));
            exponent(&points.collect::<Vec<_>>())
        };
        if let Some(slope) = fit(|world| Some(step_s(world))) {
            // Worlds with few steps pay for their windows with them: said, not bounded.
            let words = format!("{name}: time of a step of all rocks grows as N^{slope:.2}");
            found.push((words, true));
        }
        if let Some(slope) =
            fit(|world| world.memory_bytes.filter(|bytes| *bytes > 0).map(|bytes| bytes as f64))
        {
            let words = format!("{name}: memory grows as N^{slope:.2}");
            found.push((words, slope <= NEAR_LINEAR));
        }
        if let Some(slope) = fit(|world| Some(world.cost())) {
            let words = format!("{name}: processor time by simulated time grows as N^{slope:.2}");
            found.push((words, slope <= NEAR_LINEAR));
        }
    }
    for world in worlds {
        let name = format!("{}, {} spheres", world.scheme.name(), world.spheres);
        found.push((format!("{name}: {} lost", world.lost), world.lost == 0));
        let unsettled = world.census.unsettled;
        let share = unsettled as f64 / world.census.steps.max(1) as f64;
        let words = format!("{name}: {unsettled} of {} steps did not settle", world.census.steps);
        let most = match world.scheme {
            Scheme::Dda => 0.01,
            Scheme::Rigid => RIGID_UNSETTLED,
            Scheme::Adaptive | Scheme::Reference => 0.0,
        };
        found.push((words, unsettled == 0 || share < most));
    }
    found
}

/// The table (CSV).
pub(super) fn csv(worlds: &[World]) -> String {
    let mut text = "scheme,spheres,simulated_s,processor_s,cost,rock_step_s,memory_bytes,windows,returns,steps,rock_steps,rejected,sweeps,jumps,unsettled,largest_island,lost,at_rest,overlap_over_radius\n".to_owned();
    for world in worlds {
        let census = &world.census;
        let memory = world.memory_bytes.map_or(String::new(), |bytes| bytes.to_string());
        let _ = writeln!(
            text,
            "{},{},{:?},{:?},{:?},{:?},{memory},{},{},{},{},{},{},{},{},{},{},{},{:?}",
            world.scheme.name(),
            world.spheres,
            world.simulated_s,
            world.processor_s,
            world.cost(),
            world.rock_step_s(),
            census.windows,
            census.returns,
            census.steps,
            census.rock_steps,
            census.rejected,
            census.sweeps,
            census.jumps,
            census.unsettled,
            census.largest,
            world.lost,
            world.at_rest,
            world.overlap
        );
    }
    text
}

const INTRODUCTION: &str = "\
# Many rocks in one world

Spheres of the paper's example 3 (radius 0.05 m, Table 1, restitution 0.5) fall from a grid onto the ridge between two
open boxes. Boxes and grid grow in plan with their number, depth and layers stay. One thread; processor time, not the clock on the wall.
`adaptive` runs at its default tolerance of 0.05 m/s, `dda` at the paper's step of 1e-5 s, `rigid` with steps of up to
0.01 s, shorter where a sphere would go further than a fifth of its radius. Written by `rockfall study scaling`.

![Cost against number of spheres](scaling.svg)

";

/// The page (Markdown).
pub(super) fn page(worlds: &[World]) -> String {
    let mut page = INTRODUCTION.to_owned();
    page += "| scheme | spheres | simulated (s) | processor time (s) | processor s per simulated s | µs per step of a rock | memory (MB) | steps of islands | largest island | sweeps a step | factorised | rejected | unsettled | returns | lost |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for world in worlds {
        let census = &world.census;
        let memory = world
            .memory_bytes
            .map_or("–".to_owned(), |bytes| format!("{:.1}", 1e-6 * bytes as f64));
        let _ = writeln!(
            page,
            "| {} | {} | {} | {:.2} | {:.3} | {:.2} | {memory} | {} | {} | {:.1} | {} | {} | {} | {} | {} |",
            world.scheme.name(),
            world.spheres,
            world.simulated_s,
            world.processor_s,
            world.cost(),
            1e6 * world.rock_step_s(),
            census.steps,
            census.largest,
            census.sweeps as f64 / census.steps.max(1) as f64,
            census.jumps,
            census.rejected,
            census.unsettled,
            census.returns,
            world.lost
        );
    }
    page += "\n";
    for (words, holds) in findings(worlds) {
        let _ = writeln!(page, "- {}{words}", if holds { "" } else { "**outside its bound** " });
    }
    page + &beside_others(worlds)
}

fn beside_others(worlds: &[World]) -> String {
    let mut text = "\n## Beside other programs\n\nProcessor seconds by simulated second of like worlds, measured before this project on a like machine: LIGGGHTS at 0.05 ms, Rapier at 5 ms. The time simulated there is not known; here it is that of the table above, and in the first tenths of a second most spheres still fall: once impacts are everywhere, a simulated second of a large heap costs many times as much. Both take long steps on springs far softer than Table 1's, or on none; with `adaptive` an impact on 1 GN/m lasts a tenth of a millisecond and is followed; `rigid` has no springs, as Rapier.\n\n| spheres | LIGGGHTS | Rapier | adaptive | over the less of the two | rigid | over LIGGGHTS | over Rapier |\n|---|---|---|---|---|---|---|---|\n".to_owned();
    for (spheres, liggghts, rapier) in OTHERS {
        let Some(world) = of(worlds, Scheme::Adaptive).find(|world| world.spheres == spheres)
        else {
            continue;
        };
        let ratio = world.cost() / f64::min(liggghts, rapier);
        let rigid = of(worlds, Scheme::Rigid).find(|world| world.spheres == spheres);
        let rigid = rigid.map_or("– | – | –".to_owned(), |world| {
            let cost = world.cost();
            format!("{cost:.3} | {:.2} | {:.2}", cost / liggghts, cost / rapier)
        });
        let _ = writeln!(
            text,
            "| {spheres} | {liggghts} | {rapier} | {:.3} | {ratio:.1} | {rigid} |",
            world.cost()
        );
    }
    text
}

/// A number of a world.
type Value = dyn Fn(&World) -> f64;

const PLOT_PX: f64 = 220.0;
const TOP_PX: f64 = 26.0;

fn colour(scheme: Scheme) -> RGBColor {
    match scheme {
        Scheme::Dda => ORANGE,
        Scheme::Rigid => GREEN,
        Scheme::Adaptive | Scheme::Reference => BLUE,
    }
}

/// Time of a step, memory and cost over the number of spheres.
pub(super) fn figure(worlds: &[World]) -> String {
    let megabytes =
        |world: &World| world.memory_bytes.map_or(f64::NAN, |bytes| 1e-6 * bytes as f64);
    let panels: [(&str, &Value); 3] = [
        ("Step of all rocks (ms)", &|world| 1e3 * step_s(world)),
        ("Memory (MB)", &megabytes),
        ("Processor s per simulated s", &World::cost),
    ];
    let height = TOP_PX + panels.len() as f64 * (PLOT_PX + FOOT_PX + 12.0);
    paint("scaling", (WIDTH_PX, height), "Cost against number of spheres", |paper| {
        key(paper);
        for (row, (title, value)) in panels.iter().enumerate() {
            let top = TOP_PX + row as f64 * (PLOT_PX + FOOT_PX + 12.0);
            draw_panel(paper, worlds, (top, title), *value);
        }
    })
}

fn draw_panel(paper: &Paper<'_>, worlds: &[World], (top, title): (f64, &str), value: &Value) {
    let frame = Frame { left: 74.0, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
    let values = worlds.iter().map(value).filter(|y| y.is_finite());
    let (low, high) =
        values.fold((f64::INFINITY, 0.0), |(a, b), y| (f64::min(a, y), f64::max(b, y)));
    let most = worlds.iter().map(|world| world.spheres).max().unwrap_or(1) as f64;
    let least = worlds.iter().map(|world| world.spheres).min().unwrap_or(1) as f64;
    let panel = Panel::new(frame, Axis::log(least, most, "Spheres"), Axis::log(low, high, title));
    panel.grid(paper);
    if low.is_finite() && low > 0.0 {
        // linear growth from the first point, for the eye
        let end = (most, low * most / least);
        panel.line(paper, &[(least, low), end], Pen::full(GREY, 1.0).dashed());
    }
    for scheme in SCHEMES {
        let points: Vec<(f64, f64)> =
            of(worlds, scheme).map(|world| (world.spheres as f64, value(world))).collect();
        panel.line(paper, &points, Pen::full(colour(scheme), 1.6));
        for &(x, y) in points.iter().filter(|point| point.1.is_finite()) {
            paper.disc(panel.at(x, y), 3.0, colour(scheme));
        }
    }
    panel.axes(paper);
}

fn key(paper: &Paper<'_>) {
    let mut x = 74.0;
    for scheme in SCHEMES {
        paper.disc((x, 12.0), 4.0, colour(scheme));
        paper.text(&Label::new(scheme.name(), (x + 9.0, 12.0)).sized(NORMAL).coloured(INK));
        x += 90.0;
    }
    paper.text(&Label::new("dashed: in proportion to the number", (x, 12.0)).coloured(GREY));
}
