//! Elevation models as GeoTIFF: read bit for bit in every type, packing and layout; placed where they lie; refused with the
//! command to type where they cannot be used.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    clippy::print_stderr,
    reason = "tests of exact reading; one says what it leaves out"
)]

use crate::tiff;

use rockfall::error::Result;
use rockfall::rock::Vec3;
use rockfall::terrain::features::Features;
use rockfall::terrain::geotiff::{self, Raster};
use rockfall::terrain::stl::Soup;
use rockfall::terrain::weld::{Piece, Up, weld};
use std::io::Cursor;
use std::path::Path;
use std::process::Command;
use tiff::{DEFLATE, Kind, LZW, PACK_BITS, PLAIN, Spec, write};

const SIZE: [usize; 2] = [37, 29];

/// z = a + b x + c y + d x y, with digits behind the point where the type has them.
fn height(column: usize, row: usize) -> f64 {
    let (x, y) = (column as f64, row as f64);
    100.1 + 1.3 * x + 0.7 * y + 0.05 * x * y
}

fn read(bytes: Vec<u8>) -> Result<Raster> {
    let length = bytes.len() as u64;
    let file = Path::new("dem.tif");
    geotiff::parse(Cursor::new(bytes), length, file, (None, None))?.of_heights(file)
}

fn refusal(spec: &Spec) -> String {
    read(write(&[(spec, &height)])).expect_err("must be refused").to_string()
}

/// Every combination that the formats allow.
fn combinations() -> Vec<Spec> {
    let mut all = Vec::new();
    for kind in Kind::ALL {
        for packing in [PLAIN, LZW, DEFLATE, PACK_BITS] {
            for predictor in [1, 2, 3] {
                // differences are of whole numbers, planes of bytes are of floating point
                let fits = predictor == 1
                    || (packing != PACK_BITS
                        && packing != PLAIN
                        && (predictor == 3) == kind.is_float());
                for (tile, rows_per_strip) in [(None, SIZE[1]), (None, 8), (Some([16, 16]), 0)] {
                    for (big_endian, big_tiff) in
                        [(false, false), (true, false), (false, true), (true, true)]
                    {
                        let spec = Spec {
                            big_endian,
                            big_tiff,
                            tile,
                            rows_per_strip,
                            packing,
                            predictor,
                            ..Spec::new(kind, SIZE)
                        };
                        all.extend(fits.then_some(spec));
                    }
                }
            }
        }
    }
    all
}

#[test]
fn every_type_packing_and_layout_is_read_bit_for_bit() {
    let all = combinations();
    assert!(all.len() > 400, "{}", all.len());
    for spec in all {
        let Raster { grid, epsg, .. } =
            read(write(&[(&spec, &height)])).unwrap_or_else(|e| panic!("{spec:?}: {e}"));
        assert_eq!((grid.columns, grid.rows, epsg), (SIZE[0], SIZE[1], Some(2056)), "{spec:?}");
        assert_eq!(grid.corner_m, [2_600_000.5, 1_200_100.25 - 2.0 * SIZE[1] as f64]);
        for row in 0..SIZE[1] {
            for column in 0..SIZE[0] {
                let kept = spec.kind.kept(height(column, row));
                assert_eq!(grid.value(column, row), Some(kept), "{column} {row} of {spec:?}");
            }
        }
    }
}

/// Directories in front, overviews behind, tiles: the same grid as the plain file of one strip.
#[test]
fn a_cloud_optimised_file_equals_its_plain_twin() {
    let plain = read(write(&[(&Spec::new(Kind::F32, SIZE), &height)])).unwrap();
    let full = Spec {
        tile: Some([16, 16]),
        packing: DEFLATE,
        predictor: 3,
        ahead: true,
        ..Spec::new(Kind::F32, SIZE)
    };
    let (half, quarter) =
        (Spec { size: [19, 15], ..full.clone() }, Spec { size: [10, 8], ..full.clone() });
    let wrong = |_: usize, _: usize| -55.5;
    assert_eq!(
        read(write(&[(&full, &height), (&half, &wrong), (&quarter, &wrong)])).unwrap(),
        plain
    );
}

/// A value at a point stands where the file says; one over an area half a cell further, in both directions.
#[test]
fn point_and_area_differ_by_half_a_cell() {
    let area = Spec::new(Kind::F32, SIZE);
    let mut point = area.clone();
    point.keys[11] = 2;
    let [area, point] = [area, point].map(|spec| read(write(&[(&spec, &height)])).unwrap().grid);
    assert_eq!(point.values, area.values);
    assert_eq!([0, 1].map(|k| area.centre_m(3, 4)[k] - point.centre_m(3, 4)[k]), [1.0, -1.0]);
    assert_eq!(point.centre_m(0, 0), [2_600_000.5, 1_200_100.25]);
}

