//! The rocks of an island inside one rigid step, and the impulses of their contacts.

use crate::contact::ContactPoint;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::ground::{FrictionLimits, Law};
use crate::rock::{Motion, Vec3};
use crate::solver::body::{Body, Twist};
use crate::solver::impact::{BlowTable, blow_along_a_line};
use crate::solver::impact_point::ImpactPoint;
use crate::solver::island::body::BodySlot;
use crate::solver::island::outcome::MeshImpact;
use crate::solver::rigid::GroundContact;
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
    /// Change of speed in one sweep below which its contacts have converged (m/s).
    pub(super) allowed_m_s: f64,
    /// Time from its last impact to the end of the step (s).
    pub(super) since_s: f64,
    /// Number of impacts in this step.
    pub(super) impacts: u32,
    /// Number of changes of its motion.
    pub(super) version: u32,
    /// Sweep that changed its motion last.
    pub(super) changed_in_sweep: u64,
    /// Last sweep of the position correction that moved it.
    pub(super) shifted: u32,
    /// Whether another rock touches it.
    pub(super) has_neighbour: bool,
    /// Whether a contact pushed it, and whether the position correction moved it.
    pub(super) pushed: bool,
    pub(super) moved: bool,
    /// Its contact with the mesh in this step.
    pub(super) on_mesh: OnMesh,
}

/// Contact of a rock with the mesh in a step, impacts apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum OnMesh {
    /// None.
    Free,
    /// The rock has come to the mesh too slowly to rebound, and is held from there on.
    Captured,
    /// Sustained contact from the start of the step.
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
            impacts: 0,
            version: 1,
            changed_in_sweep: 0,
            shifted: 0,
            has_neighbour: false,
            pushed: false,
            moved: false,
            on_mesh: OnMesh::Free,
        }
    }

    /// Applies an impulse (N s) and a rotational one (N m s).
    #[inline]
    pub(super) fn apply_impulse(&mut self, (normal_impulse, turn): &Twist) {
        self.v += normal_impulse * self.inv.0;
        self.w += turn * self.inv.1;
    }

    /// Applies the impulse of an impact `s` (s) before the end of the step: the rock has moved with it since.
    pub(super) fn apply_impulse_earlier(&mut self, impulse: &Twist, s: f64) {
        self.apply_impulse(impulse);
        self.c += impulse.0 * (self.inv.0 * s);
    }

    /// Centre and velocity `s` (s) before the end of the step, on its parabola.
    pub(super) fn before_end(&self, s: f64) -> (Vec3, Vec3) {
        let a = self.body.gravity;
        (self.c - (self.v - a * (0.5 * s)) * s, self.v - a * s)
    }

    /// The same with its spin, at a time counted from the end of the step.
    pub(super) fn motion_before_end(&self, s: f64) -> Motion {
        let (position_m, velocity_m_s) = self.before_end(s);
        Motion { time_s: -s, position_m, velocity_m_s, spin_rad_s: self.w }
    }

    /// Notes an impact `s` (s) before the end of the step.
    pub(super) fn note_impact(&mut self, s: f64) {
        self.since_s = s;
        self.impacts += 1;
        self.pushed = true;
        self.version += 1;
    }

    /// Work of an impulse at mean velocity `v` and spin `w` (J).
    pub(super) fn work_j((normal_impulse, turn): &Twist, v: &Vec3, w: &Vec3) -> f64 {
        normal_impulse.dot(v) + turn.dot(w)
    }
}

/// Impacts of one rock in one step after which further ones do not rebound.
pub(super) const REBOUNDS_IN_STEP: u32 = 200;

/// Terrain, rocks and pairs on which impacts act.
pub(super) struct ImpactScene<'s> {
    pub(super) terrain: &'s Terrain,
    pub(super) members: &'s mut [BodySlot],
    pub(super) pair_histories: &'s [PairHistory],
}

/// Record of the impact of rock `k`, given by centre and radius, at a contact point.
pub(super) fn hit_of(
    k: usize,
    touch: &ContactPoint,
    ball: (&Vec3, f64),
    approach_m_s: f64,
) -> MeshImpact {
    let on = (touch.feature, touch.triangle);
    MeshImpact { rock: k, struck: ImpactPoint::by_ball(ball, &touch.normal, on, approach_m_s) }
}

