//! What may touch on a short way, of all that was collected.
//!
//! Features are collected for a good part of the radius, as that is not cheap; an impact goes a few millimetres, and asks some
//! thirty times what is touched. What its way cannot reach is passed over: the answers are the same, to the bit.

use super::features::may_touch_edge;
use super::{NearFeatures, NearSaddle, Neighbours, SLACK};
use crate::contact::closest::closest_on;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// By how much a way is taken longer than it is (–, relative to the radius): more than rounding and the slack of all tests.
const PATH_MARGIN: f64 = 1e-6;

/// Where the centre of a rock stays for a short while.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShortPath {
    centre: Vec3,
    /// How far it gets from there (m).
    length_m: f64,
    /// How far from the centre touches are asked for, at most (m).
    reach: f64,
}

impl ShortPath {
    /// Nowhere.
    pub(super) const NONE: Self =
        Self { centre: Vec3::new(0.0, 0.0, 0.0), length_m: -1.0, reach: 0.0 };

    /// Whether `point` is on it, and `beyond_m` farther.
    fn holds(&self, point: &Vec3, beyond_m: f64) -> bool {
        let room = self.length_m - beyond_m;
        room >= 0.0 && (point - self.centre).norm_squared() <= room * room
    }
}

impl Neighbours {
    /// The features that may be nearer than `reach` (m) to a centre: few where it is on the short way that is known.
    #[inline]
    pub(super) fn candidates(&self, (centre, reach): (&Vec3, f64)) -> &NearFeatures {
        let is_close = reach <= self.short_path.reach && self.short_path.holds(centre, 0.0);
        if is_close { &self.close } else { &self.all }
    }

    /// Makes ready for touches nearer than `reach` on a way from `centre` of `next_m`, and of `length_m` in all (m).
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

    /// Whether it is sure that a rock touches nothing from nearer than `reach` (m) while its centre stays within `length_m` of `centre`.
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

    /// Chooses what may touch on the short way: every test of [`Neighbours::touches`], with the way allowed for.
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
        // a patch is where a saddle is: without one the triangles are not asked for
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
