//! The fall of a block: tumble, touch, step, stop.
//!
//! A block is a convex core with rounded corners. In flight it turns as a free rigid body (Euler's equations, solved
//! by [`Top`]) while its centre follows a parabola; the first touch is found by conservative advancement, since no
//! closed form exists for a tumbling body. In contact a scheme with springs follows every impact in its time; in the rigid limit
//! velocities are stepped with impulses that keep the bodies apart under Coulomb's law (Moreau 1988).

mod impacts;

use super::driver::{Falling, follow};
use super::form::{Form, RockInstant, Turned};
use super::impacts::MeshEnergy;
use super::recorder::{Keep, Recorder};
use super::settings::RunSettings;
use super::{ShapeOf, Stop, Trajectory};
use crate::body::Block;
use crate::contact::MOST;
use crate::contact::block::BlockTouch;
use crate::flight::Parabola;
use crate::flight::block::{Tumble, first_touch};
use crate::flight::top::Top;
use crate::ground::Law;
use crate::random::RandomStream;
use crate::release::{DrawnShape, Release};
use crate::rock::{Motion, Vec3};
use crate::solver::block::{BlockContactState, BlockState, BlockStepOutcome};
use crate::solver::body::Body;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::roughness::RoughFacets;
use crate::solver::scar::{GroundBlow, Scars};
use crate::solver::step_control::{Advance, StepError};
use crate::solver::struck::Struck;

/// One block on its way.
struct Roll<'a> {
    /// Scheme, terrain, recorders and limits.
    settings: &'a RunSettings<'a>,
    /// Terrain, mass and laws as the contact solver wants them.
    world: ContactEnvironment<'a>,
    /// Its shape, mass and moments of inertia.
    block: &'a Block,
    /// Contacts found at the last look, with the work space of the solver.
    footing: &'a mut BlockContactState,
    /// What it has dug into soil.
    scars: &'a mut Scars,
    /// Pose, velocity and angular momentum. Momentum, not spin, is kept: it is constant in flight while the spin
    /// turns.
    moving: BlockState,
    /// What is written down of its way.
    recorder: Recorder<'a>,
    /// Whether nothing held it at the end of its last step.
    is_free: bool,
}

/// Follows one block from its release to its stop; `laws` are those of the grounds for it.
pub(super) fn follow_block(
    settings: &RunSettings,
    (release, drawn): (&Release, &DrawnShape),
    keep: Keep,
    (laws, random): (&[Law], RandomStream),
    (footing, scars): (&mut BlockContactState, &mut Scars),
) -> Trajectory {
    let block = &drawn.block;
    let world = settings.around(Body::of_block(block, settings.gravity_m_s2), laws);
    footing.forget();
    footing.stem_load.raise(settings.terrain, &random, &mut footing.near.gone);
    (footing.near.tested, footing.sweeps) = (0, 0);
    footing.facets = RoughFacets::of(random, laws);
    footing.slip.begin(&release.grounds);
    let moving =
        BlockState::new(block, (release.motion.position_m, drawn.attitude), &release.motion);
    let form = Form { rock: release.rock, block: Some(block) };
    let turned = turned(block, &moving);
    let start = (release.motion, Some(turned));
    let recorder = Recorder::new(settings.terrain, form, start, (keep, settings.recorders));
    let mut roll = Roll { settings, world, block, footing, scars, moving, recorder, is_free: true };
    let stop = follow(&mut roll, false);
    roll.end((release, drawn), stop)
}

/// Attitude and rotational energy `ω·L/2` (J) for the record.
fn turned(block: &Block, moving: &BlockState) -> Turned {
    let rotational_j = 0.5 * moving.spin(block).dot(&moving.momentum);
    Turned { attitude: moving.pose.attitude, rotational_j }
}

