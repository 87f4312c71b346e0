//! Every word of page and figures, one file a language: a word that one of them lacks does not compile.
//!
//! A text may have places for what is found, written `{name}`; `fill` puts it in. Names of lines, scenes and sources are
//! the user's and stay as they are. What the program records of a run in English (plan, inputs, warnings) is said by patterns.
//! Health of the meshes and what no pattern knows stay as they were recorded. Numbers have a decimal point in every language, as
//! Switzerland writes them: one number never stands in two ways on a page.

mod de;
mod en;
mod fr;
mod glossary;
mod it;
mod along;
mod drawn;
mod method;
pub(super) mod open;
mod said;
mod shapes;
mod year;

use super::format;
use crate::scene::Language;
use along::AlongWords;
use drawn::DrawnWords;
use method::MethodWords;
use open::OpenWords;
use shapes::ShapeWords;
use std::fmt::{Display, Write as _};
use year::YearWords;

macro_rules! words {
    ($($name:ident),+ $(,)?) => {
        /// The words of one language.
        #[derive(Debug)]
        pub struct Words {
            $(pub(crate) $name: &'static str,)+
            /// Points of the compass, from north over east, as they stand behind *towards*.
            pub(crate) compass: [&'static str; 8],
            /// What the terms mean here.
            pub(crate) glossary: [(&'static str, &'static str); 24],
            /// What the program records in English, by patterns, and how it is said here; none in English.
            said: &'static [&'static [(&'static str, &'static str)]],
            /// Texts of the view, the same way.
            view: &'static [(&'static str, &'static str)],
        }

        impl Words {
            /// All texts with places for what is found, by name.
            pub fn texts(&self) -> Vec<(&'static str, &'static str)> {
                let mut texts = vec![$((stringify!($name), self.$name),)+];
                texts.extend(self.year().texts());
                texts.extend(self.shapes().texts());
                texts.extend(self.open().texts());
                texts.extend(self.along().texts());
                texts.extend(self.drawn().texts());
                texts.extend(self.method().texts());
                texts
            }
        }
    };
}

words! {
    code, quoted, interval, at_least, at_most, and, release_one, release_many, rock_one,
    rock_many, more_rock_one, more_rock_many, no_interval, interval_95, rockfall_report,
    stored_path_one, stored_path_many, seed, slope_in_3d, client, project, author, date, question, question_zones,
    question_lines, question_barriers, read_first, ch_where, ch_how, ch_lines, ch_barriers,
    ch_year, ch_sure, ch_out, ch_inputs, ch_words, figure, no_error_study, error_study,
    error_study_caption, figures, plan_of, error_head, error_axis, error_time, error_own, error_sampling,
    error_steps, error_mesh, plausible, at_limit, look_here, plausibility, mesh_health, quality, not_recorded,
    remainder, not_stated, terrain, ground_values, releases, lost_rocks, lost_rocks_are,
    not_accounted, seed_row, version, rate, memory_used, numerical_remainder, scene,
    in_english, all_rocks, value, interval_head, unit, headline_note, percentile_of,
    all_statistics, all_statistics_note, order_statistics, woodruff, mean, maximum, runout,
    reach_angle, max_speed, max_translational, max_rotational, max_total, max_height, impacts,
    speed, translational, rotational, total, bounce_height, height_vertical, height_normal,
    descent, top, height, easting, northing, releases_percent, max, at_rest, left_terrain,
    time_up, over_budget, not_released, failed, stops_title, stops_alt, share_of_releases_percent,
    stops_caption, no_release, plan_title, no_release_no_ground, contour_interval, plan_caption,
    plan_density, key_release, key_line, key_barrier, key_tree, speed_axis, north, side_title,
    side_caption, profile_title, profile_caption, profile_axis, bearing, no_bearing, along_fall_line, height_axis, elevation_axis, bounce_axis,
    no_path, median, runout_axis, share_farther, open_end, no_curve, runout_open,
    runout_left_out, runout_caption, low_slope, high_talus, band, median_inside, median_at_limit, median_outside,
    reach_caption, distributions_title, distributions_caption, no_finite, none_above_zero, along_title, along_alt,
    along_energy, along_axis, along_rock, along_rock_caption, median_runout, only_path, most_energy,
    farthest, along_caption, line_title, nobody_line, the_line, the_line_of_barrier, where_pass,
    first_crossing, energy_exceeded, height_exceeded, line_behind, line_caption, line_axis,
    energy_axis, share_of_releases, with_barriers, without, without_barriers, retention,
    retention_axis, retention_caption, retention_colours, left, line_table, object_table, line_note, object_note,
    arrives_title, arrives_note, line_without, line_with, col_reach, col_speed, col_energy,
    col_height_vertical, col_height_normal, barrier_name, nobody_barrier, barrier_cloud,
    stopped_by_height, stopped_by_place, barrier_caption, barrier_design, barrier_no_design,
    barrier_places, top_axis, no_rock_arrives, design, stopped_axis, offset_uphill,
    offset_downhill, offset_left, barriers_head_title, barriers_head_design, barriers_head_note, barriers_head_note_design, col_arriving_of,
    col_passing, col_top, col_design_energy, col_design_height, barriers_title, barriers_note,
    col_height, col_capacity, col_arriving, col_arriving_percent, col_stopped, col_over,
    col_through, rule_lacks, no_factor, factors, factor_speed, factor_mass, factor_height,
    own_rule, rule, free_distance, arriving_title, arriving_note, sensitivity_title,
    sensitivity_note, sensitivity_design, col_stopped_at, at_its_place, uphill, downhill, to_the_left, to_the_right,
    maps_title, maps_alt, map_reach, map_intensity, maps_caption, map_values_title,
    map_values_alt, map_energy, map_height, map_deposits, map_exceeds, map_values_caption,
    map_ends_title, map_ends_alt, map_ends_caption, maps_few, maps_joined,
    measured_title, measured_curves, measured_map, measured, computed, share_of_rocks, no_rock,
    measured_caption, col_mean_measured, col_computed, col_ks, col_ks_limit, col_area,
    col_side_measured, col_side_computed, agreement_title, agreement_note, this_run,
    calibration_title, calibration_note, calibration_note_one, calibration_finalists, blocks_held_out, uncalibrated, fitted_without, held_out,
    fitted_all, hardly_told, told_title, told_note, fitted, ends_title, ends_note, difference,
    check_failed, check_reach, check_reach_found, check_speed, check_speed_found, check_fast_found,
    check_deposits, check_deposits_found, check_pits, check_mesh, check_mesh_found, check_coarse,
    year_title, year_axis, year_energy_axis, years, nobody_year, hits_of, passages_of,
    year_barriers, year_caption, object, line, hits, passages, or_more, and_without, and_with,
    kept_away, col_year, col_period, col_probability, col_conditional, col_by_rate,
    col_by_exponent, often_title, often_note, returns_title, returns_note, risk_title, risk_note,
    barrier_weighted, barrier_year_title, barrier_year_note, rocks_arrive, are_stopped, go_over,
    break_through, risk_kept_away,
    person_hit, vehicles_hit, individual_risk, deaths,
}

impl Words {
    /// The words of a language.
    pub fn of(language: Language) -> &'static Self {
        match language {
            Language::En => &en::WORDS,
            Language::De => &de::WORDS,
            Language::Fr => &fr::WORDS,
            Language::It => &it::WORDS,
        }
    }

    /// What is said of a year on the first page and on its maps.
    pub(super) fn year(&self) -> &'static YearWords {
        YearWords::of(self.language())
    }

    /// How the numbers came about.
    pub(super) fn method(&self) -> &'static MethodWords {
        MethodWords::of(self.language())
    }

    /// What is said of rocks that would have gone on.
    pub(crate) fn open(&self) -> &'static OpenWords {
        OpenWords::of(self.language())
    }

    /// What is said of a few rocks along their ways.
    pub(super) fn along(&self) -> &'static AlongWords {
        AlongWords::of(self.language())
    }

    /// What is said in keys and captions only where it applies.
    pub(super) fn drawn(&self) -> &'static DrawnWords {
        DrawnWords::of(self.language())
    }

    /// What is said of rocks with shapes.
    pub(super) fn shapes(&self) -> &'static ShapeWords {
        ShapeWords::of(self.language())
    }

    fn language(&self) -> Language {
        let is_own = |language: &&Language| std::ptr::eq(Self::of(**language), self);
        Language::ALL.iter().find(is_own).copied().unwrap_or_default()
    }

    /// Between a name and what it has: French has a space before it that does not break.
    pub(super) fn colon(&self) -> &'static str {
        if self.code == "fr" { "\u{a0}: " } else { ": " }
    }

    /// A name that the user has given, in quotation marks.
    pub(super) fn quoted(&self, name: &str) -> String {
        fill(self.quoted, &[("x", &name)])
    }

    /// How many rocks are missing.
    pub(super) fn more_rocks(&self, rocks: usize) -> String {
        let text = format::counted(rocks, self.more_rock_one, self.more_rock_many);
        fill(text, &[("n", &rocks)])
    }

    /// Two written bounds as an interval; one that is no number leaves it open.
    pub(super) fn interval(&self, low: &str, high: &str) -> String {
        match (low == format::NO_NUMBER, high == format::NO_NUMBER) {
            (false, false) => fill(self.interval, &[("low", &low), ("high", &high)]),
            (false, true) => fill(self.at_least, &[("x", &low)]),
            (true, false) => fill(self.at_most, &[("x", &high)]),
            (true, true) => format::NO_NUMBER.to_owned(),
        }
    }

    /// So many rocks.
    pub(super) fn rocks(&self, count: usize) -> String {
        let what = format::counted(count, self.rock_one, self.rock_many);
        format!("{} {what}", format::decimal(count as f64, 0))
    }
}

