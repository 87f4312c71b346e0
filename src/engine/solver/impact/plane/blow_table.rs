//! Table of impacts along a line: for spheres of one material all pairs have the same friction
//! impulse as a function of slip.
//!
//! In units of the approach speed and of the spring's own time, an impact without weight and
//! rolling depends on its damping ratio, its shear element, `1 + m R²/I` and the slip over the
//! approach speed `x`. With springs and dashpots of one material the first three are the same for
//! spheres of all sizes. So the impulse against the slip is one function `J(x)`: 0 at rest, and
//! `μ (1 + e)` where the contact slides throughout. It is integrated once at nodes and interpolated
//! linearly between them.

use super::straight::blow_plane;
use super::{Exit, Plane};
use crate::ground::Law;
use crate::solver::body::Body;
use std::sync::OnceLock;

/// Nodes except the last, equidistant in `x/(x + x₀)`: linear interpolation has a smaller error
/// than an impact at the tolerance of the nodes.
const NODES: usize = 1024;
/// Tolerance of the nodes (–).
const TOLERANCE: f64 = 1e-6;
/// Difference up to which two materials are the same (–), of each of their numbers or of 1.
const SAME_MATERIAL: f64 = 1e-9;
/// The same of `m R²/I` (–): rocks that overlap by the error of a step have levers that are shorter
/// by as much.
const SAME_LEVERS: f64 = 1e-2;

/// Impacts of all pairs of one material.
#[derive(Debug)]
pub(crate) struct BlowTable {
    plane: Plane,
    exit: Exit,
    /// Slip over approach speed from which on the contact slides nearly throughout (–).
    sliding: f64,
    /// Impulses over mass and approach speed; each is computed on demand and is the same for every
    /// caller.
    nodes: Box<[OnceLock<f64>]>,
}

impl BlowTable {
    /// An empty table of the impacts on `body` that rebound; `None` where there is nothing to
    /// integrate.
    pub(crate) fn new(body: &Body, law: &Law) -> Option<Self> {
        let plane = blow_plane((body, law), false, TOLERANCE);
        let exit = plane.oscillator.exit(0.0).filter(|_| plane.shear.is_on())?;
        let most = plane.shear.damping * plane.shear.cap * (1.0 + exit.speed);
        let sliding = (1.0 + plane.body.turns()) * most;
        let nodes: Box<[OnceLock<f64>]> = (0..=NODES).map(|_| OnceLock::new()).collect();
        nodes[0].get_or_init(|| 0.0);
        nodes[NODES].get_or_init(|| most);
        Some(Self { plane, exit, sliding, nodes })
    }

    /// As [`blow_along_a_line`](super::blow_along_a_line), without capture; `None` for an impact of
    /// another material.
    pub(crate) fn blow(&self, with: (&Body, &Law), [approach, slip]: [f64; 2]) -> Option<[f64; 2]> {
        if !self.is_of(with) {
            return None;
        }
        let x = slip / approach;
        // a spring without loss returns twice the slip, and no rounding may give more
        let against = self.against(x).min(2.0 * x / (1.0 + with.0.turns()));
        Some([approach * (1.0 + self.exit.speed), approach * against])
    }

    /// Whether the impacts of this body are those of the table.
    fn is_of(&self, (body, law): (&Body, &Law)) -> bool {
        let (damping_ratio, shear) = Plane::elements((body, law), false);
        let own = &self.plane.shear;
        let pairs = [
            (damping_ratio, self.plane.oscillator.zeta, SAME_MATERIAL),
            (shear.damping, own.damping, SAME_MATERIAL),
            (shear.rate, own.rate, SAME_MATERIAL),
            (shear.cap, own.cap, SAME_MATERIAL),
            (body.turns(), self.plane.body.turns(), SAME_LEVERS),
        ];
        pairs.iter().all(|(one, other, off)| (one - other).abs() <= off * other.abs().max(1.0))
    }

    /// Impulse against a slip of `x` times the approach speed.
    fn against(&self, x: f64) -> f64 {
        let at = NODES as f64 * (x / (x + self.sliding));
        let below = (at as usize).min(NODES - 1);
        let [low, high] = [below, below + 1].map(|k| self.node(k));
        low + (high - low) * (at - below as f64)
    }

    /// Integrated when it is first asked for.
    fn node(&self, k: usize) -> f64 {
        *self.nodes[k].get_or_init(|| {
            let share = k as f64 / NODES as f64;
            self.plane.friction_impulse(self.sliding * share / (1.0 - share), self.exit.lift_off)
        })
    }
}
