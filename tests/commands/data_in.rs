//! From the engineer's own files to the same results: elevation models beside STL, drawings beside typed coordinates.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test fails by panicking")]

use crate::drawn;
use crate::program;
use crate::site;

use drawn::{column, rings, shapefile, zones};
use program::{rockfall, same_results};
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use site::{Folder, scene};
use std::fs;
use std::path::Path;

fn table(out: &Path) -> String {
    fs::read_to_string(out.join("releases.csv")).unwrap()
}

/// The same triangles give the same bytes, whatever file they come from.
#[test]
fn every_format_of_the_same_slope_gives_the_same_bytes() {
    let dir = Folder::new();
    dir.slope();
    let stl = table(&dir.run("stl", &scene("mesh = \"dem.stl\"", "")));
    assert_eq!(stl.lines().count(), 41);
    for format in ["tif", "asc", "obj", "ply", "stl"] {
        let found = table(
            &dir.run(&format!("of_{format}"), &scene(&format!("file = \"dem.{format}\""), "")),
        );
        assert!(found == stl, "{format}");
    }
}

/// Releases come from the zones in the share of their weights, lie in them, and know which one they are of.
#[test]
fn zones_share_the_releases_by_weight() {
    let dir = Folder::new();
    dir.slope();
    dir.put(
        "zones.geojson",
        zones(["\"weight\":1", "\"weight\":3,\"volume_m3\":12.5,\"frequency_per_year\":0.25"]),
    );
    let text = scene("file = \"dem.tif\"", "zones = \"zones.geojson\"|");
    let file = dir.put("scene.toml", &text);
    let scene = Scene::read(&file).unwrap();
    let list = scene.release.zone_list.as_ref().unwrap();
    let [first, second] = list.list() else { panic!("two zones") };
    assert_eq!(
        (first.weight, second.volume_m3, second.frequency_per_year),
        (Some(1.0), Some(12.5), Some(0.25))
    );
    assert!((list.share(0) - 0.25).abs() + (list.share(1) - 0.75).abs() < 1e-12);
    let (terrain, _) = scene.read_terrain().unwrap();
    let plan = Plan::compile(&scene, terrain).unwrap();
    let count = 4000;
    let mut seen = [0usize; 2];
    for index in 0..count {
        let zone = plan.releases.zone_of(index).unwrap();
        let at = plan.release(index).unwrap().motion.position_m + plan.terrain.origin_m;
        let x = if zone == 0 { 2_600_010.5 } else { 2_600_040.25 };
        assert!((x..=x + 8.0).contains(&at.x), "{index} of zone {zone} at {at}");
        seen[zone] += 1;
    }
    // within four standard deviations of the binomial
    let deviation = (count as f64 * 0.25 * 0.75).sqrt();
    assert!((seen[0] as f64 - 0.25 * count as f64).abs() < 4.0 * deviation, "{seen:?}");
}

