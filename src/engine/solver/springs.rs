//! Energy in the springs of a rock's contacts, and a bound for the time until they have taken a
//! given energy.

use super::contact_state::{ContactEnvironment, ContactState};
use super::loss::Loss;
use super::stem_load::{PressedTree, PressedTrees};
use crate::contact::history::ContactHistory;
use crate::contact::{ContactPoint, MAX_CONTACTS, TOUCH};
use crate::ground::Law;
use crate::rock::Vec3;
use arrayvec::ArrayVec;

impl ContactState {
    /// Energy in the springs of the contacts (J), by the kind it was counted under:
    /// `Σ (p_N pen² + p_s ξ² + k_r θ²)/2`.
    pub fn springs_j(&mut self, world: &ContactEnvironment) -> Loss {
        let c = self.c;
        self.find_contact_points(world, &c, world.body.radius);
        self.stored_j(world)
    }

    /// The same for the contact points found last.
    pub fn stored_j(&self, world: &ContactEnvironment) -> Loss {
        let mut stored = Loss::default();
        for touch in self.touches.iter() {
            let history = self.history_at(touch);
            let law = world.law(history.map_or(touch.triangle, |history| history.springs_of));
            let pressed = pressed_j(world, touch, law);
            stored.add(&Loss::on_slope([0.0, pressed, 0.0]).on(world, touch.triangle), 1.0);
        }
        for history in self.histories.iter() {
            stored.add(&stretched_j(world, history), 1.0);
        }
        stored
    }

    /// The contact history on the feature of a contact point, if there is one.
    fn history_at(&self, touch: &ContactPoint) -> Option<&ContactHistory> {
        self.histories.iter().find(|history| history.feature == touch.feature)
    }

    /// Energy in the springs of one contact (J), whose point is among those found last.
    pub(super) fn contact_stored_j(
        &self,
        world: &ContactEnvironment,
        history: &ContactHistory,
    ) -> f64 {
        let law = world.springs_of(history);
        let touch = self.touches.iter().find(|touch| touch.feature == history.feature);
        touch.map_or(0.0, |touch| pressed_j(world, touch, &law))
            + law.stored_j(0.0, history.shear.norm_squared(), history.roll.norm_squared())
    }

    /// Normal springs of impacts under way: normal, triangle and energy (J) of each.
    pub(super) fn impact_springs(
        &mut self,
        world: &ContactEnvironment,
    ) -> ArrayVec<(Vec3, u32, f64), MAX_CONTACTS> {
        let c = self.c;
        self.find_contact_points(world, &c, world.body.radius);
        let of_touch = |touch: &ContactPoint| {
            let history = self.history_at(touch)?;
            let energy_j = pressed_j(world, touch, &world.springs_of(history));
            (!history.captured).then_some((touch.normal, touch.triangle, energy_j))
        };
        self.touches.iter().filter_map(of_touch).collect()
    }

    /// Energy (J) in the springs of the contacts for which `count` is true. Contact points are
    /// found anew and restored afterwards: the normal force would not do, as dashpots push as well.
    pub(crate) fn held_j(
        &mut self,
        world: &ContactEnvironment,
        count: impl Fn(&ContactHistory) -> bool,
    ) -> f64 {
        if !self.histories.iter().any(&count) {
            return 0.0;
        }
        let (c, last) = (self.c, std::mem::take(&mut self.touches));
        self.collect_contact_points(world, &c, world.body.radius);
        let all = self.stored_j(world).sum();
        let others = self.histories.iter().filter(|history| !count(history));
        let of_others: f64 = others.map(|history| self.contact_stored_j(world, history)).sum();
        self.touches = last;
        all - of_others
    }

