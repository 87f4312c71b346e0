//! The scar that a rock digs into soft soil, and the drag of the soil in it.
//!
//! In the model of Lu et al. (2019) a rock sinks into the soil to a depth `d` that follows from its
//! normal impact speed, meets a hard plane there, and leaves; in the soil a drag acts at its centre
//! against the velocity. Here **the mesh is the hard plane and the soil lies on it, `d` deep, as
//! long as the scar lasts**: contact, for any scheme and shape, is the same as without soil. Added
//! are changes of speed at three instants and along one path, each the closed form of drag alone,
//! `|v|' = −(C ρ_s A/2m) |v|²`:
//!
//! - at first contact: the entry, straight along the velocity from the surface to the depth `d`;
//! - during contact: the travel along the plane, at the depth `d`, half of that of each step before
//!   it and the rest after it;
//! - at the end of contact: the exit, straight again, and the scar is left; or, if the remaining
//!   normal speed is too small to rise through the soil against gravity, the rise up to where it is
//!   used up, and the scar goes on;
//! - at the end of a flight in a scar: the rest of the flown path, at a depth reduced by the height
//!   to which gravity lets a hop of that duration rise over its chord.
//!
//! The scar is in the soil on which the rock stands: on another soil it is as deep as the same
//! impact digs there, and on hard ground it ends.
//!
//! Neglected on entry and exit: gravity, the time they take, and the displacement (`d/cos θ` along
//! the surface, some tenths of a metre). Nothing is moved up or down, so nothing can gain energy:
//! every change takes a share of the speed of the centre. Spin is unchanged. A block cuts the soil
//! as the ball of equal volume does.
//!
//! `d` goes to 0 with the normal speed, and with it all drag: a rock that comes to rest or begins
//! to roll gently is in no scar. A further impact in a scar counts if it digs deeper.

mod way_out;

use super::body::Body;
use super::environment::ContactEnvironment;
use crate::ground::{Ground, Scar, cut_area_m2, swept_m3};
use crate::math;
use crate::rock::Vec3;

/// Share of the speed that one step along the plane may lose to drag, about (–).
const LOSS_OF_STEP: f64 = 0.02;
/// Least cosine (–) between the normal of a scar and that of a surface that continues its floor and
/// is no wall beside it: 60°.
const FLOOR_COSINE: f64 = 0.5;

/// The current scar of a rock.
#[derive(Debug, Clone, Copy)]
struct ActiveScar {
    /// Approach speed (m/s) of the impact that has dug it.
    approach_m_s: f64,
    /// The ground that it is in.
    ground: u16,
    depth_m: f64,
    /// `C ρ_s/(2 m)` (1/m³).
    ///
    /// The constant of `|v|' = −(C ρ_s A/2m)|v|²`; over a way `s` the speed falls by
    /// `exp(−C ρ_s A s/(2m))`.
    drag_per_m3: f64,
    /// Share of its speed that the rock loses per metre along the plane (1/m), small.
    per_m: f64,
    /// Normal of the plane.
    normal: Vec3,
    /// Drag applied in advance of the next flight (–), as a logarithm of the speed: the prepaid
    /// travel that was not ploughed after all, and the exit.
    prepaid: f64,
}

impl ActiveScar {
    /// Acceleration of a rock back to the plane (m/s²).
    fn pull(&self, body: &Body) -> f64 {
        -self.normal.dot(&body.gravity)
    }
}

/// Impact of a rock on a ground, with its plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GroundBlow {
    pub(crate) ground: u16,
    /// Unit normal, from the mesh to the rock.
    pub(crate) normal: Vec3,
    /// Approach speed of the centre (m/s).
    pub(crate) approach_m_s: f64,
    /// Approach speed of the contact point, spin included (m/s).
    pub(crate) of_point_m_s: f64,
}

impl GroundBlow {
    /// Whether no other impact on the same ground is faster; of equal ones the first counts.
    fn is_fastest_of(&self, place: usize, all: &[Self]) -> bool {
        let is_before = |(k, other): (usize, &Self)| {
            let [one, other_m_s] = [self, other].map(|blow| blow.of_point_m_s);
            other.ground == self.ground
                && (other_m_s > one || other_m_s.total_cmp(&one).is_eq() && k < place)
        };
        !all.iter().enumerate().any(is_before)
    }
}

/// What a rock in contact stands on.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ScarFloor {
    /// On a ground that supports it as a plane with this normal, with soil or without.
    On(u16, Vec3),
    /// Undetermined: it flies, or leans on a stem or a wall.
    Unknown,
}

