//! `[release] zones`: where rocks start, drawn in a GIS.

use super::drawn::name_of;
use super::places::{Area, Polyline};
use crate::error::{Error, Result};
use crate::gis::{self, Corner, Geometry, GisFeature, GisLayer, Polygon, reads};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Where in a zone rocks start.
#[derive(Debug, Clone, PartialEq)]
pub enum ZonePlace {
    /// One of these points (m), each as often.
    Points(Vec<Corner>),
    /// Uniform along these lines.
    Lines(Vec<Polyline>),
    /// Uniform over these areas.
    Areas(Vec<Area>),
}

/// One zone of release.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Property `name`, else "zone" and its number; features of one name are parts of one zone.
    pub name: String,
    /// Number of the feature in the file, from 1.
    pub feature: usize,
    /// Where.
    pub place: ZonePlace,
    /// Property `weight`: its share of the releases over that of the others (–), positive.
    pub weight: Option<f64>,
    /// Property `volume_m3`: volume that it releases (m³), positive.
    pub volume_m3: Option<f64>,
    /// Property `frequency_per_year`: rocks a year of all sizes (1/a), positive.
    pub frequency_per_year: Option<f64>,
    /// Property `per_year_at_1m3`: rocks a year of 1 m³ or more (1/a), positive.
    pub per_year_at_1m3: Option<f64>,
    /// Property `exponent` of its power law (–), positive.
    pub exponent: Option<f64>,
    /// Properties `volume_min_m3` and `volume_max_m3`: smallest and largest volume (m³), positive.
    pub volumes_m3: [Option<f64>; 2],
}

/// All zones of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Zones {
    /// Their file.
    pub file: PathBuf,
    /// EPSG code that the file names.
    pub epsg: Option<u32>,
    /// Name of the system of coordinates, where the file has a name and no code.
    pub system: Option<String>,
    /// Properties that look like those that are used, and are not.
    pub unused: Vec<String>,
    list: Vec<Zone>,
    /// Share of the releases up to and including each zone (–), the last one 1.
    shares: Vec<f64>,
}

impl Zones {
    /// Reads them.
    ///
    /// # Errors
    /// A file or feature that cannot be used; weights for some zones and not for others, or for several of one name; points beside
    /// lines or areas without weights, which have no common measure.
    pub fn read(file: &Path) -> Result<Self> {
        let GisLayer { epsg, system, features, .. } = gis::read(file)?;
        let list: Vec<Zone> =
            features.iter().map(|feature| zone(feature, file)).collect::<Result<_>>()?;
        check_parts(&list, file)?;
        let sizes = sizes(&list, file)?;
        let total: f64 = sizes.iter().sum();
        let mut shares: Vec<f64> = sizes
            .iter()
            .scan(0.0, |sum, size| {
                *sum += size / total;
                Some(*sum)
            })
            .collect();
        // rounding must not leave a gap behind the last one
        if let Some(last) = shares.last_mut() {
            *last = 1.0;
        }
        let unused = unused(&features);
        Ok(Self { file: file.to_owned(), epsg, system, unused, list, shares })
    }

    /// The zones.
    pub fn list(&self) -> &[Zone] {
        &self.list
    }

    /// How many zones there are, and in how many features where these are more.
    pub fn counted(&self) -> String {
        let names: BTreeSet<&str> = self.list.iter().map(|zone| zone.name.as_str()).collect();
        match self.list.len() {
            features if features > names.len() => {
                format!("{} zones in {features} features", names.len())
            }
            zones => format!("{zones} zones"),
        }
    }

    /// Whether some are points, others lines or areas: then they share the releases by weights or frequencies alone.
    pub fn has_kinds(&self) -> bool {
        has_kinds(&self.list)
    }

    /// The share of all releases that a zone gets (–).
    pub fn share(&self, zone: usize) -> f64 {
        self.shares[zone] - zone.checked_sub(1).map_or(0.0, |before| self.shares[before])
    }

    /// The zone that a number in 0..1 falls on.
    pub fn pick(&self, even: f64) -> usize {
        self.shares.partition_point(|end| *end <= even).min(self.list.len() - 1)
    }
}

impl Zone {
    /// Its points or corners (m).
    pub fn corners_m(&self) -> Vec<Corner> {
        match &self.place {
            ZonePlace::Points(points) => points.clone(),
            ZonePlace::Lines(lines) => {
                lines.iter().flat_map(Polyline::corners_m).copied().collect()
            }
            ZonePlace::Areas(areas) => areas.iter().flat_map(Area::corners_m).copied().collect(),
        }
    }

