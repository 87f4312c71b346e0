//! The files beside a scene: where they are, what they hold of it, and their part of its fingerprint.

use super::check::{Checked, Complaint};
use super::refusal::Refusal;
use super::zones::Zones;
use super::{MeshFile, Scene};
use crate::error::{Error, Result};
use crate::file::{self, LONGEST_MESH};
use crate::gis;
use crate::terrain::Terrain;
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A file that went into the results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputFile {
    /// Which.
    pub path: PathBuf,
    /// Its length.
    pub bytes: u64,
    /// Of a drawing whose coordinates were taken as the scene's without an EPSG code that says so: the name of its system,
    /// empty where it names none.
    pub assumed: Option<String>,
}

/// The table, the entry of a list, and the key that name a file.
type Named = (&'static str, Option<usize>, &'static str);

impl Scene {
    /// Paths as seen from the working directory.
    pub(super) fn settle_paths(&mut self, folder: &Path) {
        let meshes = self.terrain.iter_mut().chain(&mut self.trees);
        let meshes = meshes.flat_map(|mesh| [&mut mesh.mesh, &mut mesh.file]);
        let drawn = self.line_entries.iter_mut().map(|line| &mut line.file);
        let drawn = drawn.chain(self.barrier_entries.iter_mut().map(|barrier| &mut barrier.file));
        let deposits = self.calibrate.iter_mut().map(|table| &mut table.deposits);
        let grounds = self.ground_zones.iter_mut().map(|zones| &mut zones.file);
        let zones = [&mut self.release.zones, &mut self.release.table];
        let shapes = self.rocks.shapes.iter_mut().map(|shape| &mut shape.mesh);
        let paths =
            meshes.chain(shapes).chain(drawn).chain(zones).flatten().chain(deposits).chain(grounds);
        paths.for_each(|path| *path = folder.join(&*path));
    }

    /// Lines and barriers that stand in the scene itself.
    pub(super) fn take_written(&mut self) -> Checked {
        let (mut lines, mut barriers) = (Vec::new(), Vec::new());
        for (index, entry) in self.line_entries.iter().enumerate().filter(|(_, e)| e.file.is_none())
        {
            lines.push(entry.written().map_err(|wrong| wrong.in_entry(index).inside("lines"))?);
        }
        for (index, entry) in
            self.barrier_entries.iter().enumerate().filter(|(_, e)| e.file.is_none())
        {
            barriers
                .push(entry.written().map_err(|wrong| wrong.in_entry(index).inside("barriers"))?);
        }
        (self.lines, self.barriers) = (lines, barriers);
        Ok(())
    }

    /// Zones, lines, barriers and grounds that stand in files.
    pub(super) fn take_drawn(&mut self) -> std::result::Result<(), Refusal> {
        let lines = of_entries(&self.line_entries, "lines", |entry| {
            let Some(file) = &entry.file else { return Ok(vec![entry.written()?]) };
            self.same_system(file, "file").and_then(|()| entry.read(file))
        })?;
        let barriers = of_entries(&self.barrier_entries, "barriers", |entry| {
            let Some(file) = &entry.file else { return Ok(vec![entry.written()?]) };
            self.same_system(file, "file").and_then(|()| entry.read(file))
        })?;
        let grounds: Vec<&str> = self.grounds.keys().map(String::as_str).collect();
        let patches = of_entries(&self.ground_zones, "ground_zones", |zones| {
            let same = self.same_system(&zones.file, "file");
            same.and_then(|()| zones.read(&zones.file, &grounds))
        })?;
        let zones = self.release.zones.as_deref().map(|file| {
            self.same_system(file, "zones")?;
            Zones::read(file).map_err(Refusal::from)
        });
        let zones = zones.transpose().map_err(|wrong| match wrong {
            Refusal::Key(complaint) => complaint.inside("release").into(),
            file @ Refusal::File(_) => file,
        })?;
        self.patches.list = patches;
        self.patches.cut = self.ground_zones.iter().any(|zones| zones.cut);
        (self.lines, self.barriers, self.release.zone_list) = (lines, barriers, zones);
        Ok(())
    }

