//! Measured ends and calibration, gathered from summary, releases and `calibration.json`.

use super::super::format;
use super::super::measured::{mean_of, not_compared, not_ended, weighing, worth};
use super::super::model::{About, Estimate, EstimateTable, Is, Observed};
use super::super::words::{Words, fill};
use super::estimate;
use crate::calibrate::{
    Calibration, CalibrationTrial, OwnPlaces, SiteMeasure, ThrownFrom, Told, place_of,
};
use crate::error::Result;
use crate::hazard::{Agreement, EndSpread, ObservedPath};
use crate::math;
use crate::output::{ReleaseZone, Results, read_calibration};

/// Weights that differ by no more (–) are alike.
const SAME_WEIGHT: f64 = 1e-12;

/// Columns of both tables.
fn columns(words: &Words) -> Vec<String> {
    let columns = [
        words.col_mean_measured,
        words.col_computed,
        words.col_ks,
        words.col_ks_limit,
        words.col_area,
        words.col_side_measured,
        words.col_side_computed,
    ];
    columns.map(str::to_owned).into()
}

/// Measured and computed ways, if the scene names measured ones.
pub(super) fn observed(results: &Results) -> Result<Option<Observed>> {
    let measured = results.summary.observed.clone();
    if measured.is_empty() {
        return Ok(None);
    }
    let standing = results.hazard.weights();
    let least_runout_m = results.summary.observed_least_runout_m;
    let (mut computed, mut weights, mut stayed) = (Vec::new(), Vec::new(), 0);
    for row in results.rows()? {
        let row = row?;
        if let Some(way) = ObservedPath::of(&row) {
            if !way.ran(least_runout_m) {
                stayed += 1;
                continue;
            }
            computed.push(way);
            weights.extend(standing.as_ref().map(|all| all.of_release(row.index)));
        }
    }
    let own = own_weights(results, (&measured, &computed), &weights);
    let from_own_places = own.is_some();
    let weights = own.or(standing.is_some().then_some(weights));
    let agreement = match &weights {
        None => Agreement::of(&measured, &computed),
        Some(weights) => {
            let weighted = computed.iter().copied().zip(weights.iter().copied());
            Agreement::of_events(&measured, &weighted.collect::<Vec<_>>())
        }
    };
    Ok(agreement.map(|found| {
        let worth = results.summary.observed_worth.unwrap_or(measured.len() as f64);
        let agreement = Agreement { stayed, ks_limit: found.ks_limit_worth(worth), ..found };
        Observed { measured, computed, weights, from_own_places, worth, agreement }
    }))
}

/// What computed ways weigh beside the measured ones where every one of these was released from a place of the scene: as in a calibration each is compared with
/// the rocks from its own place. None where the scene releases elsewhere; `standing` is what rocks stand for, if they do not all weigh the same.
fn own_weights(
    results: &Results,
    (measured, computed): (&[ObservedPath], &[ObservedPath]),
    standing: &[f64],
) -> Option<Vec<f64>> {
    let mut places: Vec<ThrownFrom> = Vec::new();
    for zone in results.summary.site.zones() {
        let ReleaseZone::Points(points) = zone else { return None };
        places.extend(points.iter().map(|point| (*point, None)));
    }
    let own = OwnPlaces::of(measured, &[], &places)?;
    let weight = |k: usize| standing.get(k).copied().unwrap_or(1.0);
    let ways = computed.iter().enumerate();
    let of_places: Vec<_> =
        ways.map(|(k, way)| (place_of(measured, &way.start_m), weight(k))).collect();
    let rows: Vec<usize> = (0..measured.len()).collect();
    let weights = own.weights(&rows, &of_places);
    // as many ends as rocks everywhere: then rocks compare as they are
    let change = |(k, own): (usize, &f64)| (own / weights[0] - weight(k) / weight(0)).abs();
    let off = weights.iter().enumerate().map(change).fold(0.0, f64::max);
    (off > SAME_WEIGHT || off.is_nan()).then_some(weights)
}

/// What must be known before anything else where the computed ends are not those that were measured, or where that cannot be told, as too many rocks had
/// not ended.
pub(super) fn off(observed: &Observed, words: &Words) -> Option<String> {
    let at = &observed.agreement;
    if at.ks <= at.ks_limit && at.ks_at_most() > at.ks_limit {
        let said = format!(
            "whether the computed ends are distributed like the measured ones cannot be told: {} of {} computed rocks had not ended, and the KS distance is anything from {:.3} to {:.3}, 5 % limit {:.3}. Give a longer [solver] longest_s or terrain that reaches farther",
            at.open(),
            at.computed,
            at.ks,
            at.ks_at_most(),
            at.ks_limit
        );
        return Some(words.say(&said));
    }
    let said = format!(
        "the computed ends are not distributed like the measured ones: KS distance {:.3}, 5 % limit {:.3}. The ground values do not hold for this slope",
        at.ks, at.ks_limit
    );
    (at.ks > at.ks_limit).then(|| words.say(&said))
}

