//! Many rocks in one world: short windows of time in which those that may meet form islands.
//!
//! Rocks in flight leap, also past each other: their meeting is a quadratic. An island has its own step; where all of
//! it is quiet it sleeps until something comes near. Windows, islands and contacts stand in a fixed order, so the
//! number of threads changes nothing.

mod census;
mod crowd;
mod job;
mod moment;
mod parts;
mod rover;
mod split;
mod wide;

use super::calm::Calm;
use super::fall::{Course, kept};
use super::form::Form;
use super::journey::{Journey, Keep};
use super::{Stop, Trajectory};
use crate::contact::pair::{Bond, Strength, Tie, between};
use crate::coupled::{Member, Seat};
use crate::error::{Error, Result};
use crate::ground::{Capture, Damping, Ground, Law};
use crate::plan::{Part, Plan};
use crate::release::Release;
use crate::rock::Vec3;
use crate::step::law::Body;
pub use census::Census;
use crowd::Crowd;
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// How the rocks of a scene answer each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Springs, friction and restitution, as of a ground.
    pub ground: Ground,
    /// Bonds between rocks that touch at the start.
    pub strength: Strength,
}

/// Rocks nearer than this at the start touch (–, relative to the smaller radius): coordinates are typed with five or
/// six digits.
const TOUCHING: f64 = 1e-4;

/// Dashpots that are kept at hand.
const KNOWN: usize = 16;

/// One rock on its way.
struct Rover<'a> {
    member: Seat,
    journey: Journey<'a>,
    state: State,
    /// When its flight ends (s), and how.
    lands: Option<(f64, Option<Stop>)>,
    /// Whether it is slow and gets no faster.
    calm: Calm,
    /// Step its last island would have tried next (s).
    h: f64,
    /// Velocity when the window began, and the largest change of it since (m/s).
    off: (Vec3, f64),
    /// By how much its velocity changed when these windows were gone through before (m/s).
    foreseen_m_s: f64,
    /// Speed that the springs which press on it may give it (m/s).
    pressed_m_s: f64,
    /// Mechanical energy and what others had got of it at the beginning of the contact episode (J).
    began_j: (f64, f64),
}

/// Where a rock is in its story.
#[derive(Debug, Clone, PartialEq)]
enum State {
    /// Under way.
    Moving,
    /// At rest until something comes near.
    Asleep,
    /// No longer in the world.
    Gone(Stop),
}

/// All releases of a plan whose rocks share one world, in order; `None` if `stop` was raised before the end. A path is
/// kept for the plan's first releases and for `paths`.
///
/// # Errors
/// A release that cannot be made, rocks that overlap at the start, a plan without contact between rocks.
pub fn fall_together(
    plan: &Plan,
    paths: Option<&Range<usize>>,
    stop: &AtomicBool,
) -> Result<Option<Vec<Trajectory>>> {
    let Part::Kept(ground) = &plan.rock_against_rock else {
        return Err(Error::Request("the rocks of this plan do not share one world".to_owned()));
    };
    let releases = plan.world()?;
    let none = Strength { tensile_pa: 0.0, cohesion_pa: 0.0 };
    let strength = if let Part::Kept(strength) = plan.bonds { strength } else { none };
    let answer = Answer { ground: *ground, strength };
    let keep = |index| kept(plan, index, paths);
    Ok(follow_together(&Course::of(plan), &releases, &answer, keep, stop))
}

/// Follows all rocks of one world to their stops, in the order of the releases; `None` if `stop` was raised.
///
/// `keep` says what to keep of each rock's way.
pub fn follow_together(
    course: &Course,
    releases: &[Release],
    answer: &Answer,
    keep: impl Fn(usize) -> Keep,
    stop: &AtomicBool,
) -> Option<Vec<Trajectory>> {
    follow_counted(course, releases, answer, keep, stop).map(|(falls, _)| falls)
}

