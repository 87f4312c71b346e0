//! Rocks that arrive at a barrier.

use super::sample::Sample;
use crate::frequency::Weights;

/// A rock that arrives at a barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// Release number.
    pub release: usize,
    /// Height of its highest point above the ground (m); infinite where there is no ground below.
    pub top_m: f64,
    /// Total energy (J).
    pub total_j: f64,
    /// Speed of the centre (m/s).
    pub speed_m_s: f64,
}

/// Values of rocks, each with what the rock stands for.
pub(super) fn sample(rocks: &[Arrival], weights: &Weights, of: impl Fn(&Arrival) -> f64) -> Sample {
    Sample::of_releases(rocks.iter().map(|rock| (of(rock), rock.release)), weights)
}
