//! What may be wrong with the files beside a scene, and what a scene cannot be asked.

use super::Scene;
use super::check::Complaint;
use crate::error::{Error, Result};

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

impl Scene {
    /// Refuses a world of rocks where each would be followed alone: what is then said of them would not be theirs; `does` says who follows them.
    ///
    /// # Errors
    /// The scene's rocks share one world.
    pub fn refuse_world(&self, does: &str) -> Result<()> {
        if !self.release.together {
            return Ok(());
        }
        let remedy = format!(
            "leave it out: {does} follows every rock alone; compare worlds run by run, `rockfall compare`"
        );
        Err(Error::input(&self.file, "[release] together", "found true", remedy))
    }
}
