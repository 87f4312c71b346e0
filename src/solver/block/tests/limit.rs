//! More exact cases with every scheme that has springs: numbers of `docs/exact_blocks.md`.

use super::springs::{SCHEMES, on_springs, with_long_steps};
use super::*;
use crate::solver::Scheme;

/// Forces along the normal of the upper and the lower corners of a cube that lies on a slope (N), of its springs.
fn pairs_n(case: &BlockRun, moving: &Moving, angle: f64) -> [f64; 2] {
    let (along, up) = axes(angle);
    let mut pairs = [0.0; 2];
    for corner in &case.block.core.corners {
        let arm = moving.pose.attitude * corner;
        let pressed = case.block.ball_m - (moving.pose.centre + arm).dot(&up);
        pairs[usize::from(arm.dot(&along) > 0.0)] +=
            case.ground.normal_stiffness_n_m * pressed.max(0.0);
    }
    pairs
}

/// S7: a cube at rest on 20° presses with (cos 20° ± sin 20°)/2 of its weight on its lower and upper corners, a little more unlike as their
/// balls set them inside: 0.6408563821 and 0.2988362387 where it is sharp.
#[test]
fn a_cube_at_rest_presses_as_statics_says() {
    let angle = 20_f64.to_radians();
    let (ball, up) = (0.001, axes(angle).1);
    let shares = |arm: f64| [-1.0, 1.0].map(|s| 0.5 * (cos(angle) + s * sin(angle) * 0.5 / arm));
    let sharp = shares(0.5);
    assert!((sharp[1] - 0.640_856_382_1).abs() < 1e-10 && (sharp[0] - 0.298_836_238_7).abs() < 1e-10);
    let made = || BlockRun::new(slope(angle, 10.0), block(&box_surface([1.0; 3]), ball), (1.0, 0.4));
    for scheme in SCHEMES {
        let mut case = with_long_steps(on_springs(made(), scheme, 1e9));
        let mut moving = case.start(tilted(angle), still(up * 0.5));
        case.follow(&mut moving, 1.0, |_, _| ());
        let weight = case.block.mass_kg * G;
        for (found, known) in pairs_n(&case, &moving, angle).into_iter().zip(shares(0.5 - ball)) {
            assert!((found / weight - known).abs() < 1e-4, "{scheme:?} {} {known}", found / weight);
        }
    }
    // the rigid limit: impulses of one step
    let case = made();
    let (own, laws) = (case.block.clone(), [case.law]);
    let world = ContactEnvironment {
        terrain: &case.terrain,
        body: Body::of_block(&own, G),
        laws: &laws,
    };
    let mut footing = Footing::default();
    let mut moving = case.start(tilted(angle), still(up * 0.5));
    for _ in 0..20 {
        footing.step(&world, &own, &mut moving, (1e-3, CORNER_WAY));
    }
    let mut pairs = [0.0; 2];
    for contact in &footing.contacts {
        let lower = contact.lever.dot(&axes(angle).0) > 0.0;
        pairs[usize::from(lower)] += contact.n.dot(&contact.impulse) / (1e-3 * own.mass_kg * G);
    }
    for (found, known) in pairs.into_iter().zip(shares(0.5 - ball)) {
        assert!((found - known).abs() < 1e-6, "{found} {known}");
    }
}

/// S8 and S9: on 50° a cube tips about its lower edge if friction exceeds the slenderness of its base, with the closed form's angular
/// acceleration, and slides on its face if not; on 40° it does neither with friction enough.
#[test]
fn a_cube_slides_or_tips_as_friction_says() {
    let ball = 0.01;
    for (degrees, friction) in [(50_f64, 0.9), (50.0, 1.3), (40.0, 1.3)] {
        let angle = degrees.to_radians();
        let arm = 0.5 - ball;
        let turns = G * (0.5 * sin(angle) - arm * cos(angle)) / (1.0 / 6.0 + 0.25 + arm * arm);
        let tips = friction > arm / 0.5 && turns > 0.0;
        let slides = G * (sin(angle) - friction * cos(angle));
        for scheme in Scheme::ALL {
            let body = block(&box_surface([1.0; 3]), ball);
            let mut case = BlockRun::new(slope(angle, 100.0), body, (friction, 0.0));
            if scheme.has_springs() {
                case = with_long_steps(on_springs(case, scheme, 1e12));
            }
            let own = case.block.clone();
            let mut moving = case.start(tilted(angle), still(axes(angle).1 * 0.5));
            // springs settle first
            case.follow(&mut moving, 0.01, |_, _| ());
            let (w, v) = (moving.spin(&own).y, moving.v.dot(&axes(angle).0));
            case.follow(&mut moving, 0.02, |_, _| ());
            let turned = (moving.spin(&own).y - w) / 0.02;
            let slid = (moving.v.dot(&axes(angle).0) - v) / 0.02;
            let known = [if tips { turns } else { 0.0 }, if tips { turns * 0.5 } else { slides.max(0.0) }];
            let setting = format!("{scheme:?} {degrees}° {friction}: {turned} {slid}, {known:?}");
            assert!((turned - known[0]).abs() < 5e-3, "{setting}");
            assert!((slid - known[1]).abs() < 5e-3, "{setting}");
        }
    }
}

