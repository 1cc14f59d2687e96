//! Integrals of several functions at once over a panel, by two rules whose difference tells the error.
//!
//! Nodes and weights after R. Piessens et al., *QUADPACK*, Springer 1983, subroutine QK15.

/// Nodes and weights of Kronrod's rule of fifteen points, and of Gauss' in every other node; the last is the middle.
const NODES: [[f64; 3]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
    [0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    [0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4],
];

/// `a + b · factor`, each component by itself.
#[inline(always)]
#[must_use]
pub fn plus<const N: usize>(mut a: [f64; N], b: [f64; N], factor: f64) -> [f64; N] {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b * factor);
    a
}

/// The integrals of the components of `at` from one place to another, by Kronrod's rule of fifteen points and by Gauss' of seven. Their difference is
/// the error of the second.
#[inline(always)]
pub fn panel<const N: usize>([from, to]: [f64; 2], mut at: impl FnMut(f64) -> [f64; N]) -> [[f64; N]; 2] {
    let (middle, half) = ((from + to) * 0.5, (to - from) * 0.5);
    let (mut fine, mut coarse) = ([0.0; N], [0.0; N]);
    for [node, kronrod, gauss] in NODES {
        let both = if node == 0.0 { at(middle) } else { plus(at(middle - half * node), at(middle + half * node), 1.0) };
        (fine, coarse) = (plus(fine, both, kronrod * half), plus(coarse, both, gauss * half));
    }
    [fine, coarse]
}

/// The integral of `at` from one place to another, by Gauss' rule of seven points.
#[inline(always)]
pub fn gauss([from, to]: [f64; 2], mut at: impl FnMut(f64) -> f64) -> f64 {
    let (middle, half) = ((from + to) * 0.5, (to - from) * 0.5);
    let mut sum = 0.0;
    for [node, _, weight] in NODES {
        if node == 0.0 {
            sum += weight * at(middle);
        } else if weight != 0.0 {
            sum += weight * (at(middle - half * node) + at(middle + half * node));
        }
    }
    sum * half
}