/// The impulses of one contact: normal (N s), tangential (N s) and of rolling friction (N m s).
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

    /// Weighted sum of squares.
    pub(super) fn square(&self, [n, t, r]: [f64; 3]) -> f64 {
        n * self.0 * self.0 + t * self.1.norm_squared() + r * self.2.norm_squared()
    }

    /// Projection onto the friction cone.
    fn projected(&self, limits: &FrictionLimits) -> Self {
        let normal_impulse = self.0.max(0.0);
        Self(
            normal_impulse,
            limits.shear(self.1, normal_impulse),
            limits.rolling(self.2, normal_impulse),
        )
    }
}

/// The contact of two rocks and its impulses.
#[derive(Debug, Clone, Copy)]
pub(super) struct BallContact {
    /// Place of its pair among the pairs of the island.
    pub(super) pair_history: usize,
    /// The two rocks, as places in the island.
    pub(super) ends: [usize; 2],
    /// Unit normal from the second to the first.
    pub(super) n: Vec3,
    /// Distances from the centres to the common contact point (m).
    pub(super) levers: [f64; 2],
    /// `1/m_a + 1/m_b`, and the inverse mass of the contact point along the surface (1/kg).
    pub(super) inv: (f64, f64),
    /// Limits of friction.
    pub(super) limits: FrictionLimits,
    /// Normal separation speed wanted after the impulse (m/s).
    pub(super) target_m_s: f64,
    /// Normal impulse (N s), ≥ 0.
    pub(super) normal_impulse: f64,
    /// Tangential impulse `q`: `−q` acts on the first rock, `q` on the second (N s).
    pub(super) shear_impulse: Vec3,
    /// Versions of the motions of its rocks when it was solved last.
    pub(super) seen_versions: [u32; 2],
}

impl BallContact {
    pub(super) fn impulses(&self) -> Impulses {
        Impulses(self.normal_impulse, self.shear_impulse, Vec3::zeros())
    }

    /// Adds a step to its impulses, projected onto the cone, and applies the change.
    pub(super) fn add_projected(&mut self, step: &Impulses, a: &mut StepBody, b: &mut StepBody) {
        let next = self.impulses().plus(step).projected(&self.limits);
        self.apply_impulses((next.0, next.1), a, b);
    }

    /// Sets the impulses and applies their change to both rocks; the change.
    #[inline]
    fn apply_impulses(
        &mut self,
        next: (f64, Vec3),
        a: &mut StepBody,
        b: &mut StepBody,
    ) -> (f64, Vec3) {
        let change = (next.0 - self.normal_impulse, next.1 - self.shear_impulse);
        (self.normal_impulse, self.shear_impulse) = next;
        let (push, turn) = (self.n * change.0 - change.1, self.n.cross(&change.1));
        a.apply_impulse(&(push, turn * self.levers[0]));
        b.apply_impulse(&(-push, turn * self.levers[1]));
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
        // one common point: impulses with one line of action conserve angular momentum
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
            target_m_s: 0.0,
            normal_impulse: 0.0,
            shear_impulse: Vec3::zeros(),
            seen_versions: [0; 2],
        }
    }

    /// Normal separation speed (m/s).
    #[inline]
    pub(super) fn speed(&self, a: &StepBody, b: &StepBody) -> f64 {
        self.n.dot(&(a.v - b.v))
    }

    /// Slip of the first rock over the second at the contact point (m/s).
    #[inline]
    pub(super) fn slip(&self, a: &StepBody, b: &StepBody) -> Vec3 {
        let u = a.v - b.v;
        u - self.n * self.n.dot(&u) + self.n.cross(&(a.w * self.levers[0] + b.w * self.levers[1]))
    }

    /// Impulse and rotational impulse on end `k`.
    #[inline]
    pub(super) fn load(&self, k: usize) -> Twist {
        let normal_impulse = self.n * self.normal_impulse - self.shear_impulse;
        (
            if k == 0 { normal_impulse } else { -normal_impulse },
            self.n.cross(&self.shear_impulse) * self.levers[k],
        )
    }

    /// Sets the impulses to those of an impact of the two rocks in the limit of stiff springs, by the same map as for a
    /// rock and the ground.
    pub(super) fn impact(
        &mut self,
        (law, known, tolerance): (&Law, Option<&BlowTable>, f64),
        [a, b]: [&StepBody; 2],
        captured: bool,
    ) {
        let body = reduced_body(self.inv, a.body.radius.min(b.body.radius));
        let mass = body.mass;
        let (approach, slip) = (-self.speed(a, b), self.slip(a, b));
        let speeds = [approach, slip.norm()];
        let captured = captured || law.is_plastic();
        let known = known.filter(|_| !captured).and_then(|table| table.blow((&body, law), speeds));
        let pushed =
            known.unwrap_or_else(|| blow_along_a_line((&body, law), captured, speeds, tolerance));
        self.normal_impulse = mass * pushed[0];
        // integrated to a tolerance, the impulse of a contact that slides throughout may exceed its cap by as much
        let shear_impulse = slip * (mass * pushed[1] / speeds[1].max(f64::MIN_POSITIVE));
        self.shear_impulse = self.limits.shear(shear_impulse, self.normal_impulse);
    }

    /// Solves the contact for motions that include its present impulses, and applies the change; the change of speed
    /// at the contact (m/s).
    #[inline]
    pub(super) fn solve(&mut self, a: &mut StepBody, b: &mut StepBody) -> f64 {
        let held = self.normal_impulse;
        let speed = self.speed(a, b);
        let normal_impulse = (held + (self.target_m_s - speed) / self.inv.0).max(0.0);
        if normal_impulse <= 0.0 && held <= 0.0 {
            return 0.0;
        }
        let stick = self.shear_impulse + self.slip(a, b) / self.inv.1;
        let next = (normal_impulse, self.limits.shear(stick, normal_impulse));
        let change = self.apply_impulses(next, a, b);
        (change.0.abs() * self.inv.0).max(change.1.norm() * self.inv.1)
    }
}

