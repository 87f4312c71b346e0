//! Bonds between rocks, against exact answers.

use super::pairs::{free, momentum_is_kept};
use crate::common;

use common::together::{self, World, plane, space};
use common::{GROUND, terrain};
use rockfall::contact::pair::BondStrength;
use rockfall::ground::{Ground, damping_ratio};
use rockfall::rock::{Rock, Vec3};
use rockfall::simulation::Stop;
use rockfall::solver::Scheme;

const WORLD: World =
    World { scheme: Scheme::Adaptive, tolerance_m_s: 1e-4, step_s: 1e-5, ..together::WORLD };

/// Two bonded spheres pulled apart by their own speeds: the largest pull of the undamped spring is `Δv √(p_N m/2)`, so a
/// bond just stronger holds and one just weaker breaks.
#[test]
fn a_bond_in_tension_breaks_at_its_strength() {
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let (v, m) = (0.2, rock.mass_kg());
    // relative speed 2v on the reduced mass m/2: F = 2v √(p_N m/2)
    let pull = 2.0 * v * (GROUND.normal_stiffness_n_m * 0.5 * m).sqrt();
    let area = std::f64::consts::PI * 0.25;
    for (share, holds) in [(1.03, true), (0.97, false)] {
        let strength = BondStrength { tensile_pa: share * pull / area, cohesion_pa: 1e12 };
        let world = World { restitution: 1.0, tolerance_m_s: 1e-5, strength, ..WORLD };
        let spheres = [free(-0.5, 0.0, [-v, 0.0, 0.0]), free(0.5, 0.0, [v, 0.0, 0.0])];
        let falls = world.falls(&space(), &spheres, 1.0);
        let apart = falls[1].end.position_m.x - falls[0].end.position_m.x;
        assert_eq!(apart < 1.01, holds, "{share}: {apart}");
        momentum_is_kept(&falls);
    }
}

/// Two bonded spheres that spin about each other in flight load their bond at once with `m ω² R`, and its damped spring swings to `1 + e` times that, as
/// half-swings shrink by `e`. A bond that bears less breaks, at the usual local error too, whatever its stiffness: steps that were long against the
/// swing let it bear a quarter more than it can.
#[test]
fn a_bond_loaded_at_once_bears_what_its_spring_swings_to() {
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let (spin, area) = (6.0, std::f64::consts::PI * 0.25);
    for (stiffness_n_m, restitution) in
        [(1e8, 0.5), (1e9, 0.5), (1e11, 0.5), (1e9, 0.01), (1e9, 1.0)]
    {
        let pull = (1.0 + restitution) * rock.mass_kg() * spin * spin * rock.radius_m;
        for (share, holds) in [(1.03, true), (0.95, false)] {
            let strength = BondStrength { tensile_pa: share * pull / area, cohesion_pa: 1e9 };
            let usual = World { tolerance_m_s: 0.05, strength, ..WORLD };
            let world = World { restitution, stiffness_n_m, ..usual };
            let sphere =
                |x: f64| (0.5, 2700.0, [x, 0.0, 20.0], [0.0, spin * x, 0.0], [0.0, 0.0, spin]);
            let falls = world.falls(&space(), &[sphere(-0.5), sphere(0.5)], 0.3);
            let apart = (falls[1].end.position_m - falls[0].end.position_m).norm();
            assert_eq!(
                apart < 1.01,
                holds,
                "{stiffness_n_m:e} N/m, e = {restitution}, {share}: {apart}"
            );
            momentum_is_kept(&falls);
        }
    }
}

/// A bond has the section of the smaller rock: spheres of 0.25 and 0.5 m pulled apart by their own speeds, with no momentum in sum, load it by
/// `u √(p_N m)` with their relative speed and their reduced mass, and it holds `σ π 0.25²`.
#[test]
fn a_bond_of_unequal_rocks_has_the_section_of_the_smaller() {
    let (radii_m, density_kg_m3, u) = ([0.25, 0.5], 2700.0, 0.4);
    let [light, heavy] = radii_m.map(|radius_m| Rock { radius_m, density_kg_m3 }.mass_kg());
    let pull = u * (GROUND.normal_stiffness_n_m * light * heavy / (light + heavy)).sqrt();
    let area = std::f64::consts::PI * 0.25_f64.powi(2);
    for (share, holds) in [(1.03, true), (0.97, false)] {
        let strength = BondStrength { tensile_pa: share * pull / area, cohesion_pa: 1e12 };
        let world = World { restitution: 1.0, tolerance_m_s: 1e-5, strength, ..WORLD };
        let sphere = |k: usize, x: f64, v: f64| {
            (radii_m[k], density_kg_m3, [x, 0.0, 20.0], [v, 0.0, 0.0], [0.0; 3])
        };
        let (slow, fast) = (u * light / (light + heavy), u * heavy / (light + heavy));
        let falls = world.falls(&space(), &[sphere(0, -0.25, -fast), sphere(1, 0.5, slow)], 1.0);
        let apart = falls[1].end.position_m.x - falls[0].end.position_m.x;
        assert_eq!(apart < 0.76, holds, "{share}: {apart}");
        momentum_is_kept(&falls);
    }
}

