//! Statistics against numbers computed by hand, by exact fractions, or printed in the literature.

use crate::made;

use chacha20::ChaCha8Rng;
use made::{fall, info};
use rand::{RngExt, SeedableRng};
use rockfall::hazard::{
    CrossingRow, Hazard, Line, Open, Proportion, Quantity, Ranks, Row, Sample, StopKind, Totals,
};

fn ranks(n: usize, p: f64) -> (Option<usize>, Option<usize>, Option<usize>) {
    let Ranks { low, high, upper } = Ranks::of(n, p);
    (low, high, upper)
}

/// Computed with exact fractions from the definition. The first two are also in every table of the sign test
/// (ranks 2 and 9 of 10, 6 and 15 of 20 for the median).
#[test]
fn ranks_are_those_of_the_exact_binomial_sum() {
    for (n, p, expected) in [
        (10, 0.5, (Some(2), Some(9), Some(9))),
        (20, 0.5, (Some(6), Some(15), Some(15))),
        (100, 0.5, (Some(40), Some(61), Some(59))),
        (100, 0.9, (Some(84), Some(96), Some(96))),
        (1000, 0.9, (Some(881), Some(919), Some(916))),
        (1000, 0.95, (Some(936), Some(964), Some(962))),
        (1000, 0.98, (Some(971), Some(989), Some(988))),
        (1000, 0.99, (Some(983), Some(997), Some(996))),
    ] {
        assert_eq!(ranks(n, p), expected, "percentile {p} of {n}");
    }
}

/// 0.95⁵⁹ < 0.05 < 0.95⁵⁸ and 0.99²⁹⁹ < 0.05 < 0.99²⁹⁸; two-sided the largest of 72 bounds P95, of 71 not.
#[test]
fn too_few_rocks_give_no_bound() {
    assert_eq!(ranks(58, 0.95), (Some(51), None, None));
    assert_eq!(ranks(59, 0.95), (Some(52), None, Some(59)));
    assert_eq!(ranks(71, 0.95).1, None);
    assert_eq!(ranks(72, 0.95), (Some(64), Some(72), Some(72)));
    assert_eq!(ranks(298, 0.99).2, None);
    assert_eq!(ranks(299, 0.99).2, Some(299));
    assert_eq!(ranks(0, 0.5), (None, None, None));
    assert_eq!(ranks(1, 0.5), (None, None, None));
    let needs = |p| Sample::of([1.0]).percentile(p).unwrap().needs;
    assert_eq!((needs(0.95), needs(0.99)), (59, 299));
}

/// Among many rocks the binomial is normal: the ranks lie at n p ± 1.96 √(n p (1 − p)), to within one rank and
/// the skewness (below one rank here).
#[test]
fn ranks_of_a_million_follow_the_normal_law() {
    let (n, p) = (1_000_000, 0.95);
    let (middle, half) = (950_000.0, 1.959_964 * (47_500_f64).sqrt());
    let (low, high, _) = ranks(n, p);
    assert!((low.unwrap() as f64 - (middle - half)).abs() < 2.0);
    assert!((high.unwrap() as f64 - (middle + half)).abs() < 2.0);
}

/// An interval that holds in at least 95 % of all samples may miss at most 5 % of them, here of 4000: with
/// a standard error of 0.35 % the miss rate stays below 6.1 % (three of them).
#[test]
fn intervals_hold_as_often_as_they_say() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (repeats, p) = (4000, 0.9);
    let misses = (0..repeats)
        .filter(|_| {
            let sample = Sample::of((0..100).map(|_| random.random::<f64>()));
            let found = sample.percentile(p).unwrap();
            !(found.low_95.unwrap()..=found.high_95.unwrap()).contains(&p)
        })
        .count();
    assert!(misses as f64 / f64::from(repeats) < 0.061, "{misses} of {repeats}");
}

/// Linear between neighbours, as `numpy.percentile([1, 2, 4, 8, 16], [50, 90, 95])` gives 4, 12.8, 14.4.
#[test]
fn percentiles_are_those_of_a_spreadsheet() {
    let sample = Sample::of([16.0, 1.0, 8.0, f64::NAN, 2.0, 4.0]);
    for (p, expected) in [(0.5, 4.0), (0.9, 12.8), (0.95, 14.4)] {
        let found = sample.percentile(p).unwrap().value;
        // one rounding of the place and one of the value
        assert!((found - expected).abs() < 1e-14 * expected * 2.0, "{found}");
    }
    assert!(Sample::of([]).percentile(0.5).is_none());
    assert!((Sample::of([7.0]).percentile(0.99).unwrap().value - 7.0).abs() < f64::EPSILON);
}

