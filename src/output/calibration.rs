//! What a calibration found: every trial as a row, the result as JSON.

use super::whole::{read_json, write_json, write_whole};
use crate::calibrate::{Calibration, Trial};
use crate::error::{Error, Result};
use std::fmt::Write as _;
use std::path::Path;

const RESULT: &str = "calibration.json";

/// Writes `calibration.csv` (every trial with its half) and `calibration.json`.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write_calibration(dir: &Path, found: &Calibration, trials: &[(usize, Trial)]) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    let mut text = format!(
        "half,{},fit_area_m,fit_ks,fit_mean_m,apart_area_m,apart_ks,apart_mean_m\n",
        found.names.join(",")
    );
    for (half, trial) in trials {
        let values: Vec<String> = trial.values.iter().map(f64::to_string).collect();
        let (fit, apart) = (&trial.fitted, &trial.kept_apart);
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{}",
            half + 1,
            values.join(","),
            fit.area_m,
            fit.ks,
            fit.computed_mean_m,
            apart.area_m,
            apart.ks,
            apart.computed_mean_m
        );
    }
    write_whole(&dir.join("calibration.csv"), text.as_bytes())?;
    write_json(&dir.join(RESULT), found)
}

/// Reads `calibration.json` back; none if there is none.
///
/// # Errors
/// A file that is not as it was written.
pub fn read_calibration(dir: &Path) -> Result<Option<Calibration>> {
    read_json(&dir.join(RESULT))
}
