//! While a rock falls no memory is taken: not once after the first rocks have made room, whatever the scheme.
//!
//! Counted by the allocator of a small crate, on this thread alone: counting needs `unsafe`, which this crate forbids
//! itself.

// the slope on which the developers' bench measures: no allocation counts where speed does
#[path = "../bench/src/speed/slope.rs"]
#[allow(dead_code, unreachable_pub, reason = "the bench uses more of it")]
mod slope;

use allocation_counter::measure;
use rockfall::simulation::{Keep, RunSettings, Scratch, Stop, simulate};
use rockfall::solver::Scheme;
use rockfall::study::bench::settings;
use slope::{SCHEMES, Slope};

/// Rocks that make room, and rocks that must find it.
const WARM: usize = 12;
const COUNTED: usize = 24;
/// `dda` at 1e-5 s takes a second for a journey; allocations do not ask for the step's length.
const DDA_STEP_S: f64 = 1e-3;

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
            let mut random = rockfall::random::stream(7, rockfall::random::Purpose::Impacts, index);
            let keep = Keep { path_step_s: None, impacts: false };
            let mut fallen = None;
            let taken = measure(|| {
                fallen = Some(simulate(&course, &release, keep, &mut random, &mut scratch));
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

/// The counter counts: a kept path takes memory.
#[test]
fn a_kept_path_takes_memory() {
    let slope = Slope::of(10_000);
    let step = settings(SCHEMES[0].0, SCHEMES[0].1, None);
    let (course, release) = (slope.course(&step), slope.release(0));
    let mut random = rockfall::random::stream(7, rockfall::random::Purpose::Impacts, 0);
    let keep = Keep { path_step_s: Some(0.05), impacts: false };
    let mut scratch = Scratch::default();
    let taken = measure(|| {
        drop(simulate(&course, &release, keep, &mut random, &mut scratch));
    });
    assert!(taken.count_total > 0);
}
