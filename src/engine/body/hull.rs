//! The convex core of a block: corners, edges and faces, coplanar triangles being one face.

use super::BadSurface;
use crate::rock::Vec3;
use nalgebra::Matrix3;

/// Points of one face lie in its plane up to this (–, relative to the size of the hull) …
const FLAT: f64 = 1e-9;
/// … or, if faces overlap then, up to the first of these multiples for which they do not: the
/// points of a file are rounded to its digits.
const FLAT_MULTIPLES: [f64; 4] = [10.0, 1e2, 1e3, 1e4];
/// Most corners of a core.
const MAX_CORNERS: usize = 64;
/// Weight of "move along the mean normal" against "keep every face in its place" when corners are
/// moved inwards (–).
const REGULARISATION: f64 = 1e-10;
/// A corner that is moved inwards may lie outside a moved plane by this (–, relative to the depth)
/// …
const MAX_OVERSHOOT: f64 = 0.05;
/// … is projected back at most this often …
const MAX_PROJECTIONS: usize = 200;
/// … and is merged with another that ends closer than this (–, relative to the depth).
const MERGE_DISTANCE: f64 = 1e-6;

/// Most corners that a core may have.
pub const fn max_corners() -> usize {
    MAX_CORNERS
}

/// A face of the core.
#[derive(Debug, Clone, PartialEq)]
pub struct HullFace {
    /// Outward unit normal.
    pub normal: Vec3,
    /// Distance of its plane from the origin along the normal.
    pub level: f64,
    /// Its corners, counter-clockwise as seen from outside.
    pub corners: Vec<u8>,
}

/// An edge of the core.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ridge {
    /// Its ends.
    pub ends: [u8; 2],
    /// Unit directions across it into its two faces: a direction with no component along either
    /// lies in the normal cone of the edge.
    pub into: [Vec3; 2],
}

/// A convex polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Core {
    /// Corners.
    pub corners: Vec<Vec3>,
    /// Edges.
    pub ridges: Vec<Ridge>,
    /// Faces.
    pub faces: Vec<HullFace>,
}

impl Core {
    /// Whether a part, numbered through corners, edges and faces, is a corner.
    pub(crate) fn is_corner(&self, part: u16) -> bool {
        usize::from(part) < self.corners.len()
    }

    /// The convex hull of at most [`max_corners`] points; points inside faces or edges, or in the
    /// interior, are left out.
    ///
    /// Every plane through three points with all others on one side is a face: for so few points
    /// this takes no time, and no rounding can make it miss one.
    ///
    /// # Errors
    /// Too many points, or all of them in one plane.
    pub fn of(points: &[Vec3]) -> Result<Self, BadSurface> {
        if points.len() > MAX_CORNERS {
            return Err(BadSurface::TooMany(points.len()));
        }
        let size = points.iter().map(Vec3::norm).fold(0.0, f64::max);
        let first = Self::with_tolerance(points, FLAT * size)?;
        if first.is_closed() {
            return Ok(first);
        }
        let mut coarser = FLAT_MULTIPLES
            .iter()
            .map_while(|by| Self::with_tolerance(points, by * FLAT * size).ok());
        Ok(coarser.find(Self::is_closed).unwrap_or(first))
    }

    /// The hull, where points no farther than `flat` from a plane lie in it.
    fn with_tolerance(points: &[Vec3], flat: f64) -> Result<Self, BadSurface> {
        let planes = supporting_planes(points, flat);
        let on = |k: usize| planes.iter().filter(|plane| plane.points & (1 << k) != 0).count();
        let kept: Vec<usize> = (0..points.len()).filter(|&k| on(k) > 2).collect();
        if planes.len() < 4 || kept.len() < 4 {
            return Err(BadSurface::Flat);
        }
        let corners: Vec<Vec3> = kept.iter().map(|&k| points[k]).collect();
        let faces: Vec<HullFace> = planes.iter().map(|plane| plane.face(&kept, &corners)).collect();
        let ridges = ridges(&faces, &corners);
        Ok(Self { corners, ridges, faces })
    }

    /// Whether its faces close and do not overlap: every edge has two, and Euler's formula holds.
    fn is_closed(&self) -> bool {
        let sides: usize = self.faces.iter().map(|face| face.corners.len()).sum();
        sides == 2 * self.ridges.len()
            && self.corners.len() + self.faces.len() == self.ridges.len() + 2
    }

