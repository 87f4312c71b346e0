//! The scar that a rock digs into soft soil, and the drag of the soil in it.
//!
//! Lu et al. (2019) let a rock sink into the soil to a depth `d` that follows from its normal speed of impact, meet a hard plane
//! there, and leave; in the soil a drag acts against the velocity, at the centre. Here **the mesh is the hard plane and the soil lies on it,
//! `d` deep, as long as the scar lasts**: contact, whatever its scheme and the rock's shape, is the same as without soil. What is added are
//! changes of speed at three instants and along one way, each the closed form of the drag alone, `|v|' = −(C ρ_s A/2m) |v|²`:
//!
//! - at the touch: the way in, straight along the velocity from the surface to the depth `d`;
//! - while contact lasts: the way along the plane, at the depth `d`, half of that of each step before it and the rest after it;
//! - when contact ends: the way out, straight again, and the scar is left; or, where the speed along the normal is too small to rise
//!   through the soil against gravity, the hop back to the plane, and the scar goes on.
//!
//! Left out of the way in and out: gravity, the time it takes, and where it leads (`d/cos θ` along the surface, some tenths of a metre). Nothing
//! is moved up or down, so nothing can gain energy: every change takes a share of the speed of the centre. Spin stays. A block cuts the soil as
//! the ball of equal volume does.
//!
//! `d` goes to 0 with the normal speed, and with it all drag: a rock that comes to lie or to roll on gently is in no scar. A further impact in
//! a scar counts where it digs deeper.

use super::body::Body;
use super::environment::ContactEnvironment;
use crate::ground::{Ground, Scar, cut_area_m2, swept_m3};
use crate::math;
use crate::rock::Vec3;

/// Share of the speed that one step along the plane may lose to drag, about (–).
const LOSS_OF_STEP: f64 = 0.02;

/// The scar that a rock is in.
#[derive(Debug, Clone, Copy)]
struct Furrow {
    depth_m: f64,
    /// `C ρ_s/(2 m)` (1/m³).
    ///
    /// The constant of `|v|' = −(C ρ_s A/2m)|v|²`; over a way `s` the speed falls by `exp(−C ρ_s A
    /// s/(2m))`.
    drag_per_m3: f64,
    /// Share of its speed that the rock loses on each metre along the plane (1/m), small.
    per_m: f64,
    /// Normal of the plane.
    normal: Vec3,
    /// A flight that is longer (s) has left it.
    longest_s: f64,
}

/// The scars of one rock.
#[derive(Debug, Default)]
pub(crate) struct Scars {
    layers: Vec<Option<Scar>>,
    is_any: bool,
    /// Whether contacts are springs, which take time.
    has_springs: bool,
    now: Option<Furrow>,
    pace: Pace,
}

/// How drag along the plane is shared out between steps.
///
/// Half of a step's way is dragged before it and the rest after it (Strang splitting), so that gravity
/// and rolling friction see the mean of both: all of it after the step would tax what they gave in the
/// step by half of [`LOSS_OF_STEP`] too much.
#[derive(Debug, Clone, Copy, Default)]
struct Pace {
    /// Way along the plane of the step before (m): the one to come is taken to be as long.
    last_m: f64,
    /// Way to come that has been dragged already (m).
    paid_m: f64,
}

impl Pace {
    /// Way (m) to be dragged before a step.
    fn begin_step(&mut self) -> f64 {
        let owed_m = (0.5 * self.last_m - self.paid_m).max(0.0);
        self.paid_m += owed_m;
        owed_m
    }

    /// Way (m) still to be dragged after a step of so long a way (m), of which a share (–) was in contact.
    fn end_step(&mut self, way_m: f64, share: f64) -> f64 {
        let dragged_m = share * way_m;
        let paid_m = self.paid_m.min(dragged_m);
        self.paid_m -= paid_m;
        self.last_m = way_m;
        dragged_m - paid_m
    }

    /// Share of its way (–) that the last step of a contact is in contact.
    ///
    /// Contact ends somewhere in it, and where is not resolved: half is as likely too much as too little.
    /// But an impact on springs that is followed as a whole ends where it lets go.
    fn share_of_last(&self, has_springs: bool) -> f64 {
        if has_springs && self.last_m == 0.0 { 1.0 } else { 0.5 }
    }
}

