//! Shares and values of the rocks that arrive, by what each of them stands for.

use super::super::arrival::Arrival;
use super::super::proportion::Proportion;
use super::super::rate::share_up_to;
use super::Barrier;
use crate::frequency::Weights;

/// The share of some rocks that the barrier would stop at another height (m).
pub(super) fn stopped_at(
    barrier: &Barrier,
    (rocks, weights): (&[Arrival], &Weights),
    height_m: f64,
) -> Proportion {
    let is_stopped = |rock: &&Arrival| rock.is_stopped(height_m, barrier.capacity_j);
    let count = rocks.iter().filter(is_stopped).count();
    if weights.are_equal() {
        return Proportion::new(count, rocks.len());
    }
    let weight = |rock: &Arrival| weights.of_release(rock.release);
    let all: f64 = rocks.iter().map(weight).sum();
    let heaviest = rocks.iter().map(weight).fold(0.0, f64::max) / all;
    let share = rocks.iter().filter(is_stopped).map(weight).sum::<f64>() / all;
    // as a ratio of sums it is known to Σ w² (y − p)² / (Σ w)²: worse than by the weights alone where heavy rocks decide it
    let side = |rock: &Arrival| {
        let stopped = f64::from(u8::from(rock.is_stopped(height_m, barrier.capacity_j)));
        (weight(rock) * (stopped - share)).powi(2)
    };
    let variance = rocks.iter().map(side).sum::<f64>() / (all * all);
    Proportion::weighted((count, rocks.len()), share, (variance, heaviest))
}

/// Share of all that were released, by what they stand for, that arrive; the `open` ones may.
pub(super) fn arriving((rocks, open): (&[Arrival], &[usize]), weights: &Weights) -> Proportion {
    share_up_to(weights, rocks.iter().map(|rock| rock.release), open.iter().copied())
}
