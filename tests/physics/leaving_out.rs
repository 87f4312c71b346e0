//! Leaving out changes the cost, never the answer.
#![allow(clippy::unwrap_used, reason = "a test that cannot read its scene has failed")]

use crate::common;
use common::falls;
use common::zoo::{KINDS, between, dice, point, zoo};
use rockfall::contact::neighbours::{Neighbours, PressedPath};
use rockfall::contact::{ContactPoint, ContactPoints};
use rockfall::flight::{FlightEnd, Parabola, time_of_impact};
use rockfall::plan::Plan;
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::simulation::{Effort, Trajectory};
use rockfall::terrain::Terrain;
use std::path::Path;

fn plan(scene: &str) -> Plan {
    let mut scene = Scene::read(Path::new(scene)).unwrap();
    scene.release.count = 40;
    scene.record.paths = Some(0);
    scene.record.impacts = Some(false);
    let (terrain, _) = scene.read_terrain().unwrap();
    Plan::compile(&scene, terrain).unwrap()
}

#[test]
fn a_lean_plan_gives_the_same_rocks_as_a_full_one() {
    for scene in ["examples/quick.toml", "examples/tyrol.toml", "examples/paper_slope.toml"] {
        let lean = falls(&plan(scene).without_kernels());
        let full = falls(&plan(scene).keep_everything());
        assert!(lean.iter().all(|rock| rock.path.is_empty() && rock.impacts.is_empty()));
        for (lean, full) in lean.into_iter().zip(full) {
            assert!(!full.path.is_empty() && full.impacts.len() == full.impact_count as usize);
            // how many triangles are looked at is cost: a corner that never is touched first can still end a search
            let effort = Effort { triangles: lean.effort.triangles, ..full.effort };
            let bare = Trajectory { path: Vec::new(), impacts: Vec::new(), effort, ..full };
            assert_eq!(lean, bare, "{scene}");
        }
    }
}

/// The example of blocks with scheme `adaptive` and springs stiff enough for its speeds, by explicit stages or with everything kept.
fn falls_of_blocks(is_lean: bool) -> Vec<Trajectory> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(here.join("examples/blocks.toml")).unwrap();
    let text = text.replace("../terrain", here.join("terrain").to_str().unwrap());
    let text = text.replace("e8", "e10").replace("\"rigid\"", "\"adaptive\"");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("blocks.toml");
    std::fs::write(&file, text).unwrap();
    let mut scene = Scene::read(&file).unwrap();
    scene.release.count = 30;
    let (terrain, _) = scene.read_terrain().unwrap();
    let mut plan = Plan::compile(&scene, terrain).unwrap().keep_everything();
    assert!(!plan.step.impact_kernels);
    plan.step.impact_kernels = is_lean;
    falls(&plan)
}

/// Explicit stages are what a plan leaves out with everything kept: the first impact of a block is the same within what both ways may err.
/// Later ones are another matter: a block that tumbles doubles its errors from impact to impact.
#[test]
fn the_first_impacts_of_blocks_are_those_of_implicit_stages() {
    let (lean, full) = (falls_of_blocks(true), falls_of_blocks(false));
    let mut off: Vec<f64> = Vec::new();
    for (lean, full) in lean.iter().zip(&full) {
        let (own, other) = (&lean.impacts[0], &full.impacts[0]);
        assert_eq!((own.time_s, own.speed_in_m_s), (other.time_s, other.speed_in_m_s));
        off.push((own.speed_out_m_s - other.speed_out_m_s).abs() / own.speed_in_m_s);
    }
    off.sort_by(f64::total_cmp);
    // the local error allowed is 2e-4 of the speed of the impact
    assert!(off[15] < 4e-4 && off[27] < 2e-3, "{off:?}");
    let steps = |all: &[Trajectory]| all.iter().map(|one| one.effort.steps).sum::<u64>();
    assert!(steps(&lean) < steps(&full), "{} {}", steps(&lean), steps(&full));
}

fn touches(terrain: &Terrain, centre: &Vec3, radius: f64) -> Vec<ContactPoint> {
    let (mut near, mut touches) = (Neighbours::default(), ContactPoints::default());
    near.collect(terrain, centre, radius, 0.35 * radius, 0.1 * radius);
    near.touches(terrain, centre, radius, &mut touches);
    touches.iter().copied().collect()
}

