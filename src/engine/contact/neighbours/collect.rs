//! Which features of a triangle can touch a rock whose centre stays within a margin.
//!
//! Every test bounds what the centre may do within the margin, so it may keep too much but never
//! too little. A feature left out cannot be touched from any place within the margin; the tests at
//! each position (`touches`) act on the rest. On a slope of triangles as large as the rock these
//! are some ten triangles, and hardly any of their edges and vertices.

use super::features::may_touch_edge;
use super::{NearEdge, NearFace, NearSaddle, NearVertex, Neighbours, SLACK};
use crate::contact::closest::Segment;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::faces::Face;
use crate::terrain::seen::Seen;

/// A feature that is convex on one side of a triangle is touched from no farther than this on the
/// other (–, relative to the distance): edges turn by 1e-6 at least before they count as convex,
/// and tests have a slack of 1e-9.
const OTHER_SIDE: f64 = 0.01;
/// Rounding of the sine of the steepest direction in a normal cone (–).
const SINE_SLACK: f32 = 1e-3;

impl Neighbours {
    /// Collects the features of one triangle that may be touched. The centre is `to` from its first
    /// corner and `height` over its plane (m).
    ///
    /// `height` is signed along the triangle's normal; `to` is `c − a`. Nothing is collected twice:
    /// each edge and vertex belongs to one triangle.
    pub(super) fn collect_triangle(
        &mut self,
        terrain: &Terrain,
        (t, face): (u32, &Face),
        (to, height): (Vec3, f64),
    ) {
        self.all.sheets.push(t);
        // how far the foot of the centre may move while the centre moves within the margin
        let near = self.margin + SLACK * self.radius;
        let brim = &terrain.features.brims[t as usize];
        self.collect_saddle_vertices(terrain, t, brim.vertices);
        let (front, back) = ((brim.front, brim.least_front), (brim.back, brim.least_back));
        let far = [self.reach, self.reach - self.margin];
        let (owned, beside) = self.touchable_from_side(([front, back], brim.anywhere), height, far);
        // the cone in which an edge is concave is the opposite of that in which it is convex
        let concave_lists = [(back.0 & 7, back.1), (front.0 & 7, front.1)];
        let far = [self.radius + self.margin, self.radius];
        let (concave, beside_concave) =
            self.touchable_from_side((concave_lists, brim.anywhere & 7), height, far);
        let beside = beside.max(beside_concave).max(near);
        // `beside` is the farthest distance beside the triangle from which any of its parts can be
        // touched
        let Some(seen) = Seen::of(face, to, (height, beside)) else { return };
        // a face is touched only if the foot lies inside it
        if seen.is_within(near) {
            self.collect_face(t, face);
        }
        for k in (0..3).filter(|_| owned | concave != 0) {
            if owned & (1 << k) != 0 && seen.may_meet_edge(k, (near, self.reach)) {
                self.collect_edge(terrain, (3 * t + k as u32, face));
            }
            if concave & (1 << k) != 0 && seen.may_press_edge(k, (near, self.radius + near)) {
                self.collect_concave_edge(terrain, (3 * t + k as u32, face));
            }
            if owned & (8 << k) != 0 && seen.may_meet_corner(k, (near, self.reach)) {
                self.collect_vertex(terrain, terrain.triangles[t as usize][k], t);
            }
        }
    }

    /// Stores a face with the unit vectors outwards across its three sides, `side × n`, and the
    /// value of `out · x` on each side: the test of a foot then takes three scalar products and
    /// three comparisons.
    fn collect_face(&mut self, t: u32, face: &Face) {
        let corners = [face.a, face.a + face.e1, face.a + face.e2];
        // counter-clockwise as seen against the normal: a→b, b→c, c→a
        let sides = [face.e1, face.e2 - face.e1, -face.e2];
        let out = sides.map(|side| side.cross(&face.n).normalize());
        let rim = [0, 1, 2].map(|k| out[k].dot(&corners[k]));
        self.all.faces.push(NearFace { id: t, a: face.a, n: face.n, out, rim });
    }

    /// Those edges and corners of a triangle that can be touched, or are concave, as seen from the
    /// centre's side: bits of the features in front of it, behind it, and on any side. With them
    /// the largest distance of the centre beside the triangle (m); `far` is the largest distance
    /// from the features with and without the margin.
    ///
    /// A normal cone that is inclined by at most an angle with the cosine `steepest` is touched
    /// only from within `far √(1 − steepest²)` beside the triangle.
    #[inline]
    fn touchable_from_side(
        &self,
        ([front, back], anywhere): ([(u8, f32); 2], u8),
        height: f64,
        far: [f64; 2],
    ) -> (u8, f64) {
        let certain = self.margin + OTHER_SIDE * self.reach;
        let (mut seen, mut steepest) = (0, 1.0);
        if height >= -certain && front.0 != 0 {
            (seen, steepest) = front;
        }
        if height <= certain && back.0 != 0 {
            (seen, steepest) = (seen | back.0, back.1.min(steepest));
        }
        if anywhere != 0 {
            return (seen | anywhere, far[0]);
        }
        let aside = (1.0 - steepest * steepest).max(0.0).sqrt() + SINE_SLACK;
        (seen, self.margin + far[1] * f64::from(aside))
    }

