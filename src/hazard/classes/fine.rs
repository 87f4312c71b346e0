//! Counts over parts of the [classes](super) of equal ratio: as narrow as there is room for.

use super::{Counts, RATIO, class_of, lower_end_of};
use crate::math;
use serde::{Deserialize, Serialize};

/// How often a class of values is halved at most: into parts of a ratio of 1.003.
const CLASS_HALVINGS: u8 = 4;
/// Parts and strata that are told apart before all parts are doubled: 16 kB.
const MOST_CLASS_PARTS: usize = 1 << 11;
/// Largest class that has parts (beyond 1e84 J values are not told apart): two bytes number all parts.
const LAST_CLASS: u16 = (u16::MAX >> CLASS_HALVINGS) - 1;

/// How often values fell in each part of a class. Parts get wider where there are many values, by what the values are and
/// not by their order: joined in any way, counts are the same.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "(u8, Counts)", into = "(u8, Counts)")]
pub(in crate::hazard) struct FineCounts {
    /// How often each class is halved.
    halvings: u8,
    counts: Counts,
}

impl From<(u8, Counts)> for FineCounts {
    fn from((halvings, counts): (u8, Counts)) -> Self {
        Self { halvings, counts }
    }
}

impl From<FineCounts> for (u8, Counts) {
    fn from(of: FineCounts) -> Self {
        (of.halvings, of.counts)
    }
}

/// Rocks of one stratum whose values lie in a part of a class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::hazard) struct ClassPart {
    pub(in crate::hazard) class: u16,
    /// Ends of the part, in the unit of the values.
    pub(in crate::hazard) ends: [f64; 2],
    pub(in crate::hazard) stratum: u16,
    pub(in crate::hazard) rocks: u32,
}

impl FineCounts {
    /// Of nothing, with parts; without them classes are whole.
    pub(in crate::hazard) fn in_parts() -> Self {
        Self { halvings: CLASS_HALVINGS, counts: Counts::default() }
    }

    /// Adds the value of a rock of a stratum.
    pub(in crate::hazard) fn add(&mut self, value: f64, stratum: u16) {
        self.counts.add_class((part_of(value, self.halvings), stratum), 1);
        self.make_room();
    }

    pub(in crate::hazard) fn join(&mut self, other: &Self) {
        let halvings = self.halvings.min(other.halvings);
        self.widen(halvings);
        for &(part, stratum, count) in other.counts.entries() {
            self.counts.add_class((part >> (other.halvings - halvings), stratum), count);
        }
        self.make_room();
    }

    fn make_room(&mut self) {
        while self.halvings > 0 && self.counts.0.len() > MOST_CLASS_PARTS {
            self.widen(self.halvings - 1);
        }
    }

    /// Keeps no more than so many halvings of a class.
    fn widen(&mut self, halvings: u8) {
        let by = self.halvings - halvings;
        if by == 0 {
            return;
        }
        self.halvings = halvings;
        let narrow = std::mem::take(&mut self.counts);
        for &(part, stratum, count) in narrow.entries() {
            self.counts.add_class((part >> by, stratum), count);
        }
    }

    /// Stratum and count of all parts.
    pub(in crate::hazard) fn rocks(&self) -> impl Iterator<Item = (u16, u32)> + '_ {
        self.counts.entries().iter().map(|&(_, stratum, count)| (stratum, count))
    }

    /// The same over whole classes.
    pub(in crate::hazard) fn by_class(&self) -> Counts {
        let mut whole = self.clone();
        whole.widen(0);
        whole.counts
    }

    /// All parts, by **falling** value.
    pub(in crate::hazard) fn falling(&self) -> impl Iterator<Item = ClassPart> + '_ {
        let part = |&(part, stratum, rocks): &(u16, u16, u32)| ClassPart {
            class: part >> self.halvings,
            ends: [self.end(part), self.end(part + 1)],
            stratum,
            rocks,
        };
        self.counts.entries().iter().rev().map(part)
    }

    /// Lower end of a part; the first class is one.
    fn end(&self, part: u16) -> f64 {
        let (class, within) = (part >> self.halvings, part & ((1 << self.halvings) - 1));
        if class == 0 && within > 0 {
            return lower_end_of(1);
        }
        let share = f64::from(within) / f64::from(1u16 << self.halvings);
        lower_end_of(class) * math::pow(RATIO, share)
    }
}

