//! Speed and height by distance from the release, and where lines and barriers stand among them.

use super::super::model::{MapMark, ProfileStretch, ProfileView, ReleaseEnd, ReportStretch};
use super::{lines, of_percentile};
use crate::error::Result;
use crate::hazard;
use crate::math;
use crate::output::Results;
use std::collections::BTreeMap;

/// The profile of a run; none of results that hold none.
pub(super) fn view(results: &Results, releases: &[ReleaseEnd]) -> Result<Option<ProfileView>> {
    let profile = &results.hazard.totals.profile;
    if profile.is_empty() {
        return Ok(None);
    }
    let weights = results.hazard.weights_or_equal();
    let of = |found: &hazard::StretchStatistic, rocks: usize| ReportStretch {
        median: found.median.value,
        p95: of_percentile(&found.p95, (rocks, None)),
        largest: found.largest,
    };
    let stretch = |point: hazard::ProfilePoint| ProfileStretch {
        from_m: point.from_m,
        height_m: of(&point.height_m, point.rocks),
        speed_m_s: of(&point.speed_m_s, point.rocks),
    };
    Ok(Some(ProfileView {
        step_m: profile.step_m(),
        stretches: profile.points(&weights).into_iter().map(stretch).collect(),
        marks: marks(results, releases)?,
    }))
}

/// Lines and barriers that rocks cross, at the median distance at which they do.
fn marks(results: &Results, releases: &[ReleaseEnd]) -> Result<Vec<(f64, MapMark)>> {
    let first = results.summary.identity.first_release;
    let mut distances: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for row in results.crossings()? {
        let row = row?;
        let Some(fall) = row.index.checked_sub(first).and_then(|at| releases.get(at)) else {
            continue;
        };
        let ([x, y, _], [x0, y0, _]) = (row.position_m, fall.start_m);
        distances.entry(row.line).or_default().push(math::hypot(x - x0, y - y0));
    }
    let middle = |mark: MapMark| {
        let all = distances.get_mut(&mark.name)?;
        all.sort_by(f64::total_cmp);
        Some((all[all.len() / 2], mark))
    };
    let mut marks: Vec<(f64, MapMark)> =
        lines::marks(results).into_iter().filter_map(middle).collect();
    marks.sort_by(|one, other| one.0.total_cmp(&other.0));
    Ok(marks)
}
