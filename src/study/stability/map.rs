//! Stiffness against step: where an impact is accurate, stable, or neither.

use super::bounds::DIGITS;
use super::impacts::rebound_m_s;
use crate::ground::{damping_ratio, normal_impact};
use crate::rock::Vec3;
use crate::simulation::{Scratch, Stop};
use crate::solver::Scheme;
use crate::study::bench::{GRAVITY_M_S2, GROUND, SETUP, Setup, settings, terrain, with_springs};
use crate::terrain::{Terrain, make};

/// Approach speed of the impacts (m/s).
const SPEED_M_S: f64 = 5.0;
/// A rebound this near to the exact one, over the approach speed, is accurate (–).
const ACCURATE: f64 = 0.02;

/// How an impact came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Rebound within 2 % of the approach speed.
    Accurate,
    /// Not accurate, but finite and without a joule too much.
    Stable,
    /// Failed, not finite, or with more energy than before.
    Unstable,
}

/// One impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StabilityCell {
    /// Normal stiffness (N/m).
    pub stiffness_n_m: f64,
    /// Step (s) or tolerance (m/s).
    pub fineness: f64,
    /// Rebound over approach speed (–).
    pub rebound: f64,
    /// How it came out.
    pub verdict: Verdict,
}

/// All stiffnesses against all steps of one scheme.
#[derive(Debug, Clone)]
pub struct Map {
    /// The scheme.
    pub scheme: Scheme,
    /// Steps (s) or tolerances (m/s), rising.
    pub fineness: Vec<f64>,
    /// Stiffness (N/m), rising.
    pub stiffness_n_m: Vec<f64>,
    /// Row by row: all stiffnesses of the first step, then of the next.
    pub cells: Vec<StabilityCell>,
}

impl Map {
    /// Impacts of the usual rock at 5 m/s. The rigid scheme has no springs, so no map.
    pub fn all() -> Vec<Self> {
        let powers = |range: std::ops::RangeInclusive<i32>| -> Vec<f64> {
            range.map(|power| 10f64.powi(power)).collect()
        };
        let floor = terrain(make::jittered_plane(50.0, 1, 0.0));
        let sprung = Scheme::ALL.into_iter().filter(|scheme| scheme.has_springs());
        sprung
            .map(|scheme| {
                let (from, to) = scheme.of([(-7, -2), (-6, 0), (-8, -2), (0, 0)]);
                Self::of(scheme, powers(from..=to), powers(6..=14), &floor)
            })
            .collect()
    }

    fn of(scheme: Scheme, fineness: Vec<f64>, stiffness_n_m: Vec<f64>, floor: &Terrain) -> Self {
        let mut scratch = Scratch::default();
        let mut cells = Vec::new();
        for &fine in &fineness {
            cells.extend(
                stiffness_n_m
                    .iter()
                    .map(|&stiffness| cell(scheme, fine, stiffness, floor, &mut scratch)),
            );
        }
        Self { scheme, fineness, stiffness_n_m, cells }
    }
}

fn cell(
    scheme: Scheme,
    fineness: f64,
    stiffness: f64,
    floor: &Terrain,
    scratch: &mut Scratch,
) -> StabilityCell {
    let omega = (stiffness / SETUP.rock.mass_kg()).sqrt();
    let ground = with_springs(GROUND, stiffness);
    let fixed = if scheme.has_fixed_step() { 2.0 * fineness } else { 0.0 };
    let setup = Setup {
        ground,
        centre_m: Vec3::new(0.3, 0.2, SETUP.rock.radius_m),
        velocity_m_s: Vec3::new(0.0, 0.0, -SPEED_M_S),
        longest_s: 3.5 / omega + fixed,
        ..SETUP
    };
    let journey = setup.follow(floor, &settings(scheme, fineness, Some(0.02)), scratch);
    let rebound = rebound_m_s(&journey, &setup) / SPEED_M_S;
    let exact = normal_impact(SPEED_M_S, omega, damping_ratio(0.5), GRAVITY_M_S2).rebound_m_s;
    let gains =
        journey.ledger.rise_j > DIGITS * journey.extremes.total_j || rebound > 1.0 + ACCURATE;
    let verdict = if matches!(journey.stop, Stop::Failed(_)) || !rebound.is_finite() || gains {
        Verdict::Unstable
    } else if (rebound - exact.unwrap_or(0.0) / SPEED_M_S).abs() < ACCURATE {
        Verdict::Accurate
    } else {
        Verdict::Stable
    };
    StabilityCell { stiffness_n_m: stiffness, fineness, rebound, verdict }
}
