//! Any text is a grid, with facets of finite numbers, or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::terrain::grid::Grid;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    match Grid::parse(&String::from_utf8_lossy(bytes), Path::new("fuzzed.asc")) {
        Ok(grid) => {
            assert_eq!(grid.values.len(), grid.columns * grid.rows);
            let _ = grid.facets(grid.map_origin_m());
        }
        Err(error) => assert!(error.to_string().starts_with("fuzzed.asc: ")),
    }
});
