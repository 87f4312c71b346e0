//! Integration of the tangential motion of one contact on a plane, with error control.
//!
//! The normal force is known in closed form before slip is integrated: on a plane the normal motion
//! does not depend on friction. So slip obeys an ordinary differential equation with a given force,
//! smooth except where an element begins or ends to slip.
//!
//! In a step each element slips or sticks as at its start, also beyond the point where it would
//! switch. This keeps the right side smooth and the dense output at order 4. Where an element
//! switches the step ends, and no work is lost.

use super::ImpactEffort;
use super::dormand_prince::{
    DenseOutput, Flow, NODES, Rates, Stages, TrialResult, add_sums, excess, growth, slips,
};
use super::normal_motion::{NormalMotion, Series};

/// Longest step (1/ω, times the smaller of 1 and `1/2ζ`): as far as the series below has full
/// precision and the error estimate is reliable.
const LONGEST: f64 = 0.9;
/// Steps below this share of the whole are accepted as they are (–): rounding.
const SHORTEST_SHARE: f64 = 1e-9;
/// Largest error of a step behind a switching point that is ignored (–, relative to the local error
/// allowed).
const SWITCH_THRESHOLD: f64 = 0.3;
/// Largest error of a step by the inexact time of a switching point (–, relative to the local error
/// allowed).
const SWITCH_ACCURACY: f64 = 0.1;
/// Factor of the step length behind a switching point (–).
const AFTER_SWITCH: f64 = 0.8;
/// Iterations for the time of a switching point, at most.
const ROOT_STEPS: u32 = 8;
/// Switching points in succession without a step between them, after which a step is accepted
/// whatever switches.
const SIMULTANEOUS: u32 = 4;

/// A system of differential equations under a known normal force.
pub(super) trait ForcedFlow<const N: usize, const Q: usize, const K: usize> {
    /// Squared trial value of each element and its cap under the force `f`; an element beyond its
    /// cap slips.
    fn trial_values(&self, f: f64, y: &[f64; N]) -> [[f64; 2]; K];
    /// Writes the rates under the force `f` into `to`, with the elements that slip.
    fn rates(&self, f: f64, y: &[f64; N], slips: &[bool; K], to: &mut Rates<N, Q, K>);
    /// Squared norm of an error.
    fn size2(&self, off: &[f64; N]) -> f64;
}

/// The normal force of a contact, by a series from step to step. Forces in `m ω v_n`; times in
/// `1/ω`.
struct NormalForceSeries<const D: usize> {
    oscillator: NormalMotion,
    /// Gravity into the plane over `ω v_n` (–).
    gamma: f64,
    /// Force and its rate at the step's start.
    now: [f64; 2],
    /// Forces at the times of the stages.
    nodes: [f64; 6],
    series: Series<D>,
}

impl<const D: usize> NormalForceSeries<D> {
    fn new(&IntegrationSpan { oscillator, begin: now, gamma, .. }: &IntegrationSpan) -> Self {
        let series = Series::new(now, oscillator.zeta, gamma);
        Self { oscillator, gamma, now, nodes: [now[0]; 6], series }
    }

    /// The force a time `t` after the step's start. Never negative: a contact does not pull.
    #[inline]
    fn at(&self, t: f64) -> f64 {
        self.series.at(t).max(0.0)
    }

    /// Sets the forces at the stages of a step of length `h`.
    #[inline]
    fn set_nodes(&mut self, h: f64) {
        self.nodes = NODES.map(|node| self.at(node * h));
    }

    /// Advances by `h`.
    ///
    /// A new series from force and rate at the step's end: each has full precision over one step
    /// only.
    #[inline]
    fn advance(&mut self, h: f64) {
        self.now = self.series.value_and_rate(h);
        self.series = Series::new(self.now, self.oscillator.zeta, self.gamma);
    }
}

struct ForcedRates<'a, P, const K: usize, const D: usize> {
    law: &'a P,
    force: &'a NormalForceSeries<D>,
    slips: &'a [bool; K],
    over_allowed2: f64,
}

impl<P: ForcedFlow<N, Q, K>, const N: usize, const Q: usize, const K: usize, const D: usize>
    Flow<N, Q, K> for ForcedRates<'_, P, K, D>
{
    #[expect(clippy::inline_always, reason = "seven times a step, in loops over a constant count")]
    #[inline(always)]
    fn rates(&mut self, node: usize, y: &[f64; N], to: &mut Rates<N, Q, K>) {
        self.law.rates(self.force.nodes[node], y, self.slips, to);
    }

    #[inline]
    fn size2(&self, off: &[f64; N]) -> f64 {
        self.law.size2(off) * self.over_allowed2
    }
}

