//! Blocks that roll, slide and balance on springs as they do in the rigid limit.

use super::cases::{finely, peak, ridge};
use super::springs::{SCHEMES, on_springs, with_long_steps};
use super::*;

/// S10.
#[test]
fn a_slap_on_springs_takes_what_it_must() {
    for sides in [4, 5, 6, 8] {
        for scheme in SCHEMES {
            for p_n in [1e10, 1e12] {
            let ball = 0.001;
            let body = block(&prism_on_its_side(sides), ball);
            let mut case = on_springs(BlockRun::new(slope(0.0, 50.0), body, (10.0, 0.0)), scheme, p_n);
            let corners = &case.block.core.corners;
            let low = corners.iter().map(|p| p.z).fold(f64::MAX, f64::min);
            let half = corners.iter().filter(|p| p.z < low + 1e-6).map(|p| p.x).fold(0.0, f64::max);
            let height = ball - low;
            let inertia = case.block.inertia_kg_m2[1] / case.block.mass_kg;
            let spin = Vec3::y();
            let arm = Vec3::new(half, 0.0, height);
            let square = height * height + half * half;
            let mut moving =
                case.start(Rotation3::identity(), [Vec3::z() * height, spin.cross(&arm), spin]);
            let time_s = 200.0 / case.law.omega_rad_s();
            let own = case.block.clone();
            let mut trace = vec![];
            case.follow(&mut moving, time_s, |t, m| trace.push((t, m.spin(&own).y)));
            let back = G * half / (inertia + square) * time_s;
            let found = moving.spin(&case.block).y + back;
            let known = (inertia + height * height - half * half) / (inertia + square);
            println!("{sides} {scheme:?} {p_n:e}: {found} {known} back {back} steps {} masses", case.steps);
            if sides == 4 && p_n > 1e11 { for (t, w) in trace.iter().step_by(1 + trace.len() / 12) { println!("   {} {w}", t * case.law.omega_rad_s()); } }
            }
        }
    }
}

/// S18.
#[test]
fn a_face_slides_on_springs_over_any_triangulation() {
    let angle = 40_f64.to_radians();
    let (along, up) = axes(angle);
    for scheme in SCHEMES {
        let ends = [slope(angle, 100.0), finely(angle, 200)].map(|mesh| {
            let body = block(&box_surface([1.0, 0.9, 0.5]), 0.05);
            let case = BlockRun::new(mesh, body, (0.5, 0.4));
            let mut case = with_long_steps(on_springs(case, scheme, 1e9));
            let mut moving = case.start(tilted(angle), still(up * 0.25));
            let start = moving.pose.centre;
            let (mut worst, mut way) = (0.0f64, 0.0);
            case.follow(&mut moving, 6.4, |t, moving| {
                if t > 1.0 {
                worst = worst.max(moving.v.dot(&up).abs());
                }
                way = (moving.pose.centre - start).dot(&along);
            });
            println!("{scheme:?} {way} m, {worst:e} m/s, {} steps, {} impacts", case.steps, case.impacts);
            (way, moving.v)
        });
        println!("{scheme:?} {:e} {:e}", ends[0].0 - ends[1].0, (ends[0].1 - ends[1].1).norm());
    }
}

/// S11, S12.
#[test]
fn a_hexagonal_prism_rolls_on_springs() {
    for degrees in [10_f64, 15.0] {
        for scheme in SCHEMES {
            let (slap, known) = super::rolling_prism(degrees, |case| {
                with_long_steps(on_springs(case, scheme, 1e10))
            });
            println!("{scheme:?} {degrees}: {slap:?} {known:?}");
        }
    }
}

/// S16.
#[test]
fn a_slab_comes_to_roll_as_a_wheel_on_springs() {
    for scheme in SCHEMES {
        let begun = std::time::Instant::now();
        let first = super::cases::rolling_slab(|case| with_long_steps(on_springs(case, scheme, 1e12)));
        println!("{scheme:?} {first:?} {:?}", begun.elapsed());
    }
}

/// S19.
#[test]
fn one_contact_bears_the_weight() {
    let on_edge = turn(&Vec3::x_axis(), std::f64::consts::FRAC_PI_4);
    for scheme in SCHEMES {
        for (mesh, sides, attitude) in
            [(ridge(), [2.0, 1.0, 1.0], on_edge), (peak(), [2.0, 2.0, 0.5], Rotation3::identity())]
        {
            let body = block(&box_surface(sides), 0.05);
            let height = body.support_m(&(attitude.inverse() * -Vec3::z()));
            let case = BlockRun::new(mesh, body, (0.5, 0.0));
            let mut case = with_long_steps(on_springs(case, scheme, 1e9));
            let mut moving = case.start(attitude, still(Vec3::z() * height));
            let start = moving.pose.centre;
            case.follow(&mut moving, 0.2, |_, _| ());
            let pressed = case.block.mass_kg * G / 1e9;
            let way = moving.pose.centre - start;
            println!("{scheme:?} {} {} {:e} {:e} {way:?}", way.z / -pressed, case.steps, moving.v.norm(), moving.spin(&case.block).norm());
        }
    }
}
