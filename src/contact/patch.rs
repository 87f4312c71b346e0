//! Patches: where a ball presses into the mesh, every connected part of the mesh inside it is one contact.
//!
//! The elastic energy of a ball of radius `R` with centre `c` on a mesh `K` counts every connected part once,
//!
//! ```text
//! U(c) = p_N ∫₀ᴿ χ(K ∩ B(c, r)) (R − r) dr = p_N/2 Σ_σ w(σ) max(0, R − dist(c, σ))²
//! w(triangle) = 1,   w(edge) = 1 − its triangles,   w(vertex) = 1 − Σ w of the triangles and edges that hold it
//! ```
//!
//! with χ the Euler characteristic and the sum over all triangles, edges and vertices. Distances to convex sets are
//! continuously differentiable, so energy and force are continuous whatever the triangulation. Where the ball only touches,
//! and at ridges and apexes, a patch is the single nearest point of the paper's sphere–plane and sphere–edge contacts.
//!
//! A patch acts like one point contact: with `p = √(2U/p_N)`, `a = −∇p` and `n̂ = a/|a|`, its force `p_N p a` is that of a
//! spring of stiffness `p_N |a|²` pressed in by `p/|a|` along `n̂`, with the same energy.

use super::closest::{TrianglePart, closest_part};
use super::{ContactPoint, Feature, FeatureKind};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::edges::ends;

/// Squared length of `a` below which a patch presses nowhere (–): opposite walls of one patch cancel.
const BALANCED: f64 = 1e-12;

/// One triangle inside the ball, and the sums of the patch that it stands for.
#[derive(Debug, Clone, Copy)]
struct PressedTriangle {
    triangle: u32,
    /// Another one of the same patch, or itself.
    parent: u32,
    /// `Σ w pen²` (m²) and `Σ w pen n` (m).
    square: f64,
    slope: Vec3,
    /// Nearest point of the patch.
    nearest: ContactPoint,
}

/// An edge or a vertex inside the ball, once for every triangle on it.
#[derive(Debug, Clone, Copy)]
struct Shared {
    /// Edges by the numbers of their ends, then vertices by theirs.
    key: u64,
    place: u32,
    /// Of an edge, a side on it.
    side: u32,
    distance_m: f64,
    normal: Vec3,
}

/// There are fewer than 2³¹ vertices.
const VERTEX: u64 = 1 << 63;

/// Work space.
#[derive(Debug, Default)]
pub(super) struct PatchScratch {
    pressed: Vec<PressedTriangle>,
    shared: Vec<Shared>,
}

impl PatchScratch {
    /// With room for what is usually pressed.
    pub(super) fn with_room() -> Self {
        Self { pressed: Vec::with_capacity(128), shared: Vec::with_capacity(1024) }
    }

    /// Finds the patches of a ball of `radius` (m) at `centre` among `sheets`, all triangles near it, and hands each to
    /// `found`, in the order of their first triangles.
    pub(super) fn find(
        &mut self,
        terrain: &Terrain,
        sheets: &[u32],
        (centre, radius): (&Vec3, f64),
        mut found: impl FnMut(ContactPoint),
    ) {
        self.pressed.clear();
        self.shared.clear();
        for &t in sheets {
            self.press(terrain, t, (centre, radius));
        }
        self.shared.sort_unstable_by_key(|shared| (shared.key, shared.place));
        self.join(terrain, radius);
        for k in 0..self.pressed.len() {
            let patch = &self.pressed[k];
            if patch.parent as usize == k
                && let Some(touch) = patch.touch(radius)
            {
                found(touch);
            }
        }
    }

    /// Forgets what was found last.
    pub(super) fn clear(&mut self) {
        self.pressed.clear();
    }

    /// The nearest feature of the patch that holds `feature`, of those found last.
    pub(super) fn holding(&self, terrain: &Terrain, feature: Feature) -> Option<Feature> {
        let id = feature.id;
        let has = |t: u32| match feature.kind {
            FeatureKind::Face => t == id,
            FeatureKind::Edge => terrain.features.edges.sides_on(id).any(|side| side / 3 == t),
            FeatureKind::Vertex => terrain.triangles[t as usize].contains(&id),
        };
        let mut place = self.pressed.iter().position(|pressed| has(pressed.triangle))?;
        while self.pressed[place].parent as usize != place {
            place = self.pressed[place].parent as usize;
        }
        Some(self.pressed[place].nearest.feature)
    }

