//! The scene: what is asked, as written in its TOML file and checked key by key.
//!
//! Every table stands in a file of its own and checks its own keys. Physics has no default: what is absent
//! here is either numerics, filled in and printed by the plan, or an error.

mod barrier;
mod blocks;
mod calibrate;
mod catalogue;
mod check;
mod drawn;
mod files;
mod frequency;
mod geometry;
mod ground_zones;
mod grounds;
mod holes;
mod matrix;
mod meshes;
mod object;
mod places;
mod record;
mod refusal;
mod release;
mod rewrite;
mod rocks;
mod shapes;
mod sizes;
mod sketch;
mod solver;
mod source;
mod wording;
mod zone_sources;
mod zones;

pub use barrier::{BarrierTable, DesignTable, Simulation, Standard, Topography};
pub use blocks::{BlockRow, BothSizes, SizeFrom};
pub use calibrate::{
    CalibrateTable, CalibrationScore, FittedValue, MeasuredEnds, VaryKey, VaryTable,
};
pub use catalogue::{CATALOGUE, KnownGround, KnownValue, catalogue, known_ground};
pub use drawn::{BarrierEntry, LineEntry};
pub use files::InputFile;
pub use frequency::{ClassTable, FrequencyTable, SourceTable};
pub use ground_zones::GroundZones;
pub use grounds::GroundTable;
pub use matrix::{KnownMatrix, MATRICES, MatrixEntry, MatrixTable};
pub use meshes::{CropTable, MeshFile, MeshTable};
pub use object::{ObjectTable, VehiclesTable};
pub use places::{Area, Corner, Polyline, ReleasePoint};
pub use record::{Language, LineTable, MapsTable, RecordTable, ReportTable};
pub use release::{MOST_RELEASES, ReleaseTable};
pub use rewrite::rewritten;
pub use rocks::{RockContact, Rocks};
pub use shapes::{CORNERS, Orientation, RandomWord, ShapeTable};
pub use sketch::sketch;
pub use solver::SolverTable;
pub use zones::{ZONE_PROPERTIES, Zone, ZonePlace, Zones};

use crate::error::{Error, Result};
use crate::random::{Distribution, entries};
use crate::terrain::health::Health;
use crate::terrain::{Sheet, Terrain, patches::Patches, read::MeshSource};
use check::{Allowed, BROKEN, Checked, Complaint, check_names, is_broken, name_flaw, number};
use places::FARTHEST_M;
use refusal::Refusal;
use serde::Deserialize;
use source::Lookup;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scene file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a scene")]
pub struct Scene {
    /// Heading of the report.
    pub title: String,
    /// Where chance starts.
    pub seed: u64,
    /// Gravity (m/s²), 0 or more, along −z.
    #[serde(default = "standard_gravity_m_s2")]
    pub gravity_m_s2: f64,
    /// Map position of the meshes' (0, 0, 0) (m).
    #[serde(default, deserialize_with = "entries")]
    pub origin_m: [f64; 3],
    /// EPSG code of the map coordinates, written into rasters.
    pub epsg: Option<u32>,
    /// The slope; at least one file.
    #[serde(default)]
    pub terrain: Vec<MeshFile>,
    /// Trees; may be none.
    #[serde(default)]
    pub trees: Vec<MeshFile>,
    /// How the files become one mesh.
    #[serde(default)]
    pub mesh: MeshTable,
    /// Grounds by name; their order is that of their names.
    pub grounds: BTreeMap<String, GroundTable>,
    /// The rocks.
    pub rocks: Rocks,
    /// Where and how they start.
    pub release: ReleaseTable,
    /// How they are computed.
    #[serde(default)]
    pub solver: SolverTable,
    /// What is kept.
    #[serde(default)]
    pub record: RecordTable,
    /// Evaluation lines as they are written.
    #[serde(default, rename = "lines")]
    pub line_entries: Vec<LineEntry>,
    /// Barriers as they are written.
    #[serde(default, rename = "barriers")]
    pub barrier_entries: Vec<BarrierEntry>,
    /// Grounds by polygon.
    #[serde(default)]
    pub ground_zones: Vec<GroundZones>,
    /// Roads, paths and houses that rocks may hit.
    #[serde(default)]
    pub objects: Vec<ObjectTable>,
    /// How often rocks are released.
    pub frequency: Option<FrequencyTable>,
    /// Rasters.
    pub maps: Option<MapsTable>,
    /// What stands on the report.
    #[serde(default)]
    pub report: ReportTable,
    /// Measured ends, and what may be fitted to them.
    pub calibrate: Option<CalibrateTable>,
    /// The scene file itself.
    #[serde(skip)]
    pub file: PathBuf,
    /// SHA-256 (hexadecimal) of the scene's text and of the bytes of every file that it names.
    #[serde(skip)]
    pub hash: String,
    /// Digest of the values as read; empty for a text only parsed.
    #[serde(skip)]
    as_read: String,
    /// Those files.
    #[serde(skip)]
    pub inputs: Vec<InputFile>,
    /// Evaluation lines; those of files once the scene is read.
    #[serde(skip)]
    pub lines: Vec<LineTable>,
    /// Barriers, judged on what crosses them; those of files once the scene is read.
    #[serde(skip)]
    pub barriers: Vec<BarrierTable>,
    /// Polygons of `ground_zones`, once the scene is read.
    #[serde(skip)]
    pub patches: Patches,
}

