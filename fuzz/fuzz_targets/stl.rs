//! Any bytes are a mesh of finite numbers, welded or refused, or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::rock::Vec3;
use rockfall::terrain::stl;
use rockfall::terrain::weld::{Piece, Up, weld};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("fuzzed.stl");
    match stl::parse(bytes.to_vec(), file) {
        Ok(soup) => {
            assert!(soup.facets.iter().flatten().all(|corner| corner.iter().all(|x| x.is_finite())));
            let piece = Piece { file, soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
            let _ = weld(&[piece], Vec3::zeros(), None);
        }
        Err(error) => assert!(error.to_string().starts_with("fuzzed.stl: ")),
    }
});
