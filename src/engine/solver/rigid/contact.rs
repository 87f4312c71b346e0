//! A contact of a rock with the mesh in the limit of stiff springs, and its impulses: for a rock
//! alone and for one among others.

use crate::contact::{ContactPoint, Feature};
use crate::ground::{FrictionLimits, Law};
use crate::rock::Vec3;
use crate::solver::body::{Body, Twist};
use crate::solver::contact_frame::ContactFrame;
use crate::solver::friction_rolling::{Compliance, FrictionRolling, SlipState};
use crate::solver::law::ZERO;
use crate::solver::loss::Loss;

/// Sweeps over the contacts of one rock, at most.
const SWEEPS: u32 = 100;
/// Change of an impulse, relative to the largest, at which they have converged (–).
const CONVERGED: f64 = 1e-12;

/// One contact with the mesh and its impulses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GroundContact {
    /// The rock, as a place in its island; 0 where it is alone.
    pub(crate) rock: usize,
    pub(crate) feature: Feature,
    pub(crate) triangle: u32,
    frame: ContactFrame,
    /// Limits of friction and rolling friction.
    pub(crate) limits: FrictionLimits,
    /// Normal speed wanted after the impulse (m/s).
    pub(crate) target_m_s: f64,
    /// Normal impulse (N s), ≥ 0.
    pub(crate) normal_impulse: f64,
    /// Impulse along the surface on the rock (N s).
    pub(crate) shear_impulse: Vec3,
    /// Rolling impulse on the rock (N m s).
    pub(crate) rolling_impulse: Vec3,
    /// Which of friction and rolling friction are at their limits, as far as is known.
    pub(crate) mode: SlipState,
    /// Among others: version of its rock's motion when it was solved last.
    pub(crate) seen_version: u32,
}

impl GroundContact {
    /// No contact, on a level surface.
    pub(crate) const NONE: Self = Self {
        rock: 0,
        feature: Feature::NONE,
        triangle: 0,
        frame: ContactFrame::LEVEL,
        limits: FrictionLimits::NONE,
        target_m_s: 0.0,
        normal_impulse: 0.0,
        shear_impulse: ZERO,
        rolling_impulse: ZERO,
        mode: SlipState::Stick,
        seen_version: 0,
    };

    /// The contact of a rock at a contact point, without impulses.
    pub(crate) fn new(rock: usize, touch: &ContactPoint, law: &Law) -> Self {
        Self {
            rock,
            feature: touch.feature,
            triangle: touch.triangle,
            frame: ContactFrame::of(&touch.normal),
            limits: law.limits(),
            ..Self::NONE
        }
    }

    /// Unit normal from the mesh to the centre.
    #[inline]
    pub(crate) const fn n(&self) -> &Vec3 {
        &self.frame.n
    }

    /// Sets the impulses to zero.
    pub(crate) fn clear_impulses(&mut self) {
        (self.normal_impulse, self.shear_impulse, self.rolling_impulse) =
            (0.0, Vec3::zeros(), Vec3::zeros());
    }

    /// Solves the impulses for velocity `v` and spin `w` without this contact's own.
    ///
    /// `J = max(0, m (target_m_s − n·v))`: exact for one contact; for several sweeps repeat it.
    pub(crate) fn solve_for(&mut self, body: &Body, v: &Vec3, w: &Vec3) {
        self.normal_impulse = (body.mass * (self.target_m_s - self.n().dot(v))).max(0.0);
        if self.normal_impulse <= 0.0 {
            self.clear_impulses();
            return;
        }
        // The stick solution: `2/7 m` is the effective mass of a sphere's contact point along the
        // surface, and `I ω` stops all rotation; `FrictionRolling` couples both and applies the
        // limits.
        let pair = FrictionRolling {
            compliance: &Compliance::rigid(body.radius),
            a: self.frame.along(&(body.slip(self.n(), v, w) * body.mass_along())),
            d: self.frame.local(&(w * body.inertia)),
            caps: self.limits.caps(self.normal_impulse),
        };
        let (along, turn) = pair.solve(&mut self.mode);
        (self.shear_impulse, self.rolling_impulse) =
            (-self.frame.out_along(along), -self.frame.out_local(turn));
    }

    /// Impulse (N s) and rotational impulse (N m s) on the rock.
    #[inline]
    pub(crate) fn load(&self, body: &Body) -> Twist {
        (
            self.n() * self.normal_impulse + self.shear_impulse,
            self.rolling_impulse - self.n().cross(&self.shear_impulse) * body.radius,
        )
    }

    /// Change of the rock's velocity and spin by the impulses.
    pub(crate) fn velocity_change(&self, body: &Body) -> Twist {
        let (push, turn) = self.load(body);
        (push / body.mass, turn / body.inertia)
    }

    /// Energy taken by the impulses (J), at mean velocity and spin.
    ///
    /// The work of an impulse is that with the mean of the velocities before and after:
    /// `J·(v₀ + v₁)/2` is the change of kinetic energy exactly.
    pub(crate) fn loss(&self, body: &Body, (v, w): &Twist) -> Loss {
        let friction = -self.shear_impulse.dot(&body.slip(self.n(), v, w));
        let damping = -self.normal_impulse * self.n().dot(v);
        Loss::redistributed([friction, damping, -self.rolling_impulse.dot(w)])
    }
}

/// Normal separation speed wanted at the end of a step of length `dt` (s), from the gap (m) and the
/// separation speed (m/s) at its start: an open gap may close, and a normal impulse does no
/// positive work on the rock. Over an edge, half of the turn of the normal lies before the middle
/// of the step and half after it.
pub(crate) fn sustained_m_s(gap: f64, speed: f64, dt: f64) -> f64 {
    -(gap / dt).max(speed).max(0.0)
}

/// Sweeps over the contacts of one rock until their impulses converge, starting from those at hand.
/// `v` and `w` are the motion with these impulses; returns the motion afterwards (projected
/// Gauss–Seidel; for one contact the first sweep is exact).
pub(crate) fn converge(
    contacts: &mut [GroundContact],
    body: &Body,
    (mut v, mut w): Twist,
    sweeps: &mut u64,
) -> Twist {
    for _ in 0..SWEEPS {
        *sweeps += 1;
        let (mut change, mut scale) = (0.0f64, f64::MIN_POSITIVE);
        for contact in &mut *contacts {
            let (dv, dw) = contact.velocity_change(body);
            let (free, before) =
                ((v - dv, w - dw), (contact.normal_impulse, contact.shear_impulse));
            contact.solve_for(body, &free.0, &free.1);
            let (dv, dw) = contact.velocity_change(body);
            (v, w) = (free.0 + dv, free.1 + dw);
            change = change
                .max((contact.normal_impulse - before.0).abs())
                .max((contact.shear_impulse - before.1).norm());
            scale = scale.max(contact.normal_impulse);
        }
        if contacts.len() <= 1 || change <= CONVERGED * scale {
            break;
        }
    }
    (v, w)
}
