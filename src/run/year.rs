//! What a plan asks of the year, as the results need it.

use crate::hazard::{AnnualRequest, Matrix, Object, Vehicles};
use crate::plan::{self, Plan};
use crate::scene::{MatrixTable, ObjectTable};

/// What is asked of the year.
pub(super) fn asked(plan: &Plan) -> AnnualRequest {
    let plan::Part::Kept(tables) = &plan.objects else {
        return AnnualRequest { objects: Vec::new(), ..asked_of_sources(plan) };
    };
    let object = |table: &ObjectTable| {
        let outline = table.polygon_m.as_ref().map(|area| area.corners_m().to_vec());
        let line = table.points_m.as_ref().map(|line| line.corners_m().to_vec());
        Object {
            name: table.name.clone(),
            corners_m: line.or(outline).unwrap_or_default(),
            width_m: table.width_m,
            occupancy: table.occupancy,
            vulnerability: table.vulnerability,
            persons: table.persons,
            vehicles: table.vehicles.map(|one| Vehicles {
                per_day: one.per_day,
                speed_km_h: one.speed_km_h,
                length_m: one.length_m,
                own_per_day: one.own_per_day,
            }),
        }
    };
    AnnualRequest { objects: tables.iter().map(object).collect(), ..asked_of_sources(plan) }
}

fn asked_of_sources(plan: &Plan) -> AnnualRequest {
    let plan::Part::Kept(year) = &plan.year else { return AnnualRequest::default() };
    let matrix = |table: &MatrixTable| Matrix {
        name: table.name.clone(),
        source: table.source.clone(),
        energies_j: table.energies_j.clone(),
        return_periods_years: table.return_periods_years.clone(),
        levels: table.levels.clone(),
    };
    AnnualRequest {
        frequency: Some(year.frequency.clone()),
        objects: Vec::new(),
        matrix: year.matrix.as_ref().map(matrix),
        most_j: year.most_j.clone(),
        largest_m: year.largest_m.clone(),
    }
}
