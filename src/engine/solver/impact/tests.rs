//! Laws that the impacts must obey.

mod frozen;
mod oracle;
mod passage;
mod plane;
mod straight;

use crate::ground::{Capture, Damping, Ground, Law};
use crate::rock::{Rock, Vec3};
use crate::solver::body::Body;

/// Gravity of the exact cases (m/s²).
const G: f64 = 9.8;

/// The ground of the exact cases: friction angle 30°, `p_s = p_N/4`.
fn ground(p_n: f64, e: f64, rolling_friction: f64) -> Ground {
    let springs = [p_n, 0.25 * p_n];
    Ground { rolling_friction, ..Ground::smooth(springs, std::f64::consts::FRAC_PI_6, Some(e)) }
}

/// A rock and its law.
fn case(ground: &Ground, radius_m: f64, gravity: f64) -> (Body, Law) {
    let rock = Rock { radius_m, density_kg_m3: 2700.0 };
    let capture = Capture { own_m_s: None, tolerance_m_s: 1e-4, gravity_m_s2: gravity };
    let law = Law::new(ground, &Damping::of(ground.restitution), &rock, &capture);
    (Body::new(&rock, gravity), law)
}

/// Numbers in [0, 1), the same every time.
fn uniforms(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// The greater difference of velocity and of spin times radius, relative to the speed of the
/// impact.
fn apart(body: &Body, [v, w]: [Vec3; 2], [v1, w1]: [Vec3; 2], speed: f64) -> f64 {
    (v - v1).norm().max((w - w1).norm() * body.radius) / speed
}

/// Energy of motion (J).
fn motion_j(body: &Body, v: &Vec3, w: &Vec3) -> f64 {
    0.5 * (body.mass * v.norm_squared() + body.inertia * w.norm_squared())
}
