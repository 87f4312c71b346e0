//! What is watched along every rock's way: evaluation lines and the cells of maps, in local coordinates.

use crate::error::{Error, Result};
use crate::math;
use crate::release::{self, Release};
use crate::rock::Vec3;
use crate::scene::{Corner, MapsTable, ObjectTable, Polyline, Scene};
use crate::terrain::Terrain;
use std::path::Path;

/// An evaluation line: the upright surface over a polyline on the map, of any height. Or an object, which has a footprint.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationLine {
    /// Name in the results.
    pub name: String,
    /// Its straight pieces, one behind the other.
    pub pieces: Vec<LinePiece>,
    /// Of an object; none of a line.
    pub footprint: Option<Footprint>,
    low_m: Corner,
    high_m: Corner,
}

/// What an object covers in plan view. A rock hits it when its rim comes over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Footprint {
    /// All within half the width (m) of the pieces.
    Strip {
        /// Half the width (m), 0 or more.
        half_width_m: f64,
    },
    /// The inside of the pieces, which close.
    Area,
}

/// A straight piece of an evaluation line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePiece {
    /// Its start (m, local).
    pub from_m: Corner,
    /// From its start to its end (m).
    pub way_m: Corner,
    /// Length of the line before it (m).
    pub along_m: f64,
}

impl LinePiece {
    /// Its length (m), positive.
    pub fn length_m(&self) -> f64 {
        math::hypot(self.way_m[0], self.way_m[1])
    }

    /// Distance of a point from the line through the piece (m), positive on its left.
    pub fn side_m(&self, at_m: Corner) -> f64 {
        let (x, y) = (at_m[0] - self.from_m[0], at_m[1] - self.from_m[1]);
        (self.way_m[0] * y - self.way_m[1] * x) / self.length_m()
    }

    /// How far along the piece a point lies (–): 0 at its start, 1 at its end.
    pub fn share(&self, at_m: Corner) -> f64 {
        let (x, y) = (at_m[0] - self.from_m[0], at_m[1] - self.from_m[1]);
        let [dx, dy] = self.way_m;
        (x * dx + y * dy) / (dx * dx + dy * dy)
    }
}

/// Lines of the scene, its barriers and the other places of these.
///
/// # Errors
/// A line that comes nowhere near the terrain: no rock would ever cross it.
pub(super) fn evaluation_lines(scene: &Scene, terrain: &Terrain) -> Result<Vec<EvaluationLine>> {
    let (low, high) = terrain.index.bounds();
    let near = |name: &str, line: &Polyline| {
        let line = EvaluationLine::new(name, line, terrain.origin_m);
        line.is_near([low.x, low.y], [high.x, high.y]).then_some(line)
    };
    // a forgotten map origin, most likely
    let refused = |table: &str, name: &str| {
        let place = format!("[[{table}]] \"{name}\" points_m");
        Error::input(&scene.file, place, "found no terrain near it", release::outside(terrain))
    };
    let mut all = Vec::new();
    for line in &scene.lines {
        let found = near(&line.name, &line.points_m);
        all.push(found.ok_or_else(|| refused("lines", &line.name))?);
    }
    for barrier in &scene.barriers {
        let found = near(&barrier.name, &barrier.points_m);
        all.push(found.ok_or_else(|| refused("barriers", &barrier.name))?);
    }
    for barrier in &scene.barriers {
        for (offset_m, name, line) in barrier.elsewhere() {
            let place = format!("[[barriers]] \"{}\" offsets_m", barrier.name);
            let found = format!("found {offset_m}, where there is no terrain near the line");
            let remedy = "write distances that stay on the slope";
            all.push(
                near(&name, &line)
                    .ok_or_else(|| Error::input(&scene.file, place, found, remedy))?,
            );
        }
    }
    Ok(all)
}

/// Says which lines cross themselves: mostly corners in a wrong order. Roads may pass over themselves, so objects are not asked.
pub(super) fn crossing_themselves(scene: &Scene) -> Vec<String> {
    let lines = scene.lines.iter().map(|line| (&line.name, &line.points_m));
    let barriers = scene.barriers.iter().map(|barrier| (&barrier.name, &barrier.points_m));
    let said = |(name, line): (&String, &Polyline)| {
        let (one, other) = line.first_crossing()?;
        let (one, other) = (one + 1, other + 1);
        Some(format!(
            "line “{name}”: its pieces from corner {one} and corner {other} cross; a rock counts once, where it crosses first. Write the corners in order if the line is not meant so"
        ))
    };
    lines.chain(barriers).filter_map(said).collect()
}

