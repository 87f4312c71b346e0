//! `[frequency]`: how often rocks are released, of what size, and what is asked of the year.

use super::check::{Allowed, Checked, Complaint, check_names, number, optional};
use super::matrix::MatrixEntry;
use super::places::{Area, Polyline, ReleasePoint};
use super::sizes::{COUNTABLE, STEEPEST, VOLUMES_M3, are_volumes, positive_list};
use super::zone_sources::CommonSizes;
use super::zones::Zones;
use crate::frequency::{Class, Frequency, FrequencyLaw, RockSource};
use crate::random::Entries;
use serde::{Deserialize, Deserializer};

/// How often rocks are released: one law, or one for each of several sources.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [frequency]")]
pub struct FrequencyTable {
    /// Events a year of rocks as `[rocks] radius_m` has them (1/year), positive.
    pub per_year: Option<f64>,
    /// Power law: events a year of 1 m³ or more (1/year), positive.
    pub per_year_at_1m3: Option<f64>,
    /// Power law: exponent `b` of `N(≥ V) = a V^−b` (–), positive. Without law, that of all zones of release that have none.
    pub exponent: Option<f64>,
    /// Power law: smallest and largest volume (m³), positive and rising. Without law, those of all zones that have none.
    #[serde(default, deserialize_with = "pair")]
    pub volume_m3: Option<[f64; 2]>,
    /// Instead: events a year by class of volume.
    pub classes: Option<Vec<ClassTable>>,
    /// Instead: several sources, each with its place and its law.
    #[serde(default)]
    pub sources: Vec<SourceTable>,
    /// Energies whose frequency is asked for (J), positive.
    pub energies_j: Option<Vec<f64>>,
    /// Return periods whose energy is asked for (years), positive.
    pub return_periods_years: Option<Vec<f64>>,
    /// Classes of hazard by energy and return period.
    pub matrix: Option<MatrixEntry>,
}

/// `[[frequency.sources]]`: a place that releases rocks.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with name, a place and a law")]
pub struct SourceTable {
    /// Name in the results.
    pub name: String,
    /// Where: points in map coordinates (m), taken in turn.
    pub points_m: Option<Vec<ReleasePoint>>,
    /// Where: uniform along a polyline in map coordinates (m).
    pub line_m: Option<Polyline>,
    /// Where: uniform over an area in map coordinates (m).
    pub polygon_m: Option<Area>,
    /// As of [`FrequencyTable`].
    pub per_year: Option<f64>,
    /// As of [`FrequencyTable`].
    pub per_year_at_1m3: Option<f64>,
    /// As of [`FrequencyTable`].
    pub exponent: Option<f64>,
    /// As of [`FrequencyTable`].
    #[serde(default, deserialize_with = "pair")]
    pub volume_m3: Option<[f64; 2]>,
    /// As of [`FrequencyTable`].
    pub classes: Option<Vec<ClassTable>>,
}

/// A class of volume and how often it comes.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with volume_m3 and per_year")]
pub struct ClassTable {
    /// One volume, or smallest and largest (m³), positive.
    #[serde(deserialize_with = "one_or_two")]
    pub volume_m3: [f64; 2],
    /// Events a year (1/year), positive.
    pub per_year: f64,
}

/// The keys of a law, wherever they stand.
struct LawKeys<'a> {
    per_year: Option<f64>,
    per_year_at_1m3: Option<f64>,
    exponent: Option<f64>,
    volume_m3: Option<[f64; 2]>,
    classes: Option<&'a [ClassTable]>,
}

/// Return periods unless the scene names others (years).
const RETURN_PERIODS_YEARS: [f64; 4] = [30.0, 100.0, 300.0, 1000.0];
/// Energies unless the scene names others (J): the limits of the classes of the intensity map.
const ENERGIES_J: [f64; 2] = [30e3, 300e3];
const LAW: &str = "write per_year = … (sizes as [rocks] radius_m has them), or per_year_at_1m3, exponent and volume_m3, or classes";

impl FrequencyTable {
    /// The sources, their laws and what is asked; none where a key is wrong, which the check has reported, and where zones are
    /// sources that were not read yet.
    pub(super) fn compile(&self, zones: Option<&Zones>) -> Option<Frequency> {
        let sources = if self.is_by_zone() {
            zones?.sources(self.common_sizes()).ok()
        } else {
            self.written_sources()
        };
        Some(Frequency::new(
            sources?,
            self.energies_j.clone().unwrap_or_else(|| ENERGIES_J.into()),
            self.return_periods_years.clone().unwrap_or_else(|| RETURN_PERIODS_YEARS.into()),
        ))
    }

