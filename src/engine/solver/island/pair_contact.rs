//! The contact of two rocks in an implicit stage: the law of
//! [`StageContact`](crate::solver::law::StageContact) with a second body.

use crate::contact::pair::{Bond, PairHistory, PairImpact, normal_and_distance};
use crate::ground::{Law, NormalElement, NormalLine};
use crate::rock::Vec3;
use crate::solver::body::{Body, Twist};

/// A contact of two rocks: its state at the stage's base and the unknown forces.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairContact {
    /// Place of its pair among the pairs of the island.
    pub(super) pair_history: usize,
    /// The two rocks, as places in the island.
    pub(super) ends: [usize; 2],
    pub(super) law: Law,
    /// Normal spring and dashpot in force.
    pub(super) normal: NormalElement,
    /// Whether it is too slow to rebound.
    pub(super) captured: bool,
    /// The impact under way.
    pub(super) impact: PairImpact,
    /// Whether it begins an impact that is deferred: it exerts no force in the present try.
    pub(super) deferred: bool,
    /// Bond that also acts in tension.
    pub(super) bond: Option<Bond>,
    /// Unit normal from the second to the first.
    pub(super) n: Vec3,
    /// Penetration at the stage's base, along `n` (m).
    pub(super) penetration: f64,
    /// Stretch of the shear spring at the base (m).
    pub(super) shear: Vec3,
    /// Distances from the centres to the common contact point (m): forces with one line of action
    /// conserve the angular momentum.
    pub(super) levers: [f64; 2],
    /// Normal force (N), negative only in a bond.
    pub(super) normal_force: f64,
    /// Shear force `q`: `−q` acts on the first rock, `q` on the second (N).
    pub(super) shear_force: Vec3,
    /// Masses (kg) and moments of inertia (kg m²) of the two rocks.
    pub(super) inertia: [(f64, f64); 2],
    /// `1/m_a + 1/m_b` (1/kg).
    pub(super) inv_m: f64,
    /// Inverse effective mass of the contact point along the surface, `+ L_a²/I_a + L_b²/I_b`
    /// (1/kg).
    pub(super) inv_t: f64,
}

impl PairContact {
    /// The contact of a pair for centres at `at`, if their gap is at most `slack` (m); without
    /// stretch and shear force.
    pub(super) fn of_pair(
        pair_history: &PairHistory,
        bodies: [&Body; 2],
        at: [&Vec3; 2],
        slack: f64,
    ) -> Option<Self> {
        let (n, distance) = normal_and_distance(at[0], at[1]);
        let reach = bodies[0].radius + bodies[1].radius;
        if distance > reach + slack && pair_history.bond.is_none() {
            return None;
        }
        let levers = bodies.map(|body| distance * body.radius / reach);
        let inv_m = 1.0 / bodies[0].mass + 1.0 / bodies[1].mass;
        let turning = [0, 1].map(|k| levers[k] * levers[k] / bodies[k].inertia);
        Some(Self {
            pair_history: 0,
            ends: [pair_history.a as usize, pair_history.b as usize],
            law: pair_history.law,
            normal: pair_history.law.normal(pair_history.captured),
            captured: pair_history.captured,
            impact: pair_history.impact,
            deferred: false,
            bond: pair_history.bond,
            n,
            penetration: pair_history.bond.map_or(reach, |bond| bond.length_m) - distance,
            shear: Vec3::zeros(),
            levers,
            normal_force: pair_history.normal_force,
            shear_force: Vec3::zeros(),
            inertia: bodies.map(|body| (body.mass, body.inertia)),
            inv_m,
            inv_t: inv_m + turning[0] + turning[1],
        })
    }

    /// Begins the contact of bodies that approach at a speed (m/s): too slow to rebound, or an
    /// impact. During an impact of one of them, at a speed (m/s, 0 if none), it is part of that
    /// impact, however slow it is.
    pub(super) fn begin(&mut self, approach_m_s: f64, impact_m_s: f64) {
        let fastest_m_s = approach_m_s.max(impact_m_s);
        self.captured = fastest_m_s < self.law.capture_m_s;
        self.normal = self.law.normal(self.captured);
        if !self.captured {
            self.impact = PairImpact::new(fastest_m_s);
        }
    }

    /// Begins the contact in a try in which onsets of impacts are deferred to its end.
    pub(super) fn defer_impact(&mut self, approach_m_s: f64) {
        self.deferred = !self.captured && approach_m_s >= self.law.capture_m_s;
        if self.deferred {
            self.normal = NormalElement::NONE;
        }
    }

