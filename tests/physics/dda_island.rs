//! Scheme `dda`: a rock alone and rocks that touch each other take one step, and where it does not settle it adds no energy.
#![allow(clippy::unwrap_used, reason = "a test whose step fails has failed")]

use crate::common;

use common::together::space;
use common::{CASE, Case, G, ROCK, terrain};
use rockfall::contact::pair::PairHistory;
use rockfall::flight::{FlightEnd, Parabola, time_of_impact};
use rockfall::ground::{Capture, Damping, Ground, Law};
use rockfall::rock::{Rock, Vec3};
use rockfall::solver::body::Body;
use rockfall::solver::contact_state::{ContactEnvironment, ContactState};
use rockfall::solver::island::{BodySlot, Island, IslandBody};
use rockfall::solver::{Scheme, Settings, Stepper, advance};
use rockfall::terrain::{Terrain, make};

const BARE: Ground = Ground { restitution: None, ..common::GROUND };
const DDA: Case = Case { scheme: Scheme::Dda, ..CASE };

fn settings(case: &Case) -> Settings {
    Settings {
        scheme: case.scheme,
        tolerance_m_s: case.tolerance_m_s,
        step_s: case.step_s,
        shear_memory: case.shear_memory,
        impact_kernels: true,
        rigid_heaps: true,
        corner_way: rockfall::solver::CORNER_WAY,
        capture_speed_m_s: None,
    }
}

fn law(ground: &Ground, gravity_m_s2: f64, mass: (f64, f64)) -> Law {
    let capture = Capture { own_m_s: None, tolerance_m_s: 0.0, gravity_m_s2 };
    Law::of_mass(ground, &Damping::of(ground.restitution), mass, &capture)
}

/// Steps a rock alone and as the only one of an island from its first touch on, and compares all of their bits; how many steps there
/// were, and how many did not settle.
fn alone_and_in_an_island(floor: &Terrain, case: &Case, [c, v, w]: [[f64; 3]; 3]) -> (u32, u32) {
    let (start, velocity) = (Vec3::from(c) - floor.origin_m, v.into());
    let flight = Parabola { start, velocity, gravity: G, radius: ROCK.radius_m };
    let FlightEnd::Touch(t) = time_of_impact(floor, &flight, 9.0, &mut 0) else { return (0, 0) };
    let start = (flight.centre(t), flight.velocity(t), Vec3::from(w));
    let step = settings(case);
    let laws = vec![law(&case.ground, G, (ROCK.mass_kg(), ROCK.radius_m))];
    let body = Body::new(&ROCK, G);
    let world = ContactEnvironment { terrain: floor, body, laws: &laws };
    let mut member = IslandBody::new(body, laws.clone(), start);
    member.state.begin(&world, start.0, start.1, start.2);
    member.flying = false;
    let mut island = Island::new(floor, vec![BodySlot::new(member)], Vec::new());
    let mut state = ContactState::default();
    state.begin(&world, start.0, start.1, start.2);
    let mut stepper = Stepper::new(&step, &world, &mut state);
    let (mut steps, mut unsettled) = (0, 0);
    for k in 0..300 {
        let one = advance(&mut stepper, &world, &mut state, f64::INFINITY).unwrap();
        let other = island.advance_fixed(&step, f64::INFINITY).unwrap();
        let own = &island.members[0].state;
        assert_eq!((state.c, state.v, state.w), (own.c, own.v, own.w), "step {k}, {case:?}");
        assert_eq!((one.dt, one.loss, one.unsettled), (other.dt, other.losses[0], other.unsettled));
        assert_eq!(state.histories.len(), own.histories.len());
        (steps, unsettled) = (steps + 1, unsettled + u32::from(one.unsettled));
        if state.is_free() {
            break;
        }
    }
    assert_eq!(state.sweeps, island.sweeps);
    (steps, unsettled)
}

/// A rock alone is a system of one: the same bits as in an island of its own, on a plane, over an edge and into a fold, settled
/// or not.
#[test]
fn a_rock_alone_and_an_island_of_one_give_the_same_bits() {
    let (mut steps, mut unsettled) = (0, 0);
    for facets in [
        make::jittered_plane(4.0, 8, 0.0),
        make::jittered_plane(4.0, 8, 0.6),
        make::ridge(4.0, 0.5),
        make::v_groove(4.0, 0.7),
    ] {
        let floor = terrain(facets);
        for ground in [BARE, common::GROUND, Ground { rolling_friction: 0.4, ..BARE }] {
            for (step_s, shear_memory) in [(1e-4, true), (1e-3, true), (1e-3, false), (1e-2, false)]
            {
                let case = Case { step_s, shear_memory, ground, ..DDA };
                for k in 0..6 {
                    let v = [0.1 * f64::from(k), 0.0, -2.0 - f64::from(k % 3)];
                    let w = [0.0, f64::from(k % 2), 0.0];
                    let done = alone_and_in_an_island(&floor, &case, [[0.1, 0.2, 2.0], v, w]);
                    (steps, unsettled) = (steps + done.0, unsettled + done.1);
                }
            }
        }
    }
    println!("{unsettled} of {steps} steps did not settle");
    assert!(steps > 3_000 && unsettled > 20);
}

