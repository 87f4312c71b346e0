//! What of a mesh a sphere can ever touch: faces from both sides, edges that are not flat, corners of such edges.
//!
//! A sheet has two sides, so an edge that is hollow from the front is sharp from the back: every edge that is not
//! flat is kept, and the contact's own test (`contact::near`) decides from where the rock stands. Flat edges, and
//! vertices with flat edges only, never touch: the face does. Neither do vertices between edges that rise and edges
//! that fall around them (saddles): from either side of the sheet an edge or a face is nearer.

use super::brims::{Brim, Cone, LEANS};
use super::edges::{Edges, grouped};
use super::faces::{Face, Faces, Mesh};
use crate::parallel;
use crate::rock::Vec3;

/// Sine of the angle between faces below which an edge is flat (–): rounding of `f64` coordinates, no more.
const FLAT: f64 = 1e-12;
/// Sine of an angle above which neither a triangle nor a fold can be the work of rounding (–).
const FOLDED: f64 = 1e-6;
/// Sine of the angle between edges below which they say nothing of their corner (–).
const NEEDLE: f64 = 1e-6;
/// Corners with more edges are kept as they are: a fan of a thousand would take a billion products.
const MOST_EDGES: usize = 16;
/// How many edges and corners can be touched, and how many are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FeatureCount {
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
    /// The triangles, ready for use.
    pub(super) faces: Faces,
    /// Who shares edges.
    pub edges: Edges,
    /// What each triangle owns. Every touchable edge and corner has one owner.
    pub brims: Vec<Brim>,
    /// Triangles at vertex `v`, ascending: `triangles_at[starts[v]..starts[v + 1]]`.
    starts: Vec<u32>,
    triangles_at: Vec<u32>,
    /// Weight of every vertex in the energy of a ball pressed into the mesh (–): `1 − Σ w` over the triangles (1) and
    /// edges (1 − its triangles) that hold it.
    pub vertex_weight: Vec<i8>,
    /// Share of the edges that are flat (–, 0..1).
    pub flat_share: f64,
    /// How many are left out.
    pub count: FeatureCount,
}

impl Features {
    /// Finds the touchable features.
    pub fn of(vertices_m: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        Self::of_edges(Edges::of(triangles), Mesh { vertices_m, triangles }, true)
    }

    /// The same where the edges are known; `ready` keeps the faces ready for use, at 96 bytes each.
    pub(super) fn of_edges(edges: Edges, mesh: Mesh, ready: bool) -> Self {
        let faces = Faces::of(mesh, ready);
        let corners = mesh.triangles.iter().copied();
        let (starts, mut triangles_at) =
            grouped(corners, mesh.triangles.len(), mesh.vertices_m.len());
        parallel::update(&mut triangles_at, |_, corner| *corner /= 3);
        let mut features = Self { faces, edges, starts, triangles_at, ..Self::default() };
        features.weigh(mesh);
        features.own(mesh);
        features
    }

