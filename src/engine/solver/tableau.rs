//! Diagonally implicit Runge–Kutta tableaux with an explicit first stage.
//!
//! ```text
//! x_1 = x,   x_i = x + h (Σ_{j<i} a_ij f_j + γ f_i),   i = 2 … s
//! step = x_s, so the weights b are the last row (stiffly accurate)
//! ```
//!
//! One diagonal coefficient γ for all stages: each is a displacement step `x_i = x* + h γ f(x_i)`
//! of the same form, one DDA solve, with one set of effective stiffnesses a step. The explicit
//! first stage gives stage order two; SDIRK schemes without it lose their order on stiff springs
//! (second-order SDIRK2: an error of 3.7e-2 where TR-BDF2 has 9.7e-5, a sphere on an edge at 1e13
//! N/m).

use crate::rock::Vec3;

/// Most stages of a tableau.
pub const STAGES: usize = 6;

/// Bounds of the change of the step length at once (–): an error estimate is not trusted beyond.
pub(crate) const RATIO: (f64, f64) = (0.2, 4.0);

/// One tableau: every implicit stage has the same diagonal and the last stage is the step's result.
#[derive(Debug)]
pub struct Tableau {
    /// Number of stages, the explicit first one included.
    pub stages: usize,
    /// Diagonal coefficient.
    pub diagonal: f64,
    /// Coefficients below the diagonal; the last row with the diagonal are the weights.
    /// Row `i` belongs to stage `i + 1` and lacks its diagonal; the first row is empty.
    pub a: &'static [&'static [f64]],
    /// Weights minus embedded weights: the error estimate.
    ///
    /// `b − b̂`, stage by stage; times rates and step it is the error (that of the lower order of
    /// the two).
    pub error: [f64; STAGES],
    /// `1/(order of the embedded method + 1)`.
    pub exponent: f64,
    /// Whether the embedded method is the one of higher order: its weights then measure the work done over a step.
    pub embedded_is_finer: bool,
}

impl Tableau {
    /// Weight of stage `k` in the step's result.
    #[inline]
    pub fn weight(&self, k: usize) -> f64 {
        if k + 1 == self.stages { self.diagonal } else { self.a[self.stages - 1][k] }
    }

    /// The base of implicit stage `i` of a step of length `h` from `x`, `x* = x + h Σ_{j<i} a_ij f_j`, of a `part` of the rates.
    #[inline]
    pub(super) fn base<R>(
        &self,
        (i, h): (usize, f64),
        (x, rates): (Vec3, &[R]),
        part: impl Fn(&R) -> Vec3,
    ) -> Vec3 {
        rates.iter().zip(self.a[i]).fold(x, |sum, (rate, a)| sum + part(rate) * (h * a))
    }

    /// Difference of the two methods in a `part` of the rates, over the step length:
    /// `Σ (b_i − b̂_i) f_i`.
    #[inline]
    pub(super) fn embedded_difference<R>(&self, rates: &[R], part: impl Fn(&R) -> Vec3) -> Vec3 {
        let weighted = rates[..self.stages].iter().zip(self.error);
        weighted.fold(Vec3::zeros(), |sum, (rate, weight)| sum + part(rate) * weight)
    }

    /// Node of stage `k`, its time over the step length (–).
    pub(crate) fn node(&self, k: usize) -> f64 {
        self.a[k].iter().sum::<f64>() + if k > 0 { self.diagonal } else { 0.0 }
    }

    /// Weight of stage `k` in the work done over the step: that of the finer of the two methods.
    ///
    /// The power that goes into contacts is one more component of the motion. Summed with the
    /// weights of the finer method it is that of the exact motion from the step's start, to one
    /// order more than the step itself. What the energy of the motion then misses is the gain or
    /// loss of the step itself, not an error of the sum.
    #[inline]
    pub fn work_weight(&self, k: usize) -> f64 {
        if self.embedded_is_finer { self.weight(k) - self.error[k] } else { self.weight(k) }
    }

    /// The same for a stage that leaves the share `left` (–, 0..1) of the fastest motion of the
    /// contacts.
    ///
    /// The embedded method does not damp stiff motion. In a step much longer than the contact's own
    /// time scale the forces of a constraint oscillate from stage to stage; the step's own weights
    /// sum them to the impulse of the motion, those of the finer method do not. So their difference
    /// is filtered like an error estimate of stiff motion (Hosea and Shampine 1996).
    #[inline]
    pub fn damped_work_weight(&self, k: usize, left: f64) -> f64 {
        let own = self.weight(k);
        own + left * (self.work_weight(k) - own)
    }
}

/// `γ = 2 − √2`: trapezoidal rule to `γ h`, then BDF2; with it both stages have the diagonal `γ/2`.
const SQRT2: f64 = std::f64::consts::SQRT_2;
/// `√2/4`, the weight of the first two stages.
const W: f64 = SQRT2 / 4.0;
/// `γ/2 = 1 − √2/2`, the diagonal.
const D: f64 = 1.0 - SQRT2 / 2.0;

/// TR-BDF2 (Bank et al. 1985; embedded third order after Hosea and Shampine 1996): second order, stiffly accurate,
/// L-stable, stage order two, so it keeps its order when the springs are stiff.
pub static TR_BDF2: Tableau = Tableau {
    stages: 3,
    diagonal: D,
    a: &[&[], &[D], &[W, W]],
    error: [W - (1.0 - W) / 3.0, W - (3.0 * W + 1.0) / 3.0, D - D / 3.0, 0.0, 0.0, 0.0],
    exponent: 1.0 / 3.0,
    embedded_is_finer: true,
};

