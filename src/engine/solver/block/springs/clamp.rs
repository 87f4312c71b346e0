//! A block that is clamped between walls.
//!
//! An impact need not end with all contacts open. If the line between two contacts lies within both
//! friction cones, their springs press on each other, and friction keeps what they store, however
//! stiff they are. In the limit of stiff springs a clamped block does not move (its displacements
//! go with `p_N^(−1/2)`), but the clamp keeps its energy, and its forces exceed all others (they
//! grow with `p_N^(1/2)`). So the clamped contacts of a block are treated as contacts that neither
//! separate nor slip, whatever load acts: the block can still rotate about the line between two of
//! them, say.
//!
//! As the block moves, the stretches follow the levers so that the contacts stay in equilibrium.
//! The small displacement `d` of the body is the least-squares solution of `Σ Tᵀ K (e + T d) = 0`
//! for the stretches `e` and stiffnesses `K` of all contacts. Forces in equilibrium do no work on a
//! rigid body, so that the energy is constant. If a contact leaves its friction cone the clamp
//! bursts: its impact goes on from these stretches.

use super::super::{BlockContactState, TOUCH};
use super::SpringContact;
use crate::body::Block;
use crate::contact::block::{BlockContactPoint, MAX_BLOCK_CONTACTS};
use crate::contact::history::{SAME_CONTACT_COSINE, transport};
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::rigid::HELD;
use arrayvec::ArrayVec;
use nalgebra::{Matrix3, SMatrix, SVector};

/// Springs of a clamp may exceed the friction cone by this share (–) before it is resolved as an
/// impact.
const CONE_TOLERANCE: f64 = 1e-2;
/// A contact with a gap up to this joins an impact on a contact that it can jam against (–,
/// relative to the radius of the sphere of equal volume). Between walls a block rattles in ever
/// smaller gaps before it is clamped. Springs of any realistic stiffness press at both ends long
/// before the gaps are as small as the touching tolerance.
const NEARLY_TOUCHING: f64 = 1e-6;
/// Stiffness of motions that no contact resists, relative to the sum (–).
const UNRESISTED: f64 = 1e-12;

/// One contact of a clamp.
#[derive(Debug, Clone, Copy)]
struct ClampedContact {
    /// Part of the block that is clamped.
    part: u16,
    triangle: u32,
    /// Unit normal into the block.
    n: Vec3,
    /// Displacement of its point from the unloaded position (m): `ξ − x n` for a stretch `ξ` along
    /// the surface and a penetration `x`.
    stretch: Vec3,
    captured: bool,
    /// Stiffness along the normal and along the surface (N/m), and coefficient of friction (–).
    stiffness: [f64; 2],
    friction: f64,
}

/// Contact points of a clamp, from the centre of mass (m).
type Levers = ArrayVec<Vec3, MAX_BLOCK_CONTACTS>;

/// Contacts that jam each other; none for a block that is not clamped.
#[derive(Debug, Default)]
pub(crate) struct Clamp {
    contacts: Vec<ClampedContact>,
    /// Stretch of the spring of rolling friction (rad).
    pub(super) rolled: Vec3,
    /// Energy in all springs (J).
    pub(in super::super) held_j: f64,
}

impl ClampedContact {
    fn of(contact: &SpringContact, part: u16) -> Self {
        let normal = contact.law.normal(contact.captured);
        Self {
            part,
            triangle: contact.triangle,
            n: contact.n,
            stretch: contact.shear - contact.n * contact.penetration,
            captured: contact.captured,
            stiffness: [normal.stiffness_n_m(1.0), contact.law.shear.spring_force(1.0)],
            friction: contact.law.friction_coefficient(),
        }
    }

    /// Whether this contact point is its own.
    fn is_at(&self, touch: &BlockContactPoint) -> bool {
        self.part == touch.part && self.n.dot(&touch.normal) > SAME_CONTACT_COSINE
    }

    /// Penetration (m), and stretch along the surface (m).
    fn deformation(&self) -> (f64, Vec3) {
        let up = self.n.dot(&self.stretch);
        (-up, self.stretch - self.n * up)
    }

    /// Energy in it (J).
    fn stored_j(&self) -> f64 {
        let ((deep, along), [normal, shear]) = (self.deformation(), self.stiffness);
        0.5 * (normal * deep * deep + shear * along.norm_squared())
    }

    /// `K` (N/m).
    fn stiffness_matrix(&self) -> Matrix3<f64> {
        let ([normal, shear], up) = (self.stiffness, self.n * self.n.transpose());
        up * normal + (Matrix3::identity() - up) * shear
    }

    /// Whether it lies within its friction cone.
    fn is_held(&self) -> bool {
        let ((deep, along), [normal, shear]) = (self.deformation(), self.stiffness);
        deep > 0.0 && shear * along.norm() <= self.friction * normal * deep * (1.0 + CONE_TOLERANCE)
    }
}

impl Clamp {
    /// Whether the block is clamped.
    pub(crate) fn is_on(&self) -> bool {
        !self.contacts.is_empty()
    }

    /// Whether a contact point belongs to the clamp.
    pub(crate) fn contains(&self, touch: &BlockContactPoint) -> bool {
        self.contacts.iter().any(|one| one.is_at(touch))
    }

    /// Opens the clamp; returns its energy (J).
    pub(in super::super) fn open(&mut self) -> f64 {
        self.contacts.clear();
        self.rolled = Vec3::zeros();
        std::mem::take(&mut self.held_j)
    }

    /// Closes with those of these contacts that press, each at its contact point.
    pub(super) fn close(&mut self, contacts: &[SpringContact], touches: &[BlockContactPoint]) {
        self.open();
        let pressed = contacts.iter().zip(touches).filter(|(one, _)| one.normal_force > 0.0);
        self.contacts.extend(pressed.map(|(one, touch)| ClampedContact::of(one, touch.part)));
        self.held_j = self.springs_j();
    }

