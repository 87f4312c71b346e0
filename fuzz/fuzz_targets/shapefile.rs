//! Any bytes are a drawing or a message: the first half is the Shapefile, the second its table.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::gis::{parse_geojson, parse_shapefile};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let (file, half) = (Path::new("fuzzed.shp"), bytes.len() / 2);
    let mut shp = 9994i32.to_be_bytes().to_vec();
    shp.resize(100, 0);
    shp.extend(&bytes[..half]);
    let table = &bytes[half..];
    if let Err(error) = parse_shapefile(&shp, Some(table), Some(table), file) {
        assert!(error.to_string().starts_with("fuzzed.shp: "));
    }
    let _ = parse_geojson(bytes, file);
});
