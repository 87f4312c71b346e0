//! Computed rocks that would have gone on: what they leave open of a fit.
//!
//! Where they would have ended is not known, so how far a trial is from the measured ends lies between two bounds. The trial whose upper bound is
//! least is selected, and all that may be nearer are in the intervals. Where one may be nearer by more than chance makes out, the fit says nothing.

use super::CalibrationTrial;
use super::search::ParameterSearch;
use crate::error::{Error, Result};
use crate::hazard::Agreement;
use crate::math;
use crate::scene::VaryTable;

impl ParameterSearch<'_> {
    /// Refuses a fit where another trial, or the selected one itself, may lie nearer the measured ends than the selected one does at most, by more than the 5 % limit
    /// of their KS distance: then open rocks decide which values fit best, and not the measured ends.
    pub(super) fn refuse_unclear(
        &self,
        selected: &CalibrationTrial,
        unclear: Option<&CalibrationTrial>,
        worth: f64,
    ) -> Result<()> {
        let Some(other) = unclear else { return Ok(()) };
        let (most, least) = (selected.all.ks_at_most(), other.all.ks);
        if most - least <= selected.all.ks_limit_worth(worth) {
            return Ok(());
        }
        let names = self.vary.iter().map(VaryTable::name).zip(&other.values);
        let values: Vec<String> =
            names.map(|(name, value)| format!("{name} = {}", math::rounded(*value, 4))).collect();
        let of = &other.all;
        let found = format!(
            "found that too many computed rocks had not ended to tell which values fit best: with {} {}; as these may have ended anywhere beyond, the KS distance to the measured ends is anything from {:.3} to {:.3}",
            values.join(", "),
            had_not_ended(of),
            of.ks,
            of.ks_at_most(),
        );
        let remedy =
            format!("write {}, or a range (from, to) in vary without such values", remedy(of));
        Err(Error::input(self.sites[0].file(), "[calibrate]", found, remedy))
    }
}

/// What is to be said of a fit some of whose rocks had not ended; nothing where all had.
pub(super) fn warning(of: &Agreement) -> Option<String> {
    let said = format!(
        "in the fit on all {}: mean runouts and shares are at least what is said, KS distances and intervals hold however these rocks would have ended; write {}",
        had_not_ended(of),
        remedy(of)
    );
    (of.open() > 0).then_some(said)
}

/// How many computed rocks had not ended, and why.
fn had_not_ended(of: &Agreement) -> String {
    let share = 100.0 * of.open() as f64 / of.computed.max(1) as f64;
    format!(
        "{} of {} computed rocks ({share:.1} %) had not ended, {} had left the terrain, {} were still moving",
        of.open(),
        of.computed,
        of.left_terrain,
        of.still_moving
    )
}

/// What to write so that they end.
fn remedy(of: &Agreement) -> &'static str {
    match (of.left_terrain, of.still_moving) {
        (_, 0) => "a larger terrain",
        (0, _) => "a longer longest_s",
        _ => "a longer longest_s and a larger terrain",
    }
}
