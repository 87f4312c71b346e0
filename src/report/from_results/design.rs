//! What the rules of barriers ask for.

use super::super::model::{DesignView, Estimate, EstimateTable};
use super::estimate;
use crate::hazard::{BarrierSummary, Design};

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
