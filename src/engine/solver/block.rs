//! Scheme `rigid` for blocks: impacts are instantaneous, sustained contact is stepped in
//! velocities.
//!
//! A step drifts freely for half of its time (straight translation, torque-free rotation), solves
//! the contacts at the midpoint for one set of impulses, weight included, and drifts for the other
//! half. Each impulse is chosen so that at the end of the step its contact point is back on the
//! surface and, if it sticks, back at the point where it stuck. The target therefore subtracts
//! twice the velocity change that rotation alone has caused since the start of the step, and once
//! the normal velocity at the start. With this target a contact force does no work, a block at rest
//! stays where it is, and pivoting conserves energy to second order. A contact that closes within
//! the step does not rebound from it.
//!
//! An impact is the limit of stiff springs ([`strike`](BlockContactState::strike)).

mod mid_step;
mod energy;
mod facet;
mod detection;
mod rolling;
mod slip;
mod solve;
mod springs;
mod stems;
mod strike;
mod yielding;

use super::environment::ContactEnvironment;
use super::law::capture_m_s;
use super::loss::Loss;
use super::rigid::HELD;
use super::roughness::RoughFacets;
use super::scar::GroundBlow;
use super::slip::Slip;
use super::stem_load::StemLoad;
use crate::body::Block;
use crate::contact::block::{BlockContactPoint, BlockContactPoints, Pose};
use crate::contact::neighbours::Neighbours;
use crate::flight::block::WindowScratch;
use crate::flight::top::{attitude_after, momentum_of, spin_of};
use crate::rock::{Motion, Vec3};
use energy::ContactDirections;
use mid_step::MidStepContact;
use nalgebra::{Matrix3, Rotation3};
use rolling::RollingImpulse;
use slip::slip_m_s;
use solve::{BlockContact, Mass, SWEEPS, rigid_rolling, solve};
pub(crate) use springs::BlockHistory;
use springs::{Clamp, Springs};

/// Contacts with gaps no wider than this touch (–, relative to the radius of the sphere of equal
/// volume).
pub(crate) const TOUCH: f64 = 1e-8;
/// Contacts with gaps up to this take part in a step (–, relative to the balls' radius).
const DETECTION_REACH: f64 = 1.0;
/// A contact slides if its tangential speed exceeds this (–, relative to 1 m/s plus the block's
/// speed).
const SLIDING_SPEED: f64 = 1e-6;
/// Largest rotation of a block in one step (rad), over `corner_way`: the largest travel of a corner
/// in a step relative to the balls' radius.
const TURN_LIMIT: f64 = 0.1;
/// Largest speed at which penetration is recovered (–, relative to the speed `√(g R)` of a fall by
/// half the radius).
const RECOVERY_SPEED: f64 = 0.1;
/// Penetration from which on it is recovered at that speed (–, relative to the radius). Smaller
/// penetrations are recovered in proportion, so that the block approaches the surface ever more
/// slowly. Recovery within one step threw the block up, at the cost of all other motion, and it
/// fell back: a block that rolls on two corners rocked without end.
const RECOVERY_DEPTH: f64 = 0.01;
/// An approach slower than this is rounding (m/s).
const NO_APPROACH_M_S: f64 = 1e-9;
/// A relative gain of energy up to this is rounding (–); it is removed from the motion all the
/// same.
const ROUNDING: f64 = 1e-12;
/// Relative rounding error of velocities (–).
const ROUNDING_OF_SPEED: f64 = 1e-14;

/// Pose, velocity and angular momentum of a block in contact.
#[derive(Debug, Clone)]
pub(crate) struct BlockState {
    pub(crate) pose: Pose,
    pub(crate) v: Vec3,
    /// Angular momentum in the world's frame (kg m²/s).
    pub(crate) momentum: Vec3,
}

/// Contacts of one block and the work space of their solver.
#[derive(Debug, Default)]
pub(crate) struct BlockContactState {
    pub(crate) near: Neighbours,
    pub(crate) touches: BlockContactPoints,
    /// Pose and reach (m) of the last contact detection, as long as its contacts are valid.
    last_detection: Option<(Pose, f64)>,
    /// Work space of the search for the end of a flight.
    pub(crate) window: WindowScratch,
    contacts: Vec<BlockContact>,
    /// Impulse of rolling friction that these contacts bear together.
    rolling: RollingImpulse,
    /// Contacts of an impact, and the rebound speed that each is to reach (m/s).
    targets: Vec<(BlockContact, f64)>,
    /// Contact points selected for the current solve.
    pub(crate) selected: Vec<BlockContactPoint>,
    /// Impacts on grounds at one instant, and the contacts on springs that begin with them, by
    /// their histories.
    pub(crate) blows: Vec<GroundBlow>,
    pub(crate) begun: Vec<usize>,
    /// Springs of the contacts, in the schemes that have them, and the history of each contact of
    /// the last detection.
    pub(crate) springs: Springs,
    history_of_touch: Vec<Option<usize>>,
    /// Contacts that an impact has left pressed together.
    pub(crate) clamp: Clamp,
    /// Facets of rough ground that it meets.
    pub(crate) facets: RoughFacets,
    /// Slip distance so far.
    pub(crate) slip: Slip,
    /// Energy that stems have absorbed.
    pub(crate) stem_load: StemLoad,
    /// Sweeps over the contacts, counted.
    pub(crate) sweeps: u64,
    /// Whether the impulses of the last solve did not converge.
    pub(crate) unsettled: bool,
}

