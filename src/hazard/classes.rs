//! Counts over classes of equal ratio: percentiles and exceedance without keeping values.

mod fine;

use super::quantile::{Bounds, Percentile, WeightBelow};
use crate::frequency::Weights;
use crate::math;
pub(super) use fine::{ClassPart, FineCounts};
use serde::{Deserialize, Serialize};

/// Ratio of the upper to the lower end of a class of values (–): its middle is at most 2.5 % from any value in it.
pub(super) const RATIO: f64 = 1.05;
/// Upper end of the first class (J or m): smaller values are not told apart from 0.
const SMALLEST: f64 = 1e-3;

/// How often values fell in each class: class, stratum of the rock, count, by rising class and stratum.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Counts(Vec<(u16, u16, u32)>);

/// Class of a value: 0 up to [`SMALLEST`], then equal ratios. 65535 classes reach beyond any f64.
pub(super) fn class_of(value: f64) -> u16 {
    if value > SMALLEST {
        (math::ln(value / SMALLEST) / math::ln(RATIO)).floor().min(65_534.0) as u16 + 1
    } else {
        0
    }
}

/// The value that stands for a class: the geometric middle of its ends, 0 for the first.
fn middle_of(class: u16) -> f64 {
    if class == 0 { 0.0 } else { SMALLEST * math::pow(RATIO, f64::from(class) - 0.5) }
}

/// Lower end of a class; 0 of the first.
pub(super) fn lower_end_of(class: u16) -> f64 {
    if class == 0 { 0.0 } else { SMALLEST * math::pow(RATIO, f64::from(class) - 1.0) }
}

impl Counts {
    /// Adds the value of a rock of a stratum.
    pub(super) fn add(&mut self, value: f64, stratum: u16) {
        self.add_class((class_of(value), stratum), 1);
    }

    fn add_class(&mut self, key: (u16, u16), count: u32) {
        match self.0.binary_search_by_key(&key, |(class, stratum, _)| (*class, *stratum)) {
            Ok(at) => self.0[at].2 += count,
            Err(at) => self.0.insert(at, (key.0, key.1, count)),
        }
    }

    pub(super) fn join(&mut self, other: &Self) {
        for &(class, stratum, count) in &other.0 {
            self.add_class((class, stratum), count);
        }
    }

    /// Class, stratum and count, by rising class.
    pub(super) fn entries(&self) -> &[(u16, u16, u32)] {
        &self.0
    }

    /// The class below whose upper end at least the share `p` of all weight lies, by its middle; 0 of nothing. With equal
    /// weights it holds the ⌈p n⌉-th smallest value.
    pub(super) fn percentile(&self, p: f64, weights: &Weights) -> f64 {
        let equal = weights.are_equal();
        let weight = |&(_, stratum, count): &(u16, u16, u32)| {
            let one = if equal { 1.0 } else { weights.of_stratum(usize::from(stratum)) };
            one * f64::from(count)
        };
        let all: f64 = self.0.iter().map(weight).sum();
        let mut below = 0.0;
        for entry in &self.0 {
            below += weight(entry);
            if below >= p * all {
                return middle_of(entry.0);
            }
        }
        // rounding may keep the last sum from reaching the whole
        self.0.last().map_or(0.0, |(class, ..)| middle_of(*class))
    }
}

impl Counts {
    /// The value below which the share `p` of all weight lies, the weight of a class spread evenly over it; 0 of nothing.
    fn interpolated(&self, p: f64, weights: &Weights) -> f64 {
        let equal = weights.are_equal();
        let weight = |&(_, stratum, count): &(u16, u16, u32)| {
            let one = if equal { 1.0 } else { weights.of_stratum(usize::from(stratum)) };
            one * f64::from(count)
        };
        let asked = p * self.0.iter().map(weight).sum::<f64>();
        let mut below = 0.0;
        for of_class in self.0.chunk_by(|one, next| one.0 == next.0) {
            let (class, all) = (of_class[0].0, of_class.iter().map(weight).sum::<f64>());
            if below + all >= asked && all > 0.0 {
                let share = ((asked - below) / all).clamp(0.0, 1.0);
                return if class == 0 {
                    SMALLEST * share
                } else {
                    lower_end_of(class) * math::pow(RATIO, share)
                };
            }
            below += all;
        }
        // rounding may keep the last sum from reaching the whole
        self.0.last().map_or(0.0, |(class, ..)| middle_of(*class))
    }

