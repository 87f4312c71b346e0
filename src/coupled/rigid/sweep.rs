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
        let count = self.feet.len() + self.knots.len();
        self.lay_contacts();
        self.asked.all(count);
        let mut change = f64::INFINITY;
        for k in 0..most {
            self.sweeps += 1;
            change = self.sweep(k % 2 == 1);
            if change <= 1.0 {
                break;
            }
        }
        change
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

    /// Feet come first, then knots.
    fn sweep_contact(&mut self, k: usize) -> f64 {
        self.asked.remove(k);
        let feet = self.feet.len();
        if k < feet { self.sweep_foot(k) } else { self.sweep_knot(k - feet) }
    }

    /// The contacts of every rock.
    fn lay_contacts(&mut self) {
        let feet = self.feet.iter().map(|foot| [foot.ball; 2]);
        let ends: Vec<[usize; 2]> = feet.chain(self.knots.iter().map(|knot| knot.ends)).collect();
        super::lay(&ends, self.balls.len(), (&mut self.first, &mut self.links));
    }

    /// Asks the contacts of a rock that was stirred: all others have seen their rocks as they are, and a sweep costs what
    /// happens and not what is there.
    fn ask(&mut self, ball: usize) {
        for contact in &self.links[self.first[ball] as usize..self.first[ball + 1] as usize] {
            self.asked.add(*contact as usize);
        }
    }

    fn sweep_foot(&mut self, k: usize) -> f64 {
        let foot = &mut self.feet[k];
        let ball = &mut self.balls[foot.ball];
        if foot.seen == ball.times {
            return 0.0;
        }
        let change = foot.solve(ball) / ball.allowed_m_s;
        ball.times += u32::from(change > STIRS);
        foot.seen = ball.times;
        let end = foot.ball;
        if change > STIRS {
            self.ask(end);
        }
        change
    }

    fn sweep_knot(&mut self, k: usize) -> f64 {
        let knot = &mut self.knots[k];
        let Ok([a, b]) = self.balls.get_disjoint_mut(knot.ends) else { return 0.0 };
        if knot.seen == [a.times, b.times] {
            return 0.0;
        }
        let change = knot.solve(a, b) / a.allowed_m_s.min(b.allowed_m_s);
        let stirred = u32::from(change > STIRS);
        (a.times, b.times) = (a.times + stirred, b.times + stirred);
        knot.seen = [a.times, b.times];
        let ends = knot.ends;
        if change > STIRS {
            self.ask(ends[0]);
            self.ask(ends[1]);
        }
        change
    }
}

/// A set of contacts, a bit for each.
#[derive(Debug, Default)]
pub(super) struct Asked(Vec<u64>);

impl Asked {
    /// Every number below `count`.
    fn all(&mut self, count: usize) {
        self.0.clear();
        self.0.resize(count.div_ceil(64), u64::MAX);
        let over = 64 * self.0.len() - count;
        if let Some(last) = self.0.last_mut() {
            *last >>= over;
        }
    }

    fn add(&mut self, k: usize) {
        self.0[k / 64] |= 1 << (k % 64);
    }

    fn remove(&mut self, k: usize) {
        self.0[k / 64] &= !(1 << (k % 64));
    }

    /// The first at or after `k`.
    fn from(&self, k: usize) -> Option<usize> {
        let first = *self.0.get(k / 64)? & (u64::MAX << (k % 64));
        let rest = self.0.iter().zip(0..).skip(k / 64 + 1).map(|(word, at)| (at, *word));
        let mut words = std::iter::once((k / 64, first)).chain(rest);
        words
            .find(|(_, word)| *word != 0)
            .map(|(at, word)| 64 * at + word.trailing_zeros() as usize)
    }

    /// The last before `k`.
    fn below(&self, k: usize) -> Option<usize> {
        let first = self.0.get(k / 64).map_or(0, |word| word & !(u64::MAX << (k % 64)));
        let rest = (0..k / 64).rev().map(|at| (at, self.0[at]));
        let mut words = std::iter::once((k / 64, first)).chain(rest);
        words
            .find(|(_, word)| *word != 0)
            .map(|(at, word)| 64 * at + 63 - word.leading_zeros() as usize)
    }

    fn last(&self) -> Option<usize> {
        self.below(64 * self.0.len())
    }
}

#[cfg(test)]
mod tests {
    use super::Asked;

    /// Onwards and backwards give the same numbers, and none that was not put in.
    #[test]
    fn a_set_gives_back_its_numbers_in_order() {
        let mut set = Asked::default();
        set.all(130);
        assert_eq!((set.from(0), set.last()), (Some(0), Some(129)));
        (0..130).filter(|k| k % 7 != 3).for_each(|k| set.remove(k));
        set.add(64);
        let onwards: Vec<usize> = std::iter::successors(set.from(0), |k| set.from(k + 1)).collect();
        let mut backwards: Vec<usize> =
            std::iter::successors(set.last(), |k| set.below(*k)).collect();
        backwards.reverse();
        let expected: Vec<usize> = (0..130).filter(|k| k % 7 == 3 || *k == 64).collect();
        assert_eq!(onwards, expected);
        assert_eq!(backwards, expected);
        set.all(0);
        assert_eq!((set.from(0), set.last()), (None, None));
    }
}
