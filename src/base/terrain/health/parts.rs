//! Which part of the mesh a triangle belongs to: what shares edges hangs together.

use crate::parallel;
use crate::terrain::weld::Welded;

/// Steepest triangles that make a sheet, as cosine of their inclination (–): 80°. The rim of a wall or a stem looks nowhere.
pub(super) const LEAST_FLAT: f64 = 0.17;

/// The parts, numbered from 0, the largest first.
pub(super) struct Parts {
    /// Triangles of each part.
    pub(super) sizes: Vec<usize>,
    /// Of each triangle.
    pub(super) of: Vec<u32>,
}

impl Parts {
    pub(super) fn of(welded: &Welded) -> Self {
        let mut groups = welded.parts();
        let mut of: Vec<u32> =
            (0..welded.triangles.len() as u32).map(|t| groups.lowest(t)).collect();
        drop(groups);
        // the lowest triangle of a part comes first: parts get numbers in the order of the mesh
        let mut sizes: Vec<(usize, u32)> = Vec::new();
        for t in 0..of.len() {
            let lowest = of[t] as usize;
            let number = if lowest == t { sizes.len() as u32 } else { of[lowest] };
            if lowest == t {
                sizes.push((0, number));
            }
            sizes[number as usize].0 += 1;
            of[t] = number;
        }
        sizes.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut rank = vec![0u32; sizes.len()];
        for (place, &(_, number)) in (0..).zip(&sizes) {
            rank[number as usize] = place;
        }
        parallel::update(&mut of, |_, number| *number = rank[*number as usize]);
        Self { sizes: sizes.into_iter().map(|(size, _)| size).collect(), of }
    }
}
