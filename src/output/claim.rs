//! One process at a time writes into a result folder.

use crate::error::{Error, Result};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::Path;

/// Name of the empty file that is locked. It stays: whoever removed it could take it from under another process.
const LOCK: &str = ".lock";

/// The right to write into a folder, until it is dropped or the process ends, however it ends.
#[derive(Debug)]
pub struct Claim {
    /// Closing it gives the folder free.
    _lock: Option<File>,
}

impl Claim {
    /// Takes the folder `dir`, which is made if it is not there.
    ///
    /// A file system that cannot lock (some network disks) is used without: the user then has to take care.
    ///
    /// # Errors
    /// If another process has it, or it cannot be written.
    pub fn on(dir: &Path) -> Result<Self> {
        fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
        let path = dir.join(LOCK);
        let file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(Error::file("create", &path))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _lock: Some(file) }),
            Err(TryLockError::WouldBlock) => Err(Error::Request(format!(
                "{}: another process is writing into this folder; wait for its end or take another --out",
                dir.display()
            ))),
            Err(TryLockError::Error(why)) if why.kind() == ErrorKind::Unsupported => {
                Ok(Self { _lock: None })
            }
            Err(TryLockError::Error(why)) => Err(Error::file("lock", &path)(why)),
        }
    }
}