/// Gravity when a scene does not name it (m/s²).
fn standard_gravity_m_s2() -> f64 {
    9.81
}

impl Scene {
    /// Reads and checks a scene file and the drawings that it names, and takes the fingerprint of all files.
    /// # Errors
    /// Whatever is wrong with the scene, with file, table, key and line; a file or drawing that cannot be used.
    pub fn read(file: &Path) -> Result<Self> {
        let no_scene = |wrong| source::terrain_instead(file).unwrap_or(wrong);
        let text = crate::file::read_text(file).map_err(no_scene)?;
        let mut scene = Self::parse(&text, file).map_err(no_scene)?;
        scene.read_blocks()?;
        let refuse = |wrong| Lookup::of(file, &text).refuse(wrong);
        scene.take_drawn().and_then(|()| scene.take_zone_sources()).map_err(
            |wrong| match wrong {
                Refusal::Key(complaint) => refuse(*complaint),
                Refusal::File(error) => error,
            },
        )?;
        scene.check_lines().map_err(refuse)?;
        scene.hash = scene.fingerprint(&text).map_err(refuse)?;
        scene.as_read = scene.digest();
        Ok(scene)
    }

    /// Reads and checks a scene's text; the files that it names are not looked at and the hash stays empty.
    /// Relative paths in it are seen from the folder of `file`.
    ///
    /// # Errors
    /// Whatever is wrong with the scene, with file, table, key and line.
    pub fn parse(text: &str, file: &Path) -> Result<Self> {
        let mut scene: Self =
            toml::from_str(text).map_err(|error| Lookup::of(file, text).refuse_reading(&error))?;
        scene
            .take_from_catalogue()
            .and_then(|()| scene.check())
            .map_err(|wrong| Lookup::of(file, text).refuse(wrong))?;
        if source::EMPTY.iter().any(|empty| text.contains(empty)) {
            Lookup::of(file, text).check_paths()?;
        }
        scene.rocks.take_sizes(scene.sources().as_ref());
        scene.settle_paths(file.parent().unwrap_or(Path::new("")));
        file.clone_into(&mut scene.file);
        Ok(scene)
    }

    /// Reads the blocks of the release table; their radii, where they are there, are those of the scene.
    fn read_blocks(&mut self) -> Result<()> {
        let Some(table) = &self.release.table else { return Ok(()) };
        let has_height = self.release.height_m.is_some();
        let sized = (self.rocks.density_kg_m3, self.release.size_from);
        let blocks = blocks::read(table, has_height, sized)?;
        let radii_m: Vec<f64> = blocks.iter().filter_map(|block| block.radius_m).collect();
        if !radii_m.is_empty() {
            let refuse = |flaw: crate::error::Flaw| {
                Error::input(table, "radius_m or mass_kg", flaw.found, flaw.remedy)
            };
            let radius_m = Distribution::listed(radii_m).map_err(refuse)?;
            self.rocks.radius_m = Some(radius_m);
            let wrong = |wrong: Complaint| {
                let (least_m, most_m) =
                    self.rocks.radius_m.as_ref().map_or((0.0, 0.0), Distribution::support);
                let radii = || format!("found blocks with a radius of {least_m:?} to {most_m:?} m");
                let found = wrong.found.unwrap_or_else(radii);
                Error::input(table, "radius_m or mass_kg", found, wrong.remedy)
            };
            self.rocks.check().map_err(wrong)?;
        }
        self.release.blocks = blocks;
        self.check_table_sizes()?;
        self.match_blocks()
    }

