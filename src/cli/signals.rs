//! The signals that end a run in good order.

use super::INTERRUPTED;
use crate::error::{Error, Result};
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Ctrl-C or SIGTERM raises the flag: the chunk being computed is finished and written before the run ends.
/// A second signal ends at once: files on the disk are valid whenever a run is cut off.
pub(super) fn stop_at(flag: &Arc<AtomicBool>) -> Result<()> {
    for signal in signals() {
        // in this order: the first signal finds the flag down
        signal_hook::flag::register_conditional_shutdown(signal, INTERRUPTED.into(), flag.clone())
            .and_then(|_| signal_hook::flag::register(signal, flag.clone()))
            .map_err(|error| Error::Request(format!("cannot watch for Ctrl-C: {error}")))?;
    }
    Ok(())
}

/// A file that grows beyond the limit of its user is then an error like a full disk, and not the end of the program.
pub(super) fn outlive_file_limits() {
    #[cfg(unix)]
    {
        // without it the program ends without a word, no worse than before
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
    }
}

/// The signals that end a run in good order.
fn signals() -> Vec<i32> {
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    if is_hang_up_heard() {
        signals.push(signal_hook::consts::SIGHUP);
    }
    signals
}

/// Whether a hang-up is not ignored, as `nohup` has it. Where the system does not tell, it is left as it was: what a run
/// has on the disk is good whenever it is cut off.
#[cfg(unix)]
fn is_hang_up_heard() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask & 1 == 0)
}
