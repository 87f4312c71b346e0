//! Where rocks are likely to come from: the largest steep face of a terrain, high above its foot.
//!
//! Triangles are gathered in square cells, steep cells that touch are one face, and a line is drawn through the face along
//! its strike. It is a proposal for a scene's release line, not a survey.

use super::Terrain;
use crate::rock::Vec3;
use std::collections::BTreeMap;

/// Cosine of the slope from which on ground is a cliff: 45°, steeper than talus stands (–).
const CLIFF_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Where less than this share of the area is so steep, the steepest part of this share is taken (–).
const STEEPEST_SHARE: f64 = 0.02;
/// A face that is no cliff has at least this share of the area (–).
const LEAST_SHARE: f64 = 0.5 * STEEPEST_SHARE;
/// Cosines that differ by less are those of one slope (–).
const COSINE_ROUNDING: f64 = 1e-9;
/// Cells along the longer side of the terrain.
const CELLS: f64 = 100.0;
/// Halvings of a line that is longer than the terrain is wide.
const MOST_HALVINGS: i32 = 8;
/// Most corners of the line.
const MOST_CORNERS: usize = 9;

/// The face that a scene may begin with.
#[derive(Debug, Clone, PartialEq)]
pub struct Cliff {
    /// A line through it along its strike, two corners or more, each with the height of the face there, map coordinates (m).
    pub line_m: Vec<[f64; 3]>,
    /// Its mean normal, upwards: level and towards the valley where it is a wall.
    pub normal: Vec3,
    /// Area of its steep triangles (m²).
    pub area_m2: f64,
    /// Its lowest and highest place, map coordinates (m).
    pub heights_m: [f64; 2],
    /// Slope from which on its triangles count as steep, as a cosine (–).
    pub cosine: f64,
}

/// A triangle of the slope.
struct SlopeFace {
    centre: Vec3,
    /// Unit normal, upwards.
    normal: Vec3,
    area_m2: f64,
}

/// What lies in one cell.
#[derive(Default)]
struct SteepCell {
    area_m2: f64,
    steep_m2: f64,
    /// Sums over the steep triangles, weighted by area.
    centre: Vec3,
    normal: Vec3,
    low_high: Option<[f64; 2]>,
}

/// The steep face with the most area times height above the lowest ground; none of a level terrain.
///
/// Where no face is larger than a cell, or where none is a cliff and all are small, as the steepest triangles of a rough slope lie apart,
/// more of it counts as steep.
pub fn main_cliff(terrain: &Terrain) -> Option<Cliff> {
    let faces = faces(terrain);
    let all_m2 = faces.iter().map(|face| face.area_m2).sum::<f64>();
    let (low, high) = terrain.index.bounds();
    // a cell holds some triangles even of a coarse mesh
    let mean_m2 = all_m2 / faces.len() as f64;
    let cell_m = ((high - low).xy().max() / CELLS).max(2.0 * (2.0 * mean_m2).sqrt());
    let is_large = |cliff: &Cliff| {
        let least_m2 = if cliff.cosine > CLIFF_COSINE { LEAST_SHARE * all_m2 } else { 0.0 };
        cliff.area_m2 >= least_m2.max(cell_m * cell_m)
    };
    let shares = std::iter::successors(Some(STEEPEST_SHARE), |share| Some(2.0 * share));
    let shares = shares.take_while(|share| *share < 2.0);
    let found = shares.filter_map(|share| steepest(terrain, (&faces, cell_m), share));
    let mut largest: Option<Cliff> = None;
    for cliff in found {
        if is_large(&cliff) {
            return Some(cliff);
        }
        largest = largest.filter(|known| known.area_m2 >= cliff.area_m2).or(Some(cliff));
    }
    largest
}

/// The steep face worth most where at least such a share of the area counts as steep.
fn steepest(terrain: &Terrain, (faces, cell_m): (&[SlopeFace], f64), share: f64) -> Option<Cliff> {
    let cosine = steep_from(faces, share)?;
    let (low, _) = terrain.index.bounds();
    let cells = gathered(faces, cosine, cell_m);
    let worth = |face: &Vec<&SteepCell>| -> f64 {
        face.iter().map(|cell| cell.centre.z - cell.steep_m2 * low.z).sum()
    };
    let connected = connected(&cells);
    let face = connected.iter().max_by(|a, b| worth(a).total_cmp(&worth(b)))?;
    let heights = face.iter().filter_map(|cell| cell.low_high);
    let [foot, top] = heights.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    let on_ground = |at: &Vec3| terrain.ground_below(at.x, at.y).is_some();
    let normal = face.iter().map(|cell| cell.normal).sum::<Vec3>().normalize();
    let mut line = along_strike(face, (&normal, cell_m), on_ground);
    line.retain(on_ground);
    let origin_m = terrain.origin_m;
    (line.len() > 1).then(|| Cliff {
        line_m: line.iter().map(|at| (at + origin_m).into()).collect(),
        normal,
        area_m2: face.iter().map(|cell| cell.steep_m2).sum(),
        heights_m: [foot + origin_m.z, top + origin_m.z],
        cosine,
    })
}

