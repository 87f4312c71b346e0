//! A scene through the library: read it, change a value, run it, print a percentile with its interval and one path.
//!
//! `cargo run --release --example library`
#![allow(clippy::print_stdout, reason = "an example talks")]

use rockfall::{Distribution, Mode, Plan, Quantity, RunOptions, Scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::read("examples/quick.toml".as_ref())?;
    scene.release.count = 500;
    scene.rocks.radius_m = Some(Distribution::fixed(0.4)?);
    let plan = Plan::of_scene(&scene)?;
    println!("{plan}");
    let existing = Mode::Overwrite;
    let options = RunOptions { existing, ..RunOptions::into_folder("reports/library") };
    let results = rockfall::run(&plan, &options)?;
    let p95 = &results.statistic(Quantity::MaxTotal).percentiles["p95"];
    if let (Some(low), Some(high)) = (p95.low_95, p95.high_95) {
        println!("P95 of total energy: {:.0} J, 95 % interval {low:.0} to {high:.0} J", p95.value);
    }
    for at in results.path(0)? {
        let [x, y, z] = at.position_m;
        println!("{:.2} s: {x:.2} {y:.2} {z:.2} m, {:?}", at.time_s, at.state);
    }
    Ok(())
}
