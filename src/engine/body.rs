//! Body of a rock: volume, centre of mass, inertia, and the balls at its corners.
//!
//! A block is a **rounded convex polyhedron**: the hull of balls of one radius whose centres are
//! the corners of a convex core. Mass and inertia are those of the surface it is made from, by
//! exact integrals; contact is that of the rounded hull. Shapes are given in units of the sphere of
//! equal volume, in the frame of the principal axes, so that a radius and a density make a rock of
//! them. A sphere is one ball at the centre and needs none of this.

mod cut;
mod hull;
mod primitives;
mod mesh;
mod solid;

pub use hull::{Core, HullFace, Ridge, max_corners};
pub use mesh::{BadSurface, ThinnedHull};
pub use primitives::{box_surface, eota, prism_surface, sphere_points};
pub use solid::{Solid, Surface};

use crate::rock::{Rock, Vec3};
use serde::{Deserialize, Serialize};

/// Smallest corner radius over the radius of the sphere of equal volume (–): sharper corners would
/// need steps too short for any practical use.
pub const MIN_CORNER_RADIUS: f64 = 0.01;

/// What a shape is made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShapeKind {
    /// One ball at the centre.
    Sphere,
    /// EOTA's test block of equal sides, 26 faces (ETAG 027).
    Eota111,
    /// The same at half the thickness: a wheel.
    Eota221,
    /// A box.
    Box,
    /// An ellipsoid, represented by 42 points of its surface.
    Ellipsoid,
    /// A straight prism over a regular polygon.
    Prism,
    /// A scanned surface.
    Mesh,
}

impl ShapeKind {
    /// Its name in scenes and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Eota111 => "eota111",
            Self::Eota221 => "eota221",
            Self::Box => "box",
            Self::Ellipsoid => "ellipsoid",
            Self::Prism => "prism",
            Self::Mesh => "mesh",
        }
    }
}

/// A shape in units of the radius of the sphere of equal volume, centred, along its principal axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The convex core whose corners carry the balls.
    pub core: Core,
    /// Radius of the balls (–).
    pub ball: f64,
    /// Principal moments of inertia over `m R²` (–).
    pub inertia: [f64; 3],
    /// Distance of the farthest surface point from the centre (–).
    pub bound: f64,
    /// How far the original surface reaches beyond the rounded hull at most (–); negative if the
    /// rounded hull is outside of it everywhere.
    pub cut_off: f64,
}

impl Shape {
    /// The rounded shape of a closed surface. Mass and inertia are those of the surface; the core
    /// is the hull of `corners` (some of its points), moved inwards by the radius of the balls so
    /// that faces stay where they are. `ball` is relative to the radius of the sphere of equal
    /// volume.
    ///
    /// # Errors
    /// A surface without volume, or a core that the balls would fill.
    pub fn of(solid: &Solid, corners: &[Vec3], ball: f64) -> Result<Self, BadSurface> {
        let unit = solid.equal_radius();
        let to_own = |p: &Vec3| solid.axes.inverse_transform_vector(&(p - solid.centre)) / unit;
        let scaled: Vec<Vec3> = corners.iter().map(to_own).collect();
        let hull = Core::of(&scaled)?;
        if hull.faces.iter().any(|face| face.level <= ball) {
            return Err(BadSurface::NoCore);
        }
        let core = Core::of(&hull.inset(ball))?;
        let inertia = solid.moments.map(|moment| moment / (solid.volume * unit * unit));
        let reach = |core: &Core| core.corners.iter().map(Vec3::norm).fold(0.0, f64::max);
        let cut_off = hull.corners.iter().map(|p| core.distance(p) - ball).fold(f64::MIN, f64::max);
        let bound = reach(&core) + ball;
        Ok(Self { core, ball, inertia, bound, cut_off })
    }
}

/// A rock with a shape, in metres and kilograms, in the frame of its principal axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Core (m).
    pub core: Core,
    /// Radius of the balls at its corners (m).
    pub ball_m: f64,
    /// Mass (kg).
    pub mass_kg: f64,
    /// Principal moments of inertia (kg m²).
    pub inertia_kg_m2: [f64; 3],
    /// Radius of the bounding ball (m).
    pub bound_m: f64,
    /// Radius of the sphere of equal volume (m).
    pub radius_m: f64,
}

impl Block {
    /// A shape with the size and density of a rock.
    pub fn new(shape: &Shape, rock: &Rock) -> Self {
        let (radius_m, mass_kg) = (rock.radius_m, rock.mass_kg());
        Self {
            core: shape.core.scaled(radius_m),
            ball_m: shape.ball * radius_m,
            mass_kg,
            inertia_kg_m2: shape.inertia.map(|moment| moment * mass_kg * radius_m * radius_m),
            bound_m: shape.bound * radius_m,
            radius_m,
        }
    }

    /// Distance of its farthest point from the centre along a unit direction in its own frame (m):
    /// the support function.
    pub fn support_m(&self, along: &Vec3) -> f64 {
        let most = self.core.corners.iter().map(|p| p.dot(along)).fold(f64::MIN, f64::max);
        most + self.ball_m
    }

    /// Least value of the support function (m): the radius of the largest ball about its centre
    /// inside it.
    pub fn min_support_m(&self) -> f64 {
        let nearest = self.core.faces.iter().map(|face| face.level).fold(f64::INFINITY, f64::min);
        nearest + self.ball_m
    }
}

#[cfg(test)]
mod tests;
