//! What is written can be read again bit for bit, whatever interrupted the run and however it was dealt to threads.

use crate::made;

use made::{FAILS_EVERY, PATHS, fall, info};
use proptest::prelude::*;
use rockfall::ensemble::Ensemble;
use rockfall::error::Result;
use rockfall::hazard::{Hazard, Layer, Quantity, Row, StopKind};
use rockfall::output::{self, ImpactRow, Mode, Output, PathRow, RunInfo};
use rockfall::rock::Vec3;
use rockfall::simulation::{Stop, Trajectory};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use tempfile::TempDir;

const RELEASES: usize = 60;
const TABLES: [&str; 4] = ["releases.csv", "paths.csv", "impacts.csv", "crossings.csv"];

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Writes at most `chunks` chunks of `len` rocks.
fn go_on(mut output: Output, chunks: usize, len: usize) -> Result<Output> {
    for _ in 0..chunks {
        let falls: Vec<Trajectory> = output.remaining().take(len).map(fall).collect();
        output.write(&falls)?;
    }
    Ok(output)
}

fn whole_run(dir: &Path, info: RunInfo) -> Result<output::Results> {
    go_on(Output::create(info, dir, Mode::Fresh)?, 1, RELEASES)?.finish()
}

/// All bytes that must be the same in every repetition.
fn bytes(dir: &Path) -> Vec<Vec<u8>> {
    let mut files: Vec<_> =
        TABLES.iter().map(|name| fs::read(dir.join(name)).expect(name)).collect();
    for layer in Layer::ALL {
        for kind in ["asc", "tif"] {
            let name = format!("maps/{}.{kind}", layer.file());
            files.push(fs::read(dir.join(&name)).expect(&name));
        }
    }
    let summary = fs::read_to_string(dir.join("summary.json")).expect("a summary");
    let (same, _clock) = summary.split_once("\"run\":").expect("the run comes last");
    files.push(same.as_bytes().to_vec());
    files
}

fn message<T>(result: Result<T>) -> String {
    result.err().expect("an error").to_string()
}

/// Equal, with NaN equal to itself.
fn same<T: std::fmt::Debug>(one: &T, other: &T) -> bool {
    format!("{one:?}") == format!("{other:?}")
}

#[test]
fn every_table_reads_back_to_the_same_numbers() {
    let dir = folder();
    let about = info(RELEASES);
    let results = whole_run(dir.path(), about.clone()).unwrap();
    let origin_m = about.origin_m;
    for (index, row) in results.rows().unwrap().enumerate() {
        assert!(same(&row.unwrap(), &Row::of(&fall(index), origin_m)), "release {index}");
    }
    let paths: Vec<PathRow> = results.paths().unwrap().map(|row| row.unwrap()).collect();
    let expected: Vec<PathRow> = (0..PATHS)
        .flat_map(|index| {
            fall(index).path.into_iter().map(move |point| PathRow::of(index, &point, origin_m))
        })
        .collect();
    assert!(same(&paths, &expected));
    let impacts: Vec<ImpactRow> = results.impacts().unwrap().map(|row| row.unwrap()).collect();
    let falls: Vec<Trajectory> = (0..RELEASES).map(fall).collect();
    let expected: Vec<ImpactRow> = falls
        .iter()
        .flat_map(|fall| fall.impacts.iter().map(move |impact| (fall.index, impact)))
        .map(|(index, impact)| {
            let ground = &about.ground_of_sheet[usize::from(impact.sheet)];
            ImpactRow::of(index, impact, ground, origin_m)
        })
        .collect();
    assert_eq!(impacts, expected);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    /// The shortest text of a number reads back to its bits: infinite, subnormal and negative zero alike.
    #[test]
    fn numbers_keep_their_bits(numbers in prop::collection::vec(prop::num::f64::ANY, 1..200)) {
        let dir = folder();
        let falls: Vec<Trajectory> = numbers.iter().enumerate().map(|(index, &number)| {
            let mut fall = fall(index);
            fall.extremes.speed_m_s = number;
            fall.stop = Stop::Failed("no physical number".to_owned());
            fall
        }).collect();
        let mut output = Output::create(info(falls.len()), dir.path(), Mode::Fresh).unwrap();
        output.write(&falls).unwrap();
        let results = output.finish().unwrap();
        for (row, number) in results.rows().unwrap().zip(numbers) {
            let read = row.unwrap().max_speed_m_s;
            prop_assert!(read.to_bits() == number.to_bits() || read.is_nan() && number.is_nan());
        }
    }
}

