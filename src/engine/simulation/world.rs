//! Many rocks in one world: short windows of time in which those that may meet form islands.
//!
//! Rocks in flight leap, also past each other: their meeting is a quadratic. An island has its own step; where all of
//! it is quiet it sleeps until something comes near. Windows, islands and contacts stand in a fixed order, so the
//! number of threads changes nothing.
//!
//! Every rock is advanced by the scheme of the scene as if it were alone, until a window shows that
//! it may meet another; so a world of rocks that never meet gives the paths of single rocks. The
//! springs between two rocks carry the rocks' own law (`PairMaterial`), the masses of a pair
//! entering as `m_a m_b/(m_a + m_b)`.

mod statistics;
mod bodies;
mod window;
mod snapshot;
mod subdivide;
mod body;
mod prediction;
mod heaps;
mod cached_pairs;

use super::form::Form;
use super::recorder::{Keep, Recorder};
use super::rest::RestCriterion;
use super::settings::RunSettings;
use super::single::kept;
use super::{Stop, Trajectory};
use crate::contact::pair::{Bond, PairHistory, Strength, between};
use crate::error::{Error, Result};
use crate::ground::{Capture, Damping, Ground, Law};
use crate::plan::{Part, Plan};
use crate::random::{Purpose, stream};
use crate::release::Release;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::island::{BodySlot, IslandBody};
use crate::solver::roughness::RoughFacets;
use bodies::BodyWorld;
pub use statistics::WorldStats;
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// How the rocks of a scene answer each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairMaterial {
    /// Springs, friction and restitution, as of a ground.
    pub ground: Ground,
    /// Bonds between rocks that touch at the start.
    pub strength: Strength,
}

/// Rocks nearer than this at the start touch (–, relative to the smaller radius): coordinates are typed with five or
/// six digits.
const TOUCHING: f64 = 1e-4;

/// Dashpots that are kept at hand.
/// Damping for a restitution is a root search; more different ones than this are sought again.
const KNOWN: usize = 16;

/// One rock on its way.
struct WorldBody<'a> {
    member: BodySlot,
    recorder: Recorder<'a>,
    state: BodyState,
    /// When its flight ends (s), and how.
    /// None for a rock in contact, and for one that has not looked ahead yet.
    lands: Option<(f64, Option<Stop>)>,
    /// Whether it is slow and gets no faster.
    calm: RestCriterion,
    /// Step its last island would have tried next (s).
    ///
    /// Error control goes on from it, so that a rock that changes islands need not begin with the
    /// onset of an impact.
    h: f64,
    /// Velocity when the window began, and the largest change of it since (m/s).
    /// This is what the prediction of meetings is checked by at the window's end.
    off: (Vec3, f64),
    /// By how much its velocity changed when these windows were gone through before (m/s).
    foreseen_m_s: f64,
    /// Speed that the springs which press on it may give it (m/s).
    /// `Σ F/(m ω)`: a spring that holds F gives a mass no more than this when it lets go.
    pressed_m_s: f64,
    /// Mechanical energy and what others had got of it at the beginning of the contact episode (J).
    began_j: (f64, f64),
    /// Whether its contacts have no springs: in the rigid limit, and in heaps.
    is_unloaded: bool,
    /// When the step began that blows have been gone through of (s), and the mechanical energy then (J).
    step_began: Option<(f64, f64)>,
}

/// Where a rock is in its story.
#[derive(Debug, Clone, PartialEq)]
enum BodyState {
    /// Under way.
    Moving,
    /// At rest until something comes near.
    /// No island computes it meanwhile.
    Asleep,
    /// No longer in the world.
    Gone(Stop),
}

/// All releases of a plan whose rocks share one world, in order; `None` if `stop` was raised before the end. A path is
/// kept for the plan's first releases and for `paths`.
///
/// # Errors
/// A release that cannot be made, rocks that overlap at the start, a plan without contact between rocks.
pub fn simulate_releases_together(
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
    let answer = PairMaterial { ground: *ground, strength };
    let keep = |index| kept(plan, index, paths);
    let falls =
        simulate_world(&RunSettings::of(plan), &releases, &answer, keep, Observer::silent(stop));
    Ok(falls.map(|(falls, _)| falls))
}

/// Who asks for a world: told of it window by window, and free to end it.
#[derive(Debug)]
pub struct Observer<'a, F> {
    /// Raised when the run shall end.
    pub stop: &'a AtomicBool,
    /// Told the end of each window of time (s) and the counts so far. The world may go back to an earlier time, and goes
    /// on from there.
    pub observe: F,
}

impl<'a> Observer<'a, fn(f64, &WorldStats)> {
    /// Told nothing.
    pub fn silent(stop: &'a AtomicBool) -> Self {
        Self { stop, observe: |_, _| () }
    }
}