    /// Its own law, or its sources.
    fn written_sources(&self) -> Option<Vec<RockSource>> {
        let own = self.keys().law().ok()?.map(|law| RockSource { name: "release".to_owned(), law });
        let named = |table: &SourceTable| {
            Some(RockSource { name: table.name.clone(), law: table.keys().law().ok()?? })
        };
        match own {
            Some(source) => Some(vec![source]),
            None => self.sources.iter().map(named).collect(),
        }
    }

    /// Whether it has neither a law nor sources: then each zone of release is one.
    pub(super) fn is_by_zone(&self) -> bool {
        let has_law = self.per_year.is_some() || self.per_year_at_1m3.is_some();
        !has_law && self.classes.is_none() && self.sources.is_empty()
    }

    /// The key of its law.
    pub(super) fn law_key(&self) -> &'static str {
        match (self.per_year, self.per_year_at_1m3) {
            (Some(_), _) => "per_year",
            (_, Some(_)) => "per_year_at_1m3",
            _ => "classes",
        }
    }

    /// Sizes of all zones that do not say them themselves.
    pub(super) fn common_sizes(&self) -> CommonSizes {
        CommonSizes { exponent: self.exponent, volume_m3: self.volume_m3 }
    }

    /// `has_zones`: places of release are drawn in a file, whose properties may hold what is missing here.
    pub(super) fn check(&self, has_zones: bool) -> Checked {
        if has_zones && self.is_by_zone() {
            optional("exponent", self.exponent, Allowed::Positive, "")?;
            if let Some(volume_m3) = self.volume_m3 {
                volumes("volume_m3", volume_m3, false)?;
            }
        } else {
            self.check_sources()?;
        }
        positive_list("energies_j", self.energies_j.as_deref())?;
        positive_list("return_periods_years", self.return_periods_years.as_deref())?;
        self.matrix.as_ref().map_or(Ok(()), |one| one.check().map_err(|w| w.inside("matrix")))
    }

    fn check_sources(&self) -> Checked {
        let own = self.keys().law()?;
        if own.is_some() != self.sources.is_empty() {
            return Err(if own.is_some() {
                let remedy = "remove it, or the law in [frequency]: each source has its own";
                Complaint::about("sources", remedy).finding("found both a law and sources")
            } else {
                Complaint::missing(
                    "per_year",
                    format!(
                        "{LAW}, or [[frequency.sources]], or [release] zones with a frequency each"
                    ),
                )
            });
        }
        // results name sources, and nothing else tells them apart there
        let names = self.sources.iter().map(|source| source.name.as_str());
        check_names(&[("sources", names.collect())])?;
        let mut draws = Vec::new();
        for (index, source) in self.sources.iter().enumerate() {
            let law = source.check().map_err(|wrong| wrong.in_entry(index).inside("sources"))?;
            draws.push(!matches!(law, FrequencyLaw::Events { .. }));
        }
        if let Some(index) = draws.iter().position(|one| *one != draws[0]) {
            let remedy = "write per_year alone in all sources, or volumes in all";
            let about = Complaint::about("name", remedy);
            let [has, lacks] = if draws[0] { [0, index] } else { [index, 0] };
            let found = format!(
                "found volumes in source {:?} and none in source {:?}, which takes [rocks] radius_m",
                self.sources[has].name, self.sources[lacks].name
            );
            return Err(about.finding(found).in_entry(index).inside("sources"));
        }
        Ok(())
    }

    fn keys(&self) -> LawKeys<'_> {
        LawKeys {
            per_year: self.per_year,
            per_year_at_1m3: self.per_year_at_1m3,
            exponent: self.exponent,
            volume_m3: self.volume_m3,
            classes: self.classes.as_deref(),
        }
    }
}

impl SourceTable {
    fn check(&self) -> Result<FrequencyLaw, Complaint> {
        let places = [self.points_m.is_some(), self.line_m.is_some(), self.polygon_m.is_some()];
        if places.iter().filter(|given| **given).count() != 1 {
            let remedy = "write exactly one of points_m, line_m and polygon_m";
            return Err(Complaint::about("name", remedy).finding("found none or several places"));
        }
        if self.points_m.as_ref().is_some_and(Vec::is_empty) {
            return Err(Complaint::about("points_m", "write at least one point"));
        }
        let points = self.points_m.as_deref().unwrap_or_default();
        if points.iter().any(|point| point.height_m.is_some()) {
            let remedy = "write the points as [x, y]: height_m of [release] says how high";
            return Err(Complaint::about("points_m", remedy));
        }
        let law = self.keys().law()?;
        law.ok_or_else(|| Complaint::missing("per_year", LAW))
    }

