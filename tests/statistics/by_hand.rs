//! Small samples whose shares, bounds and intervals are found by hand.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::made;
use crate::yearly;

use made::fall;
use rockfall::frequency::{Frequency, FrequencyLaw, RockSource, Weights};
use rockfall::hazard::{
    Barrier, CrossingRow, Difference, Elsewhere, Layer, LineInfo, MapFrame, MapState, Maps,
    OpenRock, OpenRocks, Profile, Proportion, Reading, Row, Sample, StopKind, effective, judge,
    residual, stopping,
};
use rockfall::rock::Vec3;
use rockfall::simulation::{CellPassage, Stretch};
use std::convert::Infallible;
use yearly::{line, near};

/// A net of 3 m that holds 100 J, and its other place.
fn net() -> Barrier {
    let elsewhere = vec![Elsewhere { offset_m: 5.0, line: "net +5 m".to_owned() }];
    let (name, height_m, capacity_j) = ("net".to_owned(), 3.0, 100.0);
    Barrier { name, height_m, capacity_j, design: None, elsewhere }
}

fn passing(index: usize, line: &str) -> CrossingRow {
    CrossingRow { height_m: 3.0, height_normal_m: 2.0, ..yearly::row(index, line, 1.0, 50.0) }
}

fn rows(all: &[CrossingRow]) -> impl Iterator<Item = Result<CrossingRow, Infallible>> {
    all.iter().cloned().map(Ok)
}

/// Releases 50 to 89 were out of time: what they have not crossed they may still cross.
fn out_of_time(lines: &[LineInfo], all: &[CrossingRow]) -> OpenRocks {
    let way = |index| {
        let stop = StopKind::TimeUp;
        OpenRock::of(&Row { index, stop, ..Row::of(&fall(1), Vec3::zeros()) })
    };
    let nets = [net()];
    let rocks = (50..90).filter_map(way).collect();
    OpenRocks::find(rocks, (lines, stopping(&nets)), rows(all)).unwrap()
}

/// Of 100 rocks ten pass the road below a net and 40 were out of time. Had the net held those, none of them could still come to
/// the road: behind the net ten of 100 pass it, without the net up to 50 of 100 do.
#[test]
fn what_a_net_holds_may_not_still_come_behind_it() {
    let lines = [line("net"), line("road")];
    let mut all: Vec<CrossingRow> = (0..10).map(|index| passing(index, "road")).collect();
    // its highest point is 2 R = 1.24 m above the ground
    all.extend((50..90).map(|index| yearly::row(index, "net", 1.0, 50.0)));
    let open = out_of_time(&lines, &all);
    let found = residual(&[net()], &lines, rows(&all), (&Weights::equal(100), &open)).unwrap();
    let [road] = &found[..] else { panic!("the net's own line is none of them: {found:?}") };
    let high = |count: usize| Proportion::new(count, 100).high_95;
    near(road.without.reach.high_95, high(50), 1e-12);
    near(road.with.reach.high_95, high(10), 1e-12);
    assert!(road.without.reach.censored && !road.with.reach.censored);
    // vertical, as a road's clearance is, and not along the normal of the slope
    for side in [&road.without, &road.with] {
        near(side.height_m.max.unwrap().value, 3.0, 1e-12);
    }
}

/// Of 100 rocks ten arrive at either place of a net, and 40 may still: at both places the share is 0.1 or more, and up to that of 50.
#[test]
fn what_may_still_come_may_come_to_every_place_of_a_net() {
    let lines = [line("net"), line("net +5 m")];
    let places = |index: usize| ["net", "net +5 m"].map(|line| passing(index, line));
    let all: Vec<CrossingRow> = (0..10).flat_map(places).collect();
    let open = out_of_time(&lines, &all);
    let found = judge(&[net()], rows(&all), (&Weights::equal(100), &open)).unwrap();
    let high = Proportion::new(50, 100).high_95;
    for place in &found[0].by_place {
        assert_eq!(place.arriving.count, 10);
        near(place.arriving.high_95, high, 1e-12);
    }
    near(found[0].arriving.high_95, high, 1e-12);
}