/// The contract of the columns, from the first line of the files themselves.
#[test]
fn the_columns_are_those_of_the_contract() {
    let dir = folder();
    whole_run(dir.path(), info(RELEASES)).unwrap();
    let first = |name: &str| {
        fs::read_to_string(dir.path().join(name)).unwrap().lines().next().unwrap().to_owned()
    };
    assert_eq!(
        first("releases.csv"),
        "index,stop,time_s,radius_m,mass_kg,start_x_m,start_y_m,start_z_m,end_x_m,end_y_m,end_z_m,\
         end_vx_m_s,end_vy_m_s,end_vz_m_s,end_wx_rad_s,end_wy_rad_s,end_wz_rad_s,runout_m,drop_m,\
         reach_angle_deg,max_speed_m_s,max_translational_j,max_rotational_j,max_total_j,max_height_m,\
         impacts,tree_impacts,energy_balance_error,steps,leaps,sweeps,friction_j,damping_j,rolling_j,trees_j,remainder_j,others_j,passed_on_j,springs_j"
    );
    assert_eq!(
        first("paths.csv"),
        "index,time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,clearance_m,state"
    );
    assert_eq!(
        first("impacts.csv"),
        "index,time_s,x_m,y_m,z_m,feature,ground,speed_in_m_s,speed_out_m_s,energy_lost_j"
    );
    let text = fs::read_to_string(dir.path().join("releases.csv")).unwrap();
    let words: Vec<&str> =
        text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    assert_eq!(&words[..4], &["left_terrain", "at_rest", "at_rest", "failed"]);
    let text = fs::read_to_string(dir.path().join("paths.csv")).unwrap();
    assert!(text.lines().nth(1).unwrap().ends_with(",NaN,flight"), "{text}");
}

/// Statistics of the run and of the drawing come from the same rows by the same way.
#[test]
fn a_drawing_sees_the_hazard_of_the_run() {
    let dir = folder();
    let run = whole_run(dir.path(), info(RELEASES)).unwrap();
    let drawn = output::read(dir.path()).unwrap();
    assert_eq!(run.hazard, drawn.hazard);
    assert_eq!(run.summary, drawn.summary);
    let failed: Vec<usize> = (0..RELEASES).filter(|index| index % FAILS_EVERY == 3).collect();
    assert_eq!(drawn.summary.totals.failures["the step shrank below 1e-12 s"], failed);
    assert_eq!(drawn.summary.stops["failed"], failed.len());
    assert_eq!(drawn.summary.statistics["runout_m"].rocks, RELEASES - failed.len());
}

/// Interrupted behind every chunk, with rows torn by the crash, and continued with other chunks.
#[test]
fn a_resumed_run_writes_the_same_bytes() {
    let reference = folder();
    whole_run(reference.path(), info(RELEASES)).unwrap();
    for chunks in 1..=RELEASES.div_ceil(7) {
        let dir = folder();
        let output = Output::create(info(RELEASES), dir.path(), Mode::Fresh).unwrap();
        let cut = go_on(output, chunks, 7).unwrap();
        let done = cut.remaining().start;
        drop(cut);
        for name in TABLES {
            let mut file = OpenOptions::new().append(true).open(dir.path().join(name)).unwrap();
            file.write_all(b"61,at_rest,0.3333").unwrap();
        }
        let output = Output::create(info(RELEASES), dir.path(), Mode::Resume).unwrap();
        assert_eq!(output.remaining(), done..RELEASES);
        let results = go_on(output, RELEASES, 11).unwrap().finish().unwrap();
        assert_eq!(results.hazard, output::read(dir.path()).unwrap().hazard);
        assert_eq!(bytes(dir.path()), bytes(reference.path()), "interrupted after {chunks} chunks");
        assert!(!dir.path().join("progress.json").exists());
        let states = fs::read_dir(dir.path().join("maps")).unwrap().filter(|file| {
            file.as_ref().unwrap().path().extension().is_some_and(|kind| kind == "state")
        });
        assert_eq!(states.count(), 0);
        // a height where there is no ground is no number
        assert!(same(&results.lines, &output::read(dir.path()).unwrap().lines));
    }
}

#[test]
fn resuming_a_finished_run_changes_nothing() {
    let dir = folder();
    whole_run(dir.path(), info(RELEASES)).unwrap();
    let before = bytes(dir.path());
    let output = Output::create(info(RELEASES), dir.path(), Mode::Resume).unwrap();
    assert!(output.remaining().is_empty());
    output.finish().unwrap();
    assert_eq!(bytes(dir.path()), before);
}

