//! Exact cases of rounded bodies: a sphere as one ball, a capsule, bounces run backwards, meshes
//! that are planes.

use super::*;
use crate::body::Core;

/// Balls of radius `ball_m` at these places, with these moments.
pub(super) fn balls(corners: Vec<Vec3>, ball_m: f64, (mass_kg, moments): (f64, [f64; 3])) -> Block {
    let bound_m = corners.iter().map(Vec3::norm).fold(0.0, f64::max) + ball_m;
    let core = Core { corners, ridges: Vec::new(), faces: Vec::new() };
    let radius_m = crate::math::cbrt(0.75 * mass_kg / (2700.0 * std::f64::consts::PI));
    Block { core, ball_m, mass_kg, inertia_kg_m2: moments, bound_m, radius_m }
}

/// A capsule of two balls of 0.3 m, 0.8 m apart, rolls across 20° without slipping on both balls:
/// with I/(m r²) = 7/15 about its axis a = g sin 20°/(1 + 7/15) = 2.287648367744 m/s², straight on.
#[test]
fn a_capsule_rolls_on_both_of_its_balls() {
    let angle = 20_f64.to_radians();
    let (r, half, mass) = (0.3, 0.4, 1000.0);
    let own = 7.0 / 15.0 * mass * r * r;
    let body =
        balls(vec![Vec3::y() * half, Vec3::y() * -half], r, (mass, [2.0 * own, own, 2.0 * own]));
    let mut case = BlockRun::new(slope(angle, 100.0), body, (1.0, 0.0));
    let (along, up) = axes(angle);
    let mut state = case.start(tilted(angle), still(up * r - along * 40.0));
    let start = state.pose.centre;
    case.follow(&mut state, 4.0, |_, _| ());
    let a = G * sin(angle) / (1.0 + 7.0 / 15.0);
    assert!((a - 2.287_648_367_744).abs() < 1e-12);
    let way = state.pose.centre - start;
    println!("{} {}", state.v.dot(&along) / (4.0 * a) - 1.0, way.dot(&along) / (8.0 * a) - 1.0);
    assert!((state.v.dot(&along) / (4.0 * a) - 1.0).abs() < 1e-6, "{}", state.v.dot(&along));
    assert!((way.dot(&along) / (8.0 * a) - 1.0).abs() < 1e-6, "{}", way.dot(&along));
    let spin = state.spin(&case.block);
    assert!((spin.y * r / state.v.dot(&along) - 1.0).abs() < 1e-6, "{spin}");
    assert!(way.y.abs() < 1e-9 && spin.x.abs() + spin.z.abs() < 1e-9, "{way} {spin}");
}

/// One ball at the centre is a sphere: it rolls down with 5/7 g sin.
#[test]
fn one_ball_rolls_as_a_sphere_does() {
    let (angle, r, mass) = (20_f64.to_radians(), 0.5, 1400.0);
    let own = 0.4 * mass * r * r;
    let body = balls(vec![Vec3::zeros()], r, (mass, [own; 3]));
    let mut case = BlockRun::new(slope(angle, 100.0), body, (1.0, 0.0));
    let (along, up) = axes(angle);
    let mut state = case.start(tilted(angle), still(up * r - along * 40.0));
    case.follow(&mut state, 4.0, |_, _| ());
    let speed = 5.0 / 7.0 * G * sin(angle) * 4.0;
    assert!((state.v.dot(&along) / speed - 1.0).abs() < 1e-6, "{}", state.v.dot(&along) / speed);
}

/// Bounces with e = 1 and without friction, then all velocities reversed: the block returns to its
/// start. A tumbling box is chaotic: each bounce multiplies the touching tolerance of 1e-10 R. So
/// the error of the return is compared with that of a twin that starts 1e-8 m higher.
#[test]
fn elastic_bounces_run_backwards() {
    run_backwards(elastic_box(), &[2, 10], 1e-9);
}

/// A box on a level, e = 1 without friction.
pub(super) fn elastic_box() -> BlockRun {
    let body = block(&box_surface([3.0, 2.0, 1.0]), 0.1);
    BlockRun::new(slope(0.0, 1e3), body, (0.0, 1.0))
}

