//! Zones of release that are sources: each releases rocks as often as its properties say.

use super::check::{Checked, Complaint};
use super::refusal::Refusal;
use super::sizes::{COUNTABLE, STEEPEST, VOLUMES_M3, are_volumes};
use super::zones::{Zone, Zones};
use super::{FrequencyTable, Scene};
use crate::error::{Error, Flaw};
use crate::frequency::{Class, Frequency, FrequencyLaw, RockSource, power_between};

/// What `[frequency]` says of the sizes of all zones that do not say it themselves.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CommonSizes {
    /// Exponent of the power law (–).
    pub(super) exponent: Option<f64>,
    /// Smallest and largest volume (m³).
    pub(super) volume_m3: Option<[f64; 2]>,
}

const HOW_OFTEN: &str = "write the property frequency_per_year (rocks of all sizes) or per_year_at_1m3 (of 1 m³ or more) for every zone, or one law for all in [frequency]";

impl Zone {
    /// Whether its properties say how often it releases rocks.
    pub fn says_how_often(&self) -> bool {
        self.frequency_per_year.is_some() || self.per_year_at_1m3.is_some()
    }

    /// How often it releases rocks of what size.
    ///
    /// Its own properties come before what is common to all zones. With an exponent, sizes follow the power law between the
    /// two volumes: `a = f / (V_0^−b − V_1^−b)` where the events a year `f` of all sizes are given. Without one they are even
    /// in the logarithm of the volume; without volumes they are those of the scene's rocks.
    fn law(&self, common: CommonSizes) -> Result<FrequencyLaw, Flaw> {
        let volumes = self.volume_range(common)?;
        let exponent = self.exponent.or(common.exponent.filter(|_| self.volume_m3.is_none()));
        if exponent.is_some_and(|b| b > STEEPEST) {
            return Err(Flaw::new(
                "found too large an exponent",
                format!("write at most {STEEPEST}"),
            ));
        }
        let missing = |what: &str, remedy: &str| Err(Flaw::new(format!("found no {what}"), remedy));
        match (self.frequency_per_year, self.per_year_at_1m3, exponent, volumes) {
            (None, None, ..) => missing("frequency_per_year", HOW_OFTEN),
            (Some(_), Some(_), ..) => Err(Flaw::new(
                "found frequency_per_year and per_year_at_1m3",
                "write one of them: the other follows from exponent and volumes",
            )),
            (.., Some(_), None) => missing(
                "volume_min_m3 and volume_max_m3",
                "write both, or volume_m3 = [smallest, largest] in [frequency]: a power law has two ends",
            ),
            (None, Some(_), None, _) => missing(
                "exponent",
                "write it, or exponent in [frequency], or frequency_per_year instead of per_year_at_1m3",
            ),
            (None, Some(per_year_at_1m3), Some(exponent), Some(volume_m3)) => {
                Ok(FrequencyLaw::PowerLaw { per_year_at_1m3, exponent, volume_m3 })
            }
            (Some(per_year), None, Some(exponent), Some(volume_m3)) => {
                let per_year_at_1m3 = per_year / power_between(volume_m3, exponent);
                Ok(FrequencyLaw::PowerLaw { per_year_at_1m3, exponent, volume_m3 })
            }
            (Some(per_year), None, None, Some(volume_m3)) => {
                Ok(FrequencyLaw::Classes(vec![Class { volume_m3, per_year }]))
            }
            (Some(per_year), None, None, None) => Ok(FrequencyLaw::Events { per_year }),
        }
    }

    /// Smallest and largest volume (m³); none where nothing says them.
    fn volume_range(&self, common: CommonSizes) -> Result<Option<[f64; 2]>, Flaw> {
        let (own, one) = (self.volumes_m3, self.volume_m3);
        let range = match (own, one) {
            ([None, None], None) => common.volume_m3,
            ([None, None], Some(_)) if self.exponent.is_some() => {
                let remedy = "write volume_min_m3 and volume_max_m3 instead, or leave exponent out";
                return Err(Flaw::new("found exponent beside volume_m3", remedy));
            }
            ([None, None], Some(volume)) => Some([volume; 2]),
            ([Some(least), Some(largest)], None) => Some([least, largest]),
            (_, Some(_)) => {
                let remedy = "write volume_m3 alone, or volume_min_m3 and volume_max_m3";
                return Err(Flaw::new("found volume_m3 beside a range of volumes", remedy));
            }
            _ => {
                let remedy = "write volume_min_m3 and volume_max_m3, or none of them";
                return Err(Flaw::new("found one end of a range of volumes", remedy));
            }
        };
        let [low, high] = VOLUMES_M3;
        match range {
            Some([least, largest]) if !are_volumes([least, largest], one.is_some()) => {
                let found = format!("found the volumes {least} and {largest}");
                let remedy =
                    format!("write a smaller and a larger one, from {low:e} to {high:e} m³");
                Err(Flaw::new(found, remedy))
            }
            range => Ok(range),
        }
    }
}

