//! A small stroke font: letters as pen paths, so that text needs no font file, scales and turns.
//!
//! Drawn for this program. Units: capitals are 10 high, small letters 7, descenders reach to -3.2; y points up.
//! A path is a list of points `x,y`; `~x,y` is the control point of a quadratic curve to the next point (two controls
//! in a row have an implied point half way); `|` lifts the pen.

use super::accents::split;

/// Room after a letter, between the centres of the strokes.
const GAP: f64 = 2.9;
/// Advance of a space.
const SPACE: f64 = 5.0;
/// Straight pieces of a curve.
const PIECES: usize = 8;

/// A straight pen stroke.
pub(super) type Stroke = [[f64; 2]; 2];

/// Width of a text between the centres of its first and last strokes.
pub(super) fn width(text: &str) -> f64 {
    layout(text, |_, _| ())
}

/// The strokes of a text that starts at (0, 0).
pub(super) fn strokes(text: &str) -> Vec<Stroke> {
    let mut all = vec![];
    layout(text, |x, glyph| all.extend(glyph.iter().map(|s| s.map(|p| [p[0] + x, p[1]]))));
    all
}

/// The letters of a text that are drawn as a box, each once.
#[must_use]
pub fn not_drawn(text: &str) -> String {
    let mut all = String::new();
    for letter in text.chars().filter(|&letter| letter != ' ') {
        let plain = split(letter).map_or(letter, |(plain, _)| plain);
        if path(plain) == UNKNOWN && !all.contains(letter) {
            all.push(letter);
        }
    }
    all
}

fn layout(text: &str, mut place: impl FnMut(f64, &[Stroke])) -> f64 {
    let mut x = 0.0;
    let mut end: f64 = 0.0;
    for letter in text.chars() {
        if letter == ' ' {
            x += SPACE;
            continue;
        }
        let glyph = glyph(letter);
        place(x, &glyph);
        end = x + glyph.iter().flatten().fold(0.0, |w: f64, p| w.max(p[0]));
        x = end + GAP;
    }
    end
}

/// The strokes of a letter, with its mark if it has one.
fn glyph(letter: char) -> Vec<Stroke> {
    let Some((plain, mark)) = split(letter) else { return flatten(path(letter)) };
    let mut strokes = flatten(path(plain));
    let points = || strokes.iter().flatten();
    let (left, right) =
        points().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[0]), high.max(p[0])));
    let top = points().fold(0.0, |top: f64, p| top.max(p[1]));
    let (x, y) = (f64::midpoint(left, right), if mark.below { 0.0 } else { top + ABOVE });
    let mut marks: Vec<Stroke> = flatten(mark.path).iter().map(|s| s.map(|p| [p[0] + x, p[1] + y])).collect();
    // A mark that is wider than its letter moves both to the right.
    let out = marks.iter().flatten().fold(0.0, |out: f64, p| out.min(p[0]));
    marks.append(&mut strokes);
    marks.iter().map(|s| s.map(|p| [p[0] - out, p[1]])).collect()
}

/// From the top of a letter to the origin of the mark above it.
const ABOVE: f64 = 1.5;

/// Pen path to straight strokes.
fn flatten(path: &str) -> Vec<Stroke> {
    let mut strokes = vec![];
    let mut at = None;
    let mut control: Option<[f64; 2]> = None;
    for word in path.split_whitespace() {
        if word == "|" {
            (at, control) = (None, None);
            continue;
        }
        let (curved, point) = parse(word);
        let target = match control {
            Some(c) if curved => [(c[0] + point[0]) / 2.0, (c[1] + point[1]) / 2.0],
            _ => point,
        };
        if let (Some(from), false) = (at, curved && control.is_none()) {
            stroke(&mut strokes, from, control, target);
        }
        if !curved || control.is_some() {
            at = Some(target);
        }
        control = curved.then_some(point);
    }
    strokes
}

