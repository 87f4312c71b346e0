//! Impulses of several contacts with levers on one rigid body.
//!
//! With `a` from the centre of mass to the contact point, `T = [1, −[a]×]` and
//! `V_N = nᵀT = [nᵀ, (a×n)ᵀ]` are the submatrices of the paper; for a sphere `a ∥ n` and the
//! rotational part is 0. An impulse changes the velocity of the contact point by `G = T M⁻¹ Tᵀ`
//! times the impulse, the Delassus matrix of the contact.
//!
//! Every contact obeys `u_n + C_n p_n ≥ goal ⊥ p_n ≥ 0` and Coulomb's law for the remaining
//! `u_t + C_t p_t − goal`. Contacts are solved by sweeps (projected Gauss–Seidel), each for its
//! three unknowns at once. In the rigid limit a contact has no compliance, `C = 0`. A spring and
//! dashpot over an implicit step is the same contact with a compliance and a goal of its own
//! ([`SpringCompliance`]), so that one solver serves both.

mod mixing;
mod newton;
mod sliding;

use super::rolling::RollingImpulse;
use crate::contact::MAX_CONTACTS;
use crate::contact::block::MAX_BLOCK_CONTACTS;
use crate::ground::FrictionLimits;
use crate::rock::Vec3;
use mixing::{AndersonMixing, PLAIN_SWEEPS};
use nalgebra::Matrix3;
use newton::solve_hard;
pub(super) use newton::solve_springs;
use sliding::SlidingMatrix;

/// Sweeps over the contacts, at most.
pub(super) const SWEEPS: u32 = 300;
/// Change of the body's momentum in a sweep, relative to the largest impulse, below which the
/// sweeps have converged (–).
const SETTLED: f64 = 1e-11;
/// The same for the second half of the sweeps: contact laws then hold to five digits of the contact
/// impulses.
const NEARLY_SETTLED: f64 = 1e-5;
/// Relaxation factor of the second half of the sweeps (–): it damps impulses that two contacts, or
/// contacts and rolling friction, pass to and fro.
const RELAXATION: f64 = 0.5;
/// Normal impulse assumed at a clamped contact (N s): larger than any other.
const LOCKED_N_S: f64 = 1e100;

/// Mass and inertia of a body at its present attitude.
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
    /// Target velocity of the contact point (m/s): a lower bound along the normal, the tangential
    /// velocity if it sticks.
    pub(crate) goal: Vec3,
    /// Triangle whose ground is touched.
    pub(crate) triangle: u32,
    /// Impulse on the rock (N s).
    pub(crate) impulse: Vec3,
    /// Capacities of its sliders.
    limits: FrictionLimits,
    /// Delassus matrix `G` (1/kg).
    pub(super) delassus: Matrix3<f64>,
    /// `G + C` and its inverse.
    with_compliance: MatrixAndInverse,
    /// `G + C` in the frame of the normal and two tangents.
    sliding: SlidingMatrix,
    /// Compliance of its springs; `None` in the rigid limit.
    springs: Option<SpringCompliance>,
    /// Whether it is clamped: it neither separates nor slips.
    pub(super) is_clamped: bool,
}

/// A matrix (1/kg) and its inverse (kg).
#[derive(Debug, Clone, Copy)]
struct MatrixAndInverse {
    matrix: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

impl MatrixAndInverse {
    fn of(matrix: Matrix3<f64>, mass_kg: f64) -> Self {
        let inverse = matrix.try_inverse().unwrap_or_else(|| Matrix3::identity() * mass_kg);
        Self { matrix, inverse }
    }
}

/// Compliance of a contact with springs and dashpots over an implicit step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringCompliance {
    /// Compliance along the normal and along the surface (1/kg): velocity over impulse.
    pub(crate) compliance: [f64; 2],
    /// Speed along the normal that ends the step at the surface (m/s).
    pub(crate) surface_m_s: f64,
}

impl Mass {
    /// Velocity of a point of the body.
    #[inline]
    pub(crate) fn velocity_at(lever: &Vec3, (v, w): (&Vec3, &Vec3)) -> Vec3 {
        v + w.cross(lever)
    }

    /// `G = T M⁻¹ Tᵀ` of a point (1/kg).
    fn delassus(&self, lever: &Vec3) -> Matrix3<f64> {
        let across = lever.cross_matrix();
        Matrix3::identity() / self.mass - across * self.inverse * across
    }

    /// Effective mass of a contact with this normal and lever, along the normal and in the mean
    /// along the surface (kg).
    pub(crate) fn effective_masses(&self, (n, lever): (&Vec3, &Vec3)) -> [f64; 2] {
        let delassus = self.delassus(lever);
        let along = n.dot(&(delassus * n));
        [1.0 / along, 2.0 / (delassus.trace() - along)]
    }

