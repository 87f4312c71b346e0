//! The simulation of one rock from release to rest: free flight, contact, time step, stop.

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

/// Why the trajectory of a rock ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// Slower than the rest speed for the rest time, in contact.
    AtRest,
    /// Left the bounding box of the meshes.
    LeftTerrain,
    /// Still moving at the longest simulated time.
    TimeUp,
    /// Still moving when its budget of computation was used up, see [`Effort::work`].
    OverBudget,
    /// Not released: no admissible start position was found. The reason is kept and counted.
    NotReleased(&'static str),
    /// The computation failed; the reason is kept and counted.
    Failed(String),
}

/// Cost of the computation in counts (no clock: the same on every machine).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Effort {
    /// Accepted contact steps.
    pub steps: u64,
    /// Rejected contact steps.
    pub rejected: u64,
    /// Free flights, each computed in closed form.
    pub leaps: u64,
    /// Passes over the contacts (open–close iterations, Newton or Gauss–Seidel passes).
    pub sweeps: u64,
    /// Triangles tested in searches for the end of a flight and for contacts.
    pub triangles: u64,
    /// Steps whose contact states did not converge (`dda`).
    pub unsettled: u64,
}

impl Effort {
    /// Work counted against the budget of a rock: steps, accepted or rejected, and flights.
    pub fn work(&self) -> u64 {
        self.steps + self.rejected + self.leaps
    }

    /// Adds the cost of another rock. Every field is named, so that a new counter does not compile
    /// until it is summed.
    pub fn add(&mut self, other: &Self) {
        let Self { steps, rejected, leaps, sweeps, triangles, unsettled } = *other;
        self.steps += steps;
        self.rejected += rejected;
        self.leaps += leaps;
        self.sweeps += sweeps;
        self.triangles += triangles;
        self.unsettled += unsettled;
    }
}

/// Energy balance of a rock (J). All entries except `rise_j` add up to the energy that the rock
/// lost. All entries except `passed_on_j` and `remainder_j` are ≥ 0.
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
    /// Drag of soil that yields.
    #[serde(default)]
    pub soil_j: f64,
    /// Lost in contacts with other rocks: half of the loss of each contact. 0 for a rock alone.
    #[serde(default)]
    pub others_j: f64,
    /// Transferred to other rocks, negative if received. 0 for a rock alone, and 0 in the sum over
    /// a world.
    #[serde(default)]
    pub passed_on_j: f64,
    /// Elastic energy of its contacts at the end less that at release; of contacts with other
    /// rocks, half. It is not lost, but it is no motion either.
    #[serde(default)]
    pub springs_j: f64,
    /// Numerical error: energy lost (positive) or gained (negative).
    pub remainder_j: f64,
    /// Largest rise of mechanical energy over one contact episode (J), ≥ 0; 0 in exact arithmetic.
    pub rise_j: f64,
}

impl Ledger {
    /// The same balance with no negative loss. Friction that reverses within a step may seem to do
    /// work, and springs may seem to return more than they took. Such a gain is numerical and is
    /// moved to the remainder.
    fn without_gains(mut self) -> Self {
        let Self { friction_j, damping_j, rolling_j, trees_j, remainder_j, .. } = &mut self;
        for loss_j in [friction_j, damping_j, rolling_j, trees_j] {
            *remainder_j += loss_j.min(0.0);
            *loss_j = loss_j.max(0.0);
        }
        self
    }
}

/// One recorded point of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Motion (local coordinates).
    pub motion: Motion,
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there
    /// is none.
    pub clearance_m: f64,
    /// Flight, sliding or sticking.
    pub state: PathState,
    /// Attitude of a block: the rotation from its principal frame to the world, as a unit
    /// quaternion w, x, y, z; none for a sphere.
    pub attitude: Option<[f64; 4]>,
}

/// Contact state of a rock on its path.
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
    /// State of a rock in contact.
    pub(crate) fn in_contact(slides: bool) -> Self {
        if slides { Self::Sliding } else { Self::Sticking }
    }
}

