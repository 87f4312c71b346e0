//! How far apart two distributions of runout lie, of which one may be known in part.
//!
//! A rock that left the terrain or was still moving has run at least as far as it was seen. So the computed distribution lies between two:
//! that of all rocks as they were last seen, and that in which the open ones run farther than any number. Both ends of a distance hold however these
//! rocks would have ended (worst-case bounds, Manski 1990). The product-limit estimator (Kaplan and Meier 1958) is none for them: it takes
//! those that are cut off for as good as those that are not, and a rock whose time is up is a fast or a far one.

use super::{ObservedPath, Weighted};

/// Largest difference of one distribution from its own sample, times √n, which is exceeded in 5 % of all samples (Kolmogorov
/// 1933).
pub const KOLMOGOROV_95: f64 = 1.36;

/// Difference of two distributions of so many values each that equal ones exceed in 5 % of all samples (–).
pub fn ks_limit(n: f64, m: f64) -> f64 {
    KOLMOGOROV_95 * ((n + m) / (n * m)).sqrt()
}

/// Runouts (m) as they were seen and weights, ascending; what weighs nothing or is no number is left out.
pub fn runouts(ways: &[Weighted]) -> Vec<(f64, f64)> {
    ascending(ways).into_iter().map(|(runout, weight, _)| (runout, weight)).collect()
}

/// The same, each with whether it is only a lower bound.
fn ascending(ways: &[Weighted]) -> Vec<(f64, f64, bool)> {
    let each =
        ways.iter().map(|(way, weight)| (ObservedPath::runout_m(way), *weight, way.open.is_some()));
    let mut sorted: Vec<(f64, f64, bool)> =
        each.filter(|(runout, weight, _)| runout.is_finite() && *weight > 0.0).collect();
    sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
    sorted
}

/// How far the distribution of measured runouts lies from that of computed ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunoutDistances {
    /// Largest difference of the two (–), Kolmogorov and Smirnov: the least and the most that it can be, however open rocks would have ended.
    pub ks: [f64; 2],
    /// The least area between them (m).
    pub area_m: f64,
}

impl RunoutDistances {
    /// None where either side is empty.
    pub fn of(measured: &[Weighted], computed: &[Weighted]) -> Option<Self> {
        let (one, other) = (ascending(measured), ascending(computed));
        (!one.is_empty() && !other.is_empty()).then(|| Self::between(&one, &other))
    }

    fn between(one: &[(f64, f64, bool)], other: &[(f64, f64, bool)]) -> Self {
        let total = |values: &[(f64, f64, bool)]| values.iter().map(|v| v.1).sum::<f64>();
        let (whole_one, whole_other) = (total(one), total(other));
        let (mut i, mut j, mut below, mut seen, mut ended) = (0, 0, 0.0, 0.0, 0.0);
        let mut found = Self { ks: [0.0; 2], area_m: 0.0 };
        let mut before: Option<(f64, f64)> = None;
        while i < one.len() || j < other.len() {
            let next = |values: &[(f64, f64, bool)], at: usize| {
                values.get(at).map_or(f64::INFINITY, |v| v.0)
            };
            let x = next(one, i).min(next(other, j));
            found.area_m += before.map_or(0.0, |(before, gap)| gap * (x - before));
            while next(one, i) <= x && i < one.len() {
                below += one[i].1;
                i += 1;
            }
            while next(other, j) <= x && j < other.len() {
                let (_, weight, is_open) = other[j];
                seen += weight;
                ended += if is_open { 0.0 } else { weight };
                j += 1;
            }
            let gaps = gaps(below / whole_one, [ended / whole_other, seen / whole_other]);
            found.ks = [0, 1].map(|end| found.ks[end].max(gaps[end]));
            before = Some((x, gaps[0]));
        }
        found
    }
}

/// The least and the most by which a share differs from one that lies between two (–).
fn gaps(share: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    let (below, above) = (low - share, share - high);
    [below.max(above).max(0.0), below.abs().max(above.abs())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hazard::StopKind;

    fn ways(runouts: &[(f64, bool)]) -> Vec<Weighted> {
        let way = |&(runout_m, is_open): &(f64, bool)| {
            let open = is_open.then_some(StopKind::TimeUp);
            (ObservedPath { start_m: [5.0, 5.0], end_m: [5.0, 5.0 + runout_m], open }, 1.0)
        };
        runouts.iter().map(way).collect()
    }

    fn measured() -> Vec<Weighted> {
        ways(&[(1.0, false), (2.0, false), (3.0, false), (4.0, false)])
    }

    /// By hand: of four rocks that ended at 1, 2, 3 and 4 m two were last seen at 2.5 and 0.5 m. If they ended as the missing two of the measured ones, nothing
    /// differs. As seen, the shares are 1/4 to 0 at 0.5 m; farther than any, 2/4 for 4/4 from 4 m on.
    #[test]
    fn open_rocks_leave_a_distance_between_two() {
        let computed = ways(&[(1.0, false), (2.5, true), (3.0, false), (0.5, true)]);
        let found = RunoutDistances::of(&measured(), &computed).unwrap();
        assert_eq!(found, RunoutDistances { ks: [0.0, 0.5], area_m: 0.0 });
    }

    /// A rock last seen beyond all measured ends leaves nothing open, wherever it went: 1 − 3/4 at 4 m.
    #[test]
    fn open_rocks_beyond_all_measured_ends_leave_nothing_open() {
        for is_open in [false, true] {
            let computed = ways(&[(1.0, false), (2.0, false), (3.0, false), (9.0, is_open)]);
            let found = RunoutDistances::of(&measured(), &computed).unwrap();
            assert!(found.ks.iter().all(|ks| (ks - 0.25).abs() < 1e-15), "{is_open}: {found:?}");
            assert!((found.area_m - 1.25).abs() < 1e-15, "{found:?}");
        }
    }

    /// Wherever open rocks end, at what they were seen or farther, both distances lie within the bounds.
    #[test]
    fn the_bounds_hold_for_every_way_of_ending() {
        let computed = ways(&[
            (0.5, false),
            (1.5, true),
            (2.0, false),
            (3.5, true),
            (3.7, false),
            (6.0, true),
        ]);
        let bounds = RunoutDistances::of(&measured(), &computed).unwrap();
        let farther = [0.0, 0.4, 1.1, 2.0, 4.0, 50.0];
        for moves in (0..216).map(|k| [k % 6, k / 6 % 6, k / 36].map(|at: usize| farther[at])) {
            let mut moves = moves.into_iter();
            let ended = computed.iter().map(|(way, weight)| {
                let more = way.open.and_then(|_| moves.next()).unwrap_or(0.0);
                let [x, y] = way.end_m;
                (ObservedPath { end_m: [x, y + more], open: None, ..*way }, *weight)
            });
            let found = RunoutDistances::of(&measured(), &ended.collect::<Vec<_>>()).unwrap();
            assert!(bounds.ks[0] <= found.ks[0] && found.ks[1] <= bounds.ks[1] + 1e-15);
            assert!(bounds.area_m <= found.area_m + 1e-12, "{bounds:?} {found:?}");
        }
        assert!(bounds.ks[0] < bounds.ks[1]);
    }
}
