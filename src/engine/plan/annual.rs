//! What a scene asks of the year: sources, objects, and what to know of the numbers.

use super::recorders::below_releases;
use super::{EvaluationLine, Part};
use crate::error::{Error, Result};
use crate::frequency::{Frequency, Stratum, radius_of_m3};
use crate::random::Distribution;
use crate::release::{self, Release};
use crate::rock::Rock;
use crate::scene::{MatrixTable, ObjectTable, Scene, ZONE_PROPERTIES, Zone, Zones};
use crate::terrain::Terrain;

/// Fewest rocks of a stratum with which the intervals hold what they promise, as simulated runs say.
const FEW_ROCKS: usize = 20;

/// Most strata: maps and curves name them by two bytes.
const MOST_STRATA: usize = u16::MAX as usize;

/// What is asked of the year.
#[derive(Debug, Clone, PartialEq)]
pub struct YearPlan {
    /// Sources, strata, energies and return periods.
    pub frequency: Frequency,
    /// Classes of hazard.
    pub matrix: Option<MatrixTable>,
    /// Most energy that a rock of each stratum can ever have (J).
    pub most_j: Vec<f64>,
    /// Radius of the largest rock of each stratum (m).
    pub largest_m: Vec<f64>,
}

impl YearPlan {
    /// Layers of maps that it brings.
    pub(super) fn map_layers(&self) -> f64 {
        (1 + self.frequency.energies_j().len() + self.frequency.return_periods_years().len()) as f64
    }
}

/// The sources; none where the scene has none.
///
/// # Errors
/// Fewer releases than strata: nothing would stand for some of the sizes.
pub(super) fn year(
    scene: &Scene,
    terrain: &Terrain,
    warnings: &mut Vec<String>,
) -> Result<Part<YearPlan>> {
    warnings.extend(of_zones(scene));
    let Some(frequency) = scene.sources() else {
        return Ok(Part::LeftOut(
            "the scene has no [frequency], every number is conditional on release",
        ));
    };
    let (strata, count) = (frequency.strata().len(), scene.release.count);
    if strata > MOST_STRATA {
        let found = format!("found {strata} classes of size and source");
        let remedy = format!("write at most {MOST_STRATA}: join zones, sources or classes");
        return Err(Error::input(&scene.file, "[frequency]", found, remedy));
    }
    if count < strata {
        let found = format!("found {count} releases for {strata} classes of size and source");
        let remedy = format!("write {} or more", FEW_ROCKS * strata);
        return Err(Error::input(&scene.file, "[release] count", found, remedy));
    }
    if !frequency.weights(count).are_equal() {
        warnings.push(weighed(strata > frequency.sources().len()).to_owned());
    }
    let matrix = scene.frequency.as_ref().and_then(|table| table.matrix.as_ref()?.table());
    let largest_m: Vec<f64> =
        frequency.strata().iter().map(|stratum| largest_m(scene, stratum)).collect();
    let most_j = most_j(scene, terrain, &largest_m);
    Ok(Part::Kept(YearPlan { frequency, matrix, most_j, largest_m }))
}

/// What is said of so many releases where some class of size and source has too few.
pub(super) fn too_few(year: &YearPlan, count: usize) -> Option<String> {
    let strata = year.frequency.strata().len();
    (strata > 1 && count < FEW_ROCKS * strata).then(|| format!(
        "{count} releases over {strata} classes of size and source: with fewer than {FEW_ROCKS} each the intervals a year may be too narrow; write count = {} or more",
        FEW_ROCKS * strata
    ))
}

/// What is said where rocks do not all weigh the same; `has_sizes`: some source has classes of size.
fn weighed(has_sizes: bool) -> &'static str {
    if has_sizes {
        "sizes are sampled by importance: large rocks are computed more often than they come. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed"
    } else {
        "the same number of rocks is computed for every source, however often it releases them in a year. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed"
    }
}

