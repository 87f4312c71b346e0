//! Table, page and figure of the cost against the number of rocks in one world.

use crate::scaling::{Cost, Phase, World, exponent};
use rockfall::error::{Error, Result};
use rockfall::output::write_atomic;
use rockfall::report::axis::Axis;
use rockfall::report::canvas::{Canvas, Label, NORMAL, Pen, paint};
use rockfall::report::colour::{GREY, INK};
use rockfall::report::figure::WIDTH_PX;
use rockfall::report::panel::{FOOT_PX, Panel};
use rockfall::report::svg::path::PaperFrame;
use rockfall::solver::Scheme;
use rockfall::study::exact_figure::{colour, shape};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Other programs' cost of the same worlds: spheres, LIGGGHTS at 0.05 ms, Rapier at 5 ms (processor seconds by
/// simulated second), as measured before on a like machine.
const OTHERS: [(usize, f64, f64); 3] = [(48, 0.14, 0.016), (500, 0.76, 0.23), (5000, 7.7, 7.8)];

/// Largest exponent of the time of a step of all spheres, and of memory, that counts as near-linear (–): a logarithm of
/// the number and larger caches' misses.
const NEAR_LINEAR: f64 = 1.2;

/// Worlds from which on the growth of what settling costs is fitted: fewer spheres lie side by side and make no heap.
const HEAP: usize = 500;
/// Share of steps of `rigid` that may stop before every impulse has settled (–): friction may go round in circles. They
/// are counted.
const RIGID_UNSETTLED: f64 = 1e-3;

const SCHEMES: [Scheme; 3] = [Scheme::Adaptive, Scheme::Dda, Scheme::Rigid];

fn of(worlds: &[World], scheme: Scheme) -> impl Iterator<Item = &World> {
    worlds.iter().filter(move |world| world.scheme == scheme)
}

fn fit(worlds: &[World], scheme: Scheme, value: impl Fn(&World) -> Option<f64>) -> Option<f64> {
    let points = of(worlds, scheme).filter_map(|w| Some((w.spheres as f64, value(w)?)));
    exponent(&points.filter(|point| point.1 > 0.0).collect::<Vec<_>>())
}

/// Every law that a world must keep, and whether it does.
pub fn findings(worlds: &[World]) -> Vec<(String, bool)> {
    let mut found = Vec::new();
    for scheme in SCHEMES {
        for phase in Phase::ALL {
            found.extend(growth(worlds, scheme, phase));
        }
        let memory = |world: &World| world.memory_bytes.map(|bytes| bytes as f64);
        if let Some(slope) = fit(worlds, scheme, memory) {
            let words = format!("{}: memory grows as N^{slope:.2}", scheme.name());
            found.push((words, slope <= NEAR_LINEAR));
        }
    }
    for world in worlds {
        let name = format!("{}, {} spheres", world.scheme.name(), world.spheres);
        found.push((format!("{name}: {} lost", world.lost), world.lost == 0));
        let (fastest, fall) = world.fastest_m_s;
        let words = format!(
            "{name}: the fastest reached {fastest:.2} m/s, a free fall to the floor gives {fall:.2} m/s"
        );
        found.push((words, fastest <= fall));
        let unsettled = world.census.unsettled;
        let share = unsettled as f64 / world.census.steps.max(1) as f64;
        let words = format!("{name}: {unsettled} of {} steps did not settle", world.census.steps);
        let most = match world.scheme {
            Scheme::Dda => 0.01,
            // heaps with adaptive are those of the rigid limit
            Scheme::Rigid | Scheme::Adaptive => RIGID_UNSETTLED,
            Scheme::Reference => 0.0,
        };
        found.push((words, unsettled == 0 || share < most));
    }
    found
}

