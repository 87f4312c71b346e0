//! The two errors of a scene's statistics, apart: that of the sample and that of the steps.
//!
//! Paths of rocks are chaotic: from the same release they end metres apart at any two tolerances, so single paths do not
//! converge. Their statistics do. All settings get the same releases, so most of what chance does drops out of the
//! difference; what is left is drawn again and again to say how far it can be trusted.

use super::bootstrap::{Interval, Paired, PercentileLadder};
use super::finer::finer;
use super::processor_time::Busy;
use super::weighing::{FEWEST, Weigh};
use crate::ensemble::Ensemble;
use crate::error::Result;
use crate::hazard::{Percentile, Row, StopKind};
use crate::math;
use crate::plan::{Part, Plan};
use crate::report::studied::Studied;
use crate::scene::Language;
use crate::simulation::{self, Effort, Scratch, Trajectory};
use crate::solver::{Scheme, Settings};
use crate::terrain::Terrain;
use crate::terrain::coarser::{coarser, slope_edge_m};
use std::ops::Range;
use std::time::Instant;

pub use super::statistic::{Of, QUANTITIES, StudyQuantity};

/// Percentiles of the study (per cent).
pub const PERCENTS: [u8; 3] = [50, 95, 99];
/// Turns that every setting takes.
const BLOCKS: usize = 20;
/// How much longer the edges of the coarser meshes are than the scene's own (–).
const COARSER: [f64; 2] = [4.0, 2.0];
/// Order of the mesh's error against the length of its edges (–): what a triangle leaves out of a rough surface goes with its
/// length …
const MESH_ORDER: f64 = 1.0;
/// … and out of a smooth one with the square, which leaves so much of what the line through edges twice as long says (–).
const SMOOTH_MESH: f64 = 1.0 / 3.0;

/// All releases under one setting.
#[derive(Debug, Clone)]
pub struct Rung {
    /// The setting.
    pub step: Settings,
    /// Its tolerance or step over the scene's own (–).
    pub relative: f64,
    /// Run time of all releases (s): processor time over the number of threads, so that what others take of the machine
    /// stays out; clock time where the system does not tell.
    pub seconds: f64,
    /// What they cost, counted.
    pub effort: Effort,
    /// Rocks that failed.
    pub failed: usize,
    /// Largest rise of mechanical energy of a rock over one contact (J).
    pub rise_j: f64,
    /// Values of each subject, release by release; NaN for a failed rock, −∞ for one that has none.
    values: Vec<Vec<f64>>,
    /// Whether each rock would have gone on: it left the terrain, ran out of time or failed.
    ended: Vec<StopKind>,
}

/// One percentile of one quantity.
#[derive(Debug, Clone)]
pub struct StudyStatistic {
    /// Which of [`SceneStudy::subjects`].
    pub subject: usize,
    /// Per cent.
    pub percent: u8,
    /// Under the scene's own setting.
    pub own: Percentile,
    /// Rocks that would have gone on, of which it sees only a bound.
    pub open: usize,
    /// Half the 95 % interval of the first so many releases, for rising numbers up to all.
    pub sampling: Vec<(usize, f64)>,
    /// Over the ladder.
    pub ladder: PercentileLadder,
    /// Over the meshes, from coarse to the scene's own; `None` where they were not asked for.
    pub meshes: Option<PercentileLadder>,
}

/// All releases under the scene's own setting on a coarser mesh.
#[derive(Debug, Clone)]
pub struct MeshRung {
    /// Length of its edges over the scene's own (–).
    pub times: f64,
    /// Mean length of its edges (m).
    pub edge_m: f64,
    /// Its triangles.
    pub triangles: usize,
    /// What the releases did on it.
    pub rung: Rung,
}

