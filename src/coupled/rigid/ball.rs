//! The rocks of an island inside one rigid step, and the impulses of their contacts.

use crate::contact::Feature;
use crate::contact::pair::{Tie, between};
use crate::coupled::bridge::Motion;
use crate::ground::Law;
use crate::rock::Vec3;
use crate::step::impact::{Struck, throw};
use crate::step::law::{Body, within};
use crate::step::rigid::{IMPACT, rub};
use crate::step::slide::Mode;

/// One rock inside a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub(super) c: Vec3,
    pub(super) v: Vec3,
    pub(super) w: Vec3,
    pub(super) body: Body,
    /// Velocity and spin at the start of the step.
    pub(super) before: Motion,
    /// `1/m` (1/kg) and `1/I` (1/(kg m²)).
    pub(super) inv: (f64, f64),
    /// Change of speed in a sweep that has settled (m/s).
    pub(super) allowed_m_s: f64,
    /// How long before the end of the step its last blow was (s).
    pub(super) since_s: f64,
    /// Blows in this step.
    pub(super) blows: u32,
    /// How often it was set in another motion.
    pub(super) times: u32,
    /// Whether a contact pushed it, and whether it was moved out of something.
    pub(super) pushed: bool,
    pub(super) moved: bool,
}

impl Ball {
    pub(super) fn new(body: &Body, (c, v, w): (Vec3, Vec3, Vec3)) -> Self {
        let inv = (1.0 / body.mass, 1.0 / body.inertia);
        Self {
            c,
            v,
            w,
            body: *body,
            before: (v, w),
            inv,
            allowed_m_s: 0.0,
            since_s: 0.0,
            blows: 0,
            times: 1,
            pushed: false,
            moved: false,
        }
    }

    /// Takes an impulse (N s) and one of rotation (N m s).
    #[inline]
    pub(super) fn take(&mut self, (push, turn): &Motion) {
        self.v += push * self.inv.0;
        self.w += turn * self.inv.1;
    }

    /// The same for a blow that fell `s` (s) before the end of the step: the rock has gone on with what it got since.
    pub(super) fn take_late(&mut self, blow: &Motion, s: f64) {
        self.take(blow);
        self.c += blow.0 * (self.inv.0 * s);
    }

    /// Work of an impulse at mean velocity `v` and spin `w` (J).
    pub(super) fn work_j((push, turn): &Motion, v: &Vec3, w: &Vec3) -> f64 {
        push.dot(v) + turn.dot(w)
    }
}

/// The impulses of one contact: normal (N s), along the surface (N s), of rolling (N m s).
#[derive(Debug, Clone, Copy)]
pub(super) struct Impulses(f64, Vec3, Vec3);

impl Impulses {
    pub(super) const NONE: Self = Self(0.0, Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.0));

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1, self.2 + other.2)
    }

    pub(super) fn less(&self, other: &Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1, self.2 - other.2)
    }

    pub(super) fn times(&self, factor: f64) -> Self {
        Self(self.0 * factor, self.1 * factor, self.2 * factor)
    }

    /// Square of its size, with the weight of each kind.
    pub(super) fn square(&self, [n, t, r]: [f64; 3]) -> f64 {
        n * self.0 * self.0 + t * self.1.norm_squared() + r * self.2.norm_squared()
    }

    /// Within the cone of friction with these caps over the normal impulse.
    fn within(&self, caps: (f64, f64)) -> Self {
        let push = self.0.max(0.0);
        Self(push, within(self.1, caps.0 * push), within(self.2, caps.1 * push))
    }
}

/// The contact of two rocks and its impulses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knot {
    /// Which tie it belongs to.
    pub(super) tie: usize,
    /// The two rocks, as places in the island.
    pub(super) ends: [usize; 2],
    /// Unit normal from the second to the first.
    pub(super) n: Vec3,
    /// Distances from the centres to the common point that is touched (m).
    pub(super) levers: [f64; 2],
    /// `1/m_a + 1/m_b`, and the same for the touched point along the surface (1/kg).
    pub(super) inv: (f64, f64),
    /// Friction coefficient `tan φ` (–).
    pub(super) friction: f64,
    /// Normal speed apart wanted after the impulse (m/s).
    pub(super) target: f64,
    /// Normal impulse (N s), ≥ 0.
    pub(super) push: f64,
    /// Impulse along the surface: the first rock feels `−q`, the second `q` (N s).
    pub(super) drag: Vec3,
    /// The counts of its rocks when it was solved last.
    pub(super) seen: [u32; 2],
}