/// The triangles of the slope; trees are none.
fn faces(terrain: &Terrain) -> Vec<SlopeFace> {
    let slope = (0..terrain.triangles.len() as u32).filter(|&triangle| !terrain.is_tree(triangle));
    slope
        .map(|triangle| {
            let [a, b, c] = terrain.corners_m(triangle);
            let across = (b - a).cross(&(c - a));
            let up = if across.z < 0.0 { -across } else { across };
            // welded triangles have an area
            let normal = up / up.norm();
            SlopeFace { centre: (a + b + c) / 3.0, normal, area_m2: 0.5 * up.norm() }
        })
        .collect()
}

/// Cosine of the slope from which on ground counts as steep, a share of the area or more; none where all of it is level.
fn steep_from(faces: &[SlopeFace], share: f64) -> Option<f64> {
    let mut by_slope: Vec<(f64, f64)> =
        faces.iter().map(|face| (face.normal.z, face.area_m2)).collect();
    by_slope.sort_by(|a, b| a.0.total_cmp(&b.0));
    let wanted = share.min(1.0) * by_slope.iter().map(|(_, area)| area).sum::<f64>();
    let mut sum = 0.0;
    let at_share = by_slope.iter().find(|(_, area)| {
        sum += area;
        sum >= wanted
    });
    // the last bit of a level plane is no slope
    let found = at_share.map(|(cosine, _)| cosine.max(CLIFF_COSINE));
    found.filter(|cosine| *cosine < 1.0 - COSINE_ROUNDING)
}

/// The triangles in square cells, by column and row.
fn gathered(faces: &[SlopeFace], cosine: f64, cell_m: f64) -> BTreeMap<(i64, i64), SteepCell> {
    let mut cells: BTreeMap<(i64, i64), SteepCell> = BTreeMap::new();
    for SlopeFace { centre, normal, area_m2 } in faces {
        let number = |at: f64| (at / cell_m).floor() as i64;
        let cell = cells.entry((number(centre.x), number(centre.y))).or_default();
        cell.area_m2 += area_m2;
        // the triangles of an even slope differ by rounding
        if normal.z <= cosine + COSINE_ROUNDING {
            cell.steep_m2 += area_m2;
            cell.centre += centre * *area_m2;
            cell.normal += normal * *area_m2;
            let [low, high] = cell.low_high.unwrap_or([centre.z; 2]);
            cell.low_high = Some([low.min(centre.z), high.max(centre.z)]);
        }
    }
    // on an uneven slope the steepest triangles may lie apart, and fill half of no cell
    let share = |cell: &SteepCell| cell.steep_m2 / cell.area_m2;
    let least = cells.values().map(share).fold(0.0, f64::max).min(0.5);
    cells.retain(|_, cell| cell.steep_m2 > 0.0 && share(cell) >= least);
    cells
}

/// Cells that touch, also at a corner, are one face.
fn connected(cells: &BTreeMap<(i64, i64), SteepCell>) -> Vec<Vec<&SteepCell>> {
    let mut left: BTreeMap<(i64, i64), &SteepCell> =
        cells.iter().map(|(at, cell)| (*at, cell)).collect();
    let mut faces = Vec::new();
    while let Some((first, cell)) = left.pop_first() {
        let (mut face, mut open) = (vec![cell], vec![first]);
        while let Some((column, row)) = open.pop() {
            for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                let near = (column + dx, row + dy);
                if let Some(cell) = left.remove(&near) {
                    face.push(cell);
                    open.push(near);
                }
            }
        }
        faces.push(face);
    }
    faces
}

