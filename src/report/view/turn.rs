//! How a block turns between two instants of its path.
//!
//! Two attitudes leave open how often it went round between them, and an interpolation that takes the short way turns a
//! block that spins by more than half a round between two instants backwards. The spin decides: of all turns from one
//! attitude to the next about their common axis, the one nearest to what the spin says.

use super::hulls::unit;
use crate::rock::Vec3;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Steps of each of the three smaller numbers of a quaternion, which lie between ±1/√2: attitudes are good to 0.28°.
const STEPS: f64 = 1023.0;
/// Shorter, the vector part of a turn has no direction (–).
const NO_TURN: f64 = 1e-9;

/// A turn about a fixed axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisTurn {
    /// Unit axis.
    axis: Vec3,
    /// Angle of the short way (rad), 0 to π.
    short_rad: f64,
    /// Whole rounds beyond it, of either sign.
    pub(super) rounds: i32,
}

impl AxisTurn {
    /// The turn between two attitudes that is nearest to `spun_rad`, axis times angle of what the spin says.
    pub(super) fn between(from: [f64; 4], to: [f64; 4], spun_rad: Vec3) -> Self {
        let way = unit(to) * unit(from).inverse();
        let sign = if way.w < 0.0 { -1.0 } else { 1.0 };
        let vector = way.imag() * sign;
        let length = vector.norm();
        let axis = if length > NO_TURN { vector / length } else { any_unit(spun_rad) };
        let short_rad = 2.0 * crate::math::atan2(length, way.w * sign);
        let rounds = ((axis.dot(&spun_rad) - short_rad) / TAU).round() as i32;
        Self { axis, short_rad, rounds }
    }

    /// Its angle (rad), negative against the axis.
    pub(super) fn angle_rad(&self) -> f64 {
        self.short_rad + TAU * f64::from(self.rounds)
    }

    /// The attitude a share `s` of the way on from `from`, on the same side as `from` where that is near.
    pub(super) fn at(&self, from: [f64; 4], s: f64) -> [f64; 4] {
        let (sin, cos) = crate::math::sin_cos(0.5 * s * self.angle_rad());
        let way = [cos, self.axis.x * sin, self.axis.y * sin, self.axis.z * sin];
        let turned = unit(way) * unit(from);
        [turned.w, turned.i, turned.j, turned.k]
    }
}

fn any_unit(v: Vec3) -> Vec3 {
    v.try_normalize(0.0).unwrap_or_else(Vec3::z)
}

/// A unit quaternion as one number: which of w, x, y, z is the largest (bits 30 and 31), and the steps of the other three in
/// order from bit 20 down, the largest being positive.
pub(super) fn packed(attitude: [f64; 4]) -> u32 {
    let largest = (0..4).fold(
        0,
        |most: usize, k| {
            if attitude[k].abs() > attitude[most].abs() { k } else { most }
        },
    );
    let sign = if attitude[largest] < 0.0 { -1.0 } else { 1.0 };
    let step = |x: f64| {
        let share = 0.5 * (sign * x / FRAC_1_SQRT_2 + 1.0);
        (share.clamp(0.0, 1.0) * STEPS).round() as u32
    };
    let others = (0..4).filter(|k| *k != largest);
    others.fold(largest as u32, |word, k| word << 10 | step(attitude[k]))
}

/// A number of either sign as one that has none: 0, −1, 1, −2 …
pub(super) fn folded(number: i32) -> u32 {
    ((number << 1) ^ (number >> 31)).cast_unsigned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unpacked(word: u32) -> [f64; 4] {
        let step =
            |shift: u32| FRAC_1_SQRT_2 * (2.0 * f64::from(word >> shift & 1023) / STEPS - 1.0);
        let three = [step(20), step(10), step(0)];
        let last = (1.0 - three.iter().map(|x| x * x).sum::<f64>()).max(0.0).sqrt();
        let mut all = three.to_vec();
        all.insert((word >> 30) as usize, last);
        [all[0], all[1], all[2], all[3]]
    }

    /// Attitudes all round come back to 0.28°, the worst that half a step in three numbers does, whichever number is the largest.
    #[test]
    fn a_packed_attitude_is_good_to_a_third_of_a_degree() {
        let mut worst: f64 = 0.0;
        for k in 0..2000 {
            let x = f64::from(k);
            let one = unit([(0.7 * x).sin(), (1.3 * x).cos(), (2.1 * x).sin(), (0.37 * x).cos()]);
            let packed = packed([one.w, one.i, one.j, one.k]);
            worst = worst.max(one.angle_to(&unit(unpacked(packed))).to_degrees());
        }
        assert!(worst < 0.28 && worst > 0.1, "{worst}");
        assert_eq!(packed([1.0, 0.0, 0.0, 0.0]), packed([-1.0, 0.0, 0.0, 0.0]));
    }

    /// A wheel that spins steadily is turned by what it has spun, however far that is beyond half a round.
    #[test]
    fn rounds_are_those_of_the_spin() {
        let axis = Vec3::new(1.0, -2.0, 0.5).normalize();
        let start = [0.3, 0.1, -0.8, 0.4];
        for k in -40..40 {
            let angle = 0.37 * f64::from(k);
            let (sin, cos) = (0.5 * angle).sin_cos();
            let way = unit([cos, axis.x * sin, axis.y * sin, axis.z * sin]);
            let end = way * unit(start);
            let end = [end.w, end.i, end.j, end.k];
            // a spin that is a third of a round off still leads to the right one
            let turn = AxisTurn::between(start, end, axis * (angle + 2.0));
            let signed = turn.angle_rad() * turn.axis.dot(&axis);
            assert!((signed - angle).abs() < 1e-9 || k == 0, "{angle} {turn:?}");
            let arrived = unit(turn.at(start, 1.0)).angle_to(&unit(end));
            assert!(arrived < 1e-7, "{arrived}");
            // a turn and minus its whole rounds from the other side meet half-way
            let half = unit(turn.at(start, 0.5)).angle_to(&unit(start));
            let expected = (0.5 * angle).rem_euclid(TAU);
            assert!((half - expected.min(TAU - expected)).abs() < 1e-7, "{half} {expected}");
        }
        assert_eq!([0, -1, 1, -2].map(folded), [0, 1, 2, 3]);
    }
}
