//! Rates of a rock with several frozen contacts, and the times at which contacts open and close.
//!
//! A contact is closed from the time at which its penetration is 0 and growing until its force
//! would become tensile. Where that changes the dashpots are shared anew, so steps end there and
//! rates are smooth in between.

use super::contacts::{ImpactContact, ImpactContacts, SwitchTime};
use super::{ContactEnds, FrozenBody, FrozenContact, LONGEST_STEP, LONGEST_WAIT, NEGLIGIBLE};
use crate::math;
use crate::rock::Vec3;
use crate::solver::body::Twist;
use crate::solver::impact::dormand_prince::{Flow, Rates, put_vec3, vec3_at};

/// Offset of the displacements of the centres, body by body; velocities, spins times radius and the
/// springs follow.
const DISPLACEMENT: usize = 0;

/// Velocity of body `k` of `B`.
pub(super) fn velocity_of<const B: usize, const N: usize>(y: &[f64; N], k: usize) -> Vec3 {
    vec3_at(y, 3 * (B + k))
}

/// Its spin times radius.
pub(super) fn spin_of<const B: usize, const N: usize>(y: &[f64; N], k: usize) -> Vec3 {
    vec3_at(y, 3 * (2 * B + k))
}

/// The state at the start of an impact.
pub(super) fn initial_state<const B: usize, const N: usize>(motions: &[Twist; B]) -> [f64; N] {
    let mut y = [0.0; N];
    for (k, (v, w)) in motions.iter().enumerate() {
        put_vec3(&mut y, 3 * (B + k), v);
        put_vec3(&mut y, 3 * (2 * B + k), w);
    }
    y
}

/// Up to `K` contacts of `B` bodies, and which of them are closed. `K` is the room for contacts;
/// the state has `N = 9 B + 3 K` variables without rolling, `9 B + 6 K` with.
pub(super) struct ContactRates<const B: usize, const K: usize> {
    pub(super) contacts: ImpactContacts<B, K>,
    pub(super) pressed: [bool; K],
    /// Normal damping of each with the present closed contacts.
    damping: [f64; K],
    /// Longest step.
    ///
    /// In radians of the stiffest contact; shorter if a dashpot is so strong that it, and not the
    /// spring, sets the fastest rate; for several bodies longer if only soft contacts are closed.
    pub(super) longest: f64,
    /// Local error allowed.
    pub(super) allowed: f64,
}

impl<const B: usize, const K: usize> ContactRates<B, K> {
    /// Offset of the springs: shear of all `K` contacts, then rolling of all, three variables each.
    const SPRINGS: usize = 9 * B;

    /// `speed` (m/s) is the unit of speed.
    pub(super) fn new(
        (bodies, struck): (&[FrozenBody], &[FrozenContact]),
        speed: f64,
        allowed: f64,
    ) -> Self {
        let contacts = ImpactContacts::new(bodies, struck, speed);
        let fastest =
            contacts.list().iter().fold(1.0f64, |rate, contact| rate.max(contact.damping));
        Self {
            contacts,
            // All of them at penetration zero: those that close act at once.
            pressed: [false; K],
            damping: [0.0; K],
            longest: LONGEST_STEP / fastest,
            allowed,
        }
    }

    /// Speed, and length, that counts as zero. It is far below the allowed error: anything less is
    /// neither a contact nor a separation.
    pub(super) fn negligible(&self) -> f64 {
        NEGLIGIBLE * self.allowed
    }

    /// Penetration of contact `k` and its rate.
    /// `x = −n·way − gap`, `x' = −n·v`: at first contact the displacement is 0.
    fn depth<const N: usize>(&self, k: usize, y: &[f64; N]) -> [f64; 2] {
        let way = |k: usize| vec3_at(y, DISPLACEMENT + 3 * k);
        let gap = if B > 1 { self.contacts.list()[k].gap } else { 0.0 };
        [
            -self.contacts.separation(k, way) - gap,
            -self.contacts.separation(k, |k| velocity_of::<B, N>(y, k)),
        ]
    }