    /// The triangles at a vertex, ascending.
    #[inline]
    pub fn triangles_at(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.triangles_at[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// The vertices joined to `vertex` by an edge, each once.
    #[inline]
    pub fn neighbours<'a>(&'a self, vertex: u32, mesh: Mesh<'a>) -> impl Iterator<Item = u32> + 'a {
        let triangles = self.triangles_at(vertex);
        triangles.iter().enumerate().flat_map(move |(k, &t)| {
            let is_new = move |other: &u32| {
                !triangles[..k].iter().any(|&t| mesh.triangles[t as usize].contains(other))
            };
            mesh.others(t, vertex).into_iter().filter(is_new)
        })
    }

    /// Weighs the vertices: with `T` triangles and `E` edges at one, the edges weigh `E − 2 T` together.
    fn weigh(&mut self, mesh: Mesh) {
        let weight = |vertex: usize| {
            let vertex = vertex as u32;
            let triangles = self.triangles_at(vertex).len();
            let more =
                (1 + triangles).cast_signed() - self.count_neighbours(vertex, mesh).cast_signed();
            more.clamp(i8::MIN.into(), i8::MAX.into()) as i8
        };
        self.vertex_weight = parallel::map(mesh.vertices_m.len(), weight);
    }

    /// How many edges are at a vertex, also of a fan of thousands.
    fn count_neighbours(&self, vertex: u32, mesh: Mesh) -> usize {
        let triangles = self.triangles_at(vertex);
        if triangles.len() <= MOST_EDGES {
            return self.neighbours(vertex, mesh).count();
        }
        let mut all: Vec<u32> = triangles.iter().flat_map(|&t| mesh.others(t, vertex)).collect();
        all.sort_unstable();
        all.dedup();
        all.len()
    }

    /// Whether the distance from a centre at `off` from a vertex has neither saddle nor maximum there: of the edges around
    /// it, those that come nearer form one group, or none. `slack_m` (m) is on the side of saddles.
    pub fn is_regular(&self, vertex: u32, off: &Vec3, slack_m: f64, mesh: Mesh) -> bool {
        let place = mesh.vertices_m[vertex as usize];
        let rises = |other: u32| {
            let along = mesh.vertices_m[other as usize] - place;
            let ahead = along.dot(off);
            let unsure = ahead * ahead <= slack_m * slack_m * along.norm_squared();
            (ahead > 0.0, unsure)
        };
        let mut up = 0;
        for other in self.neighbours(vertex, mesh) {
            match rises(other) {
                (_, true) => return false,
                (is_up, _) => up += usize::from(is_up),
            }
        }
        if up == 0 {
            return true;
        }
        // χ of what comes nearer: edges less the triangles between two of them
        let both_up = |t: &&u32| mesh.others(**t, vertex).into_iter().all(|other| rises(other).0);
        up == 1 + self.triangles_at(vertex).iter().filter(both_up).count()
    }

    /// Whether a vertex lies on a border of its sheet.
    pub fn is_border_vertex(&self, vertex: u32, mesh: Mesh) -> bool {
        let is_border = |&t: &u32| {
            (0..3).any(|k| {
                let side = 3 * t + k as u32;
                let is_at = mesh.triangles[t as usize][(k + 2) % 3] != vertex;
                is_at && self.edges.is_border(side)
            })
        };
        self.triangles_at(vertex).iter().any(is_border)
    }

    /// Gives every touchable edge and corner to the first triangle on it.
    fn own(&mut self, mesh: Mesh) {
        let sharp_sides = |t: u32| {
            let is_sharp = |k: &u32| {
                let side = 3 * t + k;
                self.edges.is_edge(side) && !self.is_flat(side, mesh)
            };
            (0..3).filter(is_sharp).fold(0, |bits, k| bits | 1 << k)
        };
        let mut owned: Vec<u8> =
            parallel::map(mesh.triangles.len(), |triangle| sharp_sides(triangle as u32));
        let mut corner = vec![false; mesh.vertices_m.len()];
        for (bits, corners) in owned.iter().zip(mesh.triangles) {
            for k in (0..3).filter(|k| bits & (1 << k) != 0) {
                corner[corners[k] as usize] = true;
                corner[corners[(k + 1) % 3] as usize] = true;
            }
        }
        let sharp = corner.iter().filter(|sharp| **sharp).count();
        let mut pressed = corner.clone();
        parallel::update(&mut corner, |vertex, kept| {
            *kept &= *kept && self.is_within_reach(vertex as u32, mesh);
        });
        let edges = owned.iter().map(|bits| bits.count_ones() as usize).sum::<usize>();
        let flat = self.edges.len() - edges;
        let corners = corner.iter().filter(|kept| **kept).count();
        self.flat_share = flat as f64 / self.edges.len().max(1) as f64;
        self.count = FeatureCount {
            edges,
            flat_edges: flat,
            corners,
            flat_corners: corner.len() - sharp,
            saddles: sharp - corners,
        };
        give_corners(&mut owned, &mut corner, mesh.triangles);
        self.brims = parallel::map(owned.len(), |t| self.brim(t as u32, owned[t], mesh));
        for (brim, corners) in self.brims.iter_mut().zip(mesh.triangles) {
            for (k, &vertex) in corners.iter().enumerate() {
                if std::mem::take(&mut pressed[vertex as usize]) {
                    brim.vertices |= 1 << k;
                }
            }
        }
    }

    /// From where what `owned` says of triangle `t` can be touched.
    fn brim(&self, t: u32, owned: u8, mesh: Mesh) -> Brim {
        let mut brim = Brim::NONE;
        if owned == 0 {
            return brim;
        }
        let face = self.faces.at(t, mesh);
        for (k, corner) in (0..3).zip(mesh.triangles[t as usize]) {
            if owned & (1 << k) != 0 {
                brim.add(1 << k, self.edge_cone(3 * t + k, &face, mesh));
            }
            if owned & (8 << k) != 0 {
                brim.add(8 << k, self.corner_cone(corner, &face, mesh));
            }
        }
        brim
    }

    /// From where an edge can be touched, seen from the first triangle on it.
    fn edge_cone(&self, edge: u32, face: &Face, mesh: Mesh) -> Cone {
        let Some([_, beside]) = self.edges.pair_on(edge) else { return Cone::Anywhere };
        let beside = self.faces.at(beside, mesh);
        if face.is_sliver() || beside.is_sliver() {
            return Cone::Anywhere;
        }
        let ends_m = mesh.ends_m(edge);
        Cone::of_edge(&face.n, &face.outward(&ends_m), &beside.outward(&ends_m))
    }

    fn corner_cone(&self, vertex: u32, face: &Face, mesh: Mesh) -> Cone {
        let mut along = [Vec3::zeros(); MOST_EDGES];
        let Some(around) = self.edges_along(vertex, mesh, &mut along) else {
            return Cone::Anywhere;
        };
        if face.is_sliver() {
            return Cone::Anywhere;
        }
        Cone::of_corner(&face.n, around)
    }

    /// Unit vectors along the edges at a vertex; none where there are too many.
    fn edges_along<'a>(
        &self,
        vertex: u32,
        mesh: Mesh,
        along: &'a mut [Vec3; MOST_EDGES],
    ) -> Option<&'a [Vec3]> {
        let place = mesh.vertices_m[vertex as usize];
        let mut count = 0;
        for other in self.neighbours(vertex, mesh) {
            *along.get_mut(count)? = (mesh.vertices_m[other as usize] - place).normalize();
            count += 1;
        }
        Some(&along[..count])
    }