/// Tie point in the middle of the image, and the same by a transformation, also with rows that run north.
#[test]
fn every_way_to_place_a_grid_gives_the_same_place() {
    let plain = read(write(&[(&Spec::new(Kind::F32, SIZE), &height)])).unwrap();
    let tie = vec![10.0, 4.0, 0.0, 2_600_020.5, 1_200_092.25, 0.0];
    let tied = Spec { tie, ..Spec::new(Kind::F32, SIZE) };
    let mut matrix = vec![0.0; 16];
    (matrix[0], matrix[3], matrix[5], matrix[7], matrix[15]) =
        (2.0, 2_600_000.5, -2.0, 1_200_100.25, 1.0);
    let none = Spec { scale: Vec::new(), tie: Vec::new(), ..Spec::new(Kind::F32, SIZE) };
    let by_matrix = Spec { matrix: matrix.clone(), ..none.clone() };
    (matrix[5], matrix[7]) = (2.0, 1_200_100.25 - 2.0 * SIZE[1] as f64);
    let northward = Spec { matrix, ..none };
    assert_eq!(read(write(&[(&tied, &height)])).unwrap(), plain);
    assert_eq!(read(write(&[(&by_matrix, &height)])).unwrap(), plain);
    let turned = |column: usize, row: usize| height(column, SIZE[1] - 1 - row);
    assert_eq!(read(write(&[(&northward, &turned)])).unwrap(), plain);
}

#[test]
fn cells_without_data_are_holes() {
    let nan =
        |column: usize, row: usize| if column == row { f64::NAN } else { height(column, row) };
    let spec = Spec::new(Kind::F32, SIZE);
    assert_eq!(read(write(&[(&spec, &nan)])).unwrap().grid.holes(), SIZE[1]);
    let lowest = |column: usize, row: usize| {
        if column == row { f64::from(f32::MIN) } else { height(column, row) }
    };
    // as GDAL writes it, and cut short as others do
    for nodata in ["-3.4028234663852886e+38", "-3.40282347e+38"] {
        let spec = Spec { nodata: Some(nodata.to_owned()), ..spec.clone() };
        assert_eq!(read(write(&[(&spec, &lowest)])).unwrap().grid.holes(), SIZE[1], "{nodata}");
    }
    let whole =
        |column: usize, row: usize| if column < 2 { -32_768.0 } else { height(column, row) };
    let spec = Spec { nodata: Some("-32768".to_owned()), ..Spec::new(Kind::I16, SIZE) };
    assert_eq!(read(write(&[(&spec, &whole)])).unwrap().grid.holes(), 2 * SIZE[1]);
    let undeclared = Spec { nodata: None, ..spec };
    let said = read(write(&[(&undeclared, &whole)])).unwrap_err().to_string();
    assert!(
        said.contains("column 1, row 1") && said.contains("gdal_edit.py -a_nodata -32768 dem.tif"),
        "{said}"
    );
}

/// The part of a file that is read equals the same part of the whole.
#[test]
fn a_window_is_the_crop_of_the_whole() {
    let box_m = [2_600_020.0, 1_200_060.0, 2_600_041.0, 1_200_081.0];
    for tile in [None, Some([16, 16])] {
        let bytes =
            write(&[(&Spec { tile, rows_per_strip: 5, ..Spec::new(Kind::F64, SIZE) }, &height)]);
        let length = bytes.len() as u64;
        let whole = read(bytes.clone()).unwrap().grid;
        let part =
            geotiff::parse(Cursor::new(bytes), length, Path::new("dem.tif"), (Some(box_m), None))
                .unwrap()
                .grid;
        assert!(part.columns < 16 && part.rows < 16 && part.columns > 10);
        assert_eq!(part.cropped(box_m), whole.cropped(box_m));
    }
}

