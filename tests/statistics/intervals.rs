//! Intervals hold what they promise where few rocks are seen: rare and common events, zones that weigh unlike, values that tie, one to three rocks.
//! By exact sums over the binomial where there are some, else by simulated runs with known truth.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::yearly;

use rockfall::frequency::{Class, Frequency, FrequencyLaw, RockSource, Weights};
use rockfall::hazard::{
    AnnualRequest, Barrier, Difference, MapFrame, MapState, Maps, OpenRocks, Profile, Proportion,
    Ranks, Reading, Sample, StopKind, Values, judge, share_of, year_maps,
};
use rockfall::random::{Purpose, stream, unit};
use rockfall::simulation::{CellPassage, Stretch};
use std::convert::Infallible;
use yearly::{REACH, asked, crossings, power_law, road, row};

/// Simulated runs of each case: coverage is known to 0.5 % (one standard deviation).
const RUNS: u64 = 2000;
/// Fewest runs that must hold the truth: 95 % less two standard deviations.
const ENOUGH: usize = 1880;

/// Chances of `0..=most` successes among `n`, each with probability `p`, by the ratio of neighbours.
fn binomial(n: usize, p: f64, most: usize) -> Vec<f64> {
    let mut chance = (n as f64 * (-p).ln_1p()).exp();
    let odds = p / (1.0 - p);
    (0..=most)
        .map(|k| {
            let here = chance;
            chance *= (n - k) as f64 / (k + 1) as f64 * odds;
            here
        })
        .collect()
}

/// Chance that the interval of a share holds it.
fn coverage(intervals: &[Proportion], p: f64) -> f64 {
    let chances = binomial(intervals[0].of, p, intervals.len() - 1);
    let holds = |one: &Proportion| (one.low_95..=one.high_95).contains(&p);
    let held = intervals.iter().zip(&chances).filter(|(one, _)| holds(one));
    held.map(|(_, chance)| chance).sum()
}

/// Exact coverage just beside every end, where it is least: 95 % or more at every share. Only beyond the
/// one-sided bound of none and within the two-sided one, about 3/n to 3.7/n, it is 93.8 %, of 30 rocks 93.0 %. (Wilson's was 83.8 % at 0.18/n.)
#[test]
fn shares_hold_the_truth_however_rare() {
    for n in [30, 100, 1000, 10_000] {
        let most = n.min(200);
        let intervals: Vec<Proportion> = (0..=most).map(|k| Proportion::new(k, n)).collect();
        let ends = intervals.iter().flat_map(|one| [one.low_95, one.high_95]);
        let beside = ends.flat_map(|end| [end * (1.0 - 1e-9), end * (1.0 + 1e-9)]);
        // farther up, counts beyond `most` would be missing
        let (last, two_sided) =
            (100.0_f64.min(0.5 * n as f64), 1.0 - 0.025_f64.powf(1.0 / n as f64));
        for p in beside.filter(|p| (1e-9..last / n as f64).contains(p)) {
            let found = coverage(&intervals, p);
            let of_none = (1.0 - 0.05_f64.powf(1.0 / n as f64)..two_sided).contains(&p);
            assert!(
                found >= if of_none { if n > 30 { 0.938 } else { 0.929 } } else { 0.95 - 1e-8 },
                "{p} of {n}: {found}"
            );
        }
    }
}

/// Sources of so many events a year each, each a stratum of its own.
fn strata(per_year: &[f64]) -> Frequency {
    let class = |(k, per_year): (usize, &f64)| Class {
        volume_m3: [1.0 + k as f64; 2],
        per_year: *per_year,
    };
    let law = FrequencyLaw::Classes(per_year.iter().enumerate().map(class).collect());
    Frequency::new(vec![RockSource { name: "wall".to_owned(), law }], vec![], vec![])
}

/// Events a year, rocks and chance of a zone.
type Zone = (f64, usize, f64);

