//! The limit of stiff springs: impacts of frozen geometry.
//!
//! ```text
//! c' = v,   v' = Σ (F n − q)/m,   R ω' = (m R²/I) Σ (n × q − M/R)/m
//! F = max(0, k x + c x'),   x = −n·c
//! ```
//!
//! in units of mass, `|v|`, `R` and `1/ω` of the stiffest contact; normals are fixed, so `x` is
//! linear in the displacement.
//!
//! Ratios of stiffness stay constant as `p_N` grows, and with them the outcome: the limit itself is
//! computed, not a large stiffness. The penetration goes to 0 in it, so weight, the rotation of
//! normals and the duration of the impact have no effect.

mod bodies;
mod contacts;
mod rates;
mod unchanged_motion;

use super::dormand_prince::{Attempt, Stages, add_sums, growth};
use super::plane::{LOCAL_ERROR, Plane};
use super::{ImpactEffort, ImpactOutcome, StepLength};
use crate::contact::MAX_CONTACTS;
use crate::ground::Law;
use crate::math;
use crate::rock::Vec3;
use crate::solver::body::{Body, STILL, Twist};
use crate::solver::loss::{Loss, scale_to_total};
pub(crate) use bodies::{
    BODIES, CONTACTS, FrozenCollision, frozen_collision, largest_followed_ratio,
};
use contacts::{AfterImpact, SwitchTime};
use rates::ContactRates;
use std::f64::consts::TAU;
use unchanged_motion::UnchangedMotion;

/// One contact of a frozen impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrozenContact<'a> {
    /// Unit normal from the ground into the rock.
    pub(crate) normal: Vec3,
    /// Law of its ground.
    pub(crate) law: &'a Law,
    /// Normal stiffness over `p_N` (–): `|a|²` of a patch.
    pub(crate) stiffness_scale: f64,
    /// Whether it does not rebound.
    pub(crate) captured: bool,
    /// Gap (m) at the start of the impact, ≥ 0: springs that are compressed for long enough close
    /// it. Of several bodies only.
    pub(crate) gap_m: f64,
    /// The bodies that it joins.
    pub(crate) ends: ContactEnds,
}

/// The bodies that a contact of a frozen impact joins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactEnds {
    /// Index of the body into which its normal points.
    pub(crate) first: usize,
    /// Index of the other body, `None` for the mesh.
    pub(crate) second: Option<usize>,
    /// Distances from their centres to the common contact point, over their radii (–).
    pub(crate) levers: [f64; 2],
}

impl ContactEnds {
    /// The first body and the mesh.
    pub(crate) const MESH: Self = Self { first: 0, second: None, levers: [1.0; 2] };

    /// Effective mass (kg): that of a body, or the reduced mass of two.
    fn effective_mass_kg(&self, bodies: &[FrozenBody]) -> f64 {
        let mass_kg = |k: usize| bodies[k].body.mass;
        match self.second {
            Some(second) => 1.0 / (1.0 / mass_kg(self.first) + 1.0 / mass_kg(second)),
            None => mass_kg(self.first),
        }
    }

    /// Whether two contacts are of one body with the mesh: they share their dashpots.
    fn shares_with(&self, other: &Self) -> bool {
        self.second.is_none() && other.second.is_none() && self.first == other.first
    }
}

/// A body before a frozen impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrozenBody {
    /// Mass, inertia, radius.
    pub(crate) body: Body,
    /// Velocity (m/s) and spin (rad/s).
    pub(crate) motion: Twist,
}

impl FrozenBody {
    /// Its velocity, and its spin times its radius, in units of `speed` (m/s).
    fn in_units(&self, speed: f64) -> Twist {
        (self.motion.0 / speed, self.motion.1 * (self.body.radius / speed))
    }

    /// The same back from these units.
    fn out_of_units(&self, (v, w): Twist, speed: f64) -> Twist {
        (v * speed, w * (speed / self.body.radius))
    }
}

impl FrozenContact<'_> {
    /// No contact.
    pub(crate) const fn none() -> Self {
        Self {
            normal: Vec3::new(0.0, 0.0, 0.0),
            law: &Law::NONE,
            stiffness_scale: 1.0,
            captured: true,
            gap_m: 0.0,
            ends: ContactEnds::MESH,
        }
    }
}

