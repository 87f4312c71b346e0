// Coordinates are written and read back: equality is meant.
#![allow(clippy::float_cmp)]

use super::*;
use proptest::prelude::*;

const FILE: &str = "drawn";

fn geojson(text: &str) -> Result<GisLayer> {
    parse_geojson(text.as_bytes(), Path::new(FILE))
}

fn collection(features: &str) -> String {
    format!("{{\"type\":\"FeatureCollection\",\"features\":[{features}]}}")
}

fn feature(kind: &str, coordinates: &str) -> String {
    format!(
        "{{\"type\":\"Feature\",\"properties\":{{\"name\":\"a\",\"weight\":2.5,\"none\":null}},\
             \"geometry\":{{\"type\":\"{kind}\",\"coordinates\":{coordinates}}}}}"
    )
}

/// GIS programs write names of columns in capitals: `WEIGHT` is `weight`, cut off or not. Two of one name say two things.
#[test]
fn names_of_properties_are_read_in_any_case() {
    let file = Path::new(FILE);
    let read = |names: [&str; 2]| {
        let [one, other] = names;
        let text = feature("Point", "[1,2]")
            .replace("\"weight\":2.5", &format!("\"{one}\":2.5,\"{other}\":3.5"));
        geojson(&collection(&text)).unwrap().features.remove(0)
    };
    let capital = read(["WEIGHT", "FREQUENCY_"]);
    assert_eq!(capital.positive("weight", file).unwrap(), Some(2.5));
    assert_eq!(capital.positive("frequency_per_year", file).unwrap(), Some(3.5));
    assert_eq!(capital.text("NAME").as_deref(), Some("a"));
    let said = read(["weight", "WEIGHT"]).positive("weight", file).unwrap_err().to_string();
    assert!(said.contains("feature 1: found the properties WEIGHT and weight; keep one"), "{said}");
}

/// A square with a square hole.
const HOLED: &str = "[[[0,0],[9,0],[9,9],[0,9],[0,0]],[[3,3],[3,6],[6,6],[6,3],[3,3]]]";

#[test]
fn every_geometry_is_read() {
    for (kind, coordinates, shape) in [
        ("Point", "[1,2,99]", Geometry::Points(vec![[1.0, 2.0]])),
        ("MultiPoint", "[[1,2],[3,4]]", Geometry::Points(vec![[1.0, 2.0], [3.0, 4.0]])),
        ("LineString", "[[1,2],[3,4]]", Geometry::Lines(vec![vec![[1.0, 2.0], [3.0, 4.0]]])),
        ("MultiLineString", "[[[1,2],[3,4]]]", Geometry::Lines(vec![vec![[1.0, 2.0], [3.0, 4.0]]])),
    ] {
        let layer = geojson(&collection(&feature(kind, coordinates))).unwrap();
        assert_eq!(layer.features[0].shape, shape);
        assert_eq!(layer.features[0].text("name").as_deref(), Some("a"));
        assert_eq!(layer.features[0].positive("weight", Path::new(FILE)).unwrap(), Some(2.5));
        assert!(layer.features[0].property("none").is_none());
    }
    let expected = Polygon {
        outline_m: vec![[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]],
        holes_m: vec![vec![[3.0, 3.0], [3.0, 6.0], [6.0, 6.0], [6.0, 3.0]]],
    };
    // rings in any order, direction and start
    let turned = "[[[6,6],[6,3],[3,3],[3,6],[6,6]],[[9,9],[9,0],[0,0],[0,9],[9,9]]]";
    for (kind, coordinates) in [
        ("Polygon", HOLED.to_owned()),
        ("MultiPolygon", format!("[{HOLED}]")),
        ("Polygon", turned.to_owned()),
    ] {
        let layer = geojson(&collection(&feature(kind, &coordinates))).unwrap();
        assert_eq!(layer.features[0].shape, Geometry::Polygons(vec![expected.clone()]));
    }
}

#[test]
fn the_system_is_read_and_degrees_are_refused() {
    let with = |name: &str| {
        let crs =
            format!("{{\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"{name}\"}}}},");
        geojson(&collection(&feature("Point", "[1,2]")).replacen('{', &crs, 1))
    };
    assert_eq!(with("urn:ogc:def:crs:EPSG::2056").unwrap().epsg, Some(2056));
    assert_eq!(with("EPSG:31287").unwrap().epsg, Some(31_287));
    assert_eq!(geojson(&collection(&feature("Point", "[1,2]"))).unwrap().epsg, None);
    for name in ["urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326"] {
        let said = with(name).unwrap_err().to_string();
        assert!(said.contains("ogr2ogr -t_srs EPSG:CODE drawn.geojson drawn"), "{said}");
    }
}

