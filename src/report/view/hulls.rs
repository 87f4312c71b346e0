//! What blocks look like: their rounded hulls with edges and corners cut flat, in radii of the sphere of equal volume.

use super::pack::Section;
use crate::body::{Shape, Surface};
use crate::rock::Vec3;
use nalgebra::{Quaternion, UnitQuaternion};
use serde_json::json;

/// Steps of the coordinates in a radius: 0.03 mm on a block of half a metre.
const STEPS_PER_RADIUS: f64 = 16_384.0;
/// The step of the centre: three bytes reach 512 radii to either side, farther than the most slender of blocks.
const CENTRE: u32 = 1 << 23;

/// The hull of one shape.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockHull {
    /// Corners in steps, in the frame of the principal axes.
    vertices: Vec<[u32; 3]>,
    /// Triangles, turned outwards.
    triangles: Vec<[u32; 3]>,
    /// Principal moments of inertia over `m R²` (–).
    inertia: [f64; 3],
}

/// The hulls of all blocks whose paths are shown, each once.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BlockHulls {
    pub(super) hulls: Vec<BlockHull>,
    /// Releases in order, each with the number of its hull.
    of: Vec<(usize, usize)>,
}

impl BlockHull {
    /// The hull of a shape.
    pub fn of(shape: &Shape) -> Self {
        let Surface { points, triangles } = shape.cut_surface();
        let step = |x: f64| (f64::from(CENTRE) + x * STEPS_PER_RADIUS).round() as u32;
        let vertices = points.iter().map(|p| [p.x, p.y, p.z].map(step)).collect();
        Self { vertices, triangles, inertia: shape.inertia }
    }

    /// Its surface in radii of the sphere of equal volume.
    pub fn surface(&self) -> Surface {
        let place = |step: u32| (f64::from(step) - f64::from(CENTRE)) / STEPS_PER_RADIUS;
        let points = self.vertices.iter().map(|steps| Vec3::from(steps.map(place))).collect();
        Surface { points, triangles: self.triangles.clone() }
    }

    /// Rotational energy over `m R²` (1/s²): `Σ Iᵢ ωᵢ²/2` in the frame of the block.
    pub(super) fn rotational(&self, attitude: [f64; 4], spin_rad_s: [f64; 3]) -> f64 {
        let own = unit(attitude).inverse_transform_vector(&Vec3::from(spin_rad_s));
        (0..3).map(|axis| 0.5 * self.inertia[axis] * own[axis] * own[axis]).sum()
    }
}

/// The turn of a quaternion w, x, y, z.
pub(super) fn unit([w, x, y, z]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

impl BlockHulls {
    /// Adds the hull of a release behind those before it.
    pub(super) fn add(&mut self, release: usize, hull: BlockHull) {
        let known = self.hulls.iter().position(|known| *known == hull);
        let number = known.unwrap_or_else(|| {
            self.hulls.push(hull);
            self.hulls.len() - 1
        });
        self.of.push((release, number));
    }

    /// Number of the hull of a release; none for a sphere.
    pub(super) fn number(&self, release: usize) -> Option<usize> {
        let at = self.of.binary_search_by_key(&release, |(release, _)| *release).ok()?;
        Some(self.of[at].1)
    }

    /// The hull of a release; none for a sphere.
    pub fn hull(&self, release: usize) -> Option<&BlockHull> {
        self.number(release).map(|number| &self.hulls[number])
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.of.is_empty()
    }

    /// Those of several pages as one.
    pub(super) fn joined(pages: &[Self]) -> Self {
        let each = |page: &Self| page.of.clone().into_iter();
        let mut all: Vec<(usize, BlockHull)> = Vec::new();
        for page in pages {
            all.extend(each(page).map(|(release, number)| (release, page.hulls[number].clone())));
        }
        all.sort_by_key(|(release, _)| *release);
        all.dedup_by_key(|(release, _)| *release);
        let mut joined = Self::default();
        for (release, hull) in all {
            joined.add(release, hull);
        }
        joined
    }

    /// Packed as text.
    pub(super) fn text(&self) -> String {
        let inertia: Vec<_> = self.hulls.iter().map(|hull| hull.inertia).collect();
        let mut section = Section::new(json!({
            "steps_per_radius": STEPS_PER_RADIUS, "centre": CENTRE, "inertia": inertia
        }));
        let each = |of: fn(&BlockHull) -> usize| self.hulls.iter().map(|h| of(h) as u32).collect();
        section.add("release", 1, 1, self.of.iter().map(|(release, _)| *release as u32).collect());
        section.add("hull", 1, 0, self.of.iter().map(|(_, number)| *number as u32).collect());
        section.add("vertices", 1, 0, each(|hull| hull.vertices.len()));
        section.add("triangles", 1, 0, each(|hull| hull.triangles.len()));
        let vertices = self.hulls.iter().flat_map(|hull| hull.vertices.as_flattened());
        section.add("vertex", 3, 0, vertices.copied().collect());
        let corners = self.hulls.iter().flat_map(|hull| hull.triangles.as_flattened());
        section.add("corner", 3, 0, corners.copied().collect());
        section.text()
    }

    /// Reads [`Self::text`] back; none when it is none.
    pub fn read(text: &str) -> Option<Self> {
        let section = Section::read(text)?;
        let inertia: Vec<[f64; 3]> =
            serde_json::from_value(section.facts["inertia"].clone()).ok()?;
        let (mut vertices, _) = section.numbers("vertex").as_chunks::<3>();
        let (mut triangles, _) = section.numbers("corner").as_chunks::<3>();
        let counts = section.numbers("vertices").iter().zip(section.numbers("triangles"));
        let mut hulls = Vec::new();
        for (inertia, (&points, &faces)) in inertia.into_iter().zip(counts) {
            let (own, rest) = vertices.split_at_checked(points as usize)?;
            let (turns, others) = triangles.split_at_checked(faces as usize)?;
            if turns.as_flattened().iter().any(|corner| *corner >= points) {
                return None;
            }
            (vertices, triangles) = (rest, others);
            hulls.push(BlockHull { vertices: own.to_vec(), triangles: turns.to_vec(), inertia });
        }
        let numbers = section.numbers("hull").iter().map(|number| *number as usize);
        let releases = section.numbers("release").iter().map(|release| *release as usize);
        let of: Vec<(usize, usize)> = releases.zip(numbers).collect();
        of.iter().all(|(_, number)| *number < hulls.len()).then_some(Self { hulls, of })
    }
}