/// Simulates this number of bounces and the return; `near` is the closest approach to the start,
/// for a twin that has not diverged.
pub(super) fn run_backwards(mut case: BlockRun, bounces: &[usize], near: f64) {
    let start = [Vec3::z() * 3.0, Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.3, -0.7, 0.4)];
    let begun = case.start(Rotation3::identity(), start);
    for &asked in bounces {
        let (mut state, mut longest) = (begun.clone(), 0.0);
        // the time of this number of bounces is not known in advance
        while case.impacts < asked {
            (state, case.impacts) = (begun.clone(), 0);
            longest += 0.25;
            case.follow(&mut state, longest, |_, _| ());
        }
        let bounces = case.impacts;
        let mut twin = begun.clone();
        twin.pose.centre.z += 1e-8;
        case.follow(&mut twin, longest, |_, _| ());
        let apart = [
            (twin.pose.centre - state.pose.centre).norm(),
            (twin.pose.attitude.matrix() - state.pose.attitude.matrix()).norm(),
            (twin.v - state.v).norm(),
        ];
        let growth = (apart.into_iter().fold(0.0, f64::max) / 1e-8).max(1.0);
        (state.v, state.momentum, case.impacts) = (-state.v, -state.momentum, 0);
        case.follow(&mut state, longest, |_, _| ());
        assert_eq!(case.impacts, bounces);
        let off = (state.pose.centre - begun.pose.centre).norm();
        let turned = (state.pose.attitude.matrix() - begun.pose.attitude.matrix()).norm();
        let v = (state.v + begun.v).norm();
        println!("{bounces} bounces: {off:e} m, {turned:e}, {v:e} m/s; growth {growth:e}");
        assert!(off.max(turned).max(v) < near * growth, "{off:e} {turned:e} {v:e} {growth:e}");
        case.impacts = 0;
    }
}

/// A slope of so many rows of small triangles, each cell halved one way or the other.
pub(super) fn finely(angle: f64, rows: u32) -> Terrain {
    let (along, size) = (axes(angle).0, 0.37);
    let at = |i: u32, j: u32| {
        along * (size * (f64::from(i) - 20.0)) + Vec3::y() * (size * (f64::from(j) - 10.0))
    };
    let cell = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if (i + j) % 3 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let all = (0..rows).flat_map(|i| (0..20).map(move |j| (i, j))).flat_map(cell);
    terrain(all.collect())
}

/// A block whose face lies on a plane of many small triangles slides 50 m as on two large ones:
/// nothing throws it up.
#[test]
fn a_face_slides_over_any_triangulation() {
    let angle = 40_f64.to_radians();
    let (along, up) = axes(angle);
    let body = block(&box_surface([1.0, 0.9, 0.5]), 0.05);
    let ends = [slope(angle, 100.0), finely(angle, 200)].map(|mesh| {
        let mut case = BlockRun::new(mesh, body.clone(), (0.5, 0.4));
        let mut state = case.start(tilted(angle), still(up * 0.25));
        let start = state.pose.centre;
        let (mut worst, mut way) = (0.0f64, 0.0);
        case.follow(&mut state, 6.4, |_, state| {
            worst = worst.max(state.v.dot(&up).abs());
            way = (state.pose.centre - start).dot(&along);
        });
        println!("{way} m, {worst:e} m/s, {} steps, {} impacts", case.steps, case.impacts);
        assert!(way > 50.0 && worst < 1e-8, "{way} {worst:e}");
        (way, state.v)
    });
    assert!(
        (ends[0].0 - ends[1].0).abs() < 1e-6 && (ends[0].1 - ends[1].1).norm() < 1e-7,
        "{ends:?}"
    );
}

/// Number of slabs out of three, 2.5 x 3 x 1 m, that roll down 27° with rough friction, e = 0
/// (Leine 2014, 5.2), as `made` for a scheme, and come to rotate about the axis of largest inertia
/// within 60 s. They start a thousandth of a radian apart, which is enough for times between 7 and
/// 60 s with every scheme; one of ten takes longer.
pub(super) fn rolling_slabs(made: impl Fn(BlockRun) -> BlockRun) -> usize {
    [0.2, 0.201, 0.202].into_iter().filter(|tilt| rolling_slab(*tilt, &made).is_some()).count()
}

