//! What each part of a scene costs: the scene with it over the scene without it.

use super::slope::{AREA_M, facets};
use rockfall::error::{Error, Result};
use rockfall::hazard::{LineInfo, MapFrame};
use rockfall::output::{Mode, Output, RunInfo};
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::simulation::{
    Effort, Scratch, Trajectory, simulate_release, simulate_releases_together,
};
use rockfall::study::processor_time::ProcessorTime;
use rockfall::terrain::make::{Stem, natural_slope, stem};
use rockfall::terrain::stl::{Facet, write_binary};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The benchmark as a scene, lean; the marks are where parts are put in.
pub(super) const BASE: &str = "\
title = \"Benchmark\"
seed = 7
gravity_m_s2 = 9.8
[[terrain]]
mesh = \"slope.stl\"
ground = \"slope\"
[grounds.slope]
normal_stiffness_n_m = 1e9
shear_stiffness_n_m = 0.25e9
friction_angle_deg = 35.0
restitution = 0.4
rolling_friction = 0.5
[rocks]
density_kg_m3 = 2700.0
radius_m = 0.5
[release]
count = 1
height_m = 1.0
velocity_m_s = [0.0, 0.0, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
polygon_m = [[140.0, 10.0], [160.0, 10.0], [160.0, 20.0], [140.0, 20.0]]
[record]
paths = 0
";

/// A part, and what is changed in the lean scene for either side of the comparison.
#[derive(Debug, Clone, Copy)]
struct Part {
    name: &'static str,
    without: &'static [Change],
    with: &'static [Change],
}

/// What is replaced, and by what; an empty text is the end of the scene.
type Change = (&'static str, &'static str);

const TRUNK: &str = "[[trees]]\nmesh = \"trees.stl\"\nground = \"trunk\"\n[grounds.trunk]\nnormal_stiffness_n_m = 1e8\n\
     shear_stiffness_n_m = 2.5e7\nfriction_angle_deg = 30.0\nrestitution = 0.2\n";
const LINES: &str = "[[lines]]\nname = \"upper\"\npoints_m = [[0.0, 100.0], [300.0, 100.0]]\n\
     [[lines]]\nname = \"middle\"\npoints_m = [[0.0, 200.0], [150.0, 210.0], [300.0, 200.0]]\n\
     [[lines]]\nname = \"lower\"\npoints_m = [[0.0, 260.0], [300.0, 260.0]]\n";
const BARRIER: &str = "[[barriers]]\nname = \"net\"\npoints_m = [[0.0, 240.0], [300.0, 240.0]]\nheight_m = 4.0\ncapacity_j = 1e6\n";
const CONTACT: &str = "[rocks.contact]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 0.25e9\n\
     friction_angle_deg = 30.0\nrestitution = 0.4\ntensile_strength_pa = 0.0\ncohesion_pa = 0.0\n";

const AREA: &str = "polygon_m = [[140.0, 10.0], [160.0, 10.0], [160.0, 20.0], [140.0, 20.0]]";
/// Rocks that must not start within each other; see [`points`].
const POINTS: Change = (AREA, "points_m = POINTS");

/// Every part. To add one: a row.
const PARTS: [Part; 9] = [
    Part { name: "paths, every 0.05 s", without: &[], with: &[("paths = 0", "paths = 1000000")] },
    Part { name: "impacts", without: &[], with: &[("paths = 0", "paths = 0\nimpacts = true")] },
    Part { name: "three lines", without: &[], with: &[("", LINES)] },
    Part { name: "a barrier", without: &[], with: &[("", BARRIER)] },
    Part { name: "maps, cells of 2 m", without: &[], with: &[("", "[maps]\ncell_m = 2.0\n")] },
    Part { name: "300 trees", without: &[], with: &[("", TRUNK)] },
    Part { name: "rolling friction", without: &[("rolling_friction = 0.5\n", "")], with: &[] },
    Part {
        name: "roughness of 10°",
        without: &[],
        with: &[("restitution = 0.4", "restitution = 0.4\nroughness_deg = 10.0")],
    },
    Part {
        name: "rock against rock",
        without: &[POINTS],
        with: &[POINTS, ("height_m", "together = true\nheight_m"), ("", CONTACT)],
    },
];

/// A part and what it costs.
#[derive(Debug, Clone, PartialEq)]
pub struct PartCost {
    /// The part.
    pub name: &'static str,
    /// Rocks of either scene.
    pub rocks: usize,
    /// Time of a rock (s), its rows in the files included: without and with the part.
    pub rock_s: [f64; 2],
    /// What all rocks cost, counted, without and with.
    pub effort: [Effort; 2],
    /// Whether every rock ends at the same place and time, bit for bit.
    pub same_rocks: bool,
}

/// Turns in which a scene with and without a part is computed.
const TURNS: usize = 5;
/// Trees stand in so many rows of so many.
const TREES: [usize; 2] = [20, 15];

/// Measures every part on a slope of so many triangles with so many rocks; `dir` is a folder to work in.
///
/// # Errors
/// If the folder cannot be written.
pub fn costs(
    triangles: usize,
    rocks: usize,
    dir: &Path,
    done: &mut impl FnMut(String),
) -> Result<Vec<PartCost>> {
    write_binary(&dir.join("slope.stl"), &facets(triangles))?;
    write_binary(&dir.join("trees.stl"), &trees())?;
    let mut costs = Vec::new();
    for part in &PARTS {
        let cost = cost(part, rocks, dir)?;
        done(format!("{}: {:.2} times", part.name, cost.rock_s[1] / cost.rock_s[0]));
        costs.push(cost);
    }
    Ok(costs)
}

fn cost(part: &Part, rocks: usize, dir: &Path) -> Result<PartCost> {
    let mut sides = [part.without, part.with].map(|changes| Side::new(changes, rocks, dir));
    let mut turns = [Vec::new(), Vec::new()];
    for _ in 0..TURNS {
        for (side, turns) in sides.iter_mut().zip(&mut turns) {
            let side = side.as_mut().map_err(|why| Error::Request(why.to_string()))?;
            turns.push(side.run(dir)?);
        }
    }
    let [without, with] = sides.map(|side| side.map(|side| side.journeys));
    let (without, with) = (without?, with?);
    let effort = [&without, &with].map(|all| {
        let mut sum = Effort::default();
        for one in all {
            sum.add(&one.effort);
        }
        sum
    });
    let least = |turns: &Vec<f64>| turns.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(PartCost {
        name: part.name,
        rocks: without.len(),
        rock_s: [0, 1].map(|k| least(&turns[k]) / without.len() as f64),
        effort,
        same_rocks: without.iter().zip(&with).all(|(one, other)| one.end == other.end),
    })
}

/// A scene, and the journeys of its rocks once it has run.
struct Side {
    plan: Plan,
    journeys: Vec<Trajectory>,
}

impl Side {
    fn new(changes: &[Change], rocks: usize, dir: &Path) -> Result<Self> {
        let together = changes.contains(&POINTS);
        // one world of many rocks is another problem than many worlds of one
        let count = if together { rocks.min(AREA_ROCKS) } else { rocks };
        let mut text = BASE.replace("count = 1\n", &format!("count = {count}\n"));
        for (from, to) in changes {
            text = if from.is_empty() { text + to } else { text.replace(from, to) };
        }
        let text = text.replace("POINTS", &points());
        let file = dir.join("part.toml");
        fs::write(&file, &text).map_err(Error::file("write", &file))?;
        let scene = Scene::parse(&text, &file)?;
        let (terrain, _) = scene.read_terrain()?;
        Ok(Self { plan: Plan::compile(&scene, terrain)?, journeys: Vec::new() })
    }

    /// Computes and writes all rocks once; gives the time (s).
    fn run(&mut self, dir: &Path) -> Result<f64> {
        let mut output = Output::create(info(&self.plan), &dir.join("part"), Mode::Overwrite)?;
        let clock = ProcessorTime::begin();
        self.journeys = self.fall()?;
        output.write(&self.journeys)?;
        let seconds = clock.seconds();
        drop(output);
        Ok(seconds)
    }

    fn fall(&self) -> Result<Vec<Trajectory>> {
        if self.plan.rock_against_rock.is_kept() {
            let journeys = simulate_releases_together(&self.plan, None, &AtomicBool::new(false))?;
            return Ok(journeys.unwrap_or_default());
        }
        let mut scratch = Scratch::default();
        (0..self.plan.count)
            .map(|index| simulate_release(&self.plan, index, None, &mut scratch))
            .collect()
    }
}

/// What the files need to know of a plan.
fn info(plan: &Plan) -> RunInfo {
    let lines = plan.recorders().lines.iter().map(|line| LineInfo {
        name: line.name.clone(),
        length_m: line.length_m(),
        corners_m: line.corners_m(plan.terrain.origin_m),
        of_barrier: false,
        floor: None,
    });
    let maps = plan.recorders().cells.map(|cells| MapFrame {
        west_m: cells.west_m + plan.terrain.origin_m.x,
        south_m: cells.south_m + plan.terrain.origin_m.y,
        cell_m: cells.cell_m,
        columns: cells.columns,
        rows: cells.rows,
        epsg: plan.epsg,
    });
    RunInfo {
        lines: lines.collect(),
        maps,
        keeps_paths: plan.paths.is_kept(),
        keeps_impacts: plan.impacts.is_kept(),
        has_blocks: plan.releases.has_blocks(),
        has_scars: plan.releases.has_scars(),
        ..super::output::info(&plan.terrain, &plan.ground_names, plan.count)
    }
}

/// Rocks in one world.
const AREA_ROCKS: usize = 40;

/// Places 4 m apart round the release area, as a scene has them.
fn points() -> String {
    let at =
        |k: usize| [AREA_M[0] - 10.0 + 4.0 * (k % 10) as f64, AREA_M[1] + 4.0 * (k / 10) as f64];
    format!("{:?}", (0..AREA_ROCKS).map(at).collect::<Vec<_>>())
}

/// Stems of 0.4 m over the slope below the releases, in rows that are set off against each other.
fn trees() -> Vec<Facet> {
    let slope = natural_slope(1, 1);
    let [rows, each] = TREES;
    let stand = |k: usize| {
        let (row, place) = (k / each, k % each);
        let x_m = 60.0 + 12.0 * place as f64 + 3.0 * (row % 4) as f64;
        let y_m = 60.0 + 9.0 * row as f64;
        let tree = Stem { x_m, y_m, dbh_m: 0.4, height_m: 15.0 };
        stem(&tree, (slope.height_m)(x_m, y_m))
    };
    (0..rows * each).flat_map(stand).collect()
}
