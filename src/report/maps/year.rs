//! Maps of a year: how often rocks pass with much energy, with what energy once in so many years, and what moves that.

use super::super::colour::{self, BLUE, ORANGE, PALE, SKY, VERMILLION};
use super::super::figure::Drawing;
use super::super::format;
use super::super::model::{CellMap, LevelCells, Report, YearCells, energy_unit};
use super::super::words::fill;
use super::{ClassedMap, draw_layers};
use plotters::style::RGBColor;

/// Limits of the classes of a change with the exponent over the frequency itself (–).
const SLOPES: [f64; 4] = [-1.0, 0.0, 1.0, 2.0];
const SLOPE_COLOURS: [RGBColor; 5] = [BLUE, SKY, PALE, ORANGE, VERMILLION];

/// Draws return periods and energies; what the exponent changes and levels of hazard where the scene has them.
pub(in crate::report) fn draw(report: &Report, maps: &CellMap, year: &YearCells) -> Drawing {
    let words = report.words();
    let said = words.year();
    let energy: &dyn std::fmt::Display = &format::plain(year.energy_j / 1e3);
    let years: &dyn std::fmt::Display = &format::plain(year.years);
    let most_j = year.energies_j.iter().map(|(_, v)| *v).fold(0.0, f64::max);
    let energy_title = fill(said.map_energy, &[("years", years)]);
    let mut layers = vec![
        periods(fill(said.map_period, &[("energy", energy)]), year),
        ClassedMap::of_values(&energy_title, &year.energies_j, energy_unit(most_j), &[1.0, 3.0]),
    ];
    let mut exponent = "";
    if let Some(slopes) = &year.by_exponent {
        layers.push(of_slopes(said.map_by_exponent, slopes));
        exponent = said.maps_by_exponent;
    }
    let mut level = String::new();
    if let Some(levels) = &year.levels {
        let LevelCells { name, source, .. } = levels;
        layers.push(of_levels(fill(said.map_level, &[("name", &short(name))]), levels));
        let [name, source] = [name, source].map(|text| words.say(text));
        level = fill(said.maps_level, &[("name", &name), ("source", &source)]);
    }
    // no shaded ground: it stands in all other maps, and would cost more than all else of the year
    let svg = draw_layers("maps-year", said.maps_alt, (report, maps, None), &layers);
    let found: [(&str, &dyn std::fmt::Display); 4] =
        [("energy", energy), ("years", years), ("exponent", &exponent), ("level", &level)];
    Drawing { svg, caption: fill(said.maps_caption, &found) }
}

/// Most letters of a name over a map.
const NAME: usize = 40;

/// The beginning of a name that is too long for the head of a map: what stands before its colon, else as much as has room.
fn short(name: &str) -> String {
    let Some((end, _)) = name.char_indices().nth(NAME) else { return name.to_owned() };
    match name.split_once(':') {
        Some((before, _)) if before.chars().count() <= NAME => before.to_owned(),
        _ => format!("{}…", &name[..end]),
    }
}

/// Frequencies in classes between the return periods asked for, from seldom to often.
fn periods(title: String, year: &YearCells) -> ClassedMap {
    let periods = &year.return_periods_years;
    let class = |per_year: f64| periods.iter().filter(|years| per_year >= 1.0 / **years).count();
    let plain = |k: usize| format::plain(periods[k]);
    let last = periods.len();
    let name = |k: usize| match k {
        0 => format!("> {}", plain(last - 1)),
        k if k == last => format!("≤\u{2009}{}", plain(0)),
        k => format!("{}–{}", plain(last - k - 1), plain(last - k)),
    };
    let shade = |k: usize| colour::sequential(k as f64 / last.max(1) as f64);
    ClassedMap {
        title,
        cells: year.frequencies.iter().map(|&(cell, value)| (cell, class(value))).collect(),
        classes: (0..=last).filter(|_| last > 0).map(|k| (name(k), shade(k))).collect(),
        least_px: 0.0,
    }
}

