//! From what a file holds to triangles: crop, coarsen, cut, and say what was done.

use super::{Crop, ElevationModel, Loaded, Options, odd_cells, wider};
use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::terrain::facets::Facets;
use crate::terrain::grid::{Grid, Standing, nothing_there};
use crate::terrain::stl::{Format, Soup};
use std::path::Path;

/// Cells of a grid, or points of a cloud, that are cut into triangles at most: a tile of 14 km at 1 m takes about 35 GB.
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
            Self::Mesh(_) | Self::Unreached(_) | Self::Trees(_) => None,
            Self::Grid(heights) => heights.grid.highest_in(box_m),
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => cloud.highest_in(box_m),
            #[cfg(feature = "cloud")]
            Self::Joined(..) => None,
        }
    }

    /// The box of its cells that rocks from the starts can reach (m).
    fn reached(&self, starts: &Starts, slope: f64) -> Option<[f64; 4]> {
        match self {
            Self::Mesh(_) | Self::Unreached(_) | Self::Trees(_) => None,
            Self::Grid(heights) => heights.grid.reached(starts, slope),
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => cloud.reached(starts, slope),
            #[cfg(feature = "cloud")]
            Self::Joined(..) => None,
        }
    }

    fn format(&self) -> Format {
        match self {
            Self::Mesh(soup) => soup.format,
            Self::Grid(heights) => heights.format,
            Self::Unreached(format) => *format,
            Self::Trees(_) => Format::Trees,
            #[cfg(feature = "cloud")]
            Self::Cloud(_) | Self::Joined(..) => Format::Cloud,
        }
    }

    /// What of it is used: cropped and coarsened; a mesh stays as it is.
    ///
    /// # Errors
    /// Nothing left after cropping, or more than can be computed with.
    pub(in crate::terrain) fn used(
        self,
        file: &Path,
        options: &Options,
        starts: &Starts,
    ) -> Result<Self> {
        #[cfg(feature = "cloud")]
        if matches!(self, Self::Joined(..)) {
            return Ok(self);
        }
        let box_m = match &options.crop {
            None => None,
            Some(Crop::Box(box_m, margin_m)) => Some(wider(*box_m, *margin_m)),
            Some(Crop::Reach { slope, margin_m, .. }) => match self.reached(starts, *slope) {
                Some(box_m) => Some(wider(box_m, *margin_m)),
                // one of several tiles; of all files together something must be reached
                None => return Ok(Self::Unreached(self.format())),
            },
        };
        match self {
            Self::Grid(heights) => heights.used(file, (options.resample_m, box_m)).map(Self::Grid),
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => Ok(Self::Cloud(cloud.cropped(box_m))),
            whole => Ok(whole),
        }
    }

    /// Whether no triangle of its own comes of it.
    pub(in crate::terrain) fn is_left_out(&self) -> bool {
        match self {
            Self::Unreached(_) => true,
            #[cfg(feature = "cloud")]
            Self::Joined(..) => true,
            _ => false,
        }
    }

    /// Its triangles around `map_origin_m`; `facets` are those of a grid. Of trees none: they wait for the slope.
    ///
    /// # Errors
    /// No triangle.
    #[cfg_attr(
        not(feature = "cloud"),
        expect(unused_variables, reason = "only clouds are cut here")
    )]
    pub(in crate::terrain) fn into_soup(
        self,
        file: &Path,
        facets: Facets,
        map_origin_m: Vec3,
    ) -> Result<Soup> {
        match self {
            Self::Mesh(soup) => Ok(soup),
            Self::Unreached(format) => {
                let mut soup = Soup::of_format(format);
                soup.notes.push("left out: no cell lies below the places of release".to_owned());
                Ok(soup)
            }
            Self::Trees(trees) => {
                let mut soup = Soup::of_format(Format::Trees);
                soup.epsg = trees.epsg;
                Ok(soup)
            }
            Self::Grid(heights) => heights.into_soup(file, facets),
            #[cfg(feature = "cloud")]
            Self::Cloud(cloud) => cloud.into_soup(file, map_origin_m),
            #[cfg(feature = "cloud")]
            Self::Joined(first, epsg) => {
                let mut soup = Soup::of_format(Format::Cloud);
                soup.epsg = epsg;
                let first = first.display();
                soup.notes.push(format!("joined with {first}, which it touches: one surface"));
                Ok(soup)
            }
        }
    }
}

