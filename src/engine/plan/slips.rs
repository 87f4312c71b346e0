//! Numbers that look like another unit: allowed, but most likely a slip.

mod unlikely;

use crate::frequency::volume_m3;
use crate::math;
use crate::scene::{BarrierTable, GroundTable, Scene};

/// Densities of rock (kg/m³): pumice is lighter, ore heavier.
const ROCK_KG_M3: [f64; 2] = [1000.0, 5000.0];
/// Friction angle below which a number is rather in radians (degrees): π/2 and a little.
const RADIANS: f64 = 1.6;
/// Capacity below which a number is rather in kJ (J): nets are tested from 100 kJ on (EAD 340059).
const LEAST_NET_J: f64 = 10e3;
/// Height above which no net stands (m): the tallest in use have about 10 m. Above, a number is rather in cm, or a dam's.
const TALLEST_NET_M: f64 = 12.0;
/// Height from which on it is rather in cm (m): no dam is as high.
const CENTIMETRES: f64 = 50.0;
/// Energy below which a number is rather in kJ (J): thin stems break at some kJ, and weak intensities end at 30 kJ.
const LEAST_J: f64 = 1e3;
/// Radius of the largest single rocks (m): above, a number is rather in cm or mm.
pub(super) const LARGEST_M: f64 = 20.0;
/// Codes that EPSG gives to coordinate systems.
const EPSG: std::ops::RangeInclusive<u32> = 1024..=32_767;
/// Runs of codes that EPSG gives to geographic systems, whose coordinates are degrees, and the most used single ones.
const GEOGRAPHIC: [std::ops::RangeInclusive<u32>; 6] =
    [4120..=4389, 4600..=4646, 4657..=4763, 4490..=4490, 4937..=4937, 4979..=4979];
/// Web Mercator, whose lengths are those of the equator: elsewhere slopes come out too gentle.
const WEB_MERCATOR: u32 = 3857;

/// What looks like a slip of units; the meshes may name a system where the scene does not.
pub(super) fn of(scene: &Scene, mesh_epsg: Option<u32>) -> Vec<String> {
    let mut found = Vec::new();
    found.extend(density(scene.rocks.density_kg_m3));
    found.extend(size(scene));
    for (name, ground) in &scene.grounds {
        let (low, high) = ground.friction_angle_deg.support();
        if low > 0.0 && high <= RADIANS {
            found.push(format!(
                "[grounds.{name}] friction_angle_deg = {high} is next to no friction; is it in radians? that would be {:.1}",
                high.to_degrees()
            ));
        }
    }
    found.extend(scene.grounds.iter().filter_map(|(name, ground)| falling_friction(name, ground)));
    for barrier in scene.barriers.iter().filter(|barrier| barrier.capacity_j < LEAST_NET_J) {
        found.push(format!(
            "[[barriers]] \"{}\" capacity_j = {} takes next to nothing; is it in kJ? write {:e}",
            barrier.name,
            barrier.capacity_j,
            1e3 * barrier.capacity_j
        ));
    }
    found.extend(scene.barriers.iter().filter_map(tall));
    let asked = scene.frequency.as_ref().and_then(|table| table.energies_j.as_deref());
    found.extend(asked.and_then(limit));
    found.extend(scene.grounds.iter().filter_map(|(name, ground)| stems(name, ground)));
    found.extend(scene.epsg.or(mesh_epsg).and_then(epsg));
    found.extend(unlikely::of(scene));
    found
}

/// A barrier that is higher than any net.
fn tall(barrier: &BarrierTable) -> Option<String> {
    let BarrierTable { name, height_m, .. } = barrier;
    let hint = if *height_m >= CENTIMETRES {
        format!("is it in cm? write {}", height_m / 100.0)
    } else {
        "the tallest in use have about 10 m".to_owned()
    };
    (*height_m > TALLEST_NET_M).then(|| {
        format!("[[barriers]] \"{name}\" height_m = {height_m} is higher than any net; {hint}")
    })
}

/// Rocks larger than any, by the key that says how large they are.
fn size(scene: &Scene) -> Option<String> {
    let radius_m = scene.rocks.radius_m().reckoned()[2];
    let reaches = if scene.draws_volumes() {
        format!("volume_m3 reaches {:.0} m³, a radius of {radius_m:.4} m", volume_m3(radius_m))
    } else {
        format!("[rocks] radius_m reaches {radius_m:.4}")
    };
    let unit = if scene.draws_volumes() {
        "in litres? write cubic metres"
    } else {
        "in cm or mm? write metres"
    };
    (radius_m > LARGEST_M).then(|| format!("{reaches}: larger than any single rock; is it {unit}"))
}

/// A limit of energy that is rather in kJ.
fn limit(limits_j: &[f64]) -> Option<String> {
    let energy_j = limits_j.iter().find(|energy_j| **energy_j < LEAST_J)?;
    let in_kj = 1e3 * energy_j;
    Some(format!(
        "[frequency] energies_j holds {energy_j}: a thrown pebble has as much; is it in kJ? write {in_kj:e}"
    ))
}

