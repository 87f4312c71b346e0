//! Two square zones as GeoJSON and as Shapefile, written byte by byte.

#![allow(missing_docs, dead_code, unreachable_pub)]

/// Zones of 8 x 6 m with the given properties.
pub fn zones(properties: [&str; 2]) -> String {
    let square = |x: f64, y: f64| {
        format!(
            "[[[{x},{y}],[{},{y}],[{},{}],[{x},{}],[{x},{y}]]]",
            x + 8.0,
            x + 8.0,
            y + 6.0,
            y + 6.0
        )
    };
    let feature = |properties: &str, coordinates: String| {
        format!(
            "{{\"type\":\"Feature\",\"properties\":{{{properties}}},\"geometry\":{{\"type\":\"Polygon\",\"coordinates\":{coordinates}}}}}"
        )
    };
    let (a, b) = (square(2_600_010.5, 1_200_080.25), square(2_600_040.25, 1_200_070.5));
    format!(
        "{{\"type\":\"FeatureCollection\",\"features\":[{},{}]}}",
        feature(properties[0], a),
        feature(properties[1], b)
    )
}

/// The same zones, clockwise.
pub fn rings() -> [[[f64; 2]; 5]; 2] {
    let ring = |x: f64, y: f64| [[x, y], [x, y + 6.0], [x + 8.0, y + 6.0], [x + 8.0, y], [x, y]];
    [ring(2_600_010.5, 1_200_080.25), ring(2_600_040.25, 1_200_070.5)]
}

/// Polygons of five corners, clockwise as the format wants them.
pub fn shapefile(rings: &[[[f64; 2]; 5]]) -> Vec<u8> {
    let mut shp = 9994i32.to_be_bytes().to_vec();
    shp.resize(100, 0);
    for (number, ring) in (1i32..).zip(rings) {
        let mut content = 5i32.to_le_bytes().to_vec();
        content.resize(36, 0);
        content.extend([1i32, 5, 0].iter().flat_map(|x| x.to_le_bytes()));
        content.extend(ring.iter().flatten().flat_map(|x| x.to_le_bytes()));
        shp.extend(number.to_be_bytes());
        shp.extend((content.len() as u32 / 2).to_be_bytes());
        shp.extend(content);
    }
    shp
}

/// A table with one column of numbers; its name is cut after ten letters, as the format does.
pub fn column(name: &str, values: &[&str]) -> Vec<u8> {
    let mut dbf = vec![3, 24, 1, 1];
    dbf.extend((values.len() as u32).to_le_bytes());
    dbf.extend([65, 0, 9, 0]);
    dbf.resize(32, 0);
    let mut field: Vec<u8> = name.bytes().take(10).collect();
    field.resize(11, 0);
    dbf.extend(field);
    dbf.extend(b"N\0\0\0\0\x08");
    dbf.resize(64, 0);
    dbf.push(b'\r');
    dbf.extend(values.iter().flat_map(|value| format!(" {value:>8}").into_bytes()));
    dbf
}