    /// Whether contact `k` is open and closes: if the impact ends before it closes, that contact
    /// belongs to the next impact.
    pub(super) fn approaches_again<const N: usize>(&self, k: usize, y: &[f64; N]) -> bool {
        let [x, rate] = self.depth(k, y);
        x < -self.negligible() && rate > self.negligible()
    }

    /// Whether contact `k` had a gap and still has one: its closing is beyond this impact.
    pub(super) fn is_apart<const N: usize>(&self, k: usize, y: &[f64; N]) -> bool {
        let has_gap = B > 1 && self.contacts.list()[k].gap > 0.0;
        has_gap && self.depth(k, y)[0] < -self.negligible()
    }

    /// Updates which contacts are closed and shares the dashpots among them; springs of contacts
    /// that have opened are unloaded. Returns whether anything has changed.
    pub(super) fn update_pressed<const N: usize>(&mut self, y: &mut [f64; N]) -> bool {
        let (negligible, mut changed) = (self.negligible(), false);
        for k in 0..self.contacts.list().len() {
            let [x, rate] = self.depth(k, y);
            // penetrating, or at the surface and not separating: a tolerance on both sides keeps
            // rounding from opening and closing it without end
            let pressed = x > negligible || (x >= -negligible && rate > -negligible);
            changed |= pressed != self.pressed[k];
            self.set_pressed(k, pressed, y);
        }
        if changed {
            self.share_dashpots();
        }
        changed
    }

    /// A contact that opens unloads its springs: their energy was lost when it opened.
    fn set_pressed<const N: usize>(&mut self, k: usize, pressed: bool, y: &mut [f64; N]) {
        self.pressed[k] = pressed;
        if !pressed {
            y[Self::SPRINGS + 3 * k..Self::SPRINGS + 3 * k + 3].fill(0.0);
            if N > Self::SPRINGS + 3 * K {
                let at = Self::SPRINGS + 3 * (K + k);
                y[at..at + 3].fill(0.0);
            }
        }
    }

    /// `c_i = c_N/√Σ max(0, n_i·n_j)²` over the closed contacts of one body with the mesh.
    fn share_dashpots(&mut self) {
        let list = self.contacts.list();
        for (k, contact) in list.iter().enumerate() {
            let others = list.iter().zip(self.pressed).filter(|(other, pressed)| {
                *pressed && (B == 1 || contact.ends.shares_with(&other.ends))
            });
            // itself included if it is closed: a single contact keeps its dashpot
            let sum: f64 = others.map(|(other, _)| contact.n.dot(&other.n).max(0.0).powi(2)).sum();
            self.damping[k] = contact.damping / sum.max(1.0).sqrt();
        }
        if B > 1 {
            self.longest = LONGEST_STEP / self.fastest_rate();
        }
    }

    /// Fastest rate of the closed contacts (rad of the stiffest contact): a stiff contact that is
    /// open does not limit the step.
    fn fastest_rate(&self) -> f64 {
        let pressed = self.contacts.list().iter().zip(self.pressed).filter(|(_, pressed)| *pressed);
        let rates = pressed.map(|(contact, _)| contact.stiffness.sqrt().max(contact.damping));
        rates.reduce(f64::max).unwrap_or(1.0)
    }

    /// Normal force of contact `k` without the limit to compression.
    #[inline]
    fn signed_force<const N: usize>(&self, k: usize, y: &[f64; N]) -> f64 {
        let [x, rate] = self.depth(k, y);
        self.contacts.list()[k].stiffness * x + self.damping[k] * rate
    }

    /// Whether no contact pushes.
    pub(super) fn is_free<const N: usize>(&self, y: &[f64; N]) -> bool {
        let negligible = self.negligible() * self.negligible();
        // open, or separating with a force that would pull, or at rest at the surface
        (0..self.contacts.list().len()).all(|k| {
            let [x, rate] = self.depth(k, y);
            !self.pressed[k]
                || (self.signed_force(k, y) <= negligible && rate <= 0.0)
                || (x.abs() <= self.negligible() && rate.abs() <= self.negligible())
        })
    }

