//! `[[rocks.shapes]]`, `[release] orientation`, and what goes with blocks.

use super::Scene;
use super::blocks::BlockRow;
use super::check::{Allowed, Checked, Complaint, drawn, number, optional, suggest};
use crate::body::{MIN_CORNER_RADIUS, ShapeKind, max_corners};
use crate::count::number_of;
use crate::error::{Error, Result};
use crate::random::Distribution;
use serde::Deserialize;
use std::path::PathBuf;

/// One shape of the rocks.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with kind and corner_radius")]
pub struct ShapeTable {
    /// What it is made from.
    pub kind: ShapeKind,
    /// Radius of the balls at the corners over `radius_m` (–), [`MIN_CORNER_RADIUS`] to 0.5; not of a sphere.
    pub corner_radius: Option<f64>,
    /// The block of the release table that has this shape, by its name there; absent = all that have none of their own.
    pub block: Option<String>,
    /// How often it is drawn relative to the others (–), positive; absent = 1.
    pub weight: Option<f64>,
    /// Sides of a box, diameters of an ellipsoid, in any unit: only their ratios count.
    pub axes: Option<Vec<Distribution>>,
    /// Corners of the polygon of a prism, 3 to 32.
    pub sides: Option<u32>,
    /// Height of a prism over the diameter of the circle through its corners (–), positive.
    pub ratio: Option<Distribution>,
    /// STL file of a closed surface, in any unit; once a scene is read, as seen from the working directory.
    pub mesh: Option<PathBuf>,
    /// Most corners that are kept of the mesh's hull, 6 to 64; absent = 32.
    pub corners: Option<usize>,
}

/// How rocks with a shape are turned at release.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    untagged,
    expecting = "found neither \"random\" nor four numbers; write orientation = \"random\" or a quaternion [w, x, y, z]"
)]
pub enum Orientation {
    /// Uniform over all turns.
    Random(RandomWord),
    /// From the shape's own frame to the world, as a quaternion w, x, y, z of any length but 0.
    Fixed([f64; 4]),
}

/// The word `random`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RandomWord {
    /// The only one.
    Random,
}

/// What `corner_radius` may be.
pub(super) const CORNER_RADIUS: Allowed = Allowed::Between(MIN_CORNER_RADIUS, 0.5);

/// Corners kept of a scan where the scene does not say.
pub const CORNERS: usize = 32;

/// Keys that only some shapes have.
const OWN: [(&str, &[ShapeKind]); 5] = [
    ("axes", &[ShapeKind::Box, ShapeKind::Ellipsoid]),
    ("sides", &[ShapeKind::Prism]),
    ("ratio", &[ShapeKind::Prism]),
    ("mesh", &[ShapeKind::Mesh]),
    ("corners", &[ShapeKind::Mesh]),
];

impl ShapeTable {
    pub(super) fn check(&self) -> Checked {
        let given = [
            self.axes.is_some(),
            self.sides.is_some(),
            self.ratio.is_some(),
            self.mesh.is_some(),
            self.corners.is_some(),
        ];
        for ((key, kinds), given) in OWN.into_iter().zip(given) {
            let belongs = kinds.contains(&self.kind);
            if given && !belongs {
                let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
                let remedy = format!("remove it: only {} has it", names.join(" and "));
                return Err(Complaint::about(key, remedy));
            }
            if belongs && !given && key != "corners" {
                let remedy = format!("write it: kind = \"{}\" needs it", self.kind.name());
                return Err(Complaint::missing(key, remedy));
            }
        }
        optional("weight", self.weight, Allowed::Positive, "")?;
        self.check_corner_radius()?;
        self.check_sizes()
    }

    fn check_corner_radius(&self) -> Checked {
        match (self.kind, self.corner_radius) {
            (ShapeKind::Sphere, None) => Ok(()),
            (ShapeKind::Sphere, Some(_)) => {
                Err(Complaint::about("corner_radius", "remove it: a sphere has no corners"))
            }
            (_, None) => {
                let remedy = "write corner_radius = 0.1 or another radius of the corners over radius_m; fresh blocks are near 0.1, worn ones near 0.3";
                Err(Complaint::missing("corner_radius", remedy))
            }
            (_, Some(value)) => {
                let hint = "sharper corners than that are not computed";
                number("corner_radius", value, CORNER_RADIUS, hint)
            }
        }
    }

    fn check_sizes(&self) -> Checked {
        if let Some(axes) = &self.axes {
            if axes.len() != 3 {
                let found = format!("found {}", number_of(axes.len() as u64, "value"));
                let about = Complaint::about("axes", "write three, as in axes = [1.0, 0.8, 0.5]");
                return Err(about.finding(found));
            }
            for axis in axes {
                drawn("axes", axis, Allowed::Between(0.01, 100.0), "")?;
            }
        }
        if let Some(ratio) = &self.ratio {
            drawn("ratio", ratio, Allowed::Between(0.05, 20.0), "")?;
        }
        if self.sides.is_some_and(|sides| !(3..=max_corners() as u32 / 2).contains(&sides)) {
            return Err(Complaint::about("sides", "write 3..32"));
        }
        if self.corners.is_some_and(|corners| !(6..=max_corners()).contains(&corners)) {
            return Err(Complaint::about("corners", "write 6..64"));
        }
        Ok(())
    }
}