#[test]
fn a_refused_drawing_names_the_feature() {
    let two = |second: String| collection(&format!("{},{second}", feature("Point", "[1,2]")));
    for (text, part) in [
        (two(feature("Point", "[1]")), "feature 2: found a place without two numbers"),
        (two(feature("Point", "[1,1e9]")), "feature 2: found the coordinates (1, 1000000000)"),
        (two(feature("Circle", "[1,2]")), "feature 2: found a geometry of type \"Circle\""),
        (two(feature("LineString", "3")), "feature 2: found coordinates that are no list"),
        (
            two("{\"type\":\"Feature\",\"geometry\":null}".to_owned()),
            "feature 2: found no geometry; draw it",
        ),
        (two(feature("Polygon", "[]")), "feature 2: found no geometry; draw it"),
        (two(feature("MultiLineString", "[[]]")), "feature 2: found no geometry; draw it"),
        ("{\"type\":\"Topology\"}".to_owned(), "found \"Topology\""),
        ("[1,\n2".to_owned(), "line 2: found no JSON"),
    ] {
        let said = geojson(&text).expect_err(part).to_string();
        assert!(said.contains(part), "{said}");
    }
}

/// A Shapefile of one polygon record, and its table of one row.
fn holed_shapefile() -> (Vec<u8>, Vec<u8>) {
    // outline clockwise, hole anticlockwise, as the format wants it
    let rings: [&[[f64; 2]]; 2] = [
        &[[0.0, 0.0], [0.0, 9.0], [9.0, 9.0], [9.0, 0.0], [0.0, 0.0]],
        &[[3.0, 3.0], [6.0, 3.0], [6.0, 6.0], [3.0, 6.0], [3.0, 3.0]],
    ];
    let mut content = 5i32.to_le_bytes().to_vec();
    content.extend([0.0f64, 0.0, 9.0, 9.0].iter().flat_map(|x| x.to_le_bytes()));
    content.extend([2i32, 10, 0, 5].iter().flat_map(|x| x.to_le_bytes()));
    content.extend(rings.concat().iter().flatten().flat_map(|x| x.to_le_bytes()));
    let mut shp = 9994i32.to_be_bytes().to_vec();
    shp.resize(100, 0);
    shp.extend(1i32.to_be_bytes());
    shp.extend((content.len() as u32 / 2).to_be_bytes());
    shp.extend(content);
    let columns: [(&[u8], u8, u8); 3] =
        [(b"name", b'C', 6), (b"weight", b'N', 8), (b"frequency_", b'F', 10)];
    let mut dbf = vec![3, 24, 1, 1];
    dbf.extend(1u32.to_le_bytes());
    dbf.extend((32 + 32 * 3 + 1u16).to_le_bytes());
    dbf.extend(25u16.to_le_bytes());
    dbf.resize(32, 0);
    for (name, kind, length) in columns {
        let mut field = name.to_vec();
        field.resize(11, 0);
        field.extend([kind, 0, 0, 0, 0, length]);
        field.resize(32, 0);
        dbf.extend(field);
    }
    dbf.push(b'\r');
    dbf.extend(b" a     ");
    dbf.extend(b"    2.50");
    dbf.extend(b"     0.125");
    (shp, dbf)
}

