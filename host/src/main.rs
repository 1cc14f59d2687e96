//! The command `voidage`.

use clap::error::{ContextKind, ErrorKind};
use clap::{CommandFactory, Parser};
use std::io::IsTerminal;
use std::process::ExitCode;
use voidage::command::cli::{Cli, Command};
use voidage::command::progress::{all_said, output_is_closed, print, print_aside, visible};
use voidage::command::{docs, inspect, interrupt, porosity, solve, stress, study};
use voidage::error::{Error, Result};

/// Runs before the standard library starts, which opens /dev/null in the place of a standard stream that is closed: afterwards nobody can tell.
#[cfg(target_os = "linux")]
#[used]
#[unsafe(link_section = ".init_array")]
static BEFORE_THE_START: extern "C" fn() = look_at_the_output;

#[cfg(target_os = "linux")]
extern "C" fn look_at_the_output() {
    let is_there = |path: &str| std::fs::symlink_metadata(path).is_ok();
    if is_there("/proc/self/fd") && !is_there("/proc/self/fd/1") {
        output_is_closed();
    }
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
unsafe extern "C" {
    /// Of the C library, which the standard library stands on: what happens at a signal from now on. Any number of a signal and the ways `SIG_DFL` and
    /// `SIG_IGN` are safe.
    safe fn signal(number: i32, way: usize) -> usize;
}

/// A file that may not grow any further (`ulimit -f`) then refuses what is written, and the error is told; the signal itself would end the program at once and
/// leave what it had begun.
#[cfg(any(target_os = "linux", target_os = "macos"))]
fn take_limits_of_files_for_errors() {
    let (sigxfsz, sig_ign) = (25, 1);
    signal(sigxfsz, sig_ign);
}

fn main() -> ExitCode {
    #[cfg(any(target_os = "linux", target_os = "macos"))]
    take_limits_of_files_for_errors();
    // Ctrl-C leaves nothing half-written; without a handler the run goes on as the system does by default.
    let _ = ctrlc::set_handler(|| {
        if interrupt::interrupt() {
            return;
        }
        voidage::files::discard_unfinished();
        print_aside(&format!("error: {}", visible(&interrupt::cut_off())));
        std::process::exit(130);
    });
    let command = match Cli::try_parse() {
        Ok(cli) => cli.command,
        Err(answer) => return told(answer),
    };
    match execute(command).and_then(|()| all_said()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            print_aside(&format!("error: {}", visible(&error.to_string())));
            ExitCode::from(match error.usage {
                _ if interrupt::asked() => 130,
                true => 2,
                false => 1,
            })
        }
    }
}

/// Help, the version, or what is wrong with the arguments.
fn told(mut answer: clap::Error) -> ExitCode {
    // What begins with a minus is a slip far more often than a file: no advice to put -- before it.
    if answer.kind() == ErrorKind::UnknownArgument {
        answer.remove(ContextKind::Suggested);
    }
    // Help and version are what was asked for; where errors are not taken nobody reads them.
    if !answer.use_stderr() && !std::io::stdout().is_terminal() {
        if let Err(error) = print(answer.render().to_string().as_bytes()) {
            print_aside(&format!("error: {error}"));
            return ExitCode::FAILURE;
        }
    } else {
        let _ = answer.print();
    }
    ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or(2))
}

fn execute(command: Command) -> Result<()> {
    match command {
        Command::Porosity(args) => porosity::porosity(&args),
        Command::Inspect(args) => inspect::inspect(&args),
        Command::Study(args) => study::study(&args),
        Command::Stress(args) => stress::stress(&args),
        Command::Solve(args) => solve::run::solve(&args),
        Command::Docs { page } => docs::docs(page.as_deref()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "voidage", &mut script);
            print(&script)
        }
        Command::Man => {
            let mut page = Vec::new();
            manual(&mut page).map_err(|e| Error::new(format!("cannot render the manual page: {e}")))?;
            print(&page)
        }
    }
}

/// The manual page of the command, followed by those of its commands.
fn manual(page: &mut Vec<u8>) -> std::io::Result<()> {
    // A page has its version in one line.
    let mut whole = Cli::command().version(env!("CARGO_PKG_VERSION")).disable_help_subcommand(true);
    whole.build();
    let parts: Vec<_> = whole.get_subcommands().cloned().collect();
    std::iter::once(whole).chain(parts).try_for_each(|command| clap_mangen::Man::new(command).render(page))
}
