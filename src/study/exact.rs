//! Error against run time on the exact cases: every scheme over a ladder of steps or tolerances.

use super::cases::{CASES, Case};
use super::processor_time::ProcessorTime;
use crate::math;
use crate::simulation::{Effort, Scratch, Trajectory};
use crate::solver::Scheme;
use crate::terrain::Terrain;
use std::fmt::Write as _;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// A run is timed this often at least …
const RUNS: usize = 5;
/// … and until this time is spent, but not more often than [`MOST_RUNS`].
const TIMED: Duration = Duration::from_millis(20);
const MOST_RUNS: usize = 51;
/// Shortest fixed step of a block (s): one costs ten times that of a sphere.
const LEAST_OF_BLOCKS_S: f64 = 1e-5;
/// A run this long is likely to wait for others on a busy machine: only its own time counts.
const INTERRUPTED: Duration = Duration::from_millis(8);
/// Errors below this are rounding, or the last digits of the exact value: no order shows there (–).
const ROUNDING: f64 = 1e-8;
/// Errors above this are no longer small: no order shows there either (–).
const LARGE: f64 = 0.1;

/// A scheme, its ladder from coarse to fine (m/s or s), and its order in theory.
#[derive(Debug, Clone, Copy)]
pub struct Rungs {
    /// The scheme.
    pub scheme: Scheme,
    /// Tolerances (m/s) or steps (s), falling.
    pub fineness: &'static [f64],
    /// Order of convergence in theory, against steps taken.
    pub order: f64,
}

/// The paper's own scheme, with which others are compared.
pub const PAPER: Scheme = Scheme::Dda;
/// The scheme of a scene that names none.
pub const USUAL: Scheme = Scheme::Adaptive;

/// Every scheme. To add one: a row.
pub const LADDERS: [Rungs; 4] = [
    Rungs { scheme: PAPER, fineness: &[1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6], order: 1.0 },
    Rungs {
        scheme: USUAL,
        fineness: &[1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6],
        order: 2.0,
    },
    Rungs {
        scheme: Scheme::Reference,
        fineness: &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8],
        order: 4.0,
    },
    Rungs {
        scheme: Scheme::Rigid,
        fineness: &[2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4],
        order: 1.0,
    },
];

/// One case with one scheme at one step or tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LadderPoint {
    /// Tolerance (m/s) or step (s).
    pub fineness: f64,
    /// Largest error of the case's measures (–); infinite where the run failed.
    pub error: f64,
    /// What it cost, counted.
    pub effort: Effort,
    /// Median run time (s).
    pub seconds: f64,
}

/// One case with one scheme.
#[derive(Debug, Clone)]
pub struct Curve {
    /// The scheme with its ladder.
    pub rungs: Rungs,
    /// From coarse to fine.
    pub points: Vec<LadderPoint>,
}

/// One case with every scheme.
#[derive(Debug, Clone)]
pub struct CaseStudy {
    /// The case.
    pub case: Case,
    /// One curve for each scheme that is held to the case, in the order of [`LADDERS`].
    pub curves: Vec<Curve>,
}

/// How much cheaper one scheme is than another at equal error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saving {
    /// The error both reach (–).
    pub error: f64,
    /// Run time of the other over that of the one (–).
    pub time: f64,
    /// Passes over the contacts of the other over those of the one (–).
    pub sweeps: f64,
}

/// Runs every case with every scheme; `done` hears of each.
pub fn study(done: impl Fn(&str)) -> Vec<CaseStudy> {
    let study_case = |case: &Case| {
        let terrain = case.terrain();
        let own = LADDERS.into_iter().filter(|rungs| case.is_for(rungs.scheme));
        let curves = own.map(|rungs| curve(case, &terrain, rungs)).collect();
        done(case.name);
        CaseStudy { case: *case, curves }
    };
    CASES.iter().map(study_case).collect()
}

fn curve(case: &Case, terrain: &Terrain, rungs: Rungs) -> Curve {
    let measures = case.measures(terrain, rungs.scheme);
    // one work space for all runs, as in an ensemble
    let mut scratch = Scratch::default();
    let point = |&fineness: &f64| {
        let step = case.settings(rungs.scheme, fineness);
        let (journey, seconds) = timed(|| case.follow(terrain, &step, &mut scratch));
        let error = case.error(&measures, &journey);
        LadderPoint { fineness, error, effort: journey.effort, seconds }
    };
    let has_block = (case.setup)(rungs.scheme.has_springs()).block.is_some();
    let least = if has_block && rungs.scheme.has_fixed_step() { LEAST_OF_BLOCKS_S } else { 0.0 };
    let own = rungs.fineness.iter().filter(|fineness| **fineness >= least);
    Curve { rungs, points: own.map(point).collect() }
}

