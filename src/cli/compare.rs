//! `rockfall compare`.

use super::say;
use crate::run;
use clap::Args;
use rockfall::error::Result;
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

/// Compares two finished runs and says what changes.
pub(super) fn compare(args: &CompareArgs) -> Result<ExitCode> {
    run::compare::compare(&args.a, &args.b, &args.out).map(say)
}
