//! Room of every text of a drawing, with the widths of each font that a reader may have.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]

use super::svg::{attribute, strip_tags};
use rockfall::report::svg::metrics::{FontFamily, width_em_in};

/// Height of capitals and depth of letters over the font size.
const CAP: f64 = 0.718;
const DEPTH: f64 = 0.207;
/// What two texts may share (tenths of a pixel): rounding of the places.
const SHARED: f64 = 4.0;

/// A rectangle, turned: its middle, half its extent along its own axes, and the direction of reading.
struct Room {
    words: String,
    middle: (f64, f64),
    half: (f64, f64),
    way: (f64, f64),
}

/// What is wrong with the texts of a drawing: none may reach beyond the paper, none into another, in no font.
pub(crate) fn faults(svg: &str, place: &str) -> Vec<String> {
    let view: Vec<f64> = attribute(svg.split('>').next().unwrap(), "viewBox")
        .unwrap()
        .split(' ')
        .map(|v| v.parse().unwrap())
        .collect();
    let on_paper = |(x, y): (f64, f64)| {
        (-2.0..=view[2] + 2.0).contains(&x) && (-2.0..=view[3] + 2.0).contains(&y)
    };
    let mut faults = Vec::new();
    for face in FontFamily::ALL {
        let rooms = rooms(svg, face);
        for room in rooms.iter().filter(|room| !room.corners().into_iter().all(on_paper)) {
            let corners = room.corners();
            faults.push(format!("{place}, {face:?}: `{}` at {corners:.0?}", room.words));
        }
        for (k, one) in rooms.iter().enumerate() {
            for other in rooms[k + 1..].iter().filter(|other| one.meets(other)) {
                let (x, y) = one.middle;
                faults.push(format!(
                    "{place}, {face:?}: `{}` meets `{}` at ({x:.0}, {y:.0})",
                    one.words, other.words
                ));
            }
        }
    }
    faults
}

/// The rooms of all texts; the white rim behind a text is none of its own.
fn rooms(svg: &str, face: FontFamily) -> Vec<Room> {
    let mut rooms = Vec::new();
    let mut groups: Vec<(bool, Option<[f64; 3]>)> = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        let tag = rest.split('>').next().unwrap();
        if tag.starts_with("g ") {
            groups.push((attribute(tag, "stroke") == Some("#fff"), turn(tag)));
        } else if tag == "/g" {
            groups.pop();
        } else if tag.starts_with("text ") {
            let inner = rest[tag.len() + 1..].split("</text>").next().unwrap();
            if !groups.iter().any(|(is_rim, _)| *is_rim) {
                let turned = groups.iter().find_map(|(_, turn)| *turn);
                rooms.push(room(tag, inner, face, turned));
            }
        }
    }
    rooms
}

/// Angle and centre of `rotate(angle x y)`.
fn turn(tag: &str) -> Option<[f64; 3]> {
    let (_, rest) = tag.split_once("rotate(")?;
    let mut numbers = rest.split(')').next()?.split(' ').map(|n| n.parse::<f64>().unwrap());
    Some([numbers.next()?, numbers.next()?, numbers.next()?])
}

fn room(tag: &str, inner: &str, face: FontFamily, turned: Option<[f64; 3]>) -> Room {
    let number = |name: &str| attribute(tag, name).unwrap().parse::<f64>().unwrap();
    let (x, y, size) = (number("x"), number("y"), number("font-size"));
    let width = width(tag, inner, face, size);
    let left = match attribute(tag, "text-anchor") {
        None | Some("start") => x,
        Some("middle") => x - 0.5 * width,
        Some(_) => x - width,
    };
    let flat = (left + 0.5 * width, y + 0.5 * (DEPTH - CAP) * size);
    let half = (0.5 * width, 0.5 * (CAP + DEPTH) * size);
    let words = strip_tags(inner);
    let Some([degrees, cx, cy]) = turn(tag).or(turned) else {
        return Room { words, middle: flat, half, way: (1.0, 0.0) };
    };
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (dx, dy) = (flat.0 - cx, flat.1 - cy);
    let middle = (cx + cos * dx - sin * dy, cy + sin * dx + cos * dy);
    Room { words, middle, half, way: (cos, sin) }
}

/// Width of a text with its parts: bold ones, raised figures, gaps between parts.
fn width(tag: &str, inner: &str, face: FontFamily, size: f64) -> f64 {
    let is_bold = |tag: &str, around: bool| match attribute(tag, "font-weight") {
        Some(weight) => weight == "bold",
        None => around,
    };
    let bold = is_bold(tag, false);
    let mut open: Vec<(bool, f64)> = vec![(bold, size)];
    let mut sum = 0.0;
    for piece in format!(">{inner}").split('<') {
        let (tag, words) = piece.split_once('>').unwrap();
        if tag.starts_with("tspan") {
            let (around, own) = *open.last().unwrap();
            let size = attribute(tag, "font-size").map_or(own, |s| s.parse().unwrap());
            sum += attribute(tag, "dx").map_or(0.0, |dx| dx.parse::<f64>().unwrap());
            open.push((is_bold(tag, around), size));
        } else if tag == "/tspan" {
            open.pop();
        }
        let (bold, size) = *open.last().unwrap();
        sum += size * width_em_in(face, &strip_tags(words), bold);
    }
    sum
}

impl Room {
    fn corners(&self) -> [(f64, f64); 4] {
        let ((cos, sin), (w, h)) = (self.way, self.half);
        [(-w, -h), (w, -h), (w, h), (-w, h)]
            .map(|(u, v)| (self.middle.0 + cos * u - sin * v, self.middle.1 + sin * u + cos * v))
    }

    /// Whether two rectangles share room: no side of either separates them.
    fn meets(&self, other: &Self) -> bool {
        let axes = [self, other].into_iter().flat_map(|r| [r.way, (-r.way.1, r.way.0)]);
        axes.into_iter().all(|(ax, ay)| {
            let span = |room: &Self| {
                let along = room.corners().map(|(x, y)| ax * x + ay * y);
                let ends = along.into_iter();
                ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
            };
            let ((a0, a1), (b0, b1)) = (span(self), span(other));
            a0 + SHARED < b1 && b0 + SHARED < a1
        })
    }
}

/// Two texts on top of each other are found, beside each other they are not; a text over the edge is found.
#[test]
fn rooms_that_meet_are_found() {
    let drawing = |x: i32| {
        format!(
            r#"<svg viewBox="0 0 1000 200"><text x="10" y="100" font-size="100">one</text><text x="{x}" y="100" font-size="100">two</text></svg>"#
        )
    };
    let fails = |x: i32| !faults(&drawing(x), "made").is_empty();
    assert!(fails(100) && fails(900) && !fails(400));
    let turned = r#"<svg viewBox="0 0 1000 1000"><text x="100" y="500" font-size="100" transform="rotate(-90 100 500)">upwards</text><text x="120" y="300" font-size="100">flat</text></svg>"#;
    assert!(
        !rooms(turned, FontFamily::Helvetica)[0].meets(&rooms(turned, FontFamily::Helvetica)[1])
    );
}
