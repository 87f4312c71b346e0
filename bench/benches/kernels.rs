//! Kernels: a leap, a contact query, a step of every scheme, a solve of 6 equations; states as real rocks meet them.
#![allow(missing_docs)]

use divan::{Bencher, black_box};
use nalgebra::{Matrix6, Vector6};
use rockfall::contact::ContactPoints;
use rockfall::contact::neighbours::Neighbours;
use rockfall::flight::{FlightEnd, Parabola, time_of_impact};
use rockfall::ground::{Capture, Damping, Law};
use rockfall::rock::{Motion, Vec3};
use rockfall::solver::body::Body;
use rockfall::solver::contact_state::{ContactEnvironment, ContactState};
use rockfall::solver::{Settings, Stepper, advance};
use rockfall_bench::speed::rate::step_of;
use rockfall_bench::speed::slope::{GRAVITY_M_S2, GROUND, ROCK, SCHEMES, Slope};

fn main() {
    divan::main();
}

/// Sizes of the slope (triangles).
const SIZES: [usize; 3] = [10_000, 100_000, 1_000_000];
/// Rocks whose states are used.
const ROCKS: usize = 20;

/// The states of some rocks under the default scheme: where they take off and where they touch.
struct States {
    slope: Slope,
    flights: Vec<Parabola>,
    touches: Vec<Motion>,
}

fn law(step: &Settings) -> Law {
    let capture = Capture {
        own_m_s: step.capture_speed_m_s,
        tolerance_m_s: step.tolerance_m_s,
        gravity_m_s2: GRAVITY_M_S2,
    };
    Law::new(&GROUND, &Damping::of(GROUND.restitution), &ROCK, &capture)
}

fn world<'a>(slope: &'a Slope, laws: &'a [Law]) -> ContactEnvironment<'a> {
    ContactEnvironment { terrain: &slope.terrain, body: Body::new(&ROCK, GRAVITY_M_S2), laws }
}

fn states(triangles: usize) -> States {
    let slope = Slope::of(triangles);
    let (mut flights, mut touches) = (Vec::new(), Vec::new());
    let step = step_of(SCHEMES[0]);
    let laws = [law(&step)];
    for index in 0..ROCKS {
        let world = world(&slope, &laws);
        let mut grip = ContactState::default();
        let mut now = slope.release(index).motion;
        while let Some(touch) = fly(&slope, &now, &mut flights) {
            touches.push(touch);
            let Motion { position_m, velocity_m_s, spin_rad_s, .. } = touch;
            grip.begin(&world, position_m, velocity_m_s, spin_rad_s);
            let mut stepper = Stepper::new(&step, &world, &mut grip);
            let mut contact_s = 0.0;
            // a rock in contact for a second rolls or rests: no flight follows
            while contact_s < 1.0 {
                let Ok(done) = advance(&mut stepper, &world, &mut grip, 1.0) else { break };
                contact_s += done.dt;
                if grip.is_free() {
                    break;
                }
            }
            if !grip.is_free() {
                break;
            }
            let (position_m, velocity_m_s, spin_rad_s) = (grip.c, grip.v, grip.w);
            now = Motion { time_s: 0.0, position_m, velocity_m_s, spin_rad_s };
        }
    }
    States { slope, flights, touches }
}

/// Leaps to the next touch; notes the flight.
fn fly(slope: &Slope, now: &Motion, flights: &mut Vec<Parabola>) -> Option<Motion> {
    let flight = Parabola {
        start: now.position_m,
        velocity: now.velocity_m_s,
        gravity: GRAVITY_M_S2,
        radius: ROCK.radius_m,
    };
    let FlightEnd::Touch(t) = time_of_impact(&slope.terrain, &flight, 60.0, &mut 0) else {
        return None;
    };
    flights.push(flight);
    let (position_m, velocity_m_s) = (flight.centre(t), flight.velocity(t));
    Some(Motion { time_s: 0.0, position_m, velocity_m_s, spin_rad_s: now.spin_rad_s })
}

/// From take-off to the next touch.
#[divan::bench(args = SIZES)]
fn leap_to_the_next_touch(bencher: Bencher, triangles: usize) {
    let States { slope, flights, .. } = states(triangles);
    let mut next = (0..flights.len()).cycle();
    bencher.bench_local(|| {
        let flight = &flights[next.next().unwrap_or(0)];
        time_of_impact(&slope.terrain, black_box(flight), 60.0, &mut 0)
    });
}

/// Features around a touch are collected for a margin of 0.35 R.
#[divan::bench(args = SIZES)]
fn collect_features(bencher: Bencher, triangles: usize) {
    let States { slope, touches, .. } = states(triangles);
    let mut near = Neighbours::default();
    let mut next = (0..touches.len()).cycle();
    let r = ROCK.radius_m;
    bencher.bench_local(|| {
        let centre = &touches[next.next().unwrap_or(0)].position_m;
        near.collect(&slope.terrain, black_box(centre), r, 0.35 * r, 0.1 * r);
    });
}

/// Which of the collected features touch.
#[divan::bench(args = SIZES)]
fn ask_for_touches(bencher: Bencher, triangles: usize) {
    let States { slope, touches, .. } = states(triangles);
    let r = ROCK.radius_m;
    let mut nears: Vec<(Neighbours, Vec3)> = touches
        .iter()
        .take(200)
        .map(|touch| {
            let mut near = Neighbours::default();
            near.collect(&slope.terrain, &touch.position_m, r, 0.35 * r, 0.1 * r);
            (near, touch.position_m)
        })
        .collect();
    let mut found = ContactPoints::default();
    let mut next = (0..nears.len()).cycle();
    bencher.bench_local(|| {
        let (near, centre) = &mut nears[next.next().unwrap_or(0)];
        near.touches(&slope.terrain, black_box(&*centre), 1.1 * r, &mut found);
    });
}

/// The first step of an impact, by scheme; with taking the rock into the grip.
#[divan::bench(args = ["adaptive", "rigid", "reference", "dda"])]
fn first_step_of_an_impact(bencher: Bencher, scheme: &str) {
    let States { slope, touches, .. } = states(SIZES[1]);
    let Some(&way) = SCHEMES.iter().find(|(own, _)| own.name() == scheme) else { return };
    let step = step_of(way);
    let laws = [law(&step)];
    let world = world(&slope, &laws);
    let mut grip = ContactState::default();
    let mut next = (0..touches.len()).cycle();
    bencher.bench_local(|| {
        let Motion { position_m, velocity_m_s, spin_rad_s, .. } = touches[next.next().unwrap_or(0)];
        grip.begin(&world, position_m, velocity_m_s, spin_rad_s);
        let mut stepper = Stepper::new(&step, &world, &mut grip);
        advance(&mut stepper, &world, &mut grip, 1.0).map(|done| done.dt)
    });
}

/// Six equations, as several contacts of one rock give them.
#[divan::bench]
fn solve_six_equations(bencher: Bencher) {
    let k = Matrix6::from_fn(|i, j| {
        let apart = i.abs_diff(j) as f64;
        let coupled = 1e5 * (-apart).exp() * (1.0 + 0.1 * (i as f64 - 2.0 * j as f64).sin());
        if i == j { coupled + 1e6 } else { coupled }
    });
    let f = Vector6::new(1.0, -2.0, 3.0, 0.5, 0.25, -1.0);
    bencher.bench_local(|| black_box(k).lu().solve(black_box(&f)));
}
