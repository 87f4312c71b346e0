//! What a step of an island did.

use crate::rock::Motion;
use crate::solver::impact_point::ImpactPoint;
use crate::solver::loss::{EnergyGiven, Loss};

/// What one step did.
#[derive(Debug, Clone, Default)]
pub struct IslandAdvance {
    /// Time gone (s).
    pub dt: f64,
    /// Energy lost to the ground, for each rock (J).
    pub losses: Vec<Loss>,
    /// Energy given to other rocks, for each rock (J).
    pub given: Vec<EnergyGiven>,
    /// Steps tried and thrown away.
    pub rejected: u64,
    /// Impacts on the mesh, rock by rock and blow by blow (`rigid`; with the others the memory of a contact tells).
    pub hits: Vec<MeshImpact>,
    /// Blows within the step, rock by rock (`rigid`; with the others blows take time, and steps).
    pub blows: Vec<BlowInStep>,
    /// Whether contact states did not settle (`dda`, `rigid`).
    pub unsettled: bool,
    /// Bonds that broke.
    pub broken: u64,
}

/// An impact on the mesh.
#[derive(Debug, Clone, Copy)]
pub struct MeshImpact {
    /// The rock, as a place in the island.
    pub rock: usize,
    /// What it strikes.
    pub struck: ImpactPoint,
}

/// A blow on a rock within a step.
#[derive(Debug, Clone, Copy)]
pub struct BlowInStep {
    /// The rock, as a place in the island.
    pub rock: usize,
    /// Its motion before and after it; times count from the end of the step (s, 0 or less).
    pub motions: [Motion; 2],
    /// How many of the impacts on the mesh are its own.
    pub hits: usize,
}
