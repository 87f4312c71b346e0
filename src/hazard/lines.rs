//! What all rocks say at one evaluation line.

mod by_class;
mod quantity;

pub use by_class::{ClassReach, SilentClasses};
use quantity::HEIGHTS;
pub use quantity::LineQuantity;

use super::proportion::Proportion;
use super::rate::{share_if_any, share_up_to};
use super::sample::Sample;
use super::totals::Largest;
use super::{Statistic, statistic};
use crate::frequency::{Frequency, Weights};
use crate::rock::{Rock, Vec3};
use crate::simulation::Crossing;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// An evaluation line on the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LineInfo {
    /// Name in the scene.
    pub name: String,
    /// Its length (m).
    pub length_m: f64,
    /// Its corners in map coordinates (m).
    pub corners_m: Vec<[f64; 2]>,
    /// Whether it is another place of a barrier: its numbers stand with that barrier.
    #[serde(default)]
    pub of_barrier: bool,
    /// What a rock must have the energy to come up to; none where that is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<LineFloor>,
}

/// The lowest ground under a line: a rock that crosses it is above.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LineFloor {
    /// Map height that no ground of the line lies below (m).
    pub ground_m: f64,
    /// Gravity (m/s²).
    pub gravity_m_s2: f64,
}

/// One row of `crossings.csv`: the first crossing of a line by a rock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CrossingRow {
    /// Release number.
    pub index: usize,
    /// Name of the line.
    pub line: String,
    /// Time since release (s).
    pub time_s: f64,
    /// Where along the line (m), from its first corner.
    pub along_m: f64,
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there is no ground.
    pub height_m: f64,
    /// Speed of the centre (m/s).
    pub speed_m_s: f64,
    /// Translational energy (J).
    pub translational_j: f64,
    /// Rotational energy (J).
    pub rotational_j: f64,
    /// Distance from the slope to the rock along the slope's normal (m); NaN where there is no ground.
    pub height_normal_m: f64,
    /// Slope of the path against the horizontal (degrees), positive downwards.
    pub descent_deg: f64,
    /// Mass of the rock (kg).
    pub mass_kg: f64,
    /// Radius of the rock (m).
    pub radius_m: f64,
    /// How often the rock crosses the line in all.
    pub times: u32,
    /// Centre of the rock in map coordinates (m).
    pub position_m: [f64; 3],
    /// Vertical distance from the ground below to the highest point of the rock (m), NaN where there is no ground; none in a
    /// scene of spheres, where the file has no such column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top_m: Option<f64>,
}

/// Two lines on one place are crossed at times that differ by rounding (s).
const SAME_INSTANT_S: f64 = 1e-9;

impl CrossingRow {
    /// Whether the rock crosses this line later than at a time (s), or at that instant: of a line that is drawn on a barrier
    /// rounding would say both.
    pub(super) fn is_behind(&self, time_s: f64) -> bool {
        self.time_s + SAME_INSTANT_S > time_s
    }

    /// Columns of `crossings.csv`.
    pub const COLUMNS: [&'static str; 16] = [
        "index",
        "line",
        "time_s",
        "along_m",
        "height_m",
        "speed_m_s",
        "translational_j",
        "rotational_j",
        "height_normal_m",
        "descent_deg",
        "mass_kg",
        "radius_m",
        "times",
        "x_m",
        "y_m",
        "z_m",
    ];

    /// The column that follows them where a scene has blocks.
    pub const SHAPE_COLUMNS: [&'static str; 1] = ["top_m"];

    /// The row of one crossing of rock `index`; `origin_m` is the map position of the local (0, 0, 0).
    pub fn of(
        (index, rock): (usize, &Rock),
        crossing: &Crossing,
        line: &str,
        origin_m: Vec3,
    ) -> Self {
        let motion = &crossing.motion;
        Self {
            index,
            line: line.to_owned(),
            time_s: motion.time_s,
            along_m: crossing.along_m,
            height_m: crossing.height_m,
            speed_m_s: motion.velocity_m_s.norm(),
            translational_j: motion.translational_j(rock),
            rotational_j: crossing.rotational_j,
            height_normal_m: crossing.height_normal_m,
            descent_deg: crossing.descent_deg(),
            mass_kg: rock.mass_kg(),
            radius_m: rock.radius_m,
            times: crossing.times,
            position_m: (motion.position_m + origin_m).into(),
            top_m: crossing.top_m,
        }
    }

    /// Vertical distance from the ground below to the highest point of the rock (m): of a sphere, a diameter over the lowest.
    pub fn highest_m(&self) -> f64 {
        self.top_m.unwrap_or(self.height_m + 2.0 * self.radius_m)
    }

    /// Sum of translational and rotational energy (J).
    pub fn total_j(&self) -> f64 {
        self.translational_j + self.rotational_j
    }
}

/// Gives the rows of one rock at a time, from rows that come release by release.
///
/// # Errors
/// Passes on what reading a row says.
pub fn by_rock<E>(
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
    mut take: impl FnMut(&mut Vec<CrossingRow>),
) -> Result<(), E> {
    let mut rock: Vec<CrossingRow> = Vec::new();
    for row in rows {
        let row = row?;
        if rock.first().is_some_and(|first| first.index != row.index) {
            take(&mut rock);
            rock.clear();
        }
        rock.push(row);
    }
    if !rock.is_empty() {
        take(&mut rock);
    }
    Ok(())
}

/// All first crossings of one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The line.
    pub info: LineInfo,
    crossings: usize,
    repeated: usize,
    values: [Vec<f64>; LineQuantity::ALL.len()],
    /// What each of the [`HEIGHTS`] of these rocks can never lie below (m).
    least_m: [Vec<f64>; HEIGHTS.len()],
    largest: [Option<Largest>; LineQuantity::ALL.len()],
    /// Release numbers, in the order of the values; kept only where rocks may weigh differently.
    releases: Vec<u32>,
    weights: Option<Weights>,
    /// Release numbers of the rocks that may still come to it.
    open: Vec<usize>,
}