fn parse(word: &str) -> (bool, [f64; 2]) {
    let (curved, numbers) = word.strip_prefix('~').map_or((false, word), |rest| (true, rest));
    let mut numbers = numbers.split(',').map(|n| n.parse().unwrap_or(0.0)); // a test reads the whole table
    (curved, [numbers.next().unwrap_or(0.0), numbers.next().unwrap_or(0.0)])
}

fn stroke(out: &mut Vec<Stroke>, from: [f64; 2], control: Option<[f64; 2]>, to: [f64; 2]) {
    let Some(control) = control else { return out.push([from, to]) };
    let mut last = from;
    for piece in 1..=PIECES {
        let t = piece as f64 / PIECES as f64;
        let at = |axis: usize| {
            let s = 1.0 - t;
            s * s * from[axis] + 2.0 * s * t * control[axis] + t * t * to[axis]
        };
        let next = [at(0), at(1)];
        out.push([last, next]);
        last = next;
    }
}

/// A box.
const UNKNOWN: &str = "0,0 0,10 5,10 5,0 0,0";

/// The pen path of a letter; [`UNKNOWN`] for one that is not drawn.
fn path(letter: char) -> &'static str {
    GLYPHS.binary_search_by_key(&letter, |&(known, _)| known).map_or(UNKNOWN, |n| GLYPHS[n].1)
}

