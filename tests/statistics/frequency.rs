//! Frequencies a year against closed forms and against numbers found by hand.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::made;
use crate::yearly;

use rockfall::frequency::{Class, Frequency, FrequencyLaw, RockSource, Weights, radius_of_m3};
use rockfall::hazard::{
    AnnualPlace, Barrier, CrossingRow, MapFrame, MapState, Maps, Object, OpenRock, OpenRocks,
    RiskKind, Row, StopKind, Vehicles, YearSums, year_maps,
};
use rockfall::rock::Vec3;
use rockfall::simulation::CellPassage;
use std::convert::Infallible;
use yearly::{REACH, asked, crossings, line, near, power_law, road, row, year};

/// Derivatives against closed forms: λ = p a (V₀^−b − V₁^−b), ∂λ/∂b = p a (V₁^−b ln V₁ − V₀^−b ln V₀), a ∂λ/∂a = λ. The
/// energy of T follows from `V_T = (1/(T p a) + V₁^−b)^(−1/b)`, `e = 540 kJ/m³ · V_T`. 200 000 rocks know them to 2 %.
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

/// The same on a map of one cell: frequency, what the exponent changes of it and of the energy of 100 years. Sizes in a stratum
/// count with their mean, which where an energy cuts one through is a few per cent off.
#[test]
fn maps_carry_the_derivatives_of_the_closed_case() {
    let asked = asked(vec![power_law(0.1, 0.5)]);
    let releases = 100_000;
    let frequency = asked.frequency.clone().unwrap();
    let frame =
        MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 1.0, columns: 1, rows: 1, epsg: None };
    let mut maps = Maps::new(frame, frequency.energies_j(), MapState::default());
    for row in crossings(&asked, 8, releases) {
        let passage = CellPassage { cell: 0, total_j: row.total_j(), height_m: 0.0 };
        let stratum = u16::try_from(frequency.stratum_of(row.index)).unwrap();
        maps.add(stratum, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
    }
    let layers = year_maps(&maps, &asked, &frequency.weights(releases));
    let value = |file: &str| layers.iter().find(|layer| layer.file == file).unwrap().values[0].1;
    let slope = |low: f64| REACH * 0.1 * (100_f64.ln() / 100_f64.sqrt() - low.ln() / low.sqrt());
    near(value("frequency_per_year_by_exponent"), slope(0.1), 0.02);
    near(value("frequency_above_300kj_per_year_by_exponent"), slope(300.0 / 540.0), 0.06);
    let energy_of =
        |a: f64, b: f64| 540e3 * (1.0 / (100.0 * REACH * a) + 100_f64.powf(-b)).powf(-1.0 / b);
    near(value("energy_T100_j"), energy_of(0.1, 0.5), 0.03);
    let step = 1e-4;
    let by_rate =
        (energy_of(0.1 + 0.1 * step, 0.5) - energy_of(0.1 - 0.1 * step, 0.5)) / (2.0 * step);
    let by_exponent = (energy_of(0.1, 0.5 + step) - energy_of(0.1, 0.5 - step)) / (2.0 * step);
    near(value("energy_T100_j_by_log_rate"), by_rate, 0.25);
    near(value("energy_T100_j_by_exponent"), by_exponent, 0.25);
    // without power law nothing changes with an exponent
    let law = FrequencyLaw::Events { per_year: 0.1 };
    let plain = self::asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let maps = Maps::new(frame, frequency.energies_j(), MapState::default());
    assert!(
        year_maps(&maps, &plain, &Weights::equal(releases))
            .iter()
            .all(|one| !one.file.ends_with("by_exponent"))
    );
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

/// With one stratum the interval of a frequency is that of the proportion, Clopper and Pearson's, times the events a year.
#[test]
fn equal_weights_give_the_interval_of_a_proportion() {
    let events =
        RockSource { name: "wall".to_owned(), law: FrequencyLaw::Events { per_year: 0.05 } };
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

/// The first net on a rock's way keeps it away: without and with it and what it saves add up, and a rock that the net
/// cannot hold goes on. By hand: of four rocks of 0.01 a year two are stopped, one breaks through, one passes beside.
#[test]
fn what_a_barrier_saves_is_the_difference() {
    let law = FrequencyLaw::Events { per_year: 0.04 };
    let asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
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
    let law = FrequencyLaw::Events { per_year: 0.06 };
    let mut asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
    // the scene's rocks are all of 1 m³
    asked.largest_m = vec![radius_of_m3(1.0)];
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

/// A barrier a year by hand: of four rocks of 0.01 a year that come to the net two are stopped, one breaks through, one goes
/// over; a fifth is stopped by the net above and never arrives. The object behind is spared the risk of what is stopped.
#[test]
fn a_barrier_has_its_own_numbers_a_year() {
    let law = FrequencyLaw::Events { per_year: 0.05 };
    let mut asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
    asked.objects = vec![house("road")];
    let net = |name: &str, height_m: f64| Barrier {
        name: name.to_owned(),
        height_m,
        capacity_j: 1e6,
        design: None,
        elsewhere: vec![],
    };
    let at = |index: usize, name: &str, time_s: f64, energy_j: f64| CrossingRow {
        time_s,
        ..row(index, name, 1.0, energy_j)
    };
    let over = CrossingRow { height_m: 3.5, ..at(3, "lower", 1.0, 1e5) };
    let mut rows = vec![at(0, "lower", 1.0, 2e5), at(1, "lower", 1.0, 9e5)];
    rows.extend([
        at(2, "lower", 1.0, 2e6),
        over,
        at(4, "upper", 0.5, 1e5),
        at(4, "lower", 1.0, 1e5),
    ]);
    for index in 0..5 {
        rows.push(at(index, "road", 2.0, 1e5));
    }
    rows.sort_by_key(|row| row.index);
    let found = year(&asked, 5, &rows, &[net("upper", 4.0), net("lower", 4.0)]);
    let [upper, lower] = &found.barriers[..] else { panic!("two barriers") };
    near(upper.stopped.per_year, 0.01, 1e-12);
    for (rate, rocks) in
        [(&lower.arriving, 4), (&lower.stopped, 2), (&lower.through, 1), (&lower.over, 1)]
    {
        assert_eq!(rate.rocks, rocks);
        near(rate.per_year, 0.01 * f64::from(u32::try_from(rocks).unwrap()), 1e-12);
        assert!(rate.low_95 < rate.per_year && rate.per_year < rate.high_95);
    }
    let place = &found.places[0];
    let deaths = |risks: &[rockfall::hazard::Risk]| {
        risks.iter().find(|risk| risk.kind == RiskKind::Deaths).unwrap().rate
    };
    let with = place.with_barriers.as_ref().unwrap();
    let saved = [0, 1].map(|net| deaths(&place.saved[net].risks).per_year);
    near(saved[0], 0.01 * 0.5 * 0.2 * 3.0, 1e-12);
    near(saved[1], 2.0 * saved[0], 1e-12);
    let left = deaths(&with.risks).per_year;
    near(deaths(&place.without_barriers.risks).per_year, left + saved[0] + saved[1], 1e-12);
    // what it saves has the interval of what it stops
    let rate = place.saved[1].passages;
    near(deaths(&place.saved[1].risks).high_95 / saved[1], rate.high_95 / rate.per_year, 1e-9);
}

fn house(name: &str) -> Object {
    Object {
        name: name.to_owned(),
        corners_m: vec![],
        width_m: None,
        occupancy: Some(0.5),
        vulnerability: Some(0.2),
        persons: Some(3.0),
        vehicles: None,
    }
}

/// No rock hits the road: traffic has a one-sided bound of its own, as if three of the rocks had come that weigh most by what
/// they stand for and block. By hand: 1100 rocks, 0.5 a year of 2 m³ and 0.01 a year of 50 m³, 550 each.
#[test]
fn traffic_that_nothing_hit_has_a_bound() {
    let class = |volume: f64, per_year: f64| Class { volume_m3: [volume; 2], per_year };
    let law = FrequencyLaw::Classes(vec![class(2.0, 0.5), class(50.0, 0.01)]);
    let mut asked = asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let vehicles = Vehicles { per_day: 1000.0, speed_km_h: 50.0, length_m: 4.0, own_per_day: None };
    asked.objects = vec![Object {
        vehicles: Some(vehicles),
        width_m: Some(6.0),
        occupancy: None,
        persons: None,
        vulnerability: None,
        ..house("road")
    }];
    let hits = road(&asked, 1100, &[]).without_barriers.risks[0];
    assert_eq!((hits.kind, hits.rate.rocks), (RiskKind::VehiclesHit, 0));
    assert!(hits.rate.per_year.abs() < f64::EPSILON && hits.rate.low_95.abs() < f64::EPSILON);
    let diameter = |volume: f64| 2.0 * (0.75 * volume / std::f64::consts::PI).cbrt();
    let per_m = 1000.0 / (24.0 * 50e3);
    let [most, rare] = [(2.0, 0.5), (50.0, 0.01)].map(|(v, a)| per_m * (4.0 + diameter(v)) * a);
    let unseen = |heaviest: f64, all: f64| all * (1.0 - 0.05_f64.powf(heaviest / all));
    near(hits.rate.high_95, unseen(most / 550.0, most + rare), 1e-12);
    // sizes of the scene: its largest rock is told with what is asked
    asked.frequency = Some(Frequency::new(
        vec![RockSource { name: "wall".to_owned(), law: FrequencyLaw::Events { per_year: 0.2 } }],
        vec![],
        vec![],
    ));
    asked.largest_m = vec![1.5];
    let hits = road(&asked, 600, &[]).without_barriers.risks[0];
    let all = per_m * (4.0 + 3.0) * 0.2;
    near(hits.rate.high_95, unseen(all / 600.0, all), 1e-12);
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

/// 200 rocks of 0.3 events a year none of which has come, as their time was up: between none and all of them would. With any
/// energy that their class can have; beyond it none.
#[test]
fn rocks_still_on_their_way_leave_the_year_open() {
    let law = FrequencyLaw::Events { per_year: 0.3 };
    let mut asked = self::asked(vec![RockSource { name: "wall".to_owned(), law }]);
    asked.most_j = vec![1e5];
    let row = row(0, "road", 1.0, 1.0);
    let way = |index: usize| Row {
        index,
        stop: StopKind::TimeUp,
        end_m: row.position_m,
        ..Row::of(&made::fall(1), Vec3::zeros())
    };
    let lines = [line("road")];
    let rocks = |some: std::ops::Range<usize>| some.filter_map(|k| OpenRock::of(&way(k))).collect();
    let found = |some: std::ops::Range<usize>| {
        let none = std::iter::empty::<Result<CrossingRow, Infallible>>();
        let open = OpenRocks::find(rocks(some), (&lines, |_: &CrossingRow| None), none).unwrap();
        let mut year = YearSums::new(&asked, &lines, &[]).unwrap();
        year.leave_open(&open);
        let weights = asked.frequency.as_ref().unwrap().weights(200);
        year.said(weights).places.remove(0).without_barriers
    };
    let (closed, open) = (found(0..0), found(0..200));
    near(closed.passages.high_95, 0.3 * (1.0 - 0.05_f64.powf(1.0 / 200.0)), 1e-12);
    near(open.passages.high_95, 0.3, 1e-12);
    assert!(open.passages.per_year == 0.0 && open.passages.censored && !closed.passages.censored);
    // the last energy asked for is more than such a rock can have
    let above = open.above.last().unwrap();
    assert!(above.energy_j > 1e5 && above.rate.high_95 == 0.0, "{above:?}");
    assert!(open.returns.iter().any(|one| one.high_95.is_some_and(|joule| joule > 9e4)));
    assert!(closed.returns.iter().all(|one| one.high_95 <= Some(1e5)));
}
