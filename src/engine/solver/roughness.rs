//! Rough ground: a rock that comes to it meets a facet that is tilted against the mesh.
//!
//! A rock sees the facets that face it: the tilt is uniform in its angle, from nothing to the ground's roughness, and in its
//! direction, weighted by `max(0, −v·n′)` with `n′` the tilted normal, the flux of the rock through the facet. Whether it
//! rebounds is judged by its approach to the facet. A rebound into the mean surface is simply the next impact.
//!
//! Roughness belongs to the place: until the rock has moved on by the ground's roughness length it meets the same facet, so
//! that the number of its small impacts, which is a matter of stiffness and steps, does not decide how often it is deflected.
//! A rock that slides or rolls meets the next facet once that length is behind it.
//!
//! Energy is untouched: the rock is turned against the facet and turned back, and a rotation
//! changes neither speed nor spin.

use super::environment::ContactEnvironment;
use super::law::capture_m_s;
use crate::ground::Law;
use crate::math;
use crate::random::{RandomStream, unit};
use crate::rock::Vec3;
use nalgebra::{Rotation3, Unit};
use std::f64::consts::TAU;

/// Facets drawn until one is met: one in three at least where the rock comes to the surface, one in six where it goes along it.
/// A bound for pathological cases only.
const DRAWS: u32 = 1000;

/// The facets that one rock meets.
#[derive(Debug, Clone, Default)]
pub(crate) struct RoughFacets {
    random: Option<RandomStream>,
    last: Option<TiltedFacet>,
    pub(super) tilt: Option<Tilt>,
}

/// The facet met last.
#[derive(Debug, Clone)]
struct TiltedFacet {
    /// Where the rock was (m), and on which ground.
    centre: Vec3,
    ground: u16,
    turn: Rotation3<f64>,
}

/// What a rock is turned by while it meets a facet.
#[derive(Debug, Clone)]
pub(super) struct Tilt {
    pub(super) turn: Rotation3<f64>,
    /// When the impact is over at the latest (s).
    pub(super) until_s: f64,
}

/// A rock at a surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meeting {
    /// Normal of the surface.
    pub(crate) n: Vec3,
    /// Triangle whose ground answers.
    pub(crate) triangle: u32,
    /// Centre of the rock (m).
    pub(crate) c: Vec3,
    /// Its velocity (m/s).
    pub(crate) v: Vec3,
}

impl Meeting {
    /// Fastest approach to any facet tilted by `most` (rad) at most (m/s).
    ///
    /// `−n'·v` over all `n'` within an angle of `n` is `|v|` if the direction `−v` is among them,
    /// else that of the `n'` nearest to it: `approach cos + along sin`. It scales the rejection
    /// below, so that the most visible facet is always accepted.
    fn most_m_s(&self, most: f64) -> f64 {
        let approach = -self.n.dot(&self.v);
        let along = (self.v + self.n * approach).norm();
        let (sine, cosine) = math::sin_cos(most);
        // the facet square to the way of the rock is the fastest, if there is one
        if approach * sine >= along * cosine {
            self.v.norm()
        } else {
            approach * cosine + along * sine
        }
    }
}

impl RoughFacets {
    /// Those of a rock with its own random stream, on grounds with these laws: none where all are smooth.
    pub(crate) fn of(random: RandomStream, laws: &[Law]) -> Self {
        let is_rough = laws.iter().any(|law| law.roughness_rad > 0.0);
        Self { random: is_rough.then_some(random), ..Self::default() }
    }

    /// Whether any ground of the rock has some.
    pub(crate) fn are_any(&self) -> bool {
        self.random.is_some()
    }

    /// The facet that a rock strikes, as the rotation from the surface to it: the last one as far as it reaches, a new one
    /// beyond. `None` on smooth ground, and where neither it nor the surface is approached faster than the capture speed.
    pub(crate) fn struck(
        &mut self,
        world: &ContactEnvironment,
        at: &Meeting,
    ) -> Option<Rotation3<f64>> {
        let (law, ground) = (world.law(at.triangle), world.ground_of(at.triangle));
        let capture = capture_m_s(law);
        if law.roughness_rad <= 0.0 || at.most_m_s(law.roughness_rad) < capture {
            return None;
        }
        let approach = |turn: &Rotation3<f64>| -(turn * at.n).dot(&at.v);
        // the last facet still reaches here, and is not seen from behind
        let known = self.last.as_ref().filter(|facet| {
            facet.ground == ground
                && (facet.centre - at.c).norm() < law.roughness_length_m
                && approach(&facet.turn) > 0.0
        });
        let turn = if let Some(facet) = known {
            facet.turn
        } else {
            let turn = draw(self.random.as_mut()?, at, law.roughness_rad)?;
            self.last = Some(TiltedFacet { centre: at.c, ground, turn });
            turn
        };
        let fastest = approach(&turn).max(-at.n.dot(&at.v));
        (fastest >= capture).then_some(turn)
    }

    /// Whether the last facet no longer reaches to a rock in contact at `at`.
    pub(crate) fn are_behind(&self, world: &ContactEnvironment, at: &Meeting) -> bool {
        let law = world.law(at.triangle);
        law.roughness_rad > 0.0
            && self.last.as_ref().is_none_or(|facet| {
                (facet.centre - at.c).norm() >= law.roughness_length_m
                    || facet.ground != world.ground_of(at.triangle)
            })
    }

    /// Whether the rock is turned against one that it has left, or whose time is up at `now_s` (s).
    pub(super) fn is_met(&self, is_free: bool, now_s: f64) -> bool {
        self.tilt.as_ref().is_some_and(|tilt| is_free || now_s >= tilt.until_s)
    }

    /// Whether the rock is turned against one.
    pub(crate) fn is_any_met(&self) -> bool {
        self.tilt.is_some()
    }
}

/// A facet that a rock sees, as the rotation from the surface to it; tilted by `most` (rad) at most.
///
/// Rejection sampling: tilt and direction uniform, accepted with the probability `max(0,
/// −v·n')/fastest`. Three numbers of the rock's own stream a try.
fn draw(random: &mut RandomStream, at: &Meeting, most: f64) -> Option<Rotation3<f64>> {
    let fastest = at.most_m_s(most);
    let beside = if at.n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    // any axis square to the normal: it is turned by a uniform angle to give the direction of the
    // tilt
    let across = at.n.cross(&beside);
    (0..DRAWS).find_map(|_| {
        let around = math::turn(&Unit::new_normalize(at.n), TAU * unit(random));
        let axis = Unit::new_normalize(around * across);
        let turn = math::turn(&axis, most * unit(random));
        let seen = -(turn * at.n).dot(&at.v);
        (seen > fastest * unit(random)).then_some(turn)
    })
}