/// The scars of one rock.
#[derive(Debug, Default)]
pub(crate) struct Scars {
    layers: Vec<Option<Scar>>,
    is_any: bool,
    /// Whether contacts are springs, which take time.
    has_springs: bool,
    active: Option<ActiveScar>,
    split: DragSplit,
}

/// How drag along the plane is shared out between steps.
///
/// Drag acts on half of a step's travel before it and on the rest after it (Strang splitting), so
/// that gravity and rolling friction see the mean of both. With all of it after the step, their
/// work in the step would be reduced by half of [`LOSS_OF_STEP`] too much.
#[derive(Debug, Clone, Copy, Default)]
struct DragSplit {
    /// Travel along the plane in the step before (m): the next one is assumed to be as long.
    last_m: f64,
    /// Travel to come on which drag has already acted (m).
    paid_m: f64,
}

impl DragSplit {
    /// Travel (m) on which drag acts before a step.
    fn begin_step(&mut self) -> f64 {
        let owed_m = (0.5 * self.last_m - self.paid_m).max(0.0);
        self.paid_m += owed_m;
        owed_m
    }

    /// Travel (m) on which drag still has to act after a step with the travel `way_m` (m), of which
    /// a share (–) was in contact.
    fn end_step(&mut self, way_m: f64, share: f64) -> f64 {
        let dragged_m = share * way_m;
        let paid_m = self.paid_m.min(dragged_m);
        self.paid_m -= paid_m;
        self.last_m = way_m;
        dragged_m - paid_m
    }

    /// Share of its travel (–) that the last step of a contact is in contact.
    ///
    /// Contact ends somewhere in it at an unresolved point: half is as likely too much as too
    /// little. But an impact on springs that is integrated as a whole ends where it opens.
    fn share_of_last(&self, has_springs: bool) -> f64 {
        if has_springs && self.last_m == 0.0 { 1.0 } else { 0.5 }
    }
}

impl Scars {
    /// No scar yet on these grounds; soil without drag is none.
    pub(crate) fn begin(&mut self, grounds: &[Ground], has_springs: bool) {
        let drags = |scar: &Scar| scar.drag * scar.soil_density_kg_m3 > 0.0;
        self.layers.clear();
        self.layers.extend(grounds.iter().map(|ground| ground.scar.filter(drags)));
        self.is_any = self.layers.iter().any(Option::is_some);
        self.has_springs = has_springs;
        (self.active, self.split) = (None, DragSplit::default());
    }

    /// Whether any ground has soil that drags.
    #[inline]
    pub(crate) fn are_any(&self) -> bool {
        self.is_any
    }

    /// The floor of the rock in its scar, from its contacts by triangle and normal: a ground with
    /// soil that drags, first of all the ground of the scar, else the first ground; without any,
    /// the first contact that continues the plane of the scar.
    ///
    /// A stem that it leans on, or a wall beside the soil, is no floor: it has not lifted the rock
    /// out of the soil.
    pub(crate) fn floor(
        &self,
        world: &ContactEnvironment,
        contacts: impl Iterator<Item = (u32, Vec3)>,
    ) -> ScarFloor {
        let own = self.active.map(|now| now.ground);
        let mut floor = ScarFloor::Unknown;
        // of several grounds with soil, independent of the order of contacts
        let mut soil: Option<(bool, u16)> = None;
        for (triangle, n) in contacts {
            let ground = world.ground_of(triangle);
            if self.layer(ground).is_some() {
                let rank = (own != Some(ground), ground);
                if soil.is_none_or(|known| rank < known) {
                    (soil, floor) = (Some(rank), ScarFloor::On(ground, n));
                }
                continue;
            }
            let is_first = matches!(floor, ScarFloor::Unknown);
            if is_first && !world.terrain.is_tree(triangle) && self.continues_floor(&n) {
                floor = ScarFloor::On(ground, n);
            }
        }
        floor
    }

    /// Whether a rock with these contacts, by triangle, stands in soil that drags.
    pub(crate) fn is_in_soil(
        &self,
        world: &ContactEnvironment,
        mut triangles: impl Iterator<Item = u32>,
    ) -> bool {
        triangles.any(|triangle| self.layer(world.ground_of(triangle)).is_some())
    }

    /// Whether a plane with this normal continues that of the scar.
    fn continues_floor(&self, normal: &Vec3) -> bool {
        self.active.is_some_and(|now| now.normal.dot(normal) > FLOOR_COSINE)
    }

    /// The soil of a ground, if it has any that drags.
    fn layer(&self, ground: u16) -> Option<Scar> {
        self.layers.get(usize::from(ground)).copied().flatten()
    }

