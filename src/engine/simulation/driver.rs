//! The fall itself: leap, touch, step, stop.
//!
//! A journey alternates between two exact pictures. In flight the centre moves on a parabola, and the next touch is
//! the smallest root at which it comes within a radius of the mesh: no steps, no air drag. In contact a scheme
//! integrates translation, spin and springs until no contact is left. An episode of contact closes with an energy
//! balance: motion before and after, losses booked by cause, and the remainder, which is the error of the numerics.

use super::block::follow_block;
use super::fall::{Fall, Soil};
use super::form::Form;
use super::recorder::{Keep, Recorder};
use super::rest::RestCriterion;
use super::settings::RunSettings;
use super::{Stop, Trajectory};
use crate::error::Result;
use crate::flight::{Parabola, time_of_impact_past};
use crate::ground::{Damping, Law};
use crate::plan::{PATH_STEP_S, Part, Plan};
use crate::random::{Purpose, RandomStream, stream};
use crate::release::{DrawnShape, Release};
use crate::rock::Motion;
use crate::solver::block::Footing;
use crate::solver::body::Body;
use crate::solver::contact_state::ContactState;
use crate::solver::loss::Loss;
use crate::solver::roughness::RoughFacets;
use crate::solver::scar::Scars;
use crate::solver::slip::Slip;
use crate::solver::{self, Stepper};
use crate::stopwatch::{Stopwatches, TimedPiece};
use std::ops::Range;

/// Work space of one thread; nothing of one rock is left for the next.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Contacts, springs and neighbours of a sphere; see [`ContactState`].
    state: ContactState,
    /// The same for a block.
    footing: Footing,
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
    fn make_laws(&mut self, release: &Release, settings: &RunSettings) {
        let capture = settings.capture();
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
    scratch.make_laws(release, settings);
    scratch.state.near.forget();
    (scratch.state.near.tested, scratch.state.sweeps) = (0, 0);
    let state = &mut scratch.state;
    state.stem_load.raise(settings.terrain, &random, &mut state.near.gone);
    scratch.state.facets = RoughFacets::of(random, &scratch.laws);
    scratch.slip.begin(&release.grounds);
    let mut fall = Fall {
        settings,
        body: Body::new(&release.rock, settings.gravity_m_s2),
        laws: &mut scratch.laws,
        soil: Soil::new(&mut scratch.scars, &mut scratch.slip),
        state: &mut scratch.state,
        recorder: Recorder::new(
            settings.terrain,
            Form { rock: release.rock, block: None },
            (release.motion, None),
            (keep, settings.recorders),
        ),
    };
    // A rock that starts pressed into something must not fly out of its grip: a leap sees no touch where none begins.
    let mut stop = if fall.is_pressed() { fall.touch() } else { None };
    let stop = loop {
        stop = stop.or_else(|| fall.fly()).or_else(|| fall.touch());
        if let Some(stop) = stop {
            break stop;
        }
    };
    fall.end(release, stop)
}

/// The same for a block, with scheme `rigid`.
pub fn simulate_block(
    settings: &RunSettings,
    (release, drawn): (&Release, &DrawnShape),
    keep: Keep,
    random: RandomStream,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, settings);
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