    fn velocity_change(&self, contact: &BlockContact, impulse: &Vec3) -> (Vec3, Vec3) {
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
        let delassus = mass.delassus(&lever);
        let (impulse, with_compliance) = (Vec3::zeros(), MatrixAndInverse::of(delassus, mass.mass));
        let (limits, springs, sliding) =
            (FrictionLimits::NONE, None, SlidingMatrix::of(&n, &delassus));
        let is_clamped = false;
        Self {
            n,
            lever,
            friction,
            goal,
            triangle,
            impulse,
            limits,
            delassus,
            with_compliance,
            sliding,
            springs,
            is_clamped,
        }
    }

    /// The same with springs.
    pub(crate) fn on_springs(
        mass: &Mass,
        (n, lever): (Vec3, Vec3),
        (friction, triangle): (f64, u32),
        (goal, springs): (Vec3, SpringCompliance),
    ) -> Self {
        let ([along, across], normal) = (springs.compliance, n * n.transpose());
        let soft = normal * along + (Matrix3::identity() - normal) * across;
        let hard = Self::new(mass, (n, lever), (friction, triangle), goal);
        let with_compliance = MatrixAndInverse::of(hard.delassus + soft, mass.mass);
        let sliding = SlidingMatrix::of(&n, &with_compliance.matrix);
        Self { with_compliance, sliding, springs: Some(springs), ..hard }
    }

    /// The same with the capacities of its sliders.
    pub(crate) fn rolling(self, limits: FrictionLimits) -> Self {
        Self { limits, ..self }
    }

    /// The same, clamped or not.
    pub(crate) fn clamped(self, is_clamped: bool) -> Self {
        Self { is_clamped, ..self }
    }

    /// Whether it pushes the block.
    pub(super) fn pushes(&self) -> bool {
        self.n.dot(&self.impulse) > 0.0
    }

    /// Whether it has rolling friction.
    pub(super) fn has_rolling(&self) -> bool {
        self.limits.has_rolling()
    }

    /// Whether it has friction.
    pub(super) fn has_friction(&self) -> bool {
        self.friction > 0.0
    }

    /// Largest angular impulse of rolling friction under its own normal impulse (N m s).
    pub(super) fn rolling_limit(&self) -> f64 {
        self.rolling_limit_of(self.n.dot(&self.impulse))
    }

    /// The same for a normal impulse (N s).
    pub(super) fn rolling_limit_of(&self, normal_impulse: f64) -> f64 {
        let normal_impulse = if self.is_clamped { LOCKED_N_S } else { normal_impulse };
        self.limits.caps(normal_impulse).1
    }

    /// Its compliance, in a scheme with springs.
    #[inline]
    pub(super) fn springs(&self) -> Option<&SpringCompliance> {
        self.springs.as_ref()
    }

    /// The same contact with another goal.
    pub(crate) fn with_goal(&self, goal: Vec3) -> Self {
        Self { goal, ..*self }
    }

    /// Its impulse if the point would move at `u` (m/s) without it.
    fn local_impulse(&self, u: &Vec3) -> Vec3 {
        if self.is_clamped {
            return self.with_compliance.inverse * (self.goal - u);
        }
        let impulse =
            self.coulomb_impulse(&(u - self.goal), (&self.with_compliance, &self.sliding));
        let Some(springs) = self.springs.filter(|_| impulse != Vec3::zeros()) else {
            return impulse;
        };
        if self.n.dot(&(u + self.delassus * impulse)) <= springs.surface_m_s {
            return impulse;
        }
        // the dashpot alone would keep the block outside the surface: the impulse that holds it
        // exactly at the surface
        let normal = self.n * self.n.transpose();
        let hard = self.with_compliance.matrix - normal * springs.compliance[0];
        let mass_kg = self.with_compliance.inverse.trace() / 3.0;
        let goal = self.goal + self.n * (springs.surface_m_s - self.n.dot(&self.goal));
        self.coulomb_impulse(
            &(u - goal),
            (&MatrixAndInverse::of(hard, mass_kg), &SlidingMatrix::of(&self.n, &hard)),
        )
    }

    /// Its impulse by Coulomb's law if the point would move at `u` (m/s) relative to its goal
    /// without it, and an impulse changes that by the given matrix.
    fn coulomb_impulse(
        &self,
        u: &Vec3,
        (with_compliance, sliding): (&MatrixAndInverse, &SlidingMatrix),
    ) -> Vec3 {
        let up = self.n.dot(u);
        if up >= 0.0 {
            return Vec3::zeros();
        }
        let stick = -(with_compliance.inverse * u);
        let normal_impulse = self.n.dot(&stick);
        let friction_impulse = stick - self.n * normal_impulse;
        if normal_impulse > 0.0
            && friction_impulse.norm_squared() <= (self.friction * normal_impulse).powi(2)
        {
            return stick;
        }
        // first guess: the direction in which it slid in the last sweep
        let begins = [sliding.tangential(&self.impulse), sliding.tangential(&friction_impulse)];
        let mut slides =
            begins.iter().filter_map(|friction_impulse| friction_impulse.try_normalize(0.0));
        let sliding_impulse =
            slides.find_map(|d| self.sliding_impulse((up, sliding.tangential(u)), d, sliding));
        sliding_impulse.unwrap_or_else(|| {
            self.sliding_impulse_by_iteration(u, (friction_impulse, &with_compliance.matrix))
        })
    }
}

