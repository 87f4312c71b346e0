//! From terrain files to the terrain: read, crop, lay zones of ground on it, weld, examine, index.

use super::formats::surface::{self, starts};
use super::formats::{self, Loaded};
use super::health::{FileHealth, Health};
use super::make::{self, TreeList};
pub use super::options::MeshSource;
use super::options::Options;
use super::patches::{Patched, Patches, ZonePainter};
use super::stl::{self, Format, Soup};
use super::weld::{self, Piece, Up, weld};
use super::{Sheet, Terrain};
use crate::error::{Error, Result};
use crate::rock::Vec3;
use std::path::Path;

impl MeshSource {
    fn load(&self) -> Result<Loaded> {
        let path = &self.sheet.path;
        let Some(options) = &self.options else { return stl::read(path).map(Loaded::Mesh) };
        let is_list = self.sheet.is_tree && make::is_list(path, &crate::file::head(path)?);
        let loaded = if is_list {
            Loaded::Trees(make::read_list(path)?)
        } else {
            formats::read(path, options)?
        };
        let wrong =
            |key: &str, found: &str, remedy: &str| Err(Error::input(path, key, found, remedy));
        let what = if is_list { "a list of trees" } else { "an elevation model" };
        let is_mesh = matches!(loaded, Loaded::Mesh(_));
        if (is_mesh || is_list) && (options.crop.is_some() || options.resample_m.is_some()) {
            let found = format!("found them beside {}", if is_mesh { "a mesh" } else { what });
            let remedy = "remove crop and resample_m: a mesh is taken as it is, and so are stems";
            return wrong("crop, resample_m", &found, remedy);
        }
        if !options.classes.is_empty() && !loaded.is_cloud() {
            let what = if is_mesh { "a mesh" } else { what };
            let remedy = "remove it: classes choose among the points of a point cloud (LAS, LAZ)";
            return wrong("classes", &format!("found it beside {what}"), remedy);
        }
        if !is_mesh && !is_list && self.sheet.is_tree {
            let remedy = "write a mesh of stems under [[trees]], or a list of trees with x, y, dbh_m, height_m";
            return wrong("[[trees]]", "found an elevation model", remedy);
        }
        if !is_mesh && (self.up != Up::Z || (self.scale - 1.0).abs() > 0.0) {
            let remedy = format!("remove up and scale: {what} is in metres, z up");
            return wrong("up, scale", &format!("found them beside {what}"), &remedy);
        }
        Ok(loaded)
    }
}

impl Terrain {
    /// Reads and welds terrain files; says what was found in them.
    ///
    /// `map_origin_m` is the map position of the meshes' (0, 0, 0), `tolerance_m` the weld tolerance
    /// (`None` = chosen from the size of the mesh).
    ///
    /// # Errors
    /// A file that cannot be read or is of no known format, no triangle with an area, coordinates too large for a
    /// binary file, coordinate systems that differ.
    pub fn read(
        sources: &[MeshSource],
        map_origin_m: Vec3,
        tolerance_m: Option<f64>,
    ) -> Result<(Self, Health)> {
        Self::read_patched(sources, map_origin_m, tolerance_m, &Patches::default())
    }

    /// The same with zones of ground laid on the slope.
    ///
    /// # Errors
    /// As [`Terrain::read`].
    pub fn read_patched(
        sources: &[MeshSource],
        map_origin_m: Vec3,
        tolerance_m: Option<f64>,
        patches: &Patches,
    ) -> Result<(Self, Health)> {
        let (mut soups, lists) = read_soups(sources, map_origin_m)?;
        let epsg = one_system(sources, &soups)?;
        stand(&lists, sources, &mut soups, map_origin_m)?;
        let Laid { sheets, sheet_of_facet, patched } =
            lay(patches, sources, &mut soups, map_origin_m)?;
        let pieces: Vec<Piece> = pieces(sources, &soups).collect();
        let files = FileHealth::of_all(&pieces, map_origin_m);
        let joined = weld::join_files(&pieces, map_origin_m, tolerance_m)?;
        drop(pieces);
        drop(soups);
        let mut welded = joined.finish();
        let is_slope = |t: u32| !sources[usize::from(welded.sheet_of[t as usize])].sheet.is_tree;
        let health = Health::with_files(&welded, files, &is_slope);
        health.check()?;
        for (sheet, &facet) in welded.sheet_of.iter_mut().zip(&welded.facet_of) {
            if let Some(&other) = sheet_of_facet[usize::from(*sheet)].get(facet as usize) {
                *sheet = other;
            }
        }
        let has_tree_list = !lists.is_empty();
        Ok((Self { epsg, patched, has_tree_list, ..Self::new(welded, sheets) }, health))
    }
}

