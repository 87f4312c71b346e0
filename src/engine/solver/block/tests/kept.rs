//! Conserved quantities of contact without friction: momentum along a plane and along a valley, and
//! the angular momentum about the normal.

use super::springs::{every_scheme, on_springs, with_long_steps};
use super::*;
use crate::body::{Core, HullFace, eota, sphere_points};
use crate::random::{Purpose, stream, unit};
use crate::solver::Scheme;
use nalgebra::{Quaternion, UnitQuaternion};

/// Stiffness of the springs (N/m).
const STIFFNESS_N_M: f64 = 1e9;
/// Height from which blocks fall (m, above the ball around them), and the simulated time (s).
const FALLS_M: f64 = 0.3;
const LASTS_S: f64 = 2.5;
/// Bound of accumulated rounding (–): some 1e-16 a step, of which `dda` takes 1e4.
const ROUNDING: f64 = 1e-10;
/// The same with springs (–): an impact that leaves hardly any motion along its contacts is
/// corrected by the whole motion.
const GRAZING: f64 = 1e-4;

fn allowed(scheme: Scheme) -> f64 {
    if scheme.controls_error() { GRAZING } else { ROUNDING }
}

/// Shapes with corners of all kinds, about a metre wide.
fn bodies() -> Vec<(&'static str, Block)> {
    let half = Vec3::new(0.6, 0.48, 0.33);
    let points: Vec<Vec3> = sphere_points().iter().map(|p| p.component_mul(&half)).collect();
    let solid = Solid::ellipsoid([half.x, half.y, half.z]);
    let radius_m = solid.equal_radius();
    let shape = Shape::of(&solid, &points, 0.1).unwrap();
    let ellipsoid = Block::new(&shape, &Rock { radius_m, density_kg_m3: 2700.0 });
    let uneven = points.iter().zip(1..).map(|(p, k)| p * (0.9 + 0.1 * sin(7.0 * f64::from(k))));
    vec![
        ("eota111", block(&eota([1.0; 3]), 0.05)),
        ("eota221", block(&eota([1.0, 1.0, 0.5]), 0.05)),
        ("box", block(&box_surface([1.0, 0.7, 0.4]), 0.05)),
        ("prism", block(&prism_surface(6, 0.35), 0.05)),
        ("ellipsoid", ellipsoid),
        ("stone", stone(&uneven.collect::<Vec<Vec3>>())),
    ]
}

/// The hull of uneven points.
fn stone(points: &[Vec3]) -> Block {
    let core = Core::of(points).unwrap();
    let fan = |face: &HullFace| {
        let corners: Vec<u32> = face.corners.iter().map(|k| u32::from(*k)).collect();
        (1..corners.len() - 1).map(move |k| [corners[0], corners[k], corners[k + 1]])
    };
    let triangles = core.faces.iter().flat_map(fan).collect();
    block(&Surface { triangles, points: core.corners.clone() }, 0.05)
}

/// A block above the origin, with random attitude and velocity.
fn rebounded(case: &BlockRun, k: u32) -> BlockState {
    let mut random = stream(7, Purpose::Shape, k as usize);
    let mut next = || unit(&mut random) - 0.5;
    let turn: [f64; 4] = std::array::from_fn(|_| next());
    let attitude = UnitQuaternion::from_quaternion(Quaternion::from(turn)).to_rotation_matrix();
    let v = Vec3::new(next(), next(), next()) * 2.0;
    let w = Vec3::new(next(), next(), next()) * 4.0;
    let centre = Vec3::z() * (case.block.bound_m + FALLS_M);
    case.start(attitude, [centre, v, w])
}

