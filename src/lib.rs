//! Rockfall hazard by spherical discontinuous deformation analysis (SDDA) on triangle meshes.
//!
//! A **scene** says what is asked. A **plan** says what that needs, and names what it leaves out and why. Each
//! **rock** is a pure function of the plan and its number. The **hazard** is what all rocks say together. Files and
//! figures are drawn from the hazard, and nothing flows back:
//!
//! ```text
//! scene.toml ─► Scene ─► Terrain ─► Plan ─► Trajectory × n ─► Hazard ─► CSV · JSON · SVG · HTML
//! ```
//!
//! The modules below stand in the order of the floors of a house: each uses only modules above it in the list.
//! SI units and `f64` throughout; z points up. The library prints nothing.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

// words
pub mod error;
pub mod math;
pub mod file;
pub mod clock;
pub mod chance;
pub mod rock;
pub mod body;
pub mod frequency;
// world
pub mod gis;
pub mod ground;
pub mod terrain;
// physics
pub mod contact;
pub mod flight;
pub mod solver;
// question
pub mod scene;
pub mod release;
pub mod plan;
// run
pub mod simulation;
pub mod ensemble;
// answer
pub mod hazard;
pub mod calibrate;
pub mod output;
pub mod report;
pub mod study;
