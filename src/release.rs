//! Rock number i: drawn from the scene, the seed and i, and put on the terrain.

use crate::chance::{Distribution, Purpose, stream, unit};
use crate::error::{Error, Result};
use crate::flight::{Landing, Parabola, leap};
use crate::ground::Ground;
use crate::rock::{Motion, Rock, Vec3};
use crate::scene::{Area, Corner, GroundTable, Point, Polyline, Scene, Zones};
use crate::terrain::Terrain;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Triangle;
use std::path::PathBuf;

/// How deep a rock may sit in the ground at its release, over its radius (–): coordinates are typed with
/// six or seven digits, and so deep a spring holds no energy worth naming.
const TYPED_DEPTH: f64 = 1e-6;

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

/// Where rocks are released, in map coordinates.
#[derive(Debug, Clone, PartialEq)]
pub enum Where {
    /// At these points, one after the other and again from the first.
    Points(Vec<Point>),
    /// Uniform along a line.
    Line(Polyline),
    /// Uniform over an area.
    Area(Area),
    /// Over zones, each with its share.
    Zones(Zones),
}

/// All releases of a scene; draws any of them, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct Releases {
    file: PathBuf,
    seed: u64,
    gravity_m_s2: f64,
    place: Where,
    height_m: Option<Distribution>,
    velocity_m_s: [Distribution; 3],
    spin_rad_s: [Distribution; 3],
    radius_m: Distribution,
    density_kg_m3: f64,
    grounds: Vec<GroundTable>,
}

impl Releases {
    /// Takes what a release needs from the scene and looks whether the corners of its place lie on the
    /// terrain, and whether the first rock from each point is clear of it.
    ///
    /// # Errors
    /// A point or corner of the place with no ground below, or a rock that starts in ground or tree, with its
    /// coordinates.
    pub fn compile(scene: &Scene, terrain: &Terrain) -> Result<Self> {
        let asked = &scene.release;
        let place = match (&asked.points_m, &asked.line_m, &asked.polygon_m, &asked.zone_list) {
            (Some(points), None, None, None) => Where::Points(points.clone()),
            (None, Some(line), None, None) => Where::Line(line.clone()),
            (None, None, Some(area), None) => Where::Area(area.clone()),
            (None, None, None, Some(zones)) => Where::Zones(zones.clone()),
            _ => {
                let remedy = "write exactly one of points_m, line_m, polygon_m and zones";
                return Err(Error::input(
                    &scene.file,
                    "[release]",
                    "found none or several",
                    remedy,
                ));
            }
        };
        let releases = Self {
            file: scene.file.clone(),
            seed: scene.seed,
            gravity_m_s2: scene.gravity_m_s2,
            place,
            height_m: asked.height_m.clone(),
            velocity_m_s: asked.velocity_m_s.clone(),
            spin_rad_s: asked.spin_rad_s.clone(),
            radius_m: scene.rocks.radius_m.clone(),
            density_kg_m3: scene.rocks.density_kg_m3,
            grounds: scene.grounds.values().cloned().collect(),
        };
        for (who, corner) in releases.place.corners_m() {
            releases.ground_m(terrain, corner, &format!("[release] {who}"))?;
        }
        if let Where::Points(points) = &releases.place {
            for index in 0..points.len().min(asked.count) {
                releases.release(terrain, index)?;
            }
        }
        Ok(releases)
    }

    /// Where rocks are released.
    pub fn place(&self) -> &Where {
        &self.place
    }

    /// The zone from which release `index` starts, by its place in [`Zones::list`]; none where the scene has no zones.
    pub fn zone_of(&self, index: usize) -> Option<usize> {
        let Where::Zones(zones) = &self.place else { return None };
        let mut chance = stream(self.seed, Purpose::Place, index);
        // the place within the zone is drawn first
        let [.., which] = [0; 4].map(|_| unit(&mut chance));
        Some(zones.pick(which))
    }

