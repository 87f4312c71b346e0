//! Overlaps: two sheets of slope that lie over each other, a rock's radius or less apart.
//!
//! A sheet is a part of the mesh. A cave or an overhang is one part with the ground below it, so it is none. Objects on the
//! slope are no sheets: closed bodies have no border; walls and stems have little area in plan view; a dam or a block that
//! lies wholly on a sheet is apart from it by more over much of its area, or has much more surface than the sheet below.

use super::{Found, LEAST_FLAT};
use crate::groups::Groups;
use crate::parallel;
use crate::rock::Vec3;
use crate::terrain::stl::area_vector;
use crate::terrain::weld::Welded;
use crate::terrain::weld::parts::Parts;

/// Sheets farther apart than this (m), or than a cell, are two surfaces: no rock of usual size presses on both.
const FARTHEST_M: f64 = 1.0;
/// A part with more surface over its area in plan view (–) is a wall or a stem.
const STEEPEST_PART: f64 = 4.0;
/// Least share of a place where one part lies over another on which they are near each other (–).
const LEAST_NEAR: f64 = 0.8;
/// A part that lies with so much of its area on another one (–) …
const WHOLLY: f64 = 0.9;
/// … and has so many times the surface of that one there (–) is an object.
const MORE_SURFACE: f64 = 1.3;
/// Fewest cells of an overlap.
const FEWEST_CELLS: usize = 4;
/// Areas on a side of the box of the slope in which it is first asked whether there are two parts.
const AREAS: usize = 256;
/// A triangle over more rows of cells than this is a splinter, no piece of a sheet (–).
const MOST_ROWS: f64 = 1e4;
/// Triangles sampled by one thread at once.
const SAMPLED_AT_ONCE: usize = 1 << 11;

/// An area where two sheets lie over each other. Places are map coordinates (m).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Overlap {
    /// Numbers of both parts, from 1 on, the largest part first.
    pub parts: [usize; 2],
    /// Area in plan view (m²).
    pub area_m2: f64,
    /// Vertical distance that 5 % of the area falls short of (m).
    pub apart_low_m: f64,
    /// Vertical distance that 5 % of the area exceeds (m).
    pub apart_high_m: f64,
    /// A place near its middle, on the lower sheet (m).
    pub at_m: [f64; 3],
}

/// A sheet that hangs wholly above another part and touches none. Places are map coordinates (m).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct HangingSheet {
    /// Numbers of itself and of the part below, from 1 on, the largest part first.
    pub parts: [usize; 2],
    /// Area in plan view (m²).
    pub area_m2: f64,
    /// Height above that part: median (m).
    pub height_m: f64,
    /// A place near its middle (m).
    pub at_m: [f64; 3],
}

/// What is known of a part in plan view.
#[derive(Debug, Clone, Default)]
struct PartForm {
    plan_m2: f64,
    surface_m2: f64,
    has_border: bool,
}

impl PartForm {
    fn is_sheet(&self) -> bool {
        self.has_border && self.surface_m2 < STEEPEST_PART * self.plan_m2
    }
}

/// One part at one cell.
#[derive(Debug, Clone, Copy)]
struct SheetSample {
    row: i64,
    column: i64,
    part: u32,
    z_m: f64,
    /// Cosine of the inclination (–).
    flat: f64,
}

/// Two parts over each other at one cell.
#[derive(Debug, Clone, Copy)]
struct SheetPair {
    cell: [i64; 2],
    parts: [u32; 2],
    low_m: f64,
    apart_m: f64,
    /// Of both parts.
    flat: [f64; 2],
    /// Which of them is the upper one.
    upper: usize,
}

/// The cells that the slope is sampled at: one place in each, at another share of it in every row, so that a narrow
/// strip is met as often as its area says.
struct SampleGrid {
    cell_m: f64,
}

impl SampleGrid {
    fn y_m(&self, row: i64) -> f64 {
        (row as f64 + (row as f64 * 0.754_877_666).rem_euclid(1.0)) * self.cell_m
    }

    fn shift(row: i64) -> f64 {
        (row as f64 * 0.618_033_989).rem_euclid(1.0)
    }