/// Time (s) at which that axis first carries 95 % of the rotational energy of a slab that leans
/// sideways by this angle at first (rad).
fn rolling_slab(tilt: f64, made: impl Fn(BlockRun) -> BlockRun) -> Option<f64> {
    let angle = 27_f64.to_radians();
    let body = block(&box_surface([2.5, 3.0, 1.0]), 0.05);
    let mut case = made(BlockRun::new(slope(angle, 4e3), body, (10.0, 0.0)));
    let (along, up) = axes(angle);
    let start = [up * 2.5 - along * 3000.0, along * 28.0, Vec3::y() * 20.8];
    let mut state = case.start(tilted(angle) * turn(&Vec3::x_axis(), tilt), start);
    let own = case.block.clone();
    let widest =
        (0..3).max_by(|&i, &j| own.inertia_kg_m2[i].total_cmp(&own.inertia_kg_m2[j])).unwrap();
    let mut first = None;
    for begun_s in [0.0, 10.0, 20.0, 30.0, 40.0, 50.0] {
        case.follow(&mut state, 10.0, |now, state| {
            let spin = state.pose.attitude.inverse_transform_vector(&state.spin(&own));
            let parts: Vec<f64> =
                (0..3).map(|k| own.inertia_kg_m2[k] * spin[k] * spin[k]).collect();
            if parts[widest] > 0.95 * parts.iter().sum::<f64>() {
                first.get_or_insert(begun_s + now);
            }
        });
        if first.is_some() {
            break;
        }
    }
    println!("after {first:?} s; {} steps, {} impacts", case.steps, case.impacts);
    first
}

/// S16: within 60 s slabs roll as wheels.
#[test]
fn a_slab_comes_to_roll_as_a_wheel() {
    let rolling = rolling_slabs(|case| case);
    assert!(rolling >= 2, "{rolling}");
}

/// Half of the restitution is left at the ground's half speed: a cube that falls flat on its face.
#[test]
fn restitution_of_a_block_falls_with_speed() {
    for speed in [2.0, 9.0, 20.0] {
        let mut case =
            BlockRun::new(slope(0.0, 50.0), block(&box_surface([1.0; 3]), 0.05), (0.5, 0.6));
        case.law.restitution_half_m_s = 9.0;
        let start = [Vec3::z() * 0.5, Vec3::z() * -speed, Vec3::zeros()];
        let mut state = case.start(Rotation3::identity(), start);
        case.follow(&mut state, 1e-3, |_, _| ());
        let up = 0.6 / (1.0 + (speed / 9.0_f64).powi(2)) * speed;
        assert!((state.v.z + G * 1e-3 - up).abs() < 1e-9, "{} {up}", state.v.z);
    }
}

/// A ridge along y through the origin, both sides at 45°.
pub(super) fn ridge() -> Terrain {
    let (a, b) = (Vec3::y() * -5.0, Vec3::y() * 5.0);
    let [p, q, r, s] =
        [(-5.0, -5.0), (-5.0, 5.0), (5.0, 5.0), (5.0, -5.0)].map(|(x, y)| Vec3::new(x, y, -5.0));
    terrain(vec![[a, b, q], [a, q, p], [a, s, r], [a, r, b]])
}

/// A blunt peak in the origin.
pub(super) fn peak() -> Terrain {
    let tip = Vec3::zeros();
    let [a, b, c] = [(-3.0, -2.0), (3.0, -2.0), (0.0, 4.0)].map(|(x, y)| Vec3::new(x, y, -4.0));
    terrain(vec![[tip, a, b], [tip, b, c], [tip, c, a]])
}

/// An edge of a block across a ridge: one contact, and a plate over a peak: one contact, pushing
/// with the weight.
#[test]
fn edges_and_faces_meet_edges_and_peaks() {
    // on its edge across the ridge; its face over the peak
    let on_edge = turn(&Vec3::x_axis(), std::f64::consts::FRAC_PI_4);
    for (mesh, sides, attitude) in
        [(ridge(), [2.0, 1.0, 1.0], on_edge), (peak(), [2.0, 2.0, 0.5], Rotation3::identity())]
    {
        let body = block(&box_surface(sides), 0.05);
        let height = body.support_m(&(attitude.inverse() * -Vec3::z()));
        let mut case = BlockRun::new(mesh, body.clone(), (0.5, 0.0));
        let above =
            case.start(attitude, [Vec3::z() * (height + 0.3), Vec3::zeros(), Vec3::zeros()]);
        let path = Parabola {
            start: above.pose.centre,
            velocity: Vec3::zeros(),
            gravity: G,
            radius: body.bound_m,
        };
        let top = Top::new(body.inertia_kg_m2, attitude, Vec3::zeros());
        let tumble = BlockFlight { block: &body, top, path };
        let mut contact_state = BlockContactState::default();
        let landing = first_touch(
            &case.terrain,
            &tumble,
            10.0,
            (&mut contact_state.near, &mut contact_state.window),
        );
        let FlightEnd::Touch(t) = landing else { panic!("{landing:?}") };
        assert!((t - (0.6_f64 / G).sqrt()).abs() < 1e-6, "{t}");
        let laws = [case.law];
        let world = ContactEnvironment {
            terrain: &case.terrain,
            body: Body::of_block(&body, G),
            laws: &laws,
        };
        let mut state = above.clone();
        (state.pose, state.v) = (tumble.pose(t), path.velocity(t));
        let pose = state.pose;
        contact_state.detect(&world, &body, &pose, body.ball_m);
        assert_eq!(contact_state.touching(&body).count(), 1, "{:?}", contact_state.touches);
        assert!((contact_state.touches.found[0].normal - Vec3::z()).norm() < 1e-7);
        // a balanced fall on one point stops dead
        contact_state.strike(&world, &body, &mut state).unwrap();
        assert!(state.v.norm() < 1e-7 && state.spin(&body).norm() < 1e-7, "{}", state.v);
        case.impacts += 1;
    }
}