/// Flat edges, the corners that no ball can touch, and those that cannot be touched from where the ball is: with and
/// without them every rock touches the same features, and every flight ends at the same moment, on every kind of mesh.
#[test]
fn features_left_out_are_never_touched() {
    let (mut left_out, mut out_of_sight) = (0, 0);
    let (mut touched, mut landed) = (0, 0);
    for (kind, mesh) in (0..KINDS.len()).flat_map(|kind| (0..12).map(move |mesh| (kind, mesh))) {
        let (lean, full) = (zoo(kind, mesh), zoo(kind, mesh).with_every_feature().from_anywhere());
        let count = lean.features.count;
        out_of_sight += lean.features.brims.iter().filter(|one| one.front | one.back != 0).count();
        left_out += count.saddles + count.flat_corners + count.flat_edges;
        for index in 0..200 {
            let random = &mut dice(700, index + 1000 * mesh);
            let radius = 0.05 * 20f64.powf(between(random, 0.0, 1.0));
            // near corners, where what is left out would have been
            let vertex = between(random, 0.0, lean.vertices_m.len() as f64) as usize;
            let far = radius * between(random, 0.0, 1.1);
            let centre = lean.vertices_m[vertex] + point(random, 1.0).normalize() * far;
            let found = touches(&lean, &centre, radius);
            assert_eq!(found, touches(&full, &centre, radius), "{} {mesh} {index}", KINDS[kind]);
            touched += found.len();
            let flight = Parabola {
                start: centre + point(random, 1.0).normalize() * (2.0 * radius),
                velocity: point(random, 5.0),
                gravity: 9.81,
                radius,
            };
            // a rock that starts pressed in does not leap: it starts in contact
            if !touches(&full, &flight.start, radius).is_empty() {
                continue;
            }
            let end = time_of_impact(&lean, &flight, 5.0, &mut 0);
            let whole = time_of_impact(&full, &flight, 5.0, &mut 0);
            // an edge's time may be rounded otherwise in the narrower window that a neighbour leaves
            let same = match (end, whole) {
                (FlightEnd::Touch(one), FlightEnd::Touch(other)) => {
                    (one - other).abs() <= 1e-14 * one.max(1.0)
                }
                _ => end == whole,
            };
            assert!(same, "{} {mesh} {index}: {end:?} {whole:?}", KINDS[kind]);
            landed += usize::from(matches!(end, FlightEnd::Touch(_)));
        }
    }
    assert!(left_out > 1000 && touched > 5000 && landed > 4000, "{left_out} {touched} {landed}");
    assert!(out_of_sight > 1000, "{out_of_sight}");
}

/// A way of which it is said that it stays on one plane touches nothing but that plane, wherever in its enclosure the rock is: all of
/// an impact is then followed at once. On every kind of mesh, rocks a tenth to twice as large as its cells.
#[test]
fn a_way_on_one_plane_touches_nothing_else() {
    let (mut said, mut crossing) = (0, 0);
    for (kind, mesh) in (0..KINDS.len()).flat_map(|kind| (0..8).map(move |mesh| (kind, mesh))) {
        let terrain = zoo(kind, mesh);
        for index in 0..300 {
            let random = &mut dice(800, index + 1000 * mesh);
            let radius = 0.05 * 20f64.powf(between(random, 0.0, 1.0));
            let face = between(random, 0.0, terrain.triangles.len() as f64) as u32;
            let [a, b, c] = terrain.corners_m(face);
            let n = terrain.face(face).n;
            let (s, t) = (between(random, 0.0, 1.0), between(random, 0.0, 1.0));
            let foot = a + (b - a) * (s * (1.0 - t)) + (c - a) * t * (1.0 - s);
            // of an impact, and of a step that rolls or slides
            let longest = if index % 2 == 0 { 0.15 } else { 2.0 };
            let along = point(random, 1.0).cross(&n) * between(random, 0.0, longest * radius);
            let passage = PressedPath {
                start: foot + n * radius,
                along,
                into: n * -between(random, 0.0, 0.02 * radius),
                deviation_m: between(random, 0.0, 0.01 * radius),
                reach_m: along.norm() + 0.15 * radius, // more than any of them gets
            };
            let mut near = Neighbours::default();
            let (middle, half) = (passage.start + along * 0.5, 0.5 * along.norm());
            near.collect(&terrain, &middle, radius, half + 0.2 * radius, 0.1 * radius);
            if !near.meets_only_plane(face, &passage) {
                crossing += 1;
                continue;
            }
            said += 1;
            for _ in 0..30 {
                let aside = point(random, 1.0).cross(&n).normalize();
                let centre = passage.start
                    + along * between(random, 0.0, 1.0)
                    + passage.into * between(random, 0.0, 1.0)
                    + aside * between(random, 0.0, passage.deviation_m);
                let height = n.dot(&(centre - a));
                let is_own = |touch: &ContactPoint| {
                    touch.normal.dot(&n).abs() > 1.0 - 1e-9
                        && (touch.distance_m - height.abs()).abs() < 1e-6 * radius
                };
                let found = touches(&terrain, &centre, radius);
                assert!(found.iter().all(is_own), "{} {mesh} {index}: {found:?}", KINDS[kind]);
            }
        }
    }
    println!("{said} ways on one plane, {crossing} that may meet more");
    assert!(said > 2000 && crossing > 2000);
}
