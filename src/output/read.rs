//! Results read back: what figures and pages are drawn from.

use super::atomic_file::length;
use super::checksum::{self, RESTORE};
use super::lock::FolderLock;
use super::progress::{Identity, PROGRESS, Progress};
use super::releases::CLASS_COLUMNS;
use super::rows::{ImpactRow, PathRow};
use super::summary::{SUMMARY, Summary};
use super::vector;
use super::{CROSSINGS, IMPACTS, PATHS, RELEASES, table};
use crate::count::number_of;
use crate::error::{Error, Result};
use crate::hazard::{
    AnnualRequest, Barrier, BarrierSummary, CrossingRow, Hazard, Layer, Line, LineInfo, OpenRocks,
    Quantity, Row, Statistic, YearSums, by_rock, stopping,
};
use crate::terrain::geotiff;
use crate::terrain::grid::Grid;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};

/// The complete results in a folder.
#[derive(Debug)]
pub struct Results {
    /// The folder.
    pub dir: PathBuf,
    /// Its `summary.json`.
    pub summary: Summary,
    /// All rocks together, from `releases.csv` and the totals of the summary.
    pub hazard: Hazard,
    /// All first crossings line by line, from `crossings.csv`.
    pub lines: Vec<Line>,
    /// Rocks that would have gone on, and the lines that they may still come to.
    pub open: OpenRocks,
    /// Keeps other processes away as long as the run that wrote them goes on.
    #[expect(dead_code, reason = "held until it is dropped")]
    pub(super) lock: Option<FolderLock>,
}

/// Reads the results in `dir`.
///
/// # Errors
///
/// If the folder holds no results, or those of a run that is not finished, or if `releases.csv` or `summary.json`
/// is not as it was written.
pub fn read(dir: &Path) -> Result<Results> {
    let refuse = |why| Err(Error::Request(format!("{}: {why}", dir.display())));
    let summary = match (Progress::read(dir)?, Summary::read(dir)?) {
        // A summary beside a run that has begun again is that of the run before.
        (Some(progress), _) if !progress.is_complete() => {
            return refuse(
                "holds a run that is not finished; go on with `rockfall run SCENE --resume`",
            );
        }
        (_, Some(summary)) => summary,
        (Some(_), None) => {
            return refuse(
                "holds a run without its summary; write it with `rockfall run SCENE --resume`",
            );
        }
        (None, None) => {
            return refuse(
                "holds no results: there is no summary.json; write some with `rockfall run SCENE --out DIR`",
            );
        }
    };
    let asked = &summary.asked;
    let hazard = Hazard::with(summary.totals.clone()).weighing(asked.frequency.clone());
    let mut hazard = hazard.over(summary.site.floor);
    recall(dir, &summary.identity, summary.identity.releases, &mut hazard)?;
    let infos: Vec<LineInfo> = summary.lines.iter().map(|line| line.info.clone()).collect();
    let mut lines = self::lines(&infos, asked, summary.identity.releases);
    recall_lines(dir, &mut lines, None)?;
    let nets: Vec<Barrier> = summary.barriers.iter().map(|one| one.barrier.clone()).collect();
    let open = tell_lines(dir, &hazard, &mut lines, (&infos, &nets))?;
    check_files(dir, &summary.bytes)?;
    Ok(Results { dir: dir.to_owned(), summary, hazard, lines, open, lock: None })
}

impl Results {
    /// The lines and objects of the scene, its barriers among them: not the other places of barriers.
    pub fn lines_of_scene(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().filter(|line| !line.info.of_barrier)
    }

    /// The results of a finished run in the folder `dir`.
    ///
    /// # Errors
    /// As [`read`].
    pub fn read(dir: &Path) -> Result<Self> {
        read(dir)
    }

    /// Whether what rocks cross under a name is an object, which they hit; else it is a line.
    pub fn is_object(&self, name: &str) -> bool {
        self.summary.asked.objects.iter().any(|object| object.name == name)
    }

    /// Statistics of one quantity over all rocks: percentiles and mean with their 95 % intervals, in SI units.
    pub fn statistic(&self, quantity: Quantity) -> Statistic {
        self.hazard.statistic(quantity)
    }

    /// All first crossings of the evaluation line, barrier or object of this name; none if there is none.
    pub fn line(&self, name: &str) -> Option<&Line> {
        self.lines.iter().find(|line| line.info.name == name)
    }

    /// What each barrier stops, in the order of the scene.
    pub fn barriers(&self) -> &[BarrierSummary] {
        &self.summary.barriers
    }

