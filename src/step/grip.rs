//! A rock in contact: its motion, what it remembers of its contacts, and the scratch space of its steps.

use super::dda::Bench;
use super::explicit::Explicit;
use super::flat::Flat;
use super::law::{Body, Spot};
use super::slide::Mode;
use super::tableau::STAGES;
use crate::clock::{Clocks, Piece};
use crate::contact::hold::{HOLDS, Holds};
use crate::contact::near::Near;
use crate::contact::{MOST, Touch, Touches};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// What stays the same while one rock falls.
#[derive(Debug, Clone, Copy)]
pub struct World<'a> {
    /// The mesh.
    pub terrain: &'a Terrain,
    /// The rock.
    pub body: Body,
    /// The law of every ground of the scene for this rock.
    pub laws: &'a [Law],
}

impl World<'_> {
    /// The law of a triangle's ground.
    #[inline]
    pub fn law(&self, triangle: u32) -> &Law {
        let sheet = self.terrain.sheet_of[triangle as usize];
        &self.laws[self.terrain.sheets[sheet as usize].ground as usize]
    }

    /// Whether a contact is too slow to rebound.
    #[inline]
    pub fn captures(&self, touch: &Touch, v: &Vec3) -> bool {
        -touch.normal.dot(v) < self.law(touch.triangle).capture_m_s
    }

    /// Slowest approach that is an impact to be followed in its own time (m/s): slower than that a rock just presses.
    fn least_impact_m_s(&self) -> f64 {
        LEAST_IMPACT * (self.body.gravity.norm() * self.body.radius).sqrt()
    }

    /// The law of touch `k` among others of the same instant.
    #[inline]
    pub fn law_of(&self, touches: &[Touch], k: usize) -> Law {
        let touch = &touches[k];
        let law = self.law(touch.triangle);
        if touches.len() == 1 {
            return law.of_patch(touch.gain2, 1.0);
        }
        law.of_patch(touch.gain2, dashpot_share(touches, k, self.body.radius))
    }
}

/// What each dashpot takes of its own damping where several patches are pressed at once (–):
/// `1/√(Σ_j max(0, n̂_i·n̂_j)²)` over those pressed. `n` parallel ones damp like one; at right angles nothing changes.
fn dashpot_share(touches: &[Touch], k: usize, radius: f64) -> f64 {
    let normal = &touches[k].normal;
    let others = touches
        .iter()
        .enumerate()
        .filter(|(j, other)| *j != k && other.distance_m < radius)
        .map(|(_, other)| normal.dot(&other.normal).max(0.0).powi(2));
    1.0 / (1.0 + others.sum::<f64>()).sqrt()
}

/// Power that goes into contacts (W) by kind, or energy (J) once summed over time. What springs store is counted
/// in; it is nothing once the contact is over.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Loss {
    /// Sliding friction on the slope.
    pub friction: f64,
    /// Normal and shear dashpots on the slope.
    pub damping: f64,
    /// Rolling friction on the slope.
    pub rolling: f64,
    /// Everything in contacts with trees.
    pub trees: f64,
}

impl Loss {
    /// Adds `other` times `factor`.
    #[inline]
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.friction += factor * other.friction;
        self.damping += factor * other.damping;
        self.rolling += factor * other.rolling;
        self.trees += factor * other.trees;
    }

    /// The same, booked under trees where the triangle is one's.
    #[must_use]
    #[inline]
    pub fn on(self, world: &World, triangle: u32) -> Self {
        if world.terrain.is_tree(triangle) {
            Self { trees: self.sum(), ..Self::default() }
        } else {
            self
        }
    }

    /// All of it.
    pub fn sum(&self) -> f64 {
        self.friction + self.damping + self.rolling + self.trees
    }
}

