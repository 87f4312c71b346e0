//! What the rules of barriers ask for.

use super::super::format::significant;
use super::super::model::{DesignView, Estimate, EstimateTable, energy_unit};
use super::super::words::Words;
use super::estimate;
use crate::hazard::{BarrierSummary, Design, Rule};

/// Values of a design.
pub(super) fn design_view(design: &Design) -> DesignView {
    let of = |value: f64, [low, high]: [Option<f64>; 2]| estimate(value, low, high);
    DesignView {
        height_m: of(design.height_m, design.height_95_m),
        energy_j: of(design.energy_j, design.energy_95_j),
    }
}

/// What the rule of a barrier asks for, or how many rocks are missing; none without a rule.
pub(super) fn design(one: &BarrierSummary) -> Option<DesignView> {
    let lacking = Estimate::lacking(one.design_lacks);
    let lacking =
        (one.design_lacks > 0).then_some(DesignView { height_m: lacking, energy_j: lacking });
    one.design_values.as_ref().map(design_view).or(lacking)
}

/// Whether some barrier has a rule of design.
pub(super) fn has_design(all: &[BarrierSummary]) -> bool {
    all.iter().any(|one| one.barrier.design.is_some())
}

/// A table of barriers without its last two columns, height and energy of the design, where no barrier has a rule for them:
/// they would look as if too few rocks arrived.
pub(super) fn with_design_if_any(
    mut table: EstimateTable,
    all: &[BarrierSummary],
) -> EstimateTable {
    if has_design(all) {
        return table;
    }
    let kept = table.columns.len().saturating_sub(2);
    table.columns.truncate(kept);
    for (_, cells) in &mut table.rows {
        cells.truncate(kept);
    }
    table
}

/// The standard whose design energy is that of a design block.
const OF_A_BLOCK: &str = "UNI 11211-4";

/// Where the design energy comes from, and what its rule asks of the capacity; nothing where it is a percentile and no standard has it otherwise.
pub(super) fn energy_in_words((rule, design): (&Rule, &Design), words: &Words) -> String {
    let (unit, size) = energy_unit(design.energy_j);
    let energy = significant(design.energy_j / size, 3);
    let is_uni = rule.standard.as_deref() == Some(OF_A_BLOCK);
    let mut said = Vec::new();
    if let (Some(block), Some(speed_m_s)) = (rule.block, design.speed_percentile_m_s) {
        said.push(format!(
            "The design energy {energy} {unit} is that of the design block of {} m³ ({} kg without factors) at P{} of speed, {} m/s without factors.",
            significant(block.volume_m3, 3),
            significant(block.mass_kg, 4),
            rule.percentile,
            significant(speed_m_s, 3)
        ));
    } else if is_uni {
        said.push(format!(
            "The design energy is P{} of total energy with the squares of the factors on speed; the standard has that of its design block at P{} of speed, which block_volume_m3 asks for.",
            rule.percentile, rule.percentile
        ));
    }
    match (rule.capacity_factor, design.capacity_j) {
        (Some(factor), Some(capacity_j)) => said.push(format!(
            "The capacity must be {factor} times that, {} {unit}.",
            significant(capacity_j / size, 3)
        )),
        _ if is_uni => said.push(
            "The standard's factor on the energy of the barrier is not applied: its value is yours, capacity_factor takes it.".to_owned(),
        ),
        _ => {}
    }
    let each = said.iter().map(|one| words.say(one));
    std::iter::once(String::new()).chain(each).collect::<Vec<_>>().join(" ")
}
