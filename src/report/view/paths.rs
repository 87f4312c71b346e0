//! Kept paths, in whole numbers.

use super::frame::{QuantizedBox, is_finite};
use super::hulls::{BlockHull, BlockHulls};
use super::pack::Section;
use super::turn::{AxisTurn, folded, packed};
use crate::error::Result;
use crate::hazard::Row;
use crate::math;
use crate::output::{PathRow, Results};
use crate::plan::MOST_SHOWN_POINTS;
use crate::report::format;
use crate::rock::Vec3;
use serde_json::json;

/// Thousandths of a second: the unit of times.
const TICKS_PER_S: f64 = 1e3;
/// Steps of energy in a decade: 2.3 % each.
const ENERGY_STEPS: f64 = 100.0;

/// One instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PathInstant {
    pub(super) time_s: f64,
    pub(super) place_m: [f64; 3],
    pub(super) total_j: f64,
    /// How it is turned, a quaternion w, x, y, z.
    pub(super) attitude: [f64; 4],
    /// How far it has spun since the instant before, axis times angle (rad).
    spun_rad: Vec3,
}

/// One path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ViewPath {
    pub(super) release: usize,
    pub(super) radius_m: f64,
    /// Number of its hull; none for a ball.
    pub(super) hull: Option<usize>,
    pub(super) instants: Vec<PathInstant>,
}

impl ViewPath {
    /// How it turns from each instant to the next.
    pub(super) fn turns(&self) -> impl Iterator<Item = AxisTurn> + '_ {
        let pair = |two: &[PathInstant]| {
            AxisTurn::between(two[0].attitude, two[1].attitude, two[1].spun_rad)
        };
        self.instants.windows(2).map(pair)
    }
}

/// All that are shown.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ways {
    pub(super) ways: Vec<ViewPath>,
    /// Every so many points are shown.
    every: usize,
}

impl Ways {
    /// The kept paths of a run; `rows` tell mass and radius, `hulls` get what `hull_of` makes of each release.
    pub(super) fn of(
        results: &Results,
        rows: &[Row],
        hull_of: impl Fn(usize) -> Option<BlockHull>,
        hulls: &mut BlockHulls,
    ) -> Result<Self> {
        // of more points than that every second, third … of each path is shown
        let every = results.path_points()?.div_ceil(MOST_SHOWN_POINTS).max(1);
        let mut ways: Vec<ViewPath> = Vec::new();
        let mut reading: Option<PathReading> = None;
        let first = rows.first().map_or(0, |row| row.index);
        for row in results.paths()? {
            let row = row?;
            let Some(rock) = row.index.checked_sub(first).and_then(|k| rows.get(k)) else {
                break;
            };
            if reading.as_ref().is_none_or(|reading| reading.path.release != row.index) {
                let (release, radius_m) = (row.index, rock.radius_m);
                if let Some(hull) = hull_of(release) {
                    hulls.add(release, hull);
                }
                let hull = hulls.number(release);
                let path = ViewPath { release, radius_m, hull, instants: Vec::new() };
                let next = PathReading { path, every, seen: 0, last: None, skipped: None };
                ways.extend(reading.replace(next).and_then(PathReading::end));
            }
            if let Some(reading) = &mut reading {
                reading.add(&row, rock, hulls.hull(row.index));
            }
        }
        ways.extend(reading.and_then(PathReading::end));
        Ok(Self { ways, every })
    }

    /// What was left out.
    pub(super) fn notes(&self) -> Option<String> {
        let points: usize = self.ways.iter().map(|way| way.instants.len()).sum();
        (self.every > 1).then(|| {
            format!(
                "Of the paths one in {} points is drawn, {} in all.",
                self.every,
                format::decimal(points as f64, 0)
            )
        })
    }

