//! One scene through the library: read, plan, follow three rocks, print where they end.
//!
//! `cargo run --release --example library`
#![allow(clippy::print_stdout, reason = "an example talks")]

use rockfall::error::Result;
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::simulation::{Scratch, simulate_release};
use std::path::Path;

fn main() -> Result<()> {
    let scene = Scene::read(Path::new("examples/quick.toml"))?;
    let (terrain, health) = scene.read_terrain()?;
    println!("{health}");
    let plan = Plan::compile(&scene, terrain)?;
    println!("{plan}");
    let mut scratch = Scratch::default();
    for index in 0..3 {
        let fallen = simulate_release(&plan, index, None, &mut scratch)?;
        println!(
            "rock {index}: {:?} after {:.1} s and {:.1} m, {} impacts, numerical remainder {:.1e} of its energy",
            fallen.stop,
            fallen.end.time_s,
            fallen.runout_m(),
            fallen.impact_count,
            fallen.energy_balance_error(),
        );
    }
    Ok(())
}
