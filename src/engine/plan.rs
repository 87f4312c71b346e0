//! What a scene needs and what it leaves out, each with its reason; compiled once, shared by all threads.

mod annual;
mod apart;
mod cost;
mod disk;
mod grounds;
mod inputs;
mod listing;
mod settings;
mod sizes;
mod slips;
mod stiffness;
mod trees;
mod recorders;

pub use annual::YearPlan;
pub use cost::{Cost, MOST_SHOWN_POINTS};
pub use disk::DiskUse;
pub use inputs::VERSION;
pub use listing::PlanEntry;
pub use recorders::{EvaluationLine, Footprint, LinePiece, MapGrid, Recorders};
pub use stiffness::{FastWarning, OwnDissipation};

use crate::contact::pair::BondStrength;
use crate::error::Result;
use crate::ground::Ground;
use crate::random::Distribution;
use crate::release::{FailedRelease, Release, Releases};
use crate::scene::{self, BarrierTable, InputFile, Language, ObjectTable, RecordTable};
use crate::scene::{MeasuredEnds, Scene};
use crate::solver::Settings;
use crate::terrain::{Terrain, health::Health, patches::Patched, stems::Stems};
use std::convert::Infallible;
use std::path::PathBuf;

/// A part of the computation that a scene may not need.
#[derive(Debug, Clone, PartialEq)]
pub enum Part<T> {
    /// Needed, with what it takes.
    Kept(T),
    /// Not needed, and why.
    LeftOut(&'static str),
}

impl<T> Part<T> {
    /// Kept if there is something to keep, else left out for the reason.
    fn when(kept: Option<T>, reason: &'static str) -> Self {
        kept.map_or(Self::LeftOut(reason), Self::Kept)
    }

    /// Whether it is kept.
    pub fn is_kept(&self) -> bool {
        self.kept().is_some()
    }

    /// What is kept, if it is.
    pub fn kept(&self) -> Option<&T> {
        if let Self::Kept(kept) = self { Some(kept) } else { None }
    }
}

/// Which paths are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paths {
    /// The first so many releases.
    pub first: usize,
    /// Time between stored points (s).
    pub step_s: f64,
}

/// When a rock counts as at rest: |v| and |ω|R below the speed, for the time, in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestRule {
    /// Speed (m/s).
    pub speed_m_s: f64,
    /// Time (s).
    pub time_s: f64,
}

