// Numbers are written and read back: equality is meant.
#![allow(clippy::float_cmp)]

use super::*;
use crate::terrain::stl::{CoarseText, LastDigits};
use proptest::prelude::*;
use std::fmt::Write as _;

const CORNERS: [[f64; 3]; 4] =
    [[2_600_000.123_456_789, 0.0, 1.0], [1.0, 0.0, 0.1], [1.0, 1.0, 0.0], [0.0, 1.0, -2.5]];

/// The quad of [`CORNERS`] as a fan.
fn quad() -> Vec<Facet> {
    let [a, b, c, d] = CORNERS.map(Vec3::from);
    vec![[a, b, c], [a, c, d]]
}

fn ply(text: &[u8]) -> Result<Soup> {
    parse_ply(text, Path::new("m.ply"))
}

fn ply_text() -> String {
    let mut text = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty double x\nproperty double y\n\
                    property double z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\n\
                    element extra 0\nend_header\n"
        .to_owned();
    for [x, y, z] in CORNERS {
        let _ = writeln!(text, "{x} {y} {z} 255");
    }
    text + "4 0 1 2 3\n"
}

/// The same mesh in bytes.
fn ply_binary(big: bool, single: bool) -> Vec<u8> {
    let (order, kind) =
        (if big { "big" } else { "little" }, if single { "float" } else { "double" });
    let mut bytes = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement vertex 4\r\nproperty {kind} x\nproperty {kind} y\nproperty {kind} z\n\
         property list uchar short normals\nelement face 1\nproperty list int uint vertex_index\nend_header\n"
    )
    .into_bytes();
    let mut put = |little: &[u8]| {
        let mut all = little.to_vec();
        if big {
            all.reverse();
        }
        bytes.extend(all);
    };
    for corner in CORNERS {
        for x in corner {
            if single { put(&(x as f32).to_le_bytes()) } else { put(&x.to_le_bytes()) }
        }
        put(&[2]);
        put(&1i16.to_le_bytes());
        put(&(-1i16).to_le_bytes());
    }
    put(&4i32.to_le_bytes());
    for index in 0..4u32 {
        put(&index.to_le_bytes());
    }
    bytes
}

#[test]
fn every_coding_of_ply_gives_the_same_mesh() {
    assert_eq!(ply(ply_text().as_bytes()).unwrap().facets, quad());
    assert_eq!(ply(ply_text().replace('\n', "\r\n").as_bytes()).unwrap().facets, quad());
    for big in [false, true] {
        let soup = ply(&ply_binary(big, false)).unwrap();
        assert_eq!((soup.facets, soup.is_single), (quad().into(), false));
        let soup = ply(&ply_binary(big, true)).unwrap();
        let narrow = |corner: Vec3| corner.map(|x| f64::from(x as f32));
        let rounded: Vec<Facet> = quad().iter().map(|facet| facet.map(narrow)).collect();
        // the health report measures what 32 bits do to such coordinates
        assert_eq!((soup.facets, soup.is_single), (rounded.into(), true));
    }
}

#[test]
fn a_refused_ply_says_where_and_what() {
    let with = |from: &str, to: &str| ply_text().replacen(from, to, 1);
    for (text, part) in [
        (with("4 0 1 2 3\n", "4 0 1 2 4\n"), "face 1: found a corner that is none of 4 vertices"),
        (with("4 0 1 2 3\n", "4 0 1 2 -1\n"), "face 1"),
        (with("4 0 1 2 3\n", "4 0 1 2\n"), "element face: found the end of the file"),
        (with(" 0.1 ", " 0,1 "), "`0,1` is no number"),
        (with("-2.5", "nan"), "vertex 4: (0, 1, NaN) is not finite"),
        (with("format ascii", "format utf8"), "line 2: found `format utf8 1.0`"),
        (with("property double y\n", ""), "found no x, y, z"),
        (with("vertex_indices", "tristrips"), "found no vertex_indices"),
        (with("element face 1", "element face 0"), "the file holds no face"),
        (with("end_header\n", ""), "line 12"),
        ("ply\nformat ascii 1.0\n".to_owned(), "found no `end_header`"),
        (with("element vertex 4", "element vertex 4000000000"), "element vertex"),
    ] {
        let said = ply(text.as_bytes()).expect_err(part).to_string();
        assert!(said.starts_with("m.ply: ") && said.contains(part), "{said}");
    }
}

