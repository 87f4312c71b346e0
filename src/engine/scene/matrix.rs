//! `[frequency.matrix]`: levels of hazard by the energy of each return period.

use super::check::{BROKEN, Checked, Complaint, is_broken};
use super::sizes::positive_list;
use serde::Deserialize;

/// Levels of hazard as they are written: a table of the scene's own, or one of [`MATRICES`] by its name.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [frequency.matrix]")]
pub struct MatrixEntry {
    /// Key of one of [`MATRICES`], instead of all other keys.
    pub table: Option<String>,
    /// Name that stands beside the map.
    pub name: Option<String>,
    /// Where the table was read; stands beside the map.
    pub source: Option<String>,
    /// Limits between the classes of energy (J), rising.
    pub energies_j: Option<Vec<f64>>,
    /// Return periods (years), rising.
    pub return_periods_years: Option<Vec<f64>>,
    /// A row for each return period, in it a level for each class of energy, from weak to strong.
    pub levels: Option<Vec<Vec<u8>>>,
}

/// Levels of hazard.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixTable {
    /// Name that stands beside the map.
    pub name: String,
    /// Where the table was read; stands beside the map.
    pub source: String,
    /// Limits between the classes of energy (J), rising; none where every rock counts alike.
    pub energies_j: Vec<f64>,
    /// Return periods (years), rising.
    pub return_periods_years: Vec<f64>,
    /// A row for each return period, in it a level for each class of energy, from weak to strong.
    pub levels: Vec<Vec<u8>>,
}

/// A table that was read in its source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownMatrix {
    /// What a scene writes for it.
    pub key: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Where it was read.
    pub source: &'static str,
    /// Return periods (years), rising; every rock counts, whatever its energy.
    pub return_periods_years: &'static [f64],
    /// The level of each.
    pub levels: &'static [u8],
}

/// Tables that ship: only what could be read in its source.
///
/// Norway's safety classes are limits of the annual probability alone: S1 1/100, S2 1/1000, S3 1/5000. Level 3 exceeds all of
/// them, 2 those of S2 and S3, 1 that of S3.
pub const MATRICES: [KnownMatrix; 1] = [KnownMatrix {
    key: "tek17-7-3",
    name: "TEK17 § 7-3: more often than the safety classes S3 (1), S2 (2), S1 (3) permit",
    source: "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, table of the second paragraph: largest nominal annual probability S1 1/100, S2 1/1000, S3 1/5000",
    return_periods_years: &[100.0, 1000.0, 5000.0],
    levels: &[3, 2, 1],
}];

impl MatrixEntry {
    /// The table; none where a key is wrong, which the check has reported.
    pub fn table(&self) -> Option<MatrixTable> {
        let Self { table, name, source, energies_j, return_periods_years, levels } = self;
        if let Some(key) = table {
            let known = MATRICES.iter().find(|known| known.key == key)?;
            return Some(MatrixTable {
                name: known.name.to_owned(),
                source: known.source.to_owned(),
                energies_j: Vec::new(),
                return_periods_years: known.return_periods_years.to_vec(),
                levels: known.levels.iter().map(|level| vec![*level]).collect(),
            });
        }
        Some(MatrixTable {
            name: name.clone()?,
            source: source.clone()?,
            energies_j: energies_j.clone()?,
            return_periods_years: return_periods_years.clone()?,
            levels: levels.clone()?,
        })
    }

    pub(super) fn check(&self) -> Checked {
        let given = [
            ("name", self.name.is_some()),
            ("source", self.source.is_some()),
            ("energies_j", self.energies_j.is_some()),
            ("return_periods_years", self.return_periods_years.is_some()),
            ("levels", self.levels.is_some()),
        ];
        if let Some(key) = &self.table {
            if let Some((other, _)) = given.iter().find(|(_, given)| *given) {
                let remedy = "remove it, or remove table: a table that ships has all of them";
                return Err(Complaint::about(other, remedy));
            }
            let known: Vec<&str> = MATRICES.iter().map(|known| known.key).collect();
            if known.contains(&key.as_str()) {
                return Ok(());
            }
            let remedy = format!("write {}, or a table of your own", known.join(" or "));
            return Err(Complaint::about("table", remedy));
        }
        match (given.iter().find(|(_, given)| !given), self.table()) {
            (Some((key, _)), _) => {
                Err(Complaint::missing(key, format!("write {key} = …; it has no default")))
            }
            (None, table) => table.map_or(Ok(()), |table| table.check()),
        }
    }
}

impl MatrixTable {
    fn check(&self) -> Checked {
        for (key, words) in [("name", &self.name), ("source", &self.source)] {
            if words.trim().is_empty() {
                let remedy = "write it: a table of levels stands with its name and its source";
                return Err(Complaint::about(key, remedy));
            }
            if is_broken(words) {
                let found = format!("found {words:?}");
                return Err(Complaint::about(key, BROKEN).finding(found));
            }
        }
        for (key, list) in
            [("energies_j", &self.energies_j), ("return_periods_years", &self.return_periods_years)]
        {
            positive_list(key, Some(list))?;
            if list.is_empty() || list.windows(2).any(|pair| pair[0] >= pair[1]) {
                return Err(Complaint::about(key, "write at least one number, rising"));
            }
        }
        let (rows, columns) = (self.return_periods_years.len(), self.energies_j.len() + 1);
        if self.levels.len() != rows || self.levels.iter().any(|row| row.len() != columns) {
            let remedy = format!(
                "write {rows} rows, one a return period, of {columns} levels, one a class of energy"
            );
            return Err(Complaint::about("levels", remedy));
        }
        if self.levels.iter().any(|row| row.windows(2).any(|pair| pair[0] > pair[1])) {
            let remedy = "write levels that do not fall with rising energy: each row goes from the weakest class to the strongest";
            return Err(Complaint::about("levels", remedy));
        }
        Ok(())
    }
}