/// Motion after a frozen impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrozenRebound {
    /// Velocity (m/s).
    pub(crate) velocity_m_s: Vec3,
    /// Spin (rad/s).
    pub(crate) spin_rad_s: Vec3,
    /// Energy lost (J) by contact and kind, each ≥ 0: together exactly the energy before less that
    /// after.
    pub(crate) loss: [Loss; MAX_CONTACTS],
    /// How it ended.
    pub(crate) settled: ImpactOutcome,
    /// What it cost.
    pub(crate) effort: ImpactEffort,
}

/// Tolerance of a single contact over that of several (–): it is cheap.
const SINGLE_TOLERANCE: f64 = 0.5;
/// First step at a tolerance of 1 (radians of the stiffest contact): the local error of order 5 is
/// about (h/this)⁵.
const FIRST_STEP: f64 = 3.5;
/// Longest step (radians of the stiffest contact).
const LONGEST_STEP: f64 = 0.9;
/// A step up to this is not cut at a switching point (radians).
const SHORTEST_CUT: f64 = 1e-9;
/// An approach slower than this share of the allowed error is zero (–).
pub(in crate::solver) const NEGLIGIBLE: f64 = 1e-3;
/// Radians of the slowest oscillation, that of the heaviest body on the softest contact, after
/// which an impact is ended, flights between contacts not counted: rattling between walls has no
/// other end.
const MOST_TIME: f64 = 300.0;
/// Longest flight to a gap that closes within an impact, in radians of the softest contact: a
/// contact that has opened counts as near for as long again as it was closed.
pub(crate) const LONGEST_WAIT: f64 = TAU;
/// A rock whose motion changes by at most this number of allowed errors over a period of the
/// softest contact is jammed (–).
const JAMMED_ERRORS: f64 = 3.0;
/// Steps after which an impact is ended.
const MOST_STEPS: u32 = 20_000;

/// Integrates the impact of one rock with velocity `v` (m/s) and spin `w` (rad/s) on all `contacts`
/// (1 … [`MAX_CONTACTS`]) at once, each of them at penetration zero; `tolerance` is relative to `|v|` (–).
///
/// # Panics
/// Never: contacts beyond [`MAX_CONTACTS`] are ignored.
///
/// Cost: one contact is a closed form and a short integration; several are followed step by step.
pub(crate) fn frozen_impact(
    body: &Body,
    contacts: &[FrozenContact],
    (v, w): (&Vec3, &Vec3),
    tolerance: f64,
) -> FrozenRebound {
    const N: usize = MAX_CONTACTS;
    let contacts = &contacts[..contacts.len().min(N)];
    let same = FrozenRebound {
        velocity_m_s: *v,
        spin_rad_s: *w,
        loss: [Loss::default(); MAX_CONTACTS],
        settled: ImpactOutcome::Free,
        effort: ImpactEffort::default(),
    };
    // no contact closes: no impact
    if contacts.iter().all(|contact| contact.normal.dot(v) >= 0.0) {
        return same;
    }
    if let [contact] = contacts {
        return single_contact(body, contact, (v, w), tolerance, same);
    }
    let rolls = contacts.iter().any(|contact| contact.law.rolling.is_on());
    let how = (body, contacts, tolerance);
    // the numbers of contacts and springs are constants: arrays on the stack
    match (contacts.len(), rolls) {
        (2, false) => several_contacts::<2, 15, 8, 6>(how, (v, w), same),
        (2, true) => several_contacts::<2, 21, 8, 6>(how, (v, w), same),
        (3, false) => several_contacts::<3, 18, 12, 9>(how, (v, w), same),
        (3, true) => several_contacts::<3, 27, 12, 9>(how, (v, w), same),
        (4, false) => several_contacts::<4, 21, 16, 12>(how, (v, w), same),
        (4, true) => several_contacts::<4, 33, 16, 12>(how, (v, w), same),
        _ => several_contacts::<
            MAX_CONTACTS,
            { 9 + 6 * MAX_CONTACTS },
            { 4 * MAX_CONTACTS },
            { 3 * MAX_CONTACTS },
        >(how, (v, w), same),
    }
}

