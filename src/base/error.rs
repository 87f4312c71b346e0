//! The one error type. An error is always the user's: it says where, what was found and what to write instead.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What may be wrong with the user's input or the file system.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value, key, triangle or line that cannot be used.
    #[error("{file}: {place}: {found}; {remedy}", file = .file.display())]
    Input {
        /// The file that holds it.
        file: PathBuf,
        /// Key, line or triangle.
        place: String,
        /// What was found there.
        found: String,
        /// What to write instead.
        remedy: String,
    },
    /// A file that cannot be read or written.
    #[error("{file}: cannot {action}: {source}; {remedy}", file = .file.display(), remedy = remedy(.source.kind()))]
    File {
        /// The file.
        file: PathBuf,
        /// "read", "create", "write" …
        action: &'static str,
        /// The system's answer.
        source: std::io::Error,
    },
    /// A request that does not fit together (command line, result folder).
    #[error("{0}")]
    Request(String),
}

/// What to do about the system's answer.
fn remedy(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::NotFound => "write a path that is there",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "write a path that you may use, or take the right to use this one"
        }
        ErrorKind::IsADirectory => "this is a folder: write the path of a file",
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "a file stands where a folder should be: write another path"
        }
        kind if is_full(kind) => "make room, or write a path on another disk",
        ErrorKind::InvalidData => "write the path of a text file in UTF-8",
        _ => "check the disk, or write another path",
    }
}

/// Whether the system has no more room.
fn is_full(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge)
}

/// What is wrong with a value and what to write instead: an [`Error::Input`] that does not yet know its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{found}; {remedy}")]
pub struct Flaw {
    /// What was found.
    pub found: String,
    /// What to write instead.
    pub remedy: String,
}

impl Flaw {
    /// Both halves.
    pub fn new(found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { found: found.into(), remedy: remedy.into() }
    }
}

/// What a file holds, as it can stand in a message of one line: a key with a line break would part it in two.
fn one_line(text: &str) -> String {
    let escaped =
        |c: char| if c.is_control() { c.escape_default().collect() } else { c.to_string() };
    text.chars().map(escaped).collect()
}

impl Error {
    /// A value that cannot be used, with the place and the remedy.
    pub fn input(
        file: &Path,
        place: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Input {
            file: file.to_owned(),
            place: one_line(&place.into()),
            found: one_line(&found.into()),
            remedy: remedy.into(),
        }
    }

    /// The same, where a command goes on in its own way once a full disk has room again.
    #[must_use]
    pub fn on_full_disk(self, remedy: &str) -> Self {
        match self {
            Self::File { file, action, source } if is_full(source.kind()) => {
                let file = file.display();
                let another = "or write a path on another disk";
                Self::Request(format!("{file}: cannot {action}: {source}; {remedy}, {another}"))
            }
            other => other,
        }
    }

    /// Turns a system error into one that names the file: `.map_err(Error::file("read", path))`.
    pub fn file(action: &'static str, file: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let file = file.to_owned();
        move |source| Self::File { file, action, source }
    }
}

/// Shorthand for results of this crate.
pub type Result<T> = std::result::Result<T, Error>;
