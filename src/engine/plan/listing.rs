//! The plan in words: one line for everything that is computed and everything that is left out.

use super::inputs::short;
use super::{EvaluationLine, Part, Paths, Plan, RestRule, annual, settings};
use crate::count::counted;
use crate::ground::Ground;
use crate::release::{ReleasePlace, Releases};
use crate::scene::{BarrierTable, InputFile, ObjectTable, Zone, ZonePlace, Zones};
use crate::solver::dda::own_restitution;
use crate::solver::{Scheme, Settings};
use crate::terrain::Terrain;
use crate::terrain::features::FeatureCount;
use crate::terrain::patches::Patched;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;
use std::fmt;

/// Columns before the text of a line; a longer label is followed by one blank.
const LABEL: usize = 19;

impl Plan {
    /// The listing, line by line; `rockfall plan` prints it and every report ends with it.
    pub fn lines(&self) -> Vec<String> {
        self.entries_for(self.count).iter().map(ToString::to_string).collect()
    }

    /// The listing for another number of releases than the scene's: a target precision asks for more.
    pub fn entries_for(&self, releases: usize) -> Vec<PlanEntry> {
        let count = releases;
        // Every field by name and no `..`: a part that is not listed does not compile.
        let Self {
            title,
            scene_file,
            scene_hash,
            version,
            mesh_origin_m: _, // the terrain's own says more
            epsg,
            seed,
            count: _, // as asked for
            releases: places_of_release,
            radii_m: [smallest_m, median_m, largest_m],
            table_sizes,
            lifted,
            terrain,
            mesh_health: _, // printed above the listing
            input_files,
            ground_zones,
            ground_names,
            gravity_m_s2,
            step,
            capture_m_s,
            own_dissipation: _, // with the step
            rest: RestRule { speed_m_s, time_s },
            longest_s,
            trees,
            breaking,
            flight,
            orientation,
            rolling,
            roughness,
            soil,
            rock_against_rock,
            coupled_solve,
            bonds,
            paths,
            impacts,
            lines,
            barriers,
            objects,
            year,
            maps,
            profile,
            catalogued,
            rolling_stops,
            tangential,
            measured,
            inputs: _,      // with the report
            title_block: _, // with the report
            sources: _,     // with the report
            language: _,    // with the report
            warnings: _,    // as for so many releases
            fast_warnings,
        } = self;
        let place = places(places_of_release);
        let mut list = PlanList::default();
        list.line("scene", title);
        list.line("file", format!("{}, {}", scene_file.display(), fingerprint(scene_hash)));
        list.line("version", format!("rockfall {version}"));
        list.line("releases", format!("{count} {place}, seed {seed}"));
        list.line(
            "radius",
            format!("{smallest_m:.3} m smallest, {median_m:.3} m median, {largest_m:.3} m largest"),
        );
        list.lines("sizes of table", table_sizes.iter().cloned());
        list.lines("lifted", lifted.iter().cloned());
        list.line(
            "terrain",
            format!("{} triangles in {}", terrain.triangles.len(), files(terrain)),
        );
        list.lines("input file", input_files.iter().map(input_file));
        list.part("ground zones", ground_zones, zones_of_ground);
        list.line("map", map(terrain.origin_m.into(), *epsg));
        list.line("gravity", format!("{gravity_m_s2} m/s²"));
        list.line("grounds", format!("{}: {}", ground_names.len(), ground_names.join(", ")));
        list.lines("catalogue", catalogued.iter().cloned());
        list.line("scheme", settings::scheme(step));
        let captures = ground_names.iter().zip(capture_m_s);
        for (name, speed) in captures {
            let whose =
                if step.capture_speed_m_s.is_some() { "given" } else { "for the median rock" };
            list.line(
                "capture speed",
                format!("{speed:.4} m/s on {name}, {whose}: slower impacts do not rebound"),
            );
        }
        list.lines("tangential answer", tangential.iter().cloned());
        list.line("impacts on one plane", settings::plane_impacts(step));
        list.lines("own dissipation", self.dissipation());
        list.line("stop rule", format!("at rest after {time_s} s below {speed_m_s} m/s in contact; time up after {longest_s} s; over budget after {} steps and flights", step.scheme.most_work()));
        list.part("trees", trees, |triangles| format!("{triangles} triangles"));
        list.part("breaking stems", breaking, |stems| {
            format!("{stems}, each whole again for the next rock")
        });
        list.line("flight", format!("leapt over: {}", never(flight)));
        list.shapes((places_of_release.shapes(), rolling.is_kept()), orientation, step);
        list.touchable(&terrain.features.count);
        list.part("rolling friction", rolling, |()| "computed".to_owned());
        list.lines("rolling stops", rolling_stops.iter().cloned());
        list.part("roughness", roughness, |()| {
            "one facet for every roughness length of the way, leaping, sliding or rolling"
                .to_owned()
        });
        list.part("soil", soil, |lines| lines.join("; "));
        list.part("rock against rock", rock_against_rock, |ground| one_world(step.scheme, ground));
        list.part("coupled solve", coupled_solve, |()| {
            let how = settings::islands(step, bonds.is_kept());
            format!("islands of rocks that may touch, each with its own step{how}")
        });
        list.part("bonds", bonds, |strength| {
            format!(
                "between rocks that touch at the start: tensile strength {:e} Pa, cohesion {:e} Pa",
                strength.tensile_pa, strength.cohesion_pa
            )
        });
        list.part("paths", paths, |Paths { first, step_s }| {
            let releases = counted(count, "release", "releases");
            format!("kept for {} of {count} {releases}, every {step_s} s", first.min(&count))
        });
        list.part("impacts", impacts, |()| "kept".to_owned());
        list.part("lines", lines, |lines| {
            let each = |line: &EvaluationLine| format!("{} ({:.1} m)", line.name, line.length_m());
            let each: Vec<String> = lines.iter().map(each).collect();
            format!("{}: {}; crossings exact between stored points", lines.len(), each.join(", "))
        });
        list.part("barriers", barriers, |all| {
            let each = |b: &BarrierTable| {
                format!("{} ({} m, {} kJ)", b.name, b.height_m, short(b.capacity_j / 1e3))
            };
            let each: Vec<String> = all.iter().map(each).collect();
            format!("{}: judged on the rocks that cross, they change no way", each.join(", "))
        });
        list.part("objects", objects, |all| {
            let each =
                |object: &ObjectTable| format!("{} ({})", object.name, annual::words(object));
            let each: Vec<String> = all.iter().map(each).collect();
            format!("{}: hit when the rim of a rock comes over them", each.join("; "))
        });
        match year {
            Part::Kept(year) => list.lines("frequency", annual::lines(year, count).into_iter()),
            Part::LeftOut(why) => list.line("frequency", format!("left out: {why}")),
        }
        list.part("maps", maps, |cells| {
            format!("{} x {} cells of {} m", cells.columns, cells.rows, cells.cell_m)
        });
        list.part("profile", profile, |step_m| {
            format!("speed and height every {step_m} m from the release, over all rocks")
        });
        let cost = self.cost(count);
        let asks = if cost.is_modest() { "" } else { "; runs with --yes only" };
        list.line("at most", format!("{cost}{asks}"));
        if let Some(measured) = measured {
            list.line("compared with", measured.to_string());
        }
        list.lines("warning", self.warnings_for(count).into_iter());
        list.lines("warning", fast_warnings.iter().map(|warning| warning.text.clone()));
        list.0
    }

