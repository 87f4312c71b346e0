//! How fast and how high all rocks were, stretch by stretch of the distance from their release in plan view.
//!
//! Every rock counts once a stretch, with its largest values there. Percentiles come from counts over
//! [classes](super::classes) of equal ratio, so parts of a run join to the whole and nothing depends on the order of rocks.

use super::classes::Counts;
use super::quantile::Percentile;
use crate::frequency::Weights;
use crate::simulation;
use serde::{Deserialize, Serialize};

/// All rocks so far.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Profile {
    /// Length of a stretch (m); 0 before the first rock.
    step_m: f64,
    /// From the release on.
    stretches: Vec<StretchSums>,
}

/// What is known of one stretch.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct StretchSums {
    fastest_m_s: f64,
    highest_m: f64,
    #[serde(with = "super::classes::in_words")]
    speeds_m_s: Counts,
    #[serde(with = "super::classes::in_words")]
    heights_m: Counts,
}

/// Statistics of one quantity in one stretch.
#[derive(Debug, Clone, PartialEq)]
pub struct StretchStatistic {
    /// Median over the rocks that were there; its interval as that of every percentile.
    pub median: Percentile,
    /// 95th percentile.
    pub p95: Percentile,
    /// Largest of all.
    pub largest: f64,
}

/// One stretch of the profile.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfilePoint {
    /// Where it begins: distance from the release in plan view (m).
    pub from_m: f64,
    /// Rocks that were in it.
    pub rocks: usize,
    /// Largest speed of each (m/s).
    pub speed_m_s: StretchStatistic,
    /// Largest height of each above the ground (m).
    pub height_m: StretchStatistic,
}

/// The last stretch that is kept, counted from 0: the plan parts the longest way over a terrain into no more. A rock far larger than its terrain
/// pivots on over the rim, where there is no ground to be high above, and each metre of it was a stretch.
const LAST_STRETCH: u32 = 1000;

impl Profile {
    /// Whether no rock has been noted.
    pub fn is_empty(&self) -> bool {
        self.stretches.is_empty()
    }

    /// Length of a stretch (m).
    pub fn step_m(&self) -> f64 {
        self.step_m
    }

    /// Adds a rock of a stratum as far as there is terrain; `step_m` is the length of its stretches.
    pub fn add(&mut self, step_m: f64, stratum: u16, passed: &[simulation::Stretch]) {
        self.step_m = step_m;
        for one in passed.iter().filter(|one| one.number <= LAST_STRETCH) {
            let stretch = self.at(one.number as usize);
            stretch.fastest_m_s = stretch.fastest_m_s.max(one.speed_m_s);
            stretch.highest_m = stretch.highest_m.max(one.height_m);
            stretch.speeds_m_s.add(one.speed_m_s, stratum);
            stretch.heights_m.add(one.height_m, stratum);
        }
    }

    /// Adds what other rocks left.
    pub fn join(&mut self, other: &Self) {
        if other.is_empty() {
            return;
        }
        self.step_m = other.step_m;
        for (number, one) in other.stretches.iter().enumerate() {
            let StretchSums { fastest_m_s, highest_m, speeds_m_s, heights_m } = one;
            let stretch = self.at(number);
            stretch.fastest_m_s = stretch.fastest_m_s.max(*fastest_m_s);
            stretch.highest_m = stretch.highest_m.max(*highest_m);
            stretch.speeds_m_s.join(speeds_m_s);
            stretch.heights_m.join(heights_m);
        }
    }

    /// The stretches that rocks were in, from the release on, each rock by what it stands for.
    pub fn points(&self, weights: &Weights) -> Vec<ProfilePoint> {
        let of = |counts: &Counts, largest: f64| {
            let within = |found: Percentile| Percentile {
                value: found.value.min(largest),
                high_95: found.high_95.map(|high| high.min(largest)),
                ..found
            };
            Some(StretchStatistic {
                median: within(counts.percentile_with_interval(0.50, weights)?),
                p95: within(counts.percentile_with_interval(0.95, weights)?),
                largest,
            })
        };
        let point = |(number, one): (usize, &StretchSums)| {
            Some(ProfilePoint {
                from_m: number as f64 * self.step_m,
                rocks: one.speeds_m_s.rocks(),
                speed_m_s: of(&one.speeds_m_s, one.fastest_m_s)?,
                height_m: of(&one.heights_m, one.highest_m)?,
            })
        };
        self.stretches.iter().enumerate().filter_map(point).collect()
    }

    fn at(&mut self, number: usize) -> &mut StretchSums {
        if self.stretches.len() <= number {
            self.stretches.resize_with(number + 1, StretchSums::default);
        }
        &mut self.stretches[number]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rock(k: u32) -> Vec<simulation::Stretch> {
        let stretch = |number| simulation::Stretch {
            number,
            speed_m_s: 1.0 + f64::from((7 * k + number) % 100),
            height_m: 0.01 * f64::from(k % 10),
        };
        // every second rock comes twice as far
        (0..2 + 2 * (k % 2)).map(stretch).collect()
    }

    fn of(rocks: impl Iterator<Item = u32>) -> Profile {
        let mut profile = Profile::default();
        rocks.for_each(|k| profile.add(5.0, 0, &rock(k)));
        profile
    }

    /// Speeds of 200 rocks are 1 to 100, each twice: P95 is 95 within the error of the classes, and half of the rocks come
    /// farther. The interval is that of the ranks: 183 and 196 of 200 (binomial), values 92 and 98.
    #[test]
    fn every_rock_counts_once_a_stretch() {
        let points = of(0..200).points(&Weights::equal(200));
        let rocks: Vec<usize> = points.iter().map(|point| point.rocks).collect();
        assert_eq!(rocks, [200, 200, 100, 100]);
        let StretchStatistic { median, p95, largest } = &points[0].speed_m_s;
        let near = |found: f64, value: f64| (found / value - 1.0).abs() < 0.026;
        assert!(near(median.value, 50.0) && near(p95.value, 95.0), "{points:?}");
        assert!(near(p95.low_95.unwrap(), 92.0) && near(p95.high_95.unwrap(), 98.0), "{p95:?}");
        assert!((largest - 100.0).abs() < 1e-12 && (points[3].from_m - 15.0).abs() < 1e-12);
    }

    /// Two hundred million stretches beyond the terrain take no room.
    #[test]
    fn what_lies_beyond_any_terrain_is_left_out() {
        let far = |number| simulation::Stretch { number, speed_m_s: 3.0, height_m: 0.5 };
        let mut profile = Profile::default();
        profile.add(0.05, 0, &[0, 1000, 1001, 200_000_000].map(far));
        assert_eq!(profile.stretches.len(), 1001);
        assert!((profile.points(&Weights::equal(1))[1].from_m - 50.0).abs() < 1e-9);
    }

    /// Parts in any order give the bits of the whole, also by way of a file.
    #[test]
    fn parts_join_to_the_whole() {
        let (mut whole, odd) = (of((0..300).step_by(2)), of((1..300).step_by(2)));
        let text = serde_json::to_string(&odd).unwrap();
        whole.join(&serde_json::from_str(&text).unwrap());
        whole.join(&Profile::default());
        assert_eq!(whole, of(0..300));
    }
}
