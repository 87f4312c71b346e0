//! The `rockfall` command.

mod cli;
mod wiring;

fn main() -> std::process::ExitCode {
    cli::main()
}