/// Of 1, 2, 3, 4: mean 2.5, s² = 5/3, half width 3.182446 √(5/12) = 2.054260 with Student's three degrees of freedom, told to 0.2 %.
#[test]
fn the_mean_has_students_interval() {
    let mean = Sample::of([4.0, 3.0, 2.0, 1.0]).mean().unwrap();
    assert!((mean.value - 2.5).abs() < 1e-15);
    assert!((mean.high_95.unwrap() - 4.554_260).abs() < 4e-3);
    assert!((mean.low_95.unwrap() - 0.445_740).abs() < 4e-3);
    // of two, 12.7062 times the half of their difference
    let two = Sample::of([3.0, 1.0]).mean().unwrap();
    assert!((two.high_95.unwrap() - 14.706_205).abs() < 1e-5);
    assert!(Sample::of([1.0]).mean().unwrap().low_95.is_none());
    assert!(Sample::of([]).mean().is_none());
}

/// Newcombe, Statistics in Medicine 17 (1998), table I, method 5 (Clopper and Pearson), to the printed digits.
#[test]
fn shares_have_the_intervals_of_clopper_and_pearson() {
    for (count, of, low, high) in
        [(81, 263, 0.2527, 0.3676), (15, 148, 0.0578, 0.1617), (1, 29, 0.0009, 0.1776)]
    {
        let share = Proportion::new(count, of);
        assert!(
            (share.low_95 - low).abs() < 5e-5 && (share.high_95 - high).abs() < 5e-5,
            "{share:?}"
        );
    }
}

/// None among n: below 1 − 0.05^(1/n), with which none is seen in 5 % of all samples; all of n: above 0.05^(1/n); nothing known: 0..1.
#[test]
fn none_and_all_have_the_exact_one_sided_bound() {
    let ends = |count, of| {
        let Proportion { low_95, high_95, .. } = Proportion::new(count, of);
        (low_95, high_95)
    };
    for of in [1_usize, 2, 3, 30, 1000] {
        let (low, high) = ends(0, of);
        assert!(
            low == 0.0 && ((1.0 - high).powf(of as f64) - 0.05).abs() < 1e-12,
            "{high} of {of}"
        );
        let (low, high) = ends(of, of);
        assert!(
            (high - 1.0).abs() < 1e-12 && (low.powf(of as f64) - 0.05).abs() < 1e-12,
            "{low} of {of}"
        );
    }
    assert_eq!(ends(0, 0), (0.0, 1.0));
}

/// The curve falls, its band encloses it, and at 5 % it is the 95th percentile of the table.
#[test]
fn the_exceedance_curve_passes_through_the_percentiles() {
    let sample = Sample::of((0..1000).map(|rank| f64::from(rank).sqrt()));
    let curve = sample.exceedance();
    for pair in curve.windows(2) {
        assert!(pair[1].share < pair[0].share && pair[1].value >= pair[0].value);
    }
    for point in &curve {
        assert!(point.low_95.is_none_or(|low| low <= point.value));
        assert!(point.high_95.is_none_or(|high| high >= point.value));
    }
    let last = curve.last().unwrap();
    assert!(last.share >= 1e-3 && last.share < 1.3e-3 && last.high_95.is_none());
    let five = curve.iter().find(|point| (point.share - 0.05).abs() < 1e-15).unwrap();
    let p95 = sample.percentile(0.95).unwrap();
    assert_eq!((five.value, five.low_95, five.high_95), (p95.value, p95.low_95, p95.high_95));
}