    /// Notes a triangle that is inside the ball, and those of its sides and corners that are.
    fn press(&mut self, terrain: &Terrain, t: u32, (centre, radius): (&Vec3, f64)) {
        let face = terrain.face(t);
        let height = face.n.dot(&(centre - face.a));
        if height.abs() >= radius {
            return;
        }
        let corners = terrain.corners_m(t);
        let (point, part) = closest_part(&corners, centre);
        let off = centre - point;
        let distance2 = off.norm_squared();
        if distance2 >= radius * radius || distance2 == 0.0 {
            return;
        }
        let (edges, vertices) = (&terrain.features.edges, terrain.triangles[t as usize]);
        let feature = match part {
            TrianglePart::Face => Feature { kind: FeatureKind::Face, id: t },
            TrianglePart::Side(k) => {
                Feature { kind: FeatureKind::Edge, id: edges.edge_of(3 * t + k as u32) }
            }
            TrianglePart::Corner(k) => Feature { kind: FeatureKind::Vertex, id: vertices[k] },
        };
        let (distance_m, normal) = match part {
            TrianglePart::Face => (height.abs(), if height < 0.0 { -face.n } else { face.n }),
            _ => (distance2.sqrt(), off / distance2.sqrt()),
        };
        let place = self.pressed.len() as u32;
        let penetration = radius - distance_m;
        let nearest = ContactPoint { feature, triangle: t, normal, distance_m, gain2: 1.0 };
        let (square, slope) = (penetration * penetration, normal * penetration);
        self.pressed.push(PressedTriangle { triangle: t, parent: place, square, slope, nearest });
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let side = b - a;
            let s = (side.dot(&(centre - a)) / side.norm_squared()).clamp(0.0, 1.0);
            let number = 3 * t + k as u32;
            let [lower, upper] = ends(&terrain.triangles, number).map(u64::from);
            let edge = (lower << 32 | upper, place, number);
            self.share(edge, (centre - (a + side * s), radius));
            let vertex = (VERTEX + u64::from(vertices[k]), place, number);
            self.share(vertex, (centre - a, radius));
        }
    }

    #[inline]
    fn share(&mut self, (key, place, side): (u64, u32, u32), (off, radius): (Vec3, f64)) {
        let distance2 = off.norm_squared();
        if distance2 < radius * radius && distance2 > 0.0 {
            let distance_m = distance2.sqrt();
            self.shared.push(Shared { key, place, side, distance_m, normal: off / distance_m });
        }
    }

    /// Adds every edge and vertex once to its patch, and joins the triangles that meet there.
    fn join(&mut self, terrain: &Terrain, radius: f64) {
        let mut start = 0;
        while start < self.shared.len() {
            let first = self.shared[start];
            let same = self.shared[start..].iter().take_while(|next| next.key == first.key).count();
            for k in start + 1..start + same {
                self.unite(first.place, self.shared[k].place);
            }
            let features = &terrain.features;
            let weight = if first.key < VERTEX {
                1.0 - features.edges.count_on(first.side) as f64
            } else {
                f64::from(features.vertex_weight[(first.key - VERTEX) as usize])
            };
            let penetration = radius - first.distance_m;
            let root = self.root(first.place);
            let patch = &mut self.pressed[root as usize];
            patch.square += weight * penetration * penetration;
            patch.slope += first.normal * (weight * penetration);
            start += same;
        }
    }

    fn root(&mut self, mut place: u32) -> u32 {
        while self.pressed[place as usize].parent != place {
            let up = self.pressed[place as usize].parent;
            self.pressed[place as usize].parent = self.pressed[up as usize].parent;
            place = up;
        }
        place
    }

    fn unite(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        if one == other {
            return;
        }
        let (kept, gone) = (one.min(other) as usize, one.max(other) as usize);
        let from = self.pressed[gone];
        self.pressed[gone].parent = kept as u32;
        let patch = &mut self.pressed[kept];
        patch.square += from.square;
        patch.slope += from.slope;
        if from.nearest.distance_m < patch.nearest.distance_m {
            patch.nearest = from.nearest;
        }
    }
}

impl PressedTriangle {
    /// The point contact that acts like the patch; `None` where it does not press.
    fn touch(&self, radius: f64) -> Option<ContactPoint> {
        let slope2 = self.slope.norm_squared();
        if self.square <= 0.0 || slope2 <= BALANCED * self.square {
            return None;
        }
        let slope = slope2.sqrt();
        // p = √square, a = slope/p: pressed in by p/|a| = square/slope.
        Some(ContactPoint {
            normal: self.slope / slope,
            distance_m: radius - self.square / slope,
            gain2: slope2 / self.square,
            triangle: self.nearest.triangle,
            feature: self.nearest.feature,
        })
    }
}
