//! The first releases, tried out before a run.

use super::{Frequency, Release, Releases, Where};
use crate::error::{Error, Result};
use crate::terrain::Terrain;

/// Releases tried out.
const TRIED: usize = 1000;
/// Releases of a source that must be tried before it is refused: large rocks may find no room where smaller ones do.
const FEWEST_OF_SOURCE: usize = 20;

impl Releases {
    /// Tries the first releases out before a run: says which share of the zone has no ground or no room. Those that were made.
    ///
    /// # Errors
    /// If none of them can be made, or none of a source that has a frequency: its events would be missing.
    pub fn try_out(&self, terrain: &Terrain, warnings: &mut Vec<String>) -> Result<Vec<Release>> {
        let (mut places, mut made, mut first) = (0, Vec::new(), None);
        let sources = self.frequency.as_ref().map_or(&[][..], |frequency| frequency.sources());
        let mut of_source = vec![[0; 2]; sources.len()];
        for index in 0..TRIED {
            let (release, drawn) = self.place_rock(terrain, index);
            places += drawn;
            if let Some(frequency) = &self.frequency {
                let [tried, released] = &mut of_source[frequency.stratum(index).source];
                (*tried, *released) = (*tried + 1, *released + usize::from(release.is_ok()));
            }
            match release {
                Ok(release) => made.push(release),
                Err(lost) => _ = first.get_or_insert(lost),
            }
        }
        if let (true, Some(lost)) = (made.is_empty(), first) {
            return Err(lost.error);
        }
        self.check_sources(&of_source)?;
        warnings.extend(self.lost_places((places, made.len())));
        Ok(made)
    }

    /// Refuses a source of which no release tried out could be made; `of_source`: how many were tried, and how many made.
    fn check_sources(&self, of_source: &[[usize; 2]]) -> Result<()> {
        let sources = self.frequency.iter().flat_map(Frequency::sources);
        let is_silent =
            |&[tried, released]: &[usize; 2]| tried >= FEWEST_OF_SOURCE && released == 0;
        let silent = sources.zip(of_source).find(|(_, counts)| is_silent(counts));
        silent.map_or(Ok(()), |(source, [tried, _])| {
            let found = format!(
                "none of its {tried} releases tried out finds a place to start from: its {} events a year would be in no number",
                source.law.per_year()
            );
            let remedy = "move it to where rocks have room, or write a larger height_m";
            let place = format!("[frequency] source \"{}\"", source.name);
            Err(Error::input(&self.file, place, found, remedy))
        })
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
