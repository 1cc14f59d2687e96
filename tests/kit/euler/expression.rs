//! A small evaluator for the formulas in reference cases: `1-(1-0.6)*(1-cos(2 pi x))/2`, `1+0.2 sin(5.0 x)`.

/// Value of a formula; names are looked up in `names`, `pi` is known, a missing sign between factors multiplies.
/// Functions: sin, cos, exp, sqrt, ln, and S(z) = z²(3−2z) clipped to [0, 1]. `None` if it cannot be read.
pub fn evaluate(formula: &str, names: &[(&str, f64)]) -> Option<f64> {
    let text: Vec<char> = formula.chars().filter(|c| !c.is_whitespace() || *c == ' ').collect();
    let mut parser = Parser { text: &text, at: 0, names };
    let value = parser.sum()?;
    parser.skip();
    (parser.at == text.len()).then_some(value)
}

struct Parser<'a> {
    text: &'a [char],
    at: usize,
    names: &'a [(&'a str, f64)],
}

impl Parser<'_> {
    fn skip(&mut self) {
        while self.text.get(self.at) == Some(&' ') {
            self.at += 1;
        }
    }

    fn peek(&mut self) -> Option<char> {
        self.skip();
        self.text.get(self.at).copied()
    }

    fn sum(&mut self) -> Option<f64> {
        let mut value = self.product()?;
        loop {
            match self.peek() {
                Some('+') => {
                    self.at += 1;
                    value += self.product()?;
                }
                Some('-') => {
                    self.at += 1;
                    value -= self.product()?;
                }
                _ => return Some(value),
            }
        }
    }

    fn product(&mut self) -> Option<f64> {
        let mut value = self.power()?;
        loop {
            match self.peek() {
                Some('*') => {
                    self.at += 1;
                    value *= self.power()?;
                }
                Some('/') => {
                    self.at += 1;
                    value /= self.power()?;
                }
                Some(c) if c.is_alphanumeric() || c == '(' || c == '.' => value *= self.power()?,
                _ => return Some(value),
            }
        }
    }

    fn power(&mut self) -> Option<f64> {
        let base = self.factor()?;
        if self.peek() == Some('^') {
            self.at += 1;
            return Some(base.powf(self.factor()?));
        }
        Some(base)
    }

    fn factor(&mut self) -> Option<f64> {
        match self.peek()? {
            '-' => {
                self.at += 1;
                Some(-self.factor()?)
            }
            '(' => {
                self.at += 1;
                let value = self.sum()?;
                (self.peek() == Some(')')).then(|| self.at += 1)?;
                Some(value)
            }
            c if c.is_ascii_digit() || c == '.' => {
                let start = self.at;
                while let Some(&c) = self.text.get(self.at) {
                    let exponent =
                        c == 'e' && self.text.get(self.at + 1).is_some_and(|d| d.is_ascii_digit() || *d == '-');
                    let sign = c == '-' && self.at > start && self.text[self.at - 1] == 'e';
                    if !(c.is_ascii_digit() || c == '.' || exponent || sign) {
                        break;
                    }
                    self.at += 1;
                }
                self.text[start..self.at].iter().collect::<String>().parse().ok()
            }
            c if c.is_alphabetic() => {
                let start = self.at;
                while self.text.get(self.at).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
                    self.at += 1;
                }
                let name: String = self.text[start..self.at].iter().collect();
                if self.text.get(self.at) == Some(&'(') {
                    let value = |p: &mut Self| p.factor();
                    match name.as_str() {
                        "sin" => return Some(value(self)?.sin()),
                        "cos" => return Some(value(self)?.cos()),
                        "exp" => return Some(value(self)?.exp()),
                        "sqrt" => return Some(value(self)?.sqrt()),
                        "ln" => return Some(value(self)?.ln()),
                        "S" => {
                            let z = value(self)?.clamp(0.0, 1.0);
                            return Some(z * z * (3.0 - 2.0 * z));
                        }
                        _ => {}
                    }
                }
                if name == "pi" {
                    return Some(std::f64::consts::PI);
                }
                self.names.iter().find(|(n, _)| *n == name).map(|(_, v)| *v)
            }
            _ => None,
        }
    }
}

/// The number that follows a phrase in a text, past spaces and `=`.
pub fn number_after(text: &str, phrase: &str) -> Option<f64> {
    let rest = &text[text.find(phrase)? + phrase.len()..];
    let rest = rest.trim_start_matches([' ', '=', ':', '(']);
    let end = rest
        .char_indices()
        .find(|(i, c)| {
            let previous = rest[..*i].chars().next_back();
            !(c.is_ascii_digit()
                || *c == '.'
                || *c == 'e'
                || (matches!(c, '-' | '+') && matches!(previous, None | Some('e'))))
        })
        .map_or(rest.len(), |(i, _)| i);
    rest[..end].trim_end_matches(['.', 'e']).parse().ok()
}

/// The whole number that stands before a phrase: 40 of `40x40` before `x`.
pub fn number_before(text: &str, phrase: &str) -> Option<f64> {
    text.match_indices(phrase).find_map(|(at, _)| {
        let digits = text[..at].rsplit(|c: char| !c.is_ascii_digit()).next()?;
        digits.parse().ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_of_reference_cases() {
        assert_eq!(evaluate("1+0.2 sin(5.0 x)", &[("x", 0.3)]), Some(1.0 + 0.2 * 1.5_f64.sin()));
        let nozzle = evaluate("1-(1-0.6)*(1-cos(2 pi x))/2", &[("x", 0.5)]).unwrap();
        assert!((nozzle - 0.6).abs() < 1e-15);
        assert_eq!(evaluate("S((0.52-0.5)/0.04+.5)", &[]), Some(1.0));
        assert_eq!(evaluate("nonsense(", &[]), None);
        assert_eq!(number_after("at least (<=1e-13); else", "<="), Some(1e-13));
        assert_eq!(number_before("max exact 40x40, t=1", "x"), Some(40.0));
        assert_eq!(number_after("p0=1.0, rho0=2.5 (x)", "rho0"), Some(2.5));
    }
}
