//! Rocks that were not released, and those that may still come: what they do to shares, by hand.

use crate::made;
use crate::yearly;

use made::{fall, info};
use rockfall::frequency::{Frequency, FrequencyLaw, RockSource};
use rockfall::hazard::{
    CrossingRow, Hazard, Line, LineFloor, LineInfo, MapFrame, OpenRock, OpenRocks, Proportion,
    Quantity, Row, RowBounds, StopKind, YearSums,
};
use rockfall::rock::Vec3;
use rockfall::study::target_precision::TargetPrecision;
use std::convert::Infallible;
use yearly::near;

/// By hand: of four releases of each of two sources with 0.3 events a year, three of the second find no place to start
/// from. Its one rock stands for all 0.3, and those of the first for a quarter each: a line that this one and two of the
/// first cross is reached by (0.3 + 2/4 · 0.3)/0.6 of the events.
#[test]
fn rocks_that_were_not_released_count_in_no_share() {
    let source = |name: &str| RockSource {
        name: name.to_owned(),
        law: FrequencyLaw::Events { per_year: 0.3 },
    };
    let frequency = Frequency::new(vec![source("wide"), source("steep")], vec![], vec![]);
    let mut hazard = Hazard::default().weighing(Some(frequency.clone()));
    let mut line = Line::new(info(1).lines[0].clone()).weighing(Some(frequency.weights(8)));
    for index in 0..8 {
        let stop =
            if [3, 5, 7].contains(&index) { StopKind::NotReleased } else { StopKind::AtRest };
        hazard.add(&Row { index, stop, ..Row::of(&fall(1), Vec3::zeros()) });
        if [0, 1, 2].contains(&index) {
            let way = &fall(1);
            let row = CrossingRow::of((index, &way.rock), &way.crossings[0], "road", Vec3::zeros());
            line.add(&row);
        }
    }
    let weights = hazard.year_weights().unwrap();
    assert_eq!((hazard.released(), weights.rocks(0), weights.rocks(1)), (5, 4, 1));
    line.weigh(Some(&weights));
    let reach = line.reach(hazard.released());
    assert_eq!((reach.count, reach.of), (3, 5));
    assert!((reach.share - 0.75).abs() < 1e-12, "{reach:?}");
    assert!(hazard.missing_events().is_empty());
    // without sources the three are simply of five
    let plain = line.clone().weighing(None).reach(5);
    assert_eq!(plain, Proportion::new(3, 5));
}

/// A source of which nothing is released is said first: its events are in no number.
#[test]
fn a_source_that_releases_nothing_is_said() {
    let source = |name: &str| RockSource {
        name: name.to_owned(),
        law: FrequencyLaw::Events { per_year: 0.3 },
    };
    let frequency = Frequency::new(vec![source("wide"), source("steep")], vec![], vec![]);
    let mut hazard = Hazard::default().weighing(Some(frequency));
    for index in 0..8 {
        let stop = if index % 2 == 1 { StopKind::NotReleased } else { StopKind::AtRest };
        hazard.add(&Row { index, stop, ..Row::of(&fall(1), Vec3::zeros()) });
    }
    let missing = hazard.missing_events();
    assert!(missing.len() == 1 && missing[0].contains("“steep”"), "{missing:?}");
    assert!(
        rockfall::report::headline(&hazard, None).iter().any(|line| line.contains(&missing[0]))
    );
}

