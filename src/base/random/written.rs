//! How a scene writes a distribution: a number or a table.

use super::{Distribution, Entries};
use crate::error::Flaw;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// The keys a distribution may have.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum DistributionKey {
    Uniform,
    Normal,
    Lognormal,
    Triangular,
    Values,
    Weights,
}

/// The table under `normal`; in the unit of the key it stands for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { mean = …, sd = …, min = …, max = … }")]
pub(super) struct NormalTable {
    pub(super) mean: f64,
    pub(super) sd: f64,
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
}

/// The table under `lognormal`: `median` in the unit of the key, `sigma` of the logarithm (–).
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { median = …, sigma = …, min = …, max = … }")]
pub(super) struct Lognormal {
    pub(super) median: f64,
    pub(super) sigma: f64,
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Distribution;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a number or a distribution such as { uniform = [0.2, 0.6] }")
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Distribution, E> {
        Distribution::fixed(value).map_err(E::custom)
    }

    fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Distribution, E> {
        self.visit_f64(value as f64)
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Distribution, M::Error> {
        let mut found: Vec<Result<Distribution, Flaw>> = Vec::new();
        let (mut values, mut weights) = (None, None);
        while let Some(key) = map.next_key()? {
            match key {
                DistributionKey::Uniform => {
                    let Entries(ends) = map.next_value()?;
                    found.push(Distribution::uniform(ends));
                }
                DistributionKey::Normal => found.push(Distribution::normal(&map.next_value()?)),
                DistributionKey::Lognormal => {
                    found.push(Distribution::lognormal(&map.next_value()?));
                }
                DistributionKey::Triangular => {
                    let Entries(ends) = map.next_value()?;
                    found.push(Distribution::triangular(ends));
                }
                DistributionKey::Values => values = Some(map.next_value()?),
                DistributionKey::Weights => weights = Some(map.next_value()?),
            }
        }
        if values.is_some() || weights.is_some() {
            found.push(Distribution::values(values.unwrap_or_default(), weights));
        }
        match (found.pop(), found.is_empty()) {
            (Some(one), true) => one.map_err(M::Error::custom),
            (None, _) => Err(M::Error::custom(Flaw::new("found an empty table", ONE))),
            _ => Err(M::Error::custom(Flaw::new("found several distributions", ONE))),
        }
    }
}

const ONE: &str = "write a number or exactly one of uniform, normal, lognormal, triangular, values";

impl<'de> Deserialize<'de> for Distribution {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Reader)
    }
}