/// Stems that break at a touch, as their limit is rather in kJ.
fn stems(name: &str, ground: &GroundTable) -> Option<String> {
    let most_j = ground.breaks_above_j.as_ref()?.support().1;
    let in_kj = 1e3 * most_j;
    (most_j < LEAST_J).then(|| {
        format!(
            "[grounds.{name}] breaks_above_j = {most_j} breaks every stem at a touch; is it in kJ? write {in_kj:e}"
        )
    })
}

/// Friction that grows with the way slipped, written so that it falls.
fn falling_friction(name: &str, ground: &GroundTable) -> Option<String> {
    let most = ground.slip_friction?.most;
    let angle_deg = ground.friction_angle_deg.support().1;
    let start = math::tan(angle_deg.to_radians());
    (most < start).then(|| {
        format!(
            "[grounds.{name}] slip_friction.max = {most} is below the friction coefficient {start:.3} of friction_angle_deg = {angle_deg}: friction falls with the way slipped; write {start:.3} or more"
        )
    })
}

fn density(found: f64) -> Option<String> {
    let [least, most] = ROCK_KG_M3;
    let is_likely = |times: f64| (least..=most).contains(&(times * found));
    if is_likely(1.0) {
        return None;
    }
    let hint = if is_likely(1e3) {
        format!("; is it in t/m³? write {}", 1e3 * found)
    } else {
        String::new()
    };
    Some(format!("[rocks] density_kg_m3 = {found}: rock has about 2700{hint}"))
}

fn epsg(code: u32) -> Option<String> {
    if !EPSG.contains(&code) {
        return Some(format!(
            "epsg = {code} is no code of EPSG ({} to {}): rasters are written without a system",
            EPSG.start(),
            EPSG.end()
        ));
    }
    if code == WEB_MERCATOR {
        return Some(format!(
            "epsg = {code} (Web Mercator) stretches lengths by 1/cos(latitude), 1.46 at 46.8°, and leaves heights: slopes are too gentle; bring the data into the projected system of the country, as 2056 (LV95)"
        ));
    }
    GEOGRAPHIC.iter().any(|run| run.contains(&code)).then(|| {
        format!(
            "epsg = {code} is a geographic system in degrees; coordinates are metres here: name the projected system of the meshes, as 2056 (LV95)"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ceiling below where friction begins is said, also where only some rocks begin above it; one above is not.
    #[test]
    fn friction_that_falls_with_the_way_slipped_is_said() {
        let ground = |angle: &str, max: f64| -> GroundTable {
            toml::from_str(&format!(
                "normal_stiffness_n_m = 1e9\ntangential_ratio = 0.5\nrestitution = 0.3\nfriction_angle_deg = {angle}\n\
                 slip_friction = {{ max = {max:?}, kappa_per_m = 0.7, beta_per_s = 20.0 }}"
            ))
            .unwrap()
        };
        // tan 30° = 0.577, tan 40° = 0.839
        for (angle, max, is_said) in
            [("30.0", 0.57, true), ("30.0", 0.58, false), ("{ uniform = [20.0, 40.0] }", 0.8, true)]
        {
            let said = falling_friction("scree", &ground(angle, max));
            assert_eq!(said.is_some(), is_said, "{angle} {max} {said:?}");
        }
    }

    /// Energies written in kJ are said, those in J are not; stems that all stand for good have none.
    #[test]
    fn energies_in_kj_are_said() {
        let ground = |more: &str| -> GroundTable {
            let spring = "normal_stiffness_n_m = 1e8\ntangential_ratio = 0.5\nrestitution = 0.2\n";
            toml::from_str(&format!("{spring}friction_angle_deg = 30.0\n{more}")).unwrap()
        };
        for (more, is_said) in [
            ("", false),
            ("breaks_above_j = 50.0", true),
            ("breaks_above_j = { uniform = [30.0, 120.0] }", true),
            ("breaks_above_j = { uniform = [500.0, 90e3] }", false),
        ] {
            assert_eq!(stems("spruce", &ground(more)).is_some(), is_said, "{more}");
        }
        assert!(limit(&[30.0, 300.0]).is_some_and(|said| said.contains("write 3e4")));
        assert!(limit(&[30e3, 300e3]).is_none() && limit(&[]).is_none());
    }

    /// What the issue found in scenes, and what must not be taken for a slip.
    #[test]
    fn slips_are_seen_and_usual_values_are_not() {
        assert!(density(2.7).is_some_and(|said| said.contains("write 2700")));
        assert!(density(2700.0).is_none() && density(1800.0).is_none());
        assert!(density(27_000.0).is_some());
        for wrong in [99_999, 4326, 4258, 4150, 0, 3857] {
            assert!(epsg(wrong).is_some(), "{wrong}");
        }
        for right in [2056, 21_781, 31_287, 25_832, 32_632, 5972, 2154] {
            assert!(epsg(right).is_none(), "{right}");
        }
    }
}