/// Cells of half a metre at an easting of 2 725 300 as text: seven digits are steps of a metre, in which they fall together; millimetres keep them. So in
/// every text, and not in numbers of 64 bits.
#[test]
fn few_digits_of_a_text_are_told() {
    let side = 30;
    let corners = |digits: &dyn Fn(f64) -> String| -> Vec<String> {
        let all = (0..side * side).map(|at| [at % side, at / side].map(f64::from));
        let words = |[i, j]: [f64; 2]| {
            let place =
                [2_725_300.0 + 0.5 * i, 1_192_600.0 + 0.5 * j, 1300.0 + 0.3 * i + (i * j).sin()];
            place.map(digits).join(" ")
        };
        all.map(words).collect()
    };
    let cells: Vec<[i32; 4]> = (0..(side - 1) * side)
        .filter(|at| at % side < side - 1)
        .map(|at| [at, at + 1, at + side + 1, at + side])
        .collect();
    let of_ply = |digits: &dyn Fn(f64) -> String| {
        let faces: Vec<String> =
            cells.iter().map(|[a, b, c, d]| format!("4 {a} {b} {c} {d}")).collect();
        let (vertices, count) = (side * side, faces.len());
        let head = format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\nelement face {count}\nproperty list uchar int vertex_indices\nend_header\n"
        );
        ply((head + &corners(digits).join("\n") + "\n" + &faces.join("\n") + "\n").as_bytes())
            .unwrap()
    };
    let of_obj = |digits: &dyn Fn(f64) -> String| {
        let vertices: Vec<String> =
            corners(digits).iter().map(|place| format!("v {place}")).collect();
        let faces = cells.iter().map(|cell| {
            let [a, b, c, d] = cell.map(|at| at + 1);
            format!("f {a} {b} {c} {d}")
        });
        obj(&(vertices.join("\n") + "\n" + &faces.collect::<Vec<_>>().join("\n") + "\n")).unwrap()
    };
    let spoils = |soup: &Soup| CoarseText::of(soup, [0, 1]).map(|found| found.spoils());
    let (seven, fine) = (|x: f64| format!("{x:.6e}"), |x: f64| format!("{x:.3}"));
    assert_eq!([spoils(&of_ply(&seven)), spoils(&of_obj(&seven))], [Some(true); 2]);
    assert_eq!([spoils(&of_ply(&fine)), spoils(&of_obj(&fine))], [None; 2]);
    assert_eq!(ply(&ply_binary(false, false)).unwrap().last_digits, LastDigits::default());
}

fn obj(text: &str) -> Result<Soup> {
    parse_obj(text.as_bytes(), Path::new("m.obj"))
}

