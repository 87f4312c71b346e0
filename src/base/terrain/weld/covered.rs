//! Triangles that lie on others: each of their points is within the weld tolerance of a triangle that came before.
//!
//! So lies a sheet that is there twice, with other diagonals or in another triangulation, or tilted by less than the tolerance.
//! What covers is kept, so that no stack of sheets collapses onto its first one.
//!
//! Cost: in a single sheet, as its edges tell, nothing lies on anything. Else every triangle is asked what of the smaller sheets
//! lies beside it: O(n log n).

use super::Welded;
use crate::parallel;
use crate::rock::Vec3;
use crate::terrain::index::{Index, Sizes};
use outline::{PlaneOutline, lies_beneath};

/// Least share of the smaller one of two triangles over which they overlap (–): less is a seam.
const LEAST_OVERLAP: f64 = 1e-3;

/// Triangles that may lie on others or be lain on, in the order of their index.
struct Suspects {
    index: Index,
    triangles: Vec<u32>,
    is_one: Vec<bool>,
}

impl Welded {
    /// The triangles that others before them cover, ascending.
    pub(super) fn covered_triangles(&self) -> Vec<u32> {
        let Some(suspects) = self.suspects() else { return Vec::new() };
        let lying = self.overlaps(&suspects);
        let groups: Vec<&[[u32; 2]]> = lying.chunk_by(|a, b| a[0] == b[0]).collect();
        let later = |k: usize| groups[k][0][0];
        let covers = |k: usize| groups[k].iter().map(|pair| pair[1]);
        let is_covered = |k: u32| self.is_covered(later(k as usize), covers(k as usize));
        let at_all = parallel::filter(groups.len(), is_covered);
        let goes: Vec<u32> = at_all.iter().map(|&k| later(k as usize)).collect();
        // what goes itself covers nothing
        let stays = |cover: &u32| goes.binary_search(cover).is_err();
        let is_left_out = |&k: &usize| {
            covers(k).all(|cover| stays(&cover))
                || self.is_covered(later(k), covers(k).filter(stays))
        };
        let left_out = |at: usize| Some(at_all[at] as usize).filter(is_left_out).map(later);
        parallel::filter_map(at_all.len(), left_out)
    }

    /// How far a sheet may be off another that it lies on (m): rounding at least.
    fn lying_m(&self, corners: &[Vec3; 3]) -> f64 {
        let [a, b, c] = corners;
        let size = (b - a).amax().max((c - a).amax());
        self.tolerance_m.max(1e-12 * size)
    }

    /// All triangles beside the largest part of the mesh, and those of it that share an edge with two others or lie folded back
    /// on the next one; none if the mesh is one sheet.
    fn suspects(&self) -> Option<Suspects> {
        let parts = self.parts();
        // part 0 is the largest
        let is_one = parallel::map(parts.of.len(), |t| {
            parts.of[t] != 0 || (0..3).any(|k| self.is_doubled(3 * t as u32 + k))
        });
        let all: Vec<u32> = (0..is_one.len() as u32).filter(|&t| is_one[t as usize]).collect();
        if all.is_empty() {
            return None;
        }
        let corners = |k: u32| self.corners_m(all[k as usize] as usize);
        let (index, order) = Index::build(all.len(), Sizes::SMALL, corners);
        let triangles = order.into_iter().map(|k| all[k as usize]).collect();
        Some(Suspects { index, triangles, is_one })
    }

    /// Whether the edge of a side has three triangles or more, or two on the same side of it in one plane.
    fn is_doubled(&self, side: u32) -> bool {
        let Some(sides) = self.edges.sides_of_pair(side) else {
            return !self.edges.is_border(side);
        };
        let [a, b] = self.ends(side).map(|v| self.vertices_m[v as usize]);
        let apex = |side: u32| {
            let corners = self.triangles[side as usize / 3];
            self.vertices_m[corners[(side as usize + 2) % 3] as usize]
        };
        let [one, other] = sides.map(|side| apex(side) - a);
        let (along, normal) = (b - a, (b - a).cross(&one));
        let height = normal.dot(&other).abs();
        normal.dot(&along.cross(&other)) > 0.0
            && height <= self.lying_m(&[a, b, a + one]) * normal.norm()
    }

    /// Pairs of triangles that overlap within the tolerance, the later one first, sorted.
    fn overlaps(&self, suspects: &Suspects) -> Vec<[u32; 2]> {
        let of_triangle = |t: usize| {
            let corners = self.corners_m(t);
            let reach_m = self.lying_m(&corners);
            let (low, high) = around(&corners);
            let (middle, half) = ((low + high) / 2.0, (high - low).amax() / 2.0 + reach_m);
            let mut pairs = Vec::new();
            suspects.index.near(&middle, half, |start, count| {
                for &other in &suspects.triangles[start as usize..(start + count) as usize] {
                    let is_first = other < t as u32 || !suspects.is_one[t];
                    let pair = [other.max(t as u32), other.min(t as u32)];
                    if is_first && other != t as u32 && self.lie_together(pair, reach_m) {
                        pairs.push(pair);
                    }
                }
            });
            Some(pairs).filter(|pairs| !pairs.is_empty())
        };
        let mut all = parallel::filter_map(self.triangles.len(), of_triangle).concat();
        all.sort_unstable();
        all
    }

    /// Whether two triangles overlap by more than a seam, one within the tolerance of the other.
    fn lie_together(&self, [one, other]: [u32; 2], reach_m: f64) -> bool {
        let [one, other] = [one, other].map(|t| self.corners_m(t as usize));
        let ((low, high), (other_low, other_high)) = (around(&one), around(&other));
        let reach = Vec3::repeat(reach_m);
        let apart = |low: Vec3, high: Vec3| {
            (low - reach).zip_fold(&high, false, |any, low, high| any || low > high)
        };
        if apart(low, other_high) || apart(other_low, high) {
            return false;
        }
        let outline = PlaneOutline::of(&one);
        let Some(cover) = outline.flattened(&other) else { return false };
        let smaller = outline.area_m2().min(cover.area_m2());
        cover.area_over_m2(&outline, reach_m) > LEAST_OVERLAP * smaller
    }

    /// Whether triangles cover another one: what they leave of it is narrower than the tolerance, and a small part of it.
    fn is_covered(&self, t: u32, covers: impl Iterator<Item = u32>) -> bool {
        let corners = self.corners_m(t as usize);
        lies_beneath(
            &corners,
            self.lying_m(&corners),
            covers.map(|cover| self.corners_m(cover as usize)),
        )
    }
}

/// Lower and upper corner of the box around a triangle (m).
fn around([a, b, c]: &[Vec3; 3]) -> (Vec3, Vec3) {
    (a.inf(b).inf(c), a.sup(b).sup(c))
}

mod outline;
#[cfg(test)]
mod tests;
