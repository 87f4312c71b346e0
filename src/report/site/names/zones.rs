//! Names of the zones of release, where there are several: beside their outlines, or as letters with a key.

use super::super::zone_parts;
use super::{GAP_PX, Names, Outline, PlacedName, WIDEST, Wanted, farther, outlines};
use crate::report::canvas::{Label, SMALL, fitted};
use crate::report::model::Report;
use crate::report::panel::Panel;
use crate::report::svg::path::Spot;

/// More zones than there are letters are told by their outlines alone.
const MOST_NAMED: usize = 26;

impl Names {
    /// Adds the names of the zones where there are several; letters where they would be read as those of others or have no room.
    #[must_use]
    pub(in crate::report) fn with_zones(mut self, panel: &Panel, report: &Report) -> Self {
        let zones = zones(panel, report);
        if !(2..=MOST_NAMED).contains(&zones.len()) {
            return self;
        }
        let widest_px = WIDEST * panel.frame.width();
        let letters = || ('A'..='Z').map(String::from);
        let written = |words: &mut dyn Iterator<Item = String>| -> Vec<Wanted<'_>> {
            let places = |(zone, words): (&Outline<'_>, String)| places(&zone.parts, &words);
            zones.iter().map(|zone| zone.name).zip(zones.iter().zip(words).map(places)).collect()
        };
        let words = written(&mut zones.iter().map(|zone| fitted(zone.name, SMALL, widest_px)));
        let letter = written(&mut letters());
        let names = zones.iter().map(|zone| zone.name.to_owned());
        let lettered = letters().zip(names).collect();
        let all: Vec<Outline<'_>> = outlines(panel, report).into_iter().chain(zones).collect();
        let before = self.placed.len();
        if !self.place(panel, &all, words) {
            self.placed.truncate(before);
            self.place(panel, &all, letter);
            self.lettered = lettered;
        }
        self
    }
}

/// Zones that have names, in the order of the scene; outlines of one name are one zone.
fn zones<'a>(panel: &Panel, report: &'a Report) -> Vec<Outline<'a>> {
    let mut zones: Vec<Outline<'a>> = Vec::new();
    for zone in report.zones.iter().filter(|zone| !zone.name.is_empty()) {
        let parts = zone_parts(panel, &zone.outline);
        match zones.iter_mut().find(|known| known.name == zone.name) {
            Some(known) => known.parts.extend(parts),
            None => zones.push(Outline { name: &zone.name, parts }),
        }
    }
    zones
}

/// Places for the name of a zone: at the ends of its largest part in the frame, or farther off with a stroke.
fn places(parts: &[Vec<Spot>], words: &str) -> Vec<PlacedName> {
    let largest = parts.iter().max_by(|one, other| extent(one).total_cmp(&extent(other)));
    let Some(part) = largest.filter(|part| !part.is_empty()) else { return Vec::new() };
    let extreme = |of: fn(&Spot) -> f64| {
        let end = part.iter().copied().max_by(|one, other| of(one).total_cmp(&of(other)));
        end.unwrap_or_default()
    };
    let (top, bottom) = (extreme(|at| -at.1), extreme(|at| at.1));
    let (left, right) = (extreme(|at| -at.0), extreme(|at| at.0));
    let label = |(x, y): Spot, (dx, dy): Spot| Label::new(words, (x + dx, y + dy));
    let over = [(top, -GAP_PX), (bottom, GAP_PX)].into_iter().flat_map(|(end, by)| {
        let at = move || label(end, (0.0, by));
        [at().centred(), at(), at().right()]
    });
    let beside = [label(right, (GAP_PX, 0.0)), label(left, (-GAP_PX, 0.0)).right()];
    let near = over.chain(beside).map(|label| PlacedName { label, stroke: None });
    near.chain(farther(&[top, bottom], words)).collect()
}

/// Size of a part (px): half the way round it.
fn extent(part: &[Spot]) -> f64 {
    let range = |of: fn(&Spot) -> f64| {
        let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max];
        let ends = part.iter().map(of).map(|v| [v, v]);
        let whole = ends.reduce(|a, b| [low(a[0], b[0]), high(a[1], b[1])]);
        whole.map_or(0.0, |[least, most]| most - least)
    };
    range(|at| at.0) + range(|at| at.1)
}
