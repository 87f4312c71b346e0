//! Evaluation lines and barriers on the ground.

use crate::count::shortest;
use crate::hazard::{BarrierSummary, LineSummary, Proportion};
use crate::math;
use crate::output::Results;
use crate::report::raster::GroundRaster;
use crate::report::words::fill;
use crate::report::{by_frequency, format};
use serde::Serialize;
use std::fmt::Display;

/// Most pieces that a line is cut into to follow the ground.
const MOST_PIECES: f64 = 400.0;

/// A line on the ground, or a barrier on it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Wall {
    pub(super) name: String,
    /// Height of the barrier (m); none for a line alone.
    pub(super) height_m: Option<f64>,
    /// What to say of it.
    pub(super) words: String,
    /// Places on the ground, map coordinates (m).
    pub(super) foot_m: Vec<[f64; 3]>,
}

/// The lines of the scene, and the barriers that stand on some of them; without ground there is none to draw.
pub(super) fn of(results: &Results, ground: Option<&GroundRaster>) -> Vec<Wall> {
    let Some(ground) = ground else { return Vec::new() };
    let shown = results.summary.lines.iter().filter(|line| !line.info.of_barrier);
    let is_weighted = results.hazard.weights().is_some();
    shown.map(|line| wall((line, is_weighted), &results.summary.barriers, ground)).collect()
}

fn wall(
    (line, is_weighted): (&LineSummary, bool),
    barriers: &[BarrierSummary],
    ground: &GroundRaster,
) -> Wall {
    let barrier = barriers.iter().find(|one| one.barrier.name == line.info.name);
    let percent = |share: &Proportion| format::percent_of_part(share.share, 1);
    let reached = if is_weighted {
        fill(by_frequency::WALL, &[("share", &percent(&line.reach))])
    } else {
        format!("{} of {} rocks cross", line.reach.count, line.reach.of)
    };
    let words = barrier.map_or(reached, |one| {
        let (height_m, capacity_kj) =
            (one.barrier.height_m, shortest(one.barrier.capacity_j / 1e3));
        if is_weighted {
            let stopped = percent(&one.stopped);
            let found: [(&str, &dyn Display); 3] =
                [("h", &height_m), ("e", &capacity_kj), ("share", &stopped)];
            return fill(by_frequency::BARRIER, &found);
        }
        format!(
            "{height_m} m, {capacity_kj} kJ: stops {} of the {} that arrive",
            one.stopped.count, one.stopped.of
        )
    });
    Wall {
        name: line.info.name.clone(),
        height_m: barrier.map(|one| one.barrier.height_m),
        words,
        foot_m: draped(&line.info.corners_m, ground),
    }
}

/// Finer digits say nothing of a line on a raster and make the page long.
fn to_the_centimetre(x_m: f64) -> f64 {
    (x_m * 100.0).round() / 100.0
}

/// A line cut so finely that it follows the ground; places without ground are left out.
fn draped(corners_m: &[[f64; 2]], ground: &GroundRaster) -> Vec<[f64; 3]> {
    let mut foot = Vec::new();
    for pair in corners_m.windows(2) {
        let (from, way) = (pair[0], [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]]);
        let length_m = math::hypot(way[0], way[1]);
        let pieces = (length_m / ground.cell_m).ceil().clamp(1.0, MOST_PIECES);
        let shares = (0..=pieces as usize).map(|k| k as f64 / pieces);
        foot.extend(shares.filter_map(|share| {
            let [x, y] = [from[0] + share * way[0], from[1] + share * way[1]];
            let z = ground.height_at(x, y);
            z.is_finite().then_some([x, y, z].map(to_the_centimetre))
        }));
    }
    foot
}
