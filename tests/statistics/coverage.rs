//! Intervals of numbers a year, and of weighted statistics, hold what they promise: by simulated runs.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::yearly;

use rockfall::frequency::{Class, Frequency, FrequencyLaw, RockSource};
use rockfall::hazard::{
    Barrier, CrossingRow, EventRate, Object, OpenRocks, Sample, Vehicles, judge,
};
use rockfall::random::{Purpose, stream, unit};
use std::convert::Infallible;
use yearly::{REACH, asked, covers, crossings, near, power_law, road, row};

/// Reach 0.2 and 20 m/s for all: 300 kJ are 0.5556 m³, so λ = 0.2 · 0.1 (0.5556^−½ − 100^−½) = 0.0248328157 a year, T =
/// 40.2692957 years, 0.0245270179 in a year, and the energy of that return period is 300 kJ. Each lies in its interval in
/// 93 to 97 of 100 runs, hundred by hundred; over 2000 runs coverage is known to 0.5 % (one standard deviation).
#[test]
fn the_closed_case_lies_in_its_interval() {
    const RATE: f64 = 0.024_832_815_7;
    const RUNS: u64 = 2000;
    let asked = asked(vec![power_law(0.1, 0.5)]);
    near(0.02 * ((300e3 / 540e3_f64).powf(-0.5) - 0.1), RATE, 1e-8);
    let (mut rates, mut energies, mut shares, mut sum) = (Vec::new(), 0, 0, 0.0);
    for seed in 0..RUNS {
        let place = road(&asked, 2000, &crossings(&asked, seed, 2000));
        let share = place.conditional_on_release;
        shares += u32::from((share.low_95..=share.high_95).contains(&REACH));
        let found = place.without_barriers;
        let above = found.above[0].rate;
        rates.push(covers(&above, RATE));
        sum += above.per_year;
        let energy = found.returns[0];
        energies += u32::from(energy.low_95 <= 300e3 && energy.high_95.is_none_or(|e| e >= 300e3));
        near(above.return_period_years().unwrap(), 1.0 / above.per_year, 1e-12);
    }
    let of = |which: &[bool]| which.iter().filter(|inside| **inside).count();
    let hundreds: Vec<usize> = rates.chunks(100).map(of).collect();
    let all = of(&rates);
    println!(
        "rate: by hundreds {hundreds:?}, {all} of {RUNS}; energy of T: {energies}, share: {shares} of {RUNS}"
    );
    // a hundred alone strays by 2: of 95 % coverage four hundreds in five lie within 93 to 97
    let within = hundreds.iter().filter(|inside| (93..=97).contains(*inside)).count();
    assert!(within >= 14, "{hundreds:?}");
    for inside in [all as f64, f64::from(energies), f64::from(shares)] {
        assert!((0.94..=0.97).contains(&(inside / RUNS as f64)), "{inside}");
    }
    // unbiased: the mean of 2000 runs is known to 0.1 %
    near(sum / RUNS as f64, RATE, 4e-3);
    let exact = EventRate {
        rocks: 1,
        per_year: RATE,
        low_95: 0.0,
        high_95: 1.0,
        censored: false,
        by_log_rate: 0.0,
        by_exponent: None,
    };
    near(exact.return_period_years().unwrap(), 40.269_295_7, 1e-8);
    near(exact.annual_probability(), 0.024_527_017_9, 1e-8);
}

/// Few rocks, rare events: the interval may be wider than it says, never narrower. Of 200 rocks some two pass with more
/// than the energy of 4000 years.
#[test]
fn rare_events_are_covered_too() {
    let law = power_law(0.1, 1.2);
    let mut asked = asked(vec![law]);
    let energy_j = 540e3 * 40.0;
    let frequency = Frequency::new(vec![power_law(0.1, 1.2)], vec![energy_j], vec![]);
    asked.frequency = Some(frequency);
    let truth = REACH * 0.1 * (40_f64.powf(-1.2) - 100_f64.powf(-1.2));
    let run = |seed: u64| {
        let found = road(&asked, 200, &crossings(&asked, seed, 200)).without_barriers;
        covers(&found.above[0].rate, truth)
    };
    let inside = (0..2000).filter(|seed| run(*seed)).count();
    println!("rare: {inside} of 2000");
    assert!(inside >= 1880, "{inside}");
}

