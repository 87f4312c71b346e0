//! STL files as other programs write them, and ours as other programs read them (files made by `meshes/make.py`).

use rockfall::rock::Vec3;
use rockfall::terrain::health::Health;
use rockfall::terrain::make;
use rockfall::terrain::stl::{self, Facet, Format};
use rockfall::terrain::weld::{Piece, Up, weld};
use std::path::{Path, PathBuf};
use std::process::Command;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(name)
}

/// The roof of `make.py`: four triangles with a common top.
fn roof(shift: Vec3) -> Vec<Facet> {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z) + shift;
    let feet = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(4.0, 4.0, 0.0), at(0.0, 4.0, 0.0)];
    (0..4).map(|k| [feet[k], feet[(k + 1) % 4], at(2.0, 2.0, 1.5)]).collect()
}

/// All coordinates are binary fractions: equality is exact, in text and in 32 bits.
#[test]
fn files_of_other_programs_hold_the_same_roof() {
    for (name, format) in [
        ("meshio_ascii.stl", Format::Ascii),
        ("meshio_binary.stl", Format::Binary),
        ("trimesh_ascii.stl", Format::Ascii),
        ("trimesh_binary.stl", Format::Binary),
        ("numpy_stl_ascii.stl", Format::Ascii),
        ("numpy_stl_binary.stl", Format::Binary),
        ("cad_upper_crlf_latin1.stl", Format::Ascii),
        ("cr_only.stl", Format::Ascii),
        ("bom.stl", Format::Ascii),
        ("binary_solid_header.stl", Format::Binary),
    ] {
        let soup = stl::read(&file(name)).unwrap();
        assert_eq!((soup.format, soup.solids.len()), (format, 1), "{name}");
        assert_eq!(soup.facets, roof(Vec3::zeros()), "{name}");
        assert!(soup.normals_off.is_empty(), "{name}");
    }
    assert_eq!(stl::read(&file("cad_upper_crlf_latin1.stl")).unwrap().solids, ["BÖSCHUNG NORD 2"]);
}

#[test]
fn several_solids_are_one_soup() {
    let soup = stl::read(&file("two_solids.stl")).unwrap();
    let twice = [roof(Vec3::zeros()), roof(Vec3::zeros())].concat();
    assert_eq!((soup.solids.len(), soup.facets), (2, twice.into()));
}

/// Text keeps map coordinates to the last bit; 32-bit numbers are 0.25 m apart there and are refused.
#[test]
fn map_coordinates_pass_as_text_and_are_refused_in_binary() {
    let shift = Vec3::new(2_600_000.123, 1_200_000.456, 1523.789);
    let text = stl::read(&file("meshio_ascii_lv95.stl")).unwrap();
    assert_eq!(text.facets, roof(shift));

    let path = file("meshio_binary_lv95.stl");
    let soup = stl::read(&path).unwrap();
    let pieces = [Piece { file: &path, soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 }];
    let health = Health::of(&weld(&pieces, Vec3::zeros(), None).unwrap(), &pieces);
    let refused = health.check().unwrap_err().to_string();
    assert!(refused.contains("meshio_binary_lv95.stl") && refused.contains("2.50e-1"), "{refused}");
}

/// meshio stores `nan` as the normal of a facet without area; the weld leaves the facet out and counts it.
#[test]
fn a_facet_without_area_is_left_out_by_the_weld() {
    let path = file("meshio_ascii_flat_facet.stl");
    let soup = stl::read(&path).unwrap();
    let pieces = [Piece { file: &path, soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 }];
    let welded = weld(&pieces, Vec3::zeros(), None).unwrap();
    assert_eq!((soup.facets.len(), welded.triangles.len(), welded.zero_area.count), (5, 4, 1));
    assert_eq!((welded.vertices_m.len(), welded.edges.len()), (5, 8));
}

#[test]
fn cut_off_files_are_refused_with_place_and_cure() {
    for (name, place) in
        [("bad_binary_cut_off.stl", "284 bytes, but has 277"), ("bad_ascii_cut_off.stl", "line 16")]
    {
        let message = stl::read(&file(name)).unwrap_err().to_string();
        assert!(
            message.contains(name) && message.contains(place) && message.contains("cut off"),
            "{message}"
        );
    }
}

/// What the Tyrolean file is, as its README says.
#[test]
fn the_tyrolean_slope_is_one_sheet_without_faults() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("terrain/tyrol.stl");
    let soup = stl::read(&path).unwrap();
    let pieces = [Piece { file: &path, soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 }];
    let health = Health::of(&weld(&pieces, Vec3::zeros(), None).unwrap(), &pieces);
    assert_eq!((health.triangles, health.vertices, health.parts.len()), (23_542, 12_000, 1));
    assert_eq!(
        (health.border_loops, health.t_junctions.count, health.flipped_edges.count),
        (1, 0, 0)
    );
    assert!(health.check().is_ok());
}

/// The terrains of the examples are sound: no gap and no overlap is named in any of them, with their trees and without.
#[test]
fn the_terrains_of_the_examples_have_no_gaps_and_no_overlaps() {
    let at = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("terrain").join(name);
    for names in [
        &["quick_slope.stl", "quick_trees.stl"][..],
        &["valley_slope.stl", "valley_trees.stl"],
        &["paper_slope.stl", "paper_trees.stl"],
        &["paper_containers.stl"],
        &["tschamut/terrain.stl"],
        &["tyrol.stl"],
    ] {
        let paths: Vec<PathBuf> = names.iter().map(|name| at(name)).collect();
        let soups: Vec<_> = paths.iter().map(|path| stl::read(path).unwrap()).collect();
        let piece = |(path, soup)| Piece { file: path, soup, up: Up::Z, scale: 1.0, sheet: 0 };
        let files = paths.iter().map(PathBuf::as_path);
        let pieces: Vec<Piece> = files.zip(&soups).map(piece).collect();
        let health = Health::of(&weld(&pieces, Vec3::zeros(), None).unwrap(), &pieces);
        assert_eq!((health.gaps.len(), health.overlaps.len()), (0, 0), "{health}");
    }
}

/// meshio, trimesh and numpy-stl read our text and binary files. Without Python and these programs nothing is checked.
#[test]
fn other_programs_read_our_files() {
    let has_readers =
        Command::new("python3").args(["-c", "import meshio, trimesh, stl.mesh"]).output();
    if !has_readers.is_ok_and(|answer| answer.status.success()) {
        println!("not checked: python3 with meshio, trimesh and numpy-stl is not installed");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let (text, binary) = (dir.path().join("text.stl"), dir.path().join("binary.stl"));
    let facets = make::v_groove(5.0, 0.7);
    stl::write_ascii(&text, "groove 1 2 3", &facets).unwrap();
    stl::write_binary(&binary, &facets).unwrap();
    let script = file("read.py");
    let answer = Command::new("python3").arg(script).args([&text, &binary]).output().unwrap();
    let rise_m = (5.0 * 0.7_f64.tan()) as f32;
    let expected = format!("4 0.0 {rise_m}\n").repeat(6);
    assert_eq!(
        String::from_utf8_lossy(&answer.stdout),
        expected,
        "{}",
        String::from_utf8_lossy(&answer.stderr)
    );
}
