//! Gaps: stretches where borders of the slope face each other across a distance that is small beside their edges.

use super::LEAST_FLAT;
use super::near::PlanCells;
use crate::groups::Groups;
use crate::math;
use crate::parallel;
use crate::rock::Vec3;
use crate::terrain::stl::area_vector;
use crate::terrain::weld::Welded;
use crate::terrain::weld::parts::Parts;

/// Widest gap over the median length of border edges (–): a missing row of cells, but not the mouth of a gully.
const WIDEST: f64 = 3.0;
/// Least length of a gap over the median length of border edges, and over its own width (–): not a hole of a cell or two.
const LEAST_LENGTH: (f64, f64) = (5.0, 3.0);
/// Least cosine between the directions in which two borders look, one turned round, and between either and the way across (–).
const FACING: f64 = 0.5;
/// Borders of tiles that meet are known to this share of the median length of border edges (–).
const ABOVE: f64 = 0.05;
/// More border edges than this are those of a mesh in shreds, not of gaps.
pub(super) const MOST_BORDERS: usize = 400_000;
/// How many points long borders are cut into, all together.
const MOST_POINTS: f64 = 1e6;

/// A stretch where two borders face each other. Places are map coordinates (m).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Gap {
    /// Numbers of the parts on its two sides, from 1 on, the largest part first; the same one where it lies in a part.
    pub parts: [usize; 2],
    /// Length along the border (m).
    pub length_m: f64,
    /// Distance between the borders (m): median.
    pub width_m: f64,
    /// The largest.
    pub widest_m: f64,
    /// A place near its middle (m).
    pub at_m: [f64; 3],
    /// The farthest that a corner of one border is from all of the edge of the other that lies before it (m).
    #[serde(skip)]
    corners_m: f64,
}

/// Tolerance over the distance of the corners that it welds (–).
const CLOSING: f64 = 1.02;
/// Largest tolerance that is proposed, over the edges that 5 % are shorter than (–): corners of one triangle must stay apart.
const LARGEST_TOLERANCE: f64 = 0.1;

/// The tolerance, of two digits, that welds the corners of all gaps whose corners lie before each other, near beside the edges.
pub(super) fn closing_m(gaps: &[Gap], short_edge_m: f64) -> Option<f64> {
    let most_m = LARGEST_TOLERANCE * short_edge_m;
    let fitting = gaps.iter().map(|gap| CLOSING * gap.corners_m).filter(|m| *m <= most_m);
    fitting.reduce(f64::max).map(math::rounded_up)
}

/// A border edge of the slope.
#[derive(Debug, Clone, Default)]
struct Border {
    ends_m: [Vec3; 2],
    /// Unit vector in plan view that points away from its triangle.
    out: Vec3,
    part: u32,
}

/// A point on a border.
#[derive(Debug, Clone)]
struct BorderSpot {
    border: u32,
    at_m: Vec3,
    /// Length that it stands for (m).
    length_m: f64,
}

/// The nearest place of a border that a point faces.
#[derive(Debug, Clone, Copy)]
struct Facing {
    width_m: f64,
    /// Middle of the way across (m).
    middle_m: Vec3,
    parts: [u32; 2],
    /// The border.
    border: u32,
}