    fn keys(&self) -> LawKeys<'_> {
        LawKeys {
            per_year: self.per_year,
            per_year_at_1m3: self.per_year_at_1m3,
            exponent: self.exponent,
            volume_m3: self.volume_m3,
            classes: self.classes.as_deref(),
        }
    }
}

impl LawKeys<'_> {
    /// The law; none where no key of one is written.
    fn law(&self) -> Result<Option<FrequencyLaw>, Complaint> {
        let law = self.written()?;
        let key = match &law {
            Some(law) if law.is_countable() => return Ok(Some(law.clone())),
            None => return Ok(None),
            Some(FrequencyLaw::Events { .. }) => "per_year",
            Some(FrequencyLaw::PowerLaw { .. }) => "per_year_at_1m3",
            Some(FrequencyLaw::Classes(_)) => "classes",
        };
        Err(Complaint::about(key, COUNTABLE))
    }

    /// The same, whatever its rates are.
    fn written(&self) -> Result<Option<FrequencyLaw>, Complaint> {
        let power = [
            ("per_year_at_1m3", self.per_year_at_1m3.is_some()),
            ("exponent", self.exponent.is_some()),
            ("volume_m3", self.volume_m3.is_some()),
        ];
        let given = [
            self.per_year.map(|_| "per_year"),
            power.iter().find(|(_, given)| *given).map(|(key, _)| *key),
            self.classes.map(|_| "classes"),
        ];
        let mut given = given.into_iter().flatten();
        let (one, other) = (given.next(), given.next());
        if let (Some(one), Some(other)) = (one, other) {
            return Err(Complaint::about(other, LAW).finding(format!("found {one} beside it")));
        }
        if let Some(per_year) = self.per_year {
            number("per_year", per_year, Allowed::Positive, "")?;
            return Ok(Some(FrequencyLaw::Events { per_year }));
        }
        if let Some(classes) = self.classes {
            return classes_law(classes).map(Some);
        }
        let (Some(per_year_at_1m3), Some(exponent), Some(volume_m3)) =
            (self.per_year_at_1m3, self.exponent, self.volume_m3)
        else {
            let missing = power.iter().find(|(_, given)| !given);
            return match missing.filter(|_| one.is_some()) {
                Some((key, _)) => Err(Complaint::missing(key, LAW)),
                None => Ok(None),
            };
        };
        number("per_year_at_1m3", per_year_at_1m3, Allowed::Positive, "")?;
        number("exponent", exponent, Allowed::Positive, "")?;
        if exponent > STEEPEST {
            return Err(Complaint::about("exponent", format!("write at most {STEEPEST}")));
        }
        volumes("volume_m3", volume_m3, false)?;
        Ok(Some(FrequencyLaw::PowerLaw { per_year_at_1m3, exponent, volume_m3 }))
    }
}

fn classes_law(classes: &[ClassTable]) -> Result<FrequencyLaw, Complaint> {
    if classes.is_empty() {
        return Err(Complaint::about("classes", "write at least one class"));
    }
    for (index, class) in classes.iter().enumerate() {
        volumes("volume_m3", class.volume_m3, true)
            .and_then(|()| number("per_year", class.per_year, Allowed::Positive, ""))
            .map_err(|wrong| wrong.in_entry(index).inside("classes"))?;
    }
    let class = |one: &ClassTable| Class { volume_m3: one.volume_m3, per_year: one.per_year };
    Ok(FrequencyLaw::Classes(classes.iter().map(class).collect()))
}

fn volumes(key: &str, range: [f64; 2], may_be_equal: bool) -> Checked {
    if are_volumes(range, may_be_equal) {
        return Ok(());
    }
    let [low, high] = VOLUMES_M3;
    let remedy = format!("write smallest and largest volume, from {low:e} to {high:e} m³");
    Err(Complaint::about(key, remedy))
}

fn pair<'de, D: Deserializer<'de>>(from: D) -> Result<Option<[f64; 2]>, D::Error> {
    Entries::deserialize(from).map(|Entries(pair)| Some(pair))
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "a volume, or [smallest, largest]")]
enum OneOrTwo {
    One(f64),
    Two([f64; 2]),
}

fn one_or_two<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
    OneOrTwo::deserialize(from).map(|found| match found {
        OneOrTwo::One(volume) => [volume; 2],
        OneOrTwo::Two(pair) => pair,
    })
}
