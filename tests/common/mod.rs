//! One rock on a made mesh, computed through the library's own journey.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "every test file uses another part"
)]

pub mod episode;
pub mod together;
pub mod zoo;

use rockfall::ground::Ground;
use rockfall::plan::{Plan, RestRule};
use rockfall::random::{Purpose, stream};
use rockfall::release::Release;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::scene::Scene;
use rockfall::simulation::{
    RecordOptions, RunSettings, Scratch, Trajectory, simulate, simulate_release,
};
use rockfall::solver::{Scheme, Settings};
use rockfall::terrain::stl::{Facet, Soup};
use rockfall::terrain::weld::{Piece, Up, weld};
use rockfall::terrain::{Sheet, Terrain};
use std::path::Path;

/// Gravity of the exact cases (m/s²), as in the paper's Table 1.
pub const G: f64 = 9.8;

/// The plan of a scene with this text whose meshes lie in a directory.
pub fn plan_in(dir: &Path, text: &str) -> Plan {
    let scene = Scene::parse(text, &dir.join("scene.toml")).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    Plan::compile(&scene, terrain).unwrap()
}

/// All releases of a plan.
pub fn falls(plan: &Plan) -> Vec<Trajectory> {
    let mut scratch = Scratch::default();
    (0..plan.count)
        .map(|index| simulate_release(plan, index, None, &mut scratch).unwrap())
        .collect()
}

/// So many cells of a size (m) each way around the origin, uneven by `uneven_m`: the number of a cell, and its two triangles.
pub fn uneven_cells(
    cells: i32,
    cell_m: f64,
    uneven_m: f64,
) -> impl Iterator<Item = ([i32; 2], [Facet; 2])> {
    let corner = move |i: i32, j: i32| {
        let (x, y, half) = (f64::from(i), f64::from(j), f64::from(cells / 2));
        let z = uneven_m * (0.7 * x * x + 1.3 * y * y + 0.9 * x * y).sin();
        Vec3::new(cell_m * (x - half), cell_m * (y - half), z)
    };
    (0..cells * cells).map(move |k| {
        let (i, j) = (k / cells, k % cells);
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        ([i, j], [[a, b, c], [a, c, d]])
    })
}

/// A terrain of one sheet, without recentring noise: the facets' own coordinates are local when their box is
/// centred on whole metres.
pub fn terrain(facets: Vec<Facet>) -> Terrain {
    terrain_of_files(vec![facets], Some(1e-9))
}

/// A terrain of sheets from a file each; without a tolerance with that of a scene that has none.
pub fn terrain_of_files(files: Vec<Vec<Facet>>, tolerance_m: Option<f64>) -> Terrain {
    let soups: Vec<Soup> = files.into_iter().map(Soup::from).collect();
    let piece =
        |(sheet, soup)| Piece { file: Path::new("made"), soup, up: Up::Z, scale: 1.0, sheet };
    let pieces: Vec<Piece> = (0..).zip(&soups).map(piece).collect();
    let welded = weld(&pieces, Vec3::zeros(), tolerance_m).unwrap();
    let sheet = |_| Sheet { path: "made".into(), ground: 0, is_tree: false };
    Terrain::new(welded, pieces.iter().map(sheet).collect())
}

/// The rock of the exact cases: R = 0.5 m, 2700 kg/m³.
pub const ROCK: Rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };

/// The ground of the exact cases: Table 1 with restitution 0.5.
pub const GROUND: Ground = Ground::smooth([1e9, 0.25e9], std::f64::consts::FRAC_PI_6, Some(0.5));

/// A case: one rock on one ground.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    pub scheme: Scheme,
    pub tolerance_m_s: f64,
    pub step_s: f64,
    pub shear_memory: bool,
    pub impact_kernels: bool,
    pub ground: Ground,
    /// Of sheets with ground 1.
    pub other: Option<Ground>,
    pub rock: Rock,
    pub capture_speed_m_s: Option<f64>,
    pub rest_time_s: f64,
    pub path_step_s: Option<f64>,
}

pub const CASE: Case = Case {
    scheme: Scheme::Adaptive,
    tolerance_m_s: 1e-3,
    step_s: 1e-5,
    shear_memory: true,
    impact_kernels: true,
    ground: GROUND,
    other: None,
    rock: ROCK,
    capture_speed_m_s: None,
    rest_time_s: 0.3,
    path_step_s: None,
};

impl Case {
    /// Follows the rock from map position `c` with velocity `v` and spin `w` for at most `longest_s`; ends in map
    /// coordinates.
    pub fn run(&self, terrain: &Terrain, start: [[f64; 3]; 3], longest_s: f64) -> Trajectory {
        self.run_with(terrain, start, longest_s, 1)
    }

