//! Shape and attitude of rock number i.

use super::Releases;
use crate::body::{
    BadSurface, Block, Shape, ShapeKind, Solid, Surface, box_surface, eota, prism_surface,
    sphere_points,
};
use crate::error::{Error, Result};
use crate::math;
use crate::random::{Distribution, Purpose, RandomStream, stream, unit};
use crate::rock::{Rock, Vec3};
use crate::scene::{CORNERS, Orientation, Scene, ShapeTable};
use crate::terrain::facets::Facets;
use crate::terrain::stl;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

/// A rock's shape, drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnShape {
    /// What it is made from.
    pub kind: ShapeKind,
    /// Second and third side over the first (–); 1 for a scan.
    pub sides: [f64; 2],
    /// The block.
    pub block: Block,
    /// How it is turned at release, from its principal frame to the world.
    pub attitude: Rotation3<f64>,
}

/// A shape of the scene, with its share of the rocks.
#[derive(Debug, Clone, PartialEq)]
struct ShapeShare {
    table: ShapeTable,
    /// The shape, if nothing of it is drawn.
    made: Option<Shape>,
}

/// Refuses shapes that cannot be made.
///
/// # Errors
/// A scan that cannot be read or is not closed, corners too round for a shape.
pub fn check_shapes(scene: &Scene) -> Result<()> {
    Shapes::compile(scene).map(drop)
}

/// The shapes of a scene; empty for spheres alone.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Shapes {
    entries: Vec<ShapeShare>,
    /// The shapes among which rocks draw, with cumulative weights (–): those of no block, then
    /// block by block.
    weighted: Vec<Vec<(f64, usize)>>,
    /// For each row of the release table, its entry in `weighted`; empty without a table.
    of_row: Vec<usize>,
    /// A fixed attitude; `None` if it is drawn.
    attitude: Option<Rotation3<f64>>,
    /// Lines of the plan, one for each shape.
    pub(super) lines: Vec<String>,
}

impl Shapes {
    /// Reads scans and makes every shape once.
    ///
    /// # Errors
    /// A scan that cannot be read or is not closed, corners too round for a shape.
    pub(super) fn compile(scene: &Scene) -> Result<Self> {
        let mut shapes = Self { attitude: fixed_attitude(scene), ..Self::default() };
        if !scene.has_blocks() {
            return Ok(shapes);
        }
        for (index, table) in scene.rocks.shapes.iter().enumerate() {
            let refuse = |why: BadSurface| refused(scene, (index, table), &why);
            let (made, line) = prepared(table)?.map_err(refuse)?;
            shapes.lines.push(line);
            shapes.entries.push(ShapeShare { table: table.clone(), made });
        }
        shapes.group_by_block(scene);
        Ok(shapes)
    }

    /// Sets the shapes among which each row of the release table draws: those of its block, or
    /// those of none.
    fn group_by_block(&mut self, scene: &Scene) {
        let tables = &scene.rocks.shapes;
        let mut names: Vec<Option<&String>> = vec![None];
        let place = |names: &[Option<&String>], block: Option<&String>| {
            names.iter().position(|name| *name == block)
        };
        for table in tables {
            if place(&names, table.block.as_ref()).is_none() {
                names.push(table.block.as_ref());
            }
        }
        let options = |name: Option<&String>| {
            let own = tables.iter().enumerate().filter(|(_, table)| table.block.as_ref() == name);
            let summed = own.scan(0.0, |sum, (index, table)| {
                *sum += table.weight.unwrap_or(1.0);
                Some((*sum, index))
            });
            summed.collect()
        };
        self.weighted = names.iter().copied().map(options).collect();
        let rows = scene.release.blocks.iter();
        self.of_row = rows.map(|row| place(&names, row.block.as_ref()).unwrap_or(0)).collect();
    }

    /// Whether some rocks are not spheres.
    pub(super) fn has_blocks(&self) -> bool {
        !self.entries.is_empty()
    }

