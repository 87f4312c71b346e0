//! A blow on several contacts at once of which some are with stems that give way, in the limit of stiff springs.
//!
//! In that limit normals and levers stay what they are, and springs, dashpots and sliders of all contacts are followed in the blow's own time:
//!
//! ```text
//! x_k' = −n_k·u_k,   u_k = v + ω × a_k,   m v' = Σ f_k,   I ω' = Σ a_k × f_k − M_k
//! ```
//!
//! What a contact has taken is the work of its impulses with the mean of the motions before and after, which adds up to what the motion has
//! lost. So stems that are struck at once share a blow as their springs hold it, and what a stem takes acts through all its contacts. A stem
//! that has taken all it can is gone, with what its springs held, and the blow goes on against what stands until nothing presses.
//!
//! Spheres and blocks, alone and in worlds. What strikes one contact alone has a law of its own: `yielding`, and that of blocks.

use super::body::Twist;
use super::loss::Loss;
use super::yielding::{BISECTIONS, COMES_OFF, STEP};
use crate::contact::block::MOST_TOUCHES;
use crate::ground::Law;
use crate::math;
use crate::rock::Vec3;
use arrayvec::ArrayVec;
use nalgebra::Matrix3;

/// Steps at most: soft ground beside a stiff stem that stands takes many of the stem's times.
const JOINT_STEPS: u32 = 40_000;

/// One contact of such a blow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointContact {
    /// Unit normal from the mesh into the rock.
    pub(crate) n: Vec3,
    /// From the centre of mass to the contact point (m).
    pub(crate) lever: Vec3,
    /// Its law, with its share of dashpots.
    pub(crate) law: Law,
    /// Whether it comes in too slowly to rebound.
    pub(crate) captured: bool,
    /// The stem that is touched, if it can break.
    pub(crate) stem: Option<u32>,
}

/// The contacts of one blow.
pub(crate) type JointContacts = ArrayVec<JointContact, MOST_TOUCHES>;

/// Mass (kg) and inverse of the inertia tensor (1/(kg m²)) of what strikes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointBody {
    pub(crate) mass_kg: f64,
    pub(crate) inverse: Matrix3<f64>,
}

/// A blow that has broken a stem, or several.
#[derive(Debug, Clone)]
pub(crate) struct JointEnd {
    /// Velocity (m/s) and spin (rad/s) with which the rock goes on.
    pub(crate) motion: Twist,
    /// What each contact has taken, in their order.
    pub(crate) taken: ArrayVec<Loss, MOST_TOUCHES>,
    /// The stems that are gone.
    pub(crate) broken: ArrayVec<u32, MOST_TOUCHES>,
}

/// How one contact is pressed, and what it has taken (J): by friction, in all but rolling, and by rolling.
#[derive(Debug, Clone, Copy)]
struct Pressed {
    depth_m: f64,
    shear: Vec3,
    roll: Vec3,
    taken_j: [f64; 3],
}

/// The rock at an instant of the blow.
#[derive(Debug, Clone)]
struct Instant {
    v: Vec3,
    w: Vec3,
    pressed: ArrayVec<Pressed, MOST_TOUCHES>,
}

/// What a contact does to the rock.
#[derive(Debug, Clone, Copy)]
struct Answer {
    force: Vec3,
    moment: Vec3,
    /// Shear force, and rates of stretch of the shear and of the rolling spring.
    shear_force: Vec3,
    shear_rate: Vec3,
    roll_rate: Vec3,
    pushes: bool,
}

/// The blow being followed.
struct JointBlow<'a> {
    body: &'a JointBody,
    contacts: &'a [JointContact],
    broken: ArrayVec<u32, MOST_TOUCHES>,
}

/// Follows a body with this velocity (m/s) and spin (rad/s) through a blow on all `contacts`; `None` where no stem gives way of
/// which `left_j` tells what it can still take (J).
pub(crate) fn joint_blow(
    body: &JointBody,
    contacts: &[JointContact],
    (v, w): Twist,
    left_j: impl Fn(u32) -> f64,
) -> Option<JointEnd> {
    let none =
        Pressed { depth_m: 0.0, shear: Vec3::zeros(), roll: Vec3::zeros(), taken_j: [0.0; 3] };
    let mut now = Instant { v, w, pressed: contacts.iter().map(|_| none).collect() };
    let mut blow = JointBlow { body, contacts, broken: ArrayVec::new() };
    let omegas = contacts.iter().map(|contact| contact.law.omega_rad_s());
    let mut left_s = COMES_OFF / omegas.fold(f64::INFINITY, f64::min);
    for _ in 0..JOINT_STEPS {
        if left_s <= 0.0 || !blow.presses(&now) {
            break;
        }
        let step = blow.step_s(&now);
        left_s -= step;
        let next = blow.after(&now, step);
        if blow.next_to_break(&next, &left_j).is_none() {
            now = next;
            continue;
        }
        let stands = |time: f64| blow.next_to_break(&blow.after(&now, time), &left_j).is_none();
        let [_, yields] = math::bisected([0.0, step], BISECTIONS, stands);
        now = blow.after(&now, yields);
        blow.broken.extend(blow.next_to_break(&now, &left_j));
    }
    let taken = now.pressed.iter().map(|one| Loss::sharing(one.taken_j)).collect();
    (!blow.broken.is_empty()).then_some(JointEnd {
        motion: (now.v, now.w),
        taken,
        broken: blow.broken,
    })
}