/// Follows all rocks of one world to their stops, in the order of the releases, with what it took; `None` if it was
/// stopped. `keep` says what to keep of each rock's way.
pub fn simulate_world(
    settings: &RunSettings,
    releases: &[Release],
    material: &PairMaterial,
    keep: impl Fn(usize) -> Keep,
    Observer { stop, observe }: Observer<impl FnMut(f64, &WorldStats)>,
) -> Option<(Vec<Trajectory>, WorldStats)> {
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
    let bodies = releases
        .iter()
        .enumerate()
        .map(|(k, release)| {
            let mut body = body(settings, release, keep(k), &mut damping);
            let random = stream(settings.seed, Purpose::Impacts, k);
            let state = &mut body.member.state;
            state.stem_load.reset(settings.terrain, &random, &mut state.near.gone);
            body.member.state.facets = RoughFacets::of(random, &body.member.laws);
            Some(Box::new(body))
        })
        .collect();
    let step = heaps::step_in_heaps(settings.step, material);
    let heaps = step.as_ref().map(|step| RunSettings { step, ..*settings });
    let mut world = BodyWorld::new((settings, heaps.as_ref()), material, bodies);
    world.bond(material);
    world.run(stop, observe).then(|| {
        let statistics = world.statistics;
        (world.end(releases), statistics)
    })
}

/// One rock at its release: springs at rest, flying until its island says otherwise.
fn body<'a>(
    settings: &RunSettings<'a>,
    release: &Release,
    keep: Keep,
    damping: &mut impl FnMut(Option<f64>) -> Damping,
) -> WorldBody<'a> {
    let laws = release.grounds.iter().map(|ground| {
        Law::new(ground, &damping(ground.restitution), &release.rock, &settings.capture(None))
    });
    let motion = release.motion;
    let body = Body::new(&release.rock, settings.gravity_m_s2);
    let start = (motion.position_m, motion.velocity_m_s, motion.spin_rad_s);
    WorldBody {
        member: BodySlot::new(IslandBody::new(body, laws.collect(), start)),
        recorder: Recorder::new(
            settings.terrain,
            Form { rock: release.rock, block: None },
            (motion, None),
            (keep, settings.recorders),
        ),
        state: BodyState::Moving,
        lands: None,
        calm: RestCriterion::from(motion.position_m),
        h: f64::INFINITY,
        off: (Vec3::zeros(), 0.0),
        foreseen_m_s: 0.0,
        pressed_m_s: 0.0,
        is_unloaded: !settings.step.scheme.has_springs(),
        began_j: (0.0, 0.0),
        step_began: None,
    }
}

/// The contact law of two rocks.
/// Reduced mass, and the smaller radius as the lever of rolling friction.
fn law_between(a: &Body, b: &Body, answer: &(Ground, Damping), capture: &Capture) -> Law {
    let mass = a.reduced_mass_with(b);
    Law::of_mass(&answer.0, &answer.1, (mass, a.radius.min(b.radius)), capture)
}

impl BodyWorld<'_> {
    /// Bonds the rocks that touch at the start; the rigid limit has no springs by which a bond would break, and none.
    fn bond(&mut self, answer: &PairMaterial) {
        if !answer.strength.is_some() || self.is_rigid() {
            return;
        }
        // both rocks are in contact from the start: a bonded block begins at rest in itself,
        // whatever its weight then does to it
        for (a, b) in self.touching_at_start() {
            let [one, two] = [a, b].map(|k| &self.body(k).member);
            let (n, length) = between(&one.state.c, &two.state.c);
            let radius = one.body.radius.min(two.body.radius);
            let bond = Bond::new(&answer.strength, radius, length);
            let law = self.law(a, b);
            self.tie(&PairHistory { n, bond: Some(bond), ..PairHistory::new(a, b, law) });
            self.hold(a);
            self.hold(b);
        }
    }

    /// The journeys, complete.
    pub(super) fn end(self, releases: &[Release]) -> Vec<Trajectory> {
        let held_j = self.held_by_pairs_j();
        let Self { settings, mut bodies, now_s, .. } = self;
        for (body, held_j) in bodies.iter_mut().flatten().zip(held_j) {
            body.recorder.hold_for_others(held_j);
        }
        let bodies = bodies.into_iter().flatten().enumerate();
        bodies
            .zip(releases)
            .map(|((k, body), release)| body.end(settings, k, release, now_s))
            .collect()
    }

    /// What springs between rocks hold (J), half of it each rock's. Heaps in the rigid limit have given all of it to the motion.
    fn held_by_pairs_j(&self) -> Vec<f64> {
        let mut held_j = vec![0.0; self.bodies.len()];
        if self.is_rigid() {
            return held_j;
        }
        // both ends are of one island
        let is_held = |pair: &&PairHistory| pair.is_held() && !self.body(pair.a).is_unloaded;
        for pair in self.pair_histories.iter().filter(is_held) {
            let [one, two] = [pair.a, pair.b].map(|k| &self.body(k).member);
            let (_, distance) = between(&one.state.c, &two.state.c);
            let stored_j = pair.stored_j(distance, one.body.radius + two.body.radius);
            for k in [pair.a, pair.b] {
                held_j[k as usize] += 0.5 * stored_j;
            }
        }
        held_j
    }
}