fn of_slopes(title: &str, values: &[(u32, f64)]) -> ClassedMap {
    let class = |value: f64| SLOPES.iter().filter(|limit| value >= **limit).count();
    let sign = |value: f64| format::plain(value).replace('-', "−");
    let name = |k: usize| match k {
        0 => format!("< {}", sign(SLOPES[0])),
        k if k == SLOPES.len() => format!("≥ {}", sign(SLOPES[k - 1])),
        k => format!("{} … {}", sign(SLOPES[k - 1]), sign(SLOPES[k])),
    };
    ClassedMap {
        title: title.to_owned(),
        cells: values.iter().map(|&(cell, value)| (cell, class(value))).collect(),
        classes: SLOPE_COLOURS.iter().enumerate().map(|(k, c)| (name(k), *c)).collect(),
        least_px: 0.0,
    }
}

/// Levels in colours that are those of the table: light for its lowest, dark for its highest, grey where no level holds.
fn of_levels(title: String, levels: &LevelCells) -> ClassedMap {
    let named: Vec<u8> = levels.known.iter().copied().filter(|level| *level > 0).collect();
    let last = named.len().saturating_sub(1).max(1);
    let shade = |k: usize| colour::sequential(k as f64 / last as f64);
    let shades = named.iter().enumerate().map(|(k, level)| (level.to_string(), shade(k)));
    let class = |value: f64| named.iter().filter(|level| f64::from(**level) <= value).count();
    ClassedMap {
        title,
        cells: levels.cells.iter().map(|&(cell, level)| (cell, class(level))).collect(),
        classes: std::iter::once(("0".to_owned(), PALE)).chain(shades).collect(),
        least_px: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::title_lines;
    use super::{LevelCells, fill, of_levels, short};
    use crate::report::words::Words;
    use crate::scene::Language;

    /// Two maps by one table have one key, whatever levels are on them: the same colour is the same level.
    #[test]
    fn a_level_has_the_colour_of_its_place_in_the_table() {
        let map = |levels: &[u8]| {
            let cells = (0..).zip(levels.iter().map(|level| f64::from(*level))).collect();
            let known = vec![1, 2, 3];
            of_levels(String::new(), &LevelCells { known, cells, ..LevelCells::default() })
        };
        let (often, seldom) = (map(&[3, 2, 3]), map(&[1, 0]));
        assert_eq!(often.classes, seldom.classes);
        let key: Vec<&str> = often.classes.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(key, ["0", "1", "2", "3"]);
        let drawn = |map: &super::ClassedMap| -> Vec<usize> {
            map.cells.iter().map(|(_, class)| *class).collect()
        };
        assert_eq!((drawn(&often), drawn(&seldom)), (vec![3, 2, 3], vec![1, 0]));
    }

    /// No map of a year loses the end of its title, which holds the unit: a long one takes two lines.
    #[test]
    fn a_title_keeps_its_end() {
        for language in Language::ALL {
            let said = Words::of(language).year();
            let period = fill(said.map_period, &[("energy", &"1\u{2009}000")]);
            for title in [period.as_str(), said.map_by_exponent] {
                let lines = title_lines(title, 70.0);
                assert_eq!(lines.join(" "), title);
            }
        }
    }

    /// The head of a map has what stands before the colon of a long name; a name without one is cut.
    #[test]
    fn a_long_name_is_said_in_short() {
        let known = crate::scene::MATRICES[0].name;
        assert_eq!(short(known), "TEK17 § 7-3");
        assert_eq!(short("Levels: by energy"), "Levels: by energy");
        let long = "Gefahrenstufen nach der Weisung des Kantons von 2021";
        assert_eq!(short(long).chars().count(), 41);
        // and each language says it whole
        for language in [Language::De, Language::Fr, Language::It] {
            assert_ne!(Words::of(language).say(known), known);
        }
    }
}
