//! The shape of the ground as a light grey picture under the lines.

use super::svg::path::{Frame, tenths};
use base64::Engine;

/// Grey of ground turned away from the light, and of ground facing it: light enough for thin lines.
const DARKEST: f64 = 158.0;
const LIGHTEST: f64 = 250.0;
/// Steps of grey: more cannot be told apart in print and only make the file larger.
const STEP: f64 = 2.0;
/// Paper where there is no ground.
const PAPER: u8 = 255;
/// Direction to the light: from the north-west, 45° high, as maps are lit.
const LIGHT: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];

/// Grey (0..255) of ground that rises by `east` and `north` per metre.
fn grey(east: f64, north: f64) -> u8 {
    if !(east + north).is_finite() {
        return PAPER;
    }
    let length = (1.0 + east * east + north * north).sqrt();
    let shade = (LIGHT[2] - LIGHT[0] * east - LIGHT[1] * north) / length;
    let level = DARKEST + (LIGHTEST - DARKEST) * shade.clamp(0.0, 1.0);
    ((level / STEP).round() * STEP) as u8
}

/// An `<image>` that fills `frame` (one grey value a pixel of paper), or nothing when it cannot be packed.
///
/// `slope(x_px, y_px)` is the rise of the ground to the east and to the north per metre at a place on the paper.
pub fn image(frame: &Frame, slope: impl Fn(f64, f64) -> (f64, f64)) -> String {
    let (width, height) = (frame.width().ceil() as u32, frame.height().ceil() as u32);
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for row in 0..height {
        for column in 0..width {
            let x = frame.left + (f64::from(column) + 0.5) * frame.width() / f64::from(width);
            let y = frame.top + (f64::from(row) + 0.5) * frame.height() / f64::from(height);
            let (east, north) = slope(x, y);
            pixels.push(grey(east, north));
        }
    }
    let Ok(png) = packed(&pixels, width, height) else { return String::new() };
    let data = base64::engine::general_purpose::STANDARD.encode(png);
    let ((x0, y0), (x1, y1)) = (tenths((frame.left, frame.top)), tenths((frame.right, frame.bottom)));
    // both names of the link: older programs know only the second
    format!(
        r#"<image x="{x0}" y="{y0}" width="{}" height="{}" preserveAspectRatio="none" xlink:href="data:image/png;base64,{data}"/>"#,
        x1 - x0,
        y1 - y0
    )
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
        let (lit, flat, dark) = (grey(1.0, -1.0), grey(0.0, 0.0), grey(-1.0, 1.0));
        assert!(lit > flat && flat > dark, "{lit} {flat} {dark}");
        assert_eq!(grey(f64::NAN, 0.0), PAPER);
    }
}
