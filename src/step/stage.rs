//! One implicit stage: the contact law solved with the geometry at the stage's end.

use super::grip::{Grip, Loss, Rate, TOUCH, World};
use super::law::{self, Spot, within};
use super::tableau::Tableau;
use crate::contact::hold::carry;
use crate::rock::Vec3;

/// Most passes in which geometry and forces are brought to agree.
pub(crate) const PASSES: u32 = 10;
/// Change of the centre, relative to the radius, below which they agree (–).
pub(crate) const AGREED: f64 = 1e-9;

impl Spot {
    /// Power that goes into the contact (W) at velocity `v` and spin `w`: what its springs store is counted in.
    pub(super) fn loss(&self, world: &World, v: &Vec3, w: &Vec3, shear_rate: &Vec3) -> Loss {
        let slip = world.body.slip(&self.n, v, w);
        let friction = self.drag.dot(&(slip - shear_rate));
        let damping = self.drag.dot(shear_rate) - self.push * self.n.dot(v);
        let rolling = self.moment.dot(w);
        if self.is_tree {
            Loss { trees: friction + damping + rolling, ..Loss::default() }
        } else {
            Loss { friction, damping, rolling, trees: 0.0 }
        }
    }

    /// Forces at the present state, for the explicit first stage; returns the rates of shear and rolling springs.
    pub(super) fn act_now(&mut self, world: &World, v: &Vec3, w: &Vec3) -> (Vec3, Vec3) {
        let law = &self.law;
        self.push = (law.p_n * self.pen - self.c_n * self.n.dot(v)).max(0.0);
        let held = self.shear * law.p_s;
        self.drag =
            within(held + world.body.slip(&self.n, v, w) * law.c_s, law.friction * self.push);
        let wound = self.roll * law.k_r;
        self.moment = within(wound + w * law.c_r, law.rolling_m * self.push);
        let rate = |change: Vec3, damping: f64| {
            if damping > 0.0 { change / damping } else { Vec3::zeros() }
        };
        (rate(self.drag - held, law.c_s), rate(self.moment - wound, law.c_r))
    }
}

/// Where a stage ends.
#[derive(Debug, Clone, Copy)]
pub struct End {
    /// Centre (m).
    pub c: Vec3,
    /// Velocity (m/s).
    pub v: Vec3,
    /// Spin (rad/s).
    pub w: Vec3,
}

impl Grip {
    /// The base of implicit stage `i`: the state plus the explicit part of the earlier stages.
    pub(crate) fn base(&self, tableau: &Tableau, i: usize, h: f64) -> End {
        let mut base = End { c: self.c, v: self.v, w: self.w };
        for (rate, a) in self.rates.iter().zip(tableau.a[i]) {
            base.c += rate.c * (h * a);
            base.v += rate.v * (h * a);
            base.w += rate.w * (h * a);
        }
        base
    }

    /// Solves implicit stage `i` of a step of length `h` and stores its rates; `None` if it does not settle.
    pub fn stage(&mut self, world: &World, tableau: &Tableau, i: usize, h: f64) -> Option<End> {
        let base = self.base(tableau, i, h);
        let hh = tableau.diagonal * h;
        let (vf, wf) = (base.v + world.body.gravity * hh, base.w);
        // Where it would be if it went on as in the stage before.
        let before = &self.rates[i - 1];
        let mut guess = base.c + (before.c + before.v * hh) * hh;
        // Planes slid along may have ended on the way: what they say must be confirmed by the look at the end.
        let mut looked =
            !(self.near.covers(&guess) && self.touches.slide_to(world.terrain, &guess));
        if looked {
            self.look_ahead(world, &guess);
        }
        for _ in 0..PASSES {
            self.place_spots(world, tableau, (i, h), (&base, &guess));
            let spots = &mut self.spots[..self.spot_count];
            let (v, w) = law::solve(&world.body, spots, vf, wf, hh, &mut self.sweeps)?;
            let c = base.c + v * hh;
            self.look_ahead(world, &c);
            let moved = (c - guess).norm_squared();
            let agrees = looked && moved <= (AGREED * world.body.radius).powi(2);
            if agrees || self.stays_on_faces() {
                let end = End { c, v, w };
                self.store(world, &base, &end, (i, hh));
                return Some(end);
            }
            (guess, looked) = (c, true);
        }
        None
    }

