//! Sweeps over the contacts of an island until their impulses have settled.

use super::Pile;
use crate::contact::pair::Tie;
use crate::coupled::member::Seat;

/// Sweeps over the contacts before a jump, at most, and after the last. They cost little: a few contacts creep while all
/// others have settled and are passed over.
const SWEEPS: (u32, u32) = (300, 3000);
/// Sweeps that judge a jump, at most.
const SWEEPS_AFTER: u32 = 30;
/// Jumps after which the impulses have not settled.
const JUMPS: u32 = 4;
/// Change of speed at a contact in one sweep below which it has settled: over what its weight alone gains in the step, and
/// over the speed of its slower rock (–).
const SETTLED: (f64, f64) = (5e-3, 1e-3);
/// The same over the capture speed, where there is hardly any weight (–).
const SETTLED_OF_CAPTURE: f64 = 1e-6;
/// Part of that from which a change stirs the rocks: what is passed over adds up (–).
const STIRS: f64 = 0.2;

/// Contacts that are asked again, over all, below which they are listed (–).
const FEW: f64 = 0.25;

impl Pile {
    /// Sweeps until nothing changes any more, helped along by jumps; whether that came about. A jump that does not bring
    /// the sweeps nearer to rest is taken back, and no other is tried.
    pub(super) fn settle(&mut self, (members, ties): (&mut [Seat], &[Tie]), dt: f64) -> bool {
        self.dt = dt;
        for ball in &mut self.balls {
            let weight = SETTLED.0 * ball.body.gravity.norm() * dt;
            let least = weight.max(SETTLED_OF_CAPTURE * self.capture_m_s);
            ball.allowed_m_s = least + SETTLED.1 * ball.before.0.norm();
        }
        let mut change = self.sweep_on(SWEEPS.0);
        for _ in 0..JUMPS {
            if change <= 1.0 {
                return true;
            }
            let times: Vec<u32> = self.balls.iter().map(|ball| ball.times).collect();
            if self.sweep_on(1) <= 1.0 {
                return true;
            }
            let kept = (self.balls.clone(), self.feet.clone(), self.knots.clone());
            self.jumps += 1;
            if !self.jump((&mut *members, ties), &times) {
                break;
            }
            let after = self.sweep_on(SWEEPS_AFTER);
            if after > f64::max(1.0, 0.5 * change) {
                (self.balls, self.feet, self.knots) = kept;
                break;
            }
            change = after;
        }
        self.sweep_on(SWEEPS.1) <= 1.0
    }

    /// Sweeps until nothing changes by more than is allowed, or so many times; the largest change of the last, over what
    /// is allowed (–).
    fn sweep_on(&mut self, most: u32) -> f64 {
        let mut change = f64::INFINITY;
        let mut lists = false;
        self.is_listed = false;
        for k in 0..most {
            self.sweeps += 1;
            self.stirred.clear();
            change = self.sweep(k % 2 == 1);
            if change <= 1.0 {
                break;
            }
            if !lists {
                self.lay_contacts();
                lists = true;
            }
            self.list_stirred();
        }
        change
    }

    /// One pass over the contacts, onwards or backwards; the largest change of speed, over what is allowed (–). What has
    /// not been stirred since it was solved is passed over.
    fn sweep(&mut self, backwards: bool) -> f64 {
        let count =
            if self.is_listed { self.listed.len() } else { self.feet.len() + self.knots.len() };
        let mut change = 0.0f64;
        for k in 0..count {
            let k = if backwards { count - 1 - k } else { k };
            let contact = if self.is_listed { self.listed[k] as usize } else { k };
            change = change.max(self.sweep_contact(contact));
        }
        change
    }

    /// Feet come first, then knots.
    fn sweep_contact(&mut self, k: usize) -> f64 {
        let feet = self.feet.len();
        if k < feet { self.sweep_foot(k) } else { self.sweep_knot(k - feet) }
    }

    /// The contacts of every rock.
    fn lay_contacts(&mut self) {
        let feet = self.feet.iter().map(|foot| [foot.ball; 2]);
        let ends = feet.chain(self.knots.iter().map(|knot| knot.ends));
        let ends: Vec<[usize; 2]> = ends.collect();
        super::lay(&ends, self.balls.len(), (&mut self.first, &mut self.links));
    }

    /// Lists the contacts of the rocks stirred in the last sweep, in order, if they are few: all others are passed over
    /// anyway, and a sweep costs what happens and not what is there.
    fn list_stirred(&mut self) {
        self.stirred.sort_unstable();
        self.stirred.dedup();
        self.listed.clear();
        for &ball in &self.stirred {
            let range = self.first[ball as usize] as usize..self.first[ball as usize + 1] as usize;
            self.listed.extend_from_slice(&self.links[range]);
        }
        self.listed.sort_unstable();
        self.listed.dedup();
        let all = (self.feet.len() + self.knots.len()) as f64;
        self.is_listed = (self.listed.len() as f64) < FEW * all;
    }

    fn sweep_foot(&mut self, k: usize) -> f64 {
        let foot = &mut self.feet[k];
        let ball = &mut self.balls[foot.ball];
        if foot.seen == ball.times {
            return 0.0;
        }
        let change = foot.solve(ball) / ball.allowed_m_s;
        if change > STIRS {
            ball.times += 1;
            self.stirred.push(foot.ball as u32);
        }
        foot.seen = ball.times;
        change
    }

    fn sweep_knot(&mut self, k: usize) -> f64 {
        let knot = &mut self.knots[k];
        let Ok([a, b]) = self.balls.get_disjoint_mut(knot.ends) else { return 0.0 };
        if knot.seen == [a.times, b.times] {
            return 0.0;
        }
        let change = knot.solve(a, b) / a.allowed_m_s.min(b.allowed_m_s);
        if change > STIRS {
            (a.times, b.times) = (a.times + 1, b.times + 1);
            self.stirred.extend(knot.ends.map(|end| end as u32));
        }
        knot.seen = [a.times, b.times];
        change
    }
}