impl Fall<'_> {
    /// Whether the rock is in contact with something it is pressed into.
    fn is_pressed(&mut self) -> bool {
        let now = self.recorder.now;
        let world = self.settings.around(self.body, self.laws);
        self.state.begin(&world, now.position_m, now.velocity_m_s, now.spin_rad_s);
        self.state.touches.iter().any(|touch| touch.distance_m < self.body.radius)
    }

    /// Leaps to the next touch.
    /// Cost: one search through the index, however long the flight.
    fn fly(&mut self) -> Option<Stop> {
        let now = self.recorder.now;
        let flight = Parabola::of(&now, self.settings.gravity_m_s2, self.body.radius);
        let left = self.settings.longest_s - now.time_s;
        let begun = self.state.stopwatches.now();
        // stems that this rock has broken are no longer in its way
        let end = time_of_impact_past(
            self.settings.terrain,
            &flight,
            left,
            &self.state.near.gone,
            &mut self.recorder.effort.triangles,
        );
        // a flight counts as one leap, however long
        self.recorder.effort.leaps += 1;
        let (dt, stop) = self.settings.end_of_flight(&end, now.time_s, &self.recorder.effort);
        self.state.stopwatches.stop(TimedPiece::Leap, begun);
        let begun = self.state.stopwatches.now();
        self.recorder.fly(&flight, None, dt);
        self.soil.fly(dt);
        self.state.stopwatches.stop(TimedPiece::NotesInFlight, begun);
        stop
    }

    /// Goes on in contact until the rock is free again or stops.
    ///
    /// Contact begins with a fresh look: memories of the episode before are gone, as a flight of
    /// any length relaxes the springs.
    fn touch(&mut self) -> Option<Stop> {
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.recorder.now;
        let world = self.settings.around(self.body, self.laws);
        self.state.begin(&world, c, v, w);
        self.in_contact().announce();
        // soil takes speed out of the blow before any spring answers
        let kept = self.answer_blow();
        self.recorder.now.velocity_m_s *= kept;
        // from here on the balance is kept
        let before_j = self.total_j();
        let lost_before_j = self.recorder.lost_j();
        let world = self.settings.around(self.body, self.laws);
        // A rock released pressed in, or one that never left, begins with energy in its springs: it
        // counts as brought along.
        let held = if self.is_rigid() { Loss::default() } else { self.state.stored_j(&world) };
        let mut stepper = Stepper::new(self.settings.step, &world, self.state);
        let stop = self.steps(&mut stepper);
        // ΔE of motion and weight; with losses ≥ 0 and springs at rest at both ends it is −(losses)
        // up to the numerics' own error, the remainder
        let rise_j = self.total_j() - before_j;
        self.recorder.ledger.remainder_j -= rise_j + self.recorder.lost_j() - lost_before_j;
        let stored = self.held();
        self.recorder.end_episode(rise_j, &stored, &held);
        self.recorder.end_all_impacts();
        self.in_contact().leave_facet();
        stop
    }

    /// Energy in the contact springs at the end of an episode; only a fixed step leaves some in those of a free rock.
    fn held(&mut self) -> Loss {
        let left = self.state.is_free() && !self.settings.step.scheme.has_fixed_step();
        if left || self.is_rigid() {
            return Loss::default();
        }
        self.state.springs_j(&self.settings.around(self.body, self.laws))
    }

    /// Steps through one episode of contact, until the rock flies (`None`) or ends.
    ///
    /// Each step: what the ground changes first, the step of the scheme, what it has struck, then the record. The
    /// order matters: impacts are noted with the speed before their losses are paid.
    fn steps(&mut self, stepper: &mut Stepper) -> Option<Stop> {
        let mut calm = RestCriterion::from(self.state.c);
        loop {
            let from = self.recorder.now;
            let now_s = from.time_s;
            let left = self.settings.longest_s - now_s;
            let calm_s = calm.longest_s(&from, self.body.radius, &self.settings.rest);
            // the shortest of the time left, of what tells rest, and of the way after which roughness, soil or slip change
            // the law
            let most = left.min(calm_s).min(self.before_step());
            let before = self.state.c;
            let world = self.settings.around(self.body, self.laws);
            let mut done = match solver::advance(stepper, &world, self.state, most) {
                Ok(done) => done,
                Err(stuck) => return Some(Stop::Failed(stuck.to_string())),
            };
            self.in_contact().announce();
            self.soil_after_step(&before, done.dt);
            self.answer_blow();
            let effort = &mut self.recorder.effort;
            effort.steps += done.steps;
            effort.rejected += done.rejected;
            effort.unsettled += u64::from(done.unsettled);
            let world = self.settings.around(self.body, self.laws);
            // a stem has given way: stiffness and contacts changed, so the stepper forgets its factors and its step
            if self.state.bend(&world, &mut done.loss) {
                *stepper = Stepper::new(self.settings.step, &world, self.state);
            }
            self.recorder.pay(&done.loss);
            let to = Motion {
                time_s: now_s + done.dt,
                position_m: self.state.c,
                velocity_m_s: self.state.v,
                spin_rad_s: self.state.w,
            };
            // one slipping contact makes the whole step "sliding" on the path
            let slides = self.state.histories.iter().any(|history| history.slides);
            let begun = self.state.stopwatches.now();
            self.recorder.step(to, slides);
            self.in_contact().end_impacts();
            self.state.stopwatches.stop(TimedPiece::NotesInContact, begun);
            let ends = self.settings.end_of_step(now_s, done.dt, &self.recorder.effort);
            if self.state.is_free() {
                return ends;
            }
            // rest: slow for long enough, and neither faster nor farther at the end than at the start
            calm.note(done.dt, [&from, &to], self.body.radius, &self.settings.rest);
            if calm.rests() {
                return Some(Stop::AtRest);
            }
            if ends.is_some() {
                return ends;
            }
        }
    }

    /// Mechanical energy of the rock in contact (J), weight included.
    /// `m v²/2 + I ω²/2 − m g·c`; springs are not in it.
    fn total_j(&mut self) -> f64 {
        self.state.motion_j(&self.body) - self.body.mass * self.body.gravity.dot(&self.state.c)
    }

    /// The journey, complete.
    fn end(mut self, release: &Release, stop: Stop) -> Trajectory {
        self.recorder.effort.sweeps += self.state.sweeps;
        self.recorder.effort.triangles += self.state.near.tested;
        let weight_n = self.body.mass * self.settings.gravity_m_s2;
        self.recorder.into_trajectory(
            release,
            stop,
            (weight_n, release.motion.kinetic_j(&release.rock)),
        )
    }
}
