//! Integrals of several functions at once over a panel, by two rules whose difference tells the error.
//!
//! Nodes and weights after R. Piessens et al., *QUADPACK*, Springer 1983, subroutine QK15. Sixteen more nodes make of its fifteen a rule that is exact up to
//! degree 47, as T. N. L. Patterson, *The Optimum Addition of Points to Quadrature Formulae*, Mathematics of Computation 22, 1968, tells; found by linear
//! equations in 120 digits.

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

/// Weights of the same nodes in the rule of 31.
const KEPT: [f64; 8] = [
    0.011_319_468_444_683_436,
    0.031_577_706_217_045_86,
    0.052_384_370_820_982_69,
    0.070_332_046_410_400_65,
    0.084_498_765_301_243_02,
    0.095_178_029_931_830_68,
    0.102_214_180_005_702_74,
    0.104_743_213_564_805_84,
];

/// Its other nodes and their weights.
const ADDED: [[f64; 2]; 8] = [
    [0.998_687_109_678_466_7, 0.003_634_931_195_049_884],
    [0.975_383_588_208_893_4, 0.021_039_446_258_726_796],
    [0.912_204_882_783_262_8, 0.042_193_500_584_546_595],
    [0.807_688_939_172_437_5, 0.061_821_985_645_449_856],
    [0.667_348_098_104_300_2, 0.077_875_347_115_246],
    [0.498_636_786_552_832, 0.090_261_802_146_558_6],
    [0.308_579_247_910_587_8, 0.099_196_857_667_432_91],
    [0.104_528_273_810_780_71, 0.104_099_955_472_697_36],
];

/// `a + b · factor`, each component by itself.
#[inline(always)]
#[must_use]
pub fn plus<const N: usize>(mut a: [f64; N], b: [f64; N], factor: f64) -> [f64; N] {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b * factor);
    a
}

/// The integrals of the components of `at` from one place to another by two rules, that of more points first: Kronrod's of fifteen points and Gauss' of
/// seven, and where the difference of these is not `enough`, that of 31 and Kronrod's. The difference is the error of the second.
#[inline(always)]
pub fn panel<const N: usize>(
    [from, to]: [f64; 2],
    mut at: impl FnMut(f64) -> [f64; N],
    enough: impl Fn([f64; N]) -> bool,
) -> [[f64; N]; 2] {
    let (middle, half) = ((from + to) * 0.5, (to - from) * 0.5);
    let (mut fine, mut coarse, mut finer) = ([0.0; N], [0.0; N], [0.0; N]);
    // One loop over both lists of nodes, so that there is one place that calls `at`.
    for n in 0..16 {
        let (first, n) = (n < 8, n & 7);
        let [node, more] = if first { [NODES[n][0], KEPT[n]] } else { ADDED[n] };
        let both = if node == 0.0 { at(middle) } else { plus(at(middle - half * node), at(middle + half * node), 1.0) };
        finer = plus(finer, both, more * half);
        if first {
            let [_, kronrod, gauss] = NODES[n];
            (fine, coarse) = (plus(fine, both, kronrod * half), plus(coarse, both, gauss * half));
        }
        if first && n == 7 && enough(plus(fine, coarse, -1.0)) {
            return [fine, coarse];
        }
    }
    [finer, fine]
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
