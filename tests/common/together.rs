//! Spheres that share one world.

use super::{CASE, GROUND, terrain};
use rockfall::contact::pair::BondStrength;
use rockfall::ground::Ground;
use rockfall::plan::{MapGrid, Recorders, RestRule};
use rockfall::release::Release;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::simulation::{
    Observer, PairMaterial, RecordOptions, RunSettings, Stop, Trajectory, WorldStats,
    simulate_world,
};
use rockfall::solver::{Scheme, Settings};
use rockfall::terrain::Terrain;
use rockfall::terrain::make::jittered_plane;
use std::sync::atomic::AtomicBool;

/// Spheres in one world.
#[derive(Clone, Copy)]
pub struct World {
    pub scheme: Scheme,
    pub tolerance_m_s: f64,
    pub gravity_m_s2: f64,
    pub restitution: f64,
    /// Normal stiffness of the rocks among themselves (N/m), shear a quarter of it.
    pub stiffness_n_m: f64,
    pub friction_angle_rad: f64,
    pub step_s: f64,
    /// Whether heaps go on in the rigid limit (`adaptive`).
    pub rigid_heaps: bool,
    pub ground: Ground,
    pub rest_time_s: f64,
    pub strength: BondStrength,
    /// How many grounds there are, all alike.
    pub grounds: usize,
}

pub const WORLD: World = World {
    scheme: Scheme::Rigid,
    tolerance_m_s: 0.0,
    gravity_m_s2: 0.0,
    restitution: 0.5,
    stiffness_n_m: GROUND.normal_stiffness_n_m,
    friction_angle_rad: std::f64::consts::FRAC_PI_6,
    step_s: 0.01,
    rigid_heaps: true,
    ground: GROUND,
    rest_time_s: 0.3,
    strength: BondStrength { tensile_pa: 0.0, cohesion_pa: 0.0 },
    grounds: 1,
};

/// A sphere: radius, density, centre, velocity, spin.
pub type Sphere = (f64, f64, [f64; 3], [f64; 3], [f64; 3]);

/// A map of all that the rocks may reach: no cell holds more energy than the rock ever had.
const CELLS: MapGrid =
    MapGrid { west_m: -50.0, south_m: -50.0, cell_m: 0.25, columns: 400, rows: 400 };

impl World {
    pub fn run(
        &self,
        terrain: &Terrain,
        spheres: &[Sphere],
        longest_s: f64,
    ) -> (Vec<Trajectory>, WorldStats) {
        let step = Settings {
            scheme: self.scheme,
            tolerance_m_s: self.tolerance_m_s,
            step_s: self.step_s,
            shear_memory: true,
            impact_kernels: true,
            rigid_heaps: self.rigid_heaps,
            corner_way: rockfall::solver::CORNER_WAY,
            capture_speed_m_s: CASE.capture_speed_m_s,
        };
        let course = RunSettings {
            terrain,
            gravity_m_s2: self.gravity_m_s2,
            step: &step,
            rest: RestRule { speed_m_s: 0.02, time_s: self.rest_time_s },
            longest_s,
            recorders: Recorders { cells: Some(&CELLS), ..Recorders::default() },
            seed: 1,
        };
        let release = |&(radius_m, density_kg_m3, c, v, w): &Sphere| Release {
            rock: Rock { radius_m, density_kg_m3 },
            motion: Motion {
                time_s: 0.0,
                position_m: Vec3::from(c) - terrain.origin_m,
                velocity_m_s: v.into(),
                spin_rad_s: w.into(),
            },
            grounds: vec![self.ground; self.grounds],
        };
        let releases: Vec<Release> = spheres.iter().map(release).collect();
        let ground = Ground {
            normal_stiffness_n_m: self.stiffness_n_m,
            shear_stiffness_n_m: 0.25 * self.stiffness_n_m,
            restitution: Some(self.restitution),
            friction_angle_rad: self.friction_angle_rad,
            ..GROUND
        };
        let answer = PairMaterial { ground, strength: self.strength };
        let keep = |_| RecordOptions { path_step_s: None, impacts: true };
        let never = AtomicBool::new(false);
        let (falls, census) =
            simulate_world(&course, &releases, &answer, keep, Observer::silent(&never)).unwrap();
        for fall in &falls {
            assert!(!matches!(fall.stop, Stop::Failed(_)), "{:?}", fall.stop);
            let most_j = (1.0 + 1e-9) * fall.extremes.total_j;
            for cell in &fall.passages {
                assert!(cell.total_j <= most_j, "{} J of {most_j} J in a cell", cell.total_j);
            }
        }
        (falls, census)
    }
}

impl World {
    pub fn falls(&self, terrain: &Terrain, spheres: &[Sphere], longest_s: f64) -> Vec<Trajectory> {
        self.run(terrain, spheres, longest_s).0
    }
}

pub fn plane() -> Terrain {
    terrain(jittered_plane(40.0, 8, 0.0))
}

pub fn energy_j(falls: &[Trajectory], at_end: bool, g: f64) -> f64 {
    let energy = |fall: &Trajectory| {
        let motion = if at_end { fall.end } else { fall.start };
        motion.translational_j(&fall.rock)
            + motion.rotational_j(&fall.rock)
            + fall.rock.mass_kg() * g * motion.position_m.z
    };
    falls.iter().map(energy).sum()
}

/// A sheet far below and a triangle far above, whose box is 100 m wide: nothing but the other spheres is touched.
pub fn space() -> Terrain {
    let at = |x: f64, y: f64| Vec3::new(x, y, -50.0);
    let [a, b, c, d] = [at(-50.0, -50.0), at(50.0, -50.0), at(50.0, 50.0), at(-50.0, 50.0)];
    let p = Vec3::repeat(50.0);
    terrain(vec![[a, b, c], [a, c, d], [p, p + Vec3::x(), p + Vec3::y()]])
}
