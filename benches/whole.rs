//! Rocks per second and core on a made natural slope, with what they cost.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]

use rockfall::chance::{Purpose, stream, unit};
use rockfall::ground::Ground;
use rockfall::plan::RestRule;
use rockfall::release::Release;
use rockfall::rock::{Motion, Rock, Vec3};
use rockfall::step::{Scheme, Settings};
use rockfall::terrain::make::natural_slope;
use rockfall::terrain::stl::Soup;
use rockfall::terrain::weld::{Piece, Up, weld};
use rockfall::terrain::{Sheet, Terrain};
use rockfall::trajectory::{Course, Keep, Scratch, Stop, follow};
use std::path::Path;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let n: usize = args.get(1).and_then(|s| s.parse().ok()).unwrap_or(300);
    let cells = match args.get(2).map(String::as_str) {
        Some("10k") => (61, 82),
        Some("1M") => (612, 817),
        _ => (193, 258),
    };
    let scheme = match args.get(3).map(String::as_str) {
        Some("rigid") => Scheme::Rigid,
        Some("reference") => Scheme::Reference,
        Some("dda") => Scheme::Dda,
        _ => Scheme::Adaptive,
    };
    let tolerance_m_s = args.get(4).and_then(|s| s.parse().ok()).unwrap_or(0.05);
    let clock = Instant::now();
    let soup = Soup::from(natural_slope(cells.0, cells.1).facets);
    let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), None).unwrap();
    println!("weld {:?}", clock.elapsed());
    let clock = Instant::now();
    let terrain =
        Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }]);
    println!("index {:?} {} triangles", clock.elapsed(), terrain.triangles.len());
    let ground = Ground {
        normal_stiffness_n_m: 1e9,
        shear_stiffness_n_m: 0.25e9,
        friction_angle_rad: 35f64.to_radians(),
        restitution: Some(0.4),
        rolling_friction: 0.5,
        roughness_rad: 0.0,
    };
    let step = Settings {
        scheme,
        tolerance_m_s,
        step_s: args.get(5).and_then(|s| s.parse().ok()).unwrap_or(0.01),
        shear_memory: true,
        capture_speed_m_s: None,
    };
    let course = Course {
        terrain: &terrain,
        gravity_m_s2: 9.8,
        step: &step,
        rest: RestRule { speed_m_s: 0.02, time_s: 0.3 },
        longest_s: 120.0,
        watch: rockfall::plan::Watch::default(),
    };
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let mut scratch = Scratch::default();
    let clock = Instant::now();
    let mut runouts = Vec::new();
    let (mut effort, mut rise, mut rem, mut rel) = ([0u64; 7], 0.0f64, 0.0, 0.0);
    let mut stops = [0; 4];
    let (mut vmax, mut time) = (0.0, 0.0);
    for i in 0..n {
        let mut place = stream(7, Purpose::Place, i);
        let (x, y) =
            (140.0 + 20.0 * unit(&mut place) - 150.0, 10.0 - 200.0 + 10.0 * unit(&mut place));
        let z = terrain.ground_below(x, y).unwrap() + 1.5;
        let motion = Motion {
            time_s: 0.0,
            position_m: Vec3::new(x, y, z),
            velocity_m_s: Vec3::zeros(),
            spin_rad_s: Vec3::zeros(),
        };
        let release = Release { rock, motion, grounds: vec![ground] };
        let mut chance = stream(7, Purpose::Impacts, i);
        let f = follow(
            &course,
            &release,
            Keep { path_step_s: None, impacts: false },
            &mut chance,
            &mut scratch,
        );
        runouts.push(f.runout_m());
        for (sum, x) in effort.iter_mut().zip([
            f.effort.steps,
            f.effort.rejected,
            f.effort.leaps,
            f.effort.sweeps,
            f.effort.triangles,
            u64::from(f.impact_count),
            f.effort.unsettled,
        ]) {
            *sum += x;
        }
        rise = rise.max(f.ledger.rise_j);
        rem += f.ledger.remainder_j;
        rel += f.released_j;
        vmax += f.extremes.speed_m_s;
        time += f.end.time_s;
        stops[match f.stop {
            Stop::AtRest => 0,
            Stop::LeftTerrain => 1,
            Stop::TimeUp => 2,
            Stop::Failed(_) => 3,
        }] += 1;
    }
    let s = clock.elapsed().as_secs_f64();
    runouts.sort_by(f64::total_cmp);
    println!(
        "{:.0} rocks/s; per rock: steps {} rejected {} leaps {} sweeps {} triangles {} impacts {} unsettled {}; stops {stops:?} rise {rise:.2e} remainder {:.4} P50 {:.2} P95 {:.2} mean {:.2} vmax {:.2} time {:.1}",
        n as f64 / s,
        effort[0] / n as u64,
        effort[1] / n as u64,
        effort[2] / n as u64,
        effort[3] / n as u64,
        effort[4] / n as u64,
        effort[5] / n as u64,
        effort[6] / n as u64,
        rem / rel,
        runouts[n / 2],
        runouts[n * 95 / 100],
        runouts.iter().sum::<f64>() / n as f64,
        vmax / n as f64,
        time / n as f64
    );
}