/// Corners along the strike of a face, each the middle of the cells in its stretch. A face of one stretch has a line across
/// its middle, as long as it finds ground.
fn along_strike(
    face: &[&SteepCell],
    (normal, cell_m): (&Vec3, f64),
    on_ground: impl Fn(&Vec3) -> bool,
) -> Vec<Vec3> {
    let level = normal.xy().norm();
    let strike = if level > 0.0 { [-normal.y / level, normal.x / level] } else { [1.0, 0.0] };
    let middle = |cell: &SteepCell| [cell.centre.x / cell.steep_m2, cell.centre.y / cell.steep_m2];
    let along = |at: [f64; 2]| at[0] * strike[0] + at[1] * strike[1];
    let places = || face.iter().map(|cell| along(middle(cell)));
    let (from, to) = places()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)));
    if to - from < cell_m {
        let all: f64 = face.iter().map(|cell| cell.steep_m2).sum();
        let at = face.iter().map(|cell| cell.centre).sum::<Vec3>() / all;
        let across = Vec3::new(strike[0], strike[1], 0.0) * (0.5 * cell_m);
        let ends = |k: i32| [at - across * 0.5_f64.powi(k), at + across * 0.5_f64.powi(k)];
        let held = (0..MOST_HALVINGS).map(ends).find(|ends| ends.iter().all(&on_ground));
        return held.map_or_else(Vec::new, Vec::from);
    }
    let stretches = (((to - from) / cell_m) as usize + 1).clamp(2, MOST_CORNERS);
    let stretch_of = |cell: &SteepCell| {
        let share = (along(middle(cell)) - from) / (to - from);
        ((share * stretches as f64) as usize).min(stretches - 1)
    };
    let mut sums = vec![(Vec3::zeros(), 0.0); stretches];
    for cell in face {
        let sum = &mut sums[stretch_of(cell)];
        *sum = (sum.0 + cell.centre, sum.1 + cell.steep_m2);
    }
    sums.iter().filter(|(_, area)| *area > 0.0).map(|(sum, area)| sum / *area).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::terrain::Sheet;
    use crate::terrain::stl::Soup;
    use crate::terrain::weld::{Piece, Up, weld};
    use std::path::Path;

    /// Cells of 1 m over 40 by 40 m, heights by a function.
    fn terrain(height_m: impl Fn(f64, f64) -> f64) -> Terrain {
        let at = |x: i32, y: i32| {
            let (x, y) = (f64::from(x), f64::from(y));
            Vec3::new(x, y, height_m(x, y))
        };
        let cells = (0..40).flat_map(|x| (0..40).map(move |y| (x, y)));
        let facets = cells.flat_map(|(x, y)| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            [[a, b, c], [a, c, d]]
        });
        let soup = Soup::from(facets.collect::<Vec<_>>());
        let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
        let welded = weld(&[piece], Vec3::zeros(), None).unwrap();
        Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }])
    }

    /// A face of 60° between y = 10 and 20 that falls to larger y: the line runs along x through its middle, at y = 15.
    #[test]
    fn the_line_runs_along_the_face() {
        let face = |_: f64, y: f64| -3f64.sqrt() * (y - 10.0).clamp(0.0, 10.0) - 0.2 * y;
        let cliff = main_cliff(&terrain(face)).unwrap();
        assert!(cliff.line_m.len() >= 5, "{:?}", cliff.line_m);
        assert!(cliff.line_m.iter().all(|at| (at[1] - 15.0).abs() < 1.0), "{:?}", cliff.line_m);
        let ends = [cliff.line_m[0][0], cliff.line_m[cliff.line_m.len() - 1][0]];
        assert!((ends[0] - ends[1]).abs() > 25.0, "{ends:?}");
        // 40 m wide, 10 m in plan, falling 1.932 m a metre: 870 m²
        assert!((cliff.area_m2 / 870.0 - 1.0).abs() < 0.1, "{}", cliff.area_m2);
        assert!((cliff.cosine - CLIFF_COSINE).abs() < 1e-12);
    }

    /// Of two faces of one size the upper one is taken.
    #[test]
    fn the_higher_face_is_taken() {
        let step = |y: f64, from: f64| -2.0 * (y - from).clamp(0.0, 5.0);
        let cliff = main_cliff(&terrain(|_, y| step(y, 5.0) + step(y, 25.0) - 0.1 * y)).unwrap();
        assert!(cliff.line_m.iter().all(|at| (at[1] - 7.5).abs() < 1.5), "{:?}", cliff.line_m);
    }

    /// Without a cliff its steepest part serves; level ground has none.
    #[test]
    fn gentle_ground_has_its_steepest_part() {
        let hill = main_cliff(&terrain(|x, _| 0.01 * (x - 40.0).powi(2))).unwrap();
        assert!(hill.line_m.iter().all(|at| at[0] < 6.0), "{:?}", hill.line_m);
        assert_eq!(main_cliff(&terrain(|_, _| 3.0)), None);
        // an even slope is steep all over, whatever rounding makes of its triangles
        let even = main_cliff(&terrain(|x, y| -0.3 * x - 0.27 * y)).unwrap();
        assert!(even.area_m2 > 1500.0, "{even:?}");
    }

    /// On a rough slope the steepest triangles lie apart: none of them alone is a face, and more of the slope counts as steep.
    #[test]
    fn a_rough_slope_has_a_face_too() {
        let rough =
            |x: f64, y: f64| 0.05 * (math::sin(x * 12.9898 + y * 78.233) * 43_758.545).fract();
        for slope in [0.3, 0.85, 1.0] {
            let cliff = main_cliff(&terrain(|x, y| -slope * y + rough(x, y))).unwrap();
            assert!(cliff.area_m2 > 16.0, "{slope}: {} m²", cliff.area_m2);
            assert!(
                cliff.heights_m[1] > cliff.heights_m[0] + 1.0,
                "{slope}: {:?}",
                cliff.heights_m
            );
        }
    }
}