    fn springs_j(&self) -> f64 {
        self.contacts.iter().map(ClampedContact::stored_j).sum()
    }

    /// Its energy, by kind.
    pub(crate) fn stored(&self, world: &ContactEnvironment) -> Loss {
        let (mut stored, all_j) = (Loss::default(), self.springs_j());
        for one in &self.contacts {
            let damping = one.stored_j() / all_j.max(f64::MIN_POSITIVE) * self.held_j;
            stored.add(&Loss { damping, ..Loss::default() }.on(world, one.triangle), 1.0);
        }
        stored
    }

    /// Gives a contact of an impact the stretch of the clamp at its contact point.
    pub(super) fn load(&self, contact: &mut SpringContact, touch: &BlockContactPoint) {
        let Some(one) = self.contacts.iter().find(|one| one.is_at(touch)) else { return };
        (contact.penetration, contact.shear) = one.deformation();
        (contact.captured, contact.is_suspended) = (one.captured, false);
    }

    /// Updates the clamp to the detected contact points; returns whether all its contacts are still
    /// there.
    fn update(&mut self, found: &[BlockContactPoint], reach_m: f64, levers: &mut Levers) -> bool {
        let before = self.contacts.len();
        self.contacts.retain_mut(|one| {
            let near = found.iter().filter(|touch| one.is_at(touch) && touch.gap_m <= reach_m);
            let Some(touch) = near.min_by(|a, b| a.gap_m.total_cmp(&b.gap_m)) else {
                return false;
            };
            let ((deep, along), n) = (one.deformation(), touch.normal);
            one.stretch = transport(along, &one.n, &n) - n * deep;
            (one.n, one.triangle) = (n, touch.triangle);
            levers.try_push(touch.lever).is_ok()
        });
        self.contacts.len() == before
    }

    /// Moves the body until the contacts at these levers (m) are in equilibrium.
    fn balance(&mut self, levers: &[Vec3], reach_m: f64) {
        let before_j = self.springs_j();
        // rotations times the reach: all unknowns are lengths
        let jacobian = |lever: &Vec3| {
            let mut jacobian = SMatrix::<f64, 3, 6>::zeros();
            jacobian.fixed_columns_mut::<3>(0).copy_from(&Matrix3::identity());
            jacobian.fixed_columns_mut::<3>(3).copy_from(&(-lever.cross_matrix() / reach_m));
            jacobian
        };
        let (mut whole, mut residual) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
        for (one, lever) in self.contacts.iter().zip(levers) {
            let (jacobian, stiff) = (jacobian(lever), one.stiffness_matrix());
            whole += jacobian.transpose() * stiff * jacobian;
            residual += jacobian.transpose() * (stiff * one.stretch);
        }
        // nothing resists a rotation about the line between two contacts
        whole += SMatrix::<f64, 6, 6>::identity() * (UNRESISTED * whole.trace());
        let Some(solved) = whole.cholesky() else { return };
        let displacement = solved.solve(&-residual);
        for (one, lever) in self.contacts.iter_mut().zip(levers) {
            one.stretch += jacobian(lever) * displacement;
        }
        let after_j = self.springs_j();
        if after_j > 0.0 {
            let share = (before_j / after_j).sqrt();
            self.contacts.iter_mut().for_each(|one| one.stretch *= share);
        }
    }
}

impl BlockContactState {
    /// Whether two contacts can jam each other: the line between them lies within both friction
    /// cones.
    fn can_jam(&self, world: &ContactEnvironment, [one, other]: [&BlockContactPoint; 2]) -> bool {
        let supports = |touch: &BlockContactPoint, line: &Vec3| {
            let (up, law) = (touch.normal.dot(line), world.law(touch.triangle));
            let friction = self.slip.friction(world.ground_of(touch.triangle), law, 0.0);
            up > 0.0 && (line - touch.normal * up).norm() <= friction * up
        };
        let line = other.lever - one.lever;
        one.normal.dot(&other.normal) < 0.0 && supports(one, &line) && supports(other, &-line)
    }

    /// Whether two of the touching contacts can jam each other.
    pub(in super::super) fn can_clamp(&self, world: &ContactEnvironment, block: &Block) -> bool {
        self.touching(block).enumerate().any(|(k, one)| {
            self.touching(block).take(k).any(|other| self.can_jam(world, [one, other]))
        })
    }

    /// Selects the contacts of an impact: those that touch, and those that nearly touch and can jam
    /// against one of them.
    pub(super) fn select_for_blow(&mut self, world: &ContactEnvironment, block: &Block) {
        self.select_touching(block);
        let touching = self.selected.len();
        let [from_m, to_m] = [TOUCH, NEARLY_TOUCHING].map(|gap| gap * block.radius_m);
        for touch in &self.touches.found {
            let joins = touch.gap_m > from_m
                && touch.gap_m <= to_m
                && !self.clamp.contains(touch)
                && self.selected.len() < MAX_BLOCK_CONTACTS
                && (0..touching).any(|k| self.can_jam(world, [touch, &self.selected[k]]));
            if joins {
                self.selected.push(*touch);
            }
        }
    }

    /// Updates a clamp to the present pose; returns whether it bursts.
    pub(in super::super) fn carry_clamp(&mut self, block: &Block) -> bool {
        if !self.clamp.is_on() {
            return false;
        }
        let mut levers = Levers::new();
        let reach_m = HELD * block.radius_m;
        if !self.clamp.update(&self.touches.found, reach_m, &mut levers) {
            return true;
        }
        self.clamp.balance(&levers, block.bound_m);
        !self.clamp.contacts.iter().all(ClampedContact::is_held)
    }
}