    /// How many values there are.
    pub(super) fn rocks(&self) -> usize {
        self.0.iter().map(|(.., count)| *count as usize).sum()
    }

    /// Percentile `p` by its class, with the interval of [`Percentile`]: by ranks where all weigh the same, else by their weights; none
    /// of nothing. It reaches to the far ends of its outer classes: where values lie inside a class is not kept.
    pub(super) fn percentile_with_interval(&self, p: f64, weights: &Weights) -> Option<Percentile> {
        if self.0.is_empty() {
            return None;
        }
        let equal = weights.are_equal();
        let one = |stratum: u16| if equal { 1.0 } else { weights.of_stratum(usize::from(stratum)) };
        let groups = self.0.iter().map(|&(_, stratum, count)| (one(stratum), count as usize));
        let Bounds { low, high, needs, .. } = WeightBelow::of(groups).bounds(p);
        Some(Percentile {
            value: self.interpolated(p, weights),
            low_95: low.map(|at| lower_end_of(self.0[at].0)),
            high_95: high.map(|at| lower_end_of(self.0[at].0 + 1)),
            upper_95: None,
            needs,
            censored: false,
        })
    }
}

/// Counts as one text of numbers: classes by their distance from the one before. In lists a summary would have a line a number.
pub(super) mod in_words {
    use super::Counts;
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serializer};
    use std::fmt::Write as _;

    pub(in crate::hazard) fn serialize<S: Serializer>(
        counts: &Counts,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        let (mut text, mut before) = (String::new(), 0);
        for &(class, stratum, count) in &counts.0 {
            let gap = if text.is_empty() { "" } else { " " };
            // writing to a string cannot fail
            let _ = write!(text, "{gap}{} {stratum} {count}", class - before);
            before = class;
        }
        to.serialize_str(&text)
    }

    pub(in crate::hazard) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Counts, D::Error> {
        let text = String::deserialize(from)?;
        let numbers: Vec<u32> = text
            .split_ascii_whitespace()
            .map(str::parse)
            .collect::<Result<_, _>>()
            .map_err(D::Error::custom)?;
        let mut class = 0;
        let (triples, []) = numbers.as_chunks::<3>() else {
            return Err(D::Error::custom("numbers that are no triples"));
        };
        let entry = |&[step, stratum, count]: &[u32; 3]| {
            class += step;
            Some((u16::try_from(class).ok()?, u16::try_from(stratum).ok()?, count))
        };
        let entries: Option<Vec<_>> = triples.iter().map(entry).collect();
        entries.map(Counts).ok_or_else(|| D::Error::custom("a class beyond all"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The percentile of the classes lies within 2.5 % of the ⌈p n⌉-th value, over twelve decades.
    #[test]
    fn percentiles_by_class_keep_their_error() {
        let values: Vec<f64> = (0..5000).map(|k| 2e-3 * 1.006_f64.powi(k)).collect();
        let mut counts = Counts::default();
        for value in &values {
            counts.add(*value, 0);
        }
        let weights = Weights::equal(5000);
        for p in [0.01, 0.5, 0.9, 0.95, 0.99] {
            let exact = values[(p * 5000.0_f64).ceil() as usize - 1];
            assert!((counts.percentile(p, &weights) / exact - 1.0).abs() < 0.025, "{p}");
        }
        assert_eq!(counts.0.iter().map(|(_, _, count)| count).sum::<u32>(), 5000);
    }
}
