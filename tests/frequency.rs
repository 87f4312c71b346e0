//! Frequencies a year against closed forms, and the coverage of every kind of interval by simulation.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rockfall::chance::{Purpose, stream, unit};
use rockfall::frequency::{Class, Frequency, Law, Source, radius_of_m3};
use rockfall::hazard::{
    Annual, AnnualPlace, Asked, Barrier, CrossingRow, LineInfo, Object, Rate, RiskKind, Sample,
    Vehicles, annual,
};
use std::convert::Infallible;

const DENSITY_KG_M3: f64 = 2700.0;
const SPEED_M_S: f64 = 20.0;
const REACH: f64 = 0.2;

/// N(≥ 1 m³) = 0.1 a year, exponent 0.5, 0.1 to 100 m³.
fn power_law(per_year_at_1m3: f64, exponent: f64) -> Source {
    let law = Law::PowerLaw { per_year_at_1m3, exponent, volume_m3: [0.1, 100.0] };
    Source { name: "wall".to_owned(), law }
}

fn asked(sources: Vec<Source>) -> Asked {
    let frequency = Frequency::new(sources, vec![300e3], vec![40.269_295_7, 100.0]);
    Asked { frequency: Some(frequency), ..Asked::default() }
}

fn row(index: usize, line: &str, volume_m3: f64, energy_j: f64) -> CrossingRow {
    CrossingRow {
        index,
        line: line.to_owned(),
        time_s: 2.0,
        along_m: 0.0,
        height_m: 0.0,
        speed_m_s: SPEED_M_S,
        translational_j: energy_j,
        rotational_j: 0.0,
        height_normal_m: 0.0,
        descent_deg: 0.0,
        mass_kg: DENSITY_KG_M3 * volume_m3,
        radius_m: radius_of_m3(volume_m3),
        times: 1,
        position_m: [0.0; 3],
    }
}

fn line(name: &str) -> LineInfo {
    LineInfo { name: name.to_owned(), length_m: 1.0, corners_m: vec![], of_barrier: false }
}

/// Rocks of a source that reach the line one time in five with 20 m/s.
fn crossings(asked: &Asked, seed: u64, releases: usize) -> Vec<CrossingRow> {
    let frequency = asked.frequency.as_ref().unwrap();
    let one = |index: usize| {
        let mut chance = stream(seed, Purpose::Size, index);
        let volume_m3 = frequency.stratum(index).quantile_m3(unit(&mut chance)).unwrap();
        let energy_j = 0.5 * DENSITY_KG_M3 * volume_m3 * SPEED_M_S * SPEED_M_S;
        (unit(&mut chance) < REACH).then(|| row(index, "road", volume_m3, energy_j))
    };
    (0..releases).filter_map(one).collect()
}

fn year(asked: &Asked, releases: usize, rows: &[CrossingRow], barriers: &[Barrier]) -> Annual {
    let rows = rows.iter().cloned().map(Ok::<_, Infallible>);
    annual(asked, releases, (&[line("road")], barriers), rows).unwrap().unwrap()
}

fn road(asked: &Asked, releases: usize, rows: &[CrossingRow]) -> AnnualPlace {
    year(asked, releases, rows, &[]).places.remove(0)
}

fn covers(rate: &Rate, truth: f64) -> bool {
    (rate.low_95..=rate.high_95).contains(&truth)
}

fn near(found: f64, exact: f64, allowed: f64) {
    assert!((found / exact - 1.0).abs() <= allowed, "{found} for {exact}");
}

