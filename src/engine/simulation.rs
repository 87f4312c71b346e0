//! One rock from release to rest: leap, touch, step, stop.

mod block;
mod rest;
mod stretches;
mod crossings;
mod driver;
mod sphere;
mod rock_geometry;
mod heights;
mod impacts;
mod passages;
mod recorder;
mod rock_in_contact;
mod settings;
mod single;
mod soil;
mod world;
mod cells;
mod contact_heights;

use crate::body::ShapeKind;
pub use crate::contact::FeatureKind;
use crate::math;
use crate::release::DrawnShape;
use crate::rock::{Motion, Rock, Vec3};
use serde::{Deserialize, Serialize};

pub use cells::CellPassage;
pub use crossings::Crossing;
pub use recorder::RecordOptions;
pub use settings::RunSettings;
pub use single::{Scratch, simulate, simulate_block, simulate_release};
pub use stretches::Stretch;
pub use world::{Observer, PairMaterial, WorldStats, simulate_releases_together, simulate_world};

/// Why a rock's journey ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// Slower than the rest speed for the rest time, in contact.
    AtRest,
    /// Flew out of the box of the meshes.
    LeftTerrain,
    /// Still moving at the longest simulated time.
    TimeUp,
    /// Still moving when its budget of work was spent, see [`Effort::work`].
    OverBudget,
    /// Never began: no place was found where it could start; the reason is kept and counted.
    NotReleased(&'static str),
    /// The computation could not go on; the reason is kept and counted.
    Failed(String),
}

/// What the computation cost, counted (no clock: the same on every machine).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Effort {
    /// Accepted contact steps.
    pub steps: u64,
    /// Rejected contact steps.
    pub rejected: u64,
    /// Free flights leapt over.
    pub leaps: u64,
    /// Passes over the contacts (open–close iterations, Newton or Gauss–Seidel passes).
    pub sweeps: u64,
    /// Triangles tested by leaps and contact queries.
    pub triangles: u64,
    /// Steps whose contact states did not settle (`dda`).
    pub unsettled: u64,
}

impl Effort {
    /// What is held against a rock's budget: steps, accepted or not, and flights.
    pub fn work(&self) -> u64 {
        self.steps + self.rejected + self.leaps
    }

    /// Adds what another rock cost. Every field is named, so that a new counter does not compile until it is summed.
    pub fn add(&mut self, one: &Self) {
        let Self { steps, rejected, leaps, sweeps, triangles, unsettled } = *one;
        self.steps += steps;
        self.rejected += rejected;
        self.leaps += leaps;
        self.sweeps += sweeps;
        self.triangles += triangles;
        self.unsettled += unsettled;
    }
}

/// Where the energy went (J): all but `rise_j` add up to what the rock lost. All entries but `passed_on_j` and
/// `remainder_j` are ≥ 0.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Ledger {
    /// Sliding friction against the slope.
    pub friction_j: f64,
    /// Normal and shear dashpots against the slope.
    pub damping_j: f64,
    /// Rolling friction against the slope.
    pub rolling_j: f64,
    /// Everything lost in contacts with trees.
    pub trees_j: f64,
    /// Drag of soil that gives way.
    #[serde(default)]
    pub soil_j: f64,
    /// Lost in contacts with other rocks, half of what each takes; 0 for a rock alone.
    #[serde(default)]
    pub others_j: f64,
    /// Handed on to other rocks, negative if received; 0 for a rock alone, and in sum over a world.
    #[serde(default)]
    pub passed_on_j: f64,
    /// What the springs of its contacts hold at the end more than at release, half of those with other rocks: not lost, but no motion either.
    #[serde(default)]
    pub springs_j: f64,
    /// What the numerics lost (positive) or gained (negative).
    pub remainder_j: f64,
    /// Largest rise of mechanical energy seen over one contact episode (J), ≥ 0; 0 in exact arithmetic.
    pub rise_j: f64,
}

impl Ledger {
    /// The same with no loss below 0: friction that turns round within a step may seem to work, and springs to give back more than they
    /// took, which is the numerics' gain and stands in the remainder.
    fn without_gains(mut self) -> Self {
        let Self { friction_j, damping_j, rolling_j, trees_j, remainder_j, .. } = &mut self;
        for loss_j in [friction_j, damping_j, rolling_j, trees_j] {
            *remainder_j += loss_j.min(0.0);
            *loss_j = loss_j.max(0.0);
        }
        self
    }
}

/// What a kept path records of one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Motion (local coordinates).
    pub motion: Motion,
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there is none.
    pub clearance_m: f64,
    /// Flight, sliding or sticking.
    pub state: PathState,
    /// How a block is turned, from its principal frame to the world, as a unit quaternion w, x, y, z; none for a sphere.
    pub attitude: Option<[f64; 4]>,
}

/// State of a rock on its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PathState {
    /// No contact.
    Flight,
    /// At least one contact slides.
    Sliding,
    /// In contact, none slides.
    Sticking,
}

impl PathState {
    /// Of a rock in contact.
    pub(crate) fn in_contact(slides: bool) -> Self {
        if slides { Self::Sliding } else { Self::Sticking }
    }
}

