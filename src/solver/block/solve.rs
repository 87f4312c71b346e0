//! Impulses of several contacts with levers on one rigid body.
//!
//! With `a` from the centre of mass to the contact point, `T = [1, −[a]×]` and `V_N = nᵀT = [nᵀ, (a×n)ᵀ]` are the submatrices of the paper;
//! for a sphere `a ∥ n` and the rotational part is 0. The contact point answers an impulse with `G = T M⁻¹ Tᵀ`.
//!
//! Every contact obeys `u_n ≥ goal ⊥ p_n ≥ 0` and Coulomb's law for what is left of its slip; contacts are swept (projected
//! Gauss–Seidel), each solved for its three unknowns at once.

use crate::rock::Vec3;
use crate::solver::law::within;
use nalgebra::Matrix3;

/// Sweeps over the contacts, at most.
const SWEEPS: u32 = 300;
/// Change of the body's momentum in a sweep, relative to the largest impulse, below which the sweeps have settled (–).
const SETTLED: f64 = 1e-11;
/// Passes over the impulse of one contact that slides, at most.
const PASSES: u32 = 100;
/// Change of it below which they have settled (–).
const NEAR: f64 = 1e-13;

/// Mass and inertia of a body as it is turned now.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mass {
    /// Mass (kg).
    pub(crate) mass: f64,
    /// Inverse of the inertia tensor in the world's frame (1/(kg m²)).
    pub(crate) inverse: Matrix3<f64>,
}

/// One contact, and its impulse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlockContact {
    /// Unit normal from the ground into the rock.
    pub(crate) n: Vec3,
    /// From the centre of mass to the contact point (m).
    pub(crate) lever: Vec3,
    /// Coefficient of friction (–).
    pub(crate) friction: f64,
    /// Velocity of the contact point wanted afterwards (m/s): at least this along the normal, this along the surface if it sticks.
    pub(crate) goal: Vec3,
    /// Triangle whose ground answers.
    pub(crate) triangle: u32,
    /// Impulse on the rock (N s).
    pub(crate) impulse: Vec3,
    /// `G` (1/kg) and its inverse (kg).
    pub(super) answer: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

impl Mass {
    /// Velocity of a point of the body.
    #[inline]
    pub(crate) fn at(lever: &Vec3, (v, w): (&Vec3, &Vec3)) -> Vec3 {
        v + w.cross(lever)
    }

    fn change(&self, contact: &BlockContact, impulse: &Vec3) -> (Vec3, Vec3) {
        (impulse / self.mass, self.inverse * contact.lever.cross(impulse))
    }
}

impl BlockContact {
    pub(crate) fn new(
        mass: &Mass,
        (n, lever): (Vec3, Vec3),
        (friction, triangle): (f64, u32),
        goal: Vec3,
    ) -> Self {
        let across = lever.cross_matrix();
        let answer = Matrix3::identity() / mass.mass - across * mass.inverse * across;
        let inverse = answer.try_inverse().unwrap_or_else(|| Matrix3::identity() * mass.mass);
        let impulse = Vec3::zeros();
        Self { n, lever, friction, goal, triangle, impulse, answer, inverse }
    }

    /// The same contact with another goal.
    pub(crate) fn with_goal(&self, goal: Vec3) -> Self {
        Self { goal, ..*self }
    }

    /// Its impulse where the point would move by `u` beyond its goal without it.
    fn own_impulse(&self, u: &Vec3) -> Vec3 {
        let up = self.n.dot(u);
        if up >= 0.0 {
            return Vec3::zeros();
        }
        let stick = -(self.inverse * u);
        let push = self.n.dot(&stick);
        let drag = stick - self.n * push;
        if push > 0.0 && drag.norm_squared() <= (self.friction * push).powi(2) {
            return stick;
        }
        self.sliding(u, drag)
    }

    /// The impulse on the rim of Coulomb's cone. Also where no rigid solution exists (Painlevé): then the last pass, which obeys the
    /// cone and pushes.
    fn sliding(&self, u: &Vec3, mut drag: Vec3) -> Vec3 {
        let n = &self.n;
        let along = |x: &Vec3| x - n * n.dot(x);
        let to_n = self.answer * n;
        let (own, rate) = (n.dot(&to_n), 1.0 / (self.answer.trace() - n.dot(&to_n)));
        let mut push = 0.0;
        for _ in 0..PASSES {
            let asked = -(n.dot(u) + to_n.dot(&drag)) / own;
            push = asked.max(0.0);
            let slip = along(&(u + self.answer * drag + to_n * push));
            let next = within(drag - slip * rate, self.friction * push);
            let change = (next - drag).norm();
            drag = next;
            if change <= NEAR * push {
                break;
            }
        }
        n * push + drag
    }
}

/// Sweeps until the body moves as it will, from velocity and spin without impulses; whether it did. `sweeps` counts.
///
/// What must settle is the motion of the body, not each impulse. Where there are more contacts than a rigid body can tell apart, what one asks
/// may contradict what another asks, by rounding or by the little that a turn within the step moves two sticking points towards each other; the
/// sweeps then shift impulse between them without end, and the body does not feel it. Goals are known to `rounding_m_s` (m/s) only.
pub(crate) fn solve(
    mass: &Mass,
    contacts: &mut [BlockContact],
    (mut v, mut w): (Vec3, Vec3),
    rounding_m_s: f64,
    sweeps: &mut u64,
) -> bool {
    let alone = contacts.len() <= 1;
    let reach = contacts.iter().map(|contact| contact.lever.norm()).fold(0.0, f64::max);
    for _ in 0..SWEEPS {
        *sweeps += 1;
        let (before, mut scale) = ((v, w), f64::MIN_POSITIVE);
        for contact in contacts.iter_mut() {
            let u = Mass::at(&contact.lever, (&v, &w)) - contact.answer * contact.impulse;
            let next = contact.own_impulse(&(u - contact.goal));
            let (dv, dw) = mass.change(contact, &(next - contact.impulse));
            (v, w) = (v + dv, w + dw);
            scale = scale.max(next.norm());
            contact.impulse = next;
        }
        let moved = (v - before.0).norm() + (w - before.1).norm() * reach;
        if alone || moved <= (SETTLED * scale / mass.mass).max(rounding_m_s) {
            return true;
        }
    }
    false
}
