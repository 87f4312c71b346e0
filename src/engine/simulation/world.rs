//! Many rocks in one world: in short windows of time, rocks that may meet form islands.
//!
//! Rocks in flight follow parabolas, also past each other: the time of a collision in flight is the
//! root of a quadratic. An island has its own time step. An island in which all is quiet sleeps
//! until something comes near. Windows, islands and contacts have a fixed order, so the number of
//! threads changes nothing.
//!
//! Every rock is advanced by the scheme of the scene as if it were alone, until a window shows that
//! it may meet another; so a world of rocks that never meet gives the trajectories of single rocks.
//! The springs between two rocks follow a law of their own (`PairMaterial`), with the reduced mass
//! `m_a m_b/(m_a + m_b)`.

mod statistics;
mod bodies;
mod window;
mod snapshot;
mod subdivide;
mod body;
mod prediction;
mod heaps;
mod cached_pairs;

use super::recorder::{RecordOptions, Recorder};
use super::rest::RestCriterion;
use super::rock_geometry::RockGeometry;
use super::settings::RunSettings;
use super::single::record_options;
use super::{Stop, Trajectory};
use crate::contact::pair::{Bond, BondStrength, PairHistory, normal_and_distance};
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

/// Material of the contacts between rocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairMaterial {
    /// Springs, friction and restitution, as for a ground.
    pub ground: Ground,
    /// Bonds between rocks that touch at the start.
    pub strength: BondStrength,
}

/// Rocks with a gap below this at the start touch (–, relative to the smaller radius): coordinates
/// are typed with five or six digits.
const TOUCH_TOLERANCE: f64 = 1e-4;

/// Number of dampings that are cached. The damping of a restitution needs a root search; with more
/// different ones than this some are computed again.
const CACHED_DAMPINGS: usize = 16;

/// One rock of a world during the simulation.
struct WorldBody<'a> {
    member: BodySlot,
    recorder: Recorder<'a>,
    state: BodyState,
    /// Time at which its flight ends (s), and why the rock stops there, if it does. None for a rock
    /// in contact, and for one whose flight has not been searched yet.
    flight_end: Option<(f64, Option<Stop>)>,
    /// Criterion of rest.
    rest_criterion: RestCriterion,
    /// Step that its last island would have tried next (s).
    ///
    /// Step control continues with it, so that a rock that changes islands need not begin with the
    /// step of the onset of an impact.
    next_step_s: f64,
    /// Velocity at the start of the window, and the largest deviation from it since (m/s). The
    /// prediction of collisions is checked against this at the end of the window.
    deviation: (Vec3, f64),
    /// Velocity change expected from the last pass through these windows (m/s), 0 in the first.
    predicted_dv_m_s: f64,
    /// Speed that the compressed springs may give it (m/s). `Σ F/(m ω)`: a spring with force F
    /// gives a mass no more than this when it relaxes.
    spring_dv_m_s: f64,
    /// Whether a bond joins it to another rock of its island.
    is_bonded: bool,
    /// Mechanical energy, and the energy given to others, at the start of the contact episode (J).
    episode_start_j: (f64, f64),
    /// Whether its contacts have no springs: in the rigid limit, and in heaps.
    is_unloaded: bool,
    /// Start of the step whose impacts are being recorded (s), and the mechanical energy then (J).
    step_start: Option<(f64, f64)>,
}

/// State of a rock in a world.
#[derive(Debug, Clone, PartialEq)]
enum BodyState {
    /// Simulated.
    Moving,
    /// At rest until something comes near; no island computes it meanwhile.
    Asleep,
    /// Removed from the world.
    Removed(Stop),
}

/// Simulates all releases of a plan whose rocks share one world, in order; `None` if `stop` was
/// raised before the end. A path is kept for the first releases of the plan and for `paths`.
///
/// # Errors
/// A release that cannot be made, rocks that overlap at the start, a plan without contact
/// between rocks.
pub fn simulate_releases_together(
    plan: &Plan,
    paths: Option<&Range<usize>>,
    stop: &AtomicBool,
) -> Result<Option<Vec<Trajectory>>> {
    let Part::Kept(ground) = &plan.rock_against_rock else {
        return Err(Error::Request("the rocks of this plan do not share one world".to_owned()));
    };
    let releases = plan.world()?;
    let none = BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 };
    let strength = if let Part::Kept(strength) = plan.bonds { strength } else { none };
    let material = PairMaterial { ground: *ground, strength };
    let options_of = |index| record_options(plan, index, paths);
    let trajectories = simulate_world(
        &RunSettings::of(plan),
        &releases,
        &material,
        options_of,
        Observer::silent(stop),
    );
    Ok(trajectories.map(|(trajectories, _)| trajectories))
}

/// Observer of a world: called after each window, and free to stop the simulation.
#[derive(Debug)]
pub struct Observer<'a, F> {
    /// Raised when the run shall end.
    pub stop: &'a AtomicBool,
    /// Called with the end of each window (s) and the counts so far. The world may return to an
    /// earlier time and continue from there.
    pub observe: F,
}