/// Every value falls into exactly one bar, on round edges.
#[test]
fn a_histogram_counts_every_value_once() {
    let sample = Sample::of((0..1000).map(|rank| 0.1 * f64::from(rank)));
    let bars = sample.histogram().unwrap();
    // 2 · 49.95 / 10 = 9.99, rounded up to 10
    assert_eq!(bars.edges, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0]);
    assert_eq!(bars.counts, [100; 10]);
    assert!(Sample::of([]).histogram().is_none());
    for values in
        [vec![5.0], vec![0.0; 9], vec![-1e300, 1e300], vec![0.3, 0.7, 1e9], vec![-3.0, -1.0]]
    {
        let n = values.len();
        let bars = Sample::of(values).histogram().unwrap();
        assert_eq!(bars.counts.iter().sum::<usize>(), n);
        assert_eq!(bars.edges.len(), bars.counts.len() + 1);
        assert!(bars.counts.len() <= 62, "{}", bars.counts.len());
    }
}

/// Three rocks by hand: two at rest with runouts 30 and 50 m, one that left the terrain at 40 m.
#[test]
fn three_rocks_by_hand() {
    let mut hazard = Hazard::default();
    let row = Row::of(&fall(1), info(1).origin_m);
    for (index, stop, runout_m) in
        [(0, StopKind::AtRest, 30.0), (1, StopKind::LeftTerrain, 40.0), (2, StopKind::AtRest, 50.0)]
    {
        hazard.add(&Row { index, stop, runout_m, energy_balance_error: 1e-9, ..row });
    }
    let runout = hazard.statistic(Quantity::Runout);
    assert_eq!((runout.rocks, runout.max.unwrap().release), (3, 2));
    assert!((runout.mean.unwrap().value - 40.0).abs() < 1e-14 * 40.0);
    assert!((runout.percentiles["p50"].value - 40.0).abs() < 1e-14 * 40.0);
    assert!((runout.percentiles["p90"].value - 48.0).abs() < 1e-14 * 48.0); // place 1.8: 40 + 0.8 · 10
    assert_eq!(
        runout.too_few,
        "3 rocks give no upper bound with 95 % confidence: p50 needs 5, p90 needs 29, p95 needs 59, p98 needs 149, p99 needs 299"
    );
    assert_eq!(hazard.ended(StopKind::AtRest), Proportion::new(2, 3));
    assert_eq!(hazard.largest_balance_error().unwrap().release, 0);
}

/// A hundred rocks with runouts 1 to 100 m, the twenty longest of which left the terrain: whatever they would have run
/// beyond, the median stays (40th to 61st value), P90 is at least what was seen, and nothing bounds it from above. With
/// the reach angle it is the other way round: there those rocks lie at the low end.
#[test]
fn rocks_that_left_the_terrain_leave_the_far_end_open() {
    let mut hazard = Hazard::default();
    let row = Row::of(&fall(1), info(1).origin_m);
    for index in 1..=100 {
        let stop = if index > 80 { StopKind::LeftTerrain } else { StopKind::AtRest };
        let (runout_m, reach_angle_deg) = (index as f64, 101.0 - index as f64);
        hazard.add(&Row { index, stop, runout_m, reach_angle_deg, max_speed_m_s: runout_m, ..row });
    }
    let runout = hazard.sample(Quantity::Runout);
    let median = runout.percentile(0.5).unwrap();
    assert_eq!((median.low_95, median.high_95, median.censored), (Some(40.0), Some(61.0), false));
    let p90 = runout.percentile(0.9).unwrap();
    assert!(p90.censored && p90.high_95.is_none() && p90.upper_95.is_none());
    assert_eq!(p90.low_95, Some(84.0));
    assert!((p90.value - 90.1).abs() < 1e-12);
    let angle = hazard.sample(Quantity::ReachAngle).percentile(0.1).unwrap();
    assert!(angle.censored && angle.low_95.is_none() && angle.high_95.is_some());
    assert!(runout.mean().unwrap().high_95.is_none() && runout.bounds() == 20);
    // a largest speed is that on the terrain given
    assert!(!hazard.sample(Quantity::MaxSpeed).percentile(0.9).unwrap().censored);
    // the curve passes the median and ends where the twenty decide
    let curve = runout.exceedance();
    let open: Vec<bool> = curve.iter().map(|at| at.censored).collect();
    let first = open.iter().position(|is_open| *is_open).unwrap();
    assert!(open[first..].iter().all(|is_open| *is_open) && curve[first].share < 0.3);
    assert!(curve[first].value <= 81.0, "{}", curve[first].value);
}

