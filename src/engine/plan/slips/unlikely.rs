//! Numbers of barriers, objects, release and gravity that no slope has: allowed, but most likely a slip.

use crate::random::Distribution;
use crate::scene::{BarrierTable, ObjectTable, Scene};

/// Height below which nothing is a barrier (m).
const LOWEST_BARRIER_M: f64 = 0.5;
/// Largest free height over a design (m): UNI 11211-4 asks for half a metre, and at most half of a block.
const MOST_FREE_M: f64 = 5.0;
/// Longest way on which a net stops a rock (m): the largest nets stretch by some 10 m.
const MOST_ELONGATION_M: f64 = 20.0;
/// Gravity on Earth, with a margin (m/s²).
const EARTH_M_S2: std::ops::RangeInclusive<f64> = 9.7..=9.9;
/// Speed of release above which a number is rather in km/h (m/s): few rocks ever fall so fast.
const FASTEST_RELEASE_M_S: f64 = 50.0;
/// A km/h (m/s).
const KM_H: f64 = 1.0 / 3.6;
/// Vehicles that pass on one lane in a day, one every two seconds (–).
const ONE_LANE_A_DAY: f64 = 43_200.0;

/// What no slope has.
pub(super) fn of(scene: &Scene) -> Vec<String> {
    let mut found: Vec<String> = scene.barriers.iter().flat_map(barrier).collect();
    found.extend(scene.objects.iter().filter_map(traffic));
    found.extend(gravity(scene.gravity_m_s2));
    found.extend(release(&scene.release.velocity_m_s));
    found
}

fn barrier(barrier: &BarrierTable) -> Vec<String> {
    let BarrierTable { name, height_m, design, .. } = barrier;
    let mut found = Vec::new();
    if *height_m < LOWEST_BARRIER_M {
        found.push(format!(
            "[[barriers]] \"{name}\" height_m = {height_m} is lower than any net or dam; write metres"
        ));
    }
    let Some(design) = design else { return found };
    if design.free_height_m > MOST_FREE_M {
        found.push(format!(
            "[[barriers]] \"{name}\" design.free_height_m = {} is more than half of any block; is it in cm? write {}",
            design.free_height_m,
            design.free_height_m / 100.0
        ));
    }
    if let Some(elongation_m) = design.elongation_m.filter(|found| *found > MOST_ELONGATION_M) {
        found.push(format!(
            "[[barriers]] \"{name}\" design.elongation_m = {elongation_m} is more than any net stretches; is it in cm? write {}",
            elongation_m / 100.0
        ));
    }
    found
}

fn traffic(object: &ObjectTable) -> Option<String> {
    let per_day = object.vehicles?.per_day;
    (per_day > ONE_LANE_A_DAY).then(|| {
        format!(
            "[[objects]] \"{}\" vehicles.per_day = {per_day}: on one lane, with two seconds from one to the next, {ONE_LANE_A_DAY} pass; is it of a year, or of several lanes?",
            object.name
        )
    })
}

fn gravity(found: f64) -> Option<String> {
    (!EARTH_M_S2.contains(&found))
        .then(|| format!("gravity_m_s2 = {found}: on Earth it is 9.76 to 9.84"))
}

/// The fastest release; a family without bounds is taken as far as it is drawn in practice.
fn release(velocity_m_s: &[Distribution; 3]) -> Option<String> {
    let most = |one: &Distribution| one.reckoned().into_iter().map(f64::abs).fold(0.0, f64::max);
    let speed_m_s = velocity_m_s.iter().map(|one| most(one).powi(2)).sum::<f64>().sqrt();
    (speed_m_s > FASTEST_RELEASE_M_S).then(|| {
        format!(
            "[release] velocity_m_s reaches {speed_m_s:.1} m/s, faster than rocks fall; is it in km/h? write {:.1}",
            speed_m_s * KM_H
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What an audit found in scenes, and usual numbers beside it.
    #[test]
    fn what_no_slope_has_is_said_and_usual_numbers_are_not() {
        assert!(gravity(98.1).is_some() && gravity(1.62).is_some());
        assert!(gravity(9.81).is_none() && gravity(9.8).is_none());
        let along = |value: f64| [0.0, -value, 0.0].map(|one| Distribution::fixed(one).unwrap());
        assert!(release(&along(150.0)).is_some_and(|said| said.contains("write 41.7")));
        assert!(release(&along(1.5)).is_none());
        let road = |per_day: f64| -> ObjectTable {
            toml::from_str(&format!(
                "name = \"road\"\nvehicles = {{ per_day = {per_day:?}, speed_km_h = 60.0, length_m = 4.5 }}"
            ))
            .unwrap()
        };
        assert!(traffic(&road(50_000.0)).is_some() && traffic(&road(20_000.0)).is_none());
    }
}
