//! The lowest ground along a way and in a box in plan view, where there is ground everywhere.

use super::{Terrain, edges};
use crate::math;
use crate::rock::Vec3;

/// A place or a box side in plan view (m, local).
type PlanPlace = [f64; 2];

/// A crack narrower than this is none (m): rounding along a way.
const CRACK_M: f64 = 1e-6;
/// So far beside the edge at which a sheet ends it is seen whether another one goes on (m).
const BESIDE_M: f64 = 1e-3;

impl Terrain {
    /// The lowest ground under a straight way in plan view (m, local), exactly: of all triangles that it crosses, those under
    /// others too. None where ground lacks somewhere, however short the hole is.
    pub fn lowest_along(&self, ends: [PlanPlace; 2]) -> Option<f64> {
        let mut lines = Vec::new();
        self.section(ends, f64::INFINITY, |line| lines.push(line));
        lines.sort_by(|a, b| a.shares[0].total_cmp(&b.shares[0]));
        let way = Vec3::new(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1], 0.0);
        let crack = CRACK_M / way.norm();
        let (mut reached, mut lowest_m) = (0.0_f64, f64::INFINITY);
        for line in lines {
            if line.shares[0] > reached + crack {
                return None;
            }
            reached = reached.max(line.shares[1]);
            lowest_m = line.heights_m.into_iter().fold(lowest_m, f64::min);
        }
        (lowest_m.is_finite() && reached + crack >= 1.0).then_some(lowest_m)
    }

    /// A height (m, local) that no ground in a box in plan view is below: the lowest corner of a triangle that comes into it. None
    /// where ground lacks somewhere.
    ///
    /// A hole in the box ends at an edge which has triangles on one side only, and just beside which there are none; where
    /// there is no such edge, the box has ground everywhere or nowhere.
    pub fn lowest_in(&self, within @ [low, high]: [PlanPlace; 2]) -> Option<f64> {
        self.ground_below(low[0], low[1])?;
        let (mut lowest_m, mut is_whole) = (f64::INFINITY, true);
        self.index.over_way([low, high], f64::INFINITY, |start, count| {
            for t in (start..start + count).filter(|t| !self.is_tree(*t)) {
                lowest_m = self.corners_m(t).iter().map(|c| c.z).fold(lowest_m, f64::min);
                is_whole = is_whole && (3 * t..3 * t + 3).all(|side| self.goes_on(side, within));
            }
        });
        is_whole.then_some(lowest_m)
    }

    /// Whether there is ground on both sides of an edge, as far as it lies in a box.
    fn goes_on(&self, side: u32, within: [PlanPlace; 2]) -> bool {
        let ends = edges::ends(&self.triangles, side).map(|v| self.vertices_m[v as usize]);
        let Some([from, to]) = clipped(ends.map(|end| [end.x, end.y]), within) else {
            return true;
        };
        let way = [to[0] - from[0], to[1] - from[1]];
        let length_m = math::hypot(way[0], way[1]);
        if length_m < BESIDE_M {
            return true;
        }
        let across = [-way[1] / length_m, way[0] / length_m];
        let mut has = [false; 2];
        for other in self.features.edges.sides_on(side).filter(|other| !self.is_tree(other / 3)) {
            let corners = self.triangles[other as usize / 3];
            let apex = self.vertices_m[corners[(other as usize + 2) % 3] as usize];
            let left_m = across[0] * (apex.x - from[0]) + across[1] * (apex.y - from[1]);
            has[0] |= left_m >= BESIDE_M;
            has[1] |= left_m <= -BESIDE_M;
        }
        let is_ground_beside = |by_m: f64| {
            let moved = |at: PlanPlace| [0, 1].map(|axis| at[axis] + by_m * across[axis]);
            self.lowest_along([moved(from), moved(to)]).is_some()
        };
        (has[0] || is_ground_beside(BESIDE_M)) && (has[1] || is_ground_beside(-BESIDE_M))
    }
}