    /// The trees that are pressed, with the energy of the springs on them and the power of their
    /// dashpots and friction. Contact points are found anew and restored afterwards.
    pub(super) fn pressed_trees(&mut self, world: &ContactEnvironment) -> PressedTrees {
        let mut pressed = PressedTrees::default();
        let terrain = world.terrain;
        let Some(stems) = terrain.stems.as_ref() else { return pressed };
        if !self.histories.iter().any(|history| terrain.is_tree(history.triangle)) {
            return pressed;
        }
        let (c, last) = (self.c, std::mem::take(&mut self.touches));
        // including new contacts: the dashpot takes most at first
        self.collect_contact_points(world, &c, world.body.radius * (1.0 + TOUCH));
        for (k, touch) in self.touches.iter().enumerate() {
            let history = self.history_at(touch);
            if let Some(history) = history.filter(|_| terrain.is_tree(touch.triangle)) {
                let law = world.law_of(history, &self.touches, k);
                let (held_j, weight) = self.normal_energy_and_power(world, (history, touch), &law);
                let stem = stems.of_triangle(touch.triangle);
                pressed.add(PressedTree { stem, held_j, weight });
            }
        }
        for history in self.histories.iter().filter(|one| terrain.is_tree(one.triangle)) {
            let held_j = stretched_j(world, history).sum();
            let stem = stems.of_triangle(history.triangle);
            pressed.add(PressedTree { stem, held_j, weight: 0.0 });
        }
        self.touches = last;
        pressed
    }

    /// Energy in the normal spring of a contact (J), and the power that its dashpot and friction
    /// take (W).
    fn normal_energy_and_power(
        &self,
        world: &ContactEnvironment,
        (history, touch): (&ContactHistory, &ContactPoint),
        law: &Law,
    ) -> (f64, f64) {
        let penetration = (world.body.radius - touch.distance_m).max(0.0);
        let (normal, separation_m_s) = (law.normal(history.captured), touch.normal.dot(&self.v));
        let slip_m_s = world.body.slip(&touch.normal, &self.v, &self.w).norm();
        let cap = if history.slides { law.limits().caps(history.normal_force).0 } else { 0.0 };
        let taken_w = normal.dissipating_w(penetration, separation_m_s) + cap * slip_m_s;
        (normal.stored_j(penetration), taken_w)
    }

    /// A lower bound (s) of the time in which the contacts of `on` take `work_j`: their forces grow
    /// no faster than those of springs without loss, and nothing slows the rock. The bound becomes
    /// exact as `work_j` goes to 0.
    pub(crate) fn time_to_take_s(
        &self,
        world: &ContactEnvironment,
        work_j: f64,
        on: impl Fn(&ContactHistory) -> bool,
    ) -> f64 {
        let (mut now_w, mut grows_w_s) = (0.0, 0.0);
        for history in self.histories.iter().filter(|history| on(history)) {
            let law = world.springs_of(history);
            let speed = -history.n.dot(&self.v);
            let (inwards, slip): (f64, Vec3) =
                (speed.max(0.0), world.body.slip(&history.n, &self.v, &self.w));
            let (power_w, growth_w_s) =
                law.power_bound_w(history.normal_force, inwards, slip.norm());
            now_w += power_w;
            grows_w_s += growth_w_s;
        }
        2.0 * work_j / (now_w + (now_w * now_w + 4.0 * grows_w_s * work_j).sqrt())
    }
}

/// Energy in the springs of shear and rolling of a contact (J), by the kind it was counted under.
pub(super) fn stretched_j(world: &ContactEnvironment, history: &ContactHistory) -> Loss {
    let law = world.springs_of(history);
    let damping = law.stored_j(0.0, history.shear.norm_squared(), 0.0);
    let rolling = law.stored_j(0.0, 0.0, history.roll.norm_squared());
    Loss::on_slope([0.0, damping, rolling]).on(world, history.triangle)
}

/// Energy in the normal spring at a contact point (J) by a law.
fn pressed_j(world: &ContactEnvironment, touch: &ContactPoint, law: &Law) -> f64 {
    let penetration = (world.body.radius - touch.distance_m).max(0.0);
    touch.gain2 * law.stored_j(penetration, 0.0, 0.0)
}
