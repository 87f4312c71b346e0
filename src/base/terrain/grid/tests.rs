// Grids of round numbers: equality is meant.
#![allow(clippy::float_cmp)]

use super::*;
use crate::terrain::stl::area_vector;
use proptest::prelude::*;

const SMALL: &str = "ncols 3\nnrows 2\nxllcorner 2600000.25\nyllcorner 1200000\ncellsize 2\nNODATA_value -9999\n\
                     10 11 12\n20 -9999 22.5\n";

fn parse(text: &str) -> Result<Grid> {
    Grid::parse(text, Path::new("g.asc"))
}

#[test]
fn the_first_row_is_north_and_values_stand_at_cell_centres() {
    let grid = parse(SMALL).unwrap();
    assert_eq!(
        (grid.value(0, 0), grid.value(1, 1), grid.value(2, 1)),
        (Some(10.0), None, Some(22.5))
    );
    assert_eq!(grid.centre_m(0, 1), [2_600_001.25, 1_200_001.0]);
    assert_eq!(grid.centre_m(2, 0), [2_600_005.25, 1_200_003.0]);
}

#[test]
fn case_order_line_ends_and_centre_keywords_make_no_difference() {
    let grid = parse(SMALL).unwrap();
    let centred = SMALL.replace("xllcorner 2600000.25", "XLLCENTER 2600001.25");
    let centred = centred.replace("yllcorner 1200000", "YllCenter 1.200001e6");
    let swapped = SMALL.replacen("ncols 3\nnrows 2", "NROWS 2\nNCOLS   3", 1);
    let no_nodata = SMALL.replace("NODATA_value -9999\n", "").replace("-9999", "-9999.5");
    let nan = SMALL.replace("-9999", "nan");
    let wrapped = SMALL.replace("12\n", "\n\n12 ");
    for text in
        [centred, swapped, SMALL.replace('\n', "\r\n"), nan, wrapped, format!("\u{feff}{SMALL}")]
    {
        assert_eq!(parse(&text).unwrap(), grid, "{text}");
    }
    assert_eq!(parse(&no_nodata).unwrap().value(1, 1), Some(-9999.5));
}

#[test]
fn a_refused_grid_names_the_line_and_the_cure() {
    for (from, to, place, part) in [
        ("22.5\n", "", "line 8 (the last)", "5 values for ncols x nrows = 3 x 2"),
        ("22.5\n", "22.5 1\n", "line 8", "more than ncols x nrows = 3 x 2"),
        ("11", "1,1", "line 7", "`1,1` is not a finite number"),
        ("11", "inf", "line 7", "`inf` is not a finite number"),
        ("ncols 3", "ncols three", "line 1", "`ncols three`"),
        ("ncols 3", "columns 3", "line 1", "write one of ncols"),
        ("ncols 3", "ncols 1e12", "header", "no usable `ncols`"),
        ("ncols 3", "ncols 2.5", "header", "no usable `ncols`"),
        (
            "NODATA_value -9999\n",
            "",
            "line 7",
            "found a height of -9999 m; if that means no data, write the line `NODATA_value -9999` below `cellsize`",
        ),
        ("cellsize 2\n", "", "header", "no usable `cellsize`"),
        ("cellsize 2", "cellsize -2", "header", "no usable `cellsize`: found -2"),
        ("xllcorner", "xllcentre", "line 3", "xllcenter"),
    ] {
        let message = parse(&SMALL.replacen(from, to, 1)).expect_err(part).to_string();
        assert!(message.contains(place) && message.contains(part), "{message}");
    }
    assert!(parse("").unwrap_err().to_string().contains("header"));
}

/// A plane stays a plane with the area `cell² / cos`, faces up, and is 1 m lattice exact: no rounding in binary
/// fractions.
#[test]
fn a_plane_becomes_two_upward_facets_a_cell() {
    let values = (0..20).map(|k| Some(f64::from(k % 5))).collect();
    let grid = Grid { columns: 5, rows: 4, corner_m: [0.0, 0.0], cell_m: 1.0, values };
    let facets = grid.facets(Vec3::zeros());
    assert_eq!(facets.len(), 2 * 4 * 3);
    for facet in &facets {
        assert_eq!(area_vector(facet), Vec3::new(-1.0, 0.0, 1.0));
    }
}

/// The cell is cut along the diagonal with the smaller height difference, ties from south-west to north-east.
#[test]
fn ridges_are_followed_and_a_missing_corner_leaves_one_facet() {
    let cell = |z: [f64; 4]| {
        triangulate(2, 2, |i, j| {
            let z = z[[[0, 3], [1, 2]][i][j]];
            z.is_finite().then(|| Vec3::new(i as f64, j as f64, z))
        })
    };
    let on_diagonal = |facets: &[Facet], x: f64, y: f64| {
        facets.iter().filter(|f| f.iter().any(|p| p.x == x && p.y == y)).count()
    };
    assert_eq!(on_diagonal(&cell([5.0, 0.0, 5.0, 0.0]), 0.0, 0.0), 2);
    assert_eq!(on_diagonal(&cell([5.0, 0.0, 4.0, 0.0]), 1.0, 0.0), 2);
    for missing in 0..4 {
        let mut z = [0.0; 4];
        z[missing] = f64::NAN;
        let facets = cell(z);
        assert_eq!(facets.len(), 1);
        assert_eq!(area_vector(&facets[0]), Vec3::z());
        z[(missing + 1) % 4] = f64::NAN;
        assert!(cell(z).is_empty());
    }
}

#[test]
fn facets_stand_around_the_whole_metre_origin() {
    let grid = parse(&SMALL.replace(" -9999 ", " 9 ")).unwrap();
    let origin_m = grid.map_origin_m();
    assert_eq!(origin_m, Vec3::new(2_600_003.0, 1_200_002.0, 9.0));
    let facets = grid.facets(origin_m);
    assert_eq!(facets.len(), 4);
    assert!(
        facets.iter().flatten().any(|p| p + origin_m == Vec3::new(2_600_005.25, 1_200_001.0, 22.5))
    );
}

proptest! {
    #[test]
    fn what_is_written_reads_back(
        cells in prop::collection::vec(prop::option::of(-1e4..1e4), 1..40), columns in 1usize..5,
        x in -1e7..1e7, cell_m in 1e-3..1e3,
    ) {
        let rows = cells.len().div_ceil(columns);
        let mut values = cells;
        values.resize(rows * columns, None);
        let grid = Grid { columns, rows, corner_m: [x, -x], cell_m, values };
        prop_assert_eq!(parse(&grid.text()).unwrap(), grid);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "(ncols|nrows|cellsize|[a-z0-9.\\- \n]){0,60}") {
        let _ = parse(&text);
    }
}