    /// What it is drawn as, in the plural.
    fn kind(&self) -> &'static str {
        match self.place {
            ZonePlace::Points(_) => "points",
            ZonePlace::Lines(_) => "lines",
            ZonePlace::Areas(_) => "polygons",
        }
    }

    /// What it is drawn as, and the property that says how much it releases.
    fn said(&self) -> String {
        let rate = self.frequency_per_year.map(|_| "frequency_per_year");
        let rate = rate.or(self.per_year_at_1m3.map(|_| "per_year_at_1m3"));
        format!("{} with {}", self.kind(), rate.unwrap_or("neither weight nor frequency"))
    }

    /// Number of points, length (m) or area (m²).
    pub fn size(&self) -> f64 {
        match &self.place {
            ZonePlace::Points(points) => points.len() as f64,
            ZonePlace::Lines(lines) => lines.iter().map(Polyline::length_m).sum(),
            ZonePlace::Areas(areas) => areas.iter().map(Area::area_m2).sum(),
        }
    }

    /// A point of it; three independent even numbers in 0..1 give points uniform over it.
    pub fn at(&self, [which, u, v]: [f64; 3]) -> Corner {
        match &self.place {
            ZonePlace::Points(points) => {
                points[((which * points.len() as f64) as usize).min(points.len() - 1)]
            }
            ZonePlace::Lines(lines) => {
                let (line, along) = part(lines.iter().map(Polyline::length_m), which);
                lines[line].at(along)
            }
            ZonePlace::Areas(areas) => {
                let (area, which) = part(areas.iter().map(Area::area_m2), which);
                areas[area].at([which, u, v])
            }
        }
    }
}

/// The part on which an even number falls, and how far into that part it falls (–).
fn part(sizes: impl Iterator<Item = f64> + Clone, even: f64) -> (usize, f64) {
    let target = even * sizes.clone().sum::<f64>();
    let (mut before, mut last) = (0.0, (0, 1.0));
    for (number, size) in sizes.enumerate() {
        last = (number, ((target - before) / size).clamp(0.0, 1.0));
        before += size;
        if target < before {
            break;
        }
    }
    last
}

/// Properties that a zone may have.
pub const ZONE_PROPERTIES: [&str; 8] = [
    "name",
    "weight",
    "volume_m3",
    "frequency_per_year",
    "per_year_at_1m3",
    "exponent",
    "volume_min_m3",
    "volume_max_m3",
];

/// How properties begin that mean one of those.
const LOOK_LIKE: [&str; 5] = ["weight", "freq", "per_year", "volume", "expon"];

/// Names of properties that begin like those of zones and are none of them.
fn unused(features: &[GisFeature]) -> Vec<String> {
    let begins = |name: &str, with: &str| {
        name.get(..with.len()).is_some_and(|start| start.eq_ignore_ascii_case(with))
    };
    let is_used = |name: &str| ZONE_PROPERTIES.iter().any(|used| reads(used, name));
    let looks = |name: &&String| LOOK_LIKE.iter().any(|with| begins(name, with)) && !is_used(name);
    let names = features.iter().flat_map(|feature| feature.properties.keys()).filter(looks);
    names.cloned().collect::<BTreeSet<String>>().into_iter().collect()
}

fn zone(feature: &GisFeature, file: &Path) -> Result<Zone> {
    let wrong = |flaw: crate::error::Flaw| feature.wrong(file, flaw.found, flaw.remedy);
    let line = |corners: &Vec<Corner>| Polyline::try_from(corners.clone()).map_err(wrong);
    let area = |Polygon { outline_m, holes_m }: &Polygon| {
        Area::with_holes(outline_m.clone(), holes_m).map_err(wrong)
    };
    let place = match &feature.shape {
        Geometry::Points(points) => ZonePlace::Points(points.clone()),
        Geometry::Lines(lines) => ZonePlace::Lines(lines.iter().map(line).collect::<Result<_>>()?),
        Geometry::Polygons(all) => ZonePlace::Areas(all.iter().map(area).collect::<Result<_>>()?),
    };
    let zone = Zone {
        name: name_of(feature, "name", file)?.unwrap_or_else(|| format!("zone {}", feature.number)),
        feature: feature.number,
        place,
        weight: feature.positive("weight", file)?,
        volume_m3: feature.positive("volume_m3", file)?,
        frequency_per_year: feature.positive("frequency_per_year", file)?,
        per_year_at_1m3: feature.positive("per_year_at_1m3", file)?,
        exponent: feature.positive("exponent", file)?,
        volumes_m3: [
            feature.positive("volume_min_m3", file)?,
            feature.positive("volume_max_m3", file)?,
        ],
    };
    if zone.size() > 0.0 {
        return Ok(zone);
    }
    Err(feature.wrong(file, "found no point", "draw a point, a line or a polygon"))
}