/// What the study of one scene found.
#[derive(Debug, Clone)]
pub struct SceneStudy {
    /// Title of the scene.
    pub title: String,
    /// Of which scene, as its results name it.
    pub studied: Studied,
    /// In which language the figure speaks.
    pub language: Language,
    /// Releases under every setting.
    pub releases: usize,
    /// Worker threads.
    pub threads: usize,
    /// From coarse to fine.
    pub rungs: Vec<Rung>,
    /// Which of them is the scene's own.
    pub own: usize,
    /// Whether coarser meshes were asked for.
    pub with_meshes: bool,
    /// On coarser meshes and the scene's own, from coarse to fine; empty where they were not asked for, or there are none.
    pub meshes: Vec<MeshRung>,
    /// What was looked at.
    pub subjects: Vec<StudyQuantity>,
    /// Each of [`PERCENTS`] for each subject.
    pub statistics: Vec<StudyStatistic>,
    /// So many releases of equal weight would know as much (–); none where all weigh the same.
    pub effective_releases: Option<f64>,
}

/// A setting that gives a statistic with a wanted error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer {
    /// Which rung.
    pub rung: usize,
    /// How many releases.
    pub releases: usize,
    /// Run time (s).
    pub seconds: f64,
}

/// How fine the settings are over the scene's own, and the order of their error against that.
///
/// Local error and step are tied by `tolerance ~ step^(p+1)` (p: order of the embedded method); the error of the result
/// goes with `step^p'`: 2/3 for TR-BDF2, 1 for the fourth-order tableau, 1 for fixed steps.
fn ladder_of(scheme: Scheme) -> (&'static [f64], f64) {
    scheme.of([
        // each halving costs double
        (&[2.0, 1.0, 0.5][..], 1.0),
        // nothing coarser than the scene's own: what impacts may be wrong by is bounded, and no coarser tolerance would change it
        (&[1.0, 0.25, 0.0625, 0.015_625], 2.0 / 3.0),
        // far above the scene's own tolerance the error no longer follows its law, below it a rung costs little more;
        // this one is already at the fine end
        (&[4096.0, 256.0, 16.0, 1.0], 1.0),
        (&[2.0, 1.0, 0.5, 0.25, 0.125], 1.0),
    ])
}

/// Runs all releases of a plan under every setting, and on coarser meshes if asked; `done` hears of each, with how much
/// longer the edges of its mesh are.
///
/// # Errors
/// A release that cannot be made.
pub fn study(
    mut plan: Plan,
    ensemble: &Ensemble,
    with_meshes: bool,
    done: impl Fn(&Rung, f64),
) -> Result<SceneStudy> {
    plan.paths = Part::LeftOut("a study keeps no paths");
    plan.impacts = Part::LeftOut("a study keeps no impacts");
    plan.profile = Part::LeftOut("a study draws no profile");
    let own_step = plan.step;
    let has_blocks = !plan.releases.shapes().is_empty();
    let (relatives, order) = ladder_of(own_step.scheme);
    let mut rungs: Vec<Rung> =
        relatives.iter().map(|&relative| Rung::new(&own_step, relative, has_blocks)).collect();
    // All settings take turns, so that a machine that is busy for a while slows all of them alike.
    let subjects = StudyQuantity::all(&plan);
    for block in blocks(plan.count) {
        for rung in &mut rungs {
            plan.step = rung.step;
            rung.run(&plan, &subjects, block.clone(), ensemble)?;
        }
    }
    for rung in &rungs {
        done(rung, 1.0);
    }
    let own = relatives.iter().position(|relative| (relative - 1.0).abs() < 1e-9).unwrap_or(0);
    plan.step = own_step;
    let meshes = if with_meshes {
        meshes(&mut plan, &subjects, ensemble, (&rungs[own], &done))?
    } else {
        Vec::new()
    };
    let weighing = Weigh::of(&plan);
    let rocks = weighing.rocks(plan.count);
    let mut statistics = Vec::new();
    for (subject, quantity) in subjects.iter().enumerate() {
        let all: Vec<Vec<f64>> = rungs.iter().map(|rung| rung.values[subject].clone()).collect();
        let paired = Paired::weighing(&all, &rocks);
        let on_mesh: Vec<_> = meshes.iter().map(|mesh| mesh.rung.values[subject].clone()).collect();
        let times: Vec<f64> = meshes.iter().map(|mesh| mesh.times).collect();
        // The coarsest mesh may be too coarse to follow any law: the error is told by the two finest.
        let finest = meshes.len().saturating_sub(2);
        let on = |meshes: &[Vec<f64>]| Paired::weighing(meshes, &rocks);
        let (on_meshes, on_finest) = (on(&on_mesh), on(&on_mesh[finest..]));
        let open = quantity.bounds_of(&rungs[own].ended);
        let open = open.as_ref().map(|(is_bound, side)| (&is_bound[..], *side));
        for percent in PERCENTS {
            let p = f64::from(percent) / 100.0;
            let Some(found) = weighing.percentile(&all[own], open, p) else { continue };
            let ladder = paired.ladder(p, relatives, order, plan.seed);
            let sampling = weighing.sampling(&all[own], open, p);
            let meshes = (!meshes.is_empty()).then(|| {
                let rough = on_finest.ladder(p, &times[finest..], MESH_ORDER, plan.seed).own_error;
                let own_error = rough.holding(&rough.times(SMOOTH_MESH));
                let on_all = on_meshes.ladder(p, &times, MESH_ORDER, plan.seed);
                PercentileLadder { own_error, ..on_all }
            });
            statistics.push(StudyStatistic {
                subject,
                percent,
                own: found,
                open: open.map_or(0, |(bounds, _)| bounds.iter().filter(|is| **is).count()),
                sampling,
                ladder,
                meshes,
            });
        }
    }
    Ok(SceneStudy {
        title: plan.title.clone(),
        studied: Studied {
            scene_hash: plan.scene_hash.clone(),
            seed: plan.seed,
            releases: plan.count,
        },
        language: plan.language,
        releases: plan.count,
        threads: ensemble.threads(),
        rungs,
        own,
        with_meshes,
        meshes,
        subjects,
        statistics,
        effective_releases: weighing.effective(plan.count),
    })
}

