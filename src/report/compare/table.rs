//! Statistics of both runs and their differences, row by row.

use super::bounds::{self, RunBound};
use super::populations::{ComparedQuantity, CountedShare, Population};
use crate::hazard::{Difference, Reading, Values};
use crate::math;
use crate::report::bound::Is;
use crate::report::format::{self, Toward, sign};
use crate::report::words::{Words, fill};
use crate::scene::Language;
use std::fmt::Write as _;

/// Percentiles that are compared (per cent).
const PERCENTS: [u8; 4] = [50, 90, 95, 99];
/// Place beyond which no difference is written (power of ten).
const FINEST_PLACE: f64 = -9.0;

/// What is said of a difference that rocks that would have gone on may have turned either way.
pub(super) const LEFT_OPEN: &str = "left open";

/// All statistics of one population.
#[derive(Debug, Clone)]
pub(super) struct Group {
    /// Heading.
    pub(super) name: String,
    pub(super) rows: Vec<ComparedStatistic>,
    /// Whether it is of what the barriers of each run have let through.
    is_behind: bool,
}

/// Stands beside percentiles of what barriers have let through.
const OF_FEWER: &str = "Energies and heights are of the {a} rocks of A and the {b} of B that arrive: barriers let the strongest through, so that percentiles may rise while fewer rocks come.";

impl Group {
    /// That its percentiles are of fewer rocks, where a run has barriers that let fewer through.
    pub(super) fn of_fewer(&self) -> Option<String> {
        let row = self.rows.iter().find(|row| row.is_of_arriving())?;
        let [a, b] = row.rocks;
        let counts = [("a", &a as &dyn std::fmt::Display), ("b", &b)];
        (self.is_behind && a != b).then(|| fill(OF_FEWER, &counts))
    }
}

/// One statistic.
#[derive(Debug, Clone)]
pub(super) struct ComparedStatistic {
    pub(super) name: String,
    pub(super) unit: &'static str,
    /// Rocks that it is of, in each run.
    pub(super) rocks: [usize; 2],
    /// In the unit of the row.
    pub(super) difference: Difference,
    /// Whether the number of each run is a bound.
    pub(super) bounds: [Is; 2],
    /// Whether it is of those that a designer asks for first.
    pub(super) is_headline: bool,
}

impl ComparedStatistic {
    /// Without the numbers that a run has too few rocks for, as its report has none, and without a difference from them.
    fn without_lacking(self) -> Self {
        let is_lacking = self.bounds.map(|is| matches!(is, Is::Lacking(_)));
        if is_lacking == [false; 2] {
            return self;
        }
        let Difference { a, b, .. } = self.difference;
        let [a, b] = [(a, is_lacking[0]), (b, is_lacking[1])]
            .map(|(value, is_lacking)| if is_lacking { f64::NAN } else { value });
        Self { difference: Difference { a, b, value: f64::NAN, interval: None }, ..self }
    }

    /// Whether it is of the rocks that come, and not of how many do.
    fn is_of_arriving(&self) -> bool {
        !["%", "1/year"].contains(&self.unit)
    }

    /// Its name in another language: what, and which statistic of it.
    pub(super) fn name_in(&self, words: &Words) -> String {
        match self.name.rsplit_once(", ") {
            Some((what, "mean")) => format!("{}, {}", words.say(what), words.mean),
            Some((what, percentile)) => format!("{}, {percentile}", words.say(what)),
            None => words.say(&self.name),
        }
    }
}

/// Compares all statistics of a population of two runs.
pub(super) fn group([a, b]: &[Population; 2], paired: bool, same_run: bool) -> Group {
    // what is no difference by more than rounding is none, and of one run beside itself nothing is left open
    let settled = |one: Difference, bounds: [RunBound; 2]| {
        if same_run { one.of_one_run() } else { bounds::opened(one.without_rounding(), bounds) }
    };
    let mut rows = Vec::new();
    for (one, other) in a.shares.iter().zip(&b.shares) {
        let row = |name: &str, unit: &'static str, found: (Difference, [f64; 2])| {
            let bounds = [(one, found.1[0]), (other, found.1[1])];
            let bounds = bounds.map(|(share, most)| RunBound::of_share(share, most));
            ComparedStatistic {
                name: name.to_owned(),
                unit,
                rocks: [one.releases.len(), other.releases.len()],
                difference: settled(found.0, bounds),
                bounds: bounds.map(|bound| bound.is),
                is_headline: true,
            }
        };
        let share = scaled(of_shares(one, other, paired), 0.01);
        rows.push(row(&one.name, "%", (share, [100.0; 2])));
        let per_year = passages(one, other, paired);
        rows.extend(per_year.map(|rate| row("Passages", "1/year", rate)));
    }
    for ((measure, one), (_, other)) in a.values.iter().zip(&b.values) {
        let all = of_measure(*measure, [(a, one), (b, other)], paired).into_iter();
        rows.extend(all.map(|(row, bounds)| {
            let difference = settled(row.difference, bounds);
            let bounds = bounds.map(|bound| bound.is);
            ComparedStatistic { difference, bounds, ..row }.without_lacking()
        }));
    }
    // what neither run has seen is no news
    rows.retain(|row| row.rocks != [0, 0]);
    Group { name: a.name.clone(), rows, is_behind: a.is_behind_barriers }
}

