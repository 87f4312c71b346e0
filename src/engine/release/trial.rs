//! Trial releases before a run.

use super::{Frequency, PlacementAttempt, Release, ReleasePlace, Releases};
use crate::error::{Error, Result};
use crate::terrain::Terrain;

/// Number of trial releases.
const TRIAL_RELEASES: usize = 1000;
/// Trial releases of a source before it is refused: large rocks may find no room where smaller ones
/// do.
const MIN_TRIALS_OF_SOURCE: usize = 20;

/// A rock lifted by less than this, over its radius, is not reported (–).
const REPORTED_LIFT: f64 = 0.1;

/// A centre higher above the ground than this (m) indicates another height datum than that of the
/// slope, or a place beside a cliff.
const FAR_ABOVE_M: f64 = 100.0;

/// Result of the trial releases.
#[derive(Debug)]
pub struct TrialReleases {
    /// Those that could be made.
    pub made: Vec<Release>,
    /// How many are lifted off steep ground, and by how much, in words; `None` if none is lifted by
    /// a tenth of its radius.
    pub lifted: Option<String>,
}

impl Releases {
    /// Tries the first releases before a run, and warns which share of the zone has no ground or no
    /// room.
    ///
    /// # Errors
    /// If none of them can be made, or none of a source that has a frequency: its events would be
    /// missing.
    pub fn try_out(&self, terrain: &Terrain, warnings: &mut Vec<String>) -> Result<TrialReleases> {
        let (mut places, mut in_slope, mut made, mut first) = (0, 0, Vec::new(), None);
        let mut lifts_m = Vec::new();
        let sources = self.frequency.as_ref().map_or(&[][..], |frequency| frequency.sources());
        let mut of_source = vec![[0; 2]; sources.len()];
        for index in 0..TRIAL_RELEASES {
            let PlacementAttempt { release, drawn, steep, lift_m } =
                self.place_rock(terrain, index);
            (places, in_slope) = (places + drawn, in_slope + steep);
            if let Some(frequency) = &self.frequency {
                let [tried, released] = &mut of_source[frequency.stratum(index).source];
                (*tried, *released) = (*tried + 1, *released + usize::from(release.is_ok()));
            }
            match release {
                Ok(release) => {
                    let is_lifted = lift_m > REPORTED_LIFT * release.rock.radius_m;
                    lifts_m.extend(is_lifted.then_some(lift_m));
                    made.push(release);
                }
                Err(lost) => _ = first.get_or_insert(lost),
            }
        }
        if let (true, Some(lost)) = (made.is_empty(), first) {
            return Err(lost.error);
        }
        self.check_sources(&of_source)?;
        warnings.extend(self.lost_places((places, in_slope), made.len()));
        warnings.extend(far_above(&made, terrain));
        let largest_m = lifts_m.iter().copied().reduce(f64::max);
        let lifted = largest_m.map(|largest_m| {
            format!(
                "{} of {TRIAL_RELEASES} releases tried out, over steep ground, by more than a tenth of their radius and up to {largest_m:.2} m, until they just touch: they fall from higher than height_m says",
                lifts_m.len()
            )
        });
        Ok(TrialReleases { made, lifted })
    }

    /// Refuses a source of which no trial release could be made; `of_source`: how many were tried,
    /// and how many made.
    fn check_sources(&self, of_source: &[[usize; 2]]) -> Result<()> {
        let sources = self.frequency.iter().flat_map(Frequency::sources);
        let has_no_release =
            |&[tried, released]: &[usize; 2]| tried >= MIN_TRIALS_OF_SOURCE && released == 0;
        let failed = sources.zip(of_source).find(|(_, counts)| has_no_release(counts));
        failed.map_or(Ok(()), |(source, [tried, _])| {
            let found = format!(
                "none of its {tried} releases tried out finds a place to start from: its {} events a year would be in no number",
                source.law.per_year()
            );
            let remedy = "move it to where rocks have room, or write a larger height_m";
            let place = format!("[frequency] source \"{}\"", source.name);
            Err(Error::input(&self.file, place, found, remedy))
        })
    }

    /// Whether all places are given points, and none is drawn.
    pub(crate) fn are_points(&self) -> bool {
        self.places.iter().all(|place| matches!(place, ReleasePlace::Points(_)))
    }

    /// Warnings about places drawn in vain, and about releases that found none.
    fn lost_places(&self, (places, in_slope): (usize, usize), made: usize) -> Vec<String> {
        let mut warnings = Vec::new();
        let in_vain = places - made;
        if in_vain > 0 && !self.are_points() {
            let percent = |count: usize| format!("{:.1} %", 100.0 * count as f64 / places as f64);
            let steep = if in_slope > 0 {
                format!("; {} on ground so steep that no height is clear of it", percent(in_slope))
            } else {
                String::new()
            };
            warnings.push(format!(
                "{} of the places drawn for {TRIAL_RELEASES} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain{steep}): such a place is drawn again",
                percent(in_vain)
            ));
        }
        if made < TRIAL_RELEASES {
            warnings.push(format!(
                "{} of {TRIAL_RELEASES} releases tried out find no place to start from: each has a row with the stop reason not_released and counts in no statistic",
                TRIAL_RELEASES - made
            ));
        }
        warnings
    }
}

/// Warning if most releases start far above the ground: a slope with another height datum, or with
/// negated heights, is not met properly by any rock.
fn far_above(made: &[Release], terrain: &Terrain) -> Option<String> {
    let above_m = |release: &Release| {
        let centre = release.motion.position_m;
        Some(centre.z - terrain.ground_under(centre.x, centre.y, centre.z)?)
    };
    let far = made.iter().filter_map(above_m).filter(|height_m| *height_m > FAR_ABOVE_M);
    let (count, most_m) =
        far.fold((0, 0.0), |(count, most): (usize, f64), height_m| (count + 1, most.max(height_m)));
    (2 * count > made.len()).then(|| {
        format!(
            "{count} of {} releases tried out start more than {FAR_ABOVE_M:.0} m above the ground, up to {most_m:.0} m: do the heights of the releases and of the slope belong together, with their sign?",
            made.len()
        )
    })
}
