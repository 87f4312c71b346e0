//! Contact histories of a block.

use super::super::{BlockContactState, BlockState, TOUCH};
use crate::body::Block;
use crate::contact::Feature;
use crate::contact::block::{BlockContactPoint, SAME_POINT};
use crate::contact::history::{SAME_CONTACT_COSINE, transport};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::block::solve::Mass;
use crate::solver::environment::ContactEnvironment;
use crate::solver::ground_change::{begins_pressed, springs_across_fold};
use crate::solver::law::capture_m_s;

/// Lower bound of the coupling of a contact with the others (–): where they push each other apart,
/// its effective mass would grow without bound.
const LEAST_SHARED: f64 = 0.25;

/// History of one contact of a block.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct BlockHistory {
    /// Part of the block and feature of the mesh in contact.
    part: u16,
    pub(crate) feature: Feature,
    /// Triangle whose ground is touched, and the triangle whose springs act
    /// (`solver::ground_change`).
    pub(crate) triangle: u32,
    springs_of: u32,
    /// Its law, with the damping for the effective mass at its first touch.
    pub(crate) law: Law,
    /// Normal to which `shear` is tangent, and position of the contact point (m).
    pub(crate) n: Vec3,
    pub(crate) point: Vec3,
    /// Stretch of the shear spring (m).
    pub(crate) shear: Vec3,
    /// Normal force at the end of the last step (N).
    pub(crate) normal_force: f64,
    /// Penetration at which its spring begins to act (m): a penetration from before the contact
    /// existed stores nothing.
    pub(super) offset_m: f64,
    /// Compression of its spring at the end of the last step (m).
    pub(super) pressed_m: f64,
    /// Energy in its normal spring then (J).
    pub(super) normal_j: f64,
    /// Impulse of the last solve (N s): where the next begins.
    pub(super) impulse: Vec3,
    /// Speed of approach when it began (m/s).
    pub(crate) approach_m_s: f64,
    /// Age of the contact (rad of its oscillation).
    pub(super) age_rad: f64,
    /// Closed too slowly to rebound.
    pub(crate) captured: bool,
    /// Whether it presses.
    pub(crate) closed: bool,
    pub(crate) slides: bool,
    /// Whether its onset has been recorded, and as which impact, counted from 1; 0 if it was none.
    pub(crate) announced: bool,
    pub(crate) impact: u32,
}

impl BlockHistory {
    pub(super) fn is_of(&self, touch: &BlockContactPoint) -> bool {
        self.part == touch.part && self.feature == touch.feature
    }

    /// Energy in its springs (J).
    pub(crate) fn held_j(&self) -> f64 {
        self.law.stored_j(self.pressed_m, self.shear.norm_squared(), 0.0)
    }

    /// Power dissipated by its dashpot and its friction at a velocity of its point (m/s) (W).
    pub(crate) fn dissipating_w(&self, velocity: &Vec3) -> f64 {
        let apart_m_s = self.n.dot(velocity);
        let slip_m_s = (velocity - self.n * apart_m_s).norm();
        let cap = if self.slides { self.law.limits().caps(self.normal_force).0 } else { 0.0 };
        self.law.normal(self.captured).dissipating_w(self.pressed_m, apart_m_s) + cap * slip_m_s
    }

    /// Parts of block and mesh in contact.
    pub(super) fn pair(&self) -> (u16, Feature) {
        (self.part, self.feature)
    }

    /// Makes it an impact with the approach speed `speed_m_s`: on a facet of rough ground.
    pub(crate) fn rebound(&mut self, speed_m_s: f64) {
        self.captured = false;
        self.age_rad = 0.0;
        self.approach_m_s = self.approach_m_s.max(speed_m_s);
    }

    /// Updates it to the present contact point.
    pub(super) fn follow(&mut self, touch: &BlockContactPoint, centre: &Vec3) {
        (self.part, self.feature, self.triangle) = (touch.part, touch.feature, touch.triangle);
        self.shear = transport(self.shear, &self.n, &touch.normal);
        (self.n, self.point) = (touch.normal, centre + touch.lever);
    }
}

