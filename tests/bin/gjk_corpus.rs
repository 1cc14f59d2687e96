//! Scores the GJK of voidage-core against a file of labelled pairs: `gjk-corpus FILE.jsonl [--f32] [--scale 2^K]`.
//! Makes such a file: `gjk-corpus --make SEED COUNT`.
//!
//! Prints a line by kind and a sum. Exit code 0: nothing wrong; 1: something wrong; 2: not usable so.

use std::process::ExitCode;

use glam::{DVec3, Vec3};
use voidage_tests::corpus::{Score, by_kind, made, read};

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("gjk-corpus: {message}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<bool, String> {
    let usage = "usage: gjk-corpus FILE.jsonl [--f32] [--scale 2^K] | --make SEED COUNT";
    let (mut file, mut single, mut factor) = (None, false, 1.0);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--f32" => single = true,
            "--make" => {
                let mut number = || args.next().and_then(|s| s.parse().ok()).ok_or(usage);
                let (seed, count) = (number()?, number()?);
                made(seed, count).iter().for_each(|case| println!("{case}"));
                return Ok(true);
            }
            "--scale" => {
                let power = args.next().and_then(|s| s.strip_prefix("2^")?.parse::<i32>().ok()).ok_or(usage)?;
                factor = 2f64.powi(power / 2) * 2f64.powi(power - power / 2);
            }
            _ if file.is_none() && !arg.starts_with('-') => file = Some(arg),
            _ => return Err(usage.to_string()),
        }
    }
    let file = file.ok_or(usage)?;
    let text = std::fs::read_to_string(&file).map_err(|e| format!("{file}: {e}"))?;
    let mut cases = read(&text).map_err(|e| format!("{file}: {e}"))?;
    if single {
        cases.retain(|case| case.f32);
    }
    let kinds = if single { by_kind::<Vec3>(&cases, factor) } else { by_kind::<DVec3>(&cases, factor) };
    let mut sum = Score::default();
    for (kind, score) in &kinds {
        println!("{kind:22} {score} second-stage {}", score.second_stage);
        sum = sum.and(*score);
    }
    println!("second stage: {} of {} pairs", sum.second_stage, sum.cases);
    println!("{sum}");
    Ok(sum.is_clean())
}
