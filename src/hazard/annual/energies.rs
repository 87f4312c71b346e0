//! Energies of the rocks that pass a place: of each rock as long as there is room, of many rocks in narrow classes.

use super::super::classes::{ClassPart, class_of};

/// Energies that are told apart, those of rocks of different strata for themselves: half a megabyte.
const MOST_ENERGIES: usize = 1 << 15;
/// Rocks that are sorted in at a time.
const AT_ONCE: usize = 1 << 10;

/// Rocks of one stratum with one energy, or in one class of energies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct EnergyCount {
    /// Bits of the energy without the last ones: energies that are not negative have the order of their bits.
    key: u64,
    stratum: u16,
    rocks: u32,
}

/// How many rocks of each stratum have each energy. The memory that it takes does not grow with the rocks: where more than
/// [`MOST_ENERGIES`] are to be told apart, all are kept to one bit less.
#[derive(Debug, Default)]
pub(super) struct EnergyCounts {
    /// By rising energy and stratum.
    sorted: Vec<EnergyCount>,
    /// As they came, [`AT_ONCE`] at most.
    fresh: Vec<EnergyCount>,
    /// Last bits of an energy that are not kept.
    dropped_bits: u32,
}

/// Rocks of one stratum in a class of energies, which has no width as long as rocks are told apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct EnergyClass {
    pub(super) lower_j: f64,
    pub(super) upper_j: f64,
    /// That of equal ratios in which its lower end lies.
    pub(super) class: u16,
    pub(super) stratum: u16,
    pub(super) rocks: u32,
}

impl EnergyClass {
    /// Rocks in a part of a class of equal ratios.
    pub(super) fn of(part: ClassPart) -> Self {
        let ClassPart { class, ends: [lower_j, upper_j], stratum, rocks } = part;
        Self { lower_j, upper_j, class, stratum, rocks }
    }
}

impl EnergyCounts {
    /// Adds a rock. What is kept depends on the order of the rocks only where energies are not told apart: it is that of
    /// their releases, however many threads or shards compute them.
    pub(super) fn add(&mut self, energy_j: f64, stratum: u16) {
        // an energy that is no number is none
        let key = energy_j.max(0.0).to_bits() >> self.dropped_bits;
        self.fresh.push(EnergyCount { key, stratum, rocks: 1 });
        if self.fresh.len() == AT_ONCE {
            self.sorted.append(&mut self.fresh);
            merge(&mut self.sorted);
            while self.sorted.len() > MOST_ENERGIES {
                self.dropped_bits += 1;
                self.sorted.iter_mut().for_each(|one| one.key >>= 1);
                merge(&mut self.sorted);
            }
        }
    }

    /// All of them, by **falling** energy.
    pub(super) fn falling(&self) -> Vec<EnergyClass> {
        let mut all = [&self.sorted[..], &self.fresh].concat();
        merge(&mut all);
        let end = |key: u64| f64::from_bits(key << self.dropped_bits);
        let class = |&EnergyCount { key, stratum, rocks }: &EnergyCount| {
            let lower_j = end(key);
            let upper_j = if self.dropped_bits == 0 { lower_j } else { end(key + 1) };
            EnergyClass { lower_j, upper_j, class: class_of(lower_j), stratum, rocks }
        };
        all.iter().rev().map(class).collect()
    }
}

/// Sorts, and puts rocks of one stratum and energy together.
fn merge(counts: &mut Vec<EnergyCount>) {
    // stable sorting takes what is in order already as it is
    counts.sort();
    counts.dedup_by(|next, kept| {
        let is_same = (next.key, next.stratum) == (kept.key, kept.stratum);
        kept.rocks += if is_same { next.rocks } else { 0 };
        is_same
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few rocks are kept as they are; of many none is lost, their classes hold them, are narrow and take no more room.
    #[test]
    #[expect(clippy::float_cmp, reason = "the same numbers")]
    fn energies_are_those_of_rocks_or_in_narrow_classes() {
        let energy_j =
            |k: usize| 1e3 * (0.618_033_988_7 * k as f64).fract().mul_add(8.0, 0.0).exp();
        for rocks in [10, 3_000, 20_000, 300_000] {
            let mut counts = EnergyCounts::default();
            (0..rocks).for_each(|k| counts.add(energy_j(k), 0));
            let mut energies: Vec<f64> = (0..rocks).map(energy_j).collect();
            energies.sort_by(|one, next| next.total_cmp(one));
            let falling = counts.falling();
            assert!(falling.len() <= MOST_ENERGIES + AT_ONCE);
            let mut left = &energies[..];
            for class in &falling {
                let (inside, lower) = left.split_at(class.rocks as usize);
                let is_in = |joule: &f64| (class.lower_j..=class.upper_j).contains(joule);
                assert!(inside.iter().all(is_in), "{class:?} {inside:?}");
                assert!(class.upper_j / class.lower_j < 1.001, "{class:?}");
                assert!(rocks > MOST_ENERGIES || class.lower_j == class.upper_j);
                left = lower;
            }
            assert!(left.is_empty());
        }
    }
}
