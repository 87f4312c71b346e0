//! The list of figures.

use super::figure::Figure;
use super::{distributions, plan_view, reach_angle, runout, side_view, stops};

/// All figures that every report has. To add one: a file with a `draw` function and a line here; the page shows it behind the
/// histograms, if no chapter names it elsewhere.
pub const FIGURES: [Figure; 6] = [
    Figure { file: "plan.svg", title: |words| words.plan_title, draw: plan_view::draw },
    Figure { file: "stops.svg", title: |words| words.stops_title, draw: stops::draw },
    Figure { file: side_view::FILE, title: |words| words.side_title, draw: side_view::draw },
    Figure { file: "runout.svg", title: |words| words.runout, draw: runout::draw },
    Figure { file: "reach_angle.svg", title: |words| words.reach_angle, draw: reach_angle::draw },
    Figure {
        file: "distributions.svg",
        title: |words| words.distributions_title,
        draw: distributions::draw,
    },
];
