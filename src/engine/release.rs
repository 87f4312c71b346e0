//! Release number i: drawn from the scene, the seed and i, and placed on the terrain.

mod clearance;
mod shapes;
mod sources;
mod trial;

use crate::error::{Error, Result};
use crate::frequency::Frequency;
use crate::ground::Ground;
use crate::random::{Distribution, Purpose, RandomStream, stream, unit};
use crate::rock::{Motion, Rock, Vec3};
use crate::scene::{Area, Corner, GroundTable, Polyline, ReleasePoint, Scene, SourceTable, Zones};
use crate::terrain::Terrain;
use clearance::{is_in_slope, lifted_clear};
use shapes::Shapes;
pub use shapes::{DrawnShape, check_shapes};
use std::path::PathBuf;

/// Depth to which a rock may sit in the ground at its release, over its radius (–): coordinates are
/// typed with six or seven digits, and a spring so deep stores no energy of note.
pub(crate) const TYPED_DEPTH: f64 = 1e-6;

/// Places drawn for one release on a line or in an area before it is given up: if a tenth of the
/// zone is usable, that happens to one release in 40 000.
const MAX_PLACE_DRAWS: usize = 100;
/// Meshes narrower than this in plan view (m) are walls or dust, not ground.
pub(crate) const NO_WIDTH_M: f64 = 1e-3;
/// Why a release cannot be made.
const NO_GROUND: &str = "no ground below";
/// Why a release cannot be made.
const IN_GROUND: &str = "in the ground or a tree";

/// One release, drawn: a pure function of scene, seed and index.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// The rock.
    pub rock: Rock,
    /// Its motion at time 0 (local coordinates).
    pub motion: Motion,
    /// Ground values, in the order of the scene's grounds.
    pub grounds: Vec<Ground>,
}

/// A release that cannot be made: the rock, and where it was to start (NaN for what is unknown).
#[derive(Debug)]
pub struct FailedRelease {
    /// The rock.
    pub rock: Rock,
    /// Its intended start (local coordinates).
    pub start: Motion,
    /// The reason, in few words.
    pub reason: &'static str,
    /// The error message.
    error: Error,
}

/// The place where rocks are released, in map coordinates.
#[derive(Debug, Clone, PartialEq)]
pub enum ReleasePlace {
    /// At these points in turn, repeatedly.
    Points(Vec<ReleasePoint>),
    /// Uniform along a line.
    Line(Polyline),
    /// Uniform over an area.
    Area(Area),
    /// Over zones, each with its share.
    Zones(Zones),
}

/// The outcome of drawing places for one release.
struct PlacementAttempt {
    release: std::result::Result<Release, Box<FailedRelease>>,
    /// Number of places drawn.
    drawn: usize,
    /// Number of those on ground so steep that no height is clear of it.
    steep: usize,
    /// Height by which it was lifted off steep ground (m).
    lift_m: f64,
}

/// All releases of a scene; draws any of them, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct Releases {
    file: PathBuf,
    seed: u64,
    gravity_m_s2: f64,
    /// One place, or one for each source; zones that are sources are one place.
    places: Vec<ReleasePlace>,
    zones_are_sources: bool,
    height_m: Option<Distribution>,
    velocity_m_s: [Distribution; 3],
    spin_rad_s: [Distribution; 3],
    radius_m: Distribution,
    frequency: Option<Frequency>,
    /// Radii of a table's blocks, used in turn with their places (m); empty if radii are drawn.
    radii_m: Vec<f64>,
    density_kg_m3: f64,
    grounds: Vec<GroundTable>,
    shapes: Shapes,
}