/// The part of a class that a value lies in.
fn part_of(value: f64, halvings: u8) -> u16 {
    let class = class_of(value).min(LAST_CLASS);
    let parts = f64::from(1u16 << halvings);
    let share =
        if class == 0 { 0.0 } else { math::ln(value / lower_end_of(class)) / math::ln(RATIO) };
    // rounding may put a value beside its class; one beyond all lies in the last part
    let within = (share * parts).floor().clamp(0.0, parts - 1.0) as u16;
    (class << halvings) | within
}

#[cfg(test)]
mod tests {
    use super::*;

    fn energy_j(k: u32) -> f64 {
        1e3 * (9.0 * (0.618_033_988_7 * f64::from(k)).fract()).exp()
    }

    /// Each value lies in its part, whose class is that of the value, and no value is lost, few or many.
    #[test]
    fn values_lie_in_their_parts() {
        for (rocks, most_ratio) in [(10, 1.004), (600, 1.004), (50_000, 1.026)] {
            let mut counts = FineCounts::in_parts();
            (0..rocks).for_each(|k| counts.add(energy_j(k), (k % 3) as u16));
            assert!(counts.counts.0.len() <= MOST_CLASS_PARTS);
            let mut values: Vec<f64> = (0..rocks).map(energy_j).collect();
            values.sort_by(|one, next| next.total_cmp(one));
            let mut left = &values[..];
            let parts: Vec<ClassPart> = counts.falling().collect();
            for same in parts.chunk_by(|one, next| one.ends[0].total_cmp(&next.ends[0]).is_eq()) {
                let inside: u32 = same.iter().map(|part| part.rocks).sum();
                let (of_part, lower) = left.split_at(inside as usize);
                let [low, high] = same[0].ends;
                let (low, high) = (low * (1.0 - 1e-12), high * (1.0 + 1e-12));
                assert!(of_part.iter().all(|value| (low..high).contains(value)), "{same:?}");
                assert!(of_part.iter().all(|value| class_of(*value) == same[0].class));
                assert!(high / low < most_ratio, "{rocks}: {}", high / low);
                left = lower;
            }
            assert!(left.is_empty());
        }
    }

    /// Joined from parts in any order, counts are those of all one after the other, also where they had to be widened.
    #[test]
    fn joined_counts_are_the_same() {
        let of = |rocks: std::ops::Range<u32>| {
            let mut counts = FineCounts::in_parts();
            rocks.for_each(|k| counts.add(energy_j(k), (k % 3) as u16));
            counts
        };
        for rocks in [300, 2_000, 30_000] {
            let whole = of(0..rocks);
            let parts = [of(0..rocks / 10), of(rocks / 10..rocks / 2), of(rocks / 2..rocks)];
            for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
                let mut joined = FineCounts::in_parts();
                for k in order {
                    joined.join(&parts[k]);
                }
                assert!(joined == whole, "{rocks} {order:?}");
            }
        }
    }

    /// Whole classes are those that are counted without parts.
    #[test]
    fn whole_classes_are_as_without_parts() {
        let (mut fine, mut whole, mut plain) =
            (FineCounts::in_parts(), FineCounts::default(), Counts::default());
        for k in 0..3_000 {
            fine.add(energy_j(k), 0);
            whole.add(energy_j(k), 0);
            plain.add(energy_j(k), 0);
        }
        assert!(fine.by_class() == plain && whole.by_class() == plain);
    }

    /// What lies beyond all classes, nothing and what is smaller than told apart have their place.
    #[test]
    fn extreme_values_have_a_part() {
        let mut counts = FineCounts::in_parts();
        for value in [0.0, 1e-9, f64::NAN, 1e300, f64::INFINITY] {
            counts.add(value, 0);
        }
        assert_eq!(counts.rocks().map(|(_, rocks)| rocks).sum::<u32>(), 5);
    }
}