/// Input of an integration.
#[derive(Debug, Clone, Copy)]
pub(super) struct IntegrationSpan {
    pub(super) oscillator: NormalMotion,
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

/// Excess of an element beyond its law: it slips although its trial value is below the cap, or
/// sticks although it is above.
#[inline]
fn beyond(switching: [f64; 2], slips: bool) -> f64 {
    if slips { -excess(switching) } else { excess(switching) }
}

/// Integrates from `y` over the whole span; `D` terms of the force's series. Returns the end and
/// the quadratures.
pub(super) fn run<
    P: ForcedFlow<N, Q, K>,
    const N: usize,
    const Q: usize,
    const K: usize,
    const D: usize,
>(
    law: &P,
    y: [f64; N],
    span: &IntegrationSpan,
    effort: &mut ImpactEffort,
) -> ([f64; N], [f64; Q]) {
    let mut integration = ForcedIntegration::<P, N, Q, K, D>::new(law, y, span);
    let over_allowed2 = 1.0 / (span.allowed * span.allowed);
    while integration.t < span.length {
        let h = integration.next_step();
        integration.force.set_nodes(h);
        let ForcedIntegration { force, slips, stages, y, .. } = &mut integration;
        let rates = &mut ForcedRates { law, force, slips, over_allowed2 };
        let tried = stages.smooth_step(rates, y, h);
        integration.next_h = h * growth(tried.error2);
        if tried.error2 > 1.0 && h > integration.shortest() {
            effort.rejected += 1;
            integration.next_h = integration.next_h.min(0.7 * h);
            continue;
        }
        effort.steps += 1;
        match integration.switch(&tried, h) {
            Some(switch) => integration.switch_at(&switch, &tried, h),
            None => integration.accept(&tried, h),
        }
    }
    (integration.y, integration.sum)
}

/// State of an integration.
struct ForcedIntegration<'a, P, const N: usize, const Q: usize, const K: usize, const D: usize> {
    law: &'a P,
    span: &'a IntegrationSpan,
    force: NormalForceSeries<D>,
    y: [f64; N],
    sum: [f64; Q],
    t: f64,
    /// Length of the next trial step.
    next_h: f64,
    /// Elements that slip throughout the next step.
    slips: [bool; K],
    /// Elements that have switched at this time.
    simultaneous: u32,
    stages: Stages<N, Q, K>,
}

/// Where an element begins to slip or to stick: which one, after which share of the step (–), and
/// the state there.
struct SliderSwitch<const N: usize> {
    element: usize,
    share: f64,
    state: [f64; N],
}

