//! Rockfall hazard by spherical discontinuous deformation analysis (SDDA) on triangle meshes.
//!
//! A **scene** says what is asked. A **plan** says what that needs, and names what it leaves out and why. Each
//! **rock** is a pure function of the plan and its number. The **hazard** is the statistics over all rocks. Files and
//! figures are drawn from it, and nothing flows back:
//!
//! ```text
//! scene.toml ─► Scene ─► Terrain ─► Plan ─► Trajectory × n ─► Hazard ─► CSV · JSON · SVG · HTML
//! ```
//!
//! ```
//! use rockfall::{Plan, Quantity, RunOptions, Scene};
//! # fn main() -> rockfall::Result<()> {
//! let scene = Scene::read("examples/quick.toml".as_ref())?;
//! let plan = Plan::of_scene(&scene)?;
//! println!("{plan}");
//! # if false {
//! let results = rockfall::run(&plan, &RunOptions::into_folder("reports/quick"))?;
//! println!("{:?}", results.statistic(Quantity::MaxTotal).percentiles["p95"]);
//! # }
//! # Ok(())
//! # }
//! ```
//!
//! Start with [`Scene::read`], [`Plan::of_scene`] and [`run()`]; what came out is in [`Results`]: all rocks together
//! ([`Hazard`]), their crossings of each line ([`Line`]), and the contents of `summary.json` ([`Summary`]). Single rocks come
//! from [`simulate_release`], rock by rock and without files.
//!
//! Only the names on this page are the public face. The hidden modules behind it are listed so that each uses only modules
//! above it in the list; their contents may change from one version to the next.
//! SI units and `f64` throughout; z points up. Nothing prints but the command, `cli`.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

#[doc(hidden)]
pub use rockfall_engine::{
    body, contact, count, error, file, flight, frequency, gis, ground, math, parallel, plan,
    random, release, rock, scene, simulation, solver, stopwatch, terrain,
};
#[doc(hidden)]
pub mod ensemble;
// answer
#[doc(hidden)]
pub mod hazard;
#[doc(hidden)]
pub mod calibrate;
#[doc(hidden)]
pub mod output;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod study;
#[doc(hidden)]
pub mod run;
// command
#[doc(hidden)]
pub mod cli;

pub use ensemble::Ensemble;
#[doc(inline)]
pub use error::{Error, Result};
pub use hazard::{
    Annual, Barrier, BarrierSummary, CrossingRow, Hazard, Layer, Line, LineInfo, LineQuantity,
    LineSummary, Mean, Percentile, Proportion, Quantity, Residual, Row, Sample, Statistic,
    StopKind,
};
pub use output::{ImpactRow, Mode, PathRow, Results, Summary};
#[doc(inline)]
pub use plan::{EvaluationLine, MapGrid, Part, Plan};
#[doc(inline)]
pub use random::Distribution;
pub use report::{answers, draw_again, headline};
#[doc(inline)]
pub use rock::{Motion, Rock, Vec3};
pub use run::{RunEnd, RunOptions, Selection, run, run_observed};
#[doc(inline)]
pub use scene::Scene;
#[doc(inline)]
pub use simulation::{
    CellPassage, Crossing, Effort, Impact, PathPoint, PathState, Scratch, Stop, Trajectory,
    simulate_release,
};
pub use study::target_precision::TargetPrecision;
#[doc(inline)]
pub use terrain::Terrain;
#[doc(inline)]
#[doc(inline)]
pub use terrain::grid::Grid;
#[doc(inline)]
#[doc(inline)]
pub use terrain::health::Health;