/// How well this run and the calibration agree with what was measured.
pub(super) fn tables(results: &Results, words: &Words) -> Result<Vec<EstimateTable>> {
    let mut tables = Vec::new();
    if let Some(observed) = observed(results)? {
        let agreement = &observed.agreement;
        let note = fill(
            words.agreement_note,
            &[("measured", &agreement.measured), ("computed", &agreement.computed)],
        );
        tables.push(EstimateTable {
            about: About::Measured,
            title: words.agreement_title.to_owned(),
            note: note
                + &worth(&observed, words)
                + &weighing(&observed, words)
                + &not_compared(agreement, words)
                + &not_ended(agreement, words),
            columns: columns(words),
            rows: vec![(words.this_run.to_owned(), known(&observed))],
            ..EstimateTable::default()
        });
    }
    if let Some(found) = read_calibration(&results.dir)? {
        tables.push(calibration(&found, words));
        tables.extend([told(&found, words), spread(&found, words)]);
    }
    Ok(tables)
}

fn calibration(found: &Calibration, words: &Words) -> EstimateTable {
    let row = |who: &str, trial: &CalibrationTrial, of: &Agreement| {
        let values = found.names.iter().zip(&trial.values);
        let values: Vec<String> =
            values.map(|(name, value)| format!("{name} = {value:.3}")).collect();
        (format!("{who}{}{}", words.colon(), values.join(", ")), cells(of, found))
    };
    let mut rows = vec![row(words.uncalibrated, &found.before, &found.before.all)];
    for (part, trial) in found.held_out.iter().enumerate() {
        let part = part + 1;
        let named = |text: &str| fill(text, &[("part", &part)]);
        rows.push(row(&named(words.fitted_without), trial, &trial.fitted));
        rows.push(row(&named(words.held_out), trial, &trial.kept_apart));
    }
    rows.push(row(words.fitted_all, &found.whole, &found.whole.all));
    EstimateTable {
        about: About::Measured,
        title: words.calibration_title.to_owned(),
        note: effort(found, words)
            + &not_compared(&found.whole.all, words)
            + &not_ended(&found.whole.all, words),
        columns: columns(words),
        rows,
        ..EstimateTable::default()
    }
}

/// How many trials there were, and which ends say how good a value is.
fn effort(found: &Calibration, words: &Words) -> String {
    let (fits, text) = match found.held_out.len() {
        0 => (1, words.calibration_note_one),
        parts => (parts + 1, words.calibration_note),
    };
    let blocks = if found.by_block { words.blocks_held_out } else { "" };
    let (trials, releases) = (&found.trials, &found.releases);
    let said = fill(
        text,
        &[("trials", trials), ("releases", releases), ("fits", &fits), ("blocks", &blocks)],
    );
    let (finalists, more) = (&found.finalists, &found.whole.releases);
    if *finalists == 0 {
        return said;
    }
    said + &fill(words.calibration_finalists, &[("finalists", finalists), ("more", more)])
}

/// How far the measured ends tell each value.
fn told(found: &Calibration, words: &Words) -> EstimateTable {
    let row = |told: &Told| {
        let value = estimate(told.value, told.low_95, told.high_95);
        let name = if told.is_told {
            told.name.clone()
        } else {
            fill(words.hardly_told, &[("name", &told.name)])
        };
        (name, vec![Some(value)])
    };
    EstimateTable {
        about: About::Measured,
        title: words.told_title.to_owned(),
        note: told_note(found, words),
        columns: vec![words.fitted.to_owned()],
        rows: found.told.iter().map(row).collect(),
        ..EstimateTable::default()
    }
}

/// What the table of values says, and what the fit warns of.
fn told_note(found: &Calibration, words: &Words) -> String {
    let note = fill(
        words.told_note,
        &[
            ("ends", &found.ends.0),
            ("worth", &format::decimal(found.ends.1, 0)),
            ("limit", &format::decimal(found.independent_ks_limit(&found.whole.all), 2)),
        ],
    );
    let warned = found.warnings.iter().map(|said| format::sentence(&words.say(said)));
    [note].into_iter().chain(warned).collect::<Vec<_>>().join(" ")
}

