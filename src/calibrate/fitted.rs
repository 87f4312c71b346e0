//! The fitted scene, written out.

use super::{Calibration, put_all};
use crate::error::{Error, Result};
use crate::random::Distribution;
use crate::scene::{Scene, VaryKey, VaryTable, rewritten};

/// The text of a scene with the fitted values of all ends in the place of its own, a note of them under `[calibrate]`, and
/// the paths of its files in full, so that it may stand anywhere.
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
            Some(name) => fitted.grounds.get(name).and_then(|ground| ground.value_of(key)),
            None => fitted.corner_radius(),
        };
        let key = key.name();
        let Some(value) = written else {
            let why = format!("{}: the fit gives it no value", vary.name());
            return Err(Error::Request(why));
        };
        changes.push((vary.ground.clone(), key, as_written(&value)));
    }
    changes.sort();
    changes.dedup();
    rewritten(&scene.file, &changes)
}

/// A number with six decimals at most.
fn short(number: f64) -> String {
    format!("{:?}", (number * 1e6).round() / 1e6)
}

/// A number, or the triangle that a spread makes of it.
fn as_written(value: &Distribution) -> String {
    let (low, high) = value.support();
    match value.as_fixed() {
        Some(number) => short(number),
        None => format!("{{ triangular = [{0}, {0}, {1}] }}", short(low), short(high)),
    }
}
