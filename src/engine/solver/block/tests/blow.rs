//! A blow in the rigid limit is what blows on stiffer and stiffer springs come to.

use super::springs::{FINEST, on_springs};
use super::*;
use nalgebra::Unit;

/// Velocity and spin times the largest radius (m/s) of a block that has just touched a plane, a millisecond later, without what weight has added.
fn thrown(case: &mut BlockRun, attitude: Rotation3<f64>, spin: Vec3) -> (Vec3, Vec3) {
    const AFTER_S: f64 = 1e-3;
    let corners = &case.block.core.corners;
    let lowest = corners.iter().map(|corner| (attitude * corner).z).fold(f64::MAX, f64::min);
    let centre = Vec3::z() * (case.block.ball_m - lowest + 1e-9);
    let mut moving = case.start(attitude, [centre, Vec3::new(8.0, 1.0, -6.0), spin]);
    case.follow(&mut moving, AFTER_S, |_, _| ());
    (moving.v + Vec3::z() * (G * AFTER_S), moving.spin(&case.block) * case.block.bound_m)
}

/// The difference between blow `k` of two dozen in the rigid limit and on springs of two stiffnesses, over its speed (–), of ground with a restitution: a
/// box or a prism strikes a plane with a corner, with an edge or with a face, at 10 m/s, spinning, with friction of all sizes.
fn off_the_limit(k: u8, restitution: f64) -> [f64; 2] {
    let surfaces = [box_surface([1.0, 0.7, 0.4]), prism_surface(6, 0.5)];
    let x = f64::from(k);
    let axis = Unit::new_normalize(Vec3::new(sin(x), 0.5 + cos(2.0 * x), 0.7));
    // every fourth on an edge, along which its corners strike together
    let attitude =
        if k.is_multiple_of(4) { tilted(0.3 + 0.02 * x) } else { turn(&axis, 0.4 + 0.9 * x) };
    let spin =
        if k.is_multiple_of(4) { Vec3::y() } else { Vec3::new(cos(x), sin(3.0 * x), 1.0) } * 5.0;
    let made = || {
        let body = block(&surfaces[usize::from(k % 2)], 0.05);
        let mut case = BlockRun::new(slope(0.0, 50.0), body, (0.1 + 0.05 * x, restitution));
        if k.is_multiple_of(3) {
            case.ground.restitution_half_m_s = Some(5.0);
            case.law = law_of(&case.ground, &case.block, 1e-3);
        }
        case
    };
    let (v, w) = thrown(&mut made(), attitude, spin);
    [1e11, 1e13].map(|p_n| {
        let mut case = on_springs(made(), FINEST, p_n);
        let (own_v, own_w) = thrown(&mut case, attitude, spin);
        ((own_v - v).norm() + (own_w - w).norm()) / 10.0
    })
}

/// With restitution of all sizes, also one that falls with speed, and with none. On springs a blow takes a time of order `p_N^(−1/2)`, in which
/// levers turn and weight acts: so a hundred times the stiffness leaves a tenth of the difference to the rigid limit, and nothing else is left.
/// Ground that gives nothing back is no case of its own: with impulses that stop each contact dead its blows were off by up to a third of the speed.
#[test]
fn blows_on_stiffer_springs_come_to_those_of_the_rigid_limit() {
    for rebounds in [1.0, 0.0] {
        let (mut sums, mut worst) = ([0.0; 2], 0.0f64);
        for k in 0..24_u8 {
            let off = off_the_limit(k, rebounds * (0.1 + 0.03 * f64::from(k)));
            println!("{k} {off:?}");
            worst = worst.max(off[1]);
            sums.iter_mut().zip(off).for_each(|(sum, off)| *sum += off);
        }
        // 2e-4 of the speed is what a step of the rigid limit may be wrong by; where nothing rebounds a blow is so short that little else is left
        assert!(worst < 1e-3, "{rebounds}: {worst:e}");
        let own = if rebounds > 0.0 { 0.0 } else { 24.0 * 1e-4 };
        assert!(sums[1] < 0.2 * sums[0] + own, "{rebounds}: {sums:?}");
    }
}