/// The largest drift of momentum along `kept` over the fastest speed, and of the angular momentum
/// about `about` over the largest momentum (–).
fn drifts(case: &mut BlockRun, k: u32, (kept, about): (&[Vec3], Option<Vec3>)) -> [f64; 2] {
    let mut state = rebounded(case, k);
    let (start, momentum, had_j) = (state.v, state.momentum, case.energy_j(&state));
    let (mut off, mut fastest, mut most) = ([0.0f64; 2], 0.0f64, 0.0f64);
    case.follow(&mut state, LASTS_S, |t, now| {
        let fell = start - Vec3::z() * (G * t);
        for along in kept {
            off[0] = off[0].max((now.v - fell).dot(along).abs());
        }
        if let Some(n) = about {
            off[1] = off[1].max((now.momentum - momentum).dot(&n).abs());
        }
        (fastest, most) = (fastest.max(now.v.norm()), most.max(now.momentum.norm()));
    });
    let made = (case.energy_j(&state) - had_j) / state.motion_j(&case.block);
    assert!(made < 1e-9, "{made:e}");
    [off[0] / fastest, off[1] / most]
}

fn in_scheme(case: BlockRun, scheme: Scheme) -> BlockRun {
    if !scheme.has_springs() {
        return case;
    }
    let sprung = on_springs(case, scheme, STIFFNESS_N_M);
    // the gain or loss of a step grows with its length, and the conserved quantities do not depend
    // on it
    if scheme.has_fixed_step() { with_long_steps(sprung) } else { sprung }
}

/// Number of blocks of each kind; the two kinds that take the most steps have half as many.
fn throws(scheme: Scheme) -> u32 {
    scheme.of([2, 4, 2, 4])
}

/// Contacts without friction push along the normal of a plane: however a block bounces, rocks and
/// slides, `v·s − g·s t` is constant along the plane and, with `a × n` perpendicular to `n`, the
/// angular momentum about the normal too. When energy errors of steps were taken off the whole
/// motion, the drift was 1.7e-3 of the speed and 2e-3 of the momentum within 2.5 s (`rigid`), 1e-5
/// (`adaptive`). Now only rounding remains, step by step.
#[test]
fn a_plane_without_friction_keeps_what_it_must() {
    let angle = 35_f64.to_radians();
    let (along, up) = axes(angle);
    for (scheme, e) in every_scheme().into_iter().flat_map(|s| [0.0, 0.5, 1.0].map(|e| (s, e))) {
        for (name, body) in bodies() {
            let mut worst = [0.0f64; 2];
            for k in 0..throws(scheme) {
                let made = BlockRun::new(slope(angle, 300.0), body.clone(), (0.0, e));
                let mut case = in_scheme(made, scheme);
                let off = drifts(&mut case, k, (&[along, Vec3::y()], Some(up)));
                worst = [worst[0].max(off[0]), worst[1].max(off[1])];
            }
            println!("{scheme:?} {e} {name}: {worst:?}");
            assert!(
                worst.iter().all(|off| *off < allowed(scheme)),
                "{scheme:?} {e} {name}: {worst:?}"
            );
        }
    }
}

/// A valley along x between two planes that rise by an angle (rad).
pub(super) fn valley(angle: f64) -> Terrain {
    let at = |x: f64, y: f64| Vec3::new(x, y, y.abs() * crate::math::tan(angle));
    let side = |y: f64| {
        let [a, b, c, d] = [at(-200.0, 0.0), at(200.0, 0.0), at(200.0, y), at(-200.0, y)];
        [[a, b, c], [a, c, d]]
    };
    terrain([-50.0, 50.0].into_iter().flat_map(side).collect())
}

/// Both sides of a valley push across its axis alone.
#[test]
fn a_valley_without_friction_keeps_momentum_along_it() {
    for (scheme, e) in every_scheme().into_iter().flat_map(|s| [0.0, 0.5, 1.0].map(|e| (s, e))) {
        for (name, body) in bodies() {
            let mut worst = 0.0f64;
            for k in 0..throws(scheme) {
                let made = BlockRun::new(valley(0.5), body.clone(), (0.0, e));
                let off = drifts(&mut in_scheme(made, scheme), k, (&[Vec3::x()], None));
                worst = worst.max(off[0]);
            }
            println!("{scheme:?} {e} {name}: {worst:e}");
            assert!(worst < allowed(scheme), "{scheme:?} {e} {name}: {worst:e}");
        }
    }
}