impl<'a> Falling<'a> for Roll<'a> {
    /// Springs are kept with the contacts.
    type Stepping = ();

    fn settings(&self) -> &'a RunSettings<'a> {
        self.settings
    }

    fn recorder(&mut self) -> &mut Recorder<'a> {
        &mut self.recorder
    }

    /// The ball around the block: what it does not touch, the block does not touch; and a corner must not move either where it rests.
    fn ball(&self) -> (Vec3, f64) {
        (self.moving.pose.centre, self.block.bound_m)
    }

    fn total_j(&self) -> f64 {
        let weight: Vec3 = self.world.body.gravity * self.block.mass_kg;
        self.moving.motion_j(self.block) - weight.dot(&self.moving.pose.centre)
    }

    fn fly(&mut self) -> Option<Stop> {
        let time_s = self.recorder.now.time_s;
        let block = self.block;
        let path = Parabola::of(&self.recorder.now, self.settings.gravity_m_s2, block.bound_m);
        let top = Top::new(block.inertia_kg_m2, self.moving.pose.attitude, self.moving.momentum);
        let left = self.settings.longest_s - time_s;
        let tumble = Tumble { block, top, path };
        let scratch = (&mut self.footing.near, &mut self.footing.window);
        let landing = first_touch(self.settings.terrain, &tumble, left, scratch);
        self.recorder.effort.leaps += 1;
        let (dt, stop) = self.settings.end_of_flight(&landing, time_s, &self.recorder.effort);
        self.recorder.fly(&path, Some(&tumble.top), dt);
        self.footing.slip.fly(dt);
        let kept = self.scars.fly(&self.world.body, &self.recorder.now.velocity_m_s, dt);
        self.recorder.slow_in_flight(kept);
        self.moving.pose = tumble.pose(dt);
        self.moving.v = self.recorder.now.velocity_m_s;
        stop
    }

    fn begin(&mut self) -> ((), Loss) {
        ((), self.begin_contact())
    }

    fn meet(&mut self) -> bool {
        if self.has_springs() {
            self.begin_impacts();
            return false;
        }
        // contacts are looked for anew in every step: the block turns, and other corners come near
        let pose = self.moving.pose;
        self.footing.detect(&self.world, self.block, &pose, self.block.ball_m);
        self.strike()
    }

    fn longest_s(&mut self) -> f64 {
        let kept = self.scars.plough_ahead();
        self.slow(kept);
        let apart_s = self.footing.longest_apart_s(&self.world, (self.block, &self.moving));
        self.scars.longest_s(self.moving.v.norm()).min(apart_s)
    }

    fn step(&mut self, (): &mut (), most_s: f64) -> Result<(Advance, bool), StepError> {
        let from = self.moving.pose.centre;
        self.footing.press_stems(&self.world, (self.block, &self.moving));
        let (mut done, rejected) = self.advance(most_s)?;
        self.footing.bend_stems(&self.world, (self.block, &mut self.moving), &mut done.loss);
        self.plough(&from, done.is_free);
        self.is_free = done.is_free;
        // an attitude that is no longer a rotation shows as NaN here, before it can reach a table
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
        RockInstant { motion, turned: Some(turned(self.block, &self.moving)) }
    }

    fn note(&mut self, to: RockInstant, slides: bool) -> bool {
        self.recorder.step(to, slides);
        self.leave_impacts();
        self.is_free
    }

    fn stored(&mut self) -> Loss {
        self.held()
    }

    fn leave(&mut self) {
        self.end_contact();
    }
}

