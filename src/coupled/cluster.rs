//! An island of rocks that may touch each other, and its adaptive step.

use super::bridge::{Bridge, Motion};
use super::global::Global;
use crate::contact::Feature;
use crate::contact::hold::carry;
use crate::contact::pair::{Tie, between};
use crate::contact::submatrix::Vec6;
use crate::ground::Law;
use crate::rock::Vec3;
use crate::step::adaptive::{self, Control, ONSET, SHORTEST, Stuck, TRAVEL};
use crate::step::dda::joint::Joint;
use crate::step::grip::{Grip, Loss, World};
use crate::step::law::{Body, Spot};
use crate::step::stage::End;
use crate::step::tableau::{STAGES, Tableau};
use crate::terrain::Terrain;

/// A gap between two rocks that counts as a touch (–, relative to the sum of their radii): rounding of the leap.
pub(super) const TOUCH: f64 = 1e-9;
/// Overload at which a bond does not simply break: the step is cut to find the moment.
const OVERLOAD: f64 = 0.05;

/// One rock of an island.
#[derive(Debug)]
pub struct Member {
    /// Motion, contacts with the mesh and scratch space.
    pub grip: Grip,
    /// Mass, size, gravity.
    pub body: Body,
    /// The law of every ground for this rock.
    pub laws: Vec<Law>,
    /// Whether nothing touches it.
    pub flying: bool,
    pub(super) base: End,
    pub(super) guess: Vec3,
    /// Velocity and spin at the stage's end without contact forces …
    pub(super) free: Motion,
    /// … and with them.
    pub(super) now: Motion,
    end: End,
    /// Forces of the last solution, to start the next from.
    pub(super) kept: Vec<(Feature, f64, Vec3, Vec3)>,
    /// Power given to other rocks at each stage (W).
    given: [f64; STAGES],
    known: usize,
    /// Contacts with the mesh in a fixed step.
    pub(super) joints: Vec<Joint>,
    /// Displacement in a fixed step: free, and what contacts add.
    pub(super) ways: [Vec6; 2],
}

impl Default for Member {
    /// A place holder.
    fn default() -> Self {
        let nothing = Body { mass: 1.0, inertia: 1.0, radius: 1.0, gravity: Vec3::zeros() };
        Self::new(nothing, Vec::new(), (Vec3::zeros(), Vec3::zeros(), Vec3::zeros()))
    }
}

impl Member {
    /// A rock in flight at `(c, v, w)`.
    pub fn new(body: Body, laws: Vec<Law>, (c, v, w): (Vec3, Vec3, Vec3)) -> Self {
        let zero = (Vec3::zeros(), Vec3::zeros());
        let end = End { c, v, w };
        let grip = Grip { c, v, w, ..Grip::unused() };
        Self {
            grip,
            body,
            laws,
            flying: true,
            base: end,
            guess: c,
            free: zero,
            now: zero,
            end,
            kept: Vec::new(),
            given: [0.0; STAGES],
            known: 0,
            joints: Vec::new(),
            ways: [Vec6::zeros(); 2],
        }
    }

    pub(super) fn spots(&self) -> &[Spot] {
        &self.grip.spots[..self.grip.spot_count]
    }

    /// Stiffest contact with the mesh (rad/s), 0 if there is none.
    fn omega(&self, terrain: &Terrain) -> f64 {
        let world = World { terrain, body: self.body, laws: &self.laws };
        self.grip.holds.iter().map(|hold| world.law(hold.triangle).omega).fold(0.0, f64::max)
    }
}

