//! Made-up journeys: a pure function of their number, as real ones are.

#![allow(missing_docs, dead_code, unreachable_pub)]

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rockfall::hazard::{AnnualRequest, LineInfo, MapFrame};
use rockfall::output::{Identity, ReleaseZone, RunInfo, Site};
use rockfall::plan::PlanEntry;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{
    CellPassage, Crossing, Effort, Extremes, FeatureKind, Impact, Ledger, PathPoint, PathState,
    Stop, Stretch, Trajectory,
};

/// Releases that keep their path.
pub const PATHS: usize = 5;
/// Every so manieth rock fails, with no number where it ended.
pub const FAILS_EVERY: usize = 17;

pub fn info(releases: usize) -> RunInfo {
    RunInfo {
        title: "Ten rocks, \"made up\"".to_owned(),
        identity: Identity {
            scene_hash: "5ce0e".to_owned(),
            version: "0.1.0".to_owned(),
            seed: u64::MAX,
            first_release: 0,
            releases,
            of_releases: releases,
        },
        origin_m: Vec3::new(2_600_000.0, 1_200_000.0, 0.0),
        site: Site {
            mesh_origin_m: [2_600_000.0, 1_200_000.0, 0.0],
            release: ReleaseZone::Line(vec![
                [2_600_000.0, 1_200_000.0],
                [2_600_010.0, 1_200_000.0],
            ]),
            further_releases: Vec::new(),
            release_names: Vec::new(),
            fast_warnings: vec![],
            floor: None,
        },
        ground_of_sheet: vec!["rock".to_owned(), "trunk, \"old\"".to_owned()],
        lines: [("road", 40.0), ("fence, \"upper\"", 35.5)]
            .map(|(name, length_m)| LineInfo {
                name: name.to_owned(),
                length_m,
                corners_m: vec![[0.0, 0.0], [length_m, 0.0]],
                of_barrier: false,
                floor: None,
            })
            .into(),
        maps: Some(MapFrame {
            west_m: 2_600_000.0,
            south_m: 1_200_000.0,
            cell_m: 10.0,
            columns: 10,
            rows: 10,
            epsg: Some(2056),
        }),
        profile_step_m: 20.0,
        barriers: vec![],
        asked: AnnualRequest::default(),
        observed: vec![],
        observed_worth: None,
        observed_least_runout_m: None,
        keeps_paths: true,
        keeps_impacts: true,
        has_blocks: false,
        has_scars: false,
        is_shard: false,
        threads: 2,
        plan: vec![PlanEntry {
            name: "trees".to_owned(),
            said: "left out: the scene has none".to_owned(),
        }],
        inputs: vec![("Rock density".to_owned(), "2700 kg/m³".to_owned())],
        title_block: vec![],
        sources: [String::new(), String::new()],
        language: rockfall::scene::Language::En,
        warnings: vec![],
        mesh_health: serde_json::json!({ "triangles": 2 }),
    }
}

/// Numbers that belong to one rock.
struct RandomStream(ChaCha8Rng);

impl RandomStream {
    fn number(&mut self, scale: f64) -> f64 {
        scale * self.0.random::<f64>()
    }

    fn motion(&mut self, time_s: f64) -> Motion {
        Motion {
            time_s,
            position_m: Vec3::new(self.number(100.0), self.number(100.0), self.number(50.0)),
            velocity_m_s: Vec3::new(self.number(9.0), -self.number(9.0), 0.0),
            spin_rad_s: Vec3::new(self.number(1e-300), 0.1 + 0.2, -0.0),
        }
    }

    fn path(&mut self) -> Vec<PathPoint> {
        let states = [PathState::Flight, PathState::Sliding, PathState::Sticking];
        let point = |(step, state): (usize, PathState)| PathPoint {
            motion: self.motion(step as f64 * 0.05),
            clearance_m: if step == 0 { f64::NAN } else { 0.25 },
            state,
            attitude: None,
        };
        states.into_iter().enumerate().map(point).collect()
    }

