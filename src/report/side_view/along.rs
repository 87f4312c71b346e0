//! The mean fall line, and what happens along it.

use crate::math;
use crate::report::model::{Path, Report};
use crate::report::raster::GroundRaster;
use crate::report::words::{Words, fill};

/// Places at which the ground below the paths is taken.
const PLACES: f64 = 160.0;
/// Paper below the lowest ground, over the margin (–).
const SOME_GROUND: f64 = 0.5;
/// Ground so far below the rocks, over the length shown (–), is still shown.
const NEAR_GROUND: f64 = 0.25;

/// Ground so far below the lowest centre, over the least height of a centre above it (–): on a slope, and for larger rocks, it is more.
const TWICE: f64 = 2.0;

/// How high a centre is above the ground where it is least (m): about the radius of the smallest rock; 0 where that is not known.
fn least_gap_m(report: &Report) -> f64 {
    let Some(ground) = &report.ground else { return 0.0 };
    let gap = |[x, y, z]: [f64; 3]| z - ground.height_at(x, y);
    let ends = report.releases.iter().flat_map(|fall| [fall.start_m, fall.end_m]);
    let points = report.paths.iter().flat_map(|path| path.points.iter().map(|p| p.place_m));
    let gaps = ends.chain(points).map(gap).filter(|gap| *gap > 0.0);
    gaps.reduce(f64::min).unwrap_or(0.0)
}

/// The line from the mean release to the mean end, in plan view.
#[derive(Debug, Clone, Copy)]
pub(super) struct FallLine {
    /// Mean release (m).
    from: (f64, f64),
    /// Unit vector.
    way: (f64, f64),
    is_given: bool,
}

impl FallLine {
    /// The line of a report; eastwards where rocks on the mean do not move.
    pub(super) fn of(report: &Report) -> Self {
        let mut sums = [0.0; 4];
        let mut count = 0.0;
        for fall in &report.releases {
            let places = [fall.start_m[0], fall.start_m[1], fall.end_m[0], fall.end_m[1]];
            if places.iter().all(|v| v.is_finite()) {
                count += 1.0;
                // running means: map coordinates are large, their sum need not be
                (0..4).for_each(|i| sums[i] += (places[i] - sums[i]) / count);
            }
        }
        let (dx, dy) = (sums[2] - sums[0], sums[3] - sums[1]);
        let length = math::hypot(dx, dy);
        let is_given = length > 1e-6;
        let way = if is_given { (dx / length, dy / length) } else { (1.0, 0.0) };
        Self { from: (sums[0], sums[1]), way, is_given }
    }

    /// Distance of a place along the line from the mean release (m).
    pub(super) fn along(&self, place_m: [f64; 3]) -> f64 {
        (place_m[0] - self.from.0) * self.way.0 + (place_m[1] - self.from.1) * self.way.1
    }

    /// Distance of a place from the line (m), positive to the left.
    fn aside(&self, place_m: [f64; 3]) -> f64 {
        (place_m[1] - self.from.1) * self.way.0 - (place_m[0] - self.from.0) * self.way.1
    }

    /// Bearing from north over east (degrees, 0..360).
    fn bearing_deg(&self) -> f64 {
        math::atan2(self.way.0, self.way.1).to_degrees().rem_euclid(360.0)
    }