/// What a run says of its zones can be named by a scene again, and gives the same releases; lines and barriers too.
#[test]
fn what_is_written_can_be_read_again() {
    let dir = Folder::new();
    dir.slope();
    dir.put("zones.geojson", zones(["\"name\":\"a\"", "\"name\":\"b\""]));
    let barrier = "[[lines]]\nname = \"road\"\npoints_m = [[2600002.0, 1200040.5], [2600060.0, 1200040.5]]\n\
                   [[barriers]]\nname = \"net\"\npoints_m = [[2600002.0, 1200050.125], [2600060.0, 1200050.5]]\nheight_m = 3.0\ncapacity_j = 1e5\n";
    let out = dir.run(
        "first",
        &scene("file = \"dem.tif\"", &format!("zones = \"zones.geojson\"|{barrier}")),
    );
    for name in ["zones.geojson", "scene_lines.geojson", "ground.tif"] {
        assert!(out.join("maps").join(name).exists(), "{name}");
    }
    let drawn = fs::read_to_string(out.join("maps/scene_lines.geojson")).unwrap();
    let net: String =
        drawn.replace("\"name\":\"road\"", "\"name\":\"road\",\"height_m\":3.0,\"capacity_j\":1e5");
    assert!(
        drawn.contains("2600060.0,1200050.5") && drawn.contains("\"capacity_j\":100000.0"),
        "{drawn}"
    );
    dir.put("nets.geojson", net);
    let again = scene(
        "file = \"dem.tif\"",
        "zones = \"first/maps/zones.geojson\"|[[barriers]]\nfile = \"nets.geojson\"\n",
    );
    let again = dir.run("again", &again);
    assert!(table(&again) == table(&out));
    assert_eq!(
        fs::read(again.join("maps/zones.geojson")).unwrap(),
        fs::read(out.join("maps/zones.geojson")).unwrap()
    );
    // the ground as used is an elevation model: the program reads it
    let plan = dir.plan(&scene("file = \"first/maps/ground.tif\"", ""));
    assert!(plan.contains("GeoTIFF") && plan.contains("EPSG:2056"), "{plan}");
}

/// A release file as Shapefile or as GeoJSON: the same bytes in every result.
#[test]
fn a_shapefile_and_a_geojson_of_the_same_zones_give_the_same_bytes() {
    let dir = Folder::new();
    dir.slope();
    let drawn = dir.put("zones.geojson", zones(["\"weight\":1.5", "\"weight\":3"]));
    let said = std::process::Command::new("ogr2ogr")
        .args(["-f", "ESRI Shapefile", "-a_srs", "EPSG:2056"])
        .args([dir.path("of_gdal.shp"), drawn])
        .output();
    let by_gdal = said.is_ok_and(|said| said.status.success());
    if !by_gdal {
        eprintln!("skipped GDAL's Shapefile: ogr2ogr is not there; the one written here is read");
    }
    dir.put("zones.shp", shapefile(&rings()));
    dir.put("zones.dbf", column("weight", &["1.5", "3"]));
    let run = |file: &str| {
        dir.run(
            &file.replace('.', "_"),
            &scene("file = \"dem.asc\"", &format!("zones = \"{file}\"|")),
        )
    };
    let geojson = table(&run("zones.geojson"));
    assert!(table(&run("zones.shp")) == geojson);
    if by_gdal {
        assert!(table(&run("of_gdal.shp")) == geojson);
    }
}

/// The plan names every file with its size, crop and holes; every byte of them counts in the scene's hash.
#[test]
fn the_plan_names_the_files_and_the_hash_knows_them() {
    let dir = Folder::new();
    dir.slope();
    dir.put("zones.geojson", zones(["", ""]));
    dir.put("grounds.geojson", zones(["\"class\":\"scree\"", "\"class\":\"scree\""]));
    let text = |cut: &str| {
        scene(
            "file = \"dem.tif\"\ncrop = { reach_angle_deg = 20.0, margin_m = 4.0 }\nresample_m = 4.0",
            &format!(
                "zones = \"zones.geojson\"|[[ground_zones]]\nfile = \"grounds.geojson\"\nground_from = \"class\"\n{cut}"
            ),
        )
    };
    let (whole, cut) = (dir.plan(&text("")), dir.plan(&text("cut = true")));
    let bytes = fs::metadata(dir.path("dem.tif")).unwrap().len();
    for part in [
        format!("dem.tif, {bytes} bytes"),
        "zones.geojson, ".to_owned(),
        "grounds.geojson, ".to_owned(),
        "31 x 41 cells of 2 m".to_owned(),
        "cropped to ".to_owned(),
        "coarsened to ".to_owned(),
        "0 cells without data, left as holes".to_owned(),
        "over 2 zones of ".to_owned(),
        "left whole, each with the ground at its centroid".to_owned(),
    ] {
        assert!(whole.contains(&part), "{part}\n{whole}");
    }
    assert!(cut.contains("are cut into ") && cut.contains("96.0 m² in plan view"), "{cut}");
    let hash = |scene: &str| Scene::read(&dir.put("hashed.toml", scene)).unwrap().hash;
    let before = hash(&text(""));
    dir.put("grounds.geojson", zones(["\"class\":\"rock\"", "\"class\":\"scree\""]));
    assert_ne!(hash(&text("")), before);
}

