//! Letters of the Greek and Cyrillic alphabets that have the form of another one.

/// How a letter is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Form {
    /// The letter whose pen path it has.
    pub letter: char,
    /// Factors of that path along x and y.
    pub size: [f64; 2],
}

/// Letters, and in the same order those that look the same.
const TWINS: [(&str, &str); 4] = [
    ("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧνο", "ABEZHIKMNOPTYXvo"),
    ("АВЕКМНОРСТХІЅЈ", "ABEKMHOPCTXISJ"),
    ("аеорсухіѕј", "aeopcyxisj"),
    ("ГПФф", "ΓΠΦφ"),
];

/// Small letters of the Cyrillic alphabet that are small capitals, and these.
const SMALL_CAPITALS: (&str, &str) = ("вгджзиклмнптцчшщъыьэюяєґ", "BΓДЖЗИKЛMHΠTЦЧШЩЪЫЬЭЮЯЄҐ");

/// Width and height of a small capital, of a capital 1.
const SMALL: [f64; 2] = [0.8, 0.7];

/// How a letter is drawn: most by their own path.
pub(super) fn form(letter: char) -> Form {
    let partner = |(letters, partners): (&str, &str)| {
        let at = letters.chars().position(|c| c == letter)?;
        partners.chars().nth(at)
    };
    let (small, twin) = (partner(SMALL_CAPITALS), TWINS.into_iter().find_map(partner));
    Form { letter: small.or(twin).unwrap_or(letter), size: if small.is_some() { SMALL } else { [1.0, 1.0] } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_letter_is_listed_once_and_has_a_partner_with_a_path() {
        let lists = TWINS.into_iter().chain([SMALL_CAPITALS]);
        let mut letters: Vec<char> = Vec::new();
        for (these, those) in lists {
            assert_eq!(these.chars().count(), those.chars().count(), "{these}");
            assert!(those.chars().all(|c| form(c).letter == c), "{those}: a partner of a partner");
            letters.extend(these.chars());
        }
        letters.sort_unstable();
        assert!(letters.windows(2).all(|w| w[0] != w[1]), "a letter stands twice");
        assert_eq!(form('д'), Form { letter: 'Д', size: SMALL });
        assert_eq!(form('Ρ').letter, 'P');
        assert_eq!(form('P'), Form { letter: 'P', size: [1.0, 1.0] });
    }
}
