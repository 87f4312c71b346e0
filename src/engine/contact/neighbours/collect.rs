//! What of a triangle can touch a rock whose centre stays within a margin.
//!
//! Every test here bounds what the centre may do within the margin, so it may take too much and
//! never too little: what it leaves out cannot be touched from any place within the margin, and the
//! tests of each place (`touches`) are made on what is left. On a slope of triangles as large as
//! the rock that is some ten triangles, and of their edges and vertices hardly any.

use super::features::may_meet;
use super::{NearCorner, NearEdge, NearFace, NearSaddle, Neighbours, SLACK};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::brims::Brim;
use crate::terrain::faces::Face;
use crate::terrain::seen::Seen;

/// What stands out on one side of a triangle is not touched from further than this on the other (–, relative to the
/// distance): edges turn by 1e-6 at least before they are said to stand out, and tests have a slack of 1e-9.
const ASIDE: f64 = 0.01;
/// Rounding of the sine of a brim's steepest direction (–).
const ASIDE_SLACK: f32 = 1e-3;

impl Neighbours {
    /// Takes of one triangle what may touch; the centre is `to` from its first corner and `height` over its plane (m).
    ///
    /// `height` is signed along the triangle's normal; `to` is `c − a`. Nothing is taken twice:
    /// each edge and vertex has one owner.
    pub(super) fn take(
        &mut self,
        terrain: &Terrain,
        (t, face): (u32, &Face),
        (to, height): (Vec3, f64),
    ) {
        self.all.sheets.push(t);
        // how far the foot of the centre may come while the centre moves within the margin
        let near = self.margin + SLACK * self.radius;
        let brim = &terrain.features.brims[t as usize];
        self.take_vertices(terrain, t, brim.vertices);
        let (owned, beside) = self.within_sight(brim, height);
        let (hollow, beside_hollow) = self.hollow_in_sight(brim, height);
        let beside = beside.max(beside_hollow).max(near);
        // `beside` is the farthest beside the triangle at which any of its parts can be touched:
        // beyond it nothing of it is
        let Some(seen) = Seen::of(face, to, (height, beside)) else { return };
        // a face is touched only where the foot lies inside it
        if seen.is_within(near) {
            self.take_face(t, face);
        }
        for k in (0..3).filter(|_| owned | hollow != 0) {
            if owned & (1 << k) != 0 && seen.may_meet_edge(k, (near, self.reach)) {
                self.take_edge(terrain, (3 * t + k as u32, face));
            }
            if hollow & (1 << k) != 0 && seen.may_press_edge(k, (near, self.radius + near)) {
                self.take_hollow(terrain, (3 * t + k as u32, face));
            }
            if owned & (8 << k) != 0 && seen.may_meet_corner(k, (near, self.reach)) {
                self.take_corner(terrain, terrain.triangles[t as usize][k], t);
            }
        }
    }

    /// Unit vectors out of the face across its three sides, `side × n`, and what `out · x` is on
    /// each side: the test of a foot is then three scalar products and three comparisons.
    fn take_face(&mut self, t: u32, face: &Face) {
        let corners = [face.a, face.a + face.e1, face.a + face.e2];
        // counter-clockwise as seen against the normal: a→b, b→c, c→a
        let sides = [face.e1, face.e2 - face.e1, -face.e2];
        let out = sides.map(|side| side.cross(&face.n).normalize());
        let rim = [0, 1, 2].map(|k| out[k].dot(&corners[k]));
        self.all.faces.push(NearFace { id: t, a: face.a, n: face.n, out, rim });
    }

    /// Those of the edges and corners on a triangle's brim that can be touched from the side on which the centre is, and
    /// how far beside the triangle it can be then (m).
    ///
    /// A normal cone that leans by no more than an angle with the cosine `steepest` is touched only
    /// from within `reach √(1 − steepest²)` beside the triangle.
    #[inline]
    fn within_sight(&self, brim: &Brim, height: f64) -> (u8, f64) {
        let sure = self.margin + ASIDE * self.reach;
        let (mut owned, mut steepest) = (0, 1.0);
        if height >= -sure && brim.front != 0 {
            (owned, steepest) = (brim.front, brim.least_front);
        }
        if height <= sure && brim.back != 0 {
            (owned, steepest) = (owned | brim.back, brim.least_back.min(steepest));
        }
        if brim.anywhere != 0 {
            return (owned | brim.anywhere, self.reach);
        }
        let aside = (1.0 - steepest * steepest).max(0.0).sqrt() + ASIDE_SLACK;
        (owned, self.margin + (self.reach - self.margin) * f64::from(aside))
    }

