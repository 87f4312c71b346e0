//! The first releases, tried out before a run.

use super::{Releases, Where};
use crate::error::Result;
use crate::terrain::Terrain;

/// Releases tried out.
pub(crate) const TRIED: usize = 1000;

impl Releases {
    /// Tries the first releases out before a run: says which share of the zone has no ground or no room.
    ///
    /// # Errors
    /// If none of them can be made.
    pub fn try_out(&self, terrain: &Terrain, warnings: &mut Vec<String>) -> Result<()> {
        let (mut places, mut made, mut first) = (0, 0, None);
        for index in 0..TRIED {
            let (release, drawn) = self.place_rock(terrain, index);
            places += drawn;
            match release {
                Ok(_) => made += 1,
                Err(lost) => _ = first.get_or_insert(lost),
            }
        }
        let Some(lost) = first.filter(|_| made == 0) else {
            warnings.extend(self.lost_places((places, made)));
            return Ok(());
        };
        Err(lost.error)
    }

    /// What to say of places drawn in vain, and of releases that found none.
    fn lost_places(&self, (places, made): (usize, usize)) -> Vec<String> {
        let mut warnings = Vec::new();
        let in_vain = places - made;
        if in_vain > 0 && !self.places.iter().all(|place| matches!(place, Where::Points(_))) {
            warnings.push(format!(
                "{:.1} % of the places drawn for {TRIED} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain): such a place is drawn again",
                100.0 * in_vain as f64 / places as f64
            ));
        }
        if made < TRIED {
            warnings.push(format!(
                "{} of {TRIED} releases tried out find no place to start from: each has a row with the stop reason not_released and counts in no statistic",
                TRIED - made
            ));
        }
        warnings
    }
}