    /// Time until a free rock touches again, if it does; next to a gap that stays open for longer
    /// than the softest spring is compressed the impact is over before that. Without weight a free
    /// rock moves on a straight line: `−x/x'`.
    pub(super) fn next_touch<const N: usize>(&self, y: &[f64; N]) -> Option<f64> {
        let negligible = self.negligible();
        let waits = (0..self.contacts.list().len()).filter_map(|k| {
            let [x, rate] = self.depth(k, y);
            (rate > negligible).then(|| ((-x / rate).max(0.0), k))
        });
        let (wait, k) = waits.min_by(|one, other| one.0.total_cmp(&other.0))?;
        (!self.is_apart(k, y) || wait <= LONGEST_WAIT / self.contacts.softest).then_some(wait)
    }

    /// Moves a free rock for `wait`. Springs are unloaded in flight; which contacts are closed at
    /// the end is found anew.
    pub(super) fn drift<const N: usize>(&mut self, y: &mut [f64; N], wait: f64) {
        for k in 0..3 * B {
            y[DISPLACEMENT + k] += wait * y[3 * B + k];
        }
        y[Self::SPRINGS..].fill(0.0);
        self.update_pressed(y);
    }

    /// Time in the step from `y` to `end` of length `h` at which the first contact opens or closes,
    /// if one does.
    pub(super) fn crossing<const N: usize>(
        &mut self,
        y: &[f64; N],
        end: &[f64; N],
        h: f64,
    ) -> Option<SwitchTime> {
        let negligible = self.negligible();
        let mut first: Option<(f64, usize)> = None;
        for k in 0..self.contacts.list().len() {
            let ([x, rate], [x1, rate1]) = (self.depth(k, y), self.depth(k, end));
            // a closed contact that ends open, or an open one that ends closed
            let is_crossed = if self.pressed[k] { x1 < -negligible } else { x1 > negligible };
            if !is_crossed {
                continue;
            }
            // at the surface and hardly moving: the crossing is at the start, and only the state of
            // the contact is wrong
            let slow = self.pressed[k] && x <= negligible && rate <= negligible;
            let at = if slow {
                0.0
            } else {
                math::hermite_crossing([x, rate * h], [x1, rate1 * h], self.pressed[k])
            };
            if first.is_none_or(|(found, _)| at < found) {
                first = Some((at, k));
            }
        }
        let (at, k) = first?;
        if at * h > f64::EPSILON {
            return Some(SwitchTime::At(at));
        }
        self.pressed[k] = !self.pressed[k];
        self.share_dashpots();
        Some(SwitchTime::Now)
    }

