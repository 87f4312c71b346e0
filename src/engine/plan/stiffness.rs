//! Whether the contact springs carry the rocks, and what a fixed step does to them.

use super::Settings;
use crate::error::{Error, Result};
use crate::ground::{Capture, Damping, Ground, Law};
use crate::random::Distribution;
use crate::rock::Rock;
use crate::scene::{GroundTable, Scene};
use crate::solver::dda::SINGLE_STEP_PHASE;
use crate::terrain::Terrain;

/// Deepest a resting rock may press a spring, over its radius (–): a softer ground is no rigid surface.
const STATIC_DEPTH: f64 = 0.01;
/// Deepest an impact should press a spring, over the rock's radius (–): deeper, neighbouring triangles
/// take part that a rigid rock would not touch.
const IMPACT_DEPTH: f64 = 0.1;
/// The same for the corner of a block, over the corner's radius (–): half of it is the end.
const CORNER_DEPTH: f64 = 0.3;
/// Speed that a single rock seldom passes (m/s); what free fall over the whole slope would give is rarely met.
const SELDOM_PASSED_M_S: f64 = 40.0;
/// Contact oscillation per step (rad) above which an impact is not resolved: the scheme then eats more than a
/// fifth of the speed.
const RESOLVED_PHASE: f64 = 0.3;

/// Shear over normal spring (–): beyond, nothing that a ground may be.
const SHEAR: [f64; 2] = [1e-6, 1e3];

/// A warning that concerns rocks above a speed: where none comes so fast, there is nothing to warn of.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FastWarning {
    /// The speed (m/s).
    pub above_m_s: f64,
    /// In words.
    pub text: String,
}

/// What the fixed-step scheme dissipates by itself on one ground.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnDissipation {
    /// Name of the ground.
    pub ground: String,
    /// Radius (m) with `ω Δt` (rad) of the smallest rock on the stiffest value, the median on the median and
    /// the largest on the softest.
    pub phases: [(f64, f64); 3],
    /// Whether the ground has no restitution of its own, so that the scheme's is the one in force.
    pub is_in_force: bool,
}

/// Own dissipation on every ground, with warnings for steps too long; empty unless the scheme is `dda`.
pub(super) fn own_dissipation(
    scene: &Scene,
    step_s: f64,
    warnings: &mut Vec<String>,
) -> Vec<OwnDissipation> {
    if !scene.solver.scheme().has_fixed_step() {
        return Vec::new();
    }
    let dissipation = |(name, ground): (&String, &GroundTable)| {
        let [soft, median, stiff] = ground.normal_stiffness_n_m.reckoned();
        let stiffness = [stiff, median, soft];
        let mut phases = scene.rocks.radius_m().reckoned().map(|radius_m| (radius_m, 0.0));
        for ((radius_m, phase), stiffness) in phases.iter_mut().zip(stiffness) {
            *phase = step_s * (stiffness / rock(scene, *radius_m).mass_kg()).sqrt();
        }
        warnings.extend(phase_warning(name, phases[0], step_s));
        OwnDissipation { ground: name.clone(), phases, is_in_force: ground.restitution.is_none() }
    };
    scene.grounds.iter().map(dissipation).collect()
}

fn phase_warning(ground: &str, (radius_m, phase): (f64, f64), step_s: f64) -> Option<String> {
    let trouble = if phase >= SINGLE_STEP_PHASE {
        "is thrown back within one step, the livelier the longer the step"
    } else if phase >= RESOLVED_PHASE {
        "does not resolve its impacts"
    } else {
        return None;
    };
    Some(format!(
        "[grounds.{ground}] omega * step_s = {phase:.3} for a rock of {radius_m:.3} m, which {trouble}: write a step_s below {:.1e}",
        step_s * RESOLVED_PHASE / phase
    ))
}

/// A tolerance above twice the capture speed lets slow rocks flutter for ever.
pub(super) fn flutter(step: &Settings, warnings: &mut Vec<String>) {
    if let Some(capture) =
        step.capture_speed_m_s.filter(|capture| step.tolerance_m_s > 2.0 * capture)
    {
        warnings.push(format!(
            "capture_speed_m_s = {capture} is below half the tolerance of {} m/s: slow rocks may flutter and never come to rest; write {} or more",
            step.tolerance_m_s,
            0.5 * step.tolerance_m_s
        ));
    }
}

/// A fixed step so short that a rock may spend its budget of work before its time is up.
pub(super) fn too_short(step: &Settings, longest_s: f64, warnings: &mut Vec<String>) {
    let most = step.scheme.most_work() as f64;
    if step.scheme.has_fixed_step() && longest_s > most * step.step_s {
        warnings.push(format!(
            "step_s = {:e} lets a rock fall for {:.3} s at most before its budget of {most} steps is spent; write a longer step, or a longest_s below that",
            step.step_s,
            most * step.step_s
        ));
    }
}

/// Speed below which the median rock does not rebound from each ground (m/s).
pub(super) fn capture_m_s(scene: &Scene, step: &Settings) -> Vec<f64> {
    let capture = Capture {
        own_m_s: step.capture_speed_m_s,
        tolerance_m_s: step.tolerance_m_s,
        gravity_m_s2: scene.gravity_m_s2,
    };
    let median = |value: &Distribution| value.quantile(0.5);
    let rock = rock(scene, median(scene.rocks.radius_m()));
    let of = |table: &GroundTable| {
        let normal_stiffness_n_m = median(&table.normal_stiffness_n_m);
        let springs = [normal_stiffness_n_m, table.shear_n_m(normal_stiffness_n_m, median)];
        let friction_rad = median(&table.friction_angle_deg).to_radians();
        let ground = Ground::smooth(springs, friction_rad, table.restitution.as_ref().map(median));
        let damping = Damping::of(ground.restitution);
        Law::new(&ground, &damping, &rock, &capture).capture_m_s
    };
    scene.grounds.values().map(of).collect()
}