    /// The same with another stream of chance.
    pub fn run_with(
        &self,
        terrain: &Terrain,
        [c, v, w]: [[f64; 3]; 3],
        longest_s: f64,
        seed: u64,
    ) -> Trajectory {
        let step = Settings {
            scheme: self.scheme,
            tolerance_m_s: self.tolerance_m_s,
            step_s: self.step_s,
            shear_memory: self.shear_memory,
            impact_kernels: self.impact_kernels,
            rigid_heaps: true,
            corner_way: rockfall::solver::CORNER_WAY,
            capture_speed_m_s: self.capture_speed_m_s,
        };
        let course = RunSettings {
            terrain,
            gravity_m_s2: G,
            step: &step,
            rest: RestRule { speed_m_s: 0.02, time_s: self.rest_time_s },
            longest_s,
            recorders: rockfall::plan::Recorders::default(),
            seed: 1,
        };
        let motion = Motion {
            time_s: 0.0,
            position_m: Vec3::from(c) - terrain.origin_m,
            velocity_m_s: v.into(),
            spin_rad_s: w.into(),
        };
        let grounds = [self.ground].into_iter().chain(self.other).collect();
        let release = Release { rock: self.rock, motion, grounds };
        let random = stream(seed, Purpose::Impacts, 0);
        let keep = RecordOptions { path_step_s: self.path_step_s, impacts: true };
        let mut fallen = simulate(&course, &release, keep, random, &mut Scratch::default());
        fallen.start.position_m += terrain.origin_m;
        fallen.end.position_m += terrain.origin_m;
        fallen
    }
}

/// One way to compute, and how near it must come to the exact answer.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub name: &'static str,
    pub case: Case,
    /// Whether the ground answers with springs; the rigid scheme has their limit.
    pub springs: bool,
    /// Relative error allowed where an impact decides.
    pub impact: f64,
    /// Relative error allowed where the rock slides or rolls all the time.
    pub smooth: f64,
    /// Relative error allowed where it pivots over an edge, begins to slip and lifts off.
    pub edge: f64,
}

/// Every scheme. A new one needs one row: all exact cases then run over it by themselves.
///
/// The local error allowed is a speed; over an impact of 5 m/s the errors of its dozen steps add up to some ten times
/// that, of which `impact` is the share. In smooth motion the error of a step is far below the one allowed, because the
/// first step after a change must resolve the springs. The rigid scheme follows impacts
/// to 1e-5 of their speed a step, which leaves a tenth of that at most; where sliding turns
/// to rolling within a step it errs by up to `a dt²/8`.
pub const ROWS: [Row; 5] = [
    Row {
        name: "adaptive 1e-2",
        case: Case { tolerance_m_s: 1e-2, ..CASE },
        springs: true,
        impact: 2e-2,
        smooth: 2e-4,
        edge: 1e-2,
    },
    Row {
        name: "adaptive 1e-4",
        case: Case { tolerance_m_s: 1e-4, ..CASE },
        springs: true,
        impact: 1e-3,
        smooth: 1e-5,
        edge: 3e-4,
    },
    Row {
        name: "reference",
        case: Case { scheme: Scheme::Reference, tolerance_m_s: 1e-8, ..CASE },
        springs: true,
        impact: 1e-6,
        smooth: 1e-7,
        edge: 1e-6,
    },
    Row {
        name: "rigid 10 ms",
        case: Case { scheme: Scheme::Rigid, step_s: 1e-2, ..CASE },
        springs: false,
        impact: 2e-6,
        smooth: 1e-5,
        edge: 1e-2,
    },
    Row {
        name: "rigid 0.1 ms",
        case: Case { scheme: Scheme::Rigid, step_s: 1e-4, ..CASE },
        springs: false,
        impact: 2e-6,
        smooth: 1e-8,
        edge: 1e-6,
    },
];

/// Compares one number with the exact one, relative to `scale`; prints the line of the table of exact cases.
#[track_caller]
pub fn hold(row: &Row, what: &str, [ours, exact, scale]: [f64; 3], allowed: f64) {
    let error = (ours - exact).abs() / scale.abs();
    let verdict = if error <= allowed { "" } else { "  <-- too far" };
    println!("{:14} | {what:40} | {exact:>20.13} | {ours:>20.13} | {error:.1e}{verdict}", row.name);
    assert!(error <= allowed, "{} {what}: {ours} for {exact}, error {error:e}", row.name);
}
