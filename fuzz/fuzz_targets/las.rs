//! Any bytes are a cloud of finite points or a message.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::terrain::cloud;
use rockfall::terrain::formats::Options;
use std::io::Cursor;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    match cloud::parse(Cursor::new(bytes.to_vec()), Path::new("fuzzed.las"), &Options::default()) {
        Ok(cloud) => assert!(cloud.points_m().iter().all(|point| point.iter().all(|x| x.is_finite()))),
        Err(error) => assert!(error.to_string().starts_with("fuzzed.las: ")),
    }
});