    /// The block of release `index`, the `turn`-th from its place, with the size of its rock;
    /// `None` for a sphere.
    pub(super) fn draw(&self, seed: u64, of: (usize, usize), rock: &Rock) -> Option<DrawnShape> {
        let (entry, drawn, mut random) = self.pick(seed, of)?;
        let attitude = self.attitude.unwrap_or_else(|| random_attitude(&mut random));
        let (sides, made) = entry.shape(drawn)?;
        let block = Block::new(&made, rock);
        let sides = [sides[1] / sides[0], sides[2] / sides[0]];
        Some(DrawnShape { kind: entry.table.kind, sides, block, attitude })
    }

    /// The entry of release `index`, the `turn`-th from its place, the numbers that determine its
    /// sides, and the rest of the random stream; `None` for a sphere.
    fn pick(
        &self,
        seed: u64,
        (index, turn): (usize, usize),
    ) -> Option<(&ShapeShare, [f64; 4], RandomStream)> {
        let row = turn.checked_rem(self.of_row.len()).map_or(0, |row| self.of_row[row]);
        let options = self.weighted.get(row)?;
        let all = options.last()?.0;
        let mut random = stream(seed, Purpose::Shape, index);
        let pick = all * unit(&mut random);
        let entry = &self.entries[options[options.partition_point(|(sum, _)| *sum <= pick)].1];
        let drawn = [0; 4].map(|_| unit(&mut random));
        (entry.table.kind != ShapeKind::Sphere).then_some((entry, drawn, random))
    }
}

impl ShapeShare {
    /// The sides and the shape for these random numbers.
    fn shape(&self, drawn: [f64; 4]) -> Option<([f64; 3], Shape)> {
        let mut next = drawn.into_iter();
        let quantile = |axis: &Distribution| axis.quantile(next.next().unwrap_or(0.5));
        let sides = sides_of(&self.table, quantile);
        let shape = match &self.made {
            Some(shape) => shape.clone(),
            // Checked at the ends of what can be drawn; between them nothing is rounder. With x the
            // logarithms of the sides, the logarithm of a face's distance over the radius of equal
            // volume, −½ ln Σ nᵢ² e^(−2xᵢ) − ⅓ Σ xᵢ, is concave, so it is least at an end.
            None => shape_of_sides(&self.table, sides).ok()?,
        };
        Some((sides, shape))
    }
}

impl Releases {
    /// The shape of release `index`, with the size of its rock, and its attitude; `None` for a
    /// sphere.
    pub fn block(&self, index: usize, rock: &Rock) -> Option<DrawnShape> {
        self.shapes.draw(self.seed, (index, self.place_of(index).1), rock)
    }

    /// The shape of release `index` without its size; `None` for a sphere.
    pub fn shape(&self, index: usize) -> Option<Shape> {
        let (entry, drawn, _) = self.shapes.pick(self.seed, (index, self.place_of(index).1))?;
        entry.shape(drawn).map(|(_, shape)| shape)
    }

    /// Whether some rocks have shapes.
    pub fn has_blocks(&self) -> bool {
        self.shapes.has_blocks()
    }

    /// Whether some grounds have a scar layer.
    pub fn has_scars(&self) -> bool {
        self.grounds.iter().any(|ground| ground.scar.is_some())
    }

    /// The plan's line on each shape; empty for spheres alone.
    pub fn shapes(&self) -> &[String] {
        &self.shapes.lines
    }

    /// Radius of the bounding ball of a rock (m), which must be clear where it starts, whatever its
    /// attitude.
    pub(super) fn around_m(&self, index: usize, rock: &Rock) -> f64 {
        self.block(index, rock).map_or(rock.radius_m, |drawn| drawn.block.bound_m)
    }
}