/// Two bonded spheres slide past each other without normal force: shear breaks the bond at `c A`.
#[test]
fn a_bond_in_shear_breaks_at_its_cohesion() {
    for (cohesion_pa, holds) in [(1e9, true), (1e3, false)] {
        let strength = BondStrength { tensile_pa: 1e9, cohesion_pa };
        let world = World { tolerance_m_s: 1e-5, strength, ..WORLD };
        let spheres = [free(-0.5, 0.0, [0.0, -0.1, 0.0]), free(0.5, 0.0, [0.0, 0.1, 0.0])];
        let falls = world.falls(&space(), &spheres, 4.0);
        let apart = (falls[1].end.position_m - falls[0].end.position_m).norm();
        assert_eq!(apart < 1.01, holds, "{cohesion_pa}: {apart}");
        momentum_is_kept(&falls);
    }
}

/// Bonded spheres that fly over the border of the terrain leave it as loose ones do. What was bonded did not fly, fell on below until its time
/// was up, and that fall counted.
#[test]
fn bonded_spheres_leave_the_terrain_at_its_border() {
    let strength = BondStrength { tensile_pa: 1e12, cohesion_pa: 1e12 };
    let world =
        World { scheme: Scheme::Adaptive, tolerance_m_s: 0.01, gravity_m_s2: 9.81, ..WORLD };
    let spheres = [free(-0.5, 25.0, [0.0, 8.0, 0.0]), free(0.5, 25.0, [0.0, 8.0, 0.0])];
    let falls = World { strength, ..world }.falls(&plane(), &spheres, 30.0);
    for fall in &falls {
        assert_eq!(fall.stop, Stop::LeftTerrain);
        let end = fall.end.position_m;
        assert!((40.0..42.0).contains(&end.y) && end.z > 0.0, "{end:?}");
    }
}

/// Bonded spheres that fall beside the border of a plate far below, with no ground under them, are still above the terrain while one of them strikes that:
/// of equal masses, and of a heavy one and a light one that turns round it, whose centre of mass falls straight.
#[test]
fn bonded_spheres_strike_a_border_that_lies_ahead_of_them() {
    let strength = BondStrength { tensile_pa: 1e12, cohesion_pa: 1e12 };
    let world =
        World { scheme: Scheme::Adaptive, tolerance_m_s: 0.01, gravity_m_s2: 9.81, ..WORLD };
    let at = |x: f64, y: f64| Vec3::new(x, y, -10.0);
    let plate = [at(0.2, -20.0), at(40.0, -20.0), at(40.0, 20.0), at(0.2, 20.0)];
    let ground = terrain(vec![[plate[0], plate[1], plate[2]], [plate[0], plate[2], plate[3]]]);
    for (density, turns_m_s) in [(2700.0, 0.0), (270.0, 3.0)] {
        let share = density / 2700.0;
        let spin = [0.0, 0.0, turns_m_s * (1.0 + share)];
        let spheres = [
            (0.5, 2700.0, [0.0, -0.5, 0.0], [turns_m_s * share, 0.0, 0.0], spin),
            (0.5, density, [0.0, 0.5, 0.0], [-turns_m_s, 0.0, 0.0], spin),
        ];
        let falls = World { strength, ..world }.falls(&ground, &spheres, 30.0);
        for fall in &falls {
            assert_eq!(fall.stop, Stop::LeftTerrain);
            let fallen_m = fall.start.position_m.z - fall.end.position_m.z;
            assert!(fallen_m > 8.0, "{density}: {:?}", fall.end);
        }
    }
}

