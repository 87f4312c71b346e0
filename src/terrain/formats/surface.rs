//! From what a file holds to triangles: crop, coarsen, cut, and say what was done.

use super::{Crop, Loaded, Options, wider};
use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::terrain::grid::{Grid, nothing_there};
use crate::terrain::stl::{Format, Soup};
use std::path::Path;

/// Cells of a grid, or points of a cloud, that are cut into triangles at most: a tile of 14 km at 1 m takes about 100 GB.
const MOST_CELLS: usize = 200_000_000;
/// Cells on each side below which a grid has no triangle.
const FEWEST: usize = 2;

/// Places where rocks start, each with the highest ground in it (m).
pub(in crate::terrain) type Starts = Vec<([f64; 4], f64)>;

/// The starts of a crop by reach, with the highest ground that any of the files has there.
pub(in crate::terrain) fn starts(options: &Options, all: &[Loaded]) -> Starts {
    let Some(Crop::Reach { starts, .. }) = &options.crop else { return Vec::new() };
    let highest = |box_m: [f64; 4]| {
        all.iter().filter_map(|loaded| loaded.highest_in(box_m)).max_by(f64::total_cmp)
    };
    starts.iter().filter_map(|&box_m| Some((box_m, highest(box_m)?))).collect()
}

impl Loaded {
    fn highest_in(&self, box_m: [f64; 4]) -> Option<f64> {
        match self {
            Self::Mesh(_) => None,
            Self::Grid { grid, .. } => grid.highest_in(box_m),
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => cloud.highest_in(box_m),
        }
    }

    /// The box of its cells that rocks from the starts can reach (m).
    fn reached(&self, starts: &Starts, slope: f64) -> Option<[f64; 4]> {
        match self {
            Self::Mesh(_) => None,
            Self::Grid { grid, .. } => grid.reached(starts, slope),
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => cloud.reached(starts, slope),
        }
    }

    /// Its triangles around `map_origin_m`; a mesh stays as it is.
    ///
    /// # Errors
    /// Nothing left after cropping, or more than can be computed with.
    pub(in crate::terrain) fn into_soup(
        self,
        file: &Path,
        options: &Options,
        starts: &Starts,
        map_origin_m: Vec3,
    ) -> Result<Soup> {
        let box_m = match &options.crop {
            None => None,
            Some(Crop::Box(box_m, margin_m)) => Some(wider(*box_m, *margin_m)),
            Some(Crop::Reach { slope, margin_m, .. }) => {
                let reached = self.reached(starts, *slope).map(|box_m| wider(box_m, *margin_m));
                Some(reached.ok_or_else(|| unreached(file, &self))?)
            }
        };
        match self {
            Self::Mesh(soup) => Ok(soup),
            Self::Grid { grid, format, epsg } => {
                let mut soup = of_grid(grid, file, (options.resample_m, box_m), map_origin_m)?;
                (soup.format, soup.epsg) = (format, epsg);
                Ok(soup)
            }
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => cloud.into_soup(file, box_m, map_origin_m),
        }
    }
}

fn unreached(file: &Path, loaded: &Loaded) -> Error {
    let what =
        if matches!(loaded, Loaded::Mesh(_)) { "a mesh, which is not cropped" } else { "no cell" };
    let remedy = "write crop for elevation models and point clouds that hold the places of release";
    Error::input(file, "crop", format!("found {what} below the places of release"), remedy)
}

fn of_grid(
    mut grid: Grid,
    file: &Path,
    (resample_m, box_m): (Option<f64>, Option<[f64; 4]>),
    map_origin_m: Vec3,
) -> Result<Soup> {
    let mut soup = Soup::of_format(Format::AsciiGrid);
    let mut note = |text: String| soup.notes.push(text);
    note(format!("{} x {} cells of {} m", grid.columns, grid.rows, grid.cell_m));
    if let Some(box_m) = box_m {
        let whole = outline(&grid);
        grid = grid.cropped(box_m);
        if grid.columns < FEWEST || grid.rows < FEWEST {
            return Err(nothing_there(file, whole));
        }
        let [west, south, east, north] = outline(&grid);
        note(format!(
            "cropped to {} x {} cells: {west}..{east} east, {south}..{north} north",
            grid.columns, grid.rows
        ));
    }
    if let Some(cell_m) = resample_m {
        if cell_m < grid.cell_m {
            let found = format!("found {cell_m} m, finer than its cells of {} m", grid.cell_m);
            let remedy =
                format!("write {} or more: finer cells would hold nothing new", grid.cell_m);
            return Err(Error::input(file, "resample_m", found, remedy));
        }
        grid = grid.resampled(cell_m);
        note(format!(
            "coarsened to {} x {} cells of {cell_m} m, each the mean of what it covers",
            grid.columns, grid.rows
        ));
    }
    let holes = grid.holes();
    note(format!("{holes} cells without data, left as holes"));
    if grid.columns * grid.rows > MOST_CELLS {
        let found = format!("found {} cells", grid.columns * grid.rows);
        let remedy =
            format!("write crop or resample_m in the scene: at most {MOST_CELLS} are used");
        return Err(Error::input(file, "cells", found, remedy));
    }
    soup.facets = grid.facets(map_origin_m);
    if soup.facets.is_empty() {
        let remedy = "write a file whose cells have data, three neighbours or more";
        return Err(Error::input(
            file,
            "cells",
            "found no triangle between cells with data",
            remedy,
        ));
    }
    Ok(soup)
}

/// West, south, east, north of a grid (m).
fn outline(grid: &Grid) -> [f64; 4] {
    let [x, y] = grid.corner_m;
    [x, y, x + grid.columns as f64 * grid.cell_m, y + grid.rows as f64 * grid.cell_m]
}
