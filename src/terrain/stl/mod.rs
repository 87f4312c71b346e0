//! STL files, text and binary.
//!
//! A file is taken for what its length says, never for what its header says: `84 + 50 n` bytes with `n` at byte 80 is
//! binary, even when the header begins with `solid`. Anything else must begin with `solid` and is text.

mod ascii;
mod binary;
mod spacing;
#[cfg(test)]
mod tests;

pub use ascii::{ascii_text, write_ascii};
pub use binary::{binary_bytes, write_binary};
pub use spacing::Spacing;

use crate::error::{Error, Result};
use crate::rock::Vec3;
use std::path::Path;

/// Cosine of 30°: a stored normal further from the winding than this disagrees with it.
const COS_NORMAL_OFF: f64 = 0.866_025_403_784_438_6;

/// A facet: its three corners, anticlockwise seen from outside (from above, on a slope).
pub type Facet = [Vec3; 3];

/// How an STL file stores its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Text: every digit that was written is kept.
    Ascii,
    /// 50 bytes a triangle, coordinates as 32-bit floats (7 digits).
    Binary,
}

/// The facets of one STL file as they stand there: nothing shared, nothing repaired, all coordinates finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Soup {
    /// Corners of each facet in file order, in the file's own unit and axes.
    pub facets: Vec<Facet>,
    /// Names of the solids in the file (may be empty strings); the header text of a binary file.
    pub solids: Vec<String>,
    /// How the file stores its numbers.
    pub format: Format,
    /// Facets whose stored normal points more than 30° away from the one their winding gives. Stored normals are
    /// never used; a disagreement tells that a program turned the file or its facets and forgot the other.
    pub normals_off: Vec<u32>,
}

impl From<Vec<Facet>> for Soup {
    /// A made mesh, with all its digits.
    fn from(facets: Vec<Facet>) -> Self {
        Self { facets, ..Self::empty(Format::Ascii) }
    }
}

impl Soup {
    fn empty(format: Format) -> Self {
        Self { facets: Vec::new(), solids: Vec::new(), format, normals_off: Vec::new() }
    }

    /// Takes one more facet; its stored normal (any length, may be zero or NaN) is compared and forgotten.
    fn push(&mut self, stored_normal: Vec3, facet: Facet) {
        let normal = area_vector(&facet);
        let lengths = stored_normal.norm() * normal.norm();
        // NaN compares false: a normal that is not a number says nothing.
        if lengths > 0.0 && stored_normal.dot(&normal) < COS_NORMAL_OFF * lengths {
            self.normals_off.push(self.facets.len() as u32);
        }
        self.facets.push(facet);
    }
}

/// Reads an STL file of either kind.
///
/// # Errors
/// A file that cannot be read, or [`parse`]'s.
pub fn read(path: &Path) -> Result<Soup> {
    let bytes = std::fs::read(path).map_err(Error::file("read", path))?;
    parse(bytes, path)
}

/// Reads the bytes of an STL file; `file` is for messages.
///
/// Memory stays within a small multiple of the file's length, whatever count the file claims.
///
/// # Errors
/// Bytes that are no STL, a file cut off, a number that is not finite, a face with more than three corners, or no
/// facet at all: with the line (text) or triangle (binary), counted from 1.
pub fn parse(bytes: Vec<u8>, file: &Path) -> Result<Soup> {
    let soup = if binary::has_exact_length(&bytes) {
        binary::parse(bytes, file)?
    } else if ascii::begins_like_text(&bytes) {
        ascii::parse(&bytes, file)?
    } else {
        return Err(neither(&bytes, file));
    };
    if soup.facets.is_empty() {
        let remedy = "leave the file out of the scene or export it again";
        return Err(Error::input(file, "mesh", "the file holds no triangle", remedy));
    }
    Ok(soup)
}

fn neither(bytes: &[u8], file: &Path) -> Error {
    let remedy = "export the mesh again as STL, binary or ASCII";
    let Some(triangles) = binary::announced(bytes) else {
        let found = format!("{} bytes that do not begin with `solid`", bytes.len());
        return Error::input(file, "start", found, remedy);
    };
    let expected = 84 + 50 * u64::from(triangles);
    let found = format!(
        "no text STL, and as binary STL it announces {triangles} triangles \
         = {expected} bytes, but has {}",
        bytes.len()
    );
    Error::input(file, "bytes 80 to 83", found, format!("the file is cut off or no STL: {remedy}"))
}

/// Twice the area, along the normal that the winding gives (right-hand rule).
pub(super) fn area_vector([a, b, c]: &Facet) -> Vec3 {
    (b - a).cross(&(c - a))
}

/// The unit normal that the winding gives; zero for a facet without area. What writers store.
fn unit_normal(facet: &Facet) -> Vec3 {
    // `+ 0.0` turns −0.0 into 0.0.
    area_vector(facet).try_normalize(0.0).unwrap_or_else(Vec3::zeros).map(|x| x + 0.0)
}
