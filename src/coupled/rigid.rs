//! Scheme `rigid` for an island: the limit of stiff springs for rocks that touch each other.
//!
//! A step has three parts. Sustained contact is solved for the whole island at velocity level; then the impacts that the
//! step ran into are taken in the order of their times; then what still overlaps is moved apart. The step's length
//! follows from the way of the fastest rock alone, so that its cost grows with the number of rocks and no faster. An
//! island of one rock is the single rock's scheme.

mod ball;
mod part;
mod stiff;
mod strike;
mod sustain;
mod sweep;

use super::cluster::{Cluster, Done, Given};
use super::member::{Member, Seat};
use crate::contact::pair::{Tie, between};
use crate::rock::Vec3;
use crate::step::adaptive::Stuck;
use crate::step::grip::{Loss, World};
use crate::step::rigid::{HELD, capture_m_s, remember};
use crate::terrain::Terrain;
use ball::{Ball, Foot, Knot};
use std::collections::BinaryHeap;
pub use strike::Hit;
use strike::{Due, Scene};
use sweep::{Asked, Lean};

/// Longest way of a rock in one step (–, relative to its radius). Impacts on the way are found wherever they are; a
/// contact that is slid over meanwhile is off by the square of half of this.
pub const TRAVEL: f64 = 0.2;

/// Work space of the rigid steps of an island.
#[derive(Debug, Default)]
pub(super) struct Pile {
    balls: Vec<Ball>,
    feet: Vec<Foot>,
    knots: Vec<Knot>,
    losses: Vec<Loss>,
    given: Vec<Given>,
    hits: Vec<Hit>,
    due: BinaryHeap<Due>,
    /// Which ties had a blow.
    struck: Vec<bool>,
    /// Ties or contacts of every rock: where its list begins, and the lists.
    first: Vec<u32>,
    links: Vec<u32>,
    /// Contacts that one of their rocks has changed since.
    asked: Asked,
    lean: Lean,
    /// What the normal impulses of sustained contacts took in this step (J).
    taken_j: f64,
    places: Vec<Vec3>,
    /// Smallest capture speed (m/s).
    capture_m_s: f64,
    /// Length of the step in hand (s).
    dt: f64,
    sweeps: u64,
    jumps: u64,
}

impl Cluster<'_> {
    /// One step of the scheme `rigid`, at most `longest` and `h_max` (s) long.
    ///
    /// # Errors
    /// [`Stuck`] if motion is no longer finite.
    pub fn advance_rigid(&mut self, longest: f64, h_max: f64) -> Result<Done, Stuck> {
        if let [member] = &mut self.members[..] {
            return alone(self.terrain, member, (longest, h_max));
        }
        let mut pile = std::mem::take(&mut self.pile);
        pile.begin(&self.members, &self.ties);
        let dt = pile.step_s(longest, h_max);
        let (terrain, ties) = (self.terrain, &self.ties);
        let settled = pile.sustain(terrain, (&mut self.members, ties), dt);
        let mut scene = Scene { terrain, members: &mut self.members, ties };
        let struck = pile.strike(&mut scene, dt);
        pile.part(&mut scene);
        self.sweeps += std::mem::take(&mut pile.sweeps);
        self.jumps += std::mem::take(&mut pile.jumps);
        let finite = pile.balls.iter().all(Ball::is_finite);
        self.take_over(&pile, dt);
        let done = Done {
            dt,
            losses: std::mem::take(&mut pile.losses),
            given: std::mem::take(&mut pile.given),
            hits: std::mem::take(&mut pile.hits),
            unsettled: !(settled && struck),
            ..Done::default()
        };
        self.pile = pile;
        if finite { Ok(done) } else { Err(Stuck::NotFinite) }
    }

    /// Takes over the end of the step.
    fn take_over(&mut self, pile: &Pile, dt: f64) {
        for (tie, struck) in self.ties.iter_mut().zip(&pile.struck) {
            let [a, b] = [tie.a, tie.b].map(|k| &pile.balls[k as usize]);
            let (n, distance) = between(&a.c, &b.c);
            let reach = a.body.radius + b.body.radius + HELD * a.body.radius.min(b.body.radius);
            tie.n = n;
            tie.closed = *struck && distance <= reach && tie.is_slow(&(a.v - b.v));
            (tie.push, tie.drag, tie.slides) = (0.0, Vec3::zeros(), false);
            tie.captured = true;
            if distance > reach {
                tie.captured = false;
            }
        }
        for knot in pile.knots.iter().filter(|knot| knot.push > 0.0) {
            let tie = &mut self.ties[knot.tie];
            let [a, b] = knot.ends.map(|k| &pile.balls[k]);
            (tie.push, tie.drag) = (knot.push / dt, knot.drag / dt);
            tie.slides = knot.drag.norm() >= knot.friction * knot.push * (1.0 - 1e-9);
            // what carried in this step is where the next begins to look for what carries
            tie.closed |= tie.is_slow(&(a.v - b.v));
        }
        let mut feet = pile.feet.iter().filter(|foot| foot.push > 0.0).peekable();
        for (k, (member, ball)) in self.members.iter_mut().zip(&pile.balls).enumerate() {
            let member = &mut **member;
            member.kept.clear();
            while let Some(foot) = feet.next_if(|foot| foot.ball == k) {
                let kept = (foot.push / dt, foot.drag / dt, foot.turn / dt);
                member.kept.push((foot.feature, kept.0, kept.1, kept.2));
            }
            member.land_on(self.terrain, ball);
        }
        for tie in self.ties.iter().filter(|tie| tie.is_held()) {
            for k in [tie.a, tie.b] {
                self.members[k as usize].flying = false;
            }
        }
    }
}

