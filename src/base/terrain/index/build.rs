//! Building the index: trees of parry's, packed.

use super::runs::{PlacedTriangle, Run};
use super::{BvhNode, COUNT_SHIFT, Child, DEPTH, Index, LEAF, LEAF_BIT, MOST_IN_LEAF, WIDE};
use crate::parallel;
use crate::rock::Vec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// How an index is built: triangles in a leaf, and in one tree of parry's, which takes about 300 bytes for each until it is
/// packed.
#[derive(Debug, Clone, Copy)]
pub(in crate::terrain) struct Sizes {
    leaf: u32,
    at_once: usize,
}

impl Sizes {
    /// For the fastest rocks.
    pub(in crate::terrain) const FAST: Self = Self { leaf: LEAF, at_once: 1 << 19 };
    /// For the least memory and the shortest building: halving a part costs less than the same levels of a tree of parry's.
    pub(in crate::terrain) const SMALL: Self = Self { leaf: MOST_IN_LEAF, at_once: 1 << 13 };
}

/// Triangles in trees of parry's that wait to be put together, at most.
const WAITING_TRIANGLES: usize = 1 << 21;

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
    pub(in crate::terrain) fn build(
        count: usize,
        Sizes { leaf, at_once }: Sizes,
        corners: impl Fn(u32) -> [Vec3; 3] + Sync,
    ) -> (Self, Vec<u32>) {
        if count == 0 {
            return (Self::default(), Vec::new());
        }
        let mut placed = parallel::map(count, |t| PlacedTriangle::of(t as u32, &corners));
        let mut index = Self::default();
        let whole = Run { start: 0, triangles: &mut placed, above: None };
        let (mut parts, levels) = index.share_out(whole, at_once);
        let mut whole = Packed::NOTHING;
        let beside = (WAITING_TRIANGLES / at_once).max(1);
        while !parts.is_empty() {
            let some: Vec<Run> = parts.drain(..beside.min(parts.len())).collect();
            let above: Vec<_> = some.iter().map(|part| part.above).collect();
            let packed = some.into_par_iter().map(|part| Tree::pack(part, &corners, leaf));
            for ((tree, packed), above) in packed.collect::<Vec<_>>().into_iter().zip(above) {
                index.hang(tree, above, &packed);
                whole = whole.and(&packed);
            }
        }
        let depth = levels + whole.depth;
        assert!(depth <= DEPTH, "the index of the mesh has {depth} levels");
        (index.lo, index.hi) = (whole.lo, whole.hi);
        index.close_boxes();
        index.nodes.shrink_to_fit();
        (index, parallel::map(placed.len(), |place| placed[place].triangle))
    }

    /// Cuts what is too large for one tree of parry's into four, and those again; gives the parts and the levels above them.
    fn share_out<'a>(&mut self, whole: Run<'a>, at_once: usize) -> (Vec<Run<'a>>, usize) {
        let (mut ready, mut open, mut levels) = (Vec::new(), vec![whole], 0);
        loop {
            let (large, small): (Vec<Run>, Vec<Run>) =
                open.into_iter().partition(|part| part.triangles.len() > at_once);
            ready.extend(small);
            if large.is_empty() {
                ready.sort_unstable_by_key(|part| part.start);
                return (ready, levels);
            }
            levels += 1;
            let first = self.nodes.len();
            for part in &large {
                let place = self.nodes.len() as u32;
                self.nodes.push(BvhNode::EMPTY);
                if let Some((node, side)) = part.above {
                    self.nodes[node].child[side] = place;
                }
            }
            let quarters: Vec<_> = large.into_par_iter().map(Run::quarters).collect();
            let below = quarters.into_iter().enumerate().flat_map(|(k, quarters)| {
                let hung = move |(side, part)| Run { above: Some((first + k, side)), ..part };
                quarters.into_iter().enumerate().map(hung)
            });
            open = below.collect();
        }
    }

    /// Adds the nodes of a part's tree, and notes where they are and their box.
    fn hang(&mut self, tree: Tree, above: Option<(usize, usize)>, packed: &Packed) {
        let first = self.nodes.len() as u32;
        self.nodes.extend(tree.nodes.into_iter().map(|mut node| {
            let inner = node.child.iter_mut().filter(|word| **word & LEAF_BIT == 0);
            inner.for_each(|word| *word += first);
            node
        }));
        if let Some((node, side)) = above {
            self.nodes[node].put(side, first, (&packed.lo, &packed.hi));
        }
    }

    /// Gives the nodes above the parts the boxes of what is below them: those that have none yet.
    fn close_boxes(&mut self) {
        for place in (0..self.nodes.len()).rev() {
            for side in 0..WIDE {
                let node = &self.nodes[place];
                let is_open = node.lo[0].as_array()[side] >= f32::MAX;
                if let (true, Child::Inner(below)) = (is_open, Child::of(node.child[side])) {
                    let (lo, hi) = self.nodes[below as usize].whole();
                    self.nodes[place].put(side, below, (&lo, &hi));
                }
            }
        }
    }
}