/// Pen paths of the letters that are drawn, by ascending letter.
#[rustfmt::skip]
const GLYPHS: [(char, &str); 136] = [
    ('!', "0,10 0,3.2 | 0,0 0,0.3"),
    ('"', "0,10 0,7.6 | 2,10 2,7.6"),
    ('#', "1.8,10 0.8,0 | 5.2,10 4.2,0 | 0.2,6.8 6,6.8 | 0,3.2 5.8,3.2"),
    ('$', "5.4,7.6 ~5,9 3,9 ~0.4,9 0.4,7 ~0.4,5.5 3,5 ~5.8,4.5 5.8,2.8 ~5.8,1 3,1 ~0.6,1 0,2.6 | 3,11 3,-1"),
    ('%', "1.8,10 ~3.6,10 3.6,7.8 ~3.6,5.6 1.8,5.6 ~0,5.6 0,7.8 ~0,10 1.8,10 | 6.8,10 1.8,0 | 6.8,4.4 ~8.6,4.4 8.6,2.2 ~8.6,0 6.8,0 ~5,0 5,2.2 ~5,4.4 6.8,4.4"),
    ('&', "6.8,0 1.6,6.6 ~0.8,7.6 0.8,8.3 ~0.8,10 2.6,10 ~4.4,10 4.4,8.2 ~4.4,6.8 2.2,5.6 ~0,4.4 0,2.6 ~0,0 2.8,0 ~6,0 6.4,4.4"),
    ('\'', "0,10 0,7.6"),
    ('(', "2,11.5 ~0,8.5 0,4.5 ~0,0.5 2,-2.5"),
    (')', "0,11.5 ~2,8.5 2,4.5 ~2,0.5 0,-2.5"),
    ('*', "2.2,10 2.2,5.4 | 0.2,8.8 4.2,6.6 | 0.2,6.6 4.2,8.8"),
    ('+', "0,4.4 5.6,4.4 | 2.8,1.6 2.8,7.2"),
    (',', "0.5,0.2 0.4,-0.2 0,-1.6"),
    ('-', "0,4 3.4,4"),
    ('.', "0,0 0,0.3"),
    ('/', "0,-1.5 4,11"),
    ('0', "3,10 ~6,10 6,5 ~6,0 3,0 ~0,0 0,5 ~0,10 3,10"),
    ('1', "0.8,7.8 3.2,10 3.2,0 | 0.8,0 5.6,0"),
    ('2', "0.2,7.8 ~0.4,10 3,10 ~5.8,10 5.8,7.4 ~5.8,6 4.4,4.5 0,0 6,0"),
    ('3', "0.4,8.4 ~0.9,10 3,10 ~5.6,10 5.6,7.7 ~5.6,5.4 3,5.4 2.2,5.4 | 3,5.4 ~6,5.4 6,2.7 ~6,0 3,0 ~0.4,0 0,2"),
    ('4', "4.6,0 4.6,10 0,3 6.2,3"),
    ('5', "5.5,10 0.9,10 0.5,5.4 ~1.6,6.4 3,6.4 ~6,6.4 6,3.2 ~6,0 3,0 ~0.6,0 0,1.8"),
    ('6', "5.3,9.2 ~4.6,10 3.4,10 ~0,10 0,4.5 ~0,0 3,0 ~6,0 6,3.1 ~6,6.2 3.2,6.2 ~0.4,6.2 0,3.6"),
    ('7', "0,10 6,10 2,0"),
    ('8', "3,5.4 ~0.5,5.4 0.5,7.7 ~0.5,10 3,10 ~5.5,10 5.5,7.7 ~5.5,5.4 3,5.4 ~6,5.4 6,2.7 ~6,0 3,0 ~0,0 0,2.7 ~0,5.4 3,5.4"),
    ('9', "0.7,0.8 ~1.4,0 2.6,0 ~6,0 6,5.5 ~6,10 3,10 ~0,10 0,6.9 ~0,3.8 2.8,3.8 ~5.6,3.8 6,6.4"),
    (':', "0,0.2 0,0.5 | 0,5.8 0,6.1"),
    (';', "0.5,0.2 0.4,-0.2 0,-1.6 | 0.5,5.8 0.5,6.1"),
    ('<', "5.4,7.6 0,4.4 5.4,1.2"),
    ('=', "0,6 5.6,6 | 0,2.8 5.6,2.8"),
    ('>', "0,7.6 5.4,4.4 0,1.2"),
    ('?', "0,8 ~0.2,10 2.5,10 ~5,10 5,7.6 ~5,6 3.5,5.2 ~2.4,4.6 2.4,3.2 | 2.4,0 2.4,0.3"),
    ('@', "6.4,3.4 ~6.4,6.6 4.4,6.6 ~2.6,6.6 2.6,4.2 ~2.6,1.8 4.2,1.8 ~6.2,1.8 6.4,4 ~6.4,1.8 7.8,1.8 ~9,1.8 9,5 ~9,10 4.6,10 ~0,10 0,4 ~0,-2 5,-2 ~6.6,-2 7.6,-1.2"),
    ('A', "0,0 3.5,10 7,0 | 1.2,3.4 5.8,3.4"),
    ('B', "0,5.4 3.2,5.4 ~5.6,5.4 5.6,7.7 ~5.6,10 3.2,10 0,10 0,0 3.4,0 ~6.2,0 6.2,2.7 ~6.2,5.4 3.2,5.4"),
    ('C', "6.3,8 ~5.6,10 3.6,10 ~0,10 0,5 ~0,0 3.6,0 ~5.6,0 6.3,2"),
    ('D', "0,0 0,10 2.8,10 ~6.6,10 6.6,5 ~6.6,0 2.8,0 0,0"),
    ('E', "5.5,10 0,10 0,0 5.5,0 | 0,5.3 4.8,5.3"),
    ('F', "5.5,10 0,10 0,0 | 0,5 4.8,5"),
    ('G', "6.3,8.2 ~5.6,10 3.6,10 ~0,10 0,5 ~0,0 3.6,0 ~6.6,0 6.6,3 6.6,4.6 4,4.6"),
    ('H', "0,0 0,10 | 6.2,0 6.2,10 | 0,5.2 6.2,5.2"),
    ('I', "0,0 3,0 | 0,10 3,10 | 1.5,0 1.5,10"),
    ('J', "4,10 4,2.8 ~4,0 2,0 ~0.3,0 0,1.8"),
    ('K', "0,0 0,10 | 6,10 0,3.8 | 2.2,6.1 6.3,0"),
    ('L', "0,10 0,0 5,0"),
    ('M', "0,0 0,10 4,3.5 8,10 8,0"),
    ('N', "0,0 0,10 6.3,0 6.3,10"),
    ('O', "3.6,10 ~7.2,10 7.2,5 ~7.2,0 3.6,0 ~0,0 0,5 ~0,10 3.6,10"),
    ('P', "0,0 0,10 3.3,10 ~6,10 6,7.3 ~6,4.6 3.3,4.6 0,4.6"),
    ('Q', "3.6,10 ~7.2,10 7.2,5 ~7.2,0 3.6,0 ~0,0 0,5 ~0,10 3.6,10 | 4.6,2.4 7.2,-0.8"),
    ('R', "0,0 0,10 3.3,10 ~6,10 6,7.3 ~6,4.6 3.3,4.6 0,4.6 | 3.2,4.6 6.3,0"),
    ('S', "5.7,8.3 ~5.1,10 3,10 ~0.3,10 0.3,7.6 ~0.3,5.8 3,5.2 ~6,4.5 6,2.6 ~6,0 3,0 ~0.6,0 0,1.9"),
    ('T', "0,10 6.6,10 | 3.3,10 3.3,0"),
    ('U', "0,10 0,3.3 ~0,0 3.2,0 ~6.4,0 6.4,3.3 6.4,10"),
    ('V', "0,10 3.4,0 6.8,10"),
    ('W', "0,10 2.3,0 4.7,9 7.1,0 9.4,10"),
    ('X', "0,0 6.4,10 | 0,10 6.4,0"),
    ('Y', "0,10 3.3,4.8 6.6,10 | 3.3,4.8 3.3,0"),
    ('Z', "0,10 6,10 0,0 6,0"),
    ('[', "1.8,11.5 0,11.5 0,-2.5 1.8,-2.5"),
    ('\\', "0,11 4,-1.5"),
    (']', "0,11.5 1.8,11.5 1.8,-2.5 0,-2.5"),
    ('^', "0,6.6 2.4,10 4.8,6.6"),
    ('_', "0,-1.6 5.6,-1.6"),
    ('`', "0,10.5 1.4,8.6"),
    ('a', "0.5,5.8 ~1,7 2.7,7 ~5,7 5,4.6 5,0 | 5,4 2.6,4 ~0,4 0,2 ~0,0 2.3,0 ~4.6,0 5,2.4"),
    ('b', "0,10 0,0 | 0,3.5 ~0,7 2.8,7 ~5.5,7 5.5,3.5 ~5.5,0 2.8,0 ~0,0 0,3.5"),
    ('c', "5,5.6 ~4.4,7 2.8,7 ~0,7 0,3.5 ~0,0 2.8,0 ~4.4,0 5,1.4"),
    ('d', "5.5,10 5.5,0 | 5.5,3.5 ~5.5,7 2.7,7 ~0,7 0,3.5 ~0,0 2.7,0 ~5.5,0 5.5,3.5"),
    ('e', "0,3.7 5.3,3.7 ~5.3,7 2.7,7 ~0,7 0,3.5 ~0,0 2.9,0 ~4.5,0 5.1,1.3"),
    ('f', "3.9,9.9 ~3.6,10 3.2,10 ~1.4,10 1.4,7.8 1.4,0 | 0,6.7 3.6,6.7"),
    ('g', "5.5,7 5.5,-0.5 ~5.5,-3.2 2.8,-3.2 ~1,-3.2 0.4,-2 | 5.5,3.5 ~5.5,7 2.7,7 ~0,7 0,3.5 ~0,0 2.7,0 ~5.5,0 5.5,3.5"),
    ('h', "0,10 0,0 | 0,4 ~0.2,7 2.8,7 ~5.2,7 5.2,4.2 5.2,0"),
    ('i', "0,7 0,0 | 0,9.6 0,9.9"),
    ('j', "1.6,7 1.6,-1 ~1.6,-3.2 0,-3.2 | 1.6,9.6 1.6,9.9"),
    ('k', "0,10 0,0 | 5,7 0,2.5 | 1.8,4.1 5.2,0"),
    ('l', "0,10 0,1.8 ~0,0 1.8,0"),
    ('m', "0,7 0,0 | 0,4.2 ~0.2,7 2.4,7 ~4.3,7 4.3,4.4 4.3,0 | 4.3,4.2 ~4.5,7 6.7,7 ~8.6,7 8.6,4.4 8.6,0"),
    ('n', "0,7 0,0 | 0,4 ~0.2,7 2.8,7 ~5.2,7 5.2,4.2 5.2,0"),
    ('o', "2.8,7 ~5.6,7 5.6,3.5 ~5.6,0 2.8,0 ~0,0 0,3.5 ~0,7 2.8,7"),
    ('p', "0,7 0,-3.2 | 0,3.5 ~0,7 2.8,7 ~5.5,7 5.5,3.5 ~5.5,0 2.8,0 ~0,0 0,3.5"),
    ('q', "5.5,7 5.5,-3.2 | 5.5,3.5 ~5.5,7 2.7,7 ~0,7 0,3.5 ~0,0 2.7,0 ~5.5,0 5.5,3.5"),
    ('r', "0,7 0,0 | 0,4 ~0.3,7 3.2,6.9"),
    ('s', "4.7,5.8 ~4.1,7 2.5,7 ~0.3,7 0.3,5.3 ~0.3,4 2.5,3.6 ~4.9,3.1 4.9,1.8 ~4.9,0 2.5,0 ~0.6,0 0,1.3"),
    ('t', "1.4,9.3 1.4,1.8 ~1.4,0 3.2,0 3.8,0.1 | 0,6.7 3.6,6.7"),
    ('u', "0,7 0,2.8 ~0,0 2.5,0 ~5,0 5.2,3 | 5.2,7 5.2,0"),
    ('v', "0,7 2.7,0 5.4,7"),
    ('w', "0,7 2,0 4,6.5 6,0 8,7"),
    ('x', "0,0 5,7 | 0,7 5,0"),
    ('y', "0,7 2.8,0 | 5.4,7 2.1,-1.9 ~1.6,-3.2 0.3,-3.2"),
    ('z', "0,7 4.8,7 0,0 4.8,0"),
    ('{', "2.6,11.5 ~1.2,11.5 1.2,9.5 1.2,6.5 ~1.2,4.5 0,4.5 ~1.2,4.5 1.2,2.5 1.2,-0.5 ~1.2,-2.5 2.6,-2.5"),
    ('|', "0,11.5 0,-2.5"),
    ('}', "0,11.5 ~1.4,11.5 1.4,9.5 1.4,6.5 ~1.4,4.5 2.6,4.5 ~1.4,4.5 1.4,2.5 1.4,-0.5 ~1.4,-2.5 0,-2.5"),
    ('~', "0,3.8 ~0.6,5.4 1.8,5.4 ~2.6,5.4 3,4.6 ~3.4,3.8 4.2,3.8 ~5.4,3.8 6,5.4"),
    ('°', "1.6,10 ~3.2,10 3.2,8.2 ~3.2,6.4 1.6,6.4 ~0,6.4 0,8.2 ~0,10 1.6,10"),
    ('±', "0,5.4 5.6,5.4 | 2.8,2.6 2.8,8.2 | 0,0 5.6,0"),
    ('²', "0,9.2 ~0.1,10.4 1.5,10.4 ~3,10.4 3,9.1 ~3,8.3 2.2,7.5 0,5.4 3.1,5.4"),
    ('³', "0.1,9.6 ~0.4,10.4 1.5,10.4 ~2.8,10.4 2.8,9.3 ~2.8,8.1 1.3,8.1 ~3,8.1 3,6.7 ~3,5.4 1.5,5.4 ~0.2,5.4 0,6.4"),
    ('µ', "0,7 0,-3 | 0,2.8 ~0,0 2.5,0 ~5,0 5.2,3 | 5.2,7 5.2,0"),
    ('·', "0,4.2 0,4.5"),
    ('Æ', "0,0 4.6,10 9.6,10 | 1.6,3.4 5,3.4 | 5,10 5,0 9.6,0 | 5,5.3 9,5.3"),
    ('×', "0,1.8 5,6.8 | 0,6.8 5,1.8"),
    ('Ø', "3.6,10 ~7.2,10 7.2,5 ~7.2,0 3.6,0 ~0,0 0,5 ~0,10 3.6,10 | 0.4,-0.6 6.8,10.6"),
    ('ß', "0,0 0,7.4 ~0,10 2.6,10 ~5,10 5,7.9 ~5,6 2.4,5.6 ~5.6,5.2 5.6,2.6 ~5.6,0 3,0 2.4,0.1"),
    ('æ', "0.5,5.8 ~1,7 2.4,7 ~4.4,7 4.4,4.6 4.4,2 ~4.2,0 2.2,0 ~0,0 0,2 ~0,3.9 2.4,3.9 4.4,3.9 | 4.4,3.7 8.9,3.7 ~8.9,7 6.6,7 ~4.6,7 4.4,4.6 | 4.4,2.6 ~4.8,0 6.9,0 ~8.2,0 8.7,1.3"),
    ('ø', "2.8,7 ~5.6,7 5.6,3.5 ~5.6,0 2.8,0 ~0,0 0,3.5 ~0,7 2.8,7 | 0.2,-0.6 5.4,7.6"),
    ('ı', "0,7 0,0"),
    ('Ł', "1.2,10 1.2,0 6.2,0 | 0,4 3.4,6.4"),
    ('ł', "1.2,10 1.2,1.8 ~1.2,0 3,0 | 0,4.2 2.6,6.2"),
    ('Δ', "0,0 3.5,10 7,0 0,0"),
    ('Σ', "5.8,10 0,10 3.4,5 0,0 5.8,0"),
    ('Ω', "0,0 2.4,0 ~0,2.4 0,5.4 ~0,10 3.6,10 ~7.2,10 7.2,5.4 ~7.2,2.4 4.8,0 7.2,0"),
    ('α', "5.6,7 ~4.6,0 2.4,0 ~0,0 0,3.5 ~0,7 2.4,7 ~4.4,7 5,2 ~5.2,0 6.2,0"),
    ('β', "0,-3 0,7.4 ~0,10 2.6,10 ~5,10 5,7.9 ~5,5.8 2.4,5.6 ~5.6,5.4 5.6,2.7 ~5.6,0 2.8,0 ~0.6,0 0,1.6"),
    ('γ', "0,7 2.8,0 2.8,-3 | 5.6,7 2.8,0"),
    ('δ', "4.8,9.4 ~3.8,10 2.6,10 ~1,10 1,8.6 ~1,7.4 3,6.6 ~5.6,5.6 5.6,3.2 ~5.6,0 2.8,0 ~0,0 0,3 ~0,6.2 3,6.4"),
    ('ε', "4.6,6 ~4,7 2.5,7 ~0.4,7 0.4,5.3 ~0.4,3.8 2.6,3.7 ~0,3.6 0,1.8 ~0,0 2.5,0 ~4.2,0 4.8,1"),
    ('λ', "0,10 ~1,10 1.4,9 5.2,0 | 2.6,5.8 0,0"),
    ('μ', "0,7 0,-3 | 0,2.8 ~0,0 2.5,0 ~5,0 5.2,3 | 5.2,7 5.2,0"),
    ('π', "0,7 6.2,7 | 1.6,7 1.2,0 | 4.4,7 4.4,1.2 ~4.4,0 5.6,0"),
    ('ρ', "0,-3.2 0,3.5 ~0,7 2.8,7 ~5.6,7 5.6,3.5 ~5.6,0 2.8,0 ~0.4,0 0,2.4"),
    ('σ', "6.2,7 2.8,7 ~0,7 0,3.5 ~0,0 2.8,0 ~5.6,0 5.6,3.5 ~5.6,6.6 3.4,7"),
    ('τ', "0,7 4.8,7 | 2.4,7 2.4,1.4 ~2.4,0 3.8,0"),
    ('φ', "3,7 ~6,7 6,3.5 ~6,0 3,0 ~0,0 0,3.5 ~0,7 3,7 | 3,10 3,-3"),
    ('ω', "1.4,7 ~0,5.6 0,3 ~0,0 2,0 ~3.6,0 3.6,4 ~3.6,0 5.2,0 ~7.2,0 7.2,3 ~7.2,5.6 5.8,7"),
    ('–', "0,4 5.6,4"),
    ('—', "0,4 5.6,4"),
    ('’', "0,10 0,7.6"),
    ('“', "0,10 0.3,7.6 | 2,10 2.3,7.6"),
    ('”', "0,10 0.3,7.6 | 2,10 2.3,7.6"),
    ('„', "0,10 0.3,7.6 | 2,10 2.3,7.6"),
    ('…', "0,0 0,0.3 | 2.6,0 2.6,0.3 | 5.2,0 5.2,0.3"),
    ('€', "6.3,8 ~5.6,10 4.2,10 ~1,10 1,5 ~1,0 4.2,0 ~5.6,0 6.3,2 | 0,6.2 4.6,6.2 | 0,4 4.4,4"),
    ('→', "0,4 6,4 | 4,6 6,4 4,2"),
    ('−', "0,4.4 5.4,4.4"),
    ('≤', "5.6,9.6 0,6.4 5.6,3.2 | 0,0.6 5.6,0.6"),
];

