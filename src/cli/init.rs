//! `rockfall init`, `rockfall completions`, `rockfall man`: the first steps with the program.

use super::terminal::{say, say_bytes};
use super::{CommandLine, words};
use crate::error::{Error, Result};
use crate::{file, scene};
use clap::{Args, CommandFactory as _};
use clap_complete::Shell;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct InitArgs {
    /// Terrain: an STL, PLY or OBJ mesh, or an elevation model (.tif, .asc)
    terrain: PathBuf,
    /// Scene file to write [default: the terrain's name with the ending .toml, in the current folder]
    scene: Option<PathBuf>,
    /// Replace the scene file if it is there
    #[arg(long)]
    overwrite: bool,
}

/// Writes a first scene for a terrain.
pub(super) fn init(args: &InitArgs) -> Result<ExitCode> {
    let name = args.terrain.file_stem().unwrap_or_default();
    let out = args.scene.clone().unwrap_or_else(|| PathBuf::from(name).with_extension("toml"));
    if out.exists() && !args.overwrite {
        return Err(Error::Request(format!(
            "{}: is there already; write another name, or --overwrite",
            out.display()
        )));
    }
    file::keep_inputs(&out, &[&args.terrain])?;
    let text = scene::sketch(&args.terrain, &out)?;
    file::write(&out, text.as_bytes())?;
    let quoted = words::quoted(&out.to_string_lossy());
    Ok(say(format!(
        "{} written\nfill in [grounds.slope] (`rockfall grounds` lists values), check [rocks] and [release]; then: rockfall plan {quoted}",
        out.display()
    )))
}

#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// A command's own page, as in `rockfall man mesh check` [default: the program's page]
    command: Vec<String>,
}

/// Prints a manual page.
pub(super) fn man(args: &ManArgs) -> Result<ExitCode> {
    let mut command = CommandLine::command();
    command.build();
    for word in &args.command {
        command = command.find_subcommand(word).cloned().ok_or_else(|| {
            let known: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
            Error::Request(format!("man: found {word}; write one of {}", known.join(", ")))
        })?;
    }
    let mut page = Vec::new();
    let failed = |why| Error::Request(format!("the manual page cannot be made: {why}"));
    clap_mangen::Man::new(command).render(&mut page).map_err(failed)?;
    Ok(say_bytes(&page))
}

/// Prints the completion script of a shell.
pub(super) fn completions(shell: Shell) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut CommandLine::command(), "rockfall", &mut script);
    say_bytes(&script)
}
