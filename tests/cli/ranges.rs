//! Numbers of a case: each has a range, the page of keys states it, and what lies beyond is refused at its line.

use crate::kit::{Scratch, solve, solved, stderr};
use crate::reference::{page, rows};
use voidage::command::solve::ranges::RANGES;

/// A case that has nothing but one key; ranges are looked at first.
fn alone(table: &str, key: &str, value: &str) -> String {
    match (table, key) {
        ("state", "relax") => format!("[boundary]\nx_min = {{ {key} = {value} }}\n"),
        ("state", "min" | "max" | "center" | "radius") => format!("[initial]\nregions = [{{ {key} = {value} }}]\n"),
        ("state", _) => format!("[initial]\nuniform = {{ {key} = {value} }}\n"),
        ("output.monitors[]", _) => format!("[output]\nmonitors = [{{ {key} = {value} }}]\n"),
        _ => format!("[{table}]\n{key} = {value}\n"),
    }
}

#[test]
fn every_range_is_stated_and_kept() {
    let (at, page) = (Scratch::new(), page("case.md"));
    let tables = rows(&page, "keys");
    let mut refused = 0;
    for (table, key, range) in RANGES {
        let of_page = if table == "state" { "initial.uniform" } else { table };
        let row = &tables[&format!("case.{of_page}")][key];
        assert!(row.contains(&format!("| {range}")), "{table}.{key} is {range}: {row}");
        for value in ["nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "-1", "0"] {
            if range.holds(value.parse().expect("a number")) {
                continue;
            }
            let output = solve(&at, &alone(table, key, value), "out", &[]);
            let said = stderr(&output);
            assert_eq!(output.status.code(), Some(1), "{table}.{key} = {value}: {said}");
            assert!(said.contains(&format!("{key}: needs a number {range}, not {value}\n")), "{value}: {said}");
            assert!(said.contains("case.toml: line 2, column ") && said.contains('^'), "{value}: {said}");
            refused += 1;
        }
    }
    assert!(refused > 150, "{refused}");
}

const CASE: &str = "[grid]\nx = { points = [0, 1], cells = [4] }\ny = { points = [0, 1], cells = [4] }\n\
    [gas]\nmodel = \"ideal\"\ngamma = 1.4\ngas_constant = 287\n[initial]\nuniform = { rho = 1, p = 1 }\n\
    [boundary]\nx_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\n[time]\nmax_steps = 1\n";

#[test]
fn what_states_come_to_has_a_range_too() {
    let at = Scratch::new();
    for (state, words) in [
        ("T = 1e-30, p = 1e30", "key initial.uniform: comes to rho = 3."),
        ("T = 1e30, p = 1e-5", "which is not from 1e-30 to 1e30"),
    ] {
        let said = stderr(&solve(&at, &CASE.replace("rho = 1, p = 1", state), "out", &[]));
        assert!(said.contains(words) && said.contains("case.toml: line 9, column "), "{said}");
    }
}

/// What is far away has no effect; where it reaches the grid, it is told at the region, not of the grid.
#[test]
fn regions_far_away() {
    let at = Scratch::new();
    let case = |region: &str| CASE.replace("[boundary]", &format!("regions = [{{ {region}, p = 2 }}]\n[boundary]"));
    let output = solve(&at, &case("center = [nan, 0.5], radius = 0.2"), "out", &[]);
    assert!(
        stderr(&output)
            .contains("line 10, column 24: key initial.regions[0].center[0]: needs a number within ±1e30, not nan")
    );
    let output = solve(&at, &case("center = [0, 0, 0, 0], radius = 0.2"), "out", &[]);
    assert!(
        stderr(&output).contains("key initial.regions[0].center: needs one to three numbers, not 4"),
        "{}",
        stderr(&output)
    );
    let output = solve(&at, &case("center = [1e20, 0.5], radius = 1e20"), "out", &[]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("line 10, column 12: key initial.regions[0]: its center lies so far from the grid")
    );
    let output = solved(&at, &case("center = [1e20, 0.5], radius = 1"), "out", &[]);
    assert!(stderr(&output).contains("key initial.regions[0]: lies outside the grid: it has no effect"));
}