/// What a scene needs, in numbers: everything that its rocks have in common, and what is left out.
///
/// Printed (`println!("{plan}")`) it is the text of `rockfall plan`.
#[derive(Debug)]
pub struct Plan {
    /// Heading of the report.
    pub title: String,
    /// The scene file.
    pub scene_file: PathBuf,
    /// SHA-256 (hexadecimal) of the scene's text and its mesh files.
    pub scene_hash: String,
    /// Version of this crate, and after the + the fingerprint of its sources.
    pub version: &'static str,
    /// Map position of the mesh files' (0, 0, 0) (m).
    pub mesh_origin_m: [f64; 3],
    /// EPSG code of the map coordinates.
    pub epsg: Option<u32>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of releases; their indices are `0..count`.
    pub count: usize,
    /// How each of them is drawn.
    pub releases: Releases,
    /// Radius of the smallest, the median and the largest rock for the estimates of the plan (m).
    pub radii_m: [f64; 3],
    /// Masses of the release table that are not those of its radii, where the scene says which count.
    pub table_sizes: Option<String>,
    /// How many releases are lifted off steep ground, in words; none where none is.
    pub lifted: Option<String>,
    /// The meshes.
    pub terrain: Terrain,
    /// Health of the meshes; none where the terrain was given and not read from files.
    pub mesh_health: Option<Health>,
    /// The files that went in.
    pub input_files: Vec<InputFile>,
    /// Grounds by polygon, and what they have done to the triangles.
    pub ground_zones: Part<Patched>,
    /// Names of the grounds, in the order of [`Release::grounds`].
    pub ground_names: Vec<String>,
    /// Gravity (m/s²), 0 or more, along −z.
    pub gravity_m_s2: f64,
    /// Scheme, tolerance and step in force.
    pub step: Settings,
    /// Speed below which an impact does not rebound, for the median rock on each ground (m/s).
    pub capture_m_s: Vec<f64>,
    /// What the scheme itself dissipates on each ground; `dda` only.
    pub own_dissipation: Vec<OwnDissipation>,
    /// When a rock is at rest.
    pub rest: RestRule,
    /// Simulated time after which a rock is `TimeUp` (s).
    pub longest_s: f64,
    /// Trees, with the number of their triangles.
    pub trees: Part<usize>,
    /// Stems that give way, and how many; the limits stand in the terrain.
    pub breaking: Part<usize>,
    /// Time steps in free flight; always left out, flights are exact.
    pub flight: Part<Infallible>,
    /// How far a rock has turned; always left out.
    pub orientation: Part<Infallible>,
    /// Rolling friction.
    pub rolling: Part<()>,
    /// Random tilt of contact normals.
    pub roughness: Part<()>,
    /// What soft soil does, ground by ground.
    pub soil: Part<Vec<String>>,
    /// Properties of contacts between rocks, in the form of a ground.
    pub rock_against_rock: Part<Ground>,
    /// One system of equations for all rocks that touch.
    pub coupled_solve: Part<()>,
    /// Bonds between rocks that touch at the start.
    pub bonds: Part<BondStrength>,
    /// Kept paths.
    pub paths: Part<Paths>,
    /// Kept impacts.
    pub impacts: Part<()>,
    /// Evaluation lines.
    pub lines: Part<Vec<EvaluationLine>>,
    /// Barriers; each has an evaluation line of its name.
    pub barriers: Part<Vec<BarrierTable>>,
    /// Objects that rocks may hit; each has an evaluation line of its name.
    pub objects: Part<Vec<ObjectTable>>,
    /// Sources and their frequency.
    pub year: Part<YearPlan>,
    /// Cells of the maps.
    pub maps: Part<MapGrid>,
    /// Bin length of the profile of speed and height over the distance from the release (m).
    pub profile: Part<f64>,
    /// Grounds with values of the catalogue: name, what was taken, source.
    pub catalogued: Vec<String>,
    /// Up to which slope each ground stops a rolling sphere, in words.
    pub rolling_stops: Vec<String>,
    /// Ratio of the springs and tangential restitution of each ground, in words.
    pub tangential: Vec<String>,
    /// Measured ends that the report compares with.
    pub measured: Option<MeasuredEnds>,
    /// What went in, as name and value.
    pub inputs: Vec<(String, String)>,
    /// Rows of the report's title block.
    pub title_block: Vec<(String, String)>,
    /// Where terrain and ground values come from, in words; the first may be empty.
    pub sources: [String; 2],
    /// In which language page and figures speak.
    pub language: Language,
    /// What the user should look at before trusting the results, however many releases there are ([`Self::warnings_for`]).
    pub warnings: Vec<String>,
    /// Warnings that hold only if rocks get as fast as stated in them.
    pub fast_warnings: Vec<FastWarning>,
}

/// Simulated time that all but endlessly rolling rocks stay below (s); the longest journeys of
/// kilometre-long slopes take about a minute.
const LONGEST_S: f64 = 120.0;
/// At rest below this speed (m/s) for [`REST_TIME_S`]: a rock so slow would stop within a millimetre or two.
const REST_SPEED_M_S: f64 = 0.02;
/// At rest after this time below [`REST_SPEED_M_S`] (s).
const REST_TIME_S: f64 = 0.3;
/// Paths kept when the scene does not say: enough to see the spread, few enough to draw.
const PATHS: usize = 500;
/// Time between the points of a kept path when the scene does not say (s).
pub const PATH_STEP_S: f64 = 0.05;