/// Of 100 values that weigh 1 and 100 that weigh 3 each counts as 0.8: (400)²/1000 = 160 of 200. The 72 equal values that bound P95 from both
/// sides (0.95⁷² < 0.025) become 90.
#[test]
fn values_of_unlike_weight_need_more_for_an_interval() {
    let values = (0..200).map(|k| (f64::from(k), if k % 2 == 0 { 1.0 } else { 3.0 }));
    let found = Sample::weighted(values).percentile(0.95).unwrap();
    let needs = found.needs_for_interval(0.95);
    assert!((90..=91).contains(&needs), "{needs}");
    let equal = Sample::of((0..200).map(f64::from)).percentile(0.95).unwrap();
    assert_eq!(equal.needs_for_interval(0.95), 72);
}

/// Six ends of one block around 1 m and two of another around 4 m. Analysis of variance: 13.5 among and 8/6 within the blocks, with
/// `n₀ = 8 − (36 + 4)/8 = 3` ends in a typical block; the correlation within is (13.5 − 4/3)/(13.5 + 2 · 4/3) = 73/97, and
/// the eight ends are worth 8/(1 + 3 · 73/97) = 776/316.
#[test]
fn blocks_thrown_unequally_often_are_weighed_by_their_sizes() {
    let values = [0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 3.0, 5.0];
    let groups: Vec<String> = "aaaaaabb".chars().map(String::from).collect();
    near(effective(&values, &groups), 776.0 / 316.0, 1e-12);
}

/// Two rocks at 0 and 2 m/s in each of two runs: the variance of each mean is 2/2, over n − 1, so the difference of the means is known to
/// 1.96 √2 where no rock is in both.
#[test]
fn a_mean_of_two_is_known_by_the_variance_over_one_less() {
    let mean = |first: usize| Reading::mean(&[(first, 0.0), (first + 1, 2.0)]).unwrap();
    let apart = Difference::between(&mean(0), &mean(2), false);
    let (low, high) = apart.interval.unwrap();
    near(high, 1.959_964 * 2.0_f64.sqrt(), 1e-6);
    near(low, -high, 1e-12);
}

/// Rocks that were all 10 m/s fast: no bound of a percentile is above the fastest of them, though their class ends at 10.1 m/s.
#[test]
fn no_percentile_of_a_stretch_lies_above_its_largest_value() {
    let mut profile = Profile::default();
    let passed = [Stretch { number: 0, speed_m_s: 10.0, height_m: 1.0 }];
    (0..200).for_each(|_| profile.add(5.0, 0, &passed));
    let point = profile.points(&Weights::equal(200)).remove(0);
    for (found, largest) in [(point.speed_m_s, 10.0), (point.height_m, 1.0)] {
        assert!(found.median.high_95.unwrap() <= largest, "{found:?}");
        assert!(found.p95.high_95.unwrap() <= largest, "{found:?}");
    }
}

/// A hundred rocks of each of two sources pass a cell with 10 kJ, those of the second with 40 kJ. The second stands for 7 or 3 of 100
/// events: at 7 % the 95th percentile is 40 kJ, of medium intensity, at 3 % it is 10 kJ, weak.
#[test]
fn the_intensity_of_a_cell_is_that_of_the_95th_percentile_of_events() {
    let source = |per_year: f64| RockSource {
        name: format!("{per_year}"),
        law: FrequencyLaw::Events { per_year },
    };
    for (rare, class) in [(7.0, 2.0), (3.0, 1.0)] {
        let sources = [100.0 - rare, rare].map(source).into();
        let weights = Frequency::new(sources, vec![], vec![]).weights(200);
        let frame =
            MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 2.0, columns: 1, rows: 1, epsg: None };
        let mut maps = Maps::new(frame, &[], MapState::default());
        for index in 0..200 {
            let stratum = weights.stratum_of(index);
            let total_j = if stratum == 1 { 40e3 } else { 10e3 };
            let passage = CellPassage { cell: 0, total_j, height_m: 1.0 };
            maps.add(stratum as u16, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
        }
        let found: Vec<(u32, f64)> = maps.values(Layer::Intensity, &weights).collect();
        assert_eq!(found, [(0, class)], "{rare} of 100 events");
    }
}
