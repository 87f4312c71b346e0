//! Where the time of a journey goes: clocks that stand still unless somebody asks.
//!
//! A clock that is off costs one branch that is always predicted; nothing else of a journey knows of it, and nothing
//! that it reads flows back into one.

use std::time::{Duration, Instant};

/// Pieces of a journey that are timed apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimedPiece {
    /// Free flight: from take-off to the next touch.
    Leap,
    /// Which features are near, and which of them touch.
    Geometry,
    /// What is noted down along a flight: largest values, heights, lines, cells, path.
    NotesInFlight,
    /// The same along the steps in contact.
    NotesInContact,
}

/// Number of pieces.
const PIECES: usize = 4;
/// No piece takes so long by itself: another program had the core meanwhile.
const INTERRUPTED: Duration = Duration::from_millis(1);

/// How long the pieces took so far.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Stopwatches {
    is_on: bool,
    took: [Duration; PIECES],
    times: [u64; PIECES],
    /// Pieces in which another program had the core: they count with the mean of the others.
    interrupted: [u64; PIECES],
}

impl Stopwatches {
    /// Stopwatches that run.
    pub fn running() -> Self {
        Self { is_on: true, ..Self::default() }
    }

    /// The present, if the clocks run.
    #[inline]
    pub fn now(&self) -> Option<Instant> {
        self.is_on.then(Instant::now)
    }

    /// Counts a piece that began at `begun`.
    #[inline]
    pub fn stop(&mut self, piece: TimedPiece, begun: Option<Instant>) {
        if let Some(begun) = begun {
            let took = begun.elapsed();
            if took < INTERRUPTED {
                self.took[piece as usize] += took;
                self.times[piece as usize] += 1;
            } else {
                self.interrupted[piece as usize] += 1;
            }
        }
    }

    /// Time of a piece (s), without what one look at the clock adds to each.
    pub fn seconds(&self, piece: TimedPiece, look_s: f64) -> f64 {
        let (took, times) = (self.took[piece as usize], self.times[piece as usize]);
        let each = took.as_secs_f64() / times.max(1) as f64;
        self.times(piece) as f64 * (each - look_s).max(0.0)
    }

    /// How often a piece was timed.
    pub fn times(&self, piece: TimedPiece) -> u64 {
        self.times[piece as usize] + self.interrupted[piece as usize]
    }
}

/// Looks at the clock that tell what one of them takes.
const LOOKS: u32 = 1000;
/// Rounds of them.
const ROUNDS: u32 = 50;

/// What one look at the clock takes (s).
pub fn look_s() -> f64 {
    let mut last = Instant::now();
    let mut least = f64::INFINITY;
    // the fastest of some rounds: in the others another program had the core
    for _ in 0..ROUNDS {
        let begun = last;
        for _ in 0..LOOKS {
            last = std::hint::black_box(Instant::now());
        }
        least = least.min(last.duration_since(begun).as_secs_f64() / f64::from(LOOKS));
    }
    least
}

#[cfg(test)]
mod tests {
    use super::{Stopwatches, TimedPiece};

    #[test]
    fn only_running_clocks_count() {
        for (mut stopwatches, times) in [(Stopwatches::default(), 0), (Stopwatches::running(), 3)] {
            for _ in 0..3 {
                let begun = stopwatches.now();
                stopwatches.stop(TimedPiece::Leap, begun);
            }
            assert_eq!(stopwatches.times(TimedPiece::Leap), times);
            assert!(stopwatches.seconds(TimedPiece::Geometry, 0.0) == 0.0);
        }
    }
}
