//! Recipes for pairs of hulls of the degenerate kinds, from small integers: what proptest shrinks, what a fuzzer mutates, what a regression
//! file holds.

use proptest::prelude::*;

/// The kinds, as they are made from lattice points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// As they are: shared vertices, edges and planes abound.
    Lattice,
    /// All in one plane.
    Coplanar,
    /// All on one line.
    Collinear,
    /// The first thinned to a needle.
    Needle,
    /// Both flattened to slabs.
    Slab,
    /// Vertices given twice.
    Duplicates,
    /// The second shrunk, into the first or beside it.
    Containment,
    /// Moved into touch along x, then by some units in the last place.
    UlpGap,
    /// Turned by a rotation that rounds every coordinate.
    Tilted,
    /// Far from the origin.
    Far,
}

/// All of them.
pub const FAMILIES: [Family; 10] = [
    Family::Lattice,
    Family::Coplanar,
    Family::Collinear,
    Family::Needle,
    Family::Slab,
    Family::Duplicates,
    Family::Containment,
    Family::UlpGap,
    Family::Tilted,
    Family::Far,
];

/// How to make a pair.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// What to do with the points.
    pub family: Family,
    /// Lattice points of the first hull.
    pub a: Vec<[i8; 3]>,
    /// Lattice points of the second hull.
    pub b: Vec<[i8; 3]>,
    /// Added to the second hull.
    pub shift: [i8; 3],
    /// Units in the last place.
    pub ulps: i8,
    /// All coordinates times two to this power.
    pub exponent: i16,
}

/// Vertices of two hulls.
pub type Pair = (Vec<[f64; 3]>, Vec<[f64; 3]>);

impl Recipe {
    /// The pair; every coordinate is finite.
    pub fn make(&self) -> Pair {
        let points = |p: &[[i8; 3]]| p.iter().map(|p| p.map(f64::from)).collect::<Vec<_>>();
        let (mut a, mut b) = (points(&self.a), points(&self.b));
        let shift = self.shift.map(f64::from);
        for p in &mut b {
            *p = std::array::from_fn(|k| p[k] + shift[k]);
        }
        let each =
            |points: &mut [[f64; 3]], f: &dyn Fn([f64; 3]) -> [f64; 3]| points.iter_mut().for_each(|p| *p = f(*p));
        match self.family {
            Family::Lattice => {}
            Family::Coplanar => {
                let z = f64::from(self.ulps);
                each(&mut a, &|[x, y, _]| [x, y, x + 2.0 * y]);
                each(&mut b, &|[x, y, _]| [x, y, x + 2.0 * y + if z > 100.0 { 1.0 } else { 0.0 }]);
            }
            Family::Collinear => {
                each(&mut a, &|[t, _, _]| [t, 2.0 * t, -t]);
                each(&mut b, &|[t, _, _]| [t, 2.0 * t, -t]);
            }
            Family::Needle => each(&mut a, &|[x, y, z]| [x, y * 2f64.powi(-30), z * 2f64.powi(-24)]),
            Family::Slab => {
                each(&mut a, &|[x, y, z]| [x, y, z * 2f64.powi(-20)]);
                each(&mut b, &|[x, y, z]| [x, y, z * 2f64.powi(-20)]);
            }
            Family::Duplicates => {
                a.extend(a.clone());
                let first = b[0];
                b.extend([first, first]);
            }
            Family::Containment => each(&mut b, &|p| p.map(|x| x / 8.0)),
            Family::UlpGap => {
                // Thirds are not representable: everything rounds.
                each(&mut a, &|p| p.map(|x| x / 3.0));
                each(&mut b, &|p| p.map(|x| x / 3.0));
                let high = a.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
                let low = b.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
                let nudge = |mut x: f64| {
                    for _ in 0..self.ulps.unsigned_abs() % 4 {
                        x = if self.ulps > 0 { x.next_up() } else { x.next_down() };
                    }
                    x
                };
                each(&mut b, &|[x, y, z]| [nudge(x - low + high), y, z]);
            }
            Family::Tilted => {
                let m = [[0.8, -0.36, 0.48], [0.6, 0.48, -0.64], [0.0, 0.8, 0.6]];
                let turn = |p: [f64; 3]| m.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
                each(&mut a, &turn);
                each(&mut b, &turn);
            }
            Family::Far => {
                let far = |p: [f64; 3]| p.map(|x| x + 12_345_678.0 / 16.0);
                each(&mut a, &far);
                each(&mut b, &far);
            }
        }
        // Not so far that bits are lost, whatever the family.
        let exponent = i32::from(self.exponent).clamp(-900, 900);
        let (half, rest) = (2f64.powi(exponent / 2), 2f64.powi(exponent - exponent / 2));
        each(&mut a, &|p| p.map(|x| x * half * rest));
        each(&mut b, &|p| p.map(|x| x * half * rest));
        (a, b)
    }

    /// Reads a recipe from a fuzzer's bytes; small numbers of points, so that oracles keep up.
    pub fn decode(bytes: &[u8]) -> Option<Recipe> {
        let (head, mut rest) = bytes.split_at_checked(9)?;
        let mut take = |count: u8| {
            let count = usize::from(count % 6) + 1;
            let (points, more) = rest.split_at_checked(3 * count)?;
            rest = more;
            Some(points.chunks_exact(3).map(|p| [small(p[0]), small(p[1]), small(p[2])]).collect::<Vec<_>>())
        };
        let (a, b) = (take(head[1])?, take(head[2])?);
        Some(Recipe {
            family: FAMILIES[usize::from(head[0]) % FAMILIES.len()],
            a,
            b,
            shift: [small(head[3]), small(head[4]), small(head[5])],
            ulps: head[6] as i8,
            exponent: i16::from_le_bytes([head[7], head[8]]) % 901,
        })
    }
}

fn small(byte: u8) -> i8 {
    (byte as i8).clamp(-16, 16)
}

/// Recipes for proptest; they shrink to few and small points.
pub fn recipes() -> impl Strategy<Value = Recipe> {
    let points = || prop::collection::vec(prop::array::uniform3(-4i8..=4), 1..7);
    let exponents = prop_oneof![4 => Just(0i16), 1 => -900i16..=900];
    let shift = prop::array::uniform3(-6i8..=6);
    (0..FAMILIES.len(), points(), points(), shift, any::<i8>(), exponents).prop_map(
        |(family, a, b, shift, ulps, exponent)| Recipe { family: FAMILIES[family], a, b, shift, ulps, exponent },
    )
}