/// The journey and the median time of repeated runs (s).
fn timed(mut run: impl FnMut() -> Trajectory) -> (Trajectory, f64) {
    let mut times = Vec::new();
    let begun = Instant::now();
    let journey = loop {
        let (start, own) = (Instant::now(), ProcessorTime::begin());
        let journey = black_box(run());
        let passed = start.elapsed();
        // The system counts a thread's own time in ticks of some milliseconds; a short run is seldom interrupted.
        times.push(if passed < INTERRUPTED { passed.as_secs_f64() } else { own.seconds() });
        let enough = begun.elapsed() > TIMED || times.len() >= MOST_RUNS;
        if times.len() >= RUNS && enough {
            break journey;
        }
    };
    times.sort_by(f64::total_cmp);
    (journey, times[times.len() / 2])
}

/// Least ratio of the most to the fewest steps over which an order is told (–).
const SPAN: f64 = 8.0;
/// Least share of the scatter of log errors that steps explain (–).
const FOLLOWS: f64 = 0.8;

impl Curve {
    /// Order of convergence: the slope of log error over log contact steps, least squares over the rungs where an order
    /// can show; `None` where fewer than three do, where steps hardly differ, or where errors do not follow them.
    pub fn order(&self) -> Option<f64> {
        let shows = |point: &&LadderPoint| (ROUNDING..LARGE).contains(&point.error);
        let logs: Vec<(f64, f64)> = self
            .points
            .iter()
            .filter(shows)
            .map(|point| (math::ln(point.effort.steps as f64), math::ln(point.error)))
            .collect();
        if logs.len() < 3 {
            return None;
        }
        let n = logs.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(|log| log.0), mean(|log| log.1));
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for log in &logs {
            xx += (log.0 - x).powi(2);
            xy += (log.0 - x) * (log.1 - y);
            yy += (log.1 - y).powi(2);
        }
        let ends = logs.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), log| {
            (least.min(log.0), most.max(log.0))
        });
        // over few steps more errors jump to rounding; those that do not fall have another cause than the steps
        let is_seen = ends.1 - ends.0 >= math::ln(SPAN) && xy < 0.0 && xy * xy >= FOLLOWS * xx * yy;
        is_seen.then_some(-xy / xx)
    }

    /// Whether the finest rungs are at rounding, so that no order shows above it.
    pub fn ends_at_rounding(&self) -> bool {
        self.points.iter().any(|point| point.error < ROUNDING)
    }

    /// Whether every rung is exact to rounding.
    pub fn is_exact(&self) -> bool {
        self.points.iter().all(|point| point.error < ROUNDING)
    }

    /// The cheapest point at most as far off as `error` (–).
    fn cheapest(&self, error: f64) -> Option<&LadderPoint> {
        let good = self.points.iter().filter(|point| point.error <= error.max(ROUNDING));
        good.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}

impl CaseStudy {
    /// Whether any scheme has an error above rounding: else there is nothing to draw.
    pub fn says_something(&self) -> bool {
        !self.curves.iter().all(Curve::is_exact)
    }

    /// The curve of a scheme.
    pub fn curve(&self, scheme: Scheme) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.rungs.scheme == scheme)
    }

    /// What the default scheme saves against the paper's at each error that the paper's reaches on its ladder: the
    /// cheapest run of either that is at least as good. None where one of them does not converge.
    pub fn savings(&self) -> Vec<Saving> {
        let (Some(paper), Some(ours)) = (self.curve(PAPER), self.curve(USUAL)) else {
            return Vec::new();
        };
        let saving = |point: &LadderPoint| {
            let (theirs, our) = (paper.cheapest(point.error)?, ours.cheapest(point.error)?);
            Some(Saving {
                error: point.error.max(ROUNDING),
                time: theirs.seconds / our.seconds,
                sweeps: theirs.effort.sweeps as f64 / our.effort.sweeps.max(1) as f64,
            })
        };
        let small = paper.points.iter().filter(|point| point.error < LARGE);
        let mut savings: Vec<Saving> = small.filter_map(saving).collect();
        // a finer step may do no better: only what is better than all before it
        let mut best = f64::INFINITY;
        savings.retain(|saving| {
            let is_better = saving.error < best;
            best = best.min(saving.error);
            is_better
        });
        savings
    }
}

/// Unit and name of what refines a scheme.
pub fn fineness_column(scheme: Scheme) -> &'static str {
    if scheme.controls_error() { "tolerance_m_s" } else { "step_s" }
}

/// All points as CSV.
pub fn csv(studies: &[CaseStudy]) -> String {
    let mut text = String::from(
        "case,scheme,refined_by,fineness,error,seconds,steps,rejected,leaps,sweeps,triangles,unsettled\n",
    );
    for study in studies {
        for curve in &study.curves {
            for LadderPoint { fineness, error, seconds, effort } in &curve.points {
                let scheme = curve.rungs.scheme;
                let Effort { steps, rejected, leaps, sweeps, triangles, unsettled } = effort;
                let _ = writeln!(
                    text,
                    "{},{},{},{fineness:e},{error:.3e},{seconds:.3e},{steps},{rejected},{leaps},{sweeps},{triangles},{unsettled}",
                    study.case.name,
                    scheme.name(),
                    fineness_column(scheme)
                );
            }
        }
    }
    text
}
