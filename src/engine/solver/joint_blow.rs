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
//! Spheres and blocks, alone and in worlds, where rocks that touch each other take part, with equal and opposite forces at both ends of a contact.
//! What strikes one contact alone has a law of its own: `yielding`, and that of blocks.

use super::body::{Body, Twist};
use super::impact::{BODIES, CONTACTS, FrozenCollision, LONGEST_WAIT};
use super::loss::Loss;
use super::yielding::{BISECTIONS, MAX_CONTACT_RAD, STEP};
use crate::ground::Law;
use crate::math;
use crate::rock::Vec3;
use arrayvec::ArrayVec;
use nalgebra::Matrix3;

/// Steps at most: soft ground beside a stiff stem that stands takes many of the stem's times.
const JOINT_STEPS: u32 = 40_000;
/// Step of several rocks over that of one (–): through a row of them a blow takes many times as long, and is known as well to 1e-4 of its speed.
const OF_SEVERAL: f64 = 4.0;

/// One contact of such a blow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointContact {
    /// Unit normal into the rock, from the mesh or from another rock.
    pub(crate) n: Vec3,
    /// The rock.
    pub(crate) end: JointEnd,
    /// The other rock, if it is not the mesh.
    pub(crate) other: Option<JointEnd>,
    /// Its law, with its share of dashpots.
    pub(crate) law: Law,
    /// Whether it comes in too slowly to rebound.
    pub(crate) captured: bool,
    /// Gap that is left (m), 0 or more.
    pub(crate) gap_m: f64,
    /// The stem that is touched, if it can break.
    pub(crate) stem: Option<u32>,
}

/// The contacts of one blow.
pub(crate) type JointContacts = ArrayVec<JointContact, CONTACTS>;

/// Where a contact acts on a rock.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointEnd {
    /// Place of the rock.
    pub(crate) rock: usize,
    /// From its centre of mass to the contact point (m).
    pub(crate) lever: Vec3,
}

/// A rock before the blow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointBody {
    pub(crate) mass_kg: f64,
    /// Inverse of the inertia tensor (1/(kg m²)).
    pub(crate) inverse: Matrix3<f64>,
    /// Velocity (m/s) and spin (rad/s).
    pub(crate) motion: Twist,
}

/// A stem, and the rock to which it gives way: for another it stands.
pub(crate) type StemOfRock = (usize, u32);

/// A blow that has broken a stem, or several.
#[derive(Debug, Clone)]
pub(crate) struct Breakage {
    /// Motions with which the rocks go on, and what each contact has taken, in their order.
    pub(crate) after: FrozenCollision,
    /// The stems that are gone.
    pub(crate) stems: ArrayVec<StemOfRock, CONTACTS>,
}

/// How one contact is pressed, and what it has taken (J): by friction, in all but rolling, and by rolling.
#[derive(Debug, Clone, Copy)]
struct Pressed {
    depth_m: f64,
    shear: Vec3,
    roll: Vec3,
    taken_j: [f64; 3],
    /// Fastest approach while it stood (m/s).
    fastest_m_s: f64,
}

/// The rocks at an instant of the blow.
#[derive(Debug, Clone)]
struct Instant {
    motions: ArrayVec<Twist, BODIES>,
    pressed: ArrayVec<Pressed, CONTACTS>,
}

/// What a contact does to the rock, and with the opposite force at the same point to the other.
#[derive(Debug, Clone, Copy)]
struct Answer {
    force: Vec3,
    /// Rolling moment; the rock feels its opposite.
    rolling: Vec3,
    /// Shear force, and rates of stretch of the shear and of the rolling spring.
    shear_force: Vec3,
    shear_rate: Vec3,
    roll_rate: Vec3,
    approach_m_s: f64,
    pushes: bool,
}

/// The blow being followed.
struct JointBlow<'a> {
    bodies: &'a [JointBody],
    contacts: &'a [JointContact],
    broken: ArrayVec<StemOfRock, CONTACTS>,
}

