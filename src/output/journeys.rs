//! Rows of a journey: its path, its impacts, the lines that it crosses.

use super::{ImpactRow, Output, PathRow};
use crate::error::Result;
use crate::hazard::CrossingRow;
use crate::simulation::{RockShape, Trajectory};

impl Output {
    pub(super) fn write_path(&mut self, fall: &Trajectory) -> Result<()> {
        let Some(table) = &mut self.paths else { return Ok(()) };
        let (origin_m, has_blocks) = (self.info.origin_m, self.info.has_blocks);
        fall.path.iter().try_for_each(|point| {
            let mut row = PathRow::of(fall.index, point, origin_m);
            if has_blocks {
                row.attitude.get_or_insert(RockShape::SPHERE.attitude);
            }
            table.write(&row)
        })
    }

    pub(super) fn write_impacts(&mut self, fall: &Trajectory) -> Result<()> {
        let Some(table) = &mut self.impacts else { return Ok(()) };
        fall.impacts.iter().try_for_each(|impact| {
            let ground = &self.info.ground_of_sheet[usize::from(impact.sheet)];
            let row = ImpactRow::of(fall.index, impact, ground, self.info.origin_m);
            let soil_j = self.info.has_scars.then_some(impact.soil_j);
            table.write(&ImpactRow { soil_j, ..row })
        })
    }

    pub(super) fn write_crossings(&mut self, fall: &Trajectory) -> Result<()> {
        let Some(table) = &mut self.crossings else { return Ok(()) };
        let mut rock = Vec::new();
        for crossing in &fall.crossings {
            let line = &mut self.lines[crossing.line];
            let who = (fall.index, &fall.rock);
            let mut row = CrossingRow::of(who, crossing, &line.info.name, self.info.origin_m);
            if self.info.has_blocks {
                row.top_m = Some(row.highest_m());
            }
            table.write(&row)?;
            line.add(&row);
            if self.year.is_some() {
                rock.push(row);
            }
        }
        if let Some(year) = &mut self.year {
            year.add(&mut rock);
        }
        Ok(())
    }
}