/// Nothing seen: 0 to 3 f/n with equal weights. With strata three of the heaviest rocks; with the mean weight, `3 F/n_eff`,
/// the bound would be broken more often than one time in twenty where all that passes is of the heaviest stratum.
#[test]
fn nothing_seen_gives_the_one_sided_bound() {
    const RUNS: u64 = 4000;
    let events =
        RockSource { name: "wall".to_owned(), law: FrequencyLaw::Events { per_year: 0.05 } };
    let found = road(&asked(vec![events]), 600, &[]).without_barriers;
    assert_eq!(found.passages.rocks, 0);
    near(found.passages.high_95, 0.05 * (1.0 - 0.05_f64.powf(1.0 / 600.0)), 1e-12);
    assert!(found.returns[0].energy_j.is_none() && found.passages.low_95.abs() < f64::EPSILON);

    let class = |volume: f64, per_year: f64| Class { volume_m3: [volume; 2], per_year };
    let rarer = (2..=11).map(|volume| class(f64::from(volume), 0.5));
    let law = FrequencyLaw::Classes([class(1.0, 1.0)].into_iter().chain(rarer).collect());
    let asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let found = road(&asked, 1100, &[]).without_barriers.passages;
    near(found.high_95, 6.0 * (1.0 - 0.05_f64.powf(1.0 / 600.0)), 1e-12);
    let frequency = asked.frequency.clone().unwrap();
    let mean = 3.0 * frequency.per_year() / frequency.weights(1100).effective_rocks();
    let (mut honest, mut plain) = (0, 0);
    // 2.2 rocks of the heaviest stratum are expected: none is seen one time in nine
    let reach = 2.2 / 100.0;
    for seed in 0..RUNS {
        let passes = |index: &usize| {
            index.is_multiple_of(11) && unit(&mut stream(seed, Purpose::Start, *index)) < reach
        };
        let rows: Vec<CrossingRow> =
            (0..1100).filter(passes).map(|index| row(index, "road", 1.0, 1e5)).collect();
        let found = road(&asked, 1100, &rows).without_barriers.passages;
        honest += u64::from(found.high_95 >= reach);
        plain += u64::from(if rows.is_empty() { mean >= reach } else { found.high_95 >= reach });
    }
    println!("upper bound holds in {honest}, with the mean weight in {plain} of {RUNS}");
    assert!(honest >= RUNS * 95 / 100, "{honest}");
    assert!(plain < RUNS * 95 / 100, "{plain}");
}

/// Weighted mean and percentiles of a quantity that depends on size and chance, over the rocks that pass. The intervals
/// take rocks as independent; that sizes are spread evenly makes them a little too wide, never too narrow.
#[test]
fn weighted_means_and_percentiles_are_covered() {
    const RUNS: u64 = 1000;
    let (a, b, c) = (0.1, 0.5, 0.25);
    let asked = asked(vec![power_law(a, b)]);
    let frequency = asked.frequency.clone().unwrap();
    let value = |volume: f64, random: f64| volume.powf(c) * (0.5 + random);
    // E[V^c] = b/(c − b) (V₁^(c−b) − V₀^(c−b)) / (V₀^−b − V₁^−b), E[0.5 + u] = 1
    let moment = |p: f64| 100_f64.powf(p) - 0.1_f64.powf(p);
    let mean = b / (c - b) * moment(c - b) / -moment(-b);
    let exact = quantiles(value, b);
    let weights = frequency.weights(1200);
    let (mut means, mut inside) = (0, [0; 2]);
    for seed in 0..RUNS {
        let pairs = (0..1200).filter_map(|index| {
            let mut random = stream(seed, Purpose::Size, index);
            let volume = frequency.stratum(index).quantile_m3(unit(&mut random)).unwrap();
            let passes = unit(&mut random) < REACH;
            let weight = weights.of_release(index);
            passes.then(|| (value(volume, unit(&mut random)), weight))
        });
        let sample = Sample::weighted(pairs.collect::<Vec<_>>());
        let found = sample.mean().unwrap();
        means += u32::from(found.low_95.unwrap() <= mean && mean <= found.high_95.unwrap());
        for (k, (p, exact)) in exact.iter().enumerate() {
            let found = sample.percentile(*p).unwrap();
            let below = found.low_95.is_none_or(|low| low <= *exact);
            inside[k] += u32::from(below && found.high_95.is_none_or(|high| *exact <= high));
        }
    }
    println!("mean {means}, P50 and P90 {inside:?} of {RUNS}");
    // beyond P90 lie light rocks, and what a typical one would do there is taken into account: too wide by more than the others
    for (count, most) in [(means, 0.99), (inside[0], 0.99), (inside[1], 0.996)] {
        let share = f64::from(count) / RUNS as f64;
        assert!((0.93..=most).contains(&share), "{share}");
    }
}

