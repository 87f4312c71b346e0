//! What a scene's study looks at: quantities of whole journeys, and what passes the scene's lines.

use crate::hazard::{Open, Quantity, Row, StopKind};
use crate::plan::{EvaluationLine, Plan};
use crate::rock::Rock;
use crate::simulation::{Crossing, Trajectory};

/// Quantities of the study with what they are called and their units.
pub const QUANTITIES: [(Quantity, &str, &str); 3] = [
    (Quantity::Runout, "runout", "m"),
    (Quantity::MaxTotal, "energy", "J"),
    (Quantity::MaxHeight, "height", "m"),
];
/// Something that the study looks at.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyQuantity {
    /// In words.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// In tables.
    pub column: String,
    /// Where it is read.
    pub of: Of,
}

/// Where a value is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Of {
    /// A whole journey.
    Rock(Quantity),
    /// Height over the ground at the first crossing of a line.
    HeightAt(usize),
    /// Total energy there.
    EnergyAt(usize),
}

/// What has no value because the rock never came there.
pub(super) const NEVER: f64 = f64::NEG_INFINITY;

impl StudyQuantity {
    /// Each of [`QUANTITIES`], then height and energy at every line of the plan.
    pub(super) fn all(plan: &Plan) -> Vec<Self> {
        let whole = QUANTITIES.map(|(quantity, name, unit)| Self {
            name: name.to_owned(),
            unit,
            column: quantity.column().to_owned(),
            of: Of::Rock(quantity),
        });
        let at_line = |(line, evaluation_line): (usize, &EvaluationLine)| {
            let at = |what: &str, unit, of| Self {
                name: format!("{what} at \"{}\"", evaluation_line.name),
                unit,
                column: format!("{what}_at_line_{}", line + 1),
                of,
            };
            [at("height", "m", Of::HeightAt(line)), at("energy", "J", Of::EnergyAt(line))]
        };
        let lines = plan.recorders().lines.iter().enumerate().flat_map(at_line);
        whole.into_iter().chain(lines).collect()
    }

    /// Whether the value of each rock is only a bound, by how it ended, and on which side the truth lies.
    pub(super) fn bounds_of(&self, ended: &[StopKind]) -> Option<(Vec<bool>, Open)> {
        let Of::Rock(quantity) = self.of else { return None };
        let is_bound = ended.iter().map(|stop| quantity.is_bound_after(*stop));
        Some((is_bound.collect(), quantity.open()))
    }

    pub(super) fn value(&self, row: &Row, fall: &Trajectory) -> f64 {
        let at = |line: usize, value: fn(&Crossing, &Rock) -> f64| {
            let crossing = fall.crossings.iter().find(|crossing| crossing.line == line);
            crossing.map(|one| value(one, &fall.rock)).filter(|v| v.is_finite()).unwrap_or(NEVER)
        };
        match self.of {
            Of::Rock(quantity) => quantity.of(row),
            Of::HeightAt(line) => at(line, |crossing, _| crossing.height_m),
            Of::EnergyAt(line) => at(line, |crossing, rock| {
                crossing.motion.translational_j(rock) + crossing.rotational_j
            }),
        }
    }
}