/// Length of the pieces of a line of which it is asked whether there is ground below (m), and how many of a long line.
const ASKED: (f64, f64) = (1.0, 2000.0);
/// Of a line no more than this share may have no ground below without being said (–): ends may reach over the slope's brim.
const BESIDE: f64 = 0.1;

/// Says which lines lie beside the terrain in a large part: what would come there is not computed.
pub(super) fn beside_the_terrain(lines: &[EvaluationLine], terrain: &Terrain) -> Vec<String> {
    let said = |line: &EvaluationLine| {
        let pieces = line.cut(ASKED.0.max(line.length_m() / ASKED.1));
        let lacks = |ends: &&[Corner; 2]| terrain.lowest_along(**ends).is_none();
        let length_m = |[from, to]: &[Corner; 2]| math::hypot(to[0] - from[0], to[1] - from[1]);
        let beside_m: f64 = pieces.iter().filter(lacks).map(length_m).sum();
        (beside_m > BESIDE * line.length_m()).then(|| {
            format!(
                "line “{}”: {beside_m:.0} of its {:.0} m have no ground below; what comes there is not computed, and its numbers hold for the rest",
                line.name,
                line.length_m()
            )
        })
    };
    lines.iter().filter_map(said).collect()
}

/// A release lies on a line up to this far from it (m): what rounding makes of places that are drawn on it.
const ON_LINE_M: f64 = 1e-6;

/// Says on which lines the first releases lie: they do not cross these by standing there, whichever side rounding puts them on.
pub(super) fn below_releases(tried: &[Release], lines: &[EvaluationLine]) -> Vec<String> {
    let on_line = Footprint::Strip { half_width_m: ON_LINE_M };
    let said = |line: &EvaluationLine| {
        let is_on = |release: &&Release| {
            let at = release.motion.position_m;
            line.gap_m(on_line, [at.x, at.y]).0 <= 0.0
        };
        let on = tried.iter().filter(is_on).count();
        (on > 0).then(|| {
            format!(
                "{on} of {} releases tried out lie on the line “{}” before they move: they do not cross it by that, and count only where they come back over it. Draw the line or the release elsewhere",
                tried.len(), line.name
            )
        })
    };
    lines.iter().filter(|line| line.footprint.is_none()).filter_map(said).collect()
}

impl EvaluationLine {
    /// The evaluation line over a line given in map coordinates.
    pub fn new(name: &str, line: &Polyline, origin_m: Vec3) -> Self {
        let local = |corner: &Corner| [corner[0] - origin_m.x, corner[1] - origin_m.y];
        let corners: Vec<Corner> = line.corners_m().iter().map(local).collect();
        let mut along_m = 0.0;
        let mut pieces = Vec::new();
        for pair in corners.windows(2) {
            let way_m = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            let piece = LinePiece { from_m: pair[0], way_m, along_m };
            along_m += piece.length_m();
            pieces.push(piece);
        }
        let extreme = |of: fn(f64, f64) -> f64, from: f64| {
            corners.iter().fold([from; 2], |end, c| [of(end[0], c[0]), of(end[1], c[1])])
        };
        let low_m = extreme(f64::min, f64::INFINITY);
        let high_m = extreme(f64::max, f64::NEG_INFINITY);
        Self { name: name.to_owned(), pieces, footprint: None, low_m, high_m }
    }

    /// The evaluation line over the footprint of an object.
    pub fn of_object(object: &ObjectTable, origin_m: Vec3) -> Self {
        let outline = object.polygon_m.as_ref().and_then(|area| {
            let corners = area.corners_m();
            let closed: Vec<Corner> = corners.iter().chain(corners.first()).copied().collect();
            Polyline::try_from(closed).ok()
        });
        let line = object.points_m.as_ref().or(outline.as_ref());
        let half_width_m = 0.5 * object.width_m.unwrap_or(0.0);
        let footprint = match object.polygon_m {
            Some(_) => Footprint::Area,
            None => Footprint::Strip { half_width_m },
        };
        // the scene's check has made sure that there is a line or an outline
        let empty = Self {
            name: object.name.clone(),
            pieces: Vec::new(),
            footprint: None,
            low_m: [f64::INFINITY; 2],
            high_m: [f64::NEG_INFINITY; 2],
        };
        let plain = line.map_or(empty, |line| Self::new(&object.name, line, origin_m));
        Self {
            footprint: Some(footprint),
            low_m: plain.low_m.map(|low| low - half_width_m),
            high_m: plain.high_m.map(|high| high + half_width_m),
            ..plain
        }
    }

