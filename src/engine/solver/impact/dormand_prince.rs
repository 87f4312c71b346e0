//! An explicit embedded Runge–Kutta pair of order 5(4) (Dormand and Prince 1980), on the stack.
//!
//! ```text
//! y₁ = y + h Σ b_i k_i              order 5
//! error = h Σ (b_i − b̂_i) k_i       against order 4
//! k_7 = f(y₁)                       is k_1 of the next step
//! ```
//!
//! Switching points: where a slider reaches its cap or a contact opens, the right side is
//! continuous, but its derivative jumps. There a pair of order five falls to order two, and its
//! error estimate sees little of it. So each element states its trial value and its cap, and a step
//! is cut where they cross. Flows that continue smoothly beyond a switching point end the step
//! there instead, by dense output.

use crate::rock::Vec3;
use crate::solver::tableau::RATIO;

/// Times of its stages (–, relative to the step).
pub(in crate::solver) const NODES: [f64; 6] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0];

/// Coefficients of the stages, row by row.
const A2: [f64; 1] = [0.2];
const A3: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
const A4: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
const A5: [f64; 4] = [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0];
const A6: [f64; 5] =
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0];
/// Weights of the first, third … sixth stage in the step.
const B: [f64; 5] = [35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
/// The same, and of the seventh stage, in the error estimate.
const E: [f64; 6] = [
    71.0 / 57600.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Weights of the first, third … seventh stage in the dense output (Hairer, Nørsett and Wanner
/// 1993, II.6).
const D: [f64; 6] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// Rates of `N` state variables and of `Q` quadratures, and `P` switching functions.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Rates<const N: usize, const Q: usize, const P: usize> {
    pub(in crate::solver) y: [f64; N],
    pub(in crate::solver) q: [f64; Q],
    /// Squared trial value of an element, and its cap: where they cross, the element switches.
    pub(in crate::solver) switching: [[f64; 2]; P],
}

/// The vector at offset `at`.
#[inline]
pub(in crate::solver) fn vec3_at<const N: usize>(y: &[f64; N], at: usize) -> Vec3 {
    Vec3::new(y[at], y[at + 1], y[at + 2])
}

/// Writes a vector to offset `at`.
#[inline]
pub(in crate::solver) fn put_vec3<const N: usize>(y: &mut [f64; N], at: usize, x: &Vec3) {
    y[at..at + 3].copy_from_slice(x.as_slice());
}

impl<const N: usize, const Q: usize, const P: usize> Rates<N, Q, P> {
    /// Nothing changes.
    pub(in crate::solver) const NONE: Self =
        Self { y: [0.0; N], q: [0.0; Q], switching: [[0.0; 2]; P] };
}

/// A system of ordinary differential equations.
pub(in crate::solver) trait Flow<const N: usize, const Q: usize, const P: usize> {
    /// Writes the rates at the time of stage `node` into `to`.
    fn rates(&mut self, node: usize, y: &[f64; N], to: &mut Rates<N, Q, P>);
    /// Squared norm of a local error over the allowed one.
    fn size2(&self, off: &[f64; N]) -> f64;
}

/// Whether an element with this squared trial value and cap slips, or is open.
#[inline]
pub(in crate::solver) fn slips([trial2, cap]: [f64; 2]) -> bool {
    trial2 > cap * cap
}

/// Trial value less the cap.
#[inline]
pub(in crate::solver) fn excess([trial2, cap]: [f64; 2]) -> f64 {
    trial2.sqrt() - cap
}

/// Adds the quadratures of a step.
#[inline]
pub(in crate::solver) fn add_sums<const Q: usize>(sums: &mut [f64; Q], more: &[f64; Q]) {
    for (sum, more) in sums.iter_mut().zip(more) {
        *sum += more;
    }
}

/// A trial step.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct TrialResult<const N: usize, const Q: usize> {
    pub(in crate::solver) y: [f64; N],
    pub(in crate::solver) q: [f64; Q],
    /// Squared norm of its local error over the allowed one.
    pub(in crate::solver) error2: f64,
}

/// Outcome of a trial step.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) enum Attempt<const N: usize, const Q: usize> {
    /// It contains no significant switching point.
    Whole(TrialResult<N, Q>),
    /// It should end after this share of it (–): an element begins to slip, to stick or to open
    /// there.
    Cut(f64),
}

