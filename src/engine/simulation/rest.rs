//! The criterion of rest: slow for long enough, not getting faster and not turning round.
//!
//! A ball beside the top of a ridge and a heap that begins to slide are slow for a while; unlike a
//! rock at rest they speed up. A ball that has rolled up a gentle slope, or to and fro in a bowl,
//! is slow where it turns round; unlike a rock at rest its velocity keeps changing. A rock in a
//! settled heap jitters but goes nowhere. So the criterion does not compare the speed at two
//! instants, but the mean velocity over the two halves of the rule's time.
//!
//! ```text
//! slow:     max(|v|, R |ω|) < speed of the rule, over the whole time of the rule
//! no gain:  mean speed of the second half ≤ mean speed of the first half + 1 % of the rule's speed
//! no turn:  mean velocities of the centre over the halves differ by ≤ 10 % of the rule's speed
//! mean:     displacement of the centre, or of the rim by rotation, over the time of the half
//! ```
//!
//! Displacements are vectors, so that jitter adds up to nothing.
//!
//! Steps over a plane may be far longer than the time of the rule. Therefore a slow rock takes no
//! step beyond the current half, and a step within which it became slow does not count. So rest is
//! found when it is due, whatever the steps.

use crate::plan::RestRule;
use crate::rock::{Motion, Vec3};

/// Growth of the mean speed from one half of the rule's time to the next that still counts as none
/// (–, relative to the rule's speed): rounding, and the last creep of a heap.
const SPEED_GROWTH: f64 = 0.01;
/// Change of the mean velocity from one half of the rule's time to the next that is still rest (–,
/// relative to the rule's speed). With the usual rule this is 0.013 m/s², the acceleration of a
/// ball that rolls on 0.1° without rolling friction.
const VELOCITY_CHANGE: f64 = 0.1;

/// Shortest step that is requested to end with a half of the rule's time (–, relative to that
/// time): rounding must not leave a step of zero length.
const SHORTEST_STEP: f64 = 0.01;

/// State of the criterion for one rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RestCriterion {
    /// Centre at the start of the current half (m).
    half_start_m: Vec3,
    /// Displacement of the rim by rotation since then (m).
    rim_displacement_m: Vec3,
    /// Time since then (s).
    half_elapsed_s: f64,
    /// Mean speed over the half before, and mean velocity of the centre (m/s).
    previous_half_m_s: Option<(f64, Vec3)>,
    is_at_rest: bool,
}

impl RestCriterion {
    /// For a rock that was moving until now.
    pub(super) fn new(position_m: Vec3) -> Self {
        let rim_displacement_m = Vec3::zeros();
        Self {
            half_start_m: position_m,
            rim_displacement_m,
            half_elapsed_s: 0.0,
            previous_half_m_s: None,
            is_at_rest: false,
        }
    }

    /// Longest step (s) from `now` of a rock of this radius (m): to the end of the current half.
    pub(super) fn longest_s(&self, now: &Motion, radius_m: f64, rule: &RestRule) -> f64 {
        if !is_slow(now, radius_m, rule) {
            return f64::INFINITY;
        }
        (0.5 * rule.time_s - self.half_elapsed_s).max(SHORTEST_STEP * rule.time_s)
    }

    /// Adds a step of `dt` (s) between two instants, of a rock of this radius (m).
    pub(super) fn add_step(
        &mut self,
        dt: f64,
        [from, to]: [&Motion; 2],
        radius_m: f64,
        rule: &RestRule,
    ) {
        // too fast at one end: the rule's time starts again from here
        if ![from, to].iter().all(|motion| is_slow(motion, radius_m, rule)) {
            *self = Self::new(to.position_m);
            return;
        }
        self.half_elapsed_s += dt;
        self.rim_displacement_m += to.spin_rad_s * (radius_m * dt);
        // half of the rule's time is over: compare its mean velocity with that of the half before
        if self.half_elapsed_s >= 0.5 * rule.time_s {
            let per_time = 1.0 / self.half_elapsed_s.max(f64::MIN_POSITIVE);
            let velocity_m_s = (to.position_m - self.half_start_m) * per_time;
            let mean_m_s = velocity_m_s.norm().max(self.rim_displacement_m.norm() * per_time);
            let is_at_rest =
                self.previous_half_m_s.is_some_and(|(previous_speed, previous_velocity)| {
                    mean_m_s <= previous_speed + SPEED_GROWTH * rule.speed_m_s
                        && (velocity_m_s - previous_velocity).norm()
                            <= VELOCITY_CHANGE * rule.speed_m_s
                });
            let previous_half_m_s = Some((mean_m_s, velocity_m_s));
            *self = Self { previous_half_m_s, is_at_rest, ..Self::new(to.position_m) };
        }
    }

    /// Whether the rock was slow for the rule's time, did not get faster and did not turn round.
    pub(super) fn is_at_rest(&self) -> bool {
        self.is_at_rest
    }
}