impl<'a, P: ForcedFlow<N, Q, K>, const N: usize, const Q: usize, const K: usize, const D: usize>
    ForcedIntegration<'a, P, N, Q, K, D>
{
    fn new(law: &'a P, y: [f64; N], span: &'a IntegrationSpan) -> Self {
        let (force, stages) = (NormalForceSeries::new(span), Stages::NONE);
        let slips = law.trial_values(force.now[0], &y).map(slips);
        let (sum, next_h) = ([0.0; Q], span.first);
        let mut integration =
            Self { law, span, force, y, sum, t: 0.0, next_h, slips, simultaneous: 0, stages };
        integration.begin();
        integration
    }

    /// Rates at the start of a step, with the elements that slip in it.
    #[inline(never)]
    fn begin(&mut self) {
        self.law.rates(self.force.now[0], &self.y, &self.slips, self.stages.first());
    }

    /// The length of the next step.
    fn next_step(&self) -> f64 {
        let left = self.span.length - self.t;
        // a strong dashpot makes the force's series short-lived
        let wished = self.next_h.min(LONGEST / (2.0 * self.span.oscillator.zeta).max(1.0));
        // the last two steps share the remainder equally
        if wished >= left {
            left
        } else if 2.0 * wished > left {
            0.5 * left
        } else {
            wished
        }
    }

    /// A step up to this is accepted as it is.
    fn shortest(&self) -> f64 {
        SHORTEST_SHARE * self.span.length
    }

    /// Accepts a whole step of length `h`.
    fn accept(&mut self, tried: &TrialResult<N, Q>, h: f64) {
        let left = self.span.length - self.t;
        self.t = if h >= left { self.span.length } else { self.t + h };
        (self.y, self.simultaneous) = (tried.y, 0);
        add_sums(&mut self.sum, &tried.q);
        self.force.advance(h);
        let slips = self.stages.switching()[6].map(slips);
        if slips == self.slips {
            self.stages.reuse_last();
        } else {
            self.slips = slips;
            self.begin();
        }
    }

    /// Advances to where an element switches in a step of length `h`.
    fn switch_at(&mut self, switch: &SliderSwitch<N>, tried: &TrialResult<N, Q>, h: f64) {
        let elapsed = switch.share * h;
        self.t += elapsed;
        self.simultaneous = if elapsed > self.shortest() { 0 } else { self.simultaneous + 1 };
        self.y = switch.state;
        add_sums(&mut self.sum, &self.stages.dense_sums(tried, h).at(switch.share));
        self.force.advance(elapsed);
        let slips = &mut self.slips[switch.element];
        *slips = !*slips;
        self.next_h *= AFTER_SWITCH;
        self.begin();
    }

    /// The first significant switching point in a step of length `h`.
    #[inline]
    fn switch(&self, tried: &TrialResult<N, Q>, h: f64) -> Option<SliderSwitch<N>> {
        if self.simultaneous >= SIMULTANEOUS {
            return None;
        }
        let switching = self.stages.switching();
        let changes = |element: usize| {
            switching[1..].iter().any(|switching| slips(switching[element]) != self.slips[element])
        };
        let mut first: Option<SliderSwitch<N>> = None;
        let mut between = None;
        for element in (0..K).filter(|element| changes(*element)) {
            let between =
                between.get_or_insert_with(|| self.stages.dense_output((&self.y, tried), h));
            if let Some(found) = self.switch_of(element, between, h)
                && first.as_ref().is_none_or(|first| found.share < first.share)
            {
                first = Some(found);
            }
        }
        first
    }

    /// Where one element switches in a step of length `h` in which the stages say that it does, if
    /// that is significant.
    fn switch_of(
        &self,
        element: usize,
        between: &DenseOutput<N>,
        h: f64,
    ) -> Option<SliderSwitch<N>> {
        let (slips, allowed) = (self.slips[element], self.span.allowed);
        let switching = self.stages.switching().map(|switching| beyond(switching[element], slips));
        // largest excess beyond its law, as far as the stages tell
        if switching[1..].iter().fold(0.0, |most, x| f64::max(most, *x)) * h <= allowed {
            return None;
        }
        let look = |share: f64| {
            let state = between.at(share);
            let trial = self.law.trial_values(self.force.at(share * h), &state);
            (beyond(trial[element], slips), SliderSwitch { element, share, state })
        };
        let end = switching[6];
        let high = if end > 0.0 {
            (1.0, end)
        } else {
            // it has returned by the end of the step
            let seen = NODES.into_iter().zip(switching).skip(1).filter(|(_, excess)| *excess > 0.0);
            let mut looks = seen.map(|(node, _)| (node, look(node).0));
            looks.find(|(_, excess)| *excess > 0.0)?
        };
        let found = illinois_root((switching[0], high), look, SWITCH_ACCURACY * allowed / h);
        // mean error of the step behind the switching point
        let is_felt =
            end <= 0.0 || 0.5 * end * (1.0 - found.share) * h > SWITCH_THRESHOLD * allowed;
        is_felt.then_some(found)
    }
}

/// Where an element gets beyond its law in a step. The excess is `start` at the start of the step,
/// below 0 except for rounding, and `high.1` at the share `high.0` of the step. Over the part of
/// the step by which the point is inaccurate, the mean excess is `missed` times that part.
///
/// By the Illinois variant of regula falsi: linear interpolation between a point on each side,
/// where the side that stays gets half of its weight.
fn illinois_root<const N: usize>(
    (start, mut high): (f64, (f64, f64)),
    look: impl Fn(f64) -> (f64, SliderSwitch<N>),
    missed: f64,
) -> SliderSwitch<N> {
    let mut low = (0.0, start.min(0.0));
    let near2 = 2.0 * missed * (high.1 - low.1) / high.0;
    for _ in 0..ROOT_STEPS {
        let share = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1));
        let (excess, found) = look(share);
        if excess * excess <= near2 {
            return found;
        }
        if excess > 0.0 {
            high = (share, excess);
            low.1 *= 0.5;
        } else {
            low = (share, excess);
            high.1 *= 0.5;
        }
    }
    look(high.0).1
}