impl Knot {
    pub(super) fn impulses(&self) -> Impulses {
        Impulses(self.push, self.drag, Vec3::zeros())
    }

    /// Adds to its impulses what the cone allows, and acts with that.
    pub(super) fn push_on(&mut self, step: &Impulses, a: &mut Ball, b: &mut Ball) {
        let next = self.impulses().plus(step).within((self.friction, 0.0));
        let change = Self { push: next.0 - self.push, drag: next.1 - self.drag, ..*self };
        (self.push, self.drag) = (next.0, next.1);
        a.take(&change.load(0));
        b.take(&change.load(1));
    }

    /// The contact of a tie's rocks with centres at `at`, without impulses.
    pub(super) fn new((tie, of): (usize, &Tie), balls: [&Ball; 2], at: [&Vec3; 2]) -> Self {
        let (n, distance) = between(at[0], at[1]);
        let reach = balls[0].body.radius + balls[1].body.radius;
        // One common point: impulses with one line of action keep the angular momentum.
        let levers = balls.map(|ball| distance * ball.body.radius / reach);
        let inv_n = balls[0].inv.0 + balls[1].inv.0;
        let turning = [0, 1].map(|k| levers[k] * levers[k] * balls[k].inv.1);
        Self {
            tie,
            ends: [of.a as usize, of.b as usize],
            n,
            levers,
            inv: (inv_n, inv_n + turning[0] + turning[1]),
            friction: of.law.friction,
            target: 0.0,
            push: 0.0,
            drag: Vec3::zeros(),
            seen: [0; 2],
        }
    }

    /// Normal speed apart (m/s).
    #[inline]
    pub(super) fn speed(&self, a: &Ball, b: &Ball) -> f64 {
        self.n.dot(&(a.v - b.v))
    }

    /// Slip of the first rock over the second at the touched point (m/s).
    #[inline]
    pub(super) fn slip(&self, a: &Ball, b: &Ball) -> Vec3 {
        let u = a.v - b.v;
        u - self.n * self.n.dot(&u) + self.n.cross(&(a.w * self.levers[0] + b.w * self.levers[1]))
    }

    /// Impulse and rotational impulse on end `k`.
    #[inline]
    pub(super) fn load(&self, k: usize) -> Motion {
        let push = self.n * self.push - self.drag;
        (if k == 0 { push } else { -push }, self.n.cross(&self.drag) * self.levers[k])
    }

    /// Finds the impulses for motions that hold the present ones, and acts with what they change by; how much that
    /// changes the speed at the contact (m/s).
    #[inline]
    pub(super) fn solve(&mut self, a: &mut Ball, b: &mut Ball) -> f64 {
        let (held, drag) = (self.push, self.drag);
        let speed = self.speed(a, b);
        let push = (held + (self.target - speed) / self.inv.0).max(0.0);
        if push <= 0.0 && held <= 0.0 {
            return 0.0;
        }
        let stick = drag + self.slip(a, b) / self.inv.1;
        (self.push, self.drag) = (push, within(stick, self.friction * push));
        let change = Self { push: push - held, drag: self.drag - drag, ..*self };
        a.take(&change.load(0));
        b.take(&change.load(1));
        (change.push.abs() * self.inv.0).max(change.drag.norm() * self.inv.1)
    }
}

