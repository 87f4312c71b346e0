//! No file makes its reader take more memory than a small multiple of its length, whatever it claims to hold.
//!
//! One test in one program: other threads' memory would count too. The counting allocator is that of a small crate:
//! counting needs `unsafe`, which this crate forbids itself.

use peak_alloc::PeakAlloc;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use rockfall::scene::Scene;
use rockfall::terrain::grid::Grid;
use rockfall::terrain::stl;
use std::path::Path;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Bytes that a reader may take whatever the length of the file: messages, paths, first allocations.
const BASE: usize = 64 << 10;
/// Cases of each kind; `ROCKFALL_CASES=1000000 cargo test --release --test allocation` tries longer.
const CASES: u32 = 3000;

/// Most memory taken at a time by `read` beyond what was taken before (bytes).
fn peak_of<T>(read: impl FnOnce() -> T) -> usize {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    drop(read());
    MEMORY.peak_usage().saturating_sub(before)
}

/// Random bytes, words of a grammar in any order, and good files with a stretch overwritten.
fn bytes_near(
    words: &'static [&'static str],
    good: Vec<Vec<u8>>,
) -> impl Strategy<Value = Vec<u8>> {
    let any_bytes = prop::collection::vec(any::<u8>(), 0..2000);
    let any_words = prop::collection::vec(prop::sample::select(words), 0..200)
        .prop_map(|words| words.join(" ").into_bytes());
    let spoilt = (
        prop::sample::select(good),
        any::<prop::sample::Index>(),
        any_bytes.clone(),
        any::<bool>(),
    )
        .prop_map(|(mut good, at, bytes, cut)| {
            let at = at.index(good.len());
            let end = good.len().min(at + bytes.len().min(12));
            good.splice(at..end, bytes[..bytes.len().min(12)].iter().copied());
            if cut {
                good.truncate(at + 12);
            }
            good
        });
    prop_oneof![any_bytes, any_words, spoilt]
}

/// Tries many inputs; `times` is what a reader may take of memory over the length of the file (–).
fn hold(times: usize, inputs: impl Strategy<Value = Vec<u8>>, read: impl Fn(&[u8])) -> (u32, f64) {
    let cases =
        std::env::var("ROCKFALL_CASES").map_or(CASES, |cases| cases.parse().expect("a number"));
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    let most = std::cell::Cell::new(0.0_f64);
    let held = TestRunner::new(config).run(&inputs, |bytes| {
        let peak = peak_of(|| read(&bytes));
        let beyond = peak.saturating_sub(BASE) as f64 / bytes.len().max(1) as f64;
        most.set(most.get().max(beyond));
        prop_assert!(peak <= BASE + times * bytes.len(), "{} bytes take {}", bytes.len(), peak);
        Ok(())
    });
    held.expect("no panic, and memory within its bound");
    (cases, most.get())
}

/// Files of a folder with one of these endings.
fn files(folder: &str, ending: &str) -> Vec<Vec<u8>> {
    let entries =
        std::fs::read_dir(folder).expect(folder).map(|entry| entry.expect("entry").path());
    let mut paths: Vec<_> =
        entries.filter(|path| path.extension().is_some_and(|end| end == ending)).collect();
    paths.sort();
    paths
        .into_iter()
        .filter(|path| path.is_file())
        .map(|path| std::fs::read(path).expect("readable"))
        .collect()
}

const STL_WORDS: &[&str] = &[
    "solid",
    "endsolid",
    "facet",
    "normal",
    "outer",
    "loop",
    "vertex",
    "endloop",
    "endfacet",
    "0",
    "1e30",
    "nan",
    "\n",
    "\r",
    "\0",
    "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet",
];
const GRID_WORDS: &[&str] = &[
    "ncols",
    "nrows",
    "xllcorner",
    "yllcenter",
    "cellsize",
    "nodata_value",
    "\n",
    "999999999",
    "4294967296",
    "1e9",
    "2",
    "-1",
    "nan",
    "ncols 999999999\nnrows 999999999\nxllcorner 0\nyllcorner 0\ncellsize 1\n",
];
const SCENE_WORDS: &[&str] = &[
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "\n",
    "\"",
    "'''",
    "a",
    "points_m",
    "release",
    "[grounds.rock]\n",
    "radius_m",
    "1e9",
    "nan",
    "-inf",
    "0x",
    "points_m = [[0,0],[0,0],[0,0],[0,0],[0,0],[0,0]]\n",
];

