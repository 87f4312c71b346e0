//! The rocks of an island inside one rigid step, and the impulses of their contacts.

use crate::contact::ContactPoint;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::ground::{FrictionLimits, Law};
use crate::rock::{Motion, Vec3};
use crate::solver::body::{Body, Twist};
use crate::solver::impact::{BlowTable, blow_along_a_line};
use crate::solver::island::body::BodySlot;
use crate::solver::island::outcome::Hit;
use crate::solver::rigid::GroundContact;
use crate::solver::struck::Struck;
use crate::terrain::Terrain;

/// One rock inside a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepBody {
    pub(super) c: Vec3,
    pub(super) v: Vec3,
    pub(super) w: Vec3,
    pub(super) body: Body,
    /// Velocity and spin at the start of the step.
    pub(super) before: Twist,
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
    /// Sweep that stirred it last.
    pub(super) stirred: u64,
    /// Sweep of the position correction in which it was moved last.
    pub(super) shifted: u32,
    /// Whether another rock touches it.
    pub(super) has_neighbour: bool,
    /// Whether a contact pushed it, and whether it was moved out of something.
    pub(super) pushed: bool,
    pub(super) moved: bool,
    /// What the mesh does to it in this step.
    pub(super) on_mesh: OnMesh,
}

/// What the mesh does to a rock in a step, blows apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum OnMesh {
    /// Nothing.
    Free,
    /// It holds what has come to it too slowly to rebound.
    Settles,
    /// It holds it from the start.
    Held,
}

impl StepBody {
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
            stirred: 0,
            shifted: 0,
            has_neighbour: false,
            pushed: false,
            moved: false,
            on_mesh: OnMesh::Free,
        }
    }

    /// Takes an impulse (N s) and one of rotation (N m s).
    #[inline]
    pub(super) fn take(&mut self, (normal_force, turn): &Twist) {
        self.v += normal_force * self.inv.0;
        self.w += turn * self.inv.1;
    }

    /// The same for a blow that fell `s` (s) before the end of the step: the rock has gone on with what it got since.
    pub(super) fn take_late(&mut self, blow: &Twist, s: f64) {
        self.take(blow);
        self.c += blow.0 * (self.inv.0 * s);
    }

    /// Centre and velocity `s` (s) before the end of the step, on its parabola.
    pub(super) fn before_end(&self, s: f64) -> (Vec3, Vec3) {
        let gravity = self.body.gravity;
        (self.c - (self.v - gravity * (0.5 * s)) * s, self.v - gravity * s)
    }

    /// The same with its spin; the time counts from the end of the step.
    pub(super) fn motion_before_end(&self, s: f64) -> Motion {
        let (position_m, velocity_m_s) = self.before_end(s);
        Motion { time_s: -s, position_m, velocity_m_s, spin_rad_s: self.w }
    }

    /// Notes that a blow fell `s` (s) before the end of the step.
    pub(super) fn is_struck(&mut self, s: f64) {
        self.since_s = s;
        self.blows += 1;
        self.pushed = true;
        self.times += 1;
    }

    /// Work of an impulse at mean velocity `v` and spin `w` (J).
    pub(super) fn work_j((normal_force, turn): &Twist, v: &Vec3, w: &Vec3) -> f64 {
        normal_force.dot(v) + turn.dot(w)
    }
}

/// Blows on one rock in one step from which on they do not rebound.
pub(super) const LIVELY: u32 = 200;

/// What blows act on.
pub(super) struct ImpactScene<'s> {
    pub(super) terrain: &'s Terrain,
    pub(super) members: &'s mut [BodySlot],
    pub(super) pair_histories: &'s [PairHistory],
}

/// The impact of rock `k`, of which centre and radius are given, at a touch.
pub(super) fn hit_of(k: usize, touch: &ContactPoint, ball: (&Vec3, f64), approach_m_s: f64) -> Hit {
    let on = (touch.feature, touch.triangle);
    Hit { rock: k, struck: Struck::by_ball(ball, &touch.normal, on, approach_m_s) }
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

    /// Within the cone of friction.
    fn within(&self, limits: &FrictionLimits) -> Self {
        let normal_force = self.0.max(0.0);
        Self(normal_force, limits.shear(self.1, normal_force), limits.rolling(self.2, normal_force))
    }
}