/// The stages of a step, the first at its start; the storage is reused from step to step, so that
/// none is copied.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Stages<const N: usize, const Q: usize, const P: usize>(
    [Rates<N, Q, P>; 7],
);

/// Stages up to the one at four fifths of the step: a switching point among them is found before
/// the others are evaluated.
const EARLY_STAGES: usize = 4;

impl<const N: usize, const Q: usize, const P: usize> Stages<N, Q, P> {
    /// None yet.
    pub(in crate::solver) const NONE: Self = Self([Rates::NONE; 7]);

    /// Rates at the step's start.
    pub(in crate::solver) fn first(&mut self) -> &mut Rates<N, Q, P> {
        &mut self.0[0]
    }

    /// Makes the last stage the first of the next step (first same as last).
    pub(in crate::solver) fn reuse_last(&mut self) {
        self.0[0] = self.0[6];
    }

    /// Tries a step of length `h` from `y`, whose rates are in the first stage. `felt` is the
    /// allowed error, by which switching points are judged; `None` if none are searched for.
    #[inline]
    pub(in crate::solver) fn step(
        &mut self,
        flow: &mut impl Flow<N, Q, P>,
        y: &[f64; N],
        h: f64,
        felt: Option<f64>,
    ) -> Attempt<N, Q> {
        self.begin(flow, y, h);
        // a switching point in the first four fifths is found before the last three stages are
        // evaluated
        if let Some(cut) = felt.and_then(|allowed| self.cut(EARLY_STAGES, h, allowed)) {
            return Attempt::Cut(cut);
        }
        let tried = self.finish(flow, y, h);
        let cut = felt.and_then(|allowed| self.cut(self.0.len(), h, allowed));
        cut.map_or(Attempt::Whole(tried), Attempt::Cut)
    }

    /// Tries a step of length `h` from `y`, whose rates are in the first stage, without switching
    /// points.
    #[inline]
    pub(in crate::solver) fn smooth_step(
        &mut self,
        flow: &mut impl Flow<N, Q, P>,
        y: &[f64; N],
        h: f64,
    ) -> TrialResult<N, Q> {
        self.begin(flow, y, h);
        self.finish(flow, y, h)
    }

    /// The stages up to the one at four fifths.
    #[inline]
    fn begin(&mut self, flow: &mut impl Flow<N, Q, P>, y: &[f64; N], h: f64) {
        let [k1, k2, k3, k4, ..] = &mut self.0;
        flow.rates(1, &combined(y, h, [&k1.y], A2), k2);
        flow.rates(2, &combined(y, h, [&k1.y, &k2.y], A3), k3);
        flow.rates(3, &combined(y, h, [&k1.y, &k2.y, &k3.y], A4), k4);
    }

    /// The last three stages, and the result of the step.
    #[inline]
    fn finish(&mut self, flow: &mut impl Flow<N, Q, P>, y: &[f64; N], h: f64) -> TrialResult<N, Q> {
        let [k1, k2, k3, k4, k5, k6, k7] = &mut self.0;
        flow.rates(4, &combined(y, h, [&k1.y, &k2.y, &k3.y, &k4.y], A5), k5);
        flow.rates(5, &combined(y, h, [&k1.y, &k2.y, &k3.y, &k4.y, &k5.y], A6), k6);
        let end = combined(y, h, [&k1.y, &k3.y, &k4.y, &k5.y, &k6.y], B);
        // the seventh stage is at the step's end: it serves the error, and opens the next step
        flow.rates(5, &end, k7);
        let off = combined(&[0.0; N], h, [&k1.y, &k3.y, &k4.y, &k5.y, &k6.y, &k7.y], E);
        TrialResult {
            y: end,
            q: combined(&[0.0; Q], h, [&k1.q, &k3.q, &k4.q, &k5.q, &k6.q], B),
            error2: flow.size2(&off),
        }
    }

    /// Squared trial values and caps of the elements at the stages of the step: the first at its
    /// start, the last at its end.
    pub(in crate::solver) fn switching(&self) -> [&[[f64; 2]; P]; 7] {
        self.0.each_ref().map(|stage| &stage.switching)
    }
}

