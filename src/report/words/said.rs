//! What the program has recorded in English, said in another language by patterns: a text with places stands for all texts
//! with something in them. What no pattern knows stays as it is.

use super::{Words, fill};
use std::fmt::Display;

impl Words {
    /// A recorded text in this language, as far as it is known.
    pub(crate) fn say(&self, text: &str) -> String {
        self.knows(text).unwrap_or_else(|| text.to_owned())
    }

    /// The same, or nothing where no pattern knows it.
    pub fn knows(&self, text: &str) -> Option<String> {
        if self.said.is_empty() {
            return Some(text.to_owned());
        }
        // the view has some of the same words
        let all = || self.recorded().chain(self.view.iter());
        if let Some((_, said)) = all().find(|(known, _)| *known == text) {
            return Some((*said).to_owned());
        }
        let with_places = self.recorded().filter(|(known, _)| known.contains('{'));
        let mut found = with_places.filter_map(|(known, said)| Some((places(known, text)?, said)));
        let (places, said) = found.next()?;
        let values: Vec<(&str, String)> =
            places.into_iter().map(|(name, value)| (name, self.say_inside(value))).collect();
        let values: Vec<(&str, &dyn Display)> =
            values.iter().map(|(name, value)| (*name, value as &dyn Display)).collect();
        Some(fill(said, &values))
    }

    /// A recorded text that may be made of several.
    pub(crate) fn say_all(&self, text: &str) -> String {
        if text.contains(' ') { self.say_inside(text) } else { self.say(text) }
    }

    /// What stands in a place: a text of its own, or several. Single words are names and numbers.
    fn say_inside(&self, text: &str) -> String {
        if !text.contains(' ') {
            return text.to_owned();
        }
        // components of a vector stand apart whatever is in them
        if text.contains(" | ") {
            return text.split(" | ").map(|part| self.say(part)).collect::<Vec<_>>().join(" | ");
        }
        if let Some(said) = self.knows(text) {
            return said;
        }
        for gap in ["; ", ", "] {
            let parts: Vec<&str> = text.split(gap).collect();
            if parts.len() > 1 && parts.iter().any(|part| self.knows(part).is_some()) {
                return parts.iter().map(|part| self.say(part)).collect::<Vec<_>>().join(gap);
            }
        }
        text.to_owned()
    }

    /// All patterns of what is recorded.
    fn recorded(&self) -> impl Iterator<Item = &'static (&'static str, &'static str)> + use<> {
        self.said.iter().copied().flatten()
    }

    /// The name of a part of the plan.
    pub fn part(&self, name: &str) -> String {
        let key = format!("[{name}]");
        let said = self.recorded().find(|(known, _)| *known == key);
        said.map_or_else(|| name.to_owned(), |(_, said)| (*said).to_owned())
    }

    /// All texts of the view with what is said for them; none in English.
    pub(in crate::report) fn of_scripts(
        &self,
    ) -> impl Iterator<Item = (&'static str, &'static str)> + use<> {
        self.view.iter().copied()
    }

    /// A text of the view.
    pub(in crate::report) fn of_view(&self, text: &str) -> String {
        let said = self.view.iter().find(|(known, _)| *known == text);
        if let Some((_, said)) = said {
            return (*said).to_owned();
        }
        let found = self.view.iter().find_map(|(known, said)| Some((places(known, text)?, said)));
        found.map_or_else(
            || text.to_owned(),
            |(places, said)| {
                let values: Vec<(&str, &dyn Display)> =
                    places.iter().map(|(name, value)| (*name, value as &dyn Display)).collect();
                fill(said, &values)
            },
        )
    }
}

