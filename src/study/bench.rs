//! One rock on a made mesh, computed through the library's own journey.

use crate::body::{Block, Shape, ShapeKind, Solid, Surface, box_surface, prism_surface};
use crate::ground::Ground;
use crate::math;
use crate::plan::RestRule;
use crate::random::{Purpose, stream};
use crate::release::{DrawnShape, Release};
use crate::rock::{Motion, Rock, Vec3};
use crate::simulation::{
    RecordOptions, RunSettings, Scratch, Trajectory, simulate, simulate_block,
};
use crate::solver::{CORNER_WAY, Scheme, Settings};
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use crate::terrain::{Sheet, Terrain};
use nalgebra::Rotation3;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

/// Gravity of the cases (m/s²), as in the paper's Table 1.
pub const GRAVITY_M_S2: f64 = 9.8;

/// The rock of the cases: radius 0.5 m, 2700 kg/m³, so 1414 kg.
pub const ROCK: Rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };

/// The ground of the cases: springs and friction of the paper's Table 1, with a restitution of 0.5.
pub const GROUND: Ground = Ground::smooth([1e9, 0.25e9], std::f64::consts::FRAC_PI_6, Some(0.5));

/// A ground on springs of a normal stiffness (N/m), along the surface a quarter of it, as in the paper's Table 1.
pub fn with_springs(ground: Ground, normal_stiffness_n_m: f64) -> Ground {
    let shear_stiffness_n_m = 0.25 * normal_stiffness_n_m;
    Ground { normal_stiffness_n_m, shear_stiffness_n_m, ..ground }
}

/// Corners closer than this are one (m): made meshes repeat theirs to rounding.
const WELD_M: f64 = 1e-9;

/// The surface of a block, its sides in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BlockForm {
    /// A box along the axes.
    Box([f64; 3]),
    /// A regular prism of so many sides that lies on one of them, its axis along y; radius of the circle through its
    /// corners, as long as that circle is wide.
    Prism(u32, f64),
}

/// A block in the place of the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MadeBlock {
    /// Its surface.
    pub form: BlockForm,
    /// Radius of the balls at its corners (m).
    pub ball_m: f64,
    /// How it is turned at the start.
    pub attitude: Rotation3<f64>,
}

impl BlockForm {
    fn surface(&self) -> Surface {
        match *self {
            Self::Box(sides_m) => box_surface(sides_m),
            Self::Prism(sides, radius_m) => {
                let mut surface = prism_surface(sides, 1.0);
                let on_a_side = math::turn(&Vec3::y_axis(), FRAC_PI_2 - PI / f64::from(sides))
                    * math::turn(&Vec3::x_axis(), -FRAC_PI_2);
                for p in &mut surface.points {
                    *p = on_a_side * (*p * radius_m);
                }
                surface
            }
        }
    }

    /// The rock of this size, as dense as that of the cases.
    pub fn rock(&self) -> Rock {
        Rock { radius_m: Solid::of(&self.surface()).equal_radius(), ..ROCK }
    }
}

impl MadeBlock {
    /// The block of a rock, as a release has it.
    ///
    /// # Panics
    /// If its balls fill it: cases have blocks that are bodies.
    pub fn drawn(&self, rock: &Rock) -> DrawnShape {
        let (surface, kind) = (
            self.form.surface(),
            match self.form {
                BlockForm::Box(_) => ShapeKind::Box,
                BlockForm::Prism(..) => ShapeKind::Prism,
            },
        );
        let solid = Solid::of(&surface);
        let shape = Shape::of(&solid, &surface.points, self.ball_m / solid.equal_radius());
        let block = Block::new(&shape.expect("the blocks of cases are bodies"), rock);
        DrawnShape { kind, sides: [1.0; 2], block, attitude: self.attitude }
    }
}

