//! What too few digits do to a mesh that is written as text.

use super::{Soup, area_vector};
use crate::terrain::facets::{Facet, Facets};
use crate::terrain::stl::Spacing;
use std::fmt;

/// Coordinates of fewer steps than this are no map coordinates: a mesh around its own origin may stand on whole metres.
const LEAST_STEPS: f64 = 1e4;

/// Share of facets without area (–) from which on rounding has spoilt the mesh: a sound one has hardly any.
const COLLAPSED: f64 = 1e-2;

/// Lengths that differ by less, over themselves, are one (–).
const SAME_LENGTH: f64 = 1e-6;

/// The last digit that the numbers of each axis are written with, as powers of ten; the finest of all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LastDigits([i32; 3]);

impl Default for LastDigits {
    fn default() -> Self {
        Self([i32::MAX; 3])
    }
}

impl LastDigits {
    /// Looks at one number as it is written.
    pub(in crate::terrain) fn see(&mut self, axis: usize, word: &[u8]) {
        let finest = &mut self.0[axis];
        *finest = (*finest).min(last_digit(word));
    }

    /// Largest distance of neighbouring numbers among the axes of the map; none where nothing but zeros is written.
    fn step(&self, axes: [usize; 2]) -> Option<f64> {
        let known = axes.map(|axis| self.0[axis]).into_iter().filter(|last| *last < i32::MAX);
        known.max().map(|last| 10_f64.powi(last))
    }
}

/// The power of ten of the last digit of a number; zeros are written with any.
fn last_digit(word: &[u8]) -> i32 {
    let end = word.iter().position(|byte| matches!(byte, b'e' | b'E')).unwrap_or(word.len());
    let (digits, power) = word.split_at(end);
    if !digits.iter().any(|byte| (b'1'..=b'9').contains(byte)) {
        return i32::MAX;
    }
    let power = power.get(1..).and_then(|power| std::str::from_utf8(power).ok());
    let power: i32 = power.and_then(|power| power.parse().ok()).unwrap_or(0);
    let point = digits.iter().position(|byte| *byte == b'.');
    let decimals = point.map_or(0, |point| digits.len() - point - 1);
    power.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX))
}

/// A text whose numbers are too coarse for its edges, in the unit of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoarseText {
    /// Distance of neighbouring numbers in plan view.
    step: f64,
    /// Median length of the edges.
    median_edge: f64,
    /// Facets without area.
    flat: usize,
    /// All facets.
    facets: usize,
}

impl CoarseText {
    /// Of the facets of a text with these axes in plan view; none where its digits do, or where all cells are alike, as those of an elevation model on whole metres.
    pub(in crate::terrain) fn of(soup: &Soup, axes: [usize; 2]) -> Option<Self> {
        let digit = soup.last_digits.step(axes)?;
        let of_axis = |axis| single_step(&soup.facets, axis, digit);
        let step = axes.into_iter().filter_map(of_axis).fold(digit, f64::max);
        let spacing = Spacing { spacing: step, ..Spacing::of(&soup.facets) };
        if spacing.largest_coordinate < LEAST_STEPS * step || !spacing.spoils() {
            return None;
        }
        let flat = soup.facets.iter().filter(has_no_area).count();
        let found =
            Self { step, median_edge: spacing.median_edge, flat, facets: soup.facets.len() };
        (found.spoils() || !are_cells_alike(&soup.facets, axes)).then_some(found)
    }

    /// More than one facet of a hundred has no area: rounding has moved its corners onto each other or into line.
    pub fn spoils(&self) -> bool {
        self.flat as f64 > COLLAPSED * self.facets as f64
    }
}

impl fmt::Display for CoarseText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, median_edge, flat, facets } = self;
        let share = 100.0 * step / median_edge;
        write!(
            f,
            "its map coordinates are written in steps of {step}, {share:.0} % of the median edge {median_edge:.3}"
        )?;
        if *flat > 0 {
            write!(f, ", and {flat} of its {facets} facets have no area")?;
        }
        Ok(())
    }
}

/// The step of 32-bit numbers, where all coordinates of an axis are such numbers to the last `digit` that is written, and not all of
/// them on a lattice of wider steps, as those of an elevation model are; none elsewhere.
fn single_step(facets: &Facets, axis: usize, digit: f64) -> Option<f64> {
    let numbers = || facets.iter().flatten().map(|corner| corner[axis]);
    let largest = numbers().fold(0.0, |most: f64, x| most.max(x.abs())) as f32;
    let step = f64::from(largest.next_up()) - f64::from(largest);
    if step.is_nan() || step <= 2.0 * digit {
        return None;
    }
    let off = |x: f64, from: f64, step: f64| {
        ((x - from) / step - ((x - from) / step).round()).abs() * step
    };
    let is_single = |x: f64| off(x, 0.0, step) <= 0.51 * digit;
    let first = numbers().next()?;
    let is_lattice = |x: f64| off(x, first, 2.0 * step) <= 1.02 * digit;
    (numbers().all(is_single) && !numbers().all(is_lattice)).then_some(step)
}

