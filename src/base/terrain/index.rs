//! The spatial index: parry3d's bounding-volume tree, packed into two cache lines a node.
//!
//! parry builds the tree (binned surface-area heuristic). A rock's query reads it millions of times, so it is
//! then packed: four child boxes a node in `f32`, rounded outwards, and up to three triangles a leaf. Triangles
//! are renumbered in tree order, so that neighbours in space are neighbours in memory.

mod build;
mod runs;

pub(super) use build::Sizes;

use crate::rock::Vec3;
use wide::f32x4;

/// Most triangles in one leaf: four boxes at once are cheaper than the triangles that smaller ones leave out.
const LEAF: u32 = 3;
/// What a word of a child has room for: fewer nodes, where memory counts more than time.
const MOST_IN_LEAF: u32 = 8;
const LEAF_BIT: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const START_MASK: u32 = (1 << COUNT_SHIFT) - 1;

/// Children of a node.
const WIDE: usize = 4;

/// Up to four child boxes (m, rounded outwards) and where the children are.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct BvhNode {
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

impl BvhNode {
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

    /// The box of all children (m).
    fn whole(&self) -> (Vec3, Vec3) {
        let of = |boxes: &[f32x4; 3], keep: fn(f32, f32) -> f32| {
            let child =
                |side: usize| Vec3::from([0, 1, 2].map(|k| boxes[k].as_array()[side].into()));
            let narrow = |a: Vec3, b: Vec3| a.zip_map(&b, |a, b| keep(a as f32, b as f32).into());
            (0..WIDE)
                .filter(|&side| self.lo[0].as_array()[side] < f32::MAX)
                .map(child)
                .reduce(narrow)
        };
        let none = Vec3::repeat(f32::MAX.into());
        (of(&self.lo, f32::min).unwrap_or(none), of(&self.hi, f32::max).unwrap_or(none))
    }

    /// Bits of the children whose boxes share a point with the box from `lo` to `hi`.
    #[inline]
    fn meets(&self, (lo, hi): (&[f32x4; 3], &[f32x4; 3])) -> u32 {
        let apart = |k: usize| self.lo[k].simd_le(hi[k]) & lo[k].simd_le(self.hi[k]);
        (apart(0) & apart(1) & apart(2)).to_bitmask()
    }
}

/// The packed tree. Triangle numbers are positions in the order that its construction returns.
#[derive(Debug, Default)]
pub struct Index {
    nodes: Vec<BvhNode>,
    lo: Vec3,
    hi: Vec3,
}

/// Deepest tree that a traversal can walk. Every level halves what a bin of centres spans or the triangles, and a node
/// holds two levels or more: 2²⁸ triangles stay far below.
const DEPTH: usize = 56;
/// Children that wait during a traversal, at most.
pub const WAITING: usize = (WIDE - 1) * DEPTH + 1;

impl Index {
    /// The nodes; the first is the root. Empty when there is no triangle.
    #[inline]
    pub fn nodes(&self) -> &[BvhNode] {
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
        self.over_way([[x, y]; 2], under, visit);
    }

    /// Calls `visit(start, count)` for every leaf whose box meets the box around a straight way in plan view not above `under` (m).
    #[inline]
    pub fn over_way(&self, [from, to]: [[f64; 2]; 2], under: f64, visit: impl FnMut(u32, u32)) {
        let lo = [0, 1].map(|k| below(from[k].min(to[k])));
        let hi = [0, 1].map(|k| above(from[k].max(to[k])));
        self.walk(([lo[0], lo[1], f32::NEG_INFINITY], [hi[0], hi[1], above(under)]), visit);
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

/// Largest `f32` not above `x`.
#[inline]
pub fn below(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x { near.next_down() } else { near }
}

/// Smallest `f32` not below `x`.
#[inline]
pub fn above(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}