    /// Those of the edges on a triangle's brim that can be hollow on the side on which the centre is, and how far beside
    /// the triangle it can be where the ball presses into them (m): the cone in which an edge is hollow is the opposite
    /// of that in which it stands out.
    #[inline]
    fn hollow_in_sight(&self, brim: &Brim, height: f64) -> (u8, f64) {
        let sure = self.margin + ASIDE * self.reach;
        let (mut hollow, mut steepest) = (0, 1.0);
        if height >= -sure && brim.back & 7 != 0 {
            (hollow, steepest) = (brim.back & 7, brim.least_back);
        }
        if height <= sure && brim.front & 7 != 0 {
            (hollow, steepest) = (hollow | brim.front & 7, brim.least_front.min(steepest));
        }
        if brim.anywhere & 7 != 0 {
            return (hollow | brim.anywhere & 7, self.radius + self.margin);
        }
        let aside = (1.0 - steepest * steepest).max(0.0).sqrt() + ASIDE_SLACK;
        (hollow, self.margin + self.radius * f64::from(aside))
    }

    /// Takes an edge that the ball can press into from its hollow side; `face` is the first triangle on it.
    ///
    /// Two faces hold the foot of the centre at once only if the centre stands inside of both
    /// outward planes of the edge: the opposite of the condition under which an edge is touched.
    fn take_hollow(&mut self, terrain: &Terrain, (edge, face): (u32, &Face)) {
        let edges = &terrain.features.edges;
        if edges.is_border(edge) {
            return; // a border has a face on one side only: nothing meets there
        }
        let ends_m @ [a, b] = terrain.mesh().ends_m(edge);
        let length = (b - a).norm();
        let along = (b - a) / length;
        let to = self.centre - a;
        // distance of the centre from the edge, its ends included: a ball that does not reach it
        // has no saddle there
        let off = to - along * along.dot(&to).clamp(0.0, length);
        if off.norm() > self.radius + self.margin {
            return;
        }
        let first = self.rays.len();
        // an edge of three sheets and more has no simple condition: it is kept whatever the
        // directions
        if let Some([_, other]) = edges.pair_on(edge) {
            for outward in [face.outward(&ends_m), terrain.face(other).outward(&ends_m)] {
                if outward.dot(&off) > self.margin + SLACK * self.radius {
                    self.rays.truncate(first);
                    return;
                }
                self.rays.push(outward);
            }
        }
        let rays = (first as u32, self.rays.len() as u32);
        self.all.saddles.push(NearSaddle::Edge { a, along, length, rays });
    }

    /// Takes the vertices of one triangle that the ball can press into.
    #[inline]
    fn take_vertices(&mut self, terrain: &Terrain, t: u32, vertices: u8) {
        for k in (0..3).filter(|k| vertices & (1 << k) != 0) {
            let id = terrain.triangles[t as usize][k];
            let p = terrain.vertices_m[id as usize];
            let reach = self.radius + self.margin;
            if (self.centre - p).norm_squared() < reach * reach {
                self.all.saddles.push(NearSaddle::Vertex { id, p });
            }
        }
    }

    /// Takes an edge; `face` is the first triangle on it.
    ///
    /// `along` is its unit vector. Left out where the foot
    /// stays beyond its ends, the line farther than the reach, or the centre behind one of its
    /// faces, for all places within the margin.
    fn take_edge(&mut self, terrain: &Terrain, (edge, face): (u32, &Face)) {
        let ends_m @ [a, b] = terrain.mesh().ends_m(edge);
        let length = (b - a).norm();
        let along = (b - a) / length;
        let to = self.centre - a;
        if !may_meet(&to, (&along, length), (self.margin, self.reach)) {
            return;
        }
        let first = self.rays.len();
        let edges = &terrain.features.edges;
        // in-plane unit vectors out of each triangle on the edge: `m_i`, and the contact test is (c
        // − p)·m_i ≥ 0 for all of them
        let others = edges.triangles_on(edge).skip(1).map(|t| terrain.face(t).outward(&ends_m));
        for outward in std::iter::once(face.outward(&ends_m)).chain(others) {
            if outward.dot(&to) < -self.margin - SLACK * self.radius {
                self.rays.truncate(first);
                return;
            }
            self.rays.push(outward);
        }
        let (rays, at_border) = ((first as u32, self.rays.len() as u32), edges.is_border(edge));
        self.all.edges.push(NearEdge {
            id: edge,
            triangle: edge / 3,
            a,
            along,
            length,
            rays,
            at_border,
        });
    }

    /// A vertex stands out only if every edge at it leads away from the centre: `(c − p)·e_j ≤ 0`,
    /// here with the margin allowed for.
    fn take_corner(&mut self, terrain: &Terrain, id: u32, owner: u32) {
        let p = terrain.vertices_m[id as usize];
        let to = self.centre - p;
        if to.norm() > self.reach {
            return;
        }
        let first = self.rays.len();
        for v in terrain.neighbours(id) {
            let along = (terrain.vertices_m[v as usize] - p).normalize();
            if along.dot(&to) > self.margin + SLACK * self.radius {
                self.rays.truncate(first);
                return;
            }
            self.rays.push(along);
        }
        let rays = (first as u32, self.rays.len() as u32);
        let at_border = terrain.features.is_border_vertex(id, terrain.mesh());
        self.all.corners.push(NearCorner { id, triangle: owner, p, rays, at_border });
    }
}
