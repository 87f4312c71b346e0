//! The program as its users start it.
//!
//! One program for all of it: linking takes longer than most of these tests.

#[path = "../asked/mod.rs"]
mod asked;
#[path = "../drawn/mod.rs"]
mod drawn;
#[path = "../made/mod.rs"]
mod made;
#[path = "../program/mod.rs"]
mod program;
#[path = "../site/mod.rs"]
mod site;
#[path = "../tiff/mod.rs"]
mod tiff;
#[path = "../statistics/report/svg.rs"]
#[allow(dead_code, reason = "the figures of a report ask more of it")]
mod svg;
#[path = "../statistics/report/boxes.rs"]
mod boxes;

mod astray;
mod bad_input;
mod belongs;
mod blocks;
mod bonded;
mod bounded;
mod bounded_worlds;
mod calibrate;
mod calibrate_blocks;
mod calibrate_doubts;
mod calibrate_open;
mod calibrate_selection;
mod catalogue;
mod compare;
mod damaged;
mod compare_barriers;
mod data_in;
mod disk;
mod edges;
mod first_steps;
mod fitted;
mod floors;
mod full_disk;
mod kill;
mod language;
mod library;
mod own_places;
mod pages;
mod rust_version;
mod table_sizes;
mod read_off;
mod same_everywhere;
mod shards;
mod still_moving;
mod stem_lists;
mod tiles;
mod until;
mod view;
mod weights;
mod year;
mod year_extremes;
mod zone_kinds;
mod zone_sources;
