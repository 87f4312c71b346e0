//! Flat blocks on cells far smaller than they are: more of the mesh is near them than can act on them at a time.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::{falls, plan_in};
use rockfall::rock::Vec3;
use rockfall::terrain::stl::{Facet, write_binary};

/// Cells of 0.02 m, uneven by 4 mm, around the origin.
fn uneven() -> Vec<Facet> {
    const CELLS: i32 = 80;
    let corner = |i: i32, j: i32| {
        let (x, y) = (f64::from(i), f64::from(j));
        let z = 0.004 * (0.7 * x * x + 1.3 * y * y + 0.9 * x * y).sin();
        Vec3::new(0.02 * (x - 40.0), 0.02 * (y - 40.0), z)
    };
    let cell = |k: i32| {
        let (i, j) = (k / CELLS, k % CELLS);
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        [[a, b, c], [a, c, d]]
    };
    (0..CELLS * CELLS).flat_map(cell).collect()
}

/// An elastic box without friction that falls flat keeps its energy: of hundreds of peaks below its face 32 were kept that span most, so that the
/// next one came into it unseen and was stopped dead as a contact pressed in before; half of such boxes lost up to nine tenths of their energy.
#[test]
fn elastic_boxes_that_fall_flat_on_fine_cells_keep_their_energy() {
    let dir = tempfile::tempdir().unwrap();
    write_binary(&dir.path().join("uneven.stl"), &uneven()).unwrap();
    let text = "title = \"t\"\nseed = 1\n[[terrain]]\nmesh = \"uneven.stl\"\nground = \"g\"\n[grounds.g]\n\
         normal_stiffness_n_m = 1e9\ntangential_ratio = 0.4\nfriction_angle_deg = 0.0\nrestitution = 1.0\n\
         rolling_friction = 0.0\n[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.4\n[[rocks.shapes]]\nkind = \"box\"\n\
         corner_radius = 0.15\naxes = [1.5, 1.0, 0.7]\n[release]\ncount = 16\nheight_m = { uniform = [0.5, 1.0] }\n\
         velocity_m_s = [0.0, 0.0, { uniform = [-6.0, 0.0] }]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         orientation = [1.0, 0.0, 0.0, 0.0]\npoints_m = [[-0.1, -0.1], [0.1, 0.1]]\n[solver]\nscheme = \"rigid\"\n\
         longest_s = 1.2\n";
    let falls = falls(&plan_in(dir.path(), text));
    assert!(falls.iter().all(|fall| fall.impact_count > 0));
    for fall in falls {
        let lost = fall.ledger.damping_j / fall.released_j;
        // blows slower than the capture speed, a thousandth of the fall's, give nothing back
        assert!(lost.abs() < 1e-4, "release {}: {lost:e} of its energy", fall.index);
    }
}
