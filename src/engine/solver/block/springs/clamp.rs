//! A block that is clamped between walls.
//!
//! A blow need not end with all contacts open: where the line between two of them lies within both cones of friction their springs press on
//! each other, and friction holds what they store, however stiff they are. In the limit of stiff springs a clamp moves no more (its ways go with
//! `p_N^(−1/2)`), but it keeps its energy, and its forces grow beyond all others (with `p_N^(1/2)`). So a block in a clamp
//! goes on as one whose clamped contacts neither part nor slip, whatever pulls: free to turn about the line between two of them, say.
//!
//! On its way the stretches follow the levers. They stay those in which the contacts balance: what they give way, a small motion `d` of the body,
//! is the least-squares solution of `Σ Tᵀ K (e + T d) = 0` for the stretches `e` and stiffnesses `K` of all of them. As forces in balance do no work on a rigid body, their
//! energy stays as it is. Where they leave a cone of friction the clamp bursts: its blow goes on from these stretches.

use super::super::{BlockContactState, TOUCH};
use super::SpringContact;
use crate::body::Block;
use crate::contact::block::{BlockTouch, MOST_TOUCHES};
use crate::contact::history::{SAME_GRIP, carry};
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::rigid::HELD;
use arrayvec::ArrayVec;
use nalgebra::{Matrix3, SMatrix, SVector};

/// Springs of a clamp may ask for so much more friction than there is (–) before it is followed in its own time.
const CONE_TOLERANCE: f64 = 1e-2;
/// A contact no further away than this joins a blow on one that it can hold (–, relative to the radius of the sphere of equal volume). Between
/// walls a block rattles to and fro in ever smaller gaps before it is clamped; springs of any stiffness that a ground can have press at
/// both ends long before they are as small as what touches.
const NEARLY_TOUCHING: f64 = 1e-6;
/// Stiffness of what no contact resists, relative to all (–).
const UNRESISTED: f64 = 1e-12;

/// One contact of a clamp.
#[derive(Debug, Clone, Copy)]
struct ClampedContact {
    /// What of the block is clamped.
    part: u16,
    triangle: u32,
    /// Unit normal into the block.
    n: Vec3,
    /// From where its point would be without forces to where it is (m): `ξ − x n` of a stretch `ξ` along the surface and a penetration `x`.
    stretch: Vec3,
    captured: bool,
    /// Stiffness along the normal and along the surface (N/m), and coefficient of friction (–).
    stiffness: [f64; 2],
    friction: f64,
}

/// Where the contacts of a clamp are, from the centre of mass (m).
type Levers = ArrayVec<Vec3, MOST_TOUCHES>;

/// Contacts that hold each other; none for a block that is not clamped.
#[derive(Debug, Default)]
pub(crate) struct Clamp {
    contacts: Vec<ClampedContact>,
    /// Stretch of the spring of rolling friction (rad).
    pub(super) rolled: Vec3,
    /// Energy in all of them (J).
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
            stiffness: [normal.stiffness_n_m(1.0), contact.law.shear.held(1.0)],
            friction: contact.law.friction_coefficient(),
        }
    }

    /// Whether this is the touch that it holds.
    fn is_at(&self, touch: &BlockTouch) -> bool {
        self.part == touch.part && self.n.dot(&touch.normal) > SAME_GRIP
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

    /// Whether friction holds it.
    fn is_held(&self) -> bool {
        let ((deep, along), [normal, shear]) = (self.deformation(), self.stiffness);
        deep > 0.0 && shear * along.norm() <= self.friction * normal * deep * (1.0 + CONE_TOLERANCE)
    }
}

impl Clamp {
    /// Whether there is one.
    pub(crate) fn is_on(&self) -> bool {
        !self.contacts.is_empty()
    }

    /// Whether a touch is one of its contacts.
    pub(crate) fn contains(&self, touch: &BlockTouch) -> bool {
        self.contacts.iter().any(|one| one.is_at(touch))
    }

    /// Opens; the energy that was in it (J).
    pub(in super::super) fn open(&mut self) -> f64 {
        self.contacts.clear();
        self.rolled = Vec3::zeros();
        std::mem::take(&mut self.held_j)
    }

