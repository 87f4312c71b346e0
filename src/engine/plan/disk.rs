//! What the files of a run may take of the disk, estimated before it begins.

use super::{MapGrid, Part, Paths, Plan};

/// A row of `releases.csv` (bytes).
const ROW: f64 = 660.0;
/// A row of `impacts.csv` (bytes), and how many a rock has: 50 to 82 on slopes of 50 m and of 1 km.
const IMPACT: f64 = 145.0;
const IMPACTS_A_ROCK: f64 = 80.0;
/// A row of `crossings.csv` (bytes).
const CROSSING: f64 = 256.0;
/// A point of a path in `paths.csv` (bytes), the longer of two that blocks have; in `maps/paths.vtk`, and in `maps/paths.geojson`.
const POINT: f64 = 220.0;
const TURNED_POINT: f64 = 280.0;
const VTK_POINT: f64 = 130.0;
const GEOJSON_POINT: f64 = 98.0;
/// The same in `view.glb`, of spheres and of blocks, which have attitudes too.
const GLB_POINT: f64 = 19.0;
const GLB_TURNED_POINT: f64 = 42.0;
/// An end in `maps/ends.geojson` (bytes).
const END: f64 = 330.0;
/// A triangle in `maps/terrain.vtk` (bytes).
const TRIANGLE: f64 = 36.2;
/// A cell in all layers of the maps (bytes), and in a layer of a year, which has up to four beside it (bytes).
const CELL: f64 = 60.0;
const CELL_OF_YEAR: f64 = 24.0;
/// A cell in the grids of the ground (bytes), and of how many the longer side has, at least and at most.
const GROUND_CELL: f64 = 14.0;
const GROUND_CELLS: [f64; 2] = [400.0, 2000.0];
/// Page, view and figures (bytes); a triangle in the view (bytes), which shows no more than so many.
const PAGE: f64 = 2.6e6;
const SHOWN_TRIANGLE: f64 = 12.0;
const MOST_SHOWN_TRIANGLES: f64 = 1e6;
/// A rock that goes down a slope gains so much speed on the whole (m/s²): by it the time of fall over the terrain's diagonal, 9.5 s for
/// 90 m and 35 s for 1.4 km.
const GAIN_M_S2: f64 = 2.0;
/// Files that are named.
const NAMED: usize = 3;

/// What one file takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FileSize {
    /// Its name.
    name: &'static str,
    /// About so much (bytes).
    about: f64,
    /// The most, where something bounds it (bytes).
    most: Option<f64>,
}

impl FileSize {
    fn about(name: &'static str, about: f64) -> Self {
        Self { name, about, most: None }
    }
}

/// What all files take: about so much, more where rocks strike the ground more often than others do.
#[derive(Debug, Clone, PartialEq)]
pub struct DiskUse {
    /// The largest first.
    files: Vec<FileSize>,
}

impl DiskUse {
    /// All of them (bytes).
    pub fn about(&self) -> f64 {
        self.files.iter().map(|file| file.about).sum()
    }

    /// The same, if all rocks fall until their time is up and cross all lines (bytes).
    pub fn most(&self) -> f64 {
        self.files.iter().map(|file| file.most.unwrap_or(file.about)).sum()
    }

    /// The largest files, each with what it takes.
    pub(super) fn largest(&self, size: impl Fn(f64) -> String) -> String {
        let said = |file: &FileSize| match file.most {
            Some(most) if size(most) != size(file.about) => {
                format!("{} {} (≤ {})", file.name, size(file.about), size(most))
            }
            _ => format!("{} {}", file.name, size(file.about)),
        };
        self.files.iter().take(NAMED).map(said).collect::<Vec<_>>().join(", ")
    }
}

impl Plan {
    /// What so many of its releases write.
    pub(super) fn disk_use(&self, releases: f64) -> DiskUse {
        let mut files = vec![
            FileSize::about("releases.csv", ROW * releases),
            FileSize::about("report.html", self.page()),
            FileSize::about("maps/ground.asc", GROUND_CELL * self.ground_cells()),
        ];
        if self.impacts.is_kept() {
            files.push(FileSize::about("impacts.csv", IMPACT * IMPACTS_A_ROCK * releases));
        }
        if let Some(lines) = self.lines.kept() {
            let most = CROSSING * releases * lines.len() as f64;
            files.push(FileSize { name: "crossings.csv", about: most, most: Some(most) });
        }
        files.extend(
            self.paths.kept().into_iter().flat_map(|paths| self.path_files(*paths, releases)),
        );
        files.extend(self.maps.kept().into_iter().flat_map(|map| self.map_files(map, releases)));
        files.sort_by(|a, b| b.about.total_cmp(&a.about));
        DiskUse { files }
    }

    fn path_files(&self, paths: Paths, releases: f64) -> Vec<FileSize> {
        let points = |time_s: f64| releases.min(paths.first as f64) * (time_s / paths.step_s + 2.0);
        let [about, most] = [self.time_of_fall_s(), self.longest_s].map(points);
        let [point, of_view] = if self.releases.has_blocks() {
            [TURNED_POINT, GLB_TURNED_POINT]
        } else {
            [POINT, GLB_POINT]
        };
        let mut files = vec![("paths.csv", point), ("view.glb", of_view)];
        if self.maps.is_kept() {
            files.extend([("maps/paths.vtk", VTK_POINT), ("maps/paths.geojson", GEOJSON_POINT)]);
        }
        let size =
            |(name, bytes)| FileSize { name, about: bytes * about, most: Some(bytes * most) };
        files.into_iter().map(size).collect()
    }

    fn map_files(&self, map: &MapGrid, releases: f64) -> [FileSize; 3] {
        let of_year = match &self.year {
            Part::Kept(year) => year.map_layers(),
            Part::LeftOut(_) => 0.0,
        };
        let cells = f64::from(map.columns) * f64::from(map.rows);
        [
            FileSize::about("maps/terrain.vtk", TRIANGLE * self.terrain.triangles.len() as f64),
            FileSize::about("maps/ends.geojson", END * releases),
            FileSize::about("maps", (CELL + CELL_OF_YEAR * of_year) * cells),
        ]
    }

    fn page(&self) -> f64 {
        PAGE + SHOWN_TRIANGLE * (self.terrain.triangles.len() as f64).min(MOST_SHOWN_TRIANGLES)
    }

    /// Cells of the grid of the ground: about as many as pairs of triangles.
    fn ground_cells(&self) -> f64 {
        let [a, b, _] = self.sides_m();
        let along = |cells: f64| cells * cells * (a.min(b) / a.max(b));
        let [fewest, most] = GROUND_CELLS.map(along);
        (0.5 * self.terrain.triangles.len() as f64).min(most).max(fewest)
    }

    fn time_of_fall_s(&self) -> f64 {
        let [a, b, c] = self.sides_m();
        (2.0 * (a * a + b * b + c * c).sqrt() / GAIN_M_S2).sqrt().min(self.longest_s)
    }

    /// Sides of the box around the terrain (m).
    fn sides_m(&self) -> [f64; 3] {
        let (low, high) = self.terrain.index.bounds();
        (high - low).into()
    }
}