/// All releases on the slope with longer edges; last its own mesh, where they have been already. Nothing where a slope of few triangles cannot be made
/// coarser.
fn meshes(
    plan: &mut Plan,
    subjects: &[StudyQuantity],
    ensemble: &Ensemble,
    (own, done): (&Rung, impl Fn(&Rung, f64)),
) -> Result<Vec<MeshRung>> {
    let mut meshes = Vec::new();
    for times in COARSER {
        let coarse = coarser(&plan.terrain, times);
        let is_slope = |t: u32| !coarse.is_tree(t);
        if !(0..coarse.triangles.len() as u32).any(is_slope) {
            return Ok(Vec::new());
        }
        let fine = std::mem::replace(&mut plan.terrain, coarse);
        let mut rung = Rung::new(&plan.step, 1.0, false);
        rung.run(plan, subjects, 0..plan.count, ensemble)?;
        done(&rung, times);
        meshes.push(MeshRung::of(&plan.terrain, times, rung));
        plan.terrain = fine;
    }
    meshes.push(MeshRung::of(&plan.terrain, 1.0, own.clone()));
    Ok(meshes)
}

impl MeshRung {
    fn of(terrain: &Terrain, times: f64, rung: Rung) -> Self {
        Self { times, edge_m: slope_edge_m(terrain), triangles: terrain.triangles.len(), rung }
    }
}

/// The releases in a few blocks.
fn blocks(count: usize) -> impl Iterator<Item = Range<usize>> {
    let length = count.div_ceil(BLOCKS);
    (0..count).step_by(length).map(move |start| start..count.min(start + length))
}

impl Rung {
    fn new(own: &Settings, relative: f64, has_blocks: bool) -> Self {
        Self {
            step: finer(own, relative, has_blocks),
            relative,
            seconds: 0.0,
            effort: Effort::default(),
            failed: 0,
            rise_j: 0.0,
            values: Vec::new(),
            ended: Vec::new(),
        }
    }