/// What stands in a place with forms: `{n|rock|rocks}` is "rock" where `n` is 1, and of three forms the first is that of none.
fn form<'a>(place: &'a str, found: &[(&str, &dyn Display)]) -> Option<&'a str> {
    let (name, forms) = place.split_once('|')?;
    let count = found.iter().find(|(known, _)| *known == name)?.1.to_string();
    let forms: Vec<&str> = forms.split('|').collect();
    let (none, rest) =
        if forms.len() > 2 { (forms[0], &forms[1..]) } else { (forms[1], &forms[..]) };
    Some(match count.as_str() {
        "0" => none,
        "1" => rest[0],
        _ => rest[1],
    })
}

/// A text with what is found in its places; a place that nothing is given for stays as it is.
pub(crate) fn fill(text: &str, found: &[(&str, &dyn Display)]) -> String {
    let mut filled = String::with_capacity(text.len() + 16 * found.len());
    let mut rest = text;
    // one way through: braces in what the user wrote are no places
    while let Some((before, after)) = rest.split_once('{') {
        filled += before;
        let Some((name, behind)) = after.split_once('}') else {
            rest = after;
            break;
        };
        match found.iter().find(|(known, _)| *known == name) {
            None if name.contains('|') => filled += form(name, found).unwrap_or(name),
            Some((_, value)) => {
                let _ = write!(filled, "{value}");
            }
            None => {
                let _ = write!(filled, "{{{name}}}");
            }
        }
        rest = behind;
    }
    filled + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places of a text, in order of their names.
    fn places(text: &str) -> Vec<&str> {
        let inside = text.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
        // which words have forms is the affair of each language
        let mut places: Vec<&str> =
            inside.map(|(name, _)| name).filter(|name| !name.contains('|')).collect();
        places.sort_unstable();
        places
    }

    /// A place that is lost in translation would lose a number; a text that is empty would lose a sentence.
    #[test]
    fn every_language_says_all_of_it() {
        let english = Words::of(Language::En).texts();
        for language in Language::ALL {
            let words = Words::of(language);
            for ((name, text), (_, original)) in words.texts().into_iter().zip(&english) {
                assert_eq!(places(text), places(original), "{name} of {language:?}");
                if name == "in_english" {
                    assert_eq!(text.is_empty(), language == Language::En, "{text}");
                    continue;
                }
                assert!(!text.is_empty(), "{name} of {language:?}");
                let ends = |text: &str| text.ends_with('.');
                assert_eq!(
                    ends(text),
                    ends(original) || is_short(text),
                    "{name} of {language:?}: {text}"
                );
            }
            for (term, meaning) in words.glossary {
                assert!(!term.is_empty() && meaning.ends_with('.'), "{language:?}: {term}");
            }
        }
    }

    /// Abbreviations on axes end with a full stop of their own.
    fn is_short(text: &str) -> bool {
        text.ends_with("max.")
    }

    /// Longer texts that are the same in two languages have been forgotten.
    #[test]
    fn no_sentence_is_left_in_another_language() {
        let all = Language::ALL.map(|language| Words::of(language).texts());
        for (k, one) in all.iter().enumerate() {
            for other in &all[k + 1..] {
                for ((name, text), (_, same)) in one.iter().zip(other) {
                    let is_sentence = text.split(' ').count() > 4 && *name != "percentile_of";
                    assert!(!is_sentence || text != same, "{name}: {text}");
                }
            }
        }
    }

    /// What is filled in and what stands on an axis has a decimal point in every language: so has what stands in a sentence.
    #[test]
    fn numbers_in_sentences_have_a_point_as_those_of_tables_and_figures() {
        for language in Language::ALL {
            let words = Words::of(language);
            let said = words.said.iter().copied().flatten().map(|(_, said)| *said);
            let texts = words.texts().into_iter().map(|(_, text)| text);
            let terms = words.glossary.iter().map(|(_, meaning)| *meaning);
            let view = words.view.iter().map(|(_, said)| *said);
            for text in texts.chain(said).chain(terms).chain(view) {
                let is_comma = |three: &[u8]| {
                    three[1] == b',' && three[0].is_ascii_digit() && three[2].is_ascii_digit()
                };
                assert!(!text.as_bytes().windows(3).any(is_comma), "{language:?}: {text}");
            }
        }
    }

    /// French has a space that does not break before its double marks and inside its quotation marks.
    #[test]
    fn french_marks_keep_their_space() {
        let words = Words::of(Language::Fr);
        let said = words.said.iter().copied().flatten().map(|(_, said)| *said);
        let texts = words.texts().into_iter().map(|(_, text)| text);
        let terms = words.glossary.iter().map(|(_, meaning)| *meaning);
        for text in texts.chain(said).chain(terms).chain(words.view.iter().map(|(_, said)| *said)) {
            for wrong in [" :", " ;", " ?", " !", "« ", " »"] {
                assert!(!text.contains(wrong), "{text}");
            }
            for (at, _) in text.match_indices([';', '?']) {
                assert!(text[..at].ends_with('\u{a0}'), "{text}");
            }
        }
    }

    #[test]
    fn what_is_found_is_put_in_once() {
        let filled = fill("{a} of {b}, {c}", &[("a", &"{b}"), ("b", &2)]);
        assert_eq!(filled, "{b} of 2, {c}");
        let forms =
            ["0", "1", "7"].map(|n| fill("{n} {n|rock|rocks}{n|, none|, alone|}", &[("n", &n)]));
        assert_eq!(forms, ["0 rocks, none", "1 rock, alone", "7 rocks"]);
        let words = Words::of(Language::En);
        assert_eq!(words.interval("1", format::NO_NUMBER), "at least 1");
    }

    /// A run of one release stood in the captions as "über alle 1 Block".
    #[test]
    fn one_rock_is_said_as_one() {
        let expected = ["over the 1 rock", "über den 1 Block", "sur le 1 bloc", "sul 1 masso"];
        for (language, expected) in Language::ALL.into_iter().zip(expected) {
            let words = Words::of(language);
            let found: [(&str, &dyn Display); 2] = [("rocks", &words.rocks(1)), ("n", &1)];
            let said = fill(words.profile_caption, &found);
            assert!(said.contains(expected), "{said}");
            let one = fill(words.side_caption, &[("paths", &1), ("releases", &1)]);
            let plurals = ["releases", "Ablösungen", "départs", "distacchi"];
            assert!(plurals.iter().all(|plural| !one.contains(plural)), "{one}");
            let more = fill(words.rule_lacks, &[("n", &1)]);
            assert!(!more.contains("arrive.") || language != Language::En, "{more}");
        }
    }
}
