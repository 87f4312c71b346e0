//! Verification: exact cases and the method paper's four examples, as a table and as the paper's figures drawn anew.

mod draw;
mod exact;
mod paper;

pub use paper::{EXAMPLES, Example};

use super::exact::{PAPER, USUAL};
use crate::error::{Error, Result};
use crate::math;
use crate::output::write_atomic;
use crate::report::curves::Curves;
use crate::solver::Scheme;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct VerificationRow {
    /// What was run.
    pub case: &'static str,
    /// With which scheme.
    pub scheme: &'static str,
    /// What was looked at, with its unit.
    pub quantity: &'static str,
    /// What should come out.
    pub expected: f64,
    /// Where that is from.
    pub source: &'static str,
    /// What came out.
    pub computed: f64,
    /// How far they may differ, in the unit of the quantity, for the case's own reason.
    pub allowed: f64,
    /// Time the case took (s).
    pub seconds: f64,
}

impl VerificationRow {
    /// Whether it is as it should be.
    pub fn holds(&self) -> bool {
        (self.computed - self.expected).abs() <= self.allowed
    }
}

/// Everything that was verified.
#[derive(Debug, Default)]
pub struct Verification {
    /// The table.
    pub rows: Vec<VerificationRow>,
    figures: Vec<(&'static str, Curves)>,
}

impl Verification {
    /// Runs all cases.
    ///
    /// # Errors
    /// A shipped scene that cannot be planned.
    pub fn run() -> Result<Self> {
        let mut all = Self::exact()?;
        for example in EXAMPLES {
            for scheme in [PAPER, USUAL] {
                example.run(&mut all, scheme)?;
            }
        }
        Ok(all)
    }

    /// Runs the cases whose answers are formulas.
    ///
    /// # Errors
    /// A made mesh that cannot be read.
    pub fn exact() -> Result<Self> {
        let mut all = Self::default();
        exact::run(&mut all)?;
        Ok(all)
    }

    /// Runs one of the paper's examples, with its own scheme and step or with the default scheme.
    ///
    /// # Errors
    /// A shipped scene that cannot be planned.
    pub fn of(example: Example, scheme: Scheme) -> Result<Self> {
        let mut all = Self::default();
        example.run(&mut all, scheme)?;
        Ok(all)
    }

    /// Draws a figure, or into the one of that name what a second scheme makes of it.
    fn draw(&mut self, name: &'static str, curves: Curves) {
        if let Some((_, first)) = self.figures.iter_mut().find(|(known, _)| *known == name) {
            first.others = curves.lines;
            first.names = Some(["dda, 1e-5 s", "adaptive"]);
        } else {
            self.figures.push((name, curves));
        }
    }

    /// Whether every case holds.
    pub fn holds(&self) -> bool {
        self.rows.iter().all(VerificationRow::holds)
    }

    /// The table in words (Markdown).
    pub fn table(&self) -> String {
        let mut text = "| case | scheme | quantity | expected | source | computed | error | allowed | run time (s) | |\n|---|---|---|---|---|---|---|---|---|---|\n".to_owned();
        for row in &self.rows {
            let error = (row.computed - row.expected).abs();
            let verdict = if row.holds() { "holds" } else { "FAILS" };
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {} | {error:.2e} | {:.1e} | {:.2} | {verdict} |",
                row.case,
                row.scheme,
                row.quantity,
                written(row.expected),
                row.source,
                written(row.computed),
                row.allowed,
                row.seconds
            );
        }
        text
    }

    /// What the table does not say of example 1a; nothing where it was not run.
    fn beside_the_paper(&self) -> &'static str {
        let is_run = self.rows.iter().any(|row| row.case.starts_with("1a"));
        if is_run { OF_EXAMPLE_1A } else { "" }
    }

    /// Writes table and figures into a folder.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let figures = dir.join("figures");
        std::fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
        let mut page = format!("# Verification\n\n{}{}", self.table(), self.beside_the_paper());
        for (name, curves) in &self.figures {
            write_atomic(&figures.join(format!("{name}.svg")), curves.draw(name).as_bytes())?;
            let _ = write!(page, "\n![{0}](figures/{name}.svg)\n\n{0}\n", curves.title);
        }
        write_atomic(&dir.join("README.md"), page.as_bytes())
    }
}

/// Why one row has a radius of its own, and the end that only `dda` is asked for ([docs/accuracy.md]).
const OF_EXAMPLE_1A: &str = "\nThe end of example 1a is that of `dda` as printed, without shear memory; its sphere's radius is inferred from the printed step \
    number itself. `adaptive` ends it near step 210 000 (printed: 1 230 000) and is asked for the valley only: docs/accuracy.md.\n";

/// Six digits, without an exponent where that reads well.
fn written(value: f64) -> String {
    if value == 0.0 || (1e-3..1e7).contains(&value.abs()) {
        let digits = (5 - math::log10(value.abs().max(1e-3)).floor() as i32).max(0) as usize;
        let text = format!("{value:.digits$}");
        let short = if text.contains('.') { text.trim_end_matches('0') } else { &text };
        short.trim_end_matches('.').to_owned()
    } else {
        format!("{value:.5e}")
    }
}

/// Does something and says how long it took (s).
fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let begun = Instant::now();
    let done = work()?;
    Ok((done, begun.elapsed().as_secs_f64()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(computed: f64) -> VerificationRow {
        VerificationRow {
            case: "a case",
            scheme: "adaptive",
            quantity: "a length (m)",
            expected: 1.0,
            source: "a formula",
            computed,
            allowed: 0.1,
            seconds: 0.0,
        }
    }

    /// One number off, or no number at all, fails the whole.
    #[test]
    fn one_row_that_fails_fails_the_verification() {
        let of = |computed: &[f64]| Verification {
            rows: computed.iter().map(|computed| row(*computed)).collect(),
            ..Verification::default()
        };
        assert!(of(&[1.0, 1.05]).holds());
        for wrong in [1.2, f64::NAN, f64::INFINITY] {
            assert!(!of(&[1.0, wrong]).holds());
            assert!(of(&[1.0, wrong]).table().contains("FAILS"));
        }
    }

    /// What is said of an example stands only beside it.
    #[test]
    fn a_note_stands_beside_its_example() {
        let of = |case: &'static str| {
            let row = VerificationRow { case, ..row(1.0) };
            Verification { rows: vec![row], ..Verification::default() }
        };
        assert!(of("1a sphere beside an edge").beside_the_paper().contains("210 000"));
        assert_eq!(of("a case").beside_the_paper(), "");
    }

    #[test]
    fn numbers_are_written_short() {
        assert_eq!(written(0.0), "0");
        assert_eq!(written(109_881.0), "109881");
        assert_eq!(written(0.25), "0.25");
        assert_eq!(written(2.770_884_7e-5), "2.77088e-5");
    }
}
