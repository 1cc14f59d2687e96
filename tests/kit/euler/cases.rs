//! Reference cases: a directory of `ID.json` (setup, exact scalars, pass rule) with `ID.csv` (profile), run and judged.
//!
//! A case is understood by its `family` and its fields, and judged by the clauses of its `pass` sentence; numbers in the sentence
//! (`<= 1.25 x yardstick`, `order >= 1.8`) are read from it. Nothing here knows a case by its name.

mod balance;
mod channel;
mod line;
mod obstacles;
mod order;
mod plane;
mod radial;
mod riemann;
mod steady;
mod walls;

use super::State;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use voidage_core::flow::{Boundary, Error};

/// One case on disk.
pub struct Case {
    /// The JSON.
    pub data: Value,
    /// Columns of the CSV by name.
    pub table: BTreeMap<String, Vec<f64>>,
}

/// What was measured and which clauses failed.
#[derive(Default)]
pub struct Verdict {
    text: Vec<String>,
    failed: Vec<String>,
}

impl Verdict {
    fn note(&mut self, name: &str, value: f64) {
        self.text.push(format!("{name}={value:.3e}"));
    }

    fn say(&mut self, text: impl Into<String>) {
        self.text.push(text.into());
    }

    /// A measured value with an upper limit.
    fn at_most(&mut self, name: &str, value: f64, limit: f64) {
        self.text.push(format!("{name}={value:.3e}(<={limit:.3e})"));
        if !(value <= limit) {
            self.failed.push(name.to_string());
        }
    }

    /// A measured value with a lower limit.
    fn at_least(&mut self, name: &str, value: f64, limit: f64) {
        self.text.push(format!("{name}={value:.3}(>={limit})"));
        if !(value >= limit) {
            self.failed.push(name.to_string());
        }
    }

    fn holds(&mut self, name: &str, truth: bool) {
        if !truth {
            self.text.push(format!("{name}=no"));
            self.failed.push(name.to_string());
        }
    }

    /// All clauses held.
    pub fn passed(&self) -> bool {
        self.failed.is_empty()
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.text.join(" "))?;
        if !self.failed.is_empty() {
            write!(f, "  NOT: {}", self.failed.join(", "))?;
        }
        Ok(())
    }
}

/// Why a case could not be run.
#[derive(Debug)]
pub enum Trouble {
    /// A field the family needs is missing or not readable.
    Field(String),
    /// The solver refused.
    Solver(Error),
}

impl From<Error> for Trouble {
    fn from(e: Error) -> Self {
        Trouble::Solver(e)
    }
}

type Outcome = Result<Verdict, Trouble>;

impl Case {
    /// Reads a case and its table.
    pub fn read(path: &Path) -> std::io::Result<Self> {
        let data: Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
        let mut table = BTreeMap::new();
        if let Some(name) = data["table"].as_str() {
            let text = std::fs::read_to_string(path.with_file_name(name))?;
            let mut lines = text.lines();
            let header: Vec<&str> = lines.next().unwrap_or("").split(',').map(str::trim).collect();
            let mut columns = vec![Vec::new(); header.len()];
            for line in lines.filter(|l| !l.trim().is_empty()) {
                for (column, word) in columns.iter_mut().zip(line.split(',')) {
                    column.push(word.trim().parse().unwrap_or(f64::NAN));
                }
            }
            table = header.into_iter().map(String::from).zip(columns).collect();
        }
        Ok(Case { data, table })
    }

    fn number(&self, path: &str) -> Result<f64, Trouble> {
        self.data.pointer(path).and_then(Value::as_f64).ok_or_else(|| Trouble::Field(path.into()))
    }

    fn text(&self, path: &str) -> &str {
        self.data.pointer(path).and_then(Value::as_str).unwrap_or("")
    }

    fn pair(&self, path: &str) -> Result<[f64; 2], Trouble> {
        Ok([self.number(&format!("{path}/0"))?, self.number(&format!("{path}/1"))?])
    }

    fn column(&self, name: &str) -> Result<&[f64], Trouble> {
        self.table.get(name).map(Vec::as_slice).ok_or_else(|| Trouble::Field(format!("column {name}")))
    }

    fn state(&self, path: &str) -> Result<State, Trouble> {
        let value = |k: &str| self.number(&format!("{path}/{k}"));
        Ok(State { rho: value("rho")?, u: value("u")?, p: value("p").unwrap_or(0.0) })
    }

