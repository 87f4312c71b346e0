//! Kept paths, in whole numbers.

use super::frame::{QuantizedBox, is_finite};
use super::pack::Section;
use crate::error::Result;
use crate::hazard::Row;
use crate::math;
use crate::output::{PathRow, Results};
use crate::report::format;
use crate::rock::Vec3;
use serde_json::json;

/// Most points of all paths together; of more, every second, third … of each path is shown.
const MOST_POINTS: usize = 400_000;
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
}

/// One path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ViewPath {
    pub(super) release: usize,
    pub(super) radius_m: f64,
    pub(super) instants: Vec<PathInstant>,
}

/// All that are shown.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ways {
    pub(super) ways: Vec<ViewPath>,
    /// Every so many points are shown.
    every: usize,
}

impl Ways {
    /// The kept paths of a run; `rows` tell mass and radius.
    pub(super) fn of(results: &Results, rows: &[Row]) -> Result<Self> {
        let mut ways: Vec<ViewPath> = Vec::new();
        let first = rows.first().map_or(0, |row| row.index);
        for row in results.paths()? {
            let row = row?;
            let Some(rock) = row.index.checked_sub(first).and_then(|k| rows.get(k)) else {
                break;
            };
            if ways.last().is_none_or(|way| way.release != row.index) {
                let (release, radius_m) = (row.index, rock.radius_m);
                ways.push(ViewPath { release, radius_m, instants: Vec::new() });
            }
            let Some(way) = ways.last_mut() else { break };
            let is_ahead = way.instants.last().is_none_or(|last| row.time_s > last.time_s);
            if is_ahead && is_finite(&row.position_m) && row.time_s.is_finite() {
                way.instants.push(instant(&row, rock));
            }
        }
        ways.retain(|way| !way.instants.is_empty());
        let points: usize = ways.iter().map(|way| way.instants.len()).sum();
        let every = points.div_ceil(MOST_POINTS).max(1);
        for way in &mut ways {
            thin(&mut way.instants, every);
        }
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

    /// Packed as text.
    ///
    /// A column `turn` (four parts, a unit quaternion) may join when rocks have a shape that shows how they turn.
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
        section.text()
    }
}

fn instant(row: &PathRow, rock: &Row) -> PathInstant {
    let speed = Vec3::from(row.velocity_m_s).norm();
    // I = 2/5 m R²
    let rim = rock.radius_m * Vec3::from(row.spin_rad_s).norm();
    let total_j = rock.mass_kg * (0.5 * speed * speed + 0.2 * rim * rim);
    PathInstant { time_s: row.time_s, place_m: row.position_m, total_j }
}

/// Keeps every so many instants, and the last.
fn thin(instants: &mut Vec<PathInstant>, every: usize) {
    let last = instants.len().saturating_sub(1);
    let mut k = 0;
    instants.retain(|_| {
        k += 1;
        (k - 1) % every == 0 || k - 1 == last
    });
}
