//! STL files, text and binary.
//!
//! A file is taken for what its length says, never for what its header says: `84 + 50 n` bytes with `n` at byte 80 is
//! binary, even when the header begins with `solid`. Anything else must begin with `solid` and is text.

mod ascii;
mod binary;
mod digits;
mod spacing;
#[cfg(test)]
mod tests;

pub use ascii::{ascii_text, write_ascii};
pub use binary::{binary_bytes, write_binary};
pub use digits::{CoarseText, LastDigits};
pub use spacing::Spacing;

pub use super::facets::Facet;

use super::facets::Facets;
use crate::count::number_of;
use crate::error::{Error, Result};
use crate::file::{self, LONGEST_MESH};
use crate::rock::Vec3;
use std::path::Path;

/// Cosine of 30°: a stored normal further from the winding than this disagrees with it.
const COS_NORMAL_OFF: f64 = 0.866_025_403_784_438_6;

/// What a file is; of STL also how it stores its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// STL as text: every digit that was written is kept.
    Ascii,
    /// STL, 50 bytes a triangle, coordinates as 32-bit floats (7 digits).
    Binary,
    /// GeoTIFF elevation model.
    GeoTiff,
    /// ESRI ASCII grid.
    AsciiGrid,
    /// PLY mesh.
    Ply,
    /// Wavefront OBJ mesh.
    Obj,
    /// LAS or LAZ point cloud.
    Cloud,
    /// List or drawing of trees.
    Trees,
}

impl Format {
    /// Whether it holds triangles or points, and not the cells of an elevation model or trees.
    pub(in crate::terrain) fn is_mesh(self) -> bool {
        !matches!(self, Self::GeoTiff | Self::AsciiGrid | Self::Trees)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ASCII STL",
            Self::Binary => "binary STL",
            Self::GeoTiff => "GeoTIFF",
            Self::AsciiGrid => "ESRI ASCII grid",
            Self::Ply => "PLY",
            Self::Obj => "OBJ",
            Self::Cloud => "point cloud",
            Self::Trees => "list of trees",
        }
    }
}

/// The facets of one file as they stand there: nothing shared, nothing repaired, all coordinates finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Soup {
    /// Corners of each facet in file order, in the file's own unit and axes.
    pub facets: Facets,
    /// Names of the solids in the file (may be empty strings); the header text of a binary file.
    pub solids: Vec<String>,
    /// How the file stores its numbers.
    pub format: Format,
    /// Facets whose stored normal points more than 30° away from the one their winding gives. Stored normals are
    /// never used; a disagreement tells that a program turned the file or its facets and forgot the other.
    pub normals_off: Vec<u32>,
    /// Whether coordinates are stored as 32-bit floats.
    pub is_single: bool,
    /// The last digits of its numbers, where they are looked at: in texts.
    pub last_digits: LastDigits,
    /// EPSG code of its coordinates, where the file names one.
    pub epsg: Option<u32>,
    /// What the file holds and what was done with it, in words.
    pub notes: Vec<String>,
    /// What looks wrong in it, in words.
    pub warnings: Vec<String>,
}

impl From<Vec<Facet>> for Soup {
    /// A made mesh, with all its digits.
    fn from(facets: Vec<Facet>) -> Self {
        Self { facets: facets.into(), ..Self::of_format(Format::Ascii) }
    }
}

impl Soup {
    pub(super) fn of_format(format: Format) -> Self {
        Self {
            facets: Facets::default(),
            solids: Vec::new(),
            format,
            normals_off: Vec::new(),
            is_single: format == Format::Binary,
            last_digits: LastDigits::default(),
            epsg: None,
            notes: Vec::new(),
            warnings: Vec::new(),
        }
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
    parse(file::read(path, LONGEST_MESH)?, path)
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

/// How other files begin that end up under the name of an STL file, and what to do about them.
const OTHER_KINDS: [(&[u8], &str, &str); 14] = [
    (b"II*\0", "a GeoTIFF", GRID),
    (b"MM\0*", "a GeoTIFF", GRID),
    (b"\xff\xfe", "text in UTF-16", "save it as UTF-8 or ASCII"),
    (b"\xfe\xff", "text in UTF-16", "save it as UTF-8 or ASCII"),
    (b"PK\x03\x04", "a ZIP archive", "unpack it and write the STL file in it"),
    (b"\x1f\x8b", "a gzip archive", "unpack it and write the STL file in it"),
    (b"<!DOCTYPE", "a web page", "download the mesh again"),
    (b"<html", "a web page", "download the mesh again"),
    (b"<?xml", "an XML file", EXPORT),
    (b"\x89PNG", "a PNG image", EXPORT),
    (b"ply", "a PLY file", MESH),
    (b"glTF", "a glTF file", EXPORT),
    (b"v ", "a Wavefront OBJ file", MESH),
    (b"ncols", "an ESRI ASCII grid", GRID),
];

/// What to do about an elevation model in the place of an STL file.
const GRID: &str = "a scene reads it under `file` in the place of `mesh`; `rockfall mesh from-grid` turns it into STL";

/// What to do about another mesh in the place of an STL file.
const MESH: &str =
    "a scene reads it under `file` in the place of `mesh`; or export it as STL, binary or ASCII";

/// What to do about a file that is no STL.
const EXPORT: &str = "export the mesh again as STL, binary or ASCII";

/// Whether a file of so many bytes can be an STL of either kind; `head` is how it begins.
pub(super) fn may_be_stl(head: &[u8], length: u64) -> bool {
    ascii::begins_like_text(head) || binary::fits(head, length)
}

/// Whether it is of a kind that [`neither`] names, or holds nothing.
pub(super) fn is_of_other_kind(head: &[u8]) -> bool {
    head.is_empty() || OTHER_KINDS.iter().any(|(start, ..)| head.starts_with(start))
}

/// Why bytes that are neither kind of STL are refused.
fn neither(bytes: &[u8], file: &Path) -> Error {
    if bytes.is_empty() {
        return Error::input(file, "start", "the file is empty", EXPORT);
    }
    if let Some((_, kind, remedy)) = OTHER_KINDS.iter().find(|(start, ..)| bytes.starts_with(start))
    {
        return Error::input(file, "start", format!("found {kind}, no STL"), *remedy);
    }
    let (Some(triangles), false) = (binary::announced(bytes), is_text(bytes)) else {
        let bytes = number_of(bytes.len() as u64, "byte");
        let found = format!("{bytes} that do not begin with `solid`");
        return Error::input(file, "start", found, EXPORT);
    };
    let expected = 84 + 50 * u64::from(triangles);
    let found = format!(
        "as binary STL the file announces {triangles} triangles = {expected} bytes, but has {}",
        bytes.len()
    );
    let why =
        if (bytes.len() as u64) < expected { "the file is cut off" } else { "too many bytes" };
    Error::input(file, "bytes 80 to 83", found, format!("{why}, or it is no STL: {EXPORT}"))
}

/// Whether the head reads like text: a binary STL has zero bytes or others that no text has in its first 84.
fn is_text(bytes: &[u8]) -> bool {
    let printed =
        |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace() || *byte >= 0x80;
    bytes[..bytes.len().min(84)].iter().all(printed)
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
