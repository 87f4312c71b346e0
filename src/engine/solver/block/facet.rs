//! Rough ground. In the rigid limit an impact is one with the facet that is met. In the schemes with springs a block is turned against the
//! facet while the impact lasts. As for spheres, velocity and spin are turned, not the mesh: the block presses into the surface that is there, and no spring can give
//! back more than it took. The spin is given the length that keeps its energy, as the moments of inertia stay where they are.

use super::{Footing, Moving};
use crate::body::Block;
use crate::contact::block::BlockTouch;
use crate::solver::environment::ContactEnvironment;
use crate::solver::law::capture_m_s;
use crate::solver::roughness::{SurfaceApproach, Tilt};
use nalgebra::Rotation3;

impl Moving {
    /// Turns velocity and spin; every joule stays.
    pub(super) fn redirect(&mut self, block: &Block, turn: &Rotation3<f64>) {
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

impl Footing {
    /// Whether a contact that touches is struck, faster than its ground captures.
    pub(crate) fn is_struck(
        world: &ContactEnvironment,
        (block, moving): (&Block, &Moving),
        touch: &BlockTouch,
    ) -> bool {
        moving.approach_m_s(block, touch) >= capture_m_s(world.law(touch.triangle))
    }

    /// The facet of rough ground that the fastest of the contacts that touch meets.
    pub(super) fn facet(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        moving: &Moving,
    ) -> Option<Rotation3<f64>> {
        let meeting = self.meeting(block, moving)?;
        self.facets.draw_facet(world, &meeting)
    }

    /// Whether a block that slides or rolls has the last facet behind it, and comes to the next.
    pub(super) fn comes_to_next_facet(
        &self,
        world: &ContactEnvironment,
        block: &Block,
        moving: &Moving,
    ) -> bool {
        self.facets.are_rough()
            && self.meeting(block, moving).is_some_and(|at| self.facets.meets_new_facet(world, &at))
    }

    /// The fastest of the contacts that touch, as it meets a facet.
    fn meeting(&self, block: &Block, moving: &Moving) -> Option<SurfaceApproach> {
        let fastest = moving.fastest(block, self.touching(block))?;
        let (n, triangle, c) = (fastest.normal, fastest.triangle, moving.pose.centre);
        Some(SurfaceApproach { n, triangle, c, v: moving.at(block, &fastest.lever) })
    }

    /// With springs: lets the contact that presses hardest begin anew where the block comes to the next facet.
    pub(crate) fn meet_next_facet(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &Moving),
    ) {
        if !self.facets.are_rough() || self.facets.is_tilted() {
            return;
        }
        let pressed = self.springs.histories.iter_mut().filter(|one| one.closed && one.announced);
        let hardest = pressed.max_by(|one, other| one.normal_force.total_cmp(&other.normal_force));
        let Some(history) = hardest else { return };
        let v = moving.at(block, &(history.point - moving.pose.centre));
        let (n, triangle, c) = (history.n, history.triangle, moving.pose.centre);
        if self.facets.meets_new_facet(world, &SurfaceApproach { n, triangle, c, v }) {
            (history.announced, history.captured) = (false, true);
            history.approach_m_s = -n.dot(&v);
        }
    }

    /// Turns the block against a facet until it is turned back, at `until_s` (s) at the latest.
    pub(crate) fn rotate_onto_facet(
        &mut self,
        block: &Block,
        moving: &mut Moving,
        (turn, until_s): (Rotation3<f64>, f64),
    ) {
        moving.redirect(block, &turn.inverse());
        self.facets.tilt = Some(Tilt { turn, until_s });
        self.springs.refresh();
    }

    /// Turns the block back if it is turned; whether it was.
    pub(crate) fn rotate_back(&mut self, block: &Block, moving: &mut Moving) -> bool {
        let Some(Tilt { turn, .. }) = self.facets.tilt.take() else { return false };
        moving.redirect(block, &turn);
        self.springs.refresh();
        true
    }
}
