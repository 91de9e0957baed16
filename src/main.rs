//! The binary: arguments in, exit code out. All else is in the library.

fn main() -> std::process::ExitCode {
    mechc::cli::main()
}
