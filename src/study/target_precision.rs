//! `runout.p95 < 1.0 m`: a statistic and how narrow its confidence interval shall be.

use crate::hazard::{Hazard, Open, PERCENTS, Percentile, Quantity, Sample};
use std::fmt;
use std::str::FromStr;

/// Names of the quantities that can be aimed at, with their units.
const NAMES: [(&str, Quantity, &str); 8] = [
    ("runout", Quantity::Runout, "m"),
    ("reach_angle", Quantity::ReachAngle, "deg"),
    ("speed", Quantity::MaxSpeed, "m/s"),
    ("translational", Quantity::MaxTranslational, "J"),
    ("rotational", Quantity::MaxRotational, "J"),
    ("energy", Quantity::MaxTotal, "J"),
    ("height", Quantity::MaxHeight, "m"),
    ("time", Quantity::Time, "s"),
];
/// Units that stand for a thousand or a million joules.
const MULTIPLES: [(&str, &str, f64); 2] = [("kJ", "J", 1e3), ("MJ", "J", 1e6)];

/// Narrowest interval that can be aimed at (SI).
const NARROWEST: f64 = 1e-3;

/// A percentile and the width that its 95 % interval must stay below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TargetPrecision {
    /// The quantity.
    pub quantity: Quantity,
    /// Which percentile (per cent).
    pub percent: u8,
    /// Largest width of the interval, upper minus lower end, in the SI unit of the quantity.
    pub width: f64,
    name: &'static str,
    unit: &'static str,
}

impl TargetPrecision {
    /// The percentile of a sample.
    fn percentile(&self, sample: &Sample) -> Option<Percentile> {
        sample.percentile(f64::from(self.percent) / 100.0)
    }

    /// Width of the interval; `None` with too few rocks.
    fn width_of(found: &Percentile) -> Option<f64> {
        Some(found.high_95? - found.low_95?)
    }

    /// Why more releases do not help: rocks that were seen only in part decide this percentile.
    ///
    /// With ever more releases the ends of its interval come to the percentile as seen, and to that with each of those rocks at the far end of
    /// where it may have come. Where they are so many that the latter is one of them, the interval is open however many releases there are;
    /// else it is at least as wide as the two are apart.
    pub fn refusal(&self, hazard: &Hazard) -> Option<String> {
        let sample = hazard.sample(self.quantity);
        let seen = self.percentile(&hazard.sample_as_seen(self.quantity))?;
        let far = sample.far_percentile(f64::from(self.percent) / 100.0)?;
        let rocks = sample.values().len();
        let why = if far.value.is_infinite() && rocks >= 2 * seen.needs {
            "has an interval without an end"
        } else if self.gap(&seen, &far).is_some_and(|gap| gap > self.width) {
            "has a wider interval, as they may have gone on,"
        } else {
            return None;
        };
        Some(format!(
            "--until \"{self}\": {} of {rocks} rocks left the terrain, ran out of time or failed: p{} of {} {why} with any number of releases; give terrain that reaches farther, a longer [solver] longest_s, or aim at a smaller percentile",
            sample.bounds(),
            self.percent,
            self.name
        ))
    }

    /// How far the percentile as seen and that of the far ends lie apart at least, whatever chance did to both.
    fn gap(&self, seen: &Percentile, far: &Percentile) -> Option<f64> {
        match self.quantity.open() {
            Open::Above => Some(far.low_95? - seen.high_95?),
            Open::Below => Some(seen.low_95? - far.high_95?),
        }
    }

    /// How many releases the width of the interval of a sample, found with `done`, lets expect; 0 when it is narrow enough or
    /// not yet known.
    pub fn needs(&self, sample: &Sample, done: usize) -> f64 {
        let found = self.percentile(sample);
        let width = found.as_ref().and_then(Self::width_of).filter(|width| *width >= self.width);
        width.map_or(0.0, |width| done as f64 * (width / self.width) * (width / self.width))
    }

    /// How many releases to go on to after `done` that gave a sample; `None` when the interval is narrow enough.
    ///
    /// The width falls with the root of the number; a tenth more spares a last small round. At least a quarter more and
    /// at most four times as many, because the width itself is known by chance only. A function of the values alone: the
    /// same run asks for the same releases on any machine.
    pub fn next(&self, sample: &Sample, done: usize) -> Option<usize> {
        let found = self.percentile(sample);
        let needs = found.as_ref().map_or(0, |percentile| percentile.needs);
        let Some(width) = found.as_ref().and_then(Self::width_of) else {
            return Some((4 * done).max(2 * needs));
        };
        if width < self.width {
            return None;
        }
        let wanted = 1.1 * done as f64 * (width / self.width).powi(2);
        Some((wanted as usize).clamp(done + done.div_ceil(4), 4 * done))
    }
}