/// Reach 0.2 and 20 m/s for all: 300 kJ are 0.5556 m³, so λ = 0.2 · 0.1 (0.5556^−½ − 100^−½) = 0.0248328157 a year, T =
/// 40.2692957 years, 0.0245270179 in a year, and the energy of that return period is 300 kJ. Each lies in its interval in
/// 93 to 97 of 100 runs, hundred by hundred; over 2000 runs coverage is known to 0.5 % (one standard deviation).
#[test]
fn the_closed_case_lies_in_its_interval() {
    const RATE: f64 = 0.024_832_815_7;
    let asked = asked(vec![power_law(0.1, 0.5)]);
    near(0.02 * ((300e3 / 540e3_f64).powf(-0.5) - 0.1), RATE, 1e-8);
    let (mut rates, mut energies, mut sum) = (Vec::new(), 0, 0.0);
    const RUNS: u64 = 2000;
    for seed in 0..RUNS {
        let found = road(&asked, 2000, &crossings(&asked, seed, 2000)).without_barriers;
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
    println!("rate: by hundreds {hundreds:?}, {all} of {RUNS}; energy of T: {energies} of {RUNS}");
    // a hundred alone strays by 2: of 95 % coverage four hundreds in five lie within 93 to 97
    let within = hundreds.iter().filter(|inside| (93..=97).contains(*inside)).count();
    assert!(within >= 14, "{hundreds:?}");
    for inside in [all as f64, f64::from(energies)] {
        assert!((0.94..=0.97).contains(&(inside / RUNS as f64)), "{inside}");
    }
    // unbiased: the mean of 2000 runs is known to 0.1 %
    near(sum / RUNS as f64, RATE, 4e-3);
    let exact = Rate {
        rocks: 1,
        per_year: RATE,
        low_95: 0.0,
        high_95: 1.0,
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

/// Derivatives against closed forms: λ = p a (V₀^−b − V₁^−b), ∂λ/∂b = p a (V₁^−b ln V₁ − V₀^−b ln V₀), a ∂λ/∂a = λ. The
/// energy of T follows from V_T = (1/(T p a) + V₁^−b)^(−1/b), e = 540 kJ/m³ · V_T. 200 000 rocks know them to 2 %.
#[test]
fn derivatives_by_rate_and_exponent_are_those_of_the_closed_case() {
    let asked = asked(vec![power_law(0.1, 0.5)]);
    let releases = 200_000;
    let found = road(&asked, releases, &crossings(&asked, 5, releases)).without_barriers;
    let above = found.above[0].rate;
    let (low, high) = (300e3 / 540e3_f64, 100_f64);
    let slope = 0.02 * (high.ln() / high.sqrt() - low.ln() / low.sqrt());
    near(above.by_exponent.unwrap(), slope, 0.02);
    near(above.by_log_rate, above.per_year, 1e-12);
    let energy_of =
        |a: f64, b: f64| 540e3 * (1.0 / (100.0 * REACH * a) + 100_f64.powf(-b)).powf(-1.0 / b);
    let at = found.returns[1];
    near(at.energy_j.unwrap(), energy_of(0.1, 0.5), 0.02);
    let step = 1e-4;
    let by_rate =
        (energy_of(0.1 * (1.0 + step), 0.5) - energy_of(0.1 * (1.0 - step), 0.5)) / (2.0 * step);
    let by_exponent = (energy_of(0.1, 0.5 + step) - energy_of(0.1, 0.5 - step)) / (2.0 * step);
    // slopes of a curve of 2 % noise over classes of 5 %
    near(at.by_log_rate.unwrap(), by_rate, 0.25);
    near(at.by_exponent.unwrap(), by_exponent, 0.25);
}

/// Twice the events, twice the frequency, to the last bit; interval and derivatives as well.
#[test]
#[expect(clippy::float_cmp, reason = "a factor of two is exact")]
fn rates_scale() {
    let [once, twice] = [0.1, 0.2].map(|per_year| {
        let asked = asked(vec![power_law(per_year, 0.5)]);
        road(&asked, 900, &crossings(&asked, 3, 900)).without_barriers.above[0].rate
    });
    assert_eq!(once.rocks, twice.rocks);
    assert_eq!(2.0 * once.per_year, twice.per_year);
    near(twice.low_95, 2.0 * once.low_95, 1e-12);
    near(twice.high_95, 2.0 * once.high_95, 1e-12);
    near(twice.by_exponent.unwrap(), 2.0 * once.by_exponent.unwrap(), 1e-12);
}

/// The passages of two sources together are those of one plus those of the other, in one run as in two: the strata of
/// each get the same rocks in both.
#[test]
fn sources_add() {
    let sources = [power_law(0.1, 0.5), power_law(0.03, 0.8)];
    let both = asked(sources.to_vec());
    let frequency = both.frequency.clone().unwrap();
    let releases = 30 * frequency.strata().len();
    let rows = crossings(&both, 11, releases);
    let all = road(&both, releases, &rows).without_barriers.passages;
    let of = |source: usize| {
        let rows: Vec<CrossingRow> = rows
            .iter()
            .filter(|row| frequency.stratum(row.index).source == source)
            .cloned()
            .collect();
        // the same rocks as a run of this source alone
        let alone = asked(vec![sources[source].clone()]);
        let own = alone.frequency.clone().unwrap();
        let (all, mine) = (frequency.strata().len(), own.strata().len());
        let first = frequency.strata().iter().position(|one| one.source == source).unwrap();
        let renumbered = rows.iter().map(|row| {
            let index = row.index / all * mine + row.index % all - first;
            CrossingRow { index, ..row.clone() }
        });
        let renumbered: Vec<CrossingRow> = renumbered.collect();
        let in_two = road(&alone, 30 * mine, &renumbered).without_barriers.passages.per_year;
        let in_one = road(&both, releases, &rows).without_barriers.passages.per_year;
        near(in_one, in_two, 1e-12);
        in_one
    };
    near(all.per_year, of(0) + of(1), 1e-12);
    near(
        both.frequency.unwrap().per_year(),
        0.1 * (0.1_f64.powf(-0.5) - 0.1) + 0.03 * (0.1_f64.powf(-0.8) - 100_f64.powf(-0.8)),
        1e-12,
    );
}

/// Nothing seen: 0 to 3 f/n with equal weights. With strata three of the heaviest rocks; with the mean weight, 3 F/n_eff,
/// the bound would be broken more often than one time in twenty where all that passes is of the heaviest stratum.
#[test]
fn nothing_seen_gives_the_one_sided_bound() {
    let events = Source { name: "wall".to_owned(), law: Law::Events { per_year: 0.05 } };
    let found = road(&asked(vec![events]), 600, &[]).without_barriers;
    assert_eq!(found.passages.rocks, 0);
    near(found.passages.high_95, 3.0 * 0.05 / 600.0, 1e-12);
    assert!(found.returns[0].energy_j.is_none() && found.passages.low_95.abs() < f64::EPSILON);

    let class = |volume: f64, per_year: f64| Class { volume_m3: [volume; 2], per_year };
    let rarer = (2..=11).map(|volume| class(f64::from(volume), 0.5));
    let law = Law::Classes([class(1.0, 1.0)].into_iter().chain(rarer).collect());
    let asked = asked(vec![Source { name: "wall".to_owned(), law }]);
    let found = road(&asked, 1100, &[]).without_barriers.passages;
    near(found.high_95, 3.0 / 100.0, 1e-12);
    let frequency = asked.frequency.clone().unwrap();
    let mean = 3.0 * frequency.per_year() / frequency.weights(1100).effective_rocks();
    let (mut honest, mut plain) = (0, 0);
    // 2.2 rocks of the heaviest stratum are expected: none is seen one time in nine
    let reach = 2.2 / 100.0;
    const RUNS: u64 = 4000;
    for seed in 0..RUNS {
        let passes = |index: &usize| {
            index % 11 == 0 && unit(&mut stream(seed, Purpose::Start, *index)) < reach
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

/// With one stratum the interval of a frequency is that of the proportion, Wilson's, times the events a year.
#[test]
fn equal_weights_give_the_interval_of_a_proportion() {
    let events = Source { name: "wall".to_owned(), law: Law::Events { per_year: 0.05 } };
    let asked = asked(vec![events]);
    for passing in [1, 7, 30, 59, 60] {
        let rows: Vec<CrossingRow> =
            (0..passing).map(|index| row(index, "road", 1.0, 1e5)).collect();
        let place = road(&asked, 60, &rows);
        let share = rockfall::hazard::Proportion::new(passing, 60);
        assert_eq!(place.conditional_on_release, share);
        let rate = place.without_barriers.passages;
        near(rate.per_year, 0.05 * share.share, 1e-12);
        near(rate.low_95, 0.05 * share.low_95, 1e-9);
        near(rate.high_95, 0.05 * share.high_95, 1e-9);
    }
}

/// Weighted mean and percentiles of a quantity that depends on size and chance, over the rocks that pass. The intervals
/// take rocks as independent; that sizes are spread evenly makes them a little too wide, never too narrow.
#[test]
fn weighted_means_and_percentiles_are_covered() {
    let (a, b, c) = (0.1, 0.5, 0.25);
    let asked = asked(vec![power_law(a, b)]);
    let frequency = asked.frequency.clone().unwrap();
    let value = |volume: f64, chance: f64| volume.powf(c) * (0.5 + chance);
    // E[V^c] = b/(c − b) (V₁^(c−b) − V₀^(c−b)) / (V₀^−b − V₁^−b), E[0.5 + u] = 1
    let moment = |p: f64| 100_f64.powf(p) - 0.1_f64.powf(p);
    let mean = b / (c - b) * moment(c - b) / -moment(-b);
    let exact = quantiles(|volume, chance| value(volume, chance), b);
    let weights = frequency.weights(1200);
    let (mut means, mut inside) = (0, [0; 2]);
    const RUNS: u64 = 1000;
    for seed in 0..RUNS {
        let pairs = (0..1200).filter_map(|index| {
            let mut chance = stream(seed, Purpose::Size, index);
            let volume = frequency.stratum(index).quantile_m3(unit(&mut chance)).unwrap();
            let passes = unit(&mut chance) < REACH;
            let weight = weights.of_release(index);
            passes.then(|| (value(volume, unit(&mut chance)), weight))
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
    for count in [means, inside[0], inside[1]] {
        let share = f64::from(count) / RUNS as f64;
        assert!((0.93..=0.99).contains(&share), "{share}");
    }
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

/// The first net on a rock's way keeps it away: without and with it and what it saves add up, and a rock that the net
/// cannot hold goes on. By hand: of four rocks of 0.01 a year two are stopped, one breaks through, one passes beside.
#[test]
fn what_a_barrier_saves_is_the_difference() {
    let law = Law::Events { per_year: 0.04 };
    let asked = asked(vec![Source { name: "wall".to_owned(), law }]);
    let net = Barrier {
        name: "net".to_owned(),
        height_m: 4.0,
        capacity_j: 1e6,
        design: None,
        elsewhere: vec![],
    };
    let at_net = |index: usize, energy_j: f64| CrossingRow {
        time_s: 1.0,
        ..row(index, "net", 1.0, energy_j)
    };
    let mut rows = Vec::new();
    for (index, energy_j) in [(0, 2e5), (1, 9e5), (2, 2e6)] {
        rows.extend([row(index, "road", 1.0, energy_j), at_net(index, energy_j)]);
    }
    rows.push(row(3, "road", 1.0, 4e5));
    let place = year(&asked, 4, &rows, &[net]).places.remove(0);
    let with = place.with_barriers.unwrap();
    let saved = &place.saved[0];
    near(place.without_barriers.passages.per_year, 0.04, 1e-12);
    near(with.passages.per_year, 0.02, 1e-12);
    near(saved.passages.per_year, 0.02, 1e-12);
    near(place.without_barriers.above[0].rate.per_year, 0.03, 1e-12);
    near(with.above[0].rate.per_year, 0.02, 1e-12);
    near(saved.above[0].rate.per_year, 0.01, 1e-12);
}

/// AGS form by hand: 0.03 hits a year of rocks of 1 m³ (d = 1.2407 m) on a road with 2400 vehicles a day of 4 m at 50 km/h:
/// 2400 (4 + d)/(24 · 50 000) = 0.0104814 of the time one is in the way.
#[test]
fn risks_are_those_found_by_hand() {
    let law = Law::Events { per_year: 0.06 };
    let mut asked = asked(vec![Source { name: "wall".to_owned(), law }]);
    let object = Object {
        name: "road".to_owned(),
        corners_m: vec![],
        width_m: Some(6.0),
        occupancy: None,
        vulnerability: Some(0.25),
        persons: Some(1.5),
        vehicles: Some(Vehicles {
            per_day: 2400.0,
            speed_km_h: 50.0,
            length_m: 4.0,
            own_per_day: Some(2.0),
        }),
    };
    asked.objects = vec![object.clone()];
    let rows: Vec<CrossingRow> = (0..5).map(|index| row(index, "road", 1.0, 4e5)).collect();
    let risk_of = |place: &AnnualPlace, kind: RiskKind| {
        let found = place.without_barriers.risks.iter().find(|risk| risk.kind == kind);
        found.unwrap().rate
    };
    let place = road(&asked, 10, &rows);
    let diameter = 2.0 * (0.75 / std::f64::consts::PI).cbrt();
    let in_the_way = 2400.0 * (4.0 + diameter) / (24.0 * 50e3);
    near(in_the_way, 0.010_481_4, 1e-5);
    let hits = risk_of(&place, RiskKind::VehiclesHit);
    near(hits.per_year, 0.03 * in_the_way, 1e-12);
    near(risk_of(&place, RiskKind::Deaths).per_year, 0.03 * in_the_way * 1.5 * 0.25, 1e-12);
    let own = 0.03 * in_the_way / 1200.0;
    near(risk_of(&place, RiskKind::Individual).per_year, own * 0.25, 1e-12);
    // the interval is that of the hits of the road: all rocks are alike
    let passages = place.without_barriers.passages;
    near(hits.high_95 / hits.per_year, passages.high_95 / passages.per_year, 1e-9);

    asked.objects =
        vec![Object { vehicles: None, occupancy: Some(0.6), persons: Some(3.0), ..object }];
    let place = road(&asked, 10, &rows);
    near(risk_of(&place, RiskKind::PersonHit).per_year, 0.03 * 0.6, 1e-12);
    near(risk_of(&place, RiskKind::Individual).per_year, 0.03 * 0.6 * 0.25, 1e-12);
    near(risk_of(&place, RiskKind::Deaths).per_year, 0.03 * 0.6 * 0.25 * 3.0, 1e-12);
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

/// Inside a stratum sizes follow the law: over all strata N(≥ V) is that of the power law, whatever the strata.
#[test]
fn strata_together_are_the_law() {
    let asked = asked(vec![power_law(0.1, 0.7)]);
    let frequency = asked.frequency.unwrap();
    let releases = 20_000 * frequency.strata().len();
    let weights = frequency.weights(releases);
    for least in [0.1, 0.37, 2.0, 30.0] {
        let more = |index: &usize| {
            let p = ((index / frequency.strata().len()) as f64 + 0.5) / 20_000.0;
            frequency.stratum(*index).quantile_m3(p).unwrap() >= least
        };
        let found: f64 = (0..releases).filter(more).map(|at| weights.of_release(at)).sum();
        near(found, 0.1 * (least.powf(-0.7) - 100_f64.powf(-0.7)), 1e-3);
    }
    assert!(weights.effective_rocks() < releases as f64);
}