/// Largest difference between the mirror image of a block that has fallen for this time and a block
/// that falls mirrored (–): of velocity, and of spin times the largest radius, over the speed.
fn off_the_mirror(made: impl Fn() -> BlockRun, (k, lasts_s): (u32, f64)) -> f64 {
    let flip = Matrix3::from_diagonal(&Vec3::new(1.0, -1.0, 1.0));
    let (mut case, mut mirrored) = (made(), made());
    let mut state = rebounded(&case, k);
    let BlockState { pose, v, momentum } = &state;
    let attitude = Rotation3::from_matrix_unchecked(flip * pose.attitude.matrix() * flip);
    let pose = Pose { centre: flip * pose.centre, attitude };
    let mut image = BlockState { pose, v: flip * v, momentum: -(flip * momentum) };
    case.follow(&mut state, lasts_s, |_, _| ());
    mirrored.follow(&mut image, lasts_s, |_, _| ());
    let block = &case.block;
    let turned = (image.spin(block) + flip * state.spin(block)) * block.bound_m;
    ((image.v - flip * state.v).norm() + turned.norm()) / state.v.norm()
}

/// The same in a mirror, as far as rounding lets two blocks fall alike: with springs the difference
/// grows with the steps of the error control. Later paths diverge: rest on more corners than a body
/// can distinguish has no unique solution, and the solution of the sweeps depends on their order.
#[test]
fn a_mirrored_block_falls_as_the_mirror_shows() {
    for scheme in every_scheme() {
        for (friction, e) in [(0.0, 1.0), (0.0, 0.4), (0.5, 0.4), (0.5, 0.0)] {
            let off = (0..throws(scheme)).map(|k| {
                let made = || {
                    let body = block(&box_surface([1.0, 0.7, 0.4]), 0.05);
                    in_scheme(BlockRun::new(slope(0.6, 50.0), body, (friction, e)), scheme)
                };
                off_the_mirror(made, (k, 0.3))
            });
            let (off, most) =
                (off.fold(0.0, f64::max), if scheme.has_springs() { 1e-6 } else { 1e-9 });
            println!("{scheme:?} {friction} {e}: {off:e}");
            assert!(off < most, "{scheme:?} {friction} {e}: {off:e}");
        }
    }
}

/// A roof with its ridge along x, whose sides fall at 45°.
fn roof() -> Terrain {
    let at = |x: f64, y: f64| Vec3::new(x, y, -y.abs());
    let side = |y: f64| {
        let [a, b, c, d] = [at(-50.0, 0.0), at(50.0, 0.0), at(50.0, y), at(-50.0, y)];
        [[a, b, c], [a, c, d]]
    };
    terrain([-50.0, 50.0].into_iter().flat_map(side).collect())
}

/// Share of its energy (–) that an elastic box without friction keeps that falls with an edge on
/// the ridge of a roof, `ahead_m` from the lower end of the edge, which slides over the ridge while
/// the edge is pressed in.
fn kept_over_an_end(scheme: Scheme, ahead_m: f64) -> f64 {
    let body = block(&box_surface([0.7, 0.3, 0.7]), 0.05);
    let mut case = in_scheme(BlockRun::new(roof(), body, (0.0, 1.0)), scheme);
    let attitude = turn(&Vec3::x_axis(), 0.02) * tilted(std::f64::consts::FRAC_PI_4);
    let corners = case.block.core.corners.iter().map(|own| attitude * own);
    let low = corners.min_by(|p, q| p.z.total_cmp(&q.z)).unwrap();
    let place = Vec3::new(0.0, low.y.signum() * ahead_m, case.block.ball_m + 1e-3);
    let v = Vec3::new(0.0, -3.0 * low.y.signum(), -2.0);
    let mut state = case.start(attitude, [place - low, v, Vec3::zeros()]);
    let had_j = case.energy_j(&state);
    case.follow(&mut state, 0.01, |_, _| ());
    assert!(case.impacts > 0);
    case.energy_j(&state) / had_j
}

