//! The numbers that a file's points have in the mesh.

use crate::parallel;
use crate::rock::Vec3;
use crate::terrain::facets::Facets;
use crate::terrain::merge::Merger;

/// The numbers of the corners of all facets, which lie where `local` puts them, and how many corners moved; `reach` is the
/// tolerance in the file's unit.
pub(super) fn of(
    facets: &Facets,
    reach: f64,
    local: &(impl Fn(Vec3) -> Vec3 + Sync),
    merger: &mut Merger,
) -> (Vec<[u32; 3]>, usize) {
    if let (true, Some(apart)) = (merger.kept_m().is_empty(), Apart::of(facets, reach)) {
        let at = |k: usize| local(apart.points_of_file[apart.used[k] as usize]);
        merger.keep_apart(parallel::map(apart.used.len(), at));
        return (apart.corners, 0);
    }
    merger.open();
    let mut numbers = PointNumbers::of(facets);
    let mut all = Vec::with_capacity(facets.len());
    all.extend(
        (0..facets.len())
            .map(|number| numbers.of_corners(number, |k| local(facets.at(number)[k]), merger)),
    );
    let moved = |sum, number: usize| {
        let (merged, corners) = (all[number], facets.at(number).map(local));
        sum + (0..3).filter(|&k| merger.kept_m()[merged[k] as usize] != corners[k]).count()
    };
    let moved = parallel::fold(all.len(), &0, moved, |one, other| one + other);
    (all, moved)
}

/// The numbers of a file's points after merging; a common point is merged once.
struct PointNumbers<'a> {
    /// Points of each facet; none where every facet has points of its own.
    corners: &'a [[u32; 3]],
    /// Number of each point, or [`NO_NUMBER`].
    known: Vec<u32>,
}

/// A point that was not asked for yet.
const NO_NUMBER: u32 = u32::MAX;

impl<'a> PointNumbers<'a> {
    fn of(facets: &'a Facets) -> Self {
        match facets {
            Facets::Apart(_) => Self { corners: &[], known: Vec::new() },
            Facets::Shared { points, corners, .. } => {
                Self { corners, known: vec![NO_NUMBER; points.len()] }
            }
        }
    }

    /// Of the corners of a facet, which lie where `at` says (m).
    fn of_corners(
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

/// Points that merge with no other, numbered in the order in which facets use them.
struct Apart<'a> {
    points_of_file: &'a [Vec3],
    /// Numbers of the corners of each facet.
    corners: Vec<[u32; 3]>,
    /// Which point has each number.
    used: Vec<u32>,
}

impl<'a> Apart<'a> {
    /// Of facets whose points are farther apart than `reach` (in the file's unit), as those of a lattice are; `None` where
    /// that is not known.
    fn of(facets: &'a Facets, reach: f64) -> Option<Self> {
        let (points, corners) = match facets {
            Facets::Shared { points, corners, apart_m } if *apart_m > reach => (points, corners),
            _ => return None,
        };
        let mut known = vec![NO_NUMBER; points.len()];
        let mut used = Vec::with_capacity(points.len());
        let mut number = |point: u32| {
            let known = &mut known[point as usize];
            if *known == NO_NUMBER {
                *known = used.len() as u32;
                used.push(point);
            }
            *known
        };
        let mut all = Vec::with_capacity(corners.len());
        all.extend(corners.iter().map(|facet| facet.map(&mut number)));
        Some(Self { points_of_file: points, corners: all, used })
    }
}