/// Refuses features of one name that say by weight or frequency how much they release. A zone of several parts that a GIS has taken apart
/// has the value of the whole in each of them, and would release as many times as much as it has parts; two zones of one name could not be told
/// apart in results. Parts that do not say it share by their sizes, as one feature of several parts does.
fn check_parts(list: &[Zone], file: &Path) -> Result<()> {
    let says = |zone: &Zone| zone.weight.is_some() || zone.says_how_often();
    let mut known: BTreeMap<&str, &Zone> = BTreeMap::new();
    for zone in list {
        let first = *known.entry(zone.name.as_str()).or_insert(zone);
        if first.feature != zone.feature && (says(first) || says(zone)) {
            let place = format!("feature {}", zone.feature);
            let found = format!(
                "found the name {:?} of feature {} again, with weight or frequency",
                zone.name, first.feature
            );
            let remedy = "write another name, or make one feature of several parts of them, with the weight or frequency of the whole";
            return Err(Error::input(file, place, found, remedy));
        }
    }
    Ok(())
}

/// Whether some zones are points, others lines or areas.
fn has_kinds(list: &[Zone]) -> bool {
    list.iter().any(|zone| zone.kind() != list[0].kind())
}

/// By what the releases are shared: weights, or the size of the zones, or their rates where sizes have no common measure.
fn sizes(list: &[Zone], file: &Path) -> Result<Vec<f64>> {
    let weights: Vec<f64> = list.iter().filter_map(|zone| zone.weight).collect();
    if weights.len() == list.len() {
        return Ok(weights);
    }
    let refused = |zone: &Zone, found: String, remedy: &str| {
        Err(Error::input(file, format!("feature {}", zone.feature), found, remedy))
    };
    let without = list.iter().find(|zone| zone.weight.is_none());
    let weighed = list.iter().find(|zone| zone.weight.is_some());
    if let (Some(zone), Some(other)) = (without, weighed) {
        let found = format!("found no weight, which feature {} has", other.feature);
        return refused(zone, found, "write the property weight for all zones or for none");
    }
    // what says how often it releases rocks has a measure in common with others that say the same
    for often in [|zone: &Zone| zone.frequency_per_year, |zone: &Zone| zone.per_year_at_1m3] {
        let rates: Vec<f64> = list.iter().filter_map(often).collect();
        if rates.len() == list.len() && has_kinds(list) {
            return Ok(rates);
        }
    }
    // where each has one of two measures, it is these that cannot be compared
    let says_how_often = list.iter().all(Zone::says_how_often);
    let is_unlike = |zone: &&Zone| {
        if says_how_often {
            zone.frequency_per_year.is_some() != list[0].frequency_per_year.is_some()
        } else {
            zone.kind() != list[0].kind()
        }
    };
    if let Some(other) = list.iter().find(is_unlike).filter(|_| has_kinds(list)) {
        let remedy = if says_how_often {
            "write weight for every zone, or the same one of frequency_per_year and per_year_at_1m3 for all: rocks of all sizes and those of 1 m³ or more cannot be compared, nor can points, metres and square metres"
        } else {
            "write weight, or frequency_per_year, for every zone, or one file for each kind of geometry: by points, metres and square metres alone releases cannot be shared"
        };
        let found = format!(
            "found {} where feature {} has {}",
            other.said(),
            list[0].feature,
            list[0].said()
        );
        return refused(other, found, remedy);
    }
    Ok(list.iter().map(Zone::size).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two holes, one seen past the other: their area is left out, and no point falls into them.
    #[test]
    fn holes_are_left_out() {
        let square = |low: f64, side: f64| {
            vec![[low, low], [low + side, low], [low + side, low + side], [low, low + side]]
        };
        let holed = Area::with_holes(square(0.0, 10.0), &[square(3.0, 2.0), square(6.0, 2.0)]);
        let holed = holed.unwrap();
        assert!((holed.area_m2() - 92.0).abs() < 1e-12);
        for k in 0..5000u32 {
            let even = [0.618_033_988_75, 0.754_877_666_25, 0.569_840_290_99];
            let [x, y] = holed.at(even.map(|step| (f64::from(k) * step).fract()));
            let inside = |low: f64| x > low && x < low + 2.0 && y > low && y < low + 2.0;
            assert!((0.0..=10.0).contains(&x) && (0.0..=10.0).contains(&y));
            assert!(!inside(3.0) && !inside(6.0), "({x}, {y})");
        }
        // a hole that reaches out, and one in the other
        for holes in [[square(9.0, 2.0), square(3.0, 2.0)], [square(3.0, 4.0), square(4.0, 1.0)]] {
            assert!(Area::with_holes(square(0.0, 10.0), &holes).is_err());
        }
    }
}
