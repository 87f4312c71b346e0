//! An explicit embedded Runge–Kutta pair of order 5(4) (Dormand and Prince 1980), on the stack.

use crate::rock::Vec3;

/// Times of its stages (–, relative to the step).
pub(in crate::solver) const NODES: [f64; 6] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0];

const A2: [f64; 1] = [0.2];
const A3: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
const A4: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
const A5: [f64; 4] = [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0];
const A6: [f64; 5] =
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0];
/// Weights of the first, third … sixth stage in the step.
const B: [f64; 5] = [35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
/// The same, and of the seventh stage, in the difference to order four.
const E: [f64; 6] = [
    71.0 / 57600.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Rates of `N` numbers that change and of `Q` that are only summed up, and `P` places where the law may have a kink.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Rates<const N: usize, const Q: usize, const P: usize> {
    pub(in crate::solver) y: [f64; N],
    pub(in crate::solver) q: [f64; Q],
    /// What an element asks for, squared, and its cap: where they cross, the law has a kink.
    pub(in crate::solver) kinks: [[f64; 2]; P],
}

/// The vector that begins at place `at`.
#[inline]
pub(in crate::solver) fn three<const N: usize>(y: &[f64; N], at: usize) -> Vec3 {
    Vec3::new(y[at], y[at + 1], y[at + 2])
}

/// Writes a vector to place `at`.
#[inline]
pub(in crate::solver) fn put<const N: usize>(y: &mut [f64; N], at: usize, x: &Vec3) {
    y[at..at + 3].copy_from_slice(x.as_slice());
}

impl<const N: usize, const Q: usize, const P: usize> Rates<N, Q, P> {
    /// Nothing changes.
    pub(in crate::solver) const NONE: Self =
        Self { y: [0.0; N], q: [0.0; Q], kinks: [[0.0; 2]; P] };
}

/// Something that changes.
pub(in crate::solver) trait Flow<const N: usize, const Q: usize, const P: usize> {
    /// Rates at the time of stage `node`.
    fn rates(&mut self, node: usize, y: &[f64; N]) -> Rates<N, Q, P>;
    /// Square of a local error over the one allowed.
    fn size2(&self, off: &[f64; N]) -> f64;
}

/// A step tried.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Tried<const N: usize, const Q: usize, const P: usize> {
    pub(in crate::solver) y: [f64; N],
    pub(in crate::solver) q: [f64; Q],
    /// Rates at its end.
    pub(in crate::solver) last: Rates<N, Q, P>,
    /// Square of its local error over the one allowed.
    pub(in crate::solver) error2: f64,
    /// What the elements ask for, squared, and their caps, at every stage.
    kinks: [[[f64; 2]; P]; 7],
}

/// Tries a step of length `h` from `y`, where the rates are `first`.
#[inline]
pub(in crate::solver) fn step<const N: usize, const Q: usize, const P: usize>(
    flow: &mut impl Flow<N, Q, P>,
    y: &[f64; N],
    first: &Rates<N, Q, P>,
    h: f64,
) -> Tried<N, Q, P> {
    let k1 = first;
    let k2 = flow.rates(1, &mixed(y, h, [&k1.y], A2));
    let k3 = flow.rates(2, &mixed(y, h, [&k1.y, &k2.y], A3));
    let k4 = flow.rates(3, &mixed(y, h, [&k1.y, &k2.y, &k3.y], A4));
    let k5 = flow.rates(4, &mixed(y, h, [&k1.y, &k2.y, &k3.y, &k4.y], A5));
    let k6 = flow.rates(5, &mixed(y, h, [&k1.y, &k2.y, &k3.y, &k4.y, &k5.y], A6));
    let end = mixed(y, h, [&k1.y, &k3.y, &k4.y, &k5.y, &k6.y], B);
    let k7 = flow.rates(5, &end);
    let off = mixed(&[0.0; N], h, [&k1.y, &k3.y, &k4.y, &k5.y, &k6.y, &k7.y], E);
    Tried {
        y: end,
        q: mixed(&[0.0; Q], h, [&k1.q, &k3.q, &k4.q, &k5.q, &k6.q], B),
        last: k7,
        error2: flow.size2(&off),
        kinks: [k1.kinks, k2.kinks, k3.kinks, k4.kinks, k5.kinks, k6.kinks, k7.kinks],
    }
}

/// `y + h Σ a k`.
#[inline]
fn mixed<const N: usize, const K: usize>(
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
/// Most that a step shrinks or grows at once (–).
const RATIO: (f64, f64) = (0.2, 4.0);

/// By how much the next step may be longer.
#[inline]
pub(in crate::solver) fn growth(error2: f64) -> f64 {
    // The fourth root, between those of the orders 4 and 5 for little more than three roots.
    let root = error2.sqrt().sqrt().sqrt();
    if root * RATIO.1 <= SAFETY { RATIO.1 } else { (SAFETY / root).max(RATIO.0) }
}

/// A kink nearer to an end of a step than this share of it is not looked for (–) …
const AT_AN_END: (f64, f64) = (0.02, 0.98);
/// … and one found is passed by this share, so that it lies in the shorter step (–).
const PAST: f64 = 1.01;
/// A kink is cut at where what is beyond it, times the step, is more than so many errors allowed (–): the pair's own estimate
/// may not see it.
const FELT: f64 = 20.0;

impl<const N: usize, const Q: usize, const P: usize> Tried<N, Q, P> {
    /// At which share of the step of length `h` it should end instead (–), because an element begins to slip, to stick or to
    /// open there, and not little beyond it.
    #[inline]
    pub(in crate::solver) fn cut(&self, h: f64, allowed: f64) -> Option<f64> {
        let slips = |[asked2, cap]: [f64; 2]| asked2 > cap * cap;
        let first = self.kinks[0].map(slips);
        let mut cut: Option<f64> = None;
        for (k, first) in first.into_iter().enumerate() {
            if self.kinks[1..].iter().any(|kinks| slips(kinks[k]) != first) {
                let (at, beyond) = self.kink(k);
                let is_felt = at > AT_AN_END.0 && at < AT_AN_END.1 && beyond * h > FELT * allowed;
                if is_felt && cut.is_none_or(|cut| at < cut) {
                    cut = Some(at);
                }
            }
        }
        cut.map(|at| at * PAST)
    }

    /// Where in the step element `k` first crosses its cap, and how far beyond it gets.
    fn kink(&self, k: usize) -> (f64, f64) {
        let over = |stage: usize| {
            let [asked2, cap] = self.kinks[stage][k];
            asked2.sqrt() - cap
        };
        let first = over(0);
        let (mut before, mut at, mut found, mut beyond) = (first, 0.0, None, 0.0f64);
        for (stage, node) in NODES.into_iter().chain([1.0]).enumerate().skip(1) {
            let here = over(stage);
            if (here > 0.0) != (first > 0.0) {
                beyond = beyond.max(here.abs());
                let share = before / (before - here);
                found = found.or(Some(at + (node - at) * share));
            }
            (before, at) = (here, node);
        }
        (found.unwrap_or(1.0), beyond.min(first.abs()))
    }
}
