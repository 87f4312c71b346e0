//! Moments, bounds and value stability of the distributions.

#![expect(clippy::float_cmp, reason = "the same stream must give the same bits")]

use super::*;
use crate::random::{Purpose, stream};

const DRAWS: usize = 20_000;

fn read(text: &str) -> Distribution {
    #[derive(serde::Deserialize)]
    struct Holder {
        x: Distribution,
    }
    toml::from_str::<Holder>(&format!("x = {text}")).unwrap().x
}

fn refused(text: &str) -> String {
    #[derive(serde::Deserialize, Debug)]
    struct RefusedHolder {
        #[expect(dead_code, reason = "only its refusal is of interest")]
        x: Distribution,
    }
    toml::from_str::<RefusedHolder>(&format!("x = {text}")).unwrap_err().message().to_owned()
}

/// Every family with its exact mean and standard deviation.
///
/// Truncated normal: standard textbook formulas with a = −1, b = 2 and mean 3, sd 0.5; lognormal
/// (unbounded): median exp(σ²/2) and median exp(σ²/2) sqrt(exp(σ²) − 1).
fn families() -> Vec<(Distribution, f64, f64)> {
    let (phi_a, phi_b) = (0.241_970_724_519_143_37, 0.053_990_966_513_188_06);
    let share = 0.977_249_868_051_820_8 - 0.158_655_253_931_457_05;
    let shift = (phi_a - phi_b) / share;
    let variance = 1.0 + (-phi_a - 2.0 * phi_b) / share - shift * shift;
    vec![
        (read("{ uniform = [2.0, 5.0] }"), 3.5, 3.0 / 12_f64.sqrt()),
        (read("{ normal = { mean = -3.0, sd = 0.5 } }"), -3.0, 0.5),
        (
            read("{ normal = { mean = 3.0, sd = 0.5, min = 2.5, max = 4.0 } }"),
            3.0 + 0.5 * shift,
            0.5 * variance.sqrt(),
        ),
        (
            read("{ lognormal = { median = 0.4, sigma = 0.3 } }"),
            0.4 * 0.045_f64.exp(),
            0.4 * 0.045_f64.exp() * (0.09_f64.exp() - 1.0).sqrt(),
        ),
        (read("{ triangular = [0.0, 1.0, 5.0] }"), 2.0, (21.0_f64 / 18.0).sqrt()),
        (read("{ values = [1, 2, 7], weights = [1, 2, 1] }"), 3.0, 5.5_f64.sqrt()),
    ]
}

fn sample(from: &Distribution) -> Vec<f64> {
    (0..DRAWS).map(|i| from.draw(&mut stream(1, Purpose::Size, i))).collect()
}

/// The mean of n draws has the standard deviation sd/√n, their variance about sd² √(κ−1)/√n with a
/// kurtosis κ below 5 here; five standard deviations leave less than one chance in 10⁵ of failing.
#[test]
fn moments_are_exact_within_sampling_error() {
    for (from, mean, sd) in families() {
        let draws = sample(&from);
        let n = DRAWS as f64;
        let found = draws.iter().sum::<f64>() / n;
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        assert!((found - mean).abs() < 5.0 * sd / n.sqrt(), "{from:?}: mean {found}, not {mean}");
        assert!((variance / (sd * sd) - 1.0).abs() < 10.0 / n.sqrt(), "{from:?}: {variance}");
    }
}

/// No draw leaves the support, and the bounds of a truncation are reached but not piled up on:
/// the share of draws within 2 % of the span of a bound is its probability, not more.
#[test]
fn draws_stay_inside_their_bounds() {
    for (from, ..) in families() {
        let (low, high) = from.support();
        assert!(sample(&from).iter().all(|x| (low..=high).contains(x)), "{from:?}");
    }
    let cut = read("{ normal = { mean = 0.0, sd = 1.0, min = 0.0, max = 1.0 } }");
    let draws = sample(&cut);
    let at_max = draws.iter().filter(|x| **x > 0.98).count() as f64 / DRAWS as f64;
    // density at the bound 0.2420/0.3413 over 0.02, and five standard deviations of a share
    assert!((at_max - 0.02 * 0.716).abs() < 5.0 * (0.0143 / DRAWS as f64).sqrt(), "{at_max}");
}

