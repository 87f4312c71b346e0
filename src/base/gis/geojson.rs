//! GeoJSON (RFC 7946), with the older member `crs` that names a map projection; GDAL and QGIS write it.

use super::{Corner, Geometry, GisFeature, GisLayer, PropertyValue};
use super::{degrees, place, polygons, without_shape};
use crate::error::{Error, Result};
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use std::path::Path;

const WRITE: &str = "write GeoJSON: a FeatureCollection of points, lines or polygons";

/// Reads the bytes of a GeoJSON file; `file` is for messages.
///
/// # Errors
/// Text that is no GeoJSON, coordinates in degrees, a geometry that cannot be read; with the number of the feature.
pub fn parse(bytes: &[u8], file: &Path) -> Result<GisLayer> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let root: Json = serde_json::from_slice(bytes).map_err(|why| {
        let place = format!("line {}", why.line());
        Error::input(file, place, format!("found no JSON ({why})"), WRITE)
    })?;
    let (epsg, system) = system(&root, file)?;
    let list: Vec<&Json> = match (root["type"].as_str(), &root["features"]) {
        (Some("FeatureCollection"), Json::Array(list)) => list.iter().collect(),
        (Some("Feature"), _) => vec![&root],
        _ => return Err(Error::input(file, "type", format!("found {}", root["type"]), WRITE)),
    };
    let mut features = Vec::new();
    for (number, json) in (1..).zip(list) {
        let wrong = |found: String| Error::input(file, format!("feature {number}"), found, WRITE);
        // RFC 7946: what has no coordinates may be taken as null
        if json["geometry"].is_null() || has_no_place(&json["geometry"]["coordinates"]) {
            return Err(without_shape(file, format!("feature {number}")));
        }
        if let Some(found) = mixed(&json["geometry"]) {
            let remedy = "draw points, lines and polygons as features of their own: one feature has one kind of geometry";
            return Err(Error::input(file, format!("feature {number}"), found, remedy));
        }
        let shape = shape(&json["geometry"]).map_err(wrong)?;
        features.push(GisFeature {
            number,
            shape,
            properties: properties(json["properties"].as_object()),
        });
    }
    Ok(GisLayer { file: file.to_owned(), epsg, system, features })
}

fn properties(json: Option<&Map<String, Json>>) -> BTreeMap<String, PropertyValue> {
    let value = |json: &Json| match json {
        Json::Number(number) => {
            number.as_f64().filter(|x| x.is_finite()).map(PropertyValue::Number)
        }
        Json::String(text) => Some(PropertyValue::Text(text.clone())),
        Json::Bool(is) => Some(PropertyValue::Text(is.to_string())),
        _ => None,
    };
    let all = json.into_iter().flatten();
    all.filter_map(|(name, json)| Some((name.clone(), value(json)?))).collect()
}

/// `urn:ogc:def:crs:EPSG::2056`, `EPSG:2056`, or a name; without the member the coordinates are taken as the scene's.
fn system(root: &Json, file: &Path) -> Result<(Option<u32>, Option<String>)> {
    let Some(name) = root["crs"]["properties"]["name"].as_str() else { return Ok((None, None)) };
    let code = name.rsplit(':').next().and_then(|code| code.parse::<u32>().ok());
    let is_epsg = name.to_uppercase().contains("EPSG");
    if name.contains("CRS84") || (is_epsg && code == Some(4326)) {
        return Err(degrees(file));
    }
    Ok(if is_epsg && code.is_some() { (code, None) } else { (None, Some(name.to_owned())) })
}

fn shape(geometry: &Json) -> std::result::Result<Geometry, String> {
    let coordinates = &geometry["coordinates"];
    match geometry["type"].as_str() {
        Some("Point") => Ok(Geometry::Points(vec![corner(coordinates)?])),
        Some("MultiPoint") => Ok(Geometry::Points(corners(coordinates)?)),
        Some("LineString") => Ok(Geometry::Lines(vec![corners(coordinates)?])),
        Some("MultiLineString") => Ok(Geometry::Lines(lines(coordinates)?)),
        Some("Polygon") => Ok(Geometry::Polygons(polygons(lines(coordinates)?))),
        Some("MultiPolygon") => {
            let parts: std::result::Result<Vec<_>, String> =
                entries(coordinates)?.iter().map(lines).collect();
            Ok(Geometry::Polygons(polygons(parts?.concat())))
        }
        _ => Err(format!("found a geometry of type {}", geometry["type"])),
    }
}

/// What a collection of geometries holds; none of another geometry.
fn mixed(geometry: &Json) -> Option<String> {
    let parts = geometry["geometries"].as_array()?;
    let mut kinds: Vec<&str> = parts.iter().filter_map(|part| part["type"].as_str()).collect();
    kinds.dedup();
    Some(format!("found a GeometryCollection of {}", kinds.join(", ")))
}

/// Whether coordinates are lists without any number.
fn has_no_place(coordinates: &Json) -> bool {
    coordinates.as_array().is_some_and(|list| list.iter().all(has_no_place))
}

fn entries(json: &Json) -> std::result::Result<&Vec<Json>, String> {
    json.as_array().ok_or_else(|| "found coordinates that are no list".to_owned())
}

fn lines(json: &Json) -> std::result::Result<Vec<Vec<Corner>>, String> {
    entries(json)?.iter().map(corners).collect()
}

fn corners(json: &Json) -> std::result::Result<Vec<Corner>, String> {
    entries(json)?.iter().map(corner).collect()
}

fn corner(json: &Json) -> std::result::Result<Corner, String> {
    match entries(json)?.as_slice() {
        [x, y, ..] if x.is_number() && y.is_number() => {
            place(x.as_f64().unwrap_or(f64::NAN), y.as_f64().unwrap_or(f64::NAN))
        }
        _ => Err("found a place without two numbers".to_owned()),
    }
}
