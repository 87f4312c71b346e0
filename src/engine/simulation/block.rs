//! The simulation of one block: free rotation, contact, time step, stop.
//!
//! A block is a convex core with rounded corners. In flight it rotates as a free rigid body
//! (Euler's equations, solved by [`Top`]) while its centre follows a parabola. The first contact is
//! found by conservative advancement, since no closed form exists for a rotating body. In contact a
//! scheme with springs resolves every impact in time. In the rigid limit velocities are stepped
//! with impulses that keep the bodies apart under Coulomb's law (Moreau 1988).

mod impacts;

use super::driver::{RockSimulation, run_to_stop};
use super::impacts::MeshEnergy;
use super::recorder::{RecordOptions, Recorder};
use super::rock_geometry::{BlockRotation, RockGeometry, RockInstant};
use super::settings::RunSettings;
use super::{RockShape, Stop, Trajectory};
use crate::body::Block;
use crate::contact::MAX_CONTACTS;
use crate::contact::block::BlockContactPoint;
use crate::flight::Parabola;
use crate::flight::block::{BlockFlight, first_touch};
use crate::flight::top::Top;
use crate::ground::Law;
use crate::random::RandomStream;
use crate::release::{DrawnShape, Release};
use crate::rock::{Motion, Vec3};
use crate::solver::block::{BlockContactState, BlockState, BlockStepOutcome};
use crate::solver::body::Body;
use crate::solver::environment::ContactEnvironment;
use crate::solver::impact_point::ImpactPoint;
use crate::solver::loss::Loss;
use crate::solver::roughness::RoughFacets;
use crate::solver::scar::{GroundBlow, Scars};
use crate::solver::step_control::{Advance, StepError};

/// One block during its simulation.
struct BlockSimulation<'a> {
    /// Scheme, terrain, recorders and limits.
    settings: &'a RunSettings<'a>,
    /// Terrain, body and laws, as the contact solver needs them.
    world: ContactEnvironment<'a>,
    /// Its shape, mass and moments of inertia.
    block: &'a Block,
    /// Contacts found by the last detection, with the work space of the solver.
    footing: &'a mut BlockContactState,
    /// Scars that the block has made in soil.
    scars: &'a mut Scars,
    /// Pose, velocity and angular momentum. The state variable is momentum, not spin: in flight
    /// momentum is constant, while the spin changes direction.
    moving: BlockState,
    /// Recorder of the trajectory.
    recorder: Recorder<'a>,
    /// Whether no contact held it at the end of its last step.
    is_free: bool,
}

/// Simulates one block from its release to its stop; `laws` are the laws of the grounds for it.
pub(super) fn run_block(
    settings: &RunSettings,
    (release, drawn): (&Release, &DrawnShape),
    options: RecordOptions,
    (laws, random): (&[Law], RandomStream),
    (footing, scars): (&mut BlockContactState, &mut Scars),
) -> Trajectory {
    let block = &drawn.block;
    let world = settings.contact_environment(Body::of_block(block, settings.gravity_m_s2), laws);
    footing.forget();
    footing.stem_load.reset(settings.terrain, &random, &mut footing.near.broken_stems);
    (footing.near.tested, footing.sweeps) = (0, 0);
    footing.facets = RoughFacets::of(random, laws);
    footing.slip.begin(&release.grounds);
    let moving =
        BlockState::new(block, (release.motion.position_m, drawn.attitude), &release.motion);
    let geometry = RockGeometry { rock: release.rock, block: Some(block) };
    let rotation = rotation(block, &moving);
    let start = (release.motion, Some(rotation));
    let recorder = Recorder::new(settings.terrain, geometry, start, (options, settings.recorders));
    let mut rock =
        BlockSimulation { settings, world, block, footing, scars, moving, recorder, is_free: true };
    let stop = run_to_stop(&mut rock, false);
    rock.end((release, drawn), stop)
}

/// Attitude and rotational energy `ω·L/2` (J), for the recorder.
fn rotation(block: &Block, moving: &BlockState) -> BlockRotation {
    let rotational_j = 0.5 * moving.spin(block).dot(&moving.momentum);
    BlockRotation { attitude: moving.pose.attitude, rotational_j }
}

