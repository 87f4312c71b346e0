//! Rough ground. In the rigid limit an impact takes place on the facet that is met. In the schemes
//! with springs the motion of the block is rotated against the facet while the impact lasts. As for
//! spheres, velocity and spin are rotated, not the mesh: the block presses into the real surface,
//! and no spring can return more than it stored. The spin is scaled to conserve its energy, because
//! the moments of inertia are not rotated.

use super::{BlockContactState, BlockState};
use crate::body::Block;
use crate::contact::block::BlockContactPoint;
use crate::solver::environment::ContactEnvironment;
use crate::solver::law::capture_m_s;
use crate::solver::roughness::{SurfaceApproach, Tilt};
use nalgebra::Rotation3;

impl BlockState {
    /// Rotates velocity and spin and conserves the kinetic energy.
    pub(super) fn rotate(&mut self, block: &Block, turn: &Rotation3<f64>) {
        let w = self.spin(block);
        let turning_j = 0.5 * w.dot(&self.momentum);
        let mass = self.mass(block);
        let (turned, axis_of) = (turn * w, mass.inverse.try_inverse());
        self.v = turn * self.v;
        let Some(inertia) = axis_of.filter(|_| turning_j > 0.0) else { return };
        let momentum = inertia * turned;
        self.momentum = momentum * (turning_j / (0.5 * turned.dot(&momentum))).sqrt();
    }
}

impl BlockContactState {
    /// Whether a touching contact closes faster than its ground captures, so that it is an impact.
    pub(crate) fn is_struck(
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
        touch: &BlockContactPoint,
    ) -> bool {
        state.approach_m_s(block, touch) >= capture_m_s(world.law(touch.triangle))
    }

    /// The facet of rough ground met by the touching contact that closes fastest.
    pub(super) fn facet(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        state: &BlockState,
    ) -> Option<Rotation3<f64>> {
        let meeting = self.meeting(block, state)?;
        self.facets.draw_facet(world, &meeting)
    }

    /// Whether a sliding or rolling block has passed the last facet and reaches the next.
    pub(super) fn reaches_next_facet(
        &self,
        world: &ContactEnvironment,
        block: &Block,
        state: &BlockState,
    ) -> bool {
        self.facets.are_rough()
            && self.meeting(block, state).is_some_and(|at| self.facets.meets_new_facet(world, &at))
    }

    /// The touching contact that closes fastest, in the form that facets are looked up with.
    fn meeting(&self, block: &Block, state: &BlockState) -> Option<SurfaceApproach> {
        let fastest = state.fastest(block, self.touching(block))?;
        let (n, triangle, c) = (fastest.normal, fastest.triangle, state.pose.centre);
        Some(SurfaceApproach { n, triangle, c, v: state.velocity_at(block, &fastest.lever) })
    }

    /// With springs: restarts the contact with the largest normal force as an impact where the
    /// block reaches the next facet.
    pub(crate) fn meet_next_facet(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) {
        if !self.facets.are_rough() || self.facets.is_tilted() {
            return;
        }
        let pressed = self.springs.histories.iter_mut().filter(|one| one.closed && one.announced);
        let hardest = pressed.max_by(|one, other| one.normal_force.total_cmp(&other.normal_force));
        let Some(history) = hardest else { return };
        let v = state.velocity_at(block, &(history.point - state.pose.centre));
        let (n, triangle, c) = (history.n, history.triangle, state.pose.centre);
        if self.facets.meets_new_facet(world, &SurfaceApproach { n, triangle, c, v }) {
            (history.announced, history.captured) = (false, true);
            history.approach_m_s = -n.dot(&v);
        }
    }

    /// Rotates the motion against a facet; it is rotated back at `until_s` (s) at the latest.
    pub(crate) fn rotate_onto_facet(
        &mut self,
        block: &Block,
        state: &mut BlockState,
        (turn, until_s): (Rotation3<f64>, f64),
    ) {
        state.rotate(block, &turn.inverse());
        self.facets.tilt = Some(Tilt { turn, until_s });
        self.springs.invalidate_rates();
    }

    /// Rotates the motion back if it is rotated; returns whether it was.
    pub(crate) fn rotate_back(&mut self, block: &Block, state: &mut BlockState) -> bool {
        let Some(Tilt { turn, .. }) = self.facets.tilt.take() else { return false };
        state.rotate(block, &turn);
        self.springs.invalidate_rates();
        true
    }
}