fn has_no_area(facet: &Facet) -> bool {
    let [a, b, c] = facet;
    let longest2 =
        [b - a, c - b, a - c].map(|edge| edge.norm_squared()).into_iter().fold(0.0, f64::max);
    area_vector(facet).norm() <= 1e-12 * longest2
}

/// Whether all edges go by the same length or not at all along each axis of the map: nothing then was rounded.
fn are_cells_alike(facets: &Facets, axes: [usize; 2]) -> bool {
    let mut ends = [(f64::INFINITY, 0.0_f64); 2];
    for [a, b, c] in facets.iter() {
        for edge in [b - a, c - b, a - c] {
            for (length, (least, most)) in
                axes.map(|axis| edge[axis].abs()).into_iter().zip(&mut ends)
            {
                if length > 0.0 {
                    (*least, *most) = (least.min(length), most.max(length));
                }
            }
        }
    }
    ends.iter().all(|(least, most)| *most <= least * (1.0 + SAME_LENGTH))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Axes of the map in a file with z up.
    const MAP: [usize; 2] = [0, 1];

    #[test]
    fn the_last_digit_is_told_from_the_text() {
        let of = |word: &str| last_digit(word.as_bytes());
        assert_eq!([of("2.725350e+06"), of("2.72535E+06"), of("2725350")], [0, 1, 0]);
        assert_eq!([of("-12.125"), of("1e-3"), of("0.50")], [-3, -3, -2]);
        assert_eq!([of("0"), of("0.000e+00")], [i32::MAX; 2]);
    }

    /// A slope of cells of a size (m) on the map, as text with its numbers written by `digits`.
    fn slope(cell_m: f64, digits: impl Fn(f64) -> String) -> Soup {
        let at = |i: u32, j: u32| {
            let [x, y] = [i, j].map(|k| cell_m * f64::from(k));
            let z = 1300.0 + 0.6 * x + 0.013 * (x * y).sin();
            let numbers = [2_725_300.0 + x, 1_192_600.0 + y, z].map(&digits);
            format!("vertex {}\n", numbers.join(" "))
        };
        let facet = |corners: [String; 3]| {
            format!("facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n", corners.concat())
        };
        let cells = (0..30).flat_map(|i| (0..30).map(move |j| (i, j)));
        let facets = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [facet([a.clone(), b, c.clone()]), facet([a, c, d])]
        });
        let text = format!("solid s\n{}endsolid s\n", facets.collect::<String>());
        crate::terrain::stl::parse(text.into_bytes(), Path::new("s.stl")).unwrap()
    }

    /// Numbers that have been 32-bit ones are no finer for being written with three decimals: 0.25 m at an easting of 2 725 300. Cells of
    /// half a metre on such numbers are what they are.
    #[test]
    fn steps_of_single_precision_are_told_whatever_is_written() {
        let single = |x: f64| format!("{:.3}", f64::from(x as f32));
        let found = |cell_m: f64| CoarseText::of(&slope(cell_m, single), MAP);
        assert_eq!(found(1.1).map(|found| (found.step, found.spoils())), Some((0.25, false)));
        assert_eq!([found(0.5), found(2.0)], [None; 2]);
        assert_eq!(CoarseText::of(&slope(1.1, |x| format!("{x:.3}")), MAP), None);
    }

    /// Seven digits are steps of a metre at an easting of 2 725 300: cells of half a metre fall together, those of 2.5 m become 2 and 3 m.
    /// All cells of a metre stay what they are, and millimetres do for everything.
    #[test]
    fn coordinates_of_few_digits_are_told_where_they_change_the_cells() {
        let seven = |x: f64| format!("{x:.6e}");
        let spoils = |soup: &Soup| CoarseText::of(soup, MAP).map(|found| found.spoils());
        assert_eq!(spoils(&slope(0.5, seven)), Some(true));
        assert_eq!(spoils(&slope(0.5, |x| format!("{x:.0}"))), Some(true));
        assert_eq!(spoils(&slope(2.5, seven)), Some(false));
        assert_eq!(spoils(&slope(1.0, |x| format!("{x}"))), None);
        assert_eq!(spoils(&slope(0.5, |x| format!("{x:.3}"))), None);
        let said = CoarseText::of(&slope(0.5, seven), MAP).unwrap().to_string();
        assert!(said.contains("in steps of 1, ") && said.contains("facets have no area"), "{said}");
    }
}