    /// Draws release `index`: the same alone, resumed, or among a million.
    ///
    /// # Errors
    /// No ground below the point drawn, or a rock that starts inside ground or tree, with index and
    /// coordinates.
    pub fn release(&self, terrain: &Terrain, index: usize) -> Result<Release> {
        let grounds = self.draw_grounds(index);
        let rock = Rock {
            radius_m: self.radius_m.draw(&mut stream(self.seed, Purpose::Size, index)),
            density_kg_m3: self.density_kg_m3,
        };
        let mut chance = stream(self.seed, Purpose::Start, index);
        let mut vector = |from: &[Distribution; 3]| {
            let [x, y, z] = from;
            Vec3::new(x.draw(&mut chance), y.draw(&mut chance), z.draw(&mut chance))
        };
        let (velocity_m_s, spin_rad_s) = (vector(&self.velocity_m_s), vector(&self.spin_rad_s));
        let position_m = self.draw_centre(terrain, rock.radius_m, index)?;
        let motion = Motion { time_s: 0.0, position_m, velocity_m_s, spin_rad_s };
        let release = Release { rock, motion, grounds };
        self.check_clear(terrain, index, &release)?;
        Ok(release)
    }

    /// The centre of a rock (m, local).
    fn draw_centre(&self, terrain: &Terrain, radius_m: f64, index: usize) -> Result<Vec3> {
        let mut chance = stream(self.seed, Purpose::Place, index);
        let even = [0; 3].map(|_| unit(&mut chance));
        let (at_m, fixed_m) = match &self.place {
            Where::Points(points) => {
                let point = &points[index % points.len()];
                (point.at_m, point.height_m)
            }
            Where::Line(line) => (line.at(even[0]), None),
            Where::Area(area) => (area.at(even), None),
            Where::Zones(zones) => (zones.list()[zones.pick(unit(&mut chance))].at(even), None),
        };
        let ground_m = self.ground_m(terrain, at_m, &release_name(index))?;
        let gap_m = self.height_m.as_ref().map_or(0.0, |height| height.draw(&mut chance));
        let height_m = fixed_m.map(|z| z - terrain.origin_m.z);
        let [x, y] = local(terrain, at_m);
        Ok(match height_m {
            Some(z) => Vec3::new(x, y, z),
            None => clear_of(terrain, Vec3::new(x, y, ground_m + gap_m + radius_m), radius_m),
        })
    }

    /// Height of the ground at a place of the map (m, local).
    fn ground_m(&self, terrain: &Terrain, at_m: Corner, who: &str) -> Result<f64> {
        let [x, y] = local(terrain, at_m);
        terrain.ground_below(x, y).ok_or_else(|| {
            let found = format!("found no terrain at ({}, {})", at_m[0], at_m[1]);
            Error::input(&self.file, who, found, outside(terrain))
        })
    }

    /// Refuses a rock that starts deeper in ground or tree than its weight would press it.
    fn check_clear(&self, terrain: &Terrain, index: usize, release: &Release) -> Result<()> {
        let Release { rock, motion: Motion { position_m: centre, .. }, grounds } = release;
        let stiffness = grounds.iter().map(|ground| ground.normal_stiffness_n_m);
        let pressed_m =
            rock.mass_kg() * self.gravity_m_s2 / stiffness.fold(f64::INFINITY, f64::min);
        let depth_m = rock.radius_m - distance_m(terrain, centre, rock.radius_m);
        let buried = terrain.ground_under(centre.x, centre.y, centre.z).is_none();
        if depth_m <= 2.0 * pressed_m + TYPED_DEPTH * rock.radius_m && !buried {
            return Ok(());
        }
        let [x, y, z]: [f64; 3] = (centre + terrain.origin_m).into();
        let who = format!("{} at ({x}, {y}, {z})", release_name(index));
        let found = if buried {
            "found its centre under the terrain".to_owned()
        } else {
            format!("found it {depth_m:.2e} m deep in the ground or a tree")
        };
        let remedy = format!(
            "write a higher place, or another: a rock of radius {} m needs its centre that far from every triangle",
            rock.radius_m
        );
        Err(Error::input(&self.file, who, found, remedy))
    }

