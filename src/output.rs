//! Results on the disk: tables that grow chunk by chunk, and a summary at the end.
//!
//! A chunk's rows are on the disk before `progress.json` says so, in one stroke; whatever a crash leaves
//! behind that mark is cut off when the run is resumed. So a resumed run writes the same bytes as an
//! uninterrupted one, and a crash or a full disk loses at most the current chunk.

mod annual;
mod calibration;
mod checksum;
mod lock;
mod folder;
mod journeys;
mod maps;
mod mark;
mod merge;
mod opened;
mod progress;
mod read;
mod releases;
mod removal;
mod rows;
mod site;
mod summary;
mod table;
mod used;
mod vector;
mod atomic_file;

pub use crate::file::write_atomic;
pub use calibration::{read_calibration, write_calibration};
pub use checksum::add_checksums;
pub use folder::{Mode, announce_figures, check_folder, check_writable, releases_in};
pub use lock::FolderLock;
pub use merge::merge;
pub use progress::Identity;
pub use read::{Results, read};
pub use rows::{ImpactRow, PathRow};
pub use site::{ReleaseZone, Site};
pub use summary::{RunTimes, Summary};
pub use used::{copy_used, write_drawings, write_ground};
pub use vector::write_terrain;

use crate::error::{Error, Result};
use crate::frequency::Weights;
use crate::hazard::{
    self, Annual, AnnualRequest, Barrier, CrossingRow, Hazard, Line, LineInfo, MapFrame, Maps,
    ObservedPath, YearSums,
};
use crate::plan::PlanEntry;
use crate::rock::Vec3;
use crate::scene::Language;
use crate::simulation::Trajectory;
use opened::{open, open_maps};
use progress::PROGRESS;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use table::CsvTable;

const RELEASES: &str = "releases.csv";
const PATHS: &str = "paths.csv";
const IMPACTS: &str = "impacts.csv";
const CROSSINGS: &str = "crossings.csv";
const TABLES: [&str; 4] = [RELEASES, PATHS, IMPACTS, CROSSINGS];

/// What the results need to know of a plan.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each says of another file whether it is there")]
pub struct RunInfo {
    /// Title of the scene.
    pub title: String,
    /// What decides every byte of the results.
    pub identity: Identity,
    /// Map position of the local (0, 0, 0) (m): added to every position written.
    pub origin_m: Vec3,
    /// Where meshes and releases lie.
    pub site: Site,
    /// Name of the ground of each mesh, in the order of [`Terrain::sheets`](crate::terrain::Terrain).
    pub ground_of_sheet: Vec<String>,
    /// Evaluation lines, in the order of the scene; none leaves `crossings.csv` out.
    pub lines: Vec<LineInfo>,
    /// Where the maps lie; none leaves them out.
    pub maps: Option<MapFrame>,
    /// Length of the stretches of the profile (m).
    pub profile_step_m: f64,
    /// Barriers; each on the line of its name.
    pub barriers: Vec<Barrier>,
    /// What is asked of the year: sources, objects, classes of hazard.
    pub asked: AnnualRequest,
    /// Measured ways to compare with; none if the scene names none.
    pub observed: Vec<ObservedPath>,
    /// Independent ends that they are worth (–).
    pub observed_worth: Option<f64>,
    /// Least runout of a computed rock that is compared with them (m); none compares all.
    pub observed_least_runout_m: Option<f64>,
    /// Whether `paths.csv` is written.
    pub keeps_paths: bool,
    /// Whether `impacts.csv` is written.
    pub keeps_impacts: bool,
    /// Whether some rocks have shapes: the tables then say how they are turned.
    pub has_blocks: bool,
    /// Whether some grounds have a scar layer: the tables then say what its drag takes.
    pub has_scars: bool,
    /// Whether `merge` is to put it together with others, were it the only one.
    pub is_shard: bool,
    /// Worker threads.
    pub threads: usize,
    /// The plan: what is computed, what is left out and why.
    pub plan: Vec<PlanEntry>,
    /// What went in, as name and value.
    pub inputs: Vec<(String, String)>,
    /// Rows of the title block.
    pub title_block: Vec<(String, String)>,
    /// Where terrain and ground values come from, in words.
    pub sources: [String; 2],
    /// In which language page and figures speak.
    pub language: Language,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Health of the meshes.
    pub mesh_health: serde_json::Value,
}

