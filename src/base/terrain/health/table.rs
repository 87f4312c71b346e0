//! The health of a mesh as a table for people.

use super::{FileHealth, Found, Gap, HangingSheet, Health, Hole, MORE_DIGITS, Overlap, Spike};
use crate::count::counted;
use crate::terrain::stl::{CoarseText, Format, Spacing};
use crate::terrain::weld::Tally;
use std::fmt;

/// How many gaps and overlaps are said.
const MOST_SAID: usize = 5;

impl fmt::Display for Health {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for file in &self.files {
            write!(f, "{file}")?;
        }
        self.sizes(f)?;
        writeln!(f, "\n{:<22}{:>12}  handled", "found", "count")?;
        for (name, tally, handled) in self.rows() {
            writeln!(f, "{name:<22}{:>12}  {handled}", grouped(tally.count))?;
            if !tally.examples_m.is_empty() && tally.count > 0 {
                writeln!(f, "{}", places(tally))?;
            }
        }
        if let Some(warning) = self.mostly_flat() {
            writeln!(f, "warning: {warning}")?;
        }
        named(
            f,
            ("gaps", "kept: wide rocks press on both borders, smaller ones fall in"),
            &self.gaps,
        )?;
        if let Some(closing_m) = self.closing_tolerance_m {
            writeln!(
                f,
                "    [mesh] weld_tolerance_m = {closing_m} closes those whose corners are so near"
            )?;
        }
        let out = "kept: rocks that come there leave the terrain; fill them";
        found(f, ("inner holes", out), &self.holes)?;
        found(
            f,
            ("spikes", "kept as ground; single corners far from all around them"),
            &self.spikes,
        )?;
        found(f, ("hanging sheets", "kept: rocks meet them as ground"), &self.hanging)?;
        named(f, ("overlaps", "kept: rocks touch both sheets"), &self.overlaps)
    }
}

/// Some of what was found, the largest first; nothing where nothing was.
fn named(
    f: &mut fmt::Formatter<'_>,
    (name, handled): (&str, &str),
    found: &[impl fmt::Display],
) -> fmt::Result {
    if found.is_empty() {
        return Ok(());
    }
    writeln!(f, "{name:<22}{:>12}  {handled}", grouped(found.len()))?;
    for one in found.iter().take(MOST_SAID) {
        writeln!(f, "    {one}")?;
    }
    smaller(f, found.len())
}

/// How many more there are than are said.
fn smaller(f: &mut fmt::Formatter<'_>, count: usize) -> fmt::Result {
    match count.saturating_sub(MOST_SAID) {
        0 => Ok(()),
        more => writeln!(f, "    and {more} smaller ones"),
    }
}

/// The same of what may be there very often.
fn found(
    f: &mut fmt::Formatter<'_>,
    (name, handled): (&str, &str),
    found: &Found<impl fmt::Display>,
) -> fmt::Result {
    if found.is_empty() {
        return Ok(());
    }
    writeln!(f, "{name:<22}{:>12}  {handled}", grouped(found.count))?;
    for one in found.largest.iter().take(MOST_SAID) {
        writeln!(f, "    {one}")?;
    }
    smaller(f, found.count)
}

impl fmt::Display for Hole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y, z], [west, south, east, north]) = (self.at_m, self.box_m);
        let [area, wide, deep] = [self.area_m2, east - west, north - south].map(metres);
        write!(
            f,
            "{area} m², {wide} m from west to east and {deep} m from south to north, around ({x:.1}, {y:.1}, {z:.1})"
        )
    }
}

impl fmt::Display for Spike {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.at_m;
        let side = if self.height_m > 0.0 { "above" } else { "below" };
        let height = metres(self.height_m.abs());
        write!(f, "{height} m {side} all around it, at ({x:.1}, {y:.1}, {z:.1})")
    }
}

impl fmt::Display for HangingSheet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y, z], [own, below]) = (self.at_m, self.parts);
        let [area, height] = [self.area_m2, self.height_m].map(metres);
        write!(
            f,
            "part {own} of {area} m² hangs {height} m above part {below}, near ({x:.1}, {y:.1}, {z:.1})"
        )
    }
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.at_m;
        let [wide, widest] = [self.width_m, self.widest_m].map(metres);
        let most = if wide == widest { String::new() } else { format!(" (up to {widest} m)") };
        let length = metres(self.length_m);
        let between = match self.parts {
            [a, b] if a == b => format!("in part {a}"),
            [a, b] => format!("between part {a} and part {b}"),
        };
        write!(f, "{wide} m wide{most}, {length} m long, {between}, near ({x:.1}, {y:.1}, {z:.1})")
    }
}

impl fmt::Display for Overlap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y, z], [a, b]) = (self.at_m, self.parts);
        let [area, low, high] = [self.area_m2, self.apart_low_m, self.apart_high_m].map(metres);
        write!(
            f,
            "part {a} and part {b} over each other on {area} m², apart by {low} to {high} m, near ({x:.1}, {y:.1}, {z:.1})"
        )
    }
}