/// How the time of a step of all spheres grows in one part of the story, which is bounded; and how processor time by
/// simulated time does, which is said: the larger world has more contacts a sphere.
fn growth(worlds: &[World], scheme: Scheme, phase: Phase) -> Vec<(String, bool)> {
    let (name, from) = match phase {
        Phase::Settling => {
            (format!("{}, {}, from {HEAP} spheres", scheme.name(), phase.name()), HEAP)
        }
        _ => (format!("{}, {}", scheme.name(), phase.name()), 0),
    };
    let large = |world: &World| world.spheres >= from;
    let step_s = |world: &World| world.step_s(phase).filter(|_| large(world));
    let step = fit(worlds, scheme, step_s).map(|slope| {
        let words = format!("{name}: time of a step of all spheres grows as N^{slope:.2}");
        (words, slope <= NEAR_LINEAR)
    });
    let rate = |world: &World| world.cost(phase).map(Cost::rate).filter(|_| large(world));
    let rate = fit(worlds, scheme, rate).map(|slope| {
        let words = format!(
            "{name}: processor time by simulated time grows as N^{slope:.2} (said, not bounded)"
        );
        (words, true)
    });
    step.into_iter().chain(rate).collect()
}

/// Writes the page, table and figure of the cost of many rocks in one world into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write(worlds: &[World], dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_atomic(&dir.join("scaling.svg"), figure(worlds).as_bytes())?;
    write_atomic(&dir.join("scaling.csv"), csv(worlds).as_bytes())?;
    write_atomic(&dir.join("README.md"), page(worlds).as_bytes())
}

/// The table (CSV): one row a part of a world, and one for the whole.
fn csv(worlds: &[World]) -> String {
    let mut text = "scheme,spheres,part,simulated_s,processor_s,window_s,rock_step_s,windows,returns,steps,rock_steps,rejected,sweeps,jumps,unsettled,largest_island,memory_bytes,lost,at_rest,overlap_over_radius\n".to_owned();
    for world in worlds {
        let memory = world.memory_bytes.map_or(String::new(), |bytes| bytes.to_string());
        let end = format!("{memory},{},{},{:?}", world.lost, world.at_rest, world.overlap);
        for cost in &world.costs {
            text += &csv_row(world, cost.phase.name(), cost, ",,,");
        }
        text += &csv_row(world, "whole", &whole(world), &end);
    }
    text
}

/// The whole story as one part.
fn whole(world: &World) -> Cost {
    let World { simulated_s, processor_s, census, .. } = *world;
    Cost { phase: Phase::Settling, simulated_s, processor_s, census }
}

fn csv_row(world: &World, part: &str, cost: &Cost, end: &str) -> String {
    let census = &cost.census;
    format!(
        "{},{},{part},{:?},{:?},{:?},{:?},{},{},{},{},{},{},{},{},{},{end}\n",
        world.scheme.name(),
        world.spheres,
        cost.simulated_s,
        cost.processor_s,
        cost.window_s(),
        cost.rock_step_s(),
        census.windows,
        census.returns,
        census.steps,
        census.rock_steps,
        census.rejected,
        census.sweeps,
        census.jumps,
        census.unsettled,
        census.largest
    )
}

const INTRODUCTION: &str = "\
# Many rocks in one world

Spheres of the paper's example 3 (radius 0.05 m, Table 1, restitution 0.5) fall from a grid onto the ridge between two
open boxes. Boxes and grid grow in plan with their number, depth and layers stay: the story of a sphere is the same in all
worlds, and the same parts of it are compared. One thread; processor time, not the clock on the wall.
`adaptive` runs at its default tolerance of 0.05 m/s, `dda` at the paper's step of 1e-5 s, `rigid` with steps of up to
0.01 s, shorter where a sphere would go further than a fifth of its radius. Written by `rockfall-bench scaling`.

All spheres go through windows of 1 to 2 ms: those in flight leap, each island takes as many steps of its own as it needs.
The time of a step of all spheres is, while they fall, that of a window; after that, their number times the processor time
by step of a sphere in contact. Whatever else was done is in it. Processor time by simulated time also holds how many steps
a sphere takes: that is the world's story, which is the same only where walls are far.

![Cost against number of spheres](scaling.svg)

";