/// The body whose impact on the ground equals the impact of two rocks: it has their reduced mass `1/(1/m_a + 1/m_b)`, moves
/// with their relative velocity and slip, and has the inertia that gives the same tangential mass at the contact point.
/// `inv_n` is the inverse reduced mass, `inv_t` the inverse mass of the contact point along the surface (1/kg).
fn reduced_body((inv_n, inv_t): (f64, f64), radius: f64) -> Body {
    let mass = 1.0 / inv_n;
    let inertia = mass * radius * radius / (inv_t / inv_n - 1.0);
    Body { mass, inertia, radius, gravity: Vec3::zeros() }
}

/// Table of the impacts of all rocks of the material of these two, which rebound from each other by `law`.
pub(crate) fn blows_of(law: &Law, [a, b]: [&Body; 2]) -> Option<BlowTable> {
    let inv_n = 1.0 / a.mass + 1.0 / b.mass;
    let turning = [a, b].map(|body| body.radius * body.radius / body.inertia);
    let body = reduced_body((inv_n, inv_n + turning[0] + turning[1]), a.radius.min(b.radius));
    BlowTable::new(&body, &law.without_rolling())
}

impl GroundContact {
    pub(super) fn impulses(&self) -> Impulses {
        Impulses(self.normal_impulse, self.shear_impulse, self.rolling_impulse)
    }

    /// Adds a step to its impulses, projected onto the cone, and applies the change.
    pub(super) fn add_projected(&mut self, step: &Impulses, ball: &mut StepBody) {
        let next = self.impulses().plus(step).projected(&self.limits);
        let change = next.less(&self.impulses());
        let mut step = *self;
        (step.normal_impulse, step.shear_impulse, step.rolling_impulse) =
            (change.0, change.1, change.2);
        (self.normal_impulse, self.shear_impulse, self.rolling_impulse) = (next.0, next.1, next.2);
        let load = step.load(&ball.body);
        ball.apply_impulse(&load);
    }

    /// Solves the contact for a motion that includes its present impulses, and applies the change; the change of speed
    /// at the contact (m/s).
    pub(super) fn solve(&mut self, ball: &mut StepBody) -> f64 {
        let held = self.impulses();
        let (normal_impulse, turn) = self.load(&ball.body);
        let (v, w) = (ball.v - normal_impulse * ball.inv.0, ball.w - turn * ball.inv.1);
        self.solve_for(&ball.body, &v, &w);
        if held.0 <= 0.0 && self.normal_impulse <= 0.0 {
            return 0.0;
        }
        let (normal_impulse, turn) = self.load(&ball.body);
        (ball.v, ball.w) = (v + normal_impulse * ball.inv.0, w + turn * ball.inv.1);
        let change = self.impulses().less(&held);
        let along = change.1.norm().max(change.2.norm() / ball.body.radius);
        change.0.abs().max(along) * ball.inv.0
    }
}
