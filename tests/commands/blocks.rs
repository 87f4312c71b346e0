//! Blocks from a scene to its tables: what is refused, what every journey must hold, the same bytes on any number of threads.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program::{message, rockfall, same_results};
use rockfall::output::read;
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::simulation::{Scratch, Stop, simulate_release};
use std::fs;
use std::path::Path;

const FILE: &str = "examples/blocks.toml";

fn text() -> String {
    fs::read_to_string(FILE).unwrap()
}

/// The example on hard ground.
fn hard() -> String {
    let soft = ["restitution_half_speed_m_s", "slip_friction", "scar"];
    let is_hard = |line: &&str| soft.iter().all(|key| !line.starts_with(key));
    text().lines().filter(is_hard).flat_map(|line| [line, "\n"]).collect()
}

fn refused(change: &[(&str, &str)]) -> String {
    let mut scene = text();
    for (from, to) in change {
        assert!(scene.contains(from), "{from}");
        scene = scene.replacen(from, to, 1);
    }
    message(Scene::parse(&scene, Path::new(FILE)))
}

/// What blocks cannot have as yet, and shapes that cannot be: each is refused with its key.
#[test]
fn what_blocks_cannot_have_is_refused() {
    for (change, key, said) in [
        (("orientation = \"random\"", "together = true"), "together", "spheres"),
        (("corner_radius = 0.15\n", ""), "corner_radius", "found nothing"),
        (("corner_radius = 0.15", "corner_radius = 0.001"), "corner_radius", "0.01..0.5"),
        (("kind = \"eota111\"", "kind = \"sphere\""), "corner_radius", "no corners"),
        (("kappa_per_m = 0.7", "kappa_per_m = 0.0"), "kappa_per_m", "above 0"),
        (("kind = \"eota111\"", "kind = \"prism\""), "sides", "needs it"),
        (("kind = \"eota111\"", "kind = \"eota111\"\naxes = [1.0, 1.0, 1.0]"), "axes", "only box"),
        (("axes = [1.0, {", "axes = [1.0, 1.0, {"), "axes", "found 4"),
        (
            ("orientation = \"random\"", "orientation = [0.0, 0.0, 0.0, 0.0]"),
            "orientation",
            "quaternion",
        ),
        (("kind = \"eota111\"", "kind = \"potato\""), "kind", "eota111"),
    ] {
        let found = refused(&[change]);
        assert!(found.contains(key) && found.contains(said), "{key}: {found}");
    }
}

/// Rolling friction beside a shape is computed, and the plan warns of it; absent or 0 it says nothing.
#[test]
fn rolling_friction_of_blocks_is_warned_of() {
    let said = |rolling: &str| {
        let text = text().replacen("restitution = 0.35", rolling, 1);
        let scene = Scene::parse(&text, Path::new(FILE)).unwrap();
        let (terrain, _) = scene.read_terrain().unwrap();
        Plan::compile(&scene, terrain).unwrap()
    };
    let warns =
        |plan: &Plan| plan.warnings.iter().any(|one| one.contains("counts the shape twice"));
    let rolls = said("restitution = 0.35\nrolling_friction = 0.05");
    assert!(rolls.rolling.is_kept() && warns(&rolls), "{:?}", rolls.warnings);
    for rolling in ["restitution = 0.35", "restitution = 0.35\nrolling_friction = 0.0"] {
        let plan = said(rolling);
        assert!(!plan.rolling.is_kept() && !warns(&plan), "{:?}", plan.warnings);
    }
    let rock = |plan: &Plan, index| {
        let fall = simulate_release(plan, index, None, &mut Scratch::default()).unwrap();
        (fall.ledger.rolling_j, fall.energy_balance_error())
    };
    let (taken_j, off) = rock(&rolls, 3);
    assert!(taken_j > 0.0 && off < 1e-9, "{taken_j} J, {off}");
    let (taken_j, _) = rock(&said("restitution = 0.35"), 3);
    assert_eq!(taken_j.to_bits(), 0.0_f64.to_bits());
}

