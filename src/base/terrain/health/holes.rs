//! Inner holes: borders that the slope goes all round.

use super::Found;
use super::gaps::MOST_BORDERS;
use crate::groups::Groups;
use crate::rock::Vec3;
use crate::terrain::weld::Welded;

/// Most edges of a hole behind which it is asked whether there is slope of another part.
const MOST_PROBES: usize = 16;
/// How far behind the border that is asked, over the edge's length (–): beyond the seam of a patch that closes the hole.
const BEHIND: f64 = 0.1;

/// A place without ground in the slope. Places are map coordinates (m).
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Hole {
    /// Area in plan view (m²).
    pub area_m2: f64,
    /// West, south, east and north (m).
    pub box_m: [f64; 4],
    /// The middle of its border (m).
    pub at_m: [f64; 3],
}

/// A border edge in plan view, with the way out of its triangle, as long as it is.
#[derive(Debug, Clone, Copy)]
struct HoleEdge {
    ends: [u32; 2],
    middle_m: Vec3,
    out_m: Vec3,
}

/// The holes of the slope, the largest first.
pub(super) fn holes(welded: &Welded, is_slope: &(dyn Fn(u32) -> bool + Sync)) -> Found<Hole> {
    let sides: Vec<u32> =
        welded.edges.borders().into_iter().filter(|side| is_slope(side / 3)).collect();
    if sides.is_empty() || sides.len() > MOST_BORDERS {
        return Found::default();
    }
    let rims: Vec<HoleEdge> = sides.into_iter().map(|side| rim(welded, side)).collect();
    let loops = loops(&rims);
    let open: Vec<(Hole, Vec<Vec3>)> = loops.iter().filter_map(|one| hole(welded, one)).collect();
    let covered = covered(welded, &open, is_slope);
    let is_open = |(k, (_, probes)): &(usize, (Hole, Vec<Vec3>))| 2 * covered[*k] < probes.len();
    let found = open.into_iter().enumerate().filter(is_open).map(|(_, (hole, _))| hole);
    Found::largest(found.collect(), |hole| hole.area_m2)
}

fn rim(welded: &Welded, side: u32) -> HoleEdge {
    let (triangle, k) = (side as usize / 3, side as usize % 3);
    let at = |k: usize| welded.triangles[triangle][k % 3];
    let [a, b, c] = [k, k + 1, k + 2].map(|k| welded.vertices_m[at(k) as usize]);
    let across = Vec3::new(b.y - a.y, a.x - b.x, 0.0);
    let out_m = if across.dot(&(a - c)) < 0.0 { -across } else { across };
    HoleEdge { ends: [at(k), at(k + 1)], middle_m: 0.5 * (a + b), out_m }
}

/// Edges that hang together.
fn loops(rims: &[HoleEdge]) -> Vec<Vec<HoleEdge>> {
    let mut corners: Vec<u32> = rims.iter().flat_map(|rim| rim.ends).collect();
    corners.sort_unstable();
    corners.dedup();
    let place = |corner: u32| corners.partition_point(|&other| other < corner) as u32;
    let mut groups = Groups::of(corners.len());
    for rim in rims {
        groups.join(place(rim.ends[0]), place(rim.ends[1]));
    }
    let mut all: Vec<(u32, HoleEdge)> =
        rims.iter().map(|rim| (groups.lowest(place(rim.ends[0])), *rim)).collect();
    all.sort_by_key(|(group, _)| *group);
    all.chunk_by(|a, b| a.0 == b.0).map(|one| one.iter().map(|(_, rim)| *rim).collect()).collect()
}

/// A loop as a hole, with places behind its border; none where the slope lies inside.
///
/// `2 A = ∮ x · n dl`, with `n` out of the slope: of a hole it comes out negative, whichever way triangles are wound.
fn hole(welded: &Welded, rims: &[HoleEdge]) -> Option<(Hole, Vec<Vec3>)> {
    let start = rims.first()?.middle_m;
    let around = rims.iter().map(|rim| (rim.middle_m - start).dot(&rim.out_m)).sum::<f64>();
    let length_m: f64 = rims.iter().map(|rim| rim.out_m.norm()).sum();
    let area_m2 = -0.5 * around;
    // narrower than what is welded it is no hole
    if area_m2 <= length_m * welded.tolerance_m.max(f64::EPSILON * length_m) {
        return None;
    }
    let corners = || rims.iter().flat_map(|rim| rim.ends).map(|k| welded.vertices_m[k as usize]);
    let (low, high) =
        corners().fold((start, start), |(low, high), at| (low.inf(&at), high.sup(&at)));
    let [low, high] = [low, high].map(|at| welded.on_map(at));
    let middle = rims.iter().map(|rim| rim.middle_m * rim.out_m.norm()).sum::<Vec3>() / length_m;
    let every = rims.len().div_ceil(MOST_PROBES);
    let probes = rims.iter().step_by(every).map(|rim| rim.middle_m + BEHIND * rim.out_m).collect();
    let box_m = [low.x, low.y, high.x, high.y];
    Some((Hole { area_m2, box_m, at_m: welded.on_map(middle).into() }, probes))
}

/// How many places of each hole have slope above or below.
fn covered(
    welded: &Welded,
    holes: &[(Hole, Vec<Vec3>)],
    is_slope: &(dyn Fn(u32) -> bool + Sync),
) -> Vec<usize> {
    let places: Vec<(usize, Vec3)> = (0..)
        .zip(holes)
        .flat_map(|(k, (_, probes))| probes.iter().map(move |probe| (k, *probe)))
        .collect();
    if places.is_empty() {
        return Vec::new();
    }
    let mut by_x: Vec<(f64, u32)> =
        (0..).zip(&places).map(|(k, (_, place))| (place.x, k)).collect();
    by_x.sort_by(|a, b| a.0.total_cmp(&b.0));
    let under = |t: u32| -> Option<Vec<u32>> {
        let corners = welded.corners_m(t as usize);
        let [low, high] = [f64::min, f64::max]
            .map(|of: fn(f64, f64) -> f64| of(of(corners[0].x, corners[1].x), corners[2].x));
        let first = by_x.partition_point(|(x, _)| *x < low);
        let near = by_x[first..].iter().take_while(|(x, _)| *x <= high);
        let found: Vec<u32> = near
            .filter(|(_, k)| is_inside(&corners, &places[*k as usize].1))
            .map(|(_, k)| *k)
            .collect();
        (!found.is_empty() && is_slope(t)).then_some(found)
    };
    let mut is_covered = vec![false; places.len()];
    let triangles = 0..welded.triangles.len() as u32;
    for k in triangles.filter_map(under).flatten() {
        is_covered[k as usize] = true;
    }
    let mut counts = vec![0; holes.len()];
    for ((hole, _), covered) in places.iter().zip(is_covered) {
        counts[*hole] += usize::from(covered);
    }
    counts
}

/// Whether a triangle lies above or below a place.
fn is_inside(corners: &[Vec3; 3], place: &Vec3) -> bool {
    let side = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        (b.x - a.x) * (place.y - a.y) - (b.y - a.y) * (place.x - a.x)
    };
    let sides = [0, 1, 2].map(side);
    sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
}
