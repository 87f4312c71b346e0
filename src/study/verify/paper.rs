//! The paper's four examples, with its scheme, step and Table 1.

use super::draw::{FigureLine, STEP_S, heights, outline, side, speeds};
use super::{Verification, VerificationRow, timed};
use crate::error::{Error, Result};
use crate::math;
use crate::plan::Plan;
use crate::report::curves::Curves;
use crate::scene::Scene;
use crate::simulation::{
    PathPoint, Scratch, Stop, Trajectory, simulate_release, simulate_releases_together,
};
use crate::solver::Scheme;
use crate::terrain::Terrain;
use crate::terrain::make::shipped;
use crate::terrain::stl::Soup;
use crate::terrain::weld::{Piece, weld};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Slower than this a sphere has settled (m/s), as the printed step numbers were read.
const SETTLED_M_S: f64 = 1e-3;
/// Share by which a printed step number may be missed: sizes are not printed, and were fitted to 3 %.
const STEPS_SHARE: f64 = 0.06;

const SOURCE: &str = "the paper, printed";

/// One of the paper's examples with one scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Example {
    /// A sphere beside an edge.
    AsymmetricEdge,
    /// A sphere on an edge.
    SymmetricEdge,
    /// A sphere on a tetrahedron.
    Tetrahedron,
    /// 48 spheres into two containers.
    Containers,
    /// Ten rocks on a slope with trees.
    Rockfall,
}

/// The examples in the paper's order.
pub const EXAMPLES: [Example; 5] = [
    Example::AsymmetricEdge,
    Example::SymmetricEdge,
    Example::Tetrahedron,
    Example::Containers,
    Example::Rockfall,
];

/// The scene of an example: with the paper's scheme and step, or with the default scheme.
macro_rules! scene {
    ($name:literal, $as_printed:expr) => {
        if $as_printed {
            include_str!(concat!("../../../examples/paper/", $name, ".toml"))
        } else {
            include_str!(concat!("../../../examples/paper/", $name, "_adaptive.toml"))
        }
    };
}

impl Example {
    /// Runs it: with the paper's scheme and step, or with the default scheme.
    ///
    /// # Errors
    /// A shipped scene that cannot be planned.
    pub(super) fn run(self, all: &mut Verification, scheme: Scheme) -> Result<()> {
        let printed = scheme.has_fixed_step();
        let begun = all.rows.len();
        let done = match self {
            Self::AsymmetricEdge => {
                asymmetric_edge(all, (scene!("1a_asymmetric_edge", printed), printed))
            }
            Self::SymmetricEdge => symmetric_edge(all, scene!("1b_symmetric_edge", printed)),
            Self::Tetrahedron => tetrahedron(all, scene!("2_tetrahedron", printed)),
            Self::Containers => containers(all, (scene!("3_containers", printed), printed)),
            Self::Rockfall => rockfall(all, scene!("4_rockfall", printed)),
        };
        done?;
        for row in &mut all.rows[begun..] {
            row.scheme = scheme.name();
        }
        Ok(())
    }
}

/// Makes the rows of one example from what a row says: quantity, expected, source, computed, allowed.
fn rows_of(
    case: &'static str,
    seconds: f64,
) -> impl Fn(&'static str, f64, &'static str, f64, f64) -> VerificationRow {
    move |quantity, expected, source, computed, allowed| VerificationRow {
        case,
        scheme: "",
        quantity,
        expected,
        source,
        computed,
        allowed,
        seconds,
    }
}

/// The paper's settling is its scheme's own: without shear memory a sphere creeps until it rests. A scheme that
/// remembers is asked for the valley only.
fn asymmetric_edge(all: &mut Verification, (text, printed): (&str, bool)) -> Result<()> {
    let ((falls, ground), seconds) = timed(|| example(text, 0.01))?;
    let row = rows_of("1a sphere beside an edge", seconds);
    if printed {
        let settles = settles_at_step(&falls[0].path);
        let share = STEPS_SHARE * 1_230_000.0;
        all.rows.push(row(
            "comes to rest at step; with the radius of 1b, 0.0325 m, at 195 000",
            1_230_000.0,
            "the paper, printed; radius 0.166 m inferred from this number alone",
            settles,
            share,
        ));
    }
    all.rows.push(row(
        "place across the edge at the end (m): the left valley",
        -0.5,
        "the paper's Fig. 7; the valley of the inferred roof",
        falls[0].end.position_m.x,
        // a tenth of the radius: what friction on the two flanks leaves a sphere at rest
        0.016,
    ));
    all.draw("fig_09a", speeds("Example 1a: how does a sphere beside an edge come to rest? Speed (the paper’s Fig. 9a)", &falls[0].path));
    all.draw(
        "fig_07",
        side(
            "Example 1a: which valley does the sphere end in? Way of the centre (Fig. 7)",
            (&falls, &ground),
            0,
        ),
    );
    Ok(())
}

