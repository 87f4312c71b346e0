//! Figures and page from made data.

#[path = "report/slope.rs"]
mod slope;

use rockfall::report;
use std::path::Path;

#[test]
#[ignore = "writes the figures for looking at: cargo test --test report look -- --ignored"]
fn look() {
    let dir = std::env::temp_dir().join("rockfall_report");
    report::draw(&slope::report(1000, 300), Path::new(&dir)).unwrap();
    println!("{}", dir.display());
}
