//! How the exact cases start, and the places where they should end.

use super::meshes::angle;
use super::pivot::{self, Lift};
use super::{CASES, Case, CaseMeasure, STILL};
use crate::math;
use crate::rock::Vec3;
use crate::study::bench::{SETUP, Setup};
use std::f64::consts::FRAC_1_SQRT_2;

/// At rest above the origin of [`plane`], pressed in as the weight presses it.
pub(super) fn lying(degrees: f64, has_springs: bool) -> Setup {
    let pressed = if has_springs { SETUP.pressed_m(angle(degrees)) } else { 0.0 };
    let (sin, cos) = math::sin_cos(angle(degrees));
    let height = SETUP.rock.radius_m - pressed;
    Setup { centre_m: Vec3::new(0.0, height * sin, height * cos), ..SETUP }
}

pub(super) fn slippery(setup: &Setup) -> Setup {
    let ground = crate::ground::Ground { friction_angle_rad: math::atan(0.2f64), ..setup.ground };
    Setup { ground, ..*setup }
}

/// On ground without friction that gives back all of an impact.
pub(super) fn elastic() -> Setup {
    let ground =
        crate::ground::Ground { friction_angle_rad: 0.0, restitution: Some(1.0), ..SETUP.ground };
    Setup { ground, ..SETUP }
}

/// Angle from the upright at which spheres begin to tip (rad).
pub(super) const TIPPED_RAD: f64 = 0.1;

/// At rest over the edge of [`roof`], friction in degrees.
pub(super) fn tipping(degrees: f64, has_springs: bool) -> Setup {
    let ground = crate::ground::Ground { friction_angle_rad: angle(degrees), ..SETUP.ground };
    let pressed = if has_springs { SETUP.pressed_m(TIPPED_RAD) } else { 0.0 };
    let lever = SETUP.rock.radius_m - pressed;
    let centre_m = Vec3::new(lever * math::sin(TIPPED_RAD), 0.3, lever * math::cos(TIPPED_RAD));
    Setup { ground, centre_m, ..SETUP }
}

/// The case that tips off an edge without slip, and where its centre is after `t` (s), before it lifts off.
pub(in crate::study) fn rolling_off_an_edge(has_springs: bool, t: f64) -> (Case, Vec3) {
    let case = CASES.into_iter().find(|case| case.name == "pivot_rough").unwrap_or(STILL);
    let setup = (case.setup)(has_springs);
    let (x, z) = if has_springs {
        pivot::on_springs(&setup, TIPPED_RAD, t)
    } else {
        pivot::rolling(setup.rock.radius_m, TIPPED_RAD, t)
    };
    (case, Vec3::new(x, setup.centre_m.y, z))
}

pub(super) fn tipped(setup: &Setup, rigid: &Lift, has_springs: bool) -> Vec<CaseMeasure> {
    let (x, z) = if has_springs {
        pivot::on_springs(setup, TIPPED_RAD, setup.longest_s)
    } else {
        rigid.then(setup.rock.radius_m, setup.longest_s)
    };
    place(x, setup.centre_m.y, z)
}

/// At rest in the middle of a right-angled groove that falls at 20°; friction 50°.
pub(super) fn in_groove(has_springs: bool) -> Setup {
    let ground = crate::ground::Ground { friction_angle_rad: angle(50.0), ..SETUP.ground };
    // Each wall carries N = m g cos 20°/√2; the axis sinks by √2 times what that presses.
    let sinks = if has_springs { SETUP.pressed_m(angle(20.0)) } else { 0.0 };
    let height = SETUP.rock.radius_m / FRAC_1_SQRT_2 - sinks;
    let down = crate::math::turn(&Vec3::x_axis(), -angle(20.0));
    Setup { ground, centre_m: down * Vec3::new(0.0, -3.0, height), ..SETUP }
}

/// Height 1 s after a drop from 1 m with e = 0.5 in the rigid limit: two impacts, at `t_f` and 2 `t_f`, then a parabola (m).
pub(super) fn rigid_bounce_m() -> f64 {
    let g = SETUP.gravity_m_s2;
    let falls = (2.0 / g).sqrt();
    let (left, up) = (1.0 - 2.0 * falls, 0.25 * g * falls);
    SETUP.rock.radius_m + up * left - 0.5 * g * left * left
}

/// The end of a way (m) down a plane that falls in +y.
pub(super) fn along(setup: &Setup, angle_rad: f64, way_m: f64) -> Vec<CaseMeasure> {
    let end = setup.centre_m + Vec3::new(0.0, math::cos(angle_rad), -math::sin(angle_rad)) * way_m;
    place(end.x, end.y, end.z)
}

/// The centre at the end (m).
pub(super) fn place(x: f64, y: f64, z: f64) -> Vec<CaseMeasure> {
    vec![
        CaseMeasure { what: "x (m)", exact: x, scale: 1.0, of: |journey| journey.end.position_m.x },
        CaseMeasure { what: "y (m)", exact: y, scale: 1.0, of: |journey| journey.end.position_m.y },
        CaseMeasure { what: "z (m)", exact: z, scale: 1.0, of: |journey| journey.end.position_m.z },
    ]
}
