//! All rocks on all cores, in fixed order, chunk by chunk.
//!
//! A rock is a function of its number alone, so how the numbers are dealt to threads and cut into chunks changes
//! the time, never a bit of the answer. A chunk is long enough that little time passes waiting for its last rock,
//! short enough that an interrupt is answered in seconds and that its paths fit in memory.

use crate::error::{Error, Result};
use crate::simulation::{CellPassage, Crossing, Impact, PathPoint, Stretch, Trajectory};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time a chunk should take: what an interrupt waits and a crash loses.
const CHUNK_TIME: Duration = Duration::from_secs(2);
/// Memory the journeys of a chunk may take (bytes), as far as the chunk before tells.
const CHUNK_BYTES: usize = 64 << 20;
/// Fewest rocks of a chunk for each thread: waiting for the last one then costs at most an eighth of the chunk.
const FEWEST_PER_THREAD: usize = 8;
/// Most times that a chunk may be longer than the one before: a few rocks tell little of those to come, but each
/// chunk costs the disk a few milliseconds whatever its length.
const GROWTH: usize = 8;
/// Pieces a chunk is cut into for each thread, so that all end at nearly the same time.
const PIECES_PER_THREAD: usize = 64;
/// Most rocks that one worker takes at a time.
const LARGEST_PIECE: usize = 16;

/// The worker threads, and the flag that stops them between chunks.
#[derive(Debug)]
pub struct Ensemble {
    pool: rayon::ThreadPool,
    stop: Arc<AtomicBool>,
}

impl Ensemble {
    /// Starts `threads` workers, or one for each core.
    ///
    /// # Errors
    ///
    /// For 0 threads, and for more than the system grants.
    pub fn new(threads: Option<usize>) -> Result<Self> {
        if threads == Some(0) {
            return Err(Error::Request("--threads 0: at least one thread must compute".to_owned()));
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or(0))
            .build()
            .map_err(|why| {
                Error::Request(format!(
                    "cannot start the threads: {why}; ask for fewer with --threads"
                ))
            })?;
        Ok(Self { pool, stop: Arc::default() })
    }

    /// Number of worker threads.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// The flag that stops the computation after the current chunk; set it from a Ctrl-C handler, for example.
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// Runs `work` on the worker threads; parallel iterators inside it use all of them.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// Computes the `releases` with `fall`, giving the journeys of one chunk at a time, in order.
    ///
    /// `scratch` makes the memory that a worker reuses from rock to rock; nothing in it may show in a journey.
    /// The iteration ends early when [`Self::stop_flag`] is set, and after the first chunk with an error: of
    /// several, the error of the smallest release number is given. A panic in `fall` goes through to the caller.
    pub fn in_chunks<S, I, F>(
        &self,
        releases: Range<usize>,
        scratch: I,
        fall: F,
    ) -> Chunks<'_, I, F>
    where
        I: Fn() -> S + Sync,
        F: Fn(usize, &mut S) -> Result<Trajectory> + Sync,
    {
        Chunks { ensemble: self, next: FEWEST_PER_THREAD * self.threads(), releases, scratch, fall }
    }
}

/// The chunks still to come; made by [`Ensemble::in_chunks`].
#[derive(Debug)]
pub struct Chunks<'a, I, F> {
    ensemble: &'a Ensemble,
    releases: Range<usize>,
    next: usize,
    scratch: I,
    fall: F,
}

impl<S, I, F> Iterator for Chunks<'_, I, F>
where
    I: Fn() -> S + Sync,
    F: Fn(usize, &mut S) -> Result<Trajectory> + Sync,
{
    type Item = Result<Vec<Trajectory>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.releases.is_empty() || self.ensemble.stop.load(Ordering::Relaxed) {
            return None;
        }
        let start = self.releases.start;
        let chunk = start..self.releases.end.min(start + self.next);
        self.releases.start = chunk.end;
        let begun = Instant::now();
        let falls = self.compute(chunk);
        match &falls {
            Ok(falls) => {
                self.next = next_len(
                    falls.len(),
                    begun.elapsed(),
                    bytes_of(falls),
                    self.ensemble.threads(),
                );
            }
            Err(_) => self.releases.start = self.releases.end,
        }
        Some(falls)
    }
}

impl<S, I, F> Chunks<'_, I, F>
where
    I: Fn() -> S + Sync,
    F: Fn(usize, &mut S) -> Result<Trajectory> + Sync,
{
    fn compute(&self, chunk: Range<usize>) -> Result<Vec<Trajectory>> {
        let pieces = PIECES_PER_THREAD * self.ensemble.threads();
        let piece = (chunk.len() / pieces).clamp(1, LARGEST_PIECE);
        let falls: Vec<Result<Trajectory>> = self.ensemble.pool.install(|| {
            chunk
                .into_par_iter()
                .with_max_len(piece)
                .map_init(&self.scratch, |scratch, index| (self.fall)(index, scratch))
                .collect()
        });
        // Collected in order and only then searched for an error: a parallel search would give any of them.
        falls.into_iter().collect()
    }
}

/// Length of the chunk after one of `last` rocks: towards [`CHUNK_TIME`], at most [`GROWTH`] times as long, never
/// above [`CHUNK_BYTES`] unless one rock for each thread takes more.
fn next_len(last: usize, took: Duration, bytes: usize, threads: usize) -> usize {
    let by_time = last as f64 * CHUNK_TIME.as_secs_f64() / took.as_secs_f64().max(1e-9);
    let by_memory = last * CHUNK_BYTES / bytes.max(1);
    (by_time as usize)
        .min(GROWTH * last)
        .max(FEWEST_PER_THREAD * threads)
        .min(by_memory)
        .max(threads)
}

/// Memory of the journeys (bytes).
fn bytes_of(falls: &[Trajectory]) -> usize {
    let kept = |fall: &Trajectory| {
        size_of::<Trajectory>()
            + size_of_val::<[PathPoint]>(&fall.path)
            + size_of_val::<[Impact]>(&fall.impacts)
            + size_of_val::<[Crossing]>(&fall.crossings)
            + size_of_val::<[CellPassage]>(&fall.passages)
            + size_of_val::<[Stretch]>(&fall.stretches)
    };
    falls.iter().map(kept).sum()
}

#[cfg(test)]
mod tests {
    use super::{CHUNK_BYTES, next_len};
    use std::time::Duration;

    /// Rocks of 1 ms and 1 kB on two threads: 16, 128, … up to two seconds' worth, and there it stays.
    #[test]
    fn chunks_grow_until_they_take_their_time() {
        let mut lens = vec![16];
        while lens.len() < 6 {
            let last = lens[lens.len() - 1];
            lens.push(next_len(last, Duration::from_millis(last as u64), 1000 * last, 2));
        }
        assert_eq!(lens, [16, 128, 1024, 2000, 2000, 2000]);
    }

    /// Slow rocks: not fewer than keep the threads busy. Heavy rocks: not more than fit, but one a thread.
    #[test]
    fn chunks_keep_threads_busy_and_fit_in_memory() {
        assert_eq!(next_len(1000, Duration::from_secs(1000), 1000, 2), 16);
        assert_eq!(next_len(100, Duration::from_secs(1), 2 * CHUNK_BYTES, 2), 50);
        assert_eq!(next_len(2, Duration::from_secs(1), 8 * CHUNK_BYTES, 2), 2);
    }
}