    /// Collects an edge that the ball can press into from its concave side; `face` is the first
    /// triangle at the edge.
    ///
    /// Two faces hold the foot of the centre at once only if the centre is inside both outward
    /// planes of the edge: the opposite of the condition under which the edge is touched.
    fn collect_concave_edge(&mut self, terrain: &Terrain, (edge, face): (u32, &Face)) {
        let edges = &terrain.features.edges;
        if edges.is_border(edge) {
            return; // a border has a face on one side only: nothing meets there
        }
        let ends_m = terrain.mesh().ends_m(edge);
        let line = Segment::between(ends_m);
        let to = self.centre - line.a;
        // distance of the centre from the edge, its ends included: a ball that does not reach the
        // edge has no saddle there
        let off = to - line.along * line.along.dot(&to).clamp(0.0, line.length);
        if off.norm() > self.radius + self.margin {
            return;
        }
        // an edge of three or more sheets has no simple condition: it is kept whatever the
        // directions
        let other = edges.pair_on(edge).map(|[_, other]| terrain.face(other));
        let faces = other.iter().flat_map(|other| [face, other]);
        let (out, most) =
            (faces.map(|face| face.outward(&ends_m)), self.margin + SLACK * self.radius);
        if let Some(directions) = self.keep_directions(out, |outward| outward.dot(&off) > most) {
            self.all.saddles.push(NearSaddle::Edge { line, directions });
        }
    }

    /// Stores the directions of an edge or a vertex; none if one of them `rules_out` a contact.
    fn keep_directions(
        &mut self,
        directions: impl Iterator<Item = Vec3>,
        rules_out: impl Fn(&Vec3) -> bool,
    ) -> Option<(u32, u32)> {
        let first = self.directions.len();
        for direction in directions {
            if rules_out(&direction) {
                self.directions.truncate(first);
                return None;
            }
            self.directions.push(direction);
        }
        Some((first as u32, self.directions.len() as u32))
    }

    /// Collects the vertices of one triangle that the ball can press into.
    #[inline]
    fn collect_saddle_vertices(&mut self, terrain: &Terrain, t: u32, vertices: u8) {
        for k in (0..3).filter(|k| vertices & (1 << k) != 0) {
            let id = terrain.triangles[t as usize][k];
            let p = terrain.vertices_m[id as usize];
            let reach = self.radius + self.margin;
            if (self.centre - p).norm_squared() < reach * reach {
                self.all.saddles.push(NearSaddle::Vertex { id, p });
            }
        }
    }

    /// Collects an edge; `face` is the first triangle at it.
    ///
    /// `along` is its unit vector. The edge is left out if, for all places within the margin, the
    /// foot stays beyond its ends, its line stays out of reach, or the centre stays behind one of
    /// its faces.
    fn collect_edge(&mut self, terrain: &Terrain, (edge, face): (u32, &Face)) {
        let ends_m = terrain.mesh().ends_m(edge);
        let line = Segment::between(ends_m);
        if !may_touch_edge(&line, &self.centre, (self.margin, self.reach)) {
            return;
        }
        let to = self.centre - line.a;
        let edges = &terrain.features.edges;
        // unit vectors in the plane of each triangle at the edge, outwards: `m_i`. The contact test
        // is (c − p)·m_i ≥ 0 for all of them
        let others = edges.triangles_on(edge).skip(1).map(|t| terrain.face(t).outward(&ends_m));
        let out = std::iter::once(face.outward(&ends_m)).chain(others);
        let least = -self.margin - SLACK * self.radius;
        if let Some(directions) = self.keep_directions(out, |outward| outward.dot(&to) < least) {
            let (triangle, at_border) = (edge / 3, edges.is_border(edge));
            self.all.edges.push(NearEdge { id: edge, triangle, line, directions, at_border });
        }
    }

    /// Collects a vertex. It can be touched only if every edge at it leads away from the centre:
    /// `(c − p)·e_j ≤ 0`, here with the margin added.
    fn collect_vertex(&mut self, terrain: &Terrain, id: u32, owner: u32) {
        let p = terrain.vertices_m[id as usize];
        let to = self.centre - p;
        if to.norm() > self.reach {
            return;
        }
        let others = terrain.neighbours(id);
        let along = others.map(|v| (terrain.vertices_m[v as usize] - p).normalize());
        let most = self.margin + SLACK * self.radius;
        if let Some(directions) = self.keep_directions(along, |along| along.dot(&to) > most) {
            let at_border = terrain.features.is_border_vertex(id, terrain.mesh());
            self.all.vertices.push(NearVertex { id, triangle: owner, p, directions, at_border });
        }
    }
}
