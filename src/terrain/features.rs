//! What of a mesh a sphere can ever touch: faces from both sides, edges that are not flat, corners of such edges.
//!
//! A sheet has two sides, so an edge that is hollow from the front is sharp from the back: every edge that is not
//! flat is kept, and the contact's own test (`contact::near`) decides from where the rock stands. Flat edges, and
//! vertices with flat edges only, never touch: the face does. Neither do vertices between edges that rise and edges
//! that fall around them (saddles): from either side of the sheet an edge or a face is nearer.

use super::brims::{Brim, Cone, LEANS};
use super::edges::Edges;
use crate::rock::Vec3;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

/// Sine of the angle between faces below which an edge is flat (–): rounding of `f64` coordinates, no more.
const FLAT: f64 = 1e-12;
/// Sine of the angle between edges below which they say nothing of their corner (–).
const NEEDLE: f64 = 1e-6;
/// Corners with more edges are kept as they are: a fan of a thousand would take a billion products.
const MOST_EDGES: usize = 16;
/// Twice the area of a triangle, relative to its longest side squared, below which its normal is known too badly to tell
/// from where its edges can be touched (–).
const SLIVER: f64 = 1e-9;

/// A triangle ready for the hot loops.
#[derive(Debug, Clone, Copy)]
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
    fn new([a, b, c]: [Vec3; 3]) -> Self {
        let (e1, e2) = (b - a, c - a);
        Self { a, e1, e2, n: e1.cross(&e2).normalize() }
    }

    fn is_sliver(&self) -> bool {
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

/// How many edges and corners can be touched, and how many are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Count {
    /// Edges that can be touched.
    pub edges: usize,
    /// Flat edges: the faces beside them touch.
    pub flat_edges: usize,
    /// Corners that can be touched.
    pub corners: usize,
    /// Corners with flat edges only.
    pub flat_corners: usize,
    /// Corners between edges that rise and edges that fall: an edge or a face is nearer, from either side.
    pub saddles: usize,
}

/// The touchable features of a mesh.
#[derive(Debug, Default)]
pub struct Features {
    /// The triangles.
    pub faces: Vec<Face>,
    /// Edges and who shares them.
    pub edges: Edges,
    /// What each triangle owns. Every touchable edge and corner has one owner.
    pub brims: Vec<Brim>,
    /// Neighbours of vertex `v` along edges: `around[starts[v]..starts[v + 1]]`, …
    starts: Vec<u32>,
    around: Vec<u32>,
    /// … and those edges.
    edges_at: Vec<u32>,
    /// Weight of every vertex in the energy of a ball pressed into the mesh (–): `1 − Σ w` over the triangles (1) and
    /// edges (1 − its triangles) that hold it.
    pub vertex_weight: Vec<i8>,
    /// Share of the edges that are flat (–, 0..1).
    pub flat_share: f64,
    /// How many are left out.
    pub count: Count,
}

impl Features {
    /// Finds the touchable features.
    pub fn of(vertices_m: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        Self::of_edges(Edges::of(triangles), vertices_m, triangles)
    }

    /// The same where the edges are known.
    pub(super) fn of_edges(edges: Edges, vertices_m: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let face = |corners: &[u32; 3]| Face::new(corners.map(|v| vertices_m[v as usize]));
        let faces = triangles.par_iter().map(face).collect();
        let mut features = Self { faces, edges, ..Self::default() };
        features.link(vertices_m.len(), triangles);
        features.own(vertices_m, triangles);
        features
    }

    /// Lists the neighbours of every vertex.
    fn link(&mut self, vertices: usize, triangles: &[[u32; 3]]) {
        let mut starts = vec![0u32; vertices + 1];
        for &[a, b] in &self.edges.ends {
            starts[a as usize + 1] += 1;
            starts[b as usize + 1] += 1;
        }
        for v in 0..vertices {
            starts[v + 1] += starts[v];
        }
        let mut fill = starts.clone();
        self.around = vec![0; 2 * self.edges.len()];
        self.edges_at = vec![0; 2 * self.edges.len()];
        let mut weight = vec![1i32; vertices];
        for (edge, &[a, b]) in self.edges.ends.iter().enumerate() {
            for (from, to) in [(a, b), (b, a)] {
                let place = &mut fill[from as usize];
                self.around[*place as usize] = to;
                self.edges_at[*place as usize] = edge as u32;
                *place += 1;
                // w(edge) = 1 − its triangles
                weight[from as usize] += self.edges.count_on(edge as u32) - 1;
            }
        }
        for corners in triangles {
            for &vertex in corners {
                weight[vertex as usize] -= 1;
            }
        }
        let narrow = |weight: i32| weight.clamp(i8::MIN.into(), i8::MAX.into()) as i8;
        self.vertex_weight = weight.into_iter().map(narrow).collect();
        self.starts = starts;
    }

