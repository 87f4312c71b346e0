//! Contour lines of a grid of numbers (marching squares), joined to long lines.

use super::svg::path::Spot;
use std::collections::BTreeMap;

/// Numbers on a square grid; row by row. NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Place of the first number.
    pub origin: Spot,
    /// Distance between neighbours.
    pub spacing: f64,
    /// Numbers in a row.
    pub columns: usize,
    /// The numbers.
    pub values: Vec<f64>,
}

impl Field {
    /// Takes `value(x, y)` at `columns` × `rows` places.
    pub fn sample(
        origin: Spot,
        spacing: f64,
        (columns, rows): (usize, usize),
        value: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let at = |i: usize| {
            let (column, row) = ((i % columns) as f64, (i / columns) as f64);
            value(origin.0 + column * spacing, origin.1 + row * spacing)
        };
        Self { origin, spacing, columns, values: (0..columns * rows).map(at).collect() }
    }

    fn rows(&self) -> usize {
        self.values.len() / self.columns.max(1)
    }

    fn get(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    fn place(&self, column: f64, row: f64) -> Spot {
        (self.origin.0 + column * self.spacing, self.origin.1 + row * self.spacing)
    }

    /// The lines on which the field equals `level`. Closed lines end where they begin.
    pub fn lines_at(&self, level: f64) -> Vec<Vec<Spot>> {
        let mut net = Net::default();
        for row in 0..self.rows().saturating_sub(1) {
            for column in 0..self.columns.saturating_sub(1) {
                self.cross_cell(column, row, level, &mut net);
            }
        }
        let place = |crossing: &GridCrossing| self.place_of(*crossing, level);
        net.chains().iter().map(|chain| chain.iter().map(place).collect()).collect()
    }

    /// Adds the line pieces within one cell.
    fn cross_cell(&self, column: usize, row: usize, level: f64, net: &mut Net) {
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let z = corners.map(|(dc, dr)| self.get(column + dc, row + dr));
        if z.iter().any(|z| z.is_nan()) {
            return;
        }
        let is_above = z.map(|z| z >= level);
        // edges of the cell: lower, right, upper, left
        let edges: [GridCrossing; 4] = [
            (row, column, false),
            (row, column + 1, true),
            (row + 1, column, false),
            (row, column, true),
        ];
        let crossed: Vec<GridCrossing> =
            (0..4).filter(|&i| is_above[i] != is_above[(i + 1) % 4]).map(|i| edges[i]).collect();
        match crossed[..] {
            [a, b] => net.join(a, b),
            [lower, right, upper, left] => {
                // a saddle: the mean decides which two corners belong together
                let mean_is_above = z.iter().sum::<f64>() >= 4.0 * level;
                if mean_is_above == is_above[0] {
                    net.join(lower, right);
                    net.join(upper, left);
                } else {
                    net.join(lower, left);
                    net.join(right, upper);
                }
            }
            _ => {}
        }
    }

    fn place_of(&self, (row, column, is_upright): GridCrossing, level: f64) -> Spot {
        let (c, r) = (column as f64, row as f64);
        let from = self.get(column, row);
        let to = if is_upright { self.get(column, row + 1) } else { self.get(column + 1, row) };
        let t = ((level - from) / (to - from)).clamp(0.0, 1.0);
        if is_upright { self.place(c, r + t) } else { self.place(c + t, r) }
    }
}

/// Where a line passes an edge of the grid: row, column, and whether the edge runs along the column.
type GridCrossing = (usize, usize, bool);

/// Line pieces by the crossings they join; each crossing has one or two neighbours.
#[derive(Default)]
struct Net {
    neighbours: BTreeMap<GridCrossing, [Option<GridCrossing>; 2]>,
}

impl Net {
    fn join(&mut self, a: GridCrossing, b: GridCrossing) {
        for (here, there) in [(a, b), (b, a)] {
            let slots = self.neighbours.entry(here).or_default();
            let free = usize::from(slots[0].is_some());
            slots[free] = Some(there);
        }
    }

    /// All lines: open ones from an end, then the closed ones.
    fn chains(mut self) -> Vec<Vec<GridCrossing>> {
        let ends = self.neighbours.iter().filter(|(_, slots)| slots[1].is_none());
        let mut starts: Vec<GridCrossing> = ends.map(|(&crossing, _)| crossing).collect();
        starts.extend(self.neighbours.keys().copied().collect::<Vec<_>>());
        let mut chains = Vec::new();
        for start in starts {
            if self.neighbours.contains_key(&start) {
                chains.push(self.follow(start));
            }
        }
        chains
    }

    fn follow(&mut self, start: GridCrossing) -> Vec<GridCrossing> {
        let mut chain = vec![start];
        let mut here = start;
        while let Some(slots) = self.neighbours.remove(&here) {
            let next = slots.into_iter().flatten().find(|n| self.neighbours.contains_key(n));
            match next {
                Some(next) => chain.push(next),
                // back at the start of a closed line
                None if chain.len() > 2 && slots.contains(&Some(start)) => chain.push(start),
                None => break,
            }
            here = chain[chain.len() - 1];
        }
        chain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a cone of slope 1 the contour of height 10 − r is a circle of radius r. A chord between grid points is off by
    /// at most spacing²/(8 r), linear interpolation along an edge by as much again.
    #[test]
    fn contours_of_a_cone_are_circles() {
        let spacing = 0.1;
        let cone = Field::sample((-6.0, -6.0), spacing, (121, 121), |x, y| 10.0 - x.hypot(y));
        for radius in [1.0, 2.03, 5.0] {
            let lines = cone.lines_at(10.0 - radius);
            assert_eq!(lines.len(), 1, "one circle, one line");
            let line = &lines[0];
            assert_eq!(line.first(), line.last(), "a circle is closed");
            let worst = line.iter().map(|&(x, y)| (x.hypot(y) - radius).abs()).fold(0.0, f64::max);
            assert!(worst <= spacing * spacing / (4.0 * radius), "radius {radius}: {worst}");
            let length: f64 =
                line.windows(2).map(|s| (s[1].0 - s[0].0).hypot(s[1].1 - s[0].1)).sum();
            assert!((length / (2.0 * std::f64::consts::PI * radius) - 1.0).abs() < 0.01);
        }
    }

    /// A plane cut off by missing ground gives open lines that stop there.
    #[test]
    fn lines_stop_where_the_ground_stops() {
        let plane = Field::sample((0.0, 0.0), 1.0, (21, 21), |x, y| {
            if (8.0..12.0).contains(&y) { f64::NAN } else { x }
        });
        let lines = plane.lines_at(7.5);
        assert_eq!(lines.len(), 2);
        assert!(lines.iter().flatten().all(|&(x, _)| (x - 7.5).abs() < 1e-12));
    }

    /// Two high corners face each other. Below the mean height the ridge between them holds together and the lines cut off the low corners; above
    /// the mean the lines cut off the high ones.
    #[test]
    fn the_mean_decides_a_saddle() {
        let values = vec![1.0, 0.0, 0.0, 1.0];
        let saddle = Field { origin: (0.0, 0.0), spacing: 1.0, columns: 2, values };
        for (level, cut_off_is_low) in [(0.4, true), (0.6, false)] {
            let lines = saddle.lines_at(level);
            assert_eq!(lines.len(), 2);
            for line in lines {
                // high corners lie on the diagonal x = y
                let off_diagonal = (line[0].0 + line[1].0 - line[0].1 - line[1].1).abs();
                assert_eq!(off_diagonal > 0.5, cut_off_is_low, "{level}: {line:?}");
            }
        }
        assert!(saddle.lines_at(2.0).is_empty());
    }
}