fn symmetric_edge(all: &mut Verification, text: &str) -> Result<()> {
    let ((falls, ground), seconds) = timed(|| example(text, 0.001))?;
    let row = rows_of("1b sphere on an edge", seconds);
    let settles = settles_at_step(&falls[0].path);
    let off = falls[0].end.position_m.x;
    all.rows.push(row(
        "comes to rest at step",
        109_881.0,
        SOURCE,
        settles,
        STEPS_SHARE * 109_881.0,
    ));
    all.rows.push(row("stays above the edge, off by (m)", 0.0, "symmetry", off, 1e-12));
    all.draw(
        "fig_09b",
        speeds(
            "Example 1b: how does a sphere on an edge come to rest? Speed (Fig. 9b)",
            &falls[0].path,
        ),
    );
    all.draw(
        "fig_08",
        side(
            "Example 1b: does the sphere stay on the edge? Way of the centre (Fig. 8)",
            (&falls, &ground),
            0,
        ),
    );
    Ok(())
}

fn tetrahedron(all: &mut Verification, text: &str) -> Result<()> {
    let ((falls, ground), seconds) = timed(|| example(text, 0.001))?;
    let even = text.replace("3.2e-12", "0.0");
    let ((balanced, _), balanced_seconds) = timed(|| example(&even, 0.001))?;
    let path = &falls[0].path;
    let (settles, leaves) = (settles_at_step(path), leaves_at_step(path));
    let case = "2 sphere on a tetrahedron";
    let (row, row_balanced) = (rows_of(case, seconds), rows_of(case, balanced_seconds));
    let share = |step: f64| STEPS_SHARE * step;
    all.rows.push(row("comes to rest at step", 107_004.0, SOURCE, settles, share(107_004.0)));
    all.rows.push(row("begins to fall at step", 151_004.0, SOURCE, leaves, share(151_004.0)));
    let off = balanced[0].end.position_m.x;
    let still = row_balanced("without asymmetry stays, off by (m)", 0.0, "symmetry", off, 1e-6);
    all.rows.push(still);
    all.draw(
        "fig_11",
        speeds(
            "Example 2: when does the sphere rest, and when does it fall? Speed (Fig. 11)",
            path,
        ),
    );
    all.draw(
        "fig_12",
        heights("Example 2: when does the sphere leave the apex? Its height (Fig. 12)", path),
    );
    all.draw(
        "fig_10",
        side(
            "Example 2: which side does the sphere fall to? Way of the centre (Fig. 10)",
            (&falls, &ground),
            0,
        ),
    );
    Ok(())
}