    /// Whether the distance from a centre at `off` from a vertex has neither saddle nor maximum there: of the edges around
    /// it, those that come nearer form one group, or none. `slack_m` (m) is on the side of saddles.
    pub fn is_regular(&self, vertex: u32, off: &Vec3, slack_m: f64, vertices_m: &[Vec3]) -> bool {
        let place = vertices_m[vertex as usize];
        let (first, last) = (self.starts[vertex as usize], self.starts[vertex as usize + 1]);
        let rises = |k: u32| {
            let along = vertices_m[self.around[k as usize] as usize] - place;
            let ahead = along.dot(off);
            let unsure = ahead * ahead <= slack_m * slack_m * along.norm_squared();
            (ahead > 0.0, unsure)
        };
        let mut up = 0;
        for k in first..last {
            match rises(k) {
                (_, true) => return false,
                (is_up, _) => up += i32::from(is_up),
            }
        }
        // χ of what comes nearer: edges less the triangles between two of them
        up == 0 || up - self.faces_with_both_up(vertex, &|k| rises(k).0) == 1
    }

    fn faces_with_both_up(&self, vertex: u32, is_up: &dyn Fn(u32) -> bool) -> i32 {
        let (first, last) = (self.starts[vertex as usize], self.starts[vertex as usize + 1]);
        let mut both = 0;
        for one in (first..last).filter(|&k| is_up(k)) {
            for &t in self.edges.triangles_on(self.edges_at[one as usize]) {
                let sides = &self.edges.of_triangle[t as usize];
                let other = (one + 1..last).find(|&k| sides.contains(&self.edges_at[k as usize]));
                both += i32::from(other.is_some_and(is_up));
            }
        }
        both
    }

    /// Whether a vertex lies on a border of its sheet.
    pub fn is_border_vertex(&self, vertex: u32) -> bool {
        let v = vertex as usize;
        let edges = &self.edges_at[self.starts[v] as usize..self.starts[v + 1] as usize];
        edges.iter().any(|&edge| self.edges.triangles_on(edge).len() == 1)
    }

    /// Gives every touchable edge and corner to the first triangle on it.
    fn own(&mut self, vertices_m: &[Vec3], triangles: &[[u32; 3]]) {
        let kept: Vec<bool> =
            (0..self.edges.len() as u32).map(|e| !self.is_flat(e, vertices_m)).collect();
        let mut corner = vec![false; vertices_m.len()];
        for (&[a, b], _) in self.edges.ends.iter().zip(&kept).filter(|(_, kept)| **kept) {
            corner[a as usize] = true;
            corner[b as usize] = true;
        }
        let sharp = corner.iter().filter(|sharp| **sharp).count();
        let mut pressed = corner.clone();
        let mut along = Vec::new();
        for vertex in 0..corner.len() as u32 {
            corner[vertex as usize] &= self.is_within_reach(vertex, vertices_m, &mut along);
        }
        let flat = kept.iter().filter(|kept| !**kept).count();
        let corners = corner.iter().filter(|kept| **kept).count();
        self.flat_share = flat as f64 / kept.len().max(1) as f64;
        self.count = Count {
            edges: kept.len() - flat,
            flat_edges: flat,
            corners,
            flat_corners: corner.len() - sharp,
            saddles: sharp - corners,
        };
        let owned = self.give_away(&kept, &mut corner, triangles);
        let rows = owned.par_iter().zip(triangles).enumerate();
        self.brims = rows
            .map(|(t, (&owned, corners))| self.brim(t as u32, owned, (corners, vertices_m)))
            .collect();
        for (brim, corners) in self.brims.iter_mut().zip(triangles) {
            for (k, &vertex) in corners.iter().enumerate() {
                if std::mem::take(&mut pressed[vertex as usize]) {
                    brim.vertices |= 1 << k;
                }
            }
        }
    }

    /// Gives what is kept to the first triangle on it: bits 0–2 its edges, bits 3–5 its corners.
    fn give_away(&self, kept: &[bool], corner: &mut [bool], triangles: &[[u32; 3]]) -> Vec<u8> {
        let mut owned = vec![0; triangles.len()];
        for (t, (sides, corners)) in self.edges.of_triangle.iter().zip(triangles).enumerate() {
            for k in 0..3 {
                if kept[sides[k] as usize] && self.edges.triangles_on(sides[k])[0] == t as u32 {
                    owned[t] |= 1 << k;
                }
                // A corner is given away once: to the first triangle that asks.
                if std::mem::take(&mut corner[corners[k] as usize]) {
                    owned[t] |= 8 << k;
                }
            }
        }
        owned
    }

    /// From where what `owned` says of triangle `t` can be touched.
    fn brim(&self, t: u32, owned: u8, (corners, vertices_m): (&[u32; 3], &[Vec3])) -> Brim {
        let mut brim = Brim::NONE;
        let sides = self.edges.of_triangle[t as usize];
        for (k, (&edge, &corner)) in sides.iter().zip(corners).enumerate() {
            if owned & (1 << k) != 0 {
                brim.add(1 << k, self.edge_cone(edge, t, vertices_m));
            }
            if owned & (8 << k) != 0 {
                brim.add(8 << k, self.corner_cone(corner, t, vertices_m));
            }
        }
        brim
    }

