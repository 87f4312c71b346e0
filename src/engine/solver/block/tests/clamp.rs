//! A block clamped between two walls.

use super::springs::{FINEST, on_springs};
use super::*;
use nalgebra::{Quaternion, UnitQuaternion};

/// A chute along the falling diagonal of y and z, whose walls rise 8 m for each metre that they go
/// apart to one side.
fn chute() -> Terrain {
    let wall = |side: f64| {
        let at = |y: f64, up: f64| Vec3::new(-side * up, y, 8.0 * up - y);
        let [a, b, c, d] = [at(0.0, 0.0), at(30.0, 0.0), at(30.0, 2.0), at(0.0, 2.0)];
        if side > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] }
    };
    terrain([1.0, -1.0].into_iter().flat_map(wall).collect())
}

/// The tangent of 30°.
fn has_friction() -> f64 {
    3_f64.sqrt().recip()
}

/// A box that falls through a chute strikes one wall with a corner and half a millisecond later the
/// other with another; the line between them lies within both friction cones. On springs of any
/// stiffness they jam each other, and the box rotates about that line, which changes the velocity
/// of its centre from 1.8 m/s along the chute to 1.2 m/s within 8 ms. With contacts that only push
/// it flew on at 1.87 m/s.
#[test]
fn a_box_turns_about_two_corners_that_walls_clamp() {
    let turned_after = |p_n: Option<f64>| {
        let surface = box_surface([1.0, 0.8, 0.6]);
        let shape = Shape::of(&Solid::of(&surface), &surface.points, 0.3).unwrap();
        let rock = Rock { radius_m: 0.290_623_446_716_694_93, density_kg_m3: 2700.0 };
        let case = BlockRun::new(chute(), Block::new(&shape, &rock), (has_friction(), 0.0));
        let mut case = match p_n {
            Some(p_n) => on_springs(case, FINEST, p_n),
            None => case,
        };
        let turn = Quaternion::new(0.606_328_5, 0.292_536_9, -0.061_770_8, -0.736_866_5);
        let turn = UnitQuaternion::from_quaternion(turn);
        let mut state = case.start(
            turn.to_rotation_matrix(),
            [
                Vec3::new(0.018_523_949, 3.834_539_955, -1.418_586_232),
                Vec3::new(-1.145_479_999, 1.812_452_269, -8.979_271_245),
                Vec3::new(-0.410_628_258, -6.011_950_182, -1.105_215_510),
            ],
        );
        let before_j = case.energy_j(&state);
        case.follow(&mut state, 0.025, |_, _| ());
        let gained_j = case.energy_j(&state) + case.lost.sum() - before_j;
        (state.v, state.spin(&case.block) * case.block.bound_m, gained_j / before_j.abs())
    };
    let rigid = turned_after(None);
    println!("{rigid:?}");
    assert!(rigid.2.abs() < 1e-9, "{:e}", rigid.2);
    for p_n in [1e12, 1e14] {
        let springs = turned_after(Some(p_n));
        println!("{p_n:e} {springs:?}");
        let off = (springs.0 - rigid.0).norm() + (springs.1 - rigid.1).norm();
        assert!(off < 0.05, "{p_n:e}: {off}");
    }
}