/// Bombs by hand: what a few bytes could make a careless reader do.
fn bombs() {
    let mut header = vec![b' '; 84];
    header[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(peak_of(|| stl::parse(header.clone(), Path::new("bomb.stl"))) < BASE);
    let cells = "ncols 999999999\nnrows 999999999\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n";
    assert!(peak_of(|| Grid::parse(cells, Path::new("bomb.asc"))) < BASE);
    for deep in ["[", "{a=", "a.", "[[a]]\n[[a.a]]\n", "a=[[0,0],"] {
        let text = deep.repeat(20_000);
        let peak = peak_of(|| Scene::parse(&text, Path::new("bomb.toml")));
        assert!(peak < BASE + SCENE_TIMES * text.len(), "{deep}: {peak}");
    }
    let dotted = format!("[{}a]\nb = 1\n", "a.".repeat(20_000));
    let peak = peak_of(|| Scene::parse(&dotted, Path::new("bomb.toml")));
    assert!(peak < BASE + SCENE_TIMES * dotted.len(), "dotted header: {peak}");
}

/// Long good files, where the base no longer counts: memory over length (–).
fn long_files() -> [f64; 3] {
    let mesh = std::fs::read("terrain/tyrol.stl").expect("readable");
    let slope = peak_of(|| stl::parse(mesh.clone(), Path::new("t.stl"))) as f64 / mesh.len() as f64;
    let grid = format!(
        "ncols 400\nnrows 500\nxllcorner 0\nyllcorner 0\ncellsize 1\n{}",
        "1 ".repeat(200_000)
    );
    let heights = peak_of(|| Grid::parse(&grid, Path::new("t.asc"))) as f64 / grid.len() as f64;
    let scene = std::fs::read_to_string("examples/quick.toml").expect("readable");
    let points = format!("points_m = [{}]", "[1,1],".repeat(20_000));
    let scene = scene.replace("line_m = [[5.0, 4.0], [35.0, 4.0]]", &points);
    assert!(scene.len() > 100_000);
    let places = peak_of(|| Scene::parse(&scene, Path::new("t.toml"))) as f64 / scene.len() as f64;
    assert!(
        slope < 8.0 && heights < 40.0 && places < SCENE_TIMES as f64,
        "{slope} {heights} {places}"
    );
    [slope, heights, places]
}

/// A text of numbers becomes a tree of values with their places.
const SCENE_TIMES: usize = 400;

#[test]
fn memory_follows_the_length_of_the_file() {
    bombs();
    println!("long files: {:.1?} bytes a byte", long_files());
    let stl = bytes_near(
        STL_WORDS,
        [files("tests/meshes", "stl"), files("tests/bad_meshes", "stl")]
            .concat()
            .into_iter()
            .filter(|bytes| !bytes.is_empty())
            .collect(),
    );
    // a copy of the bytes, and 72 bytes in memory for each 50 of a binary file, doubled while a list grows
    let found = hold(8, stl, |bytes| drop(stl::parse(bytes.to_vec(), Path::new("t.stl"))));
    println!("STL: {} files, at most {:.1} bytes a byte beyond the base", found.0, found.1);
    let grid = bytes_near(
        GRID_WORDS,
        vec![b"ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n".to_vec()],
    );
    // 16 bytes for each number of two characters, doubled while the list grows
    let found = hold(40, grid, |bytes| {
        drop(Grid::parse(&String::from_utf8_lossy(bytes), Path::new("t.asc")));
    });
    println!("grids: {} files, at most {:.1} bytes a byte beyond the base", found.0, found.1);
    let scene = bytes_near(SCENE_WORDS, files("tests/bad", "toml"));
    let found = hold(SCENE_TIMES, scene, |bytes| {
        drop(Scene::parse(&String::from_utf8_lossy(bytes), Path::new("t.toml")));
    });
    println!("scenes: {} files, at most {:.1} bytes a byte beyond the base", found.0, found.1);
}
