//! Words, files, random streams, coordinates and the mesh that rocks fall on.
//!
//! Each module uses only modules above it in the list. SI units and `f64` throughout; z points up. The library prints nothing.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

// words
pub mod error;
pub mod count;
pub mod math;
pub mod file;
pub mod stopwatch;
pub mod parallel;
pub mod groups;
pub mod random;
pub mod rock;
pub mod frequency;
// world
pub mod gis;
pub mod terrain;