#[test]
fn an_interrupted_run_says_how_to_go_on() {
    let dir = folder();
    let output = Output::create(info(RELEASES), dir.path(), Mode::Fresh).unwrap();
    let said = message(go_on(output, 2, 7).unwrap().finish());
    assert!(said.contains("14 of 60 releases are written; go on with --resume"), "{said}");
    let said = message(output::read(dir.path()));
    assert!(said.contains("not finished") && said.contains("--resume"), "{said}");
    let said = message(Output::create(info(RELEASES), dir.path(), Mode::Fresh));
    assert!(
        said.contains("14 of 60") && said.contains("--resume") && said.contains("--overwrite"),
        "{said}"
    );
}

#[test]
fn other_results_are_refused_and_left_alone() {
    let dir = folder();
    whole_run(dir.path(), info(RELEASES)).unwrap();
    let before = bytes(dir.path());
    let mut others = [info(RELEASES), info(RELEASES), info(RELEASES + 1)];
    others[0].identity.scene_hash = "07e4".to_owned();
    others[1].identity.seed = 1;
    let words = ["another scene", "seed 18446744073709551615, not 1", "releases 0..60, not 0..61"];
    for (other, word) in others.into_iter().zip(words) {
        for mode in [Mode::Fresh, Mode::Resume] {
            let said = message(Output::create(other.clone(), dir.path(), mode));
            assert!(said.contains(word) && said.contains("--overwrite"), "{said}");
        }
    }
    let mut newer = info(RELEASES);
    newer.identity.version = "0.2.0".to_owned();
    let said = message(Output::create(newer, dir.path(), Mode::Resume));
    assert!(said.contains("0.1.0") && said.contains("0.2.0"), "{said}");
    assert_eq!(bytes(dir.path()), before);
}

/// Overwriting leaves no file of the old run behind, and touches no file that is not a result.
#[test]
fn overwriting_replaces_all_results_and_nothing_else() {
    let dir = folder();
    whole_run(dir.path(), info(RELEASES)).unwrap();
    fs::create_dir(dir.path().join("figures")).unwrap();
    let own =
        ["notes.txt", "figures/notes.txt", "figures/mine.svg", "maps/terrain.asc", "maps/1a.state"];
    for name in ["figures/runout.svg", "report.html"].into_iter().chain(own) {
        fs::write(dir.path().join(name), "old").unwrap();
    }
    output::announce_figures(dir.path(), &["runout.svg"]).unwrap();
    let mut other = info(RELEASES);
    other.identity.scene_hash = "07e4".to_owned();
    other.keeps_paths = false;
    let output = Output::create(other, dir.path(), Mode::Overwrite).unwrap();
    let results = go_on(output, 1, RELEASES).unwrap().finish().unwrap();
    assert_eq!(results.paths().unwrap().count(), 0);
    for name in ["paths.csv", "figures/runout.svg", "report.html"] {
        assert!(!dir.path().join(name).exists(), "{name}");
    }
    for name in own {
        assert!(dir.path().join(name).exists(), "{name}");
    }
}

#[test]
fn the_same_run_is_repeated_into_its_folder_only_when_asked() {
    let dir = folder();
    whole_run(dir.path(), info(RELEASES)).unwrap();
    let before = bytes(dir.path());
    let said = message(whole_run(dir.path(), info(RELEASES)));
    assert!(said.contains("finished results of this very run") && said.contains("--overwrite"));
    assert_eq!(bytes(dir.path()), before);
}

/// A scene that fails before its first row may be mended and run again into the same folder.
#[test]
fn a_run_without_a_row_has_no_claim_on_the_folder() {
    let dir = folder();
    drop(Output::create(info(RELEASES), dir.path(), Mode::Fresh).unwrap());
    let mut mended = info(RELEASES);
    mended.identity.scene_hash = "07e4".to_owned();
    for mode in [Mode::Resume, Mode::Fresh] {
        let output = Output::create(mended.clone(), dir.path(), mode).unwrap();
        assert_eq!(output.remaining(), 0..RELEASES);
    }
}

#[test]
fn unknown_tables_are_not_overwritten() {
    for name in ["releases.csv", "figures/mine.svg", "maps/deposits.tif"] {
        let dir = folder();
        let file = dir.path().join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, "mine").unwrap();
        for mode in [Mode::Fresh, Mode::Resume] {
            let said = message(Output::create(info(RELEASES), dir.path(), mode));
            assert!(said.contains(&format!("holds {name}")), "{said}");
        }
        assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    }
}