impl Scars {
    /// None yet on these grounds; soil that does not drag is none.
    pub(crate) fn begin(&mut self, grounds: &[Ground], has_springs: bool) {
        let drags = |scar: &Scar| scar.drag * scar.soil_density_kg_m3 > 0.0;
        self.layers.clear();
        self.layers.extend(grounds.iter().map(|ground| ground.scar.filter(drags)));
        self.is_any = self.layers.iter().any(Option::is_some);
        self.has_springs = has_springs;
        (self.now, self.pace) = (None, Pace::default());
    }

    /// Whether any ground has soil that drags.
    #[inline]
    pub(crate) fn are_any(&self) -> bool {
        self.is_any
    }

    /// The normal of the first of these contacts, by triangle and normal, with a ground that has soil which drags.
    ///
    /// A scar lies in the plane of such a contact, whatever else the rock meets in it: a stem that it leans on is no
    /// floor that it could climb away from.
    pub(crate) fn floor(
        &self,
        world: &ContactEnvironment,
        mut contacts: impl Iterator<Item = (u32, Vec3)>,
    ) -> Option<Vec3> {
        let is_soft =
            |ground: u16| self.layers.get(usize::from(ground)).is_some_and(Option::is_some);
        contacts.find(|(triangle, _)| is_soft(world.ground_of(*triangle))).map(|(_, n)| n)
    }

    /// An impact on a ground, on a plane with this normal, with an approach (m/s) of a rock at a speed (m/s): what it keeps of its
    /// speed on the way in (–).
    pub(crate) fn enter(
        &mut self,
        body: &Body,
        (ground, normal): (u16, Vec3),
        (approach_m_s, speed_m_s): (f64, f64),
    ) -> f64 {
        let Some(scar) = self.layers.get(usize::from(ground)).copied().flatten() else {
            return 1.0;
        };
        // d = 0.1 M^(1/3) M_E^(−0.4) v_n^0.8 (Lu et al. 2019, Eq. 11), in the units that the
        // formula is bound to
        let depth_m = scar.depth_m(body.mass, approach_m_s.max(0.0));
        if depth_m <= self.now.map_or(0.0, |now| now.depth_m) {
            self.now = self.now.map(|now| Furrow { normal, ..now });
            return 1.0;
        }
        let drag_per_m3 = scar.drag_per_m3(body.mass);
        let per_m = drag_per_m3 * cut_area_m2(body.radius, depth_m, 0.0);
        self.now = Some(Furrow { depth_m, drag_per_m3, per_m, normal, longest_s: 0.0 });
        // speed over the way in: ∫ A ds is the volume that the ball sweeps down to d, along the
        // velocity
        let cosine = (approach_m_s / speed_m_s).min(1.0);
        math::exp(-drag_per_m3 * swept_m3(body.radius, depth_m, cosine))
    }

    /// What the rock keeps of its speed before a step along the plane (–): drag on the first half of it.
    pub(crate) fn plough_ahead(&mut self) -> f64 {
        let Some(now) = &self.now else { return 1.0 };
        math::exp(-now.per_m * self.pace.begin_step())
    }

    /// What the rock keeps of its speed after a step with a way (m) along the plane (–), in a contact with soil with this normal if any is known; and of the
    /// velocity before with which the contact `ends`, if it does. What [`Self::plough_ahead`] took is
    /// taken off.
    pub(crate) fn plough(
        &mut self,
        body: &Body,
        (way_m, normal): (f64, Option<Vec3>),
        ends: Option<Vec3>,
    ) -> f64 {
        let Some(now) = &mut self.now else { return 1.0 };
        now.normal = normal.unwrap_or(now.normal);
        let share = ends.map_or(1.0, |_| self.pace.share_of_last(self.has_springs));
        let kept = math::exp(-now.per_m * self.pace.end_step(way_m, share));
        ends.map_or(kept, |v| kept * self.leave(body, &(v * kept)))
    }