    /// What the fixed step does to an impact by itself, ground by ground.
    fn dissipation(&self) -> impl Iterator<Item = String> {
        self.own_dissipation.iter().map(|own| {
            let kept = own.phases.map(|(radius_m, phase)| {
                format!("{:.4} (R = {radius_m:.3} m)", own_restitution(phase))
            });
            let force = if own.is_in_force {
                "restitution in force"
            } else {
                "beside the ground's own restitution"
            };
            format!(
                "{}: the scheme itself keeps {} of the speed; {force}",
                own.ground,
                kept.join(", ")
            )
        })
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines().iter().try_for_each(|line| writeln!(to, "{line}"))
    }
}

/// One line of the listing: a part of the plan and its text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanEntry {
    /// The part.
    pub name: String,
    /// What is computed, or what is left out and why.
    pub said: String,
}

impl fmt::Display for PlanEntry {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{:<1$} {2}", self.name, LABEL - 1, self.said)
    }
}

/// The listing as it grows.
#[derive(Default)]
struct PlanList(Vec<PlanEntry>);

impl PlanList {
    fn line(&mut self, label: &str, text: impl fmt::Display) {
        self.0.push(PlanEntry { name: label.to_owned(), said: text.to_string() });
    }

    fn lines(&mut self, label: &str, texts: impl Iterator<Item = String>) {
        texts.for_each(|text| self.line(label, text));
    }

    /// What shapes there are, and what they cost.
    fn shapes(
        &mut self,
        (shapes, rolls): (&[String], bool),
        orientation: &Part<Infallible>,
        step: &Settings,
    ) {
        if shapes.is_empty() {
            self.line("orientation", format!("left out: {}", never(orientation)));
            return;
        }
        self.lines("shape", shapes.iter().cloned());
        self.line("orientation", "computed for blocks, free rotation in closed form; left out for spheres, which look the same from every side");
        self.line("impacts of blocks", if step.scheme.has_springs() {
            "contact by contact, each with springs of its own: its restitution is that of the ground for the mass that it moves"
        } else {
            "contact by contact, as springs have it in the limit of great stiffness: restitution along the normal for the mass that a contact moves, and along the surface by the ratio of shear to normal stiffness; how stiff they are plays no part"
        });
        if let Some(text) = settings::block_impacts(step, rolls) {
            self.line("explicit stages", text);
        }
        self.line(
            "steps of blocks",
            format!("no corner goes further than {} of its rounding in one", step.corner_way),
        );
        self.line(
            "cost of shape",
            "a block is followed corner by corner and edge by edge: time grows with their number",
        );
    }

