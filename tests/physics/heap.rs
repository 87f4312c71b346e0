//! Rocks that share one world: scheme `dda`, bonds, sleep and waking, throws.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use common::together::{plane, space};
use common::{CASE, G, GROUND};
use rockfall::contact::pair::BondStrength;
use rockfall::ground::Ground;
use rockfall::plan::{Recorders, RestRule};
use rockfall::release::Release;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{
    Observer, PairMaterial, RecordOptions, RunSettings, Stop, Trajectory, WorldStats,
    simulate_world,
};
use rockfall::solver::{Scheme, Settings};
use rockfall::terrain::Terrain;
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

/// How a world is followed.
#[derive(Clone, Copy)]
struct World {
    scheme: Scheme,
    gravity_m_s2: f64,
    restitution: Option<f64>,
    strength: BondStrength,
    rest_time_s: f64,
}

const NONE: BondStrength = BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 };
const WORLD: World = World {
    scheme: Scheme::Dda,
    gravity_m_s2: 0.0,
    restitution: Some(0.5),
    strength: NONE,
    rest_time_s: 0.3,
};

/// A sphere: radius, density, centre, velocity.
type Sphere = (f64, f64, [f64; 3], [f64; 3]);

impl World {
    fn run(
        &self,
        terrain: &Terrain,
        spheres: &[Sphere],
        longest_s: f64,
    ) -> (Vec<Trajectory>, WorldStats) {
        let step = Settings {
            scheme: self.scheme,
            tolerance_m_s: 1e-4,
            step_s: 1e-5,
            shear_memory: true,
            impact_kernels: true,
            rigid_heaps: true,
            corner_way: rockfall::solver::CORNER_WAY,
            capture_speed_m_s: CASE.capture_speed_m_s,
        };
        let course = RunSettings {
            terrain,
            gravity_m_s2: self.gravity_m_s2,
            step: &step,
            rest: RestRule { speed_m_s: 0.02, time_s: self.rest_time_s },
            longest_s,
            recorders: Recorders::default(),
            seed: 1,
        };
        let release = |&(radius_m, density_kg_m3, c, v): &Sphere| Release {
            rock: Rock { radius_m, density_kg_m3 },
            motion: Motion {
                time_s: 0.0,
                position_m: Vec3::from(c) - terrain.origin_m,
                velocity_m_s: v.into(),
                spin_rad_s: Vec3::zeros(),
            },
            grounds: vec![GROUND],
        };
        let releases: Vec<Release> = spheres.iter().map(release).collect();
        let ground = Ground { restitution: self.restitution, ..GROUND };
        let answer = PairMaterial { ground, strength: self.strength };
        let keep = |_| RecordOptions { path_step_s: None, impacts: false };
        let never = AtomicBool::new(false);
        let (falls, census) =
            simulate_world(&course, &releases, &answer, keep, Observer::silent(&never)).unwrap();
        for fall in &falls {
            assert!(!matches!(fall.stop, Stop::Failed(_)), "{:?}", fall.stop);
        }
        (falls, census)
    }
}

fn free(x: f64, v: [f64; 3]) -> Sphere {
    (0.5, 2700.0, [x, 0.0, 20.0], v)
}

fn momentum_is_kept(falls: &[Trajectory]) {
    let sum = |at_end: bool| {
        falls.iter().fold((Vec3::zeros(), 0.0), |(p, size), fall| {
            let motion = if at_end { fall.end } else { fall.start };
            let own = motion.velocity_m_s * fall.rock.mass_kg();
            (p + own, f64::max(size, fall.rock.mass_kg() * fall.extremes.speed_m_s))
        })
    };
    let ((before, _), (after, size)) = (sum(false), sum(true));
    assert!((after - before).norm() <= 1e-11 * size, "{:e}", (after - before).norm() / size);
}

