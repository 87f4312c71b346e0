//! What the program has recorded in English, said in another language by patterns: a text with places stands for all texts
//! with something in them. What no pattern knows stays as it is.

use super::{Words, fill, format};
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
        // a list of two such texts is none of them
        let is_one = |(name, value): &(&str, &str)| *name != "x" || !value.contains(", ");
        let whole = |known| places(known, text).filter(|found| found.iter().all(is_one));
        let mut found = with_places.filter_map(|(known, said)| Some((known, whole(known)?, said)));
        let (known, places, said) = found.next()?;
        let values: Vec<(&str, String)> = places
            .into_iter()
            .map(|(name, value)| (name, self.in_place(known, name, value)))
            .collect();
        let values: Vec<(&str, &dyn Display)> =
            values.iter().map(|(name, value)| (*name, value as &dyn Display)).collect();
        Some(fill(said, &values))
    }

    /// A recorded text that may be made of several.
    pub(crate) fn say_all(&self, text: &str) -> String {
        let said = if text.contains(' ') { self.say_inside(text) } else { self.say(text) };
        let said = if self.said.is_empty() { with_thousands(&said) } else { said };
        // a number of things and their names
        let of_things = said.split_once(": ").filter(|(count, _)| is_number(count));
        of_things.map(|(count, names)| format!("{count}{}{names}", self.colon())).unwrap_or(said)
    }

    /// What stands in a place of a pattern: a kind of something, a number as in print, or a text.
    fn in_place(&self, pattern: &str, name: &str, value: &str) -> String {
        if name.starts_with("kind") {
            return self.part(value);
        }
        let is_printed = is_number(value) && is_number_place(pattern, name);
        if is_printed { in_print(value) } else { self.say_inside(value) }
    }

    /// What stands in a place: a text of its own, or several. Single words are names and numbers.
    fn say_inside(&self, text: &str) -> String {
        if !text.contains(' ') {
            return text.to_owned();
        }
        // components of a vector stand apart whatever is in them
        if text.contains(" | ") {
            let parts = || text.split(" | ");
            let is_vector =
                parts().all(|part| is_number(part.split(' ').next().unwrap_or_default()));
            let say = |part| match self.knows(part) {
                Some(said) => said,
                None if is_vector => part.split(' ').map(in_print).collect::<Vec<_>>().join(" "),
                None => part.to_owned(),
            };
            return parts().map(say).collect::<Vec<_>>().join(" | ");
        }
        if let Some(said) = self.knows(text) {
            return said;
        }
        for gap in ["; ", ", "] {
            let parts: Vec<&str> = text.split(gap).collect();
            if parts.len() > 1 && parts.iter().any(|part| self.knows(part).is_some()) {
                let gap =
                    if self.code == "fr" { gap.replace(';', "\u{a0};") } else { gap.to_owned() };
                return parts.iter().map(|part| self.say(part)).collect::<Vec<_>>().join(&gap);
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

/// Whether a place holds what the program has counted or measured. Names and files of the user stand in places with longer names or in
/// quotation marks, what is to be copied behind `=` or in backticks: no digit of theirs is touched.
fn is_number_place(pattern: &str, name: &str) -> bool {
    let place = format!("{{{name}}}");
    let before = pattern.split(&place).next().unwrap_or_default();
    let is_copied =
        before.ends_with("= ") || before.ends_with('“') || before.matches('`').count() % 2 == 1;
    (name.len() == 1 && name != "f" || name == "count") && !is_copied
}

fn is_number(text: &str) -> bool {
    let digits = text.strip_prefix('-').unwrap_or(text);
    digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.ends_with(|c: char| c.is_ascii_digit())
        && digits.chars().all(|c| c.is_ascii_digit() || c == '.')
        && digits.matches('.').count() < 2
}

/// What large numbers in plans of this language count: these stand as in print, and nothing that a user wrote does.
const COUNTED: [&str; 8] =
    ["steps", "triangles", "bytes", "facets", "points", "cells", "releases", "J"];

/// A recorded English text with thousands set apart in what it counts.
fn with_thousands(text: &str) -> String {
    let words: Vec<&str> = text.split(' ').collect();
    let is_counted = |at: usize| {
        let next = words.get(at + 1).map(|next| next.trim_end_matches([',', ';', '.', ')']));
        next.is_some_and(|next| COUNTED.contains(&next))
    };
    let said = |(at, word): (usize, &&str)| {
        if word.len() > 4 && is_counted(at) { in_print(word) } else { (*word).to_owned() }
    };
    words.iter().enumerate().map(said).collect::<Vec<_>>().join(" ")
}

/// A number with its digits as recorded, but thousands set apart and a minus sign; any other text as it is.
fn in_print(text: &str) -> String {
    if !is_number(text) {
        return text.to_owned();
    }
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    // more digits than a number has are no count
    let value = text.parse().ok().filter(|_| text.len() < 15);
    value.map_or_else(|| text.to_owned(), |value: f64| format::decimal(value, decimals))
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
        let two = words.say_all("along a line of 35.2 m, along a line of 20.1 m");
        assert_eq!(two, "entlang einer Linie von 35.2 m, entlang einer Linie von 20.1 m");
        assert_eq!(words.say_all("200.0 m long, 6 m wide"), "200.0 m lang, 6 m breit");
        let french = Words::of(Language::Fr).say_all("5: asphalt, forest");
        assert_eq!(french, "5\u{a0}: asphalt, forest");
        assert_eq!(words.say("left out: the scene has none"), "weggelassen: die Szene hat keine");
        assert_eq!(words.say("Nothing that is known"), "Nothing that is known");
        // a line may be called as the program calls something
        assert_eq!(words.say_all("computed"), "gerechnet");
        let said = words.say_all("1: computed (2.0 m); crossings exact between stored points");
        assert!(said.starts_with("1: computed (2.0 m)"), "{said}");
        let said = words.say_all("0 | 0.5 (0.1 to 0.9 in nine of ten, uniform) m/s");
        assert_eq!(said, "0 | 0.5 (0.1 bis 0.9 in neun von zehn, gleichverteilt) m/s");
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

    /// Numbers stand as in print, and no digit of what a user wrote is touched.
    #[test]
    fn names_of_digits_stay_as_they_were_written() {
        let words = Words::of(Language::Fr);
        let said = |text: &str| words.say_all(text);
        assert_eq!(said("5136 triangles in 2 files"), "5\u{2009}136 triangles dans 2 fichiers");
        assert_eq!(said("2017, 240084 bytes"), "2017, 240\u{2009}084 octets");
        assert_eq!(
            said("restitution 0.275 (-0.2 to 0.3 in nine of ten, normal)"),
            "restitution 0.275 (\u{2212}0.2 à 0.3 neuf fois sur dix, loi normale)"
        );
        assert_eq!(said("Ground “2017”"), "Sol «\u{a0}2017\u{a0}»");
        assert_eq!(
            said("0 (-0.27 to 0.27 in nine of ten, uniform) | -1 | 0 m/s"),
            "0 (\u{2212}0.27 à 0.27 neuf fois sur dix, loi uniforme) | \u{2212}1 | 0 m/s"
        );
        assert_eq!(
            said("2017: on slopes of up to 14.0°"),
            "2017\u{a0}: sur les pentes jusqu’à 14.0°"
        );
        assert!(
            said("1200 of 4000 rocks failed: they count as far as they came; `--only 1234` shows one again")
                .contains("`--only 1234`")
        );
        // a name that is a sign or a range is none of a number
        assert_eq!(said("-2017 (26.0 m)"), "-2017 (26.0 m)");
    }

    /// English texts are recorded as they are said, but for the thousands of what they count.
    #[test]
    fn english_counts_have_their_thousands() {
        let said = |text: &str| Words::of(Language::En).say_all(text);
        assert_eq!(
            said("over budget after 5000000 steps and flights"),
            "over budget after 5\u{2009}000\u{2009}000 steps and flights"
        );
        assert_eq!(said("37280 triangles in 2 files"), "37\u{2009}280 triangles in 2 files");
        assert_eq!(said("20170.stl, road 20170"), "20170.stl, road 20170");
    }

    /// Every language knows the same, with the same places.
    #[test]
    fn all_languages_know_the_same() {
        let names = |text: &str| {
            let inside = text.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
            let names = inside.map(|(name, _)| name.to_owned()).filter(|name| !name.contains('|'));
            let mut names: Vec<String> = names.collect();
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
