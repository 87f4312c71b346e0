//! Rough ground: impacts on facets that are tilted against the mesh.
//!
//! The tilt of a facet is uniform in its angle, from zero to the ground's roughness, and in its
//! direction, weighted by `max(0, −v·n′)` with `n′` the tilted normal, the flux of the rock through
//! the facet. Whether an impact rebounds depends on the approach to the facet. A rebound into the
//! mean surface is simply the next impact.
//!
//! Roughness is a property of the place: a rock meets one facet per roughness length of its path,
//! and the mean surface until it has left that behind. So the number of its small impacts, which
//! depends on stiffness and steps, does not decide how often it is deflected. If it met the same
//! facet in each of them, stiff springs would let it hop up a ramp that soft ones roll along.
//!
//! Energy is conserved: the motion is rotated onto the facet and back, and a rotation changes
//! neither speed nor spin rate.

use super::environment::ContactEnvironment;
use crate::contact::history::SAME_CONTACT_COSINE;
use crate::ground::Law;
use crate::math;
use crate::random::{RandomStream, unit};
use crate::rock::Vec3;
use nalgebra::{Rotation3, Unit};
use std::f64::consts::TAU;

/// Slower approaches do not count as facets (–, relative to `√(g R)`, the speed of a rock that
/// falls by half its radius): they take less than a ten-thousandth of that energy, whatever the
/// springs.
const LEAST_APPROACH: f64 = 1e-2;
/// Share of the roughness length within which a facet met late counts from where it was due (–).
const PAST_DUE: f64 = 0.5;
/// Most draws of a facet: at least one in three is accepted where the rock approaches the surface,
/// one in six where it moves along it. A bound for pathological cases only.
const DRAWS: u32 = 1000;

/// Slowest approach to a facet (m/s).
pub(super) fn least_m_s(world: &ContactEnvironment) -> f64 {
    LEAST_APPROACH * world.body.fall_speed_m_s()
}

/// The facets of one rock.
#[derive(Debug, Clone, Default)]
pub(crate) struct RoughFacets {
    random: Option<RandomStream>,
    last: Option<TiltedFacet>,
    pub(super) tilt: Option<Tilt>,
}

/// A facet that was met.
#[derive(Debug, Clone)]
struct TiltedFacet {
    /// Centre of the rock there (m), the surface's normal, and the ground.
    centre: Vec3,
    normal: Vec3,
    ground: u16,
    /// Distance from there to the next facet (m).
    reach_m: f64,
}

/// Rotation between surface and facet during the impact of a rock on it.
#[derive(Debug, Clone)]
pub(super) struct Tilt {
    pub(super) turn: Rotation3<f64>,
    /// Latest end of the impact (s).
    pub(super) until_s: f64,
}

/// A rock that approaches a surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfaceApproach {
    /// Normal of the surface.
    pub(crate) n: Vec3,
    /// Triangle whose ground sets the law.
    pub(crate) triangle: u32,
    /// Centre of the rock (m).
    pub(crate) c: Vec3,
    /// Its velocity (m/s).
    pub(crate) v: Vec3,
}

impl SurfaceApproach {
    /// Approach to the facet rotated by `turn` from the surface (m/s).
    pub(crate) fn approach_m_s(&self, turn: &Rotation3<f64>) -> f64 {
        -(turn * self.n).dot(&self.v)
    }

    /// Fastest approach to any facet tilted by `most` (rad) at most (m/s).
    ///
    /// `−n'·v` over all `n'` within an angle of `n` is `|v|` if the direction `−v` is among them,
    /// else that of the `n'` nearest to it: `approach cos + along sin`. It scales the rejection
    /// below, so that the most visible facet is always accepted.
    fn max_approach_m_s(&self, most: f64) -> f64 {
        let approach = -self.n.dot(&self.v);
        let along = (self.v + self.n * approach).norm();
        let (sine, cosine) = math::sin_cos(most);
        // the facet perpendicular to the velocity has the fastest approach, if it is in range
        if approach * sine >= along * cosine {
            self.v.norm()
        } else {
            approach * cosine + along * sine
        }
    }
}

impl RoughFacets {
    /// Facets of a rock with its own random stream, on grounds with these laws: none where all are
    /// smooth.
    pub(crate) fn of(random: RandomStream, laws: &[Law]) -> Self {
        let is_rough = laws.iter().any(|law| law.roughness_rad > 0.0);
        Self { random: is_rough.then_some(random), ..Self::default() }
    }

    /// Whether any ground of the rock is rough.
    pub(crate) fn are_rough(&self) -> bool {
        self.random.is_some()
    }

    /// Draws the facet that a rock strikes, as the rotation from the surface to it. `None` on
    /// smooth ground, within the range of the last facet, and where the approach is no faster than
    /// that of rolling.
    ///
    /// A facet approached more slowly than the capture speed causes no rebound, but deflection and
    /// loss: the capture speed is proportional to `√(m/p_N)`, and soft springs must not make the
    /// ground smooth for slow rocks.
    pub(crate) fn draw_facet(
        &mut self,
        world: &ContactEnvironment,
        at: &SurfaceApproach,
    ) -> Option<Rotation3<f64>> {
        if !self.meets_new_facet(world, at) {
            return None;
        }
        let law = world.law(at.triangle);
        let turn = draw(self.random.as_mut()?, at, law.roughness_rad, least_m_s(world))?;
        let reach_m = law.roughness_length_m - self.overshoot_m(at, law.roughness_length_m);
        let ground = world.ground_of(at.triangle);
        self.last = Some(TiltedFacet { centre: at.c, normal: at.n, ground, reach_m });
        Some(turn)
    }

