//! While a rock falls no memory is taken: not once after the first rocks have made room, whatever the scheme.
//!
//! Counted by the allocator of a small crate, on this thread alone: counting needs `unsafe`, which this crate forbids
//! itself.

// the slope on which the developers' bench measures: no allocation counts where speed does
#[path = "../bench/src/speed/slope.rs"]
#[allow(dead_code, unreachable_pub, reason = "the bench uses more of it")]
mod slope;
mod yearly;

use allocation_counter::measure;
use nalgebra::Rotation3;
use rockfall::body::{Block, Shape, ShapeKind, Solid, eota};
use rockfall::ground::Ground;
use rockfall::hazard::{Barrier, CrossingRow, annual};
use rockfall::release::DrawnShape;
use rockfall::simulation::{RecordOptions, RunSettings, Scratch, Stop, simulate, simulate_block};
use rockfall::solver::Scheme;
use rockfall::study::bench::settings;
use slope::{SCHEMES, Slope};
use std::convert::Infallible;
use yearly::{asked, line, power_law, row};

/// Rocks that make room, and rocks that must find it.
const WARM: usize = 12;
/// Blocks that make room: the most contacts at once are met by few.
const WARM_BLOCKS: usize = 120;
const COUNTED: usize = 24;
/// `dda` at 1e-5 s takes a second for a journey; allocations do not ask for the step's length.
const DDA_STEP_S: f64 = 1e-3;
/// Nor for the tolerance (m/s): a block of the finest scheme takes a quarter of a second at its usual one.
const BLOCK_TOLERANCE_M_S: f64 = 1e-4;

#[test]
fn no_memory_is_taken_while_a_rock_falls() {
    let slope = Slope::of(10_000);
    for (scheme, fineness) in SCHEMES {
        let fineness = if scheme == Scheme::Dda { DDA_STEP_S } else { fineness };
        let rocks = if scheme == Scheme::Reference { COUNTED / 4 } else { COUNTED };
        let step = settings(scheme, fineness, None);
        let course: RunSettings = slope.course(&step);
        let mut scratch = Scratch::default();
        for index in 0..WARM {
            slope.fall(&step, index, &mut scratch);
        }
        let (mut steps, mut leaps) = (0, 0);
        for index in WARM..WARM + rocks {
            let release = slope.release(index);
            let random = rockfall::random::stream(7, rockfall::random::Purpose::Impacts, index);
            let keep = RecordOptions { path_step_s: None, impacts: false };
            let mut fallen = None;
            let taken = measure(|| {
                fallen = Some(simulate(&course, &release, keep, random, &mut scratch));
            });
            let fallen = fallen.expect("it has fallen");
            assert!(!matches!(fallen.stop, Stop::Failed(_)), "{:?}", fallen.stop);
            assert_eq!(
                (taken.count_total, taken.bytes_total),
                (0, 0),
                "{}, rock {index}: {taken:?}",
                scheme.name()
            );
            steps += fallen.effort.steps;
            leaps += fallen.effort.leaps;
        }
        // it was not for want of a fall
        assert!(steps > 100 * rocks as u64 && leaps > 10 * rocks as u64, "{steps} {leaps}");
    }
}

