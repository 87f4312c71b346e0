//! Schemes with springs for blocks: `adaptive`, `reference` and `dda`.
//!
//! The unknowns are the body's six. With the lever `a` of a contact, `V_N = [nᵀ, (a×n)ᵀ]` takes the
//! place of the paper's `V_N = (V, 0)`, and everything else of the paper stays. The state is
//! centre, attitude, velocity and **angular momentum** in the frame of the terrain: `ℓ' = Σ a × f`,
//! `ω = I⁻¹ℓ`, so that no gyroscopic term has to be stepped and free spin conserves its momentum
//! exactly.
//!
//! A spring and a dashpot over an implicit stage, in which an impulse acts for `a` and the block
//! moves for `b` (s), are a contact of the rigid limit with a compliance ([`SpringCompliance`]):
//! from `F = p (pen − b u_n) − c u_n` and `P = a F`
//!
//! ```text
//! u_n + P_n/(a (p b + c)) = p pen/(p b + c)
//! ```
//!
//! and the same along the surface with `p_s`, `c_s` and the stretch `−ξ`. So all schemes share one
//! contact solver ([`solve`](super::solve::solve)), and `rigid` is its limit for stiff springs.

mod clamp;
mod controlled;
mod dda;
mod explicit;
mod frozen;
mod history;
mod impact_energy;
mod rolling;
mod rotation_vector;
mod onset;
mod stage;

use super::energy::ContactDirections;
use super::solve::{BlockContact, Mass, SpringCompliance};
use super::{BlockContactState, BlockState, BlockStepOutcome, TOUCH};
use crate::body::Block;
use crate::ground::{Law, SliderForce};
use crate::rock::Vec3;
use crate::solver::Settings;
use crate::solver::dda::DEEPEST;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::step_control::{Control, StepError};
use crate::solver::tableau::STAGES;
pub(crate) use clamp::Clamp;
pub(crate) use history::BlockHistory;
use impact_energy::ImpactEnergy;
use rolling::RollingSpring;

/// Contacts with gaps up to this multiple of the travel of a stage take part in it (–).
const STAGE_REACH: f64 = 2.0;

/// Rates of change of a block in contact.
#[derive(Debug, Clone, Default)]
struct BlockRates {
    /// Of the centre (m/s), and of its velocity (m/s²).
    centre: Vec3,
    v: Vec3,
    /// Of the rotation vector from the step's start (rad/s), and of the angular momentum (N m).
    turned: Vec3,
    momentum: Vec3,
    /// Of the shear springs (m/s), one for each history.
    shear: Vec<Vec3>,
    /// Of the rolling spring (rad/s).
    rolled: Vec3,
    /// Power into contacts (W).
    loss: Loss,
}

/// A contact within a stage.
#[derive(Debug, Clone, Copy)]
struct SpringContact {
    /// Index of its history.
    history: usize,
    /// Its law, with its share of a patch and the current friction.
    law: Law,
    /// Whether it closed too slowly to rebound.
    captured: bool,
    /// Whether it exerts no force for now: it began within this step, which is cut where it begins,
    /// or it is open.
    is_suspended: bool,
    /// Triangle whose ground answers.
    triangle: u32,
    /// Unit normal from the mesh to the block, and lever (m).
    n: Vec3,
    lever: Vec3,
    /// Penetration at which its spring begins to act (m).
    offset_m: f64,
    /// Penetration (m) and stretch of the shear spring (m) at the stage's base.
    penetration: f64,
    shear: Vec3,
    /// Normal force, ≥ 0, and shear force; the block feels the opposite of the latter (N).
    normal_force: f64,
    shear_force: Vec3,
}

