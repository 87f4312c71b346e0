//! Verification: exact cases and the method paper's four examples, as a table and as the paper's figures drawn anew.

mod exact;
mod paper;

use crate::error::{Error, Result};
use crate::output::write_whole;
use crate::report::curves::Curves;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What was run.
    pub case: &'static str,
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

impl Row {
    /// Whether it is as it should be.
    pub fn holds(&self) -> bool {
        (self.computed - self.expected).abs() <= self.allowed
    }
}

/// Everything that was verified.
#[derive(Debug, Default)]
pub struct Verification {
    /// The table.
    pub rows: Vec<Row>,
    figures: Vec<(&'static str, Curves)>,
}

impl Verification {
    /// Runs all cases.
    ///
    /// # Errors
    /// A shipped scene that cannot be planned.
    pub fn run() -> Result<Self> {
        let mut all = Self::default();
        exact::run(&mut all)?;
        paper::run(&mut all)?;
        Ok(all)
    }

    /// Whether every case holds.
    pub fn holds(&self) -> bool {
        self.rows.iter().all(Row::holds)
    }

    /// The table in words (Markdown).
    pub fn table(&self) -> String {
        let mut text = "| case | quantity | expected | source | computed | error | allowed | run time (s) | |\n|---|---|---|---|---|---|---|---|---|\n".to_owned();
        for row in &self.rows {
            let error = (row.computed - row.expected).abs();
            let verdict = if row.holds() { "holds" } else { "FAILS" };
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {:.9} | {error:.2e} | {:.1e} | {:.2} | {verdict} |",
                row.case,
                row.quantity,
                row.expected,
                row.source,
                row.computed,
                row.allowed,
                row.seconds
            );
        }
        text
    }

    /// Writes table and figures into a folder.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let figures = dir.join("figures");
        std::fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
        let mut page = format!("# Verification\n\n{}", self.table());
        for (name, curves) in &self.figures {
            write_whole(&figures.join(format!("{name}.svg")), curves.draw(name).as_bytes())?;
            let _ = write!(page, "\n![{0}](figures/{name}.svg)\n\n{0}\n", curves.title);
        }
        write_whole(&dir.join("README.md"), page.as_bytes())
    }
}

/// Does something and says how long it took (s).
fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let begun = Instant::now();
    let done = work()?;
    Ok((done, begun.elapsed().as_secs_f64()))
}
