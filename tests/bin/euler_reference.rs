//! `euler-reference DIR [--only ID]`: runs every reference case of a directory through the solver and applies its pass rule.

use std::process::ExitCode;
use voidage_tests::euler::cases;

fn main() -> ExitCode {
    let mut directory = None;
    let mut only = None;
    let mut args = std::env::args().skip(1);
    while let Some(a) = args.next() {
        if a == "--only" {
            only = args.next();
        } else {
            directory = Some(a);
        }
    }
    let Some(directory) = directory else {
        eprintln!("usage: euler-reference DIR [--only ID]");
        return ExitCode::from(2);
    };
    match cases::run_directory(directory.as_ref(), only.as_deref()) {
        Ok((_, 0)) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(2)
        }
    }
}
