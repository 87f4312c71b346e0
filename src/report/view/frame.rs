//! Places in whole numbers of a quantum above a low corner.

use serde::{Deserialize, Serialize};

/// Steps of the finest coding: two bytes a coordinate.
const STEPS: f64 = 65_535.0;
/// Largest quantum (m): what two bytes give on 2 km. A longer box takes a third byte.
const COARSEST_M: f64 = 0.03;
/// Most steps along any side: places so far out that they need more are not drawn.
const MOST_STEPS: f64 = 4e9;

/// Where a box lies and how finely it is divided.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct QuantizedBox {
    /// Lowest corner, map coordinates (m).
    pub low_m: [f64; 3],
    /// Length of a step (m), positive.
    pub quantum_m: f64,
}

impl QuantizedBox {
    /// The frame of the finite ones of some places.
    pub fn round(places: impl Iterator<Item = [f64; 3]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for place in places.filter(is_finite) {
            for axis in 0..3 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        }
        let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        let quantum_m = if longest > 0.0 { (longest / STEPS).min(COARSEST_M) } else { 1.0 };
        let quantum_m = quantum_m.max(longest / MOST_STEPS);
        let low_m = if low[0].is_finite() { low } else { [0.0; 3] };
        Self { low_m, quantum_m }
    }

    /// The step nearest to a place inside.
    pub fn steps(&self, place_m: [f64; 3]) -> [u32; 3] {
        std::array::from_fn(|axis| {
            ((place_m[axis] - self.low_m[axis]) / self.quantum_m).round() as u32
        })
    }

    /// The place of a step (m), at most half a quantum from the one that gave it.
    pub fn place_m(&self, steps: [u32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.low_m[axis] + f64::from(steps[axis]) * self.quantum_m)
    }
}

/// Whether a place is one.
pub(super) fn is_finite(place: &[f64; 3]) -> bool {
    place.iter().all(|x| x.is_finite())
}
