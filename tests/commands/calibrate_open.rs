//! Where computed rocks would have ended that left the terrain or were still moving is not known: a fit and its page hold however that was, or
//! say that it cannot be told.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use super::calibrate::{thrown, word};
use super::calibrate_selection::ways;
use crate::program;

use program::rockfall;
use rockfall::calibrate::Calibration;
use rockfall::hazard::ObservedPath;
use rockfall::output::read_calibration;
use rockfall::rock::Vec3;
use rockfall::terrain::stl::write_ascii;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The rolling friction that the measured ends were made with.
const TRUE: f64 = 0.45;
/// Speeds of release (m/s): rocks roll 4 to 13 m in 1.6 to 2.9 s.
const SPEED: [f64; 2] = [5.0, 9.0];

/// What keeps rocks from coming to rest.
#[derive(Debug, Clone, Copy)]
enum Cut {
    /// The longest time (s).
    Time(f64),
    /// The border across their way, so far from the release (m).
    Ahead(f64),
    /// The border along their way, so far to the side of one of the two places of release (m).
    Sideways(f64),
}

/// The scene cut short; its measured ends are those of the whole one.
fn cut_short(dir: &Path, cut: Cut, measured: usize, calibrate: &str) -> PathBuf {
    let whole = thrown(dir, "open", SPEED, "");
    let mut table = "release_x_m,release_y_m,x_m,y_m\n".to_owned();
    for ObservedPath { start_m, end_m, .. } in ways(&whole, 21, measured) {
        writeln!(table, "{},{},{},{}", start_m[0], start_m[1], end_m[0], end_m[1]).unwrap();
    }
    fs::write(dir.join("ends.csv"), table).unwrap();
    let (mut east, mut north, mut solver) = (40.0, 40.0, String::new());
    match cut {
        Cut::Time(longest_s) => solver = format!("[solver]\nlongest_s = {longest_s:?}\n"),
        Cut::Ahead(far_m) => east = far_m - 30.0,
        Cut::Sideways(far_m) => north = 2.0 + far_m,
    }
    let more = format!("{solver}[calibrate]\ndeposits = \"ends.csv\"\n{calibrate}");
    let scene = thrown(dir, "open", SPEED, &more);
    let p = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let corners = [p(-40.0, -40.0), p(east, -40.0), p(east, north), p(-40.0, north)];
    let facets = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    write_ascii(&dir.join("plate.stl"), "plate", &facets).unwrap();
    scene
}

/// The fit of a scene cut short to so many measured ends, by so many releases a trial, or what is said where it is refused.
fn fit(
    cut: Cut,
    score: &str,
    (measured, releases): (usize, &str),
) -> Result<(Calibration, String), String> {
    let dir = tempfile::tempdir().unwrap();
    let vary =
        "{ ground = \"meadow\", key = \"rolling_friction\", from = 0.2, to = 0.8, before = 0.3 }";
    let calibrate = format!("held_out = 0.0\nscore = \"{score}\"\nvary = [{vary}]");
    let scene = cut_short(dir.path(), cut, measured, &calibrate);
    let out = dir.path().join("fit");
    let done = rockfall(&["calibrate", word(&scene), "--releases", releases, "--out", word(&out)]);
    if done.status.code() == Some(2) {
        return Err(String::from_utf8(done.stderr).unwrap());
    }
    let found = read_calibration(&out).unwrap().unwrap();
    Ok((found, String::from_utf8(done.stdout).unwrap()))
}

/// Of measured ends by the same model the interval holds the true value, whatever kept how many computed rocks from their ends, or the fit is refused.
#[test]
fn a_fit_holds_the_truth_or_is_refused_where_rocks_had_not_ended() {
    let few = [Cut::Time(2.7), Cut::Ahead(12.0), Cut::Sideways(0.6)];
    let some = [Cut::Time(2.5), Cut::Time(2.3), Cut::Ahead(10.5), Cut::Sideways(0.05)];
    let many = [Cut::Time(1.6), Cut::Time(1.2), Cut::Ahead(5.0)];
    // taken as if they had ended there, rocks cut off after 1.2 s gave 0.33 to 0.44
    for (score, of_many) in [("runout", (300, "200")), ("ends", (60, "40"))] {
        for cut in few {
            let (found, said) = fit(cut, score, (60, "40")).unwrap();
            let told = &found.told[0];
            assert!(told.is_told && told.low_95.is_some() && told.high_95.is_some(), "{said}");
            holds_the_truth(&found, &said);
        }
        for cut in some {
            if let Ok((found, said)) = fit(cut, score, (60, "40")) {
                holds_the_truth(&found, &said);
            }
        }
        for cut in many {
            let said = fit(cut, score, of_many).unwrap_err();
            let remedy = match cut {
                Cut::Time(_) => "write a longer longest_s, or a range (from, to) in vary",
                _ => "write a larger terrain, or a range (from, to) in vary",
            };
            assert!(said.contains(" computed rocks (") && said.contains(remedy), "{cut:?}: {said}");
        }
    }
}

/// The interval holds the true value, and the fit says how many of its rocks had not ended.
fn holds_the_truth(found: &Calibration, said: &str) {
    let told = &found.told[0];
    assert!(told.low_95.is_none_or(|low| low <= TRUE), "{said}");
    assert!(told.high_95.is_none_or(|high| TRUE <= high), "{said}");
    let whole = &found.whole.all;
    let counted = format!("{} of {} computed rocks (", whole.open(), whole.computed);
    let is_warned = found.warnings.iter().any(|warning| warning.contains(&counted));
    assert!(is_warned == (whole.open() > 0) && said.contains(&counted) == is_warned, "{said}");
}

/// Of measured ends by the same model the page never says that its ground values do not hold: where too many rocks had not ended it says that this cannot be told,
/// how many they are, and what is only a lower bound.
#[test]
fn a_page_does_not_judge_ground_values_by_rocks_that_had_not_ended() {
    for (cut, is_untold) in
        [(Cut::Time(1.2), true), (Cut::Ahead(5.0), true), (Cut::Time(60.0), false)]
    {
        let dir = tempfile::tempdir().unwrap();
        let scene = cut_short(dir.path(), cut, 60, "");
        let out = dir.path().join("out");
        let done = rockfall(&["run", word(&scene), "--quiet", "--out", word(&out)]);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(!page.contains("do not hold for this slope"), "{cut:?}");
        for said in ["distributed like the measured ones cannot be told", " had not ended: "] {
            assert_eq!(page.contains(said), is_untold, "{cut:?}: {said}");
        }
        let table = &page[page.find("Agreement with measured ends").unwrap()..];
        let row = &table[..table.find("</tr></tbody>").or(table.find("</table>")).unwrap()];
        assert_eq!(row.contains('≥'), is_untold, "{cut:?}: {row}");
    }
}