impl Plan {
    /// Reads the meshes of a scene and works out what it needs.
    ///
    /// # Errors
    /// A mesh that cannot be read or used, and as [`Self::compile`].
    pub fn of_scene(scene: &Scene) -> Result<Self> {
        let (terrain, health) = scene.read_terrain()?;
        Ok(Self::compile(scene, terrain)?.with_health(health))
    }

    /// Works out what the scene needs on a terrain that is there already.
    ///
    /// # Errors
    /// A place of release off the terrain, or contact springs too soft to carry the rocks.
    pub fn compile(scene: &Scene, mut terrain: Terrain) -> Result<Self> {
        let step = settings::in_force(&scene.solver);
        scene.check_drawings(&terrain)?;
        grounds::check_size(scene, &terrain)?;
        let releases = Releases::compile(scene, &terrain)?;
        terrain.stems = grounds::stems(scene, &terrain)?;
        let mut warnings = grounds::warnings(scene, &terrain);
        let table_sizes = sizes::of_table(scene, &mut warnings);
        let mut fast_warnings = Vec::new();
        let tried = releases.try_out(&terrain, &mut warnings)?;
        stiffness::check(scene, &terrain, &mut fast_warnings)?;
        let own_dissipation = stiffness::own_dissipation(scene, step.step_s, &mut warnings);
        stiffness::flutter(&step, &mut warnings);
        let year = annual::year(scene, &terrain, &mut warnings)?;
        let objects = annual::objects(scene, &mut warnings);
        let mut lines = recorders::evaluation_lines(scene, &terrain)?;
        warnings.extend(recorders::crossing_themselves(scene));
        lines.extend(annual::evaluation_lines(scene, &terrain)?);
        warnings.extend(recorders::beside_the_terrain(&lines, &terrain));
        let lines = Some(lines).filter(|lines| !lines.is_empty());
        annual::over_release(&tried.made, lines.as_deref(), &mut warnings);
        let longest_s = scene.solver.longest_s.unwrap_or(LONGEST_S);
        stiffness::too_short(&step, longest_s, &mut warnings);
        let values = || scene.grounds.values();
        let between = scene.release.together.then(|| grounds::between_rocks(scene)).flatten();
        let rolls = values().any(|ground| can_exceed_0(ground.rolling_friction.as_ref()));
        let is_rough = values().any(|ground| can_exceed_0(ground.roughness_deg.as_ref()));
        let plan = Self {
            title: scene.title.clone(),
            scene_file: scene.file.clone(),
            scene_hash: scene.hash_in_force(),
            version: VERSION,
            mesh_origin_m: scene.origin_m,
            epsg: scene.epsg.or(terrain.epsg),
            seed: scene.seed,
            count: scene.release.count,
            releases,
            radii_m: scene.rocks.radius_m().reckoned(),
            table_sizes,
            lifted: tried.lifted,
            mesh_health: None,
            input_files: scene.inputs.clone(),
            ground_zones: Part::when(terrain.patched.clone(), "every file has one ground"),
            ground_names: scene.grounds.keys().cloned().collect(),
            gravity_m_s2: scene.gravity_m_s2,
            step,
            capture_m_s: stiffness::capture_m_s(scene, &step),
            own_dissipation,
            rest: RestRule {
                speed_m_s: scene.solver.rest_speed_m_s.unwrap_or(REST_SPEED_M_S),
                time_s: scene.solver.rest_time_s.unwrap_or(REST_TIME_S),
            },
            longest_s,
            trees: Part::when(grounds::tree_triangles(&terrain), "the scene has none"),
            breaking: Part::when(
                terrain.stems.as_ref().map(Stems::count),
                "no ground of trees has breaks_above_j, stems stand for good",
            ),
            flight: Part::LeftOut(
                "nothing but gravity acts between touches, the parabola is exact",
            ),
            orientation: Part::LeftOut(
                "a sphere looks the same from every side; its spin is computed, how far it has turned is not",
            ),
            rolling: Part::when(rolls.then_some(()), "no ground has any"),
            roughness: Part::when(is_rough.then_some(()), "no ground has any"),
            soil: Part::when(grounds::soil(scene), "no ground has any"),
            rock_against_rock: Part::when(between, "releases are independent"),
            coupled_solve: Part::when(
                between.map(|_| ()),
                "one rock has 6 unknowns, a dense factor is enough",
            ),
            bonds: grounds::bonds(scene),
            paths: paths(&scene.record),
            impacts: Part::when(
                scene.record.impacts.unwrap_or(false).then_some(()),
                "not asked for, [record] impacts = true keeps them",
            ),
            lines: Part::when(lines, "the scene has none"),
            barriers: Part::when(
                Some(scene.barriers.clone()).filter(|all| !all.is_empty()),
                "the scene has none",
            ),
            objects,
            year,
            maps: Part::when(
                recorders::map_grid(scene, &terrain)?,
                "not asked for, [maps] cell_m = … writes them",
            ),
            profile: Part::Kept(recorders::profile_step_m(scene, &terrain)?),
            inputs: inputs::of(scene),
            title_block: inputs::title_block(&scene.report),
            sources: [
                scene.report.terrain_source.clone().unwrap_or_default(),
                inputs::ground_source(scene, &grounds::catalogued(scene)),
            ],
            language: scene.report.language.unwrap_or_default(),
            catalogued: grounds::catalogued(scene),
            rolling_stops: grounds::rolling_stops(scene),
            tangential: grounds::tangential(scene),
            measured: scene.calibrate.as_ref().map(scene::CalibrateTable::measured),
            warnings,
            fast_warnings,
            terrain,
        };
        if plan.rock_against_rock.is_kept() && plan.cost(plan.count).is_modest() {
            plan.world()?;
        }
        Ok(plan)
    }