/// Dense output of a step, of order 4.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct DenseOutput<const M: usize> {
    from: [f64; M],
    difference: [f64; M],
    /// Corrections by the rate at its start, by the rate at its end, and beyond the cubic of both.
    start_bend: [f64; M],
    end_bend: [f64; M],
    quartic: [f64; M],
}

impl<const M: usize> DenseOutput<M> {
    /// From one state to another in a step of length `h`, with the rates `k` of its first, third …
    /// seventh stage.
    #[inline]
    fn of((from, to): (&[f64; M], &[f64; M]), k: [&[f64; M]; 6], h: f64) -> Self {
        let [first, .., last] = k;
        let quartic = combined(&[0.0; M], h, k, D);
        let difference: [f64; M] = std::array::from_fn(|i| to[i] - from[i]);
        let start_bend: [f64; M] = std::array::from_fn(|i| h * first[i] - difference[i]);
        let end_bend = std::array::from_fn(|i| difference[i] - h * last[i] - start_bend[i]);
        Self { from: *from, difference, start_bend, end_bend, quartic }
    }

    /// After this `share` of the step (–).
    #[inline]
    pub(in crate::solver) fn at(&self, share: f64) -> [f64; M] {
        let (Self { from, difference, start_bend, end_bend, quartic }, left) = (self, 1.0 - share);
        std::array::from_fn(|i| {
            let curve = start_bend[i] + share * (end_bend[i] + left * quartic[i]);
            from[i] + share * (difference[i] + left * curve)
        })
    }
}

impl<const N: usize, const Q: usize, const P: usize> Stages<N, Q, P> {
    /// Dense output of a step of length `h` from `y`.
    pub(in crate::solver) fn dense_output(
        &self,
        (y, tried): (&[f64; N], &TrialResult<N, Q>),
        h: f64,
    ) -> DenseOutput<N> {
        let [k1, _, k3, k4, k5, k6, k7] = &self.0;
        DenseOutput::of((y, &tried.y), [&k1.y, &k3.y, &k4.y, &k5.y, &k6.y, &k7.y], h)
    }

    /// Dense output of its quadratures, from 0.
    pub(in crate::solver) fn dense_sums(
        &self,
        tried: &TrialResult<N, Q>,
        h: f64,
    ) -> DenseOutput<Q> {
        let [k1, _, k3, k4, k5, k6, k7] = &self.0;
        DenseOutput::of((&[0.0; Q], &tried.q), [&k1.q, &k3.q, &k4.q, &k5.q, &k6.q, &k7.q], h)
    }
}

/// `y + h Σ a k`.
#[inline]
fn combined<const N: usize, const K: usize>(
    y: &[f64; N],
    h: f64,
    k: [&[f64; N]; K],
    a: [f64; K],
) -> [f64; N] {
    let mut sum = *y;
    for (k, a) in k.into_iter().zip(a) {
        let a = a * h;
        for (sum, k) in sum.iter_mut().zip(k) {
            *sum += a * k;
        }
    }
    sum
}

/// Safety factor of the next step (–).
const SAFETY: f64 = 0.85;

/// Growth factor of the next step: `clamp(0.85 err^(−1/4), 0.2, 4)`, with `err² = error2`.
#[inline]
pub(in crate::solver) fn growth(error2: f64) -> f64 {
    // Between the exponents of orders 4 and 5: the fourth root takes hardly more than three square
    // roots.
    let root = error2.sqrt().sqrt().sqrt();
    if root * RATIO.1 <= SAFETY { RATIO.1 } else { (SAFETY / root).max(RATIO.0) }
}

/// A switching point outside these shares of a step is ignored (–): too near to one of its ends.
const INTERIOR: (f64, f64) = (0.02, 0.98);
/// A step is cut behind a switching point by this factor, so that the point lies in the shorter
/// step (–).
const OVERSHOOT: f64 = 1.01;
/// A step is cut at a switching point if the excess beyond it, times the step, is more than this
/// number of allowed errors (–): the error estimate of the pair may not see it.
const CUT_THRESHOLD: f64 = 20.0;

