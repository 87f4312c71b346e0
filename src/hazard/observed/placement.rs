//! Where rocks may have ended that would have gone on.

use super::{ObservedPath, Weighted};

/// One way in which open rocks may have ended. Distances in plan view have no bound that holds for all ways, as a rock may go anywhere: they are
/// taken between the least and the most of these three.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenEnds {
    /// Where they were last seen.
    Seen,
    /// As the measured ones did that came at least as far, which take them in turn (redistribution to the right, Efron 1967): so they would if the trial were true.
    LikeMeasured,
    /// On their own line as far as the farthest measured one, or where they were seen beyond.
    Farthest,
}

impl OpenEnds {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Seen, Self::LikeMeasured, Self::Farthest];

    /// Computed ways beside measured ones, the open ones ended so.
    pub fn placed(self, measured: &[ObservedPath], mut computed: Vec<Weighted>) -> Vec<Weighted> {
        let mut sorted: Vec<&ObservedPath> = measured.iter().collect();
        sorted.sort_by(|one, other| one.runout_m().total_cmp(&other.runout_m()));
        let open = computed.iter_mut().filter(|(way, _)| way.open.is_some());
        for (turn, (way, _)) in open.enumerate() {
            let (runout_m, [x, y]) = (way.runout_m(), way.vector_m());
            let farther = &sorted[sorted.partition_point(|end| end.runout_m() < runout_m)..];
            let Some(last) = farther.last() else { continue };
            let [x, y] = match self {
                Self::Seen => continue,
                Self::LikeMeasured => farther[turn % farther.len()].vector_m(),
                Self::Farthest if runout_m > 0.0 => {
                    [x, y].map(|along| along * last.runout_m() / runout_m)
                }
                Self::Farthest => last.vector_m(),
            };
            way.end_m = [way.start_m[0] + x, way.start_m[1] + y];
        }
        computed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hazard::StopKind;

    /// By hand: rocks last seen 3 m east and 9 m north, beside measured ends 2, 4 and 6 m to the north.
    #[test]
    fn open_rocks_end_as_seen_or_as_far_as_measured_ones() {
        let way = |x: f64, y: f64| ObservedPath {
            start_m: [1.0, 1.0],
            end_m: [1.0 + x, 1.0 + y],
            open: None,
        };
        let open = |x, y| ObservedPath { open: Some(StopKind::LeftTerrain), ..way(x, y) };
        let measured = [way(0.0, 6.0), way(0.0, 2.0), way(0.0, 4.0)];
        let computed = vec![
            (way(1.0, 1.0), 1.0),
            (open(3.0, 0.0), 1.0),
            (open(0.0, 9.0), 1.0),
            (open(3.0, 0.0), 1.0),
        ];
        let ends = |how: OpenEnds| {
            let placed = how.placed(&measured, computed.clone());
            placed.iter().map(|(way, _)| way.vector_m()).collect::<Vec<_>>()
        };
        assert_eq!(ends(OpenEnds::Seen), [[1.0, 1.0], [3.0, 0.0], [0.0, 9.0], [3.0, 0.0]]);
        assert_eq!(ends(OpenEnds::LikeMeasured), [[1.0, 1.0], [0.0, 4.0], [0.0, 9.0], [0.0, 4.0]]);
        assert_eq!(ends(OpenEnds::Farthest), [[1.0, 1.0], [6.0, 0.0], [0.0, 9.0], [6.0, 0.0]]);
    }
}