/// The contact of two rocks and its impulses.
#[derive(Debug, Clone, Copy)]
pub(super) struct BallContact {
    /// Which pair of rocks it belongs to.
    pub(super) pair_history: usize,
    /// The two rocks, as places in the island.
    pub(super) ends: [usize; 2],
    /// Unit normal from the second to the first.
    pub(super) n: Vec3,
    /// Distances from the centres to the common point that is touched (m).
    pub(super) levers: [f64; 2],
    /// `1/m_a + 1/m_b`, and the same for the touched point along the surface (1/kg).
    pub(super) inv: (f64, f64),
    /// What friction bears.
    pub(super) limits: FrictionLimits,
    /// Normal speed apart wanted after the impulse (m/s).
    pub(super) target: f64,
    /// Normal impulse (N s), ≥ 0.
    pub(super) normal_force: f64,
    /// Impulse along the surface: the first rock feels `−q`, the second `q` (N s).
    pub(super) shear_force: Vec3,
    /// The counts of its rocks when it was solved last.
    pub(super) seen: [u32; 2],
}

impl BallContact {
    pub(super) fn impulses(&self) -> Impulses {
        Impulses(self.normal_force, self.shear_force, Vec3::zeros())
    }

    /// Adds to its impulses what the cone allows, and acts with that.
    pub(super) fn push_on(&mut self, step: &Impulses, a: &mut StepBody, b: &mut StepBody) {
        let next = self.impulses().plus(step).within(&self.limits);
        self.go_to((next.0, next.1), a, b);
    }

    /// Takes these impulses, and acts with what that changes; the change.
    #[inline]
    fn go_to(&mut self, next: (f64, Vec3), a: &mut StepBody, b: &mut StepBody) -> (f64, Vec3) {
        let change = (next.0 - self.normal_force, next.1 - self.shear_force);
        (self.normal_force, self.shear_force) = next;
        let (push, turn) = (self.n * change.0 - change.1, self.n.cross(&change.1));
        a.take(&(push, turn * self.levers[0]));
        b.take(&(-push, turn * self.levers[1]));
        change
    }

    /// The contact of two rocks with centres at `at`, without impulses.
    pub(super) fn new(
        (pair_history, of): (usize, &PairHistory),
        balls: [&StepBody; 2],
        at: [&Vec3; 2],
    ) -> Self {
        let (n, distance) = normal_and_distance(at[0], at[1]);
        let reach = balls[0].body.radius + balls[1].body.radius;
        // One common point: impulses with one line of action keep the angular momentum.
        let levers = balls.map(|ball| distance * ball.body.radius / reach);
        let inv_n = balls[0].inv.0 + balls[1].inv.0;
        let turning = [0, 1].map(|k| levers[k] * levers[k] * balls[k].inv.1);
        Self {
            pair_history,
            ends: [of.a as usize, of.b as usize],
            n,
            levers,
            inv: (inv_n, inv_n + turning[0] + turning[1]),
            limits: of.law.limits().without_rolling(),
            target: 0.0,
            normal_force: 0.0,
            shear_force: Vec3::zeros(),
            seen: [0; 2],
        }
    }

    /// Normal speed apart (m/s).
    #[inline]
    pub(super) fn speed(&self, a: &StepBody, b: &StepBody) -> f64 {
        self.n.dot(&(a.v - b.v))
    }

    /// Slip of the first rock over the second at the touched point (m/s).
    #[inline]
    pub(super) fn slip(&self, a: &StepBody, b: &StepBody) -> Vec3 {
        let u = a.v - b.v;
        u - self.n * self.n.dot(&u) + self.n.cross(&(a.w * self.levers[0] + b.w * self.levers[1]))
    }

    /// Impulse and rotational impulse on end `k`.
    #[inline]
    pub(super) fn load(&self, k: usize) -> Twist {
        let normal_force = self.n * self.normal_force - self.shear_force;
        (
            if k == 0 { normal_force } else { -normal_force },
            self.n.cross(&self.shear_force) * self.levers[k],
        )
    }

