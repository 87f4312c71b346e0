//! Building the index: trees of parry's, packed.

use super::{COUNT_SHIFT, DEPTH, Index, LEAF, LEAF_BIT, Node, WIDE};
use crate::rock::Vec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};

/// Most triangles that one tree of parry's is built over: it takes about 300 bytes for each until it is packed.
const AT_ONCE: usize = 1 << 19;

/// Triangles that stand side by side in the index, by their numbers in the input.
struct Part<'a> {
    /// Place of the first one in the index.
    start: u32,
    triangles: &'a mut [u32],
}

impl Part<'_> {
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
        Self::build_in_parts(count, corners, AT_ONCE)
    }

    /// The same with at most so many triangles in one tree of parry's.
    fn build_in_parts(
        count: usize,
        corners: impl Fn(u32) -> [Vec3; 3],
        at_once: usize,
    ) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..count as u32).collect();
        if count == 0 {
            return (Self::default(), order);
        }
        let mut index = Self::default();
        let whole = Part { start: 0, triangles: &mut order };
        let Packed { depth, lo, hi } = index.pack_part(whole, &corners, at_once);
        assert!(depth <= DEPTH, "the index of the mesh has {depth} levels");
        (index.lo, index.hi) = (lo, hi);
        index.nodes.shrink_to_fit();
        (index, order)
    }

    /// Packs a part of the triangles and puts them into the order of the tree. What is too large for one tree of parry's is
    /// cut into four first.
    fn pack_part(
        &mut self,
        part: Part,
        corners: &impl Fn(u32) -> [Vec3; 3],
        at_once: usize,
    ) -> Packed {
        let Part { start, triangles } = part;
        if triangles.len() <= at_once {
            return self.pack_at_once(Part { start, triangles }, corners);
        }
        let place = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let [west, east] = Part { start, triangles }.halves(corners);
        let quarters = west.halves(corners).into_iter().chain(east.halves(corners));
        let mut whole = Packed::NOTHING;
        for (side, quarter) in quarters.enumerate() {
            let word = self.nodes.len() as u32;
            let packed = self.pack_part(quarter, corners, at_once);
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
        for at_once in [usize::MAX, 1000, 37, 4] {
            let (index, order) = Index::build_in_parts(facets.len(), corners, at_once);
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

    /// The parts do not hang on the order in which triangles come.
    #[test]
    fn halves_are_the_same_whatever_the_order() {
        let facets = make::natural_slope(20, 20).facets;
        let corners = |t: u32| facets[t as usize];
        let halves = |mut triangles: Vec<u32>| {
            let halves = Part { start: 0, triangles: &mut triangles }.halves(&corners);
            halves.map(|half| {
                half.triangles.sort_unstable();
                half.triangles.to_vec()
            })
        };
        let all = 0..facets.len() as u32;
        assert_eq!(halves(all.clone().collect()), halves(all.rev().collect()));
    }
}