/// The part of a straight way that lies in a box (Liang and Barsky 1984).
fn clipped([from, to]: [PlanPlace; 2], [low, high]: [PlanPlace; 2]) -> Option<[PlanPlace; 2]> {
    let way = [to[0] - from[0], to[1] - from[1]];
    let mut shares = [0.0_f64, 1.0];
    for axis in [0, 1] {
        let at = |edge: f64| (edge - from[axis]) / way[axis];
        let (enters, leaves) = if way[axis] == 0.0 {
            let is_beside = from[axis] < low[axis] || from[axis] > high[axis];
            if is_beside { (f64::INFINITY, 0.0) } else { (0.0, 1.0) }
        } else if way[axis] > 0.0 {
            (at(low[axis]), at(high[axis]))
        } else {
            (at(high[axis]), at(low[axis]))
        };
        shares = [shares[0].max(enters), shares[1].min(leaves)];
    }
    let spot = |share: f64| [0, 1].map(|axis| from[axis] + share * way[axis]);
    (shares[0] <= shares[1]).then(|| shares.map(spot))
}

#[cfg(test)]
mod tests {
    use super::super::{Sheet, weld};
    use super::*;
    use crate::terrain::stl::{Facet, Soup};

    /// Two triangles over each square metre of 20 m by 20 m, as high as x, but for one square; `more` lies beside them.
    fn with_hole(hole: Option<[i32; 2]>, more: &[Facet]) -> Terrain {
        let mut facets = more.to_vec();
        for (column, row) in (0..20).flat_map(|x| (0..20).map(move |y| (x, y))) {
            if Some([column, row]) != hole {
                facets.extend(square([column, row], f64::from(column), 1.0));
            }
        }
        let soup = Soup::from(facets);
        let file = std::path::Path::new("slope.stl");
        let piece = weld::Piece { file, soup: &soup, up: weld::Up::Z, scale: 1.0, sheet: 0 };
        let welded = weld::weld(&[piece], Vec3::zeros(), None).expect("triangles with areas");
        let sheet = Sheet { path: file.into(), is_tree: false, ground: 0 };
        Terrain::new(welded, vec![sheet])
    }

    /// A square metre: `height` at its western side, `rise` more at its eastern one.
    fn square([column, row]: [i32; 2], height: f64, rise: f64) -> [Facet; 2] {
        let at = |x: i32, y: i32| {
            Vec3::new(f64::from(column + x), f64::from(row + y), height + rise * f64::from(x))
        };
        let corners = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
        [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
    }

    /// A hole of a square metre is seen wherever the way or the box comes over it, and nowhere else; a lid on it is ground.
    #[test]
    fn a_hole_is_seen_however_small_it_is() {
        let hole = [7, 11];
        for (terrain, is_open) in [
            (with_hole(Some(hole), &[]), true),
            (with_hole(Some(hole), &square(hole, 20.0, 0.0)), false),
            (with_hole(None, &[]), false),
        ] {
            let origin = terrain.origin_m;
            let place = |x: f64, y: f64| [x - origin.x, y - origin.y];
            let along = |y: f64| {
                let lowest = terrain.lowest_along([place(2.5, y), place(17.3, y)]);
                lowest.map(|z| z + origin.z)
            };
            let within = |from: f64, to: f64| {
                let lowest = terrain.lowest_in([place(from, from + 4.0), place(to, to + 4.0)]);
                lowest.map(|z| z + origin.z)
            };
            assert_eq!(along(11.5).is_none(), is_open);
            assert!(along(10.5).is_some_and(|z| (z - 2.5).abs() < 1e-9));
            assert_eq!(within(7.2, 7.8).is_none(), is_open);
            assert_eq!(within(5.1, 9.9).is_none(), is_open);
            assert_eq!(within(7.9, 8.5).is_none(), is_open);
            assert_eq!(within(8.2, 12.9), Some(8.0));
            assert_eq!(terrain.lowest_in([place(18.0, 3.0), place(20.5, 4.0)]), None);
        }
    }
}
