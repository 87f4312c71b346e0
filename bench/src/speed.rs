//! How fast: rocks per second of every scheme over the size of the mesh, where the time goes, and what each part costs.
//!
//! Time is that which a thread computes, as the system counts it: what other programs take of the machine stays out,
//! except for what they do to its caches.

pub mod compare;
mod figure;
pub mod machine;
pub mod output;
mod page;
pub mod parts;
pub mod program;
pub mod rate;
pub mod slope;
pub mod threads;

use compare::{Compared, compare};
use figure::draw;
use machine::Machine;
use output::OutputCost;
use page::{csv, page, parts_csv};
use parts::PartCost;
use program::ProgramRun;
use rate::{Rate, measure, step_of};
use rockfall::error::{Error, Result};
use rockfall::output::write_atomic;
use rockfall::solver::Scheme;
use slope::{SCHEMES, Slope};
use std::fs;
use std::path::{Path, PathBuf};
use threads::{Speedup, speedup};

/// How much is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedOptions {
    /// Rocks of the fast schemes; `reference` gets a tenth, `dda` one of 200.
    pub rocks: usize,
    /// Sizes of the slope (triangles), about.
    pub triangles: Vec<usize>,
    /// Releases whose files and report are measured.
    pub written: usize,
    /// The program, for what it takes as a whole.
    pub program: PathBuf,
    /// Folder of the source code, if the program was compiled from there.
    pub source: Option<PathBuf>,
}

/// Made slope and what it took to make it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeCost {
    /// Triangles.
    pub triangles: usize,
    /// Time to weld (s).
    pub weld_s: f64,
    /// Time to index and to find what can be touched (s).
    pub index_s: f64,
    /// Memory that rocks use of it (bytes).
    pub bytes: usize,
}

/// All that was measured.
#[derive(Debug, Clone)]
pub struct SpeedStudy {
    /// On what, with what.
    pub machine: Machine,
    /// The slopes.
    pub slopes: Vec<SlopeCost>,
    /// Every scheme on every slope.
    pub rates: Vec<Rate>,
    /// More threads, on the slope of middle size.
    pub speedups: Vec<(Scheme, Speedup)>,
    /// Files and report.
    pub output: OutputCost,
    /// The same releases under several schemes.
    pub compared: Vec<Compared>,
    /// Each part of a scene.
    pub parts: Vec<PartCost>,
    /// The whole program.
    pub runs: Vec<ProgramRun>,
}

/// Releases whose files and report are measured, usually.
pub const WRITTEN: usize = 100_000;

impl SpeedOptions {
    /// Rocks of one scheme.
    fn rocks_of(&self, scheme: Scheme) -> usize {
        match scheme {
            Scheme::Adaptive | Scheme::Rigid => self.rocks,
            Scheme::Reference => (self.rocks / 10).max(2),
            Scheme::Dda => (self.rocks / 200).max(2),
        }
    }

    /// Size on which threads, parts and statistics are looked at (triangles).
    fn middle(&self) -> usize {
        self.triangles[self.triangles.len() / 2]
    }
}

/// Measures everything; `done` hears of each piece. `dir` is a folder to work in, which is removed at the end.
///
/// # Errors
/// If `dir` cannot be written, or the program not be started.
///
/// # Panics
/// If no size is asked for.
pub fn study(order: &SpeedOptions, dir: &Path, mut done: impl FnMut(String)) -> Result<SpeedStudy> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    let mut study = SpeedStudy {
        machine: Machine::here(order.source.as_deref()),
        slopes: Vec::new(),
        rates: Vec::new(),
        speedups: Vec::new(),
        output: OutputCost { rocks: 0, write_s: 0.0, report_s: 0.0 },
        compared: Vec::new(),
        parts: Vec::new(),
        runs: Vec::new(),
    };
    for &triangles in &order.triangles {
        study.slope(order, triangles, dir, &mut done)?;
    }
    study.parts = parts::costs(order.middle(), (order.rocks / 2).max(2), dir, &mut done)?;
    study.runs = program::runs(&order.program, dir, &order.triangles, order.rocks)?;
    fs::remove_dir_all(dir).map_err(Error::file("remove", dir))?;
    Ok(study)
}

/// Writes the page, tables and figure of the speeds into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write(study: &SpeedStudy, dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_atomic(&dir.join("speed.svg"), draw(study).as_bytes())?;
    write_atomic(&dir.join("speed.csv"), csv(study).as_bytes())?;
    write_atomic(&dir.join("parts.csv"), parts_csv(study).as_bytes())?;
    write_atomic(&dir.join("README.md"), page(study).as_bytes())
}

impl SpeedStudy {
    /// Everything that is measured on one slope.
    fn slope(
        &mut self,
        order: &SpeedOptions,
        triangles: usize,
        dir: &Path,
        done: &mut impl FnMut(String),
    ) -> Result<()> {
        let slope = Slope::of(triangles);
        let (Slope { weld_s, index_s, .. }, bytes) = (&slope, slope.terrain.bytes());
        let (weld_s, index_s) = (*weld_s, *index_s);
        let count = slope.terrain.triangles.len();
        self.slopes.push(SlopeCost { triangles: count, weld_s, index_s, bytes });
        let mut journeys = Vec::new();
        for way in SCHEMES {
            let (rate, fallen) = measure(&slope, way, order.rocks_of(way.0));
            journeys.push((way.0, fallen));
            self.rates.push(rate);
        }
        let cost = output::cost(&slope, &journeys[0].1, order.written, &dir.join("rows"))?;
        let write_s = cost.write_s / cost.rocks as f64;
        let first = self.rates.len() - SCHEMES.len();
        for rate in &mut self.rates[first..] {
            *rate = rate.clone().with_output(write_s);
            let name = rate.scheme.name();
            done(format!("{name}, {count} triangles: {:.1} rocks/s", rate.per_second()));
        }
        if triangles == order.middle() {
            self.output = cost;
            journeys.retain(|(scheme, _)| *scheme != Scheme::Dda);
            self.compared = compare(&slope, &journeys);
            for way in &SCHEMES[..2] {
                let found = speedup(&slope, &step_of(*way), order.rocks, 2)?;
                self.speedups.push((way.0, found));
            }
        }
        Ok(())
    }
}
