//! Points, polylines and areas in plan view, in map coordinates; valid by construction.

use super::blocks::BlockRow;
pub use super::geometry::Corner;
use super::geometry::{meet, minus, twice_area};
use super::holes::bridged;
use crate::count::counted;
use crate::error::Flaw;
pub(super) use crate::gis::FARTHEST_M;
use crate::math;
use crate::random::Entries;
use serde::Deserialize;

/// A point of release.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "Vec<f64>", expecting = "a point [x, y] or [x, y, z]")]
pub struct ReleasePoint {
    /// Place in plan view (m), map coordinates.
    pub at_m: Corner,
    /// Height of the rock's centre (m), map coordinates; absent = computed from the ground below.
    pub height_m: Option<f64>,
}

impl ReleasePoint {
    /// The place of a block of a table.
    pub fn of_block(block: &BlockRow) -> Self {
        Self { at_m: block.at_m, height_m: block.height_m }
    }
}

impl TryFrom<Vec<f64>> for ReleasePoint {
    type Error = Flaw;

    fn try_from(numbers: Vec<f64>) -> Result<Self, Flaw> {
        let (at_m, height_m) = match numbers[..] {
            [x, y] => ([x, y], None),
            [x, y, z] => ([x, y], Some(z)),
            _ => {
                let found = format!("found the point {numbers:?}");
                return Err(Flaw::new(found, "write [x, y] or [x, y, z]"));
            }
        };
        finite(&numbers)?;
        Ok(Self { at_m, height_m })
    }
}

/// A line of straight pieces, longer than zero.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "Corners", expecting = "a list of corners [x, y]")]
pub struct Polyline {
    corners_m: Vec<Corner>,
    /// Length from the start to each corner (m).
    along_m: Vec<f64>,
}

impl Polyline {
    /// Its corners (m), map coordinates.
    pub fn corners_m(&self) -> &[Corner] {
        &self.corners_m
    }

    /// Its length (m).
    pub fn length_m(&self) -> f64 {
        self.along_m[self.along_m.len() - 1]
    }

    /// The first two pieces that cross or touch each other beside a corner that they share.
    pub fn first_crossing(&self) -> Option<(usize, usize)> {
        let piece = |i: usize| [self.corners_m[i], self.corners_m[i + 1]];
        let last = self.corners_m.len() - 2;
        let is_ring = self.corners_m.first() == self.corners_m.last();
        let pairs = (0..=last).flat_map(|i| (i + 2..=last).map(move |j| (i, j)));
        let mut apart = pairs.filter(|pair| !(is_ring && *pair == (0, last)));
        apart.find(|&(i, j)| meet(piece(i), piece(j)))
    }

    /// The line at a distance beside it (m), positive on its left; none where that is no line.
    pub fn beside(&self, offset_m: f64) -> Option<Self> {
        let pieces = self.corners_m.windows(2).map(|pair| minus(pair[1], pair[0]));
        let left: Vec<Corner> = pieces
            .map(|[x, y]| {
                let length = math::hypot(x, y);
                [-y / length, x / length]
            })
            .collect();
        let corner = |k: usize| {
            let before = left[k.saturating_sub(1)];
            let after = left[k.min(left.len() - 1)];
            // at a corner, along the bisector, so that both pieces keep their distance
            let (sum, share) = (
                [before[0] + after[0], before[1] + after[1]],
                1.0 + before[0] * after[0] + before[1] * after[1],
            );
            [0, 1].map(|axis| self.corners_m[k][axis] + offset_m * sum[axis] / share)
        };
        Self::try_from((0..self.corners_m.len()).map(corner).collect::<Vec<_>>()).ok()
    }

