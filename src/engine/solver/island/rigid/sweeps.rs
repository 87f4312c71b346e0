//! Sweeps over the contacts of an island until their impulses have settled.
//!
//! A sweep hands a load on from rock to rock; alone it would take as many as the square of the heap's height. From one sweep
//! to the next the impulses therefore go on in a conjugate direction: `x ← S(x) + β p`, `p ← S(x) − x + β p`, with `β` the
//! ratio of the squares of the last two sweeps' changes, and anew where that is no less than 1 (nonsmooth nonlinear
//! conjugate gradients, Silcowitz, Niebe and Erleben 2010). The last word is a sweep's.
//!
//! A contact has settled when its change of speed is small against what its weight gains in a step,
//! or against the speed of its rocks: the rule has no absolute size, so it means the same for pebbles and for blocks.

use super::RigidIsland;
use super::contacts::Impulses;
use crate::contact::pair::PairHistory;
use crate::rock::Rock;
use crate::solver::island::body::BodySlot;

/// Sweeps over the contacts before a jump, at most, and after the last. They cost little: a few contacts creep while all
/// others have settled and are passed over.
const SWEEPS: (u32, u32) = (1000, 3000);
/// Sweeps that judge a jump, at most.
const SWEEPS_AFTER: u32 = 30;
/// Jumps after which the impulses have not settled.
const JUMPS: u32 = 4;
/// Change of speed at a contact in one sweep below which it has settled, and stirs its rocks no more: over what its weight alone
/// gains in the step, and over the speed of the fastest of its rocks and their neighbours (–).
const SETTLED: (f64, f64) = (3e-3, 1.8e-2);
/// The first of them where an island is small: there it costs next to nothing to tell friction that just holds from friction
/// that just does not (–).
const SETTLED_FEW: f64 = 6e-4;
/// Rocks of a small island, at most.
pub(super) const FEW: usize = 64;
/// The same over the capture speed, where there is hardly any weight (–).
const SETTLED_OF_CAPTURE: f64 = 1e-6;

impl RigidIsland {
    /// Sweeps until nothing changes any more, helped along by jumps; whether that came about. A jump that does not bring
    /// the sweeps nearer to rest is taken back, and no other is tried.
    pub(super) fn settle(
        &mut self,
        (members, pair_histories): (&mut [BodySlot], &[PairHistory]),
        dt: f64,
    ) -> bool {
        self.dt = dt;
        self.allow();
        let mut change = self.sweep_on(SWEEPS.0);
        for _ in 0..JUMPS {
            if change <= 1.0 {
                return true;
            }
            let times: Vec<u32> = self.balls.iter().map(|ball| ball.times).collect();
            if self.sweep_on(1) <= 1.0 {
                return true;
            }
            let kept =
                (self.balls.clone(), self.ground_contacts.clone(), self.ball_contacts.clone());
            self.jumps += 1;
            if !self.jump((&mut *members, pair_histories), &times) {
                break;
            }
            let after = self.sweep_on(SWEEPS_AFTER);
            if after > f64::max(1.0, 0.5 * change) {
                (self.balls, self.ground_contacts, self.ball_contacts) = kept;
                break;
            }
            change = after;
        }
        self.sweep_on(SWEEPS.1) <= 1.0
    }

    /// What may still change at every rock: the less the slower it and its neighbours are.
    ///
    /// A rock's neighbours count too: a slow rock struck by a fast one need not be solved to its
    /// own standstill.
    fn allow(&mut self) {
        let few = self.balls.len() <= FEW;
        let of_weight = if few { SETTLED_FEW } else { SETTLED.0 };
        for ball in &mut self.balls {
            let weight = of_weight * ball.body.gravity.norm() * self.dt;
            let least = weight.max(SETTLED_OF_CAPTURE * self.capture_m_s);
            ball.allowed_m_s = least + SETTLED.1 * ball.before.0.norm();
        }
        for [a, b] in self.ball_contacts.iter().map(|ball_contact| ball_contact.ends) {
            let speeds = [a, b].map(|k| SETTLED.1 * self.balls[k].before.0.norm());
            let Ok([a, b]) = self.balls.get_disjoint_mut([a, b]) else { continue };
            a.allowed_m_s = a.allowed_m_s.max(speeds[1]);
            b.allowed_m_s = b.allowed_m_s.max(speeds[0]);
        }
    }

