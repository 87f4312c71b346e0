//! Enough of WKT to tell which coordinate system a `.prj` file means.

/// What a description of a coordinate system says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CoordinateSystem {
    /// Whether its coordinates are angles.
    pub(crate) is_geographic: bool,
    /// Its EPSG code; programs of ESRI leave it out.
    pub(crate) epsg: Option<u32>,
    /// Its name.
    pub(crate) name: String,
}

/// Reads WKT 1 or 2.
pub(crate) fn system(text: &str) -> CoordinateSystem {
    let text = text.trim_start_matches('\u{feff}').trim();
    let head = text.split('[').next().unwrap_or_default().to_uppercase();
    let name = text.split('"').nth(1).unwrap_or_default().to_owned();
    CoordinateSystem {
        is_geographic: ["GEOGCS", "GEOGCRS"].contains(&head.as_str()),
        epsg: code(text),
        name,
    }
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