/// No strength at all is the plain contact, bit for bit: no bond is made.
#[test]
fn a_bond_without_strength_is_a_plain_contact() {
    let spheres = [free(-0.5, 0.0, [0.3, 0.1, 0.0]), free(0.5, 0.0, [0.0; 3])];
    let plain = WORLD.falls(&space(), &spheres, 1.0);
    let nothing = World { strength: BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 }, ..WORLD };
    assert_eq!(plain, nothing.falls(&space(), &spheres, 1.0));
}

/// Two rocks of `radii_m`, one on the other, that fall on the ground at `speed_m_s` and are bonded for ever, by their springs and dashpots in steps
/// of a thousandth of a radian: the largest pull of the bond (N) and the speed of the upper one at the end (m/s).
fn falls_bonded(
    world: &World,
    radii_m: [f64; 2],
    (speed_m_s, longest_s): (f64, f64),
) -> (f64, f64) {
    let m = radii_m.map(|radius_m| Rock { radius_m, density_kg_m3: 2700.0 }.mass_kg());
    let stiffness = world.stiffness_n_m;
    let zeta = damping_ratio(world.restitution);
    let dashpots = [m[0], m[0] * m[1] / (m[0] + m[1])].map(|m| 2.0 * zeta * (stiffness * m).sqrt());
    let dt = 1e-3 * (m[0].min(m[1]) / stiffness).sqrt();
    let (mut ways, mut v, mut pull_n) = ([0.0; 2], [-speed_m_s; 2], 0.0_f64);
    for _ in 0..(longest_s / dt) as u64 {
        let pressed_n = (-stiffness * ways[0] - dashpots[0] * v[0]).max(0.0);
        let ground_n = if ways[0] < 0.0 { pressed_n } else { 0.0 };
        let bond_n = stiffness * (ways[0] - ways[1]) + dashpots[1] * (v[0] - v[1]);
        pull_n = pull_n.max(-bond_n);
        for (k, force_n) in [ground_n - bond_n, bond_n].into_iter().enumerate() {
            v[k] += dt * (force_n / m[k] - world.gravity_m_s2);
            ways[k] += dt * v[k];
        }
    }
    (pull_n, v[1])
}

/// Rocks bonded one on the other fall on the ground: their bond bears what it swings to after the blow, at the usual local error. Without damping bonds
/// broke that were 1.6 times as strong as all pulls on them, and a bond that held took a third of the rebound from the rocks.
#[test]
fn a_bond_that_falls_bears_what_it_swings_to() {
    let (speed_m_s, longest_s) = (3.0, 0.06);
    for (radii_m, restitution) in
        [([0.3, 0.3], 1.0), ([0.15, 0.4], 1.0), ([0.3, 0.1], 1.0), ([0.3, 0.1], 0.5)]
    {
        let ground = Ground {
            normal_stiffness_n_m: 1e8,
            shear_stiffness_n_m: 2.5e7,
            restitution: Some(restitution),
            friction_angle_rad: 0.0,
            ..GROUND
        };
        let (stiffness_n_m, gravity_m_s2) = (1e8, 9.81);
        let of_pair = World { gravity_m_s2, restitution, stiffness_n_m, ground, ..WORLD };
        let world = World { tolerance_m_s: 0.05, friction_angle_rad: 0.0, ..of_pair };
        let (pull_n, rebound_m_s) = falls_bonded(&world, radii_m, (speed_m_s, longest_s));
        let section_m2 = std::f64::consts::PI * radii_m[0].min(radii_m[1]).powi(2);
        for (share, holds) in [(0.9, false), (1.1, true), (10.0, true)] {
            let pa = share * pull_n / section_m2;
            let world =
                World { strength: BondStrength { tensile_pa: pa, cohesion_pa: pa }, ..world };
            let sphere = |k: usize, z: f64| {
                (radii_m[k], 2700.0, [0.0, 0.0, z], [0.0, 0.0, -speed_m_s], [0.0; 3])
            };
            let spheres = [sphere(0, radii_m[0]), sphere(1, 2.0 * radii_m[0] + radii_m[1])];
            let falls = world.falls(&plane(), &spheres, longest_s);
            let case = format!("{radii_m:?}, e = {restitution}, {share} of the pull");
            let up_m_s = falls[1].end.velocity_m_s.z;
            let apart_m = falls[1].end.position_m.z - falls[0].end.position_m.z;
            let gap_m = apart_m - radii_m[0] - radii_m[1];
            assert_eq!(gap_m < 1e-3, holds, "{case}: {gap_m:e} m apart");
            if holds {
                assert!(
                    (up_m_s - rebound_m_s).abs() < 0.06 * rebound_m_s,
                    "{case}: {up_m_s}, not {rebound_m_s} m/s"
                );
            }
        }
    }
}