/// A mean over all rocks, and over those that pass a place, knows that every class has as many rocks as it has: it lies in its interval as
/// often as it should, and that of all rocks is less than half as wide as if sizes came by chance. At a place that only a few rocks of a
/// class pass, it is no narrower than chance leaves it.
#[test]
fn a_mean_knows_the_classes_that_were_released() {
    const RUNS: u64 = 1000;
    let c = 0.4;
    let asked = asked(vec![power_law(0.1, 0.5)]);
    let frequency = asked.frequency.clone().unwrap();
    let weights = frequency.weights(400);
    let moment = |p: f64| 100_f64.powf(p) - 0.1_f64.powf(p);
    let mean = 0.5 / (c - 0.5) * moment(c - 0.5) / -moment(-0.5);
    for (reach, most_width) in [(1.0, 0.5), (0.1, 1.1)] {
        let (mut inside, mut widths) = (0, [0.0; 2]);
        for seed in 0..RUNS {
            let values = (0..400).filter_map(|index| {
                let mut random = stream(seed, Purpose::Size, index);
                let volume = frequency.stratum(index).quantile_m3(unit(&mut random)).unwrap();
                let passes = unit(&mut random) < reach;
                passes.then(|| (volume.powf(c) * (0.5 + unit(&mut random)), index))
            });
            let values: Vec<(f64, usize)> = values.collect();
            let weighed = values.iter().map(|(x, index)| (*x, weights.of_release(*index)));
            let by_chance = Sample::weighted(weighed).mean().unwrap();
            let found = Sample::of_releases(values, &weights).mean().unwrap();
            near(found.value, by_chance.value, 1e-12);
            let [low, high] = [found.low_95, found.high_95].map(Option::unwrap);
            inside += u32::from(low <= mean && mean <= high);
            widths[0] += high - low;
            widths[1] += by_chance.high_95.unwrap() - by_chance.low_95.unwrap();
        }
        let (share, width) = (f64::from(inside) / RUNS as f64, widths[0] / widths[1]);
        println!("reach {reach}: {inside} of {RUNS}, {width:.3} of the width by chance");
        assert!((0.93..=0.985).contains(&share) && width < most_width, "{reach}: {share} {width}");
    }
}

/// Six of 300 rocks stand for half of all: 300 of them are worth `594²/15 294` = 23 of equal weight, and none of the six beyond P95 says
/// little; that half of all weight lies on six of them says as little of where the lower end is.
#[test]
fn a_percentile_that_one_heavy_rock_may_move_has_no_upper_end() {
    let weight = |k: usize| if k.is_multiple_of(50) { 50.0 } else { 1.0 };
    let sample = Sample::weighted((0..300).map(|k| (k as f64, weight(k))));
    let found = sample.percentile(0.95).unwrap();
    assert_eq!((found.low_95, found.high_95, found.upper_95), (None, None, None));
    assert_eq!(found.needs, (59.0_f64 * 300.0 * 15_294.0 / 594.0_f64.powi(2)).ceil() as usize);
    let median = sample.percentile(0.5).unwrap();
    assert!(median.high_95.is_some() && median.low_95.is_some());
}