impl fmt::Display for TargetPrecision {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{}.p{} < {} {}", self.name, self.percent, self.width, self.unit)
    }
}

impl FromStr for TargetPrecision {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let usage = |found: &str| {
            let names = NAMES.map(|(name, ..)| name).join(", ");
            let percents = PERCENTS.map(|percent| format!("p{percent}")).join(", ");
            format!(
                "found {found}; write for instance \"runout.p95 < 1.0 m\": one of {names}, a point, one of {percents}, <, and the width of the 95 % interval with its unit"
            )
        };
        let (statistic, width) = text.split_once('<').ok_or_else(|| usage("no <"))?;
        let statistic = statistic.trim();
        let (name, percentile) = statistic.split_once('.').ok_or_else(|| usage(statistic))?;
        let &(name, quantity, unit) =
            NAMES.iter().find(|(known, ..)| *known == name).ok_or_else(|| usage(name))?;
        let percent = percentile.strip_prefix('p').and_then(|number| number.parse().ok());
        let percent = percent
            .filter(|percent| PERCENTS.contains(percent))
            .ok_or_else(|| usage(percentile))?;
        let width = width.trim();
        let cut = width.find(char::is_whitespace).unwrap_or(width.len());
        let (number, found) = (&width[..cut], width[cut..].trim());
        let number: f64 = number.parse().map_err(|_| usage(number))?;
        let multiple = MULTIPLES.iter().find(|(word, base, _)| *word == found && *base == unit);
        let times = match multiple {
            Some((.., times)) => *times,
            None if found == unit => 1.0,
            None if found.is_empty() => {
                return Err(format!("found {number} without a unit; {name} is in {unit}"));
            }
            None => return Err(format!("found the unit \"{found}\"; {name} is in {unit}")),
        };
        if !(number > 0.0 && number.is_finite()) {
            return Err(usage(&number.to_string()));
        }
        if number * times < NARROWEST {
            return Err(format!(
                "found {number:e} {found}; write {NARROWEST:e} {unit} or more: no figure on a slope is known so well"
            ));
        }
        Ok(Self { quantity, percent, width: number * times, name, unit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_aim_is_read_as_it_is_written() {
        let target: TargetPrecision = "runout.p95 < 1.0 m".parse().unwrap();
        assert_eq!((target.quantity, target.percent, target.width), (Quantity::Runout, 95, 1.0));
        let target: TargetPrecision = "energy.p99<2.5 kJ".parse().unwrap();
        assert_eq!((target.quantity, target.width), (Quantity::MaxTotal, 2500.0));
        assert_eq!(target.to_string(), "energy.p99 < 2500 J");
        for wrong in [
            "runout.p95",
            "runout < 1 m",
            "runaut.p95 < 1 m",
            "runout.p96 < 1 m",
            "runout.p95 < 1 J",
            "runout.p95 < 1",
            "runout.p95 < -1 m",
            "runout.p95 < NaN m",
            "runout.p95 < 1e-300 m",
        ] {
            let told = wrong.parse::<TargetPrecision>().unwrap_err();
            assert!(told.contains("found"), "{wrong}: {told}");
        }
        let told = "runout.p95 < 1".parse::<TargetPrecision>().unwrap_err();
        assert_eq!(told, "found 1 without a unit; runout is in m");
    }

    /// Evenly spread values: the interval of the median of n is about 2/√n wide, so half the width takes four times as many.
    #[test]
    fn releases_grow_until_the_interval_is_narrow() {
        let target: TargetPrecision = "runout.p50 < 0.02 m".parse().unwrap();
        let values: Vec<f64> = (0..100_000).map(|k| (f64::from(k) * 0.618_034).fract()).collect();
        let first = |count: usize| Sample::of(values[..count].iter().copied());
        let mut done = 100;
        let mut asked = vec![done];
        while let Some(next) = target.next(&first(done), done) {
            assert!(next > done);
            done = next;
            asked.push(done);
        }
        // (2/0.02)² = 10 000, with a tenth more
        assert!((9_000..16_000).contains(&done), "{asked:?}");
        // Too few for any interval at all.
        let far: TargetPrecision = "runout.p99 < 1 m".parse().unwrap();
        assert!(far.next(&first(10), 10).unwrap() >= 2 * 299);
    }
}
