//! Measured ends beside the terrain: no computed rock can come there.

use crate::error::{Error, Result};
use crate::hazard::ObservedPath;
use crate::rock::Vec3;
use crate::scene::MeasuredEnds;
use crate::terrain::Terrain;

/// A measured place so far beside the terrain (m) is still taken: ends are measured to a metre or two.
const MEASURED_WITHIN_M: f64 = 2.0;

/// Measured ways, with a warning where some begin or end beside the terrain.
///
/// # Errors
/// As for [`ObservedPath::read`], and if most are beside it: then they are in other coordinates.
pub(super) fn read_ways(
    ends: &MeasuredEnds,
    terrain: &Terrain,
) -> Result<(Vec<ObservedPath>, Option<String>)> {
    let (low, high) = terrain.index.bounds();
    let bounds = [low + terrain.origin_m, high + terrain.origin_m];
    let ways = ObservedPath::read_lines(ends)?;
    let place_beside = |(line, way): &(u64, ObservedPath)| {
        let place = [way.start_m, way.end_m].into_iter().find(|at| is_beside(at, &bounds));
        place.map(|at| (*line, at))
    };
    let mut beside = ways.iter().filter_map(place_beside);
    let first = beside.next();
    let count = beside.count() + usize::from(first.is_some());
    let mut warning = None;
    if let Some((line, [x, y])) = first {
        let file = ends.file.display();
        let found = format!("found a place at [{x:.3}, {y:.3}], beside the terrain");
        if 2 * count > ways.len() {
            let [low, high] = bounds;
            let remedy = format!(
                "write map coordinates on it ({:.0}..{:.0} east, {:.0}..{:.0} north)",
                low.x, high.x, low.y, high.y
            );
            return Err(Error::input(&ends.file, format!("line {line}"), found, remedy));
        }
        warning = Some(format!(
            "{count} of {} measured ways begin or end beside the terrain, where no computed rock comes ({file}, line {line}: {found})",
            ways.len()
        ));
    }
    Ok((ways.into_iter().map(|(_, way)| way).collect(), warning))
}

/// Whether a place in map coordinates (m) is beside the box of the terrain.
fn is_beside(at: &[f64; 2], [low, high]: &[Vec3; 2]) -> bool {
    let is_within = |m: f64, from: f64, to: f64| {
        (from - MEASURED_WITHIN_M..=to + MEASURED_WITHIN_M).contains(&m)
    };
    !is_within(at[0], low.x, high.x) || !is_within(at[1], low.y, high.y)
}
