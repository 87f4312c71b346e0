//! Rocks of one scheme on one made slope, counted in a line.

use crate::block::{self, BenchShape};
use crate::speed::rate::step_of;
use crate::speed::slope::{SCHEMES, Slope};
use clap::Args;
use rockfall::simulation::{Effort, Scratch, Stop, Trajectory};
use rockfall::solver::Scheme;
use std::time::Instant;

/// What is followed.
#[derive(Debug, Args)]
pub struct RocksArgs {
    /// Number of rocks
    #[arg(default_value = "300")]
    pub rocks: usize,
    /// Triangles of the slope, about
    #[arg(default_value = "100000")]
    pub triangles: usize,
    /// adaptive, reference, rigid or dda; with a shape rigid unless another is given
    pub scheme: Option<String>,
    /// Tolerance (m/s) or step (s), whichever the scheme goes by
    pub fineness: Option<f64>,
    /// Rolling friction of the ground (–): 0.5 unless given, 0 lets rocks run out fast
    #[arg(long, conflicts_with = "shape")]
    pub rolling_friction: Option<f64>,
    /// Blocks of this shape instead of spheres, without rolling friction
    #[arg(long)]
    pub shape: Option<BenchShape>,
    /// Blocks on a meadow: friction that grows with slip, a scar layer, restitution that falls with speed
    #[arg(long, requires = "shape")]
    pub soil: bool,
}

impl RocksArgs {
    /// The scheme with its tolerance or step.
    fn way(&self) -> (Scheme, f64) {
        let usual = if self.shape.is_some() { "rigid" } else { SCHEMES[0].0.name() };
        let named = |name: &str| SCHEMES.into_iter().find(|(known, _)| known.name() == name);
        let way = named(self.scheme.as_deref().unwrap_or(usual)).unwrap_or(SCHEMES[0]);
        (way.0, self.fineness.unwrap_or(way.1))
    }
}

/// Follows the rocks one after the other and says what they did and what they cost.
pub fn follow(asked: &RocksArgs) -> String {
    let way = asked.way();
    let mut slope = Slope::of(asked.triangles);
    slope.ground.rolling_friction = asked.rolling_friction.unwrap_or(slope.ground.rolling_friction);
    let welded = format!("weld {:.3} s, index {:.3} s", slope.weld_s, slope.index_s);
    let mut scratch = Scratch::default();
    let step = step_of(way);
    let course = slope.course(&step);
    let made = asked.shape.map(BenchShape::made);
    let ground = block::ground(asked.soil);
    let begun = Instant::now();
    let fall = |index: usize| match &made {
        Some((kind, shape)) => {
            block::fall(&slope, &course, (*kind, shape, ground), index, &mut scratch)
        }
        None => slope.fall(&step, index, &mut scratch),
    };
    let journeys: Vec<Trajectory> = (0..asked.rocks).map(fall).collect();
    let seconds = begun.elapsed().as_secs_f64();
    let shape = made.map_or_else(String::new, |(kind, shape)| {
        format!("{} ({} corners), ", kind.name(), shape.core.corners.len())
    });
    format!("{welded}\n{shape}{}", counted(way.0, &journeys, seconds))
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
