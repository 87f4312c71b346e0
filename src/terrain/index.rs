//! The spatial index: parry3d's bounding-volume tree, packed into one cache line a node.
//!
//! parry builds the tree (binned surface-area heuristic). A rock's query reads it millions of times, so it is
//! then packed: two child boxes a node in `f32`, rounded outwards, and up to four triangles a leaf. Triangles
//! are renumbered in tree order, so that neighbours in space are neighbours in memory.

use crate::rock::Vec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};

/// Most triangles in one leaf.
const LEAF: u32 = 4;
const LEAF_BIT: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const START_MASK: u32 = (1 << COUNT_SHIFT) - 1;

/// Most triangles an index can hold.
pub const MAX_TRIANGLES: usize = START_MASK as usize;

/// Two child boxes (m, rounded outwards) and where the children are.
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    /// Lower corners, axis by axis of the left and the right box: both are clipped at once.
    pub lo: [[f32; 2]; 3],
    /// Upper corners.
    pub hi: [[f32; 2]; 3],
    child: [u32; 2],
}

/// What a child is.
#[derive(Debug, Clone, Copy)]
pub enum Child {
    /// Another pair.
    Inner(u32),
    /// Triangles `start .. start + count`.
    Leaf(u32, u32),
}

impl Pair {
    /// What the left (0) or right (1) child is.
    #[inline]
    pub fn child(&self, side: usize) -> Child {
        let word = self.child[side];
        if word & LEAF_BIT == 0 {
            Child::Inner(word)
        } else {
            Child::Leaf(word & START_MASK, ((word & !LEAF_BIT) >> COUNT_SHIFT) + 1)
        }
    }

    /// Whether a child's box and the box from `lo` to `hi` share a point.
    #[inline]
    fn meets(&self, side: usize, (lo, hi): (&[f32; 3], &[f32; 3])) -> bool {
        (0..3).all(|k| self.lo[k][side] <= hi[k] && lo[k] <= self.hi[k][side])
    }
}

/// The packed tree. Triangle numbers are positions in the order that [`Index::build`] returns.
#[derive(Debug, Default)]
pub struct Index {
    pairs: Vec<Pair>,
    lo: Vec3,
    hi: Vec3,
}

/// Deepest tree that a traversal can walk; a binned tree over 2²⁸ triangles stays far below.
pub const DEPTH: usize = 128;

struct Loose {
    lo: Vec3,
    hi: Vec3,
    leaf: Option<u32>,
    children: [u32; 2],
    count: u32,
}

impl Index {
    /// Builds the index over triangles given by their corners, and the order in which it wants them.
    ///
    /// `order[k]` is the number that triangle `k` of the index had in the input.
    pub fn build(corners: impl Iterator<Item = [Vec3; 3]>) -> (Self, Vec<u32>) {
        let boxes: Vec<Aabb> = corners.map(|[a, b, c]| box_of(a, b, c)).collect();
        if boxes.is_empty() {
            return (Self::default(), Vec::new());
        }
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        drop(boxes);
        let mut loose = unroll(&tree);
        drop(tree);
        count_leaves(&mut loose);
        let root = &loose[0];
        let mut index = Self { pairs: Vec::new(), lo: root.lo, hi: root.hi };
        let mut order = Vec::with_capacity(root.count as usize);
        index.pack(&loose, &mut order);
        (index, order)
    }

    fn pack(&mut self, loose: &[Loose], order: &mut Vec<u32>) {
        let whole = &loose[0];
        let top = if whole.count <= LEAF { [0, 0] } else { whole.children };
        self.pairs.push(Pair { lo: [[0.0; 2]; 3], hi: [[0.0; 2]; 3], child: [0; 2] });
        // A tree of one leaf still gets a pair: its right box is empty.
        let sides = if whole.count <= LEAF { 1 } else { 2 };
        let mut stack: Vec<(u32, usize, u32)> =
            (0..sides).rev().map(|side| (0, side, top[side])).collect();
        if sides == 1 {
            for k in 0..3 {
                (self.pairs[0].lo[k][1], self.pairs[0].hi[k][1]) = (f32::MAX, f32::MAX);
            }
            self.pairs[0].child[1] = LEAF_BIT;
        }
        while let Some((pair, side, node)) = stack.pop() {
            let from = &loose[node as usize];
            let word = if from.count <= LEAF {
                let start = order.len() as u32;
                gather(loose, node, order);
                LEAF_BIT | ((from.count - 1) << COUNT_SHIFT) | start
            } else {
                let next = self.pairs.len() as u32;
                self.pairs.push(Pair { lo: [[0.0; 2]; 3], hi: [[0.0; 2]; 3], child: [0; 2] });
                stack.push((next, 1, from.children[1]));
                stack.push((next, 0, from.children[0]));
                next
            };
            let to = &mut self.pairs[pair as usize];
            to.child[side] = word;
            for k in 0..3 {
                (to.lo[k][side], to.hi[k][side]) = (below(from.lo[k]), above(from.hi[k]));
            }
        }
    }

