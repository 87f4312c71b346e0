//! What is read, what all rocks say together, and how it is drawn.
//!
//! One program for all of it: linking takes longer than most of these tests.

#[path = "../made/mod.rs"]
mod made;
#[path = "../tiff/mod.rs"]
mod tiff;
#[path = "../yearly/mod.rs"]
mod yearly;

mod by_hand;
mod coverage;
mod differences;
mod ensemble;
mod frequency;
mod geotiff;
mod gis;
mod hazard;
mod intervals;
mod lines;
mod meshes;
mod open;
mod report;
mod results;
mod return_periods;
mod scene_doc;
mod study;
