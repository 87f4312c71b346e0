//! What may be wrong with the files beside a scene.

use super::check::Complaint;
use crate::error::Error;

/// Why files cannot be taken: a key of the scene is wrong, or a file itself.
#[derive(Debug)]
pub(super) enum Refusal {
    Key(Box<Complaint>),
    File(Error),
}

impl From<Complaint> for Refusal {
    fn from(complaint: Complaint) -> Self {
        Self::Key(Box::new(complaint))
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::File(error)
    }
}

impl Refusal {
    /// The same, seen from an entry of a list.
    pub(super) fn in_entry(self, index: usize, table: &str) -> Self {
        match self {
            Self::Key(complaint) => complaint.in_entry(index).inside(table).into(),
            file @ Self::File(_) => file,
        }
    }
}
