//! Passages a year cell by cell.

use super::super::classes::{Counts, class_of, place_in_class};
use super::super::maps::Maps;
use super::curve::{Ceilings, curve, return_energy};
use super::rate::{Limits, Running, Sums};
use super::{Asked, Matrix};

/// A map of something a year, where rocks came.
#[derive(Debug, Clone, PartialEq)]
pub struct YearMap {
    /// File name without ending.
    pub file: String,
    /// What its values are, in words.
    pub name: String,
    /// Their unit; empty of a pure number.
    pub unit: &'static str,
    /// Whether it is an end of an interval.
    pub is_bound: bool,
    /// Cells and values, rising by cell.
    pub values: Vec<(u32, f64)>,
}

/// All maps of a year: passage frequency, the same above each energy asked for, the energy of each return period, each
/// with the ends of its 95 % interval, and levels of hazard; none without sources.
///
/// Above an energy inside a class of counts (ratio 1.05) rocks are taken as even in the logarithm over that class.
pub fn year_maps(maps: &Maps, asked: &Asked, releases: usize) -> Vec<YearMap> {
    let Some(frequency) = &asked.frequency else { return Vec::new() };
    let weights = frequency.weights(releases);
    let (energies, periods) = (frequency.energies_j(), frequency.return_periods_years());
    let mut layers = with_bounds("frequency_per_year", "Passages a year", "1/year").to_vec();
    for kj in energies.iter().map(|joule| joule / 1e3) {
        let words = format!("Passages a year with {kj} kJ or more");
        layers.extend(with_bounds(&format!("frequency_above_{kj}kj_per_year"), &words, "1/year"));
    }
    for years in periods {
        let words = format!("Total energy of return period {years} years");
        layers.extend(with_bounds(&format!("energy_T{years}_j"), &words, "J"));
    }
    let ceilings = Ceilings::of(&weights, &asked.most_j);
    let least = || [0.0].iter().chain(energies);
    let limits: Vec<Limits> =
        least().map(|joule| Limits::above(&weights, &asked.most_j, *joule)).collect();
    let mut running = Running::new(&weights);
    let mut levels = Vec::new();
    for (cell, counts) in maps.energies() {
        let mut layer = layers.iter_mut();
        let mut say = |values: [f64; 3]| {
            for value in values {
                if let Some(layer) = layer.next() {
                    layer.values.push((cell, value));
                }
            }
        };
        for (least_j, limits) in least().zip(&limits) {
            running.clear();
            add_above(counts, *least_j, &mut running);
            say(running.estimate(limits));
        }
        running.clear();
        let falling = counts.entries().iter().rev();
        let falling = falling.map(|&(class, stratum, n)| (class, stratum, Sums::many(n)));
        let points = curve(falling, &mut running, &ceilings);
        let energy = |years: f64| return_energy(&points, &ceilings, years, false);
        for years in periods {
            let found = energy(*years);
            // an end that is open has no number
            let high = found.high_95.unwrap_or(f64::NAN);
            say([found.energy_j.unwrap_or(0.0), found.low_95, high]);
        }
        if let Some(matrix) = &asked.matrix {
            levels.push((cell, f64::from(matrix.level(|years| energy(years).energy_j))));
        }
    }
    if asked.matrix.is_some() {
        layers.push(YearMap {
            file: Matrix::FILE.to_owned(),
            name: "Level of hazard".to_owned(),
            unit: "",
            is_bound: false,
            values: levels,
        });
    }
    layers
}

impl Matrix {
    /// File name of its map without ending.
    pub const FILE: &str = "hazard_level";
}

fn with_bounds(file: &str, name: &str, unit: &'static str) -> [YearMap; 3] {
    let ends = [("", ""), ("_low_95", ", lower"), ("_high_95", ", upper")];
    ends.map(|(end, which)| YearMap {
        file: format!("{file}{end}"),
        name: match which {
            "" => name.to_owned(),
            which => format!("{name}{which} end of the 95 % interval"),
        },
        unit,
        is_bound: !end.is_empty(),
        values: Vec::new(),
    })
}

/// Adds the rocks with at least an energy (J).
fn add_above(counts: &Counts, least_j: f64, running: &mut Running<'_>) {
    let (cut, part) = (class_of(least_j), 1.0 - place_in_class(least_j));
    for &(class, stratum, n) in counts.entries() {
        if class > cut || class == cut && part >= 1.0 {
            running.add(stratum, &Sums::many(n));
        } else if class == cut {
            running.add(stratum, &Sums::part(n, part));
        }
    }
}
