//! Tables as CSV for programs, every digit, and as Markdown and HTML for people.

use crate::files::csv;
use std::fmt::Write;

/// A value in a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// None.
    Nothing,
    /// Words.
    Text(String),
    /// A number that is counted.
    Whole(usize),
    /// A measured number, and how people read it.
    Number(f64, Reading),
    /// A mark, or none.
    Mark(bool),
}

/// How people read a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// Three digits, by powers of ten: errors.
    Small,
    /// Seconds, four digits.
    Seconds,
    /// Ten digits.
    Volume,
    /// A share, in per cent with its sign.
    Percent,
    /// A share, in whole per cent.
    Share,
    /// Six decimals.
    Fraction,
    /// Two decimals.
    Order,
}

impl Cell {
    /// A number that may be missing.
    #[must_use]
    pub fn maybe(value: Option<f64>, reading: Reading) -> Cell {
        value.map_or(Cell::Nothing, |v| Cell::Number(v, reading))
    }

    /// For programs.
    fn exact(&self) -> String {
        match self {
            Cell::Nothing => String::new(),
            Cell::Text(text) => text.clone(),
            Cell::Whole(n) => n.to_string(),
            Cell::Number(x, _) => x.to_string(),
            Cell::Mark(is) => is.to_string(),
        }
    }

    /// For people.
    #[must_use]
    pub fn readable(&self) -> String {
        match self {
            Cell::Mark(is) => if *is { "●" } else { "" }.to_owned(),
            Cell::Number(x, reading) => readable(*x, *reading),
            other => other.exact(),
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Cell::Text(_))
    }
}

/// A number for people.
#[must_use]
pub fn readable(x: f64, reading: Reading) -> String {
    let digits =
        |n: i32| if x == 0.0 || !x.is_finite() { 0 } else { (n - 1 - x.abs().log10().floor() as i32).clamp(0, 12) };
    match reading {
        Reading::Small if x == 0.0 => "0".to_owned(),
        Reading::Small => format!("{x:.1e}"),
        Reading::Seconds => format!("{x:.*}", digits(4) as usize),
        Reading::Volume => format!("{x:.*}", digits(10) as usize),
        Reading::Percent if x == 0.0 => "0 %".to_owned(),
        Reading::Percent if x.abs() < 5e-7 => format!("{:+.0e} %", 100.0 * x),
        Reading::Percent => format!("{:+.4} %", 100.0 * x),
        Reading::Share => format!("{:.0} %", 100.0 * x),
        Reading::Fraction => format!("{x:.6}"),
        Reading::Order => format!("{x:.2}"),
    }
}

/// Words for Markdown, in which a name such as `<b>` is no tag.
#[must_use]
pub fn without_tags(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// A table: its columns with their names, those that only programs get with `false`.
#[derive(Debug, Clone, Default)]
pub struct Listing {
    /// Names of columns, and whether people see them.
    pub columns: Vec<(&'static str, bool)>,
    /// Rows of as many cells.
    pub rows: Vec<Vec<Cell>>,
}

impl Listing {
    /// Comma-separated values.
    #[must_use]
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|c| c.0).collect();
        let mut text = names.join(",") + "\n";
        for row in &self.rows {
            let cells = row.iter().map(|cell| csv::cell(&cell.exact()).into_owned());
            text += &(cells.collect::<Vec<_>>().join(",") + "\n");
        }
        text
    }

    /// The columns that people see, without those that are empty.
    fn seen(&self) -> Vec<usize> {
        let holds = |c: usize| self.rows.iter().filter_map(|r| r.get(c)).any(|v| !v.readable().is_empty());
        self.columns.iter().enumerate().filter(|(c, column)| column.1 && holds(*c)).map(|(c, _)| c).collect()
    }

    fn name(&self, column: usize) -> String {
        self.columns.get(column).map_or_else(String::new, |c| c.0.replace('_', " "))
    }

    fn is_text(&self, column: usize) -> bool {
        self.rows.first().and_then(|r| r.get(column)).is_some_and(Cell::is_text)
    }

    /// For people.
    #[must_use]
    pub fn markdown(&self) -> String {
        let (seen, mut text) = (self.seen(), String::new());
        let line = |text: &mut String, cell: &dyn Fn(usize) -> String| {
            let joined: Vec<String> = seen.iter().map(|&c| cell(c)).collect();
            let _ = writeln!(text, "| {} |", joined.join(" | "));
        };
        line(&mut text, &|c| self.name(c));
        line(&mut text, &|c| if self.is_text(c) { "---" } else { "---:" }.to_owned());
        for row in &self.rows {
            let cell = |c: usize| row.get(c).map_or_else(String::new, Cell::readable);
            line(&mut text, &|c| without_tags(&cell(c)).replace('|', "\\|").replace(['\n', '\r'], " "));
        }
        text
    }

    /// For a page.
    #[must_use]
    pub fn html(&self) -> String {
        let seen = self.seen();
        let mut text = "<table>\n<tr>".to_owned();
        let class = |c: usize| if self.is_text(c) { "" } else { " class=\"n\"" };
        for &c in &seen {
            let _ = write!(text, "<th{}>{}</th>", class(c), self.name(c));
        }
        text += "</tr>\n";
        for row in &self.rows {
            text += "<tr>";
            for &c in &seen {
                let cell = row.get(c).map_or_else(String::new, Cell::readable);
                let _ = write!(text, "<td{}>{}</td>", class(c), crate::picture::svg::escape(&cell));
            }
            text += "</tr>\n";
        }
        text + "</table>\n"
    }
}
