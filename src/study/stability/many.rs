//! Rocks that touch each other: mass ratios, one centre for two. The rigid scheme knows rocks alone.

use super::bounds::{DIGITS, SpringImpact, impact_error};
use super::{Notes, SchemeSetting, is_finite, same_bits};
use crate::contact::pair::BondStrength;
use crate::ground::damping_ratio;
use crate::math;
use crate::plan::{Recorders, RestRule};
use crate::release::Release;
use crate::rock::{Motion, Rock, Vec3};
use crate::simulation::{
    Observer, PairMaterial, RecordOptions, RunSettings, Stop, Trajectory, simulate_world,
};
use crate::study::bench::{GRAVITY_M_S2, GROUND, settings, terrain};
use crate::terrain::{Terrain, make};
use std::sync::atomic::AtomicBool;

/// Radius of all of them (m); the density makes the mass.
const RADIUS_M: f64 = 0.5;
/// A sphere: density (kg/m³), height of its centre (m), upward velocity (m/s).
type Sphere = (f64, f64, f64);

/// Spheres above each other at x = 0.3 m, y = 0.2 m.
fn together(
    way: &SchemeSetting,
    on: &Terrain,
    spheres: &[Sphere],
    (gravity_m_s2, longest_s): (f64, f64),
) -> Vec<Trajectory> {
    let step = settings(way.scheme, way.fineness, None);
    let rest = RestRule { speed_m_s: 0.02, time_s: f64::INFINITY };
    let recorders = Recorders::default();
    let course =
        RunSettings { terrain: on, gravity_m_s2, step: &step, rest, longest_s, recorders, seed: 1 };
    let release = |&(density_kg_m3, z, up): &Sphere| Release {
        rock: Rock { radius_m: RADIUS_M, density_kg_m3 },
        motion: Motion {
            time_s: 0.0,
            position_m: Vec3::new(0.3, 0.2, z) - on.origin_m,
            velocity_m_s: Vec3::z() * up,
            spin_rad_s: Vec3::zeros(),
        },
        grounds: vec![GROUND],
    };
    let releases: Vec<Release> = spheres.iter().map(release).collect();
    let strength = BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 };
    let answer = PairMaterial { ground: GROUND, strength };
    let keep = |_| RecordOptions { path_step_s: None, impacts: false };
    simulate_world(&course, &releases, &answer, keep, Observer::silent(&AtomicBool::new(false)))
        .unwrap_or_default()
        .0
}

/// The same twice: holds what must hold of every journey.
fn follow(
    (way, notes, setting): (&SchemeSetting, &mut Notes, &str),
    on: &Terrain,
    spheres: &[Sphere],
    forces: (f64, f64),
) -> Vec<Trajectory> {
    let falls = together(way, on, spheres, forces);
    let again = together(way, on, spheres, forces);
    let good = |fall: &Trajectory| is_finite(fall) && !matches!(fall.stop, Stop::Failed(_));
    let same = falls.iter().zip(&again).all(|(a, b)| same_bits(a, b));
    let is_well = falls.len() == spheres.len() && falls.iter().all(good) && same;
    let law = "settles, finite, same bits again";
    notes.hold(way, setting, law, f64::from(u8::from(!is_well)), 0.0);
    falls
}

/// How long a stack is watched with each scheme (s). Twenty swings of its slowest spring, that of two equal spheres, where a second of rest
/// takes seconds; what `adaptive` leaves grows until a second is over.
const STANDS_S: [f64; 4] = [0.25, 1.0, 0.25, 1.0];
/// What the rigid limit leaves of an overlap (–, over the radius).
const RIGID_OVERLAP: f64 = 2e-5;

/// One on the other: the springs are pressed by `(m₁ + m₂) g/p_N` and `m₂ g/p_N`, whatever the ratio of the masses.
pub(super) fn stack(way: &SchemeSetting, notes: &mut Notes) {
    let (is_rigid, stands_s) = (!way.scheme.has_springs(), way.scheme.of(STANDS_S));
    let floor = terrain(make::jittered_plane(40.0, 8, 0.0));
    let mass = |density_kg_m3| Rock { radius_m: RADIUS_M, density_kg_m3 }.mass_kg();
    for ratio in [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9] {
        // the heavier one is of stone
        let densities =
            if ratio > 1.0 { [2700.0 / ratio, 2700.0] } else { [2700.0, 2700.0 * ratio] };
        let [low, high] = densities.map(mass);
        // the rigid limit has no springs to press
        let press = if is_rigid { 0.0 } else { GRAVITY_M_S2 / GROUND.normal_stiffness_n_m };
        let pens = [(low + high) * press, high * press];
        let z = [RADIUS_M - pens[0], 3.0 * RADIUS_M - pens[0] - pens[1]];
        let spheres = [(densities[0], z[0], 0.0), (densities[1], z[1], 0.0)];
        let setting = format!("upper over lower mass {ratio:.0e}");
        let falls = follow((way, notes, &setting), &floor, &spheres, (GRAVITY_M_S2, stands_s));
        let [a, b] = &falls[..] else { continue };
        let ends = [a, b].map(|fall| fall.end.position_m.z);
        let found = [RADIUS_M - ends[0], 2.0 * RADIUS_M - (ends[1] - ends[0])];
        let off = (0..2).map(|k| (found[k] - pens[k]).abs()).fold(0.0, f64::max);
        // geometry and forces of an implicit stage agree to 1e-9 of the radius, and its sweeps leave a thousandth of the forces
        let stage = 1e-9 + 1e-3 * pens[0] / RADIUS_M;
        let bound = way.scheme.of([DIGITS, stage, stage, RIGID_OVERLAP]);
        notes.hold(way, &setting, "springs off weight over stiffness (m)", off, bound * RADIUS_M);
        let fastest = [a, b].map(|fall| fall.end.velocity_m_s.norm());
        // places are rounded, and over a step that is a speed; what the rigid limit leaves of an overlap comes within the second
        let placed = 4.0 * f64::EPSILON * z[1] / way.fineness;
        // sweeps over masses up to 1e9 apart leave a hundred-thousandth of the weight: so much of `g` for as long
        let swept = 1e-5 * GRAVITY_M_S2 * stands_s;
        let bound = way.scheme.of([placed, swept, swept, RIGID_OVERLAP * RADIUS_M]);
        notes.hold(way, &setting, "speed at the end (m/s)", fastest[0].max(fastest[1]), bound);
    }
}