/// Spheres of two sizes in a cluster, without gravity and far from everything, that fly at its middle, each with a spin. Gaps and
/// overlaps are up to some times `gap` (m).
fn cluster<'a>(nowhere: &'a Terrain, ground: &Ground, (seed, gap): (u32, f64)) -> Island<'a> {
    let mut number = f64::from(seed);
    let mut random = || {
        number = (number * 16_807.0 + 1.0) % 2_147_483_647.0;
        2.0 * number / 2_147_483_647.0 - 1.0
    };
    let rock = |k: usize| Rock { radius_m: [0.15, 0.2, 0.2][k % 3], ..ROCK };
    let mut vector = || Vec3::new(random(), random(), random());
    let count = 18;
    let members = (0..count).map(|k| {
        let x = [-0.35, 0.0, 0.4][k % 3];
        let c = Vec3::new(x, (k / 3 % 3) as f64 * 0.4 - 0.4, (k / 9) as f64 * 0.4 - 0.2);
        let c = c + vector() * gap;
        let v = -c * 3.0 + vector();
        let laws = vec![law(ground, 0.0, (rock(k).mass_kg(), rock(k).radius_m))];
        BodySlot::new(IslandBody::new(Body::new(&rock(k), 0.0), laws, (c, v, vector() * 20.0)))
    });
    let members: Vec<BodySlot> = members.collect();
    let between = |(a, b): (usize, usize)| {
        let (m, n) = (rock(a).mass_kg(), rock(b).mass_kg());
        let radius = rock(a).radius_m.min(rock(b).radius_m);
        PairHistory::new(a as u32, b as u32, law(ground, 0.0, (m * n / (m + n), radius)))
    };
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))).map(between);
    Island::new(nowhere, members, pairs.collect())
}

/// Energy of motion and of the springs between the spheres (J), and their momentum (kg m/s).
fn energy_and_momentum(island: &Island, ground: &Ground) -> (f64, Vec3) {
    let (mut energy_j, mut momentum) = (0.0, Vec3::zeros());
    for member in &island.members {
        energy_j += member.state.motion_j(&member.body);
        momentum += member.state.v * member.body.mass;
    }
    for pair in &island.pair_histories {
        let [a, b] = [pair.a, pair.b].map(|k| &island.members[k as usize]);
        let apart = (a.state.c - b.state.c).norm();
        let depth = (a.body.radius + b.body.radius - apart).max(0.0);
        energy_j += 0.5 * ground.normal_stiffness_n_m * depth * depth;
        energy_j += 0.5 * ground.shear_stiffness_n_m * pair.shear.norm_squared();
    }
    (energy_j, momentum)
}

/// No step of rocks that run into each other adds energy, settled or not, and none makes momentum. In one that does not settle no contact
/// that began apart pulls, and none ends pressed in without a push.
#[test]
fn steps_of_a_cluster_that_do_not_settle_add_no_energy() {
    let nowhere = space();
    let (mut steps, mut unsettled, mut closed, mut most_solves) = (0, 0, 0, 0);
    for ground in [BARE, common::GROUND, Ground { friction_angle_rad: 1.2, ..BARE }] {
        for (step_s, shear_memory) in [(1e-4, false), (1e-3, false), (3e-3, false), (1e-3, true)] {
            let step = settings(&Case { step_s, shear_memory, ground, ..DDA });
            for seed in 1..6 {
                let mut island = cluster(&nowhere, &ground, (seed, 2e-3));
                let (mut before_j, momentum) = energy_and_momentum(&island, &ground);
                let most_j = before_j;
                for k in 0..60 {
                    let (gaps, spent) = (gaps(&island), island.sweeps);
                    let done = island.advance_fixed(&step, f64::INFINITY).unwrap();
                    let (now_j, now) = energy_and_momentum(&island, &ground);
                    let what = format!("{seed}, step {k}, {step:?}: unsettled {}", done.unsettled);
                    assert!(now_j <= before_j + 1e-9 * most_j, "{what}: {before_j} -> {now_j} J");
                    assert!((now - momentum).norm() < 1e-9, "{what}: {now} {momentum}");
                    before_j = now_j;
                    steps += 1;
                    if done.unsettled {
                        unsettled += 1;
                        closed += fits(&island, &gaps, &what);
                        most_solves = most_solves.max(island.sweeps - spent);
                    }
                }
            }
        }
    }
    println!(
        "{unsettled} of {steps} steps did not settle, of {most_solves} solves at most; {closed} contacts closed in them"
    );
    assert!(unsettled > 20 && closed > 20);
}

/// Gaps of all pairs (m), and their normals.
fn gaps(island: &Island) -> Vec<(f64, Vec3)> {
    let gap = |pair: &PairHistory| {
        let [a, b] = [pair.a, pair.b].map(|k| &island.members[k as usize]);
        let off = a.state.c - b.state.c;
        (off.norm() - a.body.radius - b.body.radius, off.normalize())
    };
    island.pair_histories.iter().map(gap).collect()
}

/// Of the pairs that began apart: whether force and depth along the normal of the step's start fit; how many closed.
fn fits(island: &Island, before: &[(f64, Vec3)], what: &str) -> u32 {
    let mut closed = 0;
    for (pair, (gap, n)) in island.pair_histories.iter().zip(before) {
        let [a, b] = [pair.a, pair.b].map(|k| &island.members[k as usize]);
        // the part of the gap that is rounding is no beginning apart
        if *gap < 1e-8 || *gap > 0.01 {
            continue;
        }
        let reach = a.body.radius + b.body.radius;
        let depth = reach - n.dot(&(a.state.c - b.state.c));
        assert!(pair.normal_force >= 0.0, "{what}: {} pulls", pair.normal_force);
        let fits = if pair.normal_force > 0.0 { depth > -1e-12 } else { depth < 1e-12 };
        assert!(fits, "{what}: pushes by {} N at {depth} m", pair.normal_force);
        closed += u32::from(pair.normal_force > 0.0);
    }
    closed
}
