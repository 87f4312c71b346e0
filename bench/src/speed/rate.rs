//! How fast one scheme is on one slope, what it does for that, and where the time goes.

use super::slope::Slope;
use rockfall::simulation::{Effort, Scratch, Stop, Trajectory};
use rockfall::solver::{Scheme, Settings};
use rockfall::stopwatch::{TimedPiece, look_s};
use rockfall::study::bench::settings;
use rockfall::study::processor_time::ProcessorTime;

/// Shares of the time of a rock (–); together 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shares {
    /// Flights, from take-off to the next touch.
    pub leap: f64,
    /// Which features are near a rock in contact, and which of them touch.
    pub geometry: f64,
    /// Everything else in contact: forces, stages, error control, energy, and the look around a rock on one plane.
    pub algebra: f64,
    /// Largest values and heights along the way.
    pub notes: f64,
    /// Writing its rows, without paths and impacts.
    pub output: f64,
}

/// One scheme on one slope.
#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    /// The scheme.
    pub scheme: Scheme,
    /// Its tolerance (m/s) or step (s).
    pub fineness: f64,
    /// Triangles of the slope.
    pub triangles: usize,
    /// Rocks followed.
    pub rocks: usize,
    /// Time of one rock on one core (s), without its rows in the files.
    pub rock_s: f64,
    /// Writing its rows (s).
    pub write_s: f64,
    /// What all of them cost, counted.
    pub effort: Effort,
    /// Impacts of all of them.
    pub impacts: u64,
    /// Rocks that failed.
    pub failed: usize,
    /// Time of one leap (s), with the clocks running.
    pub leap_s: f64,
    /// Where the time goes.
    pub shares: Shares,
}

impl Rate {
    /// Rocks per second and core, their rows in the files included.
    pub fn per_second(&self) -> f64 {
        1.0 / (self.rock_s + self.write_s)
    }

    /// A counter, per rock.
    pub fn each(&self, count: u64) -> f64 {
        count as f64 / self.rocks as f64
    }
}

/// A scheme at its fineness.
pub fn step_of((scheme, fineness): (Scheme, f64)) -> Settings {
    settings(scheme, fineness, None)
}

/// Rocks that warm caches and work space before anything is timed, at most.
const WARM: usize = 20;
/// Turns in which the rocks are followed; the fastest half of them counts.
const TURNS: usize = 10;

/// Follows the first `rocks` releases and gives the rate, and the journeys.
///
/// Time is that which this thread computes. What other programs do to the caches meanwhile shows in it; of the turns the
/// slower half is left out, each over the rocks it has.
pub fn measure(
    slope: &Slope,
    (scheme, fineness): (Scheme, f64),
    rocks: usize,
) -> (Rate, Vec<Trajectory>) {
    let step = step_of((scheme, fineness));
    let mut scratch = Scratch::default();
    for index in 0..rocks.min(WARM) / 2 {
        slope.fall(&step, index, &mut scratch);
    }
    let mut journeys = Vec::with_capacity(rocks);
    let length = rocks.div_ceil(TURNS);
    let mut turns: Vec<f64> = Vec::new();
    for start in (0..rocks).step_by(length) {
        let clock = ProcessorTime::begin();
        let end = rocks.min(start + length);
        journeys.extend((start..end).map(|index| slope.fall(&step, index, &mut scratch)));
        turns.push(clock.seconds());
    }
    let mut rate = Rate {
        scheme,
        fineness,
        triangles: slope.terrain.triangles.len(),
        rocks,
        rock_s: per_rock(&journeys, &turns, length),
        write_s: 0.0,
        effort: Effort::default(),
        impacts: 0,
        failed: 0,
        leap_s: 0.0,
        shares: Shares::default(),
    };
    for journey in &journeys {
        rate.effort.add(&journey.effort);
        rate.impacts += u64::from(journey.impact_count);
        rate.failed += usize::from(matches!(journey.stop, Stop::Failed(_)));
    }
    share_out(&mut rate, slope, &step);
    (rate, journeys)
}

/// Time of one rock (s): turns differ in their rocks, so each is weighed with the steps and leaps of its rocks.
fn per_rock(journeys: &[Trajectory], turns: &[f64], length: usize) -> f64 {
    let work = |journeys: &[Trajectory]| {
        journeys.iter().map(|one| (one.effort.steps + one.effort.leaps) as f64).sum::<f64>()
    };
    let works: Vec<f64> = journeys.chunks(length).map(work).collect();
    let mut order: Vec<usize> = (0..turns.len()).collect();
    order.sort_by(|&a, &b| (turns[a] / works[a]).total_cmp(&(turns[b] / works[b])));
    let fast = &order[..turns.len().div_ceil(2)];
    let sum = |of: &[f64]| fast.iter().map(|&turn| of[turn]).sum::<f64>();
    sum(turns) / sum(&works) * work(journeys) / journeys.len() as f64
}

/// Times the pieces apart in a run of its own: looking at the clock so often takes time itself.
fn share_out(rate: &mut Rate, slope: &Slope, step: &Settings) {
    let look_s = look_s();
    let mut scratch = Scratch::timed();
    let clock = ProcessorTime::begin();
    for index in 0..rate.rocks {
        slope.fall(step, index, &mut scratch);
    }
    let all_s = clock.seconds();
    let stopwatches = scratch.stopwatches();
    let of = |piece| stopwatches.seconds(piece, look_s);
    let pieces = [
        TimedPiece::Leap,
        TimedPiece::Geometry,
        TimedPiece::NotesInFlight,
        TimedPiece::NotesInContact,
    ];
    let looks = pieces.iter().map(|&piece| 2 * stopwatches.times(piece)).sum::<u64>() as f64;
    let (leap, geometry) = (of(TimedPiece::Leap), of(TimedPiece::Geometry));
    let notes = of(TimedPiece::NotesInFlight) + of(TimedPiece::NotesInContact);
    // what is left: nothing else is done with a rock but to draw its release
    let algebra = (all_s - looks * look_s - leap - geometry - notes).max(0.0);
    let sum = leap + geometry + algebra + notes;
    rate.leap_s = leap / stopwatches.times(TimedPiece::Leap).max(1) as f64;
    rate.shares = Shares {
        leap: leap / sum,
        geometry: geometry / sum,
        algebra: algebra / sum,
        notes: notes / sum,
        output: 0.0,
    };
}

impl Rate {
    /// Adds what writing a rock's rows takes (s).
    #[must_use]
    pub fn with_output(mut self, write_s: f64) -> Self {
        self.write_s = write_s;
        let all_s = self.rock_s + write_s;
        let kept = self.rock_s / all_s;
        let Shares { leap, geometry, algebra, notes, output } = &mut self.shares;
        for share in [leap, geometry, algebra, notes] {
            *share *= kept;
        }
        *output = write_s / all_s;
        self
    }
}