/// How a share changes (–).
fn of_shares(one: &CountedShare, other: &CountedShare, paired: bool) -> Difference {
    if let (Some(a), Some(b)) = (one.weighted(), other.weighted()) {
        return Difference::of_weighted_shares(&a, &b, paired);
    }
    let [a, b] = [one, other].map(|of| (&of.releases[..], of.among.releases.len()));
    Difference::of_shares(a, b, paired)
}

/// How their number a year changes (1/year), and all events of each run in a year.
fn passages(
    one: &CountedShare,
    other: &CountedShare,
    paired: bool,
) -> Option<(Difference, [f64; 2])> {
    let (one, other) = (one.in_a_year()?, other.in_a_year()?);
    let most = [&one, &other].map(|of| of.weights.total_per_year());
    Some((Difference::of_rates(&one, &other, paired), most))
}

fn scaled(one: Difference, size: f64) -> Difference {
    Difference {
        a: one.a / size,
        b: one.b / size,
        value: one.value / size,
        interval: one.interval.map(|(low, high)| (low / size, high / size)),
    }
}

/// Mean and percentiles of one quantity, with what is open of each.
fn of_measure(
    measure: ComparedQuantity,
    values: [(&Population, &Values); 2],
    paired: bool,
) -> Vec<(ComparedStatistic, [RunBound; 2])> {
    let (name, unit, size) = measure.words();
    let row = |what: String, is_headline: bool, p: Option<f64>| {
        let read = |(of, values): (&Population, &Values)| -> Option<Reading> {
            p.map_or_else(|| of.mean(values), |p| of.percentile(values, p))
        };
        let [a, b] = values.map(read);
        let (a, b) = (a?.times(1.0 / size), b?.times(1.0 / size));
        let found = ComparedStatistic {
            name: format!("{name}, {what}"),
            unit,
            rocks: [a.rocks, b.rocks],
            difference: Difference::between(&a, &b, paired),
            bounds: [Is::Value; 2],
            is_headline,
        };
        Some((found, values.map(|of| RunBound::of_statistic(of, measure, p))))
    };
    let mean = row("mean".to_owned(), measure.is_count(), None);
    let percents = PERCENTS.iter().filter(|_| !measure.is_count()).filter_map(|&percent| {
        row(format!("P{percent}"), percent == 95, Some(f64::from(percent) / 100.0))
    });
    mean.into_iter().chain(percents).collect()
}

/// All rows with full precision, in the units of the rows.
pub(super) fn csv(groups: &[Group], paired: bool) -> String {
    let mut text =
        "group,statistic,unit,rocks_a,rocks_b,a,b,difference,low_95,high_95,paired,bound_a,bound_b\n".to_owned();
    let quoted = |words: &str| format!("\"{}\"", words.replace('"', "\"\""));
    for group in groups {
        for row in &group.rows {
            let Difference { a, b, value, interval } = row.difference;
            let (low, high) = interval.unwrap_or((f64::NAN, f64::NAN));
            let (name, unit) = (quoted(&row.name), row.unit);
            // writing to a string cannot fail
            let _ = writeln!(
                text,
                "{},{name},{unit},{},{},{a},{b},{value},{low},{high},{paired},{},{}",
                quoted(&group.name),
                row.rocks[0],
                row.rocks[1],
                bounds::written(row.bounds[0]),
                bounds::written(row.bounds[1])
            );
        }
    }
    text
}

/// The first rows of each group, in columns for a terminal.
pub(super) fn headline(groups: &[Group]) -> Vec<String> {
    let mut lines = Vec::new();
    for group in groups {
        let rows: Vec<&ComparedStatistic> =
            group.rows.iter().filter(|row| row.is_headline).collect();
        if rows.is_empty() {
            continue;
        }
        lines.push(group.name.clone());
        let width = rows.iter().map(|row| row.name.chars().count()).max().unwrap_or(0);
        for row in rows {
            let english = Words::of(Language::En);
            let [a, b, change, interval] = in_words(row, english);
            let clear = if row.difference.is_clear() { "  clear" } else { "" };
            let [few, many] = [row.rocks[1], row.rocks[0]];
            let is_other = group.is_behind && row.is_of_arriving() && few != many;
            let of = if is_other { format!(", of {few} rocks for {many}") } else { String::new() };
            let gap = if row.unit.is_empty() { "" } else { " " };
            lines.push(format!(
                "  {:<width$}  {a} → {b}{gap}{}, {change} ({interval}){clear}{of}",
                row.name, row.unit
            ));
        }
    }
    lines
}

