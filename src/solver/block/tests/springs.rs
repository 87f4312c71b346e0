//! The exact cases with springs: `adaptive`, `reference` and `dda`.

use super::*;
use crate::solver::Scheme;

fn settings(scheme: Scheme) -> Settings {
    Settings {
        scheme,
        tolerance_m_s: 1e-3,
        step_s: 1e-5,
        shear_memory: true,
        plane_impacts: true,
        capture_speed_m_s: Some(1e-3),
    }
}

fn on_springs(
    scheme: Scheme,
    p_n: f64,
    terrain: Terrain,
    block: Block,
    law: (f64, f64),
) -> BlockRun {
    let mut case = BlockRun::new(terrain, block, law);
    case.ground.normal_stiffness_n_m = p_n;
    case.ground.shear_stiffness_n_m = 0.25 * p_n;
    let rock = Rock { radius_m: case.block.radius_m, density_kg_m3: 2700.0 };
    let own_m_s = Some(if law.1 < 1.0 { 1e-3 } else { 0.0 });
    let capture = Capture { own_m_s, tolerance_m_s: 0.0, gravity_m_s2: G };
    case.law = Law::new(&case.ground, &Damping::of(case.ground.restitution), &rock, &capture);
    case.springs = Some(settings(scheme));
    case
}

const SCHEMES: [Scheme; 3] = [Scheme::Adaptive, Scheme::Reference, Scheme::Dda];

#[test]
fn trial_s7_s8() {
    for scheme in SCHEMES {
        let angle = 20_f64.to_radians();
        let cube = block(&box_surface([1.0; 3]), 0.05);
        let mut case = on_springs(scheme, 1e9, slope(angle, 10.0), cube.clone(), (1.0, 0.4));
        let mut moving = case.start(tilted(angle), still(axes(angle).1 * 0.5));
        let start = moving.pose.centre;
        let t = std::time::Instant::now();
        case.follow(&mut moving, 2.0, |_, _| ());
        let way = (moving.pose.centre - start).norm();
        eprintln!(
            "S7 {scheme:?} way {way:e} v {:e} steps {} {:?}",
            moving.v.norm(),
            case.steps,
            t.elapsed()
        );

        let angle = 40_f64.to_radians();
        let mut case = on_springs(scheme, 1e9, slope(angle, 100.0), cube, (0.5, 0.4));
        let (along, up) = axes(angle);
        let mut moving = case.start(tilted(angle), still(up * 0.5));
        let t = std::time::Instant::now();
        case.follow(&mut moving, 2.0, |_, _| ());
        let a = moving.v.dot(&along) / 2.0;
        eprintln!(
            "S8 {scheme:?} a {a} spin {:e} steps {} {:?}",
            moving.spin(&case.block).norm(),
            case.steps,
            t.elapsed()
        );
    }
}

#[test]
fn trial_s6() {
    for scheme in SCHEMES {
        for p_n in [1e8, 1e10, 1e12] {
            let tilt = 30_f64.to_radians();
            let bar = block(&box_surface([2.0, 0.2, 0.2]), 0.01);
            let mut case = on_springs(scheme, p_n, slope(0.0, 10.0), bar, (0.0, 0.5));
            if scheme == Scheme::Dda {
                case.springs.as_mut().unwrap().step_s = 0.02 * (300.0 / p_n).sqrt();
            }
            let low = 1.0 * sin(tilt) + 0.1 * cos(tilt);
            let centre = Vec3::z() * low;
            let mut moving = case.start(tilted(tilt), [centre, Vec3::z() * -3.0, Vec3::zeros()]);
            let mut out = None;
            let t = std::time::Instant::now();
            case.follow(&mut moving, 0.02, |t, m| {
                if out.is_none() && t > 0.0 && m.v.z > -2.9 {
                    out = Some((t, m.v.z))
                }
            });
            eprintln!(
                "S6 {scheme:?} {p_n:e} v {} w {} lost {:?} steps {} {:?}",
                moving.v.z,
                moving.spin(&case.block).norm(),
                case.lost.sum(),
                case.steps,
                t.elapsed()
            );
        }
    }
}