/// By hand, with a line across the way to the south at y = 0: what has not crossed it may still come when its time was up, and
/// when it left the terrain towards the line; not at rest, and not when the line lies behind it. 10 of 100 rocks cross, 40
/// may: the share is 0.1 or more, and its upper end is that of 50 of 100.
#[test]
fn rocks_that_may_still_come_move_the_upper_end() {
    let info = LineInfo {
        name: "road".to_owned(),
        length_m: 40.0,
        corners_m: vec![[0.0, 0.0], [40.0, 0.0]],
        of_barrier: false,
        floor: None,
    };
    let (south, up) = ([0.0, -5.0, -1.0], [20.0, 30.0, 0.0]);
    let ends = [
        (StopKind::AtRest, up, [0.0; 3], false),
        (StopKind::TimeUp, up, [0.0, 5.0, 0.0], true),
        (StopKind::Failed, up, [0.0, 5.0, 0.0], true),
        (StopKind::LeftTerrain, up, south, true),
        (StopKind::LeftTerrain, [20.0, -30.0, 0.0], south, false),
        (StopKind::LeftTerrain, up, [0.0, 0.0, -9.0], true),
        (StopKind::NotReleased, up, south, false),
    ];
    for (stop, end_m, end_velocity_m_s, expected) in ends {
        let row =
            Row { index: 7, stop, end_m, end_velocity_m_s, ..Row::of(&fall(1), Vec3::zeros()) };
        let rocks = OpenRock::of(&row).into_iter().collect();
        let lines = std::slice::from_ref(&info);
        let none = std::iter::empty::<Result<CrossingRow, Infallible>>();
        let open = OpenRocks::find(rocks, (lines, |_: &CrossingRow| None), none).unwrap();
        assert_eq!(open.at("road").count() == 1, expected, "{stop:?} {end_velocity_m_s:?}");
    }
    let mut line = Line::new(info);
    for index in 0..10 {
        let way = &fall(1);
        line.add(&CrossingRow::of((index, &way.rock), &way.crossings[0], "road", Vec3::zeros()));
    }
    let seen = line.reach(100);
    assert_eq!(line.may_still_come(100), None);
    line.leave_open(10..50);
    assert_eq!(line.may_still_come(100), Some(Proportion::new(40, 100)));
    let reach = line.reach(100);
    let far = Proportion::new(50, 100);
    assert_eq!((reach.count, reach.low_95, reach.high_95), (10, seen.low_95, far.high_95));
    assert!(!seen.censored && reach.censored);
    // one more rock than chance knows of is no reason for a mark
    line.leave_open(10..11);
    assert!(!line.reach(100).censored && line.reach(100).high_95 > seen.high_95);
}

/// By hand: with 10 m/s a rock rises 5.1 m, with 15 m/s 11.5 m, so a line 8 m above its end is out of its reach in the first case,
/// however the ground beyond may be. A failed rock has no energy to trust, and of a line without a known floor nothing is known.
#[test]
fn no_rock_comes_to_a_line_above_what_its_energy_lifts_it_to() {
    let floor = LineFloor { ground_m: 508.0, gravity_m_s2: 9.81 };
    let may_come = |stop: StopKind, speed_m_s: f64, floor: Option<LineFloor>| {
        let info = LineInfo {
            name: "road".to_owned(),
            length_m: 40.0,
            corners_m: vec![[0.0, 0.0], [40.0, 0.0]],
            of_barrier: false,
            floor,
        };
        let row = Row {
            stop,
            end_m: [20.0, 30.0, 500.0],
            end_velocity_m_s: [0.0, -speed_m_s, 0.0],
            end_spin_rad_s: [0.0; 3],
            springs_j: 0.0,
            ..Row::of(&fall(1), Vec3::zeros())
        };
        let lines = std::slice::from_ref(&info);
        let none = std::iter::empty::<Result<CrossingRow, Infallible>>();
        let rocks = OpenRock::of(&row).into_iter().collect();
        let open = OpenRocks::find(rocks, (lines, |_: &CrossingRow| None), none).unwrap();
        open.at("road").count() == 1
    };
    for stop in [StopKind::LeftTerrain, StopKind::TimeUp, StopKind::OverBudget] {
        assert!(!may_come(stop, 10.0, Some(floor)), "{stop:?}");
        assert!(may_come(stop, 15.0, Some(floor)), "{stop:?}");
        assert!(may_come(stop, 10.0, None), "{stop:?}");
    }
    assert!(may_come(StopKind::Failed, 10.0, Some(floor)));
}

