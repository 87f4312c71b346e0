//! Slopes: x runs across, y runs down the slope, z up.

use super::noise::{fade, gradient, value};
use super::stems::{Stem, square_stem, stem};
use crate::rock::Vec3;
use crate::terrain::grid::triangulate;
use crate::terrain::stl::Facet;

/// A made slope: its facets and its exact height, for things that stand on it.
#[derive(Debug, Clone)]
pub struct Slope {
    /// The mesh.
    pub facets: Vec<Facet>,
    /// Height (m) of the surface that the vertices lie on, at x, y (m).
    pub height_m: fn(f64, f64) -> f64,
}

/// A lattice of `cells` (x, y) over `size_m`, draped over `height_m`; x and y from 0.
pub(super) fn drape(size_m: [f64; 2], cells: [usize; 2], height_m: fn(f64, f64) -> f64) -> Slope {
    let facets = triangulate(cells[0] + 1, cells[1] + 1, |i, j| {
        let x = size_m[0] * i as f64 / cells[0] as f64;
        let y = size_m[1] * j as f64 / cells[1] as f64;
        Some(Vec3::new(x, y, height_m(x, y)))
    });
    Slope { facets, height_m }
}

/// `max(s, 0)` with its corner rounded over about `round_m` (m).
pub(super) fn ramp(s_m: f64, round_m: f64) -> f64 {
    0.5 * (s_m + (s_m * s_m + round_m * round_m).sqrt())
}

/// From 0 to 1 as `s` goes from 0 to 1, smooth.
pub(super) fn blend(s: f64) -> f64 {
    fade(s.clamp(0.0, 1.0))
}

/// A natural slope for studies of speed: 300 m wide, 400 m long, 38° down to y = 250 m, then flat.
///
/// Six octaves of gradient noise with wave lengths λ from 64 m to 2 m and amplitudes 0.24 λ^0.8 m (Hurst exponent 0.8),
/// 35 % of it on the flat. All lattices sample the same surface: 61 x 82 cells are 10 004 triangles, 193 x 258 are
/// 99 588, 612 x 817 are 1 000 008.
pub fn natural_slope(cells_across: usize, cells_down: usize) -> Slope {
    drape([300.0, 400.0], [cells_across, cells_down], natural_height_m)
}

fn natural_height_m(x_m: f64, y_m: f64) -> f64 {
    const TAN_38_DEG: f64 = 0.781_285_626_506_717_4;
    /// Wave length and amplitude 0.24 λ^0.8 (m).
    const OCTAVES: [(f64, f64); 6] = [
        (64.0, 6.685_828),
        (32.0, 3.84),
        (16.0, 2.205_501),
        (8.0, 1.266_728),
        (4.0, 0.727_544),
        (2.0, 0.417_864),
    ];
    let rough: f64 = (0u64..)
        .zip(OCTAVES)
        .map(|(octave, (wave_m, amplitude_m))| {
            amplitude_m * gradient(38 + octave, wave_m, x_m, y_m)
        })
        .sum();
    let share = 1.0 - 0.65 * blend((y_m - 230.0) / 60.0);
    TAN_38_DEG * ramp(250.0 - y_m, 10.0) + share * rough
}

/// The slope of the method paper's rockfall example: 10 m high at 45° with humps and hollows of ±0.08 m, a 1 m bench
/// above and 3 m of flat below (the paper prints height and angle; the rest is read off its figure). 6 m wide, 4200
/// triangles.
pub fn paper_slope() -> Slope {
    drape([6.0, 14.0], [30, 70], paper_height_m)
}

fn paper_height_m(x_m: f64, y_m: f64) -> f64 {
    let even = (11.0 - y_m).clamp(0.0, 10.0);
    even + 0.06 * value(15, 1.2, x_m, y_m) + 0.02 * value(16, 0.6, x_m, y_m)
}

/// Four square stems, 0.24 m thick and 3 m high, standing in the paths down the paper's slope.
pub(super) fn paper_trees(slope: &Slope) -> Vec<Facet> {
    [(1.6, 4.0), (4.1, 5.2), (2.7, 7.0), (4.6, 8.6)]
        .into_iter()
        .flat_map(|(x_m, y_m)| {
            square_stem(&Stem { x_m, y_m, dbh_m: 0.24, height_m: 3.0 }, (slope.height_m)(x_m, y_m))
        })
        .collect()
}

/// A small slope to look at: 40 m wide, 60 m long; a bench, a 45° rock face from y = 4 m to 20 m, a 32° talus to
/// y = 40 m, an almost flat meadow; a shallow gully down the middle. 4800 triangles.
pub fn quick_slope() -> Slope {
    drape([40.0, 60.0], [40, 60], quick_height_m)
}

fn quick_height_m(x_m: f64, y_m: f64) -> f64 {
    // Edge and foot of the rock face wander down and up the slope.
    let down_m = y_m + 6.0 * gradient(5, 15.0, x_m, y_m);
    let even = 30.0 - 0.05 * y_m - 0.95 * ramp(down_m - 4.0, 0.6)
        + 0.375 * ramp(down_m - 20.0, 2.0)
        + 0.6 * ramp(down_m - 40.0, 3.0);
    let (rock, talus) = (1.0 - blend((down_m - 18.0) / 4.0), 1.0 - blend((down_m - 38.0) / 6.0));
    let rough = 1.4 * gradient(6, 9.0, x_m, y_m)
        + 0.8 * gradient(7, 4.5, x_m, y_m)
        + 0.45 * gradient(8, 2.2, x_m, y_m);
    let across = (x_m - 20.0) / 5.0;
    let gully = 2.0 / (1.0 + across * across) * blend((down_m - 3.0) / 8.0) * talus;
    even - gully + rough * (0.15 + 0.25 * talus + 0.6 * rock)
}

/// A dozen stems, 0.25 m to 0.6 m thick, on the talus and the meadow of [`quick_slope`].
pub(super) fn quick_trees(slope: &Slope) -> Vec<Facet> {
    const STEMS: [(f64, f64, f64, f64); 12] = [
        (6.5, 27.0, 0.35, 11.0),
        (12.0, 31.5, 0.45, 14.0),
        (16.5, 26.5, 0.25, 8.0),
        (18.0, 36.0, 0.40, 13.0),
        (22.5, 32.0, 0.50, 15.0),
        (24.0, 39.5, 0.30, 10.0),
        (27.5, 28.5, 0.40, 12.0),
        (31.0, 35.0, 0.60, 17.0),
        (34.5, 30.0, 0.35, 11.0),
        (10.0, 40.5, 0.55, 16.0),
        (15.0, 45.0, 0.45, 14.0),
        (28.5, 43.5, 0.50, 15.0),
    ];
    STEMS
        .into_iter()
        .flat_map(|(x_m, y_m, dbh_m, height_m)| {
            stem(&Stem { x_m, y_m, dbh_m, height_m }, (slope.height_m)(x_m, y_m))
        })
        .collect()
}