/// Where the ends of the fit lie and how they spread.
fn spread(found: &Calibration, words: &Words) -> EstimateTable {
    let row = |measure: &SiteMeasure| {
        let difference =
            estimate(measure.computed - measure.measured, measure.low_95, measure.high_95);
        let plain = |value: f64| Some(estimate(value, None, None));
        let least = |of: Estimate, is: bool| Some(Estimate { is: Is::at_least_if(is), ..of });
        let is_open = measure.low_95.is_some() && measure.high_95.is_none();
        let cells = vec![
            plain(measure.measured),
            least(Estimate::plain(measure.computed), measure.censored),
            least(difference, measure.censored || is_open),
        ];
        (format!("{}: {}", measure.scene, measure.what), cells)
    };
    EstimateTable {
        about: About::Measured,
        title: words.ends_title.to_owned(),
        note: words.ends_note.to_owned(),
        columns: [words.measured, words.computed, words.difference].map(str::to_owned).into(),
        rows: found.measures.iter().map(row).collect(),
        ..EstimateTable::default()
    }
}

fn cells(of: &Agreement, found: &Calibration) -> Vec<Option<Estimate>> {
    let numbers = [
        of.measured_mean_m,
        of.computed_mean_m,
        of.ks,
        found.independent_ks_limit(of),
        of.area_m,
        of.measured_side_m,
        of.computed_side_m,
    ];
    bounded(numbers.map(Estimate::plain), of)
}

/// The cells of a row, those marked that open rocks make lower bounds: mean runout and area, and the KS distance where they decide it.
fn bounded(mut cells: [Estimate; 7], of: &Agreement) -> Vec<Option<Estimate>> {
    for (at, is_bound) in [(1, of.open() > 0), (2, of.ks_most.is_some()), (4, of.open() > 0)] {
        cells[at].is = Is::at_least_if(is_bound);
    }
    cells.map(Some).into()
}

/// The same of one run, each with its interval, or with no more than two digits where it has none.
fn known(observed: &Observed) -> Vec<Option<Estimate>> {
    let of = &observed.agreement;
    let rounded = |value: f64| Estimate::plain(math::rounded(value, 2));
    let side = |ways: &[ObservedPath], value: f64, worth: f64| {
        let across = EndSpread::DEVIATIONS[1];
        match EndSpread::deviation_95(across, ways, worth) {
            Some([Some(low), Some(high)]) if (low..=high).contains(&value) => {
                Estimate::new(value, low, high)
            }
            _ => rounded(value),
        }
    };
    let computed = match &observed.weights {
        // of places where rocks were last seen
        _ if of.open() > 0 => rounded(of.computed_side_m),
        None => side(&observed.computed, of.computed_side_m, of.computed as f64),
        // of rocks from their own places that weigh nearly alike, by as many as know as much
        Some(weights) if observed.from_own_places => {
            let each = observed.computed.iter().zip(weights);
            let beside: Vec<ObservedPath> =
                each.filter(|(_, weight)| **weight > 0.0).map(|(way, _)| *way).collect();
            let sum = |power: i32| weights.iter().map(|weight| weight.powi(power)).sum::<f64>();
            side(&beside, of.computed_side_m, sum(1).powi(2) / sum(2))
        }
        Some(_) => rounded(of.computed_side_m),
    };
    let [measured_mean, computed_mean] = mean_of(observed);
    let cells = [
        measured_mean,
        computed_mean,
        rounded(of.ks),
        rounded(of.ks_limit),
        rounded(of.area_m),
        side(&observed.measured, of.measured_side_m, observed.worth),
        computed,
    ];
    bounded(cells, of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Language;
    use std::path::Path;

    /// Where no ends are held out there is one fit, and no ends that it was not fitted to.
    #[test]
    fn the_note_of_a_calibration_knows_how_many_fits_there_were() {
        let recorded = read_calibration(Path::new("reports/tschamut")).ok().flatten();
        let mut found = recorded.expect("a calibration is recorded there");
        let note = |found: &Calibration, language| calibration(found, Words::of(language)).note;
        let fits = found.held_out.len() + 1;
        assert!(fits > 1);
        for language in Language::ALL {
            let said = note(&found, language);
            assert!(said.contains(&format!(" {fits} ")), "{language:?}: {said}");
        }
        // of a fit whose best trials were followed again it says with how many rocks
        let count = |found: &Calibration| {
            let said = Language::ALL.map(|language| note(found, language));
            said.map(|said| said.matches("1717").count())
        };
        (found.finalists, found.whole.releases) = (0, 1717);
        assert!(count(&found).iter().all(|count| *count == 0));
        found.finalists = 7;
        assert!(count(&found).iter().all(|count| *count == 2));
        found.finalists = 0;
        found.held_out.clear();
        assert!(note(&found, Language::En).contains("releases for the fit; no ends were held out"));
        for language in Language::ALL {
            let said = note(&found, language);
            let is_of_several = said.contains(" 1 ") || said.contains(&format!(" {fits} "));
            assert!(!is_of_several && !said.contains('{'), "{language:?}: {said}");
        }
    }
}