    /// Position of a ground in the scene's list of grounds.
    pub fn ground_index(&self, name: &str) -> Option<usize> {
        self.grounds.keys().position(|known| known == name)
    }

    /// The files of slope and trees, ready for [`Terrain::read`].
    pub fn mesh_sources(&self) -> Vec<MeshSource> {
        let sources = self.frequency.iter().flat_map(|table| &table.sources);
        let starts = self.release.boxes_m(&sources.cloned().collect::<Vec<_>>());
        let source = |mesh: &MeshFile, is_tree| MeshSource {
            sheet: Sheet {
                path: mesh.path().to_owned(),
                // the check has made sure that the ground is known
                ground: self.ground_index(&mesh.ground).unwrap_or_default() as u16,
                is_tree,
            },
            up: mesh.up,
            scale: mesh.scale,
            options: mesh.options(&starts, self.epsg),
        };
        let slope = self.terrain.iter().map(|mesh| source(mesh, false));
        slope.chain(self.trees.iter().map(|mesh| source(mesh, true))).collect()
    }

    /// Reads the meshes; says what was found in them.
    ///
    /// # Errors
    /// See [`Terrain::read`].
    pub fn read_terrain(&self) -> Result<(Terrain, Health)> {
        let (sources, tolerance_m) = (self.mesh_sources(), self.mesh.weld_tolerance_m);
        Terrain::read_patched(&sources, self.origin_m.into(), tolerance_m, &self.patches)
    }

    /// Fills in what grounds leave to the catalogue.
    fn take_from_catalogue(&mut self) -> Checked {
        for (name, ground) in &mut self.grounds {
            ground.take_from_catalogue().map_err(|wrong| wrong.inside(name).inside("grounds"))?;
        }
        Ok(())
    }

    fn check(&mut self) -> Checked {
        if self.title.trim().is_empty() {
            let remedy = "name the place and the question, as in title = \"Road below the quarry\"";
            return Err(
                Complaint::about("title", remedy).finding("found an empty title".to_owned())
            );
        }
        if is_broken(&self.title) {
            let found = format!("found {:?}", self.title);
            return Err(Complaint::about("title", BROKEN).finding(found));
        }
        number("gravity_m_s2", self.gravity_m_s2, Allowed::NotNegative, "9.81 on Earth")?;
        if places::finite(&self.origin_m).is_err() {
            let remedy = format!("write three finite numbers within {FARTHEST_M:e}");
            return Err(Complaint::about("origin_m", remedy));
        }
        self.check_meshes()?;
        let scheme = self.solver.scheme();
        for (name, ground) in &self.grounds {
            if let Some(remedy) = name_flaw(name) {
                let found = format!("found the name {name}");
                return Err(Complaint::about(name, remedy).finding(found).inside("grounds"));
            }
            ground.check(scheme).map_err(|wrong| wrong.inside(name).inside("grounds"))?;
        }
        self.check_frequency()?;
        self.rocks.check().map_err(|wrong| wrong.inside("rocks"))?;
        let placed = self.frequency.as_ref().is_some_and(|table| !table.sources.is_empty());
        self.release.check(placed).map_err(|wrong| wrong.inside("release"))?;
        self.solver.check().map_err(|wrong| wrong.inside("solver"))?;
        self.record.check().map_err(|wrong| wrong.inside("record"))?;
        self.take_written()?;
        self.check_lines()?;
        let grounds: Vec<&str> = self.grounds.keys().map(String::as_str).collect();
        for (index, zones) in self.ground_zones.iter().enumerate() {
            zones.check(&grounds).map_err(|wrong| wrong.in_entry(index).inside("ground_zones"))?;
        }
        for (index, object) in self.objects.iter().enumerate() {
            object.check().map_err(|wrong| wrong.in_entry(index).inside("objects"))?;
        }
        self.check_calibrate().map_err(|wrong| wrong.inside("calibrate"))?;
        if let Some(maps) = &self.maps {
            maps.check().map_err(|wrong| wrong.inside("maps"))?;
        }
        self.check_shapes()?;
        self.check_together()
    }

