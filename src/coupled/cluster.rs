//! An island of rocks that may touch each other, and its adaptive step.

use super::bridge::Bridge;
use super::global::Global;
use super::member::{Member, Seat};
use super::rigid::{Hit, Pile};
use super::sweeps::Stirred;
use crate::contact::pair::{Tie, between};
use crate::rock::Vec3;
use crate::step::adaptive::{self, Control, ONSET, Outcome, Stuck, TRAVEL, Trial};
use crate::step::grip::{Loss, World};
use crate::step::tableau::{STAGES, Tableau};
use crate::terrain::Terrain;

/// A gap between two rocks that counts as a touch (–, relative to the sum of their radii): rounding of the leap.
pub(super) const TOUCH: f64 = 1e-9;
/// Overload at which a bond does not simply break: the step is cut to find the moment.
const OVERLOAD: f64 = 0.05;

/// Energy that a rock gives away through its contacts with other rocks (J), or power (W).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Given {
    /// Its half of what those contacts take.
    pub lost: f64,
    /// Handed on to the other rocks, negative if received.
    pub passed_on: f64,
}

impl Given {
    /// Of the two ends of a contact, from the work that each does on it.
    pub(super) fn of_ends([a, b]: [f64; 2]) -> [Self; 2] {
        let lost = 0.5 * (a + b);
        [Self { lost, passed_on: a - lost }, Self { lost, passed_on: b - lost }]
    }

    /// The same of impulses over a whole step, in which friction that turns round may seem to work: that is the step's error.
    pub(super) fn of_impulses(work: [f64; 2]) -> [Self; 2] {
        Self::of_ends(work).map(|one| Self { lost: one.lost.max(0.0), ..one })
    }

    /// Adds `other` times `factor`.
    pub(super) fn add(&mut self, other: &Self, factor: f64) {
        self.lost += factor * other.lost;
        self.passed_on += factor * other.passed_on;
    }

    /// All of it.
    pub fn sum(&self) -> f64 {
        self.lost + self.passed_on
    }
}

/// What one step did.
#[derive(Debug, Clone, Default)]
pub struct Done {
    /// Time gone (s).
    pub dt: f64,
    /// Energy lost to the ground, for each rock (J).
    pub losses: Vec<Loss>,
    /// Energy given to other rocks, for each rock (J).
    pub given: Vec<Given>,
    /// Steps tried and thrown away.
    pub rejected: u64,
    /// Impacts on the mesh (`rigid`; with the others the memory of a contact tells).
    pub hits: Vec<Hit>,
    /// Whether contact states did not settle (`dda`, `rigid`).
    pub unsettled: bool,
    /// Bonds that broke.
    pub broken: u64,
}

/// An island: rocks, and a tie for every two of them that may touch.
#[derive(Debug)]
pub struct Cluster<'a> {
    /// The mesh.
    pub terrain: &'a Terrain,
    /// The rocks.
    pub members: Vec<Seat>,
    /// The ties, in ascending order; `a` and `b` are places in `members`.
    pub ties: Vec<Tie>,
    /// Step to try next (s).
    pub h: f64,
    /// Sweeps over the contacts so far.
    pub sweeps: u64,
    /// Systems solved by factorisation so far.
    pub jumps: u64,
    /// Whether the first rates belong to the present state.
    pub fresh: bool,
    pub(super) bridges: Vec<Bridge>,
    pub(super) stirred: Stirred,
    pub(super) tolerance: f64,
    /// Rates of the shear springs at each stage.
    pub(super) tie_rates: Vec<[Vec3; STAGES]>,
    /// Forces of the last solution.
    pub(super) tie_forces: Vec<(f64, Vec3)>,
    /// The global system of fixed steps.
    pub(super) global: Global,
    /// Work space of rigid steps.
    pub(super) pile: Pile,
}

impl<'a> Cluster<'a> {
    /// An island of these rocks.
    pub fn new(terrain: &'a Terrain, members: Vec<Seat>, ties: Vec<Tie>) -> Self {
        let tie_forces = ties.iter().map(|tie| (tie.push, tie.drag)).collect();
        Self {
            terrain,
            members,
            h: f64::INFINITY,
            sweeps: 0,
            jumps: 0,
            fresh: false,
            bridges: Vec::new(),
            stirred: Stirred::default(),
            tolerance: 0.0,
            tie_rates: vec![[Vec3::zeros(); STAGES]; ties.len()],
            tie_forces,
            global: Global::default(),
            pile: Pile::default(),
            ties,
        }
    }

