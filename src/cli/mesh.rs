//! `rockfall mesh`: check, convert and make meshes.

use super::terminal::say;
use super::words::up;
use crate::error::{Error, Result};
use crate::file;
use crate::rock::Vec3;
use crate::terrain::formats::{self, Options};
use crate::terrain::read::MeshSource;
use crate::terrain::stl::write_binary;
use crate::terrain::weld::Up;
use crate::terrain::{Sheet, Terrain, make};
use clap::Subcommand;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Subcommand)]
pub(super) enum MeshCommand {
    /// Print the health of terrain files as they will be welded
    Check {
        /// STL files, or what else a scene reads as terrain: PLY, OBJ, GeoTIFF, ESRI ASCII grid
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Which axis of the files points up, as `up` in the scene: with y, (x, y, z) becomes (x, -z, y)
        #[arg(long, value_name = "z|y", value_parser = up, default_value = "z")]
        up: Up,
    },
    /// Turn a GeoTIFF or an ESRI ASCII grid into STL; subtract the map origin and print it
    FromGrid {
        /// Elevation model (.tif, .asc)
        grid: PathBuf,
        /// STL file to write
        out: PathBuf,
    },
    /// Turn a list of trees into stems that stand on a slope
    Stems {
        /// List (CSV) with the columns `x, y, dbh_m, height_m`, or GeoJSON or Shapefile points with `dbh_m` and `height_m`
        list: PathBuf,
        /// The slope's STL file
        terrain: PathBuf,
        /// STL file to write, in the coordinates of the slope's file
        out: PathBuf,
        /// Map position of the slope file's (0, 0, 0), as `origin_m` in the scene: then the list is in map coordinates
        #[arg(
            long,
            value_name = "X,Y,Z",
            value_delimiter = ',',
            num_args = 1,
            allow_negative_numbers = true
        )]
        origin_m: Option<Vec<f64>>,
    },
    /// Write a synthetic slope or shape
    Make {
        /// Which slope or shape
        #[arg(value_parser = clap::builder::PossibleValuesParser::new(make::KINDS))]
        kind: String,
        /// STL file to write
        out: PathBuf,
    },
}

/// Does what is asked of meshes.
pub(super) fn mesh(command: MeshCommand) -> Result<ExitCode> {
    let said = match command {
        MeshCommand::Check { files, up } => check(&files, up),
        MeshCommand::FromGrid { grid, out } => from_grid(&grid, &out),
        MeshCommand::Stems { list, terrain, out, origin_m } => {
            stems((&list, &terrain), &out, origin_m.as_deref())
        }
        MeshCommand::Make { kind, out } => make_mesh(&kind, &out),
    };
    said.map(say)
}

/// Health of mesh files as they will be welded, in words.
fn check(files: &[PathBuf], up: Up) -> Result<String> {
    let is_stl = |path: &Path| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("stl"));
    let source = |path: &PathBuf| {
        let options = (!is_stl(path)).then(Options::default);
        MeshSource { up, options, ..slope_source(path) }
    };
    let sources: Vec<MeshSource> = files.iter().map(source).collect();
    let (_, health) = Terrain::read(&sources, Vec3::zeros(), None)?;
    Ok(health.to_string())
}

/// Turns a GeoTIFF or an ESRI ASCII grid into an STL file; says what was subtracted.
fn from_grid(grid: &Path, out: &Path) -> Result<String> {
    file::keep_inputs(out, &[grid])?;
    let read = formats::read_grid(grid)?;
    read.check_slope(grid)?;
    let grid = read;
    let origin_m = grid.map_origin_m();
    let facets = grid.facets(origin_m);
    write_binary(out, &facets)?;
    Ok(format!(
        "{} triangles written to {}\norigin_m = [{:?}, {:?}, {:?}]  # write this into the scene",
        facets.len(),
        out.display(),
        origin_m.x,
        origin_m.y,
        origin_m.z
    ))
}

/// Turns a list of trees into stems on a slope.
fn stems((list, slope): (&Path, &Path), out: &Path, origin_m: Option<&[f64]>) -> Result<String> {
    file::keep_inputs(out, &[list, slope])?;
    let map_origin_m = match origin_m {
        None => Vec3::zeros(),
        Some(&[x, y, z]) if [x, y, z].iter().all(|m| m.is_finite()) => Vec3::new(x, y, z),
        Some(_) => {
            let wrong = "--origin-m: write three finite numbers, as in 2600000,1200000,0";
            return Err(Error::Request(wrong.to_owned()));
        }
    };
    let trees = make::read_list(list)?;
    let (terrain, _) = Terrain::read(&[slope_source(slope)], map_origin_m, None)?;
    let mut planted = make::plant(list, &trees, &terrain)?;
    for corner in planted.facets.iter_mut().flatten() {
        *corner -= map_origin_m;
    }
    write_binary(out, &planted.facets)?;
    let (stems, triangles) = (planted.stems(), planted.facets.len());
    let warning = planted.left_out.map(|text| format!("\nwarning: {}: {text}", list.display()));
    let warning = warning.unwrap_or_default();
    Ok(format!("{stems}, {triangles} triangles written to {}{warning}", out.display()))
}

/// A mesh file as it stands.
fn slope_source(path: &Path) -> MeshSource {
    MeshSource::stl(Sheet { path: path.to_owned(), ground: 0, is_tree: false })
}

/// Writes a synthetic slope or shape.
fn make_mesh(kind: &str, out: &Path) -> Result<String> {
    let facets = make::made(kind).ok_or_else(|| {
        let known = make::KINDS.join(", ");
        Error::Request(format!("mesh make: found {kind}; write one of {known}"))
    })?;
    write_binary(out, &facets)?;
    Ok(format!("{} triangles written to {}", facets.len(), out.display()))
}
