//! The page of the speeds, and its numbers as CSV.

use super::rate::Rate;
use super::threads::Speedup;
use super::{PartCost, SpeedStudy};
use rockfall::report::format::{decimal, percent, significant};
use rockfall::study::bootstrap::Interval;
use std::fmt::Write as _;

const INTRODUCTION: &str = "\
# Speed

Scene: a made natural slope of 300 m by 400 m, 38° down to 250 m and then flat, six octaves of noise; rocks of radius
0.5 m (1414 kg) released 1 m above the ground near the top, friction 35°, restitution 0.4, rolling friction 0.5. Written
by `cargo run --release -p rockfall-bench -- speed`. Time is what one thread computes, as the system counts it: other
programs on the machine slow it by what they do to the caches, no more. Counters are the same on every machine.

";

/// Writes the page.
pub(crate) fn page(study: &SpeedStudy) -> String {
    let mut page = String::from(INTRODUCTION);
    machine(&mut page, study);
    page += "\n![Rocks per second over triangles](speed.svg)\n\n";
    rates(&mut page, study);
    shares(&mut page, study);
    compared(&mut page, study);
    threads(&mut page, study);
    parts(&mut page, study);
    output(&mut page, study);
    sizes(&mut page, study);
    page
}

fn machine(page: &mut String, study: &SpeedStudy) {
    let machine = &study.machine;
    let _ = writeln!(
        page,
        "- machine: {}, {} cores, {}",
        machine.processor, machine.cores, machine.system
    );
    let _ = writeln!(page, "- compiler: {}", machine.compiler);
    let _ = writeln!(page, "- rockfall {}", machine.version);
}

/// A scheme at its fineness.
fn name(rate: &Rate) -> String {
    let unit = rate.scheme.fineness_unit();
    let fineness = rate.fineness;
    let words = if fineness < 1e-3 { format!("{fineness:e}") } else { fineness.to_string() };
    format!("`{}` at {words} {unit}", rate.scheme.name())
}

fn rates(page: &mut String, study: &SpeedStudy) {
    *page += "## Rocks per second and core\n\nPer rock; the rate includes the rock's rows in the files.\n\n\
        | scheme | triangles | rocks | **rocks/s** | steps | rejected | leaps | impacts | triangles tested | sweeps | failed |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for rate in &study.rates {
        let effort = &rate.effort;
        let each = |count: u64| significant(rate.each(count), 4);
        let _ = writeln!(
            page,
            "| {} | {} | {} | **{}** | {} | {} | {} | {} | {} | {} | {} |",
            name(rate),
            decimal(rate.triangles as f64, 0),
            decimal(rate.rocks as f64, 0),
            significant(rate.per_second(), 3),
            each(effort.steps),
            each(effort.rejected),
            each(effort.leaps),
            each(rate.impacts),
            each(effort.triangles),
            each(effort.sweeps),
            rate.failed
        );
    }
    *page += "\n";
}

fn shares(page: &mut String, study: &SpeedStudy) {
    *page += "## Where the time goes\n\nFrom a second run with clocks in the program, what looking at them takes subtracted. *Geometry*: which features are near a \
        rock in contact and which of them touch. *Algebra*: everything else, which is forces, stages, error control, energy, the look around a rock that stays on one plane, and drawing the release. *Notes*: largest values and heights along the way. *Output*: \
        rows in the files.\n\n| scheme | triangles | leap | geometry | algebra | notes | output | one leap (µs) |\n|---|---|---|---|---|---|---|---|\n";
    for rate in &study.rates {
        let s = &rate.shares;
        let _ =
            write!(page, "| `{}` | {} |", rate.scheme.name(), decimal(rate.triangles as f64, 0));
        for share in [s.leap, s.geometry, s.algebra, s.notes, s.output] {
            let _ = write!(page, " {} |", percent(share, 1));
        }
        let _ = writeln!(page, " {} |", significant(1e6 * rate.leap_s, 3));
    }
    *page += "\n";
}