/// A shape so slender that its balls leave no core, springs too soft for its corners, and a scan with a hole: refused before the run.
#[test]
fn shapes_that_are_no_bodies_are_refused() {
    let thin = text().replace(
        "axes = [1.0, { uniform = [0.6, 0.9] }, { uniform = [0.3, 0.5] }]",
        "axes = [1.0, 1.0, 0.02]",
    );
    let compile = |text: &str| {
        let scene = Scene::parse(text, Path::new(FILE)).unwrap();
        let (terrain, _) = scene.read_terrain().unwrap();
        message(Plan::compile(&scene, terrain))
    };
    let said = compile(&thin);
    assert!(said.contains("rocks.shapes") && said.contains("corner_radius"), "{said}");
    let soft = compile(&text().replace("scheme = \"rigid\"", "scheme = \"adaptive\""));
    assert!(soft.contains("normal_stiffness_n_m") && soft.contains("with such corners"), "{soft}");
    let open = text().replacen(
        "kind = \"eota111\"",
        "kind = \"mesh\"\nmesh = \"../terrain/paper_ridge.stl\"",
        1,
    );
    let said = compile(&open);
    assert!(said.contains("paper_ridge.stl") && said.contains("not closed"), "{said}");
}

/// Stems that give way take no more of a block than they can; those that can take more than any block has stand as those do that
/// stand for good, to the last bit.
#[test]
fn stems_give_way_to_blocks() {
    let falls = |limit: &str| {
        let breaks = format!("restitution = 0.2\n{limit}");
        let text = text().replacen("restitution = 0.2\n", &breaks, 1);
        let scene = Scene::parse(&text, Path::new(FILE)).unwrap();
        let (terrain, _) = scene.read_terrain().unwrap();
        let plan = Plan::compile(&scene, terrain).unwrap();
        let mut scratch = Scratch::default();
        let fall = |index| simulate_release(&plan, index, None, &mut scratch).unwrap();
        (0..40).map(fall).collect::<Vec<_>>()
    };
    let (standing, firm) = (falls(""), falls("breaks_above_j = 1e12\n"));
    for (one, other) in standing.iter().zip(&firm) {
        assert_eq!((one.end, one.ledger), (other.end, other.ledger));
    }
    let (weak, mut hits) = (falls("breaks_above_j = 2.0\n"), 0);
    for (fall, before) in weak.iter().zip(&standing) {
        let trees_j = fall.ledger.trees_j;
        assert_eq!(trees_j > 0.0, before.ledger.trees_j > 0.0, "{trees_j}");
        assert!(fall.ledger.rise_j <= 1e-9 * fall.released_j, "{:?}", fall.ledger);
        assert!(fall.energy_balance_error() < 1e-3, "{:?}", fall.ledger);
        // stem after stem has taken all it can
        assert!((trees_j / 2.0 - (trees_j / 2.0).round()).abs() < 1e-5, "{trees_j}");
        hits += usize::from(trees_j > 0.0);
    }
    assert!(hits > 3, "{hits}");
}

/// Every journey ends by itself, its ledger adds up with nothing negative, and no contact gains energy.
#[test]
fn every_journey_holds_its_ledger() {
    let scene = Scene::parse(&text(), Path::new(FILE)).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    let plan = Plan::compile(&scene, terrain).unwrap();
    let (mut scratch, mut blocks) = (Scratch::default(), 0);
    for index in 0..80 {
        let fall = simulate_release(&plan, index, None, &mut scratch).unwrap();
        let whole = matches!(fall.stop, Stop::AtRest | Stop::LeftTerrain);
        assert!(whole, "{index}: {:?}", fall.stop);
        let ledger = &fall.ledger;
        let contacts = [ledger.friction_j, ledger.damping_j, ledger.rolling_j];
        let parts = [contacts, [ledger.trees_j, ledger.soil_j, 0.0]].concat();
        assert!(parts.iter().all(|part| *part >= 0.0), "{index}: {ledger:?}");
        if fall.shape.is_none() {
            continue;
        }
        blocks += 1;
        let turning_j = fall.crossings.iter().map(|crossing| crossing.rotational_j);
        assert!(turning_j.fold(0.0, f64::max) <= fall.extremes.rotational_j * (1.0 + 1e-9));
        assert!(ledger.rise_j <= 1e-9 * fall.released_j, "{index}: {ledger:?}");
        assert!(fall.energy_balance_error() < 1e-3, "{index}: {ledger:?}");
    }
    assert!(blocks > 40, "{blocks}");
}

