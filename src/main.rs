//! The `rockfall` command.

fn main() {}
