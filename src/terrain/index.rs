//! The spatial index: parry3d's bounding-volume tree, packed into two cache lines a node.
//!
//! parry builds the tree (binned surface-area heuristic). A rock's query reads it millions of times, so it is
//! then packed: four child boxes a node in `f32`, rounded outwards, and up to three triangles a leaf. Triangles
//! are renumbered in tree order, so that neighbours in space are neighbours in memory.

use crate::rock::Vec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};
use wide::f32x4;

/// Most triangles in one leaf: four boxes at once are cheaper than the triangles that smaller ones leave out.
const LEAF: u32 = 3;
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

/// Most triangles that one tree of parry's is built over: it takes about 300 bytes for each until it is packed.
const AT_ONCE: usize = 1 << 21;

/// Triangles that stand side by side in the index, by their numbers in the input.
struct Part<'a> {
    /// Place of the first one in the index.
    start: u32,
    triangles: &'a mut [u32],
}

impl<'a> Part<'a> {
    /// Cut across the middle of the side along which the centres lie widest apart; as many triangles in both, and the same
    /// ones whatever order they come in.
    fn halves(self, corners: &impl Fn(u32) -> [Vec3; 3]) -> [Self; 2] {
        let centre = |t: u32| corners(t).iter().sum::<Vec3>();
        let first = centre(self.triangles[0]);
        let (lo, hi) = self
            .triangles
            .iter()
            .map(|&t| centre(t))
            .fold((first, first), |(lo, hi), at| (lo.inf(&at), hi.sup(&at)));
        let axis = (hi - lo).imax();
        let middle = self.triangles.len() / 2;
        self.triangles.select_nth_unstable_by(middle, |&a, &b| {
            centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b))
        });
        let (low, high) = self.triangles.split_at_mut(middle);
        let next = self.start + middle as u32;
        [Part { start: self.start, triangles: low }, Part { start: next, triangles: high }]
    }
}

/// What was packed: its levels and its box (m).
struct Packed {
    depth: usize,
    lo: Vec3,
    hi: Vec3,
}

impl Packed {
    const NOTHING: Self = Self {
        depth: 0,
        lo: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        hi: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    fn and(&self, other: &Self) -> Self {
        Self {
            depth: self.depth.max(other.depth),
            lo: self.lo.inf(&other.lo),
            hi: self.hi.sup(&other.hi),
        }
    }
}

/// Leaves of a tree from left to right; the first stands at `start` of the index.
struct Order {
    start: u32,
    leaves: Vec<u32>,
}

struct Loose {
    lo: Vec3,
    hi: Vec3,
    leaf: Option<u32>,
    children: [u32; 2],
    count: u32,
}

impl Index {
    /// Builds the index over `count` triangles given by their corners, and the order in which it wants them.
    ///
    /// `order[k]` is the number that triangle `k` of the index had in the input.
    ///
    /// # Panics
    /// If the tree were deeper than a traversal can walk, which no mesh makes it.
    pub fn build(count: usize, corners: impl Fn(u32) -> [Vec3; 3]) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..count as u32).collect();
        if count == 0 {
            return (Self::default(), order);
        }
        let mut index = Self::default();
        let whole = Part { start: 0, triangles: &mut order };
        let Packed { depth, lo, hi } = index.pack_part(whole, &corners);
        assert!(depth <= DEPTH, "the index of the mesh has {depth} levels");
        (index.lo, index.hi) = (lo, hi);
        (index, order)
    }

    /// Packs a part of the triangles and puts them into the order of the tree. What is too large for one tree of parry's is
    /// cut into four first.
    fn pack_part(&mut self, part: Part, corners: &impl Fn(u32) -> [Vec3; 3]) -> Packed {
        let Part { start, triangles } = part;
        if triangles.len() <= AT_ONCE {
            return self.pack_at_once(Part { start, triangles }, corners);
        }
        let place = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let [west, east] = Part { start, triangles }.halves(corners);
        let quarters = west.halves(corners).into_iter().chain(east.halves(corners));
        let mut whole = Packed::NOTHING;
        for (side, quarter) in quarters.enumerate() {
            let word = self.nodes.len() as u32;
            let packed = self.pack_part(quarter, corners);
            self.nodes[place].put(side, word, (&packed.lo, &packed.hi));
            whole = whole.and(&packed);
        }
        whole.depth += 1;
        whole
    }

    /// The same with one tree of parry's.
    fn pack_at_once(&mut self, part: Part, corners: &impl Fn(u32) -> [Vec3; 3]) -> Packed {
        let Part { start, triangles } = part;
        // The tree may depend on the order in which it is given triangles, and selecting leaves an order of its own.
        triangles.sort_unstable();
        let boxes: Vec<Aabb> = triangles.iter().map(|&t| box_of(corners(t))).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        drop(boxes);
        let mut loose = unroll(&tree);
        drop(tree);
        count_leaves(&mut loose);
        let (lo, hi) = (loose[0].lo, loose[0].hi);
        let mut order = Order { start, leaves: Vec::with_capacity(triangles.len()) };
        let depth = self.pack(&loose, 0, &mut order);
        let sorted = triangles.to_vec();
        for (triangle, leaf) in triangles.iter_mut().zip(order.leaves) {
            *triangle = sorted[leaf as usize];
        }
        Packed { depth, lo, hi }
    }

    /// Packs what is below a node, in the order of the tree; returns how deep it is.
    fn pack(&mut self, loose: &[Loose], top: u32, order: &mut Order) -> usize {
        let place = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut depth = 0;
        for (side, child) in widest(loose, top).enumerate() {
            let from = &loose[child as usize];
            let word = if from.count <= LEAF {
                let start = order.start + order.leaves.len() as u32;
                gather(loose, child, &mut order.leaves);
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

fn box_of([a, b, c]: [Vec3; 3]) -> Aabb {
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