/// Refuses shear springs so far from the normal one that they are no ground: too soft, a contact takes for ever to slip.
fn check_shear(scene: &Scene) -> Result<()> {
    let fixed = |value: f64| [value; 3];
    let between = scene.rocks.contact.as_ref().map(|contact| {
        let springs = [contact.normal_stiffness_n_m, contact.shear_stiffness_n_m].map(fixed);
        ("[rocks.contact]".to_owned(), springs)
    });
    let grounds = scene.grounds.iter().filter_map(|(name, ground)| {
        let springs = [&ground.normal_stiffness_n_m, ground.shear_stiffness_n_m.as_ref()?];
        Some((format!("[grounds.{name}]"), springs.map(Distribution::reckoned)))
    });
    for (table, [[soft, _, stiff], [low, _, high]]) in grounds.chain(between) {
        let (least, most) = (SHEAR[0] * soft, SHEAR[1] * stiff);
        if low < least || high > most {
            let wrong = if low < least { low } else { high };
            let found = format!("found {wrong:e} beside a normal spring of {soft:e}");
            let remedy = format!(
                "write a value in {least:e}..{most:e}; usual is 0.25 to 1 times the normal spring"
            );
            let place = format!("{table} shear_stiffness_n_m");
            return Err(Error::input(&scene.file, place, found, remedy));
        }
    }
    Ok(())
}

/// Refuses springs that cannot carry the largest rock and warns of those that an impact presses too deep.
pub(super) fn check(
    scene: &Scene,
    terrain: &Terrain,
    warnings: &mut Vec<FastWarning>,
) -> Result<()> {
    if !scene.solver.scheme().has_springs() {
        return check_shear(scene);
    }
    let largest = rock(scene, scene.rocks.radius_m().reckoned()[2]);
    // what presses in: a sphere, or the corner of a block
    let sharpest = scene.sharpest();
    let (pressed_m, deepest) = match sharpest {
        Some(corner) => (corner * largest.radius_m, CORNER_DEPTH),
        None => (largest.radius_m, IMPACT_DEPTH),
    };
    let whose = if sharpest.is_some() { "its corners'" } else { "its" };
    let of = if sharpest.is_some() { " with such corners" } else { "" };
    let fastest_m_s = fastest_m_s(scene, terrain);
    for (name, ground) in &scene.grounds {
        let softest = ground.normal_stiffness_n_m.reckoned()[0];
        let liveliest = ground.restitution.as_ref().map_or(1.0, |e| e.support().1);
        // p_N ≥ e m v²/depth², from the largest penetration √e v/ω of an impact
        let least =
            |v: f64, depth: f64| liveliest * largest.mass_kg() * (v / (depth * pressed_m)).powi(2);
        let at_rest = largest.mass_kg() * scene.gravity_m_s2 / (STATIC_DEPTH * largest.radius_m);
        if softest < at_rest.max(least(fastest_m_s, 1.0)) {
            let usual = at_rest.max(least(fastest_m_s.min(SELDOM_PASSED_M_S), deepest));
            let place = format!("[grounds.{name}] normal_stiffness_n_m");
            let found = format!(
                "found {softest:e}, too soft for a rock of {:.3} m{of} at up to {fastest_m_s:.0} m/s: it would sink in",
                largest.radius_m
            );
            let remedy = format!("write {:.1e} or more", 1.05 * usual.max(at_rest));
            return Err(Error::input(&scene.file, place, found, remedy));
        }
        let needed = least(fastest_m_s.min(SELDOM_PASSED_M_S), deepest);
        if softest < needed {
            let above_m_s =
                deepest * pressed_m * (softest / (liveliest * largest.mass_kg())).sqrt();
            let text = format!(
                "[grounds.{name}] normal_stiffness_n_m = {softest:e} lets a rock of {:.3} m sink in by more than {deepest} of {whose} radius in impacts above {above_m_s:.1} m/s; {needed:.1e} would hold it up to {:.0} m/s",
                largest.radius_m,
                fastest_m_s.min(SELDOM_PASSED_M_S),
            );
            warnings.push(FastWarning { above_m_s, text });
        }
    }
    check_shear(scene)
}

/// Speed of a rock that falls freely from the highest start to the lowest vertex (m/s): no rock is faster.
fn fastest_m_s(scene: &Scene, terrain: &Terrain) -> f64 {
    let (low, high) = terrain.index.bounds();
    let release = &scene.release;
    let gap = release.height_m.as_ref().map_or(0.0, |height| height.support().1);
    let points = release.points_m.iter().flatten().filter_map(|point| point.height_m);
    let highest = points.map(|z| z - terrain.origin_m.z).fold(high.z + gap, f64::max);
    let start2 = release.velocity_m_s.iter().map(|component| {
        let [low, _, high] = component.reckoned();
        low.abs().max(high.abs()).powi(2)
    });
    (start2.sum::<f64>() + 2.0 * scene.gravity_m_s2 * (highest - low.z)).sqrt()
}

fn rock(scene: &Scene, radius_m: f64) -> Rock {
    Rock { radius_m, density_kg_m3: scene.rocks.density_kg_m3 }
}