/// Zones of ground on the files.
struct Laid {
    /// The files' own sheets, and one more for each other ground on a file.
    sheets: Vec<Sheet>,
    /// Of every facet, by file; empty where no zones are.
    sheet_of_facet: Vec<Vec<u16>>,
    patched: Option<Patched>,
}

fn lay(
    patches: &Patches,
    sources: &[MeshSource],
    soups: &mut [Soup],
    map_origin_m: Vec3,
) -> Result<Laid> {
    let mut sheets: Vec<Sheet> = sources.iter().map(|source| source.sheet.clone()).collect();
    let mut sheet_of_facet: Vec<Vec<u16>> = vec![Vec::new(); sources.len()];
    if patches.is_empty() {
        return Ok(Laid { sheets, sheet_of_facet, patched: None });
    }
    let mut layer = ZonePainter::new(patches);
    for (number, source) in sources.iter().enumerate().filter(|(_, s)| !s.sheet.is_tree) {
        let placed = |point: Vec3| source.placed(point) + map_origin_m;
        let grounds = layer.lay(&mut soups[number], source.sheet.ground, &placed)?;
        sheet_of_facet[number] = sheets_of(&mut sheets, number, &grounds)?;
    }
    Ok(Laid { sheets, sheet_of_facet, patched: Some(layer.done) })
}

/// The files as they enter the mesh.
fn pieces<'a>(sources: &'a [MeshSource], soups: &'a [Soup]) -> impl Iterator<Item = Piece<'a>> {
    (0..).zip(sources.iter().zip(soups)).map(|(sheet, (source, soup))| Piece {
        file: &source.sheet.path,
        soup,
        up: source.up,
        scale: source.scale,
        sheet,
    })
}

/// Lists of trees, with the number of their source.
type Lists = Vec<(usize, TreeList)>;

/// Turns lists of trees into stems that stand on the slope.
fn stand(
    lists: &Lists,
    sources: &[MeshSource],
    soups: &mut [Soup],
    map_origin_m: Vec3,
) -> Result<()> {
    if lists.is_empty() {
        return Ok(());
    }
    let sheets = sources.iter().map(|source| source.sheet.clone()).collect();
    let is_ground = |piece: &Piece| !sources[usize::from(piece.sheet)].sheet.is_tree;
    let ground: Vec<Piece> = pieces(sources, soups).filter(is_ground).collect();
    let slope = Terrain::new(weld(&ground, map_origin_m, None)?, sheets);
    drop(ground);
    for (number, list) in lists {
        let planted = make::plant(&sources[*number].sheet.path, list, &slope)?;
        let soup = &mut soups[*number];
        soup.notes.push(format!("{}, stood on the slope", planted.stems()));
        soup.warnings.extend(planted.left_out);
        let mut facets = planted.facets;
        facets.iter_mut().flatten().for_each(|corner| *corner -= map_origin_m);
        soup.facets = facets.into();
    }
    Ok(())
}