    /// Packed as text. With blocks the columns `turn` and `rounds` join: how they are turned, and how often they went round
    /// since the instant before.
    pub(super) fn text(&self) -> String {
        let instants = || self.ways.iter().flat_map(|way| &way.instants);
        let frame = QuantizedBox::round(instants().map(|instant| instant.place_m));
        let mut section = Section::new(json!({
            "frame": frame, "ticks_per_s": TICKS_PER_S, "energy_steps": ENERGY_STEPS
        }));
        let each =
            |of: fn(&ViewPath) -> usize| self.ways.iter().map(|way| of(way) as u32).collect();
        section.add("release", 1, 1, each(|way| way.release));
        section.add("points", 1, 0, each(|way| way.instants.len()));
        let steps = instants().flat_map(|instant| frame.steps(instant.place_m)).collect();
        section.add("place", 3, 2, steps);
        let ticks = |instant: &PathInstant| (instant.time_s * TICKS_PER_S).round() as u32;
        section.add("time", 1, 2, instants().map(ticks).collect());
        let energy = |instant: &PathInstant| {
            (ENERGY_STEPS * math::log10(1.0 + instant.total_j.max(0.0))).round() as u32
        };
        section.add("energy", 1, 1, instants().map(energy).collect());
        if self.ways.iter().any(|way| way.hull.is_some()) {
            self.add_turns(&mut section);
        }
        section.text()
    }

    fn add_turns(&self, section: &mut Section) {
        let (mut turns, mut rounds) = (Vec::new(), Vec::new());
        for way in &self.ways {
            let is_block = way.hull.is_some();
            let shown = |instant: &PathInstant| if is_block { packed(instant.attitude) } else { 0 };
            turns.extend(way.instants.iter().map(shown));
            let since = way.turns().map(|turn| if is_block { folded(turn.rounds) } else { 0 });
            rounds.extend(std::iter::once(0).chain(since));
        }
        section.add("turn", 1, 0, turns);
        section.add("rounds", 1, 0, rounds);
    }
}

/// A path as it is read, of which every so many instants are kept, and the last.
struct PathReading {
    path: ViewPath,
    every: usize,
    /// Instants so far.
    seen: usize,
    /// Time (s) and spin (rad/s) of the last of them.
    last: Option<(f64, Vec3)>,
    /// The last of them, if it has not been kept; what has spun since the one that was adds up.
    skipped: Option<PathInstant>,
}

impl PathReading {
    /// Adds a row, unless it is no number or goes back in time.
    fn add(&mut self, row: &PathRow, rock: &Row, hull: Option<&BlockHull>) {
        let is_ahead = self.last.is_none_or(|(time_s, _)| row.time_s > time_s);
        if !(is_ahead && is_finite(&row.position_m) && row.time_s.is_finite()) {
            return;
        }
        let (mut instant, spin_rad_s) = (instant(row, rock, hull), Vec3::from(row.spin_rad_s));
        if let Some((time_s, before_rad_s)) = self.last {
            let since = self.skipped.map_or_else(Vec3::zeros, |skipped| skipped.spun_rad);
            let mean_rad_s = (before_rad_s + spin_rad_s) * 0.5;
            instant.spun_rad = since + mean_rad_s * (row.time_s - time_s);
        }
        self.last = Some((row.time_s, spin_rad_s));
        if self.seen.is_multiple_of(self.every) {
            self.path.instants.push(instant);
            self.skipped = None;
        } else {
            self.skipped = Some(instant);
        }
        self.seen += 1;
    }

    /// The path; none if it has no instant.
    fn end(self) -> Option<ViewPath> {
        let Self { mut path, skipped, .. } = self;
        path.instants.extend(skipped);
        path.instants.shrink_to_fit();
        (!path.instants.is_empty()).then_some(path)
    }
}

fn instant(row: &PathRow, rock: &Row, hull: Option<&BlockHull>) -> PathInstant {
    let speed = Vec3::from(row.velocity_m_s).norm();
    let attitude = row.attitude.unwrap_or([1.0, 0.0, 0.0, 0.0]);
    let (radius_m, spin) = (rock.radius_m, row.spin_rad_s);
    let turning = if let Some(hull) = hull {
        radius_m * radius_m * hull.rotational(attitude, spin)
    } else {
        // I = 2/5 m R²
        let rim = radius_m * Vec3::from(spin).norm();
        0.2 * rim * rim
    };
    let total_j = rock.mass_kg * (0.5 * speed * speed + turning);
    let spun_rad = Vec3::zeros();
    PathInstant { time_s: row.time_s, place_m: row.position_m, total_j, attitude, spun_rad }
}
