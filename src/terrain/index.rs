//! The spatial index: parry3d's bounding-volume tree, packed into two cache lines a node.
//!
//! parry builds the tree (binned surface-area heuristic). A rock's query reads it millions of times, so it is
//! then packed: four child boxes a node in `f32`, rounded outwards, and up to four triangles a leaf. Triangles
//! are renumbered in tree order, so that neighbours in space are neighbours in memory.

use crate::rock::Vec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};
use wide::f32x4;

/// Most triangles in one leaf.
const LEAF: u32 = 4;
const LEAF_BIT: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const START_MASK: u32 = (1 << COUNT_SHIFT) - 1;

/// Most triangles an index can hold.
pub const MAX_TRIANGLES: usize = START_MASK as usize;

/// Children of a node.
const WIDE: usize = 4;

/// Up to four child boxes (m, rounded outwards) and where the children are.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct Node {
    /// Lower corners, axis by axis: all four boxes are tested at once.
    pub lo: [f32x4; 3],
    /// Upper corners.
    pub hi: [f32x4; 3],
    child: [u32; WIDE],
}

/// What a child is.
#[derive(Debug, Clone, Copy)]
pub enum Child {
    /// Another node.
    Inner(u32),
    /// Triangles `start .. start + count`.
    Leaf(u32, u32),
}

impl Child {
    /// What the word of a child says.
    #[inline]
    pub fn of(word: u32) -> Self {
        if word & LEAF_BIT == 0 {
            Self::Inner(word)
        } else {
            Self::Leaf(word & START_MASK, ((word & !LEAF_BIT) >> COUNT_SHIFT) + 1)
        }
    }
}

impl Node {
    /// Without children: boxes that nothing ever meets.
    const EMPTY: Self = Self {
        lo: [f32x4::new([f32::MAX; WIDE]); 3],
        hi: [f32x4::new([f32::MAX; WIDE]); 3],
        child: [LEAF_BIT; WIDE],
    };

    /// The word of a child, see [`Child::of`].
    #[inline]
    pub fn word(&self, side: usize) -> u32 {
        self.child[side]
    }

    fn put(&mut self, side: usize, word: u32, (lo, hi): (&Vec3, &Vec3)) {
        self.child[side] = word;
        for k in 0..3 {
            self.lo[k].as_mut_array()[side] = below(lo[k]);
            self.hi[k].as_mut_array()[side] = above(hi[k]);
        }
    }

    /// Bits of the children whose boxes share a point with the box from `lo` to `hi`.
    #[inline]
    fn meets(&self, (lo, hi): (&[f32x4; 3], &[f32x4; 3])) -> u32 {
        let apart = |k: usize| self.lo[k].simd_le(hi[k]) & lo[k].simd_le(self.hi[k]);
        (apart(0) & apart(1) & apart(2)).to_bitmask()
    }
}

/// The packed tree. Triangle numbers are positions in the order that [`Index::build`] returns.
#[derive(Debug, Default)]
pub struct Index {
    nodes: Vec<Node>,
    lo: Vec3,
    hi: Vec3,
}

/// Deepest tree that a traversal can walk. Every level halves what a bin of centres spans or the triangles, and a node
/// holds two levels or more: 2²⁸ triangles stay far below.
const DEPTH: usize = 56;
/// Children that wait during a traversal, at most.
pub const WAITING: usize = (WIDE - 1) * DEPTH + 1;

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
        let mut index = Self { nodes: Vec::new(), lo: root.lo, hi: root.hi };
        let mut order = Vec::with_capacity(root.count as usize);
        let depth = index.pack(&loose, 0, &mut order);
        assert!(depth <= DEPTH, "the index of the mesh has {depth} levels");
        (index, order)
    }

    /// Packs what is below a node, in the order of the tree; returns how deep it is.
    fn pack(&mut self, loose: &[Loose], top: u32, order: &mut Vec<u32>) -> usize {
        let place = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut depth = 0;
        for (side, child) in widest(loose, top).enumerate() {
            let from = &loose[child as usize];
            let word = if from.count <= LEAF {
                let start = order.len() as u32;
                gather(loose, child, order);
                LEAF_BIT | ((from.count - 1) << COUNT_SHIFT) | start
            } else {
                let next = self.nodes.len() as u32;
                depth = depth.max(self.pack(loose, child, order));
                next
            };
            self.nodes[place].put(side, word, (&from.lo, &from.hi));
        }
        depth + 1
    }

    /// The nodes; the first is the root. Empty when there is no triangle.
    #[inline]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Lower and upper corner of all triangles (m).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        (self.lo, self.hi)
    }

    /// Calls `visit(start, count)` for every leaf whose box comes nearer than `radius` to `centre` along every axis.
    #[inline]
    pub fn near(&self, centre: &Vec3, radius: f64, visit: impl FnMut(u32, u32)) {
        let lo = [0, 1, 2].map(|k| below(centre[k] - radius));
        let hi = [0, 1, 2].map(|k| above(centre[k] + radius));
        self.walk((lo, hi), visit);
    }

    /// Calls `visit(start, count)` for every leaf whose box the vertical through (x, y) meets not above `under` (m).
    #[inline]
    pub fn along_vertical(&self, (x, y): (f64, f64), under: f64, visit: impl FnMut(u32, u32)) {
        let lo = [below(x), below(y), f32::NEG_INFINITY];
        let hi = [above(x), above(y), above(under)];
        self.walk((lo, hi), visit);
    }

    #[inline]
    fn walk(&self, (lo, hi): ([f32; 3], [f32; 3]), mut visit: impl FnMut(u32, u32)) {
        if self.nodes.is_empty() {
            return;
        }
        let (lo, hi) = (lo.map(f32x4::splat), hi.map(f32x4::splat));
        let mut stack = [0u32; WAITING];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let node = &self.nodes[stack[top] as usize];
            let mut meets = node.meets((&lo, &hi));
            while meets != 0 {
                match Child::of(node.child[meets.trailing_zeros() as usize % WIDE]) {
                    Child::Inner(next) => {
                        stack[top] = next;
                        top += 1;
                    }
                    Child::Leaf(start, count) => visit(start, count),
                }
                meets &= meets - 1;
            }
        }
    }
}

/// The children that a packed node takes below a node of the tree, from left to right: of what it has, the largest box is
/// opened as long as there is room.
fn widest(loose: &[Loose], top: u32) -> impl Iterator<Item = u32> {
    let area = |node: u32| {
        let size = loose[node as usize].hi - loose[node as usize].lo;
        size.x * size.y + size.y * size.z + size.z * size.x
    };
    let mut taken = [top; WIDE];
    let mut count = 1;
    while count < WIDE {
        let open = (0..count).filter(|&k| loose[taken[k] as usize].count > LEAF);
        let Some(largest) = open.max_by(|&a, &b| area(taken[a]).total_cmp(&area(taken[b]))) else {
            break;
        };
        let children = loose[taken[largest] as usize].children;
        taken.copy_within(largest + 1..count, largest + 2);
        (taken[largest], taken[largest + 1]) = (children[0], children[1]);
        count += 1;
    }
    taken.into_iter().take(count)
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
pub(crate) fn below(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x { near.next_down() } else { near }
}

/// Smallest `f32` not below `x`.
pub(crate) fn above(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}
