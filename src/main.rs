//! The `rockfall` command.

fn main() -> std::process::ExitCode {
    rockfall::cli::main()
}