impl BlockContactState {
    /// The law of a contact that begins at an approach speed (m/s). Its dashpots have the damping
    /// ratio of the ground for the effective mass of the contact, `m_n = 1/(V_N M⁻¹ V_Nᵀ)`, so that
    /// restitution without friction is that of the ground. If several contacts touch at once,
    /// itself among `all`, each gets its share.
    pub(in super::super) fn law_of_touch<'t>(
        world: &ContactEnvironment,
        mass: &Mass,
        touch: &BlockContactPoint,
        (approach_m_s, all): (f64, impl Iterator<Item = &'t BlockContactPoint>),
    ) -> Law {
        Self::law_on(world.law(touch.triangle), mass, touch, (approach_m_s, all))
    }

    /// The same on a ground with this law.
    fn law_on<'t>(
        ground: &Law,
        mass: &Mass,
        touch: &BlockContactPoint,
        (approach_m_s, all): (f64, impl Iterator<Item = &'t BlockContactPoint>),
    ) -> Law {
        let others = all.filter(|other| *other != touch);
        let others = others.map(|other| (other.normal, other.lever));
        law_at(ground, mass, (touch.normal, touch.lever), (approach_m_s, others))
    }

    /// Where an impact begins, the pressing contacts get the dashpots for the masses that they move
    /// together, as in the limit of stiff springs. Corners that land at once are found one after
    /// the other by the detections of a step, and lasting contacts may have begun long ago, as the
    /// face of a block that tips about an edge. An impact that is already under way is not changed.
    pub(crate) fn damp_together(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) {
        let histories = &mut self.springs.histories;
        if histories.iter().all(|one| one.announced || one.captured) {
            return;
        }
        let rebounds = |one: &BlockHistory| !one.captured && one.closed;
        let continues = histories.iter().any(|one| one.announced && rebounds(one));
        let mass = state.mass(block);
        for k in 0..histories.len() {
            let one = histories[k];
            if one.announced && continues {
                continue;
            }
            let at = |one: &BlockHistory| (one.n, one.point - state.pose.centre);
            let others = histories.iter().enumerate().filter(|(j, _)| *j != k);
            let others = others.map(|(_, other)| at(other));
            let approach_m_s = if one.captured { 0.0 } else { one.approach_m_s };
            let law = law_at(world.law(one.springs_of), &mass, at(&one), (approach_m_s, others));
            histories[k].law = law.with_friction_of(&one.law);
        }
        self.springs.invalidate_rates();
    }

    /// Gives contact `k` the dashpots of an impact at another speed (m/s) than it began with, as
    /// soil or a facet requires.
    pub(crate) fn strike_anew(
        &mut self,
        k: usize,
        (block, state): (&Block, &BlockState),
        approach_m_s: f64,
    ) {
        let (mass, history) = (state.mass(block), &mut self.springs.histories[k]);
        let lever = history.point - state.pose.centre;
        let across = mass.effective_masses((&history.n, &lever))[1];
        history.law = history.law.for_impact_speed(approach_m_s, [across, mass.mass]);
        self.springs.invalidate_rates();
    }

    /// Gives contacts that have moved to another ground its friction; springs and dashpots stay
    /// those of the ground on which they were loaded, as those of spheres do in an impact
    /// (`solver::ground_change`).
    fn update_friction(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) {
        if world.laws.len() == 1 {
            return;
        }
        for (touch, k) in self.touches.found.iter().zip(&self.history_of_touch) {
            let Some(k) = *k else { continue };
            let before = self.springs.histories[k];
            if world.ground_of(before.triangle) != world.ground_of(touch.triangle) {
                let began = (before.approach_m_s, self.touching(block));
                let touched = Self::law_of_touch(world, &state.mass(block), touch, began);
                let history = &mut self.springs.histories[k];
                history.law = history.law.with_friction_of(&touched);
                history.triangle = touch.triangle;
            }
        }
    }