/// Rates of change of a rock in contact.
#[derive(Debug, Clone, Copy)]
pub struct Rate {
    /// Velocity (m/s).
    pub c: Vec3,
    /// Acceleration (m/s²).
    pub v: Vec3,
    /// Angular acceleration (rad/s²).
    pub w: Vec3,
    /// Of the shear springs (m/s), in the frames of the memories.
    pub shear: [Vec3; HOLDS],
    /// Of the rolling springs (rad/s).
    pub roll: [Vec3; HOLDS],
    /// Power lost (W).
    pub loss: Loss,
}

impl Rate {
    /// Takes over another's rates, of the springs the first `holds` only.
    #[inline]
    pub fn take(&mut self, from: &Self, holds: usize) {
        (self.c, self.v, self.w, self.loss) = (from.c, from.v, from.w, from.loss);
        self.shear[..holds].copy_from_slice(&from.shear[..holds]);
        self.roll[..holds].copy_from_slice(&from.roll[..holds]);
    }

    /// Forgets the rates of the first `holds` springs.
    #[inline]
    pub fn clear(&mut self, holds: usize) {
        self.shear[..holds].fill(Vec3::zeros());
        self.roll[..holds].fill(Vec3::zeros());
    }

    /// No change.
    pub const NONE: Self = Self {
        c: Vec3::new(0.0, 0.0, 0.0),
        v: Vec3::new(0.0, 0.0, 0.0),
        w: Vec3::new(0.0, 0.0, 0.0),
        shear: [Vec3::new(0.0, 0.0, 0.0); HOLDS],
        roll: [Vec3::new(0.0, 0.0, 0.0); HOLDS],
        loss: Loss { friction: 0.0, damping: 0.0, rolling: 0.0, trees: 0.0 },
    };
}

/// A rock in contact.
#[derive(Debug)]
pub struct Grip {
    /// Centre (m, local).
    pub c: Vec3,
    /// Velocity (m/s).
    pub v: Vec3,
    /// Spin (rad/s).
    pub w: Vec3,
    /// Its contacts' memories.
    pub holds: Holds,
    /// Features around it.
    pub near: Near,
    /// Touches at the last place asked.
    pub touches: Touches,
    /// That place, if they were asked for with all slack.
    pub(crate) looked_ahead: Option<Vec3>,
    /// Rates at the stages of the step in hand; the first is that at its start.
    pub rates: [Rate; STAGES],
    /// Whether the first rate belongs to the present state.
    pub fresh: bool,
    /// Energy in the springs of the contacts at the present state (J), if the first rate is fresh.
    pub stored: f64,
    /// Contacts of the stage in hand.
    pub spots: [Spot; MOST],
    /// How many of them.
    pub spot_count: usize,
    /// The same of a rock on one plane.
    pub flat: Flat,
    /// An impact in its own time.
    pub(crate) impact: Explicit,
    /// Contacts that are about to be struck anew within an episode (`rigid`).
    pub struck: Holds,
    /// Whether what is touched may give way: it is asked step by step.
    pub may_yield: bool,
    /// Whether the blow in hand has been announced (`rigid`).
    pub(crate) is_struck: bool,
    /// Work space of the fixed step.
    pub bench: Bench,
    /// Contact sweeps done.
    pub sweeps: u64,
    /// Where the time goes, if somebody asks.
    pub clocks: Clocks,
}

/// Features are collected for the rock's centre up to this far from where it was (–, relative to R) …
const MARGIN: f64 = 0.35;
/// … at a touch no further than this, if that is enough for the impact (–) …
const LEAST_MARGIN: f64 = 0.06;
/// … which goes on for about so many contact times `π/ω` (–) …
const IMPACT_WAY: f64 = 1.3;
/// … and asked for up to this far beyond the radius (–), so that a stage sees what it is about to run into.
const SLACK: f64 = 0.1;
/// A gap this small is a touch (–, relative to R): rounding of the leap.
pub const TOUCH: f64 = 1e-9;

/// An approach slower than this is no impact (–, relative to `√(g R)`).
const LEAST_IMPACT: f64 = 1e-3;