const _: () = {
    let mut n = 1;
    while n < GLYPHS.len() {
        assert!(GLYPHS[n - 1].0 < GLYPHS[n].0, "the letters ascend");
        n += 1;
    }
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Every letter that is drawn; control characters are not.
    const LETTERS: &str = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz\
                           .,:;!?'\"()[]{}<>/\\|_-+*=#%&@^~`$×·°²³±µβρ−–ıßøØæÆłŁαγδελπστφωΔΩΣ€…→“";

    #[test]
    fn paths_are_numbers_within_the_line() {
        for letter in LETTERS.chars() {
            for word in path(letter).split_whitespace().filter(|w| *w != "|") {
                let (x, y) = word.trim_start_matches('~').split_once(',').expect(word);
                let (x, y): (f64, f64) = (x.parse().expect(word), y.parse().expect(word));
                assert!((0.0..10.0).contains(&x) && (-3.5..12.0).contains(&y), "{letter}: {word}");
            }
            assert!(!flatten(path(letter)).is_empty(), "{letter}");
        }
    }

    /// Letters with marks are those without, and more; they stay within the line and are told apart.
    #[test]
    fn letters_with_marks() {
        let plain = glyph('?').len();
        assert!(plain > 0);
        let mut drawn: Vec<String> = Vec::new();
        for letter in crate::picture::accents::all() {
            let strokes = glyph(letter);
            let (base, _) = split(letter).expect("a letter with a mark");
            assert!(strokes.len() > glyph(base).len(), "{letter}");
            assert_ne!(path(base), path('\u{1}'), "{letter}: its plain letter is not drawn");
            let inside = |p: &[f64; 2]| (0.0..10.0).contains(&p[0]) && (-3.5..13.2).contains(&p[1]);
            assert!(strokes.iter().flatten().all(inside), "{letter}");
            drawn.push(format!("{strokes:?}"));
        }
        drawn.sort_unstable();
        assert!(drawn.windows(2).all(|w| w[0] != w[1]));
    }

    #[test]
    fn no_two_letters_look_alike() {
        let mut paths: Vec<_> = LETTERS.chars().map(path).collect();
        paths.push(path('\u{1}'));
        paths.sort_unstable();
        assert!(paths.windows(2).all(|w| w[0] != w[1]));
        assert!((' '..='~').filter(|c| *c != ' ').all(|c| LETTERS.contains(c)), "all of ASCII is drawn");
    }

    #[test]
    fn curves_pass_through_their_ends_and_spaces_count() {
        let strokes = flatten("0,0 ~1,2 2,0");
        assert_eq!((strokes[0][0], strokes[PIECES - 1][1]), ([0.0, 0.0], [2.0, 0.0]));
        assert_eq!(strokes[PIECES / 2 - 1][1], [1.0, 1.0]);
        assert_eq!(width("0 0"), 6.0 + GAP + SPACE + 6.0);
        assert_eq!(width(""), 0.0);
    }
}
