//! Wavefront OBJ meshes: `v` and `f` lines, all digits of the text kept; everything else is for renderers.

use super::{fan, parsed, wrong};
use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::terrain::stl::{Format, Soup};
use std::path::Path;

/// Whether bytes begin like an OBJ file: it has no mark of its own.
pub(super) fn begins_like_obj(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let mut words = head.lines().filter_map(|line| line.split_ascii_whitespace().next());
    let first = words.find(|word| !word.starts_with('#'));
    first.is_some_and(|word| ["v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl"].contains(&word))
}

/// Reads the bytes of an OBJ file; `file` is for messages.
///
/// # Errors
/// A line of `v` or `f` that cannot be read, a face with an unknown corner, or no face; with its line.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Soup> {
    let (mut corners, mut soup) = (Vec::new(), Soup::of_format(Format::Obj));
    for (number, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let refused = |remedy: &str| -> Error {
            let found = format!("found `{}`", String::from_utf8_lossy(line).trim());
            wrong(file, format!("line {}", number + 1), found, remedy)
        };
        match words.next() {
            Some(b"v") => {
                let numbers = words.take(3).enumerate().map(|(axis, word)| {
                    soup.last_digits.see(axis, word);
                    parsed(word)
                });
                let xyz: Option<Vec<f64>> = numbers.collect();
                match xyz.as_deref() {
                    Some(&[x, y, z]) if [x, y, z].iter().all(|m| m.is_finite()) => {
                        corners.push(Vec3::new(x, y, z));
                    }
                    _ => return Err(refused("write `v x y z` with finite numbers")),
                }
            }
            Some(b"f") => {
                let polygon: Option<Vec<Vec3>> = words.map(|word| corner(&corners, word)).collect();
                let polygon = polygon.filter(|polygon| polygon.len() > 2).ok_or_else(|| {
                    refused("write `f` and three or more numbers of vertices before it, from 1")
                })?;
                soup.facets.extend(fan(&polygon));
            }
            _ => {}
        }
    }
    if soup.facets.is_empty() {
        return Err(wrong(
            file,
            "mesh",
            "the file holds no face",
            "export the mesh with its faces",
        ));
    }
    Ok(soup)
}

/// The corner that `7`, `7/1`, `7//3` or, counted from the end, `-1` names.
fn corner(corners: &[Vec3], word: &[u8]) -> Option<Vec3> {
    let number = word.split(|&byte| byte == b'/').next()?;
    let number: isize = std::str::from_utf8(number).ok()?.parse().ok()?;
    let index = if number < 0 {
        corners.len().checked_add_signed(number)?
    } else {
        usize::try_from(number - 1).ok()?
    };
    corners.get(index).copied()
}
