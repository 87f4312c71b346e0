//! Enough of WKT to tell which coordinate system a `.prj` file means.

/// Relative difference of units that are the same (–).
const SAME: f64 = 1e-9;

/// What a description of a coordinate system says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CoordinateSystem {
    /// Whether its coordinates are angles.
    pub(crate) is_geographic: bool,
    /// Its EPSG code; programs of ESRI leave it out.
    pub(crate) epsg: Option<u32>,
    /// Its name.
    pub(crate) name: String,
    /// Name of a unit of length in it that is not the metre, of places or of heights.
    pub(crate) other_unit: Option<String>,
}

/// Reads WKT 1 or 2.
pub(crate) fn system(text: &str) -> CoordinateSystem {
    let text = text.trim_start_matches('\u{feff}').trim();
    let head = text.split('[').next().unwrap_or_default().to_uppercase();
    let name = text.split('"').nth(1).unwrap_or_default().to_owned();
    let is_geographic = ["GEOGCS", "GEOGCRS"].contains(&head.as_str());
    CoordinateSystem { is_geographic, epsg: code(text), name, other_unit: other_unit(text) }
}

/// The first `UNIT["foot",0.3048]` or `LENGTHUNIT[...]` that is neither the metre nor an angle.
fn other_unit(text: &str) -> Option<String> {
    let compact: String = text.chars().filter(|c| !c.is_control()).collect();
    let mut units = compact.split("UNIT[\"").zip(compact.split("UNIT[\"").skip(1));
    let is_length = |before: &str| !before.ends_with("ANGLE") && !before.ends_with("SCALE");
    units.find_map(|(before, unit)| {
        let (name, rest) = unit.split_once('"')?;
        let number = rest.trim_start_matches([',', ' ']);
        let end = number.find(|c: char| !c.is_ascii_digit() && !".eE+-".contains(c));
        let metres: f64 = number[..end.unwrap_or(number.len())].parse().ok()?;
        let is_angle = ["degree", "grad", "radian"].iter().any(|a| name.to_lowercase().contains(a));
        (is_length(before) && !is_angle && (metres - 1.0).abs() > SAME).then(|| name.to_owned())
    })
}

/// The code of the system itself stands last: those of its parts come before.
fn code(text: &str) -> Option<u32> {
    let compact: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let at = ["AUTHORITY[\"EPSG\",", "ID[\"EPSG\","].iter().filter_map(|mark| {
        let at = compact.rfind(mark)?;
        Some(&compact[at + mark.len()..])
    });
    let rest = at.max_by_key(|rest| std::cmp::Reverse(rest.len()))?;
    let digits = rest.trim_start_matches('"');
    let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
    // of a part if more than the closing brackets of two levels follows
    let closing = digits[end..].trim_start_matches('"');
    (closing.chars().all(|c| c == ']') && closing.len() <= 2).then(|| digits[..end].parse().ok())?
}