    /// The point at the share `p` (–, 0..1) of its length.
    pub fn at(&self, p: f64) -> Corner {
        let along = p * self.length_m();
        let last = self.corners_m.len() - 2;
        let piece = self.along_m[1..].partition_point(|end| *end <= along).min(last);
        let (from, to) = (self.corners_m[piece], self.corners_m[piece + 1]);
        let length = self.along_m[piece + 1] - self.along_m[piece];
        let share = ((along - self.along_m[piece]) / length).clamp(0.0, 1.0);
        [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
    }
}

fn different(corners: usize) -> String {
    format!("{corners} {}", counted(corners, "corner", "different corners"))
}

impl TryFrom<Vec<Corner>> for Polyline {
    type Error = Flaw;

    fn try_from(mut corners_m: Vec<Corner>) -> Result<Self, Flaw> {
        finite(corners_m.as_flattened())?;
        corners_m.dedup();
        if corners_m.len() < 2 {
            let found = format!("found a line with {}", different(corners_m.len()));
            return Err(Flaw::new(found, "write at least two: [[x, y], [x, y]]"));
        }
        let mut along_m = vec![0.0];
        for pair in corners_m.windows(2) {
            let step = minus(pair[1], pair[0]);
            along_m.push(along_m[along_m.len() - 1] + math::hypot(step[0], step[1]));
        }
        Ok(Self { corners_m, along_m })
    }
}

/// The inside of a polygon whose sides neither cross nor touch each other, cut into triangles.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "Corners", expecting = "a list of corners [x, y]")]
pub struct Area {
    corners_m: Vec<Corner>,
    holes_m: Vec<Vec<Corner>>,
    /// Its triangles, each with the area up to and including it (m²).
    triangles: Vec<([Corner; 3], f64)>,
}

impl Area {
    /// Its corners (m), map coordinates.
    pub fn corners_m(&self) -> &[Corner] {
        &self.corners_m
    }

    /// Outlines of its holes (m), map coordinates.
    pub fn holes_m(&self) -> &[Vec<Corner>] {
        &self.holes_m
    }

    /// Its area (m²).
    pub fn area_m2(&self) -> f64 {
        self.triangles[self.triangles.len() - 1].1
    }

    /// A point of the area; three independent even numbers in 0..1 give points uniform over it.
    pub fn at(&self, [which, u, v]: [f64; 3]) -> Corner {
        let target = which * self.area_m2();
        let index = self.triangles.partition_point(|(_, sum)| *sum <= target);
        let ([a, b, c], _) = self.triangles[index.min(self.triangles.len() - 1)];
        // the half of the parallelogram beyond the triangle is folded back onto it
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        [0, 1].map(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]))
    }
}

impl Area {
    /// A polygon without its holes.
    ///
    /// # Errors
    /// Sides that cross or touch each other, a hole that is not inside, no area.
    pub(super) fn with_holes(
        outline_m: Vec<Corner>,
        holes_m: &[Vec<Corner>],
    ) -> Result<Self, Flaw> {
        let mut area = Self::try_from(outline_m)?;
        if holes_m.is_empty() {
            return Ok(area);
        }
        let holes: Vec<Self> =
            holes_m.iter().map(|hole| Self::try_from(hole.clone())).collect::<Result<_, _>>()?;
        let rest_m2 = area.area_m2() - holes.iter().map(Self::area_m2).sum::<f64>();
        let rings: Vec<&[Corner]> = holes.iter().map(Self::corners_m).collect();
        area.triangles = ears(&bridged(&area.corners_m, &rings)?)?;
        // holes that overlap or lie outside leave another area
        if (area.area_m2() - rest_m2).abs() > AREA_ROUNDING * rest_m2.abs() {
            let found = "found a hole that is not inside of its polygon, or meets another one";
            return Err(Flaw::new(found, ORDER));
        }
        area.holes_m = holes_m.to_vec();
        Ok(area)
    }
}

impl TryFrom<Vec<Corner>> for Area {
    type Error = Flaw;

