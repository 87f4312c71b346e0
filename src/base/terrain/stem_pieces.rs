//! Which triangles of trees are one stem: what hangs together by common corners, and pieces that stand on each other or in each other.

use super::Terrain;
use crate::groups::Groups;
use crate::rock::Vec3;

/// Pieces with a wider gap of height between them (m) are stems of their own: trunk and crown leave less open.
const LARGEST_GAP_M: f64 = 0.5;

/// Axes that are nearer (m) are one, however thin the pieces are: crossed panels have no thickness.
const SAME_AXIS_M: f64 = 0.01;

/// What hangs together by common corners (m, local).
#[derive(Debug, Clone, Copy)]
struct StemPiece {
    sheet: u16,
    vertex: u32,
    low: Vec3,
    high: Vec3,
}

impl StemPiece {
    fn axis(&self) -> Vec3 {
        (self.low + self.high) / 2.0
    }

    /// Half of the smaller width in plan view (m): a stem that leans is not as thick as its box is long.
    fn radius_m(&self) -> f64 {
        let across = (self.high - self.low) / 2.0;
        across.x.min(across.y).max(SAME_AXIS_M)
    }

    /// Whether two pieces of one file are parts of one stem: their axes lie within the thinner of them in plan view, and their heights meet.
    fn is_of_one_stem(&self, other: &Self) -> bool {
        let near_m = self.radius_m().min(other.radius_m());
        let off = (self.axis() - other.axis()).xy();
        let gap_m = self.low.z.max(other.low.z) - self.high.z.min(other.high.z);
        self.sheet == other.sheet && off.norm() <= near_m && gap_m <= LARGEST_GAP_M
    }
}

/// The vertices of some triangles of trees in groups, one for each stem.
pub(super) fn stem_groups(terrain: &Terrain, triangles: &[u32]) -> Groups {
    let mut groups = Groups::of(terrain.vertices_m.len());
    for [a, b, c] in triangles.iter().map(|&t| terrain.triangles[t as usize]) {
        groups.join(a, b);
        groups.join(a, c);
    }
    let mut pieces = pieces(terrain, triangles, &mut groups);
    pieces.sort_by(|one, other| one.axis().x.total_cmp(&other.axis().x));
    for (number, piece) in pieces.iter().enumerate() {
        let east_m = piece.axis().x + piece.radius_m();
        let near = pieces[number + 1..].iter().take_while(|other| other.axis().x <= east_m);
        near.filter(|other| piece.is_of_one_stem(other))
            .for_each(|other| groups.join(piece.vertex, other.vertex));
    }
    groups
}

/// The pieces, one after the other as their triangles come.
fn pieces(terrain: &Terrain, triangles: &[u32], groups: &mut Groups) -> Vec<StemPiece> {
    let (mut number_of, mut pieces) = (vec![u32::MAX; terrain.vertices_m.len()], Vec::new());
    for &t in triangles {
        let [vertex, ..] = terrain.triangles[t as usize];
        let corners = terrain.corners_m(t);
        let number = &mut number_of[groups.lowest(vertex) as usize];
        if *number == u32::MAX {
            *number = pieces.len() as u32;
            let sheet = terrain.sheet_of[t as usize];
            pieces.push(StemPiece { sheet, vertex, low: corners[0], high: corners[0] });
        }
        let piece = &mut pieces[*number as usize];
        for corner in &corners {
            (piece.low, piece.high) = (piece.low.inf(corner), piece.high.sup(corner));
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Distribution;
    use crate::terrain::Sheet;
    use crate::terrain::make::{Stem, stem};
    use crate::terrain::stems::Stems;
    use crate::terrain::stl::{Facet, Soup};
    use crate::terrain::weld::{Piece, Up, weld};
    use std::path::Path;

    /// Prisms, each with its place, thickness, foot and top (m), as one file of trees over level ground at 0.
    fn stems(prisms: &[[f64; 5]]) -> Terrain {
        let [a, b, c, d] = [[-9.0, -9.0], [30.0, -9.0], [30.0, 9.0], [-9.0, 9.0]]
            .map(|[x, y]| Vec3::new(x, y, 0.0));
        let prism = |&[x_m, y_m, dbh_m, foot_m, top_m]: &[f64; 5]| {
            // a stem's foot is sunk in by half a metre
            let one = Stem { x_m, y_m, dbh_m, height_m: top_m - foot_m - 0.5 };
            stem(&one, foot_m + 0.5)
        };
        let trees: Vec<Facet> = prisms.iter().flat_map(prism).collect();
        let soups = [vec![[a, b, c], [a, c, d]], trees].map(Soup::from);
        let pieces = [0, 1].map(|sheet| Piece {
            file: Path::new(""),
            soup: &soups[usize::from(sheet)],
            up: Up::Z,
            scale: 1.0,
            sheet,
        });
        let welded = weld(&pieces, Vec3::zeros(), None).unwrap();
        let sheet =
            |is_tree: bool| Sheet { path: "s.stl".into(), ground: u16::from(is_tree), is_tree };
        Terrain::new(welded, vec![sheet(false), sheet(true)])
    }

    /// How many stems break on their own, how many are counted, and how many of them do not stand on the slope.
    fn counted(prisms: &[[f64; 5]]) -> [usize; 3] {
        let terrain = stems(prisms);
        let limits = vec![None, Some(Distribution::fixed(1e4).unwrap())];
        let breaking = Stems::of(&terrain, limits).unwrap().unwrap().count();
        let standing = &terrain.standing_stems()[0];
        [breaking, standing.stems, standing.astray()]
    }

    /// A crown over or round its trunk, and a trunk in sections, are one stem, which stands on its lowest piece and breaks as one. Neighbours, a trunk under
    /// the rim of another's crown, and what hangs far above are stems of their own.
    #[test]
    fn pieces_of_one_stem_are_joined() {
        let trunk = [0.0, 0.0, 0.4, -0.5, 6.0];
        let neighbour = [2.0, 0.0, 0.4, -0.5, 6.0];
        assert_eq!(counted(&[trunk, neighbour]), [2, 2, 0]);
        assert_eq!(counted(&[trunk, [0.1, 0.1, 5.0, 5.0, 15.0]]), [1, 1, 0]);
        assert_eq!(
            counted(&[[0.0, 0.0, 0.3, 12.0, 18.0], trunk, [0.0, 0.05, 0.4, 6.2, 11.8]]),
            [1, 1, 0]
        );
        assert_eq!(counted(&[trunk, neighbour, [0.1, 0.0, 5.0, 5.0, 15.0]]), [2, 2, 0]);
        assert_eq!(counted(&[trunk, [0.0, 0.0, 5.0, 8.0, 15.0]]), [2, 2, 1]);
        assert_eq!(counted(&[trunk, [0.3, 0.0, 0.4, -0.5, 6.0]]), [2, 2, 0]);
    }
}