/// The gaps of the slope, the longest first.
pub(super) fn gaps(
    welded: &Welded,
    parts: &Parts,
    is_slope: &(dyn Fn(u32) -> bool + Sync),
) -> Vec<Gap> {
    let sides = welded.edges.borders();
    if sides.len() > MOST_BORDERS {
        return Vec::new();
    }
    let borders: Vec<Border> = parallel::filter_map(sides.len(), |k| {
        Some(sides[k])
            .filter(|side| is_slope(side / 3))
            .and_then(|side| border(welded, parts, side))
    });
    let mut lengths: Vec<f64> = borders.iter().map(Border::length_m).collect();
    if lengths.is_empty() {
        return Vec::new();
    }
    let spacing_m = (lengths.iter().sum::<f64>() / MOST_POINTS).max(median(&mut lengths));
    let facing = all_facing(&borders, spacing_m);
    let mut found: Vec<Gap> = groups(&facing, spacing_m)
        .into_iter()
        .filter_map(|group| gap(welded, &borders, &facing, (group, spacing_m)))
        .collect();
    found.sort_by(|a, b| b.length_m.total_cmp(&a.length_m));
    found
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// A border edge with the side to which it looks; none of a steep triangle.
fn border(welded: &Welded, parts: &Parts, side: u32) -> Option<Border> {
    let triangle = side / 3;
    let corners = welded.corners_m(triangle as usize);
    let [a, b, c] = [0, 1, 2].map(|k| corners[(side as usize + k) % 3]);
    let area = area_vector(&corners);
    let along = b - a;
    let across = Vec3::new(along.y, -along.x, 0.0);
    let away = if across.dot(&(a - c)) < 0.0 { -across } else { across };
    let is_flat = area.z.abs() > LEAST_FLAT * area.norm();
    let out = away.try_normalize(0.0).filter(|_| is_flat)?;
    Some(Border { ends_m: [a, b], out, part: parts.of[triangle as usize] })
}

impl Border {
    fn length_m(&self) -> f64 {
        (self.ends_m[1] - self.ends_m[0]).norm()
    }

    /// How far its ends are from the nearest of another one at most (m).
    fn corners_apart_m(&self, other: &Self) -> f64 {
        let [a, b] = self.ends_m.map(|end| {
            let [c, d] = other.ends_m.map(|at| (at - end).norm());
            c.min(d)
        });
        a.max(b)
    }

    fn nearest(&self, place: &Vec3) -> Vec3 {
        let [a, b] = self.ends_m;
        let along = b - a;
        let share = (place - a).dot(&along) / along.norm_squared();
        a + along * share.clamp(0.0, 1.0)
    }

    fn spots(&self, number: u32, spacing_m: f64) -> impl Iterator<Item = BorderSpot> + '_ {
        let [a, b] = self.ends_m;
        let count = (self.length_m() / spacing_m).ceil().max(1.0) as u32;
        let share = move |k: u32| (f64::from(k) + 0.5) / f64::from(count);
        let length_m = self.length_m() / f64::from(count);
        (0..count).map(move |k| BorderSpot {
            border: number,
            at_m: a + (b - a) * share(k),
            length_m,
        })
    }
}

/// Points of the borders that face another border, with the way across.
fn all_facing(borders: &[Border], spacing_m: f64) -> Vec<(BorderSpot, Facing)> {
    let spots: Vec<BorderSpot> =
        (0..).zip(borders).flat_map(|(k, border)| border.spots(k, spacing_m)).collect();
    let places: Vec<Vec3> = spots.iter().map(|spot| spot.at_m).collect();
    let reach_m = WIDEST * spacing_m;
    let cells = PlanCells::of(&places, reach_m + spacing_m);
    parallel::filter_map(spots.len(), |k| {
        let (spot, own) = (&spots[k], &borders[spots[k].border as usize]);
        let to_others = cells.near(&spot.at_m).filter_map(|other| {
            let number = spots[other as usize].border;
            let border = &borders[number as usize];
            let way = border.nearest(&spot.at_m) - spot.at_m;
            let is_near = (f64::MIN_POSITIVE..=reach_m).contains(&way.norm());
            (is_near && looks_at(own, border, (way, spacing_m))).then_some((number, way))
        });
        // the nearest of all: one that is farther on may look across where the nearest lies beside it
        let (number, way) =
            to_others.min_by(|a, b| a.1.norm_squared().total_cmp(&b.1.norm_squared()))?;
        let border = &borders[number as usize];
        let facing = || Facing {
            width_m: way.norm(),
            middle_m: spot.at_m + 0.5 * way,
            parts: [own.part.min(border.part), own.part.max(border.part)],
            border: number,
        };
        is_across(own, border, (way, spacing_m)).then(|| (spot.clone(), facing()))
    })
}