/// One contact: the impact on a plane without weight.
fn single_contact(
    body: &Body,
    contact: &FrozenContact,
    (v, w): (&Vec3, &Vec3),
    tolerance: f64,
    mut end: FrozenRebound,
) -> FrozenRebound {
    let body = Body { gravity: Vec3::zeros(), ..*body };
    let (law, n) = (contact.law, &contact.normal);
    // a captured contact is damped over critical, and its remaining rebound is removed below
    let point = (contact.captured, contact.stiffness_scale);
    let plane = Plane::of_patch(&body, law, point, SINGLE_TOLERANCE * tolerance);
    let Some(rebound) = plane.follow(n, v, w) else {
        // Without weight nothing keeps it but a speed too small to be squared.
        end.velocity_m_s -= n * n.dot(v);
        return end;
    };
    (end.velocity_m_s, end.spin_rad_s) = (rebound.velocity_m_s, rebound.spin_rad_s);
    (end.loss[0], end.effort) = (rebound.loss, rebound.effort);
    if contact.captured {
        let up = n.dot(&end.velocity_m_s);
        end.velocity_m_s -= n * up;
        end.loss[0].damping += 0.5 * body.mass * up * up;
    }
    end
}

/// Several contacts; at most `K` of them, `N` state variables, `Q` quadratures, `P` switching
/// functions.
fn several_contacts<const K: usize, const N: usize, const Q: usize, const P: usize>(
    (body, contacts, tolerance): (&Body, &[FrozenContact], f64),
    (v, w): (&Vec3, &Vec3),
    mut end: FrozenRebound,
) -> FrozenRebound {
    // |v| is the unit of speed: the tolerance is relative to it
    let speed = v.norm();
    let bodies = [FrozenBody { body: *body, motion: (*v, *w) }];
    let mut run = ImpactRun::<1, K, N, Q, P>::new((&bodies, contacts), speed, tolerance);
    let [start] = run.motions();
    end.settled = run.follow(tolerance);
    end.effort = run.effort;
    let [place] = run.motions();
    let AfterImpact { motions: [place], plastic } =
        run.flow.contacts.finish(start, place, run.flow.negligible());
    // exact energy of the impact; the quadratures only distribute it
    let lost = run.flow.contacts.energy(0, start) - run.flow.contacts.energy(0, place);
    let loss_j = run.loss_j(lost.max(0.0) * (body.mass * speed * speed), plastic);
    end.loss[..K].copy_from_slice(&loss_j);
    (end.velocity_m_s, end.spin_rad_s) = bodies[0].out_of_units(place, speed);
    end
}

/// An impact during its integration.
struct ImpactRun<const B: usize, const K: usize, const N: usize, const Q: usize, const P: usize> {
    flow: ContactRates<B, K>,
    y: [f64; N],
    sums: [f64; Q],
    effort: ImpactEffort,
}

