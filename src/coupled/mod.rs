//! The step for rocks that touch each other: islands, force sweeps, block systems.
//!
//! Rocks that may touch within a short while form an island; islands know nothing of each other. An island takes the
//! step of a single rock for all of its rocks at once; only the contact forces are sought together.

mod accept;
mod bridge;
mod factor;
mod fixed;
mod global;
pub mod broad;
mod cluster;
pub mod islands;
mod jump;
mod link;
mod member;
mod ordering;
mod rigid;
mod stage;
mod sweeps;

pub use cluster::{Cluster, Done, Given};
pub use member::{Member, Memory, Seat};
pub use rigid::{Hit, TRAVEL};