/// What a net stops of the rocks that arrive: a share whose chance may hang on the weight. In order: it does not, heavy rocks are
/// stopped seldom, only they are ever stopped.
#[test]
fn shares_that_a_net_stops_are_covered() {
    const RUNS: u64 = 1000;
    let class = |volume: f64, per_year: f64| Class { volume_m3: [volume; 2], per_year };
    let law = FrequencyLaw::Classes(vec![class(0.1, 1.0), class(1.0, 0.3), class(10.0, 0.1)]);
    let asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let weights = asked.frequency.clone().unwrap().weights(900);
    let net = [Barrier {
        name: "net".to_owned(),
        height_m: 4.0,
        capacity_j: 5e5,
        design: None,
        elsewhere: vec![],
    }];
    let rates = [1.0, 0.3, 0.1].map(|rate: f64| rate / 1.4);
    let open = OpenRocks::default();
    for chances in [[0.3; 3], [0.1, 0.6, 0.9], [0.15, 0.0, 0.0]] {
        let truth: f64 = rates.iter().zip(chances).map(|(rate, chance)| rate * chance).sum();
        let inside = (0..RUNS).filter(|seed| {
            let one = |index: usize| {
                let mut random = stream(*seed, Purpose::Size, index);
                let arrives = unit(&mut random) < 0.5;
                let energy_j = if unit(&mut random) < chances[index % 3] { 1e5 } else { 1e6 };
                arrives.then(|| Ok::<_, Infallible>(row(index, "net", 1.0, energy_j)))
            };
            let found = judge(&net, (0..900).filter_map(one), (&weights, &open)).unwrap();
            (found[0].stopped.low_95..=found[0].stopped.high_95).contains(&truth)
        });
        let inside = inside.count();
        println!("stopped {chances:?}: {inside} of {RUNS}");
        assert!((930..=990).contains(&inside), "{chances:?}: {inside}");
    }
}

/// Risks of traffic weigh rocks by their size: their interval covers as well.
#[test]
fn intervals_of_road_risk_are_covered() {
    let mut asked = asked(vec![power_law(0.1, 0.5)]);
    let vehicles = Vehicles { per_day: 1000.0, speed_km_h: 60.0, length_m: 4.5, own_per_day: None };
    asked.objects = vec![Object {
        name: "road".to_owned(),
        corners_m: vec![],
        width_m: Some(6.0),
        occupancy: None,
        vulnerability: None,
        persons: None,
        vehicles: Some(vehicles),
    }];
    // E[d] = 2 (3/4π)^⅓ E[V^⅓]
    let moment = |p: f64| 100_f64.powf(p) - 0.1_f64.powf(p);
    let third = 1.0 / 3.0;
    let mean = 0.5 / (third - 0.5) * moment(third - 0.5) / -moment(-0.5);
    let diameter = 2.0 * (0.75 / std::f64::consts::PI).cbrt() * mean;
    let events = 0.1 * -moment(-0.5);
    let truth = REACH * events * 1000.0 * (4.5 + diameter) / (24.0 * 60e3);
    let run = |seed: u64| {
        let found = road(&asked, 1000, &crossings(&asked, seed, 1000)).without_barriers;
        covers(&found.risks[0].rate, truth)
    };
    let inside = (0..1000).filter(|seed| run(*seed)).count();
    println!("road risk: {inside} of 1000");
    assert!((935..=980).contains(&inside), "{inside}");
}