/// The contact of a rock with the mesh and its impulses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The rock, as a place in the island.
    pub(super) ball: usize,
    pub(super) feature: Feature,
    pub(super) triangle: u32,
    /// Unit normal from the mesh to the centre.
    pub(super) n: Vec3,
    /// Friction (–) and rolling friction (m): the largest impulses over the normal one.
    pub(super) caps: (f64, f64),
    /// Normal speed wanted after the impulse (m/s).
    pub(super) target: f64,
    /// Normal impulse (N s), ≥ 0.
    pub(super) push: f64,
    /// Impulse along the surface on the rock (N s).
    pub(super) drag: Vec3,
    /// Rolling impulse on the rock (N m s).
    pub(super) turn: Vec3,
    /// Which of friction and rolling holds.
    mode: Mode,
    /// The count of its rock when it was solved last.
    pub(super) seen: u32,
}

impl Foot {
    /// A contact without impulses.
    pub(super) fn new(
        ball: usize,
        (feature, triangle): (Feature, u32),
        n: Vec3,
        law: &Law,
    ) -> Self {
        Self {
            ball,
            feature,
            triangle,
            n,
            caps: (law.friction, law.rolling_m),
            target: 0.0,
            push: 0.0,
            drag: Vec3::zeros(),
            turn: Vec3::zeros(),
            mode: Mode::default(),
            seen: 0,
        }
    }

    /// Impulse and rotational impulse on the rock.
    #[inline]
    pub(super) fn load(&self, body: &Body) -> Motion {
        (self.n * self.push + self.drag, self.turn - self.n.cross(&self.drag) * body.radius)
    }

    pub(super) fn impulses(&self) -> Impulses {
        Impulses(self.push, self.drag, self.turn)
    }

    /// Adds to its impulses what the cone allows, and acts with that.
    pub(super) fn push_on(&mut self, step: &Impulses, ball: &mut Ball) {
        let next = self.impulses().plus(step).within(self.caps);
        let change = next.less(&self.impulses());
        let change = Self { push: change.0, drag: change.1, turn: change.2, ..*self };
        (self.push, self.drag, self.turn) = (next.0, next.1, next.2);
        let load = change.load(&ball.body);
        ball.take(&load);
    }

    /// Impulses of an impact at velocity `v` and spin `w`: the limit of stiff springs, the same as for a rock alone.
    pub(super) fn impact(
        &mut self,
        (body, law): (&Body, &Law),
        (v, w): (&Vec3, &Vec3),
        captured: bool,
    ) {
        let struck = Struck { normal: self.n, law, stiffness_scale: 1.0, captured };
        let thrown = throw(body, &[struck], (v, w), IMPACT);
        let load = (thrown.velocity_m_s - v) * body.mass;
        self.push = self.n.dot(&load).max(0.0);
        self.drag = load - self.n * self.n.dot(&load);
        self.turn = (thrown.spin_rad_s - w) * body.inertia + self.n.cross(&self.drag) * body.radius;
    }

    /// Impulses for velocity `v` and spin `w` without this contact's own.
    pub(super) fn strike(&mut self, body: &Body, v: &Vec3, w: &Vec3) {
        self.push = (body.mass * (self.target - self.n.dot(v))).max(0.0);
        if self.push <= 0.0 {
            (self.drag, self.turn) = (Vec3::zeros(), Vec3::zeros());
            return;
        }
        let caps = (self.caps.0 * self.push, self.caps.1 * self.push);
        (self.drag, self.turn) = rub(body, &self.n, caps, (v, w), &mut self.mode);
    }

    /// Finds the impulses for a motion that holds the present ones, and acts with what they change by; how much that
    /// changes the speed at the contact (m/s).
    pub(super) fn solve(&mut self, ball: &mut Ball) -> f64 {
        let held = *self;
        let (push, turn) = held.load(&ball.body);
        let (v, w) = (ball.v - push * ball.inv.0, ball.w - turn * ball.inv.1);
        self.strike(&ball.body, &v, &w);
        if held.push <= 0.0 && self.push <= 0.0 {
            return 0.0;
        }
        let (push, turn) = self.load(&ball.body);
        (ball.v, ball.w) = (v + push * ball.inv.0, w + turn * ball.inv.1);
        let change = (self.push - held.push).abs().max((self.drag - held.drag).norm());
        change.max((self.turn - held.turn).norm() / ball.body.radius) * ball.inv.0
    }
}
