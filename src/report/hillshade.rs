//! The shape of the ground as a light grey picture under the lines.

use super::svg::path::{PaperFrame, tenths};
use base64::Engine;

/// Grey of the darkest and of the lightest ground: light enough for thin lines.
const DARKEST: f64 = 178.0;
const LIGHTEST: f64 = 250.0;
/// Steps of grey: more cannot be told apart in print and only make the file larger.
const STEP: f64 = 2.0;
/// Paper where there is no ground.
const PAPER: u8 = 255;
/// Direction to the light: from the north-west, 45° high, as maps are lit.
const LIGHT: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
/// Least range of shade (–) that is stretched over all greys: smoother ground stays evenly grey.
const LEAST_RANGE: f64 = 0.35;
/// Share of the ground that may be darker or lighter than the stretched range.
const CUT: f64 = 0.02;

/// Cosine between ground that rises by `east` and `north` per metre and the light; NaN where there is none.
fn shade((east, north): (f64, f64)) -> f64 {
    let length = (1.0 + east * east + north * north).sqrt();
    (LIGHT[2] - LIGHT[0] * east - LIGHT[1] * north) / length
}

/// An `<image>` that fills `frame` (one grey value a pixel of paper), or nothing when it cannot be packed.
///
/// `slope(x_px, y_px)` is the rise of the ground to the east and to the north per metre at a place on the paper.
pub(super) fn image(frame: &PaperFrame, slope: impl Fn(f64, f64) -> (f64, f64)) -> String {
    let (width, height) = (frame.width().ceil() as u32, frame.height().ceil() as u32);
    let mut shades = Vec::with_capacity(width as usize * height as usize);
    for row in 0..height {
        for column in 0..width {
            let x = frame.left + (f64::from(column) + 0.5) * frame.width() / f64::from(width);
            let y = frame.top + (f64::from(row) + 0.5) * frame.height() / f64::from(height);
            shades.push(shade(slope(x, y)));
        }
    }
    let Ok(png) = packed(&greys(&shades), width, height) else { return String::new() };
    let data = base64::engine::general_purpose::STANDARD.encode(png);
    let ((x0, y0), (x1, y1)) =
        (tenths((frame.left, frame.top)), tenths((frame.right, frame.bottom)));
    // `xlink:href`, not `href`: older programs know only this one
    format!(
        r#"<image x="{x0}" y="{y0}" width="{}" height="{}" preserveAspectRatio="none" xlink:href="data:image/png;base64,{data}"/>"#,
        x1 - x0,
        y1 - y0
    )
}

/// Shades stretched over the greys, so that a slope facing away from the light is not all dark.
fn greys(shades: &[f64]) -> Vec<u8> {
    let mut sorted: Vec<f64> = shades.iter().copied().filter(|s| s.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let at =
        |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied().unwrap_or(0.0);
    let (low, high) = (at(CUT), at(1.0 - CUT));
    let (middle, range) = (0.5 * (low + high), (high - low).max(LEAST_RANGE));
    let grey = |&shade: &f64| {
        if shade.is_nan() {
            return PAPER;
        }
        let share = ((shade - middle) / range + 0.5).clamp(0.0, 1.0);
        ((DARKEST + (LIGHTEST - DARKEST) * share) / STEP).round() as u8 * STEP as u8
    };
    shades.iter().map(grey).collect()
}

fn packed(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_facing_the_light_is_lighter() {
        let slopes = [(1.0, -1.0), (0.0, 0.0), (-1.0, 1.0), (f64::NAN, 0.0)];
        // the light comes from the north-west: ground that falls to the north-west faces it
        let greys = greys(&slopes.map(shade));
        assert!(greys[0] > greys[1] && greys[1] > greys[2], "{greys:?}");
        assert_eq!(greys[3], PAPER);
        assert!(f64::from(greys[2]) >= DARKEST - STEP, "lines must stay readable");
    }
}