/// One thread and two give the same bytes; the tables say how blocks are turned.
#[test]
fn tables_of_blocks_do_not_depend_on_threads() {
    let dir = tempfile::tempdir().unwrap();
    let folders = ["1", "2"].map(|threads| {
        let out = dir.path().join(threads);
        let args = ["run", FILE, "--quiet", "--releases", "24", "--threads", threads, "--out"];
        let done = rockfall(&[&args[..], &[out.to_str().unwrap()]].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        out
    });
    same_results(&folders[0], &folders[1]);
    let header = |file: &str| {
        let table = fs::read_to_string(folders[0].join(file)).unwrap();
        table.lines().next().unwrap().to_owned()
    };
    assert!(
        header("releases.csv")
            .ends_with("shape,side_2,side_3,start_qw,start_qx,start_qy,start_qz,soil_j")
    );
    assert!(header("impacts.csv").ends_with("energy_lost_j,soil_j"));
    assert!(
        header("paths.csv").ends_with("qw,qx,qy,qz") && header("crossings.csv").ends_with("top_m")
    );
    let results = read(&folders[0]).unwrap();
    for row in results.rows().unwrap() {
        let row = row.unwrap();
        assert!(row.soil_j.unwrap() > 0.0, "{row:?}");
        let shape = row.shape.unwrap();
        let size: f64 = shape.attitude.iter().map(|x| x * x).sum();
        assert!((size - 1.0).abs() < 1e-12 && shape.sides.iter().all(|side| *side > 0.0));
    }
    let soil_j = results.impacts().unwrap().map(|row| row.unwrap()).map(|row| {
        assert!(row.soil_j.unwrap() <= row.energy_lost_j * (1.0 + 1e-12), "{row:?}");
        row.soil_j.unwrap()
    });
    assert!(soil_j.sum::<f64>() > 0.0);
    for row in results.crossings().unwrap() {
        let row = row.unwrap();
        assert!(row.top_m.unwrap() > row.height_m, "{row:?}");
    }
    assert!(results.paths().unwrap().all(|row| row.unwrap().attitude.is_some()));
}

/// Facets of rough ground deflect blocks; each kind of soft soil stops them earlier; none of it gives energy.
#[test]
fn rough_ground_and_soil_change_where_blocks_stop() {
    let mean_m = |line: &str| {
        let mut scene = hard();
        let before = "restitution = 0.35\n";
        assert!(scene.contains(before));
        scene = scene.replacen(before, &format!("{before}{line}\n"), 1);
        let scene = Scene::parse(&scene, Path::new(FILE)).unwrap();
        let (terrain, _) = scene.read_terrain().unwrap();
        let plan = Plan::compile(&scene, terrain).unwrap();
        let mut scratch = Scratch::default();
        let rocks = 150;
        let ways = (0..rocks).map(|index| {
            let fall = simulate_release(&plan, index, None, &mut scratch).unwrap();
            assert!(!matches!(fall.stop, Stop::Failed(_)), "{:?}", fall.stop);
            let rise_j = fall.ledger.rise_j;
            assert!(rise_j <= 1e-9 * fall.released_j.abs(), "{line} {index} {:?}", fall.ledger);
            assert_eq!(fall.ledger.soil_j > 0.0, line.starts_with("scar"), "{line} {index}");
            fall.runout_m()
        });
        ways.sum::<f64>() / rocks as f64
    };
    let smooth = mean_m("");
    let rough = mean_m("roughness_deg = 15.0");
    let slip = mean_m("slip_friction = { max = 1.3, kappa_per_m = 0.7, beta_per_s = 20.0 }");
    let scar =
        mean_m("scar = { strength_kn_m2 = 5000.0, drag = 4.0, soil_density_kg_m3 = 1700.0 }");
    let half = mean_m("restitution_half_speed_m_s = 3.0");
    println!("{smooth:.1} m, rough {rough:.1}, slip {slip:.1}, scar {scar:.1}, half {half:.1}");
    assert!((rough - smooth).abs() > 0.01, "{smooth} {rough}");
    assert!(slip.max(scar).max(half) < smooth, "{smooth} {slip} {scar} {half}");
}

/// A scene whose only shape is a sphere is one without shapes: the same journeys to the last bit, with every scheme.
#[test]
fn a_sphere_among_shapes_is_the_sphere_of_old() {
    let quick = fs::read_to_string("examples/quick.toml").unwrap();
    let shaped = quick.replacen("[release]", "[[rocks.shapes]]\nkind = \"sphere\"\n\n[release]", 1);
    assert_ne!(quick, shaped);
    for scheme in ["adaptive", "rigid", "reference"] {
        let [old, new] = [&quick, &shaped].map(|text| {
            let text = format!("{text}\n[solver]\nscheme = \"{scheme}\"\n");
            let scene = Scene::parse(&text, Path::new("examples/quick.toml")).unwrap();
            let (terrain, _) = scene.read_terrain().unwrap();
            let plan = Plan::compile(&scene, terrain).unwrap();
            let mut scratch = Scratch::default();
            (0..5)
                .map(|index| simulate_release(&plan, index, None, &mut scratch).unwrap())
                .collect::<Vec<_>>()
        });
        // as text: a point without ground below is no number, and equals none
        assert!(format!("{old:?}") == format!("{new:?}"), "{scheme}");
    }
}

/// The page says on top which shapes there are, tells each kind by itself, and speaks of a sphere's moment of inertia only
/// where all rocks are spheres; in every language.
#[test]
fn the_page_tells_of_shapes() {
    let dir = tempfile::tempdir().unwrap();
    let folder = fs::canonicalize("terrain").unwrap();
    for (language, facts, table) in [
        ("en", "shapes: EOTA 1:1:1, box", "By shape"),
        ("de", "Formen: EOTA 1:1:1, Quader", "Nach der Form"),
        ("fr", "formes\u{a0}: EOTA 1:1:1, parallélépipède", "Selon la forme"),
        ("it", "forme: EOTA 1:1:1, parallelepipedo", "Secondo la forma"),
    ] {
        let scene = text().replace("../terrain", folder.to_str().unwrap());
        let scene = format!("{scene}\n[report]\nlanguage = \"{language}\"\n");
        let path = dir.path().join(format!("{language}.toml"));
        fs::write(&path, scene).unwrap();
        let out = dir.path().join(language);
        let run = ["run", path.to_str().unwrap(), "--quiet", "--releases", "12", "--out"];
        let done = rockfall(&[&run[..], &[out.to_str().unwrap()]].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        let front = page.split("class=\"front\"").next().unwrap();
        assert!(front.contains(facts), "{language}: {front}");
        assert!(page.contains(&format!("<h3>{table}</h3>")), "{language}");
        assert!(page.contains("ω·Iω/2") && !page.contains("I ω²/2"), "{language}");
        // the plan's line of each shape stands among the inputs too
        let inputs = page.split("id=\"inputs\"").nth(1).unwrap();
        assert!(inputs.contains("eota111"), "{language}");
    }
}
