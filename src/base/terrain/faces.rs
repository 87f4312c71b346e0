//! Triangles by the numbers of their corners, and ready for the hot loops: kept so, or made anew at every look where memory counts more than time.

use super::edges::ends;
use crate::parallel;
use crate::rock::Vec3;

/// Vertices and triangles of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct Mesh<'a> {
    /// Vertices (m).
    pub vertices_m: &'a [Vec3],
    /// Vertex numbers of each triangle.
    pub triangles: &'a [[u32; 3]],
}

impl Mesh<'_> {
    /// Corners of a triangle (m).
    #[inline]
    pub fn corners_m(self, triangle: u32) -> [Vec3; 3] {
        // written out: as a call of `map` it is left a call in the hot loops
        let [a, b, c] = self.triangles[triangle as usize];
        let at = |v: u32| self.vertices_m[v as usize];
        [at(a), at(b), at(c)]
    }

    /// Ends of a side (m), the one with the lower number first.
    #[inline]
    pub fn ends_m(self, side: u32) -> [Vec3; 2] {
        let [a, b] = ends(self.triangles, side);
        [self.vertices_m[a as usize], self.vertices_m[b as usize]]
    }

    /// The corner of a side's triangle that is not on the side (m).
    #[inline]
    pub(super) fn apex_m(self, side: u32) -> Vec3 {
        let (corners, k) = (self.triangles[side as usize / 3], side as usize % 3);
        self.vertices_m[corners[(k + 2) % 3] as usize]
    }

    /// The two corners of a triangle that are not `vertex`.
    #[inline]
    pub(super) fn others(self, triangle: u32, vertex: u32) -> [u32; 2] {
        let [a, b, c] = self.triangles[triangle as usize];
        if a == vertex {
            [b, c]
        } else if b == vertex {
            [c, a]
        } else {
            [a, b]
        }
    }
}

/// Twice the area of a triangle, relative to its longest side squared, below which its normal is known too badly to tell
/// from where its edges can be touched (–).
const SLIVER: f64 = 1e-9;

/// A triangle ready for the hot loops.
#[derive(Debug, Clone, Copy, Default)]
pub struct Face {
    /// First corner (m).
    pub a: Vec3,
    /// From the first to the second corner (m).
    pub e1: Vec3,
    /// From the first to the third corner (m).
    pub e2: Vec3,
    /// Unit normal, right-handed over the corners.
    pub n: Vec3,
}

impl Face {
    pub(super) fn new([a, b, c]: [Vec3; 3]) -> Self {
        let (e1, e2) = (b - a, c - a);
        Self { a, e1, e2, n: e1.cross(&e2).normalize() }
    }

    /// Unit vector in the plane of the triangle, normal to its edge between `ends_m` (m), pointing out of the triangle.
    #[inline]
    pub fn outward(&self, [a, b]: &[Vec3; 2]) -> Vec3 {
        let middle = self.a + (self.e1 + self.e2) / 3.0;
        let m = self.n.cross(&(b - a)).normalize();
        if m.dot(&(middle - a)) > 0.0 { -m } else { m }
    }

    pub(super) fn is_sliver(&self) -> bool {
        let longest2 = self
            .e1
            .norm_squared()
            .max(self.e2.norm_squared())
            .max((self.e2 - self.e1).norm_squared());
        self.e1.cross(&self.e2).norm() < SLIVER * longest2
    }

    /// Whether the foot of `point` on the plane lies inside the triangle or at most `slack_m` (m) outside.
    ///
    /// Measured as a distance: barycentric coordinates of a needle round by more than any fixed slack.
    #[inline]
    pub fn holds_foot_of(&self, point: &Vec3, slack_m: f64) -> bool {
        let is_in = |side: &Vec3, beyond: f64| {
            beyond <= 0.0 || beyond * beyond <= slack_m * slack_m * side.norm_squared()
        };
        // (side × n) · to, with one cross product for the two sides at the first corner
        let to = point - self.a;
        let across = self.n.cross(&to);
        let e3 = self.e2 - self.e1;
        is_in(&self.e1, self.e1.dot(&across))
            && is_in(&self.e2, -self.e2.dot(&across))
            && is_in(&e3, e3.dot(&self.n.cross(&(to - self.e1))))
    }
}

/// The faces of a mesh: all of them ready, or none. Either way they are the same, bit for bit.
#[derive(Debug, Default)]
pub(super) struct Faces(Vec<Face>);

impl Faces {
    pub(super) fn of(mesh: Mesh, ready: bool) -> Self {
        let count = if ready { mesh.triangles.len() } else { 0 };
        Self(parallel::map(count, |t| Face::new(mesh.corners_m(t as u32))))
    }

    #[inline]
    pub(super) fn at(&self, triangle: u32, mesh: Mesh) -> Face {
        match self.0.get(triangle as usize) {
            Some(face) => *face,
            None => Face::new(mesh.corners_m(triangle)),
        }
    }

    /// Memory that they take (bytes).
    pub(super) fn bytes(&self) -> usize {
        size_of_val::<[Face]>(&self.0)
    }
}
