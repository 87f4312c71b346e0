//! Gaps and overlaps of made tiles, and that nothing else is taken for one.

use super::*;
use crate::rock::Vec3;
use crate::terrain::make::{Stem, jittered_plane, stem};
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Up, weld};
use std::path::Path;

fn health_of(tiles: &[Vec<Facet>]) -> Health {
    health_with(tiles, None)
}

fn health_with(tiles: &[Vec<Facet>], tolerance_m: Option<f64>) -> Health {
    let soups: Vec<Soup> = tiles.iter().map(|tile| Soup::from(tile.clone())).collect();
    let piece = |soup| Piece { file: Path::new("t.stl"), soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let pieces: Vec<Piece> = soups.iter().map(piece).collect();
    Health::of(&weld(&pieces, Vec3::new(1000.0, 0.0, 0.0), tolerance_m).unwrap(), &pieces)
}

/// A rough slope of cells, over columns and rows, with other corners than a tile of another `cell_m`.
fn tile(x: [f64; 2], y: [f64; 2], cell_m: f64, height: impl Fn(f64, f64) -> f64) -> Vec<Facet> {
    let count = |[low, high]: [f64; 2]| ((high - low) / cell_m).round() as usize;
    let at = |i: usize, k: usize| {
        let (x, y) = (x[0] + cell_m * i as f64, y[0] + cell_m * k as f64);
        Vec3::new(x, y, height(x, y))
    };
    let cell = |(i, k): (usize, usize)| {
        let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
        [[a, b, c], [a, c, d]]
    };
    let cells = (0..count(x)).flat_map(|i| (0..count(y)).map(move |k| (i, k)));
    cells.flat_map(cell).collect()
}

fn hill(x: f64, y: f64) -> f64 {
    0.6 * y + 2.0 * (0.07 * x).sin() + 0.3 * (0.9 * x + 0.5 * y).cos()
}

/// Two tiles 0.4 m apart along 30 m: length, width and place of the gap, whatever the cells of the other tile and its winding.
#[test]
fn a_gap_between_two_tiles_is_measured() {
    for cell_m in [1.0, 0.5] {
        let left = tile([0.0, 20.0], [0.0, 30.0], 1.0, hill);
        let mut right = tile([20.4, 30.4], [0.0, 30.0], cell_m, hill);
        for facet in &mut right {
            facet.swap(1, 2);
        }
        let found = health_of(&[left, right]);
        assert_eq!((found.gaps.len(), found.overlaps.len()), (1, 0), "{found}");
        let gap = &found.gaps[0];
        assert_eq!(gap.parts, [1, 2]);
        // along a border of slope 0.6 and its humps
        assert!((30.0..40.0).contains(&gap.length_m), "{gap}");
        // between corners the edges of one tile cut off the humps of the other
        assert!((0.35..0.5).contains(&gap.width_m) && gap.widest_m < 0.8, "{gap}");
        let [x, y, _] = gap.at_m;
        assert!((x - 1020.2).abs() < 0.2 && (y - 15.0).abs() < 2.0, "{gap}");
        assert!(found.to_string().contains("between part 1 and part 2, near (1020."), "{found}");
        let json = serde_json::to_value(&found).unwrap();
        assert_eq!(json["gaps"][0]["parts"], serde_json::json!([1, 2]));
    }
}

/// A slit within one part is one gap, as are borders that stand above each other; a hole of two cells is none.
#[test]
fn slits_and_cracks_are_gaps_and_holes_are_not() {
    let all = tile([0.0, 20.0], [0.0, 20.0], 1.0, hill);
    let without = |is_out: &dyn Fn(Vec3) -> bool| -> Vec<Facet> {
        let middle = |facet: &Facet| (facet[0] + facet[1] + facet[2]) / 3.0;
        all.iter().filter(|facet| !is_out(middle(facet))).copied().collect()
    };
    let slit = without(&|m| (10.0..11.0).contains(&m.x) && (4.0..16.0).contains(&m.y));
    let found = health_of(&[slit]);
    assert_eq!((found.gaps.len(), found.parts.len()), (1, 1), "{found}");
    let gap = &found.gaps[0];
    assert!(gap.parts == [1, 1] && (11.0..16.0).contains(&gap.length_m), "{gap}");
    assert!((0.9..1.4).contains(&gap.width_m), "{gap}");
    let hole = without(&|m| (10.0..11.0).contains(&m.x) && (4.0..6.0).contains(&m.y));
    assert_eq!(health_of(&[hole]).gaps, []);
    let step = tile([20.0, 30.0], [0.0, 20.0], 1.0, |x, y| hill(x, y) + 0.3);
    let found = health_of(&[all, step]);
    assert_eq!((found.gaps.len(), found.overlaps.len()), (1, 0), "{found}");
    assert!((0.2..0.31).contains(&found.gaps[0].width_m), "{found}");
}

/// Two tiles that overlap by 4 m over 30 m, 0.1 to 0.3 m apart: area, distance and place.
#[test]
fn an_overlap_of_two_tiles_is_measured() {
    let left = tile([0.0, 20.0], [0.0, 30.0], 1.0, hill);
    let right =
        tile([16.0, 40.0], [0.3, 30.3], 1.0, |x, y| hill(x, y) + 0.2 + 0.1 * (0.3 * y).sin());
    let found = health_of(&[left, right]);
    assert_eq!((found.overlaps.len(), found.gaps.len()), (1, 0), "{found}");
    let overlap = &found.overlaps[0];
    // 4 m by 29.7 m, by cells of 1 m²
    assert!((overlap.area_m2 - 118.8).abs() < 8.0 && overlap.parts == [1, 2], "{overlap}");
    // cells of the two cut off the humps by 0.06 m
    assert!((0.02..0.16).contains(&overlap.apart_low_m), "{overlap}");
    assert!((0.24..0.38).contains(&overlap.apart_high_m), "{overlap}");
    let [x, y, _] = overlap.at_m;
    assert!((x - 1018.0).abs() < 1.5 && (y - 15.0).abs() < 1.5, "{overlap}");
    let said = found.to_string();
    assert!(said.contains("part 1 and part 2 over each other on 1"), "{said}");
}

/// A survey that lies wholly on another one is an overlap too; one that is a metre and a half above it is not.
#[test]
fn a_sheet_wholly_on_another_is_an_overlap() {
    let ground = tile([0.0, 40.0], [0.0, 40.0], 1.0, hill);
    let patch = |up_m: f64| tile([10.2, 25.2], [10.3, 20.3], 0.5, move |x, y| hill(x, y) + up_m);
    let found = health_of(&[ground.clone(), patch(0.2)]);
    assert_eq!(found.overlaps.len(), 1, "{found}");
    assert!((found.overlaps[0].area_m2 - 150.0).abs() < 15.0, "{found}");
    assert_eq!(health_of(&[ground, patch(1.5)]).overlaps, []);
}

/// What stands on the slope and what hangs over it is neither a gap nor an overlap.
#[test]
fn objects_and_overhangs_are_no_faults() {
    let ground = tile([0.0, 40.0], [0.0, 40.0], 1.0, |x, y| 0.2 * x + 0.1 * y);
    let box_on = |low: [f64; 3], size: [f64; 3], is_closed: bool| -> Vec<Facet> {
        let at = |k: usize| {
            let of = |bit: usize| low[bit] + size[bit] * f64::from((k >> bit & 1) as u32);
            Vec3::new(of(0), of(1), of(2))
        };
        let sides =
            [[4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [0, 2, 3, 1]];
        let faces = sides.iter().take(if is_closed { 6 } else { 5 });
        faces.flat_map(|&[a, b, c, d]| [[at(a), at(b), at(c)], [at(a), at(c), at(d)]]).collect()
    };
    let house = box_on([8.0, 8.0, 1.5], [9.0, 7.0, 6.0], false);
    let slab = box_on([25.0, 8.0, 5.0], [10.0, 10.0, 3.0], true);
    let wall = box_on([5.0, 30.0, 3.0], [20.0, 0.4, 2.5], false);
    let dam = tile([28.0, 38.0], [22.0, 38.0], 0.5, |x, y| {
        0.2 * x + 0.1 * y + 3.0 - (x - 33.0).abs() / 1.5
    });
    let tree = stem(&Stem { x_m: 20.0, y_m: 20.0, dbh_m: 0.5, height_m: 10.0 }, 5.5);
    let found = health_of(&[ground, house, slab, wall, dam, tree]);
    assert!(found.parts.len() > 5);
    assert_eq!((&found.gaps[..], &found.overlaps[..]), (&[][..], &[][..]), "{found}");
    // a sheet that folds over itself, with a lip of 0.3 m
    let fold = |s: f64| match s {
        s if s < 10.0 => (s, 5.0),
        s if s < 11.0 => (10.0, 5.0 - 0.3 * (s - 10.0)),
        s if s < 17.0 => (21.0 - s, 4.7 - 0.5 * (s - 11.0)),
        s => (s - 13.0, 1.7),
    };
    let mut cave = tile([0.0, 30.0], [0.0, 20.0], 1.0, |_, _| 0.0);
    for corner in cave.iter_mut().flatten() {
        let (x, z) = fold(corner.x);
        *corner = Vec3::new(x, corner.y, z);
    }
    let found = health_of(&[cave]);
    assert_eq!((&found.gaps[..], &found.overlaps[..]), (&[][..], &[][..]), "{found}");
}

/// A sound plane says nothing, in the table nor in JSON.
#[test]
fn a_sound_mesh_has_neither() {
    let found = health_of(&[jittered_plane(50.0, 10, 0.5)]);
    let said = found.to_string() + &serde_json::to_string(&found).unwrap();
    assert!(!said.contains("gaps") && !said.contains("overlaps"), "{said}");
}

/// Tiles on slopes of 0 to 70° that overlap by 4 mm, or are 4 mm or 9 mm aside: the gap is as wide as that, not as the edges up and down the
/// border are apart, and the tolerance that is proposed closes it.
#[test]
fn a_seam_of_millimetres_is_as_wide_as_it_is() {
    for slope in [0.0, 0.7, 2.7] {
        for [east, north] in [[-4e-3, 0.0], [4e-3, 0.0], [-4e-3, 9e-3]] {
            let left = tile([0.0, 20.0], [0.0, 30.0], 1.0, |_, y| slope * y);
            let mut right = tile([20.0, 40.0], [0.0, 30.0], 1.0, |_, y| slope * y);
            for corner in right.iter_mut().flatten() {
                *corner += Vec3::new(east, north, 0.0);
            }
            let tiles = [left, right];
            let found = health_of(&tiles);
            assert_eq!(found.gaps.len(), 1, "{slope} {east} {north} {found}");
            let gap = &found.gaps[0];
            let most = east.hypot(north) + 1e-6;
            assert!(gap.width_m > 3e-3 && gap.widest_m < most * (1.0 + slope), "{slope} {gap}");
            let closing_m = found.closing_tolerance_m.unwrap();
            assert!(closing_m < 0.05, "{closing_m}");
            let closed = health_with(&tiles, Some(closing_m));
            assert!(closed.gaps.is_empty() && closed.parts.len() == 1, "{closed}");
        }
    }
    // a gap of 0.4 m beside edges of 1 m is closed by none
    let apart = [0.0, 20.4].map(|x| tile([x, x + 20.0], [0.0, 30.0], 1.0, |_, _| 0.0));
    assert_eq!(health_of(&apart).closing_tolerance_m, None);
}

/// A hole of 8 by 3 m across a slope: its area and place, whichever way triangles are wound; none where a patch of its own fills it.
#[test]
fn an_inner_hole_is_found_where_it_is() {
    let mut all = tile([0.0, 30.0], [0.0, 20.0], 1.0, hill);
    for facet in all.iter_mut().step_by(3) {
        facet.swap(1, 2);
    }
    let is_out = |facet: &Facet| {
        let middle = (facet[0] + facet[1] + facet[2]) / 3.0;
        (10.0..18.0).contains(&middle.x) && (7.0..10.0).contains(&middle.y)
    };
    let (patch, ground): (Vec<Facet>, Vec<Facet>) = all.iter().partition(|facet| is_out(facet));
    assert_eq!(health_of(&[all]).holes.count, 0);
    let found = health_of(std::slice::from_ref(&ground));
    assert_eq!(found.holes.count, 1, "{found}");
    let hole = &found.holes.largest[0];
    assert!((hole.area_m2 - 24.0).abs() < 1e-9, "{hole}");
    assert_eq!(format!("{:?}", hole.box_m), "[1010.0, 7.0, 1018.0, 10.0]");
    assert!((hole.at_m[0] - 1014.0).abs() < 0.3 && (hole.at_m[1] - 8.5).abs() < 0.3, "{hole}");
    assert!(found.to_string().contains("inner holes                      1"), "{found}");
    assert!(found.warnings().any(|said| said.starts_with("holes in the slope: 1")));
    let filled: Vec<Facet> =
        patch.iter().map(|facet| facet.map(|corner| corner + Vec3::new(4e-3, 0.0, 0.0))).collect();
    assert_eq!(health_of(&[ground, filled]).holes.count, 0);
}

/// Two corners 12 m above and 8 m below all around them, and a sheet of 5 by 6 m that hangs 3 m above the slope.
#[test]
fn spikes_and_hanging_sheets_are_found() {
    let mut ground = tile([0.0, 30.0], [0.0, 20.0], 1.0, |_, y| 2.0 * y);
    let sheet = tile([5.2, 10.2], [4.3, 10.3], 1.0, |_, y| 2.0 * y + 3.0);
    let sound = health_of(std::slice::from_ref(&ground));
    assert!(sound.spikes.is_empty() && sound.hanging.is_empty(), "{sound}");
    for corner in ground.iter_mut().flatten() {
        match (corner.x, corner.y) {
            (20.0, 5.0) => corner.z += 14.0,
            (25.0, 15.0) => corner.z -= 10.0,
            _ => {}
        }
    }
    let found = health_of(&[ground, sheet]);
    assert_eq!((found.spikes.count, found.hanging.count), (2, 1), "{found}");
    let heights: Vec<f64> = found.spikes.largest.iter().map(|spike| spike.height_m).collect();
    assert_eq!(heights, [12.0, -8.0]);
    assert_eq!(format!("{:?}", found.spikes.largest[0].at_m), "[1020.0, 5.0, 24.0]");
    let hanging = &found.hanging.largest[0];
    assert!((hanging.height_m - 3.0).abs() < 1e-9 && hanging.parts == [2, 1], "{hanging}");
    assert!((hanging.area_m2 - 30.0).abs() < 1e-9, "{hanging}");
    assert_eq!(found.warnings().count(), 2);
}