    fn edge_cone(&self, edge: u32, owner: u32, vertices_m: &[Vec3]) -> Cone {
        let &[one, other] = self.edges.triangles_on(edge) else { return Cone::Anywhere };
        let [face, beside] = [one, other].map(|t| &self.faces[t as usize]);
        if one != owner || face.is_sliver() || beside.is_sliver() {
            return Cone::Anywhere;
        }
        let [out, across] = [one, other].map(|t| self.outward(edge, t, vertices_m));
        Cone::of_edge(&face.n, &out, &across)
    }

    fn corner_cone(&self, vertex: u32, owner: u32, vertices_m: &[Vec3]) -> Cone {
        let (face, around) = (&self.faces[owner as usize], self.neighbours(vertex));
        if around.len() > MOST_EDGES || face.is_sliver() {
            return Cone::Anywhere;
        }
        let mut along = [Vec3::zeros(); MOST_EDGES];
        for (along, &other) in along.iter_mut().zip(around) {
            *along = (vertices_m[other as usize] - vertices_m[vertex as usize]).normalize();
        }
        Cone::of_corner(&face.n, &along[..around.len()])
    }

    /// Memory that they take (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val::<[Face]>(&self.faces)
            + size_of_val::<[Brim]>(&self.brims)
            + size_of_val::<[u32]>(&self.starts)
            + size_of_val::<[u32]>(&self.around)
            + size_of_val::<[u32]>(&self.edges_at)
            + size_of_val::<[i8]>(&self.vertex_weight)
            + self.edges.bytes()
    }

    /// The same with nothing left out: leaving out changes the cost, never the answer.
    #[must_use]
    pub fn with_everything(mut self, triangles: &[[u32; 3]]) -> Self {
        let mut corner = vec![false; self.starts.len() - 1];
        triangles.iter().flatten().for_each(|&vertex| corner[vertex as usize] = true);
        let owned = self.give_away(&vec![true; self.edges.len()], &mut corner, triangles);
        for (brim, owned) in self.brims.iter_mut().zip(owned) {
            brim.anywhere |= owned & !(brim.front | brim.back);
        }
        self
    }

    /// The same, asked for from wherever the ball is: telling by heights changes the cost, never the answer.
    #[must_use]
    pub fn from_anywhere(mut self) -> Self {
        for brim in &mut self.brims {
            brim.anywhere |= brim.front | brim.back;
            (brim.front, brim.back) = (0, 0);
        }
        self
    }

    /// Whether a ball can touch a corner from anywhere: some direction must stand at a right angle or more to every edge
    /// at it.
    ///
    /// The extreme ones of those directions stand at a right angle to two of the edges. If none of these fits, none does:
    /// of three edges that hold a direction back at least two enclose a good angle, so rounding stays far below
    /// [`LEANS`]; where any two edges nearly are in line the corner is kept.
    fn is_within_reach(&self, vertex: u32, vertices_m: &[Vec3], along: &mut Vec<Vec3>) -> bool {
        let around = self.neighbours(vertex);
        if around.len() > MOST_EDGES {
            return true;
        }
        let place = vertices_m[vertex as usize];
        along.clear();
        along.extend(around.iter().map(|&other| (vertices_m[other as usize] - place).normalize()));
        for (number, one) in along.iter().enumerate() {
            for other in &along[number + 1..] {
                let across = one.cross(other);
                let size = across.norm();
                let fits =
                    |side: f64| along.iter().all(|edge| side * edge.dot(&across) <= LEANS * size);
                if size < NEEDLE || fits(1.0) || fits(-1.0) {
                    return true;
                }
            }
        }
        along.is_empty()
    }

    fn is_flat(&self, edge: u32, vertices_m: &[Vec3]) -> bool {
        let &[one, other] = self.edges.triangles_on(edge) else { return false };
        let [m_one, m_other] = [one, other].map(|t| self.outward(edge, t, vertices_m));
        let n = self.faces[one as usize].n;
        // Flat: the other face goes on in the same plane, on the other side of the edge.
        n.dot(&m_other).abs() <= FLAT && m_one.dot(&m_other) < 0.0
    }

    /// Unit vector in the plane of `triangle`, normal to `edge`, pointing out of the triangle.
    pub fn outward(&self, edge: u32, triangle: u32, vertices_m: &[Vec3]) -> Vec3 {
        let [a, b] = self.edges.ends[edge as usize].map(|v| vertices_m[v as usize]);
        let face = &self.faces[triangle as usize];
        let middle = face.a + (face.e1 + face.e2) / 3.0;
        let m = face.n.cross(&(b - a)).normalize();
        if m.dot(&(middle - a)) > 0.0 { -m } else { m }
    }

    /// The vertices joined to `vertex` by an edge.
    pub fn neighbours(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.around[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}
