//! Rocks that would have gone on, and the lines that they may still come to.
//!
//! A rock whose time or work was up, or that failed, may still come to every line that it has not crossed. One that left the
//! terrain may come to those that do not lie behind it: it would have to turn back to a line of which every corner lies
//! behind the vertical plane through its end, across its velocity there. None comes to a line whose ground lies higher than its
//! energy lifts it: whatever the terrain beyond, nothing gives a rock energy but its fall. Shares and rates take none of them as
//! arriving, and the upper ends of their intervals all (worst-case bounds, Manski 1990).

mod bounds;

pub use bounds::RowBounds;

use super::lines::{CrossingRow, LineFloor, LineInfo, by_rock};
use super::maps::MapFrame;
use super::row::{Row, StopKind};
use std::collections::BTreeMap;

/// A rock that would have gone on.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenRock {
    /// Release number.
    pub release: usize,
    /// Its radius (m).
    pub radius_m: f64,
    /// Where it has left the terrain on the map (m), and its velocity there (m/s); none of one that ended within.
    left: Option<[[f64; 2]; 2]>,
    /// What it could still do; none of one that failed.
    left_with: Option<LeftWith>,
    /// Lines that it has crossed, and barriers that have stopped it, by their numbers.
    crossed: Vec<usize>,
    stopped_by: Vec<usize>,
}

impl OpenRock {
    /// Of a rock that would have gone on; none of one at rest or never released.
    pub fn of(row: &Row) -> Option<Self> {
        let ([x, y, _], [vx, vy, _]) = (row.end_m, row.end_velocity_m_s);
        row.stop.is_open().then(|| Self {
            release: row.index,
            radius_m: row.radius_m,
            left: (row.stop == StopKind::LeftTerrain).then_some([[x, y], [vx, vy]]),
            left_with: (row.stop != StopKind::Failed).then(|| LeftWith::of(row)),
            crossed: Vec::new(),
            stopped_by: Vec::new(),
        })
    }

    /// Whether it need not turn back to come to a line, and can come up to it.
    fn may_come(&self, line: &LineInfo) -> bool {
        line.floor.is_none_or(|floor| self.most_j(floor) >= 0.0) && self.need_not_turn(line)
    }

    /// Most total energy with which it can cross a line (J): that which it ended with, and that of its fall from there to the lowest
    /// ground of the line, above which its centre then is. Negative where it does not come up to it; infinite where nothing bounds it.
    pub(super) fn most_j(&self, floor: LineFloor) -> f64 {
        let bound = |of: LeftWith| {
            let fall_j = of.mass_kg * floor.gravity_m_s2 * (of.height_m - floor.ground_m);
            ROUNDING * of.energy_j + fall_j
        };
        // what is no number bounds nothing
        self.left_with.map(bound).filter(|most| !most.is_nan()).unwrap_or(f64::INFINITY)
    }

    fn need_not_turn(&self, line: &LineInfo) -> bool {
        self.left.is_none_or(|[end, way]| {
            let is_ahead = |[x, y]: &[f64; 2]| (x - end[0]) * way[0] + (y - end[1]) * way[1] >= 0.0;
            line.corners_m.iter().any(is_ahead)
        })
    }

    /// Whether it ended on the map: time or work up, failed, or out of the terrain farther than a cell from the edge, through a
    /// hole or where the terrain fills no rectangle. What leaves over the edge of the map is missing in no cell.
    pub fn ended_on(&self, map: &MapFrame) -> bool {
        let cells = |at: f64, edge: f64| (at - edge) / map.cell_m;
        self.left.is_none_or(|[[x, y], _]| {
            let (column, row) = (cells(x, map.west_m), cells(y, map.south_m));
            column.min(row) > 1.0
                && column < f64::from(map.columns) - 1.0
                && row < f64::from(map.rows) - 1.0
        })
    }

    /// The first barrier that stops it, but for one.
    pub(super) fn stopped_by(&self, but_for: Option<usize>) -> Option<usize> {
        self.stopped_by.iter().copied().find(|which| Some(*which) != but_for)
    }