impl<'a> RockSimulation<'a> for BlockSimulation<'a> {
    /// None: the springs are stored with the contacts.
    type StepperState = ();

    fn settings(&self) -> &'a RunSettings<'a> {
        self.settings
    }

    fn recorder(&mut self) -> &mut Recorder<'a> {
        &mut self.recorder
    }

    /// The bounding sphere of the block: what the sphere does not touch, the block does not touch.
    /// At rest no corner may move either.
    fn bounding_sphere(&self) -> (Vec3, f64) {
        (self.moving.pose.centre, self.block.bound_m)
    }

    fn mechanical_energy_j(&self) -> f64 {
        let weight: Vec3 = self.world.body.gravity * self.block.mass_kg;
        self.moving.motion_j(self.block) - weight.dot(&self.moving.pose.centre)
    }

    fn fly(&mut self) -> Option<Stop> {
        let time_s = self.recorder.now.time_s;
        let block = self.block;
        let path = Parabola::of(&self.recorder.now, self.settings.gravity_m_s2, block.bound_m);
        let top = Top::new(block.inertia_kg_m2, self.moving.pose.attitude, self.moving.momentum);
        let time_left_s = self.settings.longest_s - time_s;
        let tumble = BlockFlight { block, top, path };
        let scratch = (&mut self.footing.near, &mut self.footing.window);
        let landing = first_touch(self.settings.terrain, &tumble, time_left_s, scratch);
        self.recorder.effort.leaps += 1;
        let (dt, stop) = self.settings.end_of_flight(&landing, time_s, &self.recorder.effort);
        self.recorder.record_flight(&path, Some(&tumble.top), dt);
        self.footing.slip.decay(dt);
        let speed_factor = self.scars.fly(&self.world.body, &self.recorder.now.velocity_m_s, dt);
        self.recorder.slow_in_soil_after_flight(speed_factor);
        self.moving.pose = tumble.pose(dt);
        self.moving.v = self.recorder.now.velocity_m_s;
        stop
    }

    fn begin_contact(&mut self) -> ((), Loss) {
        if self.has_springs() {
            let on = (self.block, &self.moving);
            self.footing.begin_springs(&self.world, self.settings.step, on);
        }
        ((), self.spring_energy())
    }

    fn resolve_impacts(&mut self) -> bool {
        if self.has_springs() {
            self.begin_impacts();
            return false;
        }
        // contacts are detected anew in every step: the block rotates, and other corners come near
        let pose = self.moving.pose;
        self.footing.detect(&self.world, self.block, &pose, self.block.ball_m);
        self.resolve_impact()
    }

    fn prepare_step(&mut self) -> f64 {
        let speed_factor = self.scars.plough_ahead();
        self.slow(speed_factor);
        let apart_s = self.footing.longest_apart_s(&self.world, (self.block, &self.moving));
        self.scars.longest_s(self.moving.v.norm()).min(apart_s)
    }

    fn step(&mut self, (): &mut (), longest_s: f64) -> Result<(Advance, bool), StepError> {
        let from = self.moving.pose.centre;
        self.footing.press_stems(&self.world, (self.block, &self.moving));
        let (mut done, rejected) = self.advance(longest_s)?;
        self.footing.bend_stems(&self.world, (self.block, &mut self.moving), &mut done.loss);
        self.plough(&from, done.is_free);
        self.is_free = done.is_free;
        // an attitude that is no rotation any more gives NaN here, before it can reach a table
        let spin_rad_s = self.moving.spin(self.block);
        if !self.moving.pose.centre.iter().chain(spin_rad_s.iter()).all(|x| x.is_finite()) {
            return Err(StepError::NotFinite);
        }
        let BlockStepOutcome { dt, loss, slides, unsettled, .. } = done;
        Ok((Advance { dt, loss, steps: 1, rejected, unsettled }, slides))
    }

    fn instant(&self, time_s: f64) -> RockInstant {
        let motion = Motion {
            time_s,
            position_m: self.moving.pose.centre,
            velocity_m_s: self.moving.v,
            spin_rad_s: self.moving.spin(self.block),
        };
        RockInstant { motion, rotation: Some(rotation(self.block, &self.moving)) }
    }

    fn record_step(&mut self, to: RockInstant, slides: bool) -> bool {
        self.recorder.record_step(to, slides);
        self.end_impacts();
        self.is_free
    }

    fn spring_energy(&mut self) -> Loss {
        if self.has_springs() {
            self.footing.springs_j(&self.world, (self.block, &self.moving))
        } else {
            self.footing.clamp.stored(&self.world)
        }
    }

    fn end_contact(&mut self) {
        self.end_springs();
    }
}