    fn x_m(&self, row: i64, column: i64) -> f64 {
        (column as f64 + Self::shift(row)) * self.cell_m
    }

    /// Where a pair lies, on the lower sheet.
    fn place(&self, pair: &SheetPair) -> Vec3 {
        let [row, column] = pair.cell;
        Vec3::new(self.x_m(row, column), self.y_m(row), pair.low_m)
    }
}

/// The overlaps of the slope, the largest first, and the sheets that hang above it.
pub(super) fn overlaps(
    welded: &Welded,
    parts: &Parts,
    is_slope: &(dyn Fn(u32) -> bool + Sync),
) -> (Vec<Overlap>, Found<HangingSheet>) {
    let mut found = (Vec::new(), Found::default());
    if parts.sizes.len() < 2 {
        return found;
    }
    let forms = forms(welded, parts, is_slope);
    let is_used = |t: u32| is_slope(t) && forms[parts.of[t as usize] as usize].is_sheet();
    let used = parallel::filter(welded.triangles.len(), is_used);
    let doubtful = of_several_parts(welded, parts, &used);
    if doubtful.is_empty() {
        return found;
    }
    let plan_m2: f64 = forms.iter().filter(|form| form.is_sheet()).map(|form| form.plan_m2).sum();
    // the side of a cell of a lattice of two triangles each
    let lattice = SampleGrid { cell_m: (2.0 * plan_m2 / used.len() as f64).sqrt() };
    let pairs = pairs(samples(welded, parts, &doubtful, &lattice));
    let patches = patches(&pairs);
    found.0 = patches.iter().filter_map(|patch| overlap(welded, &forms, &lattice, patch)).collect();
    found.0.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    let hanging = patches.iter().filter_map(|patch| hanging(welded, &forms, &lattice, patch));
    found.1 = Found::largest(hanging.collect(), |sheet| sheet.area_m2);
    found
}

fn forms(welded: &Welded, parts: &Parts, is_slope: &(dyn Fn(u32) -> bool + Sync)) -> Vec<PartForm> {
    let mut forms = vec![PartForm::default(); parts.sizes.len()];
    for (t, &part) in (0u32..).zip(&parts.of).filter(|&(t, _)| is_slope(t)) {
        let area = 0.5 * area_vector(&welded.corners_m(t as usize));
        let form = &mut forms[part as usize];
        form.plan_m2 += area.z.abs();
        form.surface_m2 += area.norm();
    }
    for side in welded.edges.borders() {
        forms[parts.of[side as usize / 3] as usize].has_border = true;
    }
    forms
}

