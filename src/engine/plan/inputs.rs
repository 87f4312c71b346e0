//! What went into a run, as name and value for the report.

use super::{Part, Plan, annual};
use crate::random::Distribution;
use crate::scene::{GroundTable, MeshFile, ReportTable, Scene, known_ground};
use crate::terrain::health::Health;

/// Version of rockfall, and after the + the fingerprint of its sources.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+", env!("ROCKFALL_BUILD"));

impl Plan {
    /// The warnings for another number of releases than the scene's: a target precision asks for more.
    pub fn warnings_for(&self, releases: usize) -> Vec<String> {
        let too_few = match &self.year {
            Part::Kept(year) => annual::too_few(year, releases),
            Part::LeftOut(_) => None,
        };
        self.warnings.iter().cloned().chain(too_few).collect()
    }

    /// The same with what was found in the meshes.
    pub(super) fn with_health(mut self, health: Health) -> Self {
        self.warnings.splice(..0, health.warnings());
        Self { mesh_health: Some(health), ..self }
    }
}

/// The inputs of a scene, name by name.
pub(super) fn of(scene: &Scene) -> Vec<(String, String)> {
    let row = |name: &str, value: String| (name.to_owned(), value);
    let [velocity, spin] = [&scene.release.velocity_m_s, &scene.release.spin_rad_s]
        .map(|vector| vector.each_ref().map(|one| words(one, "")).join(" | "));
    let mut rows = vec![
        row("Rock density", format!("{} kg/m³", scene.rocks.density_kg_m3)),
        row("Rock radius", sizes(scene)),
        row("Velocity at release (x | y | z)", format!("{velocity} m/s")),
        row("Spin at release (x | y | z)", format!("{spin} rad/s")),
    ];
    if let Some(height_m) = &scene.release.height_m {
        rows.insert(2, row("Release above the ground", words(height_m, " m")));
    }
    rows.extend(annual::rows(scene));
    rows.extend(scene.grounds.iter().map(|(name, ground)| ground_row(scene, name, ground)));
    rows
}

/// Sizes as the rocks or the sources have them.
fn sizes(scene: &Scene) -> String {
    if scene.draws_volumes() {
        return "by the volumes of the sources, see below".to_owned();
    }
    words(scene.rocks.radius_m(), " m")
}

fn ground_row(scene: &Scene, name: &str, ground: &GroundTable) -> (String, String) {
    let lies = |meshes: &[MeshFile]| meshes.iter().any(|mesh| mesh.ground == name);
    let what = if lies(&scene.trees) && !lies(&scene.terrain) { "Trees" } else { "Ground" };
    let along = match (&ground.tangential_ratio, &ground.shear_stiffness_n_m) {
        (Some(ratio), _) => format!("{} times that", words(ratio, "")),
        (None, own) => own.as_ref().map_or_else(String::new, |own| words(own, " N/m")),
    };
    let mut parts = vec![
        format!(
            "springs {} normal, {along} along the surface",
            words(&ground.normal_stiffness_n_m, " N/m")
        ),
        format!("friction angle {}", words(&ground.friction_angle_deg, "°")),
    ];
    let said = |name: &str, value: Option<&Distribution>, unit: &str| {
        value.map(|value| format!("{name} {}", words(value, unit)))
    };
    parts.extend(said("restitution", ground.restitution.as_ref(), ""));
    parts.extend(said("rolling friction", ground.rolling_friction.as_ref(), ""));
    parts.extend(said("roughness", ground.roughness_deg.as_ref(), "°"));
    parts.extend(said("roughness length", ground.roughness_length_m.as_ref(), "m"));
    if let Some(soil) = &ground.slip_friction {
        parts.push(format!(
            "friction grows with slip to {}, κ {} 1/m, forgotten with {} 1/s",
            soil.most, soil.kappa_per_m, soil.beta_per_s
        ));
    }
    if let Some(scar) = &ground.scar {
        parts.push(format!(
            "soil of {} kN/m² and {} kg/m³, drags with C = {}",
            scar.strength_kn_m2, scar.soil_density_kg_m3, scar.drag
        ));
    }
    let half = ground.restitution_half_speed_m_s.as_ref();
    parts.extend(said("half of the restitution is left at", half, " m/s"));
    parts.extend(said("gives way above", ground.breaks_above_j.as_ref(), " J"));
    if let Some(known) = ground.like.as_deref().and_then(known_ground) {
        parts.push(format!("like {}", known.name));
    }
    (format!("{what} “{name}”"), parts.join("; "))
}

/// A number to four digits, large ones as powers of ten.
pub(super) fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    if rounded.abs() >= 1e5 { format!("{rounded:e}") } else { rounded.to_string() }
}

/// A number, or how it is drawn: its middle, where nine of ten draws lie, and the family.
fn words(value: &Distribution, unit: &str) -> String {
    if let Some(number) = value.as_fixed() {
        return short(number) + unit;
    }
    let [low, middle, high] = [0.05, 0.5, 0.95].map(|p| short(value.quantile(p)));
    format!("{middle}{unit} ({low} to {high} in nine of ten, {})", value.family())
}

/// The rows of the title block: who, for whom, when; only what the scene says.
pub(super) fn title_block(report: &ReportTable) -> Vec<(String, String)> {
    let ReportTable {
        client,
        project,
        author,
        date,
        terrain_source: _,
        ground_source: _,
        language: _,
    } = report;
    [("Client", client), ("Project", project), ("Author", author), ("Date", date)]
        .into_iter()
        .filter_map(|(name, value)| Some((name.to_owned(), value.clone()?)))
        .collect()
}

/// Where ground values come from: what the scene says, else what can be told from it. Measured ends beside a scene do not
/// make its values calibrated; only a fit does.
pub(super) fn ground_source(scene: &Scene, catalogued: &[String]) -> String {
    if let Some(source) = &scene.report.ground_source {
        return source.clone();
    }
    let fit = match &scene.calibrate {
        Some(_) if scene.is_fitted() => Some(FITTED),
        Some(_) => Some(NOT_FITTED),
        None => None,
    };
    match (catalogued, fit) {
        ([], Some(fit)) => fit.to_owned(),
        ([], None) => "written in the scene; [report] ground_source names no source".to_owned(),
        (list, Some(fit)) => format!("{}. {fit}", list.join(". ")),
        (list, None) => list.join(". "),
    }
}

/// Of the scene that a calibration has written.
const FITTED: &str = "calibrated on measured ends ([calibrate] fitted of the scene)";
/// Of a scene with measured ends beside values that were not fitted to them, or not to these.
const NOT_FITTED: &str =
    "written in the scene; measured ends ([calibrate]) stand beside it and are not fitted";

#[cfg(test)]
mod tests {
    use super::*;

    /// A capacity of 10⁹ kJ stood in the plan as ten digits without a gap.
    #[test]
    fn large_numbers_are_powers_of_ten() {
        let said = [1e9, 2.5e5, 3000.0, 0.005, 1234.56].map(short);
        assert_eq!(said, ["1e9", "2.5e5", "3000", "0.005", "1235"]);
    }
}
