//! A triangle with the points and lines that borders draw into it.

use super::borders::before;
use super::{Corner, SNAP_M, side};
use crate::math;
use crate::rock::Vec3;

/// Nodes in one triangle at most: the work grows with their third power.
pub(super) const MOST_NODES: usize = 1000;

/// A point in or on the triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct BorderPoint {
    /// On the map (m).
    pub(super) at: Corner,
    /// In the file.
    pub(super) point: Vec3,
    /// On which edges of the triangle; edge `k` runs from corner `k` to the next.
    pub(super) on: [bool; 3],
}

/// The triangle with the points and lines that borders draw into it.
pub(super) struct BorderedTriangle {
    /// Its corners first.
    pub(super) nodes: Vec<BorderPoint>,
    /// Pieces of borders inside, by their nodes.
    pub(super) lines: Vec<[usize; 2]>,
}

impl BorderedTriangle {
    pub(super) fn of(corners: [(Corner, Vec3); 3]) -> Self {
        let node = |k: usize| {
            let (at, point) = corners[k];
            let mut on = [false; 3];
            (on[k], on[(k + 2) % 3]) = (true, true);
            BorderPoint { at, point, on }
        };
        Self { nodes: vec![node(0), node(1), node(2)], lines: Vec::new() }
    }

    fn corner(&self, k: usize) -> Corner {
        self.nodes[k % 3].at
    }

    /// Draws what of a side of a zone lies in the triangle.
    pub(super) fn draw(&mut self, [p, q]: [Corner; 2]) {
        let mut hits: Vec<(f64, usize)> = Vec::new();
        for (share, end) in [(0.0, p), (1.0, q)] {
            hits.extend(self.inside(end).map(|node| (share, node)));
        }
        for k in 0..3 {
            let (a, b) = (self.corner(k), self.corner(k + 1));
            let (from_a, from_b) = (side(p, q, a), side(p, q, b));
            let (from_p, from_q) = (self.edge_side(k, p), self.edge_side(k, q));
            if opposite(from_a, from_b) && opposite(from_p, from_q) {
                let node = self.crossing(k, [p, q]);
                hits.push((from_p / (from_p - from_q), node));
            }
            let share = share_of([p, q], a);
            if is_zero(from_a) && share > 0.0 && share < 1.0 {
                hits.push((share, k));
            }
        }
        hits.sort_by(|one, other| one.0.total_cmp(&other.0));
        hits.dedup_by_key(|hit| hit.1);
        for pair in hits.windows(2) {
            self.add_line([pair[0].1, pair[1].1]);
        }
    }

    fn add_line(&mut self, [i, j]: [usize; 2]) {
        let line = [i.min(j), i.max(j)];
        // along an edge of the triangle there is a line already
        let along = (0..3).any(|k| self.nodes[i].on[k] && self.nodes[j].on[k]);
        if i != j && !along && !self.lines.contains(&line) {
            self.lines.push(line);
        }
    }

    fn node(&mut self, node: BorderPoint) -> usize {
        let known = self.nodes.iter().position(|known| near(known.at, node.at));
        known.unwrap_or_else(|| {
            self.nodes.push(node);
            self.nodes.len() - 1
        })
    }

    /// The node of a point that lies in the triangle or on its edges.
    fn inside(&mut self, at: Corner) -> Option<usize> {
        if let Some(corner) = (0..3).find(|&k| near(self.corner(k), at)) {
            return Some(corner);
        }
        let from = [0, 1, 2].map(|k| self.edge_side(k, at));
        if from.iter().any(|&area| area < 0.0) {
            return None;
        }
        let on = from.map(is_zero);
        let Some(k) = on.iter().position(|&on| on) else {
            return Some(self.node(BorderPoint { at, point: self.blend(from), on }));
        };
        // snapped onto the edge, at the same place for both of its triangles
        let (low, high) = self.sorted(k);
        let share = share_of([low.at, high.at], at);
        let at = between(low.at, high.at, share);
        Some(self.node(BorderPoint { at, point: low.point + share * (high.point - low.point), on }))
    }

    /// On which side of an edge a place lies, to the same bits for both of its triangles: positive inside.
    fn edge_side(&self, k: usize, at: Corner) -> f64 {
        let (a, b) = (self.corner(k), self.corner(k + 1));
        if before(a, b) { side(a, b, at) } else { -side(b, a, at) }
    }

