//! The lowest ground under lines and objects: what a rock must have the energy to come up to.

use crate::hazard::LineFloor;
use crate::plan::{EvaluationLine, Footprint, Part, Plan};
use crate::scene::Corner;

/// Length of the pieces that a line is looked at in (m): boxes round short ones hold few triangles beside it.
const PIECE_M: f64 = 2.0;

/// The floor of a line or object; none where some of it lies beside the terrain or over a hole, and where rocks can push
/// each other.
pub(super) fn floor(plan: &Plan, line: &EvaluationLine) -> Option<LineFloor> {
    if plan.rock_against_rock.is_kept() {
        return None;
    }
    let terrain = &plan.terrain;
    let local_m = match line.footprint {
        None => lowest_m(line.cut(PIECE_M), |ends| terrain.lowest_along(ends)),
        Some(footprint) => {
            let (boxes, reach_m) = boxes(line, footprint, largest_radius_m(plan)?)?;
            lowest_m(boxes, |within| terrain.lowest_in(grown(within, reach_m)))
        }
    }?;
    let ground_m = local_m + terrain.origin_m.z;
    Some(LineFloor { ground_m, gravity_m_s2: plan.gravity_m_s2 })
}

/// The lowest ground of the whole terrain; none where rocks can push each other.
pub(super) fn of_terrain(plan: &Plan) -> Option<LineFloor> {
    let (low, _) = plan.terrain.index.bounds();
    let ground_m = low.z + plan.terrain.origin_m.z;
    let is_known = !plan.rock_against_rock.is_kept() && ground_m.is_finite();
    is_known.then_some(LineFloor { ground_m, gravity_m_s2: plan.gravity_m_s2 })
}

/// The lowest of some; none if one is not known.
fn lowest_m(places: Vec<[Corner; 2]>, of: impl Fn([Corner; 2]) -> Option<f64>) -> Option<f64> {
    places.into_iter().try_fold(f64::INFINITY, |lowest, place| Some(of(place)?.min(lowest)))
}

/// The largest radius of a sphere; none where nothing bounds it, or where blocks reach farther.
fn largest_radius_m(plan: &Plan) -> Option<f64> {
    let Part::Kept(year) = &plan.year else { return None };
    let largest_m = year.largest_m.iter().copied().fold(0.0, f64::max);
    (largest_m.is_finite() && !plan.releases.has_blocks()).then_some(largest_m)
}

/// Boxes round an object, and how far beyond them a rock of some radius still hits it (m).
fn boxes(
    line: &EvaluationLine,
    footprint: Footprint,
    radius_m: f64,
) -> Option<(Vec<[Corner; 2]>, f64)> {
    match footprint {
        Footprint::Area => {
            let all = line.cut(f64::INFINITY).into_iter().map(around);
            Some((vec![all.reduce(both)?], radius_m))
        }
        Footprint::Strip { half_width_m } => {
            let reach_m = half_width_m + radius_m;
            let short = line.cut(reach_m.max(PIECE_M));
            Some((short.into_iter().map(around).collect(), reach_m))
        }
    }
}

/// The box round two places: south-western and north-eastern corner.
fn around([one, other]: [Corner; 2]) -> [Corner; 2] {
    let of = |end: fn(f64, f64) -> f64| [0, 1].map(|axis| end(one[axis], other[axis]));
    [of(f64::min), of(f64::max)]
}

/// The box round two boxes.
fn both([low, high]: [Corner; 2], [other_low, other_high]: [Corner; 2]) -> [Corner; 2] {
    [around([low, other_low])[0], around([high, other_high])[1]]
}

/// A box, larger by a distance on all sides (m).
fn grown([low, high]: [Corner; 2], by_m: f64) -> [Corner; 2] {
    [low.map(|at| at - by_m), high.map(|at| at + by_m)]
}