    /// Refuses a drawing in another system than the scene's; `key` names it.
    fn same_system(&self, file: &Path, key: &str) -> std::result::Result<(), Refusal> {
        if !file.exists() {
            let remedy = format!(
                "write the path of a GeoJSON file or Shapefile as seen from the scene file; {} is not there",
                file.display()
            );
            return Err(Complaint::about(key, remedy).into());
        }
        one_system(&gis::read(file)?, self.epsg, "the scene").map_err(Into::into)
    }

    /// Sizes that neither the scene has nor its table, once that is read.
    pub(super) fn check_table_sizes(&self) -> Result<()> {
        match &self.release.table {
            Some(table) if self.rocks.radius_m.is_none() => {
                let remedy = "write a column radius_m or mass_kg, or [rocks] radius_m in the scene";
                Err(Error::input(table, "radius_m or mass_kg", "found neither", remedy))
            }
            _ => Ok(()),
        }
    }

    /// Refuses drawings in another system than the terrain's, and drawings of which nothing lies on it: those that name no
    /// system, or name it in words alone.
    pub(crate) fn check_drawings(&self, terrain: &Terrain) -> Result<()> {
        self.check_table_sizes()?;
        let (low, high) = terrain.index.bounds();
        let [low, high] = [low, high].map(|corner| corner + terrain.origin_m);
        let epsg = self.epsg.or(terrain.epsg);
        for (_, file) in self.drawings() {
            let layer = gis::read(file)?;
            one_system(&layer, epsg, "the terrain")?;
            let [west, south, east, north] = layer.box_m();
            if west <= high.x && east >= low.x && south <= high.y && north >= low.y {
                continue;
            }
            let is_degrees = west >= -180.0 && east <= 180.0 && south >= -90.0 && north <= 90.0;
            let (kind, digits, from) = match (is_degrees, &layer.system) {
                (true, _) => (", like longitude and latitude".to_owned(), 5, "4326"),
                (false, Some(name)) => (format!(" in {name}"), 1, ""),
                (false, None) => (String::new(), 1, "CODE_OF_THE_DRAWING"),
            };
            let found = format!(
                "found nothing of it on the terrain: it lies at {west:.digits$}..{east:.digits$} east, \
                 {south:.digits$}..{north:.digits$} north{kind}; the terrain at {:.1}..{:.1} east, {:.1}..{:.1} north",
                low.x, high.x, low.y, high.y
            );
            let remedy = format!(
                "draw it on the terrain, or write it in the terrain's system: {}",
                gis::transformed(file, epsg, from)
            );
            return Err(Error::input(file, "coordinates", found, remedy));
        }
        Ok(())
    }

    /// Hash over text and files, each followed by its length so that no two scenes run together.
    pub(super) fn fingerprint(&mut self, text: &str) -> std::result::Result<String, Complaint> {
        let mut hash = Sha256::new();
        hash.update(text);
        hash.update((text.len() as u64).to_le_bytes());
        let mut inputs = Vec::new();
        let mut take = |path: &Path| -> std::result::Result<(), String> {
            let file = file::open(path, LONGEST_MESH).map_err(|error| match error {
                Error::File { file, source, .. } => format!("{}: {source}", file.display()),
                other => other.to_string(),
            })?;
            let length = std::io::copy(&mut file.take(LONGEST_MESH), &mut hash)
                .map_err(|error| format!("{}: {error}", path.display()))?;
            hash.update(length.to_le_bytes());
            inputs.push(InputFile { path: path.to_owned(), bytes: length, assumed: None });
            Ok(())
        };
        self.each_mesh(|mesh| {
            // trees may be drawn in a Shapefile, which is three files
            let files = gis::files(mesh.path());
            files.iter().try_for_each(|file| take(file)).map_err(|why| unreadable(mesh, &why))
        })?;
        for ((table, key), path) in self.tables() {
            take(path).map_err(|why| {
                let remedy = "write the path of a CSV file as seen from the scene file";
                Complaint::about(key, format!("{remedy}; {why}")).inside(table)
            })?;
        }
        for (index, path) in self.scans() {
            take(path).map_err(|why| {
                let remedy = "write the path of an STL file as seen from the scene file";
                let about = Complaint::about("mesh", format!("{remedy}; {why}"));
                about.in_entry(index).inside("shapes").inside("rocks")
            })?;
        }
        for ((table, index, key), path) in self.drawings() {
            for path in gis::files(path) {
                take(&path).map_err(|why| {
                    let remedy = "write the path of a file that can be read";
                    let about = Complaint::about(key, format!("{remedy}; {why}"));
                    match index {
                        Some(index) => about.in_entry(index).inside(table),
                        None => about.inside(table),
                    }
                })?;
            }
        }
        for input in &mut inputs {
            let is_drawing = self.drawings().iter().any(|(_, file)| *file == input.path);
            let layer = if is_drawing { gis::read(&input.path).ok() } else { None };
            input.assumed = layer
                .filter(|layer| layer.epsg.is_none())
                .map(|layer| layer.system.unwrap_or_default());
        }
        self.inputs = inputs;
        Ok(format!("{:x}", hash.finalize()))
    }

