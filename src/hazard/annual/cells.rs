//! Passages a year cell by cell.

use super::super::classes::{Counts, class_of, place_in_class};
use super::super::maps::Maps;
use super::super::rate::{Limits, Running, Sums};
use super::curve::{Ceilings, curve, return_energy};
use super::{AnnualRequest, Matrix};
use crate::frequency::{Frequency, Stratum, Weights};

/// A map of something a year, where rocks came.
#[derive(Debug, Clone, PartialEq)]
pub struct YearMap {
    /// File name without ending.
    pub file: String,
    /// What its values are, in words.
    pub name: String,
    /// Their unit; empty of a pure number.
    pub unit: &'static str,
    /// Whether it stands beside another: an end of its interval, or what it changes by.
    pub is_beside: bool,
    /// Cells and values, rising by cell.
    pub values: Vec<(u32, f64)>,
}

/// All maps of a year: passage frequency, the same above each energy asked for, the energy of each return period, each
/// with the ends of its 95 % interval and with its derivatives by rate and exponent, and levels of hazard; none without
/// sources. A frequency is its own derivative by the logarithm of the rates; without power law there is none by the exponent.
///
/// Above an energy inside a class of counts (ratio 1.05) rocks are taken as even in the logarithm over that class; of the
/// sizes in a stratum (a factor of 2.2 in volume) the derivative by the exponent takes the mean.
pub fn year_maps(maps: &Maps, asked: &AnnualRequest, weights: &Weights) -> Vec<YearMap> {
    let Some(frequency) = &asked.frequency else { return Vec::new() };
    let scores: Vec<Option<f64>> = frequency.strata().iter().map(Stratum::mean_score).collect();
    let has_exponent = scores.iter().any(Option::is_some);
    let (energies, periods) = (frequency.energies_j(), frequency.return_periods_years());
    let ceilings = Ceilings::of(weights, &asked.most_j);
    let least = || [0.0].iter().chain(energies);
    let limits: Vec<Limits> =
        least().map(|joule| Limits::above(weights, &asked.most_j, *joule)).collect();
    let sums = |stratum: u16, sums: Sums| match scores[usize::from(stratum)] {
        Some(mean) => sums.scoring(mean),
        None => sums,
    };
    let mut running = Running::new(weights);
    let mut layers = Layers::of(frequency, has_exponent);
    let mut levels = Vec::new();
    for (cell, counts) in maps.energies() {
        let mut values = Vec::with_capacity(layers.0.len());
        for (least_j, limits) in least().zip(&limits) {
            running.clear();
            add_above(counts, *least_j, (&mut running, &sums));
            values.extend(running.estimate(limits));
            values.extend(has_exponent.then(|| running.by_exponent()));
        }
        running.clear();
        let falling = counts.entries().iter().rev();
        let falling = falling.map(|&(class, s, n)| (class, s, sums(s, Sums::many(n))));
        let points = curve(falling, &mut running, &ceilings);
        let energy = |years: f64| return_energy(&points, &ceilings, years, has_exponent);
        for years in periods {
            let found = energy(*years);
            // an end that is open has no number, nor has the slope of nothing
            let or_none = |value: Option<f64>| value.unwrap_or(f64::NAN);
            values.extend([found.energy_j.unwrap_or(0.0), found.low_95, or_none(found.high_95)]);
            values.push(or_none(found.by_log_rate));
            values.extend(has_exponent.then(|| or_none(found.by_exponent)));
        }
        layers.push(cell, values);
        if let Some(matrix) = &asked.matrix {
            levels.push((cell, f64::from(matrix.level(|years| energy(years).energy_j))));
        }
    }
    let level = YearMap { values: levels, ..YearMap::of(Matrix::FILE, "Level of hazard", "") };
    layers.0.into_iter().chain(asked.matrix.as_ref().map(|_| level)).collect()
}

/// All layers but that of levels, in the order in which their values come.
struct Layers(Vec<YearMap>);

impl Layers {
    fn of(frequency: &Frequency, has_exponent: bool) -> Self {
        let mut layers = Vec::new();
        let by_exponent = has_exponent.then_some(("_by_exponent", "change with the exponent"));
        let mut add = |file: &str, name: &str, unit, slopes: &[(&str, &str)]| {
            layers.push(YearMap::of(file, name, unit));
            for (end, which) in ENDS.iter().chain(slopes) {
                let of = YearMap::of(&format!("{file}{end}"), &format!("{name}, {which}"), unit);
                layers.push(YearMap { is_beside: true, ..of });
            }
        };
        let slopes: Vec<_> = by_exponent.into_iter().collect();
        add("frequency_per_year", "Passages a year", "1/year", &slopes);
        for kj in frequency.energies_j().iter().map(|joule| joule / 1e3) {
            let name = format!("Passages a year with {kj} kJ or more");
            add(&format!("frequency_above_{kj}kj_per_year"), &name, "1/year", &slopes);
        }
        let by_rate = ("_by_log_rate", "change with the logarithm of all rates");
        let slopes: Vec<_> = [by_rate].into_iter().chain(by_exponent).collect();
        for years in frequency.return_periods_years() {
            let name = format!("Total energy of return period {years} years");
            add(&format!("energy_T{years}_j"), &name, "J", &slopes);
        }
        Self(layers)
    }

    fn push(&mut self, cell: u32, values: Vec<f64>) {
        for (layer, value) in self.0.iter_mut().zip(values) {
            layer.values.push((cell, value));
        }
    }
}

/// Endings of the layers of an interval, and what they are.
const ENDS: [(&str, &str); 2] =
    [("_low_95", "lower end of the 95 % interval"), ("_high_95", "upper end of the 95 % interval")];

impl YearMap {
    fn of(file: &str, name: &str, unit: &'static str) -> Self {
        let (file, name) = (file.to_owned(), name.to_owned());
        Self { file, name, unit, is_beside: false, values: Vec::new() }
    }
}

impl Matrix {
    /// File name of its map without ending.
    pub const FILE: &str = "hazard_level";
}

/// Adds the rocks with at least an energy (J); `sums` says how the frequency of a stratum changes.
fn add_above(
    counts: &Counts,
    least_j: f64,
    (running, sums): (&mut Running<'_>, &impl Fn(u16, Sums) -> Sums),
) {
    let (cut, part) = (class_of(least_j), 1.0 - place_in_class(least_j));
    for &(class, stratum, n) in counts.entries() {
        if class > cut || class == cut && part >= 1.0 {
            running.add(stratum, &sums(stratum, Sums::many(n)));
        } else if class == cut {
            running.add(stratum, &sums(stratum, Sums::part(n, part)));
        }
    }
}