    /// The rock's contact ends at a velocity: what it keeps of it (–).
    pub(crate) fn leave(&mut self, body: &Body, v: &Vec3) -> f64 {
        let paid_m = std::mem::take(&mut self.pace).paid_m;
        let Some(now) = &mut self.now else { return 1.0 };
        // drag that a way which was not ploughed after all has taken counts for the way out
        let kept = |drag: f64, now: &Furrow| math::exp((now.per_m * paid_m - drag).min(0.0));
        let (speed, up) = (v.norm(), now.normal.dot(v));
        let pull = -now.normal.dot(&body.gravity);
        let falls_s = if pull > 0.0 { (2.0 * now.depth_m / pull).sqrt() } else { f64::INFINITY };
        now.longest_s = falls_s;
        if up <= 0.0 {
            return 1.0;
        }
        let swept = swept_m3(body.radius, now.depth_m, (up / speed).min(1.0));
        let kept_out = kept(now.drag_per_m3 * swept, now);
        if (up * kept_out).powi(2) >= 2.0 * pull * now.depth_m {
            self.now = None;
            return kept_out;
        }
        // too slow along the normal to climb d against gravity: it comes down in the same scar, and
        // the drag along the plane goes on
        let hop_s = 2.0 * up / pull;
        now.longest_s += hop_s;
        kept(now.per_m * speed * hop_s, now)
    }

    /// A flight of so long (s): out of the scar, if it takes longer than a hop in it.
    pub(crate) fn fly(&mut self, flight_s: f64) {
        self.now.take_if(|now| flight_s > now.longest_s);
    }

    /// Longest step along the plane (s) at a speed (m/s): drag acts between steps.
    pub(crate) fn longest_s(&self, speed_m_s: f64) -> f64 {
        self.now.map_or(f64::INFINITY, |now| LOSS_OF_STEP / (now.per_m * speed_m_s))
    }
}

/// Energy (J) that the soil takes of a rock that keeps a share of its velocity (–).
pub(crate) fn taken_j(body: &Body, v: &Vec3, kept: f64) -> f64 {
    0.5 * body.mass * v.norm_squared() * (1.0 - kept * kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// The hard plane lies far below the ball, so that all of it is cut, without gravity: `v = v₀ exp(−C ρ_s A z/2m)` with `A = π R²`, on the
    /// way in, square and at an angle, and along the plane, in one step or many.
    #[test]
    fn a_ball_deep_in_soil_slows_by_the_closed_form_of_drag() {
        let radius = 0.5;
        let mass = 2700.0 * 4.0 / 3.0 * PI * radius * radius * radius;
        let inertia = 0.4 * mass * radius * radius;
        let body = Body { mass, inertia, radius, gravity: Vec3::zeros() };
        let (up, speed) = (Vec3::z(), 10.0);
        for cosine in [1.0, 0.6] {
            let enter = |strength_kn_m2| {
                let scar = Scar { strength_kn_m2, drag: 2.5, soil_density_kg_m3: 1700.0 };
                let layers = vec![Some(scar)];
                let mut scars = Scars { layers, is_any: true, ..Scars::default() };
                let kept = scars.enter(&body, (0, up), (cosine * speed, speed));
                (scar.depth_m(mass, cosine * speed), kept, scars)
            };
            let (shallow, before, _) = enter(10.0);
            let (deep, after, mut scars) = enter(5.0);
            assert!(shallow > 2.0 * radius && deep > shallow);
            let area = PI * radius * radius;
            let per_m = 2.5 * 1700.0 * area / (2.0 * mass);
            let known = math::exp(-per_m * (deep - shallow) / cosine);
            assert!((after / before / known - 1.0).abs() < 1e-12, "{cosine}");
            let whole = scars.plough(&body, (0.7, Some(up)), None);
            assert!((whole / math::exp(-per_m * 0.7) - 1.0).abs() < 1e-12, "{whole}");
            // and shared out over the steps before and after as they come
            let mut ahead = 1.0;
            let parts: f64 = (0..7).map(|_| scars.plough(&body, (0.1, None), None)).product();
            scars.pace = Pace::default();
            for way_m in [0.1, 0.2, 0.02, 0.08, 0.1, 0.2] {
                ahead *= scars.plough_ahead();
                ahead *= scars.plough(&body, (way_m, None), None);
            }
            assert!((ahead / whole - 1.0).abs() < 1e-12, "{ahead} {whole}");
            assert!((parts / whole - 1.0).abs() < 1e-12, "{parts} {whole}");
        }
    }
}