    /// The hash of text and files; another one where a program has changed a value after reading them, so that results of
    /// one scene are never taken for those of another. Seed and number of releases stay out: results name them apart.
    pub fn hash_in_force(&self) -> String {
        let now = self.digest();
        if self.as_read.is_empty() || now == self.as_read {
            return self.hash.clone();
        }
        format!("{:x}", Sha256::digest(format!("{}{now}", self.hash)))
    }

    /// Digest of all values but seed and number of releases.
    pub(super) fn digest(&self) -> String {
        let (hash, as_read) = (String::new(), String::new());
        let mut values = Self { seed: 0, hash, as_read, ..self.clone() };
        values.release.count = 0;
        format!("{:x}", Sha256::digest(format!("{values:?}")))
    }

    /// CSV files: table and key that name them.
    fn tables(&self) -> Vec<((&'static str, &'static str), &Path)> {
        let blocks = self.release.table.iter().map(|path| (("release", "table"), path.as_path()));
        let ends = self.calibrate.iter();
        blocks.chain(ends.map(|c| (("calibrate", "deposits"), c.deposits.as_path()))).collect()
    }

    /// Scanned shapes: entry and file.
    fn scans(&self) -> impl Iterator<Item = (usize, &Path)> {
        let shapes = self.rocks.shapes.iter().enumerate();
        shapes.filter_map(|(index, shape)| Some((index, shape.mesh.as_deref()?)))
    }

    /// Files with drawings: table, entry and key that name them.
    fn drawings(&self) -> Vec<(Named, &Path)> {
        let lists: [(&'static str, Vec<Option<&Path>>); 3] = [
            ("lines", self.line_entries.iter().map(|one| one.file.as_deref()).collect()),
            ("barriers", self.barrier_entries.iter().map(|one| one.file.as_deref()).collect()),
            ("ground_zones", self.ground_zones.iter().map(|one| Some(&*one.file)).collect()),
        ];
        let mut all: Vec<(Named, &Path)> = Vec::new();
        for (list, files) in lists {
            let files = files.into_iter().enumerate();
            all.extend(files.filter_map(|(k, file)| Some(((list, Some(k), "file"), file?))));
        }
        all.extend(
            self.release.zones.iter().map(|file| (("release", None, "zones"), file.as_path())),
        );
        all
    }
}

/// What the entries of a list say together.
fn of_entries<E, T>(
    entries: &[E],
    list: &str,
    take: impl Fn(&E) -> std::result::Result<Vec<T>, Refusal>,
) -> std::result::Result<Vec<T>, Refusal> {
    let mut all = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        all.extend(take(entry).map_err(|wrong| wrong.in_entry(index, list))?);
    }
    Ok(all)
}

/// Refuses a drawing in another system than that of `whose`.
fn one_system(layer: &gis::GisLayer, epsg: Option<u32>, whose: &str) -> Result<()> {
    let (Some(code), Some(own)) = (layer.epsg, epsg) else { return Ok(()) };
    if code == own {
        return Ok(());
    }
    let found = format!("found EPSG:{code} where {whose} has EPSG:{own}");
    let remedy = format!(
        "write it in the system of {whose}: {}",
        gis::transformed(&layer.file, Some(own), "")
    );
    Err(Error::input(&layer.file, "coordinate system", found, remedy))
}

fn unreadable(mesh: &MeshFile, why: &str) -> Complaint {
    let (key, what) = if mesh.file.is_some() {
        ("file", "an elevation model or mesh")
    } else {
        ("mesh", "an STL file")
    };
    Complaint::about(key, format!("write the path of {what} as seen from the scene file; {why}"))
}
