//! Result of a step of an island.

use crate::rock::Motion;
use crate::solver::impact_point::ImpactPoint;
use crate::solver::loss::{EnergyGiven, Loss};

/// Result of one step.
#[derive(Debug, Clone, Default)]
pub struct IslandAdvance {
    /// Length of the step (s).
    pub dt: f64,
    /// Energy lost to the ground, for each rock (J).
    pub losses: Vec<Loss>,
    /// Energy given to other rocks, for each rock (J).
    pub given: Vec<EnergyGiven>,
    /// Rejected steps.
    pub rejected: u64,
    /// Impacts on the mesh, rock by rock and blow by blow (`rigid`; the other schemes find them in
    /// the contact histories).
    pub hits: Vec<MeshImpact>,
    /// Blows within the step, rock by rock (`rigid`; in the other schemes blows last for several
    /// steps).
    pub blows: Vec<BlowInStep>,
    /// Whether contact states did not converge (`dda`, `rigid`).
    pub unsettled: bool,
    /// Bonds that broke.
    pub broken: u64,
}

/// An impact on the mesh.
#[derive(Debug, Clone, Copy)]
pub struct MeshImpact {
    /// The rock, as a place in the island.
    pub rock: usize,
    /// Where it strikes.
    pub struck: ImpactPoint,
}

/// A blow on a rock within a step.
#[derive(Debug, Clone, Copy)]
pub struct BlowInStep {
    /// The rock, as a place in the island.
    pub rock: usize,
    /// Its motion before and after it; times count from the end of the step (s, 0 or less).
    pub motions: [Motion; 2],
    /// Number of its own impacts on the mesh.
    pub hits: usize,
}