impl<'a> Observer<'a, fn(f64, &WorldStats)> {
    /// An observer that observes nothing.
    pub fn silent(stop: &'a AtomicBool) -> Self {
        Self { stop, observe: |_, _| () }
    }
}

/// Simulates all rocks of one world until they stop; returns the trajectories in the order of the
/// releases, and the counts. `None` if it was stopped. `options_of` says what to record of each rock.
pub fn simulate_world(
    settings: &RunSettings,
    releases: &[Release],
    material: &PairMaterial,
    options_of: impl Fn(usize) -> RecordOptions,
    Observer { stop, observe }: Observer<impl FnMut(f64, &WorldStats)>,
) -> Option<(Vec<Trajectory>, WorldStats)> {
    // Most scenes give all rocks the same ground: its damping is computed once.
    let mut cache: Vec<Damping> = Vec::new();
    let mut damping = |restitution| {
        let found = cache.iter().find(|cached| cached.restitution == restitution).copied();
        found.unwrap_or_else(|| {
            cache.insert(0, Damping::of(restitution));
            cache.truncate(CACHED_DAMPINGS);
            cache[0]
        })
    };
    let bodies = releases
        .iter()
        .enumerate()
        .map(|(k, release)| {
            let mut body = new_body(settings, release, options_of(k), &mut damping);
            let random = stream(settings.seed, Purpose::Impacts, k);
            let state = &mut body.member.state;
            state.stem_load.reset(settings.terrain, &random, &mut state.near.broken_stems);
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

/// One rock at its release: springs relaxed, in flight until its island finds a contact.
fn new_body<'a>(
    settings: &RunSettings<'a>,
    release: &Release,
    options: RecordOptions,
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
            RockGeometry { rock: release.rock, block: None },
            (motion, None),
            (options, settings.recorders),
        ),
        state: BodyState::Moving,
        flight_end: None,
        rest_criterion: RestCriterion::new(motion.position_m),
        next_step_s: f64::INFINITY,
        deviation: (Vec3::zeros(), 0.0),
        predicted_dv_m_s: 0.0,
        spring_dv_m_s: 0.0,
        is_bonded: false,
        is_unloaded: !settings.step.scheme.has_springs(),
        episode_start_j: (0.0, 0.0),
        step_start: None,
    }
}

/// The contact law of two rocks, with the reduced mass, and the smaller radius as the lever of
/// rolling friction.
fn law_between(a: &Body, b: &Body, material: &(Ground, Damping), capture: &Capture) -> Law {
    let mass = a.reduced_mass_with(b);
    Law::of_mass(&material.0, &material.1, (mass, a.radius.min(b.radius)), capture)
}

impl BodyWorld<'_> {
    /// Bonds the rocks that touch at the start. The rigid limit has no bonds, because it has no
    /// springs by which a bond could break.
    fn bond(&mut self, material: &PairMaterial) {
        if !material.strength.is_some() || self.is_rigid() {
            return;
        }
        // both rocks are in contact from the start: a bonded block begins free of internal stress,
        // whatever its weight then does to it
        for (a, b) in self.touching_at_start() {
            let [member_a, member_b] = [a, b].map(|k| &self.body(k).member);
            let (n, length) = normal_and_distance(&member_a.state.c, &member_b.state.c);
            let radius = member_a.body.radius.min(member_b.body.radius);
            let bond = Bond::new(&material.strength, radius, length);
            let law = self.law(a, b);
            self.add_pair(&PairHistory { n, bond: Some(bond), ..PairHistory::new(a, b, law) });
            self.begin_contact_of(a);
            self.begin_contact_of(b);
        }
    }

    /// The complete trajectories.
    pub(super) fn end(self, releases: &[Release]) -> Vec<Trajectory> {
        let held_j = self.pair_spring_energy_j();
        let Self { settings, mut bodies, now_s, .. } = self;
        for (body, held_j) in bodies.iter_mut().flatten().zip(held_j) {
            body.recorder.book_pair_spring_energy(held_j);
        }
        let bodies = bodies.into_iter().flatten().enumerate();
        bodies
            .zip(releases)
            .map(|((k, body), release)| body.end(settings, k, release, now_s))
            .collect()
    }

    /// Elastic energy of the contacts between rocks (J), half of it to each rock. Heaps in the
    /// rigid limit have released it all into motion.
    fn pair_spring_energy_j(&self) -> Vec<f64> {
        let mut held_j = vec![0.0; self.bodies.len()];
        if self.is_rigid() {
            return held_j;
        }
        // both rocks of a pair are in the same island
        let is_held = |pair: &&PairHistory| pair.is_held() && !self.body(pair.a).is_unloaded;
        for pair in self.pair_histories.iter().filter(is_held) {
            let [member_a, member_b] = [pair.a, pair.b].map(|k| &self.body(k).member);
            let (_, distance) = normal_and_distance(&member_a.state.c, &member_b.state.c);
            let stored_j = pair.stored_j(distance, member_a.body.radius + member_b.body.radius);
            for k in [pair.a, pair.b] {
                held_j[k as usize] += 0.5 * stored_j;
            }
        }
        held_j
    }
}
