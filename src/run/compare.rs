//! Two finished runs side by side.

use rockfall::error::Result;
use rockfall::report::compare::Comparison;
use std::path::Path;

/// Compares two finished runs, writes page, figures and table into `out`, and says what changes.
pub(crate) fn compare(a: &Path, b: &Path, out: &Path) -> Result<String> {
    let comparison = Comparison::of(a, b)?;
    comparison.write(out)?;
    Ok(format!(
        "{}\n\npage in {}",
        comparison.headline().join("\n"),
        out.join("compare.html").display()
    ))
}