/// S10: a plastic slap of a prism onto its next face leaves it the same share of its spin on springs.
#[test]
fn a_slap_on_springs_takes_what_it_must() {
    for sides in [4, 6, 12] {
        for scheme in SCHEMES {
            let body = block(&prism_on_its_side(sides), 0.001);
            let case = BlockRun::new(slope(0.0, 50.0), body, (10.0, 0.0));
            let mut case = on_springs(case, scheme, 1e13);
            let corners = &case.block.core.corners;
            let low = corners.iter().map(|p| p.z).fold(f64::MAX, f64::min);
            let half = corners.iter().filter(|p| p.z < low + 1e-6).map(|p| p.x).fold(0.0, f64::max);
            let height = case.block.ball_m - low;
            let inertia = case.block.inertia_kg_m2[1] / case.block.mass_kg;
            let (spin, arm) = (Vec3::y(), Vec3::new(half, 0.0, height));
            let start = [Vec3::z() * height, spin.cross(&arm), spin];
            let mut moving = case.start(Rotation3::identity(), start);
            case.follow(&mut moving, 3e-4, |_, _| ());
            let whole = inertia + height * height + half * half;
            let known = 1.0 - 2.0 * half * half / whole;
            // it goes on about the front edge against its weight meanwhile
            let found = moving.spin(&case.block).y + 3e-4 * G * half / whole;
            assert!((found - known).abs() < 2e-3, "{sides} {scheme:?}: {found} {known}");
        }
    }
}

/// S18: a face slides over any triangulation on springs too: nothing throws the block up where its corners change triangles.
#[test]
fn a_face_slides_over_triangles_on_springs() {
    let angle = 40_f64.to_radians();
    let (along, up) = axes(angle);
    for scheme in SCHEMES {
        let ends = [slope(angle, 100.0), super::cases::finely(angle, 40)].map(|mesh| {
            let body = block(&box_surface([1.0, 0.9, 0.5]), 0.05);
            let case = BlockRun::new(mesh, body, (0.5, 0.4));
            let mut case = with_long_steps(on_springs(case, scheme, 1e9));
            let mut moving = case.start(tilted(angle), still(up * 0.25 - along * 2.0));
            let mut worst = 0.0f64;
            case.follow(&mut moving, 1.5, |t, moving| {
                if t > 0.5 {
                    worst = worst.max(moving.v.dot(&up).abs());
                }
            });
            assert!(worst < 1e-6, "{scheme:?} {worst:e}");
            moving
        });
        let apart = (ends[0].pose.centre - ends[1].pose.centre).norm();
        assert!(ends[0].v.dot(&along) > 3.0 && apart < 1e-6, "{scheme:?} {apart:e}");
    }
}

/// S19: an edge of a block on a ridge, balanced: one contact whose spring bears the weight.
#[test]
fn an_edge_on_a_ridge_bears_the_weight_on_its_spring() {
    let on_edge = turn(&Vec3::x_axis(), std::f64::consts::FRAC_PI_4);
    for scheme in SCHEMES {
        let body = block(&box_surface([2.0, 1.0, 1.0]), 0.05);
        let height = body.support_m(&(on_edge.inverse() * -Vec3::z()));
        let case = on_springs(BlockRun::new(super::cases::ridge(), body.clone(), (0.5, 0.0)), scheme, 1e10);
        let pressed = body.mass_kg * G / case.ground.normal_stiffness_n_m;
        let mut moving = case.start(on_edge, still(Vec3::z() * height));
        let laws = [case.law];
        let world = ContactEnvironment {
            terrain: &case.terrain,
            body: Body::of_block(&body, G),
            laws: &laws,
        };
        let (mut footing, settings) = (Footing::default(), case.springs.unwrap());
        footing.begin_springs(&world, &settings, (&body, &moving));
        let mut now = 0.0;
        while now < 0.02 {
            let on = (&body, &mut moving);
            now += footing.step_on_springs(&world, &settings, on, 0.02 - now).unwrap().0.dt;
        }
        let sunk = height - moving.pose.centre.z;
        let held: Vec<f64> = footing.springs.histories.iter().map(|one| one.normal_force).collect();
        assert_eq!(held.len(), 1, "{scheme:?} {held:?}");
        assert!((held[0] / (body.mass_kg * G) - 1.0).abs() < 1e-4, "{scheme:?} {held:?}");
        assert!((sunk / pressed - 1.0).abs() < 1e-3, "{scheme:?} {sunk:e} {pressed:e}");
    }
}