    fn try_from(mut corners_m: Vec<Corner>) -> Result<Self, Flaw> {
        finite(corners_m.as_flattened())?;
        corners_m.dedup();
        // many programs repeat the first corner at the end
        if corners_m.len() > 1 && corners_m.first() == corners_m.last() {
            corners_m.pop();
        }
        if corners_m.len() < 3 {
            let found = format!("found a polygon with {}", different(corners_m.len()));
            return Err(Flaw::new(found, "write at least three: [[x, y], [x, y], [x, y]]"));
        }
        if let Some((i, j)) = first_meeting(&corners_m) {
            let found =
                format!("found that the sides from corner {} and corner {} meet", i + 1, j + 1);
            return Err(Flaw::new(found, ORDER));
        }
        let triangles = ears(&corners_m)?;
        Ok(Self { corners_m, holes_m: Vec::new(), triangles })
    }
}

/// How the corners of a polygon are to be written.
const ORDER: &str = "write the corners in order around the area";
/// Relative error of a sum of areas (–).
const AREA_ROUNDING: f64 = 1e-9;

/// Cuts a polygon whose sides do not cross into triangles, ear by ear.
fn ears(corners_m: &[Corner]) -> Result<Vec<([Corner; 3], f64)>, Flaw> {
    let mut left = corners_m.to_vec();
    let turning: f64 =
        (1..left.len() - 1).map(|i| twice_area([left[0], left[i], left[i + 1]])).sum();
    if turning < 0.0 {
        left.reverse();
    }
    let (mut triangles, mut sum) = (Vec::new(), 0.0);
    while left.len() > 2 {
        let Some((tip, ear)) =
            (0..left.len()).map(|i| (i, ear(&left, i))).find(|(_, ear)| is_free(&left, ear))
        else {
            return Err(Flaw::new("found a polygon too thin to cut into triangles", ORDER));
        };
        left.remove(tip);
        let area = 0.5 * twice_area(ear);
        if area > 0.0 {
            sum += area;
            triangles.push((ear, sum));
        }
    }
    if triangles.is_empty() {
        return Err(Flaw::new("found a polygon without area", ORDER));
    }
    Ok(triangles)
}

/// A corner with its two neighbours.
fn ear(corners_m: &[Corner], tip: usize) -> [Corner; 3] {
    let n = corners_m.len();
    [corners_m[(tip + n - 1) % n], corners_m[tip], corners_m[(tip + 1) % n]]
}

/// Whether an ear may be cut off: it does not turn outwards and holds no other corner. A corner on a
/// straight side encloses nothing and may always go.
fn is_free(corners_m: &[Corner], ear: &[Corner; 3]) -> bool {
    let [a, b, c] = *ear;
    let area = twice_area(*ear);
    let holds = |p: &Corner| {
        !ear.contains(p)
            && [[a, b, *p], [b, c, *p], [c, a, *p]].into_iter().all(|side| twice_area(side) >= 0.0)
    };
    area >= 0.0 && (area <= 0.0 || !corners_m.iter().any(holds))
}

/// The first two sides that are not neighbours but cross or touch; a side is named by its first corner.
fn first_meeting(corners_m: &[Corner]) -> Option<(usize, usize)> {
    let n = corners_m.len();
    let side = |i: usize| [corners_m[i], corners_m[(i + 1) % n]];
    let pairs = (0..n).flat_map(|i| (i + 2..n).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| (j + 1) % n != i).find(|&(i, j)| meet(side(i), side(j)))
}

pub(super) fn finite(numbers: &[f64]) -> Result<(), Flaw> {
    match numbers.iter().find(|number| !(-FARTHEST_M..=FARTHEST_M).contains(*number)) {
        Some(number) => {
            let remedy = format!("write finite coordinates within {FARTHEST_M:e}");
            Err(Flaw::new(format!("found {number:?}"), remedy))
        }
        None => Ok(()),
    }
}

/// Corners as a scene writes them, each of two coordinates and no more.
#[derive(Deserialize)]
#[serde(transparent)]
struct Corners(Vec<Entries<f64, 2>>);

