//! How far the measured ends tell each value.

use super::redraw::{Again, REDRAWS, middle, tail_of};
use super::search::ParameterSearch;
use super::site::CalibrationSite;
use super::{Calibration, CalibrationTrial, Ends};
use crate::math;
use crate::random::{Purpose, stream};
use crate::scene::VaryTable;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Share of a value's range above which its interval tells nothing (–).
const UNTOLD: f64 = 0.6;
/// Over the 5 % limit of the KS distance (–), 1.36: 1.63 is exceeded in 1 % of all samples (Kolmogorov 1933), and more seldom by what was fitted to them.
const CLEARLY_ABOVE: f64 = 1.63 / 1.36;

/// How far the measured ends tell one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// `ground.key`.
    pub name: String,
    /// The value that fits all ends best.
    pub value: f64,
    /// Lower end of the 95 % interval: where the values lie that fit ends and rocks drawn again best. None where they reach the end of the
    /// range tried, beyond which better ones may lie; at a limit of the value itself there are none.
    pub low_95: Option<f64>,
    /// Its upper end.
    pub high_95: Option<f64>,
    /// Whether the interval leaves out a good part of the range.
    pub is_told: bool,
    /// Whether rocks that would have gone on leave open which values fit best: then it holds however they would have ended.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub censored: bool,
}

/// Where the values lie that fit best.
pub(super) struct LeftOpen {
    /// Of each value.
    pub(super) ranges: Vec<[f64; 2]>,
    /// Whether rocks that would have gone on leave open which these are.
    pub(super) censored: bool,
}

/// The values of a trial that fits best, or may do so, and whether open rocks leave unclear how well.
type BestFit<'a> = (&'a [f64], bool);

impl ParameterSearch<'_> {
    /// How far the measured ends tell each value. A value tried stands for half a step to either side.
    ///
    /// The intervals are of the trials of the search, whose rocks are others than those that selected: a selected value outside widens its own.
    pub(super) fn told(&self, values: &[f64]) -> Vec<Told> {
        let ends: f64 = self.sites.iter().map(CalibrationSite::effective).sum();
        let tail = tail_of(ends.min(self.rocks()));
        let LeftOpen { ranges: open, censored } = self.left_open(Ends::All, REDRAWS, tail);
        let one = |(at, vary): (usize, &VaryTable)| {
            let half = 0.5 * self.step[at];
            let low = open[at][0].min(values[at]) - half;
            let high = open[at][1].max(values[at]) + half;
            let [goes_on_below, goes_on_above] = vary.goes_on();
            let within = high.min(vary.to) - low.max(vary.from);
            Told {
                name: vary.name(),
                value: values[at],
                low_95: (low > vary.from || !goes_on_below).then_some(low.max(vary.from)),
                high_95: (high < vary.to || !goes_on_above).then_some(high.min(vary.to)),
                is_told: within < UNTOLD * (vary.to - vary.from),
                censored,
            }
        };
        self.vary.iter().enumerate().map(one).collect()
    }

    /// Releases of a trial of the search in all scenes.
    fn rocks(&self) -> f64 {
        let computed = self.searched().next().map_or(&[][..], |(_, computed)| computed);
        computed.iter().map(|computed| computed.releases.0 as f64).sum()
    }

    /// Where the values lie that fit best, of those tried in the search, when measured ends and computed rocks are drawn again, but for a tail
    /// on either side.
    pub(super) fn left_open(&self, ends: Ends, redraws: usize, tail: f64) -> LeftOpen {
        let best: Vec<Vec<BestFit<'_>>> =
            (0..redraws).map(|redraw| self.fits_best(ends, redraw)).collect();
        let extremes = |at: usize| {
            let of = move |ties: &Vec<BestFit<'_>>| {
                let values = || ties.iter().map(|(values, _)| values[at]);
                [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
            };
            best.iter().flat_map(of).collect()
        };
        let ranges = (0..self.vary.len()).map(|at| middle(extremes(at), tail)).collect();
        LeftOpen { ranges, censored: best.iter().flatten().any(|(_, is_unclear)| *is_unclear) }
    }

    /// The values that fit best in one drawing: values that make no difference fit equally well, all of them. Where open rocks leave unclear how
    /// far a trial is, all that may fit best do, which are at least as near as the best at most is (Manski 1990): no other can, however these rocks would have ended.
    fn fits_best(&self, ends: Ends, redraw: usize) -> Vec<BestFit<'_>> {
        let Some((_, first)) = self.searched().next() else { return Vec::new() };
        let mut random = stream(self.sites[0].seed(), Purpose::Redraw, redraw);
        let sites = self.sites.iter().zip(first);
        let again: Vec<Again> =
            sites.map(|(site, first)| Again::of(site, (ends, first), &mut random)).collect();
        let distances = self.searched().map(|(_, computed)| -> [f64; 2] {
            let each = self.sites.iter().zip(&again).zip(computed);
            let of_site = each.map(|((site, again), computed)| {
                site.distance(&computed.again(&again.times), &again.rows)
            });
            of_site.fold([0.0; 2], |sum, far| [sum[0] + far[0], sum[1] + far[1]])
        });
        let distances: Vec<[f64; 2]> = distances.collect();
        let least = distances.iter().map(|[_, most]| *most).fold(f64::INFINITY, f64::min);
        let ties = self.searched().zip(distances).filter(|(_, [nearest, _])| *nearest <= least);
        ties.map(|((values, _), [nearest, most])| (values, nearest < most)).collect()
    }
}

