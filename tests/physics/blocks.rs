//! Blocks on the natural slope of the benchmark: none lost, none that gains energy; and what they cost.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;
use crate::schemes_agree::kolmogorov_smirnov;

use common::{GROUND, ROCK, terrain};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};
use rockfall::body::{
    Block, Core, Shape, ShapeKind, Solid, Surface, box_surface, eota, prism_surface, sphere_points,
};
use rockfall::ground::{Ground, Scar, SlipFriction};
use rockfall::plan::{Recorders, RestRule};
use rockfall::random::{Purpose, stream, unit};
use rockfall::release::{DrawnShape, Release};
use rockfall::rock::{Motion, Vec3};
use rockfall::simulation::{
    RecordOptions, RunSettings, Scratch, Stop, Trajectory, simulate, simulate_block,
};
use rockfall::solver::Scheme;
use rockfall::study::bench::settings;
use rockfall::terrain::Terrain;
use rockfall::terrain::make::natural_slope;
use std::ops::Range;
use std::time::Instant;

/// Gravity (m/s²).
const G: f64 = 9.8;
const LONG_S: f64 = 120.0;
/// Work space of a fall, and how long it is followed at most (s).
type Within<'s> = (&'s mut Scratch, f64);
/// Where chance starts.
const SEED: u64 = 11;

/// A meadow: friction that grows with slip and a scar layer.
const SOIL: Ground = Ground {
    slip_friction: Some(SlipFriction { most: 1.3, kappa_per_m: 0.7, beta_per_s: 20.0 }),
    scar: Some(Scar { strength_kn_m2: 15e3, drag: 2.5, soil_density_kg_m3: 1700.0 }),
    restitution_half_m_s: Some(9.0),
    ..HARD
};
/// Friction 35°, restitution 0.4.
const HARD: Ground = Ground {
    // a corner of 0.04 m must not sink in at 40 m/s
    normal_stiffness_n_m: 2e10,
    shear_stiffness_n_m: 0.5e10,
    friction_angle_rad: 35.0 * std::f64::consts::PI / 180.0,
    restitution: Some(0.4),
    ..GROUND
};

/// The same with rolling friction of soft ground.
const ROLLING: Ground = Ground { rolling_friction: 0.1, ..HARD };

/// A scan: bumps and dents on an ellipsoid, seen at 400 points, its hull thinned to 48 corners.
fn scan() -> Shape {
    let mut random = stream(SEED, Purpose::Shape, 0);
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let point = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 400.0;
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let out = (1.0 - z * z).sqrt();
        Vec3::new(out * cos, 0.75 * out * sin, 0.6 * z) * (0.92 + 0.08 * unit(&mut random))
    };
    let points: Vec<Vec3> = (0..400).map(point).collect();
    let cloud = Surface { points, triangles: Vec::new() };
    let corners = cloud.thinned(48, 0.0).unwrap().corners;
    let core = Core::of(&corners).unwrap();
    let fan = |face: &rockfall::body::HullFace| {
        let corners: Vec<u32> = face.corners.iter().map(|k| u32::from(*k)).collect();
        (1..corners.len() - 1).map(move |k| [corners[0], corners[k], corners[k + 1]])
    };
    let hull = Surface {
        triangles: core.faces.iter().flat_map(fan).collect(),
        points: core.corners.clone(),
    };
    assert!(hull.points.len() > 40 && hull.check_closed().is_ok());
    Shape::of(&Solid::of(&hull), &hull.points, 0.1).unwrap()
}

/// A sphere followed as a block: one ball at the centre.
fn one_ball() -> Shape {
    let core = Core { corners: vec![Vec3::zeros()], ridges: Vec::new(), faces: Vec::new() };
    Shape { core, ball: 1.0, inertia: [0.4; 3], bound: 1.0, cut_off: 0.0 }
}