/// Uniform over all rotations, from three numbers (Shoemake 1992).
fn random_attitude(random: &mut RandomStream) -> Rotation3<f64> {
    let [a, b, c] = [0; 3].map(|_| unit(random));
    let ((sin_b, cos_b), (sin_c, cos_c)) = (math::sin_cos(TAU * b), math::sin_cos(TAU * c));
    let (less, more) = ((1.0 - a).sqrt(), a.sqrt());
    attitude_of([more * cos_c, less * sin_b, less * cos_b, more * sin_c])
}

/// The rotation of a quaternion w, x, y, z of any length.
fn attitude_of([w, x, y, z]: [f64; 4]) -> Rotation3<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).to_rotation_matrix()
}

fn fixed_attitude(scene: &Scene) -> Option<Rotation3<f64>> {
    match &scene.release.orientation {
        Some(Orientation::Fixed(turn)) => Some(attitude_of(*turn)),
        _ => None,
    }
}

/// The three sides of a shape; `value` selects those that are distributions.
fn sides_of(table: &ShapeTable, mut value: impl FnMut(&Distribution) -> f64) -> [f64; 3] {
    match (table.kind, &table.axes, &table.ratio) {
        (_, Some(axes), _) if axes.len() == 3 => [0, 1, 2].map(|k| value(&axes[k])),
        (_, _, Some(ratio)) => [1.0, 1.0, value(ratio)],
        (ShapeKind::Eota221, ..) => [1.0, 1.0, 0.5],
        _ => [1.0; 3],
    }
}

/// The shape of a table that is not a scan.
fn shape_of(
    table: &ShapeTable,
    value: impl FnMut(&Distribution) -> f64,
) -> std::result::Result<Shape, BadSurface> {
    shape_of_sides(table, sides_of(table, value))
}

fn shape_of_sides(table: &ShapeTable, sides: [f64; 3]) -> std::result::Result<Shape, BadSurface> {
    let ball = table.corner_radius.unwrap_or(0.0);
    let surface = match table.kind {
        ShapeKind::Ellipsoid => {
            let half = sides.map(|side| 0.5 * side);
            let stretch = Vec3::from(half);
            let corners: Vec<Vec3> =
                sphere_points().iter().map(|p| p.component_mul(&stretch)).collect();
            return Shape::of(&Solid::ellipsoid(half), &corners, ball);
        }
        ShapeKind::Box => box_surface(sides),
        ShapeKind::Prism => prism_surface(table.sides.unwrap_or(3), sides[2]),
        _ => eota(sides),
    };
    Shape::of(&Solid::of(&surface), &surface.points, ball)
}

/// A shape if nothing of it is drawn, and the plan's line on it.
fn prepared(
    table: &ShapeTable,
) -> Result<std::result::Result<(Option<Shape>, String), BadSurface>> {
    Ok(match table.kind {
        ShapeKind::Sphere => {
            Ok((None, format!("{}, weight {}", named(table), table.weight.unwrap_or(1.0))))
        }
        ShapeKind::Mesh => scanned_shape(table)?.map(|(shape, note)| {
            let line = described(table, &shape, &note);
            (Some(shape), line)
        }),
        _ => made_shape(table),
    })
}

fn made_shape(table: &ShapeTable) -> std::result::Result<(Option<Shape>, String), BadSurface> {
    // the extremes must be valid too, in all combinations of the sides: a drawn shape is made
    // without error handling
    for ends in 0..8_u32 {
        let mut side = 0;
        shape_of(table, |axis| {
            let (least, most) = axis.support();
            side += 1;
            if ends >> (side - 1) & 1 == 0 { least } else { most }
        })?;
    }
    let shape = shape_of(table, |axis| axis.quantile(0.5))?;
    let mut drawn = table.axes.iter().flatten().chain(&table.ratio);
    let is_drawn = drawn.any(|axis| axis.as_fixed().is_none());
    let note = if is_drawn { ", its sides drawn for each rock, of which the median" } else { "" };
    let line = described(table, &shape, note);
    Ok(((!is_drawn).then_some(shape), line))
}