impl Default for Grip {
    fn default() -> Self {
        // room for what is usually near, so that the first rock of a thread need not stop to make it
        let near = Near::default();
        Self { near, ..Self::unused() }
    }
}

impl Grip {
    /// Without memory taken: for rocks that are kept by the thousand.
    pub fn unused() -> Self {
        Self {
            c: Vec3::zeros(),
            v: Vec3::zeros(),
            w: Vec3::zeros(),
            holds: Holds::default(),
            near: Near::empty(),
            touches: Touches::default(),
            looked_ahead: None,
            rates: [Rate::NONE; STAGES],
            fresh: false,
            stored: 0.0,
            spots: [Spot::NONE; MOST],
            spot_count: 0,
            flat: Flat::default(),
            impact: Explicit::default(),
            struck: Holds::default(),
            is_struck: true,
            may_yield: false,
            bench: Bench::default(),
            sweeps: 0,
            clocks: Clocks::default(),
        }
    }
}

impl Grip {
    /// Takes a rock that has just touched; contacts slower than the capture speed are captured.
    pub fn begin(&mut self, world: &World, c: Vec3, v: Vec3, w: Vec3) {
        (self.c, self.v, self.w) = (c, v, w);
        self.holds.clear();
        self.fresh = false;
        self.flat.forget();
        self.impact.forget();
        self.struck.clear();
        self.is_struck = true;
        // Nothing of the rock before, not even a guess, may tell.
        self.spots.iter_mut().for_each(|spot| spot.mode = Mode::default());
        if !self.near.covers(&c) {
            let (r, margin) = (world.body.radius, self.way_of_impact(world));
            self.near.collect(world.terrain, &c, r, margin, SLACK * r);
        }
        self.look(world, &c, world.body.radius * (1.0 + TOUCH));
        // An impact rebounds or not as a whole, by its fastest approach.
        let captured = self.touches.iter().all(|touch| world.captures(touch, &v));
        for (k, touch) in self.touches.iter().enumerate() {
            self.holds.find(touch, &self.touches, (1 << k) - 1, || captured);
            if !captured {
                self.impact.meet(-touch.normal.dot(&v), world.least_impact_m_s());
            }
        }
    }

    /// Sees to it that the features around `c` are known.
    #[inline]
    pub fn know(&mut self, world: &World, c: &Vec3) {
        if !self.near.covers(c) {
            self.collect(world, c);
        }
    }

    /// Collects the features around `c`.
    pub(crate) fn collect(&mut self, world: &World, c: &Vec3) {
        let r = world.body.radius;
        let begun = self.clocks.now();
        self.near.collect(world.terrain, c, r, MARGIN * r, SLACK * r);
        self.clocks.stop(Piece::Geometry, begun);
    }

    /// How far an impact goes before it is over (m), between bounds: the less is collected the fewer features there are,
    /// and the more often it is one face alone.
    fn way_of_impact(&self, world: &World) -> f64 {
        let slowest = world.laws.iter().map(|law| law.omega).fold(f64::INFINITY, f64::min);
        let way = IMPACT_WAY * std::f64::consts::PI / slowest * self.v.norm();
        way.clamp(LEAST_MARGIN * world.body.radius, MARGIN * world.body.radius)
    }

    /// Asks for the touches at `c` nearer than `reach` (m).
    #[inline]
    pub fn look(&mut self, world: &World, c: &Vec3, reach: f64) {
        self.know(world, c);
        self.looked_ahead = None;
        let begun = self.clocks.now();
        self.near.touches(world.terrain, c, reach, &mut self.touches);
        self.clocks.stop(Piece::Geometry, begun);
    }

    /// Asks for the touches at `c` that a stage must know.
    #[inline]
    pub fn look_ahead(&mut self, world: &World, c: &Vec3) {
        self.look(world, c, world.body.radius * (1.0 + SLACK));
    }