/// All kinds of shapes, with corners rounded at a tenth of the radius; none for a sphere.
fn shapes() -> Vec<(&'static str, ShapeKind, Option<Shape>)> {
    let of =
        |surface: Surface| Some(Shape::of(&Solid::of(&surface), &surface.points, 0.1).unwrap());
    let half = [1.0, 0.8, 0.55];
    let points: Vec<Vec3> =
        sphere_points().iter().map(|p| p.component_mul(&Vec3::from(half))).collect();
    let ellipsoid = Shape::of(&Solid::ellipsoid(half), &points, 0.1).unwrap();
    vec![
        ("eota111", ShapeKind::Eota111, of(eota([1.0; 3]))),
        ("eota221", ShapeKind::Eota221, of(eota([1.0, 1.0, 0.5]))),
        ("box", ShapeKind::Box, of(box_surface([1.0, 0.7, 0.4]))),
        ("prism", ShapeKind::Prism, of(prism_surface(6, 0.7))),
        ("ellipsoid", ShapeKind::Ellipsoid, Some(ellipsoid)),
        ("mesh", ShapeKind::Mesh, Some(scan())),
        ("sphere", ShapeKind::Sphere, None),
        ("ball", ShapeKind::Sphere, Some(one_ball())),
    ]
}

/// The slope of the benchmark with about so many triangles.
fn slope(triangles: usize) -> Terrain {
    let across = (triangles as f64 * 3.0 / 8.0).sqrt().floor() as usize;
    terrain(natural_slope(across, across * 4 / 3 + 1).facets)
}

/// What falls, on what ground, and how it is computed.
#[derive(Clone, Copy)]
struct Series<'s> {
    scheme: Scheme,
    kind: ShapeKind,
    /// None for a sphere.
    shape: Option<&'s Shape>,
    ground: Ground,
}

/// Release `index` of a shape in the benchmark's area, turned at random, 1 m above the ground.
fn fall(terrain: &Terrain, series: &Series, index: usize, within: Within) -> Trajectory {
    let (scratch, longest_s) = within;
    let Series { scheme, kind, shape, ground } = *series;
    let mut random = stream(SEED, Purpose::Place, index);
    let mut next = || unit(&mut random);
    let (x, y) =
        (140.0 + 20.0 * next() - terrain.origin_m.x, 10.0 + 10.0 * next() - terrain.origin_m.y);
    let turn: [f64; 4] = std::array::from_fn(|_| next() - 0.5);
    let attitude: Rotation3<f64> =
        UnitQuaternion::from_quaternion(Quaternion::from(turn)).to_rotation_matrix();
    let block = shape.map(|shape| Block::new(shape, &ROCK));
    let bound_m = block.as_ref().map_or(ROCK.radius_m, |block| block.bound_m);
    let height_m = terrain.ground_below(x, y).unwrap() + 1.0 + bound_m;
    let motion = Motion {
        time_s: 0.0,
        position_m: Vec3::new(x, y, height_m),
        velocity_m_s: Vec3::zeros(),
        spin_rad_s: Vec3::zeros(),
    };
    let release = Release { rock: ROCK, motion, grounds: vec![ground] };
    let step_s = if scheme == Scheme::Dda { 2e-5 } else { 0.01 };
    let step = settings(scheme, step_s, None);
    let course = RunSettings {
        terrain,
        gravity_m_s2: G,
        step: &step,
        rest: RestRule { speed_m_s: 0.02, time_s: 0.3 },
        longest_s,
        recorders: Recorders::default(),
        seed: 1,
    };
    let keep = RecordOptions { path_step_s: None, impacts: false };
    let random = stream(SEED, Purpose::Impacts, index);
    let Some(block) = block else { return simulate(&course, &release, keep, random, scratch) };
    let drawn = DrawnShape { kind, sides: [1.0; 2], block, attitude };
    simulate_block(&course, (&release, &drawn), keep, random, scratch)
}

/// What a number of releases came to.
#[derive(Debug, Default)]
struct Counts {
    stops: std::collections::BTreeMap<String, usize>,
    steps: u64,
    unsettled: u64,
    leaps: u64,
    /// Largest gain of an episode over the energy released (–), and error of a ledger.
    worst: [f64; 2],
    speed_m_s: f64,
    spin: f64,
}

