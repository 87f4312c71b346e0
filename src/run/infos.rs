//! What the results need to know of a plan: where things stand, lines, barriers, maps.

use super::floors;
use crate::error::{Error, Result};
use crate::frequency::Frequency;
use crate::hazard::{Barrier, DesignBlock, Elsewhere, LineInfo, MapFrame, Rule};
use crate::output::{ReleaseZone, Site};
use crate::plan::{self, EvaluationLine, Plan};
use crate::release::ReleasePlace;
use crate::scene::{self, Area, BarrierTable, DesignTable, Polyline, ZonePlace};

/// Where meshes and releases lie.
pub(super) fn site(plan: &Plan) -> Site {
    let places = plan.releases.places();
    // one place alone needs no name
    let sources = plan.releases.frequency().filter(|_| places.len() > 1);
    let names = sources.into_iter().flat_map(Frequency::sources).map(|one| one.name.as_str());
    let named = places.iter().zip(names.chain(std::iter::repeat("")));
    let (release_names, mut outlines): (Vec<String>, Vec<ReleaseZone>) =
        named.flat_map(|(place, name)| zones(place, name)).unzip();
    let is_named = release_names.iter().any(|name| !name.is_empty());
    let further_releases = outlines.split_off(outlines.len().min(1));
    Site {
        mesh_origin_m: plan.mesh_origin_m,
        release: outlines.pop().unwrap_or_default(),
        further_releases,
        release_names: if is_named { release_names } else { Vec::new() },
        fast_warnings: plan.fast_warnings.clone(),
        floor: floors::of_terrain(plan),
    }
}

/// Outlines of a place of release, each with the name of its zone or of the place.
fn zones(place: &ReleasePlace, name: &str) -> Vec<(String, ReleaseZone)> {
    let line = |line: &Polyline| ReleaseZone::Line(line.corners_m().to_vec());
    let area = |area: &Area| ReleaseZone::Polygon(area.corners_m().to_vec());
    let drawn = |one: &scene::Zone| -> Vec<(String, ReleaseZone)> {
        let outlines = match &one.place {
            ZonePlace::Points(points) => vec![ReleaseZone::Points(points.clone())],
            ZonePlace::Lines(lines) => lines.iter().map(line).collect(),
            ZonePlace::Areas(areas) => areas.iter().map(area).collect(),
        };
        outlines.into_iter().map(|outline| (one.name.clone(), outline)).collect()
    };
    let outline = match place {
        ReleasePlace::Points(points) => {
            ReleaseZone::Points(points.iter().map(|point| point.at_m).collect())
        }
        ReleasePlace::Line(one) => line(one),
        ReleasePlace::Area(one) => area(one),
        ReleasePlace::Zones(zones) => return zones.list().iter().flat_map(drawn).collect(),
    };
    vec![(name.to_owned(), outline)]
}

pub(super) fn line_infos(plan: &Plan) -> Vec<LineInfo> {
    let plan::Part::Kept(tables) = &plan.barriers else { return infos(plan, &[]) };
    let moved: Vec<String> =
        tables.iter().flat_map(BarrierTable::elsewhere).map(|(_, name, _)| name).collect();
    infos(plan, &moved)
}

/// All lines; the `moved` ones are other places of barriers.
fn infos(plan: &Plan, moved: &[String]) -> Vec<LineInfo> {
    let info = |line: &EvaluationLine| LineInfo {
        name: line.name.clone(),
        length_m: line.length_m(),
        corners_m: line.corners_m(plan.terrain.origin_m),
        of_barrier: moved.contains(&line.name),
        floor: floors::floor(plan, line),
    };
    plan.recorders().lines.iter().map(info).collect()
}

pub(super) fn barriers(plan: &Plan) -> Vec<Barrier> {
    let plan::Part::Kept(tables) = &plan.barriers else { return Vec::new() };
    let rule = |rule: &DesignTable| Rule {
        standard: rule.standard().map(str::to_owned),
        percentile: rule.percentile(),
        speed_factors: rule.speed_factors(),
        mass_factors: rule.mass_factors.clone(),
        height_factors: rule.height_factors(),
        free_height_m: rule.free_height_m,
        free_distance_m: rule.free_distance_m(),
        block: rule.block_volume_m3.map(|volume_m3| DesignBlock {
            volume_m3,
            mass_kg: volume_m3 * plan.releases.density_kg_m3(),
        }),
        capacity_factor: rule.capacity_factor,
    };
    let barrier = |table: &BarrierTable| Barrier {
        name: table.name.clone(),
        height_m: table.height_m,
        capacity_j: table.capacity_j,
        design: table.design.as_ref().map(rule),
        elsewhere: table
            .elsewhere()
            .map(|(offset_m, line, _)| Elsewhere { offset_m, line })
            .collect(),
    };
    tables.iter().map(barrier).collect()
}

pub(super) fn map_frame(plan: &Plan) -> Option<MapFrame> {
    let cells = plan.recorders().cells?;
    // edges lie at multiples of the cell: the digits that the origin cost come back
    let whole = |edge_m: f64| (edge_m / cells.cell_m).round() * cells.cell_m;
    Some(MapFrame {
        west_m: whole(cells.west_m + plan.terrain.origin_m.x),
        south_m: whole(cells.south_m + plan.terrain.origin_m.y),
        cell_m: cells.cell_m,
        columns: cells.columns,
        rows: cells.rows,
        epsg: plan.epsg,
    })
}

/// Health of the meshes as the summary has it: figures, and the table as it is printed. Null where the plan was compiled on
/// a terrain that was not read from files.
pub(super) fn mesh_health(plan: &Plan) -> Result<serde_json::Value> {
    let Some(health) = &plan.mesh_health else { return Ok(serde_json::Value::Null) };
    let mut value = serde_json::to_value(health)
        .map_err(|error| Error::Request(format!("the mesh health cannot be written: {error}")))?;
    value["table"] = health.to_string().lines().collect();
    Ok(value)
}