/// A tree of parry's, packed: places count from its own first node.
struct Tree {
    nodes: Vec<BvhNode>,
    leaf: u32,
}

impl Tree {
    /// Packs a part of the triangles and puts them into the order of the tree.
    fn pack(part: Run, corners: &(impl Fn(u32) -> [Vec3; 3] + Sync), leaf: u32) -> (Self, Packed) {
        let Run { start, triangles, .. } = part;
        // The tree may depend on the order in which it is given triangles, and selecting leaves an order of its own.
        let mut sorted: Vec<u32> = triangles.iter().map(|placed| placed.triangle).collect();
        sorted.sort_unstable();
        let boxes: Vec<Aabb> = sorted.iter().map(|&t| box_of(corners(t))).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        drop(boxes);
        let mut loose = unroll(&tree);
        drop(tree);
        count_leaves(&mut loose);
        let (lo, hi) = (loose[0].lo, loose[0].hi);
        let mut order = Order { start, leaves: Vec::with_capacity(triangles.len()) };
        let mut packed = Self { nodes: Vec::new(), leaf };
        let depth = packed.take(&loose, 0, &mut order);
        for (placed, leaf) in triangles.iter_mut().zip(order.leaves) {
            placed.triangle = sorted[leaf as usize];
        }
        (packed, Packed { depth, lo, hi })
    }

    /// Packs what is below a node, in the order of the tree; returns how deep it is.
    fn take(&mut self, loose: &[Loose], top: u32, order: &mut Order) -> usize {
        let place = self.nodes.len();
        self.nodes.push(BvhNode::EMPTY);
        let mut depth = 0;
        for (side, child) in widest(loose, top, self.leaf).enumerate() {
            let from = &loose[child as usize];
            let word = if from.count <= self.leaf {
                let start = order.start + order.leaves.len() as u32;
                gather(loose, child, &mut order.leaves);
                LEAF_BIT | ((from.count - 1) << COUNT_SHIFT) | start
            } else {
                let next = self.nodes.len() as u32;
                depth = depth.max(self.take(loose, child, order));
                next
            };
            self.nodes[place].put(side, word, (&from.lo, &from.hi));
        }
        depth + 1
    }
}

/// The children that a packed node takes below a node of the tree, from left to right: of what it has, the largest box is
/// opened as long as there is room.
fn widest(loose: &[Loose], top: u32, leaf: u32) -> impl Iterator<Item = u32> {
    let area = |node: u32| {
        let size = loose[node as usize].hi - loose[node as usize].lo;
        size.x * size.y + size.y * size.z + size.z * size.x
    };
    let mut taken = [top; WIDE];
    let mut count = 1;
    while count < WIDE {
        let open = (0..count).filter(|&k| loose[taken[k] as usize].count > leaf);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::make;
    use crate::terrain::stl::Facet;

    /// However many trees it is built of, every triangle has one place, and whatever comes near a ball is found.
    #[test]
    fn an_index_built_in_parts_finds_what_one_tree_finds() {
        let facets = make::natural_slope(40, 50).facets;
        let corners = |t: u32| facets[t as usize];
        let meets = |facet: &Facet, centre: &Vec3, radius: f64| {
            let box_m = box_of(*facet);
            (0..3)
                .all(|k| box_m.mins[k] <= centre[k] + radius && box_m.maxs[k] >= centre[k] - radius)
        };
        for (at_once, leaf) in [(usize::MAX, LEAF), (1000, LEAF), (37, MOST_IN_LEAF), (9, 1)] {
            let (index, order) = Index::build(facets.len(), Sizes { leaf, at_once }, corners);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().copied().eq(0..facets.len() as u32), "{at_once}");
            let (lo, hi) = index.bounds();
            for facet in facets.iter().step_by(97) {
                let centre = facet[0];
                assert!((0..3).all(|k| lo[k] <= centre[k] && centre[k] <= hi[k]));
                let mut found = Vec::new();
                index.near(&centre, 1.5, |start, count| {
                    found.extend(order[start as usize..(start + count) as usize].iter().copied());
                });
                let near =
                    (0..facets.len() as u32).filter(|&t| meets(&facets[t as usize], &centre, 1.5));
                assert!(near.into_iter().all(|t| found.contains(&t)), "{at_once}");
            }
        }
    }
}