/// The same of blocks, in contact with springs and in the rigid limit.
#[test]
fn no_memory_is_taken_while_a_block_falls() {
    let slope = Slope::of(10_000);
    let surface = eota([1.0, 1.0, 0.5]);
    let shape = Shape::of(&Solid::of(&surface), &surface.points, 0.1).expect("a body");
    for (scheme, fineness) in SCHEMES {
        let fineness = match scheme {
            Scheme::Dda => DDA_STEP_S,
            Scheme::Reference => BLOCK_TOLERANCE_M_S,
            Scheme::Adaptive | Scheme::Rigid => fineness,
        };
        let step = settings(scheme, fineness, None);
        let course: RunSettings = slope.course(&step);
        let mut scratch = Scratch::default();
        let mut fall = |index: usize| {
            let mut release = slope.release(index);
            let block = Block::new(&shape, &release.rock);
            release.motion.position_m.z += block.bound_m - release.rock.radius_m;
            let stiff = |ground: &Ground| Ground {
                rolling_friction: 0.0,
                normal_stiffness_n_m: 2e10,
                shear_stiffness_n_m: 5e9,
                ..*ground
            };
            release.grounds = release.grounds.iter().map(stiff).collect();
            let attitude = Rotation3::from_euler_angles(index as f64, 0.7, 0.3);
            let drawn = DrawnShape { kind: ShapeKind::Eota221, sides: [1.0; 2], block, attitude };
            let random = rockfall::random::stream(7, rockfall::random::Purpose::Impacts, index);
            let keep = RecordOptions { path_step_s: None, impacts: false };
            let mut steps = 0;
            let taken = measure(|| {
                let fallen =
                    simulate_block(&course, (&release, &drawn), keep, random, &mut scratch);
                assert!(!matches!(fallen.stop, Stop::Failed(_)), "{:?}", fallen.stop);
                steps = fallen.effort.steps;
            });
            (taken, steps)
        };
        for index in 0..WARM_BLOCKS {
            fall(index);
        }
        let mut all_steps = 0;
        for index in WARM_BLOCKS..WARM_BLOCKS + COUNTED {
            let (taken, steps) = fall(index);
            all_steps += steps;
            assert_eq!(taken.count_total, 0, "{}, rock {index}: {taken:?}", scheme.name());
        }
        assert!(all_steps > 20 * COUNTED as u64, "they have hardly fallen: {all_steps}");
    }
}

/// The counter counts: a kept path takes memory.
#[test]
fn a_kept_path_takes_memory() {
    let slope = Slope::of(10_000);
    let step = settings(SCHEMES[0].0, SCHEMES[0].1, None);
    let (course, release) = (slope.course(&step), slope.release(0));
    let random = rockfall::random::stream(7, rockfall::random::Purpose::Impacts, 0);
    let keep = RecordOptions { path_step_s: Some(0.05), impacts: false };
    let mut scratch = Scratch::default();
    let taken = measure(|| {
        drop(simulate(&course, &release, keep, random, &mut scratch));
    });
    assert!(taken.count_total > 0);
}

/// Most memory taken at a time for the numbers a year of so many rocks, each of which crosses net and road (bytes); the volumes
/// of a stratum are so many.
fn most_for_a_year(releases: usize, volumes: usize) -> u64 {
    let asked = asked(vec![power_law(0.1, 0.5), power_law(0.02, 1.0)]);
    let Some(frequency) = asked.frequency.clone() else { return 0 };
    let net = Barrier {
        name: "net".to_owned(),
        height_m: 4.0,
        capacity_j: 3e5,
        design: None,
        elsewhere: vec![],
    };
    // the same volumes of every stratum again and again, so that all classes are met early
    let rows = (0..releases).flat_map(|index| {
        let p = (index / frequency.strata().len() % volumes) as f64 / volumes as f64;
        let volume_m3 = frequency.stratum(index).quantile_m3(p).unwrap_or(f64::NAN);
        let at = |name: &str, time_s: f64| CrossingRow {
            time_s,
            ..row(index, name, volume_m3, 540e3 * volume_m3)
        };
        [at("net", 1.0), at("road", 2.0)].map(Ok::<_, Infallible>)
    });
    let mut found = None;
    let taken = measure(|| {
        found = annual(&asked, releases, (&[line("net"), line("road")], &[net]), rows).ok();
    });
    let rocks = found.flatten().map(|year| year.places[1].without_barriers.passages.rocks);
    assert_eq!(rocks, Some(releases));
    taken.bytes_max
}

/// Numbers a year take memory by strata and classes of energy, not by rocks: a hundred times as many take the same. A copy of
/// one row for each of 300 000 rocks would be 60 MB.
#[test]
fn a_year_takes_no_memory_by_the_rock() {
    let [few, many] = [3_000, 300_000].map(|releases| most_for_a_year(releases, 20));
    assert!(many <= few + few / 10 && many < 4 << 20, "{few} and {many}");
    // each with an energy of its own: no more of them are told apart than there is room for
    let [few, many] = [300_000, 900_000].map(|releases| most_for_a_year(releases, releases));
    assert!(many <= few + few / 10 && many < 8 << 20, "{few} and {many}");
}