fn compared(page: &mut String, study: &SpeedStudy) {
    *page += "## The same releases under several schemes\n\nWith 95 % intervals. Differences are against the first scheme, over the releases that both have: what chance does to both \
        alike drops out. `rigid` has another contact law (no springs), `reference` the same as `adaptive`, of higher order and with a local error of 1e-8 m/s.\n\n\
        | statistic | scheme | rocks | value | difference |\n|---|---|---|---|---|\n";
    for one in &study.compared {
        let difference = one.difference.map_or_else(String::new, |found| {
            let words = interval(found, 2);
            if found.is_certain() { words } else { format!("{words}, not distinguishable from 0") }
        });
        let _ = writeln!(
            page,
            "| {} | `{}` | {} | {} | {difference} |",
            one.name,
            one.scheme.name(),
            decimal(one.rocks as f64, 0),
            interval(one.value, 2)
        );
    }
    *page += "\n";
}

fn interval(Interval { value, low, high }: Interval, decimals: usize) -> String {
    let [value, low, high] = [value, low, high].map(|x| decimal(x, decimals));
    format!("{value} ({low} to {high})")
}

fn threads(page: &mut String, study: &SpeedStudy) {
    *page += "## Threads\n\nRocks per second of several threads over those of one. *Undisturbed*: without the time that threads waited for cores which other programs had.\n\n\
        | scheme | threads | by the clock | undisturbed | idle |\n|---|---|---|---|---|\n";
    for (scheme, Speedup { threads, by_the_clock, undisturbed, idle }) in &study.speedups {
        let _ = writeln!(
            page,
            "| `{}` | {threads} | {} | {} | {} |",
            scheme.name(),
            decimal(*by_the_clock, 2),
            undisturbed.map_or("not told".to_owned(), |times| decimal(times, 2)),
            idle.map_or("not told".to_owned(), |share| percent(share, 1))
        );
    }
    *page += "\n";
}

fn parts(page: &mut String, study: &SpeedStudy) {
    let triangles = decimal(study.slopes[study.slopes.len() / 2].triangles as f64, 0);
    let _ = writeln!(
        page,
        "## What each part costs\n\nThe scene with a part over the scene without it, {triangles} triangles, `adaptive`, all rows written. What only records leaves every \
         rock as it is; what changes the rocks changes how long they take, so the work is printed beside the time. A scene pays nothing for what it leaves out: its time \
         is the column *without*.\n\n| part | rocks | with / without | without (ms) | with (ms) | steps | leaps | sweeps | triangles tested | the same rocks |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for part in &study.parts {
        let _ = writeln!(page, "{}", part_row(part));
    }
    *page += "\nCounters as with / without.\n\n";
}

fn part_row(part: &PartCost) -> String {
    let [without, with] = &part.effort;
    let ratio = |of: fn(&rockfall::simulation::Effort) -> u64| {
        decimal(of(with) as f64 / of(without).max(1) as f64, 2)
    };
    format!(
        "| {} | {} | **{}** | {} | {} | {} | {} | {} | {} | {} |",
        part.name,
        decimal(part.rocks as f64, 0),
        decimal(part.rock_s[1] / part.rock_s[0], 2),
        significant(1e3 * part.rock_s[0], 3),
        significant(1e3 * part.rock_s[1], 3),
        ratio(|effort| effort.steps),
        ratio(|effort| effort.leaps),
        ratio(|effort| effort.sweeps),
        ratio(|effort| effort.triangles),
        if part.same_rocks { "yes" } else { "no" }
    )
}

fn output(page: &mut String, study: &SpeedStudy) {
    let cost = &study.output;
    let own = study.rates.iter().filter(|rate| rate.triangles == study.middle());
    let _ = writeln!(
        page,
        "## Files and report\n\n{} releases without paths: rows {} s, summary, statistics, figures and page {} s.\n",
        decimal(cost.rocks as f64, 0),
        significant(cost.write_s, 2),
        significant(cost.report_s, 2)
    );
    for rate in own {
        let all_s = cost.rocks as f64 * rate.rock_s + cost.write_s + cost.report_s;
        let share = (cost.write_s + cost.report_s) / all_s;
        let _ = writeln!(page, "- `{}`: {} of the run", rate.scheme.name(), percent(share, 1));
    }
    *page += "\n";
}

