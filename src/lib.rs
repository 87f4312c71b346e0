//! Rockfall hazard by spherical discontinuous deformation analysis (SDDA) on triangle meshes.

pub mod chance;
pub mod contact;
pub mod coupled;
pub mod ensemble;
pub mod error;
pub mod flight;
pub mod ground;
pub mod hazard;
pub mod output;
pub mod plan;
pub mod release;
pub mod report;
pub mod rock;
pub mod scene;
pub mod step;
pub mod terrain;
pub mod trajectory;