impl Releases {
    /// Takes what a release needs from the scene. Checks whether the corners of its place lie on
    /// the terrain, and whether the first rock from each point is clear of it.
    ///
    /// # Errors
    /// A point or corner of the place without ground below, or a rock that starts in ground or
    /// tree, with its coordinates.
    pub fn compile(scene: &Scene, terrain: &Terrain) -> Result<Self> {
        let table = &scene.release;
        let sources = scene.frequency.as_ref().map_or(&[][..], |frequency| &frequency.sources[..]);
        let places = if !table.blocks.is_empty() {
            vec![ReleasePlace::Points(table.blocks.iter().map(ReleasePoint::of_block).collect())]
        } else if sources.is_empty() {
            vec![Self::place_of_scene(scene)?]
        } else {
            let of_source = |source: &SourceTable| {
                ReleasePlace::one_of((&source.points_m, &source.line_m, &source.polygon_m))
            };
            sources.iter().filter_map(of_source).collect()
        };
        let releases = Self {
            file: scene.file.clone(),
            seed: scene.seed,
            gravity_m_s2: scene.gravity_m_s2,
            places,
            zones_are_sources: scene.has_zone_sources(),
            height_m: table.height_m.clone(),
            velocity_m_s: table.velocity_m_s.clone(),
            spin_rad_s: table.spin_rad_s.clone(),
            radius_m: scene.rocks.radius_m().clone(),
            frequency: scene.sources(),
            radii_m: table.blocks.iter().map_while(|block| block.radius_m).collect(),
            density_kg_m3: scene.rocks.density_kg_m3,
            grounds: scene.grounds.values().cloned().collect(),
            shapes: Shapes::compile(scene)?,
        };
        releases.check_ground(terrain)?;
        for index in 0..releases.fixed_cycle().min(table.count) {
            releases.release(terrain, index)?;
        }
        Ok(releases)
    }

    /// Density of the rocks (kg/m³).
    pub fn density_kg_m3(&self) -> f64 {
        self.density_kg_m3
    }

    /// The zone from which release `index` starts, by its position in [`Zones::list`]; `None` if
    /// the scene has no zones.
    pub fn zone_of(&self, index: usize) -> Option<usize> {
        self.draw_zone(&mut stream(self.seed, Purpose::Place, index), index)
    }

    /// Draws the zone of a release, the first number of its stream: an unusable place is drawn
    /// again in the same zone, so that every zone keeps its share. A zone that is a source has its
    /// own releases.
    fn draw_zone(&self, random: &mut RandomStream, index: usize) -> Option<usize> {
        let ReleasePlace::Zones(zones) = self.place_of(index).0 else { return None };
        let drawn = zones.pick(unit(random));
        let source = self.frequency.as_ref().filter(|_| self.zones_are_sources);
        Some(source.map_or(drawn, |frequency| frequency.stratum(index).source))
    }

    /// Checks for ground below a point, or beside a centre given with its height. Corners of lines
    /// and areas may lie over a hole.
    fn check_corner(
        &self,
        terrain: &Terrain,
        (place, entry): (&ReleasePlace, usize),
        at_m: Corner,
        who: &str,
    ) -> Result<()> {
        let [x, y] = local(terrain, at_m);
        let (low, high) = terrain.index.bounds();
        let is_inside = (low.x..=high.x).contains(&x) && (low.y..=high.y).contains(&y);
        let height_m = match place {
            ReleasePlace::Points(points) => points[entry].height_m,
            _ if is_inside => return Ok(()),
            _ => None,
        };
        let Some(z) = height_m else { return self.ground_m(terrain, at_m, who).map(|_| ()) };
        let radius_m = self.around_m(entry, &self.release_without_place(entry).rock);
        self.check_held(terrain, (Vec3::new(x, y, z - terrain.origin_m.z), radius_m), at_m, who)
    }

    /// Draws release `index`: the same alone, resumed, or among a million.
    ///
    /// # Errors
    /// No ground below the point drawn, or a rock that starts inside ground or tree, with index and
    /// coordinates.
    pub fn release(&self, terrain: &Terrain, index: usize) -> Result<Release> {
        self.try_release(terrain, index).map_err(|lost| lost.error)
    }

    /// The same, or what is known of a rock for which no place to start is found.
    ///
    /// # Errors
    /// As [`Self::release`].
    pub fn try_release(
        &self,
        terrain: &Terrain,
        index: usize,
    ) -> std::result::Result<Release, Box<FailedRelease>> {
        self.place_rock(terrain, index).release
    }