/// The files have nothing below the places of release.
pub(in crate::terrain) fn unreached(file: &Path) -> Error {
    let remedy = "write crop for elevation models and point clouds that hold the places of release";
    Error::input(file, "crop", "found no cell below the places of release", remedy)
}

impl ElevationModel {
    /// Cropped and coarsened.
    fn used(
        mut self,
        file: &Path,
        (resample_m, box_m): (Option<f64>, Option<[f64; 4]>),
    ) -> Result<Self> {
        let mut note = |text: String| self.notes.push(text);
        let mut grid = self.grid;
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
        self.warnings.extend(odd_cells::warnings(&grid));
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
        note(format!("{} cells without data, left as holes", grid.holes()));
        if grid.columns * grid.rows > MOST_CELLS {
            let found = format!("found {} cells", grid.columns * grid.rows);
            let remedy =
                format!("write crop or resample_m in the scene: at most {MOST_CELLS} are used");
            return Err(Error::input(file, "cells", found, remedy));
        }
        self.grid = grid;
        Ok(self)
    }

    fn into_soup(self, file: &Path, facets: Facets) -> Result<Soup> {
        let mut soup = Soup::of_format(self.format);
        (soup.epsg, soup.notes, soup.facets) = (self.epsg, self.notes, facets);
        soup.warnings = self.warnings;
        // a tile whose places all belong to earlier ones has none of its own
        if soup.facets.is_empty() && self.joined == 0 {
            let remedy =
                "leave the file out, or write one whose cells have data, three neighbours or more";
            let (data, all) = (self.grid.values.len() - self.grid.holes(), self.grid.values.len());
            let found =
                format!("found data in {data} of {all} cells, and no triangle between them");
            return Err(Error::input(file, "cells", found, remedy));
        }
        Ok(soup)
    }
}

/// The facets of all grids, tiles of one model joined; none of other files.
///
/// # Errors
/// Two grids over the same ground that cannot be joined.
pub(in crate::terrain) fn facets(
    all: &mut [Loaded],
    files: &[&Path],
    map_origin_m: Vec3,
) -> Result<Vec<Facets>> {
    let mut joined = vec![Vec::new(); all.len()];
    for one in 0..all.len() {
        for other in 0..all.len() {
            let (Loaded::Grid(own), Loaded::Grid(beside)) = (&all[one], &all[other]) else {
                continue;
            };
            let name = files[other].display();
            let note = match own.grid.standing(&beside.grid) {
                _ if one == other => continue,
                Standing::Apart => continue,
                Standing::Joined(steps) => {
                    joined[one].push((other, steps));
                    format!("joined with {name}, which lies on the same lattice")
                }
                Standing::Gap => format!(
                    "a gap of a cell to {name}, which lies on another lattice: rocks fall through it"
                ),
                Standing::Double(common) => return Err(double(files[one], files[other], common)),
            };
            if let Loaded::Grid(own) = &mut all[one] {
                own.joined = joined[one].len();
                own.notes.push(note);
            }
        }
    }
    let grid = |k: usize| if let Loaded::Grid(own) = &all[k] { Some(&own.grid) } else { None };
    let of = |(one, list): (usize, &Vec<(usize, [i64; 2])>)| {
        let others = list.iter().filter_map(|&(k, steps)| Some((grid(k)?, steps, k < one)));
        let others: Vec<_> = others.collect();
        grid(one).map_or_else(Facets::default, |own| own.facets_beside(&others, map_origin_m))
    };
    Ok(joined.iter().enumerate().map(of).collect())
}

fn double(one: &Path, other: &Path, [wide, high]: [f64; 2]) -> Error {
    let found = format!(
        "found {wide} x {high} m of ground that {} has too, in other cells: rocks would meet two surfaces",
        other.display()
    );
    let remedy = format!(
        "make one model of both: gdalwarp -r bilinear {} {} out.tif, or write crop boxes beside each other",
        other.display(),
        one.display()
    );
    Error::input(one, "cells", found, remedy)
}

/// West, south, east, north of a grid (m).
fn outline(grid: &Grid) -> [f64; 4] {
    let [x, y] = grid.corner_m;
    [x, y, x + grid.columns as f64 * grid.cell_m, y + grid.rows as f64 * grid.cell_m]
}
