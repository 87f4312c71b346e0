//! Magnitude–frequency laws, cut into strata.

use super::{STRATA, STRATA_PER_DECADE};
use crate::math;
use serde::{Deserialize, Serialize};

/// How often a source releases rocks of what size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrequencyLaw {
    /// Events a year; the sizes are those of the scene's rocks.
    Events {
        /// Events a year (1/year), positive.
        per_year: f64,
    },
    /// `N(≥ V) = a V^−b` events a year of at least the volume `V` (m³) between two volumes (Hantz et al. 2021,
    /// Geosciences 11, 158).
    PowerLaw {
        /// `a`: events a year of 1 m³ or more (1/year), positive.
        per_year_at_1m3: f64,
        /// `b` (–), positive.
        exponent: f64,
        /// Smallest and largest volume (m³), positive and rising.
        volume_m3: [f64; 2],
    },
    /// Events a year, class by class of volume.
    Classes(Vec<Class>),
}

/// A class of volume.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Class {
    /// Smallest and largest volume (m³); the same twice where all rocks are equal. Even in the logarithm in between.
    pub volume_m3: [f64; 2],
    /// Events a year (1/year), positive.
    pub per_year: f64,
}

/// A part of a source's rocks that is sampled on its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Stratum {
    /// Number of the source.
    pub source: usize,
    /// Smallest and largest volume (m³); none where the scene's rocks say how large they are.
    pub volume_m3: Option<[f64; 2]>,
    /// Exponent of the power law that it belongs to (–).
    pub exponent: Option<f64>,
    /// Events a year (1/year).
    pub per_year: f64,
}

impl FrequencyLaw {
    /// Its strata, at most so many where it may be cut at will; `source` is their source's number.
    pub(super) fn strata(&self, source: usize, most: usize) -> Vec<Stratum> {
        match self {
            Self::Events { per_year } => {
                vec![Stratum { source, volume_m3: None, exponent: None, per_year: *per_year }]
            }
            Self::PowerLaw { per_year_at_1m3, exponent, volume_m3: [least, largest] } => {
                let ratio = largest / least;
                let wanted = (STRATA_PER_DECADE * math::log10(ratio)).ceil();
                let count = (wanted as usize).clamp(1, most);
                let edge = |k: usize| match k {
                    0 => *least,
                    k if k == count => *largest,
                    k => least * math::pow(ratio, k as f64 / count as f64),
                };
                let beyond = |v: f64| per_year_at_1m3 * math::pow(v, -exponent);
                let per_year = |volume_m3: [f64; 2]| {
                    let thin = thinly_spread(volume_m3, *exponent);
                    thin.map_or_else(
                        || beyond(volume_m3[0]) - beyond(volume_m3[1]),
                        |spread| -beyond(volume_m3[0]) * libm::expm1(-spread),
                    )
                };
                let stratum = |k: usize| {
                    let volume_m3 = [edge(k), edge(k + 1)];
                    Stratum {
                        source,
                        volume_m3: Some(volume_m3),
                        exponent: Some(*exponent),
                        per_year: per_year(volume_m3),
                    }
                };
                (0..count).map(stratum).collect()
            }
            Self::Classes(classes) => {
                let stratum = |class: &Class| Stratum {
                    source,
                    volume_m3: Some(class.volume_m3),
                    exponent: None,
                    per_year: class.per_year,
                };
                classes.iter().map(stratum).collect()
            }
        }
    }

    /// Whether its rates and their squares are numbers that a computer tells apart from 0 and from infinity: none of its
    /// strata comes more seldom than 10⁻¹²⁰ or more often than 10¹² times a year.
    pub fn is_countable(&self) -> bool {
        let rates = self.strata(0, STRATA);
        rates.iter().all(|stratum| (1e-120..=1e12).contains(&stratum.per_year))
    }

    /// Events a year of all sizes together (1/year).
    pub fn per_year(&self) -> f64 {
        self.strata(0, 1).iter().map(|stratum| stratum.per_year).sum()
    }