    /// Writes all rates into `rates`.
    #[inline]
    pub(super) fn rates_of<const N: usize, const Q: usize, const P: usize>(
        &self,
        y: &[f64; N],
        rates: &mut Rates<N, Q, P>,
    ) {
        *rates = Rates::NONE;
        let rolls = N > Self::SPRINGS + 3 * K;
        // unit mass; dw is the rate of spin times radius, so moments are multiplied by m R²/I
        let mut gained = [(Vec3::zeros(), Vec3::zeros()); B];
        for (k, contact) in self.contacts.list().iter().enumerate().take(K) {
            if !self.pressed[k] {
                continue;
            }
            let (n, at) = (&contact.n, Self::SPRINGS + 3 * k);
            let ContactEnds { first, second, levers } = contact.ends;
            let trial = self.signed_force(k, y);
            let normal_force = trial.max(0.0);
            // opening is a switching point too: the "cap" is the tension that the contact would
            // exert
            rates.switching[3 * k] = [normal_force * normal_force, (-trial).max(0.0)];
            let (mut v, w) = (velocity_of::<B, N>(y, first), spin_of::<B, N>(y, first));
            let mut turning = w;
            if B > 1
                && let Some(second) = second
            {
                v -= velocity_of::<B, N>(y, second);
                turning = w * levers[0] + spin_of::<B, N>(y, second) * levers[1];
            }
            let approach = -n.dot(&v);
            let slip = v + n * approach + n.cross(&turning);
            // s of the shear element (`sliders`): the velocity at which its dashpot has the force
            // of its spring
            let held = vec3_at(y, at);
            let trial = slip + held;
            let (share, slips, cap) = contact.shear.share(trial.norm_squared(), normal_force);
            let p = trial * share;
            let shear_force = p * contact.shear.damping;
            put_vec3(&mut rates.y, at, &((p - held) * contact.shear.rate));
            let (force, turn) = (n * normal_force - shear_force, n.cross(&shear_force));
            self.push(&mut gained, contact, (&force, &turn));
            rates.q[4 * k] = contact.shear.damping * cap * slips;
            rates.q[4 * k + 1] = shear_force.dot(&slip);
            rates.q[4 * k + 3] = normal_force * approach;
            rates.switching[3 * k + 1] = [trial.norm_squared(), cap];
            if rolls {
                let at = Self::SPRINGS + 3 * (K + k);
                // the same for the rolling element, over all three components of the spin
                let spring_spin = vec3_at(y, at);
                let trial = w + spring_spin;
                let (share, _, cap) = contact.rolling.share(trial.norm_squared(), normal_force);
                rates.switching[3 * k + 2] = [trial.norm_squared(), cap];
                let p = trial * share;
                let rolling_moment = p * contact.rolling.damping;
                put_vec3(&mut rates.y, at, &((p - spring_spin) * contact.rolling.rate));
                gained[first].1 -= rolling_moment * self.contacts.bodies[first].turns;
                rates.q[4 * k + 2] = rolling_moment.dot(&w);
            }
        }
        for (k, (dv, dw)) in gained.iter().enumerate() {
            put_vec3(&mut rates.y, DISPLACEMENT + 3 * k, &velocity_of::<B, N>(y, k));
            put_vec3(&mut rates.y, 3 * (B + k), dv);
            put_vec3(&mut rates.y, 3 * (2 * B + k), dw);
        }
    }

    /// Adds a force at a contact, and its moment at a lever of one radius, to the accelerations of
    /// its ends.
    #[inline]
    fn push(
        &self,
        gained: &mut [Twist; B],
        contact: &ImpactContact,
        (force, turn): (&Vec3, &Vec3),
    ) {
        let ContactEnds { first, second, levers } = contact.ends;
        let bodies = &self.contacts.bodies;
        if B == 1 {
            gained[0].0 += force;
            gained[0].1 += turn * bodies[0].turns;
            return;
        }
        gained[first].0 += force * bodies[first].lightness;
        gained[first].1 += turn * (levers[0] * bodies[first].turns);
        if let Some(second) = second {
            gained[second].0 -= force * bodies[second].lightness;
            gained[second].1 += turn * (levers[1] * bodies[second].turns);
        }
    }
}

impl<const B: usize, const K: usize, const N: usize, const Q: usize, const P: usize> Flow<N, Q, P>
    for ContactRates<B, K>
{
    #[inline]
    fn rates(&mut self, _node: usize, y: &[f64; N], to: &mut Rates<N, Q, P>) {
        self.rates_of(y, to);
    }

    #[inline]
    fn size2(&self, off: &[f64; N]) -> f64 {
        // displacement, velocity and spin have one unit here; a spring's error counts as the
        // stretch that it stands for
        let mut sum: f64 = off[..Self::SPRINGS].iter().map(|x| x * x).sum();
        for (k, contact) in self.contacts.list().iter().enumerate() {
            let mut add = |at: usize, rate: f64| {
                if rate > 0.0 {
                    sum += vec3_at(off, at).norm_squared() / (rate * rate);
                }
            };
            add(Self::SPRINGS + 3 * k, contact.shear.rate);
            if N > Self::SPRINGS + 3 * K {
                add(Self::SPRINGS + 3 * (K + k), contact.rolling.rate);
            }
        }
        sum / (self.allowed * self.allowed)
    }
}