/// Every rock is on the ground of its triangle, drawn or not; a run with zones of ground is the same again and in parts.
#[test]
fn a_run_with_everything_drawn_is_the_same_in_parts() {
    let dir = Folder::new();
    let out = |name: &str| dir.path(name).to_str().unwrap().to_owned();
    let scene = "examples/tyrol_gis.toml";
    let run = |more: &[&str]| {
        let words = [&["run", scene, "--quiet", "--releases", "30"], more].concat();
        let said = rockfall(&words);
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    };
    run(&["--out", &out("whole")]);
    run(&["--shard", "1/2", "--out", &out("a")]);
    run(&["--shard", "2/2", "--threads", "1", "--out", &out("b")]);
    let said = rockfall(&["merge", &out("a"), &out("b"), "--out", &out("merged")]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    same_results(&dir.path("whole"), &dir.path("merged"));
}

/// What stands in place of a large file until Git LFS has fetched it is told as that, whatever it stands for.
#[test]
fn a_pointer_of_git_lfs_is_told_wherever_a_file_is_read() {
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
    let dir = Folder::new();
    dir.slope();
    let good = dir.put("good.geojson", zones(["\"class\":\"scree\"", "\"class\":\"rock\""]));
    dir.put("zones.shp", shapefile(&rings()));
    for name in ["lfs.tif", "lfs.asc", "lfs.laz", "lfs.stl", "lfs.shp", "lfs.geojson", "zones.dbf"]
    {
        dir.put(name, pointer);
    }
    assert!(good.exists());
    let dem = |more: &str| scene("file = \"dem.tif\"", more);
    let terrain = |table: &str| scene(table, "");
    for (text, name) in [
        (terrain("file = \"lfs.tif\""), "lfs.tif"),
        (terrain("file = \"lfs.asc\""), "lfs.asc"),
        (terrain("file = \"lfs.laz\""), "lfs.laz"),
        (terrain("file = \"lfs.stl\""), "lfs.stl"),
        (terrain("mesh = \"lfs.stl\""), "lfs.stl"),
        (dem("zones = \"lfs.geojson\"|"), "lfs.geojson"),
        (dem("zones = \"lfs.shp\"|"), "lfs.shp"),
        (dem("zones = \"zones.shp\"|"), "zones.dbf"),
        (dem("[[lines]]\nfile = \"lfs.geojson\"\n"), "lfs.geojson"),
        (dem("[[barriers]]\nfile = \"lfs.geojson\"\n"), "lfs.geojson"),
        (dem("[[ground_zones]]\nfile = \"lfs.shp\"\nground_from = \"class\"\n"), "lfs.shp"),
        (dem("[[trees]]\nfile = \"lfs.geojson\"\nground = \"scree\"\n"), "lfs.geojson"),
    ] {
        let said = dir.refusal(&text);
        let told =
            said.contains("found a pointer of Git LFS in the place of the file; fetch the file itself with `git lfs pull`");
        assert!(told && said.contains(name), "{name}: {said}");
    }
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let dir = Folder::new();
    dir.slope();
    dir.put("zones.geojson", zones(["\"weight\":1", ""]));
    dir.put("good.geojson", zones(["\"class\":\"scree\"", "\"class\":\"sand\""]));
    dir.put(
        "swiss.geojson",
        zones(["", ""]).replacen('{', "{\"crs\":{\"properties\":{\"name\":\"EPSG:21781\"}},", 1),
    );
    let line = "{\"type\":\"Feature\",\"properties\":{\"name\":\"road\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[8.54,47.3],[8.55,47.4]]}}";
    dir.put("degrees.geojson", line);
    let away = zones(["\"class\":\"scree\"", "\"class\":\"rock\""]).replace("[26000", "[6000");
    dir.put("away.geojson", away);
    dir.put("zones.csv", "WKT,name\n\"POINT (1 2)\",a\n");
    dir.put("points.xyz", "2600000.5 1200000.5 500.25\n2600001.5 1200000.5 501\n");
    dir.put("heights.bil", [0u8, 0, 250, 67].repeat(100));
    let head = |corner: &str, cell: &str| {
        format!("ncols 3\nnrows 3\n{corner}\ncellsize {cell}\nNODATA_value -9999\n")
    };
    dir.put("degrees.asc", head("xllcorner 8.5\nyllcorner 47.3", "0.0002") + &"500 ".repeat(9));
    dir.put(
        "void.asc",
        head("xllcorner 2600000\nyllcorner 1200000", "2") + &"-9999 ".repeat(8) + "5",
    );
    let table = |table: &str| scene("file = \"dem.tif\"", &format!("\n{table}"));
    for (text, parts) in [
        (
            scene("file = \"dem.tif\"", "").replace("epsg = 2056", "epsg = 21781"),
            ["found EPSG:2056 where the scene has EPSG:21781", "gdalwarp"],
        ),
        (
            scene("file = \"dem.tif\"\nmesh = \"dem.stl\"", ""),
            ["[[terrain]] #1 file", "remove it, or remove mesh"],
        ),
        (scene("", ""), ["[[terrain]] #1 mesh", "write mesh = \"slope.stl\", or file"]),
        (scene("mesh = \"dem.stl\"\nresample_m = 4.0", ""), ["resample_m", "write file = …"]),
        (
            scene("file = \"dem.stl\"\nresample_m = 4.0", ""),
            ["crop, resample_m", "a mesh is taken as it is"],
        ),
        (
            scene("file = \"dem.tif\"\nresample_m = 1.0", ""),
            ["finer than its cells of 2 m", "write 2 or more"],
        ),
        (scene("file = \"dem.tif\"\nup = \"y\"", ""), ["up, scale", "remove up and scale"]),
        (
            scene("file = \"dem.tif\"\ncrop = { box_m = [0.0, 0.0, 10.0, 10.0] }", ""),
            ["found no cells of the file there", "2600000.5..2600062.5 east"],
        ),
        (
            scene("file = \"dem.tif\"\ncrop = { reach_angle_deg = 30.0 }", ""),
            ["margin_m", "write what is kept"],
        ),
        (scene("file = \"none.tif\"", ""), ["[[terrain]] #1 file", "none.tif: No such file"]),
        (
            scene("file = \"dem.tif\"", "zones = \"none.geojson\"|"),
            ["[release] zones", "none.geojson is not there"],
        ),
        (
            scene("file = \"dem.tif\"", "zones = \"zones.geojson\"|"),
            ["feature 2: found no weight", "for all zones or for none"],
        ),
        (
            scene("file = \"dem.tif\"", "zones = \"swiss.geojson\"|"),
            ["found EPSG:21781 where the scene has EPSG:2056", "ogr2ogr -t_srs EPSG:2056"],
        ),
        // the scene names no system, the terrain does
        (
            scene("file = \"dem.tif\"", "zones = \"swiss.geojson\"|").replace("epsg = 2056", ""),
            [
                "found EPSG:21781 where the terrain has EPSG:2056",
                "ogr2ogr -t_srs EPSG:2056 swiss_map.geojson",
            ],
        ),
        // longitude and latitude, as GeoJSON has them that names no system
        (
            table("[[lines]]\nfile = \"degrees.geojson\"\n"),
            [
                "8.54000..8.55000 east, 47.30000..47.40000 north, like longitude and latitude",
                "ogr2ogr -s_srs EPSG:4326 -t_srs EPSG:2056 degrees_map.geojson",
            ],
        ),
        (
            table("[[ground_zones]]\nfile = \"away.geojson\"\nground_from = \"class\"\n"),
            ["found nothing of it on the terrain: it lies at 6", "the terrain at 2600001.5.."],
        ),
        (
            scene("file = \"dem.tif\"", "zones = \"zones.csv\"|"),
            ["found neither GeoJSON nor a Shapefile", "ogr2ogr zones.geojson"],
        ),
        (
            scene("file = \"points.xyz\"", ""),
            ["found a list of points", "gdal_translate -of GTiff"],
        ),
        (
            scene("file = \"heights.bil\"", ""),
            ["found none of the formats that are read", "gdal_translate -of GTiff"],
        ),
        (
            scene("file = \"degrees.asc\"", ""),
            [
                "cellsize: found 0.0002 at (8.5, 47.3), like longitude and latitude",
                "gdalwarp -s_srs EPSG:4326 -t_srs EPSG:2056",
            ],
        ),
        (
            scene("file = \"void.asc\"", ""),
            ["found data in 1 of 9 cells, and no triangle", "leave the file out"],
        ),
        (
            table("[[lines]]\nfile = \"good.geojson\"\n"),
            ["feature 1: found polygons", "write lines"],
        ),
        (
            table("[[barriers]]\nfile = \"good.geojson\"\npoints_m = [[0.0, 0.0], [1.0, 1.0]]\n"),
            ["[[barriers]] #1 points_m", "remove it"],
        ),
        (
            table("[[ground_zones]]\nfile = \"good.geojson\"\nground_from = \"class\"\n"),
            ["feature 2: found the ground sand", "known here: rock, scree"],
        ),
        (
            table("[[ground_zones]]\nfile = \"good.geojson\"\nground_from = \"kind\"\n"),
            ["feature 1: found no property kind", "write the name of a ground"],
        ),
        (
            table("[[ground_zones]]\nfile = \"good.geojson\"\n"),
            ["[[ground_zones]] #1 ground_from", "write ground_from"],
        ),
    ] {
        let said = dir.refusal(&text);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}\n{said}");
    }
}