#[test]
fn what_cannot_be_used_is_refused_with_the_command_to_type() {
    let spec = || Spec::new(Kind::F32, SIZE);
    let with_key = |key: usize, value: u16| {
        let mut keys = spec().keys;
        keys[key] = value;
        Spec { keys, ..spec() }
    };
    let mut rotated = vec![0.0; 16];
    (rotated[0], rotated[1], rotated[4], rotated[5]) = (1.7, 1.0, 1.0, -1.7);
    let none = || Spec { scale: Vec::new(), tie: Vec::new(), ..spec() };
    let feet = [spec().keys, vec![3076, 0, 1, 9002]].concat();
    for (spec, parts) in [
        (Spec { matrix: rotated, ..none() }, ["rotated", "gdalwarp -t_srs EPSG:2056 -tr 1 1 -r bilinear dem.tif out.tif"]),
        (with_key(7, 2), ["longitude and latitude", "gdalwarp"]),
        (with_key(7, 3), ["geocentric", "gdalwarp"]),
        (Spec { keys: feet, ..spec() }, ["the unit EPSG:9002 (foot)", "gdalwarp -t_srs EPSG:CODE"]),
        (Spec { keys: [spec().keys, vec![4099, 0, 1, 9003]].concat(), ..spec() }, ["EPSG:9003 (US survey foot)", "gdal_calc.py -A dem.tif"]),
        // GDAL writes the code of the heights' system and no unit
        (Spec { keys: [spec().keys, vec![4096, 0, 1, 6360]].concat(), ..spec() }, ["found heights in feet (EPSG:6360)", "--calc A*0.3048"]),
        (Spec { metadata: Some("<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item></GDALMetadata>".into()), ..spec() }, ["found heights in ft", "gdal_edit.py -a_srs EPSG:CODE -units m out.tif"]),
        (Spec { scale: vec![2.0, 3.0, 0.0], ..spec() }, ["2 x 3 m, not square", "gdalwarp"]),
        (Spec { tie: [spec().tie, spec().tie].concat(), ..spec() }, ["control points", "gdalwarp"]),
        (none(), ["found none", "-a_srs EPSG:CODE -a_ullr"]),
        (Spec { metadata: Some("<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>".into()), ..spec() }, ["a scale or an offset", "-unscale"]),
        (Spec { nodata: Some("none".into()), ..spec() }, ["`none`", "gdal_edit.py"]),
    ] {
        let said = refusal(&spec);
        assert!(said.starts_with("dem.tif: ") && parts.iter().all(|part| said.contains(part)), "{said}");
    }
    for metres in ["m", "metre", ""] {
        let item =
            format!("<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{metres}</Item>");
        let keys = [spec().keys, vec![4096, 0, 1, 5703]].concat();
        let in_metres = Spec { metadata: Some(item), keys, ..spec() };
        assert!(read(write(&[(&in_metres, &height)])).is_ok(), "{metres}");
    }
    let infinite = |column: usize, _: usize| if column == 3 { f64::INFINITY } else { 1.0 };
    let said = read(write(&[(&spec(), &infinite)])).unwrap_err().to_string();
    assert!(said.contains("column 4, row 1: found a height of inf m"), "{said}");
}

/// Cut off anywhere, a file is refused or, where only its overviews are lost, read; it never takes the program down.
#[test]
fn a_file_cut_off_anywhere_is_survived() {
    let bytes = write(&[(
        &Spec { packing: DEFLATE, rows_per_strip: 4, ..Spec::new(Kind::F32, SIZE) },
        &height,
    )]);
    for length in 0..bytes.len() {
        let said = read(bytes[..length].to_vec()).unwrap_err().to_string();
        // a file of some length is not to be converted: its heights are lost
        assert!(
            length < 16 || said.contains("cut off: copy or download it again"),
            "{length}: {said}"
        );
    }
    for at in 0..bytes.len() {
        let mut wrong = bytes.clone();
        wrong[at] ^= 0xff;
        let _ = read(wrong);
    }
}

/// An inclined plane has no edge that a rock could feel, however large the map's coordinates.
#[test]
fn a_plane_has_flat_edges_only() {
    let plane = |column: usize, row: usize| 1000.0 + 0.5 * column as f64 - 0.25 * row as f64;
    let grid = read(write(&[(&Spec::new(Kind::F64, SIZE), &plane)])).unwrap().grid;
    let origin_m = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let soup = Soup::from(grid.facets(origin_m));
    assert_eq!(soup.facets.len(), 2 * (SIZE[0] - 1) * (SIZE[1] - 1));
    let piece = Piece { file: Path::new("dem.tif"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], origin_m, None).unwrap();
    let count = Features::of(&welded.vertices_m, &welded.triangles).count;
    // all that is left is the outline
    assert_eq!(count.edges, 2 * (SIZE[0] - 1 + SIZE[1] - 1));
}

