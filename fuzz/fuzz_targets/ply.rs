//! Any bytes are a mesh of finite numbers or a message, as PLY and as OBJ.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::terrain::formats::{parse_obj, parse_ply};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("fuzzed.ply");
    for read in [parse_ply(bytes, file), parse_obj(bytes, file)] {
        match read {
            Ok(soup) => assert!(soup.facets.iter().flatten().all(|c| c.iter().all(|x| x.is_finite()))),
            Err(error) => assert!(error.to_string().starts_with("fuzzed.ply: ")),
        }
    }
});