/// What properties of zones say in vain.
fn of_zones(scene: &Scene) -> Vec<String> {
    let Some(zones) = &scene.release.zone_list else { return Vec::new() };
    let unknown = (!zones.unused.is_empty()).then(|| {
        format!(
            "{}: properties that are not used: {}; zones have {}",
            zones.file.display(),
            zones.unused.join(", "),
            ZONE_PROPERTIES.join(", ")
        )
    });
    unknown.into_iter().chain(in_vain(scene, zones)).collect()
}

/// What properties of zones say where something else counts.
fn in_vain(scene: &Scene, zones: &Zones) -> Option<String> {
    let file = zones.file.display();
    if scene.has_zone_sources() {
        let is_weighted = zones.list().iter().any(|zone| zone.weight.is_some());
        return is_weighted.then(|| {
            format!("the weights of {file} are not used: every class of size and source gets the same number of rocks, and each rock stands for its part of the frequency of its zone")
        });
    }
    let says = scene.frequency.is_none() && zones.list().iter().any(Zone::says_how_often);
    if says {
        return Some(format!(
            "{file} says how often its zones release rocks, and the scene asks for nothing a year: write the table [frequency], and each zone is a source"
        ));
    }
    let has_size = |zone: &Zone| zone.volume_m3.is_some() || zone.volumes_m3 != [None; 2];
    zones.list().iter().any(has_size).then(|| {
        format!("{file} says how large the rocks of its zones are, which is not used: sizes are those of the scene; where each zone says how often too, and [frequency] has no law of its own, each has its own")
    })
}

/// What the numerics may add to the energy of a rock, over all that it has (–): ten times what was ever measured.
const NUMERICS: f64 = 1.1;
/// Energy of a rock that nothing bounds (J); a file can hold it, unlike infinity.
const UNBOUNDED_J: f64 = 1e300;

/// Most energy that a rock of each stratum can ever have (J): that of its start and of a fall through the whole height of
/// the terrain.
fn most_j(scene: &Scene, terrain: &Terrain, largest_m: &[f64]) -> Vec<f64> {
    let squares = |vector: &[Distribution; 3]| -> f64 {
        vector.iter().map(|value| largest(value).powi(2)).sum()
    };
    let (low, high) = terrain.index.bounds();
    let points = scene.release.points_m.iter().flatten().filter_map(|point| point.height_m);
    let top_m = points.map(|z| z - terrain.origin_m.z).fold(high.z, f64::max);
    let gap_m = scene.release.height_m.as_ref().map_or(0.0, largest);
    let (v2, w2) = (squares(&scene.release.velocity_m_s), squares(&scene.release.spin_rad_s));
    let most = |&radius_m: &f64| {
        let rock = Rock { radius_m, density_kg_m3: scene.rocks.density_kg_m3 };
        // a rock over steep ground may be lifted by some radii until it is clear of it
        let drop_m = top_m - low.z + gap_m + LIFTED * radius_m;
        let fall_j = rock.mass_kg() * scene.gravity_m_s2 * drop_m;
        let start_j = 0.5 * (rock.mass_kg() * v2 + rock.inertia_kg_m2() * w2);
        (NUMERICS * (fall_j + start_j)).min(UNBOUNDED_J)
    };
    largest_m.iter().map(most).collect()
}

/// Radius of the largest rock of a stratum (m).
fn largest_m(scene: &Scene, stratum: &Stratum) -> f64 {
    let own = stratum.volume_m3.map(|[_, largest]| radius_of_m3(largest));
    own.unwrap_or_else(|| largest(scene.rocks.radius_m()))
}

/// The largest amount of a value.
fn largest(value: &Distribution) -> f64 {
    let (low, high) = value.support();
    low.abs().max(high.abs())
}

/// More radii than a release is ever lifted by (–).
const LIFTED: f64 = 8.0;

/// The objects; none where the scene has none.
pub(super) fn objects(scene: &Scene, warnings: &mut Vec<String>) -> Part<Vec<ObjectTable>> {
    if !scene.objects.is_empty() && scene.frequency.is_none() {
        warnings.push(
            "[[objects]] without [frequency]: how many releases hit them is computed, how often a year and at what risk is not"
                .to_owned(),
        );
    }
    let objects = scene.objects.clone();
    Part::when(Some(objects).filter(|all| !all.is_empty()), "the scene has none")
}

