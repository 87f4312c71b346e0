//! STL files, text and binary.

use crate::rock::Vec3;

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
    pub facets: Vec<[Vec3; 3]>,
    /// Names of the solids in the file (may be empty strings); the header text of a binary file.
    pub solids: Vec<String>,
    /// How the file stores its numbers.
    pub format: Format,
    /// Facets whose stored normal points more than 30° away from the one their winding gives. Stored normals are
    /// never used; a disagreement tells that a program turned the file or its facets and forgot the other.
    pub normals_off: Vec<u32>,
}
