//! The fall itself: leap, touch, step, stop.

use super::block::follow_block;
use super::calm::Calm;
use super::form::Form;
use super::journey::{Journey, Keep};
use super::roughness::Roughness;
use super::stems::Strain;
use super::{Stop, Trajectory};
use crate::chance::{Chance, Purpose, stream};
use crate::clock::{Clocks, Piece};
use crate::error::Result;
use crate::flight::{Landing, Parabola, leap_past};
use crate::ground::{Capture, Damping, Law};
use crate::plan::{PATH_STEP_S, Part, Plan, RestRule, Watch};
use crate::release::{Drawn, Release};
use crate::rock::{Motion, Vec3};
use crate::step::block::Footing;
use crate::step::grip::{Grip, Loss, World};
use crate::step::law::Body;
use crate::step::{self, Scheme, Settings, Stepper};
use crate::terrain::Terrain;
use std::f64::consts::PI;
use std::ops::Range;

/// What all rocks of a scene have in common.
#[derive(Debug, Clone, Copy)]
pub struct Course<'a> {
    /// The meshes.
    pub terrain: &'a Terrain,
    /// Gravity (m/s²).
    pub gravity_m_s2: f64,
    /// The step.
    pub step: &'a Settings,
    /// When a rock is at rest.
    pub rest: RestRule,
    /// Simulated time after which a rock is out of time (s).
    pub longest_s: f64,
    /// Evaluation lines and map cells.
    pub watch: Watch<'a>,
}

/// Work space of one thread; nothing of one rock is left for the next.
#[derive(Debug, Default)]
pub struct Scratch {
    grip: Grip,
    footing: Footing,
    strain: Strain,
    laws: Vec<Law>,
    /// Dashpots of the grounds of the rock before: most scenes never change them.
    damping: Vec<Damping>,
}

impl Scratch {
    /// With clocks that run; see [`Self::clocks`].
    pub fn timed() -> Self {
        let mut scratch = Self::default();
        scratch.grip.clocks = Clocks::running();
        scratch
    }

    /// Where the time of all journeys so far went.
    pub fn clocks(&self) -> &Clocks {
        &self.grip.clocks
    }

    fn make_laws(&mut self, release: &Release, capture: &Capture) {
        self.damping.truncate(release.grounds.len());
        self.laws.clear();
        for (k, ground) in release.grounds.iter().enumerate() {
            if self.damping.get(k).is_none_or(|known| known.restitution != ground.restitution) {
                self.damping.truncate(k);
                self.damping.push(Damping::of(ground.restitution));
            }
            self.laws.push(Law::new(ground, &self.damping[k], &release.rock, capture));
        }
    }
}

/// An impact is over after so many contact times (–), whether the rock has left or not.
pub(super) const IMPACT_TIMES: f64 = 3.0;

