//! Numbers a year take memory by strata and classes of energy, not by rocks.
//!
//! One test in one program: other threads' memory would count too. The counting allocator is that of a small crate:
//! counting needs `unsafe`, which this crate forbids itself.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test fails by panicking")]

mod yearly;

use peak_alloc::PeakAlloc;
use rockfall::hazard::{Barrier, CrossingRow, annual};
use std::convert::Infallible;
use yearly::{asked, line, power_law, row};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Most memory taken at a time for the numbers a year of so many rocks, each of which crosses net and road (bytes).
fn peak(releases: usize) -> usize {
    let asked = asked(vec![power_law(0.1, 0.5), power_law(0.02, 1.0)]);
    let frequency = asked.frequency.clone().unwrap();
    let net = Barrier {
        name: "net".to_owned(),
        height_m: 4.0,
        capacity_j: 3e5,
        design: None,
        elsewhere: vec![],
    };
    // the same few volumes of every stratum again and again, so that all classes are met early
    let rows = (0..releases).flat_map(|index| {
        let p = (index / frequency.strata().len() % 20) as f64 / 20.0;
        let volume = frequency.stratum(index).quantile_m3(p).unwrap();
        let at = |name: &str, time_s: f64| CrossingRow {
            time_s,
            ..row(index, name, volume, 540e3 * volume)
        };
        [at("net", 1.0), at("road", 2.0)].map(Ok::<_, Infallible>)
    });
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let lines = [line("net"), line("road")];
    let found = annual(&asked, releases, (&lines, &[net]), rows).unwrap().unwrap();
    assert!(found.places[1].without_barriers.passages.rocks == releases);
    MEMORY.peak_usage().saturating_sub(before)
}

/// A hundred times as many rocks take the same memory.
#[test]
fn memory_is_flat_in_the_number_of_rocks() {
    let [few, many] = [3_000, 300_000].map(peak);
    println!("{few} bytes for 3 000 rocks, {many} bytes for 300 000");
    assert!(many <= few + few / 10, "{few} and {many}");
    // a copy of one row alone, for each of 300 000 rocks, would be 60 MB
    assert!(many < 4 << 20, "{many}");
}