/// Those of some triangles that stand in an area where there are others of another part.
fn of_several_parts(welded: &Welded, parts: &Parts, used: &[u32]) -> Vec<u32> {
    let flat = |point: &Vec3| [point.x, point.y];
    let [low, high] = welded.vertices_m.iter().fold(
        [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
        |[low, high], point| {
            let p = flat(point);
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        },
    );
    let area = |k: usize, m: f64| {
        let share = (m - low[k]) / (high[k] - low[k]).max(f64::MIN_POSITIVE);
        ((share * AREAS as f64) as usize).min(AREAS - 1)
    };
    let areas = |t: u32| {
        let corners = welded.corners_m(t as usize);
        let range = |k: usize| {
            let at = corners.map(|corner| area(k, corner[k]));
            at[0].min(at[1]).min(at[2])..=at[0].max(at[1]).max(at[2])
        };
        let columns = range(0);
        range(1).flat_map(move |row| columns.clone().map(move |column| row * AREAS + column))
    };
    let mut first = vec![u32::MAX; AREAS * AREAS];
    let mut has_several = vec![false; AREAS * AREAS];
    for &t in used {
        let part = parts.of[t as usize];
        for area in areas(t) {
            has_several[area] |= first[area] != u32::MAX && first[area] != part;
            first[area] = part;
        }
    }
    used.iter().copied().filter(|&t| areas(t).any(|area| has_several[area])).collect()
}

/// Heights of some triangles at the cells, by cell, and upwards in each.
fn samples(
    welded: &Welded,
    parts: &Parts,
    triangles: &[u32],
    lattice: &SampleGrid,
) -> Vec<SheetSample> {
    let of_share = |share: usize| {
        let mut found = Vec::new();
        for &t in triangles.iter().skip(share * SAMPLED_AT_ONCE).take(SAMPLED_AT_ONCE) {
            sample(&welded.corners_m(t as usize), parts.of[t as usize], lattice, &mut found);
        }
        found
    };
    let mut all = parallel::map_each(triangles.len().div_ceil(SAMPLED_AT_ONCE), of_share).concat();
    let order = |a: &SheetSample, b: &SheetSample| {
        (a.row, a.column)
            .cmp(&(b.row, b.column))
            .then(a.z_m.total_cmp(&b.z_m))
            .then(a.part.cmp(&b.part))
    };
    rayon::slice::ParallelSliceMut::par_sort_unstable_by(&mut all[..], order);
    all
}

/// One triangle, row by row; nothing of a steep one.
fn sample(corners: &[Vec3; 3], part: u32, lattice: &SampleGrid, found: &mut Vec<SheetSample>) {
    let area = area_vector(corners);
    let flat = area.z.abs() / area.norm();
    if flat.is_nan() || flat < LEAST_FLAT {
        return;
    }
    let [low, high] = [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| {
        of(of(corners[0].y, corners[1].y), corners[2].y) / lattice.cell_m
    });
    if high - low > MOST_ROWS {
        return;
    }
    for row in low.floor() as i64 - 1..=high.ceil() as i64 {
        let y = lattice.y_m(row);
        let Some([from, to]) = crossed(corners, y) else { continue };
        let [first, last] = [from, to].map(|x| x / lattice.cell_m - SampleGrid::shift(row));
        for column in first.ceil() as i64..=last.floor() as i64 {
            let at = Vec3::new(lattice.x_m(row, column), y, 0.0);
            let rise = area.x * (at.x - corners[0].x) + area.y * (at.y - corners[0].y);
            let z_m = corners[0].z - rise / area.z;
            found.push(SheetSample { row, column, part, z_m, flat });
        }
    }
}

/// From where to where a triangle goes at a northing, in plan view; nothing where it does not reach it.
fn crossed(corners: &[Vec3; 3], y: f64) -> Option<[f64; 2]> {
    let edge = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        ((a.y <= y) != (b.y <= y)).then(|| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
    };
    let mut at = [0, 1, 2].into_iter().filter_map(edge);
    let (one, other) = (at.next()?, at.next()?);
    Some([one.min(other), one.max(other)])
}

/// Parts that follow each other upwards in a cell.
fn pairs(samples: Vec<SheetSample>) -> Vec<SheetPair> {
    let pair = |two: &[SheetSample]| {
        let (low, high) = (two[0], two[1]);
        let is_pair = (low.row, low.column) == (high.row, high.column) && low.part != high.part;
        let (a, b) = if low.part < high.part { (low, high) } else { (high, low) };
        is_pair.then_some(SheetPair {
            cell: [low.row, low.column],
            parts: [a.part, b.part],
            low_m: low.z_m,
            apart_m: high.z_m - low.z_m,
            flat: [a.flat, b.flat],
            upper: usize::from(high.part > low.part),
        })
    };
    let mut found: Vec<SheetPair> = samples.windows(2).filter_map(pair).collect();
    drop(samples);
    found.sort_by_key(|pair| (pair.parts, pair.cell));
    found.dedup_by_key(|pair| (pair.parts, pair.cell));
    found
}

/// Cells of the same two parts that touch each other.
fn patches(pairs: &[SheetPair]) -> Vec<Vec<SheetPair>> {
    let mut groups = Groups::of(pairs.len());
    let key = |pair: &SheetPair| (pair.parts, pair.cell);
    for (k, pair) in (0u32..).zip(pairs) {
        let [row, column] = pair.cell;
        for beside in
            [[row - 1, column - 1], [row - 1, column], [row - 1, column + 1], [row, column - 1]]
        {
            if let Ok(other) = pairs.binary_search_by_key(&(pair.parts, beside), key) {
                groups.join(k, other as u32);
            }
        }
    }
    let patch = |list: Vec<u32>| list.into_iter().map(|k| pairs[k as usize]).collect();
    groups.lists().into_iter().map(patch).collect()
}

/// What a patch makes; nothing where it is small or one of the parts an object.
fn overlap(
    welded: &Welded,
    forms: &[PartForm],
    lattice: &SampleGrid,
    patch: &[SheetPair],
) -> Option<Overlap> {
    let limit_m = FARTHEST_M.min(lattice.cell_m);
    let is_near = |pair: &&SheetPair| pair.apart_m * pair.flat[0].min(pair.flat[1]) <= limit_m;
    let near: Vec<&SheetPair> = patch.iter().filter(is_near).collect();
    let spans = |k: usize| near.iter().any(|pair| pair.cell[k] != near[0].cell[k]);
    let is_small = near.len() < FEWEST_CELLS || !spans(0) || !spans(1);
    if is_small || (near.len() as f64) < LEAST_NEAR * patch.len() as f64 {
        return None;
    }
    if [[0, 1], [1, 0]].into_iter().any(|of| is_object(forms, lattice, patch, of)) {
        return None;
    }
    let mut apart: Vec<f64> = near.iter().map(|pair| pair.apart_m).collect();
    apart.sort_by(f64::total_cmp);
    let at_share = |share: f64| apart[(share * (apart.len() - 1) as f64).round() as usize];
    let at = middle_of(lattice, &near)?;
    Some(Overlap {
        parts: at.parts.map(|part| part as usize + 1),
        area_m2: near.len() as f64 * lattice.cell_m * lattice.cell_m,
        apart_low_m: at_share(0.05),
        apart_high_m: at_share(0.95),
        at_m: welded.on_map(lattice.place(at)).into(),
    })
}

/// The pair nearest to the middle of some.
fn middle_of<'a>(lattice: &SampleGrid, pairs: &[&'a SheetPair]) -> Option<&'a SheetPair> {
    let place = |pair: &&SheetPair| lattice.place(pair);
    let middle = pairs.iter().map(place).sum::<Vec3>() / pairs.len() as f64;
    let off = |pair: &&SheetPair| (lattice.place(pair) - middle).norm_squared();
    pairs.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// What a patch makes whose upper part is nowhere near the lower one and is there with nearly all its area; none of others.