/// Springs of the contacts of one block.
#[derive(Debug, Default)]
pub(crate) struct Springs {
    pub(crate) histories: Vec<BlockHistory>,
    contacts: Vec<SpringContact>,
    /// The contacts solved before further ones began.
    solved: Vec<SpringContact>,
    /// The spring of rolling friction.
    rolling: RollingSpring,
    /// Number of histories at the step's start, and whether impacts that begin after it are
    /// suspended until a step starts with them.
    known: usize,
    suspends_new: bool,
    rates: [BlockRates; STAGES],
    /// Whether the first rates belong to the present state.
    has_current_rates: bool,
    /// Whether the last detection was at the present pose.
    touches_are_current: bool,
    /// Slip speed at the step's start (m/s), and the slip distance up to the time at which friction
    /// is evaluated (m).
    slip_m_s: f64,
    ahead_m: f64,
    /// Energy in the springs at the present state (J).
    stored_j: f64,
    /// Energy that steps of `dda` have gained and that the motion has not yet paid for (J).
    debt_j: f64,
    /// The step to try next (s).
    h: f64,
    /// Fastest approach of the current impacts (m/s); 0 if there are none.
    impact_m_s: f64,
    /// Energy account of the current impact.
    energy: Option<ImpactEnergy>,
    /// Latest end of the current impacts (s).
    pub(crate) until_s: f64,
    control: Option<Control>,
}

impl Springs {
    /// Invalidates the rates: the motion has been changed from outside.
    pub(crate) fn invalidate_rates(&mut self) {
        self.has_current_rates = false;
    }

    /// Invalidates the contacts of the last detection.
    pub(crate) fn invalidate_touches(&mut self) {
        self.touches_are_current = false;
    }

    /// Whether no contact presses on the block.
    pub(crate) fn is_free(&self) -> bool {
        self.histories.iter().all(|history| !history.closed)
    }

    /// Largest contact frequency (rad/s).
    pub(super) fn stiffest(&self, world: &ContactEnvironment) -> f64 {
        let of = |laws: &mut dyn Iterator<Item = f64>| laws.fold(0.0, f64::max);
        let known = of(&mut self.histories.iter().map(|history| history.law.omega_rad_s()));
        if known > 0.0 { known } else { of(&mut world.laws.iter().map(Law::omega_rad_s)) }
    }

    /// Ends the impacts whose time is up at `now_s` (s): contacts that still press become lasting
    /// contacts and are damped as such.
    pub(crate) fn capture(&mut self, now_s: f64) {
        if now_s >= self.until_s {
            self.histories.iter_mut().for_each(|history| history.captured |= history.announced);
        }
    }

    /// Smallest contact frequency (rad/s): an impact is over after some of its periods.
    pub(crate) fn slowest(&self) -> f64 {
        self.histories.iter().map(|history| history.law.omega_rad_s()).fold(f64::INFINITY, f64::min)
    }

    /// Stretch of the shear spring of each contact of the last stage (m).
    #[cfg(test)]
    pub(super) fn stretches_m(&self) -> impl Iterator<Item = f64> {
        self.contacts.iter().map(|contact| contact.shear.norm())
    }

    /// The directions in which the contacts of the last stage act.
    fn acting_along(&self) -> ContactDirections {
        ContactDirections::default().and_springs(&self.contacts)
    }

    /// Energy in the springs of the contacts as they were placed (J), by kind.
    fn stored_by_contacts(&self, world: &ContactEnvironment) -> Loss {
        let mut placed = Loss { rolling: self.rolling.stored_j(), ..Loss::default() };
        for contact in &self.contacts {
            let damping = contact.stored_j(contact.penetration, &contact.shear);
            placed.add(&Loss { damping, ..Loss::default() }.on(world, contact.triangle), 1.0);
        }
        placed
    }

    /// Updates the fastest approach of the current impacts.
    fn update_impact_speed(&mut self) {
        self.impact_m_s = self.fastest_m_s().map_or(0.0, |own| own.max(self.impact_m_s));
    }

    /// Energy in the springs (J), by the histories.
    pub(crate) fn held_j(&self) -> f64 {
        self.held_on_j(|_| true) + self.rolling.stored_j()
    }

    /// Energy in the springs of the contacts on some triangles (J).
    pub(crate) fn held_on_j(&self, is_on: impl Fn(u32) -> bool) -> f64 {
        let holds = |history: &&BlockHistory| history.closed && is_on(history.triangle);
        self.histories.iter().filter(holds).map(BlockHistory::held_j).sum()
    }
}

