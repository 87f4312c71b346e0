//! Any bytes are a drawing or a message: so many of them as the first two say are the records of a Shapefile, the rest its
//! table; all of them are a GeoJSON file.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::gis::{parse_geojson, parse_shapefile};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("fuzzed.shp");
    if let [low, high, rest @ ..] = bytes {
        let (records, table) = rest.split_at(rest.len().min(u16::from_le_bytes([*low, *high]).into()));
        let mut shp = 9994i32.to_be_bytes().to_vec();
        shp.resize(100, 0);
        shp.extend(records);
        if let Err(error) = parse_shapefile(&shp, Some(table), Some(table), file) {
            assert!(error.to_string().starts_with("fuzzed.shp: "));
        }
    }
    if let Err(error) = parse_geojson(bytes, file) {
        assert!(error.to_string().starts_with("fuzzed.shp: "));
    }
});