    /// Sweeps until nothing changes by more than is allowed, or so many times; the largest change of the last, over what
    /// is allowed (–).
    fn sweep_on(&mut self, most: u32) -> f64 {
        let count = self.ground_contacts.len() + self.ball_contacts.len();
        self.lay_contacts();
        self.asked.all(count);
        let mut change = f64::INFINITY;
        self.lean.begin(count);
        for k in 0..most {
            self.sweeps += 1;
            change = self.sweep(k % 2 == 1);
            self.ask_again();
            if change <= 1.0 {
                break;
            }
            if k + 1 < most {
                self.lean_on();
            }
        }
        change
    }

    /// Goes on from a sweep's changes in the conjugate direction.
    fn lean_on(&mut self) {
        let list = std::mem::take(&mut self.lean.list);
        let mut square = 0.0;
        for &k in &list {
            let (now, inv) = self.impulses(k as usize);
            let one = &mut self.lean.of[k as usize];
            one.start = now.less(&one.start);
            square += one.start.square(inv);
        }
        let share = square / self.lean.square;
        // where changes grow the direction is worth nothing: begin anew from plain sweeps
        let leans = share < 1.0;
        self.lean.square = square;
        let map = self.lean.map;
        self.lean.map += 1;
        for &k in &list {
            let one = &mut self.lean.of[k as usize];
            let change = one.start;
            if leans && one.led + 1 == map {
                let step = one.way.times(share);
                one.way = change.plus(&step);
                self.push_on(k as usize, &step);
            } else {
                one.way = change;
            }
            self.lean.of[k as usize].led = map;
        }
        self.lean.list = list;
        self.lean.list.clear();
    }

    /// The impulses of a contact, and the weights that make their squares energies.
    ///
    /// `1/m` for the normal impulse, `7/2 · 1/m` for that along the surface (contact point), `1/I`
    /// for rolling.
    fn impulses(&self, k: usize) -> (Impulses, [f64; 3]) {
        let ground_contacts = self.ground_contacts.len();
        if k < ground_contacts {
            let ground_contact = &self.ground_contacts[k];
            let ball = &self.balls[ground_contact.rock];
            (ground_contact.impulses(), [ball.inv.0, Rock::SLIP_LIGHTNESS * ball.inv.0, ball.inv.1])
        } else {
            let ball_contact = &self.ball_contacts[k - ground_contacts];
            (ball_contact.impulses(), [ball_contact.inv.0, ball_contact.inv.1, 0.0])
        }
    }

    /// Adds to the impulses of a contact what its cone allows.
    fn push_on(&mut self, k: usize, step: &Impulses) {
        let ground_contacts = self.ground_contacts.len();
        if k < ground_contacts {
            let ground_contact = &mut self.ground_contacts[k];
            let ball = &mut self.balls[ground_contact.rock];
            ground_contact.push_on(step, ball);
            ball.times += 1;
        } else {
            let ball_contact = &mut self.ball_contacts[k - ground_contacts];
            if let Ok([a, b]) = self.balls.get_disjoint_mut(ball_contact.ends) {
                ball_contact.push_on(step, a, b);
                (a.times, b.times) = (a.times + 1, b.times + 1);
            }
        }
    }

    /// One pass over the contacts that are asked, onwards or backwards; the largest change of speed, over what is allowed
    /// (–).
    fn sweep(&mut self, backwards: bool) -> f64 {
        let mut change = 0.0f64;
        let mut at = if backwards { self.asked.last() } else { self.asked.from(0) };
        while let Some(k) = at {
            change = change.max(self.sweep_contact(k));
            at = if backwards { self.asked.below(k) } else { self.asked.from(k + 1) };
        }
        change
    }

