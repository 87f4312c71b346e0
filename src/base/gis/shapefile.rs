//! ESRI Shapefile (white paper of 1998): `.shp` for places, `.dbf` (dBase III) for properties, `.prj` for the system.
//!
//! Read here in a few lines and not by a library: every count in the file is checked against its bytes before it is
//! believed.

use super::{Corner, Geometry, GisFeature, GisLayer, PropertyValue};
use super::{degrees, place, polygons, without_shape, wkt};
use crate::error::{Error, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// First four bytes, big-endian.
const CODE: [u8; 4] = 9994i32.to_be_bytes();
/// Bytes before the first record.
const HEAD_BYTES: usize = 100;
const WRITE: &str = "write it again: ogr2ogr out.geojson in.shp";

pub(super) fn begins_like_shapefile(bytes: &[u8]) -> bool {
    bytes.starts_with(&CODE)
}

/// Reads the bytes of a Shapefile and of the files beside it; `file` is for messages.
///
/// # Errors
/// Bytes that are no Shapefile or end too early, coordinates in degrees, a shape other than points, lines and polygons.
pub fn parse(shp: &[u8], dbf: Option<&[u8]>, prj: Option<&[u8]>, file: &Path) -> Result<GisLayer> {
    let system = prj.map(|text| wkt::system(&String::from_utf8_lossy(text)));
    if system.as_ref().is_some_and(|system| system.is_geographic) {
        return Err(degrees(file));
    }
    if let Some(unit) = system.as_ref().and_then(|system| system.other_unit.as_ref()) {
        let remedy = format!("write it in metres: {}", super::transformed(file, None, ""));
        return Err(Error::input(file, "unit (.prj)", format!("found {unit}"), remedy));
    }
    let broken = |place: String, found: &str| Error::input(file, place, found, WRITE);
    if file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("shx")) {
        let remedy = "write the name of the .shp beside it";
        return Err(Error::input(file, "start", "found the index of a Shapefile", remedy));
    }
    if !begins_like_shapefile(shp) || shp.len() < HEAD_BYTES {
        return Err(broken("start".to_owned(), "found no Shapefile"));
    }
    let rows = dbf.map(|dbf| {
        table(dbf).ok_or_else(|| broken("table (.dbf)".to_owned(), "found a damaged table"))
    });
    let rows = rows.transpose()?.unwrap_or_default();
    let (mut features, mut at) = (Vec::new(), HEAD_BYTES);
    for number in 1.. {
        if at >= shp.len() {
            break;
        }
        let record = || format!("feature {number}");
        let words =
            be_u32(shp, at + 4).ok_or_else(|| broken(record(), "found the end of the file"))?;
        let content = usize::try_from(words).ok().and_then(|words| {
            let start = at + 8;
            shp.get(start..start.checked_add(words.checked_mul(2)?)?)
        });
        let content = content.ok_or_else(|| broken(record(), "found the end of the file"))?;
        at += 8 + content.len();
        let row = rows.get(number - 1);
        let is_deleted = row.is_some_and(Option::is_none);
        let shape = shape(content).map_err(|found| broken(record(), &found))?;
        if !is_deleted {
            let shape = shape.ok_or_else(|| without_shape(file, record()))?;
            let properties = row.cloned().flatten().unwrap_or_default();
            features.push(GisFeature { number, shape, properties });
        }
    }
    let epsg = system.as_ref().and_then(|system| system.epsg);
    let name = system.filter(|_| epsg.is_none()).map(|system| system.name);
    Ok(GisLayer { file: file.to_owned(), epsg, system: name, features })
}

/// The shape of a record; none for a null shape. Z and M variants have the plane coordinates at the same place.
fn shape(content: &[u8]) -> std::result::Result<Option<Geometry>, String> {
    let cut_off = || "found a shape that ends too early".to_owned();
    let kind = le_u32(content, 0).ok_or_else(cut_off)?;
    match kind {
        0 => Ok(None),
        1 | 11 | 21 => Ok(Some(Geometry::Points(vec![corner(content, 4)?]))),
        8 | 18 | 28 => {
            let count = le_u32(content, 36).ok_or_else(cut_off)? as usize;
            Ok(Some(Geometry::Points(corners(content, 40, count)?)))
        }
        3 | 13 | 23 => Ok(Some(Geometry::Lines(parts(content)?))),
        5 | 15 | 25 => Ok(Some(Geometry::Polygons(polygons(parts(content)?)))),
        other => Err(format!("found a shape of type {other}; points, lines and polygons are read")),
    }
}