    fn draw_grounds(&self, index: usize) -> Vec<Ground> {
        let mut chance = stream(self.seed, Purpose::Grounds, index);
        let mut draw = |from: &Distribution| from.draw(&mut chance);
        let draw_ground = |table: &GroundTable| Ground {
            normal_stiffness_n_m: draw(&table.normal_stiffness_n_m),
            shear_stiffness_n_m: draw(&table.shear_stiffness_n_m),
            friction_angle_rad: draw(&table.friction_angle_deg).to_radians(),
            restitution: table.restitution.as_ref().map(&mut draw),
            rolling_friction: table.rolling_friction.as_ref().map_or(0.0, &mut draw),
            roughness_rad: table.roughness_deg.as_ref().map_or(0.0, &mut draw).to_radians(),
        };
        self.grounds.iter().map(draw_ground).collect()
    }
}

impl Where {
    /// Its points or corners in plan view (m), map coordinates, each with the scene's key and entry that it stands in.
    fn corners_m(&self) -> Vec<(String, Corner)> {
        let numbered = |key: &str, corners: &mut dyn Iterator<Item = Corner>| {
            let named = |(number, corner)| (format!("{key}, entry {number}"), corner);
            (1..).zip(corners).map(named).collect()
        };
        match self {
            Self::Points(points) => {
                numbered("points_m", &mut points.iter().map(|point| point.at_m))
            }
            Self::Line(line) => numbered("line_m", &mut line.corners_m().iter().copied()),
            Self::Area(area) => numbered("polygon_m", &mut area.corners_m().iter().copied()),
            Self::Zones(zones) => {
                let each = zones.list().iter().flat_map(|zone| {
                    let who = format!("zones, feature {}", zone.feature);
                    zone.corners_m().into_iter().map(move |corner| (who.clone(), corner))
                });
                each.collect()
            }
        }
    }
}

fn release_name(index: usize) -> String {
    format!("release {index}")
}

/// Plan-view position in the terrain's own coordinates (m).
fn local(terrain: &Terrain, [x, y]: Corner) -> Corner {
    [x - terrain.origin_m.x, y - terrain.origin_m.y]
}

/// What to write instead of a place outside: the box of the terrain on the map.
pub(crate) fn outside(terrain: &Terrain) -> String {
    let (low, high) = terrain.index.bounds();
    let (low, high) = (low + terrain.origin_m, high + terrain.origin_m);
    format!(
        "write map coordinates on the slope; its box is {}..{} east, {}..{} north",
        low.x, high.x, low.y, high.y
    )
}

/// A rock over steep ground may be in it although its lowest point is clear: then it is lifted, straight up, until it
/// just touches. The place itself where it is clear already, or where no such height is near.
fn clear_of(terrain: &Terrain, centre: Vec3, radius_m: f64) -> Vec3 {
    if distance_m(terrain, &centre, radius_m) >= radius_m {
        return centre;
    }
    let start = centre + Vec3::z() * (LIFT * radius_m);
    let down = Parabola { start, velocity: -Vec3::z(), gravity: 0.0, radius: radius_m };
    match leap(terrain, &down, LIFT * radius_m, &mut 0) {
        Landing::Touch(way_m) if way_m > 0.0 => start - Vec3::z() * way_m,
        _ => centre,
    }
}

/// A rock in steep ground is lifted by up to this many radii (–): enough for slopes up to 80°.
const LIFT: f64 = 6.0;

/// Distance from a point to the nearest triangle (m), or `reach_m` when none is nearer.
fn distance_m(terrain: &Terrain, point: &Vec3, reach_m: f64) -> f64 {
    let mut nearest = reach_m;
    terrain.index.near(point, reach_m, |start, count| {
        for triangle in start..start + count {
            let [a, b, c] = terrain.corners_m(triangle).map(Into::into);
            let distance = Triangle::new(a, b, c).distance_to_local_point((*point).into(), true);
            nearest = nearest.min(distance);
        }
    });
    nearest
}