fn hanging(
    welded: &Welded,
    forms: &[PartForm],
    lattice: &SampleGrid,
    patch: &[SheetPair],
) -> Option<HangingSheet> {
    let first = patch.first()?;
    let upper = first.upper;
    let is_apart = |pair: &SheetPair| pair.upper == upper && pair.apart_m > FARTHEST_M;
    let own_m2 = forms[first.parts[upper] as usize].plan_m2;
    let area_m2 = patch.len() as f64 * lattice.cell_m * lattice.cell_m;
    if patch.len() < FEWEST_CELLS || area_m2 < LEAST_NEAR * own_m2 || !patch.iter().all(is_apart) {
        return None;
    }
    let mut apart: Vec<f64> = patch.iter().map(|pair| pair.apart_m).collect();
    apart.sort_by(f64::total_cmp);
    let at = middle_of(lattice, &patch.iter().collect::<Vec<_>>())?;
    let number = |k: usize| at.parts[k] as usize + 1;
    Some(HangingSheet {
        parts: [number(upper), number(1 - upper)],
        area_m2: own_m2,
        height_m: apart[apart.len() / 2],
        at_m: welded.on_map(lattice.place(at) + Vec3::new(0.0, 0.0, at.apart_m)).into(),
    })
}

/// Whether the part `own` of a patch lies wholly on the `other` and has more surface than that one below it.
fn is_object(
    forms: &[PartForm],
    lattice: &SampleGrid,
    patch: &[SheetPair],
    [own, other]: [usize; 2],
) -> bool {
    let form = &forms[patch[0].parts[own] as usize];
    let covered_m2 = patch.len() as f64 * lattice.cell_m * lattice.cell_m;
    let surface: f64 = patch.iter().map(|pair| 1.0 / pair.flat[other]).sum();
    let below = surface / patch.len() as f64;
    covered_m2 > WHOLLY * form.plan_m2 && form.surface_m2 > MORE_SURFACE * below * form.plan_m2
}