/// A bond that nothing damps goes on vibrating, at the usual local error: after 50 vibrations it keeps most of its energy. It kept nothing after ten.
#[test]
fn an_undamped_bond_vibrates_on() {
    let strength = BondStrength { tensile_pa: 1e9, cohesion_pa: 1e9 };
    let world = World { tolerance_m_s: 0.05, restitution: 1.0, strength, ..WORLD };
    let spheres = [free(-0.5, 0.0, [-0.3, 0.0, 0.0]), free(0.5, 0.0, [0.3, 0.0, 0.0])];
    let omega = (2.0 * world.stiffness_n_m
        / Rock { radius_m: 0.5, density_kg_m3: 2700.0 }.mass_kg())
    .sqrt();
    let falls = world.falls(&space(), &spheres, 50.0 * std::f64::consts::TAU / omega);
    let released_j: f64 = falls.iter().map(|fall| fall.start.translational_j(&fall.rock)).sum();
    let kept_j: f64 = falls.iter().map(|fall| fall.end.translational_j(&fall.rock)).sum();
    let in_springs_j: f64 = falls.iter().map(|fall| fall.ledger.springs_j).sum();
    let share = (kept_j + in_springs_j) / released_j;
    assert!((0.9..1.0 + 1e-3).contains(&share), "{share}");
}

/// Velocity (m/s) after a time (s) of the second of two bonded spheres that turn about their line, x, with `Ω` (rad/s), and part along y with a velocity
/// `v` each and spins that leave no angular momentum across the line. Their spring turns with them, and their line with the way `d` between them:
/// `ξ' = s + Ω x×ξ`, `s = d' + p − Ω x×d`, `d'' = −2 f/m`, `p' = −5 f/m` by the spins across the line, `f = p_s ξ + c s` with a critical dashpot.
fn turning_m_s(world: &World, mass_kg: f64, (about, v, time_s): (f64, f64, f64)) -> Vec3 {
    let k = 0.25 * world.stiffness_n_m;
    let c = 2.0 * (k * mass_kg / 7.0).sqrt();
    let turned = |x: &Vec3| (Vec3::x() * about).cross(x);
    let rates = |[stretch, apart, by_spin, way]: &[Vec3; 4]| {
        let slip = apart + by_spin - turned(way);
        let pulled = (stretch * k + slip * c) / mass_kg;
        [slip + turned(stretch), pulled * -2.0, pulled * -5.0, *apart]
    };
    let along = |now: &[Vec3; 4], rates: [Vec3; 4], dt: f64| {
        std::array::from_fn::<_, 4, _>(|k| now[k] + rates[k] * dt)
    };
    let mut now = [Vec3::zeros(), Vec3::y() * (2.0 * v), Vec3::y() * (5.0 * v), Vec3::zeros()];
    let dt = time_s / 1000.0;
    for _ in 0..1000 {
        let middle = along(&now, rates(&now), 0.5 * dt);
        now = along(&now, rates(&middle), dt);
    }
    now[1] * 0.5
}

/// A bond between rocks that turn about their line holds them along the surface with a spring that turns with them, so that they slip aside.
#[test]
fn the_spring_of_a_bond_turns_with_its_rocks_about_their_line() {
    let strength = BondStrength { tensile_pa: 1e9, cohesion_pa: 1e9 };
    let world = World { tolerance_m_s: 1e-6, restitution: 1.0, strength, ..WORLD };
    let mass_kg = Rock { radius_m: 0.5, density_kg_m3: 2700.0 }.mass_kg();
    let omega = (7.0 * 0.25 * world.stiffness_n_m / mass_kg).sqrt();
    let (about, v, time_s) = (0.3 * omega, 0.003, 2.0 / omega);
    let sphere = |side: f64| -> together::Sphere {
        let spin = [about, 0.0, -2.5 * v / 0.5];
        (0.5, 2700.0, [0.5 * side, 0.0, 20.0], [0.0, v * side, 0.0], spin)
    };
    let falls = world.falls(&space(), &[sphere(-1.0), sphere(1.0)], time_s);
    let exact = turning_m_s(&world, mass_kg, (about, v, time_s));
    let off = (falls[1].end.velocity_m_s - exact).norm();
    assert!(exact.z < -0.02 * v && off < 1e-3 * v, "{:?} {exact:?}", falls[1].end);
}