/// All files as triangles, and lists of trees apart. What one file may be cropped to depends on the heights of all.
fn read_soups(sources: &[MeshSource], map_origin_m: Vec3) -> Result<(Vec<Soup>, Lists)> {
    let mut loaded: Vec<Loaded> = sources.iter().map(MeshSource::load).collect::<Result<_>>()?;
    formats::join_tiles(&mut loaded, sources)?;
    let none = Options::default();
    let asked = |source: &MeshSource| source.options.clone().unwrap_or_else(|| none.clone());
    let starts: Vec<_> = sources.iter().map(|source| starts(&asked(source), &loaded)).collect();
    let used = |((source, loaded), starts): ((&MeshSource, Loaded), &_)| {
        loaded.used(&source.sheet.path, &asked(source), starts)
    };
    let mut used: Vec<Loaded> =
        sources.iter().zip(loaded).zip(&starts).map(used).collect::<Result<_>>()?;
    let files: Vec<&Path> = sources.iter().map(|source| source.sheet.path.as_path()).collect();
    let is_unreached =
        |(loaded, source): &(&Loaded, &MeshSource)| source.sheet.is_tree || loaded.is_left_out();
    if let Some(first) =
        files.first().filter(|_| used.iter().zip(sources).all(|s| is_unreached(&s)))
    {
        return Err(surface::unreached(first));
    }
    let list = |(number, loaded): (usize, &Loaded)| match loaded {
        Loaded::Trees(list) => Some((number, list.clone())),
        _ => None,
    };
    let lists = used.iter().enumerate().filter_map(list).collect();
    let facets = surface::facets(&mut used, &files, map_origin_m)?;
    let soup = |((loaded, file), facets): ((Loaded, &&Path), _)| {
        loaded.into_soup(file, facets, map_origin_m)
    };
    let soups = used.into_iter().zip(&files).zip(facets).map(soup).collect::<Result<_>>()?;
    Ok((soups, lists))
}

/// The EPSG code that the files name: of all the same one, and the scene's if that has one.
fn one_system(sources: &[MeshSource], soups: &[Soup]) -> Result<Option<u32>> {
    let mut known: Option<(u32, String)> = None;
    for (source, soup) in sources.iter().zip(soups) {
        let Some(code) = soup.epsg else { continue };
        let path = &source.sheet.path;
        let asked = source.options.as_ref().and_then(|options| options.epsg);
        let other = asked.map(|code| (code, "the scene".to_owned())).or_else(|| known.clone());
        if let Some((other, whose)) = other.filter(|(other, _)| *other != code) {
            let name = path.display();
            let command = match soup.format {
                Format::Trees => format!("ogr2ogr -t_srs EPSG:{other} out.geojson {name}"),
                _ => format!("gdalwarp -t_srs EPSG:{other} {name} out.tif"),
            };
            let remedy = format!("write epsg = {code} in the scene, or {command}");
            let found = format!("found EPSG:{code} where {whose} has EPSG:{other}");
            return Err(Error::input(path, "coordinate system", found, remedy));
        }
        known.get_or_insert_with(|| (code, path.display().to_string()));
    }
    Ok(known.map(|(code, _)| code))
}

/// Sheets for the grounds of a file's facets: the file's own first, a new one for each other ground.
fn sheets_of(sheets: &mut Vec<Sheet>, number: usize, grounds: &[u16]) -> Result<Vec<u16>> {
    let of_file = sheets[number].clone();
    let mut known = vec![(of_file.ground, number)];
    for &ground in grounds {
        if !known.iter().any(|(other, _)| *other == ground) {
            known.push((ground, sheets.len()));
            sheets.push(Sheet { ground, ..of_file.clone() });
        }
    }
    if sheets.len() > usize::from(u16::MAX) {
        return Err(Error::Request(format!(
            "the terrain has more than {} sheets; join files or zones",
            u16::MAX
        )));
    }
    let sheet =
        |ground: &u16| known.iter().find(|(other, _)| other == ground).map_or(number, |k| k.1);
    Ok(grounds.iter().map(|ground| sheet(ground) as u16).collect())
}

impl MeshSource {
    /// A point of the file in metres, z up.
    fn placed(&self, point: Vec3) -> Vec3 {
        self.up.turned(point) * self.scale
    }
}
