//! What must be read before any number.

use super::super::words::{Words, fill};
use super::super::{by_frequency, format};
use crate::error::Result;
use crate::hazard::{Hazard, Quantity, StopKind};
use crate::output::Results;
use crate::terrain::health::{Found, Hole};

/// What the end of a rock may lie beside the border of the hole that it has come to (m).
const AT_BORDER_M: f64 = 0.05;

/// Rocks that left the terrain at holes in it, and not at its outer border.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftAtHoles {
    /// How many.
    rocks: usize,
    /// The hole at which most of them left.
    hole: Hole,
}

impl LeftAtHoles {
    /// Of the holes that the health of the meshes knows.
    ///
    /// # Errors
    /// When the rows of the releases cannot be read.
    pub fn of(results: &Results) -> Result<Option<Self>> {
        let found = results.summary.mesh_health.get("holes").cloned();
        let holes: Option<Found<Hole>> = found.and_then(|holes| serde_json::from_value(holes).ok());
        let holes = holes.map_or_else(Vec::new, |holes| holes.largest);
        if holes.is_empty() || results.hazard.ended(StopKind::LeftTerrain).count == 0 {
            return Ok(None);
        }
        let mut rocks = vec![0; holes.len()];
        for row in results.rows()? {
            let row = row?;
            let is_there =
                |hole: &Hole| row.stop == StopKind::LeftTerrain && holds(hole, row.end_m);
            if let Some(at) = holes.iter().position(is_there) {
                rocks[at] += 1;
            }
        }
        let all = rocks.iter().sum();
        let most = (0..holes.len()).max_by_key(|k| (rocks[*k], std::cmp::Reverse(*k)));
        let most = most.filter(|_| all > 0);
        Ok(most.map(|most| Self { rocks: all, hole: holes[most].clone() }))
    }

    /// What to do about rocks that left at holes, and not at the outer border.
    fn remedy(&self, words: &Words) -> String {
        let [x, y, _] = self.hole.at_m.map(|m| format!("{m:.1}"));
        let found: [(&str, &dyn std::fmt::Display); 3] =
            [("n", &format::decimal(self.rocks as f64, 0)), ("x", &x), ("y", &y)];
        fill(words.open().remedy_holes, &found)
    }
}

fn holds(hole: &Hole, [x, y, _]: [f64; 3]) -> bool {
    let [west, south, east, north] = hole.box_m;
    (west - AT_BORDER_M..=east + AT_BORDER_M).contains(&x)
        && (south - AT_BORDER_M..=north + AT_BORDER_M).contains(&y)
}

/// What sources without a rock and rocks that left the terrain do to the numbers, before anything else.
pub(in crate::report) fn warnings_first(
    hazard: &Hazard,
    at_holes: Option<&LeftAtHoles>,
    words: &Words,
) -> Vec<String> {
    let own = words.open();
    let remedy_left = remedy_left(hazard, at_holes, words);
    let kinds = [
        (StopKind::LeftTerrain, own.have_left, remedy_left.as_str()),
        (StopKind::TimeUp, own.have_no_time, own.remedy_time),
        (StopKind::OverBudget, own.have_no_budget, own.remedy_budget),
        (StopKind::Failed, own.have_failed, own.remedy_budget),
    ];
    let weighted = hazard.weights().map(|_| words.say(by_frequency::SHARE));
    let some_rocks = weighted.unwrap_or_else(|| own.some_rocks.to_owned());
    let said = |(kind, what, remedy): (StopKind, &str, &str)| {
        let share = hazard.ended_of_released(kind);
        let count = |n: usize| format::decimal(n as f64, 0);
        let percent = format::percent_of_part(share.share, usize::from(share.share < 0.1));
        let (n, of) = (count(share.count), count(share.of));
        let rocks = fill(&some_rocks, &[("n", &n), ("of", &of), ("share", &percent)]);
        let has_left = kind == StopKind::LeftTerrain;
        let largest = match (has_left, hazard.leaves_largest_open()) {
            (true, _) => own.largest_left,
            (false, true) => own.largest_open,
            (false, false) => own.largest_closed,
        };
        // what the rocks have done: a share is of several
        let is_share = hazard.weights().is_some();
        let what = fill(what, &[("n", if is_share { &format::NO_NUMBER } else { &n })]);
        let said = || {
            fill(
                own.censored,
                &[("rocks", &rocks), ("what", &what), ("largest", &largest), ("remedy", &remedy)],
            )
        };
        (share.count > 0).then(said)
    };
    let missing = hazard.missing_events();
    let missing = missing.iter().map(|warning| words.say(warning));
    missing.chain(kinds.into_iter().filter_map(said)).collect()
}

/// What to do about rocks that left the terrain.
fn remedy_left(hazard: &Hazard, at_holes: Option<&LeftAtHoles>, words: &Words) -> String {
    let farther = words.open().remedy_left;
    let Some(left) = at_holes else { return farther.to_owned() };
    let remedy = left.remedy(words);
    if left.rocks >= hazard.ended(StopKind::LeftTerrain).count {
        remedy
    } else {
        format!("{remedy} {farther}")
    }
}

/// Says that no rock touched a tree, where there are both: trees beside the ways of rocks are usual, a forest of which none is met rather
/// stands elsewhere than it should.
pub fn untouched_trees(results: &Results) -> Option<String> {
    let planned = results.summary.plan_entries.iter().find(|entry| entry.name == "trees");
    let has_trees = planned.is_some_and(|entry| !entry.said.starts_with("left out"));
    let touched = results.hazard.values(Quantity::TreeImpacts).iter().any(|count| *count > 0.0);
    let released = results.hazard.released();
    (has_trees && released > 0 && !touched).then(|| {
        format!("trees: none of {released} rocks touched one; do they stand where the rocks come?")
    })
}

/// Says that no rock touched the ground: then releases and slope do not belong together, whatever the numbers say.
pub fn untouched_ground(results: &Results) -> Option<String> {
    let released = results.hazard.released();
    let struck = results.hazard.values(Quantity::Impacts).iter().any(|count| *count > 0.0);
    let totals = &results.hazard.totals.ledger;
    let rubbed = [&totals.friction_j, &totals.damping_j, &totals.rolling_j, &totals.soil_j];
    let rubbed = rubbed.iter().any(|sum| sum.value() > 0.0);
    (released > 0 && !struck && !rubbed).then(|| {
        format!("none of {released} rocks touched the ground: do the places and heights of the releases belong to this slope?")
    })
}
