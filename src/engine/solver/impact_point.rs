//! Where a rock strikes the mesh.

use crate::contact::{Feature, FeatureKind};
use crate::rock::Vec3;

/// An impact that rebounds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Blow {
    /// Speed of approach (m/s), to the facet on rough ground.
    pub(crate) approach_m_s: f64,
    /// Normal of the surface.
    pub(crate) n: Vec3,
    /// Triangle whose ground sets the law.
    pub(crate) triangle: u32,
}

/// A point of the mesh that is struck.
#[derive(Debug, Clone, Copy)]
pub struct ImpactPoint {
    /// Position (m).
    pub point_m: Vec3,
    /// Unit normal of the surface there.
    pub normal: Vec3,
    /// Kind of mesh feature.
    pub feature: FeatureKind,
    /// Triangle whose ground sets the law.
    pub triangle: u32,
    /// Speed of approach along the normal (m/s).
    pub approach_m_s: f64,
}

impl ImpactPoint {
    /// The point that a ball with centre `c` strikes along the normal of a feature of a triangle:
    /// `P1 = c − R n`.
    pub fn by_ball(
        (c, radius_m): (&Vec3, f64),
        normal: &Vec3,
        (feature, triangle): (Feature, u32),
        approach_m_s: f64,
    ) -> Self {
        let point_m = c - normal * radius_m;
        Self { point_m, normal: *normal, feature: feature.kind, triangle, approach_m_s }
    }
}
