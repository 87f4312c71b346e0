//! Sizes that a release table gives twice: as a radius and as a mass.

use crate::rock::Rock;
use crate::scene::{BothSizes, Scene, SizeFrom};

/// Share of the mass by which both may differ (–): a radius of three digits, 0.177 m, leaves as much of it open.
const ROUNDING: f64 = 0.01;

/// What the plan says of rows of the release table whose mass is not that of their radius; a warning, if the scene does not say which
/// counts.
pub(super) fn of_table(scene: &Scene, warnings: &mut Vec<String>) -> Option<String> {
    let density_kg_m3 = scene.rocks.density_kg_m3;
    let own_kg = |row: &BothSizes| Rock { radius_m: row.radius_m, density_kg_m3 }.mass_kg();
    let off = |row: &BothSizes| (own_kg(row) / row.mass_kg - 1.0).abs();
    let rows = || scene.release.blocks.iter().filter_map(|block| block.both);
    let wrong = rows().filter(|row| off(row) > ROUNDING).count();
    // the first of those that are off the most
    let most = rows().reduce(|most, row| if off(&row) > off(&most) { row } else { most })?;
    if wrong == 0 {
        return None;
    }
    let BothSizes { line, radius_m, mass_kg } = most;
    let stated = scene.release.size_from;
    let said = format!(
        "{wrong} of {} rows of {} have a mass_kg that is not that of their radius_m, line {line} the most: {mass_kg} kg, but {radius_m} m at {density_kg_m3} kg/m³ weigh {:.1} kg; {} is used",
        scene.release.blocks.len(),
        scene.release.table.as_ref()?.display(),
        own_kg(&most),
        stated.unwrap_or(SizeFrom::Radius).column()
    );
    if stated.is_some() {
        return Some(said);
    }
    warnings.push(format!("{said}, write [release] size_from = \"mass_kg\" to use the mass, \"radius_m\" to keep the radius"));
    None
}