    /// Notes what it has crossed on its way, in the order of time.
    fn take(
        &mut self,
        way: &[CrossingRow],
        (lines, stops): (&[LineInfo], &impl Fn(&CrossingRow) -> Option<usize>),
    ) {
        for row in way {
            self.crossed.extend(lines.iter().position(|line| line.name == row.line));
            self.stopped_by.extend(stops(row));
        }
    }
}

/// Energy that a rock may have more than its row says (–): rounding.
const ROUNDING: f64 = 1.0 + 1e-6;

/// What a rock ended with.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LeftWith {
    mass_kg: f64,
    /// Map height of its centre (m).
    height_m: f64,
    /// Energy of its motion and of the springs of its contacts (J).
    energy_j: f64,
}

impl LeftWith {
    /// The spin of a block is taken as its fastest: its row does not say what turns.
    fn of(row: &Row) -> Self {
        let square = |v: [f64; 3]| v.iter().map(|part| part * part).sum::<f64>();
        let rotational_j = match row.shape {
            // of a homogeneous sphere: I = 2/5 m R²
            None => 0.2 * row.mass_kg * row.radius_m.powi(2) * square(row.end_spin_rad_s),
            Some(_) => row.max_rotational_j,
        };
        let translational_j = 0.5 * row.mass_kg * square(row.end_velocity_m_s);
        Self {
            mass_kg: row.mass_kg,
            height_m: row.end_m[2],
            energy_j: translational_j + rotational_j + row.springs_j.max(0.0),
        }
    }
}

/// All of them, and which may come to each line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenRocks {
    rocks: Vec<OpenRock>,
    at: BTreeMap<String, Vec<usize>>,
}

impl OpenRocks {
    /// Finds the lines that rocks, by rising release, may still come to; `rows` are first crossings, release by release, and
    /// `stops` gives the number of the barrier that stops a rock there.
    ///
    /// # Errors
    /// Passes on what reading a row says.
    pub fn find<E>(
        mut rocks: Vec<OpenRock>,
        (lines, stops): (&[LineInfo], impl Fn(&CrossingRow) -> Option<usize>),
        rows: impl Iterator<Item = Result<CrossingRow, E>>,
    ) -> Result<Self, E> {
        if rocks.is_empty() || lines.is_empty() {
            return Ok(Self::default());
        }
        by_rock(rows, |way| {
            let known = rocks.binary_search_by_key(&way[0].index, |rock| rock.release);
            if let Ok(at) = known {
                way.sort_by(|one, other| one.time_s.total_cmp(&other.time_s));
                rocks[at].take(way, (lines, &stops));
            }
        })?;
        let may_come = |number: usize, line: &LineInfo| {
            let is_one = |rock: &OpenRock| !rock.crossed.contains(&number) && rock.may_come(line);
            (0..rocks.len()).filter(|at| is_one(&rocks[*at])).collect()
        };
        let at = lines.iter().enumerate();
        let at = at.map(|(number, line)| (line.name.clone(), may_come(number, line))).collect();
        Ok(Self { rocks, at })
    }

    /// Those that may come to a line.
    pub(super) fn rocks_at<'a>(
        &'a self,
        line: &str,
    ) -> impl Iterator<Item = &'a OpenRock> + Clone + use<'a> {
        self.at.get(line).into_iter().flatten().map(|at| &self.rocks[*at])
    }

    /// Release numbers of those that may come to a line.
    pub fn at<'a>(&'a self, line: &str) -> impl Iterator<Item = usize> + Clone + use<'a> {
        self.rocks_at(line).map(|rock| rock.release)
    }

    /// The same, without those that a barrier has stopped before.
    pub fn behind_barriers<'a>(
        &'a self,
        line: &str,
    ) -> impl Iterator<Item = usize> + Clone + use<'a> {
        self.free_at(line, None)
    }

    /// The same, where one barrier is the line's own.
    pub(super) fn free_at<'a>(
        &'a self,
        line: &str,
        own: Option<usize>,
    ) -> impl Iterator<Item = usize> + Clone + use<'a> {
        let free = self.rocks_at(line).filter(move |rock| rock.stopped_by(own).is_none());
        free.map(|rock| rock.release)
    }
}