/// Runs whose share of all events holds the truth.
fn runs_that_hold(zones: &[Zone]) -> usize {
    let rates: Vec<f64> = zones.iter().map(|zone| zone.0).collect();
    let weights = strata(&rates).weights_of(zones.iter().map(|zone| zone.1).collect());
    let truth = zones.iter().map(|zone| zone.0 * zone.2).sum::<f64>() / rates.iter().sum::<f64>();
    let holds = |seed: &u64| {
        let mut random = stream(*seed, Purpose::Size, 0);
        let mut seen = Vec::new();
        for (zone, (_, rocks, chance)) in zones.iter().enumerate() {
            let hits = (0..*rocks).filter(|_| unit(&mut random) < *chance);
            seen.extend(hits.map(|k| zone + k * zones.len()));
        }
        let found = share_of(&weights, seen.into_iter());
        // all of it is 1 to rounding
        found.low_95 <= truth + 1e-12 && truth <= found.high_95 + 1e-12
    };
    (0..RUNS).filter(holds).count()
}

/// Zones of unlike weight and size. By Wilson's with the effective weight of a rock 80, 81, 93, 93, 94 and 97 % of the runs held
/// the truth.
#[test]
fn shares_of_zones_that_weigh_unlike_are_covered() {
    let three = |chances: [f64; 3]| -> Vec<Zone> {
        [1.0, 0.3, 0.09].into_iter().zip(chances).map(|(rate, p)| (rate, 300, p)).collect()
    };
    let sizes = |p: f64| [50, 500, 5000].map(|rocks| (1.0, rocks, p)).to_vec();
    let many = |p: f64| (0..33).map(|k| (0.7_f64.powi(k), 6, p)).collect();
    let zones = [(10.0, 0.01), (5.0, 0.003), (1.0, 0.1), (0.1, 0.9), (0.01, 0.5)];
    let cases: [(&str, Vec<Zone>); 6] = [
        ("nearly all, and only of the lightest", three([0.0, 0.0, 0.99])),
        ("nearly all, and only of the heaviest", three([0.99, 0.0, 0.0])),
        ("nearly all, of few heavy ones", sizes(0.9)),
        ("rare, of 33 strata with six rocks each", many(0.005)),
        ("rare where much falls", zones.map(|(rate, p)| (rate, 400, p)).to_vec()),
        ("of the lightest alone", three([0.0, 0.0, 0.05])),
    ];
    for (name, zones) in cases {
        let found = runs_that_hold(&zones);
        println!("{name}: {found} of {RUNS}");
        assert!(found >= ENOUGH, "{name}: {found} of {RUNS}");
    }
}

/// A net that lets hardly any rock through, of two sources that weigh nearly the same: with Wilson's of the effective number the share that it stops lay
/// in 89 % of the intervals.
#[test]
fn a_net_that_hardly_lets_one_through_is_covered() {
    let frequency = strata(&[1.0, 0.9]);
    let weights = frequency.weights(400);
    let net = Barrier {
        name: "net".to_owned(),
        height_m: 4.0,
        capacity_j: 5e5,
        design: None,
        elsewhere: vec![],
    };
    let stops = 0.9975;
    let holds = |seed: &u64| {
        let mut random = stream(*seed, Purpose::Size, 0);
        let mut one = |index: usize| {
            let (comes, luck) = (unit(&mut random) < 0.15, unit(&mut random));
            let energy_j = if luck < stops { 1e5 } else { 1e6 };
            comes.then(|| Ok::<_, Infallible>(row(index, "net", 1.0, energy_j)))
        };
        let rows: Vec<_> = (0..400).filter_map(&mut one).collect();
        let net = std::slice::from_ref(&net);
        let found = judge(net, rows.into_iter(), (&weights, &OpenRocks::default())).unwrap();
        (found[0].stopped.low_95..=found[0].stopped.high_95).contains(&stops)
    };
    let found = (0..RUNS).filter(holds).count();
    println!("net: {found} of {RUNS}");
    assert!(found >= ENOUGH, "{found} of {RUNS}");
}

