//! Which numbers of a run are only bounds, and what that leaves open of a difference.

use super::populations::{ComparedQuantity, CountedShare, Population};
use crate::frequency::Weights;
use crate::hazard::{self, Difference, Open, Percentile, Quantity, StopKind, Values};
use crate::report::bound::Is;
use crate::report::format;

/// What rocks that would have gone on do to a number of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct RunBound {
    /// Whether the number is a bound.
    pub(super) is: Is,
    /// How much farther down and up the truth may lie than chance in the sample says; infinite where nothing bounds it.
    farther: [f64; 2],
}

impl RunBound {
    /// Of a share, or of so many a year in all: the truth lies between what was seen and all that may still come.
    pub(super) fn of_share(share: &CountedShare, most: f64) -> Self {
        if share.open.is_empty() {
            return Self::default();
        }
        let equal = || Weights::equal(share.among.releases.len());
        let weights = share.among.standing.as_ref().map_or_else(equal, |of| of.weights.clone());
        let (seen, open) = (share.releases.iter().copied(), share.open.iter().copied());
        let far = hazard::share_of(&weights, seen.clone().chain(open.clone()));
        let found = hazard::share_up_to(&weights, seen, open);
        let is = Is::at_least_if(found.censored);
        Self { is, farther: [0.0, most * (far.share - found.share)] }
    }

    /// Of the mean (no `p`) or a percentile `p` of a quantity.
    pub(super) fn of_statistic(
        (of, values): (&Population, &Values),
        measure: ComparedQuantity,
        p: Option<f64>,
    ) -> Self {
        let seen = p.and_then(|p| {
            let sample = of.sample(values, 1.0);
            Some((sample.percentile(p)?, sample.values().len()))
        });
        if let Some(rocks) = seen.as_ref().and_then(|(seen, rocks)| seen.lacks(*rocks)) {
            return Self { is: Is::Lacking(rocks), farther: [0.0; 2] };
        }
        let ComparedQuantity::Whole(quantity) = measure else { return Self::default() };
        let is_never = of.has_no_trees && quantity == Quantity::TreeImpacts;
        if of.open.is_empty() || is_never {
            return Self::default();
        }
        let side = quantity.open();
        let censored = of.censored_sample(values, quantity);
        let (is_bound, farther) = match p {
            None => censored.mean().map_or(UNKNOWN, |mean| known_if(!mean.censored)),
            Some(p) => of_percentile([seen.map(|(seen, _)| seen), censored.percentile(p)], side),
        };
        let (.., size) = measure.words();
        let farther = farther / size;
        let farther = if side == Open::Above { [0.0, farther] } else { [farther, 0.0] };
        Self { is: Is::on_side(is_bound, Some(side)), farther }
    }
}

/// A bound, and nothing says how far the truth may lie from it.
const UNKNOWN: (bool, f64) = (true, f64::INFINITY);

fn known_if(is_known: bool) -> (bool, f64) {
    if is_known { (false, 0.0) } else { UNKNOWN }
}

/// Whether a percentile is a bound, and how much farther the end of its interval lies on that side were all rocks that would have gone on to
/// go as far as can be.
fn of_percentile(both: [Option<Percentile>; 2], side: Open) -> (bool, f64) {
    let [Some(seen), Some(found)] = both else { return UNKNOWN };
    let ends = match side {
        Open::Above => seen.high_95.zip(found.high_95),
        Open::Below => seen.low_95.zip(found.low_95),
    };
    let farther = ends.map_or(f64::INFINITY, |(seen, far)| (far - seen).abs());
    (found.censored, farther)
}

/// A difference of numbers of which one or both may be bounds: its interval goes as far as what is not known of either.
pub(super) fn opened(one: Difference, [a, b]: [RunBound; 2]) -> Difference {
    let (down, up) = (b.farther[0] + a.farther[1], b.farther[1] + a.farther[0]);
    Difference { interval: one.interval.map(|(low, high)| (low - down, high + up)), ..one }
}

/// What the difference itself is: a bound where one number is one; of two that are, nothing can be said.
pub(super) fn of_difference([a, b]: [Is; 2]) -> Is {
    match (a, b) {
        (Is::Value, is) => is,
        (Is::AtLeast, Is::Value) => Is::AtMost,
        (Is::AtMost, Is::Value) => Is::AtLeast,
        _ => Is::Value,
    }
}

/// How a bound is written in a table for programs.
pub(super) fn written(is: Is) -> &'static str {
    match is {
        Is::AtLeast => ">=",
        Is::AtMost => "<=",
        Is::Value | Is::Lacking(_) => "",
    }
}

/// Share of rocks that would have gone on from which on it must be said what that does (–).
const MANY_OPEN: f64 = 0.01;

/// What rocks that would have gone on do to the numbers, where there are some.
pub(super) fn censored(pair: &[Population; 2]) -> Option<String> {
    let open = |of: &Population| -> f64 {
        let ways = StopKind::ALL.iter().zip(&of.shares);
        ways.filter(|(stop, _)| stop.is_open()).map(|(_, share)| share.share()).sum()
    };
    let [a, b] = [open(&pair[0]), open(&pair[1])];
    (a.max(b) > MANY_OPEN).then(|| {
        format!(
            "{} of the rocks of A and {} of B left the terrain, were still moving at the end or failed: all differences are of \
             the ways as far as they were followed, and those of runout and reach angle are of bounds, those of largest values too for rocks still on the terrain.",
            format::percent_of_part(a, 1),
            format::percent_of_part(b, 1)
        )
    })
}
