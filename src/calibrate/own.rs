//! Places of release that measured and computed ends have in common.

use crate::hazard::ObservedPath;
use crate::math;

/// A measured end was released from a place of the scene if that is no farther away (m): positions are measured to a
/// centimetre or two, and typed with two decimals.
const SAME_PLACE_M: f64 = 0.1;

/// A place of release (m), and the block that was thrown from it, if it is known.
pub(crate) type ThrownFrom<'a> = ([f64; 2], Option<&'a str>);

/// Places of release that measured ends and releases have in common.
pub(crate) struct OwnPlaces {
    /// Place of each measured end.
    pub(super) of_end: Vec<usize>,
    /// Place of each release, in turn; none where nothing was measured.
    of_release: Vec<Option<usize>>,
}

impl OwnPlaces {
    /// None unless every measured end was released from one of the places. Where both sides name their blocks, a place is
    /// common to throws of one block only: blocks roll unlike.
    pub(crate) fn of(
        measured: &[ObservedPath],
        blocks: &[String],
        places: &[ThrownFrom],
    ) -> Option<Self> {
        let is_same = |(one, its): &ThrownFrom, (other, others): &ThrownFrom| {
            is_near(one, other) && (its.is_none() || others.is_none() || its == others)
        };
        let ends = measured.iter().enumerate();
        let ends: Vec<ThrownFrom> =
            ends.map(|(row, way)| (way.start_m, blocks.get(row).map(String::as_str))).collect();
        let place = |from: &ThrownFrom| ends.iter().position(|end| is_same(end, from));
        let of_release: Vec<Option<usize>> = places.iter().map(place).collect();
        let of_end: Vec<usize> = ends.iter().filter_map(place).collect();
        let is_released = |place: &usize| of_release.contains(&Some(*place));
        let common = !of_end.is_empty() && of_end.iter().all(is_released);
        common.then_some(Self { of_end, of_release })
    }

    /// The place of a release; none where nothing was measured.
    pub(super) fn of_release(&self, index: usize) -> Option<usize> {
        self.of_release[index % self.of_release.len()]
    }

    /// What computed ways weigh beside some rows of the measured ends, each with its place and what it stands for: those from the place of
    /// one weigh as much as it, all together, and those from other places nothing.
    pub(crate) fn weights(&self, rows: &[usize], computed: &[(Option<usize>, f64)]) -> Vec<f64> {
        let mut counts = vec![[0.0, 0.0]; self.of_end.len()];
        for &row in rows {
            counts[self.of_end[row]][0] += 1.0;
        }
        for (place, weight) in computed {
            if let Some(place) = place {
                counts[*place][1] += weight;
            }
        }
        let weight = |(place, weight): &(Option<usize>, f64)| {
            place.map_or(0.0, |place| weight * counts[place][0] / counts[place][1])
        };
        computed.iter().map(weight).collect()
    }

    /// How many places the releases take in turn.
    pub(super) fn in_turn(&self) -> usize {
        self.of_release.len()
    }
}

/// The place of the measured ends that a way from there (m) shares, if it does one.
pub(crate) fn place_of(measured: &[ObservedPath], start_m: &[f64; 2]) -> Option<usize> {
    measured.iter().position(|end| is_near(&end.start_m, start_m))
}

fn is_near(one: &[f64; 2], other: &[f64; 2]) -> bool {
    math::hypot(one[0] - other[0], one[1] - other[1]) <= SAME_PLACE_M
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three ends from one place and one from another, which the scene releases from evenly, and from a third.
    #[test]
    fn ends_are_compared_from_their_own_places() {
        let way = |x: f64, y: f64| ObservedPath { start_m: [x, 0.0], end_m: [x, y], open: None };
        let measured = [way(0.0, 1.0), way(5.0, 2.0), way(0.05, 3.0), way(0.0, 4.0)];
        let places = [[0.0, 0.0], [5.0, 0.0], [9.0, 0.0]].map(|at| (at, None));
        let own = OwnPlaces::of(&measured, &[], &places).unwrap();
        assert_eq!(own.of_end, [0, 1, 0, 0]);
        assert_eq!(
            (0..4).map(|k| own.of_release(k)).collect::<Vec<_>>(),
            [Some(0), Some(1), None, Some(0)]
        );
        assert!(OwnPlaces::of(&measured, &[], &places[..1]).is_none());
        assert!(OwnPlaces::of(&measured, &[], &[]).is_none());
        // the same with blocks: two were thrown from the first place
        let blocks = ["a", "b", "c", "a"].map(str::to_owned);
        let thrown = [([0.0, 0.0], Some("a")), ([5.0, 0.0], Some("b")), ([0.0, 0.0], Some("c"))];
        let own = OwnPlaces::of(&measured, &blocks, &thrown).unwrap();
        assert_eq!(own.of_end, [0, 1, 2, 0]);
        assert_eq!(
            (0..3).map(|k| own.of_release(k)).collect::<Vec<_>>(),
            [Some(0), Some(1), Some(2)]
        );
    }
}