    /// Memory that they take (bytes).
    pub fn bytes(&self) -> usize {
        self.faces.bytes()
            + size_of_val::<[Brim]>(&self.brims)
            + size_of_val::<[u32]>(&self.starts)
            + size_of_val::<[u32]>(&self.triangles_at)
            + size_of_val::<[i8]>(&self.vertex_weight)
            + self.edges.bytes()
    }

    /// The same with nothing left out: leaving out changes the cost, never the answer.
    #[must_use]
    pub fn with_everything(mut self, triangles: &[[u32; 3]]) -> Self {
        let mut corner = vec![false; self.starts.len() - 1];
        triangles.iter().flatten().for_each(|&vertex| corner[vertex as usize] = true);
        let mut owned = vec![0; triangles.len()];
        self.edges.all().for_each(|edge| owned[edge as usize / 3] |= 1 << (edge % 3));
        give_corners(&mut owned, &mut corner, triangles);
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
    fn is_within_reach(&self, vertex: u32, mesh: Mesh) -> bool {
        let mut along = [Vec3::zeros(); MOST_EDGES];
        let Some(along) = self.edges_along(vertex, mesh, &mut along) else { return true };
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

    fn is_flat(&self, edge: u32, mesh: Mesh) -> bool {
        let Some(sides) = self.edges.sides_of_pair(edge) else { return false };
        let ends_m = mesh.ends_m(edge);
        if is_folded(&ends_m, &sides.map(|side| mesh.apex_m(side))) {
            return false;
        }
        let [one, other] = sides.map(|side| self.faces.at(side / 3, mesh));
        let [m_one, m_other] = [one, other].map(|face| face.outward(&ends_m));
        // Flat: the other face goes on in the same plane, on the other side of the edge.
        one.n.dot(&m_other).abs() <= FLAT && m_one.dot(&m_other) < 0.0
    }
}

/// Whether two triangles on an edge, each with its third corner, are folded beyond doubt: told without a root or a division,
/// which is enough for nearly every edge of a natural slope.
fn is_folded([a, b]: &[Vec3; 2], [one, other]: &[Vec3; 2]) -> bool {
    let (along, to, beyond) = (b - a, one - a, other - a);
    let normal = along.cross(&to);
    // height of the other corner over the plane: at least this share of its distance from the edge
    let height = normal.dot(&beyond);
    let n2 = normal.norm_squared();
    n2 > FOLDED * FOLDED * along.norm_squared() * to.norm_squared()
        && height * height > FOLDED * FOLDED * n2 * beyond.norm_squared()
}

/// Gives corners that are kept to the first triangle on them: bits 3–5.
fn give_corners(owned: &mut [u8], corner: &mut [bool], triangles: &[[u32; 3]]) {
    for (owned, corners) in owned.iter_mut().zip(triangles) {
        for k in 0..3 {
            // A corner is given away once: to the first triangle that asks.
            if std::mem::take(&mut corner[corners[k] as usize]) {
                *owned |= 8 << k;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// What is told to be folded without a root is not flat by the angle either, from blunt to sharp and to slivers.
        #[test]
        fn no_flat_edge_is_taken_for_a_fold(
            length in -2.0..2.0f64, fold in -14.0..0.0f64, at in [-3.0..3.0f64, -3.0..3.0], wide in [-9.0..1.0f64, -9.0..1.0],
        ) {
            let [wide, other] = wide.map(|x| 10f64.powf(x));
            let vertices_m = [
                Vec3::zeros(),
                Vec3::new(10f64.powf(length), 0.0, 0.0),
                Vec3::new(at[0], wide, 0.0),
                Vec3::new(at[1], -other, other * 10f64.powf(fold)),
            ];
            let triangles = [[0, 1, 2], [1, 0, 3]];
            let mesh = Mesh { vertices_m: &vertices_m, triangles: &triangles };
            let features = Features::of(&vertices_m, &triangles);
            let is_folded = is_folded(&mesh.ends_m(0), &[mesh.apex_m(0), mesh.apex_m(3)]);
            let [one, beside] = [0, 1].map(|t| Face::new(mesh.corners_m(t)));
            let sine = one.n.dot(&beside.outward(&mesh.ends_m(0))).abs();
            prop_assert!(!is_folded || sine > FLAT, "sine {sine}");
            // and nearly everything that is folded is told so
            let is_blunt = fold < -2.0 || other < 1e-2 || wide < 1e-2;
            prop_assert!(is_folded || is_blunt);
            prop_assert_eq!(features.count.flat_edges, usize::from(features.is_flat(0, mesh)));
        }
    }
}
