//! The view in three dimensions: what is packed is what was computed, for every reader, and nothing can leave the page.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stderr, reason = "what was not tried must be said")]

mod blocks;
mod glb;
use crate::program;

use program::rockfall;
use rockfall::output;
use rockfall::report::view::mesh::ViewMesh;
use rockfall::report::view::pack::Section;
use rockfall::report::view::{GLB, PAGE, frame::QuantizedBox, page};
use rockfall::rock::Vec3;
use rockfall::terrain::read::MeshSource;
use rockfall::terrain::weld::Up;
use rockfall::terrain::{Sheet, Terrain};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A run of an example in a folder of its own.
fn run(dir: &Path, scene: &str, releases: usize) -> PathBuf {
    let out = dir.join("out");
    let said = rockfall(&[
        "run",
        scene,
        "--quiet",
        "--releases",
        &releases.to_string(),
        "--out",
        out.to_str().unwrap(),
    ]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    out
}

fn terrain(files: &[(&str, bool)], origin_m: Vec3) -> Terrain {
    let source = |&(file, is_tree): &(&str, bool)| MeshSource {
        sheet: Sheet { path: file.into(), ground: 0, is_tree },
        up: Up::default(),
        scale: 1.0,
        options: None,
    };
    let sources: Vec<MeshSource> = files.iter().map(source).collect();
    Terrain::read(&sources, origin_m, None).unwrap().0
}

fn quick() -> Terrain {
    terrain(
        &[("terrain/quick_slope.stl", false), ("terrain/quick_trees.stl", true)],
        Vec3::new(2.6e6, 1.2e6, 500.0),
    )
}

/// Every triangle comes back with its corners within half a quantum, ground before trees, in the order of the files.
#[test]
fn the_terrain_comes_back_to_half_a_quantum() {
    let terrain = quick();
    let mesh = ViewMesh::of(&terrain);
    let read = ViewMesh::read(&mesh.text()).unwrap();
    assert_eq!(read, mesh);
    assert!(read.notes.is_empty());
    let mut order: Vec<u32> = (0..terrain.triangles.len() as u32).collect();
    order.sort_by_key(|&t| {
        let k = t as usize;
        (terrain.is_tree(t), terrain.sheet_of[k], terrain.facet_of[k])
    });
    assert_eq!(order.len(), read.triangles.len());
    assert_eq!(order.iter().filter(|&&t| !terrain.is_tree(t)).count(), read.ground);
    // far from the origin of the map half a quantum is no more than rounding of the map coordinates lets it be
    let half_m = 0.5 * read.frame.quantum_m * (1.0 + 1e-5);
    for (corners, t) in read.triangles.iter().zip(order) {
        for (vertex, local) in corners.iter().zip(terrain.corners_m(t)) {
            let (place, exact) = (Vec3::from(read.place_m(*vertex)), local + terrain.origin_m);
            assert!((place - exact).amax() <= half_m, "{place} {exact}");
        }
    }
    // a slope of some tens of metres: well below a millimetre
    assert!(read.frame.quantum_m < 1e-3, "{}", read.frame.quantum_m);
}

/// Above two kilometres the quantum stays at 3 cm and a third byte is taken; nothing is clipped at either end.
#[test]
fn a_long_slope_is_as_fine_as_a_short_one() {
    let ends = [[2.6e6, 1.2e6, 0.0], [2.61e6, 1.2e6 + 7.0, 3000.0]];
    let frame = QuantizedBox::round(ends.into_iter());
    assert!((frame.quantum_m - 0.03).abs() < 1e-12);
    for end in ends {
        let back = frame.place_m(frame.steps(end));
        assert!((0..3).all(|axis| (back[axis] - end[axis]).abs() <= 0.015 + 1e-9), "{back:?}");
    }
    let nothing = QuantizedBox::round([[f64::NAN; 3]].into_iter());
    assert_eq!(nothing.steps(nothing.low_m), [0; 3]);
}

/// Finer terrain than a page can show is drawn coarser: within the limit, within its own box, and it says so.
#[test]
fn too_many_triangles_are_thinned_and_it_is_said() {
    let fine = terrain(&[("terrain/tyrol.stl", false)], Vec3::zeros());
    let (whole, few) = (ViewMesh::of(&fine), ViewMesh::limited(&fine, 3000));
    assert!(few.triangles.len() <= 3000 && few.triangles.len() > 1000, "{}", few.triangles.len());
    assert!(few.notes[0].contains("of 23\u{2009}542 triangles"), "{:?}", few.notes);
    let area = |mesh: &ViewMesh| -> f64 {
        let corner = |v: u32| Vec3::from(mesh.place_m(v));
        let flat = |[a, b, c]: [u32; 3]| {
            let n = (corner(b) - corner(a)).cross(&(corner(c) - corner(a)));
            0.5 * n.z.abs()
        };
        mesh.triangles.iter().map(|&corners| flat(corners)).sum()
    };
    // in plan view it covers the same ground but for a rim of half a cell
    assert!((area(&few) / area(&whole) - 1.0).abs() < 0.1, "{} {}", area(&few), area(&whole));
    // of trees whole ones are left out
    let trees = ViewMesh::limited(&quick(), 100);
    assert!(trees.notes.iter().any(|note| note.starts_with("Of the trees one in")));
    assert!(trees.triangles.len() - trees.ground <= 100 && trees.triangles.len() > trees.ground);
}

/// Paths end with their rocks: a point that was due as time ran out, but for rounding of the clock, is the end. Two of them stood 2e-14 s apart, at one
/// instant of 32 bits, and the file was no glTF.
#[test]
fn a_path_whose_end_is_due_has_one_end() {
    let dir = tempfile::tempdir().unwrap();
    let scene = std::fs::read_to_string("examples/quick.toml").unwrap();
    let here = std::env::current_dir().unwrap();
    let scene = scene.replace("../terrain/", &format!("{}/terrain/", here.display()));
    let scene = scene.replace("path_step_s = 0.05", "path_step_s = 0.1");
    let file = dir.path().join("scene.toml");
    std::fs::write(&file, format!("{scene}\n[solver]\nlongest_s = 5.0\n")).unwrap();
    let out = run(dir.path(), file.to_str().unwrap(), 20);
    glb::check(&std::fs::read(out.join(GLB)).unwrap());
    let results = output::read(&out).unwrap();
    let rows: Vec<_> = results.paths().unwrap().map(|row| row.unwrap()).collect();
    assert!(rows.iter().any(|row| row.time_s >= 5.0), "no rock ran out of time");
    for pair in rows.windows(2).filter(|pair| pair[0].index == pair[1].index) {
        assert!(pair[1].time_s - pair[0].time_s > 1e-9, "{pair:?}");
    }
}

/// At most 6 bytes a triangle and 1.5 bytes a coordinate of a path, all that belongs to it included.
#[test]
fn a_view_is_small_and_what_it_holds_is_what_was_computed() {
    let dir = tempfile::tempdir().unwrap();
    let out = run(dir.path(), "examples/tyrol.toml", 60);
    let text = std::fs::read_to_string(out.join(PAGE)).unwrap();
    let terrain = page::section(&text, page::TERRAIN).unwrap();
    let mesh = ViewMesh::read(terrain).unwrap();
    assert!(terrain.len() <= 6 * mesh.triangles.len(), "{} bytes", terrain.len());
    let paths = page::section(&text, "paths").unwrap();
    let section = Section::read(paths).unwrap();
    let coordinates = section.numbers("place");
    assert!(2 * paths.len() <= 3 * coordinates.len(), "{} of {}", paths.len(), coordinates.len());
    let frame: QuantizedBox = serde_json::from_value(section.facts["frame"].clone()).unwrap();
    let (steps, _) = coordinates.as_chunks::<3>();
    let results = output::read(&out).unwrap();
    let mut count = 0;
    for ((row, steps), ticks) in results.paths().unwrap().zip(steps).zip(section.numbers("time")) {
        let row = row.unwrap();
        let place = frame.place_m(*steps);
        let off = (0..3).map(|axis| (place[axis] - row.position_m[axis]).abs());
        assert!(off.fold(0.0, f64::max) <= 0.5 * frame.quantum_m * (1.0 + 1e-5), "{row:?}");
        assert!((f64::from(*ticks) * 1e-3 - row.time_s).abs() <= 0.5001e-3, "{row:?}");
        count += 1;
    }
    assert_eq!(count, steps.len());
    let rocks = Section::read(page::section(&text, "rocks").unwrap()).unwrap();
    for (row, bits) in results.rows().unwrap().zip(rocks.numbers("runout_m")) {
        let (exact, read) = (row.unwrap().runout_m, f64::from(f32::from_bits(*bits)));
        assert!((read - exact).abs() <= 1e-4 * exact, "{read} {exact}");
    }
    node_reads_the_same(&out, &text);
    python_reads_the_same(&out, &mesh);
    glb::check(&std::fs::read(out.join(GLB)).unwrap());
}

/// The page's own decoder gives the numbers that Rust packed, column by column.
fn node_reads_the_same(out: &Path, text: &str) {
    let said = Command::new("node")
        .args([
            "tests/commands/view/decode.js",
            concat!(env!("CARGO_MANIFEST_DIR"), "/src/report/view/web/decode.js"),
        ])
        .arg(out.join(PAGE))
        .output();
    let Ok(said) = said else {
        eprintln!("node is not installed: the page's decoder was not tried");
        return;
    };
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let said = String::from_utf8(said.stdout).unwrap();
    let sum = |numbers: &[u32]| {
        let add = |all: u32, (i, number): (usize, &u32)| {
            all.wrapping_mul(31).wrapping_add(*number).wrapping_add(i as u32)
        };
        numbers.iter().enumerate().fold(0_u32, add)
    };
    let mut tried = 0;
    for line in said.lines().filter(|line| !line.starts_with("corner ")) {
        let words: Vec<&str> = line.split(' ').collect();
        let section = Section::read(page::section(text, words[0]).unwrap()).unwrap();
        let numbers = section.numbers(&words[1].replace('_', " "));
        let numbers = if numbers.is_empty() { section.numbers(words[1]) } else { numbers };
        assert_eq!(
            [numbers.len().to_string(), sum(numbers).to_string()],
            [words[2], words[3]],
            "{line}"
        );
        tried += 1;
    }
    assert!(tried > 15, "{said}");
    let mesh = ViewMesh::read(page::section(text, page::TERRAIN).unwrap()).unwrap();
    let corners = mesh.triangles.as_flattened();
    let last = mesh.vertices[*corners.last().unwrap() as usize];
    let place =
        last.map(|steps| format!("{:.3}", (f64::from(steps) * mesh.frame.quantum_m) as f32));
    assert!(said.contains(&format!("corner {} {}", sum(corners), place.join(" "))), "{said}");
}

/// Another program's reader finds the same triangles, the same box and the same rocks.
fn python_reads_the_same(out: &Path, mesh: &ViewMesh) {
    let said =
        Command::new("python3").arg("tests/commands/view/read_glb.py").arg(out.join(GLB)).output();
    let said = match said {
        Ok(said) if said.status.code() != Some(3) => said,
        _ => {
            eprintln!("python3 with pygltflib is not installed: view.glb was not read by it");
            return;
        }
    };
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let said = String::from_utf8(said.stdout).unwrap();
    let top = |axis: usize| mesh.vertices.iter().map(|steps| steps[axis]).max().unwrap();
    let top: Vec<String> =
        (0..3).map(|axis| format!("{:.3}", f64::from(top(axis)) * mesh.frame.quantum_m)).collect();
    assert!(said.contains(&format!("triangles {}\n", mesh.triangles.len())), "{said}");
    assert!(said.contains(&format!("box 0.000 0.000 0.000 {}\n", top.join(" "))), "{said}");
    assert!(said.contains("rocks 60\n") && said.contains("last rock 0 "), "{said}");
}

/// The policy forbids every request, and the page makes none; what a user wrote cannot end an element.
#[test]
fn nothing_leaves_the_page_and_no_title_breaks_it() {
    let dir = tempfile::tempdir().unwrap();
    let folder = std::fs::canonicalize("terrain").unwrap();
    let scene = std::fs::read_to_string("examples/quick.toml").unwrap();
    let nasty = r#""</script></title><script>alert(1)</script> & 'n'""#;
    let scene = scene
        .replace("\"Quick slope\"", &format!("'''{nasty}'''"))
        .replace("../terrain", folder.to_str().unwrap());
    let path = dir.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    let out = run(dir.path(), path.to_str().unwrap(), 20);
    let text = std::fs::read_to_string(out.join(PAGE)).unwrap();
    let policy =
        r#"content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'""#;
    assert_eq!(text.matches(policy).count(), 1);
    assert!(text.find(policy).unwrap() < text.find("<style>").unwrap());
    for word in [
        "http:",
        "https:",
        "src=",
        "<link",
        "@import",
        "url(",
        "fetch(",
        "import(",
        "XMLHttp",
        "WebSocket",
    ] {
        assert!(!text.contains(word), "{word}");
    }
    assert!(!text.contains("alert(1)</script>"));
    assert_eq!(text.matches("<script").count(), text.matches("</script>").count());
    assert!(ViewMesh::read(page::section(&text, page::TERRAIN).unwrap()).is_some());
    // the report stays without a script, and leads here
    let report = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(!report.contains("<script") && report.contains("href=\"view.html\""));
    // a model of megabytes is not shipped with a page: a link to it would lead nowhere
    assert!(!report.contains("view.glb"));
}

/// Drawn again from the files alone, both files are the same bytes; without paths and maps there is a view too.
#[test]
fn a_view_drawn_again_is_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let folder = std::fs::canonicalize("terrain").unwrap();
    let scene = std::fs::read_to_string("examples/paper_slope.toml").unwrap();
    let scene = scene.replace("../terrain", folder.to_str().unwrap());
    let path = dir.path().join("scene.toml");
    let (before, record) = scene.split_once("\npaths = ").expect("it keeps paths");
    let (_, after) = record.split_once('\n').expect("a number");
    std::fs::write(&path, format!("{before}\npaths = 0\n{after}")).unwrap();
    let out = run(dir.path(), path.to_str().unwrap(), 10);
    let both = || [PAGE, GLB].map(|file| std::fs::read(out.join(file)).unwrap());
    let before = both();
    let said = rockfall(&["draw", out.to_str().unwrap()]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    assert_eq!(both(), before);
    let text = String::from_utf8(before[0].clone()).unwrap();
    assert!(page::section(&text, "paths").is_none() && page::section(&text, "maps").is_none());
    glb::check(&before[1]);
    browser_draws(&out);
    // a page that is not one any more is refused, not guessed at
    std::fs::write(out.join(PAGE), "nothing").unwrap();
    let said = rockfall(&["draw", out.to_str().unwrap()]);
    let message = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.status.code() == Some(2) && message.contains("view.html: terrain"), "{message}");
}

/// Where a browser is installed: it draws the page without an error.
fn browser_draws(out: &Path) {
    let profile = tempfile::tempdir().unwrap();
    let said = Command::new("chromium")
        .args(["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"])
        .args(["--enable-unsafe-swiftshader", "--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}", out.join(PAGE).display()))
        .output();
    let Ok(said) = said else {
        eprintln!("chromium is not installed: the page was not drawn");
        return;
    };
    let page = String::from_utf8_lossy(&said.stdout);
    let start: String = page.chars().take(200).collect();
    assert!(start.contains("data-state=\"drawn\""), "{start}");
}