/// Follows up to [`BODIES`] rocks through a blow on all `contacts`; `None` where no stem gives way of which `left_j` tells what it
/// can still take (J).
pub(crate) fn joint_blow(
    bodies: &[JointBody],
    contacts: &[JointContact],
    left_j: impl Fn(StemOfRock) -> f64,
) -> Option<Breakage> {
    let apart = |contact: &JointContact| Pressed {
        depth_m: -contact.gap_m,
        shear: Vec3::zeros(),
        roll: Vec3::zeros(),
        taken_j: [0.0; 3],
        fastest_m_s: 0.0,
    };
    let mut now = Instant {
        motions: bodies.iter().map(|body| body.motion).collect(),
        pressed: contacts.iter().map(apart).collect(),
    };
    let mut blow = JointBlow { bodies, contacts, broken: ArrayVec::new() };
    // through a row it runs from rock to rock
    let mut left_s = bodies.len() as f64 * MAX_CONTACT_RAD / blow.softest();
    for _ in 0..JOINT_STEPS {
        if left_s <= 0.0 {
            break;
        }
        if !blow.presses(&now) {
            let Some(next) = blow.next_touch_s(&now) else { break };
            blow.drift(&mut now, next);
            continue;
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
    (!blow.broken.is_empty()).then(|| Breakage { after: now.after(), stems: blow.broken })
}

impl Body {
    /// A sphere as a rock of a blow, with its motion (m/s, rad/s).
    pub(crate) fn joint(&self, motion: Twist) -> JointBody {
        JointBody { mass_kg: self.mass, inverse: Matrix3::identity() / self.inertia, motion }
    }
}

impl JointContact {
    /// Its stem, as the rock that it gives way to.
    fn stem_of_rock(&self) -> Option<StemOfRock> {
        self.stem.map(|stem| (self.end.rock, stem))
    }
}

impl JointBlow<'_> {
    /// Whether a contact stands.
    fn stands(&self, contact: &JointContact) -> bool {
        contact.stem_of_rock().is_none_or(|stem| !self.broken.contains(&stem))
    }

    /// The stiffest contact that touches (rad/s).
    fn stiffest(&self, at: &Instant) -> f64 {
        let parts = self.contacts.iter().zip(&at.pressed);
        let touching =
            parts.filter(|(contact, pressed)| pressed.depth_m >= 0.0 && self.stands(contact));
        touching.map(|(contact, _)| contact.law.omega_rad_s()).fold(0.0, f64::max)
    }

    /// The softest contact (rad/s).
    fn softest(&self) -> f64 {
        let omegas = self.contacts.iter().map(|contact| contact.law.omega_rad_s());
        omegas.fold(f64::INFINITY, f64::min)
    }

    /// When (s) rocks that nothing pushes touch again, and at which contact; beside a gap that stays open for longer than the softest spring is pressed the
    /// blow is over before that, as it is in [`frozen_collision`](super::impact::frozen_collision).
    fn next_touch_s(&self, at: &Instant) -> Option<(f64, usize)> {
        let waits = (0..self.contacts.len()).filter_map(|k| {
            let (contact, depth_m) = (&self.contacts[k], at.pressed[k].depth_m);
            let comes_m_s = -contact.n.dot(&at.point_m_s(contact));
            let comes = self.stands(contact) && depth_m < 0.0 && comes_m_s > 0.0;
            comes.then(|| (-depth_m / comes_m_s, k))
        });
        let next = waits.min_by(|one, other| one.0.total_cmp(&other.0))?;
        (next.0 <= LONGEST_WAIT / self.softest()).then_some(next)
    }

    /// Lets rocks that nothing pushes go on until contact `k` is touched: springs are at rest then.
    fn drift(&self, at: &mut Instant, (wait_s, k): (f64, usize)) {
        let parts_m_s: ArrayVec<f64, CONTACTS> =
            self.contacts.iter().map(|one| one.n.dot(&at.point_m_s(one))).collect();
        for (pressed, parts_m_s) in at.pressed.iter_mut().zip(parts_m_s) {
            pressed.depth_m -= parts_m_s * wait_s;
            (pressed.shear, pressed.roll) = (Vec3::zeros(), Vec3::zeros());
        }
        at.pressed[k].depth_m = 0.0;
    }

    /// Whether a stem is touched that was not `before`.
    fn comes_to_stem(&self, before: &Instant, at: &Instant) -> bool {
        let ends = before.pressed.iter().zip(&at.pressed);
        let begins = ends.map(|(from, to)| from.depth_m < 0.0 && to.depth_m >= 0.0);
        let mut parts = self.contacts.iter().zip(begins);
        parts.any(|(contact, begins)| begins && contact.stem.is_some() && self.stands(contact))
    }

    /// The next step (s): that of the stiffest contact that touches, up to where a stiffer one begins, or one with a stem: a dashpot is
    /// there at once. What is gone or has let go sets none: a soft contact would not be over after as many steps of a stiff stem as are taken at most.
    fn step_s(&self, now: &Instant) -> f64 {
        let stiffest = self.stiffest(now);
        let step = if self.bodies.len() > 1 { OF_SEVERAL * STEP } else { STEP } / stiffest;
        let is_alike = |time: f64| {
            let then = self.after(now, time);
            self.stiffest(&then) <= stiffest && !self.comes_to_stem(now, &then)
        };
        if is_alike(step) { step } else { math::bisected([0.0, step], BISECTIONS, is_alike)[1] }
    }

    /// The stem that has taken all it can, if one has.
    fn next_to_break(
        &self,
        at: &Instant,
        left_j: impl Fn(StemOfRock) -> f64,
    ) -> Option<StemOfRock> {
        let standing = self.contacts.iter().filter(|contact| self.stands(contact));
        standing.filter_map(JointContact::stem_of_rock).find(|&stem| {
            let parts = self.contacts.iter().zip(&at.pressed);
            let own = parts.filter(|(contact, _)| contact.stem_of_rock() == Some(stem));
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
        let spin = at.motions[contact.end.rock].1;
        let rolling = law.rolling.at_rate(pressed.roll, spin, law.rolling.cap(push));
        Answer {
            force: n * push - shear.force,
            rolling: rolling.force,
            shear_force: shear.force,
            shear_rate: shear.stretch_rate,
            roll_rate: rolling.stretch_rate,
            approach_m_s: if is_in { -up } else { 0.0 },
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
        let answers: ArrayVec<Answer, CONTACTS> =
            (0..self.contacts.len()).map(|k| self.answer(k, there)).collect();
        let mut next = from.clone();
        for (contact, answer) in self.contacts.iter().zip(&answers) {
            let JointEnd { rock, lever } = contact.end;
            let moment = lever.cross(&answer.force) - answer.rolling;
            self.push(&mut next, rock, (answer.force * h, moment * h));
            if let Some(JointEnd { rock, lever }) = contact.other {
                self.push(&mut next, rock, (-answer.force * h, -lever.cross(&answer.force) * h));
            }
        }
        let means = from.motions.iter().zip(&next.motions);
        let motions = means.map(|(a, b)| ((a.0 + b.0) * 0.5, (a.1 + b.1) * 0.5)).collect();
        let mean = Instant { motions, pressed: ArrayVec::new() };
        for ((contact, answer), pressed) in
            self.contacts.iter().zip(&answers).zip(&mut next.pressed)
        {
            let u = mean.point_m_s(contact);
            pressed.depth_m -= contact.n.dot(&there.point_m_s(contact)) * h;
            pressed.shear += answer.shear_rate * h;
            pressed.roll += answer.roll_rate * h;
            pressed.fastest_m_s = pressed.fastest_m_s.max(answer.approach_m_s);
            let slips = u - contact.n * contact.n.dot(&u) - answer.shear_rate;
            let friction_j = answer.shear_force.dot(&slips) * h;
            pressed.taken_j[0] += friction_j;
            pressed.taken_j[1] -= answer.force.dot(&u) * h + friction_j;
            pressed.taken_j[2] += answer.rolling.dot(&mean.motions[contact.end.rock].1) * h;
        }
        next
    }

    /// An impulse (N s) and its moment (N m s) on a rock.
    fn push(&self, at: &mut Instant, rock: usize, (impulse, moment): (Vec3, Vec3)) {
        let JointBody { mass_kg, inverse, .. } = &self.bodies[rock];
        let (v, w) = &mut at.motions[rock];
        *v += impulse / *mass_kg;
        *w += inverse * moment;
    }
}

impl Instant {
    /// Velocity of the point of a contact (m/s), relative to the other rock if there is one.
    fn point_m_s(&self, contact: &JointContact) -> Vec3 {
        let of = |JointEnd { rock, lever }: JointEnd| {
            let (v, w) = &self.motions[rock];
            v + w.cross(&lever)
        };
        of(contact.end) - contact.other.map_or_else(Vec3::zeros, of)
    }

    /// The motions, and what the contacts have taken.
    fn after(&self) -> FrozenCollision {
        let mut after = FrozenCollision::STILL;
        after.motions[..self.motions.len()].copy_from_slice(&self.motions);
        for (k, pressed) in self.pressed.iter().enumerate() {
            after.loss[k] = Loss::redistributed(pressed.taken_j);
            after.fastest_m_s[k] = pressed.fastest_m_s;
        }
        after
    }
}

#[cfg(test)]
mod tests;