    /// Nearest point of the compass.
    pub(super) fn compass(&self, words: &Words) -> &'static str {
        words.compass[(self.bearing_deg() / 45.0).round() as usize % 8]
    }

    /// The bearing, or why there is none.
    pub(super) fn bearing_words(&self, words: &Words) -> String {
        if self.is_given {
            let degrees = format!("{:03.0}", self.bearing_deg().round() % 360.0);
            fill(words.bearing, &[("degrees", &degrees)])
        } else {
            words.no_bearing.to_owned()
        }
    }

    /// How many paths lead more than an angle (degrees) away from the line. One that hardly leads anywhere has no direction.
    pub(super) fn leading_aside(&self, paths: &[Path], degrees: f64) -> usize {
        let way = |path: &Path| -> Option<(f64, f64)> {
            let (first, last) = (path.points.first()?.place_m, path.points.last()?.place_m);
            let along = self.along(last) - self.along(first);
            let aside = self.aside(last) - self.aside(first);
            (along.is_finite() && aside.is_finite()).then_some((along, aside))
        };
        let ways: Vec<(f64, f64)> = paths.iter().filter_map(way).collect();
        let length = |(along, aside): &(f64, f64)| math::hypot(*along, *aside);
        let least = LEADS * ways.iter().map(length).fold(0.0, f64::max);
        let angle = |(along, aside): &(f64, f64)| math::atan2(aside.abs(), *along).to_degrees();
        ways.iter().filter(|way| length(way) > least && angle(way) > degrees).count()
    }

    /// Range along the line and range of heights to show, with a margin.
    pub(super) fn extent(&self, report: &Report) -> ((f64, f64), (f64, f64)) {
        let ends = report.releases.iter().flat_map(|fall| [fall.start_m, fall.end_m]);
        let points = report.paths.iter().flat_map(|path| path.points.iter().map(|p| p.place_m));
        let mut range = Ranges::default();
        for place in ends.chain(points).filter(|p| p.iter().all(|v| v.is_finite())) {
            range.take(self.along(place), place[2]);
        }
        let along = range.along.unwrap_or((0.0, 1.0));
        let margin = (0.03 * (along.1 - along.0)).max(0.02);
        let along = (along.0 - margin, along.1 + margin);
        let z = range.z.unwrap_or((0.0, 1.0));
        let touch = least_gap_m(report);
        let margin = (0.05 * (z.1 - z.0)).max(0.02 * (along.1 - along.0)).max(touch);
        // the ground below rocks that hardly fall is seen too
        let ends = report.releases.iter().flat_map(|fall| [fall.start_m, fall.end_m]);
        let ground = report.ground.iter().flat_map(|ground| {
            ends.clone().map(|[x, y, _]| ground.height_at(x, y) - SOME_GROUND * margin)
        });
        // but not that far below rocks which are still in flight
        let lowest = z.0 - (NEAR_GROUND * (along.1 - along.0)).max(TWICE * touch);
        let low = ground.filter(|low| *low >= lowest).fold(z.0 - margin, f64::min);
        (along, (low, z.1 + margin))
    }

    /// The ground under the paths themselves: (distance, lowest, median, highest) at steps along the line.
    ///
    /// The ground along one cut is not where the rocks are: on a curved slope they would seem to fly or to dig.
    pub(super) fn ground_below(
        &self,
        report: &Report,
        ground: &GroundRaster,
        (from, to): (f64, f64),
    ) -> Vec<[f64; 4]> {
        let step = (to - from) / PLACES;
        let mut heights: Vec<Vec<f64>> = vec![Vec::new(); PLACES as usize + 1];
        let mut take = |place: [f64; 3]| {
            let k = (self.along(place) - from) / step;
            let z = ground.height_at(place[0], place[1]);
            if z.is_finite() && k >= 0.0 {
                heights.get_mut(k as usize).into_iter().for_each(|all| all.push(z));
            }
        };
        for pair in report.paths.iter().flat_map(|path| path.points.windows(2)) {
            let (a, b) = (pair[0].place_m, pair[1].place_m);
            let pieces = ((self.along(b) - self.along(a)).abs() / step).ceil();
            // a point that is no number gives no piece
            for k in 0..(pieces.min(PLACES) as usize).max(1) {
                let share = k as f64 / pieces.max(1.0);
                take([0, 1, 2].map(|axis| a[axis] + share * (b[axis] - a[axis])));
            }
        }
        let row = |(k, all): (usize, &mut Vec<f64>)| {
            all.sort_by(f64::total_cmp);
            let (low, high) = (all.first()?, all.last()?);
            Some([from + (k as f64 + 0.5) * step, *low, all[all.len() / 2], *high])
        };
        heights.iter_mut().enumerate().filter_map(row).collect()
    }

    /// Where a line of the map crosses the fall line, as the distance along it (m); none where it does not.
    pub(super) fn meets(&self, corners_m: &[[f64; 2]]) -> Option<f64> {
        corners_m.windows(2).find_map(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|[x, y]| [x, y, 0.0]);
            let (left, right) = (self.aside(a), self.aside(b));
            let share = left / (left - right);
            (left * right <= 0.0 && share.is_finite())
                .then(|| self.along(a) + share * (self.along(b) - self.along(a)))
        })
    }
}

/// A path has a direction where it leads so far, over the farthest one (–).
const LEADS: f64 = 0.1;

#[derive(Default)]
struct Ranges {
    along: Option<(f64, f64)>,
    z: Option<(f64, f64)>,
}

impl Ranges {
    fn take(&mut self, along: f64, z: f64) {
        let wider = |r: Option<(f64, f64)>, v: f64| {
            let (low, high) = r.unwrap_or((v, v));
            Some((low.min(v), high.max(v)))
        };
        self.along = wider(self.along, along);
        self.z = wider(self.z, z);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of the map that goes from 1 m right of the fall line to 3 m left of it has crossed it after a quarter of its way; one that stays on
    /// one side never does.
    #[test]
    fn a_line_of_the_map_is_met_where_it_crosses_the_fall_line() {
        let line = FallLine { from: (0.0, 0.0), way: (1.0, 0.0), is_given: true };
        let met = line.meets(&[[0.0, -1.0], [4.0, 3.0]]).unwrap_or(f64::NAN);
        assert!((met - 1.0).abs() < 1e-12, "{met}");
        let back = line.meets(&[[4.0, 3.0], [0.0, -1.0]]).unwrap_or(f64::NAN);
        assert!((back - 1.0).abs() < 1e-12, "{back}");
        assert_eq!(line.meets(&[[0.0, 1.0], [4.0, 3.0]]), None);
    }
}
