//! Who is near whom, asked several times with growing reaches: the answer to a somewhat larger question serves all.
//!
//! Verlet's list (Phys. Rev. 159, 1967): balls are grown by a skin, and the pairs found then hold
//! until a rock has used up its skin. The answer is always the exact one for the reaches asked: the
//! list only spares the search.

use super::prediction::PredictedRock;
use crate::rock::Vec3;
use crate::solver::island::broad_phase::{Ball, overlapping};

/// Share by which the way that is asked for is larger than it must be (–).
///
/// Passes ask with growing reaches within one window; half as much again usually serves all of
/// them.
const REACH_MARGIN: f64 = 0.5;

/// Way that each rock may go besides before all are looked for anew (–, relative to its radius).
const SKIN: f64 = 0.25;

/// The pairs that were found last.
#[derive(Debug, Default)]
pub(super) struct CachedPairs {
    /// How far each rock may be from where it was then (m), and where that is.
    reaches: Vec<f64>,
    centres: Vec<Vec3>,
    pairs: Vec<(u32, u32)>,
}

impl CachedPairs {
    /// Mean way of all rocks since the list was made (m): rocks that fall together keep it.
    fn mean_displacement(&self, rocks: &[PredictedRock]) -> Vec3 {
        let displacements =
            rocks.iter().zip(&self.centres).map(|(rock, centre)| rock.centre - centre);
        displacements.fold(Vec3::zeros(), |sum, displacement| sum + displacement)
            / rocks.len().max(1) as f64
    }

    /// Pairs that overlap or touch if each rock may be anywhere within so far of its centre (m), in ascending order.
    pub(super) fn overlapping(
        &mut self,
        rocks: &[PredictedRock],
        reaches: &[f64],
    ) -> Vec<(u32, u32)> {
        // a ball of the reach asked, at the present centre, lies inside the ball that the list was
        // made for; what all have gone together brings none nearer to another
        let mean_displacement = self.mean_displacement(rocks);
        let fits = |(k, requested): (usize, &f64)| {
            let slack = self.reaches[k] - requested;
            let displacement = rocks[k].centre - self.centres[k] - mean_displacement;
            slack >= 0.0 && displacement.norm_squared() <= slack * slack
        };
        let fits = self.reaches.len() == reaches.len() && reaches.iter().enumerate().all(fits);
        if !fits {
            self.centres.clear();
            self.centres.extend(rocks.iter().map(|rock| rock.centre));
            let with_reach = rocks.iter().zip(reaches);
            self.reaches = with_reach
                .map(|(rock, reach)| {
                    reach + REACH_MARGIN * (reach - rock.radius) + SKIN * rock.radius
                })
                .collect();
            let ball = |(rock, reach): (&PredictedRock, &f64)| Ball {
                centre: rock.centre,
                radius: *reach,
            };
            let balls: Vec<Ball> = rocks.iter().zip(&self.reaches).map(ball).collect();
            self.pairs = overlapping(&balls);
        }
        // what the list holds is too much; the distance decides
        let near = |&&(a, b): &&(u32, u32)| {
            let [a, b] = [a, b].map(|k| k as usize);
            let reach = reaches[a] + reaches[b];
            (rocks[a].centre - rocks[b].centre).norm_squared() <= reach * reach
        };
        let mut pairs = Vec::with_capacity(self.pairs.len());
        pairs.extend(self.pairs.iter().filter(near));
        pairs
    }
}
