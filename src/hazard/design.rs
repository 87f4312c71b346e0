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
    /// With all factors (J).
    pub energy_j: f64,
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
        let product = |factors: &BTreeMap<String, f64>| factors.values().product::<f64>();
        let on_energy = product(&self.speed_factors).powi(2) * product(&self.mass_factors);
        let on_height = product(&self.height_factors);
        let with_energy = |joule: f64| joule * on_energy;
        let with_height = |metre: f64| metre * on_height + self.free_height_m;
        let ends = |of: &Percentile| [of.low_95, of.high_95];
        Ok(Design {
            energy_percentile_j: energy.value,
            energy_j: with_energy(energy.value),
            energy_95_j: ends(&energy).map(|end| end.map(with_energy)),
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
        }
    }

    fn equal() -> Weights {
        Weights::equal(2000)
    }

    fn rocks(count: usize) -> Vec<Arrival> {
        let rock = |k: usize| Arrival { release: k, top_m: k as f64, total_j: 10.0 * k as f64 };
        (1..=count).map(rock).collect()
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
