//! Rows of the rocks, in whole numbers.

use super::Shown;
use super::frame::{QuantizedBox, is_finite};
use super::pack::Section;
use crate::hazard::{Row, StopKind};
use serde_json::json;

/// Stands for a rock without a place: a failed one may have none.
const NOWHERE: u32 = 9;
/// Bits of the mantissa that are dropped: what is left is good to 6e-5.
const DROPPED_BITS: u32 = 10;

/// Name and value of a column.
type Number = (&'static str, fn(&Row) -> f64);

/// Columns of 32-bit floats: what a click shows.
const NUMBERS: [Number; 7] = [
    ("radius_m", |row| row.radius_m),
    ("mass_kg", |row| row.mass_kg),
    ("runout_m", |row| row.runout_m),
    ("reach_angle_deg", |row| row.reach_angle_deg),
    ("max_speed_m_s", |row| row.max_speed_m_s),
    ("max_total_j", |row| row.max_total_j),
    ("max_height_m", |row| row.max_height_m),
];

/// Packed as text: place of the end, reason, and what a click shows.
pub(super) fn text(shown: &Shown) -> String {
    let rows = &shown.rows;
    let frame = QuantizedBox::round(rows.iter().map(|row| row.end_m));
    let mut section = Section::new(
        json!({ "frame": frame, "first": shown.first_release, "all": shown.releases }),
    );
    let end = |row: &Row| if is_finite(&row.end_m) { frame.steps(row.end_m) } else { [0; 3] };
    section.add("end", 3, 0, rows.iter().flat_map(end).collect());
    section.add("stop", 1, 0, rows.iter().map(stop).collect());
    section.add("impacts", 1, 0, rows.iter().map(|row| row.impacts).collect());
    section.add("tree_impacts", 1, 0, rows.iter().map(|row| row.tree_impacts).collect());
    for (name, of) in NUMBERS {
        section.add(name, 1, 0, rows.iter().map(|row| short(of(row))).collect());
    }
    section.text()
}

fn stop(row: &Row) -> u32 {
    let place = StopKind::ALL.iter().position(|kind| *kind == row.stop);
    place.filter(|_| is_finite(&row.end_m)).map_or(NOWHERE, |place| place as u32)
}

/// The bits of the nearest 32-bit float with a short mantissa: what does not matter need not be packed.
fn short(value: f64) -> u32 {
    let value = value as f32;
    if !value.is_finite() {
        return f32::NAN.to_bits();
    }
    let half = 1 << (DROPPED_BITS - 1);
    (value.to_bits() + half) & !((1 << DROPPED_BITS) - 1)
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn a_shortened_number_is_good_to_four_digits() {
        for k in -200..200 {
            let value = 1.234_567_f64 * 1.3_f64.powi(k);
            let read = f64::from(f32::from_bits(short(value)));
            assert!((read / value - 1.0).abs() < 6.2e-5, "{value}: {read}");
        }
        assert!(f32::from_bits(short(f64::NAN)).is_nan());
    }
}