/// Quantiles invert (the discrete family has none of these quartiles): the share of draws below the quartiles is a quarter, a half, three quarters.
#[test]
fn quantiles_split_the_draws() {
    for (from, ..) in families().into_iter().filter(|(from, ..)| from.support().1 != 7.0) {
        let draws = sample(&from);
        for p in [0.25, 0.5, 0.75] {
            let below = draws.iter().filter(|x| **x < from.quantile(p)).count() as f64;
            let share = below / DRAWS as f64;
            // standard deviation of a share: sqrt(p (1 − p)/n)
            assert!(
                (share - p).abs() < 5.0 * (0.25 / DRAWS as f64).sqrt(),
                "{from:?} {p}: {share}"
            );
        }
    }
}

/// A value far out in either tail keeps its digits: bounds at 4.5 standard deviations.
#[test]
fn far_tails_are_drawn_evenly_from_both_sides() {
    let upper = read("{ normal = { mean = 0.0, sd = 1.0, min = 4.5, max = 4.6 } }");
    let lower = read("{ normal = { mean = 0.0, sd = 1.0, min = -4.6, max = -4.5 } }");
    for p in [0.1, 0.5, 0.9] {
        // mirror images; both are computed in the tail that keeps its digits
        assert!((upper.quantile(p) + lower.quantile(1.0 - p)).abs() < 1e-14);
    }
}

/// One draw takes one word: the second draw is the same whatever the first was drawn from.
#[test]
fn one_draw_takes_one_word() {
    let second = |first: &Distribution| {
        let mut random = stream(3, Purpose::Start, 8);
        first.draw(&mut random);
        unit(&mut random)
    };
    let fixed = second(&Distribution::fixed(1.0).unwrap());
    assert!(families().iter().all(|(from, ..)| second(from) == fixed));
}

#[test]
fn a_weight_of_zero_is_never_drawn() {
    let from = read("{ values = [9.0, 1.0, 9.0], weights = [0, 1, 0] }");
    assert_eq!(from.support(), (1.0, 1.0));
    assert!(sample(&from).iter().all(|x| *x == 1.0));
}

#[test]
fn wrong_distributions_are_refused_with_a_remedy() {
    let cases = [
        ("nan", "write a finite number"),
        ("{ uniform = [2, 1] }", "smaller bound first"),
        ("{ uniform = [1, inf] }", "finite"),
        ("{ normal = { mean = 0, sd = -1 } }", "sd above 0"),
        ("{ normal = { mean = 0, sd = 1, min = 2, max = 1 } }", "min below the max"),
        ("{ normal = { mean = 0, sd = 1, min = nan, max = 1 } }", "min below the max"),
        ("{ normal = { mean = 0, sd = 1, min = 9 } }", "bounds that hold"),
        ("{ lognormal = { median = 0, sigma = 1 } }", "median above 0"),
        ("{ lognormal = { median = 1, sigma = 1, min = -1 } }", "never negative"),
        ("{ triangular = [1, 0, 2] }", "in this order"),
        ("{ values = [] }", "at least one value"),
        ("{ values = [1], weights = [1, 2] }", "one weight for each"),
        ("{ weights = [1, 2] }", "at least one value"),
        ("{ values = [1, 2], weights = [0, 0] }", "at least one above 0"),
        ("{}", "exactly one of"),
        ("{ uniform = [1, 2], triangular = [1, 2, 3] }", "exactly one of"),
        ("{ unifrm = [1, 2] }", "unknown variant `unifrm`"),
        ("{ normal = { mean = 0, sd = 1, mn = 0 } }", "unknown field `mn`"),
        ("'0.4'", "a number or a distribution"),
    ];
    for (text, part) in cases {
        let message = refused(text);
        assert!(message.contains(part), "{text}: {message}");
    }
}
