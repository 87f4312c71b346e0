//! What a rule asks of a barrier, from the rocks that arrive at it.

use super::arrival::{Arrival, sample};
use super::quantile::Percentile;
use super::sample::Sample;
use crate::frequency::Weights;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A design rule: a percentile and factors, each by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rule {
    /// The standard it follows, in words; none = the scene's own.
    #[serde(default)]
    pub standard: Option<String>,
    /// Percentile of energy and height over the rocks that arrive (per cent), above 0 and below 100.
    pub percentile: f64,
    /// Factors on the speed (–); they enter the energy squared.
    #[serde(default)]
    pub speed_factors: BTreeMap<String, f64>,
    /// Factors on the mass (–).
    #[serde(default)]
    pub mass_factors: BTreeMap<String, f64>,
    /// Factors on the height (–).
    #[serde(default)]
    pub height_factors: BTreeMap<String, f64>,
    /// Free height to be kept above the design height (m).
    pub free_height_m: f64,
    /// Distance that must be kept free behind the barrier (m), where elongation and standard are named.
    #[serde(default)]
    pub free_distance_m: Option<f64>,
    /// The design block whose mass the energy is of; none = the energy is a percentile of total energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<DesignBlock>,
    /// How many times the design energy the capacity must be (–), 1 or more; none where that is not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capacity_factor: Option<f64>,
}

/// The block that a barrier is designed for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DesignBlock {
    /// Its volume (m³).
    pub volume_m3: f64,
    /// Its mass, without factors (kg).
    pub mass_kg: f64,
}

/// What a rule asks of a barrier at its place.
///
/// The intervals are those of the percentiles, with the same factors: they say what chance in the sample does, not how
/// well the factors are known. Where so few rocks arrive that they bound a percentile from one side only, its interval has
/// no upper end, as that of the percentile has none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// The percentile of total energy (J).
    pub energy_percentile_j: f64,
    /// The percentile of speed (m/s); none without a design block.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_percentile_m_s: Option<f64>,
    /// With all factors (J): the percentile of total energy, or `m v²/2` of the design block and the percentile of speed.
    pub energy_j: f64,
    /// Capacity that the rule asks for (J); none where it has no factor on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capacity_j: Option<f64>,
    /// The 95 % interval of `energy_j` (J).
    #[serde(default)]
    pub energy_95_j: [Option<f64>; 2],
    /// The percentile of the height of the rock's highest point (m).
    pub height_percentile_m: f64,
    /// With all factors and the free height (m).
    pub height_m: f64,
    /// The 95 % interval of `height_m` (m).
    #[serde(default)]
    pub height_95_m: [Option<f64>; 2],
}

