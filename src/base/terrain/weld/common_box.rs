//! The common box of all files of a mesh.

use super::{Piece, PieceBox, far, longest_m};
use crate::error::{Error, Result};
use crate::parallel;
use crate::rock::Vec3;

/// Largest coordinate (m); the Earth is 4e7 m around.
const LARGEST_M: f64 = 1e8;

/// Three corners of this many facets can be numbered with 32 bits.
const MOST_FACETS: usize = u32::MAX as usize / 3;

/// The common box of all pieces.
pub(super) struct CommonBox {
    /// Centre, rounded to whole metres: coordinates read as `f32` subtract it without rounding.
    pub(super) centre_m: Vec3,
    /// Longest side.
    pub(super) size_m: f64,
    pub(super) facets: usize,
}

impl CommonBox {
    /// # Errors
    /// A scale that is not usable, coordinates larger than the Earth, too many facets, pieces far from each other.
    pub(super) fn around(pieces: &[Piece]) -> Result<Self> {
        let spans: Vec<PieceBox> = pieces.iter().map(Piece::span).collect::<Result<_>>()?;
        let facets = pieces.iter().map(|piece| piece.soup.facets.len()).sum();
        if facets > MOST_FACETS {
            return Err(Error::Request(format!(
                "the terrain has {facets} facets; thin it out to {MOST_FACETS} or fewer"
            )));
        }
        let (low, high) = spans.iter().copied().fold(NOTHING, both);
        let size_m = longest_m(&(low, high));
        far::check_apart(pieces, &spans, size_m)?;
        Ok(Self { centre_m: (low / 2.0 + high / 2.0).map(f64::round), size_m, facets })
    }
}

const NOTHING: PieceBox =
    (Vec3::new(LARGEST_M, LARGEST_M, LARGEST_M), Vec3::new(-LARGEST_M, -LARGEST_M, -LARGEST_M));

fn both(one: PieceBox, other: PieceBox) -> PieceBox {
    (one.0.inf(&other.0), one.1.sup(&other.1))
}

impl Piece<'_> {
    /// Its box.
    fn span(&self) -> Result<PieceBox> {
        self.check_scale()?;
        let box_of = |facet: [Vec3; 3]| {
            let [a, b, c] = facet.map(|corner| self.placed(corner));
            (a.inf(&b).inf(&c), a.sup(&b).sup(&c))
        };
        let facets = &self.soup.facets;
        let grown = |all, number| both(all, box_of(facets.at(number)));
        let span = parallel::fold(facets.len(), &NOTHING, grown, both);
        if span.0.min() < -LARGEST_M || span.1.max() > LARGEST_M {
            return Err(self.too_far());
        }
        Ok(span)
    }

    /// Its first facet with a coordinate beyond [`LARGEST_M`].
    fn too_far(&self) -> Error {
        let far = |&corner: &Vec3| self.placed(corner).amax() > LARGEST_M;
        let facets = &self.soup.facets;
        let is_far = |&number: &usize| facets.at(number).iter().any(far);
        let number = (0..facets.len()).find(is_far).unwrap_or(0);
        let found = format!("coordinates beyond {LARGEST_M:e} m, more than around the Earth");
        let remedy = "check the unit and `scale`, or repair the mesh where it was made";
        Error::input(self.file, format!("triangle {}", number + 1), found, remedy)
    }
}