    /// Whether the last look found the very faces that the forces were computed with: planes are the same everywhere,
    /// so the forces are exact wherever the rock was when they were computed.
    #[inline]
    fn stays_on_faces(&self) -> bool {
        let spots = &self.spots[..self.spot_count];
        spots.len() == self.touches.len()
            && spots.iter().zip(self.touches.iter()).all(|(spot, touch)| {
                touch.is_on_plane() && touch.feature == spot.feature && touch.normal == spot.n
            })
    }

    /// Makes the contacts of the last look into spots based at the stage's base.
    pub(crate) fn place_spots(
        &mut self,
        world: &World,
        tableau: &Tableau,
        (i, h): (usize, f64),
        (base, at): (&End, &Vec3),
    ) {
        self.spot_count = self.touches.len();
        let mut taken = 0;
        for k in 0..self.spot_count {
            let hold = self.hold_of(world, k, taken, &base.v);
            taken |= 1 << hold;
            let mut spot = self.spot_of(world, k, hold);
            let memory = &self.holds[hold];
            let (mut shear, mut roll) = (memory.shear, memory.roll);
            for (rate, a) in self.rates.iter().zip(tableau.a[i]) {
                shear += rate.shear[hold] * (h * a);
                roll += rate.roll[hold] * (h * a);
            }
            spot.shear = carry(shear, &memory.n, &spot.n);
            spot.roll = roll;
            spot.pen = world.body.radius - self.touches[k].distance_m - spot.n.dot(&(base.c - at));
            self.spots[k] = spot;
        }
    }

    /// The spot of touch `k` with the stretches of its memory and no penetration yet.
    pub(super) fn spot_of(&self, world: &World, k: usize, hold: usize) -> Spot {
        let (touch, memory) = (&self.touches[k], &self.holds[hold]);
        let law = world.law_of(&self.touches, k);
        Spot {
            hold,
            feature: touch.feature,
            triangle: touch.triangle,
            c_n: if memory.captured { law.c_n_captured } else { law.c_n },
            is_tree: world.terrain.is_tree(touch.triangle),
            n: touch.normal,
            pen: 0.0,
            shear: carry(memory.shear, &memory.n, &touch.normal),
            roll: memory.roll,
            push: memory.push,
            drag: Vec3::zeros(),
            moment: Vec3::zeros(),
            mode: self.spots[k].mode,
            law,
        }
    }

    /// Stores the rates of stage `i`.
    pub(crate) fn store(&mut self, world: &World, base: &End, end: &End, (i, hh): (usize, f64)) {
        let rate = &mut self.rates[i];
        (rate.c, rate.v, rate.w) = (end.v, (end.v - base.v) / hh, (end.w - base.w) / hh);
        rate.loss = Loss::default();
        for k in 0..self.holds.len() {
            (rate.shear[k], rate.roll[k]) = (Vec3::zeros(), Vec3::zeros());
        }
        for spot in &self.spots[..self.spot_count] {
            let (shear, roll) = spot.stretches(hh);
            let (shear_rate, roll_rate) = ((shear - spot.shear) / hh, (roll - spot.roll) / hh);
            rate.shear[spot.hold] = carry(shear_rate, &spot.n, &self.holds[spot.hold].n);
            rate.roll[spot.hold] = roll_rate;
            rate.loss.add(&spot.loss(world, &end.v, &end.w, &shear_rate), 1.0);
        }
    }

    /// Rates at the present state, for the explicit first stage.
    pub fn rates_now(&mut self, world: &World) {
        let (c, v, w) = (self.c, self.v, self.w);
        let body = &world.body;
        self.look(world, &c, body.radius * (1.0 + TOUCH));
        self.rates[0] = Rate { c: v, v: body.gravity, ..Rate::NONE };
        let mut taken = 0;
        for k in 0..self.touches.len() {
            let hold = self.hold_of(world, k, taken, &v);
            taken |= 1 << hold;
            let mut spot = self.spot_of(world, k, hold);
            spot.pen = (body.radius - self.touches[k].distance_m).max(0.0);
            let (shear_rate, roll_rate) = spot.act_now(world, &v, &w);
            let back = self.holds[hold].n;
            let rate = &mut self.rates[0];
            rate.v += (spot.n * spot.push - spot.drag) / body.mass;
            rate.w += (spot.n.cross(&spot.drag) * body.radius - spot.moment) / body.inertia;
            rate.shear[hold] = carry(shear_rate, &spot.n, &back);
            rate.roll[hold] = roll_rate;
            rate.loss.add(&spot.loss(world, &v, &w, &shear_rate), 1.0);
        }
        self.stored = self.springs_j(world).sum();
        self.fresh = true;
    }
}
