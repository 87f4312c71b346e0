//! The scene that a calibration writes stands anywhere, and only it is called calibrated.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::drawn::zones;
use crate::program::rockfall;
use crate::site::{Folder, scene};
use rockfall::scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};

const LINE: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"ROW"},
"geometry":{"type":"LineString","coordinates":[[2600005.5,1200050.25],[2600055.5,1200050.25]]}}]}"#;

/// A slope of a GeoTIFF with everything else drawn in files beside it, and ends measured close to the zones.
fn site(dir: &Folder) -> PathBuf {
    dir.slope();
    dir.put("zones.geojson", zones(["\"weight\":1", "\"weight\":3"]));
    dir.put("grounds.geojson", zones(["\"class\":\"rock\"", "\"class\":\"scree\""]));
    dir.put("road.geojson", LINE);
    dir.put("net.geojson", LINE.replace("1200050.25", "1200040.25"));
    let row = |k: u32| format!("2600014.5,1200083.25,2600014.5,{}\n", 1_200_080 - k);
    let rows: String = (0..12).map(row).collect();
    dir.put("ends.csv", format!("release_x_m,release_y_m,x_m,y_m\n{rows}"));
    let more = "zones = \"zones.geojson\"|[[lines]]\nfile = \"road.geojson\"\nname = \"road\"\n\
        [[barriers]]\nfile = \"net.geojson\"\nname = \"net\"\nheight_m = 3.0\ncapacity_j = 1e6\n\
        [[ground_zones]]\nfile = \"grounds.geojson\"\nground_from = \"class\"\n\
        [calibrate]\ndeposits = \"ends.csv\" # walked\nheld_out = 0.0\n\
        vary = [{ ground = \"rock\", key = \"rolling_friction\", from = 0.4, to = 0.9, before = 0.4 }]\n";
    dir.put("gis.toml", scene("file = \"dem.tif\"", more))
}

fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn page(scene: &Path, out: &Path) -> String {
    let args = ["run", word(scene), "--quiet", "--overwrite", "--out", word(out)];
    let done = rockfall(&args);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    fs::read_to_string(out.join("report.html")).unwrap()
}

/// Every file is named in full, whatever key names it; measured ends beside values that nobody fitted to them do not make
/// these calibrated, and a distance above its limit is said before everything else.
#[test]
fn the_fitted_scene_stands_anywhere_and_only_it_is_calibrated() {
    let dir = Folder::new();
    let scene = site(&dir);
    let before = page(&scene, &dir.path("before"));
    assert!(before.contains("are not fitted") && !before.contains("calibrated on measured ends"));
    let first = before.split("Read this first").nth(1).unwrap().split("<li>").nth(1).unwrap();
    assert!(first.starts_with("The computed ends are not distributed like"), "{first}");

    let out = dir.path("fit");
    let args = ["calibrate", word(&scene), "--releases", "20", "--out", word(&out)];
    let done = rockfall(&args);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let fitted = out.join("gis_fitted.toml");
    let plan = rockfall(&["plan", word(&fitted)]);
    assert!(plan.status.success(), "{}", String::from_utf8_lossy(&plan.stderr));
    let text = fs::read_to_string(&fitted).unwrap();
    for file in ["dem.tif", "zones.geojson", "road.geojson", "net.geojson", "grounds.geojson"] {
        assert!(text.contains(word(&dir.0.path().canonicalize().unwrap().join(file))), "{text}");
    }
    assert!(text.contains("# walked") && Scene::read(&fitted).unwrap().is_fitted(), "{text}");
    assert!(page(&fitted, &dir.path("after")).contains("calibrated on measured ends"));

    // a note in the file does not make a value fitted that was changed after it
    let line = text.lines().find(|line| line.starts_with("rolling_friction")).unwrap();
    let changed = out.join("changed.toml");
    fs::write(&changed, text.replacen(line, "rolling_friction = 0.123", 1)).unwrap();
    assert!(!Scene::read(&changed).unwrap().is_fitted());
    // and what is fitted anew is noted anew
    let again = ["calibrate", word(&changed), "--releases", "20", "--out", word(&out)];
    assert!(rockfall(&again).status.success());
    assert!(Scene::read(&out.join("changed_fitted.toml")).unwrap().is_fitted());
}

/// A fitted scene that cannot be written, here as a folder has its name, costs none of the trials.
#[test]
fn trials_are_kept_whatever_becomes_of_the_fitted_scene() {
    let dir = Folder::new();
    let scene = site(&dir);
    let out = dir.path("fit");
    fs::create_dir_all(out.join("gis_fitted.toml")).unwrap();
    let done = rockfall(&["calibrate", word(&scene), "--releases", "20", "--out", word(&out)]);
    assert_eq!(done.status.code(), Some(2));
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(said.contains("gis_fitted.toml"), "{said}");
    for kept in ["calibration.csv", "calibration.json"] {
        assert!(out.join(kept).is_file(), "{kept}");
    }
}

/// A fit may be run again; what somebody has made of an earlier fitted scene stays, and twice.
#[test]
fn an_earlier_fitted_scene_is_kept() {
    let dir = Folder::new();
    let scene = site(&dir);
    let out = dir.path("fit");
    let fit = || -> String {
        let done = rockfall(&["calibrate", word(&scene), "--releases", "20", "--out", word(&out)]);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        String::from_utf8(done.stdout).unwrap()
    };
    assert!(!fit().contains("previous"));
    // the same again: nothing would be lost
    assert!(!fit().contains("previous"));
    let fitted = out.join("gis_fitted.toml");
    let text = fs::read_to_string(&fitted).unwrap();
    for (mine, kept) in [("# mine\n", "previous"), ("# mine too\n", "previous_2")] {
        fs::write(&fitted, format!("{mine}{text}")).unwrap();
        let name = format!("gis_fitted.{kept}.toml");
        let said = fit();
        assert!(said.contains("is kept as") && said.contains(&name), "{said}");
        assert_eq!(fs::read_to_string(out.join(name)).unwrap(), format!("{mine}{text}"));
        assert_eq!(fs::read_to_string(&fitted).unwrap(), text);
    }
}

/// Measured ends in another form are refused with what to do about it.
#[test]
fn ends_in_another_form_are_refused() {
    let dir = Folder::new();
    let scene = site(&dir);
    let ends = fs::read_to_string(dir.path("ends.csv")).unwrap();
    let semicolons = ends.replace(',', ";").into_bytes();
    let latin = [ends.as_bytes(), b"1,2,3,H\xfctte\n"].concat();
    for (bytes, says) in
        [(semicolons, "put commas between its columns"), (latin, "save it in UTF-8")]
    {
        dir.put("ends.csv", bytes);
        let out = dir.path("f");
        let said = rockfall(&["calibrate", word(&scene), "--releases", "20", "--out", word(&out)]);
        let message = String::from_utf8_lossy(&said.stderr);
        assert!(said.status.code() == Some(2) && message.contains(says), "{message}");
    }
}
