//! What more threads bring.

use super::slope::Slope;
use rockfall::ensemble::Ensemble;
use rockfall::error::Result;
use rockfall::simulation::Scratch;
use rockfall::solver::Settings;
use rockfall::study::processor_time::Busy;
use std::time::Instant;

/// Rocks per second of several threads over those of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speedup {
    /// Number of threads.
    pub threads: usize,
    /// Measured by a common clock, whatever else the machine did.
    pub by_the_clock: f64,
    /// The same without the time that the threads waited for cores which other programs had; none where the system
    /// does not tell.
    pub undisturbed: Option<f64>,
    /// Share of its time that a thread had nothing to do (–).
    pub idle: Option<f64>,
}

/// One run of all rocks.
struct Lap {
    seconds: f64,
    busy: Option<Busy>,
}

/// Times that each number of threads is tried.
const LAPS: usize = 3;

/// Follows the first `rocks` releases on one thread and on `threads`, in turns.
///
/// # Errors
/// If the threads cannot be started.
pub fn speedup(slope: &Slope, step: &Settings, rocks: usize, threads: usize) -> Result<Speedup> {
    let ensembles = [Ensemble::new(Some(1))?, Ensemble::new(Some(threads))?];
    let mut laps: [Vec<Lap>; 2] = Default::default();
    for _ in 0..LAPS {
        for (ensemble, laps) in ensembles.iter().zip(&mut laps) {
            laps.push(lap(slope, step, rocks, ensemble)?);
        }
    }
    let [one, many] = &laps;
    // sums: no lap is picked for its luck
    let sum = |laps: &[Lap]| laps.iter().map(|lap| lap.seconds).sum::<f64>();
    let own = |laps: &[Lap], threads: usize| {
        laps.iter().map(|lap| lap.undisturbed_s(threads)).sum::<Option<f64>>()
    };
    let idle = many.iter().map(|lap| lap.idle(threads)).sum::<Option<f64>>();
    Ok(Speedup {
        threads,
        by_the_clock: sum(one) / sum(many),
        undisturbed: own(one, 1).zip(own(many, threads)).map(|(one, many)| one / many),
        idle: idle.map(|sum| sum / LAPS as f64),
    })
}

fn lap(slope: &Slope, step: &Settings, rocks: usize, ensemble: &Ensemble) -> Result<Lap> {
    let before = Busy::of_all_threads();
    let begun = Instant::now();
    let fall = |index: usize, scratch: &mut Scratch| Ok(slope.fall(step, index, scratch));
    for falls in ensemble.in_chunks(0..rocks, Scratch::default, fall) {
        drop(falls?);
    }
    let seconds = begun.elapsed().as_secs_f64();
    let busy = before.zip(Busy::of_all_threads()).map(|(before, after)| Busy {
        computed_s: after.computed_s - before.computed_s,
        waited_s: after.waited_s - before.waited_s,
    });
    Ok(Lap { seconds, busy })
}

impl Lap {
    /// Share of the time in which the threads neither computed nor waited for a core (–).
    fn idle(&self, threads: usize) -> Option<f64> {
        let Busy { computed_s, waited_s } = self.busy?;
        Some((1.0 - (computed_s + waited_s) / (threads as f64 * self.seconds)).max(0.0))
    }

    /// How long it would have taken with all cores to itself (s): what was computed, and as much idle time for each part
    /// of it as there was.
    fn undisturbed_s(&self, threads: usize) -> Option<f64> {
        Some(self.busy?.computed_s / threads as f64 / (1.0 - self.idle(threads)?))
    }
}
