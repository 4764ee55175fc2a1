//! The `brdfbake` command.

fn main() -> std::process::ExitCode {
    brdfbake::cli::main()
}
