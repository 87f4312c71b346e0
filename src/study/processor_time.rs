//! Time that the processor gave, which a busy machine does not stretch.
//!
//! Read from the system's own files (Linux); elsewhere a common clock stands in.

use std::fs;
use std::path::Path;
use std::time::Instant;

/// Time that threads computed and that they waited for a core that others had (s).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Busy {
    /// Time computed (s).
    pub computed_s: f64,
    /// Time waited (s).
    pub waited_s: f64,
}

impl Busy {
    fn read(file: &Path) -> Option<Self> {
        let text = fs::read_to_string(file).ok()?;
        let mut numbers = text.split_whitespace().map(str::parse::<u64>);
        let mut seconds = || Some(numbers.next()?.ok()? as f64 * 1e-9);
        Some(Self { computed_s: seconds()?, waited_s: seconds()? })
    }

    /// Of all threads of this program so far.
    pub fn of_all_threads() -> Option<Self> {
        let mut sum = Self::default();
        for thread in fs::read_dir("/proc/self/task").ok()? {
            // a thread may end while the list is read
            let Some(one) = Self::read(&thread.ok()?.path().join("schedstat")) else { continue };
            sum.computed_s += one.computed_s;
            sum.waited_s += one.waited_s;
        }
        Some(sum)
    }
}

/// A clock that runs while this thread computes, and stands still while others have its core; where the system does
/// not tell, a common clock.
#[derive(Debug)]
pub struct ProcessorTime {
    computed_s: Option<f64>,
    begun: Instant,
}

impl ProcessorTime {
    /// Starts now.
    pub fn begin() -> Self {
        Self { computed_s: own_seconds(), begun: Instant::now() }
    }

    /// Time since the beginning (s).
    pub fn seconds(&self) -> f64 {
        self.computed_s
            .zip(own_seconds())
            .map_or_else(|| self.begun.elapsed().as_secs_f64(), |(before, now)| now - before)
    }
}

fn own_seconds() -> Option<f64> {
    // Linux brings this up to date when the thread offers its place to others; else it lags by milliseconds.
    std::thread::yield_now();
    Some(Busy::read(Path::new("/proc/thread-self/schedstat"))?.computed_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sleeping takes no time of one's own.
    #[test]
    #[cfg(target_os = "linux")]
    fn own_time_stands_still_in_sleep() {
        let clock = ProcessorTime::begin();
        std::thread::sleep(std::time::Duration::from_millis(30));
        assert!(clock.seconds() < 0.02, "{}", clock.seconds());
        let mut sum = 0.0_f64;
        let begun = Instant::now();
        while begun.elapsed().as_secs_f64() < 0.05 {
            sum += std::hint::black_box(1.0);
        }
        assert!(sum > 0.0 && clock.seconds() > 0.0);
    }
}