    /// Penetration (m) at the end of a stage of length `h` with the normal separation speed `vn`.
    #[inline]
    pub(super) fn penetration_at(&self, vn: f64, h: f64) -> f64 {
        self.penetration - h * vn
    }

    /// Whether it exerts any force.
    #[inline]
    pub(super) fn has_force(&self) -> bool {
        self.normal_force != 0.0 || self.bond.is_some()
    }

    /// Normal separation speed (m/s).
    #[inline]
    pub(super) fn speed(&self, [a, b]: [&Twist; 2]) -> f64 {
        self.n.dot(&(a.0 - b.0))
    }

    /// Slip of the first rock over the second at the contact point (m/s).
    pub(super) fn slip(&self, [a, b]: [&Twist; 2]) -> Vec3 {
        let u = a.0 - b.0;
        u - self.n * self.n.dot(&u) + self.n.cross(&(a.1 * self.levers[0] + b.1 * self.levers[1]))
    }

    /// Trial shear force: that without sliding (N).
    pub(super) fn trial(&self, ends: [&Twist; 2], h: f64) -> Vec3 {
        self.law.shear.spring_force(self.shear)
            + self.slip(ends) * self.law.shear.stage_stiffness(h)
    }

    /// Solves the forces for motions without this contact's own effect, over a stage of length `h`.
    pub(super) fn solve(&mut self, ends: [&Twist; 2], h: f64) {
        let vn = self.speed(ends);
        if self.bond.is_none() {
            self.normal_force = self.normal.stage_force(self.penetration, vn, 1.0 / self.inv_m, h);
            if self.normal_force <= 0.0 {
                self.shear_force = Vec3::zeros();
                return;
            }
        }
        let free = self.trial(ends, h) / (1.0 + h * self.law.shear.stage_stiffness(h) * self.inv_t);
        if self.bond.is_some() {
            let line = self.normal.bond(self.penetration, h);
            self.normal_force = line.bilateral_force(vn, h, self.inv_m);
            self.shear_force = free;
            return;
        }
        self.shear_force = self.law.shear.capped(free, self.normal_force);
    }

    /// Sets the forces to those of the law at the motions of both rocks.
    pub(super) fn set_forces_at(&mut self, ends: [&Twist; 2], h: f64) {
        let (speed, stick) = (self.speed(ends), self.trial(ends, h));
        if self.bond.is_some() {
            self.normal_force = self.normal.bilateral_force(self.penetration_at(speed, h), speed);
            self.shear_force = stick;
        } else {
            self.normal_force = self.line(h).at(speed);
            self.shear_force = self.law.shear.capped(stick, self.normal_force);
        }
    }

    /// Sets the forces to those of the present state, for the explicit first stage; returns the
    /// rate of the shear spring.
    pub(super) fn set_forces_now(&mut self, ends: [&Twist; 2]) -> Vec3 {
        let (penetration, vn) = (self.penetration, self.speed(ends));
        let held = self.law.shear.spring_force(self.shear);
        let stick = held + self.law.shear.dashpot_force(self.slip(ends));
        if self.bond.is_some() {
            (self.normal_force, self.shear_force) =
                (self.normal.bilateral_force(penetration, vn), stick);
        } else {
            self.normal_force = self.normal.force(penetration.max(0.0), vn);
            self.shear_force = self.law.shear.capped(stick, self.normal_force);
        }
        self.law.shear.stretch_rate(self.shear_force, held)
    }

    /// Normal force linearised in its present mode.
    pub(super) fn line(&self, h: f64) -> NormalLine {
        self.normal.line((self.penetration, self.normal_force), 1.0 / self.inv_m, h)
    }

    /// Force and moment on end `k` (N, N m).
    #[inline]
    pub(super) fn load(&self, k: usize) -> Twist {
        let force = self.n * self.normal_force - self.shear_force;
        let torque = self.n.cross(&self.shear_force) * self.levers[k];
        (if k == 0 { force } else { -force }, torque)
    }

    /// Adds the effect of its load on end `k` over `times_h` (s) to that end's motion.
    #[inline]
    pub(super) fn apply_effect(&self, k: usize, times_h: f64, (v, w): &mut Twist) {
        let (force, torque) = self.load(k);
        let (mass, inertia) = self.inertia[k];
        *v += force * (times_h / mass);
        *w += torque * (times_h / inertia);
    }

    /// Stretch of the shear spring at the stage's end: `ξ' = (h q + c_s ξ*)/(h p_s + c_s)`.
    pub(super) fn stretch(&self, h: f64) -> Vec3 {
        self.law.shear.stretch_after(&self.shear_force, &self.shear, h)
    }
}