/// The same rocks at 10 m/s, which lifts them 5.1 m: what their spin or pressed springs hold lifts them 4 m more, over a line 8 m above their
/// end. Of a sphere that turns with `ω R` it is `(ω R)²/(5 g)`.
#[test]
fn spin_and_springs_lift_a_rock_as_speed_does() {
    let floor = Some(LineFloor { ground_m: 508.0, gravity_m_s2: 9.81 });
    let may_come = |rim_m_s: f64, springs_j_kg: f64| {
        let way = Row::of(&fall(1), Vec3::zeros());
        let row = Row {
            stop: StopKind::TimeUp,
            end_m: [20.0, 30.0, 500.0],
            end_velocity_m_s: [0.0, -10.0, 0.0],
            end_spin_rad_s: [0.0, 0.0, rim_m_s / way.radius_m],
            springs_j: springs_j_kg * way.mass_kg,
            ..way
        };
        let none = std::iter::empty::<Result<CrossingRow, Infallible>>();
        let line = LineInfo { floor, ..yearly::line("road") };
        let rocks = OpenRock::of(&row).into_iter().collect();
        let open = OpenRocks::find(rocks, (&[line], |_: &CrossingRow| None), none).unwrap();
        open.at("road").count() == 1
    };
    let (rim_m_s, springs_j_kg) = ((4.0 * 5.0 * 9.81_f64).sqrt(), 4.0 * 9.81);
    assert!(!may_come(0.0, 0.0));
    assert!(may_come(rim_m_s, 0.0) && may_come(0.0, springs_j_kg));
    // 2 m more are too few
    assert!(!may_come(0.5_f64.sqrt() * rim_m_s, 0.0) && !may_come(0.0, 0.5 * springs_j_kg));
}

/// A road 10 m below where the rocks of [`may_still_come`] end.
fn road_below() -> LineInfo {
    let floor = Some(LineFloor { ground_m: 490.0, gravity_m_s2: 10.0 });
    LineInfo { floor, ..yearly::line("road") }
}

/// Rocks that were out of time at 10 m/s above that road: each may come to it with 150 J/kg.
fn may_still_come(indices: std::ops::Range<usize>, mass_kg: f64) -> OpenRocks {
    let way = |index: usize| Row {
        index,
        mass_kg,
        stop: StopKind::TimeUp,
        end_m: [0.0, 0.0, 500.0],
        end_velocity_m_s: [10.0, 0.0, 0.0],
        end_spin_rad_s: [0.0; 3],
        springs_j: 0.0,
        ..Row::of(&fall(1), Vec3::zeros())
    };
    let rocks = indices.filter_map(|k| OpenRock::of(&way(k))).collect();
    let none = std::iter::empty::<Result<CrossingRow, Infallible>>();
    OpenRocks::find(rocks, (&[road_below()], |_: &CrossingRow| None), none).unwrap()
}

/// By hand: 200 rocks of 0.3 events a year that may still come down 10 m to a line. Their energy there is m g h + m v²/2 at most: only where that
/// is 300 kJ or more do they move the upper end of the passages with so much.
#[test]
fn what_may_still_come_has_no_more_energy_than_it_left_with_and_falls_for() {
    let law = FrequencyLaw::Events { per_year: 0.3 };
    let asked = yearly::asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let lines = [road_below()];
    let high = |mass_kg: f64| {
        let open = may_still_come(0..200, mass_kg);
        let mut year = YearSums::new(&asked, &lines, &[]).unwrap();
        year.leave_open(&open);
        let weights = asked.frequency.as_ref().unwrap().weights(200);
        let place = year.said(weights).places.remove(0).without_barriers;
        [place.passages.high_95, place.above[0].rate.high_95]
    };
    // 100 + 50 J/kg: 1900 kg have 285 kJ, 2200 kg have 330 kJ
    let (light, heavy) = (high(1900.0), high(2200.0));
    near(light[0], 0.3, 1e-12);
    near(light[1], 0.3 * (1.0 - 0.05_f64.powf(1.0 / 200.0)), 1e-12);
    near(heavy[1], 0.3, 1e-12);
}

/// By hand: of 200 rocks of 0.3 events a year one has 1 MJ at a line and ten have 10 kJ; a hundred may still come, with 500 kJ at most. Once in
/// 100 years, that is of seven rocks, so the energy may be 500 kJ, though no rock had any between 10 kJ and 1 MJ; where they can
/// have 10.2 kJ it may be that, not that of the rocks seen in the same class of energy.
#[test]
fn the_energy_of_a_return_period_reaches_to_what_may_still_come() {
    let law = FrequencyLaw::Events { per_year: 0.3 };
    let asked = yearly::asked(vec![RockSource { name: "wall".to_owned(), law }]);
    let lines = [road_below()];
    // of a fall from 10 m and 10 m/s: 150 J/kg
    let high = |most_j: f64| {
        let open = may_still_come(100..200, most_j / 150.0);
        let mut year = YearSums::new(&asked, &lines, &[]).unwrap();
        for index in 0..11 {
            let energy_j = if index == 0 { 1e6 } else { 10e3 };
            year.add(&mut [yearly::row(index, "road", 1.0, energy_j)]);
        }
        year.leave_open(&open);
        let weights = asked.frequency.as_ref().unwrap().weights(200);
        let place = year.said(weights).places.remove(0).without_barriers;
        let [.., known] = &place.returns[..] else { panic!("asked for 40 and 100 years") };
        near(known.energy_j.unwrap(), 10e3, 1e-12);
        known.high_95.unwrap()
    };
    for most_j in [500e3, 10.2e3, 60e3] {
        // where the class of energy ends in which it lies: 5 %
        assert!((most_j..1.06 * most_j).contains(&high(most_j)), "{most_j}: {}", high(most_j));
    }
}