    fn gamma(&self) -> Result<f64, Trouble> {
        self.number("/gamma")
    }

    fn pass(&self) -> &str {
        self.text("/pass")
    }

    /// Yardstick error of the density at a number of cells.
    fn yardstick(&self, n: usize) -> Option<f64> {
        let y = self.data.get("yardstick")?;
        let of = |v: &Value| v.as_f64().or_else(|| v.get("rho").and_then(Value::as_f64));
        y.pointer(&format!("/L1/{n}")).and_then(of).or_else(|| y.pointer(&format!("/L1_rho/{n}")).and_then(of))
    }

    /// The boundary that a word means, beside an initial state.
    fn boundary(&self, path: &str, beside: State) -> Result<Boundary<f64, 1>, Trouble> {
        match self.text(path) {
            "outflow" => Ok(Boundary::ZeroGradient),
            "wall" => Ok(Boundary::Wall),
            "periodic" => Ok(Boundary::Periodic),
            "fixed inflow" => Ok(Boundary::FarField(beside.primitive())),
            other => Err(Trouble::Field(format!("{path} = {other}"))),
        }
    }
}

/// Runs all cases of a directory in the order of their names, one line each; returns how many passed and failed.
///
/// # Errors
/// The directory cannot be read, or holds no case that is asked for.
pub fn run_directory(directory: &Path, only: Option<&str>) -> std::io::Result<(usize, usize)> {
    let mut files: Vec<_> = std::fs::read_dir(directory)?.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "json"));
    files.sort();
    let (mut passed, mut failed) = (0, 0);
    let mut out = std::io::stdout();
    for file in files {
        let start = std::time::Instant::now();
        let name = file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let (id, verdict) = match Case::read(&file) {
            Err(e) => (name, Err(Trouble::Field(e.to_string()))),
            Ok(case) => {
                // A list of cases is not a case.
                let Some(id) = case.data["id"].as_str() else { continue };
                if only.is_some_and(|o| o != id) {
                    continue;
                }
                // One broken case must not hide the others.
                let result = std::panic::catch_unwind(|| run(&case));
                (id.to_string(), result.unwrap_or_else(|_| Err(Trouble::Field("the case broke the scorer".into()))))
            }
        };
        let (ok, text) = match verdict {
            Ok(verdict) => (verdict.passed(), verdict.to_string()),
            Err(trouble) => (false, format!("{trouble:?}")),
        };
        let word = if ok { "pass" } else { "FAIL" };
        writeln!(out, "{word} {id}: {text}  [{:.1} s]", start.elapsed().as_secs_f64())?;
        *if ok { &mut passed } else { &mut failed } += 1;
    }
    if passed + failed == 0 {
        let found = if only.is_some() { "no reference case of this id" } else { "no reference cases" };
        return Err(std::io::Error::other(format!("{}: {found}", directory.display())));
    }
    writeln!(out, "{passed} passed, {failed} failed")?;
    Ok((passed, failed))
}

/// Runs and judges one case.
pub fn run(case: &Case) -> Outcome {
    match case.text("/family") {
        "riemann1d" => riemann::riemann(case),
        "riemann_barotropic" => riemann::riemann_barotropic(case),
        "porous_riemann" => riemann::porous_riemann(case),
        "fine_grid" => riemann::fine_grid(case),
        "porous_steady_jump" => steady::slab(case),
        "closure" => steady::closure(case),
        "nozzle" => steady::nozzle(case),
        "drag" => obstacles::drag(case),
        "fanno" => steady::fanno(case),
        "shock_slab" => obstacles::shock_slab(case),
        "small_cell" => obstacles::small_cell(case),
        "hydrostatic" => balance::hydrostatic(case),
        "rest" => balance::rest(case),
        "order" => order::order(case),
        "noh" => radial::noh(case),
        "sedov" => radial::sedov(case),
        "low_mach" => plane::gresho(case),
        "qualitative2d" => plane::double_mach(case),
        "channel" => channel::channel(case),
        "wall_stream" => walls::wall_stream(case),
        "wedge" => walls::wedge(case),
        "turned_tube" => walls::turned_tube(case),
        "bow_shock" => walls::bow_shock(case),
        other => Err(Trouble::Field(format!("family {other}"))),
    }
}