/// The page (Markdown).
fn page(worlds: &[World]) -> String {
    let mut page = INTRODUCTION.to_owned();
    for phase in Phase::ALL {
        if worlds.iter().any(|world| world.cost(phase).is_some()) {
            page += &phase_table(worlds, phase);
        }
    }
    page += "## The worlds as a whole\n\n| scheme | spheres | simulated (s) | processor time (s) | memory (MB) | at rest | largest island | deepest overlap (R) | unsettled | lost |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for world in worlds {
        let memory = world
            .memory_bytes
            .map_or("–".to_owned(), |bytes| format!("{:.1}", 1e-6 * bytes as f64));
        let _ = writeln!(
            page,
            "| {} | {} | {} | {:.2} | {memory} | {} | {} | {:.1e} | {} | {} |",
            world.scheme.name(),
            world.spheres,
            world.simulated_s,
            world.processor_s,
            world.at_rest,
            world.census.largest,
            world.overlap,
            world.census.unsettled,
            world.lost
        );
    }
    page += "\n";
    for (words, holds) in findings(worlds) {
        let _ = writeln!(page, "- {}{words}", if holds { "" } else { "**outside its bound** " });
    }
    page + &beside_others(worlds)
}

fn phase_table(worlds: &[World], phase: Phase) -> String {
    let (from, to) = phase.times_s();
    let mut text = format!(
        "## {}: {from} to {to} s\n\n| scheme | spheres | step of all spheres (ms) | µs per step of a sphere in contact | window (ms) | processor s per simulated s | steps of a sphere | steps of islands | rocks in them | sweeps a step | factorised | rejected | returns |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        phase.name()
    );
    for world in worlds {
        let Some(cost) = world.cost(phase) else { continue };
        let census = &cost.census;
        let by_step = |count: u64| count as f64 / census.steps.max(1) as f64;
        let rock_step = if census.rock_steps > 0 {
            format!("{:.2}", 1e6 * cost.rock_step_s())
        } else {
            "–".to_owned()
        };
        let _ = writeln!(
            text,
            "| {} | {} | {:.3} | {rock_step} | {:.3} | {:.3} | {:.0} | {} | {:.1} | {:.1} | {} | {} | {} |",
            world.scheme.name(),
            world.spheres,
            1e3 * world.step_s(phase).unwrap_or(f64::NAN),
            1e3 * cost.window_s(),
            cost.rate(),
            census.rock_steps as f64 / world.spheres as f64,
            census.steps,
            by_step(census.rock_steps),
            by_step(census.sweeps),
            census.jumps,
            census.rejected,
            census.returns
        );
    }
    text + "\n"
}

const BESIDE: &str = "
## Beside other programs

Processor seconds by simulated second of like worlds, measured before this project on a like machine: LIGGGHTS at 0.05 ms,
Rapier at 5 ms. Which part of the story they were taken over is not known; here it is the impacts, the dearest part that all
worlds reach. Both take long steps on springs far softer than Table 1's, or on none; with `adaptive` an impact on 1 GN/m lasts a
tenth of a millisecond and is followed; `rigid` has no springs, as Rapier.

| spheres | LIGGGHTS | Rapier | adaptive, falling | adaptive, impacts | over the less of the two | rigid, impacts | over the less of the two |
|---|---|---|---|---|---|---|---|
";

fn beside_others(worlds: &[World]) -> String {
    let mut text = BESIDE.to_owned();
    for (spheres, liggghts, rapier) in OTHERS {
        let rate = |scheme: Scheme, phase: Phase| {
            let world = of(worlds, scheme).find(|world| world.spheres == spheres);
            world.and_then(|world| world.cost(phase)).map(Cost::rate)
        };
        let less = f64::min(liggghts, rapier);
        let said = |rate: Option<f64>| rate.map_or("–".to_owned(), |rate| format!("{rate:.3}"));
        let over = |rate: Option<f64>| {
            said(rate) + &rate.map_or(" | –".to_owned(), |rate| format!(" | {:.1}", rate / less))
        };
        let _ = writeln!(
            text,
            "| {spheres} | {liggghts} | {rapier} | {} | {} | {} |",
            said(rate(Scheme::Adaptive, Phase::Falling)),
            over(rate(Scheme::Adaptive, Phase::Impacts)),
            over(rate(Scheme::Rigid, Phase::Impacts))
        );
    }
    text
}