    /// Draws release `index`, a pure function of scene, seed and index.
    ///
    /// # Errors
    /// No ground below the point drawn, or a rock that starts inside the ground or a tree.
    pub fn release(&self, index: usize) -> Result<Release> {
        self.releases.release(&self.terrain, index)
    }

    /// The same, or what is known of a rock that finds no place to start from.
    ///
    /// # Errors
    /// As [`Self::release`].
    pub fn try_release(&self, index: usize) -> std::result::Result<Release, Box<FailedRelease>> {
        self.releases.try_release(&self.terrain, index)
    }

    /// What every rock is watched for.
    pub fn recorders(&self) -> Recorders<'_> {
        Recorders {
            lines: self.lines.kept().map_or(&[], |lines| lines),
            cells: self.maps.kept(),
            profile_step_m: self.profile.kept().copied(),
        }
    }

    /// The same plan with every part kept that this version can keep: leaving out changes the cost, never
    /// the answer.
    #[must_use]
    pub fn keep_everything(self) -> Self {
        let plan = self.without_kernels();
        let triangles = plan.trees.kept().copied().unwrap_or_default();
        let step_s = plan.paths.kept().map_or(PATH_STEP_S, |paths| paths.step_s);
        Self {
            trees: Part::Kept(triangles),
            rolling: Part::Kept(()),
            roughness: Part::Kept(()),
            paths: Part::Kept(Paths { first: plan.count, step_s }),
            impacts: Part::Kept(()),
            terrain: plan.terrain.with_every_feature(),
            ..plan
        }
    }

    /// The same plan with every impact followed step by step, of blocks by implicit stages, in heaps too: the same motion within the error
    /// allowed, in heaps up to the limit of stiff springs.
    #[must_use]
    pub fn without_kernels(mut self) -> Self {
        (self.step.impact_kernels, self.step.rigid_heaps) = (false, false);
        self
    }
}

/// Not cut to the number of releases: a run that goes on with more keeps as many paths as one that asked for them at once.
fn paths(record: &RecordTable) -> Part<Paths> {
    let first = record.paths.unwrap_or(PATHS);
    let step_s = record.path_step_s.unwrap_or(PATH_STEP_S);
    Part::when((first > 0).then_some(Paths { first, step_s }), "[record] paths = 0")
}

fn can_exceed_0(value: Option<&Distribution>) -> bool {
    value.is_some_and(|value| value.support().1 > 0.0)
}
