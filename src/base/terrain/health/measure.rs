//! The measurements behind [`Health`](super::Health).

use super::{FileHealth, MORE_DIGITS};
use crate::groups::Groups;
use crate::parallel;
use crate::rock::Vec3;
use crate::terrain::stl::{CoarseText, Spacing, area_vector};
use crate::terrain::weld::{Piece, Tally, Up, Welded};

/// Longest edge over height (–) above which a triangle counts as a needle: a quarter of a millimetre on 2.5 m. Such a
/// triangle is kept; its normal is known to about 1e-12.
const NEEDLE: f64 = 1e4;

/// Triangles whose areas are found beside each other before they are added up.
const AT_ONCE: usize = 1 << 18;

/// Shares at which the edge lengths are given.
const QUANTILES: [f64; 5] = [0.0, 0.05, 0.5, 0.95, 1.0];

/// One file; `map_origin_m` is the map position of its (0, 0, 0).
pub(super) fn file(piece: &Piece, map_origin_m: Vec3) -> FileHealth {
    let soup = piece.soup;
    let is_down = |facet: u32| {
        let corners = soup.facets.at(facet as usize).map(|corner| piece.placed(corner));
        area_vector(&corners).z < 0.0
    };
    let down = parallel::count(soup.facets.len(), is_down);
    let mut normals_off = Tally::default();
    for &facet in &soup.normals_off {
        normals_off.add(piece.placed(soup.facets.at(facet as usize)[0]) + map_origin_m);
    }
    let axes = if piece.up == Up::Y { [0, 2] } else { [0, 1] };
    let coarse = CoarseText::of(soup, axes);
    let mut warnings = soup.warnings.clone();
    warnings.extend(coarse.filter(|coarse| !coarse.spoils()).map(|coarse| {
        format!("{coarse}: where they were rounded, slopes are wrong; {MORE_DIGITS}")
    }));
    FileHealth {
        file: piece.file.display().to_string(),
        format: soup.format,
        solids: soup.solids.len(),
        facets: soup.facets.len(),
        facing_down: down as f64 / soup.facets.len().max(1) as f64,
        normals_off,
        spacing: soup.is_single.then(|| Spacing::of(&soup.facets)),
        coarse,
        epsg: soup.epsg,
        notes: soup.notes.clone(),
        warnings,
    }
}

/// Lowest and highest map coordinates (m).
pub(super) fn box_m(welded: &Welded) -> [[f64; 3]; 2] {
    let start = welded.vertices_m.first().copied().unwrap_or_default();
    let (low, high) = welded
        .vertices_m
        .iter()
        .fold((start, start), |(low, high), vertex| (low.inf(vertex), high.sup(vertex)));
    [low, high].map(|corner| welded.on_map(corner).into())
}

/// Edges that are not shared by two triangles wound alike.
#[derive(Debug, Default)]
pub(super) struct OddEdges {
    /// Of one triangle.
    pub(super) borders: Tally,
    /// Of three or more.
    pub(super) non_manifold: Tally,
    /// Of two that both run along it the same way.
    pub(super) flipped: Tally,
}

/// What is odd about an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Odd {
    Border,
    NonManifold,
    Flipped,
}

/// The odd edges, located at their middle, by the numbers of their ends.
pub(super) fn odd_edges(welded: &Welded) -> OddEdges {
    let with_ends = |edge: u32| odd(welded, edge).map(|odd| (welded.ends(edge), odd));
    let mut found = welded.edges.filter_map(with_ends);
    found.sort_unstable();
    let mut tallies = OddEdges::default();
    for (ends, odd) in found {
        let [a, b] = ends.map(|v| welded.vertices_m[v as usize]);
        let tally = match odd {
            Odd::Border => &mut tallies.borders,
            Odd::NonManifold => &mut tallies.non_manifold,
            Odd::Flipped => &mut tallies.flipped,
        };
        tally.add(welded.on_map((a + b) / 2.0));
    }
    tallies
}