/// Result of one step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BlockStepOutcome {
    /// Length of the step (s).
    pub(crate) dt: f64,
    pub(crate) loss: Loss,
    /// Whether a contact slides.
    pub(crate) slides: bool,
    /// Whether no contact holds the block any more.
    pub(crate) is_free: bool,
    /// Whether the impulses did not converge.
    pub(crate) unsettled: bool,
}

impl BlockState {
    /// A block at this centre (m) and attitude, with the velocity and spin of `motion`.
    pub(crate) fn new(
        block: &Block,
        (centre, attitude): (Vec3, Rotation3<f64>),
        motion: &Motion,
    ) -> Self {
        let momentum = momentum_of(block.inertia_kg_m2, &attitude, &motion.spin_rad_s);
        Self { pose: Pose { centre, attitude }, v: motion.velocity_m_s, momentum }
    }

    pub(crate) fn spin(&self, block: &Block) -> Vec3 {
        spin_of(block.inertia_kg_m2, &self.pose.attitude, &self.momentum)
    }

    /// Kinetic energy (J).
    pub(crate) fn motion_j(&self, block: &Block) -> f64 {
        0.5 * (block.mass_kg * self.v.norm_squared() + self.spin(block).dot(&self.momentum))
    }

    fn mass(&self, block: &Block) -> Mass {
        let turned = self.pose.attitude.matrix();
        let own = Matrix3::from_diagonal(&Vec3::from(block.inertia_kg_m2.map(|i| 1.0 / i)));
        Mass { mass: block.mass_kg, inverse: turned * own * turned.transpose() }
    }

    /// Moves freely, without any force, for `t` (s).
    fn drift(&mut self, block: &Block, t: f64) {
        let turned = attitude_after(block.inertia_kg_m2, self.pose.attitude, &self.momentum, t);
        self.pose.centre += self.v * t;
        self.pose.attitude = orthonormal(&turned);
    }

    /// Adds the impulses of the contacts and of rolling friction.
    fn apply_impulses(
        &mut self,
        contacts: &[BlockContact],
        rolling: &RollingImpulse,
        mass_kg: f64,
    ) {
        for contact in contacts {
            self.v += contact.impulse / mass_kg;
            self.momentum += contact.lever.cross(&contact.impulse);
        }
        if rolling.is_on() {
            self.momentum += rolling.impulse;
        }
    }

    /// The contact that the block approaches fastest.
    pub(crate) fn fastest<'t>(
        &self,
        block: &Block,
        touches: impl Iterator<Item = &'t BlockContactPoint>,
    ) -> Option<&'t BlockContactPoint> {
        let approach = |touch: &&BlockContactPoint| self.approach_m_s(block, touch);
        touches.max_by(|one, other| approach(one).total_cmp(&approach(other)))
    }

    /// Speed of a contact towards the mesh (m/s).
    pub(crate) fn approach_m_s(&self, block: &Block, touch: &BlockContactPoint) -> f64 {
        -touch.normal.dot(&self.velocity_at(block, &touch.lever))
    }

    /// Velocity of a point of the block (m/s).
    pub(crate) fn velocity_at(&self, block: &Block, lever: &Vec3) -> Vec3 {
        Mass::velocity_at(lever, (&self.v, &self.spin(block)))
    }
}

/// Re-orthonormalises a rotation that is multiplied again and again.
fn orthonormal(turned: &Rotation3<f64>) -> Rotation3<f64> {
    let m = turned.matrix();
    let x = m.column(0).normalize();
    let y = m.column(1) - x * x.dot(&m.column(1));
    let y = y.normalize();
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]))
}

impl BlockContactState {
    /// Contacts of the last detection that touch: those that support the block and those of an
    /// impact.
    pub(crate) fn touching(&self, block: &Block) -> impl Iterator<Item = &BlockContactPoint> {
        let most = TOUCH * block.radius_m;
        let touches =
            move |touch: &&BlockContactPoint| touch.gap_m <= most || self.clamp.contains(touch);
        self.touches.found.iter().filter(touches)
    }

