//! The sides of all zones, sorted into strips from south to north.

use super::{Corner, Patch, exact_side};

/// Strips at most: a strip is as high as it takes to hold a few sides.
const MOST_STRIPS: usize = 4096;

/// Sides of zones with quick answers to "what is near" and "what is here".
#[derive(Debug)]
pub(super) struct Borders {
    /// Both ends of each side, the western one first: two zones with a common border have the very same side.
    sides: Vec<[Corner; 2]>,
    /// Zone of each side.
    zone_of: Vec<u32>,
    /// Ground of each zone.
    grounds: Vec<u16>,
    south_m: f64,
    strip_m: f64,
    /// Sides that touch each strip, in the order of the zones.
    strips: Vec<Vec<u32>>,
}

impl Borders {
    pub(super) fn of(patches: &[Patch]) -> Self {
        let (mut sides, mut zone_of) = (Vec::new(), Vec::new());
        for (zone, patch) in (0u32..).zip(patches) {
            for ring in &patch.rings_m {
                for (k, &from) in ring.iter().enumerate() {
                    let to = ring[(k + 1) % ring.len()];
                    if is_other(from, to) {
                        sides.push(if before(from, to) { [from, to] } else { [to, from] });
                        zone_of.push(zone);
                    }
                }
            }
        }
        let heights = || sides.iter().flatten().map(|corner| corner[1]);
        let (south_m, north_m) =
            (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let count = sides.len().clamp(1, MOST_STRIPS);
        let strip_m = ((north_m - south_m) / count as f64).max(f64::MIN_POSITIVE);
        let grounds = patches.iter().map(|patch| patch.ground).collect();
        let strips = vec![Vec::new(); count];
        let mut borders = Self { sides, zone_of, grounds, south_m, strip_m, strips };
        for number in 0..borders.sides.len() {
            let [a, b] = borders.sides[number];
            for strip in borders.span(a[1].min(b[1]), a[1].max(b[1])) {
                borders.strips[strip].push(number as u32);
            }
        }
        borders
    }

    fn span(&self, low_m: f64, high_m: f64) -> std::ops::Range<usize> {
        let strip = |at: f64| ((at - self.south_m) / self.strip_m).floor();
        let last = self.strips.len() as f64 - 1.0;
        if strip(high_m) < -1.0 || strip(low_m) > last + 1.0 {
            return 0..0;
        }
        // a strip more on each side for rounding
        let (first, end) =
            ((strip(low_m) - 1.0).clamp(0.0, last), (strip(high_m) + 1.0).clamp(0.0, last));
        first as usize..end as usize + 1
    }

    /// Ground of the uppermost zone at a point; none outside of all.
    pub(super) fn ground_at(&self, at: Corner) -> Option<u16> {
        let mut found = None;
        // Sides stand in a strip more on each side than they touch: the point's own holds all at its height.
        let strip = (at[1] - self.south_m) / self.strip_m;
        let strip =
            self.strips.get(strip.floor().clamp(0.0, self.strips.len() as f64 - 1.0) as usize)?;
        let (mut zone, mut inside) = (u32::MAX, false);
        for &number in strip {
            let [a, b] = self.sides[number as usize];
            if self.zone_of[number as usize] != zone {
                if inside {
                    found = Some(zone);
                }
                (zone, inside) = (self.zone_of[number as usize], false);
            }
            // half-open, so that a corner counts once
            if (a[1] <= at[1]) != (b[1] <= at[1]) {
                let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
                inside ^= exact_side(low, high, at) > 0.0;
            }
        }
        if inside {
            found = Some(zone);
        }
        found.map(|zone| self.grounds[zone as usize])
    }

    /// Sides whose box meets the box of a triangle, each once.
    pub(super) fn near(&self, corners: [Corner; 3]) -> Vec<[Corner; 2]> {
        let low = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
        let high = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
        let ([west, south], [east, north]) = ([low(0), low(1)], [high(0), high(1)]);
        let mut numbers: Vec<u32> = Vec::new();
        for strip in self.span(south, north) {
            numbers.extend(self.strips[strip].iter().filter(|&&number| {
                let [a, b] = self.sides[number as usize];
                // ends are sorted from west to east
                a[0] <= east && b[0] >= west && a[1].min(b[1]) <= north && a[1].max(b[1]) >= south
            }));
        }
        numbers.sort_unstable();
        numbers.dedup();
        let mut sides: Vec<[Corner; 2]> = numbers.iter().map(|&n| self.sides[n as usize]).collect();
        sides.dedup();
        sides
    }
}

/// Whether two corners differ, in any digit.
pub(super) fn is_other([ax, ay]: Corner, [bx, by]: Corner) -> bool {
    (ax - bx).abs() > 0.0 || (ay - by).abs() > 0.0
}

/// Whether a corner lies west of another, or south where both are as far west.
pub(super) fn before(a: Corner, b: Corner) -> bool {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).is_lt()
}