fn count(terrain: &Terrain, series: &Series, releases: Range<usize>) -> Counts {
    let (mut scratch, mut counts) = (Scratch::default(), Counts::default());
    let number = releases.len() as f64;
    for index in releases {
        let fall = fall(terrain, series, index, (&mut scratch, LONG_S));
        let stop = match &fall.stop {
            Stop::Failed(why) => format!("failed: {why}"),
            other => format!("{other:?}"),
        };
        *counts.stops.entry(stop).or_default() += 1;
        counts.steps += fall.effort.steps;
        counts.unsettled += fall.effort.unsettled;
        counts.leaps += fall.effort.leaps;
        let ledger = &fall.ledger;
        let whole = [ledger.friction_j, ledger.damping_j, ledger.soil_j, ledger.rolling_j];
        assert!(whole.iter().all(|part| *part >= 0.0), "{index}: {ledger:?}");
        let rolls = series.ground.rolling_friction > 0.0;
        assert_eq!(ledger.rolling_j > 0.0, rolls, "{index}: {ledger:?}");
        counts.worst[0] = counts.worst[0].max(ledger.rise_j / fall.released_j);
        counts.worst[1] = counts.worst[1].max(fall.energy_balance_error());
        counts.speed_m_s += fall.extremes.speed_m_s / number;
        counts.spin += (fall.extremes.rotational_j / fall.extremes.translational_j) / number;
    }
    counts
}

fn hold(name: &str, counts: &Counts) {
    let ends = ["AtRest", "LeftTerrain"].map(|end| counts.stops.get(end).copied().unwrap_or(0));
    let all: usize = counts.stops.values().sum();
    assert_eq!(ends.iter().sum::<usize>(), all, "{name}: {counts:?}");
    assert!(counts.worst[0] <= 1e-9, "{name}: {counts:?}");
    // that of `adaptive` is its local errors, summed
    assert!(counts.worst[1] <= 0.05, "{name}: {counts:?}");
}

fn is_round(shape: Option<&Shape>) -> bool {
    shape.is_none_or(|shape| shape.core.corners.len() == 1)
}

/// A ball rolls on until rolling friction stops it; a block needs none.
fn under(shape: Option<&Shape>, ground: Ground) -> Ground {
    let rolling_friction = if is_round(shape) { 0.5 } else { ground.rolling_friction };
    Ground { rolling_friction, ..ground }
}

/// Every shape on hard ground, on soil and with rolling friction, which round ones have on every ground: all releases come to an end
/// by themselves, and nothing gains energy.
#[test]
fn no_block_is_lost_on_the_natural_slope() {
    let slope = slope(10_000);
    for (name, kind, shape) in shapes() {
        let grounds = if is_round(shape.as_ref()) { 2 } else { 3 };
        for ground in &[HARD, SOIL, ROLLING][..grounds] {
            let ground = under(shape.as_ref(), *ground);
            for (scheme, releases) in [(Scheme::Rigid, 12), (Scheme::Adaptive, 3)] {
                let series = Series { scheme, kind, shape: shape.as_ref(), ground };
                let begun = Instant::now();
                let counts = count(&slope, &series, 0..releases);
                println!("{name} {scheme:?} {counts:?} in {:?}", begun.elapsed());
                hold(name, &counts);
            }
        }
    }
}

/// What a block takes does not depend on the blocks that a worker has followed before: steps that did not settle least of all, which are few.
#[test]
fn the_effort_of_a_block_is_its_own() {
    let (slope, prism) = (slope(10_000), prism_surface(6, 0.3));
    let shape = Shape::of(&Solid::of(&prism), &prism.points, 0.1).unwrap();
    let ground = Ground { rolling_friction: 0.3, ..HARD };
    let series =
        Series { scheme: Scheme::Rigid, kind: ShapeKind::Prism, shape: Some(&shape), ground };
    // it rocks for minutes where it comes to lie, step after step alike
    let longest_s = LONG_S / 4.0;
    let mut shared = Scratch::default();
    let (mut unsettled, mut steps) = (0, 0);
    for index in 0..60 {
        let among_others = fall(&slope, &series, index, (&mut shared, longest_s)).effort;
        let alone = fall(&slope, &series, index, (&mut Scratch::default(), longest_s)).effort;
        assert_eq!(among_others, alone, "{index}");
        (unsettled, steps) = (unsettled + alone.unsettled, steps + alone.steps);
    }
    assert!(unsettled > 0, "nothing that could be counted twice");
    assert!(unsettled as f64 <= 1e-3 * steps as f64, "{unsettled} of {steps}");
}

