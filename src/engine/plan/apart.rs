//! What rocks that share one world may do at the start: touch, and press on each other with their weight.

use super::{Part, Plan};
use crate::error::{Error, Result};
use crate::ground::{Ground, damping_ratio};
use crate::math;
use crate::release::{Release, TYPED_DEPTH};
use crate::scene::Scene;
use crate::solver::impact::largest_followed_ratio;
use crate::solver::island::broad_phase::{Ball, overlapping};

/// Overlap allowed over that which the weight above presses in (–): a wedge presses more than a column.
const PRESSED: f64 = 2.0;

impl Plan {
    /// All releases, in order, of a plan whose rocks share one world.
    ///
    /// # Errors
    /// As for [`Plan::release`], and rocks that overlap deeper than the weight on them would press them together.
    pub fn world(&self) -> Result<Vec<Release>> {
        let releases =
            (0..self.count).map(|index| self.release(index)).collect::<Result<Vec<_>>>()?;
        if let Part::Kept(ground) = &self.rock_against_rock {
            check_apart(self, ground, &releases)?;
        }
        Ok(releases)
    }
}

/// What is said of the sample that the rocks of one world are, and of blows between them; nothing where each has the terrain for itself.
pub(super) fn warnings(scene: &Scene) -> Vec<String> {
    let said = "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare";
    let shared = shares_world(scene).then(|| said.to_owned());
    shared.into_iter().chain(unlike_blows(scene)).collect()
}

fn shares_world(scene: &Scene) -> bool {
    scene.release.together && scene.release.count > 1
}

/// Warns of blows between rocks so unlike in mass, and on contacts so unlike in stiffness, that they are not followed to their end.
fn unlike_blows(scene: &Scene) -> Option<String> {
    let contact = scene.rocks.contact.as_ref().filter(|_| shares_world(scene))?;
    if scene.solver.scheme().has_springs() {
        return None;
    }
    let grounds = || scene.grounds.values();
    let stiffness =
        |k: usize| grounds().map(move |ground| ground.normal_stiffness_n_m.reckoned()[k]);
    let own_n_m = contact.normal_stiffness_n_m;
    let stiffest = stiffness(2).fold(own_n_m, f64::max);
    let softest = stiffness(0).fold(own_n_m, f64::min);
    let given_back =
        grounds().filter_map(|ground| Some(ground.restitution.as_ref()?.reckoned()[0]));
    let least = given_back.chain(contact.restitution).fold(1.0, f64::min);
    let [smallest_m, _, largest_m] = scene.rocks.radius_m().reckoned();
    let (masses, springs) = ((largest_m / smallest_m).powi(3), stiffest / softest);
    let most = largest_followed_ratio(damping_ratio(least));
    (masses * springs > most).then(|| {
        format!(
            "rocks differ up to {masses:.0} times in mass and contacts up to {springs:.0} times in stiffness: where the product is more than {most:.0e} blows through several contacts are taken one by one, and a boulder on a light stone comes off too slowly; write stiffnesses that are nearer to each other, or scheme = \"adaptive\""
        )
    })
}

/// Refuses rocks that overlap deeper than the weight of those above would press them together: their springs would shoot
/// them apart.
fn check_apart(plan: &Plan, ground: &Ground, releases: &[Release]) -> Result<()> {
    let ball = |release: &Release| Ball {
        centre: release.motion.position_m,
        radius: release.rock.radius_m,
    };
    let balls: Vec<Ball> = releases.iter().map(ball).collect();
    let pairs = overlapping(&balls);
    for &(a, b) in &pairs {
        let [one, two] = [a, b].map(|k| &balls[k as usize]);
        let overlap_m = one.radius + two.radius - (one.centre - two.centre).norm();
        let typed_m = TYPED_DEPTH * one.radius.min(two.radius);
        // without weight nothing presses: most pairs need not ask who stands on them
        if overlap_m <= typed_m {
            continue;
        }
        let carried_n = plan.gravity_m_s2 * carried_kg(&balls, &pairs, releases, (a, b));
        let pressed_m = PRESSED * carried_n / ground.normal_stiffness_n_m;
        if overlap_m > pressed_m + typed_m {
            let [a_m, b_m] =
                [one, two].map(|ball| <[f64; 3]>::from(ball.centre + plan.terrain.origin_m));
            return Err(Error::input(
                &plan.scene_file,
                "[release]",
                format!(
                    "found releases {a} at {a_m:.3?} and {b} at {b_m:.3?} to overlap by {overlap_m:.2e} m at the start, where twice what their weight presses in, {pressed_m:.2e} m, is allowed"
                ),
                apart(plan, one.radius + two.radius),
            ));
        }
    }
    Ok(())
}

/// What to write instead of places that are nearer than this (m).
fn apart(plan: &Plan, least_m: f64) -> String {
    let least_m = math::rounded_up(least_m);
    let drawn = "; places drawn on a line or in an area are as near as chance has them";
    let drawn = if plan.releases.are_points() { "" } else { drawn };
    format!("write points_m that are at least {least_m} m apart{drawn}")
}

/// Mass of two rocks and of all that stands on them, directly or through others (kg).
fn carried_kg(
    balls: &[Ball],
    pairs: &[(u32, u32)],
    releases: &[Release],
    (a, b): (u32, u32),
) -> f64 {
    let mut carried = vec![a, b];
    let mut next = 0;
    while let Some(&low) = carried.get(next) {
        next += 1;
        let above = |&(one, two): &(u32, u32)| {
            let other = if one == low { two } else { one };
            let touches = one == low || two == low;
            let height_m = |k: u32| balls[k as usize].centre.z;
            (touches && height_m(other) > height_m(low)).then_some(other)
        };
        for one in pairs.iter().filter_map(above) {
            if !carried.contains(&one) {
                carried.push(one);
            }
        }
    }
    carried.iter().map(|&k| releases[k as usize].rock.mass_kg()).sum()
}
