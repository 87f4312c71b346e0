//! A rock in contact: its motion, what it remembers of its contacts, and the scratch space of its steps.

use super::law::{Body, Spot};
use super::tableau::STAGES;
use crate::contact::hold::{HOLDS, Hold, Holds};
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

    /// Whether a contact too slow to rebound.
    #[inline]
    pub fn captures(&self, touch: &Touch, v: &Vec3) -> bool {
        -touch.normal.dot(v) < self.law(touch.triangle).capture_m_s
    }
}

/// Power lost to each kind of contact work (W), or energy (J) once summed over time.
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
    /// Rates at the stages of the step in hand; the first is that at its start.
    pub rates: [Rate; STAGES],
    /// Whether the first rate belongs to the present state.
    pub fresh: bool,
    /// Contacts of the stage in hand.
    pub spots: [Spot; MOST],
    /// How many of them.
    pub spot_count: usize,
    /// Contact sweeps done.
    pub sweeps: u64,
}

/// Features are collected for the rock's centre up to this far from where it was (–, relative to R) …
const MARGIN: f64 = 0.35;
/// … and asked for up to this far beyond the radius (–), so that a stage sees what it is about to run into.
const SLACK: f64 = 0.1;
/// A gap this small is a touch (–, relative to R): rounding of the leap.
pub const TOUCH: f64 = 1e-9;

impl Default for Grip {
    fn default() -> Self {
        Self {
            c: Vec3::zeros(),
            v: Vec3::zeros(),
            w: Vec3::zeros(),
            holds: Holds::default(),
            near: Near::default(),
            touches: Touches::default(),
            rates: [Rate::NONE; STAGES],
            fresh: false,
            spots: [Spot::NONE; MOST],
            spot_count: 0,
            sweeps: 0,
        }
    }
}

impl Grip {
    /// Takes a rock that has just touched; contacts slower than the capture speed are captured.
    pub fn begin(&mut self, world: &World, c: Vec3, v: Vec3, w: Vec3) {
        (self.c, self.v, self.w) = (c, v, w);
        self.holds.clear();
        self.fresh = false;
        self.look(world, &c, world.body.radius * (1.0 + TOUCH));
        let touches = self.touches;
        for (k, touch) in touches.iter().enumerate() {
            self.holds.find(touch, &touches, (1 << k) - 1, || world.captures(touch, &v));
        }
    }

    /// Asks for the touches at `c` nearer than `reach` (m).
    #[inline]
    pub fn look(&mut self, world: &World, c: &Vec3, reach: f64) {
        let r = world.body.radius;
        if !self.near.covers(c) {
            self.near.collect(world.terrain, c, r, MARGIN * r, SLACK * r);
        }
        self.near.touches(world.terrain, c, reach, &mut self.touches);
    }

    /// Asks for the touches at `c` that a stage must know.
    #[inline]
    pub fn look_ahead(&mut self, world: &World, c: &Vec3) {
        self.look(world, c, world.body.radius * (1.0 + SLACK));
    }

    /// The memory of touch `k` of the last look; a new one starts without stretch and without history of rates.
    #[inline]
    pub fn hold_of(&mut self, world: &World, k: usize, taken: u32, v: &Vec3) -> usize {
        let before = self.holds.len();
        let touch = self.touches[k];
        let touches = self.touches;
        let hold = self.holds.find(&touch, &touches, taken, || world.captures(&touch, v));
        if hold >= before {
            for rate in &mut self.rates {
                (rate.shear[hold], rate.roll[hold]) = (Vec3::zeros(), Vec3::zeros());
            }
        }
        hold
    }

    /// Whether nothing presses on the rock any more.
    pub fn is_free(&self) -> bool {
        self.holds.iter().all(|hold| !hold.closed)
    }

    /// Energy in motion and springs (J), without weight: `m v²/2 + I w²/2 + Σ (p_N pen² + p_s ξ² + k_r θ²)/2`.
    pub fn energy_j(&mut self, world: &World) -> f64 {
        let body = &world.body;
        let motion =
            0.5 * (body.mass * self.v.norm_squared() + body.inertia * self.w.norm_squared());
        let c = self.c;
        self.look(world, &c, body.radius);
        let pressed: f64 = self
            .touches
            .iter()
            .map(|touch| {
                0.5 * world.law(touch.triangle).p_n * (body.radius - touch.distance_m).powi(2)
            })
            .sum();
        motion + pressed + self.holds.iter().map(|hold| spring_j(world, hold)).sum::<f64>()
    }
}

/// Energy in a memory's shear and rolling springs (J).
pub fn spring_j(world: &World, hold: &Hold) -> f64 {
    let law = world.law(hold.triangle);
    0.5 * (law.p_s * hold.shear.norm_squared() + law.k_r * hold.roll.norm_squared())
}