/// The shape of a scan, with a note on how its hull was thinned.
fn scanned_shape(table: &ShapeTable) -> Result<std::result::Result<(Shape, String), BadSurface>> {
    let path = table.mesh.as_deref().unwrap_or(Path::new(""));
    let soup = stl::read(path)?;
    Ok(shape_of_surface(&welded(&soup.facets), table))
}

fn shape_of_surface(
    surface: &Surface,
    table: &ShapeTable,
) -> std::result::Result<(Shape, String), BadSurface> {
    surface.check_closed()?;
    let solid = Solid::of(surface);
    if solid.volume <= 0.0 {
        return Err(BadSurface::Flat);
    }
    let thinned = surface.thinned(table.corners.unwrap_or(CORNERS), 0.0)?;
    let shape = Shape::of(&solid, &thinned.corners, table.corner_radius.unwrap_or(0.0))?;
    let note = format!(
        " of {} corners of the hull of {} points; what is left out stands out by {:.4} of the radius at most",
        thinned.hull_corners,
        surface.points.len(),
        thinned.deviation_m / solid.equal_radius()
    );
    Ok((shape, note))
}

/// The facets of a file with common corners merged: those written with the same numbers.
fn welded(facets: &Facets) -> Surface {
    let mut known: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut points = Vec::new();
    let mut place = |p: Vec3| {
        // −0 and 0 are the same position
        let key = [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            points.push(p);
            points.len() as u32 - 1
        })
    };
    let triangles: Vec<[u32; 3]> = facets.iter().map(|facet| facet.map(&mut place)).collect();
    let mut surface = Surface { points, triangles };
    if Solid::of(&surface).volume < 0.0 {
        surface.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    surface
}

/// The error of a shape that cannot be made, because of its scan or of its corners.
fn refused(scene: &Scene, (index, table): (usize, &ShapeTable), why: &BadSurface) -> Error {
    let of_corners = matches!(why, BadSurface::NoCore).then_some(table.corner_radius).flatten();
    let key = if of_corners.is_some() { "corner_radius" } else { "mesh" };
    let place = format!("[[rocks.shapes]] #{} {key}", index + 1);
    let found = of_corners.map_or_else(
        || why.to_string(),
        |ball| format!("found {ball}, so round that nothing is left between the corners"),
    );
    let file = table.mesh.as_deref().filter(|_| of_corners.is_none()).unwrap_or(&scene.file);
    Error::input(file, place, found, remedy(why))
}

fn remedy(why: &BadSurface) -> &'static str {
    match why {
        BadSurface::Open(_) => "close the scan: fill its holes and join its corners",
        BadSurface::Parts(_) => "write a file for each block, and leave out what is none of it",
        BadSurface::Flat => "write a body with a volume",
        BadSurface::TooMany(_) => "write fewer corners",
        BadSurface::NoCore => "write a smaller corner_radius, or a less slender shape",
    }
}

/// A shape's kind, and its block if it has one.
fn named(table: &ShapeTable) -> String {
    let kind = table.kind.name();
    table.block.as_ref().map_or_else(|| kind.to_owned(), |block| format!("{kind} (block {block})"))
}

/// A shape's line in the plan.
fn described(table: &ShapeTable, shape: &Shape, note: &str) -> String {
    let [low, middle, high] = {
        let mut moments = shape.inertia.map(|moment| moment / 0.4);
        moments.sort_by(f64::total_cmp);
        moments
    };
    format!(
        "{}, weight {}{note}: {} corner balls of {:.3} R, {} edges, {} faces; reaches {:.3} R, moments of inertia {low:.3}, {middle:.3}, {high:.3} of the sphere's; rounding takes {:.3} R off its corners",
        named(table),
        table.weight.unwrap_or(1.0),
        shape.core.corners.len(),
        shape.ball,
        shape.core.ridges.len(),
        shape.core.faces.len(),
        shape.bound,
        shape.cut_off,
    )
}

#[cfg(test)]
mod tests;