/// A number of a world.
type Value = dyn Fn(&World) -> f64;

const PLOT_PX: f64 = 120.0;
const TOP_PX: f64 = 26.0;

/// Time of a step, memory and cost over the number of spheres.
fn figure(worlds: &[World]) -> String {
    let megabytes =
        |world: &World| world.memory_bytes.map_or(f64::NAN, |bytes| 1e-6 * bytes as f64);
    let step = |phase: Phase| {
        move |world: &World| world.step_s(phase).map_or(f64::NAN, |step_s| 1e3 * step_s)
    };
    let rate = |phase: Phase| move |world: &World| world.cost(phase).map_or(f64::NAN, Cost::rate);
    let panels: [(&str, &Value); 6] = [
        ("Falling: step (ms)", &step(Phase::Falling)),
        ("Impacts: step (ms)", &step(Phase::Impacts)),
        ("Settling: step (ms)", &step(Phase::Settling)),
        ("Memory (MB)", &megabytes),
        ("Impacts: time (s/s)", &rate(Phase::Impacts)),
        ("Settling: time (s/s)", &rate(Phase::Settling)),
    ];
    let height = TOP_PX + panels.len() as f64 * (PLOT_PX + FOOT_PX + 12.0);
    paint("scaling", (WIDTH_PX, height), "Cost against number of spheres", |canvas| {
        key(canvas);
        for (row, (title, value)) in panels.iter().enumerate() {
            let top = TOP_PX + row as f64 * (PLOT_PX + FOOT_PX + 12.0);
            draw_panel(canvas, worlds, (top, title), *value);
        }
    })
}

fn draw_panel(canvas: &Canvas<'_>, worlds: &[World], (top, title): (f64, &str), value: &Value) {
    let frame = PaperFrame { left: 74.0, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
    let values = worlds.iter().map(value).filter(|y| y.is_finite());
    let (low, high) =
        values.fold((f64::INFINITY, 0.0), |(a, b), y| (f64::min(a, y), f64::max(b, y)));
    let most = worlds.iter().map(|world| world.spheres).max().unwrap_or(1) as f64;
    let least = worlds.iter().map(|world| world.spheres).min().unwrap_or(1) as f64;
    let panel = Panel::new(frame, Axis::log(least, most, "Spheres"), Axis::log(low, high, title));
    panel.grid(canvas);
    if low.is_finite() && low > 0.0 {
        // linear growth from the first point, for the eye
        let end = (most, low * most / least);
        panel.line(canvas, &[(least, low), end], Pen::full(GREY, 1.0).dashed());
    }
    for scheme in SCHEMES {
        let points: Vec<(f64, f64)> =
            of(worlds, scheme).map(|world| (world.spheres as f64, value(world))).collect();
        let points: Vec<_> = points.into_iter().filter(|point| point.1.is_finite()).collect();
        panel.line(canvas, &points, Pen::full(colour(scheme), 1.6));
        for &(x, y) in &points {
            canvas.mark(shape(scheme), panel.at(x, y), 2.8, colour(scheme));
        }
    }
    panel.axes(canvas);
}

fn key(canvas: &Canvas<'_>) {
    let mut x = 74.0;
    for scheme in SCHEMES {
        canvas.mark(shape(scheme), (x, 12.0), 3.2, colour(scheme));
        canvas.text(&Label::new(scheme.name(), (x + 9.0, 12.0)).sized(NORMAL).coloured(INK));
        x += 90.0;
    }
    let words = "dashed: in proportion; s/s: per simulated second";
    canvas.text(&Label::new(words, (x, 12.0)).coloured(GREY));
}
