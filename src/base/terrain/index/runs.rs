//! Triangles by where they lie, halved until a part fits one tree.

use crate::parallel;
use crate::rock::Vec3;

/// A triangle by its number in the input, and where it lies.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlacedTriangle {
    /// Three times its centre (m): only the order counts, and what is equal here is told apart by the number.
    centre: [f32; 3],
    pub(super) triangle: u32,
}

impl PlacedTriangle {
    pub(super) fn of(triangle: u32, corners: &(impl Fn(u32) -> [Vec3; 3] + Sync)) -> Self {
        let centre = corners(triangle).iter().sum::<Vec3>();
        Self { centre: centre.map(|m| m as f32).into(), triangle }
    }
}

/// Least and largest coordinates (m).
type Spans = ([f32; 3], [f32; 3]);

/// Triangles that stand side by side in the index.
pub(super) struct Run<'a> {
    /// Place of the first one in the index.
    pub(super) start: u32,
    pub(super) triangles: &'a mut [PlacedTriangle],
    /// Node and child under which it hangs; none for the root.
    pub(super) above: Option<(usize, usize)>,
}

impl Run<'_> {
    /// Cut across the middle of the side along which the centres lie widest apart; as many triangles in both, and the same
    /// ones whatever order they come in.
    fn halves(self) -> [Self; 2] {
        let axis = self.widest();
        let by_place = |a: &PlacedTriangle, b: &PlacedTriangle| {
            a.centre[axis].total_cmp(&b.centre[axis]).then(a.triangle.cmp(&b.triangle))
        };
        let middle = self.triangles.len() / 2;
        self.triangles.select_nth_unstable_by(middle, by_place);
        let (low, high) = self.triangles.split_at_mut(middle);
        let next = self.start + middle as u32;
        let part = |start, triangles| Run { start, triangles, above: self.above };
        [part(self.start, low), part(next, high)]
    }

    /// The axis along which the centres lie widest apart.
    fn widest(&self) -> usize {
        let nothing = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let both = |(mut lo, mut hi): Spans, (other_lo, other_hi): Spans| {
            for k in 0..3 {
                lo[k] = lo[k].min(other_lo[k]);
                hi[k] = hi[k].max(other_hi[k]);
            }
            (lo, hi)
        };
        let add = |all, at: usize| {
            let centre = self.triangles[at].centre;
            both(all, (centre, centre))
        };
        let (lo, hi) = parallel::fold(self.triangles.len(), &nothing, add, both);
        Vec3::from([0, 1, 2].map(|k| f64::from(hi[k]) - f64::from(lo[k]))).imax()
    }
}

impl<'a> Run<'a> {
    /// Cut into halves, and those again.
    pub(super) fn quarters(self) -> [Run<'a>; 4] {
        let [low, high] = self.halves();
        let (low, high) = rayon::join(|| low.halves(), || high.halves());
        let ([a, b], [c, d]) = (low, high);
        [a, b, c, d]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::make;

    /// The parts do not hang on the order in which triangles come.
    #[test]
    fn halves_are_the_same_whatever_the_order() {
        let facets = make::natural_slope(20, 20).facets;
        let corners = |t: u32| facets[t as usize];
        let halves = |triangles: Vec<u32>| {
            let mut placed: Vec<PlacedTriangle> =
                triangles.into_iter().map(|t| PlacedTriangle::of(t, &corners)).collect();
            let halves = Run { start: 0, triangles: &mut placed, above: None }.halves();
            halves.map(|half| {
                let mut half: Vec<u32> = half.triangles.iter().map(|p| p.triangle).collect();
                half.sort_unstable();
                half
            })
        };
        let all = 0..facets.len() as u32;
        assert_eq!(halves(all.clone().collect()), halves(all.rev().collect()));
    }
}
