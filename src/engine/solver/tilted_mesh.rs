//! The impact of a sphere on a facet of rough ground: either the rock's motion is rotated onto the
//! mesh, or the mesh is rotated onto the facet.
//!
//! For a rock that touches nothing else both are the same, and the motion is rotated, as contact
//! detection and closed forms then stay as they are. Other rocks that touch it meet it with its
//! true velocity: for a rock among others the mesh is rotated, about the rock's centre at the
//! beginning of the impact,
//!
//! ```text
//! c_mesh = c₀_mesh + Qᵀ (c − c₀),   n = Q n_mesh
//! ```
//!
//! `Q` rotates the surface to the facet, `c_mesh` is the centre for which contact points of the mesh
//! are found. So penetration is the integral of the approach along the facet's normal, and no energy
//! is made. When the impact ends, `Q` is the identity again, and an offset `c − c_mesh` of some
//! millimetres is left. It is dropped as soon as neither the mesh nor another rock notices.

use super::contact_state::{ContactEnvironment, ContactState};
use super::roughness::{Tilt, TiltedMesh};
use crate::contact::{TOUCH, penetration_correction};
use crate::rock::Vec3;
use nalgebra::Rotation3;

impl ContactState {
    /// The centre for which contact points of the rock are found when it is at `c` (m).
    #[inline]
    pub(super) fn on_mesh(&self, c: &Vec3) -> Vec3 {
        self.facets.mesh.as_ref().map_or(*c, |mesh| mesh.centre_on_mesh(c))
    }

    /// The same for where it is (m).
    pub(crate) fn centre_on_mesh(&self) -> Vec3 {
        self.on_mesh(&self.c)
    }

    /// A direction in the frame of the mesh.
    pub(crate) fn along_mesh(&self, x: &Vec3) -> Vec3 {
        self.facets.along_mesh(x)
    }

    /// Rotates the motion onto a facet until `until_s` (s) at the latest; a rotation keeps the
    /// energy.
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

    /// Ends the impact on a facet; returns the rotation of the motion that this takes, if there is
    /// an impact.
    pub(crate) fn rotate_back(&mut self, world: &ContactEnvironment) -> Option<Rotation3<f64>> {
        let Tilt { turn, .. } = self.facets.tilt.take()?;
        if self.facets.mesh.is_none() {
            self.redirect(world, turn * self.v, turn * self.w);
            return Some(turn);
        }
        self.turn_mesh(turn.inverse());
        Some(Rotation3::identity())
    }

    /// Rotates the mesh to the facet in place of the motion, for a rock among others; returns the
    /// rotation of the motion that this takes, if it was rotated. From now (s) on the impact may
    /// last `longer` times as long (–), as others press the rock on.
    pub(crate) fn rotate_mesh(
        &mut self,
        world: &ContactEnvironment,
        now_s: f64,
        longer: f64,
    ) -> Option<Rotation3<f64>> {
        let tilt = self.facets.tilt.as_mut()?;
        let turn = tilt.turn;
        if self.facets.mesh.as_ref().is_some_and(|mesh| *mesh.turn() == turn) {
            return None;
        }
        tilt.until_s = now_s + longer * (tilt.until_s - now_s);
        self.redirect(world, turn * self.v, turn * self.w);
        self.turn_mesh(turn);
        Some(turn)
    }

    /// Rotates the motion in place of the mesh, for a rock that is alone again.
    pub(crate) fn rotate_motion(&mut self, world: &ContactEnvironment) {
        if let Some(tilt) = &self.facets.tilt {
            let back = tilt.turn.inverse();
            self.redirect(world, back * self.v, back * self.w);
            self.turn_mesh(back);
        }
        self.move_to(world, self.centre_on_mesh());
    }

    /// Rotates the mesh about the rock's centre, with all that the contacts remember.
    fn turn_mesh(&mut self, turn: Rotation3<f64>) {
        let before =
            self.facets.mesh.as_ref().map_or_else(Rotation3::identity, |mesh| *mesh.turn());
        let on_mesh = self.centre_on_mesh();
        self.facets.mesh = Some(TiltedMesh::new(turn * before, self.c, on_mesh));
        for history in self.histories.iter_mut() {
            history.n = turn * history.n;
            history.shear = turn * history.shear;
            history.roll = turn * history.roll;
        }
        self.points_found_at = None;
        self.fresh = false;
    }

    /// Whether an impact on a facet has left the rock off the centre for which its contact points
    /// are found.
    pub(crate) fn is_off_mesh(&self) -> bool {
        self.facets.mesh.is_some() && self.facets.tilt.is_none()
    }

    /// Where the rock could go on without an offset (m): where it is, or the least way out of the
    /// mesh, if the mesh holds it no more; else the centre for which contact points are found.
    pub(crate) fn without_offset(&mut self, world: &ContactEnvironment) -> Vec3 {
        if !self.is_free() {
            return self.centre_on_mesh();
        }
        let (c, radius) = (self.c, world.body.radius);
        self.update_neighbours(world, &c);
        self.points_found_at = None;
        self.near.touches(world.terrain, &c, radius, &mut self.touches);
        let out = penetration_correction(&self.touches, radius, &Vec3::zeros());
        if out.norm() > TOUCH * radius { c + out } else { c }
    }

    /// Goes on from `c` (m) with an upright mesh; kinetic energy pays for the height.
    pub(crate) fn move_to(&mut self, world: &ContactEnvironment, c: Vec3) {
        let lifted_j = world.body.lifted_j(&(c - self.c));
        world.body.exchange((&mut self.v, &mut self.w), lifted_j);
        self.c = c;
        self.facets.mesh = None;
        self.points_found_at = None;
        self.fresh = false;
    }
}