    /// Draws a rock and a place for it. On a line or in an area a place without ground, or without
    /// room for the rock, is drawn again: rocks are released uniformly over the usable part.
    fn place_rock(&self, terrain: &Terrain, index: usize) -> PlacementAttempt {
        let mut release = self.release_without_place(index);
        let mut random = stream(self.seed, Purpose::Place, index);
        let is_fixed = matches!(self.place_of(index).0, ReleasePlace::Points(_));
        let draws = if is_fixed { 1 } else { MAX_PLACE_DRAWS };
        let zone = self.draw_zone(&mut random, index).unwrap_or_default();
        let around_m = self.around_m(index, &release.rock);
        let (mut lost, mut steep) = (None, 0);
        for drawn in 1..=draws {
            let at_m = self.draw_place(&mut random, (index, zone));
            let failure = match self.centre(terrain, (at_m, around_m), &mut random, index) {
                Ok((centre, lift_m)) => {
                    release.motion.position_m = centre;
                    match self.check_clear(terrain, (index, around_m), &release) {
                        Ok(()) => {
                            return PlacementAttempt { release: Ok(release), drawn, steep, lift_m };
                        }
                        Err(error) => {
                            steep += usize::from(is_in_slope(terrain, &centre, around_m));
                            (IN_GROUND, error)
                        }
                    }
                }
                Err(error) => {
                    let [x, y] = local(terrain, at_m.0);
                    release.motion.position_m = Vec3::new(x, y, f64::NAN);
                    (NO_GROUND, error)
                }
            };
            let (rock, start) = (release.rock, release.motion);
            lost.get_or_insert(Box::new(FailedRelease {
                rock,
                start,
                reason: failure.0,
                error: failure.1,
            }));
        }
        // at least one place was drawn
        PlacementAttempt {
            release: lost.map_or(Ok(release), Err),
            drawn: draws,
            steep,
            lift_m: 0.0,
        }
    }

    /// A release without its place.
    fn release_without_place(&self, index: usize) -> Release {
        let grounds = self.draw_grounds(index);
        let rock = Rock { radius_m: self.draw_radius_m(index), density_kg_m3: self.density_kg_m3 };
        let mut random = stream(self.seed, Purpose::Start, index);
        let mut vector = |from: &[Distribution; 3]| {
            let [x, y, z] = from;
            Vec3::new(x.draw(&mut random), y.draw(&mut random), z.draw(&mut random))
        };
        let (velocity_m_s, spin_rad_s) = (vector(&self.velocity_m_s), vector(&self.spin_rad_s));
        let motion = Motion { time_s: 0.0, position_m: Vec3::zeros(), velocity_m_s, spin_rad_s };
        Release { rock, motion, grounds }
    }

    /// A place on the map, in a zone if there are zones, and the height of the rock's centre if it
    /// is given.
    fn draw_place(&self, random: &mut RandomStream, of: (usize, usize)) -> (Corner, Option<f64>) {
        let (index, zone) = of;
        let even = [0; 3].map(|_| unit(random));
        let (place, turn) = self.place_of(index);
        match place {
            ReleasePlace::Points(points) => {
                let point = &points[turn % points.len()];
                (point.at_m, point.height_m)
            }
            ReleasePlace::Line(line) => (line.at(even[0]), None),
            ReleasePlace::Area(area) => (area.at(even), None),
            ReleasePlace::Zones(zones) => (zones.list()[zone].at(even), None),
        }
    }

    /// The centre of a rock over a place (m, local), and the height by which it is lifted off steep
    /// ground (m).
    fn centre(
        &self,
        terrain: &Terrain,
        ((at_m, fixed_m), radius_m): ((Corner, Option<f64>), f64),
        random: &mut RandomStream,
        index: usize,
    ) -> Result<(Vec3, f64)> {
        let [x, y] = local(terrain, at_m);
        if let Some(z) = fixed_m.map(|z| z - terrain.origin_m.z) {
            let centre = Vec3::new(x, y, z);
            self.check_held(terrain, (centre, radius_m), at_m, &release_name(index))?;
            return Ok((centre, 0.0));
        }
        let ground_m = self.ground_m(terrain, at_m, &release_name(index))?;
        let gap_m = self.height_m.as_ref().map_or(0.0, |height| height.draw(random));
        let unlifted = Vec3::new(x, y, ground_m + gap_m + radius_m);
        let centre = lifted_clear(terrain, unlifted, radius_m);
        Ok((centre, centre.z - unlifted.z))
    }