/// Penetration of a block is recovered with at most a tenth of `√(g R)` of the scene's gravity, on
/// the moon as on Jupiter, and below a hundredth of its radius in proportion to the depth: ever
/// more slowly.
#[test]
fn what_is_pressed_in_is_let_out_as_gravity_has_it() {
    let case = BlockRun::new(slope(0.0, 50.0), block(&box_surface([1.0; 3]), 0.05), (0.5, 0.4));
    let own = case.block.clone();
    for gravity in [1.62, G, 24.8] {
        let laws = [case.law];
        let body = Body::of_block(&own, gravity);
        let world = ContactEnvironment { terrain: &case.terrain, body, laws: &laws };
        for (deep_m, share) in [(0.02, 1.0), (0.001, 0.001 / (0.01 * own.radius_m))] {
            let mut contact_state = BlockContactState::default();
            let mut state = case.start(Rotation3::identity(), still(Vec3::z() * (0.5 - deep_m)));
            contact_state.step(&world, &own, &mut state, (1e-4, CORNER_WAY));
            let right = share * 0.1 * (gravity * own.radius_m).sqrt();
            assert!(!contact_state.contacts.is_empty());
            for contact in &contact_state.contacts {
                let out = contact.goal.dot(&contact.n);
                assert!((out / right - 1.0).abs() < 2e-3, "{gravity}, {deep_m}: {out} {right}");
            }
        }
    }
}

/// Share of its kinetic energy that a block has lost (–) that tips over its rear edge, without
/// slip, when its front edge strikes the level.
fn lost_by_tipping(sides: [f64; 3], ball: f64, (tilt, step_s): (f64, f64)) -> f64 {
    let body = block(&box_surface(sides), ball);
    let mut case = BlockRun::new(slope(0.0, 50.0), body, (10.0, 0.5));
    case.step_s = step_s;
    let attitude = tilted(-tilt);
    let low = attitude * Vec3::new(ball - 0.5 * sides[0], 0.0, ball - 0.5 * sides[2]);
    let mut state = case.start(attitude, still(Vec3::z() * (ball - low.z)));
    let (own, had_j) = (case.block.clone(), case.energy_j(&state));
    let energy_j = |now: &BlockState| now.motion_j(&own) + own.mass_kg * G * now.pose.centre.z;
    let (mut last_j, mut fastest, mut lost_j) = (had_j, 0.0f64, None);
    case.follow(&mut state, 2.0, |_, now| {
        let w = now.spin(&own).norm();
        if lost_j.is_none() && w < 0.9 * fastest {
            lost_j = Some(had_j - last_j);
        }
        (last_j, fastest) = (energy_j(now), fastest.max(w));
    });
    lost_j.unwrap() / (had_j - own.mass_kg * G * 0.5 * sides[2])
}

/// A step that ends where the front edge closes does not dissipate the work of the weight in it:
/// only the steps' own error remains, of second order.
#[test]
fn a_tipping_block_strikes_as_fast_as_it_has_fallen() {
    for (sides, ball) in [([2.0, 1.0, 0.2], 0.01), ([2.0, 1.0, 0.2], 0.08), ([0.6, 1.0, 0.5], 0.08)]
    {
        for tilt in [0.02, 0.1, 0.6] {
            let lost = [1e-2, 1e-3].map(|step_s| lost_by_tipping(sides, ball, (tilt, step_s)));
            println!("{sides:?} {ball} {tilt}: {lost:?}");
            assert!(lost[1].abs() < 5e-6, "{sides:?} {ball} {tilt}: {lost:?}");
        }
    }
}