impl BlockSimulation<'_> {
    /// Whether contacts have springs.
    fn has_springs(&self) -> bool {
        self.settings.step.scheme.has_springs()
    }

    /// One step of at most `longest_s` (s), and the number of rejected steps.
    fn advance(&mut self, longest_s: f64) -> Result<(BlockStepOutcome, u64), StepError> {
        let (settings, block) = (self.settings.step, self.block);
        if !self.has_springs() {
            let most = (settings.step_s.min(longest_s), settings.corner_way);
            return Ok((self.footing.step(&self.world, block, &mut self.moving, most), 0));
        }
        let on = (block, &mut self.moving);
        self.footing.step_on_springs(&self.world, settings, on, longest_s)
    }

    /// Resolves the impact of the touching contacts, if there is one. Returns whether it has thrown
    /// the block off.
    fn resolve_impact(&mut self) -> bool {
        let (block, now_s) = (self.block, self.recorder.now.time_s);
        // touching contacts whose approach is faster than the capture speed of their ground: one
        // impact, solved together
        let mut struck = std::mem::take(&mut self.footing.selected);
        struck.clear();
        let is_struck = |touch: &&BlockContactPoint| {
            BlockContactState::is_struck(&self.world, (block, &self.moving), touch)
        };
        struck.extend(self.footing.touching(block).filter(is_struck));
        // at most as many rows as impacts can be recorded at a time
        for touch in struck.iter().take(MAX_CONTACTS) {
            // velocity of the contact point, spin included: v + ω × r
            let velocity = self.moving.velocity_at(block, &touch.lever);
            let struck = ImpactPoint {
                point_m: self.moving.pose.centre + touch.lever,
                normal: touch.normal,
                feature: touch.feature.kind,
                triangle: touch.triangle,
                approach_m_s: -touch.normal.dot(&velocity),
            };
            self.recorder.begin_impact(&struck, now_s, &MeshEnergy::default());
        }
        self.enter_soil_at(&struck);
        self.footing.selected = struck;
        let broken = self.break_stems();
        self.footing.press_stems(&self.world, (block, &self.moving));
        let loss = self.footing.strike(&self.world, block, &mut self.moving);
        if loss.is_none() && !broken {
            return false;
        }
        self.recorder.effort.unsettled += u64::from(loss.is_some() && self.footing.unsettled);
        let mut loss = loss.unwrap_or_default();
        self.footing.bend_stems(&self.world, (block, &mut self.moving), &mut loss);
        self.recorder.book_losses(&loss);
        let is_free = !self.footing.stays_in_contact(&self.world, (block, &self.moving), true);
        if is_free {
            let speed_factor = self.scars.leave(&self.world.body, &self.moving.v);
            self.slow(speed_factor);
        }
        let (velocity_m_s, spin_rad_s) = (self.moving.v, self.moving.spin(block));
        self.recorder.rotation = Some(rotation(block, &self.moving));
        self.recorder.record_velocity_jump(Motion {
            velocity_m_s,
            spin_rad_s,
            ..self.recorder.now
        });
        self.recorder.end_all_impacts();
        is_free
    }

    /// Breaks the stems that the current impact overloads; returns whether there was one.
    fn break_stems(&mut self) -> bool {
        let lost = self.footing.break_stems(&self.world, self.block, &mut self.moving);
        self.recorder.book_losses(&lost.unwrap_or_default());
        lost.is_some()
    }

    /// Enters the soil at the contacts that are hit.
    fn enter_soil_at(&mut self, struck: &[BlockContactPoint]) {
        if !self.scars.are_any() {
            return;
        }
        let mut blows = std::mem::take(&mut self.footing.blows);
        blows.clear();
        blows.extend(struck.iter().map(|touch| {
            let of_point_m_s = self.moving.approach_m_s(self.block, touch);
            self.ground_blow((touch.triangle, touch.normal), of_point_m_s)
        }));
        self.enter_soil(&blows);
        self.footing.blows = blows;
    }

    /// The impact on a triangle with this normal, given the approach speed of the contact point
    /// (m/s).
    fn ground_blow(&self, (triangle, normal): (u32, Vec3), of_point_m_s: f64) -> GroundBlow {
        let approach_m_s = -normal.dot(&self.moving.v);
        GroundBlow { ground: self.world.ground_of(triangle), normal, approach_m_s, of_point_m_s }
    }

    /// Enters the soil at these impacts; the depth follows from the approach speed of the centre.
    fn enter_soil(&mut self, blows: &[GroundBlow]) {
        let holding = self.footing.touching(self.block).map(|touch| touch.triangle);
        let in_soil = self.scars.is_in_soil(&self.world, holding);
        let speed_and_soil = (self.moving.v.norm(), in_soil);
        let speed_factor = self.scars.enter(&self.world.body, blows, speed_and_soil);
        self.slow(speed_factor);
    }

    /// Ploughs the soil along the step that began at `from`, and leaves the scar if the block is
    /// free.
    fn plough(&mut self, from: &Vec3, is_free: bool) {
        let contacts =
            self.footing.touching(self.block).map(|touch| (touch.triangle, touch.normal));
        let floor = self.scars.floor(&self.world, contacts);
        let path_length_m = (self.moving.pose.centre - from).norm();
        let velocity_if_free = is_free.then_some(self.moving.v);
        let speed_factor =
            self.scars.plough(&self.world.body, (path_length_m, floor), velocity_if_free);
        self.slow(speed_factor);
    }

    /// Multiplies the velocity of the centre by `speed_factor`; the energy goes to the soil.
    fn slow(&mut self, speed_factor: f64) {
        if speed_factor >= 1.0 {
            return;
        }
        self.moving.v = self.recorder.slow_in_soil(&self.moving.v, speed_factor);
        self.footing.springs.invalidate_rates();
    }

    /// The complete trajectory, with the shape as drawn.
    fn end(mut self, (release, drawn): (&Release, &DrawnShape), stop: Stop) -> Trajectory {
        let start = BlockState::new(
            self.block,
            (release.motion.position_m, drawn.attitude),
            &release.motion,
        );
        self.recorder.effort.sweeps += self.footing.sweeps;
        self.recorder.effort.triangles += self.footing.near.tested;
        let weight_n = self.block.mass_kg * self.settings.gravity_m_s2;
        let energies = (weight_n, start.motion_j(self.block));
        let shape = Some(RockShape::new(drawn));
        Trajectory { shape, ..self.recorder.into_trajectory(release, stop, energies) }
    }
}