/// What stands in the places of a pattern, if the text follows it: each takes the least that lets the rest follow.
fn places<'a>(pattern: &'a str, text: &'a str) -> Option<Vec<(&'a str, &'a str)>> {
    let Some((before, rest)) = pattern.split_once('{') else {
        return (pattern == text).then(Vec::new);
    };
    let (name, behind) = rest.split_once('}')?;
    let text = text.strip_prefix(before)?;
    let next = behind.split('{').next().unwrap_or_default();
    let is_last = next.len() == behind.len();
    let ends: Vec<usize> = match (next, is_last) {
        ("", true) => vec![text.len()],
        (end, true) => text.strip_suffix(end).map(str::len).into_iter().collect(),
        (end, false) => text.match_indices(end).map(|(at, _)| at).collect(),
    };
    ends.into_iter().filter(|end| *end > 0).find_map(|end| {
        let mut found = vec![(name, &text[..end])];
        found.extend(places(behind, &text[end..])?);
        Some(found)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Language;

    #[test]
    fn places_take_the_least_that_fits() {
        let found = places("{a} of {b}, {c}", "3 of 4 of 5, x, y").unwrap();
        assert_eq!(found, [("a", "3"), ("b", "4 of 5"), ("c", "x, y")]);
        assert_eq!(places("kept for {k}", "kept"), None);
        assert_eq!(places("{a} m²", "7 m² in all"), None);
    }

    #[test]
    fn texts_in_texts_are_said_too() {
        let words = Words::of(Language::De);
        let said = words.say("300 along a line of 30.0 m, from 2 points in turn, seed 1");
        assert_eq!(said, "300 entlang einer Linie von 30.0 m, reihum von 2 Punkten, Startwert 1");
        assert_eq!(words.say("left out: the scene has none"), "weggelassen: die Szene hat keine");
        assert_eq!(words.say("Nothing that is known"), "Nothing that is known");
        // a line may be called as the program calls something
        assert_eq!(words.say_all("computed"), "gerechnet");
        let said = words.say_all("1: computed (2.0 m); crossings exact between stored points");
        assert!(said.starts_with("1: computed (2.0 m)"), "{said}");
        let said = words.say_all("0 | 0.5 (0.1 to 0.9 in nine of ten, uniform) m/s");
        assert_eq!(said, "0 | 0.5 (0.1 bis 0.9 in neun von zehn, uniform) m/s");
        let rows = "2 of 3 rows of a.csv have a mass_kg that is not that of their radius_m, line 3 the most: 78 kg, but 0.2 m at 2700 kg/m³ weigh 90.5 kg; radius_m is used";
        let said = words.say(&format!(
            "{rows}, write [release] size_from = \"mass_kg\" to use the mass, \"radius_m\" to keep the radius"
        ));
        assert!(
            said.starts_with("2 von 3 Zeilen von a.csv") && said.ends_with("behält den Radius")
        );
        // one volume and a range, in either order
        let said = words.say("pillar: 0.2 a year of 8 m³, 0.003 a year of 0.5–2 m³");
        assert_eq!(said, "pillar: 0.2 pro Jahr von 8 m³, 0.003 pro Jahr von 0.5–2 m³");
        let said = words.say("0.003 a year of 0.5–2 m³, 0.2 a year of 8 m³");
        assert_eq!(said, "0.003 pro Jahr von 0.5–2 m³, 0.2 pro Jahr von 8 m³");
        let english = Words::of(Language::En);
        assert_eq!(english.say("left out: x"), "left out: x");
        assert_eq!(english.part("flat edges"), "flat edges");
    }

    /// Every language knows the same, with the same places.
    #[test]
    fn all_languages_know_the_same() {
        let names = |text: &str| {
            let inside = text.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
            let mut names: Vec<String> = inside.map(|(name, _)| name.to_owned()).collect();
            names.sort_unstable();
            names.dedup();
            names
        };
        let all = [Language::De, Language::Fr, Language::It].map(Words::of);
        for words in all {
            let both =
                |words: &Words| [words.recorded().collect(), words.view.iter().collect::<Vec<_>>()];
            for (one, other) in both(words).into_iter().zip(both(all[0])) {
                assert!(
                    one.iter().map(|(known, _)| known).eq(other.iter().map(|(known, _)| known))
                );
                for (known, said) in one {
                    assert!(!said.is_empty(), "{known}");
                    assert_eq!(names(known), names(said), "{known}");
                }
            }
        }
    }
}