    /// Distance in plan view of a point from an object's footprint (m), 0 or less over it; and where along its line or
    /// outline (m) it is nearest.
    pub fn gap_m(&self, footprint: Footprint, at_m: Corner) -> (f64, f64) {
        let to_piece = |piece: &LinePiece| {
            let share = piece.share(at_m).clamp(0.0, 1.0);
            let away = [0, 1].map(|k| at_m[k] - piece.from_m[k] - share * piece.way_m[k]);
            (math::hypot(away[0], away[1]), piece.along_m + share * piece.length_m())
        };
        let nearest = self.pieces.iter().map(to_piece).min_by(|a, b| a.0.total_cmp(&b.0));
        let (distance_m, along_m) = nearest.unwrap_or((f64::INFINITY, 0.0));
        let gap_m = match footprint {
            Footprint::Strip { half_width_m } => distance_m - half_width_m,
            Footprint::Area if self.encloses(at_m) => -distance_m,
            Footprint::Area => distance_m,
        };
        (gap_m, along_m)
    }

    /// Whether a point lies inside closed pieces: a ray to the east crosses an odd number of them.
    fn encloses(&self, [x, y]: Corner) -> bool {
        let crosses = |piece: &&LinePiece| {
            let ([x0, y0], [dx, dy]) = (piece.from_m, piece.way_m);
            (y0 > y) != (y0 + dy > y) && x < x0 + (y - y0) / dy * dx
        };
        self.pieces.iter().filter(crosses).count() % 2 == 1
    }

    /// Its pieces, cut into equal parts no longer than this (m, local).
    pub fn cut(&self, long_m: f64) -> Vec<[Corner; 2]> {
        let of_piece = |piece: &LinePiece| {
            let (from, way) = (piece.from_m, piece.way_m);
            let parts = (piece.length_m() / long_m).ceil().max(1.0);
            let at = move |k: u32| [0, 1].map(|axis| from[axis] + f64::from(k) / parts * way[axis]);
            (0..parts as u32).map(move |k| [at(k), at(k + 1)])
        };
        self.pieces.iter().flat_map(of_piece).collect()
    }

    /// Its length (m).
    pub fn length_m(&self) -> f64 {
        self.pieces.last().map_or(0.0, |last| last.along_m + last.length_m())
    }

    /// Its corners in map coordinates (m).
    pub fn corners_m(&self, origin_m: Vec3) -> Vec<Corner> {
        let end = self
            .pieces
            .last()
            .map(|last| [last.from_m[0] + last.way_m[0], last.from_m[1] + last.way_m[1]]);
        let corners = self.pieces.iter().map(|piece| piece.from_m).chain(end);
        corners.map(|[x, y]| [x + origin_m.x, y + origin_m.y]).collect()
    }

    /// Whether a box in plan view comes near enough to be looked at.
    #[inline]
    pub fn is_near(&self, low_m: Corner, high_m: Corner) -> bool {
        (0..2).all(|axis| low_m[axis] <= self.high_m[axis] && high_m[axis] >= self.low_m[axis])
    }

    /// How much a box in plan view may grow on all sides before it comes near (m); 0 or less where it is.
    pub fn apart_m(&self, low_m: Corner, high_m: Corner) -> f64 {
        let apart =
            |axis: usize| (low_m[axis] - self.high_m[axis]).max(self.low_m[axis] - high_m[axis]);
        apart(0).max(apart(1))
    }
}

/// The square cells of all maps. Cell 0 is the most south-western, its eastern neighbour is cell 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapGrid {
    /// Western edge (m, local).
    pub west_m: f64,
    /// Southern edge (m, local).
    pub south_m: f64,
    /// Side of a cell (m), positive.
    pub cell_m: f64,
    /// Number of columns.
    pub columns: u32,
    /// Number of rows.
    pub rows: u32,
}

/// Most cells of a map: what a raster file of 32-bit numbers holds without special formats.
const MOST_CELLS: f64 = 250e6;

