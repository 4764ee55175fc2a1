//! The `brdfbake` command.
fn main() {}
