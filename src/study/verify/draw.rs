//! The paper's figures drawn anew.

use crate::report::curves::Curves;
use crate::simulation::{PathPoint, Trajectory};
use crate::terrain::Terrain;

/// The paper's time step (s): steps are printed, not times.
pub(super) const STEP_S: f64 = 1e-5;

/// A line in a figure.
pub(super) type FigureLine = Vec<(f64, f64)>;

/// The mesh as seen along y, without the walls that face the viewer; nothing of a large one.
pub(super) fn outline(terrain: &Terrain) -> Vec<FigureLine> {
    const MOST_TRIANGLES: usize = 100;
    if terrain.triangles.len() > MOST_TRIANGLES {
        return Vec::new();
    }
    let mut lines = Vec::new();
    for t in 0..terrain.triangles.len() as u32 {
        let corners = terrain.corners_m(t).map(|p| p + terrain.origin_m);
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        if normal.y.abs() < 0.9 {
            let seen = |k: usize| (corners[k % 3].x, corners[k % 3].z);
            lines.extend((0..3).map(|k| vec![seen(k), seen(k + 1)]));
        }
    }
    lines
}

/// Name of an axis of the paper's steps.
const STEPS: &str = "Step of 10 µs";

/// Speed over steps.
pub(super) fn speeds(title: &str, path: &[PathPoint]) -> Curves {
    let mut curves = Curves::new(title, STEPS, "Speed (m/s)");
    let at = |point: &PathPoint| (point.motion.time_s / STEP_S, point.motion.velocity_m_s.norm());
    curves.lines.push(path.iter().map(at).collect());
    curves
}

/// Vertical displacement over steps.
pub(super) fn heights(title: &str, path: &[PathPoint]) -> Curves {
    let mut curves = Curves::new(title, STEPS, "Vertical displacement (m)");
    let start = path.first().map_or(0.0, |point| point.motion.position_m.z);
    let at = |point: &PathPoint| (point.motion.time_s / STEP_S, point.motion.position_m.z - start);
    curves.lines.push(path.iter().map(at).collect());
    curves
}

/// Spheres at a step as seen along the edge; at step 0 the whole way of the centres, and the spheres at its end.
pub(super) fn side(
    title: &str,
    (falls, ground): (&[Trajectory], &[FigureLine]),
    step: usize,
) -> Curves {
    let mut curves = Curves::new(title, "Across (m)", "Height (m)");
    curves.ground = ground.to_vec();
    for fall in falls {
        let places = fall.path.iter().map(|p| (p.motion.position_m.x, p.motion.position_m.z));
        if step == 0 {
            curves.lines.push(places.clone().collect());
            curves
                .discs
                .extend(places.clone().next_back().map(|(x, z)| (x, z, fall.rock.radius_m)));
            continue;
        }
        let before = |point: &&PathPoint| point.motion.time_s <= step as f64 * STEP_S;
        let k = fall.path.iter().filter(before).count().saturating_sub(1);
        if let Some((x, z)) = places.clone().nth(k) {
            curves.discs.push((x, z, fall.rock.radius_m));
        }
    }
    curves
}
