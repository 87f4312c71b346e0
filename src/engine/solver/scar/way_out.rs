//! Exit from a scar, and hops that end in it.
//!
//! A rock that lifts off at a normal speed `u`, `u²/2g = h₀`, rises to `h` and loses `S(h)` on the
//! way, the drag of the soil between the depths `d` and `d − h` as a logarithm of the speed.
//! Gravity acts separately afterwards, so that `h = h₀ exp(−2 S(h))`. If this is at least `d` with
//! all of the drag, the rock leaves its scar with a hop of that height over the plane. Otherwise it
//! rises to the `h` that solves the equation, at most to the rim: as `S` grows with drag, more drag
//! never makes a hop higher, and the two cases agree at the rim.

use super::{ActiveScar, Scars};
use crate::ground::{cut_area_m2, over_unit, swept_m3};
use crate::math;
use crate::rock::Vec3;
use crate::solver::body::Body;

/// For rises below this share of the depth (–) the cut area at the bottom is used: the difference
/// of two swept volumes is rounding there.
const SHALLOW: f64 = 1e-6;
/// Newton steps for the height of a hop, at most, and its relative accuracy (–).
const MOST_STEPS: u32 = 30;
const EXACT: f64 = 1e-13;

/// A ball that leaves the plane: its radius (m), and the cosine of its velocity to the normal.
type Leaving = (f64, f64);

impl ActiveScar {
    /// Drag on a rise (m) from the plane, straight along the velocity (–), as a logarithm of the
    /// speed.
    fn drag_up(&self, (radius_m, cosine): Leaving, rise_m: f64) -> f64 {
        let depth_m = self.depth_m;
        let swept_m3 = if rise_m < SHALLOW * depth_m {
            cut_area_m2(radius_m, depth_m, cosine) * (rise_m / cosine)
        } else {
            let below = |from_m: f64| swept_m3(radius_m, from_m, cosine);
            below(depth_m) - below((depth_m - rise_m).max(0.0))
        };
        self.drag_per_m3 * swept_m3
    }

    /// Height (m) of a hop in the soil that would rise to `free_m` without it: the `h` of
    /// `h = h₀ exp(−2 S(h))`.
    ///
    /// `ln h + 2 S(h)` is concave, because the ball gets less deep: Newton steps from below never
    /// pass the root.
    fn rise_m(&self, leaving: Leaving, free_m: f64) -> f64 {
        let drag = |rise_m: f64| self.drag_up(leaving, rise_m) - self.prepaid;
        let top_m = free_m.min(self.depth_m);
        if drag(top_m) <= 0.0 {
            return top_m;
        }
        // y eʸ = z has y ≥ z/(1 + z), and the drag per metre is largest at the start of the rise
        let cut = |rise_m: f64| {
            let area_m2 = cut_area_m2(leaving.0, self.depth_m - rise_m, leaving.1);
            2.0 * self.drag_per_m3 * area_m2 / leaving.1
        };
        let mut rise_m = free_m / (1.0 + cut(0.0) * free_m);
        for _ in 0..MOST_STEPS {
            let per_m = 1.0 / rise_m + cut(rise_m);
            let further_m = (math::ln(free_m / rise_m) - 2.0 * drag(rise_m)) / per_m;
            rise_m += further_m;
            if further_m <= EXACT * rise_m {
                break;
            }
        }
        rise_m.min(top_m)
    }
}

impl Scars {
    /// End of contact at a velocity: the share that the rock keeps on its exit (–). A rock whose
    /// normal speed is then too small to climb `d` against gravity stays in its scar, with the drag
    /// of the rise up to where it stops.
    pub(crate) fn leave(&mut self, body: &Body, v: &Vec3) -> f64 {
        let paid_m = std::mem::take(&mut self.split).paid_m;
        let Some(now) = &mut self.active else { return 1.0 };
        now.prepaid += now.per_m * paid_m;
        let (speed, up) = (v.norm(), now.normal.dot(v));
        if up <= 0.0 {
            return 1.0;
        }
        let leaving = (body.radius, (up / speed).min(1.0));
        let kept = math::exp((now.prepaid - now.drag_up(leaving, now.depth_m)).min(0.0));
        let pull = now.pull(body);
        if (up * kept).powi(2) >= 2.0 * pull * now.depth_m {
            self.active = None;
            return kept;
        }
        let free_m = 0.5 * up * up / pull;
        if free_m <= 0.0 {
            return 1.0;
        }
        let rise_m = now.rise_m(leaving, free_m);
        now.prepaid = now.prepaid.max(now.drag_up(leaving, rise_m));
        (rise_m / free_m).sqrt().min(1.0)
    }

    /// End of a flight of `flight_s` (s) at a velocity: the share that the rock keeps (–) after the
    /// drag of the soil that it has flown through and that was not prepaid. It is out of the scar
    /// if it has risen over the soil meanwhile.
    ///
    /// Its height over the chord of a flight of `T` is `g_n t (T − t)/2`, whatever its speed and
    /// landing point.
    pub(crate) fn fly(&mut self, body: &Body, v: &Vec3, flight_s: f64) -> f64 {
        let Some(now) = &mut self.active else { return 1.0 };
        let pull = now.pull(body);
        let rises_out = flight_s * flight_s - 8.0 * now.depth_m / pull;
        let is_out = pull <= 0.0 || rises_out > 0.0;
        // in soil until it is out; the next entry is that of the next impact
        let until_s = if is_out { 0.5 * (flight_s - rises_out.max(0.0).sqrt()) } else { flight_s };
        let swept = |x: f64| {
            let t = x * until_s;
            let risen_m = 0.5 * pull * t * (flight_s - t);
            let then = v - body.gravity * (flight_s - t);
            let speed = then.norm();
            let cosine = (now.normal.dot(&then).abs() / speed.max(f64::MIN_POSITIVE)).min(1.0);
            speed * cut_area_m2(body.radius, now.depth_m - risen_m, cosine)
        };
        // rise and fall separately: a rock thrown straight up reverses between them
        let halves = [0.0, 0.5].map(|from| over_unit(|x| swept(from + 0.5 * x)));
        let drag = now.drag_per_m3 * until_s * 0.5 * (halves[0] + halves[1]);
        let kept = math::exp((now.prepaid - drag).min(0.0));
        // the end of the contact may be followed by another one without a flight
        now.prepaid = (now.prepaid - drag).max(0.0);
        if is_out {
            self.active = None;
        }
        kept
    }
}
