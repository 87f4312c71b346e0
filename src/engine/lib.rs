//! What `rockfall` stands on: from the words of a scene to the way of one rock.
//!
//! Each module uses only modules above it in the list. `rockfall` re-exports what its users need; everything else may change
//! from one version to the next. SI units and `f64` throughout; z points up. The library prints nothing.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

// words and terrain
pub use rockfall_base::{
    count, error, file, frequency, gis, groups, math, parallel, random, rock, stopwatch, terrain,
};

// bodies and grounds
pub mod body;
pub mod ground;
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