/// A value beside a difference that is known so well: no digit beyond a twentieth of that interval, but at least two; four alone.
fn told(value: f64, interval: Option<(f64, f64)>) -> String {
    let width = interval.map_or(f64::NAN, |(low, high)| high - low);
    if value == 0.0 || !value.is_finite() {
        return format::significant(value, 4);
    }
    if !(width.is_finite() && width > 0.0) {
        return format::to_digits(value, 4);
    }
    let digits = math::log10(value.abs()).floor() - math::log10(0.05 * width).floor() + 1.0;
    format::to_digits(value, digits.clamp(2.0, 6.0) as usize)
}

/// Text of a number with its sign, also where it is positive; nothing stands before a zero.
fn signed(value: f64, text: String) -> String {
    let is_zero = !text.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    if value > 0.0 && !is_zero { format!("+{text}") } else { text }
}

/// A change (–) in per cent with its sign.
pub(super) fn signed_percent(share: f64, decimals: usize) -> String {
    signed(share, format::percent(share, decimals))
}

/// Both values, the difference with its sign, and its interval; bounds with theirs.
pub(super) fn in_words(row: &ComparedStatistic, words: &Words) -> [String; 4] {
    let Difference { a, b, value, interval } = row.difference;
    let number = |v: f64, is: Is| match is {
        Is::Lacking(rocks) => format!("{} ({})", format::NO_NUMBER, words.more_rocks(rocks)),
        is => sign(is).to_owned() + &told(v, row.difference.interval),
    };
    // a difference is written as finely as its interval allows: its last digit is at most a twentieth of it
    let ends = interval.map(|(low, high)| [low, high]);
    let ends = ends.map(|ends| ends.map(|end| if end.is_finite() { end } else { value }));
    let finest = ends.map_or(0.0, |[low, high]| 0.05 * (high - low));
    let largest = ends.map_or(value.abs(), |[low, high]| low.abs().max(high.abs()));
    let last = match finest {
        fine if fine > 0.0 => math::log10(fine).floor(),
        _ if largest > 0.0 => math::log10(largest).floor() - 3.0,
        _ => 0.0,
    };
    // what is clear is not told with an end at zero, as far as two digits more tell it
    let nearest = interval.map_or(0.0, |(low, high)| low.abs().min(high.abs()));
    let is_told = !row.difference.is_clear() || nearest >= math::pow(10.0, last);
    let last = if is_told { last } else { math::log10(nearest).floor().max(last - 2.0) };
    let last = last.max(FINEST_PLACE);
    let number_of = |v: f64| signed(v, format::rounded_at(v, last));
    let end = |v: f64, toward: Toward| match v.is_finite() {
        true if finest > 0.0 => number_of(toward.at_place(v, last as i32)),
        true => number_of(v),
        false => format::NO_NUMBER.to_owned(),
    };
    let interval = match interval {
        None => words.no_interval.to_owned(),
        Some((low, high)) if low.is_infinite() && high.is_infinite() => words.say(LEFT_OPEN),
        Some((low, high)) => words.interval(&end(low, Toward::Below), &end(high, Toward::Above)),
    };
    let change = sign(bounds::of_difference(row.bounds)).to_owned() + &number_of(value);
    [number(a, row.bounds[0]), number(b, row.bounds[1]), change, interval]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is known to a hundred thousand is not told to ones.
    #[test]
    fn large_differences_have_no_more_digits_than_their_interval_leaves() {
        let said = |[a, b, low, high]: [f64; 4]| {
            let row = ComparedStatistic {
                name: "Largest total energy, P95".to_owned(),
                unit: "kJ",
                rocks: [1000; 2],
                difference: Difference { a, b, value: b - a, interval: Some((low, high)) },
                bounds: [Is::Value; 2],
                is_headline: true,
            };
            let [_, _, change, interval] = in_words(&row, Words::of(Language::En));
            format!("{change} ({interval})").replace('\u{2009}', " ").replace('\u{2212}', "-")
        };
        let found = said([769_450.0, 0.0148, -969_630.4, -602_087.1]);
        assert_eq!(found, "-770 000 (-970 000 to -600 000)");
        assert_eq!(said([100.0, 103.2, -1.4, 8.1]), "+3.2 (-1.4 to +8.1)");
        assert_eq!(said([5000.0, 5321.0, 210.0, 432.0]), "+320 (+210 to +440)");
    }
}