/// What one rock is, where it starts and how long it is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The rock.
    pub rock: Rock,
    /// Its shape; none for a sphere.
    pub block: Option<MadeBlock>,
    /// The ground everywhere.
    pub ground: Ground,
    /// Centre at the start (m), in the coordinates of the facets.
    pub centre_m: Vec3,
    /// Velocity at the start (m/s).
    pub velocity_m_s: Vec3,
    /// Spin at the start (rad/s).
    pub spin_rad_s: Vec3,
    /// Gravity (m/s²), 0 or more.
    pub gravity_m_s2: f64,
    /// How long the rock is followed (s).
    pub longest_s: f64,
    /// Time below the rest speed of 0.02 m/s after which it counts as at rest (s).
    pub rest_time_s: f64,
    /// Time between the points of a kept path (s); `None` keeps none.
    pub path_step_s: Option<f64>,
}

/// The usual rock and ground, at rest in the origin, followed for a second, never taken to be at rest.
pub const SETUP: Setup = Setup {
    rock: ROCK,
    block: None,
    ground: GROUND,
    centre_m: Vec3::new(0.0, 0.0, 0.0),
    velocity_m_s: Vec3::new(0.0, 0.0, 0.0),
    spin_rad_s: Vec3::new(0.0, 0.0, 0.0),
    gravity_m_s2: GRAVITY_M_S2,
    longest_s: 1.0,
    rest_time_s: f64::INFINITY,
    path_step_s: None,
};

impl Setup {
    /// Follows the rock; the ends are in the coordinates of the facets, impacts and path stay local.
    pub fn follow(&self, terrain: &Terrain, step: &Settings, scratch: &mut Scratch) -> Trajectory {
        let course = RunSettings {
            recorders: crate::plan::Recorders::default(),
            seed: 1,
            terrain,
            gravity_m_s2: self.gravity_m_s2,
            step,
            rest: RestRule { speed_m_s: 0.02, time_s: self.rest_time_s },
            longest_s: self.longest_s,
        };
        let motion = Motion {
            time_s: 0.0,
            position_m: self.centre_m - terrain.origin_m,
            velocity_m_s: self.velocity_m_s,
            spin_rad_s: self.spin_rad_s,
        };
        let release = Release { rock: self.rock, motion, grounds: vec![self.ground] };
        let random = stream(1, Purpose::Impacts, 0);
        let keep = RecordOptions { path_step_s: self.path_step_s, impacts: true };
        let drawn = self.block.map(|block| block.drawn(&self.rock));
        let mut fallen = match &drawn {
            Some(drawn) => simulate_block(&course, (&release, drawn), keep, random, scratch),
            None => simulate(&course, &release, keep, random, scratch),
        };
        fallen.start.position_m += terrain.origin_m;
        fallen.end.position_m += terrain.origin_m;
        fallen
    }

    /// Oscillation of the rock on one spring, `√(p_N/m)` (rad/s).
    pub fn omega(&self) -> f64 {
        (self.ground.normal_stiffness_n_m / self.rock.mass_kg()).sqrt()
    }

    /// How deep the weight presses one spring where the ground is inclined at `angle_rad` (m).
    pub fn pressed_m(&self, angle_rad: f64) -> f64 {
        self.rock.mass_kg() * self.gravity_m_s2 * math::cos(angle_rad)
            / self.ground.normal_stiffness_n_m
    }
}

/// A terrain of one sheet from facets.
///
/// # Panics
/// If nothing is left of the facets: made meshes are whole.
pub fn terrain(facets: Vec<Facet>) -> Terrain {
    let soup = Soup::from(facets);
    let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), Some(WELD_M)).expect("made meshes can be welded");
    Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }])
}

/// Settings of one scheme at one tolerance (m/s) or step (s), whichever it goes by, and the speed below which
/// impacts do not rebound (m/s).
pub fn settings(scheme: Scheme, fineness: f64, capture_speed_m_s: Option<f64>) -> Settings {
    let by_tolerance = scheme.controls_error();
    Settings {
        scheme,
        tolerance_m_s: if by_tolerance { fineness } else { 0.0 },
        step_s: if by_tolerance { f64::INFINITY } else { fineness },
        shear_memory: true,
        impact_kernels: true,
        rigid_heaps: true,
        corner_way: CORNER_WAY,
        capture_speed_m_s,
    }
}
