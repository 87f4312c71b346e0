//! Measured ends and calibration, gathered from summary, releases and `calibration.json`.

use super::super::model::{About, Estimate, Observed, Table};
use super::estimate;
use crate::calibrate::{Calibration, Measure, Told, Trial};
use crate::error::Result;
use crate::hazard::{Agreement, Way};
use crate::output::{Results, read_calibration};

/// Columns of both tables.
const COLUMNS: [&str; 7] = [
    "mean runout measured (m)",
    "computed (m)",
    "KS distance",
    "KS limit",
    "area between (m)",
    "side measured (m)",
    "side computed (m)",
];

/// Measured and computed ways, if the scene names measured ones.
pub(super) fn observed(results: &Results) -> Result<Option<Observed>> {
    let measured = results.summary.observed.clone();
    if measured.is_empty() {
        return Ok(None);
    }
    let mut computed = Vec::new();
    for row in results.rows()? {
        computed.extend(Way::of(&row?));
    }
    let agreement = Agreement::of(&measured, &computed);
    Ok(agreement.map(|agreement| Observed { measured, computed, agreement }))
}

/// How well this run and the calibration agree with what was measured.
pub(super) fn tables(results: &Results) -> Result<Vec<Table>> {
    let mut tables = Vec::new();
    if let Some(observed) = observed(results)? {
        tables.push(Table {
            about: About::Measured,
            title: "Agreement with measured ends".to_owned(),
            note: format!(
                "{} measured and {} computed rocks. KS: largest difference of the two distributions of runout; equal ones \
                 exceed the limit in 5 % of all samples. Side scatter: standard deviation across the mean measured direction.",
                observed.agreement.measured, observed.agreement.computed
            ),
            columns: COLUMNS.map(str::to_owned).into(),
            rows: vec![("This run".to_owned(), cells(&observed.agreement))],
        });
    }
    if let Some(found) = read_calibration(&results.dir)? {
        tables.push(calibration(&found));
        if !found.told.is_empty() {
            tables.extend([told(&found), spread(&found)]);
        }
    }
    Ok(tables)
}

fn calibration(found: &Calibration) -> Table {
    let row = |who: &str, trial: &Trial, of: &Agreement| {
        let values = found.names.iter().zip(&trial.values);
        let values: Vec<String> =
            values.map(|(name, value)| format!("{name} = {value:.3}")).collect();
        (format!("{who}: {}", values.join(", ")), cells(of))
    };
    let (first, second) = (&found.first, &found.second);
    Table {
        about: About::Measured,
        title: "Calibration and what it is worth".to_owned(),
        note: format!(
            "{} trials of {} releases on each half of the measured rocks; a value counts only on the half that it was not fitted to.",
            found.trials, found.releases
        ),
        columns: COLUMNS.map(str::to_owned).into(),
        rows: vec![
            row("Uncalibrated, all rocks", &found.before, &found.before.all),
            row("Fitted on the first half, seen on it", first, &first.fitted),
            row("The same on the held-out half", first, &first.kept_apart),
            row("Fitted on the second half, seen on it", second, &second.fitted),
            row("The same on the held-out half", second, &second.kept_apart),
        ]
        .into_iter()
        .chain(found.whole.as_ref().map(|whole| row("Fitted on all", whole, &whole.all)))
        .collect(),
    }
}

/// How far the measured ends tell each value.
fn told(found: &Calibration) -> Table {
    let row = |told: &Told| {
        let doubt = if told.is_told { "" } else { " (hardly told: other values fit as well)" };
        let value = estimate(told.value, Some(told.low_95), Some(told.high_95));
        (format!("{}{doubt}", told.name), vec![Some(value)])
    };
    Table {
        about: About::Measured,
        title: "What the measured ends tell".to_owned(),
        note: format!(
            "Values fitted on all {} measured ends, with 95 % intervals from ends drawn again; throws of one block are alike, so that they are worth {:.0} independent ones.",
            found.ends.0, found.ends.1
        ),
        columns: vec!["fitted".to_owned()],
        rows: found.told.iter().map(row).collect(),
    }
}

/// Where the ends of the fit lie and how they spread.
fn spread(found: &Calibration) -> Table {
    let row = |measure: &Measure| {
        let difference = estimate(
            measure.computed - measure.measured,
            Some(measure.low_95),
            Some(measure.high_95),
        );
        let plain = |value: f64| Some(estimate(value, None, None));
        let cells = vec![plain(measure.measured), plain(measure.computed), Some(difference)];
        (format!("{}: {}", measure.scene, measure.what), cells)
    };
    Table {
        about: About::Measured,
        title: "Ends of the fit".to_owned(),
        note: "Computed less measured with its 95 % interval, from measured ends drawn again."
            .to_owned(),
        columns: ["measured", "computed", "difference"].map(str::to_owned).into(),
        rows: found.measures.iter().map(row).collect(),
    }
}

fn cells(of: &Agreement) -> Vec<Option<Estimate>> {
    let numbers = [
        of.measured_mean_m,
        of.computed_mean_m,
        of.ks,
        of.ks_limit,
        of.area_m,
        of.measured_side_m,
        of.computed_side_m,
    ];
    numbers.map(|value| Some(Estimate::plain(value))).into()
}
