//! Whether trees given as meshes stand on the slope: what a program exports in other heights or at another place is met by no rock.

use super::Terrain;
use super::stem_pieces::stem_groups;
use crate::rock::Vec3;
use std::path::PathBuf;

/// A stem whose foot is higher above the slope than this (m) does not stand on it.
const FOOT_ABOVE_M: f64 = 0.5;

/// How the stems of one file meet the slope. What hangs together by common corners is one stem, and what stands on it or in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StandingStems {
    /// The file.
    pub path: PathBuf,
    /// Stems in it.
    pub stems: usize,
    /// Stems whose foot is more than half a metre above the slope.
    pub above: usize,
    /// Stems whose top is under the slope.
    pub below: usize,
    /// Stems beside the slope.
    pub beside: usize,
}

impl StandingStems {
    /// Stems that do not stand on the slope.
    pub fn astray(&self) -> usize {
        self.above + self.below + self.beside
    }
}

/// Where a stem is against the slope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Foot {
    Stands,
    Above,
    Below,
    Beside,
}

/// The ends of one stem as they are found, corner by corner (m, local).
#[derive(Debug, Clone, Copy)]
struct StemBox {
    sheet: u16,
    foot: Vec3,
    low: Vec3,
    high: Vec3,
}

impl StemBox {
    fn of(sheet: u16, corner: Vec3) -> Self {
        Self { sheet, foot: corner, low: corner, high: corner }
    }

    fn add(&mut self, corner: &Vec3) {
        if corner.z < self.foot.z {
            self.foot = *corner;
        }
        (self.low, self.high) = (self.low.inf(corner), self.high.sup(corner));
    }

    /// Looked at below its lowest corner and below its middle: one of many that stand on a steep slope has a corner over it.
    fn stands(&self, terrain: &Terrain) -> Foot {
        let middle = (self.low + self.high) / 2.0;
        let feet = [self.foot, middle].map(|at| self.stands_at(terrain, [at.x, at.y]));
        let is_one = |foot: &&Foot| feet.contains(*foot);
        let order = [Foot::Stands, Foot::Above, Foot::Below];
        *order.iter().find(is_one).unwrap_or(&Foot::Beside)
    }

    fn stands_at(&self, terrain: &Terrain, [x, y]: [f64; 2]) -> Foot {
        match terrain.ground_under(x, y, self.high.z) {
            Some(ground_m) if ground_m >= self.low.z - FOOT_ABOVE_M => Foot::Stands,
            Some(_) => Foot::Above,
            None if terrain.ground_below(x, y).is_some() => Foot::Below,
            None => Foot::Beside,
        }
    }
}

impl Terrain {
    /// How the stems of every file of trees meet the slope, file by file.
    pub fn standing_stems(&self) -> Vec<StandingStems> {
        let of_file = |(number, path): (usize, &PathBuf)| {
            let none =
                StandingStems { path: path.clone(), stems: 0, above: 0, below: 0, beside: 0 };
            (number as u16, none)
        };
        let trees = self.sheets.iter().enumerate().filter(|(_, sheet)| sheet.is_tree);
        let mut files: Vec<_> =
            trees.map(|(number, sheet)| of_file((number, &sheet.path))).collect();
        for stem in self.stem_boxes(!files.is_empty()) {
            let Some((_, file)) = files.iter_mut().find(|(sheet, _)| *sheet == stem.sheet) else {
                continue;
            };
            file.stems += 1;
            match stem.stands(self) {
                Foot::Stands => {}
                Foot::Above => file.above += 1,
                Foot::Below => file.below += 1,
                Foot::Beside => file.beside += 1,
            }
        }
        files.into_iter().map(|(_, file)| file).collect()
    }

    /// The stems, one after the other as their triangles come.
    fn stem_boxes(&self, has_trees: bool) -> Vec<StemBox> {
        if !has_trees {
            return Vec::new();
        }
        let trees: Vec<u32> =
            (0..self.triangles.len() as u32).filter(|&t| self.is_tree(t)).collect();
        let mut groups = stem_groups(self, &trees);
        let (mut number_of, mut boxes) = (vec![u32::MAX; self.vertices_m.len()], Vec::new());
        for &t in &trees {
            let corners = self.corners_m(t);
            let number = &mut number_of[groups.lowest(self.triangles[t as usize][0]) as usize];
            if *number == u32::MAX {
                *number = boxes.len() as u32;
                boxes.push(StemBox::of(self.sheet_of[t as usize], corners[0]));
            }
            for corner in &corners {
                boxes[*number as usize].add(corner);
            }
        }
        boxes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::Sheet;
    use crate::terrain::make::{Stem, stem};
    use crate::terrain::stl::{Facet, Soup};
    use crate::terrain::weld::{Piece, Up, weld};
    use std::path::Path;

    /// A slope of 45°, 20 m x 20 m, whose height is that of x.
    fn slope() -> Vec<Facet> {
        let [a, b, c, d] =
            [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]].map(|[x, y]| Vec3::new(x, y, x));
        vec![[a, b, c], [a, c, d]]
    }

    fn standing(lift_m: f64, aside_m: f64) -> StandingStems {
        let tree = |x_m: f64| Stem { x_m: x_m + aside_m, y_m: 9.0, dbh_m: 0.4, height_m: 15.0 };
        let trees: Vec<Facet> =
            [4.0, 8.0, 16.0].iter().flat_map(|&x| stem(&tree(x), x + lift_m)).collect();
        let soups = [slope(), trees].map(Soup::from);
        let piece = |sheet: u16| Piece {
            file: Path::new(""),
            soup: &soups[usize::from(sheet)],
            up: Up::Z,
            scale: 1.0,
            sheet,
        };
        let welded = weld(&[piece(0), piece(1)], Vec3::zeros(), None).unwrap();
        let sheet = |is_tree: bool| Sheet { path: "s.stl".into(), ground: 0, is_tree };
        let terrain = Terrain::new(welded, vec![sheet(false), sheet(true)]);
        let found = terrain.standing_stems();
        assert_eq!(found.len(), 1);
        found[0].clone()
    }

    /// Feet are sunk into the slope by half a metre: at the axis, and on steep ground less or more beside it.
    #[test]
    fn stems_that_do_not_meet_the_slope_are_counted() {
        let counts = |lift_m: f64, aside_m: f64| {
            let StandingStems { stems, above, below, beside, .. } = standing(lift_m, aside_m);
            [stems, above, below, beside]
        };
        assert_eq!(counts(0.0, 0.0), [3, 0, 0, 0]);
        assert_eq!(counts(-5.0, 0.0), [3, 0, 0, 0]);
        assert_eq!(counts(0.7, 0.0), [3, 0, 0, 0]);
        assert_eq!(counts(10.0, 0.0), [3, 3, 0, 0]);
        assert_eq!(counts(-100.0, 0.0), [3, 0, 3, 0]);
        assert_eq!(counts(0.0, 25.0), [3, 0, 0, 3]);
        assert_eq!(counts(12.0, 10.0), [3, 2, 0, 1]);
        assert_eq!(standing(10.0, 0.0).astray(), 3);
    }
}
