//! Rockfall hazard by spherical discontinuous deformation analysis (SDDA) on triangle meshes.

pub mod error;
pub mod ground;
pub mod plan;
pub mod report;
pub mod rock;
pub mod step;
pub mod terrain;
pub mod trajectory;