/// Evaluation lines of the objects.
///
/// # Errors
/// An object that comes nowhere near the terrain.
pub(super) fn evaluation_lines(scene: &Scene, terrain: &Terrain) -> Result<Vec<EvaluationLine>> {
    let (low, high) = terrain.index.bounds();
    let evaluation_line = |table: &ObjectTable| {
        let evaluation_line = EvaluationLine::of_object(table, terrain.origin_m);
        if evaluation_line.is_near([low.x, low.y], [high.x, high.y]) {
            return Ok(evaluation_line);
        }
        let place = format!("[[objects]] \"{}\"", table.name);
        let remedy = release::outside(terrain);
        Err(Error::input(&scene.file, place, "found no terrain near it", remedy))
    };
    scene.objects.iter().map(evaluation_line).collect()
}

/// Says which objects the first releases lie over before they have moved: such a rock hits at once, with next to no energy,
/// and a hazard that is none stands in every number of the object.
pub(super) fn over_release(
    tried: &[Release],
    lines: Option<&[EvaluationLine]>,
    warnings: &mut Vec<String>,
) {
    let lines = lines.unwrap_or_default();
    warnings.extend(below_releases(tried, lines));
    for (object, footprint) in lines.iter().filter_map(|line| Some((line, line.footprint?))) {
        let is_over = |release: &&Release| {
            let at = release.motion.position_m;
            object.gap_m(footprint, [at.x, at.y]).0 < release.rock.radius_m
        };
        let over = tried.iter().filter(is_over).count();
        if over > 0 {
            warnings.push(format!(
                "{over} of {} releases tried out lie over the object “{}” before they move: they hit it at once, with the energy of the release. Draw the object or the release elsewhere",
                tried.len(), object.name
            ));
        }
    }
}

/// Sources and objects as name and value for the report.
pub(super) fn rows(scene: &Scene) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    if let Some(frequency) = scene.sources() {
        for source in frequency.sources() {
            rows.push((format!("Source “{}”", source.name), source.law.in_words()));
        }
    }
    rows.extend(
        scene.objects.iter().map(|object| (format!("Object “{}”", object.name), words(object))),
    );
    rows
}

/// An object in words.
pub(super) fn words(object: &ObjectTable) -> String {
    let mut parts = vec![match (&object.points_m, object.width_m) {
        (Some(line), Some(width)) => format!("{:.1} m long, {width} m wide", line.length_m()),
        _ => object
            .polygon_m
            .as_ref()
            .map_or(String::new(), |area| format!("{:.1} m²", area.area_m2())),
    }];
    if let Some(vehicles) = &object.vehicles {
        let (n, v, l) = (vehicles.per_day, vehicles.speed_km_h, vehicles.length_m);
        parts.push(format!("{n} vehicles a day of {l} m at {v} km/h"));
        parts.extend(vehicles.own_per_day.map(|own| format!("{own} passages a day of one person")));
    }
    parts.extend(object.occupancy.map(|share| format!("occupied {share} of the time")));
    parts.extend(object.persons.map(|persons| format!("{persons} persons")));
    parts.extend(object.vulnerability.map(|share| format!("vulnerability {share}")));
    parts.join(", ")
}

/// The sources in words, one line each, and how they are sampled.
pub(super) fn lines(year: &YearPlan, count: usize) -> Vec<String> {
    let YearPlan { frequency, matrix, most_j: _, largest_m: _ } = year;
    let mut lines: Vec<String> = frequency
        .sources()
        .iter()
        .map(|source| format!("{}: {}", source.name, source.law.in_words()))
        .collect();
    let weights = frequency.weights(count);
    let classes = match frequency.strata().len() {
        1 => "1 class of size and source".to_owned(),
        strata => {
            format!("{strata} classes of size and source, {} rocks or more each", count / strata)
        }
    };
    lines.push(format!(
        "{:.4} events a year; {classes}: {count} rocks are as precise as {:.0} of equal weight",
        frequency.per_year(),
        weights.effective_rocks()
    ));
    lines.extend(
        matrix.as_ref().map(|one| format!("levels of “{}”; source: {}", one.name, one.source)),
    );
    lines
}
