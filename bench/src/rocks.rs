//! Rocks of one scheme on one made slope, counted in a line.

use crate::speed::rate::step_of;
use crate::speed::slope::{SCHEMES, Slope};
use rockfall::simulation::{Effort, Scratch, Stop, Trajectory};
use rockfall::solver::Scheme;
use std::time::Instant;

/// Follows so many rocks on a slope of so many triangles; the scheme's usual tolerance or step unless `fineness` gives
/// another.
pub fn follow(
    rocks: usize,
    triangles: usize,
    scheme: Option<&str>,
    fineness: Option<f64>,
) -> String {
    let named = |name: &str| SCHEMES.into_iter().find(|(known, _)| known.name() == name);
    let mut way = scheme.and_then(named).unwrap_or(SCHEMES[0]);
    way.1 = fineness.unwrap_or(way.1);
    let slope = Slope::of(triangles);
    let welded = format!("weld {:.3} s, index {:.3} s", slope.weld_s, slope.index_s);
    let mut scratch = Scratch::default();
    let begun = Instant::now();
    let step = step_of(way);
    let journeys: Vec<Trajectory> =
        (0..rocks).map(|index| slope.fall(&step, index, &mut scratch)).collect();
    format!("{welded}\n{}", counted(way.0, &journeys, begun.elapsed().as_secs_f64()))
}

fn counted(scheme: Scheme, journeys: &[Trajectory], seconds: f64) -> String {
    let count = journeys.len();
    let mut effort = Effort::default();
    for one in journeys {
        effort.add(&one.effort);
    }
    let mean =
        |of: &dyn Fn(&Trajectory) -> f64| journeys.iter().map(of).sum::<f64>() / count as f64;
    let each = |sum: u64| sum / count as u64;
    let stops = |wanted: fn(&Stop) -> bool| journeys.iter().filter(|one| wanted(&one.stop)).count();
    let mut runouts: Vec<f64> = journeys.iter().map(Trajectory::runout_m).collect();
    runouts.sort_by(f64::total_cmp);
    let rise = journeys.iter().map(|one| one.ledger.rise_j).fold(0.0, f64::max);
    let remainder = mean(&|one| one.ledger.remainder_j) / mean(&|one| one.released_j);
    format!(
        "{}: {:.0} rocks/s; per rock: steps {} rejected {} leaps {} sweeps {} triangles {} impacts {:.0} unsettled {}; \
         at rest {} left {} time up {} failed {}; rise {rise:.2e} J remainder {remainder:.4} P50 {:.2} P95 {:.2} mean {:.2} m \
         vmax {:.2} m/s time {:.1} s",
        scheme.name(),
        count as f64 / seconds,
        each(effort.steps),
        each(effort.rejected),
        each(effort.leaps),
        each(effort.sweeps),
        each(effort.triangles),
        mean(&|one| f64::from(one.impact_count)),
        each(effort.unsettled),
        stops(|stop| *stop == Stop::AtRest),
        stops(|stop| *stop == Stop::LeftTerrain),
        stops(|stop| *stop == Stop::TimeUp),
        stops(|stop| matches!(stop, Stop::Failed(_))),
        runouts[count / 2],
        runouts[count * 95 / 100],
        mean(&Trajectory::runout_m),
        mean(&|one| one.extremes.speed_m_s),
        mean(&|one| one.end.time_s),
    )
}