    /// Distance of the rock past the position of the next facet (m): a step ends somewhere behind
    /// it, and step lengths must not decide the number of facets. Beyond the share [`PAST_DUE`] of
    /// the roughness length the rock has flown or stood still, and it is 0.
    fn overshoot_m(&self, at: &SurfaceApproach, length_m: f64) -> f64 {
        let past_m = |facet: &TiltedFacet| (facet.centre - at.c).norm() - facet.reach_m;
        let past_m = self.last.as_ref().map_or(0.0, past_m);
        if (0.0..PAST_DUE * length_m).contains(&past_m) { past_m } else { 0.0 }
    }

    /// Whether a rock at a surface meets a new facet: its approach is fast enough, and the last
    /// facet does not extend to here. That one may be far off, on another ground, or on another
    /// side of an obstacle.
    pub(crate) fn meets_new_facet(&self, world: &ContactEnvironment, at: &SurfaceApproach) -> bool {
        let law = world.law(at.triangle);
        law.roughness_rad > 0.0
            && at.max_approach_m_s(law.roughness_rad) >= least_m_s(world)
            && self.last.as_ref().is_none_or(|facet| {
                (facet.centre - at.c).norm() >= facet.reach_m
                    || facet.ground != world.ground_of(at.triangle)
                    || facet.normal.dot(&at.n) <= SAME_CONTACT_COSINE
            })
    }

    /// Distance that a rock at `c` may travel before it can strike a facet (m): 0 during an impact
    /// on one, and on rough ground before the first.
    pub(super) fn distance_to_facet_m(&self, c: &Vec3) -> f64 {
        match (&self.random, &self.tilt, &self.last) {
            (None, ..) => f64::INFINITY,
            (_, None, Some(facet)) => (facet.reach_m - (facet.centre - c).norm()).max(0.0),
            _ => 0.0,
        }
    }

    /// Whether the rotation onto a facet has to end: the rock has left it, or its time is over at
    /// `now_s` (s).
    pub(crate) fn is_tilt_over(&self, is_free: bool, now_s: f64) -> bool {
        self.tilt.as_ref().is_some_and(|tilt| is_free || now_s >= tilt.until_s)
    }

    /// Whether the rock is in an impact on a facet.
    pub(crate) fn is_tilted(&self) -> bool {
        self.tilt.is_some()
    }
}

/// Draws a facet as the rotation from the surface to it, tilted by `most` (rad) at most and
/// approached at `least` (m/s) or faster.
///
/// Rejection sampling: tilt and direction uniform, accepted with the probability
/// `max(0, −v·n')/fastest`. Three numbers of the rock's own stream a try.
fn draw(
    random: &mut RandomStream,
    at: &SurfaceApproach,
    most: f64,
    least: f64,
) -> Option<Rotation3<f64>> {
    let fastest = at.max_approach_m_s(most);
    let beside = if at.n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    // any axis perpendicular to the normal, rotated by a uniform angle, gives the direction of the
    // tilt
    let across = at.n.cross(&beside);
    (0..DRAWS).find_map(|_| {
        let around = math::turn(&Unit::new_normalize(at.n), TAU * unit(random));
        let axis = Unit::new_normalize(around * across);
        let turn = math::turn(&axis, most * unit(random));
        let seen = at.approach_m_s(&turn);
        (seen > fastest * unit(random) && seen >= least).then_some(turn)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::{Capture, Damping, Ground};
    use crate::random::{Purpose, stream};
    use crate::rock::Rock;
    use crate::solver::body::Body;
    use crate::terrain::stl::Soup;
    use crate::terrain::weld::{Piece, Up, weld};
    use crate::terrain::{Sheet, Terrain};
    use std::path::Path;

    /// Mean distance between facets (–, relative to the roughness length) of a rock that draws one
    /// after every `step` of that length.
    fn spacing(step: f64) -> f64 {
        let ground = Ground {
            roughness_rad: 0.25,
            roughness_length_m: Some(0.5),
            ..Ground::smooth([1e9, 0.25e9], 0.6, Some(0.5))
        };
        let corners = [Vec3::zeros(), Vec3::x() * 9.0, Vec3::y() * 9.0];
        let soup = Soup::from(vec![corners]);
        let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
        let welded = weld(&[piece], Vec3::zeros(), Some(1e-9)).unwrap();
        let sheet = Sheet { path: "made".into(), ground: 0, is_tree: false };
        let terrain = Terrain::new(welded, vec![sheet]);
        let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
        let capture = Capture { own_m_s: None, tolerance_m_s: 0.05, gravity_m_s2: 9.81 };
        let law = Law::new(&ground, &Damping::of(ground.restitution), &rock, &capture);
        let mut facets = RoughFacets::of(stream(1, Purpose::Impacts, 0), &[law]);
        let laws = &mut [law];
        let body = Body::new(&rock, 9.81);
        let world = ContactEnvironment { terrain: &terrain, body, laws };
        let (count, v) = (2000, Vec3::x() * 2.0);
        let mut met = 0;
        for k in 0..count {
            let c = Vec3::x() * (0.5 * step * f64::from(k));
            met += u32::from(
                facets
                    .draw_facet(&world, &SurfaceApproach { n: Vec3::z(), triangle: 0, c, v })
                    .is_some(),
            );
        }
        f64::from(count) * step / f64::from(met)
    }

    /// Whatever the step length, there is one facet per roughness length. Counted from where each
    /// was met, their distance would be the next whole number of steps: 1.2, 1.05 and 1.2.
    #[test]
    fn steps_do_not_decide_how_many_facets_there_are() {
        for step in [0.01, 0.3, 0.35, 0.4] {
            let mean = spacing(step);
            assert!(
                (mean - 1.0).abs() < 5e-3,
                "{step}: one facet for each {mean} roughness lengths"
            );
        }
    }
}
