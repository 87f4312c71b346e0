//! The subset of the collected features that may be touched on a short path.
//!
//! Features are collected for a large part of the radius, because a collection is expensive. An
//! impact moves a few millimetres and queries its contacts some thirty times. Features out of reach
//! of its path are skipped: the results are the same, to the bit.

use super::features::may_touch_edge;
use super::{NearFeatures, NearSaddle, Neighbours, SLACK};
use crate::contact::closest::closest_on;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// Added to the length of a path (–, relative to the radius): more than rounding and the slack of
/// all tests.
const PATH_MARGIN: f64 = 1e-6;

/// A bound on the centre of a rock for a short time.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShortPath {
    centre: Vec3,
    /// Largest distance from there (m).
    length_m: f64,
    /// Largest distance at which contacts are queried (m).
    reach: f64,
}

impl ShortPath {
    /// No path.
    pub(super) const NONE: Self =
        Self { centre: Vec3::new(0.0, 0.0, 0.0), length_m: -1.0, reach: 0.0 };

    /// Whether `point` is within the bound, with at least `beyond_m` to spare.
    fn holds(&self, point: &Vec3, beyond_m: f64) -> bool {
        let room = self.length_m - beyond_m;
        room >= 0.0 && (point - self.centre).norm_squared() <= room * room
    }
}

impl Neighbours {
    /// Features that may be nearer than `reach` (m) to a centre: few if the centre is on the known
    /// short path.
    #[inline]
    pub(super) fn candidates(&self, (centre, reach): (&Vec3, f64)) -> &NearFeatures {
        let is_close = reach <= self.short_path.reach && self.short_path.holds(centre, 0.0);
        if is_close { &self.close } else { &self.all }
    }

    /// Prepares queries of contacts nearer than `reach` for a centre that moves from `centre` by
    /// `next_m` now and by `length_m` in all (m).
    pub fn prepare_short_path(
        &mut self,
        terrain: &Terrain,
        centre: &Vec3,
        (next_m, length_m): (f64, f64),
        reach: f64,
    ) {
        if reach <= self.short_path.reach && self.short_path.holds(centre, next_m) {
            return;
        }
        self.short_path = ShortPath { centre: *centre, length_m, reach };
        let mut close = std::mem::take(&mut self.close);
        close.clear();
        self.select_reachable(terrain, &mut close);
        self.close = close;
    }

    /// Whether a rock certainly touches nothing within `reach` (m) while its centre stays within
    /// `length_m` of `centre`.
    pub(crate) fn are_out_of_reach(
        &mut self,
        terrain: &Terrain,
        centre: &Vec3,
        (length_m, reach): (f64, f64),
    ) -> bool {
        if self.margin_left_m(centre) < length_m {
            return false;
        }
        self.prepare_short_path(terrain, centre, (length_m, length_m), reach);
        let NearFeatures { faces, edges, vertices, saddles, .. } = &self.close;
        faces.is_empty() && edges.is_empty() && vertices.is_empty() && saddles.is_empty()
    }

    /// Selects the features that may be touched on the short path: each test of
    /// [`Neighbours::touches`], with the path's length as margin.
    fn select_reachable(&self, terrain: &Terrain, close: &mut NearFeatures) {
        let ShortPath { centre, length_m, reach } = &self.short_path;
        let length = length_m + PATH_MARGIN * self.radius;
        let farthest = reach + length;
        close.faces.extend(self.all.faces.iter().filter(|face| {
            face.n.dot(&(centre - face.a)).abs() < farthest && face.holds_foot_of(centre, length)
        }));
        close.edges.extend(self.all.edges.iter().filter(|edge| {
            let to = centre - edge.line.a;
            may_touch_edge(&edge.line, centre, (length, farthest))
                && self
                    .directions_of(edge.directions)
                    .iter()
                    .all(|out| out.dot(&to) > -length - SLACK * farthest)
        }));
        close.vertices.extend(self.all.vertices.iter().filter(|vertex| {
            let to = centre - vertex.p;
            to.norm_squared() < farthest * farthest
                && self
                    .directions_of(vertex.directions)
                    .iter()
                    .all(|direction| direction.dot(&to) < length + SLACK * farthest)
        }));
        close.saddles.extend(self.all.saddles.iter().filter(|saddle| match saddle {
            NearSaddle::Edge { line, directions } => {
                let to = centre - line.a;
                may_touch_edge(line, centre, (length, farthest))
                    && self.directions_of(*directions).iter().all(|out| out.dot(&to) < length)
            }
            NearSaddle::Vertex { p, .. } => (centre - p).norm_squared() < farthest * farthest,
        }));
        // patches exist only at saddles: without one the triangles are not needed
        if !close.saddles.is_empty() {
            close.sheets.extend(self.all.sheets.iter().filter(|&&t| {
                let face = terrain.face(t);
                face.n.dot(&(centre - face.a)).abs() < farthest && {
                    let nearest = closest_on(&terrain.corners_m(t), centre);
                    (centre - nearest).norm_squared() < farthest * farthest
                }
            }));
        }
    }
}