    /// Contacts with the mesh come first, then those between rocks.
    fn sweep_contact(&mut self, k: usize) -> f64 {
        self.asked.remove(k);
        match k.checked_sub(self.ground_contacts.len()) {
            None => self.sweep_ground_contact(k),
            Some(place) => self.sweep_ball_contact(k, place),
        }
    }

    /// The contacts of every rock.
    fn lay_contacts(&mut self) {
        let ground_contacts =
            self.ground_contacts.iter().map(|ground_contact| [ground_contact.rock; 2]);
        let ends: Vec<[usize; 2]> = ground_contacts
            .chain(self.ball_contacts.iter().map(|ball_contact| ball_contact.ends))
            .collect();
        self.of_rocks.lay(&ends, self.balls.len());
    }

    /// Asks the contacts of a rock when a sweep stirs it first: all others have seen their rocks as they are, and a sweep
    /// costs what happens and not what is there.
    fn stir(&mut self, ball: usize) {
        let stirred = &mut self.balls[ball].stirred;
        if *stirred != self.sweeps {
            *stirred = self.sweeps;
            self.stirred.push(ball);
            self.ask(ball);
        }
    }

    fn ask(&mut self, ball: usize) {
        for contact in self.of_rocks.of(ball) {
            self.asked.add(contact);
        }
    }

    /// Asks the contacts of all rocks that the sweep has stirred: some were solved before the last change.
    fn ask_again(&mut self) {
        while let Some(ball) = self.stirred.pop() {
            self.ask(ball);
        }
    }

    fn sweep_ground_contact(&mut self, k: usize) -> f64 {
        let ground_contact = &mut self.ground_contacts[k];
        let end = ground_contact.rock;
        let ball = &mut self.balls[end];
        if ground_contact.seen == ball.times {
            return 0.0;
        }
        let start = ground_contact.impulses();
        let change = ground_contact.solve(ball) / ball.allowed_m_s;
        let stirs = change > 1.0;
        ball.times += u32::from(stirs);
        ground_contact.seen = ball.times;
        if stirs {
            self.lean.note(k, start);
            self.stir(end);
        }
        change
    }

    /// The contact with number `k` of all that stands at `place` among those between rocks.
    fn sweep_ball_contact(&mut self, k: usize, place: usize) -> f64 {
        let ball_contact = &mut self.ball_contacts[place];
        let ends = ball_contact.ends;
        let Ok([a, b]) = self.balls.get_disjoint_mut(ends) else { return 0.0 };
        if ball_contact.seen == [a.times, b.times] {
            return 0.0;
        }
        let start = ball_contact.impulses();
        let change = ball_contact.solve(a, b) / a.allowed_m_s.min(b.allowed_m_s);
        let stirs = change > 1.0;
        (a.times, b.times) = (a.times + u32::from(stirs), b.times + u32::from(stirs));
        ball_contact.seen = [a.times, b.times];
        if stirs {
            self.lean.note(k, start);
            self.stir(ends[0]);
            self.stir(ends[1]);
        }
        change
    }
}

/// The conjugate direction, contact by contact.
#[derive(Debug, Default)]
pub(super) struct Leaning {
    of: Vec<One>,
    list: Vec<u32>,
    /// Number of the current sweep.
    map: u64,
    /// Square of the changes of the one before.
    square: f64,
}

/// One contact's part of it.
#[derive(Debug, Clone, Copy)]
struct One {
    /// Impulses before the current sweep, and after it what they changed by.
    start: Impulses,
    /// The direction.
    way: Impulses,
    /// Sweep of which `start` is, and after which `way` was found.
    begun: u64,
    led: u64,
}

impl Leaning {
    fn begin(&mut self, count: usize) {
        // numbers of sweeps go on: what is left of others is older than the sweep before
        self.map += 2;
        let none = One { start: Impulses::NONE, way: Impulses::NONE, begun: 0, led: 0 };
        self.of.resize(count.max(self.of.len()), none);
        self.list.clear();
        self.square = 0.0;
    }

    fn note(&mut self, k: usize, start: Impulses) {
        let one = &mut self.of[k];
        if one.begun != self.map {
            (one.begun, one.start) = (self.map, start);
            self.list.push(k as u32);
        }
    }
}
