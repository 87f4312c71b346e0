//! Binary STL through `stl_io`, guarded: it trusts the count and the header more than files deserve.

use super::{Facet, Format, Soup, Spacing, unit_normal};
use crate::error::{Error, Result};
use crate::file;
use crate::rock::Vec3;
use std::io::Cursor;
use std::path::Path;

/// Header and count in front of the triangles (bytes).
const HEAD_BYTES: usize = 84;

/// One triangle (bytes).
const TRIANGLE_BYTES: u64 = 50;

/// The number of triangles that bytes 80..84 announce.
pub(super) fn announced(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEAD_BYTES)?;
    Some(u32::from_le_bytes([count[0], count[1], count[2], count[3]]))
}

/// Whether the length is exactly what the announced count needs.
pub(super) fn has_exact_length(bytes: &[u8]) -> bool {
    fits(bytes, bytes.len() as u64)
}

/// The same of a file of so many bytes, of which `head` are the first.
pub(super) fn fits(head: &[u8], length: u64) -> bool {
    let needed = announced(head).map(|n| HEAD_BYTES as u64 + TRIANGLE_BYTES * u64::from(n));
    needed == Some(length)
}

/// Reads bytes that [have the exact length](has_exact_length).
pub(super) fn parse(mut bytes: Vec<u8>, file: &Path) -> Result<Soup> {
    let mut soup = Soup::of_format(Format::Binary);
    soup.facets.reserve_exact(bytes.len() / TRIANGLE_BYTES as usize);
    soup.solids.push(header_text(&bytes[..80]));
    // stl_io takes a header that begins with `solid` for text, and searches the whole file for the end of the line.
    bytes[0] = b'\n';
    let mut bytes = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut bytes).map_err(Error::file("read", file))?;
    for triangle in triangles {
        let triangle = triangle.map_err(Error::file("read", file))?;
        let wide = |v: [f32; 3]| Vec3::from(v.map(f64::from));
        let facet = triangle.vertices.map(|vertex| wide(vertex.0));
        if let Some(bad) = facet.iter().find(|corner| !corner.iter().all(|x| x.is_finite())) {
            let place = format!("triangle {}", soup.facets.len() + 1);
            let found = format!("corner ({}, {}, {}) is not finite", bad.x, bad.y, bad.z);
            return Err(Error::input(file, place, found, "repair the mesh where it was made"));
        }
        soup.push(wide(triangle.normal.0), facet);
    }
    Ok(soup)
}

/// The readable start of the header.
fn header_text(header: &[u8]) -> String {
    let end = header.iter().position(|&byte| byte == 0).unwrap_or(header.len());
    String::from_utf8_lossy(&header[..end]).trim().to_owned()
}

/// The facets as a binary STL. Coordinates are rounded to `f32`: see [`Spacing`].
pub fn binary_bytes(facets: &[Facet]) -> Vec<u8> {
    let narrow = |v: &Vec3| stl_io::Vector::new([v.x as f32, v.y as f32, v.z as f32]);
    let triangles: Vec<stl_io::Triangle> = facets
        .iter()
        .map(|facet| stl_io::Triangle {
            normal: narrow(&unit_normal(facet)),
            vertices: [narrow(&facet[0]), narrow(&facet[1]), narrow(&facet[2])],
        })
        .collect();
    let mut bytes = Vec::with_capacity(HEAD_BYTES + TRIANGLE_BYTES as usize * facets.len());
    let _ = stl_io::write_stl(&mut bytes, triangles.iter()); // writing into memory cannot fail
    bytes
}

/// Writes a binary STL.
///
/// # Errors
/// Coordinates so large that `f32` would spoil the mesh ([`Spacing::spoils`]): subtract an origin first. A file that
/// cannot be written.
pub fn write_binary(path: &Path, facets: &[Facet]) -> Result<()> {
    let spacing = Spacing::of(&facets.to_vec().into());
    if spacing.spoils() {
        let remedy = "subtract a map origin first, or write ASCII";
        return Err(Error::input(path, "coordinates", spacing.to_string(), remedy));
    }
    file::write(path, &binary_bytes(facets))
}
