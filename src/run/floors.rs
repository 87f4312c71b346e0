//! The lowest ground under lines and objects: what a rock must have the energy to come up to.

use crate::hazard::LineFloor;
use crate::plan::{EvaluationLine, Footprint, LinePiece, Part, Plan};
use crate::scene::Corner;
use crate::terrain::Terrain;

/// Length of the pieces that a line is looked at in, and distance of the places asked for ground (m).
const PIECE_M: f64 = 2.0;

/// The floor of a line or object; none where some of it lies beside the terrain or over a hole, and where rocks can push
/// each other.
pub(super) fn floor(plan: &Plan, line: &EvaluationLine) -> Option<LineFloor> {
    if plan.rock_against_rock.is_kept() {
        return None;
    }
    let reach_m = match line.footprint {
        None => 0.0,
        Some(Footprint::Area) => largest_radius_m(plan)?,
        Some(Footprint::Strip { half_width_m }) => half_width_m + largest_radius_m(plan)?,
    };
    let boxes = match line.footprint {
        Some(Footprint::Area) => vec![whole(line)?],
        _ => pieces(line, reach_m.max(PIECE_M)),
    };
    let grown = boxes.into_iter().map(|[low, high]| {
        [[low[0] - reach_m, low[1] - reach_m], [high[0] + reach_m, high[1] + reach_m]]
    });
    let lowest = grown.map(|within| lowest_m(&plan.terrain, within));
    let local_m = lowest.reduce(|one, other| Some(one?.min(other?)))??;
    let ground_m = local_m + plan.terrain.origin_m.z;
    Some(LineFloor { ground_m, gravity_m_s2: plan.gravity_m_s2 })
}

/// The largest radius of a sphere; none where nothing bounds it, or where blocks reach farther.
fn largest_radius_m(plan: &Plan) -> Option<f64> {
    let Part::Kept(year) = &plan.year else { return None };
    let largest_m = year.largest_m.iter().copied().fold(0.0, f64::max);
    (largest_m.is_finite() && !plan.releases.has_blocks()).then_some(largest_m)
}

/// Boxes round the pieces of a line, south-western and north-eastern corner (m, local).
fn pieces(line: &EvaluationLine, long_m: f64) -> Vec<[Corner; 2]> {
    let of_piece = |piece: &LinePiece| {
        let (from, way) = (piece.from_m, piece.way_m);
        let parts = (piece.length_m() / long_m).ceil().max(1.0);
        let at = move |k: u32| [0, 1].map(|axis| from[axis] + f64::from(k) / parts * way[axis]);
        (0..parts as u32).map(move |k| around(at(k), at(k + 1)))
    };
    line.pieces.iter().flat_map(of_piece).collect()
}

/// The box round all of a line.
fn whole(line: &EvaluationLine) -> Option<[Corner; 2]> {
    let pieces = pieces(line, f64::INFINITY).into_iter();
    pieces.reduce(|one, other| [around(one[0], other[0])[0], around(one[1], other[1])[1]])
}

/// The box round two places.
fn around(one: Corner, other: Corner) -> [Corner; 2] {
    let of = |end: fn(f64, f64) -> f64| [0, 1].map(|axis| end(one[axis], other[axis]));
    [of(f64::min), of(f64::max)]
}

/// No ground in a box is lower (m, local): the lowest corner of a triangle that comes into it. None where ground lacks.
fn lowest_m(terrain: &Terrain, [low, high]: [Corner; 2]) -> Option<f64> {
    let places = |axis: usize| {
        let parts = ((high[axis] - low[axis]) / PIECE_M).ceil().max(1.0);
        let width = high[axis] - low[axis];
        (0..=parts as u32).map(move |k| low[axis] + f64::from(k) / parts * width)
    };
    let mut all = places(0).flat_map(|x| places(1).map(move |y| (x, y)));
    if !all.all(|(x, y)| terrain.ground_below(x, y).is_some()) {
        return None;
    }
    let mut lowest_m = f64::INFINITY;
    terrain.index.over_way([low, high], f64::INFINITY, |start, count| {
        for triangle in (start..start + count).filter(|t| !terrain.is_tree(*t)) {
            lowest_m = terrain.corners_m(triangle).iter().map(|c| c.z).fold(lowest_m, f64::min);
        }
    });
    Some(lowest_m)
}
