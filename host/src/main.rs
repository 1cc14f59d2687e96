//! The command `voidage`.

use clap::{CommandFactory, Parser};
use std::io::Write;
use std::process::ExitCode;
use voidage::cli::{Cli, Command};
use voidage::error::{Error, Result};
use voidage::{inspect, interrupt, run, solve, study};

fn main() -> ExitCode {
    // Ctrl-C leaves nothing half-written; without a handler the run goes on as the system does by default.
    let _ = ctrlc::set_handler(|| {
        if interrupt::interrupt() {
            return;
        }
        voidage::output::discard_unfinished();
        std::process::exit(130);
    });
    match execute(Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(match error.usage {
                _ if interrupt::asked() => 130,
                true => 2,
                false => 1,
            })
        }
    }
}

fn execute(command: Command) -> Result<()> {
    match command {
        Command::Porosity(args) => run::porosity(&args),
        Command::Inspect(args) => inspect::inspect(&args),
        Command::Study(args) => study::study(&args),
        Command::Solve(args) => solve::run::solve(&args),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "voidage", &mut script);
            print(&script)
        }
        Command::Man => {
            let mut page = Vec::new();
            let rendered = clap_mangen::Man::new(Cli::command()).render(&mut page);
            rendered.map_err(|e| Error::new(format!("cannot render the manual page: {e}")))?;
            print(&page)
        }
    }
}

/// To standard output; a reader that closes early is no failure.
fn print(bytes: &[u8]) -> Result<()> {
    match std::io::stdout().write_all(bytes) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::new(format!("cannot write to standard output: {e}")))
        }
        _ => Ok(()),
    }
}