    /// One of the maps, in map coordinates; none where the scene asks for none.
    ///
    /// # Errors
    /// If its file cannot be read or understood.
    pub fn map(&self, layer: Layer) -> Result<Option<Grid>> {
        let path = self.dir.join(super::maps::FOLDER).join(layer.file()).with_extension("asc");
        match (self.summary.maps.is_some(), path.exists()) {
            (true, true) => Grid::read(&path).map(Some),
            // every run with maps has this one; results of an earlier version lack the newer layers
            (true, false) if layer == Layer::Reach => {
                let found = "the run has written this map, and it is not there";
                Err(Error::input(&path, "file", found, RESTORE))
            }
            _ => Ok(None),
        }
    }

    /// One of the maps of a year by the name of its file without ending; none where it was not asked for.
    ///
    /// # Errors
    /// If its file cannot be read or understood.
    pub fn year_map(&self, name: &str) -> Result<Option<Grid>> {
        let folder = self.dir.join(super::maps::FOLDER);
        // names hold points: with_extension would cut them
        let [text, image] = ["asc", "tif"].map(|ending| folder.join(format!("{name}.{ending}")));
        if text.exists() {
            return Grid::read(&text).map(Some);
        }
        let image = image.exists().then(|| geotiff::read(&image, None, None)).transpose()?;
        Ok(image.map(|raster| raster.grid))
    }

    /// The kept path of one release, in the order of time; empty if it kept none.
    ///
    /// # Errors
    /// As [`Self::rows`].
    pub fn path(&self, release: usize) -> Result<Vec<PathRow>> {
        let is_its = |row: &Result<PathRow>| row.as_ref().map_or(true, |row| row.index == release);
        self.paths()?.filter(is_its).collect()
    }

    /// The rows of `releases.csv`, one by one.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or has other columns; each row says for itself if it cannot be understood.
    pub fn rows(&self) -> Result<impl Iterator<Item = Result<Row>>> {
        releases(&self.dir)
    }

    /// The rows of `paths.csv`, one by one, in the order of releases and of time; none if no path was kept.
    ///
    /// # Errors
    ///
    /// As [`Self::rows`]; each row also if it holds no finite number, or is not in this order.
    pub fn paths(&self) -> Result<impl Iterator<Item = Result<PathRow>>> {
        let path = self.dir.join(PATHS);
        let rows = if_there(path.clone(), (&PathRow::COLUMNS, &[&PathRow::SHAPE_COLUMNS]))?;
        Ok(PathRow::checked(path, rows))
    }

    /// How many rows `paths.csv` has at most: its lines. Quickly counted, where nothing of them need be known.
    ///
    /// # Errors
    /// The file is there but cannot be read.
    pub fn path_points(&self) -> Result<usize> {
        let path = self.dir.join(PATHS);
        let open = match File::open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(0),
            open => open.map_err(Error::file("read", &path))?,
        };
        let (mut file, mut lines) = (BufReader::new(open), 0);
        while file.skip_until(b'\n').map_err(Error::file("read", &path))? > 0 {
            lines += 1;
        }
        Ok(lines)
    }

    /// Writes the vectors of `maps/`: ends, what stands on the map, and paths where they were kept.
    pub(super) fn write_vectors(&self) -> Result<()> {
        let (folder, epsg) =
            (self.dir.join(super::maps::FOLDER), self.summary.maps.and_then(|maps| maps.epsg));
        vector::write_ends(&folder.join("ends.geojson"), epsg, self.rows()?)?;
        vector::write_site(&folder, epsg, &self.summary)?;
        if self.dir.join(PATHS).exists() {
            let rocks = self.rows()?;
            vector::write_paths(&folder.join("paths.geojson"), epsg, (self.paths()?, rocks))?;
            let origin_m = self.summary.site.mesh_origin_m;
            vector::write_vtk(&folder.join("paths.vtk"), origin_m, self.paths()?)?;
        }
        Ok(())
    }

    /// The rows of `crossings.csv`, one by one, in the order of releases and of lines; none without lines.
    ///
    /// # Errors
    ///
    /// As [`Self::rows`].
    pub fn crossings(&self) -> Result<impl Iterator<Item = Result<CrossingRow>>> {
        crossings(&self.dir)
    }

    /// The rows of `impacts.csv`, one by one, in the order of releases and of time; none if no impact was kept.
    ///
    /// # Errors
    ///
    /// As [`Self::rows`].
    pub fn impacts(&self) -> Result<impl Iterator<Item = Result<ImpactRow<'static>>>> {
        if_there(self.dir.join(IMPACTS), (&ImpactRow::COLUMNS, &[&ImpactRow::SOIL_COLUMNS]))
    }
}

/// Lines without crossings, whose rocks weigh what they stand for.
pub(super) fn lines(infos: &[LineInfo], asked: &AnnualRequest, releases: usize) -> Vec<Line> {
    let weights = asked.frequency.as_ref().map(|one| one.weights(releases));
    infos.iter().map(|info| Line::new(info.clone()).weighing(weights.clone())).collect()
}

