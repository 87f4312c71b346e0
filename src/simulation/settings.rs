//! What all rocks of a scene have in common.

use crate::plan::{Plan, Recorders, RestRule};
use crate::solver::Settings;
use crate::terrain::Terrain;

/// What all rocks of a scene have in common.
#[derive(Debug, Clone, Copy)]
pub struct RunSettings<'a> {
    /// The meshes.
    pub terrain: &'a Terrain,
    /// Gravity (m/s²).
    pub gravity_m_s2: f64,
    /// The step.
    pub step: &'a Settings,
    /// When a rock is at rest.
    pub rest: RestRule,
    /// Simulated time after which a rock is out of time (s).
    pub longest_s: f64,
    /// Evaluation lines and map cells.
    pub recorders: Recorders<'a>,
    /// Seed of the rocks' random streams.
    pub seed: u64,
}

impl<'a> RunSettings<'a> {
    /// What the rocks of a plan have in common.
    pub fn of(plan: &'a Plan) -> Self {
        Self {
            terrain: &plan.terrain,
            gravity_m_s2: plan.gravity_m_s2,
            step: &plan.step,
            rest: plan.rest,
            longest_s: plan.longest_s,
            recorders: plan.recorders(),
            seed: plan.seed,
        }
    }
}
