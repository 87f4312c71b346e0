//! The step for rocks that touch each other: islands, force sweeps, block systems.
//!
//! Rocks that may touch within a short time form an island; islands are independent of each other.
//! The step of an island is that of a single rock, taken for all of its rocks at once; only the
//! contact forces are solved together.
//! ```text
//! adaptive, reference   stage, sweeps, newton_step     forces by nonlinear Gauss–Seidel, accelerated by Newton steps
//! dda                   dda_step, and dda beside       the paper's global system, Eq. (4), and open–close iteration
//! rigid                 rigid/                         impulses at velocity level, impacts in the order of their times
//! ```
//!
//! Lists of rocks and pairs are in the order of their numbers, sums are taken in that order, and
//! one thread works on an island: the results of a world, to the byte, do not depend on how many
//! threads share its islands.

mod accept;
mod pair_contact;
mod contact_queue;
mod dda_step;
pub mod broad_phase;
mod assembly;
mod newton_step;
mod body;
mod impact_tolerance;
mod outcome;
mod release;
mod active_set;
mod rigid;
mod stage;
mod trial;
mod unload;
mod sweeps;

pub use assembly::Island;
pub use body::{BodySlot, IslandBody, MotionSnapshot};
pub use outcome::{BlowInStep, IslandAdvance, MeshImpact};
pub use rigid::TRAVEL;
pub(crate) use rigid::{RigidIsland, blows_of};
pub use unload::unload_pair;
