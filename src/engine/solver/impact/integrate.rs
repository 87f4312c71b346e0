//! Steps through the time of one contact on a plane, with the local error under control.
//!
//! The normal force is known in closed form before slip is followed: on a plane normal motion does
//! not feel friction. So the law of slip is an ordinary differential equation with a given force,
//! smooth but for the kinks where an element begins or ends to slip.

use super::ImpactEffort;
use super::dormand_prince::{Attempt, Flow, NODES, Rates, Stages, growth};
use super::normal_motion::{NormalMotion, Series};

/// No step is longer (1/ω, times the shorter of 1 and `1/2ζ`): as far as the series below gives all its digits.
const LONGEST: f64 = 0.9;
/// Steps below this share of the whole are taken as they are (–): rounding.
const SHORTEST_SHARE: f64 = 1e-9;

/// A flow under a force that is known.
pub(super) trait ForcedFlow<const N: usize, const Q: usize, const K: usize> {
    /// Writes the rates under the force `f` over `to`.
    fn rates(&self, f: f64, y: &[f64; N], to: &mut Rates<N, Q, K>);
    /// Square of an error.
    fn size2(&self, off: &[f64; N]) -> f64;
}

/// The force along a contact, by series from step to step.
/// Forces in `m ω v_n`; times in `1/ω`.
struct Force<const D: usize> {
    swing: NormalMotion,
    /// Gravity into the plane over `ω v_n` (–).
    gamma: f64,
    /// Force and its rate at the step's start.
    now: [f64; 2],
    /// Forces at the times of the stages.
    nodes: [f64; 6],
    series: Series<D>,
}

impl<const D: usize> Force<D> {
    fn new(&Span { swing, begin: now, gamma, .. }: &Span) -> Self {
        let series = Series::new(now, swing.zeta, gamma);
        Self { swing, gamma, now, nodes: [now[0]; 6], series }
    }

    /// Sets the forces at the stages of a step of length `h`.
    /// Never negative: a contact does not pull.
    #[inline]
    fn aim(&mut self, h: f64) {
        for (force, node) in self.nodes.iter_mut().zip(NODES).skip(1) {
            *force = self.series.at(node * h).max(0.0);
        }
    }

    /// Goes on by `h`.
    ///
    /// A new series from force and rate at the step's end: each holds its digits over one step
    /// only.
    #[inline]
    fn pass(&mut self, h: f64) {
        self.now = self.series.both(h);
        self.series = Series::new(self.now, self.swing.zeta, self.gamma);
    }
}

struct Under<'a, P, const D: usize> {
    law: &'a P,
    force: &'a Force<D>,
    over_allowed2: f64,
}

impl<P: ForcedFlow<N, Q, K>, const N: usize, const Q: usize, const K: usize, const D: usize>
    Flow<N, Q, K> for Under<'_, P, D>
{
    #[inline]
    fn rates(&mut self, node: usize, y: &[f64; N], to: &mut Rates<N, Q, K>) {
        self.law.rates(self.force.nodes[node], y, to);
    }

    #[inline]
    fn size2(&self, off: &[f64; N]) -> f64 {
        self.law.size2(off) * self.over_allowed2
    }
}

/// What is asked of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub(super) swing: NormalMotion,
    /// Force and its rate at the start.
    pub(super) begin: [f64; 2],
    pub(super) gamma: f64,
    /// Length (1/ω).
    pub(super) length: f64,
    /// First step (1/ω).
    pub(super) first: f64,
    /// Local error allowed.
    pub(super) allowed: f64,
}

/// Runs from `y` over the whole span; `D` terms of the force's series. Returns the end and the sums.
pub(super) fn run<
    P: ForcedFlow<N, Q, K>,
    const N: usize,
    const Q: usize,
    const K: usize,
    const D: usize,
>(
    law: &P,
    mut y: [f64; N],
    span: &Span,
    effort: &mut ImpactEffort,
) -> ([f64; N], [f64; Q]) {
    let mut force = Force::<D>::new(span);
    let over_allowed2 = 1.0 / (span.allowed * span.allowed);
    // a strong dashpot makes the force's series short-lived
    let longest = LONGEST / (2.0 * span.swing.zeta).max(1.0);
    let (mut sum, mut t, mut wish) = ([0.0; Q], 0.0, span.first);
    let mut stages = Stages::NONE;
    law.rates(force.now[0], &y, stages.first());
    let mut kept = 0.0;
    while t < span.length {
        let left = span.length - t;
        let wished = wish.min(longest);
        // the last two steps share what is left, so that none is a remnant
        let h = if wished >= left {
            left
        } else if 2.0 * wished > left {
            0.5 * left
        } else {
            wished
        };
        force.aim(h);
        let short = h < SHORTEST_SHARE * span.length;
        let felt = (!short).then_some(span.allowed);
        effort.evaluations += 6;
        match stages.step(&mut Under { law, force: &force, over_allowed2 }, &y, h, felt) {
            Attempt::Whole(tried) if tried.error2 <= 1.0 || short => {
                y = tried.y;
                stages.pass();
                for (sum, q) in sum.iter_mut().zip(tried.q) {
                    *sum += q;
                }
                force.pass(h);
                t = if h >= left { span.length } else { t + h };
                // after a cut the step before it is taken up again: the kink is behind
                wish = f64::max(h * growth(tried.error2), kept);
                kept = 0.0;
                effort.steps += 1;
            }
            Attempt::Whole(tried) => {
                effort.rejected += 1;
                kept = 0.0;
                wish = h * growth(tried.error2).min(0.7);
            }
            Attempt::Cut(share) => {
                effort.rejected += 1;
                // Beyond a kink the law is as smooth as before it.
                kept = h.max(kept);
                wish = h * share;
            }
        }
    }
    (y, sum)
}