fn odd(welded: &Welded, edge: u32) -> Option<Odd> {
    let from = |side: u32| welded.triangles[side as usize / 3][side as usize % 3];
    let mut sides = welded.edges.sides_on(edge);
    match (sides.next(), sides.next(), sides.next()) {
        (_, None, _) => Some(Odd::Border),
        (_, _, Some(_)) => Some(Odd::NonManifold),
        (Some(one), Some(other), None) => (from(one) == from(other)).then_some(Odd::Flipped),
        (None, ..) => None,
    }
}

/// Triangles more than [`NEEDLE`] times as long as high.
pub(super) fn needles(welded: &Welded) -> Tally {
    let is_needle = |triangle: u32| {
        let corners @ [a, b, c] = welded.corners_m(triangle as usize);
        let longest2 =
            (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        // longest / height = longest² / (2 area)
        longest2 > NEEDLE * area_vector(&corners).norm()
    };
    let mut tally = Tally::default();
    for triangle in parallel::filter(welded.triangles.len(), is_needle) {
        tally.add(welded.on_map(welded.corners_m(triangle as usize)[0]));
    }
    tally
}

/// Connected runs of border edges.
pub(super) fn border_loops(welded: &Welded) -> usize {
    let ends: Vec<[u32; 2]> =
        welded.edges.borders().into_iter().map(|edge| welded.ends(edge)).collect();
    let mut on_border: Vec<u32> = ends.iter().flatten().copied().collect();
    on_border.sort_unstable();
    on_border.dedup();
    let place = |vertex: u32| on_border.partition_point(|&other| other < vertex) as u32;
    let mut groups = Groups::of(on_border.len());
    for [a, b] in ends {
        groups.join(place(a), place(b));
    }
    groups.sizes().len()
}

/// Surface of all triangles (m²).
pub(super) fn area_m2(welded: &Welded) -> f64 {
    let mut areas = vec![0.0; AT_ONCE.min(welded.triangles.len())];
    let mut sum = 0.0;
    // added up one after the other: the same sum on any number of threads
    for first in (0..welded.triangles.len()).step_by(AT_ONCE) {
        let some = &mut areas[..AT_ONCE.min(welded.triangles.len() - first)];
        parallel::update(some, |k, area| {
            *area = 0.5 * area_vector(&welded.corners_m(first + k)).norm();
        });
        sum = some.iter().fold(sum, |sum, area| sum + area);
    }
    sum
}

/// Edge lengths (m) at [`QUANTILES`], by the nearest rank.
pub(super) fn edge_quantiles_m(welded: &Welded) -> [f64; 5] {
    let mut lengths = welded.edges.filter_map(|edge| Some(welded.edge_m(edge).norm()));
    let last = lengths.len().saturating_sub(1) as f64;
    if lengths.is_empty() {
        return [0.0; QUANTILES.len()];
    }
    let ranks = QUANTILES.map(|share| (share * last).round() as usize);
    let mut found = [0.0; QUANTILES.len()];
    select(&mut lengths, 0, (&ranks, &mut found));
    found
}

/// The values at some ranks, ascending, of which the list holds those from `first` on.
fn select(values: &mut [f64], first: usize, (ranks, found): (&[usize], &mut [f64])) {
    let middle = ranks.len() / 2;
    let Some(&rank) = ranks.get(middle) else { return };
    let (low, &mut at, high) = values.select_nth_unstable_by(rank - first, f64::total_cmp);
    let before = ranks.partition_point(|&other| other < rank);
    let behind = ranks.partition_point(|&other| other <= rank);
    found[before..behind].fill(at);
    let (found_low, found_high) = found.split_at_mut(behind);
    rayon::join(
        || select(low, first, (&ranks[..before], &mut found_low[..before])),
        || select(high, rank + 1, (&ranks[behind..], found_high)),
    );
}
