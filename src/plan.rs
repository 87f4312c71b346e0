//! What a scene needs and what it leaves out, each with its reason; compiled once, shared by all threads.

use crate::rock::{Motion, Rock};
use crate::{ground::Ground, step, terrain::Terrain};

/// Something a scene may do without.
#[derive(Debug, Clone, PartialEq)]
pub enum Part<T> {
    /// Needed, with what it takes.
    Kept(T),
    /// Not needed, and why.
    LeftOut(&'static str),
}

/// Which paths are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paths {
    /// The first so many releases.
    pub first: usize,
    /// Time between stored points (s).
    pub step_s: f64,
}

/// When a rock counts as at rest: |v| and |ω|R below the speed, for the time, in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestRule {
    /// Speed (m/s).
    pub speed_m_s: f64,
    /// Time (s).
    pub time_s: f64,
}

/// One release, drawn: a pure function of scene, seed and index.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// The rock.
    pub rock: Rock,
    /// Its motion at time 0 (local coordinates).
    pub motion: Motion,
    /// Ground values, in the order of the scene's grounds.
    pub grounds: Vec<Ground>,
}

/// The plan.
#[derive(Debug)]
pub struct Plan {
    /// The meshes.
    pub terrain: Terrain,
    /// Gravity (m/s²), positive, along −z.
    pub gravity_m_s2: f64,
    /// The step.
    pub step: step::Settings,
    /// When a rock is at rest.
    pub rest: RestRule,
    /// Simulated time after which a rock is `TimeUp` (s).
    pub longest_s: f64,
    /// Rolling friction.
    pub rolling: Part<()>,
    /// Random tilt of contact normals.
    pub roughness: Part<()>,
    /// Kept paths.
    pub paths: Part<Paths>,
    /// Kept impacts.
    pub impacts: Part<()>,
}
