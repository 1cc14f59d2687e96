//! Letters with marks: which letter, which mark, and the mark's pen path about the middle of the letter.

/// A mark above or below a letter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mark {
    /// Pen path, its origin in the middle of the letter: above the letter, or on the base line.
    pub path: &'static str,
    /// It stands below the letter.
    pub below: bool,
}

const fn above(path: &'static str) -> Mark {
    Mark { path, below: false }
}

const fn below(path: &'static str) -> Mark {
    Mark { path, below: true }
}

/// Letters with a mark, and the letters that they are without it, in the same order.
const MARKED: [(Mark, &str, &str); 12] = [
    (above("-1.4,0 -1.4,0.3 | 1.4,0 1.4,0.3"), "äëïöüÿÄËÏÖÜŸёЁїЇϊϋΪΫ", "aeıouyAEIOUYеЕıІιυΙΥ"),
    (above("-0.6,-0.4 0.9,1.1"), "áéíóúýćńśźÁÉÍÓÚÝĆŃŚŹάέήίόύώΆΈΉΊΌΎΏ", "aeıouycnszAEIOUYCNSZαεηιουωΑΕΗΙΟΥΩ"),
    (above("-0.9,1.1 0.6,-0.4"), "àèìòùÀÈÌÒÙ", "aeıouAEIOU"),
    (above("-1.5,-0.4 0,0.9 1.5,-0.4"), "âêîôûÂÊÎÔÛ", "aeıouAEIOU"),
    (above("-1.8,-0.1 ~-1,1.1 0,0.4 ~1,-0.3 1.8,0.7"), "ãñõÃÑÕ", "anoANO"),
    (above("-1.5,0.9 0,-0.4 1.5,0.9"), "čďěňřšťžČĎĚŇŘŠŤŽ", "cdenrstzCDENRSTZ"),
    (above("0,1.3 ~0.8,1.3 0.8,0.5 ~0.8,-0.3 0,-0.3 ~-0.8,-0.3 -0.8,0.5 ~-0.8,1.3 0,1.3"), "åůÅŮ", "auAU"),
    (above("-1.4,1.1 ~-1.2,-0.3 0,-0.3 ~1.2,-0.3 1.4,1.1"), "ăğйўĂĞЙЎ", "agиуAGИУ"),
    (above("-1,-0.4 0.1,1.1 | 0.9,-0.4 2,1.1"), "őűŐŰ", "ouOU"),
    (above("0,0.2 0,0.5"), "żŻİ", "zZI"),
    (below("0,0 -0.2,-0.9 ~1,-1 0.9,-1.8 ~0.6,-2.6 -0.9,-2.3"), "çşÇŞ", "csCS"),
    (below("1.6,0 ~0.3,-1 0.6,-1.9 ~1,-2.5 2,-1.9"), "ąęĄĘ", "aeAE"),
];

/// A letter as a plain letter and a mark, if it has one.
pub(super) fn split(letter: char) -> Option<(char, Mark)> {
    MARKED.iter().find_map(|(mark, marked, plain)| {
        let at = marked.chars().position(|c| c == letter)?;
        Some((plain.chars().nth(at)?, *mark))
    })
}

#[cfg(test)]
pub(super) fn all() -> impl Iterator<Item = char> {
    MARKED.iter().flat_map(|(_, marked, _)| marked.chars())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_letter_is_listed_once_and_has_its_plain_letter() {
        let mut letters: Vec<char> = all().collect();
        letters.sort_unstable();
        assert!(letters.windows(2).all(|w| w[0] != w[1]));
        for (_, marked, plain) in MARKED {
            assert_eq!(marked.chars().count(), plain.chars().count(), "{marked}");
        }
        assert_eq!(split('ü').map(|(plain, _)| plain), Some('u'));
        assert_eq!(split('Ç').map(|(plain, mark)| (plain, mark.below)), Some(('C', true)));
        assert!(split('u').is_none());
    }
}