impl Rule {
    /// What it asks for, from the rocks that arrive, each with what it stands for.
    ///
    /// # Errors
    /// The number of rocks missing: a percentile that no rock bounds from above is no design value. Where rocks weigh
    /// differently, as many count as of equal weight would say as much.
    pub(super) fn design(&self, rocks: &[Arrival], weights: &Weights) -> Result<Design, usize> {
        let p = self.percentile / 100.0;
        let percentile = |of: fn(&Arrival) -> f64| -> Result<Percentile, usize> {
            let sample = sample(rocks, weights, of);
            // of nothing, how many are needed is still known
            let needs = Sample::of([0.0]).percentile(p).map_or(1, |of| of.needs);
            let rocks = if sample.values().is_empty() { 0.0 } else { sample.effective_rocks() };
            let lacks = needs - (rocks.floor() as usize).min(needs);
            let found = sample.percentile(p).filter(|_| lacks == 0);
            // enough of them, but the heaviest may stand so high that nothing bounds the percentile
            found.filter(|of| of.high_95.or(of.upper_95).is_some()).ok_or(lacks.max(1))
        };
        let (energy, height) = (percentile(|rock| rock.total_j)?, percentile(|rock| rock.top_m)?);
        let speed = match self.block {
            Some(_) => Some(percentile(|rock| rock.speed_m_s)?),
            None => None,
        };
        let product = |factors: &BTreeMap<String, f64>| factors.values().product::<f64>();
        let on_energy = product(&self.speed_factors).powi(2) * product(&self.mass_factors);
        let on_height = product(&self.height_factors);
        let of_block = |at: f64| self.block.map_or(at, |block| 0.5 * block.mass_kg * at.powi(2));
        let with_energy = |percentile: f64| of_block(percentile) * on_energy;
        let decides = speed.as_ref().unwrap_or(&energy);
        let energy_j = with_energy(decides.value);
        let with_height = |metre: f64| metre * on_height + self.free_height_m;
        let ends = |of: &Percentile| [of.low_95, of.high_95];
        Ok(Design {
            energy_percentile_j: energy.value,
            speed_percentile_m_s: speed.as_ref().map(|speed| speed.value),
            energy_j,
            capacity_j: self.capacity_factor.map(|factor| factor * energy_j),
            energy_95_j: ends(decides).map(|end| end.map(with_energy)),
            height_percentile_m: height.value,
            height_m: with_height(height.value),
            height_95_m: ends(&height).map(|end| end.map(with_height)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule() -> Rule {
        Rule {
            standard: None,
            percentile: 95.0,
            speed_factors: [("a".to_owned(), 1.1)].into(),
            mass_factors: [("b".to_owned(), 2.0)].into(),
            height_factors: [("c".to_owned(), 1.5)].into(),
            free_height_m: 0.5,
            free_distance_m: None,
            block: None,
            capacity_factor: None,
        }
    }

    fn equal() -> Weights {
        Weights::equal(2000)
    }

    fn rocks(count: usize) -> Vec<Arrival> {
        let rock = |k: usize| {
            let speed_m_s = k as f64 / 50.0;
            Arrival { release: k, top_m: k as f64, total_j: 10.0 * k as f64, speed_m_s }
        };
        (1..=count).map(rock).collect()
    }

    /// By hand, as UNI 11211-4 has it: of 1000 rocks from 0.02 to 20 m/s P95 is at 19.001 m/s (rank 950.05); with 1.02 · 1.10 on it `v_d = 21.3191 m/s`. A block of 2 m³ of 2700 kg/m³ weighs
    /// 5400 kg, with 1.02 on its volume 5508 kg: `E_d = 5508 · 21.3191²/2 = 1 251 707 J`; the capacity 1.2 times that.
    #[test]
    fn the_energy_of_a_design_block_is_that_of_its_mass_and_the_percentile_of_speed() {
        let mut uni = rule();
        uni.speed_factors =
            [("topography".to_owned(), 1.02), ("simulation".to_owned(), 1.10)].into();
        uni.mass_factors = [("block volume".to_owned(), 1.02)].into();
        uni.block = Some(DesignBlock { volume_m3: 2.0, mass_kg: 5400.0 });
        uni.capacity_factor = Some(1.2);
        let found = uni.design(&rocks(1000), &equal()).unwrap();
        assert!((found.speed_percentile_m_s.unwrap() - 19.001).abs() < 1e-9);
        assert!((found.energy_j - 1_251_706.7).abs() < 0.1, "{}", found.energy_j);
        assert!((found.capacity_j.unwrap() - 1_502_048.0).abs() < 0.1);
        // 936th to 964th of 1000: 18.72 and 19.28 m/s
        let [low, high] = found.energy_95_j.map(Option::unwrap);
        assert!((low / found.energy_j - (18.72_f64 / 19.001).powi(2)).abs() < 1e-9);
        assert!((high / found.energy_j - (19.28_f64 / 19.001).powi(2)).abs() < 1e-9);
        // the height and the percentile of energy are as without a block
        let plain = rule().design(&rocks(1000), &equal()).unwrap();
        assert_eq!(found.height_m.to_bits(), plain.height_m.to_bits());
        assert_eq!(found.energy_percentile_j.to_bits(), plain.energy_percentile_j.to_bits());
        assert_eq!((plain.speed_percentile_m_s, plain.capacity_j), (None, None));
    }

    /// 0.95⁵⁹ < 0.05 < 0.95⁵⁸: 58 rocks say nothing about P95 from above, one more does.
    #[test]
    fn too_few_rocks_give_no_design_but_what_is_missing() {
        assert_eq!(rule().design(&[], &equal()), Err(59));
        assert_eq!(rule().design(&rocks(7), &equal()), Err(52));
        assert_eq!(rule().design(&rocks(58), &equal()), Err(1));
        assert!(rule().design(&rocks(59), &equal()).is_ok());
    }

    /// Ranks of the exact binomial sum (tests/statistics/hazard.rs): 936 to 964 of 1000; of 59 the 52nd from below and none
    /// from above, as 0.95⁷¹ > 2.5 %. Energy carries 1.1² · 2 = 2.42, height 1.5 and half a metre.
    #[test]
    fn design_values_carry_the_interval_of_their_percentile() {
        for (count, low, high) in [(59, 52.0, None), (71, 63.0, None), (1000, 936.0, Some(964.0))] {
            let found = rule().design(&rocks(count), &equal()).unwrap();
            let ends = |with: fn(f64) -> f64| [Some(low), high].map(|rank| rank.map(with));
            let energies = found.energy_95_j.into_iter().zip(ends(|rank| 24.2 * rank));
            for (found, expected) in energies {
                assert_eq!(found.is_some(), expected.is_some(), "{count} rocks");
                let off = found.zip(expected).map_or(0.0, |(found, expected)| found - expected);
                assert!(off.abs() < 1e-9, "{found:?} {expected:?}");
            }
            assert_eq!(found.height_95_m, ends(|rank| 1.5 * rank + 0.5));
            assert!(found.energy_95_j[0].unwrap() < found.energy_j);
        }
    }
}
