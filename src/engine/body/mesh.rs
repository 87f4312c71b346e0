//! A scanned surface: whether it is closed, and a hull with few corners.

use super::hull::{Core, max_corners};
use super::solid::Surface;
use crate::rock::Vec3;
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;
use std::collections::BTreeMap;

/// Why no block can be made from a surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BadSurface {
    /// Number of its edges that do not join two triangles of the same orientation.
    Open(usize),
    /// Number of separate surfaces that share no corner.
    Parts(usize),
    /// It encloses no volume.
    Flat,
    /// More corners than a core may have.
    TooMany(usize),
    /// The balls are so large that no core is left between them.
    NoCore,
}

impl std::fmt::Display for BadSurface {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Open(edges) => write!(
                to,
                "found a surface that is not closed: {edges} of its edges do not join two triangles turned alike"
            ),
            Self::Parts(parts) => write!(to, "found {parts} surfaces that share no corner"),
            Self::Flat => write!(to, "found a body without volume"),
            Self::TooMany(corners) => {
                write!(to, "found {corners} corners, where {} is the most", max_corners())
            }
            Self::NoCore => write!(to, "found corners so round that nothing is left between them"),
        }
    }
}

/// A hull with few corners.
#[derive(Debug, Clone, PartialEq)]
pub struct ThinnedHull {
    /// The corners.
    pub corners: Vec<Vec3>,
    /// Number of corners of the hull of all points.
    pub hull_corners: usize,
    /// How far the hull of all points reaches beyond this one at most (m).
    pub deviation_m: f64,
}

impl Surface {
    /// Whether every edge joins two triangles of the same orientation, and all of them are one
    /// surface.
    ///
    /// # Errors
    /// The number of edges that do not, or of surfaces.
    pub fn check_closed(&self) -> Result<(), BadSurface> {
        let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from, *to)).or_default() += 1;
            }
        }
        let count_of = |(from, to): (u32, u32)| edges.get(&(from, to)).copied().unwrap_or(0);
        let open =
            edges.iter().filter(|((from, to), count)| **count != 1 || count_of((*to, *from)) != 1);
        match open.count() {
            0 => match self.parts() {
                0 | 1 => Ok(()),
                parts => Err(BadSurface::Parts(parts)),
            },
            count => Err(BadSurface::Open(count)),
        }
    }

    /// Number of connected surfaces among its triangles, which share no corner.
    fn parts(&self) -> usize {
        let mut part_of: Vec<usize> = (0..self.points.len()).collect();
        let mut joined = 0;
        let root = |part_of: &mut [usize], mut point: usize| {
            while part_of[point] != point {
                part_of[point] = part_of[part_of[point]];
                point = part_of[point];
            }
            point
        };
        for [a, b, c] in &self.triangles {
            for (first, second) in [(a, b), (a, c)] {
                let ends = [first, second].map(|point| root(&mut part_of, *point as usize));
                joined += usize::from(ends[0] != ends[1]);
                part_of[ends[0]] = ends[1];
            }
        }
        self.points.len() - joined
    }

    /// At most `most` corners of the hull. Corners are added, always the one farthest outside the
    /// hull of the others, until none is more than `near` (m) outside.
    ///
    /// # Errors
    /// A flat surface.
    pub fn thinned(&self, most: usize, near: f64) -> Result<ThinnedHull, BadSurface> {
        let points: Vec<Vector> = self.points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
        let (hull, _) = try_convex_hull(&points).map_err(|_| BadSurface::Flat)?;
        let hull: Vec<Vec3> = hull.iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect();
        let mut kept = first_corners(&hull);
        if Core::of(&kept).is_err() {
            kept = widest_four(&hull);
        }
        loop {
            let core = Core::of(&kept)?;
            let far = hull.iter().map(|p| (core.distance(p), p));
            let (deviation_m, farthest) =
                far.max_by(|a, b| a.0.total_cmp(&b.0)).ok_or(BadSurface::Flat)?;
            if deviation_m <= near || kept.len() >= most.min(max_corners()) {
                return Ok(ThinnedHull {
                    corners: core.corners,
                    hull_corners: hull.len(),
                    deviation_m,
                });
            }
            kept.push(*farthest);
        }
    }
}

/// Extreme points along the axes, slightly tilted, as first corners of a hull.
fn first_corners(points: &[Vec3]) -> Vec<Vec3> {
    let mut kept: Vec<Vec3> = Vec::new();
    for k in 0..6 {
        let mut along = Vec3::new(0.02, 0.03, 0.05);
        along[k / 2] = if k % 2 == 0 { 1.0 } else { -1.0 };
        let height = |p: &Vec3| p.dot(&along);
        if let Some(p) = points.iter().max_by(|a, b| height(a).total_cmp(&height(b)))
            && !kept.contains(p)
        {
            kept.push(*p);
        }
    }
    kept
}

/// Four points that span a large tetrahedron: for a body with few corners the extreme points along
/// the axes may lie in one plane.
fn widest_four(points: &[Vec3]) -> Vec<Vec3> {
    let farthest = |from: &dyn Fn(&Vec3) -> f64| {
        points.iter().copied().max_by(|a, b| from(a).total_cmp(&from(b))).unwrap_or_default()
    };
    let start = points.first().copied().unwrap_or_default();
    let a = farthest(&|p| (p - start).norm());
    let b = farthest(&|p| (p - a).norm());
    let c = farthest(&|p| (b - a).cross(&(p - a)).norm());
    let across = (b - a).cross(&(c - a));
    vec![a, b, c, farthest(&|p| across.dot(&(p - a)).abs())]
}