#[test]
fn an_obj_keeps_all_digits_and_takes_every_way_to_number() {
    let mut vertices = String::new();
    for [x, y, z] in CORNERS {
        let _ = writeln!(vertices, "v {x} {y} {z}");
    }
    for face in [
        "f 1 2 3 4",
        "f 1/5 2/6 3/7 4/8",
        "f 1//1 2//1 3//1 4//1",
        "f -4 -3 -2 -1",
        "f  1 2/1/1 -2\t4\r",
    ] {
        let text = format!("# by hand\nmtllib a.mtl\no slope\n{vertices}vn 0 0 1\ns off\n{face}\n");
        assert_eq!(obj(&text).unwrap().facets, quad(), "{face}");
        assert!(obj::begins_like_obj(text.as_bytes()));
    }
    for (line, part) in [
        ("f 1 2 5", "line 5: found `f 1 2 5`"),
        ("f 1 2", "three or more"),
        ("f 0 1 2", "line 5"),
        ("f 1 2 x", "line 5"),
        ("v 1 2", "write `v x y z`"),
        ("v 1 2 inf", "finite numbers"),
        ("", "the file holds no face"),
    ] {
        let said = obj(&format!("{vertices}{line}\n")).expect_err(part).to_string();
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn a_file_is_known_by_its_first_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let said = |name: &str, bytes: &[u8]| {
        let path = dir.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        read(&path, &Options::default()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(said("a.stl", ply_text().as_bytes()), Ok(()));
    assert_eq!(
        said("a.tif", b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n"),
        Ok(())
    );
    assert_eq!(said("a.txt", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), Ok(()));
    for (bytes, part) in [
        (
            &b"SQLite format 3\0 ..."[..],
            "found a GeoPackage; write it as GeoTIFF: gdal_translate -of GTiff",
        ),
        (b"\x89HDF\r\n", "HDF5"),
        (b"PK\x03\x04", "ZIP archive"),
        (b"", "the file is empty"),
    ] {
        let said = said("a.dem", bytes).unwrap_err();
        assert!(said.contains(part), "{said}");
    }
    #[cfg(not(feature = "cloud"))]
    assert!(said("a.las", b"LASF").unwrap_err().contains("--features cloud"));
}

/// Rocks of 100 m fall at 45° at the flattest: what is kept reaches as far as the ground lies deep enough.
#[test]
fn what_rocks_can_reach_is_kept() {
    // z falls by 1 m a metre to the north for 50 m, then the valley is flat
    let height = |row_from_south: usize| 100.0 - (row_from_south as f64).min(50.0);
    let rows = 200;
    let values = (0..rows).rev().flat_map(|row| [Some(height(row)); 3]).collect();
    let grid = Grid { columns: 3, rows, corner_m: [0.0, 0.0], cell_m: 1.0, values };
    let start = ([1.0, 0.0, 2.0, 1.0], 100.0);
    // under 45° all of the slope is reached, just; under 26.6° the valley up to 100 m from the start
    let [_, south, _, north] = grid.reached(&[start], 1.0).unwrap();
    assert_eq!((south, north), (0.5, 50.5));
    let [_, _, _, north] = grid.reached(&[start], 0.5).unwrap();
    assert_eq!(north, 100.5);
    assert_eq!(grid.highest_in(start.0), Some(100.0));
}

/// Near misses of the header, and then numbers.
fn nearly_ply() -> impl Strategy<Value = Vec<u8>> {
    let words = "ply,format,ascii,binary_little_endian,1.0,element,vertex,face,property,list,uchar,int,double,x,y,z,\
                 vertex_indices,end_header,0,1,2,3,-1,1e300,\n,\n,\n";
    let words: Vec<String> = words.split(',').map(str::to_owned).collect();
    prop::collection::vec(prop::sample::select(words), 0..80)
        .prop_map(|words| format!("ply\n{}", words.join(" ")).into_bytes())
}

/// A grid text of two by three cells.
fn grid(heights: [f64; 6]) -> Grid {
    let heights = heights.map(|height| height.to_string()).join(" ");
    let text = format!("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n{heights}\n");
    Grid::parse(&text, Path::new("m.asc")).unwrap()
}

/// Zeros among heights far above are said to be cells without data; a coast, a valley floor at 0 m and a grid of zeros are not.
#[test]
fn zeros_far_below_all_other_cells_are_said() {
    let said = |heights| {
        let loaded = ElevationModel::of(grid(heights), Format::AsciiGrid, None);
        let used = loaded.used(Path::new("m.asc"), &Options::default(), &Vec::new()).unwrap();
        let Loaded::Grid(model) = used else { unreachable!("a grid was given") };
        model.warnings
    };
    let warned = said([0.0, 500.0, 510.0, 0.0, 520.0, 530.0]);
    assert_eq!(warned.len(), 1);
    assert!(
        warned[0].starts_with("2 of 6 cells are exactly 0 m high and all others above 500.0 m")
    );
    for sound in [
        [0.0, 0.5, 510.0, 0.0, 520.0, 530.0],
        [0.0, -1.0, 510.0, 0.0, 520.0, 530.0],
        [0.0; 6],
        [500.0, 510.0, 520.0, 530.0, 540.0, 550.0],
    ] {
        assert!(said(sound).is_empty(), "{sound:?}");
    }
}

proptest! {
    #[test]
    fn no_bytes_make_the_readers_panic(bytes in prop_oneof![prop::collection::vec(any::<u8>(), 0..300), nearly_ply()]) {
        for soup in [parse_ply(&bytes, Path::new("m.ply")), parse_obj(&bytes, Path::new("m.obj"))].into_iter().flatten() {
            prop_assert!(soup.facets.iter().flatten().all(|p| p.iter().all(|x| x.is_finite())));
        }
    }

    #[test]
    fn one_wrong_byte_is_survived(at in 0usize..400, value: u8) {
        let mut bytes = ply_binary(false, false);
        let at = at % bytes.len();
        bytes[at] = value;
        let _ = ply(&bytes);
    }
}
