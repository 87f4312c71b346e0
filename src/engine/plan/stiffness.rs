//! Whether the contact springs carry the rocks, and what a fixed step does to them.

use super::Settings;
use super::slips::LARGEST_M;
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
    let median = |value: &Distribution| value.quantile(0.5);
    let rock = rock(scene, median(scene.rocks.radius_m()));
    let block_radius_m = (!scene.rocks.shapes.is_empty()).then_some(rock.radius_m);
    let capture = Capture {
        own_m_s: step.capture_speed_m_s,
        tolerance_m_s: step.speed_error_m_s(scene.gravity_m_s2, block_radius_m),
        gravity_m_s2: scene.gravity_m_s2,
    };
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

/// What presses the springs deepest: the largest rock, by its sharpest corner.
struct Deepest {
    rock: Rock,
    /// Radius of what presses in (m): that of a sphere, or of the corner of a block.
    pressed_m: f64,
    /// How deep it should press in, over that radius (–).
    share: f64,
    is_corner: bool,
}

impl Deepest {
    fn of(scene: &Scene) -> Self {
        let rock = rock(scene, scene.rocks.radius_m().reckoned()[2]);
        let corner = scene.sharpest();
        let pressed_m = corner.unwrap_or(1.0) * rock.radius_m;
        let share = if corner.is_some() { CORNER_DEPTH } else { IMPACT_DEPTH };
        Self { rock, pressed_m, share, is_corner: corner.is_some() }
    }
}

/// The springs of one table and what presses them.
struct PressedSprings {
    table: String,
    /// The softest (N/m).
    softest: f64,
    /// The largest restitution (–).
    liveliest: f64,
    /// Mass that an impact moves (kg).
    moved_kg: f64,
    /// Speed at which no impact is faster (m/s).
    fastest_m_s: f64,
    /// Largest share of that speed that one rock has (–).
    one_rock: f64,
}

impl PressedSprings {
    /// Stiffness at which an impact of some speed (m/s) presses no deeper than a share of the radius (N/m):
    /// `p_N ≥ e m v²/depth²`, from the largest penetration `√e v/ω`.
    fn least(&self, deepest: &Deepest, speed_m_s: f64, share: f64) -> f64 {
        let depth_m = share * deepest.pressed_m;
        self.liveliest * self.moved_kg * (speed_m_s / depth_m).powi(2)
    }

    /// Refuses what cannot carry the rock or hold its fastest impact.
    fn carry(&self, scene: &Scene, deepest: &Deepest) -> Result<()> {
        let radius_m = deepest.rock.radius_m;
        let at_rest = deepest.rock.mass_kg() * scene.gravity_m_s2 / (STATIC_DEPTH * radius_m);
        let least = at_rest.max(self.least(deepest, self.fastest_m_s, 1.0));
        if self.softest >= least {
            return Ok(());
        }
        let usual_m_s = self.fastest_m_s.min(SELDOM_PASSED_M_S);
        let usual = at_rest.max(self.least(deepest, usual_m_s, deepest.share));
        let of = if deepest.is_corner { " with such corners" } else { "" };
        let found = format!(
            "found {:e}, too soft for a rock of {radius_m:.3} m{of} at up to {:.0} m/s: it would sink in",
            self.softest, self.fastest_m_s
        );
        // what holds usual speeds may be less than what was found: then the speed is the mistake, most likely
        let slower = if least > usual {
            format!(
                ", or check height_m and velocity_m_s: rocks are seldom faster than {SELDOM_PASSED_M_S} m/s"
            )
        } else {
            String::new()
        };
        let unit = match (radius_m > LARGEST_M, scene.draws_volumes()) {
            (false, _) => "",
            (true, false) => {
                "check radius_m first, which is larger than any single rock: is it in cm or mm? Else "
            }
            (true, true) => {
                "check volume_m3 first, larger than any single rock: is it in litres? Else "
            }
        };
        let remedy = format!("{unit}write {:.1e} or more{slower}", 1.05 * usual.max(least));
        let place = format!("{} normal_stiffness_n_m", self.table);
        Err(Error::input(&scene.file, place, found, remedy))
    }