fn sizes(page: &mut String, study: &SpeedStudy) {
    *page += "## Size of the mesh\n\n| triangles | weld (s) | index (s) | memory (bytes per triangle) |\n|---|---|---|---|\n";
    for slope in &study.slopes {
        let each = slope.bytes as f64 / slope.triangles as f64;
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} |",
            decimal(slope.triangles as f64, 0),
            significant(slope.weld_s, 2),
            significant(slope.index_s, 2),
            decimal(each, 0)
        );
    }
    *page += "\nThe whole program on a binary STL file, one thread: `plan` reads, welds, examines, indexes and plans; `run` also follows the rocks and draws the report.\n\n\
        | triangles | command | time by the clock (s) | computed (s) | peak memory (MB) |\n|---|---|---|---|---|\n";
    for run in &study.runs {
        let command = run.releases.map_or("plan".to_owned(), |n| format!("run, {n} releases"));
        let _ = writeln!(
            page,
            "| {} | {command} | {} | {} | {} |",
            decimal(run.triangles as f64, 0),
            significant(run.seconds, 2),
            run.computed_s.map_or("not told".to_owned(), |s| significant(s, 2)),
            run.peak_bytes.map_or("not told".to_owned(), |bytes| decimal(bytes as f64 / 1e6, 0))
        );
    }
}

impl SpeedStudy {
    /// Size of the slope that threads, files and statistics were looked at on (triangles).
    fn middle(&self) -> usize {
        self.slopes[self.slopes.len() / 2].triangles
    }
}

/// The rates as CSV: one row a scheme and slope.
pub(crate) fn csv(study: &SpeedStudy) -> String {
    let mut text = String::from(
        "scheme,fineness,triangles,rocks,rocks_per_second,rock_s,write_s,steps,rejected,leaps,impacts,triangles_tested,sweeps,unsettled,failed,leap,geometry,algebra,notes,output,leap_s\n",
    );
    for rate in &study.rates {
        let (effort, s) = (&rate.effort, &rate.shares);
        let each = |count: u64| rate.each(count);
        let _ = writeln!(
            text,
            "{},{},{},{},{:.2},{:.4e},{:.4e},{},{},{},{},{},{},{},{},{:.4},{:.4},{:.4},{:.4},{:.4},{:.4e}",
            rate.scheme.name(),
            rate.fineness,
            rate.triangles,
            rate.rocks,
            rate.per_second(),
            rate.rock_s,
            rate.write_s,
            each(effort.steps),
            each(effort.rejected),
            each(effort.leaps),
            each(rate.impacts),
            each(effort.triangles),
            each(effort.sweeps),
            effort.unsettled,
            rate.failed,
            s.leap,
            s.geometry,
            s.algebra,
            s.notes,
            s.output,
            rate.leap_s
        );
    }
    text
}

/// The parts as CSV.
pub(crate) fn parts_csv(study: &SpeedStudy) -> String {
    let mut text = String::from(
        "part,rocks,rock_s_without,rock_s_with,steps_without,steps_with,leaps_without,leaps_with,sweeps_without,sweeps_with,triangles_without,triangles_with,same_rocks\n",
    );
    for part in &study.parts {
        let [without, with] = &part.effort;
        let _ = writeln!(
            text,
            "\"{}\",{},{:.4e},{:.4e},{},{},{},{},{},{},{},{},{}",
            part.name,
            part.rocks,
            part.rock_s[0],
            part.rock_s[1],
            without.steps,
            with.steps,
            without.leaps,
            with.leaps,
            without.sweeps,
            with.sweeps,
            without.triangles,
            with.triangles,
            part.same_rocks
        );
    }
    text
}
