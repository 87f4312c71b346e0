//! What a blow of several contacts must obey.

use super::{Breakage, JointBody, JointContact, JointEnd, joint_blow};
use crate::ground::{CAPTURE_DAMPING_RATIO, Capture, Damping, Ground, Law};
use crate::rock::{Rock, Vec3};
use crate::solver::body::{Body, Twist};
use crate::solver::loss::Loss;
use crate::solver::yielding::yielding_impact;
use nalgebra::{Rotation3, Unit};
use proptest::prelude::*;

/// A sphere and its law on trees of a friction angle (rad) and a restitution.
fn case(friction_rad: f64, restitution: f64) -> (Body, Law) {
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let ground = Ground::smooth([1e9, 0.25e9], friction_rad, Some(restitution));
    let capture = Capture { own_m_s: None, tolerance_m_s: 0.0, gravity_m_s2: 9.8 };
    let law = Law::new(&ground, &Damping::of(ground.restitution), &rock, &capture);
    (Body::new(&rock, 9.8), law)
}

/// Contact `stem` of a sphere with this normal.
fn contact(body: &Body, law: &Law, (n, stem): (Vec3, u32)) -> JointContact {
    let lever = n * -body.radius;
    let end = JointEnd { rock: 0, lever };
    JointContact { n, end, other: None, law: *law, captured: false, gap_m: 0.0, stem: Some(stem) }
}

fn blow(
    body: &Body,
    contacts: &[JointContact],
    motion: Twist,
    left_j: [f64; 3],
) -> Option<Breakage> {
    joint_blow(&[body.joint(motion)], contacts, |(_, stem)| left_j[stem as usize])
}

/// From the centre of the second of two rocks to where they touch (m).
fn other_lever(n: &Vec3, body: &Body) -> Vec3 {
    n * body.radius
}

fn motion_j(body: &Body, (v, w): Twist) -> f64 {
    0.5 * (body.mass * v.norm_squared() + body.inertia * w.norm_squared())
}

fn vector(size: f64) -> impl Strategy<Value = Vec3> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(move |x: [f64; 3]| Vec3::from(x) * size)
}