/// The impulse of one solve as the initial guess of the next; an impulse that is not finite is
/// replaced by 0.
pub(super) fn first_guess(impulse: Vec3) -> Vec3 {
    if impulse.iter().all(|x| x.is_finite()) { impulse } else { Vec3::zeros() }
}

/// Largest angular impulse of rolling friction under the impulses of contacts (N m s).
pub(super) fn rolling_limit(contacts: &[BlockContact]) -> f64 {
    contacts.iter().map(BlockContact::rolling_limit).sum()
}

/// Rolling friction of contacts in the rigid limit.
pub(super) fn rigid_rolling(contacts: &[BlockContact]) -> RollingImpulse {
    let rolls = contacts.iter().any(BlockContact::has_rolling);
    if rolls { RollingImpulse::RIGID } else { RollingImpulse::NONE }
}

/// Sweeps until the motion of the body has converged, from its velocity and spin without impulses;
/// returns whether it has. `sweeps` counts.
///
/// Convergence is that of the body's motion, not of each impulse. With more contacts than a rigid
/// body can distinguish, the contact conditions may contradict each other by rounding, or by the
/// small amount by which the rotation within the step moves two sticking points towards each other.
/// The sweeps then shift impulse between the contacts without end, with no effect on the body. If a
/// third contact slides meanwhile, there is a small effect until one of the two begins to slip.
/// Rolling friction that holds a block sliding on several corners leaves the distribution of its
/// weight on them undetermined. After half of the sweeps, hard contacts are solved in the six
/// unknowns of the body ([`newton`]). If that fails too, the remaining sweeps are under-relaxed and
/// converge to five digits ([`NEARLY_SETTLED`]); a solve that has not converged then is counted.
/// Goals are known to `rounding_m_s` (m/s) only. `until` holds that bound and the largest number of
/// sweeps.
pub(crate) fn solve(
    mass: &Mass,
    unknowns: (&mut [BlockContact], &mut RollingImpulse),
    free: (Vec3, Vec3),
    until: (f64, u32),
    sweeps: &mut u64,
) -> bool {
    // faces with many corners are rare: the large work space is not cleared for the usual few
    // contacts
    if unknowns.0.len() <= MAX_CONTACTS {
        sweep::<{ MAX_CONTACTS + 1 }>(mass, unknowns, free, until, sweeps)
    } else {
        sweep::<{ MAX_BLOCK_CONTACTS + 1 }>(mass, unknowns, free, until, sweeps)
    }
}

/// The same with work space for fewer than `M` contacts.
fn sweep<const M: usize>(
    mass: &Mass,
    (contacts, rolling): (&mut [BlockContact], &mut RollingImpulse),
    (mut v, mut w): (Vec3, Vec3),
    (rounding_m_s, most): (f64, u32),
    sweeps: &mut u64,
) -> bool {
    let alone = contacts.len() <= 1 && !rolling.is_on();
    let reach = contacts.iter().map(|contact| contact.lever.norm()).fold(0.0, f64::max);
    // a contact at the centre of mass itself has no lever to compare moments with
    let mixes = contacts.len() < M && reach > 0.0;
    let mut mixing: Option<AndersonMixing<M>> = None;
    for sweep in 0..most {
        *sweeps += 1;
        // the last sweeps are not mixed: they end on the contact laws themselves
        let mixes_now = mixes && (PLAIN_SWEEPS..most / 2).contains(&sweep);
        if mixes_now {
            let count = contacts.len() + usize::from(rolling.is_on());
            mixing.get_or_insert_with(|| AndersonMixing::of(count, reach)).begin(contacts, rolling);
        }
        let is_late = sweep >= SWEEPS / 2;
        if sweep == SWEEPS / 2 && solve_hard(mass, (contacts, rolling), (&v, &w), rounding_m_s) {
            return true;
        }
        let (before, mut scale) = ((v, w), f64::MIN_POSITIVE);
        for contact in contacts.iter_mut() {
            let u =
                Mass::velocity_at(&contact.lever, (&v, &w)) - contact.delassus * contact.impulse;
            let own = contact.local_impulse(&u);
            let next = if is_late { contact.impulse.lerp(&own, RELAXATION) } else { own };
            let (dv, dw) = mass.velocity_change(contact, &(next - contact.impulse));
            (v, w) = (v + dv, w + dw);
            scale = scale.max(next.norm());
            contact.impulse = next;
        }
        if rolling.is_on() {
            w += rolling.update(&mass.inverse, &w, rolling_limit(contacts));
        }
        let moved = (v - before.0).norm() + (w - before.1).norm() * reach;
        let enough = if is_late { NEARLY_SETTLED } else { SETTLED };
        if alone || moved <= (enough * scale / mass.mass).max(rounding_m_s) {
            return true;
        }
        if let Some(mixing) = mixing.as_mut().filter(|_| mixes_now) {
            let (dv, dw) = mixing.mix(mass, (&mut *contacts, &mut *rolling));
            (v, w) = (v + dv, w + dw);
        }
    }
    false
}
