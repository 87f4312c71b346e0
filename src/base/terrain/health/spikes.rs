//! Spikes: single corners far above or below all that they are joined to.

use super::Found;
use crate::rock::Vec3;
use crate::terrain::weld::Welded;

/// A corner that stands out from all around it by more than this (m), and by more than so many of its longest edge in plan view (–),
/// is no ground.
const FAR_OUT: (f64, f64) = (5.0, 5.0);
/// Fewest edges that it takes to tell.
const FEWEST_EDGES: u32 = 3;

/// A corner that stands out. Places are map coordinates (m).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Spike {
    /// Height above the highest, or less than 0: below the lowest corner around it (m).
    pub height_m: f64,
    /// The place (m).
    pub at_m: [f64; 3],
}

/// What is known of a corner.
#[derive(Debug, Clone, Copy)]
struct AroundCorner {
    low_m: f64,
    high_m: f64,
    /// Longest edge in plan view (m), squared.
    far_m2: f64,
    edges: u32,
}

/// The spikes of triangles for which `is_looked_at` holds, the largest first.
pub(super) fn spikes(welded: &Welded, is_looked_at: &dyn Fn(u32) -> bool) -> Found<Spike> {
    let none =
        AroundCorner { low_m: f64::INFINITY, high_m: f64::NEG_INFINITY, far_m2: 0.0, edges: 0 };
    let mut around = vec![none; welded.vertices_m.len()];
    for (_, corners) in (0u32..).zip(&welded.triangles).filter(|&(t, _)| is_looked_at(t)) {
        for k in 0..3 {
            let (own, next, last) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
            for other in [next, last] {
                look(&mut around[own as usize], welded, [own, other]);
            }
        }
    }
    let spike = |(at, around): (&Vec3, &AroundCorner)| {
        let [above, below] = [at.z - around.high_m, around.low_m - at.z];
        let limit_m = FAR_OUT.0.max(FAR_OUT.1 * around.far_m2.sqrt());
        let is_out = around.edges >= 2 * FEWEST_EDGES && above.max(below) > limit_m;
        let height_m = if above > below { above } else { -below };
        is_out.then(|| Spike { height_m, at_m: welded.on_map(*at).into() })
    };
    let found = welded.vertices_m.iter().zip(&around).filter_map(spike).collect();
    Found::largest(found, |spike: &Spike| spike.height_m.abs())
}

fn look(around: &mut AroundCorner, welded: &Welded, [own, other]: [u32; 2]) {
    let [own, other] = [own, other].map(|k| welded.vertices_m[k as usize]);
    around.low_m = around.low_m.min(other.z);
    around.high_m = around.high_m.max(other.z);
    around.far_m2 = around.far_m2.max((other - own).xy().norm_squared());
    around.edges += 1;
}