/// Scheme `dda`: `v1' = (1−e)/2 v`, `v2' = (1+e)/2 v`; at ω Δt = 0.012 for the reduced mass its own loss is 1 %, and its
/// dashpots act on the mean velocity of a step.
#[test]
fn with_the_fixed_step_two_spheres_share_the_momentum() {
    for e in [0.3, 0.5, 0.9] {
        let world = World { restitution: Some(e), ..WORLD };
        let (falls, _) =
            world.run(&space(), &[free(-1.0, [1.0, 0.0, 0.0]), free(1.0, [0.0; 3])], 2.0);
        let speeds = [0, 1].map(|k| falls[k].end.velocity_m_s.x);
        assert!((speeds[0] - 0.5 * (1.0 - e)).abs() < 0.012, "{e}: {speeds:?}");
        assert!((speeds[1] - 0.5 * (1.0 + e)).abs() < 0.012, "{e}: {speeds:?}");
        momentum_is_kept(&falls);
    }
}

/// Scheme `dda`: without gravity nothing but the two springs acts, at a bond's rest length not even those.
#[test]
fn with_the_fixed_step_a_bond_breaks_at_its_tensile_strength() {
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let v = 0.2;
    // relative speed 2v on the reduced mass m/2: the largest pull of the undamped spring is 2v √(p_N m/2)
    let pull = 2.0 * v * (GROUND.normal_stiffness_n_m * 0.5 * rock.mass_kg()).sqrt();
    let area = PI * 0.25;
    for (share, holds) in [(1.03, true), (0.97, false)] {
        let strength = BondStrength { tensile_pa: share * pull / area, cohesion_pa: 1e12 };
        let world = World { restitution: None, strength, ..WORLD };
        let spheres = [free(-0.5, [-v, 0.0, 0.0]), free(0.5, [v, 0.0, 0.0])];
        let (falls, _) = world.run(&space(), &spheres, 1.0);
        let apart = falls[1].end.position_m.x - falls[0].end.position_m.x;
        assert_eq!(apart < 1.01, holds, "{share}: {apart}");
        momentum_is_kept(&falls);
    }
}

/// Scheme `dda`: shear without normal force breaks a bond at `c A`.
#[test]
fn with_the_fixed_step_a_bond_breaks_at_its_cohesion() {
    for (cohesion_pa, holds) in [(1e9, true), (1e3, false)] {
        let strength = BondStrength { tensile_pa: 1e9, cohesion_pa };
        let world = World { strength, ..WORLD };
        let spheres = [free(-0.5, [0.0, -0.1, 0.0]), free(0.5, [0.0, 0.1, 0.0])];
        let (falls, _) = world.run(&space(), &spheres, 4.0);
        let apart = (falls[1].end.position_m - falls[0].end.position_m).norm();
        assert_eq!(apart < 1.01, holds, "{cohesion_pa}: {apart}");
        momentum_is_kept(&falls);
    }
}

/// A bond that broke stays broken: the two part, one is thrown back by a third, and they meet again without holding on.
#[test]
fn a_broken_bond_stays_broken() {
    for scheme in [Scheme::Dda, Scheme::Adaptive] {
        let strength = BondStrength { tensile_pa: 1e3, cohesion_pa: 1e3 };
        let world = World { scheme, strength, restitution: Some(0.9), ..WORLD };
        // the second runs into the third at x = 2 and comes back to the first, which waits
        let spheres =
            [free(-0.5, [0.0; 3]), free(0.5, [1.0, 0.0, 0.0]), free(2.0, [-4.0, 0.0, 0.0])];
        let (falls, _) = world.run(&space(), &spheres, 6.0);
        let x = [0, 1, 2].map(|k| falls[k].end.position_m.x);
        let v = [0, 1, 2].map(|k| falls[k].end.velocity_m_s.x);
        assert!(v[0] < -0.5, "{scheme:?}: the first was not hit: {v:?}");
        assert!(x[1] - x[0] > 1.5, "{scheme:?}: they held on again: {x:?}");
        momentum_is_kept(&falls);
    }
}