/// The rows of `crossings.csv` in `dir`.
pub(super) fn crossings(dir: &Path) -> Result<impl Iterator<Item = Result<CrossingRow>> + use<>> {
    if_there(dir.join(CROSSINGS), CROSSING_COLUMNS)
}

/// Adds the crossings in `dir` to their lines and to the year.
pub(super) fn recall_lines(
    dir: &Path,
    lines: &mut [Line],
    mut year: Option<&mut YearSums>,
) -> Result<()> {
    if lines.is_empty() {
        return Ok(());
    }
    let mut unknown = None;
    by_rock(table::rows::<CrossingRow>(dir.join(CROSSINGS), CROSSING_COLUMNS)?, |rock| {
        for row in rock.iter() {
            match lines.iter_mut().find(|line| line.info.name == row.line) {
                Some(line) => line.add(row),
                None => unknown = Some(row.line.clone()),
            }
        }
        if let Some(year) = &mut year {
            year.add(rock);
        }
    })?;
    let Some(line) = unknown else { return Ok(()) };
    let remedy = format!("it must agree with {SUMMARY}: restore it, or run again with --overwrite");
    Err(Error::input(&dir.join(CROSSINGS), "rows", format!("the line {line}"), remedy))
}

/// Tells all lines, now that all rocks have come, what each stands for and which may still come to them.
pub(super) fn tell_lines(
    dir: &Path,
    hazard: &Hazard,
    lines: &mut [Line],
    (infos, nets): (&[LineInfo], &[Barrier]),
) -> Result<OpenRocks> {
    let weights = hazard.year_weights();
    let rocks = hazard.open_rocks().to_vec();
    let open = OpenRocks::find(rocks, (infos, stopping(nets)), crossings(dir)?)?;
    for line in lines {
        line.weigh(weights.as_ref());
        line.leave_open(open.at(&line.info.name));
    }
    Ok(open)
}

/// Adds the rocks of all `done` rows, which must be the first releases asked for, in order, and no more.
pub(super) fn recall(
    dir: &Path,
    identity: &Identity,
    done: usize,
    hazard: &mut Hazard,
) -> Result<()> {
    let before = hazard.rocks();
    for row in releases(dir)? {
        let row = row?;
        let expected = identity.first_release + hazard.rocks() - before;
        if row.index != expected {
            return Err(broken(
                dir,
                format!("release {} where {expected} should stand", row.index),
            ));
        }
        hazard.add(&row);
    }
    match hazard.rocks() - before {
        rows if rows == done => Ok(()),
        rows => Err(broken(dir, format!("{rows} rows instead of {done}"))),
    }
}

/// Every file must be as it was when the run was finished: tables have their lengths, and all that have checksums those.
pub(super) fn check_files(dir: &Path, written: &BTreeMap<String, u64>) -> Result<()> {
    check_lengths(dir, written)?;
    checksum::check_all(dir)
}

/// Every table must be as long as when the run was finished.
fn check_lengths(dir: &Path, written: &BTreeMap<String, u64>) -> Result<()> {
    for (name, written) in written {
        let path = dir.join(name);
        let found = length(&path)?;
        if found != *written {
            return Err(Error::input(
                &path,
                "length",
                format!("found {} where the run had written {written}", number_of(found, "byte")),
                RESTORE,
            ));
        }
    }
    Ok(())
}

fn releases(dir: &Path) -> Result<impl Iterator<Item = Result<Row>> + use<>> {
    table::rows(dir.join(RELEASES), (&Row::COLUMNS, RELEASE_GROUPS))
}

/// Columns of releases that some scenes have. A row of statistics has no place for the last ones: what a class is stands in the summary.
const RELEASE_GROUPS: &[&[&str]] = &[&Row::SHAPE_COLUMNS, &Row::SOIL_COLUMNS, &CLASS_COLUMNS];

const CROSSING_COLUMNS: table::Columns = (&CrossingRow::COLUMNS, &[&CrossingRow::SHAPE_COLUMNS]);

fn if_there<R: serde::de::DeserializeOwned>(
    path: PathBuf,
    columns: table::Columns,
) -> Result<impl Iterator<Item = Result<R>>> {
    let there = path.exists().then(|| table::rows(path, columns)).transpose()?;
    Ok(there.into_iter().flatten())
}

fn broken(dir: &Path, found: String) -> Error {
    let remedy = format!(
        "it must agree with {SUMMARY} or {PROGRESS}: restore it, or run again with --overwrite"
    );
    Error::input(&dir.join(RELEASES), "rows", found, remedy)
}