/// A broken table names the file, the line, the column and what was found.
#[test]
fn a_broken_table_says_where() {
    let spoil = |change: fn(&str) -> String| {
        let dir = folder();
        whole_run(dir.path(), info(RELEASES)).unwrap();
        let path = dir.path().join("releases.csv");
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, change(&text)).unwrap();
        message(output::read(dir.path()))
    };
    let said = spoil(|text| text.replacen("1,at_rest,12.5", "1,at_rest,12.5m", 1));
    assert!(
        said.contains("releases.csv: line 3, time_s: ") && said.contains("invalid float"),
        "{said}"
    );
    let said = spoil(|text| text.replacen("at_rest", "asleep", 1));
    assert!(said.contains("line 3: unknown variant `asleep`"), "{said}");
    let said = spoil(|text| text.replacen("time_s", "time_h", 1));
    assert!(said.contains("line 1") && said.contains("time_h"), "{said}");
    let said = spoil(|text| text.replacen("2,at_rest,", "2,at_rest,0,", 1));
    assert!(said.contains("line 4: 40 values instead of 39"), "{said}");
    let said = spoil(|text| text.split_inclusive('\n').take(50).collect());
    assert!(said.contains("49 rows instead of 60"), "{said}");
    let said = spoil(|text| text.replacen("\n2,", "\n7,", 1));
    assert!(said.contains("release 7 where 2 should stand"), "{said}");
}

#[test]
fn a_shortened_table_cannot_be_resumed() {
    let dir = folder();
    let output = Output::create(info(RELEASES), dir.path(), Mode::Fresh).unwrap();
    drop(go_on(output, 2, 7).unwrap());
    fs::write(dir.path().join("impacts.csv"), "index\n").unwrap();
    let said = message(Output::create(info(RELEASES), dir.path(), Mode::Resume));
    assert!(said.contains("impacts.csv: length: 6 bytes where"), "{said}");
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error_of_the_user() {
    let dir = folder();
    let file = dir.path().join("file");
    fs::write(&file, "").unwrap();
    let said = message(Output::create(info(RELEASES), &file.join("out"), Mode::Fresh));
    assert!(said.contains("out: cannot create: "), "{said}");
}

/// Number of threads, chunk lengths and scratch reuse change no byte.
#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let releases = 500; // several chunks and several pieces a chunk for every thread count
    let run = |threads: usize| {
        let dir = folder();
        let mut output = Output::create(info(releases), dir.path(), Mode::Fresh).unwrap();
        let ensemble = Ensemble::new(Some(threads)).unwrap();
        assert_eq!(ensemble.threads(), threads);
        for falls in
            ensemble.in_chunks(output.remaining(), Vec::new, |index, scratch: &mut Vec<usize>| {
                scratch.push(index);
                Ok(fall(index))
            })
        {
            output.write(&falls.unwrap()).unwrap();
        }
        output.finish().unwrap();
        bytes(dir.path())
    };
    let one = run(1);
    assert_eq!(run(2), one);
    assert_eq!(run(7), one);
}

/// One release alone has the row that it has among all.
#[test]
fn a_single_release_has_the_same_row() {
    let dir = folder();
    let mut one = info(1);
    one.identity.first_release = 42;
    let output = Output::create(one, dir.path(), Mode::Fresh).unwrap();
    assert_eq!(output.remaining(), 42..43);
    let results = go_on(output, 1, 1).unwrap().finish().unwrap();
    let row = results.rows().unwrap().next().unwrap().unwrap();
    assert!(same(&row, &Row::of(&fall(42), info(1).origin_m)));
}

/// Rocks that failed count as far as they came, as those do whose time was up: what they had done is in the statistics, and
/// their runout is a bound. Theirs here is no number: it may lie anywhere from 0 on, and decides what it can decide.
#[test]
fn failed_rocks_count_as_far_as_they_came() {
    let mut hazard = Hazard::default();
    (0..RELEASES).for_each(|index| hazard.add(&Row::of(&fall(index), Vec3::zeros())));
    let counts = StopKind::ALL.map(|stop| hazard.ended(stop).count);
    assert_eq!(counts.iter().sum::<usize>(), RELEASES);
    assert_eq!(hazard.ended(StopKind::Failed).count, 4); // 3, 20, 37, 54
    assert_eq!(hazard.statistic(Quantity::MaxSpeed).rocks, RELEASES);
    let left = hazard.ended(StopKind::LeftTerrain).count;
    let runout = hazard.statistic(Quantity::Runout);
    assert_eq!((runout.rocks, runout.censored), (RELEASES - 4, left + 4));
    assert!(runout.mean.unwrap().censored && runout.percentiles["p99"].censored);
}