impl Orientation {
    pub(super) fn check(&self) -> Checked {
        let Self::Fixed(turn) = self else { return Ok(()) };
        let size2: f64 = turn.iter().map(|x| x * x).sum();
        if size2.is_finite() && size2 > 1e-12 {
            return Ok(());
        }
        Err(Complaint::about(
            "orientation",
            "write a quaternion [w, x, y, z] of finite length, [1, 0, 0, 0] turns nothing",
        ))
    }
}

impl Scene {
    /// Whether some rocks are blocks.
    pub fn has_blocks(&self) -> bool {
        self.rocks.shapes.iter().any(|shape| shape.kind != ShapeKind::Sphere)
    }

    /// Whether some rocks are spheres.
    pub(crate) fn has_spheres(&self) -> bool {
        let shapes = &self.rocks.shapes;
        shapes.is_empty() || shapes.iter().any(|shape| shape.kind == ShapeKind::Sphere)
    }

    /// Corner radius of the sharpest blocks over `radius_m` (–); `None` where all rocks are spheres.
    pub fn sharpest(&self) -> Option<f64> {
        let blocks = self.rocks.shapes.iter().filter(|shape| shape.kind != ShapeKind::Sphere);
        blocks.filter_map(|shape| shape.corner_radius).reduce(f64::min)
    }

    /// The tables of shapes, and what cannot be had together with blocks.
    pub(super) fn check_shapes(&self) -> Checked {
        for (index, shape) in self.rocks.shapes.iter().enumerate() {
            shape
                .check()
                .and_then(|()| self.check_block(shape))
                .map_err(|wrong| wrong.in_entry(index).inside("shapes").inside("rocks"))?;
        }
        if let Some(orientation) = &self.release.orientation {
            orientation.check().map_err(|wrong| wrong.inside("release"))?;
            if !self.has_blocks() {
                let remedy =
                    "remove it, or write [[rocks.shapes]]: a sphere looks the same from every side";
                return Err(Complaint::about("orientation", remedy).inside("release"));
            }
        }
        if self.solver.corner_way.is_some() && !self.has_blocks() {
            let remedy = "remove it, or write [[rocks.shapes]]: a sphere has no corners";
            return Err(Complaint::about("corner_way", remedy).inside("solver"));
        }
        if !self.has_blocks() {
            return self.check_soil_of_worlds();
        }
        if self.release.together {
            let remedy = "remove it, or the blocks of [[rocks.shapes]]: rocks that share one world are spheres";
            return Err(Complaint::about("together", remedy).inside("release"));
        }
        Ok(())
    }

    /// Names of blocks stand in a table; whether it has them is seen once it is read.
    fn check_block(&self, shape: &ShapeTable) -> Checked {
        if shape.block.is_none() || self.release.table.is_some() {
            return Ok(());
        }
        let remedy =
            "remove it, or write [release] table = \"blocks.csv\": blocks have their names there";
        Err(Complaint::about("block", remedy))
    }

    /// Refuses a shape of a block that the release table does not have, and a block that has no shape.
    ///
    /// # Errors
    /// The block, and which there are.
    pub(super) fn match_blocks(&self) -> Result<()> {
        let shapes = &self.rocks.shapes;
        let rows = &self.release.blocks;
        for (index, shape) in shapes.iter().enumerate() {
            let Some(block) = &shape.block else { continue };
            if !rows.iter().any(|row| row.block.as_ref() == Some(block)) {
                let mut names: Vec<&str> =
                    rows.iter().filter_map(|row| row.block.as_deref()).collect();
                names.sort_unstable();
                names.dedup();
                let place = format!("[[rocks.shapes]] #{} block", index + 1);
                let found = format!("found no block \"{block}\" in the release table");
                let remedy = if names.is_empty() {
                    "give the table a column block".to_owned()
                } else {
                    suggest(block, &names)
                };
                return Err(Error::input(&self.file, place, found, remedy));
            }
        }
        let is_free = shapes.is_empty() || shapes.iter().any(|shape| shape.block.is_none());
        let has_own =
            |row: &BlockRow| row.block.is_some() && shapes.iter().any(|s| s.block == row.block);
        match rows.iter().find(|row| !is_free && !has_own(row)) {
            None => Ok(()),
            Some(row) => {
                let name = row.block.as_deref().unwrap_or_default();
                let found = format!("found no shape of the block \"{name}\" of the release table");
                let remedy = "write one with its block, or one without block for all others";
                Err(Error::input(&self.file, "[[rocks.shapes]]", found, remedy))
            }
        }
    }

    fn check_soil_of_worlds(&self) -> Checked {
        if !self.release.together {
            return Ok(());
        }
        for (name, ground) in &self.grounds {
            let soils = [
                ("slip_friction", ground.slip_friction.is_some()),
                ("scar", ground.scar.is_some()),
                ("restitution_half_speed_m_s", ground.restitution_half_speed_m_s.is_some()),
            ];
            if let Some((key, _)) = soils.into_iter().find(|(_, given)| *given) {
                let remedy = "remove it, or together = true: on soft soil rocks are computed one by one only, as yet";
                return Err(Complaint::about(key, remedy).inside(name).inside("grounds"));
            }
        }
        Ok(())
    }
}
