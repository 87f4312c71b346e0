//! What a number may be, and complaints about the one that was found.

use crate::error::Flaw;
use crate::random::{Distribution, LARGEST, LEAST};

/// One step from the top of a scene towards a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum TrailStep {
    /// Into the key of a table.
    Key(String),
    /// Into the entry of a list, from 0.
    Entry(usize),
}

/// What is wrong with the value at the end of a trail of keys. The table that complains names its own
/// keys; every table around it adds its own step, so that none has to know where it stands.
#[derive(Debug)]
pub(super) struct Complaint {
    /// From the top of the scene to the value.
    pub(super) trail: Vec<TrailStep>,
    /// What was found; `None` = the text as written.
    pub(super) found: Option<String>,
    /// What to write instead.
    pub(super) remedy: String,
}

impl Complaint {
    /// About the value of a key, as written.
    pub(super) fn about(key: &str, remedy: impl Into<String>) -> Self {
        Self { trail: vec![TrailStep::Key(key.to_owned())], found: None, remedy: remedy.into() }
    }

    /// About a key that is not there.
    pub(super) fn missing(key: &str, remedy: impl Into<String>) -> Self {
        Self::about(key, remedy).finding("found nothing")
    }

    /// Says what was found where the text as written does not.
    pub(super) fn finding(self, found: impl Into<String>) -> Self {
        Self { found: Some(found.into()), ..self }
    }

    /// The same complaint, seen from the table around.
    pub(super) fn inside(self, key: &str) -> Self {
        self.below(TrailStep::Key(key.to_owned()))
    }

    /// The same complaint, seen from the list around; entries count from 0.
    pub(super) fn in_entry(self, index: usize) -> Self {
        self.below(TrailStep::Entry(index))
    }

    fn below(mut self, step: TrailStep) -> Self {
        self.trail.insert(0, step);
        self
    }
}

/// What a check answers.
pub(super) type Checked = Result<(), Complaint>;

/// The numbers a key may take.
#[derive(Debug, Clone, Copy)]
pub(super) enum Allowed {
    NotNegative,
    Positive,
    /// 0..1, both ends included.
    Share,
    /// 0..90 degrees without 90 itself.
    Slope,
    /// Both ends included; what is beyond means nothing on a slope, and may take for ever.
    Between(f64, f64),
}

impl Allowed {
    fn holds(self, low: f64, high: f64) -> bool {
        let numbers = -LARGEST <= low && high <= LARGEST;
        numbers
            && match self {
                Self::NotNegative => low >= 0.0,
                Self::Positive => low > 0.0,
                Self::Share => low >= 0.0 && high <= 1.0,
                Self::Slope => low >= 0.0 && high < 90.0,
                Self::Between(least, most) => least <= low && high <= most,
            }
    }

    fn in_words(self) -> String {
        match self {
            Self::NotNegative => "write a number of 0 or more".to_owned(),
            Self::Positive => "write a number above 0".to_owned(),
            Self::Share => "write a value in 0..1".to_owned(),
            Self::Slope => "write a value of 0 or more and below 90".to_owned(),
            Self::Between(least, most) => format!("write a value in {least:?}..{most:?}"),
        }
    }
}

/// Checks the number under a key; `hint` says what is usual, and may be empty.
pub(super) fn number(key: &str, value: f64, allowed: Allowed, hint: &str) -> Checked {
    within(key, (value, value), allowed, hint)
}

/// Checks that everything a distribution can give is allowed.
pub(super) fn drawn(key: &str, value: &Distribution, allowed: Allowed, hint: &str) -> Checked {
    within(key, value.support(), allowed, hint)
}

/// Checks a number that may be absent.
pub(super) fn optional(key: &str, value: Option<f64>, allowed: Allowed, hint: &str) -> Checked {
    value.map_or(Ok(()), |value| number(key, value, allowed, hint))
}

fn within(key: &str, (low, high): (f64, f64), allowed: Allowed, hint: &str) -> Checked {
    let is_too_small = |end: &f64| *end != 0.0 && end.abs() < LEAST;
    if allowed.holds(low, high) {
        if ![low, high].iter().any(is_too_small) {
            return Ok(());
        }
        let or_none = if allowed.holds(0.0, 0.0) { "write 0, or" } else { "write" };
        return Err(Complaint::about(key, format!("{or_none} a number of at least {LEAST:e}")));
    }
    let bounds = match (low < high, (high - low).is_finite()) {
        (false, _) => "",
        (true, true) => "; every value it can give must lie there",
        (true, false) => "; give the distribution a min and a max",
    };
    if high.is_finite() && high > LARGEST {
        return Err(Complaint::about(key, format!("write a number of at most {LARGEST:e}")));
    }
    let hint = if hint.is_empty() { String::new() } else { format!(" ({hint})") };
    Err(Complaint::about(key, format!("{}{hint}{bounds}", allowed.in_words())))
}

/// Checks that every entry of some lists has a name of its own.
pub(super) fn check_names(tables: &[(&str, Vec<&str>)]) -> Checked {
    let mut known: Vec<&str> = Vec::new();
    for (table, names) in tables {
        for (index, &name) in names.iter().enumerate() {
            let own = if known.contains(&name) {
                let remedy = "write another name: an entry before has the same";
                Err(Complaint::about("name", remedy).finding(format!("found {name:?}")))
            } else {
                check_name("name", name)
            };
            own.map_err(|wrong| wrong.in_entry(index).inside(table))?;
            known.push(name);
        }
    }
    Ok(())
}

/// Checks a name, which stands under `key`.
pub(super) fn check_name(key: &str, name: &str) -> Checked {
    name_flaw(name).map_or(Ok(()), |remedy| {
        Err(Complaint::about(key, remedy).finding(format!("found {name:?}")))
    })
}

/// What to write instead of a name that tables and files cannot hold.
pub(super) fn name_flaw(name: &str) -> Option<&'static str> {
    if name.trim().is_empty() {
        Some("write a name; it stands in tables and files")
    } else if is_broken(name) {
        Some(BROKEN)
    } else {
        name.starts_with(['=', '+', '-', '@']).then_some(FORMULA)
    }
}

/// What to do about a name that a spreadsheet takes for a formula: it stands in CSV files.
const FORMULA: &str =
    "write a name that does not begin with =, +, - or @: spreadsheets take that for a formula";

/// What to do about a text that would break the rows, figures and messages in which it stands.
pub(super) const BROKEN: &str =
    "write it in one line, without line breaks, tabs and other control characters";

/// Whether a text breaks a line, or has characters that say something to a terminal.
pub(super) fn is_broken(text: &str) -> bool {
    text.contains(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'))
}

/// The known word that looks most like the one written, if any is near.
pub(super) fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Similarity above which two words are worth comparing; the same as in `clap`.
    const NEAR: f64 = 0.7;
    known
        .map(|candidate| (strsim::jaro_winkler(word, candidate), candidate))
        .filter(|(similarity, _)| *similarity > NEAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// "did you mean `x`? known: a, b, c"
pub(super) fn suggest(word: &str, known: &[&str]) -> String {
    let list = known.join(", ");
    match nearest(word, known.iter().copied()) {
        Some(near) => format!("did you mean {near}? known here: {list}"),
        None => format!("known here: {list}"),
    }
}

impl From<Flaw> for Complaint {
    fn from(flaw: Flaw) -> Self {
        Self { trail: Vec::new(), found: Some(flaw.found), remedy: flaw.remedy }
    }
}
