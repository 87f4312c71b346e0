//! The first line of a table: which columns it has, and what is wrong with them in one line.

/// Columns that a table always has, and groups of further ones that it has all of or none, in this order.
pub(in crate::output) type Columns = (&'static [&'static str], &'static [&'static [&'static str]]);

/// Most columns that a message names.
const NAMED: usize = 5;

/// Longest name of a column that is told in full (characters): a file with other separators is one column.
const LONGEST_NAME: usize = 40;

/// Before which columns of a file a group is missing; none if it has other columns than it should.
pub(super) fn gaps(found: &[&str], (columns, groups): Columns) -> Option<Vec<usize>> {
    let mut rest = found.strip_prefix(columns)?;
    let mut gaps = Vec::new();
    for group in groups {
        match rest.strip_prefix(*group) {
            Some(after) => rest = after,
            None => gaps.push(found.len() - rest.len()),
        }
    }
    // at the end of a row nothing needs to stand for what is missing
    gaps.retain(|gap| *gap < found.len());
    rest.is_empty().then_some(gaps)
}

/// What is wrong with the columns of a file that has other ones than it should: those that are missing, unknown or there
/// twice, else the first that stands in another place.
pub(super) fn flaw(found: &[&str], columns: Columns) -> String {
    let expected = expected(found, columns);
    let missing = named("no", expected.iter().filter(|column| !found.contains(column)));
    let unknown = named("the unknown", found.iter().filter(|column| !expected.contains(column)));
    let is_again = |at: usize| expected.contains(&found[at]) && found[..at].contains(&found[at]);
    let again = (0..found.len()).filter(|at| is_again(*at)).map(|at| &found[at]);
    let again = named("twice the", again);
    let wrong: Vec<String> = [missing, unknown, again].into_iter().flatten().collect();
    if !wrong.is_empty() {
        return format!("found {}", wrong.join(" and "));
    }
    let mut pairs = (1..).zip(found.iter().zip(&expected));
    let misplaced = pairs.find(|(_, (one, other))| one != other);
    misplaced.map_or_else(
        || "found other columns".to_owned(),
        |(number, (found, expected))| {
            format!("found {found} as column {number}, where {expected} belongs")
        },
    )
}

/// The columns of the table, with the groups of which the file has some.
fn expected<'a>(found: &[&str], (columns, groups): Columns) -> Vec<&'a str> {
    let is_meant = |group: &&&[&str]| group.iter().any(|column| found.contains(column));
    let further = groups.iter().filter(is_meant).flat_map(|group| group.iter().copied());
    columns.iter().copied().chain(further).collect()
}

/// The first few columns by name and how many more there are; none of none.
fn named<'a>(what: &str, columns: impl Iterator<Item = &'a &'a str>) -> Option<String> {
    let all: Vec<&str> = columns.copied().collect();
    let shown: Vec<String> = all.iter().take(NAMED).map(|name| cut(name)).collect();
    let shown = shown.join(", ");
    match all.len() {
        0 => None,
        1 => Some(format!("{what} column {shown}")),
        n if n <= NAMED => Some(format!("{what} columns {shown}")),
        n => Some(format!("{what} columns {shown} and {} more", n - NAMED)),
    }
}

/// A name, without what is too long to be one.
fn cut(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Columns, flaw, gaps};

    const TABLE: Columns = (&["index", "mass_kg", "speed_m_s"], &[&["side_2", "side_3"]]);

    /// What is wrong stands in the message, and nothing of what is right.
    #[test]
    fn a_wrong_header_is_told_by_what_is_wrong_with_it() {
        for (header, said) in [
            ("index,speed_m_s", "found no column mass_kg"),
            ("index,mass_kg,speed_m_s,colour", "found the unknown column colour"),
            ("index,mass,speed_m_s", "found no column mass_kg and the unknown column mass"),
            ("index,mass_kg,speed_m_s,side_3", "found no column side_2"),
            ("index,mass_kg,mass_kg,speed_m_s", "found twice the column mass_kg"),
            ("mass_kg,index,speed_m_s", "found mass_kg as column 1, where index belongs"),
            (
                "index,mass_kg,speed_m_s,side_3,side_2",
                "found side_3 as column 4, where side_2 belongs",
            ),
            (
                "0,1,2,3,4,5,6",
                "found no columns index, mass_kg, speed_m_s and the unknown columns 0, 1, 2, 3, 4 and 2 more",
            ),
        ] {
            let found: Vec<&str> = header.split(',').collect();
            assert_eq!(gaps(&found, TABLE), None, "{header}");
            assert_eq!(flaw(&found, TABLE), said, "{header}");
        }
        assert_eq!(gaps(&["index", "mass_kg", "speed_m_s"], TABLE), Some(vec![]));
        // as a spreadsheet may save it
        let semicolons = "ü".repeat(20) + &"index;mass_kg;".repeat(50);
        let said = format!("{}index;mass_kg;index;…", "ü".repeat(20));
        assert!(flaw(&[&semicolons], TABLE).ends_with(&said));
    }
}