/// Follows one rock from its release to its stop.
pub fn follow(
    course: &Course,
    release: &Release,
    keep: Keep,
    chance: &mut Chance,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, &capture_of(course));
    scratch.grip.near.forget();
    (scratch.grip.near.tested, scratch.grip.sweeps) = (0, 0);
    scratch.strain.begin(course.terrain, &mut scratch.grip.near.gone, chance);
    let world = World {
        terrain: course.terrain,
        body: Body::new(&release.rock, course.gravity_m_s2),
        laws: &scratch.laws,
    };
    let mut fall = Fall {
        course,
        world,
        grip: &mut scratch.grip,
        strain: &mut scratch.strain,
        chance,
        roughness: Roughness::default(),
        journey: Journey::new(
            course.terrain,
            Form { rock: release.rock, block: None },
            (release.motion, None),
            (keep, course.watch),
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
pub fn roll(
    course: &Course,
    (release, drawn): (&Release, &Drawn),
    keep: Keep,
    scratch: &mut Scratch,
) -> Trajectory {
    scratch.make_laws(release, &capture_of(course));
    follow_block(course, (release, drawn), keep, &scratch.laws, &mut scratch.footing)
}

fn capture_of(course: &Course) -> Capture {
    Capture {
        own_m_s: course.step.capture_speed_m_s,
        tolerance_m_s: course.step.tolerance_m_s,
        gravity_m_s2: course.gravity_m_s2,
    }
}

/// Release `index` of a plan, from release to stop; a path is kept for the plan's first releases and for `paths`.
///
/// A release that cannot be made (off the terrain, or inside the ground) ends where it should have begun.
///
/// # Errors
/// None today; a caller must be ready for one.
pub fn fall(
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
    let course = Course::of(plan);
    let fallen = if let Some(drawn) = plan.block(index, &release.rock) {
        roll(&course, (&release, &drawn), keep, scratch)
    } else {
        let mut chance = stream(plan.seed, Purpose::Impacts, index);
        follow(&course, &release, keep, &mut chance, scratch)
    };
    Ok(Trajectory { index, ..fallen })
}

impl<'a> Course<'a> {
    /// What the rocks of a plan have in common.
    pub fn of(plan: &'a Plan) -> Self {
        Self {
            terrain: &plan.terrain,
            gravity_m_s2: plan.gravity_m_s2,
            step: &plan.step,
            rest: plan.rest,
            longest_s: plan.longest_s,
            watch: plan.watch(),
        }
    }
}

/// What to keep of release `index`: a path for the plan's first releases and for `paths`.
pub(super) fn kept(plan: &Plan, index: usize, paths: Option<&Range<usize>>) -> Keep {
    let wanted = paths.is_some_and(|paths| paths.contains(&index));
    let path_step_s = match &plan.paths {
        Part::Kept(paths) if wanted || index < paths.first => Some(paths.step_s),
        Part::LeftOut(_) if wanted => Some(PATH_STEP_S),
        _ => None,
    };
    Keep { path_step_s, impacts: plan.impacts.is_kept() }
}

pub(super) struct Fall<'a> {
    pub(super) course: &'a Course<'a>,
    pub(super) world: World<'a>,
    pub(super) grip: &'a mut Grip,
    pub(super) strain: &'a mut Strain,
    pub(super) chance: &'a mut Chance,
    pub(super) roughness: Roughness,
    pub(super) journey: Journey<'a>,
}

impl Fall<'_> {
    /// Whether the rock is in contact with something it is pressed into.
    fn is_pressed(&mut self) -> bool {
        let now = self.journey.now;
        self.grip.begin(&self.world, now.position_m, now.velocity_m_s, now.spin_rad_s);
        self.grip.touches.iter().any(|touch| touch.distance_m < self.world.body.radius)
    }

    /// Leaps to the next touch.
    fn fly(&mut self) -> Option<Stop> {
        let now = self.journey.now;
        let flight = Parabola {
            start: now.position_m,
            velocity: now.velocity_m_s,
            gravity: self.course.gravity_m_s2,
            radius: self.world.body.radius,
        };
        let left = self.course.longest_s - now.time_s;
        let begun = self.grip.clocks.now();
        let (dt, stop) = match leap_past(
            self.course.terrain,
            &flight,
            left,
            &self.grip.near.gone,
            &mut self.journey.effort.triangles,
        ) {
            Landing::Touch(t) => (t, None),
            Landing::Leaves(t) => (t, Some(Stop::LeftTerrain)),
            Landing::Flies => (left, Some(Stop::TimeUp)),
        };
        // a touch at the very end of the time comes too late
        let stop = stop.or_else(|| (dt >= left).then_some(Stop::TimeUp));
        self.grip.clocks.stop(Piece::Leap, begun);
        self.journey.effort.leaps += 1;
        let begun = self.grip.clocks.now();
        self.journey.fly(&flight, None, dt);
        self.grip.clocks.stop(Piece::NotesInFlight, begun);
        // flights count too: between two plates a rock may fly without end and without getting on in time
        stop.or_else(|| self.over_budget())
    }

    /// Whether the rock has had all the work it may have.
    fn over_budget(&self) -> Option<Stop> {
        let most = self.course.step.scheme.most_work();
        (self.journey.effort.work() > most).then_some(Stop::OverBudget)
    }

    /// Goes on in contact until the rock is free again or stops.
    fn touch(&mut self) -> Option<Stop> {
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.journey.now;
        self.grip.begin(&self.world, c, v, w);
        self.announce();
        let before_j = self.total_j();
        let lost_before_j = self.journey.lost_j();
        // those of the look that `begin` has just taken
        let held = if self.is_rigid() { Loss::default() } else { self.grip.stored_j(&self.world) };
        let mut stepper = Stepper::new(self.course.step, &self.world, self.grip);
        let stop = self.steps(&mut stepper);
        let rise_j = self.total_j() - before_j;
        self.journey.ledger.remainder_j -= rise_j + self.journey.lost_j() - lost_before_j;
        // A rock that rests presses on its springs: what they hold is not lost.
        let stored = self.held();
        self.journey.pay(&stored, -1.0);
        self.journey.pay(&held, 1.0);
        self.journey.ledger.rise_j =
            self.journey.ledger.rise_j.max(rise_j + stored.sum() - held.sum());
        self.leave_facet();
        self.journey.end_impact();
        stop
    }

    /// Whether contacts have no springs: those of the rigid limit hold nothing, whatever the depth that rounding leaves.
    fn is_rigid(&self) -> bool {
        self.course.step.scheme == Scheme::Rigid
    }

    /// Energy in the contact springs at the end of an episode; only a fixed step leaves some in those of a free rock.
    fn held(&mut self) -> Loss {
        let left = self.grip.is_free() && self.course.step.scheme != Scheme::Dda;
        if left || self.is_rigid() { Loss::default() } else { self.grip.springs_j(&self.world) }
    }

    fn steps(&mut self, stepper: &mut Stepper) -> Option<Stop> {
        let mut calm = Calm::from(self.grip.c);
        loop {
            let left = self.course.longest_s - self.journey.now.time_s;
            self.strike();
            let done = match step::advance(stepper, &self.world, self.grip, left) {
                Ok(done) => done,
                Err(stuck) => return Some(Stop::Failed(stuck.to_string())),
            };
            // before its losses are paid, and with the speed before
            self.announce();
            let effort = &mut self.journey.effort;
            effort.steps += done.steps;
            effort.rejected += done.rejected;
            effort.unsettled += u64::from(done.unsettled);
            self.journey.pay(&done.loss, 1.0);
            self.bend(done.loss.trees, stepper);
            let to = Motion {
                time_s: self.journey.now.time_s + done.dt,
                position_m: self.grip.c,
                velocity_m_s: self.grip.v,
                spin_rad_s: self.grip.w,
            };
            let slides = self.grip.holds.iter().any(|hold| hold.slides);
            let begun = self.grip.clocks.now();
            self.journey.step(to, slides);
            self.leave_facet_in_time();
            self.journey.end_impact_in_time();
            self.grip.clocks.stop(Piece::NotesInContact, begun);
            let time_up = (done.dt >= left).then_some(Stop::TimeUp);
            let ends = time_up.or_else(|| self.over_budget());
            if self.grip.is_free() {
                return ends;
            }
            calm.note(done.dt, &to, self.world.body.radius, &self.course.rest);
            if calm.rests() {
                return Some(Stop::AtRest);
            }
            if ends.is_some() {
                return ends;
            }
        }
    }

    /// Notes down impacts that have just begun, and turns the rock against the facet of the fastest.
    fn announce(&mut self) {
        if self.grip.struck.is_empty() && self.grip.holds.iter().all(|hold| hold.announced) {
            return;
        }
        let radius = self.world.body.radius;
        let until_s = self.journey.now.time_s + self.impact_time();
        let mut fastest: Option<(f64, Vec3, u32)> = None;
        let Grip { holds, struck, c, .. } = &mut *self.grip;
        for hold in holds.iter_mut().chain(struck.iter_mut()).filter(|hold| !hold.announced) {
            hold.announced = true;
            if hold.captured {
                continue;
            }
            let point = *c - hold.n * radius;
            self.journey.begin_impact(point, hold.feature.kind, hold.triangle, until_s);
            let speed = -hold.n.dot(&self.journey.now.velocity_m_s);
            if speed > fastest.map_or(0.0, |(known, ..)| known) {
                fastest = Some((speed, hold.n, hold.triangle));
            }
        }
        if let Some((_, normal, triangle)) = fastest {
            self.meet_facet(normal, triangle, until_s);
        }
    }

    /// The longest an impact is taken to last (s): in the rigid limit no time at all.
    fn impact_time(&self) -> f64 {
        if self.is_rigid() {
            return 0.0;
        }
        let omegas = self.grip.holds.iter().map(|hold| self.world.law(hold.triangle).omega);
        let slowest = omegas.fold(f64::INFINITY, f64::min);
        IMPACT_TIMES * PI / slowest
    }

    /// Mechanical energy of the rock in contact (J), weight included.
    fn total_j(&mut self) -> f64 {
        self.grip.motion_j(&self.world.body)
            - self.world.body.mass * self.world.body.gravity.dot(&self.grip.c)
    }

    fn end(mut self, release: &Release, stop: Stop) -> Trajectory {
        self.journey.end_impact();
        self.journey.end_path();
        self.journey.effort.sweeps += self.grip.sweeps;
        self.journey.effort.triangles += self.grip.near.tested;
        let start = release.motion;
        let fallen = start.position_m.z - self.journey.now.position_m.z;
        let kinetic = start.translational_j(&release.rock) + start.rotational_j(&release.rock);
        let released_j = self.world.body.mass * self.course.gravity_m_s2 * fallen + kinetic;
        self.journey.into_trajectory(release, stop, released_j)
    }
}