    /// What of the mesh can never be touched.
    fn touchable(&mut self, count: &FeatureCount) {
        let FeatureCount { edges, flat_edges, corners, flat_corners, saddles } = *count;
        self.line(
            "flat edges",
            format!("{flat_edges} of {} left out: the faces beside them touch", edges + flat_edges),
        );
        self.line(
            "hollow edges",
            "all kept, however sharp: a rock so deep in a fold that it reaches the edge presses on both sides as one contact",
        );
        self.line(
            "corners",
            format!(
                "{} of {} left out: {saddles} between edges that rise and edges that fall, {flat_corners} in flat ground; an edge or a face is always nearer",
                saddles + flat_corners,
                corners + saddles + flat_corners
            ),
        );
    }

    fn part<T>(&mut self, label: &str, part: &Part<T>, kept: impl Fn(&T) -> String) {
        match part {
            Part::Kept(what) => self.line(label, kept(what)),
            Part::LeftOut(why) => self.line(label, format!("left out: {why}")),
        }
    }
}

/// Why something is left out that no plan keeps.
fn never(part: &Part<Infallible>) -> &'static str {
    match part {
        Part::Kept(never) => match *never {},
        Part::LeftOut(why) => why,
    }
}

fn places(releases: &Releases) -> String {
    let words = |one: &ReleasePlace| place(one, releases.zones_are_sources());
    releases.places().iter().map(words).collect::<Vec<_>>().join(", ")
}

fn place(place: &ReleasePlace, zones_are_sources: bool) -> String {
    match place {
        ReleasePlace::Points(points) => match points.len() {
            1 => "from one point".to_owned(),
            points => format!("from {points} points in turn"),
        },
        ReleasePlace::Line(line) => format!("along a line of {:.1} m", line.length_m()),
        ReleasePlace::Area(area) => format!("over an area of {:.1} m²", area.area_m2()),
        ReleasePlace::Zones(zones) => {
            let file = zones.file.display();
            let how = if zones_are_sources { "each a source of its own" } else { shared_by(zones) };
            format!("over {} of {file}, {how}", zones.counted())
        }
    }
}

/// Files of the terrain; one with several grounds has several sheets.
fn files(terrain: &Terrain) -> String {
    let mut paths: Vec<_> =
        terrain.sheets.iter().map(|sheet| (&sheet.path, sheet.is_tree)).collect();
    paths.sort();
    paths.dedup();
    format!("{} {}", paths.len(), counted(paths.len(), "file", "files"))
}

fn input_file(InputFile { path, bytes, assumed }: &InputFile) -> String {
    let system = match assumed.as_deref() {
        None => String::new(),
        Some("") => "; names no system of coordinates: taken as the scene's".to_owned(),
        Some(name) => format!("; its system “{name}” has no EPSG code: taken as the scene's"),
    };
    format!("{}, {bytes} bytes{system}", path.display())
}

/// What zones of ground have done; both answers are counted, cutting triangles and leaving them whole.
fn zones_of_ground(done: &Patched) -> String {
    let Patched { zones, laid_m2, crossed, pieces, other_side_m2, is_cut } = done;
    let cut = if *is_cut {
        format!("cut into {pieces}, which gives {other_side_m2:.1} m² their own ground")
    } else {
        format!(
            "left whole, each with the ground at its centroid; so {other_side_m2:.1} m² have the ground of the other side; cut = true would mend that with {pieces} triangles"
        )
    };
    format!(
        "{zones}, {laid_m2:.1} m² in plan view; {crossed} triangles crossed by a border are {cut}"
    )
}

/// By what zones share the releases.
fn shared_by(zones: &Zones) -> &'static str {
    match zones.list().first() {
        Some(Zone { weight: Some(_), .. }) => "shared by their weights",
        _ if zones.has_kinds() => "shared by their frequencies",
        Some(Zone { place: ZonePlace::Points(_), .. }) => "shared by their numbers of points",
        Some(Zone { place: ZonePlace::Lines(_), .. }) => "shared by their lengths",
        _ => "shared by their areas",
    }
}

/// Enough of the hash to tell two scenes apart by eye.
fn fingerprint(hash: &str) -> String {
    format!("sha256 {}", hash.get(..16).unwrap_or("not taken"))
}

/// How rocks answer each other.
fn one_world(scheme: Scheme, ground: &Ground) -> String {
    let springs = if scheme.has_springs() {
        let (p_n, p_s) = (ground.normal_stiffness_n_m, ground.shear_stiffness_n_m);
        format!("springs of {p_n:e} and {p_s:e} N/m")
    } else {
        "springs left out: the rigid limit has none".to_owned()
    };
    let restitution = ground.restitution.map_or_else(
        || "restitution of the scheme itself".to_owned(),
        |e| format!("restitution {e}"),
    );
    let angle_deg = ground.friction_angle_rad.to_degrees();
    format!("one world: {springs}, friction angle {angle_deg:.1}°, {restitution}")
}

fn map([x, y, z]: [f64; 3], epsg: Option<u32>) -> String {
    let code = epsg.map_or_else(|| "no EPSG code".to_owned(), |code| format!("EPSG:{code}"));
    format!("origin ({x}, {y}, {z}) m subtracted, {code}")
}
