//! Triangles that are left out as the mesh has them twice: those with the corners of another, and those that others cover.

use super::{Tally, Welded, drop_at};
use crate::parallel;
use crate::terrain::edges::Edges;

impl Welded {
    /// Lists the edges, once triangles that are there twice are dropped.
    pub(super) fn list_edges(&mut self) {
        self.find_edges();
        let again = self.duplicates();
        if !again.is_empty() {
            self.edges = Edges::default();
            let mut duplicates = std::mem::take(&mut self.duplicates);
            self.drop_triangles(&again, &mut duplicates);
            self.duplicates = duplicates;
            self.find_edges();
        }
    }

    /// Finds the edges of the triangles as they are now; what was known of parts was of those before.
    fn find_edges(&mut self) {
        self.edges = Edges::of(&self.triangles);
        self.forget_parts();
    }

    /// Drops triangles that those before them cover.
    ///
    /// A ball touches what lies on each other within rounding once, but counts it twice where it presses into edges and corners that
    /// both have, so that the energy of a contact would jump by half from one place to the next.
    pub(super) fn drop_covered(&mut self) {
        let covered = self.covered_triangles();
        if !covered.is_empty() {
            let mut tally = Tally::default();
            self.drop_triangles(&covered, &mut tally);
            self.covered = tally;
            self.find_edges();
        }
    }

    /// All triangles but the first with the same three corners, wound either way; ascending.
    fn duplicates(&self) -> Vec<u32> {
        let third = |side: u32| {
            let (corners, k) = (self.triangles[side as usize / 3], side as usize % 3);
            corners[(k + 2) % 3]
        };
        let is_again = |t: u32| {
            let same = |side: u32| side / 3 < t && third(side) == third(3 * t);
            self.edges.sides_on(3 * t).any(same)
        };
        parallel::filter(self.triangles.len(), is_again)
    }

    /// Drops triangles, ascending, and tallies where they were.
    fn drop_triangles(&mut self, dropped: &[u32], tally: &mut Tally) {
        for &t in dropped {
            tally.add(self.on_map(self.corners_m(t as usize)[0]));
        }
        drop_at(&mut self.triangles, dropped);
        drop_at(&mut self.sheet_of, dropped);
        drop_at(&mut self.facet_of, dropped);
    }
}
