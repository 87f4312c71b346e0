//! Effects of soft soil besides friction and restitution: friction that grows with slip, and the
//! drag of a scar.

use crate::math;
use std::f64::consts::{FRAC_PI_2, PI};

/// Friction that grows with the slip distance `s` (m), as soil is pushed up in front of a rock
/// (Leine et al. 2014, Eqs. 46–47): `μ(s) = μ_0 + (2/π)(μ_max − μ_0) atan(κ s)`, `s' = |slip|` in
/// contact and `s' = −β s` in flight; `μ_0` is that of the friction angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipFriction {
    /// Largest coefficient of friction `μ_max` (–).
    pub most: f64,
    /// Rate of growth `κ` (1/m), positive.
    pub kappa_per_m: f64,
    /// Rate of decay in flight `β` (1/s), 0 or more.
    pub beta_per_s: f64,
}

/// A layer of soil that yields in an impact (Lu et al. 2019, Eqs. 9–14). The rock digs in to the
/// depth [`Self::depth_m`], meets a hard plane there, and leaves. In the soil a drag `½ C ρ_s A
/// |v|²` acts against its velocity, at its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scar {
    /// Strength of the soil `M_E` (kN/m²), positive.
    pub strength_kn_m2: f64,
    /// Drag coefficient `C` (–), 0 or more.
    pub drag: f64,
    /// Density of the soil `ρ_s` (kg/m³), 0 or more.
    pub soil_density_kg_m3: f64,
}

impl SlipFriction {
    /// Coefficient of friction (–) after a slip (m): `μ_0 + (2/π)(μ_max − μ_0) atan(κ s)`.
    pub(crate) fn at(&self, least: f64, slip_m: f64) -> f64 {
        least + (self.most - least) * math::atan(self.kappa_per_m * slip_m) / FRAC_PI_2
    }

    /// Slip (m) that is left after a flight of `flight_s` (s): `s e^(−β t)`.
    pub(crate) fn left_m(&self, slip_m: f64, flight_s: f64) -> f64 {
        slip_m * math::exp(-self.beta_per_s * flight_s)
    }
}

impl Scar {
    /// Depth of the scar (m) of a rock of a mass (kg) that hits the surface with a normal speed
    /// (m/s): `d = 0.1 M^(1/3) M_E^(−0.4) v^0.8`, bound to these units (Eq. 11).
    pub fn depth_m(&self, mass_kg: f64, approach_m_s: f64) -> f64 {
        let strength = math::pow(self.strength_kn_m2, -0.4);
        0.1 * math::cbrt(mass_kg) * strength * math::pow(approach_m_s, 0.8)
    }

    /// Relative loss of speed by the drag per metre and per square metre of the cut (1/m³): `C
    /// ρ_s/(2 m)`.
    pub fn drag_per_m3(&self, mass_kg: f64) -> f64 {
        0.5 * self.drag * self.soil_density_kg_m3 / mass_kg
    }
}

/// Area (m²) of that part of a ball which is below the surface, as seen along its velocity.
///
/// `depth_m` is how far the ball reaches below the surface, `cosine` that of the angle between
/// velocity and surface normal. The cut by the surface is a disc, seen as an ellipse; where the
/// ball's outline dips below the surface, the circular segment beside it is added. `cosine` 1: the
/// disc `π(2Rζ − ζ²)` up to the ball's middle; `cosine` 0: the segment `R² acos(1 − ζ/R) − (R −
/// ζ)√(2Rζ − ζ²)`.
pub fn cut_area_m2(radius_m: f64, depth_m: f64, cosine: f64) -> f64 {
    let (r, sine) = (radius_m, (1.0 - cosine * cosine).max(0.0).sqrt());
    let above = r - depth_m;
    if depth_m <= 0.0 {
        return 0.0;
    }
    if above <= -r * sine {
        return PI * r * r;
    }
    let disc2 = depth_m * (2.0 * r - depth_m);
    if above >= r * sine {
        return PI * disc2 * cosine;
    }
    let outline = above / (r * sine);
    let disc = (above * cosine / (sine * disc2.sqrt())).clamp(-1.0, 1.0);
    let beyond = |x: f64| math::acos(x) - x * (1.0 - x * x).max(0.0).sqrt();
    r * r * beyond(outline) + disc2 * cosine * (PI - beyond(disc))
}

/// Volume of soil (m³) that a ball sweeps on a straight path from the surface to a depth (m), or
/// out again: `∫ A dζ / cosine` over the depth.
pub fn swept_m3(radius_m: f64, depth_m: f64, cosine: f64) -> f64 {
    let r = radius_m;
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    // until the outline dips in the area is the disc alone
    let first = depth_m.min(r * (1.0 - sine));
    let early = PI * first * first * (r - first / 3.0);
    // and from here on the whole ball
    let last = depth_m.min(r * (1.0 + sine));
    let all = PI * r * r * (depth_m - last);
    if depth_m <= first {
        return early;
    }
    // with the square of the variable the integrand has no root singularity at the lower end
    let cut = |x: f64| 2.0 * x * cut_area_m2(r, first + (last - first) * x * x, cosine);
    early + ((last - first) * over_unit(cut) + all) / cosine
}