    /// Names of lines and barriers, and of the other places of barriers.
    fn check_lines(&self) -> Checked {
        let lines = self.lines.iter().map(|line| line.name.as_str());
        let barriers = self.barriers.iter().map(|barrier| barrier.name.as_str());
        let objects = self.objects.iter().map(|object| object.name.as_str());
        check_names(&[
            ("lines", lines.collect()),
            ("barriers", barriers.collect()),
            ("objects", objects.collect()),
        ])?;
        for (index, barrier) in self.barriers.iter().enumerate() {
            let taken = |name: &str| {
                let lines = self.lines.iter().map(|line| line.name.as_str());
                lines
                    .chain(self.barriers.iter().map(|other| other.name.as_str()))
                    .chain(self.objects.iter().map(|object| object.name.as_str()))
                    .any(|n| n == name)
            };
            if let Some((_, name, _)) = barrier.elsewhere().find(|(_, name, _)| taken(name)) {
                let remedy =
                    format!("write another name there: \"{name}\" is the line of this offset");
                return Err(Complaint::about("offsets_m", remedy)
                    .in_entry(index)
                    .inside("barriers"));
            }
        }
        Ok(())
    }

    fn check_meshes(&self) -> Checked {
        if self.terrain.is_empty() {
            let remedy =
                "write [[terrain]] with mesh = \"slope.stl\" and ground = a name from [grounds]";
            return Err(Complaint::missing("terrain", remedy));
        }
        let sheets = self.terrain.len() + self.trees.len();
        if sheets.max(self.grounds.len()) > usize::from(u16::MAX) {
            let remedy = format!("join meshes and grounds: write at most {} of each", u16::MAX);
            return Err(Complaint::about("terrain", remedy).finding("found too many"));
        }
        self.mesh.check().map_err(|wrong| wrong.inside("mesh"))?;
        let grounds: Vec<&str> = self.grounds.keys().map(String::as_str).collect();
        self.each_mesh(|mesh| mesh.check(&grounds))
    }

    /// Does the same for every mesh file and says which one fails.
    fn each_mesh(&self, mut check: impl FnMut(&MeshFile) -> Checked) -> Checked {
        for (table, meshes) in [("terrain", &self.terrain), ("trees", &self.trees)] {
            for (index, mesh) in meshes.iter().enumerate() {
                check(mesh).map_err(|wrong| wrong.in_entry(index).inside(table))?;
            }
        }
        Ok(())
    }

    /// What rocks in one world need, and what cannot be had together with it.
    fn check_together(&self) -> Checked {
        if !self.release.together {
            return Ok(());
        }
        if self.frequency.is_some() {
            let remedy = "remove it, or write together = false: what a year brings is summed over rocks that fall on their own";
            return Err(Complaint::about("frequency", remedy)
                .finding("found it beside [release] together = true"));
        }
        let scheme = self.solver.scheme();
        let Some(contact) = &self.rocks.contact else {
            let remedy = "write the table [rocks.contact]: rocks that share one world can touch";
            return Err(Complaint::missing("contact", remedy).inside("rocks"));
        };
        if contact.restitution.is_none() && !scheme.has_fixed_step() {
            let remedy = "write restitution = 0..1; only scheme \"dda\" can do without";
            let missing = Complaint::missing("restitution", remedy);
            return Err(missing.inside("contact").inside("rocks"));
        }
        if !scheme.has_springs() && contact.has_bonds() {
            let remedy = "write \"adaptive\", \"reference\" or \"dda\": a bond breaks by its springs, and the rigid limit has none; with tensile_strength_pa = 0 and cohesion_pa = 0 in [rocks.contact] \"rigid\" can be used";
            return Err(Complaint::about("scheme", remedy).inside("solver"));
        }
        Ok(())
    }
}