    /// The pairs; the first is the root. Empty when there is no triangle.
    #[inline]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Lower and upper corner of all triangles (m).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        (self.lo, self.hi)
    }

    /// Calls `visit(start, count)` for every leaf whose box comes nearer than `radius` to `centre` along every axis.
    #[inline]
    pub fn near(&self, centre: &Vec3, radius: f64, mut visit: impl FnMut(u32, u32)) {
        let lo = [0, 1, 2].map(|k| below(centre[k] - radius));
        let hi = [0, 1, 2].map(|k| above(centre[k] + radius));
        self.walk(|pair, side| pair.meets(side, (&lo, &hi)), &mut visit);
    }

    /// Calls `visit(start, count)` for every leaf whose box the vertical through (x, y) meets.
    #[inline]
    pub fn along_vertical(&self, x: f64, y: f64, mut visit: impl FnMut(u32, u32)) {
        let lo = [below(x), below(y), f32::NEG_INFINITY];
        let hi = [above(x), above(y), f32::INFINITY];
        self.walk(|pair, side| pair.meets(side, (&lo, &hi)), &mut visit);
    }

    #[inline]
    fn walk(&self, wanted: impl Fn(&Pair, usize) -> bool, visit: &mut impl FnMut(u32, u32)) {
        if self.pairs.is_empty() {
            return;
        }
        let mut stack = [0u32; DEPTH];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let pair = &self.pairs[stack[top] as usize];
            for side in [1, 0] {
                if wanted(pair, side) {
                    match pair.child(side) {
                        Child::Inner(next) => {
                            stack[top] = next;
                            top += 1;
                        }
                        Child::Leaf(start, count) => visit(start, count),
                    }
                }
            }
        }
    }
}

fn box_of(a: Vec3, b: Vec3, c: Vec3) -> Aabb {
    let (lo, hi) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
    Aabb::new(Vector::from(lo), Vector::from(hi))
}

/// The tree's nodes in an order in which parents come before children.
///
/// `traverse` visits both children of a node before it goes down, the left one first.
fn unroll(tree: &Bvh) -> Vec<Loose> {
    let whole = tree.root_aabb();
    let mut nodes = vec![Loose {
        lo: whole.mins.into(),
        hi: whole.maxs.into(),
        leaf: None,
        children: [0; 2],
        count: 0,
    }];
    tree.traverse(|node| {
        nodes.push(Loose {
            lo: node.mins().into(),
            hi: node.maxs().into(),
            leaf: node.leaf_data(),
            children: [0; 2],
            count: 0,
        });
        TraversalAction::Continue
    });
    if nodes.len() == 2 {
        nodes.remove(0);
        return nodes;
    }
    let mut waiting = vec![0];
    let mut next = 1;
    while let Some(parent) = waiting.pop() {
        nodes[parent].children = [next as u32, next as u32 + 1];
        waiting.extend([next + 1, next].into_iter().filter(|&k| nodes[k].leaf.is_none()));
        next += 2;
    }
    nodes
}

fn count_leaves(nodes: &mut [Loose]) {
    for k in (0..nodes.len()).rev() {
        nodes[k].count = match nodes[k].leaf {
            Some(_) => 1,
            None => nodes[k].children.iter().map(|&child| nodes[child as usize].count).sum(),
        };
    }
}

fn gather(nodes: &[Loose], top: u32, order: &mut Vec<u32>) {
    match nodes[top as usize].leaf {
        Some(triangle) => order.push(triangle),
        None => nodes[top as usize].children.iter().for_each(|&child| gather(nodes, child, order)),
    }
}

/// Largest `f32` not above `x`.
fn below(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x { near.next_down() } else { near }
}

/// Smallest `f32` not below `x`.
fn above(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}
