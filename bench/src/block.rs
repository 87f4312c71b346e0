//! Rocks with a shape on the made slope.

use crate::speed::slope::{GROUND, ROCK, SEED, Slope};
use clap::ValueEnum;
use nalgebra::{Quaternion, UnitQuaternion};
use rockfall::body::{
    Block, Core, Shape, ShapeKind, Solid, Surface, box_surface, eota, prism_surface, sphere_points,
};
use rockfall::ground::{Ground, Scar, SlipFriction};
use rockfall::random::{Purpose, stream, unit};
use rockfall::release::DrawnShape;
use rockfall::rock::Vec3;
use rockfall::simulation::{RecordOptions, RunSettings, Scratch, Trajectory, simulate_block};
use std::f64::consts::PI;

/// Radius of the corners over that of the sphere of equal volume (–).
const CORNER_RADIUS: f64 = 0.1;
/// Corners of the stone.
const STONE_CORNERS: u32 = 48;

/// A shape of the bench.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BenchShape {
    /// EOTA's test block of equal sides, 24 corners
    Eota111,
    /// The same half as thick
    Eota221,
    /// A box 1 : 0.7 : 0.4
    Box,
    /// A hexagonal prism
    Prism,
    /// An ellipsoid 1 : 0.8 : 0.55, met at 42 points
    Ellipsoid,
    /// A stone of 48 corners, 1 : 0.75 : 0.6
    Stone,
}

impl BenchShape {
    /// Its kind and shape, corners rounded at a tenth of the radius.
    ///
    /// # Panics
    /// If it is none, which would be a mistake here.
    pub fn made(self) -> (ShapeKind, Shape) {
        let (kind, solid, corners) = match self {
            Self::Eota111 => of(ShapeKind::Eota111, eota([1.0; 3])),
            Self::Eota221 => of(ShapeKind::Eota221, eota([1.0, 1.0, 0.5])),
            Self::Box => of(ShapeKind::Box, box_surface([1.0, 0.7, 0.4])),
            Self::Prism => of(ShapeKind::Prism, prism_surface(6, 0.7)),
            Self::Stone => of(ShapeKind::Mesh, stone()),
            Self::Ellipsoid => {
                let half = [1.0, 0.8, 0.55];
                let stretch = Vec3::from(half);
                let points = sphere_points().iter().map(|p| p.component_mul(&stretch)).collect();
                (ShapeKind::Ellipsoid, Solid::ellipsoid(half), points)
            }
        };
        (kind, Shape::of(&solid, &corners, CORNER_RADIUS).expect("a made shape is a body"))
    }
}

fn of(kind: ShapeKind, surface: Surface) -> (ShapeKind, Solid, Vec<Vec3>) {
    (kind, Solid::of(&surface), surface.points)
}

/// Corners on a spiral round an ellipsoid, each a little in or out by chance.
fn stone() -> Surface {
    let mut random = stream(SEED, Purpose::Shape, 0);
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let corner = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(STONE_CORNERS);
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let out = (1.0 - z * z).sqrt();
        let rough = 0.97 + 0.03 * unit(&mut random);
        Vec3::new(out * cos, 0.75 * out * sin, 0.6 * z) * rough
    };
    let points: Vec<Vec3> = (0..STONE_CORNERS).map(corner).collect();
    let core = Core::of(&points).expect("points round an ellipsoid span a body");
    let fan = |corners: &[u8]| {
        let corners: Vec<u32> = corners.iter().map(|k| u32::from(*k)).collect();
        (1..corners.len() - 1).map(move |k| [corners[0], corners[k], corners[k + 1]])
    };
    let triangles = core.faces.iter().flat_map(|face| fan(&face.corners)).collect();
    Surface { points: core.corners, triangles }
}

/// The ground of the bench for blocks: their shape rolls, no law does. Soft soil is a meadow.
pub fn ground(is_soft: bool) -> Ground {
    // a corner of 0.05 m must not sink in by a third of its radius at 50 m/s
    let (normal_stiffness_n_m, shear_stiffness_n_m) = (2e10, 5e9);
    let hard =
        Ground { rolling_friction: 0.0, normal_stiffness_n_m, shear_stiffness_n_m, ..GROUND };
    let soil = Ground {
        slip_friction: Some(SlipFriction { most: 1.3, kappa_per_m: 0.7, beta_per_s: 20.0 }),
        scar: Some(Scar { strength_kn_m2: 15e3, drag: 2.5, soil_density_kg_m3: 1700.0 }),
        restitution_half_m_s: Some(9.0),
        ..hard
    };
    if is_soft { soil } else { hard }
}

/// Follows release number `index` as a block, turned at random, the ball around it 0.5 m above the ground.
pub fn fall(
    slope: &Slope,
    course: &RunSettings,
    (kind, shape, ground): (ShapeKind, &Shape, Ground),
    index: usize,
    scratch: &mut Scratch,
) -> Trajectory {
    let mut release = slope.release(index);
    let block = Block::new(shape, &ROCK);
    release.motion.position_m.z += block.bound_m - ROCK.radius_m;
    release.grounds = vec![ground];
    let mut random = stream(SEED, Purpose::Shape, index + 1);
    let turn: [f64; 4] = std::array::from_fn(|_| unit(&mut random) - 0.5);
    let attitude = UnitQuaternion::from_quaternion(Quaternion::from(turn)).to_rotation_matrix();
    let drawn = DrawnShape { kind, sides: [1.0; 2], block, attitude };
    let random = stream(SEED, Purpose::Impacts, index);
    let keep = RecordOptions { path_step_s: None, impacts: false };
    let fallen = simulate_block(course, (&release, &drawn), keep, random, scratch);
    Trajectory { index, ..fallen }
}
