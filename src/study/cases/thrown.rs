//! A box that falls on its lower corners: in the rigid limit by one impulse, on springs by plain explicit fourth-order steps of the plane
//! motion of its two lower balls. Nothing here knows the meshes, leaps and implicit steps that it is compared with.

use super::blocks::{block, on_slope};
use super::meshes::{angle, plane};
use super::{Case, CaseKind, CaseMeasure};
use crate::ground::Damping;
use crate::math;
use crate::rock::Vec3;
use crate::study::bench::{BlockForm, Setup, with_springs};

/// Turn of the box (degrees).
const TURNED_DEG: f64 = 30.0;
/// Radius of its balls (m).
const BALL_M: f64 = 0.002;
/// Its sides (m).
const SIDES_M: [f64; 3] = [0.2, 2.0, 0.2];
/// How fast it falls (m/s).
const FALLS_M_S: f64 = 3.0;
/// Its springs (N/m): so stiff that the balls sink in by a twentieth of their radius, so soft that the rigid limit is some 1e-3 away.
const STIFFNESS_N_M: f64 = 1e10;
/// Time in which the impact is over (s), and explicit steps for it: `ω h` is then 1e-3, and their error below 1e-12.
const OVER_S: f64 = 1e-3;
const EXPLICIT_STEPS: u32 = 20_000;

/// From its centre to the centres of the balls that touch first, turned by so much (rad): across and up (m).
fn lowest(turned_rad: f64) -> (f64, f64) {
    let [_, y, z] = SIDES_M.map(|side| 0.5 * side - BALL_M);
    let low = math::turn(&Vec3::x_axis(), turned_rad) * Vec3::new(0.0, y, -z);
    (low.y, low.z)
}

/// Its moment of inertia about the axis that it is turned about, over its mass (m²).
fn inertia_m2() -> f64 {
    let [_, y, z] = SIDES_M;
    (y * y + z * z) / 12.0
}

/// Speed upwards and spin after the blow of the rigid limit (m/s, rad/s).
fn struck(e: f64) -> [f64; 2] {
    let arm = lowest(-angle(TURNED_DEG)).0;
    let share = 1.0 / (1.0 + arm * arm / inertia_m2());
    let pushed = (1.0 + e) * FALLS_M_S * share;
    [pushed - FALLS_M_S, pushed * arm / inertia_m2()]
}

/// Height of the centre (m), turn (rad), and their rates.
type BarState = [f64; 4];

/// Rates on springs: `m z'' = F − m g`, `I θ'' = F y`, with `F = max(0, 2 p pen + c pen')` of both balls and the damping of the ground's
/// restitution for the mass that they move, `c = 2 ζ √(2 p m_n)`.
fn rate(setup: &Setup, [height, turned, up, spin]: BarState) -> BarState {
    let (arm, low) = lowest(turned);
    let (begun, _) = lowest(-angle(TURNED_DEG));
    let mass = setup.rock.mass_kg();
    let moved = mass / (1.0 + begun * begun / inertia_m2());
    let stiffness = 2.0 * setup.ground.normal_stiffness_n_m;
    let damper = 2.0 * Damping::of(setup.ground.restitution).ratio * (stiffness * moved).sqrt();
    let pressed = BALL_M - height - low;
    // it starts pressed in by nothing, and does not come back before the end
    let push = (stiffness * pressed - damper * (up + spin * arm)).max(0.0);
    [up, spin, push / mass - setup.gravity_m_s2, push * arm / (mass * inertia_m2())]
}

/// Speed upwards and spin at the end on springs (m/s, rad/s).
fn thrown_on_springs(setup: &Setup) -> [f64; 2] {
    let h = OVER_S / f64::from(EXPLICIT_STEPS);
    let mut state = [setup.centre_m.z, -angle(TURNED_DEG), setup.velocity_m_s.z, 0.0];
    for _ in 0..EXPLICIT_STEPS {
        state = math::runge_kutta_4(&state, h, |state| rate(setup, *state));
    }
    [state[2] - setup.gravity_m_s2 * (setup.longest_s - OVER_S), state[3]]
}

pub(super) const THROWN: Case = Case {
    name: "box_thrown",
    title: "A box 2 x 0.2 x 0.2 m tilted by 30° falls at 3 m/s on its lower corners, no friction, restitution 0.5, 0.01 s",
    source: "impulse at the lever of the corners: v' = −v + (1 + e) v m_n/m; springs: explicit Runge-Kutta steps in the plane",
    kind: CaseKind::Impact,
    capture_speed_m_s: 0.0,
    facets: || plane(0.0),
    setup: |_| {
        let flat = block(BlockForm::Box(SIDES_M), BALL_M, (0.0, 0.5));
        let turned = on_slope(&flat, TURNED_DEG, 0.0);
        let ground = with_springs(turned.ground, STIFFNESS_N_M);
        let centre_m = Vec3::z() * (BALL_M - lowest(-angle(TURNED_DEG)).1);
        Setup { ground, centre_m, velocity_m_s: Vec3::z() * -FALLS_M_S, longest_s: 0.01, ..turned }
    },
    exact: Some(|setup, has_springs| {
        let [up, spin] = if has_springs {
            thrown_on_springs(setup)
        } else {
            let [up, spin] = struck(0.5);
            [up - setup.gravity_m_s2 * setup.longest_s, spin]
        };
        vec![
            CaseMeasure {
                what: "velocity upwards (m/s)",
                exact: up,
                scale: FALLS_M_S,
                of: |journey| journey.end.velocity_m_s.z,
            },
            CaseMeasure {
                what: "spin (rad/s)",
                exact: spin,
                scale: FALLS_M_S,
                of: |journey| journey.end.spin_rad_s.norm(),
            },
        ]
    }),
};