    /// Assigns a history to every contact of the last detection, in their order; new contacts get
    /// new histories.
    pub(super) fn update_histories(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) {
        let mut history_of_touch = std::mem::take(&mut self.history_of_touch);
        history_of_touch.clear();
        for touch in &self.touches.found {
            let known = self.springs.histories.iter().position(|history| history.is_of(touch));
            history_of_touch.push(known.filter(|k| !history_of_touch.contains(&Some(*k))));
        }
        let mut k = 0;
        while k < history_of_touch.len() {
            if history_of_touch[k].is_none() {
                let touch = self.touches.found[k];
                let near = self.history_near((block, state), &touch, &history_of_touch);
                let before = history_of_touch.iter().position(|own| near.is_some() && *own == near);
                history_of_touch[k] = near.or_else(|| {
                    let new = self.new_history(world, &touch, (block, state));
                    Some(self.springs.add(&new))
                });
                if let Some(before) = before {
                    history_of_touch.remove(before);
                    self.touches.found.remove(before);
                    k -= usize::from(before < k);
                }
            }
            k += 1;
        }
        self.history_of_touch = history_of_touch;
        self.update_friction(world, (block, state));
    }

    /// The history of a contact that has moved from a neighbouring feature. It is one that no other
    /// contact has, or whose contact lies past the ends of its features.
    fn history_near(
        &self,
        (block, state): (&Block, &BlockState),
        touch: &BlockContactPoint,
        history_of_touch: &[Option<usize>],
    ) -> Option<usize> {
        let point = state.pose.centre + touch.lever;
        let is_taken = |history: usize| {
            let by = history_of_touch.iter().position(|own| *own == Some(history));
            by.is_some_and(|by| !hands_over(block, touch, &self.touches.found[by]))
        };
        self.springs.nearest(touch, (&point, block.ball_m), is_taken)
    }

    /// The springs, by a triangle, of the patch of the same corner from which a new one separates,
    /// or which it meets in an impact: at a blunt fold they are one patch, as those of a sphere are
    /// (`solver::ground_change`).
    fn springs_across_fold(
        &self,
        world: &ContactEnvironment,
        touch: &BlockContactPoint,
        block: &Block,
    ) -> Option<u32> {
        let rebounds = self.springs.is_rebounding();
        let is_parted = rebounds || begins_pressed(-touch.gap_m, block.ball_m);
        if world.laws.len() == 1 || !block.core.is_corner(touch.part) || !is_parted {
            return None;
        }
        let is_tree = world.terrain.is_tree(touch.triangle);
        let same = self.springs.histories.iter().filter(|one| one.part == touch.part);
        let pressed = same
            .filter(|one| one.closed || rebounds)
            .filter(|one| world.terrain.is_tree(one.triangle) == is_tree);
        springs_across_fold(&touch.normal, pressed.map(|one| (one.n, one.springs_of)))
    }

    /// A new history.
    fn new_history(
        &self,
        world: &ContactEnvironment,
        touch: &BlockContactPoint,
        (block, state): (&Block, &BlockState),
    ) -> BlockHistory {
        let mass = &state.mass(block);
        let approach_m_s = state.approach_m_s(block, touch);
        // a contact that begins while an impact rebounds belongs to it, however slow it is
        let rebounds = self.springs.is_rebounding();
        let captured = approach_m_s < capture_m_s(world.law(touch.triangle)) && !rebounds;
        let law = Self::law_of_touch(world, mass, touch, (approach_m_s, self.touching(block)));
        let springs_of = self.springs_across_fold(world, touch, block).unwrap_or(touch.triangle);
        let on_springs = || {
            let began = (approach_m_s, self.touching(block));
            Self::law_on(world.law(springs_of), mass, touch, began)
        };
        BlockHistory {
            part: touch.part,
            feature: touch.feature,
            triangle: touch.triangle,
            springs_of,
            law: if springs_of == touch.triangle {
                law
            } else {
                on_springs().with_friction_of(&law)
            },
            n: touch.normal,
            point: state.pose.centre + touch.lever,
            shear: Vec3::zeros(),
            normal_force: 0.0,
            offset_m: 0.0,
            pressed_m: 0.0,
            normal_j: 0.0,
            impulse: Vec3::zeros(),
            approach_m_s,
            age_rad: 0.0,
            captured,
            closed: approach_m_s > 0.0 && touch.gap_m <= TOUCH * block.radius_m,
            slides: false,
            announced: false,
            impact: 0,
        }
    }
}

