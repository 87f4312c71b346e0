//! A block that slides down a slope and strikes the level at its foot: lasting contacts take part
//! in the impact of the new one.

use super::springs::{FINEST, on_springs};
use super::*;

const ANGLE: f64 = 0.61;
const SPEED_M_S: f64 = 20.0;
/// Time after which an impact is over (s): many times that of the springs here.
const OVER_S: f64 = 1e-3;

/// A slope that falls along x to a level at the origin.
fn foot() -> Terrain {
    let (along, _) = axes(ANGLE);
    let at = |x: f64, y: f64| {
        let side = Vec3::y() * (20.0 * y);
        if x < 0.0 { along * (20.0 * x) + side } else { Vec3::x() * (20.0 * x) + side }
    };
    let rows = [-1.0, 0.0, 1.0].map(|x| [at(x, -1.0), at(x, 1.0)]);
    let strip = |[a, b]: [Vec3; 2], [d, c]: [Vec3; 2]| [[a, d, c], [a, c, b]];
    let facets = [strip(rows[0], rows[1]), strip(rows[1], rows[2])];
    terrain(facets.concat())
}

/// Share of its kinetic energy (–) that a plate loses that slides flat on the slope, rotated by
/// `yaw` (rad) about its normal, when its first corner strikes the level.
fn lost(yaw: f64, (friction, e): (f64, f64), made: impl Fn(BlockRun) -> BlockRun) -> f64 {
    let plate = block(&box_surface([1.0, 0.8, 0.3]), 0.05);
    let mut case = made(BlockRun::new(foot(), plate, (friction, e)));
    let (along, up) = axes(ANGLE);
    let attitude = tilted(ANGLE) * turn(&Vec3::z_axis(), yaw);
    let reaches = |own: &Vec3| (attitude * own).dot(&along);
    let reach_m = case.block.core.corners.iter().map(reaches).fold(0.0, f64::max);
    let centre = up * 0.15 - along * (reach_m + 0.3);
    let mut state = case.start(attitude, [centre, along * SPEED_M_S, Vec3::zeros()]);
    let (own, weight_n) = (case.block.clone(), case.block.mass_kg * G);
    let (mut had_j, mut struck_s, mut left_j) = ([0.0; 2], None, None);
    case.follow(&mut state, 0.1, |now, state| {
        let motion_j = state.motion_j(&own);
        let energy_j = motion_j + weight_n * state.pose.centre.z;
        if (state.v - along * state.v.dot(&along)).norm() < 0.05 {
            had_j = [motion_j, energy_j];
        } else if *struck_s.get_or_insert(now) + OVER_S < now {
            left_j.get_or_insert(energy_j);
        }
    });
    (had_j[1] - left_j.unwrap()) / had_j[0]
}

/// Springs of lasting contacts that are loaded while others rebound keep their damping and still
/// press. With `rigid`, rounding made some of them new contacts, which rebounded although their
/// springs would not, and without friction none was damped.
#[test]
fn what_lasts_takes_part_in_a_blow() {
    for (friction, e) in [(0.0, 0.4), (0.2, 0.4), (0.2, 0.0), (0.6, 0.4)] {
        let (mut worst, mut sums) = (0.0_f64, [0.0; 2]);
        for yaw in [0.2, 0.5, 0.8, 1.1, 1.4] {
            let rigid = lost(yaw, (friction, e), |case| case);
            let springs = lost(yaw, (friction, e), |case| on_springs(case, FINEST, 1e11));
            println!("{friction} {e} {yaw}: {rigid} {springs}");
            worst = worst.max((rigid / springs - 1.0).abs());
            sums = [sums[0] + rigid, sums[1] + springs];
        }
        println!("{friction} {e}: {worst} {}", sums[0] / sums[1]);
        assert!(worst < 0.03 && (sums[0] / sums[1] - 1.0).abs() < 0.02, "{friction} {e}");
    }
}