/// Whether two borders look at each other, or overlap by no more than tiles do that meet.
fn looks_at(own: &Border, other: &Border, (way, spacing_m): (Vec3, f64)) -> bool {
    own.out.dot(&other.out) < -FACING && ahead_m(own, other, way) >= -ABOVE * spacing_m
}

/// How far the way between two borders goes to where both look (m); less than 0 where they overlap.
fn ahead_m(own: &Border, other: &Border, way: Vec3) -> f64 {
    own.out.dot(&way).min(-other.out.dot(&way))
}

/// Whether a way leads across, and not along two borders, of which one ends. On a slope the shortest way between borders of unlike height
/// goes along them too, and between tiles that meet it goes anywhere.
fn is_across(own: &Border, other: &Border, (way, spacing_m): (Vec3, f64)) -> bool {
    let ahead_m = ahead_m(own, other, way).max(0.0);
    way.norm() <= ABOVE * spacing_m || FACING * way.xy().norm() <= ahead_m + way.z.abs()
}

/// Points that follow each other along the same two parts.
fn groups(facing: &[(BorderSpot, Facing)], spacing_m: f64) -> Vec<Vec<u32>> {
    let places: Vec<Vec3> = facing.iter().map(|(spot, _)| spot.at_m).collect();
    let near_m = WIDEST * spacing_m;
    let cells = PlanCells::of(&places, near_m);
    let mut groups = Groups::of(facing.len());
    for (k, (spot, facing_k)) in (0u32..).zip(facing) {
        for other in cells.near(&spot.at_m).filter(|&other| other < k) {
            let (beside, facing_other) = &facing[other as usize];
            let is_near = (beside.at_m - spot.at_m).norm() <= near_m;
            if is_near && facing_other.parts == facing_k.parts {
                groups.join(k, other);
            }
        }
    }
    groups.lists()
}

/// What a group of points makes; nothing where it is short.
fn gap(
    welded: &Welded,
    borders: &[Border],
    facing: &[(BorderSpot, Facing)],
    (group, spacing_m): (Vec<u32>, f64),
) -> Option<Gap> {
    let members = || group.iter().map(|&k| &facing[k as usize]);
    let parts = members().next()?.1.parts;
    let length_of = |part: u32| -> f64 {
        let on_side = members().filter(|(spot, _)| borders[spot.border as usize].part == part);
        on_side.map(|(spot, _)| spot.length_m).sum()
    };
    // both sides of a gap within a part are of that part
    let length_m = match parts {
        [a, b] if a == b => 0.5 * length_of(a),
        [a, b] => length_of(a).max(length_of(b)),
    };
    let mut widths: Vec<f64> = members().map(|(_, facing)| facing.width_m).collect();
    let widest_m = widths.iter().copied().fold(0.0, f64::max);
    let width_m = median(&mut widths);
    if length_m < LEAST_LENGTH.0 * spacing_m || length_m < LEAST_LENGTH.1 * width_m {
        return None;
    }
    let sum: Vec3 = members().map(|(_, facing)| facing.middle_m).sum();
    let middle = sum / group.len() as f64;
    let off = |facing: &Facing| (facing.middle_m - middle).norm_squared();
    let at = members().map(|(_, facing)| facing).min_by(|a, b| off(a).total_cmp(&off(b)))?;
    let corners = members().map(|(spot, facing)| {
        borders[spot.border as usize].corners_apart_m(&borders[facing.border as usize])
    });
    let corners_m = corners.fold(0.0, f64::max);
    let parts = parts.map(|part| part as usize + 1);
    let at_m = welded.on_map(at.middle_m).into();
    Some(Gap { parts, length_m, width_m, widest_m, at_m, corners_m })
}