    /// The point of the file above a place inside; `from` are the areas over the edges.
    fn blend(&self, from: [f64; 3]) -> Vec3 {
        let whole: f64 = from.iter().sum();
        // edge k lies opposite corner k + 2
        (0..3).map(|k| self.nodes[(k + 2) % 3].point * (from[k] / whole)).sum()
    }

    /// Ends of an edge, the same way round for both of its triangles.
    fn sorted(&self, k: usize) -> (BorderPoint, BorderPoint) {
        let (a, b) = (self.nodes[k], self.nodes[(k + 1) % 3]);
        if before(a.at, b.at) { (a, b) } else { (b, a) }
    }

    /// The node at which a side crosses edge `k`.
    fn crossing(&mut self, k: usize, [p, q]: [Corner; 2]) -> usize {
        let (low, high) = self.sorted(k);
        let (from_low, from_high) = (side(p, q, low.at), side(p, q, high.at));
        let share = from_low / (from_low - from_high);
        let at = between(low.at, high.at, share);
        let mut on = [false; 3];
        on[k] = true;
        self.node(BorderPoint { at, point: low.point + share * (high.point - low.point), on })
    }

    /// Breaks lines where they cross each other or run through a node.
    pub(super) fn cross(&mut self) {
        let mut first = 0;
        while first < self.lines.len() {
            let [i, j] = self.lines[first];
            match self.broken_at([i, j], first) {
                Some(node) => {
                    self.lines.swap_remove(first);
                    self.add_line([i, node]);
                    self.add_line([node, j]);
                    first = 0;
                    if self.nodes.len() > MOST_NODES {
                        return;
                    }
                }
                None => first += 1,
            }
        }
    }

    /// A node inside of a line, made where another line crosses it.
    fn broken_at(&mut self, [i, j]: [usize; 2], number: usize) -> Option<usize> {
        let ends = [self.nodes[i].at, self.nodes[j].at];
        let through = |&k: &usize| k != i && k != j && lies_within(ends, self.nodes[k].at);
        if let Some(node) = (0..self.nodes.len()).find(through) {
            return Some(node);
        }
        let crosses = |&other: &usize| {
            let [k, l] = self.lines[other];
            other != number && cross(ends, [self.nodes[k].at, self.nodes[l].at])
        };
        let other = (0..self.lines.len()).find(crosses)?;
        let [k, l] = self.lines[other];
        let (from, to) = (self.nodes[k].at, self.nodes[l].at);
        let (from_i, from_j) = (side(from, to, ends[0]), side(from, to, ends[1]));
        let share = from_i / (from_i - from_j);
        let at = between(ends[0], ends[1], share);
        let [one, two] = [self.nodes[i].point, self.nodes[j].point];
        let made = self.node(BorderPoint { at, point: one + share * (two - one), on: [false; 3] });
        // rounding may have put it on an end: then it breaks nothing
        (made != i && made != j).then(|| {
            if made != k && made != l {
                let at = self.lines.iter().position(|line| *line == [k, l]);
                if let Some(at) = at {
                    self.lines[at] = [k.min(made), k.max(made)];
                    self.add_line([made, l]);
                }
            }
            made
        })
    }
}

/// Whether two places are one.
fn near([ax, ay]: Corner, [bx, by]: Corner) -> bool {
    math::hypot(ax - bx, ay - by) <= SNAP_M
}

/// The place at a share of the way (–).
fn between(from: Corner, to: Corner, share: f64) -> Corner {
    [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
}

fn is_zero(area: f64) -> bool {
    area.abs() <= 0.0
}

/// Whether two places lie strictly on different sides.
fn opposite(one: f64, other: f64) -> bool {
    (one > 0.0 && other < 0.0) || (one < 0.0 && other > 0.0)
}

/// Whether two lines cross at an inner point of both.
pub(super) fn cross([a, b]: [Corner; 2], [c, d]: [Corner; 2]) -> bool {
    opposite(side(a, b, c), side(a, b, d)) && opposite(side(c, d, a), side(c, d, b))
}

/// Whether a point lies on a line, between its ends.
pub(super) fn lies_within([a, b]: [Corner; 2], p: Corner) -> bool {
    let share = share_of([a, b], p);
    is_zero(side(a, b, p)) && share > 0.0 && share < 1.0
}

/// Where along a line a point on it lies (–), measured on the longer axis.
fn share_of([a, b]: [Corner; 2], p: Corner) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    if x.abs() >= y.abs() { (p[0] - a[0]) / x } else { (p[1] - a[1]) / y }
}
