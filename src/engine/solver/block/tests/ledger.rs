//! What contacts of a block with springs are said to have taken.

use super::springs::{SCHEMES, on_springs};
use super::*;

/// A slope of 1 : 2 of cells of a metre, with heights off by up to 0.17 m.
fn uneven() -> Terrain {
    let at = |i: u32, j: u32| {
        let (x, y) = (f64::from(i), f64::from(j));
        Vec3::new(x - 10.0, y - 10.0, 0.17 * sin(12.9 * x + 78.2 * y) - 0.5 * (x - 10.0))
    };
    let cell = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    terrain((0..40).flat_map(|i| (0..20).map(move |j| (i, j))).flat_map(cell).collect())
}

/// Without dashpots and friction nothing is taken and nothing made, however often features come and go within a step, as a box
/// strikes folds with its corners, edges and faces. By sums over steps 5e-4 of its energy was booked as damping.
#[test]
fn dashpots_that_are_not_there_take_nothing_of_a_block() {
    let mut impacts = 0;
    let schemes = SCHEMES.into_iter().filter(|scheme| !scheme.has_fixed_step());
    for (scheme, k) in schemes.flat_map(|scheme| (0..8_u8).map(move |k| (scheme, k))) {
        let x = f64::from(k);
        let body = block(&box_surface([1.0, 0.7, 0.4]), 0.05);
        let made = BlockRun::new(uneven(), body, (0.0, 1.0));
        let mut case = on_springs(made, scheme, 1e11);
        let attitude = turn(&Vec3::x_axis(), 0.9 * x) * turn(&Vec3::y_axis(), 0.5);
        let start = [Vec3::new(0.3 * x, 0.7 * x - 2.0, 1.5), Vec3::new(1.0, 0.0, -1.0)];
        let mut moving = case.start(attitude, [start[0], start[1], Vec3::zeros()]);
        let before_j = case.energy_j(&moving);
        case.follow(&mut moving, 1.5, |_, _| ());
        let scale = moving.motion_j(&case.block);
        let (lost, off) = (case.lost, case.energy_j(&moving) - before_j);
        println!("{scheme:?} {k}: {lost:?}, {off:e} of {scale:e} J");
        assert!(
            lost.damping.abs() < 1e-9 * scale && off.abs() < 1e-9 * scale,
            "{scheme:?} {k}: {off:e}"
        );
        impacts += case.impacts;
    }
    assert!(impacts > 32, "{impacts}");
}