/// True percentiles of a value of volume and chance under the power law, by summing over a fine grid of both.
fn quantiles(value: impl Fn(f64, f64) -> f64, b: f64) -> [(f64, f64); 2] {
    let even = |k: usize| (k as f64 + 0.5) / 1000.0;
    let (low, high) = (0.1_f64.powf(-b), 100_f64.powf(-b));
    let volume = |p: f64| (low - p * (low - high)).powf(-1.0 / b);
    let mut all: Vec<f64> = (0..1000)
        .flat_map(|i| (0..1000).map(move |j| (i, j)))
        .map(|(i, j)| value(volume(even(i)), even(j)))
        .collect();
    all.sort_by(f64::total_cmp);
    [0.5, 0.9].map(|p| (p, all[(p * all.len() as f64) as usize]))
}

/// Twenty values of a long tail, exponential with mean 1: the mean lies in its interval in 93 to 97 of 100 samples (by 1.96 s/√n in 90).
#[test]
fn the_mean_of_few_skewed_values_lies_in_its_interval() {
    const SAMPLES: usize = 4000;
    let inside = (0..SAMPLES).filter(|index| {
        let mut random = stream(7, Purpose::Impacts, *index);
        let values: Vec<f64> = (0..20).map(|_| -(1.0 - unit(&mut random)).ln()).collect();
        let found = Sample::of(values).mean().unwrap();
        found.low_95.unwrap() <= 1.0 && 1.0 <= found.high_95.unwrap()
    });
    let share = inside.count() as f64 / SAMPLES as f64;
    assert!((0.93..=0.97).contains(&share), "{share}");
}

/// Two blocks of a class that stands for most events came, heights lognormal (σ = 0.6) less the 0.1 m by which such blocks lie below the ground under their
/// centre: of 4000 samples the mean lies in its interval in 95 or more of 100, and no end is below −0.1 m. Without that floor some are.
#[test]
fn a_mean_height_of_two_heavy_blocks_stays_possible() {
    const SAMPLES: usize = 4000;
    const BELOW_M: f64 = 0.1;
    let class = |volume: f64, per_year: f64| Class { volume_m3: [volume; 2], per_year };
    let law = FrequencyLaw::Classes(vec![class(0.1, 100.0), class(1.0, 2.0)]);
    let asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let weights = asked.frequency.unwrap().weights(200);
    let mean = |median: f64| median * (0.6_f64.powi(2) / 2.0).exp() - BELOW_M;
    // 2 of 100 blocks of the first class come, 50 of 100 of the second
    let truth = (100.0 * 0.02 * mean(2.0) + 2.0 * 0.5 * mean(1.0)) / (100.0 * 0.02 + 2.0 * 0.5);
    let (mut inside, mut impossible) = (0, [0, 0]);
    for index in 0..SAMPLES {
        let mut random = stream(11, Purpose::Impacts, index);
        let comes = (0..100).filter(|_| unit(&mut random) < 0.5).map(|at| 2 * at + 1);
        let releases: Vec<usize> = [0, 2].into_iter().chain(comes.collect::<Vec<_>>()).collect();
        let one = |release: usize| {
            let normal = (-2.0 * (1.0 - unit(&mut random)).ln()).sqrt()
                * (std::f64::consts::TAU * unit(&mut random)).cos();
            let median = if release.is_multiple_of(2) { 2.0 } else { 1.0 };
            (median * (0.6 * normal).exp() - BELOW_M, release)
        };
        let heights: Vec<(f64, usize)> = releases.into_iter().map(one).collect();
        let plain = Sample::of_releases(heights, &weights);
        let ends = [plain.clone(), plain.not_below(-BELOW_M)].map(|of| of.mean().unwrap());
        let [low, high] = [ends[1].low_95, ends[1].high_95].map(Option::unwrap);
        inside += usize::from(low <= truth && truth <= high);
        for (count, of) in impossible.iter_mut().zip(&ends) {
            *count += usize::from(of.low_95.unwrap() < -BELOW_M);
        }
    }
    println!("{inside} of {SAMPLES} inside, {impossible:?} ends below what is possible");
    assert!(inside * 100 >= 95 * SAMPLES, "{inside}");
    assert!(impossible[0] > 0 && impossible[1] == 0, "{impossible:?}");
}
