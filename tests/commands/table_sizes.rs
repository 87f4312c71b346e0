//! A release table that gives sizes twice: what counts, what is said of it, and that nothing moves unless it is asked for.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program::message;
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};

/// A sphere of 0.2 m and 2700 kg/m³ has 90.5 kg: the second row says a sixth less, the third rounds.
const TABLE: &str = "x_m,y_m,radius_m,mass_kg\n5,5,0.2,90.478\n4,5,0.2,78\n6,5,0.2,90.9\n";

fn scene(dir: &Path, table: &str, size_from: &str) -> PathBuf {
    fs::copy("tests/bad/square.stl", dir.join("square.stl")).unwrap();
    fs::write(dir.join("blocks.csv"), table).unwrap();
    let text = fs::read_to_string("tests/bad/size_from_without_table.toml").unwrap();
    let text = text
        .replace("points_m = [[5.0, 5.0]]", "table = \"blocks.csv\"")
        .replace("size_from = \"mass_kg\"", size_from);
    let file = dir.join("scene.toml");
    fs::write(&file, text).unwrap();
    file
}

/// Masses of the three rocks (kg), what is warned of, and what the plan says of the table.
fn planned(dir: &Path, table: &str, size_from: &str) -> ([f64; 3], Vec<String>, Option<String>) {
    let scene = Scene::read(&scene(dir, table, size_from)).unwrap();
    let plan = Plan::of_scene(&scene).unwrap();
    let masses = [0, 1, 2].map(|index| plan.release(index).unwrap().rock.mass_kg());
    let warnings = plan.warnings.iter().filter(|one| one.contains("size_from")).cloned().collect();
    (masses, warnings, plan.table_sizes)
}

fn near(found: [f64; 3], known: [f64; 3]) -> bool {
    found.iter().zip(known).all(|(found, known)| (found / known - 1.0).abs() < 1e-3)
}

/// The radius counts where nothing is said, as it always has, and the plan names row, both values and what it takes.
#[test]
fn a_radius_that_contradicts_a_mass_is_warned_of() {
    let dir = tempfile::tempdir().unwrap();
    let (masses, warnings, said) = planned(dir.path(), TABLE, "");
    assert!(near(masses, [90.478; 3]) && said.is_none(), "{masses:?} {said:?}");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    for part in ["1 of 3 rows", "line 3", "78 kg", "0.2 m", "90.5 kg", "radius_m is used"] {
        assert!(warnings[0].contains(part), "{part}: {}", warnings[0]);
    }
    // what agrees to rounding is not spoken of, nor is a mass that is missing
    let agrees = TABLE.replace("78", "");
    let (masses, warnings, said) = planned(dir.path(), &agrees, "");
    assert!(near(masses, [90.478; 3]) && warnings.is_empty() && said.is_none(), "{warnings:?}");
}

/// `size_from` settles it, either way, and the plan says so.
#[test]
fn a_scene_says_which_size_counts() {
    let dir = tempfile::tempdir().unwrap();
    for (size_from, known, used) in [
        ("size_from = \"mass_kg\"", [90.478, 78.0, 90.9], "mass_kg is used"),
        ("size_from = \"radius_m\"", [90.478; 3], "radius_m is used"),
    ] {
        let (masses, warnings, said) = planned(dir.path(), TABLE, size_from);
        assert!(near(masses, known) && warnings.is_empty(), "{masses:?} {warnings:?}");
        assert!(said.unwrap().contains(used));
    }
    // a mass that counts must be there
    let no_number = TABLE.replace("78", "");
    let said = message(Scene::read(&scene(dir.path(), &no_number, "size_from = \"mass_kg\"")));
    assert!(said.contains("blocks.csv") && said.contains("line 3"), "{said}");
    let no_column = TABLE.replace("mass_kg", "mass");
    let said = message(Scene::read(&scene(dir.path(), &no_column, "size_from = \"mass_kg\"")));
    assert!(said.contains("found no column mass_kg"), "{said}");
}

/// A column of radii or masses stands for `[rocks] radius_m`, which then need not be written; where neither is there, the table is named.
#[test]
fn a_column_of_sizes_stands_for_the_radius() {
    let dir = tempfile::tempdir().unwrap();
    let without = |table: &str| {
        let file = scene(dir.path(), table, "");
        let text = fs::read_to_string(&file).unwrap();
        let is_other = |line: &&str| !line.starts_with("radius_m");
        let kept: Vec<&str> = text.lines().filter(is_other).collect();
        assert!(kept.len() + 1 == text.lines().count(), "{text}");
        fs::write(&file, kept.join("\n")).unwrap();
        file
    };
    let file = without("x_m,y_m,mass_kg\n5,5,90.478\n");
    let plan = Plan::of_scene(&Scene::read(&file).unwrap()).unwrap();
    assert!((plan.release(0).unwrap().rock.radius_m - 0.2).abs() < 1e-6);
    let said = Scene::read(&without("x_m,y_m\n5,5\n")).unwrap_err().to_string();
    assert!(
        said.contains("blocks.csv") && said.contains("radius_m or mass_kg: found neither"),
        "{said}"
    );
}