    /// Closes with these contacts, as far as they press, each at its touch.
    pub(super) fn close(&mut self, contacts: &[SpringContact], touches: &[BlockTouch]) {
        self.open();
        let pressed = contacts.iter().zip(touches).filter(|(one, _)| one.normal_force > 0.0);
        self.contacts.extend(pressed.map(|(one, touch)| ClampedContact::of(one, touch.part)));
        self.held_j = self.springs_j();
    }

    fn springs_j(&self) -> f64 {
        self.contacts.iter().map(ClampedContact::stored_j).sum()
    }

    /// Energy in it, by what it belongs to.
    pub(crate) fn stored(&self, world: &ContactEnvironment) -> Loss {
        let (mut stored, all_j) = (Loss::default(), self.springs_j());
        for one in &self.contacts {
            let damping = one.stored_j() / all_j.max(f64::MIN_POSITIVE) * self.held_j;
            stored.add(&Loss { damping, ..Loss::default() }.on(world, one.triangle), 1.0);
        }
        stored
    }

    /// Gives a contact of a blow what the clamp holds at its touch.
    pub(super) fn load(&self, contact: &mut SpringContact, touch: &BlockTouch) {
        let Some(one) = self.contacts.iter().find(|one| one.is_at(touch)) else { return };
        (contact.penetration, contact.shear) = one.deformation();
        (contact.captured, contact.is_suspended) = (one.captured, false);
    }

    /// Goes with the touches found; whether all are there still.
    fn update(&mut self, found: &[BlockTouch], reach_m: f64, levers: &mut Levers) -> bool {
        let before = self.contacts.len();
        self.contacts.retain_mut(|one| {
            let near = found.iter().filter(|touch| one.is_at(touch) && touch.gap_m <= reach_m);
            let Some(touch) = near.min_by(|a, b| a.gap_m.total_cmp(&b.gap_m)) else {
                return false;
            };
            let ((deep, along), n) = (one.deformation(), touch.normal);
            one.stretch = carry(along, &one.n, &n) - n * deep;
            (one.n, one.triangle) = (n, touch.triangle);
            levers.try_push(touch.lever).is_ok()
        });
        self.contacts.len() == before
    }

    /// Lets the body give way until the contacts at these levers (m) balance.
    fn balance(&mut self, levers: &[Vec3], reach_m: f64) {
        let before_j = self.springs_j();
        // turns times the reach: all unknowns are ways
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
        // nothing resists a turn about the line between two contacts
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
    /// Whether two contacts can hold each other: the line between them lies within both cones of friction.
    fn can_jam(&self, world: &ContactEnvironment, [one, other]: [&BlockTouch; 2]) -> bool {
        let bears = |touch: &BlockTouch, way: &Vec3| {
            let (up, law) = (touch.normal.dot(way), world.law(touch.triangle));
            let friction = self.slip.friction(world.ground_of(touch.triangle), law, 0.0);
            up > 0.0 && (way - touch.normal * up).norm() <= friction * up
        };
        let way = other.lever - one.lever;
        one.normal.dot(&other.normal) < 0.0 && bears(one, &way) && bears(other, &-way)
    }

    /// Whether two of the contacts that touch can hold each other.
    pub(in super::super) fn can_clamp(&self, world: &ContactEnvironment, block: &Block) -> bool {
        self.touching(block).enumerate().any(|(k, one)| {
            self.touching(block).take(k).any(|other| self.can_jam(world, [one, other]))
        })
    }

    /// Sets aside what takes part in a blow: what touches, and what nearly touches and can hold it.
    pub(super) fn select_for_blow(&mut self, world: &ContactEnvironment, block: &Block) {
        self.select_touching(block);
        let touching = self.selected.len();
        let [from_m, to_m] = [TOUCH, NEARLY_TOUCHING].map(|gap| gap * block.radius_m);
        for touch in &self.touches.found {
            let joins = touch.gap_m > from_m
                && touch.gap_m <= to_m
                && !self.clamp.contains(touch)
                && self.selected.len() < MOST_TOUCHES
                && (0..touching).any(|k| self.can_jam(world, [touch, &self.selected[k]]));
            if joins {
                self.selected.push(*touch);
            }
        }
    }

    /// Carries a clamp on to where the block is; whether it bursts.
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