impl Roll<'_> {
    /// Whether contacts have springs.
    fn has_springs(&self) -> bool {
        self.settings.step.scheme.has_springs()
    }

    /// One step of at most `most_s` (s), and how many were thrown away.
    fn advance(&mut self, most_s: f64) -> Result<(BlockStepOutcome, u64), StepError> {
        let (settings, block) = (self.settings.step, self.block);
        if !self.has_springs() {
            let most = (settings.step_s.min(most_s), settings.corner_way);
            return Ok((self.footing.step(&self.world, block, &mut self.moving, most), 0));
        }
        let on = (block, &mut self.moving);
        self.footing.step_on_springs(&self.world, settings, on, most_s)
    }

    /// Resolves the impact of the contacts that touch, if there is one; whether it has thrown the block off.
    fn strike(&mut self) -> bool {
        let (block, now_s) = (self.block, self.recorder.now.time_s);
        // touching contacts that approach faster than their ground captures: one impact, resolved together
        let mut struck = std::mem::take(&mut self.footing.selected);
        struck.clear();
        let is_struck = |touch: &&BlockTouch| {
            BlockContactState::is_struck(&self.world, (block, &self.moving), touch)
        };
        struck.extend(self.footing.touching(block).filter(is_struck));
        // as many have a row as there is room for at a time
        for touch in struck.iter().take(MOST) {
            // of the touching point, spin included: v + ω × r
            let velocity = self.moving.velocity_at(block, &touch.lever);
            let struck = Struck {
                point_m: self.moving.pose.centre + touch.lever,
                normal: touch.normal,
                feature: touch.feature.kind,
                triangle: touch.triangle,
                approach_m_s: -touch.normal.dot(&velocity),
            };
            self.recorder.begin_impact(&struck, now_s, &MeshEnergy::default());
        }
        self.dig_where(&struck);
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
        self.recorder.pay(&loss);
        let is_free = !self.footing.stays_in_contact(&self.world, (block, &self.moving), true);
        if is_free {
            let kept = self.scars.leave(&self.world.body, &self.moving.v);
            self.slow(kept);
        }
        let (velocity_m_s, spin_rad_s) = (self.moving.v, self.moving.spin(block));
        self.recorder.turned = Some(turned(block, &self.moving));
        self.recorder.go_on_with(Motion { velocity_m_s, spin_rad_s, ..self.recorder.now });
        self.recorder.end_all_impacts();
        is_free
    }

    /// Breaks the stems that cannot take the current blow; whether one could not.
    fn break_stems(&mut self) -> bool {
        let lost = self.footing.break_stems(&self.world, self.block, &mut self.moving);
        self.recorder.pay(&lost.unwrap_or_default());
        lost.is_some()
    }

    /// Digs into the soil of what is struck.
    fn dig_where(&mut self, struck: &[BlockTouch]) {
        if !self.scars.are_any() {
            return;
        }
        let mut blows = std::mem::take(&mut self.footing.blows);
        blows.clear();
        blows.extend(struck.iter().map(|touch| {
            let of_point_m_s = self.moving.approach_m_s(self.block, touch);
            self.blow_on((touch.triangle, touch.normal), of_point_m_s)
        }));
        self.dig(&blows);
        self.footing.blows = blows;
    }

    /// What strikes a triangle with a normal, with this approach of the point that touches (m/s).
    fn blow_on(&self, (triangle, normal): (u32, Vec3), of_point_m_s: f64) -> GroundBlow {
        let approach_m_s = -normal.dot(&self.moving.v);
        GroundBlow { ground: self.world.ground_of(triangle), normal, approach_m_s, of_point_m_s }
    }

    /// Digs into the soil of the blows, as fast as the centre comes to it.
    fn dig(&mut self, blows: &[GroundBlow]) {
        let holding = self.footing.touching(self.block).map(|touch| touch.triangle);
        let in_soil = self.scars.is_in_soil(&self.world, holding);
        let how = (self.moving.v.norm(), in_soil);
        let kept = self.scars.enter(&self.world.body, blows, how);
        self.slow(kept);
    }

    /// Ploughs on from where the step began, and leaves the scar if it is free.
    fn plough(&mut self, from: &Vec3, is_free: bool) {
        let contacts =
            self.footing.touching(self.block).map(|touch| (touch.triangle, touch.normal));
        let floor = self.scars.floor(&self.world, contacts);
        let way_m = (self.moving.pose.centre - from).norm();
        let ends = is_free.then_some(self.moving.v);
        let kept = self.scars.plough(&self.world.body, (way_m, floor), ends);
        self.slow(kept);
    }

    /// Takes a share of the speed of the centre; the soil has it.
    fn slow(&mut self, kept: f64) {
        if kept >= 1.0 {
            return;
        }
        self.moving.v = self.recorder.slowed_in_soil(&self.moving.v, kept);
        self.footing.springs.invalidate_rates();
    }

    /// The journey, complete, with the shape as it was drawn.
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
        let shape = Some(ShapeOf::new(drawn));
        Trajectory { shape, ..self.recorder.into_trajectory(release, stop, energies) }
    }
}