#[test]
fn a_shapefile_says_what_the_geojson_says() {
    let (shp, dbf) = holed_shapefile();
    let wkt =
        b"PROJCS[\"CH1903+ / LV95\",GEOGCS[\"x\",AUTHORITY[\"EPSG\",\"4150\"]],UNIT[\"metre\",1,\
                AUTHORITY[\"EPSG\",\"9001\"]],AUTHORITY[\"EPSG\",\"2056\"]]";
    let layer = parse_shapefile(&shp, Some(&dbf), Some(wkt), Path::new(FILE)).unwrap();
    let drawn = geojson(&collection(&feature("Polygon", HOLED))).unwrap();
    assert_eq!(layer.features[0].shape, drawn.features[0].shape);
    assert_eq!(layer.features[0].property("name"), drawn.features[0].property("name"));
    assert_eq!(layer.features[0].property("weight"), drawn.features[0].property("weight"));
    // names of columns are cut off after ten bytes
    assert_eq!(
        layer.features[0].property("frequency_per_year"),
        Some(&PropertyValue::Number(0.125))
    );
    assert_eq!(layer.epsg, Some(2056));
    // programs of ESRI write no code: the name is kept
    let esri = b"PROJCS[\"CH1903+_LV95\",GEOGCS[\"GCS_CH1903+\"],UNIT[\"Meter\",1.0]]";
    let layer = parse_shapefile(&shp, None, Some(esri), Path::new(FILE)).unwrap();
    assert_eq!((layer.epsg, layer.system.as_deref()), (None, Some("CH1903+_LV95")));
    let feet = b"PROJCS[\"Feet\",GEOGCS[\"G\",UNIT[\"Degree\",0.0174532925199433]],UNIT[\"US survey foot\",0.304800609601219]]";
    let said = parse_shapefile(&shp, None, Some(feet), Path::new(FILE)).unwrap_err().to_string();
    assert!(said.contains("found US survey foot; write it in metres: ogr2ogr"), "{said}");
    let said = parse_shapefile(&shp, None, None, Path::new("drawn.SHX")).unwrap_err().to_string();
    assert!(said.contains("found the index of a Shapefile; write the name of the .shp"), "{said}");
    let degrees = b"GEOGCS[\"GCS_WGS_1984\",UNIT[\"Degree\",0.017]]";
    let said = parse_shapefile(&shp, None, Some(degrees), Path::new(FILE)).unwrap_err().to_string();
    assert!(said.contains("ogr2ogr -t_srs"), "{said}");
}

/// What says that a length is in feet is found in every spelling, and angles, scales and metres are not taken for it.
#[test]
fn units_of_length_are_told_from_angles() {
    let unit = |text: &str| wkt::system(text).other_unit;
    let metres = "PROJCRS[\"a\",BASEGEOGCRS[\"b\",ELLIPSOID[\"c\",6377397.155,299.15,LENGTHUNIT[\"metre\",1]],PRIMEM[\"Greenwich\",0,ANGLEUNIT[\"degree\",0.0174532925199433]]],\
        CONVERSION[\"d\",PARAMETER[\"k\",0.9996,SCALEUNIT[\"unity\",1]]],CS[Cartesian,2],LENGTHUNIT[\"metre\",1,ID[\"EPSG\",9001]]]";
    assert_eq!(unit(metres), None);
    assert_eq!(
        unit(&metres.replace("\"metre\",1,ID", "\"foot\",0.3048,ID")).as_deref(),
        Some("foot")
    );
    let old = "COMPD_CS[\"a\",PROJCS[\"b\",GEOGCS[\"c\",UNIT[\"grad\",0.01570796]],UNIT[\"Meter\",1.0]],VERT_CS[\"d\",UNIT[\"metre\",1.0]]]";
    assert_eq!(unit(old), None);
    let heights =
        old.replace("UNIT[\"metre\",1.0]", "UNIT[ \"US survey foot\", 0.304800609601219 ]");
    assert_eq!(unit(&heights.replace("[ ", "[")).as_deref(), Some("US survey foot"));
}

#[test]
fn a_file_is_converted_into_another_one() {
    let command = |name: &str, from: &str| transformed(Path::new(name), Some(2056), from);
    assert_eq!(command("a/z.shp", ""), "ogr2ogr -t_srs EPSG:2056 z.geojson a/z.shp");
    assert_eq!(
        command("z.geojson", "4326"),
        "ogr2ogr -s_srs EPSG:4326 -t_srs EPSG:2056 z_map.geojson z.geojson"
    );
}

#[test]
fn a_geopackage_is_refused_with_the_line_to_type() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("zones.gpkg");
    std::fs::write(&path, b"SQLite format 3\0....").unwrap();
    let said = read(&path).unwrap_err().to_string();
    assert!(
        said.contains("found a GeoPackage; write it as GeoJSON: ogr2ogr zones.geojson"),
        "{said}"
    );
}

proptest! {
    #[test]
    fn damaged_shapefiles_are_survived(at in 0usize..1000, value: u8, length in 0usize..1000, table: bool) {
        let (mut shp, mut dbf) = holed_shapefile();
        let bytes = if table { &mut dbf } else { &mut shp };
        let at = at % bytes.len();
        bytes[at] = value;
        bytes.truncate(bytes.len().saturating_sub(length % 400));
        let _ = parse_shapefile(&shp, Some(&dbf), None, Path::new(FILE));
    }

    #[test]
    fn any_bytes_are_a_drawing_or_a_message(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut shp = 9994i32.to_be_bytes().to_vec();
        shp.resize(100, 0);
        shp.extend(&bytes);
        let _ = parse_shapefile(&shp, Some(&bytes), Some(&bytes), Path::new(FILE));
        let _ = parse_geojson(&bytes, Path::new(FILE));
    }
}