/// A rock whose time was up, or that failed, might have become faster on the same terrain: its largest speed is a lower bound, as its
/// runout is. One that left the terrain has had its largest speed there.
#[test]
fn largest_values_of_rocks_that_were_stopped_too_early_are_bounds() {
    for (stop, is_bound) in [
        (StopKind::TimeUp, true),
        (StopKind::OverBudget, true),
        (StopKind::Failed, true),
        (StopKind::LeftTerrain, false),
        (StopKind::AtRest, false),
    ] {
        let mut hazard = Hazard::default();
        let row = Row::of(&fall(1), info(1).origin_m);
        for index in 1..=100 {
            let stop = if index <= 20 { stop } else { StopKind::AtRest };
            let max_speed_m_s = index as f64;
            hazard.add(&Row { index, stop, max_speed_m_s, max_total_j: max_speed_m_s, ..row });
        }
        for quantity in [Quantity::MaxSpeed, Quantity::MaxTotal, Quantity::Impacts] {
            let sample = hazard.sample(quantity);
            assert_eq!(sample.bounds() > 0, is_bound, "{stop:?}");
            assert_eq!(sample.percentile(0.9).unwrap().high_95.is_none(), is_bound, "{stop:?}");
        }
        // eighty came to rest: were all others faster, the median would be the 70th value
        let median = hazard.sample(Quantity::MaxSpeed).percentile(0.5).unwrap();
        assert!((median.value - 50.5).abs() < 1e-12 && median.censored == is_bound);
        assert_eq!(median.high_95, Some(if is_bound { 81.0 } else { 61.0 }), "{stop:?}");
    }
}

/// A bound is the largest value only where the truth may be larger, or where it is larger than every value that is known.
#[test]
fn a_bound_below_the_largest_value_decides_nothing() {
    let largest = |bounds: [bool; 3], open| {
        let values = [30.0, 35.0, 40.0].into_iter().zip(bounds).map(|(x, bound)| (x, 1.0, bound));
        Sample::censored(values, open).largest().unwrap()
    };
    assert_eq!(largest([true, true, false], Open::Below), (40.0, false));
    assert_eq!(largest([false, false, true], Open::Below), (40.0, true));
    assert_eq!(largest([true, false, false], Open::Above), (40.0, true));
    assert_eq!(largest([false; 3], Open::Above), (40.0, false));
    assert!(Sample::of([]).largest().is_none());
}

/// One rock of a hundred left at 10 m and may have come anywhere: between the percentile of what was seen and that with
/// it at the far end lies all that it can do, P90 from 90.1 to 91.1.
#[test]
fn one_rock_that_left_widens_the_interval_and_closes_it() {
    let values = (1..=100).map(|k| (f64::from(k), 1.0, k == 10));
    let found = Sample::censored(values, Open::Above).percentile(0.9).unwrap();
    let whole = Sample::of((1..=100).map(f64::from)).percentile(0.9).unwrap();
    assert!(found.censored && (found.value - whole.value).abs() < 1e-12);
    assert_eq!((found.low_95, whole.high_95), (whole.low_95, Some(96.0)));
    assert_eq!(found.high_95, Some(97.0));
}

/// No speed or energy is negative, so no interval of its mean is: of 0, 0, 0, 1 Student's would be 0.25 ± 0.80. Above it reaches as far as Hall's, as
/// such values are skewed: `a = 1/√3`, and `−3/a (∛(1 − a (t + a/6)) − 1) = 10.20` standard errors of 0.25.
#[test]
fn the_mean_of_positive_values_has_a_positive_interval() {
    let mean = Sample::of([0.0, 0.0, 0.0, 1.0]).mean().unwrap();
    let factor = (3.182_446_f64).exp();
    assert!((mean.low_95.unwrap() - 0.25 / factor).abs() < 1e-4);
    assert!((mean.high_95.unwrap() - 0.25 * 11.20).abs() < 5e-3, "{mean:?}");
    let signed = Sample::of([-1.0, 0.0, 0.0, 1.2]).mean().unwrap();
    assert!(signed.low_95.unwrap() < 0.0);
}

