//! The fitted scene, written out.

use super::{Calibration, put_all, soil_value};
use crate::error::{Error, Result};
use crate::random::Distribution;
use crate::scene::{GroundTable, Scene, VaryKey, VaryTable, rewritten};

/// The text of a scene with the fitted values of all ends in the place of its own, and with the paths of its files in
/// full, so that it may stand anywhere.
///
/// # Errors
/// A scene file that has changed meanwhile.
pub fn fitted_scene(scene: &Scene, vary: &[VaryTable], found: &Calibration) -> Result<String> {
    let mut fitted = scene.clone();
    put_all(&mut fitted, vary, &found.whole.values)?;
    let mut changes = Vec::new();
    for vary in vary {
        let key = match vary.key {
            VaryKey::RollingFrictionSpread => VaryKey::RollingFriction,
            key => key,
        };
        let written = match &vary.ground {
            Some(name) => fitted.grounds.get_mut(name).and_then(|ground| value_of(ground, key)),
            None => fitted.rocks.shapes.iter().find_map(|shape| shape.corner_radius).map(short),
        };
        let key = key.name();
        let Some(value) = written else {
            let why = format!("{}: the fit gives it no value", vary.name());
            return Err(Error::Request(why));
        };
        changes.push((vary.ground.clone(), key, value));
    }
    changes.sort();
    changes.dedup();
    rewritten(&scene.file, &changes)
}

/// A value of a ground as a scene writes it.
fn value_of(ground: &mut GroundTable, key: VaryKey) -> Option<String> {
    let value = match key {
        VaryKey::FrictionAngleDeg => Some(&ground.friction_angle_deg),
        VaryKey::Restitution => ground.restitution.as_ref(),
        VaryKey::RestitutionHalfSpeedMS => ground.restitution_half_speed_m_s.as_ref(),
        VaryKey::TangentialRatio => ground.tangential_ratio.as_ref(),
        VaryKey::RollingFriction | VaryKey::RollingFrictionSpread => {
            ground.rolling_friction.as_ref()
        }
        VaryKey::RoughnessDeg => ground.roughness_deg.as_ref(),
        VaryKey::RoughnessLengthM => ground.roughness_length_m.as_ref(),
        _ => return soil_value(ground, key).map(|value| short(*value)),
    };
    value.map(written)
}

/// A number with six decimals at most.
fn short(number: f64) -> String {
    format!("{:?}", (number * 1e6).round() / 1e6)
}

/// A number, or the triangle that a spread makes of it.
fn written(value: &Distribution) -> String {
    let (low, high) = value.support();
    match value.as_fixed() {
        Some(number) => short(number),
        None => format!("{{ triangular = [{0}, {0}, {1}] }}", short(low), short(high)),
    }
}
