//! Compact blocks on slopes hardly steep enough to keep them rolling: any energy that a step loses
//! stops one.

use super::springs::{SCHEMES, on_springs};
use super::*;
use std::f64::consts::TAU;

/// Number of blocks.
const BLOCKS: u32 = 24;
/// How long they roll (s).
const ROLLS_S: f64 = 15.0;

/// EOTA111 of 0.4 m on 2.8°, friction 35°, e = 0.4; blows below 0.02 m/s do not rebound.
fn gentle_slope() -> BlockRun {
    let surface = eota([0.73; 3]);
    let made = block(&surface, 0.06);
    let mut case = BlockRun::new(slope(2.8_f64.to_radians(), 100.0), made, (0.7, 0.4));
    case.law = law_of(&case.ground, &case.block, 0.02);
    case
}

/// Mean distance (m) that they travel in [`ROLLS_S`], from 1.5 m/s, and how many roll then.
fn roll(made: impl Fn(BlockRun) -> BlockRun) -> (f64, u32) {
    let (along, up) = axes(2.8_f64.to_radians());
    let (mut way_m, mut rolling) = (0.0, 0);
    for k in 0..BLOCKS {
        let mut case = made(gentle_slope());
        let x = f64::from(k) / f64::from(BLOCKS);
        let attitude = turn(&Vec3::x_axis(), TAU * x) * turn(&Vec3::z_axis(), 5.0 * TAU * x);
        let start = [up * 0.45, along * 1.5, Vec3::new(x - 0.5, 3.7, 0.0)];
        let mut state = case.start(attitude, start);
        case.follow(&mut state, ROLLS_S, |_, _| ());
        way_m += state.pose.centre.dot(&along) / f64::from(BLOCKS);
        rolling += u32::from(state.v.norm() > 0.02);
    }
    (way_m, rolling)
}

/// They continue to roll with `rigid` as with springs. When the penetration of corners that were
/// too slow to rebound was recovered within one step, they were thrown up: a block rocked between
/// the two corners on which it rolled, until hardly any had the energy to pass the next edge.
#[test]
fn compact_blocks_roll_on_down_a_gentle_slope() {
    let [rigid, fine] = [0.01, 0.002].map(|step_s| roll(|case| BlockRun { step_s, ..case }));
    let springs = roll(|case| on_springs(case, SCHEMES[0], 1e10));
    println!("{rigid:?} {fine:?} {springs:?}");
    for (way_m, rolling) in [rigid, fine] {
        assert!((way_m / springs.0 - 1.0).abs() < 0.15, "{way_m} {springs:?}");
        assert!(rolling + BLOCKS / 4 > springs.1, "{rolling} {springs:?}");
    }
}