impl ContactDirections {
    /// Adds the directions in which these contacts act.
    fn and_springs(mut self, contacts: &[SpringContact]) -> Self {
        for contact in contacts {
            self.add(&contact.n, contact.law.limits().caps(1.0) != (0.0, 0.0));
        }
        self
    }
}

impl SpringContact {
    /// Its contact for a stage in which impulses act for `a` and the block moves for `b` (s).
    fn stage_compliance(&self, mass: &Mass, (a, b): (f64, f64)) -> BlockContact {
        let stage = self.law.stage_compliance(self.captured, (a, b));
        let goal = self.n * (stage.normal_recovery_per_s * self.penetration)
            - self.shear * stage.shear_recovery_per_s;
        let springs =
            SpringCompliance { compliance: stage.compliance, surface_m_s: self.penetration / b };
        let slides = (self.law.friction_coefficient(), self.triangle);
        BlockContact::on_springs(mass, (self.n, self.lever), slides, (goal, springs))
            .rolling(self.law.limits())
    }

    /// Sets the forces from an impulse that has acted for `a` (s).
    fn set_forces(&mut self, impulse: &Vec3, a: f64) {
        self.normal_force = self.n.dot(impulse) / a;
        self.shear_force = (self.n * self.n.dot(impulse) - impulse) / a;
    }

    /// Sets the forces at the velocity `u` (m/s) of its point; returns the normal force without the
    /// limit to compression (N), and shear.
    fn update_forces(&mut self, u: &Vec3) -> (f64, SliderForce) {
        let (up, element) = (self.n.dot(u), &self.law.shear);
        let normal = self.law.normal(self.captured);
        let pulls = normal.bilateral_force(self.penetration.max(0.0), up);
        self.normal_force = pulls.max(0.0);
        let cap = element.cap(self.normal_force);
        let shear = element.at_rate(self.shear, u - self.n * up, cap);
        self.shear_force = shear.force;
        (pulls, shear)
    }

    /// Energy in its springs at a penetration and a stretch (J, m): none if it does not press.
    fn stored_j(&self, penetration: f64, shear: &Vec3) -> f64 {
        let shear2 = if penetration > 0.0 { shear.norm_squared() } else { 0.0 };
        self.law.stored_j(penetration.max(0.0), shear2, 0.0)
    }

    /// Energy in its normal spring at a penetration (J).
    fn normal_j(&self, penetration: f64) -> f64 {
        self.law.stored_j(penetration.max(0.0), 0.0, 0.0)
    }

    /// Penetration (m) after a motion of the contact point at `u` (m/s) for `b` (s).
    fn penetration_after(&self, u: &Vec3, b: f64) -> f64 {
        self.penetration - b * self.n.dot(u)
    }

    /// Stretch of the shear spring (m) after a motion for `b` (s).
    fn stretch(&self, b: f64) -> Vec3 {
        self.law.shear.stretch_after(&self.shear_force, &self.shear, b)
    }

    /// Power into it (W) at a velocity `u` of the contact point (m/s), including the power that its
    /// springs store.
    fn power(&self, world: &ContactEnvironment, u: &Vec3, shear_rate: &Vec3) -> Loss {
        let pushes = -self.normal_force * self.n.dot(u);
        self.shear_power(u, shear_rate, pushes).on(world, self.triangle)
    }

    /// The same, with the given power into its normal element (W).
    fn shear_power(&self, u: &Vec3, shear_rate: &Vec3, normal_w: f64) -> Loss {
        let slip = u - self.n * self.n.dot(u);
        Loss::of_slip((&self.shear_force, &slip, shear_rate), [normal_w, 0.0])
    }
}