/// Lists for every rock the numbers of what joins it to another, or to itself alone.
fn lay(ends: &[[usize; 2]], rocks: usize, (first, links): (&mut Vec<u32>, &mut Vec<u32>)) {
    let of = |[a, b]: [usize; 2]| [Some(a), Some(b).filter(|b| *b != a)].into_iter().flatten();
    first.clear();
    first.resize(rocks + 1, 0);
    for &ends in ends {
        of(ends).for_each(|k| first[k] += 1);
    }
    let mut sum = 0;
    for first in first.iter_mut() {
        sum += *first;
        *first = sum;
    }
    links.clear();
    links.resize(sum as usize, 0);
    // filled from behind, so that each list is in order and its beginning is left where it belongs
    for place in (0..ends.len()).rev() {
        for k in of(ends[place]) {
            first[k] -= 1;
            links[first[k] as usize] = place as u32;
        }
    }
}

/// One step of a rock that nothing but the mesh can touch.
fn alone(
    terrain: &Terrain,
    member: &mut Member,
    (longest, h_max): (f64, f64),
) -> Result<Done, Stuck> {
    member.flew = member.flying;
    member.kept.clear();
    let world = World { terrain, body: member.body, laws: &member.laws };
    let done = crate::step::rigid::advance(&world, &mut member.grip, longest, h_max)?;
    member.flying = member.grip.is_free();
    Ok(Done {
        dt: done.dt,
        losses: vec![done.loss],
        given: vec![Given::default()],
        ..Done::default()
    })
}

impl Tie {
    /// Whether two rocks with this velocity of the first relative to the second do not part.
    fn is_slow(&self, apart_m_s: &Vec3) -> bool {
        self.n.dot(apart_m_s) < capture_m_s(&self.law)
    }
}

impl Ball {
    fn is_finite(&self) -> bool {
        self.c.iter().chain(self.v.iter()).chain(self.w.iter()).all(|x| x.is_finite())
    }
}

impl Pile {
    /// Takes the rocks over at the start of a step.
    fn begin(&mut self, members: &[Seat], ties: &[Tie]) {
        self.balls.clear();
        let ball = |member: &Seat| {
            let grip = &member.grip;
            Ball::new(&member.body, (grip.c, grip.v, grip.w))
        };
        self.balls.extend(members.iter().map(ball));
        self.losses.clear();
        self.losses.resize(members.len(), Loss::default());
        self.given.clear();
        self.given.resize(members.len(), Given::default());
        self.struck.clear();
        self.struck.resize(ties.len(), false);
        self.hits.clear();
        let slowest = ties.iter().map(|tie| capture_m_s(&tie.law)).fold(f64::INFINITY, f64::min);
        self.capture_m_s = if slowest.is_finite() { slowest } else { 0.0 };
    }

    /// Length of the step (s): the time left in equal parts.
    fn step_s(&self, longest: f64, h_max: f64) -> f64 {
        let way = |ball: &Ball| {
            let speed = ball.v.norm() + ball.body.gravity.norm() * h_max;
            TRAVEL * ball.body.radius / speed.max(f64::MIN_POSITIVE)
        };
        let most = self.balls.iter().map(way).fold(longest, f64::min);
        if most >= h_max { h_max } else { h_max / (h_max / most).ceil() }
    }
}

impl Member {
    /// Takes over the end of a step in an island.
    fn land_on(&mut self, terrain: &Terrain, ball: &Ball) {
        self.flew = self.flying;
        self.was_touched = ball.pushed || ball.moved;
        let Self { grip, body, laws, .. } = self;
        let world = World { terrain, body: *body, laws };
        (grip.c, grip.v, grip.w) = (ball.c, ball.v, ball.w);
        remember(&world, grip, |_| ball.pushed);
        self.flying = grip.is_free();
    }
}

impl Foot {
    /// Energy that the impulses take (J), at a mean velocity and spin. Friction that turns round within a step may seem to
    /// work: that is the step's error.
    fn loss(&self, world: &World, (v, w): &(Vec3, Vec3)) -> Loss {
        let loss = Loss {
            friction: (-self.drag.dot(&world.body.slip(&self.n, v, w))).max(0.0),
            damping: -self.push * self.n.dot(v),
            rolling: (-self.turn.dot(w)).max(0.0),
            trees: 0.0,
        };
        loss.on(world, self.triangle)
    }
}