/// A map of 10 by 10 cells of 2 m: what ended on it and would have gone on is missing further on, and so is what has fallen out
/// of the terrain in the middle of the map; what left over the edge of the map, and what came to rest, is not.
#[test]
fn rocks_that_ended_on_the_map_are_missing_in_it() {
    let map =
        MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 2.0, columns: 10, rows: 10, epsg: None };
    let ends = [
        (StopKind::TimeUp, [0.5, 0.5, 0.0], true),
        (StopKind::OverBudget, [10.0, 10.0, 0.0], true),
        (StopKind::Failed, [f64::NAN, 10.0, 0.0], true),
        (StopKind::LeftTerrain, [10.0, 10.0, 0.0], true),
        (StopKind::LeftTerrain, [19.9, 10.0, 0.0], false),
        // within the cells along the edge, on whichever side
        (StopKind::LeftTerrain, [1.0, 10.0, 0.0], false),
        (StopKind::LeftTerrain, [10.0, 1.0, 0.0], false),
        (StopKind::LeftTerrain, [10.0, -0.3, 0.0], false),
        (StopKind::AtRest, [10.0, 10.0, 0.0], false),
    ];
    let mut hazard = Hazard::default();
    for (index, (stop, end_m, expected)) in ends.into_iter().enumerate() {
        let row = Row { index, stop, end_m, ..Row::of(&fall(1), Vec3::zeros()) };
        let is_missing = OpenRock::of(&row).is_some_and(|rock| rock.ended_on(&map));
        assert_eq!(is_missing, expected, "{stop:?} {end_m:?}");
        hazard.add(&row);
    }
    assert_eq!(hazard.open_on(&map), Some(Proportion::new(4, 9)));
}

/// By hand: of three sources with 0.1, 0.2 and 0.3 events a year a part of a run holds releases 4 and 5, one of the second and one of the
/// third. The one that left the terrain stands for 0.3 of the 0.5 of these two, the one at rest for 0.2, whichever numbers they have.
#[test]
fn a_part_of_a_run_weighs_its_own_rocks() {
    let source = |per_year: f64| RockSource {
        name: format!("{per_year}"),
        law: FrequencyLaw::Events { per_year },
    };
    let frequency = Frequency::new([0.1, 0.2, 0.3].map(source).into(), vec![], vec![]);
    let mut hazard = Hazard::default().weighing(Some(frequency));
    for (index, stop) in [(4, StopKind::AtRest), (5, StopKind::LeftTerrain)] {
        hazard.add(&Row { index, stop, ..Row::of(&fall(1), Vec3::zeros()) });
    }
    for (stop, share) in [(StopKind::AtRest, 0.4), (StopKind::LeftTerrain, 0.6)] {
        let found = hazard.ended(stop);
        assert_eq!((found.count, found.of), (1, 2));
        assert!((found.share - share).abs() < 1e-12, "{stop:?}: {found:?}");
    }
}

/// Of rocks with runouts of 0 to 100 m every tenth left the terrain: wherever those went, the median lies between 50 and 55.6 m, so that more
/// releases bring its interval to six metres, and to no less. P95 is one of them with any number of releases.
#[test]
fn an_aim_is_out_of_reach_only_where_open_rocks_decide_it_for_good() {
    let mut hazard = Hazard::default();
    let row = Row::of(&fall(1), info(1).origin_m);
    for index in 0..10_000 {
        let stop = if index % 10 == 3 { StopKind::LeftTerrain } else { StopKind::AtRest };
        let runout_m = 0.01 * ((index * 7919) % 10_000) as f64;
        hazard.add(&Row { index, stop, runout_m, ..row });
    }
    let refusal = |aim: &str| aim.parse::<TargetPrecision>().unwrap().refusal(&hazard);
    assert_eq!(refusal("runout.p50 < 12 m"), None);
    let said = refusal("runout.p50 < 1 m").unwrap();
    assert!(
        said.contains("1000 of 10000 rocks left") && said.contains("a wider interval"),
        "{said}"
    );
    let said = refusal("runout.p95 < 12 m").unwrap();
    assert!(said.contains("p95 of runout has an interval without an end"), "{said}");
    assert!(hazard.statistic(Quantity::Runout).percentiles["p50"].censored);
}

