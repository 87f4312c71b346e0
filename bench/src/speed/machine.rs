//! What a measurement was taken on and with.
//!
//! Read from the system's own files (Linux); elsewhere they are not there, and what is printed says so.

use std::fs;
use std::io::Read as _;
use std::path::Path;
use std::process::Command;

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
pub(crate) fn status_bytes(file: &str, key: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes << 10)
}

/// The most memory that a process has held so far (bytes).
pub(crate) fn peak_bytes(process: u32) -> Option<u64> {
    status_bytes(&format!("/proc/{process}/status"), "VmHWM:")
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
}
