//! Passages a year cell by cell.

use super::super::maps::{MapCell, Maps};
use super::super::rate::{Limits, Running, Sums};
use super::curve::{Ceilings, curve, resolved, return_energy};
use super::energies::EnergyClass;
use super::{AnnualRequest, Matrix};
use crate::count::shortest;
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
/// Of the sizes in a stratum (a factor of 2.2 in volume) the derivative by the exponent takes the mean. Energies of return periods are read
/// from classes of energy (ratio 1.003, up to 1.05 where many rocks pass), as cells keep no rocks one by one; their intervals reach to the
/// far ends of their classes. Levels of hazard are counted.
pub fn year_maps(maps: &Maps, asked: &AnnualRequest, weights: &Weights) -> Vec<YearMap> {
    let Some(frequency) = &asked.frequency else { return Vec::new() };
    let scores: Vec<Option<f64>> = frequency.strata().iter().map(Stratum::mean_score).collect();
    let has_exponent = scores.iter().any(Option::is_some);
    let (energies, periods) = (frequency.energies_j(), frequency.return_periods_years());
    let ceilings = Ceilings::of(weights, &asked.most_j);
    let limits = |joule: f64| Limits::above(weights, &asked.most_j, joule);
    let any = limits(0.0);
    let above: Vec<(Option<usize>, Limits)> =
        energies.iter().map(|&joule| (maps.number_of(joule), limits(joule))).collect();
    let sums = |stratum: u16, sums: Sums| match scores[usize::from(stratum)] {
        Some(mean) => sums.scoring(mean),
        None => sums,
    };
    let mut running = Running::new(weights);
    let mut layers = Layers::of(frequency, has_exponent);
    let mut levels = Vec::new();
    for (number, cell) in maps.passed() {
        let mut values = Vec::with_capacity(layers.0.len());
        let mut add = |rocks: &mut dyn Iterator<Item = (u16, u32)>, limits: &Limits| {
            running.clear();
            rocks.for_each(|(stratum, n)| running.add(stratum, &sums(stratum, Sums::many(n))));
            values.extend(running.estimate(limits));
            values.extend(has_exponent.then(|| running.by_exponent()));
        };
        add(&mut cell.energies().rocks(), &any);
        for (energy, limits) in &above {
            let rocks = energy.map_or(&[][..], |energy| cell.above(energy));
            add(&mut rocks.iter().copied(), limits);
        }
        running.clear();
        let classes = cell.energies().by_class();
        let falling = classes.entries().iter().rev();
        let falling = falling.map(|&(class, s, n)| (class, s, sums(s, Sums::many(n))));
        let smooth = curve(falling, &mut running, &ceilings);
        let parts: Vec<EnergyClass> = cell.energies().falling().map(EnergyClass::of).collect();
        let steps = resolved((&smooth, &parts), &mut running, &ceilings, periods);
        for years in periods {
            let found = return_energy((&steps, &smooth), &ceilings, *years, has_exponent);
            // an end that is open has no number, nor has the slope of nothing
            let or_none = |value: Option<f64>| value.unwrap_or(f64::NAN);
            values.extend([found.energy_j.unwrap_or(0.0), found.low_95, or_none(found.high_95)]);
            values.push(or_none(found.by_log_rate));
            values.extend(has_exponent.then(|| or_none(found.by_exponent)));
        }
        layers.push(number, values);
        if let Some(matrix) = &asked.matrix {
            levels.push((number, f64::from(level(matrix, (maps, cell), &mut running))));
        }
    }
    let level = YearMap { values: levels, ..YearMap::of(Matrix::FILE, "Level of hazard", "") };
    layers.0.into_iter().chain(asked.matrix.as_ref().map(|_| level)).collect()
}

/// Level of hazard of a cell, from the rocks that are counted above each limit between classes of energy.
fn level(matrix: &Matrix, (maps, cell): (&Maps, &MapCell), running: &mut Running<'_>) -> u8 {
    matrix.level(|limit| {
        running.clear();
        let mut count = |stratum, rocks| running.add(stratum, &Sums::many(rocks));
        let above = |joule| maps.number_of(joule).map_or(&[][..], |energy| cell.above(energy));
        match limit {
            None => cell.energies().rocks().for_each(|(s, n)| count(s, n)),
            Some(joule) => above(joule).iter().for_each(|&(s, n)| count(s, n)),
        }
        running.per_year()
    })
}

/// File name without ending of the map of passages a year with an energy (J) or more.
pub fn file_above(energy_j: f64) -> String {
    format!("frequency_above_{}kj_per_year", shortest(energy_j / 1e3))
}