/// One cell of a map that few rocks cross: its frequency, and the energy of a return period of 2000 years there.
#[test]
fn a_cell_that_few_rocks_cross_is_covered() {
    let frame =
        MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 1.0, columns: 1, rows: 1, epsg: None };
    let (rocks, reach, years) = (300, 0.005, 2000.0);
    let law = power_law(0.1, 1.2);
    let frequency = Frequency::new(vec![law], vec![], vec![years]);
    let request = AnnualRequest { frequency: Some(frequency.clone()), ..AnnualRequest::default() };
    let weights = frequency.weights(rocks);
    let rate = reach * frequency.per_year();
    // reach · 0.1 (V^−1.2 − 100^−1.2) = 1/T
    let volume = (1.0 / years / reach / 0.1 + 100_f64.powf(-1.2)).powf(-1.0 / 1.2);
    let truths = [("frequency_per_year", rate), ("energy_T2000_j", 540e3 * volume)];
    let mut inside = [0; 2];
    for seed in 0..RUNS {
        let mut maps = Maps::new(frame, &[], MapState::default());
        let mut random = stream(seed, Purpose::Size, 0);
        for index in 0..rocks {
            let volume = frequency.stratum(index).quantile_m3(unit(&mut random)).unwrap();
            if unit(&mut random) < reach {
                let passage = CellPassage { cell: 0, total_j: 540e3 * volume, height_m: 0.0 };
                let stratum = frequency.stratum_of(index) as u16;
                maps.add(stratum, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
            }
        }
        let found = year_maps(&maps, &request, &weights);
        let end = |name: &str, end: &str| {
            let layer = found.iter().find(|layer| layer.file == format!("{name}{end}")).unwrap();
            // a cell that no rock crosses is not on the map: nothing to 3 of the heaviest
            layer.values.first().map(|(_, value)| *value)
        };
        for (inside, (name, truth)) in inside.iter_mut().zip(truths) {
            let low = end(name, "_low_95").is_none_or(|low| low <= truth);
            let high = end(name, "_high_95").is_none_or(|high| high.is_nan() || truth <= high);
            *inside += usize::from(low && high);
        }
    }
    println!("cell, frequency and energy: {inside:?} of {RUNS}");
    assert!(inside.iter().all(|found| *found >= ENOUGH), "{inside:?}");
}

/// Weights that differ by a millionth bound percentiles by the ranks that equal ones have.
#[test]
fn nearly_equal_weights_bound_percentiles_by_the_same_ranks() {
    for n in [5, 6, 20, 36, 59, 72, 100, 300] {
        let weight = |k: usize| 1.0 + 1e-6 * (k % 2) as f64;
        let sample = Sample::weighted((1..=n).map(|k| (k as f64, weight(k))));
        for p in [0.1, 0.5, 0.9, 0.95] {
            let found = sample.percentile(p).unwrap();
            let Ranks { low, high, upper } = Ranks::of(n, p);
            let ranks =
                [found.low_95, found.high_95, found.upper_95].map(|end| end.map(|x| x as usize));
            // of fewer than it needs there is no lower end
            let low = low.filter(|_| n >= found.needs);
            assert_eq!(ranks, [low, high, upper], "percentile {p} of {n}");
        }
    }
}

/// Twenty of thirty values are 0, ten are 1: they do not bound P90, equal in weight or nearly so; thirty-six are needed. Woodruff's of the latter was 1 to 1.
#[test]
fn values_that_tie_do_not_bound_what_too_few_would_not() {
    for slip in [0.0, 1e-3] {
        let one = |k: usize| (f64::from(u8::from(k >= 20)), 1.0 + slip * (k % 2) as f64);
        let found = Sample::weighted((0..30).map(one)).percentile(0.9).unwrap();
        assert_eq!((found.value, found.high_95), (1.0, None), "{slip}");
    }
}