    /// One accepted step of at most `h_max` (s).
    ///
    /// # Errors
    /// [`Stuck`] if the step had to become too short to matter.
    pub fn advance(&mut self, control: &Control, h_max: f64) -> Result<Done, Stuck> {
        self.tolerance = control.tolerance;
        if !self.fresh {
            self.rates_now();
        }
        let omega = self.omega();
        if !self.h.is_finite() {
            self.h = ONSET / omega;
        }
        self.members.iter_mut().for_each(|member| member.known = member.grip.holds.len());
        let mut rejected = 0;
        let mut trial = Try { island: self, control, omega };
        let dt = adaptive::settle(&mut trial, control, h_max, &mut rejected)?;
        Ok(Done { rejected, ..self.accept(control.tableau, dt) })
    }

    /// Whether motion, height and springs of the whole island together hold more at the step's end than at its start.
    fn gains(&self, hh: f64) -> bool {
        let (mut before, mut after, mut unknown) = (0.0, 0.0, 0.0);
        for Member { grip, body, end, .. } in self.members.iter().map(|member| &**member) {
            let motion =
                0.5 * (body.mass * end.v.norm_squared() + body.inertia * end.w.norm_squared());
            let lifted = -body.mass * body.gravity.dot(&(end.c - grip.c));
            before += grip.motion_j(body) + grip.stored;
            after += motion + lifted + adaptive::pressed_j(grip, end, hh);
            unknown += adaptive::PLACE_ROUNDING * body.radius * body.mass * body.gravity.norm();
        }
        for tie in self.ties.iter().filter(|tie| tie.is_held()) {
            let [a, b] = [tie.a, tie.b].map(|k| &self.members[k as usize]);
            let (_, distance) = between(&a.grip.c, &b.grip.c);
            let reach = tie.bond.map_or(a.body.radius + b.body.radius, |bond| bond.length_m);
            let pen =
                if tie.bond.is_some() { reach - distance } else { (reach - distance).max(0.0) };
            before += 0.5 * (tie.law.p_n * pen * pen + tie.law.p_s * tie.shear.norm_squared());
        }
        for bridge in &self.bridges {
            let ends = bridge.ends.map(|k| (self.members[k].end.v, self.members[k].end.w));
            let mut pen = bridge.pen - hh * bridge.speed([&ends[0], &ends[1]]);
            if bridge.bond.is_none() {
                pen = pen.max(0.0);
            }
            if pen > 0.0 || bridge.push > 0.0 || bridge.bond.is_some() {
                let shear = bridge.stretch(hh);
                after += 0.5 * (bridge.law.p_n * pen * pen + bridge.law.p_s * shear.norm_squared());
            }
            let least = bridge.levers[0].min(bridge.levers[1]);
            unknown += adaptive::PLACE_ROUNDING * least * bridge.push.abs();
        }
        after > before + adaptive::ROUNDING * before + unknown
    }

    /// Largest `√(p_N/m)` among the contacts there are or may be (rad/s).
    fn omega(&self) -> f64 {
        let ties = self.ties.iter().filter(|tie| tie.is_held()).map(|tie| tie.law.omega);
        let ground = self.members.iter().map(|member| member.omega(self.terrain));
        let omega = ties.chain(ground).fold(0.0, f64::max);
        let all = self.members.iter().flat_map(|member| &member.laws).map(|law| law.omega);
        if omega > 0.0 { omega } else { all.fold(1.0, f64::max) }
    }

    /// Longest step in which nothing jumps over a feature or another rock (s).
    pub(super) fn travel_limit(&mut self) -> f64 {
        let mut limit = f64::INFINITY;
        for member in self.members.iter_mut().filter(|member| !member.flying) {
            let Member { grip, body, laws, .. } = &mut **member;
            let world = World { terrain: self.terrain, body: *body, laws };
            limit = limit.min(adaptive::travel_limit(&world, grip));
        }
        for tie in &self.ties {
            let [a, b] = [tie.a, tie.b].map(|k| &self.members[k as usize]);
            if a.flying && b.flying && !tie.is_held() {
                continue;
            }
            let gap = (a.grip.c - b.grip.c).norm() - a.body.radius - b.body.radius;
            let room = TRAVEL * a.body.radius.min(b.body.radius) + gap.max(0.0);
            let speed = (a.grip.v - b.grip.v).norm();
            if speed > 0.0 {
                limit = limit.min(room / speed);
            }
        }
        limit
    }