/// One impact: a contact that begins with a normal approach speed above the capture speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Time at which the contact begins (s).
    pub time_s: f64,
    /// Contact point (m, local coordinates).
    pub point_m: Vec3,
    /// Feature of the mesh that was hit.
    pub feature: FeatureKind,
    /// Index into `Terrain::sheets`.
    pub sheet: u16,
    /// Speed of the centre before (m/s).
    pub speed_in_m_s: f64,
    /// Speed of the centre when the contact opens, or when the longest duration of an impact is
    /// over (m/s).
    pub speed_out_m_s: f64,
    /// Energy lost in contacts with the mesh (J), ≥ 0. Impacts at the same time share it in
    /// proportion to the squares of their approach speeds.
    pub energy_lost_j: f64,
    /// Part of it that the drag of soil took (J).
    pub soil_j: f64,
}

/// Largest values along a trajectory.
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

/// Shape of one rock, as drawn from the distribution of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RockShape {
    /// Kind of shape.
    pub kind: ShapeKind,
    /// Second and third side over the first (–).
    pub sides: [f64; 2],
    /// Attitude at release: the rotation from its principal frame to the world, as a unit
    /// quaternion w, x, y, z.
    pub attitude: [f64; 4],
}

impl RockShape {
    /// Shape of a sphere in a scene that also has blocks.
    pub const SPHERE: Self =
        Self { kind: ShapeKind::Sphere, sides: [1.0; 2], attitude: [1.0, 0.0, 0.0, 0.0] };

    /// Shape of a block as drawn.
    pub fn new(drawn: &DrawnShape) -> Self {
        let attitude = rock_geometry::quaternion(&drawn.attitude);
        Self { kind: drawn.kind, sides: drawn.sides, attitude }
    }
}

/// The complete trajectory of one rock.
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
    /// Cells of the plan's maps that the rock passed, in the order of cell numbers.
    pub passages: Vec<CellPassage>,
    /// Stretches of distance from the release that the rock passed, in the order of their numbers.
    pub stretches: Vec<Stretch>,
    /// Energy balance.
    pub ledger: Ledger,
    /// Potential energy released plus kinetic energy at the start (J): the scale of the energy
    /// balance of a rock alone.
    pub released_j: f64,
    /// Cost.
    pub effort: Effort,
}

impl Trajectory {
    /// Result of a release that could not be made: a row like any other, with nothing but the rock
    /// and its place.
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
        let displacement_m = self.end.position_m - self.start.position_m;
        math::hypot(displacement_m.x, displacement_m.y)
    }

    /// Height lost from release to end (m), positive downwards.
    pub fn drop_m(&self) -> f64 {
        self.start.position_m.z - self.end.position_m.z
    }

    /// Reach angle (Fahrböschung) `atan(drop/runout)` (degrees).
    pub fn reach_angle_deg(&self) -> f64 {
        math::atan2(self.drop_m(), self.runout_m()).to_degrees()
    }

    /// `|numerical remainder| / energy released` (–). For a rock that received most of its energy
    /// from other rocks, the divisor is the energy that was available to it.
    pub fn energy_balance_error(&self) -> f64 {
        let remainder_j = self.ledger.remainder_j.abs();
        match self.available_j() {
            available_j if available_j > 0.0 => remainder_j / available_j,
            // rounding errors of a rock that neither fell nor was hit are no error of its energy
            _ if remainder_j == 0.0 || self.is_isolated() => 0.0,
            _ => 1.0,
        }
    }

    /// Energy that was available to the rock (J). This is the energy released if other rocks gave
    /// less than that. Otherwise it is the sum of the energy released and received, or the largest
    /// kinetic energy where that is larger: a rock that is hit and hits another passes on all that
    /// it received.
    fn available_j(&self) -> f64 {
        let received_j = (-self.ledger.passed_on_j).max(0.0);
        let largest_j = (self.released_j.max(0.0) + received_j).max(self.extremes.total_j);
        let is_own = self.is_isolated() || 2.0 * self.released_j >= largest_j;
        if is_own { self.released_j } else { largest_j }
    }

    /// Whether it exchanged no energy with other rocks.
    fn is_isolated(&self) -> bool {
        self.ledger.passed_on_j == 0.0 && self.ledger.others_j == 0.0
    }
}
