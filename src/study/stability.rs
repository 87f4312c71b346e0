//! Stiff and extreme cases, each held against its analytic expectation or a bound, for every scheme.

mod blocks;
mod bounds;
mod fineness;
mod folds;
mod geometry;
mod impacts;
mod lasting;
mod many;
mod map;
mod page;

use super::bench::{Setup, settings};
use crate::simulation::{Scratch, Stop, Trajectory};
use crate::solver::{Scheme, Settings};
use crate::terrain::Terrain;
use bounds::DIGITS;
use rayon::prelude::*;

pub use map::{Map, StabilityCell, Verdict};
pub(super) use page::{csv, page};

/// One number of one case with one scheme, and the bound it must keep.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseOutcome {
    /// The case.
    pub case: &'static str,
    /// The setting within the case; empty where there is only one.
    pub setting: String,
    /// The scheme.
    pub scheme: Scheme,
    /// What is held: the expectation in words.
    pub law: &'static str,
    /// The number found, in the unit of the bound.
    pub found: f64,
    /// The largest that holds.
    pub bound: f64,
}

impl CaseOutcome {
    /// Whether the bound is kept; what is no number keeps none.
    pub fn holds(&self) -> bool {
        self.found <= self.bound
    }
}

/// A scheme at its usual fineness.
#[derive(Debug, Clone, Copy)]
pub struct SchemeSetting {
    /// The scheme.
    pub scheme: Scheme,
    /// Tolerance (m/s) or step (s).
    pub fineness: f64,
}

/// Every scheme at its usual fineness.
pub const WAYS: [SchemeSetting; 4] = [
    SchemeSetting { scheme: Scheme::Dda, fineness: 1e-5 },
    SchemeSetting { scheme: Scheme::Adaptive, fineness: 0.05 },
    SchemeSetting { scheme: Scheme::Reference, fineness: 1e-6 },
    SchemeSetting { scheme: Scheme::Rigid, fineness: 0.01 },
];

/// A case: all it finds with one scheme.
type StabilityTrial = fn(&SchemeSetting, &mut Notes);

/// Every case by name. To add one: a function and a row.
const TRIALS: [(&str, StabilityTrial); 34] = [
    ("impact", impacts::impact),
    ("step and tolerance", fineness::steps),
    ("shear memory", fineness::memory),
    ("thin sheet", impacts::thin_sheet),
    ("zero gap", impacts::zero_gap),
    ("from behind", impacts::from_behind),
    ("restitution 0 and 1", impacts::restitution),
    ("bounce to rest", impacts::bounce_to_rest),
    ("friction 0 and 89°", impacts::friction),
    ("no gravity", impacts::no_gravity),
    ("edge and corner", geometry::edge_and_corner),
    ("elastic folds", folds::elastic),
    ("noisy meshes", folds::noisy),
    ("borders of grounds", folds::borders),
    ("larger than its cells", folds::larger_than_cells),
    ("slides over cells", folds::slides),
    ("parallel walls", geometry::parallel_walls),
    ("narrow groove", geometry::narrow_groove),
    ("degenerate triangles", geometry::degenerate),
    ("flipped triangles", geometry::flipped),
    ("conflicting sheets", geometry::conflicting_sheets),
    ("offset of 1e6 m", geometry::offset),
    ("small triangles", geometry::small_triangles),
    ("one triangle", geometry::one_triangle),
    ("stack of two", many::stack),
    ("head-on", many::head_on),
    ("one centre for two", many::coincident),
    ("rest for an hour", lasting::rest),
    ("random releases", lasting::random_releases),
    ("flat and slender blocks", blocks::flat),
    ("blocks beside triangles", blocks::sizes),
    ("elastic blocks", blocks::elastic),
    ("fast blocks", blocks::fast),
    ("blocks that skid", blocks::friction),
];

/// What the cases found, in order.
#[derive(Debug, Default)]
pub(super) struct Notes {
    case: &'static str,
    scratch: Scratch,
    outcomes: Vec<CaseOutcome>,
}

impl Notes {
    /// Notes one number.
    fn hold(
        &mut self,
        way: &SchemeSetting,
        setting: impl Into<String>,
        law: &'static str,
        found: f64,
        bound: f64,
    ) {
        self.outcomes.push(CaseOutcome {
            case: self.case,
            setting: setting.into(),
            scheme: way.scheme,
            law,
            found,
            bound,
        });
    }

    /// Follows a rock, twice, and holds what must hold of every journey: it does not fail, its end is finite and the same
    /// bits both times, its energy does not rise.
    fn follow(
        &mut self,
        way: &SchemeSetting,
        setting: &str,
        setup: &Setup,
        terrain: &Terrain,
    ) -> Trajectory {
        self.follow_captured(way, setting, setup, terrain, None)
    }

    /// The same with a capture speed (m/s).
    fn follow_captured(
        &mut self,
        way: &SchemeSetting,
        setting: &str,
        setup: &Setup,
        terrain: &Terrain,
        capture_speed_m_s: Option<f64>,
    ) -> Trajectory {
        let step: Settings = settings(way.scheme, way.fineness, capture_speed_m_s);
        let journey = setup.follow(terrain, &step, &mut self.scratch);
        let again = setup.follow(terrain, &step, &mut Scratch::default());
        let failed = matches!(journey.stop, Stop::Failed(_)) || !is_finite(&journey);
        let differs = !same_bits(&journey, &again);
        let lifted = setup.rock.mass_kg() * setup.gravity_m_s2 * setup.rock.radius_m;
        let energy = journey.released_j.abs().max(journey.extremes.total_j).max(lifted);
        self.hold(
            way,
            setting,
            "settles, finite, same bits again",
            f64::from(u8::from(failed) + u8::from(differs)),
            0.0,
        );
        self.hold(way, setting, "energy rise over energy", journey.ledger.rise_j / energy, DIGITS);
        journey
    }
}

fn is_finite(journey: &Trajectory) -> bool {
    let end = &journey.end;
    [end.position_m, end.velocity_m_s, end.spin_rad_s]
        .iter()
        .all(|v| v.iter().all(|x| x.is_finite()))
}

fn same_bits(a: &Trajectory, b: &Trajectory) -> bool {
    let bits = |journey: &Trajectory| {
        let end = &journey.end;
        [end.position_m, end.velocity_m_s, end.spin_rad_s].map(|v| v.map(f64::to_bits))
    };
    bits(a) == bits(b)
}

/// Runs every case with every scheme, on all threads; `done` hears of each. What is found is in the order of the cases.
pub fn study(done: impl Fn(&str) + Sync) -> Vec<CaseOutcome> {
    let found: Vec<Vec<CaseOutcome>> = TRIALS
        .par_iter()
        .with_max_len(1)
        .map(|&(case, trial)| {
            let mut notes = Notes { case, ..Notes::default() };
            for way in &WAYS {
                trial(way, &mut notes);
            }
            done(case);
            notes.outcomes
        })
        .collect();
    found.concat()
}

/// Whether the ground answers with springs.
fn sprung(way: &SchemeSetting) -> bool {
    way.scheme.has_springs()
}
