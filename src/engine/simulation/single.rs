//! One rock for itself: its laws, the work space of its thread, and whether it is a sphere or a block.

use super::Trajectory;
use super::block::follow_block;
use super::fall::follow_sphere;
use super::recorder::Keep;
use super::settings::RunSettings;
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

/// Work space of one thread; nothing of one rock is left for the next.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Contacts, springs and neighbours of a sphere; see [`ContactState`].
    state: ContactState,
    /// The same for a block.
    footing: BlockContactState,
    /// Scars that the rock has dug.
    scars: Scars,
    /// How far it has slipped on each ground, where friction grows with slip.
    slip: Slip,
    /// Contact laws of the grounds for this rock: stiffness, damping, friction.
    laws: Vec<Law>,
    /// Dashpots of the grounds of the rock before: most scenes never change them.
    /// By ground, as far as their restitution is still the same.
    damping: Vec<Damping>,
}

impl Scratch {
    /// With clocks that run; see [`Self::stopwatches`].
    pub fn timed() -> Self {
        let mut scratch = Self::default();
        scratch.state.stopwatches = Stopwatches::running();
        scratch
    }

    /// Where the time of all journeys so far went.
    pub fn stopwatches(&self) -> &Stopwatches {
        &self.state.stopwatches
    }

    /// Fills in the laws of all grounds for one rock. The damping ratio of a restitution takes a root search, so it is
    /// kept as long as the restitution of a ground stays the same.
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

/// Follows one rock from its release to its stop.
///
/// A pure function of its arguments: scratch only lends memory, so that the same rock comes out
/// with the same bytes on every thread.
pub fn simulate(
    settings: &RunSettings,
    release: &Release,
    keep: Keep,
    random: RandomStream,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, settings, false);
    let Scratch { state, scars, slip, laws, .. } = scratch;
    follow_sphere(settings, release, keep, (laws, random), (state, scars, slip))
}

/// The same for a block.
pub fn simulate_block(
    settings: &RunSettings,
    (release, drawn): (&Release, &DrawnShape),
    keep: Keep,
    random: RandomStream,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, settings, true);
    let Scratch { laws, footing, scars, .. } = scratch;
    follow_block(settings, (release, drawn), keep, (laws, random), (footing, scars))
}

/// Release `index` of a plan, from release to stop; a path is kept for the plan's first releases and for `paths`.
///
/// A release that cannot be made (off the terrain, or inside the ground) ends where it should have begun.
///
/// # Errors
/// None today; a caller must be ready for one.
///
/// The random stream belongs to seed, purpose and number: rock 137 is the same alone, resumed, or
/// among a million.
pub fn simulate_release(
    plan: &Plan,
    index: usize,
    paths: Option<&Range<usize>>,
    scratch: &mut Scratch,
) -> Result<Trajectory> {
    let release = match plan.try_release(index) {
        Ok(release) => release,
        Err(lost) => return Ok(Trajectory::not_released(index, lost.rock, lost.start, lost.why)),
    };
    let keep = kept(plan, index, paths);
    let settings = RunSettings::of(plan);
    let random = stream(plan.seed, Purpose::Impacts, index);
    let fallen = if let Some(drawn) = plan.releases.block(index, &release.rock) {
        simulate_block(&settings, (&release, &drawn), keep, random, scratch)
    } else {
        simulate(&settings, &release, keep, random, scratch)
    };
    Ok(Trajectory { index, ..fallen })
}

/// What to keep of release `index`: a path for the plan's first releases and for `paths`.
/// A path that is asked for by number is kept even where the plan leaves paths out.
pub(super) fn kept(plan: &Plan, index: usize, paths: Option<&Range<usize>>) -> Keep {
    let wanted = paths.is_some_and(|paths| paths.contains(&index));
    let path_step_s = match &plan.paths {
        Part::Kept(paths) if wanted || index < paths.first => Some(paths.step_s),
        Part::LeftOut(_) if wanted => Some(PATH_STEP_S),
        _ => None,
    };
    Keep { path_step_s, impacts: plan.impacts.is_kept() }
}