impl From<Corners> for Vec<Corner> {
    fn from(Corners(corners): Corners) -> Self {
        corners.into_iter().map(|Entries(corner)| corner).collect()
    }
}

impl TryFrom<Corners> for Polyline {
    type Error = Flaw;

    fn try_from(corners: Corners) -> Result<Self, Flaw> {
        Vec::<Corner>::from(corners).try_into()
    }
}

impl TryFrom<Corners> for Area {
    type Error = Flaw;

    fn try_from(corners: Corners) -> Result<Self, Flaw> {
        Vec::<Corner>::from(corners).try_into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[Corner]) -> Area {
        Area::try_from(corners.to_vec()).unwrap()
    }

    /// A bent polygon with a hollow, a collinear corner and a repeated first corner.
    const HOLLOW: [Corner; 8] = [
        [0.0, 0.0],
        [2.0, 0.0],
        [4.0, 0.0],
        [4.0, 3.0],
        [2.0, 1.0],
        [1.0, 4.0],
        [0.0, 3.0],
        [0.0, 0.0],
    ];

    /// Shoelace formula.
    fn shoelace(corners: &[Corner]) -> f64 {
        let n = corners.len();
        let sides = (0..n).map(|i| (corners[i], corners[(i + 1) % n]));
        0.5 * sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>().abs()
    }

    /// The triangles cover the polygon exactly: same area either way round, also at map coordinates.
    #[test]
    fn triangles_cover_the_polygon() {
        let exact = shoelace(&HOLLOW);
        let backwards: Vec<Corner> = HOLLOW.iter().rev().copied().collect();
        let far = HOLLOW.map(|[x, y]| [x + 2_600_000.0, y + 1_200_000.0]);
        for corners in [&HOLLOW[..], &backwards, &far] {
            // small whole numbers: every difference and product is exact
            assert!((area(corners).area_m2() - exact).abs() < 1e-12);
        }
    }

    /// A comb of 200 thin teeth: every ear is narrow, and no two triangles may overlap.
    #[test]
    fn thin_teeth_are_cut_without_overlap() {
        let mut comb = vec![[200.0, -1.0], [0.0, -1.0]];
        for tooth in 0..200 {
            let x = f64::from(tooth);
            comb.extend([[x, 0.0], [x + 0.5, 50.0]]);
        }
        comb.push([200.0, 0.0]);
        let comb_area = area(&comb);
        // sums of a thousand terms of up to 100
        assert!((comb_area.area_m2() - shoelace(&comb)).abs() < 1e-9);
        assert!(comb_area.triangles.iter().all(|(triangle, _)| twice_area(*triangle) > 0.0));
    }

    #[test]
    fn polygons_that_enclose_nothing_or_cross_are_refused() {
        let refused = |corners: &[Corner]| Area::try_from(corners.to_vec()).unwrap_err().found;
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(refused(&bow_tie), "found that the sides from corner 1 and corner 3 meet");
        assert!(refused(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).contains("without area"));
        assert!(refused(&[[0.0, 0.0], [1.0, 1.0], [0.0, 0.0]]).contains("2 different corners"));
        assert!(refused(&[[0.0, 0.0], [f64::NAN, 1.0], [0.0, 1.0]]).contains("NaN"));
    }

    /// Equal shares of the length are equally far apart along the line.
    #[test]
    fn a_line_is_walked_evenly() {
        let line =
            Polyline::try_from(vec![[0.0, 0.0], [3.0, 0.0], [3.0, 0.0], [3.0, 1.0]]).unwrap();
        for (p, [x, y]) in
            [(0.0, [0.0, 0.0]), (0.5, [2.0, 0.0]), (0.75, [3.0, 0.0]), (1.0, [3.0, 1.0])]
        {
            let found = line.at(p);
            assert!((found[0] - x).abs() + (found[1] - y).abs() < 1e-15, "{p}: {found:?}");
        }
        assert!(Polyline::try_from(vec![[1.0, 1.0], [1.0, 1.0]]).is_err());
    }
}