/// File name without ending of the map of the energy of a return period (years).
pub fn file_of_period(years: f64) -> String {
    format!("energy_T{}_j", shortest(years))
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
        for joule in frequency.energies_j() {
            let name = format!("Passages a year with {} kJ or more", shortest(joule / 1e3));
            add(&file_above(*joule), &name, "1/year", &slopes);
        }
        let by_rate = ("_by_log_rate", "change with the logarithm of all rates");
        let slopes: Vec<_> = [by_rate].into_iter().chain(by_exponent).collect();
        for years in frequency.return_periods_years() {
            let name = format!("Total energy of return period {} years", shortest(*years));
            add(&file_of_period(*years), &name, "J", &slopes);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::{Class, FrequencyLaw, RockSource};
    use crate::hazard::{Layer, MapFrame, MapState, StopKind};
    use crate::simulation::CellPassage;

    /// By hand: rocks of 29.9, 30.1, 49.9 and 50 kJ, each for 1/100 a year, pass a cell. Above an energy they are counted, whichever class of
    /// values it lies in: rocks of a class that the energy cuts counted by a part each, 0.0225 for 0.03 a year above 30 kJ and 0.0132 for 0.01 above 50 kJ.
    #[test]
    fn rocks_above_an_energy_are_counted() {
        let class = Class { volume_m3: [1.0, 1.0], per_year: 0.04 };
        let law = FrequencyLaw::Classes(vec![class]);
        let source = RockSource { name: "wall".to_owned(), law };
        let frequency = Frequency::new(vec![source], vec![30e3, 50e3], vec![]);
        let frame =
            MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 1.0, columns: 1, rows: 1, epsg: None };
        let mut maps = Maps::new(frame, frequency.energies_j(), MapState::default());
        for total_j in [29.9e3, 30.1e3, 49.9e3, 50e3] {
            let passage = CellPassage { cell: 0, total_j, height_m: 0.0 };
            maps.add(0, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
        }
        let weights = frequency.weights(4);
        let asked = AnnualRequest { frequency: Some(frequency), ..AnnualRequest::default() };
        let layers = year_maps(&maps, &asked, &weights);
        let value = |file: &str| {
            layers.iter().find(|layer| layer.file == file).map(|layer| layer.values[0].1)
        };
        for (file, rocks) in [
            ("frequency_per_year", 4.0),
            ("frequency_above_30kj_per_year", 3.0),
            ("frequency_above_50kj_per_year", 1.0),
        ] {
            assert!(
                (value(file).unwrap() - 0.01 * rocks).abs() < 1e-15,
                "{file}: {:?}",
                value(file)
            );
        }
        // and so does the share that is conditional on release
        let share = maps.values(Layer::ExceedsWeak, &weights).next().unwrap().1;
        assert!((0.04 * share - value("frequency_above_30kj_per_year").unwrap()).abs() < 1e-15);
    }

    /// What division by a thousand leaves behind the digits of an energy is in no name of a file.
    #[test]
    fn names_of_files_are_as_short_as_the_numbers() {
        assert_eq!(file_above(30_000.4), "frequency_above_30.0004kj_per_year");
        assert_eq!(file_above(30e3), "frequency_above_30kj_per_year");
        assert_eq!([300.0, 33.3].map(file_of_period), ["energy_T300_j", "energy_T33.3_j"]);
    }

    /// A rock of 30.2 kJ comes once in 50 years: more often than 100 years, and above 30 kJ though its class of energies begins below.
    #[test]
    fn levels_are_counted() {
        let class = Class { volume_m3: [1.0, 1.0], per_year: 0.02 };
        let law = FrequencyLaw::Classes(vec![class]);
        let source = RockSource { name: "wall".to_owned(), law };
        let frequency = Frequency::new(vec![source], vec![1e6], vec![]);
        let frame =
            MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 1.0, columns: 1, rows: 1, epsg: None };
        for (total_j, level) in [(29.8e3, 1.0), (30e3, 2.0), (30.2e3, 2.0), (31.5e3, 2.0)] {
            let matrix = Matrix {
                name: "levels".to_owned(),
                source: "by hand".to_owned(),
                energies_j: vec![30e3],
                return_periods_years: vec![10.0, 100.0],
                levels: vec![vec![8, 9], vec![1, 2]],
            };
            let frequency = Some(frequency.clone());
            let asked = AnnualRequest { frequency, matrix: Some(matrix), ..Default::default() };
            let mut maps = Maps::new(frame, &asked.counted_j(), MapState::default());
            for _ in 0..4 {
                let passage = CellPassage { cell: 0, total_j, height_m: 0.0 };
                maps.add(0, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
            }
            let weights = asked.frequency.as_ref().unwrap().weights(4);
            let layers = year_maps(&maps, &asked, &weights);
            let found = layers.iter().find(|layer| layer.file == Matrix::FILE).unwrap();
            assert!((found.values[0].1 - level).abs() < 1e-9, "{total_j}: {:?}", found.values);
        }
    }
}