/// Jumps of 0, 1, 2 … by steps that tie, of rocks of equal and of unlike weight: the percentile lies in its interval, which ends with it where ties say so.
#[test]
fn percentiles_of_few_distinct_values_are_covered() {
    // P(x ≤ k) = 1 − e^(−(k + 1)/2)
    let value = |u: f64| (-2.0 * (1.0 - u).ln()).floor();
    let truth =
        |p: f64| (0..100).map(f64::from).find(|k| 1.0 - (-0.5 * (k + 1.0)).exp() >= p).unwrap();
    for (name, weigh, n) in
        [("equal", [1.0; 2], 100), ("nearly equal", [1.0, 0.999], 100), ("unlike", [1.0, 0.1], 400)]
    {
        for p in [0.5, 0.9, 0.95] {
            let holds = |seed: &u64| {
                let mut random = stream(*seed, Purpose::Impacts, n);
                let one =
                    |k: usize| (value(unit(&mut random)), weigh[usize::from(!k.is_multiple_of(5))]);
                let found = Sample::weighted((0..n).map(one)).percentile(p).unwrap();
                let truth = truth(p);
                found.low_95.is_none_or(|low| low <= truth)
                    && found.high_95.is_none_or(|high| truth <= high)
            };
            let found = (0..RUNS).filter(holds).count();
            println!("{name}, P{}: {found} of {RUNS}", 100.0 * p);
            assert!(found >= ENOUGH, "{name}, {p}: {found} of {RUNS}");
        }
    }
}

/// Where values lie within a class of counts is not kept: a hundred rocks of one speed have an interval that holds it, wherever in its class it lies.
#[test]
fn a_profile_of_equal_speeds_holds_their_speed() {
    for k in 0..50 {
        let speed_m_s = 10.0 * 1.001_f64.powi(k);
        let mut profile = Profile::default();
        for _ in 0..100 {
            profile.add(5.0, 0, &[Stretch { number: 0, speed_m_s, height_m: 0.0 }]);
        }
        let point = profile.points(&Weights::equal(100)).remove(0);
        for found in [point.speed_m_s.median, point.speed_m_s.p95] {
            let (low, high) = (found.low_95.unwrap(), found.high_95.unwrap());
            assert!(low <= speed_m_s && speed_m_s <= high, "{speed_m_s}: {low} to {high}");
        }
    }
}

/// Two runs of one discrete law, 0 or 1 with equal chances: where the medians differ nothing is shown, and of twenty pairs one at most is called clear.
/// Half of them were: the spread of a median of 1 was taken as half of the step that it is from 0.
#[test]
fn medians_of_values_that_tie_are_not_called_different() {
    let values = |seed: u64| -> Values {
        let mut random = stream(seed, Purpose::Redraw, 0);
        (0..100).map(|k| (k, f64::from(u8::from(unit(&mut random) < 0.5)))).collect()
    };
    let clear = |of: &dyn Fn(&Values) -> Reading| {
        let is_clear = |pair: &u64| {
            let [a, b] = [2 * pair, 2 * pair + 1].map(|seed| of(&values(seed)));
            Difference::between(&a, &b, false).is_clear()
        };
        (0..RUNS).filter(is_clear).count()
    };
    let plain = clear(&|values| Reading::percentile(values, 0.5).unwrap());
    let frequency = strata(&[1.0, 0.999]);
    let weights = frequency.weights(100);
    let weighed = clear(&|values| Reading::weighted_percentile(values, &weights, 0.5).unwrap());
    println!("clear, plain {plain}, weighted {weighed} of {RUNS}");
    assert!(plain <= RUNS as usize / 20 && weighed <= RUNS as usize / 20, "{plain} {weighed}");
}

