//! The `rockfall` command.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod cli;
mod wiring;

fn main() -> std::process::ExitCode {
    cli::main()
}