/// Sums go over the rocks that did not fail; the effort of all is counted.
#[test]
fn totals_are_sums_and_name_the_failed() {
    let mut hazard = Hazard::default();
    (0..20).for_each(|index| hazard.totals.add(&fall(index)));
    let totals = hazard.totals;
    assert_eq!(totals.effort.steps, (0..20).sum::<u64>());
    assert_eq!(totals.failures.values().flatten().copied().collect::<Vec<_>>(), [3]);
    let sum: f64 = (0..20)
        .map(fall)
        .filter(|fall| fall.index != 3)
        .fold(0.0, |sum, fall| sum + fall.ledger.friction_j);
    // 19 roundings of the plain sum against none of the exact one
    assert!((totals.ledger.friction_j.value() - sum).abs() < 20.0 * f64::EPSILON * sum);
    // in two parts, the second first: the same bits
    let (mut first, mut second) = (Totals::default(), Totals::default());
    (12..20).for_each(|index| second.add(&fall(index)));
    (0..12).for_each(|index| first.add(&fall(index)));
    first.join(&second);
    assert_eq!(first.rounded(), totals.rounded());
    let rise = (0..20)
        .map(fall)
        .filter(|fall| fall.index != 3)
        .map(|fall| fall.ledger.rise_j)
        .fold(0.0, f64::max);
    assert!((totals.largest_energy_rise_j.unwrap().value - rise).abs() < f64::MIN_POSITIVE);
}

/// A hundred crossings with the values 1 to 100 of every quantity, by hand: percentiles linear between neighbours,
/// `1 + 99 p`; bounds at the ranks of the exact binomial sum above (median: 40th and 61st value of 100; P90: 84th and
/// 96th), none above P95 to P99, which so few crossings do not bound; mean 50.5 with 1.959964 · 29.011492/10 to each
/// side; reach 100 of 400, three of which cross again.
#[test]
fn a_line_by_hand() {
    let row = |k: usize| {
        let value = k as f64;
        CrossingRow {
            index: k,
            line: "road".to_owned(),
            time_s: 1.0,
            along_m: value,
            height_m: value,
            speed_m_s: value,
            translational_j: 0.75 * value,
            rotational_j: 0.25 * value,
            height_normal_m: value,
            descent_deg: value,
            mass_kg: 1.0,
            radius_m: 0.5,
            times: if k.is_multiple_of(40) || k == 7 { 2 } else { 1 },
            position_m: [0.0; 3],
            top_m: None,
        }
    };
    let info = info(1).lines[0].clone();
    let mut line = Line::new(info);
    // the order of rocks does not matter
    (1..=100).map(|k| row((k * 37) % 101)).for_each(|row| line.add(&row));
    let found = line.summary(400, None);
    assert_eq!(found.reach, Proportion::new(100, 400));
    assert_eq!(found.crossing_again, 3);
    let scales = [
        ("speed_m_s", 1.0),
        ("translational_j", 0.75),
        ("rotational_j", 0.25),
        ("total_j", 1.0),
        ("height_m", 1.0),
        ("height_normal_m", 1.0),
        ("descent_deg", 1.0),
    ];
    assert_eq!(found.statistics.len(), scales.len());
    for (name, scale) in scales {
        let of = &found.statistics[name];
        let near = |found: f64, exact: f64| {
            assert!((found - scale * exact).abs() < 1e-12 * scale * exact, "{name}: {found}");
        };
        for (percent, low, high) in [(50, Some(40), Some(61)), (90, Some(84), Some(96))] {
            let at = &of.percentiles[&format!("p{percent}")];
            near(at.value, 1.0 + 0.99 * f64::from(percent));
            let ends = [low, high].map(|rank| rank.map(|rank| scale * f64::from(rank)));
            assert_eq!([at.low_95, at.high_95], ends, "{name} {percent}");
        }
        for percent in [95, 98, 99] {
            let at = &of.percentiles[&format!("p{percent}")];
            near(at.value, 1.0 + 0.99 * f64::from(percent));
            let (low, high, _) = ranks(100, f64::from(percent) / 100.0);
            assert_eq!(at.low_95, low.map(|rank| scale * rank as f64));
            assert_eq!(at.high_95, high.map(|rank| scale * rank as f64));
        }
        let mean = of.mean.unwrap();
        near(mean.value, 50.5);
        assert!((mean.high_95.unwrap() / scale - (50.5 + 5.756_455)).abs() < 1e-4, "{mean:?}");
        assert_eq!(of.max.map(|most| most.release), Some(100));
        near(of.max.unwrap().value, 100.0);
    }
}
