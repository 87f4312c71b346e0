//! Smooth random surfaces from integer hashes.

/// A random number in −1..1 for a lattice point, the same on every machine (finaliser of `SplitMix64`, Steele et al.
/// 2014).
pub(super) fn hash(seed: u64, i: u64, j: u64) -> f64 {
    let mut bits = seed
        .wrapping_add(i.wrapping_mul(0x9e37_79b9_7f4a_7c15))
        .wrapping_add(j.wrapping_mul(0xc2b2_ae3d_27d4_eb4f));
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    // 53 bits are exactly what an f64 holds.
    (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Value noise: random numbers in −1..1 on a lattice of spacing `wave_m`, joined with continuous curvature.
pub(super) fn value(seed: u64, wave_m: f64, x_m: f64, y_m: f64) -> f64 {
    let (u, v) = (x_m / wave_m, y_m / wave_m);
    let (i, j) = (u.floor(), v.floor());
    let at = |di: i64, dj: i64| hash(seed, map_grid(i, di), map_grid(j, dj));
    let (s, t) = (fade(u - i), fade(v - j));
    let south = at(0, 0) + s * (at(1, 0) - at(0, 0));
    let north = at(0, 1) + s * (at(1, 1) - at(0, 1));
    south + t * (north - south)
}

/// Gradient noise (Perlin 1985, 2002): random inclinations on a lattice of spacing `wave_m`, zero at its points.
/// Within −1..1, mostly within ±0.5.
pub(super) fn gradient(seed: u64, wave_m: f64, x_m: f64, y_m: f64) -> f64 {
    let (u, v) = (x_m / wave_m, y_m / wave_m);
    let (i, j) = (u.floor(), v.floor());
    let (a, b) = (u - i, v - j);
    let at = |di: i64, dj: i64| {
        let (i, j) = (map_grid(i, di), map_grid(j, dj));
        hash(seed, i, j) * (a - di as f64) + hash(!seed, i, j) * (b - dj as f64)
    };
    let (s, t) = (fade(a), fade(b));
    let south = at(0, 0) + s * (at(1, 0) - at(0, 0));
    let north = at(0, 1) + s * (at(1, 1) - at(0, 1));
    south + t * (north - south)
}

/// The number of a lattice line, negative ones wrapped around.
fn map_grid(line: f64, further: i64) -> u64 {
    (line as i64 + further).cast_unsigned()
}

/// `6 t⁵ − 15 t⁴ + 10 t³`: from 0 to 1 with slope and curvature zero at both ends.
pub(super) fn fade(t: f64) -> f64 {
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}