proptest! {
    /// One contact is what it is alone.
    #[test]
    fn one_contact_is_struck_as_alone(
        v in vector(10.0), w in vector(10.0), friction in 0.0..0.8f64, e in 0.1..0.8f64, share in 0.05..0.9f64,
    ) {
        prop_assume!(v.x < -1.0);
        let (body, law) = case(friction, e);
        let limit_j = share * 0.5 * body.mass * v.x * v.x;
        let alone = yielding_impact(&body, (&law, &Vec3::x()), (&v, &w), limit_j).unwrap();
        let contacts = [contact(&body, &law, (Vec3::x(), 0))];
        let end = blow(&body, &contacts, (v, w), [limit_j; 3]).unwrap();
        // both follow it in steps of the same length
        let off = (end.after.motions[0].0 - alone.0).norm() + (end.after.motions[0].1 - alone.1).norm() * body.radius;
        prop_assert!(off < 1e-9 * v.norm() + 1e-9 * w.norm(), "{off:e}");
    }

    /// What contacts take is what the motion loses, to rounding; each stem that is gone has taken its limit, and none that stands has reached it.
    #[test]
    fn no_energy_is_made_and_each_stem_takes_its_limit(
        n in prop::array::uniform3(vector(1.0)), v in vector(10.0), w in vector(10.0),
        (friction, e) in (0.0..0.8f64, 0.1..0.9f64), limits in prop::array::uniform3(0.02..0.8f64),
    ) {
        prop_assume!(n.iter().all(|n| n.norm() > 0.1) && v.norm() > 1.0);
        let (body, law) = case(friction, e);
        // the last two contacts are with one stem
        let stems = [0, 1, 1];
        let contacts: Vec<_> = n.iter().zip(stems).map(|(n, stem)| contact(&body, &law, (n.normalize(), stem))).collect();
        let before_j = motion_j(&body, (v, w));
        let left_j = limits.map(|share| share * before_j);
        let Some(end) = blow(&body, &contacts, (v, w), left_j) else { return Ok(()) };
        let taken_j: f64 = end.after.loss.iter().map(Loss::sum).sum();
        let lost_j = before_j - motion_j(&body, end.after.motions[0]);
        prop_assert!((lost_j - taken_j).abs() < 1e-9 * before_j, "{lost_j} {taken_j}");
        for stem in [0, 1] {
            let own = end.after.loss.iter().zip(stems).filter(|(_, of)| *of == stem);
            let own_j: f64 = own.map(|(loss, _)| loss.sum()).sum();
            if end.stems.contains(&(0, stem)) {
                prop_assert!((own_j - left_j[stem as usize]).abs() < 1e-9 * before_j);
            } else {
                prop_assert!(own_j < left_j[stem as usize]);
            }
        }
    }

    /// Two rocks of unlike masses that touch, the first of them a stem too: what contacts take is what both lose, and momenta about a point are
    /// kept but for what the stem has pushed.
    #[test]
    fn a_blow_of_two_rocks_makes_neither_energy_nor_momentum(
        n in prop::array::uniform2(vector(1.0)), v in prop::array::uniform2(vector(10.0)),
        w in vector(10.0), (friction, e) in (0.0..0.8f64, 0.1..0.9f64), share in 1e-9..0.5f64, heavier in 0.1..10.0f64,
    ) {
        prop_assume!(n.iter().all(|n| n.norm() > 0.1));
        let (body, law) = case(friction, e);
        let [of_stem, of_pair] = n.map(|n| n.normalize());
        let bodies = [body.joint((v[0], w)), JointBody { mass_kg: heavier * body.mass, ..body.joint((v[1], Vec3::zeros())) }];
        let [end, other] = [(0, -1.0), (1, 1.0)].map(|(rock, side)| JointEnd { rock, lever: of_pair * (side * body.radius) });
        let law_of_pair = law.without_rolling();
        let contacts = [
            contact(&body, &law, (of_stem, 0)),
            JointContact { n: of_pair, end, other: Some(other), law: law_of_pair, captured: false, gap_m: 0.0, stem: None },
        ];
        let energy_j = |k: usize, (v, w): Twist| 0.5 * (bodies[k].mass_kg * v.norm_squared() + body.inertia * w.norm_squared());
        let before_j: f64 = (0..2).map(|k| energy_j(k, bodies[k].motion)).sum();
        let Some(end) = joint_blow(&bodies, &contacts, |_| share * before_j) else { return Ok(()) };
        let after = end.after.motions;
        let lost_j = before_j - (0..2).map(|k| energy_j(k, after[k])).sum::<f64>();
        let taken_j: f64 = end.after.loss.iter().map(Loss::sum).sum();
        prop_assert!((lost_j - taken_j).abs() < 1e-9 * before_j, "{lost_j} {taken_j}");
        prop_assert!((end.after.loss[0].sum() - share * before_j).abs() < 1e-9 * before_j, "{} {}", end.after.loss[0].sum(), share * before_j);
        // about the centre of the first rock, where the pair touches at one point
        let change = |k: usize| (after[k].0 - bodies[k].motion.0, after[k].1 - bodies[k].motion.1);
        let impulse = change(1).0 * bodies[1].mass_kg;
        let turned = change(1).1 * body.inertia - other_lever(&of_pair, &body).cross(&impulse);
        prop_assert!(turned.norm() < 1e-9 * (1.0 + impulse.norm() * body.radius), "{turned:?}");
    }

    /// Mirrored normals and equal limits: the rock goes straight on, with what both have left, however steeply it strikes them and however elastic they are.
    #[test]
    fn equal_stems_on_both_sides_do_not_turn_a_rock(angle in 0.1..1.3f64, e in 0.0..1.0f64, share in 0.01..0.45f64) {
        let (body, law) = case(0.0, e);
        let n = |side: f64| {
            let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), side * angle);
            (turn * -Vec3::x(), u32::from(side <= 0.0))
        };
        let contacts = [1.0, -1.0].map(|side| contact(&body, &law, n(side)));
        let all_j = 0.5 * body.mass * 100.0;
        let end = blow(&body, &contacts, (Vec3::x() * 10.0, Vec3::zeros()), [share * all_j; 3]).unwrap();
        let left = 10.0 * (1.0 - 2.0 * share).sqrt();
        prop_assert!((end.after.motions[0].0 - Vec3::x() * left).norm() < 1e-6, "{:?}", end.after.motions[0]);
        prop_assert!(end.stems.len() == 2);
    }

    /// However it is turned as a whole, a blow is the same.
    #[test]
    fn a_turned_blow_is_the_same(axis in vector(1.0), angle in 0.0..3.0f64, v in vector(10.0)) {
        prop_assume!(axis.norm() > 0.1);
        let v = Vec3::new(-1.0 - v.x.abs(), -1.0 - v.y.abs(), v.z);
        let turn = Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle);
        let (body, law) = case(0.4, 0.3);
        let limit_j = 0.2 * body.mass * v.norm_squared();
        let end = |turn: Rotation3<f64>| {
            let contacts = [(Vec3::x(), 0), (Vec3::y(), 1)].map(|(n, stem)| contact(&body, &law, (turn * n, stem)));
            blow(&body, &contacts, (turn * v, Vec3::zeros()), [limit_j; 3]).map(|end| turn.inverse() * end.after.motions[0].0)
        };
        let [plain, turned] = [Rotation3::identity(), turn].map(end);
        prop_assert!(plain.is_some() == turned.is_some());
        if let (Some(plain), Some(turned)) = (plain, turned) {
            prop_assert!((plain - turned).norm() < 1e-6, "{plain:?} {turned:?}");
        }
    }
}

