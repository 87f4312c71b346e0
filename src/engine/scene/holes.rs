//! A polygon with holes as one ring: every hole is joined to the outline by a bridge walked both ways.

use super::geometry::{Corner, meet, twice_area};
use crate::error::Flaw;
use crate::math;

/// The outline with its holes joined to it, anticlockwise.
///
/// # Errors
/// A hole that cannot be joined: it lies outside, or crosses another ring.
pub(super) fn bridged(outline_m: &[Corner], holes_m: &[&[Corner]]) -> Result<Vec<Corner>, Flaw> {
    if holes_m.iter().any(|hole| sorted(hole) == sorted(outline_m)) {
        return Err(Flaw::new("found a ring twice: as outline and as hole or part", INSIDE));
    }
    let mut ring = turned(outline_m, true);
    let mut holes: Vec<Vec<Corner>> = holes_m.iter().map(|hole| turned(hole, false)).collect();
    // the easternmost first: nothing stands between it and the outline but the outline
    holes.sort_by(|one, other| easternmost(other)[0].total_cmp(&easternmost(one)[0]));
    for number in 0..holes.len() {
        let (at, from) = bridge(&ring, &holes[number..]).ok_or_else(|| {
            let found =
                "found a hole that meets its outline or another hole, or two parts that overlap";
            Flaw::new(found, INSIDE)
        })?;
        let hole = &holes[number];
        let around = hole[from..].iter().chain(&hole[..=from]).copied();
        let (joint, behind) = (ring[at], ring.split_off(at + 1));
        ring.extend(around);
        ring.push(joint);
        ring.extend(behind);
    }
    Ok(ring)
}

/// What to do about rings that meet.
const INSIDE: &str =
    "write holes inside of the polygon, apart from each other, and parts of it that do not overlap";

/// The corners of a ring, wherever it begins and whichever way it goes.
fn sorted(ring: &[Corner]) -> Vec<Corner> {
    let mut corners = ring.to_vec();
    corners.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
    corners
}

fn easternmost(ring: &[Corner]) -> Corner {
    ring.iter().copied().max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or_default()
}

/// The shortest line from a corner of the ring to one of the first hole that meets no side of either or of other holes.
fn bridge(ring: &[Corner], holes: &[Vec<Corner>]) -> Option<(usize, usize)> {
    let hole = &holes[0];
    let from = (0..hole.len()).max_by(|&i, &j| hole[i][0].total_cmp(&hole[j][0]))?;
    let end = hole[from];
    let far = |at: usize| math::hypot(ring[at][0] - end[0], ring[at][1] - end[1]);
    let mut ats: Vec<usize> = (0..ring.len()).collect();
    ats.sort_by(|&one, &other| far(one).total_cmp(&far(other)));
    let sides = |ring: &[Corner]| -> Vec<[Corner; 2]> {
        (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]).collect()
    };
    let all: Vec<[Corner; 2]> =
        sides(ring).into_iter().chain(holes.iter().flat_map(|h| sides(h))).collect();
    let is_free = |line: [Corner; 2]| {
        all.iter()
            .filter(|side| !side.contains(&line[0]) && !side.contains(&line[1]))
            .all(|&side| !meet(line, side))
    };
    ats.into_iter()
        .find(|&at| is_free([ring[at], end]) && opens(ring, at, end))
        .map(|at| (at, from))
}

/// Whether a line from a corner of an anticlockwise ring starts into its inside.
fn opens(ring: &[Corner], at: usize, to: Corner) -> bool {
    let n = ring.len();
    let (before, here, after) = (ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]);
    let (left_of_in, left_of_out) =
        (twice_area([before, here, to]) > 0.0, twice_area([here, after, to]) > 0.0);
    if twice_area([before, here, after]) >= 0.0 {
        left_of_in && left_of_out
    } else {
        left_of_in || left_of_out
    }
}

/// A ring in the given direction.
fn turned(ring: &[Corner], anticlockwise: bool) -> Vec<Corner> {
    let mut ring = ring.to_vec();
    let turning: f64 =
        (1..ring.len() - 1).map(|k| twice_area([ring[0], ring[k], ring[k + 1]])).sum();
    if (turning > 0.0) != anticlockwise {
        ring.reverse();
    }
    ring
}