fn containers(all: &mut Verification, (text, printed): (&str, bool)) -> Result<()> {
    let ((falls, ground), seconds) = timed(|| example(text, 0.01))?;
    let row = rows_of("3 spheres into containers", seconds);
    let count =
        |of: &dyn Fn(&Trajectory) -> bool| falls.iter().filter(|fall| of(fall)).count() as f64;
    let rest = count(&|fall| fall.stop == Stop::AtRest);
    all.rows.push(row(
        "spheres at rest at the end",
        48.0,
        "the paper's Fig. 14; none is lost",
        rest,
        0.0,
    ));
    let left = count(&|fall| fall.end.position_m.x < 0.0);
    all.rows.push(row("spheres on the left", 24.0, "symmetry of the inferred start", left, 4.0));
    // the weight of all spheres on one spring
    let weight = 48.0 * falls[0].rock.mass_kg() * 9.8 / 1e9;
    let deepest = deepest_overlap(&falls);
    all.rows.push(row(
        "deepest overlap of two spheres (m)",
        0.0,
        "weight of all on one spring",
        deepest,
        weight,
    ));
    let unsettled = falls.iter().map(|fall| fall.effort.unsettled).sum::<u64>() as f64;
    let steps = falls.iter().map(|fall| fall.effort.steps).sum::<u64>() as f64;
    all.rows.push(row(
        "share of rock steps that did not settle",
        0.0,
        "8 in 50 000 steps are usual",
        unsettled / steps,
        1e-2,
    ));
    // before the spheres touch anything both schemes draw the same
    let figures: &[(&'static str, &str, usize)] = if printed {
        &[
            ("fig_14_a", "Example 3: 48 spheres at step 3 691 (Fig. 14a)", 3_691),
            ("fig_14_b", "Example 3: 48 spheres at step 19 673 (Fig. 14b)", 19_673),
            (
                "fig_14_end",
                "Example 3: where do the spheres come to rest? dda (Fig. 14)",
                usize::MAX,
            ),
        ]
    } else {
        let title = "Example 3: where do the spheres come to rest? adaptive (Fig. 14)";
        &[("fig_14_end_adaptive", title, usize::MAX)]
    };
    for &(name, title, step) in figures {
        all.draw(name, side(title, (&falls, &ground), step));
    }
    Ok(())
}

fn rockfall(all: &mut Verification, text: &str) -> Result<()> {
    let ((falls, _), seconds) = timed(|| example(text, 0.01))?;
    let row = rows_of("4 rocks on a slope with trees", seconds);
    // y runs down the slope: its foot begins at 11 m
    let arrived = |fall: &&Trajectory| {
        !matches!(fall.stop, Stop::Failed(_))
            && (fall.stop == Stop::AtRest || fall.end.position_m.y > 11.0)
    };
    let arrived = falls.iter().filter(arrived).count() as f64;
    let source = "the paper's Fig. 17; none is lost";
    all.rows.push(row("rocks at rest or past the foot", 10.0, source, arrived, 0.0));
    let mut ways = Curves::new(
        "Example 4: how do ten rocks come down? Ways of the centres (Fig. 17)",
        "Down the slope (m)",
        "Height (m)",
    );
    for fall in &falls {
        let way = fall.path.iter().map(|p| (p.motion.position_m.y, p.motion.position_m.z));
        ways.lines.push(way.collect());
    }
    // the ground under the first rock
    let under = |point: &PathPoint| {
        let place = point.motion.position_m;
        (place.y, place.z - point.clearance_m - falls[0].rock.radius_m)
    };
    ways.ground.push(falls[0].path.iter().map(under).filter(|(_, z)| z.is_finite()).collect());
    all.draw("fig_17", ways);
    Ok(())
}

/// Runs an example on its meshes as made; results in map coordinates, paths at `path_step_s`.
fn example(text: &str, path_step_s: f64) -> Result<(Vec<Trajectory>, Vec<FigureLine>)> {
    let mut scene = Scene::parse(text, Path::new("examples/paper/example.toml"))?;
    scene.record.path_step_s = Some(path_step_s);
    let plan = Plan::compile(&scene, made_terrain(&scene)?)?;
    let mut falls = if plan.rock_against_rock.is_kept() {
        simulate_releases_together(&plan, None, &AtomicBool::new(false))?.unwrap_or_default()
    } else {
        let mut scratch = Scratch::default();
        (0..plan.count)
            .map(|k| simulate_release(&plan, k, None, &mut scratch))
            .collect::<Result<_>>()?
    };
    for fall in &mut falls {
        fall.start.position_m += plan.terrain.origin_m;
        fall.end.position_m += plan.terrain.origin_m;
        for point in &mut fall.path {
            point.motion.position_m += plan.terrain.origin_m;
        }
    }
    let ground = outline(&plan.terrain);
    Ok((falls, ground))
}

/// The meshes of a scene, from the generator that also wrote the shipped files.
fn made_terrain(scene: &Scene) -> Result<Terrain> {
    let made = shipped();
    let sources = scene.mesh_sources();
    let mut soups = Vec::new();
    for source in &sources {
        let path = &source.sheet.path;
        let known = made.iter().find(|(name, _)| path.ends_with(name));
        let Some((_, facets)) = known else {
            return Err(Error::Request(format!("{}: not a made mesh", path.display())));
        };
        soups.push(Soup::from(facets.clone()));
    }
    let pieces: Vec<Piece> = (0..)
        .zip(sources.iter().zip(&soups))
        .map(|(sheet, (source, soup))| Piece {
            file: &source.sheet.path,
            soup,
            up: source.up,
            scale: source.scale,
            sheet,
        })
        .collect();
    let welded = weld(&pieces, scene.origin_m.into(), None)?;
    Ok(Terrain::new(welded, sources.iter().map(|source| source.sheet.clone()).collect()))
}

/// First step after which the sphere stays slower than [`SETTLED_M_S`] for a tenth of a second.
fn settles_at_step(path: &[PathPoint]) -> f64 {
    let slow = |point: &PathPoint| point.motion.velocity_m_s.norm() < SETTLED_M_S;
    let settled = (0..path.len()).find(|&k| {
        let start_s = path[k].motion.time_s;
        path[k..].iter().take_while(|point| point.motion.time_s < start_s + 0.1).all(slow)
    });
    settled.map_or(f64::NAN, |k| path[k].motion.time_s / STEP_S)
}

/// Step at which the sphere, settled before, is off the apex by 1 % of its radius.
fn leaves_at_step(path: &[PathPoint]) -> f64 {
    const OFF_M: f64 = 0.01 * 0.032;
    let off = |point: &&PathPoint| {
        math::hypot(point.motion.position_m.x, point.motion.position_m.y) > OFF_M
    };
    path.iter().find(off).map_or(f64::NAN, |point| point.motion.time_s / STEP_S)
}

fn deepest_overlap(falls: &[Trajectory]) -> f64 {
    let mut deepest = 0.0f64;
    for (k, one) in falls.iter().enumerate() {
        for two in &falls[k + 1..] {
            let distance = (one.end.position_m - two.end.position_m).norm();
            deepest = deepest.max(one.rock.radius_m + two.rock.radius_m - distance);
        }
    }
    deepest
}