impl<const N: usize, const Q: usize, const P: usize> Stages<N, Q, P> {
    /// Share of the step of length `h` at which it should end (–), because an element begins to
    /// slip, to stick or to open there and goes well beyond; by the first `known` stages.
    #[inline]
    fn cut(&self, known: usize, h: f64, allowed: f64) -> Option<f64> {
        let mut cut: Option<f64> = None;
        for (k, first) in self.0[0].switching.into_iter().map(slips).enumerate() {
            if self.0[1..known].iter().any(|stage| slips(stage.switching[k]) != first) {
                let (at, beyond) = self.crossing(k, known);
                let is_felt =
                    at > INTERIOR.0 && at < INTERIOR.1 && beyond * h > CUT_THRESHOLD * allowed;
                if is_felt && cut.is_none_or(|cut| at < cut) {
                    cut = Some(at);
                }
            }
        }
        cut.map(|at| at * OVERSHOOT)
    }

    /// Share of the step at which element `k` first crosses its cap, and its largest excess beyond,
    /// by the first `known` stages.
    ///
    /// Linear between stages; the shorter step finds it again, more accurately.
    fn crossing(&self, k: usize, known: usize) -> (f64, f64) {
        // trial value less the cap: above 0 the element slips, or the contact is open
        let excess_of = |stage: &Rates<N, Q, P>| excess(stage.switching[k]);
        let first = excess_of(&self.0[0]);
        let (mut before, mut at, mut found, mut beyond) = (first, 0.0, None, 0.0f64);
        for (stage, node) in self.0[..known].iter().zip(NODES.into_iter().chain([1.0])).skip(1) {
            let here = excess_of(stage);
            if (here > 0.0) != (first > 0.0) {
                beyond = beyond.max(here.abs());
                let share = before / (before - here);
                found = found.or(Some(at + (node - at) * share));
            }
            (before, at) = (here, node);
        }
        // if the step starts close to the cap the switching has little effect: the lesser excess of
        // both sides counts
        (found.unwrap_or(1.0), beyond.min(first.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `y'' = −y` with its energy summed up: `(cos, −sin)`, and `∫ sin² = t/2 − sin 2t/4`.
    struct Swing;

    impl Flow<2, 1, 0> for Swing {
        fn rates(&mut self, _node: usize, y: &[f64; 2], to: &mut Rates<2, 1, 0>) {
            (to.y, to.q) = ([y[1], -y[0]], [y[1] * y[1]]);
        }

        fn size2(&self, off: &[f64; 2]) -> f64 {
            off[0] * off[0] + off[1] * off[1]
        }
    }

    /// Between its ends a step is right to order 4, and its ends are what they are.
    #[test]
    fn a_step_is_known_between_its_ends() {
        let start = [1.0, 0.0];
        let off = |h: f64| {
            let mut stages = Stages::<2, 1, 0>::NONE;
            Swing.rates(0, &start, stages.first());
            let Attempt::Whole(tried) = stages.step(&mut Swing, &start, h, None) else {
                unreachable!("nothing is cut where nothing is felt")
            };
            let (place, sums) =
                (stages.dense_output((&start, &tried), h), stages.dense_sums(&tried, h));
            assert_eq!((place.at(0.0), sums.at(0.0)), (start, [0.0]));
            assert!((place.at(1.0)[0] - tried.y[0]).abs() < 1e-15);
            assert!((sums.at(1.0)[0] - tried.q[0]).abs() < 1e-15);
            let worst = |share: f64| {
                let (y, q) = (place.at(share), sums.at(share));
                let t = share * h;
                let summed = 0.5 * t - 0.25 * crate::math::sin_cos(2.0 * t).0;
                let (sine, cosine) = crate::math::sin_cos(t);
                (y[0] - cosine).abs().max((y[1] + sine).abs()).max((q[0] - summed).abs())
            };
            (1..10).map(|k| worst(0.1 * f64::from(k))).fold(0.0, f64::max)
        };
        let (coarse, fine) = (off(0.4), off(0.2));
        assert!(coarse < 3e-5 && coarse / fine > 20.0, "{coarse:e} {fine:e}");
    }
}
