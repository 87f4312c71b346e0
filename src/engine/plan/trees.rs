//! What is said of trees that rocks cannot meet as they stand.

use crate::terrain::Terrain;
use crate::terrain::standing::StandingStems;

/// Says of each file of trees how many of its stems do not stand on the slope; nothing where all do.
pub(super) fn astray(terrain: &Terrain) -> Vec<String> {
    let said = |file: &StandingStems| {
        let StandingStems { path, stems, above, below, beside } = file;
        (file.astray() > 0).then(|| {
            format!(
                "{}: {} of {stems} stems do not stand on the slope: {above} with their foot more than 0.5 m above it, {below} with their top under it, {beside} beside it; rocks meet them in the wrong place or not at all. Export the file in the coordinates and heights of the terrain, or look at its scale and up",
                path.display(),
                file.astray()
            )
        })
    };
    terrain.standing_stems().iter().filter_map(said).collect()
}