/// Whether a rock is slower than the rule's speed.
fn is_slow(motion: &Motion, radius_m: f64, rule: &RestRule) -> bool {
    // a rock that spins on the spot moves at its rim: it is not at rest
    let rim_m_s = radius_m * motion.spin_rad_s.norm();
    motion.velocity_m_s.norm().max(rim_m_s) < rule.speed_m_s
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: RestRule = RestRule { speed_m_s: 0.02, time_s: 0.3 };

    /// Time after which a rock with velocity `v(t)` is at rest, if within 1 s, in the longest steps
    /// allowed that are no longer than `most_s`.
    fn rests_in(most_s: f64, v: impl Fn(f64) -> f64) -> Option<f64> {
        let still = Vec3::zeros();
        let at = |time_s: f64, x: f64| Motion {
            time_s,
            position_m: Vec3::new(x, 0.0, 0.0),
            velocity_m_s: Vec3::new(v(time_s), 0.0, 0.0),
            spin_rad_s: still,
        };
        let mut now = at(0.0, 0.0);
        let mut criterion = RestCriterion::new(still);
        while now.time_s < 1.0 {
            let dt = most_s.min(criterion.longest_s(&now, 0.5, &RULE));
            let middle_s = now.time_s + 0.5 * dt;
            let to = at(now.time_s + dt, now.position_m.x + v(middle_s) * dt);
            criterion.add_step(dt, [&now, &to], 0.5, &RULE);
            now = to;
            if criterion.is_at_rest() {
                return Some(now.time_s);
            }
        }
        None
    }

    fn rests_after(v: impl Fn(f64) -> f64) -> Option<f64> {
        rests_in(1e-3, v)
    }

    /// However long the steps could be: a rock that stands is at rest when the rule's time is over.
    /// One that stops within a step of 0.2 s is at rest when the rule's time is over, counted from
    /// the end of that step.
    #[test]
    fn long_steps_put_rest_off_by_no_more_than_the_one_that_stops_the_rock() {
        assert!((rests_in(10.0, |_| 0.0).unwrap() - 0.3).abs() < 1e-12);
        let stops = |t: f64| (0.25 - 1.4 * t).max(0.0);
        let due_s = (0.25 - 0.02) / 1.4 + 0.3;
        for most_s in [1e-3, 0.02, 0.2] {
            let found_s = rests_in(most_s, stops).unwrap();
            assert!(due_s - 1e-12 <= found_s && found_s < due_s + most_s, "{most_s}: {found_s}");
        }
    }

    /// Constant, slowing down, jittering: at rest after the rule's time. Speeding up, even by a
    /// five-hundredth of gravity: not.
    #[test]
    fn what_speeds_up_does_not_rest() {
        for v in
            [|_| 0.0, |_| 0.019, |t: f64| 0.015 * (-t).exp(), |t: f64| 0.01 * (300.0 * t).sin()]
        {
            assert!((rests_after(v).unwrap() - 0.3).abs() < 2e-3);
        }
        assert_eq!(rests_after(|t| 0.018 * t), None);
        assert_eq!(rests_after(|t| 0.1 * t), None);
        assert_eq!(rests_after(|t| 0.001 * (3.0 * t).exp()), None);
    }

    /// A ball that rolls up 0.5° and down again, slow for 0.65 s while it turns round: not at rest.
    /// A ball that friction stops: at rest as soon as it stands.
    #[test]
    fn what_turns_round_does_not_rest() {
        assert_eq!(rests_after(|t| 0.03 - 0.061 * t), None);
        assert!(rests_after(|t| (0.03 - 0.061 * t).max(0.0)).unwrap() < 0.8);
    }

    /// A ball that slows down by 0.02 m/s² and then gets faster in the other direction is not at
    /// rest, though it is never faster than a quarter of the rule's speed. With half that
    /// deceleration, as on 0.1°, it is.
    #[test]
    fn a_slow_turn_is_told_by_its_deceleration() {
        assert_eq!(rests_after(|t| 0.02 * (0.15 - t)), None);
        assert!((rests_after(|t| 0.01 * (0.15 - t)).unwrap() - 0.3).abs() < 2e-3);
    }

    /// A rock that spins ever faster on the spot, its rim slower than the rule's speed, is not at
    /// rest; one whose spin does not grow is.
    #[test]
    fn what_spins_ever_faster_on_its_place_does_not_rest() {
        let rests = |spin: fn(f64) -> f64| {
            let still = Vec3::zeros();
            let mut criterion = RestCriterion::new(still);
            let at = |time_s: f64| Motion {
                time_s,
                position_m: still,
                velocity_m_s: still,
                spin_rad_s: Vec3::z() * spin(time_s),
            };
            (0..1000).map(|k| 1e-3 * f64::from(k)).any(|time_s| {
                criterion.add_step(1e-3, [&at(time_s), &at(time_s + 1e-3)], 0.5, &RULE);
                criterion.is_at_rest()
            })
        };
        assert!(rests(|_| 0.03) && rests(|t| 0.03 - 0.02 * t));
        assert!(!rests(|t| 0.03 * t));
    }
}
