//! What a calibration found: every trial as a row, the result as JSON.

use super::atomic_file::{read_json, write_json};
use crate::calibrate::{Calibration, CalibrationTrial, Ends};
use crate::error::{Error, Result};
use crate::file::write_atomic;
use std::fmt::Write as _;
use std::path::Path;

const RESULT: &str = "calibration.json";

/// Writes `calibration.csv` (every trial with the part that was held out, what it was for and its releases; energy distances where fits are
/// scored by them) and `calibration.json`.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write_calibration(
    dir: &Path,
    found: &Calibration,
    trials: &[(Ends, CalibrationTrial)],
) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    let mut text = format!(
        "held_out,{},fit_area_m,fit_ks,fit_mean_m,apart_area_m,apart_ks,apart_mean_m{},stage,releases\n",
        found.names.join(","),
        if found.whole.all.ends_m.is_some() { ",fit_ends_m,apart_ends_m" } else { "" }
    );
    for (ends, trial) in trials {
        let held_out = match ends {
            Ends::Without(part) | Ends::Only(part) => (part + 1).to_string(),
            Ends::All => "none".to_owned(),
        };
        let values: Vec<String> = trial.values.iter().map(f64::to_string).collect();
        let (fit, apart) = (&trial.fitted, &trial.kept_apart);
        // writing to a string cannot fail
        let _ = write!(
            text,
            "{},{},{},{},{},{},{},{}",
            held_out,
            values.join(","),
            fit.area_m,
            fit.ks,
            fit.computed_mean_m,
            apart.area_m,
            apart.ks,
            apart.computed_mean_m
        );
        for ends_m in [fit.ends_m, apart.ends_m].into_iter().flatten() {
            let _ = write!(text, ",{ends_m}");
        }
        // writing to a string cannot fail
        let _ = writeln!(text, ",{},{}", trial.stage.name(), trial.releases);
    }
    write_atomic(&dir.join("calibration.csv"), text.as_bytes())?;
    write_json(&dir.join(RESULT), found)
}

/// Reads `calibration.json` back; none if there is none.
///
/// # Errors
/// A file that is not as it was written.
pub fn read_calibration(dir: &Path) -> Result<Option<Calibration>> {
    read_json(&dir.join(RESULT))
}
