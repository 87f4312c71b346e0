//! The developers' bench: rocks per second, where the time goes, and how the cost grows with the rocks of one world.
#![allow(clippy::disallowed_methods, reason = "what is measured here reaches no result")]

pub mod block;
pub mod rocks;
pub mod scaling;
pub mod scaling_page;
pub mod speed;
pub mod tile;
