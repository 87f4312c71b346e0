//! One process at a time writes into a result folder, and what comes to nothing leaves nothing behind.

use crate::error::{Error, Result};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

/// Name of the empty file that is locked. Beside results it stays: whoever removed it could take it from under another
/// process.
const LOCK: &str = ".lock";

/// The right to write into a folder, until it is dropped or the process ends, however it ends.
///
/// Until `keep` is called nothing in the folder is worth keeping: dropped before, the lock removes what it and
/// `made` made, and nothing else.
#[derive(Debug)]
pub struct FolderLock {
    /// Closing it gives the folder free.
    file: Option<File>,
    /// What is removed if nothing comes of it, the last first.
    made: Vec<PathBuf>,
}

/// How often a lock that is held is asked for again, and after how long.
const TRIES: u32 = 10;
const WAIT: Duration = Duration::from_millis(20);

/// Tries to lock for a fifth of a second: a process that another thread has just begun holds what its parent held until it is a program
/// of its own, and a lock that nobody wants any more is still there for that instant.
fn patiently(
    lock: impl Fn() -> std::result::Result<(), TryLockError>,
) -> std::result::Result<(), TryLockError> {
    for _ in 1..TRIES {
        match lock() {
            Err(TryLockError::WouldBlock) => thread::sleep(WAIT),
            done => return done,
        }
    }
    lock()
}

impl FolderLock {
    /// Takes the folder `dir`, which is made if it is not there.
    ///
    /// A file system that cannot lock (some network disks) is used without: the user then has to take care.
    ///
    /// # Errors
    /// If another process has it, or it cannot be written.
    pub fn on(dir: &Path) -> Result<Self> {
        let mut lock = Self { file: None, made: missing(dir) };
        fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
        let path = dir.join(LOCK);
        if !path.exists() {
            lock.made.push(path.clone());
        }
        let file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(Error::file("create", &path))?;
        let taken = || {
            Err(Error::Request(format!(
                "{}: another process is writing into this folder; wait for its end or take another --out",
                dir.display()
            )))
        };
        match patiently(|| file.try_lock()) {
            // the process that had it may have removed it meanwhile: then this is no lock any more
            Ok(()) if is_there(&file, &path) => lock.file = Some(file),
            Ok(()) => return taken(),
            Err(TryLockError::WouldBlock) => {
                lock.keep();
                return taken();
            }
            Err(TryLockError::Error(why)) if why.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(why)) => return Err(Error::file("lock", &path)(why)),
        }
        Ok(lock)
    }

    /// A file or folder that the lock answers for.
    pub(super) fn made(&mut self, path: PathBuf) {
        self.made.push(path);
    }

    /// From now on there are results.
    pub(super) fn keep(&mut self) {
        self.made.clear();
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        for path in self.made.drain(..).rev() {
            // a folder goes only when it is empty; that something cannot be removed would add nothing
            let _ = if path.is_dir() { fs::remove_dir(&path) } else { fs::remove_file(&path) };
        }
    }
}

/// The folders that must be made for `dir` to be there, the outermost first.
fn missing(dir: &Path) -> Vec<PathBuf> {
    let mut missing: Vec<PathBuf> = dir
        .ancestors()
        .take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists())
        .map(Path::to_owned)
        .collect();
    missing.reverse();
    missing
}

/// Whether the name still belongs to the open file.
#[cfg(unix)]
fn is_there(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |about: fs::Metadata| (about.dev(), about.ino());
    let (own, named) = (file.metadata().map(number), fs::metadata(path).map(number));
    matches!((own, named), (Ok(own), Ok(named)) if own == named)
}

/// Elsewhere an open file cannot be removed.
#[cfg(not(unix))]
fn is_there(_: &File, _: &Path) -> bool {
    true
}