/// What `summary.json` says of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LineSummary {
    /// The line.
    #[serde(flatten)]
    pub info: LineInfo,
    /// Rocks that cross it, as a share of all that were released.
    pub reach: Proportion,
    /// Rocks that have not crossed it and may still come, with any energy: what is missing in the statistics. None of none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub may_still_come: Option<Proportion>,
    /// Rocks that cross it more than once; only their first crossing counts in the statistics.
    pub crossing_again: usize,
    /// Statistics by quantity, over first crossings.
    pub statistics: BTreeMap<String, Statistic>,
    /// How many rocks of each class come; none where all are of one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub by_class: Vec<ClassReach>,
}

impl Line {
    /// Without crossings.
    pub fn new(info: LineInfo) -> Self {
        Self {
            info,
            crossings: 0,
            repeated: 0,
            values: Default::default(),
            least_m: Default::default(),
            largest: Default::default(),
            releases: Vec::new(),
            weights: None,
            open: Vec::new(),
        }
    }

    /// Says which rocks may still come to it.
    pub fn leave_open(&mut self, open: impl Iterator<Item = usize>) {
        self.open = open.collect();
    }

    /// The same, of rocks that weigh what they stand for; how much is known when all have [come](Self::weigh).
    #[must_use]
    pub fn weighing(self, weights: Option<Weights>) -> Self {
        Self { weights: weights.filter(|weights| weights.strata() > 1), ..self }
    }

    /// Says what rocks stand for, now that all have come: only those that were released count.
    pub fn weigh(&mut self, weights: Option<&Weights>) {
        self.weights = self.weights.take().and(weights.cloned());
    }

    /// Adds the first crossing of a rock.
    pub fn add(&mut self, row: &CrossingRow) {
        self.crossings += 1;
        self.repeated += usize::from(row.times > 1);
        if self.weights.is_some() {
            self.releases.push(row.index as u32);
        }
        for (slot, quantity) in LineQuantity::ALL.into_iter().enumerate() {
            let value = quantity.of(row);
            self.values[slot].push(value);
            Largest::update(&mut self.largest[slot], row.index, value);
        }
        for (of, least_m) in self.least_m.iter_mut().zip(LineQuantity::least_heights_m(row)) {
            of.push(least_m);
        }
    }

    /// Rocks that cross it, as a share of so many released; where rocks weigh differently, of all events.
    pub fn reach(&self, released: usize) -> Proportion {
        if let Some(weights) = self.weights.as_ref().filter(|weights| !weights.are_equal()) {
            let crossed = self.releases.iter().map(|at| *at as usize);
            return share_up_to(weights, crossed, self.open.iter().copied());
        }
        let seen = Proportion::new(self.crossings, released);
        if self.open.is_empty() {
            return seen;
        }
        seen.up_to(&Proportion::new((self.crossings + self.open.len()).min(released), released))
    }

    /// Rocks that have not crossed it and may still come, as a share of so many released; none where there are none.
    pub fn may_still_come(&self, released: usize) -> Option<Proportion> {
        let weights = self.weights.clone().unwrap_or_else(|| Weights::equal(released));
        share_if_any(&weights, self.open.iter().copied())
    }

    /// Rocks that cross it more than once.
    pub fn crossing_again(&self) -> usize {
        self.repeated
    }

    /// All values of one quantity, sorted.
    pub fn sample(&self, quantity: LineQuantity) -> Sample {
        let sample = self.sample_of(&self.values[quantity as usize]);
        let Some(at) = HEIGHTS.iter().position(|height| *height == quantity) else { return sample };
        match self.sample_of(&self.least_m[at]).mean() {
            Some(least) => sample.not_below(least.value),
            None => sample,
        }
    }

    /// Values in the order of the rocks that crossed, each with what its rock stands for.
    fn sample_of(&self, values: &[f64]) -> Sample {
        let values = values.iter().copied();
        match &self.weights {
            None => Sample::of(values),
            Some(weights) => {
                let each = self.releases.iter().map(|at| *at as usize);
                Sample::of_releases(values.zip(each), weights)
            }
        }
    }

    /// Statistics of one quantity.
    pub fn statistic(&self, quantity: LineQuantity) -> Statistic {
        statistic(&self.sample(quantity), self.largest[quantity as usize])
    }

    /// All of it, among so many rocks released, of the classes of a frequency if there is one.
    pub fn summary(&self, released: usize, frequency: Option<&Frequency>) -> LineSummary {
        let of = |quantity: LineQuantity| (quantity.column().to_owned(), self.statistic(quantity));
        LineSummary {
            info: self.info.clone(),
            reach: self.reach(released),
            may_still_come: self.may_still_come(released),
            crossing_again: self.repeated,
            statistics: LineQuantity::ALL.into_iter().map(of).collect(),
            by_class: self.by_class(frequency),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::CrossingRow;

    /// A crossing of a sphere of 1 kg whose energy is all translational.
    pub(crate) fn row(
        index: usize,
        line: &str,
        time_s: f64,
        height_m: f64,
        total_j: f64,
    ) -> CrossingRow {
        CrossingRow {
            index,
            line: line.to_owned(),
            time_s,
            along_m: 0.0,
            height_m,
            speed_m_s: 1.0,
            translational_j: total_j,
            rotational_j: 0.0,
            height_normal_m: height_m,
            descent_deg: 0.0,
            mass_kg: 1.0,
            radius_m: 0.5,
            times: 1,
            position_m: [0.0; 3],
            top_m: None,
        }
    }
}