/// One impact: a touch with a normal approach speed above the capture speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Time of first touch (s).
    pub time_s: f64,
    /// Touched point (m, local coordinates).
    pub point_m: Vec3,
    /// What was touched.
    pub feature: FeatureKind,
    /// Index into `Terrain::sheets`.
    pub sheet: u16,
    /// Speed of the centre before (m/s).
    pub speed_in_m_s: f64,
    /// Speed of the centre when its patch lets go, or when its time is up (m/s).
    pub speed_out_m_s: f64,
    /// Energy that went into contacts with the mesh (J), ≥ 0; impacts at the same time share it by the squares of their
    /// approach speeds.
    pub energy_lost_j: f64,
    /// What of it the drag of soil took (J).
    pub soil_j: f64,
}

/// Largest values along a journey.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Extremes {
    /// Speed of the centre (m/s).
    pub speed_m_s: f64,
    /// Translational energy (J).
    pub translational_j: f64,
    /// Rotational energy (J).
    pub rotational_j: f64,
    /// Sum of both at one instant (J).
    pub total_j: f64,
    /// Vertical distance from the ground below to the lowest point of the rock (m).
    pub height_m: f64,
}

/// The shape of one rock, as it was drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RockShape {
    /// What it was made from.
    pub kind: ShapeKind,
    /// Second and third side over the first (–).
    pub sides: [f64; 2],
    /// How it was turned at release, from its principal frame to the world: a unit quaternion w, x, y, z.
    pub attitude: [f64; 4],
}

impl RockShape {
    /// That of a sphere among blocks.
    pub const SPHERE: Self =
        Self { kind: ShapeKind::Sphere, sides: [1.0; 2], attitude: [1.0, 0.0, 0.0, 0.0] };

    /// Of a block as it was drawn.
    pub fn new(drawn: &DrawnShape) -> Self {
        let attitude = rock_geometry::quaternion(&drawn.attitude);
        Self { kind: drawn.kind, sides: drawn.sides, attitude }
    }
}

/// One rock's journey, complete.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// Release number, from 0.
    pub index: usize,
    /// The rock.
    pub rock: Rock,
    /// Its shape; none in a scene of spheres.
    pub shape: Option<RockShape>,
    /// At release (local coordinates).
    pub start: Motion,
    /// At the end (local coordinates).
    pub end: Motion,
    /// Why it ended.
    pub stop: Stop,
    /// Largest values.
    pub extremes: Extremes,
    /// Number of impacts (trees included).
    pub impact_count: u32,
    /// Number of impacts on trees.
    pub tree_impact_count: u32,
    /// The impacts, if the plan keeps them.
    pub impacts: Vec<Impact>,
    /// The path, if the plan keeps it.
    pub path: Vec<PathPoint>,
    /// First crossings of the plan's lines, in the order of lines.
    pub crossings: Vec<Crossing>,
    /// Cells of the plan's maps that it passed, in the order of cells.
    pub passages: Vec<CellPassage>,
    /// Stretches of distance from its release that it passed, in their order.
    pub stretches: Vec<Stretch>,
    /// Energy ledger.
    pub ledger: Ledger,
    /// Potential energy released plus kinetic energy at the start (J): the scale of the ledger of a rock alone.
    pub released_j: f64,
    /// Cost.
    pub effort: Effort,
}

impl Trajectory {
    /// A release that could not be made: a row like any other, with nothing in it but the rock and its place.
    pub fn not_released(index: usize, rock: Rock, start: Motion, why: &'static str) -> Self {
        Self {
            index,
            rock,
            shape: None,
            start,
            end: start,
            stop: Stop::NotReleased(why),
            extremes: Extremes::default(),
            impact_count: 0,
            tree_impact_count: 0,
            impacts: Vec::new(),
            path: Vec::new(),
            crossings: Vec::new(),
            passages: Vec::new(),
            stretches: Vec::new(),
            ledger: Ledger::default(),
            released_j: 0.0,
            effort: Effort::default(),
        }
    }

    /// Horizontal distance from release to end (m).
    pub fn runout_m(&self) -> f64 {
        let way = self.end.position_m - self.start.position_m;
        math::hypot(way.x, way.y)
    }

    /// Height lost from release to end (m), positive downwards.
    pub fn drop_m(&self) -> f64 {
        self.start.position_m.z - self.end.position_m.z
    }

    /// Reach angle (Fahrböschung) `atan(drop/runout)` (degrees).
    pub fn reach_angle_deg(&self) -> f64 {
        math::atan2(self.drop_m(), self.runout_m()).to_degrees()
    }

    /// `|numerical remainder| / energy released` (–); of a rock that owes most of its energy to others, over what it had at
    /// its disposal.
    pub fn energy_balance_error(&self) -> f64 {
        let remainder_j = self.ledger.remainder_j.abs();
        match self.disposal_j() {
            disposal_j if disposal_j > 0.0 => remainder_j / disposal_j,
            // rounding of a rock that neither fell nor was struck is no error of what it had
            _ if remainder_j == 0.0 || self.is_by_itself() => 0.0,
            _ => 1.0,
        }
    }

    /// Energy released (J), where others gave less; else with what it received, or the largest it had where that is more:
    /// one that is struck and strikes on keeps nothing of what went through it.
    fn disposal_j(&self) -> f64 {
        let received_j = (-self.ledger.passed_on_j).max(0.0);
        let most_j = (self.released_j.max(0.0) + received_j).max(self.extremes.total_j);
        let is_own = self.is_by_itself() || 2.0 * self.released_j >= most_j;
        if is_own { self.released_j } else { most_j }
    }

    /// Whether it met no other rock.
    fn is_by_itself(&self) -> bool {
        self.ledger.passed_on_j == 0.0 && self.ledger.others_j == 0.0
    }
}
