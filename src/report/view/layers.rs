//! Maps as classes of colour over the terrain.

use super::pack::Section;
use crate::error::Result;
use crate::hazard::{self, MapFrame};
use crate::math;
use crate::output::Results;
use crate::terrain::grid::Grid;
use serde::Serialize;
use serde_json::json;

/// Longest side of a layer (cells): what every graphics card takes.
const LONGEST: usize = 2048;
/// Limits between the classes of a layer.
const LIMITS: usize = 5;
/// Decades that hold them.
const DECADES: i32 = 3;

/// What is shown of the maps: layer, name, unit, size of the unit in SI, and whether it counts rocks.
const SHOWN: [(hazard::Layer, &str, &str, f64, bool); 4] = [
    (hazard::Layer::Reach, "Reach probability", "%", 0.01, false),
    (hazard::Layer::EnergyP95, "Total energy, 95 %", "kJ", 1e3, false),
    (hazard::Layer::HeightP95, "Bounce height, 95 %", "m", 1.0, false),
    (hazard::Layer::Deposits, "Deposits in a cell", "rocks", 1.0, true),
];
/// Least limit between classes of a count: below it are one and two.
const FEW: f64 = 3.0;

/// A layer: the class of every cell, rows from north to south; 0 where no rock came, and where none is counted. Where rocks only roll
/// the height is 0, which is a value.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ViewLayer {
    name: &'static str,
    unit: &'static str,
    /// A cell of class k has at least the limit k − 2, counted from 0, and less than the next.
    limits: Vec<f64>,
    #[serde(skip)]
    classes: Vec<u32>,
}

/// All layers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MapLayers {
    frame: MapFrame,
    /// Every so many cells are one, of which the largest value counts.
    every: usize,
    layers: Vec<ViewLayer>,
}

impl MapLayers {
    /// The maps of a run; none where there are none.
    pub(super) fn of(results: &Results) -> Result<Option<Self>> {
        let Some(frame) = results.summary.maps else { return Ok(None) };
        let every = (frame.columns.max(frame.rows) as usize).div_ceil(LONGEST).max(1);
        let mut layers = Vec::new();
        for (layer, name, unit, size, counts) in SHOWN {
            let Some(grid) = results.map(layer)? else { continue };
            let values: Vec<Option<f64>> = coarsened(&grid, every)
                .map(|value| value.filter(|value| *value > 0.0 || !counts).map(|v| v / size))
                .collect();
            let most = values.iter().flatten().copied().fold(0.0, f64::max);
            let limits = if counts { limits_of_counts(most) } else { limits(most) };
            let class = |value: f64| 1 + limits.iter().filter(|limit| value >= **limit).count();
            let classes = values.into_iter().map(|value| value.map_or(0, class) as u32).collect();
            layers.push(ViewLayer { name, unit, limits, classes });
        }
        Ok(Some(Self { frame, every, layers }))
    }

    /// What was left out.
    pub(super) fn note(&self) -> Option<String> {
        let cell_m = self.frame.cell_m * self.every as f64;
        (self.every > 1)
            .then(|| format!("Map layers in cells of {cell_m} m, each with its largest value."))
    }

    /// Packed as text.
    pub(super) fn text(&self) -> String {
        let MapFrame { west_m, south_m, cell_m, columns, rows, .. } = self.frame;
        let mut section = Section::new(json!({
            "west_m": west_m,
            "north_m": south_m + f64::from(rows) * cell_m,
            "cell_m": cell_m * self.every as f64,
            "columns": (columns as usize).div_ceil(self.every),
            "rows": (rows as usize).div_ceil(self.every),
            "layers": self.layers,
        }));
        for (number, layer) in self.layers.iter().enumerate() {
            section.add(&format!("layer {number}"), 1, 0, layer.classes.clone());
        }
        section.text()
    }
}

/// Values row by row from the north, the largest of so many cells each way; none where no cell has one.
fn coarsened(grid: &Grid, every: usize) -> impl Iterator<Item = Option<f64>> {
    let (columns, rows) = (grid.columns.div_ceil(every), grid.rows.div_ceil(every));
    let mut values = vec![None; columns * rows];
    for row in 0..grid.rows {
        for column in 0..grid.columns {
            let cell: &mut Option<f64> = &mut values[row / every * columns + column / every];
            let both = [*cell, grid.value(column, row)].into_iter().flatten();
            *cell = both.reduce(f64::max);
        }
    }
    values.into_iter()
}

/// Limits between classes of numbers of rocks: no rock is a fraction.
fn limits_of_counts(most: f64) -> Vec<f64> {
    limits(most.max(FEW)).into_iter().filter(|limit| *limit >= FEW).collect()
}

/// The last few of 1, 3, 10, 30 … below a value.
fn limits(most: f64) -> Vec<f64> {
    if most.is_nan() || most <= 0.0 {
        return Vec::new();
    }
    let top = math::log10(most).floor() as i32;
    // written and read, not multiplied: 0.3 is then the double that everybody else has for it
    let series = (top - DECADES..=top)
        .flat_map(|k| [1, 3].map(|digit| format!("{digit}e{k}").parse().unwrap_or(f64::NAN)));
    let below: Vec<f64> = series.filter(|limit| *limit <= most).collect();
    below[below.len().saturating_sub(LIMITS)..].to_vec()
}

#[cfg(test)]
mod tests {
    use super::{limits, limits_of_counts};

    /// Of 12 rocks at most the classes are below 3, 3 to 10, 10 and more; of one rock, too, none is below 1.
    #[test]
    fn numbers_of_rocks_have_no_class_below_one() {
        assert_eq!(limits_of_counts(12.0), [3.0, 10.0]);
        assert_eq!(limits_of_counts(1.0), [3.0]);
        assert_eq!(limits_of_counts(0.0), [3.0]);
    }

    #[test]
    fn limits_are_round_and_hold_the_swiss_ones() {
        assert_eq!(limits(2000.0), [10.0, 30.0, 100.0, 300.0, 1000.0]);
        assert_eq!(limits(0.5), [0.003, 0.01, 0.03, 0.1, 0.3]);
        assert!(limits(0.0).is_empty() && limits(f64::NAN).is_empty());
    }
}
