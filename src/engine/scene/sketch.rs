//! A first scene for a terrain: what is known of it filled in, what only the user knows left to be written.

use crate::error::{Error, Result};
use crate::math;
use crate::rock::Vec3;
use crate::terrain::cliffs::{Cliff, main_cliff};
use crate::terrain::formats::Options;
use crate::terrain::health::Health;
use crate::terrain::read::MeshSource;
use crate::terrain::walls::places_before;
use crate::terrain::{Sheet, Terrain};
use std::path::{Component, Path, PathBuf};

/// The text of a scene for the terrain in a file (a mesh or an elevation model), as it would stand in `scene_file`.
///
/// Releases lie on a line through the largest steep face, or before it where it is a wall. Ground values are not filled in: the
/// scene says so when it is read, and which keys are missing.
///
/// # Errors
/// A file that cannot be read as a terrain, or one without a slope.
pub fn sketch(terrain_file: &Path, scene_file: &Path) -> Result<String> {
    let is_stl = terrain_file.extension().is_some_and(|end| end.eq_ignore_ascii_case("stl"));
    let sheet = Sheet { path: terrain_file.to_owned(), ground: 0, is_tree: false };
    let options = (!is_stl).then(Options::default);
    let source = MeshSource { options, ..MeshSource::stl(sheet) };
    let (terrain, health) = Terrain::read(&[source], Vec3::zeros(), None)?;
    let cliff = main_cliff(&terrain).ok_or_else(|| {
        let remedy = "write a terrain with a slope, or a scene by hand (docs/scene.md)";
        Error::input(terrain_file, "terrain", "found level ground", remedy)
    })?;
    let name = terrain_file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let path = seen_from(scene_file, terrain_file);
    let key = if is_stl { "mesh" } else { "file" };
    let triangles = health.triangles;
    Ok(format!(
        "{HEAD}title = {}\nseed = 2017\n{}\n[[terrain]]\n{key} = {}           # {triangles} triangles\nground = \"slope\"\n{GROUND}{}{}",
        quoted(&name),
        terrain.epsg.map_or_else(|| system(is_stl).to_owned(), |code| format!("epsg = {code}\n")),
        quoted(&path.to_string_lossy()),
        release(&cliff, &terrain),
        REST.replace("LINE", &across(&health, &cliff)),
    ))
}

/// What to write of the map's system where the file names none.
fn system(is_stl: bool) -> &'static str {
    if is_stl { ORIGIN } else { EPSG }
}

/// A line over the middle of the terrain and across the fall of the face, from a quarter of its way to three: an example where rocks
/// may come.
fn across(health: &Health, cliff: &Cliff) -> String {
    let middle = [0, 1].map(|axis| 0.5 * (health.low_m[axis] + health.high_m[axis]));
    let half = [0, 1].map(|axis| 0.5 * (health.high_m[axis] - health.low_m[axis]));
    // a face that falls towards the south has its strike towards the east
    let strike = [-cliff.normal.y, cliff.normal.x];
    // how far the terrain reaches that way, to either side
    let reach = [0, 1]
        .map(|axis| half[axis] / strike[axis].abs())
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let at = |share: f64| [0, 1].map(|axis| middle[axis] + share * reach * strike[axis]);
    let [[x0, y0], [x1, y1]] = [at(-0.5), at(0.5)];
    format!("[[{x0:.1}, {y0:.1}], [{x1:.1}, {y1:.1}]]")
}

const HEAD: &str = "\
# A first scene, written by `rockfall init`. Every key is explained in docs/scene.md.
#   rockfall plan SCENE      what will be computed, what is left out and why
#   rockfall run SCENE       all releases, results and report
";

const EPSG: &str = "# epsg = 2056                      # of the map coordinates: written into rasters and vector files\n";

const ORIGIN: &str = "\
# CHECK: meshes are often exported with a map position subtracted. Then write it here, and add it to all coordinates below.
# origin_m = [2600000.0, 1200000.0, 0.0]
# epsg = 2056                      # of the map coordinates: written into rasters and vector files
";

