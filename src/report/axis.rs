//! Ranges of numbers: ticks at steps of 1, 2, 2.5 and 5, linear or logarithmic.

use super::format;
use crate::math;

/// One tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Where.
    pub value: f64,
    /// What stands there; empty for a minor tick.
    pub label: String,
}

/// A range of numbers and what they mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Lower end.
    pub low: f64,
    /// Upper end, above `low`.
    pub high: f64,
    /// Whether steps are factors.
    pub is_log: bool,
    /// Name with unit.
    pub title: String,
}

impl Axis {
    /// A linear axis; an empty or impossible range is widened until it can be drawn.
    pub fn linear(low: f64, high: f64, title: impl Into<String>) -> Self {
        let (low, high) = widened(low, high);
        Self { low, high, is_log: false, title: title.into() }
    }

    /// A logarithmic axis over whole decades. Ends that are not positive are raised to 10⁻⁶ of the upper one.
    pub fn log(low: f64, high: f64, title: impl Into<String>) -> Self {
        let high = if high.is_finite() && high > 0.0 { high } else { 1.0 };
        let low = if low.is_finite() && low > 0.0 { low.min(high) } else { 1e-6 * high };
        let (down, up) = (math::log10(low) + 1e-9, math::log10(high) - 1e-9);
        let (down, up) = (down.floor(), up.ceil().max(down.floor() + 1.0));
        Self {
            low: math::pow(10f64, down),
            high: math::pow(10f64, up),
            is_log: true,
            title: title.into(),
        }
    }

    /// A logarithmic axis that ends at 1, 2 or 5 times a power of ten.
    pub fn ratios(low: f64, high: f64, title: impl Into<String>) -> Self {
        let whole = Self::log(low, high, title);
        let within = |value: f64| (whole.low..=whole.high).contains(&value);
        let below = [5.0, 2.0, 1.0].map(|step| round_down(low, step)).into_iter();
        let below = below.filter(|v| v.is_finite() && *v > 0.0).fold(whole.low, f64::max);
        let above = round_step(high, &[1.0, 2.0, 5.0]);
        let (low, high) = (below.max(whole.low), if within(above) { above } else { whole.high });
        if high > 1.5 * low { Self { low, high, ..whole } } else { whole }
    }

    /// A linear axis from 0 (or a negative least value) to a round number not below the largest of `values`.
    pub fn from_zero(values: impl IntoIterator<Item = f64>, title: impl Into<String>) -> Self {
        let finite = values.into_iter().filter(|v| v.is_finite());
        let (low, high) = finite.fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        let (low, high) = if high > low { (low, high) } else { (low, low + 1.0) };
        let step = nice_step((high - low) / 8.0);
        Self::linear((low / step).floor() * step, (high / step).ceil() * step, title)
    }

    /// An axis for energies: logarithmic over those above 0 where they spread over more than 30 times, else from 0.
    pub fn energies(values: impl IntoIterator<Item = f64>, title: impl Into<String>) -> Self {
        Self::energies_beside(values, f64::NAN, title)
    }

    /// The same with a limit beside the values: the axis holds both, however far the limit is from them.
    pub fn energies_beside(
        values: impl IntoIterator<Item = f64>,
        limit: f64,
        title: impl Into<String>,
    ) -> Self {
        let is_shown = |value: &f64| value.is_finite() && *value > 0.0;
        let limit = Some(limit).filter(is_shown);
        let some: Vec<f64> = values.into_iter().filter(is_shown).collect();
        let largest = some.iter().copied().reduce(f64::max);
        // what is a ten-thousandth of the largest needs no room
        let weakest = some.iter().copied().reduce(f64::min);
        let weakest = weakest.zip(largest).map(|(least, most)| least.max(1e-4 * most));
        let least = weakest.into_iter().chain(limit).reduce(f64::min).unwrap_or(1.0);
        let most = largest.into_iter().chain(limit).reduce(f64::max).unwrap_or(1.0);
        if most > 30.0 * least {
            Self::ratios(least, most, title)
        } else {
            Self::from_zero(some.into_iter().chain(limit), title)
        }
    }

