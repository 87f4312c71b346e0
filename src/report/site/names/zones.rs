//! Names of the zones of release, where there are several: beside their outlines, or as letters with a key.

use super::super::zone_parts;
use super::{GAP_PX, Names, Outline, PlacedName, WIDEST, Wanted, farther, outlines};
use crate::output::ReleaseZone;
use crate::report::canvas::{Label, SMALL, fitted_among};
use crate::report::model::Report;
use crate::report::panel::Panel;
use crate::report::svg::path::Spot;

/// More zones are told by their outlines alone: their key would be longer than the map.
const MOST_NAMED: usize = 104;

/// Letters of a zone by its number from 0: A to Z, then AA, AB and so on.
fn letters_of(number: usize) -> String {
    let letter = |k: usize| char::from(b'A' + (k % 26) as u8);
    let first = (number >= 26).then(|| letter(number / 26 - 1));
    first.into_iter().chain([letter(number)]).collect()
}

impl Names {
    /// Adds the names of the zones where there are several; letters where they would be read as those of others or have no room.
    #[must_use]
    pub(in crate::report) fn with_zones(mut self, panel: &Panel, report: &Report) -> Self {
        let zones = zones(panel, report);
        if !(2..=MOST_NAMED).contains(&zones.len()) {
            return self;
        }
        let widest_px = WIDEST * panel.frame.width();
        let letters = || (0..).map(letters_of);
        let is_scattered = |name: &str| {
            let mut own = report.zones.iter().filter(|zone| zone.name == name);
            own.any(|zone| matches!(zone.outline, ReleaseZone::Points(_)))
        };
        let written = |words: &mut dyn Iterator<Item = String>| -> Vec<Wanted<'_>> {
            let places = |(zone, words): (&Outline<'_>, String)| {
                places(zone, is_scattered(zone.name), &words)
            };
            zones.iter().map(|zone| zone.name).zip(zones.iter().zip(words).map(places)).collect()
        };
        let own = || zones.iter().map(|zone| zone.name);
        let fit = |name| fitted_among(name, own(), (SMALL, widest_px));
        let words = written(&mut own().map(fit));
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

/// Places for the name of a zone: beside the middle of the sides of its largest part in the frame, or farther off with a stroke. Those
/// that its own outline runs through come last.
fn places(zone: &Outline<'_>, is_scattered: bool, words: &str) -> Vec<PlacedName> {
    let largest = zone.parts.iter().max_by(|one, other| extent(one).total_cmp(&extent(other)));
    let Some(part) = largest.filter(|part| !part.is_empty()) else { return Vec::new() };
    let [top, bottom, left, right] = if is_scattered { ends(part) } else { middles(part) };
    let label = |(x, y): Spot, (dx, dy): Spot| Label::new(words, (x + dx, y + dy));
    let over = [(top, -GAP_PX), (bottom, GAP_PX)].into_iter().flat_map(|(end, by)| {
        let at = move || label(end, (0.0, by));
        [at().centred(), at(), at().right()]
    });
    let beside = [label(right, (GAP_PX, 0.0)), label(left, (-GAP_PX, 0.0)).right()];
    let mut near: Vec<Label> = over.chain(beside).collect();
    near.sort_by_key(|label| zone.crosses(&label.frame()));
    let near = near.into_iter().map(|label| PlacedName { label, stroke: None });
    near.chain(farther(&[top, bottom], words)).collect()
}

/// A coordinate on paper (px).
type PaperAxis = fn(&Spot) -> f64;

/// Right and down.
const AXES: [PaperAxis; 2] = [|at| at.0, |at| at.1];

/// The highest, lowest, leftmost and rightmost of some points.
fn ends(points: &[Spot]) -> [Spot; 4] {
    let end = |of: &dyn Fn(&Spot) -> f64| {
        let end = points.iter().copied().max_by(|one, other| of(one).total_cmp(&of(other)));
        end.unwrap_or_default()
    };
    let [right, down] = AXES;
    [end(&|at| -down(at)), end(&down), end(&|at| -right(at)), end(&right)]
}

/// Where an outline is highest and lowest in the middle of its width, and leftmost and rightmost in the middle of its height: at corners
/// the next zone may begin.
fn middles(part: &[Spot]) -> [Spot; 4] {
    let [right, down] = AXES;
    let (x, [top, bottom]) = middle(part, right, down);
    let (y, [left, right]) = middle(part, down, right);
    [(x, top), (x, bottom), (left, y), (right, y)]
}

/// The middle of an outline along one axis, and its ends along the other one there.
fn middle(part: &[Spot], along: PaperAxis, across: PaperAxis) -> (f64, [f64; 2]) {
    let [low, high] = range(part.iter().map(along));
    let middle = 0.5 * (low + high);
    let met = |pair: &[Spot]| -> Option<[f64; 2]> {
        let [from, to] = [along(&pair[0]), along(&pair[1])];
        let share = (middle - from) / (to - from);
        let ends = [across(&pair[0]), across(&pair[1])];
        let at = ends[0] + share * (ends[1] - ends[0]);
        if from.total_cmp(&to).is_eq() {
            return Some(ends).filter(|_| (from - middle).abs() < 1e-9);
        }
        Some([at; 2]).filter(|_| (0.0..=1.0).contains(&share))
    };
    let all = part.windows(2).filter_map(met).flatten().collect::<Vec<f64>>();
    // a point has no way
    let all = if all.is_empty() { part.iter().map(across).collect() } else { all };
    (middle, range(all.into_iter()))
}

/// Least and most; 0 of nothing.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let ends = values.map(|v| [v, v]);
    ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default()
}

/// Size of a part (px): half the way round it.
fn extent(part: &[Spot]) -> f64 {
    AXES.map(|along| range(part.iter().map(along))).map(|[least, most]| most - least).iter().sum()
}