    /// The same, scaled.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        let mut core = self.clone();
        core.corners.iter_mut().for_each(|p| *p *= by);
        core.faces.iter_mut().for_each(|face| face.level *= by);
        core
    }

    /// Corners moved inwards so that the planes of their faces move by `depth`: exactly where three
    /// faces meet, by least squares where more do. The origin must lie deeper than that behind
    /// every face.
    ///
    /// A corner of an edge or face that is short compared with `depth` would end up outside faces
    /// that are not its own, and the body would grow there: such a corner is projected back.
    pub(super) fn inset(&self, depth: f64) -> Vec<Vec3> {
        let moved = |k: usize| {
            let of = |face: &&HullFace| face.corners.contains(&(k as u8));
            let normals: Vec<Vec3> = self.faces.iter().filter(of).map(|face| face.normal).collect();
            let mean = normals.iter().sum::<Vec3>().normalize();
            let mut square = Matrix3::identity() * REGULARISATION;
            let mut right = mean * REGULARISATION;
            for n in &normals {
                square += n * n.transpose();
                right += n;
            }
            let step = square.try_inverse().map_or(mean, |inverse| inverse * right);
            self.projected_inside(self.corners[k] - step * depth, depth)
        };
        let mut kept: Vec<Vec3> = Vec::new();
        for p in (0..self.corners.len()).map(moved) {
            if kept.iter().all(|other| (p - other).norm() > MERGE_DISTANCE * depth) {
                kept.push(p);
            }
        }
        kept
    }

    /// A point projected back, plane by plane, until it is outside no face's plane, moved inwards
    /// by `depth`, by more than [`MAX_OVERSHOOT`] of that depth. A remainder is removed by scaling
    /// towards the origin, which lies behind all planes.
    fn projected_inside(&self, mut p: Vec3, depth: f64) -> Vec3 {
        let max_out = MAX_OVERSHOOT * depth;
        let level = |face: &HullFace| face.level - depth + max_out;
        for _ in 0..MAX_PROJECTIONS {
            let out = self.faces.iter().map(|face| (face.normal.dot(&p) - level(face), face));
            match out.max_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((out, face)) if out > 0.0 => p -= face.normal * out,
                _ => return p,
            }
        }
        let share = |face: &HullFace| level(face) / face.normal.dot(&p).max(level(face));
        p * self.faces.iter().map(share).fold(1.0, f64::min)
    }

    /// Distance of a point from the core, 0 inside.
    pub(super) fn distance(&self, p: &Vec3) -> f64 {
        let corners = self.corners.iter().map(|corner| (p - corner).norm());
        let ridges = self.ridges.iter().map(|ridge| {
            let [a, b] = ridge.ends.map(|k| self.corners[usize::from(k)]);
            let s = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            (p - a - (b - a) * s).norm()
        });
        let over = |face: &HullFace| face.normal.dot(p) - face.level;
        let faces = self.faces.iter().filter(|face| over(face) > 0.0 && self.is_over(face, p));
        let outside = self.faces.iter().any(|face| over(face) > 0.0);
        let nearest = corners.chain(ridges).chain(faces.map(over)).fold(f64::INFINITY, f64::min);
        if outside { nearest } else { 0.0 }
    }

    /// Whether the foot of a point lies on a face.
    pub fn is_over(&self, face: &HullFace, p: &Vec3) -> bool {
        let count = face.corners.len();
        (0..count).all(|k| {
            let [a, b] = [k, (k + 1) % count].map(|k| self.corners[usize::from(face.corners[k])]);
            face.normal.cross(&(b - a)).dot(&(p - a)) >= 0.0
        })
    }
}

/// A supporting plane: all points lie on one side of it.
struct HullPlane {
    normal: Vec3,
    level: f64,
    /// Bits of the points on it.
    points: u64,
}

fn supporting_planes(points: &[Vec3], flat: f64) -> Vec<HullPlane> {
    let mut planes: Vec<HullPlane> = Vec::new();
    let count = points.len();
    for i in 0..count {
        for j in i + 1..count {
            let pair = 1 << i | 1 << j;
            for k in j + 1..count {
                let three: u64 = pair | 1 << k;
                if planes.iter().any(|plane| plane.points & three == three) {
                    continue;
                }
                let across = (points[j] - points[i]).cross(&(points[k] - points[i]));
                let Some(normal) = across.try_normalize(flat * flat) else { continue };
                planes.extend(plane_through(points, (i, normal), flat));
            }
        }
    }
    planes
}

/// The plane through point `i`, oriented outwards, if all points lie on one side of it.
fn plane_through(points: &[Vec3], (i, normal): (usize, Vec3), flat: f64) -> Option<HullPlane> {
    let level = normal.dot(&points[i]);
    let (mut above, mut below, mut on) = (false, false, 0);
    for (k, p) in points.iter().enumerate() {
        let height = normal.dot(p) - level;
        if height.abs() <= flat {
            on |= 1 << k;
        } else if height > 0.0 {
            above = true;
        } else {
            below = true;
        }
        if above && below {
            return None;
        }
    }
    if above == below {
        return None;
    }
    let side = if above { -1.0 } else { 1.0 };
    Some(HullPlane { normal: normal * side, level: level * side, points: on })
}

impl HullPlane {
    /// The face with its corners in order; `kept` are the points that are corners.
    fn face(&self, kept: &[usize], corners: &[Vec3]) -> HullFace {
        let mut own: Vec<u8> = (0..kept.len())
            .filter(|&k| self.points & (1 << kept[k]) != 0)
            .map(|k| k as u8)
            .collect();
        let at = |k: &u8| corners[usize::from(*k)];
        let middle = own.iter().map(at).sum::<Vec3>() / own.len() as f64;
        let first = (at(&own[0]) - middle).normalize();
        let second = self.normal.cross(&first);
        own.sort_by(|a, b| {
            let angle = |k: &u8| {
                let to = at(k) - middle;
                crate::math::atan2(to.dot(&second), to.dot(&first))
            };
            angle(a).total_cmp(&angle(b))
        });
        HullFace { normal: self.normal, level: self.level, corners: own }
    }
}

fn ridges(faces: &[HullFace], corners: &[Vec3]) -> Vec<Ridge> {
    let mut ridges: Vec<Ridge> = Vec::new();
    for face in faces {
        let count = face.corners.len();
        for k in 0..count {
            let ends = [face.corners[k], face.corners[(k + 1) % count]];
            let [a, b] = ends.map(|end| corners[usize::from(end)]);
            let into = face.normal.cross(&(b - a)).normalize();
            match ridges.iter_mut().find(|ridge| ridge.ends == [ends[1], ends[0]]) {
                Some(ridge) => ridge.into[1] = into,
                None => ridges.push(Ridge { ends, into: [into, into] }),
            }
        }
    }
    ridges
}