    /// One step to its last stage; its error relative to the tolerance, `None` if a stage does not settle.
    fn attempt(&mut self, control: &Control, dt: f64) -> Option<f64> {
        let tableau = control.tableau;
        for i in 1..tableau.stages {
            self.stage(tableau, i, dt)?;
        }
        if self.tears_badly() {
            return None;
        }
        Some(dt * self.error(tableau) / control.tolerance)
    }

    /// Whether a bond is loaded far beyond its strength, which a shorter step would have found out.
    fn tears_badly(&self) -> bool {
        self.h * self.omega() > 1e-6
            && self.bridges.iter().any(|bridge| {
                let holds = |bond: &crate::contact::pair::Bond| {
                    bond.overload(bridge.push, bridge.drag.norm(), bridge.law.friction)
                };
                let tie = &self.ties[bridge.tie];
                // One that is overloaded from the start breaks at once: no shorter step changes that.
                bridge.bond.as_ref().is_some_and(|bond| {
                    holds(bond) > OVERLOAD
                        && bond.overload(tie.push, tie.drag.norm(), tie.law.friction) <= 0.0
                })
            })
    }

    /// Largest error of the embedded method (m/s²).
    fn error(&self, tableau: &Tableau) -> f64 {
        let weights = &tableau.error[..tableau.stages];
        let mut worst2 = 0.0f64;
        let mut omegas: Vec<f64> =
            self.members.iter().map(|member| member.omega(self.terrain)).collect();
        for (tie, rates) in self.ties.iter().zip(&self.tie_rates).filter(|(tie, _)| tie.is_held()) {
            for k in [tie.a as usize, tie.b as usize] {
                omegas[k] = omegas[k].max(tie.law.omega);
            }
            let sums = rates.iter().zip(weights);
            let drift = sums.fold(Vec3::zeros(), |sum, (rate, weight)| sum + rate * *weight);
            worst2 = worst2.max(drift.norm_squared() * tie.law.omega.powi(2));
        }
        for (member, omega) in self.members.iter().zip(&omegas) {
            let mut off = [Vec3::zeros(); 3];
            for (rate, weight) in member.grip.rates.iter().zip(weights) {
                off[0] += rate.c * *weight;
                off[1] += rate.v * *weight;
                off[2] += rate.w * *weight;
            }
            let mut stretch2 = off[0].norm_squared();
            for k in 0..member.grip.holds.len() {
                let sums = member.grip.rates.iter().zip(weights);
                let drift =
                    sums.fold(Vec3::zeros(), |sum, (rate, weight)| sum + rate.shear[k] * *weight);
                stretch2 = stretch2.max(drift.norm_squared());
            }
            worst2 = worst2
                .max(stretch2 * omega * omega)
                .max(off[1].norm_squared())
                .max(off[2].norm_squared() * member.body.radius.powi(2));
        }
        worst2.sqrt()
    }
}

/// A step of the island, tried with any length.
struct Try<'i, 'a> {
    island: &'i mut Cluster<'a>,
    control: &'i Control,
    omega: f64,
}

impl Trial for Try<'_, '_> {
    fn h(&mut self) -> &mut f64 {
        &mut self.island.h
    }

    fn limit(&mut self) -> f64 {
        self.island.travel_limit()
    }

    fn omega(&self) -> f64 {
        self.omega
    }

    fn try_step(&mut self, dt: f64) -> Outcome {
        let outcome = match self.island.attempt(self.control, dt) {
            None => Outcome::Unsettled,
            Some(error) if error <= 1.0 => {
                let hh = self.control.tableau.diagonal * dt;
                let gains = dt * self.omega > adaptive::RESOLVED && self.island.gains(hh);
                if gains { Outcome::Gains } else { return Outcome::Error(error) }
            }
            Some(error) => Outcome::Error(error),
        };
        // Memories that came up in a step thrown away go with it.
        for member in self.island.members.iter_mut().map(|seat| &mut **seat) {
            member.grip.holds.truncate(member.known);
        }
        outcome
    }
}
