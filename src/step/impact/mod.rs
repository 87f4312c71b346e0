//! Impacts followed in their own time `τ = ω t`, `ω = √(p_N/m)`, where nothing is stiff.
#![allow(dead_code, reason = "wired in next")]

mod frozen;
mod normal;
mod pair;
mod plane;
mod rub;
mod run;
#[cfg(test)]
mod tests;

pub(crate) use frozen::{Struck, Thrown, throw};
pub(crate) use plane::{Followed, Plane, Rebound};

/// What following an impact has cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Effort {
    /// Steps taken.
    pub(crate) steps: u32,
    /// Steps thrown away.
    pub(crate) rejected: u32,
    /// Times the law was asked.
    pub(crate) evaluations: u32,
}

/// How a frozen impact ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Settled {
    /// Nothing pushes and nothing comes nearer.
    Free,
    /// It went on rattling: what was still coming nearer has been stopped without rebound.
    OutOfTime,
}
