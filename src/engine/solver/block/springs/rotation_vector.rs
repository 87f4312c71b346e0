//! Rotation of a block since the start of a step, as a rotation vector.

use crate::math;
use crate::rock::Vec3;
use nalgebra::{Rotation3, Unit};

/// The rotation by a rotation vector (rad).
pub(super) fn rotation_by(turned: &Vec3) -> Rotation3<f64> {
    let angle = turned.norm();
    if angle > 0.0 {
        math::turn(&Unit::new_unchecked(turned / angle), angle)
    } else {
        Rotation3::identity()
    }
}

/// Rate of the rotation vector `θ` of a body that turns with `w`: `θ' = ω − θ×ω/2 + θ×(θ×ω)/12 − …`
/// (Bortz 1971), for small `θ`.
pub(super) fn rotation_vector_rate(turned: &Vec3, w: &Vec3) -> Vec3 {
    let once = turned.cross(w);
    w - once * 0.5 + turned.cross(&once) / 12.0
}