    /// The scar of an impact on a ground with an approach (m/s); none on hard ground.
    fn dug(
        &self,
        body: &Body,
        (ground, normal): (u16, Vec3),
        approach_m_s: f64,
    ) -> Option<ActiveScar> {
        let scar = self.layer(ground)?;
        // d = 0.1 M^(1/3) M_E^(−0.4) v_n^0.8 (Lu et al. 2019, Eq. 11), in the units that the
        // formula is bound to
        let depth_m = scar.depth_m(body.mass, approach_m_s);
        let drag_per_m3 = scar.drag_per_m3(body.mass);
        let per_m = drag_per_m3 * cut_area_m2(body.radius, depth_m, 0.0);
        Some(ActiveScar { approach_m_s, ground, depth_m, drag_per_m3, per_m, normal, prepaid: 0.0 })
    }

    /// Moves the scar to where the rock now stands, or ends it.
    fn move_to(&mut self, body: &Body, (ground, normal): (u16, Vec3)) {
        let Some(now) = self.active else { return };
        self.active = if ground == now.ground {
            Some(ActiveScar { normal, ..now })
        } else {
            self.dug(body, (ground, normal), now.approach_m_s)
        };
    }

    /// Impacts at one instant on a rock at a speed (m/s), which is already `in_soil` by other
    /// contacts or not: the share of its speed that it keeps on entry (–), from its present depth
    /// on. Each struck ground is represented by its fastest impact, and the ground that is dug
    /// deepest counts: soil beside a hard wall is dug whichever is struck first or fastest.
    pub(crate) fn enter(
        &mut self,
        body: &Body,
        struck: &[GroundBlow],
        (speed_m_s, in_soil): (f64, bool),
    ) -> f64 {
        let (mut deepest, mut ends) = (None, false);
        let fastest = |(place, blow): &(usize, &GroundBlow)| blow.is_fastest_of(*place, struck);
        for (_, blow) in struck.iter().enumerate().filter(fastest) {
            let on = (blow.ground, blow.normal);
            let Some(dug) = self.dug(body, on, blow.approach_m_s.max(0.0)) else {
                ends |= !in_soil && self.continues_floor(&blow.normal);
                continue;
            };
            // of two of equal depth the one with less drag: independent of their order, and on the
            // safe side
            let is_deeper = |known: ActiveScar| {
                let [one, other] = [&dug, &known].map(|of| (of.depth_m, -of.drag_per_m3));
                one > other
            };
            if deepest.is_none_or(is_deeper) {
                deepest = Some(dug);
            }
        }
        let Some(dug) = deepest else {
            if ends {
                self.active = None;
            }
            return 1.0;
        };
        self.move_to(body, (dug.ground, dug.normal));
        let depth_m = self.active.map_or(0.0, |now| now.depth_m);
        if dug.depth_m <= depth_m {
            return 1.0;
        }
        self.active = Some(dug);
        // speed over the entry: ∫ A ds is the volume that the ball sweeps down to d, along the
        // velocity
        let cosine = (dug.approach_m_s / speed_m_s).min(1.0);
        let swept = |to_m| swept_m3(body.radius, to_m, cosine);
        math::exp(-dug.drag_per_m3 * (swept(dug.depth_m) - swept(depth_m)))
    }

    /// Share of its speed that the rock keeps before a step along the plane (–): drag on the first
    /// half of it.
    pub(crate) fn plough_ahead(&mut self) -> f64 {
        let Some(now) = &self.active else { return 1.0 };
        math::exp(-now.per_m * self.split.begin_step())
    }

    /// Share of its speed that the rock keeps after a step with the travel `way_m` (m) along the
    /// plane (–), where it stands now. If the contact `ends`, with the velocity before that, the
    /// exit is included. The part that [`Self::plough_ahead`] took is subtracted.
    pub(crate) fn plough(
        &mut self,
        body: &Body,
        (way_m, floor): (f64, ScarFloor),
        ends: Option<Vec3>,
    ) -> f64 {
        if let ScarFloor::On(ground, normal) = floor {
            self.move_to(body, (ground, normal));
        }
        let Some(now) = &self.active else {
            self.split = DragSplit::default();
            return 1.0;
        };
        let share = ends.map_or(1.0, |_| self.split.share_of_last(self.has_springs));
        let kept = math::exp(-now.per_m * self.split.end_step(way_m, share));
        ends.map_or(kept, |v| kept * self.leave(body, &(v * kept)))
    }

    /// Longest step along the plane (s) at a speed (m/s): drag acts between steps.
    pub(crate) fn longest_s(&self, speed_m_s: f64) -> f64 {
        self.active.map_or(f64::INFINITY, |now| LOSS_OF_STEP / (now.per_m * speed_m_s))
    }
}

#[cfg(test)]
mod tests;
