//! The same law as printed, in SI units and world vectors, integrated by a fixed classical step
//! that is far too short: slow and independent.

use crate::math;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::impact::FrozenContact;
use crate::solver::law::clamp_norm;

/// Motion and history; `way` is the displacement of the centre.
#[derive(Debug, Clone)]
pub(super) struct OracleState {
    pub(super) way: Vec3,
    pub(super) v: Vec3,
    pub(super) w: Vec3,
    pub(super) shear: Vec<Vec3>,
    pub(super) roll: Vec<Vec3>,
    /// Friction, shear and normal dashpots, rolling (J).
    pub(super) lost: [f64; 3],
}

impl OracleState {
    pub(super) fn new(v: Vec3, w: Vec3, contacts: usize) -> Self {
        let none = vec![Vec3::zeros(); contacts];
        Self { way: Vec3::zeros(), v, w, shear: none.clone(), roll: none, lost: [0.0; 3] }
    }

    fn moved(&self, rate: &Self, h: f64) -> Self {
        let sum = |x: &[Vec3], y: &[Vec3]| x.iter().zip(y).map(|(x, y)| x + y * h).collect();
        Self {
            way: self.way + rate.way * h,
            v: self.v + rate.v * h,
            w: self.w + rate.w * h,
            shear: sum(&self.shear, &rate.shear),
            roll: sum(&self.roll, &rate.roll),
            lost: [0, 1, 2].map(|k| self.lost[k] + h * rate.lost[k]),
        }
    }
}

/// Penetration of a contact (m).
fn depth(touch: &FrozenContact, at: &OracleState) -> f64 {
    -touch.normal.dot(&at.way)
}

/// Normal force of every contact (N); `pressed` are the closed ones.
pub(super) fn pushes(touches: &[FrozenContact], pressed: &[bool], at: &OracleState) -> Vec<f64> {
    let share = |k: usize| -> f64 {
        let cosine = |j: usize| touches[k].normal.dot(&touches[j].normal).max(0.0);
        let sum: f64 = (0..touches.len()).filter(|j| pressed[*j]).map(|j| cosine(j).powi(2)).sum();
        1.0 / sum.sqrt()
    };
    let normal_force = |k: usize| {
        let touch = &touches[k];
        let [p_n, c_n, c_n_captured] = touch.law.coefficients().normal;
        let c_n = if touch.captured { c_n_captured } else { c_n };
        let c = c_n * touch.stiffness_scale.sqrt() * share(k);
        p_n * touch.stiffness_scale * depth(touch, at) - c * touch.normal.dot(&at.v)
    };
    (0..touches.len()).map(|k| if pressed[k] { normal_force(k).max(0.0) } else { 0.0 }).collect()
}

fn rate(body: &Body, touches: &[FrozenContact], pressed: &[bool], at: &OracleState) -> OracleState {
    let mut rate = OracleState::new(body.gravity, Vec3::zeros(), touches.len());
    rate.way = at.v;
    let normal_force = pushes(touches, pressed, at);
    for (k, touch) in touches.iter().enumerate() {
        let (n, law, force) = (&touch.normal, touch.law, normal_force[k]);
        let slip = body.slip(n, &at.v, &at.w);
        let mut shear_force = Vec3::zeros();
        let [p_s, c_s, friction] = law.coefficients().shear;
        if friction > 0.0 {
            shear_force = clamp_norm(at.shear[k] * p_s + slip * c_s, friction * force);
            rate.shear[k] = (shear_force - at.shear[k] * p_s) / c_s;
        }
        let mut rolling_moment = Vec3::zeros();
        let [k_r, c_r, rolling_m] = law.coefficients().rolling;
        if k_r > 0.0 {
            rolling_moment = clamp_norm(at.roll[k] * k_r + at.w * c_r, rolling_m * force);
            rate.roll[k] = (rolling_moment - at.roll[k] * k_r) / c_r;
        }
        rate.v += (n * force - shear_force) / body.mass;
        rate.w += (n.cross(&shear_force) * body.radius - rolling_moment) / body.inertia;
        rate.lost[0] += shear_force.dot(&(slip - rate.shear[k]));
        rate.lost[1] += shear_force.dot(&rate.shear[k]) - force * n.dot(&at.v);
        rate.lost[2] += rolling_moment.dot(&at.w);
    }
    rate
}

/// One classical step of order 4.
fn step(
    body: &Body,
    touches: &[FrozenContact],
    pressed: &[bool],
    at: &OracleState,
    h: f64,
) -> OracleState {
    let k1 = rate(body, touches, pressed, at);
    let k2 = rate(body, touches, pressed, &at.moved(&k1, 0.5 * h));
    let k3 = rate(body, touches, pressed, &at.moved(&k2, 0.5 * h));
    let k4 = rate(body, touches, pressed, &at.moved(&k3, h));
    let mut end = at.clone();
    for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
        end = end.moved(&k, h * weight / 6.0);
    }
    end
}

/// Integrates an impact with `per_radian` steps until no contact pushes and none closes, then until
/// the penetration is zero if there is but one contact; returns the end and its time (s).
pub(super) fn follow(
    body: &Body,
    touches: &[FrozenContact],
    (v, w): (Vec3, Vec3),
    per_radian: f64,
) -> (OracleState, f64) {
    let omega = |touch: &FrozenContact| {
        (touch.law.coefficients().normal[0] * touch.stiffness_scale / body.mass).sqrt()
    };
    let h = 1.0 / (per_radian * touches.iter().map(omega).fold(0.0, f64::max));
    let mut at = OracleState::new(v, w, touches.len());
    let mut pressed: Vec<bool> = touches.iter().map(|touch| touch.normal.dot(&v) < 0.0).collect();
    let mut t = 0.0;
    for _ in 0..100_000_000u64 {
        let next = step(body, touches, &pressed, &at, h);
        let normal_force = pushes(touches, &pressed, &next);
        let ends = (0..touches.len())
            .all(|k| normal_force[k] <= 0.0 && touches[k].normal.dot(&next.v) >= 0.0);
        if ends && touches.len() == 1 {
            // The moment of lift-off lies within this step.
            let holds = |time: f64| {
                let there = step(body, touches, &pressed, &at, time);
                pushes(touches, &pressed, &there)[0] > 0.0
            };
            let [_, hi] = math::bisected([0.0, h], 60, holds);
            at = step(body, touches, &pressed, &at, hi);
            let n = &touches[0].normal;
            let (x, up, g) = (depth(&touches[0], &at), n.dot(&at.v), -n.dot(&body.gravity));
            let out = 2.0 * x / (up + (up * up - 2.0 * g * x).sqrt());
            at.way += (at.v + body.gravity * (0.5 * out)) * out;
            at.v += body.gravity * out;
            return (at, t + hi + out);
        }
        (at, t) = (next, t + h);
        if ends {
            break;
        }
        for (k, touch) in touches.iter().enumerate() {
            pressed[k] = depth(touch, &at) > 0.0;
        }
    }
    (at, t)
}