    /// Warns of what impacts press deeper than a rigid rock would go.
    fn sinks(&self, deepest: &Deepest) -> Option<FastWarning> {
        let usual_m_s = self.fastest_m_s.min(SELDOM_PASSED_M_S);
        let needed = self.least(deepest, usual_m_s, deepest.share);
        if self.softest >= needed {
            return None;
        }
        let Deepest { rock, pressed_m, share, is_corner } = deepest;
        let above_m_s =
            share * pressed_m * (self.softest / (self.liveliest * self.moved_kg)).sqrt();
        let whose = if *is_corner { "its corners'" } else { "its" };
        let text = format!(
            "{} normal_stiffness_n_m = {:e} lets a rock of {:.3} m sink in by more than {share} of {whose} radius in impacts above {above_m_s:.1} m/s; {needed:.1e} would hold it up to {usual_m_s:.0} m/s",
            self.table, self.softest, rock.radius_m,
        );
        Some(FastWarning { above_m_s: self.one_rock * above_m_s, text })
    }
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
    let deepest = Deepest::of(scene);
    let fall2 = fall2_m2_s2(scene, terrain);
    let grounds = scene.grounds.iter().map(|(name, ground)| PressedSprings {
        table: format!("[grounds.{name}]"),
        softest: ground.normal_stiffness_n_m.reckoned()[0],
        liveliest: ground.restitution.as_ref().map_or(1.0, |e| e.support().1),
        moved_kg: deepest.rock.mass_kg(),
        fastest_m_s: (start2_m2_s2(scene, fastest) + fall2).sqrt(),
        one_rock: 1.0,
    });
    let contact = scene.rocks.contact.as_ref().filter(|_| scene.release.together);
    let between = contact.map(|contact| PressedSprings {
        table: "[rocks.contact]".to_owned(),
        softest: contact.normal_stiffness_n_m,
        liveliest: contact.restitution.unwrap_or(1.0),
        // two that are alike move as one of half the mass against a wall
        moved_kg: 0.5 * deepest.rock.mass_kg(),
        // one falls on another that rests, or both are thrown at each other
        fastest_m_s: (start2_m2_s2(scene, closing) + fall2).sqrt(),
        one_rock: 0.5,
    });
    for springs in grounds.chain(between) {
        springs.carry(scene, &deepest)?;
        warnings.extend(springs.sinks(&deepest));
    }
    check_shear(scene)
}

/// Largest speed of one rock between two components (m/s).
fn fastest([low, high]: [f64; 2]) -> f64 {
    low.abs().max(high.abs())
}

/// Largest speed at which two rocks with components between two come together (m/s).
fn closing([low, high]: [f64; 2]) -> f64 {
    fastest([low, high]).max(high - low)
}

/// Square of a speed at release (m²/s²).
fn start2_m2_s2(scene: &Scene, of: fn([f64; 2]) -> f64) -> f64 {
    let components = scene.release.velocity_m_s.iter().map(Distribution::reckoned);
    components.map(|[low, _, high]| of([low, high]).powi(2)).sum()
}

/// What a free fall from the highest start to the lowest vertex adds to the square of a speed (m²/s²): no rock is faster.
fn fall2_m2_s2(scene: &Scene, terrain: &Terrain) -> f64 {
    let (low, high) = terrain.index.bounds();
    let release = &scene.release;
    let gap = release.height_m.as_ref().map_or(0.0, |height| height.support().1);
    let points = release.points_m.iter().flatten().filter_map(|point| point.height_m);
    let highest = points.map(|z| z - terrain.origin_m.z).fold(high.z + gap, f64::max);
    2.0 * scene.gravity_m_s2 * (highest - low.z)
}

fn rock(scene: &Scene, radius_m: f64) -> Rock {
    Rock { radius_m, density_kg_m3: scene.rocks.density_kg_m3 }
}
