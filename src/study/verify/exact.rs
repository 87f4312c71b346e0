//! Two spheres and stacks, whose answers are formulas.

use super::{Verification, VerificationRow, timed};
use crate::contact::pair::BondStrength;
use crate::error::Result;
use crate::plan::{Recorders, RestRule};
use crate::release::Release;
use crate::rock::{Motion, Vec3};
use crate::simulation::{
    Observer, PairMaterial, RecordOptions, RunSettings, Trajectory, simulate_world,
};
use crate::solver::Settings;
use crate::study::bench::{GRAVITY_M_S2, GROUND, ROCK};
use crate::study::exact::USUAL;
use crate::terrain::make::jittered_plane;
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use crate::terrain::{Sheet, Terrain};
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub(super) fn run(all: &mut Verification) -> Result<()> {
    let near = [[-1.0, 0.0, 20.0], [1.0, 0.0, 20.0]];
    let (falls, seconds) = timed(|| rocks(&near, [1.0, 0.0, 0.0], 0.0, 2.0))?;
    let row = |quantity, expected: f64, computed: f64, allowed: f64| VerificationRow {
        case: "two equal spheres head-on, e = 0.5",
        scheme: "adaptive",
        quantity,
        expected,
        source: "momentum and restitution",
        computed,
        allowed,
        seconds,
    };
    let speed = |k: usize| falls[k].end.velocity_m_s.x;
    // some twenty steps at a local error of 1e-4 m/s
    all.rows.push(row("speed of the striking sphere (m/s)", 0.25, speed(0), 2e-3));
    all.rows.push(row("speed of the struck sphere (m/s)", 0.75, speed(1), 2e-3));
    // rounding of some hundred steps
    all.rows.push(row("sum of the speeds (m/s)", 1.0, speed(0) + speed(1), 1e-13));
    stack(all)
}

/// `(m1 + m2) g/p_N` below, `m2 g/p_N` above.
fn stack(all: &mut Verification) -> Result<()> {
    let places = [[0.3, 0.2, 0.5], [0.3, 0.2, 1.5]];
    let (falls, seconds) = timed(|| rocks(&places, [0.0; 3], GRAVITY_M_S2, 3.0))?;
    let z = [0, 1].map(|k| falls[k].end.position_m.z);
    let once = ROCK.mass_kg() * GRAVITY_M_S2 / GROUND.normal_stiffness_n_m;
    let pens = [
        ("penetration below (m)", 2.0 * once, 0.5 - z[0]),
        ("penetration above (m)", once, 1.0 - (z[1] - z[0])),
    ];
    for (quantity, expected, computed) in pens {
        all.rows.push(VerificationRow {
            case: "a stack of two spheres at rest",
            scheme: "adaptive",
            quantity,
            expected,
            source: "weight over stiffness",
            computed,
            // what is left of the swing when the stack counts as at rest
            allowed: 1e-3 * expected,
            seconds,
        });
    }
    Ok(())
}

/// Two spheres, the first of them thrown.
fn rocks(
    places: &[[f64; 3]; 2],
    velocity_m_s: [f64; 3],
    gravity_m_s2: f64,
    longest_s: f64,
) -> Result<Vec<Trajectory>> {
    let terrain = terrain(if gravity_m_s2 > 0.0 { jittered_plane(40.0, 8, 0.0) } else { far() })?;
    let step = Settings {
        scheme: USUAL,
        tolerance_m_s: 1e-4,
        step_s: f64::INFINITY,
        shear_memory: true,
        impact_kernels: true,
        rigid_heaps: true,
        corner_way: crate::solver::CORNER_WAY,
        capture_speed_m_s: None,
    };
    let rest = RestRule { speed_m_s: 0.02, time_s: 1.0 };
    let recorders = Recorders::default();
    let course = RunSettings {
        terrain: &terrain,
        gravity_m_s2,
        step: &step,
        rest,
        longest_s,
        recorders,
        seed: 1,
    };
    let releases: Vec<Release> = places
        .iter()
        .zip([velocity_m_s, [0.0; 3]])
        .map(|(place, velocity)| Release {
            rock: ROCK,
            motion: Motion {
                time_s: 0.0,
                position_m: Vec3::from(*place) - terrain.origin_m,
                velocity_m_s: velocity.into(),
                spin_rad_s: Vec3::zeros(),
            },
            grounds: vec![GROUND],
        })
        .collect();
    let strength = BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 };
    let answer = PairMaterial { ground: GROUND, strength };
    let keep = |_| RecordOptions { path_step_s: None, impacts: false };
    let falls = simulate_world(
        &course,
        &releases,
        &answer,
        keep,
        Observer::silent(&AtomicBool::new(false)),
    );
    Ok(falls.unwrap_or_default().0)
}

/// Two far triangles: room to fly in.
fn far() -> Vec<Facet> {
    let corner = |at: f64| {
        let p = Vec3::repeat(at);
        [p, p + Vec3::x(), p + Vec3::y()]
    };
    vec![corner(-50.0), corner(50.0)]
}

fn terrain(facets: Vec<Facet>) -> Result<Terrain> {
    let soup = Soup::from(facets);
    let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), Some(1e-9))?;
    Ok(Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }]))
}