    /// The same, if it was not asked for at `c` last.
    #[inline]
    pub fn look_ahead_again(&mut self, world: &World, c: &Vec3) {
        if self.looked_ahead != Some(*c) {
            self.look_ahead(world, c);
            self.looked_ahead = Some(*c);
        }
    }

    /// The memory of touch `k` of the last look; a new one starts without stretch and without history of rates.
    #[inline]
    pub fn hold_of(&mut self, world: &World, k: usize, taken: u32, v: &Vec3) -> usize {
        let (before, touch) = (self.holds.len(), &self.touches[k]);
        // What is born while an impact rebounds belongs to it, however slow it is.
        let rebounds = self.holds.iter().any(|hold| !hold.captured);
        let slow = world.captures(touch, v);
        let hold = self.holds.find(touch, &self.touches, taken, || slow && !rebounds);
        if hold >= before {
            if !slow {
                self.impact.meet(-touch.normal.dot(v), world.least_impact_m_s());
            }
            for rate in &mut self.rates {
                (rate.shear[hold], rate.roll[hold]) = (Vec3::zeros(), Vec3::zeros());
            }
        }
        hold
    }

    /// Hands the springs of contacts that merged into others to those; whether there were any.
    pub(crate) fn merge_lost(&mut self, world: &World) -> bool {
        let Self { holds, near, .. } = self;
        holds.merge_lost(|feature| near.patch_holding(world.terrain, feature))
    }

    /// Gives the rock another velocity and spin in the middle of a contact; its springs stay as they are.
    pub fn redirect(&mut self, world: &World, v: Vec3, w: Vec3) {
        self.leave_plane(world);
        (self.v, self.w) = (v, w);
        self.fresh = false;
        self.impact.restart();
    }

    /// Whether nothing presses on the rock any more.
    pub fn is_free(&self) -> bool {
        self.holds.iter().all(|hold| !hold.closed)
    }

    /// Energy in motion (J): `m v²/2 + I w²/2`.
    pub fn motion_j(&self, body: &Body) -> f64 {
        0.5 * (body.mass * self.v.norm_squared() + body.inertia * self.w.norm_squared())
    }

    /// Longest step in which the centre stays where its features are known, or goes no further than `travel` (–,
    /// relative to R), past one plane or among several features (s).
    pub fn longest_step(&self, world: &World, travel: f64) -> f64 {
        let way = travel * world.body.radius;
        let is_plane = self.near.plane().is_some();
        let room = if is_plane { self.near.room_m(&self.c).max(way) } else { way };
        longest_step(&world.body, self.v.norm(), room)
    }

    /// Energy in the springs of the contacts (J), by the kind it was counted under:
    /// `Σ (p_N pen² + p_s ξ² + k_r θ²)/2`.
    pub fn springs_j(&mut self, world: &World) -> Loss {
        let c = self.c;
        self.look(world, &c, world.body.radius);
        self.stored_j(world)
    }

    /// The same for the touches of the last look.
    pub fn stored_j(&self, world: &World) -> Loss {
        let mut stored = Loss::default();
        for touch in self.touches.iter() {
            let pen = (world.body.radius - touch.distance_m).max(0.0);
            let pressed = 0.5 * world.law(touch.triangle).p_n * touch.gain2 * pen * pen;
            stored
                .add(&Loss { damping: pressed, ..Loss::default() }.on(world, touch.triangle), 1.0);
        }
        for hold in self.holds.iter() {
            let law = world.law(hold.triangle);
            let damping = 0.5 * law.p_s * hold.shear.norm_squared();
            let rolling = 0.5 * law.k_r * hold.roll.norm_squared();
            stored.add(&Loss { damping, rolling, ..Loss::default() }.on(world, hold.triangle), 1.0);
        }
        stored
    }
}

/// Longest step in which a rock at `speed` goes no further than `room` (s); its weight may speed it up on the way.
pub(crate) fn longest_step(body: &Body, speed: f64, room: f64) -> f64 {
    2.0 * room / (speed + (speed * speed + 2.0 * body.gravity.norm() * room).sqrt())
}