impl MapGrid {
    /// Cells over the whole terrain, with edges at multiples of the cell on the map.
    ///
    /// # Errors
    /// A cell so small that there would be too many.
    pub fn over(terrain: &Terrain, asked: &MapsTable, scene: &Path) -> Result<Self> {
        let (low, high) = terrain.index.bounds();
        let origin = terrain.origin_m;
        let cell_m = asked.cell_m;
        let edge = |at: f64, origin: f64| ((at + origin) / cell_m).floor() * cell_m - origin;
        let (west_m, south_m) = (edge(low.x, origin.x), edge(low.y, origin.y));
        let count = |from: f64, to: f64| ((to - from) / cell_m).ceil().max(1.0);
        let (columns, rows) = (count(west_m, high.x), count(south_m, high.y));
        if columns * rows > MOST_CELLS {
            let found = format!("found {cell_m}, which gives {columns} x {rows} cells");
            // the last column and row may be begun anew
            let least = 1.001 * cell_m * (columns * rows / MOST_CELLS).sqrt();
            let remedy = format!("write {} or more", math::rounded_up(least));
            return Err(Error::input(scene, "[maps] cell_m", found, remedy));
        }
        Ok(Self { west_m, south_m, cell_m, columns: columns as u32, rows: rows as u32 })
    }

    /// A place in units of cells, from the south-western corner.
    #[inline]
    pub fn place(&self, x_m: f64, y_m: f64) -> [f64; 2] {
        [(x_m - self.west_m) / self.cell_m, (y_m - self.south_m) / self.cell_m]
    }

    /// The cell of a column and row; none outside.
    #[inline]
    pub fn cell(&self, column: i64, row: i64) -> Option<u32> {
        let inside = (0..i64::from(self.columns)).contains(&column)
            && (0..i64::from(self.rows)).contains(&row);
        inside.then(|| row as u32 * self.columns + column as u32)
    }
}

/// What is watched; nothing by default.
#[derive(Debug, Clone, Copy, Default)]
pub struct Recorders<'a> {
    /// Evaluation lines.
    pub lines: &'a [EvaluationLine],
    /// Cells of the maps.
    pub cells: Option<&'a MapGrid>,
    /// Length of the stretches of distance from the release in which speed and height are noted (m).
    pub profile_step_m: Option<f64>,
}

/// Stretches that the longest way over a terrain is parted into, at least.
const STRETCHES: f64 = 50.0;
/// And at most: a figure shows no more.
const MOST_STRETCHES: f64 = 1000.0;

/// The cells of a scene that asks for maps.
pub(super) fn map_grid(scene: &Scene, terrain: &Terrain) -> Result<Option<MapGrid>> {
    scene.maps.as_ref().map(|maps| MapGrid::over(terrain, maps, &scene.file)).transpose()
}

/// Way in plan view over the height of the terrain that hardly any rock exceeds (–): reach angles below 18° are those of rock avalanches.
const WAY_OVER_DROP: f64 = 3.0;

/// Length of the stretches of a profile (m): as the scene says, or a round part of the way that rocks can go: no farther than the terrain's
/// diagonal in plan view, and on a long strip no farther than its height lets them or it is wide.
///
/// # Errors
/// A length so small that there would be too many.
pub(super) fn profile_step_m(scene: &Scene, terrain: &Terrain) -> Result<f64> {
    let (low, high) = terrain.index.bounds();
    let longest_m = math::hypot(high.x - low.x, high.y - low.y);
    let Some(asked) = scene.record.profile_step_m else {
        let across_m = (high.x - low.x).min(high.y - low.y);
        let way_m = longest_m.min(across_m.max(WAY_OVER_DROP * (high.z - low.z)));
        // a round number is less by up to 2.5 times
        return Ok(round_below((way_m / STRETCHES).max(2.5 * longest_m / MOST_STRETCHES)));
    };
    if longest_m > MOST_STRETCHES * asked {
        let found = format!("found {asked} on a terrain of {longest_m:.0} m");
        let least = math::rounded_up(longest_m / MOST_STRETCHES);
        let remedy = format!("write {least} or more");
        return Err(Error::input(&scene.file, "[record] profile_step_m", found, remedy));
    }
    Ok(asked)
}

/// The largest of 1, 2 and 5 times a power of ten that is no larger.
fn round_below(value: f64) -> f64 {
    let power = math::log10(value).floor() as i32;
    // written and read, not multiplied: the doubles that everybody else has for them
    let round = [5, 2, 1].map(|digit| format!("{digit}e{power}").parse().unwrap_or(value));
    round.into_iter().find(|round| *round <= value).unwrap_or(value)
}
