//! The benchmark: a natural slope, 300 m by 400 m, with rocks released near its top.

use rockfall::ground::Ground;
use rockfall::plan::{Recorders, RestRule};
use rockfall::random::{Purpose, stream, unit};
use rockfall::release::Release;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{RecordOptions, RunSettings, Scratch, Trajectory, simulate};
use rockfall::solver::{Scheme, Settings};
use rockfall::terrain::make::natural_slope;
use rockfall::terrain::stl::{Facet, Soup};
use rockfall::terrain::weld::{Piece, Up, weld};
use rockfall::terrain::{Sheet, Terrain};
use std::path::Path;
use std::time::Instant;

/// The rock: radius 0.5 m, 1414 kg.
pub const ROCK: Rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
/// The ground: springs of the paper's Table 1, friction 35°, restitution 0.4, rolling friction 0.5.
pub const GROUND: Ground = Ground {
    rolling_friction: 0.5,
    ..Ground::smooth([1e9, 0.25e9], 35.0 * std::f64::consts::PI / 180.0, Some(0.4))
};
/// Gravity (m/s²).
pub const GRAVITY_M_S2: f64 = 9.8;
/// Simulated time after which a rock is out of time (s).
const LONGEST_S: f64 = 120.0;
/// Where chance starts.
pub const SEED: u64 = 7;
/// West and south end of the release area (m, in the coordinates of the facets), 20 m by 10 m.
pub const AREA_M: [f64; 2] = [140.0, 10.0];
/// Its size (m).
pub const AREA_SIZE_M: [f64; 2] = [20.0, 10.0];
/// Centres start this far above the ground (m): a gap of 1 m.
const ABOVE_M: f64 = 1.5;

/// Every scheme as a plan fills it in.
pub const SCHEMES: [(Scheme, f64); 4] = [
    (Scheme::Adaptive, 0.05),
    (Scheme::Rigid, 0.01),
    (Scheme::Reference, 1e-8),
    (Scheme::Dda, 1e-5),
];

/// The facets with nearly so many triangles, in square cells.
pub fn facets(triangles: usize) -> Vec<Facet> {
    let across = (triangles as f64 * 3.0 / 8.0).sqrt().floor().max(1.0) as usize;
    natural_slope(across, across * 4 / 3 + 1).facets
}

/// The slope, ready for rocks, and what it took to make it so.
#[derive(Debug)]
pub struct Slope {
    /// The slope.
    pub terrain: Terrain,
    /// What it is covered with.
    pub ground: Ground,
    /// Time to weld its facets (s).
    pub weld_s: f64,
    /// Time to index it and to find what can be touched (s).
    pub index_s: f64,
}

impl Slope {
    /// The slope with nearly so many triangles.
    ///
    /// # Panics
    /// If a made mesh cannot be welded, which would be a mistake of the maker.
    pub fn of(triangles: usize) -> Self {
        let soup = Soup::from(facets(triangles));
        let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
        let begun = Instant::now();
        let welded = weld(&[piece], Vec3::zeros(), None).expect("a made mesh is whole");
        let weld_s = begun.elapsed().as_secs_f64();
        drop(soup);
        let begun = Instant::now();
        let sheets = vec![Sheet { path: "made".into(), ground: 0, is_tree: false }];
        let terrain = Terrain::new(welded, sheets);
        let index_s = begun.elapsed().as_secs_f64();
        Self { terrain, ground: GROUND, weld_s, index_s }
    }

    /// Release number `index`: anywhere in the area, 1 m above the ground, at rest.
    ///
    /// # Panics
    /// If there is no ground, which would be a mistake of the maker.
    pub fn release(&self, index: usize) -> Release {
        let mut place = stream(SEED, Purpose::Place, index);
        let [x, y] = [0, 1].map(|k| AREA_M[k] + AREA_SIZE_M[k] * unit(&mut place));
        let (x, y) = (x - self.terrain.origin_m.x, y - self.terrain.origin_m.y);
        let ground_m = self.terrain.ground_below(x, y).expect("the slope lies below its releases");
        let motion = Motion {
            time_s: 0.0,
            position_m: Vec3::new(x, y, ground_m + ABOVE_M),
            velocity_m_s: Vec3::zeros(),
            spin_rad_s: Vec3::zeros(),
        };
        Release { rock: ROCK, motion, grounds: vec![self.ground] }
    }

    /// What all rocks have in common.
    pub fn course<'a>(&'a self, step: &'a Settings) -> RunSettings<'a> {
        RunSettings {
            terrain: &self.terrain,
            gravity_m_s2: GRAVITY_M_S2,
            step,
            rest: RestRule { speed_m_s: 0.02, time_s: 0.3 },
            longest_s: LONGEST_S,
            recorders: Recorders::default(),
            seed: 1,
        }
    }

    /// Follows release number `index`; neither path nor impacts are kept.
    pub fn fall(&self, step: &Settings, index: usize, scratch: &mut Scratch) -> Trajectory {
        let release = self.release(index);
        let random = stream(SEED, Purpose::Impacts, index);
        let keep = RecordOptions { path_step_s: None, impacts: false };
        let fallen = simulate(&self.course(step), &release, keep, random, scratch);
        Trajectory { index, ..fallen }
    }
}
