//! Triangles between given points that keep given lines: the shortest further lines first, as long as none crosses another
//! (greedy triangulation). Slow for many points and simple for the few that lie in one triangle of a slope.

use super::drawing::{BorderedTriangle, cross, lies_within};
use super::{Corner, side};

/// All triangles of a drawing, anticlockwise, by their nodes.
pub(super) fn triangulate(drawing: &BorderedTriangle) -> Vec<[usize; 3]> {
    let mut graph =
        Graph { at: drawing.nodes.iter().map(|node| node.at).collect(), lines: Vec::new() };
    for k in 0..3 {
        graph.lines.extend(outline(drawing, k));
    }
    graph.lines.extend(&drawing.lines);
    for line in candidates(drawing) {
        if graph.takes(line) {
            graph.lines.push(line);
        }
    }
    graph.faces()
}

/// The pieces of an edge of the triangle between its nodes.
fn outline(drawing: &BorderedTriangle, k: usize) -> Vec<[usize; 2]> {
    let (a, b) = (drawing.nodes[k].at, drawing.nodes[(k + 1) % 3].at);
    let along = |node: &usize| {
        let at = drawing.nodes[*node].at;
        (at[0] - a[0]) * (b[0] - a[0]) + (at[1] - a[1]) * (b[1] - a[1])
    };
    let mut nodes: Vec<usize> =
        (0..drawing.nodes.len()).filter(|&node| drawing.nodes[node].on[k]).collect();
    nodes.sort_by(|one, other| along(one).total_cmp(&along(other)));
    nodes.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]).collect()
}

/// Pairs of nodes that do not lie on one edge, the nearest first.
fn candidates(drawing: &BorderedTriangle) -> Vec<[usize; 2]> {
    let nodes = &drawing.nodes;
    let apart = |i: usize, j: usize| !(0..3).any(|k| nodes[i].on[k] && nodes[j].on[k]);
    let pairs = (0..nodes.len()).flat_map(|i| (i + 1..nodes.len()).map(move |j| [i, j]));
    let mut pairs: Vec<[usize; 2]> =
        pairs.filter(|&[i, j]| apart(i, j) && !drawing.lines.contains(&[i, j])).collect();
    let length = |[i, j]: [usize; 2]| {
        let (a, b) = (nodes[i].at, nodes[j].at);
        (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)
    };
    pairs.sort_by(|&one, &other| length(one).total_cmp(&length(other)).then(one.cmp(&other)));
    pairs
}

struct Graph {
    at: Vec<Corner>,
    lines: Vec<[usize; 2]>,
}

impl Graph {
    fn ends(&self, [i, j]: [usize; 2]) -> [Corner; 2] {
        [self.at[i], self.at[j]]
    }

    /// Whether a line crosses none and runs through no node.
    fn takes(&self, line: [usize; 2]) -> bool {
        let ends = self.ends(line);
        let through = |k: usize| !line.contains(&k) && lies_within(ends, self.at[k]);
        !self.lines.iter().any(|&other| cross(ends, self.ends(other)))
            && !(0..self.at.len()).any(through)
    }

    /// The triangles that no line divides.
    fn faces(&self) -> Vec<[usize; 3]> {
        let mut next: Vec<Vec<usize>> = vec![Vec::new(); self.at.len()];
        for &[i, j] in &self.lines {
            next[i].push(j);
            next[j].push(i);
        }
        let mut faces = Vec::new();
        for i in 0..self.at.len() {
            for &j in next[i].iter().filter(|&&j| j > i) {
                for &k in next[j].iter().filter(|&&k| k > i && next[i].contains(&k)) {
                    let face = [i, j, k];
                    if side(self.at[i], self.at[j], self.at[k]) > 0.0 && self.is_empty(face) {
                        faces.push(face);
                    }
                }
            }
        }
        faces
    }

    fn is_empty(&self, [i, j, k]: [usize; 3]) -> bool {
        let [a, b, c] = [self.at[i], self.at[j], self.at[k]];
        let holds = |p: Corner| side(a, b, p) > 0.0 && side(b, c, p) > 0.0 && side(c, a, p) > 0.0;
        !(0..self.at.len()).any(|n| n != i && n != j && n != k && holds(self.at[n]))
    }
}