/// A length as far as it is known: two digits below ten, none behind the point from ten on.
fn metres(length_m: f64) -> String {
    let decimals = match length_m {
        m if m >= 10.0 => 0,
        m if m >= 1.0 => 1,
        m if m >= 0.1 => 2,
        m if m >= 0.01 => 3,
        _ => 4,
    };
    format!("{length_m:.decimals$}")
}

impl Health {
    fn sizes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = [0, 1, 2].map(|k| {
            format!(
                "{:.2} to {:.2} ({:.2})",
                self.low_m[k],
                self.high_m[k],
                self.high_m[k] - self.low_m[k]
            )
        });
        writeln!(
            f,
            "welded       {} triangles, {} vertices, {} edges; tolerance {:.1e} m, {} corners moved",
            grouped(self.triangles),
            grouped(self.vertices),
            grouped(self.edges),
            self.tolerance_m,
            grouped(self.moved_corners)
        )?;
        writeln!(
            f,
            "origin (m)   {:?}, subtracted while computing, added back in every result",
            self.origin_m
        )?;
        writeln!(f, "extent (m)   x {x}; y {y}; z {z}")?;
        writeln!(f, "surface      {:.2} m²", self.area_m2)?;
        let [least, low, median, high, most] = self.edge_quantiles_m;
        writeln!(
            f,
            "edges (m)    {least:.4} shortest, {low:.4} 5 %, {median:.4} median, {high:.4} 95 %, {most:.4} longest"
        )?;
        writeln!(f, "parts        {}", self.parts_text())
    }

    fn parts_text(&self) -> String {
        let sizes: Vec<String> = self.parts.iter().take(5).map(|&size| grouped(size)).collect();
        let more = if self.parts.len() > sizes.len() { ", …" } else { "" };
        format!(
            "{} with {}{more} triangles; none is left out",
            grouped(self.parts.len()),
            sizes.join(", ")
        )
    }

    fn split_text(&self) -> String {
        if self.t_junctions.count == 0 {
            return "closed: the facet on the edge would be split there".into();
        }
        let (facets, into) = (grouped(self.split_facets), grouped(self.split_into));
        let left = grouped(self.t_junctions_left.count);
        format!("{facets} facets split there into {into}; {left} kept where too thin to split")
    }

    /// Name, tally and treatment of everything that can be wrong.
    fn rows(&self) -> [(&'static str, &Tally, String); 8] {
        let loops = format!(
            "kept, can be hit; {} open {}",
            grouped(self.border_loops),
            counted(self.border_loops, "border", "borders")
        );
        [
            ("without area", &self.zero_area, "left out".into()),
            ("duplicates", &self.duplicates, "left out, the first is kept".into()),
            (
                "lying on others",
                &self.covered,
                "left out: those before cover them, within the tolerance".into(),
            ),
            ("needles", &self.needles, "kept (more than 10 000 times as long as high)".into()),
            (
                "edges of 3+ triangles",
                &self.non_manifold_edges,
                "kept, every triangle can be hit".into(),
            ),
            ("border edges", &self.border_edges, loops),
            ("T-junctions", &self.t_junctions, self.split_text()),
            (
                "flipped neighbours",
                &self.flipped_edges,
                "no matter: every triangle has two sides".into(),
            ),
        ]
    }
}

impl fmt::Display for FileHealth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, ", self.file, self.format.name())?;
        if matches!(self.format, Format::Ascii | Format::Binary) {
            write!(f, "{} solid(s), ", grouped(self.solids))?;
        }
        let (facets, down) = (grouped(self.facets), 100.0 * self.facing_down);
        writeln!(f, "{facets} facets, {down:.0} % face down")?;
        if let Some(code) = self.epsg {
            writeln!(f, "  map coordinates of EPSG:{code}")?;
        }
        for note in &self.notes {
            writeln!(f, "  {note}")?;
        }
        for warning in &self.warnings {
            writeln!(f, "  warning: {warning}")?;
        }
        if self.normals_off.count > 0 {
            let count = grouped(self.normals_off.count);
            writeln!(
                f,
                "  {count} stored normals contradict their winding; stored normals are never used"
            )?;
            writeln!(f, "{}", places(&self.normals_off))?;
        }
        if let Some(coarse) = self.coarse.filter(CoarseText::spoils) {
            writeln!(f, "  warning: {coarse}: no rock can be computed on it; {MORE_DIGITS}")?;
        }
        match self.spacing.filter(Spacing::is_worth_a_warning) {
            Some(spacing) => writeln!(
                f,
                "  warning: {spacing}: export with a map origin subtracted, or as ASCII with {} decimals",
                spacing.decimals()
            ),
            None => Ok(()),
        }
    }
}

/// The example places of a tally.
fn places(tally: &Tally) -> String {
    let places: Vec<String> =
        tally.examples_m.iter().map(|[x, y, z]| format!("({x:.3}, {y:.3}, {z:.3})")).collect();
    let more = if tally.count > places.len() { " …" } else { "" };
    format!("    at {}{more}", places.join(" "))
}

/// A count with thin groups of three digits: 48 210.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}
