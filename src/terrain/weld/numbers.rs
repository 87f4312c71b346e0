//! The numbers that a file's points have in the mesh.

use crate::rock::Vec3;
use crate::terrain::facets::Facets;
use crate::terrain::merge::Merger;

/// The numbers of a file's points after merging; a common point is merged once.
pub(super) struct Numbers<'a> {
    /// Points of each facet; none where every facet has points of its own.
    corners: &'a [[u32; 3]],
    /// Number of each point, or [`NO_NUMBER`].
    known: Vec<u32>,
}

/// A point that was not asked for yet.
const NO_NUMBER: u32 = u32::MAX;

impl<'a> Numbers<'a> {
    pub(super) fn of(facets: &'a Facets) -> Self {
        match facets {
            Facets::Apart(_) => Self { corners: &[], known: Vec::new() },
            Facets::Shared { points, corners } => {
                Self { corners, known: vec![NO_NUMBER; points.len()] }
            }
        }
    }

    /// Of the corners of a facet, which lie where `at` says (m).
    pub(super) fn of_corners(
        &mut self,
        facet: usize,
        at: impl Fn(usize) -> Vec3,
        merger: &mut Merger,
    ) -> [u32; 3] {
        let Some(points) = self.corners.get(facet) else {
            return [0, 1, 2].map(|k| merger.number_of(at(k)));
        };
        [0, 1, 2].map(|k| {
            let known = &mut self.known[points[k] as usize];
            if *known == NO_NUMBER {
                *known = merger.number_of(at(k));
            }
            *known
        })
    }
}