/// An edge that slides off over its end, where the corner presses too by then, keeps the energy of
/// its spring until it opens: 16 % of the energy was lost.
#[test]
fn an_edge_that_slides_off_over_its_end_keeps_its_energy() {
    for scheme in every_scheme().into_iter().filter(|scheme| scheme.controls_error()) {
        let kept = (0..24).map(|k| kept_over_an_end(scheme, 2.5e-4 * f64::from(k)));
        let off = kept.map(|kept| (kept - 1.0).abs()).fold(0.0, f64::max);
        println!("{scheme:?}: {off:e}");
        assert!(off < allowed(scheme), "{scheme:?}: {off:e}");
    }
}

/// Straight crests along x, 0.4 m apart, from so many cells of so many metres before the origin to
/// so many past it.
fn crests(cell_m: f64, cells: std::ops::Range<i32>) -> Terrain {
    let at = |i: i32, j: i32| {
        let z = if j.rem_euclid(2) == 1 { 0.0 } else { -0.2 };
        Vec3::new(cell_m * f64::from(i), 0.2 * f64::from(j), z)
    };
    let cell = |(i, j): (i32, i32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    terrain(cells.flat_map(|i| (-4..4).map(move |j| (i, j))).flat_map(cell).collect())
}

/// Penetration of a box that has slid along two crests from 2 m/s, over the penetration at rest,
/// and its speed (–, m/s).
fn slid_along(scheme: Scheme, crests: Terrain, (friction, lasts_s): (f64, f64)) -> (f64, f64) {
    let body = block(&box_surface([0.7, 0.7, 0.4]), 0.05);
    let mut case = on_springs(BlockRun::new(crests, body, (friction, 0.4)), scheme, 1e8);
    if scheme.has_fixed_step() {
        case = with_long_steps(case);
    }
    let start = [Vec3::z() * 0.2, Vec3::x() * 2.0, Vec3::zeros()];
    let mut state = case.start(Rotation3::identity(), start);
    let level = state.pose.centre.z;
    case.follow(&mut state, lasts_s, |_, _| ());
    let pressed_m = case.block.mass_kg * G / 4e8;
    ((level - state.pose.centre.z) / pressed_m, state.v.x)
}

/// With springs of every scheme such a box has the penetration of its weight, and the speed (m/s)
/// that `is_right` accepts.
fn slides_as_deep_as_at_rest(
    (cell_m, cells): (f64, std::ops::Range<i32>),
    slide: (f64, f64),
    is_right: impl Fn(f64) -> bool,
) {
    for scheme in every_scheme().into_iter().filter(|scheme| scheme.has_springs()) {
        let (deep, fast) = slid_along(scheme, crests(cell_m, cells.clone()), slide);
        println!("{scheme:?}: {deep} of the depth at rest, {fast} m/s");
        assert!((deep - 1.0).abs() < 0.02 && is_right(fast), "{scheme:?}: {deep} {fast}");
    }
}

/// A box slides along two divided crests with the penetration of its weight: its edges pass from
/// one mesh edge to the next with the same spring. It sank by that penetration at each joint, 0.4
/// mm (30 times) in 3 m, and was faster for it.
#[test]
fn a_block_slides_along_divided_crests_without_sinking() {
    slides_as_deep_as_at_rest((0.1, -10..50), (0.0, 1.5), |fast| (fast - 2.0).abs() < 1e-6);
}

/// Friction tips the box slightly forward, and the crests are then nearest to its front edge alone.
/// Its rear edge must press all the same, and hand its spring on at each joint. It was released
/// there, and the rear sank until the box lay flat again: 5.7 times the penetration at rest where
/// it stopped.
#[test]
fn a_block_that_friction_slows_does_not_sink_into_divided_crests() {
    let slowed = |fast: f64| (fast - (2.0 - 0.3 * G * 0.6)).abs() < 1e-4;
    slides_as_deep_as_at_rest((0.1, -10..50), (0.3, 0.6), slowed);
}

/// Where the crests begin under the box, its face lies on their ends until its rear edge reaches
/// them, and then that edge lies on the crests: an error of 1.57 times the penetration at rest had
/// remained from that.
#[test]
fn a_face_hands_its_springs_on_to_its_edge() {
    slides_as_deep_as_at_rest((12.0, 0..1), (0.3, 0.6), |_| true);
}

/// A block that is at rest or slides takes long steps: its climb counts as zero, and not as a
/// rounding of its energy, which made a million steps per second.
#[test]
fn a_block_at_rest_takes_long_steps() {
    for (name, body) in bodies() {
        for (friction, k) in [(0.0, 0), (0.5, 1), (0.5, 2)] {
            let mut case = BlockRun::new(slope(0.0, 50.0), body.clone(), (friction, 0.3));
            let (mut state, mut steps) = (rebounded(&case, k), 0);
            case.follow(&mut state, 5.0, |_, _| steps += 1);
            println!("{name}, friction {friction}: {steps} steps");
            assert!(steps < 5000, "{name}, friction {friction}: {steps} steps");
        }
    }
}

/// Far from the origin gaps have rounding errors, and a resting block recovers penetration again
/// and again by that: a climb within the touching tolerance bounds no step. It made steps of 1e-6 s
/// as long as the block was simulated, 300 000 of them, on uneven ground for two of 300 blocks. A
/// climb with next to no energy is still bounded.
#[test]
fn rounding_that_lifts_a_block_cuts_no_step() {
    let case =
        BlockRun::new(slope(0.0, 50.0), block(&box_surface([1.0, 0.7, 0.4]), 0.05), (0.5, 0.3));
    let gravity = Vec3::z() * -G;
    let climb_limit_s = |up_m_s: f64| {
        let start = [Vec3::z() * 0.25, Vec3::z() * up_m_s, Vec3::zeros()];
        let state = case.start(Rotation3::identity(), start);
        state.climb_limit_s(&case.block, &gravity, state.motion_j(&case.block))
    };
    assert!(climb_limit_s(-1e-8).is_infinite());
    assert!(climb_limit_s(1e-8) > 0.1, "{}", climb_limit_s(1e-8));
    let slow_s = climb_limit_s(1e-2);
    assert!((slow_s - 1e-2 / G).abs() < 1e-6 * slow_s, "{slow_s}");
}

/// A box that slides with its face on a plane reaches a ramp of 20° and is thrown off it with all
/// of its energy, wherever steps end. A detection before the fold need not find the pair of a
/// corner and the ramp, whose foot lies below it.
#[test]
fn what_comes_within_a_step_is_struck_and_not_stopped() {
    let angle = 20_f64.to_radians();
    let [low, high] = [-30.0, 30.0]
        .map(|y| move |x: f64| Vec3::new(x, y, (x * crate::math::tan(angle)).max(0.0)));
    let piece = |[a, b]: [f64; 2]| [[low(a), low(b), high(b)], [low(a), high(b), high(a)]];
    for k in 0..16_u8 {
        let ground = terrain([[-30.0, 0.0], [0.0, 30.0]].into_iter().flat_map(piece).collect());
        let body = block(&box_surface([1.0, 0.7, 0.4]), 0.05);
        let mut case = BlockRun::new(ground, body, (0.0, 1.0));
        // nothing rebounds below that speed: a box that lies flat does not jump by rounding
        case.law = law_of(&case.ground, &case.block, 1e-3);
        let centre = Vec3::new(-1.0 - 0.01 * f64::from(k), 0.0, 0.2);
        let start = [centre, Vec3::x() * 4.0, Vec3::zeros()];
        let mut state = case.start(Rotation3::identity(), start);
        let before = case.energy_j(&state);
        case.follow(&mut state, 0.2, |_, _| ());
        let kept = case.energy_j(&state) / before;
        assert!(state.v.x < 3.9, "{k}: it has not come to the ramp");
        assert!((kept - 1.0).abs() < 1e-6, "{k}: {kept}");
    }
}
