//! Any text is a scene or a message that names the file and the remedy.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rockfall::scene::Scene;
use std::path::Path;

fuzz_target!(|text: &str| {
    if let Err(error) = Scene::parse(text, Path::new("fuzzed.toml")) {
        let said = error.to_string();
        assert!(said.starts_with("fuzzed.toml: ") && said.contains("; "), "{said}");
    }
});