impl BlockContactState {
    /// Begins an episode of contact of a block that has just touched.
    pub(crate) fn begin_springs(
        &mut self,
        world: &ContactEnvironment,
        settings: &Settings,
        (block, state): (&Block, &BlockState),
    ) {
        self.springs.histories.clear();
        self.springs.rolling = RollingSpring::default();
        self.touches.active.clear();
        (self.springs.impact_m_s, self.springs.energy, self.springs.until_s) = (0.0, None, 0.0);
        self.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
        self.springs.known = 0;
        self.update_histories(world, (block, state));
        for (touch, history) in self.touches.found.iter().zip(&self.history_of_touch) {
            let offset_m = if block.core.is_corner(touch.part) { 0.0 } else { -touch.gap_m };
            let Some(k) = *history else { continue };
            self.springs.histories[k].offset_m = offset_m.max(0.0);
        }
        (self.springs.stored_j, self.springs.debt_j) = (self.stored(world).sum(), 0.0);
        let control =
            settings.scheme.tableau().map(|tableau| Control::new(tableau, settings, world));
        self.springs.control = control;
        self.springs.h = self.first_step_s(world);
        self.springs.invalidate_rates();
        self.springs.touches_are_current = true;
    }

    /// Energy in the springs of the contacts of the last detection (J), by kind.
    fn stored(&self, world: &ContactEnvironment) -> Loss {
        let mut stored = Loss::default();
        for history in &self.springs.histories {
            let touch = self.touches.found.iter().find(|touch| history.is_of(touch));
            let Some(touch) = touch.filter(|touch| touch.gap_m < -history.offset_m) else {
                continue;
            };
            let law = history.law.of_patch(touch.gain2, 1.0);
            let penetration = -touch.gap_m - history.offset_m;
            let damping = law.stored_j(penetration, history.shear.norm_squared(), 0.0);
            stored.add(&Loss { damping, ..Loss::default() }.on(world, history.triangle), 1.0);
        }
        stored.rolling += self.springs.rolling.stored_j();
        stored
    }

    /// Energy in the springs at a pose (J), by kind.
    pub(crate) fn springs_j(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) -> Loss {
        self.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
        self.stored(world)
    }

    /// One step of at most `most_s`, and the number of rejected trial steps.
    ///
    /// # Errors
    /// [`StepError`] if no step, however short, converges, or a penetration is too large.
    pub(crate) fn step_on_springs(
        &mut self,
        world: &ContactEnvironment,
        settings: &Settings,
        (block, state): (&Block, &mut BlockState),
        most_s: f64,
    ) -> Result<(BlockStepOutcome, u64), StepError> {
        let slip_m_s = self.slip_m_s(block, state);
        (self.springs.slip_m_s, self.springs.ahead_m) = (slip_m_s, 0.0);
        let (done, rejected) = match self.springs.control {
            Some(control) => {
                let limit = Self::travel_limit_s(world, (block, state), settings.corner_way);
                self.controlled_step(world, (block, state), (control, most_s, limit))?
            }
            None => (self.fixed_step(world, settings, (block, state), most_s)?, 0),
        };
        let slipped_m = 0.5 * done.dt * (slip_m_s + self.slip_m_s(block, state));
        let on = self.touching(block).next().map(|touch| world.ground_of(touch.triangle));
        self.slip.grow(slipped_m, on);
        if done.is_free {
            self.springs.rolling = RollingSpring::default();
        }
        Ok((done, rejected))
    }

    /// Gap (m) up to which a block can touch something within a stage of `way_s`.
    fn ahead_m(
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
        way_s: f64,
    ) -> f64 {
        let fastest = state.v.norm() + state.spin(block).norm() * block.bound_m;
        let way_m = way_s * (fastest + world.body.gravity.norm() * way_s);
        TOUCH * block.radius_m + STAGE_REACH * way_m
    }

    /// Fails if a penetration is so large, relative to the balls' radius, that the contact model
    /// does not apply.
    fn check_depth(&self, block: &Block) -> Result<(), StepError> {
        let deepest = self.touches.found.iter().map(|touch| -touch.gap_m).fold(0.0, f64::max);
        if deepest > DEEPEST * block.ball_m { Err(StepError::SankIn) } else { Ok(()) }
    }
}
