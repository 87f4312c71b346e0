//! How the numbers of a run came about, as its plan says.

use super::super::planned::{is_one_world, kept};
use super::super::words::{Words, fill};
use crate::plan::PlanEntry;
use crate::solver::Scheme;

/// The paragraph on the method of a run, whose last sentence names the scheme.
pub(super) fn paragraph(plan: &[PlanEntry], words: &Words) -> String {
    let method = words.method();
    let has = |part: &str| kept(plan, part).is_some();
    let scheme = kept(plan, "scheme").unwrap_or_default();
    let name = scheme.split(',').next().unwrap_or_default();
    let known = serde_json::from_value(name.into());
    let has_springs = known.map_or(true, |scheme: Scheme| scheme.has_springs());
    let body = if has("shape") { method.shapes } else { method.spheres };
    let meshes = if has("trees") { method.slope_and_trees } else { method.slope };
    [
        fill(body, &[("meshes", &meshes)]),
        if has_springs { method.springs } else { method.rigid }.to_owned(),
        if is_one_world(plan) { method.one_world } else { method.alone }.to_owned(),
        method.counted.to_owned(),
        fill(method.scheme, &[("scheme", &words.say(scheme))]),
    ]
    .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Language;

    fn said_of(parts: &[(&str, &str)]) -> String {
        let entry = |&(name, said): &(&str, &str)| PlanEntry {
            name: name.to_owned(),
            said: said.to_owned(),
        };
        let plan: Vec<PlanEntry> = parts.iter().map(entry).collect();
        paragraph(&plan, Words::of(Language::En))
    }

    /// Springs are not spoken of where the limit has none, nor a rock alone where all share one world, nor trees where there are none.
    #[test]
    fn the_method_is_that_of_the_run() {
        let alone = said_of(&[
            ("scheme", "adaptive, local error 0.05 m/s"),
            ("trees", "left out: none given"),
            ("rock against rock", "left out: each rock has the terrain for itself"),
        ]);
        assert!(
            alone.contains("springs normal and along") && alone.contains("its number alone"),
            "{alone}"
        );
        assert!(!alone.contains("trees") && !alone.contains("block"), "{alone}");
        let world = said_of(&[
            ("scheme", "rigid, steps of up to 0.01 s"),
            ("trees", "960 triangles"),
            ("shape", "box"),
            ("rock against rock", "one world: springs left out"),
        ]);
        assert!(
            world.contains("limit of stiff springs") && world.contains("share one world"),
            "{world}"
        );
        assert!(world.contains("slope and trees") && world.contains("convex block"), "{world}");
    }
}