/// Whether a new contact of an edge or a face of the block continues one that is past the ends of
/// its features, with the next feature of the mesh or the next part of the block. Otherwise both
/// would press, the new one from its present penetration: a block that slides along a crest would
/// sink at each joint by the penetration of its weight.
fn hands_over(block: &Block, new: &BlockContactPoint, before: &BlockContactPoint) -> bool {
    !block.core.is_corner(new.part) && before.can_continue_as(new.part, new.feature)
}

/// The law of a contact with a normal and a lever beside `others`, which begins at an approach
/// speed (m/s).
fn law_at(
    ground: &Law,
    mass: &Mass,
    at: (Vec3, Vec3),
    (approach_m_s, others): (f64, impl Iterator<Item = (Vec3, Vec3)>),
) -> Law {
    let mut law = *ground;
    if approach_m_s >= capture_m_s(&law) {
        law.set_impact_speed(approach_m_s);
    }
    let [along, across] = mass.effective_masses((&at.0, &at.1));
    law.for_masses([along * mass_share(mass, at, others), across], mass.mass)
}

/// Share of a contact in the effective mass among those that touch with it (–): `G_ii/Σ_j G_ij`
/// along the normals.
fn mass_share(mass: &Mass, one: (Vec3, Vec3), others: impl Iterator<Item = (Vec3, Vec3)>) -> f64 {
    let along = |other: (Vec3, Vec3)| {
        let arms = [one, other].map(|(n, lever)| lever.cross(&n));
        one.0.dot(&other.0) / mass.mass + arms[0].dot(&(mass.inverse * arms[1]))
    };
    let own = along(one);
    let all = own + others.map(along).sum::<f64>();
    own / all.max(LEAST_SHARED * own)
}

impl super::Springs {
    /// Whether there is a current impact.
    pub(crate) fn is_rebounding(&self) -> bool {
        self.fastest_m_s().is_some()
    }

    /// Fastest approach of the current impacts (m/s); `None` if there is none.
    pub(super) fn fastest_m_s(&self) -> Option<f64> {
        let rebounding =
            self.histories.iter().filter(|history| history.closed && !history.captured);
        rebounding.map(|history| history.approach_m_s).reduce(f64::max)
    }

    /// The history, among those not taken, of a contact that has moved to a neighbouring feature
    /// and is now at `point`.
    fn nearest(
        &self,
        touch: &BlockContactPoint,
        (point, ball_m): (&Vec3, f64),
        is_taken: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let fits = |(k, history): &(usize, &BlockHistory)| {
            !is_taken(*k) && history.n.dot(&touch.normal) > SAME_CONTACT_COSINE
        };
        let away = |history: &BlockHistory| (history.point - point).norm();
        let both = self.histories.iter().enumerate().filter(fits);
        let nearest = both.min_by(|one, other| away(one.1).total_cmp(&away(other.1)))?;
        (away(nearest.1) <= SAME_POINT * ball_m).then_some(nearest.0)
    }

    /// Contacts that begin with a step keep their initial penetration through it.
    pub(super) fn keep_offsets(&mut self) {
        for contact in &self.contacts {
            self.histories[contact.history].offset_m = contact.offset_m;
        }
    }

    /// Adds a history.
    fn add(&mut self, new: &BlockHistory) -> usize {
        self.histories.push(*new);
        let place = self.histories.len() - 1;
        for rate in &mut self.rates {
            rate.shear.resize(place, Vec3::zeros());
            rate.shear.push(Vec3::zeros());
        }
        place
    }
}