/// What one step did.
#[derive(Debug, Clone, Default)]
pub struct Done {
    /// Time gone (s).
    pub dt: f64,
    /// Energy lost to the ground, for each rock (J).
    pub losses: Vec<Loss>,
    /// Energy given to other rocks, for each rock (J), negative if received.
    pub given_j: Vec<f64>,
    /// Steps tried and thrown away.
    pub rejected: u64,
    /// Whether contact states did not settle (`dda`).
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
    pub members: Vec<Box<Member>>,
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
    pub(super) tolerance: f64,
    /// Rates of the shear springs at each stage.
    tie_rates: Vec<[Vec3; STAGES]>,
    /// Forces of the last solution.
    tie_forces: Vec<(f64, Vec3)>,
    /// The global system of fixed steps.
    pub(super) global: Global,
}

impl<'a> Cluster<'a> {
    /// An island of these rocks.
    pub fn new(terrain: &'a Terrain, members: Vec<Box<Member>>, ties: Vec<Tie>) -> Self {
        let tie_forces = ties.iter().map(|tie| (tie.push, tie.drag)).collect();
        Self {
            terrain,
            members,
            h: f64::INFINITY,
            sweeps: 0,
            jumps: 0,
            fresh: false,
            bridges: Vec::new(),
            tolerance: 0.0,
            tie_rates: vec![[Vec3::zeros(); STAGES]; ties.len()],
            tie_forces,
            global: Global::default(),
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
        loop {
            let wished = self.h.min(self.travel_limit());
            let dt = wished.min(h_max);
            let ratio = match self.attempt(control, dt) {
                // A step that gains energy has met a kink of the law in an unlucky place: a shorter one does not.
                Some(error)
                    if error <= 1.0
                        && dt * omega > adaptive::RESOLVED
                        && self.gains(control.tableau.diagonal * dt) =>
                {
                    0.4
                }
                Some(error) if error <= 1.0 => {
                    let grown = adaptive::grown(control, dt, error);
                    self.h = grown.max(if dt < wished { wished } else { 0.0 });
                    let done = self.accept(control.tableau, dt);
                    return Ok(Done { rejected, ..done });
                }
                Some(error) if error.is_finite() => adaptive::grown(control, 1.0, error),
                _ => 0.25,
            };
            rejected += 1;
            self.h = dt * ratio;
            for member in &mut self.members {
                member.grip.holds.truncate(member.known);
            }
            if self.h * omega < SHORTEST {
                return Err(Stuck::Unsettled);
            }
        }
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
            let pen = if tie.bond.is_some() { reach - distance } else { (reach - distance).max(0.0) };
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
        if self.tears_badly(tableau.diagonal * dt) {
            return None;
        }
        Some(dt * self.error(tableau) / control.tolerance)
    }

    /// Whether a bond is loaded far beyond its strength, which a shorter step would have found out.
    fn tears_badly(&self, _hh: f64) -> bool {
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

    /// Solves implicit stage `i` of a step of length `h` and stores its rates.
    fn stage(&mut self, tableau: &Tableau, i: usize, h: f64) -> Option<()> {
        let hh = tableau.diagonal * h;
        for member in &mut self.members {
            let before = &member.grip.rates[i - 1];
            let (ahead_c, ahead_v) = (before.c, before.v);
            member.base = member.grip.base(tableau, i, h);
            member.guess = member.base.c + (ahead_c + ahead_v * hh) * hh;
            member.free = (member.base.v + member.body.gravity * hh, member.base.w);
            member.look(self.terrain);
        }
        for _ in 0..crate::step::stage::PASSES {
            for member in &mut self.members {
                member.place_spots(self.terrain, tableau, (i, h));
            }
            self.place_bridges(tableau, (i, h));
            if !self.settle(hh) {
                return None;
            }
            let mut agreed = true;
            for member in &mut self.members {
                let c = member.base.c + member.now.0 * hh;
                let allowed = crate::step::stage::AGREED * member.body.radius;
                agreed &= (c - member.guess).norm() <= allowed;
                member.guess = c;
                member.look(self.terrain);
            }
            if agreed {
                self.store(i, hh);
                return Some(());
            }
        }
        None
    }

    /// Makes the ties of rocks that are near into bridges based at the stage's base.
    fn place_bridges(&mut self, tableau: &Tableau, (i, h): (usize, f64)) {
        self.bridges.clear();
        for (k, tie) in self.ties.iter().enumerate() {
            let [a, b] = [tie.a, tie.b].map(|k| &self.members[k as usize]);
            let slack = 0.1 * a.body.radius.min(b.body.radius);
            let bodies = [&a.body, &b.body];
            let Some(mut bridge) = Bridge::over(tie, bodies, [&a.guess, &b.guess], slack) else {
                continue;
            };
            bridge.tie = k;
            let apart = bridge.n.dot(&((a.base.c - b.base.c) - (a.guess - b.guess)));
            bridge.pen -= apart;
            if !tie.is_held() {
                bridge.captured = -bridge.n.dot(&(a.base.v - b.base.v)) < tie.law.capture_m_s;
                bridge.c_n =
                    if bridge.captured { tie.law.c_n_captured } else { tie.law.c_n };
            }
            let from = if tie.is_held() { tie.n } else { bridge.n };
            let mut shear = tie.shear;
            for (rate, a) in self.tie_rates[k].iter().zip(tableau.a[i]) {
                shear += rate * (h * a);
            }
            bridge.shear = carry(shear, &from, &bridge.n);
            (bridge.push, bridge.drag) = self.tie_forces[k];
            self.bridges.push(bridge);
        }
    }

    fn store(&mut self, i: usize, hh: f64) {
        for member in &mut self.members {
            member.given[i] = 0.0;
        }
        for (rates, tie) in self.tie_rates.iter_mut().zip(&self.ties) {
            rates[i] = Vec3::zeros();
            debug_assert!(tie.a < tie.b);
        }
        for bridge in &self.bridges {
            let tie = &self.ties[bridge.tie];
            let from = if tie.is_held() { tie.n } else { bridge.n };
            let rate = (bridge.stretch(hh) - bridge.shear) / hh;
            self.tie_rates[bridge.tie][i] = carry(rate, &bridge.n, &from);
            self.tie_forces[bridge.tie] = (bridge.push, bridge.drag);
            for k in 0..2 {
                let member = &mut self.members[bridge.ends[k]];
                let (force, moment) = bridge.load(k);
                member.given[i] -= force.dot(&member.now.0) + moment.dot(&member.now.1);
            }
        }
        for member in &mut self.members {
            member.store(self.terrain, (i, hh));
        }
    }

    /// Rates at the present state, for the explicit first stage.
    fn rates_now(&mut self) {
        for member in &mut self.members {
            let Member { grip, body, laws, .. } = &mut **member;
            let world = World { terrain: self.terrain, body: *body, laws };
            grip.rates_now(&world);
            member.given[0] = 0.0;
        }
        for (k, tie) in self.ties.iter_mut().enumerate() {
            self.tie_rates[k][0] = Vec3::zeros();
            let ends = [tie.a as usize, tie.b as usize];
            let [a, b] = ends.map(|k| &self.members[k]);
            let touch = TOUCH * (a.body.radius + b.body.radius);
            let at = [&a.grip.c, &b.grip.c];
            let Some(mut bridge) = Bridge::over(tie, [&a.body, &b.body], at, touch) else {
                continue;
            };
            let motions = [(a.grip.v, a.grip.w), (b.grip.v, b.grip.w)];
            if !tie.is_held() {
                bridge.captured = -bridge.speed([&motions[0], &motions[1]]) < tie.law.capture_m_s;
                bridge.c_n = if bridge.captured { tie.law.c_n_captured } else { tie.law.c_n };
                tie.n = bridge.n;
            }
            bridge.shear = carry(tie.shear, &tie.n, &bridge.n);
            let rate = bridge.act_now([&motions[0], &motions[1]]);
            self.tie_rates[k][0] = carry(rate, &bridge.n, &tie.n);
            for end in 0..2 {
                let member = &mut self.members[ends[end]];
                let (force, moment) = bridge.load(end);
                let rate = &mut member.grip.rates[0];
                rate.v += force / member.body.mass;
                rate.w += moment / member.body.inertia;
                member.given[0] -= force.dot(&motions[end].0) + moment.dot(&motions[end].1);
            }
        }
        self.fresh = true;
    }

    /// Takes over the step's end.
    fn accept(&mut self, tableau: &Tableau, dt: f64) -> Done {
        let mut done = Done { dt, ..Done::default() };
        let before = self.angular_state();
        for member in &mut self.members {
            let mut loss = Loss::default();
            let end = member.end;
            adaptive::accept(tableau, &mut member.grip, &end, dt, &mut loss);
            done.losses.push(loss);
            let sums = (0..tableau.stages).map(|k| dt * tableau.weight(k) * member.given[k]);
            done.given_j.push(sums.sum());
            member.given[0] = member.given[tableau.stages - 1];
        }
        done.broken = self.accept_ties(tableau, dt);
        for member in &mut self.members {
            member.flying = member.grip.is_free();
        }
        for tie in self.ties.iter().filter(|tie| tie.is_held()) {
            for k in [tie.a, tie.b] {
                self.members[k as usize].flying = false;
            }
        }
        self.keep_spin(before);
        done
    }

    fn accept_ties(&mut self, tableau: &Tableau, dt: f64) -> u64 {
        let (last, hh) = (tableau.stages - 1, tableau.diagonal * dt);
        let mut broken = 0;
        let mut bridges = self.bridges.iter().peekable();
        for (k, tie) in self.ties.iter_mut().enumerate() {
            let Some(bridge) = bridges.next_if(|bridge| bridge.tie == k) else {
                (tie.closed, tie.push, tie.drag, tie.shear) =
                    (false, 0.0, Vec3::zeros(), Vec3::zeros());
                self.tie_rates[k][0] = Vec3::zeros();
                continue;
            };
            let [a, b] = bridge.ends.map(|k| &self.members[k]);
            let (_, distance) = between(&a.grip.c, &b.grip.c);
            let from = if tie.is_held() { tie.n } else { bridge.n };
            let rate = carry(self.tie_rates[k][last], &from, &bridge.n);
            let stretch = bridge.stretch(hh);
            // The spring turns with the two rocks about their line.
            let turn = 0.5 * dt * (a.grip.w + b.grip.w).dot(&bridge.n);
            let turned = |x: Vec3| x * turn.cos() + bridge.n.cross(&x) * turn.sin();
            (tie.push, tie.drag, tie.n) = (bridge.push, bridge.drag, bridge.n);
            tie.captured = bridge.captured;
            tie.closed = bridge.push > 0.0 || distance < a.body.radius + b.body.radius;
            tie.shear = if tie.closed || tie.bond.is_some() { turned(stretch) } else { Vec3::zeros() };
            self.tie_rates[k][0] = if tie.is_held() { turned(rate) } else { Vec3::zeros() };
            tie.slides = tie.bond.is_none()
                && tie.drag.norm() >= tie.law.friction * tie.push * (1.0 - 1e-9);
            let overload = |bond| {
                crate::contact::pair::Bond::overload(bond, tie.push, tie.drag.norm(), tie.law.friction)
            };
            if tie.bond.as_ref().is_some_and(|bond| overload(bond) > 0.0) {
                break_bond(tie);
                self.tie_forces[k] = (tie.push, tie.drag);
                self.fresh = false;
                broken += 1;
                tie.closed = distance < a.body.radius + b.body.radius;
            }
        }
        broken
    }
}

/// A broken bond keeps what friction can hold; the rest of its stretch is lost.
pub(super) fn break_bond(tie: &mut Tie) {
    tie.bond = None;
    tie.captured = true;
    tie.push = tie.push.max(0.0);
    let cap = tie.law.friction * tie.push / tie.law.p_s;
    tie.shear = crate::step::law::within(tie.shear, cap);
    tie.drag = crate::step::law::within(tie.drag, tie.law.friction * tie.push);
}

impl Member {
    fn look(&mut self, terrain: &Terrain) {
        let world = World { terrain, body: self.body, laws: &self.laws };
        let guess = self.guess;
        self.grip.look_ahead(&world, &guess);
    }

    fn place_spots(&mut self, terrain: &Terrain, tableau: &Tableau, (i, h): (usize, f64)) {
        let world = World { terrain, body: self.body, laws: &self.laws };
        self.grip.place_spots(&world, tableau, (i, h), (&self.base, &self.guess));
        for spot in &mut self.grip.spots[..self.grip.spot_count] {
            let kept = self.kept.iter().find(|kept| kept.0 == spot.feature);
            if let Some((_, push, drag, moment)) = kept {
                (spot.push, spot.drag, spot.moment) = (*push, *drag, *moment);
            }
        }
    }

    fn store(&mut self, terrain: &Terrain, (i, hh): (usize, f64)) {
        let world = World { terrain, body: self.body, laws: &self.laws };
        let c = self.base.c + self.now.0 * hh;
        self.end = End { c, v: self.now.0, w: self.now.1 };
        let (base, end) = (self.base, self.end);
        self.grip.store(&world, &base, &end, (i, hh));
        self.kept.clear();
        let spots = &self.grip.spots[..self.grip.spot_count];
        self.kept.extend(spots.iter().map(|s| (s.feature, s.push, s.drag, s.moment)));
    }
}

impl Cluster<'_> {
    /// Angular momentum about the common centre of mass (kg m²/s) of an island that touches nothing but itself.
    fn angular_state(&self) -> Option<Vec3> {
        let alone = self.members.iter().all(|m| m.grip.holds.iter().all(|hold| !hold.closed))
            && self.ties.iter().any(Tie::is_held);
        alone.then(|| self.angular_momentum())
    }

    fn centre(&self) -> (f64, Vec3, Vec3) {
        let mut sum = (0.0, Vec3::zeros(), Vec3::zeros());
        for member in &self.members {
            sum.0 += member.body.mass;
            sum.1 += member.grip.c * member.body.mass;
            sum.2 += member.grip.v * member.body.mass;
        }
        (sum.0, sum.1 / sum.0, sum.2 / sum.0)
    }

    fn angular_momentum(&self) -> Vec3 {
        let (_, c, v) = self.centre();
        self.members.iter().fold(Vec3::zeros(), |sum, member| {
            let orbit = (member.grip.c - c).cross(&((member.grip.v - v) * member.body.mass));
            sum + orbit + member.grip.w * member.body.inertia
        })
    }

    /// Gives back the angular momentum that the step's own error took from a free island, by a turn of the whole:
    /// far less than the tolerance, but a free collision keeps it to rounding.
    fn keep_spin(&mut self, before: Option<Vec3>) {
        let Some(before) = before else { return };
        if self.members.iter().any(|m| m.grip.holds.iter().any(|hold| hold.closed)) {
            return;
        }
        let lost = before - self.angular_momentum();
        let (_, c, _) = self.centre();
        let spins = self.ties.iter().any(|tie| tie.law.friction > 0.0);
        let mut inertia = nalgebra::Matrix3::zeros();
        for member in &self.members {
            let d = member.grip.c - c;
            let (m, own) = (member.body.mass, if spins { member.body.inertia } else { 0.0 });
            inertia += nalgebra::Matrix3::identity() * (own + m * d.norm_squared())
                - d * d.transpose() * m;
        }
        let Ok(turn) = inertia.pseudo_inverse(1e-9 * inertia.norm()).map(|inverse| inverse * lost)
        else {
            return;
        };
        for member in &mut self.members {
            member.grip.v += turn.cross(&(member.grip.c - c));
            if spins {
                member.grip.w += turn;
            }
        }
    }
}
