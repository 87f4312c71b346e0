//! Rocks per second and core on a made natural slope, with what they cost.
//!
//! `cargo bench --bench whole` measures everything and writes `reports/speed/`. With words behind `--` it follows rocks of
//! one scheme on one slope and prints a line: `cargo bench --bench whole -- 300 100k adaptive 0.05`.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]

use rockfall::simulation::{Effort, Scratch, Stop, Trajectory};
use rockfall::solver::Scheme;
use rockfall::study::speed::rate::step_of;
use rockfall::study::speed::slope::{SCHEMES, Slope};
use rockfall::study::speed::{Order, WRITTEN, study};
use rockfall::study::write_speed;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Rocks of the fast schemes; `ROCKFALL_BENCH_ROCKS` asks for another number.
const ROCKS: usize = 400;

fn main() {
    let words: Vec<String> =
        std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    if words.is_empty() { everything() } else { one(&words) }
}

fn everything() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rocks = std::env::var("ROCKFALL_BENCH_ROCKS").map_or(ROCKS, |rocks| rocks.parse().unwrap());
    let order = Order {
        rocks,
        triangles: vec![10_000, 100_000, 1_000_000],
        written: WRITTEN,
        program: PathBuf::from(env!("CARGO_BIN_EXE_rockfall")),
        source: Some(source.to_owned()),
    };
    let out = source.join("reports/speed");
    let found = study(&order, &out.join("work"), |piece| println!("{piece}")).unwrap();
    write_speed(&found, &out).unwrap();
    println!("page, tables and figure in {}", out.display());
}

/// Number of rocks, size of the slope, scheme, tolerance or step.
fn one(words: &[String]) {
    let word = |k: usize| words.get(k).map(String::as_str);
    let rocks: usize = word(0).and_then(|s| s.parse().ok()).unwrap_or(300);
    let triangles = match word(1) {
        Some("10k") => 10_000,
        Some("1M") => 1_000_000,
        _ => 100_000,
    };
    let mut way = SCHEMES[0];
    if let Some(name) = word(2) {
        way = *SCHEMES.iter().find(|(scheme, _)| scheme.name() == name).unwrap_or(&way);
    }
    if let Some(fineness) = word(3).and_then(|s| s.parse().ok()) {
        way.1 = fineness;
    }
    let slope = Slope::of(triangles);
    println!("weld {:.3} s, index {:.3} s", slope.weld_s, slope.index_s);
    let mut scratch = Scratch::default();
    let clock = Instant::now();
    let step = step_of(way);
    let journeys: Vec<Trajectory> =
        (0..rocks).map(|index| slope.fall(&step, index, &mut scratch)).collect();
    say(way.0, &journeys, clock.elapsed().as_secs_f64());
}

fn say(scheme: Scheme, journeys: &[Trajectory], seconds: f64) {
    let count = journeys.len();
    let mut effort = Effort::default();
    for one in journeys {
        effort.add(&one.effort);
    }
    let mean =
        |of: &dyn Fn(&Trajectory) -> f64| journeys.iter().map(of).sum::<f64>() / count as f64;
    let each = |sum: u64| sum / count as u64;
    let stops = |wanted: fn(&Stop) -> bool| journeys.iter().filter(|one| wanted(&one.stop)).count();
    let mut runouts: Vec<f64> = journeys.iter().map(Trajectory::runout_m).collect();
    runouts.sort_by(f64::total_cmp);
    let rise = journeys.iter().map(|one| one.ledger.rise_j).fold(0.0, f64::max);
    let remainder = mean(&|one| one.ledger.remainder_j) / mean(&|one| one.released_j);
    println!(
        "{}: {:.0} rocks/s; per rock: steps {} rejected {} leaps {} sweeps {} triangles {} impacts {:.0} unsettled {}; \
         at rest {} left {} time up {} failed {}; rise {rise:.2e} J remainder {remainder:.4} P50 {:.2} P95 {:.2} mean {:.2} m \
         vmax {:.2} m/s time {:.1} s",
        scheme.name(),
        count as f64 / seconds,
        each(effort.steps),
        each(effort.rejected),
        each(effort.leaps),
        each(effort.sweeps),
        each(effort.triangles),
        mean(&|one| f64::from(one.impact_count)),
        each(effort.unsettled),
        stops(|stop| *stop == Stop::AtRest),
        stops(|stop| *stop == Stop::LeftTerrain),
        stops(|stop| *stop == Stop::TimeUp),
        stops(|stop| matches!(stop, Stop::Failed(_))),
        runouts[count / 2],
        runouts[count * 95 / 100],
        mean(&Trajectory::runout_m),
        mean(&|one| one.extremes.speed_m_s),
        mean(&|one| one.end.time_s),
    );
}