const GROUND: &str = "
# FILL IN: what the slope is made of. Physics has no default. `rockfall grounds` lists values from the literature and from a
# field test with their sources; `like` takes restitution and rolling friction from there. Any value may be a distribution, as in
# { uniform = [0.3, 0.5] }.
[grounds.slope]
# like = \"rstone/debris\"
# normal_stiffness_n_m = 1e8       # contact springs: 1e7 soft soil … 1e9 rock
# shear_stiffness_n_m = 0.25e8
# friction_angle_deg = 32.0
# restitution = 0.35               # 0 … 1, normal to the ground
# rolling_friction = 0.4           # stands for the shape of the rocks too
# roughness_deg = 8.0              # random tilt of the facets that a rock meets

# CHECK: your rocks.
[rocks]
density_kg_m3 = 2700.0
radius_m = { lognormal = { median = 0.4, sigma = 0.3, min = 0.1, max = 1.2 } }

";

const REST: &str = "
[record]
paths = 200
path_step_s = 0.05

# Evaluation lines: how many rocks cross, how fast, how high, with which energy. Map coordinates.
# [[lines]]
# name = \"road\"
# points_m = LINE

# A net or dam: what it stops and what its design asks for.
# [[barriers]]
# name = \"net\"
# points_m = LINE
# height_m = 4.0
# capacity_j = 1000e3

# Maps of reach, energy and height.
# [maps]
# cell_m = 2.0
";

/// The table of releases: a line through the face, or points before a wall, and what the face is.
fn release(cliff: &Cliff, terrain: &Terrain) -> String {
    let Cliff { line_m, area_m2, heights_m: [foot, top], cosine, normal: _ } = cliff;
    let slope_deg = math::acos(*cosine).to_degrees();
    let face = format!(
        "the largest steep face, {area_m2:.0} m² steeper than {slope_deg:.0}° between {foot:.0} and {top:.0} m"
    );
    let before = places_before(terrain, cliff, ROOM_M);
    let (what, gap, place) = if before.is_empty() {
        let corners = line_m.iter().map(|[x, y, _]| format!("[{x:.1}, {y:.1}]"));
        let gap = "height_m = 0.5                     # gap below the rock at its start\n";
        (format!("the line runs through {face}"), gap, format!("line_m = [{}]", listed(corners)))
    } else {
        let points = before.iter().map(|[x, y, z]| format!("[{x:.1}, {y:.1}, {z:.1}]"));
        let what = format!(
            "the points stand before {face}.\n# Over a line on so steep a wall rocks would be lifted by radii, or find no room. The points are centres of rocks\n# {ROOM_M} m off the wall; larger rocks need more"
        );
        (what, "", format!("points_m = [{}]", listed(points)))
    };
    format!(
        "# CHECK: {what}.\n# Where rocks really come from, you know better.\n\
         [release]\ncount = 1000\n{gap}velocity_m_s = [0.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n{place}\n"
    )
}

fn listed(corners: impl Iterator<Item = String>) -> String {
    corners.collect::<Vec<_>>().join(", ")
}

/// Room before a wall (m): the largest rock of the sketch, and what a decimal of a coordinate may take away.
const ROOM_M: f64 = 1.3;

/// A text as TOML writes it.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// The terrain's path as a scene in `scene_file` has to name it.
fn seen_from(scene_file: &Path, terrain_file: &Path) -> PathBuf {
    let folder = match scene_file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let both = folder.canonicalize().ok().zip(terrain_file.canonicalize().ok());
    let Some((folder, terrain)) = both else { return terrain_file.to_owned() };
    let pairs = folder.components().zip(terrain.components());
    let common = pairs.take_while(|(one, other)| one == other).count();
    // nothing in common but the root: the way there would be as long as the whole
    if common < 2 {
        return terrain;
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(terrain.components().skip(common)).collect()
}
