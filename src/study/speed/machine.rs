//! What a measurement was taken on and with, and clocks that a busy machine does not disturb.
//!
//! Read from the system's own files (Linux); elsewhere they are not there, and what is printed says so.

use std::fs;
use std::io::Read as _;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// What a measurement was taken on and with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Machine {
    /// Name of the processor.
    pub processor: String,
    /// Cores that may be used.
    pub cores: usize,
    /// Operating system and its version.
    pub system: String,
    /// The compiler that made this program.
    pub compiler: String,
    /// Version of this crate, and the commit where it is known.
    pub version: String,
}

impl Machine {
    /// This machine and this program; `source` is the folder of its source code, if it was compiled from there.
    pub fn here(source: Option<&Path>) -> Self {
        let commit = source.and_then(commit);
        let version = env!("CARGO_PKG_VERSION");
        Self {
            processor: processor().unwrap_or_else(|| "not told".to_owned()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            system: system(),
            compiler: compiler().unwrap_or_else(|| "not told by the program".to_owned()),
            version: commit
                .map_or_else(|| version.to_owned(), |commit| format!("{version}, commit {commit}")),
        }
    }
}

fn processor() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

fn system() -> String {
    let version = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    format!("{} {} {}", std::env::consts::OS, version.trim(), std::env::consts::ARCH)
}

/// What a compiler writes into every program, in front of its version.
const MARK: &[u8] = b"rustc version ";

/// The compiler's version as it stands in this very program.
fn compiler() -> Option<String> {
    let mut program = Vec::new();
    fs::File::open(std::env::current_exe().ok()?).ok()?.read_to_end(&mut program).ok()?;
    // The mark itself stands among our constants: what follows there is no number.
    let found = program
        .windows(MARK.len() + 1)
        .position(|window| window.starts_with(MARK) && window[MARK.len()].is_ascii_digit())?;
    let rest = &program[found + MARK.len()..];
    let end = rest.iter().position(|&byte| byte == b')' || byte == 0)?;
    let version = String::from_utf8_lossy(&rest[..end]);
    let closing = if version.contains('(') { ")" } else { "" };
    Some(format!("rustc {version}{closing}"))
}

/// Name of the commit that a folder of source code stands at, with a mark if something in `src` differs from it.
fn commit(source: &Path) -> Option<String> {
    let git = |args: &[&str]| {
        let said = Command::new("git").arg("-C").arg(source).args(args).output().ok()?;
        said.status.success().then(|| String::from_utf8_lossy(&said.stdout).trim().to_owned())
    };
    let name = git(&["rev-parse", "--short=10", "HEAD"])?;
    let changed = git(&["status", "--porcelain", "--", "src", "Cargo.lock"])?;
    Some(if changed.is_empty() { name } else { format!("{name} with changes") })
}

/// Number behind a key of a status file of the system (bytes).
pub(in crate::study) fn status_bytes(file: &str, key: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes << 10)
}

/// The most memory that a process has held so far (bytes).
pub(super) fn peak_bytes(process: u32) -> Option<u64> {
    status_bytes(&format!("/proc/{process}/status"), "VmHWM:")
}

/// Time that threads computed and that they waited for a core that others had (s).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::study) struct Busy {
    pub(in crate::study) computed_s: f64,
    pub(in crate::study) waited_s: f64,
}

impl Busy {
    fn read(file: &Path) -> Option<Self> {
        let text = fs::read_to_string(file).ok()?;
        let mut numbers = text.split_whitespace().map(str::parse::<u64>);
        let mut seconds = || Some(numbers.next()?.ok()? as f64 * 1e-9);
        Some(Self { computed_s: seconds()?, waited_s: seconds()? })
    }

    /// Of all threads of this program so far.
    pub(in crate::study) fn of_all_threads() -> Option<Self> {
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
pub(in crate::study) struct OwnTime {
    computed_s: Option<f64>,
    begun: Instant,
}

impl OwnTime {
    pub(in crate::study) fn begin() -> Self {
        Self { computed_s: own_seconds(), begun: Instant::now() }
    }

    /// Time since the beginning (s).
    pub(in crate::study) fn seconds(&self) -> f64 {
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

    #[test]
    #[cfg(target_os = "linux")]
    fn a_program_knows_its_compiler() {
        let words = compiler().unwrap();
        assert!(words.starts_with("rustc 1.") && words.ends_with(')'), "{words}");
    }

    /// Sleeping takes no time of one's own.
    #[test]
    #[cfg(target_os = "linux")]
    fn own_time_stands_still_in_sleep() {
        let clock = OwnTime::begin();
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