/// The same, with what it took.
pub fn follow_counted(
    course: &Course,
    releases: &[Release],
    answer: &Answer,
    keep: impl Fn(usize) -> Keep,
    stop: &AtomicBool,
) -> Option<(Vec<Trajectory>, Census)> {
    follow_watched(course, releases, answer, keep, (stop, |_, _: &Census| ()))
}

/// The same; after each window of time `see` is told its end (s) and the counts so far. The world may go back to an
/// earlier time, and goes on from there.
pub fn follow_watched(
    course: &Course,
    releases: &[Release],
    answer: &Answer,
    keep: impl Fn(usize) -> Keep,
    (stop, see): (&AtomicBool, impl FnMut(f64, &Census)),
) -> Option<(Vec<Trajectory>, Census)> {
    // Most scenes give all rocks the same ground: its dashpot is sought once.
    let mut known: Vec<Damping> = Vec::new();
    let mut damping = |restitution| {
        let found = known.iter().find(|one| one.restitution == restitution).copied();
        found.unwrap_or_else(|| {
            known.insert(0, Damping::of(restitution));
            known.truncate(KNOWN);
            known[0]
        })
    };
    let rovers = releases
        .iter()
        .enumerate()
        .map(|(k, release)| Some(Box::new(rover(course, release, keep(k), &mut damping))))
        .collect();
    let mut crowd = Crowd::new(course, answer, rovers);
    crowd.bond(answer);
    crowd.run(stop, see).then(|| {
        let census = crowd.census;
        (crowd.end(releases), census)
    })
}

fn capture(course: &Course) -> Capture {
    Capture {
        own_m_s: course.step.capture_speed_m_s,
        tolerance_m_s: course.step.tolerance_m_s,
        gravity_m_s2: course.gravity_m_s2,
    }
}

fn rover<'a>(
    course: &Course<'a>,
    release: &Release,
    keep: Keep,
    damping: &mut impl FnMut(Option<f64>) -> Damping,
) -> Rover<'a> {
    let laws = release.grounds.iter().map(|ground| {
        Law::new(ground, &damping(ground.restitution), &release.rock, &capture(course))
    });
    let motion = release.motion;
    let body = Body::new(&release.rock, course.gravity_m_s2);
    let start = (motion.position_m, motion.velocity_m_s, motion.spin_rad_s);
    Rover {
        member: Seat::new(Member::new(body, laws.collect(), start)),
        journey: Journey::new(
            course.terrain,
            Form { rock: release.rock, block: None },
            (motion, None),
            (keep, course.watch),
        ),
        state: State::Moving,
        lands: None,
        calm: Calm::from(motion.position_m),
        h: f64::INFINITY,
        off: (Vec3::zeros(), 0.0),
        foreseen_m_s: 0.0,
        pressed_m_s: 0.0,
        began_j: (0.0, 0.0),
    }
}

/// The contact law of two rocks.
fn law_between(a: &Body, b: &Body, answer: &(Ground, Damping), capture: &Capture) -> Law {
    let mass = a.mass * b.mass / (a.mass + b.mass);
    Law::of_mass(&answer.0, &answer.1, (mass, a.radius.min(b.radius)), capture)
}

impl Crowd<'_> {
    /// Bonds the rocks that touch at the start; the rigid limit has no springs by which a bond would break, and none.
    fn bond(&mut self, answer: &Answer) {
        if !answer.strength.is_some() || self.is_rigid() {
            return;
        }
        for (a, b) in self.touching_at_start() {
            let [one, two] = [a, b].map(|k| &self.rover(k).member);
            let (n, length) = between(&one.grip.c, &two.grip.c);
            let radius = one.body.radius.min(two.body.radius);
            let bond = Bond::new(&answer.strength, radius, length);
            let law = self.law(a, b);
            self.tie(Tie { n, bond: Some(bond), ..Tie::new(a, b, law) });
            self.hold(a);
            self.hold(b);
        }
    }
}
