//! Which part of the mesh a triangle belongs to: what shares edges hangs together.

use super::Welded;
use crate::groups::Groups;
use crate::parallel;

/// The parts, numbered from 0, the largest first.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::terrain) struct Parts {
    /// Triangles of each part.
    pub(in crate::terrain) sizes: Vec<usize>,
    /// Of each triangle.
    pub(in crate::terrain) of: Vec<u32>,
}

impl Parts {
    /// Of a mesh as it is now: triangles that are left out or split later change them.
    pub(super) fn of(welded: &Welded) -> Self {
        let mut groups = groups(welded);
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

/// Triangles that share edges.
fn groups(welded: &Welded) -> Groups {
    let edges = &welded.edges;
    let beside = |t: u32| {
        let later =
            move |side: u32| edges.sides_on(side).skip(1).take_while(move |&other| other > side);
        (3 * t..3 * t + 3).flat_map(later).map(|side| side / 3)
    };
    Groups::joined(welded.triangles.len(), beside)
}
