//! What is said where rocks weigh what they stand for, and what each of them weighs: a share is by frequency, and no quotient of the counts beside it.

use super::words::Words;
use crate::frequency::Weights;
use crate::hazard::Hazard;

/// How many of all were counted, beside their share.
pub(super) const SHARE: &str = "{share} of the rocks by frequency ({n} of {of} computed)";
/// Beside a line.
pub(super) const LINE: &str = "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} \
    cross it, {again} more than once. Values at the first crossing.";
/// Beside an object.
pub(super) const OBJECT: &str = "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks \
    {count} hit it. Values at the first touch.";
/// Of a line without crossings.
pub(super) const NOBODY: &str = "None of {n} computed rocks crosses {what} {name}: by frequency its reach probability is below {share} \
    (95\u{2009}% confidence).";
/// In the 3D view, of a line and of a barrier.
pub(super) const WALL: &str = "{share} of the rocks by frequency cross";
pub(super) const BARRIER: &str = "{h} m, {e} kJ: stops {share} of those that arrive, by frequency";
/// Head of a column of numbers of rocks.
pub(super) const COMPUTED: &str = "{what} (computed)";
/// A number of rocks beside the bar of a share.
pub(super) const COUNT: &str = "{n} computed";
/// Below a table.
pub(super) const SHARES: &str = "Shares are by frequency; numbers of rocks are of computed ones.";
/// Checks of speed, deposits and mesh.
pub(super) const FAST: &str = "fastest {v} m/s; {share} of the rocks by frequency ({n} of {of} computed) above {limit} m/s, which single \
    blocks seldom pass";
pub(super) const DEPOSITS: &str = "{share} of the rocks at rest by frequency ({n} of {of} computed) lie in hollows of the mesh without an \
    outlet, deeper than {depth} m; half of all computed ones lie on {half} of the {all} m² that hold them all";
pub(super) const MESH: &str = "median edge of the triangles {edge} m, {times} times the diameter of the median rock by frequency \
    ({diameter} m)";
/// Below a figure with bars.
pub(super) const CURVES: &str =
    "Curves, lines and bars are by frequency; numbers of rocks are of computed ones.";

/// A text with a sentence more where rocks weigh what they stand for.
pub(super) fn noted(text: String, note: Option<&str>, words: &Words) -> String {
    match note {
        Some(note) => format!("{text} {}", words.say(note)),
        None => text,
    }
}

/// As many releases of equal weight would stand for what one that was released does (–).
pub(super) fn weighing(hazard: &Hazard) -> impl Fn(usize) -> f64 {
    let (weights, released) = (hazard.weights(), hazard.released() as f64);
    move |release| {
        let of_all = |all: &Weights| released * all.of_release(release) / all.total_per_year();
        weights.as_ref().map_or(1.0, of_all)
    }
}