    /// Impulses of an impact of the two rocks: the limit of stiff springs, the same map as for a rock and the ground.
    pub(super) fn impact(
        &mut self,
        (law, known, tolerance): (&Law, Option<&BlowTable>, f64),
        [a, b]: [&StepBody; 2],
        captured: bool,
    ) {
        let body = one_for_two(self.inv, a.body.radius.min(b.body.radius));
        let mass = body.mass;
        let (approach, slip) = (-self.speed(a, b), self.slip(a, b));
        let speeds = [approach, slip.norm()];
        let captured = captured || law.is_plastic();
        let known = known.filter(|_| !captured).and_then(|table| table.blow((&body, law), speeds));
        let pushed =
            known.unwrap_or_else(|| blow_along_a_line((&body, law), captured, speeds, tolerance));
        self.normal_force = mass * pushed[0];
        // followed to a tolerance, the impulse of a rock that slides all the while may be beyond its cap by as much
        let shear_force = slip * (mass * pushed[1] / speeds[1].max(f64::MIN_POSITIVE));
        self.shear_force = self.limits.shear(shear_force, self.normal_force);
    }

    /// Finds the impulses for motions that hold the present ones, and acts with what they change by; how much that
    /// changes the speed at the contact (m/s).
    #[inline]
    pub(super) fn solve(&mut self, a: &mut StepBody, b: &mut StepBody) -> f64 {
        let held = self.normal_force;
        let speed = self.speed(a, b);
        let normal_force = (held + (self.target - speed) / self.inv.0).max(0.0);
        if normal_force <= 0.0 && held <= 0.0 {
            return 0.0;
        }
        let stick = self.shear_force + self.slip(a, b) / self.inv.1;
        let next = (normal_force, self.limits.shear(stick, normal_force));
        let change = self.go_to(next, a, b);
        (change.0.abs() * self.inv.0).max(change.1.norm() * self.inv.1)
    }
}

/// What two rocks do to each other is what the ground does to one body with their reduced mass `1/(1/m_a + 1/m_b)`, with their
/// velocity apart and their slip for its velocity, and an inertia that meets friction at the contact point as they do. `inv_n` is
/// one over that mass, `inv_t` the same of the touched point along the surface (1/kg).
fn one_for_two((inv_n, inv_t): (f64, f64), radius: f64) -> Body {
    let mass = 1.0 / inv_n;
    let inertia = mass * radius * radius / (inv_t / inv_n - 1.0);
    Body { mass, inertia, radius, gravity: Vec3::zeros() }
}

/// The blows of all rocks that are of the material of these two, which rebound from each other by `law`.
pub(crate) fn blows_of(law: &Law, [a, b]: [&Body; 2]) -> Option<BlowTable> {
    let inv_n = 1.0 / a.mass + 1.0 / b.mass;
    let turning = [a, b].map(|body| body.radius * body.radius / body.inertia);
    let body = one_for_two((inv_n, inv_n + turning[0] + turning[1]), a.radius.min(b.radius));
    BlowTable::new(&body, &law.without_rolling())
}

impl GroundContact {
    pub(super) fn impulses(&self) -> Impulses {
        Impulses(self.normal_force, self.shear_force, self.turn)
    }

    /// Adds to its impulses what the cone allows, and acts with that.
    pub(super) fn push_on(&mut self, step: &Impulses, ball: &mut StepBody) {
        let next = self.impulses().plus(step).within(&self.limits);
        let change = next.less(&self.impulses());
        let mut step = *self;
        (step.normal_force, step.shear_force, step.turn) = (change.0, change.1, change.2);
        (self.normal_force, self.shear_force, self.turn) = (next.0, next.1, next.2);
        let load = step.load(&ball.body);
        ball.take(&load);
    }

    /// Finds the impulses for a motion that holds the present ones, and acts with what they change by; how much that
    /// changes the speed at the contact (m/s).
    pub(super) fn solve(&mut self, ball: &mut StepBody) -> f64 {
        let held = self.impulses();
        let (normal_force, turn) = self.load(&ball.body);
        let (v, w) = (ball.v - normal_force * ball.inv.0, ball.w - turn * ball.inv.1);
        self.strike(&ball.body, &v, &w);
        if held.0 <= 0.0 && self.normal_force <= 0.0 {
            return 0.0;
        }
        let (normal_force, turn) = self.load(&ball.body);
        (ball.v, ball.w) = (v + normal_force * ball.inv.0, w + turn * ball.inv.1);
        let change = self.impulses().less(&held);
        let along = change.1.norm().max(change.2.norm() / ball.body.radius);
        change.0.abs().max(along) * ball.inv.0
    }
}