    fn impact(&mut self, index: usize) -> Impact {
        Impact {
            time_s: 1.0 / 3.0,
            point_m: self.motion(0.0).position_m,
            feature: [FeatureKind::Face, FeatureKind::Edge, FeatureKind::Vertex][index % 3],
            sheet: (index % 2) as u16,
            speed_in_m_s: self.number(30.0),
            speed_out_m_s: self.number(10.0),
            energy_lost_j: self.number(1e5),
            soil_j: 0.0,
        }
    }

    /// Every other rock crosses the second line too, and it twice.
    fn crossings(&mut self, index: usize) -> Vec<Crossing> {
        let crossing = |line: usize| Crossing {
            line,
            motion: self.motion(2.5),
            rotational_j: 1234.5,
            top_m: None,
            along_m: self.number(30.0),
            height_m: self.number(3.0),
            height_normal_m: if index == 1 { f64::NAN } else { self.number(2.0) },
            times: 1 + line as u32,
        };
        (0..=index % 2).map(crossing).collect()
    }

    fn passages(&mut self) -> Vec<CellPassage> {
        let passage = |cell: u32| CellPassage {
            cell: 5 * cell,
            total_j: self.number(1e5),
            height_m: if cell == 2 { 0.0 } else { self.number(4.0) },
        };
        (0..8).map(passage).collect()
    }

    fn extremes(&mut self) -> Extremes {
        Extremes {
            speed_m_s: self.number(30.0),
            translational_j: self.number(1e6),
            rotational_j: self.number(1e5),
            total_j: self.number(1e6),
            height_m: self.number(4.0),
        }
    }

    fn ledger(&mut self) -> Ledger {
        Ledger {
            friction_j: self.number(1e5),
            damping_j: self.number(1e5),
            remainder_j: self.number(1e-3),
            rise_j: self.number(1e-9),
            ..Ledger::default()
        }
    }
}

fn stop(index: usize) -> Stop {
    match index {
        _ if index % FAILS_EVERY == 3 => Stop::Failed("the step shrank below 1e-12 s".to_owned()),
        _ if index.is_multiple_of(5) => Stop::LeftTerrain,
        _ => Stop::AtRest,
    }
}

/// Stretches that a rock passed.
fn stretches(index: usize) -> Vec<Stretch> {
    let stretch = |number: u32| Stretch {
        number,
        speed_m_s: 1.0 + 0.1 * index as f64,
        height_m: 0.3 * f64::from(number),
    };
    (0..=index as u32 % 4).map(stretch).collect()
}

/// The journey of rock `index`.
pub fn fall(index: usize) -> Trajectory {
    let mut random = RandomStream(ChaCha8Rng::seed_from_u64(7));
    random.0.set_stream(index as u64);
    let mut fall = Trajectory {
        index,
        rock: Rock { radius_m: 0.1 + random.number(0.5), density_kg_m3: 2700.0 },
        shape: None,
        start: random.motion(0.0),
        end: random.motion(12.5),
        stop: stop(index),
        extremes: random.extremes(),
        impact_count: 1 + index as u32 % 2,
        tree_impact_count: index as u32 % 2,
        impacts: vec![random.impact(index); 1 + index % 2],
        crossings: if index.is_multiple_of(4) { vec![] } else { random.crossings(index) },
        passages: random.passages(),
        stretches: stretches(index),
        path: if index < PATHS { random.path() } else { vec![] },
        ledger: random.ledger(),
        released_j: random.number(1e6),
        effort: Effort { steps: index as u64, leaps: 3, sweeps: 9, ..Effort::default() },
    };
    if matches!(fall.stop, Stop::Failed(_)) {
        fall.end.position_m.x = f64::NAN;
        fall.ledger.remainder_j = f64::NAN;
    }
    fall
}
