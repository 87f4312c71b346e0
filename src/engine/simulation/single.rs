//! Entry points for one rock alone: contact laws, work space of a thread, sphere or block.

use super::Trajectory;
use super::block::run_block;
use super::recorder::RecordOptions;
use super::settings::RunSettings;
use super::sphere::run_sphere;
use crate::error::Result;
use crate::ground::{Damping, Law};
use crate::plan::{PATH_STEP_S, Part, Plan};
use crate::random::{Purpose, RandomStream, stream};
use crate::release::{DrawnShape, Release};
use crate::solver::block::BlockContactState;
use crate::solver::contact_state::ContactState;
use crate::solver::scar::Scars;
use crate::solver::slip::Slip;
use crate::stopwatch::Stopwatches;
use std::ops::Range;

/// Work space of one thread; no data of one rock is used for the next.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Contacts, springs and neighbour list of a sphere; see [`ContactState`].
    state: ContactState,
    /// The same for a block.
    footing: BlockContactState,
    /// Scars that the rock has made in soil.
    scars: Scars,
    /// Slip distance on each ground where friction grows with slip.
    slip: Slip,
    /// Contact laws of the grounds for this rock: stiffness, damping, friction.
    laws: Vec<Law>,
    /// Damping of the grounds of the rock before, by ground: most scenes never change it. An entry
    /// is valid as long as the restitution of its ground is the same.
    damping: Vec<Damping>,
}

impl Scratch {
    /// With running clocks; see [`Self::stopwatches`].
    pub fn timed() -> Self {
        let mut scratch = Self::default();
        scratch.state.stopwatches = Stopwatches::running();
        scratch
    }

    /// Computing time of all trajectories so far, by part.
    pub fn stopwatches(&self) -> &Stopwatches {
        &self.state.stopwatches
    }

    /// Computes the laws of all grounds for one rock. The damping ratio that gives a restitution
    /// needs a root search, so it is reused as long as the restitution of a ground stays the same.
    fn make_laws(&mut self, release: &Release, settings: &RunSettings, is_block: bool) {
        let capture = settings.capture(is_block.then_some(release.rock.radius_m));
        self.damping.truncate(release.grounds.len());
        self.laws.clear();
        for (k, ground) in release.grounds.iter().enumerate() {
            if self.damping.get(k).is_none_or(|known| known.restitution != ground.restitution) {
                self.damping.truncate(k);
                self.damping.push(Damping::of(ground.restitution));
            }
            self.laws.push(Law::new(ground, &self.damping[k], &release.rock, &capture));
        }
        self.scars.begin(&release.grounds, settings.step.scheme.has_springs());
    }
}

/// Simulates one sphere from its release to its stop.
///
/// A pure function of its arguments: `scratch` only lends memory, so that the same rock gives the
/// same bytes on every thread.
pub fn simulate(
    settings: &RunSettings,
    release: &Release,
    options: RecordOptions,
    random: RandomStream,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, settings, false);
    let Scratch { state, scars, slip, laws, .. } = scratch;
    run_sphere(settings, release, options, (laws, random), (state, scars, slip))
}

/// Simulates one block from its release to its stop, as [`simulate`] does a sphere.
pub fn simulate_block(
    settings: &RunSettings,
    (release, drawn): (&Release, &DrawnShape),
    options: RecordOptions,
    random: RandomStream,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, settings, true);
    let Scratch { laws, footing, scars, .. } = scratch;
    run_block(settings, (release, drawn), options, (laws, random), (footing, scars))
}

/// Simulates release `index` of a plan from release to stop. A path is kept for the first releases
/// of the plan and for `paths`.
///
/// A release that cannot be made (off the terrain, or inside the ground) ends at its start
/// position.
///
/// # Errors
/// None today; a caller must be ready for one.
///
/// The random stream depends on seed, purpose and number alone: rock 137 is the same alone,
/// resumed, or among a million.
pub fn simulate_release(
    plan: &Plan,
    index: usize,
    paths: Option<&Range<usize>>,
    scratch: &mut Scratch,
) -> Result<Trajectory> {
    let release = match plan.try_release(index) {
        Ok(release) => release,
        Err(lost) => {
            return Ok(Trajectory::not_released(index, lost.rock, lost.start, lost.reason));
        }
    };
    let options = record_options(plan, index, paths);
    let settings = RunSettings::of(plan);
    let random = stream(plan.seed, Purpose::Impacts, index);
    let trajectory = if let Some(drawn) = plan.releases.block(index, &release.rock) {
        simulate_block(&settings, (&release, &drawn), options, random, scratch)
    } else {
        simulate(&settings, &release, options, random, scratch)
    };
    Ok(Trajectory { index, ..trajectory })
}

/// What to record of release `index`: a path for the first releases of the plan and for `paths`. A
/// path that is requested by number is kept even where the plan leaves paths out.
pub(super) fn record_options(
    plan: &Plan,
    index: usize,
    paths: Option<&Range<usize>>,
) -> RecordOptions {
    let is_requested = paths.is_some_and(|paths| paths.contains(&index));
    let path_step_s = match &plan.paths {
        Part::Kept(paths) if is_requested || index < paths.first => Some(paths.step_s),
        Part::LeftOut(_) if is_requested => Some(PATH_STEP_S),
        _ => None,
    };
    RecordOptions { path_step_s, impacts: plan.impacts.is_kept() }
}