impl JointBlow<'_> {
    /// Whether a contact stands.
    fn stands(&self, contact: &JointContact) -> bool {
        contact.stem.is_none_or(|stem| !self.broken.contains(&stem))
    }

    /// The stiffest contact that touches (rad/s).
    fn stiffest(&self, at: &Instant) -> f64 {
        let parts = self.contacts.iter().zip(&at.pressed);
        let touching =
            parts.filter(|(contact, pressed)| pressed.depth_m >= 0.0 && self.stands(contact));
        touching.map(|(contact, _)| contact.law.omega_rad_s()).fold(0.0, f64::max)
    }

    /// The next step (s): that of the stiffest contact that touches, up to where a stiffer one begins. What is gone or has let go sets none: a soft
    /// contact would not be over after as many steps of a stiff stem as are taken at most.
    fn step_s(&self, now: &Instant) -> f64 {
        let stiffest = self.stiffest(now);
        let step = STEP / stiffest;
        let is_alike = |time: f64| self.stiffest(&self.after(now, time)) <= stiffest;
        if is_alike(step) { step } else { math::bisected([0.0, step], BISECTIONS, is_alike)[1] }
    }

    /// The stem that has taken all it can, if one has.
    fn next_to_break(&self, at: &Instant, left_j: impl Fn(u32) -> f64) -> Option<u32> {
        let standing = self.contacts.iter().filter(|contact| self.stands(contact));
        standing.filter_map(|contact| contact.stem).find(|&stem| {
            let parts = self.contacts.iter().zip(&at.pressed);
            let own = parts.filter(|(contact, _)| contact.stem == Some(stem));
            own.flat_map(|(_, pressed)| pressed.taken_j).sum::<f64>() >= left_j(stem)
        })
    }

    /// What contact `k` does.
    fn answer(&self, k: usize, at: &Instant) -> Answer {
        let (contact, pressed) = (&self.contacts[k], &at.pressed[k]);
        let (law, n) = (&contact.law, &contact.n);
        let u = at.point_m_s(contact);
        let (up, is_in) = (n.dot(&u), pressed.depth_m >= 0.0 && self.stands(contact));
        let normal = law.normal(contact.captured);
        let push = if is_in { normal.force(pressed.depth_m, up) } else { 0.0 };
        let shear = law.shear.at_rate(pressed.shear, u - n * up, law.shear.cap(push));
        let rolling = law.rolling.at_rate(pressed.roll, at.w, law.rolling.cap(push));
        let force = n * push - shear.force;
        Answer {
            force,
            moment: contact.lever.cross(&force) - rolling.force,
            shear_force: shear.force,
            shear_rate: shear.stretch_rate,
            roll_rate: rolling.stretch_rate,
            pushes: is_in && (up < 0.0 || push > 0.0),
        }
    }

    /// Whether something is on its way in, or pushes.
    fn presses(&self, at: &Instant) -> bool {
        (0..self.contacts.len()).any(|k| self.answer(k, at).pushes)
    }

    /// After `h` (s), by a step through the middle.
    fn after(&self, from: &Instant, h: f64) -> Instant {
        let middle = self.moved(from, from, 0.5 * h);
        self.moved(from, &middle, h)
    }

    /// Gone on for `h` (s) at the rates of `there`.
    fn moved(&self, from: &Instant, there: &Instant, h: f64) -> Instant {
        let answers: ArrayVec<Answer, MOST_TOUCHES> =
            (0..self.contacts.len()).map(|k| self.answer(k, there)).collect();
        let force: Vec3 = answers.iter().map(|answer| answer.force).sum();
        let moment: Vec3 = answers.iter().map(|answer| answer.moment).sum();
        let mut next = from.clone();
        next.v += force * (h / self.body.mass_kg);
        next.w += self.body.inverse * moment * h;
        let mean = Instant {
            v: (from.v + next.v) * 0.5,
            w: (from.w + next.w) * 0.5,
            pressed: ArrayVec::new(),
        };
        for ((contact, answer), pressed) in
            self.contacts.iter().zip(&answers).zip(&mut next.pressed)
        {
            let u = mean.point_m_s(contact);
            pressed.depth_m -= contact.n.dot(&there.point_m_s(contact)) * h;
            pressed.shear += answer.shear_rate * h;
            pressed.roll += answer.roll_rate * h;
            let slips = u - contact.n * contact.n.dot(&u) - answer.shear_rate;
            let friction_j = answer.shear_force.dot(&slips) * h;
            let rolling_j = (contact.lever.cross(&answer.force) - answer.moment).dot(&mean.w) * h;
            pressed.taken_j[0] += friction_j;
            pressed.taken_j[1] -= answer.force.dot(&u) * h + friction_j;
            pressed.taken_j[2] += rolling_j;
        }
        next
    }
}

impl Instant {
    /// Velocity of the point of a contact (m/s).
    fn point_m_s(&self, contact: &JointContact) -> Vec3 {
        self.v + self.w.cross(&contact.lever)
    }
}

#[cfg(test)]
mod tests;
