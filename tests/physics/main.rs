//! Physics: exact cases, oracles, conservation and the schemes against each other.
//!
//! One program for all of it: linking takes longer than most of these tests.

#[path = "../common/mod.rs"]
mod common;

mod blocks;
mod bonds;
mod chant_sura;
mod closing_gaps;
mod contact;
mod crevices;
mod damped_folds;
mod dda;
mod dda_energy;
mod dda_island;
mod dda_ledger;
mod exact_edge;
mod exact_plane;
mod facets_among_others;
mod grooves;
mod ground_border;
mod heap;
mod heaps_unloaded;
mod heights;
mod impact_ledger;
mod ledger;
mod many_rocks;
mod leaving_out;
mod oracle_contact;
mod oracle_flight;
mod pair_law;
mod pairs;
mod paper;
mod patch;
mod pyramid;
mod question;
mod restitution_of_impacts;
mod rigid_blows;
mod rigid_heap;
mod roughness;
mod scar_leap;
mod schemes_agree;
mod sheets;
mod slap;
mod soil;
mod spins_on;
mod stem_loads;
mod stems;
mod stems_in_a_row;
mod stems_struck_again;
mod stems_together;
mod struck_through;
mod tangential;
mod traps;
mod troughs;
mod uneven_ground;
mod world_flights;
mod world_ledger;