    /// Where a value lies: 0 at the lower end, 1 at the upper.
    pub fn share(&self, value: f64) -> f64 {
        if self.is_log {
            (math::log10(value) - math::log10(self.low))
                / (math::log10(self.high) - math::log10(self.low))
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// About `count` labelled ticks.
    pub fn ticks(&self, count: usize) -> Vec<Tick> {
        if self.is_log { self.log_ticks(count) } else { self.linear_ticks(count) }
    }

    fn linear_ticks(&self, count: usize) -> Vec<Tick> {
        let step = nice_step((self.high - self.low) / count.max(1) as f64);
        let (first, last) = ((self.low / step - 1e-6).ceil(), (self.high / step + 1e-6).floor());
        let how_many = (last - first).max(0.0) as usize;
        let values: Vec<f64> = (0..=how_many.min(100)).map(|i| (first + i as f64) * step).collect();
        let label = labeller(&values, step);
        values.into_iter().map(|value| Tick { value, label: label(value) }).collect()
    }

    fn log_ticks(&self, count: usize) -> Vec<Tick> {
        let down = (math::log10(self.low) + 1e-9).floor() as i32;
        let up = (math::log10(self.high) - 1e-9).ceil() as i32;
        let every = (f64::from(up - down) / count.max(1) as f64).ceil().max(1.0) as i32;
        // numbers that a reader knows stand as they are
        let is_plain = down >= -4 && up <= 5;
        let label = |value: f64, exponent: i32| {
            if is_plain {
                format::plain(math::rounded(value, 1))
            } else {
                format::power_of_ten(exponent)
            }
        };
        // within two decades their halves and doubles are named too
        let is_short = is_plain && self.high < 101.0 * self.low && count >= 4;
        let mut ticks = Vec::new();
        for exponent in down..=up {
            let value = |m: i32| match exponent {
                // a quotient is the double nearest to the decimal number
                e if e < 0 => f64::from(m) / 10f64.powi(-e),
                e => f64::from(m) * 10f64.powi(e),
            };
            let is_labelled = (exponent - down) % every == 0;
            let text = if is_labelled { label(value(1), exponent) } else { String::new() };
            ticks.push(Tick { value: value(1), label: text });
            if exponent < up && every == 1 {
                ticks.extend((2..10).map(|m| {
                    let is_named = is_short && (m == 2 || m == 5);
                    let label = if is_named { label(value(m), exponent) } else { String::new() };
                    Tick { value: value(m), label }
                }));
            }
        }
        let (low, high) = (self.low * (1.0 - 1e-9), self.high * (1.0 + 1e-9));
        ticks.retain(|tick| (low..=high).contains(&tick.value));
        ticks
    }
}

/// The same range when it can be drawn, else one round it.
fn widened(low: f64, high: f64) -> (f64, f64) {
    match (low.is_finite(), high.is_finite()) {
        (true, true) if high - low > 1e-9 * low.abs().max(high.abs()) => (low, high),
        (true, _) => {
            let half = 0.05 * low.abs().clamp(1.0, 20.0);
            let half = half.max(1e-6 * low.abs());
            (low - half, low + half)
        }
        (false, true) => widened(high, high),
        (false, false) => (0.0, 1.0),
    }
}

/// The largest `step` times a power of ten that is not above a positive value.
fn round_down(value: f64, step: f64) -> f64 {
    step * math::pow(10.0, (math::log10(value / step) + 1e-9).floor())
}

/// The smallest of 1, 2, 2.5, 5 times a power of ten that is not below `rough`.
pub fn nice_step(rough: f64) -> f64 {
    round_step(rough, &[1.0, 2.0, 2.5, 5.0])
}

/// The smallest of some mantissas (1 first, rising) times a power of ten that is not below `rough`; 1 when that has no sense.
pub fn round_step(rough: f64, mantissas: &[f64]) -> f64 {
    if !(rough.is_finite() && rough > 0.0) {
        return 1.0;
    }
    let exponent = math::log10(rough).floor() as i32;
    // a negative power as a quotient: 25 / 1000 is the double nearest to 0.025, 25 · 0.001 is not
    let scaled = |mantissa: f64| match exponent {
        e if e < 0 => mantissa / 10f64.powi(-e),
        e => mantissa * 10f64.powi(e),
    };
    let nice = mantissas.iter().copied().map(scaled).find(|&s| rough <= s * (1.0 + 1e-9));
    nice.unwrap_or(scaled(10.0))
}

/// Writes all ticks of an axis with the same decimals, or as powers of ten where they would be long.
fn labeller(values: &[f64], step: f64) -> impl Fn(f64) -> String + use<> {
    let largest = values.iter().fold(step, |m, v| m.max(v.abs()));
    let (exponent, has_half) = exponent_of(step);
    let decimals = (i32::from(has_half) - exponent).max(0) as usize;
    let is_long = decimals > 4 || largest >= 1e9;
    let mantissa = (exponent_of(largest).0 - exponent).max(0) as usize + usize::from(has_half);
    move |value| match value {
        v if v.abs() < 1e-9 * step => format::decimal(0.0, if is_long { 0 } else { decimals }),
        v if is_long => format::scientific(v, mantissa),
        v => format::decimal(v, decimals),
    }
}

/// Power of ten of a positive number, and whether its mantissa needs a decimal (2.5).
fn exponent_of(value: f64) -> (i32, bool) {
    let text = format!("{value:.1e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    (exponent.parse().unwrap_or(0), !mantissa.ends_with(".0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, count: usize) -> Vec<String> {
        Axis::linear(low, high, "").ticks(count).into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn ticks_are_round_and_short() {
        assert_eq!(labels(0.0, 10.0, 5), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(0.0, 1.0, 4), ["0.00", "0.25", "0.50", "0.75", "1.00"]);
        assert_eq!(labels(-1.0, 1.0, 4), ["\u{2212}1.0", "\u{2212}0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(0.0, 3e-5, 3), ["0", "10⁻⁵", "2×10⁻⁵", "3×10⁻⁵"]);
        assert_eq!(
            labels(2_600_000.0, 2_600_100.0, 2),
            ["2\u{2009}600\u{2009}000", "2\u{2009}600\u{2009}050", "2\u{2009}600\u{2009}100"]
        );
        assert_eq!(labels(2_600_000.0, 2_600_000.5, 2)[1], "2\u{2009}600\u{2009}000.25");
    }

    #[test]
    fn a_range_without_extent_is_still_an_axis() {
        for (low, high) in
            [(3.0, 3.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (2.6e6, 2.6e6), (5.0, 1.0)]
        {
            let axis = Axis::linear(low, high, "");
            assert!(
                axis.high > axis.low && axis.low.is_finite() && axis.high.is_finite(),
                "{low} {high}"
            );
            assert!(!axis.ticks(5).is_empty(), "{low} {high}");
        }
        let axis = Axis::log(0.0, 0.0, "");
        assert!(axis.high > axis.low && axis.low > 0.0);
    }

    /// A barrier that takes far more than any rock has, or far less, leaves the rocks on the axis.
    #[test]
    fn a_limit_far_from_the_energies_keeps_them_on_the_axis() {
        for limit in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
            let axis = Axis::energies_beside([3.0, 40.0, 900.0], limit, "");
            let is_held = |value: f64| (axis.low..=axis.high).contains(&value);
            assert!([3.0, 900.0, limit].into_iter().all(is_held), "{limit}: {axis:?}");
        }
        // the weakest of the rocks alone may stay out
        assert!(Axis::energies([1e-9, 900.0], "").low > 1e-3);
    }

    #[test]
    fn a_decade_is_labelled_with_its_power() {
        let ticks = Axis::log(1e-5, 1.0, "").ticks(8);
        assert_eq!(ticks[0].label, "10⁻⁵");
        assert!((Axis::log(1e-3, 1.0, "").share(1e-1) - 2.0 / 3.0).abs() < 1e-12);
    }
}