/// A rock that stays where it is put releases next to nothing: what rounding makes of its energy is held against a fall by a tenth of its
/// radius, `m g R/10`, and is not 700 times the energy released. One that fell keeps its own share.
#[test]
fn the_worst_rock_is_none_that_stood_still() {
    let mut hazard = Hazard::default();
    let row = Row::of(&fall(1), info(1).origin_m);
    let row = Row { radius_m: 0.4, mass_kg: 710.0, ..row };
    let stood = Row { index: 0, energy_balance_error: 700.0, remainder_j: -0.0049, ..row };
    let fell = Row { index: 1, energy_balance_error: 1e-3, remainder_j: 500.0, ..row };
    hazard.add(&stood);
    let alone = hazard.largest_balance_error().unwrap();
    let expected = 0.0049 / (710.0 * 9.81 * 0.04);
    assert!((alone.value - expected).abs() < 1e-14 * expected, "{}", alone.value);
    hazard.add(&fell);
    let worst = hazard.largest_balance_error().unwrap();
    assert_eq!((worst.release, worst.value.to_bits()), (1, 1e-3_f64.to_bits()));
}

/// By hand, a rock of 1000 kg with g = 10 m/s² that creeps at 1 m/s, 2 m over the lowest ground: 500 J and 20 kJ of fall are all that it may still have, 6.4 m/s
/// at most, 2.05 m of height. It had 30 kJ, of which 25 kJ without spin, and 5 m of height: these stay its largest, its spin of 5 kJ may not.
#[test]
fn what_a_creeping_rock_had_is_its_largest_where_no_fall_gives_it_more() {
    let floor = Some(LineFloor { ground_m: 100.0, gravity_m_s2: 10.0 });
    let row = |stop: StopKind, height_m: f64| Row {
        stop,
        mass_kg: 1000.0,
        end_m: [0.0, 0.0, 100.0 + height_m],
        end_velocity_m_s: [1.0, 0.0, 0.0],
        end_spin_rad_s: [0.0; 3],
        springs_j: 0.0,
        max_speed_m_s: 7.0,
        max_translational_j: 25e3,
        max_rotational_j: 5e3,
        max_total_j: 30e3,
        max_height_m: 5.0,
        shape: None,
        ..Row::of(&fall(1), Vec3::zeros())
    };
    let open = |row: &Row, floor| {
        let bounds = RowBounds::of(row, floor);
        let largest = [Quantity::MaxSpeed, Quantity::MaxTranslational, Quantity::MaxRotational];
        [&largest[..], &[Quantity::MaxTotal, Quantity::MaxHeight, Quantity::Impacts]]
            .concat()
            .into_iter()
            .map(|quantity| bounds.has(quantity))
            .collect::<Vec<_>>()
    };
    let creeps = row(StopKind::TimeUp, 2.0);
    assert_eq!(open(&creeps, floor), [false, false, true, false, false, true]);
    assert_eq!(open(&creeps, None), [true; 6]);
    // from 2.9 m up its fall gives 29.5 kJ: less than it had in all, more than without spin, and 7.7 m/s
    let higher = row(StopKind::OverBudget, 2.9);
    assert_eq!(open(&higher, floor), [true, true, true, false, false, true]);
    assert_eq!(open(&row(StopKind::Failed, 2.0), floor), [true; 6]);
    assert_eq!(open(&row(StopKind::AtRest, 2.0), floor), [false; 6]);
    let mut hazard = Hazard::default().over(floor);
    hazard.add(&creeps);
    let statistic = hazard.statistic(Quantity::MaxTotal);
    assert_eq!((statistic.censored, hazard.statistic(Quantity::Impacts).censored), (0, 1));
}