impl Calibration {
    /// What is to be said of values at the end of their range, and of ends that no value tried explains.
    pub(super) fn doubts(
        &self,
        vary: &[VaryTable],
        unclear: Option<&CalibrationTrial>,
    ) -> Vec<String> {
        let mut doubts: Vec<String> =
            self.told.iter().zip(vary).filter_map(|(told, vary)| told.at_end_of(vary)).collect();
        let (ks, limit) = (self.whole.all.ks, self.independent_ks_limit(&self.whole.all));
        // one that open rocks leave unclear may explain them
        let least = unclear.map_or(ks, |other| ks.min(other.all.ks));
        if least > CLEARLY_ABOVE * limit {
            doubts.push(format!(
                "the values tried do not explain the measured ends: KS distance {ks:.3} of the fit on all, 5 % limit {limit:.3}; write wider ranges in vary, vary other values, or look at terrain, rocks and releases"
            ));
        }
        doubts
    }
}

impl Told {
    /// What is to be said where the best values reach one end of the range tried. Of a value that is hardly told it is said where it stands there
    /// itself: else a wider range tells no more of it.
    fn at_end_of(&self, vary: &VaryTable) -> Option<String> {
        let (end, value, beyond, remedy) = match (self.low_95, self.high_95) {
            (None, Some(_)) => ("lower", vary.from, "below", "a smaller from"),
            (Some(_), None) => ("upper", vary.to, "above", "a larger to"),
            _ => return None,
        };
        // far less than any step of a search
        let is_there = (self.value - value).abs() < 1e-9 * (vary.to - vary.from);
        if !(self.is_told || is_there) {
            return None;
        }
        let name = &self.name;
        if self.censored {
            return Some(format!(
                "{name}: rocks that had not ended leave open which values fit best, as far as to the {end} end of the range tried, {value}; write a longer longest_s or a larger terrain before {remedy} in vary"
            ));
        }
        Some(format!(
            "{name}: the values that fit best reach the {end} end of the range tried, {value}, and better ones may lie {beyond} it; write {remedy} in vary"
        ))
    }
}

impl fmt::Display for Told {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, low_95, high_95, is_told, censored: _ } = self;
        let short = |value: f64| math::rounded(value, 4);
        write!(to, "{name} = {} (95 %: ", short(*value))?;
        match (low_95.map(short), high_95.map(short)) {
            (Some(low), Some(high)) => write!(to, "{low} to {high})"),
            (Some(low), None) => write!(to, "{low} or more)"),
            (None, Some(high)) => write!(to, "{high} or less)"),
            (None, None) => write!(to, "open at both ends of the range)"),
        }?;
        if *is_told {
            return Ok(());
        }
        write!(to, "; warning: the measured ends hardly tell it, other values fit as well")
    }
}