/// Values that are all equal do not say how far another may lie: their mean has no interval, of zero width least of all.
#[test]
fn equal_values_leave_the_mean_open() {
    for n in 1..40 {
        let mean = Sample::of(vec![0.1; n]).mean().unwrap();
        assert_eq!((mean.low_95, mean.high_95), (None, None), "{n}");
    }
    let weighed = Sample::weighted([(0.0, 1.0), (0.0, 0.3), (0.0, 0.1)]).mean().unwrap();
    assert_eq!((weighed.low_95, weighed.high_95), (None, None));
    assert!(Sample::of([0.0, 0.0, 1e-3]).mean().unwrap().low_95.is_some());
}

/// One, two and three releases: every end is a number or missing, shares leave most open, and the bound of none or all is not passed by more rocks.
#[test]
fn one_two_and_three_rocks_are_told_honestly() {
    let exact = [
        (1, 2, [0.012_579, 0.987_421]),
        (1, 3, [0.008_404, 0.905_701]),
        (2, 3, [0.094_299, 0.991_596]),
    ];
    for (count, of, ends) in exact {
        let found = Proportion::new(count, of);
        assert!((found.low_95 - ends[0]).abs() < 1e-6 && (found.high_95 - ends[1]).abs() < 1e-6);
    }
    for n in 1..=3 {
        let open = 1.0 - 0.05_f64.powf(1.0 / n as f64);
        for (count, ends) in [(0, [0.0, open]), (n, [1.0 - open, 1.0])] {
            let found = Proportion::new(count, n);
            let off = [found.low_95 - ends[0], found.high_95 - ends[1]];
            assert!(off.iter().all(|off| off.abs() < 1e-12), "{count} of {n}: {found:?}");
        }
        let weights = strata(&[1.0, 0.2, 0.01]).weights(n);
        for count in 0..=n {
            let found = share_of(&weights, 0..count);
            let ends = [found.low_95, found.share, found.high_95];
            assert!(
                ends.is_sorted() && (0.0..=1.0).contains(&ends[0]) && ends[2] <= 1.0,
                "{found:?}"
            );
            assert!(found.high_95 - found.low_95 > 0.5, "{found:?}");
        }
        let sample = Sample::weighted((0..n).map(|k| (k as f64, 1.0 + k as f64)));
        let found = sample.percentile(0.95).unwrap();
        assert_eq!((found.low_95, found.high_95, found.upper_95), (None, None, None));
        let mean = sample.mean().unwrap();
        assert!(mean.value.is_finite() && mean.low_95.is_none_or(f64::is_finite));
        let place = road(
            &asked(vec![power_law(0.1, 0.5)]),
            n,
            &crossings(&asked(vec![power_law(0.1, 0.5)]), 1, n),
        );
        let passages = place.without_barriers.passages;
        let ends = [passages.low_95, passages.per_year, passages.high_95];
        assert!(ends.is_sorted() && ends[0] >= 0.0 && ends[2] > 0.5 * REACH, "{passages:?}");
    }
}

/// Where the rocks of one stratum vary and those of another are all at the mean, the first alone says how far: twenty of them, ten a metre to
/// either side. The interval of the mean is that of Student with 19 degrees of freedom, 2.0930 (table), on `w √(20 s²)` with `s² = 20/19`.
#[test]
fn the_interval_of_a_mean_has_the_freedom_of_the_stratum_that_varies() {
    let weights = strata(&[1.0, 0.9]).weights(40);
    let runout_m = |release: usize| match release % 4 {
        0 => 4.0,
        2 => 6.0,
        _ => 5.0,
    };
    let sample = Sample::of_releases((0..40).map(|k| (runout_m(k), k)), &weights);
    let mean = sample.mean().unwrap();
    assert!((mean.value - 5.0).abs() < 1e-12, "{mean:?}");
    // shares of all weight: a rock of the first has 1/20 of 1/1.9
    let exact = 2.093_024 / (20.0 * 1.9) * (20.0_f64 * 20.0 / 19.0).sqrt();
    for half in [mean.high_95.unwrap() - 5.0, 5.0 - mean.low_95.unwrap()] {
        assert!((half / exact - 1.0).abs() < 1e-4, "{half} {exact}");
    }
}