/// ESDIRK4(3)6L\[2\]SA (Kennedy and Carpenter 2003): fourth order, stage order two.
pub static ESDIRK4: Tableau = Tableau {
    stages: 6,
    diagonal: 0.25,
    a: &[
        &[],
        &[0.25],
        &[8611.0 / 62500.0, -1743.0 / 31250.0],
        &[5_012_029.0 / 34_652_500.0, -654_441.0 / 2_922_500.0, 174_375.0 / 388_108.0],
        &[
            15_267_082_809.0 / 155_376_265_600.0,
            -71_443_401.0 / 120_774_400.0,
            730_878_875.0 / 902_184_768.0,
            2_285_395.0 / 8_070_912.0,
        ],
        &[82889.0 / 524_892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102_672.0, -2260.0 / 8211.0],
    ],
    error: [
        82889.0 / 524_892.0 - 4_586_570_599.0 / 29_645_900_160.0,
        0.0,
        15625.0 / 83664.0 - 178_811_875.0 / 945_068_544.0,
        69875.0 / 102_672.0 - 814_220_225.0 / 1_159_782_912.0,
        -2260.0 / 8211.0 + 3_700_637.0 / 11_593_932.0,
        0.25 - 61727.0 / 225_920.0,
    ],
    exponent: 0.25,
    embedded_is_finer: false,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::Scheme;

    /// Of every scheme with a tableau: consistency and stage order two, `Σ a_ij = c_i` and `Σ a_ij c_j = c_i²/2` for every
    /// implicit stage; error weights that sum to nothing; the order that the scheme states, `Σ b_i c_i^(p−1) = 1/p` up to it
    /// and no further. 1e-15 times a few terms: rounding of the printed fractions.
    #[test]
    fn tableaux_have_stage_order_two_the_order_stated_and_an_embedded_method() {
        let schemes = Scheme::ALL.into_iter();
        for (scheme, tableau) in schemes.filter_map(|one| Some((one, one.tableau()?))) {
            let n = tableau.stages;
            let mut c = vec![0.0; n];
            for i in 1..n {
                c[i] = tableau.a[i].iter().sum::<f64>() + tableau.diagonal;
                let below: f64 = tableau.a[i].iter().zip(&c).map(|(a, c)| a * c).sum();
                let off = below + tableau.diagonal * c[i] - 0.5 * c[i] * c[i];
                assert!(off.abs() < 2e-14, "{scheme:?} stage {i}");
            }
            assert!((c[n - 1] - 1.0).abs() < 1e-14);
            assert!(tableau.error.iter().sum::<f64>().abs() < 1e-14);
            let holds = |weight: fn(&Tableau, usize) -> f64, p: i32| {
                let sum: f64 = (0..n).map(|k| weight(tableau, k) * c[k].powi(p - 1)).sum();
                (sum - 1.0 / f64::from(p)).abs() < 1e-13
            };
            let order = (1..=9).take_while(|p| holds(Tableau::weight, *p)).count();
            assert!((order as f64 - scheme.order()).abs() < 0.5, "{scheme:?}: {order}");
            // the work is summed to third order at least
            assert!((1..=3).all(|p| holds(Tableau::work_weight, p)), "{scheme:?}");
        }
    }

    /// A block with a damping ratio of 5 that stands on its spring under a weight and gets a kick along the normal; units in which mass and `ω`
    /// are 1. The normal forces of the stages of a step.
    fn kicked(tableau: &Tableau, h: f64, (weight, kick): (f64, f64)) -> (Vec<f64>, f64) {
        let damping = 10.0;
        let (way_s, start) = (tableau.diagonal * h, [weight, kick]);
        let mut rates = vec![[-kick, -damping * kick]];
        let mut up = kick;
        for i in 1..tableau.stages {
            let base = |part: usize| -> f64 {
                start[part] + (0..i).map(|k| h * tableau.a[i][k] * rates[k][part]).sum::<f64>()
            };
            let (pressed, free) = (base(0), base(1));
            up = (free + way_s * (pressed - weight)) / (1.0 + way_s * (damping + way_s));
            rates.push([-up, (pressed - way_s * up) - damping * up - weight]);
        }
        (rates.iter().map(|rate| rate[1] + weight).collect(), up)
    }

    /// Under a sliding contact friction takes energy in proportion to the normal impulse, which
    /// follows from the motion: `m Δu + m g h`. In a step of 30 rad the forces of the stages
    /// oscillate; the finer weights alone would give half as much again.
    #[test]
    fn work_under_a_stiff_contact_is_that_of_its_impulse() {
        let tableau = &TR_BDF2;
        let damping = 10.0;
        for (h, known, finer_is_off) in [(30.0, 2e-2, 0.3), (1e-3, 1e-5, 0.0)] {
            let (weight, kick) = (1.0, -1.0 / damping);
            let (forces, up) = kicked(tableau, h, (weight, kick));
            let impulse = up - kick + weight * h;
            let way_s = tableau.diagonal * h;
            let left = 1.0 / (1.0 + way_s * (damping + way_s));
            let sum = |of: &dyn Fn(usize) -> f64| {
                h * forces.iter().zip(0..).map(|(force, k)| force * of(k)).sum::<f64>() / impulse
            };
            let damped = sum(&|k| tableau.damped_work_weight(k, left));
            let finer = sum(&|k| tableau.work_weight(k));
            assert!((sum(&|k| tableau.weight(k)) - 1.0).abs() < 1e-12);
            assert!((damped - 1.0).abs() < known, "{h}: {damped}");
            assert!((finer - 1.0).abs() >= finer_is_off, "{h}: {finer}");
        }
    }
}