/// A stiff stem breaks at once beside a soft one that stands: the soft one throws the rock back as alone, however much stiffer the other was.
#[test]
fn a_stiff_stem_that_breaks_leaves_the_blow_of_a_soft_one() {
    let (body, soft) = case(0.0, 0.8);
    for stiffer in [1.0, 1e2, 1e4, 1e6, 1e8] {
        let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
        let ground = Ground::smooth([stiffer * 1e9, stiffer * 0.25e9], 0.0, Some(0.8));
        let capture = Capture { own_m_s: None, tolerance_m_s: 0.0, gravity_m_s2: 9.8 };
        let stiff = Law::new(&ground, &Damping::of(ground.restitution), &rock, &capture);
        let contacts =
            [contact(&body, &stiff, (Vec3::x(), 0)), contact(&body, &soft, (Vec3::y(), 1))];
        let v = Vec3::new(-10.0, -10.0, 0.0);
        let end = blow(&body, &contacts, (v, Vec3::zeros()), [1000.0, 1e9, 1e9]).unwrap();
        let left = (100.0 - 2.0 * 1000.0 / body.mass).sqrt();
        let off = (end.after.motions[0].0 - Vec3::new(-left, 8.0, 0.0)).norm();
        assert!(off < 1e-3, "{stiffer:e} times stiffer: {:?}", end.after.motions[0].0);
    }
}

/// Of two contacts at a right angle without friction neither knows of the other: a stem breaks, and the ground stops what comes too slowly to
/// rebound, by its dashpot of damping ratio `ζ`, to `exp(−ζ/s ln((ζ + s)/(ζ − s)))` of its speed, `s² = ζ² − 1`. Each was met as fast as the
/// rock came along it, to half a step.
#[test]
fn a_contact_too_slow_to_rebound_is_damped_beside_a_stem_that_breaks() {
    let (body, law) = case(0.0, 0.8);
    let ground =
        JointContact { captured: true, stem: None, ..contact(&body, &law, (Vec3::y(), 1)) };
    let contacts = [contact(&body, &law, (Vec3::x(), 0)), ground];
    let v = Vec3::new(-10.0, -3.0, 0.0);
    let end = blow(&body, &contacts, (v, Vec3::zeros()), [1000.0; 3]).unwrap();
    let ratio = CAPTURE_DAMPING_RATIO;
    let root = (ratio * ratio - 1.0).sqrt();
    let back = (-ratio / root * ((ratio + root) / (ratio - root)).ln()).exp();
    let left = (100.0 - 2.0 * 1000.0 / body.mass).sqrt();
    let off = (end.after.motions[0].0 - Vec3::new(-left, 3.0 * back, 0.0)).norm();
    assert!(off < 1e-3, "{:?} for {left} {}", end.after.motions[0].0, 3.0 * back);
    let [across, along, ..] = end.after.fastest_m_s;
    assert!((across - 10.0).abs() < 0.1 && (along - 3.0).abs() < 0.05, "{across} {along}");
}

/// A rock that sticks to a stem until that breaks rubs nothing off: what it loses along the surface is the dashpot's.
#[test]
fn what_sticks_to_a_stem_that_breaks_loses_nothing_by_friction() {
    let (body, law) = case(1.5, 0.3);
    let v = Vec3::new(-10.0, 6.0, 0.0);
    let limit_j = 0.3 * motion_j(&body, (v, Vec3::zeros()));
    let contacts = [contact(&body, &law, (Vec3::x(), 0))];
    let end = blow(&body, &contacts, (v, Vec3::zeros()), [limit_j; 3]).unwrap();
    let [friction_j, damping_j, ..] = end.after.loss[0].parts();
    assert!(friction_j.abs() < 1e-5 * limit_j, "{friction_j} J of {limit_j} J");
    assert!((damping_j / limit_j - 1.0).abs() < 1e-5, "{damping_j} J of {limit_j} J");
}

/// What rolling friction takes of a spinning rock counts against the stem, which breaks when it has taken its limit of all that the motion has lost.
#[test]
fn rolling_friction_on_a_stem_is_a_part_of_what_it_takes() {
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let ground = Ground::smooth([1e9, 0.25e9], 0.5, Some(0.3));
    let ground = Ground { rolling_friction: 0.2, ..ground };
    let capture = Capture { own_m_s: None, tolerance_m_s: 0.0, gravity_m_s2: 9.8 };
    let law = Law::new(&ground, &Damping::of(ground.restitution), &rock, &capture);
    let body = Body::new(&rock, 9.8);
    let motion = (Vec3::new(-10.0, 2.0, 0.0), Vec3::new(30.0, -10.0, 20.0));
    let limit_j = 0.3 * motion_j(&body, motion);
    let end = blow(&body, &[contact(&body, &law, (Vec3::x(), 0))], motion, [limit_j; 3]).unwrap();
    let lost_j = motion_j(&body, motion) - motion_j(&body, end.after.motions[0]);
    assert!((lost_j / limit_j - 1.0).abs() < 1e-9, "{lost_j} J of {limit_j} J");
    assert!(end.after.loss[0].parts()[2] > 0.01 * limit_j, "{:?}", end.after.loss[0]);
}
