//! The impact of a sphere on a facet of rough ground: its motion is rotated against the facet and back.
//!
//! Contact detection and closed forms stay those of the mesh. The rock goes on its way with the rotated
//! motion, and so do the contacts with other rocks that last meanwhile: a rotation of one motion keeps
//! the energy of all.

use super::contact_state::{ContactEnvironment, ContactState};
use super::roughness::Tilt;
use nalgebra::Rotation3;

impl ContactState {
    /// Rotates the motion onto a facet until `until_s` (s) at the latest, at constant energy.
    pub(crate) fn rotate_onto_facet(
        &mut self,
        world: &ContactEnvironment,
        turn: Rotation3<f64>,
        until_s: f64,
    ) {
        let back = turn.inverse();
        self.redirect(world, back * self.v, back * self.w);
        self.facets.tilt = Some(Tilt { turn, until_s });
    }

    /// Rotates the motion back if it is rotated; returns the rotation.
    pub(crate) fn rotate_back(&mut self, world: &ContactEnvironment) -> Option<Rotation3<f64>> {
        let Tilt { turn, .. } = self.facets.tilt.take()?;
        self.redirect(world, turn * self.v, turn * self.w);
        Some(turn)
    }
}