/// Results being written.
#[derive(Debug)]
pub struct Output {
    lock: FolderLock,
    dir: PathBuf,
    info: RunInfo,
    releases: CsvTable,
    /// Whether its rows tell the class of a rock.
    tells_class: bool,
    paths: Option<CsvTable>,
    impacts: Option<CsvTable>,
    crossings: Option<CsvTable>,
    hazard: Hazard,
    lines: Vec<Line>,
    /// What rocks do a year; none without sources, and none of a part of a run.
    year: Option<YearSums>,
    /// None also when they are complete already.
    maps: Option<Maps>,
    begun: Instant,
    /// Time that earlier sessions took (s).
    seconds_before: f64,
    /// When the last mark was set, and how long that took; none while all is marked.
    marked: (Instant, Duration),
    is_marked: bool,
}

/// Cells of maps above which their state is not put on the disk after every chunk.
const MANY_CELLS: usize = 50_000;
/// With so many cells, time between two marks over the time that one takes (–).
const MARK_SHARE: u32 = 20;

impl Output {
    /// Opens the folder `dir`, which is made if it is not there, for the run described by `info`.
    ///
    /// # Errors
    ///
    /// If the folder holds results that `mode` does not allow to touch, cannot be written, or is in use.
    pub fn create(info: RunInfo, dir: &Path, mode: Mode) -> Result<Self> {
        // looked at before it is touched: a folder that is refused stays as it is
        folder::look(dir, &info, mode)?;
        let mut lock = FolderLock::on(dir)?;
        let found = folder::prepare(dir, (&info, mode), &mut lock)?;
        let found = mark::unchanged(dir, found)?;
        let before = found.as_ref();
        let columns = |plain: &[&'static str], more: &[&'static str]| {
            [plain, if info.has_blocks { more } else { &[] }].concat()
        };
        let scars = |names: &'static [&'static str]| if info.has_scars { names } else { &[] };
        let of_release = releases::columns(dir, &info, before.is_some())?;
        let of_impact = [&ImpactRow::COLUMNS, scars(&ImpactRow::SOIL_COLUMNS)].concat();
        let releases = open(dir, RELEASES, &of_release, before)?;
        let of_path = columns(&PathRow::COLUMNS, &PathRow::SHAPE_COLUMNS);
        let paths = info.keeps_paths.then(|| open(dir, PATHS, &of_path, before)).transpose()?;
        let impacts =
            info.keeps_impacts.then(|| open(dir, IMPACTS, &of_impact, before)).transpose()?;
        let of_crossing = columns(&CrossingRow::COLUMNS, &CrossingRow::SHAPE_COLUMNS);
        let crossings = (!info.lines.is_empty())
            .then(|| open(dir, CROSSINGS, &of_crossing, before))
            .transpose()?;
        let mut lines = read::lines(&info.lines, &info.asked, info.identity.releases);
        let is_part = info.is_shard || info.identity.is_part();
        let year = YearSums::new(&info.asked, &info.lines, &info.barriers);
        let mut year = year.filter(|_| !is_part);
        if found.is_some() {
            read::recall_lines(dir, &mut lines, year.as_mut())?;
        }
        let maps = open_maps(dir, &info, found.as_ref())?;
        let seconds_before = found.as_ref().map_or(0.0, |found| found.seconds);
        let hazard = Hazard::default().weighing(info.asked.frequency.clone());
        let mut hazard = hazard.over(info.site.floor);
        // finished results are whole: nothing is marked, and what follows changes none of their rows
        let mut is_marked = false;
        if let Some(found) = found {
            hazard.totals = found.totals;
            read::recall(dir, &info.identity, found.done, &mut hazard)?;
            is_marked = !found.finished.is_empty() && found.done == info.identity.releases;
            lock.keep();
        }
        let dir = dir.to_owned();
        let begun = Instant::now();
        let mut output = Self {
            lock,
            dir,
            info,
            releases,
            tells_class: of_release.ends_with(&releases::CLASS_COLUMNS),
            paths,
            impacts,
            crossings,
            hazard,
            lines,
            year,
            maps,
            begun,
            seconds_before,
            marked: (begun, Duration::ZERO),
            is_marked,
        };
        output.keep()?;
        Ok(output)
    }

    /// Release numbers still to be computed.
    pub fn remaining(&self) -> Range<usize> {
        let asked = self.info.identity.range();
        asked.start + self.hazard.rocks()..asked.end
    }

    /// All rocks written so far, those of an interrupted run included.
    pub fn hazard(&self) -> &Hazard {
        &self.hazard
    }

    /// Writes the next journeys, which must be the first of [`Self::remaining`], in order; when it returns they
    /// are on the disk, unless fine maps are drawn, see [`Self::keep`].
    ///
    /// # Errors
    ///
    /// If the disk is full or the folder has gone; everything up to the write before stays good.
    ///
    /// # Panics
    ///
    /// If the journeys are not those: a mistake of the caller that would spoil the results.
    pub fn write(&mut self, falls: &[Trajectory]) -> Result<()> {
        for fall in falls {
            assert_eq!(fall.index, self.remaining().start, "journeys must be written in order");
            let row = self.write_release(fall)?;
            self.write_path(fall)?;
            self.write_impacts(fall)?;
            self.write_crossings(fall)?;
            let frequency = self.info.asked.frequency.as_ref();
            let stratum = frequency.map_or(0, |one| one.stratum_of(row.index)) as u16;
            if let Some(maps) = &mut self.maps {
                maps.add(stratum, &fall.passages, (row.stop, row.end_m));
            }
            self.hazard.add(&row);
            self.hazard.totals.add(fall);
            if row.stop.is_released() {
                let profile = &mut self.hazard.totals.profile;
                profile.add(self.info.profile_step_m, stratum, &fall.stretches);
            }
        }
        self.is_marked = false;
        let (last, took) = self.marked;
        let many = self.maps.as_ref().is_some_and(|maps| maps.known_cells() > MANY_CELLS);
        if many && last.elapsed() < took * MARK_SHARE {
            return Ok(());
        }
        self.keep()
    }

    /// Puts on the disk what [`Self::write`] has not yet: with fine maps it does so only now and then, because their
    /// state is as long as they are.
    ///
    /// # Errors
    ///
    /// As [`Self::write`].
    pub fn keep(&mut self) -> Result<()> {
        if self.is_marked {
            return Ok(());
        }
        let begun = Instant::now();
        self.mark()?;
        self.marked = (Instant::now(), begun.elapsed());
        self.is_marked = true;
        if self.hazard.rocks() > 0 {
            self.lock.keep();
        }
        Ok(())
    }

    /// Writes the summary and gives the results as they are on the disk. Of a part of a run the progress stays:
    /// it holds what `merge` needs.
    ///
    /// # Errors
    ///
    /// If releases remain: the message says how far the run came and how to go on. If the disk is full.
    pub fn finish(mut self) -> Result<Results> {
        let left = self.remaining().len();
        if left > 0 {
            let (done, all) = (self.hazard.rocks(), self.info.identity.releases);
            let dir = self.dir.display();
            return Err(Error::Request(format!(
                "{dir}: {done} of {all} releases are written; go on with --resume"
            )));
        }
        let seconds = self.seconds();
        let is_part = self.info.is_shard || self.info.identity.is_part();
        self.lock.keep();
        let (bytes, mut sums) = self.ends()?;
        let year_weights = self.hazard.year_weights();
        let (nets, lines) = (&self.info.barriers, &self.info.lines);
        let open = read::tell_lines(&self.dir, &self.hazard, &mut self.lines, (lines, nets))?;
        let weights = self.hazard.weights_or_equal();
        if let Some(maps) = &self.maps {
            let weights = year_weights.as_ref().unwrap_or(&weights);
            // of a part of a run no number a year can be told
            maps::write(&self.dir, maps, (&self.info.asked, weights), is_part)?;
        }
        let crossings = read::crossings(&self.dir)?;
        let barriers = hazard::judge(nets, crossings, (&weights, &open))?;
        let crossings = read::crossings(&self.dir)?;
        let residual = hazard::residual(nets, lines, crossings, (&weights, &open))?;
        if let Some(year) = &mut self.year {
            year.leave_open(&open);
        }
        let annual = self.annual(year_weights)?;
        let mut summary = Summary::new(self.info, (&self.hazard, &self.lines), seconds);
        (summary.barriers, summary.residual, summary.annual) = (barriers, residual, annual);
        (summary.bytes, summary.map_bytes) = (bytes, maps::lengths(&self.dir));
        checksum::add(&self.dir, &mut sums, summary.map_bytes.keys().map(String::as_str))?;
        summary.write(&self.dir)?;
        checksum::write(&self.dir, &sums)?;
        self.hazard.totals = summary.totals.clone();
        let results = Results {
            dir: self.dir,
            summary,
            hazard: self.hazard,
            lines: self.lines,
            open,
            lock: Some(self.lock),
        };
        if results.summary.maps.is_some() {
            results.write_vectors()?;
        }
        folder::remove_parts(&results.dir)?;
        // a part keeps what putting parts together needs
        if !is_part {
            removal::remove(&results.dir.join(PROGRESS))?;
            maps::keep_state(&results.dir, None)?;
        }
        Ok(results)
    }

    /// What a year brings, of all rocks that were released.
    fn annual(&self, weights: Option<Weights>) -> Result<Option<Annual>> {
        let annual = self.year.as_ref().zip(weights).map(|(year, weights)| year.said(weights));
        annual.as_ref().map_or(Ok(()), |annual| annual::write(&self.dir, annual))?;
        Ok(annual)
    }
}