/// The same with 100 000 triangles and any number of releases (`ROCKFALL_RELEASES`, from number `ROCKFALL_FROM` on), with the rate on one
/// thread: every shape on both grounds with `rigid`, or the series that are named
/// (`ROCKFALL_SERIES="box hard rigid,eota221 hard adaptive"`).
#[test]
#[ignore = "hours with 100 000 releases: cargo test --test physics -- --ignored --nocapture blocks_by_the"]
fn blocks_by_the_thousand_on_the_natural_slope() {
    let number =
        |name: &str, usual: usize| std::env::var(name).map_or(usual, |n| n.parse().unwrap());
    let (from, releases) = (number("ROCKFALL_FROM", 0), number("ROCKFALL_RELEASES", 100_000));
    let named = std::env::var("ROCKFALL_SERIES").ok();
    let shapes = shapes();
    let mut all: Vec<(String, Series)> = Vec::new();
    for (name, kind, shape) in &shapes {
        for (soil, ground) in [("hard", HARD), ("soil", SOIL)] {
            for scheme in [Scheme::Rigid, Scheme::Adaptive] {
                let (kind, shape) = (*kind, shape.as_ref());
                let series = Series { scheme, kind, shape, ground: under(shape, ground) };
                all.push((format!("{name} {soil} {}", scheme.name()), series));
            }
        }
    }
    let is_asked = |name: &str| match &named {
        Some(named) => named.split(',').any(|one| one == name),
        None => name.ends_with("rigid"),
    };
    all.retain(|(name, _)| is_asked(name));
    assert!(named.is_none_or(|named| named.split(',').count() == all.len()), "unknown series");
    let slope = slope(100_000);
    for (name, series) in all {
        let begun = Instant::now();
        let counts = count(&slope, &series, from..from + releases);
        let per_s = releases as f64 / begun.elapsed().as_secs_f64();
        let corners = series.shape.map_or(0, |shape| shape.core.corners.len());
        println!("{name} ({corners} corners): {per_s:.1} rocks/s; {counts:?}");
        hold(&name, &counts);
    }
}

/// Plastic blows and long slides of boxes: what friction, dashpots and soil are said to have taken is what the rock has lost, to 0.5 % of the
/// energy released. Steps of tens of radians said up to 6 % more, and contacts that were found again pressed in took 0.6 % without a word.
#[test]
fn what_is_booked_is_what_a_block_loses() {
    let shapes = shapes();
    let soft = Ground { restitution: Some(0.0), restitution_half_m_s: None, ..SOIL };
    let hard = Ground { restitution: Some(0.0), ..HARD };
    for (triangles, ground, releases) in
        [(10_000, soft, 60), (100_000, soft, 60), (100_000, hard, 12)]
    {
        let slope = slope(triangles);
        let (scheme, kind, shape) = (Scheme::Adaptive, ShapeKind::Box, shapes[2].2.as_ref());
        let counts = count(&slope, &Series { scheme, kind, shape, ground }, 0..releases);
        println!("{triangles} {counts:?}");
        assert!(counts.worst[1] < 5e-3, "{triangles}: {counts:?}");
    }
}

