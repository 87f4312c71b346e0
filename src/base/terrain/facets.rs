//! The facets of a file: each with corners of its own, as STL has them, or over common points, as grids have them.
//!
//! Facets over common points take a third of the memory, and a common point is placed and welded once instead of six times.

use crate::rock::Vec3;

/// A facet: its three corners, anticlockwise seen from outside (from above, on a slope).
pub type Facet = [Vec3; 3];

/// Facets in the order of their file.
#[derive(Debug, Clone)]
pub enum Facets {
    /// Each has corners of its own.
    Apart(Vec<Facet>),
    /// They have common points.
    Shared {
        /// The points; some may belong to no facet.
        points: Vec<Vec3>,
        /// Numbers of the points of each facet.
        corners: Vec<[u32; 3]>,
        /// No two points are closer (in the file's unit); 0 where that is not known.
        apart_m: f64,
    },
}

impl Default for Facets {
    fn default() -> Self {
        Self::Apart(Vec::new())
    }
}

impl From<Vec<Facet>> for Facets {
    fn from(facets: Vec<Facet>) -> Self {
        Self::Apart(facets)
    }
}

impl Extend<Facet> for Facets {
    fn extend<I: IntoIterator<Item = Facet>>(&mut self, facets: I) {
        facets.into_iter().for_each(|facet| self.push(facet));
    }
}

/// The same facets in the same order, however they are kept.
impl PartialEq for Facets {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl<T: AsRef<[Facet]>> PartialEq<T> for Facets {
    fn eq(&self, other: &T) -> bool {
        self.iter().eq(other.as_ref().iter().copied())
    }
}

impl Facets {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Apart(facets) => facets.len(),
            Self::Shared { corners, .. } => corners.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them.
    ///
    /// # Panics
    /// If there are fewer.
    #[inline]
    pub fn at(&self, number: usize) -> Facet {
        match self {
            Self::Apart(facets) => facets[number],
            Self::Shared { points, corners, .. } => {
                let [a, b, c] = corners[number];
                let at = |point: u32| points[point as usize];
                [at(a), at(b), at(c)]
            }
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Facet> + '_ {
        (0..self.len()).map(|number| self.at(number))
    }

    /// Adds one, with corners of its own.
    pub fn push(&mut self, facet: Facet) {
        match self {
            Self::Apart(facets) => facets.push(facet),
            Self::Shared { points, corners, apart_m } => {
                *apart_m = 0.0;
                add(points, corners, facet);
            }
        }
    }

    /// Memory that they take (bytes).
    pub fn bytes(&self) -> usize {
        match self {
            Self::Apart(facets) => facets.capacity() * size_of::<Facet>(),
            Self::Shared { points, corners, .. } => {
                points.capacity() * size_of::<Vec3>() + corners.capacity() * size_of::<[u32; 3]>()
            }
        }
    }

    /// Makes room for exactly so many more.
    pub(super) fn reserve_exact(&mut self, more: usize) {
        match self {
            Self::Apart(facets) => facets.reserve_exact(more),
            Self::Shared { corners, .. } => corners.reserve_exact(more),
        }
    }

    /// The same with some of them cut: `pieces` says of each into what, nothing if it stays whole.
    ///
    /// # Errors
    /// Those of `pieces`.
    pub(super) fn cut<E>(
        self,
        mut pieces: impl FnMut(usize, &Facet) -> Result<Vec<Facet>, E>,
    ) -> Result<Self, E> {
        match self {
            Self::Apart(facets) => {
                let mut all = Vec::with_capacity(facets.len());
                for (number, facet) in facets.into_iter().enumerate() {
                    match pieces(number, &facet)? {
                        cut if cut.is_empty() => all.push(facet),
                        cut => all.extend(cut),
                    }
                }
                Ok(Self::Apart(all))
            }
            Self::Shared { mut points, corners, mut apart_m } => {
                let mut all = Vec::with_capacity(corners.len());
                for (number, whole) in corners.into_iter().enumerate() {
                    let cut = pieces(number, &whole.map(|point| points[point as usize]))?;
                    if cut.is_empty() {
                        all.push(whole);
                    }
                    for facet in cut {
                        apart_m = 0.0;
                        add(&mut points, &mut all, facet);
                    }
                }
                Ok(Self::Shared { points, corners: all, apart_m })
            }
        }
    }
}

fn add(points: &mut Vec<Vec3>, corners: &mut Vec<[u32; 3]>, facet: Facet) {
    let first = points.len() as u32;
    points.extend(facet);
    corners.push([first, first + 1, first + 2]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shared() -> Facets {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let points = points.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
        Facets::Shared { points, corners: vec![[0, 1, 2], [0, 2, 3]], apart_m: 1.0 }
    }

    /// Both kinds hold the same facets, before and after some are cut and added.
    #[test]
    fn common_points_change_nothing() {
        let halves = |number: usize, [a, b, c]: &Facet| -> Result<Vec<Facet>, ()> {
            let middle = (a + b) / 2.0;
            Ok(if number == 1 { vec![[*a, middle, *c], [middle, *b, *c]] } else { Vec::new() })
        };
        let apart = Facets::from(shared().iter().collect::<Vec<_>>());
        assert_eq!(apart, shared());
        let [mut one, mut other] = [apart, shared()].map(|facets| facets.cut(halves).unwrap());
        assert_eq!((one.len(), other.len()), (3, 3));
        one.push(other.at(0));
        other.push(other.at(0));
        assert_eq!(one, other);
        assert_ne!(one, shared());
    }
}