    /// Checks a centre given with its height: it may be beyond the edge of the terrain if the rock
    /// touches the terrain.
    fn check_held(
        &self,
        terrain: &Terrain,
        (centre, radius_m): (Vec3, f64),
        at_m: Corner,
        who: &str,
    ) -> Result<()> {
        let reach_m = radius_m * (1.0 + TYPED_DEPTH);
        if terrain.distance_m(&centre, reach_m) < reach_m {
            return Ok(());
        }
        self.ground_m(terrain, at_m, who).map(|_| ())
    }

    /// Height of the ground at a place of the map (m, local).
    fn ground_m(&self, terrain: &Terrain, at_m: Corner, who: &str) -> Result<f64> {
        let [x, y] = local(terrain, at_m);
        terrain.ground_below(x, y).ok_or_else(|| {
            let found = format!("found no terrain at ({}, {})", at_m[0], at_m[1]);
            Error::input(&self.file, who, found, outside(terrain))
        })
    }

    fn draw_grounds(&self, index: usize) -> Vec<Ground> {
        let mut random = stream(self.seed, Purpose::Grounds, index);
        // How a block rolls depends on its shape, which it keeps: the same quantile on every
        // ground.
        let mut character = None;
        let draw_ground = |table: &GroundTable| {
            let normal_stiffness_n_m = table.normal_stiffness_n_m.draw(&mut random);
            Ground {
                normal_stiffness_n_m,
                shear_stiffness_n_m: table
                    .shear_n_m(normal_stiffness_n_m, |value| value.draw(&mut random)),
                friction_angle_rad: table.friction_angle_deg.draw(&mut random).to_radians(),
                restitution: table.restitution.as_ref().map(|e| e.draw(&mut random)),
                rolling_friction: table.rolling_friction.as_ref().map_or(0.0, |rolling| {
                    let drawn = unit(&mut random);
                    rolling.quantile(*character.get_or_insert(drawn))
                }),
                roughness_rad: table
                    .roughness_deg
                    .as_ref()
                    .map_or(0.0, |angle| angle.draw(&mut random))
                    .to_radians(),
                roughness_length_m: table.roughness_length_m.as_ref().map(|l| l.draw(&mut random)),
                slip_friction: table.slip_friction,
                scar: table.scar,
                restitution_half_m_s: table
                    .restitution_half_speed_m_s
                    .as_ref()
                    .map(|speed| speed.draw(&mut random)),
            }
        };
        self.grounds.iter().map(draw_ground).collect()
    }
}

fn release_name(index: usize) -> String {
    format!("release {index}")
}

/// Plan-view position in the terrain's own coordinates (m).
fn local(terrain: &Terrain, [x, y]: Corner) -> Corner {
    [x - terrain.origin_m.x, y - terrain.origin_m.y]
}

/// Remedy for a place outside the terrain: its bounding box on the map.
pub(crate) fn outside(terrain: &Terrain) -> String {
    let (low, high) = terrain.index.bounds();
    let narrowest_m = (high.x - low.x).min(high.y - low.y);
    if narrowest_m < NO_WIDTH_M {
        return format!(
            "the meshes cover no ground in plan view (their box is {:.3e} x {:.3e} m): add a slope below, or look at up and scale",
            high.x - low.x,
            high.y - low.y
        );
    }
    let (low, high) = (low + terrain.origin_m, high + terrain.origin_m);
    format!(
        "write map coordinates on the slope; its box is {}..{} east, {}..{} north",
        low.x, high.x, low.y, high.y
    )
}