/// Corners of a line of release over a hole: places without ground are drawn again, and all rocks start beside it.
#[test]
fn a_line_of_release_may_cross_a_hole() {
    let dir = Folder::new();
    let height = |row: i32, column: i32| {
        let is_hole = (40..60).contains(&column) && row < 30;
        if is_hole { "-9999".to_owned() } else { format!("{}", 700.0 - 0.8 * f64::from(row)) }
    };
    let rows = (0..100).map(|row| (0..100).map(|k| height(row, k)).collect::<Vec<_>>().join(" "));
    let head = "ncols 100\nnrows 100\nxllcorner 2600000\nyllcorner 1200000\ncellsize 1\nNODATA_value -9999\n";
    dir.put("hole.asc", head.to_owned() + &rows.collect::<Vec<_>>().join("\n"));
    // both ends of the line lie over the hole
    let text = scene("file = \"hole.asc\"", "").replace(
        "[[2600010.5, 1200090.25], [2600050.5, 1200090.25]]",
        "[[2600050.5, 1200085.0], [2600020.5, 1200085.0], [2600050.6, 1200085.0]]",
    );
    let rows = table(&dir.run("hole", &text));
    let at = rows.lines().next().unwrap().split(',').position(|name| name == "start_x_m").unwrap();
    let start = |row: &str| row.split(',').nth(at).unwrap().parse::<f64>().unwrap();
    let starts: Vec<f64> = rows.lines().skip(1).map(start).collect();
    assert_eq!(starts.len(), 40);
    assert!(starts.iter().all(|x| (2_600_020.0..2_600_041.0).contains(x)), "{starts:?}");
}