/// A sphere at rest sleeps, and is woken by one that rolls into it; a third, far off, sleeps on.
#[test]
fn what_sleeps_wakes_when_it_is_hit() {
    for scheme in [Scheme::Dda, Scheme::Adaptive] {
        let world = World { scheme, gravity_m_s2: G, ..WORLD };
        let spheres = [
            (0.5, 2700.0, [0.0, 0.0, 0.5], [0.0; 3]),
            (0.5, 2700.0, [-5.0, 0.0, 0.5], [3.0, 0.0, 0.0]),
            (0.5, 2700.0, [0.0, 20.0, 0.5], [0.0; 3]),
        ];
        // the second arrives after 1.3 s and more; a rock sleeps after 0.3 s
        let (falls, _) = world.run(&plane(), &spheres, 3.0);
        assert!(falls[0].end.position_m.x - falls[0].start.position_m.x > 0.5, "it slept on");
        assert_eq!(falls[2].stop, Stop::AtRest);
        assert!((falls[2].end.position_m - falls[2].start.position_m).norm() < 1e-4);
        assert!(falls[2].effort.steps < falls[0].effort.steps / 2, "sleep is not free");
    }
}

/// A light sphere between two heavy ones that close in is thrown out far faster than what hits it: the world goes back
/// where it must, and what it runs into is not passed through.
#[test]
fn a_throw_beyond_the_islands_reach_passes_through_nothing() {
    for light in [0.05, 0.02, 0.01] {
        let world = World { scheme: Scheme::Adaptive, restitution: Some(1.0), ..WORLD };
        // a row of ever lighter spheres: each hands on nearly twice its speed, the last leaves with 2⁴ times the first's
        let radii = [
            0.5,
            0.5 * (light / 0.5f64).powf(1.0 / 3.0),
            0.5 * (light / 0.5f64).powf(2.0 / 3.0),
            light,
        ];
        let mut x = -radii[0];
        let mut spheres = Vec::new();
        for (k, radius) in radii.into_iter().enumerate() {
            x += radius;
            let speed = if k == 0 { 1.0 } else { 0.0 };
            spheres.push((radius, 2700.0, [x, 0.0, 20.0], [speed, 0.0, 0.0]));
            x += radius + 1e-3;
        }
        // a wall that stands in the way of the last, just out of its island's usual reach
        let wall = x + 0.5 + 1.5 * light;
        spheres.push((0.5, 2700.0, [wall, 0.0, 20.0], [0.0; 3]));
        let (falls, census) = world.run(&space(), &spheres, 1.0);
        momentum_is_kept(&falls);
        println!("{light}: went back {} times", census.returns);
        for fall in &falls {
            println!(
                "  v {:.6} max {:.6} rise {:e} remainder {:e}",
                fall.end.velocity_m_s.x,
                fall.extremes.speed_m_s,
                fall.ledger.rise_j,
                fall.ledger.remainder_j
            );
        }
        let last = &falls[radii.len() - 1];
        let block = &falls[radii.len()];
        assert!(
            last.extremes.speed_m_s > 2.2 * 2.0,
            "it was not thrown: {}",
            last.extremes.speed_m_s
        );
        assert!(block.end.velocity_m_s.x > 0.0, "{light}: it was not hit");
        let gap = (last.end.position_m - block.end.position_m).norm() - 0.5 - light;
        assert!(last.end.position_m.x < block.end.position_m.x && gap > -1e-3 * light, "{gap}");
        let energy = |end: bool| -> f64 {
            falls
                .iter()
                .map(|fall| {
                    if end {
                        fall.end.translational_j(&fall.rock)
                    } else {
                        fall.start.translational_j(&fall.rock)
                    }
                })
                .sum()
        };
        assert!(energy(true) <= energy(false) * (1.0 + 1e-3));
    }
}

/// A heap on one thread and on three, and again: the same bits, counters included.
#[test]
fn a_heap_is_the_same_on_any_number_of_threads() {
    let spheres: Vec<Sphere> = (0..60)
        .map(|k| {
            let (i, j, l) = (f64::from(k % 4), f64::from(k / 4 % 4), f64::from(k / 16));
            (0.1, 2700.0, [0.22 * i + 0.03 * l, 0.22 * j, 0.3 + 0.25 * l], [0.0; 3])
        })
        .collect();
    let world = World { scheme: Scheme::Adaptive, gravity_m_s2: G, ..WORLD };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| world.run(&plane(), &spheres, 0.6))
    };
    let (alone, census) = on(1);
    assert_eq!((alone, census), on(3));
    assert!(census.largest > 1 && census.rock_steps > census.steps);
}