/// Head-on without gravity: both leave as momentum and restitution say.
pub(super) fn head_on(way: &SchemeSetting, notes: &mut Notes) {
    let space = terrain(far());
    for ratio in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
        let setting = format!("struck over striking mass {ratio:.0e}");
        let densities =
            if ratio > 1.0 { [2700.0 / ratio, 2700.0] } else { [2700.0, 2700.0 * ratio] };
        let spheres = [(densities[0], -1.0, 1.0), (densities[1], 0.5, 0.0)];
        let falls = follow((way, notes, &setting), &space, &spheres, (0.0, 2.0));
        let [a, b] = &falls[..] else { continue };
        let [m, n] = [a, b].map(|fall| fall.rock.mass_kg());
        let v = [a, b].map(|fall| fall.end.velocity_m_s.z);
        let expected = [(m - 0.5 * n) / (m + n), 1.5 * m / (m + n)];
        let off = (v[0] - expected[0]).abs().max((v[1] - expected[1]).abs());
        // the light one's oscillation decides
        let omega = (GROUND.normal_stiffness_n_m * (m + n) / (m * n)).sqrt();
        let phase = way.fineness * omega;
        let lasting = 40.0 * way.fineness;
        let bound = way.scheme.of([phase.min(0.5), impact_error(way, omega), lasting, DIGITS]);
        notes.hold(way, &setting, "velocities off momentum and restitution (m/s)", off, bound);
        if way.scheme.has_fixed_step() {
            let blow = SpringImpact { speed: 1.0, omega, zeta: damping_ratio(0.5), gravity: 0.0 };
            let (left, _) =
                blow.stepped(way.fineness, f64::INFINITY, 4.0 / omega + 4.0 * way.fineness);
            let law = "rebound is what the steps leave (m/s)";
            // places are rounded where the room is 50 m wide
            let placed = 4.0 * f64::EPSILON * ROOM_M / way.fineness;
            notes.hold(way, &setting, law, (v[1] - v[0] - left).abs(), placed);
        }
        let momentum = (m * (v[0] - 1.0) + n * v[1]).abs() / m;
        // the matrix of a fixed step has masses beside springs, `(ω Δt)²` times as large: so many digits are lost
        let lost = if way.scheme.has_fixed_step() { 4.0 * phase * phase } else { 0.0 };
        let bound = DIGITS + lost * f64::EPSILON;
        notes.hold(way, &setting, "momentum lost, over momentum", momentum, bound);
        let energy = (m * v[0] * v[0] + n * v[1] * v[1]) / m - 1.0;
        notes.hold(way, &setting, "energy rise over energy", energy, DIGITS);
    }
}

/// Two spheres about one centre: no force has a direction, and nothing may come of nothing. (A scene that starts so is
/// refused.) In flight they stay together.
pub(super) fn coincident(way: &SchemeSetting, notes: &mut Notes) {
    let space = terrain(far());
    let spheres = [(2700.0, 0.0, 1.0), (2700.0, 0.0, -1.0)];
    let falls = follow((way, notes, ""), &space, &spheres, (0.0, 0.1));
    let [a, b] = &falls[..] else { return };
    let sideways =
        |fall: &Trajectory| math::hypot(fall.end.velocity_m_s.x, fall.end.velocity_m_s.y);
    notes.hold(way, "", "sideways (m/s)", sideways(a).max(sideways(b)), 0.0);
    let (up, down) = (a.end.velocity_m_s.z, b.end.velocity_m_s.z);
    notes.hold(way, "", "momentum, over that of one", (up + down).abs(), DIGITS);
    notes.hold(way, "", "energy rise over energy", up * up - 1.0, DIGITS);
}

/// How far they are (m).
const ROOM_M: f64 = 50.0;

/// Two far triangles: room to fly in.
fn far() -> Vec<crate::terrain::stl::Facet> {
    let corner = |at: f64| {
        let p = Vec3::repeat(at);
        [p, p + Vec3::x(), p + Vec3::y()]
    };
    vec![corner(-ROOM_M), corner(ROOM_M)]
}