/// `adaptive`, `reference` and `dda` against `rigid`: the same distribution of runout, where chance alone decides between them.
#[test]
fn schemes_agree_on_where_blocks_stop() {
    let slope = slope(10_000);
    let shapes = shapes();
    let shape = shapes[1].2.as_ref();
    let ends = |scheme, releases: usize| {
        let series = Series { scheme, kind: ShapeKind::Eota221, shape, ground: SOIL };
        let mut scratch = Scratch::default();
        let end = |index| {
            let fall = fall(&slope, &series, index, (&mut scratch, LONG_S));
            (fall.end.position_m - fall.start.position_m).xy().norm()
        };
        (0..releases).map(end).collect::<Vec<f64>>()
    };
    let rigid = ends(Scheme::Rigid, 300);
    for (scheme, releases) in [(Scheme::Adaptive, 80), (Scheme::Reference, 4), (Scheme::Dda, 6)] {
        let begun = Instant::now();
        let own = ends(scheme, releases);
        let (n, m) = (rigid.len() as f64, own.len() as f64);
        let distance = kolmogorov_smirnov(rigid.clone(), own);
        // passed by chance once in 1000 times
        let most = 1.95 * ((n + m) / (n * m)).sqrt();
        println!("{scheme:?}: {distance:.3} of {most:.3} in {:?}", begun.elapsed());
        assert!(distance < most, "{scheme:?}: {distance} of {most}");
    }
}

/// A plane that falls along y by 0.7 m a metre.
fn plane() -> Terrain {
    let at = |x: f64, y: f64| Vec3::new(x, y, 100.0 - 0.7 * y);
    let [a, b, c, d] = [at(0.0, 0.0), at(300.0, 0.0), at(300.0, 150.0), at(0.0, 150.0)];
    terrain(vec![[a, b, c], [a, c, d]])
}

/// A box that slides down a plane meets the facets of rough ground one after the other, in every scheme: it bounces where it would
/// slide.
#[test]
fn a_sliding_box_meets_facets() {
    let plane = plane();
    let (_, kind, shape) = &shapes()[2];
    for scheme in [Scheme::Rigid, Scheme::Adaptive] {
        let impacts = [0.0, 0.35].map(|roughness_rad| {
            let ground = Ground { roughness_rad, friction_angle_rad: 0.5, ..HARD };
            let series = Series { scheme, kind: *kind, shape: shape.as_ref(), ground };
            let mut scratch = Scratch::default();
            let counts = (0..3).map(|index| {
                let fall = fall(&plane, &series, index, (&mut scratch, LONG_S));
                let no_gain = fall.ledger.rise_j <= 1e-9 * fall.released_j;
                let ended = !matches!(fall.stop, Stop::Failed(_));
                assert!(no_gain && ended, "{:?} {:?}", fall.stop, fall.ledger);
                fall.impact_count
            });
            counts.sum::<u32>()
        });
        println!("{scheme:?}: {impacts:?}");
        assert!(impacts[1] > 2 * impacts[0], "{scheme:?}: {impacts:?}");
    }
}

/// Nothing but weight acts along a plane without friction: `v·s = g t sin θ`. What steps made of energy was taken off the whole motion.
#[test]
fn a_plane_without_friction_holds_no_block_back() {
    let plane = plane();
    let down = Vec3::new(0.0, 1.0, -0.7).normalize();
    let mut scratch = Scratch::default();
    for (name, kind, shape) in &shapes()[..4] {
        for restitution in [0.0, 0.35] {
            let ground = Ground { friction_angle_rad: 0.0, restitution: Some(restitution), ..HARD };
            let shape = shape.as_ref();
            let series = Series { scheme: Scheme::Rigid, kind: *kind, shape, ground };
            let kept = (0..60).map(|index| {
                let end = fall(&plane, &series, index, (&mut scratch, 5.0)).end;
                end.velocity_m_s.dot(&down) / (G * 0.7 / (1.49f64).sqrt() * end.time_s)
            });
            let [least, most] = kept.fold([1.0f64, 1.0], |[a, b], x| [a.min(x), b.max(x)]);
            assert!(
                least > 1.0 - 1e-9 && most < 1.0 + 1e-9,
                "{name} {restitution}: {least} to {most}"
            );
        }
    }
}