/// Nodes and weights of Gauss–Legendre quadrature with sixteen points, those above 0.
const GAUSS: [[f64; 2]; 8] = [
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_6],
    [0.458_016_777_657_227_4, 0.169_156_519_395_002_54],
    [0.617_876_244_402_643_7, 0.149_595_988_816_576_73],
    [0.755_404_408_355_003, 0.124_628_971_255_533_87],
    [0.865_631_202_387_831_7, 0.095_158_511_682_492_78],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_894],
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_095],
];

/// Integral from 0 to 1, by Gauss–Legendre quadrature.
pub(crate) fn over_unit(f: impl Fn(f64) -> f64) -> f64 {
    let pair = |[x, weight]: [f64; 2]| 0.5 * weight * (f(0.5 - 0.5 * x) + f(0.5 + 0.5 * x));
    GAUSS.map(pair).iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const R: f64 = 0.5;

    /// The area against one counted on a fine grid of lines along the velocity: a line counts if
    /// any part of it inside the ball is deep enough.
    #[test]
    fn the_cut_area_is_what_lines_along_the_velocity_meet() {
        let n = 400;
        for depth in [0.02, 0.1, 0.3, 0.5, 0.7, 0.95, 1.2] {
            for cosine in [1.0, 0.9, 0.6, 0.3, 0.05, 0.0_f64] {
                let sine = (1.0 - cosine * cosine).sqrt();
                let at = |i: i32| R * (f64::from(2 * i + 1) / f64::from(n) - 1.0);
                let meets = |(x, y): (f64, f64)| {
                    let half2 = R * R - x * x - y * y;
                    half2 > 0.0 && y * sine + half2.sqrt() * cosine >= R - depth
                };
                let lines = (0..n).flat_map(|i| (0..n).map(move |j| (at(i), at(j))));
                let counted = lines.filter(|line| meets(*line)).count() as f64
                    * (2.0 * R / f64::from(n)).powi(2);
                let found = cut_area_m2(R, depth, cosine);
                assert!((found - counted).abs() < 3e-4, "{depth} {cosine}: {found} {counted}");
            }
        }
    }

    /// The swept volume against a fine sum of areas; for a normal impact, `π(R z² − z³/3)`.
    #[test]
    fn what_is_swept_is_the_integral_of_the_area() {
        for depth in [0.001, 0.1, 0.4, 0.8, 1.3] {
            for cosine in [1.0, 0.999, 0.8, 0.4, 0.1] {
                let n = 200_000;
                let step = depth / f64::from(n);
                let areas = (0..n).map(|k| cut_area_m2(R, (f64::from(k) + 0.5) * step, cosine));
                let sum = areas.sum::<f64>() * step / cosine;
                let found = swept_m3(R, depth, cosine);
                assert!((found / sum - 1.0).abs() < 2e-5, "{depth} {cosine}: {found} {sum}");
            }
        }
        let square = |z: f64| PI * (R * z * z - z.powi(3) / 3.0);
        assert!((swept_m3(R, 0.2, 1.0) / square(0.2) - 1.0).abs() < 1e-14);
    }

    /// A ball of 0.5 m and 2700 kg/m³ that falls into soil with `C ρ_s` = 2.5 · 1700 kg/m³ keeps
    /// 0.978204 of its speed after 0.1 m and 0.921409 after 0.2 m.
    #[test]
    fn a_ball_that_falls_square_keeps_what_the_closed_form_says() {
        let mass = 4.0 / 3.0 * PI * R.powi(3) * 2700.0;
        let scar = Scar { strength_kn_m2: 15e3, drag: 2.5, soil_density_kg_m3: 1700.0 };
        for (depth, kept) in [(0.1, 0.978_204_004_6), (0.2, 0.921_408_453_5)] {
            let found = math::exp(-scar.drag_per_m3(mass) * swept_m3(R, depth, 1.0));
            assert!((found - kept).abs() < 5e-11, "{found}");
        }
    }

    /// Eq. 11 by its powers, and its value for 780 kg at 10 m/s on 15 MN/m², computed by hand:
    /// 0.12405 m.
    #[test]
    fn the_depth_of_a_scar_is_that_of_the_equation() {
        let scar = Scar { strength_kn_m2: 15e3, drag: 2.5, soil_density_kg_m3: 1700.0 };
        let depth = scar.depth_m(780.0, 10.0);
        assert!((depth - 0.124_049_503_566).abs() < 1e-12, "{depth}");
        assert!((scar.depth_m(8.0 * 780.0, 10.0) / depth - 2.0).abs() < 1e-14);
        assert!((scar.depth_m(780.0, 320.0) / depth - 16.0).abs() < 1e-13);
        let soft = Scar { strength_kn_m2: 15e3 / 32.0, ..scar };
        assert!((soft.depth_m(780.0, 10.0) / depth - 4.0).abs() < 1e-13);
        assert!(scar.depth_m(780.0, 0.0) == 0.0);
    }

    /// The shallower the approach of a rock, the less it sweeps: nothing is left at a grazing
    /// touch, where the depth falls with v^0.8.
    #[test]
    fn a_grazing_rock_sweeps_nothing() {
        let scar = Scar { strength_kn_m2: 5e3, drag: 2.5, soil_density_kg_m3: 1700.0 };
        let swept = |approach: f64| swept_m3(R, scar.depth_m(1400.0, approach), approach / 20.0);
        let all = [10.0, 3.0, 1.0, 0.1, 1e-2, 1e-4, 1e-8].map(swept);
        assert!(all.windows(2).all(|pair| pair[1] < pair[0]) && all[6] < 1e-6, "{all:?}");
    }
}
