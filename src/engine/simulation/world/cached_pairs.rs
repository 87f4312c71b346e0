//! A neighbour list for repeated queries with growing reaches: the list of a somewhat larger query
//! serves all.
//!
//! Verlet's list (Phys. Rev. 159, 1967): spheres are enlarged by a skin, and the pairs found then
//! are valid until a rock has used up its skin. The result is always exact for the requested
//! reaches: the list only saves searches.

use super::prediction::PredictedRock;
use crate::rock::Vec3;
use crate::solver::island::broad_phase::{Ball, overlapping};

/// Fraction by which the requested distance is enlarged (–).
///
/// Passes query with growing reaches within one window; half as much again usually serves all of
/// them.
const REACH_MARGIN: f64 = 0.5;

/// Additional distance that each rock may move before the list is rebuilt (–, relative to its
/// radius).
const SKIN: f64 = 0.25;

/// The pairs found by the last search.
#[derive(Debug, Default)]
pub(super) struct CachedPairs {
    /// Reach of each rock in that search (m), and its centre then.
    reaches: Vec<f64>,
    centres: Vec<Vec3>,
    pairs: Vec<(u32, u32)>,
}

impl CachedPairs {
    /// Mean displacement of all rocks since the list was built (m): the list stays valid for rocks
    /// that fall together.
    fn mean_displacement(&self, rocks: &[PredictedRock]) -> Vec3 {
        let displacements =
            rocks.iter().zip(&self.centres).map(|(rock, centre)| rock.centre - centre);
        displacements.fold(Vec3::zeros(), |sum, displacement| sum + displacement)
            / rocks.len().max(1) as f64
    }

    /// Pairs that overlap or touch if each rock may be anywhere within its reach of its centre (m),
    /// in ascending order.
    pub(super) fn overlapping(
        &mut self,
        rocks: &[PredictedRock],
        reaches: &[f64],
    ) -> Vec<(u32, u32)> {
        // the sphere of the requested reach at the present centre must lie inside the sphere of the
        // list; a displacement common to all brings no two rocks nearer
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
        // the list holds too many pairs; the distance decides
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
