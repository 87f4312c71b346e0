//! `rockfall-bench`: what the developers measure.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program talks")]
#![allow(clippy::disallowed_methods, reason = "what is measured here reaches no result")]

use clap::{Args, Parser};
use rockfall::ensemble::Ensemble;
use rockfall::error::{Error, Result};
use rockfall::solver::Scheme;
use rockfall_bench::rocks::{RocksArgs, follow};
use rockfall_bench::scaling::{Phase, resident_now, world};
use rockfall_bench::speed::{SpeedOptions, WRITTEN, study, write};
use rockfall_bench::{scaling_page, tile};
use std::path::PathBuf;
use std::process::ExitCode;

/// Measures the speed of rockfall and how its cost grows.
#[derive(Debug, Parser)]
#[command(name = "rockfall-bench", version, about, arg_required_else_help = true)]
enum Asked {
    /// Rocks per second of every scheme on a made slope, where the time goes, what each part of a scene costs
    Speed(SpeedArgs),
    /// Cost of more and more rocks that share one world; exit status 1 if it is not near-linear or a rock is lost
    Scaling(ScalingArgs),
    /// Rocks of one scheme on one made slope, counted in a line
    Rocks(RocksArgs),
    /// Writes a large elevation model and a scene over it, for `rockfall plan` under `/usr/bin/time -v`
    Tile(TileArgs),
}

#[derive(Debug, Args)]
struct TileArgs {
    /// Folder for `tile.tif` and `scene.toml`
    out: PathBuf,
    /// Cells of 1 m on each side; 3163 are ten million
    #[arg(default_value = "3163")]
    side: u32,
}

#[derive(Debug, Args)]
struct SpeedArgs {
    /// Folder for page, tables and figure
    #[arg(long, value_name = "DIR", default_value = "reports/speed")]
    out: PathBuf,
    /// Rocks of the fast schemes; `reference` follows a tenth of them, `dda` one of 200
    #[arg(long, value_name = "N", default_value = "400")]
    releases: usize,
    /// The product's program, for what it takes as a whole [default: beside this one]
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Sizes of the slope, about
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [10_000, 100_000, 1_000_000])]
    triangles: Vec<usize>,
}

#[derive(Debug, Args)]
struct ScalingArgs {
    /// Folder for page, table and figure
    #[arg(long, value_name = "DIR", default_value = "reports/scaling")]
    out: PathBuf,
    /// Numbers of spheres with scheme adaptive
    #[arg(
        long,
        value_name = "N,N",
        value_delimiter = ',',
        default_value = "48,500,2000,5000,20000"
    )]
    spheres: Vec<usize>,
    /// Numbers of spheres with scheme dda
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "48,500,2000")]
    dda: Vec<usize>,
    /// Numbers of spheres with scheme rigid
    #[arg(
        long,
        value_name = "N,N",
        value_delimiter = ',',
        default_value = "48,500,2000,5000,20000"
    )]
    rigid: Vec<usize>,
    /// Time to follow each world (s): falling ends at 0.25 s, impacts at 0.6 s
    #[arg(long, value_name = "S", default_value = "0.6")]
    seconds: f64,
    /// Numbers of spheres that are followed to 1.8 s with adaptive and rigid, when the heaps settle
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "48,500,2000")]
    settle: Vec<usize>,
}

fn main() -> ExitCode {
    let done = match Asked::parse() {
        Asked::Speed(args) => speed(&args).map(|()| true),
        Asked::Scaling(args) => scaling(&args),
        Asked::Tile(TileArgs { side, out }) => tile::write(side, &out).map(|()| true),
        Asked::Rocks(args) => {
            println!("{}", follow(&args));
            Ok(true)
        }
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::from(2)
        }
    }
}

/// The product's program as cargo puts it beside this one.
fn beside_this_one() -> Result<PathBuf> {
    let own = std::env::current_exe().map_err(|why| {
        Error::Request(format!("this program does not find itself, give --program: {why}"))
    })?;
    let program = own.with_file_name(format!("rockfall{}", std::env::consts::EXE_SUFFIX));
    if program.is_file() {
        return Ok(program);
    }
    Err(Error::Request(format!(
        "{}: is not there; build it with `cargo build --release`, or give --program",
        program.display()
    )))
}

fn speed(args: &SpeedArgs) -> Result<()> {
    let program = args.program.clone().map_or_else(beside_this_one, Ok)?;
    // run where its source code lies, it can name the commit
    let package = std::fs::read_to_string("Cargo.toml").unwrap_or_default();
    let source = package.contains("name = \"rockfall\"").then(|| PathBuf::from("."));
    let options = SpeedOptions {
        rocks: args.releases,
        triangles: args.triangles.clone(),
        written: WRITTEN,
        program,
        source,
    };
    let found = study(&options, &args.out.join("work"), |piece| println!("{piece}"))?;
    write(&found, &args.out)?;
    println!("page, tables and figure in {}", args.out.display());
    Ok(())
}

/// Follows worlds of more and more spheres, those of `settle` to the end of their story; whether all was as it should be.
fn scaling(args: &ScalingArgs) -> Result<bool> {
    let schemes =
        [(Scheme::Adaptive, &args.spheres), (Scheme::Dda, &args.dda), (Scheme::Rigid, &args.rigid)];
    let mut all: Vec<(usize, Scheme)> = schemes
        .into_iter()
        .flat_map(|(scheme, list)| list.iter().map(move |&spheres| (spheres, scheme)))
        .collect();
    // Small worlds first: what a large one has given back to the process would hide their memory.
    all.sort_by_key(|(spheres, _)| *spheres);
    let settled_s = Phase::Settling.times_s().1;
    // One thread: processor time is that of the thread.
    let worlds = Ensemble::new(Some(1))?.install(|| {
        let before = resident_now();
        let follow = |(spheres, scheme): (usize, Scheme)| {
            let settles = scheme != Scheme::Dda && args.settle.contains(&spheres);
            let until_s = if settles { args.seconds.max(settled_s) } else { args.seconds };
            let world = world(scheme, spheres, (until_s, before));
            println!(
                "{}, {spheres} spheres: {:.2} s of processor time for {until_s} s",
                scheme.name(),
                world.processor_s
            );
            world
        };
        all.into_iter().map(follow).collect::<Vec<_>>()
    });
    scaling_page::write(&worlds, &args.out)?;
    let found = scaling_page::findings(&worlds);
    for (words, holds) in &found {
        println!("{}{words}", if *holds { "" } else { "outside its bound: " });
    }
    println!("page, table and figure in {}", args.out.display());
    Ok(found.iter().all(|(_, holds)| *holds))
}