/// Lines or rings: bounding box, numbers of parts and of points, where each part begins, points.
fn parts(content: &[u8]) -> std::result::Result<Vec<Vec<Corner>>, String> {
    let cut_off = || "found a shape that ends too early".to_owned();
    let count = le_u32(content, 36).ok_or_else(cut_off)? as usize;
    let points = le_u32(content, 40).ok_or_else(cut_off)? as usize;
    let starts =
        content.get(44..).and_then(|rest| rest.get(..count.checked_mul(4)?)).ok_or_else(cut_off)?;
    let all = corners(content, 44 + starts.len(), points)?;
    let start = |part: usize| le_u32(starts, 4 * part).map_or(points, |start| start as usize);
    let part = |part: usize| {
        let outside = || "found a part outside of its points".to_owned();
        all.get(start(part)..start(part + 1)).map(<[Corner]>::to_vec).ok_or_else(outside)
    };
    (0..count).map(part).collect()
}

fn corners(content: &[u8], at: usize, count: usize) -> std::result::Result<Vec<Corner>, String> {
    let cut_off = || "found a shape that ends too early".to_owned();
    let bytes = content
        .get(at..)
        .and_then(|rest| rest.get(..count.checked_mul(16)?))
        .ok_or_else(cut_off)?;
    (0..count).map(|k| corner(bytes, 16 * k)).collect()
}

fn corner(content: &[u8], at: usize) -> std::result::Result<Corner, String> {
    let number = |at: usize| {
        let bytes = content.get(at..at + 8)?.try_into().ok()?;
        Some(f64::from_le_bytes(bytes))
    };
    match (number(at), number(at + 8)) {
        (Some(x), Some(y)) => place(x, y),
        _ => Err("found a shape that ends too early".to_owned()),
    }
}

fn le_u32(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

fn be_u32(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

/// The properties of a row.
type PropertyRow = BTreeMap<String, PropertyValue>;

/// A column: name, type, length in bytes.
struct DbfColumn {
    name: String,
    kind: u8,
    bytes: usize,
}

/// All rows of a dBase table, none for a deleted one; none at all when it is damaged.
fn table(dbf: &[u8]) -> Option<Vec<Option<PropertyRow>>> {
    let le_u16 = |at: usize| Some(u16::from_le_bytes(dbf.get(at..at + 2)?.try_into().ok()?));
    let count = le_u32(dbf, 4)? as usize;
    let (head, row_bytes) = (usize::from(le_u16(8)?), usize::from(le_u16(10)?));
    let descriptions = dbf.get(32..head)?.chunks_exact(32).take_while(|field| field[0] != b'\r');
    let columns: Vec<DbfColumn> = descriptions
        .map(|field| DbfColumn {
            name: text(&field[..11]),
            kind: field[11],
            bytes: field[16].into(),
        })
        .collect();
    if row_bytes == 0 || columns.iter().map(|column| column.bytes).sum::<usize>() + 1 > row_bytes {
        return None;
    }
    let rows: Vec<&[u8]> = dbf.get(head..)?.chunks_exact(row_bytes).take(count).collect();
    (rows.len() == count).then(|| rows.into_iter().map(|bytes| row(&columns, bytes)).collect())
}

fn row(columns: &[DbfColumn], bytes: &[u8]) -> Option<PropertyRow> {
    let (mark, mut rest) = bytes.split_first()?;
    let mut row = PropertyRow::new();
    for column in columns {
        let (field, behind) = rest.split_at_checked(column.bytes)?;
        rest = behind;
        let text = text(field);
        // numbers that do not fit their column are stored as stars
        let value = match column.kind {
            b'N' | b'F' => {
                text.parse().ok().filter(|x: &f64| x.is_finite()).map(PropertyValue::Number)
            }
            _ if text.is_empty() => None,
            _ => Some(PropertyValue::Text(text)),
        };
        row.extend(value.map(|value| (column.name.clone(), value)));
    }
    (*mark != b'*').then_some(row)
}

/// UTF-8 where it is, else Latin-1; without filling.
fn text(field: &[u8]) -> String {
    let end = field.iter().position(|&byte| byte == 0).unwrap_or(field.len());
    let field = &field[..end];
    let text = std::str::from_utf8(field)
        .map_or_else(|_| field.iter().map(|&byte| char::from(byte)).collect(), str::to_owned);
    text.trim().to_owned()
}