/// Coarser cells hold the mean of what they cover, also where borders do not fall together.
#[test]
fn coarser_cells_hold_means() {
    let grid = read(write(&[(&Spec::new(Kind::F64, [6, 4]), &|column: usize, row: usize| {
        (column + 10 * row) as f64
    })]))
    .unwrap()
    .grid;
    let coarse = grid.resampled(4.0);
    assert_eq!(
        (coarse.columns, coarse.rows, coarse.cell_m, coarse.corner_m),
        (3, 2, 4.0, grid.corner_m)
    );
    assert_eq!(coarse.values, [5.5, 7.5, 9.5, 25.5, 27.5, 29.5].map(Some));
    // 1.5 cells: the first is (2·0 + 1·1) / 3 along columns and (2·30 + 1·20) / 3 along rows from the south
    let odd = grid.resampled(3.0);
    assert_eq!((odd.columns, odd.rows), (4, 2));
    let found = odd.value(0, 1).unwrap();
    assert!((found - (1.0 / 3.0 + 80.0 / 3.0)).abs() < 1e-12, "{found}");
}

/// How `gdal_translate` is asked for a type, packing, predictor and layout.
fn asked_of_gdal(packing: &str, predictor: u16, layout: &str) -> Vec<String> {
    let option = |text: String| ["-co".to_owned(), text];
    let mut words = vec![option(format!("COMPRESS={packing}"))];
    let (driver, more): (&str, &[&str]) = match layout {
        "strips" => ("GTiff", &["BLOCKYSIZE=8"]),
        "tiles" => ("GTiff", &["TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"]),
        "big" => ("GTiff", &["BIGTIFF=YES", "ENDIANNESS=BIG"]),
        _ => ("COG", &["BLOCKSIZE=128"]),
    };
    // libtiff sorts the bytes of floating-point differences by the machine's order, not by the file's: no other reader
    // can tell which that was
    let more = if predictor == 3 && layout == "big" { &more[..1] } else { more };
    words.extend(more.iter().map(|text| option((*text).to_owned())));
    if predictor > 1 {
        let named = ["STANDARD", "FLOATING_POINT"][usize::from(predictor) - 2];
        let of_cog = (driver == "COG").then(|| named.to_owned());
        let value = of_cog.unwrap_or_else(|| predictor.to_string());
        words.push(option(format!("PREDICTOR={value}")));
    }
    [vec!["-q".to_owned(), "-of".to_owned(), driver.to_owned()], words.concat()].concat()
}

/// Written by GDAL (`gdal_translate`, where it is installed) with its own options for every type, packing and layout.
#[test]
fn what_gdal_writes_is_read_bit_for_bit() {
    if !Command::new("gdal_translate").arg("--version").output().is_ok_and(|o| o.status.success()) {
        eprintln!("skipped: gdal_translate is not there, GDAL writes nothing");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let all = Kind::ALL.into_iter().flat_map(|kind| {
        let plain = dir.path().join(format!("{kind:?}.tif"));
        std::fs::write(&plain, write(&[(&Spec::new(kind, SIZE), &height)])).unwrap();
        let differences = if kind.is_float() { 3 } else { 2 };
        let packings = [("NONE", 1), ("PACKBITS", 1), ("LZW", 1), ("LZW", differences)];
        let packings = packings.into_iter().chain([("DEFLATE", 1), ("DEFLATE", differences)]);
        packings.flat_map(move |(packing, predictor)| {
            let layouts = ["strips", "tiles", "big", "cog"].into_iter();
            // the driver of cloud-optimised files does not know PackBits
            let known = layouts.filter(move |layout| *layout != "cog" || packing != "PACKBITS");
            let plain = plain.clone();
            known.map(move |layout| (kind, plain.clone(), packing, predictor, layout))
        })
    });
    let all: Vec<_> = all.collect();
    assert_eq!(all.len(), 7 * (6 * 4 - 1));
    for (number, (kind, plain, packing, predictor, layout)) in all.into_iter().enumerate() {
        let path = dir.path().join(format!("{number}.tif"));
        let words = asked_of_gdal(packing, predictor, layout);
        let name = format!("{kind:?} {words:?}");
        let said = Command::new("gdal_translate").args(&words).arg(&plain).arg(&path).output();
        let said = said.unwrap();
        assert!(said.status.success(), "{name}: {}", String::from_utf8_lossy(&said.stderr));
        let raster = geotiff::read(&path, None, None).unwrap_or_else(|e| panic!("{name}: {e}"));
        let corner_m = [2_600_000.5, 1_200_042.25];
        assert_eq!((raster.epsg, raster.grid.corner_m), (Some(2056), corner_m), "{name}");
        for (at, value) in raster.grid.values.iter().enumerate() {
            let kept = kind.kept(height(at % SIZE[0], at / SIZE[0]));
            assert_eq!(*value, Some(kept), "{name} at {at}");
        }
    }
}
