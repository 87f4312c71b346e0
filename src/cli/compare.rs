//! `rockfall compare`.

use super::terminal::say;
use crate::error::Result;
use crate::report::compare::{Comparison, PAGE};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    /// Folder with the results of the first run
    a: PathBuf,
    /// Folder with the results of the second run
    b: PathBuf,
    /// Folder for page, figures and table
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Compares two finished runs, writes page, figures and table, and says what changes.
pub(super) fn compare(args: &CompareArgs) -> Result<ExitCode> {
    Comparison::check_folder(&args.out)?;
    let comparison = Comparison::of(&args.a, &args.b)?;
    comparison.write(&args.out)?;
    let page = args.out.join(PAGE);
    Ok(say(format!("{}\n\npage in {}", comparison.headline().join("\n"), page.display())))
}