impl<const B: usize, const K: usize, const N: usize, const Q: usize, const P: usize>
    ImpactRun<B, K, N, Q, P>
{
    /// At first contact, with `speed` (m/s) as the unit.
    fn new(
        (bodies, contacts): (&[FrozenBody], &[FrozenContact]),
        speed: f64,
        tolerance: f64,
    ) -> Self {
        let motion = |k: usize| bodies.get(k).map_or(STILL, |body| body.in_units(speed));
        Self {
            flow: ContactRates::new((bodies, contacts), speed, LOCAL_ERROR * tolerance),
            y: rates::initial_state(&std::array::from_fn::<_, B, _>(motion)),
            sums: [0.0; Q],
            effort: ImpactEffort::default(),
        }
    }

    /// Steps until no contact pushes and none closes.
    ///
    /// A rock may fly between the contacts of one impact (a wedge): a closed form at no cost.
    fn follow(&mut self, tolerance: f64) -> ImpactOutcome {
        let (mut step, mut time) = (StepLength::new(FIRST_STEP * math::pow(tolerance, 0.2)), 0.0);
        let softest = self.flow.contacts.softest;
        let (most, mut unchanged) =
            (MOST_TIME / self.flow.contacts.lowest_frequency(), UnchangedMotion::<B>::NONE);
        // Whether the set of closed contacts has been switched without a step: once is enough.
        let mut switched = false;
        self.flow.update_pressed(&mut self.y);
        let mut stages = Stages::<N, Q, P>::NONE;
        self.flow.rates_of(&self.y, stages.first());
        loop {
            self.record_approaches();
            if time > most || self.effort.steps + self.effort.rejected > MOST_STEPS {
                return ImpactOutcome::OutOfTime;
            }
            if self.flow.is_free(&self.y) {
                let Some(wait) = self.flow.next_touch(&self.y) else { return ImpactOutcome::Free };
                // Exact and free of cost: its time is not counted.
                self.flow.drift(&mut self.y, wait);
                self.effort.steps += 1;
                self.flow.rates_of(&self.y, stages.first());
                continue;
            }
            if unchanged.unchanged_for(&self.motions(), time, JAMMED_ERRORS * self.flow.allowed)
                > TAU / softest
            {
                return ImpactOutcome::Jammed;
            }
            let h = step.wish.min(self.flow.longest);
            let felt = (h > SHORTEST_CUT).then_some(self.flow.allowed);
            let tried = match stages.step(&mut self.flow, &self.y, h, felt) {
                Attempt::Whole(tried) if tried.error2 <= 1.0 => tried,
                Attempt::Whole(tried) => {
                    self.effort.rejected += 1;
                    step.shrink(h * growth(tried.error2).min(0.7));
                    continue;
                }
                Attempt::Cut(share) => {
                    self.effort.rejected += 1;
                    step.cut(h, share);
                    continue;
                }
            };
            // a contact that opens or closes within the step ends it: dashpots are shared anew
            // among the closed contacts
            match self.flow.crossing(&self.y, &tried.y, h) {
                Some(SwitchTime::Now) if !switched => {
                    switched = true;
                    self.flow.rates_of(&self.y, stages.first());
                }
                Some(SwitchTime::At(share)) => {
                    self.effort.rejected += 1;
                    step.cut(h, share);
                }
                _ => {
                    switched = false;
                    self.y = tried.y;
                    add_sums(&mut self.sums, &tried.q);
                    time += h;
                    self.effort.steps += 1;
                    step.grow(h * growth(tried.error2));
                    if self.flow.update_pressed(&mut self.y) {
                        self.flow.rates_of(&self.y, stages.first());
                    } else {
                        stages.reuse_last();
                    }
                }
            }
        }
    }

    /// Velocities, and spins times radius.
    fn motions(&self) -> [Twist; B] {
        std::array::from_fn(|k| {
            (rates::velocity_of::<B, N>(&self.y, k), rates::spin_of::<B, N>(&self.y, k))
        })
    }

    /// Records the approach speeds of the closed contacts. The fastest approach of each decides how
    /// much of it restitution may return.
    fn record_approaches(&mut self) {
        let (y, contacts) = (&self.y, &mut self.flow.contacts);
        for k in 0..contacts.list().len() {
            if self.flow.pressed[k] {
                let approach = -contacts.separation(k, |k| rates::velocity_of::<B, N>(y, k));
                contacts.fastest[k] = contacts.fastest[k].max(approach);
            }
        }
    }

    /// Distributes a loss (J) over the contacts by the quadratures of friction, dashpots and
    /// rolling, and by the energy that captured contacts absorbed at the end.
    fn loss_j(&self, lost_j: f64, plastic: [f64; K]) -> [Loss; K] {
        let mut parts = [[0.0; 3]; K];
        for ((part, sums), plastic) in parts.iter_mut().zip(self.sums.chunks(4)).zip(plastic) {
            // none below 0: the integration error may make a small one negative
            let [slipping, shear, rolling, normal] = [sums[0], sums[1], sums[2], sums[3]];
            let slipping = slipping.max(0.0);
            let damping = (shear - slipping).max(0.0) + normal.max(0.0);
            *part = [slipping, damping + plastic, rolling.max(0.0)];
        }
        scale_to_total(lost_j, parts.as_flattened_mut());
        parts.map(Loss::on_slope)
    }
}
