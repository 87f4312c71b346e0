//! Any bytes are an elevation model of finite heights or a message, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::terrain::geotiff;
use std::io::Cursor;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    match geotiff::parse(Cursor::new(bytes), bytes.len() as u64, Path::new("fuzzed.tif"), (None, None)) {
        Ok(raster) => {
            let grid = raster.grid;
            assert_eq!(grid.values.len(), grid.columns * grid.rows);
            assert!(grid.values.iter().flatten().all(|height| height.is_finite()));
        }
        Err(error) => assert!(error.to_string().starts_with("fuzzed.tif: ")),
    }
});