    /// Computes some more releases.
    fn run(
        &mut self,
        plan: &Plan,
        subjects: &[StudyQuantity],
        releases: Range<usize>,
        ensemble: &Ensemble,
    ) -> Result<()> {
        self.values.resize(subjects.len(), Vec::new());
        let fall = |index: usize, scratch: &mut Scratch| {
            simulation::simulate_release(plan, index, None, scratch)
        };
        let (begun, before) = (Instant::now(), Busy::of_all_threads());
        for falls in ensemble.in_chunks(releases, Scratch::default, fall) {
            falls?
                .iter()
                .for_each(|fall| self.add(subjects, &Row::of(fall, plan.terrain.origin_m), fall));
        }
        let computed = before.zip(Busy::of_all_threads()).map(|(a, b)| b.computed_s - a.computed_s);
        self.seconds += computed.map_or_else(
            || begun.elapsed().as_secs_f64(),
            |seconds| seconds / ensemble.threads() as f64,
        );
        Ok(())
    }

    fn add(&mut self, subjects: &[StudyQuantity], row: &Row, fall: &Trajectory) {
        let failed = matches!(row.stop, StopKind::Failed | StopKind::NotReleased);
        self.failed += usize::from(failed);
        self.rise_j = self.rise_j.max(fall.ledger.rise_j);
        self.effort.add(&fall.effort);
        self.ended.push(row.stop);
        for (values, subject) in self.values.iter_mut().zip(subjects) {
            values.push(if failed { f64::NAN } else { subject.value(row, fall) });
        }
    }
}

impl StudyStatistic {
    /// Half the 95 % interval under the scene's own setting; `None` with too few releases.
    pub fn sampling_error(&self) -> Option<f64> {
        Some(0.5 * (self.own.high_95? - self.own.low_95?))
    }

    /// Whether rocks that would have gone on leave it no interval, and not the number of rocks.
    pub(super) fn is_only_bound(&self, releases: usize) -> bool {
        self.sampling_error().is_none()
            && self.open > 0
            && (self.own.censored || releases >= self.own.needs)
    }

    /// Error of the steps under a setting so much coarser than the scene's own, signed.
    pub fn step_error(&self, relative: f64, scheme: Scheme) -> Interval {
        self.ladder.own_error.times(math::pow(relative, ladder_of(scheme).1))
    }

    /// Error of a mesh, signed; nothing where it is not known.
    pub fn mesh_error_of(&self, mesh: &MeshRung) -> Interval {
        let none = Interval { value: 0.0, low: 0.0, high: 0.0 };
        let own = self.meshes.as_ref().map_or(none, |meshes| meshes.own_error);
        own.times(math::pow(mesh.times, MESH_ORDER))
    }

    /// Error of the scene's own mesh, signed; 0 where it is not known.
    pub fn mesh_error(&self) -> f64 {
        self.meshes.as_ref().map_or(0.0, |meshes| meshes.own_error.value)
    }

    /// All errors of the scene's own setting that are known together, root of the sum of squares.
    pub fn total_error(&self) -> Option<f64> {
        Some(math::hypot(
            math::hypot(self.sampling_error()?, self.ladder.own_error.value),
            self.mesh_error(),
        ))
    }
}

impl SceneStudy {
    /// Error of the steps under the finest setting tried, signed.
    pub(super) fn finest_steps(&self, statistic: &StudyStatistic) -> Interval {
        let errors =
            self.rungs.iter().map(|rung| statistic.step_error(rung.relative, rung.step.scheme));
        errors
            .min_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))
            .unwrap_or(statistic.ladder.own_error)
    }

    /// The cheapest of the settings that gives a statistic with a total error of `wanted`, at as many releases as it
    /// needs; `None` where the errors of steps and mesh alone are larger under all of them.
    pub fn cheapest(&self, statistic: &StudyStatistic, wanted: f64) -> Option<Offer> {
        let sampling = statistic.sampling_error()?;
        let offer = |(rung, setting): (usize, &Rung)| {
            let steps = statistic.step_error(setting.relative, setting.step.scheme).value;
            let room = wanted.powi(2) - steps.powi(2) - statistic.mesh_error().powi(2);
            let times = sampling * sampling / room;
            let releases = (self.releases as f64 * times).ceil().max(FEWEST as f64);
            let seconds = setting.seconds / self.releases as f64 * releases;
            (room > 0.0).then_some(Offer { rung, releases: releases as usize, seconds })
        };
        let offers = self.rungs.iter().enumerate().filter_map(offer);
        offers.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}