impl Zones {
    /// Each zone as a source.
    ///
    /// # Errors
    /// A zone without frequency, or with properties that are no law; zones with volumes beside such without.
    pub(super) fn sources(&self, common: CommonSizes) -> crate::error::Result<Vec<RockSource>> {
        let refused = |zone: &Zone, flaw: Flaw| {
            Error::input(&self.file, format!("feature {}", zone.feature), flaw.found, flaw.remedy)
        };
        let source = |zone: &Zone| {
            let law = zone.law(common).map_err(|flaw| refused(zone, flaw))?;
            if !law.is_countable() {
                let found = format!("found {}", law.in_words());
                return Err(refused(zone, Flaw::new(found, COUNTABLE)));
            }
            Ok(RockSource { name: zone.name.clone(), law })
        };
        let sources: Vec<RockSource> =
            self.list().iter().map(source).collect::<crate::error::Result<_>>()?;
        let draws = |source: &RockSource| !matches!(source.law, FrequencyLaw::Events { .. });
        let other = sources.iter().position(|source| draws(source) != draws(&sources[0]));
        match other {
            None => Ok(sources),
            Some(zone) => {
                let [first, other] = [0, zone].map(|number| &self.list()[number]);
                let (has, lacks) = if draws(&sources[0]) { (first, other) } else { (other, first) };
                let found = format!(
                    "found volumes in feature {} and none in feature {}, which takes [rocks] radius_m",
                    has.feature, lacks.feature
                );
                let remedy = "write volume_m3, or volume_min_m3 and volume_max_m3, for every zone (volume_m3 = [smallest, largest] in [frequency] stands for those without), or for none: then all rocks have [rocks] radius_m";
                Err(refused(other, Flaw::new(found, remedy)))
            }
        }
    }
}

impl Scene {
    /// The sources of rocks, their laws of size, and what is asked of the year; none without `[frequency]`, and where zones
    /// are sources that were not read yet.
    pub fn sources(&self) -> Option<Frequency> {
        self.frequency.as_ref().and_then(|table| table.compile(self.release.zone_list.as_ref()))
    }

    /// Whether sources say with volumes how large rocks are, and `[rocks] radius_m` does not.
    pub fn draws_volumes(&self) -> bool {
        self.sources().as_ref().is_some_and(Frequency::draws_volumes)
    }

    /// Checks `[frequency]`, and the sizes of rocks as far as they are known before any zones are read.
    pub(super) fn check_frequency(&self) -> Checked {
        let Some(table) = &self.frequency else { return self.check_sizes() };
        table.check(self.release.zones.is_some()).map_err(|wrong| wrong.inside("frequency"))?;
        if self.release.table.is_some() && self.draws_volumes() {
            let remedy =
                "remove it, or write per_year = … in [frequency]: a table has blocks of its own";
            let about = Complaint::about("table", remedy);
            return Err(about.finding("found it beside volumes of [frequency]").inside("release"));
        }
        if self.has_zone_sources() { Ok(()) } else { self.check_sizes() }
    }

    /// Sizes that the scene's rocks have and its sources have not, or the other way round.
    fn check_sizes(&self) -> Checked {
        // a table that is yet to be read has sizes of its own
        if self.release.table.is_some() && self.rocks.radius_m.is_none() && !self.draws_volumes() {
            return Ok(());
        }
        let sources = self.sources();
        self.rocks.check_radius(sources.as_ref()).map_err(|wrong| wrong.inside("rocks"))
    }

    /// Whether the zones of `[release]` are sources, each with a law of its own.
    pub fn has_zone_sources(&self) -> bool {
        let is_by_zone = self.frequency.as_ref().is_some_and(FrequencyTable::is_by_zone);
        is_by_zone && self.release.zones.is_some()
    }

    /// Takes the laws of the zones, once they are read.
    pub(super) fn take_zone_sources(&mut self) -> Result<(), Refusal> {
        let (Some(table), Some(zones)) = (&self.frequency, &self.release.zone_list) else {
            return Ok(());
        };
        if !table.is_by_zone() {
            let says = zones.list().iter().find(|zone| zone.says_how_often());
            return says.map_or(Ok(()), |zone| {
                let remedy = "remove the law, and every zone is a source of its own; or remove the property from the file";
                let found = format!(
                    "found a law beside the frequency of feature {} of {}",
                    zone.feature,
                    zones.file.display()
                );
                Err(Complaint::about(table.law_key(), remedy).finding(found).inside("frequency").into())
            });
        }
        zones.sources(table.common_sizes())?;
        self.check_sizes()?;
        let frequency = self.sources();
        self.rocks.take_sizes(frequency.as_ref());
        Ok(())
    }
}