    /// The law in words.
    pub fn in_words(&self) -> String {
        match self {
            Self::Events { per_year } => {
                format!("{per_year} events a year of the scene's rocks")
            }
            Self::PowerLaw { per_year_at_1m3, exponent, volume_m3: [least, largest] } => format!(
                "{} V^-{exponent} events a year of V m³ or more, {least} to {largest} m³",
                six_digits(*per_year_at_1m3)
            ),
            Self::Classes(classes) => {
                let class = |class: &Class| {
                    let Class { volume_m3: [least, largest], per_year } = class;
                    // without spaces: in a list a pattern of words then ends where a class does
                    let volumes = if least.total_cmp(largest).is_eq() {
                        least.to_string()
                    } else {
                        format!("{least}–{largest}")
                    };
                    format!("{per_year} a year of {volumes} m³")
                };
                classes.iter().map(class).collect::<Vec<_>>().join(", ")
            }
        }
    }
}

/// `V_0^−b − V_1^−b` of two volumes (m³): events a year between them for each of 1 m³ or more.
pub fn power_between(volume_m3: [f64; 2], exponent: f64) -> f64 {
    let [least, most] = volume_m3.map(|volume| math::pow(volume, -exponent));
    thinly_spread(volume_m3, exponent).map_or(least - most, |spread| -least * libm::expm1(-spread))
}

/// Below this `b ln(V_1/V_0)` the difference of two powers would lose its digits (–).
const THIN: f64 = 1e-3;

/// `b ln(V_1/V_0)` where it is so small that differences must be found from it: nearly equal volumes, or an exponent near 0.
fn thinly_spread([least, largest]: [f64; 2], exponent: f64) -> Option<f64> {
    let spread = exponent * libm::log1p((largest - least) / least);
    (spread < THIN).then_some(spread)
}

/// A number that may have been computed, without digits that tell nothing.
fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

impl Stratum {
    /// The volume (m³) that the share `p` (–, 0..1) of its rocks stays below; none where the scene's rocks say.
    ///
    /// Power law: `V^−b = V_0^−b − p (V_0^−b − V_1^−b)`; a class of a table: even in the logarithm.
    pub fn quantile_m3(&self, p: f64) -> Option<f64> {
        let [least, largest] = self.volume_m3?;
        let volume = match self.exponent {
            Some(b) => {
                if let Some(spread) = thinly_spread([least, largest], b) {
                    let below = libm::log1p(p * libm::expm1(-spread));
                    return Some((least * math::exp(-below / b)).clamp(least, largest));
                }
                // over the smallest volume, so that steep laws neither overflow nor vanish
                let end = math::pow(largest / least, -b);
                least * math::pow(1.0 - p * (1.0 - end), -1.0 / b)
            }
            None => least * math::pow(largest / least, p),
        };
        Some(volume.clamp(least, largest))
    }

    /// How its frequency of one volume (m³) changes with the exponent, over itself: `∂ ln(a b V^−b−1)/∂b = 1/b − ln V`.
    /// Over its rocks the mean is `∂ ln f_j/∂b`. None where there is no exponent.
    pub fn score(&self, volume_m3: f64) -> Option<f64> {
        self.exponent.map(|b| 1.0 / b - math::ln(volume_m3))
    }

    /// Its mean over all rocks of the stratum, `∂ ln f_j/∂b = ln(V_1/V_0) r/(1 − r) − ln V_0` with `r = (V_1/V_0)^−b`. None
    /// where there is no exponent.
    pub fn mean_score(&self) -> Option<f64> {
        let ([least, largest], b) = (self.volume_m3?, self.exponent?);
        let decades = math::ln(largest / least);
        // of a thin stratum r/(1 − r) is 1/(b ln(V_1/V_0)), and the score that of its volume
        let grown = libm::expm1(b * decades);
        let part = if grown > 0.0 { decades / grown } else { 1.0 / b };
        Some(part - math::ln(least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One volume is said once: a class of 8 m³ read "8 to 8 m³".
    #[test]
    fn one_volume_is_said_once() {
        let class = |volume_m3, per_year| Class { volume_m3, per_year };
        let law = FrequencyLaw::Classes(vec![class([8.0, 8.0], 0.2), class([0.5, 2.0], 0.003)]);
        assert_eq!(law.in_words(), "0.2 a year of 8 m³, 0.003 a year of 0.5–2 m³");
    }
}