    /// One step of sustained contact of at most `most_s`, in which no corner moves further than
    /// `corner_way` times the radius of its ball.
    pub(crate) fn step(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        state: &mut BlockState,
        (most_s, corner_way): (f64, f64),
    ) -> BlockStepOutcome {
        let spin = state.spin(block);
        let fastest = state.v.norm() + spin.norm() * block.bound_m;
        let way_m = self.step_travel_m((block, state), corner_way, fastest);
        let dt = most_s
            .min(way_m / fastest.max(f64::MIN_POSITIVE))
            .min(TURN_LIMIT * corner_way / spin.norm().max(f64::MIN_POSITIVE));
        let (start, before_j) = (state.clone(), state.motion_j(block));
        let dt = dt.min(state.climb_limit_s(block, &world.body.gravity, before_j));
        let dt = self.drift_to_middle(world, block, (&start, state), dt);
        let (mass, weight) = (state.mass(block), world.body.gravity * dt);
        let (v, w) = (state.v, state.spin(block));
        self.contacts.clear();
        let recovery =
            (RECOVERY_DEPTH * block.radius_m, RECOVERY_SPEED * world.body.fall_speed_m_s());
        let mid_step =
            |touch: &BlockContactPoint| MidStepContact::of(block, [&start, state], touch, dt);
        // an impact that is stopped within the step would not rebound
        self.select(|touch| !mid_step(touch).strikes(world, block, touch));
        for touch in &self.selected {
            let goal = mid_step(touch).goal(touch, dt, recovery);
            let ahead_m = 0.5 * dt * slip_m_s(block, &start, (&touch.normal, &touch.lever));
            self.contacts.push(self.contact(world, (&mass, touch), ahead_m, goal));
        }
        // a target velocity is a gap over the step's length, and a gap is known no better than
        // positions are
        let rounding_m_s =
            f64::EPSILON * state.pose.centre.amax() / dt + ROUNDING_OF_SPEED * v.norm();
        let free = (v + weight, w);
        self.rolling = rigid_rolling(&self.contacts);
        let unknowns = (&mut self.contacts[..], &mut self.rolling);
        self.unsettled = !solve(&mass, unknowns, free, (rounding_m_s, SWEEPS), &mut self.sweeps);
        state.v += weight;
        let free_motion = state.clone();
        state.apply_impulses(&self.contacts, &self.rolling, block.mass_kg);
        // the displacement of the step is that of the mean velocity, so this is exactly the work of
        // the weight
        let weight_j = 0.5 * block.mass_kg * weight.dot(&(v + state.v));
        let lost_j = before_j + weight_j - state.motion_j(block);
        let after = (&state.v, &state.spin(block));
        let loss = self.loss_of_impulses(world, [(&v, &w), after], lost_j);
        let along = ContactDirections::of_impulses(&self.contacts, &self.rolling);
        state.limit_energy_gain(block, (&free_motion, &weight), &along);
        let pushed = self.clamp.is_on() || self.contacts.iter().any(BlockContact::pushes);
        let [slip_before, slip_after] = [&start, state].map(|at| self.pushed_slip_m_s(block, at));
        let on = self.contacts.iter().find(|contact| contact.pushes());
        let on = on.map(|contact| world.ground_of(contact.triangle));
        self.slip.grow(0.5 * dt * (slip_before + slip_after), on);
        let slides = slip_after > SLIDING_SPEED * (1.0 + state.v.norm());
        state.drift(block, 0.5 * dt);
        self.detect(world, block, &state.pose, DETECTION_REACH * block.ball_m);
        let is_free = !self.stays_in_contact(world, (block, state), pushed);
        BlockStepOutcome { dt, loss, slides, is_free, unsettled: self.unsettled }
    }

    /// The contact at a contact point, where the block will have slipped `ahead_m` (m) further.
    fn contact(
        &self,
        world: &ContactEnvironment,
        (mass, touch): (&Mass, &BlockContactPoint),
        ahead_m: f64,
        goal: Vec3,
    ) -> BlockContact {
        let law = world.law(touch.triangle);
        let friction = self.slip.friction(world.ground_of(touch.triangle), law, ahead_m);
        BlockContact::new(mass, (touch.normal, touch.lever), (friction, touch.triangle), goal)
            .rolling(law.limits())
            .clamped(self.clamp.contains(touch))
    }

    /// Whether a contact still supports the block: it is near, and it separates no faster than the
    /// capture speed of its ground.
    pub(crate) fn stays_in_contact(
        &self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
        pushed: bool,
    ) -> bool {
        self.clamp.is_on()
            || self.touches.found.iter().any(|touch| {
                let up = touch.normal.dot(&state.velocity_at(block, &touch.lever));
                touch.gap_m <= HELD * block.radius_m
                    && up < capture_m_s(world.law(touch.triangle))
                    && (pushed || up <= 0.0)
            })
    }
}

#[cfg(test)]
mod tests;
